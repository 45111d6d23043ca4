// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "checkCells.H"
#include "masterGate.H"
#include "plainLists.H"
#include "polyMesh.H"
#include "Tuple2.H"

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
        const bool good =
            mag(across) > 0
         && (mesh.isInternalFace(facei) ? mag(S & d) + mag(S & (across - d)) : mag(S)) > 0;
        first = good ? first : min(first, owner);
    }
    forAll(centres, celli)
    {
        first = mesh.cellVolumes()[celli] > 0 ? first : min(first, celli);
    }

    // That of the first rank that has one
    const bool found = first < mesh.nCells();
    const List<Tuple2<label, point>> faults
    (
        gathered
        (
            Tuple2<label, point>
            (
                found ? first : -1, found ? centres[first] : point::zero
            )
        )
    );

    const masterGate once;
    forAll(faults, ranki)
    {
        if (Pstream::master() && faults[ranki].first() >= 0)
        {
            FatalErrorInFunction
                << "mesh cell " << faults[ranki].first();
            if (Pstream::parRun())
            {
                FatalError << " of processor " << ranki;
            }
            FatalError
                << " at " << faults[ranki].second() << " m has no volume, is"
                << " inside out, or has a face without area or distance from it" << nl
                << "    checkMesh says more" << exit(FatalError);
        }
    }
}
