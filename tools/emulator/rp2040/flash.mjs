// SPDX-License-Identifier: MIT
// The flash chip (2 MiB SPI-NOR, as on the Pico) and the two peripherals through which it is
// reached when it is written: the SSI in its plain mode and the chip select in IO_QSPI.
//
// Erasing and programming take their time. When the power fails meanwhile, what was being written
// is garbage afterwards; what the reset pin or the watchdog interrupts is finished by the flash.
import { blocks } from './blocks/blocks.mjs';
import { BasePeripheral } from './library.mjs';
import { flash } from './processor.mjs';

export const FLASH_BYTES = flash.length;

// Operation, as reported: code, bytes that it works on, how long it takes (W25Q16JV, 9.6).
const OPERATIONS = {
  0x20: { code: 1, size: 4096, nanos: { typical: 45e6, maximum: 400e6 } }, // sector erase
  0x02: { code: 2, size: 256, nanos: { typical: 0.7e6, maximum: 3e6 } }, // page program
  0x52: { code: 3, size: 32768, nanos: { typical: 120e6, maximum: 1600e6 } }, // block erase
  0xd8: { code: 3, size: 65536, nanos: { typical: 150e6, maximum: 2000e6 } }, // block erase
};
const PROGRAM = 0x02;

const WRITE_STATUS = 0x01, READ = 0x03, WRITE_DISABLE = 0x04, READ_STATUS = 0x05;
const WRITE_ENABLE = 0x06, READ_STATUS_2 = 0x35, READ_UNIQUE_ID = 0x4b, READ_JEDEC_ID = 0x9f;
const JEDEC_ID = [0xef, 0x40, 0x15];
const UNIQUE_ID = [0xe6, 0x61, 0x41, 0x04, 0x03, 0x55, 0x53, 0x21];
const BUSY = 1, WRITE_ENABLED = 2, QUAD_ENABLED = 2;

export class Flash {
  // report(code, nanos): an operation begins that takes so long. times: "typical" or "maximum".
  // onPoll(): somebody has asked whether it is over, and it is not.
  constructor(report, seed, times, onPoll) {
    this.bytes = flash.fill(0xff);
    this.report = report;
    this.onPoll = onPoll;
    this.seed = seed;
    this.times = times;
    this.busyUntil = 0;
    this.underWay = null; // the last operation: { area, before }; before: what a page held
    this.reset(null);
  }

  reset(clock) {
    this.clock = clock;
    this.selected = false;
    this.writeEnabled = false;
    this.command = [];
  }

  get busy() {
    return this.clock.nanos < this.busyUntil;
  }

  select(on) {
    if (on === this.selected) return;
    this.selected = on;
    if (on) this.command = [];
    else this.execute();
  }

  execute() {
    const code = this.command[0];
    if (code === WRITE_ENABLE) this.writeEnabled = true;
    else if (code === WRITE_DISABLE || code === WRITE_STATUS) this.writeEnabled = false;
    else if (code in OPERATIONS && this.writeEnabled && !this.busy) this.begin(code);
    else if (code === READ_STATUS && this.busy) this.onPoll();
  }

  begin(code) {
    const { size, nanos, code: reported } = OPERATIONS[code];
    const address = this.address();
    const start = address & ~(size - 1);
    const area = this.bytes.subarray(start, start + size);
    this.underWay = { area, before: code === PROGRAM ? area.slice() : null };
    if (code === PROGRAM) {
      for (let i = 4; i < this.command.length; i++) {
        area[(address + i - 4) & (size - 1)] &= this.command[i];
      }
    } else {
      area.fill(0xff);
    }
    blocks.written(start, size);
    this.writeEnabled = false;
    this.busyUntil = this.clock.nanos + nanos[this.times];
    this.report(reported, nanos[this.times]);
  }

  address() {
    const [, high, middle, low] = this.command;
    return ((high << 16) | (middle << 8) | low) & (FLASH_BYTES - 1);
  }

