// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "listedCells.H"
#include "atomicWrite.H"
#include "checkedEntries.H"
#include "csvFields.H"
#include "FlatOutput.H"
#include "stringOps.H"

#include <algorithm>
#include <fstream>
#include <sstream>

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- The fields of the first line of a file, and the lines after it
    struct listedFile
    {
        const dictionary& dict;
        const fileName name;
        std::vector<std::string> head;
        std::vector<std::string> lines;

        //- Read what the entry file of an injection names
        listedFile(const dictionary& injection, const fileName& caseFolder)
        :
            dict(injection),
            name(path(injection.get<fileName>("file"), caseFolder))
        {
            std::ifstream is(name);
            std::string text;
            for (label line = 1; std::getline(is, text); ++line)
            {
                // As spreadsheets write it, too
                if (line == 1 && text.compare(0, 3, "\xEF\xBB\xBF") == 0)
                {
                    text.erase(0, 3);
                }
                if (text.size() && text.back() == '\r')
                {
                    text.pop_back();
                }
                lines.push_back(text);
            }
            if (lines.empty())
            {
                refuse(1, "cannot be read, or is empty");
            }
            for (const std::string& column : csvFields(lines.front()))
            {
                head.push_back(stringOps::lower(stringOps::trim(column)));
            }
            lines.erase(lines.begin());
            if (std::all_of(lines.begin(), lines.end(), isBlank))
            {
                refuse(1, "no line of a cell follows");
            }
        }

        //- Does a line have nothing, or, as spreadsheets write it, separators alone?
        static bool isBlank(const std::string& line)
        {
            return line.find_first_not_of(", \t") == std::string::npos;
        }

        static fileName path(fileName file, const fileName& caseFolder)
        {
            file.expand();
            return file.isAbsolute() ? file : caseFolder/file;
        }

        //- End the run because of a line
        void refuse(const std::size_t line, const std::string& why) const
        {
            FatalIOErrorInFunction(streamOf(dict, "file"))
                << name.c_str() << ", line " << label(line) << ": "
                << why.c_str() << exit(FatalIOError);
        }

        //- The places of those of these columns that there are
        std::vector<std::size_t> placesOf(const wordList& columns) const
        {
            std::vector<std::size_t> places;
            for (const word& column : columns)
            {
                const auto at = std::find(head.begin(), head.end(), column);
                if (at != head.end())
                {
                    if (std::count(at, head.end(), column) > 1)
                    {
                        refuse(1, "two columns are named " + column);
                    }
                    places.push_back(at - head.begin());
                }
            }

            return places;
        }

        //- Write the numbers in these places, those of a line in brackets if
        //  they are several
        void write(const std::vector<std::size_t>& places, std::ostream& os) const
        {
            for (std::size_t i = 0; i < lines.size(); ++i)
            {
                // Kept for the numbers of the lines after it
                if (isBlank(lines[i]))
                {
                    continue;
                }

                const std::vector<std::string> fields(csvFields(lines[i]));
                if (fields.size() != head.size())
                {
                    refuse
                    (
                        i + 2,
                        std::to_string(fields.size())
                      + " fields, but the head has "
                      + std::to_string(head.size())
                    );
                }

                os << (places.size() > 1 ? "(" : "");
                for (const std::size_t place : places)
                {
                    scalar value = 0;
                    if (!isNumber(fields[place], value))
                    {
                        refuse
                        (
                            i + 2,
                            head[place] + " is no number: " + fields[place]
                        );
                    }
                    os << value << ' ';
                }
                os << (places.size() > 1 ? ")\n" : "\n");
            }
        }
    };

    //- Put the lists of a file into an injection
    static void fill(dictionary& dict, const fileName& caseFolder)
    {
        const struct
        {
            word entry;
            wordList columns;
        }
        lists[] =
        {
            {"positions", {"x1", "x2", "x3"}},
            {"orientations", {"eps1", "eps2", "eps3", "eta"}},
            {"sizes", {"length", "width"}},
            {"densities", {"density"}}
        };

        for (const auto& list : lists)
        {
            if (dict.found(list.entry))
            {
                FatalIOErrorInFunction(streamOf(dict, list.entry))
                    << list.entry << " is not read with file"
                    << exit(FatalIOError);
            }
        }

        const listedFile file(dict, caseFolder);
        std::ostringstream entries;
        entries.precision(17);
        for (const auto& list : lists)
        {
            const std::vector<std::size_t> places(file.placesOf(list.columns));
            const bool turned =
                list.entry == "orientations" && dict.found("orientation");

            if (turned || (places.empty() && list.entry != "positions"))
            {
                continue;
            }
            if (label(places.size()) != list.columns.size())
            {
                FatalIOErrorInFunction(streamOf(dict, "file"))
                    << file.name.c_str() << ", line 1: the head must name all of"
                    << " the columns " << flatOutput(list.columns)
                    << ", separated by commas; its first is "
                    << file.head.front().c_str() << exit(FatalIOError);
            }
            entries << list.entry << "\n(\n";
            file.write(places, entries);
            entries << ");\n";
        }

        dict.remove("file");
        dict.merge(dictionaryOf(entries.str(), dict.name()));
    }
}


// * * * * * * * * * * * * * * * Global Functions  * * * * * * * * * * * * * //

void Foam::listedCells::read(dictionary& injections, const fileName& caseFolder)
{
    for (const word& name : injections.toc())
    {
        const dictionary* dict = injections.findDict(name, keyType::LITERAL);

        if
        (
            dict && dict->found("file")
         && dict->getOrDefault<word>("type", word()) == "positions"
        )
        {
            fill(injections.subDict(name), caseFolder);
        }
    }
}
