/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/
#include "cellInjection.H"
#include "cellSurroundings.H"
#include "unitConversion.H"
#include "StringStream.H"
#include "polyBoundaryMesh.H"

#include <algorithm>

// * * * * * * * * * * * * * * Static Data Members * * * * * * * * * * * * * //

namespace Foam
{
    defineTypeNameAndDebug(cellInjection, 0);
    defineRunTimeSelectionTable(cellInjection, dictionary);
}

const Foam::Enum<Foam::cellInjection::orientationType>
Foam::cellInjection::orientationNames_
({
    { orientationType::otRandom, "random" },
    { orientationType::otAligned, "aligned" },
    { orientationType::otQuaternion, "quaternion" },
    { orientationType::otEuler, "euler" }
});


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::cellInjection::readOrientation()
{
    switch (orientation_)
    {
        case otRandom:
        {
            break;
        }
        case otAligned:
        {
            const vector axis(dict_.get<vector>("axis"));

            if (!(mag(axis) > VSMALL))
            {
                FatalIOErrorInFunction(dict_)
                    << "axis " << axis << " has no direction"
                    << exit(FatalIOError);
            }

            ellipsoid_quaternion_from_axis((axis/mag(axis)).v_, 0, q_);
            break;
        }
        case otQuaternion:
        {
            setQuaternion(dict_.get<FixedList<scalar, 4>>("quaternion"), q_);
            break;
        }
        case otEuler:
        {
            const vector degrees(dict_.get<vector>("eulerAngles"));
            const vector radians(degrees*degToRad());

            ellipsoid_quaternion_from_euler(radians.v_, q_);
            break;
        }
    }
}


bool Foam::cellInjection::overlaps
(
    const newCell& cell,
    const ellipsoid_model& model
) const
{
    cellSurroundings here(flow_, walls_, cell.at);
    const ellipsoid_surroundings around(here.core());

    int cuts = 0;
    ellipsoid_overlaps_walls(&model, &around, cell.x, cell.q, &cuts);

    if (cuts || !model.options.contact)
    {
        return cuts;
    }

    // Beads may stand out of the ellipsoid
    ellipsoid_state state = {};
    std::copy_n(cell.x, 3, state.x);
    std::copy_n(cell.q, 4, state.q);

    ellipsoid_contact_cache cache;
    ellipsoid_contact contact;
    ellipsoid_contact_cache_clear(&cache);

    return
        ellipsoid_contact_evaluate
        (
            &model, &around, &state, &cache, &contact, nullptr
        )
     || contact.touching_beads;
}


void Foam::cellInjection::draw(newCell& cell) const
{
    const label maxAttempts = drawn() ? 1000 : 1;
    const ellipsoid_model model
    (
        population_.made(population_.drawn(cell.id))
    );

    for (label attempt = 0; attempt < maxAttempts; ++attempt)
    {
        scalar uniform[6];
        ellipsoid_random_uniform
        (
            seed_, cell.id, rsPose, attempt, 6, uniform
        );

        point x(Zero);
        const bool inside = position(cell.id - firstId_, uniform, x, cell.at);
        std::copy_n(x.v_, 3, cell.x);

        if (orientation_ == otRandom)
        {
            ellipsoid_quaternion_from_uniform(uniform + 3, cell.q);
        }
        else
        {
            std::copy_n(q_, 4, cell.q);
        }
        orientation(cell.id - firstId_, cell.q);

        if (inside && !overlaps(cell, model))
        {
            return;
        }
    }

    OStringStream x;
    x.precision(6);
    x << point(cell.x[0], cell.x[1], cell.x[2]);

    FatalIOErrorInFunction(dict_)
        << "cell " << cell.id << " of injection " << dict_.dictName()
        << " at " << x.str().c_str() << " lies outside the mesh or overlaps a wall" << nl
        << "    " << maxAttempts << " position(s) tried"
        << exit(FatalIOError);
}


// * * * * * * * * * * * * Protected Member Functions  * * * * * * * * * * * //

void Foam::cellInjection::setQuaternion
(
    const FixedList<scalar, 4>& given,
    scalar q[4]
) const
{
    scalar sum = 0;
    for (const scalar component : given)
    {
        sum += sqr(component);
    }

    if (!(mag(sqrt(sum) - 1) < 1e-3))
    {
        FatalIOErrorInFunction(dict_)
            << "quaternion " << given << " is not of length 1"
            << exit(FatalIOError);
    }

    for (int d = 0; d < 4; ++d)
    {
        q[d] = given[d]/sqrt(sum);
    }
}


