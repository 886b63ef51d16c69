# SPDX-License-Identifier: MIT
"""The layout of drives that do not answer is found by trying, and the others notice nothing of it.

Against simulated drives where it matters what they take for a telegram of theirs, and on a line
with nodes of a few lines each where it matters who talks when.
"""

import micropython

from boards.sim.drives.families import mm420
from fleet_bench import Fleet
from round_bench import MASK, MIRROR, RUNNING, Bench, Node, framed
from uss import pzd
from uss.finding import finder as finding
from uss.finding.enquiry import NO_CHANNEL, Question
from uss.finding.enquiry import Node as Asked
from uss.finding.finder import Finder
from uss.layout import STANDARD, VARIABLE, Layout
from uss.master import CLOSED, LISTENING, OFF
from uss.outside import Mirror
from uss.receiver import OTHER_LENGTH, SILENT
from uss.telegram import BAD_BCC, GOOD

# --- simulated drives ---------------------------------------------------------------------------


class Line(Fleet):
    """Drive 1 runs, supervised; `sets`: {address: (P2013, P2012)} of others, without power yet.
    All stand in the list as `layout`, and so do those at `absent`."""

    def __init__(self, sets, absent=(), layout=STANDARD, baud=19200, runs=True):
        kinds = {1: {"family": mm420, "parameters": {2014: 2_000}}}
        for address, (pkw_words, pzd_words) in sets.items():
            parameters = {2013: pkw_words, 2012: pzd_words, 2014: 0}
            kinds[address] = {"family": mm420, "parameters": parameters}
        Fleet.__init__(self, kinds, baud=baud, listed=False)
        turns = self.master.turns
        self.drives[1] = turns.add(1)
        for address in sorted(list(sets) + list(absent)):
            self.drives[address] = turns.add(address, layout)
        for address in sets:
            self.motors[address].unplug()
        self.found = []
        self.finder = Finder(self.master, self.clock.ticks_mask)
        self.run(1_500)
        if runs:
            self.master.deadlines.supervise(self.drives[1], 2_000)
            self.drives[1].start(0x2000)
        self.run(2_000)

    def run(self, ms):
        until = self.clock.now_us + round(ms * 1000)
        while self.clock.now_us < until:
            Fleet.run(self, 2)
            drive = self.finder.step(self.clock.ticks_us())
            if drive:
                self.found.append(drive)

    def last(self):
        """ADR of the last telegram of the master, and its net characters."""
        for _, mine, characters in self.wire.log.last(2):
            if mine:
                last = characters
        return last[2], len(last) - 4

    def found_after(self, address, limit_ms=200_000):
        """Switch it on; after so many ms it has been found."""
        self.motors[address].plug()
        began = self.clock.now_us
        self.run_until(lambda: self.drives[address].contact, limit_ms)
        return (self.clock.now_us - began) // 1000


def layout_of(drive):
    return drive.layout.pkw_words, drive.layout.pzd_words


def test_each_of_the_layouts_is_found():
    line = Line({2: (127, 2), 3: (3, 2), 4: (0, 2), 5: (4, 2)})
    for address in (2, 3, 4, 5):
        line.motors[address].plug()
    line.run_until(lambda: all([drive.contact for drive in line.drives.values()]), 15_000)
    assert [layout_of(line.drives[address]) for address in (2, 3, 4, 5)] == [
        (127, 2), (3, 2), (0, 2), (4, 2),
    ]  # fmt: skip
    assert len(line.found) == 3 and line.drives[5] not in line.found
    line.run(2_000)
    for address in (2, 3, 4, 5):  # they run in it, and are stopped
        line.drives[address].start(0x1000)
    line.run(3_000)
    assert all([motor.state == "running" for motor in line.motors.values()])
    line.master.stop_all()
    line.run(10_000)
    assert not any([motor.state == "running" for motor in line.motors.values()])
    assert not any(line.drives[1].counters[1:])
    line.check()


def test_whatever_the_list_says_and_the_drive_is_set_to():
    for layout in (Layout(3, 2), Layout(0, 2), Layout(VARIABLE, 2), Layout(4, 4)):
        pzd_words = layout.pzd_words
        words = [0, 3, 4, 127]
        sets = {2 + place: (each, pzd_words) for place, each in enumerate(words)}
        line = Line(sets, layout=layout, runs=False)
        for address in sets:
            line.motors[address].plug()
        drives = [line.drives[address] for address in sorted(sets)]
        line.run_until(lambda: all([drive.contact for drive in drives]), 20_000)
        for drive, each in zip(drives, words):
            known = layout_of(drive)[0]
            # One of any length answers the list, if that comes first, with as many PKW words: with
            # 3 it is well served, and 0 is what the list says.
            served = {known, each} == {3, VARIABLE}
            served = served or each == VARIABLE and known == layout.pkw_words == 0
            assert known == each or served, (layout, drive.layout, each)
        line.check()


def test_other_pzd_words_than_the_list_says_are_found():
    """P2012: the length alone does not tell them, so the drive is asked."""
    for layout, words in (
        (STANDARD, (4, 4)), (STANDARD, (127, 4)), (STANDARD, (0, 4)), (STANDARD, (3, 4)),
        (STANDARD, (4, 3)), (Layout(3, 2), (127, 3)), (Layout(0, 2), (0, 4)),
        (Layout(4, 4), (4, 2)),
    ):  # fmt: skip
        line = Line({2: words}, layout=layout, runs=False)
        line.found_after(2, 30_000)
        assert layout_of(line.drives[2]) == words, (layout, words, line.drives[2].layout)
        assert line.found == [line.drives[2]]
        line.drives[2].start(0x1000)
        line.run(1_000)
        assert line.motors[2].state == "running"
        line.check()


def test_one_without_room_for_the_control_words_of_the_list_is_left_alone():
    """P2012 = 0: in that layout nobody could tell it anything."""
    line = Line({2: (3, 0)}, runs=False)
    line.motors[2].plug()
    asked = 2, 6
    line.run_until(lambda: line.last() == asked, 40_000)
    line.run(2_000)
    assert not line.found and not line.drives[2].contact and layout_of(line.drives[2]) == (4, 2)
    since = line.wire.log.count
    line.run(2_000)
    sent = [row[2][2] for row in line.wire.log.last(line.wire.log.count - since) if row[1]]
    assert 2 in sent and 2 | MIRROR in sent  # the list asks it, and it is looked for once more
    line.check()


def test_one_that_answers_late_is_asked_by_nobody_else_meanwhile():
    """It takes the list's telegrams as well, of another length, and answered them to our questions
    and our questions to them: it was asked in vain for minutes."""
    for late in (1, 2):
        line = Line({2: (127, 2)}, runs=False)
        line.motors[2].stale_replies = late
        line.found_after(2, 10_000)
        assert layout_of(line.drives[2]) == (127, 2) and line.found == [line.drives[2]]
        line.check()


def test_one_that_is_doubted_and_answers_late_is_asked_by_nobody_else_either():
    """The list's task came between the question and its answer, each time. What nobody had told
    was taken for its layout: its control word stood in the wrong place, and it heard no STOP."""
    for layout, words in (
        (Layout(VARIABLE, 4), (3, 4)),
        (STANDARD, (3, 3)),
        (Layout(3, 3), (4, 2)),
    ):
        for late in (0, 1, 2):
            line = Line({2: words}, layout=layout, runs=False)
            line.motors[2].stale_replies = late
            line.found_after(2)
            drive = line.drives[2]
            drive.doubt()
            line.run_until(lambda: line.found, 10_000)
            assert layout_of(drive) == words, (layout, words, late, layout_of(drive))
            line.run(1_000)
            assert drive.contact and not drive.doubted
            line.check()


