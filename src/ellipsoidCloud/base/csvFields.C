// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "csvFields.H"

// * * * * * * * * * * * * * * * Global Functions  * * * * * * * * * * * * * //

std::string Foam::csvField(const std::string& word)
{
    // A minus alone stands for no word
    const bool formula = word.find_first_of("=+-@") == 0 && word != "-";

    if (!formula && word.find_first_of(",\"") == std::string::npos)
    {
        return word;
    }

    std::string field(formula ? "\"'" : "\"");
    for (const char c : word)
    {
        field.append(c == '"' ? 2 : 1, c);
    }

    return field + '"';
}


std::vector<std::string> Foam::csvFields(const std::string& line)
{
    std::vector<std::string> fields(1);
    bool quoted = false;

    for (std::size_t i = 0; i < line.size(); ++i)
    {
        const bool quote = line[i] == '"';

        if (quote && quoted && line.compare(i + 1, 1, "\"") == 0)
        {
            fields.back() += line[i++];
        }
        else if (quote)
        {
            quoted = !quoted;
        }
        else if (line[i] == ',' && !quoted)
        {
            fields.emplace_back();
        }
        else
        {
            fields.back() += line[i];
        }
    }

    for (std::string& field : fields)
    {
        field.erase(0, field.compare(0, 1, "'") == 0);
    }

    return fields;
}
