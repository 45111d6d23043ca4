// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "meshFlow.H"
#include "baffleSides.H"
#include "cellFluxes.H"
#include "foamVersions.H"
#include "indexedOctree.H"
#include "pointImages.H"
#include "treeBoundBox.H"
#include "treeDataPoint.H"
#include "undecomposedFlow.H"
#include "volFields.H"
#include "wallPolyPatch.H"

#include <algorithm>

// * * * * * * * * * * * * * * Static Data Members * * * * * * * * * * * * * //

const Foam::Enum<Foam::meshFlow::schemeType> Foam::meshFlow::schemeNames
({
    { schemeType::stCellPoint, "cellPoint" },
    { schemeType::stDivergenceFree, "divergenceFree" }
});


// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- Take a value at the start of a time step to that after a part of it
    template<class Type>
    static void goOn(Type& value, const Type& later, const scalar part)
    {
        value += part*(later - value);
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

void Foam::meshFlow::sampleOf
(
    const flowValues& values,
    tetCoordinates& c,
    const bool derivatives,
    flowSample& sample
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
        sample.pressureGradient = c.back(c.value<vector>(gradp));
        if (derivatives)
        {
            sample.pressureDerivatives = c.back(c.derivatives(gradp));
        }
    }

    sample.velocity =
        velocityOf(values, c, derivatives ? &sample.derivatives : nullptr);
    sample.gradient = c.back(c.value<tensor>(gradient));

    if (derivatives)
    {
        std::fill_n(sample.gradientDerivatives, 27, scalar(0));

        for (int a = 0; a < 4; ++a)
        {
            const tensor G(c.back(gradient(c.vertices[a])));
            const vector slope(c.back(c.gradient[a]));

            for (int ij = 0; ij < 9; ++ij)
            {
                for (int k = 0; k < 3; ++k)
                {
                    sample.gradientDerivatives[3*ij + k] += slope[k]*G[ij];
                }
            }
        }
    }
}


const Foam::tetFlow& Foam::meshFlow::flowIn
(
    const flowValues& values,
    tetCoordinates& c
) const
{
    if (c.flowOf != values.vertices.cdata())
    {
        const auto vertex =
            [&](const int a) -> const flowVertex&
            {
                return values.vertex(c.vertices[a]);
            };

        balance(values, c.vertices[0]);
        c.flowOf = values.vertices.cdata();
        c.flow.set
        (
            c.gradient,
            vertex,
            values.excess[c.tet].cdata(),
            values.straight[c.tet]
        );
    }

    return c.flow;
}


