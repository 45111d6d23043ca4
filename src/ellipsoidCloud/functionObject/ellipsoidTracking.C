// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "ellipsoidTracking.H"
#include "addToRunTimeSelectionTable.H"
#include "caseFiles.H"
#include "checkedEntries.H"
#include "caseSummary.H"
#include "cellPopulation.H"
#include "domainImages.H"
#include "ellipsoidCloud.H"
#include "flowChecks.H"
#include "masterGate.H"
#include "meshSearch.H"
#include "Time.H"

// * * * * * * * * * * * * * * Static Data Members * * * * * * * * * * * * * //

namespace Foam
{
namespace functionObjects
{
    defineTypeNameAndDebug(ellipsoidTracking, 0);
    addToRunTimeSelectionTable(functionObject, ellipsoidTracking, dictionary);

    //- The one that tracks the cells
    static const ellipsoidTracking* first = nullptr;
}
}


// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- A clock of its own, with these entries, for the case of a host, and the
    //  mesh of that case
    struct ownClock
    {
        //- Of the screen, which a new Time sets to the precision of files
        const int digits = Sout.precision();

        Time time;
        const fvMesh mesh;

        ownClock(const dictionary& entries, const Time& host)
        :
            time
            (
                entries, host.rootPath(), host.caseName(),
                host.system(), host.constant(), false, false
            ),
            mesh
            (
                IOobject
                (
                    fvMesh::defaultRegion, time.timeName(), time,
                    IOobject::MUST_READ
                )
            )
        {
            Sout.precision(digits);
        }
    };

    //- As long as it lives errors end the run, as OpenFOAM takes those of a
    //  function object that is being made, or with -postProcess, for warnings;
    //  and the screen has six digits, as writePrecision is of files
    struct trackingScope
    {
        const bool before = throwErrors(FatalError, false);
        const bool beforeIO = throwErrors(FatalIOError, false);
        const int digits = Sout.precision(6);

        ~trackingScope()
        {
            throwErrors(FatalError, before);
            throwErrors(FatalIOError, beforeIO);
            Sout.precision(digits);
        }
    };
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::dictionary Foam::functionObjects::ellipsoidTracking::clockEntries() const
{
    dictionary entries(time_.controlDict());

    for (const char* other : {"functions", "libs", "adjustTimeStep", "maxDeltaT"})
    {
        entries.remove(other);
    }
    entries.set("startFrom", "startTime");
    entries.set("startTime", 0);
    entries.set("stopAt", "endTime");
    entries.set("endTime", endTime_);
    entries.set("deltaT", deltaT_);
    entries.set("writeControl", "none");
    entries.set("runTimeModifiable", false);

    return entries;
}


void Foam::functionObjects::ellipsoidTracking::check(const fvMesh& mesh) const
{
    const caseProperties properties(mesh);
    const cellPopulation population(properties);
    const label nMeshCells = returnReduce(mesh.nCells(), sumOp<label>());
    boundBox bounds(meshedBox(mesh));
    bounds.reduce();

    // Whether walls leave listed cells room is known with the flow
    const meshSearch search(mesh);
    for (const entry& e : properties.section("injection"))
    {
        const pointField listed
        (
            e.isDict()
          ? e.dict().getOrDefault<pointField>("positions", pointField())
          : pointField()
        );
        for (const point& x : listed)
        {
            if (!returnReduce(search.findCell(x) >= 0, orOp<bool>()))
            {
                const masterGate once;
                FatalIOErrorInFunction(e.dict())
                    << "positions of injection " << e.keyword() << ": "
                    << shortText(x) << " lies outside the mesh, which"
                    << " reaches from " << shortText(bounds.min())
                    << " to " << shortText(bounds.max()) << " m"
                    << exit(FatalIOError);
            }
        }
    }

    const masterGate once;
    if (Pstream::master())
    {
        reportSize(nMeshCells, bounds, population);
    }
}


void Foam::functionObjects::ellipsoidTracking::checkDryRun() const
{
    check(ownClock(clockEntries(), time_).mesh);

    Info<< type() << ' ' << name() << ": the mesh of a dry run is a column of"
        << " mesh cells, through which no cell is tracked" << endl;
}


bool Foam::functionObjects::ellipsoidTracking::hasFlow() const
{
    return
        mesh_.foundObject<volVectorField>(U_)
     && mesh_.foundObject<volScalarField>(p_)
     && mesh_.foundObject<surfaceScalarField>(phi_);
}


Foam::solverFields Foam::functionObjects::ellipsoidTracking::flow() const
{
    if (!hasFlow())
    {
        const masterGate once;
        FatalErrorInFunction
            << type() << ' ' << name() << ": the program has not all of the"
            << " fields " << U_ << ", " << p_ << " and " << phi_ << nl
            << "    After a run take the solver itself, as simpleFoam"
            << " -postProcess, or postProcess -fields '(" << U_ << ' ' << p_
            << ' ' << phi_ << ")'; of other names tell U, p and phi of the"
            << " function object" << exit(FatalError);
    }

    const solverFields fields
    {
        mesh_.lookupObject<volVectorField>(U_),
        mesh_.lookupObject<volScalarField>(p_),
        mesh_.lookupObject<surfaceScalarField>(phi_)
    };
    checkDimensions(fields);

    return fields;
}


