/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/
#include "captureStatistics.H"
#include "polyBoundaryMesh.H"
#include "wallPolyPatch.H"
#include "wordRes.H"

#include <algorithm>

// * * * * * * * * * * * * * * Static Data Members * * * * * * * * * * * * * //

const Foam::Enum<Foam::captureStatistics::eventType>
Foam::captureStatistics::eventNames
({
    { eventType::injected, "injected" },
    { eventType::caught, "caught" },
    { eventType::released, "released" },
    { eventType::stalled, "stalled" },
    { eventType::escaped, "escaped" },
    { eventType::lost, "lost" },
    { eventType::waiting, "waiting" }
});


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::cellState::fateType Foam::captureStatistics::fateAfter
(
    const packedEvent& event
)
{
    switch (eventType(label(event[2])))
    {
        case caught: return cellState::caught;
        case stalled: return cellState::stalled;
        case escaped: return cellState::escaped;
        case lost: return cellState::lost;
        case waiting: return cellState::waiting;
        case injected:
        case released: break;
    }

    return cellState::inFlight;
}


Foam::word Foam::captureStatistics::patchName(const label patchi) const
{
    return patchi < 0 ? word("-") : patchNames_[patchi];
}


void Foam::captureStatistics::count(const packedEvent& event)
{
    const label id(event[1]);

    if (!cells_.found(id))
    {
        cells_.insert(id, record{event, event, event[0], -1, -1, 0, 0, 0});
    }
    else
    {
        record& cell = cells_[id];
        --counts_[fateAfter(cell.last)];
        cell.last = event;
    }

    record& cell = cells_[id];
    ++counts_[fateAfter(event)];
    cell.deepest = event[11];
    cell.deepestCell = event[12];

    if (eventType(label(event[2])) == injected)
    {
        cell.injection = event;
    }
    if (fateAfter(event) == cellState::caught && cell.firstSieve < 0)
    {
        cell.firstCatch = event[0];
        cell.firstSieve = label(event[3]);
    }
}


void Foam::captureStatistics::note(const eventType what, const cellState& cell)
{
    if (!Pstream::master())
    {
        return;
    }

    packedEvent event;
    event[0] = cell.time;
    event[1] = cell.id;
    event[2] = what;
    event[3] = cell.patch;
    std::copy_n(cell.body.x, 3, event.begin() + 4);
    std::copy_n(cell.body.q, 4, event.begin() + 7);
    event[11] = cell.deepest;
    event[12] = cell.deepestCell;
    event[13] = cell.length;
    event[14] = cell.width;

    pending_.append(event);
}


void Foam::captureStatistics::judgeSpeed
(
    cellState& cell,
    const scalar dt,
    const scalar meanSpeed
)
{
    if (meanSpeed < slowSpeed_)
    {
        cell.slowTime += dt;
        return;
    }

    cell.slowTime = 0;
    cell.imbalance = 0;

    if (cell.fate == cellState::caught || cell.fate == cellState::stalled)
    {
        note(released, cell);
        cell.fate = cellState::inFlight;
        cell.patch = -1;
    }
}


