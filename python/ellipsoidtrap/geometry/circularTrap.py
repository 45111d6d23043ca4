# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam.
#
# ellipsoidTrapFoam is free software: you can redistribute it and/or modify it
# under the terms of the GNU General Public License as published by the Free
# Software Foundation, either version 3 of the License, or (at your option) any
# later version. It comes with ABSOLUTELY NO WARRANTY; see the file COPYING.
"""Write what the mesh tools need from constant/trapGeometry:

  constant/triSurface/walls.stl      device outline and sieves, one region each
  constant/triSurface/pockets.stl    boxes with a finer mesh
  constant/triSurface/apertures.stl  boxes with the finest mesh
  constant/generated/*               what the dictionaries include

usage: makeGeometry [-design NAME] [-resolution NAME]   (run in the case folder)
"""

import itertools
import math

from .entries import chosen, read
from .surfaces import Output, aperture_entry, box, curtain, slab, through

PARAMETERS = "constant/trapGeometry"
ARC_STEP = math.radians(1)  # chord 1.5 nm inside the arc at a radius of 40 um


# -- the shapes: closed polygons, origin at the throat entrance ----------------

def cup(d):
    """Solids, extent and width of the apertures, and extent of the pocket of a straight cup."""
    n, width, length = d.integer("apertures"), d.number("apertureWidth"), d.number("throatLength")
    bar = d.number("barWidth", strict=n > 1)
    depth, arm = d.number("pocketDepth"), d.number("armThickness")
    row = n*width + (n - 1)*bar
    pocket = d.number("pocketWidth") if "pocketWidth" in d.entries else row
    if pocket < row - 1e-9:
        d.fail(f"'{d.name}pocketWidth' {pocket:g} is less than the {row:g} of its apertures and bars")

    inner, outer, edge = pocket/2, pocket/2 + arm, row/2
    right = [(inner, -depth), (outer, -depth), (outer, length), (edge, length), (edge, 0)]
    if inner > edge + 1e-9:
        right.append((inner, 0))
    starts = [-edge + i*(width + bar) for i in range(n)]
    bars = [[(x + width, 0), (x + width + bar, 0), (x + width + bar, length), (x + width, length)]
            for x in starts[:-1]]
    return [mirror(right)] + bars + [right], (-edge, edge, length, n*width), (inner, depth)


def funnel(d):
    """The same of a funnel."""
    width, length = d.number("apertureWidth"), d.number("throatLength")
    mouth, depth, arm = d.number("mouthWidth"), d.number("funnelLength"), d.number("armThickness")
    if mouth <= width:
        d.fail(f"'{d.name}mouthWidth' must be above apertureWidth")
    inner, throat = mouth/2, width/2
    right = [(inner, -depth), (inner + arm, -depth), (throat + arm, length), (throat, length), (throat, 0)]
    return [mirror(right), right], (-throat, throat, length, width), (inner, depth)


def mirror(polygon):
    return [(-x, y) for x, y in reversed(polygon)]


def outline(c):
    """The device's own boundary as (patch, open polyline) pieces."""
    radius, half = c.number("radius"), c.number("channelWidth")/2
    if half >= radius:
        c.fail("'chamber.channelWidth' must be below the chamber's diameter")
    end, first = radius + c.number("channelLength"), math.asin(half/radius)
    n = math.ceil((math.pi - 2*first)/ARC_STEP)
    angles = [first + (math.pi - 2*first)*i/n for i in range(n + 1)]
    arc = [(radius*math.sin(a), -radius*math.cos(a)) for a in angles]
    side = [(half, -end)] + arc + [(half, end)]
    return [("inlet", [(-half, -end), (half, -end)]),
            ("chamber", side),
            ("outlet", [(half, end), (-half, end)]),
            ("chamber", mirror(side))]


def check_apart(sieves, solids):
    """Refuse sieves whose bounding boxes overlap."""
    points = [point for polygon in solids for point in polygon]
    width, height = (max(p[i] for p in points) - min(p[i] for p in points) for i in (0, 1))
    for a, b in itertools.combinations(sieves.entries, 2):
        (xa, ya), (xb, yb) = sieves.point(a), sieves.point(b)
        if abs(xa - xb) <= width and abs(ya - yb) <= height:
            sieves.fail(f"sieves {a} and {b} overlap: each is {width:g} wide and {height:g} long")


def make(words):
    """All of it, in the case folder."""
    options = chosen(words, __doc__, ("-design", "-resolution"))
    top = read(PARAMETERS)
    design_name = options["-design"] or top.get("design")
    design = top.sub("designs").choose(design_name)
    resolution = options["-resolution"] or top.get("resolution")
    mesh = top.sub("resolutions").choose(resolution)
    # A design may have a device of its own
    device = design if "sieves" in design else top
    chamber, sieves = device.sub("chamber"), device.sub("sieves")
    shapes = {"cup": cup, "funnel": funnel}
    shape = design.get("shape")
    if shape not in shapes:
        top.fail(f"'{design.name}shape' must be one of {' '.join(shapes)}: {shape}")

    solids, (left, right, length, width), (mouth, pocket) = shapes[shape](design)
    radius, depth = chamber.number("radius"), chamber.number("depth")
    base = mesh.number("baseSize")
    levels = {k: mesh.integer(k, 0)
              for k in ("chamberLevel", "pocketLevel", "sieveLevel", "apertureLevel")}
    finest = base/2**levels["apertureLevel"]

    low, high = through(base)
    walls, pockets, apertures, sections = {}, {}, {}, ""
    for patch, line in outline(chamber):
        walls.setdefault(patch, []).extend(curtain(line, low, high))
    for name in sieves.entries:
        x, y = sieves.point(name)
        walls[name] = []
        for polygon in solids:
            ring = [(x + px, y + py) for px, py in polygon]
            reach = max(math.hypot(*point) for point in ring)
            if reach >= radius:
                top.fail(f"sieve {name} reaches {reach:g} from the chamber's centre, through its wall")
            walls[name].extend(curtain(ring + ring[:1], low, high))
        pockets[name] = box(x - mouth, x + mouth, y - pocket, y, low, high)
        apertures[name] = box(x + left - finest, x + right + finest,
                              y - finest, y + length + finest, low, high)
        sections += aperture_entry(
            name, (x + left - finest, y, -1), (x + right + finest, y + length, depth + 1), 1, width*depth
        )
    check_apart(sieves, solids)

    out = Output(PARAMETERS)
    out.stl("walls.stl", walls)
    out.stl("pockets.stl", pockets)
    out.stl("apertures.stl", apertures)

    channel = chamber.number("channelLength")
    end = radius + channel
    out.entries("mesh", {
        **slab(((-radius, radius), (-end, end)), base),
        "slab": base, **levels,
        "insideX": 0.37*base, "insideY": -radius - 0.37*channel, "insideZ": 0.37*base,
        "depth": depth, "layers": mesh.integer("layers"),
    })
    out.entries("chamber", {key: chamber.number(key) for key in chamber.entries})
    out.text("chosen", f"design {design_name};\nresolution {resolution};\n")
    out.entries("inletPressure", {"inletPressure": design.number("inletPressure")})
    out.text("sieves", "".join(f"{name} {{ name {name}; }}\n" for name in sieves.entries))
    out.text("apertures", sections)

