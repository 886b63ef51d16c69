# SPDX-License-Identifier: MIT
"""./tools/drive as a process for each rate: the drives to be tried, behind pseudo terminals.

    with Drives(KINDS) as drives:
        node = drives.ready("mm420 4+2")
        ...
        drives.power_cycle(node)        # and go on with it
        ...
        drives.leave(node)              # and go on with another

What somebody who stands beside the drive could do, is done by the commands that the program takes.
"""

import os
import select
import subprocess
import time

from conformance.master import Master, Node

COMMAND = os.path.join(os.path.dirname(__file__), "..", "..", "..", "tools", "drive")
PATIENCE_S = 30.0
BOOT_S = 0.4  # a drive's, and some
END_OF_HELP = "quit"  # the list of commands ends with it


class Drives:
    """kinds: who there is, by name; those of the same rate share a line."""

    def __init__(self, kinds):
        self._kinds = kinds
        self._lines = {}
        self._booted_s = {}  # (baud, address): when the drive will have booted

    def __enter__(self):
        try:
            for baud in sorted({kind.baud for kind in self._kinds.values()}):
                mine = [kind for kind in self._kinds.values() if kind.baud == baud]
                self._lines[baud] = DriveProgram(baud, mine)
            for line in self._lines.values():
                line.open()
            for kind in self._kinds.values():
                self._booted_s[kind.baud, kind.address] = time.monotonic() + BOOT_S
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        for line in self._lines.values():
            line.close()

    @property
    def masters(self):
        """Those of all lines."""
        return [line.master for line in self._lines.values()]

    def node(self, name):
        kind = self._kinds[name]
        master = self._lines[kind.baud].master
        return Node(master, kind.address, kind.pkw_words, kind.pzd_words)

    def ready(self, name):
        """A node that has had a power-up, and nobody has talked to it since."""
        node = self.node(name)
        self._wait_until_booted(node)
        return node

    def leave(self, node):
        """Take a drive's mains away and give them back: it boots while others are tried."""
        assert self._command(node, "off {0}\non {0}") == []
        self._booted_s[self._place(node)] = time.monotonic() + BOOT_S

    def power_cycle(self, node):
        """Take a drive's mains away, give them back, and let it boot."""
        self.leave(node)
        self._wait_until_booted(node)

    def _wait_until_booted(self, node):
        left_s = self._booted_s[self._place(node)] - time.monotonic()
        assert self._command(node, "wait %d" % (1 + 1000 * max(0, left_s))) == []

    def fault(self, node, number, lasting=False):
        """Trip a drive, for a reason that is gone at once, or lasts until `clear`."""
        more = " lasting" if lasting else ""
        assert self._command(node, "fault {0} F%04d%s" % (number, more)) == []

    def clear(self, node):
        """The reason of a lasting fault is gone."""
        assert self._command(node, "clear {0}") == []

    def warn(self, node, number, on):
        """There is something to warn of, or no more."""
        more = "" if on else " off"
        assert self._command(node, "warn {0} A%04d%s" % (number, more)) == []

    def set(self, node, number, value):
        """Change a parameter at the drive's own keypad: RAM and EEPROM."""
        said = self._command(node, "param {0} P%04d %s" % (number, value))
        assert len(said) == 1 and "=" in said[0], said

    def _command(self, node, text):
        baud, address = self._place(node)
        return self._lines[baud].command(text.format(address))

    def _place(self, node):
        for baud, line in self._lines.items():
            if line.master is node.master:
                return baud, node.address


class DriveProgram:
    """One line with drives, and a master on it."""

    def __init__(self, baud, kinds):
        self._process = subprocess.Popen(
            [COMMAND, "--pty", "--baud", str(baud), *arguments(kinds)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
        )
        self._said = b""
        self._baud = baud
        self.master = None

    def open(self):
        """Wait until it serves, and take the other end of its line."""
        self.master = Master(self._line(), self._baud, lambda: self.command(""))

    def close(self):
        if self.master is not None:
            self.master.close()
        self._process.stdin.close()
        self._process.terminate()
        self._process.wait()
        self._process.stdout.close()

    def command(self, text):
        """The lines that the program says to a command, once it has been carried out."""
        self._process.stdin.write(text.encode() + b"\nhelp\n")
        self._process.stdin.flush()
        lines = []
        while not (line := self._line()).endswith(END_OF_HELP):
            lines.append(line)
        return lines

    def _line(self):
        deadline = time.monotonic() + PATIENCE_S
        while b"\n" not in self._said:
            left = deadline - time.monotonic()
            if not select.select([self._process.stdout], [], [], max(0, left))[0]:
                raise TimeoutError("tools/drive says nothing more after %r" % self._said)
            piece = os.read(self._process.stdout.fileno(), 4096)
            if not piece:
                raise EOFError("tools/drive has ended; its last words: %r" % self._said)
            self._said += piece
        line, self._said = self._said.split(b"\n", 1)
        return line.decode()


def arguments(kinds):
    """Of tools/drive, for these drives."""
    kinds = list(kinds)
    words = ["--address", ",".join("%d=%s" % (kind.address, kind.family) for kind in kinds)]
    for kind in kinds:
        for number, value in kind.settings().items():
            words += ["--set", "%d:P%04d=%s" % (kind.address, number, value)]
        for name, value in kind.switches.items():
            words += ["--switch", "%d:%s=%s" % (kind.address, name, value)]
    return words
