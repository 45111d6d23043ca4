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

Foam::HashTable<Foam::wordList>& Foam::cellInjection::keywords()
{
    // Made when the first type is added, before main()
    static HashTable<wordList> table;

    return table;
}


void Foam::cellInjection::newCell::check(const ellipsoid_status status) const
{
    if (status != ELLIPSOID_OK)
    {
        FatalErrorInFunction
            << "cell " << id << " cannot enter at " << pointOf(x) << ": "
            << ellipsoid_status_text(status) << exit(FatalError);
    }
}


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
    check
    (
        flow.sample(x, there, false, sample)
      ? ELLIPSOID_FLOW_FAILED : ELLIPSOID_OK
    );
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
    check(ellipsoid_overlaps_walls(&model, &around, x, q, &cuts));

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

    // Where the core cannot tell, another pose is drawn
    return
        ellipsoid_contact_evaluate
        (
            &model, &around, &pose, &cache, &contact, nullptr
        )
     || contact.touching_beads;
}


Foam::cellInjection::newCell Foam::cellInjection::drawn
(
    const Tuple2<scalar, label>& planned
) const
{
    newCell cell;
    cell.time = planned.first();
    cell.id = planned.second();

    const label maxAttempts = isRandom() ? 1000 : 1;
    const ellipsoid_model model
    (
        from_.population.made(from_.population.drawn(cell.id))
    );

    for (label attempt = 0; attempt < maxAttempts; ++attempt)
    {
        scalar uniform[6];
        ellipsoid_random_uniform
        (
            from_.seed, cell.id, rsPose, attempt, 6, uniform
        );

        const point x(position(cell.id - firstId_, pointOf(uniform)));
        const bool inside = from_.flow.find(x, cell.at);
        std::copy_n(x.v_, 3, cell.x);

        orientation_.set(uniform + 3, cell.q);
        orientation(cell.id - firstId_, cell.q);

        if (inside && !cell.overlaps(model, from_.flow, from_.walls))
        {
            return cell;
        }
    }

    OStringStream x;
    x.precision(6);
    x << pointOf(cell.x);

    FatalIOErrorInFunction(dict_)
        << "cell " << cell.id << " of injection " << dict_.dictName()
        << " at " << x.str().c_str()
        << " lies outside the mesh or overlaps a wall" << nl
        << "    " << maxAttempts << " position(s) tried"
        << exit(FatalIOError);

    return cell;
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
        ellipsoid_random_uniform
        (
            from_.seed, firstId_ + i, rsTime, 0, 1, &uniform
        );

        times_[i].first() = start + duration*uniform;
        times_[i].second() = firstId_ + i;
    }

    sort(times_);
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
    from_(from)
{}


Foam::autoPtr<Foam::cellInjection> Foam::cellInjection::New
(
    const dictionary& dict,
    const setting& from,
    const label firstId
)
{
    checkEntries(dict);

    return (*dictionaryConstructorTablePtr_)[dict.get<word>("type")]
    (
        dict, from, firstId
    );
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::cellInjection::checkEntries(const dictionary& dict)
{
    const word type(dict.get<word>("type"));

    if (!keywords().found(type))
    {
        FatalIOErrorInFunction
        (
            dict.lookupEntry("type", keyType::LITERAL).stream()
        )   << "unknown injection type " << type << nl
            << "    allowed: " << flatOutput(keywords().sortedToc())
            << exit(FatalIOError);
    }

    wordList allowed
    ({
        "type", "start", "duration",
        "orientation", "axis", "quaternion", "eulerAngles"
    });
    allowed.append(keywords()[type]);
    ellipsoidProperties::checkKeywords(dict, allowed);
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


void Foam::cellInjection::check() const
{
    if (!isRandom())
    {
        for (const Tuple2<scalar, label>& cell : times_)
        {
            drawn(cell);
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
    for
    (
        auto next = std::lower_bound
        (
            times_.begin(),
            times_.end(),
            Tuple2<scalar, label>(start, labelMin)
        );
        next != times_.end() && next->first() < end;
        ++next
    )
    {
        cells.append(drawn(*next));
    }
}


// ************************************************************************* //
