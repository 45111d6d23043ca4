// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "steadyFlow.H"
#include "checkedEntries.H"
#include "findRefCell.H"
#include "fixedFluxPressureFvPatchScalarField.H"
#include "fvcDiv.H"
#include "fvcGrad.H"
#include "fvmDiv.H"
#include "fvmLaplacian.H"
#include "fvmSup.H"
#include "fvMatrices.H"
#include "fvMesh.H"
#include "inletFlux.H"
#include "IOdictionary.H"
#include "jumpCyclicFvPatchField.H"
#include "masterGate.H"
#include "PstreamReduceOps.H"
#include "readViscosity.H"
#include "regionSplit.H"
#include "Time.H"

// * * * * * * * * * * * * * * Static Data Members * * * * * * * * * * * * * //

const Foam::word Foam::steadyFlow::transposedScheme_
(
    "div((nuEff*dev2(T(grad(U)))))",
    false
);


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
    IOobject io
    (
        name, folder, mesh.time(), IOobject::MUST_READ, IOobject::NO_WRITE, false
    );

    if (!io.typeHeaderOk<IOdictionary>(true))
    {
        return dictionary();
    }
    return IOdictionary(io);
}


//- Set the clock of a case while it lives
class clockAt
{
    //- Without the files of that time, which setTime would look at
    dimensionedScalar& time_;

    const scalar value_;


public:

    clockAt(const Time& time, const scalar value)
    :
        time_(const_cast<Time&>(time)),
        value_(time.value())
    {
        time_.value() = value;
    }

    ~clockAt()
    {
        time_.value() = value_;
    }
};


//- The values of a field at its patches by the clock
template<class Type>
static FieldField<Field, Type> valuesAt
(
    const GeometricField<Type, fvPatchField, volMesh>& field,
    const scalar value
)
{
    const clockAt then(field.time(), value);
    GeometricField<Type, fvPatchField, volMesh> copy(field);
    copy.correctBoundaryConditions();

    FieldField<Field, Type> values(copy.boundaryField().size());
    forAll(values, patchi)
    {
        values.set(patchi, new Field<Type>(copy.boundaryField()[patchi]));
    }

    return values;
}


