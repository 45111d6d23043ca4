// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "cellPopulation.H"
#include "masterGate.H"
#include "Pair.H"

// * * * * * * * * * * * * * * Static Data Members * * * * * * * * * * * * * //

const Foam::Enum<Foam::cellPopulation::distributionType>
Foam::cellPopulation::distributionNames_
({
    { distributionType::dtLogNormal, "logNormal" },
    { distributionType::dtTable, "table" }
});


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::cellPopulation::readDistribution(const dictionary& dict)
{
    const word name(dict.get<word>("type"));

    if (!distributionNames_.found(name))
    {
        FatalIOErrorInFunction(streamOf(dict, "type"))
            << "unknown type " << name << " of sizes" << nl
            << "    allowed: " << flatOutput(distributionNames_.names())
            << exit(FatalIOError);
    }
    type_ = distributionNames_[name];

    if (type_ == dtLogNormal)
    {
        const entryRange sigma(within(0, 1));

        checkKeywords
        (
            dict, {"type", "lengthDeviation", "widthDeviation", "truncation"}
        );
        lengthDeviation_ = checkedNumber(dict, "lengthDeviation", sigma, 0.0);
        widthDeviation_ = checkedNumber(dict, "widthDeviation", sigma, 0.0);
        truncation_ = checkedNumber(dict, "truncation", within(1, 5), 3.0);
        return;
    }

    checkKeywords(dict, {"type", "values"});
    dict.lookup("values");
    values_ = listedSizes(dict, "values");

    if (values_.empty())
    {
        refuseEntry
        (
            dict, "values", "sizes/values", "one pair (length width) or more"
        );
    }
}


Foam::List<Foam::cellSize> Foam::cellPopulation::extremes() const
{
    DynamicList<cellSize> sizes(listed_);
    sizes.append(values_);

    for (const scalar l : {-truncation_, truncation_})
    {
        for (const scalar w : {-truncation_, truncation_})
        {
            sizes.append(medianSize());
            sizes.last().length *= exp(l*lengthDeviation_);
            sizes.last().width *= exp(w*widthDeviation_);
        }
    }

    return List<cellSize>(std::move(sizes));
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::cellPopulation::cellPopulation(const ellipsoidProperties& properties)
:
    properties_(properties),
    median_(modelOf(properties.options()))
{
    const masterGate once;
    const dictionary& cell = properties.section("cell");

    for (const entry& e : properties.section("injection"))
    {
        if (!e.isDict())
        {
            continue;
        }
        const dictionary& dict = e.dict();

        listed_.append(listedSizes(dict, "sizes"));
        for (const scalar d : dict.getOrDefault<scalarList>("densities", {}))
        {
            listed_.append(medianSize());
            listed_.last().density = d;
        }
    }
    if (cell.found("sizes"))
    {
        readDistribution(subDictOf(cell, "sizes"));
    }

    for (const cellSize& size : extremes())
    {
        const string why(ellipsoidProperties::complaint(optionsOf(size)));

        if (!why.empty())
        {
            FatalIOErrorInFunction
            (
                type_ == dtNone ? properties : cell.subDict("sizes")
            )   << "sizes make a cell of length " << Foam::name(size.length)
                << " m and width " << Foam::name(size.width)
                << " m, for which " << why.c_str() << exit(FatalIOError);
        }
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

ellipsoid_model Foam::cellPopulation::modelOf(const ellipsoid_options& options)
{
    ellipsoid_model model = ellipsoid_model();

    if (ellipsoid_model_init(&model, &options) != ELLIPSOID_OK)
    {
        FatalErrorInFunction
            << "a cell of length " << shortText(2*options.semi_axes[1])
            << " m and width " << shortText(2*options.semi_axes[0])
            << " m: " << ellipsoidProperties::complaint(options).c_str()
            << exit(FatalError);
    }

    return model;
}


Foam::scalar Foam::cellPopulation::largest
(
    const std::function<scalar(const ellipsoid_options&)>& property
) const
{
    scalar most = 0;
    for (const cellSize& size : extremes())
    {
        most = max(most, property(optionsOf(size)));
    }

    return most;
}


Foam::List<Foam::cellSize> Foam::cellPopulation::listedSizes
(
    const dictionary& dict,
    const word& entry
) const
{
    const List<Pair<scalar>> pairs
    (
        dict.getOrDefault<List<Pair<scalar>>>(entry, {})
    );
    List<cellSize> sizes(pairs.size(), medianSize());

    forAll(pairs, i)
    {
        sizes[i].length = pairs[i].first();
        sizes[i].width = pairs[i].second();
    }

    return sizes;
}


ellipsoid_options Foam::cellPopulation::optionsOf(const cellSize& size) const
{
    ellipsoid_options one
    (
        ellipsoid_options_resized(&median_.options, size.length, size.width)
    );
    one.density = size.density;

    return one;
}


Foam::cellSize Foam::cellPopulation::medianSize() const
{
    const ellipsoid_options& options = median_.options;

    return cellSize
    {
        2*options.semi_axes[1], 2*options.semi_axes[0], options.density
    };
}


Foam::cellSize Foam::cellPopulation::drawn(const label id) const
{
    cellSize size(medianSize());

    const label seed = properties_.seed();

    if (type_ == dtTable)
    {
        scalar uniform;
        ellipsoid_random_uniform(seed, id, rsSize, 0, 1, &uniform);

        size = values_[label(uniform*values_.size())];
    }
    else if (type_ == dtLogNormal)
    {
        scalar normal[2];
        label attempt = 0;
        do
        {
            ellipsoid_random_normals(seed, id, rsSize, attempt++, 2, normal);
        }
        while (max(mag(normal[0]), mag(normal[1])) > truncation_);

        size.length *= exp(lengthDeviation_*normal[0]);
        size.width *= exp(widthDeviation_*normal[1]);
    }

    return size;
}


Foam::string Foam::cellPopulation::text() const
{
    return
        "semiAxes " + shortText(pointOf(median_.options.semi_axes))
      + (varies() ? ", sizes vary" : ", all alike");
}


void Foam::cellPopulation::add(const label id, const cellSize& size)
{
    const cellSize middle(medianSize());

    if (std::memcmp(&size, &middle, sizeof(cellSize)))
    {
        models_.set(id, new ellipsoid_model(modelOf(optionsOf(size))));
    }
}
