# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""Cells held by every sieve against time; the paper's Figure 1."""

import os

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.ticker import MaxNLocator

from . import style
from .case import FATES, Case, NotApplicable
from .files import CaseError, read_measured

OPTIONS = {
    "measured": {
        "metavar": "FILE", "help": "CSV with the columns sieve, t [s], fewest, most (cells seen)"
    },
    "against": {"metavar": "FOLDER", "help": "another case, as one without occupancy"},
}


def holdings(case):
    """Sieve to (times, cells held from each on)."""
    changes = {name: [(0.0, 0)] for name in case.sieves}
    holder = {}
    for event in case.events:
        before = holder.pop(event["id"], None)
        if before is not None:
            changes[before].append((event["t"], -1))
        if FATES[event["event"]] == "caught" and event["patch"] in changes:
            holder[event["id"]] = event["patch"]
            changes[event["patch"]].append((event["t"], 1))
    held = {}
    for name, steps in changes.items():
        steps.append((case.end_time, 0))
        times, numbers = np.array(steps).T
        held[name] = (times, numbers.cumsum())
    return held


def number_at(held, t):
    """Cells held at a time, from what holdings() says of a sieve."""
    times, numbers = held
    return int(numbers[np.searchsorted(times, t, side="right") - 1])


def read_seen(case, measured):
    """Sieve to (t, fewest, most) of an experiment: the file given, or what the paper tells
    of this design, or nothing."""
    file = measured or case.path("constant", f"paperCaptures{case.design}.csv")
    if not (measured or os.path.isfile(file)):
        return {}
    columns = read_measured(file, ("sieve", "t", "fewest", "most"), words=("sieve",))
    for name in ("sieve", "t", "fewest"):
        if name not in columns:
            raise CaseError(f"{file}: no column {name}")
    most = columns.get("most", np.full(len(columns["t"]), np.nan))
    seen = {}
    for sieve, *numbers in zip(columns["sieve"], columns["t"], columns["fewest"], most):
        if sieve not in case.sieves:
            raise CaseError(f"{file}: the case has no sieve {sieve}")
        # A shorter run has nothing to compare with it
        if numbers[0] <= max(case.end_time, case.loading):
            seen.setdefault(sieve, []).append(tuple(numbers))
    return seen


def drawn(held, other, seen):
    """The steps, of the other case, too, and what was seen, in rows."""
    rows = [
        (name, what, float(t), int(n), "") for what, of in (("held", held), ("against", other))
        for name, (times, numbers) in of.items() for t, n in zip(times, numbers)
    ]
    rows += [
        (name, "seen", t, low, "" if np.isnan(high) else high)
        for name, marks in seen.items() for t, low, high in marks
    ]
    return ("sieve", "what", "t [s]", "cells", "most"), rows


def in_words(fewest, most):
    """A range of numbers of cells."""
    if np.isnan(most):
        return f"≥ {fewest:g}"
    return f"{fewest:g}" if most == fewest else f"{fewest:g}-{most:g}"


def holdings_against(case, folder):
    """What holdings() says of another case with the same sieves, if one is given."""
    if folder is None:
        return {}
    other = Case(folder)
    if other.sieves != case.sieves:
        raise CaseError(f"{folder}: other sieves than those of {case.path()}")
    return holdings(other)


def draw_steps(ax, held, most, marks):
    """The cells that a sieve holds against time."""
    ax.fill_between(*held, step="post", color=style.SKY, alpha=0.6, linewidth=0)
    marks["cells held"], = ax.step(*held, where="post", color=style.BLUE)
    ax.set_ylim(0, 1.2 * most)
    ax.yaxis.set_major_locator(MaxNLocator(3, integer=True))
    ax.grid(True)


