#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""Which room of the sources includes headers of which, and whether all point one way.

usage: tests/setup/arrows.py [--write | --check] [TREE]

Prints the tables of CONTRIBUTING.md; --write puts them there, --check fails where they differ.
Fails on an arrow to a later room, and on a room that is not listed here.
"""

import re
import sys
from collections import Counter
from pathlib import Path

# Folder to its rooms, each of which knows those before it only; "." are the files of the folder itself,
# and a file may be a room
ROOMS = {
    "src/ellipsoid": [".", "body", "walls", "drag", "contact", "motion", "world"],
    "src/meshFlow": ["base", "mesh", "values", ".", "interpolation"],
    "src/coupledStokes": ["coupledStokes.H", "linear", "flow", "."],
    "src/ellipsoidCloud": [
        "base", "walls", "cells", "motion", "injection", "output", "capture", "occupancy", "cloud", "functionObject",
    ],
    "applications": ["."],
    "tests": ["."],
}
# Folder to the folders that it may include headers of, and the rooms of these that are public ([]: all)
USES = {
    "src/ellipsoidCloud": {"src/ellipsoid": ["."], "src/meshFlow": []},
    "applications": {"src/ellipsoidCloud": [], "src/meshFlow": [], "src/coupledStokes": ["coupledStokes.H"]},
    "tests": {
        "src/ellipsoid": [], "src/meshFlow": [], "src/coupledStokes": ["coupledStokes.H", "flow"], "src/ellipsoidCloud": [], "applications": [],
    },
}
# Not part of what is built of the folder's rooms
APART = {"lnInclude", "Make", "build", "example"}
BEGIN, END = "<!-- arrows: written by tests/setup/arrows.py --write -->\n", "<!-- end of arrows -->\n"


def sources(tree, folder):
    """Files of a folder with their room."""
    for file in sorted((tree / folder).rglob("*.[cChH]")):
        parts = file.relative_to(tree / folder).parts
        if not APART.intersection(parts):
            divided = len(ROOMS[folder]) > 1 and (len(parts) > 1 or parts[0] in ROOMS[folder])
            yield file, parts[0] if divided else "."


def arrows(tree):
    """Counter of ((folder, room), (folder, room)): includes of the first that name a header of the second."""
    files = {folder: list(sources(tree, folder)) for folder in ROOMS}
    home = {file.name: (folder, room) for folder in files for file, room in files[folder] if file.suffix in (".h", ".H")}
    found = Counter()
    for folder, inside in files.items():
        for file, room in inside:
            for name in re.findall(r'^ *# *include *"(?:.*/)?(.*)"', file.read_text(), re.M):
                if name in home and home[name] != (folder, room):
                    found[(folder, room), home[name]] += 1
    return found


def faults(found, tree):
    """What points the wrong way, in words."""
    for folder, rooms in ROOMS.items():
        there = {room for _, room in sources(tree, folder)}
        yield from (f"{folder}/{room} is no room of {Path(__file__).name}" for room in sorted(there - set(rooms)) if room != ".")
    for (user, used), count in found.items():
        (user_folder, user_room), (used_folder, used_room) = user, used
        rooms = ROOMS[user_folder]
        if user_folder != used_folder:
            public = USES.get(user_folder, {}).get(used_folder)
            wrong = public is None or public and used_room not in public
        else:
            wrong = {user_room, used_room} <= set(rooms) and rooms.index(user_room) < rooms.index(used_room)
        if wrong:
            yield f"{'/'.join(user)} includes {count} headers of {'/'.join(used)}"


def table(rows, columns, count):
    """Markdown of the counts; rows and columns without any are left out."""
    rows = [row for row in rows if any(count(row, column) for column in columns)]
    columns = [column for column in columns if any(count(row, column) for row in rows)]
    lines = ["| | " + " | ".join(f"`{column}`" for column in columns) + " |", "|---" * (len(columns) + 1) + "|"]
    lines += [f"| `{row}` | " + " | ".join(str(count(row, column) or "") for column in columns) + " |" for row in rows]
    return "\n".join(lines)


def text(found):
    """The tables: libraries, then the rooms of each."""
    between = Counter()
    for (user, used), count in found.items():
        if user[0] != used[0]:
            between[user[0], used[0]] += count
    libraries = [folder for folder in ROOMS if folder != "tests"]
    parts = [table(libraries, libraries, lambda row, column: between[row, column])]
    for folder, rooms in ROOMS.items():
        if len(rooms) > 1:
            parts.append(f"`{folder}`:\n\n" + table(rooms, rooms, lambda row, column: found[(folder, row), (folder, column)]))
    return "\n\n".join(parts)


def main(arguments):
    """See above."""
    options = [word for word in arguments if word.startswith("-")]
    tree = Path(next((word for word in arguments if not word.startswith("-")), Path(__file__).parents[2]))
    found = arrows(tree)
    wrong = list(faults(found, tree))
    if wrong:
        sys.exit("\n".join(wrong))
    if not options:
        print(text(found))
        return
    page = tree / "CONTRIBUTING.md"
    before, rest = page.read_text().split(BEGIN)
    now = before + BEGIN + "\n" + text(found) + "\n\n" + END + rest.split(END)[1]
    if options == ["--write"]:
        page.write_text(now)
    elif now != page.read_text():
        sys.exit(f"{page} has other arrows: tests/setup/arrows.py --write")


if __name__ == "__main__":
    main(sys.argv[1:])
