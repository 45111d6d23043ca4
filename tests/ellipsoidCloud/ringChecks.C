// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

/*---------------------------------------------------------------------------*\
Description
    The velocity between mesh points in a ring of mesh cells that are all alike:
    cyclic patches at both ends of y, a plane of symmetry below, walls on all
    other sides.

\*---------------------------------------------------------------------------*/

#include "cellFluxes.H"
#include "cyclicPolyPatch.H"
#include "layerParts.H"
#include "pointImages.H"
#include "wildFields.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- Of fluid at rest but for the flux through one face,
    //  from the first mesh cell to the next: its corners are moved by it alike.
    //  Each has four faces of a direction about it, with those beyond cyclic
    //  patches and the plane of symmetry, where the flux is, too
    static void checkCorners
    (
        const fvMesh& mesh,
        const label celli,
        const label next,
        const vector& along
    )
    {
        undecomposedFlow whole(mesh);
        const wildFields still(mesh);
        surfaceScalarField phi("phi", fvc::flux(still.U));
        labelHashSet corners;
        vector S(Zero);
        const scalar flux = 1e-14;
        forAll(phi, facei)
        {
            if (mesh.owner()[facei] == celli && mesh.neighbour()[facei] == next)
            {
                phi[facei] = flux;
                S = mesh.Sf()[facei];
                corners.insert(mesh.faces()[facei]);
            }
        }
        for (const char* name : {"begin", "end"})
        {
            const polyPatch& pp = mesh.boundaryMesh()[name];
            const cyclicPolyPatch& other =
                refCast<const cyclicPolyPatch>(pp).neighbPatch();
            forAll(pp, i)
            {
                const label own = pp.faceCells()[i];
                const label beyond = other.faceCells()[i];
                const bool outwards = own == celli && beyond == next;
                if (outwards || (own == next && beyond == celli))
                {
                    phi.boundaryFieldRef()[pp.index()][i] =
                        outwards ? flux : -flux;
                    corners.insert(pp[i]);
                    S = outwards ? pp.faceAreas()[i] : S;
                }
            }
        }
        whole.gather(solverFields{still.U, still.p, phi});
        const autoPtr<meshFlow> flow(flowOf(whole, meshFlow::stDivergenceFree));

        // By the velocity along one direction that is normal to the others
        const vector move((0.25*flux/(S & along))*along);
        bool alike = corners.size() > 3;
        OStringStream os;
        forAll(mesh.points(), pointi)
        {
            const point& x = mesh.points()[pointi];
            const point& inside = mesh.C()[mesh.pointCells()[pointi][0]];
            const label times = !corners.found(pointi) ? 0 : x.z() > 0 ? 1 : 2;
            flowSample sample;
            alike =
                reaches(*flow, inside, x + 1e-8*(inside - x), sample) && alike
             && mag(sample.velocity - times*move) < 1e-5*mag(move);
            if (times || mag(sample.velocity) > 1e-5*mag(move))
            {
                os << sample.velocity/mag(move) << " for " << times << ", ";
            }
        }
        holds("a flux moves the corners of its face alike", alike, os.str());
    }

    //- Velocities on both sides of the surfaces within the mesh: a triangle of
    //  corners of a face, and that of two corners and the middle of a mesh cell
    static void checkSurfaces(const fvMesh& mesh, const meshFlow& flow)
    {
        const pointField& x = mesh.points();
        scalar jump = 0, largest = 0;
        label n = 0;
        const auto compare = [&]
        (
            const label celli, const point& a, const point& b, const point& c
        )
        {
            const point on(0.45*a + 0.45*b + 0.1*c);
            const vector S((b - a) ^ (c - a));
            const vector off(1e-14/mag(S)*S);
            flowSample above, below;
            const point& from = mesh.C()[celli];
            if
            (
                reaches(flow, from, on + off, above)
             && reaches(flow, from, on - off, below)
            )
            {
                ++n;
                jump = max(jump, mag(above.velocity - below.velocity));
                largest = max(largest, mag(above.velocity));
            }
        };
        forAll(mesh.cells(), celli)
        {
            for (const label facei : mesh.cells()[celli])
            {
                const face& f = mesh.faces()[facei];
                for (label i = 0; i < 4; ++i)
                {
                    for (label k = 1; k < 4; ++k)
                    {
                        const point& a = x[f[i]];
                        const point& b = x[f[(i + k) % 4]];
                        compare(celli, a, b, mesh.C()[celli]);
                        compare(celli, a, b, x[f[(i + k % 3 + 1) % 4]]);
                    }
                }
            }
        }
        OStringStream os;
        os << jump << " of " << largest << " at " << n;
        holds
        (
            "it is continuous by round walls",
            n > 100*mesh.nCells() && jump < 1e-6*largest,
            os.str()
        );
    }

    //- Next to all corners of a mesh cell it is the same, and that of the fluxes
    //  but for the volume, since a face that is not plane is two triangles here
    static void checkDivergence
    (
        const undecomposedFlow& whole,
        const meshFlow& flow
    )
    {
        const fvMesh& mesh = whole.mesh();
        const volScalarField divergence(fvc::surfaceIntegrate(whole.phi()));
        scalar uneven = 0, error = 0, largest = 0;
        forAll(divergence, celli)
        {
            const point& middle = mesh.C()[celli];
            scalar least = GREAT, most = -GREAT;
            for (const label pointi : mesh.cellPoints()[celli])
            {
                flowSample sample;
                const point x(0.9*mesh.points()[pointi] + 0.1*middle);
                const scalar here =
                    reaches(flow, middle, x, sample)
                  ? tr(sample.derivatives) : GREAT;
                least = min(least, here);
                most = max(most, here);
            }
            uneven = max(uneven, most - least);
            error = max(error, mag(most - divergence[celli]));
            largest = max(largest, mag(divergence[celli]));
        }
        OStringStream os;
        os << "differs by " << uneven << " within mesh cells, by " << error
            << " from the fluxes' of up to " << largest;
        holds
        (
            "the divergence is that of the fluxes all over a mesh cell",
            uneven < 1e-9*largest && error < 0.01*largest,
            os.str()
        );
    }

    //- A flux is shared among the triangles of a face by their areas, one
    //  to five, on both sides
    static void checkShares()
    {
        flowValues values;
        values.vertices.reset(5);
        values.makeConservative(3, 1);
        const vector x[] = {{0, 0, -1}, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-2, 3, 0}};
        forAll(values.vertices, i)
        {
            values.vertices[i] = flowVertex{x[i], Zero, Zero, Zero};
        }
        const List<flowTet> tets
        ({
            flowTet{{0, 1, 2, 3}, {2, -1, -1, -1}},
            flowTet{{0, 1, 3, 4}, {-1, -1, -1, -1}},
            flowTet()
        });
        cellFluxes(tets).share(7, 0, 2, values);
        OStringStream os;
        os << values.outwards;
        holds
        (
            "a flux is shared among triangles by their areas",
            mag(values.outwards[0] - 7/6.0) < 1e-12
         && mag(values.outwards[1] - 7*5/6.0) < 1e-12
         && mag(values.outwards[2] + 7/6.0) < 1e-12,
            os.str()
        );
    }
}


