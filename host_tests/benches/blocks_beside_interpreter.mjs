// SPDX-License-Identifier: MIT
// Draws programs by lot, makes blocks of them (tools/emulator/rp2040/blocks), and executes each with
// and without: from the same registers, flags, memory and cache, for as many cycles.
//
//     node blocks_beside_interpreter.mjs SEED FOLDER
//
// FOLDER takes what is compiled. Prints each program that did not do the same, and counts.
import { execFileSync } from 'node:child_process';
import { pathToFileURL } from 'node:url';
import { ROWS } from '../../tools/emulator/rp2040/blocks/block.mjs';
import { Blocks, codeAt, firmwaresIn, halfOf } from '../../tools/emulator/rp2040/blocks/blocks.mjs';
import { translate } from '../../tools/emulator/rp2040/blocks/translate.mjs';
import * as processor from '../../tools/emulator/rp2040/processor.mjs';

const { flash, interpret, jumps, lines, ram, registers, state, times } = processor;

const PROGRAMS = 800, DEALS = 16, LONGEST = 6, SHOWN = 10;
const RAM = 0x20000000, FLASH = 0x10000000, ROM = 0;
const CODE = 0x4000, SPACE = 64; // where programs begin, bytes for each; in RAM and in the flash
const ROM_CODE = 0x400, SHARE_OF_ROM = 5; // one of so many is in the ROM
const DATA = 0x1000, DATA_BYTES = 1024;
const NEAR = [0xd0000000, 0xd0000060, 0xd0000100, 0x40054024]; // core, divider, locks, timer
const END = 0xbe00; // a breakpoint, which is a rare instruction
const SECONDS = [0xd000, 0xf801, 0x8110, 0x8f5f]; // halves: BL, BL, MRS of PRIMASK, DMB
const WIDE = { 0xd000: 0xf000, 0xf801: 0xf000, 0x8110: 0xf3ef, 0x8f5f: 0xf3bf }; // their first ones
const SHARE_OF_SHORT = 3; // one run of so many has few cycles
const BX_PC = 0x4778; // and BLX of it: no compiler writes them, and it jumps to somewhere
const USUAL = ROWS.filter(({ does }) => does);

const [seedGiven, folder] = process.argv.slice(2);
let seed = Number(seedGiven);

function draw(limit) {
  seed = (Math.imul(seed, 1103515245) + 12345) & 0x7fffffff;
  return Math.floor((seed / 0x80000000) * limit);
}

const pick = (list) => list[draw(list.length)];
const halfWord = () => draw(0x10000);

function instruction() {
  const { mask, value } = pick(USUAL);
  const op = value | (halfWord() & ~mask & 0xffff);
  if ((op & 0xff7f) === BX_PC) return instruction();
  if (op >> 11 !== 0b11110) return [op];
  const second = pick(SECONDS);
  return [second < 0x9000 ? WIDE[second] : 0xf000 | draw(2) * 0x7ff, second];
}

function put(address, halves) {
  halves.forEach((half, at) => codeAt(address + 2 * at, 2).set([half & 0xff, half >> 8]));
}

function place(index) {
  if (index % SHARE_OF_ROM === 0) return ROM + ROM_CODE + SPACE * index / SHARE_OF_ROM;
  return (index % 2 ? RAM : FLASH) + CODE + SPACE * index;
}

function programs() {
  const starts = [];
  for (let index = 0; index < PROGRAMS; index++) {
    // Some begin in the midst of a line of the cache.
    const start = place(index) + 2 * draw(4);
    const length = 1 + draw(LONGEST);
    put(start, [...Array.from({ length }, instruction).flat(), END]);
    jumps[halfOf(start)] = 65535;
    starts.push(start);
  }
  return starts;
}

function value(start) {
  switch (draw(6)) {
    case 0: return RAM + DATA + 4 * draw(DATA_BYTES / 8);
    case 1: return FLASH + draw(0x8000);
    case 2: return draw(40);
    case 3: return 0x7ffffff0 + draw(32);
    case 4: return pick([start, start + 8, 0xfffffff9, ...NEAR, ...NEAR]);
  }
  return draw(0x10000) * 0x10000 + draw(0x10000);
}

