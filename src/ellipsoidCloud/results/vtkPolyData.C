/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/

#include "vtkPolyData.H"
#include "ellipsoid.h"

// * * * * * * * * * * * * * * Static Data Members * * * * * * * * * * * * * //

const char* const Foam::vtkPolyData::prolog =
    "<?xml version=\"1.0\"?>\n"
    "<!-- ellipsoidTrapFoam " ELLIPSOID_VERSION " -->\n";


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::vtkPolyData::vtkPolyData
(
    std::ostream& os,
    const char* kind,
    const labelUList& ends
)
:
    os_(os),
    kind_(kind),
    ends_(ends)
{
    os_ << prolog
        << "<VTKFile type=\"PolyData\" version=\"0.1\">\n<PolyData>\n"
        << "<Piece NumberOfPoints=\"" << (ends.empty() ? 0 : ends.last())
        << "\" NumberOf" << kind_ << "=\"" << ends.size()
        << "\">\n<Points>\n";
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::vtkPolyData::array
(
    const char* type,
    const char* name,
    const label nComponents,
    const std::function<void(const label)>& row
)
{
    const label n = ends_.empty() ? 0 : ends_.last();

    os_ << "<DataArray type=\"" << type << "\" Name=\"" << name
        << "\" NumberOfComponents=\"" << nComponents
        << "\" format=\"ascii\">\n";
    for (label i = 0; i < n; ++i)
    {
        row(i);
        os_ << '\n';
    }
    os_ << "</DataArray>\n";
}


void Foam::vtkPolyData::pointData()
{
    os_ << "</Points>\n<PointData>\n";
}


void Foam::vtkPolyData::cells()
{
    os_ << "</PointData>\n<" << kind_ << ">\n";
    array
    (
        "Int64", "connectivity", 1, [this](const label i) { os_ << i; }
    );

    os_ << "<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">\n";
    for (const label end : ends_)
    {
        os_ << end << '\n';
    }
    os_ << "</DataArray>\n</" << kind_
        << ">\n</Piece>\n</PolyData>\n</VTKFile>\n";
}


// ************************************************************************* //
