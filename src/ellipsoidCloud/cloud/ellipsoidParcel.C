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
#include "fullPrecision.H"
#include "IOField.H"
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

    //- Files of a member of cellState: one, or one a component
    struct cellField
    {
        const char* name;
        std::size_t offset;
        fieldType type;
        int nFiles;
    };

    //- All members in their order: all reading and writing goes by this list
    static constexpr cellField cellFields[] =
    {
        { "U", offsetof(cellState, body.u), vectors, 1 },
        { "x", offsetof(cellState, body.x), vectors, 1 },
        { "omega", offsetof(cellState, body.omega), vectors, 1 },
        { "q", offsetof(cellState, body.q), scalars, 4 },
        { "step", offsetof(cellState, controller.step), scalars, 1 },
        {
            "previousError", offsetof(cellState, controller.previous_error),
            scalars, 1
        },
        { "time", offsetof(cellState, time), scalars, 1 },
        { "planned", offsetof(cellState, planned), scalars, 1 },
        { "slowTime", offsetof(cellState, slowTime), scalars, 1 },
        { "imbalance", offsetof(cellState, imbalance), scalars, 1 },
        { "nextRow", offsetof(cellState, nextRow), scalars, 1 },
        { "lastRow", offsetof(cellState, lastRow), scalars, 8 },
        { "deepest", offsetof(cellState, deepest), scalars, 1 },
        { "deepestCell", offsetof(cellState, deepestCell), scalars, 1 },
        { "length", offsetof(cellState, length), scalars, 1 },
        { "width", offsetof(cellState, width), scalars, 1 },
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
         && fills(i + 1, byte + cellFields[i].nFiles*sizeOf(cellFields[i].type));
    }

    static_assert(fills(0, 0), "cellFields lacks a member of cellState");

    //- A file of the cells
    struct cellFile
    {
        word name;
        std::size_t offset;
        fieldType type;
    };

    //- All files of the cells, in the order of the members
    static List<cellFile> cellFiles()
    {
        DynamicList<cellFile> files;

        for (const cellField& f : cellFields)
        {
            for (int d = 0; d < f.nFiles; ++d)
            {
                files.append
                ({
                    f.nFiles == 1 ? word(f.name) : word(f.name + name(d)),
                    f.offset + d*sizeOf(f.type),
                    f.type
                });
            }
        }

        return List<cellFile>(std::move(files));
    }

    //- Read a file into the states
    template<class Type>
    static void readFile
    (
        const passiveParticleCloud& c,
        const cellFile& file,
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
        const cellFile& file
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

        if (!values.write(c.size() > 0))
        {
            cannotWrite(values.objectPath());
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
    ),
    state_(state)
{
    // OpenFOAM counts from 0 again in each run and on each rank
    origId() = state.id;
    origProc() = 0;
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::List<Foam::cellState> Foam::ellipsoidParcel::read(const polyMesh& mesh)
{
    const passiveParticleCloud c(mesh, cloudName, false);
    List<cellState> cells(c.size());

    for (const cellFile& file : cellFiles())
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
    const fullPrecision digits;

    particle::writeFields(c);

    for (const cellFile& file : cellFiles())
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
