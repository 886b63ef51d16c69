# SPDX-License-Identifier: MIT
"""What the panel reads of its drives before a motor may turn: several surveys, few spare jobs."""

import struct

import micropython

from boards.sim.dice import Dice
from uss import pkw
from uss.drive import Drive
from uss.families import G120, MM3, MM4, rows
from uss.layout import Layout
from uss.receiver import SILENCE
from uss.survey import Survey, centihertz, rpm, spare_jobs
from uss.telegram_count import TelegramCount

MASK = (1 << 30) - 1
ROWS = len(MM4.survey)
US = 20_000  # an exchange
LOST_US = 1_000_000
R2024 = b"\x10\x18\x80\x00"  # PKE and IND of the task that reads it,
P1080, P1082 = b"\x14\x38\x00\x00", b"\x14\x3a\x00\x00"
SEEDS = range(1, 5)


class Line:
    """Drives in contact that answer each question in their next telegram, and their surveys."""

    def __init__(self, addresses, family=MM4):
        self.spares = spare_jobs()
        self.drives = [Drive(address, MASK) for address in addresses]
        self.surveys = [Survey(drive, family, MASK, self.spares) for drive in self.drives]
        self.now = 0
        self.questions = [0] * len(self.drives)
        self.counts = {}  # by place: r2024, and by how much it grows with each telegram
        self.silent = set()
        self.odd = 0  # so many of the next answers make no sense
        self.without = None  # PKE and IND of what they lack
        self.error = 0  # how they refuse it: 0, there is no such parameter
        self.told = {}  # by PKE and IND: a value that is not 50.0
        self.works_on = None  # PKE and IND of what they never have an answer to
        self.silent_on = None  # PKE and IND of what they do not answer at all
        self.asked = []  # PKE and IND of each question

    def exchange(self, place):
        """A reply comes, and the next telegram goes out before the panel has looked at it."""
        drive = self.drives[place]
        self.now += US
        if place in self.silent or bytes(drive.request[3:7]) == self.silent_on:
            drive.miss(SILENCE, self.now, LOST_US, MASK)
        else:
            self._reply(drive, place)
        drive.fill(self.now)
        if drive.request[3] >> 4:
            self.questions[place] += 1
            self.asked.append(bytes(drive.request[3:7]))

    def _reply(self, drive, place):
        count, step = self.counts.get(place, (0x4248, 0))
        count = count + step & 0xFFFF
        self.counts[place] = (count, step)
        net = bytearray(16)
        struct.pack_into(">H", net, 11, 0xFB31)
        if drive.request[3] >> 4:
            net[3:11] = b"\x20" + bytes(drive.request[4:7]) + b"\x42\x48\x00\x00"  # 50.0
            net[3] |= drive.request[3] & 0x07
            net[7:11] = self.told.get(bytes(drive.request[3:7]), net[7:11])
            if bytes(drive.request[3:7]) == R2024:
                net[7:11] = struct.pack(">HH", 0, count)
            if self.odd:
                self.odd -= 1
                net[3] ^= 0x30  # a word, and there is something in front of it
            if bytes(drive.request[3:7]) == self.without:
                net[3] |= 0x70
                net[7:11] = struct.pack(">HH", 0, self.error)
            if bytes(drive.request[3:7]) == self.works_on:
                net[3:11] = bytes(8)
        pkw_words = drive.layout.pkw_words
        if pkw_words == 3:
            net = net[:7] + net[9:]  # it answers with the low word
            net[3] ^= 0x30 if net[3] >> 4 == 2 else 0
        elif not pkw_words:
            net = net[:3] + net[11:]
        drive.take(net, len(net), self.now)


def test_frequencies_are_what_a_floating_point_number_says():
    for hertz in (0.0, 0.004, 0.005, 0.01, 5.0, 41.9, 49.995, 50.0, 87.5, 349.99, 649.99, 650.0):
        high, low = words(hertz)
        assert centihertz(high, low) == int(single(high, low) * 100 + 0.5), hertz
    for seed in SEEDS:
        print("seed", seed)
        dice = Dice(seed)
        for _ in range(2_000):
            high, low = words(dice.random(0, 650_000_000) / 1e6)
            hertz = single(high, low)
            assert abs(centihertz(high, low) - hertz * 100) < 0.51, hertz


