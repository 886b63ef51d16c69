# SPDX-License-Identifier: MIT
"""The operator's manual, commissioning: a drive that is new is set up at the buttons, step by
step, until its motor turns.
"""

import catalogue
from lookup_bench import choose, go_to, press, settled_heading, speak, wait, world_of
from panel import texts
from panel.commission import course
from panel.commission.step import Step
from panel.keys import NAMES, Acts, Keys
from panel.lookup.value import Form
from panel.pages import parameter_words
from panel_bench import LOOP_US, row_1, row_2, settled_row_2, wait_until_known
from uss import pkw
from uss.families import MM3, MM440, V20
from uss.families.bop import on_bop

PLATE = (  # of the motor: number, what is typed over what is there, what is read then
    (304, "400", 400),
    (305, "200", 2.0),
    (307, "055", 0.55),
    (310, "5000", 50.0),
    (311, "1380", 1380),
)


def begin(world, procedure):
    go_to(world, "COMMISSION")
    world.run(1000)
    choose(world, procedure)
    world.run(3000)
    assert "/" in settled_heading(world)[1], world.lcd()


def go_to_step(world, number):
    for _ in range(40):
        if settled_heading(world)[0][:5] == "P%04d" % number:
            world.run(700)
            return
        press(world, "DOWN")
    raise AssertionError("there is no step P%04d: %r" % (number, world.lcd()))


def is_done(world):
    return settled_heading(world)[0].endswith("*")


def do(world, number):
    """A step whose value stands in the catalogue."""
    go_to_step(world, number)
    press(world, "SET")
    assert "SET=YES" in settled_row_2(world), world.lcd()
    press(world, "SET")
    world.run(1000)
    assert settled_heading(world)[0] == "P%04d*" % number, world.lcd()


def tell(world, number, digits):
    """A step whose value stands on the motor's plate: each digit is set."""
    go_to_step(world, number)
    press(world, "SET")
    world.run(300)
    type_over(world, digits)
    press(world, "SET")
    world.run(1000)
    assert settled_heading(world)[0] == "P%04d*" % number, world.lcd()


def type_over(world, digits):
    """Each place, from the first one on, goes up until it is right."""
    places = sum([character.isdigit() for character in settled_row_2(world)])
    digits = "0" * (places - len(digits)) + digits
    for place in range(len(digits)):
        for _ in range(20):
            row = settled_row_2(world)
            if sum([character.isdigit() for character in row.split("[")[0]]) == place:
                break
            press(world, "NEXT")
        for _ in range(10):
            if settled_row_2(world).split("[")[1][0] == digits[place]:
                break
            press(world, "UP")
        else:
            raise AssertionError((digits, world.lcd()))


def leave(world):
    """Back to the home page; what is said when the list is left."""
    press(world, "PARAM")
    world.run(200)
    said = settled_row_2(world).rstrip()
    press(world, "PARAM", "PARAM")
    world.run(4000)
    return said


def test_a_motor_is_commissioned_and_turns():
    world = world_of("mm420")
    drive = world.drives[1]
    begin(world, "THE MOTOR")
    do(world, 10)
    for number, digits, value in PLATE:
        tell(world, number, digits)
        assert abs(drive.parameters.get(number) - value) < 0.001, (number, world.lcd())
    do(world, 3900)
    world.run(12_000)
    assert drive.parameters.get(10) == 0
    assert leave(world) == "A1: 12 LEFT"
    wait_until_known(world)
    press(world, "START")
    world.run(4000)
    assert drive.state == "running", world.lcd()
    world.check()


def test_while_its_steps_are_looked_for_nothing_is_said_of_a_procedure():
    world = world_of("mm420")
    go_to(world, "COMMISSION")
    wait(world, ">FOR USS")
    world.run(1000)
    world.press("SET", 50)
    rows = set()
    for _ in range(200):
        rows.add(settled_row_2(world).rstrip())
        if row_1(world).startswith("P0"):
            break
        world.run(10)
    assert row_1(world).startswith("P0") and rows <= {">FOR USS", ">..."}, (rows, world.lcd())
    world.check()


