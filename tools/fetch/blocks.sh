# SPDX-License-Identifier: MIT
# What the emulated Pico executes often of a firmware, in this machine's own code: build/blocks. To be
# sourced after emulator.sh, pico.sh and micropython.sh.
#
# The firmware runs for some seconds, and tools/emulator/rp2040/blocks makes functions in C of what it
# has executed often. Nobody has to have them: without a C compiler everything takes twice as long.

blocks_sources=$emulator_sources/rp2040

# get_blocks NAME...: of the firmware build/pico/NAME.uf2.
get_blocks() {
    local name
    type -P cc >/dev/null || return 0
    for name; do
        [[ ! -s $build/pico/$name.uf2 ]] || blocks_are_current "$name" || (
            lock
            blocks_are_current "$name" || make_blocks "$name"
        ) 9>"$build/lock" || say "    without: tests on the emulated Pico take longer"
    done
}

blocks_are_current() {
    [[ -s $build/blocks/$1.node ]] &&
        [[ $(<"$build/blocks/$1.made_of") == "$(blocks_fingerprint "$1")" ]]
} 2>/dev/null

blocks_fingerprint() {
    cat "$build/pico/$1.uf2" "$blocks_sources"/processor.* "$blocks_sources"/blocks/* \
        "$emulator_sources/often.py" | sha256sum
}

make_blocks() {
    local name=$1 folder=$build/blocks/aside fingerprint
    say "the emulated Pico: compiling what $name.uf2 executes often"
    fingerprint=$(blocks_fingerprint "$name")
    rm -rf "$folder" "$build/blocks/$name".*
    mkdir -p "$folder" && quietly "$folder/log" compile_blocks "$name" "$folder/$name" || return
    mv "$folder/$name".{node,json} "$build/blocks/"
    echo "$fingerprint" >"$build/blocks/$name.made_of"
    rm -rf "$folder"
}

compile_blocks() (
    cd "$top" &&
        USS_EMULATOR_BLOCKS=$2 python3 -I -B tools/emulator/launch.py \
            build/unix64/micropython -X heapsize=64M tools/emulator/often.py "$1" &&
        compile_c "$2" -O1 -foptimize-sibling-calls
)

# Node's functions are looked for when the library is loaded.
compile_c() {
    local shared=(-shared)
    [[ $(uname) != Darwin ]] || shared=(-bundle -undefined dynamic_lookup)
    cc "${shared[@]}" -fPIC -fvisibility=hidden -fwrapv -fno-strict-aliasing -w "${@:2}" \
        -I"$blocks_sources/blocks" -o "$1.node" "$1.c"
}
