// SPDX-License-Identifier: MIT
// The microsecond timer: rp2040js's, but it begins at 0 when the chip comes out of reset, and its
// alarms go off when it shows their value (there up to a microsecond early, so that the firmware
// has to set them again).
import { RPTimer } from './library.mjs';
import { times } from './processor.mjs';

const TIMEHR = 0x08, TIMELR = 0x0c, ALARM0 = 0x10, ALARM3 = 0x1c;
const TIMERAWH = 0x24, TIMERAWL = 0x28;
const HIGH_WORD = 2 ** 32;

export class ExactTimer extends RPTimer {
  constructor(mcu) {
    super(mcu, 'TIMER');
    this.origin = times[1] = this.clock.nanos;
  }

  get micros() {
    return Math.floor((this.clock.nanos - this.origin) / 1000);
  }

  readUint32(offset) {
    switch (offset) {
      case TIMERAWL: return this.micros >>> 0;
      case TIMERAWH: return Math.floor(this.micros / HIGH_WORD);
      case TIMELR:
        this.latchedTimeHigh = Math.floor(this.micros / HIGH_WORD);
        return this.micros >>> 0;
      case TIMEHR: return this.latchedTimeHigh;
    }
    return super.readUint32(offset);
  }

  writeUint32(offset, value) {
    if (offset < ALARM0 || offset > ALARM3) {
      super.writeUint32(offset, value);
      return;
    }
    const alarm = this.alarms[(offset - ALARM0) / 4];
    const now = this.micros;
    alarm.armed = true;
    alarm.targetMicros = value;
    alarm.clockAlarm.at(this.origin + (now + ((value - now) >>> 0)) * 1000);
  }
}
