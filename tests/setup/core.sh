#!/bin/bash
# What the tests that build and run the tests of the core again share, TAP included.
# Sourced from the top folder; ends the file where the run is not the full one.

. tests/tap.sh
if [ "$ELLIPSOID_TEST_FULL" != 1 ]; then
    tap_skip "the tests of the core with this tool" "needs --full"
    tap_end
fi

# With few samples where their number is a matter of statistics, and shorter runs
export ELLIPSOID_TEST_FEW=1

# The tests of the core, in a folder of their own. gcc takes some of what it instruments
# for uninitialised.
core_tests()    # COMPILER FOLDER FLAGS [TARGET | VARIABLE=VALUE]...
{
    local compiler=$1 folder=$tap_folder/$2 flags=$3
    shift 3
    if [ "$compiler" = gcc ]; then flags+=" -Wno-maybe-uninitialized"; fi
    make -s -O -j "$(nproc)" -C tests/core CC="$compiler" \
        BUILD="$folder" CFLAGS="$flags" "$@"
}
