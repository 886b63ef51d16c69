"""Runs an example on the virtual board, in virtual time: ./tools/example one_drive

    stage = Stage()                         # drives 1, 2 and 3 on a line at 19200 baud
    stage.at(2.0, stage.tap, "START")
    stage.play(one_drive.main)
    stage.check()

Exit status: 0; 1 when a rule of the line was broken, or with the exception that ended the example;
2 when there is no such example.
"""

import os
import sys

from boards.sim.clock import Event
from boards.sim.world import World

FOLDER = "tools/examples"
TAP_S = 0.1

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


def run(name):
    """Play an example as somebody would who tries it out; answer the exit status."""
    if name not in names():
        print("usage: ./tools/example " + "|".join(names()))
        return 2
    stage = Stage()
    for seconds, key in TAPS:
        stage.at(seconds, stage.tap, key)
    stage.at(CTRL_C_S, stage.interrupt)
    stage.play(__import__(name).main)
    seconds = stage.clock.now_us / 1_000_000
    print("\nThe simulated drives %.1f s after power-on:" % seconds)
    for address in sorted(stage.drives):
        print(stage.drives[address].report())
    complaints = stage.complaints()
    for complaint in complaints:
        print(complaint)
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(run(sys.argv[1] if len(sys.argv) > 1 else ""))