def test_what_is_no_frequency_of_a_drive_is_unknown():
    nothing = ((0x7FC0, 0), (0x7F80, 0), (0xFF80, 0), (0x8000, 1), words(-0.01), words(650.01))
    for high, low in nothing + (words(1e30), words(-1e30), (0xFFFF, 0xFFFF)):
        assert centihertz(high, low) == -1, (high, low)
    assert centihertz(0x8000, 0) == 0  # minus nothing
    assert centihertz(*words(0.006)) == 1
    assert centihertz(0, 1) == centihertz(*words(1e-30)) == 0


def test_speeds_are_what_a_floating_point_number_says():
    for speed in (0.0, 0.25, 0.5, 1.0, 1.49, 1.5, 1395.6, 3000.0, 65_535.5, 200_000.5, 210_000.0):
        high, low = words(speed)
        assert rpm(high, low) == int(single(high, low) + 0.5), speed
    assert rpm(0x8000, 0) == 0  # minus nothing
    nothing = ((0x7FC0, 0), (0x7F80, 0), (0xFF80, 0), (0x8000, 1), (0x8001, 0), words(-0.5))
    for high, low in nothing + (words(-3000.0), words(210_001.0), words(262_144.0), words(1e30)):
        assert rpm(high, low) == -1, (high, low)


def test_neither_conversion_takes_memory_not_even_of_next_to_nothing():
    if not hasattr(micropython, "heap_lock"):
        return  # CPython
    values = [words(value) for value in (0.0, 1e-30, 1e-18, 0.004, 50.0, 649.0, 2e5, 1e30)]
    micropython.heap_lock()
    try:
        for high, low in values:
            centihertz(high, low)
            rpm(high, low)
    finally:
        micropython.heap_unlock()


def words(hertz):
    return struct.unpack(">HH", struct.pack(">f", hertz))


def single(high, low):
    return struct.unpack(">f", struct.pack(">HH", high, low))[0]


def test_one_that_asks_alone_has_a_question_in_every_telegram():
    line = Line((1,))
    line.exchange(0)
    ask_everything(line, 0)


def ask_everything(line, place):
    """From the first telegram to the last not one goes without a question."""
    survey = line.surveys[place]
    survey.recheck()
    before = line.questions[place]
    for _ in range(ROWS + 1):
        for _ in range(4):
            survey.step(line.now)
        line.exchange(place)
    assert line.questions[place] - before >= ROWS, line.questions[place] - before
    for _ in range(4):
        survey.step(line.now)
    assert survey.complete and not survey.unchecked


def test_of_several_that_ask_each_gets_all_its_answers():
    """The spare jobs go from hand to hand, and no answer lands at another drive's."""
    for seed in SEEDS:
        print("seed", seed)
        dice = Dice(seed)
        line = Line(range(1, 8))
        for place in range(7):
            line.exchange(place)
        for _ in range(6_000):
            line.surveys[dice.random(0, 6)].step(line.now)
            if dice.random(0, 1):
                line.exchange(dice.random(0, 6))
            if dice.random(1, 100) == 1:
                line.surveys[dice.random(0, 6)].recheck()
        for place in range(7):
            assert line.surveys[place].complete and line.questions[place] > 100, place
            assert 50_00 in line.surveys[place].values


def test_those_that_fall_silent_give_the_spare_jobs_back():
    line = Line(range(1, 7))
    last = 5
    for place in range(6):
        line.exchange(place)
    for place in range(last):
        for _ in range(4):
            line.surveys[place].step(line.now)
        line.silent.add(place)
    assert not line.spares  # one had none
    for _ in range(200):  # 24 s
        for place in range(6):
            line.exchange(place)
            line.surveys[place].step(line.now)
    assert line.surveys[last].complete
    ask_everything(line, last)


def test_one_answer_that_makes_no_sense_is_an_accident_and_two_in_a_row_are_doubted():
    for odd in (1, 2):
        line = Line((1,))
        line.exchange(0)
        for _ in range(3):
            line.surveys[0].step(line.now)
        line.odd = odd
        let_pass(line, 8)
        assert line.odd == 0 and line.drives[0].doubted is (odd == 2)


def test_accidents_do_not_add_up_and_excuse_nothing_that_makes_no_sense_later():
    line = Line((1,))
    line.exchange(0)
    for _ in range(3):
        line.surveys[0].step(line.now)
    for _ in range(3):
        line.odd = 1
        let_pass(line, 3)
        assert line.odd == 0 and not line.drives[0].doubted
    line.odd = 4
    for _ in range(2):
        for _ in range(4):
            if not line.drives[0].doubted:
                let_pass(line, 1)
        assert line.drives[0].doubted and not line.surveys[0].complete
        line.drives[0].doubted = False  # as whoever gives it another layout does
    let_pass(line, 4)  # nothing is left to be doubted
    assert line.odd == 0 and not line.drives[0].doubted


