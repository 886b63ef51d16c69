"""Every parameter task against the simulated drive that knows them all, over line and interrupts.

The simulated chip locks the heap while an interrupt runs: whatever takes memory there, fails.
"""

from boards.sim import generic
from boards.sim.board import HardTimer
from boards.sim.chip import UART, Chip, Pin
from boards.sim.clock import Clock
from boards.sim.drive import Drive
from boards.sim.wire import Transceiver, Wire
from hal.pacer import Pacer
from hal.rs485 import Rs485Link
from uss import pkw, pkw_array, pkw_text
from uss.layout import VARIABLE, Layout
from uss.master import Master
from uss.timing import Timing

BAUD = 38400
PZD_WORDS = 2


class Bench:
    """A drive, `motor`, with so many PKW words, and the master's `drive` before it."""

    def __init__(self, pkw_words=VARIABLE, reports=False):
        self.clock = clock = Clock()
        wire = Wire(clock, BAUD)
        self.chip = chip = Chip(clock, wire)
        parameters = {2013: pkw_words, 2012: PZD_WORDS}
        self.motor = Drive(
            clock, wire, 1, parameters, family=generic, any_baud=True, reports=reports
        )
        uart = UART(chip, BAUD)
        driver_enable = Pin(chip)
        Transceiver(wire, uart, driver_enable)
        link = Rs485Link(uart, driver_enable, HardTimer(chip), clock, BAUD, True)
        self.master = Master(link, Timing(BAUD), clock.ticks_mask)
        self.drive = self.master.add(1, Layout(pkw_words, PZD_WORDS))
        self.pacer = Pacer(self.master, link, clock, HardTimer(chip))
        self.pacer.start()
        self.run(400)

    def run(self, ms):
        for _ in range(ms // 2):
            self.master.refresh(self.clock.ticks_us())
            self.pacer.tend()
            self.clock.advance(2_000)
        assert self.master.failures == 0 and not self.chip.handler_errors

    def answered(self, job):
        """The job when it has ended."""
        self.drive.ask(job)
        while job.state == pkw.PENDING:
            self.run(2)
        return job


def test_each_length_reads_and_writes_words_and_elements():
    for pkw_words in (3, 4, VARIABLE):
        bench = Bench(pkw_words)
        answered = bench.answered
        assert answered(pkw.write_word(18, 0x7000)).state == pkw.DONE
        assert answered(pkw.read(18)).integer_value() == 0x7000
        assert answered(pkw.read(19)).signed_value() == -1
        assert answered(pkw.write_word(19, -500)).signed_value() == -500
        assert answered(pkw_array.write_element_word(9, 2, 7)).state == pkw.DONE
        assert answered(pkw_array.read_element(9, 2)).integer_value() == 7
        assert answered(pkw_array.count_elements(9)).integer_value() == 3
        assert answered(pkw.write_word(18, 1, eeprom=True)).state == pkw.DONE
        bench.run(100)
        assert bench.motor.eeprom_writes == 1
        refusal = answered(pkw.read(1999))
        assert (refusal.state, refusal.error) == (pkw.REFUSED, 0), pkw_words


def test_a_drive_that_carries_out_a_standing_write_again_and_again_writes_its_eeprom_once():
    for pkw_words in (3, 4, VARIABLE):
        bench = Bench(pkw_words)
        bench.motor.reexecute = True
        for count in (1, 2):
            job = bench.answered(pkw.write_word(18, 7, eeprom=True))
            bench.run(300)
            assert job.state == pkw.DONE and bench.motor.eeprom_writes == count


def test_double_words_and_floats():
    for pkw_words in (4, VARIABLE):
        answered = Bench(pkw_words).answered
        assert answered(pkw.write_float(1120, 7.5)).float_value() == 7.5
        assert answered(pkw_array.write_element_double(4, 2, 0x40000000)).state == pkw.DONE
        assert answered(pkw_array.read_element(4, 2)).integer_value() == 0x40000000
    refusal = Bench(3).answered(pkw.read(1120))
    assert refusal.state == pkw.REFUSED and refusal.error == 102


def test_whole_arrays():
    answered = Bench().answered
    assert answered(pkw_array.read_all(4)).values == [1, 2, 3, 4]
    assert answered(pkw_array.write_all_doubles(4, (5, 6, 7, 8))).values == [5, 6, 7, 8]
    assert answered(pkw_array.write_all_words(9, (1, 2, 3), True)).values == [1, 2, 3]
    assert answered(pkw_array.read_all(9)).values == [1, 2, 3]
    assert answered(pkw_array.write_all_words(9, (1, 2))).error == 108


def test_what_the_drive_offers_instead():
    answered = Bench().answered
    job = answered(pkw.read(5))
    assert (job.error, job.next, job.previous) == (0, 7, 4)
    job = answered(pkw.write_word(19, 2000))
    assert (job.error, job.next, job.previous) == (2, 1000, 1000)


def test_descriptions():
    answered = Bench().answered
    description = answered(pkw_text.read_description(1120)).description()
    assert description.name == "ramp-up time" and description.data_type() == pkw_text.FLOAT
    assert (description.lower, description.upper, description.factor) == (0.0, 650.0, 1.0)
    description = answered(pkw_text.read_description(19)).description()
    assert (description.lower, description.upper) == (-1000, 1000)
    description = answered(pkw_text.read_description(2010, pkw_text.DEFAULT)).description()
    assert description.default == 6 and description.name is None
    for pkw_words in (3, 4):
        answered = Bench(pkw_words).answered
        job = answered(pkw_text.read_description(18, pkw_text.UPPER_LIMIT))
        assert job.description().upper == 0xFFFF, pkw_words
        assert answered(pkw_text.read_description(18)).error == 102


def test_texts():
    answered = Bench().answered
    assert answered(pkw_text.read_text(7, 3)).text == "300 BAUD"
    assert answered(pkw_text.write_text(9, 2, "SECOND")).text == "SECOND"
    assert answered(pkw_text.read_text(9, 2)).text == "SECOND"
    assert answered(pkw_text.read_text(9, 4, field=2)).text == "1200 BAUD"


def test_changes_made_by_somebody_else():
    """Ten changes, while parameters are read: each is told once, no answer is lost."""
    bench = Bench(4, reports=True)
    reports = pkw_text.Reports(bench.drive.channel)
    bench.run(100)
    for value in range(10):
        bench.motor.write(18, 0, 100 + value)
        assert bench.answered(pkw.read(700)).integer_value() == 5
        bench.run(200)
        report = reports.get()
        assert (report.number, report.integer_value()) == (18, 100 + value)
        assert reports.get() is None
