/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/

#include "cellParticles.H"
#include "atomicWrite.H"
#include "cellPoses.H"
#include "ellipsoidParcel.H"
#include "foamVersions.H"
#include "frozenFlow.H"
#include "IOField.H"
#include "polyMesh.H"
#include "Time.H"

// * * * * * * * * * * * * * * Static Data Members * * * * * * * * * * * * * //

const Foam::word Foam::cellParticles::cloudName("ellipsoidCloud");


// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- Takes fields into a registry
    struct registryTaker
    {
        objectRegistry& obr;

        template<class Type>
        void operator()(const word& name, const Field<Type>& values) const
        {
            cloud::createIOField<Type>(name, values.size(), obr)
                .Field<Type>::operator=(values);
        }
    };

    //- Takes fields into files of a cloud
    struct fileTaker
    {
        const Cloud<ellipsoidParcel>& c;

        template<class Type>
        void operator()(const word& name, const Field<Type>& values) const
        {
            IOField<Type> field
            (
                fieldFile(c, name, IOobject::NO_READ), values
            );
            atomicWrite(field, values.size() > 0);
        }
    };
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::DynamicList<Foam::cellParticles::particle>
Foam::cellParticles::local(const bool waiting) const
{
    DynamicList<particle> cells;
    for (const cellState& cell : cells_)
    {
        const label celli =
            localCells_[flow_.cell(frozenFlow::probe{cell.tet, -1})];

        if (celli >= 0 && (waiting || cell.fate != cellState::waiting))
        {
            cells.append({cell, celli});
        }
    }

    return cells;
}


template<class Taker>
void Foam::cellParticles::giveFields
(
    const UList<particle>& cells,
    const Taker& take
) const
{
    const label n = cells.size();
    labelField id(n), fate(n), sieve(n);
    vectorField U(n), omega(n), O(n), semiAxes(n);
    FixedList<scalarField, 4> q(scalarField(n, Zero));
    tensorField axes(n);

    forAll(cells, i)
    {
        const cellState& cell = cells[i].first;

        id[i] = cell.id;
        fate[i] = cell.fate;
        sieve[i] = cell.fate == cellState::caught ? cell.patch : -1;
        U[i] = pointOf(cell.body.u);
        omega[i] = pointOf(cell.body.omega);
        O[i] = longAxis(cell.body.q);
        for (label d = 0; d < 4; ++d)
        {
            q[d][i] = cell.body.q[d];
        }
        semiAxes[i] = pointOf(population_.model(cell.id).options.semi_axes);
        axes[i] = fullAxes(cell, population_);
    }

    take("id", id);
    take("fate", fate);
    take("sieve", sieve);
    take("U", U);
    take("omega", omega);
    take("O", O);
    take("eps1", q[0]);
    take("eps2", q[1]);
    take("eps3", q[2]);
    take("eta", q[3]);
    take("semiAxes", semiAxes);
    take("axes", axes);
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::cellParticles::cellParticles
(
    const polyMesh& mesh,
    const cellPopulation& population,
    const List<cellState>& cells,
    const frozenFlow& flow,
    const labelList& localCells
)
:
    cloud(mesh, cloudName),
    mesh_(mesh),
    population_(population),
    cells_(cells),
    flow_(flow),
    localCells_(localCells)
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::cellParticles::writeObjects(objectRegistry& obr) const
{
    const DynamicList<particle> cells(local(false));

    pointField& position =
        cloud::createIOField<point>("position", cells.size(), obr);
    forAll(cells, i)
    {
        position[i] = cells[i].first.centre();
    }

    giveFields(cells, registryTaker{obr});
}


void Foam::cellParticles::writeFiles(const label nEver) const
{
    for (const bool restart : {true, false})
    {
        const DynamicList<particle> particles(local(restart));
        List<cellState> states(particles.size());
        Cloud<ellipsoidParcel> c
        (
            mesh_,
            restart ? ellipsoidParcel::cloudName : cloudName,
            IDLList<ellipsoidParcel>()
        );

        forAll(particles, i)
        {
            states[i] = particles[i].first;
            c.addParticle
            (
                new ellipsoidParcel(mesh_, particles[i].second, states[i])
            );
        }

        if (restart)
        {
            ellipsoidParcel::particleCount_ = nEver;
            ellipsoidParcel::write(c, states);
        }
        else
        {
            ellipsoidParcel::writeFields(c);
            giveFields(particles, fileTaker{c});
        }
    }
}


// ************************************************************************* //
