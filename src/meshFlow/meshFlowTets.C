// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

/*---------------------------------------------------------------------------*\
Description
    The tetrahedra of the flow and their vertices, made on the master.

\*---------------------------------------------------------------------------*/

#include "meshFlow.H"
#include "baffleSides.H"
#include "cyclicPolyPatch.H"
#include "DynamicList.H"
#include "pointImages.H"
#include "tetDecomposition.H"
#include "undecomposedFlow.H"
#include "volFields.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- Split a cell into tetrahedra from a first on, with the first tetrahedra
    //  of all faces on both sides
    static void splitCell
    (
        const polyMesh& mesh,
        const tetDecomposition& decomposition,
        const baffleSides& baffles,
        const UList<labelPair>& faceTets,
        const label celli,
        label teti,
        UList<flowTet>& tets
    )
    {
        // The tetrahedron, and its face, at each edge of the cell's faces until
        // the one on the other side is there: few at a time
        struct openEdge { edge at; label tet; label face; };
        DynamicList<openEdge, 32> open;

        for (const label facei : mesh.cells()[celli])
        {
            const label owned = (mesh.faceOwner()[facei] == celli);
            const label patchi = patchOf(mesh, facei);
            const label n = decomposition.nTriangles(facei);
            const bool goesRound = n == mesh.faces()[facei].size();

            for (label k = 0; k < n; ++k, ++teti)
            {
                // The normal of a face points out of its owner
                FixedList<label, 3> corners(decomposition.triangle(facei, k));
                if (!owned)
                {
                    Swap(corners[1], corners[2]);
                }

                flowTet& tet = tets[teti];
                tet.vertices[0] = celli;
                tet.neighbours[0] =
                    patchi < 0
                  ? faceTets[facei][owned] + k
                  : -1 - patchi;

                for (label i = 1; i < 4; ++i)
                {
                    const label corner = corners[i - 1];
                    tet.vertices[i] =
                        mesh.nCells()
                      + (
                            corner < mesh.nPoints()
                          ? baffles.vertex(corner, celli)
                          : corner + baffles.sides().size()
                        );

                    // Next in the face, or of another face
                    label next = i == 1 ? -1 : i == 2 + owned ? k - 1 : k + 1;
                    if (goesRound && i > 1)
                    {
                        next = (next + n) % n;
                    }
                    if (next >= 0 && next < n)
                    {
                        tet.neighbours[i] = teti + next - k;
                        continue;
                    }

                    const edge e(corners[i % 3], corners[(i + 1) % 3]);
                    label j = open.size() - 1;
                    while (j >= 0 && open[j].at != e)
                    {
                        --j;
                    }

                    if (j < 0)
                    {
                        open.append(openEdge{e, teti, i});
                        continue;
                    }
                    tet.neighbours[i] = open[j].tet;
                    tets[open[j].tet].neighbours[open[j].face] = teti;
                    open[j] = open.last();
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

    //- The first tetrahedron of each mesh cell, and of each face on both sides.
    //  Triangles of a face, in their order, are tetrahedra first + 0, 1, ...
    //  of its owner, and second + 0, 1, ... of its neighbour.
    static List<labelPair> firstTets
    (
        const polyMesh& mesh,
        const tetDecomposition& decomposition,
        labelList& cellTets
    )
    {
        List<labelPair> faceTets(mesh.nFaces(), labelPair(-1, -1));
        label nTets = 0;
        cellTets.setSize(mesh.nCells() + 1);

        forAll(mesh.cells(), celli)
        {
            cellTets[celli] = nTets;

            for (const label facei : mesh.cells()[celli])
            {
                faceTets[facei][mesh.faceOwner()[facei] != celli] = nTets;
                nTets += decomposition.nTriangles(facei);
            }
        }
        cellTets[mesh.nCells()] = nTets;

        return faceTets;
    }

    //- Of tetrahedra at cyclic patches the one on the other side
    static Map<label> tetsAcross
    (
        const polyMesh& mesh,
        const tetDecomposition& decomposition,
        const domainImages& images,
        const UList<labelPair>& faceTets
    )
    {
        Map<label> across;
        for (const domainImages::seam& seam : images.seams())
        {
            const polyPatch& half = mesh.boundaryMesh()[seam.patch];

            // Both faces are cut alike, and go round in opposite senses
            for (label i = 0; !seam.mirrors() && i < half.size(); ++i)
            {
                const polyPatch& other =
                    refCast<const cyclicPolyPatch>(half).neighbPatch();
                const label n = decomposition.nTriangles(half.start() + i);
                const label here = faceTets[half.start() + i].first();
                const label there = faceTets[other.start() + i].first();

                for (label k = 0; k < n; ++k)
                {
                    across.set(here + k, there + n - 1 - k);
                }
            }
        }
        return across;
    }

    //- Where the vertices are, in their order
    static DynamicList<point> vertexPoints
    (
        const polyMesh& mesh,
        const tetDecomposition& decomposition,
        const baffleSides& baffles
    )
    {
        DynamicList<point> points(decomposition.apexes());
        points.append(mesh.points());
        for (const baffleSides::side& side : baffles.sides())
        {
            points.append(mesh.points()[side.point]);
        }
        for (const label facei : decomposition.meanFaces())
        {
            points.append(decomposition.mean(facei));
        }
        return points;
    }

    //- The vertices at the corners of each face that is cut from their mean
    static List<labelList> meanCorners
    (
        const polyMesh& mesh,
        const tetDecomposition& decomposition,
        const baffleSides& baffles
    )
    {
        List<labelList> corners(decomposition.meanFaces().size());
        forAll(corners, i)
        {
            const label facei = decomposition.meanFaces()[i];
            corners[i] = mesh.faces()[facei];
            for (label& corner : corners[i])
            {
                corner =
                    mesh.nCells()
                  + baffles.vertex(corner, mesh.faceOwner()[facei]);
            }
        }
        return corners;
    }
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::meshFlow::findUnsound()
{
    const auto sixVolumes =
        [&](const label teti)
        {
            const label* v = tets_[teti].vertices;
            const point& x = values_->vertices[v[0]].x;
            return
                (values_->vertices[v[1]].x - x)
              & (
                    (values_->vertices[v[2]].x - x)
                  ^ (values_->vertices[v[3]].x - x)
                );
        };
    label nInverted = 0;
    label nCells = 0;
    label first = -1;
    DynamicList<scalar> volumes;

    for (label celli = 0; celli < cellTets_.size() - 1; ++celli)
    {
        const label before = nInverted;
        scalar rounding = 0;
        volumes.clear();
        for (label i = cellTets_[celli]; i < cellTets_[celli + 1]; ++i)
        {
            volumes.append(sixVolumes(i));
            rounding += 1e-10*mag(volumes.last());
        }
        forAll(volumes, i)
        {
            if (volumes[i] <= rounding)
            {
                unsound_.insert(cellTets_[celli] + i);
            }
            nInverted += volumes[i] < -rounding;
        }
        if (nInverted > before)
        {
            ++nCells;
            first = first < 0 ? celli : first;
        }
    }

    if (nCells)
    {
        Warning
            << nInverted << " of " << tets_.size() << " tetrahedra of"
            << " the mesh are inverted, in " << nCells << " mesh cells, the"
            << " first of them mesh cell " << first << " at "
            << values_->vertices[first].x << " m: what flows through them is"
            << " not exact, and cells may get lost there" << nl
            << "    checkMesh -allGeometry says more" << nl << endl;
    }
}


void Foam::meshFlow::make
(
    const undecomposedFlow& undecomposed,
    const autoPtr<volVectorField>& E
)
{
    const bool master = Pstream::master();
    bool hasField = E.valid();
    broadcast(hasField);

    DynamicList<point> points;
    labelList cellTets;
    List<labelPair> faceTets;
    if (master)
    {
        const polyMesh& mesh = undecomposed.mesh();
        pointImages_.reset(new pointImages(mesh, images_));
        baffles_.reset(new baffleSides(mesh, *pointImages_));
        points = vertexPoints(mesh, undecomposed.decomposition(), *baffles_);
        faceTets = firstTets(mesh, undecomposed.decomposition(), cellTets);
    }

    cellTets_.reset(cellTets.size());
    tets_.reset(master ? cellTets.last() : 0);
    for (label end = 0; end < (unsteady_ ? 2 : 1); ++end)
    {
        flowValues& values = ends_[end];
        values.vertices.reset(points.size());
        forAll(points, i)
        {
            values.vertices[i] = flowVertex{points[i], Zero, Zero, Zero};
        }
        if (scheme_ == stDivergenceFree)
        {
            values.makeConservative(tets_.size(), cellTets_.size() - 1);
        }
    }
    if (hasField)
    {
        field_.reset(points.size());
    }

    if (master)
    {
        const undecomposedFlow::serialScope serial;
        const polyMesh& mesh = undecomposed.mesh();
        const tetDecomposition& decomposition = undecomposed.decomposition();

        cellTets_.deepCopy(cellTets);
        forAll(mesh.cells(), celli)
        {
            splitCell
            (
                mesh, decomposition, *baffles_, faceTets, celli,
                cellTets[celli], tets_
            );
        }
        tetAcross_ = tetsAcross(mesh, decomposition, images_, faceTets);
        meanOf_ = meanCorners(mesh, decomposition, *baffles_);
        findUnsound();
        if (hasField)
        {
            setField(undecomposed, *E);
        }
    }

    broadcast(unsound_);
    cellTets_.share();
    tets_.share();
    for (const flowValues& values : ends_)
    {
        values.share();
    }
    field_.share();
}
