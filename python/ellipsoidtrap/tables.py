# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""The tables that a run leaves in postProcessing/ellipsoidCloud (docs/reference/output.md)."""

import csv
import itertools
import os
import re
from collections import namedtuple

import numpy as np

from . import CaseError
from .pictures.files import number_folders, plain

WORDS = ("event", "fate", "firstSieve", "patch", "sieve")
ROWS = 100_000          # at a time
UNITS = (
    (r"t([A-Z]\w*)?", "s"),
    (r"x[123](End)?(Unfolded)?|deepest(Cell)?|length|width", "m"),
    (r"u[123]", "m/s"),
    (r"omega[123]", "rad/s"),
)

Tables = namedtuple("Tables", "cells events tracks captures")


class Records(np.recarray):
    """A table where pandas is not there; attrs as of its tables."""


def number(text):
    """A number; NaN where a table has none."""
    return float(text or "nan")


def parts(name):
    """The rows of a table as structured arrays, so many at a time; one at least. A row whose end is not
    written yet is left out."""
    with open(name, newline="", encoding="utf-8-sig") as file:
        table = csv.reader(line for line in file if line.endswith("\n"))
        header = next(table, [])
        if not header:
            raise CaseError(f"{name}: no header")
        types = [(c, "U128" if c in WORDS else "i4" if c == "id" else "f8") for c in header]
        empty = {i: number for i, c in enumerate(header) if c in ("imbalance", "tFirstCatch")}
        rows = np.empty(0, types)
        first = True
        while (some := list(itertools.islice(table, ROWS))) or first:
            # A name may have commas in it
            lines = ("\t".join(map(plain, row)) for row in some)
            if some:
                try:
                    rows = np.loadtxt(lines, types, delimiter="\t", converters=empty, ndmin=1, encoding="utf-8",
                                      comments=None)
                except ValueError as error:
                    raise CaseError(f"{name}: {error}") from None
            yield rows
            first = False


def narrow(rows):
    """The same with words as wide as the longest of them."""
    return rows.astype([(c, f"U{max(map(len, rows[c]), default=1)}" if c in WORDS else rows.dtype[c])
                        for c in rows.dtype.names])


def joined(arrays):
    """One array of several, with the columns that all of them have."""
    names = [c for c in arrays[0].dtype.names if all(c in a.dtype.names for a in arrays)]
    whole = np.empty(sum(map(len, arrays)), [(c, np.result_type(*(a.dtype[c] for a in arrays))) for c in names])
    for c in names:
        whole[c] = np.concatenate([a[c] for a in arrays])
    return whole


def of_starts(folders, table, key):
    """A table of all starts; None if it is not there. Of an earlier start counts what it held at the time of
    the next, and of two rows with the same key the later one's."""
    whole = None
    for start, folder in folders:
        name = os.path.join(folder, table + ".csv")
        if not os.path.isfile(name):
            continue
        rows = joined([narrow(part) for part in parts(name)])
        if whole is not None:
            if "t" in key:
                whole = whole[whole["t"] <= start]
            later = set(map(tuple, rows[key].tolist()))
            whole = whole[[row not in later for row in map(tuple, whole[key].tolist())]]
            rows = joined([whole, rows])
        whole = rows
    if whole is None:
        return None
    return whole[np.argsort(whole["id"], kind="stable")] if key == ["id"] else whole


def captures_of(folders):
    """What the sieves hold at the end, by the last start that has ended."""
    for _, folder in reversed(folders):
        name = os.path.join(folder, "captures.csv")
        if os.path.isfile(name):
            with open(name, newline="", encoding="utf-8-sig") as file:
                try:
                    rows = [(plain(sieve), int(cells), np.array(times.split(), float))
                            for sieve, cells, times in itertools.islice(csv.reader(file), 1, None)]
                except ValueError as error:
                    raise CaseError(f"{name}: no rows of sieve, cells and t: {error}") from None
            whole = np.empty(len(rows), [("sieve", "O"), ("cells", "i4"), ("t", "O")])
            for i, row in enumerate(rows):
                whole[i] = row
            return whole
    return None


def with_units(rows):
    """As a table of pandas, or as records."""
    if rows is None:
        return None
    try:
        import pandas
        table = pandas.DataFrame({c: rows[c] for c in rows.dtype.names})
    except ImportError:
        table = rows.view(Records)
        table.attrs = {}
    table.attrs["units"] = {c: unit for c in rows.dtype.names for pattern, unit in UNITS if re.fullmatch(pattern, c)}
    return table


def read(case):
    """cells, events, tracks and captures of a run: tables of pandas, or records of NumPy where pandas is not there.

    attrs["units"] has the unit of each column that has one. A continued run has one set of tables; where a case
    has been started at several times, they are joined. A table that the run has not written yet is None. Numbers
    that a table leaves empty are NaN, t of captures is an array of times."""
    root = os.path.join(case, "postProcessing", "ellipsoidCloud")
    folders = [(start, os.path.join(root, name)) for start, name in number_folders(root)]
    if not folders:
        raise CaseError(f"{root}: no results of ellipsoidTrapFoam")
    return Tables(*map(with_units, (
        of_starts(folders, "cells", ["id"]), of_starts(folders, "events", ["t", "id", "event"]),
        of_starts(folders, "tracks", ["t", "id"]), captures_of(folders))))
