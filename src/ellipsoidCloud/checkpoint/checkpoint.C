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
#include "IFstream.H"
#include "OSspecific.H"
#include "polyMesh.H"
#include "PstreamReduceOps.H"
#include "SHA1.H"
#include "SortableList.H"
#include "StringStream.H"
#include "Time.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- All ranks have come so far
    static void meet()
    {
        label all = 1;
        reduce(all, sumOp<label>());
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
        digest.append
        (
            reinterpret_cast<const char*>(list.cdata()),
            list.size()*sizeof(Type)
        );
    }

    //- Is the run to go on from the latest time there is?
    static bool fromLatestTime(const argList& args)
    {
        bool latest = false;

        if (Pstream::master())
        {
            IFstream is
            (
                args.rootPath()/args.globalCaseName()/"system"/"controlDict"
            );

            // What is wrong with it the Time will say
            latest =
                is.good()
             && dictionary(is).getOrDefault<word>("startFrom", "latestTime")
             == "latestTime";
        }
        Pstream::scatter(latest);

        return latest;
    }

    //- Names of the time directories of all ranks, in ascending order
    static wordList timeNames(const fileName& path)
    {
        List<wordList> all(Pstream::nProcs());

        DynamicList<word> mine;
        for (const fileName& name : readDir(path, fileName::DIRECTORY))
        {
            scalar value;
            if (readScalar(name.c_str(), value))
            {
                mine.append(name);
            }
        }
        all[Pstream::myProcNo()].transfer(mine);

        Pstream::gatherList(all);
        Pstream::scatterList(all);

        DynamicList<word> names;
        for (const wordList& some : all)
        {
            for (const word& name : some)
            {
                if (!names.found(name))
                {
                    names.append(name);
                }
            }
        }

        scalarList values(names.size());
        forAll(names, i)
        {
            readScalar(names[i].c_str(), values[i]);
        }

        return wordList(names, SortableList<scalar>(values).indices());
    }
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::fileName Foam::checkpoint::markFile(const fileName& path)
{
    return path/"uniform"/"ellipsoidCloudFiles";
}


Foam::fileName Foam::checkpoint::unfinishedFile(const fileName& path)
{
    return path/"uniform"/"ellipsoidCloudUnfinished";
}


Foam::fileName Foam::checkpoint::cellFolder(const fileName& path)
{
    return path/cloud::prefix/"ellipsoidCloud";
}


Foam::dictionary Foam::checkpoint::readMark(const fileName& path)
{
    fileName file(markFile(path));

    if (sharedFiles() && !isFile(file))
    {
        // Where decomposePar puts a copy
        const word parts("processors" + Foam::name(Pstream::nProcs()));
        file = markFile(path.path().path()/parts/path.name());
    }

    if (!isFile(file))
    {
        return dictionary();
    }

    IFstream is(file);
    return dictionary(is);
}


bool Foam::checkpoint::isCopy
(
    const dictionary& mark,
    const fileName& path
)
{
    return
        !mark.empty()
     && (
            Foam::type(path/"uniform", false) == fileName::LINK
         || mark.get<label>("rank") != Pstream::myProcNo()
         || mark.get<label>("ranks") != Pstream::nProcs()
        );
}


bool Foam::checkpoint::begun(const fileName& path)
{
    return
        isFile(markFile(path))
     || isFile(unfinishedFile(path))
     || isDir(cellFolder(path));
}


Foam::string Foam::checkpoint::findDamage() const
{
    for (const entry& e : mark_.subDict("files"))
    {
        const fileName file(cellFolder(path_)/e.keyword());
        const fileContent found(file);
        const scalar bytes = e.dict().get<scalar>("bytes");

        if (!isFile(file))
        {
            return file + " is missing";
        }
        if (found.bytes != bytes)
        {
            return
                file + " is damaged: it holds "
              + Foam::name(int64_t(found.bytes)) + " bytes where "
              + Foam::name(int64_t(bytes)) + " were written";
        }
        if (found.digest != e.dict().get<string>("digest"))
        {
            return file + " is damaged: it is not what was written";
        }
    }

    return string();
}


