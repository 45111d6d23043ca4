// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "stokesEquations.H"
#include "DynamicList.H"
#include "emptyFvPatch.H"
#include "fvMatrices.H"
#include "fvMesh.H"
#include "snGradScheme.H"
#include "surfaceInterpolate.H"
#include "transformFvPatchFields.H"

#include <numeric>

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

template<class Type>
Foam::Field<Type> Foam::stokesEquations::ofFaces
(
    const GeometricField<Type, fvsPatchField, surfaceMesh>& values
) const
{
    Field<Type> all(values.primitiveField());
    for (const fvsPatchField<Type>& patchValues : values.boundaryField())
    {
        if (patchValues.coupled())
        {
            all.append(patchValues);
        }
    }

    return all;
}


Foam::List<float> Foam::stokesEquations::withHalo
(
    const scalarField& values
) const
{
    List<float> all(single(values));
    all.setSize(halo_.size());
    halo_.exchange(all);

    return all;
}


void Foam::stokesEquations::setFaces()
{
    owner_ = mesh_.owner();
    neighbour_ = mesh_.neighbour();
    label halo = halo_.nLocal();

    for (const fvPatch& patch : mesh_.boundary())
    {
        if (patch.coupled())
        {
            owner_.append(patch.faceCells());
            neighbour_.append(identity(patch.size(), halo));
            halo += patch.size();
        }
    }

    weight_ = single(ofFaces(mesh_.weights()));
    Sf_ = fourOf(vectorField(ofFaces(mesh_.Sf())/units_.flux));
}


void Foam::stokesEquations::setSkewFaces(const word& pName)
{
    // The sine of an angle below which an explicit term changes nothing that
    // the outer iteration would notice
    const scalar straight = 1e-3;

    const tmp<fv::snGradScheme<scalar>> scheme
    (
        fv::snGradScheme<scalar>::New
        (
            mesh_, mesh_.snGradScheme("snGrad(" + pName + ')')
        )
    );
    if (!scheme().corrected())
    {
        return;
    }

    const vectorField correction
    (
        ofFaces(mesh_.nonOrthCorrectionVectors())
    );

    // Mesh cells whose velocity gradients are used
    boolList graded(halo_.size(), false);

    DynamicList<label> skew;
    forAll(owner_, facei)
    {
        if (magSqr(correction[facei]) > sqr(straight))
        {
            skew.append(facei);
            graded[owner_[facei]] = true;
            graded[neighbour_[facei]] = true;
        }
    }
    skewFaces_.transfer(skew);
    skewSf_ = fourOf
    (
        vectorField
        (
            vectorField(correction*ofFaces(mesh_.magSf())/units_.flux),
            skewFaces_
        )
    );
    skew_ = returnReduce(skewFaces_.size() > 0, orOp<bool>());
    halo_.exchange(graded);
    setGradients(graded);
}


void Foam::stokesEquations::setGradients(const boolList& graded)
{
    labelList row(halo_.size(), -1);
    DynamicList<label> cells;
    for (label celli = 0; celli < halo_.nLocal(); ++celli)
    {
        if (graded[celli])
        {
            row[celli] = cells.size();
            cells.append(celli);
        }
    }

    gradCells_.transfer(cells);

    gradStart_.setSize(gradCells_.size() + 1, Zero);
    forAll(owner_, facei)
    {
        for (const label celli : {owner_[facei], neighbour_[facei]})
        {
            if (row[celli] >= 0)
            {
                ++gradStart_[row[celli] + 1];
            }
        }
    }
    std::partial_sum(gradStart_.begin(), gradStart_.end(), gradStart_.begin());

    gradOwn_.setSize(gradCells_.size(), fourFloats{});
    gradCell_.setSize(gradStart_.last());
    gradWeight_.setSize(gradStart_.last());
    labelList next(SubList<label>(gradStart_, gradCells_.size()));

    forAll(owner_, facei)
    {
        const label own = owner_[facei];
        const label nei = neighbour_[facei];
        const fourFloats ofOwn = weight_[facei]*Sf_[facei];
        const fourFloats ofNei = (1 - weight_[facei])*Sf_[facei];

        if (row[own] >= 0)
        {
            const label at = next[row[own]]++;
            gradOwn_[row[own]] += ofOwn;
            gradCell_[at] = nei;
            gradWeight_[at] = ofNei;
        }
        if (row[nei] >= 0)
        {
            const label at = next[row[nei]]++;
            gradOwn_[row[nei]] -= ofNei;
            gradCell_[at] = own;
            gradWeight_[at] = -ofOwn;
        }
    }

    gradU_.setSize(halo_.size(), columns{});
}


