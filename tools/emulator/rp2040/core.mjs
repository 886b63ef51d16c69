// SPDX-License-Identifier: MIT
// The processor, fast: instructions that matter are executed here, many at a stretch; rare ones,
// exceptions and everything else of a processor are left to rp2040js's core.
//
// A stretch ends at the next alarm of the clock. The clock stands still meanwhile and is put right
// before anything outside of RAM, flash and ROM is touched, so that each access happens at the
// very instant at which it would if the clock ticked for each instruction. Whatever such an access
// makes due (an alarm, an interrupt, a reset) ends the stretch. Cycles are counted as rp2040js
// does, and besides them those that it waits for the flash (cache.mjs).
import { LINE_SHIFT } from './cache.mjs';
import { CortexM0Core } from './library.mjs';

const CYCLE_NANOS = 8;
const STRETCH_CYCLES = 1 << 24;
const RAM = 0x20000000, RAM_BYTES = 264 * 1024;
const FLASH = 0x10; // the first byte of its addresses, where it is read through the cache
const FLASH_MASK = 2 * 1024 * 1024 - 1, ROM_BYTES = 16384;
const FLASH_WINDOWS = 4; // 0x10000000 ... 0x13ffffff: the flash, cached or not; in 64 MiB
const EXCEPTION_RETURN = 15; // the first digit of its addresses
const PRIMASK = 16; // the number of the special register

// Which case of the switch below executes an instruction; 0 is rp2040js. (V8 makes a jump table
// only of numbers that are written as such, so the names stand beside them.)
const INSTRUCTIONS = [
  [1, '00000iiiiimmmddd'], [2, '00001iiiiimmmddd'], [3, '00010iiiiimmmddd'],
  [4, '0001100mmmnnnddd'], [5, '0001101mmmnnnddd'], [6, '0001110iiinnnddd'],
  [7, '0001111iiinnnddd'], [8, '00100dddiiiiiiii'], [9, '00101nnniiiiiiii'],
  [10, '00110dddiiiiiiii'], [11, '00111dddiiiiiiii'], [12, '0100000000mmmddd'],
  [13, '0100000001mmmddd'], [14, '0100000010mmmddd'], [15, '0100000011mmmddd'],
  [16, '0100000100mmmddd'], [17, '0100000101mmmddd'], [18, '0100000110mmmddd'],
  [19, '0100000111mmmddd'], [20, '0100001000mmmnnn'], [21, '0100001001mmmddd'],
  [22, '0100001010mmmnnn'], [23, '0100001011mmmnnn'], [24, '0100001100mmmddd'],
  [25, '0100001101mmmddd'], [26, '0100001110mmmddd'], [27, '0100001111mmmddd'],
  [28, '01000100dmmmmddd'], [29, '01000101nmmmmnnn'], [30, '01000110dmmmmddd'],
  [31, '010001110mmmm000'], [32, '010001111mmmm000'], [33, '01001dddiiiiiiii'],
  [34, '0101000mmmnnnddd'], [35, '0101001mmmnnnddd'], [36, '0101010mmmnnnddd'],
  [37, '0101011mmmnnnddd'], [38, '0101100mmmnnnddd'], [39, '0101101mmmnnnddd'],
  [40, '0101110mmmnnnddd'], [41, '0101111mmmnnnddd'], [42, '01100iiiiinnnddd'],
  [43, '01101iiiiinnnddd'], [44, '01110iiiiinnnddd'], [45, '01111iiiiinnnddd'],
  [46, '10000iiiiinnnddd'], [47, '10001iiiiinnnddd'], [48, '10010dddiiiiiiii'],
  [49, '10011dddiiiiiiii'], [50, '10100dddiiiiiiii'], [51, '10101dddiiiiiiii'],
  [52, '101100000iiiiiii'], [53, '101100001iiiiiii'], [54, '1011001000mmmddd'],
  [55, '1011001001mmmddd'], [56, '1011001010mmmddd'], [57, '1011001011mmmddd'],
  [58, '1011010lrrrrrrrr'], [59, '10111100rrrrrrrr'], [60, '10111101rrrrrrrr'],
  [61, '1011101000mmmddd'], [62, '1011111100000000'], [63, '11000nnnrrrrrrrr'],
  [64, '11001nnnrrrrrrrr'], [65, '11010000iiiiiiii'], [66, '11010001iiiiiiii'],
  [67, '11010010iiiiiiii'], [68, '11010011iiiiiiii'], [69, '11010100iiiiiiii'],
  [70, '11010101iiiiiiii'], [71, '11010110iiiiiiii'], [72, '11010111iiiiiiii'],
  [73, '11011000iiiiiiii'], [74, '11011001iiiiiiii'], [75, '11011010iiiiiiii'],
  [76, '11011011iiiiiiii'], [77, '11011100iiiiiiii'], [78, '11011101iiiiiiii'],
  [79, '11100iiiiiiiiiii'], [80, '11110iiiiiiiiiii'], [81, '1011011001100010'],
  [82, '1011011001110010'],
];

function decodeTable() {
  const table = new Uint8Array(65536);
  for (const [number, pattern] of INSTRUCTIONS) {
    const mask = parseInt(pattern.replace(/[01]/g, '1').replace(/[a-z]/g, '0'), 2);
    const value = parseInt(pattern.replace(/[a-z]/g, '0'), 2);
    for (let opcode = 0; opcode < 65536; opcode++) {
      if ((opcode & mask) === value) table[opcode] = number;
    }
  }
  return table;
}

