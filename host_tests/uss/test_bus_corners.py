# SPDX-License-Identifier: MIT
"""Corners of the bus: where two things come together that each are tested elsewhere.

A random hand found most of them; others showed when a line of the engine was left out and no test
minded.
"""

from round_bench import RUNNING, Bench, Node, framed
from uss import outside, pkw, pzd, telegram
from uss.layout import Layout
from uss.master import OFF
from uss.outside import DONE, PENDING, TIMED_OUT, Broadcast, Mirror, Special
from uss.receiver import SILENT


def bench_of(count, **options):
    """Drives 1 to `count`, all in contact."""
    bench = Bench([Node(address) for address in range(1, count + 1)], **options)
    bench.contact()
    return bench


def gaps(bench, address, since):
    instants = [each.at for each in bench.sent[since:] if each.address == address]
    return [after - before for before, after in zip(instants, instants[1:])]


def resting(bench, address):
    """Let this one be unplugged until it backs off."""
    bench.nodes[address].plugged = False
    bench.run(4_000_000)
    assert bench.drives[address] not in bench.master.turns.round[: bench.master.turns.round_count]


# --- the gap of a drive that may run ------------------------------------------------------------


def test_drives_that_need_more_turns_leave_the_others_theirs():
    """Ten that run and trip after a second without telegrams, and five that stand: more than the
    line can carry within a third of that. Nobody trips, and nobody is forgotten.
    """
    bench = bench_of(15)
    for address in range(1, 11):
        bench.master.deadlines.supervise(bench.drives[address], 1_000)
        bench.drives[address].start(0x1000)
    bench.run(1_000_000)
    sent = len(bench.sent)
    bench.run(10_000_000)
    for address in range(1, 16):
        longest_us = max(gaps(bench, address, sent))
        assert longest_us < (500_000 if address < 11 else 1_000_000), (address, longest_us)


def test_a_cycle_longer_than_the_off_time_does_not_trip_a_drive():
    for first in (True, False):
        bench = bench_of(2)
        if first:
            bench.master.turns.cycle_us = 2_000_000
        bench.master.deadlines.supervise(bench.drives[1], 1_500)
        bench.master.turns.cycle_us = 2_000_000
        bench.drives[1].start(0x1000)
        bench.run(200_000)
        sent = len(bench.sent)
        bench.run(6_000_000)
        assert max(gaps(bench, 1, sent)) < 500_000


def test_a_loop_that_seldom_comes_round_keeps_the_gap_of_all():
    bench = bench_of(15)
    bench.refreshing = False
    bench.loop = seldom(bench)
    for address in range(1, 6):
        bench.master.deadlines.supervise(bench.drives[address], 1_000)
        bench.drives[address].start(0x1000)
    bench.run(500_000)
    sent = len(bench.sent)
    bench.run(6_000_000)
    for address in range(1, 6):
        assert max(gaps(bench, address, sent)) < 500_000


def test_the_off_time_goes_with_the_drive_and_not_with_its_address():
    """Also when it is taken away, and another one comes in its place."""
    bench = bench_of(20)
    bench.master.turns.lost_us = 6_000_000  # those of which nobody has told may wait for long
    bench.master.deadlines.supervise(bench.drives[5], 600)
    bench.nodes[25] = bench.nodes.pop(5)
    bench.nodes[25].address = 25
    bench.master.turns.readdress(bench.drives[5], 25)
    bench.nodes[5] = Node(5)
    bench.master.deadlines.supervise(bench.drives[6], 600)
    bench.master.turns.remove(bench.drives[6])
    drives = [bench.drives[5], bench.master.turns.add(5), bench.master.turns.add(6)]
    bench.run(600_000)
    for drive in drives:
        drive.start(0x1000)
    bench.run(1_000_000)
    sent = len(bench.sent)
    bench.run(10_000_000)
    assert max(gaps(bench, 25, sent)) < 200_000
    assert min(gaps(bench, 5, sent) + gaps(bench, 6, sent)) > 300_000


def seldom(bench):
    """A main loop that takes 90 ms."""
    last = [0]

    def loop():
        if bench.now - last[0] >= 90_000:
            last[0] = bench.now
            bench.master.refresh(bench.now & bench.mask)

    return loop


