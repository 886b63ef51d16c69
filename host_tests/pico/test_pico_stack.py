# SPDX-License-Identifier: MIT
"""The stack of the chip: the receive interrupt may come at the deepest place of the main program.

MicroPython refuses a call that would leave too little (RuntimeError). In the interrupt that costs
an exchange and takes ON back from every drive. So the firmware of our own has room for both, and
elsewhere the engine is put off (`hal.pacer`) where there is none.
"""

from boards.sim.drives.families import g110, mm420
from panel_bench import row_2
from pico_bench import choose, deployed, go_to, panel, press, says

INTERPRETERS = "pico_hard"  # there all of the engine runs in handlers; else a part of it does

STACK_BYTES = 8192 + 1984  # of the RP2040's two small banks, and STACK_MORE of tools/fetch/pico.sh
MARGIN_BYTES = 256  # that MicroPython keeps for functions in C
HANDLERS_BYTES = 3_900  # of the engine that goes on; only a firmware that is frozen has it


def panel_of(family, name):
    kinds = {1: {"family": family, "parameters": {2014: 2_000}}}
    world = panel(baud=57600, kinds=kinds, settings={"kinds": {"1": name}})
    world.run(1_000)
    world.stack_depths()  # to build the panel goes deeper, before any interrupt comes
    return world


def check(world, what):
    program, handlers = world.stack_depths()
    print("%s: program %d, interrupts %d" % (what, program, handlers))
    assert program and handlers
    assert program + handlers <= STACK_BYTES - MARGIN_BYTES, what
    assert handlers <= HANDLERS_BYTES, what
    world.check()


def test_a_motor_that_runs():
    world = panel_of(mm420, "mm420")
    press(world, "START")
    world.run(5_000)
    press(world, "UP", "REVERSE")
    world.run(3_000)
    press(world, "STOP")
    world.run(3_000)
    check(world, "a motor that runs")


def test_a_parameter_is_looked_up_and_written():
    world = panel_of(g110, "g110")
    go_to(world, "PARAMETERS", "BY NUMBER")
    press(world, "UP", "NEXT", "UP", "NEXT", "UP", "UP", "SET")
    world.run(4_000)
    assert row_2(world).startswith("P1120"), world.lcd()
    check(world, "a parameter looked up")
    press(world, "EDIT", "UP", "SET")
    world.run(3_000)
    check(world, "a parameter written")
    press(world, "NEXT")
    world.run(2_000)
    check(world, "the next one")


def test_a_fault_is_explained():
    world = panel_of(g110, "g110")
    world.drives[1].fault(1)
    world.run(2_000)
    go_to(world, "WHAT IS F0001")
    press(world, "DOWN", "PARAM")
    choose(world, "FAULT MEMORY")
    press(world, "DOWN")
    world.run(2_000)
    check(world, "a fault explained")


def test_a_set_is_saved_and_written():
    world = panel_of(g110, "g110")
    go_to(world, "SETS", "SAVE A1")
    press(world, "SET")
    world.run(20_000)
    check(world, "a set saved")


def test_commissioning():
    world = panel_of(g110, "g110")
    go_to(world, "COMMISSION", "FOR USS")
    world.run(3_000)
    press(world, "DOWN", "SET")
    world.run(3_000)
    check(world, "commissioning")


def test_settings_and_diagnosis():
    world = panel_of(mm420, "mm420")
    go_to(world, "SETTINGS")
    press(world, "SET", "UP", "SET")
    world.run(2_000)
    check(world, "settings")
    go_to(world, "DIAGNOSIS", "BUS COUNTERS")
    world.run(2_000)
    check(world, "diagnosis")


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
