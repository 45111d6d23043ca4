// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "flowOfField.H"
#include "masterGate.H"
#include "surfaceFields.H"
#include "volFields.H"

// * * * * * * * * * * * * * * Static Data Members * * * * * * * * * * * * * //

namespace Foam
{
    defineTypeNameAndDebug(flowOfField, 0);
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::flowOfField::flowOfField(const word& name, const fvMesh& mesh)
:
    GeometricMeshObject<fvMesh>(name, mesh),
    undecomposed_(mesh),
    flow_
    (
        undecomposed_,
        meshFlow::stDivergenceFree,
        labelHashSet(),
        autoPtr<volVectorField>(),
        false,
        false
    )
{}


const Foam::surfaceScalarField& Foam::flowOfField::fluxOf
(
    const volVectorField& U
)
{
    word name(U.name());
    name.replace("U", "phi");
    const surfaceScalarField* phi =
        name == U.name()
      ? nullptr
      : U.db().findObject<surfaceScalarField>(name);

    const masterGate once;
    if (U.dimensions() != dimVelocity)
    {
        FatalErrorInFunction
            << "interpolation divergenceFree: " << U.name() << " has the"
            << " dimensions " << U.dimensions() << ", not those of a velocity"
            << nl << "    Interpolate it by another scheme" << exit(FatalError);
    }
    if (!phi)
    {
        FatalErrorInFunction
            << "interpolation divergenceFree of " << U.name() << " needs the"
            << " flux of volume through the faces, " << name << ", beside it,"
            << " and there is none" << nl
            << "    It is that of the solver; postProcess reads it by -fields"
            << " '(" << U.name() << ' ' << name << ")'" << exit(FatalError);
    }
    if (phi->dimensions() != dimVelocity*dimArea)
    {
        FatalErrorInFunction
            << "interpolation divergenceFree of " << U.name() << ": "
            << name << " has the dimensions " << phi->dimensions()
            << ", not those of a flux of volume, " << dimVelocity*dimArea << nl
            << "    Interpolate by another scheme where the density is not"
            << " constant" << exit(FatalError);
    }
    return *phi;
}


// * * * * * * * * * * * * * * Static Functions * * * * * * * * * * * * * * * //

const Foam::flowOfField& Foam::flowOfField::New(const volVectorField& U)
{
    const surfaceScalarField& phi = fluxOf(U);
    const word name(typeName + '(' + U.name() + ')');

    flowOfField* kept = U.mesh().thisDb().getObjectPtr<flowOfField>(name);
    const bool isNew = !kept;
    if (isNew)
    {
        kept = new flowOfField(name, U.mesh());
        regIOobject::store(kept);
    }

    if (returnReduce(isNew || !kept->upToDate(U, phi), orOp<bool>()))
    {
        kept->undecomposed_.gather(U, phi);
        kept->flow_.renew(kept->undecomposed_, 1);
        kept->setUpToDate();
    }
    return *kept;
}
