/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

Description
    The flux through each face of the tetrahedra: that of the solver through
    the faces of the mesh, none in sum out of any tetrahedron.

\*---------------------------------------------------------------------------*/
#include "frozenFlow.H"
#include "mirrorsAtVertices.H"
#include "pointImages.H"
#include "cyclicPolyPatch.H"
#include "tetFlow.H"
#include "undecomposedFlow.H"
#include "LLTMatrix.H"
#include "bitSet.H"
#include "surfaceFields.H"
#include "volFields.H"
#include "wallPolyPatch.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- Edges of triangles on walls, by vertices, and those that are one with them
    static HashSet<edge, Hash<edge>> wallEdges
    (
        const polyMesh& mesh,
        const UList<flowTet>& tets,
        const pointImages& images
    )
    {
        HashSet<edge, Hash<edge>> edges;
        const auto insert =
            [&](const label a, const label b)
            {
                edges.insert(edge(a, b));

                const label nCells = mesh.nCells();
                const pointField& x = mesh.points();
                const labelUList with(images.with(b - nCells));
                for (const label p : images.with(a - nCells))
                {
                    const point end(x[p] + x[b - nCells] - x[a - nCells]);
                    for (const label q : with)
                    {
                        if (mag(x[q] - end) < 1e-6*mag(x[q] - x[p]))
                        {
                            edges.insert(edge(nCells + p, nCells + q));
                        }
                    }
                }
            };

        for (const flowTet& tet : tets)
        {
            const label patchi = -1 - tet.neighbours[0];

            if (patchi >= 0 && isA<wallPolyPatch>(mesh.boundaryMesh()[patchi]))
            {
                for (label i = 1; i < 4; ++i)
                {
                    insert(tet.vertices[i], tet.vertices[i % 3 + 1]);
                }
            }
        }

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

                if (fixed[e.first()] && fixed[e.second()] && edges.found(e))
                {
                    straight |= 1 << edgei;
                }
            }
        }

        return straight;
    }

    //- What velocity and gradient at the first vertex add to the net flux of
    //  the quadratic velocity out of a tetrahedron, in units of these
    static FixedList<scalar, 12> fluxByCentre
    (
        const flowTet& tet,
        const UList<flowVertex>& vertices,
        const scalar unit,
        const scalar gradientUnit
    )
    {
        vector edges[4];
        for (label a = 0; a < 4; ++a)
        {
            edges[a] =
                vertices[tet.vertices[a]].x - vertices[tet.vertices[0]].x;
        }

        // A third of the areas of the faces, inwards
        const vector S[4] =
        {
            ((edges[2] - edges[1]) ^ (edges[1] - edges[3]))/6,
            (edges[2] ^ edges[3])/6,
            (edges[3] ^ edges[1])/6,
            (edges[1] ^ edges[2])/6
        };
        tensor byGradient(Zero);
        for (label a = 1; a < 4; ++a)
        {
            byGradient += (gradientUnit/8)*(S[0] + S[a])*edges[a];
        }

        FixedList<scalar, 12> flux;
        for (direction k = 0; k < 3; ++k)
        {
            flux[k] = unit*S[0][k];
        }
        for (direction k = 0; k < 9; ++k)
        {
            flux[3 + k] = byGradient[k];
        }
        return flux;
    }

    //- The flux that is missing in the tetrahedra of a cell, from a first on
    static scalarField missingIn
    (
        const scalarField& volumes,
        const UList<FixedList<scalar, 4>>& fluxes,
        const UList<flowTetExcess>& excess,
        const label first
    )
    {
        scalarField missing(volumes.size());

        forAll(missing, i)
        {
            const FixedList<scalar, 4>& flux = fluxes[first + i];
            missing[i] =
                -excess[first + i].flux[0]
              - flux[0] - flux[1] - flux[2] - flux[3];
        }

        // A flow that is not free of divergence has it everywhere in the cell
        return missing - sum(missing)/sum(volumes)*volumes;
    }

    //- Spread the flux that is missing in the tetrahedra of a cell by the least
    //  fluxes through the faces between them and the least change of velocity
    //  and gradient at its centre, which makes smaller kinks
    static void spread
    (
        const UList<flowTet>& tets,
        const UList<FixedList<scalar, 4>>& areas,
        const scalarField& volumes,
        const scalarField& missing,
        const label first,
        UList<flowTetExcess>& excess,
        UList<flowVertex>& vertices
    )
    {
        const label n = volumes.size();
        const scalar volume = sum(volumes);
        const scalar unit = Foam::sqrt(100/volume);
        const scalar gradientUnit = Foam::sqrt(1000/volume)/cbrt(volume);
        List<FixedList<scalar, 12>> byCentre(n);
        scalarSquareMatrix conductances(n, Zero);

        for (label i = 0; i < n; ++i)
        {
            byCentre[i] =
                fluxByCentre(tets[first + i], vertices, unit, gradientUnit);

            for (label j = 0; j <= i; ++j)
            {
                scalar product = 0;
                for (label k = 0; k < 12; ++k)
                {
                    product += byCentre[i][k]*byCentre[j][k];
                }
                conductances(i, j) = product;
                conductances(j, i) = product;
            }
        }

        const auto conductance =
            [&](const label i, const label k)
            {
                const label j = tets[first + i].neighbours[k] - first;

                return
                    sqr(areas[i][k])
                   /(mag(volumes[i]) + mag(volumes[j]) + VSMALL);
            };

        for (label i = 0; i < n; ++i)
        {
            for (label k = 1; k < 4; ++k)
            {
                const label j = tets[first + i].neighbours[k] - first;
                conductances(i, i) += conductance(i, k);
                conductances(i, j) -= conductance(i, k);
            }
        }
        conductances(0, 0) *= 2;

        scalarField potential(n);
        LLTMatrix<scalar>(conductances).solve(potential, missing);

        flowVertex& centre = vertices[tets[first].vertices[0]];
        for (label i = 0; i < n; ++i)
        {
            for (direction k = 0; k < 3; ++k)
            {
                centre.u[k] += unit*potential[i]*byCentre[i][k];
            }
            for (direction k = 0; k < 9; ++k)
            {
                centre.gradient[k] +=
                    gradientUnit*potential[i]*byCentre[i][3 + k];
            }
        }

        for (label i = 0; i < n; ++i)
        {
            for (label k = 1; k < 4; ++k)
            {
                const label j = tets[first + i].neighbours[k] - first;
                excess[first + i].flux[k] =
                    conductance(i, k)*(potential[i] - potential[j]);
            }
        }
    }

    //- Is the velocity at a patch given, as where the mesh has no third
    //  dimension? At a mirror it is free along it.
    static bool isConstrained(const polyMesh& mesh, const label patchi)
    {
        const polyPatch& pp = mesh.boundaryMesh()[patchi];
        return
            !pp.coupled() && polyPatch::constraintType(pp.type())
         && !domainImages::isMirror(pp);
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
        for (const flowTet& tet : tets)
        {
            const label patchi = -1 - tet.neighbours[0];

            if
            (
                patchi >= 0
             && (
                    isA<wallPolyPatch>(mesh.boundaryMesh()[patchi])
                 || isConstrained(mesh, patchi)
                )
            )
            {
                for (label i = 1; i < 4; ++i)
                {
                    const label pointi = tet.vertices[i] - mesh.nCells();
                    fixed.set(tet.vertices[i]);
                    for (const label other : images.with(pointi))
                    {
                        fixed.set(mesh.nCells() + other);
                    }
                }
            }
        }

        return fixed;
    }

    //- Is a patch the second half of a cyclic one, whose faces and points are
    //  one with those of the first?
    static bool isSecondHalf
    (
        const polyMesh& mesh,
        const domainImages& images,
        const label patchi
    )
    {
        const domainImages::seam* seam = patchi < 0 ? nullptr : images.at(patchi);
        return
            seam && !seam->mirrors()
         && !refCast<const cyclicPolyPatch>(mesh.boundaryMesh()[patchi]).owner();
    }

    //- The flux through a face of the mesh; none through one of an empty patch
    static scalar fluxThrough
    (
        const surfaceScalarField& phi,
        const label facei
    )
    {
        const polyBoundaryMesh& patches = phi.mesh().boundaryMesh();
        const label patchi = patches.whichPatch(facei);

        if (patchi < 0)
        {
            return phi[facei];
        }
        const scalarField& values = phi.boundaryField()[patchi];
        return values.size() ? values[facei - patches[patchi].start()] : 0;
    }

    //- The velocity in a tetrahedron as it is without bubbles
    static tetFlow quadraticIn
    (
        const flowTet& tet,
        const UList<flowVertex>& vertices,
        const flowTetExcess& excess
    )
    {
        tetFlow flow;
        flow.setQuadratic
        (
            [&](const int a) -> const flowVertex&
            {
                return vertices[tet.vertices[a]];
            },
            excess.straight
        );
        return flow;
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

    //- For each face of the mesh, of the cell that owns it, the face and the
    //  first and the end of the tetrahedra at its triangles
    template<class Action>
    static void forFaces
    (
        const polyMesh& mesh,
        const labelUList& cellTets,
        const Action& action
    )
    {
        for (label celli = 0; celli < mesh.nCells(); ++celli)
        {
            label teti = cellTets[celli];

            for (const label facei : mesh.cells()[celli])
            {
                const label first = teti;
                teti += mesh.faces()[facei].size() - 2;

                if (mesh.faceOwner()[facei] == celli)
                {
                    action(facei, first, teti);
                }
            }
        }
    }
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::frozenFlow::matchFluxes
(
    const undecomposedFlow& undecomposed,
    const pointImages& images,
    const bitSet& fixed
)
{
    const polyMesh& mesh = undecomposed.mesh();
    const surfaceScalarField& phi = undecomposed.phi();

    // Least squares for what the velocity of each vertex lacks normal to the
    // faces about it
    symmTensorField normals(values_.vertices.size(), Zero);
    vectorField missing(values_.vertices.size(), Zero);
    DynamicList<label> corners(16);

    const auto compare =
        [&](const label facei, const label first, const label end)
        {
            const label patchi = mesh.boundaryMesh().whichPatch(facei);
            const bool second = isSecondHalf(mesh, images_, patchi);
            scalar flux = fluxThrough(phi, facei);
            vector area(Zero);

            corners.clear();
            corners.append(mesh.faceOwner()[facei]);
            if (patchi < 0)
            {
                corners.append(mesh.faceNeighbour()[facei]);
            }

            for (label teti = first; teti < end; ++teti)
            {
                const label* v = tets_[teti].vertices;
                const flowVertex& a = values_.vertices[v[1]];
                const flowVertex& b = values_.vertices[v[2]];
                const flowVertex& c = values_.vertices[v[3]];
                const vector S(0.5*((b.x - a.x) ^ (c.x - a.x)));

                flux -= meanVelocity(a, b, c) & S;
                area += S;
                for (label a = teti == first ? 1 : 3; a < 4 && !second; ++a)
                {
                    corners.append(v[a]);
                }
            }

            if (patchi >= 0 && isConstrained(mesh, patchi))
            {
                return;
            }

            const vector n(area/mag(area));
            for (const label i : corners)
            {
                normals[i] += sqr(n);
                missing[i] += (flux/mag(area))*n;
            }
        };
    forFaces(mesh, cellTets_, compare);
    images.add(normals, mesh.nCells());
    images.add(missing, mesh.nCells());

    moveVertices
    (
        normals,
        missing,
        fixed,
        freeAtMirrors(mesh, tets_, values_.vertices),
        values_.vertices
    );
}


void Foam::frozenFlow::makeExcess
(
    const undecomposedFlow& undecomposed,
    const pointImages& images
)
{
    const polyMesh& mesh = undecomposed.mesh();
    const auto edges = wallEdges(mesh, tets_, images);
    const bitSet fixed
    (
        fixedVertices(mesh, tets_, images, values_.vertices.size())
    );
    matchFluxes(undecomposed, images, fixed);

    List<FixedList<scalar, 4>> areas(tets_.size());
    List<FixedList<scalar, 4>> fluxes(tets_.size());
    scalarField volumes(tets_.size());

    forAll(tets_, teti)
    {
        const flowTet& tet = tets_[teti];
        values_.excess[teti] =
            flowTetExcess{{0, 0, 0, 0}, straightEdges(tet, edges, fixed)};

        tetCoordinates c;
        setCoordinates(teti, values_.vertices[tet.vertices[0]].x, c);
        const tetFlow flow
        (
            quadraticIn(tet, values_.vertices, values_.excess[teti])
        );
        volumes[teti] = flow.volume();

        for (label i = 0; i < 4; ++i)
        {
            areas[teti][i] = 3*mag(flow.volume()*c.gradient[i]);
            fluxes[teti][i] = flow.quadraticFlux(c.gradient, i);
        }
    }

    // Through the faces of the mesh, as to their triangles' areas
    const auto share =
        [&](const label facei, const label first, const label end)
        {
            scalar missing = fluxThrough(undecomposed.phi(), facei);
            scalar area = 0;

            for (label i = first; i < end; ++i)
            {
                area += areas[i][0];
                missing -= fluxes[i][0];
            }
            for (label i = first; i < end; ++i)
            {
                values_.excess[i].flux[0] = missing*areas[i][0]/area;

                if (tets_[i].neighbours[0] >= 0)
                {
                    values_.excess[tets_[i].neighbours[0]].flux[0] =
                        -values_.excess[i].flux[0];
                }
            }
        };
    forFaces(mesh, cellTets_, share);

    for (label celli = 0; celli < mesh.nCells(); ++celli)
    {
        const label first = cellTets_[celli];
        const label n = cellTets_[celli + 1] - first;
        const scalarField cellVolumes(SubField<scalar>(volumes, n, first));

        spread
        (
            tets_,
            SubList<FixedList<scalar, 4>>(areas, n, first),
            cellVolumes,
            missingIn(cellVolumes, fluxes, values_.excess, first),
            first,
            values_.excess,
            values_.vertices
        );
    }
}


// ************************************************************************* //
