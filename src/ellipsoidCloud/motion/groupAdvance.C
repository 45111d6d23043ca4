/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/
#include "groupAdvance.H"
#include "cellSurroundings.H"
#include "clockTime.H"
#include "PtrList.H"

#include <cfenv>

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- So many cells go together at most: what a group needs grows with their
    //  square, and is 1.3 GB then
    static const label largestGroup = 2000;
}


// * * * * * * * * * * * * * * * Private Classes * * * * * * * * * * * * * * //

struct Foam::groupAdvance::member
{
    const label index;
    cellSweep& cell;
    const ellipsoid_model& model;
    const bool sweeping;
    DynamicList<segment>& path;
    cellSurroundings here;
    frozenFlow::locationType location;
    ellipsoid_step last;
    ellipsoid_surroundings around;
};


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

ellipsoid_facet_cache& Foam::groupAdvance::cache(const label id)
{
    if (!caches_.found(id))
    {
        caches_.set(id, new ellipsoid_facet_cache);
        ellipsoid_facet_cache_clear(caches_[id]);
    }

    return *caches_[id];
}


int Foam::groupAdvance::observe(void* context, const ellipsoid_step* step)
{
    member& m = *static_cast<member*>(context);
    cellState& state = m.cell.state;

    m.last = *step;
    m.location = m.here.settle(pointOf(step->after.x));
    state.deepest = max(state.deepest, step->contact.deepest);
    state.deepestCell = max(state.deepestCell, step->contact.cell_deepest);

    // A path bends between the ends of a long step
    const label nParts = m.sweeping ? 4 : 0;
    for (label i = 1; i <= nParts; ++i)
    {
        ellipsoid_state body(step->after);
        if (i < nParts)
        {
            const scalar t = step->start + i*(step->end - step->start)/nParts;
            ellipsoid_step_state(step, t, &body);
        }
        m.cell.sweep(body, m.model);
    }

    if (m.location != frozenFlow::pInside)
    {
        return 1;
    }

    m.path.append(segment{m.index, *step});
    return 0;
}


bool Foam::groupAdvance::fits
(
    const List<cellSweep>& cells,
    const labelUList& group,
    const bool mayFail
)
{
    if (group.size() > largestGroup && !mayFail)
    {
        FatalErrorInFunction
            << group.size() << " cells near one another, cell "
            << cells[group[0]].state.id << " among them, are one group; at most"
            << ' ' << largestGroup << " can be moved together" << nl
            << "    let fewer enter, or set contact/cells off"
            << exit(FatalError);
    }

    return group.size() <= largestGroup;
}


bool Foam::groupAdvance::integrate
(
    List<ellipsoid_member>& members,
    scalar t,
    const scalar end,
    const bool mayFail
)
{
    while (members.size())
    {
        int which = -1;
        const ellipsoid_status status = ellipsoid_advance_group
        (
            members.size(),
            members.cdata(),
            &t,
            end,
            observe,
            memory_.data(),
            &which
        );
        const bool failed =
            status != ELLIPSOID_OK && status != ELLIPSOID_STOPPED;

        if (failed && mayFail && members.size() > 1)
        {
            return false;
        }

        // The last is taken out where the core blames none
        if (failed && which < 0)
        {
            which = members.size() - 1;
        }

        label nLeft = 0;
        forAll(members, i)
        {
            member& m = *static_cast<member*>(members[i].observer_context);

            m.cell.state.time = t;
            m.cell.state.tet = m.here.home().tet;

            if (failed ? i == which : m.location != frozenFlow::pInside)
            {
                remove(m, status);
            }
            else if (status == ELLIPSOID_OK)
            {
                settle(m);
            }
            else
            {
                members[nLeft++] = members[i];
            }
        }
        members.setSize(nLeft);
    }

    return true;
}


void Foam::groupAdvance::settle(member& m) const
{
    cellSweep& cell = m.cell;
    const ellipsoid_contact& contact = m.last.contact;

    cell.nWalls = contact.touched_count;
    std::copy_n(contact.touched, cell.nWalls, cell.walls);
    cell.nCells = contact.touched_cell_count;
    std::copy_n(contact.touched_cell, cell.nCells, cell.cells);

    // Only of a cell that has been slow, or is in contact and may be slow from
    // now on
    if
    (
        cell.state.fate != cellState::caught
     && (cell.state.slowTime > 0 || cell.nWalls || cell.nCells)
    )
    {
        cell.state.imbalance = max(cell.state.imbalance, imbalance(m));
    }
}


