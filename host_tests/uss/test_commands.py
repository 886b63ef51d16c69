# SPDX-License-Identifier: MIT
"""What a drive is told and when: ON either way, JOG, OFF1, OFF2, OFF3, the acknowledgement.

Control words as in USS.md 4.8 of the protocol notes: r0054 of a MICROMASTER 4.
"""

from array import array

from master_bench import Bus
from uss import bits, pkw, pzd
from uss.drive import ATTENTION, Drive
from uss.fast import frame
from uss.layout import STANDARD, Layout
from uss.receiver import OTHER_LENGTH, SILENCE, SILENT, TROUBLES

READY, RUNNING, FAULT = 0xFB31, 0xFB34, 0xFB78
EXCHANGE_US = 30_000  # with room: 16 characters each way at 19200


def ready():
    """A bus in contact with its drive."""
    bus = Bus()
    bus.run(200_000)
    assert bus.drives[0].contact
    return bus


def new_stws(bus, us=EXCHANGE_US):
    """The control words sent while `us` microseconds pass."""
    since = len(bus.sent)
    bus.run(us)
    return bus.stws(1, since)


def test_the_whole_words_are_those_of_the_manual():
    words = (
        (pzd.OFF1, ("NO_OFF2", "NO_OFF3", "PULSES", "RAMP_OUTPUT", "RAMP_RUN", "SETPOINT")),
        (pzd.OFF2, ("NO_OFF3", "PULSES", "RAMP_OUTPUT", "RAMP_RUN", "SETPOINT")),
        (pzd.OFF3, ("NO_OFF2", "PULSES", "RAMP_OUTPUT", "RAMP_RUN", "SETPOINT")),
    )
    names = {name: 1 << bit for bit, name, _ in bits.STW_BITS}
    for word, set_bits in words:
        assert word == sum([names[name] for name in set_bits]) + names["CONTROL"], hex(word)
    assert pzd.ON == pzd.OFF1 | names["ON"]
    assert pzd.ON_REVERSE == pzd.ON | names["REVERSE"] == 0x0C7F
    assert pzd.JOG_RIGHT == pzd.OFF1 | names["JOG_RIGHT"] == 0x057E
    assert pzd.JOG_LEFT == pzd.OFF1 | names["JOG_LEFT"] == 0x067E
    assert pzd.STW_RUN == names["ON"] | names["JOG_RIGHT"] | names["JOG_LEFT"]


def test_on_goes_either_way_and_turns_without_a_new_start():
    bus = ready()
    drive = bus.drives[0]
    drive.start(0x0CCD, pzd.ON_REVERSE)
    assert set(new_stws(bus)) == {0x0C7F}
    drive.turn(pzd.ON)
    assert set(new_stws(bus)) == {0x047F}
    drive.stop()
    assert set(new_stws(bus)) == {0x047E}
    drive.turn(pzd.ON_REVERSE)  # a drive that stands is not started by it
    assert set(new_stws(bus)) == {0x047E}


def test_turning_does_not_revive_what_was_taken_back():
    bus = ready()
    drive = bus.drives[0]
    drive.start(0x0CCD)
    bus.run(EXCHANGE_US)
    bus.run(400_000, refresh=False)  # the loop hangs: the dead man takes ON back
    drive.turn(pzd.ON_REVERSE)
    assert set(new_stws(bus)) == {0x047E}


def test_a_jog_carries_no_setpoint_and_ends_in_the_next_telegram():
    bus = ready()
    drive = bus.drives[0]
    for word in (pzd.JOG_RIGHT, pzd.JOG_LEFT):
        drive.start(0x0CCD, word)
        since = len(bus.sent)
        assert set(new_stws(bus)) == {word}
        for _, characters in bus.sent[since:]:
            assert characters[13:15] == b"\x00\x00"
        drive.stop()
        assert set(new_stws(bus)) == {0x047E}


def test_a_jog_is_taken_back_like_on_when_the_loop_hangs_or_the_line_fails():
    bus = ready()
    drive = bus.drives[0]
    drive.start(0, pzd.JOG_LEFT)
    bus.run(EXCHANGE_US)
    bus.run(400_000, refresh=False)
    assert drive.stopped_by_engine() and set(new_stws(bus)) == {0x047E}
    drive.start(0, pzd.JOG_LEFT)
    bus.run(EXCHANGE_US)
    bus.silent.add(1)
    bus.run(1_500_000)
    bus.silent.remove(1)
    bus.run(100_000)
    assert drive.contact and set(new_stws(bus)) == {0x047E}


