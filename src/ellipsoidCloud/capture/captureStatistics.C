// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "captureStatistics.H"

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::captureStatistics::record::update(const cellState& now)
{
    centre = now.centre();
    unfolded = now.unfolded();
    deepest = now.deepest;
    deepestCell = now.deepestCell;
    imbalance = now.imbalance;
    size = now.size;
    fate = now.fate;
    patch = now.patch;
}


void Foam::captureStatistics::count(const cellEvent& event)
{
    const cellState& now = event.cell;
    const auto known = cells_.size();
    record& cell = cells_[now.id];
    const bool isNew = cells_.size() > known;

    if (isNew)
    {
        cell.planned = now.time;
    }
    else
    {
        --counts_[cell.fate];
    }
    if (isNew || event.type == "injected")
    {
        cell.injected = now.time;
        cell.start = now.centre();
        std::copy_n(now.body.q, 4, cell.startQ.begin());
    }
    cell.update(now);
    cell.time = now.time;
    ++counts_[now.fate];

    if (now.fate == cellState::caught && cell.firstSieve < 0)
    {
        cell.firstCatch = now.time;
        cell.firstSieve = now.patch;
    }
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::captureStatistics::captureStatistics
(
    const tableSet& set,
    const labelList& sieves
)
:
    set_(set),
    sieves_(sieves),
    counts_(Zero),
    log(set, "events", cellEvent::header(set), 12)
{
    log.forRows([&](const std::string& line)
    {
        cellEvent event = cellEvent();
        event.cell.size = set_.population.medianSize();

        if (!event.read(line, set_))
        {
            FatalErrorInFunction
                << log.name() << ": cannot read the line" << nl << line.c_str()
                << exit(FatalError);
        }

        count(event);
    });
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::captureStatistics::add(List<cellEvent>&& events)
{
    if (!Pstream::master() || events.empty())
    {
        return;
    }

    Foam::stableSort(events);

    for (const cellEvent& event : events)
    {
        count(event);
        event.write(log.stream(), set_);
    }

    log.flush();
}