//- Say which patches have other values of a field at other times of the run
template<class Type>
static void tellOfClock
(
    const GeometricField<Type, fvPatchField, volMesh>& field,
    const scalar value
)
{
    const Time& time = field.time();
    const scalar left = time.endTime().value() - value;

    // One that a solver feeds cannot be evaluated apart from it
    for (const fvPatchField<Type>& pf : field.boundaryField())
    {
        if (isA<fixedFluxPressureFvPatchScalarField>(pf))
        {
            return;
        }
    }

    const FieldField<Field, Type> now(valuesAt(field, value));
    string changing;

    const FieldField<Field, Type> soon(valuesAt(field, value + time.deltaTValue()));
    const FieldField<Field, Type> later(valuesAt(field, value + 0.37*left));
    const FieldField<Field, Type> end(valuesAt(field, value + left));

    // Processor patches differ from rank to rank
    forAll(field.mesh().boundary(), patchi)
    {
        const fvPatch& patch = field.mesh().boundary()[patchi];
        if (!patch.coupled())
        {
            const scalarField change
            (
                mag(soon[patchi] - now[patchi])
              + mag(later[patchi] - now[patchi])
              + mag(end[patchi] - now[patchi])
            );
            if (gMax(change) > 1e-6*gMax(scalarField(mag(now[patchi]))) + VSMALL)
            {
                changing += (changing.empty() ? " at " : ", ") + patch.name();
            }
        }
    }

    if (changing.size())
    {
        Warning
            << field.name() << changing.c_str()
            << " changes with time. The flow is steady: that of "
            << word::printf("%.6g", value) << " s, for the whole run" << nl
            << endl;
    }
}

} // End namespace Foam


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::steadyFlow::checkControls() const
{
    const masterGate once;

    // What other solvers read there is in many a case
    const wordHashSet known
    ({
        "coupled", "consistent", "nNonOrthogonalCorrectors", "maxIterations",
        "residualControl", "fluxTolerance", "fluxWindow",
        "pRefCell", "pRefPoint", "pRefValue"
    });
    const wordHashSet knownElsewhere
    ({
        "momentumPredictor", "transonic", "frozenFlow", "nCorrectors",
        "nOuterCorrectors", "turbOnFinalIterOnly", "pMin", "pMax",
        "pMinFactor", "pMaxFactor", "rhoMin", "rhoMax"
    });

    for (const char* field : {"U", "p"})
    {
        checkValues
        (
            mesh_.solverDict(field), {"solver", "tolerance", "relTol", "maxIter"}
        );
    }
    for (const entry& e : controls_)
    {
        if (e.isDict() && e.keyword() != "residualControl")
        {
            streamOf(controls_, e.keyword());
        }
    }

    wordHashSet unknown(controls_.toc());
    unknown -= known;
    unknown -= knownElsewhere;
    for (const word& name : unknown.toc())
    {
        if (isVariable(controls_, name))
        {
            unknown.erase(name);
        }
    }

    if (unknown.size())
    {
        FatalIOErrorInFunction(controls_)
            << "Unknown entries " << unknown.sortedToc() << nl
            << "Known are " << known.sortedToc() << exit(FatalIOError);
    }

    if
    (
        controls_.getOrDefault("consistent", true)
     && !(
            mesh_.relaxEquation("U")
         && mesh_.equationRelaxationFactor("U") < 1
        )
    )
    {
        FatalIOErrorInFunction(mesh_.solutionDict())
            << "SIMPLEC needs a relaxation factor of the U equation below 1:"
            << " relaxationFactors { equations { U 0.9; } }"
            << exit(FatalIOError);
    }
}


