# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""The sieves that hold cells, close up, from above over the flow's speed and below that from the
mouth: the cells' true shapes in the colour of their height."""

import math

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import ListedColormap, Normalize, PowerNorm
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Polygon
from matplotlib.ticker import MaxNLocator

from . import style
from .case import NotApplicable
from .poses import rotation

MARGIN = 2.0     # about a sieve, in micrometres
COLUMNS = 4
LONG, ABOUT = 60.0, 10.0   # a longer sieve is shown so far about the cells that it holds
LOWEST, TALLEST = 3.4, 40  # inches
ABOVE, MOUTH = (0, 1), (0, 2)   # directions across a view from above, and along y
DASHES = {"caught": "-", "stalled": (0, (2, 1))}   # of a cell's rim
FLOW_MAP = ListedColormap(plt.get_cmap("Blues")(np.linspace(0, 0.6, 256)), "paleBlues")
HEIGHT_MAP = ListedColormap(plt.get_cmap("inferno")(np.linspace(0.08, 0.95, 256)), "height")


def shadow(x, q, semi_axes, across):
    """Outline of an ellipsoid seen along the third direction."""
    shape = (rotation(q) * semi_axes)[list(across)]
    # An ellipsoid A s, |s| = 1, is seen as the ellipse (A A^T)^(1/2) s
    squares, directions = np.linalg.eigh(shape @ shape.T)
    angle = np.linspace(0, 2 * np.pi, 97)
    circle = np.array([np.cos(angle), np.sin(angle)])
    return x[list(across)] + (directions @ (np.sqrt(squares)[:, None] * circle)).T


def in_view(case, name):
    """(low, high) corners of what is shown of a sieve that holds cells or, if it is long, of where they are."""
    low, high = case.box(name)
    held = [cell for cell, fate in case.fates.items()
            if fate.name == "caught" and fate.patch == name and cell in case.tracks]
    if held:
        places = np.array([case.tracks[cell].x[-1, :2] for cell in held])
        first, last = places.min(axis=0), places.max(axis=0)
        reach = max(case.semi_axes_of(cell).max() for cell in held)
        if (high - low).max() > LONG + reach:
            low, high = np.maximum(low, first - ABOUT - reach), np.minimum(high, last + ABOUT + reach)
        # Large cells lie far beside a wall
        low, high = np.minimum(low, first - reach), np.maximum(high, last + reach)
    return low - MARGIN, high + MARGIN


def draw_cells(ax, case, cells, across, colour_of):
    """The cells, those nearest to the viewer last."""
    hidden = 3 - sum(across)
    # From above the highest is nearest, from the mouth that of the lowest y
    sign = 1 if hidden == 2 else -1
    for cell in sorted(cells, key=lambda cell: sign * case.tracks[cell].x[-1, hidden]):
        track = case.tracks[cell]
        ax.add_patch(Polygon(
            shadow(track.x[-1], track.q[-1], case.semi_axes_of(cell), across),
            facecolor=colour_of(track.x[-1, 2]), edgecolor="white", linewidth=1.6,
        ))
        ax.add_patch(Polygon(
            shadow(track.x[-1], track.q[-1], case.semi_axes_of(cell), across), fill=False,
            edgecolor="black", linewidth=0.8, linestyle=DASHES[case.fates[cell].name],
        ))


def draw_mouth(ax, case, name, xlim):
    """What a sieve's side view shows besides cells: its upright edges."""
    low, high = case.depth
    lines = case.plane.outlines.get(name, np.empty((0, 2, 2)))
    dx, dy = np.abs(np.diff(lines, axis=1)[:, 0]).T
    edges = np.unique(lines[dx < 0.05 * dy][:, 0, 0].round(2))
    ax.vlines(edges, low, high, color="0.75", linewidth=0.6, zorder=0)
    ax.set_aspect("equal")
    ax.set_xlim(xlim)
    ax.set_ylim(low, high)
    ax.set_xlabel("x [µm]")
    ax.set_ylabel("z [µm]")


