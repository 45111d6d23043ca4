// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "cellEvent.H"
#include "appendedFile.H"

#include <sstream>

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
    const point unfolded(cell.unfolded());

    os  << set.timeText(cell.time, 12) << ',' << cell.id << ',' << type << ','
        << set.patchName(cell.patch)
        << commas{cell.body.x, 3} << commas{cell.body.q, 4}
        << ',' << cell.deepest << ',' << cell.deepestCell
        << commas{&cell.size.length, set.population.varies() ? 2 : 0}
        << commas{unfolded.v_, set.unfolds ? 3 : 0} << '\n';
}


bool Foam::cellEvent::read(const std::string& line, const tableSet& set)
{
    const std::vector<std::string> fields(csvFields(line));

    if (fields.size() < 4)
    {
        return false;
    }

    // All but the patch are free of blanks
    const std::string& patch = fields[3];
    std::string others;
    for (const std::string& field : fields)
    {
        others += &field == &patch ? "" : field + ' ';
    }
    std::istringstream is(others);

    is >> cell.time >> cell.id >> static_cast<std::string&>(type);

    for (scalar& x : cell.body.x)
    {
        is >> x;
    }
    for (scalar& q : cell.body.q)
    {
        is >> q;
    }
    is >> cell.deepest >> cell.deepestCell;

    if (set.population.varies())
    {
        is >> cell.size.length >> cell.size.width;
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
