# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""The electric potential at half depth with its field lines, and the tracks of all cells.

If the case has a folder uncharged, of the same cells without charge, their tracks are drawn
too.
"""

import os

import numpy as np
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.lines import Line2D
from matplotlib.tri import LinearTriInterpolator, Triangulation

from . import style
from .case import MILLI, Case, NotApplicable

GRID = 1.0       # spacing of the points that the field lines follow, in micrometres
CHARGED = {"color": "black", "linewidth": 1.3, "linestyle": "-"}
UNCHARGED = {"color": style.VERMILLION, "linewidth": 1.1, "linestyle": (0, (4, 2))}


def draw_field_lines(ax, plane):
    """Lines along E, minus the gradient of the potential."""
    middles = np.array([polygon.mean(axis=0) for polygon in plane.polygons])
    potential = LinearTriInterpolator(Triangulation(*middles.T), plane.potential)
    (x0, x1), (y0, y1) = plane.bounds
    x, y = np.arange(x0, x1, GRID), np.arange(y0, y1, GRID)
    dy, dx = np.gradient(potential(*np.meshgrid(x, y)), y, x)
    # Twice as many along the plan as across
    ax.streamplot(
        x, y, -dx, -dy, density=(1.8, 0.5), color="0.35", linewidth=0.4, arrowsize=0.5
    )


def draw_tracks(ax, case, line):
    """The tracks of a case by cell."""
    tracks = {cell: track.finer().x[:, :2] for cell, track in case.tracks.items()}
    ax.add_collection(LineCollection(
        list(tracks.values()), colors=line["color"], linewidths=line["linewidth"],
        linestyles=[line["linestyle"]],
    ))
    return tracks


def rows_of(plane, paths):
    """The potential in the mesh cells cut, and the paths drawn, in rows."""
    middles = np.array([polygon.mean(axis=0) for polygon in plane.polygons]).tolist()
    rows = [
        ("potential", "", x, y, value)
        for (x, y), value in zip(middles, (plane.potential * MILLI).tolist())
    ]
    for what, tracks in paths.items():
        rows += [
            (what, cell, *place, "") for cell, track in tracks.items() for place in track.tolist()
        ]
    return ("what", "cell", "x [um]", "y [um]", "potential [mV]"), rows


def draw(case):
    """The figure."""
    plane = case.plane
    if plane.potential is None:
        raise NotApplicable("no electric potential acts on the cells")
    bounds = np.array(plane.bounds)
    margin = 0.04 * np.ptp(bounds, axis=1).max()
    figure, ax = style.plan_figure(*(bounds + [-margin, margin]))
    image = ax.add_collection(PolyCollection(
        plane.polygons, array=plane.potential * MILLI, cmap=style.POTENTIAL_MAP,
        edgecolors="face", linewidths=0.2, rasterized=True,
    ))
    draw_field_lines(ax, plane)
    style.draw_outlines(ax, case)
    style.name_openings(ax, case)
    figure.colorbar(image, ax=ax, label="potential [mV]", pad=0.02)

    others = {}
    keys = [Line2D([], [], color="0.35", linewidth=0.6, label="field lines")]
    if os.path.isdir(case.path("uncharged", "postProcessing")):
        others = draw_tracks(ax, Case(case.path("uncharged")), UNCHARGED)
        keys.append(Line2D([], [], label=f"without charge ({len(others)})", **UNCHARGED))
    paths = draw_tracks(ax, case, CHARGED)
    charge = case.number(0, "forces", "charge")
    keys.append(Line2D([], [], label=f"charge {charge:g} C ({len(paths)})", **CHARGED))
    style.legend_below(ax, keys)

    table = [("cell", "y at the start [µm]", "at the end", "at the end without charge")]
    for cell, track in sorted(paths.items()):
        start, end = track[0], track[-1]
        places = [start, end] + ([others[cell][-1]] if cell in others else [])
        # Not -0.00
        table.append((str(cell), *(f"{round(place[1], 2) + 0:.2f}" for place in places)))
    style.describe(figure, """The electric potential at half depth, its field lines, and the
        paths of the centres of the charged cells; dashed, if the case has them, those of the
        same cells without charge.""",
        rows_of(plane, {"charged": paths, "without charge": others}), table)
    return figure
