// SPDX-License-Identifier: MIT
// The emulated Pico: rp2040js's chip with what it lacks put in, its flash, the wires at its pins.
//
// One object is one Pico; `run` moves its time, `pulseRunPin` and `cutPower` are what they are
// called. It tells what happens through the `report` it was given (see the methods called on it
// below and main.mjs). A reset makes a new chip; flash, wires and time stay.
import { CacheControl, flushCache } from './cache.mjs';
import { Clock } from './clock.mjs';
import { Core } from './core.mjs';
import { LineDecoder } from './decoder.mjs';
import { giveTime } from './dma.mjs';
import { Flash, IoQspi, Ssi } from './flash.mjs';
import { BitBangedI2c, SCL, SDA, TimedI2c } from './i2c.mjs';
import { bootRom, RP2040 } from './library.mjs';
import { HIGH, isUart, LOW, RELEASED, Wires } from './pins.mjs';
import { TimedPio } from './pio.mjs';
import { flash, ram, rom } from './processor.mjs';
import { Resets } from './resets.mjs';
import { Sio } from './sio.mjs';
import { ExactTimer } from './timer.mjs';
import { TimedUart } from './uart.mjs';
import { UsbSerial } from './usb.mjs';
import { BY_TIMER, ChipReset, HAD_POWER_ON, HAD_RUN_PIN, Watchdog } from './watchdog.mjs';

const LINE = { tx: 4, rx: 5, enable: 6, uart: 1 }; // GPIO numbers and the UART at the RX pin
const BITS = 11; // of a character on the line
const START = 0x10000000; // of the second-stage boot loader, at the beginning of the flash
const ROM = bootRom();
const RUNS_IN_BUSY_FLASH = 'the program runs in the flash while that is being written';
const WHY = { watchdog: 1, software: 2, runPin: 2, power: 3 }; // the chip restarted; as reported

// What differs from chip to chip, or what the documents leave open (README.md): each with what it
// may be, the first of which it is where nobody says anything.
const MODEL = {
  cache_miss_cycles: [60, 0], // 0: no cache is modelled, the flash is as fast as RAM
  flash_times: ['typical', 'maximum'], // of the data sheet
  receive_timeout: ['once', 'again', 'never'], // cleared while characters are left in the FIFO
};

function modelOf(wanted) {
  const model = {};
  for (const name in MODEL) model[name] = wanted[name] ?? MODEL[name][0];
  for (const name in wanted) {
    const allowed = MODEL[name];
    const good = allowed && (typeof allowed[0] === 'number'
      ? Number.isInteger(wanted[name]) && wanted[name] >= 0 : allowed.includes(wanted[name]));
    if (!good) throw new Error(`there is no model with ${name} ${wanted[name]}`);
  }
  return model;
}

export class Pico {
  // options: { baud, watch, i2c, usb, seed, model, jumpers }; image(bytes) fills the flash.
  constructor(options, image, nanos, report) {
    this.report = report;
    this.model = modelOf(options.model ?? {});
    this.baud = options.baud ?? 9600; // of the chip on the line
    this.watched = new Set(options.watch ?? []);
    this.addresses = new Set(options.i2c ?? []);
    this.hasUsb = options.usb ?? true;
    this.flash = new Flash((code, duration) => report.flash(code, duration), options.seed ?? 1,
      this.model.flash_times, () => this.polled());
    image(this.flash.bytes);
    this.jumpers = options.jumpers ?? []; // [from, to] of each: GPIO numbers
    this.hearsItself = this.jumpers.some(([from, to]) => from === LINE.tx && to === LINE.rx);
    this.decoder = new LineDecoder(this.baud, (...character) => this.said(...character));
    this.wires = new Wires((gpio, state) => this.pinChanged(gpio, state),
      (...move) => this.wireMoved(...move), this.addresses.size ? [SDA, SCL] : []);
    this.written = (address, byte) => report.written(address, byte);
    this.bus = new BitBangedI2c(this.addresses, this.written,
      (low) => this.wires.drive(SDA, low ? LOW : RELEASED));
    this.pendingReset = 0;
    this.build(nanos, HAD_POWER_ON);
  }

  // Making a chip

  build(nanos, cause) {
    this.cause = cause; // as CHIP_RESET tells it, which the watchdog does not touch
    const clock = new Clock(nanos);
    const mcu = new RP2040(clock);
    this.clock = clock;
    this.poll = null; // the last one of the flash's status
    this.hasPolled = false; // just now
    this.mcu = mcu;
    mcu.logger = this.report;
    mcu.bootrom = rom;
    mcu.bootrom.set(ROM);
    mcu.sram = ram.fill(0);
    mcu.sramView = new DataView(ram.buffer, ram.byteOffset, ram.length);
    mcu.flash = flash;
    mcu.flash16 = new Uint16Array(flash.buffer, flash.byteOffset, flash.length >> 1);
    mcu.flashView = new DataView(flash.buffer, flash.byteOffset, flash.length);
    flushCache();
    this.core = mcu.core = new Core(mcu, this.model.cache_miss_cycles);
    this.core.SP = ROM[0];
    this.core.PC = START;
    this.flash.reset(clock);
    this.decoder.reset(clock);
    this.putIn(mcu, cause);
    this.wires.join(mcu);
  }