Foam::scalar Foam::groupAdvance::imbalance(const member& m) const
{
    const ellipsoid_state& body = m.cell.state.body;
    const ellipsoid_contact& contact = m.last.contact;

    frozenFlow::probe at(m.here.home());
    ellipsoid_flow_sample flow;
    if (flow_.sample(body.x, at, false, flow))
    {
        return 1;
    }

    vector drag;
    ellipsoid_drag_at_rest(&m.model, body.q, flow.velocity, drag.v_);

    const vector sum
    (
        drag + (pointOf(contact.force) + pointOf(contact.cell_force))
    );

    return mag(sum)/max(mag(drag), VSMALL);
}


void Foam::groupAdvance::remove
(
    member& m,
    const ellipsoid_status status
) const
{
    if (m.location == frozenFlow::pBeyondOpen)
    {
        stopAtPatch(m);
        m.cell.state.fate = cellState::escaped;
    }
    else
    {
        m.cell.state.patch = -1;
        m.cell.state.fate = cellState::lost;
        m.cell.status = status;
        m.cell.refused = m.here.refused();
    }
}


void Foam::groupAdvance::stopAtPatch(member& m) const
{
    // Bisection: inside at the start of the step, beyond at its end
    scalar inside = m.last.start;
    scalar beyond = m.last.end;
    frozenFlow::probe at(m.here.home());
    cellState& cell = m.cell.state;
    cell.patch = -1;

    for (label i = 0; i < 40; ++i)
    {
        const scalar middle = 0.5*(inside + beyond);
        ellipsoid_step_state(&m.last, middle, &cell.body);

        if (flow_.locate(pointOf(cell.body.x), at) == frozenFlow::pInside)
        {
            inside = middle;
        }
        else
        {
            beyond = middle;
            cell.patch = at.patch;
        }
    }

    ellipsoid_step_state(&m.last, inside, &cell.body);
    cell.time = inside;
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::groupAdvance::groupAdvance
(
    const cellPopulation& population,
    const frozenFlow& flow,
    const wallFacets& walls,
    const label seed,
    const bool sweeping
)
:
    population_(population),
    flow_(flow),
    walls_(walls),
    seed_(seed),
    sweeping_(sweeping),
    caches_(),
    memory_(),
    done_()
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

bool Foam::groupAdvance::advance
(
    List<cellSweep>& cells,
    const labelUList& group,
    const scalar end,
    const bool mayFail,
    DynamicList<segment>& path
)
{
    if (!fits(cells, group, mayFail))
    {
        return false;
    }

    const clockTime timer;
    const label n = group.size();
    const label size = ellipsoid_group_size(n)/sizeof(scalar) + 1;
    memory_.setSize(max(memory_.size(), size));

    PtrList<member> own(n);
    List<ellipsoid_member> members(n);

    forAll(group, i)
    {
        cellSweep& cell = cells[group[i]];
        const label id = cell.state.id;

        if (cell.state.fate == cellState::waiting)
        {
            cell.state.fate = cellState::inFlight;
        }

        own.set
        (
            i,
            new member
            {
                group[i], cell, population_.model(id), sweeping_, path,
                {flow_, walls_, frozenFlow::probe{cell.state.tet, -1}},
                frozenFlow::pInside, ellipsoid_step(), ellipsoid_surroundings()
            }
        );
        own[i].around = own[i].here.core();
        own[i].around.seed = seed_;
        own[i].around.id = id;

        members[i].model = &own[i].model;
        members[i].surroundings = &own[i].around;
        members[i].state = &cell.state.body;
        members[i].controller = &cell.state.controller;
        members[i].cache = &cache(id);
        members[i].observer_context = &own[i];
        members[i].statistics = &done_.steps;
    }

    // The core answers what is not finite by a shorter step; OpenFOAM's traps
    // would end the run
    std::fenv_t traps;
    std::feholdexcept(&traps);
    const scalar start = cells[group[0]].state.time;
    const bool done = integrate(members, start, end, mayFail);
    std::fesetenv(&traps);

    const scalar spent = timer.elapsedTime();
    done_.time += spent;
    if (n > 1)
    {
        ++done_.nGroups;
        done_.largest = max(done_.largest, n);
        done_.groupTime += spent;
    }

    return done;
}


// ************************************************************************* //
