// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "atomicWrite.H"
#include "IFstream.H"
#include "OFstream.H"
#include "OSspecific.H"
#include "Pstream.H"
#include "PstreamReduceOps.H"
#include "regIOobject.H"
#include "StringStream.H"
#include "Time.H"

#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <sstream>
#include <unistd.h>
#include <vector>

// * * * * * * * * * * * * * * * Global Functions  * * * * * * * * * * * * * //

std::string Foam::textOf(const fileName& file)
{
    std::ostringstream text;

    if (isFile(file))
    {
        text << IFstream(file)().stdStream().rdbuf();
    }

    return text.str();
}


Foam::dictionary Foam::dictionaryOf
(
    const std::string& text,
    const fileName& name
)
{
    IStringStream is(text);
    is.name() = name;
    is.lineNumber() = 1;

    return dictionary(is);
}


Foam::SHA1 Foam::digestOf(const fileName& file, const scalar size)
{
    SHA1 digest;
    std::ifstream is(file, std::ios::binary);
    std::vector<char> part(1 << 20);

    for (scalar left = size; left > 0 && is; left -= is.gcount())
    {
        is.read(part.data(), std::streamsize(min(left, scalar(part.size()))));
        digest.append(part.data(), std::size_t(is.gcount()));
    }

    return digest;
}


void Foam::waitForRanks()
{
    returnReduce(true, andOp<bool>());
}


void Foam::cannotWrite(const fileName& file, const int reason)
{
    FatalErrorInFunction
        << "cannot write " << file << ": "
        << (reason ? std::strerror(reason) : "its end is missing")
        << exit(FatalError);
}


void Foam::checkLinks(const fileName& path)
{
    for (fileName part(path); part.size() > 1; part = part.path())
    {
        if (part.type(false) == fileName::LINK && !exists(part))
        {
            FatalErrorInFunction
                << part << " is a symbolic link to a folder that is missing"
                << nl << "    Make that folder, or remove the link"
                << exit(FatalError);
        }
    }
}


void Foam::toDisk(const fileName& file)
{
    const std::string path(file + (isFile(file, false) ? "" : ".gz"));
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);

    if (descriptor < 0 || ::fsync(descriptor))
    {
        cannotWrite(file);
    }
    ::close(descriptor);
}


Foam::fileName Foam::partOf(const fileName& file)
{
    return file + ".part";
}


void Foam::writePart
(
    const fileName& file,
    const std::string& text,
    const IOstream::compressionType compression
)
{
    const fileName part(partOf(file));

    checkLinks(file.path());
    mkDir(file.path());
    {
        #if OPENFOAM >= 2206
        OFstream os(part, IOstreamOption(IOstream::ASCII, compression));
        #else
        OFstream os
        (
            part, IOstream::ASCII, IOstream::currentVersion, compression
        );
        #endif

        if (os.good())
        {
            errno = 0;
        }
        os.stdStream() << text << std::flush;
    }

    const int reason = errno;

    if (textOf(part) != text)
    {
        rm(part);
        cannotWrite(file, reason);
    }
}


void Foam::writePart(regIOobject& object)
{
    const Time& time = object.time();
    const exactDigits exact;

    object.instance() = time.timeName();

    OStringStream os;
    os.format(time.writeFormat());
    os.version(time.writeVersion());
    object.writeHeader(os);
    object.writeData(os);
    IOobject::writeEndDivider(os);
    writePart(object.objectPath(), os.str(), time.writeCompression());
}


void Foam::renamePart(const fileName& file)
{
    // OpenFOAM's own functions take a file and its compressed form for one
    const fileName part(partOf(file));
    const bool zipped = !isFile(part, false);
    const std::string suffix(zipped ? ".gz" : "");

    if (std::rename((part + suffix).c_str(), (file + suffix).c_str()))
    {
        cannotWrite(file);
    }
    std::remove((file + (zipped ? "" : ".gz")).c_str());
}


void Foam::atomicWrite(const fileName& file, const std::string& text)
{
    writePart(file, text);
    renamePart(file);
}


void Foam::atomicWrite
(
    const fileName& file,
    const std::function<void(std::ostream&)>& write
)
{
    const fileName part(partOf(file));

    checkLinks(file.path());
    mkDir(file.path());
    errno = 0;
    std::ofstream os(part);
    if (os)
    {
        write(os);
        os.close();
    }

    if (!os)
    {
        const int reason = errno;
        rm(part);
        cannotWrite(file, reason);
    }
    renamePart(file);
}


void Foam::durableWrite
(
    const fileName& file,
    const std::string& text,
    const IOstream::compressionType compression
)
{
    writePart(file, text, compression);
    toDisk(partOf(file));
    renamePart(file);
}


void Foam::atomicWrite(regIOobject& object, const bool valid)
{
    if (fileHandler().type() == "uncollated")
    {
        if (valid)
        {
            writePart(object);
            renamePart(object.objectPath());
        }
        return;
    }

    const exactDigits exact;
    object.instance() = object.time().timeName();
    if (!object.write(valid))
    {
        cannotWrite(object.objectPath());
    }
}
