# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""Cases of sideBySide, of the stock tool and of ours, on a mesh and with a flow that are there."""

import csv
import os
import re
import shutil
import subprocess
import sys

import numpy as np

# All cases have this outer clock [s]; the stock tool makes its interpolations anew for each interval
INTERVAL = 5e-3

TABLES = "postProcessing/ellipsoidCloud/0"


def head(name, kind="dictionary"):
    """The head of a file of OpenFOAM."""
    return f"FoamFile {{ version 2.0; format ascii; class {kind}; object {name}; }}\n"


class Case:
    """A folder with mesh, flow and settings of another."""

    program = ""

    def __init__(self, folder, name, source):
        self.name, self.path, self.source = name, folder / "runs" / name, folder / source
        self.ranks, self.count, self.options = 1, 0, []
        # Of the last run, all ranks together [s]
        self.user = self.kernel = 0
        shutil.rmtree(self.path, ignore_errors=True)
        shutil.copytree(self.source / "system", self.path / "system")
        (self.path / "constant").mkdir()
        (self.path / "constant" / "polyMesh").symlink_to((self.source / "constant" / "polyMesh").resolve())
        shutil.copytree(self.source / "0", self.path / "0")

    def write(self, file, text, kind="dictionary"):
        """A file with its head."""
        (self.path / file).write_text(head(os.path.basename(file), kind) + text, encoding="ascii")

    def change(self, file, **entries):
        """Entries that stand on lines of their own."""
        text = (self.path / file).read_text(encoding="ascii")
        for entry, value in entries.items():
            text, found = re.subn(rf"(?m)^{entry}\s.*;", f"{entry} {value};", text)
            if found != 1:
                sys.exit(f"sideBySide: {file}: {found} times {entry}")
        (self.path / file).write_text(text, encoding="ascii")

    def span(self, end):
        """From 0 to the end [s], where the state is written."""
        self.change("system/controlDict", startFrom="startTime", deltaT=INTERVAL, endTime=end, writeInterval=end)

    def clean(self):
        """Remove what an earlier run left."""
        for path in self.path.iterdir():
            if re.match(r"postProcessing|processor|[1-9]|0\.", path.name):
                shutil.rmtree(path)

    def run(self):
        """Run the program."""
        self.clean()
        command = [self.program, *self.options]
        if self.ranks > 1:
            self.write("system/decomposeParDict", f"numberOfSubdomains {self.ranks}; method simple;\n"
                       f"simpleCoeffs {{ n (1 {self.ranks} 1); delta 0.001; }}\n")
            self.call(["decomposePar", "-force"], "log.decomposePar")
            command = ["mpirun", "--oversubscribe", "-np", str(self.ranks), *command, "-parallel"]
        self.call(command, "log")

    def time(self):
        """Processor time of the last run [s]."""
        return self.user + self.kernel

    def call(self, command, log):
        """A command, and its processor time and that of what it starts."""
        before = os.times()
        with open(self.path / log, "w", encoding="ascii") as to:
            status = subprocess.run(command, cwd=self.path, stdout=to, stderr=to, check=False).returncode
        if status:
            tail = (self.path / log).read_text(encoding="ascii").splitlines()[-30:]
            sys.exit("\n".join([*tail, f"sideBySide: {command[0]} failed in {self.path}"]))
        after = os.times()
        self.user = after.children_user - before.children_user
        self.kernel = after.children_system - before.children_system


