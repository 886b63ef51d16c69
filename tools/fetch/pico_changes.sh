# SPDX-License-Identifier: MIT
# What the firmware of our own changes in the sources of MicroPython. To be sourced before pico.sh.
#
# A change that makes a firmware other than plain MicroPython takes a flag to act (pico_flags): the
# firmware files for the tests that hold plain MicroPython are made of the same sources.

# change_micropython MICROPYTHON SDK: the folders.
change_micropython() {
    open_frame_limit "$1/py/objfun.c" &&
        open_stack_limit "$1/ports/rp2/main.c" &&
        pass_what_is_full "$1/py/gc.c" &&
        probe_without_dividing "$1/py/map.c" &&
        begin_with_room "$1/py/map.c" "$1/py/modbuiltins.c" "$1/py/builtinimport.c" &&
        know_what_is_loaded "$1/py/builtinimport.c" &&
        look_on_from_the_last "$1/py/frozenmod.c" || return
    [[ ! -d $2/src/rp2_common/pico_platform_common ]] ||
        name_common_part "$1/ports/rp2/CMakeLists.txt"
}

# One line for all of it: sources that were changed otherwise are fetched again.
micropython_changes() {
    declare -f change_micropython open_frame_limit open_stack_limit pass_what_is_full \
        probe_without_dividing begin_with_room know_what_is_loaded \
        look_on_from_the_last name_common_part insert_behind | sha256sum
}

# Lets a compiler flag say what MicroPython fixes; without the flag nothing changes.
open_frame_limit() {
    local limit=VM_MAX_STATE_ON_STACK
    grep -q "^#define $limit " "$1" &&
        sed -i "s/^#define $limit .*/#ifndef $limit\n&\n#endif/" "$1"
}

# Lets a compiler flag make the stack longer than the 8 KB of the two small banks behind the RAM: it
# goes on downwards, where the heap ends.
open_stack_limit() {
    grep -q '&__StackTop - &__StackBottom' "$1" && grep -q '&__GcHeapEnd)' "$1" &&
        sed -i -e 's/&__StackTop - &__StackBottom/& + STACK_MORE/' \
            -e 's/&__GcHeapEnd)/(void *)((uintptr_t)\&__GcHeapEnd - STACK_MORE))/' \
            -e '0,/^#include/s//#ifndef STACK_MORE\n#define STACK_MORE 0\n#endif\n&/' "$1"
}

# Memory for an object of several blocks is looked for from the first hole of the heap on, four
# blocks at a time. Here sixteen are passed at once where they have no two free ones in a row: with
# 31 drives in memory a module is loaded in two thirds of the time.
pass_what_is_full() {
    insert_behind "$1" '            for (i = area->gc_last_free_atb_index; i < area->gc_alloc_table_byte_len; i++) {' <<'C'
                #if USS_PANEL
                const byte *table = area->gc_alloc_table_start;
                for (size_t whole = area->gc_alloc_table_byte_len & ~3; i % 4 == 0 && i < whole; i += 4) {
                    uint32_t blocks = *(const uint32_t *)(table + i);
                    uint32_t free = ~(blocks | blocks >> 1) & 0x55555555;
                    if (n_blocks == 1 ? free : (free & free >> 2) || (n_free && (free & 1))) {
                        break;
                    }
                    n_free = free >> 30;
                }
                if (i >= area->gc_alloc_table_byte_len) {
                    break;
                }
                #endif
C
}

# A table of names may be full, so that a name is looked for in many places. To go to the next one
# takes a comparison here, not a division.
probe_without_dividing() {
    local line='        pos = (pos + 1) % map->alloc;'
    grep -qFx -- "$line" "$1" &&
        sed -i "s/^$line\$/#if USS_PANEL\n        pos = pos + 1 < map->alloc ? pos + 1 : 0;\n#else\n&\n#endif/" "$1"
}

# The names of a module and of a class come one by one into a table that grows each time it is full:
# a dozen times for thirty, and each time all of them are entered anew. Here it begins with room for
# most (for a module by MICROPY_MODULE_DICT_SIZE), and is cut to what it needs once it is complete.
begin_with_room() {
    insert_behind "$1" '    m_del(mp_map_elem_t, old_table, old_alloc);' <<'C' &&
}

