// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "mirrorsAtVertices.H"
#include "domainImages.H"
#include "polyMesh.H"

// * * * * * * * * * * * * * * * Global Functions  * * * * * * * * * * * * * //

Foam::Map<Foam::symmTensor> Foam::freeAtMirrors
(
    const polyMesh& mesh,
    const UList<flowTet>& tets,
    const UList<flowVertex>& vertices
)
{
    Map<symmTensor> free;

    for (const flowTet& tet : tets)
    {
        const label patchi = -1 - tet.neighbours[0];
        if (patchi < 0 || !domainImages::isMirror(mesh.boundaryMesh()[patchi]))
        {
            continue;
        }

        const point& x = vertices[tet.vertices[1]].x;
        const vector S
        (
            (vertices[tet.vertices[2]].x - x)
          ^ (vertices[tet.vertices[3]].x - x)
        );

        for (label i = 1; i < 4; ++i)
        {
            free.insert(tet.vertices[i], symmTensor(symmTensor::I));
            symmTensor& P = free[tet.vertices[i]];

            // Of another plane than those before
            const vector n(P & (S/mag(S)));
            if (mag(n) > 1e-3)
            {
                P -= sqr(n/mag(n));
            }
        }
    }

    return free;
}
