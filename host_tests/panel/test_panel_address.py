# SPDX-License-Identifier: MIT
"""The operator's manual: a drive is given another address, and the panel follows it."""

from panel import texts
from panel.pages import parameter_words as words
from panel.pages.parameter_words import failure
from panel.writer import Writer
from panel_bench import (
    LOOP_US,
    OFF1,
    page_back,
    panel,
    row_2,
    running,
    starts,
    telegrams,
    unsupervised,
)
from parameter_bench import (
    ASKED,
    edit,
    lose_answer,
    parameter,
    restart_drive,
    show,
    stored,
    wait_for,
    write,
    write_eeprom,
    writes,
)
from uss import pkw
from uss.families import G120, MM440


def test_a_drive_is_followed_to_its_new_address():
    world = parameter("P2011", addresses=(1, 2), loop_us=LOOP_US)
    write(world, 5)
    world.run(400)
    assert row_2(world) == "WRITTEN (EEPROM)"  # always: where would it be after its power-up?
    world.run(3000)
    assert row_2(world) == "P2011:     5 A5" and world.drives[1].address == 5
    page_back(world)
    assert row_2(world) == "READY        A5"
    world.press("START")
    world.run(4000)
    assert world.drives[1].state == "running" and starts(world, 2) == 0
    world.press("STOP")
    world.run(5000)
    assert world.drives[1].state == "ready"
    world.check()


def test_every_address_of_a_drive_can_be_written():
    for address in (0, 9, 10, 31):
        world = parameter("P2011")
        write(world, address)
        world.run(3500)
        assert row_2(world) == "P2011:    %2d A%d" % (address, address)
        world.check()


def test_a_drive_keeps_its_address_over_its_mains():
    """While the panel goes on, and when it restarts as well."""
    for restart in (False, True):
        world = parameter("P2011")
        write(world, 5)
        world.run(1000)
        assert stored(world)["drives"] == [5]
        world.drives[1].power_off()
        world.run(3000)
        world.drives[1].power_on()
        if restart:
            world.reset()
        world.run(10_000)
        assert row_2(world)[13:] == "A5" and world.drives[1].address == 5
        world.check()


def test_an_address_in_the_eeprom_goes_into_the_settings():
    world = panel(addresses=(1, 2), settings={"unsupervised": [1]})
    show(world, "P2011")
    write_eeprom(world, 5)
    world.run(300)
    assert row_2(world) == "WRITTEN (EEPROM)"
    assert stored(world)["drives"] == [5, 2] and stored(world)["unsupervised"] == [5]
    restart_drive(world)
    world.reset()
    world.run(2000)
    assert row_2(world) == "READY        A5"
    world.check()


def test_an_address_moves_several_times_and_the_last_one_stays():
    world = parameter("P2011")
    for address in (5, 7):
        write(world, address)
        world.run(3500)
    write_eeprom(world, 9)
    world.run(500)
    assert stored(world)["drives"] == [9]
    write_eeprom(world, 1)
    world.run(500)
    assert stored(world)["drives"] == [1]
    world.check()


def test_the_address_that_it_has_may_be_written_into_the_eeprom():
    world = parameter("P2011")
    write_eeprom(world, 1)
    assert row_2(world) == "WRITTEN (EEPROM)" and stored(world)["drives"] == [1]
    world.check()


def test_an_address_of_another_drive_is_refused():
    world = edit(parameter("P2011", addresses=(1, 2), loop_us=LOOP_US), 2)
    world.press("SET")
    assert row_2(world) == "ADDRESS IS TAKEN"
    world.press("ADDRESS_UP")
    world.run(500)
    write(world, 4)
    world.run(1000)
    world.press("ADDRESS_DOWN")
    world.run(500)
    edit(world, 4)
    world.press("SET")
    assert row_2(world) == "ADDRESS IS TAKEN"
    world.press("EDIT")
    edit(world, 2)  # the other one has left it
    world.press("SET")
    assert row_2(world) == ASKED
    world.check()


