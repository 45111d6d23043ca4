// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "stokesOperator.H"
#include "polyMesh.H"

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::stokesOperator::interpolate
(
    const List<fourFloats>& x,
    const List<fourFloats>& pressureForce
) const
{
    // Of the force the fourth value is zero
    forAll(velocity_, celli)
    {
        velocity_[celli] = x[celli] + rByV_[celli]*pressureForce[celli];
    }
}


float Foam::stokesOperator::flux(const label facei) const
{
    const fourFloats& own = velocity_[owner_[facei]];
    const fourFloats& nei = velocity_[neighbour_[facei]];
    const float w = weight_[facei];

    return
        dot3(Sf_[facei], w*own + (1 - w)*nei)
      - pCoeff_[facei]*(nei[3] - own[3]);
}


float Foam::stokesOperator::boundaryFlux(const label facei) const
{
    const fourFloats& own = velocity_[boundaryCell_[facei]];
    const float through = -boundaryPCoeff_[facei]*own[3];

    return
        boundaryOpen_[facei]
      ? through + dot3(boundarySf_[facei], own)
      : through;
}


float Foam::stokesOperator::skewFlux
(
    const label i,
    const List<fourFloats>& pressureForce
) const
{
    const label facei = skewFaces_[i];
    const label own = owner_[facei];
    const label nei = neighbour_[facei];
    const float w = weight_[facei];

    return
       -skewrAU_[i]
       *dot3
        (
            skewSf_[i],
            w*byV_[own]*pressureForce[own]
          + (1 - w)*byV_[nei]*pressureForce[nei]
        );
}


