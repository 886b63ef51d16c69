# SPDX-License-Identifier: MIT
"""Whose line it is: bus off and on by command, and another master on it."""

from round_bench import Bench, Node, framed
from uss import pkw, pzd
from uss.leave import leave, persist
from uss.master import CLOSED, DEAD_MAN_US, LISTEN_US, LISTENING, OFF, RESTING

FOREIGN = framed(7, bytes(12))  # somebody else's request


def nodes(count):
    return [Node(address) for address in range(1, count + 1)]


def go_off(bench):
    bench.master.off()
    bench.run_until(lambda: bench.master.phase == OFF, 6_000_000)


# --- off ----------------------------------------------------------------------------------------


def test_bus_off_stops_every_drive_and_then_there_is_silence():
    bench = Bench(nodes(4))
    bench.contact()
    bench.drives[2].start(0x1000)
    bench.drives[4].start(0x1000)
    bench.run(500_000)
    sent = len(bench.sent)
    go_off(bench)
    assert set(bench.addresses(sent)[:2]) == {2, 4}  # those that run go first
    for address in (1, 2, 3, 4):
        assert bench.stws(address)[-1] == pzd.OFF1
    assert bench.nodes[2].zsw == bench.nodes[4].zsw == 0xFB31
    sent = len(bench.sent)
    bench.run(60_000_000)
    assert len(bench.sent) == sent


def test_it_is_off_soon_also_when_drives_are_dead():
    bench = Bench(nodes(31))
    bench.contact()
    bench.drives[5].start(0x1000)
    bench.run(1_000_000)
    for address in range(4, 20):
        bench.nodes[address].plugged = False
    began = bench.now
    sent = len(bench.sent)
    go_off(bench)
    assert bench.now - began < 6_000_000
    assert bench.addresses(sent).count(5) >= 2  # it may run: it was told more than once


def test_off_cuts_no_exchange():
    for offset_us in range(0, 48_000, 1_009):
        bench = Bench(nodes(2))
        bench.run(300_000 + offset_us)
        go_off(bench)
        for drive in bench.master.turns.drives:
            assert not any(drive.counters[1:]), (offset_us, drive.counters)


def test_while_it_is_off_the_loop_may_take_its_time():
    """No alarm from the watch over the engine, and none from the engine over the loop."""
    bench = Bench(nodes(2))
    bench.contact()
    go_off(bench)
    for _ in range(20):
        progress = bench.master.progress
        bench.run(bench.master.patience_us())
        assert bench.master.progress != progress


def test_nothing_is_sent_for_any_command_or_task():
    bench = Bench(nodes(2))
    bench.contact()
    go_off(bench)
    sent = len(bench.sent)
    one, two = bench.master.turns.drives
    one.start(0x1000)
    two.stop()
    two.acknowledge()
    two.ask(pkw.read(700))
    bench.run(3_000_000)
    bench.refreshing = False
    bench.run(1_000_000)
    assert len(bench.sent) == sent


def test_another_tool_may_have_the_line_meanwhile():
    bench = Bench(nodes(2))
    bench.contact()
    go_off(bench)
    sent = len(bench.sent)
    for _ in range(100):
        bench.talk(FOREIGN)
        bench.run(30_000)
    assert len(bench.sent) == sent and not any(bench.drives[1].counters[1:])


def test_a_bus_that_is_given_up_waits_for_no_drive_any_more():
    bench = Bench(nodes(2))
    bench.contact()
    bench.drives[2].start(0x1000)
    bench.run(300_000)
    bench.nodes[2].plugged = False
    bench.master.close()
    bench.run(500_000)
    assert bench.master.phase != CLOSED and bench.stws(2)[-1] == pzd.OFF1
    bench.run_until(lambda: bench.sent[-1].address == 1)
    good, sent = bench.drives[1].counters[0], len(bench.sent)
    bench.master.give_up()
    bench.run(50_000)
    assert bench.master.phase == CLOSED and len(bench.sent) == sent
    assert bench.drives[1].counters[0] == good + 1  # the exchange was not cut off


# --- leaving ------------------------------------------------------------------------------------


class Leaving:
    """A bus whose round takes 40 ms, and which is closed after so long; its clock; and a program
    that does something for 1 ms each time. interrupts: at these of its steps Ctrl-C strikes."""

    ticks_mask = (1 << 30) - 1

    def __init__(self, closes_after_us, began=0, interrupts=()):
        self.turns = self
        self.phase = RESTING
        self.calls = []  # (what, microseconds since the beginning)
        self._us = 0
        self._closes_after_us = closes_after_us
        self._began = began
        self._interrupts = interrupts

    def longest_cycle_us(self):
        return 40_000

    def ticks_us(self):
        return (self._began + self._us) & self.ticks_mask

    def close(self):
        self._do("close", 0)

    def give_up(self):
        self._do("give up", 0)

    def go_on(self):
        self._do("go on", 1_000)

    def _do(self, what, duration_us):
        self.calls.append((what, self._us))
        self._us += duration_us
        if self._us >= self._closes_after_us:
            self.phase = CLOSED
        if len(self.calls) in self._interrupts:
            raise KeyboardInterrupt

    def leave(self):
        """Instants of each kind of call, when the program has left."""
        leave(self, self, self.go_on)
        return [
            [at for what, at in self.calls if what == kind]
            for kind in ("close", "give up", "go on")
        ]


