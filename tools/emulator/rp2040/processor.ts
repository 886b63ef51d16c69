// SPDX-License-Identifier: MIT
// The processor's instructions, in AssemblyScript (assemblyscript.org), which becomes WebAssembly:
// which takes two thirds of the time of JavaScript. core.mjs is the rest of the processor.
//
// `interpret` executes instructions until its cycles are spent. The clock stands still meanwhile. A
// load or store beyond the memories ends it, and so does a rare instruction: those are for core.mjs,
// which puts the clock right first. So it calls nothing, and most of its variables stay in registers
// of the host. Cycles are counted as rp2040js does, and besides them those that the processor waits
// for the flash.
//
// What a firmware executes often may be there in the host's own code: blocks (blocks/blocks.mjs). A
// jump that leads to one ends `interpret` as well.

// The memories lie where they lie on the chip. What is beside them comes behind (see the compiler's
// options in tools/fetch/emulator.sh); core.mjs and the rest of the chip see it too.
export const ROM = 0, FLASH = 0x10000000, RAM = 0x20000000;
const ROM_BYTES: u32 = 16384, RAM_BYTES: u32 = 264 * 1024, FLASH_BYTES: u32 = 2 * 1024 * 1024;
export const REGISTERS = memory.data(16 * 4, 16);
export const STATE = memory.data(19 * 4, 16);
export const LINES = memory.data(1024 * 2 * 4, 16); // the cache (cache.mjs)
export const TIMES = memory.data(2 * 8, 16); // when the stretch began, and the timer; nanoseconds

// The words of STATE, and where they are.
const APSR: usize = STATE; // the flags N, Z, C, V in the uppermost bits
const PRIMASK: usize = STATE + 4; // 1: interrupts are masked
const LOWEST: usize = STATE + 8; // where SP has been, counted at PUSH
const MISS_CYCLES: usize = STATE + 12; // how long the processor waits for a line of the cache
const WHY: usize = STATE + 16; // the stretch has ended: one of the reasons below
const ADDRESS: usize = STATE + 20; // of that load or store,
const BYTES: usize = STATE + 24; // how many,
const NUMBER: usize = STATE + 28; // and of which register; or the number of the block
const DIVIDEND: usize = STATE + 32; // of the divider, see below
const DIVISOR: usize = STATE + 36;
const QUOTIENT: usize = STATE + 40;
const REMAINDER: usize = STATE + 44;
const DIRTY: usize = STATE + 48;
const LINE: usize = STATE + 52; // of the cache, from which the last instruction came; -1: from none
const JUMPED: usize = STATE + 56; // 1: a jump has led to the next instruction
const CODE: usize = STATE + 60; // where in RAM there are blocks: the first byte, and how many bytes
const CODE_BYTES: usize = STATE + 64;
const BUDGET: usize = STATE + 68; // the cycles of the stretch
const SPINLOCKS: usize = STATE + 72; // bit n: number n is taken

// By halfword of RAM, then of the flash, then of the ROM: the number of the block that begins there,
// or 0, and how many jumps have led to where none is, up to MOST_JUMPS.
const HALVES: usize = (RAM_BYTES + FLASH_BYTES + ROM_BYTES) / 2;
const MOST_JUMPS = 65535;
const CODE_SHIFT = 5; // of an offset in RAM, to its part in CODE_MAP
const LEAST = 64; // cycles that must be left, so that a block is worth while
export const BLOCKS: usize = 0x20060000;
export const JUMPS: usize = BLOCKS + 2 * HALVES;
export const CODE_MAP: usize = JUMPS + 2 * HALVES; // 1 for each 32 bytes of RAM with code of a block

// Why it has ended.
const SPENT = 0; // no cycles are left
const RARE = 1; // the next instruction is one for rp2040js
const LOAD = 2; // and so are these three, for core.mjs
const LOAD_SIGNED = 3;
const STORE = 4;
const UNMASKED = 5; // interrupts are no longer masked: one may wait
const LOST = 6; // no code is there
const CHANGED = 7; // code of a block has been overwritten
const BLOCK = 8; // a block is to be called: NUMBER

const KINDS = memory.data(1024); // by the first ten bits of an instruction: its case of the switch

const LINE_SHIFT = 3; // of an address, to the number of its line
const SETS_MASK = 1023;
const EXCEPTION_RETURN = 15; // the first digit of its addresses
const SPECIAL_PRIMASK = 16; // the number of the special register
const MOST_PUSHED: u32 = 36; // bytes
const MOST_LOADED: u32 = 32;

// The kinds of instructions. Letters are bits of operands: i immediate, d m n registers, r a list.
// The first ten bits tell the kind; what the others must be, its case asks.

