// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "appendedFile.H"
#include "atomicWrite.H"
#include "error.H"
#include "OSspecific.H"
#include "foamVersions.H"

#include <unistd.h>

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::appendedFile::appendedFile
(
    const tableSet& set,
    const word& name,
    const std::string& header,
    const int precision
)
:
    name_(set.folder/(name + ".csv")),
    size_(0)
{
    const dictionary earlier(set.earlier.subOrEmptyDict(name));

    if (Pstream::master())
    {
        size_ = earlier.getOrDefault<scalar>("bytes", 0);
    }
    buffer_.precision(precision);
    digest_.append(text());

    if (size_ == 0)
    {
        buffer_ << header << '\n';
    }
    else if (digest_.str() != earlier.get<string>("digest"))
    {
        FatalErrorInFunction
            << "cannot go on with " << name_ << ": its first "
            << int64_t(size_) << " bytes are not what was written" << nl
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

    mkDir(name_.path());
    if (size_ > 0 && ::truncate(name_.c_str(), off_t(size_)))
    {
        cannotWrite(name_);
    }

    file_.open(name_, size_ > 0 ? std::ios::app : std::ios::out);
    flush();
}


void Foam::appendedFile::flush()
{
    const std::string text(buffer_.str());
    buffer_.str("");

    file_ << text << std::flush;

    if (!file_)
    {
        cannotWrite(name_);
    }

    size_ += text.size();
    digest_.append(text);
}


Foam::dictionary Foam::appendedFile::notes()
{
    scalar size = size_;
    string digits(digest_.str());
    broadcast(size);
    broadcast(digits);

    dictionary dict;
    dict.add("bytes", size);
    dict.add("digest", digits);
    return dict;
}


std::string Foam::appendedFile::text() const
{
    return size_ > 0 ? textOf(name_).substr(0, std::size_t(size_)) : "";
}
