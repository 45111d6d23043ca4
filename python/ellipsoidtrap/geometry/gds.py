# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""Polygons and labels of a GDS layout, its references put in, by gdspy."""

import contextlib
import io
import warnings

import gdspy

from .shapes import Drawing, Shape, Text


def layers_of(layer, datatype):
    """What a layer may be called: both numbers, or the first alone."""
    return f"{layer}/{datatype}", str(layer)


def read(file, unit, cell):
    """The drawing: of the cell that is named, or the only one that no other holds; if there are
    several, their names. Lengths are multiplied by the unit, or by that of the file."""
    # Words about what is of no use here
    with warnings.catch_warnings(), contextlib.redirect_stderr(io.StringIO()):
        warnings.simplefilter("ignore")
        library = gdspy.GdsLibrary(infile=file, units="import")
    known = getattr(library, "cells", None) or library.cell_dict     # older versions call it so
    for one in known.values():
        # Of a single point, which some programs write, nothing is drawn
        one.paths = [path for path in one.paths if len(path.points) > 1]
    cells = {one.name: one for one in library.top_level()}
    if cell is not None:
        cells = {name: one for name, one in known.items() if name == cell} or known
    if len(cells) != 1:
        return list(cells)
    (top,) = cells.values()
    unit = 1e6*library.unit if unit is None else unit
    found = top.get_polygons(by_spec=True)
    shapes = [
        Shape(layers_of(*spec), [(unit*float(x), unit*float(y)) for x, y in (*points, points[0])], None)
        for spec, some in found.items() for points in some
    ]
    texts = [
        Text(layers_of(one.layer, one.texttype), one.text.strip(), tuple(unit*float(v) for v in one.position))
        for one in top.get_labels()
    ]
    return Drawing(shapes, texts, sorted("{}/{}".format(*spec) for spec in found), False)
