# SPDX-License-Identifier: MIT
"""The bus master and the simulated drives, which share no code: every task, family and layout.

What one of them has misread of the specification shows here against the other.
"""

from boards.sim.drives.families import g110, g120, generic, mm3, mm420, mm440, v20
from fleet_bench import Fleet
from uss import pkw
from uss.layout import VARIABLE
from uss.tasks import arrays, texts
from uss.tasks.change_reports import Reports
from uss.tasks.descriptions import DEFAULT, FLOAT, NAME, UPPER_LIMIT, read_description

FAMILIES = (generic, mm3, mm420, mm440, g110, v20, g120)


class Line(Fleet):
    """A master, its `drive`, and the simulated one, `motor`, of a kind: arguments of `Drive`."""

    def __init__(self, **kind):
        Fleet.__init__(self, {5: kind})
        self.motor, self.drive = self.motors[5], self.drives[5]
        self.run(400)
        assert self.drive.contact

    def do(self, job):
        """Ask, and wait for the end of it: the job."""
        self.drive.ask(job)
        self.run_until(lambda: job.state != pkw.PENDING)
        return job

    def done(self, job):
        assert self.do(job).state == pkw.DONE, (job, job.error)
        return job

    def refused(self, job):
        assert self.do(job).state == pkw.REFUSED, job
        return job.error

    def settle(self, hz):
        """Wait until the motor turns at so many Hz, and the master has heard of it."""
        self.run_until(lambda: self.motor.hz() == hz)
        self.run(200)

    def check(self):
        Fleet.check(self)
        assert not any(self.drive.counters[1:]), self.drive.counters


def kind_of(family, pkw_words, pzd_words=2, **more):
    """A drive of this layout, if its family can be set to one."""
    link = family.LINK
    parameters = {link["off time"]: 0}
    if link["layout"] is None:
        parameters[link["pkw words"]] = pkw_words
        parameters[link["pzd words"]] = pzd_words
    more.update(family=family, parameters=parameters)
    return more


def test_each_family_is_run_both_ways_as_its_data_say():
    for simulated in FAMILIES:
        line = Line(family=simulated, parameters={simulated.LINK["off time"]: 0})
        family = line.family(5)
        assert line.motor.layout == (family.layout.pkw_words, family.layout.pzd_words)
        if not family.hiw_is_signed:
            line.drive.tell_speed(0)  # or its way through zero would pass for a standstill
        line.drive.start(0x2000, family.on)
        line.settle(25)
        if family.on_reverse:
            line.drive.turn(family.on_reverse)
        else:
            line.drive.hsw = 0xE000
        line.settle(-25)
        hiw = line.drive.word(2)
        assert hiw == (0xE000 if family.hiw_is_signed else 0x2000), family.name
        assert not line.drive.word(1) & 0x4000
        line.drive.stop()
        line.settle(0)
        assert line.motor.state == "ready" and line.motor.starts == 1
        line.check()


def test_the_numbers_that_a_family_names_are_there():
    for simulated in FAMILIES:
        line = Line(family=simulated, parameters={simulated.LINK["off time"]: 0})
        family = line.family(5)
        # Of a parameter that may be missing, the family says what that means.
        numbers = [row[0] for row in family.survey if row and row[3] is None]
        numbers += [family.baud_number, family.address_number, family.off_time_number]
        numbers += [family.fault_number]
        for number in numbers:
            if number is not None:
                line.done(pkw.read(number))
        if family.address_number is not None:
            assert line.done(pkw.read(family.address_number)).integer_value() == 5
            code = line.done(pkw.read(family.baud_number)).integer_value()
            assert family.baud_codes[code] == 19200
        line.check()


def test_values_of_every_width_in_every_layout():
    for simulated in (mm420, mm440, g120, generic):
        for pkw_words in (3, 4, VARIABLE):
            line = Line(**kind_of(simulated, pkw_words))
            address = simulated.LINK["address"]
            assert line.done(pkw.read(address)).integer_value() == 5
            if pkw_words == 3:
                assert line.refused(pkw.read(1120)) == 102
                assert line.refused(pkw.write_float(1120, 5.0)) == 102
            else:
                assert line.done(pkw.read(1120)).float_value() == 10.0
                assert line.done(pkw.write_float(1120, 5.5)).float_value() == 5.5
                assert line.motor.read(1120) == 5.5
                assert line.done(pkw.write_float(1121, 6.5, eeprom=True)).float_value() == 6.5
                assert line.motor.eeprom_writes == 1
                assert line.refused(pkw.write_float(1120, -1.0)) == 2
            assert line.refused(pkw.write_word(52, 1)) == 1
            assert line.refused(pkw.read(1)) == 0
            line.check()


def test_arrays():
    for simulated, first in ((mm440, 0), (generic, 1)):
        for pkw_words in (3, 4, VARIABLE):
            line = Line(**kind_of(simulated, pkw_words, 4))
            assert line.done(arrays.count_elements(2010)).integer_value() == 2
            job = arrays.write_element_word(2010, first + 1, 8)
            assert line.done(job).integer_value() == 8
            assert line.done(arrays.read_element(2010, first + 1)).integer_value() == 8
            job = arrays.write_element_word(2010, first + 1, 6, eeprom=True)
            assert line.done(job).integer_value() == 6 and line.motor.eeprom_writes == 1
            assert line.refused(arrays.read_element(2010, first + 2)) == 3
            if pkw_words == 3:
                continue
            job = arrays.write_element_double(2019, first + 2, 20 << 16)
            assert line.done(job).integer_value() == 20 << 16
            assert line.motor.read(2019, 2) == 20 << 16
            line.check()


