// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "groupSharing.H"
#include "ListOps.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- Steps to be expected of a cell that has taken none
    static const scalar newSteps = 100;
}


// * * * * * * * * * * * * * * * Global Functions  * * * * * * * * * * * * * //

Foam::labelList Foam::groupSharing::distributed
(
    const List<groupScheduler::unit>& units,
    const labelUList& listed,
    const groupScheduler::span& time
)
{
    labelList ranks(listed.size(), 0);

    if (!time.shared || !Pstream::parRun())
    {
        return ranks;
    }

    // By the steps to be expected; all of a group go with the shortest
    scalarList work(listed.size());
    forAll(listed, k)
    {
        const labelList& members = units[listed[k]].cells;
        scalar steps = 1;
        for (const label i : members)
        {
            const scalar step = time.before[i].state.controller.step;
            steps = max
            (
                steps, step > 0 ? (time.end - time.start)/step : newSteps
            );
        }
        work[k] = steps*members.size();
    }

    // The most expensive first
    scalarList load(Pstream::nProcs(), Zero);
    labelList order;
    sortedOrder(work, order, UList<scalar>::greater(work));

    for (const label k : order)
    {
        ranks[k] = findMin(load);
        load[ranks[k]] += work[k];
    }

    return ranks;
}


Foam::labelList Foam::groupSharing::inMeshOrder
(
    const UList<cellSweep>& cells,
    const List<groupScheduler::unit>& units,
    const labelUList& listed
)
{
    labelList tets(listed.size());
    forAll(listed, k)
    {
        tets[k] = cells[units[listed[k]].cells[0]].state.tet;
    }

    labelList order;
    sortedOrder(tets, order);
    return order;
}


void Foam::groupSharing::exchange
(
    List<cellSweep>& cells,
    const List<groupScheduler::unit>& units,
    const labelUList& listed,
    const labelUList& ranks
)
{
    const label me = Pstream::myProcNo();
    labelList counts(Pstream::nProcs(), Zero);
    DynamicList<label> mine;

    forAll(listed, k)
    {
        const labelList& members = units[listed[k]].cells;
        counts[ranks[k]] += members.size();
        if (ranks[k] == me)
        {
            mine.append(members);
        }
    }

    List<List<cellSweep>> sent(counts.size());
    List<List<cellSweep>> all;
    forAll(sent, rank)
    {
        if (rank != me)
        {
            sent[rank] = UIndirectList<cellSweep>(cells, mine);
        }
    }
    counts[me] = 0;
    Pstream::exchange<List<cellSweep>, cellSweep>(sent, counts, all);

    labelList next(counts.size(), Zero);
    forAll(listed, k)
    {
        const label rank = ranks[k];

        for (const label i : units[listed[k]].cells)
        {
            if (rank != me)
            {
                cells[i] = all[rank][next[rank]++];
            }
        }
    }
}
