// SPDX-License-Identifier: MIT
// What a receiver on the line makes of the TX pin: characters of 8 data bits, even parity and one
// stop bit, each bit looked at in its middle. Its rate is that to which the chip has set the UART
// at the RX pin: whoever sends at another rate than it receives makes characters with flaws.
//
// While the chip does not drive the pin the line rests (high).

const STOP_BIT = 10; // number of bits before it
const COMPLETE = 10.5; // bits after the beginning of the start bit

export class LineDecoder {
  // decoded(start, byte, parityWrong, stopWrong): half a bit before the character is over.
  constructor(baud, decoded) {
    this.tune(baud);
    this.decoded = decoded;
    this.level = 1;
    this.reset(null);
  }

  tune(baud) {
    this.bitNanos = 1e9 / baud;
  }

  // The chip is new, its line rests.
  reset(clock) {
    this.clock = clock;
    this.alarm = clock?.createAlarm(() => this.complete());
    this.edges = null; // [instant, level, instant, level ...] since the start bit began
  }

  change(level) {
    if (level === this.level) return;
    this.level = level;
    if (this.edges !== null) {
      this.edges.push(this.clock.nanos, level);
    } else if (level === 0) {
      this.edges = [this.clock.nanos, 0];
      this.alarm.schedule(COMPLETE * this.bitNanos);
    }
  }

  complete() {
    const { edges, bitNanos } = this;
    const start = edges[0];
    let value = 0;
    let at = 0;
    for (let bit = 0; bit <= STOP_BIT; bit++) {
      const middle = start + (bit + 0.5) * bitNanos;
      while (at + 2 < edges.length && edges[at + 2] <= middle) at += 2;
      value |= edges[at + 1] << bit;
    }
    this.edges = null;
    if (value & 1) return; // no start bit in its middle: a glitch
    let ones = 0;
    for (let bit = 1; bit < STOP_BIT; bit++) ones += (value >> bit) & 1;
    this.decoded(start, (value >> 1) & 0xff, ones & 1, ((value >> STOP_BIT) & 1) ^ 1);
  }
}
