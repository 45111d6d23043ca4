// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "meshFlow.H"
#include "indexedOctree.H"
#include "treeDataPoint.H"

#include <set>

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- No tetrahedron, nor a patch
    static const label none = labelMin;

    //- The face by which a walk leaves a tetrahedron, or -1
    static label exitOf
    (
        const flowTet& tet,
        const tetCoordinates& c,
        const label previous
    )
    {
        // Leave by the face most exceeded that leads on; a patch only where
        // no face does, since the way round a corner may graze it. Nor go
        // straight back where tetrahedra overlap.
        int exit = -1;
        int patchExit = -1;

        for (int i = 0; i < 4; ++i)
        {
            const label next = tet.neighbours[i];

            if (!c.isBeyond(i) || next == previous)
            {
                continue;
            }
            if (next < 0)
            {
                patchExit =
                    patchExit < 0 || c.weight[i] < c.weight[patchExit]
                  ? i : patchExit;
            }
            else if (exit < 0 || c.weight[i] < c.weight[exit])
            {
                exit = i;
            }
        }

        return exit >= 0 ? exit : patchExit;
    }
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::label Foam::meshFlow::searched
(
    const label from,
    const point& x
) const
{
    // Those next to one that was looked at, the nearest first
    std::set<std::pair<scalar, label>> next;
    labelHashSet known;
    tetCoordinates c;
    label beyondPatch = -1;
    const auto add =
        [&](const label teti)
        {
            if (teti >= 0 && known.insert(teti))
            {
                vector d(-4*x);
                for (const label vertexi : tets_[teti].vertices)
                {
                    d += values_->vertices[vertexi].x;
                }
                next.insert({magSqr(d), teti});
            }
        };

    add(from);
    for (label n = 0; n < 1000 && !next.empty(); ++n)
    {
        const label teti = next.begin()->second;
        const flowTet& tet = tets_[teti];
        next.erase(next.begin());

        const visitedTet& in = visited(teti);
        if (in.sound)
        {
            in.setCoordinates(x, c);
            const label exit = exitOf(tet, c, none);
            if (exit < 0)
            {
                return teti;
            }
            if (tet.neighbours[exit] < 0 && beyondPatch < 0)
            {
                beyondPatch = teti;
            }
        }
        for (const label neighbour : tet.neighbours)
        {
            add(neighbour);
        }
    }
    return beyondPatch;
}


Foam::meshFlow::locationType Foam::meshFlow::walk
(
    const point& x,
    probe& at,
    tetCoordinates& c,
    isometry* image
) const
{
    const label maxTets = 10000;

    // Where x is in the mesh, and what takes it there from a passage on
    point y(x);
    isometry moved;
    bool passed = false;
    bool turned = false;
    label previous = none;
    bool justPassed = false;
    locationType location = pBeyondWall;

    for (label n = 0; n < maxTets; ++n)
    {
        // Where tetrahedra overlap, or a walk goes round in circles
        const visitedTet* in = &visited(at.tet);
        if (!in->sound || n == maxTets/2)
        {
            const label there = searched(at.tet, y);
            in = &visited(there < 0 ? at.tet : there);
            if (there < 0)
            {
                in->setCoordinates(y, c);
                break;
            }
            at.tet = there;
            previous = none;
        }

        const flowTet& tet = tets_[at.tet];
        in->setCoordinates(y, c);
        at.patch = -1;

        const label exit = exitOf(tet, c, previous);
        if (exit < 0)
        {
            location = pInside;
            break;
        }
        if (tet.neighbours[exit] >= 0)
        {
            previous = at.tet;
            at.tet = tet.neighbours[exit];
            justPassed = false;
            continue;
        }

        const label patchi = -1 - tet.neighbours[exit];
        if (patchLocation_[patchi] != pBeyondSeam)
        {
            at.patch = patchi;
            location = locationType(patchLocation_[patchi]);
            break;
        }
        if (justPassed)
        {
            // Straight back is rounding
            location = pInside;
            break;
        }

        const domainImages::seam& seam = *images_.at(patchi);
        moved = passed ? seam.inward.after(moved) : seam.inward;
        y = moved(x);
        at.tet = seam.mirrors() ? at.tet : tetAcross_[at.tet];
        turned = turned || seam.mirrors();
        passed = justPassed = true;
        previous = none;
    }

    c.turned = turned;
    if (turned)
    {
        c.turn = moved.turn();
    }
    if (image)
    {
        *image = passed ? moved : isometry();
    }

    return location;
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

bool Foam::meshFlow::find(const point& x, probe& at) const
{
    const label celli = centreTree_->findNearest(x, sqr(GREAT)).index();

    // The nearest centre's cell is the one or a neighbour; a walk from it
    // that meets a wall may yet succeed from another of its tetrahedra
    for (label teti = cellTets_[celli]; teti < cellTets_[celli + 1]; ++teti)
    {
        at.tet = teti;

        isometry image;
        if (locate(x, at, &image) == pInside && image.isIdentity())
        {
            return true;
        }
    }

    return false;
}


Foam::meshFlow::locationType Foam::meshFlow::locate
(
    const point& x,
    probe& at,
    isometry* image
) const
{
    tetCoordinates c;

    return walk(x, at, c, image);
}
