# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""What the pictures need of a case: its dictionaries, mesh, flow and the cells' files.

Lengths are in micrometres and speeds in mm/s from here on, times in seconds. The plan
of the device is the x-y plane, its depth lies along z.
"""

import gzip
import os
import re
import subprocess
import warnings
from collections import namedtuple
from functools import cached_property

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkObject
from vtkmodules.vtkCommonDataModel import vtkCompositeDataSet, vtkPlane
from vtkmodules.vtkFiltersCore import vtkAppendPolyData, vtkCleanPolyData, vtkCutter
from vtkmodules.vtkIOParallel import vtkPOpenFOAMReader
from vtkmodules.vtkParallelCore import vtkDummyController

MICRO = 1e6   # m to micrometres
MILLI = 1e3   # m/s to mm/s, s to ms

SMOOTH = 50000   # triangles that make a smooth picture

# That of ellipsoid_options_default() in src/ellipsoid
DEFAULT_SEMI_AXES = (0.5e-6, 2e-6, 0.5e-6)

# Fate that an event of events.csv leads to
FATES = {
    "injected": "in flight",
    "released": "in flight",
    "caught": "caught",
    "stalled": "stalled",
    "escaped": "escaped",
    "lost": "lost",
}

Fate = namedtuple("Fate", "name patch t")


class CaseError(Exception):
    """An input is missing or malformed; the text names the file."""


class NotApplicable(Exception):
    """The case has nothing that this picture could show."""


class Track(namedtuple("Track", "t x u q omega axis")):
    """The rows of one cell by time, in arrays."""

    __slots__ = ()

    def path(self):
        """Points of a smooth curve in the plan, through all rows along their velocity."""
        x, dt = self.x[:, :2], np.diff(self.t)[:, None]
        chord = np.diff(x, axis=0)
        length = np.linalg.norm(chord, axis=1, keepdims=True)

        def tangent(u):
            # At most the chord's length: rows of a cell at rest may lie far apart in time
            reach = u[:, :2] * dt * MICRO / MILLI
            size = np.linalg.norm(reach, axis=1, keepdims=True)
            return reach * np.minimum(1, length / np.maximum(size, 1e-30))

        a, b = tangent(self.u[:-1]), tangent(self.u[1:])
        s = np.linspace(0, 1, 6, endpoint=False)[None, :, None]
        start, chord, a, b = x[:-1, None], chord[:, None], a[:, None], b[:, None]
        # Hermite's cubic
        curve = start + s * (a + s * (3 * chord - 2 * a - b + s * (a + b - 2 * chord)))
        return np.concatenate((curve.reshape(-1, 2), x[-1:]))


class Plane:
    """A cut through mesh and flow, parallel to the plan of the device.

    points      (n, 2) corners
    connectivity, offsets   polygon i has the corners connectivity[offsets[i]:offsets[i+1]]
    velocity    (m, 3) of the flow in every polygon
    outlines    patch name to (k, 2, 2) segments
    walls       (which points, their velocity) where it is known
    """

    def __init__(self, points, connectivity, offsets, velocity, outlines, walls):
        self.points = points
        self.connectivity = connectivity
        self.offsets = offsets
        self.velocity = velocity
        self.outlines = outlines
        self._walls = walls

    @property
    def bounds(self):
        """(xMin, xMax), (yMin, yMax)"""
        return tuple(zip(self.points.min(axis=0), self.points.max(axis=0)))

    @cached_property
    def polygons(self):
        """List of (k, 2) corner arrays."""
        return np.split(self.points[self.connectivity], self.offsets[1:-1])

    @cached_property
    def areas(self):
        """Area of every polygon."""
        a, b = self.points[self.connectivity], self.points[self._next]
        cross = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
        return 0.5 * np.abs(np.add.reduceat(cross, self.offsets[:-1]))

    @cached_property
    def point_velocity(self):
        """Velocity at every corner, the mean of the polygons about it."""
        owner = np.repeat(np.arange(len(self.velocity)), np.diff(self.offsets))
        shares = np.bincount(self.connectivity, minlength=len(self.points))
        velocity = np.column_stack([
            np.bincount(self.connectivity, component[owner], len(self.points))
            for component in self.velocity.T
        ]) / np.maximum(shares, 1)[:, None]
        for which, value in self._walls:
            velocity[which] = value
        return velocity

    @cached_property
    def _fans(self):
        """Nodes of x, y and velocity, and triangles: every polygon a fan about its middle."""
        sides = np.diff(self.offsets)
        corners = self.points[self.connectivity]
        middles = np.add.reduceat(corners, self.offsets[:-1]) / sides[:, None]
        hub = np.repeat(len(self.points) + np.arange(len(sides)), sides)
        nodes = np.column_stack((
            np.concatenate((self.points, middles)),
            np.concatenate((self.point_velocity, self.velocity)),
        ))
        return nodes, np.column_stack((hub, self.connectivity, self._next))

    def speed_in(self, xlim, ylim):
        """Speed on a triangulation of a window: x, y, triangles, speed."""
        nodes, triangles = self._fans
        low, high = np.transpose((xlim, ylim))
        boxes = nodes[triangles, :2]
        seen = (boxes.max(axis=1) > low) & (boxes.min(axis=1) < high)
        triangles = triangles[seen.all(axis=1)]
        # The speed is not linear: where there are few, triangles are quartered
        while 0 < len(triangles) < SMOOTH:
            corners = nodes[triangles]
            halves = 0.5 * (corners + np.roll(corners, -1, axis=1))
            nodes = np.concatenate((corners, halves), axis=1).reshape(-1, nodes.shape[1])
            first = 6 * np.arange(len(triangles))[:, None, None]
            quarters = np.array([[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]])
            triangles = (first + quarters).reshape(-1, 3)
        return nodes[:, 0], nodes[:, 1], triangles, np.linalg.norm(nodes[:, 2:], axis=1)

    @cached_property
    def _next(self):
        """The corner that follows each entry of connectivity within its polygon."""
        after = np.roll(self.connectivity, -1)
        after[self.offsets[1:] - 1] = self.connectivity[self.offsets[:-1]]
        return after


class Case:
    """A case folder; everything is read when first asked for."""

    def __init__(self, folder):
        self.folder = os.path.abspath(folder)
        if not os.path.isfile(self.path("system", "controlDict")):
            raise CaseError(f"{folder}: not an OpenFOAM case (no system/controlDict)")

    def path(self, *parts):
        """Path of something in the case."""
        return os.path.join(self.folder, *parts)

    # -- dictionaries --------------------------------------------------------

    @cached_property
    def properties(self):
        """constant/ellipsoidCloudProperties as nested dicts of strings and lists."""
        return read_dictionary(self.path("constant", "ellipsoidCloudProperties"))

    @cached_property
    def semi_axes(self):
        """The cells' semi-axes."""
        words = self.properties.get("cell", {}).get("semiAxes", DEFAULT_SEMI_AXES)
        try:
            axes = np.array(words, dtype=float)
        except ValueError:
            axes = np.empty(0)
        if axes.shape != (3,) or not (axes > 0).all():
            file = self.path("constant", "ellipsoidCloudProperties")
            raise CaseError(f"{file}: cell/semiAxes are not three positive numbers")
        return axes * MICRO

    @cached_property
    def patches(self):
        """Patch name to type, in the order of the mesh."""
        file = self.path("constant", "polyMesh", "boundary")
        text = without_comments(read_text(file))
        found = re.findall(r"([^\s(){};]+)\s*\{[^{}]*?\btype\s+(\w+)\s*;", text)
        if not found:
            raise CaseError(f"{file}: no patches found")
        return dict(found)

    @cached_property
    def sieves(self):
        """Names of the patches that catch cells."""
        patterns = self.properties.get("capture", {}).get("sieves", [])
        walls = [name for name, kind in self.patches.items() if kind == "wall"]
        names = []
        for pattern in patterns:
            if pattern.startswith('"'):
                names += [name for name in walls if re.fullmatch(pattern[1:-1], name)]
            else:
                names += [name for name in walls if name == pattern]
        return list(dict.fromkeys(names))

    # -- times ---------------------------------------------------------------

    @property
    def decomposed(self):
        """Whether the last run was on several processors."""
        return os.path.isdir(self.path("processor0"))

    def times(self):
        """(value, name) of the time folders, ascending."""
        return number_folders(self.path("processor0") if self.decomposed else self.folder)

    @cached_property
    def end_time(self):
        """The time that the run has reached."""
        last = [value for value, _ in self.times()[-1:]]
        return max(last + [self.events["t"].max(initial=0)])

    # -- cells ---------------------------------------------------------------

    @cached_property
    def results(self):
        """The folder with the cells' files; continued runs append to the same."""
        root = self.path("postProcessing", "ellipsoidCloud")
        starts = number_folders(root)
        if not starts:
            raise CaseError(f"{root}: no results of ellipsoidTrapFoam")
        return os.path.join(root, starts[-1][1])

    @cached_property
    def events(self):
        """t, id, event, patch of all that happened to cells that entered, by time."""
        types = [("t", float), ("id", int), ("event", "U16"), ("patch", "U128")]
        file = os.path.join(self.results, "events.csv")
        events = read_csv(file, types)
        events = events[events["event"] != "waiting"]
        unknown = set(events["event"]) - set(FATES)
        if unknown:
            raise CaseError(f"{file}: unknown event {unknown.pop()}")
        return events[np.argsort(events["t"], kind="stable")]

    @cached_property
    def fates(self):
        """Cell id to what became of it."""
        return {
            int(cell): Fate(FATES[event], str(patch), float(t))
            for t, cell, event, patch in self.events
        }

    def count(self, fate, patch=None):
        """Number of cells with a fate, of one patch where it is given."""
        return sum(
            one.name == fate and patch in (None, one.patch) for one in self.fates.values()
        )

    @cached_property
    def tracks(self):
        """Cell id to its track; q is (eps1, eps2, eps3, eta), axis the long axis O."""
        vectors = (
            ("x1", "x2", "x3"),
            ("u1", "u2", "u3"),
            ("eps1", "eps2", "eps3", "eta"),
            ("omega1", "omega2", "omega3"),
            ("O1", "O2", "O3"),
        )
        types = [("t", float), ("id", int)]
        types += [(name, float) for names in vectors for name in names]
        rows = read_csv(os.path.join(self.results, "tracks.csv"), types)
        rows = rows[np.lexsort((rows["t"], rows["id"]))]
        ids, firsts = np.unique(rows["id"], return_index=True)
        tracks = {}
        for cell, part in zip(ids, np.split(rows, firsts[1:])):
            x, u, q, omega, axis = (
                np.column_stack([part[name] for name in names]) for names in vectors
            )
            tracks[int(cell)] = Track(part["t"], x * MICRO, u * MILLI, q, omega, axis)
        return tracks

    # -- mesh and flow -------------------------------------------------------

    @cached_property
    def flow_time(self):
        """(value, name) of the last time folder with a flow."""
        root = self.path("processor0") if self.decomposed else self.folder
        for value, name in reversed(self.times()):
            for file in ("U", "U.gz"):
                if os.path.isfile(os.path.join(root, name, file)):
                    return value, name
        raise CaseError(f"{root}: no time folder with a velocity U")

    @cached_property
    def wall_velocity(self):
        """Patch name to the velocity there, where the flow has a uniform one."""
        root = self.path("processor0") if self.decomposed else self.folder
        file = os.path.join(root, self.flow_time[1], "U")
        text = read_text(file if os.path.isfile(file) else file + ".gz")
        conditions = text[text.rfind("boundaryField"):]
        given = {
            name: (0, 0, 0)
            for name in re.findall(r"([^\s(){};]+)\s*\{\s*type\s+noSlip\s*;", conditions)
        }
        fixed = re.findall(
            r"([^\s(){};]+)\s*\{\s*type\s+fixedValue\s*;\s*value\s+uniform\s*\(([^)]*)\)",
            conditions,
        )
        for name, words in fixed:
            given[name] = tuple(float(word) * MILLI for word in words.split())
        return given

    @cached_property
    def _vtk(self):
        """(mesh pieces, patch name to pieces, number of mesh cells) from VTK's reader."""
        for file in ("points", "faces", "owner", "neighbour"):
            stem = self.path("constant", "polyMesh", file)
            if not (os.path.isfile(stem) or os.path.isfile(stem + ".gz")):
                raise CaseError(f"{stem}: not there; make the mesh first")

        # What VTK would print is told by the checks below in one line
        vtkObject.GlobalWarningDisplayOff()
        reader = vtkPOpenFOAMReader()
        controller = vtkDummyController()
        reader.SetController(controller)
        reader.SetCaseType(
            vtkPOpenFOAMReader.DECOMPOSED_CASE if self.decomposed
            else vtkPOpenFOAMReader.RECONSTRUCTED_CASE
        )
        reader.SetFileName(self.path("system", "controlDict"))
        reader.SetSkipZeroTime(False)
        reader.SetDecomposePolyhedra(False)
        reader.CreateCellToPointOff()
        reader.UpdateInformation()
        reader.EnableAllPatchArrays()
        for i in range(reader.GetNumberOfPatchArrays()):
            name = reader.GetPatchArrayName(i)
            if name.startswith(("lagrangian/", "group/")):
                reader.SetPatchArrayStatus(name, 0)
        for i in range(reader.GetNumberOfCellArrays()):
            name = reader.GetCellArrayName(i)
            reader.SetCellArrayStatus(name, name == "U")
        reader.UpdateTimeStep(self.flow_time[0])

        pieces = {}
        iterator = reader.GetOutputDataObject(0).NewIterator()
        while not iterator.IsDoneWithTraversal():
            name = iterator.GetCurrentMetaData().Get(vtkCompositeDataSet.NAME())
            pieces.setdefault(name, []).append(iterator.GetCurrentDataObject())
            iterator.GoToNextItem()
        meshes = [one for one in pieces.pop("internalMesh", []) if one.GetNumberOfCells()]
        if not meshes or any(one.GetCellData().GetArray("U") is None for one in meshes):
            raise CaseError(
                f"{self.folder}: VTK cannot read mesh and flow of time {self.flow_time[1]}"
            )
        return meshes, pieces

    @property
    def mesh_size(self):
        """Number of mesh cells."""
        return sum(mesh.GetNumberOfCells() for mesh in self._vtk[0])

    @cached_property
    def plane(self):
        """Mesh and flow at half depth."""
        meshes, patches = self._vtk
        bounds = [mesh.GetBounds() for mesh in meshes]
        low = min(bound[4] for bound in bounds)
        high = max(bound[5] for bound in bounds)
        size = max(max(bound[1], bound[3]) for bound in bounds)

        plane = vtkPlane()
        plane.SetNormal(0, 0, 1)
        # A hair off the middle, where two layers of mesh cells may meet
        plane.SetOrigin(0, 0, 0.5 * (low + high) + 1e-3 * (high - low))

        def cut(pieces):
            together = vtkAppendPolyData()
            for piece in pieces:
                cutter = vtkCutter()
                cutter.SetInputData(piece)
                cutter.SetCutFunction(plane)
                cutter.GenerateTrianglesOff()
                cutter.Update()
                together.AddInputData(cutter.GetOutput())
            clean = vtkCleanPolyData()
            clean.SetInputConnection(together.GetOutputPort())
            clean.ToleranceIsAbsoluteOn()
            clean.SetAbsoluteTolerance(1e-6 * size)
            clean.ConvertPolysToLinesOff()
            clean.Update()
            return clean.GetOutput()

        section = cut(meshes)
        points = vtk_to_numpy(section.GetPoints().GetData())[:, :2] * MICRO
        polygons = section.GetPolys()
        U = vtk_to_numpy(section.GetCellData().GetArray("U"))

        outlines = {}
        walls = []
        for name in self.patches:
            line = cut(patches.get(name, []))
            if not line.GetNumberOfLines():
                continue
            ends = vtk_to_numpy(line.GetLines().GetConnectivityArray()).reshape(-1, 2)
            xy = vtk_to_numpy(line.GetPoints().GetData())[:, :2] * MICRO
            outlines[name] = xy[ends]
            if name in self.wall_velocity:
                on = coincide(points, xy, 1e-5 * size * MICRO)
                walls.append((on, self.wall_velocity[name]))

        return Plane(
            points.astype(float),
            vtk_to_numpy(polygons.GetConnectivityArray()),
            vtk_to_numpy(polygons.GetOffsetsArray()),
            U.astype(float) * MILLI,
            outlines,
            walls,
        )


