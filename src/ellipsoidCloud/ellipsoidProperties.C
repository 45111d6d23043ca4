/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/
#include "ellipsoidProperties.H"
#include "cellTracks.H"
#include "masterFirst.H"
#include "readViscosity.H"
#include "StringStream.H"
#include "captureStatistics.H"
#include "cellInjection.H"
#include "dimensionedScalar.H"
#include "emptyPolyPatch.H"
#include "wedgePolyPatch.H"
#include "Time.H"
#include "Switch.H"

#include <algorithm>
#include <cmath>

// * * * * * * * * * * * * * * Static Data Members * * * * * * * * * * * * * //

const Foam::Enum<ellipsoid_bead_layout>
Foam::ellipsoidProperties::layoutNames_
({
    { ELLIPSOID_BEADS_STAGGERED, "staggered" },
    { ELLIPSOID_BEADS_PAPER, "paper" },
    { ELLIPSOID_BEADS_SURFACE, "surface" }
});


const Foam::Enum<ellipsoid_motion>
Foam::ellipsoidProperties::motionNames_
({
    { ELLIPSOID_MOTION_INERTIAL, "inertial" },
    { ELLIPSOID_MOTION_INERTIALESS, "inertialess" }
});


const Foam::Enum<ellipsoid_flow_at>
Foam::ellipsoidProperties::flowAtNames_
({
    { ELLIPSOID_FLOW_CENTRE, "centre" },
    { ELLIPSOID_FLOW_BODY, "body" }
});


const Foam::Enum<ellipsoid_wall_resistance>
Foam::ellipsoidProperties::wallResistanceNames_
({
    { ELLIPSOID_WALL_RESISTANCE_NONE, "none" },
    { ELLIPSOID_WALL_RESISTANCE_PLANE, "plane" }
});


const Foam::Enum<ellipsoid_pressure_gradient>
Foam::ellipsoidProperties::pressureGradientNames_
({
    { ELLIPSOID_PRESSURE_NONE, "none" },
    { ELLIPSOID_PRESSURE_DUDT, "DuDt" },
    { ELLIPSOID_PRESSURE_GRADP, "gradp" }
});


// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- Read a vector over its default
    static void readVector
    (
        const dictionary& dict,
        const word& keyword,
        double value[3]
    )
    {
        const vector v
        (
            dict.getOrDefault
            (
                keyword, vector(value[0], value[1], value[2])
            )
        );
        std::copy_n(v.v_, 3, value);
    }

    //- Where each option of the core stands in the dictionary
    static const struct { const char* field; const char* section; const char* entry; }
    optionEntries[] =
    {
        { "semi_axes", "cell", "semiAxes" },
        { "density", "cell", "density" },
        { "fluid_density", "fluid", "density" },
        { "drag", "forces", "drag" },
        { "flow_points", "forces", "flowPoints" },
        { "wall_resistance", "forces", "wallResistance" },
        { "lubrication_gap", "forces", "lubricationGap" },
        { "wall_range", "forces", "wallRange" },
        { "charge", "forces", "charge" },
        { "dipole", "forces", "dipole" },
        { "electric_field", "forces", "electricField" },
        { "gravity", "forces", "gravity" },
        { "external_force", "forces", "externalForce" },
        { "external_torque", "forces", "externalTorque" },
        { "brownian", "brownian", "active" },
        { "temperature", "brownian", "temperature" },
        { "noise_interval", "brownian", "interval" },
        { "bead_layout", "contact", "beadLayout" },
        { "bead_count", "contact", "beads" },
        { "bead_radius", "contact", "beadRadius" },
        { "contact_modulus", "contact", "modulus" },
        { "tolerance", "integration", "tolerance" },
        { "initial_step", "integration", "initialStep" },
        { "minimum_step", "integration", "minimumStep" },
        { "maximum_step", "integration", "maximumStep" },
        { "maximum_steps", "integration", "maximumSteps" }
    };
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::ellipsoidProperties::readOptions()
{
    options_.motion =
        motionNames_.getOrDefault("motion", *this, options_.motion);

    const dictionary& cell = section("cell");
    checkKeywords(cell, {"semiAxes", "density"});
    readVector(cell, "semiAxes", options_.semi_axes);
    options_.density = cell.getOrDefault("density", options_.density);

    const dictionary& fluid = section("fluid");
    checkKeywords(fluid, {"density"});
    options_.fluid_density =
        fluid.getOrDefault("density", options_.fluid_density);

    const dictionary& forces = section("forces");
    checkKeywords
    (
        forces,
        {
            "drag", "flow", "flowPoints", "wallResistance", "lubricationGap",
            "wallRange", "buoyancy", "pressureGradient", "gravity",
            "externalForce", "externalTorque", "charge", "dipole",
            "electricField"
        }
    );
    options_.drag = forces.getOrDefault("drag", Switch(options_.drag));
    options_.flow_at =
        flowAtNames_.getOrDefault("flow", forces, options_.flow_at);
    options_.flow_points =
        forces.getOrDefault("flowPoints", options_.flow_points);
    options_.wall_resistance =
        wallResistanceNames_.getOrDefault
        (
            "wallResistance", forces, options_.wall_resistance
        );
    options_.lubrication_gap =
        forces.getOrDefault("lubricationGap", options_.lubrication_gap);
    options_.wall_range =
        forces.getOrDefault("wallRange", options_.wall_range);
    options_.buoyancy =
        forces.getOrDefault("buoyancy", Switch(options_.buoyancy));
    options_.pressure_gradient =
        pressureGradientNames_.getOrDefault
        (
            "pressureGradient", forces, options_.pressure_gradient
        );
    readVector(forces, "gravity", options_.gravity);
    readVector(forces, "externalForce", options_.external_force);
    readVector(forces, "externalTorque", options_.external_torque);
    options_.charge = forces.getOrDefault("charge", options_.charge);
    readVector(forces, "dipole", options_.dipole);
    readVector(forces, "electricField", options_.electric_field);

    const dictionary& brownian = section("brownian");
    checkKeywords(brownian, {"active", "temperature", "interval"});
    options_.brownian =
        brownian.getOrDefault("active", Switch(options_.brownian));
    options_.temperature =
        brownian.getOrDefault("temperature", options_.temperature);
    options_.noise_interval =
        brownian.getOrDefault("interval", options_.noise_interval);

    const dictionary& contact = section("contact");
    checkKeywords
    (
        contact, {"active", "beadLayout", "beads", "beadRadius", "modulus"}
    );
    options_.contact = contact.getOrDefault("active", Switch(options_.contact));
    options_.bead_layout =
        layoutNames_.getOrDefault("beadLayout", contact, options_.bead_layout);
    options_.bead_count = contact.getOrDefault("beads", options_.bead_count);
    options_.bead_radius =
        contact.getOrDefault("beadRadius", options_.bead_radius);
    options_.contact_modulus =
        contact.getOrDefault("modulus", options_.contact_modulus);

    const dictionary& integration = section("integration");
    checkKeywords
    (
        integration,
        {
            "tolerance", "initialStep", "minimumStep", "maximumStep",
            "maximumSteps"
        }
    );
    options_.tolerance =
        integration.getOrDefault("tolerance", options_.tolerance);
    options_.initial_step =
        integration.getOrDefault("initialStep", options_.initial_step);
    options_.minimum_step =
        integration.getOrDefault("minimumStep", options_.minimum_step);
    options_.maximum_step =
        integration.getOrDefault("maximumStep", options_.maximum_step);
    options_.maximum_steps =
        integration.getOrDefault("maximumSteps", label(options_.maximum_steps));
}


void Foam::ellipsoidProperties::checkOptions() const
{
    const char* field = nullptr;
    const char* range = nullptr;

    if (ellipsoid_options_check(&options_, &field, &range) == ELLIPSOID_OK)
    {
        return;
    }

    for (const auto& known : optionEntries)
    {
        if (word(field) == known.field)
        {
            const dictionary& dict = section(known.section);

            if (dict.found(known.entry))
            {
                ITstream& is =
                    dict.lookupEntry(known.entry, keyType::LITERAL).stream();

                OStringStream value;
                value.precision(6);
                for (const token& t : static_cast<const tokenList&>(is))
                {
                    value << ' ' << t;
                }

                FatalIOErrorInFunction(is)
                    << known.section << '/' << known.entry
                    << value.str().c_str() << " is out of range" << nl
                    << "    allowed: " << range
                    << exit(FatalIOError);
            }
        }
    }

    FatalIOErrorInFunction(*this)
        << field << " is out of range" << nl << "    allowed: " << range
        << exit(FatalIOError);
}


