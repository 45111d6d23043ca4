/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/

#include "coupledFlow.H"
#include "fvcFlux.H"
#include "fvcGrad.H"
#include "fvcSnGrad.H"
#include "fvcSurfaceIntegrate.H"
#include "fvMatrices.H"
#include "fvMesh.H"
#include "masterGate.H"
#include "singlePrecision.H"
#include "stokesGMRES.H"
#include "surfaceInterpolate.H"

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::coupledFlow::setResidual
(
    const fvVectorMatrix& UEqn,
    const volScalarField& rAU,
    stokesVector& r
)
{
    const fvMesh& mesh = U_.mesh();
    const scalarField& V = mesh.V();

    const volVectorField gradP(fvc::grad(p_));
    const vectorField net
    (
        (UEqn & U_)().primitiveField() + gradP.primitiveField()
    );

    // As SIMPLE's HbyA where it has converged, and with its boundary values
    volVectorField velocity("HbyA", U_ + rAU*gradP);
    forAll(mesh.boundary(), patchi)
    {
        const fvPatch& patch = mesh.boundary()[patchi];
        if (!patch.coupled() && !polyPatch::constraintType(patch.type()))
        {
            const fvPatchVectorField& Up = U_.boundaryField()[patchi];
            fvPatchVectorField& values = velocity.boundaryFieldRef()[patchi];

            if (Up.assignable())
            {
                values == values.patchInternalField();
            }
            else
            {
                values == Up;
            }
        }
    }
    phi_ =
        fvc::flux(velocity)
      - fvc::interpolate(rAU)*fvc::snGrad(p_)*mesh.magSf();
    const volScalarField continuity(fvc::surfaceIntegrate(phi_));

    forAll(V, celli)
    {
        vector force(-V[celli]*net[celli]);
        for (direction cmpt = 0; cmpt < vector::nComponents; ++cmpt)
        {
            if (mesh.solutionD()[cmpt] == -1)
            {
                force[cmpt] = 0;
            }
        }
        r.U[celli] = single(force);
        r.p[celli] = -V[celli]*continuity[celli];
    }
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::coupledFlow::coupledFlow
(
    const dimensionedScalar& nu,
    volVectorField& U,
    volScalarField& p,
    surfaceScalarField& phi
)
:
    nu_(nu),
    U_(U),
    p_(p),
    phi_(phi)
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::coupledFlow::check(const fvMesh& mesh, const dictionary& dict)
{
    if (!cellHalo::handles(mesh))
    {
        const masterGate once;
        FatalIOErrorInFunction(dict)
            << "coupled yes does not deal with coupled patches other than"
            << " processor, and cyclic ones that do not turn vectors: set"
            << " coupled no" << exit(FatalIOError);
    }
}


Foam::label Foam::coupledFlow::correct
(
    const fvVectorMatrix& UEqn,
    const scalar relTol
)
{
    // What a correction may take; the next one goes on from there
    const label maxIterations = 80;

    fvVectorMatrix relaxed(UEqn);
    relaxed.relax();
    const volScalarField rAU(1/relaxed.A());

    const stokesOperator stokes(UEqn, rAU, nu_, U_, p_, phi_);
    const stokesPreconditioner preconditioner
    (
        stokes, nu_.value(), !p_.needReference()
    );
    stokesGMRES gmres(stokes, preconditioner, nu_.value());

    setResidual(UEqn, rAU, gmres.residual());
    const label n = gmres.solve(relTol, maxIterations);

    const stokesVector& found = gmres.correction();
    stokes.addFlux(found, gmres.pressureForce(), phi_);
    forAll(U_, celli)
    {
        U_[celli] += doubled(found.U[celli]);
        p_[celli] += found.p[celli];
    }
    U_.correctBoundaryConditions();
    p_.correctBoundaryConditions();

    return n;
}


// ************************************************************************* //