# -- files -------------------------------------------------------------------

def read_text(file):
    """The text of a file, gzipped or not."""
    try:
        with (gzip.open if file.endswith(".gz") else open)(file, "rt", encoding="latin-1") as f:
            return f.read()
    except OSError as error:
        raise CaseError(f"{file}: {error.strerror or error}") from None


def without_comments(text):
    """Text of an OpenFOAM file without its comments and header."""
    text = re.sub(r"/\*.*?\*/|//[^\n]*", " ", text, flags=re.S)
    return re.sub(r"\bFoamFile\s*\{[^}]*\}", " ", text)


def read_dictionary(file):
    """An OpenFOAM dictionary as nested dicts; lists as lists, other values as strings."""
    text = without_comments(read_text(file))
    if re.search(r"[#$]", text):
        # Directives and macros are OpenFOAM's to resolve
        try:
            text = subprocess.run(
                ["foamDictionary", "-expand", file],
                check=True, capture_output=True, text=True, encoding="latin-1",
            ).stdout
        except (OSError, subprocess.CalledProcessError):
            raise CaseError(f"{file}: its # and $ need OpenFOAM's foamDictionary") from None
        text = without_comments(text)
    tokens = re.findall(r'"[^"]*"|[{}();]|[^\s{}();"]+', text)

    def fail(what):
        raise CaseError(f"{file}: {what}")

    def read(at, nested):
        entries = {}
        while at < len(tokens) and tokens[at] != "}":
            key = tokens[at]
            if at + 1 < len(tokens) and tokens[at + 1] == "{":
                entries[key], at = read(at + 2, True)
                continue
            try:
                end = tokens.index(";", at)
            except ValueError:
                fail(f"entry '{key}' has no ';'")
            words = tokens[at + 1:end]
            entries[key] = words[1:-1] if words[:1] == ["("] else " ".join(words)
            at = end + 1
        if nested != (at < len(tokens)):
            fail("'{' and '}' do not match")
        return entries, at + 1

    return read(0, False)[0]


