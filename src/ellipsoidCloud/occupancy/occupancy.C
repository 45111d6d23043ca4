// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "occupancy.H"
#include "Enum.H"
#include "surfaceFields.H"
#include "volFields.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    static const Enum<occupancy::flowType> flowNames
    ({
        {occupancy::UNCHANGED, "unchanged"},
        {occupancy::SOLVED, "solved"}
    });

    //- The entries of a state that keep a map: its ids, and of each value the
    //  vectors with which it begins, so many
    struct mapNotes
    {
        const char* ids;
        const char* vectors;
        label n;

        template<class Type>
        void write(const Map<Type>& map, dictionary& notes) const
        {
            const labelList labels(map.sortedToc());
            vectorField all(n*labels.size());
            forAll(labels, i)
            {
                const void* value = &map[labels[i]];
                std::copy_n(static_cast<const vector*>(value), n, &all[n*i]);
            }
            notes.add(ids, labels);
            notes.add(vectors, all);
        }

        template<class Type>
        void read(const dictionary& notes, Map<Type>& map) const
        {
            const labelList labels(notes.getOrDefault(ids, labelList()));
            const vectorField all(notes.getOrDefault(vectors, vectorField()));
            forAll(labels, i)
            {
                Type value = Type();
                void* first = &value;
                std::copy_n(&all[n*i], n, static_cast<vector*>(first));
                map.insert(labels[i], value);
            }
        }
    };

    static const mapNotes ofStayed = {"stayed", "stayedUnder", 2};
    static const mapNotes ofReleased = {"released", "releasedFrom", 3};
    static const mapNotes ofHeld = {"held", "heldForces", 1};
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::occupancy::setting::setting
(
    const dictionary& dict,
    const polyBoundaryMesh& patches
)
:
    active(false),
    flow(SOLVED),
    fates({cellState::caught}),
    every(checkedNumber<label>(dict, "every", atLeast(1), 1)),
    tolerance(checkedNumber(dict, "tolerance", above(0), 1e-3))
{
    checkKeywords
    (
        dict,
        {"active", "flow", "fates", "every", "tolerance", "apertures"},
        {"apertures"}
    );
    active = dict.getOrDefault("active", false);
    flow = flowNames.getOrDefault("flow", dict, SOLVED);

    if (dict.found("fates"))
    {
        fates.clear();
        for (const word& name : dict.get<wordList>("fates"))
        {
            if (name != "caught" && name != "stalled")
            {
                refuseEntry
                (
                    dict, "fates", "fates",
                    "(caught), (stalled) or (caught stalled)"
                );
            }
            fates.append(cellState::fateNames[name]);
        }
    }

    const dictionary& sections = subDictOf(dict, "apertures");
    for (const entry& e : sections)
    {
        if (!e.isDict() && isVariable(sections, e.keyword()))
        {
            continue;
        }
        const dictionary& of = subDictOf(sections, e.keyword().c_str());
        checkKeywords(of, {"min", "max", "normal", "area"});

        const boundBox box(of.get<point>("min"), of.get<point>("max"));
        const vector normal(of.get<vector>("normal"));
        const label patchi = patches.findPatchID(e.keyword());

        if ((active && patchi < 0) || box.empty() || mag(normal) < SMALL)
        {
            FatalIOErrorInFunction(of)
                << "aperture " << e.keyword() << " needs the name of a patch,"
                << " min below max and a normal" << exit(FatalIOError);
        }

        const scalar area = checkedNumber(of, "area", above(0), scalar(0));

        apertures.append(aperture{e.keyword(), patchi, box, normal, area});
    }
}


