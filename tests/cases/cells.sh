#!/bin/bash
# What the tests that track cells share, TAP and OpenFOAM's environment included.
# Sourced from the top folder.
# License: GPL-3.0-or-later, see COPYING.

. tests/tap.sh
# It is read by itself; with it shellcheck takes thrice as long for each of the tests
# shellcheck source=/dev/null
. Make/setup.sh
if [ -z "$WM_PROJECT_DIR" ]; then setup_environment test > /dev/null || exit; fi
# What makes a mesh once for all tests
export PATH="$PWD/tests/cases/programs:$PWD/python/bin:$PATH" PYTHONPATH="$PWD/python:$PWD/tests/cases" ELLIPSOID_TEST_MESHES=${ELLIPSOID_TEST_CASES:-$tap_folder/shared}/meshes
# Test files run side by side: ranks that wait give way, and none is bound to a core
export OMPI_MCA_mpi_yield_when_idle=1 OMPI_MCA_hwloc_base_binding_policy=none
# In Alltest they rest in between, as asking alone takes half of the processor time of a run on three ranks
rest_in_between()
{
    local library=$ELLIPSOID_TEST_CASES/giveWay.so
    if [ ! -e "$library" ]; then
        mkdir -p "$ELLIPSOID_TEST_CASES" && gcc -O2 -shared -fPIC tests/cases/giveWay.c -o "$library.$$" \
            && mv "$library.$$" "$library" || return
    fi
    export OMPI_MCA_mca_base_env_list="LD_PRELOAD=$library"
}
if [ -n "$ELLIPSOID_TEST_CASES" ]; then rest_in_between || exit; fi
# Memory that is read before it was set holds numbers that overflow when they are added
export MALLOC_PERTURB_=128
if [ -n "$ELLIPSOID_PYTHON" ] && [ -z "$ELLIPSOID_TEST_PYTHON" ]; then
    export ELLIPSOID_TEST_PYTHON=$ELLIPSOID_PYTHON ELLIPSOID_PYTHON=$PWD/tests/cases/programs/python
fi
# For the sourcing tests
# shellcheck disable=SC2034
cases=$PWD/tests/cases
# shellcheck disable=SC2034
tutorials=$PWD/tutorials/ellipsoidTrapFoam

# Where a run from time 0 leaves its tables
tables=postProcessing/ellipsoidCloud/0

# Makes CASE anew from a stored one, of which only what is not generated is taken,
# and goes there
new_case()      # CASE STORED
{
    mkdir -p "$tap_folder/$1/constant" && cd "$tap_folder/$1" || exit
    cp -r "$2"/{0.orig,system} . && cp -r 0.orig 0 || exit
    find "$2" -maxdepth 1 -type f -perm -u+x -exec cp {} . \; || exit
    find "$2/constant" -maxdepth 1 -type f -exec cp {} constant/ \; || exit
}

# Makes CASE anew with mesh, settings and flow of another, and goes there
same_flow()     # CASE OTHER
{
    mkdir -p "$tap_folder/$1/0" && cd "$tap_folder/$1" || exit
    cp -r "$tap_folder/$2"/{constant,system} . || exit
    cp "$tap_folder/$2"/0/{U,p,phi} 0/ || exit
    # By which the solver knows its own flow
    if [ -e "$tap_folder/$2"/0/uniform/steadyFlow ]; then
        mkdir -p 0/uniform && cp "$tap_folder/$2"/0/uniform/steadyFlow 0/uniform/ || exit
    fi
}

