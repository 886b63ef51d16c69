# SPDX-License-Identifier: MIT
"""Data sheet of the simulated chip: UART, pin, timer, watchdog and interrupts as on the RP2040."""

from boards.sim.chip.machine import UART, WDT, Chip, Pin, Timer, heap_lock, heap_unlock
from boards.sim.clock import Clock, Event
from boards.sim.line.wire import GARBLE, Transceiver, Wire

INTERPRETERS = "unix64 unix32 cpython"  # what takes no heap depends on the size of integers

TELEGRAM = bytes(range(0x20, 0x30))  # 16 characters
TELEGRAM_US = 9166  # at 19200 baud
RXIDLE_US = 1667  # 32 bits at 19200 baud
BAUD_RATES = (1200, 9600, 19200, 38400, 57600, 115200, 187500)


class Board:
    """A chip whose UART and enable pin are joined to the line, and a drive that may talk to it."""

    name = "drive"

    def __init__(self, baud=19200, timeout_again=False):
        self.clock = Clock()
        self.wire = Wire(self.clock, baud)
        self.chip = Chip(self.clock, self.wire, timeout_again)
        self.wire.attach(self)
        self.heard = []
        self.interrupts = []  # instants
        self.baud = baud
        self.boot()

    def boot(self):
        self.uart = UART(self.chip, self.baud)
        self.enable = Pin(self.chip)
        Transceiver(self.wire, self.uart, self.enable)

    def hear(self, burst):
        self.heard.append((self.clock.now_us, bytes(burst.data[: burst.count])))

    def reply(self, characters=TELEGRAM):
        self.wire.talk(self, characters, len(characters))

    def note(self, source):
        self.interrupts.append(self.clock.now_us)

    def at(self, at_us, function, *arguments):
        self.clock.schedule(Event(lambda: function(*arguments)), at_us)

    def waiting(self):
        """Everything that waits in the UART."""
        buffer = bytearray(300)
        count = self.uart.readinto(buffer)
        return bytes(buffer[:count]) if count is not None else b""


class Node:
    """Another station, which nobody asked."""

    name = "node"

    def __init__(self, wire):
        wire.attach(self)

    def hear(self, burst):
        pass


def refused(error, function, *arguments, **keywords):
    try:
        function(*arguments, **keywords)
    except error:
        return True
    return False


# UART: sending


def test_a_written_telegram_goes_out_at_once_and_back_to_back():
    board = Board()
    board.enable(1)
    assert board.uart.write(TELEGRAM) == 16
    board.clock.advance(TELEGRAM_US - 1)
    assert not board.uart.txdone()
    board.clock.advance(1)
    assert board.uart.txdone()
    board.enable(0)
    assert board.heard == [(TELEGRAM_US, TELEGRAM)]
    assert board.wire.violations() == []
    assert board.wire.log.last(1) == [(0, True, TELEGRAM)]


def test_write_takes_bytes_views_and_a_count():
    board = Board()
    board.enable(1)
    assert board.uart.write(memoryview(bytearray(TELEGRAM))[:4]) == 4
    assert board.uart.write(bytearray(TELEGRAM), 3) == 3
    assert board.uart.write(b"xy", 9) == 2
    board.clock.advance(20_000)
    assert board.heard == [(5156, TELEGRAM[:4] + TELEGRAM[:3] + b"xy")]


def test_write_copies_so_that_the_buffer_can_be_used_again():
    board = Board()
    board.enable(1)
    buffer = bytearray(TELEGRAM)
    board.uart.write(buffer)
    buffer[0] = 0
    board.clock.advance(20_000)
    assert board.heard[0][1] == TELEGRAM


def test_write_takes_what_there_is_room_for():
    board = Board(115200)
    board.enable(1)
    assert board.uart.write(bytes(250)) == 250
    assert board.uart.write(bytes(20)) == 10
    assert board.uart.write(bytes(20)) is None
    board.clock.advance(100_000)
    assert board.uart.txdone() and len(board.heard[0][1]) == 260
    assert board.uart.write(bytes(200)) == 200
    board.clock.advance(board.wire.ends[199])
    assert board.uart.txdone() and board.uart.write(bytes(200)) == 200


