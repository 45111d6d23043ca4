/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/
#include "checkpoint.H"
#include "masterGate.H"
#include "atomicWrite.H"
#include "argList.H"
#include "cloud.H"
#include "OSspecific.H"
#include "plainLists.H"
#include "polyMesh.H"
#include "PstreamReduceOps.H"
#include "SHA1.H"
#include "StringStream.H"
#include "Time.H"

#include <set>

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- A time directory: value and name
    typedef std::pair<scalar, word> namedTime;

    //- All ranks have come so far
    static void meet()
    {
        returnReduce(true, andOp<bool>());
    }

    //- Do ranks share files?
    static bool sharedFiles()
    {
        return fileHandler().type() == "collated";
    }

    //- Take the bytes of a list into a digest
    template<class Type>
    static void addTo(SHA1& digest, const UList<Type>& list)
    {
        const void* bytes = list.cdata();
        digest.append(static_cast<const char*>(bytes), list.byteSize());
    }

    //- A dictionary of that text; the name is for messages
    static dictionary parsed(const string& text, const fileName& name)
    {
        IStringStream is(text);
        is.name() = name;
        return dictionary(is);
    }

    //- Is the run to go on from the latest time there is? Collective
    static bool fromLatestTime(const argList& args)
    {
        const fileName path(args.rootPath()/args.globalCaseName());
        string text(textOf(path/"system"/"controlDict"));
        broadcast(text);

        // What is wrong with the file the Time will say
        const dictionary control(parsed(text, "controlDict"));
        const word latest("latestTime");

        return
            control.size()
         && control.getOrDefault("startFrom", latest) == latest;
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

    //- Where two dictionaries differ, or nothing
    static string difference(const dictionary& then, const dictionary& now)
    {
        OStringStream os;

        if (then.toc() != now.toc())
        {
            os  << ": " << flatOutput(then.toc()) << " then, "
                << flatOutput(now.toc()) << " now";
            return os.str();
        }

        for (const entry& e : then)
        {
            const entry& other = *now.findEntry(e.keyword());

            if (e != other && e.isDict())
            {
                return ' ' + e.keyword() + difference(e.dict(), other.dict());
            }
            if (e != other)
            {
                os  << ' ' << e.keyword() << ": " << e.stream().first()
                    << " then, " << other.stream().first() << " now";
                return os.str();
            }
        }

        return string();
    }

    //- Paths in a time directory
    static const fileName markFile("uniform/ellipsoidCloudFiles");
    static const fileName unfinishedFile("uniform/ellipsoidCloudUnfinished");
    static const fileName cellFolder(cloud::prefix/"ellipsoidCloudRestart");

    //- And that of the same cells for other programs
    static const fileName outputFolder(cloud::prefix/"ellipsoidCloud");

    //- What the mark in a time directory says, empty if there is none
    static string readMark(const fileName& path)
    {
        if (sharedFiles() && !isFile(path/markFile))
        {
            // Where decomposePar puts a copy
            const word parts("processors" + Foam::name(Pstream::nProcs()));
            return textOf(path.path().path()/parts/path.name()/markFile);
        }

        return textOf(path/markFile);
    }

    //- Has a rank not made the mark that it finds, but decomposePar or
    //  reconstructPar? Collective
    static bool copied(const dictionary& mark, const fileName& path)
    {
        const bool copy =
            !mark.empty()
         && (
                Foam::type(path/"uniform", false) == fileName::LINK
             || mark.get<label>("rank") != Pstream::myProcNo()
             || mark.get<label>("ranks") != Pstream::nProcs()
            );

        return returnReduce(copy, orOp<bool>());
    }

    //- Was a state begun in a time directory, be it complete or not?
    static bool begun(const fileName& path)
    {
        return
            isFile(path/markFile)
         || isFile(path/unfinishedFile)
         || isDir(path/cellFolder);
    }

    //- Say what is wrong with the files of this rank in a time directory, if
    //  anything
    static string findDamage(const dictionary& mark, const fileName& path)
    {
        for (const entry& e : mark.subDict("files"))
        {
            const fileName file(path/cellFolder/e.keyword());

            if (!isFile(file))
            {
                return file + " is missing";
            }

            const std::string found(textOf(file));
            const int64_t bytes(e.dict().get<scalar>("bytes"));

            if (int64_t(found.size()) != bytes)
            {
                return
                    file + " is damaged: it holds " + Foam::name(found.size())
                  + " bytes where " + Foam::name(bytes) + " were written";
            }
            if (SHA1(found).str() != e.dict().get<string>("digest"))
            {
                return file + " is damaged: it is not what was written";
            }
        }

        return string();
    }

    //- Say under which other name this rank has a state of the present time, if
    //  any; collective
    static string findOtherName(const Time& time)
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
                return
                    "the cells of this time are in the directory "
                  + other.name() + ", which by timeFormat and timePrecision "
                  + "of controlDict is now " + time.timeName()
                  + "\n    Put these entries back, or rename the directory";
            }
        }

        return string();
    }
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::checkpoint::checkpoint(const Time& time)
:
    path_(time.path()/time.timeName())
{
    const List<string> marks(fromAllRanks(readMark(path_)));
    const fileName name(path_/markFile);
    const dictionary mark(parsed(marks[Pstream::myProcNo()], name));

    for (label ranki = 0; notes_.empty() && ranki < marks.size(); ++ranki)
    {
        notes_ = parsed(marks[ranki], name);
    }

    const bool all = !marks.found(string());
    const bool copies = copied(mark, path_);

    // Where ranks share a file the folder is another, and asking is collective
    const bool shared = isDir(fileHandler().filePath(path_/cellFolder));
    const bool some = returnReduce(shared || begun(path_), orOp<bool>());

    string complaint;
    if (!some)
    {
        complaint = findOtherName(time);
    }
    else if (!all && !copies)
    {
        complaint = "time " + time.timeName() + " was not written to its end";
    }
    else if (found() && !copies)
    {
        complaint = findDamage(mark, path_);
    }

    if (some && !complaint.empty())
    {
        complaint +=
            "\n    Remove the directory " + time.timeName()
          + (Pstream::parRun() ? " of every processor" : "")
          + " to go on from an earlier time";
    }

    // The first of any rank, said once
    const List<string> complaints(gathered(complaint));
    const masterGate once;

    for (const string& text : complaints)
    {
        if (!text.empty())
        {
            FatalErrorInFunction << text.c_str() << exit(FatalError);
        }
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::fileName Foam::checkpoint::unfinishedFlow(const fileName& path)
{
    return path/"U.unfinished";
}


Foam::dictionary Foam::checkpoint::notesOf(const polyMesh& mesh)
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
    dictionary patches;
    for (const polyPatch& pp : mesh.boundaryMesh())
    {
        dictionary patch;
        patch.add("type", pp.type());
        patch.add("start", pp.start());
        patch.add("faces", pp.size());
        patches.add(pp.name(), patch);
    }

    dictionary dict;
    dict.add("cells", mesh.nCells());
    dict.add("digest", string(digest.str()));
    dict.add("patches", patches);
    return dict;
}


void Foam::checkpoint::checkMesh(const dictionary& notesNow) const
{
    if (!found())
    {
        return;
    }

    const string text(difference(notes_.subDict("mesh"), notesNow));

    if (!text.empty())
    {
        FatalErrorInFunction
            << path_ << " holds cells of another mesh:" << text.c_str() << nl
            << "    Put the mesh back, or start again from the first time"
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

    for (auto time = times.rbegin(); std::next(time) != times.rend(); ++time)
    {
        const word& name = time->second;
        const fileName path(args.path()/name);
        const dictionary mark(parsed(readMark(path), path/markFile));
        const bool other = isFile(path/"U") || isDir(path/"polyMesh");

        // Complete, or a flow or mesh to start from, or another program's
        if
        (
            copied(mark, path)
         || returnReduce(!mark.empty(), andOp<bool>())
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
            rmDir(path + ".incomplete", true);

            if (!mv(path, path + ".incomplete"))
            {
                FatalErrorInFunction
                    << "cannot rename " << path << ": remove it by hand"
                    << exit(FatalError);
            }
        }
        meet();
    }

    return times.empty() ? word::null : times.begin()->second;
}


void Foam::checkpoint::begin(const Time& time)
{
    const fileName path(time.path()/time.timeName());

    // A link of decomposePar leads into the undecomposed case, whose mark stays
    if (Foam::type(path/"uniform", false) == fileName::LINK)
    {
        rm(path/"uniform");
    }

    atomicWrite(path/unfinishedFile, "Not all of this time is written\n");
    meet();
    rm(path/markFile);
    rmDir(path/cellFolder, true);
    rmDir(path/outputFolder, true);
}


void Foam::checkpoint::end(const Time& time, const dictionary& notes)
{
    const fileName path(time.path()/time.timeName());
    dictionary files;

    for (const fileName& name : readDir(path/cellFolder))
    {
        const std::string text(textOf(path/cellFolder/name));
        dictionary file;
        file.add("bytes", scalar(text.size()));
        file.add("digest", string(SHA1(text).str()));
        files.add(word(name), file);
    }

    dictionary mark(notes);
    mark.add("rank", Pstream::myProcNo());
    mark.add("ranks", Pstream::nProcs());
    mark.add("files", files);

    // No mark before all ranks have written
    meet();
    atomicWrite(path/markFile, mark);
    rm(path/unfinishedFile);
}


// ************************************************************************* //