void Foam::stokesEquations::setBoundary
(
    const volScalarField& rAU,
    const volVectorField& U,
    const volScalarField& p
)
{
    patchStart_.clear();
    boundaryCell_.clear();
    boundarySf_.clear();
    boundaryP_.clear();
    boundaryPCoeff_.clear();
    boundaryOpen_.clear();

    for (const fvPatch& patch : mesh_.boundary())
    {
        patchStart_.append(boundaryCell_.size());

        const label patchi = patch.index();
        const fvPatchVectorField& Up = U.boundaryField()[patchi];
        const fvPatchScalarField& pp = p.boundaryField()[patchi];

        if (patch.coupled() || isA<emptyFvPatch>(patch))
        {
            continue;
        }

        boundaryCell_.append(patch.faceCells());
        boundarySf_.append(fourOf(vectorField(patch.Sf()/units_.flux)));
        boundaryP_.append(single(pp.valueInternalCoeffs(patch.weights())()));

        // Of the ratio of a flux to a pressure
        const scalar unit = units_.flux/units_.pressure;
        const scalarField rAUp(rAU, patch.faceCells());
        boundaryPCoeff_.append
        (
            single
            (
                (rAUp*patch.magSf()*pp.gradientInternalCoeffs()/unit)()
            )
        );

        // As constrainHbyA
        boundaryOpen_.setSize
        (
            boundaryCell_.size(),
            Up.assignable() && !polyPatch::constraintType(patch.type())
        );
    }
    patchStart_.append(boundaryCell_.size());
}


void Foam::stokesEquations::setBoundaryVelocity(const volVectorField& U)
{
    boundaryU_.setSize(boundaryCell_.size());
    for (direction d = 0; d < 3; ++d)
    {
        vector unit(Zero);
        unit[d] = 1;
        volVectorField moved("moved", U);
        moved.primitiveFieldRef() += unit;
        moved.correctBoundaryConditions();

        forAll(mesh_.boundary(), patchi)
        {
            const label start = patchStart_[patchi];

            for (label i = start; i < patchStart_[patchi + 1]; ++i)
            {
                boundaryU_[i].column[d] = fourOf
                (
                    moved.boundaryField()[patchi][i - start]
                  - U.boundaryField()[patchi][i - start]
                );
            }
        }
    }

    boolList graded(halo_.size(), false);
    UIndirectList<bool>(graded, gradCells_) = true;
    DynamicList<label> faces;
    forAll(boundaryCell_, facei)
    {
        fourFloats size{};
        for (const fourFloats& column : boundaryU_[facei].column)
        {
            size += column*column;
        }
        if (graded[boundaryCell_[facei]] && dot3(size, fourOf(1)) > 0)
        {
            faces.append(facei);
        }
    }
    gradFaces_.transfer(faces);
}


