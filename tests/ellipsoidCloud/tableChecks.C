// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

/*---------------------------------------------------------------------------*\
Description
    What stands in tables and files of poses and tracks, and what a run that
    goes on with them reads.

\*---------------------------------------------------------------------------*/

#include "atomicWrite.H"
#include "cellPoses.H"
#include "cellTracks.H"
#include "layerParts.H"
#include "OSspecific.H"

#include <algorithm>
#include <fstream>

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- Tables of cells that pass planes of symmetry, after those noted
    static tableSet tablesOf(const layer& at, const dictionary& earlier)
    {
        return tableSet
        {
            at.mesh.boundaryMesh().names(), at.population,
            at.mesh.time().path()/"tables", true, earlier, 1e-3
        };
    }

    //- The first row of an array in a file for ParaView
    static std::string rowOf(const std::string& text, const std::string& name)
    {
        const std::size_t array = text.find("Name=\"" + name + '"');
        const std::size_t begin = text.find('\n', array) + 1;
        return text.substr(begin, text.find('\n', begin) - begin);
    }

    //- Digits of times, and a file that is gone on with
    static void checkFiles(const layer& at)
    {
        const tableSet set(tablesOf(at, dictionary()));
        holds
        (
            "times have the digits that resolve so small a part of an interval",
            set.timeText(1234.5678, 6) == "1234.5678"
         && set.timeText(1234.5678, 6, 1) == "1234.568"
         && set.timeText(0.5, 6) == "0.5"
        );

        const fileName name(set.folder/"rows.csv");
        mkDir(set.folder);
        std::ofstream(name) << "of another run\n";
        dictionary notes;
        {
            appendedFile file(set, "rows", "header", 12);
            file.open();
            file.stream() << "one\n";
            file.flush();
            notes.add("rows", file.notes());
            file.stream() << "two\n";
            file.flush();
        }
        holds
        (
            "a table of an earlier run is begun anew",
            textOf(name) == "header\none\ntwo\n",
            textOf(name)
        );

        appendedFile again(tablesOf(at, notes), "rows", "header", 12);
        std::string rows;
        again.forRows([&](const std::string& row) { rows += row + ';'; });
        holds("a restart reads the rows that it goes on from", rows == "one;", rows);
        again.open();
        again.stream() << "three\n";
        again.flush();
        holds
        (
            "and cuts the others",
            textOf(name) == "header\none\nthree\n",
            textOf(name)
        );
    }

    //- An event is read as it was written
    static void checkEvents(const layer& at)
    {
        const tableSet set(tablesOf(at, dictionary()));
        cellEvent event{"released", at.cellAt(point(13e-6, 2e-6, 5e-6), 7)};
        cellState& cell = event.cell;
        cell.time = 0.125;
        cell.patch = at.mesh.boundaryMesh().findPatchID("post");
        cell.body.q[0] = 0.5;
        cell.deepest = 1e-9;
        cell.deepestCell = 2e-9;
        cell.size.width *= 0.75;
        cell.unfold = isometry::translation(vector(20e-6, 0, 0));

        OStringStream os;
        os.precision(17);
        event.write(os.stdStream(), set);
        std::string line(os.str());
        line.pop_back();
        cellEvent read = cellEvent();
        const bool whole = read.read(line, set);
        const cellState& same = read.cell;
        holds
        (
            "an event is read as it was written",
            whole && read.type == "released" && same.time == cell.time
         && same.id == 7 && same.patch == cell.patch
         && same.fate == cellState::inFlight && same.centre() == cell.centre()
         && std::equal(cell.body.q, cell.body.q + 4, same.body.q)
         && same.deepest == cell.deepest
         && same.deepestCell == cell.deepestCell
         && same.size.length == cell.size.length
         && same.size.width == cell.size.width,
            line
        );
        holds
        (
            "with the way in one piece",
            mag(same.unfolded() - vector(33e-6, 2e-6, 5e-6)) < 1e-18
        );

        const std::size_t post = line.find("post");
        std::string other(line);
        other.replace(post, 4, "nowhere");
        holds("not by a patch that is none", !cellEvent().read(other, set));
        holds("nor with more columns", !cellEvent().read(line + ",1", set));
    }

    static void checkPoses(const layer& at)
    {
        const tableSet set(tablesOf(at, dictionary()));
        List<cellState> cells(2, at.cellAt(point(13e-6, 2e-6, 5e-6), 7));
        cellState& cell = cells[1];
        cells[0].fate = cellState::waiting;
        cell.fate = cellState::escaped;
        cell.patch = at.mesh.boundaryMesh().findPatchID("post");
        std::copy_n(vector(1, 2, 3).v_, 3, cell.body.u);
        std::copy_n(vector(4, 5, 6).v_, 3, cell.body.omega);
        const scalar axis[] = {0.48, 0.6, 0.64};
        ellipsoid_quaternion_from_axis(axis, 0.7, cell.body.q);

        const scalar* a = at.population.median().options.semi_axes;
        const vector along(longAxis(cell.body.q));
        holds
        (
            "the longest axis of a cell is where it lies",
            same
            (
                fullAxes(cell, at.population) & along,
                2*max(max(a[0], a[1]), a[2])*along
            )
        );

        for (const char* time : {"0.1", "0.2", "0.3"})
        {
            writePoses(set, cells, time);
        }
        const std::string text(textOf(set.folder/"poses"/"0.2.vtp"));
        holds
        (
            "poses are those of the cells that have entered",
            text.find("NumberOfPoints=\"1\"") != std::string::npos
         && rowOf(text, "id") == "7"
         && rowOf(text, "fate") == Foam::name(cell.fate)
         && rowOf(text, "patch") == Foam::name(cell.patch)
         && rowOf(text, "U") == "1 2 3" && rowOf(text, "omega") == "4 5 6",
            text
        );

        removeLaterPoses(set, 0.2);
        const std::string series(textOf(set.folder/"poses.pvd"));
        holds
        (
            "those of later times are removed, and no others",
            isFile(set.folder/"poses"/"0.1.vtp")
         && isFile(set.folder/"poses"/"0.2.vtp")
         && !isFile(set.folder/"poses"/"0.3.vtp")
         && series.find("timestep=\"0.1\"") != std::string::npos
         && series.find("timestep=\"0.2\"") != std::string::npos
         && series.find("timestep=\"0.3\"") == std::string::npos,
            series
        );
    }

    //- In the order of their times, as soon as none can come before them
    static void checkRows(const layer& at)
    {
        cellTracks tracks(tablesOf(at, dictionary()));
        DynamicList<cellTracks::row> rows;
        for (const scalar time : {0.3, 0.2, 0.1})
        {
            cellState cell(at.cellAt(point(13e-6, 2e-6, 5e-6), 7));
            cell.time = time;
            cell.unfold = isometry::translation(vector(20e-6, 0, 0));
            const scalar axis[] = {0, 0.6, 0.8};
            ellipsoid_quaternion_from_axis(axis, 0, cell.body.q);
            tracks.start(cell, rows);
            if (time == 0.1)
            {
                holds
                (
                    "the next row is an interval later",
                    mag(cell.nextRow - 0.101) < 1e-12
                );
            }
        }
        tracks.file.open();
        tracks.addRows(rows);

        const auto times = [&]()
        {
            std::string all;
            tracks.file.forRows([&](const std::string& row)
            {
                all += row.substr(0, row.find(',')) + ' ';
            });
            return all;
        };
        tracks.flush(0.3);
        holds
        (
            "rows before a time are written in order",
            times() == "0.1 0.2 ",
            times()
        );
        tracks.flush();
        holds("the others with the next", times() == "0.1 0.2 0.3 ", times());

        const tableSet& set = tracks.set();
        const cellSize size(at.population.medianSize());
        tracks.writeVTP([&](const label) { return size; });
        const std::string text(textOf(set.folder/"tracks.vtp"));
        std::ostringstream axes;
        axes.precision(9);
        const scalar* a = at.population.median().options.semi_axes;
        axes << a[0] << ' ' << a[1] << ' ' << a[2];
        holds
        (
            "tracks for ParaView have what stands in the rows",
            rowOf(text, "x") == "1.3e-05 2e-06 5e-06" && rowOf(text, "t") == "0.1"
         && rowOf(text, "id") == "7" && rowOf(text, "O") == "0 0.6 0.8"
         && rowOf(text, "unfolded") == "3.3e-05 2e-06 5e-06"
         && rowOf(text, "semiAxes") == axes.str(),
            text
        );
    }
}


// * * * * * * * * * * * * * * * Shared Functions  * * * * * * * * * * * * * //

void Foam::checkTables(const layer& at)
{
    checkFiles(at);
    checkEvents(at);
    checkPoses(at);
    checkRows(at);
}
