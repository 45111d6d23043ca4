# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""system/blockMeshDict of a plane device of rectangles, from its drawing on the standard input.

usage: planeMesh.py SCALE DEPTH KIND    (lengths times SCALE are metres; floor and ceiling: empty or symmetryPlane)

Lines: 'x' and 'y' with grid lines, each after the first as PLACE:COUNT or PLACE:COUNT:GRADING, the mesh
cells of the interval that ends there and the last one's size over the first one's; 'patch NAME x|y PLACE LOW HIGH', an opening
on a grid line; last, the rectangles, the highest row first, '.' for fluid. All other sides are the wall 'walls'.
"""

import sys

scale, depth, kind = sys.argv[1:]
lines, openings, drawing = {}, [], []
for words in map(str.split, sys.stdin):
    if words[0] in ("x", "y"):
        lines[words[0]] = [[float(n) for n in word.split(":")] for word in words[1:]]
    elif words[0] == "patch":
        openings.append((words[1], words[2], *map(float, words[3:])))
    else:
        drawing.insert(0, words[0])
x, y = ([line[0] for line in lines[axis]] for axis in "xy")


def fluid(i, j):
    return 0 <= j < len(drawing) and 0 <= i < len(drawing[j]) and drawing[j][i] == "."


def patch(axis, place, low, high):
    """Of a side on a grid line."""
    for name, of, at, first, last in openings:
        if of == axis and at == place and first <= low and high <= last:
            return name
    return "walls"


def vertex(i, j):
    return 2*(j*len(x) + i)


blocks, faces = [], {"floor": [], "ceiling": []}
for j, row in enumerate(drawing):
    for i in range(len(row)):
        if not fluid(i, j):
            continue
        a, b, c, d = vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)
        size = [(*lines[axis][k + 1], 1)[1:3] for axis, k in (("x", i), ("y", j))]
        blocks.append(f"hex ({a} {b} {c} {d} {a + 1} {b + 1} {c + 1} {d + 1}) ({size[0][0]:.0f} {size[1][0]:.0f} 1)"
                      f" simpleGrading ({size[0][1]} {size[1][1]} 1)")
        faces["floor"].append((a, d, c, b))
        faces["ceiling"].append((a + 1, b + 1, c + 1, d + 1))
        for beyond, side, p, q in (((i - 1, j), ("x", x[i], y[j], y[j + 1]), d, a), ((i + 1, j), ("x", x[i + 1], y[j], y[j + 1]), b, c),
                                   ((i, j - 1), ("y", y[j], x[i], x[i + 1]), a, b), ((i, j + 1), ("y", y[j + 1], x[i], x[i + 1]), c, d)):
            if not fluid(*beyond):
                faces.setdefault(patch(*side), []).append((p, q, q + 1, p + 1))
print("FoamFile { version 2.0; format ascii; class dictionary; object blockMeshDict; }")
print(f"scale {scale}; vertices (", *(f"({px} {py} {top})" for py in y for px in x for top in (0, depth)), "); blocks (", *blocks,
      "); edges (); boundary (", sep="\n")
for name, sides in faces.items():
    what = kind if name in ("floor", "ceiling") else "wall" if name == "walls" else "patch"
    print(f"{name} {{ type {what}; faces (", *(f"({' '.join(map(str, side))})" for side in sides), "); }", sep="\n")
print(");")
