# SPDX-License-Identifier: MIT
"""The operator's manual: a MICROMASTER 4 that has its USS on the BOP link, `mm440-bop`.

All numbers of the link have two indices: 0 is that of the RS-485 terminals, 1 that of this link.
"""

from kind_bench import panel_of
from panel_bench import page_back, row_1, row_2, starts

KINDS = ("mm420-bop", "mm440-bop/127+4")
ELSEWHERE = 5  # of P0700 and P1000: the terminals


def wait_for_row_2(world, text, ms=20_000):
    for _ in range(ms // 100):
        if row_2(world).startswith(text):
            return
        world.run(100)
    raise AssertionError((text, world.lcd()))


def test_a_start_is_refused_where_the_other_link_commands():
    for number, value, said in (
        (700, ELSEWHERE, "NO:P0700 NOT USS"),
        (1000, ELSEWHERE, "NO:P1000 NOT USS"),
        (719, 50, "NO:P0719 NOT USS"),
        (840, 2036 << 16, "NO:P0840 NOT USS"),
        (1070, 2018 << 16 | 1, "NO:P1070 NOT USS"),
    ):
        world = panel_of("1=mm440-bop")
        world.drives[1].write(number, 0, value)
        world.run(3000)
        world.press("START")
        world.run(500)
        assert row_2(world) == said and starts(world) == 0, (said, world.lcd())
        world.check()


def test_start_and_set_give_it_to_the_link_that_the_panel_is_on():
    world = panel_of("1=mm440-bop")
    drive = world.drives[1]
    for number in (700, 1000):
        drive.write(number, 0, ELSEWHERE)
    world.run(3000)
    for number in (700, 1000):
        world.press("START")
        world.run(500)
        assert world.reads("P%04d=4" % number), world.lcd()
        world.run(3500)  # until the refusal has left the row that says which keys answer
        world.press("SET")
        world.run(4000)
        assert drive.read(number) == 4 and starts(world) == 0, drive.report()
    world.press("START")
    world.run(4000)
    assert row_2(world) == "RUNNING      A1" and starts(world) == 1, world.lcd()


def test_what_the_other_link_is_set_to_is_no_matter():
    for kind in KINDS:
        world = panel_of("1=" + kind)
        for number, value in ((2009, 1), (2014, 0), (2019, 0), (2011, 9), (2013, 0), (2012, 0)):
            world.drives[1].write(number, 0, value)
        world.run(12_000)
        world.press("START")
        world.run(4000)
        assert row_1(world) == "S: 10.0 F: 10.00", world.lcd()
        assert row_2(world) == "RUNNING      A1" and abs(world.drives[1].hz() - 10) < 0.01
        world.press("STOP")
        world.run(4000)
        assert world.drives[1].hz() == 0
        world.check()


def test_what_it_sends_in_place_of_its_status_is_noticed():
    world = panel_of("1=mm440-bop")
    world.drives[1].write(2016, 0, 21 << 16)
    wait_for_row_2(world, "P2016[0] ???")
    world.press("START")
    world.run(500)
    assert row_2(world) == "NO: P2016[0] ???" and starts(world) == 0, world.lcd()


def test_start_asks_about_its_own_telegram_off_time_and_set_puts_that_right():
    world = panel_of("1=mm440-bop")
    world.drives[1].write(2014, 1, 0)
    world.run(3000)
    world.press("START")
    world.run(1500)
    assert world.reads("P2014=0: IT RUNS") and starts(world) == 0, world.lcd()
    other = world.drives[1].read(2014, 0)
    world.press("SET")
    world.run(1000)
    assert world.drives[1].read(2014, 1) > 0 and world.drives[1].read(2014, 0) == other
    world.press("START")
    world.run(4000)
    assert row_2(world) == "RUNNING      A1"
    world.drives[1].unplug()
    world.run(8000)
    world.drives[1].plug()
    wait_for_row_2(world, "FAULT F0071  A1")


def test_the_parameter_page_shows_and_writes_those_of_its_link():
    world = panel_of("1=mm440-bop", settings={"unsupervised": [1]})
    drive = world.drives[1]
    drive.write(2011, 0, 17)
    world.press("PARAM")
    for text in ("P0700:     4", "P1000:     4", "P2011:     1"):
        world.run(1000)
        assert row_2(world).startswith(text), world.lcd()
        world.press("NEXT")
    world.run(1000)
    assert row_2(world).startswith("r2024:") and not row_2(world).startswith("r2024:     0")
    world.press("PREVIOUS")
    world.run(1000)
    for key in ("EDIT", "UP", "UP", "SET", "SET"):
        world.press(key)
        world.run(300)
    world.run(3000)
    assert (drive.read(2011, 0), drive.read(2011, 1), drive.address) == (17, 3, 3)
    assert row_2(world) == "P2011:     3 A3", world.lcd()
    page_back(world)
    wait_for_row_2(world, "READY        A3")
    assert world.app.settings.kinds == {"3": "mm440-bop"}
    world.check()
