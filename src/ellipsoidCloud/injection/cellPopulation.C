/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/
#include "cellPopulation.H"
#include "Pair.H"

// * * * * * * * * * * * * * * Static Data Members * * * * * * * * * * * * * //

const Foam::Enum<Foam::cellPopulation::distributionType>
Foam::cellPopulation::distributionNames
({
    { distributionType::dtLogNormal, "logNormal" },
    { distributionType::dtTable, "table" }
});


// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- What the core makes of options that have been checked
    static ellipsoid_model modelOf(const ellipsoid_options& options)
    {
        ellipsoid_model model = ellipsoid_model();

        if (ellipsoid_model_init(&model, &options) != ELLIPSOID_OK)
        {
            FatalErrorInFunction
                << "the options of a cell of length " << 2*options.semi_axes[1]
                << " m are not those that were checked" << abort(FatalError);
        }

        return model;
    }
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::cellPopulation::setting::setting
(
    const dictionary& properties,
    const ellipsoid_options& options
)
:
    type(dtNone),
    lengthDeviation(0),
    widthDeviation(0),
    truncation(0),
    values()
{
    readListed(properties.subOrEmptyDict("injection"), medianSize(options));

    const dictionary& cell = properties.subOrEmptyDict("cell");

    if (!cell.found("sizes"))
    {
        checkExtremes(properties, options);
        return;
    }

    const dictionary& dict = cell.subDict("sizes");
    const word name(dict.get<word>("type"));

    if (!distributionNames.found(name))
    {
        FatalIOErrorInFunction
        (
            dict.lookupEntry("type", keyType::LITERAL).stream()
        )   << "unknown type " << name << " of sizes" << nl
            << "    allowed: " << flatOutput(distributionNames.names())
            << exit(FatalIOError);
    }
    type = distributionNames[name];

    if (type == dtLogNormal)
    {
        typedef ellipsoidProperties entries;
        const entryRange sigma(within(0, 1));

        ellipsoidProperties::checkKeywords
        (
            dict, {"type", "lengthDeviation", "widthDeviation", "truncation"}
        );
        lengthDeviation = entries::number(dict, "lengthDeviation", sigma, 0.0);
        widthDeviation = entries::number(dict, "widthDeviation", sigma, 0.0);
        truncation = entries::number(dict, "truncation", within(1, 5), 3.0);
    }
    else
    {
        ellipsoidProperties::checkKeywords(dict, {"type", "values"});
        dict.lookup("values");
        values = listedSizes(dict, "values", medianSize(options));

        if (values.empty())
        {
            FatalIOErrorInFunction(dict)
                << "values of sizes hold no pair (length width)"
                << exit(FatalIOError);
        }
    }

    checkExtremes(dict, options);
}


void Foam::cellPopulation::setting::readListed
(
    const dictionary& injections,
    const cellSize& median
)
{
    for (const entry& e : injections)
    {
        const dictionary& dict = e.dict();

        listed.append(listedSizes(dict, "sizes", median));
        for (const scalar d : dict.getOrDefault<scalarList>("densities", {}))
        {
            listed.append(cellSize{median.length, median.width, d});
        }
    }
}


void Foam::cellPopulation::setting::checkExtremes
(
    const dictionary& dict,
    const ellipsoid_options& options
) const
{
    for (const cellSize& size : extremes(options))
    {
        const string complaint
        (
            ellipsoidProperties::complaint(optionsOf(options, size))
        );

        if (!complaint.empty())
        {
            FatalIOErrorInFunction(dict)
                << "sizes make a cell of length " << Foam::name(size.length)
                << " m and width " << Foam::name(size.width)
                << " m, for which " << complaint.c_str() << exit(FatalIOError);
        }
    }
}


