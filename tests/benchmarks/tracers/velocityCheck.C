// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "velocityCheck.H"
#include "surfaceFields.H"
#include "tetDecomposition.H"
#include "volFields.H"
#include "wallPolyPatch.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{

//- Velocity and, unless null, its gradient at a position that a probe is near;
//  false outside
static bool sampleAt
(
    const meshFlow& flow,
    const point& x,
    meshFlow::probe& at,
    vector& u,
    tensor* gradient = nullptr
)
{
    tetCoordinates c;
    if (!flow.reach(x, at, c))
    {
        return false;
    }
    u = flow.velocity(0, c, gradient);
    return true;
}


//- The flux of a velocity that is cubic in triangles of a face (Strang and
//  Fix's formula of six points)
template<class Velocity>
static scalar fluxOf
(
    const tetDecomposition& decomposition,
    const label facei,
    const Velocity& velocity
)
{
    const scalar weights[2] = {0.109951743655322, 0.223381589678011};
    const scalar places[2] = {0.091576213509771, 0.445948490915965};
    scalar flux = 0;

    decomposition.forTriangles
    (
        facei,
        [&](const point& a, const point& b, const point& c)
        {
            const vector S(0.5*((b - a) ^ (c - a)));

            for (label k = 0; k < 6; ++k)
            {
                scalar l[3] = {places[k/3], places[k/3], places[k/3]};
                l[k % 3] = 1 - 2*places[k/3];
                flux +=
                    weights[k/3]*(velocity(l[0]*a + l[1]*b + l[2]*c) & S);
            }
        }
    );

    return flux;
}


//- Somewhere in a mesh cell, off its planes of symmetry
static point somewhere(const polyMesh& mesh, const label celli)
{
    const face& f = mesh.faces()[mesh.cells()[celli][celli % 4]];
    const point& c = mesh.cellCentres()[celli];

    return
        c + 0.31*(mesh.points()[f[0]] - c) + 0.22*(mesh.points()[f[1]] - c)
      + 0.07*(mesh.points()[f[2]] - c);
}


//- Call what is to be done at each triangle of no-slip walls with its middle
template<class Action>
static void atWalls(const fvMesh& mesh, const Action& action)
{
    for (const polyPatch& pp : mesh.boundaryMesh())
    {
        for (label i = 0; isA<wallPolyPatch>(pp) && i < pp.size(); ++i)
        {
            const label facei = pp.start() + i;
            const face& f = mesh.faces()[facei];
            const point& c = mesh.faceCentres()[facei];
            const point& owner = mesh.cellCentres()[pp.faceCells()[i]];

            forAll(f, k)
            {
                // Rounding may not take it through the wall
                const point x(0.7*c + 0.3*mesh.points()[f[k]]);
                action(owner, x + 1e-11*(owner - x), pp.faceAreas()[i]);
            }
        }
    }
}

}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::scalar Foam::knownVelocity::speed(const scalar y) const
{
    const auto parabola = [&](const scalar s) { return 4e-3*s*(1 - s); };

    return
        name == "shear" ? 100*(y - 0.3*height)
      : parabola(y/height) - (name == "slit" ? parabola(0.3) : 0);
}


Foam::tensor Foam::knownVelocity::gradient(const point& x) const
{
    return name == "linear"
      ? tensor(300, 700, -400, -250, 500, 600, 450, 350, -800)
      : name == "shear"
      ? 100*along*across
      : 4e-3/height*(1 - 2*(across & x)/height)*along*across;
}


Foam::vector Foam::knownVelocity::velocity(const point& x) const
{
    return name == "linear"
      ? vector(2e-3, -1e-3, 5e-4) + (gradient(x) & x)
      : speed(across & x)*along;
}


void Foam::knownVelocity::set
(
    volVectorField& U,
    surfaceScalarField& phi
) const
{
    const fvMesh& mesh = U.mesh();
    const tetDecomposition decomposition(mesh);
    const auto at = [&](const point& x) { return velocity(x); };

    forAll(U, celli)
    {
        U[celli] = velocity(mesh.cellCentres()[celli]);
    }
    forAll(phi, facei)
    {
        phi[facei] = fluxOf(decomposition, facei, at);
    }
    forAll(U.boundaryField(), patchi)
    {
        vectorField& Up = U.boundaryFieldRef()[patchi];
        scalarField& phip = phi.boundaryFieldRef()[patchi];
        const polyPatch& pp = mesh.boundaryMesh()[patchi];

        forAll(Up, i)
        {
            Up[i] = velocity(pp.faceCentres()[i]);
            phip[i] = fluxOf(decomposition, pp.start() + i, at);
        }
    }
}


