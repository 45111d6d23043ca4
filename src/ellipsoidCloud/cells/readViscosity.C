// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "readViscosity.H"
#include "checkedEntries.H"
#include "ellipsoidCore.H"
#include "masterGate.H"
#include "Time.H"

// * * * * * * * * * * * * * * * Global Functions  * * * * * * * * * * * * * //

Foam::dimensionedScalar Foam::readViscosity(const polyMesh& mesh)
{
    const IOdictionary dict
    (
        IOobject
        (
            "transportProperties",
            mesh.time().constant(),
            mesh,
            IOobject::MUST_READ,
            IOobject::NO_WRITE,
            false
        )
    );

    const masterGate once;

    checkValues(dict, {"transportModel", "nu"});
    const word model(dict.getOrDefault<word>("transportModel", "Newtonian"));

    if (model != "Newtonian")
    {
        FatalIOErrorInFunction(dict)
            << "transportModel " << model << " is not available: the fluid is"
            << " Newtonian" << exit(FatalIOError);
    }

    const ITstream& nuEntry = dict.lookup("nu");
    const bool isNumber = nuEntry.size() && nuEntry.last().isNumber();

    if (!isNumber || !(nuEntry.last().number() > 0))
    {
        refuseEntry(dict, "nu", "nu", "a positive number [m2/s]");
    }

    hasUnit(dict, "nu", "nu", "m2/s");

    const dimensionedScalar nu("nu", dimViscosity, dict);

    // The core knows what the cells can live with
    ellipsoid_options options(ellipsoid_options_default());
    options.kinematic_viscosity = nu.value();

    const char* range = nullptr;

    if (ellipsoid_options_check(&options, nullptr, &range) != ELLIPSOID_OK)
    {
        refuseEntry(dict, "nu", "nu", range);
    }

    // Liquids that carry cells have 3e-7 to 1e-4. Several read it: once is enough
    static bool reported = false;

    if (!reported && (nu.value() < 1e-7 || nu.value() > 1e-4))
    {
        reported = true;
        Warning
            << "nu " << shortText(nu.value()) << " m2/s of"
            << " transportProperties is not that of a liquid that carries"
            << " cells: water has 1e-6. It is kinematic, Pa s by kg/m3" << nl
            << endl;
    }

    return nu;
}
