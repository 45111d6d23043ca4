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


def keep_surfaces():
    """Another name for what we have not written."""
    for name in ("walls", "pockets", "apertures"):
        file = f"constant/triSurface/{name}.stl"
        if os.path.exists(file) and not os.path.exists("constant/generated/chosen"):
            to = file + ".bak"
            n = 1
            while os.path.exists(to):
                n += 1
                to = f"{file}.bak{n}"
            os.rename(file, to)
            print(f"keeping {os.path.abspath(file)} as {os.path.basename(to)}")


def command(words):
    """Of the device that is there."""
    words = [word for word in words if word not in ("-noPictures", "-parallel", "-flowOnly")]
    for name in ("quick", "fine"):
        if "-" + name in words:
            at = words.index("-" + name)
            words[at:at + 1] = ["-resolution", name]
    keep_surfaces()
    if os.path.exists("constant/trapGeometry"):
        from .circularTrap import make
    elif os.path.exists("constant/chip"):
        from .chip import make
    elif is_serpentine():
        from .serpentine import make
    else:
        sys.exit(__doc__.strip())
    make(words)
