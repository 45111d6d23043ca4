// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "electricField.H"
#include "checkedEntries.H"
#include "fvcGrad.H"
#include "masterGate.H"
#include "StringStream.H"
#include "undecomposedFlow.H"
#include "volFields.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- The entry of the section forces
    static const word keyword("electricField");

    //- Read what an entry names, or end the run; collective
    template<class FieldType>
    static autoPtr<FieldType> readField
    (
        const dictionary& dict,
        const word& entry,
        const dimensionSet& dimensions,
        const fvMesh& mesh
    )
    {
        const word name(dict.get<word>(entry));

        const word instance
        (
            mesh.time().findInstance
            (
                mesh.dbDir(), name, IOobject::READ_IF_PRESENT
            )
        );
        IOobject io(name, instance, mesh, IOobject::MUST_READ);

        const bool there =
            returnReduce(io.typeHeaderOk<FieldType>(false), andOp<bool>());
        const bool fits =
            there && io.headerClassName() == FieldType::typeName;

        autoPtr<FieldType> field;
        if (fits)
        {
            field.reset(new FieldType(io, mesh));
        }

        OStringStream fault;
        if (!there)
        {
            fault
                << "there is no such field in " << mesh.time().timeName()
                << " or before";
        }
        else if (!fits)
        {
            fault
                << (io.instance()/name).c_str() << " is a "
                << io.headerClassName() << ", not a " << FieldType::typeName;
        }
        else if (field->dimensions() != dimensions)
        {
            fault
                << (io.instance()/name).c_str() << " has the dimensions "
                << field->dimensions() << ", not " << dimensions;
        }

        const masterGate once;

        if (fault.str().size())
        {
            FatalIOErrorInFunction(streamOf(dict, entry))
                << keyword << '/' << entry << ' ' << name << ": "
                << fault.str().c_str() << exit(FatalIOError);
        }

        return field;
    }
}


// * * * * * * * * * * * * * * * Global Functions  * * * * * * * * * * * * * //

bool Foam::electricField::isNamed(const dictionary& forces)
{
    return forces.isDict(keyword);
}


void Foam::electricField::checkEntries(const dictionary& forces)
{
    const dictionary& dict = forces.subDict(keyword);

    checkKeywords(dict, {"field", "potential"});

    if (dict.size() != 1)
    {
        FatalIOErrorInFunction(dict)
            << "exactly one of field, potential must be given"
            << exit(FatalIOError);
    }

    dict.get<word>(dict.first()->keyword());
}


Foam::autoPtr<Foam::volVectorField> Foam::electricField::read
(
    const dictionary& forces,
    const fvMesh& mesh,
    const undecomposedFlow& undecomposed
)
{
    autoPtr<volVectorField> E;

    if (!isNamed(forces))
    {
        return E;
    }

    const dictionary& dict = forces.subDict(keyword);
    const dimensionSet volt(1, 2, -3, 0, 0, -1, 0);

    if (dict.found("field"))
    {
        return undecomposed.gather
        (
            *readField<volVectorField>(dict, "field", volt/dimLength, mesh)
        );
    }

    const autoPtr<volScalarField> V
    (
        undecomposed.gather
        (
            *readField<volScalarField>(dict, "potential", volt, mesh)
        )
    );

    if (Pstream::master())
    {
        const undecomposedFlow::serialScope serial;
        E.reset(new volVectorField(-fvc::grad(*V)));
    }

    return E;
}