def test_the_release_of_a_jog_is_repeated_until_it_is_answered():
    bus = Bus(addresses=tuple(range(8)))
    bus.run(1_000_000)
    drive = bus.drives[1]
    drive.start(0, pzd.JOG_RIGHT)
    bus.run(100_000)
    bus.silent.add(1)
    since = len(bus.sent)
    drive.stop()
    bus.run(300_000)
    assert bus.addresses(since)[:6].count(1) >= 3  # every second telegram is its, not every eighth
    assert set(bus.stws(1, since + 1)) == {0x047E}


def test_a_second_stop_stays_until_off1_is_asked_for():
    bus = ready()
    drive = bus.drives[0]
    for word in (pzd.OFF2, pzd.OFF3):
        drive.start(0x0CCD)
        bus.run(EXCHANGE_US)
        drive.stop(word)
        assert set(new_stws(bus, 2 * EXCHANGE_US)) == {word}
        assert drive.answered_stw == word
        assert set(new_stws(bus, 200_000)) == {word}
        drive.stop()
        assert set(new_stws(bus)) == {0x047E}


def test_the_dead_man_does_not_weaken_a_second_stop():
    bus = ready()
    drive = bus.drives[0]
    drive.stop(pzd.OFF3)
    since = len(bus.sent)
    bus.run(1_000_000, refresh=False)
    assert set(bus.stws(1, since)) == {0x047A}


def test_an_acknowledgement_is_one_edge_of_bit_7():
    bus = ready()
    drive = bus.drives[0]
    bus.zsw[1] = FAULT
    bus.run(EXCHANGE_US)
    drive.acknowledge()
    words = new_stws(bus, 300_000)
    assert words.count(0x04FE) == 1 and words[0] == 0x04FE, words
    assert set(words[1:]) == {0x047E}


def test_an_acknowledgement_is_repeated_until_a_reply_confirms_it():
    bus = ready()
    drive = bus.drives[0]
    drive.acknowledge()
    bus.silent.add(1)
    words = new_stws(bus, 300_000)
    assert set(words) == {0x04FE} and len(words) > 3
    bus.silent.remove(1)
    bus.run(EXCHANGE_US)
    assert set(new_stws(bus)) == {0x047E}


def test_two_acknowledgements_are_two_edges():
    bus = ready()
    drive = bus.drives[0]
    drive.acknowledge()
    while drive.acknowledged != drive.acknowledgements:
        bus.run(1_000)
    drive.acknowledge()
    words = new_stws(bus, 300_000)
    assert words[0] == 0x047E or words[1] == 0x047E  # bit 7 must fall before it can rise
    assert words.count(0x04FE) == 1, words


def test_an_acknowledgement_never_goes_with_on_and_never_comes_late():
    bus = ready()
    drive = bus.drives[0]
    drive.acknowledge()
    drive.start(0x0CCD)
    assert set(new_stws(bus)) <= {0x047F, 0x047E}
    drive.stop()
    assert set(new_stws(bus, 100_000)) == {0x047E}
    bus.silent.add(1)
    drive.acknowledge()
    bus.run(1_500_000)
    assert not drive.contact
    bus.silent.remove(1)
    assert set(new_stws(bus, 200_000)) == {0x047E}


def test_a_drive_follows_to_another_address():
    bus = Bus(addresses=(1, 2))
    bus.zsw[5] = READY
    bus.pkw[5] = None
    bus.run(300_000)
    bus.master.turns.readdress(bus.drives[0], 5)
    bus.silent.add(1)
    since = len(bus.sent)
    bus.run(300_000)
    assert set(bus.addresses(since + 1)) == {2, 5} and bus.drives[0].silent == 0
    for address in (2, 32, -1):
        try:
            bus.master.turns.readdress(bus.drives[0], address)
        except ValueError:
            continue
        raise AssertionError(address)


def test_the_longest_round_counts_every_drive_of_the_list():
    one, four = Bus(), Bus(addresses=(1, 2, 3, 4))
    four.master.turns.add(4)
    longest_us = one.master.turns.longest_cycle_us()
    assert four.master.turns.longest_cycle_us() == 5 * longest_us > 5 * EXCHANGE_US


