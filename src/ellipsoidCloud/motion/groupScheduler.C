// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "groupScheduler.H"
#include "cellDomain.H"
#include "HashSet.H"
#include "groupSharing.H"
#include "overlapGroups.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- How often an interval is halved at most
    static const label maxDepth = 8;

    //- In bead radii: the gap below which cells are one unit; what is not
    //  known of a path between the poses looked at; the travel below which it
    //  does not pay to halve the time
    static const scalar unitGap = 0.5;
    static const scalar unseenGap = 0.1;
    static const scalar shortTravel = 2;

    static inline bool waits(const cellSweep& cell)
    {
        return cell.state.fate == cellState::waiting;
    }

    //- Positions of the cells that wait and find no room
    static labelHashSet blocked
    (
        const UIndirectList<cellSweep>& cells,
        const UList<groupScheduler::nearPair>& pairs
    )
    {
        labelHashSet found;

        // By cells that are there, then by cells that enter and have a lower id
        for (const groupScheduler::nearPair& near : pairs)
        {
            const label a = near.positions.first();
            const label b = near.positions.second();

            if (near.gap < 0 && waits(cells[a]) != waits(cells[b]))
            {
                found.insert(waits(cells[a]) ? a : b);
            }
        }
        for (const groupScheduler::nearPair& near : pairs)
        {
            const label a = near.positions.first();

            if (near.gap < 0 && waits(cells[a]) && !found.found(a))
            {
                found.insert(near.positions.second());
            }
        }

        return found;
    }
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::DynamicList<Foam::groupScheduler::nearPair>
Foam::groupScheduler::nearPairs
(
    const List<cellSweep>& cells,
    const labelUList& indices,
    const labelUList& unitOf,
    const scalar margin
) const
{
    DynamicList<nearPair> found;
    List<boundBox> boxes(interacting_ ? indices.size() : 0);

    forAll(boxes, k)
    {
        const cellSweep& cell = cells[indices[k]];
        const scalar reach = population_.model(cell.state.id).reach;
        boxes[k] = widened(cell.swept, reach + 0.5*margin);
    }

    const List<vector>& periods = groups_.periods();
    for (const auto& met : overlapGroups::overlapping(boxes, periods))
    {
        const cellSweep& a = cells[indices[met.items.first()]];
        const cellSweep& b = cells[indices[met.items.second()]];

        if
        (
            unitOf[met.items.first()] != unitOf[met.items.second()]
         && !(groups_.isFixed(a.state.id) && groups_.isFixed(b.state.id))
        )
        {
            // Each point of a cell stays within its travel of where it began
            const scalar horizon = a.travel + b.travel + margin;
            const scalar gap = ellipsoid_cell_gap
            (
                &population_.model(a.state.id), a.start.x, a.start.q,
                &population_.model(b.state.id),
                (pointOf(b.start.x) + met.moved).v_, b.start.q, horizon
            );

            if (gap < horizon)
            {
                found.append(nearPair{met.items, gap});
            }
        }
    }

    return found;
}


Foam::List<Foam::groupScheduler::unit> Foam::groupScheduler::unitsOf
(
    const List<cellSweep>& cells,
    const labelUList& indices,
    const span& time
) const
{
    // Cells there at the start and those that may enter then; cells that enter
    // later in the span
    DynamicList<label> here;
    DynamicList<label> later;

    for (const label i : indices)
    {
        const scalar t = cells[i].state.time;

        if (waits(cells[i]) ? t == time.start : !cells[i].gone())
        {
            here.append(i);
        }
        else if (waits(cells[i]) && t > time.start && t < time.end)
        {
            later.append(i);
        }
    }

    const DynamicList<nearPair> pairs
    (
        nearPairs(cells, here, identity(here.size()), unitGap*beadRadius_)
    );
    const labelHashSet stay
    (
        blocked(UIndirectList<cellSweep>(cells, here), pairs)
    );

    DynamicList<labelPair> bonds;
    for (const nearPair& near : pairs)
    {
        const labelPair& pair = near.positions;

        if (!stay.found(pair.first()) && !stay.found(pair.second()))
        {
            bonds.append(pair);
        }
    }

    here.append(later);
    const labelList lowest(overlapGroups::connected(here.size(), bonds));
    labelList unitOf(here.size(), -1);
    List<unit> units(here.size());
    label nUnits = 0;

    forAll(here, k)
    {
        if (!stay.found(k))
        {
            label& to = unitOf[lowest[k]];
            to = to < 0 ? nUnits++ : to;
            units[to].cells.append(here[k]);
        }
    }

    units.setSize(nUnits);
    return units;
}


Foam::labelList Foam::groupScheduler::join
(
    const List<cellSweep>& cells,
    List<unit>& units,
    const scalar longTravel
) const
{
    DynamicList<label> indices;
    DynamicList<label> unitOf;

    forAll(units, unitI)
    {
        for (const label i : units[unitI].cells)
        {
            if (!waits(cells[i]))
            {
                indices.append(i);
                unitOf.append(unitI);
            }
        }
    }

    // Of each unit the longest travel of its cells that may have come into
    // contact with another's
    DynamicList<labelPair> bonds;
    scalarList travel(units.size(), scalar(-1));

    for
    (
        const nearPair& near
      : nearPairs(cells, indices, unitOf, unseenGap*beadRadius_)
    )
    {
        const label a = near.positions.first();
        const label b = near.positions.second();
        scalar& longest = travel[unitOf[a]];

        longest = max(longest, cells[indices[a]].travel);
        longest = max(longest, cells[indices[b]].travel);
        bonds.append(labelPair(unitOf[a], unitOf[b]));
    }

    const labelList lowest(overlapGroups::connected(units.size(), bonds));
    DynamicList<label> again;

    // Each goes into the lowest that it hangs together with, and is left empty
    forAll(units, unitI)
    {
        const label first = lowest[unitI];

        if (first != unitI)
        {
            units[first].cells.append(units[unitI].cells);
            units[unitI] = unit();
            travel[first] = max(travel[first], travel[unitI]);
            travel[unitI] = -1;
        }
    }
    forAll(units, unitI)
    {
        if (travel[unitI] >= 0)
        {
            sort(units[unitI].cells);
            units[unitI].inParts = travel[unitI] > longTravel;
            units[unitI].rows.clear();
            again.append(unitI);
        }
    }

    return labelList(std::move(again));
}


