/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/
#include "ellipsoidProperties.H"
#include "electricField.H"
#include "readViscosity.H"
#include "Switch.H"

#include <algorithm>

// * * * * * * * * * * * * * * Static Data Members * * * * * * * * * * * * * //

const Foam::Enum<ellipsoid_contact_shape>
Foam::ellipsoidProperties::shapeNames_
({
    { ELLIPSOID_CONTACT_BEADS, "beads" },
    { ELLIPSOID_CONTACT_ELLIPSOID, "ellipsoid" }
});


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
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::ellipsoidProperties::readOptions()
{
    options_.motion =
        motionNames_.getOrDefault("motion", *this, options_.motion);

    const dictionary& cell = section("cell");
    checkKeywords(cell, {"semiAxes", "density", "sizes"});
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
    if (electricField::isNamed(forces))
    {
        electricField::checkEntries(forces);

        const double* d = options_.dipole;
        if (options_.charge == 0 && d[0] == 0 && d[1] == 0 && d[2] == 0)
        {
            IOWarningInFunction(forces)
                << "a field is named in electricField, but charge and dipole"
                << " are 0: no cell will feel it" << endl;
        }
    }
    else
    {
        readVector(forces, "electricField", options_.electric_field);
    }

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
        contact,
        {
            "active", "cells", "shape", "beadLayout", "beads", "beadRadius",
            "modulus", "friction", "slipSpeed", "damping", "adhesion",
            "adhesionRange"
        }
    );
    options_.contact = contact.getOrDefault("active", Switch(options_.contact));
    pushing_ =
        contact.getOrDefault("cells", Switch(true)) && options_.contact;
    options_.contact_shape =
        shapeNames_.getOrDefault("shape", contact, options_.contact_shape);
    options_.bead_layout =
        layoutNames_.getOrDefault("beadLayout", contact, options_.bead_layout);
    options_.bead_count = contact.getOrDefault("beads", options_.bead_count);
    options_.bead_radius =
        contact.getOrDefault("beadRadius", options_.bead_radius);
    options_.contact_modulus =
        contact.getOrDefault("modulus", options_.contact_modulus);
    options_.friction = contact.getOrDefault("friction", options_.friction);
    options_.slip_speed =
        contact.getOrDefault("slipSpeed", options_.slip_speed);
    options_.contact_damping =
        contact.getOrDefault("damping", options_.contact_damping);
    options_.adhesion = contact.getOrDefault("adhesion", options_.adhesion);
    options_.adhesion_range =
        contact.getOrDefault("adhesionRange", options_.adhesion_range);

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


// ************************************************************************* //
