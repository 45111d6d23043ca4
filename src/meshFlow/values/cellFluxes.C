// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "cellFluxes.H"
#include "tetFlow.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    template<class Pair, class Form>
    static Pair pairOf(const Form& a, const Form& b)
    {
        Pair two;
        for (direction k = 0; k < Form::nComponents; ++k)
        {
            two[k] = numberPair{a[k], b[k]};
        }
        return two;
    }
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::cellFluxes::setTwo(const flowValues& values, const label i)
{
    // The last may be there twice
    const label tets[2] = {first_ + i, first_ + min(i + 1, n_ - 1)};
    vectorPair x[4];
    vectorPair third[4];
    tensorPair G[4];
    const point& apex = values.vertices[tets_[first_].vertices[0]].x;
    for (int a = 0; a < 4; ++a)
    {
        const flowVertex& v = values.vertices[tets_[tets[0]].vertices[a]];
        const flowVertex& w = values.vertices[tets_[tets[1]].vertices[a]];

        x[a] = pairOf<vectorPair>(v.x - apex, w.x - apex);
        third[a] = pairOf<vectorPair>(v.u, w.u)/3;
        G[a] = pairOf<tensorPair>(v.gradient, w.gradient);
    }
    std::copy_n(x, 4, edges_.data() + 2*i);

    // As tetFlow::setEdge()
    vectorPair twelfth[6];
    for (int e = 0; e < 6; ++e)
    {
        const int a = tetFlow::first(e);
        const int b = tetFlow::second(e);

        twelfth[e] = ((G[a] - G[b]) & (0.5*(x[b] - x[a])))/12;
        for (int j = 0; j < 2; ++j)
        {
            if (values.straight[tets[j]] >> e & 1)
            {
                twelfth[e].x()[j] = twelfth[e].y()[j] = twelfth[e].z()[j] = 0;
            }
        }
    }

    // As tetFlow::setCoordinateGradients(), volume() and quadraticFlux()
    numberPair volume = x[1] & (x[2] ^ x[3]);
    for (int j = 0; j < 2; ++j)
    {
        volume[j] = volume[j] != 0 ? volume[j] : 1e-40;
    }
    vectorPair g[4];
    g[0] = x[0];
    for (int a = 1; a < 4; ++a)
    {
        g[a] = (1/volume)*(x[a % 3 + 1] ^ x[(a + 1) % 3 + 1]);
        g[0] -= g[a];
    }
    volume /= 6;

    tetSize* of = of_.data() + i;
    numberPair missing =
    {
        -values.outwards[tets[0]], -values.outwards[tets[1]]
    };
    for (int k = 0; k < 4; ++k)
    {
        vectorPair sum(x[0]);
        for (int a = 0; a < 4; ++a)
        {
            sum += a != k ? third[a] : x[0];
        }
        for (int e = 0; e < 6; ++e)
        {
            const bool on = tetFlow::first(e) != k && tetFlow::second(e) != k;
            sum += on ? twelfth[e] : x[0];
        }
        missing -= -3*volume*(g[k] & sum);

        const vectorPair S(volume*g[k]);
        const numberPair squares = S & S;
        of[0].areas[k] = 3*Foam::sqrt(squares[0]);
        of[1].areas[k] = 3*Foam::sqrt(squares[1]);
    }
    for (int j = 0; j < 2; ++j)
    {
        of[j].volume = volume[j];
        missing_[i + j] = missing[j];
    }
}


Foam::scalar Foam::cellFluxes::take(const flowValues& values)
{
    const label nTwice = n_ + n_ % 2;
    nPairs_ = n_/2 + 1;
    of_.setSize(nTwice);
    edges_.setSize(2*nTwice);
    conductances_.setSize(n_);
    missing_.setSize(nTwice);
    for (label i = 0; i < n_; i += 2)
    {
        setTwo(values, i);
    }

    scalar volume = 0;
    scalar net = 0;
    for (label i = 0; i < n_; ++i)
    {
        net += missing_[i];
        volume += mag(of_[i].volume);
    }

    // A flow that is not free of divergence has it everywhere in the mesh cell
    const scalar divergence = net/volume;
    for (label i = 0; i < n_; ++i)
    {
        missing_[i] -= divergence*mag(of_[i].volume);
    }
    return volume;
}


void Foam::cellFluxes::setByCentre
(
    const scalar unit,
    const scalar gradientUnit
)
{
    byCentre_.setSize(nCentre*nPairs_);
    std::fill_n(byCentre_.end() - nCentre, label(nCentre), numberPair{0, 0});

    const vectorPair* edges = edges_.cdata();
    numberPair* byCentre = byCentre_.data();
    for (label i = 0; i < n_; i += 2, edges += 4, byCentre += nCentre)
    {
        // A third of the areas of the faces, inwards
        const vectorPair S[4] =
        {
            ((edges[2] - edges[1]) ^ (edges[1] - edges[3]))/6,
            (edges[2] ^ edges[3])/6,
            (edges[3] ^ edges[1])/6,
            (edges[1] ^ edges[2])/6
        };
        tensorPair byGradient(((gradientUnit/8)*(S[0] + S[1]))*edges[1]);
        for (label a = 2; a < 4; ++a)
        {
            byGradient += ((gradientUnit/8)*(S[0] + S[a]))*edges[a];
        }

        for (direction k = 0; k < 3; ++k)
        {
            byCentre[k] = unit*S[0][k];
        }
        std::copy_n(byGradient.v_, 9, byCentre + 3);
    }
}


