#!/bin/bash
# ellipsoidTrapFoam set-up, shared by Allwmake, Allrun and Alltest.
# License: GPL-3.0-or-later, see COPYING.
#
# Finds OpenFOAM (ESI, v1912 or newer). Where there is none, but apt's sources offer
# Debian's, brings that: programs and libraries from the binary package, headers and
# wmake from the source package of the same version, kept in one cache folder. Then
# gives the calling shell OpenFOAM's environment.
#
# Usage (bash):  . Make/setup.sh && setup_environment build|run|test|full
#   build   compilers, OpenFOAM and the Random123 headers
#   run     also Python with matplotlib, VTK and numpy: pictures and tables
#   test    also cmocka, h5py, pkg-config and what reads drawings
#   full    also what Alltest --full needs: clang with its sanitizers and
#           libFuzzer, valgrind, cppcheck, shellcheck and SUNDIALS
# Exports OpenFOAM's environment; for run, test and full ELLIPSOID_PYTHON, too, and a PATH with
# the commands of python/bin.
#
# Variables that may be set beforehand:
#   WM_PROJECT_DIR        an OpenFOAM to use instead of searching
#   ELLIPSOID_CACHE       cache folder [${XDG_CACHE_HOME:-$HOME/.cache}/ellipsoidTrapFoam]

setup_folder=$(dirname "$(realpath "${BASH_SOURCE[0]}")")
setup_needed="an ESI OpenFOAM (openfoam.com), v1912 or newer, with headers and wmake, such as \
the packages openfoamNNNN-default of openfoam.com, which are found in /usr/lib/openfoam"
# Numbers have a point and messages are in English, whatever the user's language
export LC_ALL=C.UTF-8
# Of a user to whom none was given, that of the system's list of users
export HOME=${HOME:-~}

setup_say() { echo "[set-up] $*"; }

# setup_fail WHAT [HINT...]: the one way an error leaves here
setup_fail()
{
    echo "[set-up] error: $1" 1>&2
    shift
    local hint
    for hint; do echo "[set-up]   $hint" 1>&2; done
    return 1
}

setup_seconds_since()   # START in $EPOCHREALTIME's format
{
    local ms=$(( (${EPOCHREALTIME/./} - ${1/./}) / 1000 ))
    printf '%d.%d s' $((ms / 1000)) $((ms % 1000 / 100))
}

setup_cache_folder()
{
    if [ -n "$ELLIPSOID_CACHE" ]; then
        echo "$ELLIPSOID_CACHE"
    else
        echo "${XDG_CACHE_HOME:-$HOME/.cache}/ellipsoidTrapFoam"
    fi
}

setup_has_apt() { command -v apt-get > /dev/null && command -v dpkg-query > /dev/null; }

setup_system_name()
(
    . /etc/os-release 2> /dev/null
    echo "${PRETTY_NAME:-an unknown system}"
)

# -----------------------------------------------------------------------------
# Which OpenFOAM

# The api number (1912, 2206, ..) of an ESI OpenFOAM; nothing for other flavours
setup_openfoam_api()    # DIR
{
    sed -n 's/^ *WM_VERSION *= *OPENFOAM=\([0-9]\{4\}\).*/\1/p' \
        "$1/wmake/rules/General/general" 2> /dev/null
}

# The version of an OpenFOAM of the Foundation, 10 or dev; nothing for other flavours
setup_foundation_version()  # DIR
{
    if [ -n "$(setup_openfoam_api "$1")" ] || ! grep -qs '^ *export WM_PROJECT=OpenFOAM' "$1/etc/bashrc"; then return; fi
    sed -n 's/^ *export WM_PROJECT_VERSION=\([0-9][0-9.]*\|dev\) *\(#.*\)\{0,1\}$/\1/p' "$1/etc/bashrc"
}

