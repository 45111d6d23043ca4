// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

/*---------------------------------------------------------------------------*\
Description
    The tables of the capture statistics, on the disk and on the screen.

\*---------------------------------------------------------------------------*/
#include "captureStatistics.H"
#include "atomicWrite.H"
#include "IOmanip.H"

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::captureStatistics::writeCells(std::ostream& os) const
{
    const bool sizes = set_.population.varies();
    os.precision(12);
    os  << "id,tInjected,x1,x2,x3,eps1,eps2,eps3,eta,fate,patch,tFate,"
        << "firstSieve,tFirstCatch,deepest,deepestCell,tPlanned,"
        << "imbalance,x1End,x2End,x3End" << (sizes ? ",length,width" : "")
        << (set_.unfolds ? ",x1EndUnfolded,x2EndUnfolded,x3EndUnfolded" : "")
        << '\n';

    for (const auto& of : cells_)
    {
        const record& cell = of.second;
        const cellState::fateType fate = cellState::fateType(cell.fate);

        if (fate == cellState::waiting)
        {
            continue;
        }

        os  << of.first << ',' << set_.timeText(cell.injected, 12)
            << commas{cell.start.v_, 3} << commas{cell.startQ.cdata(), 4}
            << ',' << cellState::fateNames[fate] << ','
            << set_.patchName(cell.patch)
            << ',' << set_.timeText(cell.time, 12) << ','
            << set_.patchName(cell.firstSieve) << ',';
        if (cell.firstSieve >= 0)
        {
            os << set_.timeText(cell.firstCatch, 12);
        }
        os  << ',' << cell.deepest << ',' << cell.deepestCell
            << ',' << set_.timeText(cell.planned, 12) << ',';
        if (fate == cellState::caught)
        {
            os << cell.imbalance;
        }
        os  << commas{cell.centre.v_, 3}
            << commas{&cell.size.length, sizes ? 2 : 0}
            << commas{cell.unfolded.v_, set_.unfolds ? 3 : 0} << '\n';
    }
}


void Foam::captureStatistics::writeCaptures(Ostream& os) const
{
    std::ostringstream table;
    table << "sieve,cells,t\n";

    if (sieves_.size())
    {
        os << nl << "sieve   cells   caught at [s]" << nl;
    }

    for (const label patchi : sieves_)
    {
        DynamicList<scalar> times;
        for (const auto& of : cells_)
        {
            const record& cell = of.second;
            if (cell.fate == cellState::caught && cell.patch == patchi)
            {
                times.append(cell.time);
            }
        }
        Foam::sort(times);

        // No time lies halfway between two that are printed, as multiples of
        // 5 ms may with fewer digits: the log rounds them to twelve
        std::string list;
        for (const scalar t : times)
        {
            list += ' ' + set_.timeText(t, 6, 1);
        }

        os  << setw(5) << set_.patchNames[patchi].c_str()
            << setw(8) << times.size() << "  " << list.c_str() << nl;

        table
            << set_.patchName(patchi) << ',' << times.size() << ','
            << list << '\n';
    }

    atomicWrite(set_.folder/"captures.csv", table.str());
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::captureStatistics::report(Ostream& os) const
{
    os  << "cells: " << label(cells_.size()) - counts_[cellState::waiting]
        << " injected, "
        << counts_[cellState::caught] << " caught, "
        << counts_[cellState::escaped] << " escaped, "
        << counts_[cellState::stalled] << " stalled, "
        << counts_[cellState::inFlight] << " in flight, "
        << counts_[cellState::lost] << " lost";
}


void Foam::captureStatistics::reportContact(Ostream& os) const
{
    const ellipsoid_model& median = set_.population.median();
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
    for (const auto& of : cells_)
    {
        const record& r = of.second;
        wall = max(wall, r.deepest);
        cell = max(cell, r.deepestCell);

        const scalar beadRadius =
            median.options.bead_radius
           *(r.size.width/set_.population.medianSize().width);
        wallPart = max(wallPart, 100*r.deepest/beadRadius);
        cellPart = max(cellPart, 100*r.deepestCell/beadRadius);

        if (r.injected > r.planned)
        {
            delay += r.injected - r.planned;
            ++nDelayed;
        }
        if (r.fate == cellState::caught)
        {
            nBalanced += r.imbalance < 0.01;

            if (r.imbalance > worst)
            {
                worst = r.imbalance;
                worstId = of.first;
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

    if (max(wallPart, cellPart) > 5)
    {
        Warning
            << "Beads overlap by more than 5 % of their radius. Is p in m2/s2,"
            << " Pa by the density? Else raise the modulus of contact" << nl
            << endl;
    }

    if (nDelayed || counts_[cellState::waiting])
    {
        os  << "waited to enter: " << nDelayed << " cells, " << delay
            << " s in all; " << counts_[cellState::waiting] << " still wait"
            << nl;
    }
}


void Foam::captureStatistics::finish(const UList<cellState>& cells, Ostream& os)
{
    for (const cellState& cell : cells)
    {
        if (!cell.waits())
        {
            cells_.at(cell.id).update(cell);
        }
    }

    reportContact(os);
    atomicWrite
    (
        set_.folder/"cells.csv", [&](std::ostream& to) { writeCells(to); }
    );
    writeCaptures(os);
    os << nl;
    report(os);
    os << endl;
}