# --- what is asked when -------------------------------------------------------------------------

ROUND = [50, 51, 2019, 2019, 719, 840, 1070, 2200, 700, 1000, 2000, 2009, 1080, 1082, 2014]
WATCHED = [2024, 1080, 1082]


def numbers(line, exchanges):
    """Parameters that are asked for; each is asked in several telegrams, one behind the other."""
    line.asked.clear()
    let_pass(line, exchanges)
    asked = [b for a, b in zip([b""] + line.asked, line.asked) if a != b]
    return [(each[0] & 7) << 8 | each[1] + (2000 if each[2] & 0x80 else 0) for each in asked]


def test_all_is_asked_on_contact_and_before_a_start_and_then_a_parameter_every_tenth_of_a_second():
    line = Line((1,))
    line.exchange(0)
    survey = line.surveys[0]
    assert numbers(line, 20)[:ROWS] == ROUND + [1210, 2024] and survey.complete
    assert survey.unchecked == 0
    let_pass(line, 10)
    asked = numbers(line, 400)
    assert 56 <= len(asked) <= 58, len(asked)  # 5 exchanges of 20 ms, and the answer
    first = asked.index(50)
    assert (asked[first:] + asked)[:15] == ROUND and asked[:40] == asked[15:55]
    survey.recheck()
    assert survey.unchecked == ROWS
    assert numbers(line, 45)[:ROWS] == ROUND + [1210, 2024] and survey.unchecked == 0


def test_it_gets_more_turns_while_somebody_waits_and_with_contact_all_is_forgotten():
    line = Line((1,))
    survey, drive = line.surveys[0], line.drives[0]
    line.exchange(0)
    let_pass(line, 1)
    assert drive.asking and survey.unchecked == ROWS
    let_pass(line, 40)
    assert not drive.asking and survey.complete and survey.scaling and survey.actual is None
    assert survey.is_settled() and min(survey.values) >= 0
    for _ in range(2):
        survey.recheck()
        let_pass(line, 6)
        assert drive.asking and 0 < survey.unchecked < ROWS
        survey.drop_recheck()
        assert not drive.asking and not survey.unchecked
    survey.recheck()
    let_pass(line, 2)
    version = survey.version
    drive.lose()
    for _ in range(3):
        survey.step(line.now)
    assert not survey.unchecked and not drive.asking and survey.version > version
    assert not survey.complete and survey.scaling is None and max(survey.values) <= 0
    survey.recheck()  # of a drive without contact nothing is asked
    assert not survey.unchecked


def test_a_drive_that_is_not_shown_is_read_at_the_pace_that_is_asked_for():
    """To the microsecond; and nobody waits for it when contact is made."""
    for pace_us, waits in ((100_000, True), (1_000_000, False), (99_999, False)):
        line = Line((1,))
        survey, drive = line.surveys[0], line.drives[0]
        line.exchange(0)
        survey.step(line.now, pace_us)
        assert (survey.unchecked, drive.asking) == ((ROWS, True) if waits else (0, False))
        for _ in range(60):
            for _ in range(4):
                survey.step(line.now, pace_us)
            line.exchange(0)
        assert survey.complete
        for later_us in (0, 0, 0, pace_us):
            survey.step(line.now + later_us, pace_us)
        for _ in range(4):
            line.exchange(0)
        now = line.now
        for _ in range(3):
            survey.step(now, pace_us)  # the answer is taken
        assert drive.channel.idle
        survey.step(now + pace_us - 1, pace_us)
        assert drive.channel.idle
        survey.step(now + pace_us, pace_us)
        assert not drive.channel.idle


def test_where_the_queue_is_full_it_asks_when_there_is_room():
    line = Line((1,))
    survey, drive = line.surveys[0], line.drives[0]
    line.exchange(0)
    survey.step(line.now)
    others = [pkw.read(number) for number in range(300, 308)]
    for other in others:
        drive.ask(other)
    for _ in range(5):
        survey.step(line.now)
    assert len(line.spares) == len(spare_jobs()) == 4 and not line.asked
    let_pass(line, 40)
    assert all([other.state == pkw.DONE for other in others]) and survey.complete


