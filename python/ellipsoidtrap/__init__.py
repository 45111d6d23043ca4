# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""Around the runs of ellipsoidTrapFoam: tables, pictures, geometry, sweeps."""


class CaseError(Exception):
    """An input is missing or malformed; the text names the file."""


def read(case):
    """The tables of a run: see ellipsoidtrap.tables.read()."""
    from . import tables  # not for makeGeometry, which needs no NumPy
    return tables.read(case)