# Takes a copy of a case. MAKER makes it, once for all test files: Alltest says where.
shared_case()   # CASE MAKER
{
    local folder=${ELLIPSOID_TEST_CASES:-$tap_folder/shared}/$1
    mkdir -p "$folder" && make_once "$folder" "$@" && cp -a "$folder"/* "$tap_folder"
}

make_once()     # FOLDER CASE MAKER
{
    local tap_folder=$1
    (
        exec 9>> "$1.lock" && flock 9 || exit
        if [ ! -e "$1/$2/made" ]; then "$3" "$2" && touch made; fi
    )
}

# The circular trap, of the narrow device: four to five times as many of its cells are caught; of the
# paper's model, without Brownian motion and friction, and held by its speed soon: runs are of seconds
narrow_trap()   # CASE
{
    new_case "$1" "$tutorials/circularTrap"
    set_entry constant/trapGeometry design narrowC
    set_entry constant/ellipsoidCloudProperties brownian "{ active no"
    set_entry constant/ellipsoidCloudProperties wallResistance none
    set_entry constant/ellipsoidCloudProperties friction 0
    set_entry constant/ellipsoidCloudProperties slipSpeed 1e-5
    set_entry constant/ellipsoidCloudProperties holdTime 0.05
    set_entry constant/ellipsoidCloudProperties active no
    sed -i 's/displacement .*;/speedFraction 0.01;/; s/^\( *flow *\)body;/\1centre;/' constant/ellipsoidCloudProperties
}

# The same on its quick mesh, of $layers layers, with few cells, up to the end
make_trap()     # CASE
{
    rm -rf "${tap_folder:?}/$1"
    narrow_trap "$1"
    sed -i "/^    quick/,/}/s/layers .*8;/layers ${layers:-8};/" constant/trapGeometry
    set_entry constant/ellipsoidCloudProperties number 80
    set_entry constant/ellipsoidCloudProperties duration 2
    set_entry system/controlDict endTime 2.2
    ./Allrun -quick -noPictures
}

# The same with half the layers, where bytes are compared or pictures drawn: every run begins in half the time
make_shallow()  { layers=4 make_trap "$1"; }
shallow_trap()  { shared_case shallow make_shallow && mv "$tap_folder"/{shallow,trap}; }

# That with more cells and for longer
make_drawn()    # CASE
{
    rm -rf "${tap_folder:?}/$1" && shallow_trap && mv "$tap_folder"/{trap,"$1"} \
        && cd "$tap_folder/$1" && rm made || return
    set_entry constant/ellipsoidCloudProperties number 150
    set_entry constant/ellipsoidCloudProperties duration 4
    set_entry system/controlDict endTime 4.3
    ./Allrun -quick -noPictures
}

# The channel with one sieve, and its flow
make_sieve()    # CASE
{
    rm -rf "${tap_folder:?}/$1"
    new_case "$1" "$tutorials/singleSieve"
    blockMesh > log.blockMesh && solve_flow
}

# The mesh of blockMesh with a baffle of two walls, plateOne and plateTwo
make_baffle()   # 'MIN MAX' of the middles of the faces of each of its parts
{
    local action=new box
    {
        dictionary_head topoSetDict
        echo 'actions ('
        for box; do
            echo "{ name plate; type faceSet; action $action; source boxToFace; box $box; }"
            action=add
        done
        echo '{ name plate; type faceZoneSet; action new; source setToFaceZone; faceSet plate; } );'
    } > system/topoSetDict
    {
        dictionary_head createBafflesDict
        echo 'internalFacesOnly true; baffles { plate { type faceZone; zoneName plate; patches {'
        echo 'master { name plateOne; type wall; } slave { name plateTwo; type wall; } } } }'
    } > system/createBafflesDict
    blockMesh > log.blockMesh && topoSet > log.topoSet && createBaffles -overwrite > log.createBaffles
}

# Makes CASE, the channel with one sieve, on a mesh that is coarse, and goes there
coarse_sieve()  # CASE
{
    rm -rf "${tap_folder:?}/$1"
    new_case "$1" "$tutorials/singleSieve"
    sed -i -E 's/\((6|7) ([0-9]+) 10\) simple/(4 \2 3) simple/; s/\(12 ([0-9]+) 10\) simple/(6 \1 3) simple/' \
        system/blockMeshDict
    sed -i -E 's/ (20|22) 3\) simple/ 12 3) simple/; s/ 16 3\) simple/ 8 3) simple/; s/ 7 3\) simple/ 4 3) simple/' \
        system/blockMeshDict
}

# That after a run of seven cells, of which three are caught, that wrote every 0.1 s up to 0.4. Steps are long:
# what is compared are the bytes of runs that were stopped
make_written()  # CASE
{
    coarse_sieve "$1"
    sed -i 's/number  .*45;/number 3;/; s/number  .*5;/number 4;/; s/duration .*/duration 0.3;/' constant/ellipsoidCloudProperties
    echo 'integration { tolerance 1e-3; }' >> constant/ellipsoidCloudProperties
    set_entry system/controlDict endTime 0.4
    set_entry system/controlDict purgeWrite 0
    blockMesh > log.blockMesh && run_cells 1
}

