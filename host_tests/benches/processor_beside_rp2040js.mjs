// SPDX-License-Identifier: MIT
// Executes every instruction of 16 bits, and pairs of halves of the wide ones, with registers and
// memory drawn by lot: with processor.ts, and with rp2040js, which executes one at a time.
//
//     node processor_beside_rp2040js.mjs SEED
//
// Then it divides, and compares that with the data sheet. Prints how many were the same, and each
// that was not: what it did here and there.
import { Clock } from '../../tools/emulator/rp2040/clock.mjs';
import { Core } from '../../tools/emulator/rp2040/core.mjs';
import { RP2040 } from '../../tools/emulator/rp2040/library.mjs';
import { flash, ram } from '../../tools/emulator/rp2040/processor.mjs';

const CYCLE_NANOS = 8, ROUNDS = 2, PAIRS = 10000, SHOWN = 20;
const RAM = 0x20000000, CODE = 0x1000, DATA = 0x2000, DATA_BYTES = 512;
const SHIFTS = [0x4080, 0x40c0, 0x4100, 0x41c0]; // LSLS, LSRS, ASRS, RORS by a register
const SBCS = 0x4180, STMIA = 0x18; // their first bits
const BX_PC = 0x4778, BLX_PC = 0x47f8, BLX_LR = 0x47f0;
const QUIET = { debug() {}, info() {}, warn() {}, error() {} };

let seed = Number(process.argv[2]);

function draw(limit) {
  seed = (Math.imul(seed, 1103515245) + 12345) & 0x7fffffff;
  return Math.floor((seed / 0x80000000) * limit);
}

class Elsewhere extends Error {} // an access to what is not RAM: not of interest here

function machines() {
  const here = new RP2040(new Clock(0)), there = new RP2040(new Clock(0));
  here.sram = ram;
  here.sramView = new DataView(ram.buffer, ram.byteOffset, ram.length);
  here.core = new Core(here, 0);
  here.core.read = here.core.write = () => { throw new Elsewhere(); };
  for (const mcu of [here, there]) {
    mcu.logger = QUIET;
    mcu.onBreak = () => {};
  }
  return [here, there];
}

function value() {
  switch (draw(4)) {
    case 0: return RAM + DATA + 4 * draw(DATA_BYTES / 8);
    case 1: return draw(40);
    case 2: return 0x7ffffff0 + draw(32);
  }
  return draw(0x10000) * 0x10000 + draw(0x10000);
}

function deal([here, there], halves) {
  const dealt = Array.from({ length: 16 }, value);
  dealt[13] = RAM + DATA + 128 + 4 * draw(16);
  dealt[14] = RAM + CODE + 2 * draw(100) + 1;
  dealt[15] = RAM + CODE;
  const flags = draw(16) << 28, masked = draw(2) === 1;
  const data = Uint8Array.from({ length: DATA_BYTES }, () => draw(256));
  for (const { core, sram, sramView } of [here, there]) {
    core.registers.set(dealt);
    core.APSR = flags;
    core.PM = masked;
    core.waiting = core.eventRegistered = core.pendingSVCall = core.interruptsUpdated = false;
    core.IPSR = 0;
    sram.set(data, DATA);
    halves.forEach((half, at) => sramView.setUint16(CODE + 2 * at, half, true));
  }
  return dealt;
}

function state({ core, sram }, cycles) {
  const { APSR, PM, waiting } = core;
  const memory = Buffer.from(sram.subarray(DATA, DATA + DATA_BYTES)).toString('base64');
  return { registers: [...core.registers].map((word) => word.toString(16)).join(' '),
    flags: (APSR >>> 28).toString(2), PM, waiting, cycles, memory };
}

// Where rp2040js does not do as the manual says: the carry of a shift by a register that holds 0 or
// more than 32; V of SBCS; BLX of LR; STMIA of its own address. And BX and BLX of PC, which neither
// of the two does as in the manual, and no compiler writes.
function isKnown(half, dealt, difference) {
  if (half >> 11 === STMIA && half & (1 << ((half >> 8) & 7))) return true;
  if ([BX_PC, BLX_PC, BLX_LR].includes(half & 0xfff8)) return true;
  if (difference !== 'flags') return false;
  const operand = dealt[(half >> 3) & 7], count = operand & 0xff;
  if ((half & 0xffc0) === SBCS) return operand === 0x7fffffff;
  return SHIFTS.includes(half & 0xffc0) && (count === 0 || count > 32);
}

