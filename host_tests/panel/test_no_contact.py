# SPDX-License-Identifier: MIT
"""The operator's manual, NO CONTACT: PARAM held says what was heard, and what to check."""

import json

import main
from boards.sim.drives.families import generic
from boards.sim.world import World
from panel.menu import contact
from panel.menu.words import SETTINGS
from panel_bench import panel, press, row_1, row_2, settled, telegrams, wait_until_known
from spoilt_bench import TROUBLES, shorter, silent, spoil
from uss.drive import COUNTERS
from uss.families import GENERIC, MM440
from uss.receiver import NOISE, OTHER_ADDRESS, OTHER_LENGTH, SILENCE, WRONG_CHECK

OFF1 = 0x047E


def title(world):
    """Row 1, which has to say now and then that something may run."""
    while world.reads("A1 MAY RUN") or world.reads("NOT STOPPED"):
        settled(world)
    return settled(world)[0]


def why(world):
    """Hold PARAM, and SET: what was heard, and the steps."""
    world.down("PARAM")
    world.run(1500)
    world.up("PARAM")
    world.run(300)
    assert row_2(world) == ">WHY NO CONTACT", world.lcd()
    press(world, "SET")
    heard, steps = row_2(world)[1:], []
    count = int(title(world).split("/")[1])
    assert title(world).startswith("A1 HEARD"), world.lcd()
    press(world, "DOWN")
    assert " OK OF " in row_2(world), world.lcd()
    for _ in range(count - 2):
        press(world, "DOWN")
        assert title(world).startswith("CHECK"), world.lcd()
        steps.append(row_2(world)[1:])
    press(world, "DOWN")
    assert title(world).startswith("A1 HEARD"), world.lcd()
    return heard, steps


def test_where_no_drive_answers_the_wires_of_the_panel_come_first():
    world = panel(addresses=(1, 2))
    for drive in world.drives.values():
        drive.unplug()
    world.run(3000)
    heard, steps = why(world)
    assert heard == "NO DRIVE AT ALL"
    assert steps == [
        "PLUG AND WIRES", "A AND B SWAPPED", "P2010=7 19200", "DRIVE HAS MAINS", "P2011 = 1",
        "ENDS TERMINATED", "FIND DRIVES",
    ]  # fmt: skip
    world.drives[1].plug()
    world.run(2000)
    assert row_2(world) == ">IT ANSWERS NOW", world.lcd()
    world.check()


def test_a_step_stays_where_it_is_read_though_something_else_is_heard_by_now():
    world = panel(addresses=(1, 2))
    for drive in world.drives.values():
        drive.unplug()
    world.run(3000)
    why(world)
    press(world, "DOWN", "DOWN")
    assert row_2(world) == ">PLUG AND WIRES", world.lcd()
    world.drives[2].plug()  # so it is drive 1 alone: then its mains would come first
    world.run(3000)
    assert row_2(world) == ">PLUG AND WIRES", world.lcd()
    press(world, "UP", "UP")
    world.run(500)
    assert row_2(world) == ">NOTHING", world.lcd()
    press(world, "DOWN", "DOWN")
    assert row_2(world) == ">DRIVE HAS MAINS", world.lcd()


def test_what_is_heard_now_counts_as_long_as_no_step_is_read():
    """Also when the counted telegrams are looked at, and whichever way it has changed."""
    world = panel(addresses=(1, 2))
    world.drives[1].unplug()
    world.run(3000)
    why(world)
    assert row_2(world) == ">NOTHING", world.lcd()
    world.drives[2].unplug()
    world.run(3000)
    assert row_2(world) == ">NO DRIVE AT ALL", world.lcd()
    press(world, "DOWN", "DOWN")
    assert row_2(world) == ">PLUG AND WIRES", world.lcd()
    press(world, "UP")
    world.drives[2].plug()
    world.run(3000)
    press(world, "DOWN")
    assert row_2(world) == ">DRIVE HAS MAINS", world.lcd()


def test_the_telegrams_that_it_answered_are_counted_as_far_as_there_is_room():
    world = panel()
    world.drives[1].unplug()
    world.run(3000)
    counters = world.app.bus.turns.at(1).counters
    why(world)
    press(world, "DOWN")
    for place in range(len(counters)):
        counters[place] = 0
    counters[COUNTERS.index("good")], counters[COUNTERS.index("bcc")] = 812, 7_000
    world.run(100)
    good, _, _, counted = row_2(world)[1:].split()
    assert good == "812" and 7_812 <= int(counted) <= 7_815, world.lcd()
    counters[COUNTERS.index("start")] = 5_000
    world.run(100)
    assert row_2(world) == ">812 OK OF 9999", world.lcd()
    counters[COUNTERS.index("good")] = 10_000
    world.run(100)
    assert row_2(world) == ">9999 OK OF 9999", world.lcd()


