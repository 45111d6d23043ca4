// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "ellipsoidCloud.H"
#include "caseSummary.H"
#include "electricField.H"
#include "masterGate.H"
#include "inletFlux.H"
#include "clockTime.H"
#include "surfaceFields.H"
#include "volFields.H"

#include <cmath>

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- The present time of the run [s], without the rounding that a run adds up
    //  step by step: a restart is to find the same times
    static scalar presentTime(const Time& time)
    {
        if (!(time.deltaTValue() > 0))
        {
            const masterGate once;
            FatalIOErrorInFunction(time.controlDict())
                << "deltaT " << time.deltaTValue() << nl
                << "    allowed: above 0 s" << exit(FatalIOError);
        }

        const scalar steps = time.value()/time.deltaTValue();
        const scalar nearest = std::round(steps);

        return
            mag(steps - nearest) < 1e-6
          ? nearest*time.deltaTValue()
          : time.value();
    }

    //- Say that a cell is lost, and why; on the master
    static void reportLost(const cellSweep& cell, const tableSet& set)
    {
        Info<< "ellipsoidCloud: cell " << cell.state.id << " is lost at t = "
            << set.timeText(cell.state.time, 6).c_str() << " s, "
            << cell.state.centre() << " m: "
            << (
                   cell.refused == meshFlow::pBeyondCoupled
                 ? "at a cyclic or symmetry patch, which it must not reach"
                 : ellipsoid_status_text(ellipsoid_status(cell.status))
               )
            << endl;
    }
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::ellipsoidCloud::makeDomain()
{
    if (!domain_.valid())
    {
        domain_.reset
        (
            new cellDomain
            (
                population_, *undecomposed_, field_, flowType_ == UNSTEADY
            )
        );
        field_.clear();
    }
}


void Foam::ellipsoidCloud::checkFlowType() const
{
    const masterGate once;

    if (occupancy_.valid() && flowType_ != OWN)
    {
        FatalIOErrorInFunction(properties_.subDict("occupancy"))
            << "Cells that block the flow, occupancy, need the flow of"
            << " ellipsoidTrapFoam" << exit(FatalIOError);
    }
    const dictionary& capture = properties_.section("capture");

    if
    (
        flowType_ == UNSTEADY
     && !capture.found("displacement") && !capture.found("speed")
    )
    {
        FatalIOErrorInFunction(properties_)
            << "capture/speed is missing, or displacement: in an unsteady flow"
            << " there is no one inlet speed that speedFraction could be of"
            << exit(FatalIOError);
    }
}


void Foam::ellipsoidCloud::checkClock() const
{
    const Time& time = mesh_.time();
    const scalar left = time.endTime().value() - time.value();
    const scalar deltaT = time.deltaTValue();
    const masterGate once;

    // A run that has come to its end may be started again
    if (left < -0.5*deltaT || (!earlier_.found() && !(left > 0)))
    {
        FatalIOErrorInFunction(time.controlDict())
            << "endTime " << shortText(time.endTime().value())
            << " s is not after the start at " << time.timeName()
            << " s: no cell would move" << exit(FatalIOError);
    }
    if (!earlier_.found() && !(left > 0.5*deltaT))
    {
        FatalIOErrorInFunction(time.controlDict())
            << "deltaT " << shortText(deltaT) << " s is too long for"
            << " the " << shortText(left) << " s up to endTime: no cell"
            << " would move" << exit(FatalIOError);
    }
    const scalar then = earlier_.notes().getOrDefault("deltaT", deltaT);
    if (flowType_ == OWN && then != deltaT)
    {
        Warning
            << "deltaT is " << deltaT << " s, and was " << then << " s in the"
            << " run so far: steps end at other times, and cells differ from"
            << " those of a run without a restart" << nl << endl;
    }
    if
    (
        Pstream::parRun()
     && time.writeFormat() == IOstream::ASCII
     && IOstream::defaultPrecision() < 17
    )
    {
        Warning
            << "writePrecision " << IOstream::defaultPrecision()
            << " is below 17: decomposePar rounds the flow, by which parallel"
            << " and serial runs will differ" << nl << endl;
    }
}


