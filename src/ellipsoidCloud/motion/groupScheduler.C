/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/
#include "groupScheduler.H"
#include "overlapGroups.H"
#include "HashSet.H"
#include "plainLists.H"

#include <algorithm>
#include <numeric>

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

    //- Steps to be expected of a cell that has taken none
    static const scalar newSteps = 100;

    static inline bool waits(const cellSweep& cell)
    {
        return cell.state.fate == cellState::waiting;
    }
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::scalar Foam::groupScheduler::gap
(
    const cellSweep& a,
    const cellSweep& b,
    const scalar horizon
) const
{
    return ellipsoid_cell_gap
    (
        &population_.model(a.state.id), a.x, a.q,
        &population_.model(b.state.id), b.x, b.q,
        horizon
    );
}


Foam::List<Foam::groupScheduler::unit> Foam::groupScheduler::unitsOf
(
    const List<cellSweep>& cells,
    const labelUList& who,
    const span& time
) const
{
    // Those there at the start, those that may enter then, those that enter
    // later in the span
    DynamicList<label> here;
    DynamicList<label> later;

    for (const label i : who)
    {
        const cellSweep& cell = cells[i];

        if (waits(cell))
        {
            if (cell.state.time == time.start)
            {
                here.append(i);
            }
            else if (cell.state.time > time.start && cell.state.time < time.end)
            {
                later.append(i);
            }
        }
        else if (!cell.gone())
        {
            here.append(i);
        }
    }

    labelHashSet stay;
    DynamicList<labelPair> close;

    if (pushing_)
    {
        List<boundBox> boxes(here.size());
        forAll(here, k)
        {
            const cellSweep& cell = cells[here[k]];
            boxes[k] = cell.box(reach(cell) + 0.5*margin_);
        }

        // By the lower of a pair and then the other, so that who comes first
        // by id enters first
        DynamicList<labelPair> overlapping;
        for (const labelPair& pair : overlapGroups::overlapping(boxes))
        {
            const cellSweep& a = cells[here[pair.first()]];
            const cellSweep& b = cells[here[pair.second()]];
            const scalar apart = gap(a, b, margin_);

            if (apart < margin_)
            {
                close.append(pair);
            }
            if (apart < 0 && (waits(a) || waits(b)))
            {
                overlapping.append(pair);
            }
        }

        // First who is in the way of those there, then of those that enter
        for (const labelPair& pair : overlapping)
        {
            for (const label k : {pair.first(), pair.second()})
            {
                const label other = pair.first() + pair.second() - k;

                if (waits(cells[here[k]]) && !waits(cells[here[other]]))
                {
                    stay.insert(k);
                }
            }
        }
        for (const labelPair& pair : overlapping)
        {
            if (!stay.found(pair.first()) && waits(cells[here[pair.first()]]))
            {
                stay.insert(pair.second());
            }
        }
    }

    DynamicList<labelPair> bonds;
    for (const labelPair& pair : close)
    {
        if (!stay.found(pair.first()) && !stay.found(pair.second()))
        {
            bonds.append(pair);
        }
    }

    const labelList lowest(overlapGroups::connected(here.size(), bonds));
    labelList unitOf(here.size(), -1);
    List<unit> units(here.size() + later.size());
    label nUnits = 0;

    const auto add =
        [&](unit& to, const label i)
        {
            to.cells.append(i);
            to.before.append(cells[i]);
            to.inParts = false;
        };

    forAll(here, k)
    {
        if (!stay.found(k))
        {
            label& to = unitOf[lowest[k]];
            if (to < 0)
            {
                to = nUnits++;
            }
            add(units[to], here[k]);
        }
    }
    for (const label i : later)
    {
        add(units[nUnits++], i);
    }

    units.setSize(nUnits);
    return units;
}


