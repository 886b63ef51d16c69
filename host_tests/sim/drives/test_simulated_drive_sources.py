# SPDX-License-Identifier: MIT
"""What gives setpoint and actual value of a simulated drive their meaning, and what it obeys.

P and r numbers are those of the MICROMASTER 4; a connector is number << 16 | index.
"""

from boards.sim.drives.families import g110, g120, mm420, mm440, v20
from drive_bench import HALF, OFF1, RUN, Bench, with_more

COM_ON, COM_SETPOINT = 2036 << 16, 2018 << 16 | 1
TERMINAL, KEYPAD, ALWAYS = 722 << 16, 19 << 16, 1 << 16
AT_ONCE = {1120: 0.0, 1121: 0.0}


def running(parameters=None, family=mm420, hsw=HALF):
    """Frequency at the end of a start from this bus, with ramps of 0 s."""
    bench = Bench(with_more(AT_ONCE, parameters), family=family)
    bench.control(OFF1)
    bench.control(RUN, hsw)
    return bench


def test_a_source_that_is_chosen_is_connected_where_the_manual_says():
    bench = Bench(family=mm440)
    for chosen, number, connector in ((5, 840, COM_ON), (5, 1070, COM_SETPOINT)):
        assert bench.drive.read(700) == chosen and bench.drive.read(number) == connector
    for number, target, table in (
        (700, 840, {1: KEYPAD, 2: TERMINAL, 4: 2032 << 16, 5: COM_ON}),
        (1000, 1070, {1: 1050 << 16, 2: 755 << 16, 3: 1024 << 16, 15: COM_SETPOINT}),
    ):
        for value, connector in table.items():
            bench.drive.write(number, 2, value)  # a data set of its own
            assert bench.drive.read(target, 2) == connector, (number, value)
            assert bench.drive.read(target, 0) == (COM_ON if target == 840 else COM_SETPOINT)


def test_the_connector_goes_where_its_source_goes_ram_or_eeprom():
    bench = Bench({3: 3})
    bench.task(0x2000 | 700, 0, 0, 2)  # by the bus, into RAM
    assert bench.drive.read(840) == TERMINAL
    bench.drive.power_off()
    bench.drive.power_on()
    assert bench.drive.read(700) == 5 and bench.drive.read(840) == COM_ON
    bench.drive.write(700, 0, 2)
    bench.drive.power_off()
    bench.drive.power_on()
    assert bench.drive.read(840) == TERMINAL and bench.drive.eeprom_writes == 1


def test_a_v20_and_a_g120_have_connectors_of_their_own():
    drive = Bench(family=v20).drive
    drive.write(10, 0, 30)
    drive.write(970, 0, 21)
    assert drive.silent
    drive = Bench(family=g120, parameters={15: 12}).drive
    assert (drive.read(840), drive.read(1070)) == (TERMINAL, 755 << 16)
    drive.write(15, 0, 21)
    assert (drive.read(840), drive.read(1070)) == (2090 << 16, 2050 << 16 | 1)
    assert running(family=g120).drive.hz() == 25


def test_on_comes_from_where_p0840_says():
    bench = running({840: TERMINAL})
    assert bench.drive.state == "ready" and bench.drive.starts == 0
    bench.drive.write(840, 0, COM_ON)
    bench.control(OFF1)
    bench.control(RUN, HALF)
    assert bench.drive.state == "running"
    bench.drive.write(840, 0, 2032 << 16)  # the other link, on which nobody talks
    assert bench.drive.state == "ready" and bench.drive.starts == 1
    bench = Bench({840: ALWAYS})
    bench.control(OFF1, HALF)
    assert bench.drive.state == "inhibited"  # an ON that was always there lifts no inhibit


