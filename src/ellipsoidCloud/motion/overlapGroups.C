/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/
#include "overlapGroups.H"
#include "ListOps.H"

// * * * * * * * * * * * * * Static Member Functions * * * * * * * * * * * * //

Foam::DynamicList<Foam::labelPair> Foam::overlapGroups::overlapping
(
    const UList<boundBox>& boxes
)
{
    DynamicList<labelPair> pairs;

    boundBox all(boundBox::invertedBox);
    for (const boundBox& box : boxes)
    {
        all.add(box);
    }

    // Along the direction in which they are spread most
    direction axis = 0;
    for (const direction d : {1, 2})
    {
        if (all.span()[d] > all.span()[axis])
        {
            axis = d;
        }
    }

    scalarList low(boxes.size());
    forAll(low, i)
    {
        low[i] = boxes[i].min()[axis];
    }
    const labelList order(sortedOrder(low));

    forAll(order, i)
    {
        const boundBox& box = boxes[order[i]];
        const scalar high = box.max()[axis];

        for (label j = i + 1; j < order.size() && low[order[j]] <= high; ++j)
        {
            if (box.overlaps(boxes[order[j]]))
            {
                const label a = order[i];
                const label b = order[j];
                pairs.append(labelPair(min(a, b), max(a, b)));
            }
        }
    }

    sort(pairs);

    return pairs;
}


Foam::labelList Foam::overlapGroups::connected
(
    const label n,
    const UList<labelPair>& pairs
)
{
    labelList lowest(identity(n));

    const auto root =
        [&](label i)
        {
            while (lowest[i] != i)
            {
                lowest[i] = lowest[lowest[i]];
                i = lowest[i];
            }
            return i;
        };

    for (const labelPair& pair : pairs)
    {
        const label a = root(pair.first());
        const label b = root(pair.second());

        lowest[max(a, b)] = min(a, b);
    }

    forAll(lowest, i)
    {
        lowest[i] = root(i);
    }

    return lowest;
}


// ************************************************************************* //
