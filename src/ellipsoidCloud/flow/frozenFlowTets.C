/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

Description
    The tetrahedra of the frozen flow and the values at their vertices, made
    on the master from the undecomposed fields.

\*---------------------------------------------------------------------------*/

#include "frozenFlow.H"
#include "volPointInterpolation.H"
#include "fvcGrad.H"
#include "wallPolyPatch.H"
#include "EdgeMap.H"

#include <algorithm>
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

    //- End the run if a value at a vertex is not finite
    static void checkFinite
    (
        const scalarList& values,
        const char* field,
        const char* advice
    )
    {
        for (const scalar value : values)
        {
            if (std::isnan(value) || std::isinf(value))
            {
                FatalErrorInFunction
                    << "the " << field << " field holds a value that is not "
                    << "finite: " << advice << exit(FatalError);
            }
        }
    }
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::frozenFlow::makeTets
(
    const polyMesh& mesh,
    const baffleSides& baffles
)
{
    const faceList& faces = mesh.faces();
    const labelList& owner = mesh.faceOwner();
    const labelList& basePoints = mesh.tetBasePtIs();
    const label nCells = mesh.nCells();

    // Triangles of face facei, in fan order, are tetrahedra
    // cellFaceTet[facei] + 0, 1, ... of its owner and its neighbour
    labelList ownerTet(mesh.nFaces(), -1);
    labelList neighbourTet(mesh.nFaces(), -1);

    cellTets_.setSize(nCells + 1);
    label nTets = 0;

    for (label celli = 0; celli < nCells; ++celli)
    {
        cellTets_[celli] = nTets;

        for (const label facei : mesh.cells()[celli])
        {
            (owner[facei] == celli ? ownerTet : neighbourTet)[facei] = nTets;
            nTets += faces[facei].size() - 2;
        }
    }
    cellTets_[nCells] = nTets;

    tets_.setSize(nTets*labelsPerTet);

    for (label celli = 0; celli < nCells; ++celli)
    {
        // The tetrahedron, and its face, waiting at each edge of the cell's
        // surface for the one on the other side
        EdgeMap<labelPair> open(4*mesh.cells()[celli].size());

        label teti = cellTets_[celli];

        for (const label facei : mesh.cells()[celli])
        {
            const face& f = faces[facei];
            const bool owned = (owner[facei] == celli);
            const label base = max(basePoints[facei], label(0));

            for (label trii = 1; trii < f.size() - 1; ++trii, ++teti)
            {
                label* data = &tets_[teti*labelsPerTet];
                tetrahedron& tet = *reinterpret_cast<tetrahedron*>(data);

                label a = f[(base + trii) % f.size()];
                label b = f[(base + trii + 1) % f.size()];

                // The normal of a face points out of its owner
                if (!owned)
                {
                    std::swap(a, b);
                }

                tet.vertices[0] = celli;
                tet.vertices[1] = nCells + baffles.vertex(f[base], celli);
                tet.vertices[2] = nCells + baffles.vertex(a, celli);
                tet.vertices[3] = nCells + baffles.vertex(b, celli);

                if (mesh.isInternalFace(facei))
                {
                    tet.neighbours[0] =
                        (owned ? neighbourTet : ownerTet)[facei] + trii - 1;
                }
                else
                {
                    tet.neighbours[0] =
                        -1 - mesh.boundaryMesh().whichPatch(facei);
                }

                const edge edges[3] =
                    {edge(a, b), edge(f[base], b), edge(f[base], a)};

                for (label i = 0; i < 3; ++i)
                {
                    const auto waiting = open.cfind(edges[i]);

                    if (waiting.found())
                    {
                        const labelPair other(*waiting);
                        tet.neighbours[i + 1] = other.first();
                        tets_
                        [
                            other.first()*labelsPerTet + 4 + other.second()
                        ] = teti;
                        open.erase(edges[i]);
                    }
                    else
                    {
                        open.insert(edges[i], labelPair(teti, i + 1));
                    }
                }
            }
        }

        if (open.size())
        {
            FatalErrorInFunction
                << "cell " << celli << " at " << mesh.cellCentres()[celli]
                << " is not closed: checkMesh says more"
                << exit(FatalError);
        }
    }
}


