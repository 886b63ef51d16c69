# SPDX-License-Identifier: MIT
"""The operator's manual, other drives: families and layouts that the settings name.

A kind is written as --drives has it: g110, or mm440/4+4 with the PKW and PZD words.
"""

from boards.sim.drives.families import mm440
from boards.sim.drives.kinds import listed_drives, simulated
from kind_bench import is_untold, panel_of, start
from panel_bench import row_1, row_2, starts, switched_on, wait_until_known

HERTZ = (
    "mm420", "mm440", "mm440/127", "mm420/4+4", "mm440/4+8", "g110", "g110/4", "v20", "v20/4+6",
    "mm3", "mm440-bop", "mm420-bop/127", "mm440-bop/4+4",
)  # fmt: skip
# Without a parameter channel, with words alone, with a reference in 1/min, or nothing known.
PERCENT = (
    "mm420/0", "mm440/0+4", "mm420/3", "mm440-bop/0", "mm420-bop/3", "g110/0", "v20/3", "g120",
    "g120/0", "g120/4", "generic", "generic/0", "generic/127+3",
)  # fmt: skip


def test_every_family_in_every_layout_runs_turns_round_trips_and_stops():
    for kind in HERTZ + PERCENT:
        world = panel_of("1=" + kind)
        drive, unit = world.drives[1], "%" if kind in PERCENT else " "
        assert row_1(world) == "S: 10.0%sF:  0.00" % unit, (kind, world.lcd())
        start(world, kind)
        assert row_1(world) == "S: 10.0%sF: 10.00" % unit, (kind, world.lcd())
        assert row_2(world) == "RUNNING      A1" and drive.state == "running", (kind, world.lcd())
        world.press("REVERSE")
        world.run(5000)
        assert row_1(world) == "S:-10.0%sF:-10.00" % unit, (kind, world.lcd())
        assert drive.hz() < -4 and starts(world) == 1, kind
        drive.fault(1)
        world.run(2500)
        assert row_2(world).startswith("FAULT") and drive.hz() == 0, (kind, world.lcd())
        world.press("STOP")
        world.run(3000)
        assert row_2(world) == "READY        A1", (kind, world.lcd())
        world.press("REVERSE")
        world.press("START")  # what was accepted stays so
        world.run(4000)
        assert drive.hz() > 4 and starts(world) == 2, (kind, drive.report())
        world.press("STOP")
        world.run(8000)
        assert drive.hz() == 0 and row_2(world) == "READY        A1", (kind, world.lcd())
        world.check()


def test_a_drive_with_short_telegrams_runs_and_shows_its_parameters():
    kinds = {1: {"family": mm440, "parameters": {2013: 127, 2014: 2_000}}}
    world = switched_on(kinds=kinds, settings={"kinds": {"1": "mm440/127s"}})
    world.run(1000)
    wait_until_known(world)
    world.press("START")
    world.run(5000)
    assert world.lcd() == ("S: 10.0 F: 10.00", "RUNNING      A1 "), world.lcd()
    lengths = {len(telegram) for _, _, telegram in world.wire.log.last(20)}
    assert 8 in lengths, lengths
    world.press("STOP")
    world.run(8000)
    assert world.drives[1].hz() == 0 and row_2(world) == "READY        A1", world.lcd()
    world.check()


def test_a_drive_jogs_if_its_family_can():
    for kind in ("mm440/0", "g110", "v20", "mm3", "mm420/3"):
        world = panel_of("1=" + kind)
        if is_untold(kind):  # nobody can tell whether it would stop if the panel died
            world.press("JOG_LEFT")
            assert row_2(world) == "NO JOG: P2014=0", (kind, world.lcd())
            start(world, kind)
            world.press("STOP")
            world.run(4000)
        world.down("JOG_LEFT")
        world.run(2000)
        assert row_2(world) == "JOG LEFT     A1" and world.drives[1].hz() < 0, (kind, world.lcd())
        world.up("JOG_LEFT")
        world.run(4000)
        assert world.drives[1].hz() == 0
        world.check()
    for kind in ("g120", "generic"):
        world = panel_of("1=" + kind)
        world.down("JOG_RIGHT")
        world.run(500)
        assert row_2(world) == "NO: HAS NO JOG" and starts(world) == 0
        world.up("JOG_RIGHT")
        world.check()


