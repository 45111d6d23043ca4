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
    static const label mostTogether = 2000;

    //- What the observer of a cell's steps needs
    struct cellJourney
    {
        cellSurroundings here;
        cellSweep& cell;
        const cellTracks& tracks;
        DynamicList<cellTracks::row>& rows;

        //- Of the cell
        const ellipsoid_model& model;

        //- Is its sweep asked for?
        const bool sweeping;

        frozenFlow::placeType place;
        ellipsoid_step last;

        cellJourney
        (
            const frozenFlow& flow,
            const wallFacets& walls,
            cellSweep& move,
            const cellTracks& to,
            DynamicList<cellTracks::row>& buffer,
            const ellipsoid_model& itsModel,
            const bool itsSweep
        )
        :
            here(flow, walls, frozenFlow::probe{move.state.tet, -1}),
            cell(move),
            tracks(to),
            rows(buffer),
            model(itsModel),
            sweeping(itsSweep),
            place(frozenFlow::pInside),
            last()
        {}
    };

    //- Add what a cell sweeps in a step
    static void sweep
    (
        const ellipsoid_step& step,
        const ellipsoid_model& model,
        cellSweep& cell
    )
    {
        // A path bends between the ends of a long step
        const label nParts = 4;
        for (label i = 1; i < nParts; ++i)
        {
            ellipsoid_state body;
            ellipsoid_step_state
            (
                &step, step.start + i*(step.end - step.start)/nParts, &body
            );
            cell.sweep(body, model);
        }
        cell.sweep(step.after, model);
    }

    //- An ellipsoid_observer: stops a cell that has left the mesh
    static int observe(void* context, const ellipsoid_step* step)
    {
        cellJourney& journey = *static_cast<cellJourney*>(context);
        cellState& state = journey.cell.state;

        journey.last = *step;
        state.deepest = max(state.deepest, step->contact.deepest);
        state.deepestCell = max(state.deepestCell, step->contact.cell_deepest);
        journey.place = journey.here.settle(pointOf(step->after.x));

        if (journey.sweeping)
        {
            sweep(*step, journey.model, journey.cell);
        }

        if (journey.place == frozenFlow::pInside)
        {
            journey.tracks.add(state, *step, journey.rows);
            return 0;
        }

        return 1;
    }

    //- Stop a cell that passed an open patch there; the patch's label
    static label stopAtPatch
    (
        const frozenFlow& flow,
        const ellipsoid_step& step,
        frozenFlow::probe at,
        cellState& cell
    )
    {
        // Bisection: inside at the start of the step, beyond at its end
        scalar inside = step.start;
        scalar beyond = step.end;
        label patchi = -1;

        for (label i = 0; i < 40; ++i)
        {
            const scalar middle = 0.5*(inside + beyond);
            ellipsoid_step_state(&step, middle, &cell.body);

            const frozenFlow::placeType place =
                flow.place(pointOf(cell.body.x), at);

            if (place == frozenFlow::pInside)
            {
                inside = middle;
            }
            else
            {
                beyond = middle;
                patchi = at.patch;
            }
        }

        ellipsoid_step_state(&step, inside, &cell.body);
        cell.time = inside;

        return patchi;
    }
}


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


void Foam::groupAdvance::admit
(
    List<cellSweep>& cells,
    const labelUList& who,
    DynamicList<cellTracks::row>& rows
) const
{
    for (const label i : who)
    {
        cellState& cell = cells[i].state;

        if (cell.fate == cellState::waiting)
        {
            cell.fate = cellState::inFlight;
            tracks_.start(cell, rows);
        }
    }
}


Foam::scalar Foam::groupAdvance::imbalance(const cellJourney& journey) const
{
    const ellipsoid_state& body = journey.cell.state.body;
    const ellipsoid_contact& contact = journey.last.contact;

    frozenFlow::probe at(journey.here.home());
    ellipsoid_flow_sample flow;
    if (flow_.sample(body.x, at, false, flow))
    {
        return 1;
    }

    vector drag;
    ellipsoid_drag_at_rest(&journey.model, body.q, flow.velocity, drag.v_);

    vector sum(drag);
    for (int i = 0; i < 3; ++i)
    {
        sum[i] += contact.force[i] + contact.cell_force[i];
    }

    return mag(sum)/max(mag(drag), VSMALL);
}


