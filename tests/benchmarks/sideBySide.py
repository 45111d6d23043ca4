# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""Runs, tables and plot of sideBySide, which makes the meshes and solves the flow first.

usage: sideBySide.py FOLDER DOCS REPEATS LARGEST PART...
"""

import re
import statistics
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
from matplotlib import ticker

from sideBySideCases import OursCase, StockCase, first_cells

# Errors are those of the position so long after cells have entered [s]
FLIGHT = 0.03
# Ours: name, interpolation, motion, the tolerance where it does not vary. But for that the first is the
# default; the velocity of the stock tool between mesh points is that of cellPoint
WAYS = (
    ("thirteen equations, `divergenceFree`", "divergenceFree", "inertial", "1e-3"),
    ("thirteen equations, `cellPoint`", "cellPoint", "inertial", "1e-3"),
    ("`inertialess`, `cellPoint`", "cellPoint", "inertialess", "1e-3"),
)
# So few cells are for a test of this benchmark: it leaves out most of the runs
FEW = 1000
REFERENCE = "1e-8"


class Bench:
    """What a run of all parts needs: where, how often, with how many cells."""

    def __init__(self, folder, docs, repeats, largest):
        self.folder, self.docs, self.repeats, self.largest = folder, docs, repeats, largest
        self.few = largest < FEW
        # Those whose growth is measured
        self.growing = (WAYS[2],) if self.few else (WAYS[0], WAYS[2])

    def measure(self, cases, figures, repeats=None):
        """Run each case so often, in turns; medians of each of the figures that a function gives of it."""
        rows = [[] for _ in cases]
        for _ in range(repeats or self.repeats):
            for case, of_case in zip(cases, rows):
                case.run()
                of_case.append(figures(case))
                print(f"  {case.name}: " + ", ".join(f"{value:.2f}" for value in of_case[-1]), flush=True)
        return [[statistics.median(values) for values in zip(*of_case)] for of_case in rows]

    def times(self, cases, repeats=None):
        """Medians of their processor times [s]."""
        return [row[0] for row in self.measure(cases, lambda case: (case.time(),), repeats)]

    def trap(self, name, way, tolerance, number, duration=1.0, end=1.2):
        """Cells through the whole inlet of the circular trap."""
        case = OursCase(self.folder, name, "trap")
        case.choose(*way[1:3], tolerance)
        case.inject(f"inlet {{ type patch; patch inlet; number {number}; duration {duration}; }}")
        case.span(end)
        return case


def quantiles(ends, reference):
    """Median and nine in ten of the distances of cells that both have [nm]."""
    if set(ends) != set(reference):
        sys.exit(f"sideBySide: {len(ends)} cells beside {len(reference)}")
    far = [1e9 * np.linalg.norm(ends[key] - reference[key]) for key in reference]
    return float(np.quantile(far, 0.5)), float(np.quantile(far, 0.9))


def at_error(rows, error):
    """Time at an error, between the logarithms of the neighbours; None beyond the ends."""
    rows = sorted((row["median"], row["time"]) for row in rows)
    errors, times = np.log([row[0] for row in rows]), np.log([row[1] for row in rows])
    if not errors[0] <= np.log(error) <= errors[-1]:
        return None
    return float(np.exp(np.interp(np.log(error), errors, times)))


def tracks(bench):
    """The stock tool and ours: processor time and error, by maxCo and by tolerance."""
    number, followed = min(1000, bench.largest), min(300, bench.largest)
    cells = first_cells(bench.trap("draw", WAYS[2], "1e-3", number, 0.001, 0.005))
    numbers = ("0.3", "0.1") if bench.few else ("0.3", "0.1", "0.03", "0.01", "0.003", "0.001")
    finest = "0.03" if bench.few else "0.0001"
    tolerances = ("1e-4", "1e-5") if bench.few else ("3e-3", "1e-3", "1e-4", "1e-5", "1e-6")

    sets = []
    for co in numbers:
        sets.append({"tool": "stock", "name": "stock", "setting": co, "reference": finest})
    for way in (WAYS[0], WAYS[2]) if bench.few else WAYS:
        for tolerance in tolerances:
            sets.append({"tool": "ours", "name": way[0], "setting": tolerance, "reference": REFERENCE,
                         "way": way, "usual": way[3] == tolerance})

    def made(row, setting, name, listed, bursts, end):
        if row["tool"] == "stock":
            case = StockCase(bench.folder, name, "trap", setting)
        else:
            case = OursCase(bench.folder, name, "trap")
            case.choose(*row["way"][1:3], setting)
            # As the stock tool does, ours takes the flow as it is read
            case.options = ["-frozenFlow"]
        case.inject_listed(listed, bursts)
        case.span(end)
        if end == FLIGHT:
            case.change("system/controlDict", writeFormat="ascii")
        return case

    references = {}
    for row in sets:
        for setting in (row["reference"], row["setting"]):
            key = row["name"], setting
            if key not in references:
                case = made(row, setting, "flight", cells[:followed], 1, FLIGHT)
                case.run()
                references[key] = case.ends(FLIGHT)
        row["median"], row["nine"] = quantiles(
            references[row["name"], row["setting"]], references[row["name"], row["reference"]])
        print(f"  {row['name']} {row['setting']}: {row['median']:.3g} nm", flush=True)

    cases = [made(row, row["setting"], f"whole{i}", cells, 10, 1.2) for i, row in enumerate(sets)]
    for row, time in zip(sets, bench.times(cases)):
        row["time"] = time

    stock = [row for row in sets if row["tool"] == "stock"]
    compared = stock[-1]["time"]
    lines = [
        f"{number} cells in ten bursts over 1 s, tracked up to 1.2 s. Errors are those of {followed} cells, times are "
        f"medians of {bench.repeats}. "
        f"The last column compares with the stock tool at `maxCo {numbers[-1]}`, whose error is "
        f"{stock[-1]['median']:.2g} nm.", "",
        "| | `maxCo` or tolerance | error of x: median [nm] | nine in ten [nm] | time [s] "
        "| relative to the stock tool |",
        "|---|---|---|---|---|---|",
    ]
    for row in sets:
        name = "`icoUncoupledKinematicParcelFoam`" if row["tool"] == "stock" else row["name"]
        mark = "**" if row.get("usual") else ""
        lines.append(f"| {name} | {row['setting']} | {row['median']:.2g} | {row['nine']:.2g} | {row['time']:.2f} | "
                     f"{mark}{row['time'] / compared:.2f}{mark} |")
    lines += equal_errors(sets)
    plot(sets, bench.docs / "gallery" / "sideBySide.png")
    return lines


def equal_errors(sets):
    """Rows of times at equal errors, by the stock tool's."""
    names = list(dict.fromkeys(row["name"] for row in sets))
    lines = ["", "Times [s] at equal median error, interpolated between the rows above; in parentheses relative to the "
             "stock tool.", "",
             "| error [nm] | " + " | ".join(names) + " |", "|---|" + "---|" * len(names)]
    for error in (1000, 100, 10, 1, 0.1):
        times = [at_error([row for row in sets if row["name"] == name], error) for name in names]
        if any(times):
            row = f"| {error:g} "
            for time in times:
                ratio = f" ({time / times[0]:.2f})" if time and times[0] and time is not times[0] else ""
                row += f"| {time:.2f}{ratio} " if time else "| "
            lines.append(row + "|")
    return lines