# --- the list -----------------------------------------------------------------------------------


def test_a_drive_taken_away_is_not_asked_again_for_want_of_a_reply():
    for offset_us in range(0, 60_000, 1_500):
        bench = bench_of(2)
        bench.master.retries = 3
        bench.nodes[2].plugged = False
        bench.run(offset_us)
        bench.master.turns.remove(bench.drives[2])
        going_on = bench.sent[-1].address == 2
        sent = len(bench.sent)
        bench.run(200_000)
        assert 2 not in bench.addresses(sent), (offset_us, going_on)


def test_the_address_of_one_that_was_taken_away_is_free():
    """For a new drive, which has its turn at once though the other one had lost its own."""
    bench = bench_of(3)
    resting(bench, 3)
    bench.master.turns.remove(bench.drives[3])
    bench.nodes[3] = Node(3, pkw_words=3)
    bench.refreshing = False  # nobody looks after it meanwhile
    drive = bench.master.turns.add(3, Layout(3, 2))
    bench.run(200_000)
    assert drive.contact
    bench.refreshing = True
    bench.master.turns.remove(drive)
    bench.nodes[3] = bench.nodes[2]
    bench.nodes[3].address = 3
    bench.master.turns.readdress(bench.drives[2], 3)
    sent = len(bench.sent)
    bench.run(200_000)
    assert set(bench.addresses(sent + 1)) == {1, 3}


def test_one_that_backs_off_goes_on_doing_so_at_another_address():
    bench = bench_of(3)
    resting(bench, 3)
    bench.master.turns.readdress(bench.drives[3], 9)
    bench.refreshing = False
    bench.nodes[3] = Node(3, pkw_words=3)
    drive = bench.master.turns.add(3, Layout(3, 2))
    bench.run(250_000)
    assert drive.contact  # it does not back off in its place
    assert bench.drives[3] not in bench.master.turns.round[: bench.master.turns.round_count]


def test_two_drives_change_places():
    bench = bench_of(2)
    one, two = bench.master.turns.drives
    for drive, address in ((one, 9), (two, 1), (one, 2)):
        bench.nodes[address] = bench.nodes.pop(drive.address)
        bench.nodes[address].address = address
        bench.master.turns.readdress(drive, address)
        bench.run(100_000)
    sent = len(bench.sent)
    one.stop()
    bench.run(60_000)
    assert 2 in bench.addresses(sent)[:2]
    assert [drive.contact for drive in (one, two)] == [True, True]


def test_another_address_in_the_middle_of_an_exchange_is_no_other_master():
    """On a link that is looked at, the reply comes in pieces, from the address before."""
    bench = bench_of(2, interrupts=False)
    drive = bench.master.turns.drives[0]
    for round_number in range(30):
        bench.run(1_000 + 777 * round_number)
        address = 7 if drive.address == 1 else 1
        bench.nodes[address] = bench.nodes.pop(drive.address)
        bench.nodes[address].address = address
        bench.master.turns.readdress(drive, address)
        bench.run(100_000)
    assert drive.contact and not bench.master.foreign and drive.counters[4] == 0


def test_a_second_drive_that_dies_later_is_looked_after_too():
    bench = bench_of(3)
    resting(bench, 3)
    bench.nodes[3].plugged = True
    bench.run(2_500_000)
    resting(bench, 2)
    bench.nodes[2].plugged = True
    bench.run(2_000_000)
    assert bench.drives[2].contact and bench.drives[3].contact


def test_looking_for_a_dead_drive_takes_a_fifth_of_the_line_at_300_baud_too():
    bench = bench_of(2, baud=300)
    best = bench_of(1, baud=300).rate(1, 200_000_000)
    bench.nodes[2].plugged = False
    bench.run(20_000_000)
    assert bench.rate(1, 200_000_000) > 0.8 * best - 1


def test_a_dead_drive_loses_contact_however_long_the_round_takes():
    """Also where the clock's counter is over sooner than that."""
    bench = bench_of(1, mask=(1 << 24) - 1)
    bench.master.turns.cycle_us = 1 << 24
    bench.run(20_000_000)
    bench.nodes[1].plugged = False
    bench.run(60_000_000)
    assert not bench.drives[1].contact


