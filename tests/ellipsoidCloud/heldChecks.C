// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

/*---------------------------------------------------------------------------*\
Description
    What occupancy keeps of cells that are held and let go, in fluid at rest;
    and what a restart has of it and of a cell.

\*---------------------------------------------------------------------------*/

#include "layerParts.H"

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
            const dictionary& notes = dictionary()
        )
        :
            at(at),
            criterion
            (
                entries("speed 1e-6; holdTime 0.05;"),
                at.mesh.boundaryMesh()
            ),
            held
            (
                occupancy::setting
                (
                    entries("active yes;"),
                    at.mesh.boundaryMesh()
                ),
                criterion,
                tableSet
                {
                    at.mesh.boundaryMesh().names(), at.population,
                    at.mesh.time().path()/"tables", false, dictionary(),
                    []() { return ""; }, 1
                },
                notes
            ),
            cells(1, cell)
        {
            criterion.setInletSpeed(1);
            held.setDomain(at.domain);
            held.begin();
        }

        //- Caught, and pulled like this. Does it stay?
        bool stays(const heldWrench& pull)
        {
            cells[0].fate = cellState::caught;
            events.clear();
            held.update(cells, events);
            held.take(List<heldWrench>(1, pull), cells);
            held.letGo(cells, true, events);

            return held.held().found(cells[0].id);
        }

        //- That moves it at so many times the speed of a slow one
        bool staysAt(const scalar times)
        {
            return stays({at.drag(vector(times*speed, 0, 0)), Zero});
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
        holds("a stronger one moves it", !pulled.staysAt(1.1));
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

        // Off the place where it was let go
        pulled.cells[0].body.x[1] += 0.06e-6;
        holds("elsewhere it has withstood nothing", !pulled.staysAt(1.1));
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

        // A quarter turn about z
        cellState other(cell);
        other.body.q[2] = other.body.q[3] = std::sqrt(0.5);
        holding quarter(at, other);
        const heldWrench lab
        {
            at.drag(vector(9*holding::speed, 0, 0)), turn.torque
        };
        quarter.stays(lab);
        const vectorField from(quarter.notes().get<vectorField>("letGoFrom"));
        holds
        (
            "forces are of the lab, torques of the body",
            from.size() == 3 && same(from[0], cell.centre())
         && same(from[1], lab.force)
         && mag(from[2] - vector(0, -turn.torque.x(), 0))
          < 1e-9*mag(turn.torque)
        );
    }

    //- What a restart has of held cells
    static void checkNotes(const layer& at)
    {
        const dictionary given
        (
            entries
            (
                "held (3 5); heldForces ((1 2 3) (4 5 6));"
                "letGo (7 9); letGoFrom ((1 2 3) (4 5 6) (7 8 9) (10 11 12)"
                "    (13 14 15) (16 17 18));"
                "stayed (3 4); borne ((1 2 3) (4 5 6) (7 8 9) (10 11 12));"
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

        for (const char* name : {"held", "letGo", "stayed"})
        {
            has
            (
                name,
                given.get<labelList>(name) == written.get<labelList>(name)
            );
        }
        for (const char* name : {"heldForces", "letGoFrom", "borne"})
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
        cell.body.omega[0] = 8;
        cell.body.omega[1] = 9;
        cell.pass(isometry::mirror(point(0.5e-6, 0, 0), vector(1, 0, 0)), axes);
        holds
        (
            "beyond a plane of symmetry forces and velocities are mirrored",
            same(cell.dragImpulse, vector(-1, 2, 3))
         && same(cell.netImpulse, vector(-4, 5, 6)) && cell.body.u[0] == -7
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
    checkTorques(at);
    checkNotes(at);
    checkState(at);
}
