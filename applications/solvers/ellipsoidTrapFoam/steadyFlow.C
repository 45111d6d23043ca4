/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/

#include "steadyFlow.H"
#include "checkedEntries.H"
#include "clockTime.H"
#include "coupledFlow.H"
#include "findRefCell.H"
#include "IOdictionary.H"
#include "fvMatrices.H"
#include "fvMesh.H"
#include "masterGate.H"
#include "readViscosity.H"
#include "sigFpe.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{

//- A dictionary that may be absent; collective
static dictionary readIfPresent
(
    const fvMesh& mesh,
    const word& name,
    const fileName& folder
)
{
    IOobject io
    (
        name, folder, mesh.time(), IOobject::MUST_READ, IOobject::NO_WRITE, false
    );

    if (!io.typeHeaderOk<IOdictionary>(true))
    {
        return dictionary();
    }
    return IOdictionary(io);
}


// A control; what is wrong with it is said once
static label wholeNumber
(
    const dictionary& dict,
    const word& keyword,
    const label least,
    const label deflt
)
{
    const masterGate once;
    return checkedNumber(dict, keyword, atLeast(least), deflt);
}

} // End namespace Foam


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::steadyFlow::checkControls() const
{
    const masterGate once;

    // What other solvers read there is in many a case
    const wordHashSet known
    ({
        "coupled", "consistent", "nNonOrthogonalCorrectors", "maxIterations",
        "residualControl", "fluxTolerance", "fluxWindow",
        "pRefCell", "pRefPoint", "pRefValue"
    });
    const wordHashSet knownElsewhere
    ({
        "momentumPredictor", "transonic", "frozenFlow", "nCorrectors",
        "nOuterCorrectors", "turbOnFinalIterOnly", "pMin", "pMax",
        "pMinFactor", "pMaxFactor", "rhoMin", "rhoMax"
    });

    wordHashSet unknown(controls_.toc());
    unknown -= known;
    unknown -= knownElsewhere;

    if (unknown.size())
    {
        FatalIOErrorInFunction(controls_)
            << "Unknown entries " << unknown.sortedToc() << nl
            << "Known are " << known.sortedToc() << exit(FatalIOError);
    }

    if
    (
        consistent_
     && !(
            mesh_.relaxEquation("U")
         && mesh_.equationRelaxationFactor("U") < 1
        )
    )
    {
        FatalIOErrorInFunction(mesh_.solutionDict())
            << "SIMPLEC needs a relaxation factor of the U equation below 1:"
            << " relaxationFactors { equations { U 0.9; } }"
            << exit(FatalIOError);
    }
}


void Foam::steadyFlow::checkModels() const
{
    for (const word& folder : {mesh_.time().constant(), mesh_.time().system()})
    {
        const dictionary sources(readIfPresent(mesh_, "fvOptions", folder));
        const masterGate once;

        if (sources.size())
        {
            FatalErrorInFunction
                << "The sources of " << folder << "/fvOptions are not solved"
                << " for. Solve the flow with a solver that does, and take it as"
                << " it is: -frozenFlow, or flow { solve no; } in"
                << " system/fvSolution" << exit(FatalError);
        }
    }

    const word constant(mesh_.time().constant());
    const dictionary turbulence
    (
        readIfPresent(mesh_, "turbulenceProperties", constant)
    );
    const word type
    (
        turbulence.getOrDefault<word>("simulationType", "laminar")
    );
    const dictionary motion(readIfPresent(mesh_, "dynamicMeshDict", constant));
    const word moving
    (
        motion.getOrDefault<word>("dynamicFvMesh", "staticFvMesh")
    );

    if (type != "laminar")
    {
        WarningInFunction
            << "The flow is solved without the " << type << " model of "
            << constant << "/turbulenceProperties: it is laminar" << nl << endl;
    }
    if (moving != "staticFvMesh")
    {
        WarningInFunction
            << "The mesh stands still: " << moving << " of " << constant
            << "/dynamicMeshDict is not read" << nl << endl;
    }
}


void Foam::steadyFlow::restore(const flow& kept)
{
    U_ == kept.U;
    p_ == kept.p;
    phi_ == kept.phi;
}


