# SPDX-License-Identifier: MIT
"""A simulated MICROMASTER 4 that has its USS on the BOP link, index 1 of the link's numbers."""

from boards.sim.drives.families import named
from boards.sim.drives.kinds import expected, listed_drives, simulated, text_of
from drive_bench import HALF, OFF1, RUN, Bench, telegram, with_more

COMMAND, SETPOINT = 2032 << 16, 2015 << 16 | 1
AT_ONCE = {1120: 0.0, 1121: 0.0}


def bench(name="mm440-bop", parameters=None, **more):
    return Bench(with_more(AT_ONCE, parameters), family=named(name), **more)


def running(**more):
    one = bench(**more)
    one.control(OFF1)
    one.control(RUN, HALF)
    return one


def test_it_is_set_up_on_the_other_index_and_obeys():
    for name in ("mm420-bop", "mm440-bop"):
        one = running(name=name)
        drive = one.drive
        assert drive.hz() == 25 and drive.address == 1 and drive.layout == (4, 2)
        assert [drive.read(number) for number in (700, 1000, 840, 1070)] == [
            4, 4, COMMAND, SETPOINT
        ]  # fmt: skip
        assert (drive.read(2011, 1), drive.read(2011, 0)) == (1, 0)
        assert (drive.read(2015, 0), drive.read(2015, 1)) == (RUN, HALF)
        assert (drive.read(2018, 0), drive.read(2036), drive.read(2032)) == (0, 0, RUN)
        assert drive.read(2024, 1) == 2 and drive.read(2024, 0) == 0


def test_the_terminals_numbers_change_nothing():
    one = running()
    for number, value in ((2009, 1), (2010, 9), (2011, 5), (2012, 4), (2013, 0), (2014, 1)):
        one.drive.write(number, 0, value)
    one.wait(0.05)
    assert one.control(RUN, HALF // 2)[1] == HALF // 2 and one.drive.hz() == 12.5
    one.drive.write(2011, 1, 5)
    assert one.ask(telegram(1, 0, 0, 0, 0, OFF1, 0)) is None
    assert one.ask(telegram(5, 0, 0, 0, 0, OFF1, 0))


def test_it_obeys_as_its_sources_say():
    for number, value in ((700, 5), (840, 2036 << 16), (719, 50), (700, 2)):
        one = bench(parameters={number: value})
        one.control(OFF1)
        one.control(RUN, HALF)
        assert one.drive.hz() == 0, number
    for number, value, hz in (
        (1000, 5, 0), (1070, 2018 << 16 | 1, 0), (719, 5, 0), (719, 44, 25), (719, 4, 25),
        (1000, 44, 50), (1000, 54, 25),
    ):  # fmt: skip
        one = bench(parameters={number: value})
        one.control(OFF1)
        one.control(RUN, HALF)
        assert one.drive.hz() == hz, (number, value)


def test_what_it_sends_is_that_of_its_own_link():
    one = running(parameters={(2016, 1): 20 << 16, (2019, 1): 0})
    assert one.control(RUN, HALF)[1] == HALF
    one.drive.write(2016, 1, 0)
    assert one.control(RUN, HALF)[1] == 0


def test_it_supervises_its_own_link_and_trips_with_a_number_of_its_own():
    one = running(parameters={(2014, 0): 100})
    one.wait(1)
    assert one.drive.state == "running"
    one = running(parameters={(2014, 1): 100})
    one.wait(1)
    assert one.drive.state == "fault" and one.drive.read(947) == 71


def test_hertz_instead_of_parts_by_the_other_index():
    one = bench(parameters={(2009, 1): 1})
    one.control(OFF1)
    one.control(RUN, 1234)
    assert one.drive.hz() == 12.34


def test_another_bit_of_p0927_lets_it_change_parameters():
    for mask, may in ((4, True), (8, False), (15, True)):
        one = bench(parameters={927: mask})
        assert (one.task(0x2000 | 700, 0, 0, 2)[0] == 0x1000 | 700) == may, mask


def test_a_list_names_it():
    listed = listed_drives("1=mm440-bop,2=mm420-bop/127+4,3=mm440-bop/factory,4=mm440")
    assert text_of(listed) == "1=mm440-bop,2=mm420-bop/127+4,3=mm440-bop/factory,4=mm440"
    assert expected(listed) == {"1": "mm440-bop", "2": "mm420-bop/127+4", "4": "mm440"}
    kinds = simulated(listed)
    drive = Bench(address=2, **kinds[2]).drive
    assert drive.layout == (127, 4) and drive.read(2013, 1) == 127 and drive.read(2012, 0) == 2
    drive = Bench(address=3, baud=9600, **kinds[3]).drive
    assert (drive.address, drive.layout, drive.read(700)) == (0, (127, 2), 2)
    for text, said in (
        ("1=v20-bop", "a SINAMICS V20 has no BOP link"),
        ("1=bop-bop", "no family bop-bop: there are mm420 "),
        ("1=mm420-bop/4+5", "a MICROMASTER 420 has 2...4 PZD words"),
    ):
        try:
            listed_drives(text)
        except ValueError as error:
            assert said in str(error), error
        else:
            raise AssertionError(text)
