/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/

#include "stokesOperator.H"
#include "fvMesh.H"
#include "singlePrecision.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{

// A matrix given by its columns times a vector
static inline floatVector product
(
    const FixedList<floatVector, 3>& columns,
    const floatVector& x
)
{
    floatVector sum(Zero);
    addProduct(x.x(), columns[0], sum);
    addProduct(x.y(), columns[1], sum);
    addProduct(x.z(), columns[2], sum);

    return sum;
}

} // End namespace Foam


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::List<Foam::floatVector> Foam::stokesOperator::interpolated
(
    const stokesVector& x,
    const List<floatVector>& pressureForce
) const
{
    List<floatVector> velocity(x.U);
    forAll(velocity, celli)
    {
        addProduct(rByV_[celli], pressureForce[celli], velocity[celli]);
    }

    return velocity;
}


float Foam::stokesOperator::flux
(
    const label facei,
    const List<floatVector>& velocity,
    const List<float>& p
) const
{
    const label own = owner_[facei];
    const label nei = neighbour_[facei];
    const float w = weight_[facei];

    return
        w*dot(Sf_[facei], velocity[own])
      + (1 - w)*dot(Sf_[facei], velocity[nei])
      - pCoeff_[facei]*(p[nei] - p[own]);
}


float Foam::stokesOperator::boundaryFlux
(
    const label facei,
    const List<floatVector>& velocity,
    const List<float>& p
) const
{
    const label celli = boundaryCell_[facei];
    const float through = -boundaryPCoeff_[facei]*p[celli];

    return
        boundaryOpen_[facei]
      ? through + dot(boundarySf_[facei], velocity[celli])
      : through;
}


float Foam::stokesOperator::skewFlux
(
    const label i,
    const List<floatVector>& pressureForce
) const
{
    const label facei = skewFaces_[i];
    const label own = owner_[facei];
    const label nei = neighbour_[facei];
    const float w = weight_[facei];

    return
       -skewrAU_[i]
       *(
            w*byV_[own]*dot(skewSf_[i], pressureForce[own])
          + (1 - w)*byV_[nei]*dot(skewSf_[i], pressureForce[nei])
        );
}


void Foam::stokesOperator::addSkew
(
    const stokesVector& x,
    const List<floatVector>& pressureForce,
    stokesVector& y
) const
{
    // The derivatives in each direction, times the volume
    List<columns> gradU(halo_.size(), columns(floatVector::zero));

    for (const label facei : gradFaces_)
    {
        const float w = weight_[facei];
        columns& own = gradU[owner_[facei]];
        columns& nei = gradU[neighbour_[facei]];
        floatVector velocity(Zero);
        addProduct(w, x.U[owner_[facei]], velocity);
        addProduct(1 - w, x.U[neighbour_[facei]], velocity);

        for (direction d = 0; d < 3; ++d)
        {
            addProduct(Sf_[facei][d], velocity, own[d]);
            addProduct(-Sf_[facei][d], velocity, nei[d]);
        }
    }
    forAll(boundaryCell_, facei)
    {
        const label celli = boundaryCell_[facei];
        const floatVector velocity(product(boundaryU_[facei], x.U[celli]));

        for (direction d = 0; d < 3; ++d)
        {
            addProduct(boundarySf_[facei][d], velocity, gradU[celli][d]);
        }
    }
    halo_.exchange(gradU);

    forAll(skewFaces_, i)
    {
        const label facei = skewFaces_[i];
        const label own = owner_[facei];
        const label nei = neighbour_[facei];
        const float wOwn = nu_*weight_[facei]*byV_[own];
        const float wNei = nu_*(1 - weight_[facei])*byV_[nei];

        floatVector stress(Zero);
        for (direction d = 0; d < 3; ++d)
        {
            addProduct(wOwn*skewSf_[i][d], gradU[own][d], stress);
            addProduct(wNei*skewSf_[i][d], gradU[nei][d], stress);
        }
        addProduct(-1, stress, y.U[own]);
        addProduct(1, stress, y.U[nei]);

        const float flux = skewFlux(i, pressureForce);
        y.p[own] += flux;
        y.p[nei] -= flux;
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::stokesOperator::pressureForce
(
    List<float>& p,
    List<floatVector>& force
) const
{
    halo_.exchange(p);
    force = Zero;

    forAll(owner_, facei)
    {
        const label own = owner_[facei];
        const label nei = neighbour_[facei];
        const float w = weight_[facei];
        const float pf = w*p[own] + (1 - w)*p[nei];

        addProduct(pf, Sf_[facei], force[own]);
        addProduct(-pf, Sf_[facei], force[nei]);
    }
    forAll(boundaryCell_, facei)
    {
        const label celli = boundaryCell_[facei];
        addProduct
        (
            boundaryP_[facei]*p[celli], boundarySf_[facei], force[celli]
        );
    }
}


void Foam::stokesOperator::exchange
(
    stokesVector& x,
    List<floatVector>& pressureForce
) const
{
    halo_.exchange(x.U);
    halo_.exchange(x.p);
    halo_.exchange(pressureForce);
}


void Foam::stokesOperator::apply
(
    const stokesVector& x,
    const List<floatVector>& pressureForce,
    stokesVector& y
) const
{
    const List<floatVector> velocity(interpolated(x, pressureForce));

    y.U = Zero;
    y.p = 0;
    forAll(diagonal_, celli)
    {
        y.U[celli] = product(diagonal_[celli], x.U[celli]);
        addProduct(1, pressureForce[celli], y.U[celli]);
    }
    forAll(owner_, facei)
    {
        const label own = owner_[facei];
        const label nei = neighbour_[facei];
        const float through = flux(facei, velocity, x.p);

        y.p[own] += through;
        y.p[nei] -= through;
        addProduct(upper_[facei], x.U[nei], y.U[own]);
        addProduct(lower_[facei], x.U[own], y.U[nei]);
    }
    forAll(boundaryCell_, facei)
    {
        y.p[boundaryCell_[facei]] += boundaryFlux(facei, velocity, x.p);
    }

    forAll(turnedFaces_, i)
    {
        const label celli = boundaryCell_[turnedFaces_[i]];
        addProduct(1, product(turned_[i], x.U[celli]), y.U[celli]);
    }

    if (skew_)
    {
        addSkew(x, pressureForce, y);
    }
}


void Foam::stokesOperator::addFlux
(
    const stokesVector& x,
    const List<floatVector>& pressureForce,
    surfaceScalarField& phi
) const
{
    const List<floatVector> velocity(interpolated(x, pressureForce));

    List<float> through(owner_.size());
    forAll(through, facei)
    {
        through[facei] = flux(facei, velocity, x.p);
    }
    forAll(skewFaces_, i)
    {
        through[skewFaces_[i]] += skewFlux(i, pressureForce);
    }

    label facei = 0;
    for (scalar& phif : phi.primitiveFieldRef())
    {
        phif += through[facei++];
    }
    forAll(mesh_.boundary(), patchi)
    {
        scalarField& phip = phi.boundaryFieldRef()[patchi];
        const label start = patchStart_[patchi];
        const bool coupled = mesh_.boundary()[patchi].coupled();

        forAll(phip, i)
        {
            phip[i] +=
                coupled
              ? through[facei++]
              : boundaryFlux(start + i, velocity, x.p);
        }
    }
}


// ************************************************************************* //
