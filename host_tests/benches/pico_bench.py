# SPDX-License-Identifier: MIT
"""What the tests of the panel on the emulated Pico share: a chip with the real firmware file.

    world = running()                       # build/pico/panel.uf2, its drive at the setpoint
    world = scripted("app.step()")          # the same firmware, but with a main loop of our own

A script takes the place of the frozen main.py by way of boot.py. It runs after power-on alone:
what comes after a reset is the firmware as it is. There is no USB in boot.py: the LED tells.
"""

import os

from panel_bench import OFF1, ON, row_2, starts, telegrams
from tools.emulator.flash_image import files_in
from tools.emulator.world import PicoWorld, temporary

BOOT_MS = 3_000
START_MS = 5_000
QUICK = {2014: 2_000, 1120: 2.0, 1121: 2.0}  # supervised; ramps that take 0.4 s to 10 Hz and back

SET = 13  # bit of the key: pressing it makes a script do what it is about

SCRIPT = """
import board
if not board.reset_cause:
    import time, gc
    from machine import Pin
    from app import App
    led = Pin(25, Pin.OUT, value=0)
    app = App(board)
    app.start()
    while not board.keypad.read() >> %d & 1:
        app.step()
    led(1)
    %s
"""


def panel(**options):
    """A panel that was switched on, has checked its drives and is ready."""
    options.setdefault("parameters", QUICK)
    world = PicoWorld("panel", **options)
    assert world.run_until(lambda: row_2(world).startswith("READY"), BOOT_MS), world.lcd()
    return world


_panel_files = {}  # once made


def panel_files():
    """{path: content} of the panel as files, as tools/deploy copies them onto a Pico."""
    if not _panel_files:
        folder = temporary()
        write = "build/mpremote/bin/python -B tools/benching/deployed.py %s" % folder
        assert os.system(write) == 0
        try:
            _panel_files.update(files_in(folder))
        finally:
            os.system("rm -r %s" % folder)
    return dict(_panel_files)


def deployed(files=(), **options):
    """A Pico with plain MicroPython and the panel as files, and these files besides."""
    everything = panel_files()
    everything.update(files)
    options.setdefault("parameters", QUICK)
    return PicoWorld("stock", files=everything, **options)


def running(**options):
    """A panel whose drive 1 has been started and is at its setpoint."""
    world = panel(**options)
    start(world)
    return world


def start(world):
    world.press("START")
    assert world.run_until(lambda: world.reads("RUNNING"), START_MS), world.lcd()
    drive = world.drives[1]
    assert world.run_until(lambda: abs(drive.hz()) >= 9.9, START_MS), drive.report()


def press(world, *keys):
    for key in keys:
        world.press(key)
        world.run(300)


def choose(world, *entries):
    """Walk to an entry of the list that is shown and press SET, one after the other."""
    for entry in entries:
        for _ in range(20):
            if row_2(world).startswith(">" + entry):
                break
            press(world, "DOWN")
        else:
            raise AssertionError("no %s: %r" % (entry, world.lcd()))
        press(world, "SET")
        world.run(700)


def go_to(world, *entries):
    """Open the menu, from wherever one is, and choose these."""
    for _ in range(6):
        if not row_2(world).startswith(">"):
            break
        press(world, "PARAM")
    world.press("PARAM", 1_300)
    world.run(500)
    choose(world, *entries)


def scripted(then, motor_on=True, **options):
    """A panel that runs until SET is pressed; then it does the lines of `then`.

    motor_on: its drive 1 has been started.
    """
    script = SCRIPT % (SET, then.strip().replace("\n", "\n    "))
    begin = running if motor_on else panel
    return begin(files={"boot.py": script.encode()}, **options)


def set_off(world):
    """Press SET, at which a script does what it is about; answer the instant of that."""
    world.down("SET")
    assert world.run_until(lambda: world.led and world.led[-1][1], 200), world.led
    world.up("SET")
    return world.led[-1][0]


def stops(world, since_us, address=1):
    """When the panel sent OFF1 to a drive since then: instants of the telegrams."""
    return [at_us for at_us, stw in telegrams(world, since_us, address) if stw == OFF1]


def says(world, text, ms=BOOT_MS):
    """Whether `text` comes on the display within so long."""
    return world.run_until(lambda: world.reads(text), ms)


def stands(world, address=1, ms=5_000):
    """Whether the motor comes to a standstill within so long."""
    return world.run_until(lambda: world.drives[address].hz() == 0, ms)


__all__ = (
    "OFF1", "ON", "choose", "go_to", "panel", "press", "row_2", "running", "says", "scripted",
    "set_off", "stands", "start", "starts", "stops", "telegrams",
)  # fmt: skip
