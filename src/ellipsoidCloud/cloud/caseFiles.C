// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "caseFiles.H"
#include "argList.H"
#include "atomicWrite.H"
#include "checkedEntries.H"
#include "labelIOList.H"
#include "masterGate.H"
#include "OSspecific.H"
#include "polyBoundaryMeshEntries.H"
#include "polyMesh.H"
#include "PstreamReduceOps.H"
#include "Time.H"
#include "volFields.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- A file of the present time or of the latest before that has it
    static IOobject latest
    (
        const word& name,
        const fileName& folder,
        const objectRegistry& db
    )
    {
        const word instance
        (
            db.time().findInstance(folder, name, IOobject::READ_IF_PRESENT)
        );

        return IOobject
        (
            name, instance, folder, db,
            IOobject::READ_IF_PRESENT, IOobject::NO_WRITE, false
        );
    }

    //- End the run, with the step to take, unless every rank has a file that
    //  begins as one of OpenFOAM
    template<class Type>
    static void need
    (
        IOobject io,
        const fileName& path,
        const std::string& step
    )
    {
        const bool there =
            returnReduce(io.typeHeaderOk<Type>(false), andOp<bool>());
        const masterGate once;

        if (!there)
        {
            FatalErrorInFunction
                << path << " is missing"
                << (Pstream::parRun() ? ", or that of another processor" : "")
                << nl << "    " << step.c_str() << exit(FatalError);
        }
    }

    //- Which step makes the mesh of this rank
    static std::string stepToMesh(const Time& time)
    {
        return
            Pstream::parRun()
          ? "Make the whole mesh, then decomposePar -force"
          : isDir(time.path()/"processor0"/"constant"/polyMesh::meshSubDir)
          ? "The case is decomposed: run it in parallel, or reconstructParMesh"
            " -constant"
          : "Make the mesh, by blockMesh or another mesher";
    }

    //- Which step brings a field of the flow
    static std::string stepToField(const word& name, const Time& time)
    {
        const fileName whole(time.globalPath());
        word from;
        scalar latest = -VGREAT;
        for (const fileName& folder : readDir(whole, fileName::DIRECTORY))
        {
            scalar t;
            if
            (
                readScalar(folder, t) && t > latest && t <= time.value()
             && isFile(whole/folder/name)
            )
            {
                latest = t;
                from = folder;
            }
        }

        if (Pstream::parRun() && !from.empty())
        {
            const word& now = time.timeName();
            return
                "Run decomposePar -force -time " + from
              + (from == now ? "" : ',' + now);
        }
        if (isFile(whole/"0.orig"/name))
        {
            return
                std::string("Run cp ")
              + (isDir(whole/"0") ? "0.orig/* 0" : "-r 0.orig 0")
              + (Pstream::parRun() ? ", then decomposePar -force" : "");
        }

        return
            "Put " + name + " with its boundary conditions there: that of a"
            " tutorial is a start";
    }
}


// * * * * * * * * * * * * * * * Global Functions  * * * * * * * * * * * * * //

Foam::dictionary Foam::caseFiles::controls(const argList& args)
{
    const fileName file
    (
        args.rootPath()/args.globalCaseName()/"system"/"controlDict"
    );
    string text(textOf(file));
    broadcast(text);

    // Its name is where files that it includes are; a file begins at line 1
    IStringStream is(text);
    is.name() = file;
    is.lineNumber() = 1;

    return dictionary(is);
}


void Foam::caseFiles::checkCase(const argList& args, const fileNameList& files)
{
    const fileName whole(args.rootPath()/args.globalCaseName());

    if (!args.checkRootCase())
    {
        if (Pstream::parRun() && isDir(whole))
        {
            FatalError << nl << "    Run decomposePar first" << endl;
        }
        FatalError.exit();
    }

    {
        const masterGate once;
        fileNameList needed({"system/controlDict"});
        std::string missing;

        needed.append(files);
        for (const fileName& file : needed)
        {
            if (Pstream::master() && !isFile(whole/file))
            {
                missing += ' ' + file;
            }
        }

        if (!missing.empty())
        {
            FatalErrorInFunction
                << "the case " << whole << " lacks" << missing.c_str() << nl
                << "    Copy what it lacks from a case that runs, as the"
                << " tutorial singleSieve, and change it" << exit(FatalError);
        }
    }

    const dictionary control(controls(args));
    const masterGate once;

    // OpenFOAM divides by it, or never comes to the next time
    if (control.getOrDefault<word>("writeControl", "timeStep") != "none")
    {
        checkedNumber(control, "writeInterval", above(0), 1.0);
    }
}


void Foam::caseFiles::checkMesh(const Time& time, const bool forCells)
{
    const fileName folder(polyMesh::meshSubDir);

    for (const char* name : {"points", "faces", "owner", "neighbour", "boundary"})
    {
        const IOobject file(latest(name, folder, time));
        need<labelIOList>(file, file.objectPath(), stepToMesh(time));
    }

    const polyBoundaryMeshEntries patches
    (
        IOobject
        (
            "boundary", latest("boundary", folder, time).instance(), folder, time,
            IOobject::MUST_READ, IOobject::NO_WRITE, false
        )
    );

    for (const entry& patch : patches)
    {
        const word type(patch.dict().get<word>("type"));
        if (!forCells || (type != "empty" && type != "wedge"))
        {
            continue;
        }

        // All ranks have these. One without faces takes no dimension away
        const bool hasFaces = returnReduce
        (
            patch.dict().get<label>("nFaces") > 0, orOp<bool>()
        );
        const masterGate once;

        if (hasFaces)
        {
            FatalErrorInFunction
                << "patch " << patch.keyword() << " of "
                << patches.objectPath() << " is of type " << type << nl
                << "    A cell is a body in three dimensions: its mesh has "
                << "walls (type wall) and open ends (type patch)"
                << exit(FatalError);
        }
    }
}


Foam::word Foam::caseFiles::flowInstance(const fvMesh& mesh)
{
    const Time& time = mesh.time();
    const IOobject U(latest("U", "", mesh));
    IOobject p(U);
    p.rename("p");

    const fileName now(time.path()/time.timeName());
    need<volVectorField>(U, now/"U", stepToField("U", time));
    need<volScalarField>(p, p.objectPath(), stepToField("p", time));

    return U.instance();
}
