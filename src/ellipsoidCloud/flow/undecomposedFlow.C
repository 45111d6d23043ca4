/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/
#include "undecomposedFlow.H"
#include "copyValues.H"
#include "masterGate.H"
#include "plainLists.H"
#include "labelIOList.H"
#include "processorPolyPatch.H"
#include "surfaceFields.H"
#include "volFields.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- UPstream::parRun(bool) sets the flag in newer versions, ...
    template<class PstreamType>
    auto setParRun(const bool on, int)
        -> decltype(PstreamType::parRun(on), void())
    {
        PstreamType::parRun(on);
    }

    //- ... and parRun() gives a reference to it in older ones
    template<class PstreamType>
    void setParRun(const bool on, long)
    {
        PstreamType::parRun() = on;
    }

    //- Addressing that decomposePar left beside the mesh of this rank
    static labelList readAddressing(const word& name, const polyMesh& mesh)
    {
        return labelIOList
        (
            IOobject
            (
                name,
                mesh.facesInstance(),
                polyMesh::meshSubDir,
                mesh,
                IOobject::MUST_READ,
                IOobject::NO_WRITE,
                false
            )
        );
    }

    //- A list of a size, filled with the values of all ranks by their addresses
    //  in it; empty but on the master; collective
    template<class Type>
    static Field<Type> putTogether
    (
        const UList<Type>& values,
        const labelUList& addresses,
        const label size
    )
    {
        const List<List<Type>> allValues(gathered(List<Type>(values)));
        const List<labelList> allAddresses(gathered(labelList(addresses)));

        if (!Pstream::master())
        {
            return Field<Type>();
        }

        Field<Type> result(size, Zero);
        forAll(allValues, ranki)
        {
            UIndirectList<Type>(result, allAddresses[ranki]) = allValues[ranki];
        }

        return result;
    }

    //- Values of a field at the faces of this rank, 0 where it has none
    template<class Type, template<class> class PatchField, class GeoMesh>
    static Field<Type> valuesAtFaces
    (
        const GeometricField<Type, PatchField, GeoMesh>& field,
        const label nFaces
    )
    {
        const bool atFaces = std::is_same<GeoMesh, surfaceMesh>::value;
        Field<Type> values(nFaces, Zero);

        if (atFaces)
        {
            SubList<Type>(values, field.size()) = field.primitiveField();
        }
        for (const auto& pf : field.boundaryField())
        {
            // Faces of processor patches are inner ones of the other mesh
            if (atFaces || !isA<processorPolyPatch>(pf.patch().patch()))
            {
                SubList<Type>(values, pf.size(), pf.patch().start()) = pf;
            }
        }

        return values;
    }
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::undecomposedFlow::serialScope::serialScope()
:
    parRun_(Pstream::parRun())
{
    setParRun<UPstream>(false, 0);
}


