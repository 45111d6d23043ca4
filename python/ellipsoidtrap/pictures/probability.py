# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""How probable it is that a sieve catches a cell, and that it holds exactly one of N.

The probability p that a cell ends in sieve S_i is the share of the cells injected, by
their fate at the end, of CASE or of all --members together.

Without --members, P(exactly one of N) is that of N independent cells, N p (1-p)^(N-1),
with the limits that those of p leave it; for runs with 'contact { cells off; }'. With
--members, runs that differ in their seed, it is the share of the runs in which S_i holds
in the end exactly one of the N cells that were injected first. Nothing is assumed of how
cells act on one another; but where they push, cells that came after these N may have had
a part in what became of them.

Intervals are Wilson's. Where cells push they are wider, as the spread between runs is (shares.py), that
of --members if it is larger. The table also tells how many cells, and how many runs, it takes
for a half-width of --precision about the shares found.
"""

import os

import matplotlib.pyplot as plt
import numpy as np

from . import style
from .case import Case, NotApplicable
from .files import CaseError, read_csv
from .shares import dispersion_of, exactly_one, exactly_one_within, trials_for, wilson

PUSH = "with 'contact { cells on; }' they push one another; runs of several seeds (--members) tell"

OPTIONS = {
    "members": {
        "nargs": "+", "metavar": "FOLDER", "default": (),
        "help": "runs that differ in their seed, such as a sweep's [CASE alone]",
    },
    "cells": {
        "type": int, "metavar": "N",
        "help": "for which N the table tells P(exactly one) [all]",
    },
    "precision": {
        "type": float, "metavar": "P", "default": 0.05,
        "help": "half-width wanted of an interval, of 1 [%(default)s]",
    },
    "confidence": {
        "type": float, "metavar": "C", "default": 0.95,
        "help": "of the intervals [%(default)s]",
    },
}


MARKS = 40   # whole numbers N that are marked, at most
POINTS = {"linestyle": "none", "marker": "o", "markersize": 2.6}


def whole_numbers(most):
    """From 1 to so many, in even ratios where there are many: the peak is at 1/p, wherever that is."""
    if most <= MARKS:
        return np.arange(1, most + 1)
    return np.unique(np.geomspace(1, most, MARKS).round().astype(int))


def holders(case):
    """The sieve that holds each cell in the end, or '', in the order of injection."""
    types = [("id", int), ("tInjected", float), ("fate", "U16"), ("patch", "U128")]
    cells = read_csv(os.path.join(case.results, "cells.csv"), types)
    cells = cells[np.lexsort((cells["id"], cells["tInjected"]))]
    return np.where(cells["fate"] == "caught", cells["patch"], "")


def spread(case, runs, name):
    """Variance of the number caught by a sieve between runs by that of independent cells; as
    a few runs tell it badly, that of pushing cells is the least."""
    found = dispersion_of([np.sum(run == name) for run in runs], list(map(len, runs)))
    return max(found, case.dispersion)


def check_options(cells, precision, confidence, most):
    """Refuse what makes no sense."""
    if not 0 < precision < 0.5:
        raise CaseError(f"--precision {precision:g}: must be between 0 and 0.5")
    if not 0 < confidence < 1:
        raise CaseError(f"--confidence {confidence:g}: must be between 0 and 1")
    if cells is not None and not 1 <= cells <= most:
        raise CaseError(f"--cells {cells}: must be 1 to {most}, the cells of a run")


def read_runs(cases):
    """Holders of each run, all of the same length; no run twice."""
    runs = [holders(one) for one in cases]
    fewest = min(map(len, runs))
    if fewest == 0:
        raise NotApplicable("no cell has been injected")
    seeds = [one.properties.get("seed", "1") for one in cases]
    if len(set(seeds)) < len(seeds):
        twice = next(seed for seed in seeds if seeds.count(seed) > 1)
        raise CaseError(f"--members: several runs have the seed {twice}: they are no replicates")
    return runs, fewest


def bounded(share, low, high):
    """In words."""
    return f"{share:.4f} ({low:.4f}-{high:.4f})"


def draw_panel(ax, marks, share, limits, alone, confidence):
    """What is known of one sieve, for every N."""
    ax.vlines(marks, *limits[marks - 1].T, color="0.75", linewidth=1.2, label=f"{100 * confidence:g} % interval")
    ax.plot(marks, share[marks - 1], label="P(exactly one)", **POINTS, color="black")
    # No peak is missed between the marks
    ax.plot(np.arange(1, len(share) + 1), share, color="black", linewidth=0.6)
    if len(share) > MARKS:
        ax.set_xscale("log")
    if alone is not None:
        ax.plot(marks, alone[marks - 1], label="N independent cells", **POINTS, color=style.VERMILLION,
                markerfacecolor="none")
    ax.grid(True)


def draw(case, members=(), cells=None, precision=0.05, confidence=0.95):
    """The figure."""
    cases = [Case(folder) for folder in members] or [case]
    runs, fewest = read_runs(cases)
    check_options(cells, precision, confidence, fewest)
    sieves = cases[0].sieves
    if not sieves:
        raise NotApplicable("the case has no sieves")
    if not members and case.blocking:
        raise NotApplicable("held cells block the flow, so that P(exactly one of N) is not that of independent "
                            "cells: runs of several seeds tell (--members)")
    if not members and not case.independent:
        print(f"probability: not of independent cells: {PUSH}")
    cells = cells or fewest
    numbers = np.arange(1, fewest + 1)
    injected = sum(map(len, runs))

    basis = f"{len(runs)} runs" if members else "if independent"
    table = [[
        "sieve", "held of injected", "p", f"P(exactly one of {cells}), {basis}",
        "cells for p", "runs for P",
    ]]
    drawn, marks = [], whole_numbers(fewest)
    counts = {name: sum(int(np.sum(run == name)) for run in runs) for name in sieves}
    shown, others = style.with_room(counts)
    columns = min(len(shown), 4)
    rows = -(-len(shown) // columns)
    figure, grid = plt.subplots(
        rows, columns, figsize=(1.2 + 2.1 * columns, 0.9 + 1.9 * rows), sharex=True,
        sharey=True, squeeze=False, layout="constrained",
    )
    for ax in grid.flat[len(shown):]:
        ax.set_visible(False)
    panels = dict(zip(shown, grid.flat))
    for name, held in counts.items():
        wide = spread(case, runs, name) if members else cases[0].dispersion
        p, ends = held / injected, wilson(held, injected, confidence, wide)
        if members:
            ones = np.sum([np.cumsum(run[:fewest] == name) == 1 for run in runs], axis=0)
            share = ones / len(runs)
            limits = np.array([wilson(n, len(runs), confidence) for n in ones])
        else:
            share = exactly_one(p, numbers)
            limits = np.array([exactly_one_within(*ends, n) for n in numbers])
        alone = exactly_one(p, numbers)
        if name in panels:
            panels[name].set_title(name)
            draw_panel(panels[name], marks, share, limits, alone if members else None, confidence)
        drawn += [
            (name, int(n), *map(float, (share[n - 1], *limits[n - 1], alone[n - 1]))) for n in numbers
        ]
        at = cells - 1
        table.append([
            name, f"{held}/{injected}", bounded(p, *ends), bounded(share[at], *limits[at]),
            trials_for(p, precision, confidence), trials_for(share[at], precision, confidence),
        ])
    grid.flat[0].margins(x=0.05)
    grid.flat[0].set_ylim(bottom=min(-0.02, grid.flat[0].get_ylim()[0]))
    figure.supxlabel("cells injected, N", fontsize=9)
    figure.supylabel("P(exactly one of N held)", fontsize=9)
    figure.legend(*grid.flat[0].get_legend_handles_labels(), loc="upper center", ncol=3,
                  bbox_to_anchor=(0.5, 0))
    columns = ("sieve", "N", "P(exactly one)", "low", "high", "of N independent cells")
    style.describe(
        figure, f"{caption(cases, members, precision, confidence)} {others}", (columns, drawn), table
    )
    return figure


def widened(case):
    """In words."""
    if case.independent:
        return ""
    return f", of p for {case.dispersion:.2g} times the variance of independent cells"


def caption(cases, members, precision, confidence):
    """What the numbers mean, and what was assumed."""
    if members:
        how = f"""the share of {len(cases)} runs of different seeds in which the sieve holds in
            the end exactly one of the first N cells; dashed, what it would be for independent
            cells of the probability p"""
    else:
        how = "N p (1-p)^(N-1), of independent cells"
        if not cases[0].independent:
            how += f", which these are not: {PUSH}"
    return f"""Probability p that a cell ends in the sieve, and P that the sieve holds exactly one
        of N: {how}. In brackets and in grey Wilson's {100 * confidence:g} % intervals{widened(cases[0])}. The last
        columns: cells for a half-width of {precision:g} about p, and runs for the same about P."""
