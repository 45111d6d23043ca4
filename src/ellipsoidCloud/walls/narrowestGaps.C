/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/

#include "narrowestGaps.H"
#include "DynamicList.H"
#include "polyMesh.H"
#include "SubField.H"
#include "wallPolyPatch.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{

static labelList wallFaces(const polyBoundaryMesh& patches)
{
    DynamicList<label> faces;

    for (const polyPatch& patch : patches)
    {
        if (isA<wallPolyPatch>(patch))
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

Foam::narrowestGaps::narrowestGaps(const polyMesh& mesh)
:
    mesh_(mesh),
    walls_
    (
        treeDataFace(false, mesh, wallFaces(mesh.boundaryMesh())),
        widened(boundBox(mesh.points(), false)),
        8,
        10,
        3
    )
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::narrowestGaps::gap Foam::narrowestGaps::at(const label patchi) const
{
    // A wall faces another if their normals are within 60 degrees of opposite:
    // the sides of a corner do not
    const scalar facing = -0.5;

    const polyPatch& patch = mesh_.boundaryMesh()[patchi];
    const vectorField::subField centres(patch.faceCentres());
    const vectorField::subField areas(patch.faceAreas());
    const scalar far = mesh_.bounds().mag();

    gap narrowest{GREAT, Zero, GREAT};

    forAll(patch, i)
    {
        const scalar area = mag(areas[i]);
        const vector n(areas[i]/area);
        const point from(centres[i] - 1e-4*sqrt(area)*n);
        const pointIndexHit hit(walls_.findLine(from, from - far*n));

        if (!hit.hit())
        {
            continue;
        }

        const label other = walls_.shapes().faceLabels()[hit.index()];
        const vector& otherArea = mesh_.faceAreas()[other];
        const scalar width = mag(hit.hitPoint() - centres[i]);

        if
        (
            (otherArea & n) < facing*mag(otherArea)
         && width < narrowest.width
        )
        {
            const label celli = patch.faceCells()[i];
            const scalar thickness =
                2*mag((centres[i] - mesh_.cellCentres()[celli]) & n);

            narrowest =
                gap
                {
                    width,
                    0.5*(centres[i] + hit.hitPoint()),
                    width/thickness
                };
        }
    }

    return narrowest;
}


// ************************************************************************* //
