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
#include "IOField.H"
#include "IOPosition.H"
#include "passiveParticleCloud.H"

#include <cstddef>
#include <cstring>

// * * * * * * * * * * * * * * Static Data Members * * * * * * * * * * * * * //

namespace Foam
{
    defineTemplateTypeNameAndDebug(Cloud<ellipsoidParcel>, 0);
}

const Foam::word Foam::ellipsoidParcel::cloudName("ellipsoidCloud");

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

    //- A file of the cells
    struct cellField
    {
        const char* name;
        std::size_t offset;
        fieldType type;
    };

    //- All members of cellState in their order: all reading and writing goes by
    //  this list
    static constexpr cellField cellFields[] =
    {
        { "U", offsetof(cellState, body.u), vectors },
        { "x", offsetof(cellState, body.x), vectors },
        { "omega", offsetof(cellState, body.omega), vectors },
        { "q0", offsetof(cellState, body.q[0]), scalars },
        { "q1", offsetof(cellState, body.q[1]), scalars },
        { "q2", offsetof(cellState, body.q[2]), scalars },
        { "q3", offsetof(cellState, body.q[3]), scalars },
        { "step", offsetof(cellState, controller.step), scalars },
        {
            "previousError",
            offsetof(cellState, controller.previous_error), scalars
        },
        { "time", offsetof(cellState, time), scalars },
        { "planned", offsetof(cellState, planned), scalars },
        { "slowTime", offsetof(cellState, slowTime), scalars },
        { "imbalance", offsetof(cellState, imbalance), scalars },
        { "nextRow", offsetof(cellState, nextRow), scalars },
        { "lastRow0", offsetof(cellState, lastRow[0]), scalars },
        { "lastRow1", offsetof(cellState, lastRow[1]), scalars },
        { "lastRow2", offsetof(cellState, lastRow[2]), scalars },
        { "lastRow3", offsetof(cellState, lastRow[3]), scalars },
        { "lastRow4", offsetof(cellState, lastRow[4]), scalars },
        { "lastRow5", offsetof(cellState, lastRow[5]), scalars },
        { "lastRow6", offsetof(cellState, lastRow[6]), scalars },
        { "lastRow7", offsetof(cellState, lastRow[7]), scalars },
        { "deepest", offsetof(cellState, deepest), scalars },
        { "deepestCell", offsetof(cellState, deepestCell), scalars },
        { "length", offsetof(cellState, length), scalars },
        { "width", offsetof(cellState, width), scalars },
        { "id", offsetof(cellState, id), labels },
        { "tet", offsetof(cellState, tet), labels },
        { "fate", offsetof(cellState, fate), labels },
        { "patch", offsetof(cellState, patch), labels }
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
         && fills(i + 1, byte + sizeOf(cellFields[i].type));
    }

    static_assert(fills(0, 0), "cellFields lacks a member of cellState");

    //- Read a file into the states
    template<class Type>
    static void readFile
    (
        const passiveParticleCloud& c,
        const cellField& file,
        List<cellState>& cells
    )
    {
        const IOField<Type> values
        (
            c.fieldIOobject(file.name, IOobject::MUST_READ), c.size() > 0
        );
        c.checkFieldIOobject(c, values);

        forAll(cells, i)
        {
            void* state = &cells[i];
            std::memcpy
            (
                static_cast<char*>(state) + file.offset,
                &values[i],
                sizeof(Type)
            );
        }
    }

    //- Write a file of the states
    template<class Type>
    static void writeFile
    (
        const Cloud<ellipsoidParcel>& c,
        const cellField& file
    )
    {
        IOField<Type> values
        (
            c.fieldIOobject(file.name, IOobject::NO_READ), c.size()
        );

        label i = 0;
        for (const ellipsoidParcel& parcel : c)
        {
            char bytes[sizeof(cellState)];
            std::memcpy(bytes, &parcel.state(), sizeof(bytes));
            void* value = &values[i++];
            std::memcpy(value, bytes + file.offset, sizeof(Type));
        }

        atomicWrite(values, c.size() > 0);
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
    ),
    state_(state)
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::List<Foam::cellState> Foam::ellipsoidParcel::read(const polyMesh& mesh)
{
    const passiveParticleCloud c(mesh, cloudName, false);
    List<cellState> cells(c.size());

    for (const cellField& file : cellFields)
    {
        switch (file.type)
        {
            case labels: readFile<label>(c, file, cells); break;
            case scalars: readFile<scalar>(c, file, cells); break;
            case vectors: readFile<vector>(c, file, cells); break;
        }
    }

    return cells;
}


void Foam::ellipsoidParcel::writeFields(const Cloud<ellipsoidParcel>& c)
{
    // What OpenFOAM's own particles have
    typedef cloud::geometryType geometry;

    for (const geometry type : {geometry::COORDINATES, geometry::POSITIONS})
    {
        IOPosition<Cloud<ellipsoidParcel>> places(c, type);
        atomicWrite(places, c.size() > 0);
    }

    const std::size_t id = offsetof(cellState, id);
    writeFile<label>(c, {"origId", id, labels});

    IOField<label> zeros
    (
        c.fieldIOobject("origProcId", IOobject::NO_READ),
        labelField(c.size(), 0)
    );
    atomicWrite(zeros, c.size() > 0);

    for (const cellField& file : cellFields)
    {
        switch (file.type)
        {
            case labels: writeFile<label>(c, file); break;
            case scalars: writeFile<scalar>(c, file); break;
            case vectors: writeFile<vector>(c, file); break;
        }
    }
}


// ************************************************************************* //
