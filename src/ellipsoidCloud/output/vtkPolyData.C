// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "vtkPolyData.H"
#include "ellipsoid.h"

// * * * * * * * * * * * * * * * Global Constants  * * * * * * * * * * * * * //

const char* const Foam::vtkProlog =
    "<?xml version=\"1.0\"?>\n"
    "<!-- ellipsoidTrapFoam " ELLIPSOID_VERSION " -->\n";


// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    template<class Type>
    static void writeArray
    (
        std::ostream& os,
        const char* type,
        const char* name,
        const label nComponents,
        const UList<Type>& values
    )
    {
        os  << "<DataArray type=\"" << type << "\" Name=\"" << name
            << "\" NumberOfComponents=\"" << nComponents
            << "\" format=\"ascii\">\n";
        forAll(values, i)
        {
            os << values[i] << ((i + 1) % nComponents ? ' ' : '\n');
        }
        os << "</DataArray>\n";
    }

    static void writeArray(std::ostream& os, const vtkArray& of)
    {
        writeArray(os, of.type, of.name, of.nComponents, of.values);
    }
}


// * * * * * * * * * * * * * * * Global Functions  * * * * * * * * * * * * * //

void Foam::appendPoint(UList<vtkArray>& arrays, const scalar* row)
{
    for (vtkArray& to : arrays)
    {
        for (label i = 0; i < to.nComponents; ++i)
        {
            to.values.append(*row++);
        }
    }
}


void Foam::writePolyData
(
    std::ostream& os,
    const UList<vtkArray>& arrays,
    const char* kind,
    const labelUList& points,
    const labelUList& ends
)
{
    os  << vtkProlog
        << "<VTKFile type=\"PolyData\" version=\"0.1\">\n<PolyData>\n"
        << "<Piece NumberOfPoints=\"" << points.size() << "\" NumberOf" << kind
        << "=\"" << ends.size() << "\">\n<Points>\n";
    writeArray(os, arrays[0]);
    os << "</Points>\n<PointData>\n";
    for (label i = 1; i < arrays.size(); ++i)
    {
        writeArray(os, arrays[i]);
    }
    os << "</PointData>\n<" << kind << ">\n";
    writeArray(os, "Int64", "connectivity", 1, points);
    writeArray(os, "Int64", "offsets", 1, ends);
    os  << "</" << kind << ">\n</Piece>\n</PolyData>\n</VTKFile>\n";
}
