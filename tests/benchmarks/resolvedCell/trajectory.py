#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A cell that grazes the sieve of singleSieve: its resolved path, and those of the models from the same start.

usage: trajectory.py PROGRAM CASE FOLDER [START [FINENESS]]
    PROGRAM     resolvedCell, built
    CASE        a singleSieve that has been run, in the environment of OpenFOAM
    FOLDER      is made; what is run is there
    START       distance of the centre from the middle of the channel, in um [1.2]
    FINENESS    of the panels [2]

The resolved cell goes from pose to pose (midpoint rule, quasi-steady, without inertia). Prints where the
cell is and how its axis is turned, in the plane of the device, at stations along the channel, and the least
gap between it and the post; the path ends where the gap is less than panels resolve.
"""

import csv
import sys
from pathlib import Path

import numpy as np
from poses import AXES, MODELS, X, make_case, quaternion, resolved, rotation, run, write_control

BEGIN, END = -10, 3         # um, along the channel
STATIONS = (-6, -5, -4, -3, -1, 1, 2)
SIDE, FRONT, BACK = 4, -4, 1    # um, of the post
STEP, NEAREST = 0.3, 0.03   # um: of the path at most, of gaps


def post_gap(x, axis):
    """Least gap [um] of the cell, its axis in the plane of the device, to the post beside it; negative: an overlap."""
    t = np.linspace(0, np.pi, 181)
    side = np.cross(axis, (0, 0, 1))
    side /= max(np.linalg.norm(side), 1e-12)
    rims = [np.outer(np.cos(t) * AXES[1], axis) + np.outer(s * np.sin(t) * AXES[0], side) for s in (1, -1)]
    points = np.array(x) + np.concatenate(rims)
    away = np.maximum(points[:, :2] - [SIDE, BACK], 0)    # beyond the side, past the back
    before = np.maximum(FRONT - points[:, 1], 0)        # in front
    inside = (points[:, 0] < SIDE) & (points[:, 1] > FRONT) & (points[:, 1] < BACK)
    gap = np.hypot(away[:, 0], np.maximum(away[:, 1], before))
    depth = np.minimum(SIDE - points[:, 0], points[:, 1] - FRONT)
    return np.where(inside, -depth, gap).min()


def angle(axis):
    """From the axis x of the device to the cell's [deg], 0 to 180."""
    return np.degrees(np.arctan2(axis[1], axis[0])) % 180


def resolved_path(program, folder, start, fineness):
    """Rows (x [um], axis)."""
    def motion(x, axis):
        u, omega, _, _ = resolved(program, folder, [("", x, axis)], fineness)[0]
        return 1e6 * u, np.cross(rotation(quaternion(axis)) @ omega, axis)

    x, axis = np.array(start, float), np.array(X, float)
    rows = [(x, axis)]
    while x[1] < END and post_gap(x, axis) > NEAREST:
        u, turn = motion(x, axis)
        step = min(STEP, max(post_gap(x, axis), 2 * NEAREST)) / (np.linalg.norm(u) + max(AXES) * np.linalg.norm(turn))
        middle = axis + 0.5 * step * turn
        u, turn = motion(x + 0.5 * step * u, middle / np.linalg.norm(middle))
        x, axis = x + step * u, axis + step * turn
        axis /= np.linalg.norm(axis)
        rows.append((x, axis))
    return rows


def model_path(case, folder, start, forces):
    """The same by the program."""
    make_case(case, folder, [("", start, X)], f"forces {{ {forces} }}", "tracks { interval 2e-5; minimumMove 1e-12; }")
    write_control(folder, endTime="0.02", deltaT="2e-4", writeInterval="0.02")
    run("ellipsoidTrapFoam -frozenFlow > log.ellipsoidTrapFoam 2>&1", folder)
    rows = []
    with open(folder / "postProcessing/ellipsoidCloud/0/tracks.csv", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            q = np.array([float(row[name]) for name in ("eps1", "eps2", "eps3", "eta")])
            rows.append((1e6 * np.array([float(row[f"x{i}"]) for i in (1, 2, 3)]), rotation(q)[:, 1]))
    return rows


def summary(rows):
    """What the table has of a path."""
    y = np.array([x[1] for x, _ in rows])
    found = []
    for station in STATIONS:
        if y.max() < station:
            found += ["-"]
            continue
        at = np.argmax(y >= station)
        part = (station - y[at - 1]) / (y[at] - y[at - 1])
        x = rows[at - 1][0][0] + part * (rows[at][0][0] - rows[at - 1][0][0])
        found += [f"{x:.3f}, {angle(rows[at][1] if part > 0.5 else rows[at - 1][1]):.0f}"]
    return [*found, f"{min(post_gap(x, axis) for x, axis in rows):.3f}"]


def main(program, case, folder, start="1.2", fineness="2"):
    """The table."""
    program, case, folder = str(Path(program).resolve()), Path(case), Path(folder)
    folder.mkdir()
    start = (float(start), BEGIN, 5)
    paths = {name: model_path(case, folder / name, start, forces) for name, forces in MODELS.items()}
    print("| path | " + " | ".join(f"y = {y}: x [um], angle" for y in STATIONS) + " | least gap |")
    print("| --- " * (2 + len(STATIONS)) + "|")
    for name, rows in paths.items():
        print(f"| {name} | " + " | ".join(summary(rows)) + " |", flush=True)
    print("| resolved | " + " | ".join(summary(resolved_path(program, folder / "none", start, fineness))) + " |")


if __name__ == "__main__":
    if not 4 <= len(sys.argv) <= 6:
        sys.exit(__doc__.strip())
    main(*sys.argv[1:])