  putIn(mcu, cause) {
    const { peripherals, clock } = mcu;
    for (const index of [0, 1]) {
      const uart = new TimedUart(mcu, index, () => this.wires.uartMoved(index),
        (baud) => this.uartTuned(index, baud), this.model.receive_timeout);
      mcu.uart[index] = peripherals[0x40034 + 4 * index] = uart;
      mcu.pio[index] = peripherals[0x50200 + 0x100 * index] = new TimedPio(mcu, index);
    }
    giveTime(mcu.dma);
    mcu.sio = new Sio(mcu);
    this.watchdog = new Watchdog(mcu, (reason) => this.bitten(reason));
    new TimedI2c(mcu, mcu.i2c[0], this.addresses, this.written);
    new TimedI2c(mcu, mcu.i2c[1], new Set(), this.written);
    peripherals[0x4000c] = new Resets(mcu, 'RESETS');
    peripherals[0x14000] = new CacheControl(mcu);
    peripherals[0x18000] = new Ssi(mcu, this.flash);
    peripherals[0x40018] = new IoQspi(mcu, this.flash);
    peripherals[0x40054] = new ExactTimer(mcu);
    peripherals[0x40058] = this.watchdog;
    peripherals[0x4005c].baselineNanos = clock.nanos; // the calendar starts with the chip
    peripherals[0x40064] = new ChipReset(mcu, cause);
    this.usb = this.hasUsb ? new UsbSerial(mcu, (bytes) => this.report.serial(bytes)) : null;
  }

  // Time

  // Runs until the instant, or until `report.until`, which what happens meanwhile may move.
  run(instant) {
    const { report } = this;
    for (;;) {
      const { clock, core } = this;
      const until = Math.min(instant, report.until);
      if (clock.nanosCounter >= until) return;
      if (core.waiting) {
        clock.skip(until);
      } else {
        if (core.inFlash && this.flash.busy) report.failed(RUNS_IN_BUSY_FLASH);
        core.run(until);
        if (this.hasPolled) this.skipPolls(until);
      }
      clock.fire();
      if (this.pendingReset) this.restartBitten();
    }
  }

  polled() {
    this.hasPolled = true;
    this.core.leave = true;
  }

  // Interrupts masked, the program waits for the flash, in rounds that are all alike. When two have
  // taken equally long and changed no register, nothing is lost if those up to the next alarm are
  // left out. A third of what a host spends on a test that writes files goes into them.
  skipPolls(until) {
    this.hasPolled = false;
    const { clock, core, poll } = this;
    const now = clock.nanosCounter, registers = core.registers.join();
    const nanos = poll ? now - poll.now : 0;
    if (core.PM && nanos === poll?.nanos && registers === poll.registers) {
      const left = Math.min(this.flash.busyUntil, clock.dueAt, until) - now;
      clock.nanosCounter += nanos * Math.max(0, Math.floor(left / nanos) - 1);
    }
    this.poll = { now: clock.nanosCounter, nanos, registers };
  }

  // Restarting

  bitten(reason) {
    this.pendingReset = reason;
    this.core.leave = true;
  }

  restartBitten() {
    const reason = this.pendingReset;
    const old = this.watchdog;
    this.restart(this.cause, reason === BY_TIMER ? WHY.watchdog : WHY.software);
    this.watchdog.takeOver(old, reason);
  }

  pulseRunPin() {
    this.restart(HAD_RUN_PIN, WHY.runPin);
  }

  cutPower() {
    this.flash.powerFails();
    this.bus.powerFails();
    this.restart(HAD_POWER_ON, WHY.power);
  }

  // The flash knows no reset: what it is doing it finishes, and the boot ROM waits for that.
  restart(cause, why) {
    this.pendingReset = 0;
    const now = this.clock.nanosCounter;
    this.build(now, cause);
    if (this.flash.busy) {
      this.core.waiting = true;
      this.clock.createAlarm(() => { this.core.waiting = false; }).at(this.flash.busyUntil);
    }
    this.report.restarted(why);
  }

  // The pins

  drive(gpio, state) {
    this.wires.drive(gpio, state);
  }

  pinChanged(gpio, state) {
    if (this.watched.has(gpio)) this.report.pin(gpio, state);
    if (gpio === LINE.tx) this.decoder.change(state === LOW ? 0 : 1);
    if (gpio === LINE.enable) {
      this.report.driver();
      this.core.leave = true;
    }
  }

  // A character is over, but for half a bit, at the TX pin. A jumper brings it to the RX pin.
  said(start, byte, parityWrong, stopWrong) {
    const isDriven = this.wires.level[LINE.enable] === HIGH;
    this.report.character(start, byte, parityWrong, stopWrong, isDriven);
    if (!this.hearsItself) return;
    const { baud, clock } = this;
    const heard = () => this.receive(byte, !!parityWrong, !!stopWrong, baud);
    clock.createAlarm(heard).at(start + (BITS * 1e9) / baud);
  }

  wireMoved(gpio, level) {
    for (const [from, to] of this.jumpers) if (from === gpio) this.wires.drive(to, level);
    if (gpio !== SDA && gpio !== SCL) return;
    this.bus.levels(this.wires.level[SDA], this.wires.level[SCL]);
  }

  uartTuned(index, baud) {
    if (index !== LINE.uart || baud === this.baud) return;
    this.baud = baud;
    this.decoder.tune(baud);
    this.report.tuned(baud);
  }

  // A character has come in at the RX pin from a talker of this rate.
  receive(byte, parityWrong, framingWrong, baud) {
    if (!isUart(this.mcu.gpio[LINE.rx])) return;
    this.mcu.uart[LINE.uart].receive(byte, parityWrong, framingWrong, baud);
  }

  send(bytes) {
    this.usb?.send(bytes);
  }

  readUsb(on) {
    this.usb?.read(on);
  }
}
