// SPDX-License-Identifier: MIT
// The processor: rp2040js's core, for which WebAssembly executes most instructions (processor.ts).
// Rare ones, exceptions and everything else of a processor are left to rp2040js.
//
// A stretch of instructions ends at the next alarm of the clock. The clock stands still meanwhile
// and is put right before anything outside of RAM, flash and ROM is touched, so that each access
// happens at the very instant at which it would if the clock ticked for each instruction.
import { blocks } from './blocks/blocks.mjs';
import { CortexM0Core } from './library.mjs';
import { flash, interpret, ram, registers, rom, state, times } from './processor.mjs';
import {
  ADDRESS, APSR, BUDGET, BYTES, JUMPED, LINE, LOWEST, MISS_CYCLES, NUMBER, PRIMASK, WHY,
} from './processor.mjs';
import { BLOCK, CHANGED, LOAD, LOAD_SIGNED, LOST, RARE, STORE, UNMASKED } from './processor.mjs';

const CYCLE_NANOS = 8;
const STRETCH_CYCLES = 1 << 24;
const RAM = 0x20000000;
const FLASH_MASK = flash.length - 1, ROM_BYTES = 4 * rom.length;
const FLASH_WINDOWS = 4; // 0x10000000 ... 0x13ffffff: the flash, cached or not; in 64 MiB
const LOAD_CYCLES = { 0x4: 4, 0xd: 1 }, STORE_CYCLES = { 0x4: 5, 0xd: 1 }; // elsewhere 2
const NOWHERE = -1; // where SP has been, when it has not been anywhere
const NO_LINE = -1;

const hex = (address) => (address >>> 0).toString(16);

// What is a HardFault on the chip.
export class Fault extends Error {}