function compare(pair, halves) {
  const [here, there] = pair;
  const dealt = deal(pair, halves);
  const began = here.clock.nanosCounter;
  try {
    here.core.run(began + CYCLE_NANOS);
  } catch (error) {
    if (error instanceof Elsewhere) return null;
    return error.message;
  }
  const one = state(here, (here.clock.nanosCounter - began) / CYCLE_NANOS);
  const other = state(there, there.core.executeInstruction());
  const names = Object.keys(one).filter((name) => one[name] !== other[name]);
  if (names.length === 0 || isKnown(halves[0], dealt, names.join())) return '';
  return names.map((name) => `${name} ${one[name]} and there ${other[name]}`).join('; ');
}

flash.fill(0xff); // as there
console.warn = () => {}; // rp2040js complains of where it reads
const pair = machines();
const counts = { same: 0, elsewhere: 0, different: 0 };

function note(halves) {
  const difference = compare(pair, halves);
  if (difference === null) counts.elsewhere++;
  else if (difference === '') counts.same++;
  else if (counts.different++ < SHOWN) {
    console.log(halves.map((half) => half.toString(16)).join(' '), 'here', difference);
  }
}

// BL; MSR, MRS and the barriers, each with the second halves of these, and with any.
const FIRST = [0xf000, 0xf380, 0xf3ef, 0xf3bf];
const SECOND = [0xd000, 0xf800, 0x8800, 0x8810, 0x8110, 0x8e10, 0x8f4f, 0x8f5f, 0x8f6f];
for (let round = 0; round < ROUNDS; round++) {
  for (let half = 0; half < 0xe800; half++) note([half, draw(0x10000)]);
}
for (let left = PAIRS; left > 0; left--) {
  const first = FIRST[draw(FIRST.length)];
  note([first | (first === FIRST[0] ? draw(0x800) : 0),
    draw(3) ? SECOND[draw(SECOND.length)] | draw(2) : draw(0x10000)]);
}

// A program writes r1 and r2 to the divider, and reads from it; r0 is its address.
const DIVIDER = 0xd0000060, DIVISIONS = 20000;
const UDIVIDEND = 0, UDIVISOR = 1, SDIVIDEND = 2, SDIVISOR = 3;
const QUOTIENT = 4, REMAINDER = 5, CSR = 6;
const str = (register, word) => 0x6000 | (word << 6) | register; // STR rd, [r0, #4 * word]
const ldr = (register, word) => 0x6800 | (word << 6) | register;
const READ_ALL = [ldr(3, CSR), ldr(4, REMAINDER), ldr(5, QUOTIENT), ldr(6, CSR)];
const DIRTY_AND_READY = 3, READY = 1;

function divide(dividend, divisor, isSigned) {
  const [{ core, clock }] = pair;
  const [one, other] = isSigned ? [SDIVIDEND, SDIVISOR] : [UDIVIDEND, UDIVISOR];
  const program = [str(1, one), str(2, other), ...READ_ALL, ldr(1, one), ldr(2, other)];
  deal(pair, program);
  core.registers.set([DIVIDER, dividend, divisor]);
  const began = clock.nanosCounter;
  core.run(began + program.length * CYCLE_NANOS);
  const cycles = (clock.nanosCounter - began) / CYCLE_NANOS;
  return [...core.registers.subarray(1, 7), cycles].join(' ');
}

// RP2040 data sheet, 2.3.1.5.
function divided(dividend, divisor, isSigned) {
  const [one, other] = isSigned ? [dividend | 0, divisor | 0] : [dividend, divisor];
  const quotient = other === 0 ? (one < 0 ? 1 : -1) : Math.trunc(one / other);
  const remainder = other === 0 ? one : one % other;
  const words = [dividend, divisor, DIRTY_AND_READY, remainder, quotient, READY];
  return [...Uint32Array.from(words), 2 + READ_ALL.length + 2].join(' ');
}

for (let left = DIVISIONS; left > 0; left--) {
  const dividend = value() >>> 0, divisor = draw(20) ? value() >>> 0 : [0, 0xffffffff][draw(2)];
  const isSigned = draw(2) === 1;
  const one = divide(dividend, divisor, isSigned), other = divided(dividend, divisor, isSigned);
  if (one === other) counts.same++;
  else if (counts.different++ < SHOWN) {
    console.log('divided', dividend, divisor, isSigned, 'here', one, 'and there', other);
  }
}

console.log(JSON.stringify(counts));
