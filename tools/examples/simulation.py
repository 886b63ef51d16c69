# SPDX-License-Identifier: MIT
"""Runs a program on the virtual board, in virtual time: ./tools/example one_drive

    stage = Stage()                         # drives 1, 2 and 3 on a line at 19200 baud
    stage.at(2.0, stage.tap, "START")
    stage.play(one_drive.main)
    stage.check()

A file of your own finds a module `board`, as on a chip: ./tools/example mine.py --drives 1,2=g110

Keys, and Ctrl-C at the end, are pressed only for the examples that need it (SOMEBODY); the output
says so. Exit status: 0; 1 if a rule of the line was broken, or an exception ended the program; 2
if there is no such example, file or drive.
"""

import os
import sys
from errno import errorcode

# Lower layers first, or the 32-bit build runs out of stack.
import boards.sim.drives.parameters  # noqa: F401
from boards.sim.clock import Event
from boards.sim.drives import pump
from boards.sim.drives.kinds import as_delivered, listed_drives, simulated
from boards.sim.world import World

FOLDER = "tools/examples"
TAP_S = 0.1

# Example: what a person does meanwhile, seconds of its time and key.
CTRL_C = "Ctrl-C"
SOMEBODY = {"own_program": ((2.0, "START"), (12.0, "STOP"), (40.0, CTRL_C))}

# Example: its drives, where those of --drives would not do.
DRIVES = {"own_family": {1: {"family": pump}}}

NO_NAME = "say which: %s, or FILE.py"


class UsageError(Exception):
    """The command line asks for something that cannot be."""


class _Nobody:
    """Stands in for the panel that a world usually has."""

    def __init__(self, board):
        self.board = board


class Stage(World):
    """A virtual board with drives, for a program that lets time pass itself. As of World."""

    def __init__(self, addresses=(1, 2, 3), **options):
        World.__init__(self, _Nobody, addresses, **options)
        self.board = self.app.board

    def at(self, seconds, action, *arguments):
        """Call action(*arguments) so long from now."""
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
    """What drives "1,2=g110" are: address -> kind, as of World. UsageError: none like that."""
    try:
        return simulated(listed_drives(text))
    except ValueError as error:
        raise UsageError("--drives: %s" % error) from None


def understood(words):
    """The name of an example, or of a file, and the kinds of the drives. UsageError."""
    chosen, drives = None, None
    words = list(words)
    while words:
        word, equals, given = words.pop(0).partition("=")
        if word == "--drives":
            if drives is not None:
                raise UsageError("--drives stands there twice: --drives 1,2")
            if not equals and not words:
                raise UsageError("--drives wants a list: --drives 1,2")
            drives = kinds(given if equals else words.pop(0))
        elif word[:1] == "-":
            raise UsageError("unknown option %s" % word)
        elif chosen is not None:
            raise UsageError("%s and %s: one at a time" % (chosen, word))
        else:
            chosen = word + equals + given
    return chosen, drives or DRIVES.get(chosen) or kinds("1,2,3")


def program(name):
    """main(board) of an example or a file. UsageError: there is none."""
    if name in names():
        return __import__(name).main
    if not name.endswith(".py"):
        raise UsageError("there is no example %s: %s" % (name, " ".join(names())))
    try:
        with open(name) as file:
            return _own(name, file.read())
    except OSError as error:
        raise UsageError("%s cannot be read (%s)" % (name, errorcode.get(error.args[0], error)))


def attend(stage, name):
    """Press keys, if the example needs that."""
    for seconds, key in SOMEBODY.get(name, ()):
        if key == CTRL_C:
            stage.at(seconds, stage.interrupt)
        else:
            stage.at(seconds, stage.tap, key)
        print("(%s is pressed after %d s)" % (key, seconds))


def run(words):
    """Play an example, or a file, as a person would try it out; return the exit status."""
    try:
        name, found = understood(words)
        if name is None:
            raise UsageError(NO_NAME % " ".join(names()))
        main = program(name)
    except UsageError as error:
        print("tools/example: %s" % error, file=sys.stderr)
        return 2
    stage = Stage(tuple(sorted(found)), kinds=found)
    for line in as_delivered(stage.drives, stage.wire.baud):
        print("(%s)" % line)
    attend(stage, name)
    stage.play(main)
    seconds = stage.clock.now_us / 1_000_000
    print("\nThe simulated drives %.1f s after power-on:" % seconds)
    for address in sorted(stage.drives):
        print(stage.drives[address].report())
    complaints = stage.complaints()
    for complaint in complaints:
        print(complaint)
    return 1 if complaints else 0


def _own(path, text):
    """main(board) of your own file."""

    def main(board):
        sys.modules["board"] = board
        exec(compile(text, path, "exec"), {"__name__": "__main__"})

    return main


if __name__ == "__main__":
    sys.exit(run(sys.argv[1:]))
