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
#include "wallPolyPatch.H"
#include "treeBoundBox.H"
#include "Pstream.H"

#include <algorithm>
#include <cmath>

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    static inline void copyTo(scalar to[3], const vector& from)
    {
        std::copy_n(from.v_, 3, to);
    }
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::label Foam::wallFacets::fanBase
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


Foam::triSurface Foam::wallFacets::triangulate(const polyMesh& mesh)
{
    const labelList& basePoints = mesh.tetBasePtIs();
    DynamicList<labelledTri> triangles;

    forAll(mesh.boundaryMesh(), patchi)
    {
        const polyPatch& pp = mesh.boundaryMesh()[patchi];

        if (!isA<wallPolyPatch>(pp))
        {
            continue;
        }

        forAll(pp, i)
        {
            const face& f = pp[i];
            const label base = fanBase
            (
                f,
                mesh.points(),
                max(basePoints[pp.start() + i], label(0))
            );

            if (base < 0)
            {
                FatalErrorInFunction
                    << "a face of wall " << pp.name() << " at "
                    << f.centre(mesh.points()) << " cannot be cut into "
                    << "triangles from any of its points: checkMesh says more"
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


Foam::triSurface Foam::wallFacets::compacted(const triSurface& surface)
{
    List<labelledTri> triangles(surface.size());

    forAll(surface, faceti)
    {
        const triFace& f = surface.localFaces()[faceti];

        triangles[faceti] =
            labelledTri(f[0], f[1], f[2], surface[faceti].region());
    }

    return triSurface(triangles, surface.localPoints());
}


void Foam::wallFacets::setFacets()
{
    facets_.setSize(surface_.size());

    forAll(facets_, faceti)
    {
        ellipsoid_facet& f = facets_[faceti];
        const labelledTri& triangle = surface_[faceti];
        double vertex[3][3];

        for (label k = 0; k < 3; ++k)
        {
            copyTo(vertex[k], surface_.points()[triangle[k]]);
        }

        if (!ellipsoid_facet_set(&f, vertex))
        {
            FatalErrorInFunction
                << "a wall triangle at " << pointOf(vertex[0])
                << " has no area: checkMesh says more"
                << exit(FatalError);
        }

        f.surface = triangle.region();
    }
}


void Foam::wallFacets::setEdges()
{
    // Where the wall ends at an open patch the edge stays a free rim
    const labelListList& edgeFaces = surface_.edgeFaces();

    forAll(surface_, faceti)
    {
        ellipsoid_facet& f = facets_[faceti];
        const triFace& local = surface_.localFaces()[faceti];

        for (label k = 0; k < 3; ++k)
        {
            const edge e(local[k], local[(k + 1) % 3]);

            for (const label edgei : surface_.faceEdges()[faceti])
            {
                if (surface_.edges()[edgei] != e)
                {
                    continue;
                }

                // More than one other where baffles meet
                for (const label otheri : edgeFaces[edgei])
                {
                    if (otheri != faceti)
                    {
                        ellipsoid_facet_join(&f, k, &facets_[otheri]);
                    }
                }
            }
        }
    }
}


void Foam::wallFacets::setStars()
{
    const labelListList& pointEdges = surface_.pointEdges();
    const edgeList& edges = surface_.edges();
    const pointField& points = surface_.localPoints();

    labelList start(points.size() + 1, Zero);
    forAll(pointEdges, pointi)
    {
        start[pointi + 1] = start[pointi] + pointEdges[pointi].size();
    }

    stars_.setSize(start.last());

    forAll(pointEdges, pointi)
    {
        forAll(pointEdges[pointi], i)
        {
            const edge& e = edges[pointEdges[pointi][i]];

            copyTo
            (
                stars_[start[pointi] + i].data(),
                normalised(points[e.otherVertex(pointi)] - points[pointi])
            );
        }
    }

    forAll(facets_, faceti)
    {
        for (label k = 0; k < 3; ++k)
        {
            const label pointi = surface_.localFaces()[faceti][k];

            facets_[faceti].star_count[k] = pointEdges[pointi].size();
            facets_[faceti].star[k] =
                reinterpret_cast<const double (*)[3]>
                (
                    stars_.cdata() + start[pointi]
                );
        }
    }
}


void Foam::wallFacets::setBalls()
{
    balls_.setSize(facets_.size());

    forAll(balls_, faceti)
    {
        balls_[faceti].middle = pointOf(facets_[faceti].middle);
        balls_[faceti].radius = facets_[faceti].radius;
    }
}


const Foam::wallFacets::region& Foam::wallFacets::regionAt
(
    const point& x,
    const scalar reach
) const
{
    const FixedList<label, 3> key
    ({
        label(std::floor(x.x()/regionSize_)),
        label(std::floor(x.y()/regionSize_)),
        label(std::floor(x.z()/regionSize_))
    });

    region& here = regions_(key, region{-1, labelList()});

    if (here.reach < reach)
    {
        const point corner(regionSize_*vector(key[0], key[1], key[2]));
        const vector margin(reach*vector::one);

        here.reach = reach;
        here.facets = tree_->findBox
        (
            treeBoundBox
            (
                corner - margin, corner + regionSize_*vector::one + margin
            )
        );
        std::sort(here.facets.begin(), here.facets.end());
    }

    return here;
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::wallFacets::wallFacets(const polyMesh* wholeMesh, const scalar length)
:
    regionSize_(length)
{
    List<labelledTri> triangles;
    pointField points;

    if (Pstream::master())
    {
        const triSurface faces(compacted(triangulate(*wholeMesh)));
        const triSurface merged
        (
            compacted(flatMerging(faces, 2*length).merged())
        );

        triangles = merged;
        points = merged.points();
        span_ = boundBox(wholeMesh->points(), false);
    }

    Pstream::scatter(span_.min());
    Pstream::scatter(span_.max());
    Pstream::scatter(triangles);
    Pstream::scatter(points);

    surface_ = triSurface(triangles, points);

    setFacets();
    setEdges();
    setStars();
    setBalls();

    if (surface_.size())
    {
        span_.inflate(0.01);

        tree_.reset
        (
            new indexedOctree<treeDataTriSurface>
            (
                treeDataTriSurface(true, surface_, 1e-6),
                treeBoundBox(span_),
                10,
                10,
                3
            )
        );
    }
}


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
    else if (!span_.contains(c))
    {
        return 1;
    }
    else
    {
        for (const label faceti : regionAt(c, reach).facets)
        {
            const ball& b = balls_[faceti];

            if (magSqr(c - b.middle) <= sqr(reach + b.radius))
            {
                listed.append(faceti);
            }
        }

        if (listed.empty())
        {
            // As far as nothing is
            const scalar far = 1000*reach;
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
