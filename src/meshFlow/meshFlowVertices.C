// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

/*---------------------------------------------------------------------------*\
Description
    Values at the vertices of the flow, on the master from the undecomposed
    fields.

\*---------------------------------------------------------------------------*/

#include "meshFlow.H"
#include "bitSet.H"
#include "checkFinite.H"
#include "fvcGrad.H"
#include "tetDecomposition.H"
#include "transform.H"
#include "undecomposedFlow.H"
#include "vertexFit.H"
#include "volPointInterpolation.H"
#include "wallsAtVertices.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- Add what a field is at a face of the boundary by the inverse distance
    //  from x, and this to the weights; nothing where the patch has no values
    template<class Type>
    static void addFace
    (
        const GeometricField<Type, fvPatchField, volMesh>& field,
        const label facei,
        const point& x,
        Type& sum,
        scalar& weights
    )
    {
        const polyMesh& mesh = field.mesh();
        const label patchi = mesh.boundaryMesh().whichPatch(facei);
        const polyPatch& pp = mesh.boundaryMesh()[patchi];
        const fvPatchField<Type>& pf = field.boundaryField()[patchi];

        if (!pp.coupled() && pf.size())
        {
            const scalar weight = 1/mag(x - mesh.faceCentres()[facei]);
            sum += weight*pf[facei - pp.start()];
            weights += weight;
        }
    }

    //- A field at a side of a baffle: of the faces around the point, as at all
    //  points of the boundary
    template<class Type>
    static Type atSide
    (
        const GeometricField<Type, fvPatchField, volMesh>& field,
        const baffleSides::side& side
    )
    {
        Type sum(Zero);
        scalar weights = 0;
        for (const label facei : side.faces)
        {
            const point& x = field.mesh().points()[side.point];
            addFace(field, facei, x, sum, weights);
        }

        return sum/weights;
    }

    //- A field at a point of a plane of symmetry by what is about it, as in the
    //  mesh of the whole: faces of the boundary, or mesh cells if there are
    //  none
    template<class Type>
    static Type beforeMirror
    (
        const GeometricField<Type, fvPatchField, volMesh>& field,
        const domainImages& images,
        const label pointi
    )
    {
        const polyMesh& mesh = field.mesh();
        const point& x = mesh.points()[pointi];

        Type sum(Zero);
        scalar weights = 0;
        for (const label facei : mesh.pointFaces()[pointi])
        {
            const label patchi = mesh.boundaryMesh().whichPatch(facei);
            if (patchi >= 0 && !images.at(patchi))
            {
                addFace(field, facei, x, sum, weights);
            }
        }
        if (weights > 0)
        {
            return sum/weights;
        }

        for (const label celli : mesh.pointCells()[pointi])
        {
            const scalar weight = 1/mag(x - mesh.cellCentres()[celli]);
            sum += weight*field[celli];
            weights += weight;
        }
        return sum/weights;
    }

    //- Make a field at the points of planes of symmetry what it is in the mesh
    //  of the whole
    template<class Type>
    static void mirror
    (
        const GeometricField<Type, fvPatchField, volMesh>& field,
        const domainImages& images,
        UList<Type>& atPoints
    )
    {
        const polyBoundaryMesh& patches = field.mesh().boundaryMesh();
        bitSet atMirror(field.mesh().nPoints());
        bitSet atCyclic(field.mesh().nPoints());
        for (const domainImages::seam& seam : images.seams())
        {
            bitSet& at = seam.mirrors() ? atMirror : atCyclic;
            at.set(patches[seam.patch].meshPoints());
        }

        // At a cyclic patch the other side counts as well
        atMirror.unset(atCyclic);
        for (const label pointi : atMirror)
        {
            atPoints[pointi] = beforeMirror(field, images, pointi);
        }

        for (const domainImages::seam& seam : images.seams())
        {
            const polyPatch& pp = patches[seam.patch];
            for (label i = 0; seam.mirrors() && i < pp.nPoints(); ++i)
            {
                Type& value = atPoints[pp.meshPoints()[i]];
                value = 0.5*(value + transform(seam.inward.turn(), value));
            }
        }
    }

    //- Where the vertices are, but for the means of others
    struct vertexPlaces
    {
        const pointField& apexes;
        const domainImages& images;
        const baffleSides& baffles;
    };

    //- Take a field from the centres of the mesh cells to their apexes
    static void toApexes
    (
        const volVectorField& field,
        const pointField& apexes,
        UList<vector>& values
    )
    {
        const pointField& centres = field.mesh().cellCentres();
        tmp<volTensorField> gradient;
        forAll(apexes, celli)
        {
            if (apexes[celli] != centres[celli])
            {
                if (!gradient.valid())
                {
                    gradient = fvc::grad(field);
                }
                values[celli] +=
                    (apexes[celli] - centres[celli]) & gradient()[celli];
            }
        }
    }

    //- The slope of a gradient is not known
    static void toApexes
    (
        const volTensorField&,
        const pointField&,
        UList<tensor>&
    )
    {}

    //- A field at all vertices but the means of others
    template<class Type>
    static Field<Type> atVertices
    (
        const GeometricField<Type, fvPatchField, volMesh>& field,
        const vertexPlaces& places
    )
    {
        const label nCells = field.mesh().nCells();
        const label nPoints = field.mesh().nPoints();
        const UList<baffleSides::side>& sides = places.baffles.sides();
        Field<Type> values(nCells + nPoints + sides.size());

        SubList<Type>(values, nCells) = field.primitiveField();
        toApexes(field, places.apexes, values);
        SubList<Type> atPoints(values, nPoints, nCells);
        atPoints =
            volPointInterpolation::New(field.mesh()).interpolate(field)()
           .primitiveField();
        mirror(field, places.images, atPoints);

        forAll(sides, sidei)
        {
            values[nCells + nPoints + sidei] = atSide(field, sides[sidei]);
        }

        return values;
    }

    //- Set velocity and gradient at the vertices as OpenFOAM interpolates them
    static void interpolateVelocity
    (
        const volVectorField& flow,
        const vertexPlaces& places,
        UList<flowVertex>& vertices
    )
    {
        const label nCells = flow.size();
        const vectorField U(atVertices(flow, places));
        const tensorField gradU(atVertices(fvc::grad(flow)(), places));
        const wallsAtVertices walls(flow, places.baffles);

        forAll(U, i)
        {
            // A point that a wall shares with an open patch moves with the
            // wall, either side of a baffle by itself
            const label j = i - nCells;
            const bool atWall = j >= 0 && walls.faces(j).size();

            vertices[i].u = atWall ? walls.mean(walls.faces(j)) : U[i];
            vertices[i].gradient = gradU[i].T();
        }
    }
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::meshFlow::setFlow
(
    const undecomposedFlow& undecomposed,
    const scalar rho
)
{
    UList<flowVertex>& vertices = values_->vertices;
    const pointField& apexes = undecomposed.decomposition().apexes();
    const vertexPlaces places{apexes, images_, *baffles_};

    checkFinite(undecomposed.U(), undecomposed.mesh().C(), "mesh cell");
    if (undecomposed.hasPressure())
    {
        checkFinite(undecomposed.p(), undecomposed.mesh().C(), "mesh cell");
    }

    if (pressure_)
    {
        const vectorField gradp
        (
            atVertices((rho*fvc::grad(undecomposed.p()))(), places)
        );
        forAll(gradp, i)
        {
            vertices[i].pressureGradient = gradp[i];
        }
    }

    if (scheme_ == stCellPoint)
    {
        interpolateVelocity(undecomposed.U(), places, vertices);
    }
    else
    {
        const vertexFit fit
        (
            undecomposed.U(), apexes, *baffles_, *pointImages_
        );

        forAll(fit.u, i)
        {
            vertices[i].u = fit.u[i];
            vertices[i].gradient = fit.gradient[i];
        }
    }

    setMeans();
    if (scheme_ == stDivergenceFree)
    {
        makeExcess(undecomposed);
    }
}


void Foam::meshFlow::setMeans()
{
    UList<flowVertex>& vertices = values_->vertices;
    label i = vertices.size() - meanOf_.size();

    for (const labelList& corners : meanOf_)
    {
        flowVertex& mean = vertices[i++];
        mean = flowVertex{mean.x, Zero, Zero, Zero};
        for (const label corner : corners)
        {
            const scalar part = scalar(1)/corners.size();
            mean.u += part*vertices[corner].u;
            mean.gradient += part*vertices[corner].gradient;
            mean.pressureGradient += part*vertices[corner].pressureGradient;
        }
    }
}


void Foam::meshFlow::setField
(
    const undecomposedFlow& undecomposed,
    const volVectorField& E
)
{
    checkFinite(E, E.mesh().C(), "mesh cell");
    const pointField& apexes = undecomposed.decomposition().apexes();
    const vectorField atOthers(atVertices(E, {apexes, images_, *baffles_}));

    label i = atOthers.size();
    SubList<vector>(field_, i) = atOthers;
    for (const labelList& corners : meanOf_)
    {
        field_[i++] = sum(vectorField(atOthers, corners))/corners.size();
    }
}
