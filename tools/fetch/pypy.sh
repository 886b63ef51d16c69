# SPDX-License-Identifier: MIT
# PyPy, the fastest interpreter for what runs long in virtual time: build/pypy/pypy3.
# To be sourced after folder.sh and packages.sh.
#
# A link to what is installed, or a script that starts unpacked packages. Nobody needs it: whoever
# wants it does without where it is not to be had.

pypy_oldest='3, 9'

# get_pypy: sees to it that it is there. Returns 1, having said why, when it is not to be had.
get_pypy() {
    fill pypy has_pypy make_pypy
}

has_pypy() {
    [[ -x $1/pypy3 ]]
}

# It is asked itself, as MicroPython is.
pypy_works() {
    [[ $(within 20 "$1" -c "
import sys
print(sys.implementation.name, sys.version_info >= ($pypy_oldest))
" </dev/null 2>/dev/null) == 'pypy True' ]]
}

make_pypy() {
    local folder=$1 way started=$SECONDS
    for way in link_pypy unpack_pypy; do
        "$way" "$folder" && pypy_works "$folder/pypy3" &&
            say "    ready in build/pypy after $((SECONDS - started)) s" && return
        rm -rf "${folder:?}"/*
    done
    return 1
}

link_pypy() {
    local installed
    installed=$(type -P pypy3) || return
    say "PyPy: using $installed"
    ln -s "$(readlink -f "$installed")" "$1/pypy3"
}

# Of the libraries that it asks for some are nobody's who soaks, but it does not start without.
unpack_pypy() {
    local folder=$1 release view=$1/view libraries
    type -P apt-get dpkg-deb >/dev/null || return
    for release in $(releases); do
        say "PyPy: fetching it, packages of $release, about 20 MB"
        packages_open "$view" deb "$release"
        libraries=$(packages_dependencies "$view" pypy3)
        # shellcheck disable=SC2086  # one word a package
        packages_unpack "$view" "$folder" pypy3 $libraries && rm -rf "$view" &&
            packages_starter "$folder" pypy3 && return
        rm -rf "${folder:?}"/*
    done
    return 1
}