def test_set_opens_what_helps_at_a_step_and_nothing_at_what_was_heard():
    for how, first in ((silent, "DRIVE HAS MAINS"), (shorter, "P2013 = 4")):
        world = panel(addresses=(1, 2))
        spoil(world.wire, world.drives[1], how)
        world.run(3000)
        why(world)
        for _ in range(2):
            before = title(world)
            press(world, "SET")
            assert title(world) == before and before.startswith("A1 HEARD"), world.lcd()
            press(world, "DOWN")
        assert row_2(world) == ">" + first, world.lcd()
        press(world, "SET")
        assert row_2(world) == (">PKW 4 WORDS" if how is shorter else ">" + first), world.lcd()


def test_of_a_drive_whose_parameters_nobody_knows_the_values_are_named():
    world = panel(kinds={1: {"family": generic}}, settings={"kinds": {"1": "generic"}})
    world.drives[1].unplug()
    world.run(3000)
    _, steps = why(world)
    assert "RATE 19200" in steps and "ADDRESS 1" in steps, steps


def test_where_the_others_answer_it_is_that_drive():
    world = panel(addresses=(1, 2))
    world.drives[1].power_off()
    world.run(3000)
    heard, steps = why(world)
    assert heard == "NOTHING" and steps[:3] == ["DRIVE HAS MAINS", "PLUG AND WIRES", "P2011 = 1"]
    press(world, "UP", "SET")  # the last step
    assert row_1(world).startswith("FIND DRIVES"), world.lcd()
    world.check()


def test_what_is_heard_in_place_of_answers_says_what_to_check_first():
    first = {
        "NO CONTACT": ("NO DRIVE AT ALL", "PLUG AND WIRES"),
        "LINE NOISE": ("LINE NOISE", "ONLY ONE IS A1"),
        "OTHER LENGTH": ("OTHER LENGTH", "P2013 = 4"),
        "WRONG DRIVE": ("WRONG DRIVE", "NO OTHER MASTER"),
        "WRONG CHECK": ("WRONG CHECK", "SHIELD, GROUND"),
    }
    for how, _, words, _ in TROUBLES:
        world = panel()
        world.run(1000)
        spoil(world.wire, world.drives[1], how)
        world.run(2500)
        heard, steps = why(world)
        assert (heard, steps[0]) == first[words], how.__name__


