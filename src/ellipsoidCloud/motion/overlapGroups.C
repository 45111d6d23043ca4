/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/
#include "overlapGroups.H"

#include <algorithm>
#include <numeric>

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
    for (direction d = 1; d < 3 && boxes.size(); ++d)
    {
        if (all.span()[d] > all.span()[axis])
        {
            axis = d;
        }
    }

    labelList order(boxes.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort
    (
        order.begin(),
        order.end(),
        [&](const label a, const label b)
        {
            return
                boxes[a].min()[axis] < boxes[b].min()[axis]
             || (boxes[a].min()[axis] == boxes[b].min()[axis] && a < b);
        }
    );

    forAll(order, i)
    {
        const boundBox& box = boxes[order[i]];

        for
        (
            label j = i + 1;
            j < order.size()
         && boxes[order[j]].min()[axis] <= box.max()[axis];
            ++j
        )
        {
            if (box.overlaps(boxes[order[j]]))
            {
                pairs.append
                (
                    labelPair
                    (
                        std::min(order[i], order[j]),
                        std::max(order[i], order[j])
                    )
                );
            }
        }
    }

    std::sort(pairs.begin(), pairs.end());

    return pairs;
}


Foam::labelList Foam::overlapGroups::connected
(
    const label n,
    const UList<labelPair>& pairs
)
{
    labelList lowest(n);
    std::iota(lowest.begin(), lowest.end(), 0);

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

        lowest[std::max(a, b)] = std::min(a, b);
    }

    forAll(lowest, i)
    {
        lowest[i] = root(i);
    }

    return lowest;
}


// ************************************************************************* //
