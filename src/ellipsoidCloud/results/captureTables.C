/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

Description
    The tables of the capture statistics, on the disk and on the screen.

\*---------------------------------------------------------------------------*/
#include "captureStatistics.H"
#include "atomicWrite.H"
#include "IOmanip.H"

#include <algorithm>
#include <sstream>

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::captureStatistics::writeCells() const
{
    std::ostringstream os;
    os.precision(12);
    os  << "id,tInjected,x1,x2,x3,eps1,eps2,eps3,eta,fate,patch,tFate,"
        << "firstSieve,tFirstCatch,deepest,deepestCell,tPlanned,"
        << "imbalance" << (population_.varies() ? ",length,width" : "") << '\n';

    for (const label id : cells_.sortedToc())
    {
        const record& cell = cells_[id];
        const cellState::fateType fate = cellState::fateType(cell.last.fate);

        if (fate == cellState::waiting)
        {
            continue;
        }

        os  << id << ',' << cell.injection.time;
        for (const scalar x : cell.injection.body.x)
        {
            os << ',' << x;
        }
        for (const scalar q : cell.injection.body.q)
        {
            os << ',' << q;
        }
        os  << ',' << cellState::fateNames[fate] << ','
            << cellEvent::patchName
               (
                   patchNames_,
                   fate == cellState::inFlight ? -1 : cell.last.patch
               )
            << ',' << cell.last.time << ','
            << cellEvent::patchName(patchNames_, cell.firstSieve) << ',';

        if (cell.firstSieve >= 0)
        {
            os << cell.firstCatch;
        }
        os  << ',' << cell.last.deepest << ',' << cell.last.deepestCell
            << ',' << cell.planned << ',';

        if (fate == cellState::caught)
        {
            os << cell.last.imbalance;
        }
        if (population_.varies())
        {
            os << ',' << cell.last.length << ',' << cell.last.width;
        }
        os << '\n';
    }

    atomicWrite(folder_/"cells.csv", os.str());
}


void Foam::captureStatistics::writeCaptures(Ostream& os) const
{
    Map<DynamicList<scalar>> held;

    forAllConstIters(cells_, iter)
    {
        const cellState& last = iter().last;
        if (last.fate == cellState::caught)
        {
            held(last.patch).append(last.time);
        }
    }

    std::ostringstream table;
    table << "sieve,cells,t\n";

    if (sieves_.size())
    {
        os << nl << "sieve   cells   caught at [s]" << nl;
    }

    for (const label patchi : sieves_)
    {
        DynamicList<scalar> times(held.lookup(patchi, DynamicList<scalar>()));
        std::sort(times.begin(), times.end());

        // No time lies halfway between two that are printed, as multiples of
        // 5 ms may with fewer digits: the log rounds them to twelve
        std::ostringstream list;
        list.precision(6);
        for (const scalar t : times)
        {
            list << ' ' << t;
        }

        os  << setw(5) << patchNames_[patchi].c_str()
            << setw(8) << times.size() << "  " << list.str().c_str() << nl;

        table
            << patchNames_[patchi] << ',' << times.size() << ',' << list.str()
            << '\n';
    }

    atomicWrite(folder_/"captures.csv", table.str());
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::captureStatistics::write(Ostream& os) const
{
    writeCells();
    writeCaptures(os);

    os << nl;
    report(os);
    os << endl;
}


// ************************************************************************* //
