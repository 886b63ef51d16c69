// SPDX-License-Identifier: MIT
// rp2040js and the boot ROM, from build/emulator (see tools/fetch/emulator.sh).
//
// The environment variable USS_EMULATOR names another folder that holds the two. Some classes that
// are extended here are not on rp2040js's list of exports; they are taken from its files, which is
// why its version is pinned in package.json.
import fs from 'node:fs';
import { fileURLToPath, pathToFileURL } from 'node:url';

const FOLDER = process.env.USS_EMULATOR
  ?? fileURLToPath(new URL('../../../build/emulator', import.meta.url));

async function library(file) {
  return import(pathToFileURL(`${FOLDER}/node_modules/rp2040js/dist/esm/${file}`).href);
}

export const { BasePeripheral, FIFO, GPIOPin, RP2040, USBCDC } = await library('index.js');
export const { CortexM0Core } = await library('cortex-m0-core.js');
export const { RPPIO, StateMachine } = await library('peripherals/pio.js');
export const { RPReset } = await library('peripherals/reset.js');
export const { RPSIO } = await library('sio.js');
export const { RPTimer } = await library('peripherals/timer.js');

const WORDS = 4096;

export function bootRom() {
  const file = fs.readFileSync(`${FOLDER}/bootrom.bin`);
  if (file.length !== 4 * WORDS) throw new Error('bootrom.bin has not got 4096 words');
  return new Uint32Array(file.buffer.slice(file.byteOffset, file.byteOffset + file.length));
}
