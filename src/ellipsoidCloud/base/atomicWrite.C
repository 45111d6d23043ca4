// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "atomicWrite.H"
#include "IFstream.H"
#include "OFstream.H"
#include "OSspecific.H"
#include "regIOobject.H"
#include "StringStream.H"
#include "Time.H"

#include <cstdio>
#include <cstring>
#include <sstream>

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


void Foam::cannotWrite(const fileName& file, const int reason)
{
    FatalErrorInFunction
        << "cannot write " << file << ": "
        << (reason ? std::strerror(reason) : "its end is missing")
        << exit(FatalError);
}


void Foam::atomicWrite
(
    const fileName& file,
    const std::string& text,
    const IOstream::compressionType compression
)
{
    const fileName part(file + ".part");

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

    // OpenFOAM's own functions take a file and its compressed form for one
    const bool zipped = compression == IOstream::COMPRESSED;
    const std::string suffix(zipped ? ".gz" : "");

    if (std::rename((part + suffix).c_str(), (file + suffix).c_str()))
    {
        cannotWrite(file);
    }
    std::remove((file + (zipped ? "" : ".gz")).c_str());
}


void Foam::atomicWrite(regIOobject& object, const bool valid)
{
    const Time& time = object.time();
    const unsigned int precision = IOstream::defaultPrecision(17);

    object.instance() = time.timeName();

    if (fileHandler().type() != "uncollated")
    {
        if (!object.write(valid))
        {
            cannotWrite(object.objectPath());
        }
    }
    else if (valid)
    {
        OStringStream os;
        os.format(time.writeFormat());
        os.version(time.writeVersion());
        object.writeHeader(os);
        object.writeData(os);
        IOobject::writeEndDivider(os);
        atomicWrite(object.objectPath(), os.str(), time.writeCompression());
    }

    IOstream::defaultPrecision(precision);
}