void Foam::steadyFlow::add
(
    const scalar part,
    const flow& one,
    const flow& other
)
{
    U_ == U_ + part*(one.U - other.U);
    p_ == p_ + part*(one.p - other.p);
    phi_ == phi_ + part*(one.phi - other.phi);
}


Foam::scalar Foam::steadyFlow::linearTolerance(const scalar before) const
{
    // Nothing is known before the first correction. What it leaves of the forces
    // is its convecting flux's fault
    if (!convergence_.sound() || convergence_.excess() <= SMALL)
    {
        return 3e-5;
    }

    // Not farther than the targets ask, with room for what is measured in
    // another way; nor than pays, of what the next convecting flux will change
    // again: a tenth of that
    const scalar ahead = 0.2/convergence_.excess();
    const scalar changing = 0.1*min(convergence_.excess()/before, scalar(1));

    return min(max(max(ahead, changing), scalar(1e-4)), scalar(0.3));
}


Foam::label Foam::steadyFlow::correct
(
    coupledFlow& together,
    const fvVectorMatrix& UEqn,
    const scalar relTol
)
{
    const sigFpe::ignore noTrap;

    const label n = together.correct(UEqn, relTol);
    if (p_.needReference())
    {
        const scalar shift = pRefValue_ - getRefCellValue(p_, pRefCell_);
        p_ += dimensionedScalar("shift", p_.dimensions(), shift);
    }

    return n;
}


Foam::autoPtr<Foam::coupledFlow> Foam::steadyFlow::begin(const bool scale)
{
    autoPtr<coupledFlow> together(new coupledFlow(nu_, U_, p_, phi_));

    const bool moves = gMax(mag(U_.primitiveField())()) > 0;
    together->setDirections();
    if (scale && moves)
    {
        together->scale([this] { return momentum(); });
        iterate(momentum(), true);
    }

    return together;
}


