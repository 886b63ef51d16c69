# SPDX-License-Identifier: MIT
"""What the panel keeps in the chip's flash survives resets, and power that goes while it is
written: either the old settings are there afterwards or the new ones, and the panel starts."""

import os
import struct

from pico_bench import panel, running, says, scripted, set_off, stands, starts
from tools.emulator.flash_image import FILES_AT
from tools.emulator.world import PROGRAMS, PicoWorld, program_path, temporary

INTERPRETERS = "pico pico_hard_again"

# At SET the panel has something to save: drive 2 is accepted as it is.
ACCEPT = "app.settings.accept_unsupervised(2)\nwhile True:\n    app.step()"
SAVING_MS = 1_500
# At SET it saves another setpoint each second; that erases sectors as well.
SAVE_OFTEN = """
for _ in range(4):
    app.settings.setpoint_centihertz += 10
    app.settings.dirty = True
    began = time.ticks_ms()
    while time.ticks_diff(time.ticks_ms(), began) < 1_000:
        app.step()
while True:
    app.step()
"""
FLASH_AT = 0x1000_0000  # in the RP2040's memory
CUTS = 4  # instants at which power goes, spread over the flash operations of one saving


def accepting(world):
    """Set the saving off; the drives `unsupervised` before and after it."""
    set_off(world)
    return [], [2]


def saving(**options):
    return scripted(ACCEPT, motor_on=False, addresses=(1, 2), **options)


def test_what_is_saved_is_there_after_a_reset():
    world = saving()
    before, after = accepting(world)
    world.run(SAVING_MS)
    assert before != after and world.settings()["unsupervised"] == after
    assert world.flash_log
    world.reset()
    assert says(world, "READY") and world.settings()["unsupervised"] == after
    world.check()


def test_a_flash_as_slow_as_its_data_sheet_allows_does_not_restart_the_panel():
    world = scripted(SAVE_OFTEN, motor_on=False, model={"flash_times": "maximum"})
    set_off(world)
    world.run(6_000)
    assert world.settings()["setpoint_centihertz"] == 1_000 + 4 * 10
    assert max(lasts_us for _, _, lasts_us in world.flash_log) == 400_000
    assert not world.restarts and says(world, "READY")
    world.check()


def test_what_was_stored_by_somebody_else_is_kept():
    world = panel(settings={"second_stop": "OFF2", "of_a_newer_firmware": [1, 2]})
    assert world.settings()["second_stop"] == "OFF2"
    assert world.settings()["of_a_newer_firmware"] == [1, 2]


def test_another_firmware_file_leaves_the_settings_where_they_are():
    """What a UF2 file writes ends before the files begin: block after block of 512 bytes."""
    for name in PROGRAMS:
        ends = 0
        with open(program_path(name), "rb") as file:
            while True:
                block = file.read(512)
                if not block:
                    break
                assert block[:4] == b"UF2\n", name
                at, size = struct.unpack("<II", block[12:20])
                ends = max(ends, at + size - FLASH_AT)
        assert 300_000 < ends <= FILES_AT, (name, ends)


def test_power_that_goes_while_settings_are_written_leaves_the_old_ones_or_the_new_ones():
    world = saving()
    before, after = accepting(world)
    world.run(SAVING_MS)
    operations = world.flash_log
    began_us = world.led[-1][0]
    assert operations and operations[0][0] > began_us
    kept = []
    for cut in range(CUTS):
        at_us, _, lasts_us = operations[cut * len(operations) // CUTS]
        world = saving()
        world.cut_power(at_us + lasts_us * (1 + cut % 3) // 4)
        accepting(world)
        assert world.led[-1][0] == began_us  # the same again, so that the cut hits
        assert says(world, "EMERGENCY STOP") and world.reset_causes == ["power"]
        assert says(world, "READY", 5_000), world.lcd()
        assert not world.reads("DAMAGED")
        kept.append(world.settings().get("unsupervised", []))
        assert kept[-1] in (before, after)
        world.check()
    assert before in kept, kept  # the first cut comes before anything is written
    assert kept == sorted(kept, key=len), kept  # once it is written it stays


def test_a_panel_that_saves_spoils_no_telegram():
    world = saving()
    good = [drive.report() for drive in world.drives.values()]
    accepting(world)
    world.run(SAVING_MS)
    assert world.flash_log
    for drive, before in zip(world.drives.values(), good):
        assert " rejected=0 " in drive.report() and drive.report() != before
    assert min(world.figures.release_ns) >= 0
    world.check()


def test_nothing_is_written_while_a_drive_runs():
    world = scripted(ACCEPT, addresses=(1, 2))
    accepting(world)
    world.run(SAVING_MS)
    assert world.drives[1].state == "running" and not world.flash_log
    world.press("STOP")
    assert stands(world)
    world.run(SAVING_MS)
    assert world.flash_log and world.settings()["unsupervised"] == [2]
    world.check()


def test_settings_that_are_no_settings_do_not_keep_the_panel_from_starting():
    world = PicoWorld("panel", files={"settings.json": b"{nonsense"})
    assert says(world, "DAMAGED", 5_000)
    assert says(world, "FILE IS NO JSON", 5_000)
    assert says(world, "READY", 5_000) and starts(world) == 0
    world.check()


def test_a_panel_on_an_erased_flash_starts_with_its_defaults():
    world = PicoWorld("panel", files={"settings.json": b""})
    assert says(world, "FILE IS NO JSON", 6_000)
    assert says(world, "READY", 5_000)
    world.check()


def test_a_flash_that_is_kept_from_run_to_run_keeps_the_settings():
    world = running(settings={"setpoint_centihertz": 1000, "second_stop": "none"})
    image = temporary()
    world.save_flash(image)
    try:
        again = panel(flash=image)
    finally:
        os.remove(image)
    assert again.settings()["second_stop"] == "none" and starts(again) == 0
    again.check()
