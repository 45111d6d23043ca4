/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

Description
    Values at the vertices of the frozen flow, on the master from the
    undecomposed fields.

\*---------------------------------------------------------------------------*/
#include "frozenFlow.H"
#include "undecomposedFlow.H"
#include "vertexFit.H"
#include "bitSet.H"
#include "volPointInterpolation.H"
#include "fvcGrad.H"
#include "wallsAtVertices.H"
#include "DynamicList.H"
#include "transform.H"

#include <cmath>

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- A field at a side of a baffle: of the faces around the point, as at all
    //  points of the boundary
    template<class Type>
    static Type atSide
    (
        const GeometricField<Type, fvPatchField, volMesh>& field,
        const baffleSides::side& side
    )
    {
        const polyMesh& mesh = field.mesh();
        const point& x = mesh.points()[side.point];

        Type value(Zero);
        scalar sum = 0;

        for (const label facei : side.faces)
        {
            const label patchi = mesh.boundaryMesh().whichPatch(facei);
            const polyPatch& pp = mesh.boundaryMesh()[patchi];
            const fvPatchField<Type>& pf = field.boundaryField()[patchi];

            if (!pp.coupled() && pf.size())
            {
                const scalar weight = 1/mag(x - mesh.faceCentres()[facei]);

                value += weight*pf[facei - pp.start()];
                sum += weight;
            }
        }

        return value/sum;
    }

    //- A field at a point of a plane of symmetry by what is about it, as in the
    //  mesh of the whole: faces of the boundary, or mesh cells if there are none
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

        Type atFaces(Zero);
        Type atCells(Zero);
        scalar faceWeights = 0;
        scalar cellWeights = 0;

        for (const label facei : mesh.pointFaces()[pointi])
        {
            const label patchi = mesh.boundaryMesh().whichPatch(facei);

            if (patchi >= 0 && !images.at(patchi))
            {
                const scalar w = 1/mag(x - mesh.faceCentres()[facei]);
                const label start = mesh.boundaryMesh()[patchi].start();
                atFaces += w*field.boundaryField()[patchi][facei - start];
                faceWeights += w;
            }
        }
        for (const label celli : mesh.pointCells()[pointi])
        {
            const scalar w = 1/mag(x - mesh.cellCentres()[celli]);
            atCells += w*field[celli];
            cellWeights += w;
        }

        return faceWeights > 0 ? atFaces/faceWeights : atCells/cellWeights;
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
        const polyMesh& mesh = field.mesh();
        bitSet isCyclic(mesh.nPoints());
        DynamicList<domainImages::seam> mirrors;

        for (const domainImages::seam& seam : images.seams())
        {
            if (seam.mirrors())
            {
                mirrors.append(seam);
                continue;
            }
            isCyclic.set(mesh.boundaryMesh()[seam.patch].meshPoints());
        }

        for (const domainImages::seam& seam : mirrors)
        {
            for
            (
                const label pointi
              : mesh.boundaryMesh()[seam.patch].meshPoints()
            )
            {
                // At a cyclic patch the other side counts as well
                if (!isCyclic.test(pointi))
                {
                    atPoints[pointi] = beforeMirror(field, images, pointi);
                }
            }
        }
        for (const domainImages::seam& seam : mirrors)
        {
            for
            (
                const label pointi
              : mesh.boundaryMesh()[seam.patch].meshPoints()
            )
            {
                Type& value = atPoints[pointi];
                value = 0.5*(value + transform(seam.inward.turn(), value));
            }
        }
    }

    //- End the run if a value of a field of that name is not finite
    template<class Type>
    static void checkFinite
    (
        const UList<Type>& values,
        const char* name = "flow",
        const char* advice = "solve the flow again from clean fields"
    )
    {
        for (const Type& value : values)
        {
            for (direction i = 0; i < pTraits<Type>::nComponents; ++i)
            {
                if (!std::isfinite(component(value, i)))
                {
                    FatalErrorInFunction
                        << "the " << name << " field holds a value that is not "
                        << "finite: " << advice << exit(FatalError);
                }
            }
        }
    }

    //- The same of the values in the mesh and on its boundary
    template<class Type>
    static void checkFinite
    (
        const GeometricField<Type, fvPatchField, volMesh>& field
    )
    {
        checkFinite(field.primitiveField());
        for (const fvPatchField<Type>& pf : field.boundaryField())
        {
            checkFinite(pf);
        }
    }

    //- A field at all vertices. Ends the run if a value is not finite.
    template<class Type>
    static Field<Type> atVertices
    (
        const GeometricField<Type, fvPatchField, volMesh>& field,
        const domainImages& images,
        const baffleSides& baffles,
        const char* name = "flow",
        const char* advice = "solve the flow again from clean fields"
    )
    {
        const label nCells = field.mesh().nCells();
        const label nPoints = field.mesh().nPoints();
        Field<Type> values(nCells + nPoints + baffles.sides().size());

        SubList<Type>(values, nCells) = field.primitiveField();
        SubList<Type>(values, nPoints, nCells) =
            volPointInterpolation::New(field.mesh()).interpolate(field)()
           .primitiveField();

        SubList<Type> atPoints(values, nPoints, nCells);
        mirror(field, images, atPoints);

        forAll(baffles.sides(), sidei)
        {
            values[nCells + nPoints + sidei] =
                atSide(field, baffles.sides()[sidei]);
        }

        checkFinite(values, name, advice);

        return values;
    }

    //- Set velocity and gradient at the vertices as OpenFOAM interpolates them
    static void interpolateVelocity
    (
        const volVectorField& flow,
        const domainImages& images,
        const baffleSides& baffles,
        UList<flowVertex>& vertices
    )
    {
        const label nCells = flow.size();
        const vectorField U(atVertices(flow, images, baffles));
        const tensorField gradU
        (
            atVertices(fvc::grad(flow)(), images, baffles)
        );
        const wallsAtVertices walls(flow, baffles);

        forAll(vertices, i)
        {
            // A point that a wall shares with an open patch moves with the
            // wall, either side of a baffle by itself
            const label j = i - nCells;
            const bool atWall = j >= 0 && walls.faces(j).size();

            vertices[i].u = atWall ? walls.mean(walls.faces(j)) : U[i];
            vertices[i].gradient = gradU[i].T();
        }
    }

    //- Set the gradient of the pressure there
    static void interpolatePressure
    (
        const volScalarField& p,
        const scalar rho,
        const domainImages& images,
        const baffleSides& baffles,
        UList<flowVertex>& vertices
    )
    {
        const vectorField gradp
        (
            atVertices((rho*fvc::grad(p))(), images, baffles)
        );
        forAll(vertices, i)
        {
            vertices[i].pressureGradient = gradp[i];
        }
    }
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::frozenFlow::setFlow
(
    const undecomposedFlow& undecomposed,
    const scalar rho,
    const baffleSides& baffles
)
{
    UList<flowVertex>& vertices = values_.vertices;
    checkFinite(undecomposed.U());
    checkFinite(undecomposed.p());

    if (pressure_)
    {
        interpolatePressure
        (
            undecomposed.p(), rho, images_, baffles, vertices
        );
    }

    if (scheme_ == stCellPoint)
    {
        interpolateVelocity(undecomposed.U(), images_, baffles, vertices);
    }
    else
    {
        const pointImages images(undecomposed.mesh(), images_);
        const vertexFit fit(undecomposed.U(), baffles, images);

        forAll(vertices, i)
        {
            vertices[i].u = fit.u[i];
            vertices[i].gradient = fit.gradient[i];
        }
        makeExcess(undecomposed, images);
    }
}


void Foam::frozenFlow::setField
(
    const volVectorField& E,
    const baffleSides& baffles
)
{
    field_.deepCopy
    (
        atVertices
        (
            E,
            images_,
            baffles,
            "electric",
            "look at what forces/electricField names"
        )
    );
}


// ************************************************************************* //