def test_an_address_is_not_changed_while_the_drive_runs():
    world = show(panel(loop_us=LOOP_US), "P2011")
    edit(world, 4)
    world.press("START", 40)
    for _ in range(2):  # it starts; it runs
        world.press("SET", 40)
        assert row_2(world) == "STOP ALL FIRST"
        world.run(4000)
    world.press("STOP")
    world.press("SET")
    assert row_2(world) == "STOP ALL FIRST"  # it ramps down
    world.run(5000)
    world.press("SET")
    assert row_2(world) == ASKED
    assert not writes(world)
    world.check()


def test_an_address_is_not_changed_when_the_drive_has_started_meanwhile():
    """While the question stood somebody started it at its terminals."""
    world = edit(parameter("P2011"), 4)
    world.press("SET")
    world.drives[1].write(700, 0, 2)
    world.drives[1].process.zsw = lambda: 0xFB34
    world.run(500)
    world.press("SET")
    world.run(500)
    assert world.drives[1].address == 1 and not writes(world)


def test_an_old_answer_to_a_reading_is_no_confirmation():
    """A drive that lags by more telegrams than the master waits for."""
    for lag, phase_ms in ((22, 0), (25, 130), (30, 470), (45, 470)):
        world = parameter("P2011", baud=115200)
        world.drives[1].stale_replies = lag
        world.run(2500 + phase_ms)
        edit(world, 5)
        world.press("SET")
        world.press("SET")
        world.run(12_000)
        assert (world.drives[1].address,) == world.app.settings.drives, (lag, world.lcd())
        world.check()


def test_two_drives_never_get_the_same_address():
    """The first one is still being written to when the second one is given its new address."""
    for wait_ms in (0, 150, 300, 450):
        world = edit(parameter("P2011", addresses=(1, 2)), 4)
        world.press("SET")
        world.run(wait_ms)
        lose_answer(world, 2011, 4, 40)
        world.press("ADDRESS_UP", 40)
        world.run(500)
        if row_2(world) != "P2011:     2 A2":
            continue
        edit(world, 4)
        world.press("SET")
        world.run(4000)
        world.press("SET")
        world.run(1000)
        assert (world.drives[1].address, world.drives[2].address) == (4, 2)
        world.check()


def test_an_address_that_is_being_given_to_one_drive_is_taken_for_all_others():
    world = edit(parameter("P2011", addresses=(1, 2), parameters={2014: 20_000}), 4)
    world.press("SET")
    world.drives[1].unplug()  # nobody knows for a while whether it has heard that
    world.press("SET")
    world.press("ADDRESS_UP")
    wait_for(world, "P2011:     2 A2")
    edit(world, 4)
    world.press("SET")
    wait_for(world, "ADDRESS IS TAKEN")
    world.press("UP")
    world.press("SET")
    wait_for(world, ASKED)  # 5 is free, and so is 3
    world.press("PARAM")
    world.press("DOWN")
    world.press("DOWN")
    world.press("SET")
    wait_for(world, ASKED)
    world.press("PARAM")
    assert world.drives[2].address == 2
    world.check()


def test_a_drive_whose_answer_was_lost_is_found_at_its_new_address():
    for silent_ms in (50, 1500, 3000, 6000):  # the last: it is only looked for by then
        options = {"parameters": {2014: 20_000}, "settings": {"unsupervised": [1]}}
        world = edit(parameter("P2011", **options), 5)
        world.press("SET")
        lose_answer(world, 2011, 5, silent_ms)
        world.run(6500)
        assert world.drives[1].address == 5
        assert row_2(world)[13:] == "A5", (silent_ms, world.lcd())
        page_back(world)
        world.press("START")
        world.run(4000)
        assert world.drives[1].state == "running" and row_2(world) == "RUNNING      A5"
        world.check()


