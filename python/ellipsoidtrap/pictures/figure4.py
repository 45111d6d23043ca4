# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""Trapping performance of every sieve by itself; the paper's Figure 4.

Of the cells that reached a sieve, the share that it held at the end; and the same of all
cells injected. A cell has reached a sieve when its centre has come within its longest
semi-axis of the sieve's walls: near enough to touch. Bars are Wilson's 95 % intervals;
where cells push one another wider, by the spread between runs of different seeds.
"""

import matplotlib.pyplot as plt
import numpy as np

from . import style
from . import walls
from .case import Case, NotApplicable
from .files import CaseError
from .shares import in_words, wilson

LOOKS = (
    {"marker": "o", "color": style.BLUE},
    {"marker": "s", "color": style.ORANGE},
    {"marker": "^", "color": "black"},
    {"marker": "D", "color": style.VERMILLION},
)

OPTIONS = {
    "designs": {
        "nargs": "+", "metavar": "FOLDER", "default": (),
        "help": "cases to compare, such as those of compareDesigns [CASE alone]",
    },
}


def reached(case):
    """Sieve to the cells that reached it."""
    paths = {cell: track.finer().x for cell, track in case.tracks.items()}
    counts = [len(path) for path in paths.values()]
    owner = np.repeat(list(paths), counts)
    reach = np.repeat([case.semi_axes_of(cell).max() for cell in paths], counts)
    points = np.concatenate(list(paths.values()))
    found = {}
    for name in case.sieves:
        near = walls.distance(case, [name], points, within=reach.max())
        # What touches a cell caught before is held without having come so near
        found[name] = set(owner[near <= reach].tolist()) | {
            cell for cell, fate in case.fates.items()
            if fate.name == "caught" and fate.patch == name
        }
    return found


def wider(cases):
    """In words."""
    most = max(one.dispersion for one in cases)
    if most == 1:
        return ""
    return (f", for {most:.2g} times the variance of independent cells where they push one another:"
            " so far runs of different seeds lie apart")


def draw(case, designs=()):
    """The figure."""
    cases = [Case(folder) for folder in designs] or [case]
    if len(cases) > len(LOOKS):
        raise CaseError(f"--designs: at most {len(LOOKS)} cases")
    names = list(dict.fromkeys(name for one in cases for name in one.sieves))
    if not names:
        raise NotApplicable("the case has no sieves")
    if not all(one.tracks for one in cases):
        raise NotApplicable("no cell has been injected")

    figure, axes = plt.subplots(2, 1, figsize=(max(7, 0.35 * len(names)), 6), sharex=True, layout="constrained")
    labels = [one.design or one.folder.rsplit("/", 1)[-1] for one in cases]
    rows = []
    table = [["held of reached"] + labels] + [[name] for name in [*names, "all, of injected"]]
    for k, (one, label, look) in enumerate(zip(cases, labels, LOOKS)):
        near = reached(one)
        at = np.arange(len(names)) + 0.22 * (k - (len(cases) - 1) / 2)
        shares, bounds = [], []
        for name, row in zip(names, table[1:]):
            held, came = one.count("caught", name), len(near.get(name, ()))
            row.append(in_words(held, came, dispersion=one.dispersion))
            for of, trials in (("reached", came), ("injected", len(one.fates))):
                low, high = wilson(held, trials, dispersion=one.dispersion)
                share = held / trials if trials else np.nan
                shares.append(share)
                bounds.append((share - low, high - share))
                rows.append((label, name, of, held, trials, share, low, high))
        table[-1].append(one.share_in_words(sum(one.count("caught", n) for n in names), len(one.fates)))
        for ax, first in zip(axes, (0, 1)):
            ax.errorbar(
                at, 100 * np.array(shares[first::2]), 100 * np.transpose(bounds[first::2]),
                linestyle="none", markersize=6, markeredgecolor="black", markeredgewidth=0.5,
                capsize=3, linewidth=1.2, label=f"design {label} ({len(one.fates)} cells)", **look,
            )
    axes[0].set_ylabel("held, of the cells that\nreached the sieve [%]")
    axes[1].set_ylabel("held, of the cells\ninjected [%]")
    axes[1].set_xticks(range(len(names)), names)
    axes[1].set_xlabel("sieve")
    for ax in axes:
        # Room for the marks of zero
        ax.set_ylim(bottom=-0.04 * ax.get_ylim()[1])
        ax.grid(True, axis="y")
        for edge in np.arange(len(names) - 1) + 0.5:
            ax.axvline(edge, color="0.85", linewidth=0.6)
    style.legend_below(axes[1], axes[0].get_legend_handles_labels()[0])
    length = f"{cases[0].semi_axes.max():g} µm" + " for the median cell" * bool(cases[0].sizes)
    style.describe(figure, f"""Trapping performance of every sieve by itself, with Wilson's 95 %
        intervals{wider(cases)}. A cell has reached a sieve when its centre has come within its longest
        semi-axis, {length}, of the sieve's walls. In the table, in brackets:
        the intervals in per cent.""",
        (("design", "sieve", "of", "held", "cells", "share", "low", "high"), rows), table)
    return figure
