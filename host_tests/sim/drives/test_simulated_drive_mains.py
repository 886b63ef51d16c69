# SPDX-License-Identifier: MIT
"""A simulated drive whose mains fail: DC link, boot, P1210 and P1200.

What P1210 does is that of the MM420 and MM440 operating instructions, "automatic restart".
"""

from boards.sim.drives.families import g120, mm3, mm440
from drive_bench import HALF, OFF1, RUN, Bench, telegram, with_more

FAST = {1120: 0.0}


def running(parameters=None, family=mm440, **switches):
    bench = Bench(with_more(FAST, parameters), family=family, switches=switches)
    bench.control(OFF1)
    bench.control(RUN, HALF)
    assert bench.drive.state == "running"
    return bench


def answer(bench, stw):
    """What it says to that control word, None: nothing."""
    return bench.ask(telegram(1, 0, 0, 0, 0, stw, HALF))


def fail(bench, seconds, stw=RUN):
    """The mains go for so long, and are back; the master goes on with `stw` for 3 s."""
    bench.drive.power_off()
    bench.wait(seconds)
    bench.drive.power_on()
    for _ in range(30):
        answer(bench, stw)
        bench.wait(0.1)


def test_it_says_nothing_while_it_boots():
    for boot_ms in (50, 300, 5000):
        bench = Bench(switches={"boot_ms": boot_ms})
        bench.control(OFF1)
        bench.drive.power_off()
        bench.drive.power_on()
        back_us = bench.clock.now_us
        assert bench.drive.state == "off" and bench.drive.powered
        while answer(bench, OFF1) is None:
            assert bench.clock.now_us - back_us < boot_ms * 1000 + 300_000
        assert bench.clock.now_us - back_us >= boot_ms * 1000
        assert bench.drive.read(2024) == 1  # counted since it has booted


def test_mains_that_go_again_while_it_boots():
    bench = Bench(switches={"boot_ms": 300})
    for _ in range(3):
        bench.drive.power_off()
        bench.drive.power_on()
        bench.wait(0.2)
    assert bench.drive.state == "off"
    bench.wait(0.2)
    assert bench.drive.state == "inhibited"


def test_the_dc_link_carries_a_short_dip():
    bench = running(buffered_ms=20, dark_ms=300)
    fail(bench, 0.019)
    assert bench.drive.state == "running" and bench.drive.starts == 1
    assert bench.drive.read(947) == 0 and bench.drive.read(1120) == 0.0


def test_a_longer_one_is_an_undervoltage_and_leaves_the_electronics_alive():
    bench = running(buffered_ms=20, dark_ms=300, boot_ms=2000)
    bench.drive.power_off()
    bench.wait(0.1)
    zsw, _ = bench.control(RUN, HALF)
    assert zsw & 0x08 and bench.drive.read(947) == 3
    bench.control(0x04FE)
    assert bench.drive.state == "fault"  # as long as there is no voltage
    bench.drive.power_on()
    assert bench.control(OFF1)[0] & 0x08
    bench.control(0x04FE)
    bench.control(OFF1)
    assert bench.drive.state == "ready" and bench.drive.starts == 1


def test_a_motor_that_stands_has_no_undervoltage():
    bench = Bench(switches={"buffered_ms": 20, "dark_ms": 300})
    bench.control(OFF1)
    fail(bench, 0.2, OFF1)
    assert bench.drive.state == "ready" and bench.drive.read(947) == 0


def test_a_longer_one_still_is_a_power_up():
    bench = running({1121: 7.0}, buffered_ms=20, dark_ms=300)
    bench.task(0xE461, 0, 0, 0)  # a change in RAM alone is not kept, whatever it was
    bench.drive.power_off()
    bench.wait(0.33)
    assert answer(bench, RUN) is None and bench.drive.state == "off"
    bench.drive.power_on()
    assert bench.control(RUN, HALF)[0] & 0x40


