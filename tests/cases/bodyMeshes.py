# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""Meshes and start fields about one body at the origin, for penalisation.test.

usage: bodyMeshes.py tube|duct|plates|shear CELLS RATIO   (in the case folder; lengths in units
of the semi-minor axis of 0.5 um; CELLS: mesh cells across the smallest diameter)

tube, duct: a circular tube along z, of radius 1/RATIO, or a square one of half-width 1/RATIO.
plates: at y = -+1/RATIO, flow along z, periodic along x. shear: u = (RATIO y, 0, 0) per second
between moving plates; periodic along x and z. Mesh cells are uniform about the body, larger
elsewhere.
"""

import math
import sys

A = 0.5e-6


def write(name, kind, text):
    """A file of the case."""
    with open(name, "w", encoding="ascii") as file:
        file.write(f"FoamFile {{ version 2.0; format ascii; class {kind}; object {name.split('/')[-1]}; }}\n{text}\n")


def mesh(points, blocks, edges, patches):
    """system/blockMeshDict."""
    def lines(rows):
        return "\n".join("(" + " ".join(map(str, row)) + ")" for row in rows)
    boundary = "\n".join(f"{name} {{ {kind} faces ( {lines(faces)} ); }}" for name, kind, faces in patches)
    write("system/blockMeshDict", "dictionary",
          f"scale {A};\nvertices ( {lines(points)} );\nblocks ( {' '.join(blocks)} );\n"
          f"edges ( {' '.join(edges)} );\nboundary ( {boundary} );")


def fields(velocity, pressure):
    """The start fields by the conditions on their patches."""
    write("0/U", "volVectorField", "dimensions [0 1 -1 0 0 0 0]; internalField uniform (0 0 0);"
          f" boundaryField {{ {velocity} }}")
    write("0/p", "volScalarField", "dimensions [0 2 -2 0 0 0 0]; internalField uniform 0;"
          f" boundaryField {{ {pressure} }}")


def tube(cells, ratio):
    """Five blocks in the cross-section, three along the tube."""
    radius, h, fine = 1 / ratio, 2 / cells, 1.6
    ends = [-2 * radius - 6, -fine, fine, 2 * radius + 6]
    half = 0.54 * radius
    across, outward = math.ceil(1.2 * radius / h), math.ceil(0.34 * radius / h)
    along = [math.ceil((ends[3] - fine) / h / 2.2), math.ceil(2 * fine / h)]
    corner = ((-1, -1), (1, -1), (1, 1), (-1, 1))
    points = [(r * x, r * y, z) for z in ends for r in (half, radius / math.sqrt(2)) for x, y in corner]

    def vertex(k, ring, i):
        return k * 8 + ring * 4 + i % 4

    blocks, edges = [], []
    for k in range(3):
        size = f"{along[k == 1]}) simpleGrading (1 1 {(0.25, 1, 4)[k]})"
        blocks.append(f"hex ({' '.join(str(vertex(k + i // 4, 0, i)) for i in range(8))}) ({across} {across} {size}")
        for i in range(4):
            inner = [vertex(k, 1, i), vertex(k, 1, i + 1), vertex(k, 0, i + 1), vertex(k, 0, i)]
            both = inner + [v + 8 for v in inner]
            blocks.append(f"hex ({' '.join(map(str, both))}) ({across} {outward} {size}")
    for k, z in enumerate(ends):
        for i, (x, y) in enumerate(((0, -1), (1, 0), (0, 1), (-1, 0))):
            for ring, r in ((0, 0.672 * radius), (1, radius)):
                edges.append(f"arc {vertex(k, ring, i)} {vertex(k, ring, i + 1)} ({r * x} {r * y} {z})")

    def end(k, turn):
        rows = [[vertex(k, 0, i) for i in range(4)]]
        rows += [[vertex(k, 1, i), vertex(k, 1, i + 1), vertex(k, 0, i + 1), vertex(k, 0, i)] for i in range(4)]
        return [row[::turn] for row in rows]

    wall = [[vertex(k, 1, i), vertex(k, 1, i + 1), vertex(k + 1, 1, i + 1), vertex(k + 1, 1, i)]
            for k in range(3) for i in range(4)]
    mesh(points, blocks, edges, (("inlet", "type patch;", end(0, -1)), ("outlet", "type patch;", end(3, 1)),
                                 ("wall", "type wall;", wall)))
    driven()


def driven(sides=""):
    """Start fields of a flow by pressure, besides patches that have conditions of their own."""
    fields('"(inlet|outlet)" { type pressureInletOutletVelocity; value uniform (0 0 0); } wall { type noSlip; }' + sides,
           'inlet { type fixedValue; value uniform 0.05; } outlet { type fixedValue; value uniform 0; }'
           ' wall { type zeroGradient; }' + sides)


def box(cells, fine, far, patches, largest=(6, 6, 6)):
    """One block to +-far, graded but for +-fine: points of a face as blockMesh counts them."""
    h = 2 / cells

    def graded(half, end, largest):
        n = 1
        while h * sum(largest ** (i / max(n - 1, 1)) for i in range(n)) < end - half:
            n += 1
        middle = math.ceil(2 * half / h)
        return 2 * n + middle, (f"(({end - half} {n} {1 / largest}) ({2 * half} {middle} 1)"
                                f" ({end - half} {n} {largest}))")

    counts, grading = zip(*map(graded, fine, far, largest))
    a, b, c = far
    points = [(x, y, z) for z in (-c, c) for x, y in ((-a, -b), (a, -b), (a, b), (-a, b))]
    mesh(points, [f"hex (0 1 2 3 4 5 6 7) ({' '.join(map(str, counts))}) simpleGrading ({' '.join(grading)})"],
         [], patches)


LEFT, RIGHT, BOTTOM, TOP, BACK, FRONT = (
    (0, 4, 7, 3), (1, 2, 6, 5), (0, 1, 5, 4), (3, 7, 6, 2), (0, 3, 2, 1), (4, 5, 6, 7))


def periodic(*names):
    """Patches of pairs of faces."""
    return [(one, f"type cyclic; neighbourPatch {other};", [face])
            for (one, face), (other, _) in zip(names, [v for i in range(0, len(names), 2) for v in names[i:i + 2][::-1]])]


def duct(cells, ratio):
    """A square tube of a block."""
    half = 1 / ratio
    box(cells, (1.6, 1.6, 1.6), (half, half, half + 6),
        [("inlet", "type patch;", [BACK]), ("outlet", "type patch;", [FRONT]),
         ("wall", "type wall;", [LEFT, RIGHT, BOTTOM, TOP])])
    driven()


def plates(cells, ratio):
    """Two plates."""
    half = 1 / ratio
    box(cells, (1.6, 1.6, 1.6), (8 * half, half, 8 * half),
        [("inlet", "type patch;", [BACK]), ("outlet", "type patch;", [FRONT]), ("wall", "type wall;", [BOTTOM, TOP])]
        + periodic(("left", LEFT), ("right", RIGHT)), (16, 6, 16))
    driven(' "(left|right)" { type cyclic; }')


def shear(cells, rate):
    """Two plates that move, far away."""
    far = 9
    box(cells, (2.4, 2.4, 1.3), (far, far, far),
        periodic(("left", LEFT), ("right", RIGHT), ("back", BACK), ("front", FRONT))
        + [("bottom", "type wall;", [BOTTOM]), ("top", "type wall;", [TOP])])
    speed = rate * far * A
    cyclic = '"(left|right|back|front)" { type cyclic; }'
    fields(f"{cyclic} bottom {{ type fixedValue; value uniform (-{speed} 0 0); }}"
           f" top {{ type fixedValue; value uniform ({speed} 0 0); }}",
           f'{cyclic} "(top|bottom)" {{ type zeroGradient; }}')


{"tube": tube, "duct": duct, "plates": plates, "shear": shear}[sys.argv[1]](float(sys.argv[2]), float(sys.argv[3]))
