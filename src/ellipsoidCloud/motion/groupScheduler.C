// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "groupScheduler.H"
#include "cellDomain.H"
#include "groupSharing.H"
#include "HashSet.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    static labelList indicesOf(const ellipsoid_world* world, const int group)
    {
        List<int> index(ellipsoid_world_group(world, group, nullptr));
        ellipsoid_world_group(world, group, index.data());

        labelList indices(index.size());
        std::copy(index.cbegin(), index.cend(), indices.begin());
        return indices;
    }
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::groupScheduler::look
(
    void* context,
    const void* cell,
    ellipsoid_cell_view* view
)
{
    const groupScheduler& s = *static_cast<const groupScheduler*>(context);
    const cellSweep& c = *static_cast<const cellSweep*>(cell);

    view->model = &s.population_.model(c.state.id);
    view->state = &c.state.body;
    view->phase =
        c.state.waits() ? ELLIPSOID_WAITING
      : c.gone() ? ELLIPSOID_GONE : ELLIPSOID_PRESENT;
    view->time = c.state.time;
    view->fixed = s.groups_.isFixed(c.state.id);
}


int Foam::groupScheduler::advance
(
    void* context,
    int n,
    const int* index,
    double end,
    int mayFail
)
{
    groupScheduler& s = *static_cast<groupScheduler*>(context);
    labelList group(n);
    std::copy_n(index, n, group.begin());

    return s.groups_.advance(s.cells_, group, end, mayFail, *s.path_);
}


void Foam::groupScheduler::putBack
(
    void* context,
    int n,
    const int* index,
    double time
)
{
    groupScheduler& s = *static_cast<groupScheduler*>(context);

    if (s.path_->empty())
    {
        return;
    }

    labelHashSet group(2*n);
    for (int i = 0; i < n; ++i)
    {
        group.insert(index[i]);
    }

    label nKept = 0;
    for (const groupAdvance::segment& taken : *s.path_)
    {
        if (taken.step.start < time || !group.found(taken.cell))
        {
            (*s.path_)[nKept++] = taken;
        }
    }
    s.path_->setSize(nKept);
}


ellipsoid_world_cells Foam::groupScheduler::worldCells()
{
    const List<vector>& periods = groups_.periods();
    ellipsoid_world_cells cells = ellipsoid_world_cells();

    cells.count = cells_.size();
    cells.cell = cells_.data();
    cells.size = sizeof(cellSweep);
    cells.context = this;
    cells.look = &look;
    cells.advance = &advance;
    cells.put_back = &putBack;
    cells.pushing = population_.properties().pushing();
    cells.length = population_.properties().options().bead_radius;
    cells.repeat = reinterpret_cast<const scalar(*)[3]>(periods.cdata());
    cells.repeat_count = periods.size();

    return cells;
}


template<class Act>
void Foam::groupScheduler::withMemory(ellipsoid_world* world, const Act& act)
{
    while (act() == ELLIPSOID_TOO_MANY_CELLS)
    {
        more_ = scalarList(2*max(more_.size(), memory_.size()));
        ellipsoid_world_extend
        (
            world, more_.data(), more_.size()*sizeof(scalar)
        );
    }
}


ellipsoid_world* Foam::groupScheduler::makeWorld
(
    const ellipsoid_world_cells& cells,
    const scalar start,
    const scalar end
)
{
    ellipsoid_world* world = nullptr;
    const std::size_t size =
        ellipsoid_world_size(cells.count, cells.size, cells.repeat_count);
    const label needed = size/sizeof(scalar) + 1;

    if (memory_.size() < needed)
    {
        memory_ = scalarList(needed + needed/2);
    }

    while
    (
        ellipsoid_world_begin
        (
            memory_.data(), memory_.size()*sizeof(scalar), &cells, start, end,
            &world
        )
     == ELLIPSOID_TOO_MANY_CELLS
    )
    {
        memory_ = scalarList(2*memory_.size());
    }

    return world;
}


void Foam::groupScheduler::sample
(
    const UList<cellSweep>& before,
    const labelUList& group,
    groupPath& seen
)
{
    // Until its end the cells have the fate that they had at the start, or
    // that they entered with
    List<cellSweep> after(UIndirectList<cellSweep>(cells_, group));
    seen.rows.clear();

    forAll(after, k)
    {
        cellState& cell = cells_[group[k]].state;
        cell = before[group[k]].state;

        if (cell.waits() && !after[k].state.waits())
        {
            cell.fate = cellState::inFlight;
            tracks_->start(cell, seen.rows);
        }
    }
    for (const groupAdvance::segment& taken : seen.path)
    {
        cellState& cell = cells_[taken.cell].state;
        tracks_->add(cell, taken.step, domain_.flow, taken.tet, seen.rows);
    }
    forAll(after, k)
    {
        cellState& cell = cells_[group[k]].state;
        after[k].state.nextRow = cell.nextRow;
        std::copy_n(cell.lastRow, 8, after[k].state.lastRow);
        cell = after[k].state;

        if (after[k].gone())
        {
            tracks_->finish(cell, seen.rows);
        }
    }
    seen.path.clear();
}


bool Foam::groupScheduler::advanceGroups
(
    ellipsoid_world* world,
    const scalar time,
    List<groupPath>& seen
)
{
    const int* todo;
    List<labelList> members(ellipsoid_world_todo(world, &todo));
    forAll(members, k)
    {
        members[k] = indicesOf(world, todo[k]);
    }

    // The world keeps them as one array
    const UList<cellSweep> before
    (
        static_cast<cellSweep*>
        (
            const_cast<void*>(ellipsoid_world_before(world, 0))
        ),
        cells_.size()
    );
    const labelList ranks(groupSharing::distributed(before, members, time));

    for (const label k : groupSharing::inMeshOrder(cells_, members))
    {
        groupPath& of = seen[todo[k]];

        if (ranks[k] == Pstream::myProcNo())
        {
            path_ = &of.path;
            withMemory
            (
                world,
                [&]() { return ellipsoid_world_advance_group(world, todo[k]); }
            );
            if (tracks_)
            {
                sample(before, members[k], of);
            }
            of.path.clear();
        }
    }

    if (members.size() && Pstream::parRun())
    {
        groupSharing::exchange(cells_, members, ranks);
    }

    return members.size();
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
    cells_.setSize(cells.size());
    forAll(cells, i)
    {
        // A cell that had no room tries again
        if (cells[i].waits())
        {
            cells[i].time = max(cells[i].time, start);
        }
        cells_[i] = cellSweep();
        cells_[i].state = cells[i];
    }

    const ellipsoid_world_cells moved(worldCells());
    ellipsoid_world* world = makeWorld(moved, start, end);
    List<groupPath> seen(ellipsoid_world_group_count(world));

    while (advanceGroups(world, end - start, seen))
    {
        withMemory(world, [&]() { return ellipsoid_world_join(world); });

        // What was seen of groups that are joined does not stand
        const int* todo;
        const int nTodo = ellipsoid_world_todo(world, &todo);
        for (int k = 0; k < nTodo; ++k)
        {
            seen[todo[k]].rows.clear();
        }
        forAll(seen, groupi)
        {
            if (!ellipsoid_world_group(world, groupi, nullptr))
            {
                seen[groupi].rows.clear();
            }
        }
    }

    for (const groupPath& of : seen)
    {
        if (tracks_)
        {
            tracks_->addRows(of.rows);
        }
    }

    return std::move(cells_);
}
