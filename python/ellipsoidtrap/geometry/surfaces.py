# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam.
#
# ellipsoidTrapFoam is free software: you can redistribute it and/or modify it
# under the terms of the GNU General Public License as published by the Free
# Software Foundation, either version 3 of the License, or (at your option) any
# later version. It comes with ABSOLUTELY NO WARRANTY; see the file COPYING.
"""What the makeGeometry scripts write: walls and boxes as STL, and the fragments that the
dictionaries of the mesh tools include."""

import math
import os

SURFACES, FRAGMENTS = "constant/triSurface", "constant/generated"


def curtain(line, low, high):
    """Triangles of a polyline drawn out in z."""
    for (x0, y0), (x1, y1) in zip(line, line[1:]):
        a, b, c, d = (x0, y0, low), (x1, y1, low), (x1, y1, high), (x0, y0, high)
        yield a, b, c
        yield a, c, d


def box(x0, x1, y0, y1, z0, z1):
    """Triangles of a closed box."""
    yield from curtain([(x0, y0), (x1, y0), (x1, y1), (x0, y1), (x0, y0)], z0, z1)
    for z, turn in ((z0, -1), (z1, 1)):
        a, b, c, d = [(x0, y0, z), (x1, y0, z), (x1, y1, z), (x0, y1, z)][::turn]
        yield a, b, c
        yield a, c, d


def through(base):
    """Between which z the walls are drawn: the slab that snappyHexMesh cuts is one base cell
    thick; they reach through it so that no edge of theirs lies inside."""
    return -base, 2*base


def slab(bounds, base):
    """The slab's size: grid planes through the origin, one spare cell around the device."""
    entries = {}
    for axis, (low, high) in zip("xy", bounds):
        first, last = math.floor(low/base) - 1, math.ceil(high/base) + 1
        entries.update({f"{axis}Min": first*base, f"{axis}Max": last*base, f"n{axis}": last - first})
    return entries


def aperture_entry(name, low, high, axis, area):
    """Of occupancy in ellipsoidCloudProperties: the section across an axis in the middle of a box
    with these corners, through which the flux is reported."""
    corners = ("({:.9g} {:.9g} {:.9g})".format(*(1e-6*v for v in corner)) for corner in (low, high))
    normal = ("(1 0 0)", "(0 1 0)")[axis]
    return "{} {{ min {}; max {}; normal {}; area {:.9g}; }}\n".format(name, *corners, normal, 1e-12*area)


class Output:
    """The folders constant/triSurface and constant/generated of the case."""

    def __init__(self, parameters):
        self.source = os.path.basename(parameters)
        os.makedirs(SURFACES, exist_ok=True)
        os.makedirs(FRAGMENTS, exist_ok=True)

    @staticmethod
    def stl(name, regions):
        """A surface: region name to triangles. What we have not written gets another name."""
        file = f"{SURFACES}/{name}"
        if os.path.exists(file) and not os.path.exists(f"{FRAGMENTS}/chosen"):
            to, n = file + ".bak", 1
            while os.path.exists(to):
                n += 1
                to = f"{file}.bak{n}"
            os.rename(file, to)
            print(f"keeping {os.path.abspath(file)} as {os.path.basename(to)}")
        with open(file, "w", encoding="ascii") as out:
            for region, triangles in regions.items():
                out.write(f"solid {region}\n")
                for triangle in triangles:
                    out.write(" facet normal 0 0 0\n  outer loop\n")
                    for point in triangle:
                        out.write("   vertex {:.9g} {:.9g} {:.9g}\n".format(*point))
                    out.write("  endloop\n endfacet\n")
                out.write(f"endsolid {region}\n")

    def text(self, name, text):
        """A fragment."""
        with open(f"{FRAGMENTS}/{name}", "w", encoding="ascii") as out:
            out.write(f"// Written by makeGeometry from {self.source}\n" + text)

    def entries(self, name, entries):
        """A fragment of numbers."""
        self.text(name, "".join(f"{key:<15} {value:.10g};\n" for key, value in entries.items()))
