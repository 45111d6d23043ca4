// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

/*---------------------------------------------------------------------------*\
Description
    What captureCriterion keeps of a cell from interval to interval.

\*---------------------------------------------------------------------------*/

#include "layerParts.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    static captureCriterion criterionOf(const layer& at, const char* text)
    {
        captureCriterion criterion(entries(text), at.mesh.boundaryMesh());
        criterion.setInletSpeed(1);
        return criterion;
    }

    static bool near(const scalar a, const scalar b)
    {
        return mag(a - b) <= 1e-9*mag(b);
    }

    //- The imbalance of a cell that is slow, and of one that is confined
    static void checkImbalance(const layer& at)
    {
        const point x(10e-6, 10e-6, 5e-6);
        const vector U(1e-3, 2e-3, -1e-3);
        const captureCriterion criterion
        (
            criterionOf(at, "displacement 1e-6; holdTime 1;")
        );

        cellSweep cell = cellSweep();
        cell.state = at.cellAt(x);
        cell.state.slowTime = 0.1;
        cell.nWalls = 1;

        // Contact leaves a half of the drag unbalanced, then a tenth
        const scalar times[] = {0.2, 0.5, 0.6};
        const vector moves[] = {{1e-7, 0, 0}, {0, -2e-7, 1e-7}};
        const auto advance =
            [&](const label i, const scalar left)
            {
                const vector u(left*U);
                std::copy_n(u.v_, 3, cell.state.body.u);
                cell.state.time = times[i + 1];
                criterion.ended
                (
                    cell, cell.state.centre() - moves[i], times[i],
                    at.population.median(), at.domain
                );
            };

        advance(0, 0.5);
        holds
        (
            "the part of the drag that contact does not balance",
            near(cell.state.imbalance, 0.5)
        );
        advance(1, 0.1);
        holds
        (
            "of a slow cell the largest is kept",
            near(cell.state.imbalance, 0.5)
        );
        holds
        (
            "the drag of all intervals is summed up, each by its time",
            same(cell.state.dragImpulse, 0.4*at.drag(U))
        );
        holds
        (
            "and the drag of all displacements",
            same(cell.state.netImpulse, at.drag(moves[0] + moves[1]))
        );

        // By the displacement it is that of the whole time
        List<cellState> before(1, cell.state);
        List<cellSweep> after(1, cell);
        DynamicList<cellEvent> events;
        before[0].time = 0.5;
        after[0].state.place = x;
        criterion.judge(before, after, 0.6, events);
        holds
        (
            "a confined cell's imbalance is that of all its time",
            near
            (
                after[0].state.imbalance,
                mag(at.drag(moves[0] + moves[1]))/mag(0.4*at.drag(U))
            )
        );
        holds
        (
            "it has been confined for so much longer",
            near(after[0].state.slowTime, 0.2)
        );

        cell.state.fate = cellState::caught;
        cell.state.imbalance = 0.1;
        advance(1, 0.8);
        holds
        (
            "that of a caught cell stays",
            near(cell.state.imbalance, 0.1)
        );

        // In contact with a cell alone
        cell.nWalls = 0;
        cell.nCells = 1;
        cell.state.slowTime = 0;
        cell.state.netImpulse = Zero;
        advance(1, 0.8);
        holds
        (
            "of one that touches a cell the drag is known",
            same(cell.state.netImpulse, at.drag(moves[1]))
        );

        // Neither slow nor in contact: nothing is asked
        cell.nCells = 0;
        const vector kept(cell.state.netImpulse);
        advance(1, 0.8);
        holds("of a free cell nothing is kept", cell.state.netImpulse == kept);
    }

    //- One that enters is confined from where it has entered on
    static void checkPlace(const layer& at)
    {
        const point x(10e-6, 10e-6, 5e-6);
        const vector moved(0.3e-6, 0, 0);
        const captureCriterion criterion
        (
            criterionOf(at, "displacement 1e-6; holdTime 1;")
        );

        List<cellState> before(1, at.cellAt(x));
        List<cellSweep> after(1, cellSweep());
        DynamicList<cellEvent> events;
        before[0].fate = cellState::waiting;
        before[0].time = 0.25;
        after[0].state = at.cellAt(x + moved);
        criterion.judge(before, after, 0.5, events);

        const cellState& cell = after[0].state;
        holds
        (
            "a cell is confined to where it has entered",
            same(cell.place, x)
        );
        holds("from then on", near(cell.slowTime, 0.25));
        holds
        (
            "that it was injected is told, of its state then",
            events.size() == 1 && events[0].type == "injected"
         && same(events[0].cell.centre(), x)
         && events[0].cell.fate == cellState::inFlight
        );

        // As far as the displacement from there, though not in an interval
        for (const scalar end : {0.75, 1.0, 1.25})
        {
            before[0] = cell;
            before[0].time = end - 0.25;
            after[0].state = at.cellAt(cell.centre() + moved);
            after[0].state.place = before[0].place;
            after[0].state.slowTime = before[0].slowTime;
            after[0].state.dragImpulse = after[0].state.netImpulse = moved;
            criterion.judge(before, after, end, events);
        }
        holds
        (
            "one that has come that far has a new place",
            same(cell.place, x + 4*moved)
        );
        holds
        (
            "where all begins again",
            cell.slowTime == 0 && cell.imbalance == 0
         && cell.dragImpulse == vector::zero
         && cell.netImpulse == vector::zero
        );

        // Once round, where it is in the mesh is not how far it has come
        before[0] = at.cellAt(x);
        before[0].time = 1.25;
        before[0].unfold = isometry::translation(vector(20e-6, 0, 0));
        before[0].place = before[0].unfolded();
        after[0].state = before[0];
        criterion.judge(before, after, 1.5, events);
        holds("a period that was passed is not a way", near(cell.slowTime, 0.25));
    }

    //- A cell that waits is told of once; one that is held for longer has the
    //  place where it is then; one that is fast has nothing left
    static void checkOthers(const layer& at)
    {
        List<cellState> before(3, at.cellAt(point(10e-6, 10e-6, 5e-6)));
        List<cellSweep> after(3, cellSweep());
        DynamicList<cellEvent> events;
        forAll(before, i)
        {
            before[i].id = i;
            before[i].fate = i < 2 ? cellState::waiting : cellState::stalled;
            before[i].planned = before[i].time = 0.1;
            after[i].state = before[i];
            after[i].state.place = before[i].centre();
        }
        after[1].state.time = 0.2;
        after[2].state.slowTime = 0.95;
        after[2].state.body.x[0] += 0.5e-6;
        criterionOf(at, "displacement 1e-6; holdTime 1;").judge
        (
            before, after, 0.2, events
        );
        holds
        (
            "a cell that waits is told of at its first attempt",
            events.size() == 1 && events[0].type == "waiting"
         && events[0].cell.id == 0
        );
        holds
        (
            "one that is held for a hold time again is so where it is then",
            after[2].state.slowTime == 0
         && after[2].state.place == after[2].state.unfolded()
        );

        before[2].fate = after[2].state.fate = cellState::inFlight;
        after[2].state.slowTime = after[2].state.imbalance = 0.5;
        criterionOf(at, "speed 1e-7; holdTime 1;").judge
        (
            before, after, 0.2, events
        );
        holds
        (
            "one that is fast has balanced nothing yet",
            after[2].state.slowTime == 0 && after[2].state.imbalance == 0
        );
    }

    //- What holds a cell decides, not where it lies in the list
    static void checkChain(const layer& at)
    {
        const label sieve = at.mesh.boundaryMesh().findPatchID("post");
        const label wall = at.mesh.boundaryMesh().findPatchID("plates");
        const captureCriterion criterion
        (
            criterionOf(at, "speed 1; holdTime 1; sieves (post);")
        );

        // 0 touches 1, 1 touches 2, 2 the sieve; 3 a wall, 4 nothing
        List<cellState> before(5);
        List<cellSweep> after(5, cellSweep());
        DynamicList<cellEvent> events;
        forAll(before, i)
        {
            before[i] = at.cellAt(point(10e-6, 10e-6, 5e-6), 10 + i);
            after[i].state = before[i];
            after[i].state.slowTime = i == 4 ? 0 : 0.9;
        }
        for (const label i : {0, 1})
        {
            after[i].nCells = 1;
            after[i].cells[0] = 11 + i;
        }
        for (const label i : {2, 3})
        {
            after[i].nWalls = 2;
            after[i].walls[0] = wall;
            after[i].walls[1] = i == 2 ? sieve : wall;
        }
        criterion.judge(before, after, 0.2, events);

        bool all = true;
        for (label i = 0; i < 3; ++i)
        {
            all = all && after[i].state.fate == cellState::caught
             && after[i].state.patch == sieve;
        }
        holds("a sieve holds the cells that lie on those that it holds", all);
        holds
        (
            "one that rests at a wall is stalled",
            after[3].state.fate == cellState::stalled
         && after[3].state.patch == wall
        );
        holds
        (
            "one that has not been slow for long is in flight",
            after[4].state.fate == cellState::inFlight && events.size() == 4
        );

        // One of them gets going
        forAll(before, i)
        {
            before[i] = after[i].state;
            before[i].time = 0.2;
        }
        after[1].state.body.x[0] += 1e-6;
        events.clear();
        criterionOf(at, "speed 1e-6; holdTime 1;").judge
        (
            before, after, 0.4, events
        );
        holds
        (
            "one that gets going is released, from where it was held",
            after[1].state.fate == cellState::inFlight
         && after[1].state.patch == -1 && after[1].state.slowTime == 0
         && events.size() == 1 && events[0].type == "released"
         && events[0].cell.patch == sieve
        );
    }

    //- By which of the walls that it touches a cell is caught or stalls, and when
    static void checkWalls(const layer& at)
    {
        const label sieve = at.mesh.boundaryMesh().findPatchID("post");
        const label wall = at.mesh.boundaryMesh().findPatchID("plates");
        List<cellState> before(2, at.cellAt(point(10e-6, 10e-6, 5e-6)));
        List<cellSweep> after(2, cellSweep());
        DynamicList<cellEvent> events;
        const auto judge = [&](const char* sieves, const scalar end)
        {
            forAll(before, i)
            {
                before[i].id = i;
                before[i].time = end - 0.25;
                after[i].state = before[i];
                after[i].state.time = end;
            }
            events.clear();
            criterionOf(at, sieves).judge(before, after, end, events);
            forAll(before, i)
            {
                before[i] = after[i].state;
            }
        };
        const char* both = "speed 1; holdTime 0.5; sieves (post plates post);";
        const char* one = "speed 1; holdTime 0.5; sieves (post);";

        // 0 touches both, the sieve last, 1 nothing yet
        after[0].nWalls = 2;
        after[0].walls[0] = wall;
        after[0].walls[1] = sieve;
        judge(one, 0.5);
        holds
        (
            "slow for half of the hold time is not yet held",
            events.empty() && near(after[0].state.slowTime, 0.25)
        );
        List<cellState> slow(before);
        judge(both, 0.75);
        holds
        (
            "for all of it is, by the first sieve that it touches",
            events.size() == 2 && after[0].state.fate == cellState::caught
         && after[0].state.patch == wall
        );
        before = slow;
        after[0].walls[1] = wall;
        after[0].walls[0] = at.mesh.boundaryMesh().findPatchID("left");
        judge(one, 0.75);
        holds
        (
            "without a sieve it stalls, at the first wall, or none",
            after[0].state.fate == cellState::stalled
         && after[0].state.patch == after[0].walls[0]
         && after[1].state.fate == cellState::stalled
         && after[1].state.patch == -1
        );
        after[0].walls[1] = sieve;
        judge(one, 1);
        holds
        (
            "one that has stalled is caught as soon as it touches a sieve",
            after[0].state.fate == cellState::caught
         && after[0].state.patch == sieve && events.size() == 1
        );
        holds
        (
            "a sieve that is named twice is one",
            criterionOf(at, both).sieves() == labelList({sieve, wall})
        );
        holds
        (
            "the speed of one that is confined is that over its hold time",
            near
            (
                criterionOf(at, "displacement 1e-6; holdTime 4;").slowSpeed(),
                0.25e-6
            )
        );
    }
}



// * * * * * * * * * * * * * * * Shared Functions  * * * * * * * * * * * * * //

void Foam::checkCaptures(const layer& at)
{
    checkImbalance(at);
    checkPlace(at);
    checkOthers(at);
    checkChain(at);
    checkWalls(at);
}