void Foam::groupScheduler::advance
(
    List<cellSweep>& cells,
    unit& u,
    const span& time
)
{
    const auto begin =
        [&]()
        {
            for (const label i : u.cells)
            {
                cells[i] = time.before[i];
            }
            u.path.clear();
        };
    begin();

    // A cell of a unit in parts that enters later does so at the end of a part
    scalar middle = time.end;
    for (const label i : u.cells)
    {
        if (waits(cells[i]) && cells[i].state.time > time.start)
        {
            middle = min(middle, cells[i].state.time);
        }
    }
    const bool enters = middle < time.end && u.cells.size() > 1;

    if (!u.inParts && !enters)
    {
        const bool mayFail = time.depth < maxDepth;

        if (groups_.advance(cells, u.cells, time.end, mayFail, u.path))
        {
            return;
        }
        begin();
    }

    label depth = time.depth;
    if (!enters)
    {
        middle = 0.5*(time.start + time.end);
        ++depth;
    }

    const auto advancePart =
        [&](const scalar start, const scalar end)
        {
            const List<unit> parts
            (
                advance(cells, u.cells, span{start, end, depth, false, {}})
            );
            for (const unit& part : parts)
            {
                u.path.append(part.path);
            }
        };

    advancePart(time.start, middle);
    const List<cellSweep> first(UIndirectList<cellSweep>(cells, u.cells));
    advancePart(middle, time.end);

    forAll(first, k)
    {
        cells[u.cells[k]].prepend(first[k]);
    }
}


void Foam::groupScheduler::sample
(
    List<cellSweep>& cells,
    unit& u,
    const span& time
) const
{
    // Until its end the cells have the fate that they had at the start, or
    // that they entered with
    List<cellSweep> after(UIndirectList<cellSweep>(cells, u.cells));
    u.rows.clear();

    forAll(after, k)
    {
        cellState& cell = cells[u.cells[k]].state;
        cell = time.before[u.cells[k]].state;

        if (cell.fate == cellState::waiting && !waits(after[k]))
        {
            cell.fate = cellState::inFlight;
            tracks_->start(cell, u.rows);
        }
    }
    for (const groupAdvance::segment& taken : u.path)
    {
        cellState& cell = cells[taken.cell].state;
        tracks_->add(cell, taken.step, domain_.flow, taken.tet, u.rows);
    }
    forAll(after, k)
    {
        cellState& cell = cells[u.cells[k]].state;
        after[k].state.nextRow = cell.nextRow;
        std::copy_n(cell.lastRow, 8, after[k].state.lastRow);
        cell = after[k].state;

        if (after[k].gone())
        {
            tracks_->finish(cell, u.rows);
        }
    }
    u.path.clear();
}


Foam::List<Foam::groupScheduler::unit> Foam::groupScheduler::advance
(
    List<cellSweep>& cells,
    const labelUList& indices,
    span&& time
)
{
    for (const label i : indices)
    {
        cells[i].begin();
        time.before.insert(i, cells[i]);
    }

    List<unit> units(unitsOf(cells, indices, time));
    labelList todo(identity(units.size()));

    while (todo.size())
    {
        const labelList ranks(groupSharing::distributed(units, todo, time));

        for (const label k : groupSharing::inMeshOrder(cells, units, todo))
        {
            unit& u = units[todo[k]];

            if (!time.shared || ranks[k] == Pstream::myProcNo())
            {
                advance(cells, u, time);
                if (time.shared && tracks_)
                {
                    sample(cells, u, time);
                }
            }
        }

        if (time.shared && Pstream::parRun())
        {
            groupSharing::exchange(cells, units, todo, ranks);
        }

        todo = join
        (
            cells,
            units,
            time.depth < maxDepth ? shortTravel*beadRadius_ : GREAT
        );
    }

    return units;
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::groupScheduler::groupScheduler
(
    const cellPopulation& population,
    const cellDomain& domain,
    trackSampler* tracks,
    const contactObserver* observer,
    const heldCells* held
)
:
    population_(population),
    domain_(domain),
    interacting_(population.properties().pushing()),
    beadRadius_(population.properties().options().bead_radius),
    groups_(population, domain, held, observer),
    tracks_(tracks)
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::List<Foam::cellSweep> Foam::groupScheduler::advanceInterval
(
    List<cellState>& cells,
    const scalar start,
    const scalar end
)
{
    List<cellSweep> moves(cells.size());
    forAll(cells, i)
    {
        // A cell that had no room tries again
        if (cells[i].fate == cellState::waiting)
        {
            cells[i].time = max(cells[i].time, start);
        }
        moves[i] = cellSweep();
        moves[i].state = cells[i];
    }

    for
    (
        const unit& u
      : advance(moves, identity(cells.size()), span{start, end, 0, true, {}})
    )
    {
        if (tracks_)
        {
            tracks_->take(u.rows);
        }
    }

    return moves;
}
