// SPDX-License-Identifier: MIT
// Makes blocks of what a chip has executed often until now: NAME.c and NAME.json (blocks.mjs).
import fs from 'node:fs';
import { Block } from './block.mjs';
import { codeAt, FLASH, halfOf, RAM } from './blocks.mjs';
import { addresses, flash, jumps, ram } from '../processor.mjs';

const OFTEN = 2000; // jumps: of all that there are, 97 in 100 lead to places with so many

const isInFlash = (pc) => pc < RAM;

function half(address) {
  const isThere = isInFlash(address) ? address < FLASH + flash.length : address < RAM + ram.length;
  const [low, high] = isThere ? codeAt(address, 2) : [];
  return isThere ? low | (high << 8) : undefined;
}

// Where jumps have led often, in order.
function places() {
  const found = [];
  for (const [area, start] of [[flash, FLASH], [ram, RAM]]) {
    for (let pc = start; pc < start + area.length; pc += 2) {
      if (jumps[halfOf(pc)] >= OFTEN) found.push(pc);
    }
  }
  return found;
}

const nameOf = (pc) => `at_${pc.toString(16)}`;

export function translate(path) {
  const made = places().map((pc) => new Block(pc, half, isInFlash(pc)))
    .filter(({ instructions }) => instructions.length > 0);
  const starts = new Set(made.map(({ start }) => start));
  // Flash and RAM change each by itself, so neither knows the blocks of the other.
  const siblingOf = (block) => (pc) =>
    (starts.has(pc) && isInFlash(pc) === block.isInFlash ? nameOf(pc) : undefined);
  const names = made.map(({ start }) => nameOf(start));
  fs.writeFileSync(`${path}.c`, [
    ...Object.entries(addresses).map(([name, address]) => `#define ${name} ${address}u`),
    '#include "native.h"',
    ...names.map((name) => `static word ${name}(STATE);`),
    ...made.map((block) =>
      `static word ${nameOf(block.start)}(STATE)\n{\n${block.translate(siblingOf(block))}\n}`),
    `const block blocks[] = {nowhere, ${names.join(', ')}};`, '',
  ].join('\n'));
  const list = (inFlash) => made.filter((block) => block.isInFlash === inFlash)
    .map(({ start, bytes }) => [start, Buffer.from(codeAt(start, bytes)).toString('base64')]);
  fs.writeFileSync(`${path}.json`,
    JSON.stringify({ addresses, flash: list(true), ram: list(false) }));
}