def test_a_second_acknowledgement_has_an_edge_of_its_own():
    """It is wanted in the very moment in which the first one was confirmed."""
    drive, reply = Drive(1, 0x3FFFFFFF), bytearray(16)
    words = []
    for _ in range(4):
        if len(words) in (0, 1):
            drive.acknowledge()
        drive.fill(0)
        words.append(drive.request[11] << 8 | drive.request[12])
        drive.take(reply, 16, 0)
    assert words == [0x04FE, 0x047E, 0x04FE, 0x047E]


# --- a drive without a line ---------------------------------------------------------------------

MASK = 0x3FFFFFFF
LOST_US = 1_000_000
NEAR = 0x4000 // 100 * 2  # 2 %


class Alone:
    """A drive in contact: it is asked when the test says so, and answers what the test says."""

    def __init__(self, layout=STANDARD):
        self.drive = Drive(1, MASK, None, layout)
        self.now = 0
        self.exchange()
        assert self.drive.contact and self.drive.contacts == self.drive.off_answers == 1

    def send(self):
        """A telegram: its control word and its setpoint."""
        drive = self.drive
        self.now += 20_000
        drive.fill(self.now)
        words = drive.request[drive.size - 1 - 2 * drive.layout.pzd_words : drive.size - 1]
        return words[0] << 8 | words[1], words[2] << 8 | words[3] if len(words) > 2 else 0

    def answer(self, zsw=READY, hiw=0):
        reply = bytes((2, 14, 1)) + bytes(2 * self.drive.layout.pkw_words)
        words = bytes((zsw >> 8, zsw & 0xFF, hiw >> 8 & 0xFF, hiw & 0xFF)) + bytes(32)
        reply += words[: 2 * self.drive.layout.pzd_words + 1]
        self.drive.take(reply, len(reply), self.now)
        assert self.drive.answered_address == 1

    def exchange(self, zsw=READY, hiw=0):
        words = self.send()
        self.answer(zsw, hiw)
        return words

    def runs(self, hsw=0x2000, stw=pzd.ON):
        self.drive.start(hsw, stw)
        assert self.exchange(RUNNING) == (stw, hsw)
        return self.drive


def test_of_a_drive_that_was_never_heard_nothing_is_known_and_it_is_told_to_stop():
    drive = Drive(7, MASK)
    told = (drive.wanted, drive.ticket, drive.stops, drive.hsw, drive.urgent, drive.void)
    told += (drive.acknowledgements, drive.acknowledged, drive.served, drive.stops_sent)
    heard = (drive.zsw, drive.hiw, drive.contacts, drive.silent, drive.status, drive.insist)
    heard += (drive.answered_stw, drive.off_answers, drive.silent_us(0, MASK))
    assert drive.silent_us(5, MASK) == 5
    assert told + heard == (0,) * 19 and drive.counters == array("H", bytes(14))
    assert drive.answered_address == drive.address == 7 and drive.further is None
    assert not (drive.contact or drive.was_running or drive.ran or drive.asking or drive.doubted)
    assert drive.trouble == SILENCE and drive.near == NEAR and drive.may_rest()
    assert not (drive.may_run() or drive.is_on() or drive.stopped_by_engine())
    assert drive.urgency() == 0 and not drive.is_told_in_vain()
    drive.stop()
    assert drive.urgency() == 3 and drive.is_told_in_vain()
    drive.fill(0)
    assert drive.request[11:15] == b"\x04\x7e\x00\x00" and drive.urgency() == 1
    drive.move(9)
    assert drive.address == 9 and drive.answered_address == 7
    drive.take(bytes((2, 14, 9)) + bytes(13), 16, 0)
    assert drive.answered_address == 9
    for address in (-1, 32):
        try:
            Drive(address, MASK)
        except ValueError:
            continue
        raise AssertionError(address)


