/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/
#include "captureCriterion.H"
#include "ellipsoidProperties.H"
#include "Map.H"
#include "polyBoundaryMesh.H"
#include "stringListOps.H"
#include "wallPolyPatch.H"
#include "wordRes.H"

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::captureCriterion::judgeSpeed
(
    const UList<cellState>& before,
    List<cellSweep>& moves,
    const scalar end,
    DynamicList<cellEvent>& events
) const
{
    forAll(moves, i)
    {
        const cellState& was = before[i];
        cellState& cell = moves[i].state;

        if (cell.fate == cellState::waiting || moves[i].gone())
        {
            continue;
        }

        const scalar dt = end - was.time;

        if (mag(cell.centre() - was.centre())/dt < slowSpeed_)
        {
            cell.slowTime += dt;
            continue;
        }

        cell.slowTime = 0;
        cell.imbalance = 0;

        if (cell.fate != cellState::inFlight)
        {
            cell.fate = cellState::inFlight;
            events.append(cellEvent{"released", cell});
            cell.patch = -1;
        }
    }
}


void Foam::captureCriterion::judgeHeld
(
    List<cellSweep>& moves,
    DynamicList<cellEvent>& events
) const
{
    // Held, and not yet caught
    DynamicList<label> open;
    Map<label> indices;

    forAll(moves, i)
    {
        const cellState& cell = moves[i].state;
        indices.insert(cell.id, i);

        if
        (
            cell.slowTime >= holdTime_
         && (
                cell.fate == cellState::inFlight
             || cell.fate == cellState::stalled
            )
        )
        {
            open.append(i);
        }
    }

    const auto settle =
        [&](const label i, const cellState::fateType fate, const label patchi)
        {
            cellState& cell = moves[i].state;
            cell.fate = fate;
            cell.patch = patchi;
            events.append(cellEvent{cellState::fateNames[fate], cell});
        };

    const auto isCaught =
        [&](const label i) { return moves[i].state.fate == cellState::caught; };

    for (const label i : open)
    {
        for (label w = 0; w < moves[i].nWalls && !isCaught(i); ++w)
        {
            if (sieves_.found(moves[i].walls[w]))
            {
                settle(i, cellState::caught, moves[i].walls[w]);
            }
        }
    }

    // By a cell that is caught, which another may have to be first
    for (bool changed = true; changed;)
    {
        changed = false;

        for (const label i : open)
        {
            for (label c = 0; c < moves[i].nCells && !isCaught(i); ++c)
            {
                const auto other = indices.cfind(moves[i].cells[c]);

                if (other.found() && isCaught(*other))
                {
                    settle(i, cellState::caught, moves[*other].state.patch);
                    changed = true;
                }
            }
        }
    }

    for (const label i : open)
    {
        if (moves[i].state.fate == cellState::inFlight)
        {
            settle
            (
                i, cellState::stalled, moves[i].nWalls ? moves[i].walls[0] : -1
            );
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
    sieves_(),
    speedFraction_
    (
        ellipsoidProperties::getAboveOrDefault(dict, "speedFraction", 0, 0.01)
    ),
    slowSpeed_(0),
    holdTime_
    (
        ellipsoidProperties::getAboveOrDefault(dict, "holdTime", 0, 0.05)
    )
{
    ellipsoidProperties::checkKeywords
    (
        dict, {"sieves", "speedFraction", "holdTime"}
    );

    for (const wordRe& name : dict.getOrDefault("sieves", wordRes()))
    {
        const labelList matched(findStrings(name, patches.names()));

        if (matched.empty())
        {
            FatalIOErrorInFunction(dict)
                << "no patch matches sieve " << name << nl
                << "    patches: " << flatOutput(patches.names())
                << exit(FatalIOError);
        }

        for (const label patchi : matched)
        {
            if (!isA<wallPolyPatch>(patches[patchi]))
            {
                FatalIOErrorInFunction(dict)
                    << "sieve " << patches[patchi].name()
                    << " is not a wall" << exit(FatalIOError);
            }
            if (!sieves_.found(patchi))
            {
                sieves_.append(patchi);
            }
        }
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

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
        const cellState& cell = moves[i].state;
        const bool waits = cell.fate == cellState::waiting;

        if (before[i].fate == cellState::waiting && !waits)
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
    }

    judgeSpeed(before, moves, end, events);
    judgeHeld(moves, events);
}

// ************************************************************************* //
