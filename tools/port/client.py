# SPDX-License-Identifier: MIT
"""The port of the computer, as a program on MicroPython has it beside tools/port/launch.py.

    port = Port()
    port.open("/dev/ttyUSB0", 19200)    # PortError: says in words what is wrong
    port.write(data)
    port.wait(1)                        # until something has come; KeyboardInterrupt: leave
    data = port.read(256)               # or None

The launcher holds the port itself, tells when it has gone or is back, and passes on the request to
end the program.
"""

import os
import select

ALONE = "--port wants tools/port/launch.py around this program: start ./tools/panel"
OPENING_MS = 5_000
LINE_MAX = 200


class PortError(Exception):
    """The port cannot be had; the text says why."""


class Port:
    """name: its path. is_cut: it has gone for the moment. notices: lines about that for people."""

    def __init__(self):
        self.name = ""
        self.is_cut = False
        self.notices = []
        data, control = os.getenv("USS_PORT_DATA"), os.getenv("USS_PORT_CONTROL")
        if not (data and control):
            raise PortError(ALONE)
        self._data = open(int(data), "r+b")
        self._control = open(int(control), "r+b")
        self._poller = select.poll()
        self._poller.register(self._control, select.POLLIN)
        self._line = b""
        self._left = False

    def open(self, path, baud):
        """PortError."""
        self.name = path
        if "\n" in path:  # which would end the line that says it
            raise PortError("there is no port %r" % path)
        self._control.write(b"open %d %s\n" % (baud, path.encode()))
        while True:
            if not self._poller.poll(OPENING_MS):
                raise PortError("%s does not open" % path)
            for word, text in self._told():
                if word == "opened":
                    self._poller.register(self._data, select.POLLIN)
                    return
                raise PortError(text or word)

    def read(self, count):
        return self._data.read(count)

    def write(self, data):
        self._data.write(data)

    def wait(self, ms):
        """Until characters have come, so many milliseconds at the most."""
        for stream, _ in self._poller.poll(ms):
            if stream is self._control:
                for word, text in self._told():
                    self._take(word, text)

    def _take(self, word, text):
        if word == "leave" and not self._left:
            self._left = True
            raise KeyboardInterrupt
        if word == "cut" and not self.is_cut:
            self.is_cut = True
            self.notices.append("%s has gone (%s): the line is cut" % (self.name, text))
        elif word == "back":
            self.is_cut = False
            self.notices.append("%s is back" % self.name)

    def _told(self):
        """What the launcher has said: (word, the rest of its line)."""
        told = self._control.read(LINE_MAX)
        if told == b"":  # the launcher was killed: nothing reaches the line any more
            self._poller.unregister(self._control)
            return [("cut", "tools/port/launch.py is no more"), ("leave", "")]
        *lines, self._line = (self._line + (told or b"")).split(b"\n")
        found = []
        for line in lines:
            word, _, text = line.decode().partition(" ")
            found.append((word, text))
        return found
