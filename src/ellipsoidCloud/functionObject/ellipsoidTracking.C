/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/

#include "ellipsoidTracking.H"
#include "addToRunTimeSelectionTable.H"
#include "calculatedFvPatchFields.H"
#include "calculatedFvsPatchFields.H"
#include "ellipsoidCloud.H"
#include "surfaceFields.H"
#include "Time.H"
#include "volFields.H"

// * * * * * * * * * * * * * * Static Data Members * * * * * * * * * * * * * //

namespace Foam
{
namespace functionObjects
{
    defineTypeNameAndDebug(ellipsoidTracking, 0);
    addToRunTimeSelectionTable
    (
        functionObject,
        ellipsoidTracking,
        dictionary
    );
}
}


// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- The same values on the mesh of another clock
    template<class FieldType>
    static tmp<FieldType> copyOf(const FieldType& host, const fvMesh& mesh)
    {
        typedef typename FieldType::value_type Type;

        tmp<FieldType> copy
        (
            new FieldType
            (
                IOobject(host.name(), mesh.time().timeName(), mesh),
                mesh,
                dimensioned<Type>(host.dimensions(), Zero)
            )
        );

        copy.ref().primitiveFieldRef() = host.primitiveField();
        forAll(host.boundaryField(), patchi)
        {
            copy.ref().boundaryFieldRef()[patchi] == host.boundaryField()[patchi];
        }

        return copy;
    }
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::dictionary Foam::functionObjects::ellipsoidTracking::clockEntries() const
{
    dictionary entries(time_.controlDict());

    for (const char* other : {"functions", "libs", "adjustTimeStep", "maxDeltaT"})
    {
        entries.remove(other);
    }
    entries.set("startFrom", "startTime");
    entries.set("startTime", 0);
    entries.set("stopAt", "endTime");
    entries.set("endTime", endTime_);
    entries.set("deltaT", deltaT_);
    entries.set("writeControl", "none");
    entries.set("runTimeModifiable", false);

    return entries;
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::functionObjects::ellipsoidTracking::ellipsoidTracking
(
    const word& name,
    const Time& runTime,
    const dictionary& dict
)
:
    fvMeshFunctionObject(name, runTime, dict)
{
    read(dict);
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

bool Foam::functionObjects::ellipsoidTracking::read(const dictionary& dict)
{
    fvMeshFunctionObject::read(dict);

    endTime_ = dict.getCheck<scalar>("endTime", scalarMinMax::ge(VSMALL));
    deltaT_ = dict.getCheck<scalar>("deltaT", scalarMinMax::ge(VSMALL));
    writeInterval_ = dict.getCheckOrDefault<scalar>
    (
        "writeInterval", endTime_, scalarMinMax::ge(VSMALL)
    );
    U_ = dict.getOrDefault<word>("U", "U");
    p_ = dict.getOrDefault<word>("p", "p");
    phi_ = dict.getOrDefault<word>("phi", "phi");

    return true;
}


bool Foam::functionObjects::ellipsoidTracking::end()
{
    Time clock
    (
        clockEntries(), time_.rootPath(), time_.caseName(),
        time_.system(), time_.constant(), false, false
    );
    const fvMesh mesh
    (
        IOobject
        (
            fvMesh::defaultRegion, clock.timeName(), clock, IOobject::MUST_READ
        )
    );

    ellipsoidCloud cells(mesh);
    cells.setFlow
    (
        copyOf(mesh_.lookupObject<volVectorField>(U_), mesh)(),
        copyOf(mesh_.lookupObject<volScalarField>(p_), mesh)(),
        copyOf(mesh_.lookupObject<surfaceScalarField>(phi_), mesh)()
    );

    const label steps = max(label(1), label(writeInterval_/deltaT_ + 0.5));

    cells.begin();
    while (clock.loop())
    {
        cells.evolve();

        if (clock.timeIndex() % steps == 0)
        {
            cells.writePoses();
        }
    }
    cells.finish();

    return true;
}


// ************************************************************************* //
