/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/

#include "cellPoses.H"
#include "atomicWrite.H"
#include "OSspecific.H"

#include <functional>
#include <map>
#include <sstream>

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- An array with a line for each cell
    static void writeArray
    (
        std::ostream& os,
        const char* type,
        const char* name,
        const label nComponents,
        const UList<cellState>& cells,
        const std::function<void(const cellState&)>& line
    )
    {
        os  << "<DataArray type=\"" << type << "\" Name=\"" << name
            << "\" NumberOfComponents=\"" << nComponents << "\" format=\"ascii\">\n";
        for (const cellState& cell : cells)
        {
            line(cell);
            os << '\n';
        }
        os << "</DataArray>\n";
    }

    //- The ellipsoid's full axes as a symmetric tensor in the lab's frame [m]
    static void writeAxes
    (
        std::ostream& os,
        const cellState& cell,
        const cellPopulation& population
    )
    {
        const double* a = population.model(cell.id).options.semi_axes;
        double r[3][3];
        ellipsoid_rotation(cell.body.q, r);

        for (int i = 0; i < 3; ++i)
        {
            for (int j = 0; j < 3; ++j)
            {
                double sum = 0;
                for (int k = 0; k < 3; ++k)
                {
                    sum += 2*a[k]*r[i][k]*r[j][k];
                }
                os << sum << ' ';
            }
        }
    }

    //- Text of the file of one time
    static std::string textOf
    (
        const tableSet& set,
        const UList<cellState>& cells
    )
    {
        std::ostringstream os;
        os.precision(9);

        const auto triple = [&os](const double v[3])
        {
            os << v[0] << ' ' << v[1] << ' ' << v[2];
        };

        os  << "<?xml version=\"1.0\"?>\n"
            << "<VTKFile type=\"PolyData\" version=\"0.1\">\n<PolyData>\n"
            << "<Piece NumberOfPoints=\"" << cells.size()
            << "\" NumberOfVerts=\"" << cells.size() << "\">\n<Points>\n";
        writeArray
        (
            os, "Float64", "x", 3, cells,
            [&](const cellState& cell) { triple(cell.body.x); }
        );
        os  << "</Points>\n<PointData>\n";
        writeArray
        (
            os, "Int32", "id", 1, cells,
            [&](const cellState& cell) { os << cell.id; }
        );
        writeArray
        (
            os, "Int32", "fate", 1, cells,
            [&](const cellState& cell) { os << cell.fate; }
        );
        writeArray
        (
            os, "Int32", "patch", 1, cells,
            [&](const cellState& cell) { os << cell.patch; }
        );
        writeArray
        (
            os, "Float64", "U", 3, cells,
            [&](const cellState& cell) { triple(cell.body.u); }
        );
        writeArray
        (
            os, "Float64", "omega", 3, cells,
            [&](const cellState& cell) { triple(cell.body.omega); }
        );
        writeArray
        (
            os, "Float64", "axes", 9, cells,
            [&](const cellState& cell) { writeAxes(os, cell, set.population); }
        );
        os  << "</PointData>\n<Verts>\n";
        label n = 0;
        writeArray
        (
            os, "Int64", "connectivity", 1, cells,
            [&](const cellState&) { os << n++; }
        );
        n = 0;
        writeArray
        (
            os, "Int64", "offsets", 1, cells,
            [&](const cellState&) { os << ++n; }
        );
        os  << "</Verts>\n</Piece>\n</PolyData>\n</VTKFile>\n";

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
        os  << "<?xml version=\"1.0\"?>\n"
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

void Foam::writePoses
(
    const tableSet& set,
    const UList<cellState>& cells,
    const word& timeName
)
{
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


// ************************************************************************* //
