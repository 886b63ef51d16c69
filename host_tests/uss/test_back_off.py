# SPDX-License-Identifier: MIT
"""A silent drive costs the others little, unless it runs: that one is asked as often as ever.

And the gap between two telegrams to a drive stays under a third of its telegram-off time.
"""

from round_bench import READY, Bench, Node
from uss import pkw

BACK_US = 2_000_000  # a drive that is plugged back in is asked within this time


def nodes(count):
    return [Node(address) for address in range(1, count + 1)]


def gaps(bench, address, since=0):
    """Microseconds from one telegram to this drive to the next."""
    instants = [telegram.at for telegram in bench.sent[since:] if telegram.address == address]
    return [after - before for before, after in zip(instants, instants[1:])]


# --- an idle drive ------------------------------------------------------------------------------


def test_an_idle_drive_unplugged_costs_the_others_less_than_5_percent():
    """Against a bus on which it does not stand in the list at all."""
    for count in (2, 5, 31):
        bench = Bench(nodes(count))
        bench.contact()
        bench.nodes[count].plugged = False
        bench.run(5_000_000)
        without = Bench(nodes(count - 1))
        without.contact()
        rate, best = bench.rate(1, 60_000_000), without.rate(1, 60_000_000)
        assert rate > 0.95 * best, (count, rate, best)


def test_plugged_back_in_it_is_asked_within_2_seconds():
    for offset_us in range(0, 2_000_000, 77_777):
        bench = Bench(nodes(4))
        bench.contact()
        bench.nodes[2].plugged = False
        bench.run(4_000_000 + offset_us)
        assert not bench.drives[2].contact
        bench.nodes[2].plugged = True
        began = bench.now
        bench.run_until(lambda: bench.drives[2].contact)
        assert bench.now - began <= BACK_US, (offset_us, bench.now - began)
        sent = len(bench.sent)
        bench.run(1_000_000)
        rates = [bench.addresses(sent).count(address) for address in (1, 2, 3, 4)]
        assert max(rates) - min(rates) <= 2, rates  # and has its turns again


def test_a_single_bad_reply_takes_no_turn_away():
    bench = Bench(nodes(3))
    bench.contact()
    answer = bench.nodes[2].answer
    count = [0]

    def spoilt(characters):
        count[0] += 1
        reply = answer(characters)
        return reply if count[0] % 3 else reply[:-1] + bytes((reply[-1] ^ 1,))

    bench.nodes[2].answer = spoilt
    sent = len(bench.sent)
    bench.run(3_000_000)
    rates = [bench.addresses(sent).count(address) for address in (1, 2, 3)]
    assert max(rates) - min(rates) <= 1, rates


def test_many_dead_drives_leave_the_living_ones_their_rate():
    """Each is asked now and then, however many they are."""
    bench = Bench(nodes(31))
    bench.contact()
    for address in range(3, 32):
        bench.nodes[address].plugged = False
    bench.run(10_000_000)
    sent = len(bench.sent)
    rate = bench.rate(1, 20_000_000)
    without = Bench(nodes(2))
    without.contact()
    assert rate > 0.4 * without.rate(1, 20_000_000), rate  # half the time is left to them
    for address in range(3, 32):
        assert bench.addresses(sent).count(address) >= 1, address
        assert not bench.drives[address].contact
    for address in range(3, 32):
        bench.nodes[address].plugged = True
    bench.run(5_000_000)
    assert all(drive.contact for drive in bench.master.turns.drives)


def test_many_dead_drives_are_looked_after_a_few_at_a_time():
    """All of them take an eighth of a second, so that no step of the loop takes long."""
    bench = Bench(nodes(31))
    for address in range(3, 32):
        bench.nodes[address].plugged = False
    bench.run(5_000_000)
    deadlines, counts = bench.master.deadlines, [0]
    look, look_after = deadlines.look, deadlines.silence.look_after

    def counted_look(now):
        counts.append(0)
        look(now)

    def counted_look_after(drive):
        counts[-1] += 1
        look_after(drive)

    deadlines.look, deadlines.silence.look_after = counted_look, counted_look_after
    bench.run(2_000_000)
    assert 10 * 29 < sum(counts) < 20 * 29 and max(counts) <= 8, (sum(counts), max(counts))