def test_the_questions_carry_the_off_that_the_drive_is_owed():
    """One that was owed OFF3 was asked with OFF1, and ramped down slowly."""
    line = Line({2: (127, 4)}, runs=False)
    line.drives[2].stop(pzd.OFF3)
    line.motors[2].plug()
    heard = set()
    while not line.found:
        line.run(4)
        heard.add(line.motors[2].stw)
    assert heard == {0, pzd.OFF3}
    line.check()


def test_a_drive_that_is_doubted_and_tells_nothing_keeps_its_layout():
    line = Line({2: (3, 4)}, layout=Layout(VARIABLE, 4), runs=False)
    line.motors[2].stale_replies = 1_000_000
    line.found_after(2)
    line.drives[2].doubt()
    line.run(10_000)
    assert not line.found and not line.drives[2].doubted and line.drives[2].contact
    assert layout_of(line.drives[2]) == (VARIABLE, 4)
    line.check()


def test_a_drive_that_is_doubted_and_answers_late_can_be_started():
    line = Line({2: (3, 4)}, layout=Layout(VARIABLE, 4), runs=False)
    line.motors[2].stale_replies = 4
    line.found_after(2)
    line.drives[2].doubt()
    silence = line.master.deadlines.silence
    line.run_until(lambda: silence.spared is line.drives[2])
    line.drives[2].start(0x1000)
    line.run(2_000)
    assert line.motors[2].state == "running" and silence.spared is None
    line.drives[2].stop()
    line.run(8_000)
    assert line.motors[2].state != "running"
    line.check()


def test_a_drive_that_is_doubted_is_asked_if_it_stands():
    """It is in contact: its telegrams have the length that the list says, or any."""
    for layout, words in (
        (Layout(VARIABLE, 2), (3, 2)), (Layout(VARIABLE, 2), (127, 4)), (STANDARD, (3, 3)),
        (STANDARD, (127, 3)), (Layout(VARIABLE, 2), (127, 3)),
    ):  # fmt: skip
        line = Line({2: words}, layout=layout, runs=False)
        line.found_after(2)
        assert line.drives[2].contact and not line.found
        line.drives[2].doubt()
        line.run(6_000)
        told = layout, words, line.drives[2].layout, line.found
        assert layout_of(line.drives[2]) == words and line.found == [line.drives[2]], told
        assert line.drives[2].contact and not line.drives[2].doubted
        line.check()
    line = Line({2: (4, 2)}, runs=False)
    line.found_after(2)
    line.drives[2].doubt()
    line.run(3_000)
    assert not line.found and not line.drives[2].doubted  # it has what the list says
    line.drives[2].start(0x1000)
    line.run(1_000)
    line.drives[2].doubt()
    since = line.wire.log.count
    line.run(3_000)
    assert line.motors[2].state == "running"
    for _, mine, characters in line.wire.log.last(line.wire.log.count - since):
        assert not (mine and characters[2] & MIRROR)
    line.drives[2].stop()
    line.run(8_000)
    assert not line.drives[2].doubted
    line.check()


def test_an_answer_to_another_question_is_no_status_word():
    """The list asks a drive that is doubted as well, so an answer may be to the list's question.
    Taken for a status word it made a drive of 3 + 2 words one of 0 + 5, which heard no STOP.
    """
    for layout, net, value in (
        (Layout(3, 2), b"\x70\xc8\x80\x00\x00\x66\xfb\x31\x00\x00", None),  # P2200: error 102
        (Layout(3, 2), b"\x12\xbc\x00\x00\x00\x05\xfb\x31\x00\x00", None),  # P0700 = 5
        (Layout(3, 2), b"\x00\x00\x00\x00\x00\x00\xfb\x31\x00\x00", None),
        (Layout(3, 2), b"\xfb\x31\x00\x00\x00\x00\x00\x00\x00\x00", NO_CHANNEL),
        (Layout(4, 2), b"\xeb\x31\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00", NO_CHANNEL),
        (Layout(3, 2), b"\x10\x0d\x80\x00\x00\x03\xfb\x31\x00\x00", 3),  # P2013
    ):
        question = Question(11, layout, 2013)
        question.take(bytearray(framed(11, net)), len(net) + 4, 0)
        assert question.value() == value, net


def test_how_long_it_takes():
    """No longer than the module says. The worst instant: its length was tried just before it was
    switched on."""
    promised_s = {(9600, 1): 4, (19200, 1): 4, (9600, 30): 45, (19200, 30): 30}
    for (baud, silent), limit_s in promised_s.items():
        for pkw_words, net_count in ((127, 10), (3, 10), (0, 4)):
            address = 2 if silent == 1 else 17
            absent = [each for each in range(2, 2 + silent) if each != address]
            line = Line({address: (pkw_words, 2)}, absent, baud=baud)
            line.run(5_000)
            asked = address | MIRROR, net_count
            line.run_until(lambda: line.last() == asked, 100_000)
            line.run(100)
            took_ms = line.found_after(address)
            print("%d baud, %d silent, PKW %d: %d ms" % (baud, silent, pkw_words, took_ms))
            assert took_ms < limit_s * 1000, (baud, silent, pkw_words, took_ms)
            assert layout_of(line.drives[address]) == (pkw_words, 2)
            assert not any(line.drives[1].counters[1:])
            line.check()


def test_while_another_runs_nobody_is_late():
    """P2014 of drive 1 is 2 s; and where so much is left that no silence fits, none is risked."""
    for off_time_ms in (2_000, 300):
        line = Line({2: (3, 2), 3: (127, 2)}, range(4, 20), baud=9600)
        line.master.deadlines.supervise(line.drives[1], off_time_ms)
        line.run(1_000)
        instants = []
        for step in range(30):
            since = line.wire.log.count
            line.run(1_000)
            if step == 10:
                line.motors[2].plug()
                line.motors[3].plug()
            for at_us, mine, characters in line.wire.log.last(line.wire.log.count - since):
                if mine and characters[2] == 1:
                    instants.append(at_us)
        longest_us = max([b - a for a, b in zip(instants, instants[1:])])
        print("P2014 = %d: %d us" % (off_time_ms, longest_us))
        assert longest_us < off_time_ms * 1000 // 3
        assert line.motors[1].state == "running" and line.drives[2].contact
        line.check()


# --- who is looked for --------------------------------------------------------------------------


class Short(Node):
    """It answers in three PKW words where it takes any length, and may answer something else. If
    asked, it tells its P2013 and P2012, unless it has no such parameters."""

    tells = True
    spoil = 0  # so many of its next replies are spoilt
    stray = None  # net data of what it answers to what is not for it

    def answer(self, characters):
        is_for_it = self.plugged and characters[2] == self.address
        if self.stray and is_for_it and not self._takes(len(characters) - 4):
            return framed(self.address, self.stray)
        reply = Node.answer(self, characters)
        if reply and self.spoil:
            self.spoil -= 1
            return reply[:5] + b"\x77" + reply[6:]
        if reply and self.pkw_words == VARIABLE and reply[2] == self.address:
            net = bytearray(reply[3:-1][-2 * (self.pzd_words + 3) :])
            told = {13: self.pkw_words, 12: self.pzd_words}.get(characters[4])
            if characters[3] == 0x10 and not self.tells:  # no such parameter
                return framed(self.address, b"\x70" + characters[4:7] + bytes(len(characters) - 8))
            if characters[3] == 0x10 and characters[5:7] == b"\x80\x00" and told is not None:
                net[:6] = b"\x10" + characters[4:7] + bytes((0, told))
            return framed(self.address, net)
        return reply


