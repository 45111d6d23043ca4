/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

Class
    Foam::positionsInjection

Description
    Cells at given positions and, if given, with given orientations.

Usage
    \verbatim
    listed
    {
        type         positions;
        positions    ((0 0 5e-6) (1e-6 0 5e-6));
        orientations ((0 0 0 1) (0 0 0.6 0.8));     // optional quaternions
    }
    \endverbatim

\*---------------------------------------------------------------------------*/

#include "cellInjection.H"

// * * * * * * * * * * * * * * * * Declarations * * * * * * * * * * * * * * * //

namespace Foam
{

class positionsInjection
:
    public cellInjection
{
    // Private Data

        const pointField positions_;

        //- As many quaternions, or none
        const List<FixedList<scalar, 4>> orientations_;


    // Private Member Functions

        virtual bool isRandom() const
        {
            return false;
        }

        virtual point position(const label i, const vector&) const
        {
            return positions_[i];
        }

        virtual void orientation(const label i, scalar q[4]) const
        {
            if (orientations_.size())
            {
                cellOrientation::setQuaternion(from_.dict, orientations_[i], q);
            }
        }


public:

    //- Runtime type information
    TypeName("positions");


    // Constructors

        //- Construct from its dictionary
        explicit positionsInjection(const setting& from)
        :
            cellInjection(from),
            positions_(from_.dict.get<pointField>("positions")),
            orientations_
            (
                from_.dict.getOrDefault<List<FixedList<scalar, 4>>>
                (
                    "orientations", {}
                )
            )
        {
            const label n = orientations_.size();

            if (n && n != positions_.size())
            {
                FatalIOErrorInFunction(from_.dict)
                    << positions_.size() << " positions but " << n
                    << " orientations" << exit(FatalIOError);
            }

            setTimes(positions_.size());
        }
};


// * * * * * * * * * * * * * * Static Data Members * * * * * * * * * * * * * //

defineTypeNameAndDebug(positionsInjection, 0);

static const cellInjection::addType<positionsInjection> addPositionsInjection
({
    "positions", "orientations"
});

} // End namespace Foam


// ************************************************************************* //
