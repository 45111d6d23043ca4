/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/
#include "partitionOfUnity.H"
#include "partitionWeights.H"
#include "baffleSides.H"
#include "pointImages.H"
#include "domainImages.H"
#include "frozenFlow.H"
#include "undecomposedFlow.H"
#include "volFields.H"
#include "wallPolyPatch.H"
#include "wallsAtVertices.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- From the centre of a mesh cell to where its weight ends [mesh cells]
    static const scalar supportRadius = 1.5;

    //- Take a polynomial to the nearest without divergence, of the same mean
    //  over a mesh cell with these second moments
    static void removeDivergence(const symmTensor& moments, quadratic& p)
    {
        p.gradient -= tr(p.gradient)/3*tensor::I;

        // Slope of the divergence
        vector D(Zero);
        for (direction i = 0; i < 3; ++i)
        {
            vector e(Zero);
            e[i] = 1;
            D += p.curvature[i] & e;
        }
        for (direction i = 0; i < 3; ++i)
        {
            vector e(Zero);
            e[i] = 1;
            const symmTensor change(0.25*twoSymm(e*D));
            p.curvature[i] -= change;
            p.value[i] += 0.5*(change && moments);
        }
    }

    //- The polynomial of a mesh cell next to a wall that has the velocity of
    //  the wall on the plane n.d = h: with L = n.d - h along the wall
    //  L (a + b.d - c L/2) and normal to it C L2/2, C such that there is no
    //  divergence. The mean along the wall is that of the mesh cell.
    static quadratic fitAtWall
    (
        const quadratic& fit,
        const symmTensor& moments,
        const vector& mean,
        const vector& wallVelocity,
        const vector& n,
        const scalar h
    )
    {
        const tensor along(tensor::I - n*n);
        const tensor b
        (
            along
          & tensor
            (
                fit.curvature[0] & n, fit.curvature[1] & n, fit.curvature[2] & n
            )
        );
        const vector Mn(moments & n);
        const vector c(b & n);
        const scalar C = -tr(b);
        const vector a
        (
            (
                (b & Mn) - 0.5*((n & Mn) + sqr(h))*c
              - (along & (mean - wallVelocity))
            )/h
        );
        const vector k(C*n - c);

        quadratic p;
        p.value = wallVelocity - h*a + 0.5*sqr(h)*k;
        p.gradient = (a - h*k)*n - h*b;
        for (direction i = 0; i < 3; ++i)
        {
            const vector bi(b[3*i], b[3*i + 1], b[3*i + 2]);
            p.curvature[i] = twoSymm(n*bi) + k[i]*sqr(n);
        }
        return p;
    }

    //- A polynomial of the image
    static quadratic turned(const quadratic& p, const tensor& T)
    {
        quadratic result(p);
        result.value = T & p.value;
        result.gradient = T & p.gradient & T.T();
        turnCurvature(T, result.curvature);
        return result;
    }
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::DynamicList<Foam::wallTriangle> Foam::partitionOfUnity::findTriangles
(
    const polyMesh& mesh
)
{
    DynamicList<wallTriangle> triangles;
    DynamicList<label> faces;

    // Tetrahedra are those of a mesh cell's faces in turn
    for (label celli = 0, teti = 0; celli < mesh.nCells(); ++celli)
    {
        const label first = triangles.size();

        for (const label facei : mesh.cells()[celli])
        {
            const label patchi = mesh.boundaryMesh().whichPatch(facei);
            const bool isWall =
                patchi >= 0 && isA<wallPolyPatch>(mesh.boundaryMesh()[patchi]);

            for (label n = mesh.faces()[facei].size() - 2; n > 0; --n, ++teti)
            {
                if (!isWall)
                {
                    continue;
                }

                wallTriangle t;
                for (label k = 0; k < 3; ++k)
                {
                    const label vertexi = mesh_.tets[teti].vertices[k + 1];
                    t.corners[k] = mesh_.vertices[vertexi].x;
                }
                t.normal =
                    (t.corners[1] - t.corners[0])
                  ^ (t.corners[2] - t.corners[0]);
                if (mag(t.normal) <= 0)
                {
                    continue;
                }
                t.normal /= mag(t.normal);

                const scalar h =
                    t.normal & (t.corners[0] - mesh.cellCentres()[celli]);
                t.inverseSquare = 1/max(sqr(h), ROOTVSMALL);
                t.cell = celli;
                t.fit = celli;
                triangles.append(t);
                faces.append(facei);
            }
        }

        // Next to one plane a mesh cell has the polynomial of the wall itself
        bool isFlat = true;
        for (label i = first; i < triangles.size(); ++i)
        {
            isFlat =
                isFlat
             && (triangles[i].normal & triangles[first].normal) > 1 - 1e-6;
        }
        for (label i = first; i < triangles.size(); ++i)
        {
            triangles[i].fit = isFlat ? celli : nFits_++;
        }
    }

    faces_ = faces;
    return triangles;
}


