# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""The shared library of the core, and its structs that Python fills or reads (src/ellipsoid/ellipsoid.h).

tests/setup/fromPython.test holds the structs against those of the headers.
"""

import contextlib
import ctypes
import fcntl
import os
import subprocess
from ctypes import CFUNCTYPE, POINTER, Structure, c_char_p, c_double, c_int, c_long, c_size_t, c_uint32, c_uint64, c_void_p
from pathlib import Path

VERSION = "0.1"         # of the library: the structs below are those of this one
NAME = f"libellipsoid.so.{VERSION}"
SOURCES = Path(__file__).resolve().parents[3] / "src" / "ellipsoid"
HELP = (f"The module needs {NAME}: work in the source tree, where it is built; or install it by 'make -C src/ellipsoid"
        " install PREFIX=...' and let PKG_CONFIG_PATH name PREFIX/lib/pkgconfig; or let ELLIPSOID_LIBRARY name the file.")

vector = c_double * 3
matrix = vector * 3


class CoreError(RuntimeError):
    """The core could not go on; `status` is the name of the reason, such as OUTSIDE."""

    def __init__(self, status, text):
        super().__init__(text)
        self.status = status


class FlowSample(Structure):
    _fields_ = [("velocity", vector), ("gradient", matrix), ("pressure_gradient", vector), ("local_acceleration", vector),
                ("velocity_jacobian", matrix), ("gradient_jacobian", matrix * 3), ("pressure_jacobian", matrix),
                ("acceleration_jacobian", matrix)]


class State(Structure):
    _fields_ = [("u", vector), ("x", vector), ("omega", vector), ("q", c_double * 4)]


class Controller(Structure):
    _fields_ = [("step", c_double), ("previous_error", c_double)]


class Statistics(Structure):
    _fields_ = [("accepted", c_long), ("rejected", c_long), ("rhs", c_long), ("jacobians", c_long), ("deepest", c_double)]


FlowFunction = CFUNCTYPE(c_int, c_void_p, c_double, POINTER(vector), c_int, POINTER(FlowSample))


class Surroundings(Structure):
    _fields_ = [("flow", FlowFunction), ("flow_context", c_void_p), ("walls", c_void_p), ("walls_context", c_void_p),
                ("velocities", c_void_p), ("field", c_void_p), ("field_context", c_void_p), ("force", c_void_p),
                ("force_context", c_void_p), ("force_depends_on_velocity", c_int), ("unsteady", c_int),
                ("repeat", c_void_p), ("repeat_count", c_int), ("fixed", c_int),
                ("time", c_double), ("seed", c_uint64), ("id", c_uint32)]


class Member(Structure):
    _fields_ = [("model", c_void_p), ("surroundings", POINTER(Surroundings)), ("state", POINTER(State)),
                ("controller", POINTER(Controller)), ("cache", c_void_p), ("observer_context", c_void_p),
                ("statistics", POINTER(Statistics))]


class Contact(Structure):
    _fields_ = [("force", vector), ("torque", vector), ("deepest", c_double), ("gap", c_double), ("slip", c_double), ("bead_contacts", c_int),
                ("surface_count", c_int), ("surface", c_int * 8), ("cell_force", vector), ("cell_torque", vector),
                ("cell_deepest", c_double), ("cell_gap", c_double), ("cell_slip", c_double), ("cell_count", c_int), ("cell_id", c_uint32 * 8)]


class Option(Structure):
    _fields_ = [("type", c_int), ("offset", c_size_t)] \
        + [(name, c_char_p) for name in ("member", "section", "entry", "unit", "default_text", "range", "meaning")] \
        + [("words", POINTER(c_char_p)), ("low", c_double), ("high", c_double), ("above", c_int), ("related", c_int),
           ("needs", c_int)]


def run(*command):
    """What a command prints, or None; and what it says of a failure."""
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    except OSError as error:
        return None, str(error)
    return (None if done.returncode else done.stdout.strip()), done.stderr.strip()


@contextlib.contextmanager
def locked(folder):
    """Programs that start at once build one after the other."""
    handle = os.open(folder, os.O_RDONLY)
    try:
        fcntl.flock(handle, fcntl.LOCK_EX)
        yield
    finally:
        os.close(handle)


def path():
    """Of the library: that of ELLIPSOID_LIBRARY, of the source tree that this file is in, of pkg-config, or of the system."""
    named = os.environ.get("ELLIPSOID_LIBRARY")
    if named:
        return named
    if (SOURCES / "Makefile").exists():
        with locked(SOURCES):
            built, why = run("make", "-s", "-C", str(SOURCES), "shared")
        if built is None:
            raise ImportError(f"make -C {SOURCES} shared: {why}")
        return str(SOURCES / "build" / NAME)
    folder, _ = run("pkg-config", "--variable=libdir", "ellipsoid")
    return str(Path(folder) / NAME) if folder else NAME


def load():
    """The library, or an ImportError that says what to do."""
    where = path()
    try:
        library = ctypes.CDLL(where)
        library.ellipsoid_version.restype = c_char_p
        version = library.ellipsoid_version().decode()
    except (OSError, AttributeError) as error:
        raise ImportError(f"{error}. {HELP}") from None
    if version.rsplit(".", 1)[0] != VERSION:
        raise ImportError(f"{where} is the core's version {version}. {HELP}")
    return library


def declare(library):
    """Results that are no int, and arguments that are no pointer."""
    library.ellipsoid_status_text.restype = library.ellipsoid_status_name.restype = c_char_p
    library.ellipsoid_option_list.restype = POINTER(Option)
    library.ellipsoid_model_size.restype = c_size_t
    library.ellipsoid_facet_cache_size.restype = c_size_t
    library.ellipsoid_advance.argtypes = [POINTER(Member), POINTER(c_double), c_double, c_void_p]
    library.ellipsoid_balance.argtypes = [c_void_p, POINTER(Surroundings), POINTER(State), c_void_p]
    library.ellipsoid_contact_evaluate.argtypes = [c_void_p, POINTER(Surroundings), POINTER(State), c_void_p,
                                                   POINTER(Contact), c_void_p]
    return library


core = declare(load())


def check(status, where=""):
    """Raises a CoreError unless a call succeeded."""
    if status != 0:
        raise CoreError(core.ellipsoid_status_name(status).decode(), core.ellipsoid_status_text(status).decode() + where)


def checked_end(end, t):
    """The time to which a cell is to go on from the time t."""
    if not t <= float(end) < float("inf"):
        raise ValueError(f"end = {float(end)} s: allowed is {t:g} s or later")
    return float(end)
