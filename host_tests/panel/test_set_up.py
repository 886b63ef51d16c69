# SPDX-License-Identifier: MIT
"""The operator's manual, a drive that obeys somebody else: START offers to set it up."""

from boards.sim.drives.families import mm3, mm440
from panel.keys import NAMES, Acts, Keys
from panel.pages import set_up
from panel.screen import Screen
from panel_bench import (
    panel,
    press,
    row_2,
    settled,
    starts,
    take_commands_elsewhere_in_second_set,
    wait_until_known,
)
from uss import families
from uss.families import rows
from uss.pzd import ZSW_RUNNING

LOCAL = {700: 2, 1000: 2, 2014: 1000}  # as delivered, but for the line
INTO_EEPROM = {"A1: P0700=5", "INTO ITS EEPROM:", "PANEL COMMANDS", "THE DRIVE THEN"}


def asked(world):
    """What row 1 says in turn."""
    seen = set()
    for _ in range(100):
        world.run(100)
        seen.add(settled(world)[0].strip())
    assert row_2(world) == "SET=DO  PARAM=NO", world.lcd()
    return seen


def test_a_drive_is_set_up_with_start_and_set_alone():
    world = panel(parameters=LOCAL)
    world.run(3000)
    assert row_2(world) == "LOCAL        A1", world.lcd()
    press(world, "START")
    assert row_2(world) == "NO:P0700 NOT USS", world.lcd()
    found = asked(world)
    assert found == INTO_EEPROM, found
    press(world, "SET")
    world.run(4000)
    press(world, "START")
    world.run(1500)
    assert "A1: P1000=5" in asked(world)
    press(world, "SET")
    world.run(4000)
    wait_until_known(world)
    press(world, "START")
    world.run(4000)
    assert world.drives[1].state == "running" and starts(world) == 1
    press(world, "STOP")
    world.run(4000)
    world.drives[1].power_off()  # it is in the EEPROM
    world.run(3000)
    world.drives[1].power_on()
    world.run(3000)
    press(world, "STOP")
    wait_until_known(world)
    world.check()


def test_p0719_that_overrides_both_sources_is_set_to_zero():
    world = panel(parameters={719: 12, 2014: 1000})
    world.run(3000)
    press(world, "START")
    world.run(3500)
    assert "A1: P0719=0" in asked(world)
    press(world, "SET")
    world.run(4000)
    assert world.drives[1].parameters.ram[719][0] == 0
    wait_until_known(world)
    world.check()


def test_what_is_set_up_is_the_data_set_that_is_active():
    world = panel(kinds={1: {"family": mm440}})
    wait_until_known(world)
    drive = world.drives[1]
    take_commands_elsewhere_in_second_set(drive)
    world.run(5000)
    press(world, "START")
    world.run(3500)
    assert "A1: P0700=5" in asked(world)
    press(world, "SET")
    world.run(4000)
    assert (drive.read(700, 0), drive.read(700, 1)) == (5, 5)
    wait_until_known(world)
    world.check()


def test_any_other_key_writes_nothing():
    for key in ("PARAM", "UP", "STOP", "START", "REVERSE"):
        world = panel(parameters=LOCAL)
        world.run(3000)
        press(world, "START")
        world.run(4000)
        press(world, key)
        world.run(3000)
        assert row_2(world) == "LOCAL        A1", (key, world.lcd())
        assert world.drives[1].parameters.ram[700][0] == 2 and starts(world) == 0
        world.check()


def test_a_start_that_a_fault_refuses_says_that_alone():
    world = panel(parameters={1000: 2, 2014: 1000})
    wait_until_known(world)
    world.drives[1].fault(3)
    world.run(1000)
    press(world, "START")
    assert row_2(world) == "NO: FAULT", world.lcd()
    for _ in range(100):
        world.run(100)
        assert row_2(world) != "SET=DO  PARAM=NO", world.lcd()
    world.check()


def test_the_access_level_of_a_micromaster_3_is_p009():
    kinds = {1: {"family": mm3, "parameters": {910: 1, 93: 2, 9: 0}}}
    world = panel(kinds=kinds, settings={"kinds": {"1": "mm3"}})
    world.run(3000)
    press(world, "PARAM", "NEXT")
    world.run(1000)
    press(world, "EDIT", "UP", "SET", "SET")  # another address
    world.run(3500)
    assert asked(world) == {"A1: P0009=3", "PANEL MAY WRITE", "MORE THEN"}
    press(world, "SET")
    world.run(3500)
    assert world.drives[1].read(9) == 3 and world.drives[1].read(91) == 1
    world.check()


def test_a_micromaster_3_is_told_by_p910():
    kinds = {1: {"family": mm3, "parameters": {910: 0, 93: 2}}}
    world = panel(kinds=kinds, settings={"kinds": {"1": "mm3"}})
    world.run(3000)
    press(world, "START")
    world.run(3500)
    assert asked(world) == {"A1: P0910=1", "PANEL COMMANDS", "THE DRIVE THEN"}
    press(world, "SET")
    world.run(4000)
    wait_until_known(world)
    world.check()


def test_a_motor_that_runs_on_other_commands_is_not_taken_over():
    world = panel(parameters=LOCAL)
    world.drives[1].process.words = lambda count: [0xFB34, 0x0CCD]
    world.run(4000)
    assert row_2(world) == "RUNS LOCALLY A1", world.lcd()
    press(world, "START")
    assert row_2(world) == "NO:P0700 NOT USS", world.lcd()
    world.run(4000)
    assert row_2(world) == "RUNS LOCALLY A1", world.lcd()


