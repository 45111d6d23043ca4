// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "cellTracks.H"
#include "atomicWrite.H"
#include "fromRanks.H"
#include "ListOps.H"
#include "stringOps.H"
#include "vtkPolyData.H"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- The fields of a line
    typedef decltype(stringOps::split(std::string(), ',')) csvLine;

    //- The cell of a line
    static label idOf(const std::string& line)
    {
        return std::atol(line.c_str() + line.find(',') + 1);
    }

    //- The text of a number of tracks.vtp, of which positions come first, in a
    //  line. The name of a patch, before what is unfolded, may have commas
    static std::string fieldOf(const csvLine& line, const label i)
    {
        return line
        [
            i < 3 ? i + 2 : i < 5 ? i - 3 : i < 18 ? i : line.size() - 25 + i
        ].str();
    }

    //- Append a row of a cell, which is there at that time
    static void append
    (
        cellState& cell,
        const scalar t,
        const cellState& there,
        DynamicList<cellTracks::row>& rows
    )
    {
        const ellipsoid_state& body = there.body;
        rows.append
        ({
            t, body, there.unfolded(), cell.id, cell.fate, cell.patch
        });

        cell.lastRow[0] = t;
        std::copy_n(body.x, 3, cell.lastRow + 1);
        std::copy_n(body.q, 4, cell.lastRow + 4);
    }
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::cellTracks::setting::setting(const dictionary& dict)
:
    interval(checkedNumber(dict, "interval", above(0), 1e-3)),
    heldInterval(checkedNumber(dict, "heldInterval", above(0), 0.1)),
    minimumMove(checkedNumber(dict, "minimumMove", above(0), 0.01))
{
    checkKeywords(dict, {"interval", "heldInterval", "minimumMove"});
}


Foam::cellTracks::cellTracks(const tableSet& set)
:
    set_(set),
    setting_(set.population.properties().section("tracks")),
    file
    (
        set,
        "tracks",
        "t,id,x1,x2,x3,u1,u2,u3,eps1,eps2,eps3,eta,"
        "omega1,omega2,omega3,O1,O2,O3,fate,patch"
      + std::string(set.unfolds ? ",x1Unfolded,x2Unfolded,x3Unfolded" : ""),
        9
    )
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::cellTracks::start(cellState& cell, DynamicList<row>& rows) const
{
    append(cell, cell.time, cell, rows);
    cell.nextRow =
        (std::floor(cell.time/setting_.interval) + 1)*setting_.interval;
}


void Foam::cellTracks::add
(
    cellState& cell,
    const ellipsoid_step& step,
    const meshFlow& flow,
    const label tet,
    DynamicList<row>& rows
) const
{
    const ellipsoid_options& options = set_.population.model(cell.id).options;
    const scalar longest = longestSemiAxis(options);

    // A pose within the step, put where it is in the mesh
    const auto at =
        [&](const ellipsoid_state& body)
        {
            cellState there(cell);
            there.body = body;
            if (set_.unfolds)
            {
                isometry image;
                meshFlow::probe from{tet, -1};
                flow.locate(pointOf(body.x), from, &image);
                there.pass(image, options.semi_axes);
            }
            return there;
        };

    while (cell.nextRow <= step.end)
    {
        ellipsoid_state inStep;
        ellipsoid_step_state(&step, max(cell.nextRow, step.start), &inStep);
        const cellState there(at(inStep));
        const ellipsoid_state& body = there.body;

        const scalar move = magSqr(pointOf(body.x) - pointOf(cell.lastRow + 1));
        const scalar alike = std::inner_product
        (
            body.q, body.q + 4, cell.lastRow + 4, scalar(0)
        );

        // |q1.q2| is the cosine of half the angle between two poses
        const scalar turn = 2*sqrt(max(1 - sqr(alike), scalar(0)));

        // Held cells may go on spinning: rarely is often enough
        const bool due =
            cell.fate == cellState::inFlight
         || cell.nextRow - cell.lastRow[0]
          > setting_.heldInterval - 0.5*setting_.interval;

        const bool moved =
            move > sqr(setting_.minimumMove*longest)
         || turn > setting_.minimumMove;

        if (due && moved)
        {
            append(cell, cell.nextRow, there, rows);
        }

        cell.nextRow =
            (std::floor(cell.nextRow/setting_.interval + 0.5) + 1)
           *setting_.interval;
    }

    if (set_.unfolds)
    {
        cell.unfold = at(step.after).unfold;
    }
}


void Foam::cellTracks::finish(cellState& cell, DynamicList<row>& rows) const
{
    if (cell.time - cell.lastRow[0] > 1e-6*setting_.interval)
    {
        append(cell, cell.time, cell, rows);
    }
}


void Foam::cellTracks::flush(const scalar until)
{
    // Those that are due go to the end of the list
    const auto due = std::partition
    (
        rows_.begin(), rows_.end(),
        [&](const row& r) { return !(r.time < until); }
    );
    const label nKept = due - rows_.begin();
    List<row> rows
    (
        joined(SubList<row>(rows_, rows_.size() - nKept, nKept))
    );
    rows_.setSize(nKept);

    if (!Pstream::master())
    {
        return;
    }

    Foam::sort(rows);

    for (const row& r : rows)
    {
        const ellipsoid_state& body = r.body;

        file.stream()
            << set_.timeText(r.time, 9) << ',' << r.id << commas{body.x, 3}
            << commas{body.u, 3} << commas{body.q, 4} << commas{body.omega, 3}
            << commas{longAxis(body.q).v_, 3}
            << ',' << cellState::fateNames[cellState::fateType(r.fate)]
            << ',' << set_.patchName(r.patch)
            << commas{r.unfolded.v_, set_.unfolds ? 3 : 0} << '\n';
    }

    file.flush();
}


void Foam::cellTracks::writeVTP
(
    const std::function<cellSize(const label)>& sizeOf
) const
{
    List<vtkArray> arrays
    ({
        {"Float64", "x", 3},
        {"Float64", "t", 1},
        {"Int32", "id", 1},
        {"Float64", "U", 3},
        {"Float64", "quaternion", 4},
        {"Float64", "omega", 3},
        {"Float64", "O", 3},
        {"Int32", "fate", 1},
        {"Float64", "semiAxes", 3},
        {"Float64", "unfolded", 3}
    });
    if (!set_.unfolds)
    {
        arrays.setSize(9);
    }

    const auto writeNumbers = [&](std::ostream& os, label first, label n)
    {
        file.forRows([&](const std::string& text)
        {
            const csvLine line(stringOps::split(text, ','));

            for (label i = first; i < first + n; ++i)
            {
                if (i == 18)
                {
                    os << cellState::fateNames[line[18].str()];
                }
                else if (i > 18 && i < 22)
                {
                    const cellSize size(sizeOf(idOf(text)));
                    os << set_.population.optionsOf(size).semi_axes[i - 19];
                }
                else
                {
                    os << fieldOf(line, i);
                }
                os << (i + 1 < first + n ? ' ' : '\n');
            }
        });
    };

    // The rows cell by cell
    DynamicList<label> ids;
    file.forRows([&](const std::string& text) { ids.append(idOf(text)); });

    labelList rows;
    sortedOrder(ids, rows);
    DynamicList<label> ends;

    forAll(rows, i)
    {
        if (i + 1 == rows.size() || ids[rows[i]] != ids[rows[i + 1]])
        {
            ends.append(i + 1);
        }
    }

    atomicWrite(set_.folder/"tracks.vtp", [&](std::ostream& os)
    {
        os.precision(9);
        writePolyData(os, arrays, writeNumbers, "Lines", rows, ends);
    });
}
