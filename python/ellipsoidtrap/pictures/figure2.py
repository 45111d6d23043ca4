# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""Orientation, velocity and spin of one cell against time; the paper's Figure 2.

--cell best is the cell that fits the paper's account best, with the one in the middle of those it was
chosen from beside it; without --cell it is that where there is one, or else the caught cell with the longest path, or else the cell that
turns most.
"""

import argparse

import matplotlib.pyplot as plt
import numpy as np

from . import account
from . import style
from .account import flips
from .case import MILLI, NotApplicable
from .files import CaseError, read_measured

RESTING = 1e-3   # speed in mm/s below which only rounding would be seen
PARTS = 20   # of an interval between rows
ROWS = {"linestyle": "none", "marker": "o", "markersize": 2}
SLOW = 0.01   # part of a cell's highest speed below which it is taken to rest

COLUMNS = (
    "cell", "t [ms]", "O1", "O2", "O3", "u1 [mm/s]", "u2 [mm/s]", "u3 [mm/s]", "|omega| [rad/s]"
)

# Columns of a measured file: those of tracks.csv, t since the injection
MEASURED = ("t", "O1", "O2", "O3", "u1", "u2", "u3")


def cell_or_best(word):
    """An id, or the word best."""
    if word == "best":
        return word
    if not word.isdigit():
        raise argparse.ArgumentTypeError(f"neither a number nor 'best': {word}")
    return int(word)


OPTIONS = {
    "cell": {"type": cell_or_best, "metavar": "ID", "help": "its id in cells.csv, or best"},
    "measured": {
        "metavar": "FILE", "help": "CSV of points to overlay: t [s] since the injection, and "
        "any of O1 O2 O3 [-], u1 u2 u3 [m/s]"
    },
    "sieve": {"default": account.SIEVE, "help": f"that the cell detours [{account.SIEVE}]"},
}


def find(case, cell, sieve):
    """The cell to show, by its id, as the best, or where none is named; and its account if it
    has one, with those of the cells it was chosen from, the best first."""
    if not case.tracks:
        raise NotApplicable("no cell has been injected")
    if cell == "best":
        told = account.all_of(case, sieve)
        return told[0].cell, told
    if cell is None:
        try:
            return find(case, "best", sieve)
        except NotApplicable:
            cell = striking(case)
    if cell not in case.tracks:
        raise CaseError(f"{case.results}/tracks.csv: no cell {cell}")
    found = account.of_cell(case, cell, sieve)
    return cell, [found] if found else []


def striking(case):
    """A cell that shows much, where there is no account to go by."""
    caught = [cell for cell in case.tracks if case.fates[cell].name == "caught"]
    if caught:
        # A held cell may still roll: that is no way made
        return max(
            caught, key=lambda cell: case.tracks[cell].until(case.fates[cell].t).travelled[-1]
        )
    return max(case.tracks, key=lambda cell: case.tracks[cell].turned[-1])


def draw_measured(file, pose, motion):
    """A user's points over the curves."""
    columns = read_measured(file, MEASURED)
    if "t" not in columns or len(columns) < 2:
        raise CaseError(f"{file}: needs the column t and one of {' '.join(MEASURED[1:])}")
    time = columns.pop("t") * MILLI
    for name, values in columns.items():
        ax, scale = (pose, 1) if name[0] == "O" else (motion, MILLI)
        colour = style.COMPONENTS[int(name[1]) - 1]["color"]
        symbol = "O_{x" if name[0] == "O" else "u_{"
        ax.plot(
            time, values * scale, linestyle="none", color=colour, **style.MEASURED,
            label=f"${symbol}{'_' if name[0] == 'O' else ''}{name[1]}}}$ measured",
        )