# Gives an entry that stands on a line of its own another value
set_entry()     # FILE ENTRY VALUE
{
    if [ "$(grep -c "^ *$2 .*;" "$1")" -ne 1 ]; then
        echo "$1: not one line with the entry $2"
        exit 1
    fi
    sed -i "s|^\( *$2 \+\).*;|\1$3;|" "$1"
}

# The head of a dictionary
dictionary_head()       # NAME
{
    echo "FoamFile { version 2.0; format ascii; class dictionary; object $1; }"
}

# decomposeParDict with N parts, and the entries of its method
set_decomposition()     # N METHOD '(NX NY NZ)'
{
    {
        dictionary_head decomposeParDict
        echo "numberOfSubdomains $1; method $2;"
        echo "${2}Coeffs { n $3; delta 0.001; order xyz; }"
    } > system/decomposeParDict
}

# Runs the solver, or $program, in the present folder, decomposed if on more than one
# rank; its output goes to log, and the end of that is shown. A rank that waits for
# ever shall not hold the test: $run_limit [s], 3000 if not set; a machine may be busy.
run_cells()     # RANKS [OPTION...]
{
    local status n=$1
    local run=(timeout -k 10 "${run_limit:-3000}")
    shift
    if [ "$n" -gt 1 ]; then
        run+=(mpirun --oversubscribe -np "$n")
        set -- -parallel "$@"
    fi
    "${run[@]}" "${program:-ellipsoidTrapFoam}" "$@" > log 2>&1
    status=$?
    # For whoever reads why a test failed
    sed '1,/^Create time/d' log | tail -n 40
    return "$status"
}

# All files of a case but logs and what tests change on purpose
files()
{
    find . -type f ! -name 'log*' ! -name ellipsoidCloudProperties ! -path './system/*' \
        -exec cksum {} + | sort -k 3
}

# What the run on so many ranks must say: one message with all of these in it. If an
# option is to be given, it stands before the ranks.
refused()       # [-OPTION] RANKS REGEX...
{
    local text found status=0 option=()
    if [ "${1#-}" != "$1" ]; then option=("$1"); shift; fi
    run_limit=600 run_cells "$1" "${option[@]}" > log.shown
    found=$?
    shift
    sed '1,/^Create time/d' log
    if [ "$found" -ne 1 ]; then echo "exit status $found"; status=1; fi
    found=$(grep -c "FOAM FATAL" log)
    if [ "$found" -ne 1 ]; then echo "$found messages"; status=1; fi
    sed -n '/FOAM FATAL/,/From function/p' log > log.message
    for text; do
        if ! grep -qE -- "$text" log.message; then echo "not named: $text"; status=1; fi
    done
    return "$status"
}

# Solves the flow of a case whose mesh is there
solve_flow()    { run_cells 1 -flowOnly; }

