# SPDX-License-Identifier: MIT
"""The operator's manual on the chip: the firmware file that people flash, on an emulated Pico."""

from pico_bench import (
    OFF1,
    ON,
    panel,
    running,
    says,
    stands,
    start,
    starts,
    stops,
    telegrams,
)
from tools.emulator.world import PicoWorld
from version import VERSION

INTERPRETERS = "pico pico_hard_again"


def test_after_power_on_the_panel_says_what_it_is_not_and_shows_its_drive():
    world = PicoWorld("panel")
    assert says(world, "USS %s IS NO EMERGENCY STOP" % VERSION)
    assert says(world, "READY        A1")
    assert world.lcd()[0] == "S: 10.0 F:  0.00"
    assert b"USS panel: runs" in world.usb
    world.check()


def test_the_first_telegram_goes_out_within_a_second_of_power_on():
    world = PicoWorld("panel")
    world.run(1000)
    assert telegrams(world, 0)
    world.check()


def test_the_display_may_hang_on_a_backpack():
    world = panel(display="backpack")
    assert says(world, "READY        A1") and world.backpack.lit
    assert world.lcd()[0] == "S: 10.0 F:  0.00"
    start(world)
    assert says(world, "F: 10.00")
    world.check()


def test_a_backpack_that_is_not_there_leaves_the_four_data_lines():
    world = panel(display="wires")
    assert world.backpack is None and world.lcd_chip.characters > 0
    world.check()


def test_start_runs_the_drive_and_stop_stops_it():
    world = running()
    assert says(world, "F: 10.00")
    pressed_us = world.clock.now_us
    world.press("STOP")
    assert stops(world, pressed_us)[0] - pressed_us < 100_000
    assert stands(world) and says(world, "READY") and starts(world) == 1
    world.check()


def test_a_jog_turns_as_long_as_its_key_is_held():
    world = panel()
    world.down("JOG_RIGHT")
    assert says(world, "JOG RIGHT")
    world.run(1000)
    assert world.drives[1].hz() > 0
    released_us = world.clock.now_us
    world.up("JOG_RIGHT")
    world.run(200)
    jogs = [at_us for at_us, stw in telegrams(world, released_us) if stw & 0x0300]
    assert not jogs or jogs[-1] - released_us < 100_000
    assert stands(world, ms=10_000)
    world.check()


def test_the_keys_change_setpoint_and_direction():
    world = panel()
    world.press("UP")
    world.press("REVERSE")
    assert says(world, "S:-10.1", 500)
    world.press("PARAM")
    assert says(world, "P0700:     5", 1000)
    world.check()


def test_two_drives_are_told_apart():
    world = panel(addresses=(1, 2))
    start(world)
    world.press("ADDRESS_UP")
    assert says(world, "A2", 500)
    world.press("STOP")
    assert world.drives[1].state == "running" and world.drives[2].starts == 0
    world.down("STOP")
    world.run(4500)
    world.up("STOP")
    assert stands(world)
    world.check()


def test_keys_that_bounce_start_and_stop_once():
    world = running(seed=5)
    world.press("STOP")
    assert stands(world) and starts(world) == 1
    world.check()


def test_a_broken_wire_of_stop_stops_and_prevents_a_start():
    world = running()
    cut_us = world.clock.now_us
    world.keypad.cut("STOP")
    world.run(200)
    assert stops(world, cut_us)[0] - cut_us < 100_000
    world.press("START")
    assert stands(world) and starts(world) == 1
    assert not [stw for _, stw in telegrams(world, cut_us + 100_000) if stw == ON]
    world.check()


def test_a_key_held_at_power_on_leaves_the_chip_at_the_prompt():
    world = PicoWorld("panel", files={"boot.py": b"import time; time.sleep_ms(200)"})
    world.down("DOWN")
    world.run(1000)
    assert b"USS panel: not started" in world.usb
    world.up("DOWN")
    world.repl.open()
    assert world.repl.execute("print(6 * 7)") == ("42\r\n", "")
    world.run(3000)
    assert not telegrams(world, 0) and not world.resets
    world.check()


def test_start_held_through_power_on_starts_nothing():
    world = PicoWorld("panel")
    world.down("START")
    world.run(2500)
    assert starts(world) == 0
    for _, stw in telegrams(world, 0):
        assert stw == OFF1
    world.up("START")
    world.run(100)
    start(world)
    world.check()


def test_the_run_pin_ends_in_a_stopped_motor_and_no_start():
    world = running()
    reset_us = world.clock.now_us
    world.reset()
    assert stands(world) and says(world, "READY        A1")
    assert world.reset_causes == ["reset"] and starts(world) == 1
    for _, stw in telegrams(world, reset_us):
        assert stw == OFF1
    world.check()
