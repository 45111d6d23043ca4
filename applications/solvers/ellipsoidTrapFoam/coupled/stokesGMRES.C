/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/

#include "stokesGMRES.H"
#include "Pstream.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{

typedef List<List<float>> krylovBasis;

// Values that stay in a processor's cache while the whole basis passes
static const label blockSize = 4096;


// Scalar products of a vector with the first vectors of the basis, and with
// itself in the end
static scalarField products
(
    const krylovBasis& basis,
    const label n,
    const List<float>& w
)
{
    scalarField sums(n + 1, Zero);

    for (label begin = 0; begin < w.size(); begin += blockSize)
    {
        const label end = min(begin + blockSize, w.size());

        for (label k = 0; k <= n; ++k)
        {
            const float* const __restrict__ v =
                (k < n ? basis[k] : w).begin();
            const float* const __restrict__ u = w.begin();

            float a = 0, b = 0, c = 0, d = 0;
            for (label i = begin; i < end; i += 4)
            {
                a += v[i]*u[i];
                b += v[i + 1]*u[i + 1];
                c += v[i + 2]*u[i + 2];
                d += v[i + 3]*u[i + 3];
            }
            sums[k] += scalar(a) + b + c + d;
        }
    }

    Pstream::listCombineGather(sums, plusEqOp<scalar>());
    Pstream::listCombineScatter(sums);

    return sums;
}


// Add multiples of the first vectors of the basis
static void addMultiples
(
    const krylovBasis& basis,
    const label n,
    const scalarField& factors,
    List<float>& w
)
{
    for (label begin = 0; begin < w.size(); begin += blockSize)
    {
        const label end = min(begin + blockSize, w.size());

        for (label k = 0; k < n; ++k)
        {
            const float* const __restrict__ v = basis[k].begin();
            float* const __restrict__ u = w.begin();
            const float factor = factors[k];

            for (label i = begin; i < end; ++i)
            {
                u[i] += factor*v[i];
            }
        }
    }
}


static List<float> normalised(const List<float>& w, const float length)
{
    List<float> v(w.size());
    forAll(v, i)
    {
        v[i] = w[i]/length;
    }

    return v;
}

} // End namespace Foam


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::stokesGMRES::scaled(List<float>& w) const
{
    forAll(scaleP_, i)
    {
        w[4*i] = scaleU_[i].x()*r_.U[i].x();
        w[4*i + 1] = scaleU_[i].y()*r_.U[i].y();
        w[4*i + 2] = scaleU_[i].z()*r_.U[i].z();
        w[4*i + 3] = scaleP_[i]*r_.p[i];
    }
}


void Foam::stokesGMRES::precondition(const UList<float>& v)
{
    forAll(scaleP_, i)
    {
        r_.U[i].x() = v[4*i]/scaleU_[i].x();
        r_.U[i].y() = v[4*i + 1]/scaleU_[i].y();
        r_.U[i].z() = v[4*i + 2]/scaleU_[i].z();
        r_.p[i] = v[4*i + 3]/scaleP_[i];
    }

    preconditioner_.precondition(r_, z_, pressureForce_);
    stokes_.exchange(z_, pressureForce_);
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

Foam::stokesGMRES::stokesGMRES
(
    const stokesOperator& stokes,
    const stokesPreconditioner& preconditioner,
    const scalar nu
)
:
    stokes_(stokes),
    preconditioner_(preconditioner),
    scaleU_(stokes.halo().nCells()),
    scaleP_(stokes.halo().nCells()),
    r_(stokes.halo().size()),
    z_(stokes.halo().size()),
    pressureForce_(stokes.halo().size())
{
    forAll(scaleU_, celli)
    {
        const floatVector& diagonal = stokes_.diagonal()[celli];
        for (direction cmpt = 0; cmpt < vector::nComponents; ++cmpt)
        {
            scaleU_[celli][cmpt] = 1/sqrt(diagonal[cmpt]);
        }
        scaleP_[celli] = sqrt(nu/stokes_.V()[celli]);
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::label Foam::stokesGMRES::solve
(
    const scalar relTol,
    const label maxIterations
)
{
    List<float> w(4*scaleP_.size());
    scaled(w);

    krylovBasis basis(maxIterations + 1);
    const scalar start = sqrt(products(basis, 0, w)[0]);
    basis[0] = normalised(w, start + VSMALL);
    left_.append(start);

    label n = 0;
    while (n < maxIterations && mag(left_[n]) > relTol*start + VSMALL)
    {
        precondition(basis[n]);
        stokes_.apply(z_, pressureForce_, r_);
        scaled(w);

        scalarField h(products(basis, n + 1, w));
        addMultiples(basis, n + 1, -h, w);
        h[n + 1] = sqrt(products(basis, 0, w)[0]);
        basis[n + 1] = normalised(w, h[n + 1] + VSMALL);

        rotate(n, h);
        ++n;
    }

    w = Zero;
    addMultiples(basis, n, factors(), w);
    precondition(w);

    return n;
}


// ************************************************************************* //
