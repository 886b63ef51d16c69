# SPDX-License-Identifier: MIT
"""Every layout: PKW of 0, 3, 4 or a variable number of words, PZD of 0 to 16.

What is built is received, and what the line has cut, stretched or changed is not - but for the one
weakness of a BCC that is an exclusive or: two bits that flip in the same column of two characters.
Specification A-4 (the frame), C-3.1 and C-7 (layouts).
"""

import random

from boards.sim.drives.families import generic
from drive_bench import Bench
from line_bench import MASK, TIMING, Line, of_words, sealed, words_of
from uss import pkw, pzd, telegram
from uss.drive import Drive
from uss.layout import PKW_WORDS, STANDARD, VARIABLE, WORDS_MAX, Layout
from uss.receiver import WAITING, Receiver
from uss.telegram import GOOD, NET
from uss.timing import BAUD_RATES, Timing

SEED = 1994
SENT_AT = 1000
TOO_LATE = SENT_AT + 1_000_000  # no telegram of this line takes so long
TCH = TIMING.character_us


def layouts():
    """All 67 of them."""
    for pkw_words in PKW_WORDS:
        for pzd_words in range(17):
            if pkw_words or pzd_words:
                yield Layout(pkw_words, pzd_words)


def seeded():
    print("seed", SEED)
    random.seed(SEED)


def random_words(count):
    return [random.getrandbits(16) for _ in range(count)]


def random_reply(layout, address=1):
    """A telegram that a drive of this layout may send; a variable length is mostly a short one."""
    words = layout.pkw_words
    if layout.variable:
        longest = WORDS_MAX - layout.pzd_words
        words = random.choice((3, 3, 4, 4, 10, random.randrange(3, longest + 1), longest))
    return of_words(random_words(words + layout.pzd_words), address)


# --- the telegram alone: what the receiver says of it -------------------------------------------


class Ear:
    """A receiver that awaits the reply of one drive, and the line that brings it."""

    interrupts = True
    resolution_us = 0
    received_at = 0

    def __init__(self, layout, address=1):
        self.drive = Drive(address, MASK, layout=layout)
        self.drive.fill(0)
        telegram.seal(self.drive.request, address, layout.net_count)
        self.receiver = Receiver(TIMING, MASK)
        self._burst = b""

    def receive(self, buffer, at):
        count = len(self._burst)
        buffer[at : at + count] = self._burst
        self._burst = b""
        return count

    def await_reply(self):
        self.receiver.open(self.drive, SENT_AT)
        self.received_at = SENT_AT

    def come(self, characters, pause_us):
        """Characters back to back after a pause; what the receiver says to them."""
        self._burst = characters
        self.received_at += pause_us + len(characters) * TCH
        return self.receiver.take(self, self.received_at)

    def finding(self, characters):
        """What becomes of a reply that comes in one go, and of what comes after it: nothing."""
        self.await_reply()
        finding = self.come(characters, 3 * TCH)
        if finding == WAITING:
            finding = self.receiver.take(self, TOO_LATE)
        assert finding != WAITING
        return finding

    def heard(self):
        return bytes(self.receiver.buffer[: self.receiver.count])


def test_what_is_built_is_received_in_every_layout():
    """In one go as from an interrupt, and character by character as from a link that is polled."""
    seeded()
    for layout in layouts():
        address = random.randrange(32)
        ear = Ear(layout, address)
        for _ in range(5):
            reply = random_reply(layout, address)
            assert ear.finding(reply) == GOOD, (layout, reply)
            assert ear.heard() == reply, layout
            cut = random.randrange(1, len(reply))
            ear.await_reply()
            assert ear.come(reply[:cut], 3 * TCH) == WAITING, (layout, cut)
            assert ear.come(reply[cut:], TCH) == GOOD, (layout, cut)
            assert ear.heard() == reply, layout


def test_what_is_cut_is_not_received():
    """Whether the end is missing, the beginning, or a character in between."""
    seeded()
    for layout in layouts():
        ear = Ear(layout)
        reply = random_reply(layout)
        for place in range(len(reply)):
            assert ear.finding(reply[:place]) != GOOD if place else True, (layout, place)
            assert ear.finding(reply[place + 1 :] or b"\x00") != GOOD, (layout, place)
            shorter = reply[:place] + reply[place + 1 :]
            if shorter != reply[: len(shorter)]:
                assert ear.finding(shorter) != GOOD, (layout, place)
        assert ear.finding(reply) == GOOD, layout


