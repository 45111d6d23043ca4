// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "meshHalo.H"
#include "cyclicPolyPatch.H"
#include "HashSet.H"
#include "Map.H"
#include "polyMesh.H"
#include "processorPolyPatch.H"

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::meshHalo::meshHalo()
:
    links_(),
    nLocal_(0),
    size_(0)
{}


Foam::meshHalo::meshHalo(const polyMesh& mesh)
:
    links_(),
    nLocal_(mesh.nCells()),
    size_(nLocal_)
{
    const polyBoundaryMesh& patches = mesh.boundaryMesh();

    for (const polyPatch& patch : patches)
    {
        if (!patch.coupled())
        {
            continue;
        }

        link added{-1, 0, patch.faceCells(), size_, patch.size()};
        if (const auto* processor = isA<processorPolyPatch>(patch))
        {
            added.rank = processor->neighbProcNo();
            added.tag = processor->tag();
        }
        else
        {
            const auto& cyclic = refCast<const cyclicPolyPatch>(patch);
            added.send = patches[cyclic.neighbPatchID()].faceCells();
        }
        links_.append(added);
        size_ += added.size;
    }
}


Foam::meshHalo::meshHalo
(
    const meshHalo& fine,
    const label nAggregates,
    labelList& aggregates
)
:
    links_(fine.links_),
    nLocal_(nAggregates),
    size_(nLocal_)
{
    fine.exchange(aggregates);

    // Both sides go through the same faces in the same order, and number what
    // they meet as they meet it
    for (link& here : links_)
    {
        Map<label> beyond;
        for (label i = here.start; i < here.start + here.size; ++i)
        {
            beyond.insert(aggregates[i], size_ + beyond.size());
            aggregates[i] = beyond[aggregates[i]];
        }

        labelHashSet met;
        labelList send;
        for (const label i : here.send)
        {
            if (met.insert(aggregates[i]))
            {
                send.append(aggregates[i]);
            }
        }

        here.send.transfer(send);
        here.start = size_;
        here.size = beyond.size();
        size_ += beyond.size();
    }
}
