#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Holds a serial port, or a pty, for a program on MicroPython, which cannot set one up itself.

    python3 tools/port/launch.py PROGRAM ARGUMENTS...

PROGRAM finds in its environment USS_PORT_DATA and USS_PORT_CONTROL, the numbers of two sockets:
one for the characters of the port, one for lines. PROGRAM sends "open BAUD PATH" and gets "opened"
or "error TEXT"; later "cut TEXT" when the port has gone, "back" when it is there again, and
"leave" on Ctrl-C, kill or a closed terminal. These signals do not reach PROGRAM, so that it can
stop its drives first. Nor does Ctrl-Z: a panel that stands still stops nothing. If PROGRAM hangs
or dies all the same, this program sends its drives OFF1. Exit status: that of PROGRAM.
"""

import os
import select
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from tools.port.dead_man import DeadMan, telegrams  # noqa: E402
from tools.port.lasting_port import AGAIN_S, LastingPort  # noqa: E402
from tools.port.serial_port import PortError, SerialPort  # noqa: E402
from tools.port.standard_streams import open_missing  # noqa: E402

LEAVE = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT)
SUSPEND = (signal.SIGTSTP, signal.SIGTTIN, signal.SIGTTOU)
STALE_S = 0.3  # if we stood still for so long, what the program sent before is out of date
NOT_FOUND = 127  # the exit status of a shell whose command is not there
READ_MAX = 4096
HURRY = -10  # niceness, if the user may set it: a panel that is too slow stops its motors
DRAIN_S = 2.0  # for the last telegrams to leave the machine
STOPPED = "panel: it hung or died, and drive %s was sent OFF1 in its place"


class Relay:
    """data, control: our ends of the program's two sockets."""

    def __init__(self, data, control):
        self._data = data
        self._control = control
        self._port = None
        self._typed = b""
        self._over = False
        self._dead_man = None  # until a port is open
        self._awake_s = time.monotonic()  # when we last ran

    def leave(self, *_):
        self._tell("leave")

    def run(self):
        """Serve until the program has ended, and all that it has sent is on the line."""
        while not self._over:
            awaited = [self._data, self._control]
            if self._is_there():
                awaited.append(self._port)
            ready, _, _ = select.select(awaited, (), (), self._wait_s())
            if self._control in ready:
                self._listen()
            if self._data in ready:
                self.send()
            if self._is_there() and self._port in ready:
                self._receive()
            if self._port is not None and not self._port.is_open:
                self._port.look_again()
            if not select.select([self._data], (), (), 0)[0]:  # otherwise it was us who hung
                self._stop_due()
            self._awake_s = time.monotonic()
        self._stop_all()
        self._drain()

    def stopped(self):
        """The addresses of the drives that were stopped because the program did not."""
        return sorted(self._dead_man.stopped) if self._dead_man else []

    def _listen(self):
        try:
            said = self._control.recv(READ_MAX)
        except ConnectionError:
            said = b""
        self._over = not said
        *lines, self._typed = (self._typed + said).split(b"\n")
        for line in lines:
            _, baud, path = os.fsdecode(line).split(" ", 2)
            self.open(path, int(baud))

    def open(self, path, baud):
        """What the program has asked for."""
        port = SerialPort(path, baud)
        try:
            port.open()
        except PortError as error:
            self._tell("error %s" % error)
            return
        self._port = LastingPort(port, self._tell_line)
        self._dead_man = DeadMan(baud)
        self._tell("opened")

    def _wait_s(self):
        return self._dead_man.wait_s(time.monotonic(), AGAIN_S) if self._dead_man else AGAIN_S

    def send(self):
        """Pass on the telegram that the program has sent. If there are more, we have been too
        slow: they may be of any age, and the program will repeat what matters.
        """
        now_s = time.monotonic()
        is_stale = now_s - self._awake_s > AGAIN_S + STALE_S
        said = b""
        while True:
            try:
                data = self._data.recv(READ_MAX)
            except BlockingIOError:
                break
            except ConnectionError:
                data = b""
            self._over = self._over or not data
            if not data:
                break
            said += data
        if said:
            may_pass = self._dead_man.heard(said, self._awake_s if is_stale else now_s)
            if may_pass and not is_stale and len(telegrams(said)) == 1:
                self._port.write(said)

    def _stop_due(self):
        telegram = self._dead_man.due(time.monotonic()) if self._dead_man else None
        if telegram:
            self._port.write(telegram)

    def _stop_all(self):
        """The program has ended: stop what it has left running."""
        if self._dead_man is None:
            return
        self._dead_man.over(time.monotonic())
        while not self._dead_man.is_done():
            self._stop_due()
            time.sleep(self._dead_man.wait_s(time.monotonic(), AGAIN_S))

    def _receive(self):
        data, flaws = self._port.read()
        # Drop a character that came with an error, so that its telegram is not complete.
        data = bytes(data[i] for i in range(len(data)) if not flaws[i])
        try:
            self._data.send(data)
        except OSError:
            pass  # the program does not read, or has ended

    def _is_there(self):
        return self._port is not None and self._port.is_open

    def _drain(self):
        if not self._is_there():
            return
        port = self._port.port
        until = time.monotonic() + DRAIN_S
        try:
            while port.unsent() and time.monotonic() < until:
                time.sleep(0.005)
        except OSError:
            pass
        port.close()

    def _tell_line(self, cut):
        self._tell("cut %s" % cut if cut else "back")

    def _tell(self, line):
        try:
            self._control.send(os.fsencode(line) + b"\n")
        except OSError:
            pass  # it has ended


def start(command, data, control):
    """Start the program. It gets none of our signals, because a second Ctrl-C would end it."""

    def prepare():
        for number in LEAVE + SUSPEND:
            signal.signal(number, signal.SIG_IGN)
        signal.pthread_sigmask(signal.SIG_BLOCK, LEAVE)  # MicroPython takes SIGINT all the same

    names = {"USS_PORT_DATA": str(data.fileno()), "USS_PORT_CONTROL": str(control.fileno())}
    data.setblocking(False)
    control.setblocking(False)
    return subprocess.Popen(
        command,
        pass_fds=(data.fileno(), control.fileno()),
        env={**os.environ, **names},
        preexec_fn=prepare,
    )


def main(command):
    if not command:
        print("launch.py: what is to be started?", file=sys.stderr)
        return 2
    open_missing()
    data, their_data = socket.socketpair()
    control, their_control = socket.socketpair()
    data.setblocking(False)
    try:
        os.nice(HURRY)
    except OSError:
        pass
    relay = Relay(data, control)
    for number in LEAVE:
        signal.signal(number, relay.leave)
    for number in SUSPEND:
        signal.signal(number, signal.SIG_IGN)
    try:
        program = start(command, their_data, their_control)
    except OSError as error:
        print("launch.py: %s: %s" % (command[0], error.strerror), file=sys.stderr)
        return NOT_FOUND
    their_data.close()
    their_control.close()
    relay.run()
    if relay.stopped():
        print(STOPPED % ", ".join(map(str, relay.stopped())), file=sys.stderr)
    status = program.wait()
    return status if status >= 0 else 128 - status


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
