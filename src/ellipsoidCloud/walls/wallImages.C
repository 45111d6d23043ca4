// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "wallImages.H"
#include "mergePoints.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    static scalar shortestEdge(const triSurface& surface)
    {
        scalar shortest = GREAT;

        for (const labelledTri& t : surface)
        {
            for (label k = 0; k < 3; ++k)
            {
                const edge e(t[k], t[(k + 1) % 3]);
                shortest = min(shortest, e.mag(surface.points()));
            }
        }

        return shortest;
    }

    //- Is a triangle a part of a plane of symmetry, as seen from behind?
    static bool isBack
    (
        const triPointRef& t,
        const domainImages& images,
        const scalar tolerance
    )
    {
        for (const domainImages::seam& seam : images.seams())
        {
            const auto off =
                [&](const point& x) { return mag((x - seam.x) & seam.n); };

            if
            (
                seam.mirrors()
             && max(off(t.a()), max(off(t.b()), off(t.c()))) < tolerance
             && (t.areaNormal() & seam.n) > 0
            )
            {
                return true;
            }
        }

        return false;
    }
}


// * * * * * * * * * * * * * * * Global Functions  * * * * * * * * * * * * * //

Foam::triSurface Foam::withImages
(
    const triSurface& surface,
    const domainImages& images,
    const boundBox& box,
    const scalar far
)
{
    const boundBox wide(widened(box, far));
    const scalar tolerance = 1e-3*shortestEdge(surface);
    DynamicList<point> points;
    DynamicList<labelledTri> triangles;

    for (const isometry& image : images.near(box, far))
    {
        const bool turnsOver = image.mirrors();
        labelList newLabel(surface.points().size(), -1);

        for (const labelledTri& t : surface)
        {
            point x[3];
            boundBox extent(boundBox::invertedBox);
            for (label k = 0; k < 3; ++k)
            {
                const label from = turnsOver ? t[2 - k] : t[k];
                x[k] = image(surface.points()[from]);
                extent.add(x[k]);
            }

            if
            (
                extent.overlaps(wide)
             && !isBack(triPointRef(x[0], x[1], x[2]), images, tolerance)
            )
            {
                FixedList<label, 3> at;
                for (label k = 0; k < 3; ++k)
                {
                    label& to = newLabel[turnsOver ? t[2 - k] : t[k]];
                    if (to < 0)
                    {
                        to = points.size();
                        points.append(x[k]);
                    }
                    at[k] = to;
                }
                triangles.append(labelledTri(at[0], at[1], at[2], t.region()));
            }
        }
    }

    // Of points that are one the first, that of the mesh
    labelList merged;
    pointField unique(mergePoints(points, tolerance, false, merged));
    for (label i = points.size() - 1; i >= 0; --i)
    {
        unique[merged[i]] = points[i];
    }
    for (labelledTri& t : triangles)
    {
        for (label k = 0; k < 3; ++k)
        {
            t[k] = merged[t[k]];
        }
    }

    return triSurface(List<labelledTri>(triangles), unique);
}
