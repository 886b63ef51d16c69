# SPDX-License-Identifier: MIT
"""Going on at once: the next telegram leaves as soon as the reply is there, and says nothing that
the reply, the program or another master has changed meanwhile.

The link looks at the reply by itself, 32 bits after its last character as the RP2040's does.
"""

import random

from round_bench import MASK, READY, RUNNING, Bench, Node, framed
from uss import pkw, pzd
from uss.drive import ANY, ATTENTION
from uss.families import GENERIC, drive_maker
from uss.finding.witness import RESPONSE_DELAY, START_DELAY, Witness
from uss.going_on import master as going_on
from uss.going_on import plan as plans
from uss.going_on import python
from uss.layout import Layout
from uss.master import AWAITING, DEAD_MAN_US, SENDING
from uss.outside import Mirror
from uss.receiver import Receiver
from uss.tasks.change_reports import Reports
from uss.telegram import GOOD

IDLE_US = 1_667  # 32 bits at 19200
FAULT, INHIBIT = 0x0008, 0x0040
LATE_US = 20  # after the end of a reply is known


class Pump(GENERIC):
    zsw_says = ((0, 0, pzd.ZSW_READY),)


class Telling(Node):
    """Answers what it is asked for; the value of a parameter is its number. lag: it does so so
    many telegrams later. deaf: it takes no task at all."""

    def __init__(self, address, lag=0, deaf=False, **more):
        Node.__init__(self, address, **more)
        self.asked = []
        self.lag = lag
        self.deaf = deaf
        self.hiw = 0
        self._pkw = [bytes(8)] * (lag + 1)

    def answer(self, characters):
        reply = Node.answer(self, characters)
        if reply is None or characters[2] != self.address:
            return reply
        words = bytearray(8)
        if characters[3] >> 4 == pkw.READ and not self.deaf:
            self.asked.append((characters[3] & 0x07) << 8 | characters[4])
            words[:] = characters[3:7] + bytes((0, 0)) + characters[3:5]
            words[6] &= 0x07
        self._pkw = self._pkw[1:] + [words]
        net = bytearray(reply[3:-1])
        net[:8] = self._pkw[0]
        net[10:12] = bytes((self.hiw >> 8 & 0xFF, self.hiw & 0xFF))
        return framed(self.address, net)


def going(nodes, **more):
    """A bus in contact with everybody, whose link goes on by itself."""
    more.setdefault("foreseen", True)
    bench = Bench(nodes, idle_us=IDLE_US, goes_on=True, **more)
    bench.contact()
    bench.run(300_000)
    assert bench.went_on > 3
    return bench


def running(node, **more):
    bench = going([node], **more)
    bench.drives[1].start(0x2000)
    bench.run(300_000)
    assert node.stw == 0x047F, node.stw
    return bench


def next_stw(bench):
    """The control word of the telegram after the one that is on the line."""
    count = len(bench.sent)
    bench.run_until(lambda: len(bench.sent) > count)
    return bench.sent[-1].stw()


def begin_of_a_telegram(bench):
    count = len(bench.sent)
    bench.run_until(lambda: len(bench.sent) > count)


# --- how soon ------------------------------------------------------------------------------------


def test_the_next_telegram_leaves_when_the_reply_is_complete():
    for foreseen in (True, False):
        bench = going([Node(1), Node(2)], foreseen=foreseen)
        went_on = bench.went_on
        sent = len(bench.sent)
        bench.run(500_000)
        assert bench.went_on - went_on == len(bench.sent) - sent
        assert bench.addresses(-4) in ([1, 2, 1, 2], [2, 1, 2, 1])
        reply_us = 2 * bench.timing.telegram_us(12) + 3 * bench.timing.character_us
        for before, after in zip(bench.sent[-9:], bench.sent[-8:]):
            assert after.at - before.at - reply_us - IDLE_US in range(LATE_US)


def test_a_drive_with_a_status_word_of_its_own_goes_on_behind_another_drive():
    """Behind its own reply it does not: what that means is not known before it is translated."""
    for count, goes_on in ((2, True), (1, False)):
        nodes = [Node(address) for address in range(1, count + 1)]
        bench = Bench(nodes, idle_us=IDLE_US, goes_on=True, foreseen=True, listed=False)
        for node in nodes:
            layout = Layout(node.pkw_words, node.pzd_words)
            make = drive_maker(Pump)
            bench.drives[node.address] = bench.master.turns.add(node.address, layout, make)
        bench.contact()
        bench.run(500_000)
        assert (bench.went_on > 3) == goes_on, (count, bench.went_on)


def test_a_new_setpoint_is_in_the_next_telegram_but_one():
    bench = running(Node(1))
    went_on = bench.went_on
    begin_of_a_telegram(bench)
    bench.drives[1].hsw = 0x2345
    begin_of_a_telegram(bench)
    begin_of_a_telegram(bench)
    assert bench.sent[-1].characters[-3:-1] == b"\x23\x45"
    assert bench.went_on > went_on + 1


