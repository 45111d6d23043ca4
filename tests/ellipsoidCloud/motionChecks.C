// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

/*---------------------------------------------------------------------------*\
Description
    What an interval makes of cells that enter, pass a cyclic patch, meet or
    are held.

\*---------------------------------------------------------------------------*/

#include "layerParts.H"
#include "memInfo.H"

#include <malloc.h>

// * * * * * * * * * * * * * * * Local Classes * * * * * * * * * * * * * * * //

namespace Foam
{
    //- What is seen of the steps of cells. A row has the cell, and how long the
    //  step is; -1 for its entry
    struct seenSteps : public trackSampler
    {
        List<scalar> times, starts;

        explicit seenSteps(const label nCells)
        :
            times(nCells, Zero),
            starts(nCells, Zero)
        {}

        static void add
        (
            const cellState& cell, const scalar time, DynamicList<row>& rows
        )
        {
            row r = row();
            r.id = cell.id;
            r.time = time;
            rows.append(r);
        }

        virtual void start(cellState& cell, DynamicList<row>& rows) const
        {
            cell.nextRow = 1;
            cell.lastRow[7] = 2;
            add(cell, -1, rows);
        }

        virtual void add
        (
            cellState& cell, const ellipsoid_step& step, const meshFlow&,
            const label, DynamicList<row>& rows
        ) const
        {
            ++cell.nextRow;
            add(cell, step.end - step.start, rows);
        }

        virtual void finish(cellState&, DynamicList<row>&) const
        {}

        virtual void addRows(const UList<row>& rows)
        {
            for (const row& r : rows)
            {
                (r.time < 0 ? starts : times)[r.id] += mag(r.time);
            }
        }

        //- Of all ranks. Is each time that, with every step once?
        bool all(const scalar duration)
        {
            bool each = true;
            forAll(times, i)
            {
                reduce(times[i], sumOp<scalar>());
                reduce(starts[i], sumOp<scalar>());
                each = each && mag(times[i] - duration) < 1e-9;
            }
            return each;
        }

        string text() const
        {
            OStringStream os;
            os << times << ' ' << starts;
            return os.str();
        }
    };
}


// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- A cell that is carried over a cyclic patch, and one that enters on its way
    static void checkPassing(const layer& at)
    {
        // How far each was from where it is said to have been advanced from
        struct seen : public contactObserver
        {
            mutable scalar farthest = 0;

            virtual void ended
            (
                cellSweep& cell, const point& from, const scalar,
                const ellipsoid_model&, const cellDomain&
            ) const
            {
                farthest = max(farthest, mag(cell.state.centre() - from));
            }
        } observer;

        List<cellState> cells(2);
        cells[0] = at.cellAt(point(19.9e-6, 10e-6, 5e-6), 0);
        cells[0].deepest = cells[0].deepestCell = 1e-7;
        cells[1] = at.cellAt(point(10e-6, 10e-6, 5e-6), 1);
        cells[1].fate = cellState::waiting;
        cells[1].time = cells[1].planned = 0.4e-3;
        const List<cellState> before(cells);
        groupScheduler scheduler(at.population, at.domain, nullptr, &observer);
        const List<cellSweep> moved(scheduler.advanceInterval(cells, 0, 1e-3));

        const vector way(1e-6, 2e-6, -1e-6);
        const auto near = [&](const vector& a, const vector& b)
        {
            return mag(a - b) < 0.05e-6;
        };
        const cellState& passed = moved[0].state;
        holds
        (
            "a cell passes a cyclic patch, and its way is in one piece",
            near(passed.centre(), before[0].centre() + way - vector(20e-6, 0, 0))
         && near(passed.unfolded(), before[0].centre() + way)
        );
        holds
        (
            "what it has swept is in one piece, too",
            near(pointOf(moved[0].sweep.passed), vector(20e-6, 0, 0))
         && near
            (
                pointOf(moved[0].sweep.high),
                before[0].centre() + vector(1e-6, 2e-6, 0)
            )
        );
        holds("where it began is seen from where it is", observer.farthest < 5e-6);
        holds
        (
            "it has been as deep in others as it was",
            passed.deepest == 1e-7 && passed.deepestCell == 1e-7
        );
        holds
        (
            "a cell that enters moves from then on",
            near(moved[1].state.centre(), before[1].centre() + 0.6*way)
        );
    }


    //- Every step that stands is seen once, where cells push one another to
    //  others that they had not been advanced with; at any time
    static void checkSeen(const layer& at, const scalar start)
    {
        // The first two overlap the third, and push towards the fourth
        List<cellState> cells(4);
        const scalar x[] = {10e-6, 10.4e-6, 10.2e-6, 8.81e-6};
        forAll(cells, i)
        {
            cells[i] = at.cellAt(point(x[i], 10e-6, 5e-6), i);
            cells[i].time = start;
            cells[i].fate =
                i < 3 ? cellState::inFlight : cellState::waiting;
            cells[i].nextRow = i < 3 ? start : -GREAT;
        }
        seenSteps tracks(4);
        groupScheduler scheduler(at.population, at.domain, &tracks, nullptr);
        const List<cellSweep> moved
        (
            scheduler.advanceInterval(cells, start, start + 1e-3)
        );

        holds
        (
            "of each cell all steps are seen once",
            tracks.all(1e-3),
            tracks.text()
        );
        holds
        (
            "and that it has entered",
            tracks.starts[3] == 1 && tracks.starts[0] == 0
         && moved[3].state.lastRow[7] == 2,
            tracks.text()
        );
        holds
        (
            "they have met",
            moved[3].state.deepestCell > 0 && moved[0].sweep.travel > 0.57e-6
        );
    }

    //- Two that meet late, so that the interval is halved: what was seen of the
    //  first part stands when they are put back in the second
    static void checkHalves(const layer& still)
    {
        const layer at(still.mesh, Zero, tensor(-1167, 0, 0, 0, 0, 0, 0, 0, 0));
        List<cellState> cells(2);
        forAll(cells, i)
        {
            cells[i] = at.cellAt(point((8.8 + 2.4*i)*1e-6, 10e-6, 5e-6), i);
            cells[i].nextRow = 1e-9;
        }
        seenSteps tracks(2);
        groupScheduler scheduler(at.population, at.domain, &tracks, nullptr);
        const List<cellSweep> moved(scheduler.advanceInterval(cells, 0, 1e-3));

        holds
        (
            "of two that meet in the second half, too",
            tracks.all(1e-3) && moved[0].state.deepestCell > 0,
            tracks.text()
        );
    }

    //- Where it is held a cell stays, and its time goes on
    static void checkRests(const layer& stream)
    {
        List<cellState> cells(1, stream.cellAt(point(10e-6, 10e-6, 5e-6), 3));
        heldCells held;
        held.insert(3, heldWrench{Zero, Zero});
        groupScheduler scheduler
        (
            stream.population, stream.domain, nullptr, nullptr, &held
        );
        const List<cellSweep> moved(scheduler.advanceInterval(cells, 0, 1e-3));

        holds
        (
            "a held cell stays, and its time goes on",
            moved[0].state.centre() == cells[0].centre()
         && moved[0].state.time == 1e-3
        );
    }
}


// * * * * * * * * * * * * * * * Shared Functions  * * * * * * * * * * * * * //

void Foam::checkMotion(const layer& still, const layer& stream)
{
    checkPassing(stream);
    checkSeen(still, 0);
    checkSeen(still, -2e-3);
    checkHalves(still);
    checkRests(stream);
}


// Lists of facets, of 21 kB each, are kept of 250 cells only: 40 MB were found,
// 85 MB with all of them
void Foam::checkMemory(const layer& stream)
{
    const auto resident = [&](const label nCells)
    {
        List<cellState> cells(nCells);
        forAll(cells, i)
        {
            cells[i] = stream.cellAt(point(10e-6, 10e-6, 5e-6), i);
        }
        groupScheduler scheduler
        (
            stream.population, stream.domain, nullptr, nullptr
        );
        scheduler.advanceInterval(cells, 0, 1e-9);
        // What is free has been given back
        malloc_trim(0);
        return memInfo().rss();
    };
    const label few = resident(1);
    const label more = resident(2000) - few;
    holds
    (
        "2000 cells take less than 60 MB",
        more < 60000,
        Foam::name(more) + " kB"
    );
}
