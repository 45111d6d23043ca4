# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""Where the cells of a run started, for an injection of type positions.

usage: starts CELLS.CSV [COLUMN WITHIN PLACE...]
        prints positions [m] and orientations (quaternions, scalar last) as OpenFOAM lists;
        of the cells alone whose COLUMN is nearer than WITHIN to a PLACE, if that is given
"""

import csv
import sys


def cells_of(path):
    """The rows of cells.csv, by id."""
    with open(path, newline="", encoding="utf-8") as file:
        return sorted(csv.DictReader(file), key=lambda row: int(row["id"]))


def command(arguments):
    """Print the lists."""
    if len(arguments) in (0, 2, 3):
        sys.exit(__doc__)
    rows = cells_of(arguments[0])
    if len(arguments) > 1:
        column, (within, *places) = arguments[1], map(float, arguments[2:])
        rows = [row for row in rows if min(abs(float(row[column]) - x) for x in places) < within]
    for name, keys in (
        ("positions", ("x1", "x2", "x3")),
        ("orientations", ("eps1", "eps2", "eps3", "eta")),
    ):
        print(f"{name}\n(")
        for row in rows:
            print("    (" + " ".join(row[key] for key in keys) + ")")
        print(");")