def draw_cell(axes, case, cell, found):
    """One column: orientation, velocity and spin; the data drawn and the flips [ms]."""
    pose, motion, spin = axes
    rows = case.tracks[cell]
    track = rows.finer(PARTS)
    fate = case.fates[cell]
    begun = track.t[0]
    time = (track.t - begun) * MILLI

    # Of a long rest only the beginning is of interest
    speed = np.linalg.norm(track.u, axis=1)
    moving = np.flatnonzero(speed > SLOW * speed.max())
    end = time[-1]
    if fate.name in ("caught", "stalled") and len(moving) and speed.max() > 0:
        end = min(end, 1.15 * time[moving[-1]])
    end = max(end, 1e-9)

    for i, line in enumerate(style.COMPONENTS):
        pose.plot(time, track.axis[:, i], label=f"$O_{{x_{i + 1}}}$", **line)
        motion.plot(time, track.u[:, i], label=f"$u_{i + 1}$", **line)
    # It has none yet when it enters
    turning = np.linalg.norm(rows.spin_at(track.t), axis=1)
    turning[:PARTS] = np.nan
    spin.plot(time, turning, color="black", label="|ω|")
    written = (rows.t - begun) * MILLI
    for i, line in enumerate(style.COMPONENTS):
        for ax, values in ((pose, rows.axis), (motion, rows.u)):
            ax.plot(written, values[:, i], color=line["color"], **ROWS)
    spin.plot(
        written[1:], np.linalg.norm(rows.omega[1:], axis=1), color="black",
        label="rows of\nthe track", **ROWS,
    )
    turned = [t for t in (flips(track) - begun) * MILLI if t <= end]
    mark_times(axes, case, track, turned, end)
    if found:
        t = (found.passing - begun) * MILLI
        pose.annotate(f"past {found.sieve}", (t, 1.08), xytext=(0, 9), annotation_clip=False,
                      textcoords="offset points", ha="center", fontsize=7,
                      arrowprops={"arrowstyle": "-|>", "linewidth": 0.7})
    if speed.max() < RESTING:
        motion.set_ylim(-RESTING, RESTING)
    spin.set_xlabel("time since injection [ms]")
    spin.set_xlim(0, end)
    for ax in axes:
        ax.grid(True)
    where = f" by {fate.patch}" if fate.name == "caught" else ""
    pose.set_title(
        f"cell {cell}, {fate.name}{where}, injected at t = {begun:.4g} s", pad=22 if found else 6
    )
    drawn = np.column_stack((time, track.axis, track.u, turning))[time <= end]
    return [(cell, *row) for row in drawn.tolist()], turned


def mark_times(axes, case, track, turned, end):
    """The flips, and when the cell is in the chamber."""
    time = (track.t - track.t[0]) * MILLI
    for ax in axes:
        for t in turned:
            ax.axvline(t, color="0.35", linewidth=0.8, linestyle=(0, (5, 2)),
                       label="flip" if ax is axes[0] and t == turned[0] else None)
    if not case.chamber:
        return
    inside = np.abs(track.x[:, 1]) < case.chamber[1]
    if inside.any():
        for ax in axes:
            ax.axvspan(time[inside][0], min(time[inside][-1], end), color="0.93", linewidth=0,
                       zorder=0, label="in the chamber" if ax is axes[0] else None)


def rarity(case, told):
    """How the best cell was chosen, in words."""
    best, middle = told[0], told[len(told) // 2]
    return f"""Cell {best.cell}, on the left, is the best of the {len(told)} that pass {best.sieve} within
        {2 * account.NEAR:g} µm and flip within {MILLI * account.AFTER:g} ms after it, of
        {len(case.fates)} in all: that one fits so well tells that such a motion occurs, not how often. On the
        right is the one in the middle of these {len(told)} by its fit, cell {middle.cell}, with
        {middle.score:.2f}; {sum(one.score > 0.8 for one in told)} of them reach 0.8."""


def draw(case, cell=None, measured=None, sieve=account.SIEVE):
    """The figure."""
    cell, told = find(case, cell, sieve)
    shown = [(cell, told[0] if told else None)]
    if len(told) > 1:
        shown.append((told[len(told) // 2].cell, told[len(told) // 2]))

    figure, axes = plt.subplots(
        3, len(shown), figsize=(2.2 + 4.8 * len(shown), 6.8), sharex="col", sharey="row",
        squeeze=False, layout="constrained",
    )
    drawn, at = [], []
    for (one, found), column in zip(shown, axes.T):
        rows, turned = draw_cell(column, case, one, found)
        drawn += rows
        at.append(", ".join(f"{t:.1f}" for t in turned[:12]) + (", ..." if len(turned) > 12 else ""))
    if measured:
        draw_measured(measured, *axes[:2, 0])

    pose, motion, spin = axes[:, 0]
    pose.set_ylabel("orientation O [-]")
    pose.set_ylim(-1.08, 1.08)
    motion.set_ylabel("velocity u [mm/s]")
    spin.set_ylabel("spin rate |ω| [rad/s]")
    spin.set_ylim(bottom=0)
    for first, last in axes[:, [0, -1]]:
        last.legend(*first.get_legend_handles_labels(), loc="center left", bbox_to_anchor=(1, 0.5))

    table = ()
    if told:
        table = [row + other[1:] for row, other in zip(told[0].table(), shown[-1][1].table())] \
            if len(shown) > 1 else told[0].table()
    style.describe(figure, f"""Orientation O of the long axis, velocity u and spin rate |ω| of
        cell {cell} against the time since its injection. Points are the rows of its track; between
        them orientation and position lie on cubics with the velocity and spin of the rows; the
        curve of u is the rate of these, that of ω is smooth and turns the cell as far in every
        interval. It flips, that is O_x2 changes from
        one side of ±{account.SIDE:g} to the other, {f"at {at[0]} ms" if at[0] else "never"}.
        {told[0].explained if told else ""} {rarity(case, told) if len(told) > 1 else ""}""",
        (COLUMNS, drawn), table)
    return figure
