/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/
#include "atomicWrite.H"
#include "dictionary.H"
#include "IFstream.H"
#include "OFstream.H"
#include "OSspecific.H"
#include "regIOobject.H"
#include "SHA1.H"
#include "Time.H"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- Where a file is written to before it is whole
    static fileName partOf(const fileName& file)
    {
        return file + ".part";
    }

    //- What the system says to writing a file, or another beside it; 0 if it
    //  does not mind
    static int objection(const fileName& file)
    {
        int at = ::open(file.c_str(), O_WRONLY | O_APPEND);

        if (at < 0 && errno != ENOENT)
        {
            return errno;
        }
        if (at >= 0)
        {
            ::close(at);
        }

        at = ::open(partOf(file).c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);

        if (at < 0)
        {
            return errno;
        }

        const std::vector<char> block(1 << 16);
        const auto write =
            [&]()
            {
                return
                    ::write(at, block.data(), block.size())
                 == ssize_t(block.size());
            };

        // If it takes a part, it says why to the next
        errno = 0;
        const bool done = (write() || write()) && ::fsync(at) == 0;
        const int reason = done ? 0 : errno;

        ::close(at);
        ::unlink(partOf(file).c_str());

        return reason;
    }

    //- Give a file that was written its own name; the reason is that of what
    //  it may lack
    static void rename
    (
        const fileName& part,
        const fileName& file,
        const int reason
    )
    {
        if (!fileContent(part).ended)
        {
            rm(part);
            cannotWrite(file, reason);
        }

        // Compressed or not, as the writing option has it
        const std::string suffix(isFile(part, false) ? "" : ".gz");
        const std::string other(suffix.empty() ? ".gz" : "");

        if
        (
            std::rename((part + suffix).c_str(), (file + suffix).c_str())
        )
        {
            cannotWrite(file, errno);
        }
        if (isFile(file + other, false))
        {
            rm(file + other);
        }
    }
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::fileContent::fileContent(const fileName& file)
:
    bytes(0),
    digest(),
    ended(false)
{
    IFstream is(file);

    if (!is.good())
    {
        return;
    }

    SHA1 sha;
    std::vector<char> block(1 << 16);
    std::string last;

    while (is.stdStream())
    {
        is.stdStream().read(block.data(), block.size());
        const std::size_t n = is.stdStream().gcount();

        sha.append(block.data(), n);
        bytes += n;
        last.append(block.data(), n);
        last.erase(0, last.size() - min(last.size(), std::size_t(100)));
    }

    digest = sha.str();

    // All but the blanks and the stars of the dividing line
    std::string line(last.substr(0, last.find_last_not_of(" \n") + 1));
    const std::size_t start = line.rfind('\n');
    ended =
        start != std::string::npos
     && line.compare(start + 1, 4, "// *") == 0
     && line.compare(line.size() - 2, 2, "//") == 0;
}


// * * * * * * * * * * * * * * * Global Functions  * * * * * * * * * * * * * //

Foam::fileName Foam::failedFile(const std::function<void()>& write)
{
    fileName file;
    int reason = 0;
    const bool throwing = FatalIOError.throwExceptions();

    try
    {
        write();
    }
    catch (const IOerror& error)
    {
        reason = errno;
        file = error.ioFileName();
    }

    if (!throwing)
    {
        FatalIOError.dontThrowExceptions();
    }
    if (!file.empty())
    {
        errno = reason;
    }

    return file;
}


void Foam::cannotWrite(const fileName& file, int reason)
{
    if (!reason)
    {
        reason = objection(file);
    }

    FatalErrorInFunction
        << "cannot write " << file << ": "
        << (reason ? std::strerror(reason) : "its end is missing")
        << exit(FatalError);
}


void Foam::leaveNote(const fileName& file)
{
    mkDir(file.path());
    std::ofstream os(file);
    os << "Not all of this time is written\n";

    if (!os.flush())
    {
        cannotWrite(file, errno);
    }
}


void Foam::writeWhole(const dictionary& dict, const fileName& file)
{
    mkDir(file.path());
    {
        OFstream os(partOf(file));
        os.precision(17);
        dict.write(os, false);
        IOobject::writeEndDivider(os);
    }
    rename(partOf(file), file, errno);
}


void Foam::writeWhole(regIOobject& object)
{
    const Time& time = object.time();

    object.instance() = time.timeName();

    // Where several ranks share a file OpenFOAM alone can write it
    if (fileHandler().type() != "uncollated")
    {
        object.write();
        return;
    }

    const fileName file(object.objectPath());

    mkDir(file.path());
    {
        #if OPENFOAM >= 2206
        OFstream os(partOf(file), time.writeStreamOption());
        #else
        OFstream os
        (
            partOf(file),
            time.writeFormat(),
            time.writeVersion(),
            time.writeCompression()
        );
        #endif

        // What fails lacks its end
        failedFile
        (
            [&]()
            {
                object.writeHeader(os);
                object.writeData(os);
                IOobject::writeEndDivider(os);
            }
        );
    }
    rename(partOf(file), file, errno);
}


// ************************************************************************* //