// * * * * * * * * * * * * * * * Global Functions  * * * * * * * * * * * * * //

void Foam::checkVelocity
(
    const meshFlow& flow,
    const surfaceScalarField& phi
)
{
    const fvMesh& mesh = phi.mesh();
    const tetDecomposition decomposition(mesh);
    scalar divergence = 0, squares = 0, slope = 0, steepest = 0, fastest = 0;

    forAll(mesh.cells(), celli)
    {
        const point x(somewhere(mesh, celli));
        const scalar h = 1e-5*Foam::cbrt(mesh.cellVolumes()[celli]);
        meshFlow::probe at{0, -1};
        tensor gradient;
        tensor differences(Zero);
        vector u;

        if (!flow.find(x, at) || !sampleAt(flow, x, at, u, &gradient))
        {
            continue;
        }
        bool smooth = true;
        for (direction k = 0; k < 6; ++k)
        {
            vector v;
            tensor there;
            point y(x);
            y[k/2] += k % 2 ? h : -h;
            meshFlow::probe near(at);

            // Not over a kink
            smooth =
                smooth && sampleAt(flow, y, near, v, &there)
             && mag(there - gradient) < 1e-3*mag(gradient);

            for (direction i = 0; i < 3; ++i)
            {
                differences[3*i + k/2] += (k % 2 ? v[i] : -v[i])/(2*h);
            }
        }

        divergence += sqr(tr(gradient));
        squares += magSqr(gradient);
        steepest = max(steepest, mag(gradient));
        fastest = max(fastest, mag(u));
        slope = max(slope, smooth ? mag(gradient - differences) : 0);
    }

    scalar flux = 0, largest = 0;
    forAll(phi, facei)
    {
        meshFlow::probe at{0, -1};
        flow.find(somewhere(mesh, mesh.faceOwner()[facei]), at);

        const auto velocity =
            [&](const point& x)
            {
                vector u;
                u = flow.velocity(0, x, at, nullptr);
                return u;
            };
        const scalar through = fluxOf(decomposition, facei, velocity);
        flux = max(flux, mag(through - phi[facei]));
        largest = max(largest, mag(phi[facei]));
    }

    scalar wall = 0;
    const auto measure =
        [&](const point& inside, const point& x, const vector&)
        {
            meshFlow::probe at{0, -1};
            vector u;
            flow.find(inside, at);
            u = flow.velocity(0, x, at, nullptr);
            wall = max(wall, mag(u));
        };
    atWalls(mesh, measure);

    Info<< "flux " << flux/largest << nl
        << "divergence " << Foam::sqrt(divergence/squares) << nl
        << "slope " << slope/steepest << nl
        << "wall " << wall/fastest << nl
        << "fastest " << fastest << endl;
}


void Foam::checkVelocity
(
    const meshFlow& flow,
    const fvMesh& mesh,
    const knownVelocity& known
)
{
    scalar velocity = 0, fastest = 0;
    scalar gradient = 0, steepest = 0, wallGradient = 0;

    const auto errorOfGradient =
        [&](const point& x, meshFlow::probe at)
        {
            tetCoordinates c;
            flowSample sample;

            flow.reach(x, at, c);
            flow.sample(0, c, false, sample);
            const tensor G(known.gradient(x));
            steepest = max(steepest, mag(G));
            return mag(sample.gradient - G);
        };

    forAll(mesh.cells(), celli)
    {
        const point x(somewhere(mesh, celli));
        meshFlow::probe at{0, -1};
        vector u;

        if (flow.find(x, at) && sampleAt(flow, x, at, u))
        {
            fastest = max(fastest, mag(known.velocity(x)));
            velocity += magSqr(u - known.velocity(x))/mesh.nCells();
            gradient = max(gradient, errorOfGradient(x, at));
        }
    }

    const auto measure =
        [&](const point& inside, const point& x, const vector&)
        {
            meshFlow::probe at{0, -1};
            flow.find(inside, at);
            wallGradient = max(wallGradient, errorOfGradient(x, at));
        };
    atWalls(mesh, measure);

    Info<< "velocity " << Foam::sqrt(velocity)/fastest << nl
        << "gradient " << gradient/steepest << nl
        << "wallGradient " << wallGradient/steepest << endl;
}
