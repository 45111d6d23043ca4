# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""Drawings for drawing.test, written by ezdxf and gdspy, and what their plans must be.

usage: drawings.py FILE...        writes the drawings, of DXF each by the function of its name
       drawings.py plan           area of the plan and length of every patch, of the files of makeGeometry
"""

import math
import os
import re
import sys
from pathlib import Path


def dxf(unit=13):
    """A new drawing and its model space; 13: in micrometres, 4: in millimetres, 0: it does not tell."""
    import ezdxf

    document = ezdxf.new("R2010")
    document.header["$INSUNITS"] = unit
    return document, document.modelspace()


def closed(space, layer, points, **more):
    """A closed polyline."""
    space.add_lwpolyline(points, close=True, dxfattribs={"layer": layer}, **more)


def text(space, words, place):
    """A name."""
    space.add_text(words, dxfattribs={"layer": "NAMES", "insert": place, "height": 1})


def channel(space, scale=1.0):
    """A channel of 20 by 40 with names at its ends."""
    closed(space, "FLUID", [(-10*scale, -20*scale), (10*scale, -20*scale), (10*scale, 20*scale), (-10*scale, 20*scale)])
    text(space, "inlet", (0, -20*scale))
    text(space, "outlet", (1*scale, 20.5*scale))


def curves(file):
    """In millimetres: an outline of loose lines and half a circle, their ends 1 nm apart, which swells at the side; in
    it an ellipse, a spline, a polyline with arcs, a hatch, an arc closed by a line."""
    document, space = dxf(4)
    mm = 1e-3

    def line(x0, y0, x1, y1, layer="FLUID"):
        space.add_line((x0*mm, y0*mm), (x1*mm, y1*mm), dxfattribs={"layer": layer})

    line(-10, -20, 10, -20)
    line(10.001, -20, 10, -5)
    space.add_arc((10*mm, 0), 5*mm, -90, 90, dxfattribs={"layer": "FLUID"})
    line(10, 5, 10, 20)
    line(10, 20, -10, 20)
    line(-10, 20.001, -10, -20)
    space.add_ellipse((0, 8*mm), (3*mm, 0), 0.5, dxfattribs={"layer": "POSTS"})
    closed(space, "POSTS", [(-6*mm, -14*mm, 0, 0, 1), (-2*mm, -14*mm, 0, 0, 1)])      # two half circles
    # A circle as a rational spline, of four quarters
    around = [(2, 0), (2, 2), (0, 2), (-2, 2), (-2, 0), (-2, -2), (0, -2), (2, -2), (2, 0)]
    spline = space.add_spline(degree=2, dxfattribs={"layer": "SPLINE"})
    spline.set_open_rational([((5 + x)*mm, (y - 12)*mm) for x, y in around], [1, math.sqrt(0.5)]*4 + [1], 2)
    spline.knots = [0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4]
    hatch = space.add_hatch(dxfattribs={"layer": "POSTS"})
    hatch.paths.add_polyline_path([(-8*mm, 0), (-4*mm, 0), (-4*mm, 4*mm), (-8*mm, 4*mm)], is_closed=True)
    space.add_arc((4*mm, 0), 2*mm, 0, 180, dxfattribs={"layer": "POSTS"})
    line(2, 0, 6, 0, "POSTS")
    text(space, "inlet", (0, -20*mm))
    text(space, "outlet", (0, 20*mm))
    document.saveas(file)


def blocks(file):
    """Blocks in blocks, turned, mirrored, scaled, and an array; entities of layer 0 are of the insert's layer. Names that are
    centred, underlined and mirrored, what has no extent, and what is hidden: layers that are off or frozen, a block on either,
    and the other shape of a block with two."""
    document, space = dxf()
    document.layers.add("OFF").off()
    document.layers.add("FROZEN").freeze()
    document.blocks.new("HIDDEN").add_circle((0, 0), 3, dxfattribs={"layer": "TRAP1"})
    space.add_blockref("HIDDEN", (0, 0), dxfattribs={"layer": "FROZEN"})
    space.add_blockref("HIDDEN", (0, 0), dxfattribs={"layer": "FLUID", "color": 77})
    space.add_circle((0, 0), 3, dxfattribs={"layer": "TRAP2", "color": 77})
    space.add_circle((0, 0), 3, dxfattribs={"layer": "OFF"})
    closed(space, "FLUID", [(-10, -20), (10, -20), (10, 20), (-10, 20)])
    space.add_text("%%uinlet", dxfattribs={
        "layer": "NAMES", "insert": (0, 0), "halign": 1, "valign": 2, "align_point": (0, -20)})
    text(space, "outlet", (1, 20.5))
    text(space, "left", (-10, 9))
    space.add_text("right", dxfattribs={"layer": "NAMES", "insert": (-10, 9), "extrusion": (0, 0, -1)})
    space.add_circle((0, 0), 0, dxfattribs={"layer": "FLUID"})
    space.add_lwpolyline([(5, 5)], dxfattribs={"layer": "FLUID"})
    post = document.blocks.new("POST")
    closed(post, "0", [(0, 0), (2, 0), (2, 1)])
    pair = document.blocks.new("PAIR")
    pair.add_blockref("POST", (0, 0), dxfattribs={"layer": "0"})
    pair.add_blockref("POST", (0, 3), dxfattribs={"layer": "POSTS", "rotation": 90})
    space.add_blockref("PAIR", (-6, -10), dxfattribs={"layer": "TRAP1"})
    space.add_blockref("PAIR", (5, -10), dxfattribs={"layer": "TRAP2", "xscale": -1, "yscale": 2})
    seen = document.blocks.new("SEEN")
    closed(seen, "posts", [(4, 14), (6, 14), (6, 16), (4, 16)])
    closed(seen, "0", [(3, 13), (7, 13), (7, 17), (3, 17)])
    space.add_blockref("SEEN", (0, 0), dxfattribs={"layer": "OFF"})
    space.add_blockref("POST", (-6, 6), dxfattribs={
        "layer": "TRAP1", "column_count": 3, "row_count": 2, "column_spacing": 4, "row_spacing": 4})
    document.saveas(file)
    # ezdxf writes no 60, which makes an entity invisible
    path = Path(file)
    whole, count = re.subn(r"\n *62\n *77\n", "\n 60\n1\n", path.read_text())
    assert count == 2
    path.write_text(whole)


def walls(file):
    """A step of the wall and an island that are solid, lines that name a part of the wall, and a shape over the outlet."""
    document, space = dxf()
    closed(space, "FLUID", [(-10, -20), (10, -20), (10, 20), (-10, 20)])
    closed(space, "TRAP", [(-12, 0), (-6, 0), (-6, 4), (-12, 4)])
    closed(space, "TRAP", [(-4, 0), (0, 0), (0, 4), (-4, 4)])
    closed(space, "FLUID", [(3, -10), (6, -10), (6, -6), (3, -6)])      # a hole of the fluid
    text(space, "G2", (4, -8))
    space.add_line((10, -3), (10, 3), dxfattribs={"layer": "WINDOW"})
    space.add_line((-10, -20), (10, -20), dxfattribs={"layer": "IN"})
    closed(space, "OUT", [(-11, 19), (11, 19), (11, 22), (-11, 22)])
    document.saveas(file)


def joined(file):
    """A chamber that three channels meet, and one more device."""
    document, space = dxf()
    space.add_circle((0, 0), 12, dxfattribs={"layer": "fluid"})
    closed(space, "FLUID", [(-4, -40), (4, -40), (4, -5), (-4, -5)])
    closed(space, "FLUID", [(-4, 5), (4, 5), (4, 40), (-4, 40)])
    closed(space, "FLUID", [(90, 0), (99, 0), (99, 9), (90, 9)])
    document.saveas(file)


def faults(file):
    """What a drawing may have wrong, each on layers of its own."""
    document, space = dxf(0)
    channel(space)
    for x in (-12, 0):
        space.add_line((x, -25), (x + 11.7, -25), dxfattribs={"layer": "OPEN"})
    for start, end in (((11.7, -25), (11.7, 25)), ((11.7, 25), (-12, 25)), ((-12, 25), (-12, -25))):
        space.add_line(start, end, dxfattribs={"layer": "OPEN"})
    closed(space, "ONE", [(-5, 0), (0, 0), (0, 4), (-5, 4)])
    closed(space, "TWO", [(-1, 3), (3, 3), (3, 8), (-1, 8)])
    closed(space, "BOWTIE", [(-5, 0), (0, 4), (0, 0), (-5, 4)])
    closed(space, "THIN", [(-5, 0), (5, 0), (5, 0.1), (-5, 0.1)])
    closed(space, "ACROSS", [(-12, 0), (12, 0), (12, 2), (-12, 2)])
    closed(space, "AWAY", [(20, 0), (22, 0), (22, 2), (20, 2)])
    closed(space, "NEAR", [(8, 0), (9.9, 0), (9.9, 2), (8, 2)])
    space.add_line((20, 0), (30, 0), dxfattribs={"layer": "LINE"})
    space.add_lwpolyline([(0, -20), (0, 20)], dxfattribs={"layer": "WIDE", "const_width": 3})
    space.add_text("G9", dxfattribs={"layer": "LOST", "insert": (0, 0)})
    document.saveas(file)


def layout(file):
    """In GDS: a layer of fluid in two cells that touch, with a hole by a cut; posts as an array of references to a cell that is
    turned; a path; labels."""
    import gdspy

    library = gdspy.GdsLibrary(unit=1e-6, precision=1e-9)
    top, half, post, other = (gdspy.Cell(name, exclude_from_current=True) for name in ("TOP", "HALF", "POST", "OTHER"))
    library.add([top, half, post])
    half.add(gdspy.Rectangle((-10, 0), (10, 20), layer=1))
    post.add(gdspy.Round((0, 0), 1, number_of_points=60, layer=2))
    top.add(gdspy.CellReference(half, (0, 0)))
    top.add(gdspy.CellReference(half, (0, 0), rotation=180))
    top.add(gdspy.Rectangle((-2, -2), (2, 2), layer=1))       # within the fluid: no hole in GDS
    top.add(gdspy.CellArray(post, 3, 2, (5, 6), (-5, 6)))
    top.add(gdspy.FlexPath([(-5, -10), (5, -10)], 1, layer=2, datatype=3))
    # Nothing, as some programs write it
    top.add(gdspy.FlexPath([(5, 5)], 0.2, layer=1, gdsii_path=True))
    top.add(gdspy.Label("inlet", (0, -20), layer=9))
    top.add(gdspy.Label("outlet", (0, 20), layer=9))
    if "two" in file:
        other.add(gdspy.Rectangle((0, 0), (1, 1), layer=1))
        library.add(other)
    if "keyhole" in file:
        top.add(gdspy.boolean(gdspy.Rectangle((3, -18), (9, -12), layer=2), gdspy.Rectangle((4, -17), (8, -13)), "not", layer=5))
    library.write_gds(file)


def plan():
    """What is said above."""
    with open("constant/generated/plan", encoding="ascii") as file:
        print("area", re.search(r"area +(\S+);", file.read())[1])
    lengths = {}
    with open("constant/triSurface/walls.stl", encoding="ascii") as file:
        for part in file.read().split("endsolid")[:-1]:
            name = re.search(r"solid (\S+)", part)[1]
            points = [tuple(map(float, p)) for p in re.findall(r"vertex (\S+) (\S+)", part)]
            # Of the two triangles of an edge the first has the edge as its first side
            lengths[name] = sum(math.dist(*points[i:i + 2]) for i in range(0, len(points), 6))
    for name in sorted(lengths):
        print(f"{name} {lengths[name]:.4f}")


if sys.argv[1] == "plan":
    plan()
else:
    for made in sys.argv[1:]:
        name, suffix = os.path.splitext(os.path.basename(made))
        (layout if suffix == ".gds" else globals()[name])(made)
