# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam.
#
# ellipsoidTrapFoam is free software: you can redistribute it and/or modify it
# under the terms of the GNU General Public License as published by the Free
# Software Foundation, either version 3 of the License, or (at your option) any
# later version. It comes with ABSOLUTELY NO WARRANTY; see the file COPYING.
"""A device given as its plan, a mask: named closed polygons, the walls of an STL, or a drawing, drawn out
to a depth. Checks constant/chip and writes what the mesh tools need of it."""

import itertools
import math
import re

from . import rings, stl
from .drawing import check_obstacles, drawing_plan
from .entries import read
from .rings import TOUCH, Ring
from .surfaces import Output, aperture_entry, curtain, slab, through

PARAMETERS = "constant/chip"
CIRCLE_SIDES = 48
RESERVED = ("top", "bottom", "outside")   # patches of the slab
OPENING = re.compile(r"(inlet|outlet)\w*")


def at(point):
    """A point for messages."""
    return "({:.6g} {:.6g})".format(*point)


# -- the plan ------------------------------------------------------------------

def patch_name(d, name):
    """A name that a patch may have."""
    if not re.fullmatch(r"[A-Za-z]\w*", name, re.ASCII) or name in RESERVED:
        d.fail(f"'{d.name}{name}': {name} is no name for a patch: letters, digits and _, "
               f"beginning with a letter, and none of {' '.join(RESERVED)}")
    return name


def corners(d, value, key):
    """Corners of a polygon whose first point stands at its end again."""
    points = d.points(value, key, 4)
    if math.dist(points[0], points[-1]) > TOUCH:
        d.fail(f"polygon '{d.name}{key}' is not closed: it begins at {at(points[0])} and ends at "
               f"{at(points[-1])}; it must end where it begins")
    return points[:-1]


def lines_of(d, name):
    """The polylines of an entry: one, or a list of them."""
    items = d.items(name)
    first = items[0][0]
    if not (isinstance(first, list) and first and isinstance(first[0], list)):
        items = [(d.get(name), name)]
    return [d.points(value, key, 2) for value, key in items]


def name_edges(d, plan, what):
    """Give edges of rings the names that 'edges' has for the polylines that they lie on, or for the box."""
    named = d.sub_if("edges")
    lines = {name: lines_of(named, name) for name in named.entries if not isinstance(named.get(name), dict)}
    segments = [(name, *ends) for name, some in lines.items() for line in some for ends in zip(line, line[1:])]
    for name, start, end in segments:
        if math.dist(start, end) < TOUCH:
            named.fail(f"'{named.name}{name}' has two points in one place: {at(start)}")
        for ring in plan:
            rings.divide(ring, start)
            rings.divide(ring, end)
    taken = {}

    def give(name, where, holds):
        found = [edge for ring in plan for edge in rings.edges(ring) if holds(edge.start) and holds(edge.end)]
        if not found:
            named.fail(f"'{named.name}{name}': no edge of {what} lies {where}")
        for edge in found:
            other = taken.setdefault((id(edge.ring), edge.index), name)
            if other != name:
                named.fail(f"the edge from {at(edge.start)} to {at(edge.end)} is named twice: "
                           f"'{named.name}{other}' and '{named.name}{name}'")
            edge.ring.patches[edge.index] = name

    for name, start, end in segments:
        give(name, f"between {at(start)} and {at(end)}",
             lambda p, a=start, b=end: math.dist(p, rings.foot(p, a, b)) < TOUCH)
    for name in named.entries:
        patch_name(named, name)
        if name not in lines:
            low, high = named.sub(name).corners()
            give(name, "in this box", lambda p, a=low, b=high: all(x <= v <= y for x, v, y in zip(a, p, b)))


def outline_of(d):
    """The fluid's outer boundary, its edges named."""
    d.only("points", "patch", "edges")
    points = corners(d, d.get("points"), "points")
    ring = Ring("outline", points, [patch_name(d, d.get("patch"))]*len(points), True)
    name_edges(d, [ring], "the outline")
    return ring


def obstacles_of(d):
    """Every obstacle's ring; those of one entry are one patch, but for edges that are named."""
    found = []
    for name in d.entries:
        one = d.sub(patch_name(d, name))
        one.only("polygons", "circles", "edges")
        if "polygons" not in one and "circles" not in one:
            one.fail(f"'{one.name[:-1]}' has neither polygons nor circles")
        shapes = []
        if "polygons" in one:
            shapes += [(key, corners(one, value, key)) for value, key in one.items("polygons")]
        if "circles" in one:
            for value, key in one.items("circles"):
                x, y, radius = one.numbers(value, 3, key, "a circle (x y radius)")
                if radius <= TOUCH:
                    one.fail(f"'{one.name}{key}': the radius must be above {TOUCH:g}: {radius:g}")
                shapes.append((key, rings.circle(x, y, radius, CIRCLE_SIDES)))
        these = [Ring(one.name + key, points, [name]*len(points), False) for key, points in shapes]
        name_edges(one, these, f"these obstacles, {name},")
        found += these
    return found


