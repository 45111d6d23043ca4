// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "groupAdvance.H"
#include "cellSurroundings.H"
#include "clockTime.H"

#include <cfenv>

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- Most cells of a group: the memory it needs grows with their square, and is
    //  1.3 GB then
    static const label largestGroup = 2000;

    //- Most lists of facets that are kept, of 25 kB each: where there are more
    //  cells, their lists are made anew in each interval
    static const label keptCaches = 250;
}


// * * * * * * * * * * * * * * * Private Classes * * * * * * * * * * * * * * //

struct Foam::groupAdvance::member
{
    // Public Data

        //- In the list of cells
        const label index;

        cellSweep& cell;
        const ellipsoid_model& model;
        const cellDomain& domain;

        //- Is the space that it sweeps asked for?
        const bool sweeping;

        //- Steps that end before have no row of a track [s]
        const scalar firstRow;
        DynamicList<segment>& path;

        cellSurroundings here;

        //- Where the last step ended, the image there, and the step itself if
        //  it is the last until then [s], or leaves the mesh
        meshFlow::locationType location;
        isometry image;
        const scalar end;
        ellipsoid_step last;

        //- Where it was at the start [m], and when [s]
        point from;
        scalar since;

        //- Distance from there at which it is stopped [m]; 0: at none
        scalar reach;


    // Member Functions

        //- An ellipsoid_observer: stops a cell that has left the mesh or goes
        //  on in an image
        static int observe(void* context, const ellipsoid_step* step)
        {
            member& m = *static_cast<member*>(context);
            cellState& state = m.cell.state;
            const ellipsoid_contact& contact = step->contact;
            const label tet = m.here.home.tet;

            m.location = m.here.moveHome(pointOf(step->after.x), m.image);
            if (step->end >= m.end || m.location != meshFlow::pInside)
            {
                m.last = *step;
            }
            state.deepest = max(state.deepest, contact.deepest);
            state.deepestCell = max(state.deepestCell, contact.cell_deepest);

            if (m.sweeping)
            {
                ellipsoid_sweep_add_step(&m.cell.sweep, &m.model, step);
            }

            if (m.location != meshFlow::pInside)
            {
                return 1;
            }

            if (step->end >= m.firstRow)
            {
                m.path.append(segment{m.index, *step, tet});
            }
            return !m.image.isIdentity() || m.isFar();
        }

        //- Has it come as far as that?
        bool isFar() const
        {
            return reach > 0 && mag(cell.state.centre() - from) >= reach;
        }

        //- Put a cell that has passed a plane of symmetry or a cyclic patch
        //  where it is in the mesh
        void pass()
        {
            cell.state.pass(image, model.options.semi_axes);
            if (image.translates())
            {
                for (direction i = 0; i < 3; ++i)
                {
                    cell.sweep.passed[i] -= image.b[i];
                }
            }
            from = image(from);
            image = isometry();
        }

        //- Note the contacts at the end
        void noteContacts()
        {
            const ellipsoid_contact& contact = last.contact;

            cell.nWalls = contact.surface_count;
            std::copy_n(contact.surface, cell.nWalls, cell.walls);
            cell.nCells = contact.cell_count;
            std::copy_n(contact.cell_id, cell.nCells, cell.cells);
        }

        //- A cell that passed a patch is stopped there; all but those that
        //  passed an open one are lost
        void remove(const ellipsoid_status status)
        {
            const bool escaped = location == meshFlow::pBeyondOpen;

            if (escaped || location == meshFlow::pBeyondCoupled)
            {
                stopAtPatch();
            }
            if (escaped)
            {
                cell.state.fate = cellState::escaped;
            }
            else
            {
                cell.state.patch = -1;
                cell.state.fate = cellState::lost;
                cell.status = status;
                cell.refused = location;
            }
        }

        //- Put a cell where its last step passed a patch
        void stopAtPatch()
        {
            // Bisection: inside at the start of the step, beyond at its end
            scalar inside = last.start;
            scalar beyond = last.end;
            meshFlow::probe at(here.home);
            cellState& state = cell.state;
            state.patch = -1;

            for (label i = 0; i < 40; ++i)
            {
                const scalar middle = 0.5*(inside + beyond);
                ellipsoid_step_state(&last, middle, &state.body);
                const auto there = domain.flow.locate(state.centre(), at);

                if (there == meshFlow::pInside)
                {
                    inside = middle;
                }
                else
                {
                    beyond = middle;
                    state.patch = at.patch;
                }
            }

            ellipsoid_step_state(&last, inside, &state.body);
            state.time = inside;

            at = here.home;
            domain.flow.locate(state.centre(), at, &image);
            if (!image.isIdentity())
            {
                pass();
            }
        }
};


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

const ellipsoid_model& Foam::groupAdvance::noiseless(const label id)
{
    if (!noiseless_.found(id))
    {
        ellipsoid_options options(population_.model(id).options);
        options.brownian = false;
        noiseless_.set
        (
            id, new ellipsoid_model(cellPopulation::modelOf(options))
        );
    }

    return *noiseless_[id];
}


