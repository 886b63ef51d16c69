# SPDX-License-Identifier: MIT
# For tools/panel --web: aiohttp in a virtual environment in build/server; for the page without a
# server, MicroPython as WebAssembly in build/page. To be sourced after folder.sh, packages.sh,
# pytest.sh and node.sh.

web_sources=$top/tools/web

get_server() {
    has_python || return
    fill server has_server make_server
}

# It is looked for, and not loaded: every start of the panel would wait for that.
has_server() {
    cmp -s "$web_sources/requirements.txt" "$1/requirements.txt" &&
        "$1/bin/python" -c 'import importlib.util, sys
sys.exit(importlib.util.find_spec("aiohttp") is None)' 2>/dev/null
}

make_server() {
    local folder=$1 requirements=$web_sources/requirements.txt
    say "aiohttp: installing it into build/server"
    make_environment "$folder" &&
        quietly "$folder/log" install_requirements "$folder" &&
        cp "$requirements" "$folder/requirements.txt"
}

get_page() {
    get_node || return
    fill page has_page make_page
}

has_page() {
    cmp -s "$web_sources/package-lock.json" "$1/package-lock.json" && [[ -d $1/node_modules ]]
}

make_page() {
    local folder=$1
    say "MicroPython for the browser: fetching it into build/page"
    cp "$web_sources"/{package.json,package-lock.json,.npmrc} "$folder" &&
        quietly "$folder/log" install_page "$folder"
}

install_page() (
    cd "$1" && PATH=$build/node:$PATH npm ci --ignore-scripts --no-audit --no-fund
)

# What to do when there is none. $1 is the command to be tried again.
no_server() {
    if ! has_python; then
        say "$1: wants Python 3.11 or newer as python3:  apt-get install python3 python3-venv"
    else
        say "$1: aiohttp could not be installed (see above)."
        say "  It comes over the network with pip:  apt-get install python3-venv ca-certificates"
    fi
}

no_page() {
    say "$1: MicroPython for the browser could not be fetched (see above)."
    say "  It comes over the network with npm:  apt-get install nodejs npm"
}
