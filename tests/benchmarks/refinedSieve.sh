# The channel with one sieve, on a mesh refined at will, with a potential flow: what the
# benchmarks of large meshes share. Sourced after tests/cases/cells.sh.
# License: GPL-3.0-or-later, see COPYING.

# Makes CASE with so many mesh cells along each edge of the tutorial's, for one, and goes there
refined_sieve()     # CASE FACTOR
{
    new_case "$1" "$tutorials/singleSieve"
    sed -i -E "/^ *hex /s/\(([0-9]+) ([0-9]+) ([0-9]+)\) simple/\n\1 \2 \3\n/" system/blockMeshDict
    awk -v f="$2" '/^[0-9]+ [0-9]+ [0-9]+$/ { printf "(%d %d %d) simple", f*$1, f*$2, f*$3; next }
        /^ *hex / { printf "%s", $0; next } { print }' system/blockMeshDict > dict \
        && mv dict system/blockMeshDict
    set_entry system/controlDict writeFormat binary
    sed -i -E 's/^( *)p$/\1"p|Phi"/; $ a potentialFlow { nNonOrthogonalCorrectors 0; }' system/fvSolution
    # A given velocity, as a potential flow wants it
    sed -i 's/"(inlet|outlet)"/outlet/' 0/U
    set_patch U inlet 'type fixedValue; value uniform (0 4e-3 0);'
    set_patch p inlet 'type zeroGradient;'
    { blockMesh && potentialFoam -writephi; } > log.flow 2>&1
}

set_patch()         # FIELD PATCH ENTRIES
{
    foamDictionary -entry "boundaryField.$2" -set "{ $3 }" "0/$1" > /dev/null
}
