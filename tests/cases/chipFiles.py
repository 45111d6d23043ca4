# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""STL files as CAD programs write them, of the walls that makeGeometry wrote, and their sizes.

usage: chipFiles.py cad FROM TO         in millimetres, with floor and ceiling, in any order and sense, and capitals
       chipFiles.py body FROM TO        the same as one body in a binary file, with some bytes behind
       chipFiles.py apart FROM FOLDER   a file for each region, named by it
       chipFiles.py areas               of the patches of the mesh in the present folder [um2]
"""

import random
import re
import struct
import sys

DEPTH = 10


def regions(file):
    """Name to the corners of its triangles, in threes, two triangles a wall."""
    with open(file, encoding="ascii") as source:
        parts = re.split(r"(?m)^solid ", source.read())[1:]
    return {part.split()[0]: [tuple(map(float, p)) for p in re.findall(r"vertex (\S+) (\S+) (\S+)", part)]
            for part in parts}


def drawn_out(points):
    """Triangles of walls cut in two along z, with some of floor and ceiling, in millimetres."""
    triangles = []
    for (x0, y0, _), (x1, y1, _) in ((points[i], points[i + 1]) for i in range(0, len(points), 6)):
        for low, high in ((0, 0.4*DEPTH), (0.4*DEPTH, DEPTH)):
            a, b, c, d = (x0, y0, low), (x1, y1, low), (x1, y1, high), (x0, y0, high)
            triangles += [[a, b, c], [c, d, a]]
        triangles += [[(x0, y0, z), (x1, y1, z), (0.1, 0.2, z)] for z in (0, DEPTH)]
    random.shuffle(triangles)
    for one in triangles:
        random.shuffle(one)
    return [[tuple(1e-3*v for v in point) for point in one] for one in triangles]


def write(file, name, triangles):
    """Add a region to an ASCII file."""
    with open(file, "a", encoding="ascii") as out:
        out.write(f"SOLID {name}\n")
        for one in triangles:
            out.write("FACET NORMAL 0 0 1\nOUTER LOOP\n")
            out.writelines("VERTEX {:.9E} {:.9E} {:.9E}\n".format(*point) for point in one)
            out.write("ENDLOOP\nENDFACET\n")
        out.write(f"ENDSOLID {name}\n")


def areas():
    """A line for each patch."""
    from ellipsoidtrap.pictures.case import Case
    from vtkmodules.vtkFiltersCore import vtkMassProperties, vtkTriangleFilter
    case = Case(".")
    for name in case.patches:
        area = 0
        for piece in case.patch_surfaces(name):
            split, mass = vtkTriangleFilter(), vtkMassProperties()
            split.SetInputData(piece)
            mass.SetInputConnection(split.GetOutputPort())
            area += 1e12*mass.GetSurfaceArea()
        print(f"{name} {area:.2f}")


what, *files = sys.argv[1:]
random.seed(3)
if what == "areas":
    areas()
elif what == "cad":
    for region, corners in regions(files[0]).items():
        write(files[1], region, drawn_out(corners))
elif what == "apart":
    for region, corners in regions(files[0]).items():
        write(f"{files[1]}/{region}.stl", "Exported from CAD-1.2", [corners[i:i + 3] for i in range(0, len(corners), 3)])
else:
    body = [one for corners in regions(files[0]).values() for one in drawn_out(corners)]
    with open(files[1], "wb") as out:
        out.write(b"solid of no name".ljust(80) + struct.pack("<I", len(body)))
        for one in body:
            out.write(struct.pack("<12fH", 0, 0, 1, *(v for point in one for v in point), 0))
        out.write(b"\0"*12)
