# SPDX-License-Identifier: MIT
# The version of the panel: one number, that of firmware/version.py. To be sourced, with $top set to
# the top of the tree, before anything else of this folder: a command that was called with
# --version alone answers and ends here, and fetches nothing for it.

panel_version() {
    sed -n 's/^VERSION = "\(.*\)"$/\1/p' "$top/firmware/version.py"
}

if [[ $# == 1 && $1 == --version ]]; then
    echo "USS panel $(panel_version)"
    exit
fi
