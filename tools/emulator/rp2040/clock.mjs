// SPDX-License-Identifier: MIT
// The time of the emulated chip: whole nanoseconds that only the run loop moves, and alarms.
//
// It takes the place of rp2040js's SimulationClock and has its face. What differs: alarms of the
// same instant go off in the order in which they were set, instants are whole nanoseconds, and the
// run loop asks for the next one instead of ticking for each instruction.

class Alarm {
  constructor(clock, callback) {
    this.clock = clock;
    this.callback = callback;
    this.nanos = 0;
    this.next = null;
    this.scheduled = false;
  }

  schedule(deltaNanos) {
    this.at(this.clock.nanosCounter + deltaNanos);
  }

  at(nanos) {
    if (this.scheduled) this.cancel();
    this.nanos = Math.max(Math.round(nanos), this.clock.nanosCounter);
    this.clock.insert(this);
  }

  cancel() {
    if (this.scheduled) this.clock.remove(this);
  }
}

export class Clock {
  constructor(nanos) {
    this.nanosCounter = nanos;
    this.first = null; // of the alarms, soonest first
    this.dueAt = Infinity; // when it goes off
  }

  get nanos() {
    return this.nanosCounter;
  }

  get micros() {
    return this.nanosCounter / 1000;
  }

  createAlarm(callback) {
    return new Alarm(this, callback);
  }

  insert(alarm) {
    let before = null;
    let after = this.first;
    while (after !== null && after.nanos <= alarm.nanos) {
      before = after;
      after = after.next;
    }
    alarm.next = after;
    alarm.scheduled = true;
    if (before !== null) {
      before.next = alarm;
    } else {
      this.first = alarm;
      this.dueAt = alarm.nanos;
    }
  }

  remove(alarm) {
    alarm.scheduled = false;
    if (this.first === alarm) {
      this.first = alarm.next;
      this.dueAt = this.first === null ? Infinity : this.first.nanos;
      return;
    }
    let before = this.first;
    while (before.next !== alarm) before = before.next;
    before.next = alarm.next;
  }

  // Nothing happens until the next alarm, or until the instant.
  skip(until) {
    this.nanosCounter = Math.max(this.nanosCounter, Math.min(this.dueAt, until));
  }

  // Lets the alarms up to now go off, each at its own instant.
  fire() {
    const now = this.nanosCounter;
    while (this.dueAt <= now) {
      const alarm = this.first;
      this.remove(alarm);
      this.nanosCounter = alarm.nanos;
      alarm.callback();
    }
    this.nanosCounter = now;
  }
}
