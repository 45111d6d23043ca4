# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam.
#
# ellipsoidTrapFoam is free software: you can redistribute it and/or modify it
# under the terms of the GNU General Public License as published by the Free
# Software Foundation, either version 3 of the License, or (at your option) any
# later version. It comes with ABSOLUTELY NO WARRANTY; see the file COPYING.
"""Check constant/chip and write what the mesh tools need of it:

  constant/triSurface/walls.stl      outline and obstacles, one region each patch
  constant/generated/*               what the dictionaries include

usage: makeGeometry [-resolution NAME]   (run in the case folder)
"""

from .entries import chosen
from .mask import make_mask


def make(words):
    """All of it, in the case folder."""
    print(make_mask(chosen(words, __doc__, ("-resolution",))["-resolution"]))
