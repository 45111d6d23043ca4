// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

/*---------------------------------------------------------------------------*\
Description
    What the time of a run goes into: the walls where the cells are, and moving
    them. Optimised as OpenFOAM is.

    One translation unit for all of them: OpenFOAM's templates are instantiated and
    optimised once, which takes a third of the time that a unit for each file takes.

\*---------------------------------------------------------------------------*/

#include "motion/groupAdvance.C"
#include "motion/groupScheduler.C"
#include "motion/groupSharing.C"

#include "walls/wallFacets.C"
