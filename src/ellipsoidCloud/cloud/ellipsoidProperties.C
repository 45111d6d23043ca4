// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "ellipsoidProperties.H"
#include "cellTracks.H"
#include "masterGate.H"
#include "occupancy.H"
#include "readViscosity.H"
#include "captureCriterion.H"
#include "cellInjection.H"
#include "emptyPolyPatch.H"
#include "polyBoundaryMesh.H"
#include "processorPolyPatch.H"
#include "PstreamReduceOps.H"
#include "Time.H"

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::ellipsoidProperties::readUnreached(const polyBoundaryMesh& patches)
{
    const wordRes names(patternsOf(*this, "unreached"));
    labelHashSet constrained;
    unreached_ = patches.patchSet(names, false, false);

    for (const polyPatch& pp : patches)
    {
        if
        (
            !polyPatch::constraintType(pp.type())
         || isA<processorPolyPatch>(pp)
         || pp.type() == emptyPolyPatch::typeName
        )
        {
            continue;
        }

        constrained.insert(pp.index());

        if (!unreached_.found(pp.index()) && !domainImages::isSeam(pp))
        {
            FatalIOErrorInFunction(*this)
                << "patch " << pp.name() << " of "
                << patches.mesh().meshDir()/"boundary"
                << " is of type " << pp.type() << nl
                << "    A cell that came to it could not go on. Make it a "
                << "plane of symmetry (symmetryPlane), cyclic (by createPatch, "
                << "if its halves have the same faces), a wall (wall) "
                << "or an open end (patch); or, if no cell comes there, say "
                << "so: unreached (" << pp.name()
                << ");" << exit(FatalIOError);
        }
    }

    for (const wordRe& name : names)
    {
        labelHashSet named(patches.patchSet(wordRes({name}), false, false));
        named &= constrained;

        if (named.empty())
        {
            const labelList labels(constrained.sortedToc());
            FatalIOErrorInFunction(*this)
                << "unreached " << name << " matches no patch of type cyclic "
                << "or symmetry" << nl << "    patches of such types: "
                << flatOutput(wordList(patches.names(), labels))
                << exit(FatalIOError);
        }
    }
}


void Foam::ellipsoidProperties::checkPatches
(
    const polyBoundaryMesh& patches
) const
{
    if (found("injection"))
    {
        section("injection");
    }
    const dictionary& injections = subDict("injection");

    for (const entry& e : injections)
    {
        if (!e.isDict() && isVariable(injections, e.keyword()))
        {
            continue;
        }
        if (!e.isDict())
        {
            FatalIOErrorInFunction(injections)
                << e.keyword() << " is not a dictionary of an injection"
                << exit(FatalIOError);
        }

        cellInjection::checkEntries(e.dict());

        if (e.dict().found("patch"))
        {
            cellInjection::findPatch(e.dict(), patches);
        }
    }

    captureCriterion(section("capture"), patches);
    cellTracks::setting(section("tracks"));
    occupancy::setting(section("occupancy"), patches);
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::ellipsoidProperties::ellipsoidProperties(const polyMesh& mesh)
:
    IOdictionary
    (
        IOobject
        (
            "ellipsoidCloudProperties",
            mesh.time().constant(),
            mesh,
            IOobject::MUST_READ
        )
    ),
    options_(ellipsoid_options_default())
{
    options_.kinematic_viscosity = readViscosity(mesh).value();

    const label nCells = returnReduce(mesh.nCells(), sumOp<label>());
    const label nPatches =
        returnReduce(mesh.boundaryMesh().size(), sumOp<label>());

    // No reading of files, for which ranks would have to meet, from here on
    const masterGate once;

    if (Pstream::master())
    {
        refuseRepeated(time().globalPath()/time().constant()/name());
    }
    if (!nCells || !nPatches)
    {
        FatalErrorInFunction
            << "the mesh in " << mesh.meshDir() << " has no "
            << (nCells ? "patches" : "cells") << ": make it again"
            << exit(FatalError);
    }

    if (isFile(time().globalPath()/time().constant()/"g"))
    {
        Warning
            << "constant/g is not read: gravity is that of forces/gravity in "
            << name() << nl << endl;
    }
    readOptions();
    checkOptions();
    scheme_ = frozenFlow::schemeNames.getOrDefault
    (
        "interpolation", *this, frozenFlow::stDivergenceFree
    );
    seed_ = getOrDefault<label>("seed", 1);
    readUnreached(mesh.boundaryMesh());
    checkPatches(mesh.boundaryMesh());
}