def draw_bars(side, held, thirds, most):
    """The cells that a sieve holds after each third of the loading."""
    counts = [number_at(held, t) for t in thirds]
    bars = side.barh(
        range(3), counts, height=0.75, color=("0.85", style.SKY, style.BLUE),
        edgecolor="black", linewidth=0.6,
    )
    side.bar_label(bars, [f"{n} at {t:.4g} s" for n, t in zip(counts, thirds)],
                   padding=2, fontsize=7)
    side.set_xlim(0, 1.9 * most)
    side.set_yticks([])
    side.invert_yaxis()
    side.xaxis.set_major_locator(MaxNLocator(3, integer=True))
    side.spines[["top", "right"]].set_visible(False)


def draw(case, measured=None, against=None):
    """The figure."""
    if not case.sieves:
        raise NotApplicable("the case has no sieves")
    seen = read_seen(case, measured)
    whose = "measured" if measured else "the paper"
    held = holdings(case)
    other = holdings_against(case, against)
    most = max(1, max(numbers.max() for _, numbers in (*held.values(), *other.values())))
    thirds = [case.loading * k / 3 for k in (1, 2, 3)]

    shown, others = style.with_room({name: (name in seen, numbers.max()) for name, (_, numbers) in held.items()})
    figure, rows = plt.subplots(
        len(shown), 2, figsize=(7.4, 1.5 + 0.65 * len(shown)), sharex="col", squeeze=False,
        width_ratios=(4, 1.5), layout="constrained",
    )
    marks = {}
    table = [["sieve"] + [f"at {t:g} s" for t in thirds] + [f"at {case.end_time:g} s"]]
    if seen:
        table[0].append(whose)
    if other:
        table[0].append(f"{against} at the end")
    for name, (ax, side) in zip(shown, rows):
        ax.set_ylabel(name, rotation=0, ha="right", va="center", fontweight="bold")
        draw_steps(ax, held[name], most, marks)
        if other:
            marks[f"in {against}"], = ax.step(
                *other[name], where="post", color=style.VERMILLION, linestyle="--", linewidth=1
            )
        marks["last cell enters"] = ax.axvline(
            case.last_injection, color="black", linewidth=0.8, linestyle=(0, (5, 3))
        )
        for t, low, high in seen.get(name, ()):
            # Of 'several' the upper end is not known
            marks[whose] = ax.errorbar(
                t, low, [[0], [0.4 * most if np.isnan(high) else high - low]],
                lolims=np.isnan(high), color=style.VERMILLION, linewidth=1.8, capsize=4,
                **style.MEASURED,
            )
        ax.set_xlim(0, max(case.end_time, thirds[-1]))
        draw_bars(side, held[name], thirds, most)
    for name, (_, numbers) in held.items():
        row = [name, *(number_at(held[name], t) for t in thirds), int(numbers[-1])]
        if seen:
            row.append("; ".join(
                f"{in_words(low, high)} by {t:g} s" for t, low, high in seen.get(name, ())
            ) or "not named")
        if other:
            row.append(int(other[name][1][-1]))
        table.append(row)
    sums = [sum(row[k] for row in table[1:]) for k in range(1, 5)]
    table.append(["all", *sums] + [""] * bool(seen))
    if other:
        table[-1].append(sum(row[-1] for row in table[1:-1]))

    injected = len(case.fates)
    rows[0, 0].set_title(f"cells held by each sieve; in all {sums[-1]} of {injected} injected")
    rows[0, 1].set_title("while cells are loaded")
    rows[-1, 0].set_xlabel("time t [s]")
    rows[-1, 1].set_xlabel("cells")
    for label, mark in marks.items():
        mark.set_label(label)
    style.legend_below(rows[-1, 0], list(marks.values()))
    design = f" of design {case.design}" if case.design else ""
    whence = "were measured" if measured else "the paper names; of other sieves it tells nothing"
    told = f"Diamonds: cells that {whence}; arrows: or more." if seen else ""
    style.describe(figure, f"""Cells held by each sieve{design} against time, and how many after
        one, two and three thirds of the loading of {case.loading:g} s; the dashed line is when
        the last cell entered. {sums[-1]} of {injected} cells are held at {case.end_time:g} s.
        {others} {told}""", drawn(held, other, seen), table)
    return figure
