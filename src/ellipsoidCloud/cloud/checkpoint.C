// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "checkpoint.H"
#include "masterGate.H"
#include "atomicWrite.H"
#include "argList.H"
#include "caseFiles.H"
#include "cloud.H"
#include "OSspecific.H"
#include "plainLists.H"
#include "PstreamReduceOps.H"
#include "SHA1.H"
#include "StringStream.H"
#include "Time.H"
#include "volFields.H"

#include <set>

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- A time directory: value and name
    typedef std::pair<scalar, word> namedTime;

    //- Do ranks share files?
    static bool sharedFiles()
    {
        return Pstream::parRun() && fileHandler().type() == "collated";
    }

    //- Take the bytes of a list into a digest
    template<class Type>
    static void addTo(SHA1& digest, const UList<Type>& list)
    {
        const void* bytes = list.cdata();
        digest.append(static_cast<const char*>(bytes), list.byteSize());
    }

    //- Is the run to go on from the latest time there is? Collective
    static bool fromLatestTime(const argList& args)
    {
        const word latest("latestTime");

        return
            caseFiles::controls(args).getOrDefault("startFrom", latest)
         == latest;
    }

    //- The time directories of all ranks, in ascending order; collective
    static std::set<namedTime> allTimes(const fileName& path)
    {
        std::set<namedTime> times;
        for (const instantList& some : fromAllRanks(Time::findTimes(path)))
        {
            for (const instant& time : some)
            {
                if (time.name() != "constant")
                {
                    times.insert({time.value(), time.name()});
                }
            }
        }

        return times;
    }

    //- The file in a time directory that holds the state, and the field that
    //  is written before it: decomposePar and reconstructPar go to a time only
    //  for its fields and cells, and there may be no cells
    static const fileName stateFile("uniform/ellipsoidCloudRestart");
    static const word fieldName("ellipsoidCloudState");

    //- Where ranks that share their files have a time directory
    static fileName sharedTime(const fileName& path)
    {
        if (!Pstream::parRun())
        {
            return path;
        }
        const word parts("processors" + Foam::name(Pstream::nProcs()));
        return path.path().path()/parts/path.name();
    }


    //- The state in a time directory, whether or not ranks shared their files
    //  when it was written
    static fileName stateIn(const fileName& path)
    {
        const fileName shared(sharedTime(path)/stateFile);
        return isFile(shared) ? shared : path/stateFile;
    }


    //- The entry that ends a state of this text
    static std::string digestEntry(const std::string& text)
    {
        return "digest \"" + SHA1(text).str() + "\";\n";
    }


    //- Is a state what was written, to its end?
    static bool isWhole(const std::string& text)
    {
        const std::size_t size = digestEntry("").size();
        const std::size_t end = max(text.size(), size) - size;

        return text.substr(end) == digestEntry(text.substr(0, end));
    }


    //- Was a state begun in a time directory, be it complete or not?
    static bool begun(const fileName& path)
    {
        return isFile(path/fieldName) || isFile(stateIn(path));
    }


    //- End the run if there is a state of the present time under another name
    static void checkNames(const Time& time)
    {
        for (const instant& other : time.times())
        {
            if
            (
                other.name() != time.timeName()
             && mag(other.value() - time.value()) < 1e-6*time.deltaTValue()
             && begun(time.path()/other.name())
            )
            {
                FatalErrorInFunction
                    << "the cells of this time are in the directory "
                    << other.name() << ", which by timeFormat and timePrecision"
                    << " of controlDict is now " << time.timeName() << nl
                    << "    Put these entries back, or raise timePrecision, as"
                    << " OpenFOAM did in the run; or rename the directory"
                    << exit(FatalError);
            }
        }
    }
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::checkpoint::checkpoint(const Time& time)
:
    path_(time.path()/time.timeName())
{
    const fileName file(stateIn(path_));
    string text(textOf(file));
    broadcast(text);

    // Where ranks share a file the folder is another, and asking is collective
    const bool shared = isFile(fileHandler().filePath(path_/fieldName));
    const bool some = returnReduce(shared || begun(path_), orOp<bool>());

    const masterGate once;
    if (isWhole(text))
    {
        notes_ = dictionaryOf(text, file);
    }
    else if (some)
    {
        const std::string complaint
        (
            text.size()
          ? file + " is damaged: it is not what was written"
          : "time " + time.timeName() + " was not written to its end"
        );
        FatalErrorInFunction
            << complaint.c_str() << nl
            << "    Go on from an earlier time, by startFrom startTime and"
            << " startTime in system/controlDict; or remove "
            << fieldName << " and " << stateFile << " of this one, on every"
            << " processor, to begin anew from its flow" << exit(FatalError);
    }
    else
    {
        checkNames(time);
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::string Foam::checkpoint::meshText(const polyMesh& mesh)
{
    SHA1 digest;
    addTo(digest, mesh.points());
    addTo(digest, mesh.faceOwner());
    addTo(digest, mesh.faceNeighbour());
    for (const face& f : mesh.faces())
    {
        addTo(digest, f);
    }

    // The log and the cells name patches, or count them
    OStringStream text;
    text << mesh.nCells() << " mesh cells, points and faces "
        << digest.str().c_str();
    for (const polyPatch& pp : mesh.boundaryMesh())
    {
        text<< ", " << pp.name() << ' ' << pp.type() << ' ' << pp.start() << ' '
            << pp.size();
    }

    return text.str();
}


void Foam::checkpoint::checkSame(const word& name, const string& now) const
{
    // A dictionary is of an earlier version
    const string then
    (
        notes_.isDict(name)
      ? string("of another version of this program")
      : notes_.getOrDefault(name, now)
    );

    if (then != now)
    {
        FatalErrorInFunction
            << path_ << " holds cells of another " << name.c_str() << nl
            << "    then: " << then.c_str() << nl
            << "    now: " << now.c_str() << nl
            << "    Put the " << name.c_str()
            << " back, or start again from the first time"
            << exit(FatalError);
    }
}


Foam::word Foam::checkpoint::setAsideIncomplete
(
    const argList& args,
    const bool dryRun
)
{
    // Where ranks share files, times without their end are refused, not moved
    if (!fromLatestTime(args) || sharedFiles())
    {
        return word::null;
    }

    bool tracked = isDir
    (
        args.rootPath()/args.globalCaseName()
       /"postProcessing"/"ellipsoidCloud"
    );
    broadcast(tracked);

    const std::set<namedTime> times(allTimes(args.path()));
    if (times.empty())
    {
        return word::null;
    }

    for (auto time = times.rbegin(); std::next(time) != times.rend(); ++time)
    {
        const word& name = time->second;
        const fileName path(args.path()/name);
        const bool other = isFile(path/"U") || isDir(path/"polyMesh");
        const bool kept = Pstream::parRun() && isDir(sharedTime(path));
        const bool complete =
            isDir(path) && (isFile(path/stateFile) || !Pstream::master());

        // To be looked at when it is read, complete, a flow or mesh to start
        // from, or another program's
        if
        (
            returnReduce(kept, orOp<bool>())
         || returnReduce(complete, andOp<bool>())
         || (
                !returnReduce(begun(path), orOp<bool>())
             && (!tracked || returnReduce(other, orOp<bool>()))
            )
        )
        {
            return name;
        }

        Info<< "ellipsoidCloud: time " << name
            << " was not written to its end: " << (dryRun ? "to be " : "")
            << "set aside as " << name << ".incomplete, going on from "
            << std::next(time)->second << endl;

        if (!dryRun && isDir(path))
        {
            const fileName aside(path + ".incomplete");

            // What is there may be the user's
            if ((exists(aside) && !mvBak(aside)) || !mv(path, aside))
            {
                FatalErrorInFunction
                    << "cannot rename " << path << ": remove it by hand"
                    << exit(FatalError);
            }
        }
        waitForRanks();
    }

    return times.begin()->second;
}


void Foam::checkpoint::begin(const fvMesh& mesh)
{
    const fileName path(mesh.time().path()/mesh.time().timeName());

    // A link of decomposePar leads into the undecomposed case: its state stays
    for (const fileName& time : {path, sharedTime(path)})
    {
        const fileName folder((time/stateFile).path());
        if (Foam::type(folder, false) == fileName::LINK)
        {
            rm(folder);
        }
    }

    volScalarField::Internal field
    (
        IOobject(fieldName, mesh.time().timeName(), mesh),
        mesh,
        dimensionedScalar(dimless, Zero)
    );
    atomicWrite(field);
    waitForRanks();
    rm(path/stateFile);
    rm(sharedTime(path)/stateFile);
    rmDir(path/cloud::prefix/"ellipsoidCloud", true);
}


void Foam::checkpoint::end(const Time& time, const std::string& text)
{
    // Not before all ranks have written
    waitForRanks();
    if (Pstream::master())
    {
        const fileName path(time.path()/time.timeName());
        durableWrite
        (
            (sharedFiles() ? sharedTime(path) : path)/stateFile,
            text + digestEntry(text),
            time.writeCompression()
        );
    }
}
