// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "cellFluxes.H"
#include "tetFlow.H"

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::scalar Foam::cellFluxes::take(const flowValues& values)
{
    nPairs_ = (n_ + 1)/2;
    of_.setSize(n_);
    conductances_.setSize(n_);
    missing_.setSize(nPairs_);
    missing_[nPairs_ - 1] = numberPair{0, 0};
    scalar* missing = numbers(missing_);
    scalar volume = 0;
    scalar net = 0;

    for (label i = 0; i < n_; ++i)
    {
        const auto vertex =
            [&](const int a) -> const flowVertex&
            {
                return values.vertices[tets_[first_ + i].vertices[a]];
            };

        tetFlow flow;
        vector g[4];
        flow.setQuadratic(vertex, values.straight[first_ + i]);
        flow.coordinateGradients(g);
        tetSize& of = of_[i];
        of.volume = flow.volume();
        missing[i] = -values.outwards[first_ + i];
        for (label k = 0; k < 4; ++k)
        {
            of.areas[k] = 3*mag(of.volume*g[k]);
            missing[i] -= flow.quadraticFlux(g, k);
        }
        net += missing[i];
        volume += mag(of.volume);
    }

    // A flow that is not free of divergence has it everywhere in the mesh cell
    const scalar divergence = net/volume;
    for (label i = 0; i < n_; ++i)
    {
        missing[i] -= divergence*mag(of_[i].volume);
    }
    return volume;
}


void Foam::cellFluxes::setByCentre
(
    const UList<flowVertex>& vertices,
    const scalar unit,
    const scalar gradientUnit
)
{
    byCentre_.setSize(nCentre*nPairs_);
    for (direction k = 0; k < nCentre; ++k)
    {
        byCentre_[(k + 1)*nPairs_ - 1] = numberPair{0, 0};
    }
    scalar* byCentre = numbers(byCentre_);
    const label stride = 2*nPairs_;

    for (label i = 0; i < n_; ++i)
    {
        const flowTet& tet = tets_[first_ + i];
        const point& origin = vertices[tet.vertices[0]].x;
        vector edges[4];
        for (label a = 0; a < 4; ++a)
        {
            edges[a] = vertices[tet.vertices[a]].x - origin;
        }

        // A third of the areas of the faces, inwards
        const vector S[4] =
        {
            ((edges[2] - edges[1]) ^ (edges[1] - edges[3]))/6,
            (edges[2] ^ edges[3])/6,
            (edges[3] ^ edges[1])/6,
            (edges[1] ^ edges[2])/6
        };
        tensor byGradient(Zero);
        for (label a = 1; a < 4; ++a)
        {
            byGradient += (gradientUnit/8)*(S[0] + S[a])*edges[a];
        }

        for (direction k = 0; k < 3; ++k)
        {
            byCentre[k*stride + i] = unit*S[0][k];
        }
        for (direction k = 0; k < 9; ++k)
        {
            byCentre[(3 + k)*stride + i] = byGradient[k];
        }
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
            const scalar factor = byCentre_[k*nPairs_ + j/2][j % 2];
            factors[k] = numberPair{factor, factor};
        }

        for (label p = j/2; p < nPairs_; ++p)
        {
            numberPair sum = {0, 0};
            for (direction k = 0; k < nCentre; ++k)
            {
                sum += byCentre_[k*nPairs_ + p]*factors[k];
            }
            columns_[j*nPairs_ + p] = sum;
        }
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
    scalar* x = numbers(missing_);

    // Each column is taken from all later ones, and from the right-hand side
    for (label k = 0; k < n_; ++k)
    {
        numberPair* column = columns_.data() + k*nPairs_;
        scalar& diagonal = numbers(columns_)[2*k*nPairs_ + k];
        if (!(diagonal > 0))
        {
            FatalErrorInFunction
                << "the fluxes in mesh cell " << tets_[first_].vertices[0]
                << " cannot be balanced: checkMesh says more"
                << exit(FatalError);
        }

        const scalar root = Foam::sqrt(diagonal);
        const numberPair roots = {root, root};
        for (label p = k/2; p < nPairs_; ++p)
        {
            column[p] /= roots;
        }
        diagonal = root;

        x[k] /= root;
        const numberPair known = {x[k], x[k]};
        if (k % 2 == 0)
        {
            x[k + 1] -= column[k/2][1]*x[k];
        }
        for (label p = k/2 + 1; p < nPairs_; ++p)
        {
            missing_[p] -= column[p]*known;
        }

        for (label j = k + 1; j < n_; ++j)
        {
            numberPair* later = columns_.data() + j*nPairs_;
            const scalar factor = column[j/2][j % 2];
            const numberPair factors = {factor, factor};
            for (label p = j/2; p < nPairs_; ++p)
            {
                later[p] -= column[p]*factors;
            }
        }
    }

    for (label i = n_; i-- > 0;)
    {
        const scalar* column = numbers(columns_) + 2*i*nPairs_;
        scalar sum = x[i];
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
    setByCentre(values.vertices, unit, gradientUnit);
    setColumns(volume);
    solve();

    const scalar* potential = numbers(missing_);
    const scalar* byCentre = numbers(byCentre_);
    const label stride = 2*nPairs_;
    const label celli = tets_[first].vertices[0];
    flowVertex centre(values.vertices[celli]);
    for (label i = 0; i < n; ++i)
    {
        for (direction k = 0; k < 3; ++k)
        {
            centre.u[k] += unit*potential[i]*byCentre[k*stride + i];
        }
        for (direction k = 0; k < 9; ++k)
        {
            centre.gradient[k] +=
                gradientUnit*potential[i]*byCentre[(3 + k)*stride + i];
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