def test_a_drive_that_is_listed_twice_is_asked_twice():
    bench = going([Node(1), Node(2), Node(3)])
    drives = bench.drives
    bench.master.turns.arrange([drives[1], drives[2], drives[1], drives[3]])
    bench.run(2_000_000)
    lately = bench.addresses(-40)
    assert lately.count(1) == 20 and lately.count(2) == 10, lately


def goes_on_always(bench, us=300_000):
    """Whether each telegram leaves behind the reply before it, with nobody looking."""
    went_on, sent = bench.went_on, len(bench.sent)
    bench.run(us)
    return bench.went_on - went_on == len(bench.sent) - sent > 3


def test_what_one_drive_must_not_say_if_it_is_asked_again_others_may():
    """A drive that runs is asked twice in a row, then one that stands; that one tells a value."""
    bench = going([Telling(4), Telling(8)])
    drives = bench.drives
    bench.master.turns.arrange([drives[4], drives[4], drives[8]])
    drives[4].start(0x2000)
    bench.run(300_000)
    assert bench.nodes[4].stw == 0x047F and goes_on_always(bench)
    jobs = ask(bench, 8, (700, 1082, 5))
    bench.run(50_000)
    assert goes_on_always(bench)
    assert [job.integer_value() for job in jobs] == [700, 1082, 5]
    jobs = ask(bench, 4, (700, 1082, 5))
    bench.run(50_000)
    assert goes_on_always(bench)
    assert [job.integer_value() for job in jobs] == [700, 1082, 5]


def test_a_drive_that_was_stopped_goes_on_as_one_that_never_ran():
    bench = running(Telling(1))
    bench.drives[1].stop()
    bench.run(300_000)
    assert goes_on_always(bench)


def test_a_reply_as_soon_as_a_start_interval_allows_is_gone_on_from():
    """A link that sees well when a character came needs no more time than that."""
    for delay_us in (1_146, 1_719, 10_000):
        bench = Bench([Node(1, delay_us=delay_us)], idle_us=300, goes_on=True, foreseen=True)
        bench.contact()
        bench.run(300_000)
        assert goes_on_always(bench), delay_us


def test_a_witness_sees_each_reply_that_the_link_has_gone_on_from():
    bench = going([Node(1), Node(2)])
    master, character_us = bench.master, bench.timing.character_us
    witness = Witness(character_us, MASK, 2)
    master.witness = witness
    progress, sent = master.progress, len(bench.sent)
    assert goes_on_always(bench)
    assert abs(master.progress - progress - len(bench.sent) + sent) <= 1
    assert witness.finding == GOOD and witness.request_count == witness.reply_count == 16
    assert bytes(witness.reply)[:3] == b"\x02\x0e\x02" and bytes(witness.request)[2] == 2
    for place, least_us in ((RESPONSE_DELAY, 3 * character_us), (START_DELAY, IDLE_US)):
        shortest_us, longest_us = witness.times[place : place + 2]
        assert abs(shortest_us - least_us) < 2 * LATE_US, (place, shortest_us)
        assert abs(longest_us - least_us) < 2 * LATE_US, (place, longest_us)


def test_a_drive_that_falls_silent_is_waited_for_to_the_microsecond():
    """Behind a telegram that the link has sent by itself; also where the clock begins anew."""
    for foreseen in (True, False):
        for mask in (MASK, (1 << 20) - 1):
            bench = going([Node(1), Node(2), Node(3)], foreseen=foreseen, mask=mask)
            while mask != MASK and bench.now & mask < mask - 30_000:
                bench.run(10_000)
            bench.run_until(lambda: bench.sent[-1].address == 1)
            went_on = bench.went_on
            bench.nodes[2].plugged = False
            bench.run_until(lambda: bench.sent[-1].address == 3)
            assert bench.went_on == went_on + 1
            silent, behind = bench.sent[-2:]
            window_us = Receiver(bench.timing, mask).window_us
            assert behind.at - silent.at == bench.timing.telegram_us(12) + window_us


def test_the_engine_is_entered_once_for_each_telegram_if_its_end_is_foreseen():
    bench = going([Node(1), Node(2)])
    entries, sent = len(bench.entries), len(bench.sent)
    assert goes_on_always(bench, 500_000)
    assert len(bench.entries) - entries == len(bench.sent) - sent


def test_a_silent_drive_is_waited_for_and_the_others_go_on():
    nodes = [Node(1), Node(2), Node(3)]
    bench = going(nodes)
    nodes[1].plugged = False
    bench.run(3_000_000)
    assert not bench.drives[2].contact and bench.drives[1].contact and bench.drives[3].contact
    went_on = bench.went_on
    bench.run(1_000_000)
    assert bench.went_on > went_on


# --- what the link is told -----------------------------------------------------------------------


def told(bench):
    """What the link is told from now on, which does not send by itself: (the telegram on the line,
    the request, the size of its reply, the next telegram, not before)."""
    calls = []

    def prepare(request, size, buffer, count, after_us):
        call = bench.sent[-1], bytes(request[:size]), size, bytes(buffer[:count]), after_us
        calls.append(call)

    bench.prepare = prepare
    return calls


