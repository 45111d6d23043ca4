# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""A cut through mesh and flow."""

from functools import cached_property

import numpy as np
from PIL import Image, ImageDraw, ImageFilter

SMOOTH = 50000   # triangles that make a smooth picture
RASTER = 4000    # pixels along the longer side of where there is fluid


class Plane:
    """A cut through mesh and flow, parallel to the plan of the device.

    points      (n, 2) corners
    connectivity, offsets   polygon i has the corners connectivity[offsets[i]:offsets[i+1]]
    velocity    (m, 3) of the flow in every polygon
    potential   (m) the electric one in every polygon [V], or None
    outlines    patch name to (k, 2, 2) segments
    walls       (which points, their velocity) where it is known
    """

    def __init__(
        self, points, connectivity, offsets, velocity, outlines, walls, potential=None
    ):
        self.points = points
        self.connectivity = connectivity
        self.offsets = offsets
        self.velocity = velocity
        self.outlines = outlines
        self.potential = potential
        self._walls = walls

    @property
    def bounds(self):
        """(xMin, xMax), (yMin, yMax)"""
        return tuple(zip(self.points.min(axis=0), self.points.max(axis=0)))

    @cached_property
    def polygons(self):
        """List of (k, 2) corner arrays."""
        return np.split(self.points[self.connectivity], self.offsets[1:-1])

    @cached_property
    def _raster(self):
        """Where there is fluid, a pixel more about it; its first corner, and pixels for each unit."""
        low, high = np.transpose(self.bounds)
        scale = RASTER / (high - low).max()
        low, high = low - 1 / scale, high + 1 / scale
        size = np.ceil(scale * (high - low)).astype(int) + 1
        image = Image.new("1", tuple(size.tolist()))
        pen = ImageDraw.Draw(image)
        # In whole pixels neighbours share an edge; what Pillow makes of others depends on its version
        corners = np.round(scale * (self.points - low)).astype(int)
        for polygon in np.split(corners[self.connectivity], self.offsets[1:-1]):
            pen.polygon([tuple(corner) for corner in polygon.tolist()], fill=1, outline=1)
        # A point on a slanting side is rounded to a pixel beside it
        return np.asarray(image.convert("L").filter(ImageFilter.MaxFilter(3))) > 0, low, scale

    def has_fluid(self, points):
        """Which of (n, 2) points are in the fluid, to a pixel."""
        raster, low, scale = self._raster
        columns, rows = np.round(scale * (points - low)).astype(int).T
        there = (columns >= 0) & (columns < raster.shape[1]) & (rows >= 0) & (rows < raster.shape[0])
        return there & raster[rows.clip(0, raster.shape[0] - 1), columns.clip(0, raster.shape[1] - 1)]

    @cached_property
    def areas(self):
        """Area of every polygon."""
        a, b = self.points[self.connectivity], self.points[self._next]
        cross = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
        return 0.5 * np.abs(np.add.reduceat(cross, self.offsets[:-1]))

    @property
    def flow_axis(self):
        """The axis of the plan along which most of the fluid flows, 0 or 1, if any."""
        mean = np.abs(self.areas @ self.velocity[:, :2]) / self.areas.sum()
        along = int(np.argmax(mean))
        return None if mean[along] < 0.1 * np.linalg.norm(self.velocity, axis=1).max() else along

    @cached_property
    def point_velocity(self):
        """Velocity at every corner, the mean of the polygons about it."""
        owner = np.repeat(np.arange(len(self.velocity)), np.diff(self.offsets))
        shares = np.bincount(self.connectivity, minlength=len(self.points))
        velocity = np.column_stack([
            np.bincount(self.connectivity, component[owner], len(self.points))
            for component in self.velocity.T
        ]) / np.maximum(shares, 1)[:, None]
        for which, value in self._walls:
            velocity[which] = value
        return velocity

    @cached_property
    def _fans(self):
        """Nodes of x, y and velocity, and triangles: every polygon a fan about its middle."""
        sides = np.diff(self.offsets)
        corners = self.points[self.connectivity]
        middles = np.add.reduceat(corners, self.offsets[:-1]) / sides[:, None]
        hub = np.repeat(len(self.points) + np.arange(len(sides)), sides)
        nodes = np.column_stack((
            np.concatenate((self.points, middles)),
            np.concatenate((self.point_velocity, self.velocity)),
        ))
        return nodes, np.column_stack((hub, self.connectivity, self._next))

    def speed_in(self, xlim, ylim):
        """Speed on a triangulation of a window: x, y, triangles, speed."""
        nodes, triangles = self._fans
        low, high = np.transpose((xlim, ylim))
        boxes = nodes[triangles, :2]
        seen = (boxes.max(axis=1) > low) & (boxes.min(axis=1) < high)
        triangles = triangles[seen.all(axis=1)]
        # The speed is not linear: where there are few, triangles are quartered
        while 0 < len(triangles) < SMOOTH:
            corners = nodes[triangles]
            halves = 0.5 * (corners + np.roll(corners, -1, axis=1))
            nodes = np.concatenate((corners, halves), axis=1).reshape(-1, nodes.shape[1])
            first = 6 * np.arange(len(triangles))[:, None, None]
            quarters = np.array([[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]])
            triangles = (first + quarters).reshape(-1, 3)
        return nodes[:, 0], nodes[:, 1], triangles, np.linalg.norm(nodes[:, 2:], axis=1)

    @cached_property
    def _next(self):
        """The corner that follows each entry of connectivity within its polygon."""
        after = np.roll(self.connectivity, -1)
        after[self.offsets[1:] - 1] = self.connectivity[self.offsets[:-1]]
        return after


def coincide(points, others, tolerance):
    """Which of the points lie on one of the others."""
    near = np.zeros(len(points), dtype=bool)
    if len(others):
        (x0, y0), (x1, y1) = others.min(axis=0) - tolerance, others.max(axis=0) + tolerance
        x, y = points.T
        candidates = np.flatnonzero((x >= x0) & (x <= x1) & (y >= y0) & (y <= y1))
        for part in np.array_split(candidates, len(candidates) // 1000 + 1):
            apart = np.abs(points[part, None] - others[None]).max(axis=2)
            near[part] = apart.min(axis=1, initial=np.inf) <= tolerance
    return near
