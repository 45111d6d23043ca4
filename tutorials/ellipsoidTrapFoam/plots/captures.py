#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""Cells held by every sieve against time, and their number at the end."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.ticker import MaxNLocator

import style
from case import FATES, NotApplicable


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


def draw(case):
    """The figure."""
    if not case.sieves:
        raise NotApplicable("the case has no sieves")
    held = holdings(case)
    most = max(1, max(numbers.max() for _, numbers in held.values()))
    loaded = case.events["t"][case.events["event"] == "injected"].max(initial=0)

    figure, rows = plt.subplots(
        len(held), 2, figsize=(7, 1.3 + 0.65 * len(held)), sharex="col", squeeze=False,
        width_ratios=(4, 1), layout="constrained",
    )
    for (name, (times, numbers)), (ax, bar) in zip(held.items(), rows):
        ax.fill_between(times, numbers, step="post", color=style.SKY, alpha=0.6, linewidth=0)
        ax.step(times, numbers, where="post", color=style.BLUE)
        ax.axvline(loaded, color="black", linewidth=0.8, linestyle=(0, (5, 3)))
        ax.set_xlim(0, case.end_time)
        ax.set_ylim(0, 1.15 * most)
        ax.yaxis.set_major_locator(MaxNLocator(3, integer=True))
        ax.set_ylabel(name, rotation=0, ha="right", va="center", fontweight="bold")
        ax.grid(True)

        bar.barh(0, numbers[-1], height=0.5, color=style.SKY, edgecolor=style.BLUE)
        bar.text(
            numbers[-1], 0, f" {numbers[-1]:.0f}", ha="left", va="center", fontweight="bold"
        )
        bar.set_xlim(0, 1.25 * most)
        bar.set_ylim(-0.6, 0.6)
        bar.set_yticks([])
        bar.xaxis.set_major_locator(MaxNLocator(4, integer=True))
        bar.spines[["top", "right"]].set_visible(False)

    figure.set_constrained_layout_pads(wspace=0.04)
    injected = len(case.fates)
    total = sum(numbers[-1] for _, numbers in held.values())
    rows[0, 0].set_title(f"cells held by each sieve; in all {total:.0f} of {injected} injected")
    rows[0, 1].set_title(f"at t = {case.end_time:g} s")
    rows[-1, 0].set_xlabel("time t [s]")
    rows[-1, 1].set_xlabel("cells")
    curve, last = rows[-1, 0].lines
    curve.set_label("cells held")
    last.set_label("last cell injected")
    style.legend_below(rows[-1, 0], [curve, last])
    return figure


if __name__ == "__main__":
    style.command(draw, __doc__)