def test_the_link_is_told_what_to_send_behind_which_reply_and_how_soon_that_can_be_over():
    """After two characters of silence and the reply, less what rounding and the link may take."""
    bench = going([Node(1), Node(2, pkw_words=3, pzd_words=4), Node(3, pkw_words=0)])
    calls = told(bench)
    first = len(bench.sent)
    bench.run(300_000)
    assert len(calls) > 6
    sent = bench.sent[first:]
    for on_line, request, size, following, after_us in calls:
        characters = on_line.characters
        assert request == characters and size == len(characters)
        assert after_us == 1_146 - 2 - IDLE_US + size * 9_166 // 16
        behind = sent[sent.index(on_line) + 1 :] if on_line in sent else []
        if behind:
            assert following == behind[0].characters
    assert {size for _, _, size, _, _ in calls} == {8, 16, 18}


def test_nothing_is_made_ready_unless_the_loop_was_there_lately_enough_for_a_whole_exchange():
    bench = going([Node(1), Node(2)])
    begin_of_a_telegram(bench)
    calls = told(bench)
    left_us = DEAD_MAN_US - bench.master.turns.longest_exchange_us
    for passed_us, ready in ((0, True), (left_us, True), (left_us + 1, False)):
        calls.clear()
        bench.master.refresh(bench.now - passed_us, False)
        bench.master.poll(bench.now)
        assert bool(calls) == ready, passed_us
        assert not bench.master.is_overtaken(bench.now)
        bench.drives[1].stop()
        assert bench.master.is_overtaken(bench.now) == ready
        bench.master.turns.attention[ANY] = 0


def test_only_while_a_reply_is_awaited_is_anything_made_ready():
    for foreseen in (True, False):
        bench = going([Node(1), Node(2)], foreseen=foreseen)
        bench.nodes[2].plugged = False  # behind it nothing of a reply is left
        phases = set()
        bench.prepare = lambda *arguments: phases.add(bench.master.phase)
        for _ in range(100):
            bench.run(1_000)
            bench.due = bench.now  # the engine is entered in each phase
        assert phases == {AWAITING}


def test_while_a_telegram_goes_out_there_is_nothing_ready_that_a_call_could_overtake():
    """Neither behind a telegram that the link sent by itself nor behind an exception."""
    bench = going([Node(1), Node(2)], foreseen=False)
    for fails in (False, True):
        if fails:
            bench.run(200_000)
            begin_of_a_telegram(bench)
            bench.run(10_500)  # the reply is awaited
            bench.master.recover(bench.now)
            bench.due = bench.now
        begin_of_a_telegram(bench)
        assert bench.master.phase == SENDING
        bench.drives[1].stop()
        assert not bench.master.is_overtaken(bench.now)


def test_what_a_reply_must_not_say_depends_on_what_the_drive_was_asked_and_told():
    node = Telling(1)
    bench = going([node])
    drive, plan = bench.drives[1], bench.plan
    begin_of_a_telegram(bench)
    assert plan[plans.AK] == plan[plans.ZSW_AT] == 0
    drive.start(0x2000)
    bench.run(300_000)
    begin_of_a_telegram(bench)
    assert plan[plans.AK] == 0 and plan[plans.ZSW_AT] == 11
    assert plan[plans.ZSW] == RUNNING & pzd.ZSW_RUNNING and plan[plans.NEAR] == 0
    node.hiw = 0x2000
    bench.run(300_000)
    begin_of_a_telegram(bench)
    assert plan[plans.NEAR] == drive.near > 0  # it has arrived
    bench.nodes[1].deaf = True
    ask(bench, 1, (700,))
    bench.run(100_000)
    begin_of_a_telegram(bench)
    assert plan[plans.AK] == pkw.FITTING[pkw.READ] and plan[plans.ZSW_AT] == 11
    drive.stop()
    bench.run(100_000)
    begin_of_a_telegram(bench)
    assert plan[plans.ZSW_AT] == 0


def test_the_answer_to_each_task_must_fit_and_behind_no_task_there_must_be_none():
    """From the first telegram with a task on; before it any answer may come."""
    bench = going([Telling(1)])
    prepare, steps = bench.prepare, []

    def note(*arguments):
        step = bench.sent[-1].task(), bench.plan[plans.AK]
        if step not in steps[-1:]:
            steps.append(step)
        prepare(*arguments)

    bench.prepare = note
    ask(bench, 1, (700, 700))
    bench.run(200_000)
    asked = pkw.READ, pkw.FITTING[pkw.READ]
    none = 0, 1 << 0
    assert steps == [(0, 0), asked, none, asked, none, (0, 0)], steps


def test_a_link_has_nothing_to_send_behind_a_part_of_the_reply_or_a_stray_character():
    """What was made ready before is taken back."""
    reply = framed(1, bytes(8) + b"\xfb\x31\x00\x00")
    for first, second in ((reply[:7], reply[7:]), (b"\x55", reply)):
        bench = going([Node(1), Node(2)])
        bench.run_until(lambda bench=bench: bench.sent[-1].address == 2)
        bench.nodes[1].plugged = False  # the test answers in its place
        begin_of_a_telegram(bench)
        calls, entries, went_on = told(bench), len(bench.entries), bench.went_on
        begin = bench.sent[-1].at + bench.timing.telegram_us(12) + 1_719
        bench.talk(first, begin)
        bench.talk(second, begin + bench.timing.telegram_us(len(first) - 4) + 2_000)
        bench.run_until(lambda: len(bench.entries) > entries)
        assert calls == []
        good = bench.drives[1].counters[0]
        begin_of_a_telegram(bench)
        assert bench.drives[1].counters[0] == good + 1 and bench.went_on == went_on
        assert len(calls) == 1 and bench.sent[-1].address == 2


