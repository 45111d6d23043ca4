/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/
#include "writeTracksVTP.H"
#include "atomicWrite.H"
#include "cellState.H"
#include "stringOps.H"

#include <fstream>
#include <map>
#include <vector>

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- Column of the fate, which is a name there and a number here
    static const label fateColumn = 18;

    //- Columns of tracks.csv that make an array
    struct trackArray
    {
        const char* type;
        const char* name;
        label nComponents;
        label firstColumn;
    };

    static const trackArray positions = { "Float64", "x", 3, 2 };

    static const trackArray pointData[] =
    {
        { "Float64", "t", 1, 0 },
        { "Int32", "id", 1, 1 },
        { "Float64", "U", 3, 5 },
        { "Float64", "omega", 3, 12 },
        { "Float64", "O", 3, 15 },
        { "Int32", "fate", 1, fateColumn }
    };

    //- The rows of each cell
    typedef std::map<label, std::vector<std::string>> trackRows;

    static void writeArray
    (
        std::ostream& os,
        const trackArray& array,
        const trackRows& cells
    )
    {
        os  << "<DataArray type=\"" << array.type << "\" Name=\"" << array.name
            << "\" NumberOfComponents=\"" << array.nComponents
            << "\" format=\"ascii\">\n";

        for (const auto& cell : cells)
        {
            for (const std::string& row : cell.second)
            {
                const auto fields = stringOps::split(row, ',');

                for (label d = 0; d < array.nComponents; ++d)
                {
                    const label column = array.firstColumn + d;
                    const std::string text(fields[column].str());

                    os << (d ? " " : "");
                    if (column == fateColumn)
                    {
                        os << label(cellState::fateNames[text]);
                    }
                    else
                    {
                        os << text;
                    }
                }
                os << '\n';
            }
        }
        os << "</DataArray>\n";
    }
}


// * * * * * * * * * * * * * * * Global Functions  * * * * * * * * * * * * * //

void Foam::writeTracksVTP(const fileName& csv, const fileName& vtp)
{
    trackRows cells;
    label nPoints = 0;

    std::ifstream is(csv);
    std::string line;
    std::getline(is, line);

    while (std::getline(is, line))
    {
        cells[std::stol(line.substr(line.find(',') + 1))].push_back(line);
        ++nPoints;
    }

    std::ofstream os(vtp);
    os  << "<?xml version=\"1.0\"?>\n"
        << "<VTKFile type=\"PolyData\" version=\"0.1\">\n<PolyData>\n"
        << "<Piece NumberOfPoints=\"" << nPoints << "\" NumberOfLines=\""
        << cells.size() << "\">\n<Points>\n";
    writeArray(os, positions, cells);
    os  << "</Points>\n<PointData>\n";
    for (const trackArray& array : pointData)
    {
        writeArray(os, array, cells);
    }
    os  << "</PointData>\n<Lines>\n"
        << "<DataArray type=\"Int64\" Name=\"connectivity\""
        << " format=\"ascii\">\n";
    for (label i = 0; i < nPoints; ++i)
    {
        os << i << '\n';
    }
    os  << "</DataArray>\n"
        << "<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">\n";
    label offset = 0;
    for (const auto& cell : cells)
    {
        offset += cell.second.size();
        os << offset << '\n';
    }
    os  << "</DataArray>\n</Lines>\n</Piece>\n</PolyData>\n</VTKFile>\n";

    if (!os.flush())
    {
        cannotWrite(vtp);
    }
}


// ************************************************************************* //
