// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "caseProperties.H"
#include "captureCriterion.H"
#include "cellInjection.H"
#include "cellTracks.H"
#include "masterGate.H"
#include "occupancy.H"
#include "polyMesh.H"

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::caseProperties::caseProperties(const polyMesh& mesh)
:
    ellipsoidProperties(mesh)
{
    const masterGate once;
    const polyBoundaryMesh& patches = mesh.boundaryMesh();

    if (found("injection"))
    {
        section("injection");
    }
    const dictionary& injections = subDict("injection");

    for (const entry& e : injections)
    {
        if (!e.isDict() && isVariable(injections, e.keyword()))
        {
            continue;
        }
        if (!e.isDict())
        {
            FatalIOErrorInFunction(injections)
                << e.keyword() << " is not a dictionary of an injection"
                << exit(FatalIOError);
        }

        cellInjection::checkEntries(e.dict());

        if (e.dict().found("patch"))
        {
            cellInjection::checkPatch(e.dict(), patches);
        }
    }

    captureCriterion(section("capture"), patches);
    cellTracks::setting(section("tracks"));
    occupancy::setting(section("occupancy"), patches);
}
