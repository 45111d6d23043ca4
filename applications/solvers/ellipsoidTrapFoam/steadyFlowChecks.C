// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "steadyFlow.H"
#include "checkedEntries.H"
#include "findRefCell.H"
#include "fvMesh.H"
#include "inletFlux.H"
#include "IOdictionary.H"
#include "jumpCyclicFvPatchField.H"
#include "masterGate.H"
#include "PstreamReduceOps.H"
#include "regionSplit.H"
#include "Time.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{

//- A dictionary that may be absent; collective
static dictionary readIfPresent
(
    const fvMesh& mesh,
    const word& name,
    const fileName& folder
)
{
    return IOdictionary
    (
        IOobject
        (
            name, folder, mesh.time(),
            IOobject::READ_IF_PRESENT, IOobject::NO_WRITE, false
        )
    );
}


//- Refuse entries of the dictionary SIMPLE that no solver knows
static void checkControls(const fvMesh& mesh, const dictionary& controls)
{
    const masterGate once;

    checkKeywords
    (
        controls,
        {
            "coupled", "consistent", "nNonOrthogonalCorrectors",
            "maxIterations", "residualControl", "fluxTolerance", "fluxWindow",
            "pRefCell", "pRefPoint", "pRefValue",

            // Of other solvers, as in many a case
            "momentumPredictor", "transonic", "frozenFlow", "nCorrectors",
            "nOuterCorrectors", "turbOnFinalIterOnly", "pMin", "pMax",
            "pMinFactor", "pMaxFactor", "rhoMin", "rhoMax"
        },
        {"residualControl"}
    );
    for (const char* field : {"U", "p"})
    {
        checkValues
        (
            mesh.solverDict(field),
            {"solver", "tolerance", "relTol", "maxIter"}
        );
    }

    if
    (
        controls.getOrDefault("consistent", true)
     && !(
            mesh.relaxEquation("U")
         && mesh.equationRelaxationFactor("U") < 1
        )
    )
    {
        FatalIOErrorInFunction(mesh.solutionDict())
            << "SIMPLEC needs a relaxation factor of the U equation below 1:"
            << " relaxationFactors { equations { U 0.9; } }"
            << exit(FatalIOError);
    }
}


//- Refuse patches at which a field has no condition, as createBaffles leaves
//  them, of which OpenFOAM makes a stack trace
template<class Field>
static void checkConditions(const Field& field)
{
    const masterGate once;

    for (const auto& pf : field.boundaryField())
    {
        if (pf.type() == "calculated")
        {
            FatalErrorInFunction
                << field.objectPath() << " is " << pf.type() << " at patch "
                << pf.patch().name() << " of type " << pf.patch().type() << nl
                << "    A flow to be solved needs a condition there: noSlip of"
                << " U and zeroGradient of p at a wall" << exit(FatalError);
        }
    }
}


//- Refuse jumps of the pressure, which decomposePar loses
static void checkJumps(const volScalarField& p)
{
    const masterGate once;

    for (const fvPatchScalarField& pp : p.boundaryField())
    {
        if
        (
            Pstream::parRun() && isA<jumpCyclicFvPatchField<scalar>>(pp)
        )
        {
            FatalErrorInFunction
                << "p has a jump, " << pp.type() << ", at patch "
                << pp.patch().name() << ", which decomposePar loses" << nl
                << "    Solve the flow on one rank, then decomposePar and"
                << " -frozenFlow" << exit(FatalError);
        }
    }
}

} // End namespace Foam


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::coupledStokes::settings Foam::steadyFlow::readControls() const
{
    checkConditions(U_);
    checkConditions(p_);
    checkJumps(p_);
    checkControls(mesh_, controls_);

    coupledStokes::settings how;
    const string refusal(coupledStokes::refusal(U_, p_));
    how.coupled = controls_.getOrDefault("coupled", refusal.empty());
    how.consistent = controls_.getOrDefault("consistent", how.consistent);
    {
        const masterGate once;

        if (how.coupled && !refusal.empty())
        {
            FatalIOErrorInFunction(controls_)
                << "coupled yes does not deal with " << refusal.c_str()
                << ": set coupled no" << exit(FatalIOError);
        }

        how.nNonOrthogonalCorrectors = checkedNumber
        (
            controls_, "nNonOrthogonalCorrectors", atLeast(0),
            how.nNonOrthogonalCorrectors
        );
        how.maxIterations = checkedNumber
        (
            controls_, "maxIterations", atLeast(1), how.maxIterations
        );
        how.fluxTolerance = checkedNumber
        (
            controls_, "fluxTolerance", above(0), how.fluxTolerance
        );
        how.fluxWindow = checkedNumber
        (
            controls_, "fluxWindow", atLeast(1), how.fluxWindow
        );
        const dictionary& targets = subDictOf(controls_, "residualControl");
        how.pResidual = checkedNumber(targets, "p", above(0), how.pResidual);
        how.UResidual = checkedNumber(targets, "U", above(0), how.UResidual);
    }
    setRefCell(p_, controls_, how.pRefCell, how.pRefValue);

    return how;
}


