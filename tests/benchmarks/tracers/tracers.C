// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

/*---------------------------------------------------------------------------*\
Application
    tracers

Description
    Where the flow takes what it carries. Points that have the velocity of the
    flow begin on a lattice over the inlet, each with the flux of its part of
    it. Of each throat, what reaches it is compared with the flux of the solver
    through it.

    A coarse lattice tells which parts of the inlet lead to throats, finer ones
    are laid over these.

Usage
    \b tracers [OPTIONS]

      - \par -interpolation \<name\>
        Instead of that in ellipsoidCloudProperties

      - \par -number \<n\>
        Points of each lattice, 20000 by default

      - \par -check
        Look at the velocity alone (velocityCheck.H), no tracers

      - \par -known \<name\>
        Put a velocity that is known in the place of U and phi: linear, parabola,
        turned, slit or shear (knownVelocity)

      - \par -write
        Write that as the flow of the case, and no more

      - \par -tolerance \<m\>
        Error of a step of a tracer, 1e-11 m by default

      - \par -columns \<n\>
        Parts of the inlet's width among which the fine lattice chooses, 200 by
        default

    The dictionary system/tracersDict has
    \table
        Property | Description
        inlet    | min and max of a rectangle normal to the flow along y, [m]
        endTime  | time [s] after which a point is given up
        throats  | min and max [m] of a rectangle for each name, normal to y
    \endtable

\*---------------------------------------------------------------------------*/

#include "argList.H"
#include "Time.H"
#include "fvMesh.H"
#include "columnFvMesh.H"
#include "meshFlow.H"
#include "surfaceFields.H"
#include "surfaceInterpolate.H"
#include "undecomposedFlow.H"
#include "tracerRectangle.H"
#include "velocityCheck.H"
#include "volFields.H"

#include <algorithm>
#include <ctime>
#include <vector>

