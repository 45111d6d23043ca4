/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/
#include "cellTracks.H"
#include "writeTracksVTP.H"
#include "Pstream.H"
#include "PstreamReduceOps.H"

#include <algorithm>
#include <cmath>

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::cellTracks::append
(
    cellState& cell,
    const scalar t,
    const ellipsoid_state& body,
    DynamicList<row>& rows
)
{
    row r;
    r[0] = t;
    r[1] = cell.id;
    std::copy_n(body.x, 3, r.begin() + 2);
    std::copy_n(body.u, 3, r.begin() + 5);
    std::copy_n(body.q, 4, r.begin() + 8);
    std::copy_n(body.omega, 3, r.begin() + 12);
    r[15] = cell.fate;
    r[16] = cell.patch;
    rows.append(r);

    cell.lastRow[0] = t;
    std::copy_n(body.x, 3, cell.lastRow + 1);
    std::copy_n(body.q, 4, cell.lastRow + 4);
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::cellTracks::setting::setting(const dictionary& dict)
:
    interval
    (
        ellipsoidProperties::getAboveOrDefault(dict, "interval", 0, 1e-3)
    ),
    heldInterval
    (
        ellipsoidProperties::getAboveOrDefault(dict, "heldInterval", 0, 0.1)
    ),
    minimumMove
    (
        ellipsoidProperties::getAboveOrDefault(dict, "minimumMove", 0, 0.01)
    )
{
    ellipsoidProperties::checkKeywords
    (
        dict, {"interval", "heldInterval", "minimumMove"}
    );
}


Foam::cellTracks::cellTracks
(
    const setting& given,
    const wordList& patchNames,
    const cellPopulation& population,
    const fileName& folder,
    const dictionary& earlier
)
:
    patchNames_(patchNames),
    setting_(given),
    population_(population),
    folder_(folder),
    rows_(),
    file_
    (
        folder/"tracks.csv",
        "t,id,x1,x2,x3,u1,u2,u3,eps1,eps2,eps3,eta,"
        "omega1,omega2,omega3,O1,O2,O3,fate,patch",
        9,
        earlier
    )
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::cellTracks::start(cellState& cell, DynamicList<row>& rows) const
{
    append(cell, cell.time, cell.body, rows);
    cell.nextRow =
        (std::floor(cell.time/setting_.interval) + 1)*setting_.interval;
}


void Foam::cellTracks::add
(
    cellState& cell,
    const ellipsoid_step& step,
    DynamicList<row>& rows
) const
{
    while (cell.nextRow <= step.end)
    {
        ellipsoid_state body;
        ellipsoid_step_state(&step, max(cell.nextRow, step.start), &body);

        scalar move = 0;
        scalar alike = 0;
        for (int d = 0; d < 3; ++d)
        {
            move += sqr(body.x[d] - cell.lastRow[1 + d]);
        }
        for (int d = 0; d < 4; ++d)
        {
            alike += body.q[d]*cell.lastRow[4 + d];
        }

        // |q1.q2| is the cosine of half the angle between two poses
        const scalar turn = 2*sqrt(max(1 - sqr(alike), scalar(0)));

        // Held cells may go on spinning: rarely is often enough
        const bool due =
            cell.fate == cellState::inFlight
         || cell.nextRow - cell.lastRow[0]
          > setting_.heldInterval - 0.5*setting_.interval;

        const bool moved =
            move > sqr(setting_.minimumMove*population_.longest(cell.id))
         || turn > setting_.minimumMove;

        if (due && moved)
        {
            append(cell, cell.nextRow, body, rows);
        }

        cell.nextRow =
            (std::floor(cell.nextRow/setting_.interval + 0.5) + 1)
           *setting_.interval;
    }
}


void Foam::cellTracks::finish(cellState& cell, DynamicList<row>& rows) const
{
    if (cell.time - cell.lastRow[0] > 1e-6*setting_.interval)
    {
        append(cell, cell.time, cell.body, rows);
    }
}


void Foam::cellTracks::flush()
{
    List<List<row>> all(Pstream::nProcs());
    all[Pstream::myProcNo()] = rows_;
    rows_.clear();
    Pstream::gatherList(all);

    if (!Pstream::master())
    {
        return;
    }

    DynamicList<row> rows;
    for (const List<row>& some : all)
    {
        rows.append(some);
    }

    std::sort
    (
        rows.begin(),
        rows.end(),
        [](const row& a, const row& b)
        {
            return a[0] < b[0] || (a[0] == b[0] && a[1] < b[1]);
        }
    );

    std::ostream& os = file_.stream();

    for (const row& r : rows)
    {
        os << r[0] << ',' << label(r[1]);

        for (label i = 2; i < 15; ++i)
        {
            os << ',' << r[i];
        }

        const vector O(longAxis(&r[8]));
        const label patchi(r[16]);

        os  << ',' << O.x() << ',' << O.y() << ',' << O.z()
            << ',' << cellState::fateNames[cellState::fateType(label(r[15]))]
            << ',' << (patchi < 0 ? "-" : patchNames_[patchi].c_str())
            << '\n';
    }

    file_.flush();
}


void Foam::cellTracks::writeVTP() const
{
    writeTracksVTP(file_.name(), folder_/"tracks.vtp");
}


// ************************************************************************* //
