/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/
#include "partitionNeighbours.H"
#include "frozenFlow.H"
#include "partitionCells.H"

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

        extentOf
        (
            const dividedMesh& mesh,
            const label celli,
            const point& centre
        )
        {
            DynamicList<label> corners;
            const label end = mesh.cellTets[celli + 1];
            for (label teti = mesh.cellTets[celli]; teti < end; ++teti)
            {
                for (label a = 1; a < 4; ++a)
                {
                    const label vertexi = mesh.tets[teti].vertices[a];
                    if (!corners.found(vertexi))
                    {
                        corners.append(vertexi);
                    }
                }
            }

            size = 0;
            ends[0] = ends[1] = Zero;
            for (const label vertexi : corners)
            {
                const vector r(mesh.vertices[vertexi].x - centre);
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

void Foam::partitionNeighbours::note
(
    weightsNear& near,
    const label source,
    const unsigned octants
) const
{
    if (!octants)
    {
        return;
    }
    if (near.n % 64 == 0)
    {
        for (unsigned o = 0; o < 8; ++o)
        {
            masks_.append(uint64_t(0));
        }
    }
    uint64_t* of = masks_.data() + near.firstMask + 8*(near.n/64);
    for (unsigned o = 0; o < 8; ++o)
    {
        of[o] |= uint64_t(octants >> o & 1) << near.n % 64;
    }
    sources_.append(source);
    ++near.n;
}


void Foam::partitionNeighbours::find(const label celli) const
{
    const point& x = supports_[celli].x;
    const extentOf extent(mesh_, celli, x);

    weightsNear near = {sources_.size(), 0, 0, masks_.size()};
    listed_.setSize(supports_.size(), -1);
    listed_[celli] = celli;
    queue_.clear();
    queue_.append(celli);
    reaching_.clear();

    for (label i = 0; i < queue_.size(); ++i)
    {
        const label other = queue_[i];
        const supportBounds& bounds = bounds_[other];
        const vector d(bounds.x - x);
        if
        (
            magSqr(d) >= sqr(bounds.radius + extent.size)
         || !extent.reached(supports_[other].metric, d)
        )
        {
            continue;
        }

        reaching_.append(other);
        note(near, other, extent.octants(d, d, bounds.form, 1));

        for (label k = start_[other]; k < start_[other + 1]; ++k)
        {
            const label next = around_[k];
            if (listed_[next] != celli)
            {
                listed_[next] = celli;
                queue_.append(next);
            }
        }
    }

    near.nCells = near.n;
    for (const label other : reaching_)
    {
        const label end = firstTriangle_[other + 1];
        for (label i = firstTriangle_[other]; i < end; ++i)
        {
            note(near, i, octantsOf(triangles_[i], x, extent));
        }
    }

    place_[celli] = found_.size();
    found_.append(near);
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::partitionNeighbours::partitionNeighbours
(
    const dividedMesh& mesh,
    const UList<weightSupport>& supports,
    const UList<wallTriangle>& triangles
)
:
    mesh_(mesh),
    supports_(supports),
    triangles_(triangles)
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::partitionNeighbours::make(const partitionCells* cells)
{
    labelList first;
    List<supportBounds> bounds;
    if (cells)
    {
        first = firstTriangles(cells->size(), triangles_);
        bounds.setSize(cells->size());
        forAll(bounds, i)
        {
            bounds[i] = supportBounds
            {
                supports_[i].x,
                Foam::sqrt(supports_[i].farthest),
                formBelow(supports_[i])
            };
        }
    }
    bounds_.fill(bounds);
    firstTriangle_.fill(first);
    start_.fill(cells ? cells->starts() : labelUList());
    around_.fill(cells ? cells->allAround() : labelUList());

    place_ = labelList(mesh_.cellTets.size() - 1, -1);
}


Foam::labelList Foam::partitionNeighbours::firstTriangles
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


// ************************************************************************* //
