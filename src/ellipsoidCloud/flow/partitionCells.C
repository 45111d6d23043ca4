/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/
#include "partitionCells.H"
#include "baffleSides.H"
#include "cyclicPolyPatch.H"
#include "domainImages.H"
#include "labelPairHashes.H"
#include "Map.H"
#include "polyMesh.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- Layers of images: a weight ends 1.5 mesh cells from the centre, and mesh
    //  cells next to one another differ in size
    static const label nImageLayers = 4;

    //- Of each mesh cell at a patch that cells pass, the mesh cells on the other
    //  side, and the patches by their place in the list of them
    static Map<DynamicList<labelPair>> cellsAcross
    (
        const polyMesh& mesh,
        const domainImages& images
    )
    {
        Map<DynamicList<labelPair>> across;

        forAll(images.seams(), seami)
        {
            const domainImages::seam& seam = images.seams()[seami];
            const polyPatch& pp = mesh.boundaryMesh()[seam.patch];
            const labelUList& beyond =
                seam.mirrors()
              ? pp.faceCells()
              : refCast<const cyclicPolyPatch>(pp).neighbPatch().faceCells();

            forAll(pp, i)
            {
                DynamicList<labelPair>& list = across(pp.faceCells()[i]);
                if (!list.found(labelPair(beyond[i], seami)))
                {
                    list.append(labelPair(beyond[i], seami));
                }
            }
        }

        return across;
    }
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::partitionCells::findAround
(
    const polyMesh& mesh,
    const baffleSides& baffles
)
{
    const bool split = baffles.sides().size();
    const labelListList& cellPoints = mesh.cellPoints();
    const labelListList& pointCells = mesh.pointCells();
    labelList listed(mesh.nCells(), -1);

    around_.reserve(30*mesh.nCells());
    start_.setSize(mesh.nCells() + 1);
    forAll(cellPoints, celli)
    {
        start_[celli] = around_.size();
        listed[celli] = celli;

        for (const label pointi : cellPoints[celli])
        {
            for (const label other : pointCells[pointi])
            {
                if
                (
                    listed[other] != celli
                 && (
                        !split
                     || baffles.vertex(pointi, other)
                     == baffles.vertex(pointi, celli)
                    )
                )
                {
                    listed[other] = celli;
                    around_.append(other);
                }
            }
        }
    }
    start_[mesh.nCells()] = around_.size();
}


void Foam::partitionCells::addImages
(
    const polyMesh& mesh,
    const domainImages& images
)
{
    const label nCells = mesh.nCells();
    const Map<DynamicList<labelPair>> across(cellsAcross(mesh, images));
    const scalar size = boundBox(mesh.points(), false).mag();

    // The ways to images, the mesh itself first
    DynamicList<isometry> ways;
    ways.append(isometry());

    // Mesh cells and ways, and the labels of these images
    DynamicList<labelPair> nodes;
    labelPairLookup labels;

    // All about one of them
    DynamicList<labelPair> next;
    const auto findNext =
        [&](const labelPair& node)
        {
            next.clear();
            for (const label other : around(node.first()))
            {
                next.append(labelPair(other, node.second()));
            }
            const auto found = across.cfind(node.first());
            if (found.found())
            {
                for (const labelPair& beyond : *found)
                {
                    const isometry& way = ways[node.second()];
                    const auto& seam = images.seams()[beyond.second()];
                    const isometry on(way.after(seam.inward.inverse()));
                    const label to = placeOf(on, size, ways);
                    next.append(labelPair(beyond.first(), to));
                }
            }
        };

    const auto addNext =
        [&](const labelPair& node)
        {
            findNext(node);
            for (const labelPair& n : next)
            {
                if (n.second() && labels.insert(n, nCells + nodes.size()))
                {
                    nodes.append(n);
                    images_.append(imageCell{n.first(), ways[n.second()]});
                }
            }
        };
    for (const label celli : across.sortedToc())
    {
        addNext(labelPair(celli, 0));
    }
    for (label layer = 1, i = 0; layer < nImageLayers; ++layer)
    {
        for (const label end = nodes.size(); i < end; ++i)
        {
            addNext(labelPair(nodes[i]));
        }
    }

    DynamicList<label> start(nCells + nodes.size() + 1);
    DynamicList<label> all(around_.size() + 30*nodes.size());
    for (label i = 0; i < nCells + nodes.size(); ++i)
    {
        start.append(all.size());
        findNext(i < nCells ? labelPair(i, 0) : nodes[i - nCells]);

        for (const labelPair& n : next)
        {
            const auto found = labels.cfind(n);
            if (!n.second() || found.found())
            {
                all.append(n.second() ? *found : n.first());
            }
        }
    }
    start.append(all.size());
    start_.transfer(start);
    around_.transfer(all);
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::partitionCells::partitionCells
(
    const polyMesh& mesh,
    const baffleSides& baffles,
    const domainImages& images
)
{
    findAround(mesh, baffles);
    if (!images.empty())
    {
        addImages(mesh, images);
    }
}


// ************************************************************************* //
