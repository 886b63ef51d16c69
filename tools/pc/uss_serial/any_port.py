# SPDX-License-Identifier: MIT
"""A serial port through pyserial, where `port.serial_port` does not reach: Windows, macOS, and
what pyserial opens by a URL, such as socket://192.168.1.5:4001 or rfc2217://...

The system does not tell it which characters came with a wrong parity.
"""

import sys

from uss_serial.port.errors import LineCut, PortError

READ_MAX = 4096
IN_USE = "%s is in use by another program"
NO_PORT = "there is no port %s"


def port_of(path, baud):
    """The port of this computer that has this name."""
    if sys.platform.startswith("linux") and "://" not in path:
        from uss_serial.port.serial_port import SerialPort

        return SerialPort(path, baud)
    return AnyPort(path, baud)


class AnyPort:
    """With the methods of `port.serial_port.SerialPort`."""

    def __init__(self, path, baud):
        self.path = path
        self.baud = baud
        self._serial = None
        self._first = b""  # what `wait` has found

    def open(self):
        """PortError."""
        try:
            import serial
        except ImportError:
            raise PortError("%s wants pyserial: pip install pyserial" % self.path) from None
        options = {"baudrate": self.baud, "parity": "E", "timeout": 0, "write_timeout": 1}
        if "://" not in self.path:
            options["exclusive"] = None if sys.platform == "win32" else True
        try:
            self._serial = serial.serial_for_url(self.path, **options)
        except (OSError, ValueError) as error:  # a SerialException is an OSError
            raise PortError(self._why(error)) from None

    def close(self):
        port, self._serial = self._serial, None
        if port is not None:
            try:
                port.close()
            except OSError:
                pass

    def wait(self, seconds):
        """Wait so long at the most; whether something has come. LineCut."""
        try:
            self._serial.timeout = seconds
            self._first += self._serial.read(1)
        except (OSError, TypeError, AttributeError) as error:
            raise LineCut(str(error)) from None
        return bool(self._first)

    def read(self):
        """The characters that have come, and a flag for each, 0. LineCut."""
        try:
            self._serial.timeout = 0
            data, self._first = self._first + self._serial.read(READ_MAX), b""
        except (OSError, TypeError, AttributeError) as error:
            raise LineCut(str(error)) from None
        return data, bytes(len(data))

    def write(self, data):
        """LineCut."""
        try:
            self._serial.write(data)
        except (OSError, AttributeError) as error:
            raise LineCut(str(error)) from None

    def change_baud(self, baud):
        """Go on at another rate. PortError: the port does not know it."""
        self.baud = baud
        try:
            self._serial.baudrate = baud
        except (OSError, ValueError, AttributeError) as error:
            raise PortError(self._why(error)) from None

    def unsent(self):
        """How many characters the machine has still to send, as far as it tells."""
        try:
            return self._serial.out_waiting
        except (OSError, AttributeError, NotImplementedError):
            return 0

    def _why(self, error):
        text = str(error)
        if "FileNotFound" in text or "No such file" in text:
            return NO_PORT % self.path
        if "PermissionError" in text or "busy" in text or "lock" in text:
            return IN_USE % self.path
        return "%s: %s" % (self.path, text.splitlines()[0])
