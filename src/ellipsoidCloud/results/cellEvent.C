/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/
#include "cellEvent.H"
#include "DynamicList.H"

#include <sstream>

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- The members of a cell that are numbers of an event, in their order
    template<class State, class Number>
    static DynamicList<Number*> numbersOf(State& cell, const bool sizes)
    {
        DynamicList<Number*> numbers;

        for (int d = 0; d < 3; ++d)
        {
            numbers.append(&cell.body.x[d]);
        }
        for (int d = 0; d < 4; ++d)
        {
            numbers.append(&cell.body.q[d]);
        }
        numbers.append(&cell.deepest);
        numbers.append(&cell.deepestCell);

        if (sizes)
        {
            numbers.append(&cell.length);
            numbers.append(&cell.width);
        }

        return numbers;
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

const char* Foam::cellEvent::patchName(const wordList& patches, const label i)
{
    return i < 0 ? "-" : patches[i].c_str();
}


std::string Foam::cellEvent::header(const bool sizes)
{
    return
        std::string("t,id,event,patch,x1,x2,x3,eps1,eps2,eps3,eta,")
      + "deepest,deepestCell" + (sizes ? ",length,width" : "");
}


void Foam::cellEvent::write
(
    std::ostream& os,
    const wordList& patches,
    const bool sizes
) const
{
    os  << cell.time << ',' << cell.id << ',' << type << ','
        << patchName(patches, cell.patch);

    for
    (
        const scalar* number
      : numbersOf<const cellState, const scalar>(cell, sizes)
    )
    {
        os << ',' << *number;
    }
    os << '\n';
}


bool Foam::cellEvent::read
(
    std::string line,
    const wordList& patches,
    const bool sizes
)
{
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream is(line);
    std::string patch;

    is >> cell.time >> cell.id >> static_cast<std::string&>(type) >> patch;

    for (scalar* number : numbersOf<cellState, scalar>(cell, sizes))
    {
        is >> *number;
    }

    const bool entered = type == "injected" || type == "released";

    cell.fate =
        entered
      ? cellState::inFlight
      : cellState::fateNames.get(type, cellState::nFates);
    cell.patch = patches.find(patch);

    return
        is
     && (is >> std::ws).eof()
     && cell.fate != cellState::nFates
     && (cell.patch >= 0 || patch == "-");
}


// ************************************************************************* //