def test_whoever_stops_in_the_middle_reads_what_is_left_and_goes_on():
    world = world_of("mm420")
    begin(world, "THE MOTOR")
    do(world, 10)
    tell(world, 304, "400")
    assert leave(world).endswith("LEFT"), world.lcd()
    begin(world, "THE MOTOR")
    go_to_step(world, 304)
    assert is_done(world)
    go_to_step(world, 305)
    assert not is_done(world)
    for _ in range(40):
        if row_1(world).startswith("A1"):
            break
        press(world, "DOWN")
    assert lines(world) >= {"17 LEFT", "FIRST P0100"}, lines(world)
    world.check()


def lines(world):
    """What row 2 says in turn, without the mark of the menu."""
    found = set()
    for _ in range(90):
        world.run(100)
        found.add(settled_row_2(world)[1:].rstrip())
    return found


def in_turn(world, ms=12_000):
    """What row 2 says one after the other, without the mark of the menu."""
    found = []
    for _ in range(ms // 50):
        world.run(50)
        row = settled_row_2(world)[1:].rstrip()
        if row not in found[-1:] + ["..."]:
            found.append(row)
    return found


def test_a_step_says_in_turn_its_name_what_the_drive_has_and_what_to_know_about_it():
    world = world_of("mm420", known="mm440", loop_us=LOOP_US)  # an MM420 has no P0205
    begin(world, "THE MOTOR")
    rows = catalogue.steps("mm440", 3)
    steps = {catalogue.value(row[catalogue.STEP_NUMBER]): row for row in rows}
    for number, downs, has in ((10, 1, "0 NEEDS 1"), (205, 2, "NO SUCH PARAM.")):
        for _ in range(downs):
            world.press("DOWN")
        rows = in_turn(world)
        assert settled_heading(world)[0] == "P%04d" % number
        name, note = steps[number][1].decode(), steps[number][catalogue.STEP_NOTE].decode()
        rows = rows[: rows.index(rows[0], 1)]  # all of them once
        assert rows[:2] == [name, has] and " ".join(rows[2:]) == note, (rows, note)
    press(world, "SET")
    assert settled_heading(world)[0] == "P0205" and "SET=YES" not in row_2(world), world.lcd()
    world.check()


def test_after_each_write_all_steps_are_asked_again():
    """To write one parameter may change others."""
    world = world_of("mm420")
    drive = world.drives[1]
    drive.parameters.set(700, 0, 2)
    begin(world, "FOR USS")
    go_to_step(world, 2014)
    assert is_done(world)
    go_to_step(world, 700)
    drive.parameters.set(2014, 0, 0)
    do(world, 700)
    assert leave(world) == "A1: 3 LEFT", world.lcd()
    world.check()


def test_a_drive_that_obeys_its_terminals_is_made_ready_for_uss():
    world = world_of("mm420")
    drive = world.drives[1]
    for number, value in ((700, 2), (1000, 2), (2014, 0)):
        drive.parameters.set(number, 0, value)
    begin(world, "FOR USS")
    for number in (700, 1000, 2014):
        do(world, number)
    assert drive.parameters.get(700) == drive.parameters.get(1000) == 5
    assert drive.parameters.get(2014) == 2000
    do(world, 971)
    world.run(1000)
    assert leave(world) == "A1: 1 LEFT", "P2000 is for a person to tell"
    wait_until_known(world)
    press(world, "START")
    world.run(3000)
    assert drive.state == "running", world.lcd()
    world.check()


def test_what_a_setpoint_means_is_asked_before_it_changes():
    world = world_of("mm420")
    begin(world, "FOR USS")
    go_to_step(world, 2000)
    assert "IS 50.00Hz" in lines(world), world.lcd()
    press(world, "SET")
    world.run(300)
    type_over(world, "6000")
    press(world, "SET")
    world.run(300)
    said = lines(world)
    assert said == {"60.00Hz SET=YES", "RESCALES SPEED"}, said
    assert world.drives[1].parameters.get(2000) == 50
    press(world, "SET")
    world.run(1000)
    assert world.drives[1].parameters.get(2000) == 60
    world.check()


def test_param_and_stop_write_nothing():
    for key in ("PARAM", "STOP"):
        world = world_of("mm420")
        begin(world, "THE MOTOR")
        do(world, 10)
        go_to_step(world, 304)
        press(world, "SET")
        world.run(300)
        type_over(world, "999")
        press(world, key)
        world.run(3500)
        assert row_1(world).startswith("P0304 "), world.lcd()
        assert world.drives[1].parameters.get(304) == 230
        go_to_step(world, 3900)
        press(world, "SET", key)
        world.run(3500)
        assert row_1(world).startswith("P3900 "), world.lcd()
        assert world.drives[1].parameters.get(10) == 1
        world.check()


def test_typing_begins_with_what_the_drive_has():
    world = world_of("mm420")
    begin(world, "THE MOTOR")
    for number in (305, 311, 1120):
        go_to_step(world, number)
        press(world, "SET")
        typed = settled_row_2(world)[1:].replace("[", "").replace("]", "")
        has = world.drives[1].parameters.get(number)
        assert abs(float(typed) - has) < 0.001, (number, has, world.lcd())
        press(world, "PARAM")
    world.check()


def test_nothing_is_written_while_the_motor_runs():
    world = world_of("mm420")
    press(world, "START")
    world.run(2000)
    begin(world, "THE MOTOR")
    go_to_step(world, 10)
    press(world, "SET")
    world.run(300)
    assert settled_row_2(world).startswith("STOP A1 FIRST"), world.lcd()
    assert world.drives[1].parameters.get(10) == 0 and world.drives[1].state == "running"
    press(world, "PARAM", "STOP")
    assert row_1(world).startswith("COMMISSION"), world.lcd()
    assert settled_row_2(world) == ">A1: STOP", world.lcd()
    world.run(8000)
    assert world.drives[1].state == "ready", world.drives[1].report()
    world.check()


def test_what_the_drive_refuses_stays_undone():
    world = world_of("mm420")
    begin(world, "THE MOTOR")
    go_to_step(world, 304)
    press(world, "SET")
    world.run(300)
    type_over(world, "400")
    press(world, "SET")
    world.run(1000)
    assert not is_done(world), "P0010 is not 1 yet"
    world.check()


def test_what_no_word_can_say_is_refused_and_can_be_typed_again():
    world = world_of("mm420")
    drive = world.drives[1]
    begin(world, "THE MOTOR")
    do(world, 10)
    go_to_step(world, 311)
    had = drive.parameters.get(311)
    press(world, "SET")
    world.run(300)
    type_over(world, "99999")
    world.press("SET")
    assert settled_row_2(world) == "BEYOND LIMITS", world.lcd()
    world.run(3000)
    assert drive.parameters.get(311) == had and settled_row_2(world) == ">9999[9]", world.lcd()
    for _ in range(4):
        press(world, "PREVIOUS")
    type_over(world, "40000")
    press(world, "SET")
    world.run(1000)
    assert is_done(world) and drive.parameters.get(311) == 40_000, world.lcd()
    assert "IS 40000" in lines(world)
    world.check()


def test_a_drive_that_falls_silent_in_between():
    world = world_of("mm420")
    begin(world, "THE MOTOR")
    world.drives[1].unplug()
    world.run(3000)
    press(world, "DOWN", "SET", "SET", "DOWN", "SET")
    world.run(3000)
    assert row_1(world).startswith("P0"), world.lcd()
    world.drives[1].plug()
    world.run(3000)
    do(world, 10)
    world.check()


def test_each_family_has_its_steps():
    for kind in ("mm3", "g110", "v20", "mm440", "g120"):
        world = world_of(kind)
        begin(world, "FOR USS")
        go_to_step(world, {"mm3": 910, "g120": 2020}.get(kind, 2010))
        assert is_done(world), (kind, world.lcd())
        assert leave(world).endswith("LEFT"), kind
        world.check()


def test_a_procedure_that_is_gone_through_says_so():
    world = world_of("mm420")
    begin(world, "FOR EXPERTS")
    do(world, 1910)
    press(world, "DOWN")
    assert settled_heading(world)[0] == "A1" and lines(world) == {"ALL DONE"}, world.lcd()
    assert leave(world) == "A1: ALL DONE", world.lcd()
    world.check()


def test_a_factory_reset_is_done_although_what_started_it_reads_nothing_again():
    world = world_of("mm420")
    drive = world.drives[1]
    drive.parameters.set(1120, 0, 3.0)
    begin(world, "FACTORY RESET")
    do(world, 10)
    do(world, 970)
    world.run(12_000)
    assert drive.parameters.get(970) == 0 and drive.parameters.get(1120) == 10.0
    assert settled_heading(world)[0] == "P0970*", world.lcd()
    assert leave(world) == "A1: ALL DONE"
    world.check()


def test_a_step_whose_value_is_there_asks_nothing():
    world = world_of("mm420")
    writes = world.drives[1].eeprom_writes
    begin(world, "FOR USS")
    for number in (2010, 2011, 700):  # the rate and the address stay whatever they are
        go_to_step(world, number)
        assert is_done(world), world.lcd()
        press(world, "SET")
        assert settled_row_2(world) == "IT IS RIGHT", world.lcd()
        world.run(3000)
        press(world, "SET")
        world.run(1000)
    assert world.drives[1].eeprom_writes == writes
    world.check()


def test_what_is_written_says_so_until_it_is_and_tells_where_to():
    """What acts from the next power-up on goes into the EEPROM, all else into RAM."""
    world = world_of("mm420")
    drive = world.drives[1]
    drive.parameters.set(2013, 0, 3)
    drive.parameters.set(700, 0, 2)
    begin(world, "FOR USS")
    for number, where in ((2013, "EEPROM"), (700, "RAM")):
        go_to_step(world, number)
        press(world, "SET")
        drive.stale_replies = 40
        for _ in range(2):  # the second one does nothing
            press(world, "SET")
            assert row_2(world).rstrip() == ">WRITING ...", world.lcd()
        drive.stale_replies = 0  # from the next task on
        wait(world, "WRITTEN (%s)" % where)
        world.run(3000)
        assert is_done(world) and "WRIT" not in row_2(world), world.lcd()
    world.check()


def test_a_drive_on_the_bop_link_obeys_that_link():
    world = world_of("mm440-bop")
    drive = world.drives[1]
    for number in (700, 1000):
        drive.parameters.set(number, 0, 2)
    begin(world, "FOR USS")
    for number in (700, 1000):
        do(world, number)
        assert drive.parameters.get(number) == 4, world.lcd()
    world.check()


def test_the_length_of_the_parameter_channel_is_that_of_the_list():
    """It was set at the drive's keypad, and acts from the next power-up on."""
    world = world_of("mm420")
    world.drives[1].parameters.set(2013, 0, 3)
    begin(world, "FOR USS")
    go_to_step(world, 2013)
    assert "3 NEEDS 4" in lines(world), world.lcd()
    do(world, 2013)
    assert world.drives[1].parameters.get(2013) == 4
    world.check()


def test_a_step_may_need_a_number_with_a_point_or_what_is_there():
    """None of the catalogue needs such a number so far, but a table may be written anew."""
    world = world_of("mm420")
    row = [b"S101", b"Ramp", b"Rampe", b"1120", b"0", b"4097.5", b"", b"", b"", b"GK"]
    step = Step(row, world.app.panel.selected, False)
    form = Form(catalogue.find("mm420", 1120), pkw.DOUBLE)
    bits = step.needed(form, 0)
    assert form.words(bits >> 16, bits & 0xFFFF) == b"4097.50"
    job = pkw.read(1120)
    job.width, job.high, job.low = pkw.DOUBLE, bits >> 16, bits & 0xFFFF
    assert step.is_right(job)
    job.low += 1
    assert not step.is_right(job)
    stays = Step(row[:5] + [b"@address"] + row[6:], world.app.panel.selected, False)
    assert stays.needed(form, bits) == bits and stays.is_right(job)


def test_a_family_without_a_table_has_no_steps():
    world = world_of("generic")
    go_to(world, "COMMISSION")
    world.run(1000)
    assert settled_row_2(world) == ">NO STEPS FOR IT", world.lcd()
    press(world, "SET")
    assert row_1(world).startswith("COMMISSION") and row_2(world) == ">NO STEPS FOR IT"
    world.check()


def test_in_german():
    world = world_of("mm420")
    speak(world, "de")
    go_to(world, "INBETRIEBN.", "F\u00dcR USS")
    world.run(3000)
    go_to_step(world, 2011)
    assert "Adresse" in lines(world), world.lcd()
    speak(world, "en")
    world.check()


# --- a step by itself ----------------------------------------------------------------------------


class Told:
    """What a step asks of its drive, the survey of that, and a reading."""

    contact = has_room = True
    pkw_words = 127

    def __init__(self, family):
        self.drive = self.survey = self.layout = self
        self.family = family
        self.asked = []

    def ask(self, drive, number, index, task):
        assert drive is self
        self.asked.append((number, index, task))
        return self.has_room


def step_of(told, number, needs, index=0, is_done=False):
    row = [b"S207", b"", b"", b"%d" % number, b"%d" % index, needs]
    return Step(row, told, is_done)


def job_with(bits, width=pkw.WORD):
    job = pkw.read(0)
    job.width, job.high, job.low = width, bits >> 16, bits & 0xFFFF
    return job


def test_a_person_tells_that_a_step_is_done_where_no_reading_does():
    """A value of the motor's plate, and what starts something, which reads 0 again."""
    told = Told(MM440)
    for number, needs, is_typed, is_told in (
        (304, b"?", True, True), (10, b"?", True, True), (10, b"1", False, True),
        (10, b"0", False, False), (970, b"1", False, True), (971, b"1", False, True),
        (1910, b"1", False, True), (3900, b"1", False, True), (700, b"5", False, False),
    ):  # fmt: skip
        for is_done in (False, True):
            step = step_of(told, number, needs, is_done=is_done)
            assert (step.is_typed, step.is_told) == (is_typed, is_told), (number, needs)
            assert step.is_done == (is_told and is_done) and step.key == 207
    for number in (9, 11, 969, 972, 1909, 1911, 3899, 3901):
        assert not step_of(told, number, b"1").is_told, number


def test_a_step_is_asked_about_with_the_index_that_its_family_and_its_link_have():
    for family, number, index, asked in (
        (MM440, 700, 0, (700, 0, pkw.READ)),
        (MM440, 1120, 2, (1120, 2, pkw.READ)),  # its tasks take an index as they are
        (V20, 1120, 2, (1120, 2, pkw.READ_ELEMENT)),
        (V20, 1120, 0, (1120, 0, pkw.READ)),
        (MM440, 2010, 0, (2010, 0, pkw.READ)),
        (on_bop(MM440), 2010, 0, (2010, 1, pkw.READ)),
        (on_bop(MM440), 1120, 2, (1120, 2, pkw.READ)),
    ):
        told = Told(family)
        step = step_of(told, number, b"1", index)
        assert (step.number, step.index) == asked[:2]
        for has_room in (True, False):
            told.has_room = has_room
            assert step.ask(told) == has_room and told.asked.pop() == asked
        told.contact = False
        assert not step.ask(told) and told.asked == []


def test_a_step_needs_what_stands_in_the_catalogue_or_what_the_panel_knows():
    """Some are right with whatever answers, or with any time after which the drive trips."""
    bop, third, second = on_bop(MM440), Told(MM3), Told(V20)
    for told, number, needs, has, needed, is_right in (
        (Told(MM440), 700, b"5", 2, 5, False), (Told(MM440), 700, b"5", 5, 5, True),
        (Told(MM440), 1000, b"5", 4, 5, False), (Told(bop), 1000, b"5", 4, 4, True),
        (Told(bop), 700, b"5", 5, 4, False), (Told(bop), 701, b"5", 5, 5, True),
        (second, 2010, b"@baud", 0, 0, True), (second, 2011, b"@address", 31, 31, True),
        (second, 2013, b"@pkw", 4, 127, False), (second, 2013, b"@pkw", 127, 127, True),
        (second, 2014, b"@off", 0, 2_000, False), (second, 2014, b"@off", 1, 1, True),
        (third, 93, b"@off", 0, 2, False), (third, 93, b"@off", 240, 240, True),
    ):  # fmt: skip
        step = step_of(told, number, needs)
        row = number, needs, has
        assert step.needed(step.form(None, job_with(has)), has) == needed, row
        assert step.is_right(job_with(has)) == is_right, row

    class Slow(MM3):
        off_time_unit_ms = 3_000

    step = step_of(Told(Slow), 93, b"@off")
    assert step.needed(step.form(None, job_with(0)), 0) == 1  # the least that is no 0


def test_a_number_of_two_words_is_right_as_a_whole_one_or_with_a_point():
    """What the drive has says how it is meant; what is written is as the catalogue says."""
    step = step_of(Told(MM440), 1120, b"10")
    point = 0x41200000  # 10.0
    for bits, width, is_right in (
        (point, pkw.DOUBLE, True), (10, pkw.DOUBLE, True), (10, pkw.WORD, True),
        (point + 1, pkw.DOUBLE, False), (11, pkw.DOUBLE, False), (0x1000A, pkw.DOUBLE, False),
        (9, pkw.WORD, False),
    ):  # fmt: skip
        assert step.is_right(job_with(bits, width)) == is_right, (bits, width)
    row = catalogue.find("mm440", 1120)
    assert step.needed(step.form(row, job_with(0, pkw.DOUBLE)), 0) == point
    assert step.needed(step.form(row, job_with(0)), 0) == 10


def test_a_step_asks_first_where_another_value_gives_the_setpoint_another_meaning():
    for family, number, rescales in (
        (MM440, 2000, True), (MM440, 2010, False), (MM440, 1120, False), (MM3, 94, True),
        (MM3, 93, False),
    ):  # fmt: skip
        step = step_of(Told(family), number, b"?")
        assert step.rescales(5, 4) == step.rescales(4, 5) == rescales, number
        assert not step.rescales(5, 5), number


# --- the steps of a procedure by themselves ------------------------------------------------------


class Front(Told):
    """A panel, and a drive that answers at once with what it has."""

    address, pkw_words = 3, 4
    page_turns = 0
    runs = can_write = True

    def __init__(self, has):
        Told.__init__(self, MM440)
        self.announcer = self.channel = self
        self.has, self.remembered, self.did = has, {}, []
        self.runs, self.outcome, self.done = False, None, False

    def is_active(self):
        return self.runs

    def is_full(self):
        return False

    def ask(self, job):
        job.state = pkw.DONE
        if job.number in self.has:
            has = self.has[job.number]
            job.high, job.low = has >> 16, has & 0xFFFF
            job.width = pkw.DOUBLE if job.high else pkw.WORD
        else:
            job.state = pkw.UNANSWERED

    def say(self, now_ms, text, *values):
        self.did.append(texts.of(text, *values))

    def write(self, now_ms, *what):
        self.did.append(what[1:])
        return self if self.can_write else None


class Course:
    """The list of a procedure, at one of its steps."""

    def __init__(self, front, procedure=1):
        self.front, self.at = front, 0
        self.list = course.List(front, (front, procedure))
        self.turns()

    def turns(self, count=600):
        for _ in range(count):
            if self.list.is_searching():
                self.list.search()
            self.list.step(self.at, 0)

    def go_to(self, number):
        places = range(self.list.count())
        (self.at,) = [at for at in places if self.heading(at)[:5] == "P%04d" % number]
        self.turns()

    def heading(self, at=None):
        return self.list.heading(self.at if at is None else at).decode()

    def says(self):
        """What it says in turn, once each."""
        rows = []
        for self.front.page_turns in range(9):
            row = self.list.words(self.at).decode()
            if row not in rows:
                rows.append(row)
        self.front.page_turns = 0
        return rows

    def press(self, key):
        acts = Acts(Keys(NAMES, 0xFFFFF))
        acts.pressed = acts.bit(key)
        taken = self.list.take_keys(acts)
        if key == "SET" and not taken:
            self.list.choose(self.at, 0)
        return taken

    def is_written(self, done=True):
        self.front.outcome, self.front.done = (b"",), done
        self.turns()
        self.front.outcome = None


HAS = {3: 3, 10: 0, 2010: 6, 2011: 3, 2012: 2, 2013: 4, 2009: 0, 2000: 50, 700: 2, 1000: 5,
       2014: 0, 971: 0}  # fmt: skip


def test_each_step_is_asked_about_and_what_is_right_has_a_star():
    front = Front(dict(HAS))
    steps = Course(front)
    assert steps.list.count() == 13 and steps.list.control_at(0) is front
    done = [at for at in range(12) if steps.heading(at).endswith("*")]
    assert done == [0, 1, 2, 3, 4, 5, 6, 9], done  # not P2000, P0700, P2014, P0971
    steps.at = 12
    steps.turns()
    assert steps.heading() == "A3" and steps.says() == ["4 LEFT", "FIRST P2000"]
    steps.list.leave(0)
    assert front.did == [b"A3: 4 LEFT"]
    for number, says in ((700, "2 NEEDS 5"), (1000, "IS 5"), (2014, "0ms NEEDS 2000")):
        steps.go_to(number)
        assert says in steps.says(), steps.says()
    del front.has[700]
    steps.go_to(700)
    assert parameter_words.NO_REPLY_TO_IT.decode() in steps.says(), steps.says()
    steps.press("SET")
    assert len(front.did) == 1 and not steps.list.is_busy()  # what it has is not known


def test_set_asks_about_a_value_of_the_catalogue_and_writes_it_with_the_second_set():
    front = Front(dict(HAS))
    steps = Course(front)
    steps.go_to(1000)
    steps.press("SET")
    assert front.did.pop() == b"IT IS RIGHT"
    steps.go_to(700)
    front.runs = True
    steps.press("SET")
    assert front.did.pop() == b"STOP A3 FIRST" and "2 NEEDS 5" in steps.says()
    front.runs = False
    for key in ("PARAM", "STOP"):
        steps.press("SET")
        assert steps.says() == ["5 SET=YES"]
        assert steps.press("EDIT") is True and steps.says() == ["5 SET=YES"]
        assert steps.press(key) is True and "2 NEEDS 5" in steps.says()
        assert not steps.press("EDIT")  # the keys are the menu's again
    front.can_write = False
    for can_write in (False, True):
        front.can_write = can_write
        steps.press("SET")
        steps.press("SET")
        assert front.did == [(700, 0, 5, False, pkw.WORD)]
        assert steps.list.is_busy() == can_write
        front.did.clear()
    assert steps.says() == ["WRITING ..."]
    assert not steps.press("SET") and not steps.press("PARAM") and front.did == []
    front.has.update({700: 5, 2014: 100})  # to write one may change others
    steps.is_written()
    assert steps.heading() == "P0700*" and not steps.list.is_busy() and "IS 5" in steps.says()
    steps.at = 12
    steps.turns()
    assert steps.says() == ["2 LEFT", "FIRST P2000"]


def test_what_starts_something_is_done_when_it_was_written_and_stays_so_for_who_comes_back():
    front = Front(dict(HAS))
    for done, star in ((False, ""), (True, "*"), (None, "*")):
        steps = Course(front)
        steps.go_to(971)
        if done is not None:
            steps.press("SET")
            steps.press("SET")
            steps.is_written(done)
        assert steps.heading() == "P0971" + star, done
    assert front.did == [(971, 0, 1, False, pkw.WORD)] * 2


def test_what_stands_on_the_plate_is_typed_and_what_rescales_is_asked_about():
    front = Front(dict(HAS))
    steps = Course(front)
    steps.go_to(2000)
    steps.press("SET")
    for key, row in (
        (None, "05[0]"), ("UP", "05[1]"), ("PREVIOUS", "0[5]1"), ("DOWN", "0[4]1"),
        ("UP", "0[5]1"), ("NEXT", "05[1]"), ("NEXT", "[0]51"), ("PREVIOUS", "05[1]"),
    ):  # fmt: skip
        assert key is None or steps.press(key) is True
        assert steps.says() == [row], (key, steps.says())
    steps.press("SET")
    assert steps.says()[0].endswith(" SET=YES") and "RESCALES SPEED" in steps.says()
    assert front.did == []
    steps.press("SET")
    assert front.did == [(2000, 0, 51, False, pkw.WORD)] and steps.says() == ["WRITING ..."]
    steps.is_written()
    assert steps.heading() == "P2000*"
    front.did.clear()
    steps.press("SET")  # it may be typed again; what is as it was asks nothing
    steps.press("SET")
    assert front.did == [(2000, 0, 50, False, pkw.WORD)]


def test_a_value_is_read_typed_and_asked_about_with_all_its_bits():
    """The places that its unit and its decimals have are those of the catalogue."""
    for has, reads, types, asks, writes, width in (
        (50_000, "IS 50000Hz", "5000[0]", "50001Hz", 50_001, pkw.WORD),
        (0x42480000, "IS 50.00Hz", "05[0].00", "51.00Hz", 0x424C0000, pkw.DOUBLE),
        (0x4248CCCD, "IS 50.20Hz", "05[0].20", "51.20Hz", 0x424CCCCD, pkw.DOUBLE),
    ):
        front = Front(dict(HAS))
        front.has[2000] = has
        steps = Course(front)
        steps.go_to(2000)
        assert reads in steps.says(), steps.says()
        steps.press("SET")
        assert steps.says() == [types], steps.says()
        steps.press("UP")
        steps.press("SET")
        assert steps.says() == [asks + " SET=YES", "RESCALES SPEED"], steps.says()
        steps.press("SET")
        assert front.did == [(2000, 0, writes, False, width)], front.did
