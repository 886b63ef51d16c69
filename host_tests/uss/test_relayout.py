# SPDX-License-Identifier: MIT
"""A drive of the bus that does not answer gets another layout, whatever the engine is doing then.

No telegram is half old and half new, STOP stays owed, nothing starts, the others lose nothing.
"""

from test_turns import Table

from boards.sim.drives.families import generic
from fleet_bench import Fleet
from round_bench import MASK, RUNNING, Bench, Node, exclusive_or, framed
from uss import pkw, pzd
from uss.layout import STANDARD, VARIABLE, Layout
from uss.receiver import OTHER_LENGTH
from uss.tasks.change_reports import Reports
from uss.timing import Timing
from uss.turns import Turns

OLD = STANDARD
LAYOUTS = (Layout(3, 2), Layout(0, 2), Layout(VARIABLE, 2), Layout(4, 8), Layout(3, 0))
LOST = 2


class Short(Node):
    """With a variable length it answers in three PKW words. bit: bit 11 of PKE."""

    bit = 0

    def answer(self, characters):
        reply = Node.answer(self, characters)
        if reply and reply[2] == self.address and (self.pkw_words == VARIABLE or self.bit):
            net = bytearray(reply[3:-1][-2 * (self.pzd_words + 3) :])
            net[0] = self.bit
            reply = framed(self.address, net)
        return reply


def standing(layout, **more):
    """Drive 2 is in the list as 4 + 2 words, and set to another layout."""
    bench = Bench([Node(1), Short(LOST), Node(3)], **more)
    node = bench.nodes[LOST]
    node.pkw_words, node.pzd_words = layout.pkw_words, layout.pzd_words
    bench.run_until(lambda: bench.drives[1].contact and bench.drives[3].contact)
    return bench


def bench_of(layout, **more):
    """The same, and drive 1 runs."""
    bench = standing(layout, **more)
    bench.drives[1].start(0x1000)
    bench.run(200_000)
    return bench


def relayout(bench, layout):
    bench.master.turns.relayout(bench.drives[LOST], layout)


def refused(bench, layout, address=LOST, doubted=False):
    try:
        bench.master.turns.relayout(bench.drives[address], layout, doubted)
    except ValueError as reason:
        return str(reason)
    raise AssertionError("it was not refused")


def is_whole(telegram, layout):
    """Whether this is a telegram of the layout that has no task and says OFF1."""
    characters = telegram.characters
    net = bytearray(layout.net_count)
    if layout.pzd_words:
        net[layout.net_count - layout.pzd_count] = pzd.OFF1 >> 8
        net[layout.net_count - layout.pzd_count + 1] = pzd.OFF1 & 0xFF
    return (
        characters[:3] == bytes((2, layout.net_count + 2, LOST))
        and characters[3:-1] == net
        and exclusive_or(characters) == 0
    )


def check_wire(bench, layout, since):
    """The telegrams to it are whole: some of the old layout, then only such of the new one."""
    changed = False
    for telegram in bench.sent[since:]:
        if telegram.address == LOST:
            changed = changed or not is_whole(telegram, OLD)
            assert not changed or is_whole(telegram, layout), telegram
    assert changed
    assert bench.nodes[1].zsw == RUNNING and not any(bench.drives[1].counters[1:])
    assert not any(bench.drives[3].counters[1:]) and bench.master.foreign == 0


# --- what it does -------------------------------------------------------------------------------


def test_a_drive_that_did_not_answer_does():
    for layout in LAYOUTS:
        bench = bench_of(layout)
        bench.run(3_000_000)
        assert not bench.drives[LOST].contact
        sent = len(bench.sent)
        relayout(bench, layout)
        assert bench.drives[LOST].layout is layout
        bench.run(200_000)
        assert bench.drives[LOST].contact, layout
        check_wire(bench, layout, sent)


