# SPDX-License-Identifier: MIT
"""The RS-485 link on the simulated chip: sends, hears, and lets go of the line in time."""

from boards.sim.board import HardTimer, clear_fifo
from boards.sim.chip.machine import UART, Chip, Pin
from boards.sim.clock import Clock
from boards.sim.line.wire import Transceiver, Wire
from hal.link.rp2_check import DRIVER, LINE, find
from hal.link.rp2_check import UART as UART_DEFECT
from hal.link.rs485 import Rs485Link
from hal.link.self_directed import SelfDirectedLink

COMING = -1
RATES = (300, 600, 1200, 2400, 4800, 9600, 19200, 38400, 57600, 76800, 93750, 115200, 187500)
REQUEST = bytes((0x02, 0x0E, 0x01, 0, 0, 0, 0, 0, 0, 0, 0, 0x04, 0x7E, 0, 0, 0x77))


class Neighbour:
    """Another station: keeps what it hears."""

    name = "neighbour"

    def __init__(self, wire):
        self.heard = []
        self.wire = wire
        wire.attach(self)

    def hear(self, burst):
        self.heard.append((burst.start_us, burst.end_us, bytes(burst.data[: burst.count])))


class Bench:
    """A link on a chip, and a neighbour on the line."""

    def __init__(self, baud=19200, interrupts=True, timeout_again=False, ticks_start=0):
        self.clock = Clock(ticks_start)
        self.wire = Wire(self.clock, baud)
        self.chip = Chip(self.clock, self.wire, timeout_again)
        self.driver_enable = Pin(self.chip)
        self.uart = UART(self.chip, baud)
        Transceiver(self.wire, self.uart, self.driver_enable)
        timer = HardTimer(self.chip)
        fifo = (self.uart.fifo_holds, clear_fifo)
        self.link = Rs485Link(
            self.uart, self.driver_enable, timer, self.clock, baud, interrupts, fifo=fifo
        )
        self.neighbour = Neighbour(self.wire)
        self.activities = []
        self.link.on_activity = self.note
        self.clock.advance(100_000)

    def note(self):
        self.activities.append(self.clock.now_us)

    def check(self):
        assert self.wire.violations() == [] and self.chip.handler_errors == []