# Says why DIR cannot be used; silent and true if it can
setup_check_openfoam()  # DIR
{
    local api foundation version="${WM_PROJECT:-OpenFOAM} ${WM_PROJECT_VERSION:-of unknown version}"
    api=$(setup_openfoam_api "$1")
    foundation=$(setup_foundation_version "$1")
    if [ ! -f "$1/etc/bashrc" ]; then
        setup_fail "WM_PROJECT_DIR is $1, which holds no etc/bashrc" \
            "Needed: $setup_needed. Or unset WM_PROJECT_DIR, to have one found or installed."
    elif [ -n "$foundation" ]; then
        setup_fail "$1 is OpenFOAM $foundation of the Foundation (openfoam.org), which is another program" \
            "Needed: $setup_needed." "Use a shell without that environment, or source another one."
    elif [ -z "$api" ]; then
        setup_fail "$1 ($version) is not an ESI OpenFOAM" \
            "Needed: $setup_needed; foam-extend differs too much." \
            "Use a shell without that environment, or source another one."
    elif [ "$api" -lt 1912 ]; then
        setup_fail "$1 is OpenFOAM v$api, which is too old" \
            "Needed: $setup_needed."
    elif [ ! -x "$1/wmake/wmake" ] || [ ! -e "$1/src/finiteVolume/lnInclude/fvCFD.H" ]; then
        setup_fail "$1 (OpenFOAM v$api) holds no wmake or no headers" \
            "Install its development package, or run 'wmakeLnIncludeAll' in it."
    fi
}

# The newest usable OpenFOAM in the usual places, if any
setup_search_openfoam()
{
    local dir api best=0 found=
    for dir in /usr/lib/openfoam/openfoam*/ /opt/openfoam*/ \
        /opt/OpenFOAM/OpenFOAM-v*/ "$HOME"/OpenFOAM/OpenFOAM-v*/
    do
        dir=${dir%/}
        setup_check_openfoam "$dir" 2> /dev/null || continue
        api=$(setup_openfoam_api "$dir")
        if [ "$api" -gt "$best" ]; then
            best=$api
            found=$dir
        fi
    done
    echo "$found"
}

# Says which of them are of the Foundation, so that nobody wonders why they are not taken
setup_name_foundation()
{
    local dir version
    for dir in /opt/openfoam*/ /opt/OpenFOAM/OpenFOAM-*/ "$HOME"/OpenFOAM/OpenFOAM-*/; do
        version=$(setup_foundation_version "${dir%/}")
        if [ -n "$version" ]; then
            setup_say "${dir%/} is OpenFOAM $version of the Foundation (openfoam.org), which is another program: not taken"
        fi
    done
}

# -----------------------------------------------------------------------------
# Debian packages

# The python3 that can draw: not always the first on PATH
setup_find_python()
{
    local python
    while read -r python; do
        # Not where a case may have scripts named as modules
        if (cd / && "$python" -c 'import sys, importlib.util as u
sys.exit(any(u.find_spec(m) is None for m in ("numpy", "matplotlib", "vtkmodules")))' 2> /dev/null)
        then
            echo "$python"
            return
        fi
    done < <(type -ap python3; echo /usr/bin/python3)
}

setup_has_header()      # HEADER
{
    echo "#include <$1>" | gcc -E -include stdarg.h -include stddef.h \
        -include setjmp.h -include stdint.h - > /dev/null 2>&1
}

# Sanitizers and libFuzzer are in a package of their own
setup_has_clang_runtime()
{
    compgen -G "$(clang -print-resource-dir 2> /dev/null)/lib/*/libclang_rt.fuzzer*" > /dev/null
}

# Prints the Debian packages that are missing
setup_missing_packages()    # LEVEL OPENFOAM_DIR ('' for Debian's)
{
    command -v gcc > /dev/null || echo gcc
    command -v g++ > /dev/null || echo g++
    command -v make > /dev/null || echo make
    setup_has_header Random123/philox.h || echo librandom123-dev
    if [ -n "$2" ]; then
        command -v mpicc > /dev/null || echo libopenmpi-dev
    else
        [ -n "$(setup_debian_openfoam_version)" ] || echo openfoam
        [ -n "$(setup_debian_mpi)" ] || echo libopenmpi-dev
        command -v bzip2 > /dev/null || echo bzip2
    fi
    if [ "$1" != build ] && [ -z "$(setup_find_python)" ]; then
        echo python3-matplotlib python3-numpy python3-vtk9
    fi
    case $1 in
        test | full)
            setup_has_header cmocka.h || echo libcmocka-dev
            command -v pkg-config > /dev/null || echo pkgconf
            local module
            for module in h5py shapely ezdxf gdspy; do
                /usr/bin/python3 -c "import $module" 2> /dev/null || echo "python3-$module"
            done ;;
    esac
    if [ "$1" != full ]; then return; fi
    command -v clang > /dev/null || echo clang
    setup_has_clang_runtime || echo libclang-rt-dev
    command -v clang-format > /dev/null || echo clang-format
    command -v valgrind > /dev/null || echo valgrind
    command -v cppcheck > /dev/null || echo cppcheck
    command -v shellcheck > /dev/null || echo shellcheck
    command -v chromium > /dev/null || echo chromium
    setup_has_header sundials/sundials_config.h || echo libsundials-dev
}

