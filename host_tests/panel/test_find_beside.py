# SPDX-License-Identifier: MIT
"""The operator's manual: further drives are found at the rate of the panel, beside its own."""

import json
import sys

import on_demand
from boards.sim.drives.kinds import listed_drives, simulated
from panel import texts
from panel.menu import beside
from panel_bench import (
    comes_to,
    press,
    row_1,
    row_2,
    settled,
    starts,
    switched_on,
    telegrams,
    wait_until_known,
)
from uss.families import MM440
from uss.layout import Layout

OFF1 = 0x047E


def line_of(text, drives, **more):
    """A panel with these drives, on a line with more."""
    listed = listed_drives(text)
    addresses = [one.address for one in listed]
    world = switched_on(
        addresses, settings={"drives": list(drives)}, kinds=simulated(listed), **more
    )
    world.run(3000)
    return world


def title(world):
    """Row 1, which has to say now and then that a motor runs."""
    while "HOLD" in settled(world)[0]:
        pass
    return row_1(world)


def opened(world):
    """PARAM held, FIND DRIVES, AT THIS RATE."""
    world.down("PARAM")
    world.run(1500)
    world.up("PARAM")
    world.run(300)
    for wanted in (">FIND DRIVES", ">AT THIS RATE"):
        while row_2(world) != wanted:
            press(world, "DOWN")
        press(world, "SET")
    assert (title(world), row_2(world)) == ("STOPS FOUND     ", ">SET=BEGIN"), world.lcd()


def searched(world):
    """Begin, and wait for the end. How long that takes, in ms."""
    began_us = world.clock.now_us
    press(world, "SET")
    percents = []
    while title(world).startswith("SEARCH "):
        percents.append(int(row_1(world)[7:].split("%")[0]))
        world.run(100)
    assert percents == sorted(percents), percents
    assert percents[0] < 10 and 90 < percents[-1] <= 100, percents
    return (world.clock.now_us - began_us) // 1000


def entries(world):
    """What was found: (row 1 without the place, row 2)."""
    found = []
    while True:
        press(world, "DOWN")
        if title(world).startswith("FOUND"):
            return found
        found.append((title(world)[:11].strip(), row_2(world)[1:]))


def stored(world):
    return json.loads(world.flash.files["settings.json"].decode())


def test_drives_are_found_beside_a_motor_that_runs_and_taken_one_by_one_or_all():
    world = line_of("1,3=g110,7=v20/4,9=mm440,12=mm3", (1,))
    wait_until_known(world)
    press(world, "START")
    world.run(4000)
    opened(world)
    assert searched(world) < 60_000
    found = [
        ("A3 READY", "G110 127+2"),
        ("A7 READY", "V20 4+2"),
        ("A9 READY", "MM420 4+2"),
        ("A12 READY", "MM3 3+2"),
    ]
    assert entries(world) == found
    press(world, "DOWN", "DOWN", "SET")  # the second one
    assert row_2(world) == "A7 ADDED", world.lcd()  # row 1 has the next one by now
    world.run(3000)
    del found[1]
    assert title(world).startswith("A9 READY"), world.lcd()
    while not title(world).startswith("FOUND"):
        press(world, "DOWN")
    assert row_2(world) == ">TAKE ALL 3", world.lcd()
    assert entries(world) == found
    press(world, "SET")
    assert "3 ADDED" in world.lcd()[1], world.lcd()
    world.run(4000)
    assert row_2(world) == "RUNNING      A1" and world.drives[1].state == "running", world.lcd()
    assert [drive.state for drive in world.drives.values()].count("ready") == 4
    for address in (7, 3, 9, 12):
        press(world, "ADDRESS_UP")
        world.run(3000)
        assert world.app.panel.selected.drive.address == address
        press(world, "START")
        world.run(4000)
        assert world.drives[address].state == "running", world.lcd()
    press(world, "ADDRESS_UP")
    assert starts(world) == 1
    world.down("STOP")
    world.run(4500)
    world.up("STOP")
    world.run(8000)
    assert stored(world)["drives"] == [1, 7, 3, 9, 12]
    assert stored(world)["kinds"] == {"3": "g110", "7": "v20/4", "12": "mm3"}
    world.check()


def test_stop_is_stop_and_ends_the_search():
    world = line_of("1,3=g110,20", (1,))
    wait_until_known(world)
    press(world, "START")
    world.run(4000)
    for wait_ms in (400, 2500, 7000):
        opened(world)
        press(world, "SET")
        world.run(wait_ms)
        pressed_us = world.clock.now_us
        press(world, "STOP")
        offs = [at_us for at_us, stw in telegrams(world, pressed_us, 1) if stw == OFF1]
        assert offs and offs[0] - pressed_us < 100_000, wait_ms
        world.run(6000)
        assert world.drives[1].hz() == 0 and not title(world).startswith("SEARCH"), world.lcd()
        press(world, "PARAM", "PARAM", "PARAM")
        wait_until_known(world)
        press(world, "START")
        world.run(4000)
        assert world.drives[1].state == "running"
    world.check()


