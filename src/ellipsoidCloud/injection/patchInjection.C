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

#include <algorithm>

// * * * * * * * * * * * * * * Static Data Members * * * * * * * * * * * * * //

namespace Foam
{
    defineTypeNameAndDebug(patchInjection, 0);
    addToRunTimeSelectionTable(cellInjection, patchInjection, dictionary);
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
    const scalarList& inflow = inflow_.upTo();
    const auto found = std::upper_bound
    (
        inflow.begin(), inflow.end(), uniform[0]*inflow.last()
    );
    const label trii = min
    (
        label(found - inflow.begin()), inflow.size() - 1
    );

    const point* corner = &inflow_.corners()[3*trii];
    const scalar s = sqrt(uniform[1]);

    x =
        (1 - s)*corner[0]
      + s*(1 - uniform[2])*corner[1]
      + s*uniform[2]*corner[2];

    // Just inside, so that the search finds it
    x += 1e-3*(inflow_.behind()[trii] - x);

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
    cellInjection(dict, from, firstId),
    inflow_(dict, from.whole)
{
    setTimes(readNumber(inflow_.upTo().last()));
}


// ************************************************************************* //