export const DECODE = decodeTable();

// The cycles of a load or store, the instruction itself included.
const readCycles = (address) => {
  const digit = address >>> 28;
  return digit === 0xd ? 1 : digit === 4 ? 4 : 2;
};
const writeCycles = (address) => {
  const digit = address >>> 28;
  return digit === 0xd ? 1 : digit === 4 ? 5 : 2;
};

// What is a HardFault on the chip.
export class Fault extends Error {}

export class Core extends CortexM0Core {
  constructor(mcu, cache) {
    super(mcu);
    this.cache = cache;
    this.leave = false; // the stretch is to end: the chip is about to be reset
    this.changed = false; // ... something has become due
    this.rare = false; // ... the next instruction is one for rp2040js
    this.start = 0; // of the stretch: its instant, and how many cycles it may take
    this.budget = 0;
    this.lowest = Infinity; // where SP has been in this mode, counted at PUSH
    this.depths = { program: 0, handlers: 0 }; // of the stack, bytes
    this.entered = 0; // SP when the handler interrupted the program
    this.signed = new Int32Array(this.registers.buffer);
    this.ram8 = mcu.sram;
    this.ram16 = new Uint16Array(mcu.sram.buffer);
    this.ram32 = new Int32Array(mcu.sram.buffer);
    this.flash8 = mcu.flash;
    this.flash16 = new Uint16Array(mcu.flash.buffer);
    this.flash32 = new Int32Array(mcu.flash.buffer);
    this.rom16 = new Uint16Array(mcu.bootrom.buffer);
    this.rom32 = new Int32Array(mcu.bootrom.buffer);
  }

  // Asleep with interrupts masked, the processor wakes but takes none (rp2040js takes it).
  checkForInterrupts() {
    if (this.waiting && this.PM) {
      const pending = this.pendingInterrupts & this.enabledInterrupts;
      return !!pending || this.pendingPendSV || this.pendingSystick || this.pendingNMI;
    }
    return super.checkForInterrupts();
  }

  // The greatest depths of the stack since the last call: of the program, below the end of the RAM,
  // and of the handlers, below where they interrupted it. An interrupt may come anywhere.
  takeDepths() {
    this.noteDepth();
    const { depths } = this;
    this.depths = { program: 0, handlers: 0 };
    return depths;
  }

  noteDepth() {
    const { depths, lowest } = this;
    if (lowest === Infinity) return;
    if (this.IPSR) depths.handlers = Math.max(depths.handlers, this.entered - lowest);
    else depths.program = Math.max(depths.program, RAM + RAM_BYTES - lowest);
    this.lowest = Infinity;
  }

  exceptionEntry(number) {
    this.noteDepth();
    if (!this.IPSR) this.entered = this.SP;
    super.exceptionEntry(number);
  }

  exceptionReturn(how) {
    this.noteDepth();
    super.exceptionReturn(how);
  }

  get anyPending() {
    return (this.pendingInterrupts & this.enabledInterrupts) !== 0 || this.pendingPendSV
      || this.pendingSystick || this.pendingSVCall || this.pendingNMI;
  }

  get inFlash() {
    return this.signed[15] >>> 28 === 1;
  }

  // Access to what is outside of RAM. `left`: the cycles of the stretch that are not yet spent.

  before(left) {
    this.rp2040.clock.nanosCounter = this.start + (this.budget - left) * CYCLE_NANOS;
  }

  after() {
    this.changed = this.leave || this.interruptsUpdated || this.waiting
      || this.rp2040.clock.dueAt < this.start + this.budget * CYCLE_NANOS;
  }

  // Throws where the chip has a HardFault: unaligned, where nothing is, into the flash.
  check(address, bytes, writing) {
    const digit = address >>> 28;
    const there = digit >= 4 ? digit <= 5 || digit === 0xd || digit === 0xe
      : digit === 1 && (!writing || address >>> 26 !== FLASH_WINDOWS);
    if (there && (address & (bytes - 1)) === 0) return;
    const how = writing ? 'writes to' : 'reads from';
    throw new Fault(`the program ${how} ${(address >>> 0).toString(16)}, ${bytes} bytes`);
  }

  load32(address, left) {
    if ((address & 3) === 0) {
      if (address >>> 26 === FLASH_WINDOWS) return this.flash32[(address & FLASH_MASK) >> 2];
      if (address >>> 0 < ROM_BYTES) return this.rom32[address >> 2];
    }
    this.check(address, 4, false);
    this.before(left);
    const value = address >>> 28 === 0xd ? this.rp2040.sio.readUint32(address & 0xfffffff)
      : this.rp2040.readUint32(address >>> 0);
    this.after();
    return value | 0;
  }

  load16(address, left) {
    if (address & 1) this.check(address, 2, false);
    const word = this.load32(address & ~3, left);
    return address & 2 ? word >>> 16 : word & 0xffff;
  }

  load8(address, left) {
    return (this.load32(address & ~3, left) >>> (8 * (address & 3))) & 0xff;
  }