def test_where_another_master_talks_that_is_the_reason():
    """As long as it talks, row 2 tells nothing else."""

    class OtherMaster:
        def hear(self, burst):
            pass

    world = World(main.start, (1,))
    other = OtherMaster()
    world.wire.attach(other)

    def beside(ms):
        for _ in range(ms // 50):
            world.wire.talk(other, b"\x02\x06\x05\x04\x7e\x00\x00\x7b", 8)
            world.run(50)

    shown = []
    beside(1000)
    for key, ms in (("PARAM", 1500), ("SET", 100), ("UP", 100)):
        world.down(key)
        beside(ms)
        world.up(key)
        beside(500)
        shown.append(world.lcd())
    assert shown[1:] == [
        ("A1 HEARD     1/3", "LINE IN USE     "), ("CHECK        3/3", "LINE IN USE     "),
    ], shown  # fmt: skip
    assert telegrams(world, 0) == []
    world.run(1500)  # it falls silent
    assert row_2(world) == ">NO OTHER MASTER", world.lcd()
    press(world, "DOWN")
    assert row_2(world) == ">IT ANSWERS NOW", world.lcd()
    world.check()


def test_the_rate_can_be_changed_from_there():
    world = panel(baud=9600, settings={"baud": 19200})
    world.run(3000)
    press(world, "STOP")  # nobody confirms it
    world.run(2000)
    why(world)
    while row_2(world) != ">P2010=7 19200":
        press(world, "DOWN")
    press(world, "SET")
    assert row_2(world) == ">BAUD 19200", world.lcd()
    press(world, "DOWN", "SET")
    world.run(4000)
    wait_until_known(world)
    assert json.loads(world.flash.files["settings.json"].decode())["baud"] == 9600
    world.check()


def test_drives_at_another_rate_are_looked_for_though_no_stop_is_confirmed():
    world = panel(baud=9600, settings={"baud": 19200})
    world.run(3000)
    press(world, "STOP")
    world.run(2000)
    assert "STOP UNCONFIRMED" in world.lcd(), world.lcd()
    _, steps = why(world)
    assert steps[-1] == "FIND DRIVES", steps
    press(world, "UP", "SET")
    assert row_2(world) == ">AT ALL RATES", world.lcd()
    press(world, "SET")
    asked = []
    for _ in range(100):
        world.run(200)
        row = settled(world)[0].rstrip()
        if row not in asked[-1:]:
            asked.append(row)
    assert row_2(world) == "SET=DO  PARAM=NO", world.lcd()
    stakes = ["LEAVE THE LINE &", "FIND DRIVES?", "THOSE WITH P2014", "MAY TRIP: F0072"]
    assert asked[0:16:2] == stakes * 2, asked
    assert set(asked[1:16:2]) == {"A1 NOT STOPPED"}, asked  # the alarm takes turns
    press(world, "SET")
    world.run(3000)
    assert row_2(world) == "3 RATES SET=GO", world.lcd()
    world.check()


def test_a_drive_that_somebody_has_given_another_address_is_found_from_there():
    world = panel(addresses=(1, 2))
    world.run(1000)
    world.drives[1].write(2011, 0, 4)
    world.run(3000)
    why(world)
    while row_2(world) != ">P2011 = 1":
        press(world, "DOWN")
    press(world, "SET")
    assert row_2(world) == ">A1  IN THE LIST", world.lcd()
    press(world, "DOWN", "DOWN", "DOWN")
    world.run(3000)
    assert row_2(world) == ">A4  ANSWERS", world.lcd()
    world.check()


def test_stop_is_stop_at_every_step_and_behind_it():
    opened = []
    for how in (TROUBLES[0][0], TROUBLES[1][0], TROUBLES[4][0]):
        world = panel(addresses=(1, 2))
        world.run(1000)
        spoil(world.wire, world.drives[1], how)
        world.run(2500)
        _, steps = why(world)
        press(world, "DOWN")
        press_stop(world, "counted")
        for step in steps:
            press(world, "DOWN", "SET")
            if row_2(world)[1:] != step:
                opened.append(step)
                press_stop(world, step)
                press(world, "PARAM")
            assert row_2(world)[1:] == step, (step, world.lcd())
            press_stop(world, step)
        world.check()
    assert opened == [
        "P2011 = 1", "P2010=7 19200", "P2013 = 4", "FIND DRIVES", "P2010=7 19200", "P2013 = 4",
        "P2012 = 2",
    ], opened  # fmt: skip


def press_stop(world, where):
    pressed_us = world.clock.now_us
    press(world, "STOP")
    offs = [at_us for at_us, stw in telegrams(world, pressed_us, 1) if stw == OFF1]
    assert offs and offs[0] - pressed_us < 150_000, (where, world.lcd())
    assert row_2(world) == ">A1: STOP", (where, world.lcd())


# --- the list by itself --------------------------------------------------------------------------


class Told:
    """A drive, its control, and a panel that shows it beside another one."""

    address = 3
    contact = in_use = False
    trouble = SILENCE
    baud = 19_200

    def __init__(self, family=MM440, **told):
        self.drive = self.survey = self.selected = self.settings = self
        self.family, self.layout = family, family.layout
        self.counters = [0] * len(COUNTERS)
        self.controls = [self]
        for name in told:
            setattr(self, name, told[name])

    def line_in_use(self):
        return self.in_use


def checks(shown):
    return [shown.words(place).decode() for place in range(2, shown.count())]


def test_what_was_heard_has_its_steps_the_most_likely_one_first():
    other, masters = Told(contact=True), "NO OTHER MASTER"
    for told, heard, number, first, last in (
        ({}, "NO DRIVE AT ALL", 7, "PLUG AND WIRES", "FIND DRIVES"),
        ({"controls": [other]}, "NOTHING", 7, "DRIVE HAS MAINS", "FIND DRIVES"),
        ({"trouble": NOISE}, "LINE NOISE", 6, "ONLY ONE IS A3", masters),
        ({"trouble": OTHER_LENGTH}, "OTHER LENGTH", 3, "P2013 = 4", "ONLY ONE IS A3"),
        ({"trouble": OTHER_ADDRESS}, "WRONG DRIVE", 3, masters, "ONLY ONE IS A3"),
        ({"trouble": WRONG_CHECK}, "WRONG CHECK", 3, "SHIELD, GROUND", "ONLY ONE IS A3"),
        ({"in_use": True}, "LINE IN USE", 1, masters, masters),
        ({"in_use": True, "trouble": NOISE}, "LINE IN USE", 1, masters, masters),
    ):
        panel = Told(**told)
        shown = contact.List(panel, None)
        found = checks(shown)
        assert (len(found), found[0]) == (number, first) and found[-1] == last, found
        assert shown.words(0).decode() == heard
        assert [shown.heading(at) for at in range(3)] == [b"A3 HEARD", b"A3 HEARD", b"CHECK"]
        panel.contact = True
        assert shown.words(0) == b"IT ANSWERS NOW"


def test_between_the_first_step_and_the_last_each_has_its_place():
    plug, mains, swapped = "PLUG AND WIRES", "DRIVE HAS MAINS", "A AND B SWAPPED"
    ends, shield, masters = "ENDS TERMINATED", "SHIELD, GROUND", "NO OTHER MASTER"
    rate, address, length, twins = "P2010=7 19200", "P2011 = 3", "P2013 = 4", "ONLY ONE IS A3"
    for told, steps in (
        ({"controls": [Told(contact=True)]},
         [mains, plug, address, rate, swapped, length, "FIND DRIVES"]),
        ({"trouble": NOISE}, [twins, rate, ends, swapped, shield, masters]),
        ({"trouble": OTHER_ADDRESS}, [masters, address, twins]),
        ({"trouble": WRONG_CHECK}, [shield, ends, twins]),
    ):  # fmt: skip
        assert checks(contact.List(Told(**told), None)) == steps, told


def test_what_is_heard_now_counts_at_the_first_two_entries():
    panel = Told(trouble=NOISE)
    shown = contact.List(panel, None)
    panel.trouble = OTHER_LENGTH
    shown.step(2, 0)
    assert shown.count() == 8
    for position in (1, 0):
        shown.step(position, 0)
        assert shown.count() == 5
        panel.trouble = NOISE
        shown.step(7, 0)
        assert shown.count() == 5
        shown.step(position, 0)
        assert shown.count() == 8
        panel.trouble = OTHER_LENGTH


def test_answers_are_counted_among_all_telegrams_to_9999_of_both():
    panel = Told()
    shown = contact.List(panel, None)
    good, bad = COUNTERS.index("good"), COUNTERS.index("bcc")
    for goods, bads, row in (
        (0, 0, b"0 OK OF 0"), (5, 7, b"5 OK OF 12"), (9_998, 1, b"9998 OK OF 9999"),
        (9_999, 0, b"9999 OK OF 9999"), (10_000, 1, b"9999 OK OF 9999"),
        (3, 9_997, b"3 OK OF 9999"),
    ):  # fmt: skip
        panel.counters[good], panel.counters[bad] = goods, bads
        assert shown.words(1) == row, row


def test_a_step_has_the_number_of_its_parameter_where_the_family_has_one():
    """And the code of the rate, where that is one of the family's."""
    of_mm4 = ["PLUG AND WIRES", "A AND B SWAPPED", "P2010=7 19200", "DRIVE HAS MAINS", "P2011 = 3",
              "ENDS TERMINATED", "FIND DRIVES"]  # fmt: skip
    assert checks(contact.List(Told(), None)) == of_mm4
    of_mm4[2] = "P2010 = 12345"
    assert checks(contact.List(Told(baud=12_345), None)) == of_mm4
    of_any = checks(contact.List(Told(GENERIC), None))
    assert of_any[2] == "RATE 19200" and of_any[4] == "ADDRESS 3", of_any
    lengths = checks(contact.List(Told(trouble=OTHER_LENGTH), None))
    assert lengths == ["P2013 = 4", "P2012 = 2", "ONLY ONE IS A3"], lengths
    of_any = Told(GENERIC, trouble=OTHER_LENGTH)
    words = of_any.layout.pkw_words, of_any.layout.pzd_words
    assert checks(contact.List(of_any, None))[:2] == ["PKW WORDS %d" % words[0],
                                                      "PZD WORDS %d" % words[1]]  # fmt: skip


def test_set_on_a_step_leads_to_what_is_changed_there():
    panel = Told()
    shown = contact.List(panel, None)
    rate, address, find = ("value", SETTINGS[0]), ("address", None), ("find", None)
    leads = [shown.choose(at, 0) for at in range(shown.count())]
    assert leads == [None, None, None, None, rate, None, address, None, find], leads
    panel = Told(trouble=OTHER_LENGTH)
    shown = contact.List(panel, None)
    leads = [shown.choose(at, 0) for at in range(shown.count())]
    assert leads == [None, None, ("kind", (panel, 1)), ("kind", (panel, 2)), None], leads
