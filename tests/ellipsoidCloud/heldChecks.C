// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

/*---------------------------------------------------------------------------*\
Description
    What occupancy keeps of cells that are held and let go, in fluid at rest;
    what a restart has of it and of a cell; what the flow does to held bodies.

\*---------------------------------------------------------------------------*/

#include "layerParts.H"
// Of the solver, which is no library
#include "solidBodies.C"

#include <cmath>

// * * * * * * * * * * * * * * * Local Classes * * * * * * * * * * * * * * * //

namespace Foam
{
    //- One cell that is held
    struct holding
    {
        const layer& at;
        captureCriterion criterion;
        occupancy held;
        List<cellState> cells;
        DynamicList<cellEvent> events;

        static constexpr scalar speed = 1e-6;

        holding
        (
            const layer& at,
            const cellState& cell,
            const dictionary& notes = dictionary(),
            const char* rests = "speed 1e-6; holdTime 0.05;",
            const char* how = "active yes;"
        )
        :
            at(at),
            criterion(entries(rests), at.mesh.boundaryMesh()),
            held
            (
                occupancy::setting
                (
                    entries(how),
                    at.mesh.boundaryMesh()
                ),
                criterion,
                tableSet
                {
                    at.mesh.boundaryMesh().names(), at.population,
                    at.mesh.time().path()/"tables", false, dictionary(),
                    1
                },
                notes
            ),
            cells(1, cell)
        {
            criterion.setInletSpeed(1);
            held.setDomain(at.domain);
            held.begin();
        }

        //- Caught, and pulled like this. Do all stay?
        bool allStay(const List<heldWrench>& pulls)
        {
            for (cellState& cell : cells)
            {
                cell.fate = cellState::caught;
            }
            return stillHeld(pulls) == cells.size();
        }

        //- How many are held after those that are caught are pulled like this
        label stillHeld(const List<heldWrench>& pulls)
        {
            events.clear();
            held.update(cells, events);
            held.setWrenches(pulls, cells);
            held.release(cells, true, events);

            return held.held().size();
        }

        bool stays(const heldWrench& pull)
        {
            return allStay(List<heldWrench>(1, pull));
        }

        //- A pull that moves a cell at so many times the speed of a slow one
        heldWrench pullOf(const scalar times) const
        {
            return {at.drag(vector(times*speed, 0, 0)), Zero};
        }

        bool staysAt(const scalar times)
        {
            return stays(pullOf(times));
        }

        dictionary notes()
        {
            dictionary notes, tables;
            held.note(notes, tables);
            return notes;
        }
    };
}


// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    static void checkPulls(const layer& at)
    {
        const cellState cell(at.cellAt(point(10e-6, 10e-6, 5e-6), 3));

        holding pulled(at, cell);
        holds("a weak pull leaves a held cell", pulled.staysAt(0.98));
        holds("so does one as that, asked or not", pulled.staysAt(1.02));
        holds("the flow is not asked for again", !pulled.held.outdated());
        pulled.cells[0].slowTime = 1;
        pulled.cells[0].dragImpulse = vector::one;
        holds("a stronger one moves it", !pulled.staysAt(1.1));
        holds("then the flow is another", pulled.held.outdated());
        holds
        (
            "and it has to come to rest anew",
            pulled.cells[0].slowTime == 0
         && pulled.cells[0].dragImpulse == vector::zero
         && same(pulled.cells[0].place, cell.centre())
        );
        holds
        (
            "it is told, and is where it was held",
            pulled.events.size() == 1 && pulled.events[0].type == "released"
         && pulled.cells[0].fate == cellState::inFlight
         && pulled.cells[0].centre() == cell.centre()
        );
        holds("one that withstood a pull does so again", pulled.staysAt(1.1));
        holds("and what exceeds that by less than moves it", pulled.staysAt(2));
        holds("by more it does not", !pulled.staysAt(2.3));

        holding afterRestart(at, cell, pulled.notes());
        holds("a restart knows it", afterRestart.staysAt(3.2));

        holding barely(at, cell);
        holds("hardly more than a slow one is enough", !barely.staysAt(1.008));

        // Off the place where it was let go
        pulled.cells[0].body.x[1] += 0.06e-6;
        holds("elsewhere it has withstood nothing", !pulled.staysAt(2.3));
    }

    //- Of two cells that one is let go makes the other be asked again
    static void checkTwo(const layer& at)
    {
        const cellState cell(at.cellAt(point(10e-6, 10e-6, 5e-6), 3));
        holding two(at, cell);
        two.cells.append(at.cellAt(point(15e-6, 10e-6, 5e-6), 4));
        two.cells[0].body.u[0] = two.cells[1].body.omega[2] = 1;

        const auto pulls = [&](const scalar first, const scalar second)
        {
            return List<heldWrench>({two.pullOf(first), two.pullOf(second)});
        };

        const bool both = two.allStay(pulls(0.98, 0.98));
        holds("two that are pulled weakly stay", both);
        holds
        (
            "held cells are still",
            two.cells[0].body.u[0] == 0 && two.cells[1].body.omega[2] == 0
        );
        holds
        (
            "a flow that does the same is told from another",
            two.held.setWrenches(pulls(0.98, 0.98), two.cells)
         && !two.held.setWrenches(pulls(0.5, 0.98), two.cells)
        );
        two.allStay(pulls(0.98, 3));
        holds
        (
            "one goes, the other is not yet asked again",
            two.events.size() == 1 && two.events[0].cell.id == 4
        );
        two.allStay(pulls(1.02, 0));
        holds
        (
            "but then it is",
            two.events.size() == 1 && two.events[0].cell.id == 3
        );
    }

    //- A cell that is held, and another beside it that is not
    static void checkBeside(const layer& still)
    {
        const layer at(still.mesh, vector(1e-5, 0, 0));
        const cellState cell(at.cellAt(point(10e-6, 10e-6, 5e-6), 3));
        const auto isLeft =
            [&](const scalar distance, const cellState::fateType fate)
            {
                holding one(at, cell);
                one.cells.append(at.cellAt(cell.centre(), 4));
                one.cells[0].fate = cellState::caught;
                one.cells[1].fate = fate;
                one.cells[1].body.x[0] -= distance;
                return one.stillHeld({one.pullOf(0)}) == 1;
            };

        holds
        (
            "one that comes to it, later than in the first part of a trial,"
            " pushes it off",
            !isLeft(1.1e-6, cellState::inFlight)
        );
        holds("one farther off does not", isLeft(1.2e-6, cellState::inFlight));
        holds
        (
            "nor does one that waits to enter there",
            isLeft(0.9e-6, cellState::waiting)
        );
    }

    //- A cell on the floor that is turned upright
    static void checkTorques(const layer& at)
    {
        const ellipsoid_model& model = at.population.median();
        const cellState cell(at.cellAt(point(10e-6, 10e-6, 0.5e-6), 3));
        const heldWrench turn
        {
            Zero,
            vector(40*model.viscosity*model.rotation_resistance[0], 0, 0)
        };

        holding turned(at, cell);
        holds("a torque moves a cell on the floor", !turned.stays(turn));
        holding afterRestart(at, cell, turned.notes());
        holds("having withstood that it stays", turned.stays(turn));
        holds("so it does after a restart", afterRestart.stays(turn));

        holding asked(at, cell);
        asked.staysAt(0.98);
        holds
        (
            "another torque is asked of, though the force is the same",
            !asked.stays({asked.pullOf(0.98).force, turn.torque})
        );

        // A quarter turn about z
        cellState other(cell);
        other.body.q[2] = other.body.q[3] = std::sqrt(0.5);
        holding quarter(at, other);
        const heldWrench lab
        {
            at.drag(vector(9*holding::speed, 0, 0)), turn.torque
        };
        quarter.stays(lab);
        const vectorField from(quarter.notes().get<vectorField>("releasedFrom"));
        holds
        (
            "forces are of the lab, torques of the body",
            from.size() == 3 && same(from[0], cell.centre())
         && same(from[1], lab.force)
         && mag(from[2] - vector(0, -turn.torque.x(), 0))
          < 1e-9*mag(turn.torque)
        );
    }

    //- One that is confined is held when what acts on it is balanced
    static void checkBalance(const layer& at)
    {
        cellState cell(at.cellAt(point(10e-6, 10e-6, 5e-6), 3));
        const auto isHeld = [&](const scalar imbalance)
        {
            cell.imbalance = imbalance;
            holding one
            (
                at, cell, dictionary(), "displacement 1e-6; holdTime 0.05;"
            );
            return one.staysAt(0);
        };
        holds("one that is on its way is not held", !isHeld(0.011));
        holds("one that is balanced to 1 % is", isHeld(0.009));
    }

    //- What a restart has of held cells
    static void checkNotes(const layer& at)
    {
        const dictionary given
        (
            entries
            (
                "held (3 5); heldForces ((1 2 3) (4 5 6));"
                "released (7 9); releasedFrom ((1 2 3) (4 5 6) (7 8 9) (10 11 12)"
                "    (13 14 15) (16 17 18));"
                "stayed (3 4); stayedUnder ((1 2 3) (4 5 6) (7 8 9) (10 11 12));"
            )
        );
        const dictionary written
        (
            holding(at, at.cellAt(point(10e-6, 10e-6, 5e-6)), given).notes()
        );
        const auto has = [&](const char* name, const bool does)
        {
            holds((string("a restart has ") + name).c_str(), does);
        };

        for (const char* name : {"held", "released", "stayed"})
        {
            has
            (
                name,
                given.get<labelList>(name) == written.get<labelList>(name)
            );
        }
        for (const char* name : {"heldForces", "releasedFrom", "stayedUnder"})
        {
            has
            (
                name,
                given.get<vectorField>(name) == written.get<vectorField>(name)
            );
        }
    }

    //- What a restart has of a cell, and what an image makes of it
    static void checkState(const layer& at)
    {
        List<cellState> cells(3);
        scalar next = 1;
        for (cellState& cell : cells)
        {
            cell = cellState();
            scalar* number = reinterpret_cast<scalar*>(&cell);
            const scalar* end = reinterpret_cast<scalar*>(&cell.id);
            while (number != end)
            {
                *number++ = std::sqrt(next++);
            }
            for (label* of : {&cell.id, &cell.tet, &cell.fate, &cell.patch})
            {
                *of = label(next++);
            }
        }
        OStringStream os;
        os.precision(17);
        writeStates(cells, os);
        const List<cellState> read
        (
            readStates(entries(os.str()))
        );
        bool equal = read.size() == cells.size();
        forAll(read, i)
        {
            equal =
                equal && !std::memcmp(&read[i], &cells[i], sizeof(cellState));
        }
        holds("a restart has all of a cell, to the last bit", equal);

        cellState cell(at.cellAt(point(1e-6, 2e-6, 3e-6)));
        const point x(cell.centre());
        cell.dragImpulse = vector(1, 2, 3);
        cell.netImpulse = vector(4, 5, 6);
        const scalar axes[] = {0.5e-6, 2e-6, 0.5e-6};
        cell.body.u[0] = 7;
        const scalar axis[] = {0.48, 0.6, 0.64};
        ellipsoid_quaternion_from_axis(axis, 0.7, cell.body.q);
        std::copy_n(vector(8, 9, 10).v_, 3, cell.body.omega);
        const vector spin(rotationOf(cell.body.q) & vector(8, 9, 10));
        const vector O(longAxis(cell.body.q));
        cell.pass(isometry::mirror(point(0.5e-6, 0, 0), vector(1, 0, 0)), axes);
        holds
        (
            "beyond a plane of symmetry forces and velocities are mirrored",
            same(cell.dragImpulse, vector(-1, 2, 3))
         && same(cell.netImpulse, vector(-4, 5, 6)) && cell.body.u[0] == -7
        );
        const vector turned(rotationOf(cell.body.q) & pointOf(cell.body.omega));
        holds
        (
            "and spins as what they are",
            mag(turned - vector(spin.x(), -spin.y(), -spin.z())) < 1e-9
        );
        const vector mirrored(-O.x(), O.y(), O.z());
        holds
        (
            "with the axes",
            mag(1 - mag(longAxis(cell.body.q) & mirrored)) < 1e-12
        );
        holds
        (
            "and places, with the way in one piece",
            same(cell.centre(), point(0, 2e-6, 3e-6))
         && same(cell.unfolded(), x)
        );
    }
}