function kind(number: u8, pattern: string): void {
  let mask = 0, value = 0;
  for (let i = 0; i < 10; i++) {
    const letter = pattern.charCodeAt(i), isOne = letter == 0x31;
    mask = (mask << 1) | i32(isOne || letter == 0x30);
    value = (value << 1) | i32(isOne);
  }
  // All that the other bits may be, from all ones down to none.
  for (let bits = ~mask & 1023; ; bits = (bits - 1) & ~mask) {
    store<u8>(KINDS + (value | bits), number);
    if (bits == 0) break;
  }
}

kind(1, "00000iiiiinnnddd"); kind(2, "00001iiiiinnnddd"); kind(3, "00010iiiiinnnddd");
kind(4, "0001100mmmnnnddd"); kind(5, "0001101mmmnnnddd"); kind(6, "0001110iiinnnddd");
kind(7, "0001111iiinnnddd"); kind(8, "00100dddiiiiiiii"); kind(9, "00101nnniiiiiiii");
kind(10, "00110dddiiiiiiii"); kind(11, "00111dddiiiiiiii"); kind(12, "0100000000nnnddd");
kind(13, "0100000001nnnddd"); kind(14, "0100000010nnnddd"); kind(15, "0100000011nnnddd");
kind(16, "0100000100nnnddd"); kind(17, "0100000101nnnddd"); kind(18, "0100000110nnnddd");
kind(19, "0100000111nnnddd"); kind(20, "0100001000nnnddd"); kind(21, "0100001001nnnddd");
kind(22, "0100001010nnnddd"); kind(23, "0100001011nnnddd"); kind(24, "0100001100nnnddd");
kind(25, "0100001101nnnddd"); kind(26, "0100001110nnnddd"); kind(27, "0100001111nnnddd");
kind(28, "01000100dnnnnddd"); kind(29, "01000101dnnnnddd"); kind(30, "01000110dnnnnddd");
kind(31, "010001110nnnn000"); kind(32, "010001111nnnn000"); kind(33, "01001dddiiiiiiii");
kind(34, "0101000mmmnnnddd"); kind(35, "0101001mmmnnnddd"); kind(36, "0101010mmmnnnddd");
kind(37, "01100iiiiinnnddd"); kind(38, "10000iiiiinnnddd"); kind(39, "01110iiiiinnnddd");
kind(40, "10010dddiiiiiiii"); kind(41, "0101100mmmnnnddd"); kind(42, "0101101mmmnnnddd");
kind(43, "0101110mmmnnnddd"); kind(44, "01101iiiiinnnddd"); kind(45, "10001iiiiinnnddd");
kind(46, "01111iiiiinnnddd"); kind(47, "10011dddiiiiiiii"); kind(48, "0101111mmmnnnddd");
kind(49, "0101011mmmnnnddd"); kind(50, "10100dddiiiiiiii"); kind(51, "10101dddiiiiiiii");
kind(52, "101100000iiiiiii"); kind(53, "101100001iiiiiii"); kind(54, "1011001000nnnddd");
kind(55, "1011001001nnnddd"); kind(56, "1011001010nnnddd"); kind(57, "1011001011nnnddd");
kind(58, "1011010rrrrrrrrr"); kind(59, "10111100rrrrrrrr"); kind(60, "10111101rrrrrrrr");
kind(61, "1011101000nnnddd"); kind(62, "1011111100000000"); kind(63, "11000dddrrrrrrrr");
kind(64, "11001dddrrrrrrrr"); kind(65, "11010000iiiiiiii"); kind(66, "11010001iiiiiiii");
kind(67, "11010010iiiiiiii"); kind(68, "11010011iiiiiiii"); kind(69, "11010100iiiiiiii");
kind(70, "11010101iiiiiiii"); kind(71, "11010110iiiiiiii"); kind(72, "11010111iiiiiiii");
kind(73, "11011000iiiiiiii"); kind(74, "11011001iiiiiiii"); kind(75, "11011010iiiiiiii");
kind(76, "11011011iiiiiiii"); kind(77, "11011100iiiiiiii"); kind(78, "11011101iiiiiiii");
kind(79, "11100iiiiiiiiiii"); kind(80, "11110iiiiiiiiiii"); kind(81, "10110110011s0010");
kind(82, "1011111101000000");

// The operands of an instruction: registers, by where the bits of their numbers are.

@inline function d(op: i32): i32 { return load<i32>((op & 7) << 2, REGISTERS); }
@inline function n(op: i32): i32 { return load<i32>((op >> 1) & 28, REGISTERS); }
@inline function m(op: i32): i32 { return load<i32>((op >> 4) & 28, REGISTERS); }
@inline function d8(op: i32): i32 { return load<i32>((op >> 6) & 28, REGISTERS); }
@inline function high(op: i32): i32 { return ((op >> 4) & 8) | (op & 7); }
@inline function get(number: i32): i32 { return load<i32>(number << 2, REGISTERS); }

@inline function setD(op: i32, value: i32): i32 {
  store<i32>((op & 7) << 2, value, REGISTERS);
  return value;
}
@inline function setD8(op: i32, value: i32): i32 {
  store<i32>((op >> 6) & 28, value, REGISTERS);
  return value;
}
@inline function set(number: i32, value: i32): void {
  store<i32>(number << 2, value, REGISTERS);
}

