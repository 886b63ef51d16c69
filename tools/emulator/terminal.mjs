// SPDX-License-Identifier: MIT
// The pty through which a person's programs talk to the chip's USB serial port.
//
// Nothing here waits: bytes that nobody takes are kept up to a limit, then dropped, as a terminal
// that is not looked at does.
import fs from 'node:fs';

const WAITING_BYTES = 65536;
const WAITS = new Set(['EAGAIN', 'EIO']); // EIO: nobody has opened the other side

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
    const { descriptor, buffer } = this;
    return buffer.subarray(0, ifReady(() => fs.readSync(descriptor, buffer)) ?? 0);
  }

  write(bytes) {
    if (this.waiting.length < WAITING_BYTES) this.waiting = Buffer.concat([this.waiting, bytes]);
    this.pass();
  }

  pass() {
    while (this.waiting.length) {
      const count = ifReady(() => fs.writeSync(this.descriptor, this.waiting));
      if (count === undefined) return;
      this.waiting = this.waiting.subarray(count);
    }
  }
}

// What `call` returns; undefined where it would have to wait. Node throws an error then, here once a
// millisecond: without the stack in it, that costs less.
function ifReady(call) {
  const { stackTraceLimit } = Error;
  Error.stackTraceLimit = 0;
  try {
    return call();
  } catch (error) {
    if (WAITS.has(error.code)) return undefined;
    throw error;
  } finally {
    Error.stackTraceLimit = stackTraceLimit;
  }
}
