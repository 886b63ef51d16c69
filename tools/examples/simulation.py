# SPDX-License-Identifier: MIT
"""Runs a program on the virtual board, in virtual time: ./tools/example one_drive

    stage = Stage()                         # drives 1, 2 and 3 on a line at 19200 baud
    stage.at(2.0, stage.tap, "START")
    stage.play(one_drive.main)
    stage.check()

A file of one's own finds a module `board`, as on a chip: ./tools/example mine.py --drives 1,2=g110

Exit status: 0; 1 when a rule of the line was broken, or with the exception that ended the program;
2 when there is no such example.
"""

import os
import sys

from boards.sim import g110, g120, generic, mm3, mm420, mm440, v20
from boards.sim.clock import Event
from boards.sim.world import World

FOLDER = "tools/examples"
TAP_S = 0.1
FAMILIES = {
    "g110": g110, "g120": g120, "generic": generic, "mm3": mm3, "mm420": mm420, "mm440": mm440,
    "v20": v20,
}  # fmt: skip

# What a person does meanwhile: seconds, key.
TAPS = ((2.0, "START"), (12.0, "STOP"))
CTRL_C_S = 40.0


class _Nobody:
    """In place of the panel that a world has otherwise."""

    def __init__(self, board):
        self.board = board


class Stage(World):
    """A virtual board with drives, for a program that lets time pass itself. As of World."""

    def __init__(self, addresses=(1, 2, 3), **options):
        World.__init__(self, _Nobody, addresses, **options)
        self.board = self.app.board

    def at(self, seconds, action, *arguments):
        """Have action(*arguments) happen so long from now."""
        event = Event(lambda: action(*arguments))
        self.clock.schedule(event, self.clock.now_us + int(seconds * 1_000_000))

    def tap(self, key):
        self.down(key)
        self.at(TAP_S, self.up, key)

    def interrupt(self):
        """Ctrl-C."""
        raise KeyboardInterrupt

    def play(self, main):
        """Run main(board) to its end, or until Ctrl-C."""
        try:
            main(self.board)
        except KeyboardInterrupt:
            pass


def names():
    """The examples there are."""
    files = [name for name in os.listdir(FOLDER) if name.endswith(".py")]
    return sorted(name[:-3] for name in files if name != "simulation.py")


def kinds(text):
    """What drives "1,2=g110" are: address -> kind, as of World. ValueError: none like that."""
    found = {}
    for entry in text.split(","):
        address, _, family = entry.partition("=")
        family = family.lower() or "mm420"
        if family not in FAMILIES:
            raise ValueError("no drive %r: %s" % (family, " ".join(sorted(FAMILIES))))
        found[int(address)] = {"family": FAMILIES[family]}
    return found


def run(name, drives="1,2,3"):
    """Play an example, or a file, as somebody would who tries it out; answer the exit status."""
    if name not in names() and not name.endswith(".py"):
        print("usage: ./tools/example %s|FILE.py [--drives 1,2=g110]" % "|".join(names()))
        return 2
    found = kinds(drives)
    stage = Stage(tuple(sorted(found)), kinds=found)
    for seconds, key in TAPS:
        stage.at(seconds, stage.tap, key)
    stage.at(CTRL_C_S, stage.interrupt)
    stage.play(_own(name) if name.endswith(".py") else __import__(name).main)
    seconds = stage.clock.now_us / 1_000_000
    print("\nThe simulated drives %.1f s after power-on:" % seconds)
    for address in sorted(stage.drives):
        print(stage.drives[address].report())
    complaints = stage.complaints()
    for complaint in complaints:
        print(complaint)
    return 1 if complaints else 0


def _own(path):
    """main(board) of a file of one's own."""

    def main(board):
        sys.modules["board"] = board
        with open(path) as file:
            exec(compile(file.read(), path, "exec"), {"__name__": "__main__"})

    return main


if __name__ == "__main__":
    words = [word for word in sys.argv[1:] if word != "--drives"]
    sys.exit(run(*(words or [""])))
