# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam.
#
# ellipsoidTrapFoam is free software: you can redistribute it and/or modify it
# under the terms of the GNU General Public License as published by the Free
# Software Foundation, either version 3 of the License, or (at your option) any
# later version. It comes with ABSOLUTELY NO WARRANTY; see the file COPYING.
"""Closed polygons in the plan of a device: areas, crossings, gaps. Lengths in micrometres."""

import math
from collections import namedtuple

TOUCH = 1e-4   # what lies nearer is taken to touch

# A closed polygon: what it is called in messages, its corners, one patch for each edge
# (edge i goes from corner i to the next), and whether fluid is inside of it
Ring = namedtuple("Ring", "what points patches encloses")

Edge = namedtuple("Edge", "ring index start end")

Gap = namedtuple("Gap", "width first second place")


def area(points):
    """Signed area, positive if anticlockwise."""
    return 0.5*sum(a[0]*b[1] - b[0]*a[1] for a, b in zip(points, points[1:] + points[:1]))


def edges(ring):
    """The edges in order."""
    return [
        Edge(ring, i, a, b)
        for i, (a, b) in enumerate(zip(ring.points, ring.points[1:] + ring.points[:1]))
    ]


def bounds(points):
    """(xMin, xMax), (yMin, yMax)"""
    return tuple((min(v), max(v)) for v in zip(*points))


def contains(points, x, y):
    """Whether a polygon encloses a point."""
    inside = False
    for (x0, y0), (x1, y1) in zip(points, points[1:] + points[:1]):
        if (y0 > y) != (y1 > y) and x < x0 + (y - y0)/(y1 - y0)*(x1 - x0):
            inside = not inside
    return inside


def foot(point, start, end):
    """The point of a segment that is nearest to a point."""
    (x, y), (x0, y0), (x1, y1) = point, start, end
    dx, dy = x1 - x0, y1 - y0
    s = ((x - x0)*dx + (y - y0)*dy)/(dx*dx + dy*dy or 1)
    s = min(max(s, 0), 1)
    return x0 + s*dx, y0 + s*dy


def nearest(a, b, c, d):
    """Where the segments a b and c d are nearest: distance, a point on each."""
    def side(p, q, r):
        return (q[0] - p[0])*(r[1] - p[1]) - (q[1] - p[1])*(r[0] - p[0])

    at, bt, ct, dt = side(c, d, a), side(c, d, b), side(a, b, c), side(a, b, d)
    if at*bt < 0 and ct*dt < 0:
        s = at/(at - bt)
        x = a[0] + s*(b[0] - a[0]), a[1] + s*(b[1] - a[1])
        return 0.0, x, x
    pairs = [(p, foot(p, c, d)) for p in (a, b)] + [(foot(p, a, b), p) for p in (c, d)]
    return min((math.dist(p, q), p, q) for p, q in pairs)


def divide(ring, point):
    """Make a point that lies on an edge a corner, if it is none."""
    for edge in edges(ring):
        if math.dist(point, foot(point, edge.start, edge.end)) < TOUCH:
            if min(math.dist(point, edge.start), math.dist(point, edge.end)) > TOUCH:
                ring.points.insert(edge.index + 1, point)
                ring.patches.insert(edge.index + 1, ring.patches[edge.index])
            return


def length_between(rings, start, end):
    """Length of what of a line lies in the first ring and in no other."""
    (x0, y0), (dx, dy) = start, (end[0] - start[0], end[1] - start[1])
    cuts = [0.0, 1.0]
    for ring in rings:
        sides = [dx*(y - y0) - dy*(x - x0) for x, y in ring.points]
        along = [((x - x0)*dx + (y - y0)*dy)/(dx*dx + dy*dy) for x, y in ring.points]
        for i, (a, b) in enumerate(zip(sides, sides[1:] + sides[:1])):
            if (a < 0) != (b < 0):
                cuts.append(along[i] + a/(a - b)*(along[(i + 1) % len(along)] - along[i]))
    cuts = sorted(s for s in cuts if 0 <= s <= 1)
    length = 0.0
    for a, b in zip(cuts, cuts[1:]):
        middle = x0 + 0.5*(a + b)*dx, y0 + 0.5*(a + b)*dy
        if contains(rings[0].points, *middle) and not any(contains(one.points, *middle) for one in rings[1:]):
            length += (b - a)*math.hypot(dx, dy)
    return length


