// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "groupSharing.H"
#include "DynamicList.H"
#include "ListOps.H"
#include "scalarList.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- Steps to be expected of a cell that has taken none
    static const scalar newSteps = 100;
}


// * * * * * * * * * * * * * * * Global Functions  * * * * * * * * * * * * * //

Foam::labelList Foam::groupSharing::distributed
(
    const UList<cellSweep>& before,
    const UList<labelList>& groups,
    const scalar time
)
{
    labelList ranks(groups.size(), 0);

    if (!Pstream::parRun())
    {
        return ranks;
    }

    // By the steps to be expected; all of a group go with the shortest
    scalarList work(groups.size());
    forAll(groups, k)
    {
        scalar steps = 1;
        for (const label i : groups[k])
        {
            const scalar step = before[i].state.controller.step;
            steps = max(steps, step > 0 ? time/step : newSteps);
        }
        work[k] = steps*groups[k].size();
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
    const UList<labelList>& groups
)
{
    labelList tets(groups.size());
    forAll(groups, k)
    {
        tets[k] = cells[groups[k][0]].state.tet;
    }

    labelList order;
    sortedOrder(tets, order);
    return order;
}


void Foam::groupSharing::exchange
(
    List<cellSweep>& cells,
    const UList<labelList>& groups,
    const labelUList& ranks
)
{
    DynamicList<cellSweep> mine;
    forAll(groups, k)
    {
        if (ranks[k] == Pstream::myProcNo())
        {
            mine.append(List<cellSweep>(cells, groups[k]));
        }
    }

    const List<List<cellSweep>> sent(Pstream::nProcs(), mine);
    List<List<cellSweep>> all;
    Pstream::exchange<List<cellSweep>, cellSweep>(sent, all);

    labelList next(all.size(), Zero);
    forAll(groups, k)
    {
        for (const label i : groups[k])
        {
            cells[i] = all[ranks[k]][next[ranks[k]]++];
        }
    }
}
