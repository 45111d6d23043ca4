/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/
#include "cellState.H"
#include "quaternion.H"

// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::cellState::pass(const isometry& image, const scalar semiAxes[3])
{
    if (image.isIdentity())
    {
        return;
    }

    const point x(image(centre()));
    const tensor turn(image.turn());
    const vector u(turn & pointOf(body.u));

    std::copy_n(x.v_, 3, body.x);
    std::copy_n(u.v_, 3, body.u);
    dragImpulse = turn & dragImpulse;
    netImpulse = turn & netImpulse;
    unfold = unfold.after(image.inverse());

    if (image.translates())
    {
        return;
    }

    // Of a body that is its own mirror image along this axis, a reflection M
    // makes one that is turned by -M, and before by half a turn about the axis
    const bool mirrors = image.mirrors();
    const int axis = ellipsoid_mirror_axis(semiAxes);
    const quaternion before(body.q[3], pointOf(body.q));
    quaternion after(quaternion(mirrors ? tensor(-turn) : turn)*before);

    if (mirrors)
    {
        vector half(Zero);
        half[axis] = 1;
        after *= quaternion(0, half);
        for (int i = 0; i < 3; ++i)
        {
            body.omega[i] *= i == axis ? 1 : -1;
        }
    }
    std::copy_n(after.v().v_, 3, body.q);
    body.q[3] = after.w();
}


// ************************************************************************* //