void Foam::captureStatistics::judgeHeld(List<cellSweep>& moves)
{
    // Held, and not yet caught
    DynamicList<label> open;
    Map<label> place;

    forAll(moves, i)
    {
        const cellState& cell = moves[i].state;
        place.insert(cell.id, i);

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
            moves[i].state.fate = fate;
            moves[i].state.patch = patchi;
            note(fate == cellState::caught ? caught : stalled, moves[i].state);
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
                const auto other = place.cfind(moves[i].cells[c]);

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

Foam::captureStatistics::setting::setting
(
    const dictionary& dict,
    const polyBoundaryMesh& patches
)
:
    sieves(),
    speedFraction
    (
        ellipsoidProperties::getAboveOrDefault(dict, "speedFraction", 0, 0.01)
    ),
    holdTime
    (
        ellipsoidProperties::getAboveOrDefault(dict, "holdTime", 0, 0.05)
    )
{
    ellipsoidProperties::checkKeywords
    (
        dict, {"sieves", "speedFraction", "holdTime"}
    );

    const wordRes names(dict.getOrDefault("sieves", wordRes()));

    for (const wordRe& name : names)
    {
        DynamicList<label> matched;

        forAll(patches, patchi)
        {
            if (name.match(patches[patchi].name()))
            {
                if (!isA<wallPolyPatch>(patches[patchi]))
                {
                    FatalIOErrorInFunction(dict)
                        << "sieve " << patches[patchi].name()
                        << " is not a wall"
                        << exit(FatalIOError);
                }
                matched.append(patchi);
            }
        }

        if (matched.empty())
        {
            FatalIOErrorInFunction(dict)
                << "no patch matches sieve " << name << nl
                << "    patches: " << flatOutput(patches.names())
                << exit(FatalIOError);
        }

        for (const label patchi : matched)
        {
            if (!sieves.found(patchi))
            {
                sieves.append(patchi);
            }
        }
    }
}


Foam::captureStatistics::captureStatistics
(
    const setting& given,
    const wordList& patchNames,
    const cellPopulation& population,
    const fileName& folder,
    const dictionary& earlierLog
)
:
    patchNames_(patchNames),
    sieves_(given.sieves),
    speedFraction_(given.speedFraction),
    slowSpeed_(0),
    holdTime_(given.holdTime),
    population_(population),
    nLogged_(population.varies() ? 15 : 13),
    folder_(folder),
    pending_(),
    cells_(),
    counts_(Zero),
    log_
    (
        folder/"events.csv",
        std::string
        (
            "t,id,event,patch,x1,x2,x3,eps1,eps2,eps3,eta,deepest,deepestCell"
        ) + (population.varies() ? ",length,width" : ""),
        12,
        earlierLog
    )
{
    if (Pstream::master() && log_.earlier() > 0)
    {
        readLog();
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::captureStatistics::judge
(
    const UList<cellState>& before,
    List<cellSweep>& moves,
    const scalar end
)
{
    forAll(moves, i)
    {
        const cellState& was = before[i];
        cellState& cell = moves[i].state;

        if (cell.fate == cellState::waiting)
        {
            // Once, at the first attempt
            if (cell.time == cell.planned)
            {
                note(waiting, cell);
            }
            continue;
        }
        if (was.fate == cellState::waiting)
        {
            note(injected, was);
        }

        if (cell.fate == cellState::escaped || cell.fate == cellState::lost)
        {
            note
            (
                cell.fate == cellState::escaped ? escaped : lost, cell
            );
        }
        else
        {
            const scalar dt = end - was.time;
            const point from(was.body.x[0], was.body.x[1], was.body.x[2]);
            const point to(cell.body.x[0], cell.body.x[1], cell.body.x[2]);

            judgeSpeed(cell, dt, mag(to - from)/dt);
        }
    }

    judgeHeld(moves);
}


bool Foam::captureStatistics::inside(const label id) const
{
    if (!cells_.found(id))
    {
        return false;
    }

    const cellState::fateType fate = fateAfter(cells_[id].last);

    return fate != cellState::escaped && fate != cellState::lost;
}


Foam::labelList Foam::captureStatistics::cellsInside() const
{
    DynamicList<label> ids;
    for (const label id : cells_.sortedToc())
    {
        if (inside(id))
        {
            ids.append(id);
        }
    }

    return labelList(std::move(ids));
}


void Foam::captureStatistics::update(const UList<cellState>& cells)
{
    for (const cellState& cell : cells)
    {
        if (cell.fate != cellState::waiting)
        {
            cells_[cell.id].deepest = cell.deepest;
            cells_[cell.id].deepestCell = cell.deepestCell;
            cells_[cell.id].imbalance = cell.imbalance;
        }
    }
}


// ************************************************************************* //
