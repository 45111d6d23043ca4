/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/

#include "steadyFlow.H"
#include "adjustPhi.H"
#include "clockTime.H"
#include "constrainHbyA.H"
#include "constrainPressure.H"
#include "ellipsoidProperties.H"
#include "findRefCell.H"
#include "fvcDiv.H"
#include "fvcFlux.H"
#include "fvcGrad.H"
#include "fvcSnGrad.H"
#include "fvcSurfaceIntegrate.H"
#include "fvmDiv.H"
#include "fvmLaplacian.H"
#include "fvMatrices.H"
#include "fvMesh.H"
#include "masterGate.H"
#include "PstreamReduceOps.H"
#include "readViscosity.H"
#include "sigFpe.H"
#include "StringStream.H"
#include "surfaceInterpolate.H"
#include "atomicWrite.H"
#include "checkpoint.H"

#include <cmath>

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{

// The solver performance of every solve within one time step is kept, and
// copied with each solve: a thousand iterations would come to seconds
static void forgetSolverPerformance(const fvMesh& mesh)
{
    #if OPENFOAM >= 2312
    const dictionary& dict = mesh.data().solverPerformanceDict();
    #else
    const dictionary& dict = mesh.solverPerformanceDict();
    #endif

    const_cast<dictionary&>(dict).clear();
}


// The precision of Info is that of the fields, far more than one can read
static word text(const scalar value)
{
    return word::printf("%.6g", value);
}


//- The first value that is not finite, and where; empty if there is none
template<class Type>
static string findNotFinite
(
    const UList<Type>& values,
    const UList<vector>& centres,
    const word& where
)
{
    forAll(values, i)
    {
        for (direction cmpt = 0; cmpt < pTraits<Type>::nComponents; ++cmpt)
        {
            if (!std::isfinite(component(values[i], cmpt)))
            {
                OStringStream os;
                os.precision(6);
                os  << values[i] << " in " << where << ' ' << i << " at "
                    << centres[i] << " m";
                return os.str();
            }
        }
    }

    return string();
}


//- End the run if a value of a field is not finite
template<class Field, class Centres>
static void checkFinite
(
    const Field& field,
    const Centres& centres,
    const word& where
)
{
    List<string> found(Pstream::nProcs());
    string& mine = found[Pstream::myProcNo()];

    mine = findNotFinite
    (
        field.primitiveField(), centres.primitiveField(), where
    );

    forAll(field.boundaryField(), patchi)
    {
        const auto& values = field.boundaryField()[patchi];

        if (mine.empty())
        {
            mine = findNotFinite
            (
                values,
                centres.boundaryField()[patchi],
                "patch " + values.patch().name() + ", face"
            );
        }
    }

    Pstream::gatherList(found);
    const masterGate once;

    forAll(found, ranki)
    {
        if (!found[ranki].empty())
        {
            FatalErrorInFunction
                << "A value of " << field.name() << " is not a finite number: "
                << found[ranki].c_str();

            if (Pstream::parRun())
            {
                FatalError<< " of processor" << ranki;
            }

            FatalError
                << nl << "    " << field.objectPath() << exit(FatalError);
        }
    }
}


// A control; what is wrong with it is said once
static label wholeNumber
(
    const dictionary& dict,
    const word& keyword,
    const label least,
    const label deflt
)
{
    const masterGate once;
    return ellipsoidProperties::getWholeOrDefault(dict, keyword, least, deflt);
}

} // End namespace Foam


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::IOobject Foam::steadyFlow::fieldIO
(
    const word& name,
    const IOobject::readOption readOpt
) const
{
    return IOobject(name, instance_, mesh_, readOpt, IOobject::NO_WRITE);
}


