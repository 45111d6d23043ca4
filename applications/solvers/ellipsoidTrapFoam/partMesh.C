/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/

#include "partMesh.H"
#include "surfaceFields.H"

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::partMesh::make
(
    faceList&& faces,
    labelList&& owner,
    labelList&& neighbour,
    const labelUList& sizes
)
{
    labelList renumbered(whole_.nPoints(), -1);
    DynamicList<point> points;
    for (face& f : faces)
    {
        for (label& pointi : f)
        {
            if (renumbered[pointi] < 0)
            {
                renumbered[pointi] = points.size();
                points.append(whole_.points()[pointi]);
            }
            pointi = renumbered[pointi];
        }
    }

    label start = neighbour.size();

    // Of the whole mesh's name, as its schemes are read by that
    const IOobject io
    (
        whole_.name(), whole_.time().timeName(), whole_.time(),
        IOobject::NO_READ, IOobject::NO_WRITE, false
    );
#if OPENFOAM >= 2112
    mesh_.reset
    (
        new fvMesh
        (
            io, whole_, pointField(std::move(points)), std::move(faces),
            std::move(owner), std::move(neighbour), false
        )
    );
#else
    mesh_.reset
    (
        new fvMesh
        (
            io, pointField(std::move(points)), std::move(faces),
            std::move(owner), std::move(neighbour), false
        )
    );
    fvSchemes& schemes = *mesh_;
    fvSolution& solution = *mesh_;
    schemes.readOpt() = solution.readOpt() = IOobject::MUST_READ;
    schemes.read();
    solution.read();
#endif

    const polyBoundaryMesh& boundary = mesh_->boundaryMesh();
    List<polyPatch*> all(sizes.size());
    forAll(patches_, i)
    {
        all[i] =
            whole_.boundaryMesh()[patches_[i]]
           .clone(boundary, i, sizes[i], start).ptr();
        start += sizes[i];
    }
    all.last() = new polyPatch
    (
        "cut", sizes.last(), start, cut(), boundary, polyPatch::typeName
    );
    mesh_->addFvPatches(all);
    mesh_->setFluxRequired("p");
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::partMesh::partMesh(const fvMesh& whole, const boundBox& box)
:
    whole_(whole)
{
    labelList renumbered(whole.nCells(), -1);
    forAll(whole.C(), celli)
    {
        if (box.contains(whole.C()[celli]))
        {
            renumbered[celli] = cells_.size();
            cells_.append(celli);
        }
    }

    DynamicList<face> faces;
    DynamicList<label> owner, neighbour;
    DynamicList<label> outside;
    const auto add = [&](const label facei, const bool flip)
    {
        const label celli =
            (flip ? whole.faceNeighbour() : whole.faceOwner())[facei];
        const face& f = whole.faces()[facei];

        faces_.append(facei);
        faces.append(flip ? f.reverseFace() : f);
        owner.append(renumbered[celli]);
    };

    for (label facei = 0; facei < whole.nInternalFaces(); ++facei)
    {
        const label from = renumbered[whole.faceOwner()[facei]];
        const label to = renumbered[whole.faceNeighbour()[facei]];

        if (from >= 0 && to >= 0)
        {
            add(facei, false);
            neighbour.append(to);
        }
        else if (from >= 0 || to >= 0)
        {
            outside.append(facei);
        }
    }

    DynamicList<label> sizes;
    for (const polyPatch& patch : whole.boundaryMesh())
    {
        const label before = faces.size();
        forAll(patch, i)
        {
            const label facei = patch.start() + i;
            if (renumbered[whole.faceOwner()[facei]] < 0)
            {
                continue;
            }
            if (patch.coupled())
            {
                outside.append(facei);
            }
            else
            {
                add(facei, false);
            }
        }
        if (!patch.coupled())
        {
            patches_.append(patch.index());
            sizes.append(faces.size() - before);
        }
    }

    for (const label facei : outside)
    {
        add(facei, renumbered[whole.faceOwner()[facei]] < 0);
    }
    sizes.append(outside.size());

    make
    (
        faceList(std::move(faces)), labelList(std::move(owner)),
        labelList(std::move(neighbour)), sizes
    );
}


// ************************************************************************* //
