# SPDX-License-Identifier: MIT
"""The drives that a command line names: 1,2=g110,3=v20/4,7=mm440/4+4,8=mm420/factory."""

from boards.sim.drives.families import NAMES, g110, g120, mm3, mm420, mm440, named, v20
from boards.sim.drives.kinds import (
    as_delivered,
    expected,
    knowing,
    listed_drives,
    simulated,
    text_of,
)
from drive_bench import OFF1, Bench, telegram

ALL = "1,2=g110,3=v20/4,7=mm440/4+4,8=mm420/factory"


def refused(text, **more):
    try:
        listed_drives(text, **more)
    except ValueError as error:
        return str(error)
    raise AssertionError("%s is none" % text)


# --- what is written ----------------------------------------------------------------------------


def test_an_address_alone_is_a_plain_drive():
    assert simulated(listed_drives("1,31")) == {1: {"family": mm420}, 31: {"family": mm420}}
    assert expected(listed_drives("1,31")) == {}
    assert simulated(listed_drives("4", usual="v20")) == {4: {"family": v20}}


def test_family_layout_and_factory_are_understood():
    assert simulated(listed_drives(ALL)) == {
        1: {"family": mm420},
        2: {"family": g110},
        3: {"family": v20, "layout": (4, 2)},
        7: {"family": mm440, "layout": (4, 4)},
        8: {"family": mm420, "factory": True},
    }
    assert text_of(listed_drives(ALL)) == ALL
    for name in NAMES:
        assert simulated(listed_drives("3=" + name.upper())) == {3: {"family": named(name)}}


def test_the_panel_is_told_of_each_but_plain_ones_and_those_as_delivered():
    assert expected(listed_drives(ALL)) == {"2": "g110", "3": "v20/4", "7": "mm440/4+4"}


def test_the_usual_layout_is_left_out():
    for text, short in (
        ("1=mm420/4", "1=mm420"),
        ("1=mm420/4+2", "1=mm420"),
        ("1=g110/127", "1=g110"),
        ("1=g120/127+2", "1=g120"),
        ("1=mm3/3", "1=mm3"),
        ("1=mm440+4", "1=mm440/4+4"),
        ("1=v20+4", "1=v20/127+4"),
        ("1=generic/0+16", "1=generic/0+16"),
        ("1=/127", "1=mm420/127"),
    ):
        assert text_of(listed_drives(text)) == short, text


def test_what_there_cannot_be_is_said_in_one_line():
    for text, said in (
        ("", "nothing is no address 0...31"),
        ("1,", "nothing is no address 0...31"),
        ("x=g110", "x is no address 0...31"),
        ("32", "32 is no address 0...31"),
        ("-1", "-1 is no address 0...31"),
        ("9" * 5000, " is no address 0...31"),
        ("4/127", "4/127 is no address 0...31"),
        ("1,01=g110", "1 stands there twice"),
        ("1=g110,1=v20/factory", "1 stands there twice"),
        ("1=foo", "no family foo: there are mm420 "),
        ("1=mm3/4", "1=mm3/4: a MICROMASTER 3 has 3+2 words"),
        ("1=mm3+4", "1=mm3+4: a MICROMASTER 3 has 3+2 words"),
        ("1=g110/5", "1=g110/5: behind / stand PKW words, 0, 3, 4 or 127, or factory"),
        ("1=g110/", "1=g110/: behind / stand PKW words, 0, 3, 4 or 127, or factory"),
        ("1=g110/4/4", "1=g110/4/4: behind / stand PKW words, 0, 3, 4 or 127, or factory"),
        ("1=g110/4+1", "1=g110/4+1: behind + stand PZD words, 2...16"),
        ("1=g110/4+", "1=g110/4+: behind + stand PZD words, 2...16"),
        ("1=g110/factory+4", "1=g110/factory+4: behind / stand PKW words"),
        ("1=mm420/4+5", "1=mm420/4+5: a MICROMASTER 420 has 2...4 PZD words"),
        ("31=mm3", "31=mm3: a MICROMASTER 3 has addresses 0...30"),
    ):
        told = refused(text)
        assert said in told and "\n" not in told, (text, told)


