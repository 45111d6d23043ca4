/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

Description
    The tetrahedra of the frozen flow and the values at their vertices, made
    on the master from the undecomposed fields.

\*---------------------------------------------------------------------------*/
#include "frozenFlow.H"
#include "undecomposedFlow.H"
#include "vertexFit.H"
#include "bitSet.H"
#include "cyclicPolyPatch.H"
#include "volPointInterpolation.H"
#include "fvcGrad.H"
#include "wallsAtVertices.H"
#include "DynamicList.H"
#include "transform.H"

#include <cmath>

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- A field at a side of a baffle: of the faces around the point, as at all
    //  points of the boundary
    template<class Type>
    static Type atSide
    (
        const GeometricField<Type, fvPatchField, volMesh>& field,
        const baffleSides::side& side
    )
    {
        const polyMesh& mesh = field.mesh();
        const point& x = mesh.points()[side.point];

        Type value(Zero);
        scalar sum = 0;

        for (const label facei : side.faces)
        {
            const label patchi = mesh.boundaryMesh().whichPatch(facei);
            const polyPatch& pp = mesh.boundaryMesh()[patchi];
            const fvPatchField<Type>& pf = field.boundaryField()[patchi];

            if (!pp.coupled() && pf.size())
            {
                const scalar weight = 1/mag(x - mesh.faceCentres()[facei]);

                value += weight*pf[facei - pp.start()];
                sum += weight;
            }
        }

        return value/sum;
    }

    //- A field at a point of a plane of symmetry by what is about it, as in the
    //  mesh of the whole: faces of the boundary, or mesh cells if there are none
    template<class Type>
    static Type beforeMirror
    (
        const GeometricField<Type, fvPatchField, volMesh>& field,
        const domainImages& images,
        const label pointi
    )
    {
        const polyMesh& mesh = field.mesh();
        const point& x = mesh.points()[pointi];

        Type atFaces(Zero);
        Type atCells(Zero);
        scalar faceWeights = 0;
        scalar cellWeights = 0;

        for (const label facei : mesh.pointFaces()[pointi])
        {
            const label patchi = mesh.boundaryMesh().whichPatch(facei);

            if (patchi >= 0 && !images.at(patchi))
            {
                const scalar w = 1/mag(x - mesh.faceCentres()[facei]);
                const label start = mesh.boundaryMesh()[patchi].start();
                atFaces += w*field.boundaryField()[patchi][facei - start];
                faceWeights += w;
            }
        }
        for (const label celli : mesh.pointCells()[pointi])
        {
            const scalar w = 1/mag(x - mesh.cellCentres()[celli]);
            atCells += w*field[celli];
            cellWeights += w;
        }

        return faceWeights > 0 ? atFaces/faceWeights : atCells/cellWeights;
    }

    //- Make a field at the points of planes of symmetry what it is in the mesh
    //  of the whole
    template<class Type>
    static void mirror
    (
        const GeometricField<Type, fvPatchField, volMesh>& field,
        const domainImages& images,
        UList<Type>& atPoints
    )
    {
        const polyMesh& mesh = field.mesh();
        bitSet isCyclic(mesh.nPoints());
        DynamicList<domainImages::seam> mirrors;

        for (const domainImages::seam& seam : images.seams())
        {
            if (seam.mirrors())
            {
                mirrors.append(seam);
                continue;
            }
            isCyclic.set(mesh.boundaryMesh()[seam.patch].meshPoints());
        }

        for (const domainImages::seam& seam : mirrors)
        {
            for
            (
                const label pointi
              : mesh.boundaryMesh()[seam.patch].meshPoints()
            )
            {
                // At a cyclic patch the other side counts as well
                if (!isCyclic.test(pointi))
                {
                    atPoints[pointi] = beforeMirror(field, images, pointi);
                }
            }
        }
        for (const domainImages::seam& seam : mirrors)
        {
            for
            (
                const label pointi
              : mesh.boundaryMesh()[seam.patch].meshPoints()
            )
            {
                Type& value = atPoints[pointi];
                value = 0.5*(value + transform(seam.inward.turn(), value));
            }
        }
    }

    //- A field at all vertices. Ends the run if a value is not finite.
    template<class Type>
    static Field<Type> atVertices
    (
        const GeometricField<Type, fvPatchField, volMesh>& field,
        const domainImages& images,
        const baffleSides& baffles,
        const char* name = "flow",
        const char* advice = "solve the flow again from clean fields"
    )
    {
        const label nCells = field.mesh().nCells();
        const label nPoints = field.mesh().nPoints();
        Field<Type> values(nCells + nPoints + baffles.sides().size());

        SubList<Type>(values, nCells) = field.primitiveField();
        SubList<Type>(values, nPoints, nCells) =
            volPointInterpolation::New(field.mesh()).interpolate(field)()
           .primitiveField();

        SubList<Type> atPoints(values, nPoints, nCells);
        mirror(field, images, atPoints);

        forAll(baffles.sides(), sidei)
        {
            values[nCells + nPoints + sidei] =
                atSide(field, baffles.sides()[sidei]);
        }

        for (const Type& value : values)
        {
            for (const scalar component : value.v_)
            {
                if (!std::isfinite(component))
                {
                    FatalErrorInFunction
                        << "the " << name << " field holds a value that is not "
                        << "finite: " << advice << exit(FatalError);
                }
            }
        }

        return values;
    }

    //- Split a cell into tetrahedra from a first on, with the first tetrahedra
    //  of all faces on both sides
    static void splitCell
    (
        const polyMesh& mesh,
        const baffleSides& baffles,
        const UList<labelPair>& faceTets,
        const label celli,
        const labelUList& bases,
        label teti,
        UList<flowTet>& tets
    )
    {
        // The tetrahedron, and its face, at each edge of the cell's surface
        // until the one on the other side is there: few at a time
        struct openEdge { edge at; label tet; label face; };
        DynamicList<openEdge> open;

        for (const label facei : mesh.cells()[celli])
        {
            const face& f = mesh.faces()[facei];
            const label owned = (mesh.faceOwner()[facei] == celli);
            const label base = bases[facei];
            const label patchi = mesh.boundaryMesh().whichPatch(facei);

            for (label trii = 1; trii < f.size() - 1; ++trii, ++teti)
            {
                // The normal of a face points out of its owner
                const label corners[3] =
                {
                    f[base],
                    f[(base + trii + 1 - owned) % f.size()],
                    f[(base + trii + owned) % f.size()]
                };

                flowTet& tet = tets[teti];
                tet.vertices[0] = celli;
                tet.neighbours[0] =
                    patchi < 0
                  ? faceTets[facei][owned] + trii - 1
                  : -1 - patchi;

                for (label i = 0; i < 3; ++i)
                {
                    tet.vertices[i + 1] =
                        mesh.nCells() + baffles.vertex(corners[i], celli);

                    const edge e(corners[(i + 1) % 3], corners[(i + 2) % 3]);
                    label k = open.size() - 1;
                    while (k >= 0 && open[k].at != e)
                    {
                        --k;
                    }

                    if (k < 0)
                    {
                        open.append(openEdge{e, teti, i + 1});
                        continue;
                    }
                    tet.neighbours[i + 1] = open[k].tet;
                    tets[open[k].tet].neighbours[open[k].face] = teti;
                    open[k] = open.last();
                    open.remove();
                }
            }
        }

        if (open.size())
        {
            FatalErrorInFunction
                << "cell " << celli << " at " << mesh.cellCentres()[celli]
                << " is not closed: checkMesh says more" << exit(FatalError);
        }
    }

    //- The tetrahedra of a mesh, and the first of each cell
    static void makeTets
    (
        const polyMesh& mesh,
        const baffleSides& baffles,
        const bool widest,
        UList<label>& cellTets,
        UList<flowTet>& tets
    )
    {
        // Triangles of a face, in fan order, are tetrahedra first + 0, 1, ...
        // of its owner, and second + 0, 1, ... of its neighbour
        List<labelPair> faceTets(mesh.nFaces(), labelPair(-1, -1));
        label nTets = 0;

        forAll(mesh.cells(), celli)
        {
            cellTets[celli] = nTets;

            for (const label facei : mesh.cells()[celli])
            {
                faceTets[facei][mesh.faceOwner()[facei] != celli] = nTets;
                nTets += mesh.faces()[facei].size() - 2;
            }
        }
        cellTets[mesh.nCells()] = nTets;

        labelList bases(mesh.tetBasePtIs());
        forAll(bases, facei)
        {
            bases[facei] =
                widest
              ? frozenFlow::fanBase(mesh, facei)
              : max(bases[facei], label(0));
        }

        // Both halves of a cyclic patch alike: faces begin with the same point
        // and go round in opposite senses
        for (const polyPatch& pp : mesh.boundaryMesh())
        {
            if (!isA<cyclicPolyPatch>(pp))
            {
                continue;
            }
            const cyclicPolyPatch& half = refCast<const cyclicPolyPatch>(pp);
            forAll(half, i)
            {
                const label n = half[i].size();
                if (half.owner())
                {
                    bases[half.neighbPatch().start() + i] =
                        (n - bases[half.start() + i]) % n;
                }
            }
        }

        forAll(mesh.cells(), celli)
        {
            splitCell
            (
                mesh, baffles, faceTets, celli, bases, cellTets[celli], tets
            );
        }
    }

    //- The vertices, with fluid at rest
    static void makeVertices
    (
        const fvMesh& mesh,
        const baffleSides& baffles,
        UList<flowVertex>& vertices
    )
    {
        const label nCells = mesh.nCells();

        forAll(vertices, i)
        {
            const label j = i - nCells;
            const label pointi =
                j < mesh.nPoints()
              ? j
              : baffles.sides()[j - mesh.nPoints()].point;

            vertices[i] = flowVertex
            {
                j < 0 ? mesh.cellCentres()[i] : mesh.points()[pointi],
                Zero, Zero, Zero
            };
        }
    }

    //- Set the flow at the vertices, the gradient only if it is interpolated
    static void setVertices
    (
        const undecomposedFlow& undecomposed,
        const scalar rho,
        const domainImages& images,
        const baffleSides& baffles,
        const bool interpolated,
        UList<flowVertex>& vertices
    )
    {
        const volVectorField& flow = undecomposed.U();
        const label nCells = flow.size();
        const vectorField U(atVertices(flow, images, baffles));
        const tensorField gradU
        (
            interpolated
          ? atVertices(fvc::grad(flow)(), images, baffles)
          : tensorField(U.size(), Zero)
        );
        const vectorField gradp
        (
            atVertices((rho*fvc::grad(undecomposed.p()))(), images, baffles)
        );

        const wallsAtVertices walls(flow, baffles);

        forAll(vertices, i)
        {
            // A point that a wall shares with an open patch moves with the
            // wall, either side of a baffle by itself
            const label j = i - nCells;
            const bool atWall = j >= 0 && walls.faces(j).size();

            vertices[i].u = atWall ? walls.mean(walls.faces(j)) : U[i];
            vertices[i].gradient = gradU[i].T();
            vertices[i].pressureGradient = gradp[i];
        }
    }
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::frozenFlow::setFlow
(
    const undecomposedFlow& undecomposed,
    const scalar rho,
    const baffleSides& baffles
)
{
    UList<flowVertex>& vertices = values_.vertices;
    const bool interpolated =
        scheme_ == stCellPoint || scheme_ == stCellPointQuadratic;
    setVertices(undecomposed, rho, images_, baffles, interpolated, vertices);

    if (scheme_ == stDivergenceFree)
    {
        const pointImages images(undecomposed.mesh(), images_);
        const vertexFit fit(undecomposed.U(), baffles, images);

        forAll(vertices, i)
        {
            vertices[i].u = fit.u[i];
            vertices[i].gradient = fit.gradient[i];
        }
        makeExcess(undecomposed, images);
    }
    else if (scheme_ == stPartitionOfUnity)
    {
        const pointImages images(undecomposed.mesh(), images_);
        unity_.setFits(undecomposed.U(), baffles, images, values_.fits);
    }
}


