# SPDX-License-Identifier: MIT
# What each command begins with. To be sourced, with $top set to the top of the tree, before
# anything else of this folder.

# One number, that of firmware/version.py.
panel_version() {
    sed -n 's/^VERSION = "\(.*\)"$/\1/p' "$top/firmware/version.py"
}

# A command that was called with --version alone answers and ends here, and fetches nothing for it.
if [[ $# == 1 && $1 == --version ]]; then
    echo "USS panel $(panel_version)"
    exit
fi

# For Python: what it compiles is kept in build/, once that is there, and never beside the sources.
caches=(-B)
if [[ -d $top/build ]]; then
    caches=(-X "pycache_prefix=$top/build/pycache")
fi
