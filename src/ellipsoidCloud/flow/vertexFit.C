/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/
#include "vertexFit.H"
#include "baffleSides.H"
#include "cyclicPoints.H"
#include "symmetryPlanePolyPatch.H"
#include "symmetryPolyPatch.H"
#include "Tuple2.H"
#include "volFields.H"
#include "wallPolyPatch.H"

#include <algorithm>

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- The faces of walls at each vertex that is a point, and what they do
    class wallsAtVertices
    {
        const volVectorField& U_;
        const cyclicPoints& cyclics_;
        List<DynamicList<label>> faces_;

    public:

        wallsAtVertices
        (
            const volVectorField& U,
            const baffleSides& baffles,
            const cyclicPoints& cyclics
        )
        :
            U_(U),
            cyclics_(cyclics),
            faces_(U.mesh().nPoints() + baffles.sides().size())
        {
            for (const polyPatch& pp : U.mesh().boundaryMesh())
            {
                const label nFaces = isA<wallPolyPatch>(pp) ? pp.size() : 0;

                for (label i = 0; i < nFaces; ++i)
                {
                    for (const label pointi : pp[i])
                    {
                        faces_[baffles.vertex(pointi, pp.faceCells()[i])]
                            .append(pp.start() + i);
                    }
                }
            }
        }

        const UList<label>& faces(const label vertexi) const
        {
            return faces_[vertexi];
        }

        const vector& velocity(const label facei) const
        {
            const polyBoundaryMesh& patches = U_.mesh().boundaryMesh();
            const label patchi = patches.whichPatch(facei);

            return U_.boundaryField()[patchi][facei - patches[patchi].start()];
        }

        //- Give a vertex the velocity of its walls, and a gradient that
        //  agrees with them
        void impose(const label vertexi, vector& u, tensor& gradient) const
        {
            DynamicList<label> faces;
            for (const label pointi : cyclics_.with(vertexi))
            {
                faces.append(faces_[pointi]);
            }
            if (faces.empty())
            {
                faces = faces_[vertexi];
            }
            if (faces.empty())
            {
                return;
            }

            vector sum(Zero), area(Zero);
            for (const label facei : faces)
            {
                const vector& S = U_.mesh().faceAreas()[facei];
                sum += velocity(facei);
                area += S/mag(S);
            }
            u = sum/scalar(faces.size());

            const vector n(area/(mag(area) + VSMALL));
            bool flat = true;
            for (const label facei : faces)
            {
                const vector& S = U_.mesh().faceAreas()[facei];
                // A wall that turns keeps its own gradient
                if (mag(velocity(facei) - u) > SMALL*mag(u))
                {
                    return;
                }
                flat = flat && (S & n) > 0.9*mag(S);
            }

            const vector slope(gradient & n);
            gradient = flat ? tensor((slope - n*(n & slope))*n) : tensor(Zero);
        }
    };

    //- Least squares with columns for the three gradients, the six curvatures
    //  and the three components of the velocity
    class leastSquares
    {
        static const direction nUnknowns = 9;
        static const direction nColumns = 12;

        DynamicList<FixedList<scalar, nColumns>> rows_;

    public:

        void clear()
        {
            rows_.clear();
        }

        //- That the velocity differs by du where d is, and the second moments
        //  by M; lengths by that of the mesh cell
        void append(const vector& d, const symmTensor& M, const vector& du)
        {
            const scalar w = 1/mag(d);
            const symmTensor dd(sqr(d) + M);

            rows_.append
            (
                FixedList<scalar, nColumns>
                ({
                    w*d.x(), w*d.y(), w*d.z(),
                    w*dd.xx()/2, w*dd.yy()/2, w*dd.zz()/2,
                    w*dd.xy(), w*dd.xz(), w*dd.yz(),
                    w*du.x(), w*du.y(), w*du.z()
                })
            );
        }

        //- Solve by Gram and Schmidt. An unknown that the others determine
        //  already, as in a mesh one cell thick, is 0.
        void solve(quadratic& p)
        {
            scalar R[nUnknowns][nColumns];
            bool kept[nUnknowns];

            FixedList<scalar, nColumns> before(0.0);
            for (const auto& row : rows_)
            {
                for (direction j = 0; j < nUnknowns; ++j)
                {
                    before[j] += sqr(row[j]);
                }
            }

            for (direction j = 0; j < nUnknowns; ++j)
            {
                scalar norm = 0;
                for (const auto& row : rows_)
                {
                    norm += sqr(row[j]);
                }

                kept[j] = norm > 1e-4*before[j] && norm > VSMALL;
                std::fill_n(R[j], nColumns, scalar(0));
                if (kept[j])
                {
                    takeAlong(j, 1/Foam::sqrt(norm), R[j]);
                }
            }

            vector x[nUnknowns];
            for (direction j = nUnknowns; j-- > 0;)
            {
                x[j] = Zero;
                if (kept[j])
                {
                    x[j] = vector(R[j][9], R[j][10], R[j][11]);
                    for (direction k = j + 1; k < nUnknowns; ++k)
                    {
                        x[j] -= kept[k] ? R[j][k]*x[k] : vector::zero;
                    }
                    x[j] *= R[j][j];
                }
            }

            for (direction i = 0; i < 3; ++i)
            {
                for (direction j = 0; j < 3; ++j)
                {
                    p.gradient[3*i + j] = x[j][i];
                }
                p.curvature[i] = symmTensor
                (
                    x[3][i], x[6][i], x[7][i], x[4][i], x[8][i], x[5][i]
                );
            }
        }

    private:

        //- Normalise a column and take the later ones' parts along it away.
        //  In the place of a part along itself is the inverse norm.
        void takeAlong
        (
            const direction along,
            const scalar inverseNorm,
            scalar parts[nColumns]
        )
        {
            for (auto& row : rows_)
            {
                row[along] *= inverseNorm;
                for (direction k = along + 1; k < nColumns; ++k)
                {
                    parts[k] += row[along]*row[k];
                }
            }
            for (auto& row : rows_)
            {
                for (direction k = along + 1; k < nColumns; ++k)
                {
                    row[k] -= parts[k]*row[along];
                }
            }
            parts[along] = inverseNorm;
        }
    };

    //- What has been taken for a mesh cell already, in the mesh or, moved by a
    //  shift, beyond a cyclic patch
    class takenOnce
    {
        label celli_;
        labelList takenFor_;
        DynamicList<Tuple2<label, vector>> beyond_;

    public:

        explicit takenOnce(const label n)
        :
            celli_(-1),
            takenFor_(n, -1)
        {}

        void start(const label celli)
        {
            celli_ = celli;
            beyond_.clear();
        }

        //- Take one, unless it has been
        bool take(const label i, const vector& shift)
        {
            if (shift == vector::zero)
            {
                const bool isNew = takenFor_[i] != celli_;
                takenFor_[i] = celli_;
                return isNew;
            }

            for (const Tuple2<label, vector>& known : beyond_)
            {
                if
                (
                    known.first() == i
                 && mag(known.second() - shift) < 1e-6*mag(shift)
                )
                {
                    return false;
                }
            }
            beyond_.append(Tuple2<label, vector>(i, shift));
            return true;
        }
    };

    //- The polynomials of all cells
    static List<quadratic> fitCells
    (
        const volVectorField& U,
        const baffleSides& baffles,
        const cyclicPoints& cyclics,
        const wallsAtVertices& walls
    )
    {
        const polyMesh& mesh = U.mesh();
        const vectorField& centres = mesh.cellCentres();
        const symmTensorField M(secondMoments(mesh));
        List<quadratic> fits(mesh.nCells());

        leastSquares equations;
        takenOnce cells(mesh.nCells());
        takenOnce faces(mesh.nFaces());

        forAll(fits, celli)
        {
            const scalar length = Foam::sqrt(tr(M[celli]));
            const auto add =
                [&](const point& x, const symmTensor& m, const vector& u)
                {
                    equations.append
                    (
                        (x - centres[celli])/length,
                        (m - M[celli])/sqr(length),
                        u - U[celli]
                    );
                };

            // The mesh cells and walls at a point, all moved by a shift
            const auto addThoseAt =
                [&](const label pointi, const label vertexi, const vector& shift)
                {
                    for (const label other : mesh.pointCells()[pointi])
                    {
                        if
                        (
                            baffles.vertex(pointi, other) == vertexi
                         && cells.take(other, shift)
                        )
                        {
                            add(centres[other] + shift, M[other], U[other]);
                        }
                    }
                    for (const label facei : walls.faces(vertexi))
                    {
                        if (faces.take(facei, shift))
                        {
                            // The mean over the face, as wide as its cell
                            const vector& S = mesh.faceAreas()[facei];
                            const symmTensor along(I - sqr(S/mag(S)));
                            add
                            (
                                mesh.faceCentres()[facei] + shift,
                                symm
                                (
                                    along & M[mesh.faceOwner()[facei]] & along
                                ),
                                walls.velocity(facei)
                            );
                        }
                    }
                };

            equations.clear();
            cells.start(celli);
            faces.start(celli);
            cells.take(celli, Zero);

            for (const label pointi : mesh.cellPoints()[celli])
            {
                addThoseAt(pointi, baffles.vertex(pointi, celli), Zero);

                for (const label other : cyclics.with(pointi))
                {
                    if (other != pointi)
                    {
                        const pointField& x = mesh.points();
                        addThoseAt(other, other, x[pointi] - x[other]);
                    }
                }
            }

            quadratic& p = fits[celli];
            equations.solve(p);
            p.gradient /= length;
            p.value = U[celli];
            for (direction i = 0; i < 3; ++i)
            {
                p.curvature[i] /= sqr(length);
                p.value[i] -= 0.5*(p.curvature[i] && M[celli]);
            }
        }

        return fits;
    }
}


