# SPDX-License-Identifier: MIT
"""The panel as files on plain MicroPython, as tools/deploy leaves it: it lies in the chip's file
system and runs from its memory. How it gets there: test_pico_deploy_stock.py."""

from boards.sim.ports.chips import HEAP_BYTES
from panel.menu.main import LISTS
from pico_bench import deployed, says, stands, start, starts

INTERPRETERS = "pico"

BOOT_MS = 15_000
ALL = tuple(range(1, 32))
TAP_MS, READ_MS, HOLD_MS, LIST_MS = 140, 150, 1_300, 400
DEPTH_MAX = 6  # lists, one in the other
LEARN_MS = 31_000  # for 31 drives to tell what they are
TELL_MS = 2_000
TELLS = b"""
import gc
from machine import Timer
def tell(_):
    gc.collect()
    print("TAKEN", gc.mem_alloc(), "FREE", gc.mem_free(), "END")
timer = Timer(period=%d, mode=Timer.PERIODIC, callback=tell)
""" % TELL_MS  # fmt: skip
FREE_BYTES = 36 * 1024
# Of an ESP32, where the bytecode takes as much: boards/esp32/README.md says which ones will do.
ESP32_FREE_BYTES = 40 * 1024
WILL_DO = ("ESP32-S3", "ESP32 with PSRAM")


made = []  # the world of a panel as files, which takes a while


def panel_as_files():
    if not made:
        world = deployed(addresses=(1, 2))
        assert says(world, "READY", BOOT_MS), world.lcd()
        made.append(world)
    return made[0]


def test_a_panel_that_was_deployed_runs_its_drive_and_stops_it():
    world = panel_as_files()
    start(world)
    assert says(world, "F: 10.00")
    world.press("STOP")
    assert stands(world) and says(world, "READY") and starts(world) == 1
    assert not world.restarts
    world.check()


def test_all_of_the_menu_is_read_and_it_still_opens():
    """MicroPython keeps every name that a module brings: all of them have to fit."""
    world = panel_as_files()
    for place in range(1, len(LISTS) + 1):
        go_to_menu(world)
        walk_to(world, "MENU %d/%d >" % (place, len(LISTS)))
        for _ in range(2):
            world.press("SET", TAP_MS)
            assert not says(world, "NO MEMORY", LIST_MS), world.lcd()
        assert not world.reads("MENU"), world.lcd()
    leave(world)
    open_menu(world)
    assert not world.restarts
    world.check()


def tap(world, key):
    """As a person does who sees what comes of it."""
    world.press(key, TAP_MS)
    world.run(READ_MS)


def open_menu(world):
    world.press("PARAM", HOLD_MS)
    assert says(world, "MENU"), world.lcd()


def go_to_menu(world):
    """Back to its first list, or by way of the home page where that is nearer."""
    for _ in range(DEPTH_MAX):
        if world.reads("MENU"):
            return
        if world.reads("S:"):
            open_menu(world)
            return
        tap(world, "PARAM")
    raise AssertionError(world.lcd())


def walk_to(world, heading):
    world.run(READ_MS)
    for _ in LISTS:
        if world.reads(heading):
            return
        tap(world, "DOWN")
    raise AssertionError(world.lcd())


def leave(world):
    for _ in range(DEPTH_MAX):
        if world.reads("S:"):
            return
        tap(world, "PARAM")
    raise AssertionError(world.lcd())


def test_with_31_drives_there_is_memory_left_here_and_on_the_esp32s_that_the_manual_names():
    world = deployed({"boot.py": TELLS}, addresses=ALL)
    made.clear()
    assert says(world, "READY", BOOT_MS)
    world.run(LEARN_MS)
    world.usb[:] = b""
    assert world.run_until(lambda: b"END" in world.usb, 2 * TELL_MS)
    told = bytes(world.usb).split()
    taken, free = (int(told[told.index(word) + 1]) for word in (b"TAKEN", b"FREE"))
    assert free >= FREE_BYTES, free
    for chip, heap in HEAP_BYTES.items():
        assert (heap - taken >= ESP32_FREE_BYTES) == (chip in WILL_DO), (chip, heap - taken)
    world.check()
