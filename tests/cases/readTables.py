# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""Checks of ellipsoidtrap.read() for readTables.test, in a case that has run from 0.

usage: readTables.py CHECK
"""

import csv
import shutil
import sys
from pathlib import Path

import numpy as np

import ellipsoidtrap
from ellipsoidtrap.pictures.files import CaseError

ROOT = Path("postProcessing/ellipsoidCloud")
NAMES = ("cells", "events", "tracks")


def rows_of(name, start="0"):
    """The rows of a file, as words."""
    with open(ROOT / start / (name + ".csv"), newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def same(value, word):
    """Is a value that of a file?"""
    if isinstance(value, str):
        return value == word
    return np.isnan(value) if word == "" else value == float(word)


def values():
    """Each of them."""
    tables = ellipsoidtrap.read(".")
    compared = 0
    for name in NAMES:
        table, rows = getattr(tables, name), rows_of(name)
        for column in rows[0]:
            found = list(table[column])
            assert len(found) == len(rows), name
            wrong = [(a, row[column]) for a, row in zip(found, rows) if not same(a, row[column])]
            assert not wrong, (name, column, wrong[0])
            compared += len(found)
    for sieve, cells, times, row in zip(*(tables.captures[c] for c in ("sieve", "cells", "t")), rows_of("captures")):
        assert (sieve, cells) == (row["sieve"], int(row["cells"])) and cells == len(times)
        assert [float(word) for word in row["t"].split()] == list(times)
    print(compared, "values")
    assert compared > 1000


def units():
    """Of all columns that have one."""
    tables = ellipsoidtrap.read(".")
    assert tables.tracks.attrs["units"] == {
        "t": "s", **{f"x{i}": "m" for i in (1, 2, 3)}, **{f"u{i}": "m/s" for i in (1, 2, 3)},
        **{f"omega{i}": "rad/s" for i in (1, 2, 3)}}
    cells = tables.cells.attrs["units"]
    assert cells["tFirstCatch"] == "s" and cells["deepest"] == cells["x2End"] == "m"
    assert not {"id", "fate", "patch", "imbalance", "eta"} & set(cells)
    assert tables.captures.attrs["units"]["t"] == "s"


def pandas():
    """The kind."""
    import pandas as pd
    assert all(isinstance(table, pd.DataFrame) for table in ellipsoidtrap.read("."))


def records():
    """The kind; columns are attributes, too."""
    tables = ellipsoidtrap.read(".")
    assert all(isinstance(table, np.recarray) for table in tables)
    assert (tables.tracks.x1 == tables.tracks["x1"]).all()


def bak():
    """A copy of tables as they were."""
    before = ellipsoidtrap.read(".")
    shutil.copytree(ROOT / "0", ROOT / "0.bak")
    shutil.copytree(ROOT / "0", ROOT / "0" / "5.bak")
    after = ellipsoidtrap.read(".")
    assert len(before.tracks) == len(after.tracks) and len(before.cells) == len(after.cells)


def cut():
    """While the run goes on, or after it was killed."""
    before = ellipsoidtrap.read(".").tracks
    file = ROOT / "0" / "tracks.csv"
    text = file.read_bytes()
    file.write_bytes(text[:-5])
    after = ellipsoidtrap.read(".").tracks
    file.write_bytes(text)
    assert len(after) == len(before) - 1


def starts():
    """Of an earlier start up to the next; at that time a cell has the row of the later one."""
    before = ellipsoidtrap.read(".")
    time = sorted(set(before.tracks["t"]))[len(set(before.tracks["t"])) // 2]
    later = ROOT / f"{time:.6g}"
    time = float(later.name)
    later.mkdir()
    for name in ("tracks", "events"):
        first, *lines = (ROOT / "0" / (name + ".csv")).read_text(encoding="utf-8").splitlines(True)
        kept = [line for line in lines if float(line.split(",")[0]) >= time]
        (later / (name + ".csv")).write_text(first + "".join(kept), encoding="utf-8")
    shutil.copy(ROOT / "0" / "cells.csv", later)
    assert ellipsoidtrap.read(".").captures is not None
    tables = ellipsoidtrap.read(".")
    for name in NAMES:
        a, b = getattr(before, name), getattr(tables, name)
        assert len(a) == len(b), (name, len(a), len(b))
        for column in rows_of(name)[0]:
            x, y = np.asarray(a[column]), np.asarray(b[column])
            assert all(p == q or p != p and q != q for p, q in zip(x, y)), (name, column)
    # Cells of the later start alone, from there on
    file = later / "tracks.csv"
    file.write_text("".join(file.read_text(encoding="utf-8").splitlines(True)[:1]), encoding="utf-8")
    assert max(ellipsoidtrap.read(".").tracks["t"]) <= time
    shutil.rmtree(later)


def refused(case, text):
    """It is, with this text."""
    try:
        ellipsoidtrap.read(case)
    except CaseError as error:
        assert text in str(error), error
    else:
        raise AssertionError("read")


def spreadsheet():
    """Tables that a spreadsheet has saved: with a byte order mark they are read, with semicolons they are named."""
    before = ellipsoidtrap.read(".")
    texts = {name: (ROOT / "0" / f"{name}.csv").read_bytes() for name in ("cells", "captures")}
    for name, text in texts.items():
        (ROOT / "0" / f"{name}.csv").write_bytes(b"\xef\xbb\xbf" + text)
    after = ellipsoidtrap.read(".")
    assert list(after.cells["id"]) == list(before.cells["id"]) and list(after.captures["cells"]) == list(before.captures["cells"])
    (ROOT / "0" / "captures.csv").write_bytes(texts["captures"].replace(b",", b";"))
    refused(".", "captures.csv: no rows of sieve, cells and t")
    for name, text in texts.items():
        (ROOT / "0" / f"{name}.csv").write_bytes(text)


def none():
    """No folder of tables."""
    refused("system", "no results")


globals()[sys.argv[1]]()
