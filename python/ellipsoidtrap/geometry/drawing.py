# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""The plan of a device from a drawing, DXF or GDS: what the entry 'drawing' of constant/chip says."""

import math

from . import rings, sketch
from .entries import shown
from .rings import TOUCH, Ring

# In micrometres
UNITS = {"nm": 1e-3, "um": 1.0, "mm": 1e3, "cm": 1e4, "m": 1e6, "inch": 25400.0}
# A device's larger side
SMALLEST, LARGEST = 1.0, 2e5
# How far curves may be off, and ends of lines that meet apart
TOLERANCE = 0.005
# How far from an edge its name may stand, of the edge's length
NAME_REACH = 0.1


class Plan:
    """A drawing on its way to a plan; what is wrong ends the script, with a picture of it."""

    def __init__(self, top):
        self.top, self.d = top, top.sub("drawing")
        self.d.only("file", "unit", "cell", "tolerance", "fluid", "layers", "texts", "window", "inside")
        self.file = self.d.path("file")
        self.tolerance = self.d.number("tolerance") if "tolerance" in self.d else TOLERANCE
        self.lines, self.plan = [], []
        self.drawing = None

    def fail(self, message, places):
        """End the script with a message about the drawing."""
        self.top.fail(f"'drawing': {self.file}: {message}", places)

    def sketch(self, places):
        """Draw what there is; what to add to a message."""
        return sketch.draw(self.lines, self.plan, places)

    # -- the file ------------------------------------------------------------------

    def read(self):
        """Shapes and texts of the file."""
        kind = self.file.rsplit(".", 1)[-1].lower()
        if kind not in ("dxf", "gds"):
            self.d.fail(f"'drawing.file' must be a DXF or GDS file, of that ending: {self.file}; other formats are exported as "
                        "one of these")
        unit = self.unit()
        if "cell" in self.d and kind == "dxf":
            self.d.fail("'drawing.cell' is of GDS files alone; blocks of a DXF file are put in where it inserts them")
        try:
            if kind == "dxf":
                from . import dxf
                found = dxf.read(self.file, unit, self.tolerance)
            else:
                from . import gds
                found = gds.read(self.file, unit, self.d.path("cell") if "cell" in self.d else None)
        except ModuleNotFoundError as error:
            reader = {"dxf": "python3-ezdxf", "gds": "python3-gdspy"}[kind]
            self.d.fail(f"'drawing.file': Python has no module {error.name}, which reads {self.file}: install it (Debian: "
                        f"apt-get install python3-shapely {reader})")
        except Exception as error:      # whatever a reader says of a file that is none
            if getattr(error, "strerror", None):
                self.d.fail(f"'drawing.file': cannot read {self.file}: {error.strerror}")
            self.d.fail(f"'drawing.file': {self.file} is no {kind.upper()} file that can be read: "
                        f"{type(error).__name__} {' '.join(str(error).split())}".rstrip())
        if found is None:
            self.d.fail(f"'drawing.unit' is missing: {self.file} does not tell its unit, one of {' '.join(UNITS)}")
        if isinstance(found, list):
            self.d.fail(f"'drawing.cell' must be one of the cells of {self.file}: {' '.join(found) or 'it has none'}")
        self.drawing = found

    def unit(self):
        """The unit that is given, in micrometres."""
        if "unit" not in self.d:
            return None
        name = self.d.get("unit")
        if not isinstance(name, str) or name not in UNITS:
            self.d.fail(f"'drawing.unit' must be one of {' '.join(UNITS)}: {shown(name)}")
        return UNITS[name]

    def layers(self, d, key):
        """The layers that an entry names, each of which has something on it."""
        value = d.get(key)
        names = value if isinstance(value, list) else [value]
        if not names or not all(isinstance(name, str) for name in names):
            d.fail(f"'{d.name}{key}' must be a layer or a list of layers: {shown(value)}")
        names = [name.strip('"').replace(" / ", "/").casefold() for name in names]
        have = {name.casefold() for one in self.drawing.shapes + self.drawing.texts for name in one.layers}
        for name in names:
            if name not in have:
                d.fail(f"'{d.name}{key}': nothing is drawn on a layer {name} of {self.file}; its layers are: "
                       f"{', '.join(self.drawing.layers) or 'none'}")
        return set(names)

    def shapes(self, d, key):
        """The shapes of the layers that an entry names."""
        layers = self.layers(d, key)
        found = [one for one in self.drawing.shapes if layers & {name.casefold() for name in one.layers}]
        self.lines += [one.points for one in found if one.points]
        for one in found:
            if one.trouble:
                self.fail(f"layer {one.layers[0]}: {one.trouble}", one.points[:1])
        return found

    # -- areas -----------------------------------------------------------------------

    def area(self, some, must_close=True):
        """The area that shapes bound, and the lines that bound none, which may not be."""
        from .shapes import Trouble, area_of, open_outline

        try:
            area, loose = area_of(some, self.drawing.holes, self.tolerance)
            if loose and must_close:
                raise open_outline(sorted({one.layers[0] for one in some}), loose)
        except Trouble as trouble:
            self.fail(trouble.message, trouble.places)
        return area, loose

    def fluid(self, solids):
        """The one area of fluid, solids cut out of it."""
        from shapely.geometry import Point, box
        from .shapes import parts, without_slivers

        fluid, _ = self.area(self.shapes(self.d, "fluid"))
        x0, y0, x1, y1 = fluid.bounds or (0, 0, 0, 0)
        size = max(x1 - x0, y1 - y0)
        if not SMALLEST <= size <= LARGEST:
            self.fail(f"the fluid would be {size:.6g} um long, which must be {SMALLEST:g} to {LARGEST:g}: 'drawing.unit' says "
                      f"what a length of 1 in the file is ({' '.join(UNITS)})", [])
        if "window" in self.d:
            low, high = self.d.sub("window").corners()
            fluid = fluid.intersection(box(*low, *high))
            if fluid.is_empty:
                self.fail(f"nothing of the fluid, which spans x {x0:g} to {x1:g}, y {y0:g} to {y1:g}, lies in 'drawing.window'", [])
        for one in solids.values():
            fluid = fluid.difference(one)
        found = parts(without_slivers(fluid))
        if "inside" in self.d:
            place = self.d.point("inside")
            found = [one for one in found if one.contains(Point(place))]
            if not found:
                self.fail("no fluid at 'drawing.inside' ({:g} {:g})".format(*place), [place])
        if len(found) != 1:
            places = [one.representative_point().coords[0] for one in found]
            self.fail(f"the fluid is in {len(found)} parts: 'drawing.inside (x y)' says which, 'drawing.window {{ min (x y); max "
                      "(x y); }' cuts out a piece", places)
        return found[0]

    def solids_and_marks(self):
        """Of every patch its solid shapes, as an area, and what names edges: lines and, of openings, shapes."""
        solids, marks, given = {}, {}, self.d.sub_if("layers")
        for patch in given.entries:
            some = self.shapes(given, patch)
            area, loose = self.area(some, must_close=False)
            if patch.startswith(("inlet", "outlet")):
                marks[patch] = [area, *loose]
            else:
                solids[patch], marks[patch] = area, loose
        self.check_overlaps(solids)
        return solids, marks

    def check_overlaps(self, solids):
        """Refuse solids that would be of two patches."""
        names = list(solids)
        for i, name in enumerate(names):
            for other in names[:i]:
                both = solids[name].intersection(solids[other])
                if both.area > TOUCH:
                    place = both.representative_point().coords[0]
                    self.fail("the shapes of the patches {} and {} overlap at ({:.6g} {:.6g})".format(other, name, *place), [place])

    # -- rings and the names of their edges --------------------------------------------

    def make(self, patch):
        """The rings, the outline first; what no layer and no text names is of the patch."""
        self.read()
        solids, marks = self.solids_and_marks()
        fluid = self.fluid(solids)
        for i, one in enumerate((fluid.exterior, *fluid.interiors)):
            points = list(one.coords)[:-1]
            self.plan.append(Ring("drawing: outline" if i == 0 else "", points, [patch]*len(points), i == 0))
        for name, area in solids.items():
            if not area.is_empty:
                self.name(name, area.boundary, TOUCH)
        for name, some in marks.items():
            for mark in some:
                for line in [mark] if mark.geom_type == "LineString" else []:
                    for ring in self.plan:
                        rings.divide(ring, line.coords[0])
                        rings.divide(ring, line.coords[-1])
                if not mark.is_empty and not self.name(name, mark, self.tolerance):
                    place = mark.representative_point().coords[0]
                    self.fail(f"what the layer of {name} has at ({place[0]:.6g} {place[1]:.6g}) lies on no edge of the fluid"
                              + ("" if name.startswith(("inlet", "outlet")) else ", and bounds no area"), [place])
        self.plan = [shortened(ring) for ring in self.plan]
        for name in solids:
            if not any(name in ring.patches for ring in self.plan):
                self.fail(f"no edge of the fluid is of the patch {name}: its layer has nothing in the fluid", [])
        if "texts" in self.d:
            self.name_by_texts()
        self.plan = [ring if ring.encloses else ring._replace(what="drawing: {} at ({:.4g} {:.4g})".format(
            ring.patches[0], *ring.points[0])) for ring in self.plan]
        return self.plan

    def name(self, name, where, reach):
        """Name the edges that lie on or in something; whether there are any."""
        from shapely.geometry import LineString
        from shapely.prepared import prep

        zone = prep(where.buffer(reach))
        found = [edge for ring in self.plan for edge in rings.edges(ring) if zone.contains(LineString(edge[2:]))]
        for edge in found:
            edge.ring.patches[edge.index] = name
        return bool(found)

    def name_by_texts(self):
        """A text in an obstacle names all of it; another one the edge of the outline that it stands on."""
        layers = self.layers(self.d, "texts")
        texts = [one for one in self.drawing.texts if layers & {name.casefold() for name in one.layers}]
        if "window" in self.d:
            low, high = self.d.sub("window").corners()
            texts = [one for one in texts if all(a <= v <= b for a, v, b in zip(low, one.place, high))]
        for text in texts:
            ring = next((ring for ring in self.plan[1:] if rings.contains(ring.points, *text.place)), None)
            if ring:
                ring.patches[:] = [text.words]*len(ring.patches)
                continue
            far, edge = min((math.dist(text.place, rings.foot(text.place, one.start, one.end)), one)
                            for one in rings.edges(self.plan[0]))
            if far > NAME_REACH*math.dist(edge.start, edge.end):
                self.fail("the text {} at ({:.6g} {:.6g}) stands in no obstacle and on no edge of the outline: the nearest edge is "
                          "{:.4g} away and {:.4g} long".format(text.words, *text.place, far, math.dist(edge.start, edge.end)),
                          [text.place])
            edge.ring.patches[edge.index] = text.words