def test_a_drive_that_fell_silent_is_spoken_to_at_either_address_three_times_in_turn():
    world = edit(parameter("P2011", parameters={2014: 20_000}, loop_us=LOOP_US), 5)
    world.press("SET")
    since_us = world.clock.now_us
    lose_answer(world, 2011, 5, 1500)
    asked = []  # [address, so many telegrams one after the other]
    for at_us, from_panel, characters in world.wire.log.last(200):
        if from_panel and at_us > since_us:
            if not asked or asked[-1][0] != characters[2]:
                asked.append([characters[2], 0])
            asked[-1][1] += 1
    told = asked[2:10]  # later mirrors of the search stand between
    assert {count for _, count in told} == {3} and len(told) == 8, asked
    assert {address for address, _ in told} == {1, 5}, asked


def test_a_long_list_gets_time_to_find_the_drive_as_well():
    """With 20 drives at 2400 baud a round of the bus takes more than 3 s."""
    world = panel(addresses=tuple(range(1, 21)), baud=2400)
    world.run(4000)
    show(world, "P2011")
    wait_for(world, "P2011:     1 A1", 60_000)
    edit(world, 0)
    world.press("SET")
    lose_answer(world, 2011, 0, 50)
    assert world.drives[1].address == 0
    world.run(60_000)
    assert row_2(world) == "P2011:     0 A0"


def test_on_a_slow_line_a_drive_is_looked_for_during_three_rounds():
    """With eight drives at 2400 baud they take 5 s: from 6 s to 11 s after its last answer."""
    for silent_ms, address in ((9_000, 0), (13_000, 1)):
        world = panel(addresses=tuple(range(1, 9)), baud=2400, parameters={2014: 60_000})
        world.run(6000)
        show(world, "P2011")
        wait_for(world, "P2011:     1 A1", 60_000)
        edit(world, 0)
        world.press("SET")
        lose_answer(world, 2011, 0, 50)
        world.drives[1].unplug()
        world.run(silent_ms)
        world.drives[1].plug()
        world.run(5_000)
        assert row_2(world)[13:] == "A%d" % address, (silent_ms, world.lcd())
        assert stored(world)["drives"][0] == address, silent_ms


def test_a_drive_that_did_not_hear_is_taken_again_at_its_old_address():
    world = parameter("P2011", addresses=(1, 2), parameters={2014: 20_000}, loop_us=LOOP_US)
    edit(world, 5)
    world.press("SET")
    world.drives[1].unplug()
    world.press("SET")
    wait_for(world, "NO ANSWER", 15_000)
    world.drives[1].plug()
    world.run(5000)
    assert row_2(world) == "P2011:     5↕A1"
    world.press("EDIT")
    assert row_2(world) == "P2011:     1 A1" and stored(world)["drives"] == [1, 2]
    world.check()


def test_an_address_that_did_not_reach_the_eeprom_does_not_get_into_the_settings():
    """The line fails while SET is held, and comes back: nothing is claimed that is not so."""
    for silent_ms in range(5000, 13_000, 1000):
        world = edit(parameter("P2011", parameters={2014: 0}), 5)
        world.press("SET")
        world.down("SET")
        world.run(1350)
        world.drives[1].unplug()
        world.run(silent_ms)
        world.up("SET")
        world.drives[1].plug()
        world.run(3000)
        claimed = stored(world)["drives"]
        restart_drive(world)
        assert claimed == [world.drives[1].address], (silent_ms, claimed, world.lcd())


def test_a_drive_that_is_not_of_this_panel_is_not_taken_for_the_one_that_moved():
    """Drive 1 did not hear that it is 5; somebody else's drive 5 answers instead."""
    world = edit(parameter("P2011", addresses=(1, 5), settings={"drives": [1]}), 5)
    world.press("SET")
    world.drives[1].unplug()
    world.press("SET")
    world.run(3000)
    page_back(world)
    world.press("START")
    world.run(3000)
    assert starts(world, 5) == 0
    assert 5 not in [row[2][2] for row in world.wire.log.last(20) if row[1]]


