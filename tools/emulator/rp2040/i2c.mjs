// SPDX-License-Identifier: MIT
// Devices on I2C0 that acknowledge what is written to them, and how long that takes.
//
// Two ways lead to them: the I2C peripheral, and the pins SDA and SCL moved by software (which is
// how MicroPython asks whether a device is there). Nothing can be read from these devices: they
// answer 0xFF.

export const SDA = 0, SCL = 1; // GPIO numbers
const CYCLE_NANOS = 8;
const BYTE_BITS = 9; // with the acknowledge bit
const TX_EMPTY = 1 << 4; // of the raw interrupts

const RESET_STATE = {
  state: 0, busy: false, stop: false, pendingRestart: false, firstByte: false,
  enable: 0, abortSource: 0, intRaw: 0, intEnable: 0,
};

// The peripheral: rp2040js's, given time and devices.
export class TimedI2c {
  // written(address, byte): a byte was written and acknowledged.
  constructor(mcu, peripheral, addresses, written) {
    const alarm = mcu.clock.createAlarm(() => this.done());
    this.done = () => {};
    const after = (bits, done) => {
      const { sclHighPeriod, sclLowPeriod } = peripheral;
      this.done = done;
      alarm.schedule(bits * (sclHighPeriod + sclLowPeriod) * CYCLE_NANOS);
    };
    let target = 0;
    peripheral.onStart = () => after(1, () => peripheral.completeStart());
    peripheral.onConnect = (address) => {
      target = address;
      after(BYTE_BITS, () => {
        peripheral.completeConnect(addresses.has(address));
        // What was to be written is thrown away then, which rp2040js does but does not tell.
        if (!addresses.has(address)) peripheral.setInterrupts(TX_EMPTY);
      });
    };
    peripheral.onWriteByte = (byte) => after(BYTE_BITS, () => {
      written(target, byte);
      peripheral.completeWrite(true);
    });
    peripheral.onReadByte = () => after(BYTE_BITS, () => peripheral.completeRead(0xff));
    peripheral.onStop = () => after(1, () => peripheral.completeStop());
    peripheral.reset = () => {
      alarm.cancel();
      peripheral.txFIFO.reset();
      peripheral.rxFIFO.reset();
      Object.assign(peripheral, RESET_STATE);
      peripheral.checkInterrupts();
    };
  }
}

// The same devices, as the pins see them. `hold(low)` is the device's side of SDA.
export class BitBangedI2c {
  constructor(addresses, written, hold) {
    this.addresses = addresses;
    this.written = written;
    this.hold = hold;
    this.sda = this.scl = 1;
    this.idle();
  }

  idle() {
    this.bits = -1; // of the byte so far; -1 before a start condition
    this.byte = 0;
    this.target = -1; // the address, once one of ours was called
    this.acknowledging = false;
  }

  powerFails() {
    this.idle();
    this.hold(false);
  }

  // A reset of the chip is none for the device: it goes on with what the pins do.
  levels(sda, scl) {
    const before = { sda: this.sda, scl: this.scl };
    this.sda = sda;
    this.scl = scl;
    if (before.scl && scl && before.sda !== sda) {
      const held = this.acknowledging;
      this.idle();
      if (!sda) this.bits = 0; // a start condition; otherwise it was a stop
      if (held) this.hold(false);
    } else if (!before.scl && scl) {
      this.clockRises(sda);
    } else if (before.scl && !scl) {
      this.clockFalls();
    }
  }

  clockRises(sda) {
    if (this.bits < 0) return;
    if (this.bits < 8) this.byte = ((this.byte << 1) | sda) & 0xff;
    this.bits++;
  }

  clockFalls() {
    if (this.bits === 8) {
      const called = this.target < 0 && this.addresses.has(this.byte >> 1);
      const writing = this.target >= 0;
      if (!called && !writing) {
        this.idle();
        return;
      }
      this.acknowledging = true;
      this.hold(true);
    } else if (this.bits === BYTE_BITS) {
      this.acknowledging = false;
      this.hold(false);
      if (this.target >= 0) this.written(this.target, this.byte);
      else this.target = this.byte >> 1;
      this.bits = this.byte = 0;
    }
  }
}
