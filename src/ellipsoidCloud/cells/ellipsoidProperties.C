// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "ellipsoidProperties.H"
#include "emptyPolyPatch.H"
#include "listedCells.H"
#include "masterGate.H"
#include "polyBoundaryMesh.H"
#include "processorPolyPatch.H"
#include "PstreamReduceOps.H"
#include "readViscosity.H"
#include "Time.H"

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::ellipsoidProperties::readUnreached(const polyBoundaryMesh& patches)
{
    const wordRes names(patternsOf(*this, "unreached"));
    labelHashSet constrained;
    unreached_ = patches.patchSet(names, false);

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

        if
        (
            !unreached_.found(pp.index()) && !domainImages::isSeam(pp)
         && returnReduce(pp.size(), sumOp<label>()) > 0
        )
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
        labelHashSet named(patches.patchSet(wordRes({name}), false));
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

    {
        const masterGate once;

        if (Pstream::master())
        {
            refuseRepeated(time().globalPath()/time().constant()/name());
        }
        readOptions();
        if (isDict("injection"))
        {
            listedCells::read(subDict("injection"), time().globalPath());
        }
    }
    forces_.read(section("forces"));

    // No reading of files, for which ranks would have to meet, from here on
    const masterGate once;

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
    checkOptions();
    scheme_ = meshFlow::schemeNames.getOrDefault
    (
        "interpolation", *this, meshFlow::stDivergenceFree
    );
    const auto most = scalar(labelMax);
    seed_ = checkedNumber<label>(*this, "seed", within(-most, most), 1);
    readUnreached(mesh.boundaryMesh());
}