void Foam::partitionOfUnity::addImages(DynamicList<wallTriangle>& triangles)
{
    const label nCells = moments_.size();
    const labelList firstOf
    (
        partitionNeighbours::firstTriangles(nCells, triangles)
    );

    forAll(images_, i)
    {
        const imageCell& image = images_[i];
        const bool mirrors = image.image.mirrors();

        for
        (
            label of = firstOf[image.cell];
            of < firstOf[image.cell + 1];
            ++of
        )
        {
            wallTriangle t(triangles[of]);
            for (label k = 0; k < 3; ++k)
            {
                t.corners[k] =
                    image.image(triangles[of].corners[mirrors ? 2 - k : k]);
            }
            t.normal = image.image.turn() & t.normal;
            t.cell = nCells + i;
            t.fit = t.fit == image.cell ? t.cell : nFits_++;
            triangles.append(t);
            imagesOf_.append(of);
        }
    }
}


void Foam::partitionOfUnity::setSupports(const polyMesh& mesh)
{
    forAll(supports_, i)
    {
        const label imagei = i - mesh.nCells();
        const label celli = imagei < 0 ? i : images_[imagei].cell;

        // A mesh cell of edges a has moments of a2/12
        const symmTensor& M = moments_[celli];
        weightSupport& support = supports_[i];

        support.x = mesh.cellCentres()[celli];
        support.metric = inv(M)/(12*sqr(supportRadius));
        support.farthest = 12*sqr(supportRadius)*cmptMax(eigenValues(M));

        if (imagei >= 0)
        {
            const isometry& image = images_[imagei].image;
            support.x = image(support.x);
            support.metric = transform(image.turn(), support.metric);
        }
    }
}


