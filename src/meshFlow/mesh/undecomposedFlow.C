// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "undecomposedFlow.H"
#include "checkCells.H"
#include "fromRanks.H"
#include "processorPolyPatch.H"
#include "surfaceFields.H"
#include "tetDecomposition.H"
#include "volFields.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
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


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

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
    forAll(partValues, facei)
    {
        if (atFaces && turned_.test(facei))
        {
            partValues[facei] *= -1;
        }
    }

    const bool master = Pstream::master();
    Field<Type> faceValues(master ? mesh().nFaces() : 0, Zero);
    Field<Type> cellValues(master && !atFaces ? nCells_ : 0, Zero);
    putTogether(faceAddressing_, partValues, faceValues);
    if (!atFaces)
    {
        putTogether(cellAddressing_, field.primitiveField(), cellValues);
    }

    if (!master)
    {
        return autoPtr<fieldType>();
    }

    const serialScope serial;

    autoPtr<fieldType> result
    (
        fieldType::New
        (
            field.name(), mesh(), dimensioned<Type>(field.dimensions(), Zero)
        ).ptr()
    );

    result->primitiveFieldRef() =
        SubList<Type>(atFaces ? faceValues : cellValues, result->size());
    for (PatchField<Type>& pf : result->boundaryFieldRef())
    {
        // An empty patch has faces but no values
        const label start = pf.patch().start();
        static_cast<Field<Type>&>(pf) =
            SubField<Type>(faceValues, pf.size(), start);
    }

    return result;
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::undecomposedFlow::undecomposedFlow(const fvMesh& mesh)
:
    part_(mesh),
    nCells_(mesh.nCells())
{
    checkCells(mesh);

    if (!Pstream::parRun())
    {
        cellAddressing_ = identity(mesh.nCells());
        faceAddressing_ = identity(mesh.nFaces());
        return;
    }

    if (!readAddressing())
    {
        makeAddressing();
    }
    makeMesh();

    // Of no further use
    pointAddressing_.clear();
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
        decomposition_.clear();
        mesh_.clear();
        time_.clear();
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::undecomposedFlow::gather(const solverFields& flow)
{
    gather(flow.U, flow.phi);
    p_ = gather(flow.p);
}


void Foam::undecomposedFlow::gather
(
    const volVectorField& U,
    const surfaceScalarField& phi
)
{
    U_ = gather(U);
    phi_ = gather(phi);
}


void Foam::undecomposedFlow::take(const solverFields& flow)
{
    *U_ == flow.U;
    *p_ == flow.p;
    *phi_ == flow.phi;
}


const Foam::tetDecomposition& Foam::undecomposedFlow::decomposition() const
{
    if (!decomposition_.valid())
    {
        decomposition_.reset(new tetDecomposition(mesh()));
    }
    return *decomposition_;
}


Foam::labelList Foam::undecomposedFlow::localCells() const
{
    return invert(nCells_, cellAddressing_);
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
