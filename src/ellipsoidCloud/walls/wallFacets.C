// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "wallFacets.H"
#include "flatMerging.H"
#include "foamVersions.H"
#include "fvMesh.H"
#include "tetDecomposition.H"
#include "treeBoundBox.H"
#include "treeDataTriSurface.H"
#include "undecomposedFlow.H"
#include "wallImages.H"
#include "wallPolyPatch.H"

#include <cmath>
#include <functional>

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- Longest edge of merged triangles, by a cell's longest semi-axis: most of
    //  a flat wall near a cell is then few triangles. Longer ones save nothing.
    static const scalar mergedEdge = 6;

    //- The triangles of the faces of patches, as the flow's tetrahedra have
    //  them
    static triSurface triangulate
    (
        const undecomposedFlow& undecomposed,
        const std::function<bool(const polyPatch&)>& chosen
    )
    {
        const polyMesh& mesh = undecomposed.mesh();
        const tetDecomposition& decomposition = undecomposed.decomposition();
        DynamicList<labelledTri> triangles;
        DynamicList<point> points(mesh.points());

        for (const label facei : decomposition.meanFaces())
        {
            points.append(decomposition.mean(facei));
        }

        for (const polyPatch& pp : mesh.boundaryMesh())
        {
            const label end = chosen(pp) ? pp.start() + pp.size() : 0;

            for (label facei = pp.start(); facei < end; ++facei)
            {
                for (label k = 0; k < decomposition.nTriangles(facei); ++k)
                {
                    // Faces point out of the mesh, facets into the fluid
                    const auto t = decomposition.triangle(facei, k);
                    triangles.append
                    (
                        labelledTri(t[0], t[2], t[1], pp.index())
                    );
                }
            }
        }

        return triSurface(List<labelledTri>(triangles), pointField(points));
    }

    //- The cube of space that holds a point
    static FixedList<label, 3> cubeAt(const point& x, const scalar size)
    {
        return FixedList<label, 3>
        ({
            label(std::floor(x.x()/size)),
            label(std::floor(x.y()/size)),
            label(std::floor(x.z()/size))
        });
    }

    //- Two surfaces that share no points
    static triSurface both(const triSurface& a, const triSurface& b)
    {
        DynamicList<labelledTri> triangles(a);
        DynamicList<point> points(a.points());
        points.append(b.points());

        for (const labelledTri& t : b)
        {
            const label n = a.points().size();
            triangles.append
            (
                labelledTri(t[0] + n, t[1] + n, t[2] + n, t.region())
            );
        }

        return triSurface(List<labelledTri>(triangles), pointField(points));
    }
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::triSurface Foam::wallFacets::made
(
    const undecomposedFlow& undecomposed,
    const domainImages& images,
    const bool mirrors
) const
{
    const boundBox box(undecomposed.mesh().points(), false);
    const scalar far = known_ + beyond_;
    const auto merged =
        [&](const triSurface& of)
        {
            return flatMerged
            (
                images.empty() ? of : withImages(of, images, box, far),
                mergedEdge*regionSize_
            );
        };

    const triSurface walls
    (
        merged
        (
            triangulate
            (
                undecomposed,
                [](const polyPatch& pp) { return isA<wallPolyPatch>(pp); }
            )
        )
    );
    const triSurface planes
    (
        triangulate
        (
            undecomposed,
            [&](const polyPatch& pp)
            {
                const domainImages::seam* seam = images.at(pp.index());
                return mirrors && seam && seam->mirrors();
            }
        )
    );

    return planes.size() ? both(walls, merged(planes)) : walls;
}


void Foam::wallFacets::setFacets(const domainImages& images)
{
    facets_.setSize(surface_.size());
    spheres_.setSize(surface_.size());

    forAll(facets_, faceti)
    {
        ellipsoid_facet& f = facets_[faceti];
        double vertex[3][3];

        for (label k = 0; k < 3; ++k)
        {
            const point& x = surface_.points()[surface_[faceti][k]];
            std::copy_n(x.v_, 3, vertex[k]);
        }

        if (!ellipsoid_facet_set(&f, vertex))
        {
            FatalErrorInFunction
                << "a wall triangle at " << pointOf(vertex[0])
                << " has no area: checkMesh says more"
                << exit(FatalError);
        }

        f.surface = surface_[faceti].region();
        const domainImages::seam* seam = images.at(f.surface);
        f.mirror = seam && seam->mirrors();
        spheres_[faceti] = sphere{pointOf(f.middle), f.radius};
    }

    // By wide cubes of space, so that those of a box are near one another
    List<FixedList<label, 3>> cubes(spheres_.size());
    forAll(cubes, i)
    {
        cubes[i] = cubeAt(spheres_[i].centre, 4*regionSize_);
    }
    sortedOrder(cubes, inBoxes_);

    boxes_.setSize((spheres_.size() + boxed - 1)/boxed);
    forAll(inBoxes_, i)
    {
        const sphere& s = spheres_[inBoxes_[i]];
        boxes_[i/boxed].add(s.centre - s.radius*vector::one);
        boxes_[i/boxed].add(s.centre + s.radius*vector::one);
    }
}


