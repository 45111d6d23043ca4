// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

/*---------------------------------------------------------------------------*\
Description
    What captureStatistics makes of events, and cellTracks of steps.

\*---------------------------------------------------------------------------*/

#include "atomicWrite.H"
#include "captureStatistics.H"
#include "cellTracks.H"
#include "layerParts.H"
#include "stringOps.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- Seconds that rowTimes() follows a cell for
    static const scalar rowsEnd = 0.3505;

    //- When the rows of a cell are that goes along evenly by so much [m/s] and
    //  turns by so much [rad/s]
    static scalarList rowTimes
    (
        const layer& at,
        const cellTracks& tracks,
        const cellState::fateType fate,
        const scalar speed,
        const scalar spin
    )
    {
        const vector axis(0, 0, 1);
        DynamicList<cellTracks::row> rows;
        cellState cell(at.cellAt(point(10e-6, 10e-6, 5e-6)));
        tracks.start(cell, rows);
        cell.fate = fate;

        // In many steps, as a pose is linear within one
        const label nSteps = 3500;
        for (label i = 0; i < nSteps; ++i)
        {
            ellipsoid_step step = ellipsoid_step();
            step.start = rowsEnd*i/nSteps;
            step.end = rowsEnd*(i + 1)/nSteps;
            step.before = cell.body;
            cell.body.x[0] = 10e-6 + speed*step.end;
            ellipsoid_quaternion_from_axis(axis.v_, 0, cell.body.q);
            cell.body.q[2] = std::sin(0.5*spin*step.end);
            cell.body.q[3] = std::cos(0.5*spin*step.end);
            cell.body.q[0] = cell.body.q[1] = 0;
            step.after = cell.body;
            tracks.add(cell, step, at.domain.flow, cell.tet, rows);
        }

        // The second has nothing to add
        cell.time = rowsEnd;
        tracks.finish(cell, rows);
        tracks.finish(cell, rows);

        scalarList times(rows.size());
        forAll(rows, i)
        {
            times[i] = rows[i].time;
        }
        return times;
    }

    //- Rows are left out where hardly anything moves, and of held cells, but for
    //  the last; by the defaults, 1 ms, 0.1 s and a hundredth of 2 um or of a rad
    static void checkTracks(const layer& at, const tableSet& set)
    {
        const cellTracks tracks(set);
        const auto every = [&]
        (
            const char* name, const cellState::fateType fate,
            const scalar speed, const scalar spin, const scalar interval
        )
        {
            const scalarList times(rowTimes(at, tracks, fate, speed, spin));
            const label n = label(rowsEnd/interval) + 1;
            bool all = times.size() == n + 1 && times[n] == rowsEnd;
            for (label i = 0; i < min(n, times.size()); ++i)
            {
                all = all && mag(times[i] - i*interval) < 1e-9;
            }
            OStringStream os;
            os << times;
            holds(name, all, os.str());
        };

        every("a cell has a row each interval", cellState::inFlight, 1e-4, 0, 1e-3);
        every("a slow one when it has moved", cellState::inFlight, 0.97e-6, 0, 21e-3);
        every("or turned", cellState::inFlight, 0, 0.48, 21e-3);
        every("a caught one rarely", cellState::caught, 1e-6, 0, 0.1);
        every("and none if it rests", cellState::caught, 0, 0, 1);
    }

    //- Of a cell that waits, one under way and one that has left
    static void checkRemaining(const layer& at)
    {
        const tableSet set
        {
            at.mesh.boundaryMesh().names(), at.population,
            at.mesh.time().path()/"remaining", true, dictionary(), 0.1
        };
        captureStatistics statistics(set, labelList());
        statistics.log.open();
        List<cellState> cells(3, at.cellAt(point(10e-6, 10e-6, 5e-6)));
        DynamicList<cellEvent> events;
        forAll(cells, i)
        {
            cells[i].id = i;
            cells[i].fate = i ? cellState::inFlight : cellState::waiting;
            events.append(cellEvent{i ? "injected" : "waiting", cells[i]});
        }
        cells[2].body.x[0] = 12e-6;
        cells[2].fate = cellState::escaped;
        cells[2].time = 1;
        events.append(cellEvent{"escaped", cells[2]});
        statistics.add(std::move(events));
        cells[1].unfold = isometry::translation(vector(20e-6, 0, 0));
        cells.setSize(2);
        OStringStream os;
        statistics.finish(cells, os);

        const auto says = [&](const char* text)
        {
            return os.str().find(text) != std::string::npos;
        };
        holds
        (
            "one that waits is not counted as injected",
            says("cells: 2 injected, 0 caught, 1 escaped, 0 stalled, 1 in")
         && says("waited to enter: 0 cells, 0 s in all; 1 still wait"),
            os.str()
        );
        const std::string table(textOf(set.folder/"cells.csv"));
        const auto lines(stringOps::split(table, '\n'));
        const std::string one(lines[1].str()), two(lines[2].str());
        const std::string end("1.2e-05,1e-05,5e-06,");
        holds
        (
            "those that have entered have a line, with where they are",
            lines.size() == 3
         && one.find(",3e-05,1e-05,5e-06") == one.size() - 18
         && two.find(end) > two.find("escaped")
         && two.find(end) != std::string::npos,
            table
        );
    }
}