Foam::DynamicList<Foam::groupScheduler::meeting> Foam::groupScheduler::meetings
(
    const List<cellSweep>& cells,
    const List<unit>& units
) const
{
    DynamicList<meeting> found;
    DynamicList<label> who;
    DynamicList<label> unitOf;
    DynamicList<boundBox> boxes;
    const scalar unseen = unseenGap*beadRadius_;

    if (!pushing_)
    {
        return found;
    }

    forAll(units, unitI)
    {
        for (const label i : units[unitI].cells)
        {
            if (!waits(cells[i]))
            {
                who.append(i);
                unitOf.append(unitI);
                boxes.append(cells[i].box(reach(cells[i]) + 0.5*unseen));
            }
        }
    }

    for (const labelPair& pair : overlapGroups::overlapping(boxes))
    {
        const labelPair both(unitOf[pair.first()], unitOf[pair.second()]);

        if (both.first() == both.second())
        {
            continue;
        }

        // Each point of a cell stays within its travel of where it began
        const cellSweep& a = cells[who[pair.first()]];
        const cellSweep& b = cells[who[pair.second()]];
        const scalar near = a.travel + b.travel + unseen;

        if (gap(a, b, near) < near)
        {
            found.append(meeting{both, max(a.travel, b.travel)});
        }
    }

    return found;
}


Foam::List<Foam::groupScheduler::unit> Foam::groupScheduler::joined
(
    List<unit>& units,
    const UList<meeting>& meetings,
    const scalar farTravel,
    labelList& changed
)
{
    List<labelPair> pairs(meetings.size());
    forAll(meetings, i)
    {
        pairs[i] = meetings[i].units;
    }

    const labelList lowest(overlapGroups::connected(units.size(), pairs));

    // Of those that are joined, by the lowest of them
    scalarList travel(units.size(), scalar(-1));
    for (const meeting& m : meetings)
    {
        scalar& longest = travel[lowest[m.units.first()]];
        longest = max(longest, m.travel);
    }

    List<unit> result(units.size());
    labelList place(units.size(), -1);
    DynamicList<label> again;
    label nUnits = 0;

    forAll(units, unitI)
    {
        label& to = place[lowest[unitI]];

        if (to < 0)
        {
            to = nUnits++;
            result[to] = std::move(units[unitI]);

            if (travel[unitI] >= 0)
            {
                result[to].inParts = travel[unitI] > farTravel;
                result[to].rows.clear();
                again.append(to);
            }
        }
        else
        {
            result[to].cells.append(units[unitI].cells);
            result[to].before.append(units[unitI].before);
        }
    }
    result.setSize(nUnits);

    // Within a unit by id
    for (const label to : again)
    {
        unit& mixed = result[to];
        labelList order(mixed.cells.size());
        std::iota(order.begin(), order.end(), 0);
        std::sort
        (
            order.begin(),
            order.end(),
            [&](const label a, const label b)
            {
                return mixed.cells[a] < mixed.cells[b];
            }
        );
        mixed.cells = labelList(UIndirectList<label>(mixed.cells, order));
        mixed.before =
            List<cellSweep>(UIndirectList<cellSweep>(mixed.before, order));
    }

    changed = std::move(again);
    return result;
}


void Foam::groupScheduler::move
(
    List<cellSweep>& cells,
    unit& moved,
    const span& time
)
{
    const auto restore =
        [&]()
        {
            UIndirectList<cellSweep>(cells, moved.cells) = moved.before;
            moved.rows.clear();
        };

    restore();

    // A cell of a unit in parts that enters later does so at the end of a part
    scalar middle = time.end;
    for (const cellSweep& cell : moved.before)
    {
        if (waits(cell) && cell.state.time > time.start)
        {
            middle = min(middle, cell.state.time);
        }
    }
    const bool enters = middle < time.end && moved.cells.size() > 1;

    if (!moved.inParts && !enters)
    {
        const bool mayFail = time.depth < maxDepth;

        if (mover_.move(cells, moved.cells, time.end, mayFail, moved.rows))
        {
            return;
        }
        restore();
    }

    label depth = time.depth;
    if (!enters)
    {
        middle = 0.5*(time.start + time.end);
        ++depth;
    }

    advance(cells, moved.cells, {time.start, middle, depth, false}, moved.rows);

    const List<cellSweep> first(UIndirectList<cellSweep>(cells, moved.cells));

    advance(cells, moved.cells, {middle, time.end, depth, false}, moved.rows);

    forAll(moved.cells, k)
    {
        cells[moved.cells[k]].prepend(first[k]);
    }
}


