// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "narrowestGaps.H"
#include "baffleSides.H"
#include "cyclicPolyPatch.H"
#include "domainImages.H"
#include "polyMesh.H"
#include "wallPolyPatch.H"

#include <utility>
#include <vector>

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{

//- A line through one mesh cell after the other
struct meshLine
{
    const polyMesh& mesh;

    //- Position [m] and direction, in a mesh cell that it entered by a face
    point x;
    vector along;
    label celli;
    label facei;

    //- Go to the face by which it leaves the mesh cell; returns the way there [m],
    //  GREAT if there is none
    scalar leave()
    {
        scalar way = GREAT;
        label out = -1;

        for (const label i : mesh.cells()[celli])
        {
            const vector& area = mesh.faceAreas()[i];
            const scalar side = mesh.faceOwner()[i] == celli ? 1 : -1;

            if (i == facei || side*(area & along) <= SMALL*mag(area))
            {
                continue;
            }

            // The plane of a face is not enough: mesh cells need not be convex
            const pointHit hit
            (
                mesh.faces()[i].intersection
                (
                    x, along, mesh.faceCentres()[i], mesh.points(),
                    intersection::FULL_RAY, 1e-6
                )
            );
            const scalar least = -1e-6*Foam::sqrt(mag(area));
            if (hit.hit() && hit.distance() > least && hit.distance() < way)
            {
                way = hit.distance();
                out = i;
            }
        }

        facei = out;
        way = max(way, scalar(0));
        x += way*along;
        return way;
    }

    //- The width of its mesh cell in this direction [m]
    scalar cellWidth() const
    {
        scalar low = GREAT, high = -GREAT;
        for (const label i : mesh.cells()[celli])
        {
            for (const label pointi : mesh.faces()[i])
            {
                const scalar here = mesh.points()[pointi] & along;
                low = min(low, here);
                high = max(high, here);
            }
        }
        return high - low;
    }

    //- Go on beyond the face: in the next mesh cell, or in the image there.
    //  False at the boundary
    bool enter(const domainImages& images)
    {
        const label patchi = mesh.boundaryMesh().whichPatch(facei);
        if (patchi < 0)
        {
            const label owner = mesh.faceOwner()[facei];
            celli = celli == owner ? mesh.faceNeighbour()[facei] : owner;
            return true;
        }

        const domainImages::seam* seam = images.at(patchi);
        if (!seam)
        {
            return false;
        }
        if (!seam->mirrors())
        {
            const cyclicPolyPatch& half =
                refCast<const cyclicPolyPatch>(mesh.boundaryMesh()[patchi]);
            facei += half.neighbPatch().start() - half.start();
        }
        celli = mesh.faceOwner()[facei];
        x = seam->inward(x);
        along = seam->inward.turn() & along;
        return true;
    }

    //- Does it meet a wall that faces it? Within 60 degrees: the sides of a corner
    //  do not
    bool meetsWall() const
    {
        const polyBoundaryMesh& patches = mesh.boundaryMesh();
        const vector& area = mesh.faceAreas()[facei];

        return
            isA<wallPolyPatch>(patches[patches.whichPatch(facei)])
         && (area & along) > 0.5*mag(area);
    }
};


//- Make a gap that from a point on, along a line that begins there or a mesh
//  cell before, if it is narrower: to a wall that faces it, or as wide as known
static void narrow
(
    const domainImages& images,
    meshLine line,
    const point& from,
    const scalar known,
    narrowGap& gap
)
{
    const vector along(line.along);
    const scalar before = (from - line.x) & along;
    scalar width = -before;

    // Beyond a period of the device walls come again
    const scalar longest = 4*line.mesh.bounds().mag();
    const scalar most = min(min(known, gap.width), longest);

    // Where it was in each mesh cell, and how far it goes there
    std::vector<std::pair<meshLine, scalar>> passed;

    for (label n = 0; n < 10000; ++n)
    {
        const scalar start = max(width, scalar(0));
        passed.emplace_back(line, 0);
        width += line.leave();
        passed.back().second = max(min(width, most) - start, scalar(0));

        const bool wide = width >= (1 - 1e-6)*most;
        if (!wide && line.enter(images))
        {
            continue;
        }
        if (wide ? known < gap.width : line.meetsWall())
        {
            // It cuts corners of tetrahedra: of each the part of its width counts
            scalar meshCells = 0;
            for (const auto& in : passed)
            {
                meshCells += in.second/in.first.cellWidth();
            }
            width = min(width, most);
            gap = narrowGap
            {
                width, from + 0.5*width*along,
                max(label(1), label(std::ceil(meshCells - 0.01)))
            };
        }
        return;
    }
}


//- Where a face of a baffle has an edge, and no others of the boundary do but
//  that on its back: its ends, and the unit vector in the face to the outside
struct baffleRim
{
    label facei;
    point ends[2];
    vector out;

    linePointRef line() const
    {
        return linePointRef(ends[0], ends[1]);
    }
};


static DynamicList<baffleRim> baffleRims(const polyMesh& mesh)
{
    DynamicList<baffleRim> rims;
    for (const labelPair& pair : baffleFaces(mesh))
    {
        for (const edge& e : mesh.faces()[pair.first()].edges())
        {
            label nFaces = 0;
            for (const label i : mesh.pointFaces()[e.start()])
            {
                nFaces += !mesh.isInternalFace(i)
                 && mesh.faces()[i].edgeDirection(e) != 0;
            }
            const linePointRef line(e.line(mesh.points()));
            vector out(line.centre() - mesh.faceCentres()[pair.first()]);
            out -= (out & line.vec())*line.vec()/magSqr(line.vec());
            for (label i = 0; i < 2 && nFaces == 2; ++i)
            {
                rims.append
                (
                    {pair[i], {line.start(), line.end()}, out/mag(out)}
                );
            }
        }
    }
    return rims;
}


//- Make a gap that from a rim to a wall or to another rim, of the mesh or of an
//  image of it around, if it is narrower
static void narrow
(
    const polyMesh& mesh,
    const domainImages& images,
    const UList<isometry>& around,
    const baffleRim& rim,
    const UList<baffleRim>& others,
    narrowGap& gap
)
{
    const label celli = mesh.faceOwner()[rim.facei];
    const point from(rim.line().centre());
    meshLine line{mesh, mesh.cellCentres()[celli], rim.out, celli, -1};
    narrow(images, line, from, GREAT, gap);

    for (const isometry& image : around)
    {
        for (const baffleRim& other : others)
        {
            const point a(image(other.ends[0])), b(image(other.ends[1]));
            point x, y;
            const scalar way = rim.line().nearestDist(linePointRef(a, b), x, y);
            line.along = (y - x)/max(way, VSMALL);

            // Within 40 degrees: the sides of a corner do not face each other
            const vector in(-(image.turn() & other.out));
            if (min(line.along & rim.out, line.along & in) > 0.76)
            {
                narrow(images, line, from, way, gap);
            }
        }
    }
}

} // End namespace Foam