// * * * * * * * * * * * * * * * Global Functions  * * * * * * * * * * * * * //

Foam::symmTensorField Foam::secondMoments(const polyMesh& mesh)
{
    symmTensorField moments(mesh.nCells(), Zero);
    scalarField volumes(mesh.nCells(), Zero);

    forAll(mesh.faces(), facei)
    {
        const face& f = mesh.faces()[facei];
        for (label side = 0; side < 1 + mesh.isInternalFace(facei); ++side)
        {
            const label celli =
                side ? mesh.faceNeighbour()[facei]
              : mesh.faceOwner()[facei];
            const point& c = mesh.cellCentres()[celli];

            for (label i = 1; i < f.size() - 1; ++i)
            {
                const vector a(mesh.points()[f[0]] - c);
                const vector b(mesh.points()[f[i]] - c);
                const vector d(mesh.points()[f[i + 1]] - c);
                const scalar volume = (side ? -1 : 1)*(a & (b ^ d));

                moments[celli] +=
                    volume*(sqr(a) + sqr(b) + sqr(d) + sqr(a + b + d))/20;
                volumes[celli] += volume;
            }
        }
    }

    return moments/volumes;
}


Foam::List<Foam::quadratic> Foam::cellFits
(
    const volVectorField& U,
    const baffleSides& baffles,
    const cyclicPoints& cyclics
)
{
    return
        fitCells(U, baffles, cyclics, wallsAtVertices(U, baffles, cyclics));
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::vertexFit::vertexFit
(
    const volVectorField& U,
    const baffleSides& baffles,
    const cyclicPoints& cyclics
)
{
    const polyMesh& mesh = U.mesh();
    const label nCells = mesh.nCells();
    const wallsAtVertices walls(U, baffles, cyclics);
    const List<quadratic> fits(fitCells(U, baffles, cyclics, walls));

    u.setSize(nCells + mesh.nPoints() + baffles.sides().size(), Zero);
    gradient.setSize(u.size(), Zero);
    scalarField weights(u.size(), Zero);

    forAll(fits, celli)
    {
        u[celli] = fits[celli].value;
        gradient[celli] = fits[celli].gradient;
        weights[celli] = 1;

        for (const label pointi : mesh.cellPoints()[celli])
        {
            const vector d(mesh.points()[pointi] - mesh.cellCentres()[celli]);
            const scalar w = 1/mag(d);
            const label vertexi = nCells + baffles.vertex(pointi, celli);

            u[vertexi] += w*fits[celli].at(d);
            gradient[vertexi] += w*fits[celli].gradientAt(d);
            weights[vertexi] += w;
        }
    }

    cyclics.add(u, nCells);
    cyclics.add(gradient, nCells);
    cyclics.add(weights, nCells);

    // A point of a baffle is of no cell but as its sides
    weights = max(weights, VSMALL);
    u /= weights;
    gradient /= weights;

    for (label i = 0; i < u.size() - nCells; ++i)
    {
        walls.impose(i, u[nCells + i], gradient[nCells + i]);
    }

    for (const polyPatch& pp : mesh.boundaryMesh())
    {
        const bool mirror =
            isA<symmetryPolyPatch>(pp) || isA<symmetryPlanePolyPatch>(pp);

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


// ************************************************************************* //
