// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

/*---------------------------------------------------------------------------*\
Description
    The undecomposed mesh, put together from the parts of the ranks.

\*---------------------------------------------------------------------------*/
#include "undecomposedFlow.H"
#include "bitSet.H"
#include "fromRanks.H"
#include "fvMesh.H"
#include "globalIndex.H"
#include "globalMeshData.H"
#include "labelIOList.H"
#include "masterGate.H"
#include "processorCyclicPolyPatch.H"
#include "syncTools.H"
#include "Time.H"

#include <algorithm>
#include <array>
#include <vector>

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- Check that no cyclic patch is divided, faces of which could not be paired
    //  without the addressing of decomposePar; collective
    static void checkUndivided(const polyMesh& part)
    {
        bool divided = false;
        for (const polyPatch& pp : part.boundaryMesh())
        {
            divided = divided || isA<processorCyclicPolyPatch>(pp);
        }
        reduce(divided, orOp<bool>());

        const masterGate once;
        if (divided)
        {
            FatalErrorInFunction
                << "processors share a cyclic patch, and there are no files"
                << " *ProcAddressing in " << part.meshDir() << nl
                << "    Keep it on one processor (preservePatches in"
                << " decomposeParDict), or run decomposePar -force"
                << exit(FatalError);
        }
    }

    //- Number of faces on all ranks of each patch of the undecomposed mesh;
    //  collective, for the master
    static labelList wholePatchSizes(const polyMesh& part)
    {
        labelList sizes(part.boundaryMesh().nNonProcessor(), Zero);
        for (const polyPatch& pp : part.boundaryMesh())
        {
            const auto* divided = isA<processorCyclicPolyPatch>(pp);
            if (divided || !isA<processorPolyPatch>(pp))
            {
                sizes[divided ? divided->referPatchID() : pp.index()] +=
                    pp.size();
            }
        }
        Pstream::listCombineGather(sizes, plusEqOp<label>());

        return sizes;
    }

    //- Check that parts of a mesh make a whole: owners and neighbours, or -1, of
    //  faces of which so many are inner ones, on so many cells
    static void checkSides
    (
        const labelUList& owner,
        const labelUList& neighbour,
        const label nInner,
        const label nCells
    )
    {
        const SubList<label> inner(neighbour, max(nInner, label(0)));
        bitSet cells(nCells);

        if (!owner.found(-1) && !inner.found(-1))
        {
            cells.set(owner);
            cells.set(inner);
        }
        if (nInner < 0 || !cells.all())
        {
            FatalErrorInFunction
                << "the processors' meshes do not fit together by the files"
                << " *ProcAddressing beside them" << nl
                << "    Run decomposePar -force again" << exit(FatalError);
        }
    }
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

bool Foam::undecomposedFlow::readAddressing()
{
    const struct
    {
        const char* name;
        labelList& addressing;
        label size;
    }
    all[] =
    {
        {"pointProcAddressing", pointAddressing_, part_.nPoints()},
        {"cellProcAddressing", cellAddressing_, part_.nCells()},
        {"faceProcAddressing", faceAddressing_, part_.nFaces()}
    };

    for (const auto& one : all)
    {
        IOobject io
        (
            one.name,
            part_.facesInstance(),
            polyMesh::meshSubDir,
            part_,
            IOobject::MUST_READ,
            IOobject::NO_WRITE,
            false
        );
        bool found = io.typeHeaderOk<labelIOList>(false);
        if (!returnReduce(found, andOp<bool>()))
        {
            return false;
        }

        one.addressing = labelIOList(io);
        if (one.addressing.size() != one.size)
        {
            FatalErrorInFunction
                << io.objectPath() << " is of another mesh: it has "
                << one.addressing.size() << " entries, not " << one.size << nl
                << "    Run decomposePar -force again; or, if the mesh was made"
                << " or changed in parallel, remove the files *ProcAddressing"
                << exit(FatalError);
        }
    }

    // Those of faces are from 1, for the sake of their sign
    for (labelList* addressing : {&pointAddressing_, &cellAddressing_})
    {
        for (label& address : *addressing)
        {
            ++address;
        }
    }

    return true;
}