def test_a_bus_on_which_everybody_is_dead_goes_on_asking():
    bench = Bench(nodes(3))
    for node in bench.nodes.values():
        node.plugged = False
    bench.run(10_000_000)
    progress = bench.master.progress
    sent = len(bench.sent)
    bench.run(2_000_000)
    assert set(bench.addresses(sent)) == {1, 2, 3} and bench.master.progress != progress
    for node in bench.nodes.values():
        node.plugged = True
    bench.run(2_000_000)
    assert all(drive.contact for drive in bench.master.turns.drives)


def test_a_command_reaches_a_drive_that_is_asked_now_and_then_at_once():
    bench = Bench(nodes(4))
    bench.contact()
    bench.nodes[3].plugged = False
    bench.run(5_000_000)
    for command in (bench.drives[3].stop, bench.drives[3].acknowledge):
        sent = len(bench.sent)
        command()
        bench.run(100_000)
        assert bench.addresses(sent)[0] == 3
        bench.run(3_000_000)


def test_parameters_asked_of_a_dead_drive_time_out():
    """All jobs end, although it has hardly a turn."""
    bench = Bench(nodes(4))
    bench.contact()
    bench.nodes[3].plugged = False
    bench.run(5_000_000)
    jobs = [pkw.read(700), pkw.read(1000)]
    for job in jobs:
        bench.drives[3].ask(job)
    bench.run(20_000_000)
    assert [job.state for job in jobs] == [pkw.TIMED_OUT] * 2


def test_a_drive_that_never_answered_is_asked_now_and_then_too():
    bench = Bench(nodes(3))
    bench.nodes[3].plugged = False
    bench.run(5_000_000)
    sent = len(bench.sent)
    bench.run(10_000_000)
    asked = bench.addresses(sent).count(3)
    assert 5 <= asked < bench.addresses(sent).count(1) // 10, asked


# --- a drive that runs --------------------------------------------------------------------------


def test_a_drive_that_runs_is_never_asked_less_often():
    """Unplugged while it turns: for as long as nobody knows that it stands, it has its turns."""
    bench = Bench(nodes(5))
    bench.contact()
    bench.drives[2].start(0x1000)
    bench.run(500_000)
    bench.nodes[2].plugged = False
    for _ in range(10):
        sent = len(bench.sent)
        bench.run(6_000_000)
        rates = [bench.addresses(sent).count(address) for address in (1, 2, 3, 4, 5)]
        assert rates[1] >= min(rates), rates
    assert bench.drives[2].was_running


def test_a_drive_that_runs_by_itself_is_never_asked_less_often():
    """Not by order of this bus: it was last seen running."""
    bench = Bench(nodes(4))
    bench.contact()
    bench.nodes[2].follows = False
    bench.nodes[2].zsw = 0xFB34
    bench.run(1_000_000)
    bench.nodes[2].plugged = False
    bench.run(5_000_000)
    sent = len(bench.sent)
    bench.run(10_000_000)
    rates = [bench.addresses(sent).count(address) for address in (1, 2, 3, 4)]
    assert rates[1] >= min(rates), rates


def test_a_drive_that_was_wanted_to_run_is_never_asked_less_often():
    """It had ON, and its plug was pulled before it was seen running."""
    bench = Bench(nodes(4))
    bench.contact()
    bench.nodes[2].follows = False
    bench.nodes[2].zsw = READY
    bench.drives[2].start(0x1000)
    bench.run(200_000)
    bench.nodes[2].plugged = False
    bench.run(5_000_000)
    sent = len(bench.sent)
    bench.run(10_000_000)
    rates = [bench.addresses(sent).count(address) for address in (1, 2, 3, 4)]
    assert rates[1] >= min(rates), rates


def test_after_its_stop_was_confirmed_it_may_be_asked_now_and_then():
    bench = Bench(nodes(4))
    bench.contact()
    bench.drives[2].start(0x1000)
    bench.run(500_000)
    bench.drives[2].stop()
    bench.run(500_000)
    bench.nodes[2].plugged = False
    bench.run(5_000_000)
    sent = len(bench.sent)
    bench.run(10_000_000)
    rates = [bench.addresses(sent).count(address) for address in (1, 2, 3, 4)]
    assert rates[1] * 10 < rates[0], rates


# --- the telegram-off time ----------------------------------------------------------------------