def test_writing_nothing_sends_nothing():
    board = Board()
    board.enable(1)
    assert board.uart.write(b"") == 0 and board.uart.write(TELEGRAM, 0) == 0
    assert board.uart.txdone()
    board.clock.advance(20_000)
    assert board.heard == []


def test_the_uart_is_done_in_its_time_even_if_the_driver_is_off():
    board = Board()
    board.uart.write(TELEGRAM)
    board.clock.advance(TELEGRAM_US - 1)
    assert not board.uart.txdone()
    board.clock.advance(1)
    assert board.uart.txdone()
    assert board.heard == [] and board.wire.violation_count() == 1


def test_the_uart_is_done_in_its_time_even_if_the_driver_cuts_it_short():
    board = Board()
    board.enable(1)
    board.uart.write(TELEGRAM)
    board.clock.advance(1000)
    board.enable(0)
    board.clock.advance(TELEGRAM_US - 1001)
    assert not board.uart.txdone()
    board.clock.advance(1)
    assert board.uart.txdone() and board.heard == [(1000, TELEGRAM[:1])]


# UART: receiving


def test_a_look_in_the_middle_sees_the_characters_whose_stop_bit_is_over():
    for baud in BAUD_RATES:
        board = Board(baud)
        board.clock.advance(12_345)
        board.reply()
        for i in range(16):
            end_us = 12_345 + (i + 1) * 11_000_000 // baud
            board.clock.advance_to(end_us - 1)
            assert board.uart.any() == i
            board.clock.advance_to(end_us)
            assert board.uart.any() == i + 1
        assert board.waiting() == TELEGRAM
        assert board.uart.any() == 0


def test_readinto_takes_what_is_there_and_leaves_the_rest():
    board = Board()
    board.reply()
    board.clock.advance(20_000)
    buffer = bytearray(10)
    assert board.uart.readinto(buffer, 3) == 3
    assert buffer == TELEGRAM[:3] + bytes(7)
    assert board.uart.readinto(buffer) == 10
    assert buffer == TELEGRAM[3:13]
    assert board.uart.readinto(buffer, 99) == 3
    assert buffer[:3] == TELEGRAM[13:]
    assert board.uart.readinto(buffer) is None


def test_the_buffer_is_a_ring():
    board = Board(115200)
    received = b""
    expected = b""
    for number in range(40):
        telegram = bytes((number + i) & 0xFF for i in range(50))
        board.reply(telegram)
        board.clock.advance(10_000)
        buffer = bytearray(47)
        count = board.uart.readinto(buffer)
        received += bytes(buffer[:count])
        expected += telegram
    assert received + board.waiting() == expected


def test_no_character_is_lost_where_the_ring_closes():
    board = Board(115200)
    for _ in range(4):
        board.reply(bytes(69))
        board.clock.advance(10_000)
    buffer = bytearray(100)
    board.uart.readinto(buffer)
    for telegram in (TELEGRAM[:12], TELEGRAM):  # the first one ends at the end of the ring
        board.reply(telegram)
        board.clock.advance(10_000)
    assert board.waiting() == bytes(176) + TELEGRAM[:12] + TELEGRAM


def test_what_does_not_fit_into_288_characters_is_lost():
    board = Board(115200)
    telegrams = [bytes((number + i) & 0xFF for i in range(250)) for number in range(3)]
    for telegram in telegrams:
        board.reply(telegram)
        board.clock.advance(30_000)
    assert board.uart.any() == 256 and board.uart.fifo_holds()
    assert board.waiting() == telegrams[0] + telegrams[1][:38]
    board.reply()
    board.clock.advance(30_000)
    assert board.waiting() == TELEGRAM


