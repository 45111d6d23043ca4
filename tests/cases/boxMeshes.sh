#!/bin/bash
# The program of tests/benchmarks/tracers, built once, and boxes of hexahedra,
# tetrahedra and polyhedra. Sourced from the top folder.
# License: GPL-3.0-or-later, see COPYING.

. tests/cases/cells.sh

source=$PWD
export BUILD=$source/build/tests/tracers
# Where it stays, so that only what changed is compiled; one test at a time. Not in the sources, where a
# benchmark may build it, too
builds()
{
    mkdir -p "$BUILD/program/whole" && cd "$BUILD/program" || return
    (
        flock 9 && cp -au "$source"/tests/benchmarks/tracers/* . || exit
        # Only once, or it is linked again while another test runs it
        if grep -q '\.\./\.\./\.\.' Make/options; then
            # It takes longer to optimise than to run
            sed -i "s|../../..|$source|" Make/options && echo "c++OPT = -O0" >> Make/options || exit
            # OpenFOAM's headers are most of each file: they are read once
            sed -n 's|^\(.*\.C\)$|#include "../\1"|p' Make/files > whole/whole.C \
                && sed -i -e '1i whole/whole.C' -e '/\.C$/d' Make/files || exit
        fi
        wmake
    ) 9>> "$BUILD/lock"
}
tracers()       { "$BUILD/tracers" "$@" > log.tracers 2>&1 || { tail log.tracers; return 1; }; }

# A box of 8 x 10 x 6 um, N mesh cells a side; its walls at y = 0 and 10 um
box_mesh()      # CASE N
{
    new_case "$1" "$cases/duct"
    {
        dictionary_head blockMeshDict
        echo 'scale 1e-6; vertices ((0 0 0) (8 0 0) (8 10 0) (0 10 0) (0 0 6) (8 0 6) (8 10 6) (0 10 6));'
        echo "blocks (hex (0 1 2 3 4 5 6 7) ($2 $2 $2) simpleGrading (1 1 1));"
        echo 'boundary (walls { type wall; faces ((0 1 5 4) (3 7 6 2)); }'
        echo 'open { type patch; faces ((0 4 7 3) (1 2 6 5) (0 3 2 1) (4 5 6 7)); });'
    } > system/blockMeshDict
    sed -i '/^boundaryField/,$d' 0/U 0/p
    echo 'boundaryField { ".*" { type calculated; value uniform (0 0 0); } }' >> 0/U
    echo 'boundaryField { ".*" { type calculated; value uniform 0; } }' >> 0/p
}
hexahedra()     { box_mesh "$@" && blockMesh > log.blockMesh; }
# The inner points moved by up to two thirds of a mesh cell: of some faces no diagonal is seen from both sides, some centres do
# not see all faces
warped()
{
    hexahedra "$@" && "${ELLIPSOID_PYTHON:-python3}" - "$2" << 'EOT'
import math
import re
import sys

n = int(sys.argv[1])
size = 8e-6, 10e-6, 6e-6


def moved(match):
    """A point; those of the surface stay."""
    x = [float(number) for number in match[1].split()]
    if all(1e-9 < c < s - 1e-9 for c, s in zip(x, size)):
        i = sum((n + 1)**k*round(n*x[k]/size[k]) for k in range(3))
        x = [x[k] + 0.65*size[k]/n*math.sin(12.9898*i + 78.233*k) for k in range(3)]
    return "(" + " ".join(map(repr, x)) + ")"


with open("constant/polyMesh/points", encoding="ascii") as file:
    text = file.read()
with open("constant/polyMesh/points", "w", encoding="ascii") as file:
    file.write(re.sub(r"\((\S+ \S+ \S+)\)", moved, text))
EOT
}
dual()          { mv 0 0.start && polyDualMesh 60 -overwrite > log.polyDualMesh && rm -rf 0 && mv 0.start 0; }
polyhedra()     { hexahedra "$@" && dual; }
# Of which many faces have five corners and more
duals()         { tetrahedra "$@" && dual; }
# Each cube in six or, by planes along z, in two, the inner corners moved off their places
tetrahedra()    { cut_cubes tetrahedra "$@"; }
prisms()        { cut_cubes prisms "$@"; }
cut_cubes()     # tetrahedra|prisms CASE N
{
    box_mesh "${@:2}" && "${ELLIPSOID_PYTHON:-python3}" - "$1" "$3" << 'EOT' && gmshToFoam box.msh > log.gmshToFoam \
        && sed -i '/^ *walls$/,/}/s/type .*/type wall;/' constant/polyMesh/boundary
import itertools
import math
import sys

n = int(sys.argv[2])
size = 8e-6, 10e-6, 6e-6
nodes = list(itertools.product(range(n + 1), repeat=3))
number = {node: i + 1 for i, node in enumerate(nodes)}
lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", "3", '2 1 "walls"',
         '2 2 "open"', '3 3 "inside"', "$EndPhysicalNames", "$Nodes", str(len(nodes))]
for i, node in enumerate(nodes):
    x = [size[k]*(node[k] + (0.2*math.sin(12.9898*i + 78.233*k) if 0 < node[k] < n else 0))/n for k in range(3)]
    lines.append(f"{i + 1} {x[0]!r} {x[1]!r} {x[2]!r}")


def along(corner, axes):
    """Corners of the cube that are passed along the axes, from one on."""
    passed = [corner]
    for axis in axes:
        passed.append(tuple(c + (k == axis) for k, c in enumerate(passed[-1])))
    return passed


# Right-handed, as gmsh has them: kind, nodes, and which of them are a face
cells = []
for corner in itertools.product(range(n), repeat=3):
    if sys.argv[1] == "prisms":
        for axes in (0, 1), (1, 0):
            base = along(corner, axes)[::1 if axes[0] == 0 else -1]
            cells.append((6, base + [along(x, [2])[1] for x in base],
                          [(0, 1, 2), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)]))
        continue
    for order in itertools.permutations(range(3)):
        tet = along(corner, order)
        even = order in ((0, 1, 2), (1, 2, 0), (2, 0, 1))
        cells.append((4, tet if even else [tet[1], tet[0]] + tet[2:], itertools.combinations(range(4), 3)))
