// SPDX-License-Identifier: MIT
// What the blocks of block.mjs use, and what node calls (Node-API, nodejs.org/api/n-api.html). The
// code that blocks.mjs makes of a firmware includes this first, behind the addresses of processor.ts.
#include <stddef.h>
#include <stdint.h>

typedef uint32_t word;
typedef int32_t number;
typedef uint8_t *memory;

#define RAM 0x20000000u
#define RAM_BYTES (264u * 1024)
#define FLASH 0x10000000u
#define FLASH_BYTES (2u * 1024 * 1024)
#define ROM_BYTES (16u * 1024) // from 0 on
#define STACK_ROOM 36u // bytes that PUSH, POP, STMIA and LDMIA move at the most

// What is at an address of the chip, and what processor.ts keeps beside it.
#define WORD(address) (*(word *)(m + (word)(address)))
#define HALF(address) (*(uint16_t *)(m + (word)(address)))
#define BYTE(address) (*(uint8_t *)(m + (word)(address)))
#define SIGNED_HALF(address) ((word)(number)*(int16_t *)(m + (word)(address)))
#define SIGNED_BYTE(address) ((word)(number)*(int8_t *)(m + (word)(address)))
#define R(register) WORD(REGISTERS + 4u * (register))
#define PC R(15)

// A block takes the cycles that are left and the flags, and goes on to the next block: a call with
// the same parameters that ends a function becomes a jump. Answers the cycles that remain.
#define STATE memory m, word left, word n, word z, word c, word v
#define GIVEN m, left, n, z, c, v
#if defined(__clang__) && __has_attribute(musttail)
#define GO __attribute__((musttail)) return
#else
#define GO return
#endif
typedef word (*block)(STATE);
extern const block blocks[] __attribute__((visibility("hidden")));

static word packed(word n, word z, word c, word v)
{
    return (n & 0x80000000u) | (word)(z == 0) << 30 | c << 29 | v << 28;
}

// Leave: `interpret` goes on. To where no block is, a jump has led.

static word leave(STATE)
{
    WORD(APSR) = packed(n, z, c, v);
    WORD(JUMPED) = 0;
    return left;
}

static word nowhere(STATE)
{
    WORD(APSR) = packed(n, z, c, v);
    WORD(JUMPED) = 1;
    return left;
}

static word dispatch(STATE)
{
    word place = (PC - RAM) >> 1;
    if (place >= RAM_BYTES / 2) {
        place = (PC - FLASH) >> 1;
        if (place >= FLASH_BYTES / 2) {
            if (PC >= ROM_BYTES) GO nowhere(GIVEN);
            place = FLASH_BYTES / 2 + (PC >> 1);
        }
        place += RAM_BYTES / 2;
    }
    GO blocks[HALF(BLOCKS + 2 * place)](GIVEN);
}

static inline word rotated(word value, word count)
{
    return value >> (count & 31) | value << (-count & 31);
}

static inline int is_in(word address, word area, word bytes, word size)
{
    return rotated(address - area, size >> 1) < bytes >> (size >> 1); // it is aligned as well
}

static inline int is_in_code(memory m, word address)
{
    return address - WORD(CODE) < WORD(CODE_BYTES);
}

// The same of all that starts there and has STACK_ROOM.
static inline int may_be_in_code(memory m, word address)
{
    return address + STACK_ROOM - WORD(CODE) < WORD(CODE_BYTES) + STACK_ROOM;
}

// The cycles that the processor waits for a line of the cache (processor.ts).
static word wait_for(memory m, word line)
{
    const word set = LINES + ((line & 1023) << 3), last = WORD(set);
    if (last == line) return 0;
    const word other = WORD(set + 4);
    WORD(set) = line;
    WORD(set + 4) = last;
    return other == line ? 0 : WORD(MISS_CYCLES);
}

static inline word wait(memory m, word line)
{
    return WORD(LINES + ((line & 1023) << 3)) == line ? 0 : wait_for(m, line);
}

// The core's number, its divider and the locks (processor.ts).

#define CPUID 0xd0000000u
#define DIVIDER 0xd0000060u
#define LOCKS 0xd0000100u

static inline int is_lock(word address)
{
    return (address & ~0x7cu) == LOCKS;
}

static inline int is_near(word address)
{
    return (address & ~0x1fu) == DIVIDER || address == CPUID || is_lock(address);
}

static word take(memory m, word lock)
{
    const word taken = WORD(SPINLOCKS), bit = 1u << (lock >> 2 & 31);
    WORD(SPINLOCKS) = taken | bit;
    return bit & ~taken;
}

