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

from tiers import TOP

PANEL = os.path.join(TOP, "tools", "panel")
PATIENCE_S = 30  # for a machine that does other things as well

SEQUENCE = re.compile(rb"\x1b\[([?\d;]*)([A-Za-z])")


class Screen:
    """What a terminal shows: as much of ECMA-48 as the panel uses. Anything else is an error."""

    def __init__(self, rows, columns):
        self.rows, self.columns = rows, columns
        self.normal = []  # what was printed on the normal screen
        self.second = False
        self.cursor = True
        self.wraps = True
        self.brackets = False  # around what is pasted
        self.clear()
        self._pending = b""

    def clear(self):
        self.cells = [[" "] * self.columns for _ in range(self.rows)]
        self.row = self.column = 0

    def lines(self):
        return ["".join(row).rstrip() for row in self.cells]

    def text(self):
        return "\n".join(self.lines() if self.second else "".join(self.normal).splitlines())

    def write(self, data):
        data = self._pending + data
        at = 0
        while at < len(data):
            if data[at] == 0x1B:
                found = SEQUENCE.match(data, at)
                if not found:
                    assert len(data) - at < 12, data[at : at + 20]
                    break
                self._obey(found[1].decode(), found[2].decode())
                at = found.end()
                continue
            size = 1 if data[at] < 0x80 else 2 if data[at] < 0xE0 else 3
            if at + size > len(data):
                break
            self._put(data[at : at + size].decode())
            at += size
        self._pending = data[at:]

    def _obey(self, parameters, final):
        if final in "hl":
            on = final == "h"
            if parameters == "?1049":
                self.second = on
                self.clear()
            elif parameters == "?25":
                self.cursor = on
            elif parameters == "?2004":
                self.brackets = on
            else:
                assert parameters == "?7", parameters
                self.wraps = on
        elif final == "H":
            row, column = map(int, parameters.split(";"))
            assert 1 <= row <= self.rows and column == 1, parameters
            self.row, self.column = row - 1, 0
        elif final == "K":
            # After a character in the last column the cursor still stands on it.
            column = min(self.column, self.columns - 1)
            self.cells[self.row][column:] = [" "] * (self.columns - column)
        elif final == "J":
            self.clear()
        else:
            assert final == "m" and parameters in ("0", "7", "27"), (parameters, final)

    def _put(self, character):
        if not self.second:
            self.normal.append(character)
            return
        assert character >= " " and self.column < self.columns, "it would leave the screen"
        self.cells[self.row][self.column] = character
        self.column += 1


class Terminal:
    """A terminal in which a program runs: ./tools/panel, with options, or another one."""

    def __init__(self, *options, rows=24, columns=80, program=None, discipline="0", **environment):
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
        self.screen = Screen(rows, columns)
        fcntl.ioctl(self.slave, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))

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
        if " :_" not in self.screen.text():
            self.type(":")
        for command in commands:
            self.shows(" :_")
            self.type(command)
            self.shows(" :%s_" % command)
            time.sleep(0.2)  # at once it would be a part of what came at once
            self.type("\r")

    def back_to_the_keys(self):
        self.shows(" :_")
        self.type("\r")
        self.shows_no_more(" :_")

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
        assert not (self.screen.second or self.screen.brackets)
        return True

    def program(self):
        """The process id of the program that the wrapper runs."""
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
