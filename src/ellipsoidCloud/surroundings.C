/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

Description
    What the cells move in: flow and walls.

    One translation unit for all of them: OpenFOAM's templates are instantiated and
    optimised once, which takes a third of the time that a unit for each file takes.

\*---------------------------------------------------------------------------*/
#include "flow/baffleSides.C"
#include "flow/domainImages.C"
#include "flow/electricField.C"
#include "flow/frozenFlow.C"
#include "flow/frozenFlowFluxes.C"
#include "flow/frozenFlowTets.C"
#include "flow/frozenFlowWalk.C"
#include "flow/inletFlux.C"
#include "flow/partitionNeighbours.C"
#include "flow/partitionOfUnity.C"
#include "flow/possibleInflow.C"
#include "flow/readViscosity.C"
#include "flow/sharedMemory.C"
#include "flow/undecomposedFlow.C"
#include "flow/undecomposedMesh.C"
#include "flow/vertexFit.C"

#include "walls/flatMerging.C"
#include "walls/narrowestGaps.C"
#include "walls/wallFacets.C"
#include "walls/wallImages.C"
