/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/
#include "cyclicPoints.H"
#include "cyclicPolyPatch.H"
#include "domainImages.H"
#include "polyMesh.H"

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::cyclicPoints::cyclicPoints
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

    // At an edge of two such patches four are one
    for (const label pointi : across.sortedToc())
    {
        if (!listOf_.found(pointi))
        {
            DynamicList<label> points;
            points.append(pointi);
            listOf_.insert(pointi, same_.size());

            for (label i = 0; i < points.size(); ++i)
            {
                for (const label other : across[points[i]])
                {
                    if (listOf_.insert(other, same_.size()))
                    {
                        points.append(other);
                    }
                }
            }
            sort(points);
            same_.append(labelList(points));
        }
    }
}


// ************************************************************************* //
