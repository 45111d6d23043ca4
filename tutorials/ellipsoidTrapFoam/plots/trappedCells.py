# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""The sieves that hold cells, close up: the cells' true shapes over the flow's speed."""

import math

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import PowerNorm
from matplotlib.patches import Patch, Polygon
from matplotlib.ticker import MaxNLocator

import style
from case import NotApplicable
from poses import rotation

MARGIN = 2.0     # about a sieve, in micrometres
COLUMNS = 4
CELL_COLOURS = {"caught": style.ORANGE, "stalled": style.SKY}


def shadow(x, q, semi_axes):
    """Outline in the plan of an ellipsoid seen along the depth."""
    shape = (rotation(q) * semi_axes)[:2]
    # An ellipsoid A s, |s| = 1, is seen as the ellipse (A A^T)^(1/2) s
    squares, directions = np.linalg.eigh(shape @ shape.T)
    angle = np.linspace(0, 2 * np.pi, 97)
    circle = np.array([np.cos(angle), np.sin(angle)])
    return x[:2] + (directions @ (np.sqrt(squares)[:, None] * circle)).T


def heading(case, name):
    """A sieve, the number of cells it holds, and how high they lie over one another."""
    heights = sorted(
        case.tracks[cell].x[-1, 2] for cell, fate in case.fates.items()
        if fate.name == "caught" and fate.patch == name and cell in case.tracks
    )
    if len(heights) > 5:
        levels = f"{heights[0]:.1f} to {heights[-1]:.1f}"
    else:
        levels = ", ".join(f"{height:.1f}" for height in heights)
    return f"{name}: {len(heights)} cell{'s' if len(heights) > 1 else ''}\nz = {levels} µm"


def draw(case):
    """The figure."""
    at_rest = [
        cell for cell, fate in case.fates.items()
        if fate.name in CELL_COLOURS and cell in case.tracks
    ]
    holding = [name for name in case.sieves if case.count("caught", name)]
    if not holding:
        raise NotApplicable("no sieve holds a cell")
    # The deepest first, as one sees them from above
    at_rest.sort(key=lambda cell: case.tracks[cell].x[-1, 2])

    plane = case.plane
    columns = min(COLUMNS, len(holding))
    rows = math.ceil(len(holding) / columns)
    windows = {}
    for name in holding:
        corners = plane.outlines[name].reshape(-1, 2)
        windows[name] = np.array(
            [corners.min(axis=0) - MARGIN, corners.max(axis=0) + MARGIN]
        ).T

    fastest = 0
    for (x0, x1), (y0, y1) in windows.values():
        x, y, _, speed = plane.speed_in((x0, x1), (y0, y1))
        fastest = max(fastest, speed[(x >= x0) & (x <= x1) & (y >= y0) & (y <= y1)].max())
    # In a pocket the flow is slow, outside it is fast
    scale = PowerNorm(0.5, 0, fastest)

    aspect = max(np.ptp(ylim) / np.ptp(xlim) for xlim, ylim in windows.values())
    figure, axes = plt.subplots(
        rows, columns, squeeze=False, layout="compressed",
        figsize=(1.4 + 2.7 * columns, 0.4 + (2.2 * aspect + 0.9) * rows),
    )
    for ax in axes.flat[len(holding):]:
        ax.set_axis_off()
    for ax, (name, (xlim, ylim)) in zip(axes.flat, windows.items()):
        style.plan_axes(ax, xlim, ylim)
        image = style.draw_speed(ax, plane, norm=scale)
        style.draw_outlines(ax, case, linewidth=1)
        ax.set_title(heading(case, name))
        for axis in (ax.xaxis, ax.yaxis):
            axis.set_major_locator(MaxNLocator(7, steps=(1, 2, 5, 10)))
        for cell in at_rest:
            track = case.tracks[cell]
            ax.add_patch(Polygon(
                shadow(track.x[-1], track.q[-1], case.semi_axes_of(cell)),
                facecolor=CELL_COLOURS[case.fates[cell].name], edgecolor="black",
                linewidth=0.9, alpha=0.7,
            ))
    for ax in axes[:, 1:].flat:
        ax.set_ylabel(None)
    figure.colorbar(image, ax=axes, label="|u| at half depth [mm/s]", aspect=30, pad=0.02)
    keys = [
        Patch(facecolor=colour, edgecolor="black", label=f"{fate} cell")
        for fate, colour in CELL_COLOURS.items() if case.count(fate)
    ]
    keys.append(Patch(facecolor=style.SOLID, edgecolor="black", label="no fluid"))
    style.legend_below(axes[-1, 0], keys)
    style.describe(figure, """The cells at rest in the sieves, their true outlines seen from above,
        with their heights above the bottom, over the flow's speed at half depth.""")
    return figure
