// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

/*---------------------------------------------------------------------------*\
Description
    All files of the program.

    One translation unit for all of them: OpenFOAM's templates are instantiated and
    optimised once, which takes a third of the time that a unit for each file takes.

\*---------------------------------------------------------------------------*/
#include "captureMap.C"
#include "captureMapTables.C"
#include "independentCells.C"
#include "inletPlane.C"
#include "ellipsoidCaptureMap.C"
