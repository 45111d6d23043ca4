# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""The commands of the package.

usage: python3 -m ellipsoidtrap COMMAND [ARGUMENT...]
"""

import importlib
import os
import sys

from . import CaseError

MODULES = {
    "makeGeometry": ".geometry.makeGeometry",
    "makePictures": ".pictures.makePictures",
    "refineTable": ".pictures.refineTable",
    "starts": ".pictures.starts",
    "statements": ".pictures.statements",
    "sweepTable": ".pictures.sweepTable",
    "tablesToHDF5": ".tablesToHDF5",
}


def main():
    """Run the command that this was started as, or that is the first argument; its exit status."""
    name, *words = sys.argv
    name = os.path.basename(name)
    if name not in MODULES and words:
        name, *words = words
    if name not in MODULES:
        sys.exit(__doc__.strip() + "\n\nCOMMAND is one of " + " ".join(MODULES))
    try:
        return importlib.import_module(MODULES[name], "ellipsoidtrap").command(words)
    except CaseError as error:
        sys.exit(f"{name}: {error}")
    except OSError as error:
        sys.exit(f"{name}: {error.filename or os.getcwd()}: {error.strerror or error}")
    except ModuleNotFoundError as error:
        sys.exit(f"{name}: {sys.executable} has no module {error.name}; what Python needs is at the end of README.md")


if __name__ == "__main__":
    sys.exit(main())