Foam::occupancy::occupancy
(
    const setting& from,
    const captureCriterion& criterion,
    const tableSet& set,
    const dictionary& notes
)
:
    setting_(from),
    criterion_(criterion),
    set_(set),
    fluxes_(set, "fluxes", "t,sieve,flux,share,cells", 9)
{
    ofHeld.read(notes, held_);
    ofReleased.read(notes, released_);
    ofStayed.read(notes, stayedUnder_);
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::occupancy::stopHeld(List<cellState>& cells) const
{
    for (cellState& cell : cells)
    {
        if (held_.found(cell.id))
        {
            std::fill_n(cell.body.u, 3, scalar(0));
            std::fill_n(cell.body.omega, 3, scalar(0));
        }
    }
}


void Foam::occupancy::release
(
    List<cellState>& cells,
    const bool all,
    DynamicList<cellEvent>& events
)
{
    DynamicList<label> loose;

    forAll(cells, i)
    {
        if (held_.found(cells[i].id) && !stays(cells[i], cells, all))
        {
            loose.append(i);
        }
    }

    // Those that stay may have lost a neighbour
    if (loose.size())
    {
        stayedUnder_.clear();
    }

    for (const label i : loose)
    {
        cellState& cell = cells[i];
        released_.set(cell.id, releasedCell{cell.centre(), held_[cell.id]});
        held_.erase(cell.id);
        outdated_ = true;
        cell.setPlace(cell.unfolded());
        cell.fate = cellState::inFlight;
        events.append(cellEvent{"released", cell});
        cell.patch = -1;
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::scalar Foam::occupancy::aperture::flux
(
    const surfaceScalarField& phi
) const
{
    const fvMesh& mesh = phi.mesh();
    const point middle(box.centre());
    scalar sum = 0;

    // Mesh faces between centres on either side of the plane in the middle
    for (label facei = 0; facei < mesh.nInternalFaces(); ++facei)
    {
        const scalar from = (mesh.C()[mesh.owner()[facei]] - middle) & normal;
        const scalar to = (mesh.C()[mesh.neighbour()[facei]] - middle) & normal;

        if ((from < 0) == (to >= 0) && box.contains(mesh.Cf()[facei]))
        {
            sum += from < 0 ? phi[facei] : -phi[facei];
        }
    }

    return sum;
}


Foam::scalar Foam::occupancy::aperture::area(const fvMesh& mesh) const
{
    // Of a mesh that rounds the corners of the device
    const scalar tolerance = 0.1;

    const scalar sum = flux(((mesh.Sf() & normal)/mag(normal))());
    const bool given = givenArea > 0;

    if (!(sum > 0) || (given && mag(sum/givenArea - 1) > tolerance))
    {
        FatalErrorInFunction
            << "aperture " << name << " of occupancy is a section of "
            << shortText(1e12*sum) << " um2 of the mesh";
        if (given)
        {
            FatalError
                << ", and not of " << shortText(1e12*givenArea);
        }
        FatalError
            << nl << "    Correct min, max and normal"
            << (given ? " or area: " : ": ")
            << "the box must reach across it, from wall to wall, and be a few"
            << " mesh cells thick"
            << exit(FatalError);
    }

    return sum;
}


void Foam::occupancy::update
(
    List<cellState>& cells,
    DynamicList<cellEvent>& events
)
{
    release(cells, false, events);

    DynamicList<label> caught;
    Map<releasedCell> near;
    for (const cellState& cell : cells)
    {
        const auto from = released_.cfind(cell.id);
        if (from.found() && mag(cell.centre() - (*from).centre) < reach())
        {
            near.insert(cell.id, *from);
        }
        if
        (
            setting_.fates.found(cell.fate) && !held_.found(cell.id)
         && criterion_.isAtRest(cell)
        )
        {
            caught.append(cell.id);
        }
    }
    released_.transfer(near);
    outdated_ = outdated_ || caught.size() >= setting_.every;

    if (outdated_)
    {
        for (const label id : caught)
        {
            held_.insert(id, heldWrench{Zero, Zero});
        }
    }
    if (!changesFlow())
    {
        stopHeld(cells);
        outdated_ = false;
    }
}


Foam::List<Foam::heldBody> Foam::occupancy::bodies
(
    const UList<cellState>& cells
) const
{
    DynamicList<heldBody> found;

    for (const cellState& cell : cells)
    {
        if (held_.found(cell.id))
        {
            found.append
            (
                heldBody
                {
                    cell.id, cell.patch, cell.centre(), rotationOf(cell.body.q),
                    pointOf(set_.population.model(cell.id).options.semi_axes)
                }
            );
        }
    }

    return List<heldBody>(std::move(found));
}


bool Foam::occupancy::setWrenches
(
    const UList<heldWrench>& wrenches,
    List<cellState>& cells
)
{
    label n = 0;
    bool same = true;

    for (cellState& cell : cells)
    {
        if (held_.found(cell.id))
        {
            heldWrench& wrench = held_[cell.id];
            const tensor R(rotationOf(cell.body.q));

            same = same && wrench.force == wrenches[n].force;
            wrench.force = wrenches[n].force;
            wrench.torque = R.T() & wrenches[n].torque;
            ++n;
        }
    }

    stopHeld(cells);
    outdated_ = false;

    return same;
}


void Foam::occupancy::write
(
    const scalar time,
    const surfaceScalarField& phi,
    const scalar inflow,
    const UList<cellState>& cells
)
{
    for (const aperture& a : setting_.apertures)
    {
        const scalar flux = a.flux(phi);
        label nHeld = 0;
        for (const cellState& cell : cells)
        {
            nHeld += held_.found(cell.id) && cell.patch == a.patch;
        }

        fluxes_.stream()
            << set_.timeText(time, 9) << ',' << csvField(a.name) << ','
            << flux << ',' << flux/max(inflow, VSMALL) << ',' << nHeld << '\n';
    }
    fluxes_.flush();
}


void Foam::occupancy::note(dictionary& notes, dictionary& tables)
{
    ofStayed.write(stayedUnder_, notes);
    ofReleased.write(released_, notes);
    ofHeld.write(held_, notes);
    tables.add("fluxes", fluxes_.notes());
}