def stl_plan(top):
    """The rings of an STL's walls, that about all others first."""
    outline = top.sub_if("outline")
    outline.only("patch", "edges")
    patch = patch_name(outline, outline.get("patch")) if "patch" in outline else None
    loops, broken = rings.chain(stl.segments(top, patch))
    if broken:
        top.fail(f"'stl': its walls are not closed at {at(broken)} (micrometres)")
    if not loops:
        top.fail("'stl': no upright walls reach its lowest z")
    outer = max(loops, key=lambda loop: abs(rings.area(loop[0])))
    loops.remove(outer)
    plan = [Ring("stl: outline", *outer, True)] + [
        Ring(f"stl: {patches[0]}[{i}]", points, patches, False)
        for i, (points, patches) in enumerate(loops)
    ]
    name_edges(outline, plan, "the STL's walls")
    for ring in plan:
        for name in ring.patches:
            patch_name(top, name)
    return plan


def plan_of(top):
    """The outline and the obstacles."""
    source = next((key for key in ("drawing", "stl") if key in top), None)
    if source:
        for given, key in ((top.sub_if("outline"), "points"), (top, "obstacles"), (top, "stl")):
            if key in given and key != source:
                top.fail(f"give either '{source}' or '{given.name}{key}', not both")
    if source == "drawing":
        plan = drawing_plan(top)
        name_edges(top.sub_if("outline"), plan, "the drawing's fluid")
        for name in {name for ring in plan for name in ring.patches}:
            patch_name(top, name)
    elif source == "stl":
        plan = stl_plan(top)
    else:
        plan = [outline_of(top.sub("outline"))] + obstacles_of(top.sub_if("obstacles"))
    names = set(plan[0].patches)
    for kind in ("inlet", "outlet"):
        if not any(name.startswith(kind) for name in names if OPENING.fullmatch(name)):
            top.fail(f"no edge of the outline is named {kind}; there are: {' '.join(sorted(names))}")
    for ring in plan[1:]:
        for name in ring.patches:
            if OPENING.fullmatch(name):
                top.fail(f"obstacle '{ring.what}': the patch {name} would be an opening: another name, "
                         "not beginning with inlet or outlet")
    return plan


# -- its checks ------------------------------------------------------------------

def check_rings(top, plan):
    """Refuse polygons that are none, cross or lie in one another."""
    for ring in plan:
        line = rings.edges(ring)
        for edge in line:
            if math.dist(edge.start, edge.end) < TOUCH:
                top.fail(f"polygon '{ring.what}' has the point {at(edge.start)} twice", [edge.start])
        for edge, after in zip(line, line[1:] + line[:1]):
            back = math.dist(after.end, rings.foot(after.end, edge.start, edge.end))
            ahead = math.dist(edge.start, rings.foot(edge.start, after.start, after.end))
            if min(back, ahead) < TOUCH:
                top.fail(f"polygon '{ring.what}' turns back on itself at {at(edge.end)}", [edge.end])
    outline = plan[0]
    for edge, other in rings.neighbours(plan, TOUCH):
        distance, place, _ = rings.nearest(edge.start, edge.end, other.start, other.end)
        if distance > TOUCH:
            continue
        one, two = edge.ring, other.ring
        if one is two:
            top.fail(f"polygon '{one.what}' crosses itself at {at(place)}: its edges "
                     f"{at(edge.start)} to {at(edge.end)} and {at(other.start)} to {at(other.end)}", [place])
        if outline in (one, two):
            top.fail(f"obstacle '{(two if one is outline else one).what}' meets the outline at "
                     f"{at(place)}: keep it inside, or draw it as a part of the outline", [place])
        top.fail(f"obstacles '{one.what}' and '{two.what}' overlap at {at(place)}: "
                 "join them to one polygon", [place])
    for ring in plan[1:]:
        x, y = ring.points[0]
        if not rings.contains(outline.points, x, y):
            (x0, x1), (y0, y1) = rings.bounds(outline.points)
            top.fail(f"obstacle '{ring.what}' at {at((x, y))} lies outside the outline, which spans "
                     f"x {x0:g} to {x1:g}, y {y0:g} to {y1:g}")
    boxes = [rings.bounds(ring.points) for ring in plan]
    for ring, other in itertools.permutations(range(1, len(plan)), 2):
        if all(low <= v <= high for v, (low, high) in zip(plan[ring].points[0], boxes[other])) \
                and rings.contains(plan[other].points, *plan[ring].points[0]):
            top.fail(f"obstacles '{plan[ring].what}' and '{plan[other].what}' overlap: "
                     "one lies in the other")


