/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/

#include "surfaceFields.H"

// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

template<class Type>
Foam::tmp<Foam::Field<Type>> Foam::partMesh::patchValues
(
    const GeometricField<Type, fvPatchField, volMesh>& ofWhole,
    const label patchi
) const
{
    const polyPatch& patch = mesh_->boundaryMesh()[patchi];
    const polyBoundaryMesh& boundary = whole_.boundaryMesh();
    auto result = tmp<Field<Type>>::New(patch.size());
    Field<Type>& values = result.ref();

    forAll(values, i)
    {
        const label facei = faces_[patch.start() + i];
        if (whole_.isInternalFace(facei))
        {
            const scalar weight = whole_.weights()[facei];
            values[i] =
                weight*ofWhole[whole_.faceOwner()[facei]]
              + (1 - weight)*ofWhole[whole_.faceNeighbour()[facei]];
        }
        else
        {
            const label from = boundary.whichPatch(facei);
            values[i] =
                ofWhole.boundaryField()[from][facei - boundary[from].start()];
        }
    }

    return result;
}


// ************************************************************************* //
