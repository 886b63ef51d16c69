// SPDX-License-Identifier: MIT
// The emulated Pico's server: reads records, runs the chip, answers (README.md has the protocol).
//
//     node main.mjs READ WRITE PTY
//
// are the numbers of inherited descriptors: two pipes and the master side of a pty for the chip's
// USB serial port. launch.py starts it. It ends when the pipe that it reads ends. With
// USS_EMULATOR_BLOCKS=PATH in the environment, it then makes blocks of what it has executed often.
import fs from 'node:fs';
import { translate } from './rp2040/blocks/translate.mjs';
import { Fault } from './rp2040/core.mjs';
import { FLASH_BYTES, layUf2 } from './rp2040/flash.mjs';
import { Pico } from './rp2040/pico.mjs';
import { Reader, Writer } from './records.mjs';
import { Terminal } from './terminal.mjs';

const SLICE_NANOS = 1e6; // how often the pty is looked at
const ORPHAN_SLICES = 20; // and how often whether anybody still waits for the answer
const COMPLAINTS = 20; // different ones, for each chip
const PAYLOADS = new Set(['N', 'U', 'F']);
const UNIT_NANOS = 100000; // of V's duration
const HUNDREDTH_NANOS = 1e7; // of a bit, at 1 bit/s
const UNIT_BAUD = 50; // of a rate: the greatest common divisor of those of USS

// What the chip reports, as records. It is the chip's logger as well.
class Report {
  constructor(server) {
    this.server = server;
    this.until = 0; // the run ends here
    this.complaints = new Set();
  }

  get now() {
    return this.server.now;
  }

  add(kind, a, b, payload) {
    this.server.writer.add(this.now, kind, a, b, payload);
  }

  // isDriven: the chip's driver is on, and so its receiver off.
  character(start, byte, parityWrong, stopWrong, isDriven) {
    this.server.writer.add(start, 'T', byte, parityWrong | (stopWrong << 1));
    this.until = isDriven && !this.server.isHearing() ? this.server.goesOnUntil(start) : this.now;
  }

  // The driver was switched: what is coming in may not be heard.
  driver() {
    if (this.server.isHearing()) this.until = this.now;
  }

  tuned(baud) {
    this.add('B', 0, Math.min(Math.round(baud / UNIT_BAUD), 0xffff));
  }

  pin(gpio, state) {
    this.add('E', gpio, state);
  }

  written(address, byte) {
    this.add('I', address, byte);
  }

  flash(code, nanos) {
    this.add('V', code, nanos / UNIT_NANOS);
  }

  restarted(why) {
    this.add('Z', why, 0);
    this.until = this.now;
  }

  serial(bytes) {
    this.server.serialOut(bytes);
  }

  failed(text) {
    if (this.complaints.size >= COMPLAINTS || this.complaints.has(text)) return;
    this.complaints.add(text);
    const bytes = Buffer.from(text).subarray(0, 1000);
    this.add('!', 0, bytes.length, bytes);
  }

  debug() {}

  info() {}

  // What firmware touches that rp2040js has not got is of interest to who works on this.
  warn(name, text) {
    if (process.env.USS_EMULATOR_WARN) process.stderr.write(`${name}: ${text}\n`);
  }

  error(name, text) {
    this.failed(`${name}: ${text}`);
  }
}

class Server {
  constructor(read, write, pty) {
    this.reader = new Reader(read);
    this.writer = new Writer(write);
    this.terminal = new Terminal(pty);
    this.pico = null;
    this.report = new Report(this);
    this.idleNanos = 0; // the time, while there is no chip
    this.pending = []; // records not yet due, in order of time
    this.run = null; // the R that is being answered
    this.parent = process.ppid;
    this.slices = 0; // run so far
  }

  get now() {
    return this.pico ? this.pico.clock.nanosCounter : this.idleNanos;
  }

  serve() {
    for (;;) {
      const record = this.reader.record();
      if (record === null) return;
      if (PAYLOADS.has(record.kind)) {
        const payload = this.reader.bytes(record.b);
        if (payload === null) return;
        record.payload = Buffer.from(payload);
      }
      if (record.kind === 'R') this.answer(record);
      else if (record.kind === 'W') this.takeBack(record.time);
      else this.queue(record);
    }
  }

