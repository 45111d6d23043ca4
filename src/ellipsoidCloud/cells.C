// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

/*---------------------------------------------------------------------------*\
Description
    The cells and what is kept of them, and what is read and made before they
    move. Compiled with -O1 (Make/options), which takes half the time.

    One translation unit for all of them: OpenFOAM's templates are instantiated and
    optimised once, which takes a third of the time that a unit for each file takes.

\*---------------------------------------------------------------------------*/

#include "base/atomicWrite.C"
#include "base/checkedEntries.C"
#include "base/csvFields.C"

#include "walls/narrowestGaps.C"

#include "cells/cellPopulation.C"
#include "cells/cellState.C"
#include "cells/electricField.C"
#include "cells/ellipsoidOptions.C"
#include "cells/ellipsoidProperties.C"
#include "cells/externalForce.C"
#include "cells/codedForce.C"
#include "cells/listedCells.C"
#include "cells/readViscosity.C"

#include "injection/boxInjection.C"
#include "injection/cellInjection.C"
#include "injection/cellOrientation.C"
#include "injection/patchInflow.C"
#include "injection/patchInjection.C"
#include "injection/positionsInjection.C"

#include "output/appendedFile.C"
#include "output/cellEvent.C"
#include "output/cellPoses.C"
#include "output/cellTracks.C"
#include "output/vtkPolyData.C"

#include "capture/captureCriterion.C"
#include "capture/captureStatistics.C"
#include "capture/captureTables.C"

#include "occupancy/occupancy.C"
#include "occupancy/occupancyTrials.C"

#include "cloud/caseFiles.C"
#include "cloud/caseProperties.C"
#include "cloud/caseSummary.C"
#include "cloud/checkpoint.C"
#include "cloud/ellipsoidCloud.C"
#include "cloud/ellipsoidCloudFiles.C"
#include "cloud/ellipsoidCloudInjections.C"
#include "cloud/ellipsoidCloudParticles.C"
#include "cloud/flowChecks.C"
#include "cloud/inletFlux.C"

#include "functionObject/ellipsoidTracking.C"