def test_all_elements_at_once():
    line = Line(**kind_of(generic, VARIABLE, 4))
    assert line.done(arrays.read_all(9)).integer_values() == [5, 5, 5]
    assert line.done(arrays.write_all_words(9, (1, 2, 3))).integer_values() == [1, 2, 3]
    assert line.done(arrays.read_all(4)).integer_values() == [1, 2, 3, 4]
    line.done(arrays.write_all_doubles(4, (1 << 31, 2, 3, 4), eeprom=True))
    assert line.motor.read(4) == 1 << 31 and line.motor.eeprom_writes == 4
    assert len(line.done(arrays.read_all(2019)).integer_values()) == 16
    assert line.refused(arrays.write_all_words(9, (1, 2))) == 108
    line.check()


def test_browsing_by_what_comes_with_an_error():
    line = Line(**kind_of(generic, VARIABLE))
    job = pkw.read(8)
    assert line.refused(job) == 0 and (job.next, job.previous) == (9, 7)
    job = pkw.write_word(2011, 40)
    assert line.refused(job) == 2 and (job.next, job.previous) == (31, 31)
    line = Line(**kind_of(mm440, VARIABLE))
    numbers, number = [], 0
    while True:
        job = line.do(pkw.read(number))
        if job.state == pkw.DONE:
            numbers.append(number)
            number += 1
        elif job.next:
            number = job.next
        else:
            break
    assert numbers == [row[0] for row in mm440.ROWS]
    line.check()


def test_descriptions():
    line = Line(**kind_of(generic, VARIABLE))
    whole = line.done(read_description(1120)).description()
    assert (whole.name, whole.lower, whole.upper) == ("ramp-up time", 0.0, 650.0)
    assert whole.data_type() == FLOAT and whole.elements == 1
    assert whole.factor == 1.0
    signed = line.done(read_description(19)).description()
    assert (signed.lower, signed.upper) == (-1000, 1000)
    upper = line.done(read_description(2011, UPPER_LIMIT)).description()
    assert upper.upper == 31 and upper.default is None
    default = line.done(read_description(2010, DEFAULT)).description()
    assert default.default == 6 and default.name is None
    assert line.refused(read_description(1)) == 0
    for pkw_words in (3, 4):
        line = Line(**kind_of(generic, pkw_words))
        job = read_description(18, UPPER_LIMIT)
        assert line.done(job).description().upper == 0xFFFF
        assert line.refused(read_description(18)) == 102
    line = Line(**kind_of(mm440, 4))
    job = read_description(1120, UPPER_LIMIT)
    assert line.done(job).description().upper is not None
    assert line.refused(read_description(1120, NAME)) == 9


def test_texts():
    line = Line(**kind_of(generic, VARIABLE))
    assert line.done(texts.read_text(7, 3)).text() == "300 BAUD"
    assert line.done(texts.read_text(9, 4, field=2)).text() == "1200 BAUD"
    assert line.done(texts.write_text(9, 2, "THE SECOND ONE")).text() == "THE SECOND ONE"
    assert line.done(texts.read_text(9, 2)).text() == "THE SECOND ONE"
    assert line.refused(texts.read_text(18, 1)) == 15
    line.check()


def test_change_reports():
    for pkw_words in (3, 4, VARIABLE):
        line = Line(**kind_of(generic, pkw_words, reports=True))
        reports = Reports(line.drive.channel)
        line.run(100)
        line.motor.write(7, 0, 3)
        line.motor.write(2011, 1, 9)
        line.motor.write(1120, 0, 2.5)
        line.run(600)
        found = [reports.get() for _ in range(4)]
        places = [(report.number, report.index) for report in found[:3]]
        assert places == [(7, 0), (2011, 2), (1120, 0)]
        assert found[3] is None
        assert [report.integer_value() for report in found[:2]] == [3, 9]
        if pkw_words == 3:
            assert not found[2].width
        else:
            assert found[2].float_value() == 2.5
        assert line.done(pkw.read(7)).integer_value() == 3  # and tasks go on
        line.check()


def test_each_of_many_changes_is_reported_once_while_parameters_are_read():
    line = Line(**kind_of(generic, 4, reports=True))
    reports = Reports(line.drive.channel)
    line.run(100)
    for value in range(10):
        line.motor.write(18, 0, 100 + value)
        assert line.done(pkw.read(700)).integer_value() == 5
        line.run(200)
        report = reports.get()
        assert (report.number, report.integer_value()) == (18, 100 + value)
        assert reports.get() is None
    line.check()


def test_stale_replies_and_standing_tasks():
    """However late a drive answers, and however often it does what stands there: once."""
    for stale in (0, 1, 5):
        for reexecute in (False, True):
            for pkw_words in (3, 4, VARIABLE):
                line = Line(**kind_of(mm440, pkw_words))
                line.motor.stale_replies = stale
                line.motor.reexecute = reexecute
                assert line.done(pkw.read(700)).integer_value() == 5
                for value in (7, 8, 8):
                    job = pkw.write_word(2010, value, index=1, eeprom=True)
                    assert line.done(job).integer_value() == value
                line.run(500)
                assert line.motor.eeprom_writes == 3, (stale, reexecute, pkw_words)
