/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/
#include "patchInjection.H"
#include "addToRunTimeSelectionTable.H"
#include "triPointRef.H"

#include <algorithm>

// * * * * * * * * * * * * * * Static Data Members * * * * * * * * * * * * * //

namespace Foam
{
    defineTypeNameAndDebug(patchInjection, 0);
    addToRunTimeSelectionTable(cellInjection, patchInjection, dictionary);
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::patchInjection::triangulate
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


// * * * * * * * * * * * * Protected Member Functions  * * * * * * * * * * * //

bool Foam::patchInjection::position
(
    const label,
    const scalar uniform[3],
    point& x,
    frozenFlow::probe& at
) const
{
    const auto found = std::upper_bound
    (
        inflow_.begin(), inflow_.end(), uniform[0]*inflow_.last()
    );
    const label trii = min
    (
        label(found - inflow_.begin()), inflow_.size() - 1
    );

    const point* corner = &corners_[3*trii];
    const scalar s = sqrt(uniform[1]);

    x =
        (1 - s)*corner[0]
      + s*(1 - uniform[2])*corner[1]
      + s*uniform[2]*corner[2];

    // Just inside, so that the search finds it
    x += 1e-3*(behind_[trii] - x);

    return flow_.find(x, at);
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::patchInjection::patchInjection
(
    const dictionary& dict,
    const setting& from,
    const label firstId
)
:
    cellInjection(dict, from, firstId)
{
    const word patch(dict.get<word>("patch"));

    if (Pstream::master())
    {
        triangulate(from.whole, patch);
    }
    Pstream::scatter(corners_);
    Pstream::scatter(behind_);
    Pstream::scatter(inflow_);

    if (inflow_.empty() || inflow_.last() <= 0)
    {
        FatalIOErrorInFunction(dict_)
            << "nothing flows in through patch " << patch
            << exit(FatalIOError);
    }

    setTimes(readNumber(inflow_.last()));
}


// ************************************************************************* //
