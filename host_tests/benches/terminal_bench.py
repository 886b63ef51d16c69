# SPDX-License-Identifier: MIT
"""A real terminal (a pty) in which a program runs, and the screen of 24 x 80 that a person sees.

In use:

    terminal = pytest.fixture(terminals)

    def test_it(terminal):
        panel = terminal("--drives", "1,2")     # ./tools/panel with these options
        panel.type("s")
        panel.shows("RUNNING")                  # waits for it, and gives up after a while
"""

import fcntl
import os
import re
import select
import signal
import struct
import subprocess
import termios
import time
from contextlib import suppress

from tiers import TOP

PANEL = os.path.join(TOP, "tools", "panel")
PATIENCE_S = 30  # for a machine that does other things as well

SEQUENCE = re.compile(rb"\x1b\[([<-?]?)([\d;:]*)([ -/]*)([@-~])")
POINTER = re.compile(rb"\x1b\]22;\w*\x07")  # how the mouse looks
CURSOR, WRAPS, SECOND, BRACKETS = "25", "7", "1049", "2004"
MOUSE, FOCUS = ("1000", "1003", "1015", "1006"), "1004"
MODES = (CURSOR, WRAPS, SECOND, BRACKETS, *MOUSE, FOCUS, "2026")


class Screen:
    """What a terminal shows and answers: as much of ECMA-48 and of xterm as the panel uses.
    Anything else is an error. answer(bytes): to the program; silent: it answers nothing. before:
    the same one when it had another size, for which a program that is slow may still write.
    """

    def __init__(self, rows, columns, answer=None, before=None):
        self.rows, self.columns = rows, columns
        self.room = rows, columns  # in which the program may place its cursor
        self.normal = []  # what was printed on the normal screen
        self.modes = {CURSOR, WRAPS}
        self.answer = answer
        self.clear()
        self.pending = b""  # of a sequence whose rest is still to come
        if before:
            self.room = max(rows, before.rows), max(columns, before.columns)
            self.modes = before.modes
            self.pending = before.pending

    second = property(lambda self: SECOND in self.modes)
    cursor = property(lambda self: CURSOR in self.modes)
    wraps = property(lambda self: WRAPS in self.modes)
    brackets = property(lambda self: BRACKETS in self.modes)
    mouse = property(lambda self: not self.modes.isdisjoint(MOUSE))

    def clear(self):
        self.cells = [[" "] * self.columns for _ in range(self.rows)]
        self.row = self.column = 0

    def lines(self):
        return ["".join(row).rstrip() for row in self.cells]

    def text(self):
        return "\n".join(self.lines() if self.second else "".join(self.normal).splitlines())

    def place(self, text):
        """Row and column of a text, from 1 on, as the mouse counts them."""
        for row, line in enumerate(self.lines()):
            if text in line:
                return row + 1, line.index(text) + 1
        raise AssertionError("%s is not on the screen:\n%s" % (text, self.text()))

    def write(self, data):
        data = self.pending + data
        at = 0
        while at < len(data):
            if data[at] == 0x1B:
                found = SEQUENCE.match(data, at) or POINTER.match(data, at)
                if not found:
                    assert len(data) - at < 16, data[at : at + 20]
                    break
                if found.re is SEQUENCE:
                    self._obey(*(part.decode() for part in found.groups()))
                at = found.end()
                continue
            size = 1 if data[at] < 0x80 else 2 if data[at] < 0xE0 else 3
            if at + size > len(data):
                break
            self._put(data[at : at + size].decode())
            at += size
        self.pending = data[at:]

    def _obey(self, private, parameters, between, final):
        if private == "?" and final in "hl":
            assert parameters in MODES, parameters
            if parameters == SECOND:
                self.clear()
            (self.modes.add if final == "h" else self.modes.discard)(parameters)
        elif private == "?" and between + final == "$p":
            self._answer("\x1b[?%s;0$y" % parameters)  # a mode that it does not know
        elif private and final == "u":
            assert private == "<", "it leaves the keyboard as it is"
        elif final == "n":
            assert parameters == "6", parameters
            self._answer("\x1b[%d;%dR" % (self.row + 1, self.column + 1))
        elif final == "H":
            row, column = (int(number) for number in (parameters or "1;1").split(";"))
            rows, columns = self.room
            assert 1 <= row <= rows and 1 <= column <= columns + 1, parameters
            self.row, self.column = row - 1, column - 1
        elif final == "J":
            self.clear()
        else:
            assert final == "m" and not private, (private, parameters, between, final)

    def _answer(self, text):
        if self.answer:
            self.answer(text.encode())

    def _put(self, character):
        if not self.second:
            self.normal.append(character)
        elif character == "\r":
            self.column = 0
        elif character == "\n":
            self.row = min(self.row + 1, self.rows - 1)
        else:
            assert character >= " ", repr(character)
            if self.row < self.rows and self.column < self.columns:  # a smaller one cuts it off
                self.cells[self.row][self.column] = character
            self.column += 1


