// SPDX-License-Identifier: MIT
// The block that holds peripherals in reset: rp2040js's, but it does reset those whose old state
// would show, the UARTs and the I2Cs. The SDK resets each of them when it sets it up.
import { RPReset } from './library.mjs';

const RESET = 0x0;
const UART_BITS = [22, 23], I2C_BITS = [3, 4];

export class Resets extends RPReset {
  writeUint32(offset, value) {
    const before = this.reset;
    super.writeUint32(offset, value);
    if (offset !== RESET) return;
    const begun = this.reset & ~before;
    const { uart, i2c } = this.rp2040;
    UART_BITS.forEach((bit, index) => { if (begun & (1 << bit)) uart[index].reset(); });
    I2C_BITS.forEach((bit, index) => { if (begun & (1 << bit)) i2c[index].reset(); });
  }
}
