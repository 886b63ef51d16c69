# SPDX-License-Identifier: MIT
"""A serial port, or a pty, for programs on CPython: 8E1, at the rates of USS, for exclusive use.

    port = SerialPort("/dev/ttyUSB0", 19200)
    port.open()                     # PortError: says in words what is wrong, and what helps
    data, flaws = port.read()       # what has come, without waiting; LineCut: it has gone
    port.write(data)
    port = Pty(link="/tmp/drive")   # one of our own: port.path is for the other side

`fileno()` is for select. Nothing here waits. A pty has no parity and no rate; it is only set to
pass all characters unchanged.
"""

import array
import errno
import fcntl
import os
import pwd
import select
import stat
import struct
import sys
import termios
import time
import tty

# Relative, because the package `uss_serial` has these files as well.
from .errors import LineCut, PortError

PARITY, FRAME = 1, 2  # of a character, as in boards.sim.line.wire
PTY_MAJORS = range(136, 144)  # of the device number of a pty's slave, on Linux
READ_MAX = 4096
MARK = 0xFF  # with PARMRK: before 00 and a character with a wrong parity, or before itself

# Linux: rates that have no name are set with these (asm-generic/termbits.h, ioctls.h).
TCGETS2, TCSETS2 = 0x802C542A, 0x402C542B
BOTHER, CBAUD = 0o010000, 0o010017
OF_FLAGS, OF_SPEEDS = 8, 36  # places in struct termios2: c_cflag; c_ispeed, c_ospeed

NO_PORT = "there is no port %s"
NOT_ALLOWED = "%s: not allowed; on Debian:  sudo adduser $USER dialout, then log in anew"
NOT_YOURS = "%s: not allowed: it is a terminal of %s"
OWN_TERMINAL = "%s is the terminal in which this runs"
LEFT_OVER = "%s is left over: the terminal that it leads to was made after it, by somebody else"
OTHERS_NOW = "%s has gone for good: what has its number now is another terminal"
LINK_TAKEN = "%s leads to %s, which is not ours: remove it, or use another name"
IN_USE = "%s is in use by another program"
NO_TERMINAL = "%s is no serial port"
NO_RATE = "%s does not know %d baud"