void Foam::wallFacets::setEdges()
{
    // Where the wall ends at an open patch the edge stays free. More than two
    // facets share one where baffles join.
    forAll(surface_.edgeFaces(), edgei)
    {
        const labelList& sharing = surface_.edgeFaces()[edgei];

        for (const label faceti : sharing)
        {
            const triFace& local = surface_.localFaces()[faceti];
            const edge& e = surface_.edges()[edgei];
            label k = 0;
            while (edge(local[k], local[(k + 1) % 3]) != e)
            {
                ++k;
            }

            for (const label otheri : sharing)
            {
                if (otheri != faceti)
                {
                    ellipsoid_facet_join(&facets_[faceti], k, &facets_[otheri]);
                }
            }
        }
    }
}


void Foam::wallFacets::setStars()
{
    const labelListList& pointEdges = surface_.pointEdges();
    const pointField& points = surface_.localPoints();
    DynamicList<vector> stars(2*surface_.nEdges());
    labelList start(points.size());

    forAll(pointEdges, pointi)
    {
        start[pointi] = stars.size();

        for (const label edgei : pointEdges[pointi])
        {
            const label other = surface_.edges()[edgei].otherVertex(pointi);
            stars.append(normalised(points[other] - points[pointi]));
        }
    }

    stars_.transfer(stars);

    forAll(facets_, faceti)
    {
        for (label k = 0; k < 3; ++k)
        {
            const label pointi = surface_.localFaces()[faceti][k];

            facets_[faceti].star_count[k] = pointEdges[pointi].size();
            facets_[faceti].star[k] = &stars_.cdata()[start[pointi]].v_;
        }
    }
}


const Foam::wallFacets::region& Foam::wallFacets::regionAt
(
    const point& x,
    const scalar reach
) const
{
    const bool wide = reach > 2*regionSize_;
    const scalar edge = wide ? 2*regionSize_ : regionSize_;
    const FixedList<label, 3> key(cubeAt(x, edge));

    region& here = (wide ? wideRegions_ : regions_)
    (
        key,
        region{-1, labelList(), List<sphere>()}
    );

    if (here.reach < reach)
    {
        // Somewhat more: inside a step the length of q, and with it the reach,
        // differs from pose to pose, and the next may ask for a little more
        here.reach = 1.05*reach;

        const point corner(edge*vector(key[0], key[1], key[2]));
        const vector half(0.5*edge*vector::one);
        const vector margin((here.reach + 1e-6*edge)*vector::one);
        const boundBox cube(corner, corner + 2*half);
        const boundBox about(cube.min() - margin, cube.max() + margin);
        DynamicList<label> facets;

        forAll(boxes_, boxi)
        {
            const label end = min((boxi + 1)*boxed, spheres_.size());
            const label first = boxes_[boxi].overlaps(about) ? boxi*boxed : end;

            for (label i = first; i < end; ++i)
            {
                const sphere& s = spheres_[inBoxes_[i]];
                const vector off(cmptMag(s.centre - corner - half) - half);
                const scalar far = margin.x() + s.radius;

                if (magSqr(max(off, vector::zero)) < sqr(far))
                {
                    facets.append(inBoxes_[i]);
                }
            }
        }

        here.facets = facets;
        std::sort(here.facets.begin(), here.facets.end());
        here.spheres = UIndirectList<sphere>(spheres_, here.facets);
    }

    return here;
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
    regionSize_(length),
    known_(images.empty() ? GREAT : reach),
    beyond_(images.empty() ? 0 : length)
{
    if (Pstream::master())
    {
        surface_ = made(undecomposed, images, mirrors);
        span_ = boundBox(undecomposed.mesh().points(), false);
    }

    broadcast(span_);
    broadcast(surface_);

    setFacets(images);
    setEdges();
    setStars();

    if (surface_.size())
    {
        span_.inflate(0.01);
        span_ = widened(span_, beyond_);

        // A tree does not know what is outside its box
        boundBox all(span_);
        all.add(surface_.points());

        tree_.reset
        (
            new indexedOctree<treeDataTriSurface>
            (
                treeDataTriSurface(true, surface_, 1e-6),
                treeBoundBox(all),
                10,
                10,
                3
            )
        );
    }
}


// * * * * * * * * * * * * * * * * Destructor  * * * * * * * * * * * * * * * //

Foam::wallFacets::~wallFacets() = default;


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

int Foam::wallFacets::list
(
    const scalar centre[3],
    const scalar reach,
    DynamicList<label>& listed,
    ellipsoid_facet_list& list
) const
{
    const point c(pointOf(centre));

    listed.clear();
    list.reach = reach;

    if (facets_.empty())
    {
        list.reach = GREAT;
    }
    else if (!reaches(c) || reach > known_)
    {
        return 1;
    }
    else
    {
        const region& here = regionAt(c, reach);

        // Without a branch, which would be predicted wrongly half of the time
        listed.setSize(here.facets.size());
        label n = 0;
        forAll(here.facets, i)
        {
            const sphere& b = here.spheres[i];

            listed[n] = here.facets[i];
            n += magSqr(c - b.centre) <= sqr(reach + b.radius);
        }
        listed.setSize(n);

        if (listed.empty())
        {
            // As far as nothing is
            const scalar far = min(1000*reach, known_);
            const pointIndexHit nearest(tree_->findNearest(c, sqr(far)));

            list.reach = nearest.hit() ? mag(nearest.hitPoint() - c) : far;
        }
    }

    list.facets = facets_.cdata();
    list.index = listed.cdata();
    list.count = listed.size();

    return 0;
}
