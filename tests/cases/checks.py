# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""What the checks of a case's tables share: read in the case's folder, note what does not hold."""

import csv
import math
import os
import re
import sys

import numpy as np

TABLES = "postProcessing/ellipsoidCloud/0/"
failures = []


def table(name):
    """Rows of a table as dictionaries, numbers as floats."""
    with open(TABLES + name, encoding="ascii") as file:
        rows = list(csv.DictReader(file))
    for row in rows:
        for key, value in row.items():
            if key not in ("event", "fate", "patch", "sieve", "firstSieve", "touched") and " " not in value:
                row[key] = float(value) if value else None
    return rows


def columns(rows, *names):
    """Some columns as an array, one row each."""
    return np.array([[row[name] for name in names] for row in rows])


def vectors(name):
    """Values of a vector field, a mesh cell each."""
    with open(name, encoding="ascii") as file:
        rows = re.search(r"internalField.*?\n\d+\n\((.*?)\n\)", file.read(), re.S).group(1)
    return np.array([line.strip("()").split() for line in rows.split("\n") if line], float)


def expect(holds, what):
    """Note a failure, with what it is about; print what holds too."""
    print(("  " if holds else "WRONG ") + what)
    if not holds:
        failures.append(what)


def row(what, value, reference, bound, disagrees=0):
    """Expect a value within a bound: a row of the validation table (CONTRIBUTING.md, Tests).

    what: group, quantity, conditions, source, kind and why, as tap_row of tap.sh takes them.
    """
    if os.environ.get("ELLIPSOID_TEST_ROWS"):
        often = os.environ.get("tap_often", "everyday")
        with open(os.environ["ELLIPSOID_TEST_ROWS"], "a", encoding="utf-8") as file:
            print(*what, f"{value:.17g}", f"{reference:.17g}", f"{bound:.17g}", often, disagrees, sep="\t", file=file)
    error = abs(value - reference)/bound
    expect(1 < error <= disagrees if disagrees > 1 else error <= 1,
           f"{what[1]}, {what[2]}: {value:.6g}, reference {reference:.6g}, bound {bound:.3g}")


def kolmogorov(sample, cdf):
    """Probability of a sample as far from the distribution, or farther (Kolmogorov's
    limit with Stephens' correction, Numerical Recipes 14.3)."""
    x = np.sort(np.asarray(sample))
    n = len(x)
    f = cdf(x)
    d = max(np.max(np.arange(1, n + 1)/n - f), np.max(f - np.arange(n)/n))
    t = d*(math.sqrt(n) + 0.12 + 0.11/math.sqrt(n))
    return min(1.0, 2*sum((-1)**(k - 1)*math.exp(-2*(k*t)**2) for k in range(1, 101)))


def finish():
    """End, with a status above 0 if one has failed."""
    sys.exit(bool(failures))