def test_a_family_that_is_not_simulated_may_be_expected_on_a_real_line():
    names = ("mm420", "fc300")
    listed = listed_drives("1,2=fc300,3=fc300/127", names=names)
    assert expected(listed) == {"2": "fc300", "3": "fc300/127"}
    assert "no family g110: there are mm420 fc300" == refused("1=g110", names=names)


def test_a_rate_that_a_family_does_not_know_is_noticed():
    knowing(listed_drives("1,2=mm3,3=v20"), 9600)
    knowing(listed_drives("1,3=v20/factory"), 2400)  # it stays at its own
    try:
        knowing(listed_drives("1,3=v20"), 2400)
    except ValueError as error:
        assert str(error) == "a SINAMICS V20 has no code for 2400 baud"
    else:
        raise AssertionError("a V20 knows 2400 baud")


# --- what a drive becomes of it -----------------------------------------------------------------


def test_a_drive_has_the_layout_that_was_asked_for():
    for name in NAMES:
        family = named(name)
        fixed = family.LINK["layout"]
        for layout in (fixed,) if fixed else ((0, 2), (3, 2), (4, 2), (127, 2), (4, 4)):
            assert Bench(family=family, layout=layout).drive.layout == layout, (name, layout)
    assert Bench({2013: 3}, layout=(4, 4)).drive.layout == (3, 4)
    try:
        Bench(family=mm3, layout=(4, 2))
    except ValueError as error:
        assert str(error) == "a MICROMASTER 3 has 3+2 words"
    else:
        raise AssertionError("a MICROMASTER 3 with 4 PKW words")


# What the families' manuals say of the link as delivered: address, rate, PKW and PZD words.
DELIVERED = (
    (mm420, 0, 9600, (127, 2)),
    (mm440, 0, 9600, (127, 2)),
    (g110, 0, 9600, (127, 2)),
    (mm3, 0, 9600, (3, 2)),
    (v20, 1, 38400, (127, 2)),
    (g120, 0, 38400, (127, 2)),
)


def asking(address, layout):
    """A telegram that a drive with this layout answers."""
    return telegram(address, *[0] * min(layout[0], 4), OFF1, 0)


def test_a_drive_as_delivered_answers_as_its_family_does():
    for family, address, baud, layout in DELIVERED:
        bench = Bench(address=8, family=family, baud=baud, factory=True)
        drive = bench.drive
        assert (drive.address, drive.slave.baud, drive.layout) == (address, baud, layout)
        assert drive.factory and drive.name == "drive 8" and not drive.parameters.eeprom_writes
        assert bench.ask(asking(address, layout)), family.NAME
        assert as_delivered({8: drive}, baud) == [
            "drive 8 is as delivered: it answers at address %d, at %d baud" % (address, baud)
        ]
        command, setpoint = drive.family.COMMISSIONED.get(700), drive.family.COMMISSIONED.get(1000)
        if command is not None:
            assert drive.read(700) != command and drive.read(1000) != setpoint


def test_at_another_rate_it_hears_noise_and_says_nothing():
    for family, address, baud, layout in DELIVERED:
        for other in (1200, 19200):  # some families do not know it
            bench = Bench(address=8, family=family, baud=other, factory=True)
            for count in range(1, 6):
                bench.wait(0.05)
                assert bench.ask(asking(address, layout)) is None, (family.NAME, other)
                counters = bench.drive.slave.counters()
                assert counters[0] == 0 and counters[1] == counters[2] == count, family.NAME
            assert as_delivered({8: bench.drive}, other) == [
                "drive 8 is as delivered: it answers at address %d, at %d baud, not %d"
                % (address, baud, other)
            ]


def test_it_answers_once_somebody_has_set_it_up():
    bench = Bench(address=8, factory=True)
    for number, value in ((2013, 4), (2011, 8), (2010, 7)):
        assert bench.ask(telegram(8, 0, 0, 0, 0, OFF1, 0)) is None
        bench.drive.write(number, 0, value)
    assert bench.ask(telegram(8, 0, 0, 0, 0, OFF1, 0))
    assert as_delivered({1: Bench().drive}, 19200) == []