  store32(address, value, left) {
    if (address >>> 0 < ROM_BYTES) return; // the USB driver does that; the chip ignores it
    this.check(address, 4, true);
    this.before(left);
    if (address >>> 28 === 0xd) this.rp2040.sio.writeUint32(address & 0xfffffff, value >>> 0);
    else this.rp2040.writeUint32(address >>> 0, value >>> 0);
    this.after();
  }

  store16(address, value, left) {
    if (address >>> 0 < ROM_BYTES) return;
    this.check(address, 2, true);
    this.before(left);
    this.rp2040.writeUint16(address >>> 0, value & 0xffff);
    this.after();
  }

  store8(address, value, left) {
    if (address >>> 0 < ROM_BYTES) return;
    this.check(address, 1, true);
    this.before(left);
    this.rp2040.writeUint8(address >>> 0, value & 0xff);
    this.after();
  }

  // The cycles that LDMIA waits for the words of the registers in `list`, one after the other.
  waitForAll(address, list) {
    let cycles = 0;
    for (; list; list &= list - 1, address += 4) cycles += this.cache.wait(address >> LINE_SHIFT);
    return cycles;
  }

  // Where instructions at `address` are.
  codeAt(address) {
    switch (address >>> 28) {
      case 0: return this.rom16;
      case 1: return this.flash16;
      case 2: return this.ram16;
    }
    throw new Fault(`the program has run to ${(address >>> 0).toString(16)}, where no code is`);
  }

  // Executes instructions until the instant, or until an alarm or an interrupt is due.
  run(until) {
    const { clock } = this.rp2040;
    this.leave = false;
    if (this.interruptsUpdated && this.checkForInterrupts()) this.waiting = false;
    this.start = clock.nanosCounter;
    const cycles = Math.ceil((Math.min(until, clock.dueAt) - this.start) / CYCLE_NANOS);
    if (cycles <= 0) return;
    this.budget = Math.min(cycles, STRETCH_CYCLES);
    this.changed = false;
    const left = this.stretch(this.budget | 0);
    clock.nanosCounter = this.start + (this.budget - left) * CYCLE_NANOS;
    if (this.rare) clock.nanosCounter += super.executeInstruction() * CYCLE_NANOS;
  }

