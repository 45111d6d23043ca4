// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "externalForce.H"
#include "checkedEntries.H"
#include "dictionary.H"
#include "masterGate.H"

// * * * * * * * * * * * * * * Static Data Members * * * * * * * * * * * * * //

namespace Foam
{
    defineTypeNameAndDebug(externalForce, 0);
    defineRunTimeSelectionTable(externalForce, dictionary);

    //- Of the shortest semi-axis, that of a difference: what it leaves out goes
    //  with its square, what it rounds with its inverse
    static const scalar differencePart = 1e-3;
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::autoPtr<Foam::externalForce> Foam::externalForce::New
(
    const dictionary& dict
)
{
    word type;
    {
        const masterGate once;

        checkValues(dict, {"type"});
        type = dict.get<word>("type");
        if (!dictionaryConstructorTablePtr_->found(type))
        {
            FatalIOErrorInFunction(streamOf(dict, "type"))
                << "unknown type of an external force " << type << nl
                << "    allowed: "
                << flatOutput(dictionaryConstructorTablePtr_->sortedToc()) << nl
                << "    others come from libraries that libs of controlDict"
                << " names" << exit(FatalIOError);
        }
    }

    return (*dictionaryConstructorTablePtr_)[type](dict);
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::wordList Foam::externalForces::names(const dictionary& forces)
{
    DynamicList<word> found;

    for (const entry& e : forces)
    {
        if (e.isDict() && e.dict().found("type"))
        {
            found.append(e.keyword());
        }
    }

    return wordList(found);
}


void Foam::externalForces::read(const dictionary& forces)
{
    for (const word& name : names(forces))
    {
        append(externalForce::New(forces.subDict(name)));
        Info<< "ellipsoidCloud: external force " << name << ": "
            << last().type() << endl;
    }
}


bool Foam::externalForces::unsteady() const
{
    bool any = false;

    for (const externalForce& one : *this)
    {
        any = any || one.unsteady();
    }

    return any;
}


void Foam::externalForces::act
(
    const externalForce::pose& at,
    vector& force,
    vector& torque
) const
{
    force = torque = Zero;

    for (const externalForce& one : *this)
    {
        one.add(at, force, torque);
    }
}


void Foam::externalForces::differentiate
(
    const externalForce::pose& at,
    tensor& ofForce,
    tensor& ofTorque
) const
{
    const scalar h = differencePart*cmptMin(at.semiAxes);

    for (direction j = 0; j < vector::nComponents; ++j)
    {
        vector force[2];
        vector torque[2];

        for (const label side : {0, 1})
        {
            vector moved(Zero);
            moved[j] = side ? h : -h;

            externalForce::pose there(at);
            there.x += moved;
            there.E += moved & at.gradE;
            act(there, force[side], torque[side]);
        }
        for (direction i = 0; i < vector::nComponents; ++i)
        {
            ofForce(i, j) = (force[1][i] - force[0][i])/(2*h);
            ofTorque(i, j) = (torque[1][i] - torque[0][i])/(2*h);
        }
    }
}
