// SPDX-License-Identifier: MIT
// Runs build/pico/panel.uf2 with blocks (tools/emulator/rp2040/blocks) and without. Prints for each a
// digest of registers, flags and the time, taken every 0.8 ms, and of the RAM at the end; and how many
// times `interpret` has handed over to a block.
import { createHash } from 'node:crypto';
import fs from 'node:fs';
import { blocks } from '../../tools/emulator/rp2040/blocks/blocks.mjs';
import { layUf2 } from '../../tools/emulator/rp2040/flash.mjs';
import { Pico } from '../../tools/emulator/rp2040/pico.mjs';
import { ram } from '../../tools/emulator/rp2040/processor.mjs';

const PANEL = new URL('../../build/pico/panel.uf2', import.meta.url);
const NANOS = 2.5e9, SLICE_NANOS = 777777;
const REPORT = new Proxy({ until: Infinity }, { get: (it, name) => it[name] ?? (() => {}) });

function run() {
  const image = (bytes) => layUf2(fs.readFileSync(PANEL), bytes);
  const pico = new Pico({ usb: false }, image, 0, REPORT);
  const digest = createHash('sha256');
  let runs = 0;
  const { run: execute } = blocks;
  if (blocks.firmware) blocks.run = (left) => { runs++; return execute(left); };
  while (pico.clock.nanos < NANOS) {
    pico.run(pico.clock.nanos + SLICE_NANOS);
    digest.update(`${pico.clock.nanos} ${pico.core.APSR} ${pico.core.registers.join()};`);
  }
  return { runs, digest: digest.update(ram).digest('hex') };
}

const withBlocks = run();
blocks.firmwares = [];
console.log(JSON.stringify([withBlocks, run()]));
