// SPDX-License-Identifier: MIT
// The wires at the chip's pins: three states on each side, and shorts; who is told of them.
//
// A pin's level is that of a short, else what the chip drives, else what the outside drives, else
// what the pulls make of it. The chip reads that level back, also of a pin that it drives itself (in rp2040js an input
// knows only what it was told). Pins whose function is UART show the level of their TX line.
import { GPIOPin } from './library.mjs';

export const LOW = 0, HIGH = 1, RELEASED = 2;
const SHORTED_HIGH = 3; // of the outside alone
const PINS = 30;
const FUNCTION_UART = 2;
const UART_OF_TX_PIN = { 0: 0, 4: 1, 8: 1, 12: 0, 16: 0, 20: 1, 24: 1, 28: 0 };
const PULL_UP = 3, PULL_DOWN = 4; // of GPIOPin.value, beside LOW, HIGH and 2 for no pull

// rp2040js has no UART on its pins and no way to add it but through these two.
function extend(name, ofUart) {
  const { get } = Object.getOwnPropertyDescriptor(GPIOPin.prototype, name);
  Object.defineProperty(GPIOPin.prototype, name, {
    get() {
      if ((this.ctrl & 0x1f) !== FUNCTION_UART || !(this.index in UART_OF_TX_PIN)) {
        return get.call(this);
      }
      return ofUart(this.rp2040.uart[UART_OF_TX_PIN[this.index]]);
    },
    configurable: true,
  });
}
extend('rawOutputEnable', () => true);
extend('rawOutputValue', (uart) => uart.level === 1);

export const isUart = (pin) => (pin.ctrl & 0x1f) === FUNCTION_UART;

export class Wires {
  // changed(gpio, state): what the chip does at a pin: LOW, HIGH, RELEASED.
  // moved(gpio, level): the level of a wire.
  // pulledUp: the wires with a resistor to the supply, stronger than the chip's own pulls.
  constructor(changed, moved, pulledUp) {
    this.changed = changed;
    this.moved = moved;
    this.pulledUp = pulledUp;
    this.outside = new Uint8Array(PINS).fill(RELEASED);
    this.chip = new Uint8Array(PINS).fill(RELEASED);
    this.level = new Uint8Array(PINS);
    this.pins = [];
  }

  // The pins of a chip that has just come out of reset.
  join(mcu) {
    this.pins = mcu.gpio.slice(0, PINS);
    for (const pin of this.pins) {
      pin.addListener(() => this.update(pin.index));
      pin.lastValue = pin.value;
      pin.rawInputValue = !!this.level[pin.index];
      this.update(pin.index);
    }
  }

  uartMoved(uart) {
    for (const gpio in UART_OF_TX_PIN) {
      if (UART_OF_TX_PIN[gpio] === uart && isUart(this.pins[gpio])) {
        this.pins[gpio].checkForUpdates();
      }
    }
  }

  drive(gpio, state) {
    this.outside[gpio] = state;
    if (this.pins.length) this.update(gpio);
  }

  update(gpio) {
    const pin = this.pins[gpio];
    const { value } = pin;
    const chip = value <= HIGH ? value : RELEASED;
    if (chip !== this.chip[gpio]) {
      this.chip[gpio] = chip;
      this.changed(gpio, chip);
    }
    const level = this.resolve(gpio, value);
    if (level === this.level[gpio]) return;
    this.level[gpio] = level;
    pin.setInputValue(level === HIGH);
    this.moved(gpio, level);
  }

  resolve(gpio, value) {
    if (this.outside[gpio] === SHORTED_HIGH) return HIGH;
    if (value <= HIGH) return value;
    if (this.outside[gpio] !== RELEASED) return this.outside[gpio];
    if (value === PULL_UP || this.pulledUp.includes(gpio)) return HIGH;
    if (value === PULL_DOWN) return LOW;
    return this.level[gpio]; // it floats
  }
}