bool Foam::functionObjects::ellipsoidTracking::begin()
{
    if (cells_.valid())
    {
        return false;
    }

    checkFlux();
    cells_.reset(new ellipsoidCloud(mesh_, ellipsoidCloud::UNSTEADY));
    cells_->setFlow(flow());

    return true;
}


void Foam::functionObjects::ellipsoidTracking::checkFlux() const
{
    checkFluxDifference(fluxErrors(flow()).difference, mesh_);
}


void Foam::functionObjects::ellipsoidTracking::trackThroughEnd() const
{
    checkFlux();
    ownClock clock(clockEntries(), time_);
    ellipsoidCloud cells(clock.mesh, ellipsoidCloud::STEADY);

    cells.setFlow(flow());
    cells.track(clock.time, max(label(1), label(writeInterval_/deltaT_ + 0.5)));
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::functionObjects::ellipsoidTracking::ellipsoidTracking
(
    const word& name,
    const Time& runTime,
    const dictionary& dict
)
:
    fvMeshFunctionObject(name, runTime, dict),
    idle_(true),
    endTime_(runTime.endTime().value()),
    deltaT_(runTime.deltaTValue())
{
    const trackingScope scope;

    caseFiles::checkMesh(runTime, true);

    // One of the same name takes the place of that which was
    if
    (
        (first && first->name() != name)
     || mesh_.foundObject<IOdictionary>("ellipsoidCloudProperties")
    )
    {
        Info<< type() << ' ' << name << " does nothing: the cells of"
            << " ellipsoidCloudProperties are tracked already, by"
            << " ellipsoidTrapFoam or another function object" << endl;
        return;
    }
    first = this;
    read(dict);
    if (outputPrefix == "postProcessing-dry-run")
    {
        checkDryRun();
        return;
    }
    idle_ = false;

    // Mistakes are reported before the solver takes its time
    if (steady_)
    {
        if (hasFlow())
        {
            flow();
        }
        check(mesh_);
    }
    else if (hasFlow())
    {
        // The flow of the start, which the first time step replaces; with
        // -postProcess it is read later
        begin();
    }
}


Foam::functionObjects::ellipsoidTracking::~ellipsoidTracking()
{
    if (first == this)
    {
        first = nullptr;
    }
    if (!idle_)
    {
        Warning
            << type() << ' ' << name() << " was not called at the end of the"
            << " run: " << (steady_ ? "no cell was tracked" : "the tables lack"
            " their end") << nl << "    OpenFOAM calls an object that executes"
            << " or writes in the last time step: correct executeControl,"
            << " executeInterval, timeStart or timeEnd" << nl << endl;
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

bool Foam::functionObjects::ellipsoidTracking::read(const dictionary& dict)
{
    fvMeshFunctionObject::read(dict);
    checkValues
    (
        dict,
        {"steady", "U", "p", "phi", "endTime", "deltaT", "writeInterval"}
    );

    const word scheme
    (
        mesh_.schemesDict().subOrEmptyDict("ddtSchemes")
       .getOrDefault<word>("default", "steadyState")
    );

    steady_ = dict.getOrDefault("steady", scheme == "steadyState");
    U_ = dict.getOrDefault<word>("U", "U");
    p_ = dict.getOrDefault<word>("p", "p");
    phi_ = dict.getOrDefault<word>("phi", "phi");

    if (steady_)
    {
        endTime_ = checkedNumber<scalar>(dict, "endTime", above(0));
        deltaT_ =
            checkedNumber<scalar>(dict, "deltaT", entryRange{0, endTime_, true});
        writeInterval_ =
            checkedNumber<scalar>(dict, "writeInterval", above(0), endTime_);
    }

    return true;
}


bool Foam::functionObjects::ellipsoidTracking::execute()
{
    const trackingScope scope;

    if (idle_ || steady_ || begin())
    {
        return true;
    }
    if (mesh_.changing())
    {
        FatalErrorInFunction
            << "The mesh moves or changes, and cells do not go with it: "
            << name() << " of type " << type()
            << " needs a mesh that stays as it is" << exit(FatalError);
    }

    cells_->advance(flow());

    return true;
}


bool Foam::functionObjects::ellipsoidTracking::write()
{
    const trackingScope scope;

    if (!idle_ && !steady_)
    {
        cells_->writeTime();
    }

    return true;
}


bool Foam::functionObjects::ellipsoidTracking::end()
{
    if (idle_)
    {
        return true;
    }
    const trackingScope scope;

    idle_ = true;
    if (steady_)
    {
        trackThroughEnd();
    }
    else if (cells_.valid())
    {
        cells_->finish();

        // A solver's mesh is gone before its function objects are
        cells_.clear();
    }

    return true;
}
