// SPDX-License-Identifier: MIT
// The first second of a panel on an erased flash, in which it writes that: what the processor was
// and when, and how often it asked whether the flash was done. Used by test_emulated_processor.py.
//
//     node waits_for_flash.mjs            as it is
//     node waits_for_flash.mjs patiently  each round of waiting is run
import { createHash } from 'node:crypto';
import fs from 'node:fs';
import { layUf2 } from '../../tools/emulator/rp2040/flash.mjs';
import { Pico } from '../../tools/emulator/rp2040/pico.mjs';

const PANEL = new URL('../../build/pico/panel.uf2', import.meta.url);
const SECOND = 1e9, SLICE = 777777; // ns
const nothing = () => {};
const report = new Proxy({ until: Infinity }, { get: (it, name) => it[name] ?? nothing });

let polls = 0;
const { skipPolls } = Pico.prototype;
Pico.prototype.skipPolls = function counted(until) {
  polls++;
  if (process.argv[2] === 'patiently') this.hasPolled = false;
  else skipPolls.call(this, until);
};

const pico = new Pico({ usb: false }, (bytes) => layUf2(fs.readFileSync(PANEL), bytes), 0, report);
const hash = createHash('sha256');
while (pico.clock.nanos < SECOND) {
  pico.run(pico.clock.nanos + SLICE);
  hash.update(`${pico.clock.nanos} ${pico.core.APSR} ${pico.core.registers.join(' ')}\n`);
}
hash.update(pico.flash.bytes);
console.log(JSON.stringify({ polls, was: hash.digest('hex') }));
