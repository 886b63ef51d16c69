# SPDX-License-Identifier: MIT
# pytest, in a virtual environment in build/pytest. To be sourced after folder.sh and packages.sh.

requirements=$top/host_tests/requirements.txt

get_pytest() {
    has_python || return
    fill pytest has_pytest make_pytest
}

# The environment is whole when it was made for these requirements and pytest is found in it; it is
# not when the machine has got another Python since.
has_pytest() {
    cmp -s "$requirements" "$1/requirements.txt" && "$1/bin/python" -c 'import pytest' 2>/dev/null
}

make_pytest() {
    local folder=$1
    say "pytest: installing it into build/pytest"
    make_environment "$folder" &&
        quietly "$folder/log" install_requirements "$folder" &&
        cp "$requirements" "$folder/requirements.txt"
}

# Debian leaves pip out of python3 (it comes with python3-venv). Then its package is unpacked, and
# pip is run from there.
make_environment() {
    local folder=$1
    python3 -m venv "$folder" >/dev/null 2>&1 && return
    say "    this python3 comes without pip, fetching that"
    python3 -m venv --clear --without-pip "$folder" && unpack_pip "$folder"
}

install_requirements() {
    PYTHONPATH=$1/pip "$1/bin/python" -m pip install \
        --disable-pip-version-check -r "$requirements"
}

unpack_pip() {
    local folder=$1 view=$1/view release
    type -P apt-get dpkg-deb >/dev/null || return
    for release in $(releases); do
        packages_open "$view" deb "$release"
        packages_unpack "$view" "$view/unpacked" python3-pip-whl &&
            python3 -m zipfile -e "$view"/unpacked/usr/share/python-wheels/pip-*.whl "$folder/pip" &&
            rm -rf "$view" && return
        rm -rf "$view"
    done
    return 1
}

# What to do when there is no pytest. $1 is the command to be tried again.
no_pytest() {
    not_installed "$1" pytest
}

# not_installed COMMAND WHAT: the same of anything that stands in an environment.
not_installed() {
    if ! has_python; then
        wants_python "$1"
    else
        say "$1: $2 could not be installed (see above). It comes over the network with pip:"
        say "  $(how_to_get 'python3-venv ca-certificates' python python python3-pip)"
    fi
}

wants_python() {
    say "$1: wants Python 3.11 or newer as python3:"
    say "  $(how_to_get 'python3 python3-venv' python python python3)"
}