Foam::labelList Foam::groupScheduler::dealt
(
    const List<unit>& units,
    const labelUList& listed,
    const span& time
)
{
    labelList ranks(listed.size(), 0);

    if (!time.shared || !Pstream::parRun())
    {
        return ranks;
    }

    // By the steps to be expected; all of a group go with the shortest
    scalarList work(listed.size());
    forAll(listed, k)
    {
        scalar steps = 1;
        for (const cellSweep& cell : units[listed[k]].before)
        {
            const scalar step = cell.state.controller.step;
            steps = max
            (
                steps, step > 0 ? (time.end - time.start)/step : newSteps
            );
        }
        work[k] = steps*units[listed[k]].cells.size();
    }

    labelList order(identity(listed.size()));
    std::stable_sort
    (
        order.begin(),
        order.end(),
        [&](const label a, const label b) { return work[a] > work[b]; }
    );

    scalarList load(Pstream::nProcs(), Zero);
    for (const label k : order)
    {
        ranks[k] = findMin(load);
        load[ranks[k]] += work[k];
    }

    return ranks;
}


void Foam::groupScheduler::exchange
(
    List<cellSweep>& cells,
    const List<unit>& units,
    const labelUList& listed,
    const labelUList& ranks
)
{
    if (!Pstream::parRun())
    {
        return;
    }

    DynamicList<cellSweep> mine;
    forAll(listed, k)
    {
        if (ranks[k] == Pstream::myProcNo())
        {
            for (const label i : units[listed[k]].cells)
            {
                mine.append(cells[i]);
            }
        }
    }

    const List<List<cellSweep>> all(fromAllRanks(mine));
    labelList next(all.size(), 0);

    forAll(listed, k)
    {
        for (const label i : units[listed[k]].cells)
        {
            cells[i] = all[ranks[k]][next[ranks[k]]++];
        }
    }
}


void Foam::groupScheduler::advance
(
    List<cellSweep>& cells,
    const labelUList& who,
    const span& time,
    DynamicList<cellTracks::row>& rows
)
{
    for (const label i : who)
    {
        cells[i].begin();
    }

    List<unit> units(unitsOf(cells, who, time));
    labelList todo(identity(units.size()));

    while (todo.size())
    {
        const labelList ranks(dealt(units, todo, time));

        forAll(todo, k)
        {
            if (!time.shared || ranks[k] == Pstream::myProcNo())
            {
                move(cells, units[todo[k]], time);
            }
        }

        if (time.shared)
        {
            exchange(cells, units, todo, ranks);
        }

        units = joined
        (
            units,
            meetings(cells, units),
            time.depth < maxDepth
          ? shortTravel*beadRadius_
          : GREAT,
            todo
        );
    }

    for (const unit& moved : units)
    {
        rows.append(moved.rows);
    }
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::groupScheduler::groupScheduler
(
    const cellPopulation& population,
    const frozenFlow& flow,
    const wallFacets& walls,
    const cellTracks& tracks,
    const ellipsoidProperties& properties
)
:
    population_(population),
    pushing_(properties.pushing()),
    beadRadius_(properties.options().bead_radius),
    margin_(unitGap*beadRadius_),
    mover_(population, flow, walls, tracks, properties.seed(), pushing_)
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::groupScheduler::advance
(
    List<cellSweep>& cells,
    const scalar start,
    const scalar end,
    DynamicList<cellTracks::row>& rows
)
{
    advance(cells, identity(cells.size()), {start, end, 0, true}, rows);

    for (const cellSweep& cell : cells)
    {
        if (cell.gone())
        {
            mover_.forget(cell.state.id);
        }
    }
}


// ************************************************************************* //