def test_what_is_stretched_is_not_received():
    """Characters before it, behind it, or somewhere inside."""
    seeded()
    for layout in layouts():
        ear = Ear(layout)
        reply = random_reply(layout)
        for count in range(1, 9):
            more = bytes(random.getrandbits(8) for _ in range(count))
            place = random.randrange(1, len(reply))
            for longer in (reply + more, more + reply, reply[:place] + more + reply[place:]):
                assert ear.finding(longer[: telegram.SIZE_MAX + 8]) != GOOD, (layout, longer)


def test_any_flipped_bit_is_found():
    """Anywhere in the telegram: STX, LGE, ADR, net data and BCC."""
    seeded()
    flips = 0
    for layout in layouts():
        ear = Ear(layout)
        reply = bytearray(random_reply(layout))
        for place in range(len(reply)):
            for bit in range(8):
                reply[place] ^= 1 << bit
                assert ear.finding(reply) != GOOD, (layout, place, bit)
                reply[place] ^= 1 << bit
                flips += 1
        assert ear.finding(reply) == GOOD
    print(flips, "single flips, all found")


def test_two_flipped_bits_are_found_unless_they_are_in_one_column():
    """The BCC is an exclusive or: two flips of the same bit in two characters cancel out in it.

    STX, LGE and ADR must be right of themselves, so that a flip in one of them is always found.
    """
    seeded()
    pairs = unnoticed = 0
    for layout in layouts():
        ear = Ear(layout)
        reply = bytearray(random_reply(layout))
        for _ in range(400):
            first, second = random.randrange(len(reply)), random.randrange(len(reply))
            bit = random.randrange(8)
            other_bit = random.choice((bit, random.randrange(8)))
            if (first, bit) == (second, other_bit):
                continue
            reply[first] ^= 1 << bit
            reply[second] ^= 1 << other_bit
            blind = bit == other_bit and min(first, second) >= NET
            assert (ear.finding(reply) == GOOD) == blind, (layout, first, bit, second, other_bit)
            reply[first] ^= 1 << bit
            reply[second] ^= 1 << other_bit
            pairs += 1
            unnoticed += blind
    print(pairs, "pairs of flips,", unnoticed, "in one column of the net data and BCC unnoticed")
    assert unnoticed


def test_a_telegram_to_somebody_else_is_not_received():
    seeded()
    for layout in layouts():
        ear = Ear(layout, 5)
        net = random_reply(layout)[3:-1]
        for address in (0, 4, 6, 31, 5 | telegram.MIRROR, 5 | telegram.BROADCAST, 5 | 0x80):
            assert ear.finding(sealed(net, address)) == telegram.BAD_ADDRESS, (layout, address)


def test_a_telegram_of_another_layout_is_not_received():
    """With variable length the PZD must fit in at least, and PKE, IND and one word before them."""
    seeded()
    for layout in layouts():
        ear = Ear(layout)
        for words in range(1, WORDS_MAX + 1):
            fits = words == layout.pkw_words + layout.pzd_words
            if layout.variable:
                fits = words >= 3 + layout.pzd_words
            finding = ear.finding(of_words(random_words(words)))
            assert finding == (GOOD if fits else telegram.BAD_LENGTH), (layout, words)
        assert ear.finding(sealed(bytes(2 * words - 1))) == telegram.BAD_LENGTH, layout


# --- the whole exchange: a master, a drive, and what they say to each other ---------------------


def contact(layout, address=1, **options):
    """A line with one drive of this layout, which has answered once, with zeros."""
    line = Line(lambda request: sealed(bytes(layout.net_count), address), **options)
    drive = line.master.turns.add(address, layout)
    line.exchange()
    assert drive.contact, layout
    return line, drive


def test_the_words_of_every_layout_arrive_at_both_ends():
    check_words(polled=False)


def test_the_words_of_every_layout_arrive_over_a_link_without_interrupts():
    check_words(polled=True)


