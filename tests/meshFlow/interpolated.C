// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

/*---------------------------------------------------------------------------*\
Application
    interpolated

Description
    Prints the velocity of a case at points within it as the interpolation
    divergenceFree gives it; then that of twice the flow, and whether what is
    kept with the mesh was kept.

\*---------------------------------------------------------------------------*/

#include "argList.H"
#include "columnFvMesh.H"
#include "flowOfField.H"
#include "fvMesh.H"
#include "interpolation.H"
#include "Random.H"
#include "StringStream.H"
#include "surfaceFields.H"
#include "Time.H"
#include "volFields.H"

using namespace Foam;

static void print(const char* what, const volVectorField& U)
{
    const fvMesh& mesh = U.mesh();
    const boundBox box(mesh.points(), true);
    const auto velocity = interpolation<vector>::New("divergenceFree", U);
    Random random(1);
    List<string> lines(Pstream::nProcs());
    OStringStream text;
    text.precision(17);

    for (label i = 0; i < 300; ++i)
    {
        const point x
        (
            box.min() + cmptMultiply(random.sample01<vector>(), box.span())
        );
        const label celli = mesh.findCell(x);
        if (celli >= 0)
        {
            const vector u(velocity->interpolate(x, celli));
            text<< what << ' ' << i << ' ' << u.x() << ' ' << u.y() << ' '
                << u.z() << nl;
        }
    }

    // Ranks that print by themselves may interrupt one another
    lines[Pstream::myProcNo()] = text.str();
    Pstream::gatherList(lines);
    for (const string& ofRank : lines)
    {
        Info<< ofRank.c_str();
    }
    Info<< endl;
}


int main(int argc, char *argv[])
{
    #include "setRootCase.H"
    #include "createTime.H"
    #include "createMesh.H"

    const auto io =
        [&](const word& name)
        {
            return IOobject
            (
                name, runTime.timeName(), mesh, IOobject::MUST_READ
            );
        };
    volVectorField U(io("U"), mesh);
    surfaceScalarField phi(io("phi"), mesh);

    print("once", U);
    const flowOfField& kept = flowOfField::New(U);
    const label made = kept.eventNo();
    print("again", U);
    Info<< "kept " << (flowOfField::New(U).eventNo() == made) << endl;

    U *= 2;
    phi *= 2;
    print("twice", U);
    Info<< "kept " << (kept.eventNo() == made) << endl;

    return 0;
}