Foam::vector Foam::meshFlow::velocityOf
(
    const flowValues& values,
    tetCoordinates& c,
    tensor* derivatives
) const
{
    const auto u =
        [&](const label i) -> const vector&
        {
            return values.vertex(i).u;
        };
    vector value(Zero);

    if (scheme_ == stCellPoint)
    {
        value = c.value<vector>(u);
        if (derivatives)
        {
            *derivatives = c.derivatives(u);
        }
    }
    else
    {
        const tetFlow& flow = flowIn(values, c);
        scalar inside[4];
        std::copy_n(c.weight, 4, inside);

        // Beyond an open patch, what is not linear stays as it is there
        const bool beyond = *std::min_element(inside, inside + 4) < -1e-9;
        if (beyond)
        {
            toFace(inside);
        }
        flow.evaluate(c.gradient, inside, value, derivatives);
        for (int a = 0; beyond && a < 4; ++a)
        {
            value += (c.weight[a] - inside[a])*u(c.vertices[a]);
        }
    }

    if (derivatives)
    {
        *derivatives = c.back(*derivatives);
    }
    return c.back(value);
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::meshFlow::meshFlow
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
    fluxes_(new cellFluxes(tets_)),
    images_(undecomposed.mesh(), unreached)
{
    make(undecomposed, E);

    if (Pstream::master())
    {
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
        centres_[celli] = values_->vertices[celli].x;
    }

    const boundBox box(centres_, false);
    // One mesh cell alone has a box without extent
    const scalar margin = centres_.size() > 1 ? 0.01*box.mag() : 1e-6;

    centreTree_.reset
    (
        new indexedOctree<treeDataPoint>
        (
            treeDataPoint(centres_),
            treeBoundBox(widened(box, margin)),
            10,
            10,
            3
        )
    );
}


// * * * * * * * * * * * * * * * * Destructor  * * * * * * * * * * * * * * * //

Foam::meshFlow::~meshFlow() = default;


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::meshFlow::renew
(
    const undecomposedFlow& undecomposed,
    const scalar rho
)
{
    values_->close();

    if (Pstream::master())
    {
        const undecomposedFlow::serialScope serial;
        setFlow(undecomposed, rho);
    }

    values_->share();
}


void Foam::meshFlow::advance
(
    const undecomposedFlow& undecomposed,
    const scalar rho,
    const scalar start,
    const scalar end
)
{
    // The start of the last step becomes the end of this; before the first step
    // there is only a start
    if (!accelerates())
    {
        std::swap(values_, laterValues_);
    }
    renew(undecomposed, rho);
    std::swap(values_, laterValues_);

    start_ = start;
    end_ = end;
}


void Foam::meshFlow::sample
(
    const scalar t,
    tetCoordinates& c,
    const bool derivatives,
    flowSample& sample
) const
{
    sampleOf(*values_, c, derivatives, sample);

    if (!accelerates())
    {
        return;
    }

    flowSample later;
    sampleOf(*laterValues_, c, derivatives, later);

    const scalar part = passed(t);
    const scalar dt = end_ - start_;
    sample.acceleration = (later.velocity - sample.velocity)/dt;
    goOn(sample.velocity, later.velocity, part);
    goOn(sample.gradient, later.gradient, part);
    if (pressure_)
    {
        goOn(sample.pressureGradient, later.pressureGradient, part);
        if (derivatives)
        {
            goOn(sample.pressureDerivatives, later.pressureDerivatives, part);
        }
    }
    if (derivatives)
    {
        sample.accelerationDerivatives =
            (later.derivatives - sample.derivatives)/dt;
        goOn(sample.derivatives, later.derivatives, part);
        for (int i = 0; i < 27; ++i)
        {
            goOn
            (
                sample.gradientDerivatives[i], later.gradientDerivatives[i],
                part
            );
        }
    }
}


Foam::vector Foam::meshFlow::velocity
(
    const scalar t,
    tetCoordinates& c,
    tensor* derivatives
) const
{
    vector value(velocityOf(*values_, c, derivatives));

    if (!accelerates())
    {
        return value;
    }

    tensor laterDerivatives;
    const vector later
    (
        velocityOf(*laterValues_, c, derivatives ? &laterDerivatives : nullptr)
    );

    if (derivatives)
    {
        goOn(*derivatives, laterDerivatives, passed(t));
    }
    goOn(value, later, passed(t));
    return value;
}


Foam::vector Foam::meshFlow::velocityIn
(
    const label celli,
    const point& x,
    probe& at,
    tetCoordinates& c
) const
{
    if (at.tet < 0 || cell(at) != celli)
    {
        at.tet = cellTets_[celli];
    }
    if (reach(x, at, c))
    {
        return velocity(0, c);
    }

    // The way from one tetrahedron of a mesh cell that is not convex may meet a
    // wall where that from another does not
    locationType location = pBeyondWall;
    for
    (
        label teti = cellTets_[celli];
        location == pBeyondWall && teti < cellTets_[celli + 1];
        ++teti
    )
    {
        at.tet = teti;
        location = walk(x, at, c);
    }
    if (location == pBeyondWall)
    {
        toFace(c.weight);
    }
    return velocity(0, c);
}


Foam::vector Foam::meshFlow::field
(
    const tetCoordinates& c,
    tensor* derivatives
) const
{
    const auto E = [&](const label i) -> const vector& { return field_[i]; };

    if (derivatives)
    {
        *derivatives = c.back(c.derivatives(E));
    }
    return c.back(c.value<vector>(E));
}


Foam::vector Foam::meshFlow::velocity
(
    const scalar t,
    const point& x,
    const probe& from,
    tensor* derivatives
) const
{
    probe at(from);
    tetCoordinates c;

    if (walk(x, at, c) == pBeyondWall)
    {
        toFace(c.weight);
        if (derivatives)
        {
            *derivatives = Zero;
        }
        return velocity(t, c);
    }

    return velocity(t, c, derivatives);
}
