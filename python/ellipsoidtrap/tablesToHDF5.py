# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""The tables of a run in one HDF5 file, a dataset a column, which large runs are read from faster.

usage: tablesToHDF5 FOLDER      such as CASE/postProcessing/ellipsoidCloud/0

Writes FOLDER/tables.h5 with the groups tracks, cells and events. Words (fates, patches) are codes, whose names are the
dataset's attribute `names`; a number that a table leaves empty is NaN. Needs NumPy and h5py."""
import os
import sys

import h5py
import numpy as np

from . import CaseError
from .tables import WORDS, parts

TABLES = ("tracks", "cells", "events")
CHUNK = 10_000          # of a dataset


def convert(name, group):
    """Copy a table into a group."""
    names = {}
    for rows in parts(name):
        for c in rows.dtype.names:
            values = rows[c]
            if c not in group:
                kind = "i4" if c in WORDS else values.dtype
                group.create_dataset(c, (0,), kind, maxshape=(None,), chunks=(CHUNK,))
            if c in WORDS:
                words = names.setdefault(c, [])
                found, values = np.unique(values, return_inverse=True)
                words += [word for word in found if word not in words]
                values = np.array([words.index(word) for word in found], int)[values]
            group[c].resize(len(group[c]) + len(rows), 0)
            group[c][len(group[c]) - len(rows):] = values
    for c, words in names.items():
        group[c].attrs["names"] = [str(word) for word in words]


def main(folder):
    """All tables of a folder."""
    for table in TABLES:
        if not os.path.isfile(os.path.join(folder, table + ".csv")):
            raise CaseError(f"{folder} has no {table}.csv: FOLDER is one such as CASE/postProcessing/ellipsoidCloud/0")
    result = os.path.join(folder, "tables.h5")
    if os.path.exists(result):
        raise CaseError(f"{result} is there already")
    unfinished = result + ".unfinished"
    with h5py.File(unfinished, "w") as file:
        for table in TABLES:
            convert(os.path.join(folder, table + ".csv"), file.create_group(table))
    os.rename(unfinished, result)


def command(words):
    """The command."""
    if len(words) != 1:
        sys.exit(__doc__)
    main(words[0])
