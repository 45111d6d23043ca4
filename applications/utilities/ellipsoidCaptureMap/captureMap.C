// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "captureMap.H"
#include "masterGate.H"

#include <algorithm>

// * * * * * * * * * * * * * * Static Data Members * * * * * * * * * * * * * //

const Foam::label Foam::captureMap::anySieve_;
const Foam::label Foam::captureMap::noRoom_;


// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- The orientations of a dictionary
    static List<captureMap::pose> readPoses
    (
        const dictionary& dict,
        const label seed
    )
    {
        const dictionary& given =
            dict.found("orientations")
          ? subDictOf(dict, "orientations")
          : dict.subDict("orientations");
        DynamicList<captureMap::pose> poses;
        label nDrawn = 0;

        for (const entry& e : given)
        {
            if (!e.isDict())
            {
                FatalIOErrorInFunction(given)
                    << e.keyword() << " is not a dictionary of an orientation"
                    << exit(FatalIOError);
            }

            const dictionary& one = e.dict();
            const cellOrientation orientation(one);

            checkKeywords
            (
                one,
                orientation.random()
              ? wordList({"orientation", "number"})
              : wordList({"orientation", "axis", "quaternion", "eulerAngles"})
            );

            const label n = checkedNumber(one, "number", within(1, 1000), 1);

            for (label i = 0; i < n; ++i)
            {
                captureMap::pose p;
                p.name = word(e.keyword());
                if (n > 1)
                {
                    p.name += Foam::name(i + 1);
                }
                orientation.draw(seed, nDrawn, p.q);
                nDrawn += orientation.random();
                poses.append(p);
            }
        }

        if (poses.empty())
        {
            FatalIOErrorInFunction(given)
                << "no orientation is given" << exit(FatalIOError);
        }

        return List<captureMap::pose>(std::move(poses));
    }
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::inletPlane::window Foam::captureMap::windowOf(const square& one) const
{
    const scalar ds = plane_.width()/(nNodes(0) - 1);
    const scalar dt = plane_.height()/(nNodes(1) - 1);
    const label n = sideOf(one);

    return inletPlane::window
    {
        one.at.i*ds, (one.at.i + n)*ds, one.at.j*dt, (one.at.j + n)*dt
    };
}


void Foam::captureMap::begin(const node& at, const label level)
{
    const label id = starts_.size();

    if (!startAt_[at.pose].insert(labelPair(at.i, at.j), id))
    {
        return;
    }

    const point x
    (
        plane_.position
        (
            at.i*(plane_.width()/(nNodes(0) - 1)),
            at.j*(plane_.height()/(nNodes(1) - 1))
        )
    );

    cellState cell = cellState();
    cell.id = id;
    std::copy_n(x.v_, 3, cell.body.x);
    std::copy_n(from_.poses[at.pose].q, 4, cell.body.q);

    if (cells_.fits(cell))
    {
        waiting_.append(cell);
        ++nFollowed_;
    }

    starts_.append(start{at, level, x, {cellState::waiting, -1, -1}});
}


void Foam::captureMap::followWaiting()
{
    const List<independentCells::ending> endings
    (
        cells_.follow(waiting_, deltaT_, from_.endTime)
    );

    forAll(waiting_, i)
    {
        starts_[waiting_[i].id].end = endings[i];
    }
    waiting_.clear();

    Info<< "captureMap: " << nFollowed_ << " cells followed, "
        << squares_.size() << " squares" << endl;
}


void Foam::captureMap::addEdge
(
    const node& a,
    const node& b,
    DynamicList<label>& ids
) const
{
    const node middle{a.pose, (a.i + b.i)/2, (a.j + b.j)/2};

    // Neighbouring nodes have none between them
    if (mag(a.i - b.i) + mag(a.j - b.j) < 2 || startOf(middle) < 0)
    {
        return;
    }

    ids.append(startOf(middle));
    addEdge(a, middle, ids);
    addEdge(middle, b, ids);
}


Foam::DynamicList<Foam::label> Foam::captureMap::on(const square& one) const
{
    const label n = sideOf(one);
    const node& at = one.at;
    const FixedList<node, 4> corners
    ({
        at,
        node{at.pose, at.i + n, at.j},
        node{at.pose, at.i + n, at.j + n},
        node{at.pose, at.i, at.j + n}
    });

    DynamicList<label> ids;
    for (const node& corner : corners)
    {
        ids.append(startOf(corner));
    }
    for (label k = 0; k < 4; ++k)
    {
        addEdge(corners[k], corners[(k + 1) % 4], ids);
    }

    return ids;
}


