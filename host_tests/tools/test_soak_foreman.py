# SPDX-License-Identifier: MIT
"""What the judge of a soak knows of the lock, of the list of drives, and of drives that are reset:
by pictures and keys alone."""

import json

from tools.soaking.judging.kept_sets import SETTINGS_FILE
from tools.soaking.judging.rules import Broken
from tools.soaking.soak import Soak

CODE = 4711
HOME = ("S: 10.0 F:  0.00", "READY        A1 ")
MENU, REFUSED = ("MENU       12/14", ">LOCK          "), (HOME[0], "LOCK: HOLD PARAM")
TITLE = "UP DOWN SET=NEXT"


def broken(deed, *arguments):
    """The rule that it breaks, or None."""
    try:
        deed(*arguments)
    except Broken as found:
        return found.args[0]


def locking(is_closed):
    """A judge's `Locked` of a panel that has a code, and its world."""
    soak = Soak(13, drives=1)
    soak.hand.run(2_000)
    locked = soak.judge.witness.locked
    files = soak.world.flash.files
    stored = json.loads(files[SETTINGS_FILE])
    stored["lock_code"] = CODE if is_closed else 0
    files[SETTINGS_FILE] = json.dumps(stored).encode()
    locked.booted(soak.world.clock.now_us)
    locked.code = CODE
    soak.world.run(5_000)
    return locked, soak.world


def give(locked, world, digits):
    for place, digit in enumerate(digits):
        shown = place * "*" + digit
        locked.read((TITLE, ">CODE %-9s" % (shown + (4 - len(shown)) * "_")), world.clock.now_us)
        locked.key("SET", world.clock.now_us)
        world.run(100)


def says(locked, world, text):
    return broken(locked.read, (HOME[0], "%-16s" % text), world.clock.now_us)


def test_a_closed_lock_lets_no_jog_no_reversal_and_no_write_through():
    locked, world = locking(True)
    now = world.clock.now_us
    assert broken(locked.judge_jog, now, "here") == "LOCK"
    assert broken(locked.judge_write, "here", now) == "LOCK"
    assert broken(locked.judge_direction, 1, True, "here", now) is None, "as it was"
    assert broken(locked.judge_direction, 1, True, "here", now) is None
    assert broken(locked.judge_direction, 1, False, "here", now) == "LOCK"


def test_an_open_lock_lets_everything_through():
    locked, world = locking(False)
    now = world.clock.now_us
    assert broken(locked.judge_jog, now, "here") is None
    assert broken(locked.judge_write, "here", now) is None
    for is_left in (True, False):
        assert broken(locked.judge_direction, 1, is_left, "here", now) is None
    assert broken(locked.read, MENU, now) is None


def test_its_code_opens_it_and_no_other_one():
    for digits, text, rule in (
        ("4711", "UNLOCKED", None),
        ("4712", "UNLOCKED", "LOCK"),
        ("4712", "WRONG CODE", None),
        ("4711", "WRONG CODE", "LOCK"),
        ("", "UNLOCKED", "LOCK"),
    ):
        locked, world = locking(True)
        give(locked, world, digits)
        assert says(locked, world, text) == rule, (digits, text)
        if rule is None:
            assert locked.is_closed == (text != "UNLOCKED")


def test_a_digit_that_nobody_has_read_may_be_any():
    for text in ("UNLOCKED", "WRONG CODE"):
        locked, world = locking(True)
        give(locked, world, "471")
        world.run(1_000)
        locked.key("SET", world.clock.now_us)  # NO: IN THE MENU hides the fourth one
        assert says(locked, world, text) is None, text


def test_a_closed_lock_shows_the_page_for_its_code_and_no_other():
    locked, world = locking(True)
    now = world.clock.now_us
    for rows in (
        HOME,
        REFUSED,
        (TITLE, ">CODE **4_     "),
        (TITLE, ">A1: STOP      "),
        (HOME[0], "P2014 LONG   A1 "),
    ):
        assert broken(locked.read, rows, now) is None, rows
    for rows in (
        MENU,
        (TITLE, ">CODE 474_     "),
        ("Ramp-up time    ", "P1120[0]  10.00s"),
        (HOME[0], "P0700:     5 A1 "),
    ):
        assert broken(locked.read, rows, now) == "LOCK", rows


