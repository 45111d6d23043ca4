// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "flowFields.H"
#include "caseFiles.H"
#include "checkedEntries.H"
#include "checkFinite.H"
#include "dictionary.H"
#include "Enum.H"
#include "flowChecks.H"
#include "fvcFlux.H"
#include "fvMesh.H"
#include "inletFlux.H"
#include "masterGate.H"
#include "processorCyclicFvPatchField.H"
#include "PstreamReduceOps.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    static const Enum<flowFields::solveType> solveTypeNames
    ({
        {flowFields::NO, "no"},
        {flowFields::YES, "yes"},
        {flowFields::AUTO, "auto"}
    });

    //- The dictionary flow, or an empty one
    static const dictionary& controlsOf(const fvMesh& mesh)
    {
        return subDictOf(mesh.solutionDict(), "flow");
    }

    //- Set a field at cyclic patches that are divided between ranks, where
    //  decomposePar does not write the values of the other side
    template<class Type>
    static void setSplitCyclic
    (
        GeometricField<Type, fvPatchField, volMesh>& field
    )
    {
        typedef processorCyclicFvPatchField<Type> splitCyclic;
        const label firstRequest = Pstream::nRequests();

        for (fvPatchField<Type>& pf : field.boundaryFieldRef(false))
        {
            if (isA<splitCyclic>(pf))
            {
                pf.initEvaluate(Pstream::commsTypes::nonBlocking);
            }
        }
        Pstream::waitRequests(firstRequest);
        for (fvPatchField<Type>& pf : field.boundaryFieldRef(false))
        {
            if (isA<splitCyclic>(pf))
            {
                pf.evaluate(Pstream::commsTypes::nonBlocking);
            }
        }
    }

} // End namespace Foam


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::IOobject Foam::flowFields::fieldIO
(
    const word& name,
    const IOobject::readOption readOpt
) const
{
    return IOobject(name, instance_, mesh_, readOpt, IOobject::NO_WRITE);
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::flowFields::flowFields(const fvMesh& mesh)
:
    mesh_(mesh),
    instance_(caseFiles::flowInstance(mesh)),
    hasFlux_
    (
        returnReduce
        (
            fieldIO("phi", IOobject::MUST_READ)
           .typeHeaderOk<surfaceScalarField>(true),
            andOp<bool>()
        )
    ),
    transportProperties_
    (
        IOobject
        (
            "transportProperties",
            mesh.time().constant(),
            mesh,
            IOobject::MUST_READ
        )
    ),
    U_(fieldIO("U", IOobject::MUST_READ), mesh),
    p_(fieldIO("p", IOobject::MUST_READ), mesh),
    phi_
    (
        fieldIO
        (
            "phi",
            hasFlux_ ? IOobject::READ_IF_PRESENT : IOobject::NO_READ
        ),
        fvc::flux(U_)
    )
{
    setSplitCyclic(U_);
    setSplitCyclic(p_);

    checkDimensions(fields());
    checkFinite(U_, mesh_.C(), "mesh cell");
    checkFinite(p_, mesh_.C(), "mesh cell");
    checkFinite(phi_, mesh_.Cf(), "mesh face");
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::flowFields::solveType Foam::flowFields::solveOf(const fvMesh& mesh)
{
    const dictionary& dict = controlsOf(mesh);
    const masterGate once;

    checkKeywords(dict, {"solve", "continuityTolerance", "fluxTolerance"});

    return solveTypeNames.getOrDefault("solve", dict, solveType::AUTO);
}


bool Foam::flowFields::accept()
{
    if (unfinished())
    {
        const masterGate once;
        FatalErrorInFunction
            << "The flow in " << instance_ << " was not all written: a run was"
            << " interrupted, as the file U.unfinished says. Without solve no in"
            << " the dictionary flow of system/fvSolution it is solved again." << exit(FatalError);
    }

    scalar continuityTolerance;
    {
        const masterGate once;
        continuityTolerance = checkedNumber
        (
            controlsOf(mesh_), "continuityTolerance", above(0), 1e-3
        );
    }

    const fluxErrors errors(fields());

    Info<< "flow: taken as read from " << instance_ << ": net fluxes of mesh"
        << " cells " << shortText(errors.net) << " of those through them, phi"
        << " and the flux of U differ by " << shortText(errors.difference)
        << (hasFlux_ ? "" : " (phi is that of U: there is none in the time)")
        << endl;

    if (!(errors.net <= continuityTolerance))
    {
        const masterGate once;
        FatalErrorInFunction
            << "The flow in " << instance_ << " does not keep its volume: net"
            << " fluxes of mesh cells are " << shortText(errors.net)
            << " of the fluxes through them, above continuityTolerance "
            << shortText(continuityTolerance) << " (dictionary flow of"
            << " system/fvSolution)" << exit(FatalError);
    }
    checkFluxDifference(errors.difference, mesh_);

    return true;
}


void Foam::flowFields::checkPatches() const
{
    const inletFlux through(U_, phi_);
    scalarField ofU(through.patches.size());
    forAll(ofU, i)
    {
        const label patchi = through.patches[i];
        ofU[i] = gSum
        (
            U_.boundaryField()[patchi] & mesh_.Sf().boundaryField()[patchi]
        );
    }

    const masterGate once;
    const scalar tolerance = checkedNumber
    (
        controlsOf(mesh_), "fluxTolerance", above(0), scalar(0.1)
    );

    forAll(ofU, i)
    {
        const fvPatchVectorField& Up = U_.boundaryField()[through.patches[i]];
        const scalar flux = through.flux[i];
        const scalar largest = max(mag(flux), mag(ofU[i]));

        // What flows out has no velocity of its own at the patch
        if
        (
            (Up.fixesValue() || min(flux, ofU[i]) < 0)
         && largest > 1e-3*through.crossing
         && mag(flux - ofU[i]) > tolerance*largest
        )
        {
            const std::string what
            (
                "phi and U are not of one flow at patch " + Up.patch().name()
              + ": phi carries " + shortText(flux) + " m3/s out, U "
              + shortText(ofU[i])
            );

            // The flow may change what is given there
            if (Up.assignable())
            {
                Warning
                    << what.c_str() << ". Cells enter there by U and go on"
                    << " by phi" << nl << endl;
                continue;
            }
            FatalErrorInFunction
                << what.c_str() << nl
                << "    Give either the velocity or the pressure there, not"
                << " both; or raise fluxTolerance (dictionary flow of"
                << " system/fvSolution)" << exit(FatalError);
        }
    }
}


void Foam::flowFields::report(const scalar density) const
{
    const inletFlux through(U_, phi_);

    if (through.closed())
    {
        Info<< "flow: nothing flows through, mean speed "
            << shortText(through.speed) << " m/s" << endl;
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
            << shortText(mag(flux)) << " m3/s " << (flux < 0 ? "in" : "out")
            << ", mean p " << shortText(patchP) << " m2/s2" << endl;

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

    Info<< "flow: mean inlet speed " << shortText(through.speed) << " m/s"
        << endl;

    if (outflow > 0)
    {
        const scalar drop = inP/through.inflow - outP/outflow;

        Info<< "flow: pressure drop " << shortText(drop) << " m2/s2";

        if (density > 0)
        {
            Info<< " (" << shortText(density*drop) << " Pa)";
        }
        Info<< endl;
    }
}