def check_words(polled):
    seeded()
    for layout in layouts():
        address = random.randrange(32)
        line, drive = contact(layout, address, polled=polled)
        words = random_words(layout.pzd_words)
        if words:
            words[0] = pzd.ON
            drive.start(words[1] if len(words) > 1 else 0)
        for place in range(3, layout.pzd_words + 1):
            drive.put(place, words[place - 1])
        reply = random_reply(layout, address)
        line.answer = lambda request: reply
        line.exchange()
        asked = line.asked
        assert telegram.judge(asked, len(asked), address, layout.net_count) == GOOD, layout
        net = words_of(asked)
        idle = len(net) - layout.pzd_words
        assert net == [0] * idle + words, layout
        received = words_of(reply)[-layout.pzd_words :] if words else []
        for place in range(1, layout.pzd_words + 1):
            assert drive.word(place) == received[place - 1], (layout, place)
        assert drive.zsw == (received[0] if words else 0)
        assert list(drive.counters) == [2, 0, 0, 0, 0, 0, 0] and drive.status == 0


def test_the_parameter_channel_of_every_layout():
    """A word is in PWE1 of three words, in PWE2 of four (C-4.2.3). Without PKW there is none."""
    seeded()
    places = {3: [5], 4: [0, 5], VARIABLE: [5]}
    for layout in layouts():
        line, drive = contact(layout)
        job = pkw.write_word(700, 5)
        if not layout.pkw_words:
            try:
                drive.ask(job)
            except RuntimeError:
                continue
            raise AssertionError("%r took a job" % layout)
        area = [0x22BC, 0] + places[layout.pkw_words]
        drive.ask(job)
        asked_pzd = random_words(layout.pzd_words)
        line.answer = lambda request: of_words([0x12BC, 0] + area[2:] + asked_pzd)
        line.exchange()
        assert words_of(line.asked)[: len(area)] == area, layout
        assert job.state == pkw.DONE and job.integer_value() == 5, layout
        for place in range(1, layout.pzd_words + 1):
            assert drive.word(place) == asked_pzd[place - 1], (layout, place)


def image(drive):
    """All that a reply may change."""
    places = range(1, drive.layout.pzd_words + 1)
    return [drive.word(place) for place in places] + [drive.counters[0], drive.contacts]


def damaged(reply):
    """The reply after one of the things that a line does to telegrams."""
    kind = random.randrange(4)
    place = random.randrange(len(reply))
    if kind == 0:
        return reply[:place]
    if kind == 1:
        return reply + bytes(random.getrandbits(8) for _ in range(1 + place % 8))
    reply = bytearray(reply)
    reply[place] ^= 1 << random.randrange(8)
    if kind == 2:
        other = (place + random.randrange(1, len(reply))) % len(reply)
        reply[other] ^= 1 << random.randrange(8)
        if min(place, other) >= NET and not telegram.bcc(reply, len(reply)):
            reply[NET] ^= 1  # the blind spot is no damage that could be seen
    return bytes(reply)


def test_what_is_damaged_changes_nothing_in_the_master():
    seeded()
    exchanges = 0
    for layout in layouts():
        line, drive = contact(layout)
        good = random_reply(layout)
        line.answer = lambda request: good
        line.exchange()
        before = image(drive)
        for index in range(30):
            line.answer = lambda request: damaged(random_reply(layout)) or None
            line.exchange()
            assert image(drive) == before, (layout, index)
            assert drive.status and drive.silent == index + 1, layout
            assert drive.counters[0] == 2 and sum(drive.counters) == 3 + index, layout
            exchanges += 1
        line.answer = lambda request: good
        line.exchange()
        assert drive.counters[0] == 3 and drive.status == drive.silent == 0, layout
    print(exchanges, "damaged replies, none taken")


def test_a_reply_of_any_length_is_taken_at_every_rate():
    """The start interval before it is what a receiver can only reckon from its end and length."""
    seeded()
    for baud in BAUD_RATES:
        timing = Timing(baud)
        for words in (4, 6, 18, WORDS_MAX):
            reply = of_words(random_words(words))
            for pause_us in (timing.start_interval_us, 3 * timing.character_us):
                pieces = [(pause_us, reply)]
                line = Line(lambda request, pieces=pieces: pieces, timing)
                drive = line.master.turns.add(1, Layout(VARIABLE, 1))
                line.exchange()
                assert drive.contact, (baud, words, pause_us)


