# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""Write what the mesh tools need of the device of the case in the present folder.

usage: makeGeometry [OPTION VALUE]...
           constant/trapGeometry, a circular trap: -design NAME, -resolution NAME
           constant/chip, a chip given by its plan: -resolution NAME
           system/blockMeshDict that includes generated/blocks, a serpentine of traps:
           -traps N, -leg LENGTH, -throat WIDTH [um]
"""

import os
import sys


def is_serpentine():
    """Does blockMesh read blocks that are made?"""
    try:
        with open("system/blockMeshDict", encoding="latin-1") as file:
            return "generated/blocks" in file.read()
    except OSError:
        return False


def command(words):
    """Of the device that is there."""
    if os.path.exists("constant/trapGeometry"):
        from .circularTrap import make
    elif os.path.exists("constant/chip"):
        from .chip import make
    elif is_serpentine():
        from .serpentine import make
    else:
        sys.exit(__doc__.strip())
    make(words)