def rows_of(case, at_rest):
    """The cells at rest, in rows."""
    names = ("cell", "fate", "sieve", "x1 [um]", "x2 [um]", "x3 [um]", "eps1", "eps2", "eps3", "eta")
    rows = []
    for cell in at_rest:
        fate, track = case.fates[cell], case.tracks[cell]
        axes = case.semi_axes_of(cell)
        rows.append((
            cell, fate.name, fate.patch, *track.x[-1].tolist(), *track.q[-1].tolist(),
            *axes.tolist(),
        ))
    return (*names, *(f"semi-axis {i} [um]" for i in (1, 2, 3))), rows


def draw(case):
    """The figure."""
    at_rest = [
        cell for cell, fate in case.fates.items() if fate.name in DASHES and cell in case.tracks
    ]
    counts = {name: case.count("caught", name) for name in case.sieves}
    holding, others = style.with_room({name: count for name, count in counts.items() if count})
    if not holding:
        raise NotApplicable("no sieve holds a cell")

    plane = case.plane
    columns = min(COLUMNS, len(holding))
    rows = math.ceil(len(holding) / columns)
    windows = {}
    for name in holding:
        windows[name] = np.transpose(in_view(case, name))

    fastest = 0
    for (x0, x1), (y0, y1) in windows.values():
        x, y, _, speed = plane.speed_in((x0, x1), (y0, y1))
        fastest = max(fastest, speed[(x >= x0) & (x <= x1) & (y >= y0) & (y <= y1)].max(initial=1e-9))
    # In a pocket the flow is slow, outside it is fast
    scale = PowerNorm(0.5, 0, fastest)
    heights = ScalarMappable(Normalize(*case.depth), HEIGHT_MAP)

    width = max(np.ptp(xlim) for xlim, _ in windows.values())
    sizes = [max(np.ptp(ylim) for _, ylim in windows.values()), np.ptp(case.depth)] * rows
    figure, axes = plt.subplots(
        2 * rows, columns, squeeze=False, layout="compressed", height_ratios=sizes,
        figsize=(1.9 + 2.3 * columns, np.clip(0.7 * len(sizes) + 2.2 * sum(sizes) / width, LOWEST, TALLEST)),
    )
    for ax in axes.T.reshape(columns, rows, 2).swapaxes(0, 1).reshape(-1, 2)[len(holding):].flat:
        ax.set_axis_off()
    for k, (name, (xlim, ylim)) in enumerate(windows.items()):
        above, mouth = axes[2 * (k // columns):, k % columns][:2]
        style.plan_axes(above, xlim, ylim)
        image = style.draw_speed(above, plane, norm=scale, cmap=FLOW_MAP)
        style.draw_outlines(above, case, linewidth=1)
        number = counts[name]
        above.set_title(f"{name}: {number} cell{'s' if number > 1 else ''}")
        above.set_xlabel(None)
        draw_mouth(mouth, case, name, xlim)
        inside = [
            cell for cell in at_rest
            if np.all((case.tracks[cell].x[-1, :2] > (xlim[0], ylim[0]))
                      & (case.tracks[cell].x[-1, :2] < (xlim[1], ylim[1])))
        ]
        for ax, across in ((above, ABOVE), (mouth, MOUTH)):
            draw_cells(ax, case, inside, across, heights.to_rgba)
            for axis in (ax.xaxis, ax.yaxis):
                axis.set_major_locator(MaxNLocator(5, steps=(1, 2, 5, 10)))
            if k % columns:
                ax.set_ylabel(None)
    figure.colorbar(image, ax=axes, label="|u| at half depth [mm/s],\nsquare-root scale",
                    aspect=40, pad=0.02)
    figure.colorbar(
        heights, ax=axes, label="height z of a cell's centre [µm]", aspect=40, pad=0.02
    )
    keys = [
        Line2D([], [], color="black", linewidth=0.8, linestyle=DASHES[fate], label=f"{fate} cell")
        for fate in DASHES if case.count(fate)
    ]
    keys.append(Patch(facecolor=style.SOLID, edgecolor="black", label="no fluid"))
    style.legend_below(axes[-1, 0], keys)
    style.describe(figure, f"""The cells at rest in the sieves, their true outlines, coloured by the
        height of their centres: from above over the flow's speed at half depth, whose colours are
        those of its square root, and below along y, with the sieve's upright edges in grey.
        {others}""", rows_of(case, at_rest))
    return figure
