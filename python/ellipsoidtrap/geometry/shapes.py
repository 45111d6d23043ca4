# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""From the lines of a drawing to the areas that they bound, by shapely. Lengths in micrometres."""

import math
from collections import namedtuple

from shapely.geometry import JOIN_STYLE, LineString, MultiLineString, MultiPoint, Point, Polygon
from shapely.ops import polygonize_full, snap, unary_union
from shapely.prepared import prep
from shapely.validation import explain_validity, make_valid

from .rings import TOUCH

CIRCLE_SIDES = 48   # at least

# What a reader gives: shapes, texts, the names of layers, and whether a shape within another of its layer is a
# hole, as in DXF, or part of it, as in GDS
Drawing = namedtuple("Drawing", "shapes texts layers holes")

# Points of a line, closed if the first is also the last; names of the layer; what is wrong with it, or None
Shape = namedtuple("Shape", "layers points trouble")

Text = namedtuple("Text", "layers words place")


class Trouble(Exception):
    """What is wrong with a drawing: a message, and the places."""

    def __init__(self, message, places):
        super().__init__(message)
        self.message, self.places = message, places


def parts(geometry, kind="Polygon"):
    """The polygons, or lines, of any geometry."""
    if geometry.is_empty:
        return []
    if geometry.geom_type == kind:
        return [geometry]
    return [one for part in getattr(geometry, "geoms", ()) for one in parts(part, kind)]


def is_closed(points):
    """Does a line end where it begins?"""
    return len(points) > 3 and math.dist(points[0], points[-1]) < TOUCH


def ends_joined(lines, reach):
    """Lines whose ends are moved onto one another where they are nearer than a length."""
    kept = {}

    def moved(point):
        column, row = (math.floor(v/reach) for v in point)
        for i in (column - 1, column, column + 1):
            for j in (row - 1, row, row + 1):
                for other in kept.get((i, j), ()):
                    if math.dist(point, other) <= reach:
                        return other
        kept.setdefault((column, row), []).append(point)
        return point

    return [[moved(line[0]), *line[1:-1], moved(line[-1])] for line in lines]


def closed_and_loose(lines, reach):
    """The areas that open lines bound together, and the lines that bound none."""
    lines = [line for line in ends_joined(lines, reach) if LineString(line).length > 0]
    if not lines:
        return [], []
    together = MultiLineString(lines)
    # An end may also lie on the middle of another line
    together = snap(together, MultiPoint([end for line in lines for end in (line[0], line[-1])]), reach)
    areas, *others = polygonize_full(unary_union(together))
    return [Polygon(one.exterior) for one in areas.geoms], [one for some in others for one in parts(some, "LineString")]


def ends_of(lines):
    """Where lines end that others do not go on from."""
    count = {}
    for line in lines:
        for end in (line.coords[0], line.coords[-1]):
            count[end] = count.get(end, 0) + 1
    return [end for end, n in count.items() if n == 1] or [line.coords[0] for line in lines]


def open_outline(layers, lines):
    """That lines of a layer bound nothing."""
    ends = ends_of(lines)
    first = ends[0]
    others = sorted(math.dist(first, other) for other in ends[1:])
    far = f", {others[0]:.4g} from the next open end" if others else ""
    return Trouble(f"lines of layer {' '.join(layers)} bound no area: {len(ends)} open end{'s'*(len(ends) > 1)}, one at "
                   f"({first[0]:.6g} {first[1]:.6g}){far}", ends)


def polygon_of(shape, mend):
    """The area in a closed line. Those of GDS touch themselves where they have holes."""
    polygon = Polygon(shape.points)
    if polygon.is_valid:
        return polygon
    if mend:
        return unary_union(parts(make_valid(polygon)))
    said = explain_validity(polygon)
    place = tuple(float(v) for v in said[said.index("[") + 1:said.index("]")].split()[:2])
    raise Trouble(f"an outline of layer {shape.layers[0]} crosses or touches itself at ({place[0]:.6g} {place[1]:.6g})",
                  [place])


def with_holes(areas):
    """Areas, joined where their outlines meet; what then lies within another one is a hole of it, and so on."""
    order = sorted(range(len(areas)), key=lambda i: areas[i].bounds[0])
    joined, outlines, active = list(range(len(areas))), {}, []

    def root(i):
        while joined[i] != i:
            i = joined[i]
        return i

    for i in order:
        box = areas[i].bounds
        active = [j for j in active if areas[j].bounds[2] >= box[0]]
        for j in active:
            other = areas[j].bounds
            if other[1] <= box[3] and other[3] >= box[1] and root(i) != root(j):
                if outlines.setdefault(j, prep(areas[j].boundary)).intersects(areas[i].boundary):
                    joined[root(i)] = root(j)
        active.append(i)
    groups = {}
    for i, area in enumerate(areas):
        groups.setdefault(root(i), []).append(area)
    merged = sorted((one for some in groups.values() for one in parts(unary_union(some))), key=lambda one: -one.area)
    # The larger ones come first, so that what holds an area has its depth already
    depths, fast = [], []
    for area in merged:
        point = Point(area.exterior.coords[0])
        holders = [depth for depth, (box, other) in zip(depths, fast)
                   if box[0] <= point.x <= box[2] and box[1] <= point.y <= box[3] and other.contains(point)]
        depths.append(len(holders))
        fast.append((area.bounds, prep(area)))
    whole = Polygon()
    for depth in range(max(depths, default=-1) + 1):
        some = unary_union([area for area, own in zip(merged, depths) if own == depth])
        whole = whole.difference(some) if depth % 2 else whole.union(some)
    return whole


def without_slivers(area):
    """An area without what is thinner than what touches, of it and of what is beside it: shapes that meet may do so but for
    the last digits."""
    for distance in (-TOUCH, 2*TOUCH, -TOUCH):
        area = area.buffer(distance, join_style=JOIN_STYLE.mitre)
    return area


def area_of(shapes, holes, reach):
    """The area that shapes bound, and the lines among them that bound none."""
    closed = [shape for shape in shapes if is_closed(shape.points)]
    areas, loose = closed_and_loose([shape.points for shape in shapes if not is_closed(shape.points)], reach)
    areas = [polygon_of(shape, not holes) for shape in closed] + areas
    return with_holes(areas) if holes else unary_union(areas), loose
