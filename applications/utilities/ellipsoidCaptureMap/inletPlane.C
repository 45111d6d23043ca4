// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "inletPlane.H"
#include "masterGate.H"
#include "plane.H"
#include "triPointRef.H"

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

    second_ = inward_ ^ first_;
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
        tri.corners =
            triPoints(corners[3*i], corners[3*i + 1], corners[3*i + 2]);
        tri.inflow = patch.upTo[i] - (i ? patch.upTo[i - 1] : 0);
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::inletPlane::share Foam::inletPlane::within(const window& w) const
{
    const plane sides[] =
    {
        plane(position(w.s0, 0), first_), plane(position(w.s1, 0), -first_),
        plane(position(0, w.t0), second_), plane(position(0, w.t1), -second_)
    };
    const auto drop = [](const triPoints&) {};
    share sum{0, 0};

    for (const triangle& tri : triangles_)
    {
        DynamicList<triPoints, 8> parts(1, tri.corners);
        for (const plane& side : sides)
        {
            DynamicList<triPoints, 8> rest;
            const auto keep = [&](const triPoints& part)
            {
                rest.append(part);
            };
            for (const triPoints& part : parts)
            {
                triPointRef(part).sliceWithPlane(side, keep, drop);
            }
            parts.transfer(rest);
        }

        for (const triPoints& part : parts)
        {
            const scalar area = triPointRef(part).mag();
            sum.area += area;
            sum.inflow +=
                tri.inflow*area/max(triPointRef(tri.corners).mag(), VSMALL);
        }
    }

    return sum;
}