Foam::string Foam::checkpoint::findOtherName(const Time& time)
{
    for (const word& name : timeNames(time.path()))
    {
        scalar value;
        readScalar(name.c_str(), value);

        if
        (
            name != time.timeName()
         && mag(value - time.value()) < 1e-6*time.deltaTValue()
         && begun(time.path()/name)
        )
        {
            return
                "the cells of this time are in the directory " + name
              + ", which by timeFormat and timePrecision of controlDict is now "
              + time.timeName() + "\n"
              + "    Put these entries back, or rename the directory";
        }
    }

    return string();
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::checkpoint::checkpoint(const Time& time)
:
    path_(time.path()/time.timeName()),
    mark_(readMark(path_)),
    notes_()
{
    // What the first rank has that has any
    List<string> marks(Pstream::nProcs());
    if (!mark_.empty())
    {
        OStringStream os;
        os.precision(17);
        mark_.write(os, false);
        marks[Pstream::myProcNo()] = os.str();
    }
    Pstream::gatherList(marks);
    Pstream::scatterList(marks);

    bool all = true;
    for (const string& mark : marks)
    {
        all = all && !mark.empty();

        if (notes_.empty() && !mark.empty())
        {
            IStringStream is(mark);
            notes_ = dictionary(is);
        }
    }

    const bool copies = returnReduce(isCopy(mark_, path_), orOp<bool>());

    // Where ranks share a file the folder is another, and asking is collective
    const bool shared = isDir(fileHandler().filePath(cellFolder(path_)));
    const bool some = returnReduce(shared || begun(path_), orOp<bool>());

    // The first complaint of any rank, said once
    List<string> complaints(Pstream::nProcs());
    string& complaint = complaints[Pstream::myProcNo()];

    if (!some)
    {
        complaint = findOtherName(time);
    }
    else if (!all && !copies)
    {
        complaint =
            "time " + time.timeName() + " was not written to its end";
    }
    else if (found() && !copies)
    {
        complaint = findDamage();
    }

    if (some && !complaint.empty())
    {
        complaint +=
            "\n    Remove the directory " + time.timeName()
          + (Pstream::parRun() ? " of every processor" : "")
          + " to go on from an earlier time";
    }

    Pstream::gatherList(complaints);
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


void Foam::checkpoint::checkMesh(const polyMesh& whole) const
{
    if (!found())
    {
        return;
    }

    const dictionary& then = notes_.subDict("mesh");
    const dictionary now(notesOf(whole));
    const dictionary& patchesThen = then.subDict("patches");
    const dictionary& patchesNow = now.subDict("patches");

    OStringStream difference;

    if (then.get<string>("digest") != now.get<string>("digest"))
    {
        difference
            << "it had " << then.get<label>("cells")
            << " mesh cells, this one has " << whole.nCells();
    }
    else if (patchesThen.toc() != patchesNow.toc())
    {
        difference
            << "its patches were " << flatOutput(patchesThen.toc())
            << ", now they are " << flatOutput(patchesNow.toc());
    }
    else
    {
        for (const word& name : patchesThen.toc())
        {
            const dictionary& was = patchesThen.subDict(name);
            const dictionary& is = patchesNow.subDict(name);

            if (was != is)
            {
                difference
                    << "patch " << name << " was of type "
                    << was.get<word>("type") << " with "
                    << was.get<label>("faces") << " faces, and is now of type "
                    << is.get<word>("type") << " with "
                    << is.get<label>("faces");
                break;
            }
        }
    }

    if (!difference.str().empty())
    {
        FatalErrorInFunction
            << path_ << " holds cells of another mesh: "
            << difference.str().c_str() << nl
            << "    Put the mesh back, or start again from the first time"
            << exit(FatalError);
    }
}


void Foam::checkpoint::setAsideIncomplete(const argList& args)
{
    // Where ranks share files, times without their end are refused, not moved
    if (!fromLatestTime(args) || sharedFiles())
    {
        return;
    }

    const fileName folder
    (
        args.rootPath()/args.globalCaseName()
       /"postProcessing"/"ellipsoidCloud"
    );

    bool tracked = isDir(folder);
    Pstream::scatter(tracked);

    const wordList names(timeNames(args.path()));

    for (label i = names.size() - 1; i > 0; --i)
    {
        const fileName path(args.path()/names[i]);

        const dictionary mark(readMark(path));
        const bool other = isFile(path/"U") || isDir(path/"polyMesh");

        if (returnReduce(isCopy(mark, path), orOp<bool>()))
        {
            // decomposePar makes no directory where there are no cells, but
            // ranks have to start from the same time
            mkDir(path);
            meet();
            return;
        }

        if (returnReduce(!mark.empty(), andOp<bool>()))
        {
            return;
        }

        // A flow or mesh to start from, or another program's
        if
        (
            !returnReduce(begun(path), orOp<bool>())
         && (!tracked || returnReduce(other, orOp<bool>()))
        )
        {
            return;
        }

        Info<< "ellipsoidCloud: time " << names[i]
            << " was not written to its end: set aside as " << names[i]
            << ".incomplete, going on from " << names[i - 1] << endl;

        if (isDir(path))
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
}


void Foam::checkpoint::begin(const Time& time)
{
    const fileName path(time.path()/time.timeName());

    // A link of decomposePar leads into the undecomposed case, whose mark stays
    if (Foam::type(path/"uniform", false) == fileName::LINK)
    {
        rm(path/"uniform");
    }

    leaveNote(unfinishedFile(path));
    meet();
    rm(markFile(path));
    rmDir(cellFolder(path), true);
}


void Foam::checkpoint::end(const Time& time, const dictionary& notes)
{
    const fileName path(time.path()/time.timeName());
    dictionary files;

    for (const fileName& name : readDir(cellFolder(path)))
    {
        const fileContent written(cellFolder(path)/name);

        if (!written.ended)
        {
            cannotWrite(cellFolder(path)/name);
        }

        dictionary file;
        file.add("bytes", written.bytes);
        file.add("digest", written.digest);
        files.add(word(name), file);
    }

    dictionary mark(notes);
    mark.add("rank", Pstream::myProcNo());
    mark.add("ranks", Pstream::nProcs());
    mark.add("files", files);

    // No mark before all ranks have written
    meet();
    writeWhole(mark, markFile(path));
    rm(unfinishedFile(path));
}


// ************************************************************************* //