def test_how_urgent_a_telegram_is():
    alone = Alone()
    drive = alone.drive
    assert drive.urgency() == 0
    drive.want_turns(True)
    assert drive.urgency() == 1
    drive.lose()
    assert drive.urgency() == 0  # it does not answer anyway
    assert alone.exchange() == (pzd.OFF1, 0) and drive.urgency() == 1
    drive.want_turns(False)
    assert drive.urgency() == 0
    for call, urgency in ((drive.hurry, 3), (drive.acknowledge, 3), (drive.stop, 3)):
        call()
        assert drive.urgency() == urgency
        alone.exchange()
        alone.exchange()
        assert drive.urgency() == 0
    drive.start(0x1000)
    assert drive.urgency() == 2
    assert alone.exchange() == (pzd.ON, 0x1000) and drive.urgency() == 0
    drive.stop()
    assert drive.urgency() == 4  # it was told to run, whatever it says
    alone.exchange(RUNNING)
    assert drive.urgency() == 0 and drive.may_run()
    drive.stop()
    assert drive.urgency() == 4  # it is seen to
    alone.exchange()
    assert not drive.may_run()
    drive.tells_status = False
    drive.stop()
    assert drive.urgency() == 4 and drive.may_run()
    alone.exchange()


def test_a_stop_is_repeated_ten_times_to_a_drive_that_answered_and_three_times_to_another():
    for lost, times in ((False, 10), (True, 3)):
        alone = Alone()
        drive = alone.drive
        if lost:
            drive.lose()
            alone.send()
            alone.exchange()
            drive.lose()
        drive.stop()
        assert not drive.is_told_in_vain() or lost
        alone.send()
        for _ in range(times):
            assert drive.urgency() == 1 and drive.is_told_in_vain() is lost
            alone.send()
        assert drive.urgency() == 0 and not drive.is_told_in_vain()
        drive.ask_soon()
        assert drive.urgency() == 1
        alone.send()
        assert drive.urgency() == 0
        drive.stop()
        alone.send()
        drive.ask_soon()  # what is left of them stays
        for _ in range(times):
            assert drive.urgency() == 1
            alone.send()
        assert drive.urgency() == 0
        drive.stop()
        alone.send()
        off_answers = drive.off_answers
        alone.answer()
        assert drive.urgency() == 0 and drive.off_answers == off_answers + 1


def test_a_ticket_is_never_the_one_that_is_void():
    alone = Alone()
    drive = alone.drive
    for ticket, void, drawn in ((0xFFFF, 0, 1), (0xFFFE, 0xFFFF, 0), (7, 8, 9), (7, 6, 8)):
        drive.ticket, drive.void = ticket, void
        drive.start(0)
        assert drive.ticket == drawn and drive.is_on() and not drive.stopped_by_engine()
        alone.exchange()
    for hsw in (-1, 0x10000):
        try:
            drive.start(hsw)
        except ValueError:
            continue
        raise AssertionError(hsw)
    drive.start(0xFFFF)
    assert alone.exchange() == (pzd.ON, 0xFFFF)


def test_a_drive_that_stops_of_its_own_accord_is_not_told_to_run_any_more():
    alone = Alone()
    drive = alone.drive
    drive.start(0x2000)
    for _ in range(3):
        assert alone.exchange() == (pzd.ON, 0x2000)  # it takes its time to run
    assert not drive.ran and drive.is_on()
    alone.exchange(RUNNING)
    assert drive.ran and drive.is_on()
    alone.exchange()
    assert drive.stopped_by_engine() and not drive.is_on() and not drive.ran
    assert drive.urgency() == 4
    assert alone.exchange() == (pzd.OFF1, 0) and drive.urgency() == 0
    assert drive.answered_off() and drive.stopped_by_engine()
    for trouble in (FAULT, READY | 0x08, READY | 0x40, RUNNING | 0x08, RUNNING | 0x40):
        drive.start(0x2000)
        assert not drive.stopped_by_engine()
        alone.exchange(trouble)
        assert drive.stopped_by_engine() and alone.exchange() == (pzd.OFF1, 0), hex(trouble)
    drive.stop()
    assert not drive.stopped_by_engine()


def test_a_motor_that_had_its_speed_and_stands_still_is_not_told_to_run_any_more():
    still = NEAR // 2
    for hsw, hiw, stopped in (
        (0x2000, still, True),
        (0x2000, still + 1, False),
        (0x2000, -still, True),
        (0x2000, -still - 1, False),
        (0xE000, still, True),
        (0xE000, -still - 1, False),
    ):
        for off, arrives in ((0, True), (NEAR, True), (-NEAR, True), (NEAR + 1, False)):
            alone = Alone()
            drive = alone.runs(hsw)
            alone.exchange(RUNNING, 0)  # still on its way
            assert drive.is_on()
            alone.exchange(RUNNING, hsw + off)
            alone.exchange(RUNNING, hiw)
            assert drive.stopped_by_engine() is (stopped and arrives), (hsw, hiw, off)


