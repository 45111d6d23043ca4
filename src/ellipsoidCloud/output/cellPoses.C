// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "cellPoses.H"
#include "atomicWrite.H"
#include "checkedEntries.H"
#include "diagTensor.H"
#include "masterGate.H"
#include "OSspecific.H"
#include "vtkPolyData.H"

#include <algorithm>
#include <map>
#include <sstream>

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- Write the file of one time
    static void writeCells
    (
        std::ostream& os,
        const tableSet& set,
        const UList<cellState>& cells
    )
    {
        os.precision(9);

        const List<vtkArray> arrays
        ({
            {"Float64", "x", 3},
            {"Int32", "id", 1},
            {"Int32", "fate", 1},
            {"Int32", "patch", 1},
            {"Float64", "U", 3},
            {"Float64", "omega", 3},
            {"Float64", "axes", 9}
        });
        const labelList points(identity(cells.size()));
        const labelList ends(identity(cells.size(), 1));

        const auto writeNumbers = [&](std::ostream& to, label first, label n)
        {
            for (const cellState& cell : cells)
            {
                const ellipsoid_state& body = cell.body;
                scalar row[21];
                scalar* at = std::copy_n(body.x, 3, row);
                for (const label i : {cell.id, cell.fate, cell.patch})
                {
                    *at++ = i;
                }
                at = std::copy_n(body.u, 3, at);
                at = std::copy_n(body.omega, 3, at);
                std::copy_n(fullAxes(cell, set.population).v_, 9, at);

                for (label i = 0; i < n; ++i)
                {
                    to << row[first + i] << (i + 1 < n ? ' ' : '\n');
                }
            }
        };

        writePolyData(os, arrays, writeNumbers, "Verts", points, ends);
    }

    //- The files of a folder by their times
    static std::map<scalar, word> posesIn(const fileName& folder)
    {
        std::map<scalar, word> times;
        for (const fileName& file : readDir(folder, fileName::FILE))
        {
            scalar time;
            if (file.hasExt("vtp") && isNumber(file.lessExt(), time))
            {
                times[time] = file;
            }
        }

        return times;
    }

    //- Write the series of the files in a folder
    static void writeSeries(const fileName& folder)
    {
        std::ostringstream os;
        os  << vtkProlog
            << "<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n";
        for (const auto& time : posesIn(folder))
        {
            os  << "<DataSet timestep=\"" << time.second.lessExt().c_str()
                << "\" file=\"" << folder.name().c_str() << '/'
                << time.second.c_str() << "\"/>\n";
        }
        os << "</Collection>\n</VTKFile>\n";

        atomicWrite(folder + ".pvd", os.str());
    }
}


// * * * * * * * * * * * * * * * Global Functions  * * * * * * * * * * * * * //

Foam::tensor Foam::fullAxes
(
    const cellState& cell,
    const cellPopulation& population
)
{
    const double* a = population.model(cell.id).options.semi_axes;
    const tensor R(rotationOf(cell.body.q));

    return R & diagTensor(2*a[0], 2*a[1], 2*a[2]) & R.T();
}


void Foam::writePoses
(
    const tableSet& set,
    const UList<cellState>& cells,
    const word& timeName
)
{
    const masterGate once;
    if (!Pstream::master())
    {
        return;
    }

    DynamicList<cellState> entered;
    for (const cellState& cell : cells)
    {
        if (!cell.waits())
        {
            entered.append(cell);
        }
    }

    const fileName folder(set.folder/"poses");
    mkDir(folder);
    atomicWrite
    (
        folder/(timeName + ".vtp"),
        [&](std::ostream& os) { writeCells(os, set, entered); }
    );
    writeSeries(folder);
}


void Foam::removeLaterPoses(const tableSet& set, const scalar time)
{
    const fileName folder(set.folder/"poses");

    if (!Pstream::master() || !isDir(folder))
    {
        return;
    }

    for (const auto& of : posesIn(folder))
    {
        if (of.first > time + 1e-6*set.interval)
        {
            rm(folder/of.second);
        }
    }
    writeSeries(folder);
}
