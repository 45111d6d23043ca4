# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""Table of a mesh refinement: fluxes and fates side by side.

usage: refineTable CASE...      from coarse to fine
"""

import sys
from pathlib import Path

from .case import Case
from .report import logged
from .starts import cells_of

# Sieves whose flux the table shows
SHOWN = ("S2", "S5")


def fate(row):
    """caught by which sieve, or the fate alone."""
    return row["patch"] if row["fate"] == "caught" else row["fate"]


def print_table(cases):
    """One line a case; the last is what the others are compared with."""
    fates = [
        [fate(row) for row in cells_of(Path(case) / "postProcessing/ellipsoidCloud/0/cells.csv")]
        for case in cases
    ]
    sieves = [f"S{i}" for i in range(1, 9)]
    print("| mesh | inlet flux [m³/s] | through " + " | through ".join(SHOWN) + " | "
          + " | ".join(sieves) + " | escaped | other | fates unlike the finest |")
    print("| --- " * (5 + len(SHOWN) + len(sieves)) + "|")
    for case, mine in zip(cases, fates):
        flux = {name: abs(one) for name, one, _ in Case(case).fluxes}
        counts = [mine.count(sieve) for sieve in sieves]
        escaped = mine.count("escaped")
        differ = sum(a != b for a, b in zip(mine, fates[-1]))
        entries = [Path(case).name, f"{float(logged(Case(case), r'flow: inlet: (.*) m3/s in')):.4g}"]
        entries += [f"{flux[sieve]:.4g}" for sieve in SHOWN]
        entries += [str(n) for n in counts]
        entries += [str(escaped), str(len(mine) - sum(counts) - escaped), str(differ)]
        print("| " + " | ".join(entries) + " |")


def command(words):
    """The command."""
    if not words:
        sys.exit(__doc__)
    print_table(words)
