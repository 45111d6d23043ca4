/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

Description
    What the time of solving the coupled equations goes into: matrices, multigrid
    and the iteration. Optimised as OpenFOAM is.

\*---------------------------------------------------------------------------*/
#include "coupled/aggregationMultigrid.C"
#include "coupled/cellHalo.C"
#include "coupled/sparseRows.C"
#include "coupled/stokesGMRES.C"
#include "coupled/stokesOperator.C"
#include "coupled/stokesPreconditioner.C"
