// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

/*---------------------------------------------------------------------------*\
Application
    steadyHistories

Description
    What steadyCriterion says of given flows, residuals and forces: a square
    with an inlet, an outlet and walls, one mesh cell deep.

\*---------------------------------------------------------------------------*/

#include "argList.H"
#include "columnFvMesh.H"
#include "fixedValueFvPatchFields.H"
#include "fvMesh.H"
#include "sigFpe.H"
#include "steadyCriterion.H"
#include "surfaceFields.H"
#include "Time.H"
#include "volFields.H"

#include <limits>

using namespace Foam;

static void holds(const char* name, const bool does, const string& found)
{
    Info<< (does ? "holds: " : "WRONG: ") << name << nl;
    if (!does)
    {
        Info<< "    " << found.c_str() << nl;
    }
}


//- A flow and its judge
struct history
{
    volVectorField U;
    volScalarField p;
    surfaceScalarField phi;
    coupledStokes::settings how;
    autoPtr<steadyCriterion> criterion;
    vector UResidual = vector(1e-9, 1e-9, 0);
    scalar pResidual = 1e-9;
    steadyCriterion::forceRatios forces{1e-9, 1};

    history(const fvMesh& mesh, const label window = 1)
    :
        U
        (
            IOobject("U", mesh.time().timeName(), mesh),
            mesh,
            dimensionedVector(dimVelocity),
            fixedValueFvPatchVectorField::typeName
        ),
        p
        (
            IOobject("p", mesh.time().timeName(), mesh),
            mesh,
            dimensionedScalar(sqr(dimVelocity))
        ),
        phi
        (
            IOobject("phi", mesh.time().timeName(), mesh),
            mesh,
            dimensionedScalar(dimVolume/dimTime)
        )
    {
        for (fvPatchVectorField& Up : U.boundaryFieldRef())
        {
            Up == vector::zero;
        }
        how.pResidual = how.UResidual = how.fluxTolerance = 1e-4;
        how.fluxWindow = window;
        flow(1, 1, 1);
        criterion.reset(new steadyCriterion(U, p, phi, 2, how));
    }

    //- These fluxes, and fluid at one velocity; in between no flux, so that all
    //  of them are an error of continuity
    void flow(const scalar in, const scalar out, const scalar speed)
    {
        const auto set = [&](const word& name, const scalar flux)
        {
            const label patchi = phi.mesh().boundaryMesh().findPatchID(name);
            fvsPatchScalarField& of = phi.boundaryFieldRef()[patchi];
            of = flux/of.size();
        };
        set("inlet", -in);
        set("outlet", out);
        U.primitiveFieldRef() = vector(speed, 0, 0);
    }

    //- An iteration that leaves fluid at one speed, without fluxes
    void still(const scalar speed = 1)
    {
        flow(0, 0, speed);
        update();
    }

    void update()
    {
        solverPerformance p("", "p");
        p.initialResidual() = pResidual;
        SolverPerformance<vector> ofU("", "U");
        ofU.initialResidual() = UResidual;
        criterion->update(p, ofU, forces);
    }

    //- Is a measure in the line?
    bool says(const char* name, const scalar value) const
    {
        const string wanted(name + word::printf(" %.1e, ", value));
        return criterion->measures().find(wanted) != string::npos;
    }

    string found() const
    {
        return
            criterion->measures() + word::printf(", %g", criterion->excess());
    }
};


static void checkSeries(const fvMesh& mesh)
{
    // 1 + q^k: what is left is q/(1 - q) of the latest change
    bool left = true;
    string found;
    for (const scalar q : {0.3, 0.9})
    {
        history of(mesh);
        for (label k = 0; k < 4; ++k)
        {
            const scalar now = 1 + std::pow(q, k);
            of.flow(now, now, now);
            of.update();
        }
        const scalar last = std::pow(q, 2) - std::pow(q, 3);
        left = left
         && of.says
            (
                "flux change", last*max(q/(1 - q), scalar(1))/(1 + std::pow(q, 3))
            );
        found += of.found();
    }
    holds("the change to come is the rest of a geometric series", left, found);

    history of(mesh, 3);
    for (const scalar now : {1.0, 1.4, 1.4, 1.25, 1.32, 1.34, 1.3})
    {
        of.flow(now, now, now);
        of.update();
    }
    bool windows = of.says("flux change", 0.09/1.3);
    for (label i = 0; i < 3; ++i)
    {
        of.update();
    }
    windows = windows && of.says("flux change", 0);
    holds("ranges are those of a window", windows, of.found());

    // Changes that do not fall are taken for 1000 windows
    history weak(mesh);
    for (const scalar out : {1e-6, 1e-6, 2e-6})
    {
        weak.flow(2, out, 1);
        weak.update();
    }
    holds
    (
        "a flux that is nothing beside the inflow counts by the tolerance of it",
        weak.says("flux change", 1e-6*1000/(1e-4*2)),
        weak.found()
    );
}