def neighbours(rings, reach):
    """Pairs of edges that share no corner and whose bounding boxes are not farther apart."""
    boxed = sorted(
        ((*bounds((edge.start, edge.end)), edge) for ring in rings for edge in edges(ring)),
        key=lambda one: one[:2],
    )
    active = []
    for (x0, x1), (y0, y1), edge in boxed:
        active = [one for one in active if one[0][1] >= x0 - reach]
        for (_, (low, high), other) in active:
            if low > y1 + reach or high < y0 - reach:
                continue
            if edge.ring is other.ring:
                apart = abs(edge.index - other.index)
                if apart in (1, len(edge.ring.points) - 1):
                    continue
            yield edge, other
        active.append(((x0, x1), (y0, y1), edge))


def into_fluid(ring):
    """Unit normals of the edges that point into the fluid."""
    turn = 1 if (area(ring.points) > 0) == ring.encloses else -1
    normals = []
    for edge in edges(ring):
        (x0, y0), (x1, y1) = edge.start, edge.end
        length = turn*math.hypot(x1 - x0, y1 - y0)
        normals.append(((y0 - y1)/length, (x1 - x0)/length))
    return normals


def face(edge, other, normals):
    """Whether fluid may lie between two edges: each has a part of the other before it; of one
    ring they must be turned to one another, as a bend is no gap."""
    n, m = normals[id(edge.ring)][edge.index], normals[id(other.ring)][other.index]
    if edge.ring is other.ring and n[0]*m[0] + n[1]*m[1] > -0.5:
        return False

    def before(one, normal, two):
        x, y = one.start
        return any(
            (px - x)*normal[0] + (py - y)*normal[1] > TOUCH for px, py in (two.start, two.end)
        )

    return before(edge, n, other) and before(other, m, edge)


def gaps(rings, reach, ignored=()):
    """The narrowest gap between every two rings, and of a ring with itself, up to reach;
    edges of the patches in ignored bound none."""
    normals = {id(ring): into_fluid(ring) for ring in rings}
    found = {}
    for edge, other in neighbours(rings, reach):
        if {one.ring.patches[one.index] for one in (edge, other)} & set(ignored):
            continue
        if not face(edge, other, normals):
            continue
        width, p, q = nearest(edge.start, edge.end, other.start, other.end)
        place = tuple(0.5*(a + b) for a, b in zip(p, q))
        key = tuple(sorted((id(edge.ring), id(other.ring))))
        if width <= reach and (key not in found or width < found[key].width):
            found[key] = Gap(width, edge, other, place)
    return sorted(found.values(), key=lambda gap: gap.width)


def circle(x, y, radius, sides):
    """Corners of a circle's polygon, which has the circle's area."""
    corner = radius*math.sqrt(2*math.pi/(sides*math.sin(2*math.pi/sides)))
    angles = [2*math.pi*i/sides for i in range(sides)]
    return [(x + corner*math.cos(a), y + corner*math.sin(a)) for a in angles]


def chain(segments):
    """Closed polylines of (patch, start, end): (corners, patches) each, in the order of the
    segments; or, where they do not close, the first place that has not two ends."""
    def key(point):
        return tuple(round(v/TOUCH) for v in point)

    at = {}
    for i, (_, a, b) in enumerate(segments):
        for point in (a, b):
            at.setdefault(key(point), []).append(i)
    for mine in at.values():
        if len(mine) != 2:
            _, a, b = segments[mine[0]]
            return [], a if at[key(a)] is mine else b
    loops, used = [], set()
    for first, (_, start, _) in enumerate(segments):
        if first in used:
            continue
        points, patches, i, here = [], [], first, start
        while i not in used:
            used.add(i)
            patch, a, b = segments[i]
            points.append(here)
            patches.append(patch)
            here = b if key(a) == key(here) else a
            i = sum(at[key(here)]) - i
        loops.append((points, patches))
    return loops, None
