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

void Foam::meshFlow::visit(const label teti, visitedTet& in) const
{
    const label* v = tets_[teti].vertices;
    const UList<flowVertex>& vertices = values_->vertices;

    in.tet = teti;
    in.vertices = v;
    in.sound = !unsound_.found(teti);
    in.flowOf = nullptr;
    in.origin = vertices[v[0]].x;

    const vector edges[3] =
    {
        vertices[v[1]].x - in.origin,
        vertices[v[2]].x - in.origin,
        vertices[v[3]].x - in.origin
    };

    tetFlow::setCoordinateGradients(edges, in.gradient);
}


void Foam::meshFlow::setFlowIn
(
    const flowValues& values,
    visitedTet& in
) const
{
    const bool conservative = scheme_ == stDivergenceFree;
    const auto vertex =
        [&](const int a) -> const flowVertex& { return *in.corners[a]; };

    if (conservative)
    {
        balance(values, in.vertices[0]);
    }
    for (int a = 0; a < 4; ++a)
    {
        in.corners[a] = &values.vertex(in.vertices[a]);
    }
    if (conservative)
    {
        in.flow.set
        (
            in.gradient,
            vertex,
            values.excess[in.tet].cdata(),
            values.straight[in.tet]
        );
    }
    in.flowOf = values.vertices.cdata();
}


Foam::vector Foam::meshFlow::velocityBeyond
(
    const visitedTet& in,
    const tetCoordinates& c,
    tensor* derivatives
) const
{
    const scalar* l = c.weight;
    vector value;

    if (scheme_ == stCellPoint)
    {
        const scalar* at[4];
        in.take(&flowVertex::u, at);
        in.combine<3>(at, l, value.v_);
        if (derivatives)
        {
            in.differentiate<3>(at, derivatives->v_);
        }
    }
    else
    {
        scalar inside[4];
        std::copy_n(l, 4, inside);

        // Beyond an open patch, what is not linear stays as it is there
        const bool beyond = *std::min_element(inside, inside + 4) < -1e-9;
        if (beyond)
        {
            toFace(inside);
        }
        in.flow.evaluate(in.gradient, inside, value, derivatives);
        for (int a = 0; beyond && a < 4; ++a)
        {
            value += (l[a] - inside[a])*in.corners[a]->u;
        }
    }

    if (derivatives)
    {
        *derivatives = c.back(*derivatives);
    }
    return c.back(value);
}


void Foam::meshFlow::sampleOf
(
    const flowValues& values,
    const tetCoordinates& c,
    const bool derivatives,
    flowSample& sample
) const
{
    const visitedTet& in = flowIn(values, c.tet);
    const scalar* at[4];

    if (pressure_)
    {
        vector gradp;
        in.take(&flowVertex::pressureGradient, at);
        in.combine<3>(at, c.weight, gradp.v_);
        sample.pressureGradient = c.back(gradp);
        if (derivatives)
        {
            tensor byPosition;
            in.differentiate<3>(at, byPosition.v_);
            sample.pressureDerivatives = c.back(byPosition);
        }
    }

    sample.velocity =
        velocityOf(in, c, derivatives ? &sample.derivatives : nullptr);

    tensor G;
    in.take(&flowVertex::gradient, at);
    in.combine<9>(at, c.weight, G.v_);
    sample.gradient = c.back(G);

    if (derivatives)
    {
        scalar* to = sample.gradientDerivatives;
        in.differentiate<9>(at, to);
        if (c.turned)
        {
            tensor along[3];
            for (int i = 0; i < 27; ++i)
            {
                along[i % 3][i/3] = to[i];
            }
            for (tensor& T : along)
            {
                T = c.back(T);
            }
            for (int ij = 0; ij < 9; ++ij, to += 3)
            {
                const vector d(along[0][ij], along[1][ij], along[2][ij]);
                std::copy_n(c.back(d).v_, 3, to);
            }
        }
    }
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
    visited_(nVisited),
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
    visited_ = visitedTet();

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


void Foam::meshFlow::goOnTo
(
    const scalar t,
    const tetCoordinates& c,
    const bool derivatives,
    flowSample& sample
) const
{
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


Foam::vector Foam::meshFlow::velocityBetween
(
    const scalar t,
    const tetCoordinates& c,
    tensor* derivatives
) const
{
    vector value(velocityOf(flowIn(*values_, c.tet), c, derivatives));
    tensor laterDerivatives;
    const vector later
    (
        velocityOf
        (
            flowIn(*laterValues_, c.tet), c,
            derivatives ? &laterDerivatives : nullptr
        )
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
    const visitedTet& in = visited(c.tet);
    const scalar* at[4];
    vector E;

    for (int a = 0; a < 4; ++a)
    {
        at[a] = field_[in.vertices[a]].cdata();
    }
    if (derivatives)
    {
        in.differentiate<3>(at, derivatives->v_);
        *derivatives = c.back(*derivatives);
    }
    in.combine<3>(at, c.weight, E.v_);
    return c.back(E);
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
