// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

/*---------------------------------------------------------------------------*\
Application
    layerParts

Description
    Parts of the layer one by one, in a case whose mesh goes on in two
    directions: for each that is looked at a line with its name and whether it
    is as it should be.

\*---------------------------------------------------------------------------*/

#include "fvCFD.H"
#include "layerParts.H"
#include "groupSharing.H"

#include <cmath>

// * * * * * * * * * * * * * * * Shared Functions  * * * * * * * * * * * * * //

Foam::layer::layer
(
    const fvMesh& mesh,
    const vector& velocity,
    const tensor& gradient
)
:
    mesh(mesh),
    properties(mesh),
    population(properties),
    undecomposed(mesh),
    domain(population, undecomposed, autoPtr<volVectorField>(), false)
{
    const point middle(10e-6, 10e-6, 5e-6);
    volVectorField U
    (
        IOobject("U", mesh.time().timeName(), mesh),
        mesh,
        dimensionedVector("U", dimVelocity, velocity)
    );
    U.primitiveFieldRef() += gradient & (mesh.C().primitiveField() - middle);
    for (fvPatchVectorField& Up : U.boundaryFieldRef())
    {
        Up == velocity + (gradient & (Up.patch().Cf() - middle));
    }
    const surfaceScalarField phi("phi", fvc::flux(U));

    const volScalarField p
    (
        IOobject("p", mesh.time().timeName(), mesh),
        mesh,
        dimensionedScalar(dimless)
    );

    undecomposed.gather(solverFields{U, p, phi});
    domain.flow.renew(undecomposed, properties.options().fluid_density);
}


Foam::cellState Foam::layer::cellAt(const point& x, const label id) const
{
    cellState cell = cellState();
    meshFlow::probe at;

    std::copy_n(x.v_, 3, cell.body.x);
    cell.body.q[3] = 1;
    cell.id = id;
    cell.patch = -1;
    cell.size = population.medianSize();
    if (!domain.flow.find(x, at))
    {
        FatalErrorInFunction << x << " is not in the mesh" << exit(FatalError);
    }
    cell.tet = at.tet;

    return cell;
}


Foam::vector Foam::layer::drag(const vector& velocity) const
{
    const ellipsoid_model& model = population.median();

    return
        model.viscosity*cmptMultiply(pointOf(model.resistance), velocity);
}


void Foam::holds(const char* name, const bool does, const string& found)
{
    Info<< (does ? "holds: " : "WRONG: ") << name << nl;
    if (!does)
    {
        Info<< "    " << found.c_str() << nl;
    }
}


// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

// Across the edge where patches of two directions meet: the post's image, and
// another cell
static void checkDiagonals(const layer& at)
{
    const scalar period = 20e-6;
    const domainImages& images = at.domain.flow.images();
    const List<vector> periods(images.periods());

    bool all = periods.size() == 8;
    for (label i = -1; i < 2; ++i)
    {
        for (label j = -1; j < 2; ++j)
        {
            bool found = !i && !j;
            for (const vector& b : periods)
            {
                found = found || mag(b - period*vector(i, j, 0)) < 1e-9*period;
            }
            all = all && found;
        }
    }
    OStringStream os;
    os << periods;
    holds("eight periods are about one of two directions", all, os.str());

    // The post's nearest edge is 1 um off in both directions
    const auto slanted =
        [&](const scalar x)
        {
            cellState cell(at.cellAt(point(x, x, 5e-6)));
            cell.body.q[2] = -std::sin(constant::mathematical::pi/8);
            cell.body.q[3] = std::cos(constant::mathematical::pi/8);
            return
                cellInjection::overlaps
                (
                    cell, at.population.median(), at.domain
                );
        };
    holds("a wall's image across an edge is there", slanted(19.9e-6));
    holds("and no nearer", !slanted(19.5e-6));

    // 0.99 um apart, and as wide as 1 um
    List<cellState> cells(2);
    cells[0] = at.cellAt(point(19.5e-6, 19.5e-6, 5e-6), 0);
    cells[1] = at.cellAt(point(0.2e-6, 0.2e-6, 5e-6), 1);
    for (cellState& cell : cells)
    {
        cell.body.q[0] = cell.body.q[3] = std::sqrt(0.5);
    }
    groupScheduler scheduler(at.population, at.domain, nullptr, nullptr);
    const List<cellSweep> moved(scheduler.advanceInterval(cells, 0, 1e-3));
    const vector apart
    (
        moved[1].state.unfolded() + period*vector(1, 1, 0)
      - moved[0].state.unfolded()
    );
    os.rewind();
    os << moved[0].state.deepestCell << ' ' << moved[1].state.deepestCell
        << " deep, then " << apart;
    holds
    (
        "two cells push one another across an edge",
        moved[0].state.deepestCell > 1e-9 && moved[1].state.deepestCell > 1e-9
     && apart.x() > 0.701e-6 && apart.y() > 0.701e-6,
        os.str()
    );
}