# Turns what apt or tar wrote into a reason
setup_reason()      # LOG OFFSET: what was logged after the first OFFSET bytes counts
{
    local text
    text=$(tail -c "+$(($2 + 1))" "$1")
    case $text in
        *"No space left"* | *"enough free space"*)
            echo "the disk is full" ;;
        *"E: Failed to fetch"*" 404 "*)
            echo "the package registry answers, but lacks a file of them" ;;
        *"Could not resolve"* | *"Temporary failure"* | *"onnection"* | *"Could not connect"* | *"Failed to fetch"*)
            echo "the package registry cannot be reached" ;;
        *"Unable to locate package"* | *"Unable to find a source package"* | *"no installation candidate"*)
            echo "apt's sources offer no such package (is Debian's 'main' or Ubuntu's 'universe' among them?)" ;;
        *"Unable to acquire the dpkg"* | *"Could not get lock"*)
            echo "another program holds apt's lock" ;;
        *)  echo "the log tells why" ;;
    esac
}

# Whether apt's sources have PACKAGE in VERSION or a newer one
setup_is_offered()          # PACKAGE VERSION
{
    local candidate
    candidate=$(LC_ALL=C apt-cache policy "$1" | sed -n 's/^ *Candidate: //p')
    if ! dpkg --compare-versions "${candidate/(none)/0}" ge "$2"; then
        echo "E: Unable to locate package $1 in version $2 or newer, but ${candidate:-none}"
        return 1
    fi
}

setup_install_packages()    # LOG PACKAGE...
{
    local log=$1 offset start=$EPOCHREALTIME
    local -a sudo=()
    shift
    local by_hand="Install by hand, as root, then start again:"
    by_hand+=" apt-get update && apt-get install --no-install-recommends $*"

    if ! setup_has_apt; then
        setup_fail "missing: $*" \
            "Packages are installed for you by apt, which is not on this $(setup_system_name)." \
            "Install these (Debian's names), then start again."
        return
    fi
    if [ "$(id -u)" -ne 0 ]; then
        if ! command -v sudo > /dev/null; then
            setup_fail "missing: $*; you are not root and there is no sudo" "$by_hand"
            return
        fi
        # A password can be asked for on a terminal only
        sudo=(sudo -n)
        if [ -t 0 ]; then sudo=(sudo); fi
        if ! "${sudo[@]}" true; then
            setup_fail "missing: $*; sudo refuses" "$by_hand"
            return
        fi
    fi

    setup_say "installing Debian packages: $* (one to three minutes)"
    offset=$(stat -c %s "$log")
    local -a apt=("${sudo[@]}" env DEBIAN_FRONTEND=noninteractive LC_ALL=C apt-get -q -y
        -o Dpkg::Use-Pty=0 -o DPkg::Lock::Timeout=300)
    # Some unrelated source may fail to update: only the installation counts
    "${apt[@]}" update >> "$log" 2>&1
    if [[ " $* " = *" openfoam "* ]] && ! setup_is_offered openfoam 1912 >> "$log"; then
        setup_fail "no OpenFOAM found, and none to install: $(setup_reason "$log" "$offset")" \
            "Needed: Debian's package 'openfoam' in version 1912 or newer," \
            "or $setup_needed." "Log: $log"
        return
    fi
    if ! "${apt[@]}" install --no-install-recommends "$@" >> "$log" 2>&1; then
        setup_fail "cannot install packages: $(setup_reason "$log" "$offset")" \
            "$by_hand" "Log: $log"
        return
    fi
    setup_say "packages installed ($(setup_seconds_since "$start"))"
}

