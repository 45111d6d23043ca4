# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""Commands of makePictures, each in a process of its own that has the modules loaded already.

usage: pictureCommands.py FOLDER [PROPERTY...] < COMMANDS

A line of COMMANDS is NAME PICTURE WORD..., with the words of makePictures; PICTURE is a file in
pictures, or '-'. FOLDER gets NAME.status, NAME.said with the standard error, and the picture as
NAME.png. The properties are those of the case in the present folder that are read once for all.
"""

import gc
import os
import shlex
import shutil
import sys

from ellipsoidtrap.pictures import makePictures

folder, *properties = sys.argv[1:]


def run(words, said):
    """One command in this process, which it ends as it ends that of the program."""
    error = os.open(said, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o644)
    os.dup2(error, 2)
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    sys.exit(0 if makePictures.main(words) else 1)


for prop in properties:
    getattr(makePictures.case_of("."), prop)
# Or each process would clear all of that when it ends
gc.freeze()
for line in sys.stdin.read().splitlines():
    name, picture, *words = shlex.split(line)
    stem = os.path.join(folder, name)
    drawn = os.path.join("pictures", picture)
    if os.path.isfile(drawn):
        os.remove(drawn)
    child = os.fork()
    if child == 0:
        run(words, stem + ".said")
    status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    with open(stem + ".status", "w", encoding="ascii") as file:
        file.write(f"{status}\n")
    if os.path.isfile(drawn):
        shutil.copyfile(drawn, stem + ".png")
