// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "inletPlane.H"
#include "masterGate.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- Corners of a convex polygon in the plane
    struct corner
    {
        scalar s, t;
    };
    typedef DynamicList<corner, 8> polygon;

    //- What of a polygon lies on one side of a line: where above(c) >= 0, which
    //  is linear. Sutherland & Hodgman, Commun. ACM 17, 32 (1974).
    template<class Distance>
    static polygon cut(const polygon& full, const Distance& above)
    {
        polygon rest;

        forAll(full, i)
        {
            const corner& a = full[i];
            const corner& b = full[full.fcIndex(i)];
            const scalar da = above(a);
            const scalar db = above(b);

            if (da >= 0)
            {
                rest.append(a);
            }
            if ((da >= 0) != (db >= 0))
            {
                const scalar part = da/(da - db);
                rest.append
                (
                    corner{a.s + part*(b.s - a.s), a.t + part*(b.t - a.t)}
                );
            }
        }

        return rest;
    }

    static scalar areaOf(const polygon& p)
    {
        scalar twice = 0;
        for (label i = 2; i < p.size(); ++i)
        {
            twice +=
                (p[i - 1].s - p[0].s)*(p[i].t - p[0].t)
              - (p[i].s - p[0].s)*(p[i - 1].t - p[0].t);
        }

        return 0.5*mag(twice);
    }
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::inletPlane::setDirections(const patchInflow& patch)
{
    const pointField& corners = patch.corners;

    // All triangles are turned alike, and outwards
    vector outward(Zero);
    for (label i = 0; i < corners.size(); i += 3)
    {
        outward +=
            (corners[i + 1] - corners[i]) ^ (corners[i + 2] - corners[i]);
    }
    inward_ = -outward/max(mag(outward), VSMALL);

    direction along = 0;
    for (direction d = 1; d < 3; ++d)
    {
        if (mag(inward_[d]) < mag(inward_[along]) - 1e-6)
        {
            along = d;
        }
    }

    first_ = Zero;
    first_[along] = 1;
    first_ -= (first_ & inward_)*inward_;
    first_ /= mag(first_);

    // So that its largest component counts upwards
    second_ = inward_ ^ first_;
    direction largest = 0;
    for (direction d = 1; d < 3; ++d)
    {
        if (mag(second_[d]) > mag(second_[largest]) + 1e-6)
        {
            largest = d;
        }
    }
    second_ *= sign(second_[largest]);
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::inletPlane::inletPlane
(
    const dictionary& dict,
    const undecomposedFlow& undecomposed
)
{
    const patchInflow patch(dict, undecomposed, false);
    const pointField& corners = patch.corners;

    setDirections(patch);

    const scalarField s(corners & first_);
    const scalarField t(corners & second_);
    const scalarField depth(corners & inward_);

    width_ = max(s) - min(s);
    height_ = max(t) - min(t);

    {
        const masterGate once;

        // Snapped meshes are not quite flat
        if (max(depth) - min(depth) > 0.01*min(width_, height_))
        {
            FatalIOErrorInFunction(dict)
                << "patch " << dict.get<word>("patch") << " is not flat: its"
                << " points are up to "
                << word::printf("%.3g", max(depth) - min(depth)).c_str()
                << " m apart along its normal" << nl
                << "    allowed: 0.01 of its shorter side, "
                << word::printf("%.3g", min(width_, height_)).c_str() << " m"
                << exit(FatalIOError);
        }
    }

    const scalar layer = average(patch.behind & inward_) - average(depth);
    origin_ =
        min(s)*first_ + min(t)*second_ + (max(depth) + 1e-3*layer)*inward_;

    triangles_.setSize(corners.size()/3);
    forAll(triangles_, i)
    {
        triangle& tri = triangles_[i];
        polygon full;

        for (label k = 0; k < 3; ++k)
        {
            tri.s[k] = s[3*i + k] - min(s);
            tri.t[k] = t[3*i + k] - min(t);
            full.append(corner{tri.s[k], tri.t[k]});
        }
        tri.area = areaOf(full);
        tri.inflow = patch.upTo[i] - (i ? patch.upTo[i - 1] : 0);
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::inletPlane::share Foam::inletPlane::within(const window& w) const
{
    share sum{0, 0};

    for (const triangle& tri : triangles_)
    {
        if
        (
            max(tri.s[0], max(tri.s[1], tri.s[2])) <= w.s0
         || min(tri.s[0], min(tri.s[1], tri.s[2])) >= w.s1
         || max(tri.t[0], max(tri.t[1], tri.t[2])) <= w.t0
         || min(tri.t[0], min(tri.t[1], tri.t[2])) >= w.t1
         || tri.area <= 0
        )
        {
            continue;
        }

        polygon part;
        for (label k = 0; k < 3; ++k)
        {
            part.append(corner{tri.s[k], tri.t[k]});
        }
        part = cut(part, [&](const corner& c) { return c.s - w.s0; });
        part = cut(part, [&](const corner& c) { return w.s1 - c.s; });
        part = cut(part, [&](const corner& c) { return c.t - w.t0; });
        part = cut(part, [&](const corner& c) { return w.t1 - c.t; });

        const scalar area = areaOf(part);
        sum.area += area;
        sum.inflow += tri.inflow*area/tri.area;
    }

    return sum;
}