Foam::undecomposedFlow::serialScope::~serialScope()
{
    setParRun<UPstream>(parRun_, 0);
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::undecomposedFlow::readMesh(const Time& runTime)
{
    const fileName casePath(runTime.rootPath()/runTime.globalCaseName());

    if (!isDir(casePath/runTime.constant()/polyMesh::meshSubDir))
    {
        FatalErrorInFunction
            << "no undecomposed mesh in " << casePath/runTime.constant()
            << nl << "    The cells see the whole flow, so constant/polyMesh "
            << "has to stay where decomposePar found it"
            << exit(FatalError);
    }

    // A Time sets the digits of what is printed
    const int digits = Sout.precision();

    time_.reset
    (
        new Time
        (
            Time::controlDictName,
            runTime.rootPath(),
            runTime.globalCaseName(),
            "system",
            "constant",
            false,
            false
        )
    );

    Sout.precision(digits);
    Pout.precision(digits);

    mesh_.reset
    (
        new fvMesh
        (
            IOobject
            (
                polyMesh::defaultRegion,
                time_->constant(),
                *time_,
                IOobject::MUST_READ
            )
        )
    );
}


template<class Type, template<class> class PatchField, class GeoMesh>
Foam::autoPtr<Foam::GeometricField<Type, PatchField, GeoMesh>>
Foam::undecomposedFlow::gather
(
    const GeometricField<Type, PatchField, GeoMesh>& field
) const
{
    typedef GeometricField<Type, PatchField, GeoMesh> fieldType;

    const bool atFaces = std::is_same<GeoMesh, surfaceMesh>::value;

    Field<Type> partValues(valuesAtFaces(field, part_.nFaces()));
    if (atFaces)
    {
        for (const label facei : turnedFaces_)
        {
            partValues[facei] *= -1;
        }
    }

    const Field<Type> faceValues
    (
        putTogether(partValues, faceAddressing_, mesh().nFaces())
    );
    const Field<Type> cellValues
    (
        atFaces
      ? Field<Type>()
      : putTogether(field.primitiveField(), cellAddressing_, mesh().nCells())
    );

    if (!Pstream::master())
    {
        return autoPtr<fieldType>();
    }

    const serialScope serial;

    autoPtr<fieldType> result
    (
        new fieldType
        (
            IOobject
            (
                field.name(),
                mesh().time().timeName(),
                mesh(),
                IOobject::NO_READ,
                IOobject::NO_WRITE,
                false
            ),
            mesh(),
            dimensioned<Type>("zero", field.dimensions(), Zero),
            PatchField<Type>::calculatedType()
        )
    );

    const Field<Type>& values = atFaces ? faceValues : cellValues;
    forAll(*result, i)
    {
        (*result)[i] = values[i];
    }
    for (PatchField<Type>& pf : result->boundaryFieldRef())
    {
        // An empty patch has faces but no values
        forAll(pf, i)
        {
            pf[i] = faceValues[pf.patch().start() + i];
        }
    }

    return result;
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::undecomposedFlow::undecomposedFlow(const fvMesh& mesh)
:
    part_(mesh)
{
    if (Pstream::parRun())
    {
        cellAddressing_ = readAddressing("cellProcAddressing", mesh);
        faceAddressing_ = readAddressing("faceProcAddressing", mesh);
        forAll(faceAddressing_, facei)
        {
            // From 1, negative where the normal is the opposite there
            label& whole = faceAddressing_[facei];
            if (whole < 0)
            {
                turnedFaces_.append(facei);
            }
            whole = mag(whole) - 1;
        }

        if (Pstream::master())
        {
            const serialScope serial;
            readMesh(mesh.time());
        }

        // Before anything is put where the addressing says
        label nWhole = (Pstream::master() ? mesh_->nCells() : 0);
        broadcast(nWhole);
        const label nParts = returnReduce(mesh.nCells(), sumOp<label>());

        const masterGate once;

        if (nWhole != nParts)
        {
            FatalErrorInFunction
                << "the decomposed mesh has " << nParts
                << " cells, the undecomposed one " << nWhole << nl
                << "    Run decomposePar -force again"
                << exit(FatalError);
        }
    }
    else
    {
        cellAddressing_ = identity(mesh.nCells());
        faceAddressing_ = identity(mesh.nFaces());
    }
}


// * * * * * * * * * * * * * * * * Destructor  * * * * * * * * * * * * * * * //

Foam::undecomposedFlow::~undecomposedFlow()
{
    if (mesh_.valid())
    {
        const serialScope serial;

        phi_.clear();
        p_.clear();
        U_.clear();
        mesh_.clear();
        time_.clear();
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::undecomposedFlow::gather
(
    const volVectorField& U,
    const volScalarField& p,
    const surfaceScalarField& phi
)
{
    U_ = gather(U);
    p_ = gather(p);
    phi_ = gather(phi);
}


void Foam::undecomposedFlow::take
(
    const volVectorField& U,
    const volScalarField& p,
    const surfaceScalarField& phi
)
{
    copyValues(U, *U_);
    copyValues(p, *p_);
    copyValues(phi, *phi_);
}


Foam::labelList Foam::undecomposedFlow::localCells() const
{
    return invert
    (
        returnReduce(part_.nCells(), sumOp<label>()), cellAddressing_
    );
}


// What others gather
template Foam::autoPtr<Foam::volScalarField> Foam::undecomposedFlow::gather
(
    const volScalarField&
) const;

template Foam::autoPtr<Foam::volVectorField> Foam::undecomposedFlow::gather
(
    const volVectorField&
) const;


// ************************************************************************* //