def test_automatic_restart():
    # P1210: whether it runs again after a brownout, after a blackout; and the fault that is left.
    for mode, brownout, blackout, left in (
        (0, False, False, (3, 3)),
        (1, False, False, (3, 0)),
        (2, False, True, (3, 0)),
        (3, True, True, (0, 0)),
        (4, True, True, (0, 0)),
        (5, False, True, (3, 0)),
        (6, True, True, (0, 0)),
    ):
        for seconds, restarts, fault in ((0.1, brownout, left[0]), (0.6, blackout, left[1])):
            bench = running({1210: mode}, dark_ms=300)
            fail(bench, seconds)
            case = (mode, seconds)
            assert bench.drive.starts == (2 if restarts else 1), case
            assert (bench.drive.state == "running") == restarts, case
            assert bench.drive.read(947) == fault, case


def test_it_restarts_for_an_on_that_stands_alone():
    for mode in (2, 6):
        bench = running({1210: mode})
        fail(bench, 0.6, OFF1)
        assert bench.drive.starts == 1 and bench.drive.state == "ready"
        for _ in range(3):
            bench.control(OFF1)
        bench.control(RUN, HALF)
        assert bench.drive.starts == 2  # a new ON as ever
    bench = running({1210: 6}, bus_restart=False)
    fail(bench, 0.6)
    assert bench.drive.starts == 1 and bench.drive.state == "inhibited"


def test_without_a_fault_two_five_and_six_start_it_after_a_blackout():
    for mode in range(7):
        bench = Bench({1210: mode})
        bench.control(OFF1)
        fail(bench, 1.0)
        assert bench.drive.starts == (1 if mode in (2, 5, 6) else 0), mode


def test_a_cause_that_lasts_keeps_it_from_restarting():
    bench = running({1210: 6})
    bench.drive.fault(11, lasting=True)
    fail(bench, 1.0)
    assert bench.drive.state == "fault" and bench.drive.starts == 1


def test_other_families():
    bench = Bench({93: 0}, family=mm3)
    bench.drive.fault(2)
    bench.drive.power_off()
    bench.drive.power_on()
    assert bench.drive.state == "inhibited"  # the power acknowledges
    for mode, starts in ((0, 1), (1, 1), (4, 2), (6, 2)):
        bench = running({1210: mode, 2023: 4}, g120)
        fail(bench, 0.6)
        assert bench.drive.starts == starts, mode


def test_clean_power_up_starts_for_a_master_that_goes_on_with_on():
    """What P1210 = 1, as delivered, does not prevent: ON rises against a clean image."""
    bench = running(clean_power_up=True)
    fail(bench, 0.6)
    assert bench.drive.starts == 2 and bench.drive.state == "running"


def test_flying_start():
    # P1200; after what it coasts; whether a motor that turns to the right is caught, which is
    # started to the right, and to the left.
    def off2(bench):
        bench.control(0x047C)
        bench.control(OFF1)

    def trips(bench):
        bench.drive.fault(1)
        bench.control(0x04FE)
        bench.control(OFF1)

    def mains(bench):
        bench.drive.power_off()
        bench.drive.power_on()
        bench.control(OFF1)

    def pulses(bench):
        bench.control(0x0476)
        bench.control(OFF1)

    ways = (off2, trips, mains, pulses)
    for setting, right, left in (
        (0, (), ()),
        (1, ways, ways),
        (2, (off2, trips, mains), (off2, trips, mains)),
        (3, (off2, trips), (off2, trips)),
        (4, ways, ()),
        (5, (off2, trips, mains), ()),
        (6, (off2, trips), ()),
    ):
        for way in ways:
            for stw, caught in ((RUN, right), (0x0C7F, left)):
                bench = running({1200: setting, 1120: 10.0, 1121: 10.0})
                bench.wait(6)
                way(bench)
                before_hz = bench.drive.hz()
                assert before_hz > 20
                bench.control(stw, HALF)
                close = abs(bench.drive.hz() - before_hz) < 2
                assert close == (way in caught), (setting, way, stw, bench.drive.hz())
