// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "aggregationMultigrid.H"
#include "LUscalarMatrix.H"
#include "PstreamReduceOps.H"
#include "sumOfFields.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{

// The single values of a list
template<class Type>
static UList<float> flat(UList<Type>& values)
{
    return UList<float>
    (
        reinterpret_cast<float*>(values.begin()),
        values.size()*(sizeof(Type)/sizeof(float))
    );
}

} // End namespace Foam


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

template<class Type>
void Foam::aggregationMultigrid<Type>::coarsen()
{
    // Of the diagonal; what couples less is nearly independent
    const float threshold = 0.06;

    // Rows on all ranks that are few enough
    const label fewRows = 100;

    label before = labelMax;
    label rows = returnReduce(levels_[0].matrix.size(), sumOp<label>());

    while (rows > fewRows && rows < 0.9*before)
    {
        level& fine = levels_.last();
        labelList aggregates;
        const label n = fine.matrix.aggregate(threshold, aggregates);
        fine.weights =
            fine.matrix.smoothed
            (
                threshold,
                n,
                SubList<label>(aggregates, fine.matrix.size())
            );

        levels_.append(new level());
        level& coarse = levels_.last();
        coarse.matrix = sparseRows<Type>
        (
            levels_[levels_.size() - 2].matrix,
            levels_[levels_.size() - 2].weights,
            n,
            aggregates
        );

        before = rows;
        rows = returnReduce(coarse.matrix.size(), sumOp<label>());
    }
}


template<class Type>
void Foam::aggregationMultigrid<Type>::invertCoarsest(const bool singular)
{
    sparseRows<Type>& matrix = levels_.last().matrix;
    const UList<float> diagonal(flat(matrix.diagonal));
    coarsestRows_ = globalIndex(matrix.size());
    const label n = coarsestRows_.size();

    labelList column(matrix.halo.size());
    for (label i = 0; i < matrix.size(); ++i)
    {
        column[i] = coarsestRows_.toGlobal(i);
    }
    matrix.halo.exchange(column);

    inverse_.setSize(matrix.size(), List<Type>(n));

    for (label cmpt = 0; cmpt < nValues; ++cmpt)
    {
        scalarSquareMatrix all(n, Zero);
        for (label i = 0; i < matrix.size(); ++i)
        {
            scalar* const row = all[column[i]];
            row[column[i]] = diagonal[nValues*i + cmpt];
            for (label k = matrix.start[i]; k < matrix.start[i + 1]; ++k)
            {
                row[column[matrix.column[k]]] += matrix.coefficient[k];
            }
        }
        reduce(all, sumOp<scalarSquareMatrix>());
        if (singular)
        {
            all += all.trace()/n/n;
        }

        scalarSquareMatrix inverse(n);
        LUscalarMatrix(all).inv(inverse);
        forAll(inverse_, i)
        {
            for (label j = 0; j < n; ++j)
            {
                flat(inverse_[i])[nValues*j + cmpt] = inverse(column[i], j);
            }
        }
    }
}


template<class Type>
void Foam::aggregationMultigrid<Type>::solveCoarsest() const
{
    level& coarsest = levels_.last();
    const label n = coarsestRows_.size();
    const UList<float> mine(flat(coarsest.source));

    Field<float> all(nValues*n, 0.0f);
    std::copy
    (
        mine.begin(),
        mine.end(),
        all.begin() + nValues*coarsestRows_.toGlobal(0)
    );
    reduce(all, sumOfFields<float>());
    const Type* const source = reinterpret_cast<const Type*>(all.begin());

    forAll(inverse_, i)
    {
        Type sum{};
        for (label j = 0; j < n; ++j)
        {
            sum += inverse_[i][j]*source[j];
        }
        coarsest.solution[i] = sum;
    }
}


template<class Type>
void Foam::aggregationMultigrid<Type>::cycle(const label leveli) const
{
    if (leveli == levels_.size() - 1)
    {
        solveCoarsest();
        return;
    }

    level& here = levels_[leveli];
    level& next = levels_[leveli + 1];
    const label n = here.matrix.size();
    const label* const __restrict__ start = here.matrix.start.begin();
    const label* const __restrict__ middle = here.matrix.middle.begin();
    const label* const __restrict__ column = here.matrix.column.begin();
    const float* const __restrict__ a = here.matrix.coefficient.begin();
    // The diagonal's inverse
    const Type* const __restrict__ d = here.matrix.diagonal.begin();
    const label* const __restrict__ first = here.weights.start.begin();
    const label* const __restrict__ coarse = here.weights.column.begin();
    const float* const __restrict__ w = here.weights.weight.begin();
    const Type* const __restrict__ b = here.source.begin();
    Type* const x = here.solution.begin();

    for (label i = 0; i < n; ++i)
    {
        Type sum = b[i];
        for (label k = start[i]; k < middle[i]; ++k)
        {
            sum -= a[k]*x[column[k]];
        }
        x[i] = sum*d[i];
    }
    here.matrix.halo.exchange(here.solution);

    next.source = Type{};
    for (label i = 0; i < n; ++i)
    {
        Type sum{};
        for (label k = middle[i]; k < start[i + 1]; ++k)
        {
            sum -= a[k]*x[column[k]];
        }
        for (label k = first[i]; k < first[i + 1]; ++k)
        {
            next.source[coarse[k]] += w[k]*sum;
        }
    }

    cycle(leveli + 1);

    for (label i = 0; i < n; ++i)
    {
        for (label k = first[i]; k < first[i + 1]; ++k)
        {
            x[i] += w[k]*next.solution[coarse[k]];
        }
    }
    here.matrix.halo.exchange(here.solution);

    for (label i = n - 1; i >= 0; --i)
    {
        Type sum = b[i];
        for (label k = start[i]; k < start[i + 1]; ++k)
        {
            sum -= a[k]*x[column[k]];
        }
        x[i] = sum*d[i];
    }
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

template<class Type>
Foam::aggregationMultigrid<Type>::aggregationMultigrid
(
    const meshHalo& halo,
    const faceCoefficients& faces,
    const UList<Type>& diagonal,
    const bool singular,
    const label nCycles
)
:
    nCycles_(nCycles),
    levels_(),
    inverse_(),
    coarsestRows_()
{
    levels_.append(new level());
    levels_[0].matrix = sparseRows<Type>(halo, faces, diagonal);

    coarsen();
    invertCoarsest(singular);

    for (level& here : levels_)
    {
        here.source.setSize(here.matrix.size());
        here.solution.setSize(here.matrix.halo.size());
        here.solution = Type{};
        for (Type& value : here.matrix.diagonal)
        {
            value = 1/value;
        }
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

template<class Type>
const Foam::UList<Type>& Foam::aggregationMultigrid<Type>::solve() const
{
    level& finest = levels_[0];
    const sparseRows<Type>& matrix = finest.matrix;

    cycle(0);
    for (label cyclei = 1; cyclei < nCycles_; ++cyclei)
    {
        const List<Type> before(finest.solution);
        matrix.halo.exchange(finest.solution);

        for (label i = 0; i < matrix.size(); ++i)
        {
            finest.source[i] -= product(i, finest.solution);
        }

        cycle(0);
        for (label i = 0; i < matrix.size(); ++i)
        {
            finest.solution[i] += before[i];
        }
    }

    return finest.solution;
}


// * * * * * * * * * * * * * * * * Instantiation * * * * * * * * * * * * * * //

template class Foam::aggregationMultigrid<float>;
template class Foam::aggregationMultigrid<Foam::fourFloats>;