class OursCase(Case):
    """Ellipsoids, by ellipsoidTrapFoam."""

    program = "ellipsoidTrapFoam"

    def __init__(self, folder, name, source):
        super().__init__(folder, name, source)
        shutil.copy(self.source / "constant" / "transportProperties", self.path / "constant")
        self.settings = ""

    def choose(self, interpolation, motion, tolerance):
        """The settings to compare, with the paper's model: the stock tool sees the flow at a point, and no walls."""
        self.settings = (f"interpolation {interpolation}; motion {motion};\ncontact {{ cells off; }}\n"
                         "forces { flow centre; wallResistance none; }\n"
                         f"integration {{ tolerance {tolerance}; }}\n"
                         'capture { sieves ("S[1-8]"); displacement 4e-6; holdTime 1; }\n')

    def inject(self, injections):
        """Injections as in the dictionary."""
        self.settings += f"injection {{ {injections} }}\n"

    def inject_listed(self, cells, bursts):
        """Cells at their places, in so many bursts over 1 s."""
        texts = []
        for i in range(bursts):
            part = cells[i * len(cells) // bursts:(i + 1) * len(cells) // bursts]
            centres = " ".join(f"({row['x1']} {row['x2']} {row['x3']})" for row in part)
            turned = " ".join(f"({row['eps1']} {row['eps2']} {row['eps3']} {row['eta']})" for row in part)
            texts.append(f"burst{i} {{ type positions; start {i / bursts}; positions ({centres}); "
                         f"orientations ({turned}); }}")
        self.inject("\n".join(texts))

    def span(self, end):
        """With rows of tracks at the end alone."""
        super().span(end)
        self.write("constant/ellipsoidCloudProperties", self.settings +
                   f"tracks {{ interval {end}; heldInterval {end}; minimumMove 1e-12; }}\n")

    def ends(self, time):
        """Positions at a time, by the cells' numbers."""
        with open(self.path / TABLES / "tracks.csv", encoding="ascii") as file:
            return {int(row["id"]): np.array([float(row[key]) for key in ("x1", "x2", "x3")])
                    for row in csv.DictReader(file) if abs(float(row["t"]) - time) < 1e-9}

    def load(self):
        """Seconds of tracking by the clock, evenness of the ranks [%], part of their time in which cells move [%]."""
        text = (self.path / "log").read_text(encoding="ascii")
        clock = float(re.search(r"^tracking: (\S+) s", text, re.M)[1])
        line = re.search(r"^load of the ranks.*:((?: \S+ \(\d+\))+); evenness (\S+) %", text, re.M)
        if not line:
            return clock, 100.0, 100.0
        seconds = [float(s) for s in re.findall(r"(\S+) \(", line[1])]
        return clock, float(line[2]), 100 * sum(seconds) / (len(seconds) * clock)

    def mesh_cells(self):
        """How many the mesh has."""
        with open(self.path / "constant" / "polyMesh" / "owner", "rb") as file:
            return int(re.search(rb"nCells:\s*(\d+)", file.read(2000))[1])


class StockCase(Case):
    """Spheres of 1 um, by the stock tool; its steps are limited by maxCo."""

    program = "icoUncoupledKinematicParcelFoam"

    def __init__(self, folder, name, source, largest_courant):
        super().__init__(folder, name, source)
        self.largest_courant = largest_courant
        self.change("system/controlDict", application=self.program)
        schemes = self.path / "system" / "fvSchemes"
        schemes.write_text(schemes.read_text(encoding="ascii").replace("steadyState", "Euler"), encoding="ascii")
        self.write("constant/transportProperties", "transportModel Newtonian; nu 1e-6; rhoInf 997.5;\n")
        self.write("constant/turbulenceProperties", "simulationType laminar;\n")
        self.write("constant/g", "dimensions [0 1 -2 0 0 0 0]; value (0 0 -9.81);\n", "uniformDimensionedVectorField")

    def inject_listed(self, cells, bursts):
        """Spheres at the places, in so many bursts over 1 s."""
        models = ""
        for i in range(bursts):
            part = cells[i * len(cells) // bursts:(i + 1) * len(cells) // bursts]
            places = "\n".join(f"({row['x1']} {row['x2']} {row['x3']})" for row in part)
            self.write(f"constant/positions{i}", f"{len(part)}\n(\n{places}\n)\n", "vectorField")
            models += (f'burst{i} {{ type manualInjection; massTotal 0; parcelBasisType fixed; nParticle 1; '
                       f'SOI {i / bursts}; U0 (0 0 0); positionsFile "positions{i}"; '
                       "sizeDistribution { type fixedValue; fixedValueDistribution { value 1e-6; } } }\n")
        self.write("constant/kinematicCloudProperties", f"""
solution
{{
    active true; coupled false; transient yes; cellValueSourceCorrection off; maxCo {self.largest_courant};
    sourceTerms {{ schemes {{}} }}
    interpolationSchemes {{ rho cell; U cellPoint; mu cell; }}
    integrationSchemes {{ U Euler; }}
}}
constantProperties {{ rho0 1040; alphaMax 0.99; parcelTypeId 1; }}
subModels
{{
    particleForces {{ sphereDrag; gravity; }}
    injectionModels {{ {models} }}
    dispersionModel none; patchInteractionModel standardWallInteraction; surfaceFilmModel none;
    stochasticCollisionModel none; collisionModel none; heatTransferModel none;
    standardWallInteractionCoeffs {{ type rebound; e 0; mu 0; }}
}}
cloudFunctions {{}}
""")

    def ends(self, time):
        """Positions at a time, by the numbers of the spheres."""
        folder = self.path / f"{time:g}" / "lagrangian" / "kinematicCloud"
        labels = (folder / "origId").read_text(encoding="ascii")
        listed = re.search(r"\n(\d+)\s*\(([\d\s]*)\)", labels)
        places = re.findall(r"\((\S+) (\S+) (\S+)\) \d+", (folder / "positions").read_text(encoding="ascii"))
        return {int(label): np.array(place, float) for label, place in zip(listed[2].split(), places)}


def first_cells(case):
    """Places and orientations that a case draws."""
    case.run()
    with open(case.path / TABLES / "cells.csv", encoding="ascii") as file:
        return list(csv.DictReader(file))
