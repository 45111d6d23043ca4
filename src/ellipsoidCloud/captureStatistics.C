/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/
#include "captureStatistics.H"
#include "wholeFile.H"
#include "polyBoundaryMesh.H"
#include "wallPolyPatch.H"
#include "wordRes.H"
#include "OFstream.H"
#include "IOmanip.H"

#include <algorithm>
#include <cstdlib>
#include <sstream>

// * * * * * * * * * * * * * * Static Data Members * * * * * * * * * * * * * //

const Foam::Enum<Foam::captureStatistics::eventType>
Foam::captureStatistics::eventNames
({
    { eventType::injected, "injected" },
    { eventType::caught, "caught" },
    { eventType::released, "released" },
    { eventType::stalled, "stalled" },
    { eventType::escaped, "escaped" },
    { eventType::lost, "lost" }
});


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::cellState::fateType Foam::captureStatistics::fateAfter
(
    const packedEvent& event
)
{
    switch (eventType(label(event[2])))
    {
        case caught: return cellState::caught;
        case stalled: return cellState::stalled;
        case escaped: return cellState::escaped;
        case lost: return cellState::lost;
        case injected:
        case released: break;
    }

    return cellState::inFlight;
}


Foam::word Foam::captureStatistics::patchName(const label patchi) const
{
    return patchi < 0 ? word("-") : patchNames_[patchi];
}


void Foam::captureStatistics::count(const packedEvent& event)
{
    const label id(event[1]);

    if (!cells_.found(id))
    {
        cells_.insert(id, record{event, event, -1, -1, 0});
    }
    else
    {
        record& cell = cells_[id];
        --counts_[fateAfter(cell.last)];
        cell.last = event;
    }

    record& cell = cells_[id];
    ++counts_[fateAfter(event)];
    cell.deepest = event[11];

    if (fateAfter(event) == cellState::caught && cell.firstSieve < 0)
    {
        cell.firstCatch = event[0];
        cell.firstSieve = label(event[3]);
    }
}