def test_limits_that_nobody_can_be_asked_for_are_none():
    """With no PKW words; and with three, which carry no frequency."""
    for pkw_words, off_time_ms in ((0, 0), (3, 2000)):
        line = Line((1,))
        survey, drive = line.surveys[0], line.drives[0]
        drive.become(Drive(1, MASK, None, Layout(pkw_words, 2)))
        line.told[task(2009)], line.told[task(2014)] = whole(0), whole(2000)
        survey.step(line.now)
        line.exchange(0)
        drive.lose()
        line.exchange(0)
        let_pass(line, 60)
        assert survey.lowest() == 0 and survey.own_highest() == 65_000, pkw_words
        assert survey.off_time_ms() == off_time_ms, survey.off_time_ms()


def test_while_it_runs_every_other_question_is_for_its_count_and_its_limits():
    line = runs(5000, 1)
    line.surveys[0].recheck()
    assert numbers(line, 45)[:ROWS] == ROUND + [1210, 2024]  # all of them for another START
    asked = numbers(line, 400)
    watched = asked[asked.index(2024) :]
    others, watched = watched[1::2], watched[0::2]
    assert watched == (WATCHED * 20)[: len(watched)] and len(watched) > 20
    kept = [number for number in ROUND if number not in WATCHED] * 3
    first = kept.index(others[0])
    assert others[:20] == kept[first : first + 20]


# --- the telegrams that a drive has counted since its power-up, r2024 ---------------------------


def runs(count, step):
    """A drive that runs, whose counter is at `count` and has been read."""
    line = Line((1,))
    line.counts[0] = (count, step)
    line.exchange(0)
    let_pass(line, 40)
    line.drives[0].start(0x1000)
    survey = line.surveys[0]
    survey.count_anew()
    survey.recheck()
    let_pass(line, 40)
    assert survey.complete and not survey.count.restarted
    return line


def let_pass(line, exchanges):
    for _ in range(exchanges):
        for _ in range(4):
            line.surveys[0].step(line.now)
        line.exchange(0)


def test_a_drive_that_counts_from_the_beginning_was_without_power():
    for before, after in ((5000, 0), (65_000, 3), (40_000, 20_000), (30, 0), (90, 0), (90, 85)):
        line = runs(before, 1)
        let_pass(line, 60)
        line.counts[0] = (after, 1)
        let_pass(line, 200)
        assert line.surveys[0].count.restarted, (before, after)


def test_a_drive_that_was_without_power_while_it_stood_has_not_been_without_it_while_it_ran():
    line = runs(5000, 1)
    survey = line.surveys[0]
    let_pass(line, 60)
    line.drives[0].stop()
    line.counts[0] = (0, 1)
    survey.recheck()  # which asks a drive that stands for its count as well
    let_pass(line, 100)
    assert not survey.unchecked and not survey.has_restarted()


def test_a_counter_that_goes_on_or_wraps_is_no_reset():
    for step in (1, 2, 3, 31, 0):  # that of each telegram; with those to others; none at all
        line = runs(0xF000, step)
        let_pass(line, 5000)
        assert not line.surveys[0].count.restarted, step


def test_who_asks_anew_does_not_hide_that_the_counter_went_back():
    line = runs(5000, 1)
    let_pass(line, 60)
    line.counts[0] = (0, 1)
    line.surveys[0].recheck()
    let_pass(line, 100)
    assert line.surveys[0].count.restarted


def counted(*steps, wanted=0x047F):
    """Whether a drive counts as reset after these steps: telegrams sent to it, those of them that
    it answered before it was asked for its count and later, and its count. None: contact was
    lost. "begin": another run begins."""
    drive = Drive(1, MASK)
    drive.wanted = wanted
    count = TelegramCount(drive)
    told = 1000
    for step in ((0, 0, 0, 1000), (0, 0, 0, 1000)) + steps:
        if step is None:
            count.forget()
        elif step == "begin":
            count.begin()
        else:
            sent, before, later, counter = step
            drive.counters[5] = (drive.counters[5] + sent - before - later) & 0xFFFF
            drive.counters[0] = (drive.counters[0] + before) & 0xFFFF
            count.asked()
            drive.counters[0] = (drive.counters[0] + later) & 0xFFFF
            count.take(told, counter)
            told = counter
    restarted = count.take_restart()
    assert not count.take_restart()
    return restarted