def test_it_runs_and_stops_and_is_asked_for_parameters_in_its_new_layout():
    for layout in LAYOUTS[:4]:
        bench = bench_of(layout)
        relayout(bench, layout)
        bench.run(3_000_000)
        drive, node = bench.drives[LOST], bench.nodes[LOST]
        drive.start(0x1234)
        bench.run(200_000)
        assert drive.is_on() and node.zsw == RUNNING
        job = pkw.read(700)
        if layout.pkw_words:
            drive.ask(job)
        bench.run(200_000)
        assert not layout.pkw_words or bench.sent[-2].characters[3] >> 4 or job.tries
        drive.stop()
        bench.run(200_000)
        assert node.stw == pzd.OFF1 and node.zsw != RUNNING


def test_what_follows_from_the_list_follows():
    bench = bench_of(STANDARD)
    turns, drive = bench.master.turns, bench.drives[LOST]
    bench.nodes[LOST].plugged = False
    bench.run(3_000_000)
    exchange_us, cycle_us = turns.longest_exchange_us, turns.longest_cycle_us()
    silent_us = bench.master.deadlines.silence.silent_exchange_us
    relayout(bench, Layout(4, 16))
    more_us = bench.timing.telegram_us(40) - bench.timing.telegram_us(12)
    assert turns.longest_cycle_us() > cycle_us + 2 * more_us
    assert turns.longest_exchange_us > exchange_us + 2 * more_us
    assert bench.master.deadlines.silence.silent_exchange_us == silent_us + more_us
    relayout(bench, Layout(4, 2))
    assert turns.longest_exchange_us == exchange_us and turns.longest_cycle_us() == cycle_us
    assert turns.list == [bench.drives[1], drive, bench.drives[3]]
    relayout(bench, drive.layout)


def test_only_a_drive_without_contact():
    """One that may be running hears its STOP in the new layout."""
    bench = Bench([Node(1), Node(2), Node(3)])
    bench.contact()
    assert "contact" in refused(bench, Layout(3, 2))
    bench.drives[LOST].start(0x1000)
    bench.run(100_000)
    bench.nodes[LOST].plugged = False
    bench.run(2_000_000)
    assert not bench.drives[LOST].contact and bench.drives[LOST].may_run()
    relayout(bench, Layout(3, 2))
    sent = len(bench.sent)
    bench.drives[LOST].stop()
    bench.run(100_000)
    assert bench.sent[sent].address == LOST and is_whole(bench.sent[sent], Layout(3, 2))
    assert pzd.ON not in bench.stws(LOST, sent)
    bench.master.turns.remove(bench.drives[3])
    assert "not on this bus" in refused(bench, Layout(3, 2), 3)


def test_a_doubted_drive_that_stands_may_be_in_contact_and_has_none_in_the_new_layout_yet():
    bench = Bench([Node(1), Node(LOST), Node(3)])
    bench.contact()
    turns, drive, layout = bench.master.turns, bench.drives[LOST], Layout(3, 2)
    drive.doubted, contacts = True, drive.contacts
    drive.start(0x1000)
    bench.run(100_000)
    assert "contact" in refused(bench, layout, doubted=True) and drive.is_on()
    drive.stop()
    bench.run(100_000)
    turns.relayout(drive, layout, True)
    assert drive.layout is layout and not drive.doubted and not drive.contact
    bench.nodes[LOST].pkw_words = layout.pkw_words
    bench.run(100_000)
    assert drive.contact and drive.contacts == contacts + 1


def test_one_that_answers_at_the_last_moment_keeps_its_layout_and_its_turns():
    def answer(drive):
        reply = framed(drive.address, bytes(8) + b"\xfb\x31\x00\x00")
        drive.take(reply, len(reply), 0)

    turns = Turns(Timing(19200), MASK, 1_000_000, lambda drive: True, answer)
    drives = [turns.add(address) for address in (1, LOST, 3)]
    try:
        turns.relayout(drives[1], Layout(3, 2))
    except ValueError as reason:
        assert "contact" in str(reason)
    assert drives[1].contact and drives[1].layout is STANDARD
    assert [turns.choose(0) for _ in drives] == drives
    drives[1].stop()
    assert turns.choose(0) is drives[1]


