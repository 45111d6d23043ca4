// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "checkCells.H"
#include "masterGate.H"
#include "polyMesh.H"
#include "StringStream.H"

// * * * * * * * * * * * * * * * Global Functions  * * * * * * * * * * * * * //

void Foam::checkCells(const polyMesh& mesh)
{
    const pointField& centres = mesh.cellCentres();
    label first = mesh.nCells();
    forAll(mesh.faces(), facei)
    {
        const label owner = mesh.faceOwner()[facei];
        const vector& S = mesh.faceAreas()[facei];
        const vector d(mesh.faceCentres()[facei] - centres[owner]);
        const vector across
        (
            mesh.isInternalFace(facei)
          ? centres[mesh.faceNeighbour()[facei]] - centres[owner]
          : d
        );

        // OpenFOAM divides by these
        const scalar apart =
            mesh.isInternalFace(facei)
          ? mag(S & d) + mag(S & (across - d))
          : mag(S);
        const bool good = mag(across) > 0 && apart > 0;
        first = good ? first : min(first, owner);
    }
    forAll(centres, celli)
    {
        first = mesh.cellVolumes()[celli] > 0 ? first : min(first, celli);
    }

    OStringStream complaint;
    complaint.precision(6);
    if (first < mesh.nCells())
    {
        complaint
            << "mesh cell " << first << " at " << centres[first] << " m has no"
            << " volume, is inside out, or has a face without area or distance"
            << " from it" << nl << "    checkMesh says more";
    }
    refuseFirst(complaint.str());
}
