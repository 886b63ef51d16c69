# SPDX-License-Identifier: MIT
# Other people's protocol libraries, which tools/bench measures ours beside, in a virtual environment
# in build/libraries. To be sourced after folder.sh, packages.sh and pytest.sh, which knows how such
# environments are made.

libraries_requirements=$top/tools/benching/requirements.txt

get_libraries() {
    has_python || return
    fill libraries has_libraries make_libraries
}

# Whole when it was made for these requirements, and they are found in it; not when the machine has
# got another Python since.
has_libraries() {
    cmp -s "$libraries_requirements" "$1/requirements.txt" &&
        "$1/bin/python" -c 'import turboctl, minimalmodbus, pymodbus, umodbus' 2>/dev/null
}

make_libraries() {
    local folder=$1 requirements=$libraries_requirements
    say "turboctl, minimalmodbus, pymodbus, umodbus: installing them into build/libraries"
    make_environment "$folder" &&
        quietly "$folder/log" install_requirements "$folder" &&
        cp "$requirements" "$folder/requirements.txt"
}

# What to do when they are not there. $1 is the command to be tried again.
no_libraries() {
    not_installed "$1" "the libraries to compare with"
}