def test_a_count_may_lack_an_eighth_of_what_was_answered_and_32_and_no_more():
    moves = (10, 10, 0, 1010)
    for sent, before, later in ((800, 800, 0), (900, 800, 100), (1000, 800, 0)):
        assert not counted(moves, (sent, before, later, 1010 + 668)), (sent, later)
        assert counted(moves, (sent, before, later, 1010 + 667)), (sent, later)
        assert not counted(moves, (sent, before, later, 1010 + 667), wanted=0)
    # What was answered after the question may be in this count or in the next.
    late = moves, (100, 0, 100, 1010)
    assert not counted(*late + ((800, 800, 0, 1010 + 668),))
    assert counted(*late + ((800, 800, 0, 1010 + 667),))
    assert not counted((800, 800, 0, 1000))  # it never moves
    assert not counted(moves, None, (0, 0, 0, 1010), (800, 800, 0, 1010))
    assert counted(moves, "begin", (0, 0, 0, 1010), (800, 800, 0, 1010 + 667))
    assert not counted(moves, "begin", (800, 800, 0, 1010))  # not judged yet
    assert not counted(moves, (800, 800, 0, 1010), "begin")
    assert not counted(moves, (800, 800, 0, 1010), None)


def test_a_count_moves_when_it_grows_from_more_than_nothing():
    begun = (0, 0, 0, 0), None, (0, 0, 0, 0)
    assert not counted(*begun + ((10, 10, 0, 10), (800, 800, 0, 10)))
    assert counted(*begun + ((10, 10, 0, 10), (10, 10, 0, 20), (800, 800, 0, 20)))


def test_another_run_asks_for_the_count_again_and_begins_with_what_it_is_then():
    line = runs(5000, 1)
    survey, drive = line.surveys[0], line.drives[0]
    drive.stop()
    let_pass(line, 20)
    line.counts[0] = (0, 1)
    drive.start(0x1000)
    survey.count_anew()
    let_pass(line, 100)
    assert not survey.has_restarted()
    line.counts[0] = (0, 1)
    let_pass(line, 100)
    assert survey.has_restarted() and not survey.has_restarted()
    line.without = R2024
    let_pass(line, 100)
    assert 2024 not in numbers(line, 200)
    line.without = None
    survey.count_anew()
    assert 2024 in numbers(line, 100)


def test_a_count_that_has_gone_back_was_wrapped_by_64_more_than_were_sent_or_begun_anew():
    high = (64_000, 64_000, 0, 65_000)
    most = 65_000 + 800 + 64 - 0x10000
    assert not counted(high, (800, 100, 0, most)) and counted(high, (800, 100, 0, most + 1))
    # It counts those to others as well when it has counted 16 more than were sent to it: then
    # 32 times as many may be in it.
    high = (0, 0, 0, 1000 + 16), (63_984, 63_984, 0, 65_000)
    assert counted(*high + ((100, 0, 0, most),))
    high = (0, 0, 0, 1000 + 17), (63_983, 63_983, 0, 65_000)
    most = 65_000 + 100 * 32 + 64 - 0x10000
    assert not counted(*high + ((100, 0, 0, most),))
    assert counted(*high + ((100, 0, 0, most + 1),))
    assert counted(*high + (None, (0, 0, 0, 65_000), (100, 0, 0, most)))


def test_a_drive_that_has_no_counter_is_not_asked_for_it_again_and_again_while_it_runs():
    """In its place the limits are read, every second question, by turns."""
    line = runs(0x4248, 0)
    line.without = R2024
    let_pass(line, 100)
    line.asked.clear()
    let_pass(line, 200)
    asked = [b for a, b in zip(line.asked, line.asked[1:]) if a != b]  # each for some telegrams
    limits = [each for each in asked if each in (P1080, P1082)]
    assert R2024 not in asked and len(asked) > 20
    assert limits in (asked[0::2], asked[1::2]), asked
    assert {P1080, P1082} == set(limits[:2]) and limits[2:] == limits[:-2], limits


# --- what the answers amount to -----------------------------------------------------------------


def task(number, index=0):
    """PKE and IND of the task that reads a parameter."""
    page = number >= 2000
    number -= 2000 * page
    return bytes((0x10 | number >> 8, number & 0xFF, 0x80 * page, index))


def hertz(value):
    return struct.pack(">f", value)


def whole(value):
    return struct.pack(">I", value)


