# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""The dynamics of cells, without OpenFOAM: docs/fromPython.md."""

from .ellipsoid import Ellipsoid
from .library import CoreError
from .options import options
from .walls import Walls
from .world import World

__all__ = ["CoreError", "Ellipsoid", "Walls", "World", "options"]
