// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "sparseRows.H"
#include "DynamicList.H"
#include "ListOps.H"

#include <numeric>

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{

static inline float least(const float x)
{
    return x;
}


static inline float least(const fourFloats& x)
{
    return min(min(x[0], x[1]), x[2]);
}


// The rows that each column of an interpolation has, as that of the columns
static aggregateWeights transposed
(
    const aggregateWeights& weights,
    const label n
)
{
    aggregateWeights result;
    result.start.setSize(n + 1, Zero);
    result.column.setSize(weights.column.size());
    result.weight.setSize(weights.column.size());

    for (const label col : weights.column)
    {
        ++result.start[col + 1];
    }
    std::partial_sum
    (
        result.start.begin(), result.start.end(), result.start.begin()
    );

    labelList next(SubList<label>(result.start, n));
    for (label i = 0; i < weights.start.size() - 1; ++i)
    {
        for (label k = weights.start[i]; k < weights.start[i + 1]; ++k)
        {
            const label at = next[weights.column[k]]++;
            result.column[at] = i;
            result.weight[at] = weights.weight[k];
        }
    }

    return result;
}


// A row whose columns are met in any order
class sparseSum
{
    List<scalar> value_;

    bitSet met_;

    DynamicList<label> columns_;


public:

    explicit sparseSum(const label nColumns)
    :
        value_(nColumns, Zero),
        met_(nColumns),
        columns_()
    {}


    void add(const label column, const scalar value)
    {
        if (!met_[column])
        {
            met_[column] = true;
            columns_.append(column);
        }
        value_[column] += value;
    }


    //- Append the row to others, columns below the diagonal first; it is empty
    //- then.
    //  \param middle  where those above the diagonal begin
    //  \return the diagonal
    scalar takeOut
    (
        const label row,
        label& middle,
        DynamicList<label>& column,
        DynamicList<float>& coefficient
    )
    {
        for (const bool lower : {true, false})
        {
            for (const label col : columns_)
            {
                if (col != row && (col < row) == lower)
                {
                    column.append(col);
                    coefficient.append(value_[col]);
                }
            }
            if (lower)
            {
                middle = column.size();
            }
        }

        const scalar diagonal = value_[row];
        for (const label col : columns_)
        {
            value_[col] = 0;
            met_[col] = false;
        }
        columns_.clear();

        return diagonal;
    }
};

} // End namespace Foam


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

template<class Type>
float Foam::sparseRows<Type>::leastDiagonal(const label row) const
{
    return least(diagonal[row]);
}


