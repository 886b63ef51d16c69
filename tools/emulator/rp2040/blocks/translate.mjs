// SPDX-License-Identifier: MIT
// Makes blocks of what a chip has executed often until now: NAME.c and NAME.json (blocks.mjs).
import fs from 'node:fs';
import { Block } from './block.mjs';
import { codeAt, halfOf, memories, memoryAt } from './blocks.mjs';
import { addresses, jumps } from '../processor.mjs';

const OFTEN = 2000; // jumps: of all that there are, 97 in 100 lead to places with so many

function half(address) {
  const [low, high] = codeAt(address, 2);
  return high === undefined ? undefined : low | (high << 8);
}

// Where jumps have led often, in order.
function places({ start, bytes }) {
  const found = [];
  for (let pc = start; pc < start + bytes.length; pc += 2) {
    if (jumps[halfOf(pc)] >= OFTEN) found.push(pc);
  }
  return found;
}

function blocksIn(memory) {
  return places(memory).map((pc) => new Block(pc, half, memory === memories.flash))
    .filter(({ instructions }) => instructions.length > 0);
}

const nameOf = (pc) => `at_${pc.toString(16)}`;

export function translate(path) {
  const [flash, ram, rom] = ['flash', 'ram', 'rom'].map((name) => blocksIn(memories[name]));
  const made = [...flash, ...ram, ...rom];
  const starts = new Set(made.map(({ start }) => start));
  // Each memory changes by itself, so none knows the blocks of another.
  const siblingOf = (block) => (pc) =>
    (starts.has(pc) && memoryAt(pc) === memoryAt(block.start) ? nameOf(pc) : undefined);
  const names = made.map(({ start }) => nameOf(start));
  fs.writeFileSync(`${path}.c`, [
    ...Object.entries(addresses).map(([name, address]) => `#define ${name} ${address}u`),
    '#include "native.h"',
    ...names.map((name) => `static word ${name}(STATE);`),
    ...made.map((block) =>
      `static word ${nameOf(block.start)}(STATE)\n{\n${block.translate(siblingOf(block))}\n}`),
    `const block blocks[] = {nowhere, ${names.join(', ')}};`, '',
  ].join('\n'));
  const list = (blocks) => blocks.map(({ start, bytes }) =>
    [start, Buffer.from(codeAt(start, bytes)).toString('base64')]);
  fs.writeFileSync(`${path}.json`,
    JSON.stringify({ addresses, flash: list(flash), ram: list(ram), rom: list(rom) }));
}
