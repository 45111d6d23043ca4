/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/

#include "stokesPreconditioner.H"
#include "PstreamReduceOps.H"
#include "singlePrecision.H"

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::List<Foam::floatVector> Foam::stokesPreconditioner::dominant
(
    const stokesOperator& stokes
)
{
    const faceCoefficients faces(stokes.momentumFaces());

    List<float> sums(stokes.halo().size(), Zero);
    forAll(faces.owner, facei)
    {
        sums[faces.owner[facei]] += mag(faces.upper[facei]);
        sums[faces.neighbour[facei]] += mag(faces.lower[facei]);
    }

    List<floatVector> diagonal(stokes.diagonal());
    forAll(diagonal, celli)
    {
        diagonal[celli] =
            max
            (
                diagonal[celli],
                floatVector(sums[celli], sums[celli], sums[celli])
            );
    }

    return diagonal;
}


Foam::List<Foam::floatVector> Foam::stokesPreconditioner::mobility() const
{
    // Enough for a few per cent, which is all that counts
    const label nSolutions = 2;

    const label n = stokes_.halo().nCells();
    const faceCoefficients faces(stokes_.momentumFaces());
    UList<floatVector>& residual = momentum_.source();

    List<floatVector> m(stokes_.halo().size(), Zero);
    for (label i = 0; i < nSolutions; ++i)
    {
        forAll(residual, celli)
        {
            const float V = stokes_.V()[celli];
            residual[celli] = product(diagonal_[celli], -m[celli]);
            addProduct(V, floatVector::one, residual[celli]);
        }
        forAll(faces.owner, facei)
        {
            const label own = faces.owner[facei];
            const label nei = faces.neighbour[facei];

            addProduct(-faces.upper[facei], m[nei], residual[own]);
            if (nei < n)
            {
                addProduct(-faces.lower[facei], m[own], residual[nei]);
            }
        }
        const UList<floatVector>& correction = momentum_.solve();
        forAll(residual, celli)
        {
            addProduct(1, correction[celli], m[celli]);
        }
        stokes_.halo().exchange(m);
    }

    // Convection may leave a cell with less than what it has if its neighbours
    // are at rest
    for (label celli = 0; celli < n; ++celli)
    {
        const float V = stokes_.V()[celli];
        m[celli] =
            max(m[celli], cmptDivide(floatVector(V, V, V), diagonal_[celli]));
    }
    stokes_.halo().exchange(m);

    return m;
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::stokesPreconditioner::stokesPreconditioner
(
    const stokesOperator& stokes,
    const scalar nu,
    const bool fixedPressure
)
:
    stokes_(stokes),
    // Of the values tried the one that takes the fewest iterations
    viscous_(0.7*nu),
    diagonal_(dominant(stokes)),
    momentum_(stokes.halo(), stokes.momentumFaces(), diagonal_, false),
    pressure_()
{
    List<float> upper, diagonal;
    const faceCoefficients faces
    (
        stokes.laplacian(mobility(), upper, diagonal)
    );

    pressure_.reset
    (
        new aggregationMultigrid<float>
        (
            stokes.halo(), faces, diagonal, !fixedPressure
        )
    );
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::stokesPreconditioner::precondition
(
    const stokesVector& r,
    stokesVector& z,
    List<floatVector>& pressureForce
) const
{
    UList<float>& continuity = pressure_->source();
    forAll(continuity, i)
    {
        continuity[i] = r.p[i];
    }
    const UList<float>& p = pressure_->solve();
    forAll(continuity, i)
    {
        z.p[i] = viscous_/stokes_.V()[i]*r.p[i] + p[i];
    }

    stokes_.pressureForce(z.p, pressureForce);

    UList<floatVector>& momentum = momentum_.source();
    forAll(momentum, i)
    {
        momentum[i] = r.U[i] - pressureForce[i];
    }
    const UList<floatVector>& U = momentum_.solve();
    forAll(momentum, i)
    {
        z.U[i] = U[i];
    }
}


// ************************************************************************* //
