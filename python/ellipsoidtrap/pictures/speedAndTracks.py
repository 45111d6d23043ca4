# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""Speed of the flow at half depth, with the tracks of all cells by their fate."""

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.patches import Patch

from . import style

SHOWN = 100   # tracks of escaped cells at most: more would hide the flow
FAINT = 0.45  # how much of them is seen


def thinned(cells):
    """So many of the cells, in even steps; they entered in no order."""
    return [cells[i * len(cells) // min(SHOWN, len(cells))] for i in range(min(SHOWN, len(cells)))]


def rows_of(plane, tracks):
    """The flow in the mesh cells cut, and the paths drawn, in rows."""
    middles = np.array([polygon.mean(axis=0) for polygon in plane.polygons])
    speed = np.linalg.norm(plane.velocity, axis=1)
    rows = [("flow", "", "", x, y, value) for (x, y), value in zip(middles.tolist(), speed.tolist())]
    for cell, fate, track in tracks:
        rows += [
            (fate, cell, float(t), *x[:2].tolist(), float(np.linalg.norm(u)))
            for t, x, u in zip(track.t, track.x, track.u)
        ]
    return ("what", "cell", "t [s]", "x [um]", "y [um]", "speed [mm/s]"), rows


def draw(case):
    """The figure."""
    plane = case.plane
    bounds = np.array(plane.bounds)
    margin = 0.04 * np.ptp(bounds, axis=1).max()
    figure, ax = style.plan_figure(*(bounds + [-margin, margin]))
    image = style.draw_speed(ax, plane)
    style.draw_outlines(ax, case)
    style.name_openings(ax, case)
    figure.colorbar(image, ax=ax, label="speed |u| at\nhalf depth [mm/s]", aspect=35, pad=0.02)

    keys, drawn = [], []
    for fate, line in style.FATE_LINES.items():
        cells = [
            cell for cell, one in case.fates.items() if one.name == fate and cell in case.tracks
        ]
        if not cells:
            continue
        key = style.fate_key(fate, len(cells))
        if fate == "escaped" and len(cells) > SHOWN:
            key.set_label(f"escaped ({len(cells)}; {SHOWN} shown)")
            cells = thinned(cells)
        keys.append(key)
        drawn += [(cell, fate, case.tracks[cell]) for cell in cells]
        tracks = [case.tracks[cell].finer().x[:, :2] for cell in cells]
        effects = [] if fate == "escaped" else style.framed("white", line["linewidth"] + 0.6)
        ax.add_collection(LineCollection(
            tracks, colors=line["color"], linewidths=line["linewidth"],
            linestyles=[line["linestyle"]], path_effects=effects,
            alpha=FAINT if fate == "escaped" else 1,
        ))
        if fate != "escaped":
            ends = np.array([track[-1] for track in tracks])
            ax.plot(
                *ends.T, linestyle="none", markerfacecolor=line["color"], **style.LAST_POINT
            )

    for name in case.sieves:
        (left, _), (right, top) = case.box(name)
        ax.annotate(
            f"{name}: {case.count('caught', name)}", ((left + right) / 2, top),
            xytext=(0, 3), textcoords="offset points", ha="center", va="bottom",
            fontsize=8, fontweight="bold", path_effects=style.framed("white", 2),
        )
    keys.append(Patch(facecolor=style.SOLID, edgecolor="black", label="no fluid"))
    # Wider than the plan it would part that from its colour bar
    style.legend_below(ax, keys, most=3 if len(keys) == 3 else 2)
    style.describe(figure, f"""Speed of the flow at half depth, and the paths of the cells' centres
        by fate, of those that escaped {SHOWN} at most; points mark where cells are that have not
        left. Numbers beside the sieves are the cells that they hold.""", rows_of(plane, drawn))
    return figure
