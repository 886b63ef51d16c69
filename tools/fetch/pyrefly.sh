# SPDX-License-Identifier: MIT
# pyrefly and the stubs of the ports, in build/pyrefly. To be sourced after folder.sh, packages.sh
# and pytest.sh.
#
# Nothing of it is run by Python: all is unpacked into one folder, where pyrefly finds the stubs.

pyrefly_requirements=$top/tools/fetch/pyrefly_requirements.txt
pyrefly_esp32_requirements=$top/tools/fetch/pyrefly_esp32_requirements.txt

get_pyrefly() {
    get_pytest || return                             # for its pip
    fill pyrefly has_pyrefly make_pyrefly
}

has_pyrefly() {
    pyrefly_made_of | cmp -s - "$1/requirements.txt" && [[ -x $1/bin/pyrefly ]]
}

make_pyrefly() {
    local folder=$1
    say "pyrefly: fetching it into build/pyrefly"
    quietly "$folder/log" unpack_pyrefly "$folder" &&
        pyrefly_made_of >"$folder/requirements.txt"
}

pyrefly_made_of() {
    cat "$pyrefly_requirements" "$pyrefly_esp32_requirements"
}

unpack_pyrefly() {
    install_unpacked "$1" "$pyrefly_requirements" &&
        install_unpacked "$1/esp32" "$pyrefly_esp32_requirements"
}

install_unpacked() {
    PYTHONPATH=$build/pytest/pip "$build/pytest/bin/python" -m pip install \
        --disable-pip-version-check --no-deps --no-compile --only-binary=:all: --target "$1" \
        -r "$2"
}
