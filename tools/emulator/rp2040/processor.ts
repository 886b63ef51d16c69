// SPDX-License-Identifier: MIT
// The processor's instructions, in AssemblyScript (assemblyscript.org), which becomes WebAssembly:
// which takes two thirds of the time of JavaScript. core.mjs is the rest of the processor.
//
// `stretch` executes instructions until its cycles are spent. The clock stands still meanwhile. An
// access to what is neither RAM nor flash goes to core.mjs, which puts the clock right first. What
// becomes due by it (an alarm, an interrupt, a reset) ends the stretch, and so does a rare
// instruction: that is for rp2040js. Cycles are counted as rp2040js does, and besides them those
// that the processor waits for the flash.

// Memory that core.mjs and the rest of the chip see too, by these addresses in it.
export const ROM = memory.data(16384, 16);
export const RAM = memory.data(264 * 1024, 16);
export const FLASH = memory.data(2 * 1024 * 1024, 16);
export const REGISTERS = memory.data(16 * 4, 16);
export const STATE = memory.data(11 * 4, 16);
export const LINES = memory.data(1024 * 2 * 4, 16); // the cache (cache.mjs)

// The words of STATE, and where they are.
const APSR: usize = STATE; // the flags N, Z, C, V in the uppermost bits
const PRIMASK: usize = STATE + 4; // 1: interrupts are masked
const LOWEST: usize = STATE + 8; // where SP has been, counted at PUSH
const CHANGED: usize = STATE + 12; // core.mjs sets it: the stretch is to end
const RARE: usize = STATE + 16; // the next instruction is one for rp2040js
const MISS_CYCLES: usize = STATE + 20; // how long the processor waits for a line of the cache
const DIVIDEND: usize = STATE + 24; // of the divider, see below
const DIVISOR: usize = STATE + 28;
const QUOTIENT: usize = STATE + 32;
const REMAINDER: usize = STATE + 36;
const DIRTY: usize = STATE + 40;

const KINDS = memory.data(65536); // of each instruction, which case of the switch executes it

const ROM_BYTES: u32 = 16384, RAM_BYTES: u32 = 264 * 1024, FLASH_BYTES: u32 = 2 * 1024 * 1024;
const RAM_BASE = 0x20000000, FLASH_BASE = 0x10000000, FLASH_MASK = 2 * 1024 * 1024 - 1;
const CACHED = 0x10; // the first byte of the addresses of the flash, read through the cache
const LINE_SHIFT = 3; // of an address, to the number of its line
const SETS_MASK = 1023;
const REGION_MASK: i32 = 0xf0000000;
const EXCEPTION_RETURN = 15; // the first digit of its addresses
const SPECIAL_PRIMASK = 16; // the number of the special register
const ENOUGH = 1 << 30; // cycles: more than any stretch has. Taken off, they end it
const MOST_PUSHED: u32 = 36; // bytes

// core.mjs: access to what is neither RAM nor flash, `left` cycles before the end of the stretch.
@external("core", "read") declare function read(address: i32, bytes: i32, left: i32): i32;
@external("core", "write")
declare function write(address: i32, bytes: i32, value: i32, left: i32): void;
// Whether an interrupt that is no longer masked waits.
@external("core", "waits") declare function waits(): bool;
// Does not return.
@external("core", "lost") declare function lost(pc: i32): void;

// The kinds of instructions. Letters are bits of operands: i immediate, d m n registers, r a list.

