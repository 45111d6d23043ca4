# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""Readers of the files that a case, its run and its user leave."""

import csv
import gzip
import os
import re
import warnings

import numpy as np

from .. import CaseError
from ..geometry import foamDictionary
from ..geometry.foamDictionary import spelled, without_comments  # noqa: F401  (others take them from here)


def read_text(file):
    """The text of a file, gzipped or not."""
    try:
        with (gzip.open if file.endswith(".gz") else open)(file, "rt", encoding="utf-8-sig", errors="replace") as f:
            return f.read()
    except OSError as error:
        raise CaseError(f"{file}: {error.strerror or error}") from None


def read_dictionary(file):
    """An OpenFOAM dictionary as nested dicts; lists as lists, other values as strings."""
    try:
        return foamDictionary.read(file)
    except ValueError as error:
        raise CaseError(f"{file}: {error}") from None


def number(file, entries, default, *keys):
    """A number of a dictionary, by the keys that lead to it; the default where it is left out."""
    for key in keys:
        entries = entries.get(key) if isinstance(entries, dict) else None
    if entries is None:
        return default
    try:
        return float(entries)
    except (TypeError, ValueError):
        words = "a dictionary" if isinstance(entries, dict) else spelled(entries)
        raise CaseError(f"{file}: {'/'.join(keys)} is no number: {words}") from None


def plain(field):
    """A field of a table without the apostrophe that keeps a name from being a formula."""
    return field[field.startswith("'"):]


def not_formula(value):
    """A value for a table: what a spreadsheet would take for a formula, and is no number, after an apostrophe."""
    if not isinstance(value, str) or value[:1] not in "=+-@" or value in ("", "-"):
        return value
    try:
        float(value)
        return value
    except ValueError:
        return "'" + value


def read_csv(file, types):
    """The named columns of a CSV file with a header, as a structured array."""
    if not os.path.isfile(file):
        raise CaseError(f"{file}: not there")
    with open(file, newline="", encoding="utf-8-sig", errors="replace") as f:
        table = csv.reader(f)
        header = next(table, [])
        missing = [name for name, _ in types if name not in header]
        if missing:
            raise CaseError(f"{file}: no column {missing[0]}")
        used = [header.index(name) for name, _ in types]
        # Names may have commas, but no blanks
        lines = ("\t".join([plain(row[i]) for i in used]) for row in table)
        try:
            with warnings.catch_warnings():
                warnings.filterwarnings("ignore", "loadtxt: input contained no data")
                rows = np.loadtxt(lines, dtype=types, delimiter="\t", ndmin=1, comments=None)
        except (ValueError, IndexError, csv.Error) as error:
            raise CaseError(f"{file}: {error}") from None
    for name, kind in types:
        if kind is float and not np.isfinite(rows[name]).all():
            line = 2 + int(np.argmin(np.isfinite(rows[name])))
            raise CaseError(f"{file}: line {line}: {name} is not a number")
    return rows


def finite(word):
    """A word as a finite number."""
    number = float(word)
    if not np.isfinite(number):
        raise ValueError(word)
    return number


def read_measured(file, names, words=()):
    """A user's CSV file: the named columns it has, to arrays; NaN where there is no number."""
    try:
        with open(file, newline="", encoding="utf-8-sig") as f:
            table = csv.DictReader(f, skipinitialspace=True)
            table.fieldnames = [name.strip() for name in table.fieldnames or ()]
            # Spreadsheets write rows of separators alone
            rows = [(table.line_num, row) for row in table if any(str(word or "").strip() for word in row.values())]
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise CaseError(f"{file}: {getattr(error, 'strerror', None) or error}") from None
    if ";" in (table.fieldnames + [""])[0]:
        raise CaseError(f"{file}: line 1: {table.fieldnames[0]}: allowed: commas between columns, a point in numbers")
    if not rows:
        raise CaseError(f"{file}: no rows below a header")
    for line, row in rows:
        if any(map(str.strip, row.get(None, ()))):
            raise CaseError(f"{file}: line {line}: more fields than the {len(table.fieldnames)} of the header")
    columns = {}
    for name in names:
        if name not in table.fieldnames:
            continue
        if name in words:
            columns[name] = [(row[name] or "").strip() for _, row in rows]
            continue
        columns[name] = np.full(len(rows), np.nan)
        for i, (line, row) in enumerate(rows):
            word = (row[name] or "").strip()
            try:
                if word:
                    columns[name][i] = finite(word)
            except ValueError:
                raise CaseError(f"{file}: line {line}: {name} is no number: {word}") from None
    return columns


def write_csv(file, names, rows):
    """Rows of words and numbers under the names of their columns; empty where there is none."""
    def word_of(value):
        if isinstance(value, float):
            return "" if np.isnan(value) else f"{value:.9g}"
        return not_formula(value)

    with open(file, "w", newline="", encoding="utf-8") as f:
        table = csv.writer(f, lineterminator="\n")
        table.writerow(names)
        table.writerows([word_of(value) for value in row] for row in rows)


def number_folders(root):
    """(value, name) of the folders named by a number, ascending."""
    found = []
    for name in os.listdir(root) if os.path.isdir(root) else []:
        is_number = re.fullmatch(r"-?\d+(\.\d*)?(e[+-]?\d+)?", name)
        if is_number and os.path.isdir(os.path.join(root, name)):
            found.append((float(name), name))
    return sorted(found)