void Foam::ellipsoidProperties::checkPatches
(
    const polyBoundaryMesh& patches
) const
{
    for (const polyPatch& pp : patches)
    {
        if (isA<emptyPolyPatch>(pp) || isA<wedgePolyPatch>(pp))
        {
            FatalErrorInFunction
                << "patch " << pp.name() << " of "
                << patches.mesh().meshDir()/"boundary"
                << " is of type " << pp.type() << nl
                << "    A cell is a body in three dimensions: its mesh has "
                << "walls (type wall), open ends (type patch), and patches it "
                << "must not reach (cyclic, symmetry)"
                << exit(FatalError);
        }
    }

    const dictionary& injections = subDict("injection");

    for (const entry& e : injections)
    {
        if (!e.isDict())
        {
            FatalIOErrorInFunction(injections)
                << e.keyword() << " is not a dictionary of an injection"
                << exit(FatalIOError);
        }

        cellInjection::checkEntries(e.dict());

        if (e.dict().found("patch"))
        {
            cellInjection::findPatch(e.dict(), patches);
        }
    }

    captureStatistics::setting(section("capture"), patches);
    cellTracks::setting(section("tracks"));
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::ellipsoidProperties::ellipsoidProperties(const polyMesh& mesh)
:
    IOdictionary
    (
        IOobject
        (
            "ellipsoidCloudProperties",
            mesh.time().constant(),
            mesh,
            IOobject::MUST_READ,
            IOobject::NO_WRITE
        )
    ),
    options_(ellipsoid_options_default()),
    scheme_(frozenFlow::stCellPoint),
    seed_(1),
    empty_()
{
    options_.kinematic_viscosity = readViscosity(mesh).value();

    // No reading of files, for which ranks would have to meet, from here on
    const masterFirst once;

    scheme_ =
        frozenFlow::schemeNames.getOrDefault("interpolation", *this, scheme_);
    seed_ = getOrDefault<label>("seed", seed_);

    checkKeywords
    (
        *this,
        {
            "interpolation", "seed", "motion", "cell", "fluid", "forces",
            "brownian", "contact",
            "integration", "injection", "capture", "tracks"
        }
    );

    readOptions();
    checkOptions();
    checkPatches(mesh.boundaryMesh());
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::ellipsoidProperties::checkKeywords
(
    const dictionary& dict,
    const wordList& allowed
)
{
    for (const entry& e : dict)
    {
        if (!allowed.found(e.keyword()))
        {
            FatalIOErrorInFunction(dict)
                << "unknown keyword " << e.keyword();

            if (e.startLineNumber() > 0)
            {
                FatalIOError<< " (line " << e.startLineNumber() << ")";
            }

            FatalIOError<< nl
                << "    allowed: " << flatOutput(allowed)
                << exit(FatalIOError);
        }
    }
}


Foam::scalar Foam::ellipsoidProperties::getAbove
(
    const dictionary& dict,
    const word& keyword,
    const scalar bound
)
{
    const scalar value = dict.get<scalar>(keyword);

    if (!(value > bound && value < VGREAT))
    {
        FatalIOErrorInFunction
        (
            dict.lookupEntry(keyword, keyType::LITERAL).stream()
        )   << keyword << ' ' << value << " is out of range" << nl
            << "    allowed: above " << bound
            << exit(FatalIOError);
    }

    return value;
}


Foam::scalar Foam::ellipsoidProperties::getAboveOrDefault
(
    const dictionary& dict,
    const word& keyword,
    const scalar bound,
    const scalar deflt
)
{
    return dict.found(keyword) ? getAbove(dict, keyword, bound) : deflt;
}


// ************************************************************************* //