void Foam::steadyFlow::reportProgress(const label iteration) const
{
    Info<< "flow: iteration " << iteration << ": "
        << convergence_.measures().c_str();

    const inletFlux& through = convergence_.through();

    if (through.closed())
    {
        Info<< ", mean speed " << text(through.speed) << " m/s" << endl;
    }
    else
    {
        Info<< ", inflow " << text(through.inflow) << " m3/s" << endl;
    }
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::steadyFlow::steadyFlow(const fvMesh& mesh, const solveType solve)
:
    flowFields(mesh),
    solve_(solve),
    controls_(mesh.solutionDict().subDict("SIMPLE")),
    coupled_(controls_.getOrDefault("coupled", coupledFlow::handles(U_, p_))),
    consistent_(controls_.getOrDefault("consistent", true)),
    nNonOrthogonalCorrectors_
    (
        wholeNumber(controls_, "nNonOrthogonalCorrectors", 0, 0)
    ),
    maxIterations_(wholeNumber(controls_, "maxIterations", 1, 2000)),
    hasTransposed_
    (
        mesh.schemesDict().subOrEmptyDict("divSchemes").found(transposedScheme_)
    ),
    nu_(readViscosity(mesh)),
    pRefCell_(0),
    pRefValue_(0),
    convergence_(mesh, controls_, coupled_ ? 1 : 10)
{
    checkControls();
    if (coupled_)
    {
        coupledFlow::check(U_, p_, controls_);
    }

    setRefCell(p_, controls_, pRefCell_, pRefValue_);
    mesh_.setFluxRequired(p_.name());
    convergence_.restart(U_, phi_);

    // One line a second tells more than several in each iteration
    SolverPerformance<scalar>::debug = 0;
    SolverPerformance<vector>::debug = 0;
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

bool Foam::steadyFlow::converged()
{
    if (unfinished())
    {
        Info<< "flow: not all of it was written in " << instance_ << endl;
        return false;
    }

    const flow read(*this);
    iterate(momentum(), false);
    const bool arrived = convergence_.sound() && convergence_.reachedBefore();

    restore(read);

    if (arrived)
    {
        Info<< "flow: already converged (" << convergence_.measures().c_str()
            << "), not solved again: as stored in " << instance_ << endl;
    }
    convergence_.restart(U_, phi_);

    return arrived;
}


void Foam::steadyFlow::solveFrom(const flow& kept, const scalar tolerance)
{
    restore(kept);
    convergence_.begin(tolerance);
    solve(false);
}


void Foam::steadyFlow::refuseForeign() const
{
    if (foreign())
    {
        const masterGate once;
        FatalErrorInFunction
            << "The flow in " << instance_ << " is of another program, and not"
            << " steady by the measures of this one:" << nl
            << convergence_.shortcomings().c_str()
            << "-frozenFlow, or flow { solve no; } in system/fvSolution, takes"
            << " it as it is; flow { solve yes; } solves it again and keeps its"
            << " files as U.bak, p.bak and phi.bak" << exit(FatalError);
    }
}


Foam::autoPtr<Foam::flowFields> Foam::steadyFlow::New
(
    const fvMesh& mesh,
    const solveType solve
)
{
    return autoPtr<flowFields>
    (
        solve == NO ? new flowFields(mesh) : new steadyFlow(mesh, solve)
    );
}


bool Foam::steadyFlow::accept()
{
    if (solve_ == AUTO)
    {
        // A flux that was not there to be read is not steady
        if (hasFlux_ && converged())
        {
            return true;
        }
        refuseForeign();
    }
    checkModels();

    return false;
}


void Foam::steadyFlow::solve()
{
    solve(true);
}


void Foam::steadyFlow::solve(const bool scale)
{
    Info<< "flow: solved from that in " << instance_ << " by "
        << (coupled_ ? "corrections of U and p together, checked by " : "")
        << (consistent_ ? "SIMPLEC" : "SIMPLE") << endl;

    convergence_.restart(U_, phi_);
    const clockTime clock;
    scalar reported = -1;
    label iteration = 0;

    // Of the coupled method: iterations of GMRES, and how far the flow had been
    // from the targets before the latest correction
    autoPtr<coupledFlow> together;
    tmp<fvVectorMatrix> UEqn;
    if (coupled_)
    {
        // As in an iteration
        const sigFpe::ignore noTrap;
        together = begin(scale);
        UEqn = momentum();
    }
    label nLinear = 0;
    scalar before = GREAT;

    do
    {
        if (iteration == maxIterations_)
        {
            const masterGate once;
            FatalIOErrorInFunction(controls_)
                << "The flow is not steady after " << iteration
                << " iterations:" << nl
                << convergence_.shortcomings().c_str()
                << "Nothing was written. Raise maxIterations or the U entry of"
                << " relaxationFactors, or loosen residualControl or"
                << " fluxTolerance." << exit(FatalIOError);
        }

        if (coupled_)
        {
            const scalar relTol = linearTolerance(before);
            before = iteration > 0 ? convergence_.excess() : GREAT;
            const label n = correct(*together, UEqn(), relTol);
            nLinear = n < 0 ? n : nLinear + n;
            UEqn = momentum();
            iterate(tmp<fvVectorMatrix>(UEqn()), true);
        }
        else
        {
            iterate(momentum(), false);
        }
        ++iteration;

        if (nLinear < 0 || !convergence_.sound())
        {
            const masterGate once;
            FatalIOErrorInFunction(controls_)
                << "The flow diverges: iteration " << iteration << " left "
                << convergence_.measures().c_str() << ", mean speed "
                << text(convergence_.through().meanSpeed) << " m/s" << nl
                << "Nothing was written. Lower the relaxationFactors, or check"
                << " the boundary conditions and nu." << exit(FatalIOError);
        }

        // About a line a second
        if (clock.elapsedTime() > reported + 1)
        {
            reported = clock.elapsedTime();
            reportProgress(iteration);
        }
    } while (!convergence_.reached());

    reportProgress(iteration);
    Info<< "flow: converged in " << iteration << " iterations, ";
    if (coupled_)
    {
        Info<< nLinear << " of GMRES, ";
    }
    Info<< text(clock.elapsedTime()) << " s" << endl;
}


// ************************************************************************* //
