// SPDX-License-Identifier: MIT
// The cache through which the processor reads the flash (RP2040 data sheet, 2.6.3), and its
// control registers: 16 KiB, two ways, lines of 8 bytes.
//
// It holds no bytes, only which lines are there: what a read costs. Of a set it knows the line
// that was used last and the other one, which the next miss drops. The reading is in processor.ts.
import { BasePeripheral } from './library.mjs';
import { lines } from './processor.mjs';

const NOTHING = -1;

export function flushCache() {
  lines.fill(NOTHING);
}

const CTRL = 0x00, FLUSH = 0x04, STAT = 0x08;
const ENABLED = 0x3; // after a reset: on, and writing to the flash is an error
const FLUSHED = 0x3; // at once; and the FIFO of the streaming, which is not modelled, is empty

export class CacheControl extends BasePeripheral {
  constructor(mcu) {
    super(mcu, 'XIP_CTRL');
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
    if (offset === FLUSH && value & 1) flushCache();
  }
}