def test_a_setpoint_of_less_than_five_percent_may_mean_a_standstill():
    least = 5 * NEAR // 2
    for hsw, stw, counts in (
        (least, pzd.ON, True),
        (least - 1, pzd.ON, False),
        (0x10000 - least, pzd.ON, True),
        (0x10000 - least + 1, pzd.ON, False),
        (0, pzd.ON, False),
        (0x2000, pzd.JOG_RIGHT, False),
    ):
        alone = Alone()
        alone.drive.start(hsw, stw)
        for hiw in (hsw, 0):
            alone.exchange(RUNNING, hiw)
        assert alone.drive.stopped_by_engine() is counts, (hsw, stw)
    alone = Alone()
    drive = alone.runs(0x2000, pzd.ON_REVERSE)  # it turns the other way
    alone.exchange(RUNNING, 0x2000)
    alone.exchange(RUNNING, 0)
    assert drive.is_on()
    alone.exchange(RUNNING, -0x2000)
    drive.hsw = 0x3000  # a new one has not arrived
    alone.exchange(RUNNING, 0)
    assert drive.is_on()
    drive.turn(pzd.ON)
    alone.exchange(RUNNING, 0x3000)
    drive.tell_speed(0)  # HIW is something else from now on
    drive.hsw = 0x3001
    alone.exchange(RUNNING, 0x3001)
    alone.exchange(RUNNING, 0)
    assert drive.is_on()
    for bit in (0x10, 0x20, 0x40):  # its setpoint does not count
        alone = Alone()
        alone.drive.control(bit, False)
        alone.drive.start(0x2000)
        for hiw in (0x2000, 0):
            alone.exchange(RUNNING, hiw)
        assert alone.drive.is_on(), hex(bit)


def test_contact_is_lost_when_the_time_is_over_and_then_on_is_void():
    alone = Alone()
    drive = alone.runs()
    answered = alone.now
    for passed_us, contact in ((1, True), (LOST_US - 1, True), (LOST_US, False)):
        drive.miss(SILENT, answered + passed_us, LOST_US, MASK)
        assert drive.contact is contact
        if contact:
            assert drive.silent_us(answered + passed_us, MASK) == passed_us
    assert drive.silent == 3 and drive.counters[5] == 3 and drive.status == 0x80
    assert drive.was_running and drive.may_run() and not drive.may_rest() and not drive.is_on()
    assert drive.stopped_by_engine() and not drive.answered_off() and drive.answered_stw == 0
    assert drive.silent_us(answered + LOST_US + 5, MASK) == LOST_US + 5
    drive.miss(OTHER_LENGTH, answered + LOST_US + 9, LOST_US, MASK)
    tried = answered + LOST_US + 9
    assert drive.silent_us(tried + 5, MASK) == 5  # since the last telegram
    for ahead_us in (1, 90_000, 100_001):  # an interrupt was so far ahead
        assert drive.silent_us(tried - ahead_us, MASK) == 0
    assert drive.silent_us(tried - 100_002, MASK) > MASK // 2
    assert drive.silent == 4 and drive.counters[2] == 1 and drive.status & 0x80
    drive.silent = 0xFFFF
    drive.miss(SILENT, answered + LOST_US + 9, LOST_US, MASK)
    assert drive.silent == 0xFFFF
    drive.counters[5] = drive.counters[0] = drive.contacts = drive.off_answers = 0xFFFF
    drive.miss(SILENT, answered + LOST_US + 9, LOST_US, MASK)
    alone.now = answered + LOST_US + 10
    assert alone.exchange(RUNNING) == (pzd.OFF1, 0)
    assert drive.counters[5] == drive.counters[0] == drive.contacts == drive.off_answers == 0
    assert drive.contact and drive.silent == drive.status == 0 and not drive.was_running
    assert drive.may_run() and drive.stopped_by_engine()
    alone.exchange()
    assert not drive.may_run() and drive.answered_off()
    drive.lose()
    assert not drive.was_running and drive.may_rest() and not drive.may_run()
    drive.tells_status = False
    alone.exchange()
    drive.lose()
    assert drive.was_running and not drive.may_rest()


