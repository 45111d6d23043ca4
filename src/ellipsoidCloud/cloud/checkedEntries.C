/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/

#include "checkedEntries.H"
#include "dimensionedTypes.H"

// * * * * * * * * * * * * * * * Global Functions  * * * * * * * * * * * * * //

void Foam::checkKeywords
(
    const dictionary& dict,
    const wordList& allowed
)
{
    for (const entry& e : dict)
    {
        // _NAME is a variable for other entries
        if (!allowed.found(e.keyword()) && e.keyword()[0] != '_')
        {
            FatalIOErrorInFunction(dict)
                << "unknown keyword " << e.keyword();

            if (e.startLineNumber() > 0)
            {
                FatalIOError<< " (line " << e.startLineNumber() << ")";
            }

            FatalIOError<< nl
                << "    allowed: " << flatOutput(allowed)
                << exit(FatalIOError);
        }
    }
}


void Foam::refuseEntry
(
    const dictionary& dict,
    const word& keyword,
    const string& name,
    const string& range
)
{
    const ITstream& is = streamOf(dict, keyword);

    FatalIOErrorInFunction(is) << name.c_str();

    // With fewer digits than files have
    for (const token& t : static_cast<const tokenList&>(is))
    {
        FatalIOError<< ' ' << shortText(t).c_str();
    }

    FatalIOError
        << " is out of range" << nl
        << "    allowed: " << range.c_str() << exit(FatalIOError);
}


Foam::string Foam::entryRange::text(const bool whole) const
{
    const string from(whole ? Foam::name(label(low)) : Foam::name(low));

    if (high < VGREAT)
    {
        const string to(whole ? Foam::name(label(high)) : Foam::name(high));
        return (whole ? "whole numbers from " : "") + from + " to " + to;
    }

    return
        open ? "above " + from
      : (whole ? "a whole number, " : "") + from + " or more";
}


bool Foam::hasUnit
(
    const dictionary& dict,
    const word& keyword,
    const string& name,
    const word& unit
)
{
    static const HashTable<dimensionSet> units
    ({
        {"", dimless},
        {"C", dimCurrent*dimTime},
        {"C m", dimCurrent*dimTime*dimLength},
        {"K", dimTemperature},
        {"N", dimForce},
        {"N m", dimForce*dimLength},
        {"Pa", dimPressure},
        {"V/m", dimForce/(dimCurrent*dimTime)},
        {"kg/m3", dimDensity},
        {"m", dimLength},
        {"m/s", dimVelocity},
        {"m/s2", dimAcceleration},
        {"m2/s", dimViscosity},
        {"s", dimTime},
        {"s/m", dimless/dimVelocity}
    });
    ITstream is(dict.lookup(keyword));

    if (is.empty() || is.first() != token::BEGIN_SQR)
    {
        return false;
    }

    const dimensionSet& expected = units[unit];
    dimensionSet given(dimless);
    is >> given;

    if (given != expected)
    {
        refuseEntry
        (
            dict,
            keyword,
            name,
            (unit.empty() ? "no unit" : unit) + ", the dimensions "
          + shortText(expected)
        );
    }

    return true;
}


// ************************************************************************* //
