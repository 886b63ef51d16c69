# SPDX-License-Identifier: MIT
"""./tools/panel --board pico as a user calls it: what it prints, its status, what it keeps."""

import os

from tools.emulator.flash_image import FlashImage
from tools.emulator.world import temporary

INTERPRETERS = "pico"

START_AND_STOP = """\
wait 1500
press START
wait 3500
expect RUNNING
lcd
press STOP
wait 3000
drive 1
"""


def panel(arguments, script=""):
    """Exit status and what was printed, errors as well, of a panel that does this script."""
    given, printed = temporary(), temporary()
    with open(given, "w") as file:
        file.write(script)
    os.system(
        "{ ./tools/panel --board pico %s --script -; echo EXIT $?; } <%s >%s 2>&1"
        % (arguments, given, printed)
    )
    with open(printed) as file:
        said, _, status = file.read().rpartition("EXIT ")
    os.remove(given)
    os.remove(printed)
    return int(status), said


def test_a_script_runs_the_firmware_file_on_an_emulated_pico():
    status, said = panel("", START_AND_STOP)
    assert status == 0, said
    assert "|S: 10.0 F: 10.00|\n|RUNNING      A1 |\n" in said
    assert "\naddress=1 state=ready hz=0.00 " in said and "starts=1" in said
    assert "USB serial of the emulated Pico: /dev/" in said


def test_drives_rate_display_and_seed_are_those_asked_for():
    options = "--drives 3,4 --baud 9600 --display backpack --seed 2"
    status, said = panel(options, "wait 2000\nexpect READY        A3\n")
    assert status == 0, said


def test_the_flash_is_kept_from_one_run_to_the_next():
    flash = temporary()
    try:
        status, said = panel("--flash %s --drives 5 --baud 9600" % flash, "wait 1500\nlcd\n")
        assert status == 0 and "A5" in said, said
        assert b"9600" in FlashImage(flash).read("settings.json")
        status, said = panel("--flash " + flash, "wait 1500\nexpect READY        A5\n")
        assert status == 0, said
        status, said = panel("--flash %s --baud 19200" % flash)
        assert status == 2 and "--baud 19200: %s says 9600" % flash in said, said
    finally:
        os.remove(flash)


def test_a_file_that_is_no_flash_is_refused_and_left_as_it_is():
    path = temporary()
    with open(path, "w") as file:
        file.write("a letter")
    try:
        status, said = panel("--flash " + path)
        assert status == 2 and "is no image of the Pico's flash" in said, said
        with open(path) as file:
            assert file.read() == "a letter"
        with open(path, "wb") as file:
            for _ in range(2048):
                file.write(b"\x5a" * 1024)
        status, said = panel("--flash " + path)
        assert status == 2 and "holds no file system, or a damaged one" in said, said
        status, said = panel("--flash host_tests")
        assert status == 2 and "is no ordinary file" in said, said
        status, said = panel("--flash /proc/nowhere/flash")
        assert status == 2 and "cannot be kept" in said, said
    finally:
        os.remove(path)


def test_what_the_chip_cannot_do_is_refused():
    for options, why in (
        ("--polled", "--polled is not for --board pico"),
        ("--keys matrix", "--keys is not for --board pico"),
        ("--settings file", "--settings is not for --board pico"),
        ("--display none", "--display none: there are wires and backpack"),
    ):
        status, said = panel(options)
        assert status == 2 and why in said, said
    status, said = panel("", "hang 100\n")
    assert status == 2 and "standard input:1: nobody can hang" in said, said


def test_power_cut_and_reset_start_the_panel_anew_and_no_motor():
    for what in ("power cut", "reset"):
        script = "wait 1500\npress START\nwait 3000\n%s\nwait 5000\nexpect READY\ndrive 1\n" % what
        status, said = panel("", script)
        assert status == 0 and "state=ready" in said and "starts=1" in said, said
