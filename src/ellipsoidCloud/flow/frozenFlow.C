// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "frozenFlow.H"
#include "baffleSides.H"
#include "cellFluxes.H"
#include "foamVersions.H"
#include "indexedOctree.H"
#include "treeDataPoint.H"
#include "undecomposedFlow.H"
#include "volFields.H"
#include "wallPolyPatch.H"
#include "treeBoundBox.H"

#include <algorithm>

// * * * * * * * * * * * * * * Static Data Members * * * * * * * * * * * * * //

const Foam::Enum<Foam::frozenFlow::schemeType> Foam::frozenFlow::schemeNames
({
    { schemeType::stCellPoint, "cellPoint" },
    { schemeType::stDivergenceFree, "divergenceFree" }
});


// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    static inline void copy(const vector& from, scalar to[3])
    {
        std::copy_n(from.v_, 3, to);
    }

    static inline void copy(const tensor& from, scalar (*to)[3])
    {
        std::copy_n(from.v_, 9, &to[0][0]);
    }

    //- Take coordinates beyond a face back to it
    static void toFace(scalar weight[4])
    {
        scalar sum = 0;

        for (int a = 0; a < 4; ++a)
        {
            weight[a] = max(weight[a], scalar(0));
            sum += weight[a];
        }
        for (int a = 0; a < 4; ++a)
        {
            weight[a] /= sum;
        }
    }
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::frozenFlow::sampleOf
(
    const flowValues& values,
    tetCoordinates& c,
    const bool derivatives,
    ellipsoid_flow_sample& sample
) const
{
    const auto gradient =
        [&](const label i) -> const tensor&
        {
            return values.vertex(i).gradient;
        };
    const auto gradp =
        [&](const label i) -> const vector&
        {
            return values.vertices[i].pressureGradient;
        };

    if (pressure_)
    {
        copy(c.back(c.value<vector>(gradp)), sample.pressure_gradient);
    }
    if (pressure_ && derivatives)
    {
        copy(c.back(c.derivatives(gradp)), sample.pressure_jacobian);
    }

    velocityOf
    (
        values,
        c,
        sample.velocity,
        derivatives ? sample.velocity_jacobian : nullptr
    );
    copy(c.back(c.value<tensor>(gradient)), sample.gradient);

    if (derivatives)
    {
        std::fill_n(&sample.gradient_jacobian[0][0][0], 27, scalar(0));

        for (int a = 0; a < 4; ++a)
        {
            const tensor G(c.back(gradient(c.vertices[a])));
            const vector slope(c.back(c.gradient[a]));

            for (int ij = 0; ij < 9; ++ij)
            {
                for (int k = 0; k < 3; ++k)
                {
                    sample.gradient_jacobian[ij/3][ij % 3][k] += slope[k]*G[ij];
                }
            }
        }
    }
}


void Foam::frozenFlow::divergenceFreeAt
(
    const flowValues& values,
    tetCoordinates& c,
    vector& value,
    tensor* derivatives
) const
{
    const tetFlow& flow = flowIn(values, c);

    if (*std::min_element(c.weight, c.weight + 4) >= -1e-9)
    {
        flow.evaluate(c.gradient, c.weight, value, derivatives);
        return;
    }

    // Beyond an open patch, what is not linear stays as it is there
    scalar inside[4];
    std::copy_n(c.weight, 4, inside);
    toFace(inside);

    flow.evaluate(c.gradient, inside, value, derivatives);
    for (int a = 0; a < 4; ++a)
    {
        value += (c.weight[a] - inside[a])*values.vertex(c.vertices[a]).u;
    }
}


