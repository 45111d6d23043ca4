# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""What the sieves caught in the members of a sweep: table.csv, table.md, which is printed,
and caught.png.

usage: sweepTable FOLDER     with the members and the members.csv that the script sweep
                                leaves: member, wall time [s], and what was varied
"""

import csv
import os
import sys

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.lines import Line2D

from . import style  # the look, by being read
from .files import not_formula, read_csv
from .shares import mcnemar, wilson

RESULTS = ("postProcessing", "ellipsoidCloud", "0")
POSE = ("x1", "x2", "x3", "eps1", "eps2", "eps3", "eta")
OTHER_FATES = ("escaped", "stalled", "inFlight", "lost")
# Metres, and parts of 1: digits that were lost in writing make no other start
SAME_START = 1e-12

# Letters below the narrow axes
FITS = 24

# Shape and filling tell the sieves apart in grey
MARKERS = "osD^vPX*<>"
FILLINGS = ("white", "0.1", "0.6")


class Member:
    """One run: its values in words, and what became of its cells."""

    def __init__(self, folder, row):
        self.name, self.seconds, *values = row
        self.values = tuple(values)
        self.done = bool(self.seconds)
        if not self.done:
            return
        path = os.path.join(folder, self.name, *RESULTS)
        types = [("id", int), ("fate", "U16"), ("patch", "U128")]
        types += [(name, float) for name in POSE]
        self.cells = np.sort(read_csv(os.path.join(path, "cells.csv"), types), order="id")
        held = read_csv(os.path.join(path, "captures.csv"), [("sieve", "U128"), ("cells", int)])
        self.sieves = [str(name) for name in held["sieve"]]

        # Where it has some of the cells drawn alone, shares are of all drawn
        self.drawn = len(self.cells)
        drawn = os.path.join(folder, "starts", *RESULTS, "cells.csv")
        if os.path.isfile(drawn):
            self.drawn = len(read_csv(drawn, types))

    @property
    def injected(self):
        """Number of cells."""
        return len(self.cells)

    def caught(self, sieve=None):
        """Cells held at the end, by a sieve or by any."""
        caught = self.cells[self.cells["fate"] == "caught"]
        return len(caught) if sieve is None else int(np.sum(caught["patch"] == sieve))

    def fate(self, name):
        """Cells with one of the other fates."""
        return int(np.sum(self.cells["fate"] == name))

    def paired(self, other):
        """Has another run the same starts?"""
        a, b = self.cells, other.cells
        return np.array_equal(a["id"], b["id"]) and all(
            np.allclose(a[k], b[k], rtol=0, atol=SAME_START) for k in POSE
        )

    def only(self, other):
        """Cells caught here and not in another run of the same starts, and the reverse."""
        here, there = self.cells["fate"] == "caught", other.cells["fate"] == "caught"
        return int(np.sum(here & ~there)), int(np.sum(there & ~here))

    def compared(self, other):
        """Cells with another fate than in a run of the same starts, those caught here alone
        and there alone, and McNemar's p of these; '-' if the starts differ."""
        if not self.paired(other):
            return ["-"] * 4
        here, there = self.only(other)
        return [self.unlike(other), here, there, f"{mcnemar(here, there):.2g}"]

    def unlike(self, other):
        """Cells with another fate than in a run of the same starts."""
        a, b = self.cells, other.cells
        # Where a cell escapes matters as little as where one is lost
        held = (a["fate"] == "caught") & (a["patch"] != b["patch"])
        return int(np.sum((a["fate"] != b["fate"]) | held))


def percent(held, trials):
    """A share with its interval, in per cent."""
    low, high = wilson(held, trials)
    share = f"{100 * held / trials:.2f}" if trials else "-"
    return f"{share} ({100 * low:.2f}-{100 * high:.2f})"


def comparison(first):
    """Headers of what compared() tells."""
    of = first.name if first else "the first"
    return [f"fates unlike {of}", "caught here alone", f"in {of} alone", "p (McNemar)"]


def write_csv(file, members, names, sieves, first):
    """All numbers, a line a member."""
    shares = ("caught", *sieves)
    header = ["member", *names, "injected", "caught", *sieves]
    header += [f"{what} {part}" for what in shares for part in ("fraction", "low", "high")]
    header += [*OTHER_FATES, *comparison(first), "wall time [s]"]
    with open(file, "w", newline="", encoding="utf-8") as f:
        table = csv.writer(f)

        def write(row):
            table.writerow([not_formula(value) for value in row])

        write(header)
        for one in members:
            if not one.done:
                write([one.name, *one.values] + ["failed"] + [""] * (len(header) - len(names) - 2))
                continue
            row = [one.name, *one.values, one.injected, one.caught()]
            row += [one.caught(name) for name in sieves]
            for held in (one.caught(), *(one.caught(name) for name in sieves)):
                share = held / one.drawn if one.drawn else float("nan")
                row += [f"{v:.6g}" for v in (share, *wilson(held, one.drawn))]
            row += [one.fate(name) for name in OTHER_FATES]
            write([*row, *one.compared(first), one.seconds])


