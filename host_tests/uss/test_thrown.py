# SPDX-License-Identifier: MIT
"""An exception at any line of the engine: what waits is not forgotten, and nothing starts by it.

On a chip that is a Ctrl-C while the main loop is inside the engine, or a fault of ours. Here each
line throws, one after the other, and the engine recovers. Beside that, what `test_interrupted`
does to commands is done here to what the main loop calls all the time.
"""

from interruption_bench import interrupted, recovered
from round_bench import Bench, Node
from uss import pzd
from uss.outside import DONE, PENDING, Mirror

INTERPRETERS = "cpython"


def running(count=5):
    """Drives 2 and 4 run."""
    bench = Bench([Node(address) for address in range(1, count + 1)])
    bench.contact()
    for address in (2, 4):
        bench.drives[address].start(0x1000)
    bench.run(200_000)
    return bench


def stopping():
    """They are told to stop, and the engine has not come to it yet."""
    bench = running()
    bench.run_until(lambda: bench.sent[-1].address == 3)
    for address in (1, 2, 4):
        bench.drives[address].stop()
    return bench


def test_stops_that_wait_are_in_the_next_telegrams():
    for bench in recovered(stopping, 90_000):
        waiting = {drive.address for drive in bench.master.turns.drives if drive.urgency() > 1}
        sent = len(bench.sent)
        bench.run(300_000)
        assert set(bench.addresses(sent)[: len(waiting)]) == waiting
        assert bench.nodes[2].zsw == bench.nodes[4].zsw == 0xFB31


def test_all_that_run_are_stopped_and_need_a_new_start():
    for bench in recovered(running, 60_000):
        sent = len(bench.sent)
        bench.run(300_000)
        stws = bench.stws(2, sent) + bench.stws(4, sent)
        assert stws and set(stws) == {pzd.OFF1}
        bench.drives[2].start(0x1000)
        bench.run(200_000)
        assert bench.nodes[2].zsw == 0xFB34


def test_a_telegram_outside_the_list_comes_to_an_end():
    """But for one that was out of the queue already, and was not begun."""

    def prepare():
        bench = running()
        bench.probe = Mirror(3)
        bench.master.turns.post(bench.probe)
        return bench

    for bench in recovered(prepare, 60_000):
        bench.run(500_000)
        if bench.probe.state == PENDING:
            assert 0x43 not in bench.addresses()
            continue
        bench.master.turns.post(bench.probe)
        bench.run(300_000)
        assert bench.probe.state == DONE


# --- refresh, between any two lines of which the engine comes in ---------------------------------


def test_a_refresh_takes_no_turn_from_a_drive_that_runs():
    """While one that is dead begins to back off, and while it comes back."""
    for back in (False, True):

        def prepare(back=back):
            bench = running()
            bench.nodes[5].plugged = False
            if back:
                bench.run(4_000_000)
                bench.nodes[5].plugged = True
            bench.run_until(lambda: back == bench.drives[5].contact)
            return bench

        def refresh(bench):
            for later_us in range(0, 120_000, 40_000):  # so that everybody is looked at
                bench.master.refresh((bench.now + later_us) & bench.mask)

        for bench, _ in interrupted(prepare, refresh):
            sent = len(bench.sent)
            bench.run(500_000)
            for address in (2, 4):
                instants = [each.at for each in bench.sent[sent:] if each.address == address]
                assert max([b - a for a, b in zip(instants, instants[1:])]) < 160_000
                assert bench.drives[address].is_on()


# --- a start, once more -------------------------------------------------------------------------


def test_a_start_forwards_sends_no_jog_that_was_wanted_before():
    """The engine had taken the jog back; its word still stood there."""

    def prepare():
        bench = running()
        bench.drives[1].start(0, pzd.JOG_LEFT)
        bench.run(100_000)
        bench.refreshing = False
        bench.run(400_000)
        bench.refreshing = True
        bench.run(100_000)
        assert bench.drives[1].stopped_by_engine()
        return bench

    for bench, sent in interrupted(prepare, lambda bench: bench.drives[1].start(0x1000)):
        bench.run(200_000)
        assert set(bench.stws(1, sent)) <= {pzd.OFF1, pzd.ON}