// Loads and stores: the first kinds of both, and how many bytes each kind moves.

const STORES = 34, STORE_AT_SP = 40, LOADS = 41, LOAD_AT_SP = 47, SIGNED = 48, ACCESSES_END = 50;
const SIZES = memory.data<u8>([4, 2, 1, 4, 2, 1, 4, 4, 2, 1, 4, 2, 1, 4, 2, 1]);

// Whether it is there, and aligned.
@inline function inRam<T>(address: i32): bool {
  const shift = <i32>alignof<T>();
  return <u32>rotr(address - RAM, shift) < RAM_BYTES >> shift;
}

// What a load of this kind makes of a word, of which it has read the first bytes.
@inline function extended(kind: i32, word: i32): i32 {
  switch (kind) {
    case 42: case 45: return word & 0xffff;
    case 43: case 46: return word & 0xff;
    case 48: return <i32><i16>word;
    case 49: return <i32><i8>word;
  }
  return word;
}

// The cycles that the processor waits for a line (cache.mjs says how the cache works).
@inline function wait(line: i32): i32 {
  const at = (line & SETS_MASK) << 3;
  const last = load<i32>(at, LINES);
  if (last == line) return 0;
  const other = load<i32>(at, LINES + 4);
  store<i32>(at, line, LINES);
  store<i32>(at, last, LINES + 4);
  return other == line ? 0 : load<i32>(MISS_CYCLES);
}

// Outside of the memories nothing is accessed as often as the core's number, its divider and the
// locks. The divider has divided at once (RP2040 data sheet, 2.3.1.1, 2.3.1.3 and 2.3.1.5).

const CPUID: i32 = 0xd0000000, DIVIDER: i32 = 0xd0000060, DIVIDER_MASK = ~0x1f;
const LOCKS: i32 = 0xd0000100, LOCKS_MASK = ~0x7c;

@inline function isNear(address: i32): bool {
  return (address & DIVIDER_MASK) == DIVIDER || address == CPUID || isLock(address);
}

@inline function isLock(address: i32): bool {
  return (address & LOCKS_MASK) == LOCKS;
}

// 0: it was taken before.
@inline function take(lock: i32): i32 {
  const taken = load<i32>(SPINLOCKS), bit = 1 << ((lock >> 2) & 31);
  store<i32>(SPINLOCKS, taken | bit);
  return bit & ~taken;
}

@inline function release(lock: i32): void {
  store<i32>(SPINLOCKS, load<i32>(SPINLOCKS) & ~(1 << ((lock >> 2) & 31)));
}

@inline function readNear(address: i32): i32 {
  if (isLock(address)) return take(address);
  switch (address - DIVIDER) {
    case 0x00: case 0x08: return load<i32>(DIVIDEND);
    case 0x04: case 0x0c: return load<i32>(DIVISOR);
    case 0x10:
      store<i32>(DIRTY, 0);
      return load<i32>(QUOTIENT);
    case 0x14: return load<i32>(REMAINDER);
    case 0x18: return (load<i32>(DIRTY) << 1) | 1; // and it is ready
  }
  return 0; // the number of the first core
}

@inline function writeNear(address: i32, value: i32): void {
  if (isLock(address)) return release(address);
  const register = address - DIVIDER;
  switch (register) {
    case 0x00: case 0x08: store<i32>(DIVIDEND, value); break;
    case 0x04: case 0x0c: store<i32>(DIVISOR, value); break;
    case 0x10: store<i32>(QUOTIENT, value); break;
    case 0x14: store<i32>(REMAINDER, value); break;
  }
  if (<u32>register < 0x18) store<i32>(DIRTY, 1);
  if (<u32>register < 0x10) divide((register & 8) != 0);
}

@inline function divide(isSigned: bool): void {
  const dividend = load<i32>(DIVIDEND), divisor = load<i32>(DIVISOR);
  let quotient = 0, remainder = 0;
  if (divisor == 0) {
    quotient = isSigned && dividend < 0 ? 1 : -1;
    remainder = dividend;
  } else if (!isSigned) {
    quotient = <u32>dividend / <u32>divisor;
    remainder = <u32>dividend % <u32>divisor;
  } else if (divisor == -1) { // WebAssembly does not divide the least number by it
    quotient = -dividend;
  } else {
    quotient = dividend / divisor;
    remainder = dividend % divisor;
  }
  store<i32>(QUOTIENT, quotient);
  store<i32>(REMAINDER, remainder);
}

// The timer's count, which whoever waits reads again and again (RP2040 data sheet, 4.6.5). timer.mjs
// has the rest of it, and counts alike.

const TIMERAWH: i32 = 0x40054024, TIMERAWL: i32 = 0x40054028;
const CYCLE_NANOS = 8, CLOCK_CYCLES = 4; // to read it takes so many

