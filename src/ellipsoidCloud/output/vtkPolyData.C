// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "vtkPolyData.H"
#include "ellipsoidCore.H"

// * * * * * * * * * * * * * * * Global Constants  * * * * * * * * * * * * * //

const char* const Foam::vtkProlog =
    "<?xml version=\"1.0\"?>\n"
    "<!-- ellipsoidTrapFoam " ELLIPSOID_VERSION " -->\n";


// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    static void beginArray(std::ostream& os, const vtkArray& array)
    {
        os  << "<DataArray type=\"" << array.type << "\" Name=\"" << array.name
            << "\" NumberOfComponents=\"" << array.nComponents
            << "\" format=\"ascii\">\n";
    }

    static void endArray(std::ostream& os)
    {
        os << "</DataArray>\n";
    }

    static void writeLabels
    (
        std::ostream& os,
        const char* name,
        const labelUList& labels
    )
    {
        beginArray(os, {"Int64", name, 1});
        for (const label i : labels)
        {
            os << i << '\n';
        }
        endArray(os);
    }
}


// * * * * * * * * * * * * * * * Global Functions  * * * * * * * * * * * * * //

void Foam::writePolyData
(
    std::ostream& os,
    const UList<vtkArray>& arrays,
    const numberWriter& writeNumbers,
    const char* kind,
    const labelUList& points,
    const labelUList& ends
)
{
    os  << vtkProlog
        << "<VTKFile type=\"PolyData\" version=\"0.1\">\n<PolyData>\n"
        << "<Piece NumberOfPoints=\"" << (ends.size() ? ends.last() : 0)
        << "\" NumberOf" << kind
        << "=\"" << ends.size() << "\">\n<Points>\n";
    label first = 0;
    for (const vtkArray& array : arrays)
    {
        beginArray(os, array);
        writeNumbers(os, first, array.nComponents);
        endArray(os);
        os << (first ? "" : "</Points>\n<PointData>\n");
        first += array.nComponents;
    }
    os << "</PointData>\n<" << kind << ">\n";
    writeLabels(os, "connectivity", points);
    writeLabels(os, "offsets", ends);
    os  << "</" << kind << ">\n</Piece>\n</PolyData>\n</VTKFile>\n";
}