def shortened(ring):
    """A ring without edges that are shorter than what touches."""
    points, patches = [], []
    for point, patch in zip(ring.points, ring.patches):
        if points and math.dist(point, points[-1]) < 2*TOUCH:
            patches[-1] = patch
        else:
            points.append(point)
            patches.append(patch)
    if len(points) > 3 and math.dist(points[0], points[-1]) < 2*TOUCH:
        points.pop()
        patches.pop()
    return ring._replace(points=points, patches=patches)


def check_obstacles(top, plan, mesh):
    """Refuse obstacles that mesh cells cannot show."""
    from shapely.geometry import Polygon

    thin = []
    for ring in plan[1:]:
        size = mesh.size(max(mesh.levels[name] for name in ring.patches))
        if Polygon(ring.points).buffer(-0.5*size).is_empty:
            thin.append((ring.what, size, ring.points[0]))
    if thin:
        more = f", as {len(thin) - 1} more" if thin[1:] else ""
        top.fail(f"obstacle '{thin[0][0]}' is thinner than one mesh cell, {thin[0][1]:g}{more}", [one[2] for one in thin])


def drawing_plan(top):
    """The rings of a drawing, the outline first."""
    plan = Plan(top)
    top.sketch = plan.sketch
    outline = top.sub_if("outline")
    outline.only("patch", "edges")
    plan.make(outline.get("patch") if "patch" in outline else "walls")
    return plan.plan