Foam::labelHashSet Foam::captureMap::kindsOn(const square& one) const
{
    labelHashSet found;
    for (const label id : on(one))
    {
        found.insert(kindOf(id));
    }

    return found;
}


bool Foam::captureMap::isDue(const square& one) const
{
    labelHashSet found(kindsOn(one));

    if (found.size() > 1 && one.level < seekLevels_)
    {
        return true;
    }

    // Little flows in between cells that have room and cells that have none
    const bool atWall = found.erase(noRoom_);

    if (found.size() > 1 || (atWall && found.size() && *found.begin() >= 0))
    {
        return true;
    }

    const DynamicList<label> ids(on(one));

    return
        one.level < seekLevels_
     && std::any_of
        (
            ids.begin(),
            ids.end(),
            [&](const label id) { return starts_[id].end.touched >= 0; }
        );
}


bool Foam::captureMap::divide()
{
    // The largest first
    DynamicList<label> due;
    for (label level = 0; level < from_.levels; ++level)
    {
        forAll(squares_, i)
        {
            if (squares_[i].level == level && isDue(squares_[i]))
            {
                due.append(i);
            }
        }
    }

    labelHashSet divided;
    for (const label i : due)
    {
        if (nFollowed_ + 5 > from_.mostCells)
        {
            bounded_ = true;
            break;
        }

        const square one = squares_[i];
        const label half = sideOf(one)/2;
        divided.insert(i);

        for (label k = 0; k < 9; ++k)
        {
            begin
            (
                node
                {
                    one.at.pose,
                    one.at.i + (k % 3)*half,
                    one.at.j + (k / 3)*half
                },
                one.level + 1
            );
        }
    }

    DynamicList<square> squares;
    forAll(squares_, i)
    {
        square one = squares_[i];

        if (!divided.found(i))
        {
            squares.append(one);
            continue;
        }

        const node low = one.at;
        ++one.level;
        for (label k = 0; k < 4; ++k)
        {
            one.at.i = low.i + (k % 2)*sideOf(one);
            one.at.j = low.j + (k / 2)*sideOf(one);
            squares.append(one);
        }
    }
    squares_.transfer(squares);

    return divided.size();
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::captureMap::setting::setting
(
    const dictionary& dict,
    const polyBoundaryMesh& patches,
    const label seed
)
:
    nSquares(checkedNumber(dict, "squares", within(1, 1000), 64)),
    levels(checkedNumber(dict, "levels", within(0, 10), 3)),
    mostCells(checkedNumber(dict, "mostCells", within(1, 10000000), 20000)),
    endTime(checkedNumber<scalar>(dict, "endTime", above(0))),
    poses(readPoses(dict, seed))
{
    checkKeywords
    (
        dict,
        {
            "patch", "squares", "levels", "mostCells", "endTime", "orientations"
        },
        {"orientations"}
    );
    cellInjection::checkPatch(dict, patches);
}


Foam::captureMap::captureMap
(
    const setting& from,
    const inletPlane& plane,
    const independentCells& cells,
    const scalar deltaT
)
:
    cells_(cells),
    plane_(plane),
    from_(from),
    deltaT_(deltaT),
    startAt_(from.poses.size()),
    nFollowed_(0),
    bounded_(false)
{
    const scalar side = max(plane.width(), plane.height())/from.nSquares;

    nFirst_[0] = max(label(plane.width()/side + 0.5), label(1));
    nFirst_[1] = max(label(plane.height()/side + 0.5), label(1));

    const int64_t nStarts =
        int64_t(nFirst_[0] + 1)*(nFirst_[1] + 1)*from.poses.size();
    if (nStarts > from.mostCells)
    {
        const masterGate once;
        FatalErrorInFunction
            << "mostCells " << from.mostCells << " of captureMapDict is out of"
            << " range" << nl << "    allowed: " << nStarts
            << " or more, as many as start on the corners of the first squares"
            << exit(FatalError);
    }

    const label n = 1 << from.levels;
    forAll(from.poses, p)
    {
        for (label j = 0; j <= nFirst_[1]; ++j)
        {
            for (label i = 0; i <= nFirst_[0]; ++i)
            {
                begin(node{p, i*n, j*n}, 0);

                if (i < nFirst_[0] && j < nFirst_[1])
                {
                    squares_.append(square{node{p, i*n, j*n}, 0});
                }
            }
        }
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::captureMap::make()
{
    do
    {
        followWaiting();
    } while (divide());

    shares_.setSize(squares_.size());
    forAll(squares_, i)
    {
        shares_[i] = plane_.within(windowOf(squares_[i]));
    }
}
