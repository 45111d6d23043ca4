// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "listedCells.H"
#include "atomicWrite.H"
#include "checkedEntries.H"
#include "csvFields.H"
#include "FixedList.H"
#include "HashTable.H"
#include "pointField.H"

#include <fstream>

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    typedef HashTable<DynamicList<scalar>> columnTable;

    //- The next line, as spreadsheets write it, too
    static bool hasLine(std::istream& is, std::string& text)
    {
        const bool found(std::getline(is, text));

        if (text.compare(0, 3, "\xEF\xBB\xBF") == 0)
        {
            text.erase(0, 3);
        }
        if (text.size() && text.back() == '\r')
        {
            text.pop_back();
        }

        return found;
    }


    //- The columns of these names that a file has
    static columnTable columnsOf
    (
        const dictionary& dict,
        const fileName& file,
        const wordList& names
    )
    {
        const auto refuse = [&](const label line, const std::string& why)
        {
            FatalIOErrorInFunction(streamOf(dict, "file"))
                << file.c_str() << ", line " << line << ": " << why.c_str()
                << exit(FatalIOError);
        };

        std::ifstream is(file);
        std::string text;
        if (!hasLine(is, text))
        {
            refuse(1, "cannot be read, or is empty");
        }

        const std::vector<std::string> head(csvFields(text));
        columnTable found;
        for (const std::string& name : head)
        {
            if (names.found(word(name, false)))
            {
                found.insert(word(name, false), DynamicList<scalar>());
            }
        }

        for (label line = 2; hasLine(is, text); ++line)
        {
            const std::vector<std::string> fields(csvFields(text));
            if (fields.size() != head.size())
            {
                refuse
                (
                    line,
                    std::to_string(fields.size()) + " fields, but the head has "
                  + std::to_string(head.size())
                );
            }
            for (size_t i = 0; i < head.size(); ++i)
            {
                const word name(head[i], false);
                scalar value = 0;

                if (!found.found(name))
                {
                    continue;
                }
                if (!readScalar(fields[i].c_str(), value))
                {
                    refuse(line, head[i] + " is no number: " + fields[i]);
                }
                found[name].append(value);
            }
        }

        return found;
    }


    //- Are all of these columns there? End the run if only some are, or none
    //  where they must be
    static bool hasAll
    (
        const dictionary& dict,
        const fileName& file,
        const columnTable& columns,
        const wordList& names,
        const bool required
    )
    {
        label n = 0;
        for (const word& name : names)
        {
            n += columns.found(name);
        }
        if (n != names.size() && (n || required))
        {
            FatalIOErrorInFunction(streamOf(dict, "file"))
                << file.c_str() << ", line 1: the head must name all of the "
                << "columns " << flatOutput(names) << exit(FatalIOError);
        }

        return n;
    }


    //- Put the lists of a file into an injection
    static void fill(dictionary& dict, const fileName& caseFolder)
    {
        const wordList place({"x1", "x2", "x3"});
        const wordList turn({"eps1", "eps2", "eps3", "eta"});
        const wordList size({"length", "width"});

        for
        (
            const word& given
          : wordList({"positions", "orientations", "sizes", "densities"})
        )
        {
            if (dict.found(given))
            {
                FatalIOErrorInFunction(streamOf(dict, given))
                    << given << " is not read with file" << exit(FatalIOError);
            }
        }

        fileName file(dict.get<fileName>("file"));
        file.expand();
        if (!file.isAbsolute())
        {
            file = caseFolder/file;
        }

        wordList all(place);
        all.append(turn);
        all.append(size);
        all.append("density");
        const columnTable columns(columnsOf(dict, file, all));

        hasAll(dict, file, columns, place, true);
        pointField positions(columns["x1"].size());
        forAll(positions, i)
        {
            positions[i] =
                point(columns["x1"][i], columns["x2"][i], columns["x3"][i]);
        }
        const exactDigits exact;
        dict.set("positions", positions);

        if
        (
            !dict.found("orientation")
         && hasAll(dict, file, columns, turn, false)
        )
        {
            List<FixedList<scalar, 4>> orientations(positions.size());
            forAll(orientations, i)
            {
                forAll(turn, j)
                {
                    orientations[i][j] = columns[turn[j]][i];
                }
            }
            dict.set("orientations", orientations);
        }
        if (hasAll(dict, file, columns, size, false))
        {
            List<FixedList<scalar, 2>> sizes(positions.size());
            forAll(sizes, i)
            {
                sizes[i][0] = columns["length"][i];
                sizes[i][1] = columns["width"][i];
            }
            dict.set("sizes", sizes);
        }
        if (columns.found("density"))
        {
            dict.set("densities", columns["density"]);
        }
        dict.remove("file");
    }
}


// * * * * * * * * * * * * * * * Global Functions  * * * * * * * * * * * * * //

void Foam::listedCells::read
(
    dictionary& injections,
    const fileName& caseFolder
)
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