void Foam::frozenFlow::makeVertices
(
    const undecomposedFlow& whole,
    const scalar rho,
    const baffleSides& baffles
)
{
    const fvMesh& mesh = whole.mesh();
    const label nCells = mesh.nCells();

    const volTensorField gradU(fvc::grad(whole.U()));
    const volVectorField gradp(rho*fvc::grad(whole.p()));

    const volPointInterpolation& toPoints = volPointInterpolation::New(mesh);

    const pointVectorField pointU(toPoints.interpolate(whole.U()));
    const pointTensorField pointGradU(toPoints.interpolate(gradU));
    const pointVectorField pointGradp(toPoints.interpolate(gradp));

    // A point that a wall shares with an open patch moves with the wall
    vectorField wallU(mesh.nPoints(), Zero);
    labelList nWallFaces(mesh.nPoints(), Zero);

    forAll(mesh.boundaryMesh(), patchi)
    {
        const polyPatch& pp = mesh.boundaryMesh()[patchi];

        if (isA<wallPolyPatch>(pp))
        {
            forAll(pp, i)
            {
                for (const label pointi : pp[i])
                {
                    wallU[pointi] += whole.U().boundaryField()[patchi][i];
                    ++nWallFaces[pointi];
                }
            }
        }
    }

    const label nSides = baffles.sides().size();

    vertices_.setSize((nCells + mesh.nPoints() + nSides)*scalarsPerVertex);

    const auto setVertex =
        [&]
        (
            const label i,
            const point& x,
            const vector& u,
            const tensor& gradu,
            const vector& gradientp
        )
        {
            scalar* data = &vertices_[i*scalarsPerVertex];
            vertex& v = *reinterpret_cast<vertex*>(data);

            for (direction d = 0; d < 3; ++d)
            {
                v.x[d] = x[d];
                v.u[d] = u[d];
                v.pressureGradient[d] = gradientp[d];

                for (direction e = 0; e < 3; ++e)
                {
                    v.gradient[d][e] = gradu[3*e + d];
                }
            }
        };

    for (label celli = 0; celli < nCells; ++celli)
    {
        setVertex
        (
            celli,
            mesh.cellCentres()[celli],
            whole.U()[celli],
            gradU[celli],
            gradp[celli]
        );
    }

    for (label pointi = 0; pointi < mesh.nPoints(); ++pointi)
    {
        setVertex
        (
            nCells + pointi,
            mesh.points()[pointi],
            nWallFaces[pointi]
          ? wallU[pointi]/scalar(nWallFaces[pointi])
          : pointU[pointi],
            pointGradU[pointi],
            pointGradp[pointi]
        );
    }

    // Either side of a baffle by itself
    for (label sidei = 0; sidei < nSides; ++sidei)
    {
        const baffleSides::side& side = baffles.sides()[sidei];

        vector u(Zero);
        label nWalls = 0;

        for (const label facei : side.faces)
        {
            const label patchi = mesh.boundaryMesh().whichPatch(facei);
            const polyPatch& pp = mesh.boundaryMesh()[patchi];

            if (isA<wallPolyPatch>(pp))
            {
                u += whole.U().boundaryField()[patchi][facei - pp.start()];
                ++nWalls;
            }
        }

        setVertex
        (
            nCells + mesh.nPoints() + sidei,
            mesh.points()[side.point],
            nWalls ? u/scalar(nWalls) : pointU[side.point],
            atSide(gradU, side),
            atSide(gradp, side)
        );
    }

    checkFinite(vertices_, "flow", "solve the flow again from clean fields");
}


void Foam::frozenFlow::makeFields
(
    const volVectorField& E,
    const baffleSides& baffles
)
{
    const fvMesh& mesh = E.mesh();
    const label nCells = mesh.nCells();
    const label nWhole = nCells + mesh.nPoints();

    const pointVectorField pointE
    (
        volPointInterpolation::New(mesh).interpolate(E)
    );

    fields_.setSize(3*(nWhole + baffles.sides().size()));

    for (label i = 0; i < fields_.size()/3; ++i)
    {
        const vector value
        (
            i < nCells ? E[i]
          : i < nWhole ? pointE[i - nCells]
          : atSide(E, baffles.sides()[i - nWhole])
        );

        std::copy_n(value.v_, 3, &fields_[3*i]);
    }

    checkFinite(fields_, "electric", "look at what forces/electricField names");
}


// ************************************************************************* //
