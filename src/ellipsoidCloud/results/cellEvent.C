/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/
#include "cellEvent.H"
#include "appendedFile.H"
#include "DynamicList.H"

#include <sstream>

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- The members of a cell that are numbers of an event, in their order
    static DynamicList<scalar*> numbersOf(cellState& cell, const bool sizes)
    {
        DynamicList<scalar*> numbers;

        for (scalar& x : cell.body.x)
        {
            numbers.append(&x);
        }
        for (scalar& q : cell.body.q)
        {
            numbers.append(&q);
        }
        numbers.append(&cell.deepest);
        numbers.append(&cell.deepestCell);

        if (sizes)
        {
            numbers.append(&cell.size.length);
            numbers.append(&cell.size.width);
        }

        return numbers;
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

std::string Foam::cellEvent::header(const tableSet& set)
{
    return
        std::string("t,id,event,patch,x1,x2,x3,eps1,eps2,eps3,eta,")
      + "deepest,deepestCell"
      + (set.population.varies() ? ",length,width" : "")
      + (set.unfolds ? ",x1Unfolded,x2Unfolded,x3Unfolded" : "");
}


void Foam::cellEvent::write(std::ostream& os, const tableSet& set) const
{
    cellState now(cell);

    os  << now.time << ',' << now.id << ',' << type << ','
        << set.patchName(now.patch);

    for (const scalar* number : numbersOf(now, set.population.varies()))
    {
        os << ',' << *number;
    }
    if (set.unfolds)
    {
        os << commas{now.unfolded().v_, 3};
    }
    os << '\n';
}


bool Foam::cellEvent::read(std::string line, const tableSet& set)
{
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream is(line);
    std::string patch;

    is >> cell.time >> cell.id >> static_cast<std::string&>(type) >> patch;

    for (scalar* number : numbersOf(cell, set.population.varies()))
    {
        is >> *number;
    }
    if (set.unfolds)
    {
        point unfolded(Zero);
        for (scalar& x : unfolded.v_)
        {
            is >> x;
        }
        // Cells in the device have more than this, from elsewhere
        cell.unfold = isometry::translation(unfolded - cell.centre());
    }

    const bool entered = type == "injected" || type == "released";

    cell.fate =
        entered
      ? cellState::inFlight
      : cellState::fateNames.found(type)
      ? cellState::fateNames[type]
      : cellState::nFates;
    cell.patch = set.patchNames.find(patch);

    return
        is
     && (is >> std::ws).eof()
     && cell.fate != cellState::nFates
     && (cell.patch >= 0 || patch == "-");
}


// ************************************************************************* //