// What a run begins with.
function deal(start) {
  const dealt = Uint32Array.from({ length: 16 }, () => value(start));
  dealt[13] = pick([RAM + DATA + 128 + 4 * draw(64), RAM + DATA + 128 + draw(256), value(start)]);
  dealt[14] = pick([RAM + CODE + 1, FLASH + CODE + 1, dealt[14]]);
  dealt[15] = start;
  return { dealt, flags: draw(16) << 28, masked: draw(2), miss: pick([0, 60]), fetched: draw(2),
    divider: Array.from({ length: 5 }, () => draw(0x10000)),
    locks: draw(2), began: 1e5 + draw(3) * 2 ** 32 * 999,
    cycles: draw(SHARE_OF_SHORT) ? 400 : 1 + draw(60) };
}

function begin({ dealt, flags, masked, miss, fetched, divider, locks, began, cycles }) {
  ram.set(pristine);
  registers.set(dealt);
  state.fill(0);
  state[processor.APSR] = flags;
  state[processor.PRIMASK] = masked;
  state[processor.LOWEST] = -1;
  state[processor.MISS_CYCLES] = miss;
  state.set(divider, 8);
  state[processor.SPINLOCKS] = locks;
  state[processor.BUDGET] = cycles + 1000;
  times.set([began, 12345]);
  lines.fill(-1);
  if (fetched) for (let set = 0; set < 1024; set += 3) lines[2 * set] = (FLASH + CODE >>> 3) + set;
}

// As Core does, but for what it leaves to rp2040js.
function run(blocks, cycles) {
  let left = cycles;
  state[processor.LINE] = -1;
  state[processor.JUMPED] = 1;
  for (;;) {
    left = interpret(left);
    if (state[processor.WHY] === processor.BLOCK) {
      left = blocks.run(left);
      counts.blocks++;
    } else if (state[processor.WHY] === processor.CHANGED) {
      blocks.changed();
      counts.changed++;
    } else {
      return left;
    }
  }
}

function outcome(left) {
  const words = [...state.subarray(0, processor.LINE), state[processor.SPINLOCKS]];
  if (![processor.LOAD, processor.LOAD_SIGNED, processor.STORE].includes(words[processor.WHY])) {
    words.fill(0, processor.ADDRESS, processor.NUMBER + 1); // left behind
  }
  return { left, registers: [...registers].map((word) => word.toString(16)).join(' '),
    state: words.join(' '), lines: Buffer.from(lines).toString('base64'),
    ram: Buffer.from(ram.subarray(0, CODE + SPACE * PROGRAMS)).toString('base64') };
}

const counts = { same: 0, different: 0, blocks: 0, changed: 0 };
flash.fill(0);
const starts = programs();
const pristine = ram.slice();
translate(`${folder}/drawn`);
const tools = new URL('../../tools', import.meta.url).pathname;
const compile = `emulator_sources=$1/emulator; . "$1/fetch/blocks.sh"; compile_c "$2" -O0`;
execFileSync('bash', ['-c', compile, 'bash', tools, `${folder}/drawn`], { stdio: 'inherit' });
const blocks = new Blocks(firmwaresIn(pathToFileURL(`${folder}/`)));

for (const start of starts) {
  for (let deals = 0; deals < DEALS; deals++) {
    const dealt = deal(start);
    blocks.end();
    begin(dealt);
    const plain = outcome(run(blocks, dealt.cycles));
    begin(dealt);
    blocks.begin();
    blocks.look();
    const translated = outcome(run(blocks, dealt.cycles));
    const names = Object.keys(plain).filter((name) => plain[name] !== translated[name]);
    if (names.length === 0) {
      counts.same++;
    } else if (counts.different++ < SHOWN) {
      console.log(start.toString(16), Buffer.from(codeAt(start, 24)).toString('hex'),
        ...names.filter((name) => !['ram', 'lines'].includes(name))
          .map((name) => `${name} ${plain[name]}, in a block ${translated[name]}`), names.join());
    }
  }
}

// Whoever writes to the flash where they are, has them no more; elsewhere they stay.
ram.set(pristine);
blocks.begin();
blocks.written(0x100000, 4096);
counts.staysBesideWriting = blocks.firmware !== null;
blocks.written(CODE, 256);
counts.goesWithWriting = blocks.firmware === null;
console.log(JSON.stringify(counts));
