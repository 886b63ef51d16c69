// SPDX-License-Identifier: MIT
// A PL011 UART with time: characters take as long as they take on the line.
//
// FIFOs of 32, BUSY, the level and time-out interrupts, parity, framing and overrun errors, DMA
// requests. What is sent appears bit by bit at the TX pins whose function is UART; what is
// received comes in as whole characters by `receive`, at the instant of the end of their stop bit.
import { BasePeripheral } from './library.mjs';

const DR = 0x00, FR = 0x18, IBRD = 0x24, FBRD = 0x28, LCR_H = 0x2c, CR = 0x30, IFLS = 0x34;
const IMSC = 0x38, RIS = 0x3c, MIS = 0x40, ICR = 0x44, DMACR = 0x48;
const IDENTITY = {
  0xfe0: 0x11, 0xfe4: 0x10, 0xfe8: 0x34, 0xff0: 0x0d, 0xff4: 0xf0, 0xff8: 0x05, 0xffc: 0xb1,
};

const FRAMING = 1 << 8, PARITY = 1 << 9, OVERRUN = 1 << 11; // beside a character in DR
const RX_LEVEL = 1 << 4, TX_LEVEL = 1 << 5, RX_TIMEOUT = 1 << 6; // in RIS, IMSC, ICR
const FRAMING_ERROR = 1 << 7, PARITY_ERROR = 1 << 8, OVERRUN_ERROR = 1 << 10;
const BUSY = 0x08, RX_EMPTY = 0x10, TX_FULL = 0x20, RX_FULL = 0x40, TX_EMPTY = 0x80, CTS = 0x01;
const PARITY_ENABLED = 0x02, EVEN = 0x04, TWO_STOP = 0x08, FIFOS = 0x10; // in LCR_H
const UART_ON = 0x001, LOOPBACK = 0x080, TX_ON = 0x100, RX_ON = 0x200; // in CR
const RX_DMA = 1, TX_DMA = 2; // in DMACR
const LEVELS = [4, 8, 16, 24, 28];
const TIMEOUT_BITS = 32;
const BAUD_TOLERANCE = 0.03;

export class TimedUart extends BasePeripheral {
  // onLevel(): the level of the TX line has changed. onRate(baud): it was set to a rate.
  // receiveTimeout: 'again', when it was cleared it is there again as long as its characters are
  // left in the FIFO; 'once', it is not; 'never', it does not come at all.
  constructor(mcu, index, onLevel, onRate, receiveTimeout) {
    super(mcu, 'UART' + index);
    const { irq, dreq } = mcu.uart[index];
    this.irq = irq;
    this.dreq = dreq;
    this.onLevel = onLevel;
    this.onRate = onRate;
    this.receiveTimeout = receiveTimeout;
    this.bitAlarm = mcu.clock.createAlarm(() => this.nextBit());
    this.timeoutAlarm = mcu.clock.createAlarm(() => this.timeout());
    this.level = 1; // of the TX line
    this.reset();
  }

  reset() {
    this.bitAlarm.cancel();
    this.timeoutAlarm.cancel();
    this.cr = TX_ON | RX_ON;
    this.lcr = this.ibrd = this.fbrd = this.imsc = this.ris = this.dmacr = 0;
    this.ifls = 0x12;
    this.tx = [];
    this.rx = [];
    this.overrun = false;
    this.timedOut = false; // the FIFO holds characters, and for 32 bits nothing came or was read
    this.bits = null; // of the character being sent: levels, one for each bit
    this.byte = 0; // and what it is
    this.bitsSent = 0;
    this.bitsStart = 0;
    this.setLevel(1);
    this.update();
  }

  clkPeriChanged() {}

  get depth() {
    return this.lcr & FIFOS ? 32 : 1;
  }

  get bitNanos() {
    return 16e9 * (this.ibrd + this.fbrd / 64) / this.rp2040.clkPeri;
  }

  get rxTrigger() {
    return this.lcr & FIFOS ? LEVELS[(this.ifls >> 3) & 7] ?? 16 : 1;
  }

  get txTrigger() {
    return this.lcr & FIFOS ? LEVELS[this.ifls & 7] ?? 16 : 0;
  }

  update() {
    this.rp2040.setInterrupt(this.irq, !!(this.ris & this.imsc));
    const { dma } = this.rp2040;
    if (this.dmacr & TX_DMA && this.tx.length < this.depth) dma.setDREQ(this.dreq.tx);
    else dma.clearDREQ(this.dreq.tx);
    if (this.dmacr & RX_DMA && this.rx.length) dma.setDREQ(this.dreq.rx);
    else dma.clearDREQ(this.dreq.rx);
  }

  // Sending

  begin() {
    if (this.bits || !this.tx.length || !(this.cr & UART_ON) || !(this.cr & TX_ON)) return;
    const byte = this.byte = this.tx.shift();
    const count = 5 + ((this.lcr >> 5) & 3);
    const bits = [0];
    let odd = 0;
    for (let i = 0; i < count; i++) {
      bits.push((byte >> i) & 1);
      odd ^= (byte >> i) & 1;
    }
    if (this.lcr & PARITY_ENABLED) bits.push(this.lcr & EVEN ? odd : odd ^ 1);
    bits.push(1);
    if (this.lcr & TWO_STOP) bits.push(1);
    this.bits = bits;
    this.bitsSent = 0;
    this.bitsStart = this.rp2040.clock.nanos;
    if (this.tx.length <= this.txTrigger) this.ris |= TX_LEVEL;
    this.nextBit();
  }