void Foam::ellipsoidCloud::checkImages(const domainImages& images) const
{
    for (const domainImages::seam& seam : images.seams())
    {
        if (!seam.mirrors() && blocking_.active)
        {
            const word& name = mesh_.boundaryMesh()[seam.patch].name();

            FatalIOErrorInFunction(properties_)
                << "cells pass cyclic patch " << name
                << ", and occupancy is active" << nl
                << "    Held cells do not know of the other side: set"
                << " occupancy/active no; or, if no cell comes there,"
                << " unreached (" << name << ");" << exit(FatalIOError);
        }
    }

    // A cell meets one image of another at a time, and none of itself
    const scalar longest = 2*population_.largest(longestSemiAxis);
    for (const vector& period : images.periods())
    {
        if (properties_.pushing() && mag(period) < 2.2*longest)
        {
            FatalIOErrorInFunction(properties_)
                << "cells of " << shortText(longest) << " m push one"
                << " another, and the cyclic patches repeat every "
                << shortText(mag(period)) << " m" << nl
                << "    That must be 2.2 lengths of a cell or more: mesh"
                << " several periods, or set contact/cells off"
                << exit(FatalIOError);
        }
    }
}


void Foam::ellipsoidCloud::evolve()
{
    const clockTime timer;

    const scalar end = presentTime(mesh_.time());

    addNew(time_, end);

    List<cellSweep> moves(interval_->advanceInterval(cells_, time_, end));
    DynamicList<cellEvent> events;
    criterion_.judge(cells_, moves, end, events);

    // Those that have gone are taken out
    label nLeft = 0;
    for (const cellSweep& cell : moves)
    {
        if (!cell.gone())
        {
            cells_[nLeft++] = cell.state;
        }
    }
    cells_.setSize(nLeft);
    time_ = end;

    if (occupancy_.valid())
    {
        occupancy_->update(cells_, events);
    }
    statistics_->add(std::move(events));

    // A cell that enters now has a row of this time, too
    tracks_->flush(time_);

    for (const cellSweep& cell : moves)
    {
        if (cell.gone())
        {
            interval_->forget(cell.state.id);
            population_.forget(cell.state.id);
            if (occupancy_.valid())
            {
                occupancy_->forget(cell.state.id);
            }
        }
        if (cell.state.fate == cellState::lost)
        {
            reportLost(cell, tracks_->set());
        }
    }

    trackingTime_ += timer.elapsedTime();
    report();
}