class SerialPort:
    """path: of the device. baud: bits a second; a pty ignores it. is_pty: known when open."""

    def __init__(self, path, baud):
        self.path = path
        self.baud = baud
        self.is_pty = False
        self._descriptor = None
        self._opened_ns = None  # when it was last open, by the clock of the machine
        self._marking = False
        self._rest = b""  # the beginning of a mark whose end has not come

    def fileno(self):
        return self._descriptor

    def open(self):
        """PortError."""
        try:
            # Without NONBLOCK it would wait until a modem finds a carrier.
            self._descriptor = os.open(self.path, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
        except OSError as error:
            raise PortError(self._why(error)) from None
        try:
            self._take()
        except PortError:
            self.close()
            raise
        except (OSError, termios.error) as error:
            self.close()
            raise PortError(f"{self.path}: {error.args[-1]}") from None
        self._rest = b""

    def close(self):
        descriptor, self._descriptor = self._descriptor, None
        if descriptor is not None:
            try:
                os.close(descriptor)
            except OSError:
                pass

    def wait(self, seconds):
        """Wait so long at the most; whether something has come."""
        return bool(select.select([self], (), (), seconds)[0])

    def read(self):
        """The characters that have come, and a flag for each: 0, PARITY or FRAME. LineCut."""
        try:
            data = os.read(self._descriptor, READ_MAX)
        except BlockingIOError:
            return b"", b""
        except OSError as error:
            raise LineCut(error.strerror) from None
        if not data:
            raise LineCut("end of file")
        return self.unmarked(data) if self._marking else (data, bytes(len(data)))

    def write(self, data):
        """Write what has room; the rest is lost, as on a line without listeners. LineCut."""
        try:
            os.write(self._descriptor, data)
        except BlockingIOError:
            pass
        except OSError as error:
            raise LineCut(error.strerror) from None

    def unsent(self):
        """How many characters the machine has still to send."""
        waiting = array.array("i", [0])
        fcntl.ioctl(self._descriptor, termios.TIOCOUTQ, waiting)
        return waiting[0]

    def change_baud(self, baud):
        """Go on at another rate. PortError: the port does not know it."""
        self.baud = baud
        try:
            self._note_rate() if self.is_pty else self._set_up()
        except (OSError, termios.error) as error:
            raise PortError(f"{self.path}: {error.args[-1]}") from None

    def _take(self):
        if not os.isatty(self._descriptor):
            raise PortError(NO_TERMINAL % self.path)
        if self._is_our_terminal():
            raise PortError(OWN_TERMINAL % self.path)
        status = os.fstat(self._descriptor)
        self.is_pty = is_pty(status)
        if self.is_pty:
            self._look_whose(status)
        try:
            fcntl.flock(self._descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)  # as pyserial does
            if not self.is_pty:
                # It stays until all programs have closed the port; a pty's maker never closes it.
                fcntl.ioctl(self._descriptor, termios.TIOCEXCL)
        except OSError:
            raise PortError(IN_USE % self.path) from None
        tty.setraw(self._descriptor)
        if self.is_pty:
            self._note_rate()
        else:
            self._set_up()
        termios.tcflush(self._descriptor, termios.TCIOFLUSH)
        self._opened_ns = time.time_ns()

    def _look_whose(self, status):
        """PortError if this is not the pty that we mean. When a pty has gone, the next terminal
        gets its number. One made after the link to it, or after we had it, is another pty.
        """
        if os.path.islink(self.path):
            if os.lstat(self.path).st_mtime_ns < made_ns(status):
                raise PortError(LEFT_OVER % self.path)
        elif self._opened_ns is not None and self._opened_ns < made_ns(status):
            raise PortError(OTHERS_NOW % self.path)

    def _is_our_terminal(self):
        try:
            os.tcgetpgrp(self._descriptor)  # succeeds only for our own terminal
        except OSError:
            return False
        return True

    def _note_rate(self):
        """A pty has no rate. It keeps this for whoever asks at its other end."""
        settings = termios.tcgetattr(self._descriptor)
        settings[4] = settings[5] = getattr(termios, f"B{self.baud}", settings[4])
        termios.tcsetattr(self._descriptor, termios.TCSANOW, settings)

    def _set_up(self):
        """8E1, no handshake, and characters that are wrong are marked."""
        settings = termios.tcgetattr(self._descriptor)
        settings[0] = termios.INPCK | termios.PARMRK
        settings[2] = termios.CS8 | termios.PARENB | termios.CREAD | termios.CLOCAL
        rate = getattr(termios, f"B{self.baud}", None)
        if rate is not None:
            settings[4] = settings[5] = rate
        termios.tcsetattr(self._descriptor, termios.TCSANOW, settings)
        self._marking = True
        if rate is None:
            self.set_other_rate()
        if termios.tcgetattr(self._descriptor)[2] & termios.PARENB == 0:
            raise PortError(f"{self.path} has no even parity")

    def set_other_rate(self):
        if not sys.platform.startswith("linux"):
            raise PortError(NO_RATE % (self.path, self.baud))
        try:
            block = bytearray(64)
            fcntl.ioctl(self._descriptor, TCGETS2, block)
            flags = struct.unpack_from("I", block, OF_FLAGS)[0] & ~CBAUD | BOTHER
            struct.pack_into("I", block, OF_FLAGS, flags)
            struct.pack_into("2I", block, OF_SPEEDS, self.baud, self.baud)
            fcntl.ioctl(self._descriptor, TCSETS2, block)
            fcntl.ioctl(self._descriptor, TCGETS2, block)
            if abs(struct.unpack_from("I", block, OF_SPEEDS)[0] - self.baud) > self.baud // 50:
                raise OSError
        except OSError:
            raise PortError(NO_RATE % (self.path, self.baud)) from None

    def unmarked(self, marked):
        """What PARMRK has marked: FF FF is FF, FF 00 xx is xx with a wrong parity or stop bit."""
        marked = self._rest + marked
        data, flags = bytearray(), bytearray()
        at = 0
        while at < len(marked):
            size = 1
            if marked[at] == MARK:
                size = 2 if marked[at + 1 : at + 2] != b"\0" else 3
            if at + size > len(marked):
                break
            wrong = size == 3
            data.append(marked[at + size - 1])
            flags.append((PARITY if data[-1] else FRAME) if wrong else 0)
            at += size
        self._rest = marked[at:]
        return bytes(data), bytes(flags)

    def _why(self, error):
        if error.errno in (errno.ENOENT, errno.ENODEV, errno.ENXIO):
            return NO_PORT % self.path
        if error.errno in (errno.EACCES, errno.EPERM):
            return self._why_not_allowed()
        if error.errno == errno.EBUSY:
            return IN_USE % self.path
        return f"{self.path}: {error.strerror}"

    def _why_not_allowed(self):
        try:
            status = os.stat(self.path)
        except OSError:
            return NO_PORT % self.path
        if is_pty(status):
            return NOT_YOURS % (self.path, user_name(status.st_uid))
        return (NOT_ALLOWED if stat.S_ISCHR(status.st_mode) else NO_TERMINAL) % self.path


def is_pty(status):
    """status: of `os.stat`."""
    return stat.S_ISCHR(status.st_mode) and os.major(status.st_rdev) in PTY_MAJORS


def made_ns(status):
    """When a pty was made, at the latest. status: of `os.stat`.

    Only this tells two ptys of one number apart: device and inode are the same. The oldest of its
    times counts: using a terminal, or changing its mode, renews the others.
    """
    return min(status.st_atime_ns, status.st_mtime_ns, status.st_ctime_ns)


def user_name(number):
    try:
        return pwd.getpwuid(number).pw_name
    except KeyError:
        return "user %d" % number


class Pty(SerialPort):
    """A pty of our own; `path` is where the others find it. link: a name that stays the same;
    what else has that name is left alone.

    We keep the others' end open as well: they may come and go.
    """

    def __init__(self, link=None):
        SerialPort.__init__(self, None, None)
        self.is_pty = True
        self.link = link
        self._theirs = None

    def open(self):
        """PortError: the link cannot be made."""
        self._descriptor, self._theirs = os.openpty()
        os.set_blocking(self._descriptor, False)
        tty.setraw(self._theirs)
        self.path = os.ttyname(self._theirs)
        try:
            if self.link:
                self._make_link()
        except PortError:
            self.close()
            raise

    def close(self):
        # First of all: a pty that is closed gives its path to the next one.
        if self.link and self.path and target(self.link) == self.path:
            os.remove(self.link)
        SerialPort.close(self)
        if self._theirs is not None:
            os.close(self._theirs)
            self._theirs = None

    def _make_link(self):
        there = target(self.link)
        try:
            if there is not None:
                if not self._is_left_over(there):
                    raise PortError(LINK_TAKEN % (self.link, there))
                os.remove(self.link)
            os.symlink(self.path, self.link)
        except OSError as error:
            raise PortError(f"{self.link}: {error.strerror}") from None

    def _is_left_over(self, there):
        """Whether a link that leads there was made by one of us that was killed, and whose pty has
        gone; somebody else may have its number by now.
        """
        if there == self.path:
            return True
        if os.path.dirname(there) != os.path.dirname(self.path):
            return False  # it leads to no pty
        try:
            return os.lstat(self.link).st_mtime_ns < made_ns(os.stat(there))
        except FileNotFoundError:
            return True


def target(link):
    """Where a symbolic link leads, or None: it is none."""
    try:
        return os.readlink(link)
    except OSError:
        return None
