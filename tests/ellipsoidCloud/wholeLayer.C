// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

/*---------------------------------------------------------------------------*\
Description
    All checks in one translation unit: OpenFOAM's templates are made once.

\*---------------------------------------------------------------------------*/

#include "layerParts.C"
#include "injectionChecks.C"
#include "captureChecks.C"
#include "heldChecks.C"
#include "occupancyChecks.C"
#include "motionChecks.C"
#include "boundaryChecks.C"
#include "flowChecks.C"
#include "ringChecks.C"
#include "statisticsChecks.C"
#include "tableChecks.C"
#include "forceChecks.C"