Foam::coupledStokes::settings Foam::steadyFlow::readControls() const
{
    checkJumps();
    checkControls();

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
    for (const word& folder : {mesh_.time().constant(), mesh_.time().system()})
    {
        const dictionary sources(readIfPresent(mesh_, "fvOptions", folder));
        const masterGate once;

        if (sources.size())
        {
            FatalErrorInFunction
                << "The sources of " << folder << "/fvOptions are not solved"
                << " for. Solve the flow with a solver that does, and take it as"
                << " it is: -frozenFlow, or flow { solve no; } in"
                << " system/fvSolution" << exit(FatalError);
        }
    }

    const word constant(mesh_.time().constant());
    const dictionary turbulence
    (
        readIfPresent(mesh_, "turbulenceProperties", constant)
    );
    const word type
    (
        turbulence.getOrDefault<word>("simulationType", "laminar")
    );
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


void Foam::steadyFlow::checkJumps() const
{
    const masterGate once;

    for (const fvPatchScalarField& pp : p_.boundaryField())
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


void Foam::steadyFlow::restore(const flow& kept)
{
    U_ == kept.U;
    p_ == kept.p;
    phi_ == kept.phi;
}


Foam::tmp<Foam::fvVectorMatrix> Foam::steadyFlow::momentum()
{
    tmp<fvVectorMatrix> UEqn(fvm::div(phi_, U_) - fvm::laplacian(nu_, U_));

    if (hasTransposed_)
    {
        UEqn.ref() -= fvc::div(nu_*dev2(T(fvc::grad(U_))), transposedScheme_);
    }
    if (const auto* resistance = mesh_.cfindObject<volScalarField>("resistance"))
    {
        UEqn.ref() += fvm::Sp(*resistance, U_);
    }

    return UEqn;
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::steadyFlow::steadyFlow(const fvMesh& mesh, const solveType solve)
:
    flowFields(mesh),
    solve_(solve),
    controls_
    (
        mesh.solutionDict().found("SIMPLE")
      ? subDictOf(mesh.solutionDict(), "SIMPLE")
      : mesh.solutionDict().subDict("SIMPLE")
    ),
    hasTransposed_
    (
        mesh.schemesDict().subOrEmptyDict("divSchemes").found(transposedScheme_)
    ),
    nu_(readViscosity(mesh)),
    how_(readControls()),
    solver_(U_, p_, phi_, nu_, [this] { return momentum(); }, how_),
    clock_(mesh.time().value())
{
    // What reads the clock is as it was when the flow was solved
    readScalar(instance_, clock_);
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

bool Foam::steadyFlow::converged()
{
    if (unfinished())
    {
        Info<< "flow: not all of it was written in " << instance_ << endl;
        return false;
    }

    const clockAt then(mesh_.time(), clock_);
    const bool steady = solver_.isSteady();
    if (steady)
    {
        Info<< "flow: already converged (" << solver_.measures().c_str()
            << "), not solved again: as stored in " << instance_ << endl;
    }

    return steady;
}


void Foam::steadyFlow::solveFrom(const flow& kept, const scalar tolerance)
{
    restore(kept);
    solver_.setTolerance(tolerance);
    solve(false);
}


void Foam::steadyFlow::refuseForeign() const
{
    if (foreign())
    {
        const masterGate once;
        FatalErrorInFunction
            << "The flow in " << instance_ << " is of another program, and not"
            << " steady by the measures of this one:" << nl
            << solver_.shortcomings().c_str()
            << "-frozenFlow, or flow { solve no; } in system/fvSolution, takes"
            << " it as it is; flow { solve yes; } solves it again and keeps its"
            << " files as U.bak, p.bak and phi.bak" << exit(FatalError);
    }
}


Foam::autoPtr<Foam::flowFields> Foam::steadyFlow::New
(
    const fvMesh& mesh,
    const solveType solve
)
{
    return autoPtr<flowFields>
    (
        solve == NO ? new flowFields(mesh) : new steadyFlow(mesh, solve)
    );
}


bool Foam::steadyFlow::accept()
{
    if (solve_ == AUTO)
    {
        // A flux that was not there to be read is not steady
        if (hasFlux_ && converged())
        {
            tellOfClocks();
            return true;
        }
        refuseForeign();
    }
    checkModels();
    checkRegions();

    return false;
}


void Foam::steadyFlow::tellOfClocks() const
{
    tellOfClock(U_, clock_);
    tellOfClock(p_, clock_);
}


void Foam::steadyFlow::solve()
{
    clock_ = mesh_.time().value();
    tellOfClocks();
    solve(true);
}


void Foam::steadyFlow::solve(const bool scaled)
{
    Info<< "flow: solved from that in " << instance_ << " by "
        << (how_.coupled ? "corrections of U and p together, checked by " : "")
        << (how_.consistent ? "SIMPLEC" : "SIMPLE") << endl;
    if (!how_.coupled && !controls_.found("coupled"))
    {
        Info<< "flow: U and p are not corrected together, which does not deal"
            << " with " << coupledStokes::refusal(U_, p_).c_str() << endl;
    }

    const clockAt then(mesh_.time(), clock_);
    const coupledStokes::outcome end = solver_.solve(scaled);
    const masterGate once;

    if (end == coupledStokes::DIVERGED)
    {
        FatalIOErrorInFunction(controls_)
            << "The flow diverges: the last iteration left "
            << solver_.measures().c_str() << nl
            << "Nothing was written. Lower the relaxationFactors, or check"
            << " the boundary conditions and nu." << exit(FatalIOError);
    }
    if (end == coupledStokes::UNSTEADY)
    {
        FatalIOErrorInFunction(controls_)
            << "The flow is not steady after " << how_.maxIterations
            << " iterations:" << nl << solver_.shortcomings().c_str()
            << "Nothing was written. Raise maxIterations or the U entry of"
            << " relaxationFactors, or loosen residualControl or"
            << " fluxTolerance." << exit(FatalIOError);
    }
}
