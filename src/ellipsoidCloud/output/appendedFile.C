// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "appendedFile.H"
#include "atomicWrite.H"
#include "error.H"
#include "OSspecific.H"

#include <cmath>
#include <cstdio>
#include <unistd.h>

// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

std::string Foam::tableSet::timeText
(
    const scalar t,
    const int digits,
    const scalar part
) const
{
    const scalar parts = max(mag(t)/(part*interval), scalar(1));
    const int needed = int(std::ceil(std::log10(parts)));

    // A double has no more than fifteen
    char text[32];
    std::snprintf(text, sizeof(text), "%.*g", max(digits, min(needed, 15)), t);
    return text;
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::appendedFile::appendedFile
(
    const tableSet& set,
    const word& name,
    const std::string& header,
    const int precision
)
:
    name_(set.folder/(name + ".csv"))
{
    const dictionary earlier(set.earlier.subOrEmptyDict(name));

    if (Pstream::master())
    {
        size_ = earlier.getOrDefault<scalar>("bytes", 0);
    }
    buffer_.precision(precision);
    digest_ = digestOf(name_, size_);

    if (size_ == 0)
    {
        buffer_ << header << '\n';
    }
    else if (digest_.str() != earlier.get<string>("digest"))
    {
        FatalErrorInFunction
            << "cannot go on with " << name_ << ": its first "
            << int64_t(size_) << " bytes are not what was written" << nl
            << "    Put it back, or go on from an earlier time, by startFrom"
            << " startTime and startTime in system/controlDict"
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
    if (file_.is_open())
    {
        toDisk(name_);
    }

    dictionary dict;
    dict.add("bytes", size_);
    dict.add("digest", string(digest_.str()));
    return dict;
}


void Foam::appendedFile::forRows
(
    const std::function<void(const std::string&)>& act
) const
{
    std::ifstream is(name_);
    std::string line;
    scalar left = size_;
    bool header = true;

    while (left > 0 && std::getline(is, line))
    {
        left -= line.size() + 1;
        if (!header)
        {
            act(line);
        }
        header = false;
    }
}
