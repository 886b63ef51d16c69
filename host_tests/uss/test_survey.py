# SPDX-License-Identifier: MIT
"""What the panel reads of its drives before a motor may turn: several surveys, few spare jobs."""

import struct

from boards.sim.dice import Dice
from uss.drive import Drive
from uss.families import MM4
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

    def __init__(self, addresses):
        self.spares = spare_jobs()
        self.drives = [Drive(address, MASK) for address in addresses]
        self.surveys = [Survey(drive, MM4, MASK, self.spares) for drive in self.drives]
        self.now = 0
        self.questions = [0] * len(self.drives)
        self.counts = {}  # by place: r2024, and by how much it grows with each telegram
        self.silent = set()
        self.odd = 0  # so many of the next answers make no sense
        self.without = None  # PKE and IND of what they lack
        self.asked = []  # PKE and IND of each question

    def exchange(self, place):
        """A reply comes, and the next telegram goes out before the panel has looked at it."""
        drive = self.drives[place]
        self.now += US
        if place in self.silent:
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
            if bytes(drive.request[3:7]) == R2024:
                net[7:11] = struct.pack(">HH", 0, count)
            if self.odd:
                self.odd -= 1
                net[3] ^= 0x30  # a word, and there is something in front of it
            if bytes(drive.request[3:7]) == self.without:
                net[3] |= 0x70
                net[7:11] = bytes(4)  # refused, error 0: no such parameter
        drive.take(net, 16, self.now)


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
    nothing = ((0x7FC0, 0), (0x7F80, 0), (0xFF80, 0), (0x8000, 1), words(-0.01), words(650.1))
    for high, low in nothing + (words(1e30), words(-1e30), (0xFFFF, 0xFFFF)):
        assert centihertz(high, low) == -1, (high, low)
    assert centihertz(0x8000, 0) == 0  # minus nothing
    assert centihertz(0, 1) == centihertz(*words(1e-30)) == 0


def test_speeds_are_what_a_floating_point_number_says():
    for speed in (0.0, 0.25, 0.5, 1.0, 1.49, 1.5, 1395.6, 3000.0, 65_535.5, 200_000.5, 210_000.0):
        high, low = words(speed)
        assert rpm(high, low) == int(single(high, low) + 0.5), speed
    assert rpm(0x8000, 0) == 0  # minus nothing
    nothing = ((0x7FC0, 0), (0x7F80, 0), (0xFF80, 0), (0x8000, 1), (0x8001, 0), words(-0.5))
    for high, low in nothing + (words(-3000.0), words(210_001.0), words(262_144.0), words(1e30)):
        assert rpm(high, low) == -1, (high, low)


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
