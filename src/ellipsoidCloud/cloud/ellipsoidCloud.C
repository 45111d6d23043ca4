/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/
#include "ellipsoidCloud.H"
#include "masterGate.H"
#include "inletFlux.H"
#include "clockTime.H"
#include "surfaceFields.H"
#include "volFields.H"

#include <algorithm>
#include <cmath>

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::ellipsoidCloud::makeInjections()
{
    const dictionary& dict = properties_.subDict("injection");
    const cellInjection::setting from
    {
        *undecomposed_, *flow_, *walls_, population_, properties_.seed()
    };

    label nCells = 0;

    for (const entry& e : dict)
    {
        injections_.append(cellInjection::New(e.dict(), from, nCells).ptr());
        {
            const masterGate once;
            injections_.last().check();
        }
        nCells += injections_.last().size();
    }

    Info<< "ellipsoidCloud: " << nCells << " cells to enter by "
        << flatOutput(dict.toc()) << endl;
}


Foam::scalar Foam::ellipsoidCloud::presentTime(const Time& time)
{
    const scalar steps = time.value()/time.deltaTValue();
    const scalar nearest = std::round(steps);

    return
        mag(steps - nearest) < 1e-6
      ? nearest*time.deltaTValue()
      : time.value();
}


void Foam::ellipsoidCloud::addNew(const scalar start, const scalar end)
{
    DynamicList<cellInjection::newCell> newCells;

    for (const cellInjection& injection : injections_)
    {
        injection.append(start, end, newCells);
    }

    for (const cellInjection::newCell& cell : newCells)
    {
        const cellSize size(population_.drawn(cell.id));
        population_.take(cell.id, size);
        cells_.append(cell.state(*flow_, size));
    }

    if (newCells.size())
    {
        sortCells();
    }
}


void Foam::ellipsoidCloud::sortCells()
{
    std::sort
    (
        cells_.begin(),
        cells_.end(),
        [](const cellState& a, const cellState& b) { return a.id < b.id; }
    );
}


void Foam::ellipsoidCloud::reportLost(const cellSweep& cell)
{
    const scalar* x = cell.state.body.x;

    Info<< "ellipsoidCloud: cell " << cell.state.id << " is lost at t = "
        << cell.state.time << " s, " << point(x[0], x[1], x[2]) << " m: "
        << ellipsoid_status_text(ellipsoid_status(cell.status));

    if (cell.refused == frozenFlow::pBeyondCoupled)
    {
        Info<< " at a cyclic or symmetry patch, which it must not reach";
    }
    Info<< endl;
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::ellipsoidCloud::ellipsoidCloud(const fvMesh& mesh)
:
    mesh_(mesh),
    properties_(mesh),
    earlier_(mesh.time()),
    undecomposed_(new undecomposedFlow(mesh)),
    field_(new electricField(properties_.section("forces"), mesh)),
    population_(properties_),
    flow_(),
    walls_(),
    cellRank_(undecomposed_->cellRank()),
    cellLocal_(undecomposed_->cellLocal()),
    injections_(),
    cells_(),
    criterion_(properties_.section("capture"), mesh.boundaryMesh()),
    statistics_(),
    tracks_(),
    interval_(),
    meshNotes_(),
    time_(presentTime(mesh.time())),
    firstTime_(mesh.time().timeName()),
    trackingTime_(0),
    reportTime_(0)
{
    {
        const masterGate once;

        if (Pstream::master())
        {
            meshNotes_ = checkpoint::notesOf(undecomposed_->mesh());
            earlier_.checkMesh(meshNotes_);
        }
    }

    makeTables();
    if (earlier_.found())
    {
        readCells();
        checkCells();
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::ellipsoidCloud::setFlow
(
    const volVectorField& U,
    const volScalarField& p,
    const surfaceScalarField& phi
)
{
    undecomposed_->gather(U, p, phi);

    flow_.reset
    (
        new frozenFlow
        (
            *undecomposed_,
            fluidDensity(),
            properties_.scheme(),
            field_->onUndecomposed(*undecomposed_)
        )
    );
    walls_.reset
    (
        new wallFacets
        (
            Pstream::master() ? &undecomposed_->mesh() : nullptr,
            longestSemiAxis(properties_.options())
        )
    );

    criterion_.setInletSpeed(inletFlux::speedOf(*undecomposed_));

    checkPlaces();
    makeInjections();
    field_.clear();
    undecomposed_.clear();

    interval_.reset
    (
        new groupScheduler
        (
            population_, *flow_, *walls_, properties_, tracks_.get()
        )
    );

    // Nothing on the disk is changed before all has been checked
    statistics_->open();
    tracks_->open();

    Info<< "ellipsoidCloud: " << flow_->nTets() << " tetrahedra, "
        << walls_->size() << " wall facets; slow is below "
        << criterion_.slowSpeed() << " m/s" << endl;
}


void Foam::ellipsoidCloud::evolve()
{
    const clockTime timer;
    const scalar end = presentTime(mesh_.time());

    addNew(time_, end);

    DynamicList<cellEvent> events;
    const List<cellSweep> moves
    (
        interval_->advanceInterval(cells_, criterion_, time_, end, events)
    );
    statistics_->add(std::move(events));

    for (const cellSweep& cell : moves)
    {
        if (cell.gone())
        {
            population_.forget(cell.state.id);
        }
        if (cell.state.fate == cellState::lost)
        {
            reportLost(cell);
        }
    }

    time_ = end;

    trackingTime_ += timer.elapsedTime();
    report();
}


// ************************************************************************* //
