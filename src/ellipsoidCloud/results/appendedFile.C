/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/
#include "appendedFile.H"
#include "atomicWrite.H"
#include "error.H"
#include "OSspecific.H"
#include "Pstream.H"

#include <cerrno>
#include <unistd.h>
#include <vector>

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::appendedFile::digest(const scalar size)
{
    std::ifstream is(name_, std::ios::binary);
    is.seekg(std::streamoff(digested_));

    std::vector<char> block(1 << 16);

    while (is && digested_ < size)
    {
        is.read(block.data(), min(scalar(block.size()), size - digested_));
        digest_.append(block.data(), is.gcount());
        digested_ += is.gcount();
    }
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::appendedFile::appendedFile
(
    const fileName& name,
    const std::string& header,
    const int precision,
    const dictionary& earlier
)
:
    name_(name),
    header_(header),
    earlier_(earlier.getOrDefault<scalar>("bytes", 0)),
    file_(),
    digest_(),
    digested_(0)
{
    file_.precision(precision);

    if (!Pstream::master() || earlier_ <= 0)
    {
        return;
    }

    digest(earlier_);

    if (digested_ < earlier_)
    {
        FatalErrorInFunction
            << "cannot go on with " << name_ << ": it should hold "
            << int64_t(earlier_) << " bytes at least" << nl
            << "    Put it back, or start again from the first time"
            << exit(FatalError);
    }

    if (digest_.str() != earlier.get<string>("digest"))
    {
        FatalErrorInFunction
            << "cannot go on with " << name_ << ": its first "
            << int64_t(earlier_) << " bytes are not what was written" << nl
            << "    Put it back, or start again from the first time"
            << exit(FatalError);
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::appendedFile::open()
{
    if (!Pstream::master())
    {
        return;
    }

    if (earlier_ > 0)
    {
        if (::truncate(name_.c_str(), off_t(earlier_)))
        {
            cannotWrite(name_, errno);
        }

        // At its end from the beginning: where that is, is noted at the next
        // write time even if there was nothing to append
        file_.open(name_, std::ios::app | std::ios::ate);
    }
    else
    {
        mkDir(name_.path());
        file_.open(name_);
        file_ << header_ << '\n';
    }

    flush();
}


void Foam::appendedFile::flush()
{
    file_.flush();

    if (!file_)
    {
        cannotWrite(name_, errno);
    }
}


Foam::dictionary Foam::appendedFile::notes()
{
    scalar size = 0;
    string digits;

    if (Pstream::master())
    {
        size = scalar(file_.tellp());
        digest(size);
        digits = digest_.str();
    }
    Pstream::scatter(size);
    Pstream::scatter(digits);

    dictionary dict;
    dict.add("bytes", size);
    dict.add("digest", digits);
    return dict;
}


// ************************************************************************* //