class Search(Bench):
    """A bench whose loop steps a finder. sets: {address: (PKW, PZD words)} of those that the list
    has as 4 + 2 words. found: the drives that it has found."""

    def __init__(self, sets=None, present=(1,), **more):
        nodes = [Node(address) for address in present]
        nodes += [Short(address) for address in sets or ()]
        Bench.__init__(self, nodes, **more)
        for address, (pkw_words, pzd_words) in (sets or {}).items():
            self.nodes[address].pkw_words = pkw_words
            self.nodes[address].pzd_words = pzd_words
        self.found = []
        self.finder = Finder(self.master, MASK)
        self.loop = self.step

    def step(self):
        drive = self.finder.step(self.now & MASK)
        if drive:
            self.found.append(drive)

    def mirrors(self, address=None, since=0):
        """Net characters of the mirror telegrams to it, or to everybody."""
        return [
            len(telegram.characters) - 4
            for telegram in self.sent[since:]
            if telegram.address & MIRROR and address in (None, telegram.address & 0x1F)
        ]

    def until_found(self, address, limit_us=60_000_000):
        self.run_until(lambda: self.drives[address].contact, limit_us)


def test_mirror_telegrams_have_nothing_in_them_that_a_drive_could_obey():
    bench = Search({2: (3, 2), 3: (127, 2), 4: (0, 2)})
    bench.run(20_000_000)
    assert all([drive.contact for drive in bench.drives.values()])
    for telegram in bench.sent:
        assert not telegram.address & MIRROR or not any(telegram.characters[3:-1])
    assert [bench.nodes[address].stw for address in (2, 3, 4)] == [pzd.OFF1] * 3


def test_a_drive_in_contact_is_left_alone_and_so_is_one_that_was_missed_now_and_then():
    bench = Search(present=(1, 2))
    for _ in range(20):
        bench.nodes[2].plugged = False
        bench.run(50_000)
        bench.nodes[2].plugged = True
        bench.run(400_000)
    assert bench.mirrors() == [] and not bench.found


def test_the_length_that_the_list_asks_in_is_left_out():
    for layout, lengths in (
        ((4, 2), [10, 4]), ((3, 2), [12, 4]), ((0, 2), [10, 12]), ((127, 2), [12, 4]),
        ((3, 0), [8]), ((0, 6), [18, 20]),
    ):  # fmt: skip
        bench = Bench([Node(1), Node(2, *layout)])
        bench.nodes[2].plugged = False
        bench.contact()
        search = Finder(bench.master, MASK)
        bench.loop = lambda: search.step(bench.now)
        bench.run(30_000_000)
        asked = [len(each.characters) - 4 for each in bench.sent if each.address == 2 | MIRROR]
        own = 2 * ((3 if layout[0] == 127 else layout[0]) + layout[1])
        others = [each for each in range(4, 26, 2) if each not in lengths and each != own]
        assert [each for each in asked if each in lengths][:4] == (lengths * 4)[:4], asked
        further = [each for each in asked if each not in lengths]
        assert further[: len(others)] == others and set(further) == set(others), (layout, asked)
        # Each turn of the drive ends with one of those.
        turn = len(lengths) + 1
        assert [asked[at] in others for at in range(turn)] == [False] * (turn - 1) + [True]


def test_where_eight_are_silent_other_process_data_are_tried_in_every_ninth_turn_of_a_drive():
    """With fewer, in each turn; the next length each time."""
    for silent, lengths in (
        (7, [10, 4, 6, 10, 4, 8, 10, 4, 14]),
        (8, [10, 4] * 9 + [6]),
    ):
        bench = Search({address: (3, 2) for address in range(2, 2 + silent)})
        for address in range(2, 2 + silent):
            bench.nodes[address].plugged = False
        bench.run(80_000_000)
        assert bench.mirrors(2)[: len(lengths)] == lengths, (silent, bench.mirrors(2))


class Silent(Bench):
    """Silent drives that the list has in these layouts, from address 2 on. Each telegram to them
    is over at once, and there is always room for the next one."""

    def __init__(self, layouts):
        nodes = [Node(address, *layout) for address, layout in enumerate(layouts, 2)]
        for node in nodes:
            node.plugged = False
        Bench.__init__(self, [Node(1)] + nodes)
        self.contact()
        self.run(100_000)
        self.silence = silence = self.master.deadlines.silence
        self.unused_us = 4 * silence.silent_exchange_us
        silence.wait_us, silence.charged_us = -self.unused_us, silence.shared_us
        silence.resting, silence.count = len(nodes), 0xFFFE
        for node in nodes:
            self.drives[node.address].silent = finding.SILENT_MIN
        self.asked = []  # (address, net characters) of each mirror telegram
        self.longer_us = None  # by so much the last one that was asked for was too long
        self.master.turns.post = self.post
        self.master.deadlines.silence_wait_us = self.room
        self.finder = Finder(self.master, MASK)

    def post(self, telegram):
        self.asked.append((telegram.node, telegram.size - 4))
        telegram.miss(SILENT, 0, 0, 0)
        self.silence.count = self.silence.count + 1 & 0xFFFF

    def room(self, longer_us=0):
        self.longer_us = longer_us
        return 0

    def next(self, count):
        """The next so many that are asked."""
        since = len(self.asked)
        for step in range(60 * count):
            assert self.finder.step(step) is None
            if len(self.asked) == since + count:
                return self.asked[since:]
        raise AssertionError("only %d were asked" % (len(self.asked) - since))

    def asks_another(self):
        """Whether another one is asked."""
        since = len(self.asked)
        for step in range(60):
            self.finder.step(step)
            if len(self.asked) > since:
                return True
        return False


def usual_and_further(pkw_words, pzd_words):
    """The lengths that a drive of this layout may have besides: those with its PZD words, and the
    others from 2 to 12 words."""
    usual = [2 * (words + pzd_words) for words in (3, 4, 0)]
    own = 2 * ((3 if pkw_words == VARIABLE else pkw_words) + pzd_words)
    further = [length for length in range(4, 26, 2) if length not in usual]
    return [length for length in usual if length not in (own, 0)], further


def test_each_turn_of_a_drive_has_the_usual_lengths_and_one_more_which_is_the_next_each_time():
    for layout in (
        (4, 2), (3, 2), (0, 2), (VARIABLE, 2), (3, 0), (4, 0), (VARIABLE, 0), (0, 1), (0, 6),
        (4, 8), (3, 9), (4, 12), (0, 16),
    ):  # fmt: skip
        usual, further = usual_and_further(*layout)
        expected = []
        for length in further * 2:
            expected += usual + [length]
        asked = [length for _, length in Silent([layout]).next(len(expected))]
        assert asked == expected, (layout, asked)


