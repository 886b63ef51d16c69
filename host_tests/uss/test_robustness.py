# SPDX-License-Identifier: MIT
"""What a line does to telegrams, and what neither the master nor a drive may make of it.

The set is the one that the protocol's documents suggest: each of SET's rows names a disturbance
and the test that holds it, here or elsewhere. Section numbers are those of the specification
E20125-D0001-S302-A1-7600.
"""

from boards.sim.line.wire import BURST_LIMIT
from drive_bench import HALF, OFF1, RUN, Bench, telegram
from line_bench import TIMING, Line
from uss import pkw
from uss.layout import VARIABLE, Layout

HERE = "uss/test_robustness"
LINK = "sim/drives/test_simulated_drive_link"
PARAMETERS = "sim/drives/test_simulated_drive_parameters"

# What the line or a partner does; how a master takes it; how a drive takes it: file and test.
# None: it is no matter of that side.
SET = (
    ("wrong BCC",
     (HERE, "test_a_reply_with_a_wrong_bcc_is_counted_as_such"),
     (LINK, "test_every_single_bit_error_meets_silence_and_starts_nothing")),
    ("BCC without STX",
     (HERE, "test_a_reply_whose_bcc_leaves_out_stx_is_counted_as_such"),
     (LINK, "test_a_bcc_without_the_stx_meets_silence")),
    ("LGE 00, 01, 02, FF, half words",
     (HERE, "test_a_reply_with_an_lge_that_cannot_be_is_refused_by_its_length"),
     (HERE, "test_a_drive_with_variable_length_takes_no_lge_that_cannot_be")),
    ("LGE of another layout",
     ("uss/test_layouts", "test_a_telegram_of_another_layout_is_not_received"),
     (LINK, "test_lge_has_to_fit_the_layout")),
    ("LGE larger than what follows",
     (HERE, "test_a_reply_that_is_shorter_than_its_lge_ends_with_the_residual_time"),
     (HERE, "test_a_drive_waits_for_what_lge_promises_until_the_residual_time_is_over")),
    ("LGE smaller than what follows",
     (HERE, "test_a_reply_that_is_longer_than_its_lge_is_refused_by_its_length"),
     (HERE, "test_a_drive_whose_lge_is_too_short_swallows_what_follows")),
    ("02h inside the data",
     (HERE, "test_a_reply_full_of_02h_is_taken_whole_or_not_at_all"),
     (HERE, "test_a_02h_is_a_start_only_behind_a_pause")),
    ("02h inside the data, a telegram in a telegram",
     ("uss/test_receiver", "test_a_02h_inside_the_data_starts_nothing"),
     (LINK, "test_a_telegram_inside_another_ones_data_is_not_seen")),
    ("no pause before STX",
     (HERE, "test_a_reply_1_9_characters_after_the_request_starts_nothing"),
     (LINK, "test_a_telegram_starts_after_two_characters_of_silence")),
    ("gaps of just below and above half the compressed time",
     ("uss/test_receiver", "test_gaps_of_half_the_telegram_are_allowed_and_no_more"),
     (LINK, "test_gaps_are_allowed_up_to_half_the_compressed_time")),
    ("a single gap of 1.9 and of 2.1 characters",
     ("uss/test_receiver", "test_a_gap_inside_the_telegram_is_no_error"),
     (HERE, "test_a_single_gap_inside_a_telegram_is_none_of_the_drives_business")),
    ("parity and frame errors at each place",
     (HERE, "test_a_character_that_came_wrong_spoils_the_reply_wherever_it_stands"),
     (HERE, "test_a_character_that_is_garbled_spoils_the_telegram_wherever_it_stands")),
    ("overrun at each place",
     (HERE, "test_a_character_that_never_came_spoils_the_reply_wherever_it_stood"),
     (HERE, "test_a_character_that_is_lost_spoils_the_telegram_wherever_it_stood")),
    ("another address; special and undefined bits of ADR; mirror for another address",
     (HERE, "test_a_reply_with_another_adr_is_counted_as_such"),
     (LINK, "test_each_address_answers_to_itself_only")),
    ("mirror",
     ("uss/test_golden", "test_a_mirror_telegram_that_came_back_is_recognised"),
     (LINK, "test_a_mirror_telegram_comes_back_and_does_nothing")),
    ("broadcast: no reply",
     None,
     (LINK, "test_a_broadcast_changes_what_its_enable_array_names")),
    ("wrong PNU and IND in the reply",
     (HERE, "test_a_reply_about_another_parameter_is_ignored_and_its_process_data_are_taken"),
     None),
    ("reply 1.9 characters after the request",
     (HERE, "test_a_reply_1_9_characters_after_the_request_starts_nothing"),
     None),
    ("reply after 19.9 and 20.1 ms",
     (HERE, "test_a_reply_is_in_time_for_20_ms"),
     (LINK, "test_the_reply_delay_can_be_set")),
    ("stale reply for 1...n cycles",
     (HERE, "test_a_stale_reply_is_ignored_for_as_long_as_it_comes"),
     (PARAMETERS, "test_stale_replies")),
    ("AK 0 for n cycles",
     (HERE, "test_no_reply_yet_is_waited_out"),
     (PARAMETERS, "test_no_task_gets_no_reply_id")),
    ("AK 7 in 3, 4 and a variable number of words",
     (HERE, "test_a_refusal_has_its_number_where_the_layout_has_it"),
     (PARAMETERS, "test_three_parameter_words")),
    ("AK 8",
     (HERE, "test_no_rights_is_a_refusal_of_writes_and_no_answer_to_reads"),
     (PARAMETERS, "test_no_change_rights")),
    ("AK 9 to 12",
     (HERE, "test_a_change_report_answers_nothing"),
     None),
    ("a dead node first, in the middle, last in the list",
     (HERE, "test_a_dead_node_keeps_nobody_else_from_being_asked"),
     None),
    ("a node twice in the list",
     ("uss/test_master", "test_the_list_goes_round_and_a_node_may_stand_in_it_twice"),
     None),
    ("own echo before the reply",
     (HERE, "test_the_own_echo_is_skipped"),
     None),
    ("noise of any kind",
     ("uss/test_receiver", "test_noise_of_any_kind_is_survived_and_the_next_reply_taken"),
     (HERE, "test_a_drive_survives_the_longest_burst")),
)  # fmt: skip


