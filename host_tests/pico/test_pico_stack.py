# SPDX-License-Identifier: MIT
"""The stack of the chip: the receive interrupt may come at the deepest place of the main program.

MicroPython refuses a call that would leave too little (RuntimeError). In the interrupt that costs
an exchange and takes ON back from every drive. So the firmware of our own has room for both, and
elsewhere the engine is put off (`hal.pacer`) where there is none.
"""

from boards.sim.drives.families import g110, mm420
from panel_bench import row_2
from pico_bench import QUICK, choose, deployed, go_to, panel, press, says, stands, start

INTERPRETERS = "pico_hard"  # there all of the engine runs in handlers; else a part of it does

STACK_BYTES = 8192 + 1984  # of the RP2040's two small banks, and STACK_MORE of tools/fetch/pico.sh
MARGIN_BYTES = 256  # that MicroPython keeps for functions in C
HANDLERS_BYTES = 3_900  # of the engine that goes on; only a firmware that is frozen has it


made = {}  # name of a drive -> the world of a panel that has it: one at a time


def panel_of(family, name):
    """At its home page, ready. What one test leaves behind the next one goes on with."""
    if name not in made:
        made.clear()
        kinds = {1: {"family": family, "parameters": QUICK}}
        made[name] = panel(baud=57600, kinds=kinds, settings={"kinds": {"1": name}})
        made[name].run(1_000)
    world = made[name]
    go_home(world)
    world.stack_depths()  # to build the panel goes deeper, before any interrupt comes
    return world


def go_home(world):
    for _ in range(6):
        if world.reads("READY"):
            return
        press(world, "PARAM")
    raise AssertionError(world.lcd())


def check(world, what):
    program, handlers = world.stack_depths()
    print("%s: program %d, interrupts %d" % (what, program, handlers))
    assert program and handlers
    assert program + handlers <= STACK_BYTES - MARGIN_BYTES, what
    assert handlers <= HANDLERS_BYTES, what
    world.check()


def test_a_motor_that_runs():
    world = panel_of(mm420, "mm420")
    start(world)
    press(world, "UP", "REVERSE")
    assert world.run_until(lambda: world.drives[1].hz() <= -9.9, 5_000), world.lcd()
    press(world, "STOP")
    assert stands(world) and says(world, "READY"), world.lcd()
    check(world, "a motor that runs")


def test_settings_and_diagnosis():
    world = panel_of(mm420, "mm420")
    go_to(world, "SETTINGS")
    press(world, "SET", "UP", "SET")
    world.run(1_000)
    check(world, "settings")
    go_to(world, "DIAGNOSIS", "BUS COUNTERS")
    world.run(1_000)
    check(world, "diagnosis")


def test_a_parameter_is_looked_up_and_written():
    world = panel_of(g110, "g110")
    go_to(world, "PARAMETERS", "BY NUMBER")
    press(world, "UP", "NEXT", "UP", "NEXT", "UP", "UP", "SET")
    assert world.run_until(lambda: row_2(world).startswith("P1120"), 4_000), world.lcd()
    world.run(500)
    check(world, "a parameter looked up")
    press(world, "EDIT", "UP", "SET")
    world.run(3_000)
    check(world, "a parameter written")
    press(world, "NEXT")
    world.run(1_000)
    check(world, "the next one")


def test_a_set_is_saved():
    world = panel_of(g110, "g110")
    go_to(world, "SETS", "SAVE A1")
    press(world, "SET")
    assert says(world, "SAVED", 60_000), world.lcd()
    check(world, "a set saved")


def test_commissioning():
    world = panel_of(g110, "g110")
    go_to(world, "COMMISSION", "FOR USS")
    assert says(world, "P0003", 4_000), world.lcd()
    press(world, "DOWN", "SET")
    world.run(2_000)
    check(world, "commissioning")


def test_a_fault_is_explained():
    world = panel_of(g110, "g110")
    world.drives[1].fault(1)
    assert says(world, "FAULT F0001"), world.lcd()
    go_to(world, "WHAT IS F0001")
    press(world, "DOWN", "PARAM")
    choose(world, "FAULT MEMORY")
    press(world, "DOWN")
    world.run(1_000)
    check(world, "a fault explained")
    press(world, "PARAM", "PARAM", "STOP")


TELLS_PUT_OFF = b"""
from hal import pacer
from machine import Timer
seen = []
class Pacer(pacer.Pacer):
    def start(self):
        seen[:] = [self]
        super().start()
pacer.Pacer = Pacer
def tell(_):
    for one in seen:
        print("PUT OFF", one.put_off, "FAILURE", one.failure)
timer = Timer(period=500, mode=Timer.PERIODIC, callback=tell)
"""


def test_as_files_there_is_less_and_the_engine_is_put_off():
    """On plain MicroPython; a set is what takes the most."""
    made.clear()
    kinds = {1: {"family": g110, "parameters": {2014: 2_000}}}
    settings = {"kinds": {"1": "g110"}}
    world = deployed({"boot.py": TELLS_PUT_OFF}, baud=57600, kinds=kinds, settings=settings)
    assert says(world, "READY", 15_000)
    go_to(world, "SETS", "SAVE A1")
    press(world, "SET")
    assert world.run_until(lambda: was_put_off(world), 20_000), bytes(world.usb)
    assert b"FAILURE None" in world.usb and world.usb.count(b"FAILURE") == world.usb.count(b"None")
    world.check()


def was_put_off(world):
    counts = [line.split()[2] for line in bytes(world.usb).split(b"\r\n")[:-1]]
    return any(count != b"0" for count in counts)