Foam::cellPopulation::cellPopulation(const ellipsoidProperties& properties)
:
    properties_(properties),
    setting_(properties, properties.options()),
    median_(modelOf(properties.options()))
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::List<Foam::cellSize> Foam::cellPopulation::setting::extremes
(
    const ellipsoid_options& options
) const
{
    DynamicList<cellSize> sizes(listed);
    sizes.append(values);

    // The ranges of the core that a size can leave are monotonic in both
    const cellSize middle(medianSize(options));
    for (const scalar l : {-truncation, truncation})
    {
        for (const scalar w : {-truncation, truncation})
        {
            sizes.append
            (
                cellSize
                {
                    middle.length*exp(l*lengthDeviation),
                    middle.width*exp(w*widthDeviation),
                    middle.density
                }
            );
        }
    }

    return List<cellSize>(std::move(sizes));
}


Foam::scalar Foam::cellPopulation::farthestSeen
(
    const ellipsoidProperties& properties
)
{
    const ellipsoid_options& options = properties.options();
    scalar farthest = 0;

    for (const cellSize& size : setting(properties, options).extremes(options))
    {
        const ellipsoid_options own(optionsOf(options, size));
        const double* a = own.semi_axes;
        const scalar longest = longestSemiAxis(own);
        const scalar slimness = longest/min(a[0], min(a[1], a[2]));

        // Twice the reach of its beads, as far from all walls; or what gives
        // it resistance, see wallPlanes.c
        farthest = max(farthest, 4*(longest + 2*own.bead_radius));
        if (own.wall_resistance != ELLIPSOID_WALL_RESISTANCE_NONE)
        {
            farthest = max(farthest, (2 + slimness)*own.wall_range);
        }
    }

    return farthest;
}


Foam::List<Foam::cellSize> Foam::cellPopulation::listedSizes
(
    const dictionary& dict,
    const word& entry,
    const cellSize& other
)
{
    const List<Pair<scalar>> pairs
    (
        dict.getOrDefault<List<Pair<scalar>>>(entry, {})
    );
    List<cellSize> sizes(pairs.size(), other);

    forAll(pairs, i)
    {
        sizes[i].length = pairs[i].first();
        sizes[i].width = pairs[i].second();
    }

    return sizes;
}


ellipsoid_options Foam::cellPopulation::optionsOf
(
    const ellipsoid_options& options,
    const cellSize& size
)
{
    ellipsoid_options one
    (
        ellipsoid_options_resized(&options, size.length, size.width)
    );
    one.density = size.density;

    return one;
}


Foam::cellSize Foam::cellPopulation::medianSize
(
    const ellipsoid_options& options
)
{
    return
        cellSize
        {
            2*options.semi_axes[1], 2*options.semi_axes[0], options.density
        };
}


Foam::cellSize Foam::cellPopulation::drawn(const label id) const
{
    cellSize size(medianSize());

    const label seed = properties_.seed();

    if (setting_.type == dtTable)
    {
        scalar uniform;
        ellipsoid_random_uniform(seed, id, rsSize, 0, 1, &uniform);

        size = setting_.values[label(uniform*setting_.values.size())];
    }
    else if (setting_.type == dtLogNormal)
    {
        scalar normal[2];
        label attempt = 0;
        do
        {
            ellipsoid_random_normals(seed, id, rsSize, attempt++, 2, normal);
        }
        while (max(mag(normal[0]), mag(normal[1])) > setting_.truncation);

        size.length *= exp(setting_.lengthDeviation*normal[0]);
        size.width *= exp(setting_.widthDeviation*normal[1]);
    }

    return size;
}


ellipsoid_model Foam::cellPopulation::made(const cellSize& size) const
{
    return modelOf(optionsOf(median_.options, size));
}


void Foam::cellPopulation::take(const label id, const cellSize& size)
{
    const cellSize middle(medianSize());

    if
    (
        size.length != middle.length
     || size.width != middle.width
     || size.density != middle.density
    )
    {
        models_.set(id, new ellipsoid_model(made(size)));
    }
}


// ************************************************************************* //
