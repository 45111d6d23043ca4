/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/

#include "aggregationMultigrid.H"
#include "globalIndex.H"
#include "Pstream.H"
#include "PstreamReduceOps.H"
#include "scalarMatrices.H"
#include "singlePrecision.H"

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

template<class Type>
void Foam::aggregationMultigrid<Type>::coarsen()
{
    // Matchings by pairs from one level to the next
    const label nMatchings = 2;

    // Rows on all ranks of levels that are worth a second cycle
    const label manyRows = 2000;

    // Rows on all ranks that are few enough
    const label fewRows = 100;

    label before = labelMax;
    label rows = returnReduce(levels_[0].matrix.size(), sumOp<label>());

    while (rows > fewRows && rows < 0.9*before)
    {
        level& fine = levels_.last();
        fine.nCycles = rows > manyRows ? 2 : 1;
        sparseRows<Type> matrix;
        for (label matching = 0; matching < nMatchings; ++matching)
        {
            const sparseRows<Type>& last = matching ? matrix : fine.matrix;
            labelList aggregates;
            const label n = last.pair(aggregates);
            matrix = sparseRows<Type>(last, n, aggregates);

            if (matching)
            {
                for (label& aggregate : fine.aggregates)
                {
                    aggregate = aggregates[aggregate];
                }
            }
            else
            {
                fine.aggregates.transfer(aggregates);
                fine.aggregates.setSize(fine.matrix.size());
            }
        }

        levels_.append(new level());
        levels_.last().matrix = matrix;

        before = rows;
        rows = returnReduce(matrix.size(), sumOp<label>());
    }
}


template<class Type>
void Foam::aggregationMultigrid<Type>::invertCoarsest(const bool singular)
{
    const sparseRows<Type>& matrix = levels_.last().matrix;
    const globalIndex rows(matrix.size());
    const label n = rows.size();
    offset_ = rows.offset(Pstream::myProcNo());

    labelList column(matrix.halo.size());
    for (label i = 0; i < matrix.size(); ++i)
    {
        column[i] = offset_ + i;
    }
    matrix.halo.exchange(column);

    inverse_.setSize(matrix.size());
    for (List<Type>& row : inverse_)
    {
        row.setSize(n);
    }

    for (direction cmpt = 0; cmpt < pTraits<Type>::nComponents; ++cmpt)
    {
        List<scalarSquareMatrix> parts(Pstream::nProcs());
        scalarSquareMatrix& mine = parts[Pstream::myProcNo()];
        mine = scalarSquareMatrix(n, Zero);

        for (label i = 0; i < matrix.size(); ++i)
        {
            const label row = offset_ + i;
            mine(row, row) = component(matrix.diagonal[i], cmpt);
            for (label k = matrix.start[i]; k < matrix.start[i + 1]; ++k)
            {
                mine(row, column[matrix.column[k]]) += matrix.coefficient[k];
            }
        }

        scalarSquareMatrix all(n, Zero);
        Pstream::gatherList(parts);
        Pstream::scatterList(parts);
        for (const scalarSquareMatrix& part : parts)
        {
            all += part;
        }
        if (singular)
        {
            const scalar mean = all.trace()/n/n;
            for (scalar& value : all)
            {
                value += mean;
            }
        }

        labelList pivots(n);
        LUDecompose(all, pivots);
        for (label j = 0; j < n; ++j)
        {
            List<scalar> solution(n, Zero);
            solution[j] = 1;
            LUBacksubstitute(all, pivots, solution);
            forAll(inverse_, i)
            {
                setComponent(inverse_[i][j], cmpt) = solution[offset_ + i];
            }
        }
    }
}


template<class Type>
void Foam::aggregationMultigrid<Type>::solveCoarsest() const
{
    level& coarsest = levels_.last();

    List<List<Type>> sources(Pstream::nProcs());
    sources[Pstream::myProcNo()] = coarsest.source;
    Pstream::gatherList(sources);
    Pstream::scatterList(sources);

    forAll(inverse_, i)
    {
        Type sum = Zero;
        label j = 0;
        for (const List<Type>& part : sources)
        {
            for (const Type& value : part)
            {
                sum += product(inverse_[i][j++], value);
            }
        }
        coarsest.solution[i] = sum;
    }
}