// What a restart knows the mesh by
static void checkMeshNotes(const polyMesh& mesh)
{
    pointField points(mesh.points());
    faceList faces(mesh.faces());
    labelList owner(mesh.faceOwner());
    labelList neighbour(mesh.faceNeighbour());

    const auto digest = [&]()
    {
        const polyMesh other
        (
            IOobject("other", mesh.time().timeName(), mesh.time()),
            pointField(points), faceList(faces), labelList(owner),
            labelList(neighbour), false
        );
        return checkpoint::meshText(other);
    };
    const string before(digest());

    points[0].x() -= 1e-9;
    holds("a point that has moved makes another mesh", digest() != before);
    points = mesh.points();
    faces[0].flip();
    holds("so does a face of other points", digest() != before);
    faces = mesh.faces();
    Swap(owner.first(), owner.last());
    holds("so does another owner", digest() != before);
    owner = mesh.faceOwner();
    Swap(neighbour.first(), neighbour.last());
    holds("so does another neighbour", digest() != before);
    neighbour = mesh.faceNeighbour();
    holds("the same mesh is the same", digest() == before);

    bool told = true;
    const string text(checkpoint::meshText(mesh));
    for (const polyPatch& pp : mesh.boundaryMesh())
    {
        OStringStream patch;
        patch << pp.name() << ' ' << pp.type() << ' ' << pp.start() << ' '
            << pp.size();
        told = told && text.find(patch.str()) != std::string::npos;
    }
    holds("with the patches and where they begin", told);
}


// Ranks give one another what they have advanced
static void checkSharing()
{
    const label nCells = 23;
    const label nRanks = Pstream::nProcs();
    List<cellSweep> cells(nCells, cellSweep());

    // Cells of a group do not follow one another in the list; one is slow
    List<labelList> groups;
    for (label i = 0; i < nCells;)
    {
        labelList group(min(1 + i % 3, nCells - i));
        for (label& member : group)
        {
            member = (5*i++) % nCells;
            cells[member].state.controller.step = member == 7 ? 1e-9 : 1e-4;
        }
        groups.append(group);
    }
    const labelList ranks(groupSharing::distributed(cells, groups, 1e-2));

    // Every byte tells which cell it is of, and whether that was advanced
    const auto filled = [](const label i, const bool advanced)
    {
        cellSweep cell;
        char* byte = reinterpret_cast<char*>(&cell);
        for (std::size_t k = 0; k < sizeof(cellSweep); ++k)
        {
            byte[k] = char(7*k + 3*i + (advanced ? 101 : 0));
        }
        return cell;
    };
    forAll(groups, k)
    {
        for (const label i : groups[k])
        {
            cells[i] = filled(i, ranks[k] == Pstream::myProcNo());
        }
    }
    groupSharing::exchange(cells, groups, ranks);

    label nWrong = 0;
    forAll(cells, i)
    {
        const cellSweep wanted(filled(i, true));
        nWrong += std::memcmp(&wanted, &cells[i], sizeof(cellSweep)) != 0;
    }
    nWrong = returnReduce(nWrong, sumOp<label>());
    holds
    (
        "every rank has what each has advanced",
        nWrong == 0,
        Foam::name(nWrong) + " cells have not"
    );

    labelList nOf(nRanks, 0);
    label busy = -1;
    forAll(groups, k)
    {
        ++nOf[ranks[k]];
        busy = groups[k].found(7) ? ranks[k] : busy;
    }
    OStringStream os;
    os << nOf;
    holds
    (
        "a rank with a slow cell has no other group, the rest share them",
        nRanks == 1
     || (nOf[busy] == 1 && max(nOf) <= groups.size()/(nRanks - 1) + 1),
        os.str()
    );
}


int main(int argc, char *argv[])
{
    #include "setRootCase.H"
    #include "createTime.H"
    #include "createMesh.H"

    if (mesh.boundaryMesh().findPatchID("open") >= 0)
    {
        checkOpen(mesh);
    }
    else if (mesh.boundaryMesh().findPatchID("plateOne") >= 0)
    {
        checkBaffle(mesh);
    }
    else if (mesh.boundaryMesh().findPatchID("begin") >= 0)
    {
        checkRing(mesh);
    }
    else if (mesh.boundaryMesh().findPatchID("ahead") >= 0)
    {
        checkStepped(mesh);
    }
    else if (mesh.boundaryMesh().findPatchID("mirror") >= 0)
    {
        checkBoundaries(mesh);
    }
    else
    {
        const layer still(mesh, Zero);
        const layer stream(mesh, vector(1e-3, 2e-3, -1e-3));

        checkDiagonals(still);
        checkMotion(still, stream);
        checkInjections(stream);
        checkSharing();
        if (!Pstream::parRun())
        {
            checkMeshNotes(mesh);
            checkHeld(still);
            checkBodies(stream);
            checkApertures(stream);
            checkCaptures(stream);
            checkStatistics(still);
            checkTables(still);
        }
    }
    Info<< "End" << nl << endl;

    return 0;
}
