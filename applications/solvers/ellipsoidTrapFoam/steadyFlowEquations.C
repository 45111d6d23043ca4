/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

Description
    The equations of a steadyFlow, and one iteration of SIMPLE or SIMPLEC.

\*---------------------------------------------------------------------------*/

#include "steadyFlow.H"
#include "adjustPhi.H"
#include "constrainHbyA.H"
#include "constrainPressure.H"
#include "fvcDiv.H"
#include "fvcFlux.H"
#include "fvcGrad.H"
#include "fvcSnGrad.H"
#include "fvmDiv.H"
#include "fvmLaplacian.H"
#include "fvmSup.H"
#include "fvMatrices.H"
#include "fvMesh.H"
#include "sigFpe.H"
#include "surfaceInterpolate.H"

// * * * * * * * * * * * * * * Static Data Members * * * * * * * * * * * * * //

const Foam::word Foam::steadyFlow::transposedScheme_
(
    "div((nuEff*dev2(T(grad(U)))))",
    false
);


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

} // End namespace Foam


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::dictionary Foam::steadyFlow::linearSolver
(
    const word& fieldName,
    const bool judgeOnly
) const
{
    dictionary dict(mesh_.solverDict(fieldName));

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


Foam::tmp<Foam::fvVectorMatrix> Foam::steadyFlow::momentum()
{
    tmp<fvVectorMatrix> UEqn(fvm::div(phi_, U_) - fvm::laplacian(nu_, U_));

    if (hasTransposed_)
    {
        UEqn.ref() -= fvc::div(nu_*dev2(T(fvc::grad(U_))), transposedScheme_);
    }
    if (const auto* resistance = mesh_.cfindObject<volScalarField>("resistance"))
    {
        UEqn.ref() += fvm::Sp(*resistance, U_);
    }

    return UEqn;
}


Foam::flowConvergence::forceRatios Foam::steadyFlow::forces
(
    const fvVectorMatrix& UEqn,
    const volVectorField& gradP
) const
{
    vectorField net
    (
        (UEqn & U_)().primitiveField() + gradP.primitiveField()
    );
    for (direction cmpt = 0; cmpt < vector::nComponents; ++cmpt)
    {
        if (mesh_.solutionD()[cmpt] == -1)
        {
            net.replace(cmpt, scalar(0));
        }
    }

    scalar shear = 0;
    for (const fvPatchVectorField& Up : U_.boundaryField())
    {
        if (!Up.coupled())
        {
            shear += nu_.value()*sum(mag(Up.snGrad())*Up.patch().magSf());
        }
    }
    reduce(shear, sumOp<scalar>());

    const scalar pressure = gSum(mag(gradP.primitiveField())*mesh_.V());
    const scalar driving = pressure + shear + VSMALL;

    return {gSum(mag(net)*mesh_.V())/driving, pressure/driving};
}


void Foam::steadyFlow::iterate
(
    const tmp<fvVectorMatrix>& equation,
    const bool judgeOnly
)
{
    // A flow that diverges is reported as such, not by a signal
    const sigFpe::ignore noTrap;

    fvVectorMatrix UEqn(equation);
    const volVectorField gradP(fvc::grad(p_));
    const flowConvergence::forceRatios forcesFound(forces(UEqn, gradP));

    UEqn.relax();
    const SolverPerformance<vector> UPerf
    (
        Foam::solve(UEqn == -gradP, linearSolver("U", judgeOnly))
    );

    // Velocity without pressure gradient, and what a pressure gradient adds
    const volScalarField rAU(1/UEqn.A());
    volVectorField HbyA(constrainHbyA(rAU*UEqn.H(), U_, p_));
    surfaceScalarField phiHbyA("phiHbyA", fvc::flux(HbyA));
    adjustPhi(phiHbyA, U_, p_);

    volScalarField rAtU("rAtU", rAU);
    if (consistent_)
    {
        // The neighbours' velocities change with the cell's own
        rAtU = 1/(1/rAU - UEqn.H1());
        phiHbyA +=
            fvc::interpolate(rAtU - rAU)*fvc::snGrad(p_)*mesh_.magSf();
        HbyA += (rAtU - rAU)*gradP;
    }

    constrainPressure(p_, U_, phiHbyA, rAtU);

    p_.storePrevIter();
    solverPerformance pPerf;
    for (label corr = 0; corr <= nNonOrthogonalCorrectors_; ++corr)
    {
        fvScalarMatrix pEqn
        (
            fvm::laplacian(rAtU, p_) == fvc::div(phiHbyA)
        );
        pEqn.setReference(pRefCell_, pRefValue_);

        const solverPerformance perf(pEqn.solve(linearSolver("p", judgeOnly)));
        if (corr == 0)
        {
            pPerf = perf;
        }
        if (corr == nNonOrthogonalCorrectors_ && !judgeOnly)
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
    convergence_.update(pPerf, UPerf, forcesFound, U_, phi_);
    forgetSolverPerformance(mesh_);
}


// ************************************************************************* //
