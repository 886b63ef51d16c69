# SPDX-License-Identifier: MIT
"""What a program should know of the three streams that it was started with.

    open_missing()              # before anything else is opened
    is_ours(0)                  # whether we may read, and are not stopped for it
    output = Output(1)
    output.say("a line")        # without waiting: who does not read does not get it
    output.go_on()              # now and then

Streams are named by their numbers. On CPython, where there are terminals and jobs.
"""

import os
import select

LEFT_OUT = "(%d lines left out: %s)"
UNREAD = "nobody read them"


def open_missing():
    """Lead a closed stream to nowhere; or the next file that is opened takes its number."""
    for number, how in ((0, os.O_RDONLY), (1, os.O_WRONLY), (2, os.O_WRONLY)):
        try:
            os.fstat(number)
        except OSError:
            os.set_inheritable(os.open(os.devnull, how), True)  # the lowest number that is free


def is_ours(number):
    """Whether we may read: not a terminal in which another program is in the foreground."""
    try:
        return not os.isatty(number) or os.tcgetpgrp(number) == os.getpgrp()
    except OSError:
        return True  # the terminal has gone: reading tells


class Output:
    """Lines for somebody who need not read them: it leaves out those that have no room, and counts
    them.

    failed: called once, with the reason in words, when nothing can be written: the disk is full,
    the terminal has gone. What is said then is left out as well.
    """

    def __init__(self, number, failed=None):
        self._number = anew(number)
        self._failed = failed
        self._rest = b""  # of a line that had no room for all of it
        self._left_out = 0
        self._why = UNREAD

    def say(self, line):
        """BrokenPipeError: whoever has read is no more."""
        self.go_on()
        if self._rest or self._left_out or not self._begin(line):
            self._left_out += 1

    def go_on(self):
        """Say what has had no room: the rest of a line, and how many were left out."""
        if self._rest:
            self._rest = self._rest[self._write(self._rest) :]
        if self._left_out and not self._rest:
            if self._begin(LEFT_OUT % (self._left_out, self._why)):
                self._left_out = 0
                self._why = UNREAD

    def _begin(self, line):
        """Whether there was room, for the beginning at least."""
        data = line.encode("utf-8", "backslashreplace") + b"\n"
        written = self._write(data)
        self._rest = data[written:] if written else b""
        return written > 0

    def _write(self, data):
        """How much of it had room. A pipe that can be written to has room for PIPE_BUF."""
        written = 0
        try:
            while written < len(data) and select.select((), (self._number,), (), 0)[1]:
                piece = data[written : written + select.PIPE_BUF]
                written += os.write(self._number, piece)
        except BlockingIOError:
            pass
        except BrokenPipeError:
            raise
        except OSError as error:
            self._why = error.strerror
            failed, self._failed = self._failed, None
            if failed is not None:
                failed(error.strerror)
        return written


def anew(number):
    """A number for a stream that does not wait. Only a terminal gets another number: it says that
    it can be written to when it has room for one character, and then waits for the rest. It is
    opened once more without waiting, because the first number may belong to others as well.
    """
    if not os.isatty(number):
        return number
    for path in ("/proc/self/fd/%d" % number, terminal_name(number)):
        try:
            return os.open(path, os.O_WRONLY | os.O_NOCTTY | os.O_NONBLOCK)
        except OSError:
            pass  # it belongs to another user
    return number


def terminal_name(number):
    try:
        return os.ttyname(number)
    except OSError:
        return ""  # it has gone