def test_a_motor_that_has_begun_to_run_on_other_commands_is_not_taken_over_by_set():
    world = panel(parameters=LOCAL)
    world.run(3000)
    press(world, "START")
    world.run(3500)
    assert row_2(world) == "SET=DO  PARAM=NO", world.lcd()
    world.drives[1].process.words = lambda count: [0xFB34, 0x0CCD]
    world.run(300)
    press(world, "SET")
    world.run(4000)
    assert row_2(world) == "RUNS LOCALLY A1", world.lcd()
    assert world.drives[1].parameters.ram[700][0] == 2
    world.check()


def test_a_value_that_the_access_level_forbids_is_offered_again_after_p0003():
    world = panel(parameters={2014: 0, 3: 1})
    wait_until_known(world)
    press(world, "START")
    world.run(1500)
    assert row_2(world) == "SET=FIX START=GO", world.lcd()
    press(world, "SET")
    assert row_2(world) == "P0003 TOO LOW", world.lcd()
    world.run(3500)
    found = asked(world)
    assert found >= {"A1: P0003=3", "PANEL MAY WRITE", "MORE THEN"}, found
    press(world, "SET")
    world.run(3500)
    drive = world.drives[1]
    assert drive.read(3) == 3 and drive.eeprom_writes == 0  # until it is switched off
    press(world, "START")
    world.run(1500)
    press(world, "SET")
    world.run(3500)
    press(world, "START")
    world.run(4000)
    assert world.drives[1].state == "running", world.lcd()
    assert world.drives[1].parameters.ram[2014][0] > 0
    world.check()


# --- what is offered, with a drive that tells what the test says ---------------------------------


class Told:
    """What is asked of a panel and of the drive that it shows."""

    mask = 0xFFFF
    address, zsw, contact, page_turns = 7, 0, True, 0
    message = None

    def __init__(self, family=families.MM440):
        self.selected = self.survey = self.drive = self.announcer = self
        self.family = family
        self.values = [rows.UNKNOWN] * rows.COUNT_OF_ROWS
        self.wrong = list(rows.NOTHING_WRONG)
        self.screen = Screen()
        self.question = None
        self.wrote = []

    def needs_attention(self):
        return False

    def cover(self, page):
        self.question = page

    def uncover(self):
        pass

    def write(self, now_ms, control, *what):
        assert control is self
        self.wrote.append(what)

    def asked(self, what=set_up.offer):
        """What row 1 says in turn; None: nothing is offered."""
        self.question = None
        what(self)
        if self.question is None:
            return None
        said = []
        for self.page_turns in range(4):
            self.question.draw(self.screen, 0)
            said.append(self.screen.rows()[0].rstrip())
        return said

    def set(self):
        """What SET writes."""
        keys = Keys(NAMES, self.mask)
        keys.pressed = keys.bit("SET")
        self.wrote.clear()
        self.question.take_keys(Acts(keys), 0)
        return self.wrote


def test_the_first_source_that_is_wrong_and_can_be_put_right_is_offered():
    command, setpoint = rows.COMMAND, rows.SETPOINT
    for wrong, offered in (
        ({}, None),
        ({command: rows.COMMAND_SOURCE}, (700, 5)),
        ({setpoint: rows.SETPOINT_SOURCE}, (1000, 5)),
        ({command: rows.COMMAND_SOURCE, setpoint: rows.SETPOINT_SOURCE}, (700, 5)),
        ({command: rows.SELECTION, setpoint: rows.SETPOINT_SOURCE}, (719, 0)),
        ({setpoint: rows.SELECTION}, (719, 0)),
        ({command: rows.ON_SOURCE}, None),  # whoever has wired that wanted it so
        ({command: rows.ON_SOURCE, setpoint: rows.SETPOINT_SOURCE}, (1000, 5)),
        ({rows.STATUS: rows.STATUS_SENT, rows.ACTUAL: rows.ACTUAL_SENT}, None),
    ):
        told = Told()
        for subject in wrong:
            told.wrong[subject] = wrong[subject]
        said = told.asked()
        if offered is None:
            assert said is None, wrong
        else:
            assert said[0] == "A7: P%04d=%d" % offered and said[1] == "INTO ITS EEPROM:", said
            assert told.set() == [(offered[0], 0, offered[1], True)]


def test_a_family_without_tasks_for_the_eeprom_is_set_up_in_its_ram():
    told = Told(families.MM3)
    told.wrong[rows.COMMAND] = rows.COMMAND_SOURCE
    assert told.asked() == ["A7: P0910=1", "PANEL COMMANDS", "THE DRIVE THEN", "A7: P0910=1"]
    assert told.set() == [(910, 0, 1, False)]


def test_the_access_level_is_raised_in_the_ram_where_the_family_has_one():
    for family, number in ((families.MM440, 3), (families.MM3, 9), (families.GENERIC, None)):
        told = Told(family)
        said = told.asked(set_up.unlock)
        if number is None:
            assert said is None
        else:
            assert said[:3] == ["A7: P%04d=3" % number, "PANEL MAY WRITE", "MORE THEN"]
            assert told.set() == [(number, 0, 3, False)]


def test_nothing_is_offered_nor_written_while_the_motor_runs_or_the_drive_is_silent():
    for field, value in (("zsw", ZSW_RUNNING), ("contact", False)):
        told = Told()
        told.wrong[rows.COMMAND] = rows.COMMAND_SOURCE
        for what in (set_up.offer, set_up.unlock):
            told.asked(what)
            assert told.question is not None
            question = told.question
            setattr(told, field, value)
            assert told.asked(what) is None
            told.question = question
            assert len(told.set()) == (1 if field == "contact" else 0)
            setattr(told, field, getattr(Told, field))
