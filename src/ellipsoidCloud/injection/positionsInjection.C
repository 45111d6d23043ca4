// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

/*---------------------------------------------------------------------------*\
Class
    Foam::positionsInjection

Description
    Cells at given positions and, if given, with given orientations, sizes and
    densities; or all of them of a file, see listedCells.

Usage
    \verbatim
    listed
    {
        type         positions;
        positions    ((0 0 5e-6) (1e-6 0 5e-6));
        orientations ((0 0 0 1) (0 0 0.6 0.8));     // optional quaternions
        sizes        ((4e-6 1e-6) (5e-6 1.2e-6));   // optional (length width)
        densities    (1040 1100);                   // optional
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

        //- As many, or none
        const List<cellSize> sizes_;

        //- As many [kg/m3], or none
        const scalarList densities_;


    // Private Member Functions

        virtual bool isRandom() const
        {
            return false;
        }

        virtual point position(const label i, const vector&) const
        {
            return positions_[i];
        }

        virtual cellSize sizeOf(const label i) const
        {
            cellSize own(sizes_.size() ? sizes_[i] : cellInjection::sizeOf(i));

            if (densities_.size())
            {
                own.density = densities_[i];
            }

            return own;
        }

        //- End the run if a list is not as long as that of the positions
        void check(const char* entry, const label n) const
        {
            if (n && n != positions_.size())
            {
                FatalIOErrorInFunction(from_.dict)
                    << positions_.size() << " positions but " << n << ' '
                    << entry << exit(FatalIOError);
            }
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
            ),
            sizes_(from_.population.listedSizes(from_.dict, "sizes")),
            densities_(from_.dict.getOrDefault<scalarList>("densities", {}))
        {
            check("orientations", orientations_.size());
            check("sizes", sizes_.size());
            check("densities", densities_.size());

            if (positions_.empty())
            {
                refuseEntry
                (
                    from_.dict, "positions", "positions", "one or more"
                );
            }
            if (orientations_.size() && from_.dict.found("orientation"))
            {
                FatalIOErrorInFunction(streamOf(from_.dict, "orientation"))
                    << "orientation is not read with orientations"
                    << exit(FatalIOError);
            }

            setTimes(positions_.size());
        }
};


// * * * * * * * * * * * * * * Static Data Members * * * * * * * * * * * * * //

defineTypeNameAndDebug(positionsInjection, 0);

static const cellInjection::addType<positionsInjection> addPositionsInjection
({
    "positions", "orientations", "sizes", "densities", "file"
});

} // End namespace Foam