  // Returns the cycles that are left (or were taken too many); `rare` is set when it stopped
  // before an instruction that is for rp2040js. One function and long: each call would cost more
  // than the instruction. A case ends by `continue`; by `break` where something may have become
  // due.
  stretch(left) {
    const r = this.signed;
    const { ram8, ram16, ram32, flash8, flash16, flash32, cache } = this;
    let pc = r[15] & ~1;
    let code = this.codeAt(pc);
    let base = pc & 0xf0000000;
    let n = this.N ? -1 : 0; // negative: N is set
    let z = this.Z ? 0 : 1; // zero: Z is set
    let c = this.C ? 1 : 0;
    let v = this.V ? 1 : 0;
    let unspent = 0;
    this.rare = false;
    let line = -1; // from which the last instruction came
    while (left > 0) {
      if (pc >> LINE_SHIFT !== line) {
        line = pc >> LINE_SHIFT;
        if (base === FLASH << 24) {
          left -= cache.wait(line);
          if (left <= 0) break; // something is due before the line has come
        }
      }
      const op = code[(pc - base) >> 1];
      switch (DECODE[op]) {
        case 1: { // LSLS immediate
          const count = (op >> 6) & 31;
          const value = r[(op >> 3) & 7];
          if (count) c = (value >>> (32 - count)) & 1;
          n = z = r[op & 7] = value << count;
          pc += 2; left -= 1; continue;
        }
        case 2: { // LSRS immediate
          const count = (op >> 6) & 31;
          const value = r[(op >> 3) & 7];
          c = (value >>> ((count - 1) & 31)) & 1;
          n = z = r[op & 7] = count ? value >>> count : 0;
          n |= 0; pc += 2; left -= 1; continue;
        }
        case 3: { // ASRS immediate
          const count = ((op >> 6) & 31) || 32;
          const value = r[(op >> 3) & 7];
          c = (value >> (count - 1)) & 1;
          n = z = r[op & 7] = value >> (count < 32 ? count : 31);
          pc += 2; left -= 1; continue;
        }
        case 4: { // ADDS register
          const one = r[(op >> 3) & 7], other = r[(op >> 6) & 7];
          const sum = (one + other) | 0;
          c = sum >>> 0 < one >>> 0 ? 1 : 0;
          v = ((one ^ sum) & (other ^ sum)) >>> 31;
          n = z = r[op & 7] = sum;
          pc += 2; left -= 1; continue;
        }
        case 5: { // SUBS register
          const one = r[(op >> 3) & 7], other = r[(op >> 6) & 7];
          const rest = (one - other) | 0;
          c = one >>> 0 >= other >>> 0 ? 1 : 0;
          v = ((one ^ other) & (one ^ rest)) >>> 31;
          n = z = r[op & 7] = rest;
          pc += 2; left -= 1; continue;
        }
        case 6: { // ADDS immediate, 3 bits
          const one = r[(op >> 3) & 7], other = (op >> 6) & 7;
          const sum = (one + other) | 0;
          c = sum >>> 0 < one >>> 0 ? 1 : 0;
          v = (~one & sum) >>> 31;
          n = z = r[op & 7] = sum;
          pc += 2; left -= 1; continue;
        }
        case 7: { // SUBS immediate, 3 bits
          const one = r[(op >> 3) & 7], other = (op >> 6) & 7;
          const rest = (one - other) | 0;
          c = one >>> 0 >= other ? 1 : 0;
          v = (one & ~rest) >>> 31;
          n = z = r[op & 7] = rest;
          pc += 2; left -= 1; continue;
        }
        case 8: // MOVS immediate
          n = z = r[(op >> 8) & 7] = op & 0xff;
          pc += 2; left -= 1; continue;
        case 9: { // CMP immediate
          const one = r[(op >> 8) & 7], other = op & 0xff;
          const rest = (one - other) | 0;
          c = one >>> 0 >= other ? 1 : 0;
          v = (one & ~rest) >>> 31;
          n = z = rest;
          pc += 2; left -= 1; continue;
        }
        case 10: { // ADDS immediate, 8 bits
          const one = r[(op >> 8) & 7];
          const sum = (one + (op & 0xff)) | 0;
          c = sum >>> 0 < one >>> 0 ? 1 : 0;
          v = (~one & sum) >>> 31;
          n = z = r[(op >> 8) & 7] = sum;
          pc += 2; left -= 1; continue;
        }
        case 11: { // SUBS immediate, 8 bits
          const one = r[(op >> 8) & 7], other = op & 0xff;
          const rest = (one - other) | 0;
          c = one >>> 0 >= other ? 1 : 0;
          v = (one & ~rest) >>> 31;
          n = z = r[(op >> 8) & 7] = rest;
          pc += 2; left -= 1; continue;
        }
        case 12: // ANDS
          n = z = r[op & 7] &= r[(op >> 3) & 7];
          pc += 2; left -= 1; continue;
        case 13: // EORS
          n = z = r[op & 7] ^= r[(op >> 3) & 7];
          pc += 2; left -= 1; continue;
        case 14: { // LSLS register
          const count = r[(op >> 3) & 7] & 0xff;
          const value = r[op & 7];
          if (count) c = count <= 32 ? (value >>> (32 - count)) & 1 : 0;
          n = z = r[op & 7] = count < 32 ? value << count : 0;
          pc += 2; left -= 1; continue;
        }
        case 15: { // LSRS register
          const count = r[(op >> 3) & 7] & 0xff;
          const value = r[op & 7];
          if (count) c = count <= 32 ? (value >>> (count - 1)) & 1 : 0;
          n = z = r[op & 7] = count < 32 ? (value >>> count) | 0 : 0;
          pc += 2; left -= 1; continue;
        }
        case 16: { // ASRS register
          const count = r[(op >> 3) & 7] & 0xff;
          const value = r[op & 7];
          if (count) c = (value >> (count < 32 ? count - 1 : 31)) & 1;
          n = z = r[op & 7] = value >> (count < 32 ? count : 31);
          pc += 2; left -= 1; continue;
        }
        case 17: { // ADCS
          const one = r[op & 7], other = r[(op >> 3) & 7];
          const sum = (one >>> 0) + (other >>> 0) + c;
          const low = sum | 0;
          c = sum > 0xffffffff ? 1 : 0;
          v = ((one ^ low) & (other ^ low)) >>> 31;
          n = z = r[op & 7] = low;
          pc += 2; left -= 1; continue;
        }
        case 18: { // SBCS
          const one = r[op & 7], other = ~r[(op >> 3) & 7];
          const sum = (one >>> 0) + (other >>> 0) + c;
          const low = sum | 0;
          c = sum > 0xffffffff ? 1 : 0;
          v = ((one ^ low) & (other ^ low)) >>> 31;
          n = z = r[op & 7] = low;
          pc += 2; left -= 1; continue;
        }
        case 19: { // RORS
          const count = r[(op >> 3) & 7] & 0xff;
          const value = r[op & 7];
          const turned = (value >>> (count & 31)) | (value << (-count & 31));
          if (count) c = turned >>> 31;
          n = z = r[op & 7] = count & 31 ? turned : value;
          pc += 2; left -= 1; continue;
        }
        case 20: // TST
          n = z = r[op & 7] & r[(op >> 3) & 7];
          pc += 2; left -= 1; continue;
        case 21: { // RSBS
          const other = r[(op >> 3) & 7];
          const rest = -other | 0;
          c = other === 0 ? 1 : 0;
          v = (other & rest) >>> 31;
          n = z = r[op & 7] = rest;
          pc += 2; left -= 1; continue;
        }
        case 22: { // CMP register
          const one = r[op & 7], other = r[(op >> 3) & 7];
          const rest = (one - other) | 0;
          c = one >>> 0 >= other >>> 0 ? 1 : 0;
          v = ((one ^ other) & (one ^ rest)) >>> 31;
          n = z = rest;
          pc += 2; left -= 1; continue;
        }
        case 23: { // CMN
          const one = r[op & 7], other = r[(op >> 3) & 7];
          const sum = (one + other) | 0;
          c = sum >>> 0 < one >>> 0 ? 1 : 0;
          v = ((one ^ sum) & (other ^ sum)) >>> 31;
          n = z = sum;
          pc += 2; left -= 1; continue;
        }
        case 24: // ORRS
          n = z = r[op & 7] |= r[(op >> 3) & 7];
          pc += 2; left -= 1; continue;
        case 25: // MULS
          n = z = r[op & 7] = Math.imul(r[op & 7], r[(op >> 3) & 7]);
          pc += 2; left -= 1; continue;
        case 26: // BICS
          n = z = r[op & 7] &= ~r[(op >> 3) & 7];
          pc += 2; left -= 1; continue;
        case 27: // MVNS
          n = z = r[op & 7] = ~r[(op >> 3) & 7];
          pc += 2; left -= 1; continue;
        case 28: { // ADD, any register
          const to = ((op >> 4) & 8) | (op & 7);
          r[15] = pc + 4;
          const sum = (r[to] + r[(op >> 3) & 15]) | 0;
          if (to === 15) {
            pc = sum & ~1;
            left -= 2;
            if (((pc ^ base) & 0xf0000000) !== 0) {
              code = this.codeAt(pc);
              base = pc & 0xf0000000;
            }
            continue;
          }
          r[to] = to === 13 ? sum & ~3 : sum;
          pc += 2; left -= 1; continue;
        }
        case 29: { // CMP, any register
          r[15] = pc + 4;
          const one = r[((op >> 4) & 8) | (op & 7)], other = r[(op >> 3) & 15];
          const rest = (one - other) | 0;
          c = one >>> 0 >= other >>> 0 ? 1 : 0;
          v = ((one ^ other) & (one ^ rest)) >>> 31;
          n = z = rest;
          pc += 2; left -= 1; continue;
        }
        case 30: { // MOV, any register
          const to = ((op >> 4) & 8) | (op & 7);
          r[15] = pc + 4;
          const value = r[(op >> 3) & 15];
          if (to === 15) {
            pc = value & ~1;
            left -= 2;
            if (((pc ^ base) & 0xf0000000) !== 0) {
              code = this.codeAt(pc);
              base = pc & 0xf0000000;
            }
            continue;
          }
          r[to] = to === 13 ? value & ~3 : value;
          pc += 2; left -= 1; continue;
        }
        case 31: { // BX
          const target = r[(op >> 3) & 15];
          if (target >>> 28 === EXCEPTION_RETURN) {
            this.rare = true;
            break;
          }
          pc = target & ~1;
          left -= 2;
          if (((pc ^ base) & 0xf0000000) !== 0) {
            code = this.codeAt(pc);
            base = pc & 0xf0000000;
          }
          continue;
        }
        case 32: { // BLX
          const target = r[(op >> 3) & 15];
          r[14] = (pc + 2) | 1;
          pc = target & ~1;
          left -= 2;
          if (((pc ^ base) & 0xf0000000) !== 0) {
            code = this.codeAt(pc);
            base = pc & 0xf0000000;
          }
          continue;
        }
        case 33: { // LDR literal
          const at = ((pc + 4) & ~3) + ((op & 0xff) << 2) - base;
          r[(op >> 8) & 7] = code[at >> 1] | (code[(at >> 1) + 1] << 16);
          if (base === FLASH << 24) left -= cache.wait((base + at) >> LINE_SHIFT);
          pc += 2; left -= 2; continue;
        }
        case 34: { // STR register
          const address = (r[(op >> 3) & 7] + r[(op >> 6) & 7]) | 0;
          const offset = (address - RAM) | 0;
          pc += 2;
          if (offset >>> 0 < RAM_BYTES && (address & 3) === 0) {
            ram32[offset >> 2] = r[op & 7];
            left -= 2; continue;
          }
          this.store32(address, r[op & 7], left);
          left -= writeCycles(address);
          break;
        }
        case 35: { // STRH register
          const address = (r[(op >> 3) & 7] + r[(op >> 6) & 7]) | 0;
          const offset = (address - RAM) | 0;
          pc += 2;
          if (offset >>> 0 < RAM_BYTES && (address & 1) === 0) {
            ram16[offset >> 1] = r[op & 7];
            left -= 2; continue;
          }
          this.store16(address, r[op & 7], left);
          left -= writeCycles(address);
          break;
        }
        case 36: { // STRB register
          const address = (r[(op >> 3) & 7] + r[(op >> 6) & 7]) | 0;
          const offset = (address - RAM) | 0;
          pc += 2;
          if (offset >>> 0 < RAM_BYTES) {
            ram8[offset] = r[op & 7];
            left -= 2; continue;
          }
          this.store8(address, r[op & 7], left);
          left -= writeCycles(address);
          break;
        }
        case 37: { // LDRSB register
          const address = (r[(op >> 3) & 7] + r[(op >> 6) & 7]) | 0;
          const offset = (address - RAM) | 0;
          pc += 2;
          if (offset >>> 0 < RAM_BYTES) {
            r[op & 7] = (ram8[offset] << 24) >> 24;
            left -= 2; continue;
          }
          if (address >>> 24 === FLASH) {
            r[op & 7] = (flash8[address & FLASH_MASK] << 24) >> 24;
            left -= 2 + cache.wait(address >> LINE_SHIFT); continue;
          }
          r[op & 7] = (this.load8(address, left) << 24) >> 24;
          left -= readCycles(address);
          break;
        }
        case 38: { // LDR register
          const address = (r[(op >> 3) & 7] + r[(op >> 6) & 7]) | 0;
          const offset = (address - RAM) | 0;
          pc += 2;
          if (offset >>> 0 < RAM_BYTES && (address & 3) === 0) {
            r[op & 7] = ram32[offset >> 2];
            left -= 2; continue;
          }
          if (address >>> 24 === FLASH && (address & 3) === 0) {
            r[op & 7] = flash32[(address & FLASH_MASK) >> 2];
            left -= 2 + cache.wait(address >> LINE_SHIFT); continue;
          }
          r[op & 7] = this.load32(address, left);
          left -= readCycles(address);
          break;
        }
        case 39: { // LDRH register
          const address = (r[(op >> 3) & 7] + r[(op >> 6) & 7]) | 0;
          const offset = (address - RAM) | 0;
          pc += 2;
          if (offset >>> 0 < RAM_BYTES && (address & 1) === 0) {
            r[op & 7] = ram16[offset >> 1];
            left -= 2; continue;
          }
          if (address >>> 24 === FLASH && (address & 1) === 0) {
            r[op & 7] = flash16[(address & FLASH_MASK) >> 1];
            left -= 2 + cache.wait(address >> LINE_SHIFT); continue;
          }
          r[op & 7] = this.load16(address, left);
          left -= readCycles(address);
          break;
        }
        case 40: { // LDRB register
          const address = (r[(op >> 3) & 7] + r[(op >> 6) & 7]) | 0;
          const offset = (address - RAM) | 0;
          pc += 2;
          if (offset >>> 0 < RAM_BYTES) {
            r[op & 7] = ram8[offset];
            left -= 2; continue;
          }
          if (address >>> 24 === FLASH) {
            r[op & 7] = flash8[address & FLASH_MASK];
            left -= 2 + cache.wait(address >> LINE_SHIFT); continue;
          }
          r[op & 7] = this.load8(address, left);
          left -= readCycles(address);
          break;
        }
        case 41: { // LDRSH register
          const address = (r[(op >> 3) & 7] + r[(op >> 6) & 7]) | 0;
          const offset = (address - RAM) | 0;
          pc += 2;
          if (offset >>> 0 < RAM_BYTES && (address & 1) === 0) {
            r[op & 7] = (ram16[offset >> 1] << 16) >> 16;
            left -= 2; continue;
          }
          if (address >>> 24 === FLASH && (address & 1) === 0) {
            r[op & 7] = (flash16[(address & FLASH_MASK) >> 1] << 16) >> 16;
            left -= 2 + cache.wait(address >> LINE_SHIFT); continue;
          }
          r[op & 7] = (this.load16(address, left) << 16) >> 16;
          left -= readCycles(address);
          break;
        }
        case 42: { // STR immediate
          const address = (r[(op >> 3) & 7] + ((op >> 4) & 0x7c)) | 0;
          const offset = (address - RAM) | 0;
          pc += 2;
          if (offset >>> 0 < RAM_BYTES && (address & 3) === 0) {
            ram32[offset >> 2] = r[op & 7];
            left -= 2; continue;
          }
          this.store32(address, r[op & 7], left);
          left -= writeCycles(address);
          break;
        }
        case 43: { // LDR immediate
          const address = (r[(op >> 3) & 7] + ((op >> 4) & 0x7c)) | 0;
          const offset = (address - RAM) | 0;
          pc += 2;
          if (offset >>> 0 < RAM_BYTES && (address & 3) === 0) {
            r[op & 7] = ram32[offset >> 2];
            left -= 2; continue;
          }
          if (address >>> 24 === FLASH && (address & 3) === 0) {
            r[op & 7] = flash32[(address & FLASH_MASK) >> 2];
            left -= 2 + cache.wait(address >> LINE_SHIFT); continue;
          }
          r[op & 7] = this.load32(address, left);
          left -= readCycles(address);
          break;
        }
        case 44: { // STRB immediate
          const address = (r[(op >> 3) & 7] + ((op >> 6) & 31)) | 0;
          const offset = (address - RAM) | 0;
          pc += 2;
          if (offset >>> 0 < RAM_BYTES) {
            ram8[offset] = r[op & 7];
            left -= 2; continue;
          }
          this.store8(address, r[op & 7], left);
          left -= writeCycles(address);
          break;
        }
        case 45: { // LDRB immediate
          const address = (r[(op >> 3) & 7] + ((op >> 6) & 31)) | 0;
          const offset = (address - RAM) | 0;
          pc += 2;
          if (offset >>> 0 < RAM_BYTES) {
            r[op & 7] = ram8[offset];
            left -= 2; continue;
          }
          if (address >>> 24 === FLASH) {
            r[op & 7] = flash8[address & FLASH_MASK];
            left -= 2 + cache.wait(address >> LINE_SHIFT); continue;
          }
          r[op & 7] = this.load8(address, left);
          left -= readCycles(address);
          break;
        }
        case 46: { // STRH immediate
          const address = (r[(op >> 3) & 7] + ((op >> 5) & 0x3e)) | 0;
          const offset = (address - RAM) | 0;
          pc += 2;
          if (offset >>> 0 < RAM_BYTES && (address & 1) === 0) {
            ram16[offset >> 1] = r[op & 7];
            left -= 2; continue;
          }
          this.store16(address, r[op & 7], left);
          left -= writeCycles(address);
          break;
        }
        case 47: { // LDRH immediate
          const address = (r[(op >> 3) & 7] + ((op >> 5) & 0x3e)) | 0;
          const offset = (address - RAM) | 0;
          pc += 2;
          if (offset >>> 0 < RAM_BYTES && (address & 1) === 0) {
            r[op & 7] = ram16[offset >> 1];
            left -= 2; continue;
          }
          if (address >>> 24 === FLASH && (address & 1) === 0) {
            r[op & 7] = flash16[(address & FLASH_MASK) >> 1];
            left -= 2 + cache.wait(address >> LINE_SHIFT); continue;
          }
          r[op & 7] = this.load16(address, left);
          left -= readCycles(address);
          break;
        }
        case 48: { // STR, SP plus immediate
          const address = (r[13] + ((op & 0xff) << 2)) | 0;
          const offset = (address - RAM) | 0;
          pc += 2;
          if (offset >>> 0 < RAM_BYTES) {
            ram32[offset >> 2] = r[(op >> 8) & 7];
            left -= 2; continue;
          }
          this.store32(address, r[(op >> 8) & 7], left);
          left -= writeCycles(address);
          break;
        }
        case 49: { // LDR, SP plus immediate
          const address = (r[13] + ((op & 0xff) << 2)) | 0;
          const offset = (address - RAM) | 0;
          pc += 2;
          if (offset >>> 0 < RAM_BYTES) {
            r[(op >> 8) & 7] = ram32[offset >> 2];
            left -= 2; continue;
          }
          r[(op >> 8) & 7] = this.load32(address, left);
          left -= readCycles(address);
          break;
        }
        case 50: // ADR
          r[(op >> 8) & 7] = ((pc + 4) & ~3) + ((op & 0xff) << 2);
          pc += 2; left -= 1; continue;
        case 51: // ADD, register = SP plus immediate
          r[(op >> 8) & 7] = r[13] + ((op & 0xff) << 2);
          pc += 2; left -= 1; continue;
        case 52: // ADD to SP
          r[13] = r[13] + ((op & 0x7f) << 2);
          pc += 2; left -= 1; continue;
        case 53: // SUB from SP
          r[13] = r[13] - ((op & 0x7f) << 2);
          pc += 2; left -= 1; continue;
        case 54: // SXTH
          r[op & 7] = (r[(op >> 3) & 7] << 16) >> 16;
          pc += 2; left -= 1; continue;
        case 55: // SXTB
          r[op & 7] = (r[(op >> 3) & 7] << 24) >> 24;
          pc += 2; left -= 1; continue;
        case 56: // UXTH
          r[op & 7] = r[(op >> 3) & 7] & 0xffff;
          pc += 2; left -= 1; continue;
        case 57: // UXTB
          r[op & 7] = r[(op >> 3) & 7] & 0xff;
          pc += 2; left -= 1; continue;
        case 58: { // PUSH
          let count = 0;
          for (let list = op & 0x1ff; list; list &= list - 1) count++;
          const bottom = (r[13] - 4 * count) | 0;
          const offset = (bottom - RAM) | 0;
          if (offset >>> 0 > RAM_BYTES - 36) {
            this.rare = true;
            break;
          }
          let at = offset >> 2;
          for (let i = 0; i < 8; i++) if (op & (1 << i)) ram32[at++] = r[i];
          if (op & 0x100) ram32[at] = r[14];
          r[13] = bottom;
          if (bottom < this.lowest) this.lowest = bottom;
          pc += 2; left -= 1 + count - ((op >> 8) & 1); continue;
        }
        case 59: { // POP without PC
          const offset = (r[13] - RAM) | 0;
          if (offset >>> 0 > RAM_BYTES - 36) {
            this.rare = true;
            break;
          }
          let at = offset >> 2;
          left -= 1;
          for (let i = 0; i < 8; i++) {
            if (op & (1 << i)) {
              r[i] = ram32[at++];
              left -= 1;
            }
          }
          r[13] = RAM + (at << 2);
          pc += 2; continue;
        }
        case 60: { // POP with PC
          const offset = (r[13] - RAM) | 0;
          let count = 0;
          for (let list = op & 0xff; list; list &= list - 1) count++;
          const target = offset >>> 0 > RAM_BYTES - 36 ? -1 : ram32[(offset >> 2) + count];
          if (target >>> 28 === EXCEPTION_RETURN) {
            this.rare = true;
            break;
          }
          let at = offset >> 2;
          for (let i = 0; i < 8; i++) if (op & (1 << i)) r[i] = ram32[at++];
          r[13] = RAM + (at << 2) + 4;
          pc = target & ~1;
          left -= 3 + count;
          if (((pc ^ base) & 0xf0000000) !== 0) {
            code = this.codeAt(pc);
            base = pc & 0xf0000000;
          }
          continue;
        }
        case 61: { // REV
          const value = r[(op >> 3) & 7];
          r[op & 7] = (value << 24) | ((value & 0xff00) << 8) | ((value >> 8) & 0xff00)
            | (value >>> 24);
          pc += 2; left -= 1; continue;
        }
        case 62: // NOP
          pc += 2; left -= 1; continue;
        case 63: { // STMIA
          const offset = (r[(op >> 8) & 7] - RAM) | 0;
          if (offset >>> 0 > RAM_BYTES - 36 || (offset & 3) !== 0) {
            this.rare = true;
            break;
          }
          let at = offset >> 2;
          left -= 1;
          for (let i = 0; i < 8; i++) {
            if (op & (1 << i)) {
              ram32[at++] = r[i];
              left -= 1;
            }
          }
          r[(op >> 8) & 7] = RAM + (at << 2);
          pc += 2; continue;
        }
        case 64: { // LDMIA
          const to = (op >> 8) & 7;
          const offset = (r[to] - RAM) | 0;
          if (offset >>> 0 > RAM_BYTES - 36 || (offset & 3) !== 0) {
            if (r[to] >>> 24 === FLASH) left -= this.waitForAll(r[to], op & 0xff);
            this.rare = true;
            break;
          }
          let at = offset >> 2;
          left -= 1;
          for (let i = 0; i < 8; i++) {
            if (op & (1 << i)) {
              r[i] = ram32[at++];
              left -= 1;
            }
          }
          if (!(op & (1 << to))) r[to] = RAM + (at << 2);
          pc += 2; continue;
        }
        case 65: // BEQ
          if (z === 0) { pc += 4 + ((op << 24) >> 23); left -= 2; } else { pc += 2; left -= 1; }
          continue;
        case 66: // BNE
          if (z !== 0) { pc += 4 + ((op << 24) >> 23); left -= 2; } else { pc += 2; left -= 1; }
          continue;
        case 67: // BCS
          if (c !== 0) { pc += 4 + ((op << 24) >> 23); left -= 2; } else { pc += 2; left -= 1; }
          continue;
        case 68: // BCC
          if (c === 0) { pc += 4 + ((op << 24) >> 23); left -= 2; } else { pc += 2; left -= 1; }
          continue;
        case 69: // BMI
          if (n < 0) { pc += 4 + ((op << 24) >> 23); left -= 2; } else { pc += 2; left -= 1; }
          continue;
        case 70: // BPL
          if (n >= 0) { pc += 4 + ((op << 24) >> 23); left -= 2; } else { pc += 2; left -= 1; }
          continue;
        case 71: // BVS
          if (v !== 0) { pc += 4 + ((op << 24) >> 23); left -= 2; } else { pc += 2; left -= 1; }
          continue;
        case 72: // BVC
          if (v === 0) { pc += 4 + ((op << 24) >> 23); left -= 2; } else { pc += 2; left -= 1; }
          continue;
        case 73: // BHI
          if (c !== 0 && z !== 0) { pc += 4 + ((op << 24) >> 23); left -= 2; }
          else { pc += 2; left -= 1; }
          continue;
        case 74: // BLS
          if (c === 0 || z === 0) { pc += 4 + ((op << 24) >> 23); left -= 2; }
          else { pc += 2; left -= 1; }
          continue;
        case 75: // BGE
          if (n >>> 31 === v) { pc += 4 + ((op << 24) >> 23); left -= 2; }
          else { pc += 2; left -= 1; }
          continue;
        case 76: // BLT
          if (n >>> 31 !== v) { pc += 4 + ((op << 24) >> 23); left -= 2; }
          else { pc += 2; left -= 1; }
          continue;
        case 77: // BGT
          if (z !== 0 && n >>> 31 === v) { pc += 4 + ((op << 24) >> 23); left -= 2; }
          else { pc += 2; left -= 1; }
          continue;
        case 78: // BLE
          if (z === 0 || n >>> 31 !== v) { pc += 4 + ((op << 24) >> 23); left -= 2; }
          else { pc += 2; left -= 1; }
          continue;
        case 79: // B
          pc += 4 + ((op << 21) >> 20);
          left -= 2; continue;
        case 80: { // the wide ones: BL, MRS and MSR of PRIMASK, barriers
          const second = code[(pc - base + 2) >> 1];
          if ((second & 0xd000) === 0xd000) { // BL
            const sign = (op << 21) >> 31; // all ones or zeros
            const i1 = ~((second >> 13) ^ sign) & 1, i2 = ~((second >> 11) ^ sign) & 1;
            r[14] = (pc + 4) | 1;
            pc += 4 + ((sign << 24) | (i1 << 23) | (i2 << 22) | ((op & 0x3ff) << 12)
              | ((second & 0x7ff) << 1));
            left -= 3;
            continue;
          }
          if (op === 0xf3ef && (second & 0xf0ff) === (0x8000 | PRIMASK)) { // MRS
            r[(second >> 8) & 15] = this.PM ? 1 : 0;
            pc += 4; left -= 3; continue;
          }
          if ((op & 0xfff0) === 0xf380 && second === (0x8800 | PRIMASK)) { // MSR
            this.PM = (r[op & 15] & 1) !== 0;
            pc += 4; left -= 3;
            if (this.PM || !this.anyPending) continue;
            this.interruptsUpdated = this.changed = true;
            break;
          }
          if (op === 0xf3bf) { // DMB, DSB, ISB
            pc += 4; left -= 3; continue;
          }
          this.rare = true;
          break;
        }
        case 81: // CPSIE
          this.PM = false;
          pc += 2; left -= 1;
          if (!this.anyPending) continue;
          this.interruptsUpdated = this.changed = true;
          break;
        case 82: // CPSID
          this.PM = true;
          pc += 2; left -= 1; continue;
        case 0:
          this.rare = true;
          break;
        default:
          throw new Fault(`the program has run to ${(pc >>> 0).toString(16)}, past the memory`);
      }
      if (this.rare || this.changed) {
        unspent = left;
        left = 0;
      }
    }
    this.N = n < 0;
    this.Z = z === 0;
    this.C = c !== 0;
    this.V = v !== 0;
    r[15] = pc;
    return unspent + left;
  }
}