void Foam::ellipsoidCloud::renewFlow(heldFlowSolver& solver, bool again)
{
    do
    {
        const List<heldBody> bodies(occupancy_->bodies(cells_));
        List<heldWrench> wrenches(bodies.size());

        if (Pstream::master())
        {
            const undecomposedFlow::serialScope serial;
            const solverFields flow(solver.solve(bodies, wrenches));

            undecomposed_->take(flow);
            if (!again)
            {
                const scalar inflow = inletFlux(flow.U, flow.phi).inflow;
                occupancy_->write(time_, flow.phi, inflow, cells_);
            }
        }
        broadcast(wrenches);
        domain_->flow.renew(*undecomposed_, fluidDensity());

        if (!occupancy_->setWrenches(wrenches, cells_) || !again)
        {
            DynamicList<cellEvent> events;
            occupancy_->release(cells_, true, events);
            statistics_->add(std::move(events));
        }
        again = false;
    }
    while (occupancy_->outdated());
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::ellipsoidCloud::ellipsoidCloud(const fvMesh& mesh, const flowType type)
:
    cloud(mesh, "ellipsoidCloud"),
    mesh_(mesh),
    flowType_(type),
    properties_(mesh),
    population_(properties_),
    earlier_(mesh.time()),
    undecomposed_(new undecomposedFlow(mesh)),
    field_
    (
        electricField::read(properties_.section("forces"), mesh, *undecomposed_)
    ),
    blocking_(properties_.section("occupancy"), mesh.boundaryMesh()),
    criterion_(properties_.section("capture"), mesh.boundaryMesh()),
    time_(presentTime(mesh.time())),
    firstTime_(mesh.time().timeName())
{
    {
        const masterGate once;

        earlier_.checkSame("shape", population_.text());
        if (Pstream::master())
        {
            meshText_ = checkpoint::meshText(undecomposed_->mesh());
            earlier_.checkSame("mesh", meshText_);
        }
    }

    checkClock();
    makeTables();
    checkFlowType();

    {
        const masterGate once;

        if (Pstream::master())
        {
            const fvMesh& whole = undecomposed_->mesh();
            const domainImages images(whole, properties_.unreached());

            checkImages(images);

            // The function object has reported it before the solver began
            if (flowType_ != STEADY)
            {
                reportSize(whole.nCells(), meshedBox(whole), population_);
            }
            reportCapture(images);

            // Before the flow is solved: one that is no section ends the run
            const undecomposedFlow::serialScope serial;
            for (const occupancy::aperture& a : blocking_.apertures)
            {
                a.area(whole);
            }
        }
    }
    if (earlier_.found())
    {
        const masterGate once;

        cells_ = readStates(earlier_.takeCells());
        for (const cellState& cell : cells_)
        {
            population_.add(cell.id, cell.size);
        }
    }
}


Foam::ellipsoidCloud::~ellipsoidCloud() = default;


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::ellipsoidCloud::setFlow(const solverFields& flow, const bool asItIs)
{
    start_ = time_;
    undecomposed_->gather(flow);

    const inletFlux through(flow.U, flow.phi);
    through.checkWalls(mesh_, asItIs);
    if (flowType_ != UNSTEADY)
    {
        through.checkOpen(mesh_);
    }

    makeDomain();
    domain_->flow.renew(*undecomposed_, fluidDensity());
    criterion_.setInletSpeed(inletFlux::speedOf(*undecomposed_));

    reportFlow(through);

    if (flowType_ == OWN)
    {
        noteFlow();
    }
    if (flowType_ != UNSTEADY)
    {
        reportApertures(through.inflow);
    }

    planEntries();
    checkTimes();
    reportCells(through.inflow);
    inertiaReported_ =
        reportInertia(flow.U, properties_, population_.largest(longestSemiAxis));
    reportMovingWalls(flow.U, properties_);

    localCells_ = undecomposed_->localCells();

    if (occupancy_.valid())
    {
        occupancy_->setDomain(*domain_);
    }
    else if (flowType_ != UNSTEADY)
    {
        undecomposed_.clear();
    }

    interval_.reset
    (
        new groupScheduler
        (
            population_,
            *domain_,
            tracks_.get(),
            &criterion_,
            occupancy_.valid() ? &occupancy_->held() : nullptr
        )
    );

    Info<< "ellipsoidCloud: " << domain_->flow.nTets() << " tetrahedra, "
        << domain_->walls.size() << " wall facets; slow is below "
        << criterion_.slowSpeed() << " m/s" << endl;

    if (flowType_ == UNSTEADY)
    {
        beginTables();
    }
}


void Foam::ellipsoidCloud::advance(const solverFields& flow)
{
    const scalar end = presentTime(mesh_.time());

    // -postProcess executes at the start, too
    if (!(end > time_))
    {
        return;
    }
    inletFlux(flow.U, flow.phi).checkWalls(mesh_, false);
    inertiaReported_ =
        inertiaReported_
     || reportInertia(flow.U, properties_, population_.largest(longestSemiAxis));

    undecomposed_->gather(flow);
    domain_->flow.advance(*undecomposed_, fluidDensity(), time_, end);
    for (cellInjection& injection : injections_)
    {
        injection.renew();
    }

    evolve();
}


void Foam::ellipsoidCloud::track
(
    Time& runTime,
    const label every,
    heldFlowSolver* solver
)
{
    beginTables();
    if (solver)
    {
        renewFlow(*solver, earlier_.found());
    }

    while (runTime.loop())
    {
        evolve();
        // Else it adds up rounding, and so do the names of times
        static_cast<dimensionedScalar&>(runTime).value() = time_;
        if (solver && occupancy_->outdated())
        {
            renewFlow(*solver, false);
        }

        if (every ? runTime.timeIndex() % every == 0 : runTime.writeTime())
        {
            writeTime();
        }
    }

    finish();
}


void Foam::ellipsoidCloud::finish()
{
    if (Pstream::master())
    {
        DynamicList<cellTracks::row> rows;
        for (cellState& cell : cells_)
        {
            if (!cell.waits())
            {
                tracks_->finish(cell, rows);
            }
        }
        tracks_->addRows(rows);
    }
    tracks_->flush();

    reportWork();

    if (Pstream::master())
    {
        statistics_->finish(cells_, Info);
        tracks_->writeVTP
        (
            [&](const label id) { return statistics_->sizeOf(id); }
        );
    }
}