def plot(sets, file):
    """Processor time against the error."""
    file.parent.mkdir(exist_ok=True)
    figure, axes = plt.subplots(figsize=(7, 4.4), layout="constrained")
    looks = {"stock": ("black", "s"), WAYS[0][0]: ("#D55E00", "o"), WAYS[1][0]: ("#E69F00", "^"),
             WAYS[2][0]: ("#CC79A7", "v")}
    for name, (colour, marker) in looks.items():
        rows = [row for row in sets if row["name"] == name]
        if not rows:
            continue
        label = "stock tool, spheres; maxCo" if name == "stock" else name.replace("`", "")
        axes.loglog([row["median"] for row in rows], [row["time"] for row in rows], color=colour, marker=marker,
                    markersize=5, linewidth=1.3, label=label)
        for row in rows if name == "stock" else ():
            axes.annotate(row["setting"], (row["median"], row["time"]), xytext=(7, -9), textcoords="offset points",
                          fontsize=8)
        used = [row for row in rows if row.get("usual")]
        axes.plot([row["median"] for row in used], [row["time"] for row in used], linestyle="none", marker="o",
                  markersize=11, markerfacecolor="none", markeredgecolor=colour)
    axes.invert_xaxis()
    axes.yaxis.set_major_locator(ticker.LogLocator(subs=(1, 2, 5)))
    axes.yaxis.set_major_formatter(ticker.StrMethodFormatter("{x:g}"))
    axes.yaxis.set_minor_formatter(ticker.NullFormatter())
    axes.set_xlabel(f"median error of the position after {1000 * FLIGHT:g} ms [nm]; circles: tolerance in use")
    axes.set_ylabel("processor time of the whole program [s]")
    axes.grid(which="major", linewidth=0.4, alpha=0.6)
    axes.legend(fontsize=8, frameon=False)
    figure.savefig(file, dpi=140, metadata={})
    plt.close(figure)


def medians(bench, many=True):
    """Of how many runs a table tells, which may have many cells."""
    if bench.repeats == 1:
        return "One run each."
    once = many and bench.largest > 10000
    return f"Medians of {bench.repeats}" + ("; one run of more than 10000 cells." if once else ".")


def growth(sizes, times):
    """Exponent of the time by the size, from one row to the next."""
    powers = [""]
    for i in range(1, len(sizes)):
        powers.append(f"{np.log(times[i] / times[i - 1]) / np.log(sizes[i] / sizes[i - 1]):.2f}")
    return powers