def size_of(d, key, base):
    """A cell size: what is asked for, the level of refinement that gives it or less."""
    size = d.number(key)
    if size > base:
        d.fail(f"'{d.name}{key}' must be at most base, {base:g}: {size:g}")
    return math.ceil(math.log2(base/size) - 1e-9)


class Mesh:
    """The cell sizes of a resolution."""

    def __init__(self, top, plan, mesh):
        mesh.only("base", "outline", "obstacles", "layers", "patches", "boxes", "gapCells")
        self.base = mesh.number("base")
        self.layers = mesh.integer("layers")
        self.gap_cells = mesh.integer("gapCells", 2) if "gapCells" in mesh else 4
        outer = list(dict.fromkeys(plan[0].patches))
        inner = list(dict.fromkeys(name for ring in plan[1:] for name in ring.patches))
        self.levels = {name: size_of(mesh, "outline", self.base) for name in outer}
        if inner:
            level = size_of(mesh, "obstacles", self.base)
            # A patch may be of both
            self.levels.update((name, max(level, self.levels.get(name, 0))) for name in inner)
        special = mesh.sub_if("patches")
        for name in special.entries:
            if name not in self.levels:
                special.fail(f"'{special.name}{name}': no patch {name}; there are: {' '.join(self.levels)}")
            self.levels[name] = size_of(special, name, self.base)
        given, sizes = top.sub_if("boxes"), mesh.sub_if("boxes")
        self.boxes = {}
        for name in given.entries:
            low, high = given.sub(name).corners()
            if name in sizes:
                self.boxes[name] = low, high, size_of(sizes, name, self.base)
        for name in sizes.entries:
            if name not in given:
                sizes.fail(f"'{sizes.name}{name}': no box {name}; there are: {' '.join(given.entries) or 'none'}")

    def finest(self):
        """The smallest mesh cells."""
        return self.size(max([*self.levels.values(), *(level for *_, level in self.boxes.values())]))

    def size(self, level):
        """Size of the mesh cells of a level."""
        return self.base/2**level

    def level_in(self, gap):
        """Level of the mesh cells in a gap."""
        levels = [self.levels[edge.ring.patches[edge.index]] for edge in (gap.first, gap.second)]
        for low, high, level in self.boxes.values():
            if all(a <= v <= b for a, v, b in zip(low, gap.place, high)):
                levels.append(level)
        return max(levels)


def check_gaps(top, plan, mesh):
    """Refuse gaps with too few mesh cells across; the narrowest that is looked at, or None."""
    reach = mesh.gap_cells*max(mesh.size(level) for level in mesh.levels.values())
    openings = [name for name in mesh.levels if OPENING.fullmatch(name)]
    found = rings.gaps(plan, reach, openings)
    # Corners of a circle's polygon stand out
    narrow = [gap for gap in found if 1.01*gap.width < mesh.gap_cells*mesh.size(mesh.level_in(gap))]
    if narrow:
        gap, size = narrow[0], mesh.size(mesh.level_in(narrow[0]))
        top.fail(
            f"the gap between '{gap.first.ring.what}' and '{gap.second.ring.what}' at "
            f"{at(gap.place)} is {gap.width:.4g} wide, {gap.width/size:.2g} mesh cells of "
            f"{size:g}: gapCells asks for {mesh.gap_cells}, a size of "
            f"{gap.width/mesh.gap_cells:.3g} or less there, of a patch or a box", [one.place for one in narrow]
        )
    return found[0] if found else None


def inside_point(top, plan, mesh):
    """A place for snappyHexMesh in the fluid, off all walls and grid planes."""
    outline = plan[0]
    walls = [edge for ring in plan for edge in rings.edges(ring)]
    best, place = 0, None
    for edge, normal in zip(rings.edges(outline), rings.into_fluid(outline)):
        if not outline.patches[edge.index].startswith("inlet"):
            continue
        for steps in range(1, 41):
            x, y = (
                math.floor((0.5*(a + b) + 0.5*steps*mesh.base*n)/mesh.base)*mesh.base + 0.37*mesh.base
                for a, b, n in zip(edge.start, edge.end, normal)
            )
            if not rings.contains(outline.points, x, y) or any(
                    rings.contains(ring.points, x, y) for ring in plan[1:]):
                continue
            clear = min(math.dist((x, y), rings.foot((x, y), w.start, w.end)) for w in walls)
            if clear > best:
                best, place = clear, (x, y)
    if best < mesh.base:
        top.fail(f"'base' {mesh.base:g} is too coarse: within 20 of them from the inlet nothing is as "
                 f"far off all walls as one; it must be below {best:.3g}")
    return place


