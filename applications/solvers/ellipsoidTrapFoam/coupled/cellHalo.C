/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/

#include "cellHalo.H"
#include "cyclicFvPatch.H"
#include "fvMesh.H"
#include "Map.H"
#include "processorFvPatch.H"
#include "PstreamReduceOps.H"

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::cellHalo::cellHalo()
:
    links_(),
    nCells_(0),
    nHalo_(0)
{}


Foam::cellHalo::cellHalo(const fvMesh& mesh)
:
    links_(),
    nCells_(mesh.nCells()),
    nHalo_(0)
{
    labelList linkOf(mesh.boundary().size(), -1);
    labelList otherPatch;

    for (const fvPatch& patch : mesh.boundary())
    {
        if (!patch.coupled())
        {
            continue;
        }

        const label size = patch.size();
        link added{-1, 0, -1, patch.faceCells(), nCells_ + nHalo_, size};
        label other = -1;

        if (isA<processorFvPatch>(patch))
        {
            const auto& processorPatch = refCast<const processorFvPatch>(patch);
            added.rank = processorPatch.neighbProcNo();
            added.tag = processorPatch.tag();
        }
        else
        {
            other = refCast<const cyclicFvPatch>(patch).neighbPatchID();
        }

        linkOf[patch.index()] = links_.size();
        links_.append(added);
        otherPatch.append(other);
        nHalo_ += size;
    }

    forAll(links_, linki)
    {
        if (otherPatch[linki] >= 0)
        {
            links_[linki].other = linkOf[otherPatch[linki]];
        }
    }
}


Foam::cellHalo::cellHalo
(
    const cellHalo& fine,
    const label nAggregates,
    labelList& aggregates
)
:
    links_(fine.links_),
    nCells_(nAggregates),
    nHalo_(0)
{
    fine.exchange(aggregates);

    // Both sides go through the same faces in the same order, and number what
    // they meet as they meet it
    for (link& thisLink : links_)
    {
        const label fineStart = thisLink.start;
        const label fineSize = thisLink.size;

        Map<label> beyond;
        for (label i = fineStart; i < fineStart + fineSize; ++i)
        {
            beyond.insert(aggregates[i], nCells_ + nHalo_ + beyond.size());
            aggregates[i] = beyond[aggregates[i]];
        }

        Map<label> local;
        labelList send;
        for (const label celli : thisLink.send)
        {
            if (local.insert(aggregates[celli], 0))
            {
                send.append(aggregates[celli]);
            }
        }

        thisLink.send.transfer(send);
        thisLink.start = nCells_ + nHalo_;
        thisLink.size = beyond.size();
        nHalo_ += beyond.size();
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

bool Foam::cellHalo::handles(const fvMesh& mesh)
{
    bool handled = true;

    for (const fvPatch& patch : mesh.boundary())
    {
        if (patch.coupled())
        {
            const auto& coupled = refCast<const coupledFvPatch>(patch);

            if
            (
                !coupled.parallel()
             || !(isA<processorFvPatch>(patch) || isA<cyclicFvPatch>(patch))
            )
            {
                handled = false;
            }
        }
    }

    return returnReduce(handled, andOp<bool>());
}


// ************************************************************************* //
