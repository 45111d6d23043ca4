// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

/*---------------------------------------------------------------------------*\
Application
    trapContact

Description
    What an accepted step and a simulated millisecond cost in the bulk, near
    walls and in contact: the cells of a case, each alone, in its solved flow.

Usage
    \b trapContact [OPTION]

    Options:
      - \par -repeats \<n\>
        Figures are medians of so many, 5 unless told.

    Cells end with the case's endTime, or as they leave.

\*---------------------------------------------------------------------------*/

#include "argList.H"
#include "Time.H"
#include "fvMesh.H"
#include "columnFvMesh.H"
#include "cellInjection.H"
#include "cellSurroundings.H"
#include "inletFlux.H"
#include "surfaceFields.H"
#include "undecomposedFlow.H"
#include "volFields.H"

#include <algorithm>
#include <cfenv>
#include <cstdio>
#include <ctime>
#include <vector>

using namespace Foam;

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace
{

enum kindType { BULK, NEAR, FLYING, HELD, nKinds };

const char* const kindNames[nKinds] =
    {"bulk", "near a wall", "touching, under way", "touching, held"};

//- An accepted step, with the attempts rejected before it
struct taken
{
    scalar cost;        // [s] of CPU time
    scalar span;        // [s] simulated
    long rejected;
    int landings;       // by so much more beads touch at its end
    kindType kind;
};

//- What is said of all steps of a kind
struct figures
{
    long steps, rejected, landings;
    scalar span;        // [ms] simulated
    scalar median;      // [us] of an accepted step
    scalar mean;        // [us] of an accepted step, with the rejected ones
    scalar perMs;       // [us] a simulated millisecond
};


//- CPU time of this process [s]
scalar seconds()
{
    timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return now.tv_sec + 1e-9*now.tv_nsec;
}


scalar medianOf(std::vector<scalar> values)
{
    if (values.empty())
    {
        return 0;
    }
    std::nth_element
    (
        values.begin(), values.begin() + values.size()/2, values.end()
    );
    return values[values.size()/2];
}


//- What reading the clock adds to a step [s]
scalar clockCost()
{
    std::vector<scalar> costs;
    for (int i = 0; i < 10000; ++i)
    {
        const scalar start = seconds();
        costs.push_back(seconds() - start);
    }
    return medianOf(costs);
}


//- What the observer of a cell's steps needs
struct journey
{
    cellSurroundings here;
    const wallFacets& walls;
    const ellipsoid_model& model;
    const scalar clock;
    std::vector<taken> steps;
    ellipsoid_statistics done;
    long rejected;
    int touching;
    bool near;
    scalar since;

    journey
    (
        const cellDomain& domain,
        const meshFlow::probe& at,
        const ellipsoid_model& of,
        const scalar clockTime
    )
    :
        here(domain, at),
        walls(domain.walls),
        model(of),
        clock(clockTime),
        steps(),
        done(),
        rejected(0),
        touching(0),
        near(true),
        since(0)
    {}

    //- Is there a facet that could act on a bead, were the cell turned?
    bool nearWalls(const scalar x[3]) const
    {
        DynamicList<int> listed;
        ellipsoid_facet_list list;

        return
            walls.list
            (
                x, model.reach + model.options.bead_radius, listed, list
            ) != 0
         || list.count > 0;
    }
};


//- An ellipsoid_observer: stops a cell that has left the mesh
int observe(void* context, const ellipsoid_step* step)
{
    journey& j = *static_cast<journey*>(context);
    const scalar* x = step->after.x;

    isometry image;
    const bool inside =
        j.here.moveHome(point(x[0], x[1], x[2]), image) == meshFlow::pInside;

    taken t;
    t.cost = seconds() - j.since - j.clock;
    t.span = step->end - step->start;
    t.rejected = j.done.rejected - j.rejected;
    t.landings = max(step->contact.bead_contacts - j.touching, 0);

    const bool wasNear = j.near;
    const bool touched = j.touching > 0;
    j.near = j.nearWalls(x);
    j.touching = step->contact.bead_contacts;
    j.rejected = j.done.rejected;
    t.kind =
        touched || j.touching > 0 ? FLYING
      : wasNear || j.near ? NEAR
      : BULK;
    j.steps.push_back(t);

    j.since = seconds();
    return !inside;
}


//- Advance a cell, in the intervals in which the solver does
void advance
(
    journey& j,
    const cellState& cell,
    const Time& runTime,
    const scalar slowSpeed
)
{
    ellipsoid_controller controller = {};
    ellipsoid_state body = cell.body;
    facetCache cache(j.model);
    const ellipsoid_member member =
        {&j.model, &j.here, &body, &controller, cache, &j, &j.done};
    const scalar interval = runTime.deltaTValue();
    ellipsoid_status status = ELLIPSOID_OK;
    scalar t = 0;

    for
    (
        label i = 1;
        status == ELLIPSOID_OK && t < runTime.endTime().value();
        ++i
    )
    {
        const point from(body.x[0], body.x[1], body.x[2]);
        const size_t first = j.steps.size();

        j.since = seconds();
        status = ellipsoid_advance
        (
            &member, &t, i*interval, observe
        );

        // Held by what it has moved: of one that bounces speed tells little
        if (mag(point(body.x[0], body.x[1], body.x[2]) - from)
            < slowSpeed*interval)
        {
            for (size_t k = first; k < j.steps.size(); ++k)
            {
                if (j.steps[k].kind == FLYING)
                {
                    j.steps[k].kind = HELD;
                }
            }
        }
    }

    if (status != ELLIPSOID_OK && status != ELLIPSOID_STOPPED)
    {
        FatalErrorInFunction
            << "cell " << cell.id << ": " << ellipsoid_status_text(status)
            << exit(FatalError);
    }
}


//- Sum up the steps of a kind
figures summed(const std::vector<taken>& steps, const kindType kind)
{
    figures sum = {};
    scalar cost = 0;
    std::vector<scalar> costs;

    for (const taken& t : steps)
    {
        if (t.kind == kind)
        {
            ++sum.steps;
            sum.rejected += t.rejected;
            sum.landings += t.landings;
            sum.span += 1e3*t.span;
            cost += 1e6*t.cost;
            costs.push_back(1e6*t.cost);
        }
    }
    sum.median = medianOf(costs);
    sum.mean = sum.steps ? cost/sum.steps : 0;
    sum.perMs = sum.span > 0 ? cost/sum.span : 0;
    return sum;
}


//- Medians over the repeats, each a list by kind
void print(const std::vector<std::vector<figures>>& repeats)
{
    // Of a figure, or of its ratio to that of the bulk in the same repeat
    const auto over =
        [&](const int kind, scalar figures::* figure, const bool ratio)
        {
            std::vector<scalar> values;
            for (const std::vector<figures>& all : repeats)
            {
                const scalar unit = ratio ? all[BULK].*figure : 1;
                values.push_back(unit > 0 ? all[kind].*figure/unit : 0);
            }
            return medianOf(values);
        };

    std::printf
    (
        "%-20s %8s %8s %8s %8s %6s %8s %6s %8s %6s %8s %8s\n",
        "", "accepted", "rejected", "ms", "median", "ratio", "mean", "ratio",
        "us/ms", "ratio", "landings", "steps"
    );

    for (int kind = 0; kind < nKinds; ++kind)
    {
        const figures& one = repeats[0][kind];
        const long attempts = one.steps + one.rejected;

        std::printf
        (
            "%-20s %8ld %7.1f%% %8.0f", kindNames[kind], one.steps,
            attempts ? 100.0*one.rejected/attempts : 0, one.span
        );
        for (const auto figure :
            {&figures::median, &figures::mean, &figures::perMs})
        {
            std::printf
            (
                " %8.2f %6.2f",
                over(kind, figure, false), over(kind, figure, true)
            );
        }
        std::printf(" %8ld", one.landings);
        if (one.landings)
        {
            std::printf(" %8.1f", scalar(attempts)/one.landings);
        }
        std::printf("\n");
    }
}

} // End namespace