# --- telegrams outside the list -----------------------------------------------------------------


def test_a_mirror_telegram_is_pending_until_the_last_repetition_is_over():
    bench = bench_of(1)
    bench.master.retries = 2
    probe = Mirror(9)
    bench.master.turns.post(probe)
    states = []
    bench.loop = lambda: states.append((probe.state, bench.addresses().count(0x49)))
    bench.run(400_000)
    assert all([state == PENDING for state, times in states if times < 3])
    assert probe.state == TIMED_OUT and bench.addresses().count(0x49) == 3
    bench.master.turns.post(probe)
    bench.run(400_000)
    assert probe.state == TIMED_OUT and bench.addresses().count(0x49) == 6


def test_one_that_is_on_the_line_when_the_engine_fails_comes_to_an_end():
    bench = bench_of(1)
    probe = Mirror(1)
    bench.master.turns.post(probe)
    bench.run_until(lambda: bench.sent[-1].address == 0x41)
    bench.master.recover(bench.now & bench.mask)
    bench.run(100_000)
    assert probe.state == TIMED_OUT
    bench.master.turns.post(probe)
    bench.run(500_000)
    assert probe.state == DONE


def test_a_special_reply_that_is_too_long_for_a_telegram_is_none():
    """LGE 255 would be 253 net characters; the longest telegram has 252."""
    bench = Bench([])
    special = Special(1, b"\x01\x02")
    bench.master.turns.post(special)
    bench.run_until(lambda: bench.sent)
    begin = bench.now + 15_000
    bench.talk(framed(0x81, bytes(253)), begin)
    bench.run(400_000)
    assert special.state == TIMED_OUT and bench.master.failures == 0


def test_a_special_reply_as_long_as_the_request_is_none_when_another_length_was_agreed():
    bench = Bench([])
    special = Special(1, b"\x01\x02\x03\x04", reply_count=6)
    bench.master.turns.post(special)
    bench.run_until(lambda: bench.sent)
    bench.talk(framed(0x81, bytes(4)), bench.now + bench.timing.telegram_us(4) + 3_000)
    bench.run(100_000)
    assert special.state == TIMED_OUT and special.finding == telegram.BAD_LENGTH


def test_what_a_mirror_telegram_found_before_is_forgotten():
    bench = bench_of(1)
    probe = Mirror(1)
    for plugged, finding in ((False, SILENT), (True, telegram.GOOD)):
        bench.nodes[1].plugged = plugged
        bench.master.turns.post(probe)
        bench.run(200_000)
        assert probe.finding == finding


def test_behind_a_broadcast_stop_those_that_run_are_first():
    bench = bench_of(10)
    for address in (7, 9):
        bench.drives[address].start(0x1000)
    bench.run(400_000)
    outside.stop_all(bench.master)
    bench.run_until(lambda: bench.sent[-1].address == 0x20)
    sent = len(bench.sent)
    bench.run(300_000)
    assert set(bench.addresses(sent)[:2]) == {7, 9}


def test_a_broadcast_is_sent_before_the_bus_is_off():
    bench = Bench([])
    bench.run(200_000)
    broadcast = Broadcast((pzd.OFF1, 0), {1: pzd.STW_RUN})
    broadcast.ahead = True
    bench.master.turns.post(broadcast)
    bench.master.off()
    bench.run(300_000)
    assert bench.master.phase == OFF and broadcast.state == DONE


# --- turns --------------------------------------------------------------------------------------


def test_repetitions_keep_nobody_from_having_more_than_its_turn():
    bench = bench_of(4)
    bench.master.retries = 1
    bench.drives[1].want_turns(True)
    bench.nodes[3].plugged = False
    bench.run(100_000)
    sent = len(bench.sent)
    bench.run(500_000)
    addresses = bench.addresses(sent)
    assert addresses.count(1) > addresses.count(2) + 3


