# SPDX-License-Identifier: MIT
"""The small program that holds the port for a program, and stops its motors when that cannot.

    python -m uss_serial.keeper         # `link` starts it; they talk through its stdin and stdout

While the program polls its link, it says every 50 ms that it is alive. If it has said nothing for
PATIENCE_S and an exchange, or its end of the pipe is closed, every drive whose last telegram
turned its motor is sent OFF1, three times. Nothing that happens in a terminal reaches this
program: it has a session of its own, and ignores the signals that end others.
"""

import json
import os
import queue
import signal
import sys
import threading
import time
from functools import partial

if __package__ in (None, ""):
    sys.path[0] = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))

import uss_serial.frames as frames
from uss_serial.any_port import port_of
from uss_serial.frames import framed, read_frame
from uss_serial.port.dead_man import DeadMan
from uss_serial.port.errors import LineCut, PortError
from uss_serial.port.lasting_port import LastingPort

PATIENCE_S = 0.35  # beyond the 300 ms after which the master itself takes ON back
STALE_S = 0.3  # older telegrams are not sent: the program will repeat what matters
LONGEST_WAIT_S = 0.5
LOOK_S = 0.05  # how long the reading thread waits for characters
RETURN_S = 10.0  # after the program's end: for a port to come back when a drive is owed OFF1
DRAIN_S = 2.0
UNREAD_MAX = 1000  # frames that the program has not read; more are dropped
HURRY = -10  # niceness, if the user may set it
PARITY = 1  # a flag of a character, as `serial_port` has it; others are a wrong stop bit