void Foam::frozenFlow::velocityOf
(
    const flowValues& values,
    tetCoordinates& c,
    scalar velocity[3],
    scalar (*jacobian)[3]
) const
{
    if (scheme_ == stDivergenceFree)
    {
        vector value;
        tensor derivatives;

        divergenceFreeAt(values, c, value, jacobian ? &derivatives : nullptr);
        copy(c.back(value), velocity);
        if (jacobian)
        {
            copy(c.back(derivatives), jacobian);
        }
        return;
    }

    const linearFlow& linear = linearIn(values, c);

    vector value(Zero);
    for (int a = 0; a < 4; ++a)
    {
        value += c.weight[a]*linear.u[a];
    }
    copy(c.back(value), velocity);
    if (jacobian)
    {
        copy(c.back(linear.derivatives), jacobian);
    }
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::frozenFlow::frozenFlow
(
    const undecomposedFlow& undecomposed,
    const schemeType scheme,
    const labelHashSet& unreached,
    const autoPtr<volVectorField>& E,
    const bool pressure,
    const bool unsteady
)
:
    scheme_(scheme),
    pressure_(pressure),
    unsteady_(unsteady),
    start_(0),
    end_(0),
    fluxes_(new cellFluxes(tets_)),
    images_(undecomposed.mesh(), unreached)
{
    make(undecomposed, E);

    if (Pstream::master())
    {
        findAcross(undecomposed);

        for (const polyPatch& pp : undecomposed.mesh().boundaryMesh())
        {
            patchLocation_.append
            (
                isA<wallPolyPatch>(pp) ? pBeyondWall
              : images_.at(pp.index()) ? pBeyondSeam
              : polyPatch::constraintType(pp.type()) ? pBeyondCoupled
              : pBeyondOpen
            );
        }
    }

    broadcast(patchLocation_);
    broadcast(tetAcross_);
    images_.share();

    centres_.setSize(cellTets_.size() - 1);
    forAll(centres_, celli)
    {
        centres_[celli] = values_.vertices[celli].x;
    }

    const boundBox box(centres_, false);
    // One mesh cell alone has a box without extent
    const vector margin
    (
        (centres_.size() > 1 ? 0.01*box.mag() : 1e-6)*vector::one
    );

    centreTree_.reset
    (
        new indexedOctree<treeDataPoint>
        (
            treeDataPoint(centres_),
            treeBoundBox(box.min() - margin, box.max() + margin),
            10,
            10,
            3
        )
    );
}


// * * * * * * * * * * * * * * * * Destructor  * * * * * * * * * * * * * * * //

Foam::frozenFlow::~frozenFlow() = default;


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::frozenFlow::renew
(
    const undecomposedFlow& undecomposed,
    const scalar rho
)
{
    values_.close();

    if (Pstream::master())
    {
        const undecomposedFlow::serialScope serial;

        setFlow(undecomposed, rho, baffleSides(undecomposed.mesh()));
    }

    values_.share();
}


void Foam::frozenFlow::advance
(
    const undecomposedFlow& undecomposed,
    const scalar rho,
    const scalar start,
    const scalar end
)
{
    if (laterValues_.vertices.empty())
    {
        laterValues_.copy(values_);
    }

    // What was the flow at the start of the last step is that at the end of this
    renew(undecomposed, rho);
    laterValues_.swap(values_);

    start_ = start;
    end_ = end;
}


void Foam::frozenFlow::sample
(
    const scalar t,
    tetCoordinates& c,
    const bool derivatives,
    ellipsoid_flow_sample& sample
) const
{
    sampleOf(values_, c, derivatives, sample);

    if (laterValues_.vertices.empty())
    {
        return;
    }

    ellipsoid_flow_sample later = {};
    sampleOf(laterValues_, c, derivatives, later);

    const auto mix =
        [&](double* value, const double* at, const int n, double* rate)
        {
            for (int i = 0; i < n; ++i)
            {
                const double change = at[i] - value[i];

                value[i] += passed(t)*change;
                if (rate)
                {
                    rate[i] = change/(end_ - start_);
                }
            }
        };

    mix(sample.velocity, later.velocity, 3, sample.local_acceleration);
    mix(sample.gradient[0], later.gradient[0], 9, nullptr);
    if (pressure_)
    {
        mix(sample.pressure_gradient, later.pressure_gradient, 3, nullptr);
    }
    if (derivatives)
    {
        mix
        (
            sample.velocity_jacobian[0], later.velocity_jacobian[0], 9,
            sample.acceleration_jacobian[0]
        );
        mix
        (
            sample.gradient_jacobian[0][0], later.gradient_jacobian[0][0], 27,
            nullptr
        );
    }
    if (pressure_ && derivatives)
    {
        mix
        (
            sample.pressure_jacobian[0], later.pressure_jacobian[0], 9, nullptr
        );
    }
}


void Foam::frozenFlow::velocity
(
    const scalar t,
    tetCoordinates& c,
    scalar velocity[3],
    scalar (*jacobian)[3]
) const
{
    velocityOf(values_, c, velocity, jacobian);

    if (laterValues_.vertices.empty())
    {
        return;
    }

    scalar later[3];
    scalar laterJacobian[3][3];
    velocityOf
    (
        laterValues_, c, later, jacobian ? laterJacobian : nullptr
    );

    for (int i = 0; i < 3; ++i)
    {
        velocity[i] += passed(t)*(later[i] - velocity[i]);
        for (int j = 0; jacobian && j < 3; ++j)
        {
            jacobian[i][j] += passed(t)*(laterJacobian[i][j] - jacobian[i][j]);
        }
    }
}


void Foam::frozenFlow::field
(
    const tetCoordinates& c,
    scalar field[3],
    scalar (*jacobian)[3]
) const
{
    const auto E = [&](const label i) -> const vector& { return field_[i]; };

    copy(c.back(c.value<vector>(E)), field);
    if (jacobian)
    {
        copy(c.back(c.derivatives(E)), jacobian);
    }
}


void Foam::frozenFlow::velocity
(
    const scalar t,
    const scalar x[3],
    const probe& from,
    scalar velocity[3],
    scalar (*jacobian)[3]
) const
{
    probe at(from);
    tetCoordinates c;

    if (walk(pointOf(x), at, c) == pBeyondWall)
    {
        toFace(c.weight);
        this->velocity(t, c, velocity, nullptr);
        if (jacobian)
        {
            copy(tensor::zero, jacobian);
        }
        return;
    }

    this->velocity(t, c, velocity, jacobian);
}
