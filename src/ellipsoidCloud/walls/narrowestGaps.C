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
                const label celli = patch.faceCells()[i];
                const scalar thickness =
                    2*mag((centres[i] - mesh.cellCentres()[celli]) & n);

                gaps[k] = narrowGap
                {
                    width, centres[i] - 0.5*width*n, width/thickness
                };
            }
        }
    }

    return gaps;
}