def markdown(members, names, sieves, first):
    """The lines of the short table."""
    header = ["member", *names, "injected", *sieves, "caught", "caught [%] (95 %)"]
    header += ["escaped", "stalled", "in flight", "lost"]
    header += [*comparison(first), "wall time [s]"]
    yield header
    yield ["---"] * len(header)
    for one in members:
        row = [one.name, *one.values]
        if one.done:
            row += [one.injected, *(one.caught(name) for name in sieves), one.caught()]
            row += [percent(one.caught(), one.drawn)]
            row += [one.fate(name) for name in OTHER_FATES]
            row += [*one.compared(first), one.seconds]
        else:
            row += ["failed"] + [""] * (len(header) - len(row) - 1)
        yield row


def panels(members, names):
    """(column, members in order of its values, title): where only that column differs."""
    done = [one for one in members if one.done]
    product = any(
        sum(a != b for a, b in zip(one.values, members[0].values)) > 1 for one in members
    )
    for column in range(1 if product else len(names)):
        groups = {}
        for one in done:
            rest = one.values[:column] + one.values[column + 1:]
            groups.setdefault(rest, []).append(one)
        for rest, group in groups.items():
            if len(group) < 2 and len(done) > 1 and not product:
                continue
            others = names[:column] + names[column + 1:]
            title = ", ".join(f"{name} {value}" for name, value in zip(others, rest))
            yield column, in_order(group, column), title if product else ""


def in_order(group, column):
    """By the numbers of a column, or as they come if there are words."""
    try:
        return sorted(group, key=lambda one: float(one.values[column]))
    except ValueError:
        return group


def mark(ax, at, group, sieve, **look):
    """The shares of one sieve, or of all, with their intervals."""
    shares, bounds = [], []
    for one in group:
        held = one.caught(sieve)
        share = held / one.drawn if one.drawn else np.nan
        low, high = wilson(held, one.drawn)
        shares.append(100 * share)
        bounds.append((100 * (share - low), 100 * (high - share)))
    ax.errorbar(
        at, shares, np.transpose(bounds), linestyle="none", markersize=5.5, capsize=2,
        linewidth=0.9, color="black", markeredgecolor="black", markeredgewidth=0.8, **look,
    )


def plot(file, members, names, sieves):
    """Shares against what was varied, a row for each."""
    rows = list(panels(members, names))
    figure, grid = plt.subplots(
        max(len(rows), 1), 2, figsize=(9, 2.7 * max(len(rows), 1) + 0.7), squeeze=False,
        width_ratios=(3, 1), layout="constrained",
    )
    looks = [
        {"marker": MARKERS[k % len(MARKERS)], "markerfacecolor": FILLINGS[k % len(FILLINGS)]}
        for k in range(len(sieves))
    ]
    for (column, group, title), (each, together) in zip(rows, grid):
        places = np.arange(len(group))
        for k, (sieve, look) in enumerate(zip(sieves, looks)):
            shift = 0.8 * ((k + 0.5) / len(sieves) - 0.5)
            mark(each, places + shift, group, sieve, **look)
        mark(together, places, group, None, marker="o", markerfacecolor="black")
        # The components of a vector one below the other
        labels = ["\n".join(one.values[column].strip("( )").split()) for one in group]
        widest = max(len(line) for label in labels for line in label.split("\n"))
        if widest * len(labels) > FITS:
            together.tick_params(axis="x", labelrotation=90)
        for ax in (each, together):
            ax.set_xticks(places, labels)
            ax.set_xlim(-0.5, len(group) - 0.5)
            # Room for the marks of zero
            ax.set_ylim(bottom=-0.04 * ax.get_ylim()[1])
            ax.set_xlabel(names[column])
            ax.grid(True, axis="y")
            for edge in places[1:] - 0.5:
                ax.axvline(edge, color="0.8", linewidth=0.6)
        each.set_ylabel("caught by one sieve,\nof the injected [%]")
        together.set_ylabel("caught by all [%]")
        each.set_title(title)
    keys = [
        Line2D([], [], linestyle="none", color="black", markersize=5.5, label=sieve, **look)
        for sieve, look in zip(sieves, looks)
    ]
    figure.legend(handles=keys, loc="upper center", bbox_to_anchor=(0.5, 0),
                  ncol=max(len(keys), 1), columnspacing=1.2, handletextpad=0.2)
    figure.savefig(file)
    plt.close(figure)


def main(folder):
    """All of it; whether there is a member that is done."""
    with open(os.path.join(folder, "members.csv"), newline="", encoding="utf-8") as f:
        header, *rows = csv.reader(f)
    names = header[2:]
    members = [Member(folder, row) for row in rows]
    done = [one for one in members if one.done]
    first = done[0] if done else None
    sieves = list(dict.fromkeys(name for one in done for name in one.sieves))
    write_csv(os.path.join(folder, "table.csv"), members, names, sieves, first)
    lines = ["| " + " | ".join(str(word).replace("|", "\\|") for word in row) + " |"
             for row in markdown(members, names, sieves, first)]
    with open(os.path.join(folder, "table.md"), "w", encoding="utf-8") as f:
        f.write("\n".join(lines) + "\n")
    print("\n".join(lines))
    if done:
        plot(os.path.join(folder, "caught.png"), members, names, sieves)
        print(f"plot: {os.path.join(folder, 'caught.png')}")


def command(words):
    """The command."""
    if len(words) != 1:
        sys.exit(__doc__)
    main(words[0])
