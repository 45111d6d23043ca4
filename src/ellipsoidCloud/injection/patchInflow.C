// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "patchInflow.H"
#include "masterGate.H"
#include "triPointRef.H"
#include "tetDecomposition.H"
#include "undecomposedFlow.H"
#include "volFields.H"
#include "wallPolyPatch.H"

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::patchInflow::patchInflow
(
    const dictionary& dict,
    const undecomposedFlow& undecomposed,
    const bool mayCome
)
{
    const word name(dict.get<word>("patch"));

    if (Pstream::master())
    {
        const fvMesh& mesh = undecomposed.mesh();
        const tetDecomposition& decomposition = undecomposed.decomposition();
        const polyPatch& pp = mesh.boundaryMesh()[name];
        const vectorField& U = undecomposed.U().boundaryField()[pp.index()];
        DynamicList<point> vertices;
        DynamicList<point> centres;
        DynamicList<scalar> sums;
        DynamicList<scalar> areas;
        scalar sum = 0;
        scalar area = 0;

        forAll(pp, i)
        {
            const auto add =
                [&](const point& a, const point& b, const point& c)
                {
                    const triPointRef triangle(a, b, c);

                    // Outward normal; what flows out carries no cell in
                    sum += max(-(U[i] & triangle.areaNormal()), scalar(0));

                    vertices.append({a, b, c});
                    centres.append(decomposition.apexes()[pp.faceCells()[i]]);
                    sums.append(sum);
                    area += triangle.mag();
                    areas.append(area);
                };
            decomposition.forTriangles(pp.start() + i, add);
        }

        corners.transfer(vertices);
        behind.transfer(centres);

        const bool open = mayCome && !isA<wallPolyPatch>(pp);
        upTo.transfer(open && sum <= 0 ? areas : sums);
    }
    broadcast(corners);
    broadcast(behind);
    broadcast(upTo);

    const masterGate once;

    if (upTo.empty() || upTo.last() <= 0)
    {
        FatalIOErrorInFunction(dict)
            << "nothing flows in through patch " << name << exit(FatalIOError);
    }
}
