// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "checkedEntries.H"
#include "atomicWrite.H"
#include "dimensionedTypes.H"
#include "foamVersions.H"
#include "IFstream.H"
#include "masterGate.H"
#include "OSspecific.H"
#include "regExp.H"

#include <cfenv>
#include <cmath>
#include <functional>
#include <vector>

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{

//- The text of a dictionary's file; a processor reads that of the whole case
static std::string fileTextOf(const dictionary& dict)
{
    fileName file(dict.topDict().name());
    const fileName folder(file.path());
    const fileName part(folder.path());

    if (!isFile(file) && part.name().find("processor") == 0)
    {
        file = part.path()/folder.name()/file.name();
    }

    return textOf(file);
}


//- What is said of an error that ends the run elsewhere; of a pattern it names
//- neither file nor entry
static string complaintOf(const std::function<void()>& act)
{
    string complaint;
    const bool throwing = throwErrors(FatalError, true);
    try
    {
        act();
    }
    catch (const Foam::IOerror&)
    {}
    catch (const Foam::error& error)
    {
        complaint = error.message();
    }
    throwErrors(FatalError, throwing);

    return complaint;
}


//- End the run at a comma in a number: a field is read up to it, without a word
static void refuseCommas(const dictionary& dict)
{
    for (const entry& e : dict)
    {
        if (e.isDict())
        {
            refuseCommas(e.dict());
            continue;
        }
        for (const token& part : e.stream())
        {
            if (part == token::COMMA)
            {
                FatalErrorInFunction
                    << "line " << e.startLineNumber() << ": " << e.keyword()
                    << " has a comma in a number" << nl
                    << "    allowed: a point, as in 1.5" << exit(FatalError);
            }
        }
    }
}

} // End namespace Foam


// * * * * * * * * * * * * * * * Global Functions  * * * * * * * * * * * * * //

bool Foam::isNumber(const std::string& text, scalar& value)
{
    std::fenv_t before;
    std::feholdexcept(&before);
    const bool is = readScalar(text.c_str(), value) && std::isfinite(value);
    std::fesetenv(&before);

    return is;
}


const Foam::ITstream& Foam::streamOf
(
    const dictionary& dict,
    const word& keyword
)
{
    const entry& e = dict.lookupEntry(keyword, keyType::LITERAL);

    if (e.isDict())
    {
        FatalIOErrorInFunction(e.dict())
            << keyword << " is a dictionary" << nl
            << "    allowed: a value, " << keyword << " VALUE;"
            << exit(FatalIOError);
    }

    return e.stream();
}


void Foam::checkValues(const dictionary& dict, const wordList& keywords)
{
    for (const word& keyword : keywords)
    {
        if (dict.found(keyword))
        {
            streamOf(dict, keyword);
        }
    }
}


Foam::wordRes Foam::patternsOf(const dictionary& dict, const word& keyword)
{
    wordRes patterns;
    const string complaint
    (
        complaintOf([&] { dict.readIfPresent(keyword, patterns); })
    );

    if (!complaint.empty())
    {
        FatalIOErrorInFunction(streamOf(dict, keyword))
            << keyword << ": " << complaint.c_str() << exit(FatalIOError);
    }

    return patterns;
}


void Foam::checkPatterns(const std::string& text, const fileName& file)
{
    // What else is wrong is reported where the file is read, except for a number such
    // as 1e400: there it raises SIGFPE
    std::fenv_t before;
    std::feholdexcept(&before);
    const bool throwing = throwErrors(FatalIOError, true);
    const string complaint
    (
        complaintOf
        (
            [&] { refuseCommas(dictionaryOf(text, file)); }
        )
    );
    throwErrors(FatalIOError, throwing);

    const masterGate once;
    if (std::fetestexcept(FE_OVERFLOW))
    {
        dictionaryOf(text, file);
    }
    std::fesetenv(&before);
    if (!complaint.empty())
    {
        FatalErrorInFunction
            << file << ": " << complaint.c_str() << exit(FatalError);
    }
}


const Foam::dictionary& Foam::subDictOf
(
    const dictionary& dict,
    const char* keyword
)
{
    const entry* e = dict.findEntry(keyword, keyType::LITERAL);

    if (e && !e->isDict())
    {
        FatalIOErrorInFunction(e->stream())
            << keyword << " is not a dictionary" << nl
            << "    allowed: " << keyword << " { ENTRIES }"
            << exit(FatalIOError);
    }

    return e ? e->dict() : dictionary::null;
}


bool Foam::isVariable(const dictionary& dict, const word& keyword)
{
    // The mark of one that nothing need refer to
    if (keyword[0] == '_')
    {
        return true;
    }

    // Variables have no other characters
    if (!regExp("[A-Za-z0-9_-]+").match(keyword))
    {
        return false;
    }
    const std::string text(fileTextOf(dict));
    const auto has =
        [&](const std::string& before, const std::string& after)
        {
            return regExp(before + keyword + after).search(text);
        };

    // $NAME, ${NAME}, $.NAME, $:OTHER.NAME; or one that a file which is included
    // sets, for other dictionaries
    return
        has("\\$([A-Za-z0-9_{.:^]*[{.:^])?", "([^A-Za-z0-9_]|$)")
     || (
            !text.empty()
         && !has("(^|[^A-Za-z0-9_-])", "([^A-Za-z0-9_-]|$)")
         && &dict == &dict.topDict() && !dict.isDict(keyword)
        );
}


void Foam::checkKeywords
(
    const dictionary& dict,
    const wordList& allowed,
    const wordList& dictionaries
)
{
    for (const entry& e : dict)
    {
        if
        (
            e.isDict() && allowed.found(e.keyword())
         && !dictionaries.found(e.keyword())
        )
        {
            streamOf(dict, e.keyword());
        }
        if (!allowed.found(e.keyword()) && !isVariable(dict, e.keyword()))
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
        FatalIOError<< ' ' << shortText(t);
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
        return
            open ? "above " + from + ", up to " + to
          : (whole ? "whole numbers from " : "") + from + " to " + to;
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