def test_every_item_of_the_set_has_its_tests():
    files = {}
    for item, *places in SET:
        assert any(places), item
        for file, test in filter(None, places):
            if file not in files:
                with open("host_tests/%s.py" % file) as source:
                    files[file] = source.read()
            assert "\ndef %s()" % test in files[file], (item, file, test)


# --- the master: it takes nothing of what is wrong, counts it, and the next exchange works ------

TCH = TIMING.character_us
READY, RUNNING = 0xFB31, 0xFB34
GOOD_REPLY = telegram(1, 0, 0, 0, 0, RUNNING, 0x2000)
GOOD, START, LENGTH, BCC, ADDRESS, NO_REPLY, RESIDUAL = range(7)  # places in Drive.counters


class Exchange:
    """A master and drive 1, which has answered once: ready, standing."""

    def __init__(self, layout=None):
        self.line = Line()
        self.drive = self.line.master.turns.add(1, layout or Layout(4, 2))
        words = self.drive.layout.net_count // 2 - self.drive.layout.pzd_words
        self.idle = [0] * words
        self.process_data = [READY, 0][: self.drive.layout.pzd_words]
        self.hear(telegram(1, *self.idle + self.process_data))
        assert self.drive.contact

    def hear(self, reply, pause_us=3 * TCH):
        """One exchange in which that comes back."""
        self.line.answer = lambda request: [(pause_us, bytes(reply))] if reply else None
        self.line.exchange()

    def refuses(self, reply, kind, pause_us=3 * TCH):
        """Nothing of it is taken, it counts as `kind`, and the reply after it is taken."""
        drive = self.drive
        before = list(drive.counters)
        zsw, hiw = drive.zsw, drive.hiw
        self.hear(reply, pause_us)
        before[kind] += 1
        assert list(drive.counters) == before, (kind, drive.counters)
        assert (drive.zsw, drive.hiw) == (zsw, hiw) and drive.contact
        assert drive.silent == 1 and drive.status
        self.hear(telegram(1, *self.idle + self.process_data))
        assert drive.counters[GOOD] == before[GOOD] + 1 and drive.silent == drive.status == 0

    def ask(self, job, *pkw_words):
        """One exchange of a job, which is answered by these PKW words."""
        if job.state == pkw.NEW:
            self.drive.ask(job)
        self.hear(telegram(1, *list(pkw_words) + [RUNNING, 0x2000]))
        assert self.drive.zsw == RUNNING and self.drive.hiw == 0x2000