void Foam::groupAdvance::rest
(
    List<cellSweep>& cells,
    const labelUList& group,
    const scalar end,
    DynamicList<segment>& path
) const
{
    for (const label i : group)
    {
        cellState& cell = cells[i].state;
        path.append(segment{i, ellipsoid_step(), cell.tet});

        ellipsoid_step& step = path.last().step;
        step.start = cell.time;
        step.end = cell.time = end;
        step.before = step.after = cell.body;
    }
}


void Foam::groupAdvance::enter
(
    List<cellSweep>& cells,
    const labelUList& group,
    const scalar end,
    const trial* tried,
    DynamicList<segment>& path,
    PtrList<member>& own,
    List<ellipsoid_member>& members
)
{
    const ellipsoidProperties& properties = population_.properties();

    if (caches_.size() > keptCaches)
    {
        caches_.clear();
    }
    forAll(group, i)
    {
        cellSweep& cell = cells[group[i]];
        const label id = cell.state.id;

        if (cell.state.waits())
        {
            cell.state.fate = cellState::inFlight;
        }

        if (!caches_.found(id))
        {
            caches_.set(id, new facetCache(population_.model(id)));
        }

        // What unfolds the way follows from all steps
        const scalar nextRow =
            domain_.flow.images().empty() ? cell.state.nextRow : -GREAT;

        const ellipsoid_model& model = population_.model(id);
        const bool isTried = tried && id == tried->cell;

        own.set
        (
            i,
            new member
            {
                group[i], cell,
                tried && model.options.brownian ? noiseless(id) : model,
                domain_,
                properties.pushing() || tried, tried ? GREAT : nextRow, path,
                {domain_, meshFlow::probe{cell.state.tet, -1}},
                meshFlow::pInside, isometry(), end, ellipsoid_step(),
                cell.state.centre(), cell.state.time,
                isTried ? tried->reach : 0
            }
        );
        cellSurroundings& here = own[i].here;
        here.fixed = isFixed(id, tried);
        here.setForces(properties.forces(), own[i].model.options);
        if (isTried && tried->pull)
        {
            here.setStill(*tried->pull);
        }
        here.repeat = reinterpret_cast<const scalar(*)[3]>(periods_.cdata());
        here.repeat_count = periods_.size();
        here.seed = properties.seed();
        here.id = id;

        members[i].model = &own[i].model;
        members[i].surroundings = &here;
        members[i].state = &cell.state.body;
        members[i].controller = &cell.state.controller;
        members[i].cache = *caches_[id];
        members[i].observer_context = &own[i];
        members[i].statistics = &done_.steps;
    }
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
            member::observe,
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
        bool isOver = false;
        forAll(members, i)
        {
            member& m = *static_cast<member*>(members[i].observer_context);

            isOver = isOver || m.isFar();
            m.cell.state.time = t;
            m.cell.state.tet = m.here.home.tet;

            if (failed ? i == which : m.location != meshFlow::pInside)
            {
                m.remove(status);
                continue;
            }
            if (!m.image.isIdentity())
            {
                m.pass();
            }
            if (status == ELLIPSOID_OK)
            {
                m.noteContacts();
                if (observer_ && !m.here.fixed)
                {
                    observer_->ended(m.cell, m.from, m.since, m.model, domain_);
                }
            }
            else
            {
                members[nLeft++] = members[i];
            }
        }
        members.setSize(isOver ? 0 : nLeft);
    }

    return true;
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::groupAdvance::groupAdvance
(
    const cellPopulation& population,
    const cellDomain& domain,
    const heldCells* held,
    const contactObserver* observer
)
:
    population_(population),
    domain_(domain),
    periods_(domain.flow.images().periods()),
    held_(held),
    observer_(observer),
    done_()
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

bool Foam::groupAdvance::advance
(
    List<cellSweep>& cells,
    const labelUList& group,
    const scalar end,
    const bool mayFail,
    DynamicList<segment>& path,
    const trial* tried
)
{
    if (group.size() > largestGroup)
    {
        if (!mayFail)
        {
            FatalErrorInFunction
                << group.size() << " cells near one another, cell "
                << cells[group[0]].state.id
                << " among them, are one group; at most " << largestGroup
                << " can be moved together" << nl
                << "    let fewer enter, or set contact/cells off"
                << exit(FatalError);
        }
        return false;
    }

    label nFixed = 0;
    for (const label i : group)
    {
        nFixed += isFixed(cells[i].state.id, tried);
    }
    if (nFixed == group.size())
    {
        rest(cells, group, end, path);
        return true;
    }

    const clockTime timer;
    const label n = group.size();
    const label size = ellipsoid_group_size(n)/sizeof(scalar) + 1;
    memory_.setSize(max(memory_.size(), size));

    PtrList<member> own(n);
    List<ellipsoid_member> members(n);

    enter(cells, group, end, tried, path, own, members);

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
