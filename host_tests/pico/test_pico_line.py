# SPDX-License-Identifier: MIT
"""The rules of the RS-485 line on the chip, at every usual baud rate and while the panel has
other things to do: collections, the display, saving. Figures are nanoseconds of its clock."""

from pico_bench import running, says, scripted, set_off, stands, start
from tools.emulator.world import PicoWorld

INTERPRETERS = "pico pico_hard_again"

RATES = (2_400, 9_600, 19_200, 38_400, 57_600, 115_200)
TELEGRAMS = 40
AT_ONCE_NS = 400_000  # after the start interval
TELEGRAM_NS = 16 * 11_000_000_000 // 19_200  # of the panel, uncut

# What a panel may be busy with: lines that take the place of the main loop.
BUSY = {
    "collections": "while True:\n    app.step()\n    gc.collect()",
    "garbage": "while True:\n    app.step()\n    bytearray(5000)",
    "display": "while True:\n    app.step()\n"
    "    app.panel.screen.put(0, 0, 16, b'%016d' % app.bus.progress)",
    "slow": "while True:\n    app.step()\n    time.sleep_ms(150)",
}


def character_ns(baud):
    return 11_000_000_000 // baud


def judge(world):
    """The rules of DE and of the start interval, by the chip's clock."""
    figures = world.figures
    one = character_ns(world.wire.baud)
    assert len(figures.release_ns) >= TELEGRAMS, len(figures.release_ns)
    assert 0 <= min(figures.release_ns) and max(figures.release_ns) <= one
    assert 0 <= min(figures.lead_ns) and max(figures.lead_ns) <= one
    assert min(figures.idle_ns) >= 2 * one - 1_000
    world.check()


def enough(world, ms=60_000):
    assert world.run_until(lambda: len(world.figures.release_ns) >= TELEGRAMS, ms)


def test_the_driver_is_on_from_just_before_a_telegram_until_just_after_it():
    for baud in RATES:
        world = PicoWorld("panel", baud=baud)
        enough(world)
        judge(world)


def test_whatever_the_panel_is_busy_with():
    for busy in BUSY.values():
        world = scripted(busy)
        set_off(world)
        world.figures.clear()
        enough(world)
        judge(world)


def test_the_next_telegram_follows_a_reply_at_once():
    """The interrupt that tells of a reply sends what is ready. The engine would take 1 ms."""
    world = running(baud=115_200)
    world.figures.clear()
    enough(world)
    judge(world)
    late_ns = sorted([ns - 2 * character_ns(115_200) for ns in world.figures.idle_ns])
    assert late_ns[len(late_ns) * 9 // 10] < AT_ONCE_NS, late_ns


def test_while_it_saves_its_settings():
    world = scripted(
        "app.settings.accept_unsupervised(2)\nwhile True:\n    app.step()",
        motor_on=False,
        addresses=(1, 2),
        baud=115_200,
    )
    world.figures.clear()
    set_off(world)
    world.run(1_000)
    assert world.flash_log
    judge(world)


def test_with_drives_that_answer_each_in_its_own_time():
    world = PicoWorld("panel", addresses=(1, 2, 3), seed=7)
    world.run(1_500)
    start(world)
    world.press("STOP")
    assert stands(world)
    judge(world)


def test_a_chip_that_resets_in_the_middle_of_a_telegram_lets_go_of_the_line():
    cut = 0
    world = PicoWorld("panel")
    for offset_ms in range(0, 24, 4):
        assert says(world, "READY"), world.lcd()
        world.run(offset_ms)
        effective_us = world.clock.now_us + 1_000  # of the reset, at the latest
        world.reset()
        world.run(100)
        (on_ns, was_on), (off_ns, is_on) = world.figures.driver[-2:]
        assert was_on and not is_on and off_ns // 1000 < effective_us, world.figures.driver[-4:]
        cut += off_ns - on_ns < TELEGRAM_NS
        assert says(world, "NO EMERGENCY STOP") and not world.reads("READY")
    assert says(world, "READY")
    world.check()
    assert cut  # or nothing was tried
