# SPDX-License-Identifier: MIT
# For the tests of the page: playwright-core, which drives the Chromium that is installed, and
# axe-core, in build/browser. To be sourced after folder.sh, packages.sh, pytest.sh and node.sh.

browser_sources=$top/host_tests/web

get_browser() {
    get_node || return
    fill browser has_browser make_browser
}

has_browser() {
    cmp -s "$browser_sources/package-lock.json" "$1/package-lock.json" && [[ -d $1/node_modules ]]
}

make_browser() {
    local folder=$1
    say "playwright-core and axe-core: fetching them into build/browser"
    cp "$browser_sources"/{package.json,package-lock.json,.npmrc} "$folder" &&
        quietly "$folder/log" install_browser "$folder"
}

install_browser() (
    cd "$1" && PATH=$build/node:$PATH npm ci --ignore-scripts --no-audit --no-fund
)
