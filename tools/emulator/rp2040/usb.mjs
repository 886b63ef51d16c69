// SPDX-License-Identifier: MIT
// The USB serial port of the chip: rp2040js's CDC host, which enumerates it, but answering
// "nothing yet" (NAK) while there is nothing to send. Without that the chip is flooded with empty
// packets and spends two thirds of its time on them.
//
// And with the host's start of frame, every millisecond, for a chip that has asked to be told:
// MicroPython sends what was printed before the port was opened some frames after that.
import { USBCDC } from './library.mjs';

const WAITING_BYTES = 65536; // that a chip which does not read may leave in the queue
const FRAME_NANOS = 1e6;
const EP0_IN_BUFFER_CONTROL = 0x80; // those of the endpoints follow, 8 bytes each
const SOF_RD = 0x48, INTE = 0x90; // registers
const DEV_SOF = 1 << 17; // bit of INTR and INTE; reading SOF_RD takes the first one back

export class UsbSerial {
  // received(bytes): the chip has sent these.
  constructor(mcu, received) {
    this.controller = mcu.usbCtrl;
    this.cdc = new USBCDC(this.controller);
    this.cdc.onSerialData = received;
    this.waiting = []; // bytes for the chip
    this.room = 0; // of the buffer in which the chip awaits bytes; 0: it does not
    this.controller.onEndpointRead = (endpoint, size) => {
      if (endpoint !== this.cdc.outEndpoint) return;
      this.room = size;
      this.pass();
    };
    this.countFrames(mcu.clock);
    this.reads = true;
    this.held = null; // what the chip has ready while the host does not read
    const { DPRAMUpdated } = this.controller;
    this.controller.DPRAMUpdated = (offset, value) => {
      if (!this.reads && offset === EP0_IN_BUFFER_CONTROL + 8 * this.cdc.inEndpoint) {
        this.held = value;
      } else {
        DPRAMUpdated.call(this.controller, offset, value);
      }
    };
  }

  // Whether the host, which has the port open, reads what the chip sends.
  read(on) {
    this.reads = on;
    if (!on || this.held === null) return;
    const offset = EP0_IN_BUFFER_CONTROL + 8 * this.cdc.inEndpoint;
    const value = this.held;
    this.held = null;
    this.controller.DPRAMUpdated(offset, value);
  }

  countFrames(clock) {
    const { controller } = this;
    const { readUint32, writeUint32 } = controller;
    const frame = clock.createAlarm(() => {
      if (!(controller.intEnable & DEV_SOF)) return;
      controller.sofFrameNumber = (controller.sofFrameNumber + 1) & 0x7ff;
      controller.intRaw |= DEV_SOF;
      controller.checkInterrupts();
      frame.schedule(FRAME_NANOS);
    });
    controller.writeUint32 = (offset, value) => {
      const told = controller.intEnable & DEV_SOF;
      writeUint32.call(controller, offset, value);
      if (offset === INTE && controller.intEnable & DEV_SOF && !told) frame.schedule(FRAME_NANOS);
    };
    controller.readUint32 = (offset) => {
      const value = readUint32.call(controller, offset);
      if (offset === SOF_RD) {
        controller.intRaw &= ~DEV_SOF;
        controller.checkInterrupts();
      }
      return value;
    };
  }

  send(bytes) {
    for (const byte of bytes) if (this.waiting.length < WAITING_BYTES) this.waiting.push(byte);
    this.pass();
  }

  pass() {
    if (!this.room || !this.waiting.length) return;
    const packet = Uint8Array.from(this.waiting.splice(0, this.room));
    this.room = 0;
    this.controller.endpointReadDone(this.cdc.outEndpoint, packet);
  }
}