def random_noise(most, first=None):
    characters = [random.getrandbits(8) for _ in range(random.randrange(1, most + 1))]
    if first is not None:
        characters[0] = first
    return bytes(characters)


def test_noise_of_any_kind_is_survived_and_the_next_reply_taken():
    """Bursts with any pauses before them, some of which begin as a telegram does."""
    seeded()
    for layout in layouts():
        for polled in (False, True):
            line, drive = contact(layout, polled=polled)
            for _ in range(8):
                pieces = [
                    (random.randrange(0, 8000), random_noise(60, random.choice((None, 2))))
                    for _ in range(random.randrange(1, 4))
                ]
                line.answer = lambda request, pieces=pieces: pieces
                line.exchange()
            assert drive.counters[0] == 1, (layout, polled)
            good = random_reply(layout)
            line.answer = lambda request, good=good: good
            line.exchange()
            assert drive.counters[0] == 2 and drive.silent == 0, (layout, polled)


def test_a_reply_behind_noise_and_a_pause_is_taken():
    """A spike when the line turns round is no reason to lose the reply that follows."""
    seeded()
    for layout in layouts():
        line, drive = contact(layout)
        for _ in range(5):
            good = random_reply(layout)
            noise = random_noise(8, 0xFF)
            line.answer = lambda request, pieces=[(200, noise), (3 * TCH, good)]: pieces
            before = drive.counters[0]
            line.exchange()
            assert drive.counters[0] == before + 1, (layout, noise)


# --- a drive that somebody else wrote ------------------------------------------------------------


def done(line, drive, job):
    """The job after the drive has had time for it."""
    drive.ask(job)
    line.exchange(3)
    return job


def test_a_simulated_drive_of_every_layout_understands_and_is_understood():
    """boards/sim shares no code with the firmware: a mistake of one shows against the other."""
    seeded()
    for layout in layouts():
        parameters = {2013: layout.pkw_words, 2012: layout.pzd_words}
        bench = Bench(parameters, family=generic)
        line = Line(bench.ask)
        drive = line.master.turns.add(1, layout)
        line.exchange()
        words = random_words(layout.pzd_words)
        words[:2] = [pzd.ON, 0x2000][: len(words)]
        if words:
            drive.start(0x2000)
        for place in range(3, len(words) + 1):
            drive.put(place, words[place - 1])
        line.exchange(2)
        heard = [bench.drive.read(2018, index) for index in range(16)]
        assert heard == words + [0] * (16 - len(words)), layout
        if words:
            assert drive.state() == pzd.RUNNING and bench.drive.state == "running", layout
        if len(words) >= 4:
            assert drive.word(4) == bench.drive.read(53), layout
        if layout.pkw_words:
            value = random.getrandbits(16)
            assert done(line, drive, pkw.write_word(18, value)).state == pkw.DONE, layout
            assert bench.drive.read(18) == value, layout
            job = done(line, drive, pkw.read(1082))
            if layout.pkw_words == 3:
                assert job.state == pkw.REFUSED and job.error == pkw.TOO_SMALL, layout
            else:
                assert job.state == pkw.DONE and job.float_value() == 50.0, layout


# --- the layout itself --------------------------------------------------------------------------


def test_the_sizes_that_are_usual():
    """The specification's and the drives': LGE, all characters (chapter 2 of the digest)."""
    for pkw_words, pzd_words, lge, size in (
        (0, 2, 0x06, 8), (3, 2, 0x0C, 14), (4, 2, 0x0E, 16), (4, 4, 0x12, 20), (4, 8, 0x1A, 28),
        (0, 16, 0x22, 36), (4, 16, 0x2A, 44),
    ):  # fmt: skip
        layout = Layout(pkw_words, pzd_words)
        assert layout.net_count + 2 == lge and layout.net_count + 4 == size, layout
    assert (STANDARD.pkw_words, STANDARD.pzd_words) == (4, 2)
    assert Layout(VARIABLE, 2).net_count == 10, "three words when nothing is asked"


def test_a_layout_is_four_and_two_words_unless_somebody_says_so():
    """With a variable length a request has room for a text of 16 characters."""
    assert Layout().is_like(STANDARD) and repr(Layout()) == "Layout(4, 2)"
    assert Layout(VARIABLE, 2).longest == 10 and Layout(VARIABLE, 2).net_max == 24
    assert repr(Layout(VARIABLE, 4, short=True)) == "Layout(127, 4, short=True)"


