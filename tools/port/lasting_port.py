# SPDX-License-Identifier: MIT
"""A port that may go and come back, as an adapter does that is unplugged.

port = LastingPort(opened, told)    # told(cut): the `LineCut` when it goes, None: it is back
port.write(data)                    # lost while it is away
data, flaws = port.read()           # nothing while it is away
port.look_again()                   # now and then while it is away
"""

import time

# Relative, because the package `uss_serial` has this file as well.
from .errors import LineCut, PortError

AGAIN_S = 1.0  # it is looked for so often


class LastingPort:
    """port: a `SerialPort` or `Pty` that is open. is_open: it is there."""

    def __init__(self, port, told):
        self.port = port
        self.is_open = True
        self._told = told
        self._looked_s = 0.0

    def fileno(self):
        return self.port.fileno()

    def read(self):
        try:
            return self.port.read()
        except LineCut as cut:
            self._lose(cut)
            return b"", b""

    def write(self, data):
        if self.is_open:
            try:
                self.port.write(data)
            except LineCut as cut:
                self._lose(cut)

    def change_baud(self, baud):
        """PortError."""
        if self.is_open:
            self.port.change_baud(baud)
        self.port.baud = baud

    def look_again(self):
        if time.monotonic() - self._looked_s < AGAIN_S:
            return
        self._looked_s = time.monotonic()
        try:
            self.port.open()
        except PortError:
            return
        self.is_open = True
        self._told(None)

    def _lose(self, cut):
        self.port.close()
        self.is_open = False
        self._looked_s = time.monotonic()
        self._told(cut)
