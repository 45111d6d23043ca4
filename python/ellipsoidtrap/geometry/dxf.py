# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""Lines and texts of a DXF drawing, its blocks put in, by ezdxf."""

import logging
import math

import ezdxf
from ezdxf import path, recover, units
from ezdxf.math import X_AXIS, Y_AXIS, Matrix44, Vec3

from . import rings
from .shapes import CIRCLE_SIDES, Drawing, Shape, Text

# What says something about the drawing, and bounds nothing
PASSED_OVER = ("POINT", "DIMENSION", "LEADER", "MULTILEADER", "VIEWPORT", "ATTDEF", "ATTRIB")


def entities(some, matrix, hidden, layer=None, blocks=()):
    """Entities of a layout or block that are seen, each with the matrix to the drawing and its layer; those of inserted blocks
    in their place. Layer 0 of a block is that of its insert. What is hidden: of each layer whether it is frozen, or else off,
    which does not hide what an insert on it has on other layers."""
    for entity in some:
        own = layer if layer and entity.dxf.layer == "0" else entity.dxf.layer
        frozen = hidden.get(own.casefold())
        if frozen or entity.dxf.invisible:
            continue
        if entity.dxftype() != "INSERT":
            if frozen is None:
                yield entity, matrix, own
            continue
        name = entity.dxf.name
        if name in blocks:
            raise ValueError(f"block {name} holds itself")
        for one in entity.multi_insert() if entity.mcount > 1 else (entity,):
            if one.block() is not None:
                yield from entities(one.block(), one.matrix44()*matrix, hidden, own, (*blocks, name))


def sides_of(radius, tolerance):
    """Sides of the polygon of a circle that is nowhere farther off than the tolerance."""
    return max(CIRCLE_SIDES, math.ceil(math.pi/math.acos(1 - min(tolerance/radius, 1))))


def lines_of(entity, tolerance):
    """The lines of an entity as points, in its own coordinates; None if it has none."""
    kind = entity.dxftype()
    if kind == "CIRCLE":
        center, radius = entity.ocs().to_wcs(entity.dxf.center), entity.dxf.radius
        if not radius > 0:
            return []
        points = rings.circle(center.x, center.y, radius, sides_of(radius, tolerance))
        return [[Vec3(point) for point in points + points[:1]]]
    if kind in ("SOLID", "TRACE", "3DFACE"):
        return [entity.wcs_vertices(close=True)]
    try:
        paths = list(path.from_hatch(entity)) if kind in ("HATCH", "MPOLYGON") else [path.make_path(entity)]
    except TypeError:
        return None
    return [list(one.flattening(tolerance, 4)) for one in paths if len(one)]


def place_of(text):
    """Where a text stands, in the coordinates of the drawing or of its block: if it is centred, say, its second point."""
    if text.dxftype() == "MTEXT":
        return text.dxf.insert
    second = text.dxf.hasattr("align_point") and (text.dxf.halign in (1, 2, 4) or text.dxf.valign)
    return text.ocs().to_wcs(text.dxf.align_point if second else text.dxf.insert)


def read(file, unit, tolerance):
    """The drawing; lengths are multiplied by the unit, or by that which the file tells, None if neither does."""
    logging.getLogger("ezdxf").setLevel(logging.ERROR)
    try:
        document = ezdxf.readfile(file)
    except ezdxf.DXFStructureError:
        document, _ = recover.readfile(file)
    if unit is None and document.units:
        unit = 1e6*units.conversion_factor(document.units, units.M)
    if unit is None:
        return None
    shapes, texts = [], []
    unseen = [one for one in document.layers if one.is_off() or one.is_frozen()]
    hidden = {one.dxf.name.casefold(): one.is_frozen() for one in unseen}
    for entity, matrix, layer in entities(document.modelspace(), Matrix44.scale(unit), hidden):
        kind = entity.dxftype()
        if kind in ("TEXT", "MTEXT"):
            place = matrix.transform(place_of(entity))
            texts.append(Text((layer,), entity.plain_text().strip(), (place.x, place.y)))
        elif kind not in PASSED_OVER:
            stretch = max(matrix.transform_direction(axis).magnitude for axis in (X_AXIS, Y_AXIS))
            lines = lines_of(entity, tolerance/stretch)
            trouble = f"a {kind} is no outline: draw it by lines, arcs or polylines" if lines is None else None
            if getattr(entity, "has_width", False):
                trouble = f"a {kind} has a width: draw its outline"
            shapes += [Shape((layer,), [tuple(p.vec2) for p in matrix.transform_vertices(points)], trouble)
                       for points in lines or ([[]] if trouble else [])]
    return Drawing(shapes, texts, sorted({one.layers[0] for one in shapes + texts})
                   + [f"{one.dxf.name} (off or frozen)" for one in unseen], True)
