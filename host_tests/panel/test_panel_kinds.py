# SPDX-License-Identifier: MIT
"""The operator's manual: START, STOP, a trip and its acknowledgement, on a drive of every family,
in every layout that it has, on every link that it has.
"""

from kind_bench import panel_of, start
from panel_bench import row_1, row_2, starts

EVERY_PKW = (0, 3, 4, 127)

# Family: its links, its PKW words, and how it tells the number of a trip, for F0001 or the like.
FAMILIES = {
    "mm3": (("",), (3,), "F001"),
    "mm420": (("", "-bop"), EVERY_PKW, "F0001"),
    "mm440": (("", "-bop"), EVERY_PKW, "F0001"),
    "g110": (("",), EVERY_PKW, "F0001"),
    "v20": (("",), EVERY_PKW, "F1"),
    "g120": (("",), EVERY_PKW, "F00001"),
    "generic": (("",), EVERY_PKW, ""),  # nobody knows the parameter that has it
}

# What the drive tells its reference frequency in, so that the panel shows hertz.
HERTZ = {"mm3": (3,), "mm420": (4, 127), "mm440": (4, 127), "g110": (4, 127), "v20": (4, 127)}


def kinds_of(family):
    """(kind, unit that it is shown in, how its trip reads) of each layout and link."""
    links, pkw_words, fault = FAMILIES[family]
    for link in links:
        for words in pkw_words:
            unit = " " if words in HERTZ.get(family, ()) else "%"
            yield "%s%s/%d" % (family, link, words), unit, fault if words else ""


def check(family):
    tried = 0
    for kind, unit, fault in kinds_of(family):
        tried += 1
        world = panel_of("1=" + kind)
        drive = world.drives[1]
        whole_hz = drive.process.reference_hz if unit == "%" else 100
        start(world, kind)
        assert row_1(world) == "S: 10.0%sF: 10.00" % unit, (kind, world.lcd())
        assert row_2(world) == "RUNNING      A1" and starts(world) == 1, (kind, world.lcd())
        assert abs(drive.hz() - whole_hz / 10) < 0.02, (kind, drive.report())
        world.press("STOP")
        world.run(4000)
        assert row_2(world) == "READY        A1" and drive.hz() == 0, (kind, world.lcd())
        world.press("START")  # what was accepted stays so
        world.run(4000)
        assert drive.state == "running" and starts(world) == 2, (kind, drive.report())
        drive.fault(1)
        world.run(2500)
        shown = ("FAULT %s" % fault).rstrip()
        assert row_2(world)[:13].rstrip() == shown, (kind, world.lcd())
        world.press("START")
        world.run(500)
        assert row_2(world) == "NO: FAULT" and starts(world) == 2, (kind, world.lcd())
        world.run(4000)
        world.press("STOP")
        world.run(3000)
        assert row_2(world) == "READY        A1" and drive.state == "ready", (kind, world.lcd())
        assert drive.hz() == 0 and starts(world) == 2, (kind, drive.report())
        world.check()
    assert tried == len(FAMILIES[family][0]) * len(FAMILIES[family][1])


def test_mm3():
    check("mm3")


def test_mm420():
    check("mm420")


def test_mm440():
    check("mm440")


def test_g110():
    check("g110")


def test_v20():
    check("v20")


def test_g120():
    check("g120")


def test_generic():
    check("generic")
