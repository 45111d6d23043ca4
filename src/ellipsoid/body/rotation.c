/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    rotation.c - quaternions, rotation matrices and the paper's Euler angles.
*/
#include "body/body.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

void ellipsoid_rotation(const double q[4], double rotation[3][3])
{
    ellipsoid_rotation_inline(q, rotation);
}

/* To (-pi, pi]; the argument lies within two turns of it. */
static double wrapped(double angle)
{
    while (angle > pi)
    {
        angle -= 2 * pi;
    }
    while (angle <= -pi)
    {
        angle += 2 * pi;
    }
    return angle;
}

/*
    Paper, supplement Figure 3B: R = Rz(phi) Rx(theta) Rz(psi). N, the line of
    nodes, is where the planes x1-x2 and x^1-x^2 cross; phi turns x1 to N,
    theta turns x3 to x^3 about N, psi turns N to x^1 about x^3. So
        eps1 = sin(theta/2) cos((phi-psi)/2)
        eps2 = sin(theta/2) sin((phi-psi)/2)
        eps3 = cos(theta/2) sin((phi+psi)/2)
        eta  = cos(theta/2) cos((phi+psi)/2)
    phi and psi lie in (-pi, pi], theta in [0, pi]. Where x^3 is along +-x3
    only phi+-psi is defined: psi is then 0.
*/
void ellipsoid_euler_from_quaternion(const double q[4], double euler[3])
{
    const double across = hypot(q[0], q[1]);
    const double along = hypot(q[2], q[3]);
    double sum = atan2(q[2], q[3]);
    double difference = atan2(q[1], q[0]);

    if (across == 0)
    {
        difference = sum;
    }
    else if (along == 0)
    {
        sum = difference;
    }
    euler[0] = wrapped(sum + difference);
    euler[1] = 2 * atan2(across, along);
    euler[2] = wrapped(sum - difference);
}

void ellipsoid_quaternion_from_euler(const double euler[3], double q[4])
{
    const double sum = 0.5 * (euler[0] + euler[2]);
    const double difference = 0.5 * (euler[0] - euler[2]);
    const double s = sin(0.5 * euler[1]), c = cos(0.5 * euler[1]);

    q[0] = s * cos(difference);
    q[1] = s * sin(difference);
    q[2] = c * sin(sum);
    q[3] = c * cos(sum);
}

/*
    The shortest turn of x^2 to the axis, written with half-angle forms that
    lose no digits for any direction (x^2 to -x^2 goes about x^1), times the
    spin (0, sin, 0, cos).
*/
void ellipsoid_quaternion_from_axis(const double axis[3], double spin,
                                    double q[4])
{
    const double across = hypot(axis[0], axis[2]);
    const double half = 0.5 * atan2(across, axis[1]);
    const double scale = across > 0 ? sin(half) / across : 0;
    const double e0 = across > 0 ? axis[2] * scale : sin(half);
    const double e2 = -axis[0] * scale;
    const double n = cos(half);
    const double s = sin(0.5 * spin), c = cos(0.5 * spin);

    q[0] = e0 * c - e2 * s;
    q[1] = n * s;
    q[2] = e2 * c + e0 * s;
    q[3] = n * c;
}

/* Shoemake, Graphics Gems III, 124 (1992), eq. for uniform unit quaternions. */
void ellipsoid_quaternion_from_uniform(const double uniform[3], double q[4])
{
    const double r = sqrt(1 - uniform[0]), s = sqrt(uniform[0]);
    const double a = 2 * pi * uniform[1], b = 2 * pi * uniform[2];

    q[0] = r * sin(a);
    q[1] = r * cos(a);
    q[2] = s * sin(b);
    q[3] = s * cos(b);
}
