/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

Description
    What a stokesOperator is made of: faces and coefficients.

\*---------------------------------------------------------------------------*/

#include "stokesOperator.H"
#include "DynamicList.H"
#include "fvMatrices.H"
#include "fvMesh.H"
#include "snGradScheme.H"
#include "surfaceInterpolate.H"
#include "transformFvPatchFields.H"

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

template<class Type>
Foam::Field<Type> Foam::stokesOperator::faceValues
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


void Foam::stokesOperator::setFaces()
{
    owner_ = mesh_.owner();
    neighbour_ = mesh_.neighbour();
    label halo = halo_.nCells();

    for (const fvPatch& patch : mesh_.boundary())
    {
        if (patch.coupled())
        {
            owner_.append(patch.faceCells());
            neighbour_.append(identity(patch.size(), halo));
            halo += patch.size();
        }
    }

    weight_ = single(faceValues(mesh_.weights()));
    Sf_ = fourOf(vectorField(faceValues(mesh_.Sf())/units_.flux()));
}


void Foam::stokesOperator::setSkewFaces()
{
    // The sine of an angle below which an explicit term changes nothing that
    // the outer iteration would notice
    const scalar straight = 1e-3;

    const tmp<fv::snGradScheme<scalar>> scheme
    (
        fv::snGradScheme<scalar>::New(mesh_, mesh_.snGradScheme("snGrad(p)"))
    );
    if (!scheme().corrected())
    {
        return;
    }

    const vectorField correction
    (
        faceValues(mesh_.nonOrthCorrectionVectors())
    );

    // Cells whose velocity gradients are used
    boolList graded;
    graded.setSize(halo_.size(), false);

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
            vectorField(correction*faceValues(mesh_.magSf())/units_.flux()),
            skewFaces_
        )
    );
    skew_ = returnReduce(skewFaces_.size() > 0, orOp<bool>());
    halo_.exchange(graded);
    setGradients(graded);
}


void Foam::stokesOperator::setGradients(const boolList& graded)
{
    labelList row(halo_.size(), -1);
    DynamicList<label> cells;
    for (label celli = 0; celli < halo_.nCells(); ++celli)
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
    forAll(gradCells_, i)
    {
        gradStart_[i + 1] += gradStart_[i];
    }

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


void Foam::stokesOperator::setBoundary
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
        const word& type = patch.type();

        if (patch.coupled() || type == "empty")
        {
            continue;
        }

        boundaryCell_.append(patch.faceCells());
        boundarySf_.append(fourOf(vectorField(patch.Sf()/units_.flux())));
        boundaryP_.append(single(pp.valueInternalCoeffs(patch.weights())()));

        // Of the ratio of a flux to a pressure
        const scalar unit = units_.flux()/units_.pressure();
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
            Up.assignable() && !polyPatch::constraintType(type)
        );
    }
    patchStart_.append(boundaryCell_.size());
}


void Foam::stokesOperator::setTurned
(
    const fvVectorMatrix& UEqn,
    const surfaceScalarField& phi,
    const volVectorField& U
)
{
    // What boundary values take over of a velocity in each direction
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

    boolList graded;
    graded.setSize(halo_.size(), false);
    UIndirectList<bool>(graded, gradCells_) = true;
    DynamicList<label> faces;
    forAll(boundaryCell_, facei)
    {
        const columns& moved = boundaryU_[facei];
        fourFloats size{};
        for (const fourFloats& column : moved.column)
        {
            size += column*column;
        }
        if (graded[boundaryCell_[facei]] && dot3(size, fourOf(1)) > 0)
        {
            faces.append(facei);
        }
    }
    gradFaces_.transfer(faces);

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
                    float((phip[i] - viscous[i])/units_.force())
                   *boundaryU_[facei].column[d];
                column[d] += (viscous[i] - internal[i][d])/units_.force();
            }
            turnedFaces_.append(facei);
            turned_.append(missing);
        }
    }
}


