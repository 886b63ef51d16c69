# SPDX-License-Identifier: MIT
# pyright and the stubs of the ports, in build/pyright. To be sourced after folder.sh, packages.sh,
# pytest.sh and node.sh.
#
# Nothing of it is run by Python: both are unpacked into one folder, where node finds pyright and
# pyright finds the stubs.

pyright_requirements=$top/tools/fetch/pyright_requirements.txt
pyright_esp32_requirements=$top/tools/fetch/pyright_esp32_requirements.txt

get_pyright() {
    get_node || return
    get_pytest || return                             # for its pip
    fill pyright has_pyright make_pyright
}

has_pyright() {
    pyright_made_of | cmp -s - "$1/requirements.txt" && [[ -f $1/pyright/dist/index.js ]]
}

make_pyright() {
    local folder=$1
    say "pyright: fetching it into build/pyright"
    quietly "$folder/log" unpack_pyright "$folder" &&
        pyright_made_of >"$folder/requirements.txt"
}

pyright_made_of() {
    cat "$pyright_requirements" "$pyright_esp32_requirements"
}

unpack_pyright() {
    install_unpacked "$1" "$pyright_requirements" &&
        install_unpacked "$1/esp32" "$pyright_esp32_requirements"
}

install_unpacked() {
    PYTHONPATH=$build/pytest/pip "$build/pytest/bin/python" -m pip install \
        --disable-pip-version-check --no-deps --no-compile --only-binary=:all: --target "$1" \
        -r "$2"
}