def test_whoever_leaves_goes_on_until_the_bus_is_closed_and_no_longer():
    assert Leaving(0).leave() == [[0], [], []]
    assert Leaving(3_000).leave() == [[0], [], [0, 1_000, 2_000]]


def test_whoever_leaves_waits_a_second_and_a_round_for_the_drives_then_as_long_for_the_bus():
    """Also where the counter of the clock begins anew meanwhile."""
    for began in (0, -1_500_000):
        closed, given_up, went_on = Leaving(10_000_000, began).leave()
        assert closed == [0]
        assert went_on == list(range(0, 2_080_000, 1_000))
        assert given_up == list(range(1_040_000, 2_080_000, 1_000))


def test_ctrl_c_does_not_keep_anybody_from_leaving():
    """It strikes in the closing, which is begun anew, in the program and in the giving up."""
    assert Leaving(3_000, interrupts=(1, 3)).leave() == [[0, 0], [], [0, 1_000, 2_000]]
    closed, given_up, went_on = Leaving(10_000_000, interrupts=(1_042, 1_500)).leave()
    assert given_up[:2] == [1_040_000] * 2 and went_on[-1] == 2_079_000


def test_what_must_not_be_cut_short_is_begun_anew_until_it_is_done():
    strikes = [KeyboardInterrupt] * 3
    began = []

    def action(*arguments):
        began.append(arguments)
        if strikes:
            raise strikes.pop()
        return "done"

    assert persist(action, 1, "two") == "done" and began == [(1, "two")] * 4

    def fail():
        raise ValueError("on purpose")

    try:
        persist(fail)
    except ValueError:
        return
    raise AssertionError("another exception was kept in")


# --- on -----------------------------------------------------------------------------------------


def test_on_listens_first_and_then_goes_on():
    bench = Bench(nodes(2))
    bench.contact()
    go_off(bench)
    bench.run(1_000_000)
    sent = len(bench.sent)
    bench.master.on()
    began = bench.now
    bench.run_until(lambda: len(bench.sent) > sent)
    assert bench.now - began >= LISTEN_US
    bench.run(200_000)
    assert all(drive.contact for drive in bench.master.turns.drives)


def test_after_on_nothing_starts_by_itself():
    """What was wanted before, and what was pressed meanwhile, is void."""
    bench = Bench(nodes(2))
    bench.contact()
    bench.drives[1].start(0x1000)
    bench.run(300_000)
    go_off(bench)
    assert not bench.drives[1].contact or bench.drives[1].stopped_by_engine()
    bench.drives[2].start(0x1000)
    bench.run(500_000)
    sent = len(bench.sent)
    bench.master.on()
    bench.run(3_000_000)
    for address in (1, 2):
        assert bench.drives[address].contact
        assert set(bench.stws(address, sent)) == {pzd.OFF1}
    bench.drives[1].start(0x1000)
    bench.run(300_000)
    assert bench.stws(1)[-1] == pzd.ON


def test_on_waits_until_the_other_one_is_silent():
    bench = Bench(nodes(2))
    bench.contact()
    go_off(bench)
    sent = len(bench.sent)
    bench.master.on()
    for _ in range(100):
        bench.talk(FOREIGN)
        bench.run(60_000)
        assert len(bench.sent) == sent
    assert bench.master.is_line_in_use()
    bench.run(300_000)
    assert len(bench.sent) > sent and not bench.master.is_line_in_use()


def test_on_before_it_was_off_altogether():
    bench = Bench(nodes(3))
    bench.contact()
    bench.drives[2].start(0x1000)
    bench.run(300_000)
    bench.master.off()
    bench.run(10_000)
    bench.master.on()
    sent = len(bench.sent)
    bench.run(3_000_000)
    assert pzd.ON not in bench.stws(2, sent)[2:]
    assert all(drive.contact for drive in bench.master.turns.drives)


def test_off_and_on_again_a_hundred_times():
    bench = Bench(nodes(2))
    bench.contact()
    for _ in range(100):
        go_off(bench)
        bench.master.on()
        bench.run(600_000)
        assert all(drive.contact for drive in bench.master.turns.drives)
    for drive in bench.master.turns.drives:
        assert not any(drive.counters[1:]), drive.counters


