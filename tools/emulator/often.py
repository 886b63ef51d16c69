# SPDX-License-Identifier: MIT
"""Lets a firmware do for some seconds what it usually does, so that the emulator learns what it
executes often (rp2040/blocks/blocks.mjs).

    USS_EMULATOR_BLOCKS=PATH python3 tools/emulator/launch.py MICROPYTHON PROGRAM NAME

PROGRAM: this file. NAME: a firmware of tools/fetch/pico.sh. Runs on the Unix port, from the top of
the tree.
"""

import sys

sys.path[:] = ["", "firmware", ".frozen"]

import tools.emulator.world as emulated  # noqa: E402
from boards.sim.drives.families import g110  # noqa: E402

HARD = "_hard"
PROGRAMS_MS = 5_000
SAVED_MS = 60_000
KEY_MS = 400  # from key to key

# What plain MicroPython does: its bytecode, compiler, heap, files, timer, UART and I2C.
MAIN = """
import gc, json, os, struct, sys, time
from machine import I2C, Pin, Timer, UART

SOURCE = '''
class Counter:
    def __init__(self, first):
        self.count, self.seen, self.names = first, {}, []
    def step(self, value):
        self.count = (self.count + value * 7) % 1009
        self.seen[self.count & 31] = value
        if self.count > 500 and value:
            self.names.append("A%d" % self.count)
        return self.count // 3
def turn(counter, values):
    total = 0
    for value in values:
        try:
            total += counter.step(value) ^ value << 1
            if total & 64:
                raise ValueError(total)
        except ValueError as error:
            total -= error.args[0] & 15
    return [total] + list(values[:3]), (value for value in values if value)
'''
ticks = 0
def tick(timer):
    global ticks
    ticks += 1
timer = Timer(period=2, callback=tick)
uart = UART(1, 19200, parity=0, tx=Pin(4), rx=Pin(5))
i2c = I2C(0, sda=Pin(0), scl=Pin(1))
while True:
    names = {}
    exec(SOURCE, names)
    counter = names["Counter"](3)
    for length in range(20):
        row, rest = names["turn"](counter, bytearray(range(length)))
        text = json.dumps({"row": row, "rest": list(rest), "text": repr(counter.names)})
        json.loads(text)
        packed = struct.pack("<HBI", length, 7, counter.count)
        if sum(packed) != sum(memoryview(packed)[0:7]):
            sys.exit(1)
    with open("tried", "wb") as file:
        file.write(text.encode() * 20)
    with open("tried", "rb") as file:
        while file.read(64):
            pass
    os.listdir("/")
    uart.write(packed)
    uart.read()
    i2c.scan()
    gc.collect()
    time.sleep_ms(5)
"""

# What a PC asks at the prompt, and how long it then says nothing.
WRITE = "file = open('written', 'wb')\nfor _ in range(8): print(file.write(%r))\nfile.close()"
WRITTEN = bytes(range(256))
WRITES, SILENT_MS = 8, 500


def tap(world, key, ms=100):
    world.press(key, ms)
    world.run(KEY_MS)


def choose(world, *entries):
    """From the home page through the menu."""
    tap(world, "PARAM", 1_300)
    for entry in entries:
        for _ in range(20):
            if world.lcd()[1].startswith(">" + entry):
                break
            tap(world, "DOWN")
        tap(world, "SET")


def let_panel_work():
    """It runs a drive, shows pages, and saves the drive's parameters."""
    world = emulated.PicoWorld(
        "panel", baud=57600, kinds={1: {"family": g110}}, settings={"kinds": {"1": "g110"}}
    )
    world.run(3_000)
    for key in ("START", "UP", "NEXT", "PARAM", "PARAM", "DOWN", "EDIT", "STOP"):
        tap(world, key)
    world.reset()
    world.run(3_000)
    choose(world, "SETS", "SAVE A1")
    tap(world, "SET")
    assert world.run_until(lambda: world.reads("SAVED"), SAVED_MS), world.lcd()
    let_prompt_work(world)


def let_programs_work():
    world = emulated.PicoWorld("stock", addresses=(), files={"main.py": MAIN.encode()})
    world.run(PROGRAMS_MS)
    assert b"Error" not in world.usb, bytes(world.usb)
    let_prompt_work(world)


def let_prompt_work(world):
    world.repl.open()
    for _ in range(WRITES):
        _, error = world.repl.execute(WRITE % WRITTEN)
        assert not error, error
        world.run(SILENT_MS)


def main(name):
    emulated.build = HARD if name.endswith(HARD) else ""
    if name.startswith("stock"):
        let_programs_work()
    else:
        let_panel_work()


main(sys.argv[1])