def test_it_closes_when_lock_is_chosen_and_not_otherwise():
    locked, world = locking(False)
    assert broken(locked.read, REFUSED, world.clock.now_us) == "LOCK"
    locked, world = locking(False)
    locked.read(MENU, world.clock.now_us)
    locked.key("SET", world.clock.now_us)
    assert broken(locked.read, REFUSED, world.clock.now_us) is None
    assert locked.is_closed
    locked, world = locking(False)
    locked.read(MENU, world.clock.now_us)
    locked.key("SET", world.clock.now_us)
    assert broken(locked.look, world.clock.now_us) is None
    world.run(5_000)
    assert broken(locked.look, world.clock.now_us) == "LOCK", "and it is not closed"


def arranging():
    """A judge's `Arranged` of three drives that stand, and its soak."""
    soak = Soak(13, drives=3)
    soak.hand.run(15_000)
    soak.hand.press("STOP")
    soak.hand.run(5_000)
    arranged = soak.judge.witness.arranged
    shown(soak, ("MENU        6/14", ">ORDER         "))
    return arranged, soak


def shown(soak, rows):
    soak.hand.run(2_000)
    soak.judge.witness.arranged.read(rows, soak.world.clock.now_us)
    soak.hand.run(100)


def ends(soak, key):
    witness, now = soak.judge.witness, soak.world.clock.now_us
    witness.down[key] = now
    witness.arranged.key(key, now)
    del witness.down[key]


def starts(soak, **stored):
    """The rule that a panel breaks which begins anew with these settings, or None."""
    files = soak.world.flash.files
    files[SETTINGS_FILE] = json.dumps(dict(json.loads(files[SETTINGS_FILE]), **stored)).encode()
    return broken(soak.judge.witness.arranged.booted, True)


def carried(soak):
    """The second one is carried to the third place. Returns the order then."""
    first, second, third = soak.judge.witness.arranged.order
    shown(soak, ("ORDER        1/3", ">A%-14d" % first))
    shown(soak, ("SET=KEEP     3/3", ">A%-14s" % ("%d  UP DOWN" % second)))
    return [first, third, second]


def test_the_panel_begins_with_the_order_that_was_kept():
    arranged, soak = arranging()
    order, before = carried(soak), list(arranged.order)
    ends(soak, "PARAM")
    assert starts(soak, drives=order) is None
    assert arranged.order == order
    assert starts(soak, drives=before) == "LIST", "nobody kept that"


def test_an_order_that_was_kept_is_there_before_long():
    arranged, soak = arranging()
    carried(soak)
    ends(soak, "PARAM")
    assert broken(arranged.look, soak.world.clock.now_us) is None
    assert broken(arranged.look, soak.world.clock.now_us + 20_000_000) == "LIST"
    assert starts(soak) is None, "that was said"


def test_the_panel_that_refuses_an_order_may_leave_it_as_it_is():
    arranged, soak = arranging()
    carried(soak)
    ends(soak, "PARAM")
    shown(soak, (HOME[0], "STOP ALL FIRST  "))
    assert broken(arranged.look, soak.world.clock.now_us + 20_000_000) is None


def test_an_order_that_nobody_could_read_may_be_any():
    arranged, soak = arranging()
    order = carried(soak)
    shown(soak, ("A3 RUN,HOLD=ALL ", ">A%-14s" % ("%d  UP DOWN" % order[0])))
    ends(soak, "PARAM")
    assert broken(arranged.look, soak.world.clock.now_us + 20_000_000) is None
    assert starts(soak, drives=order[::-1]) is None


def test_the_panel_begins_with_the_turns_that_were_kept():
    arranged, soak = arranging()
    first, second, third = arranged.order
    shown(soak, ("TURNS        2/3", ">A%-14s" % ("%d  x1" % second)))
    ends(soak, "SET")
    shown(soak, ("SET=KEEP     2/3", ">A%-14s" % ("%d  x3" % second)))
    ends(soak, "SET")
    assert broken(arranged.look, soak.world.clock.now_us + 20_000_000) == "LIST"
    assert starts(soak, repeats={str(second): 3}) is None
    assert arranged.turns() == 5
    assert starts(soak, repeats={str(third): 3}) == "LIST"


def test_what_a_reset_has_taken_from_a_drive_is_given_back():
    soak = Soak(26)
    soak.hand.run(2_000)
    (drive, *_), hand = soak.hand.drives, soak.hand
    address = drive.address
    drive.write(10, 0, 30)
    drive.write(970, 0, 1)
    assert drive.silent
    hand.wait_for_the_busy()
    assert not drive.silent and drive.read(700) != 5
    drive.write(2011, 0, (address + 1) % 31)
    hand.put_back(drive)
    assert drive.address == address
