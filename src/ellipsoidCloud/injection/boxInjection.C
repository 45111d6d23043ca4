/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/
#include "boxInjection.H"
#include "addToRunTimeSelectionTable.H"

// * * * * * * * * * * * * * * Static Data Members * * * * * * * * * * * * * //

namespace Foam
{
    defineTypeNameAndDebug(boxInjection, 0);
    addToRunTimeSelectionTable(cellInjection, boxInjection, dictionary);
}


// * * * * * * * * * * * * Protected Member Functions  * * * * * * * * * * * //

bool Foam::boxInjection::position
(
    const label,
    const scalar uniform[3],
    point& x,
    frozenFlow::probe& at
) const
{
    for (direction d = 0; d < 3; ++d)
    {
        x[d] = min_[d] + uniform[d]*(max_[d] - min_[d]);
    }

    return flow_.find(x, at);
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::boxInjection::boxInjection
(
    const dictionary& dict,
    const setting& from,
    const label firstId
)
:
    cellInjection(dict, from, firstId),
    min_(dict.get<point>("min")),
    max_(dict.get<point>("max"))
{
    if (!(cmptMin(max_ - min_) >= 0))
    {
        FatalIOErrorInFunction(dict_)
            << "the box from " << min_ << " to " << max_ << " is inside out"
            << exit(FatalIOError);
    }

    setTimes(readNumber(0));
}


// ************************************************************************* //