def test_further_words_have_their_places_and_others_are_refused():
    alone = Alone(Layout(4, 5))
    drive = alone.drive
    for place in (3, 4, 5):
        drive.put(place, 0x1111 * place)
    alone.send()
    assert bytes(drive.request[15:21]) == b"\x33\x33\x44\x44\x55\x55"
    reply = bytes(11) + b"\xfb\x31\x01\x23\x0a\xaa\x0b\xbb\x0c\xcc\x00"
    drive.take(reply, len(reply), alone.now)
    words = [drive.word(place) for place in range(1, 6)]
    assert words == [0xFB31, 0x0123, 0x0AAA, 0x0BBB, 0x0CCC]
    drive.put(5, 0xFFFF)
    drive.put(3, 0)
    alone.send()
    assert bytes(drive.request[15:21]) == b"\x00\x00\x44\x44\xff\xff"
    for place, word in ((2, 0), (6, 0), (3, -1), (3, 0x10000)):
        try:
            drive.put(place, word)
        except ValueError:
            continue
        raise AssertionError((place, word))
    for place in (0, 6):
        try:
            drive.word(place)
        except ValueError:
            continue
        raise AssertionError(place)


def test_commands_are_counted_in_sixteen_bits_and_go_on_when_the_count_wraps():
    alone = Alone()
    drive = alone.drive
    drive.stops = drive.stops_sent = 0xFFFF
    drive.acknowledgements = drive.acknowledged = 0xFFFF
    drive.served = drive.urgent = 0xFFFF
    drive.stop()
    assert (drive.stops, drive.urgent) == (0, 0) and drive.urgency() == 3
    assert alone.exchange() == (pzd.OFF1, 0) and drive.urgency() == 0
    drive.acknowledge()
    assert drive.acknowledgements == 0
    assert alone.exchange() == (0x04FE, 0) and drive.acknowledged == 0
    alone.runs()
    drive.stops = drive.stops_sent = 0
    drive.revoke()
    assert drive.stops_sent == 0xFFFF and drive.urgency() == 4 and not drive.is_on()
    drive.revoke()  # one stop is enough
    assert drive.stops_sent == 0xFFFF
    assert alone.exchange() == (pzd.OFF1, 0) and drive.urgency() == 0


def test_each_of_many_acknowledgements_is_repeated_without_a_gap_until_it_is_confirmed():
    alone = Alone()
    for _ in range(5):
        alone.drive.acknowledge()
        for _ in range(4):
            assert alone.send() == (0x04FE, 0)
        alone.answer()
        assert alone.drive.acknowledged == alone.drive.acknowledgements
        assert [alone.exchange()[0] for _ in range(3)] == [pzd.OFF1] * 3
    alone.drive.acknowledge()
    alone.send()
    alone.drive.lose()  # then it is dropped
    assert alone.exchange() == (pzd.OFF1, 0)
    alone.drive.acknowledge()
    alone.runs()  # and with ON as well
    alone.drive.stop()
    assert [alone.exchange()[0] for _ in range(3)] == [pzd.OFF1] * 3


def test_a_foreseen_telegram_has_the_setpoint_as_it_is_then_and_counts_when_it_is_sent():
    for layout in (STANDARD, Layout(4, 5), Layout(0, 2), Layout(0, 1)):
        alone = Alone(layout)
        drive = alone.drive
        drive.start(0x2000)
        alone.exchange(RUNNING)
        telegram = bytearray(len(drive.request))
        assert drive.foresee(telegram, False) is None  # it is not whole
        frame(drive.request, drive.size, 1)
        drive.sealed = True
        assert drive.foresee(telegram, False) is drive.request
        at = drive.size + 1 - 2 * layout.pzd_words
        for hsw in (0x2001, 0x1FFF, 0x3412, 0x3411, 0xFFFF, 0xF000):
            before = bytes(drive.request)
            whole = bytearray(before[: drive.size])
            if layout.pzd_words > 1:
                whole[at], whole[at + 1] = hsw >> 8, hsw & 0xFF
                whole[-1] = 0
                for character in whole[:-1]:
                    whole[-1] ^= character
            drive.hsw = hsw
            for _ in range(2):
                assert drive.foresee(telegram, False) is telegram, hex(hsw)
                assert telegram[: drive.size] == whole and drive.request == before
            drive.follow(telegram, alone.now)
            assert drive.request[: drive.size] == whole
            if layout.pzd_words > 1:
                assert drive.foresee(telegram, False) is drive.request
                alone.answer(RUNNING, hsw)
        if layout.pzd_words > 1:
            alone.answer(RUNNING, 0)  # it had this speed, and stands
            assert drive.stopped_by_engine() and drive.foresee(telegram, False) is None
        drive.stop()
        alone.exchange()
        alone.exchange()
        frame(drive.request, drive.size, 1)
        drive.sealed = True
        drive.hsw = 0x1234  # of no meaning with OFF
        assert drive.foresee(telegram, False) is drive.request
        drive.follow(bytes(drive.request), alone.now)
        drive.address = 2
        assert drive.foresee(telegram, False) is None


