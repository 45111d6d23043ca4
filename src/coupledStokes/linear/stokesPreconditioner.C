// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "stokesPreconditioner.H"
#include "PstreamReduceOps.H"

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::List<Foam::fourFloats> Foam::stokesPreconditioner::dominant
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

    List<fourFloats> diagonal(stokes.diagonal());
    forAll(diagonal, celli)
    {
        const fourFloats sum = fourOf(sums[celli]);
        fourFloats& d = diagonal[celli];
        d = d > sum ? d : sum;
    }

    return diagonal;
}


Foam::List<Foam::fourFloats> Foam::stokesPreconditioner::mobility() const
{
    // Enough for a few per cent, which is all that counts
    const label nSolutions = 2;

    const label n = stokes_.halo().nLocal();
    const faceCoefficients faces(stokes_.momentumFaces());
    UList<fourFloats>& residual = momentum_.source();

    List<fourFloats> m(stokes_.halo().size(), fourFloats{});
    for (label i = 0; i < nSolutions; ++i)
    {
        forAll(residual, celli)
        {
            residual[celli] =
                fourOf(stokes_.V()[celli]) - diagonal_[celli]*m[celli];
        }
        forAll(faces.owner, facei)
        {
            const label own = faces.owner[facei];
            const label nei = faces.neighbour[facei];

            residual[own] -= faces.upper[facei]*m[nei];
            if (nei < n)
            {
                residual[nei] -= faces.lower[facei]*m[own];
            }
        }
        const UList<fourFloats>& correction = momentum_.solve();
        forAll(residual, celli)
        {
            m[celli] += correction[celli];
        }
        stokes_.halo().exchange(m);
    }

    // Convection may leave a mesh cell with less than what it has if its
    // neighbours are at rest
    for (label celli = 0; celli < n; ++celli)
    {
        const fourFloats least = stokes_.V()[celli]/diagonal_[celli];
        m[celli] = m[celli] > least ? m[celli] : least;
    }
    stokes_.halo().exchange(m);

    return m;
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::stokesPreconditioner::stokesPreconditioner
(
    const stokesOperator& stokes,
    const UList<scalar>& distance,
    const bool fixedPressure
)
:
    stokes_(stokes),
    diagonal_(dominant(stokes)),
    momentum_(stokes.halo(), stokes.momentumFaces(), diagonal_, false, 2),
    pressure_(),
    laplacian_()
{
    List<float> diagonal;
    const faceCoefficients faces
    (
        stokes.laplacian(mobility(), distance, laplacian_, diagonal)
    );

    pressure_.reset
    (
        new aggregationMultigrid<float>
        (
            stokes.halo(), faces, diagonal, !fixedPressure, 1
        )
    );
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::stokesPreconditioner::precondition
(
    const List<fourFloats>& r,
    List<fourFloats>& z,
    List<fourFloats>& pressureForce
) const
{
    // By the volume of a mesh cell its part of the inverse: of the values tried
    // the one that takes the fewest iterations
    const float viscous = 0.7;

    UList<float>& continuity = pressure_->source();
    forAll(continuity, i)
    {
        continuity[i] = r[i][3];
    }
    const UList<float>& p = pressure_->solve();
    forAll(continuity, i)
    {
        z[i][3] = viscous/stokes_.V()[i]*r[i][3] + p[i];
    }
    stokes_.halo().exchange(z);

    stokes_.pressureForce(z, pressureForce);
    stokes_.halo().exchange(pressureForce);

    UList<fourFloats>& momentum = momentum_.source();
    forAll(momentum, i)
    {
        momentum[i] = r[i] - pressureForce[i];
        momentum[i][3] = 0;
    }
    const UList<fourFloats>& U = momentum_.solve();
    forAll(momentum, i)
    {
        const float pressure = z[i][3];
        z[i] = U[i];
        z[i][3] = pressure;
    }
    stokes_.halo().exchange(z);
}


Foam::faceValues Foam::stokesPreconditioner::conserving
(
    List<float> net,
    const scalar relTol
) const
{
    // Enough for any factor that single precision can have
    const label maxIterations = 40;

    const meshHalo& halo = stokes_.halo();
    const label n = halo.nLocal();
    const auto product = [n](const UList<float>& a, const UList<float>& b)
    {
        scalar sum = 0;
        for (label i = 0; i < n; ++i)
        {
            sum += scalar(a[i])*b[i];
        }
        return returnReduce(sum, sumOp<scalar>());
    };

    // Conjugate gradients; the sweeps of several ranks are not quite symmetric,
    // which the formula of Polak and Ribiere allows
    List<float>& r = net;
    List<float> p(halo.size(), 0.0f), d(p), Ld(n), change(n);
    const scalar start = product(r, r);
    scalar before = 1;

    for
    (
        label i = 0;
        i < maxIterations && product(r, r) > sqr(relTol)*start;
        ++i
    )
    {
        pressure_->source().deepCopy(r);
        const UList<float>& z = pressure_->solve();
        const scalar now = product(r, z);
        const float beta = i > 0 ? product(change, z)/before : 0;
        for (label celli = 0; celli < n; ++celli)
        {
            d[celli] = z[celli] + beta*d[celli];
        }
        halo.exchange(d);
        for (label celli = 0; celli < n; ++celli)
        {
            Ld[celli] = pressure_->product(celli, d);
        }
        const float alpha = now/product(d, Ld);
        for (label celli = 0; celli < n; ++celli)
        {
            p[celli] += alpha*d[celli];
            change[celli] = -alpha*Ld[celli];
            r[celli] += change[celli];
        }
        before = now;
    }
    halo.exchange(p);

    return stokes_.drivenFlux(p, laplacian_);
}
