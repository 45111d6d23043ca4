// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "occupancy.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- In bead radii: cells farther apart do not meet within a hold time, for
    //  one of them is held and the other in contact with it or slow
    static const scalar nearGap = 0.5;

    //- Wrenches that differ by less than this part are the same
    static const scalar sameWrench = 0.05;

    //- Of the hold time: the first part of a trial; each is twice the one
    //  before, the last what is left
    static const scalar firstPart = 1./64;

    //- A trial is over when the cell, at this times its mean speed in the last
    //  part, would not come as far as a cell that is released
    static const scalar paceFactor = 2;

    //- Distance of a cell from where its sweep began [m]
    static scalar distanceMoved(const cellSweep& cell)
    {
        return
            mag(cell.state.centre() + pointOf(cell.sweep.passed)
              - pointOf(cell.sweep.start.x));
    }
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

bool Foam::occupancy::isNear(const cellState& a, const cellState& b) const
{
    const scalar horizon =
        nearGap*set_.population.properties().options().bead_radius;

    return
        set_.population.properties().pushing()
     && !b.waits()
     && ellipsoid_cell_gap
        (
            &set_.population.model(a.id), a.body.x, a.body.q,
            &set_.population.model(b.id), b.body.x, b.body.q,
            horizon
        ) < horizon;
}


bool Foam::occupancy::pushed
(
    const cellState& cell,
    const UList<cellState>& cells
) const
{
    for (const cellState& other : cells)
    {
        if (!held_.found(other.id) && isNear(cell, other))
        {
            return true;
        }
    }

    return false;
}


bool Foam::occupancy::moves
(
    const cellState& cell,
    const UList<cellState>& cells,
    const heldWrench* pull
)
{
    DynamicList<cellSweep> group;
    label own = 0;

    for (const cellState& other : cells)
    {
        if (other.id == cell.id || isNear(cell, other))
        {
            own = other.id == cell.id ? group.size() : own;
            group.append(cellSweep());
            group.last().state = other;
        }
    }

    const groupAdvance::trial tried{cell.id, pull, reach()};
    scalar part = firstPart;
    for (scalar left = 1; left > 0; part *= 2)
    {
        part = min(part, left);
        left -= part;

        DynamicList<label> present;
        DynamicList<groupAdvance::segment> path;
        forAll(group, i)
        {
            if (!group[i].gone())
            {
                ellipsoid_sweep_begin(&group[i].sweep, &group[i].state.body);
                present.append(i);
            }
        }
        trials_->advance
        (
            group, present, cell.time + (1 - left)*criterion_.holdTime(),
            false, path, &tried
        );

        const scalar moved = mag(group[own].state.centre() - cell.centre());
        if (group[own].gone() || moved >= reach())
        {
            return true;
        }

        scalar farthest = moved + paceFactor*distanceMoved(group[own])*left/part;
        for (const cellSweep& other : group)
        {
            if (!other.gone())
            {
                farthest = max(farthest, paceFactor*distanceMoved(other)*left/part);
            }
        }
        if (farthest < reach())
        {
            return false;
        }
    }

    return false;
}


bool Foam::occupancy::pulledOff
(
    const cellState& cell,
    const UList<cellState>& cells
)
{
    const heldWrench whole(held_[cell.id]);
    const auto from = released_.cfind(cell.id);

    if (!moves(cell, cells, changesFlow() ? &whole : nullptr))
    {
        return false;
    }
    if (!changesFlow() || !from.found())
    {
        return true;
    }

    const heldWrench& withstood = (*from).pull;
    const heldWrench excess
    {
        whole.force - withstood.force, whole.torque - withstood.torque
    };

    return moves(cell, cells, &excess);
}


bool Foam::occupancy::isUnchanged(const cellState& cell) const
{
    const auto before = stayedUnder_.cfind(cell.id);
    if (!before.found())
    {
        return false;
    }

    const scalar arm = longestSemiAxis(set_.population.model(cell.id).options);
    const heldWrench& now = held_[cell.id];
    const heldWrench& then = *before;

    return
        arm*mag(now.force - then.force) + mag(now.torque - then.torque)
     <= sameWrench*(arm*mag(then.force) + mag(then.torque));
}


bool Foam::occupancy::stays
(
    const cellState& cell,
    const UList<cellState>& cells,
    const bool afterSolution
)
{
    const bool isPushed = pushed(cell, cells);
    const bool asked =
        isPushed
      ? afterSolution || criterion_.isDue(cell)
      : afterSolution && !isUnchanged(cell);

    if (!asked)
    {
        return true;
    }
    if (pulledOff(cell, cells))
    {
        return false;
    }
    if (!isPushed)
    {
        stayedUnder_.set(cell.id, held_[cell.id]);
    }

    return true;
}
