# What the tests of the circular trap's pictures share: it, narrow, with few cells. Sourced.
# License: GPL-3.0-or-later, see COPYING.
# shellcheck shell=bash
. tests/cases/cells.sh

python=${ELLIPSOID_PYTHON:-python3}
if ! "$python" -c "import matplotlib, vtkmodules" 2> /dev/null; then
    tap_skip "pictures" "Python has no matplotlib or no VTK"
    tap_end
fi

tap_check "mesh, flow and cells" shared_case drawn make_drawn
mv "$tap_folder"/{drawn,trap} && cd "$tap_folder/trap" || exit
