// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "flowFields.H"
#include "atomicWrite.H"
#include "dictionary.H"
#include "fileOperation.H"
#include "flowChecks.H"
#include "fvMesh.H"
#include "PstreamReduceOps.H"
#include "SHA1.H"
#include "StringStream.H"
#include "Time.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- Of U, p and phi, in the order that they are written
    static const wordList fieldNames({"phi", "p", "U"});

    //- In the file of an unfinished flow: what is left to do is to rename
    static const std::string wholeParts
    (
        "The flow is all written, in the files NAME.part\n"
    );

    //- What names the files of a time that this class has written
    static fileName digestsFile(const fileName& path)
    {
        return path/"uniform"/"steadyFlow";
    }

    //- What that says
    static dictionary digestsOf(const fileName& path)
    {
        return dictionaryOf(textOf(digestsFile(path)), digestsFile(path));
    }

    static string digest(const fileName& file)
    {
        return SHA1(textOf(file)).str();
    }

    //- Has flowFields written the file of a field, as it is now?
    static bool isOwn(const fileName& path, const word& name)
    {
        return
            digestsOf(path).getOrDefault<string>(name, "") == digest(path/name);
    }

    static void moveAside(const fileName& file, const char* how)
    {
        if (!mvBak(file, "bak"))
        {
            cannotWrite(file);
        }
        Info<< "flow: " << (file.path().name()/file.name()).c_str() << " as it"
            << " was " << how << " is kept as " << file.name().c_str() << ".bak"
            << endl;
    }

    //- Move the file of a field away that is neither our own nor a copy of that
    //  in 0.orig, and one that was not read beside it
    static void setAside(const fileName& path, const word& name)
    {
        const fileName plain(path/name);
        const fileName zipped(plain + ".gz");
        const bool isPlain = isFile(plain, false);
        const std::string text(textOf(plain));

        if (isPlain && isFile(zipped, false))
        {
            moveAside(zipped, "found beside it");
        }
        if
        (
            text.empty()
         || isOwn(path, name)
         || text == textOf(path.path()/"0.orig"/name)
        )
        {
            return;
        }
        moveAside(isPlain ? plain : zipped, "read");
    }

    //- Give what is written in a time its names, and the time its digests
    static void nameParts(const fileName& path)
    {
        dictionary written;
        written.set("ranks", Pstream::nProcs());

        for (const word& name : fieldNames)
        {
            if (isFile(partOf(path/name)))
            {
                setAside(path, name);
                renamePart(path/name);
            }
            written.set(name, digest(path/name));
        }
        // decomposePar links the folder of the whole case
        if ((path/"uniform").type(false) == fileName::LINK)
        {
            rm(path/"uniform");
        }
        OStringStream os;
        written.write(os, false);
        IOobject::writeEndDivider(os);
        durableWrite(digestsFile(path), os.str());

        waitForRanks();
        rm(unfinishedFlow(path));
    }

} // End namespace Foam


// * * * * * * * * * * * *  Protected Member Functions * * * * * * * * * * * //

bool Foam::flowFields::unfinished() const
{
    const fileName path(mesh_.time().path()/instance_);

    return returnReduce(isFile(unfinishedFlow(path)), orOp<bool>());
}


bool Foam::flowFields::foreign() const
{
    // Digests that decomposePar links or reconstructPar copies are of the files
    // that it started from; U and p may have been edited, their boundary
    // conditions
    const fileName path(mesh_.time().path()/instance_);
    const bool copied =
        (path/"uniform").type(false) == fileName::LINK
     || (
            isFile(digestsFile(path))
         && digestsOf(path).getOrDefault<label>("ranks", 0)
         != Pstream::nProcs()
        );

    return returnReduce
    (
        hasFlux_ && !unfinished() && !copied && !isOwn(path, phi_.name()),
        orOp<bool>()
    );
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::flowFields::finishWriting(const Time& time)
{
    const fileName path(time.path()/time.timeName());
    const bool whole = textOf(unfinishedFlow(path)) == wholeParts;

    if (returnReduce(whole, orOp<bool>()))
    {
        Info<< "flow: the files of " << time.timeName() << ", all written when"
            << " a run was interrupted, get their names" << endl;
        nameParts(path);
        return;
    }
    for (const word& name : fieldNames)
    {
        rm(partOf(path/name));
    }
}


void Foam::flowFields::write()
{
    const word& instance = mesh_.time().timeName();
    const fileName path(mesh_.time().path()/instance);
    const fileName unfinished(unfinishedFlow(path));

    if (fileHandler().type() == "uncollated")
    {
        writePart(phi_);
        writePart(p_);
        writePart(U_);
        for (const word& name : fieldNames)
        {
            toDisk(partOf(path/name));
        }
        // What was read stays until all ranks have come so far
        waitForRanks();
        durableWrite(unfinished, wholeParts);
    }
    else if (hasFlux_)
    {
        FatalErrorInFunction
            << "A flow in files that ranks share cannot be kept beside the new"
            << " one: move U, p and phi of " << instance << " elsewhere, or"
            << " solve with -fileHandler uncollated" << exit(FatalError);
    }
    else
    {
        for (const word& name : fieldNames)
        {
            setAside(path, name);
        }
        atomicWrite(unfinished, "Not all of the flow is written\n");
        atomicWrite(phi_);
        atomicWrite(p_);
        atomicWrite(U_);
    }
    nameParts(path);

    Info<< "flow: written to " << instance << endl;
}
