#!/bin/bash
# Tables of inputs. A row says what is set in a file of a good case and what the run says of it:
#
#     NAME | SETTING | FRAGMENT ; FRAGMENT ...
#
# SETTING is appended to the file, by which OpenFOAM replaces an entry that stands before; or a script of
# sed that begins with s or /; or a command after '!'. FRAGMENTs are regular expressions, all of which the
# message must have; 'line': it names the line of what was appended.
# Of every row: exit status, one message (or, where the status is 0, a warning), and that all files of the
# case are as they were. Rows run side by side, each in a copy of the case.
# Sourced from the top folder.
# License: GPL-3.0-or-later, see COPYING.

. tests/cases/cells.sh

# Digests of all files in the present folder but logs
digests()       { find . -type f ! -name 'log*' -exec cksum {} + | sort -k 3; }

# Makes the good case: a duct on a small mesh, with its flow and the tables of an earlier run
make_inputs()   # CASE
{
    mesh_case "$1" "$cases/duct" 's/(25 38 12)/(8 12 4)/' system/blockMeshDict
    set_entry system/controlDict startFrom startTime
    {
        dictionary_head ellipsoidCloudProperties
        cat << 'EOT'

cell
{
    semiAxes        (0.5e-6 2e-6 5e-7);
    density         1040;
}

contact
{
    friction        0.3;
    slipSpeed       2e-5;
    damping         10;
}

injection
{
    start
    {
        type            patch;
        patch           inlet;
        number          5;
    }
}

capture
{
    sieves          (channel);
    holdTime        1e-3;
}

tracks
{
    interval        1e-3;
}
EOT
    } > constant/ellipsoidCloudProperties
    run_cells 1 && rm -r 0.001
}

set_input()     # FILE SETTING
{
    case $2 in
        '! '*) eval "${2#! }" > log.set 2>&1 ;;
        s[/\|]* | /*) sed -i "$2" "$1" ;;
        *) printf '%s\n' "$2" >> "$1" ;;
    esac
}

# One row, in the present copy of the case, whose digests were $good_digests
try_input()     # FILE SETTING STATUS FRAGMENTS [OPTION...]
{
    local file=$1 setting=$2 status=$3 fragments=$4 failed=0
    local before found message text lines
    shift 4

    set_input "$file" "$setting" || { cat log.set; return 1; }
    before=$(digests)
    if [ "$before" = "$good_digests" ]; then echo "nothing was set"; return 1; fi

    run_limit=600 run_cells 1 "$@"
    found=$?
    if [ "$found" -ne "$status" ]; then echo "exit status $found"; failed=1; fi
    if ! diff <(echo "$before") <(digests); then echo "files are not as they were"; failed=1; fi

    if [ "$status" -ne 0 ]; then
        found=$(grep -c "FOAM FATAL" log)
        if [ "$found" -ne 1 ]; then echo "$found messages"; failed=1; fi
        message=$(sed -n '/FOAM FATAL/,/From function/p' log)
    else
        message=$(grep -A 6 "FOAM Warning" log)
    fi
    message=$(tr -s '\n ' '  ' <<< "$message")
    while read -r text; do
        if [ "$text" = line ]; then mapfile -t lines < "$file" && text="${file##*/}.* line ${#lines[@]}\b"; fi
        if ! [[ $message =~ $text ]]; then echo "not said: $text"; failed=1; fi
    done <<< "${fragments// ; /$'\n'}"
    return "$failed"
}

shown()         # FOLDER: verdict of a row
{
    echo "$(< "$1/log.row")"
    return "$(< "$1/log.status")"
}

# A table of the standard input
inputs()        # GOOD_CASE FILE STATUS [OPTION...]
{
    local good=$1 file=$2 status=$3 name setting fragments folder good_digests
    local folders=() names=() most running=0
    shift 3
    most=$(nproc)
    good_digests=$(cd "$good" && digests) || return

    while IFS='|' read -r name setting fragments; do
        read -r name <<< "$name"
        setting=${setting# } setting=${setting%"${setting##*[! ]}"} fragments=${fragments# }
        folder=$tap_folder/row.$((tap_count + ${#names[@]}))
        names+=("$name: $setting")
        folders+=("$folder")
        if [ "$((running++))" -ge "$most" ]; then wait -n; fi
        (
            cp -r "$good" "$folder" && cd "$folder" || exit
            try_input "$file" "$setting" "$status" "$fragments" "$@" > log.row 2>&1
            echo $? > log.status
        ) &
    done
    wait
    for row in "${!names[@]}"; do
        tap_check "${names[$row]}" shown "${folders[$row]}"
        rm -r "${folders[$row]}"
    done
}