void Foam::steadyFlow::checkControls() const
{
    const masterGate once;

    const wordHashSet known
    ({
        "consistent", "nNonOrthogonalCorrectors", "maxIterations",
        "residualControl", "fluxTolerance", "fluxWindow",
        "pRefCell", "pRefPoint", "pRefValue"
    });
    const wordHashSet knownTargets({"p", "U"});

    wordHashSet unknown(controls_.toc());
    unknown -= known;
    wordHashSet unknownTargets
    (
        controls_.subOrEmptyDict("residualControl").toc()
    );
    unknownTargets -= knownTargets;

    if (unknown.size() || unknownTargets.size())
    {
        FatalIOErrorInFunction(controls_)
            << "Unknown entries " << (unknown | unknownTargets).sortedToc()
            << nl << "Known are " << known.sortedToc()
            << ", and in residualControl " << knownTargets.sortedToc()
            << exit(FatalIOError);
    }

    if
    (
        consistent_
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


Foam::dictionary Foam::steadyFlow::linearSolver(const word& fieldName) const
{
    dictionary dict(mesh_.solverDict(fieldName));

    // A solver that is content with its start leaves the flow untouched, which
    // would pass for steady
    dict.set("minIter", max(dict.getOrDefault<label>("minIter", 1), label(1)));

    return dict;
}


Foam::flowConvergence::forceRatios Foam::steadyFlow::forces
(
    const fvVectorMatrix& UEqn
) const
{
    const volVectorField gradP(fvc::grad(p_));

    vectorField net
    (
        (UEqn & U_)().primitiveField() + gradP.primitiveField()
    );
    for (direction cmpt = 0; cmpt < vector::nComponents; ++cmpt)
    {
        if (mesh_.solutionD()[cmpt] == -1)
        {
            net.replace(cmpt, scalar(0));
        }
    }

    scalar shear = 0;
    for (const fvPatchVectorField& Up : U_.boundaryField())
    {
        if (!Up.coupled())
        {
            shear += nu_.value()*sum(mag(Up.snGrad())*Up.patch().magSf());
        }
    }
    reduce(shear, sumOp<scalar>());

    const scalar pressure = gSum(mag(gradP.primitiveField())*mesh_.V());
    const scalar driving = pressure + shear + VSMALL;

    return {gSum(mag(net)*mesh_.V())/driving, pressure/driving};
}


void Foam::steadyFlow::iterate()
{
    // A flow that diverges is reported as such, not by a signal
    const sigFpe::ignore noTrap;

    fvVectorMatrix UEqn(fvm::div(phi_, U_) - fvm::laplacian(nu_, U_));
    const flowConvergence::forceRatios forcesFound(forces(UEqn));

    UEqn.relax();
    const SolverPerformance<vector> UPerf
    (
        Foam::solve(UEqn == -fvc::grad(p_), linearSolver("U"))
    );

    // Velocity without pressure gradient, and what a pressure gradient adds
    const volScalarField rAU(1/UEqn.A());
    volVectorField HbyA(constrainHbyA(rAU*UEqn.H(), U_, p_));
    surfaceScalarField phiHbyA("phiHbyA", fvc::flux(HbyA));
    adjustPhi(phiHbyA, U_, p_);

    volScalarField rAtU("rAtU", rAU);
    if (consistent_)
    {
        // The neighbours' velocities change with the cell's own
        rAtU = 1/(1/rAU - UEqn.H1());
        phiHbyA +=
            fvc::interpolate(rAtU - rAU)*fvc::snGrad(p_)*mesh_.magSf();
        HbyA += (rAtU - rAU)*fvc::grad(p_);
    }

    constrainPressure(p_, U_, phiHbyA, rAtU);

    p_.storePrevIter();
    solverPerformance pPerf;
    for (label corr = 0; corr <= nNonOrthogonalCorrectors_; ++corr)
    {
        fvScalarMatrix pEqn
        (
            fvm::laplacian(rAtU, p_) == fvc::div(phiHbyA)
        );
        pEqn.setReference(pRefCell_, pRefValue_);

        const solverPerformance perf(pEqn.solve(linearSolver("p")));
        if (corr == 0)
        {
            pPerf = perf;
        }
        if (corr == nNonOrthogonalCorrectors_)
        {
            phi_ = phiHbyA - pEqn.flux();
        }
    }
    p_.relax();

    U_ = HbyA - rAtU*fvc::grad(p_);
    U_.correctBoundaryConditions();

    convergence_.update(pPerf, UPerf, forcesFound, U_, phi_);
    forgetSolverPerformance(mesh_);
}


Foam::fileName Foam::steadyFlow::unfinishedFile(const word& instance) const
{
    return checkpoint::unfinishedFlow(mesh_.time().path()/instance);
}


void Foam::steadyFlow::reportProgress(const label iteration) const
{
    Info<< "flow: iteration " << iteration << ": "
        << convergence_.measures().c_str();

    const inletFlux& through = convergence_.through();

    if (through.closed())
    {
        Info<< ", mean speed " << text(through.speed) << " m/s" << endl;
    }
    else
    {
        Info<< ", inflow " << text(through.inflow) << " m3/s" << endl;
    }
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::steadyFlow::steadyFlow(const fvMesh& mesh)
:
    mesh_(mesh),
    controls_(mesh.solutionDict().subDict("SIMPLE")),
    consistent_(controls_.getOrDefault("consistent", true)),
    nNonOrthogonalCorrectors_
    (
        wholeNumber(controls_, "nNonOrthogonalCorrectors", 0, 0)
    ),
    maxIterations_(wholeNumber(controls_, "maxIterations", 1, 2000)),
    instance_(mesh.time().findInstance(mesh.dbDir(), "U")),
    unfinished_
    (
        returnReduce(isFile(unfinishedFile(instance_)), orOp<bool>())
    ),
    nu_(readViscosity(mesh)),
    U_(fieldIO("U", IOobject::MUST_READ), mesh),
    p_(fieldIO("p", IOobject::MUST_READ), mesh),
    phi_(fieldIO("phi", IOobject::READ_IF_PRESENT), fvc::flux(U_)),
    pRefCell_(0),
    pRefValue_(0),
    convergence_(mesh, controls_)
{
    checkControls();
    checkFinite(U_, mesh_.C(), "mesh cell");
    checkFinite(p_, mesh_.C(), "mesh cell");
    checkFinite(phi_, mesh_.Cf(), "mesh face");

    setRefCell(p_, controls_, pRefCell_, pRefValue_);
    mesh_.setFluxRequired(p_.name());
    convergence_.restart(U_, phi_);

    // One line a second tells more than several in each iteration
    SolverPerformance<scalar>::debug = 0;
    SolverPerformance<vector>::debug = 0;
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

bool Foam::steadyFlow::converged()
{
    if (unfinished_)
    {
        Info<< "flow: not all of it was written in " << instance_ << endl;
        return false;
    }

    const volVectorField URead(U_);
    const volScalarField pRead(p_);
    const surfaceScalarField phiRead(phi_);

    iterate();
    const bool arrived = convergence_.sound() && convergence_.reachedBefore();

    U_ == URead;
    p_ == pRead;
    phi_ == phiRead;

    if (arrived)
    {
        Info<< "flow: already converged (" << convergence_.measures().c_str()
            << "), not solved again: as stored in " << instance_ << endl;
    }
    convergence_.restart(U_, phi_);

    return arrived;
}


void Foam::steadyFlow::solve()
{
    Info<< "flow: solved from that in " << instance_ << " by "
        << (consistent_ ? "SIMPLEC" : "SIMPLE") << endl;

    const clockTime clock;
    scalar reported = -1;
    label iteration = 0;

    do
    {
        if (iteration == maxIterations_)
        {
            const masterGate once;
            FatalIOErrorInFunction(controls_)
                << "The flow is not steady after " << iteration
                << " iterations:" << nl
                << convergence_.shortcomings().c_str()
                << "Nothing was written. Raise maxIterations or the U entry of"
                << " relaxationFactors, or loosen residualControl or"
                << " fluxTolerance." << exit(FatalIOError);
        }

        iterate();
        ++iteration;

        if (!convergence_.sound())
        {
            const masterGate once;
            FatalIOErrorInFunction(controls_)
                << "The flow diverges: iteration " << iteration << " left "
                << convergence_.measures().c_str() << ", mean speed "
                << text(convergence_.through().meanSpeed) << " m/s" << nl
                << "Nothing was written. Lower the relaxationFactors, or check"
                << " the boundary conditions and nu." << exit(FatalIOError);
        }

        // About a line a second
        if (clock.elapsedTime() > reported + 1)
        {
            reported = clock.elapsedTime();
            reportProgress(iteration);
        }
    } while (!convergence_.reached());

    reportProgress(iteration);
    Info<< "flow: converged in " << iteration << " iterations, "
        << text(clock.elapsedTime()) << " s" << endl;
}


void Foam::steadyFlow::write()
{
    const word& instance = mesh_.time().timeName();

    atomicWrite(unfinishedFile(instance), "Not all of the flow is written\n");
    atomicWrite(phi_);
    atomicWrite(p_);
    atomicWrite(U_);
    label all = 1;
    reduce(all, sumOp<label>());
    rm(unfinishedFile(instance));

    Info<< "flow: written to " << mesh_.time().timeName() << endl;
}


void Foam::steadyFlow::report(const scalar density) const
{
    const inletFlux& through = convergence_.through();

    if (through.closed())
    {
        Info<< "flow: nothing flows through, mean speed "
            << text(through.speed) << " m/s" << endl;
        return;
    }

    scalar inP = 0;
    scalar outflow = 0, outP = 0;

    forAll(through.patches, i)
    {
        // A patch may have no faces
        if (through.area[i] <= 0)
        {
            continue;
        }

        const label patchi = through.patches[i];
        const scalar flux = through.flux[i];
        const scalar patchP =
            gSum
            (
                p_.boundaryField()[patchi]*mesh_.magSf().boundaryField()[patchi]
            )
           /through.area[i];

        Info<< "flow: " << mesh_.boundary()[patchi].name() << ": "
            << text(mag(flux)) << " m3/s " << (flux < 0 ? "in" : "out")
            << ", mean p " << text(patchP) << " m2/s2" << endl;

        if (flux < 0)
        {
            inP -= flux*patchP;
        }
        else
        {
            outflow += flux;
            outP += flux*patchP;
        }
    }

    Info<< "flow: mean inlet speed " << text(through.speed) << " m/s"
        << endl;

    if (outflow > 0)
    {
        const scalar drop = inP/through.inflow - outP/outflow;

        Info<< "flow: pressure drop " << text(drop) << " m2/s2";

        if (density > 0)
        {
            Info<< " (" << text(density*drop) << " Pa)";
        }
        Info<< endl;
    }
}


// ************************************************************************* //
