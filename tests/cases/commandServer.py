# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""Commands of the package, each in a process of its own that has the modules loaded already.

usage: commandServer.py OUT ERROR MODULE... < COMMANDS

A line of COMMANDS is FOLDER COMMAND WORD...; OUT and ERROR get what it writes, the standard output
of this program its exit status, in a line.
"""

import gc
import importlib
import os
import shlex
import sys

from ellipsoidtrap import __main__ as package

out, error, *modules = sys.argv[1:]
for module in modules:
    importlib.import_module(module)
# Or each process would clear all of that when it ends
gc.freeze()
for line in sys.stdin:
    folder, *words = shlex.split(line)
    child = os.fork()
    if child == 0:
        for number, name in ((1, out), (2, error)):
            os.dup2(os.open(name, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o644), number)
        os.chdir(folder)
        sys.argv = words
        sys.exit(package.main())
    print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), flush=True)