def test_the_status_word_is_looked_at_where_the_layout_has_it():
    for pkw_words, pzd_words, at in ((4, 2, 11), (3, 4, 9), (0, 2, 3), (4, 6, 11)):
        bench = running(Node(1, pkw_words=pkw_words, pzd_words=pzd_words))
        begin_of_a_telegram(bench)
        assert bench.plan[plans.ZSW_AT] == at, (pkw_words, pzd_words)


# --- what the reply says -------------------------------------------------------------------------


def test_a_telegram_that_is_to_be_repeated_goes_before_the_list_behind_a_stop():
    bench = going([Node(1), Node(2), Node(3)])
    bench.master.retries = 1
    bench.nodes[2].plugged = False
    bench.run_until(lambda: bench.sent[-1].address == 1)
    bench.run_until(lambda: bench.sent[-1].address == 2)
    count = len(bench.sent)
    bench.drives[1].stop()
    bench.run(150_000)
    assert bench.addresses(count)[:4] == [1, 2, 3, 1], bench.sent[count:]


def test_a_drive_that_trips_inhibits_or_stops_gets_no_second_telegram_with_on():
    for zsw in (RUNNING | FAULT, RUNNING | INHIBIT, READY):
        node = Node(1)
        bench = running(node)
        node.follows = False
        node.zsw = zsw
        begin_of_a_telegram(bench)  # its reply has that status word
        assert bench.sent[-1].stw() & 1
        assert not next_stw(bench) & 1, "%04X" % zsw
        assert bench.drives[1].stopped_by_engine()


def test_a_drive_that_is_in_trouble_already_gets_one_telegram_with_on():
    for zsw in (READY | FAULT, READY | INHIBIT):
        node = Node(1)
        bench = going([node])
        node.follows = False
        node.zsw = zsw
        bench.run(100_000)
        count = len(bench.sent)
        bench.drives[1].start(0x2000)
        bench.run(200_000)
        stws = bench.stws(1, count)
        assert sum([stw & 1 for stw in stws]) == 1, (zsw, stws)


def test_a_motor_that_stands_still_unordered_gets_no_second_telegram_with_on():
    node = Telling(1)
    bench = running(node)
    node.hiw = 0x2000
    bench.run(300_000)
    node.hiw = 0x0010
    begin_of_a_telegram(bench)
    assert not next_stw(bench) & 1


def test_a_motor_that_ramps_up_goes_on_at_once():
    node = Telling(1)
    bench = running(node)
    went_on, sent = bench.went_on, len(bench.sent)
    for hiw in range(0, 0x2000, 0x100):
        node.hiw = hiw
        begin_of_a_telegram(bench)
    assert bench.went_on - went_on == len(bench.sent) - sent
    assert bench.sent[-1].stw() & 1


def test_a_reply_that_is_spoilt_starts_nothing():
    """Each of its bits, in turn, is another one: there is no byte that is not checked."""
    request = framed(1, bytes(8) + b"\x04\x7f\x20\x00")
    reply = framed(1, bytes(8) + b"\xfb\x34\x20\x00")
    plan = plan_of(zsw=RUNNING)
    attention = bytearray(ATTENTION)
    assert judged(reply, request, plan, attention)
    for index in range(len(reply)):
        for bit in range(8):
            spoilt = bytearray(reply)
            spoilt[index] ^= 1 << bit
            assert not judged(spoilt, request, plan, attention), (index, bit)
    assert not judged(request, request, plan, attention), "an echo"


def judged(reply, *arguments):
    """What both twins say."""
    says = [
        bool(says_nothing_new(reply, len(reply), *arguments))
        for says_nothing_new in (python.says_nothing_new, going_on.says_nothing_new)
    ]
    assert says[0] == says[1], (reply, arguments)
    return says[0]


def plan_of(answers=0, zsw=None, near=0):
    plan = going_on.array("H", bytes(2 * plans.WORDS))
    plan[plans.AK] = answers
    if zsw is not None:
        plan[plans.ZSW_AT] = 11
        plan[plans.ZSW] = zsw & 0x4C
        plan[plans.NEAR] = near
    return plan