# --- what it loses, and what not ----------------------------------------------------------------


def test_a_stop_that_is_owed_goes_out_in_the_new_layout_before_all_else():
    for layout in LAYOUTS[:4]:
        bench = bench_of(layout)
        bench.run(3_000_000)
        drive = bench.drives[LOST]
        bench.run_until(lambda: bench.sent[-1].address == 1)
        drive.stop()
        stops = drive.stops
        sent = len(bench.sent)
        relayout(bench, layout)
        assert drive.stops == stops != drive.stops_sent
        bench.run(100_000)
        assert bench.sent[sent].address == LOST and is_whole(bench.sent[sent], layout)
        assert drive.stops_sent == stops and drive.answered_off()


def test_a_stop_that_nobody_has_answered_is_repeated_in_the_new_layout():
    bench = bench_of(Layout(3, 2))
    bench.run(3_000_000)
    bench.drives[LOST].stop()
    bench.run_until(lambda: bench.sent[-1].address == LOST)
    sent = len(bench.sent)
    assert is_whole(bench.sent[-1], OLD)
    relayout(bench, Layout(3, 2))
    bench.run(100_000)
    told = [telegram for telegram in bench.sent[sent:] if telegram.address == LOST]
    assert is_whole(told[0], Layout(3, 2)) and bench.drives[LOST].answered_off()


def test_a_start_that_was_wanted_is_void():
    bench = bench_of(Layout(3, 2))
    bench.run(3_000_000)
    drive = bench.drives[LOST]
    drive.start(0x1000)
    ticket = drive.ticket
    relayout(bench, Layout(3, 2))
    drive.start(0x1000)
    bench.run(3_000_000)
    assert drive.contact and drive.stopped_by_engine() and drive.ticket == ticket + 1
    assert set(bench.stws(LOST)) == {pzd.OFF1} and bench.nodes[LOST].zsw != RUNNING
    drive.start(0x1000)
    bench.run(100_000)
    assert drive.is_on()


def test_counters_go_on_and_an_exchange_under_way_is_a_miss():
    """Also where the answer is one of the old layout, or one of the new."""
    for layout in (Layout(4, 2), Layout(VARIABLE, 2)):
        for echo in (False, True):
            bench = bench_of(layout, echo=echo)
            node, drive = bench.nodes[LOST], bench.drives[LOST]
            node.plugged = False
            bench.run(3_000_000)
            bench.run_until(lambda: bench.sent[-1].address == LOST)
            bench.run(100_000)
            node.plugged = True
            counters = list(drive.counters)
            bench.run_until(lambda: bench.sent[-1].address == LOST)
            relayout(bench, Layout(VARIABLE, 2))
            node.plugged = False
            bench.run(60_000)
            assert not drive.contact and sum(drive.counters) > sum(counters)
            assert drive.counters[0] == counters[0] and drive.counters[2] == counters[2] + 1
            assert drive.trouble == OTHER_LENGTH or drive.silent > 3


def test_an_exception_behind_it_makes_the_exchange_under_way_a_miss_as_well():
    """And the reply that may still come has the length that the request had."""
    bench = bench_of(Layout(4, 8))
    drive = bench.drives[LOST]
    bench.run_until(lambda: bench.sent[-1].address == LOST)
    missed, count = sum(drive.counters[1:]), len(bench.sent)
    relayout(bench, Layout(0, 2))
    began = bench.now
    bench.master.recover(bench.now)
    bench.due = bench.now
    assert sum(drive.counters[1:]) == missed + 1
    bench.run_until(lambda: len(bench.sent) > count)
    assert bench.now - began >= bench.timing.reply_timeout_us + bench.timing.telegram_us(12 + 16)


