// SPDX-License-Identifier: MIT
// The cache through which the processor reads the flash (RP2040 data sheet, 2.6.3), and its
// control registers: 16 KiB, two ways, lines of 8 bytes.
//
// It holds no bytes, only which lines are there: what a read costs. Of a set it knows the line
// that was used last and the other one, which the next miss drops.
import { BasePeripheral } from './library.mjs';

export const LINE_SHIFT = 3; // of an address, to the number of its line
const SETS = 1024;
const NOTHING = -1;

export class Cache {
  // missCycles: how long the processor waits for a line that is not there; 0: there is no cache.
  constructor(missCycles) {
    this.missCycles = missCycles | 0;
    this.lines = new Int32Array(2 * SETS); // of each set the line used last, and the other one
    this.flush();
  }

  flush() {
    this.lines.fill(NOTHING);
  }

  // The cycles that the processor waits for a line.
  wait(line) {
    const { lines } = this;
    const at = (line & (SETS - 1)) << 1;
    const last = lines[at];
    if (last === line) return 0;
    lines[at] = line;
    const other = lines[at + 1];
    lines[at + 1] = last;
    return other === line ? 0 : this.missCycles;
  }
}

const CTRL = 0x00, FLUSH = 0x04, STAT = 0x08;
const ENABLED = 0x3; // after a reset: on, and writing to the flash is an error
const FLUSHED = 0x3; // at once; and the FIFO of the streaming, which is not modelled, is empty

export class CacheControl extends BasePeripheral {
  constructor(mcu, cache) {
    super(mcu, 'XIP_CTRL');
    this.cache = cache;
    this.control = ENABLED;
  }

  readUint32(offset) {
    switch (offset) {
      case CTRL: return this.control;
      case STAT: return FLUSHED;
    }
    return 0;
  }

  writeUint32(offset, value) {
    if (offset === CTRL) this.control = value;
    if (offset === FLUSH && value & 1) this.cache.flush();
  }
}
