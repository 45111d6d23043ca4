#!/bin/bash
# Sourced by the *.test files: prints TAP, which Alltest reads.
#
#   tap_check NAME COMMAND...   ok if the command succeeds; what it wrote is shown if not
#   tap_ok NAME, tap_not_ok NAME [WHY], tap_skip NAME WHY
#   tap_row GROUP QUANTITY CONDITIONS SOURCE KIND WHY VALUE REFERENCE BOUND [DISAGREES]
#                               does VALUE lie within BOUND? A row of the validation table
#                               (CONTRIBUTING.md, Tests); where --full alone runs, tap_often=full
#   tap_end                     the last line of a test file: plan and exit status
#   tap_make_comma, "${tap_comma[@]}" COMMAND...    a locale with a decimal comma; the command in it
# Sets tap_folder, an empty folder that is removed at the end.

tap_count=0
tap_failed=0
tap_folder=
# Before there is a folder: a signal may come as soon as it is made
trap 'rm -rf "$tap_folder"' EXIT
trap 'exit 143' INT TERM HUP
tap_folder=$(mktemp -d "${TMPDIR:-/tmp}/ellipsoidTest.XXXXXX") || exit
# shellcheck disable=SC2034
tap_comma=(env LOCPATH="$tap_folder" LC_ALL=comma)

tap_ok()     { echo "ok $((++tap_count)) - $1"; }
tap_skip()   { echo "ok $((++tap_count)) - $1 # SKIP $2"; }
tap_not_ok()
{
    echo "not ok $((++tap_count)) - $1"
    tap_failed=$((tap_failed + 1))
    if [ -n "$2" ]; then printf '%s\n' "$2" | sed 's/^/# /'; fi
}

tap_check()
{
    local name=$1 output
    shift
    if output=$("$@" 2>&1); then tap_ok "$name"; else tap_not_ok "$name" "$output"; fi
}

tap_row()
{
    if [ -n "$ELLIPSOID_TEST_ROWS" ]; then
        { printf '%s\t' "${@:1:9}" "${tap_often:-everyday}"; echo "${10:-0}"; } >> "$ELLIPSOID_TEST_ROWS"
    fi
    echo "$2: $7, reference $8, bound $9"
    awk -v v="$7" -v r="$8" -v b="$9" -v d="${10:-0}" 'BEGIN {
        e = (v - r)/b; e = e < 0 ? -e : e; exit !(d > 1 ? e > 1 && e <= d : e <= 1) }'
}

# Of the portable characters alone, so that it takes no files of the system's
tap_make_comma()
{
    local code
    printf 'LC_NUMERIC\ndecimal_point ","\nthousands_sep ""\ngrouping -1\nEND LC_NUMERIC\n' > "$tap_folder/comma.source"
    {
        printf '<code_set_name> ANSI_X3.4-1968\n<comment_char> %%\n<escape_char> /\nCHARMAP\n'
        for code in {0..127}; do printf '<U%04X> /x%02x\n' "$code" "$code"; done
        echo 'END CHARMAP'
    } > "$tap_folder/comma.characters"
    # It warns of the categories that are not there
    localedef --no-archive -c -i "$tap_folder/comma.source" -f "$tap_folder/comma.characters" "$tap_folder/comma" 2> /dev/null
    # shellcheck disable=SC2016
    [ "$("${tap_comma[@]}" "$BASH" -c 'echo "${EPOCHREALTIME//[0-9]/}"')" = , ]
}

tap_end()
{
    echo "1..$tap_count"
    [ "$tap_failed" -eq 0 ]
    exit
}
