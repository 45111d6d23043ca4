#!/bin/bash
# Sourced by the *.test files: prints TAP, which Alltest reads.
#
#   tap_check NAME COMMAND...   ok if the command succeeds; what it wrote is shown if not
#   tap_ok NAME, tap_not_ok NAME [WHY], tap_skip NAME WHY
#   tap_end                     the last line of a test file: plan and exit status
# Sets tap_folder, an empty folder that is removed at the end.

tap_count=0
tap_failed=0
tap_folder=$(mktemp -d "${TMPDIR:-/tmp}/ellipsoidTest.XXXXXX") || exit
trap 'rm -rf "$tap_folder"' EXIT
trap 'exit 143' INT TERM HUP

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

tap_end()
{
    echo "1..$tap_count"
    [ "$tap_failed" -eq 0 ]
    exit
}