def test_the_setpoint_comes_from_where_p1070_says():
    assert running().drive.hz() == 25
    for connector in (755 << 16, 2015 << 16 | 1, 0, 2018 << 16 | 15, 2018 << 16 | 99):
        assert running({1070: connector}).drive.hz() == 0, connector
    assert running({1070: 1024 << 16, 1001: 12.0}).drive.hz() == 0  # no fixed frequency chosen
    assert running({1070: 1050 << 16, 1040: 7.0}).drive.hz() == 7
    # PZD3, as the main setpoint; P2009 is about PZD2 alone
    bench = Bench(with_more(AT_ONCE, {1070: 2018 << 16 | 2, 2012: 4, 2009: 1}), family=mm440)
    bench.exchange(0, 0, 0, 0, OFF1, 0, 0, 0)
    bench.exchange(0, 0, 0, 0, RUN, HALF, HALF // 2, 0)
    assert bench.drive.hz() == 12.5


def test_p0719_overrides_both():
    for selection, state, hz in ((0, "running", 25), (55, "running", 25), (50, "running", 25),
                                 (5, "running", 25), (1, "running", 5), (2, "running", 0),
                                 (10, "ready", 0), (45, "inhibited", 0)):  # fmt: skip
        bench = running({719: selection})
        assert (bench.drive.state, bench.drive.hz()) == (state, hz), selection
    bench = running({700: 2, 1000: 2, 719: 55})
    assert bench.drive.state == "running" and bench.drive.hz() == 25


def test_the_pid_controller_takes_the_place_of_the_main_setpoint():
    assert running({2200: ALWAYS}, mm440).drive.hz() == 0  # its own setpoint is open
    quarter = HALF // 4
    bench = running({2200: ALWAYS, 2253: COM_SETPOINT, 2280: 2.0}, mm440, quarter)
    assert bench.drive.hz() == 12.5  # 12.5 % twice
    bench = running({2200: ALWAYS, 2253: COM_SETPOINT, 2291: 40.0}, mm440)
    assert bench.drive.hz() == 20
    bench = running({2200: 2036 << 16 | 15}, mm440)
    assert bench.drive.hz() == 25
    bench.control(RUN | 0x8000, HALF)
    assert bench.drive.hz() == 0
    assert 2200 not in [row[0] for row in g110.ROWS]


def test_what_is_sent_is_what_stands_in_p2019():
    bench = running({(2019, 1): 0})
    assert bench.control(RUN, HALF) == (0xFB34, 0) and bench.drive.hz() == 25
    bench = running({(2019, 1): 20 << 16, 1120: 10.0})
    assert bench.control(RUN, HALF)[1] == HALF  # the setpoint, not what the motor does
    bench = running({2009: 1}, hsw=1000)
    assert bench.control(RUN, 1000)[1] == 1000 and bench.drive.hz() == 10
    bench = running({2000: 25.0, 1082: 50.0})
    assert bench.drive.hz() == 12.5


def test_the_command_data_set_that_counts_is_the_one_of_p0810():
    bench = Bench(with_more(AT_ONCE, {(700, 1): 2, (700, 2): 5, (1000, 2): 5}), family=mm440)
    bench.control(OFF1)
    bench.control(RUN, HALF)
    assert bench.drive.hz() == 25 and bench.drive.read(50) == 0
    bench.drive.write(810, 0, ALWAYS)  # P0700[1]: terminals, which say OFF1
    assert bench.drive.read(50) == 1 and bench.drive.state == "ready"
    bench.drive.write(811, 0, ALWAYS)
    assert bench.drive.read(50) == 2 and bench.drive.state == "ready"  # no ON has risen
    bench.control(OFF1)
    bench.control(RUN, HALF)
    assert bench.drive.hz() == 25 and bench.drive.starts == 2


def test_a_bit_of_this_bus_may_choose_the_set_of_commands():
    bench = running({810: 2036 << 16 | 15, (700, 1): 2}, mm440)
    assert bench.drive.state == "running"
    bench.control(RUN | 0x8000, HALF)
    assert bench.drive.read(50) == 1 and bench.drive.state == "ready"
    bench.control(RUN, HALF)
    assert bench.drive.state == "running"  # for the drive ON has risen


def test_another_set_of_the_drive_counts_from_standstill_on():
    more = {(2000, 1): 100.0, (1082, 1): 100.0, (1120, 1): 0.0, (1121, 1): 0.0}
    bench = running(with_more({820: 2036 << 16 | 15}, more), mm440)
    bench.control(RUN | 0x8000, HALF)
    assert [bench.drive.read(51, i) for i in (0, 1)] == [1, 0] and bench.drive.hz() == 25
    bench.control(OFF1 | 0x8000, HALF)
    bench.control(RUN | 0x8000, HALF)
    bench.control(OFF1 | 0x8000, HALF)
    bench.control(RUN | 0x8000, HALF)
    assert [bench.drive.read(51, i) for i in (0, 1)] == [1, 1] and bench.drive.hz() == 50