using namespace Foam;

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace
{

//- CPU time of this process [s]
scalar seconds()
{
    timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return now.tv_sec + 1e-9*now.tv_nsec;
}


//- Position and velocity of a tracer, by the method of Dormand and Prince
class tracer
{
    const meshFlow& flow_;
    meshFlow::probe probe_;

    bool slope(const point& x, vector& u)
    {
        tetCoordinates c;
        meshFlow::probe at(probe_);

        ++nSamples;
        if (!flow_.reach(x, at, c))
        {
            return false;
        }
        u = flow_.velocity(0, c);
        return true;
    }


public:

    point x;
    vector u;
    scalar step;
    label nSamples;

    tracer(const meshFlow& flow, const point& start)
    :
        flow_(flow),
        probe_{0, -1},
        x(start),
        u(Zero),
        step(1e-5),
        nSamples(0)
    {
        if (!flow_.find(x, probe_) || !slope(x, u))
        {
            u = Zero;
        }
    }

    //- One step of at most the time left. False where the flow ends.
    bool advance(const scalar left, const scalar tolerance, scalar& taken)
    {
        static const scalar A[6][6] =
        {
            {1.0/5},
            {3.0/40, 9.0/40},
            {44.0/45, -56.0/15, 32.0/9},
            {19372.0/6561, -25360.0/2187, 64448.0/6561, -212.0/729},
            {9017.0/3168, -355.0/33, 46732.0/5247, 49.0/176, -5103.0/18656},
            {35.0/384, 0, 500.0/1113, 125.0/192, -2187.0/6784, 11.0/84}
        };
        static const scalar E[7] =
        {
            71.0/57600, 0, -71.0/16695, 71.0/1920, -17253.0/339200, 22.0/525,
            -1.0/40
        };

        for (;;)
        {
            const scalar h = min(step, left);
            vector k[7];
            point end(x);
            bool inside = true;

            k[0] = u;
            for (int i = 1; i < 7 && inside; ++i)
            {
                end = x;
                for (int j = 0; j < i; ++j)
                {
                    end += h*A[i - 1][j]*k[j];
                }
                inside = slope(end, k[i]);
            }

            vector error(Zero);
            for (int i = 0; inside && i < 7; ++i)
            {
                error += h*E[i]*k[i];
            }

            const scalar e = inside ? mag(error)/tolerance : 1e3;
            step = h*min(max(0.9*Foam::pow(e + 1e-12, -0.2), 0.2), 5);

            if (e <= 1)
            {
                const auto location = flow_.locate(end, probe_);
                x = end;
                u = k[6];
                taken = h;
                return location == meshFlow::pInside;
            }
            if (step < 1e-12)
            {
                taken = left;
                return true;
            }
        }
    }
};


struct journey
{
    std::vector<char> passed;
    bool stayed;
    label nSamples;
};


journey follow
(
    tracer& t,
    const std::vector<rectangle>& throats,
    const scalar endTime,
    const scalar tolerance
)
{
    journey j{std::vector<char>(throats.size(), 0), true, 0};
    scalar time = 0;

    while (j.stayed && time < endTime)
    {
        const point before(t.x);
        scalar taken = 0;

        j.stayed = t.advance(endTime - time, tolerance, taken);
        time += taken;

        for (std::size_t i = 0; i < throats.size(); ++i)
        {
            const scalar y = throats[i].low.y();

            if (before.y() < y && t.x.y() >= y)
            {
                const scalar part = (y - before.y())/(t.x.y() - before.y());
                j.passed[i] |=
                    throats[i].covers(before + part*(t.x - before));
            }
        }
    }
    j.nSamples = t.nSamples;

    return j;
}


//- Note that a part of the inlet, and those about it, lead to throats
void mark
(
    std::vector<char>& matters,
    const label columns,
    const label rows,
    const label part,
    const bool leads
)
{
    const label i = part % columns;
    const label j = part/columns;

    for (label a = max(i - 1, 0); leads && a <= min(i + 1, columns - 1); ++a)
    {
        for (label b = max(j - 1, 0); b <= min(j + 1, rows - 1); ++b)
        {
            matters[b*columns + a] = 1;
        }
    }
}


//- Nine parts of each
std::vector<char> divided
(
    const std::vector<char>& matters,
    const label columns,
    const label rows
)
{
    std::vector<char> parts(9*columns*rows);

    for (label j = 0; j < 3*rows; ++j)
    {
        for (label i = 0; i < 3*columns; ++i)
        {
            parts[j*3*columns + i] = matters[(j/3)*columns + i/3];
        }
    }

    return parts;
}

//- Where the points of lattices go
struct survey
{
    const meshFlow& flow;
    const surfaceScalarField& phi;
    const rectangle& inlet;
    const std::vector<rectangle>& throats;
    const scalar endTime;
    const scalar tolerance;
    const label n;

    //- Print what passed each throat against the flux of the solver
    void report(const std::vector<scalar>& passed) const
    {
        scalar all = 0, want = 0;

        for (std::size_t i = 0; i < throats.size(); ++i)
        {
            const scalar through = fluxThrough(throats[i], phi);
            all += passed[i];
            want += through;
            Info<< "throat " << throats[i].name << ' ' << passed[i]/through
                << " of " << through << nl;
        }
        Info<< "all " << all/want << endl;
    }

    //- Follow a lattice over the parts of the inlet that matter, and tell which
    //  of them lead to throats
    std::vector<char> lattice
    (
        const std::vector<char>& matters,
        const label columns,
        const label rows
    ) const
    {
        std::vector<label> parts;
        for (label i = 0; i < rows*columns; ++i)
        {
            if (matters[i])
            {
                parts.push_back(i);
            }
        }
        if (parts.empty())
        {
            FatalErrorInFunction
                << "no point of the lattice before passes a throat: more points"
                << " (-number), or other throats in tracersDict"
                << exit(FatalError);
        }
        std::vector<char> next(rows*columns, 0);
        std::vector<scalar> passed(throats.size(), 0);
        scalar inflow = 0, still = 0, nSamples = 0;
        label count = 0;
        scalar clock = seconds();

        for (label k = 0; k < n; ++k)
        {
            // Roberts' sequence, over the parts one after another
            const label part = parts[label((k + 0.5)*parts.size()/n)];
            const scalar s =
                part % columns + std::fmod(0.5 + k*0.7548776662466927, 1.0);
            const scalar t =
                part/columns + std::fmod(0.5 + k*0.5698402909980532, 1.0);

            tracer one(flow, inlet.at(s/columns, t/rows));
            if (one.u.y() <= 0)
            {
                continue;
            }

            const scalar weight =
                one.u.y()*inlet.area()*parts.size()/(rows*columns)/n;
            const journey went(follow(one, throats, endTime, tolerance));
            inflow += weight;
            still += went.stayed*weight;
            nSamples += went.nSamples;
            ++count;

            bool any = false;
            for (std::size_t i = 0; i < throats.size(); ++i)
            {
                passed[i] += went.passed[i]*weight;
                any |= went.passed[i];
            }
            mark(next, columns, rows, part, any);
        }
        clock = seconds() - clock;

        Info<< count << " points over "
            << scalar(parts.size())/(rows*columns) << " of the inlet, "
            << inflow << " m3/s, " << 1e9*clock/nSamples << " ns and "
            << nSamples/count << " samples a point" << nl
            << "still inside " << still/inflow << nl;

        report(passed);

        return next;
    }

    //- Three lattices, each over nine times as many parts of the inlet
    void lattices(label columns) const
    {
        label rows = columns/10;
        std::vector<char> matters(rows*columns, 1);

        for (int level = 0; level < 3; ++level)
        {
            Info<< "lattice " << level << ": ";
            matters = lattice(matters, columns, rows);
            matters = divided(matters, columns, rows);
            columns *= 3;
            rows *= 3;
        }
    }
};

} // End namespace

