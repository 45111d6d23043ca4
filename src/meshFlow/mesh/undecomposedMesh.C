// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

/*---------------------------------------------------------------------------*\
Description
    The undecomposed mesh, put together from the parts of the ranks.

\*---------------------------------------------------------------------------*/

#include "undecomposedFlow.H"
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
    //- Check that no cyclic patch is divided: its faces could not be paired
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

    //- Check that parts of a mesh make a whole: owners and neighbours, or -1,
    //  of faces of which so many are inner ones, on so many mesh cells
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
    turned_.resize(part_.nFaces());
    forAll(faceAddressing_, facei)
    {
        label& address = faceAddressing_[facei];
        turned_.set(facei, address < 0);
        address = mag(address) - 1;
    }

    return true;
}


void Foam::undecomposedFlow::makeAddressing()
{
    const polyBoundaryMesh& patches = part_.boundaryMesh();
    checkUndivided(part_);

    labelList uniquePoints;
    part_.globalData().mergePoints(pointAddressing_, uniquePoints);

    const globalIndex cells(part_.nCells());
    cellAddressing_ = identity(part_.nCells(), cells.localStart());

    // Faces between cells belong to the rank of the lower cell, ordered by both
    labelList across;
    syncTools::swapBoundaryCellList(part_, cellAddressing_, across);

    std::vector<std::array<label, 3>> inner;
    forAll(part_.faces(), facei)
    {
        const label owner = cellAddressing_[part_.faceOwner()[facei]];
        label other = -1;

        if (part_.isInternalFace(facei))
        {
            other = cellAddressing_[part_.faceNeighbour()[facei]];
        }
        else if (isA<processorPolyPatch>(patches[patches.whichPatch(facei)]))
        {
            other = across[facei - part_.nInternalFaces()];
        }
        if (owner < other)
        {
            inner.push_back({owner, other, facei});
        }
    }
    std::sort(inner.begin(), inner.end());

    faceAddressing_ = labelList(part_.nFaces(), -1);
    const globalIndex innerFaces(inner.size());
    for (std::size_t i = 0; i < inner.size(); ++i)
    {
        faceAddressing_[inner[i][2]] = innerFaces.toGlobal(i);
    }

    label nBefore = innerFaces.size();
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

    across =
        SubList<label>(faceAddressing_, across.size(), part_.nInternalFaces());
    syncTools::swapBoundaryFaceList(part_, across);
    turned_.resize(part_.nFaces());
    forAll(across, i)
    {
        const label facei = part_.nInternalFaces() + i;
        if (faceAddressing_[facei] < 0)
        {
            faceAddressing_[facei] = across[i];
            turned_.set(facei);
        }
    }
}


void Foam::undecomposedFlow::makeMesh()
{
    // What this rank has, by the numbers of the undecomposed mesh: of each face
    // owner and neighbour, or -1
    faceList partFaces(part_.faces());
    List<labelPair> partSides(partFaces.size(), labelPair(-1, -1));
    forAll(partFaces, facei)
    {
        const bool turned = turned_.test(facei);

        inplaceRenumber(pointAddressing_, partFaces[facei]);
        if (turned)
        {
            partFaces[facei].flip();
        }

        labelPair& side = partSides[facei];
        side[turned] = cellAddressing_[part_.faceOwner()[facei]];
        if (part_.isInternalFace(facei))
        {
            side[!turned] = cellAddressing_[part_.faceNeighbour()[facei]];
        }
    }

    const labelList patchSizes(wholePatchSizes(part_));
    const label nPoints = 1 + gMax(pointAddressing_);
    const label nFaces = 1 + gMax(faceAddressing_);
    nCells_ = 1 + gMax(cellAddressing_);

    const bool master = Pstream::master();
    pointField points(master ? nPoints : 0, Zero);
    faceList faces(master ? nFaces : 0);
    labelList owner(faces.size(), -1);
    labelList neighbour(faces.size(), -1);

    putTogether(pointAddressing_, part_.points(), points);
    putTogether(faceAddressing_, partFaces, faces);

    // A face between ranks has its owner from one, its neighbour from the other
    const labelList to(joined(faceAddressing_));
    const List<labelPair> sides(joined(partSides));
    forAll(to, i)
    {
        owner[to[i]] = max(owner[to[i]], sides[i].first());
        neighbour[to[i]] = max(neighbour[to[i]], sides[i].second());
    }

    if (master)
    {
        const serialScope serial;
        makeCase
        (
            std::move(points),
            std::move(faces),
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

    // Schemes are to be read, and a mesh in constant would be with them. So it
    // is of a time that is not there. A name that is no number would be taken
    // for 0, and 0 for constant where there is no such folder.
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
