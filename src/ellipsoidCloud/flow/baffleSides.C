/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/
#include "baffleSides.H"
#include "wallPolyPatch.H"

#include <algorithm>
#include <set>
#include <vector>

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::labelHashSet Foam::baffleSides::bafflePoints() const
{
    std::set<std::vector<label>> seen;
    labelHashSet points;

    for (const polyPatch& pp : mesh_.boundaryMesh())
    {
        if (!isA<wallPolyPatch>(pp))
        {
            continue;
        }

        for (const face& f : pp)
        {
            std::vector<label> corners(f.begin(), f.end());
            std::sort(corners.begin(), corners.end());

            if (!seen.insert(corners).second)
            {
                points.insert(f);
            }
        }
    }

    return points;
}


void Foam::baffleSides::split(const label pointi, const UList<label>& faces)
{
    const labelList& owner = mesh_.faceOwner();
    const labelList& neighbour = mesh_.faceNeighbour();

    // The group of each cell: the lowest cell that it hangs together with
    Map<label> group;

    for (const label facei : faces)
    {
        group.insert(owner[facei], owner[facei]);

        if (mesh_.isInternalFace(facei))
        {
            group.insert(neighbour[facei], neighbour[facei]);
        }
    }

    bool changed = true;

    while (changed)
    {
        changed = false;

        for (const label facei : faces)
        {
            if (mesh_.isInternalFace(facei))
            {
                label& a = group[owner[facei]];
                label& b = group[neighbour[facei]];

                if (a != b)
                {
                    a = b = min(a, b);
                    changed = true;
                }
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
            sides_[sideOf_[pointi][owner[facei]]].faces.append(facei);
        }
    }
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::baffleSides::baffleSides(const polyMesh& mesh)
:
    mesh_(mesh)
{
    const labelHashSet points(bafflePoints());

    if (points.empty())
    {
        return;
    }

    Map<DynamicList<label>> faces;

    forAll(mesh.faces(), facei)
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


// ************************************************************************* //
