# SPDX-License-Identifier: MIT
"""The log: a line of JSON a second for a PC that listens, which no motor and no key waits for."""

import json

from panel_bench import OFF1, panel, row_1, row_2, running, starts, telegrams

LOG = {"log": "JSON"}
MANUAL = "firmware/panel/README.md"


def lines(world):
    """What the PC has read, line by line; what is no JSON is None."""
    read = []
    for line in bytes(world.usb.heard).split(b"\r\n")[:-1]:
        try:
            read.append(json.loads(line))
        except ValueError:
            read.append(None)
    return read


def test_every_second_there_is_a_line_of_json():
    world = running(addresses=(1, 2), settings=LOG)
    world.usb.heard = bytearray()
    world.run(10_000)
    read = lines(world)
    assert None not in read[1:] and 9 <= len(read) <= 11, read
    last = read[-1]
    one, two = last["drives"]
    assert (one["address"], one["state"], one["on"], one["actual"]) == (1, "RUNNING", True, 1000)
    assert (two["address"], two["state"], two["on"]) == (2, "READY", False)
    assert last["bus"]["state"] == "on" and 40 < last["bus"]["exchanges"] < 50, last["bus"]
    assert last["panel"]["dropped"] == 0 and last["panel"]["shown"] == 1
    world.check()


def keys_of(line):
    """The names of what a line tells: of the panel, the bus and its first drive."""
    return {"panel": line["panel"], "bus": line["bus"], "drives": line["drives"][0]}


def documented():
    """The same, as the manual's table has them: {"panel": names ...}."""
    with open(MANUAL) as file:
        section = file.read().split("\n## The log\n")[1].split("\n## ")[0]
    told = {}
    for row in section.split("\n"):
        cells = [cell.strip() for cell in row.split("|")]
        if len(cells) > 3 and cells[1][:1] == "`":
            told.setdefault(cells[1].strip("`"), []).append(cells[2].strip("`"))
    return told


def test_the_manual_has_a_row_for_each_field_and_no_other():
    world = running(settings=LOG)
    fields = keys_of(lines(world)[-1])
    told = documented()
    assert sorted(told) == sorted(fields)
    for name, values in fields.items():
        assert sorted(told[name]) == sorted(values), name


def test_a_drive_that_does_not_answer_has_no_words():
    world = panel(settings=LOG)
    world.drives[1].unplug()
    world.run(4000)
    drive = lines(world)[-1]["drives"][0]
    assert drive["state"] == "NO CONTACT" and drive["zsw"] is None and drive["hiw"] is None
    assert drive["missed"] >= 3 and drive["silent"] >= 3 and drive["actual"] is None
    world.check()


def test_it_is_off_until_somebody_switches_it_on_in_the_settings_and_acts_at_once():
    world = running()
    world.run(3000)
    assert not world.usb.heard
    walk_to_the_log(world)
    world.press("SET")
    world.press("UP")
    world.press("SET")
    assert world.reads("KEPT"), world.lcd()
    world.run(3000)
    assert len(lines(world)) >= 2 and world.drives[1].state == "running"
    world.press("SET")
    world.press("DOWN")
    world.press("SET")
    world.run(200)
    before = len(world.usb.heard)
    world.run(3000)
    assert len(world.usb.heard) == before
    world.check()


def walk_to_the_log(world):
    world.press("PARAM", 1200)
    for entry in ("SETTINGS", "LOG "):
        for _ in range(30):
            world.run(200)
            if row_2(world).startswith(">" + entry):
                break
            world.press("DOWN")
        assert row_2(world).startswith(">" + entry), world.lcd()
        if entry == "SETTINGS":
            world.press("SET")


def test_a_board_without_a_serial_port_has_no_log_whatever_its_settings_say():
    """They may have come from another board."""
    world = panel()
    world.app.board.serial = None
    world.app.settings.change("log", "JSON")
    world.run(1000)
    assert world.app.settings.log == "none" and row_2(world) == "READY        A1", world.lcd()
    world.check()


def test_a_port_that_is_open_and_never_read_holds_nobody_up():
    world = running(settings=LOG)
    world.usb.is_read = False
    before = world.app.bus.dead_man_trips
    world.run(60_000)
    assert world.drives[1].state == "running" and row_2(world) == "RUNNING      A1"
    assert world.usb.waits == 0 and world.app.bus.dead_man_trips == before
    world.press("STOP")
    assert [stw for _, stw in telegrams(world, world.clock.now_us - 200_000) if stw == OFF1]
    world.usb.heard = bytearray()
    world.usb.is_read = True
    world.run(5_000)
    read = lines(world)
    assert None not in read[2:], read  # the rest of the line that was torn is one of its own
    assert read[-1]["panel"]["dropped"] >= 55 and starts(world) == 1
    world.check()


def test_nothing_that_a_logger_sends_ends_the_panel():
    world = running(settings=LOG)
    for typed in (
        b"\x03",
        b"\x03\x03\x02\x04\x01",
        b"# end panel",
        b" # end panels\r",
        b"x" * 3000,
    ):
        world.usb.type(typed)
        world.run(2000)
    assert not world.usb.ends and world.drives[1].state == "running"
    world.run(60_000)  # a character in a step that has time
    assert not world.usb.read(1) and row_1(world)[:2] == "S:"
    world.check()


def test_one_line_ends_it_as_ctrl_c_does_and_the_drives_are_stopped():
    world = running(settings=LOG)
    world.usb.type(b"\x03 # end\r# end panel\n")
    try:
        world.run(5000)
    except KeyboardInterrupt:
        world.close()
    else:
        raise AssertionError("the panel goes on")
    assert world.app.bus.turns.drives[0].answered_off()


def test_without_the_log_ctrl_c_ends_the_panel_as_ever():
    world = running()
    world.usb.type(b"\x03")
    assert world.usb.ends == 1


def test_while_the_search_has_the_line_ctrl_c_ends_nothing_either():
    world = panel(settings=LOG)
    world.app.panel.wants = "search"
    world.run(1000)
    assert "FIND DRIVES" in row_1(world), world.lcd()
    world.usb.type(b"\x03# end panel\r")
    try:
        world.run(3000)
    except KeyboardInterrupt:
        assert not world.usb.ends
    else:
        raise AssertionError("nobody hears it")


def test_31_drives_have_a_line_each_second():
    world = panel(addresses=list(range(31)), settings=LOG)
    world.run(3000)
    world.usb.heard = bytearray()
    world.run(10_000)
    read = lines(world)[1:]
    assert len(read) >= 8 and None not in read
    assert [drive["address"] for drive in read[-1]["drives"]] == list(range(31))
    world.check()
