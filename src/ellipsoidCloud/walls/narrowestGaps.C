/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/

#include "narrowestGaps.H"
#include "domainImages.H"
#include "DynamicList.H"
#include "polyMesh.H"
#include "SubField.H"
#include "wallPolyPatch.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{

static labelList wallsAndSeams
(
    const polyBoundaryMesh& patches,
    const domainImages& images
)
{
    DynamicList<label> faces;

    for (const polyPatch& patch : patches)
    {
        if (isA<wallPolyPatch>(patch) || images.at(patch.index()))
        {
            for (label i = 0; i < patch.size(); ++i)
            {
                faces.append(patch.start() + i);
            }
        }
    }

    return labelList(std::move(faces));
}


// A search tree does not bear faces that lie on its boundary
static treeBoundBox widened(const boundBox& box)
{
    treeBoundBox wide(box);
    wide.min() -= vector::uniform(1e-3*box.mag());
    wide.max() += vector::uniform(1e-3*box.mag());

    return wide;
}

} // End namespace Foam


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::narrowestGaps::narrowestGaps
(
    const polyMesh& mesh,
    const domainImages& images
)
:
    mesh_(mesh),
    images_(images),
    faces_
    (
        treeDataFace
        (
            false,
            mesh,
            wallsAndSeams(mesh.boundaryMesh(), images)
        ),
        widened(boundBox(mesh.points(), false)),
        8,
        10,
        3
    )
{}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::scalar Foam::narrowestGaps::widthAlong
(
    point from,
    vector along,
    const scalar off
) const
{
    // A wall faces another if their normals are within 60 degrees of opposite:
    // the sides of a corner do not
    const scalar facing = 0.5;
    // Beyond a period of the device walls come again
    const label mostSeams = 4;

    const scalar far = mesh_.bounds().mag();
    scalar width = 0;

    for (label i = 0; i <= mostSeams; ++i)
    {
        const pointIndexHit hit
        (
            faces_.findLine(from + off*along, from + far*along)
        );

        if (!hit.hit())
        {
            return GREAT;
        }
        width += mag(hit.hitPoint() - from);

        const label facei = faces_.shapes().faceLabels()[hit.index()];
        const domainImages::seam* seam =
            images_.at(mesh_.boundaryMesh().whichPatch(facei));

        if (!seam)
        {
            const vector& area = mesh_.faceAreas()[facei];

            return (area & along) > facing*mag(area) ? width : GREAT;
        }
        from = seam->inward(hit.hitPoint());
        along = seam->inward.turn() & along;
    }

    return GREAT;
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::narrowestGaps::gap Foam::narrowestGaps::at(const label patchi) const
{
    const polyPatch& patch = mesh_.boundaryMesh()[patchi];
    const vectorField::subField centres(patch.faceCentres());
    const vectorField::subField areas(patch.faceAreas());

    gap narrowest{GREAT, Zero, GREAT};

    forAll(patch, i)
    {
        const scalar area = mag(areas[i]);
        const vector n(areas[i]/area);
        const scalar width = widthAlong(centres[i], -n, 1e-4*sqrt(area));

        if (width < narrowest.width)
        {
            const label celli = patch.faceCells()[i];
            const scalar thickness =
                2*mag((centres[i] - mesh_.cellCentres()[celli]) & n);

            narrowest = gap{width, centres[i] - 0.5*width*n, width/thickness};
        }
    }

    return narrowest;
}


// ************************************************************************* //
