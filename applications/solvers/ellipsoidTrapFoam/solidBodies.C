// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "solidBodies.H"
#include "calculatedFvPatchFields.H"
#include "fvcSurfaceIntegrate.H"
#include "polyMeshTetDecomposition.H"
#include "surfaceFields.H"

#include <cmath>

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- c and e of the header
    static const scalar interfaceFactor = 5;
    static const scalar leak = 1e-6;

    //- Points of a tetrahedron at which it is asked for inside or outside
    static const label nSamples = 64;

    //- Points evenly spread in a tetrahedron of unit edges along the axes: the
    //  additive recurrence of Roberts (2018) in the cube, its parts beyond the
    //  tetrahedron folded into it (Rocchini & Cignoni 2000)
    static List<vector> samplePoints()
    {
        // Powers of 1/g, g^4 = g + 1
        const scalar g = 1.2207440846057596;
        List<vector> points(nSamples);

        forAll(points, i)
        {
            vector v;
            for (direction d = 0; d < 3; ++d)
            {
                const scalar x = 0.5 + (i + 1)*std::pow(g, -(d + 1));
                v[d] = x - std::floor(x);
            }
            if (v.x() + v.y() > 1)
            {
                v = vector(1 - v.x(), 1 - v.y(), v.z());
            }
            if (v.y() + v.z() > 1)
            {
                v = vector(v.x(), 1 - v.z(), 1 - v.x() - v.y());
            }
            else if (v.x() + v.y() + v.z() > 1)
            {
                v = vector(1 - v.y() - v.z(), v.y(), v.x() + v.y() + v.z() - 1);
            }
            points[i] = v;
        }

        return points;
    }
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::scalar Foam::solidBodies::fraction
(
    const label celli,
    const heldBody& body
) const
{
    static const List<vector> points(samplePoints());

    scalar solid = 0;
    scalar volume = 0;

    for
    (
        const tetIndices& tet
      : polyMeshTetDecomposition::cellTetIndices(mesh_, celli)
    )
    {
        const tetPointRef t(tet.tet(mesh_));
        const scalar tetVolume = t.mag();
        label inside = 0;

        for (const vector& v : points)
        {
            inside += body.contains
            (
                t.a() + v.x()*(t.b() - t.a()) + v.y()*(t.c() - t.a())
              + v.z()*(t.d() - t.a())
            );
        }
        solid += tetVolume*inside/nSamples;
        volume += tetVolume;
    }

    return solid/volume;
}


Foam::solidBodies::part Foam::solidBodies::partOf(const heldBody& body) const
{
    DynamicList<label> cells;
    DynamicList<scalar> fractions;

    const pointField& points = mesh_.points();
    const scalar reach = cmptMax(body.semiAxes);

    forAll(mesh_.C(), celli)
    {
        const point& centre = mesh_.C()[celli];
        scalar size = 0;
        bool within = true;

        // A cube of the same volume is not as wide
        if
        (
            magSqr(centre - body.centre)
          > sqr(reach + 10*cbrt(mesh_.V()[celli]))
        )
        {
            continue;
        }
        for (const label pointi : mesh_.cellPoints()[celli])
        {
            size = max(size, mag(points[pointi] - centre));
            within = within && body.contains(points[pointi]);
        }

        const scalar f =
            within ? 1
          : mag(centre - body.centre) > reach + size ? 0
          : fraction(celli, body);

        if (f > 0)
        {
            cells.append(celli);
            fractions.append(f);
        }
    }

    return part{std::move(cells), std::move(fractions)};
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::solidBodies::solidBodies(const fvMesh& mesh, const dimensionedScalar& nu)
:
    mesh_(mesh),
    viscousRate_
    (
        nu.value()
       *fvc::surfaceSum(mesh.magSf()*mesh.deltaCoeffs())().primitiveField()
       /mesh.V()
    ),
    solid_(mesh.nCells(), Zero),
    resistance_
    (
        IOobject("resistance", mesh.time().timeName(), mesh),
        mesh,
        dimensionedScalar("zero", dimless/dimTime, Zero)
    )
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::solidBodies::set(const List<heldBody>& bodies)
{
    bodies_ = bodies;
    parts_.setSize(bodies.size());
    solid_ = 0;

    forAll(bodies_, i)
    {
        parts_[i] = partOf(bodies_[i]);
        forAll(parts_[i].cells, k)
        {
            solid_[parts_[i].cells[k]] += parts_[i].fractions[k];
        }
    }

    forAll(solid_, celli)
    {
        const scalar f = min(solid_[celli], scalar(1));
        resistance_[celli] =
            interfaceFactor*viscousRate_[celli]*f/(1 - f + leak);
    }
}


Foam::List<Foam::heldWrench> Foam::solidBodies::wrenches
(
    const volVectorField& U,
    const scalar density
) const
{
    List<heldWrench> sums(bodies_.size());

    forAll(bodies_, i)
    {
        heldWrench& sum = sums[i];
        sum.force = sum.torque = Zero;

        forAll(parts_[i].cells, k)
        {
            const label celli = parts_[i].cells[k];
            const scalar own = parts_[i].fractions[k]/solid_[celli];
            const vector force
            (
                own*density*resistance_[celli]*mesh_.V()[celli]*U[celli]
            );

            sum.force += force;
            sum.torque += (mesh_.C()[celli] - bodies_[i].centre) ^ force;
        }
        reduce(sum.force, sumOp<vector>());
        reduce(sum.torque, sumOp<vector>());
    }

    return sums;
}
