// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "pointImages.H"
#include "cyclicPolyPatch.H"
#include "domainImages.H"
#include "polyMesh.H"

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::pointImages::findImages
(
    const polyMesh& mesh,
    const domainImages& images,
    const UList<label>& cyclics
)
{
    const pointField& x = mesh.points();
    const scalar size = meshedBox(mesh).mag();
    Map<DynamicList<isometry>> mirrors;

    for (const domainImages::seam& seam : images.seams())
    {
        const polyPatch& pp = mesh.boundaryMesh()[seam.patch];
        for (label i = 0; seam.mirrors() && i < pp.nPoints(); ++i)
        {
            mirrors(pp.meshPoints()[i]).append(seam.inward);
            imagesAt_(pp.meshPoints()[i]);
        }
    }
    for (const label pointi : cyclics)
    {
        imagesAt_(pointi);
    }

    for (const label pointi : imagesAt_.sortedToc())
    {
        DynamicList<pointImage> list;
        DynamicList<isometry> ways;
        const auto add =
            [&](const label other, const isometry& image)
            {
                if (placeOf(image, size, ways) == list.size())
                {
                    list.append(pointImage{other, image});
                }
            };
        add(pointi, isometry());

        for (label i = 0; i < list.size(); ++i)
        {
            const pointImage from(list[i]);
            for (const label other : with(from.point))
            {
                const vector shift(x[from.point] - x[other]);
                add(other, from.image.after(isometry::translation(shift)));
            }
            for (const isometry& mirror : mirrors(from.point))
            {
                add(from.point, from.image.after(mirror));
            }
        }

        // Without the mesh itself
        imagesAt_[pointi] = SubList<pointImage>(list, list.size() - 1, 1);
    }
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::pointImages::pointImages
(
    const polyMesh& mesh,
    const domainImages& images
)
{
    Map<DynamicList<label>> across;
    for (const domainImages::seam& seam : images.seams())
    {
        if (seam.mirrors())
        {
            continue;
        }
        const cyclicPolyPatch& half =
            refCast<const cyclicPolyPatch>(mesh.boundaryMesh()[seam.patch]);

        for (const edge& pair : half.coupledPoints())
        {
            across(half.meshPoints()[pair.first()])
                .append(half.neighbPatch().meshPoints()[pair.second()]);
        }
    }

    // At an edge of two cyclic patches four are one
    for (const label pointi : across.sortedToc())
    {
        if (!listOf_.found(pointi))
        {
            DynamicList<label> points;
            points.append(pointi);
            for (label i = 0; i < points.size(); ++i)
            {
                for (const label other : across[points[i]])
                {
                    if (!points.found(other))
                    {
                        points.append(other);
                    }
                }
            }
            sort(points);
            join(points);
        }
    }

    findImages(mesh, images, across.sortedToc());
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::pointImages::join(const UList<label>& vertices)
{
    for (const label vertexi : vertices)
    {
        listOf_.insert(vertexi, same_.size());
    }
    same_.append(labelList(vertices));
}