def read_csv(file, types):
    """The named columns of a CSV file with a header, as a structured array."""
    if not os.path.isfile(file):
        raise CaseError(f"{file}: not there")
    with open(file, encoding="latin-1") as f:
        header = f.readline().strip().split(",")
    missing = [name for name, _ in types if name not in header]
    if missing:
        raise CaseError(f"{file}: no column {missing[0]}")
    try:
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", "loadtxt: input contained no data")
            rows = np.loadtxt(
                file, dtype=types, delimiter=",", skiprows=1, ndmin=1,
                usecols=[header.index(name) for name, _ in types],
            )
    except (ValueError, IndexError) as error:
        raise CaseError(f"{file}: {error}") from None
    for name, kind in types:
        if kind is float and not np.isfinite(rows[name]).all():
            line = 2 + int(np.argmin(np.isfinite(rows[name])))
            raise CaseError(f"{file}: line {line}: {name} is not a number")
    return rows


def number_folders(root):
    """(value, name) of the folders named by a number, ascending."""
    found = []
    for name in os.listdir(root) if os.path.isdir(root) else []:
        is_number = re.fullmatch(r"\d+(\.\d*)?(e[+-]?\d+)?", name)
        if is_number and os.path.isdir(os.path.join(root, name)):
            found.append((float(name), name))
    return sorted(found)


def coincide(points, others, tolerance):
    """Which of the points lie on one of the others."""
    near = np.zeros(len(points), dtype=bool)
    if len(others):
        (x0, y0), (x1, y1) = others.min(axis=0) - tolerance, others.max(axis=0) + tolerance
        x, y = points.T
        candidates = np.flatnonzero((x >= x0) & (x <= x1) & (y >= y0) & (y <= y1))
        for part in np.array_split(candidates, len(candidates) // 1000 + 1):
            apart = np.abs(points[part, None] - others[None]).max(axis=2)
            near[part] = apart.min(axis=1, initial=np.inf) <= tolerance
    return near