def test_the_driver_leaves_one_character_in_the_fifo_as_long_as_a_burst_goes_on():
    board = Board()
    board.reply(bytes(70))
    for characters in range(1, 71):
        board.clock.advance_to(-(-characters * 11_000_000 // 19200) + 2)
        assert board.uart.fifo_holds()
    board.uart.any()
    assert not board.uart.fifo_holds()


def test_while_interrupts_wait_the_fifo_holds_32_characters_and_no_more():
    board = Board(115200)
    telegram = bytes(range(100))
    board.reply(telegram)
    board.clock.advance(50 * board.wire.character_us)
    state = board.chip.disable_irq()
    board.clock.advance(20_000)
    board.chip.enable_irq(state)
    waiting = board.waiting()
    assert waiting == telegram[: len(waiting)] and 50 + 32 - 24 < len(waiting) <= 50 + 32


# UART: IRQ_RXIDLE


def fills(board):
    """So many characters that the buffer is full, and the FIFO as well."""
    board.uart.irq(board.note, UART.IRQ_RXIDLE)
    for _ in range(2):
        board.reply(bytes(200))
        board.clock.advance(200 * board.wire.character_us)
    board.clock.advance(100_000)


def test_of_a_full_receiver_rxidle_comes_once():
    board = Board(115200)
    fills(board)
    assert len(board.interrupts) == 1 and not board.chip.storms
    board.waiting()
    board.reply()
    board.clock.advance(50_000)
    assert len(board.interrupts) == 2


def test_of_a_full_receiver_rxidle_comes_again_and_again():
    board = Board(115200, timeout_again=True)
    fills(board)
    assert len(board.interrupts) > 1_000 and board.chip.storms
    board.waiting()
    board.clock.advance(1_000)
    came = len(board.interrupts)
    board.clock.advance(50_000)
    assert len(board.interrupts) == came and not board.chip.storms


def test_rxidle_comes_32_bits_after_the_last_character():
    for baud in BAUD_RATES:
        for hard in (False, True):
            board = Board(baud)
            calls = bytearray(1)

            def handler(uart):
                assert uart is board.uart
                assert board.clock.now_us == end_us + -(-32_000_000 // baud)
                calls[0] += 1

            board.uart.irq(handler, UART.IRQ_RXIDLE, hard=hard)
            end_us = 16 * 11_000_000 // baud
            board.reply()
            board.clock.advance(1_000_000)
            assert calls[0] == 1 and board.chip.handler_errors == []
            assert board.waiting() == TELEGRAM


def test_rxidle_comes_once_for_each_burst_even_if_nothing_is_taken():
    board = Board()
    board.uart.irq(board.note, UART.IRQ_RXIDLE)
    for start_us in (0, 20_000, 40_000):
        board.clock.advance_to(start_us)
        board.reply()
    board.clock.advance(20_000)
    end_us = TELEGRAM_US + RXIDLE_US
    assert board.interrupts == [end_us, 20_000 + end_us, 40_000 + end_us]
    assert board.uart.any() == 48


def test_any_empties_the_fifo_and_so_suppresses_rxidle():
    for look in (UART.any, lambda uart: uart.readinto(bytearray(1))):
        board = Board()
        board.uart.irq(board.note, UART.IRQ_RXIDLE)
        board.reply()
        board.clock.advance(TELEGRAM_US + RXIDLE_US - 1)
        look(board.uart)
        board.clock.advance(20_000)
        assert board.interrupts == []
        assert board.uart.any() >= 15


def test_a_look_before_the_last_character_does_not_suppress_rxidle():
    board = Board()
    board.uart.irq(board.note, UART.IRQ_RXIDLE)
    board.reply()
    board.clock.advance(TELEGRAM_US - 1)
    assert board.uart.any() == 15
    board.clock.advance(20_000)
    assert board.interrupts == [TELEGRAM_US + RXIDLE_US]


def test_a_next_burst_within_32_bits_puts_rxidle_off():
    # A burst that begins 22 bits later completes its first character 33 bits later: too late.
    for pause_bits, interrupts in ((20, 1), (22, 2)):
        board = Board()
        board.uart.irq(board.note, UART.IRQ_RXIDLE)
        second_us = TELEGRAM_US + pause_bits * 1_000_000 // 19200
        board.reply()
        board.at(second_us, board.reply)
        board.clock.advance(50_000)
        instants = [TELEGRAM_US + RXIDLE_US, second_us + TELEGRAM_US + RXIDLE_US]
        assert board.interrupts == instants[-interrupts:]
        assert board.uart.any() == 32


def test_one_character_is_enough_for_rxidle_and_none_is_not():
    board = Board()
    board.uart.irq(board.note, UART.IRQ_RXIDLE)
    board.reply(b"\x02")
    board.clock.advance(20_000)
    assert board.interrupts == [572 + RXIDLE_US]
    board.reply(b"\x02")
    board.clock.advance(500)
    board.wire.silence(board)
    board.clock.advance(20_000)
    assert len(board.interrupts) == 1


def test_irq_without_a_handler_or_trigger_ends_it():
    for arguments in ((None, 0), (None, UART.IRQ_RXIDLE), (lambda uart: None, 0), ()):
        board = Board()
        board.uart.irq(board.note, UART.IRQ_RXIDLE)
        board.uart.irq(*arguments)
        board.reply()
        board.clock.advance(20_000)
        assert board.interrupts == []


def test_an_unknown_trigger_or_a_handler_that_cannot_be_called_is_refused():
    board = Board()
    assert refused(ValueError, board.uart.irq, board.note, 1)
    assert refused(ValueError, board.uart.irq, board.note, UART.IRQ_RXIDLE | 0x20)
    assert refused(ValueError, board.uart.irq, 5, UART.IRQ_RXIDLE)


def test_a_uart_after_deinit_has_nothing_and_interrupts_nobody():
    board = Board()
    board.uart.irq(board.note, UART.IRQ_RXIDLE)
    board.reply()
    board.clock.advance(TELEGRAM_US + 100)
    board.uart.deinit()
    board.clock.advance(20_000)
    assert board.interrupts == [] and board.uart.any() == 0


def test_a_uart_after_deinit_is_silent_and_deaf():
    board = Board()
    board.uart.irq(board.note, UART.IRQ_RXIDLE)
    board.enable(1)
    board.uart.write(TELEGRAM)
    board.clock.advance(1000)
    board.uart.deinit()
    assert board.heard == [(1000, TELEGRAM[:1])]
    assert board.uart.txdone() and board.uart.any() == 0
    assert board.uart.write(TELEGRAM) is None
    board.enable(0)
    board.reply()
    board.clock.advance(20_000)
    assert board.uart.any() == 0 and board.interrupts == []
    assert board.wire.violations() == [
        "at 1000: drive talks after 0 us of silence, the start interval is 1146 us"
    ]


# Transceiver


def test_there_is_no_echo():
    board = Board()
    board.enable(1)
    board.uart.write(TELEGRAM)
    board.clock.advance(TELEGRAM_US)
    board.enable(0)
    board.clock.advance(20_000)
    assert board.uart.any() == 0


def test_the_receiver_is_off_while_the_driver_is_on():
    # On within character 4, off where character 7 begins, at 4010 us, or near it. Of the garbled
    # rest, a character comes in if the receiver was on from its start bit to its stop bit.
    for off_us, first_heard in ((4009, 7), (4010, 7), (4011, 8), (4583, 8), (4584, 9)):
        board = Board()
        start_us = 1000
        board.at(start_us, board.reply)
        board.uart.irq(board.note, UART.IRQ_RXIDLE)
        ends = board.wire.ends
        board.clock.advance(start_us + ends[3] + 10)
        board.enable(1)
        board.clock.advance_to(start_us + off_us)
        board.enable(0)
        board.clock.advance(20_000)
        garbled = bytes(one ^ GARBLE[at] for at, one in enumerate(TELEGRAM))
        assert board.waiting() == TELEGRAM[:4] + garbled[first_heard:]
        ends_us = (start_us + ends[3], start_us + TELEGRAM_US)
        assert board.interrupts == [end_us + RXIDLE_US for end_us in ends_us]
        assert board.wire.violation_count() == 2  # a collision, and a driver on for nothing


def test_a_pin_that_is_high_from_the_start_enables_the_driver():
    board = Board()
    pin = Pin(board.chip, value=1)
    Transceiver(board.wire, UART(board.chip, 19200), pin, "other")
    board.clock.advance(1000)
    pin(0)
    assert board.wire.violations() == [
        "at 1000: other has its driver enabled for 1000 us without sending"
    ]


def test_characters_left_before_the_driver_came_on_still_give_rxidle():
    board = Board()
    board.uart.irq(board.note, UART.IRQ_RXIDLE)
    board.reply()
    board.clock.advance(board.wire.ends[3] + 10)
    board.enable(1)
    board.clock.advance(20_000)
    assert board.interrupts == [board.wire.ends[3] + RXIDLE_US]
    assert board.waiting() == TELEGRAM[:4]


def test_of_two_talkers_both_come_in_as_garbage():
    board = Board()
    other = Node(board.wire)
    board.reply()
    board.clock.advance(board.wire.ends[1])
    board.wire.talk(other, TELEGRAM, 3)
    board.clock.advance(20_000)
    received = board.waiting()
    assert len(received) == 19 and received[:2] == TELEGRAM[:2]
    assert TELEGRAM[2] not in received


# Interrupts


def test_an_exception_disables_its_handler_for_good_and_is_remembered():
    board = Board()

    def fail(source):
        board.note(source)
        raise KeyError("spoilt")

    board.uart.irq(fail, UART.IRQ_RXIDLE)
    timer = Timer(board.chip)
    timer.init(mode=Timer.PERIODIC, period=50, callback=fail)
    for _ in range(3):
        board.reply()
        board.clock.advance(40_000)
    assert board.interrupts == [TELEGRAM_US + RXIDLE_US, 50_000]
    assert [type(error) for error in board.chip.handler_errors] == [KeyError, KeyError]
    board.uart.irq(board.note, UART.IRQ_RXIDLE)  # armed anew, it works again
    board.reply()
    board.clock.advance(20_000)
    assert board.interrupts[2:] == [120_000 + TELEGRAM_US + RXIDLE_US]


def test_the_first_16_exceptions_are_remembered():
    board = Board()

    def fail(source):
        raise KeyError("spoilt")

    timer = Timer(board.chip)
    for _ in range(20):
        timer.init(mode=Timer.ONE_SHOT, period=1, callback=fail)
        board.clock.advance(1000)
    assert len(board.chip.handler_errors) == 16


def test_interrupts_wait_while_disabled_and_come_in_the_order_they_happened():
    board = Board()
    book = []
    board.uart.irq(lambda uart: book.append("uart"), UART.IRQ_RXIDLE)
    timers = [Timer(board.chip) for _ in range(2)]
    timers[0].init(mode=Timer.PERIODIC, period=20, callback=lambda timer: book.append("slow"))
    timers[1].init(mode=Timer.ONE_SHOT, period=5, callback=lambda timer: book.append("fast"))
    state = board.chip.disable_irq()
    board.reply()
    board.clock.advance(45_000)
    assert book == []
    board.chip.enable_irq(state)
    assert book == ["fast", "uart", "slow"]  # each once, however often it happened
    board.clock.advance(20_000)
    assert book[3:] == ["slow"]


def test_disabling_nests():
    board = Board()
    timer = Timer(board.chip)
    timer.init(mode=Timer.ONE_SHOT, period=1, callback=board.note)
    outer = board.chip.disable_irq()
    inner = board.chip.disable_irq()
    board.clock.advance(3000)
    board.chip.enable_irq(inner)
    assert board.interrupts == []
    board.chip.enable_irq(outer)
    assert board.interrupts == [3000]


def test_characters_taken_while_disabled_leave_nothing_to_interrupt_for():
    board = Board()
    board.uart.irq(board.note, UART.IRQ_RXIDLE)
    state = board.chip.disable_irq()
    board.reply()
    board.clock.advance(20_000)
    assert board.waiting() == TELEGRAM
    board.chip.enable_irq(state)
    assert board.interrupts == []


def test_a_handler_is_not_interrupted_by_another_one():
    board = Board()
    book = []

    def first_handler(timer):
        book.append("first begins")
        board.chip.enable_irq(board.chip.disable_irq())
        book.append("first ends")

    first = Timer(board.chip)
    first.init(mode=Timer.ONE_SHOT, period=1, callback=first_handler)
    second = Timer(board.chip)
    second.init(mode=Timer.ONE_SHOT, period=2, callback=lambda timer: book.append("second"))
    state = board.chip.disable_irq()
    board.clock.advance(5000)
    board.chip.enable_irq(state)
    assert book == ["first begins", "first ends", "second"]


# Pin


def test_a_pin_has_a_level_and_tells_its_edges():
    chip = Chip(Clock(), None)
    edges = []
    pin = Pin(chip, on_change=edges.append)
    assert pin.value() == 0 and pin() == 0
    pin(1)
    pin.on()
    pin.value(7)
    assert pin() == 1
    pin.off()
    pin(0)
    pin.value(True)
    assert edges == [1, 0, 1]
    assert Pin(chip, value=1).value() == 1


def test_an_input_reads_what_is_applied_to_it_else_its_pull():
    chip = Chip(Clock(), None)
    for pull, level in ((Pin.PULL_UP, 1), (Pin.PULL_DOWN, 0), (None, 0)):
        edges = []
        pin = Pin(chip, Pin.IN, pull, on_change=edges.append)
        assert pin() == level
        for applied in (0, 1):
            pin.apply(applied)
            assert pin.value() == applied
        pin.on()
        pin.off()
        assert pin() == 1 and edges == []
        pin.apply(None)
        assert pin() == level


def test_an_open_drain_output_pulls_low_or_lets_go():
    chip = Chip(Clock(), None)
    edges = []
    pin = Pin(chip, Pin.OPEN_DRAIN, Pin.PULL_UP, value=1, on_change=edges.append)
    assert pin() == 1
    pin.apply(0)
    assert pin() == 0  # somebody else pulls
    pin.apply(1)
    pin.off()
    assert pin() == 0
    pin.on()
    pin.on()
    assert pin() == 1 and edges == [0, 1]
    assert Pin(chip, Pin.OPEN_DRAIN, value=1)() == 0  # nobody holds it


def test_an_output_reads_as_it_is_set_whatever_is_applied():
    pin = Pin(Chip(Clock(), None))
    pin.apply(1)
    assert pin() == 0
    pin.apply(0)
    pin.on()
    assert pin() == 1


def test_a_reset_lets_go_of_open_drain_outputs():
    chip = Chip(Clock(), None)
    edges = []
    pin = Pin(chip, Pin.OPEN_DRAIN, Pin.PULL_UP, on_change=edges.append)
    chip.reset()
    pin.off()
    assert edges == [0, 1] and pin() == 1


def test_the_chip_shows_the_levels_of_its_first_thirty_pins_as_bits():
    chip = Chip(Clock(), None)
    output = Pin(chip)
    pins = [Pin(chip, Pin.IN, Pin.PULL_UP) for _ in range(31)]
    assert (output.mask, pins[0].mask, pins[28].mask) == (1, 2, 1 << 29)
    assert pins[29].mask == pins[30].mask == 0  # an RP2040 has no more
    assert chip.levels == (1 << 30) - 2
    output.on()
    pins[0].apply(0)
    pins[30].apply(0)
    assert chip.levels == (1 << 30) - 3
    pins[0].apply(None)
    assert chip.levels == (1 << 30) - 1


def test_a_pin_from_before_a_reset_is_in_no_ones_levels():
    chip = Chip(Clock(), None)
    old = Pin(chip, Pin.IN, Pin.PULL_UP)
    chip.reset()
    assert chip.levels == 0
    new = Pin(chip, Pin.IN, Pin.PULL_UP)
    old.apply(0)
    assert chip.levels == new.mask == 1


def test_a_pin_of_no_mode_is_refused():
    assert refused(ValueError, Pin, Chip(Clock(), None), 3)


# Timer


def test_a_one_shot_timer_fires_once():
    board = Board()
    timer = Timer(board.chip)
    timer.init(mode=Timer.ONE_SHOT, period=30, callback=board.note)
    board.clock.advance(100_000)
    assert board.interrupts == [30_000]


def test_a_periodic_timer_fires_again_and_again_without_drift():
    board = Board()
    timer = Timer(board.chip)
    timer.init(period=333, tick_hz=1_000_000, callback=board.note)
    board.clock.advance(1000)
    assert board.interrupts == [333, 666, 999]
    timer.deinit()
    board.clock.advance(1000)
    assert len(board.interrupts) == 3


def test_a_period_counts_ticks():
    for period, tick_hz, us in (
        (5, 1000, 5000),
        (5, 1_000_000, 5),
        (0, 1_000_000, 1),
        (1, 3, 333_333),
        (90, 60, 1_500_000),
    ):
        board = Board()
        timer = Timer(board.chip)
        timer.init(mode=Timer.ONE_SHOT, period=period, tick_hz=tick_hz, callback=board.note)
        board.clock.advance(2_000_000)
        assert board.interrupts == [us]


def test_a_timer_may_be_started_anew_by_its_own_callback():
    board = Board()
    timer = Timer(board.chip)

    def again(source):
        assert source is timer
        board.note(source)
        timer.init(mode=Timer.ONE_SHOT, period=7, callback=again)

    timer.init(mode=Timer.ONE_SHOT, period=10, callback=again)
    board.clock.advance(25_000)
    assert board.interrupts == [10_000, 17_000, 24_000]


def test_a_timer_stopped_while_its_interrupt_waits_does_not_call():
    board = Board()
    timer = Timer(board.chip)
    timer.init(mode=Timer.ONE_SHOT, period=1, callback=board.note)
    state = board.chip.disable_irq()
    board.clock.advance(2000)
    timer.deinit()
    board.chip.enable_irq(state)
    assert board.interrupts == []


def test_a_timer_started_anew_while_its_interrupt_waits_calls_after_the_new_period_only():
    board = Board()
    timer = Timer(board.chip)
    timer.init(mode=Timer.ONE_SHOT, period=1, callback=board.note)
    state = board.chip.disable_irq()
    board.clock.advance(2000)
    timer.init(mode=Timer.ONE_SHOT, period=5, callback=board.note)
    board.chip.enable_irq(state)
    board.clock.advance(10_000)
    assert board.interrupts == [7000]


def test_arguments_that_make_no_period_are_refused():
    timer = Timer(Chip(Clock(), None))
    for keywords in ({"period": 1.5}, {"period": None}, {"mode": "x"}, {"tick_hz": 1e6}):
        assert refused(TypeError, timer.init, **keywords)
    assert refused(TypeError, timer.init, Timer.ONE_SHOT)
    assert refused(ValueError, timer.init, period=-1)


# Watchdog and reset


def test_the_watchdog_bites_when_it_is_not_fed():
    board = Board()
    bites = []
    board.chip.on_bite = lambda: bites.append(board.clock.now_us)
    watchdog = WDT(board.chip, 2000)
    for _ in range(3):
        board.clock.advance(1_999_999)
        watchdog.feed()
    assert bites == []
    board.clock.advance(2_000_000)
    assert bites == [7_999_997]


def test_the_watchdog_counts_to_8388_ms_and_no_further():
    chip = Chip(Clock(), None)
    WDT(chip, 8388)
    assert refused(ValueError, WDT, chip, 8389)
    assert refused(ValueError, WDT, chip, 0)


def test_a_bite_resets_the_chip_even_with_interrupts_disabled():
    board = Board()
    WDT(board.chip, 1000)
    board.enable(1)
    board.chip.disable_irq()
    board.clock.advance(1_000_000)
    assert board.enable() == 0
    timer = Timer(board.chip)
    timer.init(mode=Timer.ONE_SHOT, period=1, callback=board.note)
    board.clock.advance(2_000_000)
    assert board.interrupts == [1_001_000]


def test_a_reset_cuts_the_telegram_lowers_the_pins_and_calls_nobody():
    board = Board()
    levels = []
    lamp = Pin(board.chip, value=1, on_change=levels.append)
    watchdog = WDT(board.chip, 100)
    board.chip.on_bite = lambda: levels.append("bite")
    timer = Timer(board.chip)
    timer.init(period=50, callback=board.note)
    board.uart.irq(board.note, UART.IRQ_RXIDLE)
    board.enable(1)
    board.uart.write(TELEGRAM)
    board.clock.advance(5000)
    board.chip.reset()
    assert board.heard == [(5000, TELEGRAM[:8])]
    assert lamp() == 0 and board.enable() == 0 and levels == [1, 0]
    board.clock.advance(2000)
    board.reply()
    board.clock.advance(1_000_000)
    assert board.interrupts == [] and levels == [1, 0]
    assert board.wire.violations() == []
    # What was made before the reset is dead.
    lamp(1)
    watchdog.feed()
    timer.init(period=50, callback=board.note)
    assert board.uart.write(TELEGRAM) is None and board.uart.any() == 0
    board.clock.advance(1_000_000)
    assert board.interrupts == [] and levels == [1, 0] and lamp() == 0


def test_after_a_reset_new_peripherals_work_on_the_same_line():
    board = Board()
    for _ in range(5):
        board.enable(1)
        board.uart.write(TELEGRAM)
        board.clock.advance(TELEGRAM_US)
        board.enable(0)
        board.clock.advance(10_000)
        board.reply()
        board.clock.advance(20_000)
        assert board.waiting() == TELEGRAM
        board.chip.reset()
        board.boot()
    assert len(board.heard) == 5 and board.wire.violations() == []


def test_a_reset_drops_the_interrupts_that_wait():
    board = Board()
    timer = Timer(board.chip)
    timer.init(mode=Timer.ONE_SHOT, period=1, callback=board.note)
    board.chip.disable_irq()
    board.clock.advance(2000)
    board.chip.reset()
    board.chip.enable_irq(False)
    assert board.interrupts == []


# A whole exchange


class PingPong:
    """Firmware in small: each end sends a telegram as soon as it has received one."""

    def __init__(self, wire, name):
        chip = Chip(wire.clock, wire)
        self.chip = chip
        self.uart = UART(chip, wire.baud)
        self.enable = Pin(chip)
        self.timer = Timer(chip)
        self.telegram = bytearray(TELEGRAM)
        self.received = bytearray(64)
        self.count = 0
        self.duration_us = wire.ends[15]
        self.on_sent = self.sent  # bound once: binding takes heap
        Transceiver(wire, self.uart, self.enable, name)
        self.uart.irq(self.burst, UART.IRQ_RXIDLE, hard=True)

    def send(self):
        self.enable(1)
        self.uart.write(self.telegram, 16)
        self.timer.init(
            mode=Timer.ONE_SHOT,
            period=self.duration_us,
            tick_hz=1_000_000,
            callback=self.on_sent,
            hard=True,
        )

    def sent(self, timer):
        if self.uart.txdone():
            self.enable.off()

    def burst(self, uart):
        if uart.any() == 16 and uart.readinto(self.received, 16) == 16:
            self.count += 1
            self.send()


def ping_pong(clock, seconds, baud=115200):
    wire = Wire(clock, baud)
    one = PingPong(wire, "one")
    two = PingPong(wire, "two")
    one.send()
    heap_lock()
    try:
        clock.advance(seconds * 1_000_000)
    finally:
        heap_unlock()
    assert one.chip.handler_errors == [] and two.chip.handler_errors == []
    assert wire.violations() == []
    return one.count


def test_thousands_of_exchanges_take_no_heap_and_break_no_rule():
    # Two telegrams of 16 characters and two interrupts: 2 * (1527 + 278) us.
    assert ping_pong(Clock(), 10) == 10_000_000 // 3610


def test_firmwares_other_calls_take_no_heap():
    board = Board()
    board.wire.detach(board)  # its ears take heap
    watchdog = WDT(board.chip, 2000)
    timer = Timer(board.chip)
    buffer = bytearray(4)
    heap_lock()
    try:
        state = board.chip.disable_irq()
        board.chip.enable_irq(state)
        watchdog.feed()
        board.enable.on()
        board.uart.write(buffer)
        board.uart.write(buffer)
        board.uart.irq(None, 0)
        board.clock.advance(9999)
        board.enable.value(0)
        timer.init(mode=Timer.PERIODIC, period=8000, callback=None)
        timer.deinit()
        board.clock.ticks_us()
        board.uart.readinto(buffer)
    finally:
        heap_unlock()


def test_exchanges_go_on_past_the_small_integers_of_the_32_bit_build():
    clock = Clock()
    clock.advance((1 << 30) - 30_000_000)
    wire = Wire(clock, 9600)
    one = PingPong(wire, "one")
    PingPong(wire, "two")
    one.send()
    clock.advance(40_000_000)
    assert one.count == 40_000_000 // (2 * (18333 + 3334))
    assert one.chip.handler_errors == [] and wire.violations() == []