@inline function isClock(address: i32): bool {
  return address == TIMERAWL || address == TIMERAWH;
}

@inline function readClock(address: i32, left: i32): i32 {
  const now = load<f64>(TIMES) + <f64>((load<i32>(BUDGET) - left) * CYCLE_NANOS);
  const micros = <u64>((now - load<f64>(TIMES + 8)) / 1000);
  return <i32>(address == TIMERAWL ? micros : micros >> 32);
}

@inline function hop(op: i32): i32 { return 2 + ((op << 24) >> 23); }

// After a comparison comes BEQ or BNE, more often than not: it is executed with it, if it is in the
// same line.

const BEQ_OR_BNE = 0xd000, BEQ_OR_BNE_MASK = 0xfe00, IS_BNE = 0x100, IN_LINE_MASK = 6;

@inline function branchesHere(pc: i32): bool {
  return (pc & IN_LINE_MASK) != 0 && (<i32>load<u16>(pc) & BEQ_OR_BNE_MASK) == BEQ_OR_BNE;
}

@inline function isTaken(branch: i32, rest: i32): bool {
  return (rest == 0) == ((branch & IS_BNE) == 0);
}

// The block that begins where a jump has led, or 0.
@inline function blockAt(pc: i32): i32 {
  let half = <u32>(pc - RAM) >> 1;
  if (half >= RAM_BYTES / 2) {
    half = <u32>(pc - FLASH) >> 1;
    if (half >= FLASH_BYTES / 2) {
      if (<u32>pc >= ROM_BYTES) return 0;
      half = FLASH_BYTES / 2 + (<u32>pc >> 1);
    }
    half += RAM_BYTES / 2;
  }
  const block = <i32>load<u16>(half << 1, BLOCKS);
  if (block == 0) {
    const jumps = load<u16>(half << 1, JUMPS);
    if (jumps != MOST_JUMPS) store<u16>(half << 1, jumps + 1, JUMPS);
  }
  return block;
}

// Stores to RAM. Whether that has changed the code of a block.
@inline function put<T>(address: i32, value: i32): bool {
  if (<u32>(address - load<i32>(CODE)) < load<u32>(CODE_BYTES)) {
    const changes = load<u8>(<u32>(address - RAM) >> CODE_SHIFT, CODE_MAP) != 0
      && load<T>(address) != <T>value;
    store<T>(address, <T>value);
    return changes;
  }
  store<T>(address, <T>value);
  return false;
}

@inline function isStack(offset: i32): bool {
  return <u32>offset <= RAM_BYTES - MOST_PUSHED;
}

