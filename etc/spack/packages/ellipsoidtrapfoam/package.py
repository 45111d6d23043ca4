# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.

import os

from spack.package import *


class Ellipsoidtrapfoam(Package):
    """Rigid ellipsoids, such as bacteria, in the flow of microfluidic devices: a solver and a
    function object for OpenFOAM (ESI), as a module beside it."""

    # The clone that this recipe lies in
    git = "file://" + os.path.realpath(os.path.join(os.path.dirname(__file__), *4 * [os.pardir]))

    license("GPL-3.0-or-later")

    version("main", branch="main")

    depends_on("c", type="build")
    depends_on("cxx", type="build")
    depends_on("gmake", type="build")

    depends_on("openfoam@1912:+source")  # +source: headers and wmake
    depends_on("mpi")
    depends_on("random123")

    def install(self, spec, prefix):
        """wmake builds straight into the prefix; the environment is that of openfoam."""
        Executable("./Allwmake")(f"-j{make_jobs}", f"-prefix={prefix}")
        # Tutorials, commands and annotated dictionaries find one another by these places
        for folder in ("tutorials", "python", "etc", "docs"):
            install_tree(folder, join_path(prefix, folder))
        mkdirp(prefix.Make)
        install("Make/setup.sh", prefix.Make)
        install("COPYING", prefix)

    def setup_run_environment(self, env):
        """Function objects and commands are found by name."""
        env.prepend_path("LD_LIBRARY_PATH", self.prefix.lib)
        env.prepend_path("PATH", self.prefix.python.bin)
