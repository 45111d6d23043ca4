/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/
#include "possibleInflow.H"
#include "fixedValueFvPatchFields.H"
#include "uniformFixedValueFvPatchField.H"
#include "inletFlux.H"
#include "volFields.H"

// * * * * * * * * * * * * * * * * Functions * * * * * * * * * * * * * * * * //

Foam::tmp<Foam::volVectorField> Foam::possibleInflow
(
    const volVectorField& U,
    const volScalarField& p
)
{
    const fvMesh& mesh = U.mesh();
    const labelList patches(inletFlux::openPatches(mesh.boundaryMesh()));

    // As the boundary conditions will have it
    volVectorField now(U.name() + "Inflow", U);
    now.correctBoundaryConditions();

    tmp<volVectorField> result
    (
        volVectorField::New
        (
            "possibleInflow", mesh, dimensionedVector(dimVelocity, Zero)
        )
    );
    volVectorField::Boundary& inflow = result.ref().boundaryFieldRef();

    // Do given velocities push fluid in, or draw it out?
    bool pushed = false;
    bool drawn = false;

    // Where the pressure is given, and whether it is just a value
    bool plain = true;
    DynamicList<label> atPressure(patches.size());

    for (const label patchi : patches)
    {
        const fvPatchVectorField& Up = now.boundaryField()[patchi];
        const fvPatchScalarField& pp = p.boundaryField()[patchi];

        if (isA<fixedValueFvPatchVectorField>(Up) && !pp.fixesValue())
        {
            const scalarField flux(Up & Up.patch().Sf());
            pushed = gMin(flux) < 0 || pushed;
            drawn = gMax(flux) > 0 || drawn;
            inflow[patchi] == Up;
        }
        else
        {
            atPressure.append(patchi);
            plain =
                plain
             && (
                    pp.type() == fixedValueFvPatchScalarField::typeName
                 || pp.type() == uniformFixedValueFvPatchField<scalar>::typeName
                );
            inflow[patchi] == -Up.patch().nf();
        }
    }

    if (plain && !drawn)
    {
        for (const label patchi : atPressure)
        {
            const scalar its = gMax(p.boundaryField()[patchi]);
            bool lowest = true;
            bool driven = pushed;

            for (const label otheri : atPressure)
            {
                if (otheri != patchi)
                {
                    const scalarField& other = p.boundaryField()[otheri];
                    lowest = gMin(other) >= its && lowest;
                    driven = gMax(other) > its || driven;
                }
            }

            if (lowest && driven)
            {
                inflow[patchi] == Zero;
            }
        }
    }

    return result;
}


// ************************************************************************* //