def test_each_bit_that_matters_is_looked_at_and_no_other():
    """The bits of motion, how near to 0 the speed is, which answers may come, and about what."""
    attention = bytearray(ATTENTION)
    asked = b"\x12\xbc\x80\x01"
    request = framed(1, asked + bytes(4) + b"\x04\x7f\x20\x00")

    def says_nothing(plan, answer=asked, zsw=RUNNING, hiw=0x2000):
        words = bytes((zsw >> 8, zsw & 0xFF, hiw >> 8 & 0xFF, hiw & 0xFF))
        return judged(framed(1, bytes(answer) + bytes(4) + words), request, plan, attention)

    for bit in range(16):
        zsw = RUNNING ^ 1 << bit
        assert says_nothing(plan_of(), zsw=zsw)
        assert says_nothing(plan_of(zsw=RUNNING), zsw=zsw) == (bit not in (2, 3, 6)), bit
    for hiw in (-0x8000, -164, -163, -1, 0, 1, 163, 164, 0x7FFF):
        assert says_nothing(plan_of(zsw=RUNNING), hiw=hiw)
        assert says_nothing(plan_of(zsw=RUNNING, near=326), hiw=hiw) == (abs(hiw) > 163), hiw
    for kind in range(16):
        for other in (False, True):
            answer = bytes((kind << 4 | 2, 0xBC, 0x80, 1 + other))
            assert says_nothing(plan_of(), answer)
            expected = kind == 0 or not other
            assert says_nothing(plan_of(1 << kind), answer) == expected, (kind, other)
            assert not says_nothing(plan_of(0xFFFF ^ 1 << kind), answer), kind
    for bit in range(32):
        answer = bytearray(asked)
        answer[bit >> 3] ^= 0x80 >> (bit & 7)
        expected = bit in (0, 1, 2, 3, 4)  # AK may be any; bit 11 is no part of PNU
        assert says_nothing(plan_of(0xFFFF), answer) == expected, bit
    attention[ANY] = 1
    assert not says_nothing(plan_of())


def test_both_twins_say_the_same_of_anything():
    seed = 20_261_126
    print("seed", seed)
    dice = random
    dice.seed(seed)
    agreed = 0
    for _ in range(3000):
        task = bytes((dice.getrandbits(8), dice.getrandbits(8), dice.getrandbits(8), 3))
        request = framed(1, task + bytes(4) + b"\x04\x7f\x20\x00")
        answer = bytearray(task + bytes(4))
        answer[0] = answer[0] & 0x0F | dice.getrandbits(2) << 4
        if not dice.getrandbits(2):
            answer[dice.getrandbits(2)] ^= 1 << dice.getrandbits(3)
        zsw = RUNNING ^ (1 << dice.getrandbits(3))
        hiw = bytes((dice.choice((0x00, 0x20, 0x7F, 0x80, 0xFF)), dice.getrandbits(8)))
        reply = framed(1, bytes(answer) + bytes((zsw >> 8, zsw & 0xFF)) + hiw)
        plan = plan_of(dice.getrandbits(4), RUNNING, dice.getrandbits(1) * 326)
        attention = bytearray(ATTENTION)
        attention[ANY] = not dice.getrandbits(3)
        agreed += judged(reply, request, plan, attention)
    assert 100 < agreed < 2000, agreed


def test_a_reply_behind_a_stray_character_or_before_another_one_starts_nothing():
    for more, at_us in ((b"\x55", -2_000), (b"\x55", 10_500)):
        bench = going([Node(1), Node(2)])
        begin_of_a_telegram(bench)
        sent = bench.sent[-1]
        bench.talk(more, sent.at + bench.timing.telegram_us(12) + 1_719 + at_us)
        bench.bursts.sort()
        count = len(bench.sent)
        bench.run_until(lambda: len(bench.sent) > count)
        quiet_us = bench.sent[-1].at - sent.at - 2 * bench.timing.telegram_us(12)
        assert quiet_us >= 1_719 + IDLE_US, (more, at_us, quiet_us)


def test_a_line_with_an_echo_takes_the_usual_way():
    bench = Bench([Node(1)], idle_us=IDLE_US, goes_on=True, foreseen=True, echo=True)
    bench.contact()
    bench.run(500_000)
    assert bench.master.has_echo() and bench.went_on == 0


def test_a_reply_that_comes_too_soon_starts_nothing():
    bench = Bench([Node(1, delay_us=100)], idle_us=300, goes_on=True, foreseen=True)
    bench.run(3_000_000)
    assert bench.went_on == 0


# --- parameters ----------------------------------------------------------------------------------


def ask(bench, address, numbers):
    jobs = [pkw.read(number) for number in numbers]
    for job in jobs:
        bench.drives[address].ask(job)
    return jobs


def test_the_next_task_follows_the_answer_at_once():
    node = Telling(1)
    bench = going([node])
    went_on, sent = bench.went_on, len(bench.sent)
    jobs = ask(bench, 1, range(700, 708))
    bench.run(500_000)
    assert [job.integer_value() for job in jobs] == list(range(700, 708))
    assert node.asked == list(range(700, 708))
    # The first one could not be foreseen, nor the one to the drive when the first was made ready.
    assert len(bench.sent) - sent - (bench.went_on - went_on) <= 2


def test_whoever_follows_change_reports_or_no_longer_does_is_asked_as_before():
    """While they are followed a reply is looked at first: it may hold a report."""
    node = Telling(1)
    bench = running(node)
    reports = Reports(bench.drives[1].channel)
    bench.run(100_000)
    went_on = bench.went_on
    bench.run(200_000)
    assert bench.went_on == went_on
    reports.close()
    jobs = ask(bench, 1, (700, 5))
    bench.run(300_000)
    assert [job.integer_value() for job in jobs] == [700, 5]
    assert bench.went_on > went_on + 3 and node.stw == 0x047F


