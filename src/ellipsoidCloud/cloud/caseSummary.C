// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "caseSummary.H"
#include "ellipsoidCloud.H"
#include "fvMesh.H"
#include "gaussGrad.H"
#include "inletFlux.H"
#include "narrowestGaps.H"
#include "surfaceFields.H"
#include "volFields.H"
#include "wallPolyPatch.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{

//- Metres in micrometres, three digits
static word um(const scalar length)
{
    return word::printf("%.3g", 1e6*length);
}


static string um(const vector& v)
{
    return um(v.x()) + " x " + um(v.y()) + " x " + um(v.z()) + " um";
}


//- The part of a cell's surface below which, along the normal, no bead is
static scalar bareSurface(const ellipsoid_options& options)
{
    double bead[ELLIPSOID_MAX_BEADS][3];
    const int nBeads = ellipsoid_beads(&options, bead);
    const vector semiAxes(pointOf(options.semi_axes));

    // A lattice of directions as even as can be
    const label nDirections = 4000;
    const scalar turn = constant::mathematical::pi*(1 + sqrt(5.0));

    scalar bare = 0;
    scalar whole = 0;

    for (label i = 0; i < nDirections; ++i)
    {
        const scalar z = 1 - (2*i + 1.0)/nDirections;
        const scalar c = sqrt(1 - z*z);
        const vector u(c*cos(i*turn), c*sin(i*turn), z);

        const vector point(cmptMultiply(semiAxes, u));
        const vector normal(cmptDivide(u, semiAxes));
        const scalar area = mag(normal);

        bool covered = false;
        for (int b = 0; b < nBeads && !covered; ++b)
        {
            const vector from(point - pointOf(bead[b]));
            covered = mag(from ^ normal) < options.bead_radius*area;
        }
        whole += area;
        bare += covered ? 0 : area;
    }

    return bare/whole;
}

} // End namespace Foam


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::ellipsoidCloud::reportCapture(const domainImages& images) const
{
    // With n the flux through a slit is 1 + 2/n^2 times as large
    const label fewest = 4;

    const fvMesh& mesh = undecomposed_->mesh();
    const labelList& sieves = criterion_.sieves();
    const List<narrowGap> gaps(narrowestGaps(mesh, images, sieves));
    const scalar width = 2*shortestSemiAxis(properties_.options());

    if (sieves.empty())
    {
        Warning
            << "capture names no sieves: no cell can be caught" << nl << endl;
    }
    forAll(sieves, i)
    {
        const word& name = mesh.boundaryMesh()[sieves[i]].name();
        const narrowGap& gap = gaps[i];

        if (gap.width >= GREAT)
        {
            continue;
        }
        Info<< "case: narrowest gap of " << name << ' ' << um(gap.width)
            << " um: " << gap.meshCells << " mesh cells across, "
            << word::printf("%.3g", gap.width/width)
            << " of a cell's width" << endl;

        if (gap.meshCells < fewest)
        {
            Warning
                << "The narrowest gap of " << name << ", at "
                << shortText(gap.at) << ", is only "
                << gap.meshCells << " mesh cells wide:"
                << " the flow through it is not resolved" << nl << endl;
        }
    }

    const scalar deltaT = mesh_.time().deltaTValue();
    const scalar holdTime = criterion_.holdTime();

    if (deltaT > holdTime)
    {
        Warning
            << "deltaT " << deltaT << " s is longer than holdTime " << holdTime
            << " s: cells are judged once a deltaT" << nl << endl;
    }
}


void Foam::ellipsoidCloud::reportFlow(const inletFlux& through) const
{
    const scalar slowSpeed = criterion_.slowSpeed();

    if (slowSpeed >= through.speed && through.speed > 0)
    {
        Warning
            << "capture: what is below " << slowSpeed << " m/s is slow, and"
            << " the mean inlet speed only " << through.speed << " m/s: cells"
            << " that move with the flow would be caught" << nl << endl;
    }
    if (through.closed())
    {
        return;
    }

    // Beyond, a steady laminar flow is not to be taken for granted
    const scalar largest = 100;

    const scalar area = through.inflow/through.speed;
    const scalar number =
        through.speed*sqrt(area)
       /properties_.options().kinematic_viscosity;

    Info<< "case: Reynolds number " << word::printf("%.3g", number) << " of the"
        << " inlets" << endl;

    if (number > largest)
    {
        Warning
            << "The Reynolds number is " << word::printf("%.3g", number)
            << ". The pressure p is kinematic: Pa by the density, m2/s2" << nl
            << endl;
    }
}


