// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "overlapGroups.H"
#include "ListOps.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{

//- Pairs of boxes that overlap, the lower index first, in ascending order
static DynamicList<labelPair> pairsOf(const UList<boundBox>& boxes)
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

} // End namespace Foam


// * * * * * * * * * * * * * * * Global Functions  * * * * * * * * * * * * * //

Foam::DynamicList<Foam::overlapGroups::overlap>
Foam::overlapGroups::overlapping
(
    const UList<boundBox>& boxes,
    const UList<vector>& translations
)
{
    DynamicList<boundBox> all(boxes);
    DynamicList<overlap> images;
    boundBox extent(boundBox::invertedBox);
    for (const boundBox& box : boxes)
    {
        extent.add(box);
    }

    for (const vector& by : translations)
    {
        forAll(boxes, i)
        {
            const boundBox image(boxes[i].min() + by, boxes[i].max() + by);
            if (image.overlaps(extent))
            {
                all.append(image);
                images.append(overlap{labelPair(i, i), by});
            }
        }
    }

    DynamicList<overlap> found;
    for (const labelPair& pair : pairsOf(all))
    {
        const label image = pair.second() - boxes.size();

        if (image < 0)
        {
            found.append(overlap{pair, Zero});
        }
        else if
        (
            // Each once: the image of the first meets the second as well
            pair.first() < images[image].items.first()
        )
        {
            found.append
            (
                overlap
                {
                    labelPair(pair.first(), images[image].items.first()),
                    images[image].moved
                }
            );
        }
    }

    return found;
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
