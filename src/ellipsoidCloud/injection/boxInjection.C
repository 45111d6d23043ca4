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
#include "polyMesh.H"

// * * * * * * * * * * * * * * * * Declarations * * * * * * * * * * * * * * * //

namespace Foam
{

class boxInjection
:
    public cellInjection
{
    // Private Data

        boundBox box_;


    // Private Member Functions

        virtual point position(const label, const vector& uniform) const
        {
            return box_.min() + cmptMultiply(uniform, box_.span());
        }


public:

    //- Runtime type information
    TypeName("box");


    // Constructors

        //- Construct from its dictionary
        explicit boxInjection(const setting& from)
        :
            cellInjection(from),
            box_(from_.dict.get<point>("min"), from_.dict.get<point>("max"))
        {
            if (!(cmptMin(box_.span()) >= 0))
            {
                refuseEntry
                (
                    from_.dict, "max", "max", "min or more along each axis"
                );
            }

            // No draws where no mesh is. With a margin for rounding, by which a
            // box that ends at the mesh stays as it is
            boundBox within(mesh().bounds());
            within.inflate(1e-6);
            within = boundBox
            (
                max(box_.min(), within.min()), min(box_.max(), within.max())
            );
            if (within.valid())
            {
                box_ = within;
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
