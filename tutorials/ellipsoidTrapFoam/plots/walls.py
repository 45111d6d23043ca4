# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""Distance from the walls of a case, by VTK from the surfaces of its patches."""

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkDoubleArray
from vtkmodules.vtkFiltersCore import (
    vtkAppendPolyData, vtkImplicitPolyDataDistance, vtkTriangleFilter,
)

from case import MICRO


def distance(case, names, points, within=np.inf):
    """Distance of points, (n, 3), from the nearest of the patches named; infinite where it
    is more than `within`, which is cheap to find out for most."""
    surface = vtkAppendPolyData()
    for name in names:
        for piece in case.patch_surfaces(name):
            surface.AddInputData(piece)
    triangles = vtkTriangleFilter()
    triangles.SetInputConnection(surface.GetOutputPort())
    triangles.Update()
    surface = triangles.GetOutput()
    bounds = np.reshape(surface.GetBounds(), (3, 2)) * MICRO

    found = np.full(len(points), np.inf)
    near = ((points > bounds[:, 0] - within) & (points < bounds[:, 1] + within)).all(axis=1)
    if near.any():
        implicit = vtkImplicitPolyDataDistance()
        implicit.SetInput(surface)
        values = vtkDoubleArray()
        places = np.ascontiguousarray(points[near] / MICRO)
        implicit.FunctionValue(numpy_to_vtk(places), values)
        found[near] = np.abs(vtk_to_numpy(values)) * MICRO
        found[found > within] = np.inf
    return found
