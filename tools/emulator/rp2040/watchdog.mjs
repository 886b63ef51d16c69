// SPDX-License-Identifier: MIT
// The watchdog with its true timing and memory: REASON and the scratch registers live through the
// resets that it makes, and the register that tells how the chip came up.
import { BasePeripheral } from './library.mjs';

const CTRL = 0x00, LOAD = 0x04, REASON = 0x08, SCRATCH_FIRST = 0x0c, SCRATCH_LAST = 0x28;
const TICK = 0x2c;
const TRIGGER = 1 << 31, ENABLE = 1 << 30, PAUSE = 7 << 24, TIME = 0xffffff;
const TICK_RUNNING = 1 << 10, TICK_ENABLE = 1 << 9;
const COUNT_NANOS = 500; // erratum RP2040-E1: it counts down twice for each microsecond
export const BY_TIMER = 1, BY_FORCE = 2; // of REASON

export class Watchdog extends BasePeripheral {
  // bite(reason): the chip is to be reset.
  constructor(mcu, bite) {
    super(mcu, 'WATCHDOG');
    this.clock = mcu.clock;
    this.bite = bite;
    this.alarm = this.clock.createAlarm(() => this.bite(BY_TIMER));
    this.scratch = new Uint32Array(8);
    this.reason = 0;
    this.enabled = false;
    this.pause = PAUSE;
    this.tick = TICK_ENABLE | 12;
    this.left = 0; // counts, while it stands still
    this.endAt = 0; // the instant of zero, while it runs
  }

  // What survives a reset by the watchdog itself.
  takeOver(old, reason) {
    this.scratch.set(old.scratch);
    this.reason = reason;
  }

  get running() {
    return this.enabled && !!(this.tick & TICK_ENABLE);
  }

  get count() {
    if (!this.running) return this.left;
    return Math.max(0, Math.ceil((this.endAt - this.clock.nanos) / COUNT_NANOS));
  }

  // Sets the count and whether it runs down.
  set(count, enabled, tick) {
    this.enabled = enabled;
    this.tick = tick;
    this.left = count;
    if (this.running) {
      this.endAt = this.clock.nanos + count * COUNT_NANOS;
      this.alarm.at(this.endAt);
    } else {
      this.alarm.cancel();
    }
  }

  readUint32(offset) {
    if (offset >= SCRATCH_FIRST && offset <= SCRATCH_LAST) {
      return this.scratch[(offset - SCRATCH_FIRST) >> 2];
    }
    switch (offset) {
      case CTRL: return (this.enabled ? ENABLE : 0) | this.pause | (this.count & TIME);
      case REASON: return this.reason;
      case TICK: return this.tick | (this.tick & TICK_ENABLE ? TICK_RUNNING : 0);
    }
    return 0;
  }

  writeUint32(offset, value) {
    if (offset >= SCRATCH_FIRST && offset <= SCRATCH_LAST) {
      this.scratch[(offset - SCRATCH_FIRST) >> 2] = value;
      return;
    }
    switch (offset) {
      case CTRL:
        this.pause = value & PAUSE;
        this.set(this.count, !!(value & ENABLE), this.tick);
        if (value & TRIGGER) this.bite(BY_FORCE);
        break;
      case LOAD: this.set(value & TIME, this.enabled, this.tick); break;
      case TICK: this.set(this.count, this.enabled, value & 0x3ff & ~TICK_RUNNING); break;
    }
  }
}

const CHIP_RESET = 0x08;
export const HAD_POWER_ON = 1 << 8, HAD_RUN_PIN = 1 << 16;

// VREG_AND_CHIP_RESET, as far as somebody looks: how the chip came up.
export class ChipReset extends BasePeripheral {
  constructor(mcu, cause) {
    super(mcu, 'VREG_AND_CHIP_RESET');
    this.cause = cause;
  }

  readUint32(offset) {
    return offset === CHIP_RESET ? this.cause : 0;
  }

  writeUint32() {}
}
