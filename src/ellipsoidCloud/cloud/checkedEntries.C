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
#include "IFstream.H"

#include <vector>

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


void Foam::refuseRepeated(const fileName& file)
{
    IFstream is(file);
    token t;

    // Lines of the entries in each block that is open, and tokens of the present
    // entry, with the depth of lists or braces in its value
    std::vector<HashTable<label>> blocks(1);
    label nTokens = 0;
    label depth = 0;

    while (is.read(t).good() && t.good())
    {
        const bool opens = t == token::BEGIN_LIST || t == token::BEGIN_BLOCK;
        const bool closes = t == token::END_LIST || t == token::END_BLOCK;

        if (depth > 0 || (opens && nTokens != 1) || t == token::BEGIN_LIST)
        {
            depth += opens - closes;
        }
        else if (opens)
        {
            blocks.emplace_back();
            nTokens = 0;
        }
        else if (closes || t == token::END_STATEMENT)
        {
            blocks.resize(max(std::size_t(1), blocks.size() - closes));
            nTokens = 0;
        }
        else if (nTokens++ == 0 && (t.isWord() || t.isString()))
        {
            const string key(t.isWord() ? t.wordToken() : t.stringToken());

            // Of #if and #else one is read
            if (key.find("#if") == 0)
            {
                return;
            }
            if (key[0] == '#')
            {
                std::string rest;
                is.getLine(rest);
                nTokens = 0;
            }
            else if
            (
                blocks.size() > 1 && key[0] != '$'
             && !blocks.back().insert(key, t.lineNumber())
            )
            {
                FatalIOErrorInFunction(is)
                    << key.c_str() << " stands twice in one block, at lines "
                    << blocks.back()[key] << " and " << t.lineNumber() << nl
                    << "    OpenFOAM makes one entry of them: remove one, or"
                    << " give it a name of its own" << exit(FatalIOError);
            }
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
