// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "stokesGMRES.H"
#include "PstreamReduceOps.H"
#include "sumOfFields.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{

typedef List<List<fourFloats>> krylovBasis;

// Mesh cells whose values stay in a processor's cache while the whole basis
// passes
static const label blockSize = 1024;


static scalar product
(
    const fourFloats* const __restrict__ u,
    const fourFloats* const __restrict__ v,
    const label n
)
{
    // Sums that do not wait for one another
    fourFloats a{}, b{}, c{}, d{};
    label i = 0;
    for (; i + 3 < n; i += 4)
    {
        a += u[i]*v[i];
        b += u[i + 1]*v[i + 1];
        c += u[i + 2]*v[i + 2];
        d += u[i + 3]*v[i + 3];
    }
    for (; i < n; ++i)
    {
        a += u[i]*v[i];
    }
    a += b + (c + d);

    return scalar(a[0]) + a[1] + a[2] + a[3];
}


// Scalar products of a vector with the first vectors of the basis, and with
// itself in the end
static scalarField products
(
    const krylovBasis& basis,
    const label n,
    const List<fourFloats>& w
)
{
    scalarField sums(n + 1, Zero);

    for (label begin = 0; begin < w.size(); begin += blockSize)
    {
        const label size = min(blockSize, w.size() - begin);

        for (label k = 0; k <= n; ++k)
        {
            const List<fourFloats>& v = k < n ? basis[k] : w;
            sums[k] += product(v.begin() + begin, w.begin() + begin, size);
        }
    }

    reduce(sums, sumOfFields<scalar>());

    return sums;
}


// Add multiples of the first vectors of the basis
static void addMultiples
(
    const krylovBasis& basis,
    const label n,
    const scalarField& factors,
    List<fourFloats>& w
)
{
    for (label begin = 0; begin < w.size(); begin += blockSize)
    {
        const label end = min(begin + blockSize, w.size());

        for (label k = 0; k < n; ++k)
        {
            const fourFloats* const __restrict__ v = basis[k].begin();
            fourFloats* const __restrict__ u = w.begin();
            const float factor = factors[k];

            for (label i = begin; i < end; ++i)
            {
                u[i] += factor*v[i];
            }
        }
    }
}


static List<fourFloats> normalised
(
    const List<fourFloats>& w,
    const float length
)
{
    List<fourFloats> v(w.size());
    forAll(v, i)
    {
        v[i] = w[i]/length;
    }

    return v;
}

} // End namespace Foam


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::stokesGMRES::scaled
(
    const List<fourFloats>& residual,
    List<fourFloats>& w
) const
{
    forAll(scale_, i)
    {
        w[i] = scale_[i]*residual[i];
    }
}


void Foam::stokesGMRES::precondition
(
    const stokesPreconditioner& preconditioner,
    const UList<fourFloats>& v
)
{
    forAll(scale_, i)
    {
        r_[i] = v[i]/scale_[i];
    }

    preconditioner.precondition(r_, z_, pressureForce_);
}


void Foam::stokesGMRES::rotate(const label n, scalarField& h)
{
    for (label i = 0; i < n; ++i)
    {
        const scalar first = h[i];
        h[i] = cosine_[i]*first + sine_[i]*h[i + 1];
        h[i + 1] = cosine_[i]*h[i + 1] - sine_[i]*first;
    }
    const scalar length = hypot(h[n], h[n + 1]) + VSMALL;
    cosine_.append(h[n]/length);
    sine_.append(h[n + 1]/length);
    left_.append(-sine_[n]*left_[n]);
    left_[n] *= cosine_[n];
    h[n] = length;
    triangle_.append(h);
}


Foam::scalarField Foam::stokesGMRES::factors() const
{
    scalarField result(triangle_.size());
    for (label i = result.size() - 1; i >= 0; --i)
    {
        result[i] = left_[i];
        for (label j = i + 1; j < result.size(); ++j)
        {
            result[i] -= triangle_[j][i]*result[j];
        }
        result[i] /= triangle_[i][i];
    }

    return result;
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::stokesGMRES::stokesGMRES(const stokesOperator& stokes)
:
    stokes_(stokes),
    scale_(stokes.halo().nLocal()),
    r_(stokes.halo().size(), fourFloats{}),
    z_(stokes.halo().size(), fourFloats{}),
    pressureForce_(stokes.halo().size(), fourFloats{})
{
    forAll(scale_, celli)
    {
        const vector diagonal(vectorOf(stokes_.diagonal()[celli]));
        scale_[celli] = fourOf
        (
            vector
            (
                1/sqrt(diagonal.x()), 1/sqrt(diagonal.y()), 1/sqrt(diagonal.z())
            ),
            1/sqrt(stokes_.V()[celli])
        );
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::scalar Foam::stokesGMRES::norm(const List<fourFloats>& residual) const
{
    return sqrt(inner(residual, residual));
}


Foam::scalar Foam::stokesGMRES::inner
(
    const List<fourFloats>& r,
    const List<fourFloats>& s
) const
{
    krylovBasis u(1, List<fourFloats>(scale_.size()));
    List<fourFloats> w(scale_.size());
    scaled(r, u[0]);
    scaled(s, w);

    return products(u, 1, w)[0];
}


Foam::label Foam::stokesGMRES::solve
(
    const stokesPreconditioner& preconditioner,
    const List<fourFloats>& residual,
    const scalar relTol,
    const label maxIterations
)
{
    List<fourFloats> w(scale_.size());
    scaled(residual, w);

    krylovBasis basis(maxIterations + 1);
    const scalar start = sqrt(products(basis, 0, w)[0]);
    basis[0] = normalised(w, start + VSMALL);
    left_.append(start);

    label n = 0;
    while (n < maxIterations && mag(left_[n]) > relTol*start + VSMALL)
    {
        precondition(preconditioner, basis[n]);
        stokes_.apply(z_, pressureForce_, r_);
        scaled(r_, w);

        scalarField h(products(basis, n + 1, w));
        addMultiples(basis, n + 1, -h, w);
        h[n + 1] = sqrt(products(basis, 0, w)[0]);
        basis[n + 1] = normalised(w, h[n + 1] + VSMALL);

        rotate(n, h);
        ++n;
    }

    w = fourFloats{};
    addMultiples(basis, n, factors(), w);
    precondition(preconditioner, w);

    return n;
}