void Foam::cellFluxes::setColumns(const scalar volume)
{
    columns_.setSize(n_*nPairs_);
    scalar* columns = numbers(columns_);
    const label stride = 2*nPairs_;

    for (label j = 0; j < n_; ++j)
    {
        numberPair factors[nCentre];
        for (direction k = 0; k < nCentre; ++k)
        {
            const scalar factor = byCentre(j)[2*k];
            factors[k] = numberPair{factor, factor};
        }

        for (label p = j/2; p < nPairs_; ++p)
        {
            numberPair sum = {0, 0};
            for (direction k = 0; k < nCentre; ++k)
            {
                sum += byCentre_[p*nCentre + k]*factors[k];
            }
            columns_[j*nPairs_ + p] = sum;
        }
        columns[j*stride + n_] = missing_[j];
    }

    for (label i = 0; i < n_; ++i)
    {
        for (label k = 1; k < 4; ++k)
        {
            const label j = tets_[first_ + i].neighbours[k] - first_;
            // Not without bound between flat ones
            const scalar both = mag(of_[i].volume) + mag(of_[j].volume);
            const scalar conductance =
                sqr(of_[i].areas[k])/max(both, 1e-6*volume);

            conductances_[i][k - 1] = conductance;
            columns[i*stride + i] += conductance;
            if (j < i)
            {
                columns[j*stride + i] -= conductance;
            }
        }
    }
    columns[0] *= 2;
}


void Foam::cellFluxes::solve()
{
    const label stride = 2*nPairs_;
    scalar* columns = numbers(columns_);
    factors_.setSize(n_);

    // All earlier columns are taken from each
    for (label j = 0; j < n_; ++j)
    {
        numberPair* column = columns_.data() + j*nPairs_;
        scalar& diagonal = columns[j*stride + j];

        for (label k = 0; k < j; ++k)
        {
            const scalar factor = columns[k*stride + j];
            factors_[k] = numberPair{factor, factor};
        }
        for (label p = j/2; p < nPairs_; ++p)
        {
            numberPair sum = column[p];
            for (label k = 0; k < j; ++k)
            {
                sum -= columns_[k*nPairs_ + p]*factors_[k];
            }
            column[p] = sum;
        }

        if (!(diagonal > 0))
        {
            FatalErrorInFunction
                << "the fluxes in mesh cell " << tets_[first_].vertices[0]
                << " cannot be balanced: checkMesh says more"
                << exit(FatalError);
        }

        const scalar root = Foam::sqrt(diagonal);
        const numberPair roots = {root, root};
        for (label p = j/2; p < nPairs_; ++p)
        {
            column[p] /= roots;
        }
        diagonal = root;
    }

    scalar* x = missing_.data();
    for (label i = n_; i-- > 0;)
    {
        const scalar* column = columns + i*stride;
        scalar sum = column[n_];
        for (label j = i + 1; j < n_; ++j)
        {
            sum -= column[j]*x[j];
        }
        x[i] = sum/column[i];
    }
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::cellFluxes::cellFluxes(const UList<flowTet>& tets)
:
    tets_(tets)
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::cellFluxes::share
(
    scalar flux,
    const label first,
    const label end,
    flowValues& values
)
{
    scalar area = 0;
    of_.setSize(end - first);
    for (label teti = first; teti < end; ++teti)
    {
        const auto vertex =
            [&](const int a) -> const flowVertex&
            {
                return values.vertices[tets_[teti].vertices[a]];
            };

        tetFlow flow;
        vector g[4];
        flow.setFace(vertex, values.straight[teti]);
        flow.coordinateGradients(g);
        scalar& part = of_[teti - first].areas[0];
        part = 3*mag(flow.volume()*g[0]);
        area += part;
        flux -= flow.quadraticFlux(g, 0);
    }

    for (label teti = first; teti < end; ++teti)
    {
        const scalar part = flux*of_[teti - first].areas[0]/area;
        const label other = tets_[teti].neighbours[0];

        values.outwards[teti] = part;
        if (other >= 0)
        {
            values.outwards[other] = -part;
        }
    }
}


void Foam::cellFluxes::spread
(
    const label first,
    const label n,
    const flowValues& values
)
{
    first_ = first;
    n_ = n;

    const scalar volume = take(values);
    const scalar unit = Foam::sqrt(100/volume);
    const scalar gradientUnit = Foam::sqrt(1000/volume)/cbrt(volume);
    setByCentre(unit, gradientUnit);
    setColumns(volume);
    solve();

    const scalar* potential = missing_.cdata();
    const label celli = tets_[first].vertices[0];
    flowVertex centre(values.vertices[celli]);
    for (label i = 0; i < n; ++i)
    {
        for (direction k = 0; k < 3; ++k)
        {
            centre.u[k] += unit*potential[i]*byCentre(i)[2*k];
        }
        for (direction k = 0; k < 9; ++k)
        {
            centre.gradient[k] +=
                gradientUnit*potential[i]*byCentre(i)[2*(3 + k)];
        }

        flowTetExcess& flux = values.excess[first + i];
        flux[0] = values.outwards[first + i];
        for (label k = 1; k < 4; ++k)
        {
            const label j = tets_[first + i].neighbours[k] - first;
            flux[k] = conductances_[i][k - 1]*(potential[i] - potential[j]);
        }
    }
    values.centres[celli] = centre;
}
