// SPDX-License-Identifier: MIT
// The pty through which a person's programs talk to the chip's USB serial port.
//
// Nothing here waits: bytes that nobody takes are kept up to a limit, then dropped, as a terminal
// that is not looked at does.
import fs from 'node:fs';

const WAITING_BYTES = 65536;

export class Terminal {
  constructor(descriptor) {
    this.descriptor = descriptor;
    this.on = false;
    this.buffer = Buffer.alloc(4096);
    this.waiting = Buffer.alloc(0);
  }

  // What was typed by now; it may be nothing.
  read() {
    this.pass();
    try {
      const count = fs.readSync(this.descriptor, this.buffer, 0, this.buffer.length);
      return this.buffer.subarray(0, count);
    } catch (error) {
      if (error.code === 'EAGAIN' || error.code === 'EIO') return this.buffer.subarray(0, 0);
      throw error;
    }
  }

  write(bytes) {
    if (this.waiting.length < WAITING_BYTES) this.waiting = Buffer.concat([this.waiting, bytes]);
    this.pass();
  }

  pass() {
    while (this.waiting.length) {
      try {
        const count = fs.writeSync(this.descriptor, this.waiting);
        this.waiting = this.waiting.subarray(count);
      } catch (error) {
        if (error.code === 'EAGAIN' || error.code === 'EIO') return;
        throw error;
      }
    }
  }
}