  queue(record) {
    const { pending } = this;
    let at = pending.length;
    while (at > 0 && pending[at - 1].time > record.time) at--;
    pending.splice(at, 0, record);
  }

  // Characters that were to come later do not.
  takeBack(after) {
    this.pending = this.pending.filter(({ kind, time }) => kind !== 'C' || time <= after);
  }

  answer(run) {
    this.run = run;
    this.report.until = run.time;
    try {
      this.runAndApply();
    } catch (error) {
      this.report.failed(error instanceof Fault ? `HardFault: ${error.message}` : error.stack);
      this.idleNanos = this.now;
      this.pico = null;
    }
    this.writer.finish(this.now);
  }

  runAndApply() {
    const { pending, report } = this;
    do {
      while (pending.length && pending[0].time <= this.now) this.apply(pending.shift());
      this.runTo(pending.length ? pending[0].time : Infinity);
    } while (this.now < report.until);
  }

  // Whether characters are on their way to the chip.
  isHearing() {
    return this.pending.some(({ kind }) => kind === 'C');
  }

  // The end of the run after a character whose start bit began then: the next one moves it on.
  goesOnUntil(start) {
    const nanos = (this.run.b * HUNDREDTH_NANOS) / this.pico.baud;
    return Math.max(this.now, Math.min(start + nanos, this.run.time));
  }

  runTo(instant) {
    const { report, terminal } = this;
    if (!this.pico) {
      this.idleNanos = Math.min(instant, report.until);
      return;
    }
    while (this.now < Math.min(instant, report.until)) {
      if (terminal.on) this.pico.send(terminal.read());
      if (++this.slices % ORPHAN_SLICES === 0 && process.ppid !== this.parent) process.exit(0);
      this.pico.run(Math.min(instant, this.now + SLICE_NANOS));
    }
  }

  serialOut(bytes) {
    if (this.terminal.on) this.terminal.write(bytes);
    else this.report.add('U', 0, bytes.length, Buffer.from(bytes));
  }

  // Applying records

  apply(record) {
    const { kind, a, b, payload } = record;
    const { pico } = this;
    switch (kind) {
      case 'N': this.newChip(JSON.parse(payload.toString())); break;
      case 'S': this.terminal.on = a === 1; pico?.readUsb(a !== 2); break;
      case 'C': pico?.receive(a, !!(b & 1), !!(b & 2), (b >> 2) * UNIT_BAUD); break;
      case 'P': pico?.drive(a, b); break;
      case 'U': pico?.send(payload); break;
      case 'X': if (a === 1) pico?.cutPower(); else pico?.pulseRunPin(); break;
      case 'K': this.tellDepths(); break;
      case 'F': this.saveFlash(payload.toString()); break;
      default: this.report.failed(`there is no record of the kind "${kind}"`);
    }
  }

  newChip(options) {
    this.idleNanos = this.now;
    this.pico = null;
    this.report.complaints.clear();
    try {
      const image = (bytes) => fillFlash(bytes, options);
      this.pico = new Pico(options, image, this.idleNanos, this.report);
    } catch (error) {
      this.report.failed(`no chip: ${error.message}`);
    }
  }

  tellDepths() {
    const { program, handlers } = this.pico?.core.takeDepths() ?? { program: 0, handlers: 0 };
    this.report.add('K', 0, program);
    this.report.add('K', 1, handlers);
  }

  saveFlash(path) {
    if (!this.pico) return;
    try {
      fs.writeFileSync(path, this.pico.flash.bytes);
    } catch (error) {
      this.report.failed(`the flash could not be saved: ${error.message}`);
    }
  }
}

function fillFlash(bytes, { uf2, flash, keep }) {
  if (flash) {
    const image = fs.readFileSync(flash);
    if (image.length !== FLASH_BYTES) throw new Error(`${flash} has not got 2 MiB`);
    bytes.set(image);
  }
  if (!keep) layUf2(fs.readFileSync(uf2), bytes);
}

process.env.TZ = 'UTC'; // the chip's calendar knows no other, and must not know this machine's
console.warn = () => {}; // rp2040js has a logger, and in places forgets it
const [read, write, pty] = process.argv.slice(2).map(Number);
new Server(read, write, pty).serve();
if (process.env.USS_EMULATOR_BLOCKS) translate(process.env.USS_EMULATOR_BLOCKS);