class Keeper:
    """source, sink: streams of bytes from and to the program. find_port(path, baud): as
    `any_port.port_of`."""

    def __init__(self, source, sink, find_port=port_of, patience_s=PATIENCE_S):
        self._source = source
        self._sink = sink
        self._find_port = find_port
        self._patience_s = patience_s
        self._happened = queue.Queue()  # what the threads have seen: a function, to be called
        self._unread = queue.Queue(UNREAD_MAX)
        self._port = None
        self._lock = threading.Lock()  # two threads use the port
        self._dead_man = None  # until a port is open
        self._told = set()  # addresses of which the program knows that they were stopped
        self._over = False

    def run(self):
        """Serve until the program has ended, and all drives that it left running are stopped."""
        threading.Thread(target=self._listen, daemon=True).start()
        writer = threading.Thread(target=self._speak, daemon=True)
        writer.start()
        while not self._over:
            self._go_on()
        self._stop_all()
        self._unread.put(None)
        writer.join(LOOK_S)

    def _go_on(self):
        """Do what has happened; if nothing has, see whether the program is dead."""
        try:
            self._happened.get(timeout=self._wait_s(LONGEST_WAIT_S))()
        except queue.Empty:
            self._stop_due()

    def _wait_s(self, longest_s):
        wait_s = longest_s
        if self._dead_man is not None:
            wait_s = self._dead_man.wait_s(time.monotonic(), longest_s)
        return max(wait_s, 0.001)

    # --- the program ----------------------------------------------------------------------------

    def _listen(self):
        """In a thread of its own."""
        while True:
            try:
                frame = read_frame(self._source)
            except (OSError, ValueError):
                frame = None
            if frame is None:
                self._happened.put(self._end)
                return
            self._happened.put(partial(self._obey, *frame))

    def _obey(self, letter, content):
        if letter == frames.OPEN:
            self._open(**json.loads(content))
        elif self._dead_man is None:
            return
        elif letter == frames.ALIVE:
            self._dead_man.alive(_seconds(content))
        elif letter == frames.TELEGRAM:
            self._send(_seconds(content), content[8], content[9:])

    def _open(self, port, baud):
        try:
            if self._port is None:
                self._begin(self._find_port(port, baud), baud)
            else:
                with self._lock:
                    self._port.change_baud(baud)
        except PortError as error:
            self._tell(frames.FAILED, str(error).encode())
            return
        self._dead_man.change_baud(baud)
        self._tell(frames.OPENED)

    def _begin(self, port, baud):
        port.open()
        self._port = LastingPort(port, self._tell_line)
        self._dead_man = DeadMan(baud, self._patience_s)
        threading.Thread(target=self._receive, daemon=True).start()

    def _send(self, sent_s, pzd_words, telegram):
        told = None if pzd_words == frames.NOT_TOLD else pzd_words
        if self._dead_man.heard(telegram, sent_s, told):
            if time.monotonic() - sent_s < STALE_S:
                with self._lock:
                    self._port.write(telegram)

    def _end(self):
        self._over = True

    def _stop_due(self):
        telegram = self._dead_man.due(time.monotonic()) if self._dead_man else None
        if telegram:
            with self._lock:
                self._port.write(telegram)
            if self._dead_man.stopped != self._told:
                self._told = set(self._dead_man.stopped)
                self._tell(frames.STOPPED, bytes(sorted(self._told)))

    def _stop_all(self):
        """The program has ended: stop what it has left running."""
        if self._dead_man is None:
            return
        until_s = time.monotonic() + RETURN_S
        while not (self._port.is_open or self._dead_man.is_done()) and time.monotonic() < until_s:
            time.sleep(LOOK_S)
        self._dead_man.over(time.monotonic())
        while not self._dead_man.is_done():
            time.sleep(self._wait_s(LONGEST_WAIT_S))
            self._stop_due()
        until_s = time.monotonic() + DRAIN_S
        try:
            while self._port.is_open and self._port.port.unsent() and time.monotonic() < until_s:
                time.sleep(0.005)
        except OSError:
            pass
        with self._lock:
            self._port.port.close()
            self._port.is_open = False

    # --- the port -------------------------------------------------------------------------------

    def _receive(self):
        """In a thread of its own."""
        while True:
            if not self._port.is_open:
                time.sleep(LOOK_S)
                with self._lock:
                    if not self._port.is_open and not self._over:
                        self._port.look_again()
                continue
            try:
                if not self._port.port.wait(LOOK_S):
                    continue
            except (OSError, ValueError, TypeError, LineCut):
                pass  # it has gone: `read` will say so
            with self._lock:
                if not self._port.is_open:
                    continue
                data, flaws = self._port.read()
            if data:
                self._hand_over(data, flaws)

    def _hand_over(self, data, flaws):
        """Drop a character that came with an error, so that its telegram is not complete."""
        heard = bytes(data[i] for i in range(len(data)) if not flaws[i])
        wrong = len(data) - len(heard)
        if wrong:
            parity = sum(flaw == PARITY for flaw in flaws)
            counts = min(parity, 255), min(wrong - parity, 255)
            self._tell(frames.WRONG, frames.COUNTS.pack(*counts))
        if heard:
            self._tell(frames.DATA, _now() + heard)

    def _tell_line(self, cut):
        self._tell(*(frames.CUT, str(cut).encode()) if cut else (frames.BACK,))

    def _tell(self, letter, content=b""):
        try:
            self._unread.put_nowait(framed(letter, content))
        except queue.Full:
            pass  # a program that hangs does not read

    def _speak(self):
        """In a thread of its own, because a program that hangs does not read."""
        while True:
            frame = self._unread.get()
            try:
                if frame is None:
                    return
                self._sink.write(frame)
                self._sink.flush()
            except (OSError, ValueError):
                return  # it has ended


def _now():
    return frames.INSTANT.pack(time.monotonic_ns() // 1000)


def _seconds(content):
    return frames.INSTANT.unpack_from(content)[0] / 1e6


def main():
    for name in ("SIGINT", "SIGTERM", "SIGHUP", "SIGQUIT", "SIGBREAK", "SIGTSTP", "SIGTTOU"):
        if hasattr(signal, name):
            signal.signal(getattr(signal, name), signal.SIG_IGN)
    try:
        os.nice(HURRY)
    except (AttributeError, OSError):
        pass
    Keeper(sys.stdin.buffer, sys.stdout.buffer).run()
    sys.stdout = None  # nobody may read it any more
    os._exit(0)


if __name__ == "__main__":
    main()