void Foam::groupAdvance::takeOut
(
    cellSweep& cell,
    cellJourney& journey,
    const ellipsoid_status status
) const
{
    if (journey.place == frozenFlow::pBeyondOpen)
    {
        cell.state.patch = stopAtPatch
        (
            flow_, journey.last, journey.here.home(), cell.state
        );
        cell.state.fate = cellState::escaped;
    }
    else
    {
        cell.state.patch = -1;
        cell.state.fate = cellState::lost;
        cell.status = status;
        cell.refused = journey.here.refused();
    }

    tracks_.finish(cell.state, journey.rows);
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::groupAdvance::groupAdvance
(
    const cellPopulation& population,
    const frozenFlow& flow,
    const wallFacets& walls,
    const cellTracks& tracks,
    const label seed,
    const bool sweeping
)
:
    population_(population),
    flow_(flow),
    walls_(walls),
    tracks_(tracks),
    seed_(seed),
    sweeping_(sweeping),
    caches_(),
    memory_(),
    done_()
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

bool Foam::groupAdvance::move
(
    List<cellSweep>& cells,
    const labelUList& who,
    const scalar end,
    const bool mayFail,
    DynamicList<cellTracks::row>& rows
)
{
    if (who.size() > mostTogether)
    {
        if (mayFail)
        {
            return false;
        }

        FatalErrorInFunction
            << who.size() << " cells near one another, cell "
            << cells[who[0]].state.id << " among them, are one group; at most "
            << mostTogether << " can be moved together" << nl
            << "    let fewer enter, or set contact/cells off"
            << exit(FatalError);
    }

    const clockTime timer;

    admit(cells, who, rows);

    PtrList<cellJourney> journeys(who.size());
    List<ellipsoid_surroundings> around(who.size());
    List<ellipsoid_member> members(who.size());

    forAll(who, i)
    {
        cellSweep& cell = cells[who[i]];

        journeys.set
        (
            i,
            new cellJourney
            (
                flow_,
                walls_,
                cell,
                tracks_,
                rows,
                population_.model(cell.state.id),
                sweeping_
            )
        );
        around[i] = journeys[i].here.core();
        around[i].seed = seed_;
        around[i].id = cell.state.id;

        members[i].model = &journeys[i].model;
        members[i].surroundings = &around[i];
        members[i].state = &cell.state.body;
        members[i].controller = &cell.state.controller;
        members[i].cache = &cache(cell.state.id);
        members[i].observer_context = &journeys[i];
        members[i].statistics = &done_.steps;
    }

    memory_.setSize
    (
        max
        (
            memory_.size(),
            label(ellipsoid_group_size(who.size())/sizeof(scalar) + 1)
        )
    );

    scalar t = cells[who[0]].state.time;
    bool failed = false;

    // The core answers what is not finite by a shorter step; OpenFOAM's traps
    // would end the run
    std::fenv_t traps;
    std::feholdexcept(&traps);

    while (members.size() && !failed)
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

        failed =
            mayFail
         && members.size() > 1
         && status != ELLIPSOID_OK
         && status != ELLIPSOID_STOPPED;

        // The last to come is the one to blame where none is in particular
        if (status != ELLIPSOID_OK && which < 0)
        {
            which = members.size() - 1;
        }

        label nStay = 0;
        forAll(members, i)
        {
            cellJourney& journey =
                *static_cast<cellJourney*>(members[i].observer_context);
            cellSweep& cell = journey.cell;

            cell.state.time = t;
            cell.state.tet = journey.here.home().tet;

            const bool leaves =
                status == ELLIPSOID_STOPPED
              ? journey.place != frozenFlow::pInside
              : status != ELLIPSOID_OK && i == which;

            if (leaves)
            {
                takeOut(cell, journey, status);
            }
            else if (status == ELLIPSOID_OK)
            {
                const ellipsoid_contact& contact = journey.last.contact;

                cell.nWalls = contact.touched_count;
                std::copy_n(contact.touched, cell.nWalls, cell.walls);
                cell.nCells = contact.touched_cell_count;
                std::copy_n(contact.touched_cell, cell.nCells, cell.cells);

                // Slow before, or perhaps from now on: what touches nothing
                // costs nothing
                if
                (
                    cell.state.fate != cellState::caught
                 && (cell.state.slowTime > 0 || cell.nWalls || cell.nCells)
                )
                {
                    cell.state.imbalance =
                        max(cell.state.imbalance, imbalance(journey));
                }
            }
            else
            {
                members[nStay++] = members[i];
            }
        }
        members.setSize(nStay);
    }

    std::fesetenv(&traps);

    const scalar spent = timer.elapsedTime();
    done_.time += spent;
    if (who.size() > 1)
    {
        ++done_.nGroups;
        done_.largest = max(done_.largest, who.size());
        done_.groupTime += spent;
    }

    return !failed;
}


// ************************************************************************* //
