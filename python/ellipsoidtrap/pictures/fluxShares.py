# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""Share of the flow through every sieve against time, where held cells block it."""

import os

import matplotlib.pyplot as plt
import numpy as np

from . import style
from .case import FATES, NotApplicable
from .files import read_csv

OPTIONS = {}

COLUMNS = [("t", float), ("sieve", "U128"), ("flux", float), ("share", float), ("cells", int)]

EVENT_MARKS = {
    event: {
        "marker": marker, "color": color, "linestyle": "", "markersize": 6,
        "markeredgecolor": "black", "markeredgewidth": 0.6, "clip_on": False, "zorder": 3,
    }
    for event, marker, color in (("caught", "v", style.VERMILLION), ("released", "^", "white"))
}


def changes(case, sieve):
    """Times at which a sieve caught a cell, and at which it released one."""
    times = {"caught": [], "released": []}
    held = set()
    for t, cell, event, patch in case.events:
        if FATES[event] == "caught" and patch == sieve:
            held.add(cell)
            times["caught"].append(float(t))
        elif cell in held:
            held.remove(cell)
            times["released"].append(float(t))
    return times


def draw(case):
    """The figure."""
    file = os.path.join(case.results, "fluxes.csv")
    if not os.path.isfile(file):
        raise NotApplicable("no fluxes.csv: occupancy is not active")
    rows = read_csv(file, COLUMNS)
    names = list(dict.fromkeys(rows["sieve"]))
    if not names:
        raise NotApplicable("occupancy names no apertures")

    shown, others = style.with_room({name: rows["cells"][rows["sieve"] == name].max() for name in names})
    figure, axes = plt.subplots(
        len(shown), 1, figsize=(6.4, 1.3 + 0.8 * len(shown)), sharex=True, sharey=True,
        squeeze=False, layout="constrained",
    )
    top = 108 * rows["share"].max()
    marks, drawn = {}, []
    table = [["sieve", "share at the start", "at the end", "cells"]]
    panels = dict(zip(shown, axes[:, 0]))
    for name in names:
        own = rows[rows["sieve"] == name]
        times = np.append(own["t"], max(case.end_time, own["t"][-1]))
        share = 100 * np.append(own["share"], own["share"][-1])
        events = changes(case, name)
        drawn += [(name, event, t, "") for event, times_of in events.items() for t in times_of]
        drawn += [(name, "share", float(t), float(one)) for t, one in zip(times, share)]
        table.append([name, f"{share[0]:.3g} %", f"{share[-1]:.3g} %", int(own["cells"][-1])])
        if name not in panels:
            continue
        ax = panels[name]
        marks["share of the flow"], = ax.step(times, share, where="post", color=style.BLUE)
        ax.fill_between(times, share, step="post", color=style.SKY, alpha=0.4, linewidth=0)
        for event, times_of in events.items():
            if times_of:
                # The share from then on
                after = np.searchsorted(own["t"], times_of, side="right") - 1
                marks[f"cell {event}"], = ax.plot(times_of, share[after], **EVENT_MARKS[event])
        ax.set_ylabel(name, rotation=0, ha="right", va="center", fontweight="bold")
        ax.set_ylim(0, top)
        ax.grid(True)
    axes[0, 0].set_title("share of the flow into the device that passes each sieve [%]")
    axes[-1, 0].set_xlim(0, case.end_time)
    axes[-1, 0].set_xlabel("time t [s]")
    for label, mark in marks.items():
        mark.set_label(label)
    style.legend_below(axes[-1, 0], list(marks.values()))
    style.describe(figure, f"""Share of the flow into the device that passes each sieve against
        time, as the flow is solved again with the cells that are held; triangles: a cell is
        caught, or let go. {others}""", (("sieve", "what", "t [s]", "share [%]"), drawn), table)
    return figure