def test_a_new_layout_is_filled_with_what_is_wanted_and_the_further_words_of_both():
    alone = Alone(Layout(4, 5))
    drive = alone.drive
    for place in (3, 4, 5):
        drive.put(place, 0x1111 * place)
    alone.exchange()
    drive.miss(SILENT, alone.now, LOST_US, MASK)
    drive.sealed = True
    drive.become(Drive(1, MASK, None, Layout(3, 4)))
    assert not drive.sealed and drive.silent == drive.status == 0 and drive.size == 3 + 14 + 1
    alone.exchange()
    assert bytes(drive.request[9:17]) == b"\x04\x7e\x00\x00\x33\x33\x44\x44"
    drive.become(Drive(1, MASK, None, Layout(0, 6)))
    alone.exchange()
    assert bytes(drive.request[3:15]) == b"\x04\x7e\0\0\x33\x33\x44\x44\0\0\0\0"
    drive.become(Drive(1, MASK))
    assert alone.exchange() == (pzd.OFF1, 0) and drive.further is None


def test_what_has_no_process_data_tells_nothing_of_the_motor():
    drive = Drive(1, MASK, None, Layout(4, 0))
    drive.take(bytes((2, 10, 1)) + bytes(8) + b"\xff\xff", 12, 0)
    assert drive.contact and drive.zsw == drive.hiw == 0 and not drive.may_run()
    try:
        drive.start(0)
    except ValueError:
        return
    raise AssertionError


def test_the_trouble_that_is_told_changes_when_another_has_outweighed_it():
    alone = Alone()
    drive = alone.drive
    for same, others in ((1, 2), (2, 3), (3, 3), (9, 3)):
        alone.exchange()
        for _ in range(same):
            drive.miss(SILENT, alone.now, LOST_US, MASK)
        for _ in range(others):
            drive.miss(OTHER_LENGTH, alone.now, LOST_US, MASK)
            assert drive.trouble == SILENCE, (same, others)
        drive.miss(OTHER_LENGTH, alone.now, LOST_US, MASK)
        assert drive.trouble == TROUBLES[OTHER_LENGTH] != SILENCE, (same, others)
        alone.exchange()
        drive.miss(SILENT, alone.now, LOST_US, MASK)  # after a reply it begins anew
        assert drive.trouble == SILENCE


def test_each_finding_has_its_counter_and_its_bit_of_the_error_status_word():
    """Specification A-5.2.3; a telegram that is garbled counts as one of a wrong length."""
    findings = ((1, 1, 0x08), (2, 2, 0x40), (3, 3, 0x10), (4, 4, 0x08), (5, 5, 0x80))
    for finding, row, bit in findings + ((6, 6, 0x20), (7, 2, 0x40)):
        alone = Alone()
        alone.drive.miss(finding, alone.now, LOST_US, MASK)
        assert alone.drive.status == bit, finding
        counters = [1, 0, 0, 0, 0, 0, 0]
        counters[row] += 1
        assert list(alone.drive.counters) == counters, finding