def running(bench, address, off_time_ms):
    """Have a drive run that trips after so long without a telegram."""
    drive = bench.drives[address]
    bench.master.deadlines.supervise(drive, off_time_ms)
    drive.start(0x1000)
    bench.run(1_000_000)
    assert bench.nodes[address].zsw == 0xFB34
    return drive


def test_the_gap_stays_under_a_third_of_the_off_time():
    """A round of 31 drives takes 0.7 s at 19200; this one trips after 0.45 s."""
    bench = Bench(nodes(31))
    bench.contact()
    running(bench, 17, 450)
    sent = len(bench.sent)
    bench.run(10_000_000)
    assert max(gaps(bench, 17, sent)) < 150_000
    for address in range(1, 32):  # and the others have their turns still
        assert bench.addresses(sent).count(address) >= 8, address


def test_the_gap_is_kept_while_other_drives_are_dead():
    bench = Bench(nodes(31))
    bench.contact()
    running(bench, 5, 600)
    for address in range(6, 31):
        bench.nodes[address].plugged = False
    sent = len(bench.sent)
    bench.run(10_000_000)
    assert max(gaps(bench, 5, sent)) < 200_000


def test_the_gap_is_kept_with_retries_parameters_and_a_fixed_cycle():
    bench = Bench(nodes(12))
    bench.contact()
    running(bench, 5, 600)
    bench.master.retries = 3
    bench.master.turns.cycle_us = 900_000
    bench.nodes[6].plugged = bench.nodes[7].plugged = False
    for drive in bench.master.turns.drives:
        if drive.address != 5:
            drive.want_turns(True)
            drive.ask(pkw.read(700))
    sent = len(bench.sent)
    bench.run(10_000_000)
    assert max(gaps(bench, 5, sent)) < 200_000


def test_the_gap_is_kept_for_several_drives_at_once():
    bench = Bench(nodes(20))
    bench.contact()
    times_ms = {3: 400, 9: 500, 15: 450}
    for address, off_time_ms in times_ms.items():
        running(bench, address, off_time_ms)
    sent = len(bench.sent)
    bench.run(10_000_000)
    for address, off_time_ms in times_ms.items():
        assert max(gaps(bench, address, sent)) < off_time_ms * 1000 // 3, address


def test_where_every_drive_is_in_a_hurry_the_list_alone_keeps_the_gap():
    bench = Bench(nodes(20))
    bench.contact()
    for address in range(1, 21):
        running(bench, address, 1_350)  # a round takes 0.42 s, a third of this is 0.45 s
    bench.run(2_000_000)
    sent = len(bench.sent)
    bench.run(10_000_000)
    for address in range(1, 21):
        assert max(gaps(bench, address, sent)) < 450_000, address


def test_a_drive_that_stands_has_its_turn_in_the_list_and_no_more():
    bench = Bench(nodes(31))
    bench.contact()
    bench.master.deadlines.supervise(bench.drives[17], 450)
    sent = len(bench.sent)
    bench.run(10_000_000)
    assert min(gaps(bench, 17, sent)) > 600_000


def test_a_drive_that_never_trips_counts_as_one_that_trips_when_it_would_be_lost():
    """P2014 = 0: after a second without a reply it is lost. So does one of which nobody told."""
    for told in (True, False):
        bench = Bench(nodes(31))
        bench.contact()
        if told:
            bench.master.deadlines.supervise(bench.drives[17], 0)
        bench.drives[17].start(0x1000)
        bench.run(1_000_000)
        sent = len(bench.sent)
        bench.run(10_000_000)
        assert max(gaps(bench, 17, sent)) < 333_333


def test_a_gap_of_three_rounds_needs_no_extra_turns_however_late_the_bus_began():
    # The first measurement of a round counted the time before the first telegram.
    bench = Bench(nodes(31))
    bench.now = 10_000_000
    bench.contact()
    running(bench, 17, 5_400)  # a third of it is nearly three rounds
    sent = len(bench.sent)
    bench.run(10_000_000)
    assert min(gaps(bench, 17, sent)) > 600_000


def test_while_it_is_lost_and_may_run_the_gap_is_kept():
    bench = Bench(nodes(31))
    bench.contact()
    running(bench, 17, 600)
    bench.nodes[17].plugged = False
    bench.run(3_000_000)
    sent = len(bench.sent)
    bench.run(5_000_000)
    assert max(gaps(bench, 17, sent)) < 200_000