def test_an_off_that_nobody_confirms_is_repeated_although_mirrors_are_sent():
    bench = bench_of(6)
    bench.drives[2].start(0x1000)
    bench.run(300_000)
    bench.nodes[2].plugged = False
    probe = Mirror(3)

    def loop():
        if probe.state != PENDING:
            bench.master.turns.post(probe)

    bench.loop = loop
    sent = len(bench.sent)
    bench.drives[2].stop()
    bench.run(900_000)
    assert bench.addresses(sent).count(2) >= 10


def test_a_pause_is_not_broken_by_another_address():
    bench = bench_of(2)
    bench.drives[1].want_turns(True)
    bench.master.pause()
    bench.run_until(lambda: bench.master.paused)
    sent = len(bench.sent)
    bench.nodes[9] = bench.nodes.pop(1)
    bench.nodes[9].address = 9
    bench.master.turns.readdress(bench.drives[1], 9)
    bench.run(100_000)
    assert len(bench.sent) == sent and bench.master.paused


def test_a_drive_added_after_a_long_silence_is_asked_at_once():
    """Longer than half of what the clock can tell."""
    for seconds in range(7, 20):
        bench = Bench([], mask=(1 << 24) - 1)
        bench.run(seconds * 1_000_000)
        bench.nodes[1] = Node(1)
        drive = bench.master.turns.add(1)
        bench.run(50_000)
        assert drive.contact, seconds


# --- commands -----------------------------------------------------------------------------------


def test_bits_of_the_control_word_are_set_one_after_the_other():
    bench = bench_of(1)
    drive = bench.drives[1]
    drive.control(0x2000, True)
    drive.control(0x0020, False)
    bench.run(100_000)
    assert bench.stws(1)[-1] == pzd.OFF1 & ~0x0020 | 0x2000
    drive.control(0x2000, False)
    bench.run(100_000)
    assert bench.stws(1)[-1] == pzd.OFF1 & ~0x0020


def test_who_was_just_told_to_run_is_stopped_before_one_that_stands():
    """Though it has not been seen running yet."""
    bench = bench_of(6)
    bench.nodes[5].follows = False
    bench.run_until(lambda: bench.sent[-1].address == 5)
    bench.run_until(lambda: bench.sent[-1].address == 6)
    bench.drives[5].start(0x1000)
    bench.run_until(lambda: bench.sent[-1].stw() == pzd.ON)
    bench.run(40_000)
    sent = len(bench.sent)
    for address in (1, 2, 3, 4, 6, 5):
        bench.drives[address].stop()
    bench.run(60_000)
    assert bench.addresses(sent)[0] == 5


def test_a_lost_drive_has_answered_nothing():
    bench = bench_of(2)
    bench.run(100_000)
    assert bench.drives[2].answered_stw == pzd.OFF1 and bench.drives[2].answered_off()
    bench.nodes[2].plugged = False
    bench.run(1_500_000)
    assert bench.drives[2].answered_stw == 0 and not bench.drives[2].answered_off()


def test_a_further_word_is_sent_from_the_next_telegram_on():
    bench = Bench([Node(1, pzd_words=4)])
    bench.contact()
    bench.run(300_000)
    bench.drives[1].put(4, 0x2000)
    sent = len(bench.sent)
    bench.run(60_000)
    assert bench.sent[sent].characters[-3:-1] == b"\x20\x00"


def test_a_word_that_has_no_place_in_the_telegrams_or_16_bits_is_refused():
    drive = Bench([Node(1, pzd_words=4)]).drives[1]
    for place, word in ((2, 0), (5, 0), (3, 0x10000), (3, -1)):
        before = bytes(drive.further)
        try:
            drive.put(place, word)
        except ValueError as error:
            assert "PZD%d" % place in str(error)
        else:
            raise AssertionError((place, word))
        assert bytes(drive.further) == before


def test_the_control_word_moves_with_the_length_of_the_task():
    """With variable length a double word takes more room, and the process data stand behind it."""
    bench = Bench([Node(1, pkw_words=127, pzd_words=4)])
    bench.contact()
    drive = bench.drives[1]
    drive.start(0x1234)
    drive.put(4, 0x2000)
    bench.run(300_000)
    sent = len(bench.sent)
    drive.put(4, 0x2001)
    drive.ask(pkw.write_double(1082, 0x12345678))
    bench.run(3_000_000)
    lengths = set()
    for each in bench.sent[sent:]:
        lengths.add(len(each.characters))
        assert each.characters[-9:-1] == b"\x04\x7f\x12\x34\x00\x00\x20\x01", each
    assert len(lengths) == 2