static void addOptions()
{
    argList::addOption("interpolation", "name", "Scheme of the velocity");
    argList::addOption("number", "n", "Points of each lattice");
    argList::addOption("tolerance", "m", "Error of a step, 1e-11 by default");
    argList::addOption("known", "name", "A known velocity for U and phi");
    argList::addBoolOption("write", "Write the known velocity alone");
    argList::addBoolOption("check", "Look at the velocity alone");
    argList::addOption("columns", "n", "Columns of parts of the inlet");
}


int main(int argc, char *argv[])
{
    addOptions();

    #include "setRootCase.H"
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
    const word known(args.getOrDefault<word>("known", "none"));
    const knownVelocity exact(known, mesh.points());
    const volScalarField p(io("p"), mesh);
    volVectorField U(io("U"), mesh);
    surfaceScalarField phi
    (
        known == "none"
      ? surfaceScalarField(io("phi"), mesh)
      : surfaceScalarField("phi", fvc::interpolate(U) & mesh.Sf())
    );
    if (known != "none")
    {
        exact.set(U, phi);
    }
    if (args.found("write"))
    {
        return U.write() && phi.write() ? 0 : 1;
    }

    undecomposedFlow undecomposed(mesh);
    undecomposed.gather({U, p, phi});

    scalar clock = seconds();
    meshFlow flow
    (
        undecomposed,
        meshFlow::schemeNames
        [
            args.getOrDefault<word>("interpolation", "divergenceFree")
        ],
        labelHashSet(),
        nullptr,
        false,
        false
    );
    flow.renew(undecomposed, 997.5);
    Info<< "made in " << seconds() - clock << " s" << endl;
    checkVelocity(flow, phi);
    if (known != "none")
    {
        checkVelocity(flow, mesh, exact);
    }
    if (args.found("check"))
    {
        return 0;
    }

    const IOdictionary dict
    (
        IOobject("tracersDict", runTime.system(), mesh, IOobject::MUST_READ)
    );
    const rectangle inlet("inlet", dict.subDict("inlet"));
    const std::vector<rectangle> throats(rectangles(dict.subDict("throats")));

    const survey all
    {
        flow, phi, inlet, throats, dict.get<scalar>("endTime"),
        args.getOrDefault<scalar>("tolerance", 1e-11),
        args.getOrDefault<label>("number", 20000)
    };
    all.lattices(args.getOrDefault<label>("columns", 200));

    return 0;
}
