// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "cellOrientation.H"
#include "ellipsoidProperties.H"
#include "unitConversion.H"
#include "vector.H"

#include <numeric>

// * * * * * * * * * * * * * * Static Data Members * * * * * * * * * * * * * //

const Foam::Enum<Foam::cellOrientation::orientationType>
Foam::cellOrientation::orientationNames_
({
    { orientationType::otRandom, "random" },
    { orientationType::otAligned, "aligned" },
    { orientationType::otQuaternion, "quaternion" },
    { orientationType::otEuler, "euler" }
});


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::cellOrientation::cellOrientation(const dictionary& dict)
:
    type_(orientationNames_.getOrDefault("orientation", dict, otRandom)),
    q_{0, 0, 0, 1}
{
    const HashTable<orientationType> readers
    ({
        {"axis", otAligned}, {"quaternion", otQuaternion}, {"eulerAngles", otEuler}
    });

    for (const word& entry : readers.sortedToc())
    {
        if (dict.found(entry) && readers[entry] != type_)
        {
            FatalIOErrorInFunction(streamOf(dict, entry))
                << entry << " is not read with orientation "
                << orientationNames_[type_] << nl << "    allowed: with"
                << " orientation " << orientationNames_[readers[entry]]
                << exit(FatalIOError);
        }
    }

    if (type_ == otAligned)
    {
        const vector axis(dict.get<vector>("axis"));
        if (!(mag(axis) > VSMALL))
        {
            refuseEntry(dict, "axis", "axis", "a vector longer than 0");
        }
        ellipsoid_quaternion_from_axis((axis/mag(axis)).v_, 0, q_);
    }
    else if (type_ == otQuaternion)
    {
        setQuaternion(dict, dict.get<FixedList<scalar, 4>>("quaternion"), q_);
    }
    else if (type_ == otEuler)
    {
        const vector degrees(dict.get<vector>("eulerAngles"));
        ellipsoid_quaternion_from_euler((degrees*degToRad()).v_, q_);
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::cellOrientation::setQuaternion
(
    const dictionary& dict,
    const FixedList<scalar, 4>& given,
    scalar q[4]
)
{
    const auto begin = given.begin();
    const scalar length =
        sqrt(std::inner_product(begin, given.end(), begin, scalar(0)));

    if (!(mag(length - 1) < 1e-3))
    {
        FatalIOErrorInFunction(dict)
            << "quaternion " << given << " is of length " << length << nl
            << "    allowed: 1, within 1e-3" << exit(FatalIOError);
    }

    for (int d = 0; d < 4; ++d)
    {
        q[d] = given[d]/length;
    }
}


void Foam::cellOrientation::set(const scalar uniform[3], scalar q[4]) const
{
    if (type_ == otRandom)
    {
        ellipsoid_quaternion_from_uniform(uniform, q);
    }
    else
    {
        std::copy_n(q_, 4, q);
    }
}


void Foam::cellOrientation::draw
(
    const label seed,
    const label id,
    scalar q[4]
) const
{
    scalar uniform[6];
    ellipsoid_random_uniform(seed, id, rsPose, 0, 6, uniform);
    set(uniform + 3, q);
}
