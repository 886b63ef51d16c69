// SPDX-License-Identifier: MIT
// processor.ts as it runs: one processor for this process of node, and its memories.
// tools/fetch/emulator.sh compiles it.
import fs from 'node:fs';

const WASM = new URL('../../../build/processor/processor.wasm', import.meta.url);

const { exports } = new WebAssembly.Instance(new WebAssembly.Module(fs.readFileSync(WASM)));

export const { interpret, memory } = exports;

const view = (Kind, name, length) => new Kind(memory.buffer, exports[name].value, length);

export const rom = view(Uint32Array, 'ROM', 4096);
export const ram = view(Uint8Array, 'RAM', 264 * 1024);
export const flash = view(Uint8Array, 'FLASH', 2 * 1024 * 1024);
export const registers = view(Uint32Array, 'REGISTERS', 16);
export const lines = view(Int32Array, 'LINES', 2048);
export const state = view(Int32Array, 'STATE', 19);
export const times = view(Float64Array, 'TIMES', 2); // when the stretch began, and the timer
export const blockAt = view(Uint16Array, 'BLOCKS', (ram.length + flash.length + rom.byteLength) / 2);
export const jumps = view(Uint16Array, 'JUMPS', blockAt.length);
export const codeMap = view(Uint8Array, 'CODE_MAP', ram.length / 32);

// What is where in `state`.
export const APSR = 0, PRIMASK = 1, LOWEST = 2, MISS_CYCLES = 3, WHY = 4;
export const ADDRESS = 5, BYTES = 6, NUMBER = 7;
export const LINE = 13, JUMPED = 14, CODE = 15, CODE_BYTES = 16, BUDGET = 17, SPINLOCKS = 18;

// Why a stretch has ended.
export const RARE = 1, LOAD = 2, LOAD_SIGNED = 3, STORE = 4, UNMASKED = 5, LOST = 6, CHANGED = 7;
export const BLOCK = 8;

// The addresses of what blocks use. That of JUMPS tells how much is before it.
const WORDS = { APSR, PRIMASK, LOWEST, MISS_CYCLES, NUMBER, LINE, JUMPED, CODE, CODE_BYTES,
  BUDGET, SPINLOCKS, DIVIDEND: 8, DIVISOR: 9, QUOTIENT: 10, REMAINDER: 11, DIRTY: 12 };
export const addresses = {
  ...Object.fromEntries(['REGISTERS', 'LINES', 'TIMES', 'BLOCKS', 'JUMPS'].map((name) =>
    [name, exports[name].value])),
  ...Object.fromEntries(Object.entries(WORDS).map(([name, at]) =>
    [name, exports.STATE.value + 4 * at])),
};
