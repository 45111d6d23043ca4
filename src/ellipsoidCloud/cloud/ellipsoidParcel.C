/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/
#include "ellipsoidParcel.H"
#include "atomicWrite.H"
#include "domainImages.H"
#include "foamVersions.H"
#include "IOField.H"
#include "IOPosition.H"

#include <cstddef>

// * * * * * * * * * * * * * * Static Data Members * * * * * * * * * * * * * //

namespace Foam
{
    // What tools that read places expect in their header
    defineTemplateTypeNameAndDebugWithName
    (
        Cloud<ellipsoidParcel>, "Cloud<passiveParticle>", 0
    );
}

const Foam::word Foam::ellipsoidParcel::cloudName("ellipsoidCloudRestart");

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
    //- What a file holds of a cell
    enum fieldType { labels, scalars, vectors };

    //- A member of a cell: a file, or one for each of its components
    struct cellField
    {
        const char* name;
        std::size_t offset;
        fieldType type;
        int count;
    };

    //- All members of cellState in their order: all reading and writing goes by
    //  this list
    static constexpr cellField cellFields[] =
    {
        { "U", offsetof(cellState, body.u), vectors, 1 },
        { "x", offsetof(cellState, body.x), vectors, 1 },
        { "omega", offsetof(cellState, body.omega), vectors, 1 },
        { "q", offsetof(cellState, body.q), scalars, 4 },
        { "step", offsetof(cellState, controller.step), scalars, 1 },
        {
            "previousError",
            offsetof(cellState, controller.previous_error), scalars, 1
        },
        { "time", offsetof(cellState, time), scalars, 1 },
        { "planned", offsetof(cellState, planned), scalars, 1 },
        { "slowTime", offsetof(cellState, slowTime), scalars, 1 },
        { "imbalance", offsetof(cellState, imbalance), scalars, 1 },
        { "place", offsetof(cellState, place), vectors, 1 },
        { "dragImpulse", offsetof(cellState, dragImpulse), vectors, 1 },
        { "netImpulse", offsetof(cellState, netImpulse), vectors, 1 },
        { "nextRow", offsetof(cellState, nextRow), scalars, 1 },
        { "lastRow", offsetof(cellState, lastRow), scalars, 8 },
        { "deepest", offsetof(cellState, deepest), scalars, 1 },
        { "deepestCell", offsetof(cellState, deepestCell), scalars, 1 },
        { "length", offsetof(cellState, size.length), scalars, 1 },
        { "width", offsetof(cellState, size.width), scalars, 1 },
        { "density", offsetof(cellState, size.density), scalars, 1 },
        { "unfold", offsetof(cellState, unfold), vectors, 4 },
        { "id", offsetof(cellState, id), labels, 1 },
        { "tet", offsetof(cellState, tet), labels, 1 },
        { "fate", offsetof(cellState, fate), labels, 1 },
        { "patch", offsetof(cellState, patch), labels, 1 }
    };

    //- Size [bytes] of what a file holds of a cell
    static constexpr std::size_t sizeOf(const fieldType type)
    {
        return
            type == labels ? sizeof(label)
          : type == scalars ? sizeof(scalar)
          : sizeof(vector);
    }

    //- Do the members from i on fill the struct from this byte on?
    static constexpr bool fills(const std::size_t i, const std::size_t byte)
    {
        return
            i == sizeof(cellFields)/sizeof(cellFields[0])
          ? byte == sizeof(cellState)
          : cellFields[i].offset == byte
         && fills(i + 1, byte + cellFields[i].count*sizeOf(cellFields[i].type));
    }

    static_assert(fills(0, 0), "cellFields lacks a member of cellState");

    //- Read a member of the states from its files, or write it
    template<class Type>
    static void transfer
    (
        const Cloud<ellipsoidParcel>& c,
        const cellField& field,
        List<cellState>& cells,
        const IOobject::readOption option
    )
    {
        for (int d = 0; d < field.count; ++d)
        {
            const std::string component(field.count > 1 ? name(d) : "");
            IOField<Type> values
            (
                fieldFile(c, field.name + component, option), cells.size() > 0
            );
            const bool read = option == IOobject::MUST_READ;
            if (read)
            {
                c.checkFieldIOobject(c, values);
            }
            values.setSize(cells.size());

            forAll(cells, i)
            {
                void* state = &cells[i];
                void* value = &values[i];
                void* member =
                    static_cast<char*>(state) + field.offset + d*sizeof(Type);
                std::memcpy
                (
                    read ? member : value, read ? value : member, sizeof(Type)
                );
            }

            if (!read)
            {
                atomicWrite(values, cells.size() > 0);
            }
        }
    }

    //- All members; what unfolds a way only where it can fold
    static void transferAll
    (
        const Cloud<ellipsoidParcel>& c,
        List<cellState>& cells,
        const IOobject::readOption option
    )
    {
        const bool folds = domainImages::any(c.pMesh().boundaryMesh());

        for (const cellField& field : cellFields)
        {
            if (field.offset == offsetof(cellState, unfold) && !folds)
            {
                continue;
            }
            switch (field.type)
            {
                case labels: transfer<label>(c, field, cells, option); break;
                case scalars: transfer<scalar>(c, field, cells, option); break;
                case vectors: transfer<vector>(c, field, cells, option); break;
            }
        }
    }
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::ellipsoidParcel::ellipsoidParcel
(
    const polyMesh& mesh,
    const label celli,
    const cellState& state
)
:
    // Clear of the faces: beyond one by rounding would be an error
    passiveParticle
    (
        mesh,
        state.centre() + 1e-6*(mesh.cellCentres()[celli] - state.centre()),
        celli
    )
{
    origId() = state.id;
    origProc() = 0;
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::List<Foam::cellState> Foam::ellipsoidParcel::read(const polyMesh& mesh)
{
    const Cloud<ellipsoidParcel> c(mesh, cloudName, false);
    List<cellState> cells(c.size(), cellState());
    transferAll(c, cells, IOobject::MUST_READ);

    return cells;
}


void Foam::ellipsoidParcel::write
(
    const Cloud<ellipsoidParcel>& c,
    List<cellState>& cells
)
{
    c.write();
    transferAll(c, cells, IOobject::NO_READ);
}


void Foam::ellipsoidParcel::writeFields(const Cloud<ellipsoidParcel>& c)
{
    for
    (
        const auto type
      : {cloud::geometryType::COORDINATES, cloud::geometryType::POSITIONS}
    )
    {
        IOPosition<Cloud<ellipsoidParcel>> places(c, type);
        atomicWrite(places, c.size() > 0);
    }

    const auto none = IOobject::NO_READ;
    IOField<label> ids(fieldFile(c, "origId", none), c.size());
    IOField<label> ranks(fieldFile(c, "origProcId", none), c.size());
    label i = 0;
    for (const ellipsoidParcel& parcel : c)
    {
        ids[i] = parcel.origId();
        ranks[i++] = parcel.origProc();
    }
    atomicWrite(ids, c.size() > 0);
    atomicWrite(ranks, c.size() > 0);
}


// ************************************************************************* //