void Foam::cellInjection::setTimes(const label number)
{
    const scalar start = dict_.getOrDefault<scalar>("start", 0);
    const scalar duration = dict_.getOrDefault<scalar>("duration", 0);

    if (!(duration >= 0 && duration < VGREAT))
    {
        ellipsoidProperties::refuse
        (
            dict_, "duration", "duration", "0 or more"
        );
    }

    times_.setSize(number);

    forAll(times_, i)
    {
        scalar uniform;
        ellipsoid_random_uniform(seed_, firstId_ + i, rsTime, 0, 1, &uniform);

        times_[i].first() = start + duration*uniform;
        times_[i].second() = firstId_ + i;
    }

    std::sort
    (
        times_.begin(),
        times_.end(),
        [](const Tuple2<scalar, label>& a, const Tuple2<scalar, label>& b)
        {
            return
                a.first() < b.first()
             || (a.first() == b.first() && a.second() < b.second());
        }
    );
}


Foam::label Foam::cellInjection::readNumber(const scalar flux) const
{
    const label nGiven =
        label(dict_.found("number"))
      + label(dict_.found("rate"))
      + label(dict_.found("concentration"));

    if (nGiven != 1 || (dict_.found("concentration") && flux <= 0))
    {
        FatalIOErrorInFunction(dict_)
            << "injection " << dict_.dictName() << " needs exactly one of "
            << "number, rate and, at a patch with inflow, concentration"
            << exit(FatalIOError);
    }

    if (dict_.found("number"))
    {
        return ellipsoidProperties::getWhole(dict_, "number", 1);
    }

    const scalar duration =
        ellipsoidProperties::getAbove(dict_, "duration", 0);

    const scalar rate =
        dict_.found("rate")
      ? ellipsoidProperties::getAbove(dict_, "rate", 0)
      : ellipsoidProperties::getAbove(dict_, "concentration", 0)*flux;

    const scalar number = rate*duration;

    if (!(number >= 0.5 && number < 1e8))
    {
        FatalIOErrorInFunction(dict_)
            << "injection " << dict_.dictName() << " makes " << number
            << " cells" << nl << "    allowed: 1 to 1e8"
            << exit(FatalIOError);
    }

    return label(number + 0.5);
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::cellInjection::cellInjection
(
    const dictionary& dict,
    const setting& from,
    const label firstId
)
:
    orientation_(orientationNames_.getOrDefault("orientation", dict, otRandom)),
    q_{0, 0, 0, 1},
    firstId_(firstId),
    times_(),
    dict_(dict),
    flow_(from.flow),
    walls_(from.walls),
    population_(from.population),
    seed_(from.seed)
{
    readOrientation();
}


void Foam::cellInjection::checkEntries(const dictionary& dict)
{
    const word type(dict.get<word>("type"));

    if (!dictionaryConstructorTablePtr_->found(type))
    {
        FatalIOErrorInFunction
        (
            dict.lookupEntry("type", keyType::LITERAL).stream()
        )   << "unknown injection type " << type << nl
            << "    allowed: "
            << flatOutput(dictionaryConstructorTablePtr_->sortedToc())
            << exit(FatalIOError);
    }

    // Those of all injections, of a number, and of each type
    static const wordList common
    ({
        "type", "start", "duration",
        "orientation", "axis", "quaternion", "eulerAngles"
    });
    static const HashTable<wordList> more
    ({
        {"patch", {"number", "rate", "concentration", "patch"}},
        {"box", {"number", "rate", "min", "max"}},
        {"positions", {"positions", "orientations"}}
    });

    if (more.found(type))
    {
        wordList allowed(common);
        allowed.append(more[type]);
        ellipsoidProperties::checkKeywords(dict, allowed);
    }
}


Foam::word Foam::cellInjection::findPatch
(
    const dictionary& dict,
    const polyBoundaryMesh& patches
)
{
    const word patch(dict.get<word>("patch"));

    if (patches.findPatchID(patch) < 0)
    {
        FatalIOErrorInFunction
        (
            dict.lookupEntry("patch", keyType::LITERAL).stream()
        )   << "no patch " << patch << " in the mesh" << nl
            << "    patches: " << flatOutput(patches.names())
            << exit(FatalIOError);
    }

    return patch;
}


Foam::autoPtr<Foam::cellInjection> Foam::cellInjection::New
(
    const dictionary& dict,
    const setting& from,
    const label firstId
)
{
    checkEntries(dict);

    const auto found =
        dictionaryConstructorTablePtr_->cfind(dict.get<word>("type"));

    return (*found)(dict, from, firstId);
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::cellInjection::check() const
{
    if (!drawn())
    {
        for (const Tuple2<scalar, label>& time : times_)
        {
            newCell cell;
            cell.id = time.second();
            draw(cell);
        }
    }
}


void Foam::cellInjection::append
(
    const scalar start,
    const scalar end,
    DynamicList<newCell>& cells
) const
{
    auto next = std::lower_bound
    (
        times_.begin(),
        times_.end(),
        start,
        [](const Tuple2<scalar, label>& a, const scalar t)
        {
            return a.first() < t;
        }
    );

    for (; next != times_.end() && next->first() < end; ++next)
    {
        newCell cell;
        cell.time = next->first();
        cell.id = next->second();
        draw(cell);
        cells.append(cell);
    }
}


// ************************************************************************* //
