# SPDX-License-Identifier: MIT
"""The serial port of the chip on which a logger listens: nothing here waits.

It is the stream of the prompt. While `hears` is on, Ctrl-C is a character like any other, because
a logger may send anything: only the line END ends the program.

    serial = Serial(sys.stdout.buffer, poll, micropython.kbd_intr, is_idle)
    serial.listen(True)
    at = serial.send(line, at)          # from line[at] on as much as fits, a packet at most
    serial.hear()                       # again and again, or the port takes nothing more
"""

from micropython import const

END = b"# end panel\r"  # nothing happens if the prompt reads it

_CTRL_C, _NO_CHARACTER = const(3), const(-1)
_PACKET = const(64)  # characters of full speed USB
_POLLIN, _POLLOUT = const(1), const(4)  # of `select`, in every port
_RETURN, _NEWLINE = const(13), const(10)


class Serial:
    """stream: has write(buffer, at, count) and read(1). poll: a `select.poll` of it, for reading
    and writing. kbd_intr: of `micropython`. is_idle: a function that answers whether the PC has
    taken all packets; then one more fits.
    """

    hears = False
    packet = _PACKET  # characters that are sent at a time

    def __init__(self, stream, poll, kbd_intr, is_idle):
        self._write = stream.write
        self._read = stream.read
        self._ipoll = poll.ipoll
        self._kbd_intr = kbd_intr
        self._is_idle = is_idle
        self._matched = 0  # so many characters of END have come

    def listen(self, on):
        """Whether Ctrl-C is a character, and `hear` takes what comes."""
        self.hears = on
        self._kbd_intr(_NO_CHARACTER if on else _CTRL_C)

    def send(self, buffer, at):
        """Send some characters from buffer[at] on; answer where the rest begins.

        The port tells that there is room, and not how much, and whoever writes more waits for half
        a second if nobody reads. But if the last packet was taken, the look at the port has begun
        with the next one, if there is one, and that has made room for a packet.
        """
        if not self._is_idle() or not self._flags() & _POLLOUT:
            return at
        count = min(len(buffer) - at, _PACKET)
        self._write(buffer, at, count)
        return at + count

    def hear(self):
        """Take a character that has come. KeyboardInterrupt: it is the last one of END."""
        if not self.hears or not self._flags() & _POLLIN:
            return
        code = self._read(1)[0]
        if code == _NEWLINE:
            code = _RETURN
        matched = self._matched if code == END[self._matched] else 0
        self._matched = matched + 1 if code == END[matched] else 0
        if self._matched == len(END):
            self._matched = 0
            raise KeyboardInterrupt

    def _flags(self):
        for _, flags in self._ipoll(0):
            return flags
        return 0
