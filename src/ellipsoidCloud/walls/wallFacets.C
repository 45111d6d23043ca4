// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "wallFacets.H"
#include "domainImages.H"
#include "foamVersions.H"
#include "fvMesh.H"
#include "tetDecomposition.H"
#include "undecomposedFlow.H"
#include "wallPolyPatch.H"

// * * * * * * * * * * * * * * * Local Classes  * * * * * * * * * * * * * * * //

namespace Foam
{
    //- Longest edge of merged triangles, by a cell's longest semi-axis: most of
    //  a flat wall near a cell is then few triangles. Longer ones save nothing.
    static const scalar mergedEdge = 6;

    //- How deep a part of a wall may be bent that resists as one plane, likewise:
    //  a quarter of the gap at which lubrication ends for the default cell
    static const scalar flatDepth = 2.5e-3;

    //- The triangles of patches, as the flow's tetrahedra have them and the
    //  core takes them
    struct wallTriangles
    {
        DynamicList<point> points;
        DynamicList<FixedList<int, 3>> corners;
        DynamicList<int> labels;
        DynamicList<int> mirror;

        //- Add a patch, whose faces point out of the mesh, facets into the fluid
        void add
        (
            const polyPatch& pp,
            const tetDecomposition& decomposition,
            const bool isMirror
        )
        {
            const label end = pp.start() + pp.size();

            for (label facei = pp.start(); facei < end; ++facei)
            {
                for (label k = 0; k < decomposition.nTriangles(facei); ++k)
                {
                    const auto t = decomposition.triangle(facei, k);

                    corners.append
                    (
                        FixedList<int, 3>{int(t[0]), int(t[2]), int(t[1])}
                    );
                    labels.append(pp.index());
                    mirror.append(isMirror);
                }
            }
        }

        //- For the core, as long as this is not changed
        ellipsoid_triangles view() const
        {
            ellipsoid_triangles t;

            t.point_count = points.size();
            t.point = reinterpret_cast<const double(*)[3]>(points.cdata());
            t.count = corners.size();
            t.corner = reinterpret_cast<const int(*)[3]>(corners.cdata());
            t.label = labels.cdata();
            t.mirror = mirror.cdata();
            return t;
        }
    };
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::List<Foam::scalar> Foam::wallFacets::createWalls
(
    const undecomposedFlow& undecomposed,
    const scalar length,
    const domainImages& images,
    const bool mirrors
) const
{
    const polyMesh& mesh = undecomposed.mesh();
    const tetDecomposition& decomposition = undecomposed.decomposition();
    const boundBox box(meshedBox(mesh));
    const boundBox wide(widened(box, known_ + beyond_));

    wallTriangles triangles;
    triangles.points = mesh.points();
    for (const label facei : decomposition.meanFaces())
    {
        triangles.points.append(decomposition.mean(facei));
    }
    for (const polyPatch& pp : mesh.boundaryMesh())
    {
        const domainImages::seam* seam = images.at(pp.index());
        const bool isMirror = seam && seam->mirrors();

        if (isA<wallPolyPatch>(pp) || (mirrors && isMirror))
        {
            triangles.add(pp, decomposition, isMirror);
        }
    }

    DynamicList<ellipsoid_isometry> moved;
    DynamicList<ellipsoid_symmetry_plane> planes;
    if (!images.empty())
    {
        for (const isometry& image : images.near(box, known_ + beyond_))
        {
            moved.append(ellipsoid_isometry());
            std::copy_n(image.A.v_, 9, moved.last().A[0]);
            std::copy_n(image.b.v_, 3, moved.last().b);
        }
    }
    for (const domainImages::seam& seam : images.seams())
    {
        if (seam.mirrors())
        {
            planes.append(ellipsoid_symmetry_plane());
            std::copy_n(seam.x.v_, 3, planes.last().x);
            std::copy_n(seam.n.v_, 3, planes.last().n);
        }
    }

    ellipsoid_walls_options options = ellipsoid_walls_options();
    options.longest_edge = mergedEdge*length;
    options.flat_depth = flatDepth*length;
    options.image_count = moved.size();
    options.image = moved.cdata();
    options.plane_count = planes.size();
    options.plane = planes.cdata();
    std::copy_n(wide.min().v_, 3, options.low);
    std::copy_n(wide.max().v_, 3, options.high);

    const ellipsoid_triangles given(triangles.view());
    const std::size_t bytes = ellipsoid_walls_size(&given, &options);
    List<scalar> memory(bytes/sizeof(scalar) + 1);
    ellipsoid_walls* walls = nullptr;
    int which = -1;
    const ellipsoid_status status = ellipsoid_walls_create
    (
        memory.data(), bytes, &given, &options, &walls, &which
    );

    if (status == ELLIPSOID_BAD_TRIANGLE)
    {
        FatalErrorInFunction
            << "a wall triangle at "
            << triangles.points[triangles.corners[which][0]]
            << " has no area: checkMesh says more" << exit(FatalError);
    }
    else if (status != ELLIPSOID_OK)
    {
        FatalErrorInFunction
            << "the walls are " << triangles.corners.size() << " triangles, "
            << images.seams().size() << " patches go on in images: too many"
            << exit(FatalError);
    }

    memory.setSize(ellipsoid_walls_bytes(walls)/sizeof(scalar) + 1);
    return memory;
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::wallFacets::wallFacets
(
    const undecomposedFlow& undecomposed,
    const scalar length,
    const domainImages& images,
    const scalar reach,
    const bool mirrors
)
:
    known_(images.empty() ? GREAT : reach),
    beyond_(images.empty() ? 0 : length)
{
    List<scalar> made;

    if (Pstream::master())
    {
        made = createWalls(undecomposed, length, images, mirrors);
        span_ = meshedBox(undecomposed.mesh());
    }
    broadcast(span_);
    memory_.reset(made.size());
    if (Pstream::master())
    {
        memory_.deepCopy(made);
    }
    memory_.share();

    int count;
    ellipsoid_walls_facets(walls(), &count);
    size_ = count;
    if (size_)
    {
        span_.inflate(0.01);
        span_ = widened(span_, beyond_);
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

int Foam::wallFacets::list
(
    const scalar centre[3],
    const scalar reach,
    DynamicList<int>& listed,
    ellipsoid_facet_list& list
) const
{
    if (size_ && (!reaches(pointOf(centre)) || reach > known_))
    {
        return 1;
    }

    // As far as nothing is, where nothing is
    const scalar far = size_ ? min(ELLIPSOID_FAR_REACHES*reach, known_) : GREAT;
    const auto search =
        [&]()
        {
            return ellipsoid_walls_search
            (
                walls(), centre, reach, far, listed.capacity(),
                listed.data(), &list
            );
        };

    const int found = search();
    if (found > listed.capacity())
    {
        listed.reserve(2*found);
        search();
    }

    return 0;
}