// * * * * * * * * * * * * * * * Shared Functions  * * * * * * * * * * * * * //

void Foam::checkStatistics(const layer& at)
{
    const polyBoundaryMesh& patches = at.mesh.boundaryMesh();
    const label post = patches.findPatchID("post");
    const label plates = patches.findPatchID("plates");
    const tableSet set
    {
        patches.names(), at.population, at.mesh.time().path()/"statistics",
        false, dictionary(), 0.1
    };
    captureStatistics statistics(set, labelList({post, plates}));
    statistics.log.open();

    // Half as wide, so that its beads are, too
    cellState cell(at.cellAt(point(10e-6, 10e-6, 5e-6), 7));
    cell.size.width *= 0.5;
    cell.body.q[0] = 0.6;
    cell.body.q[3] = 0.8;
    cellState next(at.cellAt(point(5e-6, 10e-6, 5e-6), 8));
    DynamicList<cellEvent> events;
    const auto tell = [&]
    (
        cellState& of, const char* type, const cellState::fateType fate,
        const label patchi, const scalar time
    )
    {
        of.fate = fate;
        of.patch = patchi;
        of.time = time;
        events.append(cellEvent{type, of});
    };
    tell(cell, "waiting", cellState::waiting, -1, 0.25);
    tell(cell, "injected", cellState::inFlight, -1, 0.5);
    tell(cell, "caught", cellState::caught, post, 1);
    tell(cell, "released", cellState::inFlight, -1, 2);
    tell(cell, "caught", cellState::caught, plates, 3);
    tell(next, "injected", cellState::inFlight, -1, 0.5);
    tell(next, "caught", cellState::caught, plates, 2.50125);
    statistics.add(std::move(events));

    cell.time = 4;
    cell.deepest = 1e-9;
    cell.deepestCell = 2e-9;
    cell.imbalance = 0.02;
    OStringStream os;
    statistics.finish(List<cellState>({cell, next}), os);

    // By the names of columns
    const std::string table(textOf(set.folder/"cells.csv"));
    const auto lines(stringOps::split(table, '\n'));
    const auto names(stringOps::split(lines[0].str(), ','));
    const auto fields(stringOps::split(lines[1].str(), ','));
    const auto is = [&](const char* name, const char* text)
    {
        for (std::size_t i = 0; i < names.size(); ++i)
        {
            if (names[i].str() == name)
            {
                return fields[i].str() == text;
            }
        }
        return false;
    };
    holds
    (
        "a cell is caught first where it was first, and last where it is",
        is("firstSieve", "post") && is("tFirstCatch", "1")
     && is("patch", "plates"),
        table
    );
    holds("with the pose with which it entered", is("eta", "0.8"), table);
    holds("its fate is of when it came to it", is("tFate", "3"), table);

    const std::string captures(textOf(set.folder/"captures.csv"));
    holds
    (
        "the times at a sieve are in order",
        captures.find("plates,2, 2.50125 3\n") != std::string::npos,
        captures
    );

    const auto says = [&](const std::string& text)
    {
        return os.str().find(text) != std::string::npos;
    };
    const scalar part =
        100*1e-9/(0.5*at.population.median().options.bead_radius);
    OStringStream percent;
    percent << part << " % of its radius";
    holds
    (
        "overlaps are parts of the cell's own beads",
        says(percent.str()),
        os.str()
    );
    holds
    (
        "what pulls by more than 1 % is not balanced",
        says("held: 1 of 2 caught cells balanced to 1 %, worst 2 % (cell 7)"),
        os.str()
    );
    holds
    (
        "and how long cells waited to enter is told",
        says("waited to enter: 1 cells, 0.25 s in all"),
        os.str()
    );
    holds
    (
        "those with other cells are told by themselves",
        says("another cell's: 2 nm, ") && says("with a wall: 1 nm, "),
        os.str()
    );
    const std::string log(textOf(set.folder/"events.csv"));
    holds
    (
        "events are told in the order of their times",
        log.find("\n2.50125,8,") < log.find("\n3,7,"),
        log
    );
    checkRemaining(at);
    checkTracks(at, set);
}
