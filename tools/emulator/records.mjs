// SPDX-License-Identifier: MIT
// The records of the protocol, on the two pipes (see README.md). Everything is synchronous.
import fs from 'node:fs';

export const RECORD_BYTES = 12; // <QBBH: time in nanoseconds, kind, a, b

export class Reader {
  constructor(descriptor) {
    this.descriptor = descriptor;
    this.buffer = Buffer.alloc(65536);
    this.from = 0;
    this.to = 0;
  }

  // The next `count` bytes; null when the other side is gone. Valid until the next call.
  bytes(count) {
    if (count > this.buffer.length) throw new Error('a record is longer than 64 KiB');
    if (this.from + count > this.buffer.length) {
      this.buffer.copyWithin(0, this.from, this.to);
      this.to -= this.from;
      this.from = 0;
    }
    while (this.to - this.from < count) {
      const got = fs.readSync(this.descriptor, this.buffer, this.to, this.buffer.length - this.to);
      if (got === 0) return null;
      this.to += got;
    }
    this.from += count;
    return this.buffer.subarray(this.from - count, this.from);
  }

  record() {
    const bytes = this.bytes(RECORD_BYTES);
    if (bytes === null) return null;
    const time = bytes.readUInt32LE(0) + bytes.readUInt32LE(4) * 2 ** 32;
    return { time, kind: String.fromCharCode(bytes[8]), a: bytes[9], b: bytes.readUInt16LE(10) };
  }
}

export class Writer {
  constructor(descriptor) {
    this.descriptor = descriptor;
    this.buffer = Buffer.alloc(65536);
    this.records = []; // { time, bytes } of this answer
  }

  add(time, kind, a, b, payload) {
    const bytes = Buffer.alloc(RECORD_BYTES + (payload?.length ?? 0));
    bytes.writeUInt32LE(time % 2 ** 32, 0);
    bytes.writeUInt32LE(Math.floor(time / 2 ** 32), 4);
    bytes[8] = kind.charCodeAt(0);
    bytes[9] = a;
    bytes.writeUInt16LE(b, 10);
    if (payload) bytes.set(payload, RECORD_BYTES);
    this.records.push({ time, bytes });
  }

  // Sends the answer: D, and the records in order of time.
  finish(time) {
    const records = this.records.sort((one, other) => one.time - other.time);
    const length = records.reduce((sum, { bytes }) => sum + bytes.length, 0);
    this.records = [];
    this.add(time, 'D', length >> 16, length & 0xffff);
    const all = Buffer.concat([...this.records, ...records].map(({ bytes }) => bytes));
    this.records = [];
    try {
      for (let at = 0; at < all.length;) at += fs.writeSync(this.descriptor, all, at);
    } catch (error) {
      if (error.code !== 'EPIPE') throw error;
      process.exit(0); // nobody waits for the answer any more
    }
  }
}
