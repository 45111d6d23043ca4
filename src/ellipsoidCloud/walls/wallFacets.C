/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/
#include "wallFacets.H"
#include "flatMerging.H"
#include "foamVersions.H"
#include "fvMesh.H"
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

    //- The point of a face from which it can be cut into triangles: the
    //  preferred one, as the flow's tetrahedra are cut, if all have an area;
    //  else the best; -1 if there is none
    static label fanBase
    (
        const face& f,
        const pointField& points,
        const label preferred
    )
    {
        // Of the face's area; less is a point in line with its neighbours
        const scalar noArea = 1e-10;

        const vector normal(f.areaNormal(points)/(f.mag(points) + VSMALL));
        scalar largest = 0;
        label best = -1;

        for (label i = 0; i < f.size(); ++i)
        {
            const label base = (preferred + i) % f.size();
            scalar smallest = GREAT;

            for (label trii = 1; trii < f.size() - 1; ++trii)
            {
                const point& a = points[f[base]];
                const point& b = points[f[(base + trii) % f.size()]];
                const point& c = points[f[(base + trii + 1) % f.size()]];

                smallest = min(smallest, 0.5*(((b - a) ^ (c - a)) & normal));
            }

            if (smallest > max(largest, noArea*f.mag(points)))
            {
                largest = smallest;
                best = base;
            }
            if (i == 0 && best >= 0)
            {
                break;
            }
        }

        return best;
    }

    //- Split the faces of patches of the undecomposed mesh into triangles
    static triSurface triangulate
    (
        const polyMesh& mesh,
        const std::function<bool(const polyPatch&)>& chosen
    )
    {
        const labelList& basePoints = mesh.tetBasePtIs();
        DynamicList<labelledTri> triangles;

        forAll(mesh.boundaryMesh(), patchi)
        {
            const polyPatch& pp = mesh.boundaryMesh()[patchi];

            if (!chosen(pp))
            {
                continue;
            }

            forAll(pp, i)
            {
                const face& f = pp[i];
                const label preferred = max(basePoints[pp.start() + i], 0);
                const label base = fanBase(f, mesh.points(), preferred);

                if (base < 0)
                {
                    FatalErrorInFunction
                        << "a face of patch " << pp.name() << " at "
                        << f.centre(mesh.points()) << " cannot be cut into "
                        << "triangles from any of its points: "
                        << "checkMesh says more"
                        << exit(FatalError);
                }

                for (label trii = 1; trii < f.size() - 1; ++trii)
                {
                    // Faces point out of the mesh, facets into the fluid
                    triangles.append
                    (
                        labelledTri
                        (
                            f[base],
                            f[(base + trii + 1) % f.size()],
                            f[(base + trii) % f.size()],
                            patchi
                        )
                    );
                }
            }
        }

        return triSurface(List<labelledTri>(triangles), mesh.points());
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
    const polyMesh& mesh,
    const domainImages& images,
    const bool mirrors
) const
{
    const boundBox box(mesh.points(), false);
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
                mesh,
                [](const polyPatch& pp) { return isA<wallPolyPatch>(pp); }
            )
        )
    );
    const triSurface planes
    (
        triangulate
        (
            mesh,
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
        surface_ = made(undecomposed.mesh(), images, mirrors);
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


// ************************************************************************* //
