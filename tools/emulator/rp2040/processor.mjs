// SPDX-License-Identifier: MIT
// processor.ts as it runs: one processor for this process of node, its memories, and whom it asks.
// tools/fetch/emulator.sh compiles it.
import fs from 'node:fs';

const WASM = new URL('../../../build/processor/processor.wasm', import.meta.url);

let core = null; // of the chip whose instructions are executed

// The chip has a new processor.
export function join(newCore) {
  core = newCore;
}

const { exports } = new WebAssembly.Instance(
  new WebAssembly.Module(fs.readFileSync(WASM)),
  {
    core: {
      read: (address, bytes, left) => core.read(address, bytes, left),
      write: (address, bytes, value, left) => core.write(address, bytes, value, left),
      waits: () => core.waits(),
      lost: (pc) => core.lost(pc),
    },
  },
);

export const { stretch } = exports;

const view = (Kind, name, length) => new Kind(exports.memory.buffer, exports[name].value, length);

export const rom = view(Uint32Array, 'ROM', 4096);
export const ram = view(Uint8Array, 'RAM', 264 * 1024);
export const flash = view(Uint8Array, 'FLASH', 2 * 1024 * 1024);
export const registers = view(Uint32Array, 'REGISTERS', 16);
export const lines = view(Int32Array, 'LINES', 2048);
export const state = view(Uint32Array, 'STATE', 11);

// What is where in `state`.
export const APSR = 0, PRIMASK = 1, LOWEST = 2, CHANGED = 3, RARE = 4, MISS_CYCLES = 5;
