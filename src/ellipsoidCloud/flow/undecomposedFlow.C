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
#include "labelIOList.H"
#include "calculatedFvPatchFields.H"
#include "calculatedFvsPatchFields.H"
#include "processorPolyPatch.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- UPstream::parRun(bool) sets the flag in newer versions, ...
    template<class PstreamType>
    auto setParRun(const bool on, int) -> decltype(PstreamType::parRun(on), void())
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
Foam::autoPtr<Foam::GeometricField<Type, Foam::fvPatchField, Foam::volMesh>>
Foam::undecomposedFlow::gather
(
    const GeometricField<Type, fvPatchField, volMesh>& field
) const
{
    typedef GeometricField<Type, fvPatchField, volMesh> fieldType;

    const polyMesh& part = field.mesh();

    // Boundary values go with the label of their face in the whole mesh;
    // those of processor patches are inner faces there
    DynamicList<label> faces(part.nFaces() - part.nInternalFaces());
    DynamicList<Type> faceValues(faces.capacity());

    forAll(field.boundaryField(), patchi)
    {
        const fvPatchField<Type>& pf = field.boundaryField()[patchi];

        if (!isA<processorPolyPatch>(pf.patch().patch()))
        {
            forAll(pf, i)
            {
                faces.append(mag(faceAddressing_[pf.patch().start() + i]) - 1);
                faceValues.append(pf[i]);
            }
        }
    }

    List<labelList> allCells(Pstream::nProcs());
    List<Field<Type>> allValues(Pstream::nProcs());
    List<labelList> allFaces(Pstream::nProcs());
    List<List<Type>> allFaceValues(Pstream::nProcs());

    allCells[Pstream::myProcNo()] = cellAddressing_;
    allValues[Pstream::myProcNo()] = field.primitiveField();
    allFaces[Pstream::myProcNo()] = faces;
    allFaceValues[Pstream::myProcNo()] = faceValues;

    Pstream::gatherList(allCells);
    Pstream::gatherList(allValues);
    Pstream::gatherList(allFaces);
    Pstream::gatherList(allFaceValues);

    if (!Pstream::master())
    {
        return autoPtr<fieldType>();
    }

    const serialScope serial;

    autoPtr<fieldType> whole
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
            calculatedFvPatchField<Type>::typeName
        )
    );

    Field<Type>& values = whole->primitiveFieldRef();

    forAll(allCells, ranki)
    {
        UIndirectList<Type>(values, allCells[ranki]) = allValues[ranki];

        forAll(allFaces[ranki], i)
        {
            const label facei = allFaces[ranki][i];
            const label patchi = mesh().boundaryMesh().whichPatch(facei);
            fvPatchField<Type>& pf = whole->boundaryFieldRef()[patchi];

            // An empty patch has faces but no values
            if (pf.size())
            {
                pf[facei - pf.patch().start()] = allFaceValues[ranki][i];
            }
        }
    }

    return whole;
}


Foam::autoPtr<Foam::surfaceScalarField> Foam::undecomposedFlow::gather
(
    const surfaceScalarField& flux
) const
{
    // Addresses count from 1, negative where the face looks the other way
    labelList faces(faceAddressing_);
    scalarField faceValues(faces.size(), Zero);

    forAll(flux, facei)
    {
        faceValues[facei] = flux[facei];
    }
    for (const fvsPatchScalarField& pf : flux.boundaryField())
    {
        forAll(pf, i)
        {
            faceValues[pf.patch().start() + i] = pf[i];
        }
    }

    List<labelList> allFaces(Pstream::nProcs());
    List<scalarField> allValues(Pstream::nProcs());

    allFaces[Pstream::myProcNo()].transfer(faces);
    allValues[Pstream::myProcNo()].transfer(faceValues);

    Pstream::gatherList(allFaces);
    Pstream::gatherList(allValues);

    if (!Pstream::master())
    {
        return autoPtr<surfaceScalarField>();
    }

    const serialScope serial;

    autoPtr<surfaceScalarField> whole
    (
        new surfaceScalarField
        (
            IOobject
            (
                flux.name(),
                time_->timeName(),
                *mesh_,
                IOobject::NO_READ,
                IOobject::NO_WRITE
            ),
            *mesh_,
            dimensionedScalar("zero", flux.dimensions(), Zero),
            calculatedFvsPatchScalarField::typeName
        )
    );

    forAll(allFaces, ranki)
    {
        forAll(allFaces[ranki], i)
        {
            const label address = allFaces[ranki][i];
            const label facei = mag(address) - 1;
            const scalar value =
                address > 0 ? allValues[ranki][i] : -allValues[ranki][i];

            if (facei < mesh_->nInternalFaces())
            {
                whole->primitiveFieldRef()[facei] = value;
                continue;
            }

            const label patchi = mesh_->boundaryMesh().whichPatch(facei);
            fvsPatchScalarField& pf = whole->boundaryFieldRef()[patchi];

            // An empty patch has faces but no values
            if (pf.size())
            {
                pf[facei - pf.patch().start()] = value;
            }
        }
    }

    return whole;
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::undecomposedFlow::undecomposedFlow(const fvMesh& mesh)
:
    part_(mesh),
    cellAddressing_(),
    faceAddressing_(),
    time_(),
    mesh_(),
    UGathered_(),
    pGathered_(),
    phiGathered_(),
    U_(nullptr),
    p_(nullptr),
    phi_(nullptr),
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

    List<labelList> allCells(Pstream::nProcs());
    allCells[Pstream::myProcNo()] = cellAddressing_;
    Pstream::gatherList(allCells);
    Pstream::scatterList(allCells);

    label nCells = 0;
    for (const labelList& cells : allCells)
    {
        nCells += cells.size();
    }

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

        phiGathered_.clear();
        pGathered_.clear();
        UGathered_.clear();
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
    U_ = &U;
    p_ = &p;
    phi_ = &phi;

    if (!Pstream::parRun())
    {
        return;
    }

    UGathered_ = gather(U);
    pGathered_ = gather(p);
    phiGathered_ = gather(phi);

    if (Pstream::master())
    {
        U_ = UGathered_.get();
        p_ = pGathered_.get();
        phi_ = phiGathered_.get();
    }
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