def test_what_a_drive_calls_for_stands_at_its_address_and_in_the_two_words_for_all():
    """Rows of 32 for commands, for turns that would be too late, and for more than its turn; then
    whether any of the first, or of the others, is to be looked at."""
    for address in (0, 31):
        attention = bytearray(ATTENTION)
        drive = Drive(address, MASK, attention)
        command, overdue, wants, any_of_them, soon = address, 32 + address, 64 + address, 96, 97
        reply = bytes((2, 14, address)) + bytes(13)

        def exchange(drive=drive, reply=reply):
            drive.fill(0)
            drive.take(reply, 16, 0)

        def start(drive=drive, exchange=exchange):
            drive.start(0x1000)
            exchange()  # a stop that is owed goes first
            exchange()

        exchange()
        for before, call, told in (
            (None, drive.hurry, {command: 3, any_of_them: 1}),
            (drive.hurry, lambda: drive.fill(0), {}),
            (None, drive.acknowledge, {command: 3, any_of_them: 1}),
            (exchange, drive.stop, {command: 3, any_of_them: 1}),
            (None, lambda: drive.fill(0), {wants: 1, soon: 1}),  # it is repeated
            (exchange, lambda: drive.start(0x1000), {command: 2, any_of_them: 1}),
            (exchange, drive.stop, {command: 4, any_of_them: 1}),
            (exchange, drive.revoke, {}),
            (start, drive.revoke, {command: 4, any_of_them: 1}),
            (start, drive.lose, {command: 4, any_of_them: 1}),
            (exchange, lambda: drive.want_turns(True), {wants: 1, soon: 1}),
            (None, lambda: drive.want_turns(False), {}),
            (exchange, lambda: drive.ask(pkw.read(700)), {soon: 1}),
            (exchange, drive.ask_soon, {wants: 1, soon: 1}),
            (exchange, drive.press, {overdue: 2, soon: 1}),
            (None, lambda: drive.press(1), {overdue: 1, soon: 1}),
            (None, lambda: drive.control(0x2000, True), {}),
            (exchange, drive.call, {}),
            (exchange, drive.call_again, {wants: 1, any_of_them: 1, soon: 1}),
            (drive.stop, lambda: drive.move(5), {5: 3, 64 + 5: 1, any_of_them: 1, soon: 1}),
        ):  # fmt: skip
            if before:
                before()
            is_there = attention[command]
            for index in range(ATTENTION):
                attention[index] = 0
            attention[command] = is_there if before == drive.hurry else 0
            call()
            stands = {index: value for index, value in enumerate(attention) if value}
            assert stands == told, (address, call, stands, told)
    assert len(attention) == 98


def test_each_bit_of_the_control_word_may_be_changed_or_is_refused():
    for bit in range(16):
        for on in (True, False):
            alone = Alone()
            drive, mask = alone.drive, 1 << bit
            try:
                drive.control(mask, on)
            except ValueError as error:
                assert bit not in (3, 4, 5, 6, 13, 14, 15), bit
                assert str(error) == "STW bits %04Xh are no matter of control()" % mask
                assert alone.exchange()[0] == pzd.OFF1
                continue
            assert bit in (3, 4, 5, 6, 13, 14, 15), bit
            changed = pzd.OFF1 | mask if on else pzd.OFF1 & ~mask
            assert alone.exchange()[0] == changed == alone.exchange()[0]
            drive.control(0xE078, True)
            assert alone.exchange()[0] == pzd.OFF1 | 0xE078
            drive.control(mask, False)
            assert alone.exchange()[0] == (pzd.OFF1 | 0xE078) & ~mask
    alone = Alone()
    try:
        alone.drive.control(0x0401 | 0x0010, False)
    except ValueError as error:
        assert "0401h" in str(error)  # what was wrong about it
    else:
        raise AssertionError
    for word in (0, pzd.ON, pzd.OFF1 | 1, None):
        stops, urgency = alone.drive.stops, alone.drive.urgency()
        try:
            alone.drive.stop(word)
        except ValueError:
            assert (alone.drive.stops, alone.drive.urgency()) == (stops, urgency)
            continue
        raise AssertionError(word)


def test_two_percent_of_the_speed_are_near_it_and_an_even_count():
    drive = Drive(1, MASK)
    for full_scale, near in ((0x4000, 326), (100, 2), (99, 0), (199, 2), (200, 4), (0, 0)):
        drive.tell_speed(full_scale)
        assert drive.near == near, full_scale
    for pzd_words in (0, 1, 2):  # only without a status word its reply may be like the request
        drive = Drive(1, MASK, None, Layout(4, pzd_words))
        assert drive.may_reply_alike() is (pzd_words == 0)
