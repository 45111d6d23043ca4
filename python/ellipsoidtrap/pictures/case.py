# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""What the pictures need of a case: its dictionaries, mesh, flow and the cells' files.

Lengths are in micrometres and speeds in mm/s from here on, times in seconds. The plan
of the device is the x-y plane, its depth lies along z.
"""

import os
import re
import sys
from collections import namedtuple
from functools import cached_property

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkObject
from vtkmodules.vtkCommonDataModel import vtkCompositeDataSet, vtkPlane
from vtkmodules.vtkFiltersCore import vtkAppendPolyData, vtkCleanPolyData, vtkCutter
from vtkmodules.vtkIOParallel import vtkPOpenFOAMReader
from vtkmodules.vtkParallelCore import vtkDummyController

from ..geometry.foamDictionary import WORD
from .files import (
    CaseError, number, number_folders, read_csv, read_dictionary, read_text, spelled, without_comments,
)
from .plane import Plane, coincide
from .shares import PUSHING_DISPERSION, in_words, wilson
from .track import MICRO, MILLI, Track  # noqa: F401  (others take the units from here)

# That of ellipsoid_options_default() in src/ellipsoid
OFF = ("off", "no", "false", "n", "f", "none")   # of a switch
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


class NotApplicable(Exception):
    """The case has nothing that this picture could show."""


class Case:
    """A case folder; everything is read when first asked for."""

    def __init__(self, folder):
        self.folder = os.path.abspath(folder)
        if not os.path.isfile(self.path("system", "controlDict")):
            raise CaseError(f"{folder}: not an OpenFOAM case (no system/controlDict)")

    def path(self, *parts):
        """Path of something in the case."""
        return os.path.join(self.folder, *parts)

    def target(self, *parts):
        """Path of something to be written: links of a case of another's must not lead out of it."""
        path, folder = self.path(*parts), os.path.realpath(self.folder)
        if not os.path.realpath(path).startswith(os.path.join(folder, "")):
            raise CaseError(f"{path}: leads out of the case: nothing is written there")
        return path

    # -- dictionaries --------------------------------------------------------

    @cached_property
    def properties(self):
        """constant/ellipsoidCloudProperties as nested dicts of strings and lists."""
        return read_dictionary(self.path("constant", "ellipsoidCloudProperties"))

    def number(self, default, *keys):
        """A number of the properties."""
        return number(self.path("constant", "ellipsoidCloudProperties"), self.properties, default, *keys)

    @property
    def independent(self):
        """Whether its cells do not see one another."""
        contact = self.properties.get("contact", {})
        return contact.get("cells", "on") in OFF or contact.get("active", "yes") in OFF

    @property
    def blocking(self):
        """Whether the cells that are held change the flow."""
        given = self.properties.get("occupancy", {})
        return given.get("active", "no") not in OFF and given.get("flow", "solved") == "solved"

    @cached_property
    def _of_model(self):
        """constant/modelBand, or nothing."""
        file = self.path("constant", "modelBand")
        return read_dictionary(file) if os.path.isfile(file) else {}

    @property
    def dispersion(self):
        """Variance of a number of cells caught by that of independent cells: of cells that push what
        constant/modelBand tells of this design, or else the most that has been seen."""
        if self.independent:
            return 1.0
        file = self.path("constant", "modelBand")
        return number(file, self._of_model, PUSHING_DISPERSION, "dispersion", self.design)

    @property
    def band(self):
        """(least, most) of a number of cells caught with other choices of the model, by that
        with the choices made: constant/modelBand, or None."""
        file, given = self.path("constant", "modelBand"), self._of_model
        return (number(file, given, 1, "least"), number(file, given, 1, "most")) if given else None

    def share_in_words(self, held, trials):
        """A share with the interval of chance and, where known, the band of the model."""
        words = in_words(held, trials, dispersion=self.dispersion)
        if self.band and trials:
            low, high = wilson(held, trials, dispersion=self.dispersion)
            words += f"; {100 * self.band[0] * low:.1f}-{100 * min(1, self.band[1] * high):.1f} with the model's choices"
        return words

    @cached_property
    def semi_axes(self):
        """The cells' semi-axes; where sizes vary those of the median cell."""
        words = self.properties.get("cell", {}).get("semiAxes", DEFAULT_SEMI_AXES)
        try:
            axes = np.array(words, dtype=float)
        except ValueError:
            axes = np.empty(0)
        if axes.shape != (3,) or not (axes > 0).all():
            file = self.path("constant", "ellipsoidCloudProperties")
            raise CaseError(f"{file}: cell/semiAxes are not three positive numbers: {spelled(words)}")
        return axes * MICRO

    @cached_property
    def sizes(self):
        """Cell id to its (length, width) in metres; empty where all cells are alike."""
        if "sizes" not in self.properties.get("cell", {}):
            return {}
        types = [("id", int), ("length", float), ("width", float)]
        rows = read_csv(os.path.join(self.results, "events.csv"), types)
        return {int(cell): (float(length), float(width)) for cell, length, width in rows}

    def semi_axes_of(self, cell):
        """The semi-axes of one cell: length along the second, width along the first."""
        axes = self.semi_axes
        if cell not in self.sizes:
            return axes
        length, width = self.sizes[cell]
        wider = width * MICRO / (2 * axes[0])
        return np.array((wider * axes[0], length * MICRO / 2, wider * axes[2]))

    @cached_property
    def design(self):
        """Name of the trap's design, of those in constant/trapGeometry; "" without one."""
        file = self.path("constant", "generated", "chosen")
        return read_dictionary(file).get("design", "") if os.path.isfile(file) else ""

    @cached_property
    def chamber(self):
        """(radius, y at which the channels begin) of a circular trap, or None."""
        file = self.path("constant", "generated", "chamber")
        if not os.path.isfile(file):
            return None
        chamber = read_dictionary(file)
        radius, width = (number(file, chamber, np.nan, key) for key in ("radius", "channelWidth"))
        if not radius >= width / 2 > 0:
            raise CaseError(f"{file}: radius and channelWidth are not those of a chamber")
        return radius, float(np.sqrt(radius**2 - width**2 / 4))

    @cached_property
    def loading(self):
        """How long cells enter [s]: the last duration of the injections, or as it was."""
        durations = [
            self.number(0, "injection", name, "duration")
            for name, one in self.properties.get("injection", {}).items()
            if isinstance(one, dict) and "duration" in one
        ]
        return max(durations, default=self.last_injection)

    @property
    def last_injection(self):
        """When the last cell so far entered [s]."""
        return self.events["t"][self.events["event"] == "injected"].max(initial=0)

    @cached_property
    def patches(self):
        """Patch name to type, in the order of the mesh."""
        file = self.path("constant", "polyMesh", "boundary")
        text = without_comments(read_text(file))
        found = re.findall(rf"({WORD})\s*\{{[^{{}}]*?\btype\s+(\w+)\s*;", text)
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
                names += [name for name in walls if self._matches(pattern[1:-1], name)]
            else:
                names += [name for name in walls if name == pattern]
        return list(dict.fromkeys(names))

    def _matches(self, pattern, name):
        """Is a name one of a regular expression's, as OpenFOAM understands it?"""
        for posix, own in (("[:alpha:]", "a-zA-Z"), ("[:digit:]", "0-9"), ("[:alnum:]", "a-zA-Z0-9")):
            pattern = pattern.replace(posix, own)
        try:
            return re.fullmatch(pattern, name)
        except re.error as error:
            file = self.path("constant", "ellipsoidCloudProperties")
            raise CaseError(f"{file}: capture/sieves: \"{pattern}\": {error}") from None

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
        """The time that the run has reached, which may be later than what was written last."""
        last = [value for value, _ in self.times()[-1:]]
        tracks = self.tracks if os.path.isfile(os.path.join(self.results, "tracks.csv")) else {}
        return max(last + [self.events["t"].max(initial=0)] + [track.t[-1] for track in tracks.values()])

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
            for name in re.findall(rf"({WORD})\s*\{{\s*type\s+noSlip\s*;", conditions)
        }
        fixed = re.findall(
            rf"({WORD})\s*\{{\s*type\s+fixedValue\s*;\s*value\s+uniform\s*\(([^)]*)\)",
            conditions,
        )
        for name, words in fixed:
            given[name] = tuple(float(word) * MILLI for word in words.split())
        return given

    @property
    def potential_name(self):
        """Name of the electric potential that acts on the cells, or None."""
        field = self.properties.get("forces", {}).get("electricField")
        return field.get("potential") if isinstance(field, dict) else None

    @cached_property
    def _vtk(self):
        """(mesh pieces, patch name to pieces, number of mesh cells) from VTK's reader."""
        for file in ("points", "faces", "owner", "neighbour"):
            stem = self.path("constant", "polyMesh", file)
            if not (os.path.isfile(stem) or os.path.isfile(stem + ".gz")):
                raise CaseError(f"{stem}: not there; make the mesh first")

        # What VTK would print the checks below say in one line
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
            reader.SetCellArrayStatus(name, name in ("U", self.potential_name))
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

    def patch_surfaces(self, name):
        """The pieces of a patch, VTK's polygons in metres."""
        return self._vtk[1].get(name, [])

    def box(self, name):
        """(low, high) corners in the plan of a patch: of where the plane at half depth cuts it or, of a
        floor, of all of it."""
        if name in self.plane.outlines:
            corners = self.plane.outlines[name].reshape(-1, 2)
        else:
            bounds = np.array([piece.GetBounds() for piece in self.patch_surfaces(name)
                               if piece.GetNumberOfCells()])
            corners = bounds.reshape(-1, 3, 2)[:, :2].swapaxes(1, 2).reshape(-1, 2) * MICRO
        if not len(corners):
            raise CaseError(f"{self.path('constant', 'polyMesh', 'boundary')}: patch {name} has no faces")
        return corners.min(axis=0), corners.max(axis=0)

    @cached_property
    def depth(self):
        """(lowest, highest) z of the mesh."""
        bounds = np.array([mesh.GetBounds() for mesh in self._vtk[0]]) * MICRO
        return bounds[:, 4].min(), bounds[:, 5].max()

    @property
    def entry_speed(self):
        """Mean speed at which cells enter; they start with the flow's."""
        return float(np.mean([np.linalg.norm(one.u[0]) for one in self.tracks.values()]))

    @property
    def fluxes(self):
        """(name, flux [m3/s], part of the inflow) of the apertures of the device without cells, as the
        solver logged them last."""
        file = self.path("log.ellipsoidTrapFoam")
        rows = re.findall(
            r"flow: aperture (\S+): (\S+) m3/s, (\S+) of the inflow",
            read_text(file) if os.path.isfile(file) else "",
        )
        last = {name: (name, float(flux), float(part)) for name, flux, part in rows}
        return list(last.values())

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
        if not section.GetNumberOfPolys():
            raise CaseError(f"{self.folder}: no fluid at half depth, z = {plane.GetOrigin()[2]:.3g} m")
        points = vtk_to_numpy(section.GetPoints().GetData())[:, :2] * MICRO
        polygons = section.GetPolys()
        U = vtk_to_numpy(section.GetCellData().GetArray("U"))
        potential = section.GetCellData().GetArray(self.potential_name or "")
        if not U.any():
            print(
                f"{self.folder}: the fluid of time {self.flow_time[1]} is at rest. If that is the start of a flow solved in"
                " parallel, run reconstructPar -withZero", file=sys.stderr
            )

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
            None if potential is None else vtk_to_numpy(potential).astype(float),
        )
