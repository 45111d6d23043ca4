#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""Orientation, velocity and spin of one cell against the time since its injection.

Without --id: of the caught cells that with the longest path, or else of all cells the
one that turns most.
"""

import matplotlib.pyplot as plt
import numpy as np

import style
from case import MILLI, CaseError, NotApplicable

# Colour and dashes of the components along x1, x2, x3
COMPONENTS = (
    {"color": style.VERMILLION, "linestyle": (0, (5, 1.5))},
    {"color": "black", "linestyle": "-"},
    {"color": style.SKY, "linestyle": (0, (1, 0.8)), "linewidth": 1.6},
)

RESTING = 1e-3   # speed in mm/s below which only rounding would be seen
SLOW = 0.01   # part of a cell's highest speed below which it is taken to rest


def path_length(track, end):
    """Length of a cell's path until the time given."""
    x = track.x[track.t <= end]
    return np.linalg.norm(np.diff(x, axis=0), axis=1).sum()


def turning(track):
    """Angle that a cell has turned through, back and forth."""
    half = np.abs((track.q[1:] * track.q[:-1]).sum(axis=1))
    return 2 * np.arccos(np.minimum(half, 1)).sum()


def choose(case):
    """The cell to show."""
    if not case.tracks:
        raise NotApplicable("no cell has been injected")
    caught = [cell for cell in case.tracks if case.fates[cell].name == "caught"]
    if caught:
        # A held cell may still roll: that is no way made
        return max(caught, key=lambda cell: path_length(case.tracks[cell], case.fates[cell].t))
    return max(case.tracks, key=lambda cell: turning(case.tracks[cell]))


def draw(case, id=None):
    """The figure."""
    cell = choose(case) if id is None else id
    if cell not in case.tracks:
        raise CaseError(f"{case.results}/tracks.csv: no cell {cell}")
    track = case.tracks[cell]
    fate = case.fates[cell]
    time = (track.t - track.t[0]) * MILLI

    # Of a long rest only the beginning is of interest
    speed = np.linalg.norm(track.u, axis=1)
    moving = np.flatnonzero(speed > SLOW * speed.max())
    end = time[-1]
    if fate.name in ("caught", "stalled") and len(moving) and speed.max() > 0:
        end = min(end, 1.15 * time[moving[-1]])

    figure, (pose, motion, spin) = plt.subplots(
        3, 1, figsize=(6.5, 6.5), sharex=True, layout="constrained"
    )
    for i, line in enumerate(COMPONENTS):
        pose.plot(time, track.axis[:, i], label=f"$O_{{x_{i + 1}}}$", **line)
        motion.plot(time, track.u[:, i], label=f"$u_{i + 1}$", **line)
    spin.plot(time, np.linalg.norm(track.omega, axis=1), color="black", label="|ω|")

    pose.set_ylabel("orientation O [-]")
    pose.set_ylim(-1.08, 1.08)
    if speed.max() < RESTING:
        motion.set_ylim(-RESTING, RESTING)
    motion.set_ylabel("velocity u [mm/s]")
    spin.set_ylabel("spin rate |ω| [rad/s]")
    spin.set_ylim(bottom=0)
    spin.set_xlabel("time since injection [ms]")
    spin.set_xlim(0, end)
    for ax in (pose, motion, spin):
        ax.grid(True)
        ax.legend(loc="center left", bbox_to_anchor=(1, 0.5))

    where = f" by {fate.patch}" if fate.name == "caught" else ""
    pose.set_title(f"cell {cell}, {fate.name}{where}, injected at t = {track.t[0]:.4g} s")
    return figure


if __name__ == "__main__":
    style.command(
        draw, __doc__.split("\n")[0],
        id={"type": int, "help": "of the cell; see cells.csv"},
    )