void Foam::stokesOperator::setVolumes()
{
    const scalarField V(mesh_.V()/pow3(units_.length));
    V_ = single(V);

    byV_ = single(scalarField(1/V));
    byV_.setSize(halo_.size());
    halo_.exchange(byV_);
}


void Foam::stokesOperator::setMomentum(const fvVectorMatrix& UEqn)
{
    vectorField diagonal(UEqn.diag()*vector::one);
    upper_ = single(scalarField(UEqn.upper()/units_.force()));
    lower_ = single(scalarField(UEqn.lower()/units_.force()));

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
               /units_.force()
            );
            const List<float> row(single(beyond));
            upper_.append(row);
            lower_.append(row);
        }
    }

    diagonal_.setSize(diagonal.size());
    forAll(diagonal_, celli)
    {
        const vector d(diagonal[celli]/units_.force());
        diagonal_[celli] = fourOf(d, d.x());
    }
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::stokesOperator::stokesOperator(const fvMesh& mesh, const scalar nu)
:
    mesh_(mesh),
    units_(mesh, nu),
    halo_(mesh_),
    skew_(false),
    velocity_(halo_.size())
{
    setFaces();
    setSkewFaces();
    setVolumes();
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::stokesOperator::set
(
    const fvVectorMatrix& UEqn,
    const volScalarField& rAU,
    const volVectorField& U,
    const volScalarField& p,
    const surfaceScalarField& phi
)
{
    setBoundary(rAU, U, p);
    setTurned(UEqn, phi, U);
    setMomentum(UEqn);

    rByV_ = single
    (
        scalarField(rAU.primitiveField()/units_.mobility())
    );
    rByV_.setSize(halo_.size());
    halo_.exchange(rByV_);
    forAll(rByV_, celli)
    {
        rByV_[celli] *= byV_[celli];
    }

    const surfaceScalarField rAUf(fvc::interpolate(rAU));
    skewrAU_ = single
    (
        scalarField(faceValues(rAUf), skewFaces_)/units_.mobility()
    );
    pCoeff_ = single
    (
        scalarField
        (
            faceValues
            (
                (rAUf*mesh_.magSf()*mesh_.nonOrthDeltaCoeffs())()
            )
           *(units_.pressure()/units_.flux())
        )
    );
}


Foam::faceCoefficients Foam::stokesOperator::laplacian
(
    const List<fourFloats>& mobility,
    List<float>& upper,
    List<float>& diagonal,
    List<float>& boundary
) const
{
    const scalarField distance
    (
        faceValues(mesh_.nonOrthDeltaCoeffs())*units_.length
    );

    upper.setSize(owner_.size());
    scalarField sums(halo_.size(), Zero);
    forAll(owner_, facei)
    {
        const label own = owner_[facei];
        const label nei = neighbour_[facei];
        const float w = weight_[facei];
        const fourFloats m = w*mobility[own] + (1 - w)*mobility[nei];
        const fourFloats& Sf = Sf_[facei];
        const scalar coefficient =
            dot3(m*Sf, Sf)/sqrt(dot3(Sf, Sf))*distance[facei];

        upper[facei] = -coefficient;
        sums[own] += coefficient;
        sums[nei] += coefficient;
    }
    boundary.setSize(boundaryCell_.size());
    forAll(boundaryCell_, facei)
    {
        // The gradient of a pressure that is fixed at the face
        const label celli = boundaryCell_[facei];
        const fourFloats& Sf = boundarySf_[facei];

        boundary[facei] =
           -boundaryPCoeff_[facei]/(rByV_[celli]*V_[celli])
           *(dot3(mobility[celli]*Sf, Sf)/dot3(Sf, Sf));
        sums[celli] += boundary[facei];
    }
    sums.setSize(halo_.nCells());
    diagonal = single(sums);

    return {owner_, neighbour_, upper, upper};
}


// ************************************************************************* //