void Foam::undecomposedFlow::makeAddressing()
{
    const polyBoundaryMesh& patches = part_.boundaryMesh();
    checkUndivided(part_);

    labelList uniquePoints;
    part_.globalData().mergePoints(pointAddressing_, uniquePoints);
    for (label& address : pointAddressing_)
    {
        ++address;
    }

    const globalIndex cells(part_.nCells());
    cellAddressing_ = identity(part_.nCells(), 1 + cells.localStart());

    // Faces between cells belong to the rank of the lower cell, ordered by both
    labelList across;
    syncTools::swapBoundaryCellList(part_, cellAddressing_, across);

    std::vector<std::array<label, 3>> inner;
    forAll(part_.faces(), facei)
    {
        const label owner = cellAddressing_[part_.faceOwner()[facei]];
        const label patchi = patches.whichPatch(facei);

        if (patchi < 0)
        {
            inner.push_back
            ({
                owner, cellAddressing_[part_.faceNeighbour()[facei]], facei
            });
        }
        else if (isA<processorPolyPatch>(patches[patchi]))
        {
            const label other = across[facei - part_.nInternalFaces()];
            if (owner < other)
            {
                inner.push_back({owner, other, facei});
            }
        }
    }
    std::sort(inner.begin(), inner.end());

    faceAddressing_.setSize(part_.nFaces());
    faceAddressing_ = 0;
    const globalIndex innerFaces(inner.size());
    for (std::size_t i = 0; i < inner.size(); ++i)
    {
        faceAddressing_[inner[i][2]] = 1 + innerFaces.toGlobal(i);
    }

    label nBefore = 1 + innerFaces.size();
    for (label patchi = 0; patchi < patches.nNonProcessor(); ++patchi)
    {
        const polyPatch& pp = patches[patchi];
        const globalIndex patchFaces(pp.size());
        forAll(pp, i)
        {
            faceAddressing_[pp.start() + i] = nBefore + patchFaces.toGlobal(i);
        }
        nBefore += patchFaces.size();
    }

    forAll(across, i)
    {
        across[i] = faceAddressing_[part_.nInternalFaces() + i];
    }
    syncTools::swapBoundaryFaceList(part_, across);
    forAll(across, i)
    {
        label& address = faceAddressing_[part_.nInternalFaces() + i];
        address = address ? address : -across[i];
    }
}


void Foam::undecomposedFlow::makeMesh()
{
    // What this rank has, by the numbers of the undecomposed mesh: of each face
    // owner and neighbour from 1, or 0
    faceList faces(part_.faces());
    List<labelPair> sides(faces.size(), labelPair(0, 0));
    forAll(faces, facei)
    {
        const bool turned = faceAddressing_[facei] < 0;

        for (label& pointi : faces[facei])
        {
            pointi = pointAddressing_[pointi] - 1;
        }
        if (turned)
        {
            faces[facei].flip();
        }

        sides[facei][turned] = cellAddressing_[part_.faceOwner()[facei]];
        if (part_.isInternalFace(facei))
        {
            sides[facei][!turned] =
                cellAddressing_[part_.faceNeighbour()[facei]];
        }
    }

    const labelList patchSizes(wholePatchSizes(part_));
    const label nPoints = gMax(pointAddressing_);
    const label nFaces = max(gMax(faceAddressing_), -gMin(faceAddressing_));
    nCells_ = gMax(cellAddressing_);

    pointField points(putTogether(pointAddressing_, part_.points(), nPoints));
    faceList wholeFaces(Pstream::master() ? nFaces : 0);
    labelList owner(wholeFaces.size(), -1);
    labelList neighbour(wholeFaces.size(), -1);

    forAllRanks
    (
        faceAddressing_,
        faces,
        [&](const label address, const face& f)
        {
            wholeFaces[mag(address) - 1] = f;
        }
    );
    forAllRanks
    (
        faceAddressing_,
        sides,
        [&](const label address, const labelPair& side)
        {
            const label facei = mag(address) - 1;
            owner[facei] = max(owner[facei], side.first() - 1);
            neighbour[facei] = max(neighbour[facei], side.second() - 1);
        }
    );

    if (Pstream::master())
    {
        const serialScope serial;
        makeCase
        (
            std::move(points),
            std::move(wholeFaces),
            std::move(owner),
            std::move(neighbour),
            patchSizes
        );
    }
}


void Foam::undecomposedFlow::makeCase
(
    pointField&& points,
    faceList&& faces,
    labelList&& owner,
    labelList&& neighbour,
    const labelUList& patchSizes
)
{
    const label nInner = faces.size() - sum(patchSizes);
    checkSides(owner, neighbour, nInner, nCells_);
    neighbour.setSize(nInner);

    // A Time sets the digits of what is printed
    const int digits = Sout.precision();
    const Time& runTime = part_.time();

    time_.reset
    (
        new Time
        (
            Time::controlDictName,
            runTime.rootPath(),
            runTime.globalCaseName(),
            "system",
            "constant",
            false,
            false
        )
    );

    Sout.precision(digits);
    Pout.precision(digits);

    // Schemes are to be read, by which a mesh in constant would be, too. So it is
    // of a time that is not there; what is no number OpenFOAM takes for 0, and
    // that for constant where there is no folder 0
    mesh_.reset
    (
        new fvMesh
        (
            IOobject
            (
                polyMesh::defaultRegion,
                "1e300",
                *time_,
                IOobject::READ_IF_PRESENT
            ),
            std::move(points),
            std::move(faces),
            std::move(owner),
            std::move(neighbour)
        )
    );

    PtrList<polyPatch> patches(patchSizes.size());
    label start = nInner;
    forAll(patches, patchi)
    {
        patches.set
        (
            patchi,
            part_.boundaryMesh()[patchi].clone
            (
                mesh_->boundaryMesh(), patchi, patchSizes[patchi], start
            )
        );
        start += patchSizes[patchi];
    }
    mesh_->addFvPatches(patches);
}
