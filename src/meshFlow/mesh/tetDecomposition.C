// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "tetDecomposition.H"
#include "bitSet.H"
#include "cyclicPolyPatch.H"
#include "DynamicList.H"
#include "SubField.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- Distance of an apex from a triangle that will do
    static const scalar enough = 0.05;

    //- The face of the other half of a cyclic patch
    static label faceAcross(const cyclicPolyPatch& half, const label facei)
    {
        return half.neighbPatch().start() + facei - half.start();
    }

    //- The plane of a triangle: the normal out of a mesh cell, and the
    //  distance from the origin along it
    struct trianglePlane
    {
        vector n;
        scalar distance;
    };

    //- The point with the largest distance from the nearest of planes that lie
    //  about the origin, within a size, by the simplex method: of x and t with
    //  n.x + t <= distance for all planes the largest t. Those of the basis
    //  meet it with equality, and the one that violates it most enters.
    static vector deepestPoint
    (
        const UList<trianglePlane>& planes,
        const scalar size
    )
    {
        // What distances of the basis add to x and t; at first those of a
        // tetrahedron far away
        struct { vector x; scalar t; scalar distance; } basis[4];
        for (label k = 0; k < 4; ++k)
        {
            const scalar i = k & 1 ? 1 : -1;
            const scalar j = k & 2 ? 1 : -1;
            basis[k] = {Foam::sqrt(3.0)/4*vector(i, j, i*j), 0.25, 10*size};
        }

        vector x(Zero);
        for (label n = 0; n < 1000; ++n)
        {
            scalar t = 0;
            x = Zero;
            for (const auto& column : basis)
            {
                x += column.distance*column.x;
                t += column.distance*column.t;
            }

            const trianglePlane* in = nullptr;
            scalar least = t - 1e-9*size;
            for (const trianglePlane& p : planes)
            {
                if (p.distance - (p.n & x) < least)
                {
                    least = p.distance - (p.n & x);
                    in = &p;
                }
            }

            scalar by[4];
            label out = -1;
            for (label k = 0; in && k < 4; ++k)
            {
                by[k] = (in->n & basis[k].x) + basis[k].t;
                if
                (
                    by[k] > 1e-9
                 && (out < 0 || basis[k].t*by[out] < basis[out].t*by[k])
                )
                {
                    out = k;
                }
            }
            if (out < 0)
            {
                break;
            }

            basis[out] =
                {basis[out].x/by[out], basis[out].t/by[out], in->distance};
            for (label k = 0; k < 4; ++k)
            {
                if (k != out)
                {
                    basis[k].x -= by[k]*basis[out].x;
                    basis[k].t -= by[k]*basis[out].t;
                }
            }
        }
        return x;
    }
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::label Foam::tetDecomposition::sidesOf
(
    const label facei,
    side sides[2]
) const
{
    sides[0] = sideOf(mesh_.faceOwner()[facei], 1);

    if (mesh_.isInternalFace(facei))
    {
        sides[1] = sideOf(mesh_.faceNeighbour()[facei], -1);
        return 2;
    }

    // Cells pass no others than those moved along
    const cyclicPolyPatch* half = halfOf(facei);
    if (!half || !half->parallel())
    {
        return 1;
    }
    const label across = faceAcross(*half, facei);
    sides[1] = sideOf(mesh_.faceOwner()[across], -1);
    sides[1].apex += mesh_.faceCentres()[facei] - mesh_.faceCentres()[across];
    return 2;
}


const Foam::cyclicPolyPatch* Foam::tetDecomposition::halfOf
(
    const label facei
) const
{
    const label patchi = patchOf(mesh_, facei);
    return
        patchi < 0
      ? nullptr
      : isA<cyclicPolyPatch>(mesh_.boundaryMesh()[patchi]);
}


void Foam::tetDecomposition::lowerClearances
(
    const label facei,
    const label base,
    const side sides[],
    const label n,
    scalar least[]
) const
{
    const scalar noArea = 1e-9*mag(mesh_.faceAreas()[facei]);

    forTriangles
    (
        facei,
        base,
        [&](const point& a, const point& b, const point& c)
        {
            const vector S(0.5*((b - a) ^ (c - a)));
            const scalar area = mag(S) + noArea;
            for (label i = 0; i < n; ++i)
            {
                const side& of = sides[i];
                least[i] = min
                (
                    least[i], of.sign*(S & (a - of.apex))/(area*of.depth)
                );
            }
        }
    );
}


Foam::scalar Foam::tetDecomposition::clearance
(
    const label facei,
    const label base
) const
{
    side sides[2];
    scalar least[2] = {enough, enough};
    const label n = sidesOf(facei, sides);

    lowerClearances(facei, base, sides, n, least);
    return n == 1 ? least[0] : (least[0] + least[1])/2;
}


Foam::scalar Foam::tetDecomposition::cellClearance(const label celli) const
{
    scalar least = GREAT;
    for (const label facei : mesh_.cells()[celli])
    {
        const scalar sign = mesh_.faceOwner()[facei] == celli ? 1 : -1;
        const side of(sideOf(celli, sign));
        lowerClearances(facei, bases_[facei], &of, 1, &least);
    }
    return least;
}


Foam::scalar Foam::tetDecomposition::narrowest
(
    const label facei,
    const label base
) const
{
    const vector& S = mesh_.faceAreas()[facei];
    scalar least = GREAT;

    forTriangles
    (
        facei,
        base,
        [&](const point& x, const point& y, const point& z)
        {
            const vector a(y - x);
            const vector b(z - x);
            least = min
            (
                least,
                ((a ^ b) & S)/max(max(magSqr(a), magSqr(b)), magSqr(b - a))
            );
        }
    );
    return least;
}