// * * * * * * * * * * * * * * * Global Functions  * * * * * * * * * * * * * //

void Foam::reportSize
(
    const label nMeshCells,
    const boundBox& bounds,
    const cellPopulation& population
)
{
    const vector span(bounds.span());
    const scalar width = 2*population.largest(shortestSemiAxis);
    const scalar length = 2*population.largest(longestSemiAxis);

    // A chip is smaller
    const scalar largest = 1;

    Info<< "case: mesh of " << nMeshCells << " cells, " << um(span).c_str()
        << endl;

    if (cmptMax(span) > largest)
    {
        Warning
            << "The mesh is " << cmptMax(span) << " m long. If it is in"
            << " micrometres: transformPoints -scale 1e-6" << nl << endl;
    }
    else if (cmptMin(span) < width)
    {
        FatalErrorInFunction
            << "A cell is " << um(width) << " um wide, the device only "
            << um(cmptMin(span)) << " um. Entries are in metres: semiAxes"
            << " (0.5e-6 2e-6 0.5e-6)" << exit(FatalError);
    }
    else if (cmptMin(span) < length)
    {
        Warning
            << "A cell is " << um(length) << " um long, the device only "
            << um(cmptMin(span)) << " um: is there room for it to enter?" << nl
            << endl;
    }

    const ellipsoid_options& options = population.properties().options();

    Info<< "case: cells of " << um(2*pointOf(options.semi_axes)).c_str()
        << " along their axes" << endl;

    const bool beads =
        options.contact && options.contact_shape == ELLIPSOID_CONTACT_BEADS;
    const scalar bare = beads ? bareSurface(options) : 0;

    // Of the default cell nothing is bare, up to 1.4 times its size
    if (bare > 0.1)
    {
        Warning
            << "The " << options.bead_count << " beads of contact leave "
            << word::printf("%.0f", 100*bare) << " % of a cell's surface bare,"
            << " where edges of walls come into it: contact { shape ellipsoid; }"
            << " has no gaps" << nl << endl;
    }

    const scalar ratio = options.density/options.fluid_density;

    // Of bubbles in a liquid or drops in a gas, but not of cells
    if (max(ratio, 1/ratio) > 100)
    {
        Warning
            << "cell/density " << options.density << " and fluid/density "
            << options.fluid_density << " differ by much: both are in kg/m3"
            << nl << endl;
    }
    if (options.brownian && options.temperature < 200)
    {
        Warning
            << "brownian/temperature " << options.temperature
            << " is that of no liquid: it is in K" << nl << endl;
    }
}


bool Foam::reportInertia
(
    const volVectorField& U,
    const ellipsoidProperties& properties,
    const scalar longest
)
{
    // By Gauss, as the case need not name a scheme for it
    const tmp<volTensorField> gradU
    (
        fv::gaussGrad<vector>::gradf(linearInterpolate(U)(), "gradU")
    );
    const scalar shear = sqrt(2.0)*gMax(mag(symm(gradU().primitiveField()))());
    const scalar number =
        shear*sqr(longest)/properties.options().kinematic_viscosity;

    const bool matters = number > 0.1;

    if (matters)
    {
        Warning
            << "The particle Reynolds number comes to "
            << word::printf("%.2g", number) << ", where the shear rate is "
            << word::printf("%.2g", shear) << " 1/s: above 0.1 the inertia of"
            << " the fluid, which the model of a cell does not have, turns and"
            << " shifts it" << nl << endl;
    }

    return matters;
}


void Foam::reportMovingWalls
(
    const volVectorField& U,
    const ellipsoidProperties& properties
)
{
    const ellipsoid_options& options = properties.options();

    if (!options.contact || !(options.friction > 0))
    {
        return;
    }
    for (const polyPatch& pp : U.mesh().boundaryMesh())
    {
        const fvPatchVectorField& Up = U.boundaryField()[pp.index()];

        if (isA<wallPolyPatch>(pp) && Up.fixesValue())
        {
            const scalar speed = gMax(mag(Up)());

            if (speed > 0)
            {
                Warning
                    << "contact/friction " << options.friction << " takes walls"
                    << " to be at rest, and U at " << pp.name() << " is up to "
                    << speed << " m/s: if this wall moves, it brakes the cells"
                    << " that it should carry. Without friction walls may move"
                    << nl << endl;
            }
        }
    }
}
