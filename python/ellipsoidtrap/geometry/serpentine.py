# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""Blocks of a serpentine with a trap at every bend, and the sections of the traps' throats:

  constant/generated/blocks      what system/blockMeshDict includes
  constant/generated/apertures   what constant/ellipsoidCloudProperties includes

usage: makeGeometry [-traps N] [-leg LENGTH] [-throat WIDTH]   (run in the case folder)

Lengths in micrometres. Legs run along x, one above another; where one begins, straight ahead
of the stream that comes up into it, a pocket with a throat leads to the end of the next.
"""

import argparse
import os

WIDTH, DEPTH = 3.0, 2.2  # of the channel
POCKET, LENGTH = 2.2, 1.0  # width and depth of a pocket, length of its throat
END = 4.0  # of the channel before and after
CELL = 0.28  # of the mesh

HEAD = "// Written by makeGeometry: changes are lost\n"


def count(length):
    """Mesh cells over a length."""
    return round(length / CELL)


class Serpentine:
    """Columns and rows of blocks; columns of either end are counted from the wall."""

    def __init__(self, traps, leg, throat):
        self.traps, self.throat = traps, throat
        edge = (POCKET - throat) / 2
        ends = [0, edge, POCKET - edge, POCKET, WIDTH]
        side = [2, 4, 2, 3]
        self.x = ends + [leg - v for v in reversed(ends)]
        self.nx = side + [round((leg - 2 * WIDTH) / 0.5)] + side[::-1]
        self.rows = [("in", -1, END)]
        for k in range(traps + 1):
            self.rows.append(("leg", k, WIDTH))
            if k < traps:
                self.rows += [("pocket", k, POCKET), ("throat", k, LENGTH)]
        self.rows.append(("out", traps, END))
        self.y = [-END]
        for _, _, height in self.rows:
            self.y.append(self.y[-1] + height)

    def of_trap(self, i, k):
        """Column from the outer wall, at the end where trap k is; 4 or more: not there."""
        return i if k % 2 == 0 else len(self.nx) - 1 - i

    def is_fluid(self, i, j):
        """Is this block there?"""
        if not (0 <= i < len(self.nx) and 0 <= j < len(self.rows)):
            return False
        kind, k, _ = self.rows[j]
        # Trap k is above where the channel comes up into leg k; up to the next at the other end
        if kind == "leg" or self.of_trap(i, k + 1) < 4:
            return True
        return self.of_trap(i, k) < {"pocket": 3, "throat": 3}.get(kind, 0) and (
            kind == "pocket" or self.of_trap(i, k) == 1)

    def patch(self, i, j, dj):
        """Patch of a block's side: dj is -1 down, 1 up, 0 to the left or right."""
        for row in (j, j + dj):
            if not 0 <= row < len(self.rows):
                return "inlet" if row < 0 else "outlet"
            kind, k, _ = self.rows[row]
            if kind in ("pocket", "throat") and self.of_trap(i, k) < 4:
                return f"S{k + 1}"
        return "channel"

    def vertex(self, i, j, top):
        """Number of a vertex."""
        return (top * len(self.y) + j) * len(self.x) + i

    def text(self):
        """What blockMesh reads."""
        patches = {}
        blocks = []
        layers = count(DEPTH)
        for j, (kind, _, height) in enumerate(self.rows):
            ny = 4 if kind == "throat" else count(height)
            for i, nx in enumerate(self.nx):
                if not self.is_fluid(i, j):
                    continue
                corners = ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1))
                a, b, c, d = (self.vertex(*v, 0) for v in corners)
                e, f, g, h = (self.vertex(*v, 1) for v in corners)
                blocks.append(f"hex ({a} {b} {c} {d} {e} {f} {g} {h}) ({nx} {ny} {layers}) simpleGrading (1 1 1)")
                patches.setdefault("bottom", []).append((a, d, c, b))
                patches.setdefault("top", []).append((e, f, g, h))
                for di, dj, face in ((-1, 0, (a, e, h, d)), (1, 0, (b, c, g, f)),
                                     (0, -1, (a, b, f, e)), (0, 1, (d, h, g, c))):
                    if not self.is_fluid(i + di, j + dj):
                        patches.setdefault(self.patch(i, j, dj), []).append(face)
        lines = ["vertices", "("]
        lines += [f"({x:.6g} {y:.6g} {z})" for z in (0, DEPTH) for y in self.y for x in self.x]
        lines += [");", "blocks", "(", *blocks, ");", "edges ();", "boundary", "("]
        for name, faces in sorted(patches.items()):
            kind = "patch" if name in ("inlet", "outlet") else "wall"
            lines.append(f"{name} {{ type {kind}; faces (")
            lines += ["(" + " ".join(map(str, face)) + ")" for face in faces] + ["); }"]
        return "\n".join(lines + [");"]) + "\n"

    def apertures(self):
        """Boxes about the throats."""
        lines = []
        for j, (kind, k, _) in enumerate(self.rows):
            if kind == "throat":
                x = sorted(self.x[i] for i in ((0, 4) if k % 2 == 0 else (-1, -5)))
                lines.append(f"S{k + 1} {{ min ({x[0]:.6g}e-6 {self.y[j]:.6g}e-6 -1e-6);"
                             f" max ({x[1]:.6g}e-6 {self.y[j + 1]:.6g}e-6 {DEPTH + 1:.6g}e-6); normal (0 1 0);"
                             f" area {self.throat * DEPTH:.6g}e-12; }}")
        return "\n".join(lines) + "\n"


def make(words):
    """Write both files."""
    parser = argparse.ArgumentParser(prog="makeGeometry", description=__doc__, allow_abbrev=False,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-traps", type=int, default=6, metavar="N")
    parser.add_argument("-leg", type=float, default=26, metavar="LENGTH")
    parser.add_argument("-throat", type=float, default=1.2, metavar="WIDTH")
    given = parser.parse_args(words)
    if given.traps < 1 or not given.leg > 2 * WIDTH or not 0 < given.throat < POCKET:
        parser.error(f"-traps from 1, -leg above {2 * WIDTH:g}, -throat above 0 and below {POCKET:g}")
    serpentine = Serpentine(given.traps, given.leg, given.throat)
    os.makedirs("constant/generated", exist_ok=True)
    for name, text in (("blocks", serpentine.text()), ("apertures", serpentine.apertures())):
        with open(f"constant/generated/{name}", "w", encoding="ascii") as file:
            file.write(HEAD + text)
    print(f"{given.traps} traps, legs of {given.leg:g} um, throats {given.throat:g} um wide")

