# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""Ellipsoids drawn true: every pixel's ray is met with the body's surface.

VTK's own rendering wants an X server, which a machine without a screen lacks.
"""

from collections import namedtuple

import numpy as np
from matplotlib.colors import to_rgb

from .poses import rotation

# Semi-axes along the body's axes, and the colours of the halves beyond and before its
# middle, so that one sees which end of the long axis is which
Body = namedtuple("Body", "x q semi_axes ahead behind")

# Rows: to the right, up, and towards the viewer
FROM_ABOVE = np.eye(3)
LIGHT = np.array([-0.45, 0.55, 0.7])
LIGHT = LIGHT / np.linalg.norm(LIGHT)

FINER = 2   # rays a pixel, each way
RIM = 0.35  # where the surface turns away more than this it is drawn dark


def camera(azimuth, elevation):
    """The view from a direction in degrees, x3 up."""
    azimuth, elevation = np.radians((azimuth, elevation))
    towards = np.array([
        np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth),
        np.sin(elevation),
    ])
    right = np.array([-np.sin(azimuth), np.cos(azimuth), 0])
    return np.array([right, np.cross(towards, right), towards])


def parts(bodies, view, xlim, ylim, scale):
    """RGBA images of what is drawn in a window in the plane of the view, each with its rows from the
    top and its columns; scale in pixels a micrometre. Where two overlap they are the same."""
    width, height = (int(round(scale * (high - low))) for low, high in (xlim, ylim))
    fine = scale * FINER
    # Most of the window is empty, and zeros take time only where something is drawn
    colour = np.zeros((height * FINER, width * FINER, 4), dtype=np.float32)
    depth = np.zeros(colour.shape[:2], dtype=np.float32)
    boxes = [_draw(body, view, (xlim[0], ylim[0]), fine, colour, depth) for body in bodies]
    for rows, columns in boxes:
        rays = [
            colour[FINER * rows.start + i:FINER * rows.stop:FINER,
                   FINER * columns.start + j:FINER * columns.stop:FINER]
            for i in range(FINER) for j in range(FINER)
        ]
        mean = sum(rays[1:], rays[0]) / len(rays)
        mean[..., :3] /= np.maximum(mean[..., 3:], 1e-6)
        yield slice(height - rows.stop, height - rows.start), columns, mean.clip(0, 1)[::-1]


def picture(bodies, view, xlim, ylim, scale):
    """RGBA image, first row at the top, of all of the window."""
    width, height = (int(round(scale * (high - low))) for low, high in (xlim, ylim))
    image = np.zeros((height, width, 4), dtype=np.float32)
    for rows, columns, part in parts(bodies, view, xlim, ylim, scale):
        image[rows, columns] = part
    return image


def _draw(body, view, corner, fine, colour, depth):
    """One body into colour and depth, first row at the bottom; the image's rows and columns
    that it may touch."""
    x, y, z = view @ body.x
    shape = view @ rotation(np.asarray(body.q)) * body.semi_axes
    reach = np.linalg.norm(shape[:2], axis=1)
    rows, columns = depth.shape
    left, right = ((x - corner[0] + reach[0] * np.array([-1, 1])) * fine).round().astype(int)
    low, high = ((y - corner[1] + reach[1] * np.array([-1, 1])) * fine).round().astype(int)
    left, low = max(left, 0), max(low, 0)
    right, high = min(right + 1, columns), min(high + 1, rows)
    box = tuple(
        slice(start // FINER, -(-stop // FINER))
        for start, stop in ((low, high), (left, right))
    )
    if left >= right or low >= high:
        return slice(0, 0), slice(0, 0)

    # On the surface | M (du, dv, dw) | = 1: a quadratic for dw, nearer root
    du = (np.arange(left, right) + 0.5) / fine + corner[0] - x
    dv = (np.arange(low, high) + 0.5) / fine + corner[1] - y
    M = np.linalg.inv(shape)
    flat = M[:, 0, None, None] * du + M[:, 1, None, None] * dv[:, None]
    a = M[:, 2] @ M[:, 2]
    b = np.tensordot(M[:, 2], flat, 1)
    inside = b * b - a * ((flat * flat).sum(axis=0) - 1)
    hit = inside > 0
    dw = (np.sqrt(np.where(hit, inside, 0)) - b) / a
    on_sphere = flat + M[:, 2, None, None] * dw
    normal = np.tensordot(M.T, on_sphere, 1)
    normal /= np.linalg.norm(normal, axis=0)

    window = slice(low, high), slice(left, right)
    hit &= (z + dw > depth[window]) | (colour[window][..., 3] == 0)
    bright = 0.42 + 0.58 * np.clip(np.tensordot(LIGHT, normal, 1), 0, 1)
    bright = np.where(normal[2] < RIM, 0.3 * bright, bright)
    paint = np.where(
        on_sphere[1] > 0, np.reshape(to_rgb(body.ahead), (3, 1, 1)),
        np.reshape(to_rgb(body.behind), (3, 1, 1)),
    ) * bright
    colour[window][hit, :3] = np.moveaxis(paint, 0, -1)[hit]
    colour[window][hit, 3] = 1
    depth[window][hit] = (z + dw)[hit]
    return box


def show(ax, bodies, view, scale, **options):
    """The bodies within the limits of axes; scale in pixels a micrometre, but for bodies that would be blurred, or
    larger than any paper."""
    xlim, ylim = ax.get_xlim(), ax.get_ylim()
    scale = np.clip(scale, 500/(xlim[1] - xlim[0]), 2000/(xlim[1] - xlim[0]))
    ax.imshow(
        picture(bodies, view, xlim, ylim, scale), extent=(*xlim, *ylim),
        interpolation="bilinear", **options,
    )
    ax.set_xlim(xlim)
    ax.set_ylim(ylim)
