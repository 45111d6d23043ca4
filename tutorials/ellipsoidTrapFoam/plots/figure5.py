#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""The mesh in the plan of the device, and the surroundings of a sieve's apertures."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.lines import Line2D
from matplotlib.patches import ConnectionPatch, Patch, Rectangle

import style
from case import CaseError


HEIGHT = 6.0      # of the plan, in inches
SIEVE_COLOUR = style.VERMILLION


def finest(plane, name):
    """Square window (xlim, ylim) about the smallest mesh cells at a sieve."""
    corners = plane.outlines[name].reshape(-1, 2)
    low, high = corners.min(axis=0), corners.max(axis=0)
    middles = np.array([polygon.mean(axis=0) for polygon in plane.polygons])
    inside = ((middles > low) & (middles < high)).all(axis=1)
    small = inside & (plane.areas < 2 * plane.areas[inside].min())
    low, high = middles[small].min(axis=0), middles[small].max(axis=0)
    half = 0.6 * max(high - low)
    return np.add.outer((low + high) / 2, [-half, half])


def draw_mesh(ax, case, linewidth):
    """Mesh cells and walls, sieves in colour."""
    ax.add_collection(PolyCollection(
        case.plane.polygons, facecolors="white", edgecolors="0.35", linewidths=linewidth
    ))
    style.draw_outlines(ax, case, 1, SIEVE_COLOUR)


def draw_close_up(whole, close, case, name):
    """The window about a sieve's finest mesh cells, and where it lies in the plan."""
    window = finest(case.plane, name)
    style.plan_axes(close, *window)
    draw_mesh(close, case, 0.4)
    close.yaxis.tick_right()
    close.yaxis.set_label_position("right")
    close.set_title(f"finest mesh at {name}")
    (x0, x1), (y0, y1) = window
    frame = {"edgecolor": style.BLUE, "linewidth": 1}
    whole.add_patch(Rectangle((x0, y0), x1 - x0, y1 - y0, fill=False, **frame))
    for y in (y0, y1):
        whole.add_artist(ConnectionPatch(
            (x1, y), (x0, y), "data", "data", axesA=whole, axesB=close, **frame
        ))


def draw(case, sieve=None):
    """The figure."""
    plane = case.plane
    names = case.sieves
    if sieve is not None and sieve not in names:
        file = case.path("constant", "ellipsoidCloudProperties")
        raise CaseError(f"{file}: no sieve {sieve}")
    bounds = np.array(plane.bounds)
    margin = 0.02 * np.ptp(bounds, axis=1).max()
    limits = bounds + [-margin, margin]
    width, height = np.ptp(limits, axis=1)

    widths = [HEIGHT * width / height, HEIGHT] if names else [HEIGHT * width / height]
    figure, axes = plt.subplots(
        1, len(widths), figsize=(sum(widths) + 0.9 * len(widths), HEIGHT + 1), squeeze=False,
        width_ratios=widths, layout="compressed",
    )
    whole = axes[0, 0]
    style.plan_axes(whole, *limits)
    draw_mesh(whole, case, np.clip(12 / np.sqrt(len(plane.velocity)), 0.12, 0.5))
    whole.set_title(f"{len(plane.velocity):,} of {case.mesh_size:,} mesh cells at half depth")
    keys = [
        Line2D([], [], color="0.35", linewidth=0.5, label="mesh"),
        Line2D([], [], color="black", linewidth=1, label="wall"),
    ]
    if names:
        keys.append(Line2D([], [], color=SIEVE_COLOUR, linewidth=1, label="sieve"))
        # The nearest to the close-up, so that the lines to it cross little
        rightmost = max(names, key=lambda name: plane.outlines[name][..., 0].mean())
        draw_close_up(whole, axes[0, 1], case, sieve or rightmost)
    keys.append(Patch(facecolor=style.SOLID, label="no fluid"))
    style.legend_below(whole, keys)
    return figure


if __name__ == "__main__":
    style.command(
        draw, __doc__, sieve={"help": "to look at closely [the rightmost]"}
    )