export class Core extends CortexM0Core {
  // missCycles: how long it waits for a line that is not in the cache.
  constructor(mcu, missCycles) {
    super(mcu);
    this.registers = registers.fill(0);
    state.fill(0);
    state[LOWEST] = NOWHERE; // SP, in this mode
    state[MISS_CYCLES] = missCycles;
    blocks.begin();
    this.leave = false; // the stretch is to end: the chip is about to be reset
    this.changed = false; // it is to end, for this or another reason
    this.start = 0; // of the stretch: its instant, and how many cycles it may take
    this.budget = 0;
    this.dueAt = 0; // when the next alarm goes off, as it was at the start
    this.depths = { program: 0, handlers: 0 }; // of the stack, bytes
    this.entered = 0; // SP when the handler interrupted the program
    this.flash = new Int32Array(flash.buffer, flash.byteOffset, flash.length >> 2);
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
    if (state[LOWEST] === NOWHERE) return;
    const { depths } = this, lowest = state[LOWEST] >>> 0;
    if (this.IPSR) depths.handlers = Math.max(depths.handlers, this.entered - lowest);
    else depths.program = Math.max(depths.program, RAM + ram.length - lowest);
    state[LOWEST] = NOWHERE;
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

  // Whether an interrupt waits that is not masked any more.
  waits() {
    if (!(this.pendingInterrupts & this.enabledInterrupts || this.pendingPendSV
      || this.pendingSystick || this.pendingSVCall || this.pendingNMI)) return false;
    this.interruptsUpdated = true;
    return true;
  }

  get inFlash() {
    return registers[15] >>> 28 === 1;
  }

  // Loads from what is neither RAM nor flash through the cache, and stores there. `left`: the cycles
  // of the stretch that are not yet spent.

  load(left, isSigned) {
    const address = state[ADDRESS], bytes = state[BYTES], above = 32 - 8 * bytes;
    const value = this.read(address, bytes, left);
    registers[state[NUMBER]] = isSigned ? (value << above) >> above : value;
    registers[15] += 2;
    return left - (LOAD_CYCLES[address >>> 28] ?? 2);
  }

  store(left) {
    const address = state[ADDRESS];
    this.write(address, state[BYTES], registers[state[NUMBER]], left);
    registers[15] += 2;
    return left - (STORE_CYCLES[address >>> 28] ?? 2);
  }

  read(address, bytes, left) {
    if (address & (bytes - 1)) this.check(address, bytes, false);
    const word = this.readWord(address & ~3, left);
    if (bytes === 4) return word;
    return (word >>> (8 * (address & 3))) & (bytes === 2 ? 0xffff : 0xff);
  }

  readWord(address, left) {
    if (address >>> 26 === FLASH_WINDOWS) return this.flash[(address & FLASH_MASK) >> 2];
    if (address >>> 0 < ROM_BYTES) return rom[address >> 2];
    this.check(address, 4, false);
    this.before(left);
    const value = address >>> 28 === 0xd ? this.rp2040.sio.readUint32(address & 0xfffffff)
      : this.rp2040.readUint32(address >>> 0);
    this.after();
    return value;
  }

  write(address, bytes, value, left) {
    if (address >>> 0 < ROM_BYTES) return; // the USB driver does that; the chip ignores it
    this.check(address, bytes, true);
    this.before(left);
    const { rp2040 } = this;
    if (bytes === 1) rp2040.writeUint8(address >>> 0, value & 0xff);
    else if (bytes === 2) rp2040.writeUint16(address >>> 0, value & 0xffff);
    else if (address >>> 28 === 0xd) rp2040.sio.writeUint32(address & 0xfffffff, value >>> 0);
    else rp2040.writeUint32(address >>> 0, value >>> 0);
    this.after();
  }

  before(left) {
    this.rp2040.clock.nanosCounter = this.start + (this.budget - left) * CYCLE_NANOS;
  }

  after() {
    const isDue = this.rp2040.clock.dueAt < this.dueAt;
    this.changed = this.leave || this.interruptsUpdated || this.waiting || isDue;
  }

  // Throws where the chip has a HardFault: unaligned, where nothing is, into the flash.
  check(address, bytes, writing) {
    const digit = address >>> 28;
    const there = digit >= 4 ? digit <= 5 || digit === 0xd || digit === 0xe
      : digit === 1 && (!writing || address >>> 26 !== FLASH_WINDOWS);
    if (there && (address & (bytes - 1)) === 0) return;
    const how = writing ? 'writes to' : 'reads from';
    throw new Fault(`the program ${how} ${hex(address)}, ${bytes} bytes`);
  }

  lost(pc) {
    throw new Fault(`the program has run to ${hex(pc)}, where no code is`);
  }

  // Takes the cycles that are left, returns those that remain; `state` tells why.
  execute(cycles) {
    state[LINE] = NO_LINE;
    state[JUMPED] = 0;
    for (let left = cycles; ;) {
      left = interpret(left);
      if (state[WHY] !== BLOCK) return left;
      left = blocks.run(left);
    }
  }

  // The stretch, and what it leaves to others. Returns the cycles that remain.
  stretch() {
    let left = this.budget;
    while (!this.changed) {
      left = this.execute(left);
      switch (state[WHY]) {
        case LOAD: left = this.load(left, false); break;
        case LOAD_SIGNED: left = this.load(left, true); break;
        case STORE: left = this.store(left); break;
        case UNMASKED: this.changed = this.waits(); break;
        case LOST: return this.lost(registers[15]);
        case CHANGED: blocks.changed(); break;
        default: return left;
      }
    }
    return left;
  }

  // Executes instructions until the instant, or until an alarm or an interrupt is due.
  run(until) {
    const { clock } = this.rp2040;
    this.leave = false;
    if (this.interruptsUpdated && this.checkForInterrupts()) this.waiting = false;
    this.start = clock.nanosCounter;
    const cycles = Math.ceil((Math.min(until, clock.dueAt) - this.start) / CYCLE_NANOS);
    if (cycles <= 0) return;
    if (blocks.waits) blocks.look();
    this.budget = state[BUDGET] = Math.min(cycles, STRETCH_CYCLES);
    times[0] = this.start;
    this.dueAt = clock.dueAt;
    state[APSR] = this.APSR;
    state[PRIMASK] = this.PM ? 1 : 0;
    this.changed = false;
    const left = this.stretch();
    this.APSR = state[APSR];
    this.PM = state[PRIMASK] !== 0;
    clock.nanosCounter = this.start + (this.budget - left) * CYCLE_NANOS;
    if (state[WHY] === RARE) clock.nanosCounter += super.executeInstruction() * CYCLE_NANOS;
  }
}