// Takes the cycles that are left, returns those that remain (or were taken too many); WHY tells why.
// One function and long: each call would cost more than the instruction.
export function interpret(left: i32): i32 {
  let pc = get(15) & ~1; // of the next instruction
  let line = load<i32>(LINE);
  let jumped = load<i32>(JUMPED);
  const flags = load<i32>(APSR);
  let negative = flags; // below 0: N is set
  let zero = ~flags & 0x40000000; // 0: Z is set
  let c = (flags >>> 29) & 1;
  let v = (flags >>> 28) & 1;
  let why = SPENT;
  let address = 0; // of the load or store
  while (left > 0) {
    if (jumped != 0) {
      jumped = 0;
      const block = blockAt(pc);
      if (block != 0 && left > LEAST) {
        store<i32>(NUMBER, block);
        why = BLOCK;
        break;
      }
    }
    if (pc >> LINE_SHIFT != line) {
      line = pc >> LINE_SHIFT;
      if (<u32>(pc - FLASH) < FLASH_BYTES) {
        left -= wait(line);
        if (left <= 0) break; // something is due before the line has come
      } else if (<u32>(pc - RAM) >= RAM_BYTES && <u32>pc >= ROM_BYTES) {
        why = LOST;
        break;
      }
    }
    const op = <i32>load<u16>(pc);
    // Every instruction takes a cycle and is followed by the next; what differs says so below.
    left -= 1;
    pc += 2;
    switch (<i32>load<u8>(op >> 6, KINDS)) {
      case 1: { // LSLS immediate
        const count = (op >> 6) & 31, value = n(op);
        if (count) c = (value >>> (32 - count)) & 1;
        negative = zero = setD(op, value << count);
        continue;
      }
      case 2: { // LSRS immediate
        const count = (op >> 6) & 31, value = n(op);
        c = (value >>> ((count - 1) & 31)) & 1;
        negative = zero = setD(op, count ? value >>> count : 0);
        continue;
      }
      case 3: { // ASRS immediate
        const count = (op >> 6) & 31, value = n(op);
        c = (value >> ((count - 1) & 31)) & 1;
        negative = zero = setD(op, value >> (count ? count : 31));
        continue;
      }
      case 4: { // ADDS register
        const one = n(op), other = m(op), sum = one + other;
        c = i32(<u32>sum < <u32>one);
        v = ((one ^ sum) & (other ^ sum)) >>> 31;
        negative = zero = setD(op, sum);
        continue;
      }
      case 5: { // SUBS register
        const one = n(op), other = m(op), rest = one - other;
        c = i32(<u32>one >= <u32>other);
        v = ((one ^ other) & (one ^ rest)) >>> 31;
        negative = zero = setD(op, rest);
        continue;
      }
      case 6: { // ADDS immediate, 3 bits
        const one = n(op), sum = one + ((op >> 6) & 7);
        c = i32(<u32>sum < <u32>one);
        v = (~one & sum) >>> 31;
        negative = zero = setD(op, sum);
        continue;
      }
      case 7: { // SUBS immediate, 3 bits
        const one = n(op), other = (op >> 6) & 7, rest = one - other;
        c = i32(<u32>one >= <u32>other);
        v = (one & ~rest) >>> 31;
        negative = zero = setD(op, rest);
        continue;
      }
      case 8: // MOVS immediate
        negative = zero = setD8(op, op & 0xff);
        continue;
      case 9: { // CMP immediate
        const one = d8(op), other = op & 0xff, rest = one - other;
        c = i32(<u32>one >= <u32>other);
        v = (one & ~rest) >>> 31;
        negative = zero = rest;
        if (left > 0 && branchesHere(pc)) {
          const branch = <i32>load<u16>(pc);
          left -= 1;
          pc += 2;
          if (isTaken(branch, rest)) { pc += hop(branch); left -= 1; jumped = 1; }
        }
        continue;
      }
      case 10: { // ADDS immediate, 8 bits
        const one = d8(op), sum = one + (op & 0xff);
        c = i32(<u32>sum < <u32>one);
        v = (~one & sum) >>> 31;
        negative = zero = setD8(op, sum);
        continue;
      }
      case 11: { // SUBS immediate, 8 bits
        const one = d8(op), other = op & 0xff, rest = one - other;
        c = i32(<u32>one >= <u32>other);
        v = (one & ~rest) >>> 31;
        negative = zero = setD8(op, rest);
        continue;
      }
      case 12: // ANDS
        negative = zero = setD(op, d(op) & n(op));
        continue;
      case 13: // EORS
        negative = zero = setD(op, d(op) ^ n(op));
        continue;
      case 14: { // LSLS register
        const count = n(op) & 0xff, value = d(op);
        if (count) c = count <= 32 ? (value >>> (32 - count)) & 1 : 0;
        negative = zero = setD(op, count < 32 ? value << count : 0);
        continue;
      }
      case 15: { // LSRS register
        const count = n(op) & 0xff, value = d(op);
        if (count) c = count <= 32 ? (value >>> (count - 1)) & 1 : 0;
        negative = zero = setD(op, count < 32 ? value >>> count : 0);
        continue;
      }
      case 16: { // ASRS register
        const count = n(op) & 0xff, value = d(op);
        if (count) c = (value >> (count < 32 ? count - 1 : 31)) & 1;
        negative = zero = setD(op, value >> (count < 32 ? count : 31));
        continue;
      }
      case 17: { // ADCS
        const one = d(op), other = n(op), sum = <u64><u32>one + <u64><u32>other + <u64>c;
        c = <i32>(sum >> 32);
        negative = zero = setD(op, <i32>sum);
        v = ((one ^ zero) & (other ^ zero)) >>> 31;
        continue;
      }
      case 18: { // SBCS
        const one = d(op), other = ~n(op), sum = <u64><u32>one + <u64><u32>other + <u64>c;
        c = <i32>(sum >> 32);
        negative = zero = setD(op, <i32>sum);
        v = ((one ^ zero) & (other ^ zero)) >>> 31;
        continue;
      }
      case 19: { // RORS
        const count = n(op) & 0xff, turned = rotr(d(op), count & 31);
        if (count) c = turned >>> 31;
        negative = zero = setD(op, turned);
        continue;
      }
      case 20: // TST
        negative = zero = d(op) & n(op);
        continue;
      case 21: { // RSBS
        const other = n(op), rest = -other;
        c = i32(other == 0);
        v = (other & rest) >>> 31;
        negative = zero = setD(op, rest);
        continue;
      }
      case 22: { // CMP register
        const one = d(op), other = n(op), rest = one - other;
        c = i32(<u32>one >= <u32>other);
        v = ((one ^ other) & (one ^ rest)) >>> 31;
        negative = zero = rest;
        if (left > 0 && branchesHere(pc)) {
          const branch = <i32>load<u16>(pc);
          left -= 1;
          pc += 2;
          if (isTaken(branch, rest)) { pc += hop(branch); left -= 1; jumped = 1; }
        }
        continue;
      }
      case 23: { // CMN
        const one = d(op), other = n(op), sum = one + other;
        c = i32(<u32>sum < <u32>one);
        v = ((one ^ sum) & (other ^ sum)) >>> 31;
        negative = zero = sum;
        continue;
      }
      case 24: // ORRS
        negative = zero = setD(op, d(op) | n(op));
        continue;
      case 25: // MULS
        negative = zero = setD(op, d(op) * n(op));
        continue;
      case 26: // BICS
        negative = zero = setD(op, d(op) & ~n(op));
        continue;
      case 27: // MVNS
        negative = zero = setD(op, ~n(op));
        continue;
      case 28: { // ADD, any register
        set(15, pc + 2);
        const to = high(op), sum = get(to) + get((op >> 3) & 15);
        if (to == 15) {
          pc = sum & ~1;
          left -= 1;
          jumped = 1;
        } else {
          set(to, to == 13 ? sum & ~3 : sum);
        }
        continue;
      }
      case 29: { // CMP, any register
        set(15, pc + 2);
        const one = get(high(op)), other = get((op >> 3) & 15), rest = one - other;
        c = i32(<u32>one >= <u32>other);
        v = ((one ^ other) & (one ^ rest)) >>> 31;
        negative = zero = rest;
        continue;
      }
      case 30: { // MOV, any register
        set(15, pc + 2);
        const to = high(op), value = get((op >> 3) & 15);
        if (to == 15) {
          pc = value & ~1;
          left -= 1;
          jumped = 1;
        } else {
          set(to, to == 13 ? value & ~3 : value);
        }
        continue;
      }
      case 31: { // BX
        const target = get((op >> 3) & 15);
        if ((op & 7) != 0 || target >>> 28 == EXCEPTION_RETURN) break;
        pc = target & ~1;
        left -= 1;
        jumped = 1;
        continue;
      }
      case 32: { // BLX
        if ((op & 7) != 0) break;
        const target = get((op >> 3) & 15);
        set(14, pc | 1);
        pc = target & ~1;
        left -= 1;
        jumped = 1;
        continue;
      }
      case 33: { // LDR literal
        const literal = ((pc + 2) & ~3) + ((op & 0xff) << 2);
        setD8(op, load<i32>(literal));
        if (<u32>(pc - FLASH) < FLASH_BYTES) left -= wait(literal >> LINE_SHIFT);
        left -= 1;
        continue;
      }
      case 34: // STR register
        address = n(op) + m(op);
        if (!inRam<i32>(address)) break;
        left -= 1;
        if (!put<i32>(address, d(op))) continue;
        why = CHANGED;
        break;
      case 35: // STRH register
        address = n(op) + m(op);
        if (!inRam<u16>(address)) break;
        left -= 1;
        if (!put<u16>(address, d(op))) continue;
        why = CHANGED;
        break;
      case 36: // STRB register
        address = n(op) + m(op);
        if (!inRam<u8>(address)) break;
        left -= 1;
        if (!put<u8>(address, d(op))) continue;
        why = CHANGED;
        break;
      case 37: // STR immediate
        address = n(op) + ((op >> 4) & 0x7c);
        if (!inRam<i32>(address)) break;
        left -= 1;
        if (!put<i32>(address, d(op))) continue;
        why = CHANGED;
        break;
      case 38: // STRH immediate
        address = n(op) + ((op >> 5) & 0x3e);
        if (!inRam<u16>(address)) break;
        left -= 1;
        if (!put<u16>(address, d(op))) continue;
        why = CHANGED;
        break;
      case 39: // STRB immediate
        address = n(op) + ((op >> 6) & 31);
        if (!inRam<u8>(address)) break;
        left -= 1;
        if (!put<u8>(address, d(op))) continue;
        why = CHANGED;
        break;
      case 40: // STR, SP plus immediate
        address = get(13) + ((op & 0xff) << 2);
        if (!inRam<i32>(address)) break;
        left -= 1;
        if (!put<i32>(address, d8(op))) continue;
        why = CHANGED;
        break;
      case 41: // LDR register
        address = n(op) + m(op);
        if (!inRam<i32>(address)) break;
        setD(op, load<i32>(address));
        left -= 1;
        continue;
      case 42: // LDRH register
        address = n(op) + m(op);
        if (!inRam<u16>(address)) break;
        setD(op, load<u16>(address));
        left -= 1;
        continue;
      case 43: // LDRB register
        address = n(op) + m(op);
        if (!inRam<u8>(address)) break;
        setD(op, load<u8>(address));
        left -= 1;
        continue;
      case 44: // LDR immediate
        address = n(op) + ((op >> 4) & 0x7c);
        if (!inRam<i32>(address)) break;
        setD(op, load<i32>(address));
        left -= 1;
        continue;
      case 45: // LDRH immediate
        address = n(op) + ((op >> 5) & 0x3e);
        if (!inRam<u16>(address)) break;
        setD(op, load<u16>(address));
        left -= 1;
        continue;
      case 46: // LDRB immediate
        address = n(op) + ((op >> 6) & 31);
        if (!inRam<u8>(address)) break;
        setD(op, load<u8>(address));
        left -= 1;
        continue;
      case 47: // LDR, SP plus immediate
        address = get(13) + ((op & 0xff) << 2);
        if (!inRam<i32>(address)) break;
        setD8(op, load<i32>(address));
        left -= 1;
        continue;
      case 48: // LDRSH register
        address = n(op) + m(op);
        if (!inRam<i16>(address)) break;
        setD(op, load<i16>(address));
        left -= 1;
        continue;
      case 49: // LDRSB register
        address = n(op) + m(op);
        if (!inRam<i8>(address)) break;
        setD(op, load<i8>(address));
        left -= 1;
        continue;
      case 50: // ADR
        setD8(op, ((pc + 2) & ~3) + ((op & 0xff) << 2));
        continue;
      case 51: // ADD, register = SP plus immediate
        setD8(op, get(13) + ((op & 0xff) << 2));
        continue;
      case 52: // ADD to SP
        set(13, get(13) + ((op & 0x7f) << 2));
        continue;
      case 53: // SUB from SP
        set(13, get(13) - ((op & 0x7f) << 2));
        continue;
      case 54: // SXTH
        setD(op, <i32><i16>n(op));
        continue;
      case 55: // SXTB
        setD(op, <i32><i8>n(op));
        continue;
      case 56: // UXTH
        setD(op, n(op) & 0xffff);
        continue;
      case 57: // UXTB
        setD(op, n(op) & 0xff);
        continue;
      case 58: { // PUSH
        const count = popcnt(op & 0x1ff), bottom = get(13) - 4 * count;
        let offset = bottom - RAM, changes = false;
        if (!isStack(offset)) break;
        for (let list = op & 0xff; list; list &= list - 1, offset += 4) {
          if (put<i32>(RAM + offset, get(ctz(list)))) changes = true;
        }
        const link = (op >> 8) & 1;
        if (link && put<i32>(RAM + offset, get(14))) changes = true;
        set(13, bottom);
        if (<u32>bottom < load<u32>(LOWEST)) store<i32>(LOWEST, bottom);
        left -= count - link;
        if (!changes) continue;
        why = CHANGED;
        break;
      }
      case 59: { // POP without PC
        let offset = get(13) - RAM;
        if (!isStack(offset)) break;
        for (let list = op & 0xff; list; list &= list - 1, offset += 4) {
          set(ctz(list), load<i32>(offset, RAM));
        }
        set(13, RAM + offset);
        left -= popcnt(op & 0xff);
        continue;
      }
      case 60: { // POP with PC
        let offset = get(13) - RAM;
        if (!isStack(offset)) break;
        const count = popcnt(op & 0xff), target = load<i32>(offset + 4 * count, RAM);
        if (target >>> 28 == EXCEPTION_RETURN) break;
        for (let list = op & 0xff; list; list &= list - 1, offset += 4) {
          set(ctz(list), load<i32>(offset, RAM));
        }
        set(13, RAM + offset + 4);
        pc = target & ~1;
        left -= 2 + count;
        jumped = 1;
        continue;
      }
      case 61: // REV
        setD(op, bswap(n(op)));
        continue;
      case 62: // NOP
        if (op != 0xbf00) break;
        continue;
      case 63: { // STMIA
        const to = (op >> 8) & 7;
        let offset = get(to) - RAM, changes = false;
        if (!isStack(offset) || (offset & 3) != 0) break;
        for (let list = op & 0xff; list; list &= list - 1, offset += 4) {
          if (put<i32>(RAM + offset, get(ctz(list)))) changes = true;
        }
        set(to, RAM + offset);
        left -= popcnt(op & 0xff);
        if (!changes) continue;
        why = CHANGED;
        break;
      }
      case 64: { // LDMIA
        const from = (op >> 8) & 7;
        let offset = get(from) - RAM;
        if ((offset & 3) != 0) break;
        if (isStack(offset)) {
          for (let list = op & 0xff; list; list &= list - 1, offset += 4) {
            set(ctz(list), load<i32>(offset, RAM));
          }
        } else {
          if (<u32>(offset + RAM - FLASH) > FLASH_BYTES - MOST_LOADED) break;
          for (let list = op & 0xff; list; list &= list - 1, offset += 4) {
            left -= wait((RAM + offset) >> LINE_SHIFT);
            set(ctz(list), load<i32>(RAM + offset));
          }
        }
        if ((op & (1 << from)) == 0) set(from, RAM + offset);
        left -= popcnt(op & 0xff);
        continue;
      }
      case 65: // BEQ
        if (zero == 0) { pc += hop(op); left -= 1; jumped = 1; }
        continue;
      case 66: // BNE
        if (zero != 0) { pc += hop(op); left -= 1; jumped = 1; }
        continue;
      case 67: // BCS
        if (c != 0) { pc += hop(op); left -= 1; jumped = 1; }
        continue;
      case 68: // BCC
        if (c == 0) { pc += hop(op); left -= 1; jumped = 1; }
        continue;
      case 69: // BMI
        if (negative < 0) { pc += hop(op); left -= 1; jumped = 1; }
        continue;
      case 70: // BPL
        if (negative >= 0) { pc += hop(op); left -= 1; jumped = 1; }
        continue;
      case 71: // BVS
        if (v != 0) { pc += hop(op); left -= 1; jumped = 1; }
        continue;
      case 72: // BVC
        if (v == 0) { pc += hop(op); left -= 1; jumped = 1; }
        continue;
      case 73: // BHI
        if (c != 0 && zero != 0) { pc += hop(op); left -= 1; jumped = 1; }
        continue;
      case 74: // BLS
        if (c == 0 || zero == 0) { pc += hop(op); left -= 1; jumped = 1; }
        continue;
      case 75: // BGE
        if (negative >>> 31 == v) { pc += hop(op); left -= 1; jumped = 1; }
        continue;
      case 76: // BLT
        if (negative >>> 31 != v) { pc += hop(op); left -= 1; jumped = 1; }
        continue;
      case 77: // BGT
        if (zero != 0 && negative >>> 31 == v) { pc += hop(op); left -= 1; jumped = 1; }
        continue;
      case 78: // BLE
        if (zero == 0 || negative >>> 31 != v) { pc += hop(op); left -= 1; jumped = 1; }
        continue;
      case 79: // B
        pc += 2 + ((op << 21) >> 20);
        left -= 1;
        jumped = 1;
        continue;
      case 80: { // the wide ones: BL, MRS and MSR of PRIMASK, barriers
        const second = <i32>load<u16>(pc);
        if ((second & 0xd000) == 0xd000) { // BL
          const sign = (op << 21) >> 31; // all ones or zeros
          const i1 = ~((second >> 13) ^ sign) & 1, i2 = ~((second >> 11) ^ sign) & 1;
          set(14, (pc + 2) | 1);
          pc += 2 + ((sign << 24) | (i1 << 23) | (i2 << 22) | ((op & 0x3ff) << 12)
            | ((second & 0x7ff) << 1));
          left -= 2;
          jumped = 1;
          continue;
        }
        if (op == 0xf3ef && (second & 0xf0ff) == (0x8000 | SPECIAL_PRIMASK)) { // MRS
          set((second >> 8) & 15, load<i32>(PRIMASK));
          pc += 2;
          left -= 2;
          continue;
        }
        if ((op & 0xfff0) == 0xf380 && second == (0x8800 | SPECIAL_PRIMASK)) { // MSR
          const isMasked = get(op & 15) & 1;
          store<i32>(PRIMASK, isMasked);
          pc += 2;
          left -= 2;
          if (isMasked) continue;
          why = UNMASKED;
          break;
        }
        if (op == 0xf3bf && second >= 0x8f40 && second < 0x8f70) { // DSB, DMB, ISB
          pc += 2;
          left -= 2;
          continue;
        }
        break;
      }
      case 81: // CPSIE, CPSID
        if (op == 0xb662) {
          store<i32>(PRIMASK, 0);
          why = UNMASKED;
        } else if (op == 0xb672) {
          store<i32>(PRIMASK, 1);
          continue;
        }
        break;
      case 82: // SEV: nobody waits for it
        if (op != 0xbf40) break;
        continue;
    }
    if (why != SPENT) break;
    // What has not gone on by now is a load or store elsewhere, or a rare instruction.
    const kind = <i32>load<u8>(op >> 6, KINDS);
    why = RARE;
    if (kind >= STORES && kind < ACCESSES_END) {
      const number = (kind == STORE_AT_SP || kind == LOAD_AT_SP ? op >> 8 : op) & 7;
      const bytes = <i32>load<u8>(kind, SIZES - STORES);
      if (isNear(address)) {
        if (kind < LOADS) writeNear(address, get(number));
        else set(number, extended(kind, readNear(address)));
        why = SPENT;
        continue;
      }
      if (kind >= LOADS && isClock(address)) {
        set(number, extended(kind, readClock(address, left + 1)));
        left -= CLOCK_CYCLES - 1;
        why = SPENT;
        continue;
      }
      if (kind < LOADS) {
        why = STORE;
      } else if (<u32>(address - FLASH) < FLASH_BYTES && (address & (bytes - 1)) == 0) {
        set(number, extended(kind, load<i32>(address)));
        left -= 1 + wait(address >> LINE_SHIFT);
        why = SPENT;
        continue;
      } else {
        why = kind < SIGNED ? LOAD : LOAD_SIGNED;
      }
      store<i32>(ADDRESS, address);
      store<i32>(BYTES, bytes);
      store<i32>(NUMBER, number);
    }
    pc -= 2;
    left += 1;
    break;
  }
  store<i32>(APSR, (negative & <i32>0x80000000) | (i32(zero == 0) << 30) | (c << 29) | (v << 28));
  store<i32>(LINE, line);
  store<i32>(JUMPED, jumped);
  store<i32>(WHY, why);
  set(15, pc);
  return left;
}