def test_an_answer_that_equals_the_request_is_no_echo_for_that():
    """Without PZD words it may, and the link cannot tell how long the pause before it was."""
    bench = Bench([Node(1), Node(LOST, 4, 0, 1_000)], idle_us=800)
    node, drive = bench.nodes[LOST], bench.drives[LOST]
    node.plugged = False
    bench.run(3_000_000)
    node.plugged = True
    length_errors = drive.counters[2]
    sent = len(bench.sent)
    bench.run_until(lambda: LOST in bench.addresses(sent))
    relayout(bench, Layout(3, 0))
    bench.run(60_000)
    assert drive.counters[2] == length_errors + 1 and not drive.contact
    assert not bench.master.has_echo()


class Talkative(Node):
    """It has something to say in its last two PZD words."""

    def answer(self, characters):
        reply = Node.answer(self, characters)
        return reply and framed(reply[2], reply[3:-5] + b"\x55\x55\x77\x77")


def test_further_words_that_both_layouts_have_are_kept():
    """And no word that the drive has said is said to it."""
    bench = Bench([Node(1), Talkative(LOST, 4, 4)])
    node, drive = bench.nodes[LOST], bench.drives[LOST]
    bench.contact()
    drive.put(3, 0x1111)
    drive.put(4, 0x2222)
    bench.run(200_000)
    assert drive.word(4) == 0x7777
    node.plugged = False
    bench.run_until(lambda: not drive.contact)
    node.plugged, node.pkw_words, node.pzd_words = True, 3, 6
    relayout(bench, Layout(3, 6))
    drive.put(6, 0x6666)
    bench.run(1_000_000)
    assert drive.contact and (drive.word(4), drive.word(6)) == (0, 0x7777)
    sent = [telegram for telegram in bench.sent if telegram.address == LOST][-1]
    assert sent.characters[13:-1] == b"\x11\x11\x22\x22\x00\x00\x66\x66"


def test_parameter_jobs_come_to_an_end_and_new_ones_are_sent():
    bench = bench_of(Layout(3, 2))
    drive = bench.drives[LOST]
    jobs = [pkw.read(700 + index) for index in range(8)]
    for job in jobs:
        drive.ask(job)
    bench.run(500_000)
    relayout(bench, Layout(3, 2))
    assert [job.state for job in jobs] == [pkw.TIMED_OUT] * 8
    drive.ask(jobs[0])
    bench.run(1_000_000)
    assert drive.contact and jobs[0].state == pkw.PENDING
    tasks = [each.task() for each in bench.sent if each.address == LOST and is_short(each)]
    assert tasks[0] == 0 and tasks[-1] == 1  # the answer to an old one may still come


def is_short(telegram):
    return len(telegram.characters) == 14


def test_change_reports_are_followed_on():
    bench = bench_of(Layout(3, 2))
    reports = Reports(bench.drives[LOST].channel)
    relayout(bench, Layout(3, 2))
    bench.run(1_000_000)
    assert bench.drives[LOST].contact
    bench.nodes[LOST].bit = 8
    bench.run(200_000)
    assert [each.characters[3] for each in bench.sent if each.address == LOST][-1] == 8
    reports.close()
    bench.run(200_000)
    assert [each.characters[3] for each in bench.sent if each.address == LOST][-1] == 0
    bench.nodes[LOST].plugged = False
    bench.run(2_000_000)
    relayout(bench, Layout(0, 2))
    reports.close()


def test_a_drive_that_is_to_be_asked_again_is_asked_in_its_new_layout():
    bench = bench_of(Layout(VARIABLE, 2))
    bench.master.retries = 1_000
    bench.run(3_000_000)
    for later_us in range(0, 60_000, 500):
        sent = len(bench.sent)
        bench.run_until(lambda: LOST in bench.addresses(sent))
        bench.run_to(bench.sent[-1].at + later_us)
        sent = len(bench.sent)
        relayout(bench, Layout(4, 4))
        bench.run(60_000)
        check_form(bench, sent, 20)
        relayout(bench, Layout(4, 2))
        bench.run(60_000)