def test_it_asks_nobody_before_set_and_stops_whom_it_finds():
    world = line_of("1,3=g110", (1,))
    other = world.drives[3]
    other.write(2014, 0, 0)
    for stw in (0x047E, 0x047F):
        other.process.accept((stw, 0x1000))
    opened(world)
    world.run(5000)
    assert other.state == "running"
    searched(world)
    world.run(4000)
    assert other.hz() == 0 and entries(world) == [("A3 RUNS", "G110 127+2")]
    world.check()


def test_what_is_not_taken_does_not_trip_while_the_list_is_shown():
    world = line_of("1,3=v20,5", (1,))
    opened(world)
    searched(world)
    world.run(20_000)
    states = [world.drives[address].state for address in (3, 5)]
    assert states == ["ready", "ready"], states
    press(world, "SET")
    world.run(4000)
    press(world, "ADDRESS_UP")
    wait_until_known(world)
    world.check()


def test_set_on_the_first_entry_takes_nobody_before_the_search_is_over():
    """Neither before one is found nor after that."""
    world = line_of("1,3=g110", (1,))
    opened(world)
    press(world, "SET", "SET")
    assert row_2(world) == ">0 FOUND", world.lcd()
    assert comes_to(world, ">1 FOUND"), world.lcd()
    press(world, "SET")
    assert title(world).startswith("SEARCH ") and row_2(world) == ">1 FOUND", world.lcd()
    assert [drive.address for drive in world.app.bus.turns.drives] == [1]
    world.check()


def test_a_search_that_takes_longer_than_a_minute_goes_on_without_a_key():
    world = line_of("1", (1,), baud=2400)
    opened(world)
    press(world, "SET")
    world.run(65_000)
    assert title(world).startswith("SEARCH ") and row_2(world) == ">0 FOUND", world.lcd()
    world.check()


def test_the_last_of_three_that_were_found_is_taken_alone():
    world = line_of("1,3=g110,5,6=mm3", (1,))
    opened(world)
    searched(world)
    press(world, "UP")
    assert title(world).startswith("A6 READY"), world.lcd()
    press(world, "SET")
    assert row_2(world) == "A6 ADDED", world.lcd()
    assert [drive.address for drive in world.app.bus.turns.drives] == [1, 6]
    world.check()


def test_the_first_one_for_which_there_is_no_room_is_named():
    """A panel has 31 drives at the most; while the others were looked for, 28 have come."""
    world = line_of("1,3=g110,5", (1,))
    opened(world)
    searched(world)
    for address in range(32):
        if address not in (1, 3, 5, 31):
            world.app.settings.add(address, "mm420")
    assert row_2(world) == ">TAKE ALL 2", world.lcd()
    world.app.settings.add(31, "mm420")
    press(world, "SET")
    assert row_2(world) == "A5 NOT ADDED", world.lcd()
    drives = [drive.address for drive in world.app.bus.turns.drives]
    assert drives == [1, 3] and world.app.settings.drives[-1] == 3, drives
    world.run(4000)
    assert row_2(world) == "READY        A1", world.lcd()
    world.check()


def test_where_nobody_else_is_it_says_so_and_a_minute_without_a_key_closes_it():
    world = line_of("1,2", (1, 2), baud=9600)
    opened(world)
    assert 20_000 < searched(world) < 60_000
    assert row_2(world) == ">NOBODY", world.lcd()
    press(world, "SET")
    assert row_2(world) == ">NOBODY", world.lcd()
    world.run(62_000)
    assert row_2(world) == "READY        A1", world.lcd()
    world.check()


# --- the list by itself --------------------------------------------------------------------------


class Node:
    """What was found at an address."""

    family = MM440

    def __init__(self, zsw=0xFB31, layout=MM440.layout):
        self.zsw, self.layout = zsw, layout


class Scan:
    """Looks for drives as far as it is told; it notes when."""

    over, percent = False, 0

    def __init__(self, bus, mask):
        bus.scan = self
        self.mask = mask
        self.nodes, self.stepped, self.kept = [], [], []

    def progress(self, whole):
        assert whole == 100
        return self.percent

    def asked_nodes(self):
        return self.nodes

    def step(self, now_us):
        self.stepped.append(now_us)

    def keep(self, now_us):
        self.kept.append(now_us)


