// SPDX-License-Identifier: MIT
// PIO on the chip's clock: each enabled state machine executes one instruction at an edge of its
// divided clock, with the divider's fraction and the delays.
//
// rp2040js knows the instructions but lets the machines run free on the host's time. A machine
// that waits costs nothing: what it waits for (a FIFO written by the CPU or by DMA, a pin, an
// interrupt flag) wakes it at the next edge. Nor does an alarm go off for an instruction that nobody
// outside of the machine would notice: it is executed early, and taken back if somebody looks.
import { FIFO, RPPIO, StateMachine } from './library.mjs';

const CYCLE_NANOS = 8;
const CTRL = 0x000, SM_FIRST = 0x0c8, SM_SIZE = 0x18, SM_LAST = 0x124;
const CLKDIV = 0x00, INSTR = 0x10;
const JOIN_RX = 1 << 31, JOIN_TX = 1 << 30;
const INSTRUCTIONS = 0x048; // from here on, registers tell or change how far a machine is
const FIFO_WORDS = 4;
const JMP = 0, OUT = 3, MOV = 5, SET = 7; // the first three bits of an instruction
const ON_PIN = 6, FROM_PINS = 0, FROM_STATUS = 5, TO_EXEC = 4, OUT_EXEC = 7; // and what some have
const AUTOPULL = 1 << 17;
const MOST_EARLY = 32; // instructions: a program may go round for ever
const COUNTED = { 2: 'x', 4: 'y' }; // by the condition of a JMP: the register that it counts down
const FRACTION = 256;

class TimedMachine extends StateMachine {
  constructor(mcu, pio, index) {
    super(mcu, pio, index);
    this.clock = mcu.clock;
    this.alarm = this.clock.createAlarm(() => this.execute());
    this.origin = 0; // the instant of edge 0 of the divided clock
    this.edge = 0; // the number of the edge that the alarm is set to
    this.executing = false;
    this.spun = null; // { register, turns, cycles of each, edge of the first }
    this.onTime = null; // how it was when it began to execute instructions early
  }

  get period() { // in cycles / FRACTION
    return (this.clockDivInt || 65536) * FRACTION + this.clockDivFrac;
  }

  instant(edge) {
    return this.origin + Math.floor((edge * this.period) / FRACTION) * CYCLE_NANOS;
  }

  get nextEdge() {
    const { nanos } = this.clock, cycles = (nanos - this.origin) / CYCLE_NANOS;
    let edge = Math.floor((cycles * FRACTION) / this.period);
    while (this.instant(edge) <= nanos) edge++;
    return edge;
  }

  clkDivRestart() {
    this.origin = this.clock.nanos;
    this.edge = 0;
  }

  // Sets the alarm to the first edge after now, unless the machine runs already or cannot.
  wake() {
    if (!this.enabled) {
      this.alarm.cancel();
      return;
    }
    if (this.executing || this.alarm.scheduled) return;
    this.edge = this.nextEdge;
    this.alarm.at(this.instant(this.edge));
  }

  // What the library calls when something that a machine may wait for has changed.
  checkWait() {
    if (this.executing) super.checkWait();
    else if (this.waiting) this.wake();
  }

  execute() {
    this.spun = this.onTime = null;
    if (!this.enabled) return;
    this.executing = true;
    const { pc, cycles: before } = this;
    let spent = 0;
    if (this.waiting) {
      super.checkWait();
      spent = 1; // the edge at which the wait ended; its delay is in this.cycles
    } else {
      super.step();
    }
    this.executing = false;
    this.pio.checkChangedPins();
    if (this.waiting) return;
    this.edge += spent + this.cycles - before;
    if (this.pc === pc && !spent) this.spin(this.cycles - before);
    else this.goAhead();
    this.alarm.at(this.instant(this.edge));
  }

  // Executes the instructions that come next as long as they are of the machine alone.
  goAhead() {
    const { pio } = this, { pinValues, pinDirections } = pio;
    for (let count = 0; count < MOST_EARLY && this.isOwn(pio.instructions[this.pc]); count++) {
      const before = this.copy();
      this.stepEarly();
      if (pio.pinValues !== pinValues || pio.pinDirections !== pinDirections) {
        Object.assign(pio, { pinValues, pinDirections });
        Object.assign(this, before);
        return;
      }
      this.onTime ??= before;
    }
  }