def test_which_replies_fit_a_layout():
    for layout, fitting in (
        (STANDARD, [12]), (Layout(3, 2), [10]), (Layout(0, 2), [4]), (Layout(4, 4), [16]),
        (Layout(VARIABLE, 2), [10, 12, 14, 16, 18]), (Layout(VARIABLE, 5), [16, 18]),
    ):  # fmt: skip
        assert [count for count in range(20) if layout.fits(count)] == fitting, layout


def test_the_enable_array_of_a_broadcast_needs_four_parameter_words():
    taking = [layout for layout in layouts() if layout.takes_broadcast()]
    expected = [(4, pzd_words) for pzd_words in range(1, 17)]
    assert [(layout.pkw_words, layout.pzd_words) for layout in taking] == expected


def test_a_layout_that_is_none_is_refused():
    for pkw_words, pzd_words in (
        (0, 0), (1, 2), (2, 2), (5, 2), (126, 2), (128, 2), (-1, 2), (4, 17), (4, -1), (None, 2),
        (4, None), (VARIABLE, 17),
    ):  # fmt: skip
        try:
            Layout(pkw_words, pzd_words)
        except ValueError:
            continue
        raise AssertionError("%r + %r words were accepted" % (pkw_words, pzd_words))


def test_the_longest_request_is_a_task_at_least_and_a_telegram_at_the_most():
    for pzd_words, longest in ((2, 3), (2, 124), (0, 126), (16, 110)):
        layout = Layout(VARIABLE, pzd_words, longest)
        assert layout.longest == longest and layout.net_max == 2 * (longest + pzd_words)
    for pzd_words, longest in ((2, 2), (2, 0), (2, 125), (0, 127), (16, 111)):
        try:
            Layout(VARIABLE, pzd_words, longest)
        except ValueError as error:
            assert str(error) == "%d PKW words and %d PZD words" % (longest, pzd_words)
            continue
        raise AssertionError("%r + %r words were accepted" % (longest, pzd_words))
    assert Layout(4, 2, 200).longest == 4  # what has a fixed length needs no other


def test_a_short_telegram_has_no_pkw_words_unless_there_is_a_task():
    """STX LGE ADR STW HSW BCC both ways; a task and its answer have as many words as ever."""
    seeded()
    for pzd_words in (1, 2, 4, 16):
        layout = Layout(VARIABLE, pzd_words, short=True)
        assert layout.net_count == 2 * pzd_words
        bench = Bench({2013: 127, 2012: pzd_words}, family=generic)
        line = Line(bench.ask)
        drive = line.master.turns.add(1, layout)
        line.exchange(2)
        assert drive.contact and drive.size == 4 + 2 * pzd_words, layout
        drive.start(0x2000)
        line.exchange(2)
        assert drive.state() == pzd.RUNNING and bench.drive.state == "running", layout
        value = random.getrandbits(16)
        assert done(line, drive, pkw.write_word(18, value)).state == pkw.DONE, layout
        assert bench.drive.read(18) == value, layout
        jobs = [pkw.read(18), pkw.read(18), pkw.read(1082)]
        for job in jobs:
            drive.ask(job)
        line.exchange(6)
        assert [job.state for job in jobs] == [pkw.DONE] * 3, layout
        assert jobs[1].integer_value() == value and jobs[2].float_value() == 50.0
        line.exchange()
        assert drive.size == 4 + 2 * pzd_words and drive.channel.idle, layout
        assert bench.drive.state == "running", layout


def test_a_reply_with_half_a_parameter_channel_fits_no_short_layout():
    layout = Layout(VARIABLE, 2, short=True)
    assert [count for count in range(14) if layout.fits(count)] == [4, 10, 12]


def test_only_pkw_words_of_variable_length_beside_pzd_words_are_left_out():
    for pkw_words, pzd_words in ((4, 2), (0, 2), (VARIABLE, 0)):
        try:
            Layout(pkw_words, pzd_words, short=True)
        except ValueError:
            continue
        raise AssertionError("%r + %r words were accepted" % (pkw_words, pzd_words))
    assert not Layout(VARIABLE, 2, short=True).is_like(Layout(VARIABLE, 2))