// * * * * * * * * * * * * * * * Shared Functions  * * * * * * * * * * * * * //

void Foam::checkRing(fvMesh& mesh)
{
    // Along x and y; by so many mesh cells along y all is moved on
    const label nx = 4, ny = 5, by = 2;
    checkShares();
    const auto cell = [&](label x, label y, label z) { return x + nx*(y + ny*z); };
    checkCorners(mesh, cell(1, 2, 1), cell(2, 2, 1), vector(1, 0.3, 0));
    checkCorners(mesh, cell(1, 2, 1), cell(1, 2, 2), vector(0, 0, 1));
    for (const label y : {1, ny - 1})
    {
        checkCorners(mesh, cell(1, y, 0), cell(1, (y + 1) % ny, 0), vector(0, 1, 0));
    }

    autoPtr<wildFields> fields(new wildFields(mesh));
    fields->change();
    const auto present =
        [&]() -> autoPtr<meshFlow>
        {
            fields->gather();
            return flowOf(fields->whole, meshFlow::stDivergenceFree);
        };
    autoPtr<meshFlow> flow(present());
    const vectorField U(fields->U.primitiveField());
    const scalarField divergence
    (
        fvc::surfaceIntegrate(fields->whole.phi())().primitiveField()
    );
    forAll(U, celli)
    {
        const label x = celli % nx, y = celli/nx % ny, z = celli/nx/ny;
        fields->U[x + nx*((y + by) % ny + ny*z)] = U[celli];
    }
    const autoPtr<meshFlow> moved(present());

    bool alike = true, continuous = true, atRest = true, even = true;
    bool images = true, beyond = true;
    flowSample a, b;
    Random random(3);
    for (label i = 0; i < 300; ++i)
    {
        // The mesh leans by 0.3 along y
        const scalar x = 8e-6*random.sample01<scalar>();
        const scalar z = 8e-6*random.sample01<scalar>();
        const scalar part = random.sample01<scalar>();
        const auto in = [&](const scalar y) { return point(x, y + 0.3*x, z); };
        const point at(in(10e-6*part));
        const point on(in(10e-6*fmod(part + by/scalar(ny), 1)));

        alike = reaches(*flow, at, at, a) && alike
         && reaches(*moved, on, on, b)
         && same(a.velocity, b.velocity, 1e-9)
         && mag(a.gradient - b.gradient) < 1e-9*mag(a.gradient);
        even = even
         && mag(tr(a.derivatives) - divergence[mesh.findCell(at)]) < 1e-6;

        // In a mirror and once round, and the other way
        const isometry mirror(isometry::mirror(Zero, vector(0, 0, 1)));
        const point image(mirror(at) + vector(0, i % 2 ? 10e-6 : -10e-6, 0));
        images = reaches(*flow, at, image, b) && images
         && same(b.velocity, mirror.turn() & a.velocity, 1e-9);

        continuous = reaches(*flow, in(1e-8), in(1e-18), a) && continuous
         && reaches(*flow, in(9.99e-6), in(10e-6 - 1e-18), b)
         && same(a.velocity, b.velocity, 1e-6);

        const vector up(0, 0, 8e-6 - z);
        atRest = reaches(*flow, at, at + (1 - 1e-9)*up, a) && atRest
         && mag(a.velocity) < 1e-9;
        meshFlow::probe from;
        tensor derivatives(I);
        beyond = flow->find(at + 0.999*up, from) && beyond
         && mag(flow->velocity(0, at + 1.1*up, from, &derivatives)) < 1e-15
         && derivatives == tensor::zero;
    }
    holds("where a ring of mesh cells begins makes no difference", alike);
    holds("where faces are plane the divergence is exactly that of the fluxes", even);
    holds("beyond a plane of symmetry and a cyclic patch it is both", images);
    holds("the velocity is continuous over cyclic patches", continuous);
    holds("the fluid has the velocity of the wall", atRest);
    holds("and so beyond it, whatever the place there", beyond);

    // Walls that are round
    pointField points(mesh.points());
    for (point& x : points)
    {
        const scalar y = x.y() - 0.3*x.x();
        x.x() += 1e-6*std::sin(constant::mathematical::twoPi*y/10e-6);
        x.z() += 0.05*x.z()*std::sin(3*x.x()/8e-6 + 0.5);
    }
    mesh.movePoints(points);
    fields.reset(new wildFields(mesh));
    fields->change();
    flow = present();

    checkSurfaces(mesh, *flow);
    checkDivergence(fields->whole, *flow);
}


