// SPDX-License-Identifier: MIT
// What a firmware executes often, in this machine's own code. tools/fetch/blocks.sh lets a firmware
// run for a while, makes functions in C of the places to which most jumps have led (translate.mjs,
// block.mjs), and compiles them to NAME.node; NAME.json says what they are. Where there are none,
// processor.ts executes everything: it takes more than twice as long, and does the same.
//
// The blocks of a firmware are good as long as its code is there: those in the flash while it has
// each of them, those in RAM from when the program has copied them there until something changes one.
// Those in the boot ROM, which copies and clears memory for the firmware, are good with the flash's.
import fs from 'node:fs';
import { createRequire } from 'node:module';
import { isDeepStrictEqual } from 'node:util';
import {
  addresses, blockAt, CODE, CODE_BYTES, codeMap, flash, memory, ram, rom, state,
} from '../processor.mjs';

const RAM = 0x20000000, FLASH = 0x10000000, ROM = 0;
const FOLDER = new URL('../../../../build/blocks/', import.meta.url);
const CODE_SHIFT = 5; // as in processor.ts

// Where code may be: where each memory begins, and how many halves of instructions come before its
// own, as in processor.ts.
const romBytes = new Uint8Array(rom.buffer, rom.byteOffset, rom.byteLength);
export const memories = {
  ram: { start: RAM, bytes: ram, halvesBefore: 0 },
  flash: { start: FLASH, bytes: flash, halvesBefore: ram.length / 2 },
  rom: { start: ROM, bytes: romBytes, halvesBefore: (ram.length + flash.length) / 2 },
};

export const memoryAt = (address) =>
  Object.values(memories).find(({ start }) => address >= start);

export function halfOf(address) {
  const { start, halvesBefore } = memoryAt(address);
  return halvesBefore + (address - start) / 2;
}

// Less, or nothing, where the memory ends.
export function codeAt(address, count) {
  const { start, bytes } = memoryAt(address);
  return bytes.subarray(address - start, address - start + count);
}

// The blocks of a firmware in one memory; list: where each begins, and its code in base64.
class Area {
  constructor(list, firstNumber) {
    this.blocks = list.map(([start, coded], index) => {
      const code = Buffer.from(coded, 'base64');
      return { number: firstNumber + index, start, code, here: codeAt(start, code.length) };
    });
    this.start = Math.min(...this.blocks.map(({ start }) => start));
    this.end = Math.max(...this.blocks.map(({ start, code }) => start + code.length));
  }

  // Whether all of the code is there. A program copies it from the first byte to the last.
  get isThere() {
    return this.blocks.findLastIndex(({ code, here }) => !code.equals(here)) < 0;
  }

  put(areGood) {
    for (const { number, start } of this.blocks) blockAt[halfOf(start)] = areGood ? number : 0;
  }
}

// Those that were made for this processor.
export function firmwaresIn(folder) {
  const names = fs.existsSync(folder) ? fs.readdirSync(folder) : [];
  return names.filter((name) => name.endsWith('.json')).map((name) => ({
    library: new URL(name.replace(/json$/, 'node'), folder).pathname,
    ...JSON.parse(fs.readFileSync(new URL(name, folder))),
  })).filter((told) => isDeepStrictEqual(told.addresses, addresses))
    .map(({ library, flash: inFlash, ram: inRam, rom: inRom }) => ({
      library,
      inFlash: new Area(inFlash, 1),
      inRam: new Area(inRam, 1 + inFlash.length),
      inRom: new Area(inRom, 1 + inFlash.length + inRam.length),
    }));
}

export class Blocks {
  constructor(firmwares) {
    this.firmwares = firmwares;
    this.firmware = null; // that whose blocks are good
    this.waits = false; // for those in RAM
    this.run = null; // (left): the block NUMBER and those after it; the cycles that remain
  }

  // A chip begins: its flash is filled, its RAM is empty.
  begin() {
    this.end();
    const firmware = this.firmwares.find(({ inFlash }) => inFlash.isThere);
    const native = firmware && libraryOf(firmware);
    if (!native) return;
    native.join(memory.buffer);
    this.run = native.run;
    this.firmware = firmware;
    firmware.inFlash.put(true);
    firmware.inRom.put(firmware.inRom.isThere);
    this.waits = firmware.inRam.blocks.length > 0;
  }

  end() {
    blockAt.fill(0);
    this.firmware = null;
    this.waits = false;
    this.noteCode(null);
  }

  // Whether those in RAM are there by now.
  look() {
    const { inRam } = this.firmware;
    if (!inRam.isThere) return;
    this.waits = false;
    inRam.put(true);
    this.noteCode(inRam);
  }

  // The code of one in RAM has changed.
  changed() {
    this.firmware.inRam.put(false);
    this.waits = true;
    this.noteCode(null);
  }

  // Bytes of the flash are written.
  written(offset, bytes) {
    if (this.firmware === null) return;
    const { start, end } = this.firmware.inFlash;
    if (FLASH + offset < end && FLASH + offset + bytes > start) this.end();
  }

  // So that processor.ts tells when it changes.
  noteCode(inRam) {
    codeMap.fill(0);
    for (const { start, code } of inRam?.blocks ?? []) {
      const offset = start - RAM;
      codeMap.fill(1, offset >>> CODE_SHIFT, ((offset + code.length - 1) >>> CODE_SHIFT) + 1);
    }
    state[CODE] = inRam?.start ?? 0;
    state[CODE_BYTES] = inRam ? inRam.end - inRam.start : 0;
  }
}

// null: it cannot be loaded, as while new ones are being made.
function libraryOf({ library }) {
  try {
    return createRequire(import.meta.url)(library);
  } catch {
    return null;
  }
}

export const blocks = new Blocks(firmwaresIn(FOLDER));
