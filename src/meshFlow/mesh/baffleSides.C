// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "baffleSides.H"
#include "cyclicPolyPatch.H"
#include "pointImages.H"
#include "wallPolyPatch.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- The group of each mesh cell around points that are one: the lowest that
    //  it is connected with by faces that have one of them
    static Map<label> groups(const polyMesh& mesh, const UList<label>& points)
    {
        const polyBoundaryMesh& patches = mesh.boundaryMesh();
        Map<label> group;
        DynamicList<labelPair> pairs;
        for (const label pointi : points)
        {
            for (const label facei : mesh.pointFaces()[pointi])
            {
                const label own = mesh.faceOwner()[facei];
                const label patchi = patches.whichPatch(facei);
                group.insert(own, own);
                if (patchi < 0)
                {
                    pairs.append(labelPair(own, mesh.faceNeighbour()[facei]));
                }
                else if (points.size() > 1)
                {
                    const auto* half = isA<cyclicPolyPatch>(patches[patchi]);
                    if (half)
                    {
                        const polyPatch& other = half->neighbPatch();
                        const label i = facei - half->start();
                        pairs.append(labelPair(own, other.faceCells()[i]));
                    }
                }
            }
        }
        for (bool changed = true; changed;)
        {
            changed = false;

            for (const labelPair& pair : pairs)
            {
                label& b = group(pair.second(), pair.second());
                label& a = group[pair.first()];

                changed = changed || a != b;
                a = b = min(a, b);
            }
        }

        return group;
    }
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::baffleSides::split
(
    const UList<label>& points,
    pointImages& images
)
{
    const Map<label> group(groups(mesh_, points));
    Map<DynamicList<label>> verticesOf;
    for (const label celli : group.sortedToc())
    {
        verticesOf(group[celli]);
    }
    if (verticesOf.size() < 2)
    {
        // The rim
        return;
    }

    for (const label pointi : points)
    {
        Map<label> vertexOfGroup;
        for (const label celli : mesh_.pointCells()[pointi])
        {
            const label g = group[celli];
            const label next = mesh_.nPoints() + sides_.size();
            if (vertexOfGroup.insert(g, next))
            {
                verticesOf[g].append(next);
                sides_.append(side{pointi, labelList()});
            }
            vertexOf_(pointi).insert(celli, vertexOfGroup[g]);
        }
        for (const label facei : mesh_.pointFaces()[pointi])
        {
            if (!mesh_.isInternalFace(facei))
            {
                const label vertexi = vertex(pointi, mesh_.faceOwner()[facei]);
                sides_[vertexi - mesh_.nPoints()].faces.append(facei);
            }
        }
    }
    if (points.size() > 1)
    {
        for (const label g : verticesOf.sortedToc())
        {
            images.join(verticesOf[g]);
        }
    }
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::baffleSides::baffleSides(const polyMesh& mesh, pointImages& images)
:
    mesh_(mesh)
{
    labelHashSet bafflePoints;
    for (const labelPair& pair : baffleFaces(mesh))
    {
        bafflePoints.insert(mesh.faces()[pair.first()]);
    }

    labelHashSet done;
    for (const label pointi : bafflePoints.sortedToc())
    {
        const labelList points(images.with(pointi));

        if (done.insert(pointi))
        {
            split(points, images);
            done.insert(points);
        }
    }
}


// * * * * * * * * * * * * * * * Global Functions  * * * * * * * * * * * * * //

Foam::DynamicList<Foam::labelPair> Foam::baffleFaces(const polyMesh& mesh)
{
    // The faces of walls by their lowest point
    Map<DynamicList<label>> facesOf;
    DynamicList<labelPair> pairs;

    for (const polyPatch& pp : mesh.boundaryMesh())
    {
        const label nFaces = isA<wallPolyPatch>(pp) ? pp.size() : 0;

        for (label i = 0; i < nFaces; ++i)
        {
            const label facei = pp.start() + i;
            DynamicList<label>& others = facesOf(min(pp[i]));

            for (const label other : others)
            {
                if (face::sameVertices(mesh.faces()[other], pp[i]))
                {
                    pairs.append(labelPair(other, facei));
                }
            }
            others.append(facei);
        }
    }

    return pairs;
}
