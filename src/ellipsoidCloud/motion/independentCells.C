/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/
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

void Foam::independentCells::followSome
(
    const UList<cellInjection::newCell>& starts,
    const scalar deltaT,
    const scalar endTime,
    ending* endings
) const
{
    groupScheduler scheduler(population_, flow_, walls_, properties_, nullptr);
    DynamicList<cellEvent> events;

    List<cellState> cells(starts.size());
    labelList which(identity(starts.size()));
    forAll(starts, i)
    {
        cells[i] = starts[i].state(flow_, population_.medianSize());
        endings[i] = ending{cellState::inFlight, -1, -1};
    }

    // No last one of rounding's length
    const label nIntervals = label(std::ceil(endTime/deltaT - 1e-6));

    for (label n = 0; cells.size() && n < nIntervals; ++n)
    {
        const scalar end = n + 1 < nIntervals ? (n + 1)*deltaT : endTime;
        events.clear();
        const List<cellSweep> moves
        (
            scheduler.advanceInterval(cells, criterion_, n*deltaT, end, events)
        );

        label nStay = 0;
        forAll(moves, i)
        {
            const cellSweep& cell = moves[i];
            ending& to = endings[which[i]];

            to.fate = cell.state.fate;
            to.patch = cell.state.patch;

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
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::independentCells::independentCells
(
    const ellipsoidProperties& properties,
    const fvMesh& mesh,
    const undecomposedFlow& undecomposed
)
:
    properties_(properties),
    patchNames_(mesh.boundaryMesh().names()),
    criterion_(properties.section("capture"), mesh.boundaryMesh()),
    population_(properties),
    flow_
    (
        undecomposed,
        properties.options().fluid_density,
        properties.scheme(),
        electricField(properties.section("forces"), mesh)
       .onUndecomposed(undecomposed)
    ),
    walls_
    (
        Pstream::master() ? &undecomposed.mesh() : nullptr,
        longestSemiAxis(properties.options())
    )
{
    criterion_.setInletSpeed(inletFlux::speedOf(undecomposed));
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

bool Foam::independentCells::fits(cellInjection::newCell& cell) const
{
    return
        flow_.find(point(cell.x[0], cell.x[1], cell.x[2]), cell.at)
     && !cell.overlaps(population_.median(), flow_, walls_);
}


Foam::List<Foam::independentCells::ending> Foam::independentCells::follow
(
    const UList<cellInjection::newCell>& starts,
    const scalar deltaT,
    const scalar endTime
) const
{
    List<ending> endings(starts.size());

    for (label first = 0; first < starts.size(); first += mostAtOnce)
    {
        const label n = min(mostAtOnce, starts.size() - first);

        followSome
        (
            SubList<cellInjection::newCell>(starts, n, first),
            deltaT,
            endTime,
            &endings[first]
        );
    }

    return endings;
}


// ************************************************************************* //