  // One byte out and one in, as always on SPI.
  exchange(byte) {
    if (!this.selected) return 0;
    const at = this.command.push(byte) - 1;
    switch (at === 0 ? undefined : this.command[0]) {
      case READ_STATUS:
        return (this.busy ? BUSY : 0) | (this.writeEnabled ? WRITE_ENABLED : 0);
      case READ_STATUS_2: return QUAD_ENABLED;
      case READ_JEDEC_ID: return JEDEC_ID[at - 1] ?? 0;
      case READ_UNIQUE_ID: return at > 4 ? UNIQUE_ID[at - 5] ?? 0 : 0;
      case READ: return at > 3 ? this.bytes[(this.address() + at - 4) & (FLASH_BYTES - 1)] : 0;
    }
    return 0;
  }

  // The power fails. An erase programs all bits before it erases them, so anything may be left; of
  // a page some bits are programmed and some not yet.
  powerFails() {
    if (this.busy) {
      const { area, before } = this.underWay;
      for (let i = 0; i < area.length; i++) {
        const garbage = this.random();
        area[i] = before === null ? garbage : before[i] & (area[i] | garbage);
      }
    }
    this.busyUntil = 0;
  }

  random() {
    let x = this.seed | 0 || 1;
    x ^= x << 13;
    x ^= x >>> 17;
    x ^= x << 5;
    this.seed = x;
    return (x >>> 8) & 0xff;
  }
}

const SSIENR = 0x08, TXFLR = 0x20, RXFLR = 0x24, SR = 0x28, IDR = 0x58, VERSION = 0x5c;
const DR_FIRST = 0x60, DR_LAST = 0xec;
const TX_NOT_FULL_AND_EMPTY = 0x06, RX_NOT_EMPTY = 0x08;

export class Ssi extends BasePeripheral {
  constructor(mcu, flash) {
    super(mcu, 'SSI');
    this.flash = flash;
    this.received = [];
    this.registers = new Uint32Array(64);
  }

  readUint32(offset) {
    if (offset >= DR_FIRST && offset <= DR_LAST) return this.received.shift() ?? 0;
    switch (offset) {
      case TXFLR: return 0;
      case RXFLR: return this.received.length;
      case SR: return TX_NOT_FULL_AND_EMPTY | (this.received.length ? RX_NOT_EMPTY : 0);
      case IDR: return 0x51535049;
      case VERSION: return 0x3430312a;
    }
    return this.registers[offset >> 2] ?? 0;
  }

  writeUint32(offset, value) {
    if (offset >= DR_FIRST && offset <= DR_LAST) {
      this.received.push(this.flash.exchange(value & 0xff));
      return;
    }
    if (offset === SSIENR && !(value & 1)) this.received = [];
    this.registers[offset >> 2] = value;
  }
}

const CHIP_SELECT_CTRL = 0x0c;
const OUTPUT_LOW = 2; // of the output override

export class IoQspi extends BasePeripheral {
  constructor(mcu, flash) {
    super(mcu, 'IO_QSPI');
    this.flash = flash;
    this.registers = new Uint32Array(64);
  }

  readUint32(offset) {
    return this.registers[offset >> 2] ?? 0;
  }

  writeUint32(offset, value) {
    this.registers[offset >> 2] = value;
    if (offset === CHIP_SELECT_CTRL) this.flash.select(((value >> 8) & 3) === OUTPUT_LOW);
  }
}

const UF2_BLOCK = 512, UF2_MAGIC = 0x0a324655, UF2_NOT_MAIN_FLASH = 1, XIP_BASE = 0x10000000;

// Lays the blocks of a UF2 file over `bytes`, an image of the flash.
export function layUf2(file, bytes) {
  if (file.length === 0 || file.length % UF2_BLOCK) throw new Error('this is no UF2 file');
  for (let at = 0; at < file.length; at += UF2_BLOCK) {
    if (file.readUInt32LE(at) !== UF2_MAGIC) throw new Error('this is no UF2 file');
    if (file.readUInt32LE(at + 8) & UF2_NOT_MAIN_FLASH) continue;
    const start = file.readUInt32LE(at + 12) - XIP_BASE;
    const length = file.readUInt32LE(at + 16);
    if (start < 0 || length > 476 || start + length > FLASH_BYTES) {
      throw new Error('the UF2 file has a block outside of the 2 MiB of flash');
    }
    bytes.set(file.subarray(at + 32, at + 32 + length), start);
  }
}
