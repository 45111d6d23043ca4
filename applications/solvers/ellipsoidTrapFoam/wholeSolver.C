// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

/*---------------------------------------------------------------------------*\
Description
    All files of the program. Compiled with -O1 (Make/options), which takes half
    the time.

    One translation unit for all of them: OpenFOAM's templates are instantiated and
    optimised once, which takes a third of the time that a unit for each file takes.

\*---------------------------------------------------------------------------*/
#include "flowFields.C"
#include "flowFieldsFiles.C"
#include "occupiedFlow.C"
#include "solidBodies.C"
#include "steadyFlow.C"
#include "steadyFlowChecks.C"
#include "ellipsoidTrapFoam.C"
