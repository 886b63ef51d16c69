# SPDX-License-Identifier: MIT
# pyserial and rich for tools/uss and tools/example --port, in a virtual environment in build/uss.
# To be sourced after folder.sh, packages.sh and pytest.sh, which knows how such environments are
# made.

uss_requirements=$top/tools/uss_command/requirements.txt

get_uss() {
    has_python || return
    fill uss has_uss make_uss
}

has_uss() {
    cmp -s "$uss_requirements" "$1/requirements.txt" &&
        "$1/bin/python" -c 'import rich, serial' 2>/dev/null
}

make_uss() {
    local folder=$1 requirements=$uss_requirements
    say "pyserial and rich: installing them into build/uss"
    make_environment "$folder" &&
        quietly "$folder/log" install_requirements "$folder" &&
        cp "$uss_requirements" "$folder/requirements.txt"
}

# What to do when there are none. $1 is the command to be tried again.
no_uss() {
    not_installed "$1" "pyserial and rich"
}
