// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "captureMap.H"
#include "appendedFile.H"
#include "IOmanip.H"
#include "atomicWrite.H"

#include <algorithm>

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::label Foam::captureMap::kindOf(const label id) const
{
    const independentCells::ending& end = starts_[id].end;

    return end.fate == cellState::caught ? end.patch : -1 - end.fate;
}


Foam::word Foam::captureMap::kindName(const label kind) const
{
    return
        kind == anySieve_ ? word("anySieve")
      : kind == noRoom_ ? word("noRoom")
      : kind >= 0 ? cells_.patchNames()[kind]
      : word(cellState::fateNames[cellState::fateType(-1 - kind)]);
}


Foam::labelList Foam::captureMap::kinds() const
{
    labelList all(cells_.sieves());

    for
    (
        const cellState::fateType fate :
        {
            cellState::escaped, cellState::stalled, cellState::inFlight,
            cellState::lost
        }
    )
    {
        all.append(-1 - fate);
    }

    return all;
}


Foam::captureMap::part Foam::captureMap::partOf
(
    const label pose,
    const label kind,
    const bool byInflow
) const
{
    // Of what is asked for and of the rest: what is so for sure, at most, and
    // by the corners
    struct { scalar least, most, likely; } sums[2] = {};

    forAll(squares_, i)
    {
        if (pose >= 0 && squares_[i].at.pose != pose)
        {
            continue;
        }

        const scalar amount = byInflow ? shares_[i].inflow : shares_[i].area;
        const DynamicList<label> ids(on(squares_[i]));
        FixedList<label, 2> n(Zero);
        FixedList<label, 2> nCorners(Zero);

        forAll(ids, k)
        {
            const label found = kindOf(ids[k]);

            // What has no room does not enter
            if (found != noRoom_ || kind == noRoom_)
            {
                const bool other =
                    kind == anySieve_ ? found < 0 : found != kind;

                ++n[other];
                nCorners[other] += k < 4;
            }
        }

        for (label other = 0; other < 2; ++other)
        {
            sums[other].least += n[other] == ids.size() ? amount : 0;
            sums[other].most += n[other] ? amount : 0;
            sums[other].likely += 0.25*nCorners[other]*amount;
        }
    }

    const auto share =
        [](const scalar its, const scalar others)
        {
            return its/max(its + others, VSMALL);
        };

    return part
    {
        share(sums[0].likely, sums[1].likely),
        share(sums[0].least, sums[1].most),
        share(sums[0].most, sums[1].least)
    };
}


void Foam::captureMap::writeStarts(std::ostream& os) const
{
    os << "id,level,x1,x2,x3,orientation,fate,touched" << '\n';

    forAll(starts_, id)
    {
        const start& one = starts_[id];
        const label touched = one.end.touched;

        os  << id << ',' << one.level << commas{one.x.v_, 3};
        const word name(touched < 0 ? word("-") : cells_.patchNames()[touched]);
        os  << ',' << one.at.pose << ','
            << csvField(kindName(kindOf(id))) << ','
            << csvField(name) << '\n';
    }
}


void Foam::captureMap::writePoses(std::ostream& os) const
{
    os << "orientation,name,eps1,eps2,eps3,eta,O1,O2,O3" << '\n';

    forAll(from_.poses, p)
    {
        const scalar* q = from_.poses[p].q;
        os  << p << ',' << csvField(from_.poses[p].name) << commas{q, 4}
            << commas{longAxis(q).v_, 3} << '\n';
    }
}


void Foam::captureMap::writeSquares(std::ostream& os) const
{
    os << "orientation,level,x1,x2,x3,width,height,area,inflow,fate" << '\n';

    forAll(squares_, i)
    {
        const square& one = squares_[i];
        const labelHashSet found(kindsOn(one));
        const inletPlane::window w(windowOf(one));
        const point x(plane_.position(0.5*(w.s0 + w.s1), 0.5*(w.t0 + w.t1)));
        const word kind
        (
            found.size() > 1 ? word("mixed") : kindName(*found.begin())
        );

        os  << one.at.pose << ',' << one.level << commas{x.v_, 3}
            << ',' << w.s1 - w.s0 << ',' << w.t1 - w.t0
            << ',' << shares_[i].area << ',' << shares_[i].inflow << ','
            << csvField(kind) << '\n';
    }
}


void Foam::captureMap::writeSummary(std::ostream& os) const
{
    labelList all(kinds());
    all.append(anySieve_);
    all.append(noRoom_);

    os << "orientation,fate,inflow,inflowLow,inflowHigh,area,areaLow,areaHigh"
       << '\n';

    for (label p = -1; p < from_.poses.size(); ++p)
    {
        for (const label kind : all)
        {
            const word name(p < 0 ? word("all") : from_.poses[p].name);
            os  << csvField(name) << ','
                << csvField(kindName(kind));

            for (const bool byInflow : {true, false})
            {
                const part found(partOf(p, kind, byInflow));
                os  << ',' << found.likely << ',' << found.low
                    << ',' << found.high;
            }
            os << '\n';
        }
    }
}


void Foam::captureMap::report(Ostream& os) const
{
    label finest = 0;
    for (const square& one : squares_)
    {
        finest = max(finest, one.level);
    }
    const inletPlane::window w(windowOf(square{node{0, 0, 0}, finest}));

    os  << nl << "capture map: " << from_.poses.size() << " orientations, "
        << starts_.size() << " starts, " << nFollowed_ << " cells followed"
        << nl << squares_.size() << " squares, the smallest "
        << 1e6*w.s1 << " x " << 1e6*w.t1 << " um" << nl;

    if (bounded_)
    {
        os << "mostCells kept some squares from being divided" << nl;
    }

    os  << nl << "Of the cells that enter with the flow, in %, with bounds"
        << nl;

    labelList shown(kinds());
    shown.append(anySieve_);
    for (const label kind : shown)
    {
        const part found(partOf(-1, kind, true));
        os  << setw(10) << kindName(kind).c_str() << "  "
            << word::printf("%7.3f", 100*found.likely).c_str()
            << word::printf("  (%.3f", 100*found.low).c_str()
            << word::printf(" to %.3f)", 100*found.high).c_str() << nl;
    }
    os << endl;
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::captureMap::write(const fileName& folder) const
{
    const auto write =
        [&](const word& name, void (captureMap::*contents)(std::ostream&) const)
        {
            atomicWrite
            (
                folder/name,
                [&](std::ostream& os)
                {
                    os.precision(12);
                    (this->*contents)(os);
                }
            );
        };

    write("map.csv", &captureMap::writeStarts);
    write("orientations.csv", &captureMap::writePoses);
    write("squares.csv", &captureMap::writeSquares);
    write("summary.csv", &captureMap::writeSummary);
    report(Info);
}