void mp_map_fit(mp_map_t *map) {
    mp_map_t fit;
    mp_map_init(&fit, get_hash_alloc_greater_or_equal_to(map->used));
    for (size_t i = 0; i < map->alloc; i++) {
        if (mp_map_slot_is_filled(map, i)) {
            mp_map_lookup(&fit, map->table[i].key, MP_MAP_LOOKUP_ADD_IF_NOT_FOUND)->value = map->table[i].value;
        }
    }
    m_del(mp_map_elem_t, map->table, map->alloc);
    *map = fit;
C
        insert_behind "$2" '    mp_obj_t class_locals = mp_obj_new_dict(0);' <<'C' &&
    #if USS_PANEL
    void mp_map_fit(mp_map_t *map);
    class_locals = mp_obj_new_dict(29);
    #endif
C
        insert_behind "$2" '    mp_obj_t cell = mp_call_function_0(args[0]);' <<'C' &&
    #if USS_PANEL
    mp_map_fit(mp_obj_dict_get_map(class_locals));
    #endif
C
        insert_behind "$3" '    nlr_pop_jump_callback(false);' <<'C'
    #if USS_PANEL
    void mp_map_fit(mp_map_t *map);
    mp_map_fit(&((mp_obj_module_t *)MP_OBJ_TO_PTR(module_obj))->globals->map);
    #endif
C
}

# `from a.b.c import d` looks for a, a.b and a.b.c, one after the other, each by its letters. Here a
# module that is loaded is found by its whole name, which the bytecode has as a number. (`import a.b`
# is about a, so it goes the long way.)
know_what_is_loaded() {
    insert_behind "$1" '    DEBUG_printf("Starting module search for '"'%s'"'\n", module_name);' <<'C'
    #if USS_PANEL
    if (level == 0 && mp_obj_is_qstr(module_name_obj) && (fromtuple != mp_const_none || !strchr(module_name, '.'))) {
        mp_map_elem_t *loaded = mp_map_lookup(&MP_STATE_VM(mp_loaded_modules_dict).map, module_name_obj, MP_MAP_LOOKUP);
        if (loaded) {
            return loaded->value;
        }
    }
    #endif
C
}

# MicroPython goes through the names of all frozen modules three times for each: whether it is a
# folder, whether it is a file, and where. Here a search begins where the last one ended, and the
# first one stops at a file, so the others are short, and so is one for a neighbour. Nothing but
# modules is frozen.
look_on_from_the_last() {
    insert_behind "$1" 'mp_import_stat_t mp_find_frozen_module(const char *str, int *frozen_type, void **data) {' <<'C'
    #if USS_PANEL
    static const char *at = mp_frozen_names;
    static size_t place;
    size_t length = strlen(str);
    const char *first = at;
    if (frozen_type != NULL) {
        *frozen_type = MP_FROZEN_NONE;
    }
    do {
        size_t at_length = strlen(at);
        if (at_length >= length && memcmp(str, at, length) == 0) {
            if (at_length == length) {
                if (frozen_type != NULL) {
                    *frozen_type = MP_FROZEN_MPY;
                    *data = (void *)mp_frozen_mpy_content[place];
                }
                return MP_IMPORT_STAT_FILE;
            } else if (at[length] == '/') {
                return MP_IMPORT_STAT_DIR;
            } else if (frozen_type == NULL && strcmp(at + length, ".py") == 0) {
                return MP_IMPORT_STAT_FILE; // whoever asks for a folder asks for a file then
            }
        }
        at += at_length + 1;
        place++;
        if (*at == 0) {
            at = mp_frozen_names;
            place = 0;
        }
    } while (at != first);
    return MP_IMPORT_STAT_NO_EXIST;
    #endif
C
}

# SDK 2.2 has a part more, which everything needs; a MicroPython that is older does not name it.
name_common_part() {
    grep -qx ' *pico_platform_common' "$1" ||
        { grep -qx ' *pico_platform_compiler' "$1" &&
            sed -i 's/^\( *\)pico_platform_compiler$/\1pico_platform_common\n&/' "$1"; }
}

# insert_behind FILE LINE: what stands on the standard input, behind that line, which is there once.
insert_behind() {
    local found
    found=$(grep -nFx -- "$2" "$1") && [[ $found != *$'\n'* ]] || return
    sed -i "${found%%:*}r /dev/stdin" "$1"
}
