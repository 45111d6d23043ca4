/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

Description
    What has a weight in each mesh cell, found on the master
    (partitionOfUnity.H).

\*---------------------------------------------------------------------------*/
#include "partitionOfUnity.H"
#include "partitionCells.H"
#include "polyMesh.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- A mesh cell as seen from its centre: its points, the largest distance,
    //  and the lower and upper ends of its box, a little wider
    class extentOf
    {
    public:

        DynamicList<vector> points;
        scalar size;
        vector ends[2];

        //- The larger of each
        vector half;

        void set
        (
            const UList<point>& all,
            const UList<label>& labels,
            const point& centre
        )
        {
            points.clear();
            size = 0;
            ends[0] = ends[1] = Zero;
            for (const label pointi : labels)
            {
                const vector r(all[pointi] - centre);
                points.append(r);
                size = max(size, mag(r));
                ends[0] = min(ends[0], r);
                ends[1] = max(ends[1], r);
            }
            ends[0] -= 1e-6*size*vector::one;
            ends[1] += 1e-6*size*vector::one;
            half = max(-ends[0], ends[1]);
        }

        //- The octants that a box comes nearer to than a distance, where
        //  squares of differences count by factors
        unsigned octants
        (
            const vector& low,
            const vector& high,
            const vector& factor,
            const scalar farthest
        ) const
        {
            scalar lower[3];
            scalar upper[3];
            for (direction i = 0; i < 3; ++i)
            {
                const scalar below =
                    max(max(low[i], ends[0][i] - high[i]), scalar(0));
                const scalar above =
                    max(max(low[i] - ends[1][i], -high[i]), scalar(0));
                lower[i] = factor[i]*below*below;
                upper[i] = factor[i]*above*above;
            }
            const scalar xy[4] =
            {
                lower[0] + lower[1], upper[0] + lower[1],
                lower[0] + upper[1], upper[0] + upper[1]
            };

            unsigned found = 0;
            for (unsigned o = 0; o < 4; ++o)
            {
                found |= unsigned(xy[o] + lower[2] < farthest) << o;
                found |= unsigned(xy[o] + upper[2] < farthest) << (o + 4);
            }
            return found;
        }

        //- Does the support of a mesh cell with its centre at d reach here, as
        //  far as a triangle inequality tells?
        bool reached(const symmTensor& metric, const vector& d) const
        {
            const scalar distance = d & (metric & d);
            if (distance < 1)
            {
                return true;
            }

            // No point has more than the corner of the box
            const scalar past = sqr(Foam::sqrt(distance) - 1);
            if (past > (half & (cmptMag(metric) & half)))
            {
                return false;
            }
            for (const vector& r : points)
            {
                if (past < (r & (metric & r)))
                {
                    return true;
                }
            }
            return false;
        }
    };

    //- Factors of squares of differences, the sum of which is no more than the
    //  form of a metric: of its diagonal, or of the sphere about its ellipsoid,
    //  whichever says more
    static vector formBelow(const weightSupport& support)
    {
        const symmTensor& M = support.metric;
        const vector d(M.xx(), M.yy(), M.zz());
        const scalar xy = mag(M.xy())/Foam::sqrt(d.x()*d.y());
        const scalar xz = mag(M.xz())/Foam::sqrt(d.x()*d.z());
        const scalar yz = mag(M.yz())/Foam::sqrt(d.y()*d.z());
        const scalar part = 1 - max(xy + xz, max(xy + yz, xz + yz));
        const vector diagonal(max(part, scalar(0))*d);
        const vector sphere(vector::one/support.farthest);

        return
            cmptProduct(diagonal) > cmptProduct(sphere) ? diagonal : sphere;
    }

    //- What a support lies within, close together in memory
    struct supportBounds
    {
        point x;
        scalar radius;
        vector form;
    };

    static List<supportBounds> boundsOf(const UList<weightSupport>& supports)
    {
        List<supportBounds> bounds(supports.size());
        forAll(bounds, i)
        {
            bounds[i] = supportBounds
            {
                supports[i].x,
                Foam::sqrt(supports[i].farthest),
                formBelow(supports[i])
            };
        }
        return bounds;
    }

    //- Note the octants in which the next source of a mesh cell has a weight
    static inline void note
    (
        weightsNear& near,
        const label source,
        const unsigned octants,
        DynamicList<label>& sources,
        DynamicList<uint64_t>& masks
    )
    {
        if (!octants)
        {
            return;
        }
        if (near.n % 64 == 0)
        {
            for (unsigned o = 0; o < 8; ++o)
            {
                masks.append(uint64_t(0));
            }
        }
        uint64_t* of = masks.data() + near.firstMask + 8*(near.n/64);
        for (unsigned o = 0; o < 8; ++o)
        {
            of[o] |= uint64_t(octants >> o & 1) << near.n % 64;
        }
        sources.append(source);
        ++near.n;
    }

    //- The octants of a mesh cell about x in which a triangle has a weight
    static unsigned octantsOf
    (
        const wallTriangle& t,
        const point& x,
        const extentOf& extent
    )
    {
        const vector a(t.corners[0] - x);
        const vector b(t.corners[1] - x);
        const vector c(t.corners[2] - x);

        return extent.octants
        (
            min(a, min(b, c)),
            max(a, max(b, c)),
            vector::one,
            (1 + 1e-9)/t.inverseSquare
        );
    }
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::labelList Foam::partitionOfUnity::firstTriangles
(
    const label n,
    const UList<wallTriangle>& triangles
)
{
    labelList first(n + 1, triangles.size());
    for (label i = triangles.size(), celli = n; celli-- > 0;)
    {
        while (i > 0 && triangles[i - 1].cell == celli)
        {
            --i;
        }
        first[celli] = i;
    }
    return first;
}


void Foam::partitionOfUnity::findNear
(
    const polyMesh& mesh,
    const partitionCells& cells,
    const UList<wallTriangle>& triangles,
    DynamicList<label>& sources,
    DynamicList<uint64_t>& masks
)
{
    const labelList firstOf(firstTriangles(cells.size(), triangles));
    const List<supportBounds> bounds(boundsOf(supports_));
    const labelListList& cellPoints = mesh.cellPoints();
    const pointField& points = mesh.points();
    labelList listed(cells.size(), -1);
    DynamicList<label> found;
    DynamicList<label> reaching;
    extentOf extent;

    forAll(cellPoints, celli)
    {
        const point& x = supports_[celli].x;
        extent.set(points, cellPoints[celli], x);

        weightsNear& near = near_[celli];
        near = weightsNear{sources.size(), 0, 0, masks.size()};
        reaching.clear();
        found.clear();
        found.append(celli);
        listed[celli] = celli;

        for (label i = 0; i < found.size(); ++i)
        {
            const label other = found[i];
            const vector d(bounds[other].x - x);
            if
            (
                magSqr(d) >= sqr(bounds[other].radius + extent.size)
             || !extent.reached(supports_[other].metric, d)
            )
            {
                continue;
            }

            reaching.append(other);
            const unsigned octants =
                extent.octants(d, d, bounds[other].form, 1);
            note(near, other, octants, sources, masks);

            for (const label next : cells.around(other))
            {
                if (listed[next] != celli)
                {
                    listed[next] = celli;
                    found.append(next);
                }
            }
        }

        near.nCells = near.n;
        for (const label other : reaching)
        {
            for (label i = firstOf[other]; i < firstOf[other + 1]; ++i)
            {
                const unsigned octants = octantsOf(triangles[i], x, extent);
                note(near, i, octants, sources, masks);
            }
        }
    }
}


// ************************************************************************* //
