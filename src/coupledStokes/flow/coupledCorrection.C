// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "coupledCorrection.H"
#include "fvcFlux.H"
#include "fvcGrad.H"
#include "fvcSnGrad.H"
#include "fvcSurfaceIntegrate.H"
#include "fvMatrices.H"
#include "fvMesh.H"
#include "meshTools.H"
#include "stokesGMRES.H"
#include "surfaceInterpolate.H"

#include <cmath>

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::tmp<Foam::surfaceScalarField> Foam::coupledCorrection::linearise
(
    const fvVectorMatrix& UEqn,
    List<fourFloats>& r
)
{
    const fvMesh& mesh = U_.mesh();
    const scalarField& V = mesh.V();
    const stokesUnits& units = stokes_.units();

    fvVectorMatrix relaxed(UEqn);
    relaxed.relax();
    const volScalarField rAU(1/relaxed.A());
    stokes_.set(UEqn, rAU, U_, p_, phi_);

    const volVectorField gradP(fvc::grad(p_));
    vectorField net((UEqn & U_)().primitiveField() + gradP.primitiveField());
    meshTools::constrainDirection(mesh, mesh.solutionD(), net);

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
    tmp<surfaceScalarField> flux
    (
        fvc::flux(velocity)
      - fvc::interpolate(rAU)*fvc::snGrad(p_)*mesh.magSf()
    );
    const volScalarField continuity(fvc::surfaceIntegrate(flux()));

    forAll(V, celli)
    {
        r[celli] = fourOf
        (
            -V[celli]*net[celli]/units.force,
            -V[celli]*continuity[celli]/units.flux
        );
    }

    return flux;
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::coupledCorrection::coupledCorrection
(
    volVectorField& U,
    volScalarField& p,
    surfaceScalarField& phi,
    const scalar nu
)
:
    U_(U),
    p_(p),
    phi_(phi),
    stokes_(p, nu),
    preconditioner_(),
    firstNorm_(0)
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::coupledCorrection::setDirections()
{
    if (gMax(mag(phi_)()) > 0)
    {
        return;
    }

    // Too short to convect anything
    const dimensionedScalar duration
    (
        "duration", dimTime, 1e-6*stokes_.units().mobility
    );
    phi_ = -duration*fvc::snGrad(p_)*U_.mesh().magSf();
    U_.correctBoundaryConditions();
}


void Foam::coupledCorrection::scale
(
    const std::function<tmp<fvVectorMatrix>()>& momentum
)
{
    const vectorField U(U_.primitiveField());
    const scalarField p(p_.primitiveField());
    const auto set = [&](const scalar ofU, const scalar ofP)
    {
        U_.primitiveFieldRef() = ofU*U;
        p_.primitiveFieldRef() = ofP*p;
        U_.correctBoundaryConditions();
        p_.correctBoundaryConditions();
    };

    // Of fluid at rest, of the velocity alone and of the pressure alone
    List<fourFloats> rest(U.size()), ofU(rest), ofP(rest);
    for (List<fourFloats>* r : {&rest, &ofU, &ofP})
    {
        set(r == &ofU, r == &ofP);
        linearise(momentum()(), *r);
    }
    forAll(rest, celli)
    {
        ofU[celli] -= rest[celli];
        ofP[celli] -= rest[celli];
    }

    const stokesGMRES gmres(stokes_);
    const scalar UU = gmres.inner(ofU, ofU), PP = gmres.inner(ofP, ofP);
    const scalar UP = gmres.inner(ofU, ofP);
    const scalar U0 = gmres.inner(ofU, rest), P0 = gmres.inner(ofP, rest);
    const scalar determinant = UU*PP - sqr(UP);

    if (determinant > 1e-6*UU*PP)
    {
        const scalar factor = (UP*P0 - PP*U0)/determinant;
        set(factor, (UP*U0 - UU*P0)/determinant);
        phi_ *= factor;
    }
    else
    {
        set(1, 1);
    }
}


Foam::label Foam::coupledCorrection::correct
(
    const fvVectorMatrix& UEqn,
    const scalar relTol
)
{
    // What a correction may take; the next one goes on from there
    const label maxIterations = 80;

    // Of the net fluxes that GMRES leaves: what drifts follows the flux
    const scalar toConserve = 0.01;

    // If what is left is this small a part, the equations are nearly the same
    const scalar negligible = 0.01;

    List<fourFloats> residual(U_.size());
    phi_ = linearise(UEqn, residual);
    stokesGMRES gmres(stokes_);

    const scalar norm = gmres.norm(residual);
    if (!std::isfinite(norm))
    {
        return -1;
    }
    if (!preconditioner_.valid() || norm > negligible*firstNorm_)
    {
        preconditioner_.clear();
        preconditioner_.reset
        (
            new stokesPreconditioner
            (
                stokes_, stokes_.distance(), !p_.needReference()
            )
        );
        firstNorm_ = norm;
    }
    const label n =
        gmres.solve(*preconditioner_, residual, relTol, maxIterations);

    const List<fourFloats>& found = gmres.correction();
    stokes_.addFlux(stokes_.flux(found, gmres.pressureForce()), phi_);
    const scalarField net
    (
        fvc::surfaceIntegrate(phi_)().primitiveField()*U_.mesh().V()
    );
    stokes_.addFlux
    (
        preconditioner_->conserving
        (
            single(scalarField(-net/stokes_.units().flux)), toConserve
        ),
        phi_
    );
    forAll(U_, celli)
    {
        U_[celli] += vectorOf(found[celli]);
        p_[celli] += stokes_.units().pressure*found[celli][3];
    }
    U_.correctBoundaryConditions();
    p_.correctBoundaryConditions();

    return n;
}
