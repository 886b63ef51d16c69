// The USB serial port of the chip: rp2040js's CDC host, which enumerates it, but answering
// "nothing yet" (NAK) while there is nothing to send. Without that the chip is flooded with empty
// packets and spends two thirds of its time on them.
import { USBCDC } from './library.mjs';

const WAITING_BYTES = 65536; // that a chip which does not read may leave in the queue

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
