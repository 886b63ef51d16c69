# SPDX-License-Identifier: MIT
"""The operator's manual on the chip when the panel fails: a loop that hangs, an engine that fails,
somebody at the USB cable. The motor stops, and nothing starts it again."""

from pico_bench import (
    OFF1,
    ON,
    panel,
    row_2,
    running,
    says,
    scripted,
    set_off,
    stands,
    start,
    starts,
    stops,
    telegrams,
)

INTERPRETERS = "pico pico_hard_again"

STOPPED = b"USS panel: stopped, and every drive with it."

# Ways to hang: the main loop never comes back, or not for three seconds.
HANGS = (
    "while True: pass",
    "time.sleep_ms(30_000)",
    "while True: gc.collect()",
    "while True: bytearray(100)",
)

# Stands before the drive that takes its replies, in interrupts: nothing is made there.
FAILS_TWICE = """
class Failing:
    def __init__(self, take):
        self.taken = take
        self.times = 2
    def take(self, buffer, count, now):
        if self.times:
            self.times -= 1
            raise ERROR
        self.taken(buffer, count, now)
ERROR = ValueError("on purpose")
drive = app.bus.turns.drives[0]
drive.take = Failing(drive.take).take
while True:
    app.step()
"""


def test_a_main_loop_that_hangs_stops_the_motor_within_400_ms_and_restarts_the_chip():
    for hang in HANGS:
        world = scripted(hang)
        hung_us = set_off(world)
        world.run(2_500)
        offs = stops(world, hung_us)
        assert offs and offs[0] - hung_us <= 400_000, (hang, offs[:1])
        assert not [stw for _, stw in telegrams(world, offs[0]) if stw != OFF1], hang
        ((bitten_us, cause),) = world.restarts
        assert cause == "watchdog" and bitten_us - hung_us <= 2_010_000, hang
        assert stands(world) and starts(world) == 1
        world.check()


def test_a_loop_that_hangs_stops_the_motor_also_while_the_drive_does_not_answer():
    world = scripted(HANGS[0])
    hung_us = set_off(world)
    world.drives[1].unplug()
    world.run(600)
    world.drives[1].plug()
    world.run(600)
    offs = stops(world, hung_us)
    assert offs and offs[0] - hung_us <= 400_000, offs[:1]
    assert not [stw for _, stw in telegrams(world, offs[0]) if stw == ON]
    assert stands(world)


def test_after_the_watchdog_the_panel_says_so_keeps_its_settings_and_starts_nothing():
    world = scripted(HANGS[0], settings={"setpoint_centihertz": 1000, "second_stop": "OFF2"})
    before = world.settings()
    hung_us = set_off(world)
    assert world.run_until(lambda: world.resets, 2_500)
    reset_us = world.clock.now_us
    assert says(world, "WATCHDOG RESTART") and says(world, "READY", 8_000)
    assert world.settings() == before and before["second_stop"] == "OFF2"
    assert not [stw for _, stw in telegrams(world, reset_us) if stw != OFF1]
    assert world.drives[1].hz() == 0 and starts(world) == 1 and reset_us > hung_us
    start(world)
    assert starts(world) == 2
    world.check()


def test_an_exception_in_the_interrupt_path_stops_the_motor_and_is_shown():
    world = scripted(FAILS_TWICE)
    hung_us = set_off(world)
    assert stands(world) and starts(world) == 1 and not world.restarts
    assert stops(world, hung_us)[0] - hung_us <= 400_000
    assert says(world, "BUS ERROR")
    world.run(200)
    world.press("START")
    assert says(world, "RUNNING") and starts(world) == 2


def test_an_exception_in_the_main_loop_stops_every_drive_and_restarts_the_chip():
    world = scripted("import main\nmain.loop = None\ntry:\n    1 / 0\nfinally:\n    app.close()")
    hung_us = set_off(world)
    assert stands(world) and stops(world, hung_us)[0] - hung_us <= 400_000
    assert world.run_until(lambda: world.resets, 2_500)
    assert world.reset_causes == ["watchdog"] and starts(world) == 1
    world.check()


def test_ctrl_c_stops_every_drive_and_ends_in_a_maintenance_mode_without_watchdog():
    world = running(addresses=(1, 2))
    asked_us = world.clock.now_us
    world.repl.write(b"\x03")
    world.repl.wait_for(STOPPED, 3_000)
    assert stops(world, asked_us)[0] - asked_us <= 400_000 and stops(world, asked_us, 2)
    assert stands(world) and starts(world) == 1
    assert world.lcd() == ("PANEL STOPPED   ", "NO CONTROL      ")
    quiet_us = world.clock.now_us
    world.run(3_000)
    assert not world.restarts and not telegrams(world, quiet_us)
    world.repl.open()
    assert world.repl.execute("print('here')") == ("here\r\n", "")
    world.check()


def test_ctrl_c_again_and_again_does_not_keep_the_drives_from_being_stopped():
    world = running()
    asked_us = world.clock.now_us
    for _ in range(40):
        world.repl.write(b"\x03")
        world.run(7)
    world.run(1_500)
    assert stops(world, asked_us)
    assert stands(world) and starts(world) == 1
    world.check()


def test_ctrl_d_after_that_starts_the_panel_and_not_the_motor():
    world = running()
    world.repl.write(b"\x03")
    world.repl.wait_for(STOPPED, 3_000)
    world.run(500)
    asked_us = world.clock.now_us
    world.repl.write(b"\x04")
    assert says(world, "READY        A1")
    assert stands(world) and starts(world) == 1
    assert not [stw for _, stw in telegrams(world, asked_us) if stw != OFF1]
    start(world)
    assert starts(world) == 2 and row_2(world) == "RUNNING      A1"
    world.check()


def test_somebody_who_only_listens_at_the_usb_cable_disturbs_nothing():
    world = panel()
    world.repl.write(b"hello\r\nimport machine\r\n")
    world.run(1_000)
    assert row_2(world) == "READY        A1" and not world.restarts
    world.check()
