#!/bin/bash
# Plane devices: of rectangles, and arrays of posts of any size and slope. Sourced from the top folder.
# License: GPL-3.0-or-later, see COPYING.

. tests/cases/cells.sh

# A device from its drawing on the standard input (planeMesh.py), on patches as those of the stored channel
plane_case()    # CASE SCALE DEPTH KIND
{
    new_case "$1" "$cases/channel"
    sed -i "/frontAndBack/,/}/s/empty/$4/; s/frontAndBack/\"(floor|ceiling)\"/" 0/U 0/p
    "$ELLIPSOID_PYTHON" "$cases/planeMesh.py" "${@:2}" > system/blockMeshDict && blockMesh > log.blockMesh
}

# The tutorial's array with other posts: their radius, distance [um], slope of the rows, posts a row
new_posts()     # CASE RADIUS PERIOD SLOPE POSTS
{
    new_case "$1" "$tutorials/postArray"
    cp -r "$cases"/postArray/* . || return
    sed -i "s/^RADIUS, PERIOD, SHIFT, POSTS = .*/RADIUS, PERIOD, SHIFT, POSTS = $2, $3, $4, $5/" postMesh
    sed -i "s/^RADIUS, PERIOD, SHIFT = .*/RADIUS, PERIOD, SHIFT = $2e-6, $3e-6, $4/" separatingStreamline followSpheres
}

# No face of an opening turns from inflow to outflow: where that is decided anew in each iteration, some flows do not settle
solve_settled()
{
    sed -i 's/pressureInletOutletVelocity/zeroGradient/' 0/U
    solve_flow > log.shown || { cat log.shown; return 1; }
}

# The step of p from one side to the other, which turns the flow
set_jump()      { sed -i "s/^\( *jump *uniform\) .*;/\1 $1;/" 0/p; }

# The separating streamline's distance from the posts, and the flux that passes below it, by the gap's (widths), where the flow goes along
# x: a jump of p between the sides that turns it. The flux is linear in the jump.
level_flow()    # GUESS of the jump, PRESSURE at the inlet [m2/s2]
{
    local share=() jump
    for jump in 0 "$1" level; do
        if [ "$jump" = level ]; then
            jump=$(awk -v j="$1" -v a="${share[0]}" -v b="${share[1]}" -v s="$(sed -n 's/^RADIUS, PERIOD, SHIFT = .*, //p' followSpheres)" \
                'BEGIN { print j*(s - a)/(b - a) }')
        fi
        rm -rf 0 && cp -r 0.orig 0 && set_jump "$jump"
        sed -i "s/uniform 0.0342857142857143;/uniform $2;/" 0/p
        solve_settled || return
        "$ELLIPSOID_PYTHON" separatingStreamline > widths || return
        share+=("$(awk '{ n += $2 } END { print n/NR }' widths)")
    done
    echo "jump $jump: shares of the flux ${share[*]}"
}

# The paper's model, for the tests
# shellcheck disable=SC2034
paper='forces { flow centre; wallResistance none; }'

# 21 spheres twice, or COUNT of followSpheres, the second time between two neighbours of the first; their mode must change
# once, from one diameter to the next
follow()        # CASE OTHER INTERPOLATION [LEAST MOST OPTIONS], LEAST and MOST over twice the separating streamline's distance
{
    local range width
    same_flow "$1" "$2"
    sed -i "s/^\(interpolation *\).*/\1$3;/" constant/ellipsoidCloudProperties
    if [ $# -gt 5 ]; then echo "$6" >> constant/ellipsoidCloudProperties; fi
    width=$(awk '{ n += $4 } END { print 2*n/NR }' "$tap_folder/$2/widths")
    range=$(awk -v w="$width" -v a="${4:-0.88}" -v b="${5:-1.12}" 'BEGIN { print a*w, b*w }')
    for _ in 1 2; do
        rm -rf postProcessing [1-9]* 0.*
        "$tap_folder/$2/followSpheres" write "${range% *}" "${range#* }" || return
        run_cells 1 > log.shown || { tail log.shown; return 1; }
        "$tap_folder/$2/followSpheres" read > found 2>&1 || { cat found; return 1; }
        range=$(cut -d ' ' -f 1,2 found)
    done
    awk -v width="$width" '{ d = ($1 + $2)/2
        printf "diameter %.5g um, of the flow %.5g um, ratio %.4f, deepest overlap %.2g of the radius\n",
            1e6*d, 1e6*width, d/width, 2*$3/d }' found
}
