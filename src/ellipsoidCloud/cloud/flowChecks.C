// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "flowChecks.H"
#include "checkedEntries.H"
#include "fvcFlux.H"
#include "fvcSurfaceIntegrate.H"
#include "masterGate.H"
#include "undecomposedFlow.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- End the run if a field is not of the dimensions that the solver has it in
    template<class Field>
    static void needDimensions
    (
        const Field& field,
        const dimensionSet& dimensions
    )
    {
        if (field.dimensions() != dimensions)
        {
            const masterGate once;
            FatalErrorInFunction
                << "The dimensions " << field.dimensions() << " of "
                << field.name() << " are not " << dimensions << nl
                << "    " << field.objectPath() << nl
                << "    Cells go in the incompressible flow of one liquid: p is"
                << " kinematic, Pa by kg/m3, and phi a flux of volume"
                << exit(FatalError);
        }
    }
}


// * * * * * * * * * * * * * * * Global Functions  * * * * * * * * * * * * * //

void Foam::checkDimensions(const solverFields& flow)
{
    needDimensions(flow.U, dimVelocity);
    needDimensions(flow.p, sqr(dimVelocity));
    needDimensions(flow.phi, dimVelocity*dimArea);
}


Foam::fluxErrors::fluxErrors(const solverFields& flow)
{
    const surfaceScalarField& phi = flow.phi;
    const scalarField left(fvc::surfaceIntegrate(phi)().primitiveField());
    const scalarField apart
    (
        fvc::surfaceSum(mag(phi - fvc::flux(flow.U)))().primitiveField()
    );
    const scalar through = gSum(fvc::surfaceSum(mag(phi))().primitiveField());

    net = gSum(mag(left)*phi.mesh().V())/(0.5*through + VSMALL);
    difference = gSum(apart)/(through + VSMALL);
}


void Foam::checkFluxDifference(const scalar difference, const fvMesh& mesh)
{
    const masterGate once;
    const scalar tolerance = checkedNumber
    (
        subDictOf(mesh.solutionDict(), "flow"), "fluxTolerance", above(0), 0.1
    );

    if (!(difference <= tolerance))
    {
        FatalErrorInFunction
            << "phi and U are not of one flow: they differ by "
            << shortText(difference) << ", above fluxTolerance "
            << shortText(tolerance) << " (dictionary flow of"
            << " system/fvSolution)" << exit(FatalError);
    }
}