# -----------------------------------------------------------------------------
# OpenFOAM from Debian: binary packages, and headers and wmake from their source

# Source version of the installed packages; nothing if they are not installed, or too old
setup_debian_openfoam_version()
{
    local status version
    read -r status version < <(dpkg-query -W -f='${db:Status-Status} ${source:Version}\n' openfoam 2> /dev/null)
    if [ "$status" = installed ] && dpkg --compare-versions "$version" ge 1912; then echo "$version"; fi
}

# Folder of the MPI with headers; nothing if it is not installed
setup_debian_mpi() { dpkg-query -L libopenmpi-dev 2> /dev/null | grep -m 1 '/openmpi$'; }

# A private set of apt sources: the machine's own, each asked for source packages
setup_write_source_lists()  # FOLDER
{
    local list parts file
    eval "$(apt-config shell list Dir::Etc::sourcelist/f parts Dir::Etc::sourceparts/d)"
    for file in "$list" "${parts%/}"/*.list; do
        [ -f "$file" ] || continue
        # Install media hold no sources
        sed -n '/cdrom:/d; s/^ *deb\(-src\)\{0,1\} /deb-src /p' "$file"
    done | sort -u > "$1/all.list"
    for file in "${parts%/}"/*.sources; do
        [ -f "$file" ] || continue
        sed 's/^Types:.*/Types: deb-src/I' "$file"
        echo
    done > "$1/all.sources"
}