def test_a_reply_with_a_wrong_bcc_is_counted_as_such():
    exchange = Exchange()
    for bit in range(8):
        exchange.refuses(GOOD_REPLY[:-1] + bytes([GOOD_REPLY[-1] ^ 1 << bit]), BCC)
    assert exchange.drive.counters[BCC] == 8


def test_a_reply_whose_bcc_leaves_out_stx_is_counted_as_such():
    Exchange().refuses(GOOD_REPLY[:-1] + bytes([GOOD_REPLY[-1] ^ 2]), BCC)


def with_lge(reply, lge):
    """The reply with another LGE, and a BCC that fits it."""
    changed = bytearray(reply)
    changed[1] = lge
    changed[-1] ^= lge ^ reply[1]
    return bytes(changed)


def test_a_reply_with_an_lge_that_cannot_be_is_refused_by_its_length():
    for layout in (Layout(4, 2), Layout(VARIABLE, 2)):
        exchange = Exchange(layout)
        for lge in (0x00, 0x01, 0x02, 0x03, 0x0D, 0x0F, 0xFF):
            exchange.refuses(with_lge(GOOD_REPLY, lge), LENGTH)


def test_a_reply_that_is_shorter_than_its_lge_ends_with_the_residual_time():
    """With a fixed length it is refused at once. Behind it the line must be silent as ever."""
    for lge in (0x10, 0x20, 0xFE):
        Exchange().refuses(with_lge(GOOD_REPLY, lge), LENGTH)
        exchange = Exchange(Layout(VARIABLE, 2))
        since = exchange.line.now
        exchange.refuses(with_lge(GOOD_REPLY, lge), RESIDUAL)
        assert exchange.line.now - since >= TIMING.residual_us(lge - 2), lge


def test_a_reply_that_is_longer_than_its_lge_is_refused_by_its_length():
    for lge in (0x06, 0x0A, 0x0C):
        for layout in (Layout(4, 2), Layout(VARIABLE, 2)):
            Exchange(layout).refuses(with_lge(GOOD_REPLY, lge), LENGTH)


def test_a_reply_full_of_02h_is_taken_whole_or_not_at_all():
    """Drive 2, PNU 514, values and setpoint of 0202h."""
    line = Line()
    drive = line.master.turns.add(2)
    reply = telegram(2, 0x1202, 0x0002, 0x0202, 0x0202, 0x0202, 0x0202)
    line.answer = lambda request: reply
    line.exchange()
    assert drive.zsw == drive.hiw == 0x0202
    for place in range(1, len(reply)):
        line.answer = lambda request, from_place=place: reply[from_place:]
        line.exchange()
        assert drive.counters[GOOD] == 1, place
    line.answer = lambda request: reply
    line.exchange()
    assert drive.counters[GOOD] == 2