Foam::label Foam::tetDecomposition::bestBase
(
    const label facei,
    bool& wellOff
) const
{
    wellOff = true;
    const label n = faces_[facei].size();
    label best = -1;
    label farthest = -1;
    scalar widest = -GREAT;
    scalar most = -GREAT;

    for (label base = 0; base < (n > 3 ? n : 1); ++base)
    {
        const scalar distance = clearance(facei, base);
        if (distance > most)
        {
            most = distance;
            farthest = base;
        }
        if (distance < enough)
        {
            continue;
        }
        if (n < 5)
        {
            return base;
        }
        const scalar width = narrowest(facei, base);
        if (width > widest)
        {
            widest = width;
            best = base;
        }
    }

    wellOff = best >= 0;
    return
        wellOff ? best
      : n > 3 && clearance(facei, -1) > most ? -1
      : farthest;
}


bool Foam::tetDecomposition::cut(const label facei, bool& wellOff)
{
    const cyclicPolyPatch* half = halfOf(facei);

    // Both halves of a cyclic patch alike: faces begin with the same point and
    // go round in opposite senses
    if (half && !half->owner())
    {
        return cut(faceAcross(*half, facei), wellOff);
    }

    const label base = bestBase(facei, wellOff);
    const bool changed = base != bases_[facei];
    bases_[facei] = base;
    if (half)
    {
        const label n = faces_[facei].size();
        bases_[faceAcross(*half, facei)] = base < 0 ? -1 : (n - base) % n;
    }
    return changed;
}


Foam::labelList Foam::tetDecomposition::cutAt(const bitSet& cells)
{
    bitSet faces(mesh_.nFaces());
    for (const label celli : cells)
    {
        faces.set(mesh_.cells()[celli]);
    }

    bitSet others(mesh_.nCells());
    for (const label facei : faces)
    {
        side sides[2];
        bool wellOff;
        const label n = cut(facei, wellOff) ? sidesOf(facei, sides) : 0;
        for (label i = 0; i < n; ++i)
        {
            others.set(sides[i].cell);
        }
    }
    return others.sortedToc();
}


bool Foam::tetDecomposition::moveApex(const label celli)
{
    const scalar before = cellClearance(celli);
    if (before >= enough)
    {
        return false;
    }

    const point& centre = mesh_.cellCentres()[celli];
    const scalar noArea = 1e-9*pow(mesh_.cellVolumes()[celli], 2.0/3);
    DynamicList<trianglePlane> planes;
    scalar size = 0;
    for (const label facei : mesh_.cells()[celli])
    {
        const scalar sign = mesh_.faceOwner()[facei] == celli ? 1 : -1;
        const auto add =
            [&](const point& a, const point& b, const point& c)
            {
                const vector S(sign*((b - a) ^ (c - a)));
                size = max(size, mag(a - centre));
                if (mag(S) > noArea)
                {
                    const vector n(S/mag(S));
                    planes.append(trianglePlane{n, n & (a - centre)});
                }
            };
        forTriangles(facei, bases_[facei], add);
    }

    const point was(apexes_[celli]);
    apexes_[celli] = centre + deepestPoint(planes, size);
    if (!(cellClearance(celli) > before))
    {
        apexes_[celli] = was;
        return false;
    }
    return true;
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::tetDecomposition::tetDecomposition(const polyMesh& mesh)
:
    mesh_(mesh),
    points_(mesh.points()),
    faces_(mesh.faces()),
    apexes_(mesh.cellCentres()),
    depths_(mesh.nCells(), Zero),
    bases_(mesh.nFaces(), -1)
{
    forAll(depths_, celli)
    {
        scalar area = 0;
        for (const label facei : mesh.cells()[celli])
        {
            area += mag(mesh.faceAreas()[facei]);
        }
        depths_[celli] = 3*mesh.cellVolumes()[celli]/area;
    }

    // At a cyclic patch an apex is judged from the other side as well
    bitSet close(mesh.nCells());
    forAll(bases_, facei)
    {
        bool wellOff = false;
        cut(facei, wellOff);
        if (!wellOff || halfOf(facei))
        {
            close.set(mesh.faceOwner()[facei]);
            if (mesh.isInternalFace(facei))
            {
                close.set(mesh.faceNeighbour()[facei]);
            }
        }
    }

    // An apex that moves may make other cuts better, and these other apexes
    labelList cells(close.sortedToc());
    for (label pass = 0; pass < 10 && cells.size(); ++pass)
    {
        bitSet moved(mesh.nCells());
        for (const label celli : cells)
        {
            if (moveApex(celli))
            {
                moved.set(celli);
            }
        }
        cells = cutAt(moved);
    }

    // Where there is no better one the apex is the centre
    bitSet back(mesh.nCells());
    forAll(apexes_, celli)
    {
        const point& centre = mesh.cellCentres()[celli];
        if (apexes_[celli] != centre && cellClearance(celli) <= 0)
        {
            apexes_[celli] = centre;
            back.set(celli);
        }
    }
    cutAt(back);

    meanFaces_ = findIndices(bases_, label(-1));
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::FixedList<Foam::label, 3> Foam::tetDecomposition::triangle
(
    const label facei,
    const label k
) const
{
    const face& f = faces_[facei];
    const label base = bases_[facei];
    const label n = f.size();
    const label i = base + 1 + k;

    FixedList<label, 3> corners;
    corners[0] =
        base < 0
      ? mesh_.nPoints() + findSortedIndex(meanFaces_, facei)
      : f[base];
    corners[1] = f[i < n ? i : i - n];
    corners[2] = f[i + 1 < n ? i + 1 : i + 1 - n];
    return corners;
}