Foam::quadratic Foam::partitionOfUnity::fitOf
(
    const wallTriangle& t,
    const label facei,
    const volVectorField& U,
    const UList<quadratic>& ofCells
) const
{
    const polyBoundaryMesh& patches = U.mesh().boundaryMesh();
    const label patchi = patches.whichPatch(facei);

    return fitAtWall
    (
        ofCells[t.cell],
        moments_[t.cell],
        U[t.cell],
        U.boundaryField()[patchi][facei - patches[patchi].start()],
        t.normal,
        t.normal & (t.corners[0] - supports_[t.cell].x)
    );
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::partitionOfUnity::make
(
    const polyMesh* mesh,
    const baffleSides* baffles,
    const domainImages& images
)
{
    DynamicList<wallTriangle> triangles;
    autoPtr<partitionCells> cells;

    if (mesh)
    {
        const undecomposedFlow::serialScope serial;
        cells.reset(new partitionCells(*mesh, *baffles, images));
    }
    supports_.reset(mesh ? cells->size() : 0);

    if (mesh)
    {
        const undecomposedFlow::serialScope serial;

        moments_ = secondMoments(*mesh);
        images_ = cells->images();
        nFits_ = cells->size();
        triangles = findTriangles(*mesh);
        addImages(triangles);
        setSupports(*mesh);
    }

    broadcast(nFits_);
    triangles_.fill(triangles);
    supports_.share();
    neighbours_.make(cells.get());
}


void Foam::partitionOfUnity::setFits
(
    const volVectorField& U,
    const baffleSides& baffles,
    const pointImages& images,
    UList<quadraticTerms>& fits
) const
{
    const label nCells = moments_.size();
    const wallsAtVertices walls(U, baffles);
    List<quadratic> ofCells(cellFits(U, baffles, images, walls, moments_));

    forAll(ofCells, celli)
    {
        removeDivergence(moments_[celli], ofCells[celli]);
        fits[celli] = termsOf(ofCells[celli]);
    }
    forAll(images_, i)
    {
        const imageCell& image = images_[i];
        fits[nCells + i] =
            termsOf(turned(ofCells[image.cell], image.image.turn()));
    }

    forAll(faces_, i)
    {
        const wallTriangle& t = triangles_[i];
        fits[t.fit] = termsOf(fitOf(t, faces_[i], U, ofCells));
    }
    forAll(imagesOf_, i)
    {
        const wallTriangle& t = triangles_[faces_.size() + i];
        const label of = imagesOf_[i];

        fits[t.fit] = termsOf
        (
            turned
            (
                fitOf(triangles_[of], faces_[of], U, ofCells),
                images_[t.cell - nCells].image.turn()
            )
        );
    }
}


template<int order>
Foam::weightedSums Foam::partitionOfUnity::sumsAt
(
    const UList<quadraticTerms>& fits,
    const label celli,
    const point& x
) const
{
    const weightsNear& near = neighbours_.in(celli);
    const label* sources = neighbours_.sources(near);
    const vector r(x - supports_[celli].x);
    const int octant = (r.x() >= 0) + 2*(r.y() >= 0) + 4*(r.z() >= 0);
    const uint64_t* mask = neighbours_.masks(near) + octant;
    weightedSums sums = {};
    weightAt w;

    for (label from = 0; from < near.n; from += 64, mask += 8)
    {
        for (uint64_t left = *mask; left; left &= left - 1)
        {
            const label k = from + __builtin_ctzll(left);
            const label i = sources[k];

            if (k < near.nCells)
            {
                const weightSupport& support = supports_[i];
                const vector d(x - support.x);
                if (weightOf<order>(support, d, w))
                {
                    sums.add<order>(fits[i], d, w);
                }
                continue;
            }

            const wallTriangle& t = triangles_[i];
            if (weightOf<order>(t, x, w))
            {
                sums.add<order>(fits[t.fit], x - supports_[t.cell].x, w);
            }
        }
    }
    if (!(sums.w > 0))
    {
        // Beyond all weights, in a corner of a mesh cell that is far from a box
        w = weightAt{1, vector(Zero), symmTensor(Zero)};
        sums.add<order>(fits[celli], r, w);
    }

    return sums;
}


void Foam::partitionOfUnity::evaluate
(
    const UList<quadraticTerms>& fits,
    const label celli,
    const point& x,
    vector& u,
    tensor* gradient,
    symmTensor* curvature
) const
{
    const weightedSums sums
    (
        curvature ? sumsAt<2>(fits, celli, x)
      : gradient ? sumsAt<1>(fits, celli, x)
      : sumsAt<0>(fits, celli, x)
    );

    for (direction i = 0; i < 3; ++i)
    {
        u[i] = component(sums.u, i)/sums.w;
        if (!gradient)
        {
            continue;
        }

        vector slope;
        for (direction j = 0; j < 3; ++j)
        {
            slope[j] =
                (component(sums.uSlope[j], i) - u[i]*sums.wSlope[j])/sums.w;
            (*gradient)[3*i + j] = slope[j];
        }

        for (direction k = 0; curvature && k < 6; ++k)
        {
            curvature[i][k] =
                component(sums.uCurvature[k], i) - u[i]*sums.wCurvature[k];
        }
        if (curvature)
        {
            curvature[i] =
                (curvature[i] - twoSymm(slope*sums.wSlope))/sums.w;
        }
    }
}


// ************************************************************************* //
