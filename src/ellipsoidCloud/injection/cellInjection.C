// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "cellInjection.H"
#include "cellSurroundings.H"
#include "mathematicalConstants.H"
#include "polyMesh.H"
#include "Switch.H"

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


const Foam::polyMesh& Foam::cellInjection::mesh() const
{
    return refCast<const polyMesh>(from_.population.properties().db());
}


Foam::string Foam::cellInjection::overlap
(
    const cellState& cell,
    const ellipsoid_model& m
) const
{
    const cellSurroundings around
    (
        from_.domain, meshFlow::probe{cell.tet, -1}
    );
    ellipsoid_model model(m);
    ellipsoid_contact contact;
    model.options.contact = 1;
    model.options.contact_shape = ELLIPSOID_CONTACT_ELLIPSOID;

    // Of the ellipsoid; else beads stand out of it
    for (const bool beads : {false, true})
    {
        facetCache cache(m);
        const ellipsoid_status status = ellipsoid_contact_evaluate
        (
            beads ? &m : &model, &around, &cell.body, cache, &contact, nullptr
        );

        if (status == ELLIPSOID_OK && contact.surface_count)
        {
            return
                " overlaps a wall, "
              + mesh().boundaryMesh()[contact.surface[0]].name() + ", by "
              + shortText(contact.deepest) + " m";
        }
    }

    return " overlaps a wall";
}


Foam::cellState Foam::cellInjection::drawn
(
    const Tuple2<scalar, label>& planned
) const
{
    cellState cell = cellState();
    cell.id = planned.second();

    cell.size = sizeOf(cell.id - from_.firstId);

    const label seed = from_.population.properties().seed();
    const label maxAttempts = isRandom() ? 1000 : 1;
    const ellipsoid_model model
    (
        cellPopulation::modelOf(from_.population.optionsOf(cell.size))
    );
    bool inside = false;

    for (label attempt = 0; attempt < maxAttempts; ++attempt)
    {
        scalar uniform[6];
        ellipsoid_random_uniform(seed, cell.id, rsPose, attempt, 6, uniform);

        const point x(position(cell.id - from_.firstId, pointOf(uniform)));
        std::copy_n(x.v_, 3, cell.body.x);
        orientation_.set(uniform + 3, cell.body.q);
        orientation(cell.id - from_.firstId, cell.body.q);

        meshFlow::probe at;
        inside = from_.domain.flow.find(x, at);
        cell.tet = at.tet;

        if (inside && !overlaps(cell, model, from_.domain))
        {
            wait(cell, planned.first(), from_.domain.flow);
            return cell;
        }
    }

    const string outside
    (
        " lies outside the mesh, which reaches from "
      + shortText(mesh().bounds().min()) + " to "
      + shortText(mesh().bounds().max()) + " m"
    );

    FatalIOErrorInFunction(from_.dict)
        << "cell " << cell.id << " of injection " << from_.dict.dictName()
        << " at " << shortText(cell.centre())
        << (inside ? overlap(cell, model) : outside).c_str() << nl
        << "    " << maxAttempts << " position(s) tried, this the last"
        << exit(FatalIOError);

    return cell;
}


// * * * * * * * * * * * * Protected Member Functions  * * * * * * * * * * * //

void Foam::cellInjection::setTimes(const label number)
{
    const dictionary& dict = from_.dict;

    const scalar start =
        dict.getOrDefault<scalar>("start", 0)
      + (
            dict.getOrDefault("relativeStart", Switch(false))
          ? from_.runStart
          : 0
        );
    const scalar duration = checkedNumber(dict, "duration", atLeast(0), 0.0);
    const label seed = from_.population.properties().seed();
    times_.setSize(number);

    if (number > 1000000)
    {
        Warning
            << "injection " << dict.dictName() << " makes " << number
            << " cells: is concentration in 1/m3, rate in 1/s?" << nl << endl;
    }

    forAll(times_, i)
    {
        scalar uniform;
        ellipsoid_random_uniform
        (
            seed, from_.firstId + i, rsTime, 0, 1, &uniform
        );

        times_[i].first() = start + duration*uniform;
        times_[i].second() = from_.firstId + i;
    }

    sort(times_);
}


