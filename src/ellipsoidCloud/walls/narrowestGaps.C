// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "narrowestGaps.H"
#include "cyclicPolyPatch.H"
#include "domainImages.H"
#include "polyMesh.H"
#include "wallPolyPatch.H"

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


//- The passage along the normal of a face of a wall. If it is not narrower than
//  the narrowest so far, that
static narrowGap narrower
(
    const polyMesh& mesh,
    const domainImages& images,
    const label facei,
    const narrowGap& narrowest
)
{
    const point from(mesh.faceCentres()[facei]);
    const vector n(mesh.faceAreas()[facei]/mag(mesh.faceAreas()[facei]));
    meshLine line{mesh, from, -n, mesh.faceOwner()[facei], facei};
    scalar width = 0;

    for (label nMeshCells = 1; nMeshCells < 10000; ++nMeshCells)
    {
        width += line.leave();

        // Beyond a period of the device walls come again
        if (width >= min(narrowest.width, 4*mesh.bounds().mag()))
        {
            break;
        }
        if (!line.enter(images))
        {
            return
                line.meetsWall()
              ? narrowGap{width, from - 0.5*width*n, nMeshCells}
              : narrowest;
        }
    }

    return narrowest;
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

    forAll(patches, k)
    {
        const polyPatch& patch = mesh.boundaryMesh()[patches[k]];
        forAll(patch, i)
        {
            gaps[k] = narrower(mesh, images, patch.start() + i, gaps[k]);
        }
    }

    return gaps;
}