function kind(number: u8, pattern: string): void {
  let mask = 0, value = 0;
  for (let i = 0; i < 16; i++) {
    const letter = pattern.charCodeAt(i), isOne = letter == 0x31;
    mask = (mask << 1) | i32(isOne || letter == 0x30);
    value = (value << 1) | i32(isOne);
  }
  // All that the other bits may be, from all ones down to none.
  for (let bits = ~mask & 0xffff; ; bits = (bits - 1) & ~mask) {
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
kind(37, "0101011mmmnnnddd"); kind(38, "0101100mmmnnnddd"); kind(39, "0101101mmmnnnddd");
kind(40, "0101110mmmnnnddd"); kind(41, "0101111mmmnnnddd"); kind(42, "01100iiiiinnnddd");
kind(43, "01101iiiiinnnddd"); kind(44, "01110iiiiinnnddd"); kind(45, "01111iiiiinnnddd");
kind(46, "10000iiiiinnnddd"); kind(47, "10001iiiiinnnddd"); kind(48, "10010dddiiiiiiii");
kind(49, "10011dddiiiiiiii"); kind(50, "10100dddiiiiiiii"); kind(51, "10101dddiiiiiiii");
kind(52, "101100000iiiiiii"); kind(53, "101100001iiiiiii"); kind(54, "1011001000nnnddd");
kind(55, "1011001001nnnddd"); kind(56, "1011001010nnnddd"); kind(57, "1011001011nnnddd");
kind(58, "1011010rrrrrrrrr"); kind(59, "10111100rrrrrrrr"); kind(60, "10111101rrrrrrrr");
kind(61, "1011101000nnnddd"); kind(62, "1011111100000000"); kind(63, "11000dddrrrrrrrr");
kind(64, "11001dddrrrrrrrr"); kind(65, "11010000iiiiiiii"); kind(66, "11010001iiiiiiii");
kind(67, "11010010iiiiiiii"); kind(68, "11010011iiiiiiii"); kind(69, "11010100iiiiiiii");
kind(70, "11010101iiiiiiii"); kind(71, "11010110iiiiiiii"); kind(72, "11010111iiiiiiii");
kind(73, "11011000iiiiiiii"); kind(74, "11011001iiiiiiii"); kind(75, "11011010iiiiiiii");
kind(76, "11011011iiiiiiii"); kind(77, "11011100iiiiiiii"); kind(78, "11011101iiiiiiii");
kind(79, "11100iiiiiiiiiii"); kind(80, "11110iiiiiiiiiii"); kind(81, "1011011001100010");
kind(82, "1011011001110010");

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

// The cycles that the processor waits for a line (cache.mjs says how the cache works).
@inline function wait(line: i32): i32 {
  const at = (line & SETS_MASK) << 3;
  const last = load<i32>(at, LINES);
  return last == line ? 0 : waitForOther(at, line, last);
}

function waitForOther(at: i32, line: i32, last: i32): i32 {
  const other = load<i32>(at, LINES + 4);
  store<i32>(at, line, LINES);
  store<i32>(at, last, LINES + 4);
  return other == line ? 0 : load<i32>(MISS_CYCLES);
}

// The same for the words of the registers in `list`, one after the other.
function waitForAll(address: i32, list: i32): i32 {
  let cycles = 0;
  for (; list; list &= list - 1, address += 4) cycles += wait(address >> LINE_SHIFT);
  return cycles;
}

// Loads and stores. `left`: the cycles that were left before the instruction.

let spent = 0; // by the last one, but for the first cycle

@inline function take<T>(address: i32, left: i32): i32 {
  const offset = address - RAM_BASE;
  const isAligned = (address & (sizeof<T>() - 1)) == 0;
  if (<u32>offset < RAM_BYTES && isAligned) {
    spent = 1;
    return load<T>(offset, RAM);
  }
  if (address >>> 24 == CACHED && isAligned) {
    spent = 1 + wait(address >> LINE_SHIFT);
    return load<T>(address & FLASH_MASK, FLASH);
  }
  return <T>takeFar(address, sizeof<T>(), left);
}

function takeFar(address: i32, bytes: i32, left: i32): i32 {
  if (isNear(address)) {
    spent = 0;
    return readNear(address);
  }
  const value = read(address, bytes, left), digit = address >>> 28;
  spent = (digit == 0xd ? 0 : digit == 4 ? 3 : 1) + (load<i32>(CHANGED) ? ENOUGH : 0);
  return value;
}

@inline function put<T>(address: i32, value: i32, left: i32): void {
  const offset = address - RAM_BASE;
  if (<u32>offset < RAM_BYTES && (address & (sizeof<T>() - 1)) == 0) {
    spent = 1;
    store<T>(offset, <T>value, RAM);
    return;
  }
  putFar(address, sizeof<T>(), value, left);
}

function putFar(address: i32, bytes: i32, value: i32, left: i32): void {
  if (isNear(address)) {
    spent = 0;
    return writeNear(address, value);
  }
  write(address, bytes, value, left);
  const digit = address >>> 28;
  spent = (digit == 0xd ? 0 : digit == 4 ? 4 : 1) + (load<i32>(CHANGED) ? ENOUGH : 0);
}

// Outside of the memories nothing is accessed as often as the core's number and its divider. That
// has divided at once (RP2040 data sheet, 2.3.1.1 and 2.3.1.5).

const CPUID: i32 = 0xd0000000, DIVIDER: i32 = 0xd0000060, DIVIDER_MASK = ~0x1f;

@inline function isNear(address: i32): bool {
  return (address & DIVIDER_MASK) == DIVIDER || address == CPUID;
}

function readNear(address: i32): i32 {
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

function writeNear(address: i32, value: i32): void {
  switch (address - DIVIDER) {
    case 0x00: case 0x08: store<i32>(DIVIDEND, value); divide((address & 8) != 0); break;
    case 0x04: case 0x0c: store<i32>(DIVISOR, value); divide((address & 8) != 0); break;
    case 0x10: store<i32>(QUOTIENT, value); break;
    case 0x14: store<i32>(REMAINDER, value); break;
    default: return;
  }
  store<i32>(DIRTY, 1);
}

function divide(isSigned: bool): void {
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

@inline function hop(op: i32): i32 { return 2 + ((op << 24) >> 23); }

@inline function isStack(offset: i32): bool {
  return <u32>offset <= RAM_BYTES - MOST_PUSHED;
}

// Where the code of a region is in this memory, less its first address; how much there is.
function placeOf(region: i32): i32 {
  return <i32>(region == RAM_BASE ? RAM : region == FLASH_BASE ? FLASH : ROM) - region;
}

function bytesOf(region: i32): u32 {
  switch (region) {
    case 0: return ROM_BYTES;
    case FLASH_BASE: return FLASH_BYTES;
    case RAM_BASE: return RAM_BYTES;
  }
  return 0;
}

// Takes the cycles that are left, returns those that remain (or were taken too many). One function
// and long: each call would cost more than the instruction.
export function stretch(left: i32): i32 {
  let pc = get(15) & ~1; // of the next instruction
  let region = pc & REGION_MASK;
  let place = placeOf(region);
  let bytes = bytesOf(region);
  let line = -1; // from which the last instruction came
  const flags = load<i32>(APSR);
  let negative = flags; // below 0: N is set
  let zero = ~flags & 0x40000000; // 0: Z is set
  let c = (flags >>> 29) & 1;
  let v = (flags >>> 28) & 1;
  let isRare = false;
  while (left > 0) {
    if (pc >> LINE_SHIFT != line) {
      line = pc >> LINE_SHIFT;
      if (<u32>(pc - region) >= bytes) { // a jump to another region
        region = pc & REGION_MASK;
        place = placeOf(region);
        bytes = bytesOf(region);
        if (<u32>(pc - region) >= bytes) lost(pc);
      }
      if (region == FLASH_BASE) {
        left -= wait(line);
        if (left <= 0) break; // something is due before the line has come
      }
    }
    const op = <i32>load<u16>(pc + place);
    // Every instruction takes a cycle and is followed by the next; what differs says so below.
    left -= 1;
    pc += 2;
    switch (<i32>load<u8>(op, KINDS)) {
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
        } else {
          set(to, to == 13 ? value & ~3 : value);
        }
        continue;
      }
      case 31: { // BX
        const target = get((op >> 3) & 15);
        if (target >>> 28 == EXCEPTION_RETURN) break;
        pc = target & ~1;
        left -= 1;
        continue;
      }
      case 32: { // BLX
        const target = get((op >> 3) & 15);
        set(14, pc | 1);
        pc = target & ~1;
        left -= 1;
        continue;
      }
      case 33: { // LDR literal
        const address = ((pc + 2) & ~3) + ((op & 0xff) << 2);
        setD8(op, load<i32>(address + place));
        if (region == FLASH_BASE) left -= wait(address >> LINE_SHIFT);
        left -= 1;
        continue;
      }
      case 34: // STR register
        put<i32>(n(op) + m(op), d(op), left + 1);
        left -= spent;
        continue;
      case 35: // STRH register
        put<u16>(n(op) + m(op), d(op), left + 1);
        left -= spent;
        continue;
      case 36: // STRB register
        put<u8>(n(op) + m(op), d(op), left + 1);
        left -= spent;
        continue;
      case 37: // LDRSB register
        setD(op, take<i8>(n(op) + m(op), left + 1));
        left -= spent;
        continue;
      case 38: // LDR register
        setD(op, take<i32>(n(op) + m(op), left + 1));
        left -= spent;
        continue;
      case 39: // LDRH register
        setD(op, take<u16>(n(op) + m(op), left + 1));
        left -= spent;
        continue;
      case 40: // LDRB register
        setD(op, take<u8>(n(op) + m(op), left + 1));
        left -= spent;
        continue;
      case 41: // LDRSH register
        setD(op, take<i16>(n(op) + m(op), left + 1));
        left -= spent;
        continue;
      case 42: // STR immediate
        put<i32>(n(op) + ((op >> 4) & 0x7c), d(op), left + 1);
        left -= spent;
        continue;
      case 43: // LDR immediate
        setD(op, take<i32>(n(op) + ((op >> 4) & 0x7c), left + 1));
        left -= spent;
        continue;
      case 44: // STRB immediate
        put<u8>(n(op) + ((op >> 6) & 31), d(op), left + 1);
        left -= spent;
        continue;
      case 45: // LDRB immediate
        setD(op, take<u8>(n(op) + ((op >> 6) & 31), left + 1));
        left -= spent;
        continue;
      case 46: // STRH immediate
        put<u16>(n(op) + ((op >> 5) & 0x3e), d(op), left + 1);
        left -= spent;
        continue;
      case 47: // LDRH immediate
        setD(op, take<u16>(n(op) + ((op >> 5) & 0x3e), left + 1));
        left -= spent;
        continue;
      case 48: // STR, SP plus immediate
        put<i32>(get(13) + ((op & 0xff) << 2), d8(op), left + 1);
        left -= spent;
        continue;
      case 49: // LDR, SP plus immediate
        setD8(op, take<i32>(get(13) + ((op & 0xff) << 2), left + 1));
        left -= spent;
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
        let offset = bottom - RAM_BASE;
        if (!isStack(offset)) break;
        for (let i = 0; i < 8; i++) {
          if ((op & (1 << i)) == 0) continue;
          store<i32>(offset, get(i), RAM);
          offset += 4;
        }
        const link = (op >> 8) & 1;
        if (link) store<i32>(offset, get(14), RAM);
        set(13, bottom);
        if (<u32>bottom < load<u32>(LOWEST)) store<i32>(LOWEST, bottom);
        left -= count - link;
        continue;
      }
      case 59: { // POP without PC
        let offset = get(13) - RAM_BASE;
        if (!isStack(offset)) break;
        for (let i = 0; i < 8; i++) {
          if ((op & (1 << i)) == 0) continue;
          set(i, load<i32>(offset, RAM));
          offset += 4;
        }
        set(13, RAM_BASE + offset);
        left -= popcnt(op & 0xff);
        continue;
      }
      case 60: { // POP with PC
        let offset = get(13) - RAM_BASE;
        if (!isStack(offset)) break;
        const count = popcnt(op & 0xff), target = load<i32>(offset + 4 * count, RAM);
        if (target >>> 28 == EXCEPTION_RETURN) break;
        for (let i = 0; i < 8; i++) {
          if ((op & (1 << i)) == 0) continue;
          set(i, load<i32>(offset, RAM));
          offset += 4;
        }
        set(13, RAM_BASE + offset + 4);
        pc = target & ~1;
        left -= 2 + count;
        continue;
      }
      case 61: // REV
        setD(op, bswap(n(op)));
        continue;
      case 62: // NOP
        continue;
      case 63: { // STMIA
        const to = (op >> 8) & 7;
        let offset = get(to) - RAM_BASE;
        if (!isStack(offset) || (offset & 3) != 0) break;
        for (let i = 0; i < 8; i++) {
          if ((op & (1 << i)) == 0) continue;
          store<i32>(offset, get(i), RAM);
          offset += 4;
        }
        set(to, RAM_BASE + offset);
        left -= popcnt(op & 0xff);
        continue;
      }
      case 64: { // LDMIA
        const from = (op >> 8) & 7;
        let offset = get(from) - RAM_BASE;
        if (!isStack(offset) || (offset & 3) != 0) {
          if (get(from) >>> 24 == CACHED) left -= waitForAll(get(from), op & 0xff);
          break;
        }
        for (let i = 0; i < 8; i++) {
          if ((op & (1 << i)) == 0) continue;
          set(i, load<i32>(offset, RAM));
          offset += 4;
        }
        if ((op & (1 << from)) == 0) set(from, RAM_BASE + offset);
        left -= popcnt(op & 0xff);
        continue;
      }
      case 65: // BEQ
        if (zero == 0) { pc += hop(op); left -= 1; }
        continue;
      case 66: // BNE
        if (zero != 0) { pc += hop(op); left -= 1; }
        continue;
      case 67: // BCS
        if (c != 0) { pc += hop(op); left -= 1; }
        continue;
      case 68: // BCC
        if (c == 0) { pc += hop(op); left -= 1; }
        continue;
      case 69: // BMI
        if (negative < 0) { pc += hop(op); left -= 1; }
        continue;
      case 70: // BPL
        if (negative >= 0) { pc += hop(op); left -= 1; }
        continue;
      case 71: // BVS
        if (v != 0) { pc += hop(op); left -= 1; }
        continue;
      case 72: // BVC
        if (v == 0) { pc += hop(op); left -= 1; }
        continue;
      case 73: // BHI
        if (c != 0 && zero != 0) { pc += hop(op); left -= 1; }
        continue;
      case 74: // BLS
        if (c == 0 || zero == 0) { pc += hop(op); left -= 1; }
        continue;
      case 75: // BGE
        if (negative >>> 31 == v) { pc += hop(op); left -= 1; }
        continue;
      case 76: // BLT
        if (negative >>> 31 != v) { pc += hop(op); left -= 1; }
        continue;
      case 77: // BGT
        if (zero != 0 && negative >>> 31 == v) { pc += hop(op); left -= 1; }
        continue;
      case 78: // BLE
        if (zero == 0 || negative >>> 31 != v) { pc += hop(op); left -= 1; }
        continue;
      case 79: // B
        pc += 2 + ((op << 21) >> 20);
        left -= 1;
        continue;
      case 80: { // the wide ones: BL, MRS and MSR of PRIMASK, barriers
        const second = <i32>load<u16>(pc + place);
        if ((second & 0xd000) == 0xd000) { // BL
          const sign = (op << 21) >> 31; // all ones or zeros
          const i1 = ~((second >> 13) ^ sign) & 1, i2 = ~((second >> 11) ^ sign) & 1;
          set(14, (pc + 2) | 1);
          pc += 2 + ((sign << 24) | (i1 << 23) | (i2 << 22) | ((op & 0x3ff) << 12)
            | ((second & 0x7ff) << 1));
          left -= 2;
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
          if (!isMasked && waits()) left -= ENOUGH;
          continue;
        }
        if (op == 0xf3bf && second >= 0x8f40 && second < 0x8f70) { // DSB, DMB, ISB
          pc += 2;
          left -= 2;
          continue;
        }
        break;
      }
      case 81: // CPSIE
        store<i32>(PRIMASK, 0);
        if (waits()) left -= ENOUGH;
        continue;
      case 82: // CPSID
        store<i32>(PRIMASK, 1);
        continue;
    }
    // What has not gone on by now is for rp2040js.
    pc -= 2;
    left += 1;
    isRare = true;
    break;
  }
  store<i32>(APSR, (negative & <i32>0x80000000) | (i32(zero == 0) << 30) | (c << 29) | (v << 28));
  store<i32>(RARE, i32(isRare));
  set(15, pc);
  return load<i32>(CHANGED) ? left + ENOUGH : left;
}