class Told:
    """A panel with drive 3, and room for some more."""

    def __init__(self, room=9):
        self.bus = self.turns = self
        self.selected = "A3"
        self.room = room
        self.did = []

    def at(self, address):
        return self if address == 3 else None

    def say(self, now_ms, text, *values):
        self.did.append(texts.of(text, *values))

    def add(self, address, kind):
        if not self.room:
            raise ValueError
        self.room -= 1
        self.selected = "another"
        self.did.append((address, kind))

    def show(self, control):
        self.did.append(control)

    def close_menu(self):
        self.did.append("closed")


class FindModule:
    """Where the scan stands."""

    Scan = Scan


def begun(**told):
    panel = Told(**told)
    shown = beside.List(panel, None)
    sys.modules["uss.finding.scan"] = FindModule
    shown.choose(0, 0)
    sys.modules.pop("uss.finding.scan", None)
    return panel, shown, panel.scan


def test_a_search_is_shown_from_its_question_to_the_drives_that_are_new():
    panel = Told()
    shown = beside.List(panel, None)
    shown.step(0, 5)
    assert (shown.heading(0), shown.words(0), shown.count()) == (b"STOPS FOUND", b"SET=BEGIN", 1)
    assert not shown.is_busy() and panel.did == []
    panel, shown, scan = begun()
    assert shown.is_busy() and scan.mask == 0x3FFFFFF
    for percent, row in ((0, b"SEARCH 0%"), (41, b"SEARCH 41%"), (100, b"SEARCH 100%")):
        scan.percent = percent
        assert (shown.heading(0), shown.words(0), shown.count()) == (row, b"0 FOUND", 1)
    scan.nodes = [(3, Node()), (7, Node()), (9, Node(0xFB34, Layout(127, 6)))]
    assert (shown.words(0), shown.count()) == (b"2 FOUND", 3)  # drive 3 was there already
    rows = [(shown.heading(at), shown.words(at)) for at in (1, 2)]
    assert rows == [(b"A7 READY", b"MM440 4+2"), (b"A9 RUNS", b"MM440 127+6")], rows
    scan.over = True
    assert (shown.heading(0), shown.words(0)) == (b"FOUND", b"TAKE ALL 2") and not shown.is_busy()
    scan.nodes = scan.nodes[:1]
    assert (shown.heading(0), shown.words(0), shown.count()) == (b"FOUND", b"NOBODY", 1)
    shown.choose(0, 0)
    assert panel.did == []


def test_without_memory_for_a_search_it_says_so_and_can_be_begun_again():
    """What was loaded for it leaves the memory in any case."""

    class Full:
        @staticmethod
        def Scan(bus, mask):
            raise MemoryError

    panel = Told()
    shown = beside.List(panel, None)
    for module in (Full, FindModule):
        sys.modules["uss.finding.scan"] = module
        sys.modules["uss.finding.enquiry"] = module
        shown.choose(0, 0)
        on_demand.flush()  # where there is room, what was dropped leaves it later
        assert "uss.finding.scan" not in sys.modules
        assert "uss.finding.enquiry" not in sys.modules
        assert panel.did == [texts.NO_MEMORY]
        assert shown.is_busy() == (module is FindModule)
        assert (shown.words(0) == b"SET=BEGIN") == (module is Full)


def test_the_time_of_a_search_goes_on_when_the_clock_of_the_panel_begins_anew():
    _, shown, scan = begun()
    for now_ms in (1, 0xFFFF, 0x10000, 0x3FFFFFFF):
        shown.step(0, now_ms)
    assert scan.stepped == [0x400, 0x3FFFC00, 0, 0x3FFFC00] and scan.kept == []
    scan.over = True  # from now on whoever was found is kept from tripping
    shown.step(0, 2)
    assert scan.kept == [0x800] and len(scan.stepped) == 4


def test_set_takes_one_that_was_found_at_any_time_and_all_when_the_search_is_over():
    nodes = [(3, Node()), (7, Node()), (9, Node(layout=Layout(127, 6))), (11, Node())]
    added = [(7, "mm440"), (9, "mm440/127+6"), (11, "mm440")]
    for room, over, position, did in (
        (9, False, 0, []), (9, False, 2, [added[1], b"A9 ADDED", "A3"]),
        (9, True, 3, [added[2], b"A11 ADDED", "A3"]), (0, False, 1, [b"A7 NOT ADDED", "A3"]),
        (9, True, 0, added + [b"3 ADDED", "A3", "closed"]),
        (2, True, 0, added[:2] + [b"A11 NOT ADDED", "A3", "closed"]),
    ):  # fmt: skip
        panel, shown, scan = begun(room=room)
        scan.nodes, scan.over = nodes, over
        shown.choose(position, 0)
        assert panel.did == did, (room, over, position, panel.did)