template<class Type>
void Foam::aggregationMultigrid<Type>::cycle(const label leveli) const
{
    // What piecewise constant interpolation lacks of a smooth correction
    const float enlarged = 1.5;

    level& here = levels_[leveli];
    level& next = levels_[leveli + 1];
    const label n = here.matrix.size();
    const label* const __restrict__ start = here.matrix.start.begin();
    const label* const __restrict__ middle = here.matrix.middle.begin();
    const label* const __restrict__ column = here.matrix.column.begin();
    const float* const __restrict__ a = here.matrix.coefficient.begin();
    // The diagonal's inverse
    const Type* const __restrict__ d = here.matrix.diagonal.begin();
    const label* const __restrict__ aggregates = here.aggregates.begin();
    const Type* const __restrict__ b = here.source.begin();
    Type* const x = here.solution.begin();

    for (label i = 0; i < n; ++i)
    {
        Type sum = b[i];
        for (label k = start[i]; k < middle[i]; ++k)
        {
            addProduct(-a[k], x[column[k]], sum);
        }
        x[i] = product(sum, d[i]);
    }
    here.matrix.halo.exchange(here.solution);

    next.source = Zero;
    for (label i = 0; i < n; ++i)
    {
        Type sum = Zero;
        for (label k = middle[i]; k < start[i + 1]; ++k)
        {
            addProduct(-a[k], x[column[k]], sum);
        }
        next.source[aggregates[i]] += sum;
    }

    solve(leveli + 1);

    for (label i = 0; i < n; ++i)
    {
        addProduct(enlarged, next.solution[aggregates[i]], x[i]);
    }
    here.matrix.halo.exchange(here.solution);

    for (label i = n - 1; i >= 0; --i)
    {
        Type sum = b[i];
        for (label k = start[i]; k < start[i + 1]; ++k)
        {
            addProduct(-a[k], x[column[k]], sum);
        }
        x[i] = product(sum, d[i]);
    }
}


template<class Type>
void Foam::aggregationMultigrid<Type>::solve(const label leveli) const
{
    if (leveli == levels_.size() - 1)
    {
        solveCoarsest();
        return;
    }

    cycle(leveli);

    level& here = levels_[leveli];
    const sparseRows<Type>& matrix = here.matrix;

    for (label cyclei = 1; cyclei < here.nCycles; ++cyclei)
    {
        const List<Type> before(here.solution);
        matrix.halo.exchange(here.solution);

        for (label i = 0; i < matrix.size(); ++i)
        {
            Type& residual = here.source[i];
            // The diagonal's inverse is stored
            residual -= cmptDivide(before[i], matrix.diagonal[i]);
            for (label k = matrix.start[i]; k < matrix.start[i + 1]; ++k)
            {
                addProduct
                (
                   -matrix.coefficient[k],
                    here.solution[matrix.column[k]],
                    residual
                );
            }
        }

        cycle(leveli);

        for (label i = 0; i < matrix.size(); ++i)
        {
            here.solution[i] += before[i];
        }
    }
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

template<class Type>
Foam::aggregationMultigrid<Type>::aggregationMultigrid
(
    const cellHalo& halo,
    const faceCoefficients& faces,
    const UList<Type>& diagonal,
    const bool singular
)
:
    levels_(),
    inverse_(),
    offset_(0)
{
    levels_.append(new level());
    levels_[0].matrix = sparseRows<Type>(halo, faces, diagonal);

    coarsen();
    invertCoarsest(singular);

    for (level& here : levels_)
    {
        here.source.setSize(here.matrix.size());
        here.solution.setSize(here.matrix.halo.size());
        here.solution = Zero;
        for (Type& value : here.matrix.diagonal)
        {
            value = cmptDivide(pTraits<Type>::one, value);
        }
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

template<class Type>
const Foam::UList<Type>& Foam::aggregationMultigrid<Type>::solve() const
{
    solve(0);
    return levels_[0].solution;
}


// * * * * * * * * * * * * * * * * Instantiation * * * * * * * * * * * * * * //

template class Foam::aggregationMultigrid<float>;
template class Foam::aggregationMultigrid<Foam::floatVector>;


// ************************************************************************* //
