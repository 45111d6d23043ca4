/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/
#include "positionsInjection.H"
#include "addToRunTimeSelectionTable.H"

// * * * * * * * * * * * * * * Static Data Members * * * * * * * * * * * * * //

namespace Foam
{
    defineTypeNameAndDebug(positionsInjection, 0);
    addToRunTimeSelectionTable(cellInjection, positionsInjection, dictionary);
}


// * * * * * * * * * * * * Protected Member Functions  * * * * * * * * * * * //

bool Foam::positionsInjection::position
(
    const label i,
    const scalar[3],
    point& x,
    frozenFlow::probe& at
) const
{
    x = positions_[i];

    return flow_.find(x, at);
}


bool Foam::positionsInjection::orientation(const label i, scalar q[4]) const
{
    if (orientations_.empty())
    {
        return false;
    }

    cellOrientation::setQuaternion(dict_, orientations_[i], q);

    return true;
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::positionsInjection::positionsInjection
(
    const dictionary& dict,
    const setting& from,
    const label firstId
)
:
    cellInjection(dict, from, firstId),
    positions_(dict.get<pointField>("positions")),
    orientations_
    (
        dict.getOrDefault<List<FixedList<scalar, 4>>>("orientations", {})
    )
{
    if (orientations_.size() && orientations_.size() != positions_.size())
    {
        FatalIOErrorInFunction(dict_)
            << positions_.size() << " positions but " << orientations_.size()
            << " orientations"
            << exit(FatalIOError);
    }

    setTimes(positions_.size());
}


// ************************************************************************* //
