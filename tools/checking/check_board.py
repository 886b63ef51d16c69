# SPDX-License-Identifier: MIT
"""Checks a board file on the machine of its port: what tools/check-board runs, on MicroPython.

for finding in findings("boards/pico/board.py"): print(finding)
"""

import io
import os
import sys

from boards.sim.chip.machine import Chip
from boards.sim.clock import Clock
from boards.sim.line.wire import Wire
from boards.sim.ports.chips import CHIPS
from boards.sim.ports.loading import chip_of, load
from boards.sim.ports.machine import Port
from panel.keys import COMPACT_NAMES, NAMES

CALLED = "tools/check-board: say which: a folder of boards/, or a board.py of your own"
LINES_MAX = 60
NAME_MAX = 16
BAUD = 19_200

# What the chip cannot do with a pin: all of these are told at once.
OF_PINS = ("pin", "output", "pull", "flash", "psram", "strapping", "prompt", "led", "board", "e5",
           "uart pin", "i2c pin")  # fmt: skip

SOFT_PORTS = ("esp32",)  # all callbacks there wait for the interpreter

COMPACT = ("START", "STOP", "REVERSE", "UP", "DOWN") + COMPACT_NAMES  # a keypad of eight
PINS = ("BUS_SEND", "BUS_RECEIVE", "DRIVER_ENABLE", "BACKPACK_SDA", "BACKPACK_SCL")
LCD_WIRES = ("RS", "E", "D4", "D5", "D6", "D7")  # six pins in a row

# What a board has to offer (firmware/hal/__init__.py): the attribute, and what that has to have.
OBJECTS = (
    ("name", ()),
    ("reset_cause", ()),
    ("clock", ("ticks_us", "ticks_ms", "ticks_mask", "sleep_us")),
    ("display", ("define", "show")),
    ("keypad", ("names", "read", "unclear")),
    ("store", ("read", "replace", "set_aside")),
    ("watchdog", ("feed", "stop")),
    ("timer", ("init", "deinit")),
    ("make_link", ()),
    ("idle", ()),
)
FUNCTIONS = ("make_link", "idle")
LINK = ("clock", "interrupts", "resolution_us", "on_activity", "send", "sending_us", "sent_at",
        "receive", "received_at", "close")  # fmt: skip


def wires(board):
    """What is wired to which pin: (what, number) of each, by the tables of a board file."""
    for what in PINS:
        number = getattr(board, what, None)
        if number is not None:
            yield what, number
    first = getattr(board, "LCD_REGISTER_SELECT", None)
    if first is not None:
        for place, what in enumerate(LCD_WIRES):
            yield "LCD " + what, first + place
    for what, number in getattr(board, "KEYS", ()):
        yield "key " + what, number
    for what in ("ROWS", "COLUMNS"):
        for place, number in enumerate(getattr(board, what, ())):
            yield "%s[%d]" % (what, place), number


def findings(path):
    """Texts of what is wrong with a board file, in the order of the file's life."""
    try:
        chip = chip_of(path)
    except (ValueError, SyntaxError) as error:  # or bytes that are no text
        yield "it cannot be read: %r" % error
        return
    if chip not in CHIPS:
        known = " ".join(sorted(CHIPS))
        yield 'no line `name, CHIP = "...", "..."` with a chip that is known here: %s' % known
        return
    with open(path) as file:
        lines = sum(1 for _ in file)
    if lines >= LINES_MAX:
        yield "%d lines: a board is a table of less than %d" % (lines, LINES_MAX)
    clock = Clock()
    port = Port(CHIPS[chip], Chip(clock, Wire(clock, BAUD)), OF_PINS)
    try:
        board = load(path, port)
    except Exception as error:
        yield from told(port, {})
        yield "it cannot be loaded: %r%s" % (error, line_of(error, path))
        return
    link = None
    failure = None
    low = driver_is_low(board, port)
    try:
        link = board.make_link(BAUD)
    except Exception as error:
        failure = "make_link(%d) fails: %r" % (BAUD, error)
    yield from told(port, {number: what for what, number in wires(board)})
    yield from clashes(board)
    if not low:
        yield "DRIVER_ENABLE is no output that is low before the bus is made"
    yield from keys(board)
    yield from objects(board)
    yield from supervision(board, CHIPS[chip])
    if failure:
        yield failure
    for name in LINK:
        if link is not None and not hasattr(link, name):
            yield "its link has no %s" % name


