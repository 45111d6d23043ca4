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
    mkdir -p "$BUILD/program" && cd "$BUILD/program" || return
    (
        flock 9 && cp -au "$source"/tests/benchmarks/tracers/* . || exit
        # Only once, or it is linked again while another test runs it
        if grep -q '\.\./\.\./\.\.' Make/options; then sed -i "s|../../..|$source|" Make/options; fi
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
# Each cube in six, the inner corners moved off their places
tetrahedra()
{
    box_mesh "$@" && "${ELLIPSOID_PYTHON:-python3}" - "$2" << 'EOT' && gmshToFoam box.msh > log.gmshToFoam \
        && sed -i '/^ *walls$/,/}/s/type .*/type wall;/' constant/polyMesh/boundary
import itertools
import math
import sys

n = int(sys.argv[1])
size = 8e-6, 10e-6, 6e-6
nodes = list(itertools.product(range(n + 1), repeat=3))
number = {node: i + 1 for i, node in enumerate(nodes)}
lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", "3", '2 1 "walls"',
         '2 2 "open"', '3 3 "inside"', "$EndPhysicalNames", "$Nodes", str(len(nodes))]
for i, node in enumerate(nodes):
    x = [size[k]*(node[k] + (0.2*math.sin(12.9898*i + 78.233*k) if 0 < node[k] < n else 0))/n for k in range(3)]
    lines.append(f"{i + 1} {x[0]!r} {x[1]!r} {x[2]!r}")
elements = []
faces = {}
for corner in itertools.product(range(n), repeat=3):
    for order in itertools.permutations(range(3)):
        tet = [corner]
        for axis in order:
            tet.append(tuple(c + (k == axis) for k, c in enumerate(tet[-1])))
        even = order in ((0, 1, 2), (1, 2, 0), (2, 0, 1))
        elements.append("4 2 3 3 " + " ".join(str(number[t]) for t in (tet if even else [tet[1], tet[0]] + tet[2:])))
        for left in range(4):
            face = frozenset(tet[:left] + tet[left + 1:])
            faces[face] = faces.get(face, 0) + 1
for face, count in faces.items():
    if count == 1:
        wall = any(all(t[1] == y for t in face) for y in (0, n))
        elements.append(f"2 2 {1 if wall else 2} 1 " + " ".join(str(number[t]) for t in sorted(face)))
lines += ["$EndNodes", "$Elements", str(len(elements))]
lines += [f"{i + 1} {e}" for i, e in enumerate(elements)] + ["$EndElements", ""]
open("box.msh", "w", encoding="ascii").write("\n".join(lines))
EOT
}
