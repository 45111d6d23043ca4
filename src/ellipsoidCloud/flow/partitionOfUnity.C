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
#include "cyclicPoints.H"
#include "domainImages.H"
#include "frozenFlow.H"
#include "bitSet.H"
#include "undecomposedFlow.H"
#include "volFields.H"
#include "wallPolyPatch.H"

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

    //- Add the mesh cells that share a vertex with one, unless listed for it
    static void appendAround
    (
        const polyMesh& mesh,
        const baffleSides& baffles,
        const label celli,
        const label listedFor,
        labelList& listed,
        DynamicList<label>& cells
    )
    {
        const bool split = baffles.sides().size();

        for (const label pointi : mesh.cellPoints()[celli])
        {
            for (const label other : mesh.pointCells()[pointi])
            {
                if
                (
                    listed[other] != listedFor
                 && (
                        !split
                     || baffles.vertex(pointi, other)
                     == baffles.vertex(pointi, celli)
                    )
                )
                {
                    listed[other] = listedFor;
                    cells.append(other);
                }
            }
        }
    }

    //- Make a shared list of what the master has; collective
    template<class Type>
    static void fill(sharedList<Type>& list, const UList<Type>& from)
    {
        list.reset(from.size());
        if (Pstream::master())
        {
            list.deepCopy(from);
        }
        list.share();
    }
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::DynamicList<Foam::wallTriangle> Foam::partitionOfUnity::findTriangles
(
    const polyMesh& mesh,
    const UList<flowTet>& tets,
    const UList<flowVertex>& vertices
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
                    t.corners[k] = vertices[tets[teti].vertices[k + 1]].x;
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


void Foam::partitionOfUnity::findNear
(
    const polyMesh& mesh,
    const baffleSides& baffles,
    const UList<wallTriangle>& triangles,
    DynamicList<label>& cells,
    DynamicList<label>& trianglesNear
)
{
    labelList firstOf(mesh.nCells() + 1, triangles.size());
    for (label i = triangles.size(), celli = mesh.nCells(); celli-- > 0;)
    {
        while (i > 0 && triangles[i - 1].cell == celli)
        {
            --i;
        }
        firstOf[celli] = i;
    }

    labelList listed(mesh.nCells(), -1);
    DynamicList<label> found;

    forAll(mesh.cells(), celli)
    {
        const point& x = mesh.cellCentres()[celli];
        scalar size = 0;
        for (const label pointi : mesh.cellPoints()[celli])
        {
            size = max(size, mag(mesh.points()[pointi] - x));
        }

        cellStart_[celli] = cells.size();
        found.clear();
        found.append(celli);
        listed[celli] = celli;

        for (label i = 0; i < found.size(); ++i)
        {
            const weightSupport& support = supports_[found[i]];
            const vector d(x - support.x);
            if (mag(d) >= Foam::sqrt(support.farthest) + size)
            {
                continue;
            }

            scalar radius = 0;
            for (const label pointi : mesh.cellPoints()[celli])
            {
                const vector r(mesh.points()[pointi] - x);
                radius = max(radius, r & (support.metric & r));
            }
            if
            (
                Foam::sqrt(d & (support.metric & d)) < 1 + Foam::sqrt(radius)
            )
            {
                cells.append(found[i]);
                appendAround(mesh, baffles, found[i], celli, listed, found);
            }
        }

        triangleStart_[celli] = trianglesNear.size();
        for (label j = cellStart_[celli]; j < cells.size(); ++j)
        {
            for (label i = firstOf[cells[j]]; i < firstOf[cells[j] + 1]; ++i)
            {
                const wallTriangle& t = triangles[i];
                if
                (
                    mag(fromTriangle(t, x, nullptr))
                  < size + 1/Foam::sqrt(t.inverseSquare)
                )
                {
                    trianglesNear.append(i);
                }
            }
        }
    }

    cellStart_[mesh.nCells()] = cells.size();
    triangleStart_[mesh.nCells()] = trianglesNear.size();
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::partitionOfUnity::make
(
    const polyMesh* mesh,
    const baffleSides* baffles,
    const UList<flowTet>& tets,
    const UList<flowVertex>& vertices
)
{
    DynamicList<wallTriangle> triangles;
    DynamicList<label> cells;
    DynamicList<label> trianglesNear;

    supports_.reset(mesh ? mesh->nCells() : 0);
    cellStart_.reset(mesh ? mesh->nCells() + 1 : 0);
    triangleStart_.reset(mesh ? mesh->nCells() + 1 : 0);

    if (mesh)
    {
        const undecomposedFlow::serialScope serial;

        moments_ = secondMoments(*mesh);
        nFits_ = mesh->nCells();
        triangles = findTriangles(*mesh, tets, vertices);

        forAll(moments_, celli)
        {
            // A mesh cell of edges a has moments of a2/12
            const symmTensor& M = moments_[celli];
            weightSupport& support = supports_[celli];

            support.x = mesh->cellCentres()[celli];
            support.metric = inv(M)/(12*sqr(supportRadius));
            support.farthest =
                12*sqr(supportRadius)*cmptMax(eigenValues(M));
        }
        findNear(*mesh, *baffles, triangles, cells, trianglesNear);
    }

    broadcast(nFits_);
    fill(triangles_, triangles);
    fill(cells_, cells);
    fill(trianglesNear_, trianglesNear);
    supports_.share();
    cellStart_.share();
    triangleStart_.share();
}


void Foam::partitionOfUnity::setFits
(
    const volVectorField& U,
    const baffleSides& baffles,
    UList<quadratic>& fits
) const
{
    const polyMesh& mesh = U.mesh();
    const cyclicPoints none(mesh, domainImages());
    const List<quadratic> ofCells(cellFits(U, baffles, none));

    forAll(ofCells, celli)
    {
        fits[celli] = ofCells[celli];
        removeDivergence(moments_[celli], fits[celli]);
    }

    forAll(triangles_, i)
    {
        const wallTriangle& t = triangles_[i];
        const label facei = faces_[i];
        const label patchi = mesh.boundaryMesh().whichPatch(facei);
        const label start = mesh.boundaryMesh()[patchi].start();

        quadratic fit(ofCells[t.cell]);
        removeDivergence(moments_[t.cell], fit);

        fits[t.fit] = fitAtWall
        (
            fit,
            moments_[t.cell],
            U[t.cell],
            U.boundaryField()[patchi][facei - start],
            t.normal,
            t.normal & (t.corners[0] - supports_[t.cell].x)
        );
    }
}


void Foam::partitionOfUnity::evaluate
(
    const UList<quadratic>& fits,
    const label celli,
    const point& x,
    vector& u,
    tensor* gradient,
    symmTensor* curvature
) const
{
    const int order = curvature ? 2 : gradient ? 1 : 0;
    weightedSums sums;
    weightAt w;

    for (label i = cellStart_[celli]; i < cellStart_[celli + 1]; ++i)
    {
        const weightSupport& support = supports_[cells_[i]];
        const vector d(x - support.x);
        if (weightOf(support, d, order, w))
        {
            sums.add(fits[cells_[i]], d, order, w);
        }
    }
    for (label i = triangleStart_[celli]; i < triangleStart_[celli + 1]; ++i)
    {
        const wallTriangle& t = triangles_[trianglesNear_[i]];
        if (weightOf(t, x, order, w))
        {
            sums.add(fits[t.fit], x - supports_[t.cell].x, order, w);
        }
    }
    if (!(sums.w > 0))
    {
        // Beyond all weights, in a corner of a mesh cell that is far from a box
        w = weightAt{1, vector(Zero), symmTensor(Zero)};
        sums.add(fits[celli], x - supports_[celli].x, order, w);
    }

    u = sums.u/sums.w;
    if (order > 0)
    {
        *gradient = (sums.uSlope - u*sums.wSlope)/sums.w;
    }
    for (direction i = 0; order > 1 && i < 3; ++i)
    {
        curvature[i] =
            (
                sums.uCurvature[i] - u[i]*sums.wCurvature
              - twoSymm(weightedSums::row(*gradient, i)*sums.wSlope)
            )/sums.w;
    }
}


// ************************************************************************* //
