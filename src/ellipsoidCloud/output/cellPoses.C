// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "cellPoses.H"
#include "atomicWrite.H"
#include "masterGate.H"
#include "OSspecific.H"
#include "vtkPolyData.H"

#include <algorithm>
#include <map>
#include <sstream>

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- Text of the file of one time
    static std::string textOf
    (
        const tableSet& set,
        const UList<cellState>& cells
    )
    {
        std::ostringstream os;
        os.precision(9);

        List<vtkArray> arrays
        ({
            {"Float64", "x", 3, {}},
            {"Int32", "id", 1, {}},
            {"Int32", "fate", 1, {}},
            {"Int32", "patch", 1, {}},
            {"Float64", "U", 3, {}},
            {"Float64", "omega", 3, {}},
            {"Float64", "axes", 9, {}}
        });
        const labelList points(identity(cells.size()));
        labelList ends(points);

        forAll(cells, i)
        {
            const cellState& cell = cells[i];
            const ellipsoid_state& body = cell.body;
            scalar row[21];
            scalar* at = std::copy_n(body.x, 3, row);
            for (const label n : {cell.id, cell.fate, cell.patch})
            {
                *at++ = n;
            }
            at = std::copy_n(body.u, 3, at);
            at = std::copy_n(body.omega, 3, at);
            std::copy_n(fullAxes(cell, set.population).v_, 9, at);

            appendPoint(arrays, row);
            ++ends[i];
        }

        writePolyData(os, arrays, "Verts", points, ends);

        return os.str();
    }

    //- Text of the series of the files in a folder, up to a time
    static std::string seriesOf(const fileName& folder, const scalar end)
    {
        std::map<scalar, word> times;
        for (const fileName& file : readDir(folder, fileName::FILE))
        {
            scalar time;
            if
            (
                file.hasExt("vtp")
             && readScalar(file.lessExt(), time)
             && time <= end
            )
            {
                times[time] = file;
            }
        }

        std::ostringstream os;
        os  << vtkProlog
            << "<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n";
        for (const auto& time : times)
        {
            os  << "<DataSet timestep=\"" << time.second.lessExt().c_str()
                << "\" file=\"" << folder.name().c_str() << '/'
                << time.second.c_str() << "\"/>\n";
        }
        os << "</Collection>\n</VTKFile>\n";

        return os.str();
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

    tensor axes(Zero);
    for (int i = 0; i < 3; ++i)
    {
        for (int j = 0; j < 3; ++j)
        {
            for (int k = 0; k < 3; ++k)
            {
                axes(i, j) += 2*a[k]*R(i, k)*R(j, k);
            }
        }
    }
    return axes;
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
        if (cell.fate != cellState::waiting)
        {
            entered.append(cell);
        }
    }

    const fileName folder(set.folder/"poses");
    mkDir(folder);
    atomicWrite(folder/(timeName + ".vtp"), textOf(set, entered));
    atomicWrite
    (
        set.folder/"poses.pvd",
        seriesOf(folder, readScalar(timeName))
    );
}
