# SPDX-License-Identifier: MIT
"""The log on the chip: a PC that reads, one that has the port open and reads nothing, and one that
talks."""

import json

from pico_bench import running, says, stands, starts, stops

INTERPRETERS = "pico"

LOG = {"log": "JSON"}
READS, READS_NOTHING = 0, 2  # of the record S


def lines(world):
    read = []
    for line in bytes(world.usb).split(b"\r\n")[1:-1]:
        try:
            read.append(json.loads(line))
        except ValueError:
            read.append(None)
    return read


def test_every_second_there_is_a_line():
    world = running(settings=LOG)
    world.usb = bytearray()
    world.run(5_000)
    read = lines(world)
    assert len(read) >= 3 and None not in read, bytes(world.usb)
    assert read[-1]["drives"][0]["state"] == "RUNNING" and not read[-1]["panel"]["dropped"]
    world.check()


def test_a_port_that_is_open_and_never_read_holds_nobody_up():
    world = running(settings=LOG)
    world.tell("S", READS_NOTHING)
    shown = set()
    for _ in range(50):
        world.run(200)
        shown.add(world.lcd()[1].rstrip())
    assert shown == {"RUNNING      A1"}, shown
    assert world.drives[1].state == "running" and starts(world) == 1 and not world.resets
    pressed_us = world.clock.now_us
    world.press("STOP")
    assert stops(world, pressed_us)[0] - pressed_us < 100_000
    world.usb = bytearray()
    world.tell("S", READS)
    world.run(4_000)
    last = lines(world)[-1]
    assert last["panel"]["dropped"] >= 7 and last["bus"]["hung"] == 0, last
    world.check()


def test_ctrl_c_ends_nothing_and_one_line_ends_it():
    world = running(settings=LOG)
    world.repl.write(b"\x03\x03\r\x03\x02" + 600 * b"x")
    world.run(3_000)
    assert says(world, "RUNNING") and world.drives[1].state == "running"
    world.repl.write(b"\r# end panel\r")
    assert stands(world) and b"USS panel: stopped" in world.usb
    world.repl.open()
    assert world.repl.execute("print(6 * 7)") == ("42\r\n", "")
    assert not world.resets