def test_a_question_that_comes_while_there_is_time_is_in_the_next_telegram():
    bench = going([Telling(1)])
    begin_of_a_telegram(bench)
    bench.run(10_500)
    jobs = ask(bench, 1, (700, 5))
    bench.due = bench.now  # the engine is entered, as a call has overtaken what was ready
    went_on, sent = bench.went_on, len(bench.sent)
    bench.run(150_000)
    assert [job.state for job in jobs] == [pkw.DONE, pkw.DONE]
    assert [telegram.task() for telegram in bench.sent[sent:]][:3] == [1, 1, 0]
    assert bench.went_on - went_on == len(bench.sent) - sent


def test_the_same_question_twice_has_no_task_between():
    node = Telling(1)
    bench = going([node])
    jobs = ask(bench, 1, (700, 700))
    count = len(bench.sent)
    bench.run(300_000)
    assert [job.state for job in jobs] == [pkw.DONE, pkw.DONE]
    tasks = [telegram.task() for telegram in bench.sent[count:]]
    first = tasks.index(1)
    assert tasks[first : first + 4] == [1, 0, 1, 0], tasks


def test_a_drive_that_lags_says_that_there_is_no_task_before_the_same_question():
    bench = going([Telling(1, lag=1)])
    jobs = ask(bench, 1, (700, 700))
    count = len(bench.sent)
    bench.run(400_000)
    assert [job.state for job in jobs] == [pkw.DONE, pkw.DONE]
    tasks = [telegram.task() for telegram in bench.sent[count:]]
    first = tasks.index(1)
    assert tasks[first : first + 8] == [1, 1, 0, 0, 1, 1, 0, 0], tasks


def test_a_drive_that_lags_or_is_deaf_is_asked_as_before():
    for lag in range(4):
        bench = going([Telling(1, lag=lag), Telling(2)])
        jobs = ask(bench, 1, (700, 1082, 2000 - 1)) + ask(bench, 2, (5, 6))
        bench.run(1_500_000)
        assert [job.state for job in jobs] == [pkw.DONE] * 5, (lag, jobs)
        assert [job.integer_value() for job in jobs] == [700, 1082, 1999, 5, 6]
    bench = going([Telling(1, deaf=True)])
    jobs = ask(bench, 1, (700,))
    bench.run(3_000_000)
    assert jobs[0].state == pkw.TIMED_OUT


def test_random_questions_commands_and_silences():
    """Every question is answered rightly, every command goes out, and no ON after a stop."""
    for seed in range(12):
        print("seed", seed)
        random.seed(seed)
        nodes = [Telling(each, lag=random.getrandbits(1)) for each in (1, 2, 3)]
        bench = going(nodes, foreseen=seed & 1 == 0)
        waiting = []
        for _ in range(150):
            address = 1 + random.getrandbits(8) % 3
            drive, node = bench.drives[address], nodes[address - 1]
            what = random.getrandbits(3)
            if what < 3 and not drive.channel.is_full():
                number = random.getrandbits(10)
                waiting.append((number, ask(bench, address, (number,))[0]))
            elif what == 3:
                drive.start(0x1000 | random.getrandbits(10))
            elif what == 4:
                others = max([other.urgency() for other in bench.drives.values()])
                ran = drive.is_on() and others < 3  # nobody else must be stopped as well
                drive.stop()
                count = len(bench.sent)
                bench.run_until(lambda: len(bench.sent) > count)
                next_one = bench.sent[-1]
                assert not ran or next_one.address == address and not next_one.stw() & 1
            elif what == 5:
                drive.hsw = 0x1000 | random.getrandbits(10)
            elif what == 6:
                node.plugged = not node.plugged or random.getrandbits(1) == 0
            bench.run(random.getrandbits(15))
        for node in nodes:
            node.plugged = True
        bench.run(6_000_000)
        for number, job in waiting:
            done = job.state == pkw.DONE and job.integer_value() == number
            assert done or job.state in (pkw.TIMED_OUT, pkw.UNANSWERED), (number, job)
        assert sum([job.state == pkw.DONE for _, job in waiting]) > len(waiting) // 2


# --- what the program does meanwhile -------------------------------------------------------------


def at_every_instant(prepare, change, check, step_us=500):
    """Do the change at each instant of an exchange, in a bus of its own each time."""
    bench = prepare()
    began = bench.now
    count = len(bench.sent)
    bench.run_until(lambda: len(bench.sent) > count + 1)
    for after_us in range(0, bench.now - began, step_us):
        bench = prepare()
        bench.run(after_us)
        change(bench)
        check(bench)


def test_a_stop_is_in_the_next_telegram_whenever_it_comes():
    def check(bench):
        count = len(bench.sent)
        bench.run_until(lambda: len(bench.sent) > count)
        assert bench.sent[-1].address == 1 and not bench.sent[-1].stw() & 1

    def prepare():
        bench = going([Node(1), Node(2)])
        bench.drives[1].start(0x2000)
        bench.run(300_000)
        return bench

    at_every_instant(prepare, lambda bench: bench.drives[1].stop(), check)

    def stop_and_enter(bench):
        bench.drives[1].stop()
        bench.due = bench.now  # the engine is entered once more before the reply is there

    at_every_instant(prepare, stop_and_enter, check)


