# SPDX-License-Identifier: MIT
"""The USB serial port of a virtual chip, and the PC at its other end.

It holds as much as the port of an RP2040 and then has no room until the PC reads. While nobody has
opened it, it keeps the latest characters, as TinyUSB does.

    usb.is_read = False             # the PC has the port open and reads nothing
    usb.heard                       # what the PC has read, a bytearray
    usb.type(b"\\x03")               # the PC sends characters
"""

from hal.serial import Serial

HOLDS = 256  # characters
KEPT = 100_000  # of what the PC has read
POLLIN, POLLOUT = 1, 4
CTRL_C = 3


class Usb:
    """to: a function that is given what the PC reads, as bytes; None: it is kept in `heard`.

    ends: how often a Ctrl-C would have ended the program. waits: characters that were written
    where there was no room: on the chip the program stands still for that.
    """

    def __init__(self, to=None):
        self.to = to
        self.is_open = self.is_read = True
        self.heard = bytearray()
        self.ends = self.waits = 0
        self._fifo = bytearray()
        self._typed = bytearray()
        self._interrupt = CTRL_C

    def serial(self):
        """The driver of a chip that has just booted."""
        self._interrupt = CTRL_C
        return Serial(self, self, self._set_interrupt, self._is_idle)

    # --- the PC ---------------------------------------------------------------------------------

    def type(self, characters):
        for code in characters:
            if code == self._interrupt:
                self.ends += 1
            else:
                self._typed.append(code)

    def read(self, count):
        """What the program reads."""
        taken, self._typed = self._typed[:count], self._typed[count:]
        return bytes(taken)

    # --- the stream and its poll ----------------------------------------------------------------

    def write(self, buffer, at, count):
        self._fifo.extend(buffer[at : at + count])
        if len(self._fifo) > HOLDS:
            if self.is_open:
                self.waits += len(self._fifo) - HOLDS
            self._fifo = self._fifo[-HOLDS:]
        self._pass()

    def ipoll(self, timeout_ms):
        self._pass()
        flags = POLLIN if self._typed else 0
        if not self.is_open or len(self._fifo) < HOLDS:
            flags |= POLLOUT
        return ((self, flags),) if flags else ()

    def _pass(self):
        if not (self.is_open and self.is_read and self._fifo):
            return
        if self.to is not None:
            self.to(bytes(self._fifo))
        else:
            self.heard.extend(self._fifo)
            if len(self.heard) > KEPT:
                self.heard = self.heard[-KEPT:]
        self._fifo = bytearray()

    def _is_idle(self):
        self._pass()
        return not (self.is_open and self._fifo)

    def _set_interrupt(self, code):
        self._interrupt = code
