/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

Description
    The tetrahedra of the frozen flow and their vertices, made on the master.

\*---------------------------------------------------------------------------*/
#include "frozenFlow.H"
#include "baffleSides.H"
#include "cyclicPolyPatch.H"
#include "undecomposedFlow.H"
#include "volFields.H"
#include "DynamicList.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
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
        UList<flowTet>& tets
    )
    {
        // The tetrahedron, and its face, at each edge of the cell's surface
        // until the one on the other side is there: few at a time
        struct openEdge { edge at; label tet; label face; };
        DynamicList<openEdge> open;

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
                    label k = open.size() - 1;
                    while (k >= 0 && open[k].at != e)
                    {
                        --k;
                    }

                    if (k < 0)
                    {
                        open.append(openEdge{e, teti, i + 1});
                        continue;
                    }
                    tet.neighbours[i + 1] = open[k].tet;
                    tets[open[k].tet].neighbours[open[k].face] = teti;
                    open[k] = open.last();
                    open.remove();
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
    static void makeTets
    (
        const polyMesh& mesh,
        const baffleSides& baffles,
        const bool widest,
        UList<label>& cellTets,
        UList<flowTet>& tets
    )
    {
        // Triangles of a face, in fan order, are tetrahedra first + 0, 1, ...
        // of its owner, and second + 0, 1, ... of its neighbour
        List<labelPair> faceTets(mesh.nFaces(), labelPair(-1, -1));
        label nTets = 0;

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

        // Both halves of a cyclic patch alike: faces begin with the same point
        // and go round in opposite senses
        for (const polyPatch& pp : mesh.boundaryMesh())
        {
            if (!isA<cyclicPolyPatch>(pp))
            {
                continue;
            }
            const cyclicPolyPatch& half = refCast<const cyclicPolyPatch>(pp);
            forAll(half, i)
            {
                const label n = half[i].size();
                if (half.owner())
                {
                    bases[half.neighbPatch().start() + i] =
                        (n - bases[half.start() + i]) % n;
                }
            }
        }

        forAll(mesh.cells(), celli)
        {
            splitCell
            (
                mesh, baffles, faceTets, celli, bases, cellTets[celli], tets
            );
        }
    }

    //- The vertices, with fluid at rest
    static void makeVertices
    (
        const fvMesh& mesh,
        const baffleSides& baffles,
        UList<flowVertex>& vertices
    )
    {
        const label nCells = mesh.nCells();

        forAll(vertices, i)
        {
            const label j = i - nCells;
            const label pointi =
                j < mesh.nPoints()
              ? j
              : baffles.sides()[j - mesh.nPoints()].point;

            vertices[i] = flowVertex
            {
                j < 0 ? mesh.cellCentres()[i] : mesh.points()[pointi],
                Zero, Zero, Zero
            };
        }
    }
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::frozenFlow::make
(
    const undecomposedFlow& undecomposed,
    const autoPtr<volVectorField>& E
)
{
    const bool master = Pstream::master();
    bool hasField = E.valid();
    broadcast(hasField);

    autoPtr<baffleSides> baffles;
    label nVertices = 0;
    label nTets = 0;
    if (master)
    {
        const fvMesh& mesh = undecomposed.mesh();
        baffles.reset(new baffleSides(mesh));
        nVertices = mesh.nCells() + mesh.nPoints() + baffles->sides().size();
        forAll(mesh.faces(), facei)
        {
            const label nSides = 1 + mesh.isInternalFace(facei);
            nTets += nSides*(mesh.faces()[facei].size() - 2);
        }
    }

    cellTets_.reset(master ? undecomposed.mesh().nCells() + 1 : 0);
    tets_.reset(nTets);
    values_.vertices.reset(nVertices);
    if (scheme_ == stDivergenceFree)
    {
        values_.makeConservative(nTets, cellTets_.size() - 1);
    }
    if (hasField)
    {
        field_.reset(nVertices);
    }

    if (master)
    {
        const undecomposedFlow::serialScope serial;
        const fvMesh& mesh = undecomposed.mesh();

        makeTets
        (
            mesh, *baffles, scheme_ == stDivergenceFree, cellTets_, tets_
        );
        makeVertices(mesh, *baffles, values_.vertices);

        if (hasField)
        {
            setField(*E, *baffles);
        }
    }

    cellTets_.share();
    tets_.share();
    values_.share();
    field_.share();
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
            const label next = (base + i + 1) % f.size();
            const vector b(mesh.points()[f[next]] - x);
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