int main(int argc, char *argv[])
{
    argList::addNote
    (
        "What steps and simulated milliseconds cost in the bulk, near walls"
        " and in contact."
    );
    argList::noParallel();
    argList::addOption("repeats", "n", "Figures are medians of so many [5]");

    #include "setRootCaseLists.H"
    #include "createTime.H"
    #include "createMesh.H"

    const auto io =
        [&](const word& name)
        {
            return IOobject
            (
                name, runTime.timeName(), mesh,
                IOobject::MUST_READ, IOobject::NO_WRITE
            );
        };
    const surfaceScalarField phi(io("phi"), mesh);
    const volScalarField p(io("p"), mesh);
    const volVectorField U(io("U"), mesh);

    // As in ellipsoidCloud
    const ellipsoidProperties properties(mesh);
    const ellipsoid_options& options = properties.options();
    const cellPopulation population(properties);

    undecomposedFlow whole(mesh);
    whole.gather({U, p, phi});
    cellDomain domain(population, whole, autoPtr<volVectorField>(), false);
    domain.flow.renew(whole, properties.options().fluid_density);
    const scalar slowSpeed =
        checkedNumber
        (
            properties.section("capture"), "speedFraction", above(0), 0.01
        )
       *inletFlux(U, phi).speed;

    DynamicList<cellState> cells;
    for (const entry& e : properties.subDict("injection"))
    {
        const cellInjection::setting from
        {
            e.dict(), whole, domain, population, cells.size(),
            runTime.value(), true
        };
        cellInjection::New(from)->append(-GREAT, GREAT, cells);
    }

    const label nRepeats = args.getOrDefault<label>("repeats", 5);
    const scalar clock = clockCost();
    std::vector<std::vector<figures>> repeats;

    // As in groupAdvance: the core answers what is not finite
    std::fenv_t traps;
    std::feholdexcept(&traps);

    for (label n = 0; n < nRepeats; ++n)
    {
        std::vector<taken> steps;
        for (const cellState& cell : cells)
        {
            const meshFlow::probe at{cell.tet, -1};
            journey j(domain, at, population.median(), clock);
            advance(j, cell, runTime, slowSpeed);
            steps.insert(steps.end(), j.steps.begin(), j.steps.end());
        }

        std::vector<figures> all;
        for (int kind = 0; kind < nKinds; ++kind)
        {
            all.push_back(summed(steps, kindType(kind)));
        }
        repeats.push_back(all);
    }

    std::fesetenv(&traps);

    std::printf
    (
        "%d cells, %d wall facets, tolerance %g, clock %.2f us\n",
        int(cells.size()), int(domain.walls.size()), options.tolerance,
        1e6*clock
    );
    print(repeats);

    return 0;
}