def test_a_start_while_it_goes_off_is_not_carried_out():
    """A motor would turn on a bus that nobody looks at."""
    for offset_us in range(0, 80_000, 3_001):
        bench = Bench(nodes(3))
        bench.contact()
        sent = len(bench.sent)
        bench.master.off()
        bench.run(offset_us)
        bench.drives[1].start(0x1000)
        bench.drives[3].start(0, pzd.JOG_LEFT)
        bench.run(1_000_000)
        assert bench.master.phase == OFF
        assert set(bench.stws(1, sent) + bench.stws(3, sent)) <= {pzd.OFF1}, offset_us


def test_off_while_it_listens():
    bench = Bench(nodes(1))
    bench.run(50_000)
    bench.master.off()
    bench.run(3_000_000)
    assert bench.sent == [] and bench.master.phase == OFF
    bench.master.on()
    bench.run(300_000)
    assert bench.drives[1].contact


def test_bus_on_ends_neither_a_pause_nor_leaving_for_good():
    bench = Bench(nodes(2))
    bench.contact()
    bench.master.pause()
    bench.run_until(lambda: bench.master.paused)
    sent = len(bench.sent)
    bench.master.on()
    bench.run(300_000)
    assert bench.master.paused and len(bench.sent) == sent
    bench.master.resume()
    bench.master.close()
    bench.master.on()
    bench.run_until(lambda: bench.master.phase == CLOSED, 6_000_000)
    sent = len(bench.sent)
    bench.run(1_000_000)
    assert len(bench.sent) == sent


# --- another master -----------------------------------------------------------------------------


def test_before_the_first_telegram_another_master_is_listened_to():
    bench = Bench(nodes(2))
    for _ in range(50):
        bench.talk(FOREIGN)
        bench.run(50_000)
    assert bench.sent == [] and bench.master.phase == LISTENING
    assert bench.master.is_line_in_use() and bench.master.foreign >= 50
    bench.run(200_000)
    assert bench.sent and not bench.master.is_line_in_use()


def test_a_spike_is_no_master_for_long():
    bench = Bench(nodes(1))
    bench.run(30_000)
    bench.talk(b"\x00")
    bench.run(80_000)
    assert bench.sent == []
    bench.run(100_000)
    assert bench.sent


def test_another_master_that_comes_later_is_noticed():
    """It talks when this one does not expect anything: it is counted, and said."""
    bench = Bench(nodes(2))
    bench.master.turns.cycle_us = 200_000
    bench.contact()
    before = bench.master.foreign
    for _ in range(30):
        bench.talk(FOREIGN)
        bench.run(97_000)
    assert bench.master.foreign >= before + 5
    assert all(drive.contact for drive in bench.master.turns.drives)


def test_the_head_of_a_request_tells_another_master():
    """STX, LGE and ADR are enough; less is not, nor is what begins no telegram."""
    bench = Bench(nodes(2))
    bench.master.turns.cycle_us = 200_000
    bench.contact()
    for head, foreign in (
        (FOREIGN[:2], 0),
        (FOREIGN[:3], 1),
        (b"\x03" + FOREIGN[1:3], 1),
        (b"\x01" + FOREIGN[1:3], 1),
        (b"\x02\x0f\x09", 1),
        (b"\x02\x02\x09", 1),
        (b"\x02\x04\x09", 2),
        (b"\x02\xfe\x09", 3),
    ):
        sent = len(bench.sent)
        bench.run_until(lambda sent=sent: len(bench.sent) == sent + 2)
        bench.run(60_000)  # the replies are in, and the next round has not begun
        bench.talk(head)
        bench.run(60_000)
        assert bench.master.foreign == foreign, head


def test_a_bus_of_its_own_is_not_taken_for_another_masters():
    bench = Bench(nodes(5), echo=True)
    bench.contact()
    bench.nodes[3].plugged = False
    bench.run(10_000_000)
    assert bench.master.foreign == 0 and not bench.master.is_line_in_use()


def test_a_stop_is_sent_although_another_master_talks():
    """It was not there at first. A motor turns, and it is this master that started it."""
    bench = Bench(nodes(2))
    bench.contact()
    bench.drives[1].start(0x1000)
    bench.run(300_000)
    for _ in range(20):
        bench.talk(FOREIGN)
        bench.run(40_000)
    bench.drives[1].stop()
    for _ in range(20):
        bench.talk(FOREIGN)
        bench.run(40_000)
    assert bench.nodes[1].zsw == 0xFB31


def test_the_dead_man_works_however_the_bus_is_switched():
    bench = Bench(nodes(1))
    bench.contact()
    go_off(bench)
    bench.master.on()
    bench.run(300_000)
    bench.drives[1].start(0x1000)
    bench.run(300_000)
    bench.refreshing = False
    bench.run(DEAD_MAN_US + 100_000)
    assert bench.stws(1)[-1] == pzd.OFF1
