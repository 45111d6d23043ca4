/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/

#include "sparseRows.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{

static inline void addToAll(float& diagonal, const float value)
{
    diagonal += value;
}


static inline void addToAll(floatVector& diagonal, const float value)
{
    diagonal.x() += value;
    diagonal.y() += value;
    diagonal.z() += value;
}

} // End namespace Foam


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

template<class Type>
Foam::sparseRows<Type>::sparseRows
(
    const cellHalo& halo,
    const faceCoefficients& faces,
    const UList<Type>& diagonal
)
:
    halo(halo),
    start(halo.nCells() + 1, Zero),
    middle(halo.nCells(), Zero),
    column(),
    coefficient(),
    diagonal(diagonal)
{
    const label n = halo.nCells();
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

    // The owner of a face is the lower cell
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
    const label nAggregates,
    labelList& aggregates
)
:
    halo(fine.halo, nAggregates, aggregates),
    start(nAggregates + 1, Zero),
    middle(nAggregates, Zero),
    column(fine.column.size()),
    coefficient(fine.column.size()),
    diagonal(nAggregates, Zero)
{
    // Rows in the order of their aggregates
    labelList first(nAggregates + 1, Zero);
    for (label i = 0; i < fine.size(); ++i)
    {
        ++first[aggregates[i] + 1];
    }
    for (label i = 0; i < nAggregates; ++i)
    {
        first[i + 1] += first[i];
    }
    labelList rows(fine.size());
    labelList next(first);
    for (label i = 0; i < fine.size(); ++i)
    {
        rows[next[aggregates[i]]++] = i;
    }

    // Where the row at hand has a column already
    labelList place(halo.size(), -1);
    label n = 0;

    for (label coarse = 0; coarse < nAggregates; ++coarse)
    {
        const label begin = n;

        // Columns below the diagonal come first
        for (const bool lower : {true, false})
        {
            for (label r = first[coarse]; r < first[coarse + 1]; ++r)
            {
                const label row = rows[r];
                if (lower)
                {
                    diagonal[coarse] += fine.diagonal[row];
                }
                for (label k = fine.start[row]; k < fine.start[row + 1]; ++k)
                {
                    const label col = aggregates[fine.column[k]];
                    if (col == coarse)
                    {
                        if (lower)
                        {
                            addToAll(diagonal[coarse], fine.coefficient[k]);
                        }
                    }
                    else if ((col < coarse) == lower)
                    {
                        if (place[col] < begin)
                        {
                            place[col] = n;
                            column[n] = col;
                            coefficient[n++] = 0;
                        }
                        coefficient[place[col]] += fine.coefficient[k];
                    }
                }
            }
            if (lower)
            {
                middle[coarse] = n;
            }
        }
        start[coarse + 1] = n;
    }

    column = labelList(SubList<label>(column, n));
    coefficient = List<float>(SubList<float>(coefficient, n));
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

template<class Type>
Foam::label Foam::sparseRows<Type>::pair(labelList& aggregates) const
{
    aggregates.setSize(halo.size());
    aggregates = -1;
    label n = 0;

    for (label i = 0; i < size(); ++i)
    {
        if (aggregates[i] >= 0)
        {
            continue;
        }

        label alone = -1, paired = -1;
        float largestAlone = 0, largestPaired = 0;

        for (label k = start[i]; k < start[i + 1]; ++k)
        {
            const label j = column[k];
            const float strength = mag(coefficient[k]);

            if (j >= size())
            {
                continue;
            }
            if (aggregates[j] < 0 && strength > largestAlone)
            {
                alone = j;
                largestAlone = strength;
            }
            else if (aggregates[j] >= 0 && strength > largestPaired)
            {
                paired = j;
                largestPaired = strength;
            }
        }

        if (alone >= 0)
        {
            aggregates[i] = aggregates[alone] = n++;
        }
        else
        {
            aggregates[i] = paired >= 0 ? aggregates[paired] : n++;
        }
    }

    return n;
}


// * * * * * * * * * * * * * * * * Instantiation * * * * * * * * * * * * * * //

template class Foam::sparseRows<float>;
template class Foam::sparseRows<Foam::floatVector>;


// ************************************************************************* //