def test_a_drive_that_is_removed_moved_or_divided_anew_gets_no_old_telegram():
    def prepare():
        return going([Node(1), Node(2)])

    def remove(bench):
        bench.master.turns.remove(bench.drives[2])

    def nothing_to_2(bench):
        count = len(bench.sent)
        bench.run(200_000)
        assert 2 not in bench.addresses(count), bench.sent[count:]

    at_every_instant(prepare, remove, nothing_to_2)

    def move(bench):
        bench.nodes[7] = bench.nodes.pop(2)
        bench.nodes[7].address = 7
        bench.master.turns.readdress(bench.drives[2], 7)

    def move_check(bench):
        nothing_to_2(bench)
        assert bench.drives[2].contact

    at_every_instant(prepare, move, move_check)

    def divide(bench):
        node = bench.nodes[2]
        node.plugged = False
        bench.run_until(lambda: not bench.drives[2].contact)
        node.plugged = True
        node.pkw_words = 3
        bench.master.turns.relayout(bench.drives[2], Layout(3, 2))

    def divide_check(bench):
        count = len(bench.sent)
        bench.run(200_000)
        lengths = {len(sent.characters) for sent in bench.sent[count:] if sent.address == 2}
        assert lengths == {14}, lengths

    at_every_instant(prepare, divide, divide_check, 4_000)


def test_a_drive_that_is_divided_anew_when_the_link_has_gone_on_has_missed_its_telegram():
    """Its reply is in, but the engine has not looked at it."""
    bench = going([Node(1), Node(2)])
    drive, node = bench.drives[2], bench.nodes[2]
    drive.doubt()
    send = bench.send
    good, missed = drive.counters[0], sum(drive.counters[1:])

    def divide(buffer, count):
        send(buffer, count)
        if buffer[2] == 1 and bench.master.is_under_way(drive):
            bench.send = send
            node.pkw_words = 3
            bench.master.turns.relayout(drive, Layout(3, 2), True)

    bench.run_until(lambda: bench.sent[-1].address == 1)
    bench.run_until(lambda: bench.sent[-1].address == 2)
    good = drive.counters[0]
    bench.send = divide
    bench.run_until(lambda: bench.sent[-1].address == 1)
    bench.run(1_000)
    assert drive.layout.pkw_words == 3 and not drive.contact
    assert drive.counters[0] == good and sum(drive.counters[1:]) == missed + 1
    bench.run(200_000)
    assert drive.contact and drive.zsw == READY and sum(drive.counters[1:]) == missed + 1


def test_a_call_overtakes_what_is_ready_if_there_is_time_to_make_another_ready():
    """Up to a millisecond and a half before the reply can be there; see `hal.pacer`."""
    for foreseen in (True, False):
        bench = going([Node(1), Node(2)], foreseen=foreseen)
        begin_of_a_telegram(bench)
        master, timing = bench.master, bench.timing
        bench.run(10_500)  # the reply is awaited
        assert not master.is_overtaken(bench.now)
        bench.drives[2].stop()
        assert master.is_overtaken(bench.now)
        last_at = bench.sent[-1].at + timing.telegram_us(12) + timing.start_interval_us
        last_at += 16 * timing.character_us
        assert master.is_overtaken(last_at - 1_501)
        assert not master.is_overtaken(last_at - 1_500)
    bench = Bench([Node(1)], idle_us=IDLE_US, goes_on=True, foreseen=True, echo=True)
    bench.contact()
    begin_of_a_telegram(bench)
    bench.drives[1].stop()
    assert not bench.master.is_overtaken(bench.now)  # nothing is made ready on such a line


def test_a_telegram_outside_the_list_is_the_next_but_one_at_the_latest():
    bench = going([Node(1), Node(2)])
    begin_of_a_telegram(bench)
    mirror = Mirror(2, bytes(range(12)))
    bench.master.turns.post(mirror)
    begin_of_a_telegram(bench)
    begin_of_a_telegram(bench)
    assert 2 | 0x40 in bench.addresses(-2)
    bench.run(200_000)
    assert mirror.state == pkw.DONE


def test_a_dead_loop_stops_the_motor_in_time():
    node = Node(1)
    bench = running(node)
    bench.refreshing = False
    since = bench.now
    bench.run_until(lambda: not node.stw & 1)
    assert bench.now - since < 400_000, bench.now - since


def test_at_a_rate_at_which_an_exchange_outlasts_the_dead_man_nothing_is_made_ready():
    bench = Bench([Node(1)], baud=300, idle_us=106_667, goes_on=True, foreseen=True)
    bench.run(5_000_000)
    assert bench.drives[1].contact and bench.went_on == 0


def test_a_pause_begins_after_the_telegram_that_was_ready():
    bench = going([Node(1), Node(2)])
    begin_of_a_telegram(bench)
    bench.master.pause()
    count = len(bench.sent)
    bench.run(100_000)
    assert bench.master.paused and len(bench.sent) - count <= 1
    bench.master.resume()
    bench.run(100_000)
    assert len(bench.sent) - count > 2


