# SPDX-License-Identifier: MIT
"""Noise on the line of an emulated Pico, above all while its panel starts: it waits until that is
over, and then finds its drives. In both ways in which the receive time-out may behave."""

from boards.sim.line.faults import LineFaults
from pico_bench import QUICK, panel, row_2, running, says, stands
from tools.emulator.world import PicoWorld

INTERPRETERS = "pico pico_again"

READY_MS = 4_000  # with 31 drives, of which 30 are silent


def noise(world, ms):
    LineFaults(world.wire, world.random).strike("babble", ms)


def gets_ready(world, noise_ms):
    noise(world, noise_ms)
    ready = world.run_until(lambda: row_2(world).startswith("READY"), READY_MS + noise_ms)
    assert ready and not world.restarts, (noise_ms, world.lcd(), world.restarts)


def test_noise_while_the_panel_starts_keeps_it_waiting_no_longer_than_it_lasts():
    for ms in (120, 180, 210, 240, 270, 400):
        gets_ready(PicoWorld("panel", parameters=QUICK), ms)


def test_noise_after_a_reset_is_not_another_master_for_ever():
    """As `tools/panel` does it: wait 3000 / reset / babble 400."""
    world = panel()
    world.reset()
    noise(world, 400)
    world.run(1_000)
    assert says(world, "READY"), world.lcd()
    assert world.reset_causes == ["reset"]


def test_noise_at_a_high_rate_fills_the_receiver_many_times_over():
    for ms in (200, 300, 1_000):
        gets_ready(PicoWorld("panel", baud=115200, parameters=QUICK), ms)


def test_noise_while_a_long_list_is_being_set_up_hangs_nothing():
    """Nobody takes characters from when the UART is opened until the bus is at work."""
    for ms in (300, 400):
        settings = {"drives": list(range(1, 32))}
        gets_ready(PicoWorld("panel", baud=115200, settings=settings, parameters=QUICK), ms)


def test_noise_while_a_motor_runs_costs_no_more_than_the_contact():
    for baud in (19200, 115200):
        world = running(baud=baud)
        noise(world, 500)
        world.run(600)
        assert says(world, "RUNNING", 500), world.lcd()
        world.press("STOP")
        assert stands(world) and not world.restarts, (baud, world.drives[1].report())


HANGS = b"""
import board
def make_link(baud):
    while True:
        pass
if not board.reset_cause:
    board.make_link = make_link
"""


def test_a_panel_that_hangs_before_it_has_started_restarts_the_chip():
    world = PicoWorld("panel", files={"boot.py": HANGS}, parameters=QUICK)
    assert world.run_until(lambda: world.restarts, 3_000)
    assert world.reset_causes == ["watchdog"]
    assert says(world, "WATCHDOG") and says(world, "READY", 5_000), world.lcd()