def test_a_start_takes_an_off3_back():
    """What is sent when the engine stops it later is OFF1, and inhibits nothing."""
    bench = bench_of(1)
    drive = bench.drives[1]
    drive.stop(pzd.OFF3)
    bench.run(100_000)
    assert bench.stws(1)[-1] == pzd.OFF3
    drive.start(0x1000)
    bench.run(100_000)
    bench.refreshing = False
    bench.run(400_000)
    assert bench.stws(1)[-1] == pzd.OFF1


def test_whoever_may_run_unseen_is_told_to_stop_before_the_bus_is_off():
    """It was lost while it ran: it does not answer, and OFF1 is sent again and again."""
    bench = bench_of(2)
    bench.drives[2].start(0x1000)
    bench.run(100_000)
    bench.nodes[2].plugged = False
    bench.run(3_000_000)
    assert bench.drives[2].was_running and not bench.drives[2].contact
    sent = len(bench.sent)
    bench.master.off()
    bench.run_until(lambda: bench.master.phase == OFF)
    assert bench.stws(2, sent).count(pzd.OFF1) >= 10


# --- another master -----------------------------------------------------------------------------


def test_a_reply_that_comes_too_late_is_no_other_master():
    bench = bench_of(1)
    bench.nodes[1].plugged = False
    for offset_us in range(0, 20_000, 500):
        sent = len(bench.sent)
        bench.run_until(lambda: len(bench.sent) > sent)
        begin = bench.now + bench.timing.telegram_us(12) + 21_000 + offset_us
        bench.talk(framed(1, bytes(12)), begin)
        bench.run_until(lambda: not bench.bursts)
    assert bench.master.foreign == 0


def test_a_telegram_of_somebody_else_instead_of_the_reply_is():
    bench = bench_of(1)
    bench.nodes[1].plugged = False
    bench.run(100_000)
    sent = len(bench.sent)
    bench.run_until(lambda: len(bench.sent) > sent)
    bench.talk(framed(9, bytes(12)), bench.now + bench.timing.telegram_us(12) + 3_000)
    bench.run(60_000)
    assert bench.master.foreign == 1 and bench.master.is_line_shared()
    assert bench.drives[1].counters[4] == 1


# --- after an exception, and off ----------------------------------------------------------------


def test_an_exception_while_the_line_is_given_away_sends_nothing():
    bench = bench_of(1)
    bench.master.off()
    bench.run(300_000)
    sent = len(bench.sent)
    bench.drives[1].stop()
    bench.drives[1].start(0x1000)
    bench.master.recover(bench.now & bench.mask)
    bench.run(500_000)
    assert len(bench.sent) == sent and bench.master.phase == OFF


def test_after_an_exception_the_exchange_may_come_to_its_end():
    """A reply that begins at the last moment is over before the next telegram."""
    bench = Bench([Node(1, delay_us=19_900)], baud=1200)
    bench.contact()
    for offset_us in range(0, 340_000, 20_000):
        sent = len(bench.sent)
        bench.run_until(lambda: len(bench.sent) > sent)
        bench.run(offset_us)
        bench.master.recover(bench.now & bench.mask)
        over = max([bench.now] + [end for _, end, _ in bench.bursts])
        sent = len(bench.sent)
        bench.run_until(lambda: len(bench.sent) > sent)
        assert bench.sent[-1].at >= over + bench.timing.start_interval_us


def test_what_others_said_while_it_was_off_is_forgotten():
    for interrupts in (True, False):
        bench = bench_of(1, interrupts=interrupts)
        bench.master.off()
        bench.run(300_000)
        bench.talk(framed(5, bytes(12)))
        bench.run(400_000)
        bench.master.on()
        bench.run(900_000)
        assert bench.master.foreign == 0 and bench.drives[1].contact