def test_a_pause_that_the_engine_sees_before_the_reply_begins_behind_that():
    bench = going([Node(1), Node(2)])
    begin_of_a_telegram(bench)
    bench.run(5_000)
    count, good = len(bench.sent), sum(drive.counters[0] for drive in bench.drives.values())
    bench.master.pause()
    bench.due = bench.now  # the engine is entered, and takes back what was ready
    bench.run(100_000)
    assert bench.master.paused and len(bench.sent) == count
    assert sum(drive.counters[0] for drive in bench.drives.values()) == good + 1


def test_close_tells_every_drive_to_stop():
    nodes = [Node(1), Node(2)]
    bench = going(nodes)
    for drive in bench.drives.values():
        drive.start(0x2000)
    bench.run(300_000)
    bench.master.close()
    bench.run(500_000)
    assert [node.stw & 1 for node in nodes] == [0, 0]
    count = len(bench.sent)
    bench.run(200_000)
    assert len(bench.sent) == count


def test_an_exception_in_the_engine_takes_on_back_though_the_link_has_gone_on():
    node = Node(1)
    bench = running(node)
    drive = bench.drives[1]
    take = drive.take
    failed = []

    def fail(buffer, count, now):
        if not failed:
            failed.append(now)
            raise ValueError("once")
        take(buffer, count, now)

    drive.take = fail
    went_on = bench.went_on
    try:
        bench.run(100_000)
    except ValueError:
        bench.master.recover(bench.now)
        bench.due = bench.now
    assert failed and bench.went_on > went_on
    count = len(bench.sent)
    bench.run(300_000)
    assert bench.sent[count].stw() == pzd.OFF1 and not node.stw & 1
    assert bench.master.foreign == 0


def test_after_an_exception_what_was_made_ready_is_taken_back_before_anything_else():
    """The reply may come at any time: nobody would know of a telegram that follows it then."""
    bench = running(Node(1))
    told = []

    def tell(name):
        act = getattr(bench, name)

        def tells():
            told.append(name)
            return act()

        setattr(bench, name, tells)

    for name in ("follow", "take_back"):
        tell(name)
    bench.drives[1].revoke = lambda: told.append("revoke")
    bench.master.recover(bench.now)
    assert told == ["take_back", "follow", "revoke"]


def test_behind_an_exception_the_link_sends_nothing_by_itself():
    """Not even if the engine is entered only when the reply is there."""
    node = Node(1)
    bench = running(node)
    begin_of_a_telegram(bench)
    went_on, sent = bench.went_on, len(bench.sent)
    bench.master.recover(bench.now)
    bench.run(20_000)
    assert bench.went_on == went_on and len(bench.sent) == sent
    assert next_stw(bench) == pzd.OFF1


def test_a_telegram_that_the_link_sent_by_itself_is_given_up_50_ms_after_it_should_have_left():
    bench = going([Node(1), Node(2)], foreseen=False)
    went_on, poll, waits = bench.went_on, bench.master.poll, []
    bench.master.poll = lambda now: waits.append(poll(now)) or waits[-1]
    bench.run_until(lambda: bench.went_on > went_on)
    begun, sent = bench.sent[-1].at, len(bench.sent)
    window_us = Receiver(bench.timing, MASK).window_us
    assert waits[-1] == bench.timing.telegram_us(12) + window_us  # else when the reply is late
    bench.sending_us = lambda now: 1
    drive = bench.drives[bench.sent[-1].address]
    last_us = 16 * bench.timing.character_us + 50_000
    for passed_us, given_up in ((9_000, 0), (last_us, 0), (last_us + 1, 1)):
        bench.now = begun + passed_us
        bench.master.poll(bench.now)
        assert drive.silent == given_up and len(bench.sent) == sent + given_up, passed_us


def test_an_exception_gives_nobody_a_second_turn():
    """The drive that the link has gone on to has had its own, and what comes is its reply."""

    def before_the_engine_looks(bench):
        take_back = bench.take_back
        went_on = bench.went_on

        def fail():
            take_back()
            if bench.went_on > went_on:
                bench.take_back = take_back
                raise KeyboardInterrupt

        bench.take_back = fail

    def while_it_takes_the_reply(bench):
        drive = bench.drives[bench.sent[-1].address]
        take = drive.take

        def fail(buffer, count, now):
            drive.take = take
            raise KeyboardInterrupt

        drive.take = fail

    for strikes in (before_the_engine_looks, while_it_takes_the_reply):
        bench = going([Node(address) for address in (1, 2, 3, 4)])
        begin_of_a_telegram(bench)
        address = bench.sent[-1].address
        strikes(bench)
        try:
            bench.run(200_000)
        except KeyboardInterrupt:
            bench.master.recover(bench.now)
            bench.due = bench.now
        else:
            raise AssertionError("it did not fail")
        assert bench.sent[-1].address == address % 4 + 1
        count = len(bench.sent)
        bench.run(300_000)
        assert bench.addresses(count)[:5] == [(address + step) % 4 + 1 for step in range(1, 6)]
        assert bench.master.foreign == 0
