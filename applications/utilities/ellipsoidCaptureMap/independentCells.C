// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "independentCells.H"
#include "electricField.H"
#include "fvMesh.H"
#include "inletFlux.H"
#include "undecomposedFlow.H"
#include "volFields.H"

#include <cmath>

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- Each cell keeps the facets near it, some 30 kB
    static const label mostAtOnce = 1000;
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::List<Foam::independentCells::ending>
Foam::independentCells::followSome
(
    const UList<cellState>& starts,
    const scalar deltaT,
    const scalar endTime
) const
{
    groupScheduler scheduler(population_, domain_, nullptr, &criterion_);
    DynamicList<cellEvent> events;

    List<cellState> cells(starts);
    labelList which(identity(starts.size()));
    List<ending> endings(starts.size(), ending{cellState::inFlight, -1, -1});
    for (cellState& cell : cells)
    {
        cell.size = population_.medianSize();
        cellInjection::wait(cell, 0, domain_.flow);
    }

    // No last one of rounding's length
    const label nIntervals = label(std::ceil(endTime/deltaT - 1e-6));

    for (label n = 0; cells.size() && n < nIntervals; ++n)
    {
        const scalar end = n + 1 < nIntervals ? (n + 1)*deltaT : endTime;
        events.clear();
        List<cellSweep> moves(scheduler.advanceInterval(cells, n*deltaT, end));
        criterion_.judge(cells, moves, end, events);

        label nStay = 0;
        forAll(moves, i)
        {
            const cellSweep& cell = moves[i];
            ending& to = endings[which[i]];

            to.fate = cell.state.fate;
            to.patch = cell.state.patch;
            if (cell.gone())
            {
                scheduler.forget(cell.state.id);
            }

            for (label w = 0; w < cell.nWalls && !cell.gone(); ++w)
            {
                if (criterion_.sieves().found(cell.walls[w]))
                {
                    to.touched = cell.walls[w];
                }
            }

            // One that has stalled may get going again
            if (!cell.gone() && to.fate != cellState::caught)
            {
                which[nStay] = which[i];
                cells[nStay++] = cell.state;
            }
        }
        which.setSize(nStay);
        cells.setSize(nStay);
    }

    return endings;
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::independentCells::independentCells
(
    const ellipsoidProperties& properties,
    const fvMesh& mesh,
    const undecomposedFlow& undecomposed
)
:
    patchNames_(mesh.boundaryMesh().names()),
    criterion_(properties.section("capture"), mesh.boundaryMesh()),
    population_(properties),
    domain_
    (
        population_,
        undecomposed,
        electricField::read(properties.section("forces"), mesh, undecomposed),
        false
    )
{
    domain_.flow.renew(undecomposed, properties.options().fluid_density);
    criterion_.setInletSpeed(inletFlux::speedOf(undecomposed));
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

bool Foam::independentCells::fits(cellState& cell) const
{
    meshFlow::probe at;
    const bool inside = domain_.flow.find(cell.centre(), at);
    cell.tet = at.tet;

    return
        inside
     && !cellInjection::overlaps(cell, population_.median(), domain_);
}


Foam::List<Foam::independentCells::ending> Foam::independentCells::follow
(
    const UList<cellState>& starts,
    const scalar deltaT,
    const scalar endTime
) const
{
    DynamicList<ending> endings;

    for (label first = 0; first < starts.size(); first += mostAtOnce)
    {
        const label n = min(mostAtOnce, starts.size() - first);
        const SubList<cellState> some(starts, n, first);

        endings.append(followSome(some, deltaT, endTime));
    }

    return List<ending>(std::move(endings));
}
