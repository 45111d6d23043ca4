# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""Speed of the flow at half depth, with the tracks of all cells by their fate."""

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.patches import Patch

import style


def draw(case):
    """The figure."""
    plane = case.plane
    bounds = np.array(plane.bounds)
    margin = 0.04 * np.ptp(bounds, axis=1).max()
    figure, ax = style.plan_figure(*(bounds + [-margin, margin]))
    image = style.draw_speed(ax, plane, vmin=0)
    style.draw_outlines(ax, case)
    style.name_openings(ax, case)
    figure.colorbar(image, ax=ax, label="speed |u| at\nhalf depth [mm/s]", aspect=35, pad=0.02)

    keys = []
    for fate, line in style.FATE_LINES.items():
        tracks = [
            case.tracks[cell].finer().x[:, :2]
            for cell, one in case.fates.items() if one.name == fate and cell in case.tracks
        ]
        if not tracks:
            continue
        effects = [] if fate == "escaped" else style.framed("white", line["linewidth"] + 0.6)
        ax.add_collection(LineCollection(
            tracks, colors=line["color"], linewidths=line["linewidth"],
            linestyles=[line["linestyle"]], path_effects=effects,
            alpha=min(1, 150 / len(tracks)) if fate == "escaped" else 1,
        ))
        if fate != "escaped":
            ends = np.array([track[-1] for track in tracks])
            ax.plot(
                *ends.T, linestyle="none", markerfacecolor=line["color"], **style.LAST_POINT
            )
        keys.append(style.fate_key(fate, len(tracks)))

    for name in case.sieves:
        corners = plane.outlines[name].reshape(-1, 2)
        ax.annotate(
            f"{name}: {case.count('caught', name)}",
            (corners[:, 0].mean(), corners[:, 1].max()),
            xytext=(0, 3), textcoords="offset points", ha="center", va="bottom",
            fontsize=8, fontweight="bold", path_effects=style.framed("white", 2),
        )
    keys.append(Patch(facecolor=style.SOLID, edgecolor="black", label="no fluid"))
    style.legend_below(ax, keys)
    style.describe(figure, """Speed of the flow at half depth, and the paths of the cells' centres
        by fate; points mark where cells are that have not left. Numbers beside the sieves are
        the cells that they hold.""")
    return figure
