# SPDX-License-Identifier: MIT
"""A bare emulated Pico for the checks of tools/bringup: plain MicroPython, and the files it needs.

bare = bare_pico()                  # GP4 is joined to GP5
ask(bare, "codes()")                # what the chip answers
"""

import os

from boards.sim.clock import Event
from tools.emulator.station import RATE_SHIFT, UNIT_BAUD, Figures
from tools.emulator.world import PicoWorld

ON_CHIP = "tools/bringing_up/on_chip.py"
CALL_MS = 30_000
LOOK_US = 20


class Jumper:
    """A wire from GP4 to GP5 in place of the transceiver: the chip hears what it sends.

    The chip tells a character when it is over; LOOK_US is how often somebody looks for it. alters:
    a function of the character, that answers what arrives, None for nothing.
    """

    def __init__(self, world, alters=None, baud=115_200, look_us=LOOK_US):
        self.baud = baud
        self._look_us = look_us
        self.figures = Figures()
        self.complaints = []
        self._world = world
        self._alters = alters
        self._look = Event(self._looked)
        self._looked()

    def sent(self, at_ns, byte, flaws):
        arrives = self._alters(byte) if self._alters else byte
        if arrives is not None:
            end_ns = at_ns + 11_000_000_000 // self.baud
            rate = self.baud // UNIT_BAUD << RATE_SHIFT
            self._world.chip.tell(end_ns, "C", arrives, rate | flaws)

    def tune(self, baud):
        self.baud = baud

    talk_at = tune

    def driver(self, at_ns, on):
        pass

    drive = driver

    def reset(self):
        pass

    def _looked(self):
        clock = self._world.clock
        clock.schedule(self._look, clock.now_us + self._look_us)


def files(changes=()):
    """What tools/bringup puts onto the chip. changes: (file, old, new) of each."""
    found = {"chips/rp2.py": read("boards/chips/rp2.py"), "on_chip.py": read(ON_CHIP)}
    for folder in ("hal", "hal/display", "hal/link"):
        for name in os.listdir("firmware/" + folder):
            if name.endswith(".py"):
                found[folder + "/" + name] = read("firmware/%s/%s" % (folder, name))
    for path, old, new in changes:
        assert old in found[path], (path, old)
        found[path] = found[path].replace(old, new)
    return found


def read(path):
    with open(path, "rb") as file:
        return file.read()


def bare_pico(joined=True, changes=(), alters=None, baud=115_200):
    world = PicoWorld("stock", addresses=(), baud=baud, files=files(changes))
    if joined:
        world.station = Jumper(world, alters, baud)
    world.repl.open()
    world.repl.execute("from on_chip import *", CALL_MS)
    return world


def ask(world, call):
    printed, error = world.repl.execute("print(repr(%s))" % call, CALL_MS)
    assert not error, error
    return eval(printed.strip())