# -- output ------------------------------------------------------------------------

def walls_of(plan, base):
    """Patch to the triangles of its walls."""
    walls = {}
    for ring in plan:
        for edge in rings.edges(ring):
            walls.setdefault(ring.patches[edge.index], []).extend(
                curtain((edge.start, edge.end), *through(base))
            )
    return walls


def in_fluid(plan, point, wall):
    """Whether a point lies in the fluid, and farther than this from all walls."""
    return (rings.contains(plan[0].points, *point)
            and not any(rings.contains(one.points, *point) for one in plan[1:])
            and all(math.dist(point, rings.foot(point, edge.start, edge.end)) > wall
                    for ring in plan for edge in rings.edges(ring)))


def sections_of(top, plan, depth, mesh):
    """The sections, as apertures."""
    sections, text, base = top.sub_if("sections"), "", mesh.base
    for name in sections.entries:
        patch_name(sections, name)
        ends = [sections.numbers(value, 2, key, "a point (x y)") for value, key in sections.items(name)]
        same = [axis for axis in (0, 1) if len(ends) == 2 and abs(ends[0][axis] - ends[1][axis]) < TOUCH]
        if len(same) != 1:
            sections.fail(f"'{sections.name}{name}' must be two ends of a line along x or y")
        area = depth*rings.length_between(plan, *ends)
        if not area > 0:
            sections.fail(f"'{sections.name}{name}' lies nowhere in the fluid")
        for end in ends:
            if in_fluid(plan, end, mesh.finest()):
                print(f"makeGeometry: warning: {PARAMETERS}: '{sections.name}{name}' ends at {at(end)}, in the "
                      "fluid: what passes beyond is not counted")
        # Across the line up to mesh cells on either side, over the depth beyond floor and ceiling
        low, high = ([end(*pair) for pair in zip(*ends)] for end in (min, max))
        low[same[0]] -= base
        high[same[0]] += base
        text += aperture_entry(name, (*low, -base), (*high, depth + base), same[0], area)
    return text


def make_mask(resolution):
    """Everything, in the case folder; what there is, in one line."""
    top = read(PARAMETERS)
    top.only("resolution", "depth", "inletPressure", "outline", "obstacles", "stl", "stlScale", "drawing",
             "boxes", "sections", "resolutions")
    resolution = resolution or top.get("resolution")
    plan = plan_of(top)
    check_rings(top, plan)
    mesh = Mesh(top, plan, top.sub("resolutions").choose(resolution))
    if "drawing" in top:
        check_obstacles(top, plan, mesh)
    narrowest = check_gaps(top, plan, mesh)
    inside = inside_point(top, plan, mesh)
    depth, pressure = top.number("depth"), top.number("inletPressure")
    sections = sections_of(top, plan, depth, mesh)
    area = abs(rings.area(plan[0].points)) - sum(abs(rings.area(ring.points)) for ring in plan[1:])

    out = Output(PARAMETERS)
    out.stl(stl.WALLS, walls_of(plan, mesh.base))
    out.entries("mesh", {
        **slab(rings.bounds(plan[0].points), mesh.base),
        "slab": mesh.base,
        "insideX": inside[0], "insideY": inside[1], "insideZ": 0.37*mesh.base,
        "depth": depth, "layers": mesh.layers,
    })
    out.text("chosen", f"resolution {resolution};\n")
    out.entries("inletPressure", {"inletPressure": pressure})
    out.text("regions", "".join(f"{name} {{ name {name}; }}\n" for name in mesh.levels))
    out.text("regionLevels", "".join(
        f"{name} {{ level ({level} {level}); patchInfo {{ type "
        f"{'patch' if OPENING.fullmatch(name) else 'wall'}; }} }}\n"
        for name, level in mesh.levels.items()
    ))
    low, high = through(mesh.base)
    out.text("boxes", "".join(
        f"box_{name}\n{{\n    type searchableBox;\n    min ({a[0]:.9g} {a[1]:.9g} {low:.9g});\n"
        f"    max ({b[0]:.9g} {b[1]:.9g} {high:.9g});\n}}\n" for name, (a, b, _) in mesh.boxes.items()
    ))
    out.text("boxLevels", "".join(
        f"box_{name} {{ mode inside; levels ((1e15 {level})); }}\n" for name, (*_, level) in mesh.boxes.items()
    ))
    out.text("sections", sections)
    facts = {"obstacles": len(plan) - 1, "area": area, "depth": depth, "finestCell": mesh.finest()}
    if narrowest:
        facts["narrowestGap"] = narrowest.width
    out.entries("plan", facts)
    drawn = top.sketch([]) if top.sketch else ""
    return ", ".join(f"{key} {value:.6g}" for key, value in facts.items()) + drawn
