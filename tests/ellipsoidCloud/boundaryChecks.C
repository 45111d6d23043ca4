// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

/*---------------------------------------------------------------------------*\
Description
    What happens at the ends of the domain: a plane of symmetry, x = 20 um, and
    open patches at both ends of y. Sizes of its cells are drawn.

\*---------------------------------------------------------------------------*/

#include "baffleSides.H"
#include "caseSummary.H"
#include "inletFlux.H"
#include "layerParts.H"
#include "patchInflow.H"
#include "pointImages.H"
#include "vertexFit.H"
#include "wallsAtVertices.H"
#include "wildFields.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- A cell that slides on the floor through the plane of symmetry in its
    //  last step: its velocity and its way are those of the image
    static void checkMirror(const layer& at)
    {
        struct seen : public contactObserver
        {
            mutable vector moved;

            virtual void ended
            (
                cellSweep& cell, const point& from, const scalar,
                const ellipsoid_model&, const cellDomain&
            ) const
            {
                moved = cell.state.centre() - from;
            }
        } observer;

        cellState cell(at.cellAt(point(20e-6 - 0.83e-10, 10e-6, 0.499e-6)));
        cell.body.u[0] = 1e-3;
        cell.controller.step = 1e-7;
        List<cellState> cells(1, cell);
        groupScheduler scheduler(at.population, at.domain, nullptr, &observer);
        const List<cellSweep> moved(scheduler.advanceInterval(cells, 0, 1e-7));
        const cellState& passed = moved[0].state;

        OStringStream os;
        os << passed.centre() << ' ' << passed.unfolded() << ' '
            << pointOf(passed.body.u) << ' ' << observer.moved;
        holds
        (
            "a cell passes a plane of symmetry",
            passed.unfolded().x() > 20e-6 && passed.centre().x() < 20e-6,
            os.str()
        );
        holds
        (
            "its velocity and its way are mirrored with it",
            passed.body.u[0] < 0 && observer.moved.x() < 0,
            os.str()
        );
    }

    //- When and where a cell leaves; it starts at rest, and so is late by its
    //  relaxation time, 1.4e-7 s
    static void checkLeaving(const layer& at)
    {
        const point x(10e-6, 19.7e-6, 5e-6);
        const cellState cell(at.cellAt(x));
        List<cellState> cells(1, cell);
        groupScheduler scheduler(at.population, at.domain, nullptr, nullptr);
        const List<cellSweep> moved(scheduler.advanceInterval(cells, 0, 1e-3));
        const cellState& gone = moved[0].state;

        OStringStream os;
        os << gone.time << ' ' << gone.centre();
        holds
        (
            "a cell leaves when its centre passes an open patch",
            gone.fate == cellState::escaped && mag(gone.time - 1.5e-4) < 2e-7
         && mag(gone.centre().y() - 20e-6) < 1e-12
         && gone.patch == at.mesh.boundaryMesh().findPatchID("back"),
            os.str()
        );
    }

    //- What flows out through a part of an inlet carries no cell in, and is no
    //  inflow
    static void checkInlet(const fvMesh& mesh)
    {
        // At y = 0 from -3 to 5 mm/s across x, 1 mm/s on average
        const tensor gradient(0, 0, 0, 400, 0, 0, 0, 0, 0);
        const layer at(mesh, vector(0, 1e-3, 0), gradient);
        const volVectorField& U = at.undecomposed.U();
        const inletFlux through(U, at.undecomposed.phi());

        OStringStream os;
        os << through.inflow << ' ' << through.speed;
        holds
        (
            "what comes in is what comes in more than goes out",
            mag(through.inflow/2e-13 - 1) < 1e-9
         && through.crossing == through.inflow
         && mag(through.speed/1e-3 - 1) < 1e-9,
            os.str()
        );

        // Through two sides of 200 um2 at once, and through none
        const auto speedOf = [&](const vector& velocity)
        {
            return inletFlux::speedOf(layer(mesh, velocity).undecomposed);
        };
        const scalar both = speedOf(vector(1e-3, 2e-3, 0));
        const scalar none = speedOf(vector(0, 0, 3e-3));
        os.rewind();
        os << both << ' ' << none;
        holds
        (
            "its mean speed is that through all inlets, or within a closed device",
            mag(both/1.5e-3 - 1) < 1e-9 && mag(none/3e-3 - 1) < 1e-9,
            os.str()
        );

        // Into and out of one side as much, or nothing through the left one
        const auto closes = [&](const vector& velocity, const tensor& gradient)
        {
            const layer other(mesh, velocity, gradient);
            const inletFlux flux
            (
                other.undecomposed.U(), other.undecomposed.phi()
            );
            return refuses([&] { flux.checkOpen(mesh); });
        };
        holds
        (
            "an open side is one that something flows through, either way",
            !closes(vector(1e-3, 0, 0), gradient)
         && closes(vector(0, 1e-3, 0), gradient)
        );

        // Through the post
        const auto leaks = [&](const vector& velocity, const bool asItIs)
        {
            const layer other(mesh, velocity);
            const inletFlux flux
            (
                other.undecomposed.U(), other.undecomposed.phi()
            );
            return refuses([&] { flux.checkWalls(mesh, asItIs); });
        };
        holds
        (
            "a wall is one that nothing flows through, or the flow is given",
            !leaks(Zero, false) && leaks(vector(0, 1e-3, 0), false)
         && !leaks(vector(0, 1e-3, 0), true)
        );

        // Each face is two triangles
        const label front = mesh.boundaryMesh().findPatchID("front");
        const patchInflow inflow
        (
            entries("patch front;"), at.undecomposed, false
        );
        scalar in = 0;
        bool alike = inflow.upTo.size() == inflow.corners.size()/3;
        forAll(inflow.upTo, i)
        {
            const point* x = &inflow.corners[3*i];
            const scalar speed = U.boundaryField()[front][i/2].y();
            in +=
                0.5*mag((x[1] - x[0]) ^ (x[2] - x[0]))*max(speed, scalar(0));
            alike = alike && mag(inflow.upTo[i] - in) < 1e-9*2e-13;
        }
        os.rewind();
        os << inflow.upTo;
        holds("where it goes out no cell comes in", alike, os.str());
    }

    //- By a shear rate [1/s], for a cell of 2 um in water
    static void checkInertia(const fvMesh& mesh)
    {
        const auto isTold = [&](const scalar rate)
        {
            const layer at(mesh, Zero, tensor(0, 0, 0, rate, 0, 0, 0, 0, 0));
            return reportInertia(at.undecomposed.U(), at.properties, 2e-6);
        };
        holds
        (
            "the inertia of the fluid is told of where it matters, every time",
            isTold(4e4) && isTold(4e4) && !isTold(2e4)
        );
    }

    //- What is sampled somewhere: seven vectors and tensors, and what of their
    //  derivatives by place is told
    struct sampled
    {
        flowSample flow;
        vector field;
        tensor fieldDerivatives;

        sampled
        (
            const meshFlow& of,
            meshFlow::probe from,
            const point& x,
            const scalar t
        )
        {
            tetCoordinates c;
            if (!of.reach(x, from, c))
            {
                FatalErrorInFunction << x << " is not reached" << exit(FatalError);
            }
            of.sample(t, c, true, flow);
            field = of.field(c, &fieldDerivatives);

            // The velocity alone is the same
            tensor derivatives;
            const vector u(of.velocity(t, c, &derivatives));
            if
            (
                !same(u, flow.velocity)
             || mag(derivatives - flow.derivatives) > 1e-12*mag(derivatives)
            )
            {
                flow.velocity = Zero;
            }
        }

        //- Change along an axis, as told
        sampled along(const direction k) const
        {
            sampled d(*this);
            vector unit(Zero);
            unit[k] = 1;
            d.flow.velocity = flow.derivatives & unit;
            d.flow.acceleration = flow.accelerationDerivatives & unit;
            d.flow.pressureGradient = flow.pressureDerivatives & unit;
            d.field = fieldDerivatives & unit;
            for (direction ij = 0; ij < 9; ++ij)
            {
                d.flow.gradient[ij] = flow.gradientDerivatives[3*ij + k];
            }
            return d;
        }

        //- As seen in a mirror
        sampled in(const tensor& T) const
        {
            sampled d(*this);
            d.flow.velocity = T & flow.velocity;
            d.flow.acceleration = T & flow.acceleration;
            d.flow.pressureGradient = T & flow.pressureGradient;
            d.flow.gradient = T & flow.gradient & T;
            d.field = T & field;
            return d;
        }

        //- (This less another)/h
        sampled less(const sampled& other, const scalar h) const
        {
            sampled d(*this);
            d.flow.velocity = (flow.velocity - other.flow.velocity)/h;
            d.flow.acceleration =
                (flow.acceleration - other.flow.acceleration)/h;
            d.flow.pressureGradient =
                (flow.pressureGradient - other.flow.pressureGradient)/h;
            d.flow.gradient = (flow.gradient - other.flow.gradient)/h;
            d.field = (field - other.field)/h;
            return d;
        }

        bool is(const sampled& other, const scalar tolerance) const
        {
            const sampled d(less(other, 1));
            return
                mag(d.flow.velocity) < tolerance*mag(flow.velocity)
             && mag(d.flow.acceleration) < tolerance*mag(flow.acceleration)
             && mag(d.flow.pressureGradient)
              < tolerance*mag(flow.pressureGradient)
             && mag(d.flow.gradient) < tolerance*mag(flow.gradient)
             && mag(d.field) < tolerance*mag(field);
        }
    };

    //- Derivatives are what differences say, on both sides of the plane of
    //  symmetry, and there all is the mirror image
    static void checkSamples(const fvMesh& mesh)
    {
        const point inside(19.62e-6, 10.31e-6, 4.73e-6);
        const isometry mirror(isometry::mirror(point(20e-6, 0, 0), {1, 0, 0}));
        const scalar h = 1e-11, start = 1, end = 3, t = 1.7;
        wildFields fields(mesh);
        bool differences = true, rates = true, images = true, ends = true;

        for (const auto scheme : {meshFlow::stCellPoint, meshFlow::stDivergenceFree})
        {
            fields.change();
            meshFlow flow
            (
                fields.whole, scheme, labelHashSet(), fields.ofE, true, true
            );
            flow.renew(fields.whole, 1000);
            meshFlow::probe at;
            flow.find(inside, at);
            const sampled first(flow, at, inside, 0);
            fields.change();
            flow.advance(fields.whole, 1000, start, end);
            ends = ends
             && same
                (
                    sampled(flow, at, inside, start).flow.velocity,
                    first.flow.velocity
                );
            const vector last(sampled(flow, at, inside, end).flow.velocity);
            flow.advance(fields.whole, 1000, end, 2*end);
            ends = ends && !same(first.flow.velocity, last, 0.01)
             && same(sampled(flow, at, inside, end).flow.velocity, last);
            fields.change();
            flow.advance(fields.whole, 1000, start, end);

            const sampled own(flow, at, inside, t);
            images = images
             && sampled(flow, at, mirror(inside), t).is
                (
                    own.in(mirror.turn()), 1e-11
                );

            for (const point& x : {inside, mirror(inside)})
            {
                const sampled here(flow, at, x, t);
                for (direction k = 0; k < 3; ++k)
                {
                    vector step(Zero);
                    step[k] = h;
                    const sampled a(flow, at, x - step, t);
                    const sampled b(flow, at, x + step, t);
                    differences =
                        differences && b.less(a, 2*h).is(here.along(k), 1e-5);
                }
                const sampled a(flow, at, x, t - 0.1);
                const sampled b(flow, at, x, t + 0.1);
                const sampled rate(b.less(a, 0.2));
                rates = rates
                 && mag(rate.flow.velocity - here.flow.acceleration)
                  < 1e-9*mag(here.flow.acceleration)
                 && mag(rate.flow.gradient) > 0
                 && mag(rate.flow.pressureGradient) > 0;
            }
        }
        holds("derivatives by place are differences of what is sampled", differences);
        holds("and by time, in a flow that changes", rates);
        holds("a time step is from the flow before to the flow after", ends);
        holds("beyond a plane of symmetry all is the mirror image", images);
    }

    //- Of a flow that is quadratic mesh cells have the mean: what is fitted to
    //  them is the flow itself, also beside the plane of symmetry. It is
    //  k (d y, d^2/2 + z^2, 0), d from there, in mesh cells that lean along y by
    //  so much; on the floor, too, whose faces have no thickness
    static void checkFit(const fvMesh& mesh, const scalar lean, const char* name)
    {
        const scalar k = 2e7, moment = sqr(2e-6)/12;
        volVectorField U
        (
            wildFields::named("quadratic", mesh),
            mesh,
            dimensionedVector(dimVelocity)
        );
        const auto mean = [&](const point& x, const scalar thickness)
        {
            const scalar d = x.x() - 20e-6, z = x.z();
            return k*vector
            (
                d*x.y() + lean*moment,
                (sqr(d) + moment)/2 + sqr(z) + sqr(thickness)/12,
                0
            );
        };
        forAll(U, celli)
        {
            U[celli] = mean(mesh.C()[celli], 2.5e-6);
        }
        for (fvPatchVectorField& Up : U.boundaryFieldRef())
        {
            forAll(Up, i)
            {
                Up[i] = mean(Up.patch().Cf()[i], 0);
            }
        }

        pointImages images(mesh, domainImages(mesh, labelHashSet()));
        const baffleSides baffles(mesh, images);
        const List<quadratic> fits
        (
            cellFits(U, baffles, images, wallsAtVertices(U, baffles))
        );
        const auto fitted = [&](const point& at)
        {
            const label celli = mesh.findCell(at);
            const point& x = mesh.C()[celli];
            const scalar d = x.x() - 20e-6;
            const quadratic& fit = fits[celli];
            return
                same(fit.value, k*vector(d*x.y(), sqr(d)/2 + sqr(x.z()), 0), 1e-9)
             && same(fit.gradient.x(), k*vector(x.y(), d, 0), 1e-9)
             && same(fit.gradient.y(), k*vector(d, 0, 2*x.z()), 1e-9)
             && mag(fit.curvature[0].xy()/k - 1) < 1e-6
             && mag(fit.curvature[1].xx()/k - 1) < 1e-6;
        };
        holds
        (
            name,
            fitted(point(15e-6, 13e-6, 6.25e-6))
         && fitted(point(19e-6, 13e-6, 1.25e-6))
        );
    }
}