  stepEarly() {
    const { cycles } = this;
    this.executing = true;
    super.step();
    this.executing = false;
    this.edge += this.cycles - cycles;
  }

  // What such an instruction may change.
  copy() {
    const { pc, x, y, cycles, edge, outPinValues, outPinDirection } = this;
    const { inputShiftReg, inputShiftCount, outputShiftReg, outputShiftCount } = this;
    return { pc, x, y, cycles, edge, outPinValues, outPinDirection,
      inputShiftReg, inputShiftCount, outputShiftReg, outputShiftCount };
  }

  // Whether it has to do with nothing outside but the pins that it drives, which no other machine
  // drives. One that jumps to itself is for `spin`.
  isOwn(opcode) {
    const operand = (opcode >> 5) & 7, source = opcode & 7;
    switch (opcode >> 13) {
      case JMP: return operand !== ON_PIN && (opcode & 0x1f) !== this.pc;
      case OUT: return operand !== OUT_EXEC && !(this.shiftCtrl & AUTOPULL);
      case MOV: return operand !== TO_EXEC && source !== FROM_PINS && source !== FROM_STATUS;
      case SET: return true;
    }
    return false;
  }

  // It has jumped to where it was. If it counts down meanwhile, it waits: all turns but the last are
  // taken at once.
  spin(cycles) {
    const opcode = this.pio.instructions[this.pc], register = COUNTED[(opcode >> 5) & 7];
    if (opcode >> 13 !== JMP || !register) return;
    const turns = this[register];
    this.spun = { register, turns, cycles, edge: this.edge };
    this[register] = 0;
    this.edge += turns * cycles;
  }

  // As far as it is by now.
  catchUp() {
    if (this.onTime !== null) {
      Object.assign(this, this.onTime);
      this.onTime = null;
      while (this.edge < this.nextEdge) this.stepEarly();
      this.alarm.at(this.instant(this.edge));
    }
    if (this.spun === null) return;
    const { register, turns, cycles, edge } = this.spun;
    const done = Math.min(turns, Math.max(0, Math.ceil((this.nextEdge - edge) / cycles)));
    this.spun = null;
    this[register] = turns - done;
    this.edge = edge + done * cycles;
    this.alarm.at(this.instant(this.edge));
  }

  // Joining or parting the FIFOs empties them; the SDK does it for that alone.
  join(control) {
    const words = (joined, other) => (joined ? 2 * FIFO_WORDS : other ? 0 : FIFO_WORDS);
    this.txFIFO = new FIFO(words(control & JOIN_TX, control & JOIN_RX));
    this.rxFIFO = new FIFO(words(control & JOIN_RX, control & JOIN_TX));
    this.updateDMATx();
    this.updateDMARx();
  }

  // An instruction from the CPU is executed at once, in place of what the machine waits at.
  executeNow(opcode) {
    this.waiting = false;
    this.executing = true;
    this.executeInstruction(opcode & 0xffff);
    this.executing = false;
    this.wake();
  }
}

export class TimedPio extends RPPIO {
  constructor(mcu, index) {
    const old = mcu.pio[index];
    super(mcu, old.name, old.firstIrq, index);
    this.machines = this.machines.map((_, i) => new TimedMachine(mcu, this, i));
  }

  run() {} // never free

  readUint32(offset) {
    this.catchUp(offset);
    return super.readUint32(offset);
  }

  catchUp(offset) {
    if (offset === CTRL || offset >= INSTRUCTIONS) for (const each of this.machines) each.catchUp();
  }

  writeUint32(offset, value) {
    this.catchUp(offset);
    const inMachine = offset >= SM_FIRST && offset <= SM_LAST;
    const register = (offset - SM_FIRST) % SM_SIZE;
    const machine = inMachine ? this.machines[Math.floor((offset - SM_FIRST) / SM_SIZE)] : null;
    if (inMachine && register === INSTR) {
      machine.executeNow(value);
    } else {
      const before = machine?.shiftCtrl;
      super.writeUint32(offset, value);
      if (inMachine && register === CLKDIV) machine.clkDivRestart();
      if (inMachine && (before ^ machine.shiftCtrl) & (JOIN_RX | JOIN_TX)) {
        machine.join(machine.shiftCtrl);
        this.checkInterrupts();
      }
    }
    if (offset === CTRL) for (const each of this.machines) each.wake();
    if (offset === CTRL || inMachine) this.checkChangedPins();
  }
}
