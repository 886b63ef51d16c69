# SPDX-License-Identifier: MIT
"""A drive gets another layout, and the engine comes in between any two lines of that, or Ctrl-C.

As in `test_interrupted` for what the loop does besides.
"""

from test_relayout import LAYOUTS, LOST, OLD, bench_of, check_wire, is_whole, relayout

from interruption_bench import interrupted, recovered, thrown
from round_bench import RUNNING
from uss import pkw, pzd
from uss.layout import Layout

INTERPRETERS = "cpython"


def prepared(layout, later_us, stopped, **more):
    """Shortly before its turn, or in the middle of it."""

    def prepare():
        bench = bench_of(layout, **more)
        bench.run_until(lambda: bench.sent[-1].address == LOST)
        bench.run_until(lambda: bench.sent[-1].address != LOST)
        bench.drives[LOST].ask_soon()
        bench.run(later_us)
        if stopped:
            bench.drives[LOST].stop()
        return bench

    return prepare


def test_no_telegram_is_half_old_and_half_new():
    for place, (later_us, more) in enumerate(
        ((1_000, {}), (24_000, {}), (30_000, {"foreseen": True}), (33_000, {"retries": 2}))
    ):
        layout = LAYOUTS[place]
        retries = more.pop("retries", 0)

        def change(bench, layout=layout, retries=retries):
            bench.master.retries = retries
            relayout(bench, layout)

        for stopped in (False, True):
            for bench, _ in interrupted(prepared(layout, later_us, stopped, **more), change):
                drive = bench.drives[LOST]
                returned = len(bench.sent)
                bench.run(150_000)
                assert drive.contact and drive.answered_off(), layout
                assert drive.stops == drive.stops_sent == stopped
                check_wire(bench, layout, 0)
                for telegram in bench.sent[returned:]:
                    assert telegram.address != LOST or is_whole(telegram, layout)
                assert bench.master.failures == 0 and len(bench.master.turns.round) == 3


def test_where_its_exchange_is_about_to_be_repeated():
    """It answered in another length; the start interval after that goes on."""
    layout = LAYOUTS[2]
    for later_us in (18_300, 19_000, 19_400, 19_800):

        def prepare(later_us=later_us):
            bench = bench_of(layout)
            bench.master.retries = 1_000
            sent = len(bench.sent)
            bench.run_until(lambda: LOST in bench.addresses(sent))
            bench.run_to(bench.sent[-1].at + later_us)
            return bench

        for bench, _ in interrupted(prepare, lambda bench: relayout(bench, layout)):
            bench.run(150_000)
            assert bench.drives[LOST].contact
            check_wire(bench, layout, 0)


def test_a_drive_that_answers_at_the_last_moment_keeps_its_layout():
    """It was switched on just now, and has the layout that the bus thought it has."""
    outcomes = set()

    def prepare():
        bench = bench_of(Layout(3, 2))
        bench.run_until(lambda: bench.sent[-1].address == LOST)
        bench.run_until(lambda: bench.sent[-1].address != LOST)
        bench.nodes[LOST].pkw_words = 4
        bench.drives[LOST].ask_soon()
        bench.run_until(lambda: bench.sent[-1].address == LOST)
        bench.run(15_000)
        return bench

    def change(bench):
        try:
            relayout(bench, Layout(4, 4))
        except ValueError:
            outcomes.add("refused")
            assert bench.drives[LOST].contact and bench.drives[LOST].layout.is_like(OLD)
        else:
            outcomes.add("done")
            assert not bench.drives[LOST].contact

    for bench, _ in interrupted(prepare, change):
        drive = bench.drives[LOST]
        sent = len(bench.sent)
        bench.run(150_000)
        assert drive.contact == drive.layout.is_like(OLD)
        for telegram in bench.sent[sent:]:
            assert telegram.address != LOST or is_whole(telegram, drive.layout)
        assert bench.nodes[1].zsw == RUNNING
    assert outcomes == {"refused", "done"}


def test_no_ctrl_c_has_a_telegram_go_out_that_is_half_old():
    """Where it comes in the middle, nobody asks the drive any more; the others go on."""
    prepare = prepared(Layout(3, 2), 1_000, True)

    def with_a_job():
        bench = prepare()
        bench.drives[LOST].ask(pkw.read(700))
        return bench

    left_out = count = 0
    for bench, lines in thrown(with_a_job, lambda bench: relayout(bench, Layout(3, 2))):
        drive = bench.drives[LOST]
        sent = len(bench.sent)
        bench.run(3_000_000)
        asked = [each for each in bench.sent[sent:] if each.address == LOST]
        left_out += lines * (not asked)
        count += lines
        for telegram in asked:
            assert len(telegram.characters) - 4 == drive.layout.net_count
            assert telegram.stw() == pzd.OFF1
        assert bench.nodes[1].zsw == RUNNING and not any(bench.drives[1].counters[1:])
        bench.drives[1].stop()
        bench.run(100_000)
        assert bench.nodes[1].zsw != RUNNING
        bench.master.turns.remove(drive)
    assert 0 < left_out < count // 2, (left_out, count)


def test_an_exception_in_the_engine_meanwhile():
    """Whatever line of it throws in the exchange that is no longer the drive's own."""

    def prepare():
        bench = bench_of(Layout(3, 2))
        bench.run_until(lambda: bench.sent[-1].address == LOST)
        bench.run(5_000)
        relayout(bench, Layout(3, 2))
        return bench

    for bench in recovered(prepare, 40_000):
        sent = len(bench.sent)
        bench.run(300_000)
        assert bench.drives[LOST].contact and bench.drives[1].contact
        for telegram in bench.sent[sent:]:
            assert telegram.address != LOST or is_whole(telegram, Layout(3, 2))