// * * * * * * * * * * * * * * * Shared Functions  * * * * * * * * * * * * * //

void Foam::checkBoundaries(fvMesh& mesh)
{
    const layer at(mesh, vector(1e-3, 2e-3, -1e-3));

    typedef const ellipsoid_options& options;
    const auto longest = [](options o) { return o.semi_axes[1]; };
    const auto perWidth = [](options o) { return 1/o.semi_axes[0]; };
    holds
    (
        "the longest and the narrowest cell that may be drawn are known",
        mag(at.population.largest(longest)/(2e-6*exp(0.4)) - 1) < 1e-12
     && mag(at.population.largest(perWidth)*0.5e-6/exp(0.2) - 1) < 1e-12
    );
    checkMirror(at);
    checkLeaving(at);
    if (!Pstream::parRun())
    {
        checkInlet(mesh);
    checkInertia(mesh);
        checkSamples(mesh);
        checkFit(mesh, 0, "what is fitted to means is the flow that they are of");
        checkForces(mesh);
        checkMemory(at);

        // Mesh cells oblique to that plane, whose images are so the other way
        pointField points(mesh.points());
        for (point& x : points)
        {
            x += (x.x() - 20e-6)*vector(0, 0.5, 0);
        }
        mesh.movePoints(points);
        checkFit(mesh, 0.5, "in oblique mesh cells by a plane of symmetry, too");
    }
}
