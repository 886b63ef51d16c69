// SPDX-License-Identifier: MIT
// The single-cycle I/O block: rp2040js's, with the FIFO to the second core. Its divider and its locks
// processor.ts has.
//
// The second core is not there. The SDK resets it at a soft reset of MicroPython, and waits for
// the zero that a core which comes out of reset sends.
import { RPSIO } from './library.mjs';
import { SPINLOCKS, state } from './processor.mjs';

const FIFO_STATUS = 0x50, FIFO_WRITE = 0x54, FIFO_READ = 0x58;
const VALID_AND_READY = 3;

export class Sio extends RPSIO {
  get spinLock() { return state[SPINLOCKS]; }

  set spinLock(taken) { state[SPINLOCKS] = taken; }

  readUint32(offset) {
    if (offset === FIFO_STATUS) return VALID_AND_READY;
    if (offset === FIFO_READ) return 0;
    return super.readUint32(offset);
  }

  writeUint32(offset, value) {
    if (offset >= FIFO_STATUS && offset <= FIFO_WRITE) return;
    super.writeUint32(offset, value);
  }
}
