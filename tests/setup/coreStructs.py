#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""Prints a C program that compares the structs of ellipsoidtrap.core with those of the headers: it writes what differs
and fails. --planted moves one member."""

import sys

from ellipsoidtrap.core import ellipsoid, library, walls, world
from ellipsoidtrap.core.options import Options

# Structs that Python makes itself are mirrored whole; of the others the start
WHOLE = {
    "ellipsoid_flow_sample": library.FlowSample, "ellipsoid_state": library.State,
    "ellipsoid_controller": library.Controller, "ellipsoid_statistics": library.Statistics,
    "ellipsoid_surroundings": library.Surroundings, "ellipsoid_member": library.Member,
    "ellipsoid_contact": library.Contact, "ellipsoid_option": library.Option, "ellipsoid_options": Options,
    "ellipsoid_triangles": walls.Triangles, "ellipsoid_walls_options": walls.WallsOptions,
    "ellipsoid_walls_context": walls.WallsContext, "ellipsoid_sweep": world.Sweep, "ellipsoid_world_body": world.Body,
    "ellipsoid_world_bodies": world.Bodies, "ellipsoid_world_cells": world.WorldCells,
}
START = {"ellipsoid_model": ellipsoid.ModelStart}

print('#include "ellipsoid.h"\n#include <stdio.h>\n')
print("static int differs(const char *what, size_t in_c, size_t in_python)\n{\n    if (in_c == in_python)\n        return 0;")
print('    printf("%s: %zu in C, %zu in Python\\n", what, in_c, in_python);\n    return 1;\n}\n\nint main(void)\n{\n    int wrong = 0;\n')
for name, mirror in (WHOLE | START).items():
    if name in WHOLE:
        print(f'    wrong += differs("{name}", sizeof({name}), {library.ctypes.sizeof(mirror)});')
    for member, *_ in mirror._fields_:
        offset = getattr(mirror, member).offset + ("--planted" in sys.argv and member == "q")
        size = getattr(mirror, member).size
        print(f'    wrong += differs("{name}.{member}", offsetof({name}, {member}), {offset});')
        print(f'    wrong += differs("size of {name}.{member}", sizeof((({name} *)0)->{member}), {size});')
major, minor = library.VERSION.split(".")
print(f'    wrong += differs("major version", ELLIPSOID_VERSION_MAJOR, {major});')
print(f'    wrong += differs("minor version", ELLIPSOID_VERSION_MINOR, {minor});')
print("    return wrong != 0;\n}")
