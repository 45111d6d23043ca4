# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""Orientations and curves through the rows of a track.

Quaternions are (eps1, eps2, eps3, eta), body to lab, as in src/ellipsoid/ellipsoid.h.
"""

import numpy as np


def rotation(q):
    """Matrix that turns the body's frame to that of the lab."""
    e, eta = q[:3], q[3]
    cross = np.array([[0, -e[2], e[1]], [e[2], 0, -e[0]], [-e[1], e[0], 0]])
    return (eta**2 - e @ e) * np.eye(3) + 2 * np.outer(e, e) + 2 * eta * cross


def long_axis(q):
    """O = R e2 of an array of quaternions: the paper's O_x1, O_x2, O_x3."""
    e1, e2, e3, eta = q.T
    return np.column_stack((
        2 * (e1 * e2 - eta * e3),
        eta**2 + e2**2 - e1**2 - e3**2,
        2 * (e2 * e3 + eta * e1),
    ))


def quaternion_rate(q, omega):
    """dq/dt of an array of quaternions, omega in the body's frame; paper equation (4)."""
    e, eta = q[:, :3], q[:, 3:]
    return 0.5 * np.column_stack((
        eta * omega + np.cross(e, omega), -(e * omega).sum(axis=1)
    ))


def spin(q, rate):
    """omega in the body's frame of an array of quaternions of any length, from their dq/dt."""
    e, eta, rate_e, rate_eta = q[:, :3], q[:, 3:], rate[:, :3], rate[:, 3:]
    return 2 * (eta * rate_e - rate_eta * e - np.cross(e, rate_e)) / (q**2).sum(axis=1)[:, None]


def quaternion_from_euler(phi, theta, psi):
    """Of the paper's angles, z-x-z."""
    half_sum, half_difference = (phi + psi) / 2, (phi - psi) / 2
    s, c = np.sin(theta / 2), np.cos(theta / 2)
    return np.array([
        s * np.cos(half_difference), s * np.sin(half_difference),
        c * np.sin(half_sum), c * np.cos(half_sum),
    ])


def hermite(start, end, start_tangent, end_tangent, s):
    """Cubic from start to end at 0 <= s <= 1, with the tangents d/ds at its ends."""
    chord = end - start
    a, b = start_tangent, end_tangent
    return start + s * (a + s * (3 * chord - 2 * a - b + s * (a + b - 2 * chord)))


def hermite_rate(start, end, start_tangent, end_tangent, s):
    """d/ds of hermite()."""
    chord = end - start
    a, b = start_tangent, end_tangent
    return a + s * (2 * (3 * chord - 2 * a - b) + 3 * s * (a + b - 2 * chord))


def at_most(tangent, chord, factor):
    """Tangents no longer than so many chords."""
    length = factor * np.linalg.norm(chord, axis=1, keepdims=True)
    size = np.linalg.norm(tangent, axis=1, keepdims=True)
    return tangent * np.minimum(1, length / np.maximum(size, 1e-30))


def beads(layout, count, radius, semi_axes):
    """Centres of the beads in the body's frame, as in src/ellipsoid/body/beads.c."""
    if count == 1:
        return np.zeros((1, 3))
    if layout == "paper":
        s, v = np.meshgrid(np.arange(4) * np.pi / 4, np.arange(8) * np.pi / 4)
        sphere = np.column_stack([
            one.ravel() for one in (np.sin(s) * np.cos(v), np.sin(v), np.cos(s) * np.cos(v))
        ])
        return np.unique(sphere.round(12), axis=0) * semi_axes
    axes = semi_axes - radius if layout == "staggered" else semi_axes
    rings = (count - 2) // 3
    sphere = [(0, -1, 0), (0, 1, 0)]
    for ring in range(rings):
        y = (2 * ring + 1 - rings) / (rings + 1)
        for k in range(3):
            angle = (2 * k + ring % 2) * np.pi / 3
            around = np.sqrt(1 - y * y)
            sphere.append((around * np.sin(angle), y, around * np.cos(angle)))
    # Poles on the longest axis, a bead of every ring on the plane of the two longer ones
    along = max((1, 0, 2), key=lambda i: semi_axes[i])
    after, last = (along + 1) % 3, (along + 2) % 3
    across, rim = (after, last) if semi_axes[last] > semi_axes[after] else (last, after)
    centres = np.empty((len(sphere), 3))
    centres[:, [across, along, rim]] = sphere
    return centres * axes
