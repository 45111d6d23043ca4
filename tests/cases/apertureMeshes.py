# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""A body in an aperture, for bodyFitted.test: mesh, start fields and the surface of the body.

usage: apertureMeshes.py slit|square SIZE fitted|whole   (in the case folder; lengths in
micrometres; SIZE: of the cubes of the mesh)

slit: one aperture of the circular trap's design C, 4 deep, with a cell upright in its mouth as it
is held there: its nose 1 nm from the edges. square: a square aperture 1.5 wide with a
spheroid, semi-axes 0.5 and 1, in its mouth at 30 degrees; it leaves gaps of 0.09 and 0.25.
whole: the room of the body is meshed. fitted: also the dictionary by which snappyHexMesh cuts it
out of that mesh, and the body's surface.
"""

import math
import os
import sys

# Half-widths of chambers and aperture; their ends; the body's longest semi-axis, z, angle to z
SLIT = ((1.6, 2), (0.4, 2), (-5, 0, 1, 3), 2, -1.205, 0)
SQUARE = ((1.75, 1.75), (0.75, 0.75), (-3, 0, 1, 4), 1, 0, math.radians(30))
WIDE, NARROW, END, LONG, PLACE, TILT = {"slit": SLIT, "square": SQUARE}[sys.argv[1]]
SHORT = 0.5


def write(name, kind, text):
    """A file of the case."""
    os.makedirs(os.path.dirname(name), exist_ok=True)
    with open(name, "w", encoding="ascii") as file:
        file.write(f"FoamFile {{ version 2.0; format ascii; class {kind}; object {name.split('/')[-1]}; }}\n{text}\n")


def mesh(size):
    """system/blockMeshDict: blocks of cubes."""
    # Without steps in y the outer blocks are missing
    sides = [(-wide, -narrow, narrow, wide) for wide, narrow in zip(WIDE, NARROW)]
    count = [[round((b - a) / size) for a, b in zip(v, v[1:])] for v in (*sides, END)]
    points = "\n".join(f"({x} {y} {z})" for z in END for y in sides[1] for x in sides[0])
    blocks, walls, ends = [], [], {"inlet": [], "outlet": []}

    def vertex(i, j, k):
        return (k * 4 + j) * 4 + i

    def fluid(i, j, k):
        there = 0 <= i < 3 and 0 <= j < 3 and count[1][j] > 0
        return there and (k in (0, 2) or (i, j, k) == (1, 1, 1))

    for i, j, k in ((i, j, k) for k in range(3) for j in range(3) for i in range(3)):
        if not fluid(i, j, k):
            continue
        v = [vertex(i + a, j + b, k + c) for c in (0, 1) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
        blocks.append(f"hex ({' '.join(map(str, v))}) ({count[0][i]} {count[1][j]} {count[2][k]}) simpleGrading (1 1 1)")
        for step, face in (((-1, 0, 0), (0, 4, 7, 3)), ((1, 0, 0), (1, 2, 6, 5)), ((0, -1, 0), (0, 1, 5, 4)),
                           ((0, 1, 0), (3, 7, 6, 2)), ((0, 0, -1), (0, 3, 2, 1)), ((0, 0, 1), (4, 5, 6, 7))):
            beyond = (i + step[0], j + step[1], k + step[2])
            if not fluid(*beyond):
                side = ends["inlet"] if beyond[2] < 0 else ends["outlet"] if beyond[2] > 2 else walls
                side.append("(" + " ".join(str(v[n]) for n in face) + ")")
    patches = "\n".join(f"{name} {{ type {kind}; faces ({' '.join(faces)}); }}" for name, kind, faces in (
        ("inlet", "patch", ends["inlet"]), ("outlet", "patch", ends["outlet"]), ("wall", "wall", walls)))
    write("system/blockMeshDict", "dictionary",
          f"scale 1e-6; vertices ({points}); blocks ({' '.join(blocks)}); boundary ({patches});")


def surface():
    """constant/triSurface/body.stl, of triangles that err by less than 1 nm."""
    around, along = 96, 64

    def point(i, j):
        t, p = math.pi * j / along, 2 * math.pi * i / around
        x, y, z = SHORT * math.sin(t) * math.cos(p), SHORT * math.sin(t) * math.sin(p), LONG * math.cos(t)
        c, s = math.cos(TILT), math.sin(TILT)
        # The axis leans to x
        return tuple(1e-6 * v for v in (c * x + s * z, y, PLACE - s * x + c * z))

    os.makedirs("constant/triSurface", exist_ok=True)
    with open("constant/triSurface/body.stl", "w", encoding="ascii") as file:
        print("solid body", file=file)
        for i in range(around):
            for j in range(along):
                a, b, c, d = point(i, j), point(i, j + 1), point(i + 1, j + 1), point(i + 1, j)
                # One at the poles
                triangles = [(a, b, c)] * (j < along - 1) + [(a, c, d)] * (j > 0)
                for triangle in triangles:
                    print("facet normal 0 0 0\nouter loop", file=file)
                    for x, y, z in triangle:
                        print(f"vertex {x:.9e} {y:.9e} {z:.9e}", file=file)
                    print("endloop\nendfacet", file=file)
        print("endsolid body", file=file)


def cut():
    """system/snappyHexMeshDict: a body in place of its room, mesh cells on it a quarter as wide."""
    write("system/snappyHexMeshDict", "dictionary", """
castellatedMesh true; snap true; addLayers false;
geometry { body.stl { type triSurfaceMesh; name body; } }
castellatedMeshControls
{
    maxLocalCells 4000000; maxGlobalCells 8000000; minRefinementCells 0; nCellsBetweenLevels 3;
    resolveFeatureAngle 30; allowFreeStandingZoneFaces false; locationInMesh (0.711e-6 0.613e-6 -2.931e-6);
    features (); refinementSurfaces { body { level (2 2); patchInfo { type wall; } } } refinementRegions {}
}
snapControls { nSmoothPatch 3; tolerance 2; nSolveIter 30; nRelaxIter 5; }
addLayersControls
{
    relativeSizes true; layers {} expansionRatio 1; finalLayerThickness 0.5; minThickness 0.1; nGrow 0;
    featureAngle 60; nRelaxIter 3; nSmoothSurfaceNormals 1; nSmoothNormals 3; nSmoothThickness 10;
    maxFaceThicknessRatio 0.5; maxThicknessToMedialRatio 0.3; minMedianAxisAngle 90;
    nBufferCellsNoExtrude 0; nLayerIter 50;
}
meshQualityControls { #includeEtc "caseDicts/meshQualityDict" nSmoothScale 4; errorReduction 0.75; minVol 1e-30; }
mergeTolerance 1e-6;""")


def fields(walls):
    """The start fields."""
    write("0/U", "volVectorField", "dimensions [0 1 -1 0 0 0 0]; internalField uniform (0 0 0); boundaryField {"
          ' "(inlet|outlet)" { type pressureInletOutletVelocity; value uniform (0 0 0); }'
          f" {walls} {{ type noSlip; }} }}")
    write("0/p", "volScalarField", "dimensions [0 2 -2 0 0 0 0]; internalField uniform 0; boundaryField {"
          " inlet { type fixedValue; value uniform 0.05; } outlet { type fixedValue; value uniform 0; }"
          f" {walls} {{ type zeroGradient; }} }}")


mesh(float(sys.argv[2]))
if sys.argv[3] == "fitted":
    surface()
    cut()
fields('"(wall|body)"')
