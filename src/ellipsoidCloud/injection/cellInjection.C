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
#include "StringStream.H"
#include "polyBoundaryMesh.H"

#include <algorithm>

// * * * * * * * * * * * * * * Static Data Members * * * * * * * * * * * * * //

namespace Foam
{
    defineTypeNameAndDebug(cellInjection, 0);
    defineRunTimeSelectionTable(cellInjection, dictionary);
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::cellState Foam::cellInjection::newCell::state
(
    const frozenFlow& flow,
    const cellSize& size
) const
{
    cellState state = cellState();
    std::copy_n(x, 3, state.body.x);
    std::copy_n(q, 4, state.body.q);
    state.time = time;
    state.planned = time;
    state.id = id;
    state.tet = at.tet;
    state.fate = cellState::waiting;
    state.patch = -1;
    state.length = size.length;
    state.width = size.width;

    ellipsoid_flow_sample sample;
    frozenFlow::probe there(at);
    flow.sample(x, there, false, sample);
    std::copy_n(sample.velocity, 3, state.body.u);

    return state;
}


bool Foam::cellInjection::newCell::overlaps
(
    const ellipsoid_model& model,
    const frozenFlow& flow,
    const wallFacets& walls
) const
{
    cellSurroundings here(flow, walls, at);
    const ellipsoid_surroundings around(here.core());

    int cuts = 0;
    ellipsoid_overlaps_walls(&model, &around, x, q, &cuts);

    if (cuts || !model.options.contact)
    {
        return cuts;
    }

    // Beads may stand out of the ellipsoid
    ellipsoid_state pose = {};
    std::copy_n(x, 3, pose.x);
    std::copy_n(q, 4, pose.q);

    ellipsoid_facet_cache cache;
    ellipsoid_contact contact;
    ellipsoid_facet_cache_clear(&cache);

    return
        ellipsoid_contact_evaluate
        (
            &model, &around, &pose, &cache, &contact, nullptr
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

        orientation_.set(uniform + 3, cell.q);
        orientation(cell.id - firstId_, cell.q);

        if (inside && !cell.overlaps(model, flow_, walls_))
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
    orientation_(dict),
    firstId_(firstId),
    times_(),
    dict_(dict),
    flow_(from.flow),
    walls_(from.walls),
    population_(from.population),
    seed_(from.seed)
{}


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


void Foam::cellInjection::drawOrientation
(
    const cellOrientation& orientation,
    const label seed,
    const label id,
    scalar q[4]
)
{
    scalar uniform[6];
    ellipsoid_random_uniform(seed, id, rsPose, 0, 6, uniform);
    orientation.set(uniform + 3, q);
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