void Foam::frozenFlow::make
(
    const undecomposedFlow& undecomposed,
    const autoPtr<volVectorField>& E
)
{
    const bool master = Pstream::master();
    bool hasField = E.valid();
    broadcast(hasField);

    autoPtr<baffleSides> baffles;
    label nVertices = 0;
    label nTets = 0;
    if (master)
    {
        const fvMesh& mesh = undecomposed.mesh();
        baffles.reset(new baffleSides(mesh));
        nVertices = mesh.nCells() + mesh.nPoints() + baffles->sides().size();
        forAll(mesh.faces(), facei)
        {
            const label nSides = 1 + mesh.isInternalFace(facei);
            nTets += nSides*(mesh.faces()[facei].size() - 2);
        }
    }

    cellTets_.reset(master ? undecomposed.mesh().nCells() + 1 : 0);
    tets_.reset(nTets);
    values_.vertices.reset(nVertices);
    if (scheme_ == stDivergenceFree)
    {
        values_.excess.reset(nTets);
    }
    if (hasField)
    {
        field_.reset(nVertices);
    }

    if (master)
    {
        const undecomposedFlow::serialScope serial;
        const fvMesh& mesh = undecomposed.mesh();

        makeTets
        (
            mesh, *baffles, scheme_ == stDivergenceFree, cellTets_, tets_
        );
        makeVertices(mesh, *baffles, values_.vertices);
        static_cast<UList<flowTetExcess>&>(values_.excess) =
            flowTetExcess{{0, 0, 0, 0}, 0};

        if (hasField)
        {
            field_.deepCopy
            (
                atVertices
                (
                    *E,
                    images_,
                    *baffles,
                    "electric",
                    "look at what forces/electricField names"
                )
            );
        }
    }

    if (scheme_ == stPartitionOfUnity)
    {
        unity_.make
        (
            master ? &undecomposed.mesh() : nullptr,
            baffles.get(),
            images_,
            tets_,
            values_.vertices
        );
        values_.fits.reset(unity_.nFits());
    }

    cellTets_.share();
    tets_.share();
    values_.share();
    field_.share();
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::label Foam::frozenFlow::fanBase
(
    const polyMesh& mesh,
    const label facei
)
{
    const face& f = mesh.faces()[facei];
    const vector& S = mesh.faceAreas()[facei];
    label best = max(mesh.tetBasePtIs()[facei], label(0));
    scalar widest = -GREAT;

    for (label base = 0; f.size() > 4 && base < f.size(); ++base)
    {
        const point& x = mesh.points()[f[base]];
        scalar narrowest = GREAT;

        for (label i = 1; i < f.size() - 1; ++i)
        {
            const vector a(mesh.points()[f[(base + i) % f.size()]] - x);
            const label next = (base + i + 1) % f.size();
            const vector b(mesh.points()[f[next]] - x);
            narrowest = min
            (
                narrowest,
                ((a ^ b) & S)/max(max(magSqr(a), magSqr(b)), magSqr(b - a))
            );
        }
        if (narrowest > widest)
        {
            widest = narrowest;
            best = base;
        }
    }

    return best;
}


// ************************************************************************* //
