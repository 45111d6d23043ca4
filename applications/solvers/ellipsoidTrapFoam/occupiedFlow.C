// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "occupiedFlow.H"
#include "masterGate.H"
#include "readViscosity.H"

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::occupiedFlow::makeOwn()
{
    const undecomposedFlow::serialScope serial;
    const fvMesh& mesh = cells_.undecomposed().mesh();

    if (mesh.solverDict("p").get<word>("solver") == "GAMG")
    {
        FatalIOErrorInFunction(mesh.solverDict("p"))
            << "On several ranks occupancy needs another solver of p than GAMG,"
            << " whose levels depend on the number of ranks: PCG"
            << exit(FatalIOError);
    }

    own_.reset(new steadyFlow(mesh, flowFields::YES));
    flow_ = own_.get();

    const vectorField& ofParts = cells_.undecomposed().U().primitiveField();
    const scalarField differences(mag(flow_->U().primitiveField() - ofParts));
    const scalar fastest = max(mag(ofParts));

    // decomposePar rounds to writePrecision
    if (!(max(differences) <= 1e-4*fastest))
    {
        FatalErrorInFunction
            << "The flow of the undecomposed case, " << flow_->U().objectPath()
            << ", is not that of its parts, from which occupancy has to start."
            << nl << "    Solve it with -flowOnly on one rank, then run"
            << " decomposePar" << exit(FatalError);
    }
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::occupiedFlow::occupiedFlow
(
    flowFields& empty,
    const ellipsoidCloud& cells
)
:
    cells_(cells),
    flow_(dynamic_cast<steadyFlow*>(&empty))
{
    const masterGate once;

    if (!flow_)
    {
        FatalErrorInFunction
            << "Cells that block the flow, occupancy, need a flow that is"
            << " solved here, not one taken as it is: without -frozenFlow, and without"
            << " solve no in the dictionary flow of system/fvSolution"
            << exit(FatalError);
    }
    if (Pstream::parRun())
    {
        flow_ = nullptr;
        if (Pstream::master())
        {
            makeOwn();
        }
    }

    if (flow_)
    {
        const undecomposedFlow::serialScope serial;

        empty_.reset(new steadyFlow::flow(*flow_));

        const fvMesh& mesh = flow_->U().mesh();
        solids_.reset(new solidBodies(mesh, readViscosity(mesh)));
    }
}


Foam::occupiedFlow::~occupiedFlow()
{
    const undecomposedFlow::serialScope serial;

    solids_.clear();
    empty_.clear();
    own_.clear();
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::solverFields Foam::occupiedFlow::solve
(
    const List<heldBody>& bodies,
    List<heldWrench>& wrenches
)
{
    Info<< "occupancy: " << bodies.size() << " cells held" << endl;
    solids_->set(bodies);
    if (bodies.empty())
    {
        flow_->restore(*empty_);
    }
    else
    {
        flow_->solveFrom(*empty_, cells_.occupied()->settings().tolerance);
    }

    wrenches = solids_->wrenches(flow_->U(), cells_.fluidDensity());
    forAll(bodies, i)
    {
        Info<< "occupancy: cell " << bodies[i].id << ": force "
            << wrenches[i].force << " N, torque " << wrenches[i].torque
            << " N m" << endl;
    }

    return flow_->fields();
}