template<class Type>
Foam::boolList Foam::sparseRows<Type>::strong(const float threshold) const
{
    boolList result(column.size(), false);

    for (label i = 0; i < size(); ++i)
    {
        bool any = false;
        for (label k = start[i]; k < start[i + 1]; ++k)
        {
            const label j = column[k];
            if (j < size())
            {
                result[k] =
                    sqr(coefficient[k]/threshold)
                  > leastDiagonal(i)*leastDiagonal(j);
                any = any || result[k];
            }
        }
        for (label k = start[i]; !any && k < start[i + 1]; ++k)
        {
            result[k] = column[k] < size();
        }
    }

    return result;
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

template<class Type>
Foam::sparseRows<Type>::sparseRows
(
    const meshHalo& halo,
    const faceCoefficients& faces,
    const UList<Type>& diagonal
)
:
    halo(halo),
    start(halo.nLocal() + 1, Zero),
    middle(halo.nLocal(), Zero),
    column(),
    coefficient(),
    diagonal(diagonal)
{
    const label n = halo.nLocal();
    const labelUList& owner = faces.owner;
    const labelUList& neighbour = faces.neighbour;

    forAll(owner, facei)
    {
        ++start[owner[facei] + 1];
        if (neighbour[facei] < n)
        {
            ++start[neighbour[facei] + 1];
            ++middle[neighbour[facei]];
        }
    }
    for (label i = 0; i < n; ++i)
    {
        start[i + 1] += start[i];
        middle[i] += start[i];
    }

    column.setSize(start[n]);
    coefficient.setSize(start[n]);
    labelList below(SubList<label>(start, n));
    labelList above(middle);

    // The owner of a face is the lower one
    forAll(owner, facei)
    {
        const label own = owner[facei];
        const label nei = neighbour[facei];

        column[above[own]] = nei;
        coefficient[above[own]++] = faces.upper[facei];
        if (nei < n)
        {
            column[below[nei]] = own;
            coefficient[below[nei]++] = faces.lower[facei];
        }
    }
}


template<class Type>
Foam::sparseRows<Type>::sparseRows
(
    const sparseRows& fine,
    const aggregateWeights& weights,
    const label nAggregates,
    labelList& aggregates
)
:
    halo(fine.halo, nAggregates, aggregates),
    start(nAggregates + 1, Zero),
    middle(nAggregates, Zero),
    column(),
    coefficient(),
    diagonal(nAggregates, Type{})
{
    const label n = fine.size();
    const aggregateWeights rowsOf(transposed(weights, nAggregates));

    // What a row has in the halo, and how the aggregates' rows go on from that
    scalarField beyond(n, Zero);
    const labelListList rows
    (
        invertOneToMany(nAggregates, SubList<label>(aggregates, n))
    );

    for (label i = 0; i < n; ++i)
    {
        for (label k = fine.middle[i]; k < fine.start[i + 1]; ++k)
        {
            if (fine.column[k] >= n)
            {
                beyond[i] += fine.coefficient[k];
            }
        }
        diagonal[aggregates[i]] +=
            fine.diagonal[i] - (Type{} + fine.leastDiagonal(i));
    }

    DynamicList<label> columns(fine.column.size()/2);
    DynamicList<float> coefficients(fine.column.size()/2);
    sparseSum sum(halo.size());

    for (label coarse = 0; coarse < nAggregates; ++coarse)
    {
        const auto addRow = [&](const label row, const scalar a)
        {
            const label end = weights.start[row + 1];
            for (label k = weights.start[row]; k < end; ++k)
            {
                sum.add(weights.column[k], a*weights.weight[k]);
            }
        };

        const label end = rowsOf.start[coarse + 1];
        for (label r = rowsOf.start[coarse]; r < end; ++r)
        {
            const label i = rowsOf.column[r];
            const scalar w = rowsOf.weight[r];

            addRow(i, w*(fine.leastDiagonal(i) + beyond[i]));
            for (label k = fine.start[i]; k < fine.start[i + 1]; ++k)
            {
                if (fine.column[k] < n)
                {
                    addRow(fine.column[k], w*fine.coefficient[k]);
                }
            }
        }
        for (const label i : rows[coarse])
        {
            sum.add(coarse, -beyond[i]);
            for (label k = fine.middle[i]; k < fine.start[i + 1]; ++k)
            {
                if (fine.column[k] >= n)
                {
                    sum.add(aggregates[fine.column[k]], fine.coefficient[k]);
                }
            }
        }

        diagonal[coarse] +=
            float(sum.takeOut(coarse, middle[coarse], columns, coefficients));
        start[coarse + 1] = columns.size();
    }

    column = columns;
    coefficient = coefficients;
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

template<class Type>
Foam::label Foam::sparseRows<Type>::aggregate
(
    const float threshold,
    labelList& aggregates
) const
{
    const boolList coupled(strong(threshold));
    aggregates.setSize(halo.size());
    aggregates = -1;
    label n = 0;

    // One more, of a row and its free neighbours
    const auto addAggregate = [&](const label i)
    {
        aggregates[i] = n;
        for (label k = start[i]; k < start[i + 1]; ++k)
        {
            if (coupled[k] && aggregates[column[k]] < 0)
            {
                aggregates[column[k]] = n;
            }
        }
        ++n;
    };

    // Rows all of whose neighbours are free
    for (label i = 0; i < size(); ++i)
    {
        bool free = aggregates[i] < 0;
        for (label k = start[i]; free && k < start[i + 1]; ++k)
        {
            free = !(coupled[k] && aggregates[column[k]] >= 0);
        }
        if (free)
        {
            addAggregate(i);
        }
    }

    // Others go with the neighbour that they are coupled with most
    const labelList first(aggregates);
    for (label i = 0; i < size(); ++i)
    {
        float largest = 0;
        for (label k = start[i]; first[i] < 0 && k < start[i + 1]; ++k)
        {
            const float strength = mag(coefficient[k]);
            if (coupled[k] && first[column[k]] >= 0 && strength > largest)
            {
                largest = strength;
                aggregates[i] = first[column[k]];
            }
        }
    }

    // What is left
    for (label i = 0; i < size(); ++i)
    {
        if (aggregates[i] < 0)
        {
            addAggregate(i);
        }
    }

    return n;
}


template<class Type>
Foam::aggregateWeights Foam::sparseRows<Type>::smoothed
(
    const float threshold,
    const label nAggregates,
    const labelUList& aggregates
) const
{
    // By the largest eigenvalue of the matrix by its diagonal, as Vanek et al.
    const scalar damping = 4.0/3;

    const boolList coupled(strong(threshold));
    aggregateWeights result;
    result.start.setSize(size() + 1, Zero);
    DynamicList<label> columns(3*size());
    DynamicList<float> weights(3*size());
    labelList place(nAggregates, -1);

    for (label i = 0; i < size(); ++i)
    {
        // Weak coefficients go to the diagonal
        scalar own = leastDiagonal(i), others = 0;
        for (label k = start[i]; k < start[i + 1]; ++k)
        {
            if (coupled[k])
            {
                others += mag(coefficient[k]);
            }
            else
            {
                own += coefficient[k];
            }
        }
        // At most a whole Jacobi step
        const scalar step =
            own > 0 ? min(damping/(own + others), 1/own) : scalar(0);

        const label begin = columns.size();
        place[aggregates[i]] = begin;
        columns.append(aggregates[i]);
        weights.append(1 - step*own);

        for (label k = start[i]; k < start[i + 1]; ++k)
        {
            if (coupled[k])
            {
                const label col = aggregates[column[k]];
                if (place[col] < begin)
                {
                    place[col] = columns.size();
                    columns.append(col);
                    weights.append(0);
                }
                weights[place[col]] -= step*coefficient[k];
            }
        }
        result.start[i + 1] = columns.size();
    }

    result.column = columns;
    result.weight = weights;

    return result;
}


// * * * * * * * * * * * * * * * * Instantiation * * * * * * * * * * * * * * //

template class Foam::sparseRows<float>;
template class Foam::sparseRows<Foam::fourFloats>;
