# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""The picture of a drawing's plan: what has been read of it, its patches, and places that are marked."""

import os

from ..colours import BLUE, GREEN, ORANGE, PURPLE, SKY, VERMILLION
from . import rings
from .surfaces import FRAGMENTS

FILE = f"{FRAGMENTS}/plan.png"
MARK = "Written by makeGeometry"
COLOURS = (BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY)
FLUID, RED = "#E3F0F8", "#C00000"
STYLES = ("-", (0, (4, 1)), (0, (1, 1)))
MOST_PLACES = 200


def is_ours():
    """May the file be written?"""
    try:
        with open(FILE, "rb") as file:
            return MARK.encode() in file.read(4096)
    except FileNotFoundError:
        return True


def draw_plan(axes, plan):
    """The fluid, and the edges of every patch: in a colour and style of its own, or with its name if there are too many."""
    from matplotlib.collections import LineCollection

    for ring in plan:
        axes.fill(*zip(*ring.points), facecolor=FLUID if ring.encloses else "white", zorder=0 if ring.encloses else 1)
    lines = {}
    for ring in plan:
        for edge in rings.edges(ring):
            lines.setdefault(ring.patches[edge.index], []).append((edge.start, edge.end))
    many = len(lines) > len(COLOURS)*len(STYLES)
    for i, (name, some) in enumerate(lines.items()):
        colour, style = COLOURS[i % len(COLOURS)], STYLES[i//len(COLOURS) % len(STYLES)]
        axes.add_collection(LineCollection(some, colors=colour, linewidths=0.5 if many else 1.5, zorder=2,
                                           linestyles=[style], label=None if many else name))
        if many:
            x, y = zip(*(point for edge in some for point in edge))
            axes.text((min(x) + max(x))/2, max(y), name, size=4, horizontalalignment="center", verticalalignment="bottom")


def draw(lines, plan, places):
    """Write the picture of the plan, or of the lines while there is none; what to add to a message."""
    try:
        import matplotlib
        matplotlib.use("Agg")
        import matplotlib.pyplot as plt
        from matplotlib.collections import LineCollection
    except ModuleNotFoundError:
        return " (no picture of it: Python has no matplotlib)"
    if not is_ours():
        return f" (no picture of it: {FILE} is yours)"
    figure, axes = plt.subplots(figsize=(9, 7), layout="constrained")
    if plan:
        draw_plan(axes, plan)
    else:
        axes.add_collection(LineCollection(lines, colors="0.3", linewidths=0.8))
    axes.autoscale_view()
    if places:
        axes.plot(*zip(*places[:MOST_PLACES]), "o", markersize=16, markerfacecolor="none", markeredgecolor=RED,
                  markeredgewidth=2, zorder=4, label="here")
    axes.set_aspect("equal")
    axes.margins(0.05)
    axes.set_xlabel("x [µm]")
    axes.set_ylabel("y [µm]")
    if axes.get_legend_handles_labels()[0]:
        axes.legend(loc="upper left", bbox_to_anchor=(1, 1), frameon=False)
    os.makedirs(FRAGMENTS, exist_ok=True)
    figure.savefig(FILE, dpi=240, metadata={"Description": MARK, "Software": None})
    plt.close(figure)
    return f"; see {FILE}"
