/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/
#include "patchInflow.H"
#include "masterGate.H"
#include "triPointRef.H"

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::patchInflow::triangulate
(
    const undecomposedFlow& whole,
    const word& patch
)
{
    const fvMesh& mesh = whole.mesh();
    const label patchi = mesh.boundaryMesh().findPatchID(patch);
    const polyPatch& pp = mesh.boundaryMesh()[patchi];
    const fvPatchVectorField& U = whole.U().boundaryField()[patchi];

    DynamicList<point> corners;
    DynamicList<point> behind;
    DynamicList<scalar> inflow;
    scalar sum = 0;

    forAll(pp, i)
    {
        const face& f = pp[i];

        for (label trii = 1; trii < f.size() - 1; ++trii)
        {
            const point& a = mesh.points()[f[0]];
            const point& b = mesh.points()[f[trii]];
            const point& c = mesh.points()[f[trii + 1]];

            // Outward normal; what flows out carries no cell in
            sum += max(-(U[i] & triPointRef(a, b, c).areaNormal()), scalar(0));

            corners.append(a);
            corners.append(b);
            corners.append(c);
            behind.append(mesh.cellCentres()[pp.faceCells()[i]]);
            inflow.append(sum);
        }
    }

    corners_.transfer(corners);
    behind_.transfer(behind);
    inflow_.transfer(inflow);
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::patchInflow::patchInflow
(
    const dictionary& dict,
    const undecomposedFlow& whole
)
{
    const word patch(dict.get<word>("patch"));

    if (Pstream::master())
    {
        triangulate(whole, patch);
    }
    Pstream::scatter(corners_);
    Pstream::scatter(behind_);
    Pstream::scatter(inflow_);

    const masterGate once;

    if (inflow_.empty() || inflow_.last() <= 0)
    {
        FatalIOErrorInFunction(dict)
            << "nothing flows in through patch " << patch
            << exit(FatalIOError);
    }
}


// ************************************************************************* //