def test_a_reply_1_9_characters_after_the_request_starts_nothing():
    """A-5.1.2: the pause belongs to the telegram."""
    Exchange().refuses(GOOD_REPLY, START, TIMING.start_interval_us * 95 // 100)
    exchange = Exchange()
    exchange.hear(GOOD_REPLY, TIMING.start_interval_us)
    assert exchange.drive.zsw == RUNNING


def test_a_reply_is_in_time_for_20_ms():
    """A-5.2.1.1. The one that is late is no reply to the next request either."""
    exchange = Exchange()
    exchange.hear(GOOD_REPLY, 19_900)
    assert exchange.drive.zsw == RUNNING
    exchange.refuses(telegram(1, 0, 0, 0, 0, READY, 0), NO_REPLY, 20_100)


def test_a_character_that_came_wrong_spoils_the_reply_wherever_it_stands():
    """What is left of a parity or frame error: other bits, or zeros, and a UART says no more."""
    exchange = Exchange()
    reply = telegram(1, 0x1101, 0x0101, 0x0101, 0x0101, RUNNING, 0x2001)
    for place in range(len(reply)):
        kind = {0: START, 1: LENGTH}.get(place, BCC)
        for wrong in (reply[place] ^ 0x10, reply[place] ^ 0x80, 0x00, 0xFF):
            changed = reply[:place] + bytes([wrong]) + reply[place + 1 :]
            exchange.refuses(changed, kind)


def test_a_character_that_never_came_spoils_the_reply_wherever_it_stood():
    """An overrun. The residual time tells, or LGE when that has gone."""
    exchange = Exchange()
    reply = telegram(1, 0x1121, 0x0141, 0x0161, 0x0181, RUNNING, 0x20A1)
    for place in range(len(reply)):
        kind = {0: START, 1: LENGTH}.get(place, RESIDUAL)
        exchange.refuses(reply[:place] + reply[place + 1 :], kind)


def test_a_reply_with_another_adr_is_counted_as_such():
    """Another node, a bit that nobody asked for, and combinations that do not exist."""
    exchange = Exchange()
    for adr in (0, 2, 31, 0x21, 0x41, 0x81, 0x61, 0xA1, 0xC1, 0xE1):
        exchange.refuses(telegram(adr, 0, 0, 0, 0, RUNNING, 0x2000), ADDRESS)


def test_the_own_echo_is_skipped():
    """Two wires and a receiver that stays on: the request is heard before the reply."""
    exchange = Exchange()
    line = exchange.line
    line.answer = lambda request: [(-len(request) * TCH, request), (3 * TCH, GOOD_REPLY)]
    line.exchange()
    assert exchange.drive.zsw == RUNNING and exchange.drive.counters[GOOD] == 2
    line.answer = lambda request: [(-len(request) * TCH, request)]
    line.exchange()
    assert exchange.drive.counters[NO_REPLY] == 1, "an echo alone is no reply"


# --- the master and its parameters --------------------------------------------------------------


def test_a_reply_about_another_parameter_is_ignored_and_its_process_data_are_taken():
    exchange = Exchange()
    job = pkw.read(1000)
    for words in ((0x12BC, 0, 0, 5), (0x13E8, 1, 0, 5), (0x13E8, 0x8000, 0, 5), (0x13E9, 0, 0, 5)):
        exchange.ask(job, *words)
        assert job.state == pkw.PENDING, words
    exchange.ask(job, 0x13E8, 0, 0, 5)
    assert job.state == pkw.DONE and job.integer_value() == 5


def test_a_stale_reply_is_ignored_for_as_long_as_it_comes():
    """C-4.2.1.1: until it is ready a drive may go on with the reply to the task before."""
    for cycles in range(1, 13):
        exchange = Exchange()
        job = pkw.read(1000)
        for _ in range(cycles):
            exchange.ask(job, 0x12BC, 0, 0, 5)
            assert job.state == pkw.PENDING, cycles
        exchange.ask(job, 0x13E8, 0, 0, 2)
        assert job.state == pkw.DONE and job.integer_value() == 2, cycles


def test_no_reply_yet_is_waited_out():
    """C-4.2.1.1: AK 0 while the reply is not ready."""
    for cycles in range(1, 13):
        exchange = Exchange()
        job = pkw.write_word(1000, 5)
        for _ in range(cycles):
            exchange.ask(job, 0, 0, 0, 0)
            assert job.state == pkw.PENDING, cycles
        exchange.ask(job, 0x13E8, 0, 0, 5)
        assert job.state == pkw.DONE, cycles


def test_a_refusal_has_its_number_where_the_layout_has_it():
    """PWE1 of three words and with variable length, PWE2 of four (C-4.2.3)."""
    for layout, pwe in (
        (Layout(3, 2), (17,)), (Layout(4, 2), (0, 17)), (Layout(VARIABLE, 2), (17,)),
    ):  # fmt: skip
        exchange = Exchange(layout)
        job = pkw.write_word(1000, 5)
        exchange.ask(job, 0x73E8, 0, *pwe)
        assert job.state == pkw.REFUSED and job.error == 17, layout


def test_no_rights_is_a_refusal_of_writes_and_no_answer_to_reads():
    exchange = Exchange()
    job = pkw.write_word(1000, 5)
    exchange.ask(job, 0x83E8, 0, 0, 0)
    assert job.state == pkw.REFUSED and job.error == pkw.NO_CHANGE_RIGHTS
    exchange = Exchange()
    job = pkw.read(1000)
    exchange.ask(job, 0x83E8, 0, 0, 0)
    assert job.state == pkw.PENDING


def test_a_change_report_answers_nothing():
    """AK 9 to 12, also of the very parameter that is asked for, and whatever bit 11 says."""
    exchange = Exchange()
    job = pkw.read(1000)
    for reply in range(9, 13):
        for bit_11 in (0, 0x0800):
            exchange.ask(job, reply << 12 | bit_11 | 1000, 0, 0, 5)
            assert job.state == pkw.PENDING, reply
    exchange.ask(job, 0x1BE8, 0, 0, 5)
    assert job.state == pkw.DONE


# --- the master and its list --------------------------------------------------------------------


def test_a_dead_node_keeps_nobody_else_from_being_asked():
    """First, in the middle, last in the list, where it stays: it may answer again."""
    for dead in (1, 2, 3):
        line = Line()
        alive = lambda request: telegram(request[2], 0, 0, 0, 0, READY, 0)  # noqa: E731
        line.answer = lambda request, dead=dead: None if request[2] == dead else alive(request)
        drives = [line.master.turns.add(address) for address in (1, 2, 3)]
        line.run(3_000_000)
        for drive in drives:
            assert drive.contact == (drive.address != dead)
            if drive.contact:
                assert drive.counters[GOOD] > 20 and sum(drive.counters[1:]) == 0
        assert drives[dead - 1].counters[NO_REPLY] >= 3 and drives[dead - 1].silent >= 3
        assert drives[dead - 1] in line.master.turns.list
        line.answer = alive
        line.run(2_000_000)
        assert drives[dead - 1].contact and drives[dead - 1].silent == 0


# --- the drive: it says nothing, does nothing, and hears the next telegram ----------------------

REQUEST = telegram(1, 0, 0, 0, 0, OFF1, 0)
VARIABLE_LENGTH = {2013: 127}


class Intruder:
    """Somebody who talks when it is not his turn."""

    name = "intruder"

    def hear(self, burst):
        pass


def stays_silent_and_hears_the_next(bench, characters):
    """`characters` would start the motor if they were a telegram."""
    starts = bench.drive.starts
    assert bench.ask(characters) is None, characters
    assert bench.drive.starts == starts, characters
    assert bench.ask(REQUEST), characters


def test_a_drive_waits_for_what_lge_promises_until_the_residual_time_is_over():
    """A-6.3. With variable length a longer LGE may be right; the next pause ends it."""
    for lge in (0x10, 0x12, 0x20, 0x40, 0xFE):
        bad = bytearray(telegram(1, 0, 0, 0, 0, RUN, HALF))
        bad[1] = lge
        bad[-1] ^= lge ^ 0x0E
        bench = Bench(VARIABLE_LENGTH)
        bench.send(bad)
        bench.wait(0.25)  # more than the 219 ms of the longest telegram
        assert bench.heard == [] and bench.counters() == [0] * 8, lge  # no counter shows it
        assert bench.drive.starts == 0 and bench.ask(REQUEST), lge


def test_a_drive_whose_lge_is_too_short_swallows_what_follows():
    for lge in (0x04, 0x06, 0x08, 0x0A, 0x0C):
        bad = bytearray(telegram(1, 0, 0, 0, 0, RUN, HALF))
        bad[1] = lge
        bad[-1] ^= lge ^ 0x0E
        stays_silent_and_hears_the_next(Bench(VARIABLE_LENGTH), bad)


def test_a_drive_with_variable_length_takes_no_lge_that_cannot_be():
    """Nothing between LGE and BCC, half words, and less than the PZD words that are agreed."""
    for lge in (0x00, 0x01, 0x02, 0x03, 0x05, 0x0D, 0x0F, 0xFF):
        bad = bytearray(telegram(1, 0, 0, 0, 0, RUN, HALF))
        bad[1] = lge
        bad[-1] ^= lge ^ 0x0E
        stays_silent_and_hears_the_next(Bench(VARIABLE_LENGTH), bad)


def test_a_02h_is_a_start_only_behind_a_pause():
    """ADR 2, PNU 514 (0202h), a setpoint of 0202h: none of them begins a telegram."""
    bench = Bench(address=2)
    assert bench.ask(telegram(2, 0x1202, 0x0002, 0x0202, 0x0202, OFF1, 0x0202))
    assert bench.counters()[:2] == [1, 0]


def test_a_single_gap_inside_a_telegram_is_none_of_the_drives_business():
    """A-6.3: the receiver need not watch it. A drive does where its switch `strict_gaps` says so:
    a gap of two characters then ends the telegram, as the residual time would.
    """
    for strict, tenths, answers in ((False, 19, 1), (False, 21, 1), (True, 19, 1), (True, 21, 0)):
        bench = Bench()
        bench.drive.switches.strict_gaps = strict
        bench.send(REQUEST[:8])
        bench.send(REQUEST[8:], tenths * bench.wire.character_us // 10)
        bench.wait(0.05)
        assert len(bench.heard) == answers, (strict, tenths)
        assert bench.drive.read(2024) == answers, (strict, tenths)
        assert bench.drive.residual_time_errors == 1 - answers, (strict, tenths)


def test_a_character_that_is_garbled_spoils_the_telegram_wherever_it_stands():
    """Parity and frame errors: somebody talks for a moment over each of its characters."""
    for place in range(len(REQUEST)):
        bench = Bench()
        intruder = Intruder()
        bench.wire.attach(intruder)
        bench.control(OFF1)
        bench.clock.advance(5000)
        bench.wire.talk(bench, telegram(1, 0, 0, 0, 0, RUN, HALF), 16)
        bench.clock.advance(place * bench.wire.character_us + 100)
        bench.wire.talk(intruder, b"\x55", 1)
        bench.wait(0.05)
        assert bench.drive.starts == 0, place
        # What is judged first counts: the start, LGE, BCC, and then the errors of characters.
        frame, bcc, length = (bench.drive.read(number) for number in (2026, 2030, 2031))
        expected = {0: (1, 0, 0), 1: (0, 0, 1)}.get(place, (0, 1, 0))
        assert (frame, bcc, length) == expected, place
        assert bench.drive.read(2024) == 1 and bench.drive.read(2025) == 1, place
        assert bench.ask(REQUEST), place


def test_a_character_that_is_lost_spoils_the_telegram_wherever_it_stood():
    """An overrun of the receiver."""
    bench = Bench()
    bench.control(OFF1)
    good = telegram(1, 0, 0, 0, 0, RUN, HALF)
    for place in range(len(good)):
        stays_silent_and_hears_the_next(bench, good[:place] + good[place + 1 :])


def test_a_drive_survives_the_longest_burst():
    for character in (0x00, 0x02, 0xFF):
        stays_silent_and_hears_the_next(Bench(), bytes([character]) * BURST_LIMIT)
