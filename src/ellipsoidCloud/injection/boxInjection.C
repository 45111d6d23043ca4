// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

/*---------------------------------------------------------------------------*\
Class
    Foam::boxInjection

Description
    Cells spread uniformly over a box, or the part of it the mesh fills.

Usage
    \verbatim
    cloudburst
    {
        type    box;
        min     (-10e-6 -60e-6 1e-6);
        max     (10e-6 -55e-6 9e-6);
        number  100;
    }
    \endverbatim

\*---------------------------------------------------------------------------*/

#include "cellInjection.H"

// * * * * * * * * * * * * * * * * Declarations * * * * * * * * * * * * * * * //

namespace Foam
{

class boxInjection
:
    public cellInjection
{
    // Private Data

        const point min_;
        const point max_;


    // Private Member Functions

        virtual point position(const label, const vector& uniform) const
        {
            return min_ + cmptMultiply(uniform, max_ - min_);
        }


public:

    //- Runtime type information
    TypeName("box");


    // Constructors

        //- Construct from its dictionary
        explicit boxInjection(const setting& from)
        :
            cellInjection(from),
            min_(from_.dict.get<point>("min")),
            max_(from_.dict.get<point>("max"))
        {
            if (!(cmptMin(max_ - min_) >= 0))
            {
                refuseEntry
                (
                    from_.dict, "max", "max", "min or more along each axis"
                );
            }

            setTimes(readNumber(0));
        }
};


// * * * * * * * * * * * * * * Static Data Members * * * * * * * * * * * * * //

defineTypeNameAndDebug(boxInjection, 0);

static const cellInjection::addType<boxInjection> addBoxInjection
({
    "number", "rate", "min", "max"
});

} // End namespace Foam