Foam::label Foam::cellInjection::readNumber(const scalar flux) const
{
    const dictionary& dict = from_.dict;
    const label nGiven =
        dict.found("number") + dict.found("rate") + dict.found("concentration");

    const auto read =
        [&](const char* entry)
        {
            return checkedNumber<scalar>(dict, entry, above(0));
        };

    if (nGiven != 1 || (dict.found("concentration") && flux <= 0))
    {
        FatalIOErrorInFunction(dict)
            << "injection " << dict.dictName() << " needs exactly one of "
            << "number, rate and, at a patch with steady inflow, concentration"
            << exit(FatalIOError);
    }

    if (dict.found("number"))
    {
        return checkedNumber<label>(dict, "number", atLeast(1));
    }

    const scalar duration = read("duration");
    const scalar rate =
        dict.found("rate") ? read("rate") : read("concentration")*flux;

    if (!from_.hasFlow && dict.found("concentration"))
    {
        return 1;
    }
    const scalar number = rate*duration;

    if (!(number >= 0.5 && number < 1e8))
    {
        FatalIOErrorInFunction(dict)
            << "injection " << dict.dictName() << " makes " << number
            << " cells" << nl << "    allowed: 1 to 1e8"
            << exit(FatalIOError);
    }

    return label(number + 0.5);
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::cellInjection::cellInjection(const setting& from)
:
    orientation_(from.dict),
    from_(from)
{}


Foam::autoPtr<Foam::cellInjection> Foam::cellInjection::New(const setting& from)
{
    checkEntries(from.dict);

    const word type(from.dict.get<word>("type"));

    return (*dictionaryConstructorTablePtr_)[type](from);
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::cellInjection::checkEntries(const dictionary& dict)
{
    checkValues(dict, {"type"});
    const word type(dict.get<word>("type"));

    if (!keywords().found(type))
    {
        FatalIOErrorInFunction(streamOf(dict, "type"))
            << "unknown injection type " << type << nl
            << "    allowed: " << flatOutput(keywords().sortedToc())
            << exit(FatalIOError);
    }

    wordList allowed
    ({
        "type", "start", "relativeStart", "duration",
        "orientation", "axis", "quaternion", "eulerAngles"
    });
    allowed.append(keywords()[type]);
    checkKeywords(dict, allowed);
}


void Foam::cellInjection::checkPatch
(
    const dictionary& dict,
    const polyBoundaryMesh& patches
)
{
    const word patch(dict.get<word>("patch"));

    if (patches.findPatchID(patch) < 0)
    {
        FatalIOErrorInFunction(streamOf(dict, "patch"))
            << "no patch " << patch << " in the mesh" << nl
            << "    patches: " << flatOutput(patches.names())
            << exit(FatalIOError);
    }
}


Foam::scalar Foam::cellInjection::volume() const
{
    const label n = min(size(), label(1000));
    scalar sum = 0;
    for (label i = 0; i < n; ++i)
    {
        const auto options = from_.population.optionsOf(sizeOf(i));
        const scalar* a = options.semi_axes;
        sum += 4.0/3.0*constant::mathematical::pi*a[0]*a[1]*a[2];
    }

    return sum*size()/max(n, label(1));
}


void Foam::cellInjection::check() const
{
    for (const Tuple2<scalar, label>& cell : times_)
    {
        drawn(cell);

        // Where the first finds no place, hardly any other will
        if (isRandom())
        {
            return;
        }
    }
}


void Foam::cellInjection::wait
(
    cellState& cell,
    const scalar time,
    const meshFlow& flow
)
{
    cell.time = time;
    cell.planned = time;
    cell.nextRow = -GREAT;
    cell.fate = cellState::waiting;
    cell.patch = -1;

    meshFlow::probe at{cell.tet, -1};
    tetCoordinates c;
    flow.reach(cell.centre(), at, c);
    std::copy_n(flow.velocity(time, c).v_, 3, cell.body.u);
}


bool Foam::cellInjection::overlaps
(
    const cellState& cell,
    const ellipsoid_model& model,
    const cellDomain& domain
)
{
    const cellSurroundings around(domain, meshFlow::probe{cell.tet, -1});
    const ellipsoid_state& pose = cell.body;

    int cuts = 0;

    // Where the core cannot tell, another pose is drawn
    if
    (
        ellipsoid_overlaps_walls(&model, &around, pose.x, pose.q, &cuts)
     || cuts
    )
    {
        return true;
    }
    if (!model.options.contact)
    {
        return false;
    }

    // Beads may stand out of the ellipsoid
    facetCache cache(model);
    ellipsoid_contact contact;

    // To touch, whatever rounding says, is not to overlap, but adhesion may pull
    // without
    return
        ellipsoid_contact_evaluate
        (
            &model, &around, &pose, cache, &contact, nullptr
        )
     || (
            contact.bead_contacts
         && (
                contact.deepest <= 0
             || contact.deepest > 1e-9*model.options.bead_radius
            )
        );
}


void Foam::cellInjection::append
(
    const scalar start,
    const scalar end,
    DynamicList<cellState>& cells
) const
{
    const Tuple2<scalar, label> first(start, labelMin);
    auto next = std::lower_bound(times_.begin(), times_.end(), first);

    for (; next != times_.end() && next->first() < end; ++next)
    {
        cells.append(drawn(*next));
    }
}
