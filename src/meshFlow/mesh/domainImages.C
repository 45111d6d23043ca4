// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "domainImages.H"
#include "foamVersions.H"
#include "cyclicPolyPatch.H"
#include "polyMesh.H"
#include "SubField.H"
#include "symmetryPlanePolyPatch.H"
#include "symmetryPolyPatch.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- Part of a length that the points of a mesh may be off
    static const scalar offness = 1e-4;

    //- End the run because of a patch
    static void refuse
    (
        const polyPatch& pp,
        const char* what,
        const char* advice
    )
    {
        FatalErrorInFunction
            << "patch " << pp.name() << " of "
            << pp.boundaryMesh().mesh().meshDir()/"boundary"
            << " is of type " << pp.type() << ", and " << what << nl
            << "    " << advice << "; or, where that is an entry and nothing"
            << " comes there, unreached (" << pp.name() << ");"
            << exit(FatalError);
    }

    //- A plane of symmetry. Ends the run if it is none.
    static domainImages::seam symmetry(const polyPatch& pp)
    {
        vector n(sum(vectorField(pp.faceAreas())));
        n /= max(mag(n), VSMALL);

        // Exactly along an axis if it is so but for rounding
        for (scalar& component : n.v_)
        {
            component = mag(component) < 1e-9 ? 0 : component;
        }
        n /= mag(n);

        const scalarField heights(pp.localPoints() & n);
        const scalar size = meshedBox(pp.boundaryMesh().mesh()).mag();

        if (max(heights) - min(heights) > offness*size)
        {
            refuse
            (
                pp,
                "not plane",
                "Make each plane a patch of its own, and curved ones walls"
            );
        }

        const scalar height = 0.5*(max(heights) + min(heights));
        scalar highest = height;
        for (const polyPatch& other : pp.boundaryMesh())
        {
            highest = max(highest, max(other.localPoints() & n));
        }
        if (highest - height > offness*size)
        {
            refuse
            (
                pp,
                "the mesh lies on both sides of its plane",
                "Mesh the whole, or the part on one side"
            );
        }

        const point x(height*n);
        return domainImages::seam{pp.index(), isometry::mirror(x, n), x, n};
    }

    //- A cyclic patch. Ends the run if it is not moved along.
    static domainImages::seam translational(const polyPatch& pp)
    {
        const cyclicPolyPatch& half = refCast<const cyclicPolyPatch>(pp);
        const cyclicPolyPatch& other = half.neighbPatch();

        const vectorField shifts(other.faceCentres() - half.faceCentres());
        vector shift(sum(shifts)/scalar(half.size()));
        const scalar size = meshedBox(half.boundaryMesh().mesh()).mag();

        // Halves that lie on one another are a membrane within the device
        if (mag(shift) < offness*size)
        {
            shift = Zero;
        }
        if (max(mag(shifts - shift)) > offness*size)
        {
            refuse
            (
                pp,
                "its other half is turned against it",
                "One half has to be the other moved along; mesh the whole"
            );
        }

        // Back the same way to the last bit
        const isometry inward
        (
            half.owner()
          ? isometry::translation(shift)
          : translational(other).inward.inverse()
        );

        return domainImages::seam{pp.index(), inward, Zero, Zero};
    }
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::domainImages::domainImages
(
    const polyMesh& mesh,
    const labelHashSet& unreached
)
{
    if (!Pstream::master())
    {
        return;
    }

    for (const polyPatch& pp : mesh.boundaryMesh())
    {
        if (isSeam(pp) && pp.size() && !unreached.found(pp.index()))
        {
            seams_.append(isMirror(pp) ? symmetry(pp) : translational(pp));
        }
    }
}


// * * * * * * * * * * * * * * Static Functions * * * * * * * * * * * * * * * //

bool Foam::domainImages::isMirror(const polyPatch& pp)
{
    return isA<symmetryPolyPatch>(pp) || isA<symmetryPlanePolyPatch>(pp);
}


bool Foam::domainImages::isSeam(const polyPatch& pp)
{
    return isMirror(pp) || pp.type() == cyclicPolyPatch::typeName;
}


bool Foam::domainImages::any
(
    const polyBoundaryMesh& patches,
    const labelHashSet& unreached
)
{
    for (const polyPatch& pp : patches)
    {
        if (isSeam(pp) && !unreached.found(pp.index()))
        {
            return true;
        }
    }

    return false;
}


void Foam::domainImages::share()
{
    broadcast(seams_);
}


Foam::List<Foam::vector> Foam::domainImages::periods() const
{
    DynamicList<vector> sums;
    sums.append(Zero);

    for (const seam& s : seams_)
    {
        // Both halves of a patch have a seam, and lead back together
        const label n = s.mirrors() ? 0 : sums.size();

        for (label i = 0; i < n; ++i)
        {
            const vector sum(sums[i] + s.inward.b);
            bool isNew = true;
            for (const vector& known : sums)
            {
                isNew = isNew && mag(sum - known) > offness*mag(s.inward.b);
            }
            if (isNew)
            {
                sums.append(sum);
            }
        }
    }

    return List<vector>(SubList<vector>(sums, sums.size() - 1, 1));
}


Foam::DynamicList<Foam::isometry> Foam::domainImages::near
(
    const boundBox& box,
    const scalar far
) const
{
    const boundBox wide(widened(box, far));
    const pointField corners(box.points());
    DynamicList<isometry> found;
    found.append(isometry());

    for (label i = 0; i < found.size(); ++i)
    {
        for (const seam& s : seams_)
        {
            const isometry next(found[i].after(s.inward.inverse()));
            boundBox image(boundBox::invertedBox);
            for (const point& corner : corners)
            {
                image.add(next(corner));
            }

            if (image.overlaps(wide))
            {
                placeOf(next, box.mag(), found);
            }
        }
    }

    return found;
}


// * * * * * * * * * * * * * * * Global Functions  * * * * * * * * * * * * * //

Foam::boundBox Foam::meshedBox(const polyMesh& mesh)
{
    boundBox box(boundBox::invertedBox);
    for (const polyPatch& pp : mesh.boundaryMesh())
    {
        box.add(pp.localPoints());
    }

    return box;
}
