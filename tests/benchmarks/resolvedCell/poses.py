#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the models make of walls, beside the resolved cell, at poses about the sieve of singleSieve.

usage: poses.py PROGRAM CASE FOLDER [FINENESS]
    PROGRAM     resolvedCell, built
    CASE        a singleSieve that has been run, in the environment of OpenFOAM
    FOLDER      is made; what is run is there
    FINENESS    of the panels [2]

Prints for every pose the speed of the flow at the centre, the resolved speed over that, the speed
that the resolved spin gives the tip of the cell, likewise, and of each model how far both are off,
over the speed of the flow. Then of the resistance, over that of the free body, what the models give of
the resolved one on its diagonal, body frame.
"""

import csv
import math
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "python"))
from ellipsoidtrap.pictures.poses import rotation  # noqa: E402

AXES = (0.5, 2, 0.5)        # um
DEPTH = 10
POSTS = (
    [(-4, -4), (-2, -4), (-2, 0), (-0.4, 0), (-0.4, 1), (-4, 1)],
    [(4, -4), (4, 1), (0.4, 1), (0.4, 0), (2, 0), (2, -4)],
)
FORCE, TORQUE = 1e-13, 1e-19    # N, N m
CHANNEL = (-12, 12, -30, 30)
X, Y, Z = (1, 0, 0), (0, 1, 0), (0, 0, 1)
MODELS = {
    "none": "flow centre; wallResistance none;", "plane": "flow centre; wallResistance plane;",
    "body": "flow body; wallResistance none;", "both": "flow body; wallResistance plane;",
}
HEADER = "FoamFile { version 2.0; format ascii; class dictionary; object ellipsoidCloudProperties; }\n"


def support(axis, normal):
    """Height of the centre of a cell that touches a plane."""
    along = np.dot(axis, normal) / np.linalg.norm(axis)
    return math.sqrt(AXES[0]**2 * (1 - along**2) + AXES[1]**2 * along**2)


def quaternion(axis):
    """That turns the body axis x2 to an axis, not to its reverse."""
    axis = np.array(axis) / np.linalg.norm(axis)
    turned = np.append(np.cross(Y, axis), 1 + axis[1])
    return turned / np.linalg.norm(turned)


def make_poses():
    """(name, centre [um], axis)"""
    poses = []
    for gap in (0.1, 0.3, 1):
        oblique, aside = (1, 2, 0), math.sqrt(0.5)
        poses += [
            (f"beside the post, along, {gap}", (4 + support(Y, X) + gap, -1.5, 5), Y),
            (f"beside the post, upright, {gap}", (4 + support(Z, X) + gap, -1.5, 5), Z),
            (f"beside the post, oblique, {gap}", (4 + support(oblique, X) + gap, -1.5, 5), oblique),
            (f"before the post, across, {gap}", (3, -4 - support(X, Y) - gap, 5), X),
            (f"before the post, tip on, {gap}", (3, -4 - support(Y, Y) - gap, 5), Y),
            (f"corner, across, {gap}", (4 + (0.5 + gap) * aside, -4 - (0.5 + gap) * aside, 5), (1, 1, 0)),
            (f"corner, tip on, {gap}", (4 + (2 + gap) * aside, -4 - (2 + gap) * aside, 5), (1, -1, 0)),
            (f"aperture, oblique, {gap}", (0, -0.5 - gap, 5), (1, 0, 1)),
            (f"aperture, upright, {gap}", (0, -0.5 - gap, 5), Z),
            (f"in the sieve, along, {gap}", (1.5 - gap, -2.2, 5), Y),
            (f"floor, along, {gap}", (8, -2, 0.5 + gap), Y),
            (f"edge of post and floor, {gap}", (4.5 + gap, -1.5, 0.5 + gap), Y),
        ]
    return poses + [("in the aperture, 0.1", (0, -1.6, 5), Y), ("far from walls", (8, -12, 5), (1, 1, 1))]


def make_device():
    """The walls, rectangles of four corners [um]."""
    x0, x1, y0, y1 = CHANNEL
    edges = [pair for post in POSTS for pair in zip(post, post[1:] + post[:1])]
    edges += [((x0, y0), (x0, y1)), ((x1, y0), (x1, y1))]
    walls = [((*a, 0), (*b, 0), (*b, DEPTH), (*a, DEPTH)) for a, b in edges]
    return walls + [((x0, y0, z), (x1, y0, z), (x1, y1, z), (x0, y1, z)) for z in (0, DEPTH)]


def write_walls(file, walls):
    """An STL in um, of few triangles."""
    with open(file, "w", encoding="utf-8") as out:
        for a, b, c, d in walls:
            for corners in ((a, b, c), (a, c, d)):
                out.write("".join("vertex {:g} {:g} {:g}\n".format(*corner) for corner in corners))


def run(command, folder):
    """What a shell command prints."""
    return subprocess.run(command, shell=True, cwd=folder, check=True, capture_output=True, text=True).stdout


def make_case(case, folder, poses, *entries):
    """A copy of the device and its flow, with cells at poses and no others."""
    folder.mkdir()
    for name in ("constant", "system", "0"):
        shutil.copytree(case / name, folder / name)
    cells = "".join(
        "p{} {{ type positions; positions (({:.9g} {:.9g} {:.9g})); orientation quaternion;"
        " quaternion ({:.15g} {:.15g} {:.15g} {:.15g}); }}\n".format(
            n, *(1e-6 * np.array(x)), *quaternion(axis)) for n, (_, x, axis) in enumerate(poses)
    )
    (folder / "constant/ellipsoidCloudProperties").write_text(
        "\n".join((f"{HEADER}motion inertialess;", f"injection {{ {cells} }}", "contact { cells off; }", *entries)),
        encoding="utf-8")


def write_control(folder, **entries):
    """Entries of controlDict that are there."""
    control = (folder / "system/controlDict").read_text(encoding="utf-8")
    for name, value in entries.items():
        control = re.sub(rf"^{name} .*;", f"{name} {value};", control, flags=re.M)
    (folder / "system/controlDict").write_text(control, encoding="utf-8")


def motions(case, folder, poses, forces, *entries):
    """Velocity [m/s] and spin [rad/s, body] of every cell by the program, in its first microsecond."""
    make_case(case, folder, poses, f"forces {{ {forces} }}", "tracks { interval 1e-7; minimumMove 1e-12; }", *entries)
    write_control(folder, endTime="1e-6", deltaT="1e-6", writeInterval="1e-6")
    run("ellipsoidTrapFoam -frozenFlow > log.ellipsoidTrapFoam 2>&1", folder)
    found = {}
    with open(folder / "postProcessing/ellipsoidCloud/0/tracks.csv", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            if float(row["t"]) > 0:
                found.setdefault(int(row["id"]), [
                    np.array([float(row[f"{name}{i}"]) for i in (1, 2, 3)]) for name in ("u", "omega")])
    return [found[n] for n in range(len(poses))]


def resistances(case, folder, poses, forces):
    """(6, 6) of every cell by the program, body frame [N s/m, N s, N m s], from what a force and a torque change."""
    folder.mkdir()
    pushes = [f"external{name} {tuple(size * (k == n) for k in range(3))};".replace(",", "")
              for name, size in (("Force", FORCE), ("Torque", TORQUE)) for n in range(3)]
    still, *moved = [motions(case, folder / str(n), poses, forces + push) for n, push in enumerate(["", *pushes])]
    found = []
    for n, (_, _, axis) in enumerate(poses):
        turn = rotation(quaternion(axis))
        columns = np.array([np.append(turn.T @ (one[n][0] - still[n][0]), one[n][1] - still[n][1]) for one in moved]).T
        # Forces are in the lab
        found.append(np.linalg.inv(np.hstack((columns[:, :3] @ turn / FORCE, columns[:, 3:] / TORQUE))))
    return found


def resolved_resistance(text, axis):
    """The (6, 6) that the program prints, body frame."""
    turn = np.kron(np.eye(2), rotation(quaternion(axis)).T)
    return turn @ np.array([line.split()[:6] for line in text.splitlines() if line.startswith(" ")], float) @ turn.T


def resolved(program, folder, poses, fineness, walls=None, axes=AXES):
    """(velocity, spin, velocity of the flow at the centre, resistance over the free body's) of every cell, resolved."""
    write_walls(folder / "walls.stl", walls or make_device())
    commands = [
        " ".join([program, "walls.stl", *map(str, (*axes, *x, *quaternion(axis), fineness))])
        for _, x, axis in poses
    ]
    panels = [np.array([line.split() for line in run(f"{one} -", folder).splitlines()], float) for one in commands]
    points = np.concatenate(panels + [np.array([x for _, x, _ in poses])])
    listed = "\n".join("({:.10g} {:.10g} {:.10g})".format(*point) for point in 1e-6 * points)
    (folder / "system/samples").write_text(
        'type sets; libs ("libsampling.so" "libmeshFlow.so"); interpolationScheme divergenceFree;\n'
        f"setFormat raw; fields (U); sets ( panels {{ type cloud; axis xyz; points ({listed}); }} );\n",
        encoding="utf-8")
    run("postProcess -func samples -fields '(U phi)' -time 0 > log.postProcess 2>&1", folder)
    sampled = np.loadtxt(next(folder.glob("postProcessing/samples/0/*.xy")))
    assert np.abs(sampled[:, :3] - 1e-6 * points).max() < 1e-11, "not all panels are in the fluid"
    velocities = np.split(sampled[:, 3:], np.cumsum([len(one) for one in panels]))
    free = np.diag(resolved_resistance(run(" ".join(
        [program, "none", *map(str, (*axes, 0, 0, 0, *quaternion(Y), fineness))]), folder), Y))
    found = []
    for n, (_, _, axis) in enumerate(poses):
        np.savetxt(folder / "flow", np.column_stack((panels[n], velocities[n])), fmt="%.9g")
        text = run(f"{commands[n]} flow", folder)
        motion = np.array(text.split("free")[1].split(), float)
        found.append((motion[:3], rotation(quaternion(axis)).T @ motion[3:] * 1e6, velocities[-1][n],
                      np.diag(resolved_resistance(text, axis)) / free))
    return found


def print_motions(poses, models, truth):
    """The first table."""
    print("| pose, gap [um] | flow [mm/s] | speed | " + " | ".join(models) + " | tip | " + " | ".join(models) + " |")
    print("| --- " * (4 + 2 * len(models)) + "|")
    errors = []
    for n, (name, _, _) in enumerate(poses):
        u, omega, flow, _ = truth[n]
        speed, tip = np.linalg.norm(flow), 1e-6 * max(AXES)
        off = [np.linalg.norm(one[n][0] - u) / speed for one in models.values()]
        turned = [tip * np.linalg.norm(one[n][1] - omega) / speed for one in models.values()]
        errors.append(off + turned)
        print(f"| {name} | {1e3 * speed:.2f} | {np.linalg.norm(u) / speed:.3f} | " + " | ".join(f"{e:.3f}" for e in off)
              + f" | {tip * np.linalg.norm(omega) / speed:.3f} | " + " | ".join(f"{e:.3f}" for e in turned) + " |")
    for name, of in (("median", 0.5), ("nine of ten below", 0.9), ("worst", 1)):
        row = np.quantile(errors, of, axis=0)
        half = len(models)
        print(f"| **{name}** | | | " + " | ".join(f"{e:.3f}" for e in row[:half]) + " | | "
              + " | ".join(f"{e:.3f}" for e in row[half:]) + " |")


def print_resistances(case, folder, poses, truth):
    """The second one."""
    free = np.diag(resistances(case, folder / "free", poses[-1:], "")[0])
    walls = resistances(case, folder / "walls", poses, "wallResistance plane;")
    print("\n| resistance along | resolved, largest | none / resolved: least, median | plane / resolved: least, median, largest |")
    print("| --- " * 4 + "|")
    for k, name in enumerate(("x1", "x2, the axis", "x3", "turning about x1", "about x2", "about x3")):
        exact = np.array([one[3][k] for one in truth])
        ratio = np.array([one[k, k] for one in walls]) / free[k] / exact
        plain = 1 / exact
        print(f"| {name} | {exact.max():.1f} | {plain.min():.2f}, {np.median(plain):.2f} | "
              f"{ratio.min():.2f}, {np.median(ratio):.2f}, {ratio.max():.2f} |")


def main(program, case, folder, fineness="2"):
    """Both tables."""
    program, case, folder = str(Path(program).resolve()), Path(case), Path(folder)
    folder.mkdir()
    poses = make_poses()
    models = {name: motions(case, folder / name, poses, forces) for name, forces in MODELS.items()}
    truth = resolved(program, folder / "none", poses, fineness)
    print_motions(poses, models, truth)
    print_resistances(case, folder, poses, truth)


if __name__ == "__main__":
    if len(sys.argv) not in (4, 5):
        sys.exit(__doc__.strip())
    main(*sys.argv[1:])
