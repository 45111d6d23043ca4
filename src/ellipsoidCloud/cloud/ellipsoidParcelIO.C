/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/
#include "ellipsoidParcel.H"
#include "IOstreams.H"
#include "IOField.H"
#include "atomicWrite.H"

#include <algorithm>
#include <cstddef>

// * * * * * * * * * * * * * * Static Data Members * * * * * * * * * * * * * //

namespace Foam
{
    defineTemplateTypeNameAndDebug(Cloud<ellipsoidParcel>, 0);
}

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
    //- A member of cellState: scalars, or a label where there are none
    struct cellStateMember
    {
        const char* name;
        std::size_t offset;
        int nScalars;
    };

    //- Every member once: all reading and writing goes by this list
    static const cellStateMember members[] =
    {
        { "U", offsetof(cellState, body.u), 3 },
        { "x", offsetof(cellState, body.x), 3 },
        { "omega", offsetof(cellState, body.omega), 3 },
        { "q", offsetof(cellState, body.q), 4 },
        { "step", offsetof(cellState, controller.step), 1 },
        { "previousError", offsetof(cellState, controller.previous_error), 1 },
        { "time", offsetof(cellState, time), 1 },
        { "planned", offsetof(cellState, planned), 1 },
        { "slowTime", offsetof(cellState, slowTime), 1 },
        { "imbalance", offsetof(cellState, imbalance), 1 },
        { "nextRow", offsetof(cellState, nextRow), 1 },
        { "lastRow", offsetof(cellState, lastRow), 8 },
        { "deepest", offsetof(cellState, deepest), 1 },
        { "deepestCell", offsetof(cellState, deepestCell), 1 },
        { "length", offsetof(cellState, length), 1 },
        { "width", offsetof(cellState, width), 1 },
        { "id", offsetof(cellState, id), 0 },
        { "tet", offsetof(cellState, tet), 0 },
        { "fate", offsetof(cellState, fate), 0 },
        { "patch", offsetof(cellState, patch), 0 }
    };

    //- The member of a state
    template<class Type>
    static Type* at(cellState& s, const cellStateMember& m)
    {
        return reinterpret_cast<Type*>(reinterpret_cast<char*>(&s) + m.offset);
    }

    //- Read a field and hand its values out
    template<class Type, class Set>
    static void readField
    (
        Cloud<ellipsoidParcel>& c,
        const word& name,
        const Set& set
    )
    {
        IOField<Type> values
        (
            c.fieldIOobject(name, IOobject::MUST_READ), c.size() > 0
        );
        c.checkFieldIOobject(c, values);

        label i = 0;
        for (ellipsoidParcel& p : c)
        {
            set(p.state(), values[i++]);
        }
    }

    //- Collect the values of a field and write it
    template<class Type, class Get>
    static void writeField
    (
        const Cloud<ellipsoidParcel>& c,
        const word& name,
        const Get& get
    )
    {
        IOField<Type> values
        (
            c.fieldIOobject(name, IOobject::NO_READ), c.size()
        );

        label i = 0;
        for (const ellipsoidParcel& p : c)
        {
            cellState s(p.state());
            values[i++] = get(s);
        }

        if (!values.write(c.size() > 0))
        {
            cannotWrite(values.objectPath());
        }
    }

    //- Name of a component: the member's own where there is one only
    static word componentName(const cellStateMember& m, const int d)
    {
        return m.nScalars == 1 ? word(m.name) : word(m.name + Foam::name(d));
    }
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::ellipsoidParcel::ellipsoidParcel
(
    const polyMesh& mesh,
    Istream& is,
    bool readFields,
    bool newFormat
)
:
    particle(mesh, is, readFields, newFormat),
    state_()
{
    if (readFields)
    {
        for (const cellStateMember& m : members)
        {
            for (int d = 0; d < m.nScalars; ++d)
            {
                is >> at<scalar>(state_, m)[d];
            }

            if (!m.nScalars)
            {
                is >> *at<label>(state_, m);
            }
        }
    }

    is.check(FUNCTION_NAME);
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::ellipsoidParcel::readFields(Cloud<ellipsoidParcel>& c)
{
    particle::readFields(c);

    for (const cellStateMember& m : members)
    {
        if (!m.nScalars)
        {
            readField<label>
            (
                c, m.name,
                [&](cellState& s, const label v) { *at<label>(s, m) = v; }
            );
        }
        else if (m.nScalars == 3)
        {
            readField<vector>
            (
                c, m.name,
                [&](cellState& s, const vector& v)
                {
                    std::copy_n(v.v_, 3, at<scalar>(s, m));
                }
            );
        }
        else
        {
            for (int d = 0; d < m.nScalars; ++d)
            {
                readField<scalar>
                (
                    c, componentName(m, d),
                    [&](cellState& s, const scalar v)
                    {
                        at<scalar>(s, m)[d] = v;
                    }
                );
            }
        }
    }
}


void Foam::ellipsoidParcel::writeFields(const Cloud<ellipsoidParcel>& c)
{
    const fullPrecision digits;

    particle::writeFields(c);

    for (const cellStateMember& m : members)
    {
        if (!m.nScalars)
        {
            writeField<label>
            (
                c, m.name, [&](cellState& s) { return *at<label>(s, m); }
            );
        }
        else if (m.nScalars == 3)
        {
            writeField<vector>
            (
                c, m.name,
                [&](cellState& s)
                {
                    const scalar* v = at<scalar>(s, m);
                    return vector(v[0], v[1], v[2]);
                }
            );
        }
        else
        {
            for (int d = 0; d < m.nScalars; ++d)
            {
                writeField<scalar>
                (
                    c, componentName(m, d),
                    [&](cellState& s) { return at<scalar>(s, m)[d]; }
                );
            }
        }
    }
}


// * * * * * * * * * * * * * * * IOstream Operators  * * * * * * * * * * * * //

Foam::Ostream& Foam::operator<<(Ostream& os, const ellipsoidParcel& p)
{
    os << static_cast<const particle&>(p);

    cellState state(p.state_);

    for (const cellStateMember& m : members)
    {
        for (int d = 0; d < m.nScalars; ++d)
        {
            os << token::SPACE << at<scalar>(state, m)[d];
        }

        if (!m.nScalars)
        {
            os << token::SPACE << *at<label>(state, m);
        }
    }

    os.check(FUNCTION_NAME);
    return os;
}


// ************************************************************************* //
