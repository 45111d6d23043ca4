/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

Description
    The files of the capture statistics, and what is said of them on the screen.

\*---------------------------------------------------------------------------*/
#include "captureStatistics.H"
#include "atomicWrite.H"
#include "OFstream.H"
#include "IOmanip.H"

#include <algorithm>
#include <cstdlib>
#include <sstream>

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::captureStatistics::readLog()
{
    std::ifstream log(log_.name());
    std::string line;
    std::getline(log, line);

    // What came after the time to go on from is about to be cut off
    while
    (
        scalar(log.tellg()) < log_.earlier()
     && std::getline(log, line)
    )
    {
        std::istringstream fields(line);
        std::string field;
        packedEvent event;

        const cellSize size(population_.medianSize());
        event[13] = size.length;
        event[14] = size.width;

        for (label i = 0; i < nLogged_; ++i)
        {
            std::getline(fields, field, ',');

            event[i] =
                i == 2 ? scalar(eventNames[word(field)])
              : i == 3 ? scalar(patchNames_.find(field))
              : std::atof(field.c_str());

            if (i == 3 && event[i] < 0 && field != patchName(-1))
            {
                // Of another mesh
                fields.setstate(std::ios::failbit);
            }
        }

        // Or with other columns than ours
        if (!fields || !fields.eof())
        {
            FatalErrorInFunction
                << log_.name() << ": cannot read the line" << nl << line.c_str()
                << exit(FatalError);
        }

        count(event);
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::captureStatistics::writeEvents()
{
    if (pending_.empty())
    {
        return;
    }

    DynamicList<packedEvent> events(std::move(pending_));

    // By time and cell
    std::stable_sort
    (
        events.begin(),
        events.end(),
        [](const packedEvent& a, const packedEvent& b)
        {
            return a[0] < b[0] || (a[0] == b[0] && a[1] < b[1]);
        }
    );

    for (const packedEvent& event : events)
    {
        count(event);

        std::ostream& os = log_.stream();

        os  << event[0] << ',' << label(event[1]) << ','
            << eventNames[eventType(label(event[2]))] << ','
            << patchName(label(event[3]));

        for (label i = 4; i < nLogged_; ++i)
        {
            os << ',' << event[i];
        }
        os << '\n';
    }

    log_.flush();
}


void Foam::captureStatistics::report(Ostream& os) const
{
    os  << "cells: " << cells_.size() - counts_[cellState::waiting]
        << " injected, "
        << counts_[cellState::caught] << " caught, "
        << counts_[cellState::escaped] << " escaped, "
        << counts_[cellState::stalled] << " stalled, "
        << counts_[cellState::inFlight] << " in flight, "
        << counts_[cellState::lost] << " lost";
}


void Foam::captureStatistics::reportContact(Ostream& os) const
{
    scalar wall = 0;
    scalar cell = 0;
    scalar wallPart = 0;
    scalar cellPart = 0;
    scalar delay = 0;
    label nDelayed = 0;
    label nBalanced = 0;
    scalar worst = 0;
    label worstId = -1;

    // In order, since a sum depends on it
    for (const label id : cells_.sortedToc())
    {
        const record& r = cells_[id];
        wall = max(wall, r.deepest);
        cell = max(cell, r.deepestCell);

        const scalar beadRadius = population_.beadRadius(r.last[14]);
        wallPart = max(wallPart, 100*r.deepest/beadRadius);
        cellPart = max(cellPart, 100*r.deepestCell/beadRadius);

        if (r.injection[0] > r.planned)
        {
            delay += r.injection[0] - r.planned;
            ++nDelayed;
        }
        if (fateAfter(r.last) == cellState::caught)
        {
            nBalanced += r.imbalance < 0.01;

            if (r.imbalance > worst)
            {
                worst = r.imbalance;
                worstId = id;
            }
        }
    }

    os  << "deepest overlap of a bead with a wall: " << wall*1e9 << " nm, "
        << wallPart << " % of its radius" << nl
        << "deepest overlap of a bead with another cell's: " << cell*1e9
        << " nm, " << cellPart << " % of its radius" << nl
        << "held: " << nBalanced << " of " << counts_[cellState::caught]
        << " caught cells balanced to 1 %";

    if (worstId >= 0)
    {
        os  << ", worst " << 100*worst << " % (cell " << worstId << ')';
    }
    os  << nl;

    if (nDelayed || counts_[cellState::waiting])
    {
        os  << "waited to enter: " << nDelayed << " cells, " << delay
            << " s in all; " << counts_[cellState::waiting] << " still wait"
            << nl;
    }
}


void Foam::captureStatistics::write(Ostream& os) const
{
    OFstream cells(folder_/"cells.csv");
    cells.precision(12);
    cells
        << "id,tInjected,x1,x2,x3,eps1,eps2,eps3,eta,fate,patch,tFate,"
        << "firstSieve,tFirstCatch,deepest,deepestCell,tPlanned,"
        << "imbalance" << (population_.varies() ? ",length,width" : "") << nl;

    Map<DynamicList<scalar>> held;

    for (const label id : cells_.sortedToc())
    {
        const record& cell = cells_[id];
        const cellState::fateType fate = fateAfter(cell.last);

        if (fate == cellState::waiting)
        {
            continue;
        }

        cells << id << ',' << cell.injection[0];
        for (label i = 4; i < 11; ++i)
        {
            cells << ',' << cell.injection[i];
        }
        cells
            << ',' << cellState::fateNames[fate] << ','
            << patchName
               (
                   fate == cellState::inFlight ? -1 : label(cell.last[3])
               )
            << ',' << cell.last[0] << ',' << patchName(cell.firstSieve) << ',';

        if (cell.firstSieve >= 0)
        {
            cells << cell.firstCatch;
        }
        cells
            << ',' << cell.deepest << ',' << cell.deepestCell
            << ',' << cell.planned << ',';

        if (fate == cellState::caught)
        {
            cells << cell.imbalance;
            held(label(cell.last[3])).append(cell.last[0]);
        }
        if (population_.varies())
        {
            cells << ',' << cell.last[13] << ',' << cell.last[14];
        }
        cells << nl;
    }

    OFstream captures(folder_/"captures.csv");
    captures << "sieve,cells,t" << nl;

    if (sieves_.size())
    {
        os << nl << "sieve   cells   caught at [s]" << nl;
    }

    for (const label patchi : sieves_)
    {
        DynamicList<scalar> times(held.lookup(patchi, DynamicList<scalar>()));
        std::sort(times.begin(), times.end());

        std::ostringstream list;
        // No time lies halfway between two that are printed, as multiples of
        // 5 ms may with fewer digits: the log rounds them to twelve
        list.precision(6);
        for (const scalar t : times)
        {
            list << ' ' << t;
        }

        os  << setw(5) << patchNames_[patchi].c_str()
            << setw(8) << times.size() << "  " << list.str().c_str() << nl;

        captures
            << patchNames_[patchi] << ',' << times.size() << ','
            << list.str().c_str() << nl;
    }

    for (OFstream* table : {&cells, &captures})
    {
        if (!table->stdStream().flush())
        {
            cannotWrite(table->name());
        }
    }

    os << nl;
    report(os);
    os << endl;
}


// ************************************************************************* //
