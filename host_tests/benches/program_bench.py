# SPDX-License-Identifier: MIT
"""./tools/drive and ./tools/panel as programs that take commands, in real time.

In use:

    program = pytest.fixture(programs)

    def test_it(program):
        drives = program(Drives, "--address", "1,2")    # on a pty
        panel = program(Panel, drives.path)
        panel.runs()
        drives.waits(state="running")           # gives up after a while
"""

import os
import select
import signal
import subprocess
import time

from tiers import TOP

PANEL = os.path.join(TOP, "tools", "panel")
DRIVE = os.path.join(TOP, "tools", "drive")
PATIENCE_S = 30  # for a machine that does other things as well


def as_in_a_terminal():
    """Tests that run in the background or under nohup hand down signals that are ignored."""
    for number in (signal.SIGINT, signal.SIGHUP, signal.SIGQUIT, signal.SIGTSTP):
        signal.signal(number, signal.SIG_DFL)


class Talking:
    """A program that takes commands line by line, and answers."""

    def __init__(self, *command):
        self.process = subprocess.Popen(
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            preexec_fn=as_in_a_terminal,
        )
        self._said = b""

    def line(self):
        """The next line that it says."""
        deadline = time.monotonic() + PATIENCE_S
        while b"\n" not in self._said:
            left = deadline - time.monotonic()
            assert left > 0, "it says nothing; the last was %r" % self._said
            if select.select([self.process.stdout], [], [], left)[0]:
                said = os.read(self.process.stdout.fileno(), 65536)
                assert said, "it has ended"
                self._said += said
        line, self._said = self._said.split(b"\n", 1)
        return line.decode()

    def does(self, *commands):
        self.process.stdin.write(("\n".join(commands) + "\n").encode())
        self.process.stdin.flush()

    def asked(self, command):
        """The line that a command answers."""
        self.does(command)
        return self.line()

    def ends(self, patience_s=PATIENCE_S):
        status = self.process.wait(patience_s)
        self.rest = (self._said + self.process.stdout.read()).decode()
        return status

    def kill(self):
        self.process.kill()
        self.process.wait()


class Drives(Talking):
    """./tools/drive on a pty, whose path is `path`."""

    def __init__(self, *options):
        Talking.__init__(self, DRIVE, "--pty", *options)
        self.path = self.line()

    def report(self, address=1):
        """{"state": "running", ...}"""
        words = self.asked("drive %d" % address).split()
        return dict(word.split("=") for word in words if "=" in word)

    def waits(self, address=1, **wanted):
        """Until the report of a drive says so."""
        deadline = time.monotonic() + PATIENCE_S
        while True:
            report = self.report(address)
            if all(report[name] == wanted[name] for name in wanted):
                return
            assert time.monotonic() < deadline, (wanted, report)


class Panel(Talking):
    """./tools/panel on a port, which takes its commands from here."""

    def __init__(self, path, *options):
        Talking.__init__(self, PANEL, "--port", path, "--script", "-", *options)

    def shows(self, *texts):
        """Wait until the display shows one of these; answer that."""
        deadline = time.monotonic() + PATIENCE_S
        while True:
            self.does("wait 50", "lcd")
            rows = [self.line(), self.line()]
            for text in texts:
                if text in " ".join(rows):
                    return text
            assert time.monotonic() < deadline, (texts, rows)

    def runs(self):
        """START, until it runs: a machine that stalls for 300 ms stops it again."""
        while self.shows("READY", "NOT STARTED", "PANEL HUNG", "RUNNING") != "RUNNING":
            self.does("press START")
            self.shows("RUNNING", "PANEL HUNG")


def programs():
    """A fixture: makes one of the programs above, and sees that it does not run on."""
    made = []

    def make(kind, *words):
        made.append(kind(*words))
        return made[-1]

    yield make
    for one in made:
        if one.process.poll() is None:
            one.kill()
