// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "captureCriterion.H"
#include "cellDomain.H"
#include "checkedEntries.H"
#include "Map.H"
#include "polyBoundaryMesh.H"
#include "wallPolyPatch.H"
#include "wordRes.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- What holds the cells that have been slow for the hold time
    static void judgeHeld
    (
        List<cellSweep>& moves,
        const scalar holdTime,
        const labelUList& sieves,
        DynamicList<cellEvent>& events
    )
    {
        // Those that have been slow for the hold time, and are not yet caught
        DynamicList<label> open;
        Map<label> indices;
        forAll(moves, i)
        {
            const cellState& cell = moves[i].state;

            indices.insert(cell.id, i);
            if
            (
                cell.slowTime >= holdTime
             && (
                    cell.fate == cellState::inFlight
                 || cell.fate == cellState::stalled
                )
            )
            {
                open.append(i);
            }
        }

        const auto setFate =
            [&](cellState& cell, const cellState::fateType fate, label patchi)
            {
                cell.fate = fate;
                cell.patch = patchi;
                events.append(cellEvent{cellState::fateNames[fate], cell});
            };

        const auto isCaught =
            [&](const label i)
            {
                return moves[i].state.fate == cellState::caught;
            };

        for (const label i : open)
        {
            cellSweep& cell = moves[i];

            for (label w = 0; w < cell.nWalls && !isCaught(i); ++w)
            {
                if (sieves.found(cell.walls[w]))
                {
                    setFate(cell.state, cellState::caught, cell.walls[w]);
                }
            }
        }

        // By a cell that is caught, which another may have to be first
        for (bool changed = true; changed;)
        {
            changed = false;

            for (const label i : open)
            {
                cellSweep& cell = moves[i];

                for (label c = 0; c < cell.nCells && !isCaught(i); ++c)
                {
                    const auto other = indices.cfind(cell.cells[c]);

                    if (other.found() && isCaught(*other))
                    {
                        const label patchi = moves[*other].state.patch;
                        setFate(cell.state, cellState::caught, patchi);
                        changed = true;
                    }
                }
            }
        }

        for (const label i : open)
        {
            cellSweep& cell = moves[i];

            if (cell.state.fate == cellState::inFlight)
            {
                const label patchi = cell.nWalls ? cell.walls[0] : -1;
                setFate(cell.state, cellState::stalled, patchi);
            }
        }
    }
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::captureCriterion::captureCriterion
(
    const dictionary& dict,
    const polyBoundaryMesh& patches
)
:
    displacement_(checkedNumber(dict, "displacement", above(0), 0.0)),
    speed_(checkedNumber(dict, "speed", above(0), 0.0)),
    speedFraction_(checkedNumber(dict, "speedFraction", above(0), 0.01)),
    holdTime_
    (
        checkedNumber(dict, "holdTime", above(0), displacement_ > 0 ? 1 : 0.05)
    )
{
    checkKeywords
    (
        dict, {"sieves", "displacement", "speed", "speedFraction", "holdTime"}
    );

    if
    (
        dict.found("speed") + dict.found("speedFraction")
      + dict.found("displacement") > 1
    )
    {
        FatalIOErrorInFunction(dict)
            << "give one of displacement, speed and speedFraction"
            << exit(FatalIOError);
    }

    for (const wordRe& name : patternsOf(dict, "sieves"))
    {
        const labelHashSet matched(patches.patchSet(wordRes({name}), false));

        if (matched.empty())
        {
            FatalIOErrorInFunction(dict)
                << "no patch matches sieve " << name << nl
                << "    patches: " << flatOutput(patches.names())
                << exit(FatalIOError);
        }

        for (const label patchi : matched.sortedToc())
        {
            if (!isA<wallPolyPatch>(patches[patchi]))
            {
                FatalIOErrorInFunction(dict)
                    << "sieve " << patches[patchi].name() << " is not a wall"
                    << nl << "    It is of type " << patches[patchi].type()
                    << ": name another, or set type wall in"
                    << " constant/polyMesh/boundary" << exit(FatalIOError);
            }
            if (!sieves_.found(patchi))
            {
                sieves_.append(patchi);
            }
        }
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

bool Foam::captureCriterion::stays
(
    const cellState& was,
    const scalar end,
    cellState& cell
) const
{
    const scalar dt = end - was.time;

    if (displacement_ > 0)
    {
        if (was.waits())
        {
            cell.place = was.unfolded();
        }
        if (mag(cell.unfolded() - cell.place) < displacement_)
        {
            cell.slowTime += dt;
            cell.imbalance =
                mag(cell.netImpulse)/max(mag(cell.dragImpulse), VSMALL);
            return true;
        }
        cell.setPlace(cell.unfolded());
        return false;
    }

    if (mag(cell.unfolded() - was.unfolded())/dt < slowSpeed_)
    {
        cell.slowTime += dt;
        return true;
    }
    cell.slowTime = 0;
    cell.imbalance = 0;
    return false;
}


void Foam::captureCriterion::ended
(
    cellSweep& cell,
    const point& from,
    const scalar since,
    const ellipsoid_model& model,
    const cellDomain& domain
) const
{
    cellState& state = cell.state;

    if (!(state.slowTime > 0 || cell.nWalls || cell.nCells))
    {
        return;
    }

    meshFlow::probe at{state.tet, -1};
    tetCoordinates c;
    if (!domain.flow.reach(state.centre(), at, c))
    {
        state.imbalance = 1;
        return;
    }

    const vector U(domain.flow.velocity(state.time, c));
    vector drag;
    ellipsoid_drag_at_rest(&model, state.body.q, U.v_, drag.v_);

    // What contact does not balance is the drag of the cell's own motion
    vector left;
    ellipsoid_drag_at_rest(&model, state.body.q, state.body.u, left.v_);
    if (state.fate != cellState::caught)
    {
        state.imbalance =
            max(state.imbalance, mag(left)/max(mag(drag), VSMALL));
    }
    state.dragImpulse += (state.time - since)*drag;

    const vector moved(state.centre() - from);
    ellipsoid_drag_at_rest(&model, state.body.q, moved.v_, drag.v_);
    state.netImpulse += drag;
}


void Foam::captureCriterion::judge
(
    const UList<cellState>& before,
    List<cellSweep>& moves,
    const scalar end,
    DynamicList<cellEvent>& events
) const
{
    forAll(moves, i)
    {
        cellState& cell = moves[i].state;
        const bool waits = cell.waits();

        if (before[i].waits() && !waits)
        {
            events.append(cellEvent{"injected", before[i]});
            events.last().cell.fate = cellState::inFlight;
        }

        // Waiting once, at the first attempt
        if (waits ? cell.time == cell.planned : moves[i].gone())
        {
            const auto fate = cellState::fateType(cell.fate);
            events.append(cellEvent{cellState::fateNames[fate], cell});
        }

        if
        (
            !waits && !moves[i].gone() && !stays(before[i], end, cell)
         && cell.fate != cellState::inFlight
        )
        {
            cell.fate = cellState::inFlight;
            events.append(cellEvent{"released", cell});
            cell.patch = -1;
        }
    }

    judgeHeld(moves, holdTime_, sieves_, events);

    // From now on the place of one that was confined for so long is where it is
    for (cellSweep& move : moves)
    {
        if (displacement_ > 0 && move.state.slowTime >= holdTime_)
        {
            move.state.slowTime = 0;
            move.state.place = move.state.unfolded();
        }
    }
}
