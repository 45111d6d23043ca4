// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "narrowestGaps.H"
#include "domainImages.H"
#include "indexedOctree.H"
#include "polyMesh.H"
#include "SubField.H"
#include "treeDataFace.H"
#include "wallPolyPatch.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{

//- From a point on a face to the wall that a unit vector leads to [m], seen
//  from so far off the face; GREAT if that does not face it
static scalar widthAlong
(
    const indexedOctree<treeDataFace>& faces,
    const polyMesh& mesh,
    const domainImages& images,
    point from,
    vector along,
    const scalar off
)
{
    // A wall faces another if their normals are within 60 degrees of opposite:
    // the sides of a corner do not
    const scalar facing = 0.5;
    // Beyond a period of the device walls come again
    const label mostSeams = 4;

    const scalar far = mesh.bounds().mag();
    scalar width = 0;

    for (label i = 0; i <= mostSeams; ++i)
    {
        const pointIndexHit hit
        (
            faces.findLine(from + off*along, from + far*along)
        );

        if (!hit.hit())
        {
            return GREAT;
        }
        width += mag(hit.hitPoint() - from);

        const label facei = faces.shapes().faceLabels()[hit.index()];
        const domainImages::seam* seam =
            images.at(mesh.boundaryMesh().whichPatch(facei));

        if (!seam)
        {
            const vector& area = mesh.faceAreas()[facei];

            return (area & along) > facing*mag(area) ? width : GREAT;
        }
        from = seam->inward(hit.hitPoint());
        along = seam->inward.turn() & along;
    }

    return GREAT;
}


//- Mesh cells by length on the line from a face of the boundary along a vector
//  to where it leaves the mesh [1/m]
static scalar meshCellsAlong
(
    const polyMesh& mesh,
    label facei,
    const vector& along
)
{
    const point from(mesh.faceCentres()[facei]);
    label celli = mesh.faceOwner()[facei];
    label nCells = 0;
    scalar length = 0;

    // Through the plane of a face that is met first, farther on
    while (celli >= 0 && nCells < mesh.nCells())
    {
        scalar next = GREAT;
        label out = -1;

        for (const label i : mesh.cells()[celli])
        {
            const scalar side = mesh.faceOwner()[i] == celli ? 1 : -1;
            const vector area(side*mesh.faceAreas()[i]);
            const scalar speed = area & along;

            if (i != facei && speed > SMALL*mag(area))
            {
                const scalar l =
                    ((mesh.faceCentres()[i] - from) & area)/speed;
                if (l < next)
                {
                    next = l;
                    out = i;
                }
            }
        }
        if (out < 0)
        {
            break;
        }
        ++nCells;
        length = max(length, next);
        celli =
            !mesh.isInternalFace(out) ? -1
          : mesh.faceOwner()[out] == celli ? mesh.faceNeighbour()[out]
          : mesh.faceOwner()[out];
        facei = out;
    }

    return nCells/max(length, VSMALL);
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
    DynamicList<label> limits;
    for (const polyPatch& patch : mesh.boundaryMesh())
    {
        if (isA<wallPolyPatch>(patch) || images.at(patch.index()))
        {
            limits.append(identity(patch.size(), patch.start()));
        }
    }

    // A search tree does not bear faces that lie on its boundary
    treeBoundBox box(boundBox(mesh.points(), false));
    box.inflate(1e-3);
    const indexedOctree<treeDataFace> faces
    (
        treeDataFace(true, mesh, limits), box, 8, 40, 3
    );

    List<narrowGap> gaps(patches.size(), narrowGap{GREAT, Zero, GREAT});

    forAll(patches, k)
    {
        const polyPatch& patch = mesh.boundaryMesh()[patches[k]];
        const vectorField::subField centres(patch.faceCentres());
        const vectorField::subField areas(patch.faceAreas());
        label narrowest = -1;

        forAll(patch, i)
        {
            const scalar area = mag(areas[i]);
            const vector n(areas[i]/area);
            const scalar width = widthAlong
            (
                faces, mesh, images, centres[i], -n, 1e-4*sqrt(area)
            );

            if (width < gaps[k].width)
            {
                gaps[k] = narrowGap{width, centres[i] - 0.5*width*n, 0};
                narrowest = patch.start() + i;
            }
        }
        if (narrowest >= 0)
        {
            const vector& area = mesh.faceAreas()[narrowest];
            gaps[k].meshCells = gaps[k].width
                *meshCellsAlong(mesh, narrowest, -area/mag(area));
        }
    }

    return gaps;
}
