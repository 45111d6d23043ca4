// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

/*---------------------------------------------------------------------------*\
Description
    One iteration of SIMPLE or SIMPLEC of a coupledStokes flow.

\*---------------------------------------------------------------------------*/

#include "steadyCriterion.H"
#include "adjustPhi.H"
#include "constrainHbyA.H"
#include "constrainPressure.H"
#include "fvcDiv.H"
#include "fvcFlux.H"
#include "fvcGrad.H"
#include "fvcSnGrad.H"
#include "fvmLaplacian.H"
#include "fvMatrices.H"
#include "fvMesh.H"
#include "surfaceInterpolate.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{

// The solver performance of every solve within one time step is kept, and
// copied with each solve: a thousand iterations would come to seconds
static void forgetSolverPerformance(const fvMesh& mesh)
{
    #if OPENFOAM >= 2312
    const dictionary& dict = mesh.data().solverPerformanceDict();
    #else
    const dictionary& dict = mesh.solverPerformanceDict();
    #endif

    const_cast<dictionary&>(dict).clear();
}


// While it lives linear solvers say nothing: one line a second tells more
class silence
{
    const int before_ = SolverPerformance<scalar>::debug;

    static void set(const int debug)
    {
        SolverPerformance<scalar>::debug = debug;
        SolverPerformance<vector>::debug = debug;
    }

public:

    silence()
    {
        set(0);
    }

    ~silence()
    {
        set(before_);
    }
};

} // End namespace Foam


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::dictionary Foam::coupledStokes::linearSolver
(
    const word& fieldName,
    const bool judgeOnly
) const
{
    dictionary dict(U_.mesh().solverDict(fieldName));

    if (judgeOnly)
    {
        // Content with any start
        dict.clear();
        dict.set("solver", "PBiCGStab");
        dict.set("preconditioner", "none");
        dict.set("tolerance", GREAT);
        dict.set("relTol", 0);
        return dict;
    }

    // A solver that is content with its start leaves the flow untouched, which
    // would pass for steady
    dict.set("minIter", max(dict.getOrDefault<label>("minIter", 1), label(1)));

    return dict;
}


void Foam::coupledStokes::iterate
(
    const tmp<fvVectorMatrix>& equation,
    const bool judgeOnly
)
{
    const silence noSolverLines;
    fvVectorMatrix UEqn(equation);
    const volVectorField gradP(fvc::grad(p_));
    const steadyCriterion::forceRatios forces
    (
        criterion_->forces
        (
            (UEqn & U_)().primitiveField(), gradP.primitiveField()
        )
    );

    UEqn.relax();
    const SolverPerformance<vector> UPerf
    (
        Foam::solve(UEqn == -gradP, linearSolver(U_.name(), judgeOnly))
    );

    // Velocity without pressure gradient, and what a pressure gradient adds
    const volScalarField rAU(1/UEqn.A());
    volVectorField HbyA(constrainHbyA(rAU*UEqn.H(), U_, p_));
    surfaceScalarField phiHbyA("phiHbyA", fvc::flux(HbyA));
    adjustPhi(phiHbyA, U_, p_);

    volScalarField rAtU("rAtU", rAU);
    if (how_.consistent)
    {
        // The neighbours' velocities change with the mesh cell's own
        rAtU = 1/(1/rAU - UEqn.H1());
        phiHbyA +=
            fvc::interpolate(rAtU - rAU)*fvc::snGrad(p_)*U_.mesh().magSf();
        HbyA += (rAtU - rAU)*gradP;
    }

    constrainPressure(p_, U_, phiHbyA, rAtU);

    p_.storePrevIter();
    solverPerformance pPerf;
    for (label corr = 0; corr <= how_.nNonOrthogonalCorrectors; ++corr)
    {
        fvScalarMatrix pEqn
        (
            fvm::laplacian(rAtU, p_) == fvc::div(phiHbyA)
        );
        pEqn.setReference(how_.pRefCell, how_.pRefValue);

        const solverPerformance perf
        (
            pEqn.solve(linearSolver(p_.name(), judgeOnly))
        );
        if (corr == 0)
        {
            pPerf = perf;
        }
        if (corr == how_.nNonOrthogonalCorrectors && !judgeOnly)
        {
            phi_ = phiHbyA - pEqn.flux();
        }
    }
    if (!judgeOnly)
    {
        p_.relax();
        U_ = HbyA - rAtU*fvc::grad(p_);
        U_.correctBoundaryConditions();
    }
    criterion_->update(pPerf, UPerf, forces);
    forgetSolverPerformance(U_.mesh());
}
