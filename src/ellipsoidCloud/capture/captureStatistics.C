// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "captureStatistics.H"

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::captureStatistics::count(const cellEvent& event)
{
    const cellState& now = event.cell;

    if (!cells_.insert(now.id, record{now, now, now.time, -1, -1}))
    {
        --counts_[cells_[now.id].last.fate];
    }

    record& cell = cells_[now.id];
    cell.last = now;
    ++counts_[now.fate];

    if (event.type == "injected")
    {
        cell.injection = now;
    }
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
    std::istringstream lines(log.text());
    std::string line;
    std::getline(lines, line);

    while (std::getline(lines, line))
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
    }
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
