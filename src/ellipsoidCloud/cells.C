// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

/*---------------------------------------------------------------------------*\
Description
    The cells and what is kept of them, and what is read and made before they
    move. Compiled with -O1 (Make/options), which takes half the time.

    One translation unit for all of them: OpenFOAM's templates are instantiated and
    optimised once, which takes a third of the time that a unit for each file takes.

\*---------------------------------------------------------------------------*/
#include "injection/boxInjection.C"
#include "injection/cellInjection.C"
#include "injection/cellOrientation.C"
#include "injection/cellPopulation.C"
#include "injection/patchInflow.C"
#include "injection/patchInjection.C"
#include "injection/positionsInjection.C"

#include "cloud/caseFiles.C"
#include "cloud/caseSummary.C"
#include "cloud/cellParticles.C"
#include "cloud/cellState.C"
#include "cloud/checkedEntries.C"
#include "cloud/ellipsoidCloud.C"
#include "cloud/ellipsoidCloudFiles.C"
#include "cloud/ellipsoidCloudInjections.C"
#include "cloud/ellipsoidCloudRun.C"
#include "cloud/ellipsoidOptions.C"
#include "cloud/ellipsoidProperties.C"

#include "occupancy/occupancy.C"
#include "occupancy/occupancyTrials.C"

#include "results/appendedFile.C"
#include "results/captureCriterion.C"
#include "results/captureStatistics.C"
#include "results/captureTables.C"
#include "results/cellEvent.C"
#include "results/cellPoses.C"
#include "results/cellTracks.C"
#include "results/csvFields.C"
#include "results/vtkPolyData.C"

#include "checkpoint/atomicWrite.C"
#include "checkpoint/checkpoint.C"

#include "functionObject/ellipsoidTracking.C"

#include "flow/electricField.C"
#include "flow/inletFlux.C"
#include "flow/readViscosity.C"

#include "walls/narrowestGaps.C"
#include "walls/wallImages.C"
