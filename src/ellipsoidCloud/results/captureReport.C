/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

Description
    What the capture statistics say on the screen.

\*---------------------------------------------------------------------------*/
#include "captureStatistics.H"

// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

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
        wall = max(wall, r.last.deepest);
        cell = max(cell, r.last.deepestCell);

        const scalar beadRadius = population_.beadRadius(r.last.width);
        wallPart = max(wallPart, 100*r.last.deepest/beadRadius);
        cellPart = max(cellPart, 100*r.last.deepestCell/beadRadius);

        if (r.injection.time > r.planned)
        {
            delay += r.injection.time - r.planned;
            ++nDelayed;
        }
        if (r.last.fate == cellState::caught)
        {
            nBalanced += r.last.imbalance < 0.01;

            if (r.last.imbalance > worst)
            {
                worst = r.last.imbalance;
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


// ************************************************************************* //
