# SPDX-License-Identifier: MIT
# build/, the one folder that tools/fetch fills. To be sourced, with $top set to the top of the
# tree.
#
# Each subfolder of build/ is made aside and then renamed, so that it is either absent or whole,
# and under a lock, so that two runs at once do not disturb each other. Deleting build/, or any
# subfolder of it, is always safe: the next run makes it again.

build=$top/build

# One line of progress, on stderr: stdout belongs to the program that is being started.
say() {
    printf '%s\n' "$*" >&2
}

# quietly LOG COMMAND...
#   Runs the command with its output in LOG; when it fails, shows what it said last.
quietly() {
    local log=$1
    shift
    "$@" >"$log" 2>&1 && return
    say "    that failed:"
    tail -n 8 "$log" | sed 's/^/    /' >&2
    return 1
}

# fill NAME IS_WHOLE MAKE...
#   Sees to it that build/NAME is whole. `IS_WHOLE FOLDER` judges; `MAKE... FOLDER` makes it in an
#   empty folder. Returns 0 when build/NAME is whole, otherwise the status of MAKE.
fill() {
    local name=$1 is_whole=$2
    shift 2
    "$is_whole" "$build/$name" && return
    mkdir -p "$build" && (
        # The lock is held by this subshell, and so is released however it ends.
        lock
        "$is_whole" "$build/$name" && exit           # another run has made it meanwhile
        # $BASHPID is the number of this subshell, $$ that of the whole script.
        aside=$build/aside.$BASHPID
        trap 'rm -rf "$aside"' EXIT
        mkdir "$aside" && "$@" "$aside" && "$is_whole" "$aside" || exit
        rm -rf "${build:?}/$name"
        mv -T "$aside" "$build/$name"
    ) 9>"$build/lock"
}

# Waits for the other runs. A system without flock does without: then two first runs at once do the
# same work twice, and the one that is last is the one that stays.
lock() {
    type -P flock >/dev/null || return 0
    if ! flock --nonblock 9; then
        say "waiting for another run that is filling build/"
        flock 9
    fi
    rm -rf "$build"/aside.*                          # left behind by a run that was killed
}