# Makes CASE anew from a stored one, changes and meshes it, and goes there
mesh_case()     # CASE STORED [SED_SCRIPT FILE]...
{
    new_case "$1" "$2"
    shift 2
    while [ $# -gt 0 ]; do sed -i "$1" "$2"; shift 2; done
    blockMesh > log.blockMesh
}

# The flux that leaves [m3/s]
flux()          { awk '$2 == "outlet:" { print $3 }' log; }

# Are two numbers as near as that, relative to the second? With the first words of a tap_row, it is one
near()          # A B TOLERANCE [GROUP QUANTITY CONDITIONS SOURCE KIND WHY]
{
    echo "$1 against $2, relative tolerance $3"
    if [ $# -gt 3 ]; then
        tap_row "${@:4}" "$(awk -v a="$1" -v b="$2" 'BEGIN { printf "%.15g", a/b }')" 1 "$3"
        return
    fi
    awk -v a="$1" -v b="$2" -v t="$3" 'BEGIN { e = a/b - 1; exit !(-t < e && e < t) }'
}

# The tables of two cases, byte by byte. With CONDITIONS it is a row of the validation table
same_tables()   # CASE OTHER [CONDITIONS]
{
    local file differ=0
    for file in events.csv cells.csv captures.csv tracks.csv tracks.vtp; do
        cmp "$tap_folder/$1/$tables/$file" "$tap_folder/$2/$tables/$file" || differ=$((differ + 1))
    done
    if [ $# -gt 2 ]; then
        tap_row "parallel and restart" "tables, of five, in which a byte differs" "$3" "one run on one rank" I "none may" "$differ" 0 0.5
    fi
    [ "$differ" -eq 0 ]
}

# Starts Python with these modules, once for many commands of the package: of a line 'FOLDER COMMAND WORD...' to $ask
# the exit status comes from $answer, and said.out and said.error are what it wrote
# shellcheck disable=SC2034
start_server()  # MODULE...
{
    ask='' answer=''
    coproc server { "${ELLIPSOID_PYTHON:-python3}" "$cases/commandServer.py" "$tap_folder"/said.{out,error} "$@"; }
    # Those of a coprocess are not there in a subshell
    exec {ask}>&"${server[1]}" {answer}<&"${server[0]}" || exit
    eval "exec ${server[1]}>&-"
}

# Runs Python from the standard input in a case, after checks.py, which is what all checks need
numbers()       # CASE ARGUMENT...
(
    cd "$tap_folder/$1" || exit
    shift
    cat "$cases/checks.py" - | "${ELLIPSOID_PYTHON:-python3}" - "$@"
)

# All centres of tracks.csv, more than so many, are inside the circular trap. Dimensions of
# its narrow device, in micrometres. A centre stays a semi-minor axis, 0.5, from every wall, less
# what a corner reaches in between beads; found 0.45.
centres_in_chamber()    # CASE COUNT
{
    numbers "$1" "$2" << 'EOT'
MARGIN = 0.4
x, y, z = 1e6*columns(table("tracks.csv"), "x1", "x2", "x3").T
expect(len(x) > int(sys.argv[1]), f"{len(x)} centres")


def beyond(u, v, x0, x1, y0, y1):
    """Distance from a rectangle."""
    return np.hypot(np.maximum(np.maximum(x0 - u, u - x1), 0), np.maximum(np.maximum(y0 - v, v - y1), 0))


free = (z > MARGIN) & (z < 10 - MARGIN) & (np.abs(y) < 70 + 1e-6)
free &= (np.hypot(x, y) < 40 - MARGIN) | (np.abs(x) < 10 - MARGIN)
for a, b in ((-18, -17), (0, -17), (18, -17), (-9, 0), (9, 0), (-18, 17), (0, 17), (18, 17)):
    u, v = np.abs(x - a), y - b
    free &= (beyond(u, v, 2.4, 4.4, -4, 1) > MARGIN) & (beyond(u, v, 0.4, 1.6, 0, 1) > MARGIN)
expect(free.all(), f"{np.count_nonzero(~free)} not free, at {list(zip(x[~free], y[~free], z[~free]))[:5]} um")
finish()
EOT
}
