// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "interpolationDivergenceFree.H"
#include "addToRunTimeSelectionTable.H"
#include "interpolationCellPoint.H"

// * * * * * * * * * * * * * * Static Data Members * * * * * * * * * * * * * //

namespace Foam
{
    defineTypeNameAndDebug(interpolationDivergenceFree, 0);

    static const interpolation<vector>::
    adddictionaryConstructorToTable<interpolationDivergenceFree> addVector;

    static const interpolation<scalar>::
    adddictionaryConstructorToTable<interpolationCellPoint<scalar>> addScalar
    (
        interpolationDivergenceFree::typeName
    );
}
