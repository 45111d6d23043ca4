/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/
#include "frozenFlow.H"
#include "inletFlux.H"
#include "wallPolyPatch.H"
#include "treeBoundBox.H"

#include <algorithm>
#include <cmath>

// * * * * * * * * * * * * * * Static Data Members * * * * * * * * * * * * * //

const Foam::Enum<Foam::frozenFlow::schemeType> Foam::frozenFlow::schemeNames
({
    { schemeType::stCellPoint, "cellPoint" },
    { schemeType::stCellPointQuadratic, "cellPointQuadratic" }
});


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::frozenFlow::barycentric
(
    const tetrahedron& tet,
    const scalar x[3],
    scalar coordinates[4],
    scalar gradients[4][3]
) const
{
    const scalar* origin = vertexRef(tet.vertices[0]).x;

    scalar e[3][3];
    for (int i = 0; i < 3; ++i)
    {
        const scalar* corner = vertexRef(tet.vertices[i + 1]).x;

        for (int d = 0; d < 3; ++d)
        {
            e[i][d] = corner[d] - origin[d];
        }
    }

    for (int i = 0; i < 3; ++i)
    {
        const scalar* a = e[(i + 1) % 3];
        const scalar* b = e[(i + 2) % 3];

        gradients[i + 1][0] = a[1]*b[2] - a[2]*b[1];
        gradients[i + 1][1] = a[2]*b[0] - a[0]*b[2];
        gradients[i + 1][2] = a[0]*b[1] - a[1]*b[0];
    }

    const scalar volume =
        e[0][0]*gradients[1][0]
      + e[0][1]*gradients[1][1]
      + e[0][2]*gradients[1][2];

    // A flat tetrahedron holds nothing, but the walk has to get through it
    const scalar inverseVolume = 1/(volume != 0 ? volume : 1e-40);

    coordinates[0] = 1;
    for (int d = 0; d < 3; ++d)
    {
        gradients[0][d] = 0;
    }

    for (int i = 1; i < 4; ++i)
    {
        coordinates[i] = 0;

        for (int d = 0; d < 3; ++d)
        {
            gradients[i][d] *= inverseVolume;
            gradients[0][d] -= gradients[i][d];
            coordinates[i] += gradients[i][d]*(x[d] - origin[d]);
        }

        coordinates[0] -= coordinates[i];
    }
}


Foam::frozenFlow::placeType Foam::frozenFlow::walk
(
    const scalar x[3],
    probe& at,
    scalar coordinates[4],
    scalar gradients[4][3]
) const
{
    // A coordinate this far below 0 is rounding, not another tetrahedron
    const scalar tolerance = 1e-10;
    const label maxTets = 10000;

    label previous = -1;

    for (label n = 0; n < maxTets; ++n)
    {
        const tetrahedron& tet = tetRef(at.tet);
        barycentric(tet, x, coordinates, gradients);

        // Leave by the face most exceeded that leads on; a patch only where
        // no face does, since the way round a corner may touch it. Nor go
        // straight back where tetrahedra overlap.
        int exit = -1;
        int patchExit = -1;

        for (int i = 0; i < 4; ++i)
        {
            if (coordinates[i] < -tolerance)
            {
                int& best = tet.neighbours[i] < 0 ? patchExit : exit;

                if
                (
                    (tet.neighbours[i] != previous || previous < 0)
                 && (best < 0 || coordinates[i] < coordinates[best])
                )
                {
                    best = i;
                }
            }
        }

        if (exit >= 0)
        {
            previous = at.tet;
            at.tet = tet.neighbours[exit];
        }
        else if (patchExit >= 0)
        {
            at.patch = -1 - tet.neighbours[patchExit];
            return patchPlace_[at.patch];
        }
        else
        {
            at.patch = -1;
            return pInside;
        }
    }

    at.patch = -1;
    return pBeyondWall;
}


void Foam::frozenFlow::interpolate
(
    const scalar* const values[4],
    const scalar coordinates[4],
    const scalar gradients[4][3],
    scalar value[3],
    scalar (*jacobian)[3]
)
{
    for (int i = 0; i < 3; ++i)
    {
        value[i] = 0;

        for (int a = 0; a < 4; ++a)
        {
            value[i] += coordinates[a]*values[a][i];
        }

        for (int j = 0; jacobian && j < 3; ++j)
        {
            jacobian[i][j] = 0;

            for (int a = 0; a < 4; ++a)
            {
                jacobian[i][j] += gradients[a][j]*values[a][i];
            }
        }
    }
}


