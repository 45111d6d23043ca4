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
#include "stokesGMRES.H"
#include "surfaceInterpolate.H"

#include <cmath>

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{

// Does the velocity of the cells say what flows through?
static bool isOpen(const fvPatchVectorField& Up)
{
    return
        Up.assignable()
     && !Up.coupled()
     && !polyPatch::constraintType(Up.patch().type());
}

} // End namespace Foam


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::tmp<Foam::surfaceScalarField> Foam::coupledFlow::setResidual
(
    const fvVectorMatrix& UEqn,
    const volScalarField& rAU,
    List<fourFloats>& r
) const
{
    const fvMesh& mesh = U_.mesh();
    const scalarField& V = mesh.V();
    const stokesUnits& units = stokes_.units();

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
    tmp<surfaceScalarField> flux
    (
        fvc::flux(velocity)
      - fvc::interpolate(rAU)*fvc::snGrad(p_)*mesh.magSf()
    );
    const volScalarField continuity(fvc::surfaceIntegrate(flux()));

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
        r[celli] = fourOf
        (
            force/units.force(), -V[celli]*continuity[celli]/units.flux()
        );
    }

    return flux;
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
    phi_(phi),
    stokes_(U.mesh(), nu.value()),
    preconditioner_(),
    firstNorm_(0)
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

bool Foam::coupledFlow::handles(const volVectorField& U, const volScalarField& p)
{
    bool open = false;
    for (const fvPatchVectorField& Up : U.boundaryField())
    {
        open = open || isOpen(Up);
    }

    // Both collective
    const bool adjusted = p.needReference() && open;

    return cellHalo::handles(U.mesh()) && !adjusted;
}


void Foam::coupledFlow::check
(
    const volVectorField& U,
    const volScalarField& p,
    const dictionary& dict
)
{
    if (!handles(U, p))
    {
        const masterGate once;
        FatalIOErrorInFunction(dict)
            << "coupled yes does not deal with coupled patches other than"
            << " processor, and cyclic ones that do not turn vectors, nor with"
            << " an outflow that is adjusted to the inflow because no patch"
            << " fixes the pressure: set coupled no" << exit(FatalIOError);
    }
}


void Foam::coupledFlow::setDirections()
{
    if (gMax(mag(phi_)()) > 0)
    {
        return;
    }

    // Too short to convect anything
    const dimensionedScalar duration
    (
        "duration", dimTime, 1e-6*stokes_.units().mobility()
    );
    phi_ = -duration*fvc::snGrad(p_)*U_.mesh().magSf();
    U_.correctBoundaryConditions();
}


void Foam::coupledFlow::scale
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
        const tmp<fvVectorMatrix> UEqn(momentum());
        fvVectorMatrix relaxed(UEqn());
        relaxed.relax();
        const volScalarField rAU(1/relaxed.A());
        stokes_.set(UEqn(), rAU, U_, p_, phi_);
        setResidual(UEqn(), rAU, *r);
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

    stokes_.set(UEqn, rAU, U_, p_, phi_);
    List<fourFloats> residual(U_.size());
    phi_ = setResidual(UEqn, rAU, residual);
    stokesGMRES gmres(stokes_);

    // Of the net fluxes that GMRES leaves: cells follow the flux
    const scalar toConserve = 0.01;

    // If what is left is this small a part, the equations are nearly the same
    const scalar negligible = 0.01;

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
            new stokesPreconditioner(stokes_, !p_.needReference())
        );
        firstNorm_ = norm;
    }
    const label n =
        gmres.solve(*preconditioner_, residual, relTol, maxIterations);

    const List<fourFloats>& found = gmres.correction();
    stokes_.addFlux(found, gmres.pressureForce(), phi_);
    preconditioner_->conserve
    (
        fvc::surfaceIntegrate(phi_)().primitiveField()*U_.mesh().V(),
        toConserve,
        phi_
    );
    forAll(U_, celli)
    {
        U_[celli] += vectorOf(found[celli]);
        p_[celli] += stokes_.units().pressure()*found[celli][3];
    }
    U_.correctBoundaryConditions();
    p_.correctBoundaryConditions();

    return n;
}


// ************************************************************************* //
