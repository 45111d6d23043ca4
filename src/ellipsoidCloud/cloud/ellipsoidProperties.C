/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/
#include "ellipsoidProperties.H"
#include "cellTracks.H"
#include "masterGate.H"
#include "readViscosity.H"
#include "StringStream.H"
#include "captureCriterion.H"
#include "cellInjection.H"
#include "cellPopulation.H"
#include "dimensionedScalar.H"
#include "emptyPolyPatch.H"
#include "processorPolyPatch.H"
#include "stringListOps.H"
#include "wedgePolyPatch.H"
#include "Time.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- A value as one would write it
    template<class Type>
    static string textOf(const Type& value)
    {
        OStringStream text;
        text.precision(6);
        text << value;
        return text.str();
    }
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::ellipsoidProperties::checkUnreached
(
    const polyBoundaryMesh& patches
) const
{
    const wordRes unreached(getOrDefault("unreached", wordRes()));
    DynamicList<word> impassable;

    for (const polyPatch& pp : patches)
    {
        if
        (
            !polyPatch::constraintType(pp.type())
         || isA<processorPolyPatch>(pp)
        )
        {
            continue;
        }

        impassable.append(pp.name());

        if (!unreached.match(pp.name()))
        {
            FatalIOErrorInFunction(*this)
                << "patch " << pp.name() << " of "
                << patches.mesh().meshDir()/"boundary"
                << " is of type " << pp.type() << nl
                << "    A cell that came to it could not go on. Make it a "
                << "wall (type wall) or an open end (type patch); or, if no "
                << "cell comes there, say so: unreached (" << pp.name()
                << ");" << exit(FatalIOError);
        }
    }

    for (const wordRe& name : unreached)
    {
        if (findStrings(name, impassable).empty())
        {
            FatalIOErrorInFunction(*this)
                << "unreached " << name << " matches no patch that cells "
                << "cannot pass" << nl
                << "    patches of such types: " << flatOutput(impassable)
                << exit(FatalIOError);
        }
    }
}


void Foam::ellipsoidProperties::checkPatches
(
    const polyBoundaryMesh& patches
) const
{
    for (const polyPatch& pp : patches)
    {
        if (isA<emptyPolyPatch>(pp) || isA<wedgePolyPatch>(pp))
        {
            FatalErrorInFunction
                << "patch " << pp.name() << " of "
                << patches.mesh().meshDir()/"boundary"
                << " is of type " << pp.type() << nl
                << "    A cell is a body in three dimensions: its mesh has "
                << "walls (type wall) and open ends (type patch)"
                << exit(FatalError);
        }
    }

    checkUnreached(patches);

    const dictionary& injections = subDict("injection");

    for (const entry& e : injections)
    {
        if (!e.isDict())
        {
            FatalIOErrorInFunction(injections)
                << e.keyword() << " is not a dictionary of an injection"
                << exit(FatalIOError);
        }

        cellInjection::checkEntries(e.dict());

        if (e.dict().found("patch"))
        {
            cellInjection::findPatch(e.dict(), patches);
        }
    }

    captureCriterion(section("capture"), patches);
    cellTracks::setting(section("tracks"));
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::ellipsoidProperties::ellipsoidProperties(const polyMesh& mesh)
:
    IOdictionary
    (
        IOobject
        (
            "ellipsoidCloudProperties",
            mesh.time().constant(),
            mesh,
            IOobject::MUST_READ,
            IOobject::NO_WRITE
        )
    ),
    options_(ellipsoid_options_default()),
    scheme_(frozenFlow::stCellPoint),
    seed_(1),
    pushing_(true),
    empty_()
{
    options_.kinematic_viscosity = readViscosity(mesh).value();

    // No reading of files, for which ranks would have to meet, from here on
    const masterGate once;

    scheme_ =
        frozenFlow::schemeNames.getOrDefault("interpolation", *this, scheme_);
    seed_ = getOrDefault<label>("seed", seed_);

    readOptions();
    checkOptions();
    cellPopulation::setting(section("cell"), options_);
    checkPatches(mesh.boundaryMesh());
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

ellipsoid_model Foam::ellipsoidProperties::model() const
{
    ellipsoid_model made = ellipsoid_model();

    if (ellipsoid_model_init(&made, &options_) != ELLIPSOID_OK)
    {
        FatalIOErrorInFunction(*this)
            << "the options are not those that were checked"
            << abort(FatalIOError);
    }

    return made;
}


void Foam::ellipsoidProperties::checkKeywords
(
    const dictionary& dict,
    const wordList& allowed
)
{
    for (const entry& e : dict)
    {
        if (!allowed.found(e.keyword()))
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


void Foam::ellipsoidProperties::refuse
(
    const dictionary& dict,
    const word& keyword,
    const string& name,
    const string& range
)
{
    const ITstream& is = dict.lookupEntry(keyword, keyType::LITERAL).stream();

    FatalIOErrorInFunction(is) << name.c_str();

    // With fewer digits than files have
    for (const token& t : static_cast<const tokenList&>(is))
    {
        FatalIOError<< ' ' << textOf(t).c_str();
    }

    FatalIOError
        << " is out of range" << nl
        << "    allowed: " << range.c_str() << exit(FatalIOError);
}


Foam::scalar Foam::ellipsoidProperties::getAbove
(
    const dictionary& dict,
    const word& keyword,
    const scalar bound
)
{
    const scalar value = dict.get<scalar>(keyword);

    if (!(value > bound && value < VGREAT))
    {
        refuse(dict, keyword, keyword, "above " + textOf(bound));
    }

    return value;
}


Foam::label Foam::ellipsoidProperties::getWhole
(
    const dictionary& dict,
    const word& keyword,
    const label least
)
{
    const label value = dict.get<label>(keyword);

    if (value < least)
    {
        refuse
        (
            dict, keyword, keyword,
            "a whole number, " + textOf(least) + " or more"
        );
    }

    return value;
}


Foam::label Foam::ellipsoidProperties::getWholeOrDefault
(
    const dictionary& dict,
    const word& keyword,
    const label least,
    const label deflt
)
{
    return dict.found(keyword) ? getWhole(dict, keyword, least) : deflt;
}


Foam::scalar Foam::ellipsoidProperties::getAboveOrDefault
(
    const dictionary& dict,
    const word& keyword,
    const scalar bound,
    const scalar deflt
)
{
    return dict.found(keyword) ? getAbove(dict, keyword, bound) : deflt;
}


Foam::scalar Foam::ellipsoidProperties::getWithinOrDefault
(
    const dictionary& dict,
    const word& keyword,
    const scalar low,
    const scalar high,
    const scalar deflt
)
{
    const scalar value = dict.getOrDefault<scalar>(keyword, deflt);

    if (!(value >= low && value <= high))
    {
        refuse
        (
            dict, keyword, keyword,
            Foam::name(low) + " to " + Foam::name(high)
        );
    }

    return value;
}


Foam::label Foam::ellipsoidProperties::getWholeWithinOrDefault
(
    const dictionary& dict,
    const word& keyword,
    const label least,
    const label largest,
    const label deflt
)
{
    const label value = dict.getOrDefault(keyword, deflt);

    if (value < least || value > largest)
    {
        refuse
        (
            dict, keyword, keyword,
            "whole numbers from " + Foam::name(least) + " to "
          + Foam::name(largest)
        );
    }

    return value;
}


// ************************************************************************* //
