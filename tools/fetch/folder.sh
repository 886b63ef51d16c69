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
#   Runs the command with its output in LOG; when it fails, shows what it said last. Meanwhile a
#   terminal is told how far it is.
quietly() {
    local log=$1 watch= status=0
    shift
    if [[ -t 2 ]]; then
        tell_how_far "$log" "$$" 9>&- &
        watch=$!
    fi
    "$@" >"$log" 2>&1 || status=$?
    if [[ -n $watch ]]; then
        kill "$watch" 2>/dev/null
        wait "$watch" 2>/dev/null || :
        printf '\r\033[K' >&2
    fi
    ((status)) || return 0
    say "    that failed:"
    tail -n 8 "$log" | sed 's/^/    /' >&2
    return 1
}

# tell_how_far LOG PROCESS: a line that is written over once a second, as long as the process is
# there: "412 of 980, 35 s left", where the log counts as ninja does, or the seconds.
tell_how_far() {
    local began=$SECONDS counted took far
    while sleep 1 && kill -0 "$2"; do
        took=$((SECONDS - began))
        counted=$(tail -n 1 "$1" | sed -n 's/^\[\([0-9]*\)\/\([0-9]*\)\].*/\1 \2/p')
        far="$took s"
        if [[ -n $counted && ${counted% *} -gt 0 ]]; then
            far="${counted% *} of ${counted#* }, $((took * (${counted#* } - ${counted% *}) / ${counted% *})) s left"
        fi
        printf '\r\033[K    %s' "$far" >&3
    done
} 3>&2 2>/dev/null

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
        # With the number of this subshell: $$ is that of the whole script.
        aside=$build/aside.$(exec bash -c 'echo $PPID')
        trap 'rm -rf "$aside"' EXIT
        mkdir "$aside" && "$@" "$aside" && "$is_whole" "$aside" || exit
        rm -rf "${build:?}/$name"
        mv "$aside" "$build/$name"
    ) 9>"$build/lock"
}

# Waits for the other runs. macOS has no flock, but Python has. A system with neither does without:
# then two first runs at once do the same work twice.
lock() {
    type -P flock >/dev/null || has_python || return 0
    if ! take_lock --nonblock; then
        say "waiting for another run that is filling build/"
        take_lock
    fi
    rm -rf "$build"/aside.*                          # left behind by a run that was killed
}

# take_lock [--nonblock]: it is held as long as file 9 is open, also when Python has gone.
take_lock() {
    if type -P flock >/dev/null; then
        flock "$@" 9
    else
        python3 -c 'import fcntl, sys
fcntl.flock(9, fcntl.LOCK_EX | (fcntl.LOCK_NB if sys.argv[1:] else 0))' "$@" 2>/dev/null
    fi
}

has_python() {
    python3 -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null
}

# within SECONDS COMMAND...: its status; when it takes longer it is killed. macOS has no timeout.
within() {
    local child looks=$(($1 * 20))
    "${@:2}" <&0 &
    child=$!
    while kill -0 "$child" && ((looks-- > 0)); do
        sleep 0.05
    done
    ((looks >= 0)) || kill -9 "$child"
    wait "$child"
} 2>/dev/null

# how_to_get DEBIAN HOMEBREW ARCH FEDORA: the command that installs these packages, by the package
# manager that is here, or by each of them.
how_to_get() {
    local commands=("apt-get install $1" "brew install $2" "pacman -S $3" "dnf install $4") one all=
    for one in "${commands[@]}"; do
        type -P "${one%% *}" >/dev/null && echo "$one" && return
        all+="${all:+, or }$one"
    done
    echo "$all"
}