class Terminal:
    """A terminal in which a program runs: ./tools/panel, with options, or another one."""

    def __init__(self, *options, rows=24, columns=80, program=None, discipline="0", **environment):
        self.is_dead = False  # it answers nothing, as behind a connection that froze
        self.master, self.slave = os.openpty()
        self.resize(rows, columns)
        subprocess.run(["stty", "line", discipline], stdin=self.slave, check=True)
        self.before = self.settings()
        environment = {**os.environ, "LC_ALL": "C.UTF-8", **environment}
        self.process = subprocess.Popen(
            program or [PANEL, *options],
            stdin=self.slave, stdout=self.slave, stderr=self.slave,
            start_new_session=True, cwd=TOP, env=environment,
        )  # fmt: skip

    def resize(self, rows, columns):
        self.screen = Screen(rows, columns, self._answer, getattr(self, "screen", None))
        fcntl.ioctl(self.slave, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))

    def _answer(self, data):
        if not self.is_dead:
            os.write(self.master, data)

    def settings(self):
        """All of them: Python knows no line discipline."""
        listed = subprocess.run(
            ["stty", "-a"], stdin=self.slave, capture_output=True, text=True, check=True
        ).stdout
        return re.sub("(rows|columns) [0-9]+", "", listed), termios.tcgetattr(self.slave)

    def type(self, text):
        os.write(self.master, text.encode())

    def commands(self, *commands):
        """Type what the script language knows after `:`. The line is left open."""
        if not any(line.startswith(" :") for line in self.screen.lines()):
            self.type(":")  # not while the command before still stands there
        for command in commands:
            self.waits(self.is_open, "the command line")
            self.type(command)
            self.waits(lambda: " :" + command in self.screen.lines(), command)
            time.sleep(0.2)  # at once it would be a part of what came at once
            self.type("\r")

    def is_open(self):
        """Whether a command can be typed."""
        return " :" in self.screen.lines()

    def back_to_the_keys(self):
        self.waits(self.is_open, "the command line")
        self.type("\r")
        self.waits(lambda: not self.is_open(), "the keys")

    def mouse(self, place, down):
        """The left button goes down or up there: (row, column), from 1 on."""
        row, column = place
        self.type("\x1b[<0;%d;%d%s" % (column, row, "M" if down else "m"))

    def waits(self, condition, what):
        """Take what is written until the condition holds."""
        deadline = time.monotonic() + PATIENCE_S
        while not condition():
            left = deadline - time.monotonic()
            assert left > 0, "%s was never seen:\n%s" % (what, self.screen.text())
            if select.select([self.master], [], [], min(left, 0.1))[0]:
                self.screen.write(os.read(self.master, 65536))

    def shows(self, text):
        self.waits(lambda: text in self.screen.text(), text)

    def says(self, text):
        """As `shows`, also where the text goes on in the next line."""
        self.waits(lambda: text in " ".join(self.screen.text().split()), text)

    def shows_no_more(self, text):
        self.waits(lambda: text not in self.screen.text(), "the end of " + text)

    def ends(self):
        """The exit status of the program, when everything it wrote has been seen."""
        self.waits(lambda: self.process.poll() is not None, "its end")
        while select.select([self.master], [], [], 0)[0]:
            self.screen.write(os.read(self.master, 65536))
        return self.process.returncode

    def is_as_before(self):
        assert self.settings() == self.before
        assert self.screen.cursor and self.screen.wraps
        assert not (self.screen.second or self.screen.brackets or self.screen.mouse)
        return True

    def freeze(self):
        """It is full and read no more: wait until the program stands still, as it cannot write."""
        full = os.open(os.ttyname(self.slave), os.O_WRONLY | os.O_NONBLOCK | os.O_NOCTTY)
        with suppress(BlockingIOError):
            while True:
                os.write(full, bytes(1000))
        os.close(full)
        used, since = None, time.monotonic()
        deadline = since + PATIENCE_S
        while time.monotonic() - since < 0.5:  # the picture is drawn ten times as often
            assert time.monotonic() < deadline, "the program goes on without a terminal"
            time.sleep(0.05)
            with open("/proc/%d/stat" % self.process.pid) as file:
                now = file.read().rsplit(")", 1)[1].split()[11:13]  # its time of processor
            if now != used:
                used, since = now, time.monotonic()

    def program(self):
        """The process id of the panel behind the picture."""
        with open("/proc/%d/task/%d/children" % (self.process.pid, self.process.pid)) as file:
            return int(file.read().split()[0])


def terminals():
    """A fixture: makes terminals, and sees that nothing runs on in them."""
    made = []

    def make(*options, **others):
        made.append(Terminal(*options, **others))
        return made[-1]

    yield make
    for one in made:
        if one.process.poll() is None:
            os.killpg(one.process.pid, signal.SIGKILL)
            one.process.wait()
        os.close(one.master)
        os.close(one.slave)
