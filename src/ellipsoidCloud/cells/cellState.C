// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "cellState.H"
#include "dictionary.H"
#include "quaternion.H"
#include "scalarList.H"

#include <cstddef>

// * * * * * * * * * * * * * * * Static Data Members * * * * * * * * * * * * //

const Foam::Enum<Foam::cellState::fateType> Foam::cellState::fateNames
({
    { fateType::inFlight, "inFlight" },
    { fateType::caught, "caught" },
    { fateType::stalled, "stalled" },
    { fateType::escaped, "escaped" },
    { fateType::lost, "lost" },
    { fateType::waiting, "waiting" }
});


// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- A member of a cell: so many labels or scalars
    struct cellField
    {
        const char* name;
        std::size_t offset;
        std::size_t count;
        bool isLabel;

        constexpr std::size_t size() const
        {
            return count*(isLabel ? sizeof(label) : sizeof(scalar));
        }
    };


    //- All members of cellState in their order: all reading and writing goes by
    //  this list
    static constexpr cellField cellFields[] =
    {
        { "U", offsetof(cellState, body.u), 3, false },
        { "x", offsetof(cellState, body.x), 3, false },
        { "omega", offsetof(cellState, body.omega), 3, false },
        { "q", offsetof(cellState, body.q), 4, false },
        { "step", offsetof(cellState, controller.step), 1, false },
        {
            "previousError",
            offsetof(cellState, controller.previous_error), 1, false
        },
        { "time", offsetof(cellState, time), 1, false },
        { "planned", offsetof(cellState, planned), 1, false },
        { "slowTime", offsetof(cellState, slowTime), 1, false },
        { "imbalance", offsetof(cellState, imbalance), 1, false },
        { "place", offsetof(cellState, place), 3, false },
        { "dragImpulse", offsetof(cellState, dragImpulse), 3, false },
        { "netImpulse", offsetof(cellState, netImpulse), 3, false },
        { "nextRow", offsetof(cellState, nextRow), 1, false },
        { "lastRow", offsetof(cellState, lastRow), 8, false },
        { "deepest", offsetof(cellState, deepest), 1, false },
        { "deepestCell", offsetof(cellState, deepestCell), 1, false },
        { "size", offsetof(cellState, size), 3, false },
        { "unfold", offsetof(cellState, unfold), 12, false },
        { "id", offsetof(cellState, id), 1, true },
        { "tet", offsetof(cellState, tet), 1, true },
        { "fate", offsetof(cellState, fate), 1, true },
        { "patch", offsetof(cellState, patch), 1, true }
    };


    //- Do the members from i on fill the struct from this byte on?
    static constexpr bool fills(const std::size_t i, const std::size_t byte)
    {
        return
            i == sizeof(cellFields)/sizeof(cellFields[0])
          ? byte == sizeof(cellState)
          : cellFields[i].offset == byte
         && fills(i + 1, byte + cellFields[i].size());
    }

    static_assert(fills(0, 0), "cellFields lacks a member of cellState");
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::cellState::pass(const isometry& image, const scalar semiAxes[3])
{
    if (image.isIdentity())
    {
        return;
    }

    const point x(image(centre()));
    const tensor turn(image.turn());
    const vector u(turn & pointOf(body.u));

    std::copy_n(x.v_, 3, body.x);
    std::copy_n(u.v_, 3, body.u);
    dragImpulse = turn & dragImpulse;
    netImpulse = turn & netImpulse;
    unfold = unfold.after(image.inverse());

    if (image.translates())
    {
        return;
    }

    // Of a body that is its own mirror image along this axis, a reflection M
    // makes one that is turned by -M, and before by half a turn about the axis
    const bool mirrors = image.mirrors();
    const int axis = ellipsoid_mirror_axis(semiAxes);
    const quaternion before(body.q[3], pointOf(body.q));
    quaternion after(quaternion(mirrors ? tensor(-turn) : turn)*before);

    if (mirrors)
    {
        vector half(Zero);
        half[axis] = 1;
        after *= quaternion(0, half);
        for (int i = 0; i < 3; ++i)
        {
            body.omega[i] *= i == axis ? 1 : -1;
        }
    }
    std::copy_n(after.v().v_, 3, body.q);
    body.q[3] = after.w();
}


// * * * * * * * * * * * * * * * Global Functions  * * * * * * * * * * * * * //

void Foam::writeStates(const UList<cellState>& cells, Ostream& os)
{
    for (const cellField& field : cellFields)
    {
        scalarList values(field.count*cells.size());
        scalar* value = values.data();

        for (const cellState& cell : cells)
        {
            const void* member =
                reinterpret_cast<const char*>(&cell) + field.offset;
            for (std::size_t i = 0; i < field.count; ++i)
            {
                *value++ =
                    field.isLabel
                  ? static_cast<const label*>(member)[i]
                  : static_cast<const scalar*>(member)[i];
            }
        }
        os.writeEntry(field.name, values);
    }
}


Foam::List<Foam::cellState> Foam::readStates(const dictionary& dict)
{
    List<cellState> cells(dict.get<labelList>("id").size(), cellState());
    for (const cellField& field : cellFields)
    {
        const scalarList values(dict.get<scalarList>(field.name));
        if (std::size_t(values.size()) != field.count*cells.size())
        {
            FatalIOErrorInFunction(dict)
                << field.name << " of " << cells.size() << " cells has "
                << values.size() << " values: the state is of another version"
                << " of this program" << exit(FatalIOError);
        }

        const scalar* value = values.cdata();
        for (cellState& cell : cells)
        {
            void* member = reinterpret_cast<char*>(&cell) + field.offset;
            for (std::size_t i = 0; i < field.count; ++i, ++value)
            {
                if (field.isLabel)
                {
                    static_cast<label*>(member)[i] = label(*value);
                }
                else
                {
                    static_cast<scalar*>(member)[i] = *value;
                }
            }
        }
    }

    return cells;
}
