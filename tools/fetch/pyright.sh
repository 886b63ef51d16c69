# SPDX-License-Identifier: MIT
# pyright and the stubs of the port, in build/pyright. To be sourced after folder.sh, packages.sh,
# pytest.sh and node.sh.
#
# Nothing of it is run by Python: both are unpacked into one folder, where node finds pyright and
# pyright finds the stubs.

pyright_requirements=$top/tools/fetch/pyright_requirements.txt

get_pyright() {
    get_node || return
    get_pytest || return                             # for its pip
    fill pyright has_pyright make_pyright
}

has_pyright() {
    cmp -s "$pyright_requirements" "$1/requirements.txt" && [[ -f $1/pyright/dist/index.js ]]
}

make_pyright() {
    local folder=$1
    say "pyright: fetching it into build/pyright"
    quietly "$folder/log" unpack_pyright "$folder" &&
        cp "$pyright_requirements" "$folder/requirements.txt"
}

unpack_pyright() {
    PYTHONPATH=$build/pytest/pip "$build/pytest/bin/python" -m pip install \
        --disable-pip-version-check --no-deps --no-compile --only-binary=:all: --target "$1" \
        -r "$pyright_requirements"
}
