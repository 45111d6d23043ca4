// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "steadyFlow.H"
#include "checkedEntries.H"
#include "clockDependence.H"
#include "fvcDiv.H"
#include "fvcGrad.H"
#include "fvmDiv.H"
#include "fvmLaplacian.H"
#include "fvmSup.H"
#include "fvMatrices.H"
#include "fvMesh.H"
#include "masterGate.H"
#include "readViscosity.H"
#include "Time.H"

// * * * * * * * * * * * * * * Static Data Members * * * * * * * * * * * * * //

const Foam::word Foam::steadyFlow::transposedScheme_
(
    "div((nuEff*dev2(T(grad(U)))))",
    false
);


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::steadyFlow::restore(const flow& kept)
{
    U_ == kept.U;
    p_ == kept.p;
    phi_ == kept.phi;
}


Foam::tmp<Foam::fvVectorMatrix> Foam::steadyFlow::momentum()
{
    tmp<fvVectorMatrix> UEqn(fvm::div(phi_, U_) - fvm::laplacian(nu_, U_));

    if (hasTransposed_)
    {
        UEqn.ref() -= fvc::div(nu_*dev2(T(fvc::grad(U_))), transposedScheme_);
    }
    const auto* resistance = mesh_.cfindObject<volScalarField>("resistance");
    if (resistance)
    {
        UEqn.ref() += fvm::Sp(*resistance, U_);
    }

    return UEqn;
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::steadyFlow::steadyFlow(const fvMesh& mesh, const solveType solve)
:
    flowFields(mesh),
    solve_(solve),
    controls_
    (
        mesh.solutionDict().found("SIMPLE")
      ? subDictOf(mesh.solutionDict(), "SIMPLE")
      : mesh.solutionDict().subDict("SIMPLE")
    ),
    hasTransposed_
    (
        mesh.schemesDict().subOrEmptyDict("divSchemes").found(transposedScheme_)
    ),
    nu_(readViscosity(mesh)),
    how_(readControls()),
    solver_(U_, p_, phi_, nu_, [this] { return momentum(); }, how_),
    clock_(mesh.time().value())
{
    // What reads the clock is as it was when the flow was solved
    readScalar(instance_, clock_);
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

bool Foam::steadyFlow::converged()
{
    if (unfinished())
    {
        Info<< "flow: not all of it was written in " << instance_ << endl;
        return false;
    }

    const clockAt then(mesh_.time(), clock_);
    const bool steady = solver_.isSteady();
    if (steady)
    {
        Info<< "flow: already converged (" << solver_.measures().c_str()
            << "), not solved again: as stored in " << instance_ << endl;
    }

    return steady;
}


void Foam::steadyFlow::solveFrom(const flow& kept, const scalar tolerance)
{
    restore(kept);
    solver_.setTolerance(tolerance);
    solve(false);
}


bool Foam::steadyFlow::accept()
{
    // What is added later would change a flow that is steady without it
    checkModels();
    if (solve_ == AUTO)
    {
        // A flux that was not there to be read is not steady
        if (hasFlux_ && converged())
        {
            reportClocks();
            return true;
        }
        if (foreign())
        {
            const masterGate once;
            FatalErrorInFunction
                << "The flow in " << instance_ << " is of another program, and"
                << " not steady by the measures of this one:" << nl
                << solver_.shortcomings().c_str()
                << "-frozenFlow, or flow { solve no; } in system/fvSolution,"
                << " takes it as it is; flow { solve yes; } solves it again and"
                << " keeps its files as U.bak, p.bak and phi.bak"
                << exit(FatalError);
        }
    }
    checkRegions();

    return false;
}


void Foam::steadyFlow::reportClocks() const
{
    reportClock(U_, clock_);
    reportClock(p_, clock_);
}


void Foam::steadyFlow::solve()
{
    clock_ = mesh_.time().value();
    reportClocks();
    solve(true);
}


void Foam::steadyFlow::solve(const bool scaled)
{
    Info<< "flow: solved from that in " << instance_ << " by "
        << (how_.coupled ? "corrections of U and p together, checked by " : "")
        << (how_.consistent ? "SIMPLEC" : "SIMPLE") << endl;
    if (!how_.coupled && !controls_.found("coupled"))
    {
        Info<< "flow: U and p are not corrected together, which does not deal"
            << " with " << coupledStokes::refusal(U_, p_).c_str() << endl;
    }

    const clockAt then(mesh_.time(), clock_);
    const coupledStokes::outcome end = solver_.solve(scaled);
    const masterGate once;

    if (end == coupledStokes::DIVERGED)
    {
        FatalIOErrorInFunction(controls_)
            << "The flow diverges: the last iteration left "
            << solver_.measures().c_str() << nl
            << "Nothing was written. Lower the relaxationFactors, or check"
            << " the boundary conditions and nu." << exit(FatalIOError);
    }
    if (end == coupledStokes::UNSTEADY)
    {
        FatalIOErrorInFunction(controls_)
            << "The flow is not steady after " << how_.maxIterations
            << " iterations:" << nl << solver_.shortcomings().c_str()
            << "Nothing was written. Raise maxIterations or the U entry of"
            << " relaxationFactors, or loosen residualControl or"
            << " fluxTolerance." << exit(FatalIOError);
    }
}
