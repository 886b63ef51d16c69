# SPDX-License-Identifier: MIT
"""The running panel as a child: a program that speaks the language of tools/live/README.md.

    child = Child(command)
    for message in child.read(): ...    # when its descriptor is ready; child.is_over: that was all
    child.send("down", key="STOP")
    child.leave()                       # it stops its drives, and ends

Nothing here waits, but `leave` and `first`.
"""

import json
import os
import select
import signal
import subprocess

from tools.live.language import VERSION, spoken

READ_MAX = 65_536
OURS = 1  # our id: the child has no other front end
LEAVE_S = 10.0  # for the drives to be stopped
SAID_MAX = 100_000  # of what it says on standard error


class Child:
    """said: what it wrote on standard error, bytes. is_over: it tells nothing any more."""

    def __init__(self, command):
        # A group of its own: what the keyboard or a closing terminal does to ours is for us, who
        # tell it in order. It stays in our session, so that it knows the terminal it must not take
        # for a port.
        self._process = subprocess.Popen(
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            process_group=0,
        )
        for pipe in (self._process.stdin, self._process.stdout, self._process.stderr):
            os.set_blocking(pipe.fileno(), False)
        self.said = b""
        self.is_over = False
        self._rest = b""
        self._unsent = b""
        self.send("hello", v=VERSION)

    def fileno(self):
        return self._process.stdout.fileno()

    def errors(self):
        """The descriptor of what it says on standard error: when it is ready, `hear`."""
        return self._process.stderr.fileno()

    def first(self):
        """Wait for its `hello`; the messages up to then. Without one, it has ended."""
        messages = []
        while not self.is_over and not any(message["t"] == "hello" for message in messages):
            ready, _, _ = select.select([self.fileno(), self.errors()], [], [])
            if self.errors() in ready:
                self.hear()
            if self.fileno() in ready:
                messages += self.read()
        return messages

    def read(self):
        """The messages that have come."""
        try:
            told = os.read(self.fileno(), READ_MAX)
        except BlockingIOError:
            return []
        if not told:
            self.is_over = True
            return []
        *lines, self._rest = (self._rest + told).split(b"\n")
        return [json.loads(line) for line in lines]

    def hear(self):
        """Take what it says on standard error. False: that was all."""
        try:
            said = os.read(self.errors(), READ_MAX)
        except BlockingIOError:
            return True
        self.said = (self.said + said)[-SAID_MAX:]
        return bool(said)

    def send(self, kind, **fields):
        """What has no room is sent with the next message: a panel that hangs misses nothing but
        signs of life.
        """
        self._unsent += spoken(kind, id=OURS, **fields)
        try:
            sent = os.write(self._process.stdin.fileno(), self._unsent)
            self._unsent = self._unsent[sent:]
        except BlockingIOError:
            pass
        except (BrokenPipeError, ValueError):
            self._unsent = b""

    def interrupt(self, number=signal.SIGINT):
        """Ctrl-C, or what somebody has sent us."""
        if self._process.poll() is None:
            self._process.send_signal(number)

    def leave(self):
        """Nobody is at the panel any more: wait for its end. Return its exit status, negative: it
        was ended by that signal.
        """
        if not self._process.stdin.closed:
            try:
                self._process.stdin.close()
            except BrokenPipeError:
                pass
        open_ = {self.fileno(), self.errors()}
        while open_:
            ready, _, _ = select.select(list(open_), [], [], LEAVE_S)
            if not ready:
                self._process.kill()
            for descriptor in ready:
                if descriptor == self.errors() and not self.hear():
                    open_.discard(descriptor)
                elif descriptor == self.fileno():
                    self.read()
                    if self.is_over:
                        open_.discard(descriptor)
        return self._process.wait()