def test_stop_while_it_is_looked_whether_an_address_is_free_reaches_the_drive():
    world = parameter("P2011", baud=2400)
    world.run(5000)
    edit(world, 5)
    world.press("SET")
    world.press("SET", 60)
    pressed_us = world.clock.now_us
    world.press("STOP")
    world.run(1500)
    assert OFF1 in [stw for _, stw in telegrams(world, pressed_us, 1)]
    assert row_2(world) == "NOT WRITTEN" and world.drives[1].address == 1
    world.check()


def test_a_drive_whose_new_address_cannot_be_saved_is_not_started():
    """The flash is full: a panel that restarts would look for it at the old address."""
    world = parameter("P2011")
    full(world)
    write(world, 5)
    world.run(1000)
    assert world.drives[1].address == 5
    page_back(world)
    world.press("START")
    assert row_2(world) in ("NO: UNSAVED", "SETTINGS UNSAVED")
    world.run(2000)
    assert starts(world) == 0
    world.app.board.store.replace = world.keep
    world.run(11_000)
    world.press("START")
    world.run(2000)
    assert starts(world) == 1
    world.check()


def test_settings_that_cannot_be_saved_are_tried_again_after_ten_seconds():
    """And each time the display says so."""
    world = panel()
    tried_us = []

    def replace(data):
        tried_us.append(world.clock.now_us)
        raise OSError(28)

    world.app.board.store.replace = replace
    world.app.settings.change("setpoint_step_centihertz", 20)
    for count in (1, 2, 3):
        wait_for(world, "SETTINGS UNSAVED", 11_000)
        assert len(tried_us) == count, tried_us
        wait_for(world, "READY        A1")
    waits = [(after - before) // 1000 for before, after in zip(tried_us, tried_us[1:])]
    assert all([10_000 <= ms < 10_500 for ms in waits]), waits
    world.check()


def full(world):
    store = world.app.board.store
    world.keep = store.replace

    def replace(data):
        raise OSError(28)

    store.replace = replace


def lost_running():
    """Drive 1 was running when its connector was pulled; STOP has acknowledged it."""
    world = running(loop_us=LOOP_US, **unsupervised(1, 2))
    world.drives[1].unplug()
    world.run(2000)
    assert world.reads("NO CONTACT, MAY RUN")
    world.press("STOP")
    world.run(3000)
    world.press("ADDRESS_UP")
    world.run(500)
    return show(world, "P2011")


def test_stop_that_a_lost_drive_did_not_hear_makes_no_drive_stand():
    """It is acknowledged, and turns on: no address changes until it is heard at rest."""
    world = edit(lost_running(), 7)
    world.press("SET", 40)
    assert row_2(world) == "STOP ALL FIRST" and world.drives[1].hz() > 9
    world.drives[1].plug()
    world.run(8000)
    world.press("SET")
    world.press("SET")
    world.run(2000)
    assert world.drives[2].address == 7 and stored(world)["drives"] == [1, 7]
    world.check()


def test_nothing_is_saved_while_a_lost_drive_turns_that_was_acknowledged():
    world = lost_running()
    world.app.settings.dirty = True
    world.run(5000)
    assert world.app.settings.dirty and world.drives[1].hz() > 9
    world.drives[1].plug()
    world.run(8000)
    assert not world.app.settings.dirty
    world.check()


def test_a_drive_that_was_taken_away_for_good_is_forgotten_by_a_restart():
    world = lost_running()
    world.reset()
    world.run(3000)
    world.press("ADDRESS_UP")
    world.run(500)
    show(world, "P2011")
    write(world, 7)
    world.run(2000)
    assert stored(world)["drives"] == [1, 7]


def test_start_and_jog_wait_until_the_address_is_written():
    world = edit(parameter("P2011", loop_us=LOOP_US), 5)
    world.press("SET")
    world.press("SET", 40)
    world.press("START", 40)
    assert row_2(world) == "STILL WRITING"
    world.run(5000)
    assert starts(world) == 0 and world.drives[1].address == 5
    world.check()


def test_a_drive_whose_new_address_was_saved_does_not_wait_for_other_settings():
    """They are saved when no drive runs."""
    world = parameter("P2011", addresses=(1, 2, 3))
    write(world, 5)
    world.run(3000)
    page_back(world)
    assert stored(world)["drives"] == [5, 2, 3]
    world.press("ADDRESS_DOWN")
    world.press("START")
    world.run(1000)
    world.press("ADDRESS_DOWN")
    world.drives[2].write(2014, 0, 0)
    world.run(3000)
    world.press("START")
    wait_for(world, "SET=FIX START=GO")
    world.run(1200)
    world.press("START")
    world.run(3000)
    assert starts(world, 2) == starts(world, 3) == 1 and world.app.settings.dirty
    world.press("ADDRESS_DOWN")
    world.press("START")
    world.run(1000)
    assert starts(world, 1) == 1
    world.check()


def test_an_address_is_not_changed_while_another_drive_may_run_out_of_contact():
    world = running(loop_us=LOOP_US, **unsupervised(1, 2))
    world.drives[1].unplug()
    world.run(2000)
    world.press("ADDRESS_UP")
    edit(show(world, "P2011"), 4)
    world.press("SET", 40)
    assert row_2(world) == "STOP ALL FIRST"
    world.check()


def test_an_address_is_not_changed_while_another_drive_is_sent_on():
    """It does not run yet, but may in the next moment."""
    world = panel(addresses=(1, 2), loop_us=LOOP_US)
    world.drives[1].write(10, 0, 1)
    world.run(300)
    world.press("START")
    world.press("ADDRESS_UP")
    edit(show(world, "P2011"), 4)
    world.run(500)  # the drive that is not shown has told its settings
    assert world.app.bus.turns.drives[0].is_on()
    world.press("SET", 40)
    assert row_2(world) == "STOP ALL FIRST"
    world.check()


# --- the writer by itself ------------------------------------------------------------------------


class Told:
    """What a writer asks of a control, its drive, and the bus. It answers when it is told to."""

    address = answered_address = 1
    contact = True
    full = moving = moved = False
    silent = stops = served = urgent = rechecks = 0
    cycle_us = 100_000

    def __init__(self, family=MM440):
        self.drive = self.survey = self.channel = self.turns = self
        self.family = family
        self.counters = [0xFFF0, 0xFFF0]
        self.kept, self.aims, self.hurries = [], [], 0
        self.writer = Writer(self, self, 0x3FFFFFF)
        self.now_us = 0x3FFFF00  # the clock begins anew meanwhile

    def is_full(self):
        return self.full

    def ask(self, job):
        job.state = pkw.PENDING
        self.job = job
        self.aims.append((job.task, job.number, job.index, job.high, job.low))

    def hurry(self):
        self.urgent = self.served + 1
        self.hurries += 1

    def recheck(self):
        self.rechecks += 1

    def longest_cycle_us(self):
        return self.cycle_us

    def readdress(self, drive, address):
        if drive is self:
            self.address = address
        else:  # the settings: from this one to that one
            self.kept.append((drive, address))

    def write(self, *what):
        self.written = self.writer.write(self, *what)
        return self.written.outcome

    def step(self, ms=0):
        self.now_us = self.now_us + ms * 1_000 & 0x3FFFFFF
        self.writer.step(self.now_us)
        return self.written.outcome

    def answer(self, value=None, state=pkw.DONE):
        self.job.state, self.job.width = state, self.written.width
        value = self.written.value if value is None else value
        self.job.high, self.job.low = value >> 16, value & 0xFFFF
        return self.step()

    def probe(self, telegrams=3):
        self.counters[0] += telegrams
        self.silent += telegrams
        return self.step()


def test_a_write_is_done_when_the_drive_tells_the_value():
    for what, aim, outcome in (
        ((5, 0, 7), (pkw.WRITE_WORD, 5, 0, 0, 7), words.WRITTEN),
        ((5, 2, 7, True), (pkw.WRITE_WORD_EEPROM, 5, 2, 0, 7), words.WRITTEN_EEPROM),
        ((5, 0, 0xFFFF), (pkw.WRITE_WORD, 5, 0, 0, 0xFFFF), words.WRITTEN),
        ((5, 0, 0x10002, False, pkw.DOUBLE), (pkw.WRITE_DOUBLE, 5, 0, 1, 2), words.WRITTEN),
        ((5, 0, 3, True, pkw.DOUBLE), (pkw.WRITE_DOUBLE_EEPROM, 5, 0, 0, 3), words.WRITTEN_EEPROM),
    ):
        told = Told()
        assert told.writer.is_idle() and told.writer.take_ended() is None
        assert told.write(*what) is None and told.aims == []
        assert not told.writer.is_idle() and told.writer.write(told, 6, 0, 1).outcome
        told.full = True
        assert told.step() is None and told.aims == []
        told.full = False
        assert told.step() is None and told.step() is None and told.aims == [aim]
        assert told.answer() == (outcome,) and told.written.done and told.rechecks == 1
        assert not told.writer.is_idle() and told.writer.take_ended() is told.written
        assert told.writer.is_idle() and told.writer.take_ended() is None
        assert not told.moved and told.kept == []
        assert told.written.news(told) == (outcome,)
        assert told.written.news(None) == (words.OTHER_WRITTEN, 1)
    told = Told(G120)
    told.write(5, 2, 7)
    told.step()
    assert told.aims == [(pkw.WRITE_ELEMENT_WORD, 5, 2, 0, 7)]


def test_a_write_that_is_not_done_says_why():
    told = Told()
    told.full = True
    assert told.write(5, 0, 7) == (texts.WRITER_BUSY,)
    told.full, told.contact = False, False
    assert told.write(5, 0, 7) == (texts.NO_CONTACT,)
    told.contact = True
    told.write(5, 0, 7)
    told.step()
    for count in (2, 3, 4):  # an old answer to a reading
        assert told.answer(9) is None and len(told.aims) == count
    assert told.answer(9) == (words.NOT_WRITTEN,) and not told.written.done
    assert told.written.news(None) == (words.OTHER_NOT_WRITTEN, 1)
    told.writer.take_ended()
    told.write(5, 0, 7)
    told.step()
    assert told.answer(9) is None  # its tries are counted anew
    told.job.error = 11
    told.silent = 3
    assert told.answer(state=pkw.REFUSED) == failure(told.job)
    assert told.rechecks == 2
    told.writer.take_ended()
    told.write(5, 0, 7)
    told.step()
    assert told.answer(state=pkw.TIMED_OUT) == failure(told.job)  # it has not moved anywhere


def moving(value=9, **told):
    """A drive that is being given another address; nobody is there so far."""
    made = Told()
    for name in told:
        setattr(made, name, told[name])
    assert made.write(2011, MM440.link_index, value) is None
    assert made.moving and made.address == value and made.hurries == 1
    return made


def test_a_drive_is_given_an_address_that_nobody_has():
    told = moving(stops=5)
    assert told.writer.takes(9) and not told.writer.takes(8)
    assert told.step() is None  # the last answer was that of the old address
    told.silent = 1
    assert told.step() is None and told.hurries == 1
    told.served = told.urgent
    assert told.step() is None and told.hurries == 2
    assert told.probe(2) is None and told.address == 9 and told.aims == []
    assert told.probe(1) is None and told.address == 1 and len(told.aims) == 1
    assert told.answer() == (words.WRITTEN,)
    assert (told.address, told.kept) == (9, [(1, 9)]) and told.moved and not told.moving
    assert not told.writer.takes(9)
    told = moving()
    told.answered_address = 9
    assert told.step() == (words.ADDRESS_TAKEN,) and told.address == 1 and not told.moving
    told = moving()
    told.silent, told.stops = 1, 1  # STOP is for the drive where it is
    assert told.step() == (words.NOT_WRITTEN,) and told.address == 1 and told.hurries == 2
    same = Told()
    same.write(2011, MM440.link_index, 1)  # it has that already
    assert not same.moving and not same.writer.takes(1)
    other = Told()
    other.write(2011, MM440.link_index + 1, 9)  # of its other link
    assert not other.moving and other.address == 1 and not other.writer.takes(9)
    assert moving(0).writer.takes(0)  # a lower one is another one as well


def test_telegrams_to_a_new_address_are_counted_though_their_counter_begins_anew():
    told = moving(counters=[0xFFFE, 0])
    told.counters[0] = 0  # two more
    told.silent = 2
    assert told.step() is None and told.aims == []
    told.counters[0] = 1
    assert told.step() is None and len(told.aims) == 1
    assert told.address == 1


def test_a_drive_that_refuses_its_new_address_is_not_looked_for_there():
    told = moving()
    told.probe()
    told.job.error = 2
    assert told.silent and told.answer(state=pkw.REFUSED) == failure(told.job)
    assert (told.address, told.kept) == (1, []) and not told.moving and not told.moved
    assert not told.written.done and told.rechecks == 1
    # An answer of the old address is none of the new one, however soon it comes.
    told = moving()
    told.probe()
    assert told.answer(state=pkw.TIMED_OUT) is None and told.address == 9
    told.silent = 0
    assert told.step(1_999) is None and told.address == 9 and told.moving
    assert told.step(1) == (words.NO_ANSWER,) and told.address == 1 and not told.moving


def test_a_drive_is_looked_for_no_longer_than_a_quarter_of_the_period_of_the_clock():
    told = moving(cycle_us=10_000_000)
    told.probe()
    assert told.answer(state=pkw.TIMED_OUT) is None
    quarter_us = 0x3FFFFFF >> 2
    told.now_us += quarter_us - 1
    assert told.step() is None
    told.now_us += 1
    assert told.step() == (words.NO_ANSWER,) and told.address == 1


def test_a_drive_that_falls_silent_on_its_new_address_is_looked_for():
    for answers, cycle_us, most_ms in (
        (False, 100_000, 2_000), (False, 1_000_000, 3_000), (True, 100_000, 1_999)
    ):  # fmt: skip
        told = moving(cycle_us=cycle_us)
        told.probe()
        told.silent = 5
        assert told.step() is None and told.address == 1
        told.silent = 6  # three more telegrams: it is spoken to at either
        assert told.step() is None and told.address == 9
        told.silent = 8
        assert told.step() is None and told.address == 9
        told.silent = 9
        assert told.step() is None and told.address == 1
        told.silent = 0  # heard in between: that is counted anew
        assert told.step() is None and told.address == 1
        told.silent = 3
        assert told.step() is None and told.address == 9
        told.silent = 6
        assert told.step() is None and told.address == 1
        assert told.answer(state=pkw.TIMED_OUT) is None and told.address == 9
        assert told.step(most_ms - 1) is None
        if answers:
            told.silent, told.answered_address = 0, 9
            assert told.step() == (words.WRITTEN,) and told.kept == [(1, 9)] and told.moved
        else:
            assert told.step(1) == (words.NO_ANSWER,) and told.address == 1
            assert told.kept == [] and not told.moved
    told = moving()
    told.probe()
    told.silent, told.answered_address = 0, 9
    assert told.answer(state=pkw.TIMED_OUT) == (words.WRITTEN,) and told.moved
    told = moving()
    told.probe()
    told.silent = 0
    assert told.answer(state=pkw.TIMED_OUT) == failure(told.job) and not told.moved