// * * * * * * * * * * * * * * * Shared Functions  * * * * * * * * * * * * * //

void Foam::checkHeld(const layer& at)
{
    checkPulls(at);
    checkTwo(at);
    checkBeside(at);
    checkTorques(at);
    checkBalance(at);
    checkNotes(at);
    checkState(at);
}


// Bodies that share a mesh cell share what it resists by their volumes: of
// n alike, of a part f of its volume each, each by f/(1 - n f)
void Foam::checkBodies(const layer& at)
{
    const volVectorField& U = at.undecomposed.U();
    const label celli = at.mesh.findCell(point(10e-6, 10e-6, 6e-6));
    const heldBody body
    {
        0, 0, at.mesh.C()[celli], tensor::I, vector::uniform(0.6e-6)
    };
    solidBodies solids(at.mesh, dimensionedScalar("nu", dimViscosity, 1e-6));
    const auto drags = [&](const List<heldBody>& bodies)
    {
        solids.set(bodies);
        return solids.wrenches(U, 1000);
    };
    scalar drag[3];
    for (label n = 1; n < 4; ++n)
    {
        drag[n - 1] = mag(drags(List<heldBody>(n, body))[n - 1].force);
    }
    OStringStream os;
    os << drag[0] << ' ' << drag[1] << ' ' << drag[2];
    holds
    (
        "bodies in one mesh cell share what it resists",
        drag[0] > 0
     && mag(1/drag[0] - 2/drag[1] + 1/drag[2]) < 1e-5/drag[0]
     && drag[1] > 1.01*drag[0],
        os.str()
    );

    heldBody small(body);
    small.semiAxes *= 0.8;
    const List<heldWrench> pair(drags(List<heldBody>({body, small})));
    const scalar ratio = mag(pair[1].force)/mag(pair[0].force);
    holds
    (
        "each by its volume",
        mag(ratio/pow3(0.8) - 1) < 0.05,
        Foam::name(ratio)
    );

    // Beside the middle of the mesh cell
    heldBody beside(body);
    const vector off(0.1e-6, -0.05e-6, 0.2e-6);
    beside.centre += off;
    const heldWrench one(drags(List<heldBody>(1, beside))[0]);
    holds
    (
        "its torque is about its own centre",
        mag(one.torque - (-off ^ one.force)) < 1e-9*mag(one.torque)
     && mag(one.torque) > 0
    );
}
