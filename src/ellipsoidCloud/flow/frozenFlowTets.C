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
#include "baffleSides.H"
#include "undecomposedFlow.H"
#include "vertexFit.H"
#include "volPointInterpolation.H"
#include "fvcGrad.H"
#include "wallPolyPatch.H"
#include "EdgeMap.H"

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

    //- A field at all vertices. Ends the run if a value is not finite.
    template<class Type>
    static Field<Type> atVertices
    (
        const GeometricField<Type, fvPatchField, volMesh>& field,
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

        forAll(baffles.sides(), sidei)
        {
            values[nCells + nPoints + sidei] =
                atSide(field, baffles.sides()[sidei]);
        }

        for (const Type& value : values)
        {
            for (const scalar component : value.v_)
            {
                if (!std::isfinite(component))
                {
                    FatalErrorInFunction
                        << "the " << name << " field holds a value that is not "
                        << "finite: " << advice << exit(FatalError);
                }
            }
        }

        return values;
    }

    //- Split a cell into tetrahedra from a first on, with the first tetrahedra
    //  of all faces on both sides
    static void splitCell
    (
        const polyMesh& mesh,
        const baffleSides& baffles,
        const UList<labelPair>& faceTets,
        const label celli,
        const labelUList& bases,
        label teti,
        List<flowTet>& tets
    )
    {
        // The tetrahedron, and its face, at each edge of the cell's surface
        // until the one on the other side is there
        EdgeMap<labelPair> open(4*mesh.cells()[celli].size());

        for (const label facei : mesh.cells()[celli])
        {
            const face& f = mesh.faces()[facei];
            const label owned = (mesh.faceOwner()[facei] == celli);
            const label base = bases[facei];
            const label patchi = mesh.boundaryMesh().whichPatch(facei);

            for (label trii = 1; trii < f.size() - 1; ++trii, ++teti)
            {
                // The normal of a face points out of its owner
                const label corners[3] =
                {
                    f[base],
                    f[(base + trii + 1 - owned) % f.size()],
                    f[(base + trii + owned) % f.size()]
                };

                flowTet& tet = tets[teti];
                tet.vertices[0] = celli;
                tet.neighbours[0] =
                    patchi < 0
                  ? faceTets[facei][owned] + trii - 1
                  : -1 - patchi;

                for (label i = 0; i < 3; ++i)
                {
                    tet.vertices[i + 1] =
                        mesh.nCells() + baffles.vertex(corners[i], celli);

                    const edge e(corners[(i + 1) % 3], corners[(i + 2) % 3]);

                    if (!open.insert(e, labelPair(teti, i + 1)))
                    {
                        const labelPair other(open[e]);
                        tet.neighbours[i + 1] = other.first();
                        tets[other.first()].neighbours[other.second()] = teti;
                        open.erase(e);
                    }
                }
            }
        }

        if (open.size())
        {
            FatalErrorInFunction
                << "cell " << celli << " at " << mesh.cellCentres()[celli]
                << " is not closed: checkMesh says more" << exit(FatalError);
        }
    }

    //- The tetrahedra of a mesh, and the first of each cell
    static List<flowTet> makeTets
    (
        const polyMesh& mesh,
        const baffleSides& baffles,
        const bool widest,
        labelList& cellTets
    )
    {
        // Triangles of a face, in fan order, are tetrahedra first + 0, 1, ...
        // of its owner, and second + 0, 1, ... of its neighbour
        List<labelPair> faceTets(mesh.nFaces(), labelPair(-1, -1));
        label nTets = 0;

        cellTets.setSize(mesh.nCells() + 1);
        forAll(mesh.cells(), celli)
        {
            cellTets[celli] = nTets;

            for (const label facei : mesh.cells()[celli])
            {
                faceTets[facei][mesh.faceOwner()[facei] != celli] = nTets;
                nTets += mesh.faces()[facei].size() - 2;
            }
        }
        cellTets[mesh.nCells()] = nTets;

        labelList bases(mesh.tetBasePtIs());
        forAll(bases, facei)
        {
            bases[facei] =
                widest
              ? frozenFlow::fanBase(mesh, facei)
              : max(bases[facei], label(0));
        }

        List<flowTet> tets(nTets);

        forAll(mesh.cells(), celli)
        {
            splitCell
            (
                mesh, baffles, faceTets, celli, bases, cellTets[celli], tets
            );
        }

        return tets;
    }

    //- The vertices, with fluid at rest
    static List<flowVertex> makeVertices
    (
        const fvMesh& mesh,
        const baffleSides& baffles
    )
    {
        const label nCells = mesh.nCells();
        const label nPoints = mesh.nPoints() + baffles.sides().size();

        List<flowVertex> vertices(nCells + nPoints);

        forAll(vertices, i)
        {
            const label j = i - nCells;
            const label pointi =
                j < mesh.nPoints()
              ? j
              : baffles.sides()[j - mesh.nPoints()].point;

            vertices[i].x =
                j < 0 ? mesh.cellCentres()[i] : mesh.points()[pointi];
            vertices[i].u = Zero;
            vertices[i].gradient = Zero;
            vertices[i].pressureGradient = Zero;
        }

        return vertices;
    }

    //- Set the flow at the vertices
    static void setVertices
    (
        const undecomposedFlow& undecomposed,
        const scalar rho,
        const baffleSides& baffles,
        UList<flowVertex>& vertices
    )
    {
        const fvMesh& mesh = undecomposed.mesh();
        const volVectorField& flow = undecomposed.U();
        const label nCells = mesh.nCells();
        const vectorField U(atVertices(flow, baffles));
        const tensorField gradU(atVertices(fvc::grad(flow)(), baffles));
        const vectorField gradp
        (
            atVertices((rho*fvc::grad(undecomposed.p()))(), baffles)
        );

        // A point that a wall shares with an open patch moves with the wall,
        // either side of a baffle by itself
        vectorField wallU(U.size() - nCells, Zero);
        labelList nWallFaces(wallU.size(), Zero);

        for (const polyPatch& pp : mesh.boundaryMesh())
        {
            const vectorField& Up = flow.boundaryField()[pp.index()];
            const label nFaces = isA<wallPolyPatch>(pp) ? pp.size() : 0;

            for (label i = 0; i < nFaces; ++i)
            {
                for (const label pointi : pp[i])
                {
                    const label j = baffles.vertex(pointi, pp.faceCells()[i]);
                    wallU[j] += Up[i];
                    ++nWallFaces[j];
                }
            }
        }

        forAll(vertices, i)
        {
            const label j = i - nCells;

            vertices[i].u =
                j >= 0 && nWallFaces[j] ? wallU[j]/scalar(nWallFaces[j]) : U[i];
            vertices[i].gradient = gradU[i].T();
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
    setVertices(undecomposed, rho, baffles, vertices_);

    if (scheme_ == stDivergenceFree)
    {
        const vertexFit fit(undecomposed.U(), baffles);

        forAll(vertices_, i)
        {
            vertices_[i].u = fit.u[i];
            vertices_[i].gradient = fit.gradient[i];
        }
        matchFluxes(undecomposed);
        makeExcess(undecomposed);
    }
}


void Foam::frozenFlow::make
(
    const undecomposedFlow& undecomposed,
    const autoPtr<volVectorField>& E
)
{
    const baffleSides baffles(undecomposed.mesh());

    tets_ = makeTets
    (
        undecomposed.mesh(), baffles, scheme_ == stDivergenceFree, cellTets_
    );
    vertices_ = makeVertices(undecomposed.mesh(), baffles);
    if (scheme_ == stDivergenceFree)
    {
        excess_.setSize(tets_.size(), flowTetExcess{{0, 0, 0, 0}, 0});
    }

    if (E.valid())
    {
        field_ = atVertices
        (
            *E, baffles, "electric", "look at what forces/electricField names"
        );
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::label Foam::frozenFlow::fanBase
(
    const polyMesh& mesh,
    const label facei
)
{
    const face& f = mesh.faces()[facei];
    const vector& S = mesh.faceAreas()[facei];
    label best = max(mesh.tetBasePtIs()[facei], label(0));
    scalar widest = -GREAT;

    for (label base = 0; f.size() > 4 && base < f.size(); ++base)
    {
        const point& x = mesh.points()[f[base]];
        scalar narrowest = GREAT;

        for (label i = 1; i < f.size() - 1; ++i)
        {
            const vector a(mesh.points()[f[(base + i) % f.size()]] - x);
            const vector b
            (
                mesh.points()[f[(base + i + 1) % f.size()]] - x
            );
            narrowest = min
            (
                narrowest,
                ((a ^ b) & S)/max(max(magSqr(a), magSqr(b)), magSqr(b - a))
            );
        }
        if (narrowest > widest)
        {
            widest = narrowest;
            best = base;
        }
    }

    return best;
}


// ************************************************************************* //