void Foam::stokesOperator::addSkew
(
    const List<fourFloats>& x,
    const List<fourFloats>& pressureForce,
    List<fourFloats>& y
) const
{
    // The derivatives in each direction, times the volume
    forAll(gradCells_, i)
    {
        const label celli = gradCells_[i];
        const fourFloats own = gradOwn_[i];
        fourFloats dx = own[0]*x[celli];
        fourFloats dy = own[1]*x[celli];
        fourFloats dz = own[2]*x[celli];
        for (label k = gradStart_[i]; k < gradStart_[i + 1]; ++k)
        {
            const fourFloats weight = gradWeight_[k];
            const fourFloats other = x[gradCell_[k]];
            dx += weight[0]*other;
            dy += weight[1]*other;
            dz += weight[2]*other;
        }
        gradU_[celli] = {{dx, dy, dz}};
    }
    for (const label facei : gradFaces_)
    {
        const label celli = boundaryCell_[facei];
        const fourFloats velocity = boundaryU_[facei] & x[celli];

        for (int d = 0; d < 3; ++d)
        {
            gradU_[celli].column[d] += boundarySf_[facei][d]*velocity;
        }
    }
    halo_.exchange(gradU_);

    forAll(skewFaces_, i)
    {
        const label facei = skewFaces_[i];
        const label own = owner_[facei];
        const label nei = neighbour_[facei];
        const float wOwn = weight_[facei]*byV_[own];
        const float wNei = (1 - weight_[facei])*byV_[nei];

        fourFloats added{};
        for (int d = 0; d < 3; ++d)
        {
            added -=
                skewSf_[i][d]
               *(wOwn*gradU_[own].column[d] + wNei*gradU_[nei].column[d]);
        }
        added[3] = skewFlux(i, pressureForce);
        y[own] += added;
        y[nei] -= added;
    }
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::stokesOperator::stokesOperator(const polyMesh& mesh)
:
    halo_(mesh),
    skew_(false),
    velocity_(halo_.size())
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::faceCoefficients Foam::stokesOperator::laplacian
(
    const List<fourFloats>& mobility,
    const UList<scalar>& distance,
    faceValues& coefficients,
    List<float>& diagonal
) const
{
    List<float>& upper = coefficients.inner;
    List<float>& boundary = coefficients.boundary;

    upper.setSize(owner_.size());
    List<scalar> sums(halo_.size(), Zero);
    forAll(owner_, facei)
    {
        const label own = owner_[facei];
        const label nei = neighbour_[facei];
        const float w = weight_[facei];
        const fourFloats m = w*mobility[own] + (1 - w)*mobility[nei];
        const fourFloats& Sf = Sf_[facei];
        const scalar coefficient =
            dot3(m*Sf, Sf)/sqrt(dot3(Sf, Sf))*distance[facei];

        upper[facei] = -coefficient;
        sums[own] += coefficient;
        sums[nei] += coefficient;
    }
    boundary.setSize(boundaryCell_.size());
    forAll(boundaryCell_, facei)
    {
        // The gradient of a pressure that is fixed at the face
        const label celli = boundaryCell_[facei];
        const fourFloats& Sf = boundarySf_[facei];

        boundary[facei] =
           -boundaryPCoeff_[facei]/(rByV_[celli]*V_[celli])
           *(dot3(mobility[celli]*Sf, Sf)/dot3(Sf, Sf));
        sums[celli] += boundary[facei];
    }
    sums.setSize(halo_.nLocal());
    diagonal = single(sums);

    return {owner_, neighbour_, upper, upper};
}


Foam::faceValues Foam::stokesOperator::drivenFlux
(
    const List<float>& p,
    const faceValues& coefficients
) const
{
    faceValues through(coefficients);
    forAll(owner_, facei)
    {
        through.inner[facei] *= p[neighbour_[facei]] - p[owner_[facei]];
    }
    forAll(boundaryCell_, facei)
    {
        through.boundary[facei] *= p[boundaryCell_[facei]];
    }

    return through;
}


void Foam::stokesOperator::pressureForce
(
    const List<fourFloats>& x,
    List<fourFloats>& force
) const
{
    force = fourFloats{};

    forAll(owner_, facei)
    {
        const label own = owner_[facei];
        const label nei = neighbour_[facei];
        const float w = weight_[facei];
        const fourFloats part = (w*x[own][3] + (1 - w)*x[nei][3])*Sf_[facei];

        force[own] += part;
        force[nei] -= part;
    }
    forAll(boundaryCell_, facei)
    {
        const label celli = boundaryCell_[facei];
        force[celli] += boundaryP_[facei]*x[celli][3]*boundarySf_[facei];
    }
}


void Foam::stokesOperator::apply
(
    const List<fourFloats>& x,
    const List<fourFloats>& pressureForce,
    List<fourFloats>& y
) const
{
    interpolate(x, pressureForce);

    forAll(diagonal_, celli)
    {
        y[celli] = diagonal_[celli]*x[celli] + pressureForce[celli];
        y[celli][3] = 0;
    }
    for (label celli = halo_.nLocal(); celli < halo_.size(); ++celli)
    {
        y[celli] = fourFloats{};
    }
    forAll(owner_, facei)
    {
        const label own = owner_[facei];
        const label nei = neighbour_[facei];
        const float through = flux(facei);
        fourFloats ofOwn = upper_[facei]*x[nei];
        fourFloats ofNei = lower_[facei]*x[own];
        ofOwn[3] = through;
        ofNei[3] = -through;

        y[own] += ofOwn;
        y[nei] += ofNei;
    }
    forAll(boundaryCell_, facei)
    {
        y[boundaryCell_[facei]][3] += boundaryFlux(facei);
    }

    forAll(turnedFaces_, i)
    {
        const label celli = boundaryCell_[turnedFaces_[i]];
        y[celli] += turned_[i] & x[celli];
    }

    if (skew_)
    {
        addSkew(x, pressureForce, y);
    }
}


Foam::faceValues Foam::stokesOperator::flux
(
    const List<fourFloats>& x,
    const List<fourFloats>& pressureForce
) const
{
    interpolate(x, pressureForce);

    faceValues through
    {
        List<float>(owner_.size()), List<float>(boundaryCell_.size())
    };
    forAll(through.inner, facei)
    {
        through.inner[facei] = flux(facei);
    }
    forAll(skewFaces_, i)
    {
        through.inner[skewFaces_[i]] += skewFlux(i, pressureForce);
    }
    forAll(through.boundary, facei)
    {
        through.boundary[facei] = boundaryFlux(facei);
    }

    return through;
}
