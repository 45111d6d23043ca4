# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""Where a cell must enter to be caught: the map that ellipsoidCaptureMap made of the inlet.

A panel an orientation of the cell. Every place has the colour of the start nearest to it;
regions from which a sieve catches cells are named above the panel.
"""

import os

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.patches import Patch

from . import style
from .case import MICRO, NotApplicable
from .files import CaseError, number_folders, read_csv

# Fates of cells that no sieve has: told apart by lightness and hatches
OTHERS = {
    "escaped": {"facecolor": "0.93"},
    "noRoom": {"facecolor": "white", "edgecolor": "0.55", "hatch": "////"},
    "stalled": {"facecolor": "0.7", "edgecolor": "0.3", "hatch": "...."},
    "inFlight": {"facecolor": "0.8", "edgecolor": "0.3", "hatch": "xxxx"},
    "lost": {"facecolor": "0.5", "edgecolor": "white", "hatch": "++++"},
}
NAMES = {"noRoom": "no room", "inFlight": "in flight"}

# Sieves beside one another differ in lightness, too
SIEVES = (
    style.VERMILLION, "black", style.SKY, style.PURPLE, style.ORANGE, style.BLUE, style.GREEN,
    "#7A4B00",
)

WIDE = 4.6   # inches of a panel
APART = 0.055   # of a panel's width, between names


class Map:
    """What ellipsoidCaptureMap left of a case."""

    def __init__(self, case):
        root = case.path("postProcessing", "captureMap")
        times = number_folders(root)
        if not times:
            raise NotApplicable(f"{root}: no map; ellipsoidCaptureMap makes one")
        self.folder = os.path.join(root, times[-1][1])
        x = [(f"x{i}", float) for i in (1, 2, 3)]
        self.starts = self.read(
            "map", [("id", int), ("orientation", int), ("fate", "U128"), *x]
        )
        self.squares = self.read("squares", [
            ("orientation", int), ("fate", "U128"), ("width", float), ("height", float), *x
        ])
        self.poses = self.read(
            "orientations", [("name", "U128"), *((f"O{i}", float) for i in (1, 2, 3))]
        )
        shares = ("inflow", "inflowLow", "inflowHigh")
        rows = self.read(
            "summary", [("orientation", "U128"), ("fate", "U128")] + [(s, float) for s in shares]
        )
        self.shares = {
            (row["orientation"], row["fate"]): [row[share] for share in shares] for row in rows
        }
        self.across = self.directions()

    def read(self, name, types):
        """A table."""
        return read_csv(os.path.join(self.folder, name + ".csv"), types)

    def directions(self):
        """The two coordinates along which the plane lies."""
        span = [np.ptp(self.starts[f"x{i}"]) for i in (1, 2, 3)]
        flat = [i for i in (1, 2, 3) if span[i - 1] < 1e-3 * max(span)]
        if len(flat) != 1:
            raise NotApplicable("the plane of the patch is not normal to an axis")
        return [f"x{i}" for i in (1, 2, 3) if i != flat[0]]

    def quarters(self, pose):
        """Fate to rectangles: the quarter of each square next to a corner is as it ends."""
        starts = self.starts[self.starts["orientation"] == pose]
        squares = self.squares[self.squares["orientation"] == pose]
        # The plane's sides are named by size alone: a square knows its own
        first, second = self.across
        unit = 1e-3 * squares["width"].min()
        ends = {
            (round(row[first] / unit), round(row[second] / unit)): str(row["fate"])
            for row in starts
        }

        def nearest(x, y):
            at = round(x / unit), round(y / unit)
            for dx in (0, -1, 1):
                for dy in (0, -1, 1):
                    found = ends.get((at[0] + dx, at[1] + dy))
                    if found:
                        return found
            raise CaseError(f"{self.folder}: squares.csv is not of the run of map.csv")

        found = {}
        for row in squares:
            x, y = row[first], row[second]
            w, h = 0.5 * row["width"], 0.5 * row["height"]
            if row["fate"] != "mixed":
                found.setdefault(str(row["fate"]), []).append((x - w, y - h, 2 * w, 2 * h))
                continue
            for a in (-1, 1):
                for b in (-1, 1):
                    found.setdefault(nearest(x + a * w, y + b * h), []).append(
                        (x + min(a, 0) * w, y + min(b, 0) * h, w, h)
                    )
        return {fate: MICRO * np.array(parts) for fate, parts in found.items()}


def corners(rectangles):
    """Of rectangles (x, y, width, height) their corners."""
    x, y, w, h = rectangles.T
    return np.stack([
        np.column_stack(pair) for pair in ((x, y), (x + w, y), (x + w, y + h), (x, y + h))
    ], axis=1)


def columns_of(found):
    """Names of what rows_of() tells, of the corner next to the axes."""
    sides = (f"{one} [um]" for one in (*found.across, "width", "height"))
    return ("orientation", "fate", *sides)


def rows_of(found, maps):
    """The rectangles drawn."""
    return [
        (str(pose["name"]), fate, *rectangle)
        for pose, regions in zip(found.poses, maps)
        for fate, rectangles in regions.items() for rectangle in rectangles.tolist()
    ]


def name_regions(ax, regions, colours):
    """The names of sieves above a panel, each with a line to the middle of its region."""
    if not regions:
        return
    left, right = ax.get_xlim()
    top = ax.get_ylim()[1]
    marks = []
    for name, rectangles in regions.items():
        x, y, w, h = rectangles.T
        area = w * h
        marks.append((np.sum((x + w / 2) * area) / area.sum(), np.max(y + h), name))
    marks.sort()
    # Apart, but not farther from where they belong than that takes
    step = APART * (right - left)
    places = np.array([x for x, _, _ in marks])
    for _ in range(100):
        for i in range(len(places) - 1):
            lacking = step - (places[i + 1] - places[i])
            if lacking > 0:
                places[i] -= lacking / 2
                places[i + 1] += lacking / 2
    for (x, y, name), place in zip(marks, places):
        ax.annotate(
            name, (x, y), xytext=(place, top + 0.07 * (right - left) / 2),
            ha="center", va="bottom", fontsize=8, color=colours[name], annotation_clip=False,
            arrowprops={"arrowstyle": "-", "linewidth": 0.6, "color": colours[name],
                        "shrinkA": 0, "shrinkB": 0},
        )


def draw(case):
    """The figure."""
    found = Map(case)
    names = [fate for pose, fate in found.shares if pose == "all"]
    sieves = [name for name in names if name not in OTHERS and name != "anySieve"]
    colours = {name: SIEVES[i % len(SIEVES)] for i, name in enumerate(sieves)}
    looks = {**OTHERS, **{name: {"facecolor": colours[name]} for name in sieves}}

    maps = [found.quarters(pose) for pose in range(len(found.poses))]
    edges = np.concatenate([part for one in maps for part in one.values()])
    low = edges[:, :2].min(axis=0)
    high = (edges[:, :2] + edges[:, 2:]).max(axis=0)
    width, height = high - low

    columns = 1 if len(maps) == 1 else 2
    rows = -(-len(maps) // columns)
    figure, axes = plt.subplots(
        rows, columns, squeeze=False, sharex=True, sharey=True, layout="constrained",
        figsize=(columns * WIDE, rows * (WIDE * height / width + 0.8)),
    )
    for ax, regions, pose in zip(axes.flat, maps, found.poses):
        ax.set_aspect("equal")
        ax.set_xlim(low[0], high[0])
        ax.set_ylim(low[1], high[1])
        for fate, rectangles in regions.items():
            look = dict(looks[fate])
            # No seams between squares of one fate
            look.setdefault("edgecolor", look["facecolor"])
            ax.add_collection(PolyCollection(
                corners(rectangles), linewidths=0 if "hatch" in look else 0.2,
                rasterized=True, **look,
            ))
        name_regions(
            ax, {name: part for name, part in regions.items() if name in sieves}, colours
        )
        likely, least, most = found.shares[pose["name"], "anySieve"]
        axis = ", ".join(f"{pose[f'O{i}']:.2f}".replace("-", "−") for i in (1, 2, 3))
        ax.set_title(
            f"{pose['name']}, long axis ({axis}):\n{likely:.2%} caught "
            f"({100 * least:.2f} to {100 * most:.2f})", pad=26,
        )
    for ax in axes.flat[len(maps):]:
        ax.remove()
    for ax in axes[-1]:
        ax.set_xlabel("xyz"[int(found.across[0][1]) - 1] + " [µm]")
    for ax in axes[:, 0]:
        ax.set_ylabel("xyz"[int(found.across[1][1]) - 1] + " [µm]")

    shown = [fate for fate in [*sieves, *OTHERS] if any(fate in one for one in maps)]
    figure.legend(
        handles=[
            Patch(**{"edgecolor": "0.3", "linewidth": 0.5, **looks[fate]},
                  label=NAMES.get(fate, fate)) for fate in shown
        ],
        loc="upper center", bbox_to_anchor=(0.5, 0), ncol=6, handlelength=1.8,
    )

    table = [["of what enters with the flow [%]", "likely", "at least", "at most"]]
    for name in names:
        if name != "noRoom":
            label = {"anySieve": "any sieve", **NAMES}.get(name, name)
            table.append([label] + [f"{100 * x:.3f}" for x in found.shares["all", name]])
    style.describe(figure, f"""Where a cell must enter to be caught: the plane of the inlet, for
        {len(maps)} orientation{'s' if len(maps) > 1 else ''} of the cell as it enters.
        {len(found.starts)} starts, each cell by itself. Every place has the colour of the
        start nearest to it. Where there is no room the cell would overlap a wall. Percentages:
        of the cells that enter with the flow; bounds from the squares that the map's
        boundaries pass through.""", (columns_of(found), rows_of(found, maps)), table)
    return figure
