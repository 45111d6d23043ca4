#!/bin/bash
# In a bare Debian: set-up, build, and cells by a function object of a stock solver.
# Sourced from the top folder, TAP included; bare_debian is all of a test.

. tests/tap.sh
. Make/setup.sh

# Makes it, or takes the one that was made before
make_root()     # SUITE ROOT
{
    local kept
    kept=$(setup_cache_folder)/bare-$1.tar
    mkdir -p "$2" "${kept%/*}" || return
    if [ ! -e "$kept" ]; then
        debootstrap --variant=minbase --include=ca-certificates,sudo "$1" "$2" || return
        tar -C "$2" --exclude='./var/cache/apt/archives/*.deb' --exclude='./proc/*' --exclude='./sys/*' \
            --exclude='./dev/*' -cf "$kept.$$" . && mv "$kept.$$" "$kept"
    else
        tar -C "$2" -xf "$kept" && cp /etc/resolv.conf "$2/etc/"
    fi || return
    # It is thrown away: nothing need reach the disk
    echo force-unsafe-io > "$2/etc/dpkg/dpkg.cfg.d/unsafe"
    chroot "$2" useradd --create-home --shell /bin/bash somebody || return
    echo 'somebody ALL=(ALL) NOPASSWD: ALL' > "$2/etc/sudoers.d/somebody"
}

# This tree as it is, without what was built
copy_tree()     # ROOT USER
{
    local home
    home=$1$(chroot "$1" sh -c "echo ~$2")/ellipsoidTrapFoam
    mkdir "$home" && git ls-files -z --cached --others --exclude-standard | tar --null -T - -cf - | tar -C "$home" -xf - \
        && chroot "$1" chown -R "$2:" "${home#"$1"}"
}

# What is mounted is seen in here alone, and gone when it ends
in_root()       # ROOT USER COMMAND
{
    # shellcheck disable=SC2016
    timeout 3600 unshare --mount --pid --fork --kill-child bash -c '
        mount -t proc proc "$1/proc" && mount --rbind /dev "$1/dev" || exit
        exec chroot "$1" su --login "$2" --command "cd ellipsoidTrapFoam && $3"' in_root "$@"
}

builds()        # ROOT USER
{
    local log=$tap_folder/build.log status
    in_root "$@" ./Allwmake > "$log" 2>&1
    status=$?
    cat "$log"
    [ "$status" -eq 0 ] && ! grep -q 'warning:' "$log"
}

bare_debian()   # SUITE USER
{
    local root=$tap_folder/root user=$2
    if [ "$ELLIPSOID_TEST_FULL" != 1 ]; then
        tap_skip "a bare $1" "needs --full"
    elif ! command -v debootstrap > /dev/null; then
        tap_skip "a bare $1" "debootstrap is not installed"
    elif ! unshare --mount --pid --fork true 2> /dev/null; then
        tap_skip "a bare $1" "no right to mount"
    else
        tap_check "a bare $1 is made" make_root "$1" "$root"
        tap_check "this tree is copied" copy_tree "$root" "$user"
        tap_check "set-up and build as $user, without a warning of the compiler" builds "$root" "$user"
        tap_check "cells by a stock solver" in_root "$root" "$user" \
            '. Make/setup.sh && setup_environment build && cd tutorials/simpleFoam/post && ./Allrun \
                && grep "^cells: 60 injected, .*, 0 lost" log.simpleFoam'
    fi
    tap_end
}
