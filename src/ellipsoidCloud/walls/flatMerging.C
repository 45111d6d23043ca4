/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/
#include "flatMerging.H"

#include <algorithm>

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- A turn smaller than this [rad] is rounding
    static const scalar flatAngle = 1e-8;

    //- More triangles than this at a point would make a hub
    static const std::size_t maxTriangles = 24;
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

bool Foam::flatMerging::has(const label trii, const label pointi) const
{
    const labelledTri& t = triangles_[trii];

    return t[0] == pointi || t[1] == pointi || t[2] == pointi;
}


bool Foam::flatMerging::flat(const label a, const label b) const
{
    return
        triangles_[a].region() == triangles_[b].region()
     && (normals_[a] & normals_[b]) > 0
     && mag(normals_[a] ^ normals_[b]) < flatAngle;
}


void Foam::flatMerging::targets
(
    const label pointi,
    DynamicList<label>& points
) const
{
    DynamicList<label> creases;
    points.clear();

    for (const label trii : pointTriangles_[pointi])
    {
        for (const label other : triangles_[trii])
        {
            if (other == pointi || points.found(other))
            {
                continue;
            }
            points.append(other);

            DynamicList<label> sharing;
            for (const label t : pointTriangles_[pointi])
            {
                if (has(t, other))
                {
                    sharing.append(t);
                }
            }

            if (sharing.size() > 2)
            {
                points.clear();
                return;
            }
            if (sharing.size() == 1 || !flat(sharing[0], sharing[1]))
            {
                creases.append(other);
            }
        }
    }

    if (creases.empty())
    {
        return;
    }

    // Along a straight crease, or not at all
    points.clear();

    if (creases.size() == 2)
    {
        const vector a(normalised(points_[creases[0]] - points_[pointi]));
        const vector b(normalised(points_[creases[1]] - points_[pointi]));

        if ((a & b) < 0 && mag(a ^ b) < flatAngle)
        {
            points = creases;
        }
    }
}


Foam::scalar Foam::flatMerging::cost
(
    const label pointi,
    const label target
) const
{
    // A triangle's height over its longest edge at the least
    const scalar thinnest = 1e-3;

    label nShared = 0;
    label nCommon = 0;
    scalar longest = 0;
    DynamicList<label> around;

    for (const label trii : pointTriangles_[pointi])
    {
        nShared += has(trii, target);

        for (const label other : triangles_[trii])
        {
            if (other != pointi && other != target && !around.found(other))
            {
                around.append(other);
            }
        }
    }

    if
    (
        pointTriangles_[pointi].size() + pointTriangles_[target].size()
      > maxTriangles + 2*nShared
    )
    {
        return GREAT;
    }

    // Points next to both are those of the shared triangles, or the surface
    // would fold onto itself
    for (const label other : around)
    {
        for (const label trii : pointTriangles_[target])
        {
            if (has(trii, other))
            {
                ++nCommon;
                break;
            }
        }
    }
    if (nCommon != nShared)
    {
        return GREAT;
    }

    for (const label trii : pointTriangles_[pointi])
    {
        if (has(trii, target))
        {
            continue;
        }

        labelledTri t(triangles_[trii]);
        scalar edge = 0;

        for (label k = 0; k < 3; ++k)
        {
            if (t[k] == pointi)
            {
                t[k] = target;
            }
        }
        for (label k = 0; k < 3; ++k)
        {
            edge = max(edge, mag(points_[t[(k + 1) % 3]] - points_[t[k]]));
        }

        const vector area
        (
            (points_[t[1]] - points_[t[0]]) ^ (points_[t[2]] - points_[t[0]])
        );

        if
        (
            edge > maxEdge_
         || (area & normals_[trii]) < thinnest*sqr(edge)
         || mag(area ^ normals_[trii]) > flatAngle*mag(area)
        )
        {
            return GREAT;
        }

        longest = max(longest, edge);
    }

    return longest;
}


void Foam::flatMerging::collapse
(
    const label pointi,
    const label target,
    DynamicList<label>& queue
)
{
    for (const label trii : pointTriangles_[pointi])
    {
        labelledTri& t = triangles_[trii];
        const bool shared = has(trii, target);

        for (label& other : t)
        {
            if (other == pointi)
            {
                other = target;
                continue;
            }

            queue.append(other);

            if (shared)
            {
                auto& list = pointTriangles_[other];
                list.erase(std::find(list.begin(), list.end(), trii));
            }
        }

        if (shared)
        {
            t.region() = -1;
        }
        else
        {
            pointTriangles_[target].push_back(trii);
        }
    }

    pointTriangles_[pointi].clear();
    queue.append(target);
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::flatMerging::flatMerging
(
    const triSurface& surface,
    const scalar maxEdge
)
:
    points_(surface.points()),
    maxEdge_(maxEdge),
    triangles_(surface),
    normals_(surface.size()),
    pointTriangles_(surface.points().size())
{
    forAll(triangles_, trii)
    {
        normals_[trii] = normalised(triangles_[trii].areaNormal(points_));

        for (const label pointi : triangles_[trii])
        {
            pointTriangles_[pointi].push_back(trii);
        }
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::triSurface Foam::flatMerging::merged()
{
    DynamicList<label> queue(identity(points_.size()));
    DynamicList<label> candidates;

    for (label i = 0; i < queue.size(); ++i)
    {
        const label pointi = queue[i];
        scalar best = GREAT;
        label bestTarget = -1;

        targets(pointi, candidates);

        for (const label target : candidates)
        {
            const scalar c = cost(pointi, target);

            if (c < best)
            {
                best = c;
                bestTarget = target;
            }
        }

        if (bestTarget >= 0)
        {
            collapse(pointi, bestTarget, queue);
        }
    }

    DynamicList<labelledTri> kept(triangles_.size());
    for (const labelledTri& t : triangles_)
    {
        if (t.region() >= 0)
        {
            kept.append(t);
        }
    }

    return triSurface(List<labelledTri>(kept), points_);
}


// ************************************************************************* //