// Mirror and period do not commute: the one after the other is about a point of
// both, the other way round it is not
void Foam::checkStepped(const fvMesh& mesh)
{
    const pointField& x = mesh.points();
    const pointImages images(mesh, domainImages(mesh, labelHashSet()));
    const auto isOn = [&](const char* name, const label pointi)
    {
        return mesh.boundaryMesh()[name].whichPoint(pointi) >= 0;
    };
    bool there = true, all = true;

    forAll(x, pointi)
    {
        DynamicList<isometry> ways;
        placeOf(isometry(), 1e-5, ways);
        for (const pointImage& other : images.at(pointi))
        {
            there = there
             && mag(other.image(x[other.point]) - x[pointi]) < 1e-12;
            all = all && placeOf(other.image, 1e-5, ways) == ways.size() - 1;
        }
        bool mirrored = isOn("low", pointi);
        for (const label one : images.with(pointi))
        {
            mirrored = mirrored || isOn("low", one);
        }
        const label nPeriods = isOn("ahead", pointi) + isOn("behind", pointi);
        all = all && ways.size() == (mirrored ? 2 : 1)*(1 + nPeriods);
    }
    holds("what is seen about a point of the mesh is seen there", there);
    holds("once each: mirrored, a period on, and both", all);
}


// One side of a baffle touches the cyclic patches, at x = 2 to 6 um, z = 4 um. It
// may end there, or go on
void Foam::checkBaffle(const fvMesh& mesh)
{
    wildFields fields(mesh);
    fields.change();
    const vector wall(2e-3, 1e-3, 0);
    for (const char* name : {"plateOne", "plateTwo"})
    {
        const label patchi = mesh.boundaryMesh().findPatchID(name);
        fields.U.boundaryFieldRef()[patchi] == wall;
    }
    fields.gather();
    const autoPtr<meshFlow> flow(flowOf(fields.whole, meshFlow::stDivergenceFree));

    bool held = true, continuous = true;
    flowSample a, b;
    Random random(3);
    for (label i = 0; i < 300; ++i)
    {
        const scalar x = 1e-6*(2 + 4*random.sample01<scalar>());
        const auto in = [&](const scalar y, const scalar z)
        {
            return point(x, y + 0.3*x, z);
        };
        for (const scalar side : {-1, 1})
        {
            const scalar z = 4e-6 + side*1e-15, away = 4e-6 + side*1e-8;
            held = reaches(*flow, in(1e-8, away), in(1e-15, z), a) && held
             && reaches(*flow, in(9.99e-6, away), in(10e-6 - 1e-15, z), b)
             && same(a.velocity, wall, 1e-6) && same(b.velocity, wall, 1e-6);

            const scalar any = 4e-6 + side*2e-6*random.sample01<scalar>();
            continuous = reaches(*flow, in(1e-8, any), in(1e-18, any), a)
             && continuous
             && reaches(*flow, in(9.99e-6, any), in(10e-6 - 1e-18, any), b)
             && same(a.velocity, b.velocity, 1e-6);
        }
    }
    holds("a baffle moves the fluid on both sides of a cyclic patch", held);
    holds("which is continuous there", continuous);
}
