/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/
#include "ellipsoidCloud.H"
#include "cellSurroundings.H"
#include "masterFirst.H"
#include "throughFlow.H"
#include "PstreamBuffers.H"
#include "clockTime.H"

#include <algorithm>
#include <cfenv>
#include <cmath>

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    static inline point pointOf(const scalar x[3])
    {
        return point(x[0], x[1], x[2]);
    }

    //- What the observer of a cell's steps needs
    struct cellJourney
    {
        cellSurroundings& here;
        cellTracks& tracks;
        cellState& cell;
        frozenFlow::placeType place;
        ellipsoid_step last;
    };

    //- An ellipsoid_observer: stops a cell that has left the mesh
    static int observe(void* context, const ellipsoid_step* step)
    {
        cellJourney& journey = *static_cast<cellJourney*>(context);

        journey.last = *step;
        journey.cell.deepest =
            max(journey.cell.deepest, step->contact.deepest);
        journey.place = journey.here.settle(pointOf(step->after.x));

        if (journey.place == frozenFlow::pInside)
        {
            journey.tracks.add(journey.cell, *step);
            return 0;
        }

        return 1;
    }
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::ellipsoidCloud::makeInjections()
{
    const dictionary& dict = properties_.subDict("injection");
    const cellInjection::setting from
    {
        *whole_, *flow_, *walls_, model_, properties_.seed()
    };

    label nCells = 0;

    for (const entry& e : dict)
    {
        injections_.append(cellInjection::New(e.dict(), from, nCells).ptr());
        {
            const masterFirst once;
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
    const scalar whole = std::round(steps);

    return mag(steps - whole) < 1e-6 ? whole*time.deltaTValue() : time.value();
}


void Foam::ellipsoidCloud::inject(const scalar start, const scalar end)
{
    DynamicList<cellInjection::newCell> cells;

    for (const cellInjection& injection : injections_)
    {
        injection.append(start, end, cells);
    }

    for (const cellInjection::newCell& cell : cells)
    {
        const label celli = flow_->cell(cell.at);

        if (cellRank_[celli] != Pstream::myProcNo())
        {
            continue;
        }

        cellState state = cellState();
        std::copy_n(cell.x, 3, state.body.x);
        std::copy_n(cell.q, 4, state.body.q);
        state.time = cell.time;
        state.id = cell.id;
        state.tet = cell.at.tet;
        state.fate = cellState::inFlight;
        state.patch = -1;

        ellipsoid_flow_sample sample;
        frozenFlow::probe at(cell.at);
        flow_->sample(cell.x, at, false, sample);
        std::copy_n(sample.velocity, 3, state.body.u);

        tracks_->start(state);
        statistics_->note(captureStatistics::injected, state);
        addParticle(new ellipsoidParcel(mesh_, cellLocal_[celli], state));
    }
}


Foam::label Foam::ellipsoidCloud::stopAtPatch
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


bool Foam::ellipsoidCloud::move(ellipsoidParcel& parcel, const scalar end)
{
    cellState& cell = parcel.state();
    const frozenFlow::probe at{cell.tet, -1};

    cellSurroundings here(*flow_, *walls_, at);
    ellipsoid_surroundings around(here.core());
    around.seed = properties_.seed();
    around.id = cell.id;

    cellJourney journey
    {
        here, *tracks_, cell, frozenFlow::pInside, ellipsoid_step()
    };

    const point from(pointOf(cell.body.x));
    const scalar start = cell.time;

    // The core answers what is not finite by a shorter step; OpenFOAM's traps
    // would end the run
    std::fenv_t traps;
    std::feholdexcept(&traps);

    const ellipsoid_status status = ellipsoid_advance
    (
        &model_,
        &around,
        &cell.body,
        &cell.time,
        end,
        &cell.controller,
        &parcel.cache(),
        observe,
        &journey,
        &totals_
    );

    std::fesetenv(&traps);

    cell.tet = here.home().tet;

    const ellipsoid_contact& contact = journey.last.contact;

    if (status == ELLIPSOID_OK)
    {
        statistics_->judge
        (
            cell,
            end - start,
            mag(pointOf(cell.body.x) - from)/(end - start),
            UList<label>
            (
                const_cast<label*>(contact.touched), contact.touched_count
            )
        );
        return true;
    }

    if
    (
        status == ELLIPSOID_STOPPED
     && journey.place == frozenFlow::pBeyondOpen
    )
    {
        cell.patch = stopAtPatch(*flow_, journey.last, here.home(), cell);
        cell.fate = cellState::escaped;
        statistics_->note(captureStatistics::escaped, cell);
    }
    else
    {
        cell.fate = cellState::lost;
        cell.patch = -1;
        statistics_->note(captureStatistics::lost, cell);

        Pout<< "ellipsoidCloud: cell " << cell.id << " is lost at t = "
            << cell.time << " s, " << pointOf(cell.body.x) << " m: "
            << ellipsoid_status_text(status);

        if (here.refused() == frozenFlow::pBeyondCoupled)
        {
            Pout<< " at a cyclic or symmetry patch, which it must not reach";
        }
        Pout<< endl;
    }

    tracks_->finish(cell);

    return false;
}


void Foam::ellipsoidCloud::handOver()
{
    List<DynamicList<cellState>> leaving(Pstream::nProcs());

    for (ellipsoidParcel& parcel : *this)
    {
        const frozenFlow::probe at{parcel.state().tet, -1};
        const label celli = flow_->cell(at);
        const label ranki = cellRank_[celli];

        if (ranki == Pstream::myProcNo())
        {
            parcel.settle(cellLocal_[celli]);
        }
        else
        {
            leaving[ranki].append(parcel.state());
            deleteParticle(parcel);
        }
    }

    if (!Pstream::parRun())
    {
        return;
    }

    PstreamBuffers buffers(Pstream::commsTypes::nonBlocking);

    forAll(leaving, ranki)
    {
        if (leaving[ranki].size())
        {
            UOPstream os(ranki, buffers);
            os << leaving[ranki].size();
            os.write
            (
                reinterpret_cast<const char*>(leaving[ranki].cdata()),
                leaving[ranki].size()*sizeof(cellState)
            );
        }
    }

    labelList nBytes(Pstream::nProcs());
    buffers.finishedSends(nBytes);

    forAll(nBytes, ranki)
    {
        if (!nBytes[ranki])
        {
            continue;
        }

        UIPstream is(ranki, buffers);
        List<cellState> arriving(readLabel(is));
        is.read
        (
            reinterpret_cast<char*>(arriving.data()),
            arriving.size()*sizeof(cellState)
        );

        for (const cellState& state : arriving)
        {
            const frozenFlow::probe at{state.tet, -1};

            addParticle
            (
                new ellipsoidParcel
                (
                    mesh_, cellLocal_[flow_->cell(at)], state
                )
            );
        }
    }
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::ellipsoidCloud::ellipsoidCloud(const fvMesh& mesh)
:
    // Empty: what was written is looked at before it is read
    Cloud<ellipsoidParcel>
    (
        mesh,
        "ellipsoidCloud",
        IDLList<ellipsoidParcel>()
    ),
    mesh_(mesh),
    properties_(mesh),
    earlier_(mesh.time()),
    whole_(new undecomposedFlow(mesh)),
    model_(),
    flow_(),
    walls_(),
    cellRank_(whole_->cellRank()),
    cellLocal_(whole_->cellLocal()),
    injections_(),
    statistics_(),
    tracks_(),
    meshNotes_(),
    time_(presentTime(mesh.time())),
    firstTime_(mesh.time().timeName()),
    totals_(),
    trackingTime_(0),
    movingTime_(0),
    reportTime_(0)
{
    const ellipsoid_options& options = properties_.options();

    if (ellipsoid_model_init(&model_, &options) != ELLIPSOID_OK)
    {
        FatalIOErrorInFunction(properties_)
            << "the options are not those that were checked"
            << abort(FatalIOError);
    }

    {
        const masterFirst once;

        if (Pstream::master())
        {
            meshNotes_ = writtenState::notesOf(whole_->mesh());
            earlier_.checkMesh(whole_->mesh());
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
    const ellipsoid_options& options = properties_.options();

    whole_->gather(U, p, phi);

    flow_.reset
    (
        new frozenFlow(*whole_, options.fluid_density, properties_.scheme())
    );
    walls_.reset
    (
        new wallFacets
        (
            Pstream::master() ? &whole_->mesh() : nullptr,
            *std::max_element(options.semi_axes, options.semi_axes + 3)
        )
    );

    scalar speed = 0;
    if (Pstream::master())
    {
        const undecomposedFlow::serialScope serial;
        speed = throughFlow(whole_->U(), whole_->phi()).speed();
    }
    Pstream::scatter(speed);
    statistics_->setInletSpeed(speed);

    checkPlaces();
    makeInjections();
    whole_.clear();

    // Nothing on the disk is touched before all is known to be sound
    statistics_->open();
    tracks_->open();

    Info<< "ellipsoidCloud: " << flow_->nTets() << " tetrahedra, "
        << walls_->size() << " wall facets; slow is below "
        << statistics_->slowSpeed() << " m/s" << endl;
}


void Foam::ellipsoidCloud::evolve()
{
    const clockTime timer;
    const scalar end = presentTime(mesh_.time());

    inject(time_, end);

    const scalar begun = timer.elapsedTime();

    for (ellipsoidParcel& parcel : *this)
    {
        if (!move(parcel, end))
        {
            deleteParticle(parcel);
        }
    }

    movingTime_ += timer.elapsedTime() - begun;

    handOver();
    statistics_->gather();
    time_ = end;

    trackingTime_ += timer.elapsedTime();
    report();
}


// ************************************************************************* //
