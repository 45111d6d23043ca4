/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/
#include "undecomposedFlow.H"
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
}


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


template<class Type>
Foam::Field<Type> Foam::undecomposedFlow::gathered
(
    const UList<Type>& values,
    const labelUList& addresses,
    const label size
)
{
    List<List<Type>> allValues(Pstream::nProcs());
    List<labelList> allAddresses(Pstream::nProcs());

    allValues[Pstream::myProcNo()] = values;
    allAddresses[Pstream::myProcNo()] = addresses;
    Pstream::gatherList(allValues);
    Pstream::gatherList(allAddresses);

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


template<class GeoField>
Foam::Field<typename GeoField::value_type> Foam::undecomposedFlow::valuesOfFaces
(
    const GeoField& field,
    const bool onFaces
) const
{
    typedef typename GeoField::value_type Type;
    Field<Type> values(part_.nFaces(), Zero);

    if (onFaces)
    {
        SubList<Type>(values, field.size()) = field.primitiveField();
    }
    for (const auto& pf : field.boundaryField())
    {
        // Faces of processor patches are inner ones of the undecomposed mesh
        if (onFaces || !isA<processorPolyPatch>(pf.patch().patch()))
        {
            SubList<Type>(values, pf.size(), pf.patch().start()) = pf;
        }
    }

    // A flux is signed by the direction of its face
    forAll(values, facei)
    {
        if (onFaces && faceAddressing_[facei] < 0)
        {
            values[facei] = -values[facei];
        }
    }

    return values;
}


template<class Type, template<class> class PatchField, class GeoMesh>
Foam::autoPtr<Foam::GeometricField<Type, PatchField, GeoMesh>>
Foam::undecomposedFlow::gather
(
    const GeometricField<Type, PatchField, GeoMesh>& field
) const
{
    typedef GeometricField<Type, PatchField, GeoMesh> fieldType;
    const bool onFaces = std::is_same<GeoMesh, surfaceMesh>::value;

    labelList faces(faceAddressing_);
    for (label& facei : faces)
    {
        facei = mag(facei) - 1;
    }

    const Field<Type> faceValues
    (
        gathered(valuesOfFaces(field, onFaces), faces, mesh().nFaces())
    );
    const Field<Type> values
    (
        onFaces
      ? faceValues
      : gathered(field.primitiveField(), cellAddressing_, mesh().nCells())
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
    part_(mesh),
    cellAddressing_(),
    faceAddressing_(),
    time_(),
    mesh_(),
    U_(),
    p_(),
    phi_(),
    cellRank_(),
    cellLocal_()
{
    if (Pstream::parRun())
    {
        cellAddressing_ = readAddressing("cellProcAddressing", mesh);
        faceAddressing_ = readAddressing("faceProcAddressing", mesh);

        if (Pstream::master())
        {
            const serialScope serial;
            readMesh(mesh.time());
        }

        // Before anything is put where the addressing says
        label nWhole = (Pstream::master() ? mesh_->nCells() : 0);
        Pstream::scatter(nWhole);
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
        faceAddressing_ = identity(mesh.nFaces(), 1);
    }

    const List<labelList> allCells(fromAllRanks(cellAddressing_));
    const label nCells = returnReduce(mesh.nCells(), sumOp<label>());

    cellRank_.setSize(nCells);
    cellLocal_.setSize(nCells);

    forAll(allCells, ranki)
    {
        forAll(allCells[ranki], i)
        {
            cellRank_[allCells[ranki][i]] = ranki;
            cellLocal_[allCells[ranki][i]] = i;
        }
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
