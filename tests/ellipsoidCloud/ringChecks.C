// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

/*---------------------------------------------------------------------------*\
Description
    The velocity between mesh points in a ring of mesh cells that are all alike:
    cyclic patches at both ends of y, a plane of symmetry below, walls on all
    other sides.

\*---------------------------------------------------------------------------*/

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
}


// * * * * * * * * * * * * * * * Shared Functions  * * * * * * * * * * * * * //

void Foam::checkRing(fvMesh& mesh)
{
    // Along x and y; by so many mesh cells along y all is moved on
    const label nx = 4, ny = 5, by = 2;
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
    holds("the divergence is that of the fluxes all over a mesh cell", even);
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

    // A jump is larger than what the velocity changes by over a small part of a
    // mesh cell
    const label n = 20000;
    scalar largest = 0, change = 0;
    for (label line = 0; line < 12; ++line)
    {
        const point far
        (
            8e-6*random.sample01<scalar>(), 10e-6*random.sample01<scalar>(),
            8e-6*random.sample01<scalar>()
        );
        const vector way((point(4e-6, 6.2e-6, 4e-6) - far)/n);
        bool before = false;
        for (label i = 0; i < n; ++i)
        {
            const point x(far + i*way);
            const bool found = reaches(*flow, x, x, a);
            if (found && before)
            {
                const scalar step = mag(a.velocity - b.velocity);
                largest = max(largest, step);
                change = max(change, mag(b.derivatives)*mag(way));
            }
            b = a;
            before = found;
        }
    }
    OStringStream os;
    os << largest << " in a step, " << change << " by its derivatives";
    holds("it is continuous by round walls", largest < 1.5*change, os.str());
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
