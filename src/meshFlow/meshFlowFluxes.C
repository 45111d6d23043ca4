// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

/*---------------------------------------------------------------------------*\
Description
    The flux through each face of the tetrahedra: that of the solver through
    the faces of the mesh, none in sum out of any tetrahedron.

\*---------------------------------------------------------------------------*/

#include "cellFluxes.H"
#include "meshFlow.H"
#include "pointImages.H"
#include "cyclicPolyPatch.H"
#include "undecomposedFlow.H"
#include "bitSet.H"
#include "Map.H"
#include "surfaceFields.H"
#include "tetDecomposition.H"
#include "volFields.H"
#include "wallPolyPatch.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    static bool isWall(const polyPatch& pp)
    {
        return isA<wallPolyPatch>(pp);
    }

    //- Is the velocity at a patch given, as where the mesh has no third
    //  dimension? At a mirror it is free along it.
    static bool isConstrained(const polyPatch& pp)
    {
        return
            !pp.coupled() && polyPatch::constraintType(pp.type())
         && !domainImages::isMirror(pp);
    }

    //- For each tetrahedron at a patch of a kind
    template<class Action>
    static void forTetsAt
    (
        const polyMesh& mesh,
        const UList<flowTet>& tets,
        bool isOfKind(const polyPatch&),
        const Action& action
    )
    {
        for (const flowTet& tet : tets)
        {
            const label patchi = -1 - tet.neighbours[0];
            if (patchi >= 0 && isOfKind(mesh.boundaryMesh()[patchi]))
            {
                action(tet);
            }
        }
    }

    //- Edges of triangles on walls, by vertices, and those that are one with
    //  them
    static HashSet<edge, Hash<edge>> wallEdges
    (
        const polyMesh& mesh,
        const UList<flowTet>& tets,
        const UList<flowVertex>& vertices,
        const pointImages& images
    )
    {
        HashSet<edge, Hash<edge>> edges;
        const auto insert =
            [&](const label a, const label b)
            {
                const label nCells = mesh.nCells();
                const auto x = [&](const label vertexi) -> const point&
                {
                    return vertices[vertexi].x;
                };
                const labelList with(images.with(b - nCells));
                for (label p : images.with(a - nCells))
                {
                    p += nCells;
                    const point end(x(p) + x(b) - x(a));
                    for (label q : with)
                    {
                        q += nCells;
                        if (mag(x(q) - end) < 1e-6*mag(x(q) - x(p)))
                        {
                            edges.insert(edge(p, q));
                        }
                    }
                }
            };

        const auto insertEdges =
            [&](const flowTet& tet)
            {
                for (label i = 1; i < 4; ++i)
                {
                    insert(tet.vertices[i], tet.vertices[i % 3 + 1]);
                }
            };
        forTetsAt(mesh, tets, isWall, insertEdges);

        return edges;
    }

    //- Those of the edges of a tetrahedron, a bit for each in lexical order;
    //  fixed are the vertices among which they are
    static label straightEdges
    (
        const flowTet& tet,
        const HashSet<edge, Hash<edge>>& edges,
        const bitSet& fixed
    )
    {
        label straight = 0;
        label edgei = 3;
        for (label a = 1; a < 3; ++a)
        {
            for (label b = a + 1; b < 4; ++b, ++edgei)
            {
                const edge e(tet.vertices[a], tet.vertices[b]);
                if (fixed.test(e[0]) && fixed.test(e[1]) && edges.found(e))
                {
                    straight |= 1 << edgei;
                }
            }
        }

        return straight;
    }

    //- Vertices whose velocity a wall gives, or a patch of a constraint type
    //  that is no plane of symmetry
    static bitSet fixedVertices
    (
        const polyMesh& mesh,
        const UList<flowTet>& tets,
        const pointImages& images,
        const label nVertices
    )
    {
        bitSet fixed(nVertices);
        const auto fix =
            [&](const flowTet& tet)
            {
                for (label i = 1; i < 4; ++i)
                {
                    const label pointi = tet.vertices[i] - mesh.nCells();

                    for (const label other : images.with(pointi))
                    {
                        fixed.set(mesh.nCells() + other);
                    }
                }
            };
        forTetsAt(mesh, tets, isWall, fix);
        forTetsAt(mesh, tets, isConstrained, fix);

        return fixed;
    }

    //- Is a patch the second half of a cyclic one, whose faces and points are
    //  one with those of the first?
    static bool isSecondHalf(const domainImages& images, const polyPatch& pp)
    {
        const domainImages::seam* seam = images.at(pp.index());
        return
            seam && !seam->mirrors()
         && !refCast<const cyclicPolyPatch>(pp).owner();
    }

    //- The flux through a face of the mesh; none through one of an empty patch
    static scalar fluxThrough
    (
        const surfaceScalarField& phi,
        const label facei
    )
    {
        const polyBoundaryMesh& patches = phi.mesh().boundaryMesh();
        const label patchi = patchOf(phi.mesh(), facei);

        if (patchi < 0)
        {
            return phi[facei];
        }
        const scalarField& values = phi.boundaryField()[patchi];
        return values.size() ? values[facei - patches[patchi].start()] : 0;
    }

    //- Mean over a triangle of the velocity that is quadratic on its edges
    static vector meanVelocity
    (
        const flowVertex& a,
        const flowVertex& b,
        const flowVertex& c
    )
    {
        const auto bend =
            [](const flowVertex& v, const flowVertex& w)
            {
                return (v.gradient - w.gradient) & (w.x - v.x);
            };

        return
            (a.u + b.u + c.u)/3 + (bend(a, b) + bend(b, c) + bend(c, a))/24;
    }

    //- For each vertex on planes of symmetry the projection to what lies in all
    //  of them, along which its velocity is free
    static Map<symmTensor> freeAtMirrors
    (
        const polyMesh& mesh,
        const UList<flowTet>& tets,
        const UList<flowVertex>& vertices
    )
    {
        Map<symmTensor> free;
        const auto project =
            [&](const flowTet& tet)
            {
                const point& x = vertices[tet.vertices[1]].x;
                const vector S
                (
                    (vertices[tet.vertices[2]].x - x)
                  ^ (vertices[tet.vertices[3]].x - x)
                );

                for (label i = 1; i < 4; ++i)
                {
                    symmTensor& P =
                        free(tet.vertices[i], symmTensor(symmTensor::I));

                    // Of another plane than those before
                    const vector n(P & (S/mag(S)));
                    if (mag(n) > 1e-3)
                    {
                        P -= sqr(n/mag(n));
                    }
                }
            };
        forTetsAt(mesh, tets, domainImages::isMirror, project);

        return free;
    }

    //- Move the velocities at vertices by what is missing normal to the faces
    //  about them, in the least squares
    static void moveVertices
    (
        const UList<symmTensor>& normals,
        const UList<vector>& missing,
        const bitSet& fixed,
        const Map<symmTensor>& free,
        UList<flowVertex>& vertices
    )
    {
        forAll(vertices, i)
        {
            const scalar size = tr(normals[i]);
            if (!fixed.test(i) && size > 0)
            {
                // Nothing along a direction that no face is normal to
                symmTensor M(normals[i] + 1e-6*size*symmTensor::I);
                vector by(missing[i]);

                // At a mirror what is missing across it cancels with what is
                // missing beyond
                const auto mirror = free.cfind(i);
                if (mirror.found())
                {
                    const symmTensor& P = *mirror;
                    M = symm(P & M & P) + size*(symmTensor::I - P);
                    by = P & by;
                }
                vertices[i].u += inv(M) & by;
            }
        }
    }

    //- For each face, by the mesh cells that own them, the face and the first
    //  and the end of the tetrahedra of its owner at its triangles
    template<class Action>
    static void forOwnedFaces
    (
        const undecomposedFlow& undecomposed,
        const Action& action
    )
    {
        const polyMesh& mesh = undecomposed.mesh();
        label teti = 0;

        forAll(mesh.cells(), celli)
        {
            for (const label facei : mesh.cells()[celli])
            {
                const label first = teti;
                teti += undecomposed.decomposition().nTriangles(facei);

                if (mesh.faceOwner()[facei] == celli)
                {
                    action(facei, first, teti);
                }
            }
        }
    }
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::meshFlow::matchFluxes
(
    const undecomposedFlow& undecomposed,
    const bitSet& fixed
)
{
    const polyMesh& mesh = undecomposed.mesh();
    const surfaceScalarField& phi = undecomposed.phi();

    UList<flowVertex>& vertices = values_->vertices;
    const label firstMean = vertices.size() - meanOf_.size();

    // Least squares for what the velocity of each vertex lacks normal to the
    // faces about it
    symmTensorField normals(vertices.size(), Zero);
    vectorField missing(vertices.size(), Zero);
    DynamicList<label> corners(16);

    const auto compare =
        [&](const label facei, const label first, const label end)
        {
            const label patchi = patchOf(mesh, facei);
            const polyPatch* pp =
                patchi < 0 ? nullptr : &mesh.boundaryMesh()[patchi];
            if (pp && isConstrained(*pp))
            {
                return;
            }

            const bool second = pp && isSecondHalf(images_, *pp);
            scalar flux = fluxThrough(phi, facei);
            vector area(Zero);

            corners.clear();
            corners.append(mesh.faceOwner()[facei]);
            if (!pp)
            {
                corners.append(mesh.faceNeighbour()[facei]);
            }

            for (label teti = first; teti < end; ++teti)
            {
                const label* v = tets_[teti].vertices;
                const flowVertex& a = vertices[v[1]];
                const flowVertex& b = vertices[v[2]];
                const flowVertex& c = vertices[v[3]];
                const vector S(0.5*((b.x - a.x) ^ (c.x - a.x)));

                flux -= meanVelocity(a, b, c) & S;
                area += S;
                const bool fromCorner = v[1] < firstMean;
                label k = teti == first && fromCorner ? 1 : 3;
                for (; k < 4 && !second; ++k)
                {
                    corners.append(v[k]);
                }
            }

            const vector n(area/mag(area));
            const symmTensor along(sqr(n));
            const vector lacks((flux/mag(area))*n);
            for (const label i : corners)
            {
                normals[i] += along;
                missing[i] += lacks;
            }
        };
    forOwnedFaces(undecomposed, compare);
    pointImages_->add(normals, mesh.nCells());
    pointImages_->add(missing, mesh.nCells());

    moveVertices
    (
        normals, missing, fixed, freeAtMirrors(mesh, tets_, vertices), vertices
    );
    setMeans();
}


