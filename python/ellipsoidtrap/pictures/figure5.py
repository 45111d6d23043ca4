# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""The mesh in the plan of the device, and a close-up of the apertures of a sieve of each shape,
or of each of several designs; the paper's Figure 5."""

import math

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle
from matplotlib.ticker import MaxNLocator

from . import style
from .case import Case
from .files import CaseError


HEIGHT = 6.6      # of the plan, in inches
WIDEST = 12.0
MOST_CELLS = 80   # across a close-up
SIEVE_COLOUR = style.VERMILLION

OPTIONS = {
    "sieve": {"help": "to look at closely [one of each shape, or the last of a design]"},
    "designs": {
        "nargs": "+", "metavar": "FOLDER", "default": (),
        "help": "cases whose apertures to compare; the last is shown as a whole",
    },
}


def finest(plane, low, high):
    """Square window (xlim, ylim) about the smallest mesh cells at a sieve, which lies in a box."""
    middles = np.array([polygon.mean(axis=0) for polygon in plane.polygons])
    inside = ((middles > low) & (middles < high)).all(axis=1)
    # A sieve may fill its box, or be one straight edge
    while not inside.any():
        more = 0.1 * (high - low).max()
        low, high = low - more, high + more
        inside = ((middles > low) & (middles < high)).all(axis=1)
    small = np.flatnonzero(inside & (plane.areas < 2 * plane.areas[inside].min()))
    corners = np.concatenate([plane.polygons[k] for k in small])
    low, high = corners.min(axis=0), corners.max(axis=0)
    half = min(0.55 * max(high - low), MOST_CELLS / 2 * np.sqrt(plane.areas[small].min()))
    return np.add.outer((low + high) / 2, [-half, half])


def draw_mesh(ax, case, linewidth):
    """Mesh cells and walls, sieves in colour."""
    ax.add_collection(PolyCollection(
        case.plane.polygons, facecolors="white", edgecolors="0.35", linewidths=linewidth
    ))
    style.draw_outlines(ax, case, 1, SIEVE_COLOUR)


def draw_close_up(close, case, name, title):
    """The window about a sieve's finest mesh cells; its limits."""
    window = finest(case.plane, *case.box(name))
    style.plan_axes(close, *window)
    draw_mesh(close, case, 0.3)
    close.yaxis.tick_right()
    close.set_title(title, pad=3)
    close.yaxis.set_label_position("right")
    close.tick_params(labelsize=7, pad=1.5)
    for axis in (close.xaxis, close.yaxis):
        axis.set_major_locator(MaxNLocator(3))
    return window


def frame(whole, window, name):
    """Where a close-up lies in the plan."""
    (x0, x1), (y0, y1) = window
    whole.add_patch(Rectangle(
        (x0, y0), x1 - x0, y1 - y0, fill=False, edgecolor=style.BLUE, linewidth=1
    ))
    whole.annotate(
        name, ((x0 + x1) / 2, y1), xytext=(0, 2), textcoords="offset points", ha="center",
        fontsize=8, fontweight="bold", path_effects=style.framed("white", 2),
    )


def close_ups(case, sieve, designs):
    """(case, sieve, title) of the close-ups: one of each design, or of each shape of a sieve."""
    if designs:
        return [
            (one, name, f"design {one.design or one.folder.rsplit('/', 1)[-1]}, {name}")
            for one, name in ((one, sieve or one.sieves[-1]) for one in designs)
        ]
    if sieve:
        return [(case, sieve, sieve)]
    alike = {}
    for name in case.sieves:
        alike.setdefault(tuple(np.subtract(*case.box(name)).round(1)), []).append(name)
    return [
        (case, names[0], names[0] + (f" (all {len(names)} alike)" if names[1:] else ""))
        for names in alike.values()
    ]


def rows_of(panels, whole):
    """The mesh cells of all cases drawn, corner by corner."""
    cases = {id(one): one for one in (whole, *(one for one, *_ in panels))}
    return [
        (one.design, k, *corner) for one in cases.values()
        for k, polygon in enumerate(one.plane.polygons) for corner in polygon.tolist()
    ]


def draw(case, sieve=None, designs=()):
    """The figure."""
    designs = [Case(folder) for folder in designs]
    for one in designs or [case]:
        if sieve is not None and sieve not in one.sieves or designs and not one.sieves:
            file = one.path("constant", "ellipsoidCloudProperties")
            raise CaseError(f"{file}: no sieve {sieve or 'at all'}")
    case = designs[-1] if designs else case
    plane = case.plane
    panels = close_ups(case, sieve, designs)
    bounds = np.array(plane.bounds)
    margin = 0.02 * np.ptp(bounds, axis=1).max()
    limits = bounds + [-margin, margin]
    width, height = np.ptp(limits, axis=1)

    columns = min(len(panels), 2 if len(panels) > 3 else 1)
    rows = math.ceil(len(panels) / max(columns, 1))
    # One close-up alone leaves room for more of the plan
    side = HEIGHT / max(rows, 2)
    plan = min(HEIGHT * width / height, WIDEST)
    high = max(plan * height / width, rows * side)
    figure = plt.figure(figsize=(plan + columns * (side + 0.35) + 0.9, high + 1), layout="constrained")
    grid = figure.add_gridspec(
        max(rows, 1), 1 + columns, width_ratios=[plan] + [side] * columns
    )
    whole = figure.add_subplot(grid[:, 0])
    style.plan_axes(whole, *limits)
    draw_mesh(whole, case, np.clip(12 / np.sqrt(len(plane.velocity)), 0.12, 0.5))
    whole.set_title(f"{len(plane.velocity):,} of {case.mesh_size:,} mesh cells at half depth")
    keys = [
        Line2D([], [], color="0.35", linewidth=0.5, label="mesh"),
        Line2D([], [], color="black", linewidth=1, label="wall"),
    ]
    for k, (one, name, title) in enumerate(panels):
        close = figure.add_subplot(grid[k // columns, 1 + k % columns])
        window = draw_close_up(close, one, name, title)
        if k < len(panels) - columns:
            close.set_xlabel(None)
        if one is case:
            frame(whole, window, name)
    if panels:
        keys.append(Line2D([], [], color=SIEVE_COLOUR, linewidth=1, label="sieve"))
    keys.append(Patch(facecolor=style.SOLID, label="no fluid"))
    style.legend_below(whole, keys)
    if designs:
        figure.name = "figure5Designs"
    what = "apertures of the designs" if designs else "apertures of the sieves"
    style.describe(figure, f"""The finite volume mesh at half depth,
        {len(plane.velocity):,} of {case.mesh_size:,} mesh cells, and close-ups of the finest
        mesh cells, the {what}.""" if panels else "The finite volume mesh at half depth.",
        (("design", "mesh cell", "x [um]", "y [um]"), rows_of(panels, case)))
    return figure