def set_up(family=MM4, **changes):
    """A drive in contact that is set up for USS; `p1082=hertz(40)` for one that differs."""
    line = Line((1,), family)
    for number in (50, 719, 1210, 2009, 2014, 2200):
        line.told[task(number)] = whole(0)
    line.told[task(51, 1)] = whole(0)
    line.told[task(700)] = line.told[task(1000)] = whole(5)
    line.told[task(840)] = whole(2036 << 16)
    line.told[task(1070)] = whole(2018 << 16 | 1)
    line.told[task(1080)] = hertz(2.0)
    line.told[task(2019)], line.told[task(2019, 1)] = whole(52 << 16), whole(21 << 16)
    for name in changes:
        line.told[task(int(name[1:]))] = changes[name]
    line.exchange(0)
    return line


def read(line):
    """Everything anew."""
    let_pass(line, 4)
    line.surveys[0].recheck()
    let_pass(line, 2 * ROWS)
    assert not line.surveys[0].unchecked
    return line.surveys[0]


def test_a_drive_that_is_set_up_for_uss_tells_its_frequencies_and_nothing_is_wrong():
    line = set_up(p2014=whole(2000), p2000=hertz(60.0), p1082=hertz(87.5))
    survey = read(line)
    assert survey.complete and survey.wrong is rows.NOTHING_WRONG and not survey.unreadable
    assert survey.scaling.is_of(6000, False) and survey.actual is survey.scaling
    assert (survey.lowest(), survey.highest(), survey.off_time_ms()) == (200, 8750, 2000)
    assert line.drives[0].near == 0x4000 // 100 * 2
    line.told[task(1082)] = hertz(40.0)  # less than before
    line.told[task(1080)] = hertz(3.0)  # more
    line.told[task(2014)] = whole(256)
    assert (read(line).lowest(), survey.highest(), survey.off_time_ms()) == (300, 4000, 256)
    line.told[task(1082)] = hertz(150.0)
    assert read(line).highest() == 2 * 6000 - 1 and survey.own_highest() == 15000
    line.told[task(2009)] = whole(1)  # PZD2 is the frequency itself
    assert read(line).scaling.is_of(6000, True) and survey.actual is survey.scaling
    assert survey.highest() == 15000 and line.drives[0].near == 6000 // 100 * 2
    line.told[task(2000)] = hertz(1.0)
    assert read(line).scaling.is_of(100, True)
    line.told[task(2000)] = hertz(0.99)  # no drive has so little
    assert read(line).scaling is None and not survey.complete and survey.actual is None


def test_an_actual_value_that_is_no_frequency_has_no_scaling_and_shows_no_standstill():
    line = set_up()
    line.told[task(2019, 1)] = whole(27 << 16)  # the current
    survey = read(line)
    assert survey.complete and survey.scaling and survey.actual is None
    assert line.drives[0].near == 0
    assert survey.wrong[rows.ACTUAL] == rows.ACTUAL_SENT
    line.told[task(2019, 1)] = whole(21 << 16)
    assert read(line).actual is survey.scaling and line.drives[0].near


def test_with_another_data_set_nothing_counts_until_it_is_read():
    line = set_up()
    survey = read(line)
    for number, index in ((50, 0), (51, 1)):
        line.told[task(number, index)] = whole(1)
        survey.recheck()
        asked = numbers(line, 2)
        while survey.complete:
            survey.step(line.now)
            if survey.is_settled():
                line.exchange(0)
        assert survey.scaling is None and not survey.is_settled(), asked
        for reference in (2000, 1080, 1082, 700, 1000, 719, 840, 1070, 2200):
            line.told[task(reference, 1)] = line.told.get(task(reference), hertz(50.0))
        line.asked.clear()
        assert read(line).complete and survey.scaling
        by_set = (1080, 1082, 2000) if number == 51 else (700, 719, 840, 1000, 1070, 2200)
        for each in by_set:
            assert task(each, 1) in line.asked and task(each) not in line.asked, each
    for number, index in ((50, 0), (51, 1)):  # an index is a byte
        before = line.told[task(number, index)]
        line.told[task(number, index)] = whole(256)
        assert not read(line).complete
        line.told[task(number, index)] = before
        assert read(line).complete


def test_what_is_absent_has_its_default_and_is_nothing_new_when_it_is_absent_again():
    line = set_up(p719=whole(11))
    survey = read(line)
    assert survey.wrong[rows.COMMAND] == rows.SELECTION
    line.without = task(719)
    version = read(line).version
    assert survey.complete and survey.wrong is rows.NOTHING_WRONG and not survey.unreadable
    assert read(line).version == version
    for line.error in (3, 1, 17, 102, 0):
        assert read(line).complete is (line.error in (0, 3)), line.error
        assert survey.unreadable is not survey.complete and survey.scaling
    version = survey.version
    line.without = task(2009)
    for line.error in (0, 102):
        assert not read(line).complete and survey.scaling is None and survey.unreadable
        assert survey.version > version
    line.without = None
    assert read(line).complete and survey.scaling and not survey.unreadable


