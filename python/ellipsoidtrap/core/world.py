# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""Cells that push one another."""

import ctypes
from ctypes import POINTER, Structure, byref, c_double, c_int, c_size_t, c_void_p

import numpy as np

from .library import Contact, Controller, Member, State, Statistics, Surroundings, check, checked_end, core, vector

GONE = 2


class Sweep(Structure):
    _fields_ = [("start", State), ("low", vector), ("high", vector), ("passed", vector), ("travel", c_double)]


class Body(Structure):
    _fields_ = [("sweep", Sweep), ("state", State), ("controller", Controller), ("phase", c_int), ("time", c_double),
                ("status", c_int), ("contact", Contact), ("model", c_void_p), ("surroundings", POINTER(Surroundings)),
                ("cache", c_void_p), ("observer", c_void_p), ("observer_context", c_void_p)]


class Bodies(Structure):
    _fields_ = [("count", c_int), ("body", POINTER(Body)), ("largest", c_int), ("member", POINTER(Member)),
                ("memory", c_void_p), ("statistics", Statistics)]


class WorldCells(Structure):
    _fields_ = [("count", c_int), ("cell", c_void_p), ("size", c_size_t), ("context", c_void_p), ("look", c_void_p),
                ("advance", c_void_p), ("put_back", c_void_p), ("pushing", c_int), ("length", c_double),
                ("repeat", c_void_p), ("repeat_count", c_int)]


core.ellipsoid_group_size.restype = core.ellipsoid_world_size.restype = c_size_t
core.ellipsoid_world_size.argtypes = [c_int, c_size_t, c_int]
core.ellipsoid_world_advance.argtypes = [c_void_p, c_size_t, POINTER(WorldCells), c_double, c_double]


class World:
    """
    Cells that push one another where they touch.

    cells   Ellipsoids, each with an id of its own and of one time; in the world they are moved by it, not by themselves
    """

    def __init__(self, cells):
        self.cells = list(cells)
        count = len(self.cells)
        if count == 0 or len({cell.id for cell in self.cells}) < count or len({cell.t for cell in self.cells}) > 1:
            raise ValueError("a world is of cells of one time, each with another id")
        self.t = self.cells[0].t
        self._body, self._member = (Body * count)(), (Member * count)()
        self._group = ctypes.create_string_buffer(core.ellipsoid_group_size(count))
        for body, cell in zip(self._body, self.cells):
            member = cell._member       # pylint: disable=protected-access
            body.model, body.surroundings, body.cache = member.model, member.surroundings, member.cache
        self.bodies = Bodies(count, self._body, count, self._member, ctypes.addressof(self._group))
        self._world_cells = WorldCells()
        core.ellipsoid_world_cells_set(byref(self._world_cells), byref(self.bodies))
        self._size = core.ellipsoid_world_size(count, ctypes.sizeof(Body), 0)
        self._memory = ctypes.create_string_buffer(self._size)

    @property
    def x(self):
        """[m] the centres, one row each."""
        return np.array([cell.x for cell in self.cells])

    def contact(self, number):
        """What touches a cell at the end of the last interval: ellipsoid_contact."""
        return self._body[number].contact

    def advance(self, end):
        """Move on to the time `end` [s], as one interval: best one in which cells move by a fraction of their length. A cell
        that the core cannot go on with is gone from then on; the error names it."""
        end = checked_end(end, self.t)
        for body, cell in zip(self._body, self.cells):
            body.state, body.controller, body.time = *cell.parts(), self.t
        status = core.ellipsoid_world_advance(self._memory, self._size, byref(self._world_cells), self.t, end)
        if status == 0:
            self.t = end
        for body, cell in zip(self._body, self.cells):
            cell.set_parts(body.state, body.controller, self.t)
        for body, cell in zip(self._body, self.cells):
            cell.finish(body.status if body.phase == GONE else 0)
        check(status)
