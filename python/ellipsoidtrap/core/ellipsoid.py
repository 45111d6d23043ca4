# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""One cell in a flow that is a Python function."""

import ctypes
from ctypes import POINTER, Structure, byref, c_double, cast

import numpy as np

from .library import Contact, Controller, FlowFunction, Member, State, Statistics, Surroundings, check, checked_end, core, vector
from .options import Options, make


class ModelStart(Structure):
    """The members of ellipsoid_model that stand first."""
    _fields_ = [("options", Options)] \
        + [(name, c_double) for name in ("volume", "mass", "fluid_mass", "viscosity")] \
        + [(name, vector) for name in ("inertia", "constant_force", "resistance", "rotation_resistance", "strain_factor",
                                       "mobility", "rotation_mobility")] \
        + [("relaxation_time", c_double), ("rotation_relaxation_time", c_double)]


class Flow:
    """A Python function as the core calls it; what that raises waits until the core has returned."""

    def __init__(self, function, unsteady):
        self.function, self.unsteady = function, unsteady
        self.raised = None
        self.callback = FlowFunction(self.sample)

    def sample(self, _context, t, x, derivatives, sample):
        """See ellipsoid_flow_function; all that is not set here is zero."""
        try:
            place = np.array(x.contents)
            answer = self.function(place, t) if self.unsteady else self.function(place)
            if answer is None:
                return 1
            velocity, gradient = answer
            numbers = np.frombuffer(sample.contents)
            numbers[0:3] = shaped("the flow's velocity", velocity, (3,))
            numbers[3:12] = shaped("the flow's gradient", gradient, (3, 3)).ravel()
            if derivatives:
                numbers[18:27] = numbers[3:12]      # velocity_jacobian
            return 0
        except BaseException as error:  # pylint: disable=broad-exception-caught
            self.raised = error
            return -1

    def raise_again(self):
        """What the function has raised, if anything."""
        raised, self.raised = self.raised, None
        if raised is not None:
            raise raised


def shaped(what, given, shape):
    """An array of this shape, or an error that names it."""
    array = np.asarray(given, float)
    if array.shape != shape:
        raise ValueError(f"{what} has the shape {array.shape} in place of {shape}")
    return array


def key(what, given, bits):
    """A whole number that C would cut off if it were too large, or an error that names it."""
    if not 0 <= given < 2**bits or int(given) != given:
        raise ValueError(f"{what} = {given!r}: allowed is a whole number, 0 to {2**bits - 1}")
    return int(given)


def state_part(first, last, text):
    """A property: a part of the state's numbers, which may be changed in place."""
    def read(self):
        return self.numbers[first:last]

    def write(self, given):
        part = shaped("the state", given, (last - first,))
        # The core's functions but advance() take a quaternion as it is; that of no length is told
        length = np.linalg.norm(part) if last - first == 4 else 0
        self.numbers[first:last] = part / length if length > 0 else part

    return property(read, write, doc=text)


class Ellipsoid:
    """
    A rigid ellipsoid; SI units.

    semi_axes   [m] along the body axes; the default cell's long axis is the second
    x, q        where it is [m] and its quaternion, scalar last, which turns body axes to the lab's
    u, omega    [m/s] in the lab, [rad/s] in the body; of motion inertialess they are results
    flow        function of the place x [m] (of x and t [s] if unsteady) that returns the velocity [m/s] and its
                gradient [1/s], G[i][j] = du_i/dx_j; or None where there is no fluid, so that the step is shortened.
                Without one the body is in vacuum
    walls       Walls that it touches
    seed, id    the key of its Brownian motion; the id names it in a World
    options     any of ellipsoidtrap.core.options(), by name

    Of these x, q, u, omega and the time t may be set later.
    """

    u = state_part(0, 3, "[m/s] velocity, lab")
    x = state_part(3, 6, "[m] centre, lab")
    omega = state_part(6, 9, "[rad/s] angular velocity, body")
    q = state_part(9, 13, "quaternion, scalar last")

    def __init__(self, semi_axes=None, *, x=(0, 0, 0), q=(0, 0, 0, 1), u=(0, 0, 0), omega=(0, 0, 0), t=0.0, flow=None,
                 walls=None, unsteady=False, seed=0, id=0, **options):  # pylint: disable=redefined-builtin,too-many-arguments
        if semi_axes is not None:
            options["semi_axes"] = semi_axes
        self.t, self.id, self.walls = float(t), key("id", id, 32), walls
        self._model = ctypes.create_string_buffer(core.ellipsoid_model_size())
        check(core.ellipsoid_model_init(self._model, byref(make(options))))
        self.model = ModelStart.from_buffer(self._model)
        self._state, self._controller, self.statistics = State(), Controller(), Statistics()
        self.numbers = np.frombuffer(self._state)
        self.x, self.q, self.u, self.omega = x, q, u, omega
        self._flow = Flow(flow, unsteady)
        self._surroundings = Surroundings(unsteady=bool(unsteady), seed=key("seed", seed, 64), id=self.id)
        if flow is not None:
            self._surroundings.flow = self._flow.callback
        self._cache = None
        if walls is not None:
            walls.put_around(self._surroundings)
            self._cache = ctypes.create_string_buffer(core.ellipsoid_facet_cache_size(self._model))
            core.ellipsoid_facet_cache_clear(self._cache)
        self._member = Member(ctypes.addressof(self._model), ctypes.pointer(self._surroundings),
                              ctypes.pointer(self._state), ctypes.pointer(self._controller),
                              self._cache and ctypes.addressof(self._cache), None, ctypes.pointer(self.statistics))

    def __setattr__(self, name, what):
        if name not in ("t", "x", "q", "u", "omega") and hasattr(self, "_member"):
            raise AttributeError(f"{name} of an Ellipsoid: allowed to be set are t, x, q, u, omega; all else when it is made")
        super().__setattr__(name, what)

    def __repr__(self):
        return f"<Ellipsoid at t = {self.t:g} s, x = {self.x} m, q = {self.q}>"

    def advance(self, end):
        """Move on to the time `end` [s]. On a CoreError, or one of the flow's own, the state is that of the last step."""
        t = c_double(self.t)
        status = core.ellipsoid_advance(byref(self._member), byref(t), checked_end(end, self.t), None)
        self.t = t.value
        self.finish(status)

    def balance(self):
        """Set u and omega to those with which the drag balances all other forces here."""
        self.finish(core.ellipsoid_balance(self._model, byref(self._surroundings), byref(self._state), self._cache))

    @property
    def contact(self):
        """What the walls do here: ellipsoid_contact, with force [N], gap [m], surface_count and surface, the labels."""
        found = Contact()
        self.finish(core.ellipsoid_contact_evaluate(self._model, byref(self._surroundings), byref(self._state), self._cache,
                                                    byref(found), None))
        return found

    @property
    def rotation(self):
        """R(q), whose columns are the body axes in the lab."""
        turned = (vector * 3)()
        core.ellipsoid_rotation(cast(byref(self._state, State.q.offset), POINTER(c_double)), turned)
        return np.array(turned)

    def parts(self):
        """The state and what step control remembers: what a World moves."""
        return self._state, self._controller

    def set_parts(self, state, controller, t):
        """Take these back from a World."""
        ctypes.memmove(byref(self._state), byref(state), ctypes.sizeof(State))
        ctypes.memmove(byref(self._controller), byref(controller), ctypes.sizeof(Controller))
        self.t = t

    def finish(self, status):
        """Raise what the flow has raised, or why the core could not go on."""
        self._flow.raise_again()
        check(status, f" (cell {self.id}, t = {self.t:g} s, x = {self.x} m)")