def test_a_recheck_judges_at_once_what_has_come_and_a_lost_contact_forgets_half_a_round():
    line = set_up()
    survey, drive = line.surveys[0], line.drives[0]
    while survey.is_settled() or survey.values[rows.REFERENCE] == rows.UNKNOWN:
        survey.step(line.now)
        if survey.is_settled():
            line.exchange(0)
    version = survey.version
    survey.recheck()
    assert survey.is_settled() and survey.version == version + 1
    while survey.scaling is None:
        survey.step(line.now)
        if survey.is_settled():
            line.exchange(0)
    while not survey.is_settled():
        survey.step(line.now)
    assert not survey.complete and not survey.unreadable
    version = survey.version
    drive.lose()
    survey.step(line.now)
    survey.step(line.now)
    assert survey.scaling is None and survey.version == version + 1
    survey.step(line.now)
    assert survey.version == version + 1  # nothing more is to be forgotten


def test_a_micromaster_3_tells_its_frequencies_in_steps_of_two_sizes():
    line = set_up(MM3, p910=whole(1), p94=whole(500), p95=whole(0), p12=whole(25))
    line.told[task(13)], line.told[task(93)] = whole(600), whole(10)
    survey = read(line)
    assert survey.complete and survey.scaling.is_of(5000, False) and not survey.is_percent()
    assert (survey.lowest(), survey.highest(), survey.off_time_ms()) == (250, 6000, 10_000)
    assert survey.actual is survey.scaling and line.drives[0].near == 0  # HIW has no sign
    line.told[task(95)] = whole(1)
    for _ in range(100):
        if not survey.complete:
            break
        let_pass(line, 1)
    assert survey.scaling is None  # another size: what was read means something else
    assert read(line).complete and survey.scaling.is_of(500, False) and survey.lowest() == 25
    line.told[task(95)] = whole(2)
    assert read(line).scaling.is_of(500, True) and survey.highest() == 600
    line.told[task(910)] = whole(0)
    assert read(line).wrong[rows.COMMAND] == rows.COMMAND_SOURCE and survey.complete
    line.without = task(95)
    assert not read(line).complete and survey.scaling is None
    assert survey.values[rows.LOWEST] == rows.UNKNOWN  # steps of no known size


def test_a_drive_that_tells_speeds_is_shown_in_percent_of_its_reference():
    line = set_up(G120, p1080=hertz(150.0), p1082=hertz(3000.0), p2000=hertz(1500.0))
    line.told[task(2040)] = whole(100)
    survey = read(line)
    assert survey.is_percent() and survey.complete and survey.scaling.is_of(100_00, False)
    assert (survey.lowest(), survey.own_highest(), survey.off_time_ms()) == (10_00, 200_00, 100)
    assert survey.highest() == 2 * 100_00 - 1 and survey.actual is survey.scaling
    survey.recheck()
    assert survey.unchecked == 4  # of the others it has none
    assert numbers(line, 12)[:4] == [2000, 1080, 1082, 2040] and survey.unchecked == 0
    line.told[task(2000)] = bytes(4)
    assert read(line).scaling is None and not survey.complete


def test_a_drive_that_falls_silent_twice_on_a_parameter_seems_to_lack_it():
    line = set_up()
    survey = line.surveys[0]
    line.silent_on = task(719)
    for _ in range(300):
        if survey.complete:
            break
        let_pass(line, 1)
    silences = [asked for asked in zip([b""] + line.asked, line.asked) if asked[0] != asked[1]]
    assert [asked for _, asked in silences].count(task(719)) == 2
    assert survey.complete and survey.values[rows.SELECTION] == 0 and not survey.unreadable
    assert survey.scaling and line.drives[0].contact
    let_pass(line, 60)
    assert not survey.unchecked
    assert 719 not in numbers(line, 400) and survey.complete  # only START asks for it again
    survey.recheck()
    assert 719 in numbers(line, 100) and survey.complete
    line.silent_on = None
    line.told[task(719)] = whole(12)
    survey.recheck()
    let_pass(line, 100)
    assert survey.values[rows.SELECTION] == 12
    line.silent_on = task(719)
    version = survey.version
    survey.recheck()
    while survey.values[rows.SELECTION] == 12:
        let_pass(line, 1)
    let_pass(line, 1)
    assert survey.values[rows.SELECTION] == rows.UNKNOWN  # once says nothing yet
    assert survey.unreadable and not survey.complete and survey.version > version
    let_pass(line, 200)
    assert survey.values[rows.SELECTION] == 0 and survey.complete and not survey.unreadable
    line.drives[0].lose()
    survey.step(line.now)
    line.exchange(0)
    was_unreadable = False
    while not survey.complete:
        let_pass(line, 1)
        was_unreadable = was_unreadable or survey.unreadable
    assert was_unreadable and survey.values[rows.SELECTION] == 0  # twice again


