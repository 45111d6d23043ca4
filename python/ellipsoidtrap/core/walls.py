# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""Walls of triangles."""

import ctypes
from ctypes import POINTER, Structure, byref, c_double, c_int, c_size_t, c_void_p, cast

import numpy as np

from .library import CoreError, check, core, vector


class Triangles(Structure):
    _fields_ = [("point_count", c_int), ("point", c_void_p), ("count", c_int), ("corner", c_void_p), ("label", c_void_p),
                ("mirror", c_void_p)]


class WallsOptions(Structure):
    _fields_ = [("same_point", c_double), ("longest_edge", c_double), ("flat_depth", c_double), ("image_count", c_int),
                ("image", c_void_p), ("low", vector), ("high", vector), ("plane_count", c_int), ("plane", c_void_p)]


class WallsContext(Structure):
    _fields_ = [("walls", c_void_p), ("room", c_int), ("index", POINTER(c_int))]


core.ellipsoid_walls_size.restype = core.ellipsoid_walls_bytes.restype = c_size_t
core.ellipsoid_walls_create.argtypes = [c_void_p, c_size_t, POINTER(Triangles), POINTER(WallsOptions), POINTER(c_void_p),
                                        POINTER(c_int)]
core.ellipsoid_walls_facets.argtypes = [c_void_p, POINTER(c_int)]


class Walls:
    """
    Walls that cells touch.

    points      [m] one row each
    triangles   three indices of points a row, counter-clockwise seen from the fluid
    labels      a whole number of each triangle, which `contact` of a cell reports
    same_point  [m] points no farther apart are one, as where each triangle has its own (STL)
    """

    def __init__(self, points, triangles, labels=None, same_point=0.0):
        self.points = rows("points", points, np.float64)
        self.triangles = rows("triangles", triangles, np.intc)
        self.labels = None if labels is None else np.ascontiguousarray(labels, np.intc)
        if self.labels is not None and self.labels.shape != (len(self.triangles),):
            raise ValueError(f"{len(self.triangles)} triangles, but labels of the shape {self.labels.shape}")
        surface = Triangles(len(self.points), self.points.ctypes.data, len(self.triangles), self.triangles.ctypes.data,
                            None if self.labels is None else self.labels.ctypes.data, None)
        options = WallsOptions(same_point=same_point)
        size = core.ellipsoid_walls_size(byref(surface), byref(options))
        if size == 0:
            raise ValueError(f"no walls of {len(self.triangles)} triangles with same_point = {same_point!r}")
        self._memory = ctypes.create_string_buffer(size)
        made, which, count = c_void_p(), c_int(), c_int()
        try:
            check(core.ellipsoid_walls_create(self._memory, size, byref(surface), byref(options), byref(made), byref(which)))
        except CoreError as error:
            raise ValueError(f"triangle {which.value}: {error}") from None
        core.ellipsoid_walls_facets(made, byref(count))
        self._index = (c_int * count.value)()
        self.context = WallsContext(made, count.value, self._index)

    @classmethod
    def box(cls, low, high):
        """The inside of a box [m]."""
        if not all(below < above for below, above in zip(low, high)):
            raise ValueError(f"low = {low} and high = {high} of a box: allowed is low below high along every axis")
        point, corner = (vector * 8)(), (c_int * 3 * 12)()
        core.ellipsoid_box(vector(*low), vector(*high), point, corner)
        return cls(np.array(point), np.array(corner))

    def put_around(self, surroundings):
        """Make a cell's surroundings ask for these."""
        surroundings.walls = cast(core.ellipsoid_walls_list, c_void_p)
        surroundings.walls_context = ctypes.addressof(self.context)


def rows(what, given, kind):
    """An array of three numbers a row."""
    array = np.asarray(given)
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"{what} have the shape {array.shape} in place of (n, 3)")
    if kind is np.intc and not np.issubdtype(array.dtype, np.integer):
        raise ValueError(f"{what} are {array.dtype}, not whole numbers")
    return np.ascontiguousarray(array, kind)
