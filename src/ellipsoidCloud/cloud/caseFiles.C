// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "caseFiles.H"
#include "argList.H"
#include "atomicWrite.H"
#include "checkedEntries.H"
#include "labelIOList.H"
#include "masterGate.H"
#include "plainLists.H"
#include "OSspecific.H"
#include "polyBoundaryMeshEntries.H"
#include "polyMesh.H"
#include "PstreamReduceOps.H"
#include "surfaceFields.H"
#include "Time.H"
#include "volFields.H"

#include <algorithm>
#include <climits>
#include <unistd.h>
#include <vector>

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
        const IOobject::readOption ifPresent = IOobject::READ_IF_PRESENT;

        return IOobject
        (
            name, db.time().findInstance(folder, name, ifPresent), folder, db,
            ifPresent, IOobject::NO_WRITE, false
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
            const bool headless = !Pstream::parRun() && isFile(path);

            FatalErrorInFunction
                << path
                << (
                       headless
                     ? " is empty, or does not begin with FoamFile { ... }"
                     : " is missing"
                   )
                << (Pstream::parRun() ? ", or that of another processor" : "")
                << nl << "    " << step.c_str() << exit(FatalError);
        }
    }

    //- What is wrong with the patches of a mesh, or nothing
    static string complaintOf
    (
        const polyBoundaryMeshEntries& patches,
        const label nInternal,
        const label nFaces
    )
    {
        label start = nInternal;
        forAll(patches, i)
        {
            const dictionary& patch = patches[i].dict();
            const label end =
                i + 1 < patches.size()
              ? patches[i + 1].dict().get<label>("startFace")
              : nFaces;
            const struct
            {
                const char* entry;
                label allowed;
                const char* why;
            }
            rules[] =
            {
                {"startFace", start, ", after the faces that come before"},
                {
                    "nFaces", max(end - start, label(0)),
                    ", up to the next patch or the last face"
                },
                {
                    "myProcNo", Pstream::myProcNo(),
                    ". The folder is another processor's: put it back, or"
                    " decomposePar -force"
                }
            };

            for (const auto& rule : rules)
            {
                const label given =
                    patch.getOrDefault<label>(rule.entry, rule.allowed);
                if (given != rule.allowed)
                {
                    return
                        "patch " + patches[i].keyword() + " has " + rule.entry
                      + ' ' + Foam::name(given) + "\n    allowed: "
                      + Foam::name(rule.allowed) + rule.why;
                }
            }
            start = end;
        }

        return string();
    }

    //- End the run if the patches are not those of the mesh, or of another rank
    static void checkPatches
    (
        const polyBoundaryMeshEntries& patches,
        const Time& time
    )
    {
        const fileName folder(polyMesh::meshSubDir);
        const labelIOList owner(latest("owner", folder, time));
        const labelIOList neighbour(latest("neighbour", folder, time));
        const label nInternal = std::count_if
        (
            neighbour.begin(), neighbour.end(),
            [](const label celli) { return celli >= 0; }
        );
        string complaint(complaintOf(patches, nInternal, owner.size()));

        // Faces that a rank shares with others: the sum is for cyclic ones
        labelList shared(Pstream::nProcs(), Zero);
        for (const entry& patch : patches)
        {
            label rank = -1;
            if
            (
                patch.dict().readIfPresent("neighbProcNo", rank)
             && rank >= 0 && rank < shared.size()
            )
            {
                shared[rank] += patch.dict().get<label>("nFaces");
            }
        }
        const List<labelList> between(fromAllRanks(shared));
        const label me = Pstream::myProcNo();

        for (label other = 0; complaint.empty() && other < me; ++other)
        {
            const label here = between[me][other];
            const label there = between[other][me];
            if (here != there)
            {
                OStringStream text;
                text<< "processor " << me << " has " << here
                    << " faces to processor " << other << ", and that " << there
                    << " to it" << nl << "    They are of two decompositions:"
                    << " decomposePar -force";
                complaint = text.str();
            }
        }
        if (!complaint.empty())
        {
            complaint = patches.objectPath() + ": " + complaint;
        }
        refuseFirst(complaint);
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
                isNumber(folder, t) && t > latest && t <= time.value()
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

    return dictionaryOf(text, file);
}


void Foam::caseFiles::checkPath(const int argc, const char* const argv[])
{
    char folder[PATH_MAX] = "";
    std::vector<std::string> paths;
    if (::getcwd(folder, sizeof(folder)))
    {
        paths.push_back(folder);
    }

    for (int i = 1; i + 1 < argc; ++i)
    {
        if (std::string(argv[i]) == "-case")
        {
            paths.push_back(argv[i + 1]);
        }
    }

    for (const std::string& path : paths)
    {
        if (!string::valid<fileName>(path))
        {
            FatalErrorInFunction
                << "OpenFOAM cannot read the folder '" << path.c_str() << "'"
                << nl << "    allowed: names without blanks, quotes and"
                << " semicolons. Rename the folder" << exit(FatalError);
        }
    }
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
                << "    Copy what it lacks from a tutorial that has it,"
                << " singleSieve or circularTrap, and change it"
                << exit(FatalError);
        }
    }

    for (const fileName& file : files)
    {
        string text(textOf(whole/file));
        broadcast(text);
        checkPatterns(text, whole/file);
    }
    const dictionary control(controls(args));
    const masterGate once;

    checkValues
    (
        control,
        {
            "startFrom", "startTime", "stopAt", "endTime", "deltaT",
            "writeControl", "writeInterval", "purgeWrite", "writeFormat",
            "writeVersion", "writePrecision", "writeCompression", "timeFormat",
            "timePrecision", "runTimeModifiable"
        }
    );

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

    const polyBoundaryMeshEntries patches(latest("boundary", folder, time));

    checkPatches(patches, time);

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

    // decomposePar has read those of a rank
    for (const IOobject& field : {U, p})
    {
        std::string text(textOf(field.objectPath()));
        const std::size_t patches = text.find("boundaryField");
        if (!Pstream::parRun() && patches != std::string::npos)
        {
            // Lines keep their numbers
            const auto end = text.begin() + patches;
            text.replace
            (
                0, patches, std::string(std::count(text.begin(), end, '\n'), '\n')
            );
            checkPatterns(text, field.objectPath());
        }
    }

    return U.instance();
}
