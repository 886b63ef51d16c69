# SPDX-License-Identifier: MIT
# Textual, which draws the live panel in a terminal, in a virtual environment in build/textual. To
# be sourced after folder.sh, packages.sh and pytest.sh, which knows how such environments are made.

textual_requirements=$top/tools/terminal/requirements.txt

get_textual() {
    has_python || return
    fill textual has_textual make_textual
}

# It is looked for, and not loaded: every start of the panel would wait for that.
has_textual() {
    cmp -s "$textual_requirements" "$1/requirements.txt" &&
        "$1/bin/python" -c 'import importlib.util, sys
sys.exit(importlib.util.find_spec("textual") is None)' 2>/dev/null
}

make_textual() {
    local folder=$1 requirements=$textual_requirements
    say "Textual: installing it into build/textual, 49 MB"
    make_environment "$folder" &&
        quietly "$folder/log" install_requirements "$folder" &&
        cp "$textual_requirements" "$folder/requirements.txt"
}

# What to do when there is none. $1 is the command to be tried again.
no_textual() {
    if ! has_python; then
        say "$1: wants Python 3.11 or newer as python3:  apt-get install python3 python3-venv"
    else
        say "$1: Textual could not be installed (see above)."
        say "  It comes over the network with pip:  apt-get install python3-venv ca-certificates"
        say "  Scripts work without it:  $1 --script FILE"
    fi
}