// * * * * * * * * * * * * * * * Global Functions  * * * * * * * * * * * * * //

Foam::List<Foam::narrowGap> Foam::narrowestGaps
(
    const polyMesh& mesh,
    const domainImages& images,
    const labelUList& patches
)
{
    List<narrowGap> gaps(patches.size(), narrowGap{GREAT, Zero, 0});
    const DynamicList<baffleRim> rims(baffleRims(mesh));
    DynamicList<isometry> around;
    if (rims.size())
    {
        const boundBox bounds(meshedBox(mesh));
        around = images.near(bounds, bounds.mag());
    }

    forAll(patches, k)
    {
        const polyPatch& patch = mesh.boundaryMesh()[patches[k]];
        forAll(patch, i)
        {
            const label facei = patch.start() + i;
            const point& x = mesh.faceCentres()[facei];
            const vector& area = mesh.faceAreas()[facei];
            const label celli = mesh.faceOwner()[facei];
            const meshLine line{mesh, x, -area/mag(area), celli, facei};
            narrow(images, line, x, GREAT, gaps[k]);
        }
        for (const baffleRim& rim : rims)
        {
            if (patch.range().found(rim.facei))
            {
                narrow(mesh, images, around, rim, rims, gaps[k]);
            }
        }
    }

    return gaps;
}
