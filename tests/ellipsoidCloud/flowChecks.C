// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

/*---------------------------------------------------------------------------*\
Description
    The velocity between mesh points. Where no wall is: planes of symmetry,
    x = 0 and x = 20 um, open patches on all other sides; in a mesh along the
    axes and in one that leans and lies aslant.

\*---------------------------------------------------------------------------*/

#include "layerParts.H"
#include "wildFields.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- A flow that is linear, or quadratic, free of divergence and its own
    //  mirror image in x = 20 um, turned
    struct polynomialFlow
    {
        tensor R;
        scalar linear;      // [1/s]
        scalar quadratic;   // [1/m/s]

        vector at(const point& turned) const
        {
            const point x(R.T() & turned);
            const scalar d = x.x() - 20e-6;
            const scalar y = x.y(), z = x.z();
            return
                R
              & (
                    linear*vector(d, y - 3*z, 2*y - 2*z)
                  + quadratic
                   *vector
                    (
                        d*(y + z), 0.5*(sqr(d) - sqr(y)) + sqr(z), -0.5*sqr(z)
                    )
                );
        }

        //- Integral over a triangle, by the middles of its edges
        vector over(const point& a, const point& b, const point& c) const
        {
            return
                0.5*mag((b - a) ^ (c - a))
               *(at(0.5*(a + b)) + at(0.5*(b + c)) + at(0.5*(c + a)))/3;
        }

        //- And over a tetrahedron, by its corners and these middles
        vector over
        (
            const point& a, const point& b, const point& c, const point& d
        ) const
        {
            const vector corners(at(a) + at(b) + at(c) + at(d));
            const vector middles
            (
                at(0.5*(a + b)) + at(0.5*(a + c)) + at(0.5*(a + d))
              + at(0.5*(b + c)) + at(0.5*(b + d)) + at(0.5*(c + d))
            );
            return
                mag((b - a) & ((c - a) ^ (d - a)))/6
               *(middles/5 - corners/20);
        }

        //- Give a flow its means of mesh cells and faces
        void setMeans(volVectorField& U, surfaceScalarField& phi) const
        {
            const fvMesh& mesh = U.mesh();
            const pointField& points = mesh.points();
            vectorField sums(mesh.nCells(), Zero);

            forAll(mesh.faces(), facei)
            {
                const face& f = mesh.faces()[facei];
                const label own = mesh.faceOwner()[facei];
                vector mean(Zero);
                for (label i = 1; i < f.size() - 1; ++i)
                {
                    const point& a = points[f[0]];
                    const point& b = points[f[i]];
                    const point& c = points[f[i + 1]];

                    mean += over(a, b, c)/mag(mesh.faceAreas()[facei]);
                    sums[own] += over(a, b, c, mesh.cellCentres()[own]);
                    if (mesh.isInternalFace(facei))
                    {
                        const label nei = mesh.faceNeighbour()[facei];
                        sums[nei] += over(a, b, c, mesh.cellCentres()[nei]);
                    }
                }

                const scalar flux = mean & mesh.faceAreas()[facei];
                if (mesh.isInternalFace(facei))
                {
                    phi[facei] = flux;
                }
                else
                {
                    const label patchi = mesh.boundaryMesh().whichPatch(facei);
                    const label i =
                        facei - mesh.boundaryMesh()[patchi].start();
                    U.boundaryFieldRef()[patchi][i] = mean;
                    phi.boundaryFieldRef()[patchi][i] = flux;
                }
            }
            U.primitiveFieldRef() = sums/mesh.V().field();
        }
    };

    //- What has the means of a quadratic flow is that flow, and of a linear
    //  one beyond open patches, too
    static void checkPolynomials(const fvMesh& mesh, const tensor& R)
    {
        undecomposedFlow whole(mesh);
        const wildFields named(mesh);
        volVectorField U(named.U);
        surfaceScalarField phi("phi", fvc::flux(U));
        flowSample sample;

        const polynomialFlow quadratic{R, 300, 2e7};
        quadratic.setMeans(U, phi);
        whole.gather(solverFields{U, named.p, phi});
        autoPtr<meshFlow> made(flowOf(whole, meshFlow::stDivergenceFree));
        meshFlow& flow = *made;

        bool exact = true;
        OStringStream os;
        for (const point& x : {point(12.3e-6, 9e-6, 4e-6), point(19.4e-6, 8.5e-6, 4.7e-6)})
        {
            const point at(R & x);
            exact = reaches(flow, at, at, sample) && exact
             && same(sample.velocity, quadratic.at(at), 1e-9);
            os << sample.velocity << " for " << quadratic.at(at) << ' ';
            for (direction k = 0; k < 3; ++k)
            {
                vector step(Zero);
                step[k] = 1e-6;
                const vector slope
                (
                    (quadratic.at(at + step) - quadratic.at(at - step))/2e-6
                );
                exact = exact
                 && mag((sample.derivatives & step)/1e-6 - slope) < 1e-3
                 && mag((sample.gradient & step)/1e-6 - slope) < 1e-3;
            }
        }
        holds("a quadratic flow is found from means and fluxes", exact, os.str());

        const polynomialFlow linear{R, 300, 0};
        linear.setMeans(U, phi);
        whole.gather(solverFields{U, named.p, phi});
        flow.renew(whole, 1000);

        exact = true;
        os.rewind();
        const point inside(12.3e-6, 9e-6, 4e-6);
        for (const vector& out : {vector(0, 12e-6, 0.3e-6), vector(0.2e-6, -9.7e-6, 0), vector(-1e-6, 2e-6, 6.4e-6)})
        {
            const point x(R & (inside + out));
            exact = reaches(flow, R & inside, x, sample) && exact
             && same(sample.velocity, linear.at(x), 1e-9);
            os << sample.velocity << " for " << linear.at(x) << ' ';
        }
        holds("a linear one goes on beyond open patches", exact, os.str());
    }

    //- Of fluxes that are those of one velocity, and mesh cells that know none
    //  of it, the vertices have it: the planes of symmetry leave it free
    static void checkFluxes(const fvMesh& mesh, const tensor& R)
    {
        undecomposedFlow whole(mesh);
        const wildFields named(mesh);
        const vector velocity(R & vector(0, 1e-3, -2e-3));
        surfaceScalarField phi("phi", fvc::flux(named.U));
        phi.primitiveFieldRef() = velocity & mesh.Sf().primitiveField();
        for (fvsPatchScalarField& values : phi.boundaryFieldRef())
        {
            values == (velocity & values.patch().Sf());
        }
        whole.gather(solverFields{named.U, named.p, phi});
        autoPtr<meshFlow> made(flowOf(whole, meshFlow::stDivergenceFree));
        meshFlow& flow = *made;

        bool moved = true;
        OStringStream os;
        for (const scalar x : {0.01e-6, 7e-6, 19.99e-6})
        {
            flowSample sample;
            const point at(R & point(x, 9e-6, 4e-6));
            moved = reaches(flow, at, at, sample) && moved
             && same(sample.velocity, velocity, 1e-4);
            os << sample.velocity << " for " << velocity << ' ';
        }
        holds("vertices follow the fluxes about them", moved, os.str());
    }

    //- Nothing flows through a plane of symmetry, and what is beyond two of
    //  them is the image of an image
    static void checkPlanes
    (
        const fvMesh& mesh,
        const tensor& R,
        const meshFlow::schemeType scheme
    )
    {
        wildFields fields(mesh);
        fields.change();
        autoPtr<meshFlow> made(flowOf(fields.whole, scheme));
        meshFlow& flow = *made;

        flowSample sample, image;
        const vector n(R & vector(1, 0, 0));
        bool tight = true;
        OStringStream os;
        for (label i = 1; i < 20; ++i)
        {
            const point y(0, i*1e-6, 1e-6 + i*0.43e-6);
            const point at(R & (point(20e-6, 0, 0) + y));
            const point inside(R & (point(19.9e-6, 0, 0) + y));
            tight = reaches(flow, inside, at, sample) && tight
             && mag(sample.velocity & n) < 1e-9*mag(sample.velocity);
            os << (sample.velocity & n)/mag(sample.velocity) << ' ';
        }
        holds("nothing flows through a plane of symmetry", tight, os.str());

        const point x(R & point(3.3e-6, 9e-6, 4e-6));
        const bool both = reaches(flow, x, x, sample)
         && reaches(flow, x, x + 40e-6*n, image)
         && same(image.velocity, sample.velocity, 1e-9);
        os.rewind();
        os << image.velocity << " for " << sample.velocity;
        holds("beyond two planes is the image of an image", both, os.str());

        // On a line from the middle of a mesh cell the place of an open patch
        // is one, and from there on the velocity is linear
        const label celli = mesh.findCell(R & point(19e-6, 19e-6, 4e-6));
        const point& middle = mesh.cellCentres()[celli];
        const vector way(R & vector(0.2e-6, 2e-6, 0.3e-6));
        vector u[3];
        bool reached = true;
        for (label i = 0; i < 3; ++i)
        {
            reached = reaches(flow, middle, middle + (i + 2)*way, sample)
             && reached;
            u[i] = sample.velocity;
        }
        os.rewind();
        os << u[0] << ' ' << u[1] << ' ' << u[2];
        holds
        (
            "beyond an open patch it is linear",
            reached && mag(u[2] - 2*u[1] + u[0]) < 1e-9*mag(u[2])
         && mag(u[1] - u[0]) > 0.01*mag(u[1]),
            os.str()
        );
    }
}


// * * * * * * * * * * * * * * * Shared Functions  * * * * * * * * * * * * * //

void Foam::checkOpen(fvMesh& mesh)
{
    checkPolynomials(mesh, tensor(I));
    checkFluxes(mesh, tensor(I));
    checkPlanes(mesh, tensor(I), meshFlow::stDivergenceFree);
    checkPlanes(mesh, tensor(I), meshFlow::stCellPoint);

    const vector axis(vector(1, -2, 0.5)/mag(vector(1, -2, 0.5)));
    const tensor R(Ra(axis, 0.7));
    pointField points(mesh.points());
    for (point& x : points)
    {
        x = R & (x + (x.x() - 20e-6)*vector(0, 0.3, 0.1));
    }
    mesh.movePoints(points);
    checkPolynomials(mesh, R);
    checkFluxes(mesh, R);
    checkPlanes(mesh, R, meshFlow::stDivergenceFree);
}
