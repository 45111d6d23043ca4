// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

/*---------------------------------------------------------------------------*\
Application
    porousFlow

Description
    A solver around libcoupledStokes, as another program would have it: the
    steady flow through a porous medium,

        div(U U) - nu laplacian(U) + k U = -grad(p)

\*---------------------------------------------------------------------------*/

#include "argList.H"
#include "columnFvMesh.H"
#include "coupledStokes.H"
#include "fvcFlux.H"
#include "fvcSurfaceIntegrate.H"
#include "fvmDiv.H"
#include "fvMesh.H"
#include "fvmLaplacian.H"
#include "fvmSup.H"
#include "surfaceFields.H"
#include "Time.H"
#include "volFields.H"

using namespace Foam;

int main(int argc, char *argv[])
{
    argList::addOption("resistance", "number", "k [1/s]");
    argList::addOption("maxIterations", "count", "Give up after so many");
    argList::addOption("again", "factor", "Begin again from its multiple");
    argList::addBoolOption("simplec", "By SIMPLEC");

    #include "setRootCase.H"
    #include "createTime.H"
    #include "createMesh.H"

    const auto stored = [&](const word& name)
    {
        return IOobject
        (
            name,
            runTime.timeName(),
            mesh,
            IOobject::MUST_READ,
            IOobject::AUTO_WRITE
        );
    };
    volVectorField U(stored("U"), mesh);
    volScalarField p(stored("p"), mesh);
    surfaceScalarField phi("phi", fvc::flux(U));

    const dimensionedScalar nu("nu", dimViscosity, 1e-6);
    const dimensionedScalar k
    (
        "k", dimless/dimTime, args.getOrDefault<scalar>("resistance", 0)
    );

    const string refusal(coupledStokes::refusal(U, p));
    if (!refusal.empty())
    {
        Info<< "not together: " << refusal.c_str() << endl;
    }

    coupledStokes::settings how;
    how.coupled = refusal.empty() && !args.found("simplec");
    how.maxIterations =
        args.getOrDefault<label>("maxIterations", how.maxIterations);
    how.pResidual = how.UResidual = how.fluxTolerance = 1e-8;

    const auto momentum = [&]
    {
        return fvm::div(phi, U) - fvm::laplacian(nu, U) + fvm::Sp(k, U);
    };
    coupledStokes flow(U, p, phi, nu, momentum, how);

    Info<< "steady: " << flow.isSteady() << endl;
    const coupledStokes::outcome end = flow.solve();
    const vectorField solvedU(U.primitiveField());
    const scalarField solvedP(p.primitiveField());
    const scalarField solvedPhi(phi.primitiveField());
    Info<< "outcome: " << end << nl << flow.shortcomings().c_str()
        << "steady: " << flow.isSteady() << nl
        << "left alone: "
        << returnReduce
           (
               solvedU == U.primitiveField() && solvedP == p.primitiveField()
            && solvedPhi == phi.primitiveField(),
               andOp<bool>()
           )
        << endl;

    const auto scale = [&](const scalar factor)
    {
        U *= factor;
        p *= factor;
        phi *= factor;
        U.correctBoundaryConditions();
        p.correctBoundaryConditions();
    };
    scale(2);
    Info<< "twice: " << flow.isSteady();
    scale(0.5);
    Info<< ' ' << flow.isSteady() << nl;

    const label outlet = mesh.boundaryMesh().findPatchID("outlet");
    Info<< "outflow: " << gSum(phi.boundaryField()[outlet]) << nl
        << "pressure: " << gAverage(p.primitiveField()) << nl;

    if (end != coupledStokes::DIVERGED)
    {
        const volScalarField net(fvc::surfaceIntegrate(phi));
        Info<< "net fluxes: "
            << gSum(mag(net.primitiveField()*mesh.V().field())) << nl;
    }

    if (args.found("again"))
    {
        scale(args.get<scalar>("again"));

        // What it begins from, and nothing else; and what is left to do then
        const label most = how.maxIterations;
        how.maxIterations = 0;
        coupledStokes(U, p, phi, nu, momentum, how).solve();
        Info<< "again: " << gSum(phi.boundaryField()[outlet]) << nl
            << "again pressure: " << gAverage(p.primitiveField()) << nl
            << "by U: "
            << gSum
               (
                   U.boundaryField()[outlet]
                 & mesh.Sf().boundaryField()[outlet]
               )
            << nl;
        how.maxIterations = most;
        for (label i = 0; i < 2; ++i)
        {
            coupledStokes(U, p, phi, nu, momentum, how).solve();
        }
    }
    Info<< "End" << nl << endl;

    return 0;
}
