# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""The plan in STL files of a device's walls, or of the fluid as a closed body."""

import itertools
import math
import os
import re
import struct

from .rings import TOUCH
from .surfaces import SURFACES

WALLS = "walls.stl"
VERTEX = re.compile(r"(?i)vertex\s+" + r"\s+".join([r"([-+.\deE]+)"]*3))


def triangles(top, file):
    """(region, corners) of an STL file; the region is None where it has no name."""
    if os.path.realpath(file) == os.path.realpath(f"{SURFACES}/{WALLS}"):
        top.fail(f"'stl': {file} is written by makeGeometry: rename yours")
    try:
        with open(file, "rb") as source:
            data = source.read()
    except OSError as error:
        top.fail(f"'stl': cannot read {file}: {error.strerror or error}")
    # Header, number, 50 bytes each: normal, three corners, attribute. Some programs write more; of a text
    # the number would be above 5e8
    end = 84 + 50*struct.unpack_from("<I", data, 80)[0] if len(data) > 84 else 0
    if 84 < end <= len(data):
        for numbers in struct.iter_unpack("<12fH", data[84:end]):
            yield None, [numbers[3:6], numbers[6:9], numbers[9:12]]
        return
    text = data.decode("latin-1")
    if not re.match(r"(?i)\s*solid\b", text) or not VERTEX.search(text):
        top.fail(f"'stl': {file} is no STL")
    for part in re.split(r"(?mi)^\s*solid\b", text)[1:]:
        region = part.split("\n", 1)[0].strip() or None
        points = [tuple(map(float, found)) for found in VERTEX.findall(part)]
        for i in range(0, len(points) - 2, 3):
            yield region, points[i:i + 3]


def read(top, patch):
    """(patch, corners) of all triangles: of one file, whose regions are patches if none is given for
    all of them, or of a file for each patch."""
    if isinstance(top.get("stl"), dict):
        files = top.sub("stl")
        return [(name, corners) for name in files.entries for _, corners in triangles(top, files.path(name))]
    file = top.path("stl")
    found = [(patch or region, corners) for region, corners in triangles(top, file)]
    if any(name is None for name, _ in found):
        top.fail(f"'stl': {file} holds no names of regions: give outline {{ patch NAME; edges {{ ... }} }}, "
                 "or a file for each patch")
    return found


def segments(top, patch):
    """(patch, start, end) of the walls' edges at the lowest z; triangles that lie flat are floor and
    ceiling."""
    scale = top.number("stlScale") if "stlScale" in top else 1.0
    scaled = [(name, [tuple(scale*v for v in point) for point in corners]) for name, corners in read(top, patch)]
    heights = [point[2] for _, triangle in scaled for point in triangle]
    low, high = min(heights), max(heights)
    if high - low < TOUCH:
        top.fail("'stl': it is flat: its walls must be drawn out along z")
    found = {}
    for name, triangle in scaled:
        if max(p[2] for p in triangle) - min(p[2] for p in triangle) < TOUCH:
            continue
        (ax, ay, _), (bx, by, _), (cx, cy, _) = triangle
        longest = max(math.dist(p[:2], q[:2]) for p, q in itertools.combinations(triangle, 2))
        if abs((bx - ax)*(cy - ay) - (by - ay)*(cx - ax)) > TOUCH*longest:
            top.fail(f"'stl': a triangle of {name} at ({ax:.6g} {ay:.6g}) is neither upright nor flat: "
                     "walls must be along z")
        for p, q in zip(triangle, triangle[1:] + triangle[:1]):
            if max(p[2], q[2]) < low + TOUCH and math.dist(p[:2], q[:2]) > TOUCH:
                other = found.setdefault(frozenset((p[:2], q[:2])), (name, p[:2], q[:2]))[0]
                if other != name:
                    top.fail(f"'stl': the walls {other} and {name} lie on one another at ({p[0]:.6g} {p[1]:.6g})")
    return list(found.values())
