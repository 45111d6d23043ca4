// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "ellipsoidProperties.H"
#include "dimensionedTypes.H"
#include "electricField.H"
#include "Switch.H"

#include <vector>

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- The core's list of options
    static std::vector<ellipsoid_option> coreOptions()
    {
        int size = 0;
        const ellipsoid_option* first = ellipsoid_option_list(&size);

        return std::vector<ellipsoid_option>(first, first + size);
    }

    //- What options.def says of a member
    static ellipsoid_option optionOf(const word& member)
    {
        ellipsoid_option found = {};
        for (const ellipsoid_option& option : coreOptions())
        {
            found = option.member == member ? option : found;
        }

        return found;
    }

    //- An option as the user knows it
    static string nameOf(const ellipsoid_option& option)
    {
        const string section(option.section);

        return section.empty() ? option.entry : section + '/' + option.entry;
    }

    //- The keywords of a section, or with an empty name those of the top
    static wordList keywordsOf(const word& section)
    {
        // What the layer reads beside the options of the core
        static const HashTable<wordList> others
        ({
            {
                "",
                {
                    "interpolation", "seed", "injection", "capture", "tracks",
                    "unreached", "occupancy"
                }
            },
            {"cell", {"sizes"}},
            {"contact", {"cells"}}
        });

        wordList allowed(others.lookup(section, wordList()));

        for (const ellipsoid_option& option : coreOptions())
        {
            const word in(option.section);

            if (in == section)
            {
                allowed.append(option.entry);
            }
            else if
            (
                section.empty()
             && in != "transportProperties"
             && !allowed.found(in)
            )
            {
                allowed.append(in);
            }
        }

        return allowed;
    }

    //- Value of an entry, which may have dimensions in front
    template<class Type>
    static Type valueOf(const dictionary& dict, const ellipsoid_option& option)
    {
        const word keyword(option.entry);

        return
            hasUnit(dict, keyword, nameOf(option), option.unit)
          ? dimensioned<Type>(keyword, dict).value()
          : dict.get<Type>(keyword);
    }

    //- Read an entry into a member of the options
    static void readMember
    (
        const dictionary& dict,
        const ellipsoid_option& option,
        void* member
    )
    {
        const word keyword(option.entry);
        int value = 0;

        switch (option.type)
        {
            case ELLIPSOID_OPTION_REAL:
                *static_cast<double*>(member) = valueOf<scalar>(dict, option);
                return;

            case ELLIPSOID_OPTION_VECTOR:
                std::copy_n
                (
                    valueOf<vector>(dict, option).v_,
                    3,
                    static_cast<double*>(member)
                );
                return;

            case ELLIPSOID_OPTION_WHOLE:
            {
                const scalar given = dict.get<scalar>(keyword);
                if (!isWhole<int>(given))
                {
                    refuseEntry
                    (
                        dict,
                        keyword,
                        nameOf(option),
                        "a whole number, " + string(option.range)
                    );
                }
                value = given;
                break;
            }

            case ELLIPSOID_OPTION_SWITCH:
                value = dict.get<Switch>(keyword);
                break;

            case ELLIPSOID_OPTION_CHOICE:
            {
                const word given(dict.get<word>(keyword));
                while (option.words[value] && given != option.words[value])
                {
                    ++value;
                }
                if (!option.words[value])
                {
                    refuseEntry(dict, keyword, nameOf(option), option.range);
                }
                break;
            }
        }

        std::memcpy(member, &value, sizeof(value));
    }
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::ellipsoidProperties::readOptions()
{
    const wordList keywords(keywordsOf(word::null));
    wordList sections({"injection", "capture", "tracks", "occupancy"});
    const wordList external(externalForces::names(section("forces")));

    for (const word& keyword : keywords)
    {
        wordList allowed(keywordsOf(keyword));

        if (allowed.size())
        {
            wordList dictionaries({"sizes", "electricField"});
            if (keyword == "forces")
            {
                dictionaries.append(external);
                allowed.append(external);
            }
            checkKeywords(section(keyword), allowed, dictionaries);
            sections.append(keyword);
        }
    }
    checkKeywords(*this, keywords, sections);

    for (const ellipsoid_option& option : coreOptions())
    {
        const dictionary& dict = section(option.section);

        // The case may name a field in place of a uniform one
        const bool isField =
            word("electric_field") == option.member
         && electricField::isNamed(dict);

        if (isField)
        {
            electricField::checkEntries(dict);
        }
        else if (dict.found(option.entry))
        {
            readMember
            (
                dict,
                option,
                reinterpret_cast<char*>(&options_) + option.offset
            );
        }
    }

    if
    (
        electricField::isNamed(section("forces"))
     && external.empty() && options_.charge == 0
     && pointOf(options_.dipole) == vector::zero
    )
    {
        IOWarningInFunction(section("forces"))
            << "a field is named in electricField, but charge and dipole"
            << " are 0: it acts on no cell" << endl;
    }

    // The default is of cells as wide as the paper's
    const scalar shortest = shortestSemiAxis(options_);

    if
    (
        !section("contact").found("beadRadius")
     && options_.bead_radius >= shortest
    )
    {
        options_.bead_radius = 0.57*shortest;
    }

    pushing_ =
        section("contact").getOrDefault("cells", Switch(true))
     && options_.contact;
}


void Foam::ellipsoidProperties::checkOptions() const
{
    const char* member = nullptr;
    const char* range = nullptr;

    if (ellipsoid_options_check(&options_, &member, &range) == ELLIPSOID_OK)
    {
        return;
    }

    const ellipsoid_option option(optionOf(member));
    const dictionary& dict = section(option.section);

    if (dict.found(option.entry))
    {
        refuseEntry(dict, option.entry, nameOf(option), range);
    }

    const char* at = reinterpret_cast<const char*>(&options_) + option.offset;
    const char* value =
        option.words
      ? option.words[*reinterpret_cast<const int*>(at)]
      : option.default_text;

    FatalIOErrorInFunction(*this)
        << nameOf(option).c_str() << ' ' << value
        << ", the default, is out of range" << nl
        << "    allowed: " << range << exit(FatalIOError);
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::string Foam::ellipsoidProperties::complaint
(
    const ellipsoid_options& options
)
{
    const char* member = nullptr;
    const char* range = nullptr;

    if (ellipsoid_options_check(&options, &member, &range) == ELLIPSOID_OK)
    {
        return string();
    }

    return nameOf(optionOf(member)) + " is out of range\n    allowed: " + range;
}