def line_of(error, path):
    """Where in the file that happened."""
    traceback = io.StringIO()
    sys.print_exception(error, traceback)
    mark = '"%s", line ' % path
    last = traceback.getvalue().rpartition(mark)[2] if mark in traceback.getvalue() else ""
    return " (line %s)" % last.split(",")[0].split("\n")[0] if last else ""


def told(port, whats):
    """What the port refused of the pins."""
    texts = []
    for name, text in port.met:
        if name in OF_PINS and text not in texts:
            texts.append(text)
            yield text + user_of(text, whats)


def user_of(text, whats):
    for number, what in whats.items():
        for prefix in ("GPIO%d", "GP%d"):
            if prefix % number in text.split():
                return " (%s)" % what
    return ""


def clashes(board):
    at = {}
    for what, number in wires(board):
        if number in at:
            yield "%s and %s are both at pin %d" % (at[number], what, number)
        at.setdefault(number, what)
    first = getattr(board, "LCD_REGISTER_SELECT", None)
    if first is not None and board.LCD_ENABLE != first + 1:
        yield "LCD_ENABLE is not the pin after LCD_REGISTER_SELECT"


def driver_is_low(board, port):
    """Whether nobody can drive the line before the bus is made."""
    number = getattr(board, "DRIVER_ENABLE", None)
    if number is None:
        return True
    pin = port.pins.get(number)
    return pin is not None and pin.mode == pin.OUT and not pin.output


def keys(board):
    names = getattr(getattr(board, "keypad", None), "names", ())
    known = NAMES + COMPACT_NAMES
    for name in names:
        if name not in known:
            yield "the panel knows no key %s: %s" % (name, " ".join(known))
    is_compact = any(name in names for name in COMPACT_NAMES)
    missing = [name for name in (COMPACT if is_compact else NAMES) if name not in names]
    if missing:
        yield "no key %s" % " ".join(missing)
    for name in ("START", "STOP"):
        if name in names and name not in [key for key, _ in board.KEYS]:
            yield "%s has no pin of its own" % name
    if "STOP" in names and "STOP" not in getattr(board, "NORMALLY_CLOSED", ()):
        yield "STOP is not normally closed: nobody will notice a broken wire"


def supervision(board, model):
    """Where callbacks are soft, a hang in C stops them all, and only the drive's own time-out is
    left."""
    if model.port in SOFT_PORTS and getattr(board, "must_supervise", False) is not True:
        yield "must_supervise is not True: if the chip hangs, nothing stops a drive without P2014"


def objects(board):
    for name, parts in OBJECTS:
        if not hasattr(board, name):
            yield "no %s: see firmware/hal/__init__.py" % name
            continue
        for part in parts:
            if not hasattr(getattr(board, name), part):
                yield "%s has no %s: see firmware/hal/__init__.py" % (name, part)
    for name in FUNCTIONS:
        if hasattr(board, name) and not callable(getattr(board, name)):
            yield "%s is no function: see firmware/hal/__init__.py" % name
    if len(getattr(board, "name", "")) > NAME_MAX:
        yield "name has more than %d characters" % NAME_MAX


def path_of(word):
    """The board file that a word of the command line means, None if there is none."""
    for path in (word, "boards/%s/board.py" % word):
        try:
            if not os.stat(path)[0] & 0x4000:  # a folder is no file
                return path
        except OSError:
            pass
    return None


def main(words):
    if len(words) != 1 or words[0].startswith("-"):
        print(CALLED)
        return 2
    path = path_of(words[0])
    if path is None:
        print("tools/check-board: there is no board %s" % words[0])
        return 2
    found = list(findings(path))
    for one in found:
        print("%s: %s" % (words[0], one))
    if not found:
        print("%s: nothing is wrong with it, as far as can be told without the chip" % words[0])
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
