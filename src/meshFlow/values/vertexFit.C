// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "vertexFit.H"
#include "domainImages.H"
#include "wallsAtVertices.H"

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::vertexFit::vertexFit
(
    const volVectorField& U,
    const pointField& apexes,
    const baffleSides& baffles,
    const pointImages& images
)
{
    const polyMesh& mesh = U.mesh();
    const label nCells = mesh.nCells();
    const wallsAtVertices walls(U, baffles);
    const List<quadratic> fits(cellFits(U, baffles, images, walls));

    u.setSize(nCells + mesh.nPoints() + baffles.sides().size(), Zero);
    gradient.setSize(u.size(), Zero);
    scalarField weights(u.size(), Zero);

    forAll(fits, celli)
    {
        const vector shift(apexes[celli] - mesh.cellCentres()[celli]);
        u[celli] = fits[celli].at(shift);
        gradient[celli] = fits[celli].gradientAt(shift);
        weights[celli] = 1;

        for (const label pointi : mesh.cellPoints()[celli])
        {
            const vector d(mesh.points()[pointi] - mesh.cellCentres()[celli]);
            const scalar w = 1/(mag(d) + ROOTVSMALL);
            const label vertexi = nCells + baffles.vertex(pointi, celli);

            u[vertexi] += w*fits[celli].at(d);
            gradient[vertexi] += w*fits[celli].gradientAt(d);
            weights[vertexi] += w;
        }
    }

    images.add(u, nCells);
    images.add(gradient, nCells);
    images.add(weights, nCells);

    // A point of a baffle is of no cell but as its sides
    weights = max(weights, VSMALL);
    u /= weights;
    gradient /= weights;

    for (label i = 0; i < u.size() - nCells; ++i)
    {
        walls.impose(i, images, u[nCells + i], gradient[nCells + i]);
    }

    for (const polyPatch& pp : mesh.boundaryMesh())
    {
        const bool mirror = domainImages::isMirror(pp);

        for (label i = 0; mirror && i < pp.size(); ++i)
        {
            const vector n(pp.faceAreas()[i]/mag(pp.faceAreas()[i]));
            const tensor along(I - n*n);

            for (const label pointi : pp[i])
            {
                const label j =
                    nCells + baffles.vertex(pointi, pp.faceCells()[i]);
                tensor& G = gradient[j];

                u[j] = along & u[j];
                G = (along & G & along) + (n & G & n)*n*n;
            }
        }
    }
}