void Foam::stokesEquations::setTurned
(
    const fvVectorMatrix& UEqn,
    const surfaceScalarField& phi,
    const volVectorField& U
)
{
    turnedFaces_.clear();
    turned_.clear();
    for (const fvPatchVectorField& Up : U.boundaryField())
    {
        if (!isA<transformFvPatchVectorField>(Up))
        {
            continue;
        }

        const fvPatch& patch = Up.patch();
        const vectorField& internal = UEqn.internalCoeffs()[patch.index()];
        const scalarField viscous
        (
            units_.nu*patch.magSf()*patch.deltaCoeffs()
        );
        const scalarField& phip = phi.boundaryField()[patch.index()];

        forAll(patch, i)
        {
            const label facei = patchStart_[patch.index()] + i;
            columns missing;
            for (int d = 0; d < 3; ++d)
            {
                fourFloats& column = missing.column[d];
                column =
                    float((phip[i] - viscous[i])/units_.force)
                   *boundaryU_[facei].column[d];
                column[d] += (viscous[i] - internal[i][d])/units_.force;
            }
            turnedFaces_.append(facei);
            turned_.append(missing);
        }
    }
}


void Foam::stokesEquations::setVolumes()
{
    const scalarField V(mesh_.V()/pow3(units_.length));
    V_ = single(V);

    byV_ = withHalo(scalarField(1/V));
}


void Foam::stokesEquations::setMomentum(const fvVectorMatrix& UEqn)
{
    vectorField diagonal(UEqn.diag()*vector::one);
    upper_ = single(scalarField(UEqn.upper()/units_.force));
    lower_ = single(scalarField(UEqn.lower()/units_.force));

    for (const fvPatch& patch : mesh_.boundary())
    {
        const vectorField& internal = UEqn.internalCoeffs()[patch.index()];
        const labelUList& cells = patch.faceCells();

        forAll(internal, i)
        {
            diagonal[cells[i]] += internal[i];
        }
        if (patch.coupled())
        {
            // Of a face that has its neighbour beyond, one row is here
            const scalarField beyond
            (
                -UEqn.boundaryCoeffs()[patch.index()].component(0)
               /units_.force
            );
            const List<float> row(single(beyond));
            upper_.append(row);
            lower_.append(row);
        }
    }

    diagonal_.setSize(diagonal.size());
    forAll(diagonal_, celli)
    {
        const vector d(diagonal[celli]/units_.force);
        diagonal_[celli] = fourOf(d, d.x());
    }
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::stokesEquations::stokesEquations(const volScalarField& p, const scalar nu)
:
    stokesOperator(p.mesh()),
    mesh_(p.mesh()),
    units_(cbrt(gAverage(mesh_.V().field())), nu)
{
    setFaces();
    setSkewFaces(p.name());
    setVolumes();
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::stokesEquations::set
(
    const fvVectorMatrix& UEqn,
    const volScalarField& rAU,
    const volVectorField& U,
    const volScalarField& p,
    const surfaceScalarField& phi
)
{
    setBoundary(rAU, U, p);
    setBoundaryVelocity(U);
    setTurned(UEqn, phi, U);
    setMomentum(UEqn);

    rByV_ = withHalo(scalarField(rAU.primitiveField()/units_.mobility));
    forAll(rByV_, celli)
    {
        rByV_[celli] *= byV_[celli];
    }

    const surfaceScalarField rAUf(fvc::interpolate(rAU));
    skewrAU_ = single
    (
        scalarField(ofFaces(rAUf), skewFaces_)/units_.mobility
    );
    pCoeff_ = single
    (
        scalarField
        (
            ofFaces((rAUf*mesh_.magSf()*mesh_.nonOrthDeltaCoeffs())())
           *(units_.pressure/units_.flux)
        )
    );
}


Foam::scalarField Foam::stokesEquations::distance() const
{
    return scalarField(ofFaces(mesh_.nonOrthDeltaCoeffs())*units_.length);
}


void Foam::stokesEquations::addFlux
(
    const faceValues& through,
    surfaceScalarField& phi
) const
{
    label facei = 0;
    for (scalar& phif : phi.primitiveFieldRef())
    {
        phif += units_.flux*through.inner[facei++];
    }
    for (fvsPatchScalarField& phip : phi.boundaryFieldRef())
    {
        label i = patchStart_[phip.patch().index()];
        for (scalar& phif : phip)
        {
            phif +=
                units_.flux
               *(
                    phip.coupled()
                  ? through.inner[facei++]
                  : through.boundary[i++]
                );
        }
    }
}