void Foam::meshFlow::makeExcess(const undecomposedFlow& undecomposed)
{
    const polyMesh& mesh = undecomposed.mesh();
    const UList<flowVertex>& vertices = values_->vertices;
    const auto edges = wallEdges(mesh, tets_, vertices, *pointImages_);
    const bitSet fixed
    (
        fixedVertices(mesh, tets_, *pointImages_, vertices.size())
    );
    matchFluxes(undecomposed, fixed);

    forAll(tets_, teti)
    {
        values_->straight[teti] = straightEdges(tets_[teti], edges, fixed);
    }
    const auto share =
        [&](const label facei, const label first, const label end)
        {
            fluxes_->share
            (
                fluxThrough(undecomposed.phi(), facei), first, end, *values_
            );
        };
    forOwnedFaces(undecomposed, share);

    values_->balanced = direction(0);
}


void Foam::meshFlow::balance
(
    const flowValues& values,
    const label celli
) const
{
    direction* balanced = &values.balanced[celli];
    if (__atomic_load_n(balanced, __ATOMIC_ACQUIRE))
    {
        return;
    }

    const label first = cellTets_[celli];
    fluxes_->spread(first, cellTets_[celli + 1] - first, values);
    __atomic_store_n(balanced, direction(1), __ATOMIC_RELEASE);
}
