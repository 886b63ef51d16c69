# SPDX-License-Identifier: MIT
"""What the catalogue knows, on the chip, by keys: of a MICROMASTER 420, whose rows leave to those
of the 440 what is the same.
"""

import pico_bench
from panel_bench import row_2
from pico_bench import go_to, press, says

INTERPRETERS = "pico"


made = []  # the world of a panel: each test finds its own way through it


def panel():
    if not made:
        made.append(pico_bench.panel())
    return made[0]


def test_a_parameter_is_looked_up_by_its_number():
    world = panel()
    go_to(world, "PARAMETERS", "BY NUMBER")
    press(world, "UP", "NEXT", "UP", "NEXT", "UP", "UP")
    assert row_2(world) == "P01120", world.lcd()
    press(world, "SET")
    assert says(world, "Ramp-up time", 4_000), world.lcd()
    assert row_2(world) == "P1120      2.00s", world.lcd()
    world.check()


def test_a_fault_is_explained_and_kept_in_the_memory():
    world = panel()
    world.drives[1].fault(1)
    assert says(world, "FAULT F0001"), world.lcd()
    go_to(world, "WHAT IS F0001")
    assert says(world, ">Overcurrent"), world.lcd()
    press(world, "DOWN")
    assert row_2(world) == ">Short circuit", world.lcd()
    press(world, "PARAM", "PARAM")
    world.run(1_500)
    world.press("STOP")
    assert says(world, "READY"), world.lcd()
    go_to(world, "FAULT MEMORY")
    press(world, "DOWN", "DOWN")
    assert says(world, ">F0001 Overcurre"), world.lcd()
    world.check()


def test_commissioning_has_its_steps():
    world = panel()
    go_to(world, "COMMISSION", "FOR USS")
    assert says(world, "P0003", 4_000), world.lcd()
    press(world, "DOWN", "DOWN")
    assert says(world, "P2010*", 4_000), world.lcd()
    world.check()