static void checkMeasures(const fvMesh& mesh)
{
    history of(mesh);

    of.flow(2, 1, 1);
    of.update();
    const string line(of.criterion->measures());
    holds
    (
        "the inflow is that of the patches with more of it, continuity by it",
        line.find("inflow 2 m3/s") != string::npos
     && of.says("continuity", 1.5),
        of.found()
    );
    of.flow(1e-21, 1e-21, 1);
    of.update();
    const scalar crossing = std::pow(gSum(mesh.V().field()), 2.0/3);
    holds
    (
        "a flux that is rounding is none",
        of.criterion->measures().find("mean speed 1 m/s") != string::npos
     && of.says("continuity", 2e-21/crossing),
        of.found()
    );

    of.UResidual = vector(1e-9, 0.5, 0.6);
    of.flow(0, 0, 1);
    of.U.primitiveFieldRef() += vector(0, 0.9e-4, 0);
    of.update();
    bool counted = of.says("U", 1e-9);
    of.U.primitiveFieldRef() += vector(0, 0.2e-4, 0);
    of.update();
    counted = counted && of.says("U", 0.5);
    holds("components below the tolerance of U do not count", counted, of.found());

    of.pResidual = 0.5;
    of.forces.pressure = 0.9e-4;
    of.update();
    bool driven = of.says("p", 0);
    of.forces.pressure = 1.1e-4;
    of.update();
    driven = driven && of.says("p", 0.5);
    holds("nor does a pressure that drives nothing", driven, of.found());
}


static void checkForces(const fvMesh& mesh)
{
    history of(mesh);
    of.flow(0, 0, 1);

    // By the four sides, half a mesh cell from the fluid
    const scalar depth = 1e-6, nu = 2;
    const scalar n = std::sqrt(scalar(mesh.nCells()));
    const scalar shear = nu*(2*n)*4*depth;
    const scalar volume = gSum(mesh.V().field());
    const vectorField none(mesh.nCells(), Zero);
    const vectorField m(mesh.nCells(), vector(3e5, 4e5, 7e5));
    const auto free = of.criterion->forces(m, none);
    const auto driven = of.criterion->forces(none, m);
    const scalar pressure = mag(vector(3e5, 4e5, 7e5))*volume;

    holds
    (
        "forces are those in the plane of the mesh, by shear",
        mag(free.net/(5e5*volume/shear) - 1) < 1e-9 && free.pressure == 0,
        name(free.net*shear/volume)
    );
    holds
    (
        "and by the pressure's gradient",
        mag(driven.pressure*(pressure + shear)/pressure - 1) < 1e-9
     && mag(driven.net*(pressure + shear)/(5e5*volume) - 1) < 1e-9,
        name(driven.pressure)
    );
}


static void checkTargets(const fvMesh& mesh)
{
    history of(mesh);
    of.criterion->restart();
    of.still();
    bool twice = !of.criterion->reached();
    of.still();
    of.still();
    twice = twice && of.criterion->reached();
    holds("a flow has arrived after two windows at the earliest", twice, of.found());

    of.criterion->restart();
    of.still();
    holds("the past is forgotten", !of.criterion->reached(), of.found());

    // Each measure by itself is too large
    bool each = true;
    const auto alone = [&](const scalar excess)
    {
        of.criterion->restart();
        of.still(2);
        of.still(2);
        of.still(2);
        each = each && !of.criterion->reached()
         && mag(of.criterion->excess()/excess - 1) < 1e-9;
    };
    of.pResidual = 1.1e-4;
    alone(1.1);
    of.pResidual = 1e-9;
    of.UResidual.x() = 1.1e-4;
    alone(1.1);
    of.UResidual.x() = 1e-9;
    of.forces.net = 1.1e-4;
    alone(1.1);
    of.forces.net = 1e-9;
    for (label i = 0; i < 3; ++i)
    {
        of.flow(2, 2, 1);
        of.update();
    }
    each = each && mag(of.criterion->excess()/2e4 - 1) < 1e-9;
    holds("each measure can be too large", each, of.found());

    of.still(1);
    of.still(2);
    holds
    (
        "the change of fluxes is no measure of one iteration",
        mag(of.criterion->excess()/1e-5 - 1) < 1e-9
     && !of.criterion->reached(),
        of.found()
    );

    bool before = true;
    for (const scalar slack : {1.9, 2.1})
    {
        of.pResidual = slack*1e-4;
        of.criterion->restart();
        of.still(2);
        before = before && of.criterion->reachedBefore() == (slack < 2);
    }
    holds("one that had arrived is up to twice a target off", before, of.found());
    holds
    (
        "what misses its target is told",
        of.criterion->shortcomings() == "    p 2.10e-04, target 1.00e-04\n",
        of.criterion->shortcomings()
    );

    of.criterion->setTolerance(1e-6);
    bool anew = of.criterion->excess() == SMALL;
    of.pResidual = 5e-5;
    of.forces.pressure = 1e-5;
    of.still();
    anew = anew && mag(of.criterion->excess()/50 - 1) < 1e-9;
    holds("another tolerance is that of all, and of a new judgement", anew, of.found());
}


static void checkSound(const fvMesh& mesh)
{
    const sigFpe::ignore noTrap;
    history of(mesh);

    of.still(1e29);
    bool sound = of.criterion->sound();
    of.still(1e31);
    sound = sound && !of.criterion->sound();
    of.still();
    sound = sound && of.criterion->sound();
    of.pResidual = std::numeric_limits<scalar>::quiet_NaN();
    of.still();
    holds
    (
        "speeds that would overflow and what is no number are not sound",
        sound && !of.criterion->sound(),
        of.found()
    );
}


int main(int argc, char *argv[])
{
    #include "setRootCase.H"
    #include "createTime.H"
    #include "createMesh.H"

    checkSeries(mesh);
    checkMeasures(mesh);
    checkForces(mesh);
    checkTargets(mesh);
    checkSound(mesh);
    Info<< "End" << nl << endl;

    return 0;
}