def check_form(bench, since, size):
    for telegram in bench.sent[since:]:
        assert telegram.address != LOST or len(telegram.characters) == size, telegram


def test_twice_in_one_exchange():
    """Before the engine has come to it, and after; the first telegram is long, the line slow."""
    for between_us in (0, 3_000):
        bench = Bench([Node(1), Node(LOST, 3, 2)], baud=1200, echo=True)
        turns = bench.master.turns
        turns.remove(bench.drives[LOST])
        drive = bench.drives[LOST] = turns.add(LOST, Layout(4, 16))
        bench.run_until(lambda: bench.sent and bench.sent[-1].address == LOST)
        bench.run(1_000)
        long = bench.sent[-1]
        for layout in (Layout(4, 4), Layout(3, 2)):
            turns.relayout(drive, layout)
            bench.run(between_us)
        sent = len(bench.sent)
        bench.run_until(lambda: len(bench.sent) > sent)
        waited_us = bench.sent[sent].at - long.at
        assert waited_us > bench.timing.telegram_us(40) + bench.timing.reply_timeout_us
        bench.run(1_000_000)
        assert drive.contact and drive.silent == 0
        assert drive.counters[5] == 1 == sum(drive.counters) - drive.counters[0]  # no reply


# --- whose turn it is ---------------------------------------------------------------------------


def test_the_others_keep_their_places_in_the_round():
    for passed in range(1, 9):
        table = Table(1, 2, 3)
        one, two, three = table.turns.drives
        table.turns.arrange((one, two, one, three))
        table.silent.add(2)
        before = table.asked(passed)
        table.turns.relayout(two, Layout(3, 2))
        asked = before + table.asked(12)
        assert "".join([str(each) for each in asked if each != 2]).startswith("1131131"), asked


def test_in_a_list_of_its_own():
    bench = Bench([Node(LOST)])
    bench.nodes[LOST].pkw_words = 3
    bench.run(1_000_000)
    relayout(bench, Layout(3, 2))
    bench.run(100_000)
    assert bench.drives[LOST].contact


# --- at every instant ---------------------------------------------------------------------------


def test_at_every_instant_of_an_exchange():
    """And of the one after it: on a link that foresees its last stop bit, and on one that does
    not, or has to be looked at. With a stop that is owed, and without."""
    step = 0
    for more in ({}, {"foreseen": True}, {"interrupts": False}, {"echo": True, "idle_us": 800}):
        for later_us in range(0, 90_000, 370):
            layout = LAYOUTS[step % 4]
            bench = bench_of(layout, **more)
            drive = bench.drives[LOST]
            drive.ask_soon()
            bench.run(later_us)
            if step & 1:
                drive.stop()
            sent = len(bench.sent)
            relayout(bench, layout)
            bench.run(250_000)
            assert drive.contact and drive.answered_off(), (more, later_us, layout)
            assert drive.stops == drive.stops_sent == step & 1
            check_form(bench, sent, layout.net_count + 4)
            check_wire(bench, layout, 0)
            step += 1


def test_the_engine_takes_no_memory_for_it():
    """On the simulated chip, whose heap is locked while an interrupt runs."""
    fleet = Fleet({1: {"family": generic}, LOST: {"family": generic}}, listed=False)
    turns = fleet.master.turns
    turns.add(1)
    lost = turns.add(LOST, Layout(3, 2))
    fleet.run(1_000)
    for step in range(120):
        lost.ask_soon()
        fleet.run(2 + step % 40)
        turns.relayout(lost, (Layout(0, 2), Layout(3, 4))[step & 1])
        fleet.run(10)
    fleet.check()
    assert turns.drives[0].contact and not any(turns.drives[0].counters[1:])
    turns.relayout(lost, Layout(4, 2))
    fleet.run(1_000)
    assert lost.contact