void Foam::captureStatistics::readLog()
{
    std::ifstream log(log_.name());
    std::string line;
    std::getline(log, line);

    // What came after the time to go on from is about to be cut off
    while
    (
        scalar(log.tellg()) < log_.earlier()
     && std::getline(log, line)
    )
    {
        std::istringstream fields(line);
        std::string field;
        packedEvent event;

        forAll(event, i)
        {
            std::getline(fields, field, ',');

            event[i] =
                i == 2 ? scalar(eventNames[word(field)])
              : i == 3 ? scalar(patchNames_.find(field))
              : std::atof(field.c_str());

            if (i == 3 && event[i] < 0 && field != patchName(-1))
            {
                // Of another mesh
                fields.setstate(std::ios::failbit);
            }
        }

        if (!fields)
        {
            FatalErrorInFunction
                << log_.name() << ": cannot read the line" << nl << line.c_str()
                << exit(FatalError);
        }

        count(event);
    }
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::captureStatistics::setting::setting
(
    const dictionary& dict,
    const polyBoundaryMesh& patches
)
:
    sieves(),
    speedFraction
    (
        ellipsoidProperties::getAboveOrDefault(dict, "speedFraction", 0, 0.01)
    ),
    holdTime
    (
        ellipsoidProperties::getAboveOrDefault(dict, "holdTime", 0, 0.05)
    )
{
    ellipsoidProperties::checkKeywords
    (
        dict, {"sieves", "speedFraction", "holdTime"}
    );

    const wordRes names(dict.getOrDefault("sieves", wordRes()));

    for (const wordRe& name : names)
    {
        DynamicList<label> matched;

        forAll(patches, patchi)
        {
            if (name.match(patches[patchi].name()))
            {
                if (!isA<wallPolyPatch>(patches[patchi]))
                {
                    FatalIOErrorInFunction(dict)
                        << "sieve " << patches[patchi].name()
                        << " is not a wall"
                        << exit(FatalIOError);
                }
                matched.append(patchi);
            }
        }

        if (matched.empty())
        {
            FatalIOErrorInFunction(dict)
                << "no patch matches sieve " << name << nl
                << "    patches: " << flatOutput(patches.names())
                << exit(FatalIOError);
        }

        for (const label patchi : matched)
        {
            if (!sieves.found(patchi))
            {
                sieves.append(patchi);
            }
        }
    }
}


Foam::captureStatistics::captureStatistics
(
    const setting& given,
    const wordList& patchNames,
    const fileName& folder,
    const dictionary& earlierLog
)
:
    patchNames_(patchNames),
    sieves_(given.sieves),
    speedFraction_(given.speedFraction),
    slowSpeed_(0),
    holdTime_(given.holdTime),
    folder_(folder),
    pending_(),
    cells_(),
    counts_(Zero),
    log_
    (
        folder/"events.csv",
        "t,id,event,patch,x1,x2,x3,eps1,eps2,eps3,eta,deepest",
        12,
        earlierLog
    )
{
    if (Pstream::master() && log_.earlier() > 0)
    {
        readLog();
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::captureStatistics::note(const eventType what, const cellState& cell)
{
    packedEvent event;
    event[0] = cell.time;
    event[1] = cell.id;
    event[2] = what;
    event[3] = cell.patch;
    std::copy_n(cell.body.x, 3, event.begin() + 4);
    std::copy_n(cell.body.q, 4, event.begin() + 7);
    event[11] = cell.deepest;

    pending_.append(event);
}


void Foam::captureStatistics::judge
(
    cellState& cell,
    const scalar dt,
    const scalar meanSpeed,
    const UList<label>& touched
)
{
    if (meanSpeed >= slowSpeed_)
    {
        cell.slowTime = 0;

        if (cell.fate == cellState::caught || cell.fate == cellState::stalled)
        {
            note(released, cell);
            cell.fate = cellState::inFlight;
            cell.patch = -1;
        }
        return;
    }

    cell.slowTime += dt;

    if (cell.slowTime < holdTime_ || cell.fate == cellState::caught)
    {
        return;
    }

    for (const label patchi : touched)
    {
        if (sieves_.found(patchi))
        {
            cell.fate = cellState::caught;
            cell.patch = patchi;
            note(caught, cell);
            return;
        }
    }

    if (cell.fate != cellState::stalled)
    {
        cell.fate = cellState::stalled;
        cell.patch = touched.empty() ? -1 : touched[0];
        note(stalled, cell);
    }
}


void Foam::captureStatistics::gather()
{
    if (!returnReduce(pending_.size(), sumOp<label>()))
    {
        return;
    }

    List<List<packedEvent>> all(Pstream::nProcs());
    all[Pstream::myProcNo()] = pending_;
    pending_.clear();
    Pstream::gatherList(all);

    if (!Pstream::master())
    {
        return;
    }

    DynamicList<packedEvent> events;
    for (const List<packedEvent>& some : all)
    {
        events.append(some);
    }

    // By time and cell, whatever rank they come from
    std::stable_sort
    (
        events.begin(),
        events.end(),
        [](const packedEvent& a, const packedEvent& b)
        {
            return a[0] < b[0] || (a[0] == b[0] && a[1] < b[1]);
        }
    );

    for (const packedEvent& event : events)
    {
        count(event);

        std::ostream& os = log_.stream();

        os  << event[0] << ',' << label(event[1]) << ','
            << eventNames[eventType(label(event[2]))] << ','
            << patchName(label(event[3]));

        for (label i = 4; i < event.size(); ++i)
        {
            os << ',' << event[i];
        }
        os << '\n';
    }

    log_.flush();
}


bool Foam::captureStatistics::inside(const label id) const
{
    if (!cells_.found(id))
    {
        return false;
    }

    const cellState::fateType fate = fateAfter(cells_[id].last);

    return fate != cellState::escaped && fate != cellState::lost;
}


Foam::labelList Foam::captureStatistics::cellsInside() const
{
    DynamicList<label> ids;
    for (const label id : cells_.sortedToc())
    {
        if (inside(id))
        {
            ids.append(id);
        }
    }

    return labelList(std::move(ids));
}


void Foam::captureStatistics::report(Ostream& os) const
{
    os  << "cells: " << cells_.size() << " injected, "
        << counts_[cellState::caught] << " caught, "
        << counts_[cellState::escaped] << " escaped, "
        << counts_[cellState::stalled] << " stalled, "
        << counts_[cellState::inFlight] << " in flight, "
        << counts_[cellState::lost] << " lost";
}


void Foam::captureStatistics::update(const Map<scalar>& deepest)
{
    forAllConstIters(deepest, iter)
    {
        cells_[iter.key()].deepest = iter.val();
    }
}


Foam::scalar Foam::captureStatistics::deepest() const
{
    scalar value = 0;
    forAllConstIters(cells_, iter)
    {
        value = max(value, iter.val().deepest);
    }

    return value;
}


void Foam::captureStatistics::write(Ostream& os) const
{
    OFstream cells(folder_/"cells.csv");
    cells.precision(12);
    cells
        << "id,tInjected,x1,x2,x3,eps1,eps2,eps3,eta,fate,patch,tFate,"
        << "firstSieve,tFirstCatch,deepest" << nl;

    Map<DynamicList<scalar>> held;

    for (const label id : cells_.sortedToc())
    {
        const record& cell = cells_[id];
        const cellState::fateType fate = fateAfter(cell.last);

        cells << id << ',' << cell.injection[0];
        for (label i = 4; i < 11; ++i)
        {
            cells << ',' << cell.injection[i];
        }
        cells
            << ',' << cellState::fateNames[fate] << ','
            << patchName
               (
                   fate == cellState::inFlight ? -1 : label(cell.last[3])
               )
            << ',' << cell.last[0] << ',' << patchName(cell.firstSieve) << ',';

        if (cell.firstSieve >= 0)
        {
            cells << cell.firstCatch;
        }
        cells << ',' << cell.deepest << nl;

        if (fate == cellState::caught)
        {
            held(label(cell.last[3])).append(cell.last[0]);
        }
    }

    OFstream captures(folder_/"captures.csv");
    captures << "sieve,cells,t" << nl;

    if (sieves_.size())
    {
        os << nl << "sieve   cells   caught at [s]" << nl;
    }

    for (const label patchi : sieves_)
    {
        DynamicList<scalar> times(held.lookup(patchi, DynamicList<scalar>()));
        std::sort(times.begin(), times.end());

        std::ostringstream list;
        list.precision(4);
        for (const scalar t : times)
        {
            list << ' ' << t;
        }

        os  << setw(5) << patchNames_[patchi].c_str()
            << setw(8) << times.size() << "  " << list.str().c_str() << nl;

        captures
            << patchNames_[patchi] << ',' << times.size() << ','
            << list.str().c_str() << nl;
    }

    for (OFstream* table : {&cells, &captures})
    {
        if (!table->stdStream().flush())
        {
            cannotWrite(table->name());
        }
    }

    os << nl;
    report(os);
    os << endl;
}


// ************************************************************************* //