def test_a_fault_has_as_many_digits_as_the_manual_of_the_family():
    for kind, number, text in (
        ("mm440", 1, "FAULT F0001  A1"),
        ("mm3", 8, "FAULT F008   A1"),
        ("v20", 72, "FAULT F72    A1"),
        ("g120", 1910, "FAULT F01910 A1"),
        ("generic", 5, "FAULT        A1"),  # nobody knows the parameter that has it
        ("mm420/0", 5, "FAULT        A1"),  # no channel to ask by
    ):
        world = panel_of("1=" + kind)
        world.drives[1].fault(number)
        world.run(2000)
        assert row_2(world) == text, (kind, world.lcd())


def test_the_texts_name_the_parameters_of_the_family():
    world = panel_of("1=mm3")
    world.drives[1].write(93, 0, 0)
    world.run(3000)
    world.press("START")
    world.run(1500)
    assert world.reads("P0093=0: IT RUNS") and starts(world) == 0, world.lcd()
    world.press("SET")  # the panel writes a time, in this family's unit, which is a second
    world.run(1000)
    assert world.drives[1].read(93) in (1, 2), world.drives[1].read(93)
    world.press("START")
    world.run(4000)
    assert row_2(world) == "RUNNING      A1"
    world.drives[1].write(910, 0, 0)
    world.run(12_000)
    world.press("STOP")
    world.run(3000)
    world.press("START")
    world.run(500)
    assert row_2(world) == "NO:P0910 NOT USS", world.lcd()


def test_the_parameter_page_shows_what_the_family_has():
    for kind, rows in (
        ("mm440", ("P0700:     5", "P1000:     5", "P2011:     1")),
        ("mm3", ("P0910:     1", "P0091:     1")),
        ("g120", ("P2021:     1", "P2040:")),
        ("generic", ("NO PARAMETERS",)),
        ("mm440/0", ("NO PARAMETERS",)),
    ):
        world = panel_of("1=" + kind)
        world.press("PARAM")
        for text in rows:
            world.run(1000)
            assert row_2(world).startswith(text), (kind, world.lcd())
            world.press("NEXT")
        for key in ("EDIT", "UP", "SET", "PREVIOUS"):
            world.press(key)
            world.run(300)
        world.check()


def test_no_telegram_off_time_is_chosen_that_trips_the_drive():
    """p2040 of a G120: 0, or what fits this bus."""
    world = panel_of("1=g120")
    drive = world.drives[1]
    before = drive.read(2040)
    assert before > 1000
    world.press("PARAM")
    world.press("NEXT")
    world.run(1500)
    assert row_2(world).startswith("P2040:"), world.lcd()
    world.press("EDIT")
    seen = [before]
    world.down("DOWN")
    while seen[-1] and len(seen) < 500:
        world.run(50)
        seen.append(int(row_2(world)[6:12]))
    world.up("DOWN")
    assert len(seen) > 10 and not [one for one in seen if one and one < 1000], seen
    assert seen[-1] == 0
    world.press("UP")
    world.run(200)
    assert row_2(world).startswith("P2040:  1000"), world.lcd()
    for key in ("UP", "DOWN"):  # and down again to the shortest, not past it
        world.press(key)
        world.run(200)
    assert row_2(world).startswith("P2040:  1000"), world.lcd()
    world.press("SET")
    world.run(500)
    world.press("SET")
    world.run(4000)
    assert drive.read(2040) == 1000 and drive.state == "ready", drive.report()
    world.check()


def test_a_limit_in_rpm_is_kept_in_percent():
    world = panel_of("1=g120", settings={"setpoint_centihertz": 9000})
    drive = world.drives[1]
    assert row_1(world).startswith("S: 90.0%"), world.lcd()
    drive.write(1082, 0, drive.read(2000) / 2)
    world.run(5000)
    assert row_1(world).startswith("S: 50.0%"), world.lcd()