def test_what_others_said_before_it_was_off_is_forgotten_too():
    bench = Bench([Node(1)])
    bench.talk(framed(5, bytes(12)))
    bench.run(50_000)
    assert bench.master.is_line_in_use()
    bench.master.off()
    bench.run(400_000)
    bench.master.on()
    assert not bench.master.is_line_in_use()
    bench.run(900_000)
    assert bench.drives[1].contact and not bench.master.is_line_shared()


def test_on_listens_although_the_line_was_silent_for_long():
    bench = bench_of(1)
    bench.master.off()
    bench.run(2_000_000)
    sent = len(bench.sent)
    bench.master.on()
    bench.due = switched_at = bench.now
    bench.run(300_000)
    assert bench.sent[sent].at - switched_at >= 100_000


def test_off_and_pause_do_not_wait_for_a_gap_in_the_replies():
    """The link reports them later than the start interval lasts: a request follows at once."""
    bench = bench_of(3, idle_us=2_000)
    bench.master.pause()
    bench.run(60_000)
    assert bench.master.paused
    bench.master.resume()
    bench.run(100_000)
    bench.master.off()
    bench.run(200_000)
    assert bench.master.phase == OFF


def test_jobs_asked_while_it_was_off_are_carried_out_later():
    bench = bench_of(1)
    bench.master.off()
    bench.run(300_000)
    job = pkw.read(700)
    bench.drives[1].ask(job)
    bench.run(3_000_000)
    assert job.state == pkw.PENDING
    bench.master.on()
    sent = len(bench.sent)
    bench.run(500_000)
    assert pkw.READ in [each.task() for each in bench.sent[sent:]]


# --- a drive that falls silent on a task --------------------------------------------------------


class Touchy(Node):
    """A drive that gives no reply at all to a telegram with a task."""

    def answer(self, characters):
        reply = Node.answer(self, characters)
        return None if characters[3] >> 4 else reply


def test_a_task_that_a_drive_leaves_unanswered_stops_no_motor():
    for count, baud in ((1, 19200), (8, 19200), (31, 38400), (1, 2400)):
        nodes = [Touchy(1)] + [Node(address % 32) for address in range(2, count + 1)]
        bench = Bench(nodes, baud)
        bench.contact()
        drive = bench.drives[1]
        drive.start(0x1000)
        bench.run_until(lambda: bench.nodes[1].zsw == RUNNING)
        for job in (pkw.read(999), pkw.write_word(999, 5), pkw.read(998)):
            asked_at = bench.now
            drive.ask(job)
            bench.run_until(lambda: job.state != pkw.PENDING, 20_000_000)
            assert drive.contact and drive.contacts == 1 and drive.is_on(), (count, baud, job)
            assert job.state == pkw.UNANSWERED, (count, baud, job)
            if baud > 2400:  # else half of the lost time is over after two
                sent = [each for each in bench.sent if each.at >= asked_at and each.address == 1]
                assert len([each for each in sent if each.task()]) <= 3
        assert bench.nodes[1].zsw == RUNNING
        assert all([other.contact for other in bench.master.turns.drives])


def test_three_losses_in_a_row_on_a_bad_line_withdraw_no_question():
    """The line fails for a fifth of a second, with a question on its way.

    Had the drive answered that by "no answer yet" before, it may as well lag and have fallen
    silent on the question: nobody can tell these two apart.
    """
    bench = Bench([Node(1), Node(2)])
    bench.contact()
    for step in range(20):
        first = len(bench.sent)
        job = pkw.read(999)
        bench.drives[1].ask(job)
        bench.run(3_000 + 1_700 * step)
        bench.nodes[1].plugged = False
        bench.run(200_000)
        assert job.state == pkw.PENDING, step
        bench.nodes[1].plugged = True
        sent = len(bench.sent)
        asked = [each.task() for each in bench.sent[first:] if each.address == 1].count(1)
        if asked > 3:  # one of them was answered
            bench.run_until(lambda: job.state != pkw.PENDING)
            assert step == 0 and job.state == pkw.UNANSWERED, step
            continue
        bench.run(100_000)
        assert 1 in [each.task() for each in bench.sent[sent:] if each.address == 1], step
        bench.run_until(lambda: job.state != pkw.PENDING)
        assert job.state == pkw.TIMED_OUT  # this node knows no tasks, and says so by AK 0
