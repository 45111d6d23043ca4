// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

/*---------------------------------------------------------------------------*\
Description
    Which cells enter, and when; and what of that a restart goes on with.

\*---------------------------------------------------------------------------*/

#include "ellipsoidCloud.H"
#include "checkedEntries.H"
#include "masterGate.H"
#include "OSspecific.H"
#include "SHA1.H"
#include "volFields.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- Take into a digest when a cell enters
    static void addEntry(SHA1& digest, const Tuple2<scalar, label>& cell)
    {
        const scalar numbers[2] = {cell.first(), scalar(cell.second())};
        const void* bytes = numbers;
        digest.append(static_cast<const char*>(bytes), sizeof(numbers));
    }
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::ellipsoidCloud::makeInjections
(
    const label firstId,
    const bool hasFlow
)
{
    const dictionary& dict = properties_.subDict("injection");
    const scalar runStart = readScalar(firstTime_);
    label nextId = firstId;
    SHA1 digest;

    if (dict.empty())
    {
        const masterGate once;
        FatalIOErrorInFunction(dict)
            << "injection holds no injection: give one a name and a dictionary"
            << exit(FatalIOError);
    }

    injections_.clear();
    for (const entry& e : dict)
    {
        if (!e.isDict())
        {
            continue;
        }
        const cellInjection::setting from
        {
            e.dict(), *undecomposed_, *domain_, population_, nextId,
            runStart, hasFlow
        };

        injections_.append(cellInjection::New(from).ptr());
        {
            const masterGate once;
            injections_.last().check();
        }
        nextId += injections_.last().size();

        for (const Tuple2<scalar, label>& cell : injections_.last().times())
        {
            addEntry(digest, cell);
        }
    }

    plan_.clear();
    plan_.add("first", firstId);
    plan_.add("next", nextId);
    plan_.add("digest", string(digest.str()));
}


void Foam::ellipsoidCloud::planEntries()
{
    if (!earlier_.found())
    {
        makeInjections(0, true);
        return;
    }

    const dictionary& then = earlier_.notes().subDict("plan");
    makeInjections(then.get<label>("first"), true);

    // An id that has been given is not given again
    if (plan_.get<string>("digest") != then.get<string>("digest"))
    {
        const label nextId = then.get<label>("next");
        makeInjections(nextId, true);

        Warning
            << "By seed and injections other cells enter, or at other times,"
            << " than in the run so far: those that have entered stay, those"
            << " to come are drawn anew, with numbers from " << nextId << " on"
            << nl << endl;
    }
}


void Foam::ellipsoidCloud::reportCells(const scalar inflow) const
{
    const scalarList all(entries(-VGREAT, VGREAT));
    const scalar end = mesh_.time().endTime().value();
    const scalarList now(entries(time_, end));

    Info<< "ellipsoidCloud: " << all.size() << " cells to enter by "
        << flatOutput(properties_.subDict("injection").toc()) << nl
        << "case: " << now.size() << " cells enter in the run from " << time_
        << " to " << end << " s" << endl;

    const fileName tables(statistics_->log.name().path().path());
    scalar begun = time_;
    for (const fileName& other : readDir(tables, fileName::DIRECTORY))
    {
        scalar start;
        if (isNumber(other, start))
        {
            begun = min(begun, start);
        }
    }
    if (!earlier_.found() && begun < time_)
    {
        Warning
            << "There is no state of " << time_ << " s: cells begin anew,"
            << " without those of the run from " << begun << " s, whose tables"
            << " stay in " << tables.c_str() << nl << endl;
    }

    // Of those that are there and those to come
    scalar first = min(now);
    for (const cellState& cell : cells_)
    {
        first = min(first, cell.planned);
    }
    if
    (
        first < end && criterion_.holdTime() > end - first
     && criterion_.sieves().size()
    )
    {
        Warning
            << "holdTime " << criterion_.holdTime() << " s is longer than from"
            << " the first cell, at " << first << " s, to the end: no cell can"
            << " be caught until " << end << " s" << nl << endl;
    }

    // What comes with them, or what is there if they come faster than it leaves
    const scalar there = gSum(mesh_.V().field());
    scalar cells = 0;
    for (const cellInjection& injection : injections_)
    {
        cells += injection.volume();
    }
    const scalar part = cells/max(there, inflow*(max(all) - min(all)));

    if (part > 0.01)
    {
        Warning
            << "The cells fill " << word::printf("%.2g", 100*part)
            << " % of the fluid that they enter with: above 1 % they change"
            << " the flow, which the model leaves out" << nl << endl;
    }
}


Foam::scalarList Foam::ellipsoidCloud::entries
(
    const scalar start,
    const scalar end
) const
{
    DynamicList<scalar> times;
    for (const cellInjection& injection : injections_)
    {
        for (const Tuple2<scalar, label>& cell : injection.times())
        {
            if (cell.first() >= start && cell.first() < end)
            {
                times.append(cell.first());
            }
        }
    }

    return scalarList(std::move(times));
}


void Foam::ellipsoidCloud::checkTimes() const
{
    const scalar end = mesh_.time().endTime().value();
    const scalarList all(entries(-VGREAT, VGREAT));

    if (earlier_.found() || entries(time_, end).size())
    {
        return;
    }

    const masterGate once;
    FatalIOErrorInFunction(properties_.subDict("injection"))
        << "no cell enters while the run lasts, from "
        << shortText(time_) << " to "
        << shortText(end) << " s: "
        << (
               all.empty()
             ? string("none is to enter at any time")
             : "they are to enter from " + shortText(min(all)) + " to "
             + shortText(max(all)) + " s"
           ).c_str()
        << nl
        << "    Correct start of the injections, or startTime and endTime"
        << " of controlDict" << exit(FatalIOError);
}


void Foam::ellipsoidCloud::addNew(const scalar start, const scalar end)
{
    DynamicList<cellState> newCells;

    for (const cellInjection& injection : injections_)
    {
        injection.append(start, end, newCells);
    }

    for (const cellState& cell : newCells)
    {
        population_.add(cell.id, cell.size);
    }
    cells_.append(newCells);
    Foam::sort(cells_);
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::ellipsoidCloud::checkInjections(const solverFields& flow)
{
    undecomposed_->gather(flow);

    makeDomain();
    makeInjections(0, false);

    bool known = true;
    for (const entry& e : properties_.subDict("injection"))
    {
        known = known && !(e.isDict() && e.dict().found("concentration"));
    }
    if (known)
    {
        checkTimes();
    }
    injections_.clear();
}