def test_what_must_be_known_and_is_not_answered_leaves_the_drive_unreadable():
    line = set_up()
    survey = line.surveys[0]
    line.silent_on = task(1000)
    let_pass(line, 300)
    assert survey.unreadable and not survey.complete and survey.scaling
    assert survey.values[rows.SETPOINT_SOURCE] == rows.UNKNOWN
    line.silent_on = None
    line.drives[0].lose()
    survey.step(line.now)
    survey.step(line.now)
    assert not survey.unreadable
    let_pass(line, 40)
    assert survey.complete
    line.silent_on = task(1210)  # only START needs it
    let_pass(line, 10)
    survey.recheck()
    for _ in range(150):
        let_pass(line, 1)
        assert survey.complete and survey.values[rows.RESTART] == 0 and not survey.unreadable
    assert not survey.unchecked


def test_another_layout_is_asked_for_what_fits_into_it():
    for family, in_percent in ((MM4, True), (MM3, False), (G120, True)):
        line = set_up(family)
        survey, drive = line.surveys[0], line.drives[0]
        assert survey.is_percent() is (family is G120)
        for pkw_words, percent in ((3, in_percent), (0, True), (4, family is G120)):
            let_pass(line, 3)
            drive.lose()
            drive.become(Drive(1, MASK, None, Layout(pkw_words, 2)))
            survey.step(line.now)
            assert survey.is_percent() is percent, (family, pkw_words)
            survey.step(line.now)
            line.exchange(0)
            line.asked.clear()
            if pkw_words == 0:
                let_pass(line, 5)
                assert not line.asked
                assert survey.complete and survey.scaling.is_of(100_00, False)
            if pkw_words == 4:
                assert len(set(numbers(line, 40))) > 3


def test_in_three_words_a_drive_is_shown_in_percent_whatever_data_set_is_active():
    line = set_up()
    survey, drive = line.surveys[0], line.drives[0]
    assert read(line).complete
    drive.lose()
    drive.become(Drive(1, MASK, None, Layout(3, 2)))
    survey.step(line.now)
    assert not survey.complete and survey.scaling is None and max(survey.values) == 0
    line.exchange(0)
    assert read(line).complete and survey.scaling.is_of(100_00, False)
    line.asked.clear()
    asked = numbers(line, 400)
    assert 719 in asked and not {2000, 1080, 1082, 840, 1070, 2019} & set(asked), asked
    for number in (700, 1000, 719):
        line.told[task(number, 1)] = line.told[task(number)]
    line.told[task(50)] = whole(1)
    assert read(line).complete and survey.scaling.is_of(100_00, False)
    line.told[task(2009)] = whole(1)  # Hertz, as if it told them
    assert not read(line).complete and survey.scaling is None and survey.unreadable


def test_what_the_drive_works_on_for_too_long_is_unknown_until_it_is_read_again():
    line = set_up()
    survey = read(line)
    survey.count_anew()
    for number, row in ((719, rows.SELECTION), (1000, rows.SETPOINT_SOURCE), (2024, None)):
        line.asked.clear()
        survey.recheck()
        while task(number) not in line.asked:
            let_pass(line, 1)
        line.works_on = task(number)
        before = survey.values[rows.COUNTER]
        for _ in range(400):
            if not survey.complete:
                break
            let_pass(line, 1)
        assert survey.complete is (row is None) and not survey.unreadable, number
        if row is not None:
            assert survey.values[row] == rows.UNKNOWN and survey.scaling
        assert survey.values[rows.COUNTER] == before and survey.count.is_told
        line.works_on = None
        let_pass(line, 100)
        assert survey.complete and survey.scaling and survey.count.is_told
    line.without = task(719)
    assert read(line).count.is_told  # that lacks something else
    line.without = R2024
    assert not read(line).count.is_told and survey.complete
