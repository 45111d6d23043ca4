// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "baffleSides.H"
#include "wallPolyPatch.H"

#include <algorithm>

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::labelHashSet Foam::baffleSides::bafflePoints() const
{
    // Of each point the last face of a wall of which it is the lowest, and of
    // each such face the one before
    labelList last(mesh_.nPoints(), -1);
    labelList before(mesh_.nFaces(), -1);
    labelHashSet points;

    for (const polyPatch& pp : mesh_.boundaryMesh())
    {
        const label nFaces = isA<wallPolyPatch>(pp) ? pp.size() : 0;

        for (label i = 0; i < nFaces; ++i)
        {
            const face& f = pp[i];
            label& lastHere = last[*std::min_element(f.begin(), f.end())];

            for (label other = lastHere; other >= 0; other = before[other])
            {
                if (face::sameVertices(mesh_.faces()[other], f))
                {
                    points.insert(f);
                }
            }
            before[pp.start() + i] = lastHere;
            lastHere = pp.start() + i;
        }
    }

    return points;
}


void Foam::baffleSides::split(const label pointi, const UList<label>& faces)
{
    // The group of each cell: the lowest cell that it is connected with by
    // faces that have the point
    Map<label> group;

    for (const label facei : faces)
    {
        group.insert(mesh_.faceOwner()[facei], mesh_.faceOwner()[facei]);
    }
    for (bool changed = true; changed;)
    {
        changed = false;

        for (const label facei : faces)
        {
            if (mesh_.isInternalFace(facei))
            {
                const label celli = mesh_.faceNeighbour()[facei];
                label& b = group(celli, celli);
                label& a = group[mesh_.faceOwner()[facei]];

                changed = changed || a != b;
                a = b = min(a, b);
            }
        }
    }

    const labelList cells(group.sortedToc());

    const auto isFirst =
        [&](const label celli){ return group[celli] == cells.first(); };

    if (std::all_of(cells.begin(), cells.end(), isFirst))
    {
        // The rim
        return;
    }

    Map<label> sideOfGroup;

    for (const label celli : cells)
    {
        if (sideOfGroup.insert(group[celli], sides_.size()))
        {
            sides_.append(side{pointi, labelList()});
        }
        sideOf_(pointi).insert(celli, sideOfGroup[group[celli]]);
    }

    for (const label facei : faces)
    {
        if (!mesh_.isInternalFace(facei))
        {
            const label celli = mesh_.faceOwner()[facei];
            sides_[sideOf_[pointi][celli]].faces.append(facei);
        }
    }
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::baffleSides::baffleSides(const polyMesh& mesh)
:
    mesh_(mesh)
{
    const labelHashSet points(bafflePoints());
    Map<DynamicList<label>> faces;

    for (label facei = 0; points.size() && facei < mesh.nFaces(); ++facei)
    {
        for (const label pointi : mesh.faces()[facei])
        {
            if (points.found(pointi))
            {
                faces(pointi).append(facei);
            }
        }
    }

    for (const label pointi : faces.sortedToc())
    {
        split(pointi, faces[pointi]);
    }
}
