// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

/*---------------------------------------------------------------------------*\
Description
    The cells as particles of OpenFOAM. A restart reads none of them: see
    checkpoint.

\*---------------------------------------------------------------------------*/

#include "ellipsoidCloud.H"
#include "atomicWrite.H"
#include "cellPoses.H"
#include "Cloud.H"
#include "fvMesh.H"
#include "IOField.H"
#include "IOPosition.H"
#include "passiveParticle.H"

namespace Foam
{

//- What is written of OpenFOAM's Cloud, which would end a run in which a
//- cyclicAMI patch is on several processors, whether or not a particle is near
class writtenParticles
:
    public cloud,
    public IDLList<passiveParticle>
{
    const polyMesh& mesh_;

public:

    typedef passiveParticle particleType;

    using IDLList<passiveParticle>::append;
    using IDLList<passiveParticle>::begin;
    using IDLList<passiveParticle>::end;
    using IDLList<passiveParticle>::size;

    writtenParticles(const polyMesh& mesh, const word& name)
    :
        cloud(mesh, name),
        mesh_(mesh)
    {
        // Ranks meet in it, also those without a particle
        mesh_.tetBasePtIs();
    }

    const polyMesh& pMesh() const
    {
        return mesh_;
    }
};

} // End namespace Foam

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::List<Foam::ellipsoidCloud::particle> Foam::ellipsoidCloud::particles() const
{
    DynamicList<particle> found;
    for (const cellState& cell : cells_)
    {
        // Until there is a flow no cell is in any part of the mesh
        const label celli =
            localCells_.empty()
          ? -1
          : localCells_[domain_->flow.cell(meshFlow::probe{cell.tet, -1})];

        if (celli >= 0 && !cell.waits())
        {
            found.append({cell, celli});
        }
    }

    return List<particle>(std::move(found));
}


void Foam::ellipsoidCloud::writeParticles() const
{
    const List<particle> cells(particles());
    const label n = cells.size();

    writtenParticles c(mesh_, name());
    labelField& origId = createIOField<label>("origId", n, c);
    createIOField<label>("origProcId", n, c) = 0;

    forAll(cells, i)
    {
        // Clear of the faces: beyond one by rounding would be an error
        const point x(cells[i].first.centre());
        const label celli = cells[i].second;
        const vector inwards(1e-6*(mesh_.cellCentres()[celli] - x));

        c.append(new passiveParticle(mesh_, x + inwards, celli));
        origId[i] = cells[i].first.id;
    }
    for (const auto type : {geometryType::COORDINATES, geometryType::POSITIONS})
    {
        IOPosition<writtenParticles> places(c, type);
        atomicWrite(places, n > 0);
    }

    writeObjects(c);
    c.checkOut("position");
    for (const word& field : c.sortedNames())
    {
        atomicWrite(c.lookupObjectRef<regIOobject>(field), n > 0);
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::ellipsoidCloud::writeObjects(objectRegistry& obr) const
{
    const List<particle> cells(particles());
    const label n = cells.size();

    pointField& position = createIOField<point>("position", n, obr);
    labelField& id = createIOField<label>("id", n, obr);
    labelField& fate = createIOField<label>("fate", n, obr);
    labelField& sieve = createIOField<label>("sieve", n, obr);
    vectorField& U = createIOField<vector>("U", n, obr);
    vectorField& omega = createIOField<vector>("omega", n, obr);
    vectorField& O = createIOField<vector>("O", n, obr);
    scalarField& eps1 = createIOField<scalar>("eps1", n, obr);
    scalarField& eps2 = createIOField<scalar>("eps2", n, obr);
    scalarField& eps3 = createIOField<scalar>("eps3", n, obr);
    scalarField& eta = createIOField<scalar>("eta", n, obr);
    vectorField& semiAxes = createIOField<vector>("semiAxes", n, obr);
    tensorField& axes = createIOField<tensor>("axes", n, obr);

    forAll(cells, i)
    {
        const cellState& cell = cells[i].first;

        position[i] = cell.centre();
        id[i] = cell.id;
        fate[i] = cell.fate;
        sieve[i] = cell.fate == cellState::caught ? cell.patch : -1;
        U[i] = pointOf(cell.body.u);
        omega[i] = pointOf(cell.body.omega);
        O[i] = longAxis(cell.body.q);
        eps1[i] = cell.body.q[0];
        eps2[i] = cell.body.q[1];
        eps3[i] = cell.body.q[2];
        eta[i] = cell.body.q[3];
        semiAxes[i] = pointOf(population_.model(cell.id).options.semi_axes);
        axes[i] = fullAxes(cell, population_);
    }
}
