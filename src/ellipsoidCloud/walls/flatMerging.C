// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "flatMerging.H"
#include "DynamicList.H"

// * * * * * * * * * * * * * * * Local Classes  * * * * * * * * * * * * * * * //

namespace Foam
{

//- A turn smaller than this [rad] is rounding
static const scalar flatAngle = 1e-8;

//- More triangles than this at a point would make a hub
static const label maxTriangles = 24;


/*---------------------------------------------------------------------------*\
                         Class flatMerging Declaration
\*---------------------------------------------------------------------------*/

class flatMerging
{
    // Private Data

        //- The points that the surface uses
        const pointField& points_;

        //- Longest edge [m] that may come about
        const scalar maxEdge_;

        //- Triangles; those taken out have a region below 0
        List<labelledTri> triangles_;

        //- Unit normals of the triangles
        vectorField normals_;

        //- Triangles at each point
        List<DynamicList<label>> pointTriangles_;

        //- Collapses so far; how many there had been when the triangles at a
        //  point changed last, and when it was looked at
        label nCollapses_;
        labelList changed_;
        labelList looked_;

        //- The points around one that may be moved and its targets; and those
        //  around a target
        DynamicList<label> around_;
        DynamicList<label> targets_;
        DynamicList<label> aroundTarget_;


    // Private Member Functions

        //- Are two triangles part of one plane and region?
        bool flat(const label a, const label b) const
        {
            return
                triangles_[a].region() == triangles_[b].region()
             && (normals_[a] & normals_[b]) > 0
             && mag(normals_[a] ^ normals_[b]) < flatAngle;
        }

        //- Have no triangles of a point or of those around it changed since it
        //  was looked at?
        bool unchanged(const label pointi) const
        {
            for (const label trii : pointTriangles_[pointi])
            {
                for (const label other : triangles_[trii])
                {
                    if (changed_[other] > looked_[pointi])
                    {
                        return false;
                    }
                }
            }
            return looked_[pointi] >= 0;
        }

        //- Set the points that share a triangle with a point
        void setAround(const label pointi, DynamicList<label>& points) const
        {
            points.clear();

            for (const label trii : pointTriangles_[pointi])
            {
                for (const label other : triangles_[trii])
                {
                    if (other != pointi && !points.found(other))
                    {
                        points.append(other);
                    }
                }
            }
        }

        //- Set the points around a point, and those that it may be moved to by
        //  what the surface is like around it; none at corners
        void setTargets(const label pointi)
        {
            setAround(pointi, around_);
            targets_.clear();

            for (const label other : around_)
            {
                label sharing[2] = {-1, -1};
                label n = 0;
                for (const label trii : pointTriangles_[pointi])
                {
                    if (triangles_[trii].found(other))
                    {
                        sharing[min(n, label(1))] = trii;
                        ++n;
                    }
                }

                if (n > 2)
                {
                    targets_.clear();
                    return;
                }
                if (n == 1 || !flat(sharing[0], sharing[1]))
                {
                    targets_.append(other);
                }
            }

            if (targets_.empty())
            {
                targets_ = around_;
                return;
            }

            // Along a straight crease
            bool straight = false;
            if (targets_.size() == 2)
            {
                const point& x = points_[pointi];
                const vector a(normalised(points_[targets_[0]] - x));
                const vector b(normalised(points_[targets_[1]] - x));
                straight = (a & b) < 0 && mag(a ^ b) < flatAngle;
            }
            if (!straight)
            {
                targets_.clear();
            }
        }