static word load_near(memory m, word address)
{
    if (is_lock(address)) return take(m, address);
    switch (address - DIVIDER) {
    case 0x00: case 0x08: return WORD(DIVIDEND);
    case 0x04: case 0x0c: return WORD(DIVISOR);
    case 0x10: WORD(DIRTY) = 0; return WORD(QUOTIENT);
    case 0x14: return WORD(REMAINDER);
    case 0x18: return WORD(DIRTY) << 1 | 1; // and it is ready
    }
    return 0; // the number of the first core
}

static void divide(memory m, int is_signed)
{
    const word dividend = WORD(DIVIDEND), divisor = WORD(DIVISOR);
    word quotient, remainder = 0;
    if (divisor == 0) {
        quotient = is_signed && (number)dividend < 0 ? 1 : -1;
        remainder = dividend;
    } else if (!is_signed) {
        quotient = dividend / divisor;
        remainder = dividend % divisor;
    } else if (divisor == (word)-1) { // the least number is not divided by it
        quotient = -dividend;
    } else {
        quotient = (number)dividend / (number)divisor;
        remainder = (number)dividend % (number)divisor;
    }
    WORD(QUOTIENT) = quotient;
    WORD(REMAINDER) = remainder;
}

static void store_near(memory m, word address, word value)
{
    const word which = address - DIVIDER;
    if (is_lock(address)) WORD(SPINLOCKS) &= ~(1u << (address >> 2 & 31));
    switch (which) {
    case 0x00: case 0x08: WORD(DIVIDEND) = value; break;
    case 0x04: case 0x0c: WORD(DIVISOR) = value; break;
    case 0x10: WORD(QUOTIENT) = value; break;
    case 0x14: WORD(REMAINDER) = value; break;
    }
    if (which < 0x18) WORD(DIRTY) = 1;
    if (which < 0x10) divide(m, (which & 8) != 0);
}

// The timer's count (processor.ts).

#define TIMERAWH 0x40054024u
#define TIMERAWL 0x40054028u
#define CYCLE_NANOS 8

static inline int is_clock(word address)
{
    return address == TIMERAWL || address == TIMERAWH;
}

static word load_clock(memory m, word address, word left)
{
    const double *times = (double *)(m + TIMES);
    const double now = times[0] + (number)(WORD(BUDGET) - left) * CYCLE_NANOS;
    const uint64_t micros = (now - times[1]) / 1000;
    return address == TIMERAWL ? micros : micros >> 32;
}

// What node calls

typedef struct napi_env__ *napi_env;
typedef struct napi_value__ *napi_value;
typedef struct napi_callback_info__ *napi_callback_info;
typedef napi_value (*napi_callback)(napi_env, napi_callback_info);
int napi_create_function(napi_env, const char *, size_t, napi_callback, void *, napi_value *);
int napi_set_named_property(napi_env, napi_value, const char *, napi_value);
int napi_get_cb_info(napi_env, napi_callback_info, size_t *, napi_value *, napi_value *, void **);
int napi_get_arraybuffer_info(napi_env, napi_value, void **, size_t *);
int napi_get_value_int32(napi_env, napi_value, int32_t *);
int napi_create_int32(napi_env, int32_t, napi_value *);

static memory chip;

// join(buffer): the memory of processor.ts.
static napi_value join(napi_env env, napi_callback_info info)
{
    size_t count = 1, bytes;
    napi_value buffer;
    void *start;
    napi_get_cb_info(env, info, &count, &buffer, NULL, NULL);
    napi_get_arraybuffer_info(env, buffer, &start, &bytes);
    chip = start;
    return NULL;
}

// run(left): the block NUMBER and those after it; answers the cycles that remain.
static napi_value run(napi_env env, napi_callback_info info)
{
    size_t count = 1;
    napi_value value;
    int32_t left;
    const memory m = chip;
    const word flags = WORD(APSR);
    napi_get_cb_info(env, info, &count, &value, NULL, NULL);
    napi_get_value_int32(env, value, &left);
    left = blocks[WORD(NUMBER)](
        m, left, flags, ~flags & 0x40000000u, flags >> 29 & 1, flags >> 28 & 1);
    napi_create_int32(env, left, &value);
    return value;
}

static void offer(napi_env env, napi_value exports, const char *name, napi_callback does)
{
    napi_value function;
    napi_create_function(env, name, (size_t)-1, does, NULL, &function);
    napi_set_named_property(env, exports, name, function);
}

__attribute__((visibility("default"))) napi_value napi_register_module_v1(
    napi_env env, napi_value exports)
{
    offer(env, exports, "join", join);
    offer(env, exports, "run", run);
    return exports;
}