elements = []
faces = {}
for kind, cell, sides in cells:
    elements.append(f"{kind} 2 3 3 " + " ".join(str(number[x]) for x in cell))
    for side in sides:
        face = [cell[k] for k in side]
        faces.setdefault(frozenset(face), []).append(face)
for face in (found[0] for found in faces.values() if len(found) == 1):
    wall = any(all(x[1] == y for x in face) for y in (0, n))
    elements.append(f"{len(face) - 1} 2 {1 if wall else 2} 1 " + " ".join(str(number[x]) for x in face))
lines += ["$EndNodes", "$Elements", str(len(elements))]
lines += [f"{i + 1} {e}" for i, e in enumerate(elements)] + ["$EndElements", ""]
open("box.msh", "w", encoding="ascii").write("\n".join(lines))
EOT
}
# Cells of the same box cut about a sphere, as fine again inside, and moved to its surface
snapped()
{
    hexahedra "$@" && {
        dictionary_head snappyHexMeshDict
        cat << 'EOT'
castellatedMesh true; snap true; addLayers false;
geometry { ball { type searchableSphere; centre (5.3e-6 3.6e-6 3e-6); radius 1.7e-6; } }
castellatedMeshControls
{
    maxLocalCells 4000000; maxGlobalCells 8000000; minRefinementCells 0; nCellsBetweenLevels 2;
    resolveFeatureAngle 30; allowFreeStandingZoneFaces true; locationInMesh (0.711e-6 9.613e-6 0.931e-6);
    features (); refinementRegions {}
    refinementSurfaces { ball { level (1 1); faceZone ball; cellZone ball; cellZoneInside inside; } }
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
mergeTolerance 1e-6;
EOT
    } > system/snappyHexMeshDict && mv 0 0.start && snappyHexMesh -overwrite > log.snappyHexMesh \
        && rm -rf 0 && mv 0.start 0
}