        //- Longest edge of a triangle if its point is moved to another, or
        //  GREAT if it would be too long or thin or not lie in its plane
        scalar movedEdge
        (
            const label trii,
            const label pointi,
            const label target
        ) const
        {
            // A triangle's height over its longest edge at the least
            const scalar thinnest = 1e-3;

            FixedList<point, 3> x;
            for (label k = 0; k < 3; ++k)
            {
                const label corner = triangles_[trii][k];
                x[k] = points_[corner == pointi ? target : corner];
            }

            const scalar edge =
                max(max(mag(x[1] - x[0]), mag(x[2] - x[1])), mag(x[0] - x[2]));
            const vector area((x[1] - x[0]) ^ (x[2] - x[0]));
            const bool alike =
                edge <= maxEdge_
             && (area & normals_[trii]) >= thinnest*sqr(edge)
             && mag(area ^ normals_[trii]) <= flatAngle*mag(area);

            return alike ? edge : GREAT;
        }

        //- Longest edge if the point is moved to another, or GREAT if the
        //  surface would not stay what it is or that is no less than another.
        //  The points around it are set.
        scalar cost
        (
            const label pointi,
            const label target,
            const scalar other
        )
        {
            scalar longest = 0;
            label nShared = 0;
            label nCommon = 0;

            for (const label trii : pointTriangles_[pointi])
            {
                if (triangles_[trii].found(target))
                {
                    ++nShared;
                }
                else
                {
                    longest = max(longest, movedEdge(trii, pointi, target));
                }
                if (longest >= other)
                {
                    return GREAT;
                }
            }

            // Points next to both are those of the shared triangles, or the
            // surface would fold onto itself
            setAround(target, aroundTarget_);
            for (const label next : around_)
            {
                nCommon += aroundTarget_.found(next);
            }

            const label nTriangles =
                pointTriangles_[pointi].size() + pointTriangles_[target].size();

            return
                nTriangles > maxTriangles + 2*nShared || nCommon != nShared
              ? GREAT : longest;
        }

        //- Move a point to another and append the points around to the queue
        void collapse
        (
            const label pointi,
            const label target,
            DynamicList<label>& queue
        )
        {
            ++nCollapses_;
            changed_[target] = nCollapses_;
            for (const label trii : pointTriangles_[pointi])
            {
                labelledTri& t = triangles_[trii];
                const bool shared = triangles_[trii].found(target);

                for (label& other : t)
                {
                    if (other == pointi)
                    {
                        other = target;
                        continue;
                    }

                    queue.append(other);
                    changed_[other] = nCollapses_;

                    if (shared)
                    {
                        DynamicList<label>& list = pointTriangles_[other];
                        list.remove(list.find(trii));
                    }
                }

                if (shared)
                {
                    t.region() = -1;
                }
                else
                {
                    pointTriangles_[target].append(trii);
                }
            }

            pointTriangles_[pointi].clear();
            queue.append(target);
        }


public:

    // Constructors

        flatMerging(const triSurface& surface, const scalar maxEdge)
        :
            points_(surface.localPoints()),
            maxEdge_(maxEdge),
            triangles_(surface.localFaces()),
            normals_(surface.size()),
            pointTriangles_(surface.nPoints()),
            nCollapses_(0),
            changed_(surface.nPoints(), Zero),
            looked_(surface.nPoints(), -1)
        {
            forAll(triangles_, trii)
            {
                normals_[trii] =
                    normalised(triangles_[trii].areaNormal(points_));

                for (const label pointi : triangles_[trii])
                {
                    pointTriangles_[pointi].append(trii);
                }
            }
        }


    // Member Functions

        //- The merged surface, with all points
        triSurface merged()
        {
            DynamicList<label> queue(identity(points_.size()));

            for (label i = 0; i < queue.size(); ++i)
            {
                const label pointi = queue[i];
                scalar best = GREAT;
                label bestTarget = -1;

                if (unchanged(pointi))
                {
                    continue;
                }
                looked_[pointi] = nCollapses_;
                setTargets(pointi);
                for (const label target : targets_)
                {
                    const scalar c = cost(pointi, target, best);

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
};

} // End namespace Foam


// * * * * * * * * * * * * * * * Global Functions  * * * * * * * * * * * * * //

Foam::triSurface Foam::flatMerged
(
    const triSurface& surface,
    const scalar maxEdge
)
{
    return flatMerging(surface, maxEdge).merged();
}
