// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

/*---------------------------------------------------------------------------*\
Description
    When and where cells of an injection enter.

\*---------------------------------------------------------------------------*/

#include "cellOrientation.H"
#include "layerParts.H"
#include "mathematicalConstants.H"

#include <numeric>

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- Two injections of one dictionary draw other numbers, and every cell's
    //  time, position and orientation are independent
    static void checkDraws(const layer& at)
    {
        const label n = 50;
        bool apart = true;
        label nByTime = 0, nByPlace = 0;
        const dictionary dict
        (
            entries
            (
                "type box; number 50; duration 1; min (8e-6 8e-6 3e-6);"
                "max (16e-6 16e-6 7e-6);"
            )
        );
        DynamicList<cellState> cells;
        bool ordered = true;
        for (const label first : {0, 50})
        {
            const cellInjection::setting from
            {
                dict, at.undecomposed, at.domain, at.population, first, 0, true
            };
            const auto injection(cellInjection::New(from));
            const label nBefore = cells.size();

            injection->append(0, 0.5, cells);
            injection->append(0.5, 2, cells);
            for (label i = nBefore; i < cells.size(); ++i)
            {
                ordered = ordered
                 && cells[i].id >= first && cells[i].id < first + n
                 && (i == nBefore || cells[i].time >= cells[i - 1].time);
            }
        }
        holds("an injection's cells come in the order of their times", ordered);
        holds("and all of them", cells.size() == 2*n, Foam::name(cells.size()));

        // Uniform numbers of a cell; no two of all are the same
        DynamicList<scalar> numbers;
        for (const cellState& cell : cells)
        {
            numbers.append(cell.time);
            numbers.append((cell.body.x[0] - 8e-6)/8e-6);
            numbers.append((cell.body.x[1] - 8e-6)/8e-6);
            numbers.append((cell.body.x[2] - 3e-6)/4e-6);

            // Nor is the orientation that of the numbers of the place
            scalar q[4];
            const scalar* place = numbers.cdata() + numbers.size() - 3;
            ellipsoid_quaternion_from_uniform(place, q);
            const scalar* own = cell.body.q;
            const bool isLong = cell.size.length > 3e-6;
            nByTime += isLong == (cell.time < 0.5);
            nByPlace += isLong == (place[0] < 0.5);
            apart = apart
             && mag(std::inner_product(q, q + 4, own, scalar(0))) < 1 - 1e-6;
        }
        sort(numbers);
        scalar nearest = 1;
        for (label i = 1; i < numbers.size(); ++i)
        {
            nearest = min(nearest, numbers[i] - numbers[i - 1]);
        }
        holds
        (
            "no number is drawn twice, by two cells or for two uses",
            apart && nearest > 1e-9
         && numbers.first() >= 0 && numbers.last() < 1,
            Foam::name(nearest)
        );
        holds
        (
            "sizes of a table are drawn by neither",
            nByTime > 0 && nByTime < 2*n && nByPlace > 0 && nByPlace < 2*n,
            Foam::name(nByTime) + " by time, " + Foam::name(nByPlace)
        );
    }

    //- When cells enter, how many, and which is which
    static void checkEntries(const layer& at)
    {
        const auto made = [&](const dictionary& dict, const label firstId)
        {
            const cellInjection::setting from
            {
                dict, at.undecomposed, at.domain, at.population, firstId, 3,
                true
            };
            return cellInjection::New(from);
        };
        const string box
        (
            "type box; min (8e-6 8e-6 5e-6); max (12e-6 12e-6 5e-6);"
        );
        DynamicList<cellState> cells;

        const dictionary many(entries(box + "rate 1000.3; duration 2;"));
        const auto thousands(made(many, 0));
        const scalar* a = at.population.median().options.semi_axes;
        holds("numbers are rounded", thousands->size() == 2001);
        holds
        (
            "the volume is that of all cells",
            mag
            (
                thousands->volume()/(2001*4.0/3*constant::mathematical::pi)
               /(a[0]*a[1]*a[2]) - 1
            ) < 1e-9
        );

        const dictionary three
        (
            entries
            (
                "type positions; start 0.5; relativeStart yes; positions"
                " ((10e-6 10e-6 5e-6) (12e-6 10e-6 5e-6) (14e-6 10e-6 5e-6));"
                "sizes ((4e-6 1e-6) (5e-6 1.2e-6) (3e-6 0.9e-6));"
                "densities (1001 1002 1003);"
                "orientations ((0 0 0 1) (0 0 0.6 0.8) (1 0 0 0));"
            )
        );
        const auto listed(made(three, 7));
        listed->append(0, 3.5, cells);
        holds("an interval has its start and not its end", cells.empty());
        listed->append(3.5, 4, cells);
        bool each = cells.size() == 3;
        bool starts = each;
        const scalar lengths[] = {4e-6, 5e-6, 3e-6};
        const scalar quaternions[] = {1, 0.8, 0};
        forAll(cells, i)
        {
            const cellState& cell = cells[i];
            each = each && cell.id == 7 + i && cell.planned == 3.5
             && mag(cell.body.x[0] - (10e-6 + 2e-6*i)) < 1e-15
             && cell.size.length == lengths[i] && cell.size.density == 1001 + i
             && mag(cell.body.q[3] - quaternions[i]) < 1e-12;
            starts = starts
             && mag(pointOf(cell.body.u) - vector(1e-3, 2e-3, -1e-3)) < 1e-12
             && cell.nextRow < -1e12;
        }
        holds("each cell of a list has what stands with it", each);
        holds
        (
            "each enters as fast as the flow, at any time with a row",
            starts
        );
    }

    //- Orientations that are given, and those that are drawn
    static void checkOrientations()
    {
        scalar q[4], other[4], angles[3], R[3][3];
        const auto given = [&](const string& text)
        {
            cellOrientation(entries(text)).draw(5, 3, q);
        };

        given("orientation aligned; axis (2 4 4);");
        ellipsoid_rotation(q, R);
        const vector axis(R[0][1], R[1][1], R[2][1]);
        holds("an axis is of any length", same(axis, vector(1, 2, 2)/3));

        given("orientation euler; eulerAngles (30 40 50);");
        ellipsoid_euler_from_quaternion(q, angles);
        const scalar degree = constant::mathematical::pi/180;
        holds
        (
            "Euler angles are in degrees",
            same(pointOf(angles), degree*vector(30, 40, 50))
        );

        given("orientation quaternion; quaternion (0 0 0.6 0.8006);");
        const scalar length = std::inner_product(q, q + 4, q, scalar(0));
        holds
        (
            "a quaternion is of length 1, but for its digits, which go",
            mag(length - 1) < 1e-12
         && refuses([&]()
            {
                given("orientation quaternion; quaternion (0 0 0.6 0.802);");
            }),
            Foam::name(length - 1)
        );

        scalar uniform[6];
        ellipsoid_random_uniform(5, 3, rsPose, 0, 6, uniform);
        ellipsoid_quaternion_from_uniform(uniform + 3, other);
        given("orientation random;");
        holds
        (
            "one that is drawn is not by the numbers of the place",
            std::equal(q, q + 4, other)
        );
    }

    //- How many cells are asked for
    static void checkNumbers(const layer& at)
    {
        const auto refused = [&](const string& text)
        {
            const dictionary dict
            (
                entries
                (
                    "type box; min (8e-6 8e-6 5e-6); max (12e-6 12e-6 5e-6);"
                  + text
                )
            );
            const cellInjection::setting from
            {
                dict, at.undecomposed, at.domain, at.population, 0, 0, true
            };
            return refuses([&]() { cellInjection::New(from); });
        };
        holds
        (
            "either their number is given or their rate",
            refused("") && refused("number 3; rate 3; duration 1;")
         && !refused("number 3; duration 1;") && !refused("rate 3; duration 1;")
        );
        holds
        (
            "and makes one cell at least, and no more than can be",
            refused("rate 0.49; duration 1;")
         && !refused("rate 0.51; duration 1;")
         && refused("rate 1e9; duration 1;")
        );
    }
}


// * * * * * * * * * * * * * * * Shared Functions  * * * * * * * * * * * * * //

void Foam::checkInjections(const layer& at)
{
    checkDraws(at);
    checkEntries(at);
    checkOrientations();
    checkNumbers(at);
}
