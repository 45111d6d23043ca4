#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the models make of a sphere that passes a round post of the tutorial postArray, beside the resolved one.

usage: roundPost.py PROGRAM CASE FOLDER [FINENESS]
    PROGRAM     resolvedCell, built
    CASE        a postArray that has been run, in the environment of OpenFOAM
    FOLDER      is made; what is run is there
    FINENESS    of the panels [3]

The sphere has a radius of 2.8 um, the post of 5 um. Prints for angles to the gap between two posts, upstream positive, and
gaps of sphere and post the velocity away from the post and along it, over the speed of the flow at the centre, of the flow, the
resolved sphere and each model.
"""

import math
import sys
from pathlib import Path

import numpy as np

from poses import MODELS, Y, motions, resolved

RADIUS, POST, MIDDLE, SIDES = 2.8, 5, (110, 32, 5), 32
ANGLES, GAPS = (67.5, 45, 22.5, 0, -22.5, -45), (0.1, 0.3, 1)


def make_post():
    """The post alone, of rectangles; its corners are those of the mesh."""
    x, y, _ = MIDDLE
    turns = [2*math.pi*k/SIDES for k in range(SIDES, 0, -1)]
    corners = [(x + POST*math.cos(turn), y + POST*math.sin(turn)) for turn in turns]
    return [((*p, -3), (*q, -3), (*q, 13), (*p, 13)) for p, q in zip(corners, corners[1:] + corners[:1])]


def main(program, case, folder, fineness="3"):
    """The table."""
    program, case, folder = str(Path(program).resolve()), Path(case), Path(folder)
    folder.mkdir()
    size = f"{RADIUS}e-6"
    cell = f"cell {{ semiAxes ({size} {size} {size}); }} contact {{ beads 1; beadRadius {size}; }}"
    outward = [np.array((-math.sin(math.radians(angle)), math.cos(math.radians(angle)), 0)) for _ in GAPS for angle in ANGLES]
    places = [np.array(MIDDLE) + (POST + RADIUS + gap)*n for n, gap in zip(outward, np.repeat(GAPS, len(ANGLES)))]
    listed = [("", place, Y) for place in places]
    models = {name: [u for u, _ in motions(case, folder / name, listed, forces, cell)] for name, forces in MODELS.items()}
    truth = resolved(program, folder / "none", listed, fineness, make_post(), (RADIUS,)*3)
    print("| gap [um] | angle | flow | resolved | " + " | ".join(models) + " |\n" + "| --- " * (4 + len(models)) + "|")
    for n, out in enumerate(outward):
        along, speed = np.array((out[1], -out[0], 0)), np.linalg.norm(truth[n][2])
        columns = [truth[n][2], truth[n][0]] + [one[n] for one in models.values()]
        print(f"| {GAPS[n // len(ANGLES)]} | {ANGLES[n % len(ANGLES)]} | "
              + " | ".join(f"{u @ out / speed:.3f}, {u @ along / speed:.3f}" for u in columns) + " |")


if __name__ == "__main__":
    if len(sys.argv) not in (4, 5):
        sys.exit(__doc__.strip())
    main(*sys.argv[1:])
