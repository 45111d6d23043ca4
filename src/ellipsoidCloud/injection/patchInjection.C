// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

/*---------------------------------------------------------------------------*\
Class
    Foam::patchInjection

Description
    Cells that enter with the flow through a patch: the more flows in through a
    part of it, the more cells start there. In an unsteady flow that is the inflow
    at the end of the time step, and where there is none all parts are alike.

Usage
    \verbatim
    inlet
    {
        type        patch;
        patch       inlet;
        number      1000;
        duration    30;
    }
    \endverbatim

\*---------------------------------------------------------------------------*/

#include "cellInjection.H"
#include "patchInflow.H"

// * * * * * * * * * * * * * * * * Declarations * * * * * * * * * * * * * * * //

namespace Foam
{

class patchInjection
:
    public cellInjection
{
    // Private Data

        patchInflow inflow_;


    // Private Member Functions

        virtual point position(const label, const vector& uniform) const
        {
            const scalarField& upTo = inflow_.upTo;
            const label trii = std::upper_bound
            (
                upTo.begin(), upTo.end() - 1, uniform[0]*upTo.last()
            ) - upTo.begin();

            // The root makes positions uniform in the triangle
            const point* corner = &inflow_.corners[3*trii];
            const scalar s = sqrt(uniform[1]);
            const point x
            (
                (1 - s)*corner[0]
              + s*(1 - uniform[2])*corner[1]
              + s*uniform[2]*corner[2]
            );

            // Just inside, so that the search finds it
            return x + 1e-3*(inflow_.behind[trii] - x);
        }


public:

    //- Runtime type information
    TypeName("patch");


    // Constructors

        //- Construct from its dictionary; collective
        explicit patchInjection(const setting& from)
        :
            cellInjection(from),
            inflow_
            (
                from_.dict,
                from.undecomposed,
                !from.hasFlow || from.domain.flow.unsteady()
            )
        {
            const bool steady = !from.domain.flow.unsteady();

            setTimes(readNumber(steady ? inflow_.upTo.last() : 0));
        }


    // Member Functions

        virtual void renew()
        {
            inflow_ = patchInflow(from_.dict, from_.undecomposed, true);
        }
};


// * * * * * * * * * * * * * * Static Data Members * * * * * * * * * * * * * //

defineTypeNameAndDebug(patchInjection, 0);

static const cellInjection::addType<patchInjection> addPatchInjection
({
    "number", "rate", "concentration", "patch"
});

} // End namespace Foam
