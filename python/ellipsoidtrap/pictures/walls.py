# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""Distance from the walls of a case, by VTK from the surfaces of its patches."""

from functools import lru_cache

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkDoubleArray
from vtkmodules.vtkFiltersCore import (
    vtkAppendPolyData, vtkImplicitPolyDataDistance, vtkTriangleFilter,
)

from .case import MICRO


@lru_cache(maxsize=16)
def surface_of(case, *names):
    """The surface of patches, its bounds [um], and VTK's search in it: what takes longest."""
    surface = vtkAppendPolyData()
    for name in names:
        for piece in case.patch_surfaces(name):
            surface.AddInputData(piece)
    triangles = vtkTriangleFilter()
    triangles.SetInputConnection(surface.GetOutputPort())
    triangles.Update()
    implicit = vtkImplicitPolyDataDistance()
    implicit.SetInput(triangles.GetOutput())
    return np.reshape(triangles.GetOutput().GetBounds(), (3, 2)) * MICRO, implicit


def distance(case, names, points, within=np.inf):
    """Distance of points, (n, 3), from the nearest of the patches named; infinite where it
    is more than `within`, which is cheap to find out for most."""
    bounds, implicit = surface_of(case, *names)
    found = np.full(len(points), np.inf)
    near = ((points > bounds[:, 0] - within) & (points < bounds[:, 1] + within)).all(axis=1)
    if near.any():
        values = vtkDoubleArray()
        places = np.ascontiguousarray(points[near] / MICRO)
        implicit.FunctionValue(numpy_to_vtk(places), values)
        found[near] = np.abs(vtk_to_numpy(values)) * MICRO
        found[found > within] = np.inf
    return found
