# SPDX-License-Identifier: MIT
"""Where the port's timers have hard callbacks, the panel takes those: no collection of its memory
holds up a telegram."""

from pico_bench import scripted, set_off
from tools.emulator.world import PicoWorld

INTERPRETERS = "pico_hard"

STEPS = "while True:\n    app.step()\n    %s"
TELEGRAMS = 15
# How much later a telegram goes than without a collection. With soft callbacks it is 0.8 ms and
# more.
LATER_NS = 250_000

# On the chip: how long it takes to set the timer ten times, if a collection begins as soon as
# anything has taken memory.
SETS = """
import gc, time
from chips import rp2
def set(timer):
    gc.collect()
    gc.threshold(16)
    began = time.ticks_us()
    for _ in range(10):
        timer.init(mode=timer.ONE_SHOT, period=1_000_000, tick_hz=1_000_000, callback=print)
    lasted = time.ticks_diff(time.ticks_us(), began)
    gc.threshold(-1)
    timer.deinit()
    return lasted
print(set(rp2.make_timer()))
"""
SET_US = 2_000


def longest_pause_ns(statement):
    """From telegram to telegram, if the drive is silent and so the timer alone sends, and the main
    loop does `statement` after each step."""
    world = scripted(STEPS % statement)
    set_off(world)
    world.drives[1].unplug()
    world.run(100)
    world.figures.clear()
    world.run(600)
    sent = [at_ns for at_ns, on in world.figures.driver if on]
    between = [after - before for before, after in zip(sent, sent[1:])]
    assert len(between) >= TELEGRAMS, between
    return max(between)


def test_a_collection_of_memory_does_not_make_the_bus_wait():
    undisturbed_ns = longest_pause_ns("pass")
    for collect in ("gc.collect()", "bytearray(5000)"):
        later_ns = longest_pause_ns(collect) - undisturbed_ns
        assert later_ns <= LATER_NS, (collect, later_ns)


def test_to_set_the_timer_takes_no_memory():
    world = PicoWorld("panel", addresses=(), files={"boot.py": b"import time; time.sleep_ms(200)"})
    world.down("DOWN")  # held at power-on: no panel
    world.run(1_000)
    world.repl.open()
    lasted_us, error = world.repl.execute(SETS)
    assert not error and int(lasted_us) <= SET_US, (lasted_us, error)
