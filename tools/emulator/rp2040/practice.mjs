// SPDX-License-Identifier: MIT
// Lets V8 see every kind of instruction with every kind of operand before the chip starts.
//
// V8 compiles the processor's one long function for what it has seen so far, and throws the result
// away whenever something new turns up, which costs a good second of the first ones. So a chip
// that nobody uses executes each instruction some times, with operands drawn by lot (always the
// same).
import { Cache } from './cache.mjs';
import { Clock } from './clock.mjs';
import { Core, DECODE } from './core.mjs';
import { RP2040 } from './library.mjs';
import { Sio } from './sio.mjs';

const ROUNDS = 40;
const CODES = [0x20001000, 0x10001000]; // in RAM, and in the flash
const SCRATCH = 0x20002000, STACK = 0x20003000, TABLE = 0x10000100;
const GPIO_OUT = 0xd0000010, TIMER = 0x40054028;
const BASES = [SCRATCH, SCRATCH, SCRATCH, STACK, TABLE, GPIO_OUT, TIMER, 0x7fffffff, 0xfffffffe];
const STARTS = [0, 1e11]; // nanoseconds: small numbers and large ones
const QUIET = { debug() {}, info() {}, warn() {}, error() {} };

let seed = 12345;

function draw(limit) {
  seed = (Math.imul(seed, 1103515245) + 12345) & 0x7fffffff;
  return (seed >>> 8) % limit;
}

function examples() {
  const ofKind = new Map();
  DECODE.forEach((kind, opcode) => {
    if (!ofKind.has(kind)) ofKind.set(kind, []);
    ofKind.get(kind).push(opcode);
  });
  ofKind.delete(0);
  return [...ofKind.values()];
}

function deal(core) {
  for (let i = 0; i < 15; i++) {
    core.registers[i] = draw(3) ? BASES[draw(BASES.length)] : 4 * draw(10);
  }
  core.registers[13] = STACK;
  core.N = !draw(2);
  core.Z = !draw(2);
  core.C = !draw(2);
  core.V = !draw(2);
}

export function practise() {
  const kinds = examples();
  for (const start of STARTS) {
    const mcu = new RP2040(new Clock(start));
    mcu.logger = QUIET;
    mcu.sio = new Sio(mcu);
    const core = mcu.core = new Core(mcu, new Cache(1));
    for (let round = 0; round < ROUNDS; round++) {
      for (const opcodes of kinds) {
        deal(core);
        core.PC = CODES[round % CODES.length];
        const code = core.codeAt(core.PC), at = (core.PC & 0xffff) >> 1;
        code[at] = opcodes[draw(opcodes.length)];
        code[at + 1] = 0xf800 | draw(0x7ff); // the second half of a BL
        try {
          core.run(mcu.clock.nanos + 8);
        } catch {
          // It jumped to where no code is.
        }
      }
    }
  }
}
