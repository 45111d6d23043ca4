// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "meshHalo.H"
#include "UIPstream.H"
#include "UOPstream.H"

// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

template<class Type>
void Foam::meshHalo::exchange(UList<Type>& values) const
{
    const auto mode = UPstream::commsTypes::nonBlocking;
    const label before = UPstream::nRequests();
    List<List<Type>> sent(links_.size());

    forAll(links_, linki)
    {
        const link& here = links_[linki];
        Type* received = values.begin() + here.start;

        if (here.rank < 0)
        {
            for (const label i : here.send)
            {
                *received++ = values[i];
            }
            continue;
        }

        UIPstream::read
        (
            mode,
            here.rank,
            reinterpret_cast<char*>(received),
            here.size*sizeof(Type),
            here.tag
        );

        List<Type>& buffer = sent[linki];
        buffer.setSize(here.send.size());
        forAll(buffer, i)
        {
            buffer[i] = values[here.send[i]];
        }
        UOPstream::write
        (
            mode,
            here.rank,
            reinterpret_cast<const char*>(buffer.begin()),
            buffer.size()*sizeof(Type),
            here.tag
        );
    }

    UPstream::waitRequests(before);
}