def numbers_of_cells(bench):
    """Processor time by the number of cells."""
    numbers = [10**i for i in range(2, 9) if 10**i <= bench.largest] or [bench.largest]
    lines = [medians(bench), "",
             "| cells | way | tolerance | processor time [s] | after the first cell has entered [s] "
             "| the same per cell [ms] | exponent of growth |", "|---|---|---|---|---|---|---|"]
    for way in bench.growing:
        few = [bench.trap(f"cells{n}", way, way[3], n) for n in numbers if n <= 10000]
        many = [bench.trap(f"cells{n}", way, way[3], n) for n in numbers if n > 10000]
        start = bench.trap("cells0", way, way[3], 1, 0.001, 0.005)
        set_up, *times = bench.times([start, *few])
        times += bench.times(many, 1)
        moving = [time - set_up for time in times]
        for n, time, less, power in zip(numbers, times, moving, growth(numbers, moving)):
            lines.append(f"| {n} | {way[0]} | {way[3]} | {time:.2f} | {less:.2f} | {1000 * less / n:.2f} | {power} |")
    return lines


def ranks(bench):
    """Clock time of the tracking on 1, 2 and 4 ranks, and how much of the ranks' it is that cells move in."""
    number = min(10000, bench.largest)
    lines = [medians(bench), "",
             "| cells | way | ranks | tracking, by the clock [s] | evenness | share of time for moving cells |",
             "|---|---|---|---|---|---|"]
    for way in bench.growing:
        cases = []
        sizes = [(1, number), (2, number), (4, number), (2, bench.largest)]
        for n, count in dict.fromkeys(sizes[:2 if bench.few else 4]):
            case = bench.trap(f"{count}on{n}", way, way[3], count)
            case.ranks, case.count = n, count
            cases.append(case)
        few, many = [[case for case in cases if (case.count > 10000) == is_many] for is_many in (False, True)]
        loads = bench.measure(few, OursCase.load) + bench.measure(many, OursCase.load, 1)
        for case, (clock, even, moving) in zip(few + many, loads):
            shares = f"{even:.1f} % | {moving:.0f} %" if case.ranks > 1 else "| "
            lines.append(f"| {case.count} | {way[0]} | {case.ranks} | {clock:.2f} | {shares} |")
    return lines


def meshes(bench):
    """Processor time by the number of mesh cells before the first cell, and time of tracking."""
    number = min(1000, bench.largest)
    names = sorted((path.name for path in bench.folder.glob("sieve[0-9]*")), key=lambda name: int(name[5:]))
    lines = [medians(bench, many=False), "",
             "| mesh cells | way | before the first cell [s] | in the kernel, in addition [s] | exponent of growth "
             f"| tracking of {number} cells [s] | exponent of growth |",
             "|---|---|---|---|---|---|---|"]
    for way in bench.growing:
        cases = []
        for name in names:
            for count, duration, end in ((1, 0.001, 0.005), (number, 0.2, 0.3)):
                case = OursCase(bench.folder, f"{name}of{count}", name)
                case.choose(*way[1:4])
                case.inject(f"inlet {{ type patch; patch inlet; number {count}; duration {duration}; }}")
                case.span(end)
                case.options = ["-frozenFlow"]
                cases.append(case)
        rows = bench.measure(cases, lambda case: (case.user, case.kernel, case.load()[0]))
        sizes = [case.mesh_cells() for case in cases[::2]]
        users, kernels, _ = zip(*rows[::2])
        clocks = [row[2] for row in rows[1::2]]
        for row in zip(sizes, users, kernels, growth(sizes, users), clocks, growth(sizes, clocks)):
            lines.append("| {} | {} | {:.2f} | {:.2f} | {} | {:.2f} | {} |".format(row[0], way[0], *row[1:]))
    return lines


def write_part(docs, part, lines):
    """The table of a part, between its marks; it is printed, too."""
    print("\n".join(lines), flush=True)
    file = docs / "performance.md"
    text = file.read_text(encoding="utf-8")
    marked = re.compile(rf"(<!-- sideBySide {part}: -->\n).*?(<!-- end of sideBySide {part} -->)", re.S)
    if not marked.search(text):
        sys.exit(f"sideBySide: no marks of {part} in {file}")
    table = "\n".join(lines) + "\n"
    file.write_text(marked.sub(lambda match: match[1] + table + match[2], text), encoding="utf-8")


def main(arguments):
    """All parts asked for."""
    if len(arguments) < 5:
        sys.exit(__doc__.strip())
    bench = Bench(Path(arguments[0]), Path(arguments[1]), int(arguments[2]), int(arguments[3]))
    parts = {"tracks": tracks, "cells": numbers_of_cells, "ranks": ranks, "meshes": meshes}
    for part in arguments[4:]:
        print(f"{part}:", flush=True)
        write_part(bench.docs, part, parts[part](bench))


if __name__ == "__main__":
    main(sys.argv[1:])
