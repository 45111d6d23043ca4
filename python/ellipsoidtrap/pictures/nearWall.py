# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""Spin rate against the distance from the sieves' walls: what movies 2 to 5 of the paper show.

Taken from the rows of all tracks in the chamber while the cell moves. Distance is that of
the cell's centre from the surfaces of the sieves. Cells that pass and cells that end in a
sieve are kept apart: in its pocket the flow is slow, and so is their spin.
"""

from collections import namedtuple

import matplotlib.pyplot as plt
import numpy as np

from . import style
from . import walls
from .case import NotApplicable

# Lengths in units of unit()
FAR = 8.0        # up to which the plot goes
EDGES = np.array([0.4, 0.7, 1, 1.4, 2, 2.8, 4, 5.6, FAR])
CLOSE, APART = 1.0, 4.0   # the number that is told: nearer than one, farther than the other
MIDDLE = 1 / 3   # part of the depth in the middle of which floor and ceiling shear little
FEWEST = 20      # rows that make a median

Rows = namedtuple("Rows", "distance spin middle passing")


def unit(case):
    """Width of a cell [µm], of small ones that of the default cell."""
    return max(1.0, 2 * case.semi_axes.min())


def moving_rows(case):
    """Distance [µm] from the sieves, spin rate [rad/s], and whether in the middle of the
    depth and of a cell that escapes, of all rows in the chamber at which it is not slow."""
    share = case.number(0.01, "capture", "speedFraction")
    slow = share * case.entry_speed
    low, high = case.depth
    parts = []
    for cell, track in case.tracks.items():
        moves = np.linalg.norm(track.u, axis=1) > slow
        if case.chamber:
            moves &= np.abs(track.x[:, 1]) < case.chamber[1]
        # The row of the injection has no spin yet
        moves[:1] = False
        passing = np.full(len(moves), case.fates[cell].name == "escaped")
        spin = np.linalg.norm(track.omega, axis=1)
        parts.append(np.column_stack((track.x, spin, passing))[moves])
    rows = np.concatenate(parts) if parts else np.empty((0, 5))
    distance = walls.distance(case, case.sieves, rows[:, :3], within=FAR * unit(case))
    middle = np.abs(rows[:, 2] - (low + high) / 2) < MIDDLE / 2 * (high - low)
    near = np.isfinite(distance)
    return Rows(distance[near], rows[near, 3], middle[near], rows[near, 4] == 1)


def medians(distance, spin, edges):
    """Middle, median, quartiles and number of rows of each bin that has enough."""
    found = []
    for low, high in zip(edges, edges[1:]):
        values = spin[(distance >= low) & (distance < high)]
        if len(values) >= FEWEST:
            found.append((np.sqrt(low * high), *np.percentile(values, (50, 25, 75)), len(values)))
    return np.array(found).reshape(-1, 5)


def draw(case):
    """The figure."""
    if not case.sieves:
        raise NotApplicable("the case has no sieves")
    if not case.tracks:
        raise NotApplicable("no cell has been injected")
    rows = moving_rows(case)
    edges, far, close, apart = (unit(case) * length for length in (EDGES, FAR, CLOSE, APART))
    kinds = (
        ("cells that pass", rows.passing, style.BLUE, "o", "-"),
        (f"the same, middle {MIDDLE:.0%} of the depth", rows.passing & rows.middle,
         style.ORANGE, "s", (0, (5, 1.5))),
        ("cells that stay", ~rows.passing, "black", "^", (0, (1, 1))),
    )
    if len(medians(rows.distance[rows.passing], rows.spin[rows.passing], edges)) < 2:
        raise NotApplicable(f"too few rows of passing cells within {far:g} µm of the sieves")

    figure, (ax, number) = plt.subplots(
        2, 1, figsize=(6, 5), sharex=True, height_ratios=(3, 1), layout="constrained"
    )
    drawn = [("row", *pair, "", "", "") for pair in zip(rows.distance.tolist(), rows.spin.tolist())]
    highest = 0
    ax.scatter(rows.distance, rows.spin, s=1, color="0.8", linewidth=0, rasterized=True,
               label="rows of tracks")
    for label, chosen, colour, marker, dashes in kinds:
        bins = medians(rows.distance[chosen], rows.spin[chosen], edges)
        drawn += [(label, *one) for one in bins.tolist()]
        x, median, low, high, _ = bins.T
        highest = max(highest, high.max(initial=0))
        ax.fill_between(x, low, high, color=colour, alpha=0.25, linewidth=0)
        ax.plot(x, median, color=colour, marker=marker, linestyle=dashes, markersize=4.5,
                markeredgecolor="black", markeredgewidth=0.5, label=label)
    ax.fill_between([], [], color="0.6", alpha=0.5, label="quartiles of each")
    number.stairs(np.histogram(rows.distance, edges)[0], edges, fill=True, color="0.7",
                  edgecolor="black")
    # Room for the legend above all quartiles
    ax.set_ylim(0, max(np.percentile(rows.spin, 98), 1.45 * highest))
    ax.set_ylabel("spin rate |ω| [rad/s]")
    number.set_ylabel("rows")
    number.set_xlabel("distance of the centre from the sieves' walls [µm]")
    number.set_xscale("log")
    ticks = edges[[0, 1, 2, 4, 6, 8]]
    number.set_xticks(ticks, [f"{t:g}" for t in ticks])
    number.set_xticks([], minor=True)
    number.set_xlim(edges[0], far)
    for one in (ax, number):
        one.grid(True)
    ax.legend(loc="upper right", markerscale=1.5)

    table = [["|ω| [rad/s], centre from the sieves' walls", *(label for label, *_ in kinds)]]
    facts = []
    for title, there in (
        (f"below {close:g} µm", rows.distance < close),
        (f"{apart:g} to {far:g} µm", rows.distance > apart),
    ):
        sets = [rows.spin[there & chosen] for _, chosen, *_ in kinds]
        facts.append([np.median(one) if len(one) else np.nan for one in sets])
        table.append([title] + [
            "{1:.0f} ({0:.0f} to {2:.0f})".format(*np.percentile(one, (25, 50, 75)))
            if len(one) else "none" for one in sets
        ])
    ratios = np.divide(*facts)
    table.append(["ratio of the medians"] + [f"{ratio:.2f}" for ratio in ratios])
    where = " in the chamber" if case.chamber else ""
    style.describe(figure, f"""Spin rate of moving cells{where} against the distance of
        their centre from the sieves' walls: medians and quartiles of the {len(rows.spin)} rows
        within {far:g} µm. Of the cells that pass, the median nearer than {close:g} µm is
        {ratios[0]:.1f} times that beyond {apart:g} µm; in the middle of the depth, where
        floor and ceiling shear little, {ratios[1]:.1f} times. Cells that stay turn slowly in
        the pockets.""", (("what", "distance [um]", "|omega| [rad/s]", "low quartile", "high quartile",
                           "rows"), drawn), table)
    return figure
