# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""Write what the mesh tools need of the device of the case in the present folder.

usage: makeGeometry [OPTION VALUE]...
           constant/trapGeometry, a circular trap: -design NAME, -resolution NAME
           constant/chip, a chip given by its plan: -resolution NAME
           system/blockMeshDict that includes generated/blocks, a serpentine of traps:
           -traps N, -leg LENGTH, -throat WIDTH [um]
-quick and -fine are resolutions; -noPictures, -parallel and -flowOnly are for the scripts of cases.
A user's own surface of a name that is written is renamed.
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
    words = [word for word in words if word not in ("-noPictures", "-parallel", "-flowOnly")]
    for name in ("quick", "fine"):
        if "-" + name in words:
            at = words.index("-" + name)
            words[at:at + 1] = ["-resolution", name]
    if "--help" in words:
        sys.exit(__doc__.strip())
    if os.path.exists("constant/trapGeometry"):
        from .circularTrap import make
    elif os.path.exists("constant/chip"):
        from .chip import make
    elif is_serpentine():
        from .serpentine import make
    else:
        sys.exit(f"makeGeometry: {os.getcwd()}: nothing to make: no constant/chip, no constant/trapGeometry, no "
                 "system/blockMeshDict that includes generated/blocks; it runs in the folder of a case (--help)")
    make(words)
