# SPDX-License-Identifier: MIT
# The Unix port of MicroPython, in the builds that the panel and the tests run on.
# To be sourced after folder.sh and packages.sh.
#
#   unix64     the one people use: 1.25 or newer, installed, or fetched
#   unix32     small integers of 31 bits, as on the microcontrollers
#   packaged   that of Debian, for the test that it runs the panel, where unix64 is built here
#
# Each lands in build/NAME/micropython: a link to what is installed, a script that starts unpacked
# packages, or a program built here.

oldest=1.25

# get_micropython NAME: sees to it that build/NAME/micropython is there. Returns 1, having said
# why, when none of the ways leads to one.
get_micropython() {
    fill "$1" has_micropython make_micropython "$1"
}

# A link whose target was uninstalled is not executable, and so is replaced.
has_micropython() {
    [[ -x $1/micropython ]]
}

make_micropython() {
    local name=$1 folder=$2 way started=$SECONDS
    for way in $(ways_to "$name"); do
        if "$way" "$name" "$folder"; then
            if works "$folder/micropython"; then
                say "    ready in build/$name after $((SECONDS - started)) s"
                return
            fi
            say "    it does not run on this machine"
        fi
        rm -rf "${folder:?}"/*
    done
    return 1
}

# What is built here takes two thirds of the time, but building takes a minute or two. That is for
# those who run all tests, and not for those who want to see the panel.
builds_unix64=

ways_to() {
    case $1 in
        unix64) echo link_installed ${builds_unix64:+build_from_source} unpack_packages \
            build_from_source ;;
        unix32) echo build_from_source unpack_packages ;;
        packaged) echo unpack_packages ;;
    esac
}

# Whether a program is MicroPython and new enough: it is asked itself, since it knows best. The
# limit in time is for a program of that name that is something else and waits.
works() {
    [[ $(within 10 "$1" -c "
import sys
name, version = sys.implementation[0], sys.implementation[1]
print(name, tuple(version[:2]) >= (${oldest/./, }))
" </dev/null 2>/dev/null) == 'micropython True' ]]
}

# What to do when there is no way. $1 is the command to be tried again.
no_micropython() {
    say "$1: no MicroPython $oldest or newer is here, and none could be fetched (see above)."
    say "One of these helps:"
    say "  - install it, so that 'micropython' is on the PATH:"
    say "    $(how_to_get micropython micropython micropython micropython)"
    say "    (Debian has it from 13 on, Ubuntu from 25.10 on);"
    say "  - on Debian or Ubuntu, see that 'apt-get update' reaches its mirror, and run $1 again;"
    say "  - where that has no package for this machine, have it built:"
    say "    apt-get install gcc libc6-dev make python3"
}

# ---- what is installed ----------------------------------------------------------------------

link_installed() {
    local folder=$2 installed
    installed=$(type -P micropython) || return
    [[ $installed == /* ]] || installed=$PWD/$installed
    if ! works "$installed"; then
        say "MicroPython: $installed is not MicroPython $oldest or newer, passed over"
        return 1
    fi
    say "MicroPython: using $installed"
    ln -s "$installed" "$folder/micropython"
}

# ---- Debian's packages, run through their own loader and libraries --------------------------

unpack_packages() {
    local name=$1 folder=$2 release architecture view=$2/view
    type -P apt-get dpkg-deb >/dev/null || return
    architecture=$(architecture_of "$name") || return
    for release in $(releases); do
        say "MicroPython $name: looking into the packages of $release ($architecture)"
        packages_open "$view" deb "$release" "$architecture"
        unpack_from_view "$view" "$folder" && rm -rf "$view" && return
        rm -rf "$view"
    done
    return 1
}

# The architecture of the packages for a build, in Debian's words.
architecture_of() {
    case $1.$(dpkg --print-architecture) in
        unix64.* | packaged.*) dpkg --print-architecture ;;
        unix32.amd64) echo i386 ;;
        unix32.arm64) echo armhf ;;
        unix32.i386 | unix32.armhf) dpkg --print-architecture ;;
        *) return 1 ;;
    esac
}

unpack_from_view() {
    local view=$1 folder=$2
    offered "$view" || return
    local libraries
    libraries=$(packages_dependencies "$view" micropython)
    # shellcheck disable=SC2086  # one word a package
    packages_unpack "$view" "$folder" micropython $libraries &&
        packages_starter "$folder" micropython
}

# Whether the view offers a MicroPython that is new enough; says which.
offered() {
    local view=$1 version
    version=$(packages_version "$view" micropython)
    if [[ -z $version ]]; then
        say "    no MicroPython there"
        grep -m 1 -E '^[EW]:' "$view/log" | sed 's/^/    /' >&2 || true
        return 1
    fi
    if ! dpkg --compare-versions "$version" ge "$oldest"; then
        say "    only MicroPython $version there"
        return 1
    fi
    say "    taking MicroPython $version"
}

# ---- built here from the source package -----------------------------------------------------

build_from_source() {
    local name=$1 folder=$2 release view=$2/view
    can_build "$name" && type -P apt-get dpkg >/dev/null || return
    for release in $(releases); do
        say "MicroPython $name: looking into the sources of $release"
        packages_open "$view" deb-src "$release"
        unpack_source "$view" && compile "$name" "$view" "$folder" && rm -rf "$view" && return
        rm -rf "$view"
    done
    return 1
}

# A compiler that finds its headers, for the word size in question; make; and python3, which the
# build itself uses.
can_build() {
    type -P cc make python3 >/dev/null || return
    # shellcheck disable=SC2046  # no word or one
    echo '#include <stdio.h>' | cc $(word_size "$1") -xc -fsyntax-only - 2>/dev/null
}

word_size() {
    [[ $1 == unix32 ]] && echo -m32
    return 0
}

unpack_source() {
    local view=$1
    offered "$view" &&
        packages_download "$view" source micropython &&
        mkdir "$view/source" &&
        unpack_tar "$view"/downloads/micropython_*.orig.tar.xz "$view/source"
}

compile() {
    local name=$1 port=$2/source/ports/unix folder=$3
    say "    compiling it"
    keep_frames_on_stack "$2/source/py/objfun.c"
    quietly "$2/log" build_port "$name" "$port" &&
        mv "$port/build-$name/micropython" "$folder/micropython"
}

# MicroPython takes the frame of a function with more than 11 words from the heap. Where much lies
# there, as with 31 drives, looking for free blocks took 40 % of a test's time.
keep_frames_on_stack() {
    sed -i 's/\(VM_MAX_STATE_ON_STACK (sizeof(mp_uint_t) \*\) 11)/\1 40)/' "$1"
}

# Twice where the compiler can: what first notes what it does most while it simulates a panel is
# then built to do that fast.
build_port() {
    local name=$1 port=$2
    if learns; then
        make_port "$name" "$port" -fprofile-generate &&
            simulate "$port/build-$name/micropython" &&
            compile_anew "$port/build-$name" &&
            make_port "$name" "$port" "${as_learnt[@]}" && return
        rm -rf "$port/build-$name"
    fi
    make_port "$name" "$port"
}

as_learnt=(-flto=auto -fprofile-use -fprofile-partial-training -Wno-missing-profile)

learns() {
    cc -fprofile-generate "${as_learnt[@]}" -xc -fsyntax-only /dev/null
}

simulate() {
    local each
    for each in simulation codec; do
        (cd "$top" && within 120 "$1" -X heapsize=16M tools/benching/measurements.py quick "$each") ||
            return
    done
}

compile_anew() {
    find "$1" -name '*.o' -delete && rm "$1/micropython"
}

# Nothing is frozen in, so that no cross compiler has to be built first; and what the panel does
# not use is left out, so that a C library is all that has to be installed. Built for speed, at a
# fixed address and with a place for each name in the cache of look-ups, the tests take less time
# on it. Both builds round numbers with a fraction alike: x87, which is usual with 32 bits, keeps
# more digits than SSE. git may not look above build/, or it would take the version of this tree for
# that of MicroPython.
make_port() {
    local name=$1 port=$2 flags="-O2 -fno-gcse ${*:3}" settings
    [[ $name == unix32 && $(uname -m) == x86_64 ]] && flags+=" -msse2 -mfpmath=sse"
    settings=(
        FROZEN_MANIFEST= MICROPY_PY_THREAD=0 MICROPY_PY_FFI=0 MICROPY_PY_BTREE=0
        MICROPY_PY_SSL=0 MICROPY_SSL_MBEDTLS=0
        "COPT=$flags -DNDEBUG" "LDFLAGS_EXTRA=-no-pie $flags"
        "CFLAGS_EXTRA=-Wno-error -fno-pie -DMICROPY_OPT_MAP_LOOKUP_CACHE_SIZE=8192"
    )
    [[ $name == unix32 ]] && settings+=(MICROPY_FORCE_32BIT=1)
    GIT_CEILING_DIRECTORIES=$build make -C "$port" -j"$(nproc)" \
        "BUILD=build-$name" "${settings[@]}"
}