void Foam::steadyFlow::checkModels() const
{
    const word constant(mesh_.time().constant());
    for
    (
        const fileName& file :
        {
            constant/"fvOptions", mesh_.time().system()/"fvOptions",
            constant/"MRFProperties", constant/"porosityProperties"
        }
    )
    {
        const dictionary sources(readIfPresent(mesh_, file.name(), file.path()));
        const masterGate once;
        bool active = false;

        // All are in a dictionary of their own, or none
        for (const entry& e : sources.optionalSubDict("options"))
        {
            active =
                active || (e.isDict() && e.dict().getOrDefault("active", true));
        }
        if (active)
        {
            FatalErrorInFunction
                << "The sources of " << file.c_str() << " are not solved"
                << " for. Solve the flow with a solver that does, and take it as"
                << " it is: -frozenFlow, or flow { solve no; } in"
                << " system/fvSolution" << exit(FatalError);
        }
    }

    const dictionary turbulence
    (
        readIfPresent(mesh_, "turbulenceProperties", constant)
    );
    const word type(turbulence.getOrDefault<word>("simulationType", "laminar"));
    const dictionary motion(readIfPresent(mesh_, "dynamicMeshDict", constant));
    const word moving
    (
        motion.getOrDefault<word>("dynamicFvMesh", "staticFvMesh")
    );

    if (type != "laminar")
    {
        WarningInFunction
            << "The flow is solved without the " << type << " model of "
            << constant << "/turbulenceProperties: it is laminar" << nl << endl;
    }
    if (moving != "staticFvMesh")
    {
        WarningInFunction
            << "The mesh stands still: " << moving << " of " << constant
            << "/dynamicMeshDict is not read" << nl << endl;
    }
}


void Foam::steadyFlow::checkRegions() const
{
    const regionSplit regions(mesh_);
    const label n = regions.nRegions();
    if (n == 1)
    {
        return;
    }

    boolList open(n, false);
    for (const label patchi : inletFlux::openPatches(mesh_.boundaryMesh()))
    {
        for (const label celli : mesh_.boundary()[patchi].faceCells())
        {
            open[regions[celli]] = true;
        }
    }
    Pstream::listCombineGather(open, orEqOp<bool>());

    labelList sizes(n, Zero);
    pointField places(n, point::uniform(GREAT));
    forAll(regions, celli)
    {
        ++sizes[regions[celli]];
        places[regions[celli]] = mesh_.C()[celli];
    }
    Pstream::listCombineGather(sizes, plusEqOp<label>());
    Pstream::listCombineGather(places, minMagSqrEqOp<point>());

    const masterGate once;
    const label closed = open.find(false);
    // Where all are closed, walls drive the flow of each
    if (Pstream::master() && closed >= 0 && open.found(true))
    {
        FatalErrorInFunction
            << "The mesh is in " << n << " regions, of which "
            << std::count(open.begin(), open.end(), false)
            << " are reached by no opening: the first has " << sizes[closed]
            << " mesh cells, one at " << places[closed] << " m" << nl
            << "    Remove them (splitMeshRegions -largestOnly, or"
            << " cellSet and subsetMesh), or give each a patch that the fluid"
            << " passes" << exit(FatalError);
    }
}