# What it prints is for the log
setup_build_tree()      # WORK VERSION: WORK/tree becomes a tree that wmake can use
{
    local work=$1 version=$2 package path name lib bin links
    mkdir -p "$work"/{sources,lists/partial,archives/partial,download,tree} || return
    setup_write_source_lists "$work/sources" || return
    local -a apt=(env LC_ALL=C apt-get -q -o APT::Sandbox::User="$(id -un)"
        -o Dir::Etc::sourcelist=/dev/null -o Dir::Etc::sourceparts="$work/sources"
        -o Dir::State::lists="$work/lists" -o Dir::Cache="$work")
    # Where the disk is full, apt's own retries may never end
    local -a update=("${apt[@]}" -o Acquire::Retries=0 update)
    "${update[@]}" || "${update[@]}"
    # Of the package's files only this one is needed, and no dpkg-source to unpack it
    (cd "$work/download" && "${apt[@]}" source --tar-only --only-source "openfoam=$version") || return

    tar -xf "$work"/download/openfoam_*.orig.tar.* -C "$work/tree" --strip-components=1 \
        --exclude='*/tutorials' --exclude='*/doc' || return
    rm -rf "$work"/{sources,lists,archives,download}

    # gcc 14 and newer would say it of these headers with every file
    echo 'c++WARN += -Wno-template-id-cdtor' >> "$work/tree/wmake/rules/General/Gcc/c++" || return
    # Settings would ask mpicc for it, which may be another MPI's
    echo "export MPI_ARCH_PATH=$(setup_debian_mpi)" > "$work/tree/etc/config.sh/openmpi-system" || return

    (
        setup_source_bashrc "$work/tree"
        make -C "$WM_PROJECT_DIR/wmake/src" || exit
        cd "$WM_PROJECT_DIR" || exit
        # It always claims success; links that are there already are no failure
        links=$(LC_ALL=C wmakeLnIncludeAll src 2>&1)
        echo "$links"
        if grep -E '(ln|mkdir): .*(No space|quota|denied)' <<< "$links"; then exit 1; fi
        lib=platforms/$WM_OPTIONS/lib
        bin=platforms/$WM_OPTIONS/bin
        mkdir -p "$lib"/{dummy,openmpi-system} "$bin" || exit
        for package in openfoam libopenfoam; do
            while read -r path; do
                name=${path#/usr/lib/}
                case $path in
                    /usr/bin/*) ln -s "$path" "$bin/" || exit ;;
                    /usr/lib/*.so | /usr/lib/*.o) ln -s "$path" "$lib/$name" || exit ;;
                esac
            done < <(dpkg-query -L "$package")
        done
        [ -e src/finiteVolume/lnInclude/fvCFD.H ] || exit
        setup_starts_functions "$work" \
            || setup_mend_digest "$work" "$(realpath "$lib/libOpenFOAM.so")"
    )
}

setup_compile()         # ARGUMENT...: against the library OpenFOAM
{
    local -a compile
    read -r -a compile < <(wmake -show-compile-cxx)
    "${compile[@]}" -I"$WM_PROJECT_DIR"/src/{OpenFOAM,OSspecific/POSIX}/lnInclude "$@"
}

# Whether a function object starts, even one that is off
setup_starts_functions()    # WORK
{
    setup_compile -x c++ - -x none -o "$1/functions" -L"$FOAM_LIBBIN" -lOpenFOAM << 'END' && "$1/functions"
#include "IStringStream.H"
#include "Time.H"
int main()
{
    Foam::IStringStream text("deltaT 1; writeFrequency 1; functions { any { enabled no; } }");
    Foam::Time time(Foam::dictionary(text), ".", ".");
    time.functionObjects().start();
}
END
}

# A library OpenFOAM that has our digest() and leaves all else to LIBRARY. It is where programs look
# first, by OpenFOAM's settings, and the linker does not.
setup_mend_digest()     # WORK LIBRARY
{
    setup_say "$2 fails in every function object"
    setup_compile -shared -Wl,--no-as-needed -o "$FOAM_LIBBIN/$FOAM_MPI/libOpenFOAM.so" \
        "$setup_folder/dictionaryDigest.C" "$2" && setup_starts_functions "$1"
}

# A tree is moved in place when complete; its links die with the packages they lead to
setup_is_tree()         # DIR
{
    local -a program=("$1"/platforms/*/bin/blockMesh)
    [ -x "${program[0]}" ]
}

setup_debian_openfoam()     # CACHE VERSION LOG: makes CACHE/openfoam-VERSION unless it is there
(
    cache=$1 version=$2 log=$3 start=$EPOCHREALTIME
    tree=$cache/openfoam-$version
    if setup_is_tree "$tree"; then exit 0; fi

    exec 9> "$cache/lock" && flock 9 || exit
    if setup_is_tree "$tree"; then exit 0; fi
    # Only a set-up that was killed leaves these: the lock keeps living ones out
    rm -rf "$cache"/unpacking.* "$tree"

    setup_say "fetching OpenFOAM's headers and wmake (45 MB) and unpacking them (about half a minute)"
    offset=$(stat -c %s "$log")
    work=
    trap 'rm -rf "$work"' EXIT
    trap 'exit 130' INT
    trap 'exit 143' TERM HUP
    if work=$(mktemp -d "$cache/unpacking.XXXXXX" 2>> "$log") \
        && setup_build_tree "$work" "$version" >> "$log" 2>&1 \
        && mv -T "$work/tree" "$tree" 2>> "$log"
    then
        if compgen -G "$tree/platforms/*/lib/*/libOpenFOAM.so" > /dev/null; then
            setup_say "this package's OpenFOAM stops in every function object ('error in IOstream \"sha1\"'): it is" \
                "older than the gcc that built it. In this environment a library of ours mends it" \
                "(Make/dictionaryDigest.C). Newer versions of OpenFOAM do not have this fault."
        fi
        setup_say "OpenFOAM's headers and wmake are in $tree ($(setup_seconds_since "$start"))"
    else
        rm -rf "$work"
        setup_fail "cannot fetch or unpack OpenFOAM's source package: $(setup_reason "$log" "$offset")" \
            "Needed: the network, 250 MB free in $cache (ELLIPSOID_CACHE names another folder)," \
            "and the source package of version $version among apt's sources;" \
            "if they have another one: apt-get install openfoam. Or $setup_needed." \
            "Log: $log"
        exit 1
    fi
)

# -----------------------------------------------------------------------------

# OpenFOAM's bashrc reads unset variables, and takes a caller's arguments for settings
setup_source_bashrc()   # DIR
{
    local options dir=$1
    options=$(set +o)
    set +eu
    set --
    export USER=${USER:-$(id -un)}
    . "$dir/etc/bashrc"
    eval "$options"
}

setup_environment()     # build|run|test|full
{
    local level=$1 cache log dir start=$EPOCHREALTIME version
    local -a packages
    cache=$(setup_cache_folder)
    log=$cache/setup.log
    export ELLIPSOID_CACHE=$cache

    if ! mkdir -p "$cache" 2> /dev/null || ! : 2> /dev/null > "$log"; then
        setup_fail "cannot write in $cache: is the disk full, or the folder another user's?" \
            "ELLIPSOID_CACHE names another folder."
        return
    fi

    # Within the environment of a set-up done before, the tree is looked for anew
    case $WM_PROJECT_DIR in "$cache"/*) unset WM_PROJECT_DIR ;; esac

    dir=$WM_PROJECT_DIR
    if [ -n "$dir" ]; then
        setup_check_openfoam "$dir" || return
    else
        dir=$(setup_search_openfoam)
        if [ -z "$dir" ]; then setup_name_foundation; fi
    fi
    if [ -z "$dir" ] && ! setup_has_apt; then
        setup_fail "no OpenFOAM found, and this $(setup_system_name) has no apt to install Debian's" \
            "Needed: $setup_needed;" \
            "also gcc, g++, make, an MPI and Random123;" \
            "for pictures Python 3 with numpy, matplotlib and vtk; for tests cmocka, h5py, pkg-config, shapely, ezdxf and gdspy;" \
            "for all tests (--full) clang with compiler-rt, clang-format, valgrind, cppcheck, shellcheck, chromium, SUNDIALS."
        return
    fi

    read -r -d '' -a packages < <(setup_missing_packages "$level" "$dir")
    if [ "${#packages[@]}" -gt 0 ]; then
        setup_install_packages "$log" "${packages[@]}" || return
        read -r -d '' -a packages < <(setup_missing_packages "$level" "$dir")
        if [ "${#packages[@]}" -gt 0 ]; then
            setup_fail "installed, but not found on PATH: what ${packages[*]} should bring"
            return
        fi
    fi
    if [ -z "$dir" ]; then
        version=$(setup_debian_openfoam_version)
        setup_debian_openfoam "$cache" "$version" "$log" || return
        dir=$cache/openfoam-$version
    fi

    # An environment that is complete may hold settings of the user's: keep it
    if [ -z "$WM_PROJECT_DIR" ] || [ -z "$WM_OPTIONS" ]; then setup_source_bashrc "$dir"; fi
    if [ "${WM_PRECISION_OPTION:-DP}" != DP ]; then
        setup_fail "$dir computes in single precision (WM_PRECISION_OPTION is $WM_PRECISION_OPTION)" \
            "Needed: double precision, DP, as packages have it."
        return
    fi
    export WM_NCOMPPROCS=${WM_NCOMPPROCS:-$(nproc)}
    # As many ranks as a case asks for
    export OMPI_MCA_rmaps_base_oversubscribe=${OMPI_MCA_rmaps_base_oversubscribe:-1}
    # Open MPI asks root twice; a container's only user is often root
    if [ "$(id -u)" -eq 0 ]; then
        export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
    fi
    if [ "$level" != build ]; then
        ELLIPSOID_PYTHON=$(setup_find_python)
        export ELLIPSOID_PYTHON
        # makePictures, sweep and the others
        case $PATH: in "${setup_folder%/*}"/python/bin:*) ;; *) export PATH=${setup_folder%/*}/python/bin:$PATH ;; esac
    fi
    setup_say "OpenFOAM v$(setup_openfoam_api "$dir") in $dir ($(setup_seconds_since "$start"))"
}