def test_a_setpoint_that_is_absolute_is_no_percentage():
    """With P2009 = 1 HSW is in 0.01 Hz. Three PKW words tell that, but no reference."""
    world = panel_of("1=mm420/3")
    world.drives[1].write(2009, 0, 1)
    world.run(15_000)
    world.press("START")
    world.run(500)
    assert row_2(world) == "NO: SCALING ???" and starts(world) == 0, world.lcd()


def test_drives_of_several_families_stand_in_one_list():
    world = panel_of("1,2=g110,3=mm3,4=g120,5=generic")
    for _ in range(5):
        wait_until_known(world)
        address = int(row_2(world)[-1])
        start(world, "generic" if address == 5 else "", address)
        assert world.drives[address].state == "running", world.lcd()
        world.press("ADDRESS_UP")
        world.run(2000)
    assert all(drive.state == "running" for drive in world.drives.values())
    world.down("STOP")
    world.run(4500)
    world.up("STOP")
    world.run(8000)
    assert all(drive.hz() == 0 for drive in world.drives.values())
    world.check()


def test_a_drive_of_another_layout_than_the_settings_say_is_found():
    """The panel tries the others with telegrams that no drive obeys, and keeps what it finds."""
    for kind in ("mm440/127", "mm440/3", "mm440/0", "mm440/4"):
        world = switched_on([2], kinds=simulated(listed_drives("2=" + kind)))
        world.run(6000)
        assert row_2(world) == "READY        A2", (kind, world.lcd())
        found = {} if kind.endswith("/4") else {"2": kind.replace("mm440", "mm420")}
        assert world.app.settings.kinds == found and starts(world, 2) == 0
        world.reset()
        world.run(1500)
        assert row_2(world) == "READY        A2", (kind, world.lcd())
        world.check()


def test_a_drive_of_other_pzd_words_than_the_settings_say_is_found():
    for real, told in (
        ("mm440/4+4", "mm440"),
        ("mm440/127+4", "mm440"),
        ("mm440/0+4", "mm440/0"),
        ("mm440-bop/4+8", "mm440-bop"),
    ):
        found_as_it_is(real, told)


def test_a_drive_whose_answers_make_no_sense_is_asked_for_its_layout():
    """It answers in the length that the settings say, or in any, and is divided differently."""
    for real, told in (
        ("mm440/3", "mm440/127"),
        ("mm440/127+4", "mm440/127"),
        ("mm440/127+5", "mm440/127"),
        ("mm440/3+3", "mm440"),
        ("mm440/0+6", "mm440"),
        ("mm440-bop/3", "mm440-bop/127"),
    ):
        found_as_it_is(real, told)


def found_as_it_is(real, told):
    """A panel whose settings say `told`, on a line with a drive that is `real`."""
    settings = {"kinds": {"1": told}}
    world = switched_on([1], kinds=simulated(listed_drives("1=" + real)), settings=settings)
    for _ in range(250):
        world.run(100)
        if row_2(world) == "READY        A1" and world.app.settings.kinds == {"1": real}:
            break
    assert world.app.settings.kinds == {"1": real}, (real, told, world.lcd())
    wait_until_known(world)
    start(world, real)
    assert row_2(world) == "RUNNING      A1" and world.drives[1].hz() > 4, (real, world.lcd())
    world.press("STOP")
    world.run(4000)
    assert world.drives[1].hz() == 0 and starts(world) == 1
    world.check()


def test_a_drive_whose_layout_is_changed_while_it_runs_is_found_and_stopped():
    world = panel_of("1=mm440")
    start(world, "")
    world.drives[1].write(2013, 0, 127)
    seen = set()
    for _ in range(80):
        world.run(100)
        seen.add(" ".join(" ".join(world.lcd()).split()))
    assert any("MAY RUN" in rows for rows in seen), seen
    assert world.drives[1].hz() == 0 and starts(world) == 1, world.lcd()
    assert row_2(world) == "LINE FAILED  A1", world.lcd()
    world.check()