void Foam::frozenFlow::interpolateVelocity
(
    const vertex* const v[4],
    const scalar coordinates[4],
    const scalar gradients[4][3],
    scalar velocity[3],
    scalar (*jacobian)[3]
) const
{
    const scalar* const u[4] = {v[0]->u, v[1]->u, v[2]->u, v[3]->u};

    interpolate(u, coordinates, gradients, velocity, jacobian);

    if (scheme_ != stCellPointQuadratic)
    {
        return;
    }

    for (int a = 0; a < 3; ++a)
    {
        for (int b = a + 1; b < 4; ++b)
        {
            const scalar weight = 0.5*coordinates[a]*coordinates[b];

            for (int i = 0; i < 3; ++i)
            {
                // Change of the slope along the edge from a to b
                scalar bend = 0;
                for (int j = 0; j < 3; ++j)
                {
                    bend +=
                        (v[a]->gradient[i][j] - v[b]->gradient[i][j])
                       *(v[b]->x[j] - v[a]->x[j]);
                }

                velocity[i] += weight*bend;

                for (int j = 0; jacobian && j < 3; ++j)
                {
                    jacobian[i][j] +=
                        0.5*bend
                       *(
                            gradients[a][j]*coordinates[b]
                          + coordinates[a]*gradients[b][j]
                        );
                }
            }
        }
    }
}