def test_what_is_sent_arrives_at_every_rate_and_the_line_is_free_in_time():
    """The referee of the line allows the driver one character after the last stop bit."""
    for baud in RATES:
        bench = Bench(baud)
        began_us = bench.clock.now_us
        bench.link.send(REQUEST, len(REQUEST))
        assert bench.driver_enable.value() == 1
        bench.clock.advance(-(-11_000_000 * 17 // baud))
        assert bench.driver_enable.value() == 0
        start_us, end_us, heard = bench.neighbour.heard[0]
        assert heard == REQUEST and start_us == began_us
        assert 0 <= bench.link.sent_at - end_us <= bench.wire.character_us // 2
        assert bench.link.late_releases == 0
        assert len(bench.activities) == 1  # sending has ended
        bench.check()


def test_only_the_first_characters_of_a_longer_buffer_are_sent():
    bench = Bench()
    bench.link.send(REQUEST + bytes(240), len(REQUEST))
    bench.clock.advance(20_000)
    assert bench.neighbour.heard[0][2] == REQUEST
    bench.check()


def test_sending_us_counts_down_to_zero():
    """Also where the counter of the clock begins anew meanwhile."""
    for ticks_start in (0, -104_500):
        bench = Bench(ticks_start=ticks_start)
        assert bench.link.sending_us(bench.clock.ticks_us()) == 0
        bench.link.send(REQUEST, len(REQUEST))
        left = []
        for _ in range(12):
            left.append(bench.link.sending_us(bench.clock.ticks_us()))
            bench.clock.advance(1_000)
        assert left == list(range(9167, 0, -1_000)) + [0, 0]
        bench.check()


def test_whoever_looked_at_the_clock_before_the_sending_began_has_all_of_it_before_him():
    bench = Bench()
    before_us = bench.clock.ticks_us() - 50
    bench.link.send(REQUEST, len(REQUEST))
    assert bench.link.sending_us(before_us) == 9167


def test_a_burst_is_announced_and_its_end_known():
    bench = Bench()
    burst = bench.wire.talk(bench.neighbour, REQUEST, len(REQUEST))
    bench.clock.advance(20_000)
    assert len(bench.activities) == 1
    assert bench.activities[0] - burst.end_us <= 32 * 1_000_000 // 19200 + 2
    buffer = bytearray(260)
    assert bench.link.receive(buffer, 0) == 16
    assert bytes(buffer[:16]) == REQUEST
    assert 0 <= bench.link.received_at - burst.end_us <= 2
    assert bench.link.receive(buffer, 16) == 0
    bench.check()


def test_a_burst_before_anybody_wants_to_know_is_kept():
    bench = Bench()
    clock, wire = bench.clock, bench.wire
    uart, timer = bench.uart, HardTimer(bench.chip)
    link = Rs485Link(uart, bench.driver_enable, timer, clock, 19200)
    wire.talk(bench.neighbour, REQUEST, len(REQUEST))
    clock.advance(20_000)
    assert link.receive(bytearray(260), 0) == 16
    bench.check()


def test_in_the_middle_of_a_burst_nothing_is_taken():
    """To look would use up the interrupt that announces its end."""
    bench = Bench()
    bench.wire.talk(bench.neighbour, REQUEST, len(REQUEST))
    for _ in range(8):
        bench.clock.advance(1_100)
        assert bench.link.receive(bytearray(260), 0) == COMING
    bench.clock.advance(20_000)
    assert len(bench.activities) == 1
    assert bench.link.receive(bytearray(260), 0) == 16
    bench.check()


def fill(bench):
    """More characters than the receiver holds."""
    for _ in range(2):
        bench.wire.talk(bench.neighbour, bytes(200), 200)
        bench.clock.advance(200 * bench.wire.character_us)
    bench.clock.advance(100_000)


def test_characters_whose_end_is_not_announced_are_taken_after_128_characters():
    bench = Bench(115200)
    bench.uart.irq(None)  # nobody hears the only time-out of a full receiver
    fill(bench)
    character_us = bench.wire.character_us
    buffer = bytearray(264)
    for waiting in (256, 32):
        assert bench.link.receive(buffer, 0) == COMING
        bench.clock.advance(127 * character_us)
        assert bench.link.receive(buffer, 0) == COMING
        bench.clock.advance(2 * character_us)
        assert bench.link.receive(buffer, 0) == waiting
    assert bench.link.receive(buffer, 0) == 0


def test_what_finds_no_room_in_a_full_receiver_is_dropped():
    """Also before anybody takes anything: the chip would not leave its interrupt handler."""
    for timeout_again in (False, True):
        bench = Bench(115200, timeout_again=timeout_again)
        fill(bench)
        assert len(bench.activities) <= 2 and not bench.chip.storms
        buffer = bytearray(264)
        assert bench.link.receive(buffer, 0) == 256
        assert bench.link.receive(buffer, 0) == 0
        bench.wire.talk(bench.neighbour, REQUEST, len(REQUEST))
        bench.clock.advance(20_000)
        assert bench.link.receive(buffer, 0) == 16 and buffer[:16] == REQUEST
        assert bench.chip.handler_errors == []


def test_a_burst_may_be_taken_in_pieces():
    bench = Bench(interrupts=False)
    burst = bench.wire.talk(bench.neighbour, REQUEST, len(REQUEST))
    buffer = bytearray(260)
    count = 0
    while bench.clock.now_us < burst.end_us + 1_000:
        bench.clock.advance(700)
        came = bench.link.receive(buffer, count)
        if came:
            late_us = bench.clock.now_us - bench.link.received_at
            assert 0 <= late_us <= bench.link.resolution_us
        count += came
    assert count == 16 and bytes(buffer[:16]) == REQUEST
    assert bench.activities == []
    bench.check()


def test_more_than_there_is_room_for_waits():
    bench = Bench(interrupts=False)
    bench.wire.talk(bench.neighbour, bytes(range(200)), 200)
    bench.clock.advance(200_000)
    small = bytearray(30)
    received = b""
    while True:
        came = bench.link.receive(small, 10)
        if not came:
            break
        received += bytes(small[10 : 10 + came])
    assert received == bytes(range(200))


def test_the_panel_does_not_hear_itself():
    bench = Bench()
    bench.link.send(REQUEST, len(REQUEST))
    bench.clock.advance(30_000)
    assert bench.link.receive(bytearray(64), 0) == 0
    bench.check()


def test_a_transmitter_that_is_a_little_slow_is_waited_for():
    """A quarter of a character at a time: the last stop bit is never cut. Also after one that
    was given up."""
    for given_up in (False, True):
        bench = Bench()
        if given_up:
            bench.uart.txdone = lambda: False
            bench.link.send(REQUEST, len(REQUEST))
            bench.clock.advance(30_000)
        answers = [False, False, True]
        bench.uart.txdone = lambda answers=answers: answers.pop(0)
        bench.link.send(REQUEST, len(REQUEST))
        bench.clock.advance(9167 + 10)
        assert bench.driver_enable.value() == 1
        assert bench.link.sending_us(bench.clock.ticks_us()) == 1
        bench.clock.advance(bench.wire.character_us * 3 // 4)
        assert bench.driver_enable.value() == 0 and answers == []
        assert bench.link.late_releases == given_up


def test_a_transmitter_that_never_ends_does_not_keep_the_line():
    bench = Bench()
    bench.uart.txdone = lambda: False
    bench.link.send(REQUEST, len(REQUEST))
    look_us = bench.wire.character_us // 4 + 1
    bench.clock.advance(9167 + 16 * look_us - 10)  # four characters more
    assert bench.driver_enable.value() == 1
    assert bench.link.late_releases == 0
    bench.clock.advance(20)
    assert bench.driver_enable.value() == 0
    assert bench.link.late_releases == 1
    assert bench.link.sending_us(bench.clock.ticks_us()) == 0
    for before, after in ((1, 2), (0xFFFE, 0xFFFF), (0xFFFF, 0)):
        bench.link.late_releases = before
        bench.link.send(REQUEST, len(REQUEST))
        bench.clock.advance(20_000)
        assert bench.link.late_releases == after


def test_the_end_of_a_burst_is_a_hard_interrupt_where_the_port_has_those():
    for options, wanted in (({}, [True]), ({"hard": False}, [False]), ({"interrupts": False}, [])):
        bench = Bench()
        asked = []
        bench.uart.irq = lambda handler, trigger, hard: asked.append(hard)
        timer = HardTimer(bench.chip)
        Rs485Link(bench.uart, bench.driver_enable, timer, bench.clock, 19200, **options)
        assert asked == wanted, options


def test_the_driver_is_off_before_anything_is_sent():
    clock = Clock()
    chip = Chip(clock, Wire(clock, 19200))
    driver_enable = Pin(chip, value=1)  # left on by somebody
    Rs485Link(UART(chip, 19200), driver_enable, HardTimer(chip), clock, 19200)
    assert driver_enable.value() == 0


def test_a_burst_that_somebody_drained_does_not_date_the_next_one():
    """Whether somebody looks meanwhile, or a request is sent."""
    for sends in (False, True):
        bench = Bench()
        bench.wire.talk(bench.neighbour, REQUEST, len(REQUEST))
        bench.clock.advance(20_000)
        bench.uart.readinto(bytearray(32))
        if sends:
            bench.link.send(REQUEST, len(REQUEST))
            bench.clock.advance(12_000)
        else:
            assert bench.link.receive(bytearray(260), 0) == 0
        burst = bench.wire.talk(bench.neighbour, REQUEST, len(REQUEST))
        bench.clock.advance(9_300)  # before the interrupt that ends it
        assert bench.link.receive(bytearray(260), 0) == COMING
        bench.clock.advance(2_000)
        assert bench.link.receive(bytearray(260), 0) == 16
        assert 0 <= bench.link.received_at - burst.end_us <= 2


def test_a_burst_that_somebody_drained_while_it_came_does_not_end_the_next_one():
    bench = Bench()
    bench.wire.talk(bench.neighbour, REQUEST, 2)
    bench.clock.advance(1_100)
    assert bench.link.receive(bytearray(260), 0) == COMING
    bench.clock.advance(200)
    bench.uart.readinto(bytearray(32))
    assert bench.link.receive(bytearray(260), 0) == 0
    bench.clock.advance(200_000)
    bench.wire.talk(bench.neighbour, REQUEST, len(REQUEST))
    bench.clock.advance(5_000)
    for _ in range(2):
        assert bench.link.receive(bytearray(260), 0) == COMING


def test_how_late_a_link_may_notice_a_burst_is_said():
    """Without interrupts as late as somebody may look; else 32 bits after it, at any rate."""
    for baud, late_us in ((9600, 3_333), (19200, 1_666), (187500, 170)):
        assert Bench(baud).link.resolution_us == late_us
        assert Bench(baud, interrupts=False).link.resolution_us == 5_000


def test_the_longest_telegram_is_delivered_whole():
    bench = Bench()
    bench.wire.talk(bench.neighbour, bytes(256), 256)
    bench.clock.advance(160_000)
    buffer = bytearray(264)
    assert bench.link.receive(buffer, 2) == 256
    bench.check()


def test_a_closed_link_is_quiet():
    bench = Bench()
    bench.link.send(REQUEST, len(REQUEST))
    bench.clock.advance(30_000)
    bench.link.close()
    bench.wire.talk(bench.neighbour, REQUEST, len(REQUEST))
    activities = len(bench.activities)
    bench.clock.advance(50_000)
    assert len(bench.activities) == activities and bench.driver_enable.value() == 0
    bench.check()


def test_a_link_that_is_closed_while_it_sends_lets_go_at_once():
    for interrupts in (True, False):
        bench = Bench(interrupts=interrupts)
        calls = []
        bench.uart.irq = lambda handler, trigger, calls=calls: calls.append((handler, trigger))
        bench.link.send(REQUEST, len(REQUEST))
        bench.clock.advance(3_000)
        assert bench.driver_enable.value() == 1
        bench.link.close()
        assert bench.driver_enable.value() == 0
        assert bench.link.sending_us(bench.clock.ticks_us()) == 0
        assert calls == ([(None, 0)] if interrupts else [])
        assert bench.uart.write(REQUEST, 16) is None  # it is off
        bench.clock.advance(50_000)
        assert bench.activities == [] and bench.link.sent_at == 0  # no timer comes


def test_the_longest_telegram_is_sent_whole():
    bench = Bench()
    bench.link.send(bytes(range(256)), 256)
    assert bench.link.sending_us(bench.clock.ticks_us()) == 146_667
    bench.clock.advance(146_600)
    assert bench.driver_enable.value() == 1
    bench.clock.advance(5_000)
    assert bench.driver_enable.value() == 0
    assert bench.neighbour.heard[0][2] == bytes(range(256))
    bench.check()


# --- a transceiver that finds its direction ------------------------------------------------------


class SelfDirectedUart:
    """What a link without a driver enable asks of the UART. done: whether the last stop bit has
    left."""

    IRQ_RXIDLE = 1

    def __init__(self):
        self.sent = []
        self.heard = b""
        self.done = False
        self.handler = None
        self.is_on = True

    def irq(self, handler, trigger, hard=False):
        assert not hard
        self.handler = handler if trigger else None

    def write(self, buffer, count):
        self.sent.append(bytes(buffer[:count]))

    def txdone(self):
        return self.done

    def any(self):
        return len(self.heard)

    def readinto(self, buffer, count):
        buffer[:count] = self.heard[:count]
        self.heard = self.heard[count:]
        return count

    def deinit(self):
        self.is_on = False


def self_directed(ticks_start=0):
    clock = Clock(ticks_start)
    uart = SelfDirectedUart()
    return SelfDirectedLink(uart, clock, 19200, 1_250, 14_000), uart, clock


def test_a_line_that_finds_its_direction_is_busy_until_the_last_stop_bit():
    """Also where the counter of the clock begins anew; the UART may be a little slow."""
    for ticks_start in (0, -4_000):
        link, uart, clock = self_directed(ticks_start)
        assert link.sending_us(clock.ticks_us()) == 0
        link.send(REQUEST + bytes(9), len(REQUEST))
        assert uart.sent == [REQUEST]
        assert link.sent_at == clock.ticks_us() + 9167 & clock.ticks_mask
        before_us = clock.ticks_us() - 50 & clock.ticks_mask
        assert link.sending_us(before_us) == 9167
        for passed_us, left_us in ((0, 9167), (5_000, 4167), (9_166, 1), (9_167, 1), (9_500, 1)):
            clock.advance(passed_us - clock.now_us)
            assert link.sending_us(clock.ticks_us()) == left_us, (ticks_start, passed_us)
        uart.done = True
        assert link.sending_us(clock.ticks_us()) == 0
        clock.advance(600_000_000)  # the counter goes round
        assert link.sending_us(clock.ticks_us()) == 0


def test_how_late_a_line_that_finds_its_direction_may_notice_a_burst_is_said():
    """1.25 ms at the least after its end, and 14 ms more at the most."""
    link, uart, clock = self_directed()
    assert link.resolution_us == 1_250 + 14_000
    calls = []
    link.on_activity = lambda: calls.append(clock.ticks_us())
    clock.advance(50_000)
    uart.heard = REQUEST
    uart.handler(uart)
    assert calls == [50_000] and link.receive(bytearray(260), 0) == len(REQUEST)
    assert link.received_at == 50_000 - 1_250


def test_what_was_heard_before_a_request_does_not_date_the_reply():
    link, uart, clock = self_directed()
    clock.advance(100_000)
    uart.handler(uart)  # of noise, which somebody has taken
    clock.advance(5_000)
    link.send(REQUEST, len(REQUEST))
    clock.advance(20_000)
    uart.heard = REQUEST  # it has come, and is not announced yet
    buffer = bytearray(260)
    assert link.receive(buffer, 0) == 16 and bytes(buffer[:16]) == REQUEST
    assert link.received_at == clock.ticks_us()


def test_a_line_that_finds_its_direction_takes_the_longest_telegram_both_ways():
    """What comes may be taken in pieces. When it will have sent all of it is known beforehand."""
    longest = bytes(range(256))
    link, uart, clock = self_directed()
    link.send(longest, 256)
    assert link.foreseen and link.sent_at == 146_667 and uart.sent == [longest]
    buffer = bytearray(260)
    at = 0
    for count in (1, 6, 200, 49):
        uart.heard = longest[at : at + count]
        assert link.receive(buffer, at) == count
        at += count
    assert bytes(buffer[:256]) == longest and link.receive(buffer, at) == 0


def test_a_line_that_finds_its_direction_is_let_go_of_as_a_whole():
    link, uart, clock = self_directed()
    assert uart.handler
    link.send(REQUEST, len(REQUEST))
    link.close()
    assert uart.handler is None and not uart.is_on
    assert link.sending_us(clock.ticks_us()) == 0


# --- what a board finds wrong with its bus -------------------------------------------------------

UART_AT = 0x40038000
DATA, FLAGS, WHOLE, FRACTION, FORMAT, CONTROL, MASK, CLEAR = (
    0x00, 0x18, 0x24, 0x28, 0x2C, 0x30, 0x38, 0x44,
)  # fmt: skip
OPEN = {WHOLE: 406, FRACTION: 16, FORMAT: 0x76, CONTROL: 0x301, MASK: 0x50, CLEAR: 0}


class Pl011:
    """The registers of an open UART. waiting: characters in its FIFO. busy: it sends for so many
    looks at its flags. spoil(character): what comes back of it in loopback; None for nothing."""

    def __init__(self, waiting=0, busy=3, spoil=lambda character: character):
        self.registers = dict(OPEN)
        self.fifo = [0xA5] * waiting
        self.written = []
        self.sent = 0
        self._acts = OPEN[WHOLE], OPEN[FRACTION]
        self._busy = busy
        self._spoil = spoil

    def __getitem__(self, address):
        offset = address - UART_AT
        if offset == DATA:
            return self.fifo.pop(0)
        if offset != FLAGS:
            return self.registers[offset]
        busy = self.sent and self._busy > 0
        self._busy -= bool(busy)
        return (0x08 if busy else 0) | (0 if self.fifo else 0x10) | 0x80

    def __setitem__(self, address, value):
        offset = address - UART_AT
        self.written.append(offset)
        if offset == FORMAT:
            self._acts = self.registers[WHOLE], self.registers[FRACTION]
        if offset != DATA:
            self.registers[offset] = value
            return
        assert self.registers[CONTROL] == 0x381, "it leaves the chip, or goes nowhere"
        assert self.registers[MASK] == 0, "MicroPython takes it"
        assert self._acts == (4, 0) and self.registers[FORMAT] == OPEN[FORMAT]
        self.sent += 1
        back = self._spoil(value)
        if back is not None:
            self.fifo.append(back)

    def is_as_before(self):
        """Set up as it was, at its old rate, with nothing in it."""
        self.registers[CLEAR] = 0
        return self.registers == OPEN and self._acts == (406, 16) and not self.fifo


class Level:
    """A pin that is low up to an instant. To look at it takes 2 us."""

    def __init__(self, clock, high_from=0):
        self.clock = clock
        self.high_from = high_from

    def value(self):
        self.clock.now += 2
        return int(self.clock.now >= self.high_from)


class Watch:
    ticks_mask = (1 << 30) - 1

    def __init__(self, began=0):
        self.now = 0
        self.began = began

    def ticks_us(self):
        return (self.began + self.now) & self.ticks_mask

    def sleep_us(self, us):
        self.now += us


def looked(uart, drives=False, low_us=0, baud=19200, began=0):
    clock = Watch(began)
    driver_enable = Level(clock, 0 if drives else 1 << 29)
    return find(uart, UART_AT, driver_enable, Level(clock, low_us), clock, baud), clock


def test_a_sound_uart_gets_all_back_and_is_as_it_was_before():
    for waiting in (0, 1, 31, 32):  # what was heard before is dropped
        for busy in (0, 1, 49):
            uart = Pl011(waiting, busy)
            assert looked(uart)[0] == "" and uart.sent == 8
            assert uart.registers[CLEAR] == 0x7FF and uart.is_as_before()
            assert uart.written.index(MASK) < uart.written.index(CONTROL)
            assert uart.written[-3:] == [CLEAR, CONTROL, MASK]  # no old interrupt comes then


def test_a_uart_that_does_not_get_all_back_is_found():
    """Each of the characters may come wrong or not at all, or it sends for over a millisecond."""
    sent = []
    looked(Pl011(spoil=sent.append))
    assert sent == [0x00, 0xFF, 0x55, 0xAA, 0x01, 0x80, 0x7F, 0xFE]
    for place in range(8):
        for wrong in (None, sent[place] ^ 0x01, sent[place] ^ 0x80):
            come = iter(sent[:place] + [wrong] + sent[place + 1 :])
            uart = Pl011(spoil=lambda character, come=come: next(come))
            assert looked(uart)[0] == UART_DEFECT, (place, wrong)
            assert uart.is_as_before()
    uart = Pl011(busy=50)
    found, clock = looked(uart)
    assert found == UART_DEFECT and uart.is_as_before() and 1_000 <= clock.now < 1_100


def test_a_driver_that_is_on_is_found_before_anything_is_touched():
    uart = Pl011(busy=99)
    assert looked(uart, drives=True, low_us=99_000)[0] == DRIVER
    assert uart.written == [] and uart.sent == 0


def test_a_line_that_is_low_for_longer_than_any_character_is_found():
    """For 3 ms at the least; at a rate so slow that it took over 11 ms nobody looks."""
    for began in (0, -500):
        for baud, low_us, wanted in (
            (187500, 2_950, ""), (187500, 3_300, LINE), (19200, 2_950, ""), (19200, 3_300, LINE),
            (1200, 9_950, ""), (1200, 10_300, LINE), (1091, 11_300, LINE), (1090, 99_000, ""),
        ):  # fmt: skip
            found, clock = looked(Pl011(), low_us=low_us, baud=baud, began=began)
            assert found == wanted, (baud, low_us)
            assert clock.now <= 11_300
    assert looked(Pl011())[1].now < 100  # it is high: that is seen at once
