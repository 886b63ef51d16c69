# SPDX-License-Identifier: MIT
# cosmic-ray, whose operators make the mutants of tools/mutants, in build/mutating. To be sourced
# after folder.sh, packages.sh and pytest.sh.
#
# Only its operators are used: what else it asks for, a database and a client of the web among it,
# stays away.

mutating_requirements=$top/tools/mutating/requirements.txt

get_mutating() {
    get_pytest || return                             # for its pip
    fill mutating has_mutating make_mutating
}

has_mutating() {
    cmp -s "$mutating_requirements" "$1/requirements.txt" && [[ -d $1/cosmic_ray/operators ]]
}

make_mutating() {
    local folder=$1
    say "cosmic-ray: installing it into build/mutating"
    quietly "$folder/log" install_mutating "$folder" &&
        cp "$mutating_requirements" "$folder/requirements.txt"
}

install_mutating() {
    PYTHONPATH=$build/pytest/pip "$build/pytest/bin/python" -m pip install \
        --disable-pip-version-check --no-deps --no-compile --target "$1" \
        -r "$mutating_requirements"
}

# What to do when it is not there. $1 is the command to be tried again.
no_mutating() {
    not_installed "$1" "cosmic-ray"
}