  // At the beginning of each run of bits of one level, and at the end of the character.
  nextBit() {
    const { bits } = this;
    let at = this.bitsSent;
    if (at === bits.length) {
      this.bits = null;
      if (this.cr & LOOPBACK && this.cr & RX_ON) this.push(this.byte, false, false);
      this.begin();
      this.update();
      return;
    }
    const level = bits[at];
    while (at < bits.length && bits[at] === level) at++;
    this.bitsSent = at;
    this.bitAlarm.at(this.bitsStart + at * this.bitNanos);
    this.setLevel(level);
  }

  setLevel(level) {
    if (level === this.level) return;
    this.level = level;
    this.onLevel();
  }

  // Receiving

  // A character of 8 data bits with even parity has come in from a line of `lineBaud`.
  receive(byte, parityWrong, framingWrong, lineBaud) {
    if (!(this.cr & UART_ON) || !(this.cr & RX_ON) || this.cr & LOOPBACK) return;
    const ratio = 1e9 / this.bitNanos / lineBaud;
    if (!(Math.abs(ratio - 1) <= BAUD_TOLERANCE)) {
      byte ^= 0x5a; // read at the wrong instants, it is anything but what was sent
      framingWrong = true;
    } else if (!(this.lcr & PARITY_ENABLED)) {
      // The parity bit is where the stop bit is looked for.
      if (parityBit(byte) === (parityWrong ? 1 : 0)) framingWrong = true;
      parityWrong = false;
    } else if (!(this.lcr & EVEN)) {
      parityWrong = !parityWrong;
    }
    this.push(byte, parityWrong, framingWrong);
  }

  push(byte, parityWrong, framingWrong) {
    if (this.rx.length >= this.depth) {
      this.overrun = true;
      this.ris |= OVERRUN_ERROR;
    } else {
      this.rx.push(byte | (parityWrong ? PARITY : 0) | (framingWrong ? FRAMING : 0)
        | (this.overrun ? OVERRUN : 0));
      this.overrun = false;
    }
    if (parityWrong) this.ris |= PARITY_ERROR;
    if (framingWrong) this.ris |= FRAMING_ERROR;
    if (this.rx.length >= this.rxTrigger) this.ris |= RX_LEVEL;
    this.awaitTimeout();
    this.update();
  }

  awaitTimeout() {
    this.timedOut = false;
    this.timeoutAlarm.schedule(TIMEOUT_BITS * this.bitNanos);
  }

  timeout() {
    if (!this.rx.length || this.receiveTimeout === 'never') return;
    this.timedOut = true;
    this.ris |= RX_TIMEOUT;
    this.update();
  }

  pull() {
    const value = this.rx.shift() ?? 0;
    if (this.rx.length < this.rxTrigger) this.ris &= ~RX_LEVEL;
    if (this.rx.length) {
      this.awaitTimeout();
    } else {
      this.timedOut = false;
      this.ris &= ~RX_TIMEOUT;
      this.timeoutAlarm.cancel();
    }
    this.update();
    return value;
  }

  // Registers

  get flags() {
    const { tx, rx, depth } = this;
    return (tx.length || this.bits ? BUSY : 0) | (rx.length ? 0 : RX_EMPTY) | CTS
      | (tx.length >= depth ? TX_FULL : 0) | (rx.length >= depth ? RX_FULL : 0)
      | (tx.length ? 0 : TX_EMPTY);
  }

  readUint32(offset) {
    switch (offset) {
      case DR: return this.pull();
      case FR: return this.flags;
      case IBRD: return this.ibrd;
      case FBRD: return this.fbrd;
      case LCR_H: return this.lcr;
      case CR: return this.cr;
      case IFLS: return this.ifls;
      case IMSC: return this.imsc;
      case RIS: return this.ris;
      case MIS: return this.ris & this.imsc;
      case DMACR: return this.dmacr;
    }
    return IDENTITY[offset] ?? 0;
  }

  writeUint32(offset, value) {
    switch (offset) {
      case DR:
        if (this.tx.length < this.depth) this.tx.push(value & 0xff);
        if (this.tx.length > this.txTrigger) this.ris &= ~TX_LEVEL;
        this.begin();
        break;
      case IBRD: this.ibrd = value & 0xffff; break;
      case FBRD: this.fbrd = value & 0x3f; break;
      case LCR_H: // it makes the divisors act as well
        this.lcr = value & 0xff;
        if (this.ibrd && !(this.cr & LOOPBACK)) this.onRate(1e9 / this.bitNanos);
        break;
      case CR:
        this.cr = value & 0xffff;
        this.begin();
        break;
      case IFLS: this.ifls = value & 0x3f; break;
      case IMSC: this.imsc = value & 0x7ff; break;
      case ICR:
        this.ris &= ~this.rawWriteValue;
        if (this.receiveTimeout === 'again' && this.timedOut) this.ris |= RX_TIMEOUT;
        break;
      case DMACR: this.dmacr = value & 7; break;
    }
    this.update();
  }
}

function parityBit(byte) {
  let bit = 0;
  for (let i = 0; i < 8; i++) bit ^= (byte >> i) & 1;
  return bit;
}