void Foam::frozenFlow::checkOpenPatches(const undecomposedFlow& whole) const
{
    const inletFlux through(whole.U(), whole.phi());

    forAll(through.patches(), i)
    {
        const polyPatch& pp =
            whole.mesh().boundaryMesh()[through.patches()[i]];

        if (pp.size() && through.isRounding(through.magFlux()[i]))
        {
            FatalErrorInFunction
                << "nothing flows through patch " << pp.name() << " of type "
                << pp.type() << nl
                << "    Cells would leave there. If it is a wall, make it one: "
                << "type wall in " << whole.mesh().meshDir()/"boundary"
                << exit(FatalError);
        }
    }
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::frozenFlow::frozenFlow
(
    const undecomposedFlow& whole,
    const scalar rho,
    const schemeType scheme,
    const autoPtr<volVectorField>& E
)
:
    scheme_(scheme)
{
    if (Pstream::master())
    {
        const undecomposedFlow::serialScope serial;

        const baffleSides baffles(whole.mesh());

        makeTets(whole.mesh(), baffles);
        makeVertices(whole, rho, baffles);

        if (E.valid())
        {
            makeFields(*E, baffles);
        }

        checkOpenPatches(whole);

        const polyBoundaryMesh& patches = whole.mesh().boundaryMesh();
        patchPlace_.setSize(patches.size());

        forAll(patches, patchi)
        {
            const polyPatch& pp = patches[patchi];

            patchPlace_[patchi] =
                isA<wallPolyPatch>(pp) ? pBeyondWall
              : polyPatch::constraintType(pp.type()) ? pBeyondCoupled
              : pBeyondOpen;
        }
    }

    Pstream::scatter(vertices_);
    Pstream::scatter(fields_);
    Pstream::scatter(tets_);
    Pstream::scatter(cellTets_);

    labelList places(patchPlace_.size());
    std::copy(patchPlace_.cbegin(), patchPlace_.cend(), places.begin());
    Pstream::scatter(places);
    patchPlace_.setSize(places.size());
    forAll(places, patchi)
    {
        patchPlace_[patchi] = placeType(places[patchi]);
    }

    centres_.setSize(cellTets_.size() - 1);
    forAll(centres_, celli)
    {
        const scalar* x = vertexRef(celli).x;
        centres_[celli] = point(x[0], x[1], x[2]);
    }

    const boundBox box(centres_, false);
    const vector margin(0.01*box.mag()*vector::one);

    centreTree_.reset
    (
        new indexedOctree<treeDataPoint>
        (
            treeDataPoint(centres_),
            treeBoundBox(box.min() - margin, box.max() + margin),
            10,
            10,
            3
        )
    );
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

bool Foam::frozenFlow::find(const point& x, probe& at) const
{
    const label celli = centreTree_->findNearest(x, sqr(GREAT)).index();

    // The nearest centre's cell is the one or a neighbour; a walk from it
    // that meets a wall may yet succeed from another of its tetrahedra
    for (label teti = cellTets_[celli]; teti < cellTets_[celli + 1]; ++teti)
    {
        at.tet = teti;

        if (place(x, at) == pInside)
        {
            return true;
        }
    }

    return false;
}


Foam::frozenFlow::placeType Foam::frozenFlow::place
(
    const point& x,
    probe& at
) const
{
    scalar coordinates[4];
    scalar gradients[4][3];

    return walk(x.v_, at, coordinates, gradients);
}


int Foam::frozenFlow::sample
(
    const scalar x[3],
    probe& at,
    const bool derivatives,
    ellipsoid_flow_sample& sample
) const
{
    scalar coordinates[4];
    scalar gradients[4][3];

    const placeType place = walk(x, at, coordinates, gradients);

    if (place == pBeyondWall || place == pBeyondCoupled)
    {
        return 1;
    }

    const tetrahedron& tet = tetRef(at.tet);
    const vertex* v[4];

    std::fill_n(&sample.gradient[0][0], 9, scalar(0));
    std::fill_n(sample.pressure_gradient, 3, scalar(0));

    for (int a = 0; a < 4; ++a)
    {
        v[a] = &vertexRef(tet.vertices[a]);

        for (int i = 0; i < 3; ++i)
        {
            sample.pressure_gradient[i] +=
                coordinates[a]*v[a]->pressureGradient[i];

            for (int j = 0; j < 3; ++j)
            {
                sample.gradient[i][j] += coordinates[a]*v[a]->gradient[i][j];
            }
        }
    }

    interpolateVelocity
    (
        v,
        coordinates,
        gradients,
        sample.velocity,
        derivatives ? sample.velocity_jacobian : nullptr
    );

    if (derivatives)
    {
        std::fill_n(&sample.pressure_jacobian[0][0], 9, scalar(0));
        std::fill_n(&sample.gradient_jacobian[0][0][0], 27, scalar(0));

        for (int a = 0; a < 4; ++a)
        {
            for (int i = 0; i < 3; ++i)
            {
                for (int k = 0; k < 3; ++k)
                {
                    sample.pressure_jacobian[i][k] +=
                        gradients[a][k]*v[a]->pressureGradient[i];

                    for (int j = 0; j < 3; ++j)
                    {
                        sample.gradient_jacobian[i][j][k] +=
                            gradients[a][k]*v[a]->gradient[i][j];
                    }
                }
            }
        }
    }

    return 0;
}


int Foam::frozenFlow::field
(
    const scalar x[3],
    probe& at,
    scalar field[3],
    scalar (*jacobian)[3]
) const
{
    scalar coordinates[4];
    scalar gradients[4][3];

    const placeType place = walk(x, at, coordinates, gradients);

    if (place == pBeyondWall || place == pBeyondCoupled)
    {
        return 1;
    }

    const scalar* E[4];

    for (int a = 0; a < 4; ++a)
    {
        E[a] = &fields_[3*tetRef(at.tet).vertices[a]];
    }

    interpolate(E, coordinates, gradients, field, jacobian);

    return 0;
}


void Foam::frozenFlow::velocity
(
    const scalar x[3],
    const probe& from,
    scalar velocity[3],
    scalar (*jacobian)[3]
) const
{
    probe at(from);
    scalar coordinates[4];
    scalar gradients[4][3];

    const placeType place = walk(x, at, coordinates, gradients);

    const tetrahedron& tet = tetRef(at.tet);
    const vertex* v[4];

    for (int a = 0; a < 4; ++a)
    {
        v[a] = &vertexRef(tet.vertices[a]);
    }

    if (place == pBeyondWall)
    {
        // Back to the face beyond which the position lies
        scalar sum = 0;

        for (int a = 0; a < 4; ++a)
        {
            coordinates[a] = max(coordinates[a], scalar(0));
            sum += coordinates[a];
            std::fill_n(gradients[a], 3, scalar(0));
        }
        for (int a = 0; a < 4; ++a)
        {
            coordinates[a] /= sum;
        }
    }

    interpolateVelocity(v, coordinates, gradients, velocity, jacobian);
}


// ************************************************************************* //