def test_eight_silent_drives_have_their_turns_in_the_order_of_the_list_and_nine_for_one_more():
    """Each goes on with the further lengths where it was; one of seven has one in each turn."""
    layouts = [(4, 2), (3, 2), (0, 2), (VARIABLE, 2), (3, 6), (4, 8), (3, 0), (4, 0)]
    for silent, every in ((7, 1), (8, 9)):
        expected = []
        for turn in range(1, 19):
            for address, layout in enumerate(layouts[:silent], 2):
                usual, further = usual_and_further(*layout)
                if turn % every == 0:
                    usual.append(further[(turn // every - 1) % len(further)])
                expected += [(address, length) for length in usual]
        asked = Silent(layouts[:silent]).next(len(expected))
        assert asked == expected, (silent, asked[:20])


def test_whoever_answers_in_another_length_is_next_once_and_then_waits_like_the_others():
    line = Silent([(4, 2)] * 9)

    def turns(count):
        asked = [address for address, _ in line.next(2 * count)]
        assert asked[::2] == asked[1::2], asked
        return asked[::2]

    assert turns(2) == [2, 3]
    for _ in range(2):
        line.drives[7].trouble = OTHER_LENGTH
        assert turns(10) == [7, 4, 5, 6, 7, 8, 9, 10, 2, 3]
        line.drives[7].trouble = 0
        assert turns(9) == [4, 5, 6, 7, 8, 9, 10, 2, 3]


def test_when_there_is_room_for_a_telegram_that_perhaps_nobody_answers():
    """The list has asked a silent one meanwhile, of eight two, or has left room for four; what the
    last one took is charged; no command waits; and no drive that runs would be late."""
    for resting, needed in ((7, 1), (8, 2)):
        line = Silent([(4, 2), (4, 2)])
        silence, turns, deadlines = line.silence, line.master.turns, line.master.deadlines
        silence.resting = resting
        line.next(1)
        for _ in range(4):
            for wait_us, meanwhile, is_asked in (
                (0, 0, False), (0, needed - 1, False), (1 - line.unused_us, 0, False),
                (0, needed, True), (-line.unused_us, 0, True), (0, needed + 1, True),
                (-1 - line.unused_us, 0, True),
            ):  # fmt: skip
                silence.wait_us = 0
                assert not line.asks_another()
                before, silence.wait_us = silence.count, wait_us
                silence.count = silence.count + meanwhile & 0xFFFF
                assert line.asks_another() == is_asked, (resting, wait_us, meanwhile)
                if not is_asked:
                    silence.count = before
        silence.wait_us = -line.unused_us
        turns.has_command = lambda: True
        assert not line.asks_another()
        turns.has_command = lambda: False
        silence.shared_us += 1
        assert not line.asks_another()
        silence.charged_us = silence.shared_us
        deadlines.silence_wait_us = lambda longer_us: 1
        assert not line.asks_another()
        deadlines.silence_wait_us = line.room
        assert line.asks_another()


def test_room_is_asked_for_what_a_telegram_takes_longer_than_those_of_the_list():
    """A telegram that is not answered: none of them is longer than one of 12 characters."""
    line = Silent([(4, 2), (0, 6), (4, 0)])
    own_us = line.timing.telegram_us(12)
    for _ in range(30):
        ((_, net_count),) = line.next(1)
        assert line.longer_us == max(line.timing.telegram_us(net_count) - own_us, 0), net_count


class Told:
    """In place of an `Enquirer`: it makes the finder ask so many questions, and knows `node`."""

    def __init__(self, layout, confirmed=True, variable=True, questions=1):
        self.node = Asked(2, 12, variable)
        self.node.layout = Layout(*layout)
        self.node.confirmed = confirmed
        self.questions = questions
        self.asked_for = None

    def begin(self, *asked_for):
        self.asked_for = asked_for
        return self

    def question(self, off):
        return Question(2, STANDARD, None, 0, off)

    def take(self, question):
        self.questions -= 1
        return self.questions <= 0


class Willing(Silent):
    """A line on which drive 2 sends back mirror telegrams of the lengths `takes`, or of any, and
    tells what `told` says. doubted: it is in contact. why: the finding where nothing comes."""

    def __init__(self, layouts, told=None, takes=None, doubted=False):
        Silent.__init__(self, layouts)
        if told:
            self.finder = Finder(self.master, MASK, told.begin)
        self.takes = takes
        self.why = SILENT
        self.answers = True  # it answers questions
        self.drive = self.drives[2]
        if doubted:
            self.drive.contact = True
            self.drive.silent = 0
            self.drive.doubt()

    def post(self, telegram):
        if not isinstance(telegram, Mirror):
            if not self.answers:
                telegram.miss(self.why, 0, 0, 0)
                return
        else:
            net_count = telegram.size - 4
            self.asked.append((telegram.node, net_count))
            if self.takes is not None and net_count not in self.takes:
                telegram.miss(self.why, 0, 0, 0)
                self.silence.count = self.silence.count + 1 & 0xFFFF
                return
        telegram.state = finding.DONE

    def steps(self, count):
        """The drive that has got another layout in so many steps, or None."""
        for step in range(count):
            drive = self.finder.step(step)
            if drive:
                return drive
        return None


def test_what_a_drive_tells_is_its_layout_unless_it_could_not_be_commanded_in_that():
    """Two PZD words at the least, if the list says that it has them; where nothing was told, what
    is likely. One in contact keeps what it has, if the other one is not likelier."""
    for listed, told, confirmed, variable, doubted, found in (
        ((4, 2), (3, 3), True, False, False, True), ((4, 2), (0, 16), True, True, False, True),
        ((4, 2), (VARIABLE, 16), True, True, False, True),
        ((4, 2), (4, 1), True, True, False, False),
        ((4, 2), (3, 0), True, True, False, False), ((4, 2), (3, 2), True, True, False, True),
        ((4, 3), (4, 1), True, True, False, False), ((4, 3), (4, 2), True, True, False, True),
        ((4, 1), (3, 1), True, True, False, True), ((4, 1), (3, 0), True, True, False, True),
        ((4, 0), (3, 1), True, True, False, True), ((4, 2), (4, 2), True, True, False, False),
        ((3, 4), (3, 2), True, True, False, True), ((4, 2), (4, 4), False, False, False, True),
        ((4, 2), (3, 3), True, False, True, True), ((4, 2), (4, 2), True, True, True, False),
        ((4, 2), (3, 3), False, False, True, False), ((4, 2), (0, 6), False, False, True, True),
    ):  # fmt: skip
        line = Willing([listed], Told(told, confirmed, variable), doubted=doubted)
        drive = line.steps(60)
        assert (drive is line.drive) == found, (listed, told, doubted)
        assert layout_of(line.drive) == (told if found else listed), (listed, told, doubted)
        assert not line.drive.doubted and line.drive.contact == (doubted and not found)
    # Variable length, and it does not tell its PZD words: those of the list.
    line = Willing([(4, 4)], Told((VARIABLE, 2), False, True))
    assert line.steps(60) is line.drive and layout_of(line.drive) == (VARIABLE, 4)


def test_it_is_asked_for_its_layout_alone_and_with_the_length_that_it_takes():
    """And not at all if it takes one of the usual lengths, and none that is longer."""
    for doubted, takes, asked, asked_for in (
        (False, None, [10, 12], (2, 10, True, False)),
        (False, (6,), [10, 4, 6, 8, 8], (2, 6, False, False)),
        (True, None, [14], (2, 12, True, False)),
        (True, (), [14, 14], (2, 12, False, False)),
    ):
        told = Told((4, 4))
        line = Willing([(4, 2)], told, takes, doubted)
        assert line.steps(60) is line.drive
        assert [length for _, length in line.asked] == asked, (doubted, takes, line.asked)
        assert told.asked_for == asked_for
    for takes, asked, words in (((10,), [10, 12, 12], (3, 2)), ((4,), [10, 4, 6, 6], (0, 2))):
        told = Told((4, 4))
        line = Willing([(4, 2)], told, takes)
        assert line.steps(60) is line.drive and layout_of(line.drive) == words
        assert [length for _, length in line.asked] == asked and told.asked_for is None


def test_the_list_leaves_a_drive_that_answers_late_to_the_questions_until_contact_is_at_stake():
    """A silence is not late; who was late once is late until all is told. A third of the time
    after which it is lost is left to them, and any time if it is not in contact."""
    for doubted in (True, False):
        told, passed_us = Told((3, 3), questions=8), [0]
        line = Willing([(4, 2)], told, doubted=doubted)
        silence = line.silence
        line.drive.silent_us = lambda now, mask, passed_us=passed_us: passed_us[0]
        bound_us = line.master.deadlines.bound_us(line.drive)
        assert bound_us == 333_333
        for answers, why, us, is_left in (
            (True, GOOD, 0, False), (False, SILENT, 0, False), (False, GOOD, 0, True),
            (False, SILENT, bound_us - 1, True), (False, GOOD, bound_us, not doubted),
            (True, GOOD, bound_us - 1, True), (False, SILENT, bound_us + 1, not doubted),
        ):  # fmt: skip
            line.answers, line.why, passed_us[0] = answers, why, us
            left = told.questions
            while told.questions == left:
                assert line.steps(1) is None
            assert (silence.spared is line.drive) == is_left, (doubted, answers, why, us)
            assert is_left or silence.spared is None
        line.answers = True
        assert line.steps(60) is line.drive and silence.spared is None


def test_it_waits_while_too_many_telegrams_wait_and_then_asks_what_it_was_about_to():
    line = Silent([(4, 2)])
    turns, refused = line.master.turns, []

    def refuse(telegram):
        refused.append(telegram.size - 4)
        raise RuntimeError("too many wait")

    turns.post = refuse
    assert not line.asks_another() and len(refused) > 3 and set(refused) == {10}
    turns.post = line.post
    assert line.next(2) == [(2, 10), (2, 4)]


def test_a_drive_that_is_changed_in_its_turn_begins_anew_with_the_next():
    """Its new layout has other lengths. One that answers has no turn, one that is removed neither;
    one that was moved goes on at its new address."""
    line = Silent([(4, 2), (4, 2)])
    turns, drive = line.master.turns, line.drives[2]
    assert line.next(1) == [(2, 10)]
    turns.relayout(drive, Layout(4, 6))
    drive.silent = finding.SILENT_MIN
    line.silence.wait_us = -4 * line.silence.silent_exchange_us  # it takes longer now
    assert line.next(5) == [(3, 10), (3, 4), (3, 6), (2, 18), (2, 12)]
    turns.readdress(drive, 9)
    assert line.next(3) == [(9, 4), (3, 10), (3, 4)]
    drive.silent = 0
    assert line.next(5) == [(3, 8), (3, 10), (3, 4), (3, 14), (3, 10)]
    drive.silent = finding.SILENT_MIN
    turns.remove(line.drives[3])
    assert line.next(3) == [(9, 18), (9, 12), (9, 6)]


def test_what_came_back_from_the_address_where_it_was_tells_nothing_of_a_drive():
    line = Silent([(4, 2), (4, 2)])
    waiting = []

    def keep(telegram):
        telegram.state = finding.PENDING
        waiting.append(telegram)

    turns = line.master.turns
    turns.post = keep
    while not waiting:
        assert line.finder.step(0) is None
    turns.readdress(line.drives[2], 9)
    waiting[0].state = finding.DONE
    turns.post = line.post
    assert line.next(4) == [(3, 10), (3, 4), (3, 6), (9, 10)]


def test_replies_that_were_spoilt_in_an_earlier_turn_do_not_count():
    line = Willing([(4, 2)], takes=())
    line.why = BAD_BCC
    assert line.next(2) == [(2, 10)] * 2
    line.drive.silent = 0
    assert not line.asks_another()
    line.drive.silent = finding.SILENT_MIN
    line.silence.count = 7
    assert line.next(4) == [(2, 10)] * 3 + [(2, 4)]


def test_spoilt_replies_to_one_length_do_not_count_against_the_longer_one_or_the_next():
    """Two silences, or three telegrams that came back spoilt."""
    for why, times in ((SILENT, 2), (BAD_BCC, 3)):
        for spoilt in (0, 1, 2):
            line = Willing([(4, 2)], takes=())
            line.why = BAD_BCC
            if spoilt:
                assert line.next(spoilt) == [(2, 10)] * spoilt
            line.takes = (10,)
            assert line.next(1) == [(2, 10)]
            line.why = why
            assert line.steps(60) is line.drive and layout_of(line.drive) == (3, 2)
            assert line.asked[spoilt + 1 :] == [(2, 12)] * times, (why, spoilt)
            line = Willing([(4, 2)], takes=())
            line.why = BAD_BCC
            if spoilt:
                line.next(spoilt)
            line.why = SILENT
            assert line.next(1) == [(2, 10)]
            line.why = BAD_BCC
            assert line.next(4) == [(2, 4)] * 3 + [(2, 6)], spoilt


def test_it_looks_for_silent_drives_when_a_telegram_was_not_answered_or_one_is_doubted():
    """And else it takes no time. The count of silences has 16 bits."""
    line = Silent([(4, 2), (4, 2)])
    line.drives[2].silent = line.drives[3].silent = 0
    for count in (5, 0xFFFF, 0):
        line.silence.count = count
        assert not line.asks_another()
        line.drives[2].silent = finding.SILENT_MIN
        assert not line.asks_another()
        line.silence.count = count + 1 & 0xFFFF
        assert line.asks_another()
        line.drives[2].silent = 0
        assert not line.asks_another()
    line.drives[3].contact = True
    line.drives[3].doubt()
    assert line.asks_another() and line.asked[-1] == (3, 14)


def test_one_that_was_running_when_it_was_lost_is_told_to_stop_before_it_is_looked_for():
    """And then in the layout in which it hears that."""
    bench = Search(present=(1, 2))
    bench.contact()
    bench.drives[2].start(0x1000)
    bench.run(300_000)
    node = bench.nodes[2]
    node.plugged = False
    sent = len(bench.sent)
    while not bench.mirrors():
        bench.run(1_000)
    assert bench.drives[2].was_running and not bench.drives[2].contact
    assert bench.stws(2, sent).count(pzd.OFF1) > 10
    node.pkw_words = 3
    node.plugged = True
    bench.run(20_000_000)
    assert bench.drives[2].contact and bench.drives[2].layout.is_like(Layout(3, 2))
    assert pzd.ON not in bench.stws(2, sent)[30:] and not bench.drives[2].is_on()


def test_all_its_stops_out_of_turn_come_first_also_where_it_is_lost_late():
    """Until then it was told to run, in more telegrams than would do."""
    bench = Search(present=(1, 2))
    bench.master.turns.lost_us = 5_000_000
    bench.contact()
    drive = bench.drives[2]
    drive.start(0x1000)
    bench.run(300_000)
    bench.nodes[2].plugged = False
    since = len(bench.sent)
    bench.run_until(lambda: bench.mirrors(2, since), 30_000_000)
    stws = bench.stws(2, since)
    assert stws.count(pzd.ON) > finding.STOPPED_MIN, stws
    assert stws.count(pzd.OFF1) > 10, stws
    drive.stop()  # STOP is pressed once more
    since = len(bench.sent)
    bench.run_until(lambda: len(bench.stws(2, since)) > 10, 20_000_000)
    assert bench.mirrors(2, since) == []


def test_one_that_falls_silent_again_is_looked_for_again():
    bench = Search({2: (3, 2)})
    drive, node = bench.drives[2], bench.nodes[2]
    for pkw_words in (3, 0, 4, 127, 0):
        node.plugged = False
        bench.run(3_000_000)
        node.pkw_words = pkw_words
        node.plugged = True
        bench.until_found(2)
        assert drive.layout.pkw_words == pkw_words
        asked = len(bench.mirrors())
        bench.run(10_000_000)
        assert len(bench.mirrors()) <= asked + 1 and drive.contact
    assert bench.found == [drive] * 5


def test_one_that_was_found_is_asked_by_the_list_before_it_is_looked_for_again():
    """In its new layout, and again if those telegrams are lost, as often as any other drive."""
    for lost in range(3):
        bench = Search({2: (3, 2), 3: (0, 2), 4: (127, 2)})
        bench.nodes[3].plugged = bench.nodes[4].plugged = False
        bench.run_until(lambda: bench.found)
        drive, node, since = bench.drives[2], bench.nodes[2], len(bench.sent)
        node.plugged = False
        bench.run_until(lambda: len(bench.stws(2, since)) >= lost, 20_000_000)
        bench.run(100_000)
        node.plugged = True
        bench.run_until(lambda: drive.contact, 20_000_000)
        assert bench.mirrors(2, since) == [] and bench.found == [drive], lost


def test_one_that_answers_in_another_length_goes_first_unless_that_was_in_vain():
    sets = {address: (127, 2) for address in range(2, 12)}
    bench = Search(sets)
    for address in sets:
        bench.nodes[address].plugged = False
    bench.run(20_000_000)
    node = bench.nodes[9]
    node.plugged = True
    node.pkw_words, node.pzd_words, node.stray = 4, 12, bytes(22)
    bench.run_until(lambda: bench.drives[9].trouble == OTHER_LENGTH)
    since = len(bench.sent)
    bench.run(30_000_000)
    asked = [each.address & 0x1F for each in bench.sent[since:] if each.address & MIRROR]
    first = asked.index(9)
    assert first < 3 and asked[first + 1] == 9, asked
    later = asked[first + 2 :]
    counts = [later.count(address) for address in sets]
    assert max(counts) - min(counts) <= 2 < min(counts), asked
    node.plugged = False
    bench.run(1_000_000)


def test_one_that_goes_first_changes_nothing_about_whose_turn_it_is_afterwards():
    sets = {address: (127, 2) for address in range(2, 9)}
    bench = Search(sets)
    for address in sets:
        bench.nodes[address].plugged = False
    bench.run(10_000_000)
    bench.run_until(lambda: bench.sent[-1].address == 7 | MIRROR)  # that of 6 is just over
    since, node = len(bench.sent) - 1, bench.nodes[6]
    node.plugged = True
    node.pkw_words, node.pzd_words, node.stray = 4, 12, bytes(22)
    bench.run(15_000_000)
    asked = [each.address & 0x1F for each in bench.sent[since:] if each.address & MIRROR]
    turns = [b for a, b in zip(asked, asked[1:]) if a != b]
    first = [at for at, (a, b) in enumerate(zip(turns, turns[1:]), 1) if b == 6 and a != 5]
    assert len(first) == 1, turns
    turns.pop(first[0])
    assert len(turns) > 10 and 8 in turns, turns
    for a, b in zip(turns, turns[1:]):
        assert b == (a + 1 if a < 8 else 2), turns


def test_a_reply_that_was_spoilt_is_asked_for_again():
    for spoilt in (1, 2):
        bench = Search({2: (3, 2)})
        bench.run_until(lambda: bench.mirrors(2))
        bench.nodes[2].spoil = spoilt
        bench.until_found(2)
        assert bench.drives[2].layout.is_like(Layout(3, 2))


def test_one_that_no_telegram_reaches_whole_is_left_for_this_time():
    """And the others are looked for."""
    bench = Search({2: (3, 2), 3: (0, 2)})
    bench.nodes[2].spoil = 1_000
    bench.until_found(3)
    asked = bench.mirrors(2)
    assert asked[:4] == [10] * 3 + [4], asked
    bench.nodes[2].spoil = 0
    bench.until_found(2)


def test_each_length_that_a_drive_takes_is_tried_three_times():
    bench = Search({2: (127, 2)})
    bench.nodes[2].spoil = 1_000
    bench.run_until(lambda: len(bench.mirrors(2)) > 2 * 3, 20_000_000)
    first, second = bench.mirrors(2)[:3], bench.mirrors(2)[3:]
    assert len(set(first)) == 1 and len(set(second[:3])) == 1, bench.mirrors(2)
    assert first[0] != second[0] != second[3], bench.mirrors(2)


def test_a_telegram_that_is_lost_makes_no_fixed_length_of_a_variable_one():
    bench = Search({2: (127, 2)})
    node, answer = bench.nodes[2], bench.nodes[2].answer
    lost = []

    def lossy(characters):
        if characters[2] & MIRROR and len(characters) == 16 and not lost:
            lost.append(characters)
            return None
        return answer(characters)

    node.answer = lossy
    bench.until_found(2)
    assert lost and bench.drives[2].layout.variable


def test_one_whose_longer_replies_are_spoilt_and_then_lost_is_taken_for_one_of_fixed_length():
    """Which such a drive takes as well; and nobody asks it for ever."""
    bench = Search({2: (127, 2)})
    node, answer = bench.nodes[2], bench.nodes[2].answer
    longer = []

    def spoilt(characters):
        reply = answer(characters)
        if characters[2] & MIRROR and len(characters) == 16:
            longer.append(reply)
            return reply[:5] + b"\x77" + reply[6:] if len(longer) < 3 else None
        return reply

    node.answer = spoilt
    bench.until_found(2)
    assert bench.mirrors(2) == [10, 12, 12, 12] and layout_of(bench.drives[2]) == (3, 2)


def test_the_list_goes_on_asking_one_that_answers_each_question_in_time():
    bench = Search({2: (127, 2)})
    silence, spared = bench.master.deadlines.silence, []

    def loop():
        bench.step()
        spared.append(silence.spared)

    bench.loop = loop
    bench.until_found(2)
    assert bench.drives[2].layout.variable and set(spared) == {None}


def test_a_drive_is_asked_for_its_layout_and_for_nothing_else():
    """P2013 and P2012; not what it is, nor when it trips."""
    bench = Search({2: (127, 2)})
    bench.until_found(2)
    asked = {each.characters[3:7] for each in bench.sent if each.address == 2}
    assert asked == {b"\x10\x0d\x80\x00", b"\x10\x0c\x80\x00", bytes(4)}, asked


def test_one_that_takes_any_length_and_tells_nothing_gets_the_pzd_words_of_the_list():
    bench = Search({2: (127, 4)})
    bench.nodes[2].tells = False
    turns = bench.master.turns
    turns.remove(bench.drives[2])
    bench.drives[2] = turns.add(2, Layout(4, 4))
    bench.until_found(2)
    assert layout_of(bench.drives[2]) == (VARIABLE, 4)


def test_a_drive_that_is_changed_or_removed_meanwhile():
    """By the operator: its layout, its address; or it answers at last, or stands there no more."""

    def relayout(bench):
        bench.master.turns.relayout(bench.drives[2], Layout(0, 2))

    def readdress(bench):
        bench.nodes[9] = bench.nodes[2]
        bench.nodes[9].address = 9
        bench.master.turns.readdress(bench.drives[2], 9)

    def remove(bench):
        bench.master.turns.remove(bench.drives[2])

    def answer(bench):
        bench.nodes[2].pkw_words = 4

    for change in (relayout, readdress, remove, answer):
        for later_us in range(0, 120_000, 7_000):
            bench = Search({2: (3, 2), 3: (127, 2)})
            bench.run_until(lambda: bench.mirrors(2))
            bench.run(later_us)
            if not bench.drives[2].contact:
                change(bench)

            def is_as_it_should_be():
                drives = bench.master.turns.drives
                node = bench.nodes[bench.drives[2].address]
                told = bench.drives[2].layout.pkw_words == node.pkw_words or change is remove
                return told and all([drive.contact for drive in drives])

            print(change, later_us)
            bench.run_until(is_as_it_should_be, 12_000_000)
            bench.run(500_000)
            assert is_as_it_should_be() and bench.drives[3].layout.variable


def test_where_many_are_removed_the_others_are_still_looked_for():
    """It goes through the list one drive in a step, and that may become shorter meanwhile."""
    for steps in (4, 5, 6, 7, 8):
        bench = Search({address: (3, 2) for address in range(2, 9)})
        for address in range(2, 9):
            bench.nodes[address].plugged = False
        bench.run(1_000_000)
        bench.finder = Finder(bench.master, MASK)
        for _ in range(steps):
            bench.step()
        for address in range(4, 9):
            bench.master.turns.remove(bench.drives[address])
        bench.nodes[2].plugged = bench.nodes[3].plugged = True
        bench.until_found(2)
        bench.until_found(3)


def test_one_that_answers_while_it_gets_another_layout_keeps_its_own():
    bench = Search({2: (3, 2)})
    turns = bench.master.turns
    relayout = turns.relayout
    refused = []

    def refuse(drive, layout, doubted):
        refused.append(layout)
        turns.relayout = relayout
        raise ValueError("it is in contact")

    turns.relayout = refuse
    bench.until_found(2)
    assert len(refused) == 1 and bench.found == [bench.drives[2]]


def test_two_layouts_that_are_the_same_are_one_object():
    bench = Search({address: (3, 2) for address in range(2, 6)})
    bench.run(20_000_000)
    layouts = [bench.drives[address].layout for address in range(2, 6)]
    assert len(bench.found) == 4 and [each is layouts[0] for each in layouts] == [True] * 4


# --- when the next telegram goes, and which -----------------------------------------------------


def noted(bench, note):
    """What `note()` says whenever the finder posts a telegram, from now on."""
    post, notes = bench.master.turns.post, []

    def noting(telegram):
        notes.append(note())
        post(telegram)

    bench.master.turns.post = noting
    return notes


def test_two_silences_show_that_a_drive_takes_no_longer_telegram_and_one_answer_that_it_does():
    """A reply that was spoilt costs one telegram more, and no silence of those after it."""
    for words, lengths in (((3, 2), [10, 12, 12]), ((0, 2), [10, 4, 6, 6])):
        for spoilt in (0, 1, 2):
            bench = Search({2: words})
            bench.nodes[2].spoil = spoilt
            bench.until_found(2)
            at = 0 if words == (3, 2) else 1
            asked = lengths[:at] + [lengths[at]] * spoilt + lengths[at:]
            assert bench.mirrors(2) == asked, (words, spoilt, bench.mirrors(2))
    for words, lengths in (
        ((127, 2), [10, 12]),
        ((4, 3), [10, 4, 6, 10, 4, 8, 10, 4, 14, 16, 16]),
    ):
        bench = Search({2: words})
        bench.until_found(2)
        assert bench.mirrors(2)[: len(lengths)] == lengths, (words, bench.mirrors(2))


def test_three_silences_of_one_that_stood_and_thirty_of_one_that_may_run_come_first():
    for runs, silences in ((False, 3), (True, 30)):
        bench = Search(present=(1, 2))
        drive = bench.drives[2]
        if runs:
            bench.contact()
            drive.start(0x1000)
            bench.run(300_000)
        bench.nodes[2].plugged = False
        notes = noted(bench, lambda: drive.silent)
        bench.run_until(lambda: notes)
        assert notes[0] == silences, (runs, notes)


def test_the_list_asks_one_silent_drive_for_each_telegram_and_two_where_eight_are_silent():
    """The silent drives have them in the order of the list, over the wrap of the count too."""
    for silent, between in ((7, 1), (8, 2)):
        bench = Search({address: (3, 2) for address in range(2, 2 + silent)})
        for address in range(2, 2 + silent):
            bench.nodes[address].plugged = False
        bench.master.deadlines.silence.count = 0xFFF0
        bench.contact()
        bench.drives[1].start(0x1000)
        bench.run(18_000_000)
        asked = [address for address in bench.addresses() if address != 1]
        places = [place for place, address in enumerate(asked) if address & MIRROR]
        apart = [b - a - 1 for a, b in zip(places, places[1:])]
        assert len(apart) > 30 and set(apart) == {between}, (silent, apart)
        turns = [asked[place] & 0x1F for place in places]
        turns = [b for a, b in zip(turns, turns[1:]) if a != b]
        turns = turns[turns.index(2, 4) :]  # until then not all of them were silent long enough
        order = list(range(2, 2 + silent)) * 2
        assert turns[: len(order)] == order[: len(turns)] and len(turns) > 4, (silent, turns)


def test_room_that_the_list_does_not_use_is_taken_after_four_silent_telegrams():
    for silent in (1, 8):
        bench = Search({address: (3, 2) for address in range(2, 2 + silent)})
        for address in range(2, 2 + silent):
            bench.nodes[address].plugged = False
        bench.run(3_000_000)
        silence = bench.master.deadlines.silence
        silence.give_turn = lambda: None  # the list asks no silent drive any more
        bench.run(1_000_000)
        notes = noted(bench, lambda: silence.wait_us + 4 * silence.silent_exchange_us)
        bench.run(4_000_000)
        assert len(notes) > 2 and all([-3_000 < late_us <= 0 for late_us in notes]), notes


def test_one_that_is_doubted_while_it_may_run_is_asked_as_soon_as_it_stands():
    """Though nothing else happens meanwhile that would make the finder look; and not again."""
    bench = Search(present=(1, 2))
    bench.contact()
    bench.drives[2].start(0x1000)
    bench.run(300_000)
    bench.drives[2].doubt()
    bench.run(700_000)
    assert bench.mirrors() == [] and bench.drives[2].doubted
    bench.drives[2].stop()
    bench.run(700_000)
    assert bench.mirrors() == [14, 14] and bench.mirrors(2) == [14, 14]
    bench.run_until(lambda: not bench.drives[2].doubted, 30_000_000)
    bench.run(700_000)
    assert bench.mirrors() == [14, 14] and not bench.found


def test_the_longest_telegram_that_a_drive_can_take_is_one_word_longer_than_any_of_the_list():
    """4 + 16 words, from a drive that is doubted: perhaps it takes any length."""
    for words, net_count in (((4, 16), 42), ((3, 16), 40)):
        bench = Bench([Node(1), Node(2, *words)])
        bench.contact()
        search = Finder(bench.master, MASK)
        bench.loop = lambda: search.step(bench.now)
        bench.drives[2].doubt()
        bench.run(1_500_000)
        asked = [len(each.characters) - 4 for each in bench.sent if each.address == 2 | MIRROR]
        assert asked == [net_count] * 2, (words, asked)


def test_a_telegram_that_is_longer_than_those_of_the_list_needs_room_for_the_rest():
    for layout, lengths in (((0, 2), (6, 8, 10, 12, 14, 16)), ((4, 2), (12, 14, 16))):
        bench = Bench([Node(1, *layout), Node(2, *layout)])
        bench.nodes[2].plugged = False
        bench.contact()
        search = Finder(bench.master, MASK)
        bench.loop = lambda: search.step(bench.now)
        wait_us, longer = bench.master.deadlines.silence_wait_us, set()

        def noting(longer_us):
            longer.add(longer_us)
            return wait_us(longer_us)

        bench.master.deadlines.silence_wait_us = noting
        bench.run(10_000_000)
        own_us = bench.timing.telegram_us(2 * sum(layout))
        rests = [bench.timing.telegram_us(length) - own_us for length in lengths]
        assert sorted(longer) == rests, (layout, longer)


def test_a_telegram_that_is_lost_is_given_up_after_ten_seconds():
    """And its buffer is not used again, because the engine may still have it."""
    bench = Search({2: (3, 2)})
    bench.nodes[2].plugged = False
    posted = []

    def swallow(telegram):
        telegram.state = finding.PENDING
        posted.append((telegram, bench.now))

    bench.master.turns.post = swallow
    bench.run_until(lambda: posted)
    began = posted[0][1]
    for waited_us, count in ((0, 1), (9_999_999, 1), (10_000_000, 2)):
        bench.loop = lambda: bench.finder.step(began + waited_us & MASK)
        bench.run(1_500_000)
        assert len(posted) == count, waited_us
    assert posted[0][0] is not posted[1][0]


# --- where nobody can be asked ------------------------------------------------------------------


def test_nothing_is_sent_while_the_bus_listens_or_is_off():
    bench = Search({2: (3, 2)})
    bench.nodes[2].plugged = False
    bench.run(3_000_000)
    bench.master.off()
    bench.run(1_000_000)
    sent = len(bench.sent)
    bench.nodes[2].plugged = True
    bench.run(30_000_000)
    assert len(bench.sent) == sent
    bench.master.on()
    bench.until_found(2)


def test_nothing_is_posted_before_the_bus_has_listened_nor_after_it_was_closed():
    """What was posted would be sent as the first thing when it is on again."""
    bench = Search({2: (3, 2)})
    bench.nodes[2].plugged = False
    bench.run(3_000_000)
    notes = noted(bench, lambda: bench.master.phase)
    for _ in range(3):
        bench.master.off()
        bench.run(1_000_000)
        bench.master.on()
        bench.run(1_500_000)
    assert len(notes) > 3 and not {LISTENING, OFF, CLOSED} & set(notes), notes
    posted = len(notes)
    bench.master.close()
    bench.run(2_000_000)
    assert bench.master.phase == CLOSED and len(notes) == posted


def test_where_others_wait_already_it_waits():
    bench = Search({2: (3, 2)})
    bench.nodes[2].plugged = False
    bench.run(2_000_000)
    posts = []

    def crowd():
        while True:
            single = Mirror(1)
            try:
                bench.master.turns.post(single)
            except RuntimeError:
                break
            posts.append(single)

    step = bench.loop

    def loop():
        crowd()
        step()

    bench.loop = loop
    asked = len(bench.mirrors(2))
    bench.run(5_000_000)
    assert len(bench.mirrors(2)) <= asked + 1
    bench.loop = step
    bench.nodes[2].plugged = True
    bench.until_found(2)


def test_a_telegram_that_is_never_through_does_not_hold_it_up():
    """An exception in the engine may lose one."""
    bench = Search({2: (3, 2)})
    post = bench.master.turns.post
    lost = []

    def swallow(mirror):
        assert mirror not in lost  # the engine may still have that one
        if not lost:
            lost.append(mirror)
            mirror.state = finding.PENDING
        else:
            post(mirror)

    bench.master.turns.post = swallow
    bench.until_found(2, 20_000_000)
    assert len(lost) == 1 and bench.found
    assert bench.now > 10_000_000, "it may only wait its turn"


# --- the others ---------------------------------------------------------------------------------


def gaps(bench, address, since):
    instants = [each.at for each in bench.sent[since:] if each.address == address]
    return [b - a for a, b in zip(instants, instants[1:])]


def test_a_drive_that_runs_keeps_four_fifths_of_its_telegrams():
    bench = Bench([Node(1)] + [Node(address) for address in range(2, 12)])
    for address in range(2, 12):
        bench.nodes[address].plugged = False
    bench.contact()
    bench.drives[1].start(0x1000)
    bench.run(3_000_000)
    beside = bench.rate(1, 20_000_000)
    search = Finder(bench.master, MASK)
    bench.loop = lambda: search.step(bench.now)
    since = len(bench.sent)
    searched = bench.rate(1, 20_000_000)
    mirrors = [each for each in bench.sent[since:] if each.address & MIRROR]
    assert searched > 0.97 * beside and len(mirrors) > 20, (beside, searched, len(mirrors))
    assert bench.nodes[1].zsw == RUNNING and not any(bench.drives[1].counters[1:])


def test_a_stop_is_on_the_line_as_soon_as_beside_silent_drives_anyway():
    bench = Search(present=tuple(range(1, 8)))
    for address in range(3, 8):
        bench.nodes[address].plugged = False
    bench.contact()
    bench.run(2_000_000)
    silence = bench.master.deadlines.silence
    limit_us = silence.silent_exchange_us + bench.timing.start_interval_us
    latest_us = 0
    for step in range(250):
        bench.drives[1].start(0x1000)
        bench.run(300_000 + 1_739 * step % 90_000)
        assert bench.nodes[1].zsw == RUNNING
        sent = len(bench.sent)
        began = bench.now
        bench.drives[1].stop()
        bench.run(100_000)
        first = bench.sent[sent]
        assert first.address == 1 and first.stw() == pzd.OFF1, first
        latest_us = max(latest_us, first.at - began)
    print("%d us, mirrors: %d" % (latest_us, len(bench.mirrors())))
    assert latest_us <= limit_us and len(bench.mirrors()) > 50


def test_while_commands_wait_none_is_sent():
    """Nor right behind them: they have cost what the silent drives share."""
    bench = Search(present=tuple(range(1, 32)))
    for address in range(3, 32):
        bench.nodes[address].plugged = False
    for step in range(10):
        bench.loop = bench.step
        bench.run(3_000_000 + 7_111 * step)
        bench.loop = None
        bench.run(50_000)
        bench.run_until(lambda: bench.master.deadlines.silence_wait_us() == 0)
        since = len(bench.sent)
        bench.master.stop_all()
        bench.loop = bench.step
        bench.run_until(lambda: not bench.master.turns.has_command())
        bench.run(150_000)
        told = bench.addresses(since)
        assert not bench.mirrors(None, since) and set(range(1, 32)) <= set(told), told


def test_a_drive_that_is_switched_on_beside_thirty_others_is_found_by_the_list():
    """In less than one and a half times what it takes without a finder."""
    bench = Search(present=tuple(range(1, 32)))
    for address in range(2, 32):
        bench.nodes[address].plugged = False
    bench.contact()
    bench.drives[1].start(0x1000)
    bench.run(20_000_000)
    silence_us = bench.master.deadlines.silence.silent_exchange_us
    limit_us = 30 * silence_us * 6 * 3 // 2 + 2_000_000
    for address in (5, 30, 16):
        bench.nodes[address].plugged = True
        bench.until_found(address, limit_us)
        bench.run(1_234_567)
    assert not bench.found


def test_other_pzd_words_are_found_beside_many_silent_drives_too():
    """It takes a minute at the least: the usual lengths of the others come first."""
    bench = Search({2: (0, 3)}, present=(1,) + tuple(range(3, 11)))
    for address in range(2, 11):
        bench.nodes[address].plugged = False
    bench.contact()
    bench.drives[1].start(0x1000)
    bench.run(5_000_000)
    bench.nodes[2].plugged = True
    began = bench.now
    bench.until_found(2, 90_000_000)
    assert bench.now - began > 45_000_000, bench.now - began
    assert layout_of(bench.drives[2]) == (0, 3) and bench.found == [bench.drives[2]]


def test_where_nobody_answers_and_nobody_may_run_it_is_quick():
    bench = Search({2: (0, 2), 3: (3, 2), 4: (127, 2)}, present=())
    bench.run_until(lambda: all([drive.contact for drive in bench.drives.values()]), 4_000_000)


def test_no_motor_starts_by_it():
    """Whatever was wanted before its layout was found is void."""
    for pkw_words in (0, 3, 127):
        bench = Search({2: (pkw_words, 2)})
        drive = bench.drives[2]
        while not drive.contact:
            drive.start(0x1000)
            bench.run(1_000_000)
            assert bench.now < 30_000_000
        assert bench.nodes[2].zsw != RUNNING
        sent = len(bench.sent)
        bench.run(3_000_000)
        drive.start(0x1000)
        bench.run(300_000)
        assert pzd.ON in bench.stws(2, sent) and bench.nodes[2].zsw == RUNNING


# --- memory -------------------------------------------------------------------------------------


def test_a_step_takes_memory_only_when_something_is_found():
    """And where there is none, nothing is changed: the next step does it."""
    if not hasattr(micropython, "heap_lock"):
        return  # CPython
    bench = Search({2: (3, 2)}, present=(1, 5, 6, 7))
    for address in (5, 6, 7):
        bench.nodes[address].plugged = False
    step = bench.finder.step
    bench.loop = None
    wanting = 0
    for _ in range(10_000):
        bench.run(2_000)
        now = bench.now
        is_short = False
        micropython.heap_lock()
        try:
            step(now)
        except MemoryError:
            is_short = True
        finally:
            micropython.heap_unlock()
        if is_short:
            wanting += 1
            step(now)
    print("%d steps in %d s took memory" % (wanting, bench.now // 1_000_000))
    asked = len(bench.mirrors())
    assert bench.drives[2].contact and bench.drives[2].layout.is_like(Layout(3, 2))
    assert asked > 10 and wanting == 1
