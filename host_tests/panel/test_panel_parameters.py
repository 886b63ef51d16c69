# SPDX-License-Identifier: MIT
"""The operator's manual, parameter mode: look at parameters and change them."""

from boards.sim.drives.kinds import listed_drives, simulated
from panel import texts
from panel.keys import NAMES as KEY_NAMES
from panel.keys import Acts, Keys
from panel.pages import parameter_words as words
from panel.pages.parameter_words import failure
from panel.pages.question import Question
from panel.pages.writing import ASK, Writing
from panel.screen import Screen
from panel_bench import (
    LOOP_US,
    OFF1,
    page_back,
    panel,
    row_1,
    row_2,
    running,
    said,
    settled_row_2,
    starts,
    telegrams,
    wait_until_known,
)
from parameter_bench import (
    ASKED,
    WRITES,
    edit,
    parameter,
    restart_drive,
    rows_in_turn,
    show,
    wait_for,
    write,
    write_eeprom,
    writes,
)
from pkw_bench import AskedDrive
from uss import pkw
from uss.families import MM3, MM440
from uss.families.generic import CUTS_OFF

KEYS = ("START", "REVERSE", "JOG_RIGHT", "JOG_LEFT", "UP", "DOWN", "ADDRESS_UP", "ADDRESS_DOWN",
        "PARAM", "NEXT", "PREVIOUS", "EDIT")  # fmt: skip


# --- looking -------------------------------------------------------------------------------------


def test_param_goes_to_parameter_mode_and_back():
    world = panel(loop_us=LOOP_US)
    home = world.lcd()
    world.press("PARAM")
    world.run(200)
    assert world.lcd() == ("S: 10.0 F:  0.00", "P0700:     5 A1 ")
    page_back(world)
    assert world.lcd() == home
    world.check()


def test_next_and_previous_walk_the_parameters_round():
    world = panel()
    world.drives[1].write(1000, 0, 65)
    world.press("PARAM")
    walk = ["P0700:     5 A1", "P1000:    65 A1", "P2011:     1 A1", "r2024:", "r2025:     0 A1"]
    for key, rows in (("NEXT", walk + walk[:2]), ("PREVIOUS", [walk[1], walk[0]] + walk[:0:-1])):
        if key == "PREVIOUS":
            walk = walk[1:]
        for row in rows:
            world.run(100)
            assert row_2(world).startswith(row), (row, world.lcd())
            last = row
            world.press(key)
        world.press("PREVIOUS" if key == "NEXT" else "NEXT")
        world.run(100)  # as for every other row
        assert row_2(world).startswith(last)
    world.check()


def test_a_parameter_on_which_the_drive_falls_silent_stops_no_motor():
    """The question is withdrawn before the drive counts as lost, and row 2 says what happened."""
    world = panel()
    drive = world.drives[1]
    world.press("START")
    world.run(4000)
    hear = drive.slave.hear
    silent_on = []

    def hear_selectively(burst):
        characters = bytes(burst.data[: burst.count])
        if characters[3:5] == b"\x10\x19" and characters[5] & 0x80:  # r2025, read
            silent_on.append(burst.start_us)
            return None
        return hear(burst)

    drive.slave.hear = hear_selectively
    show(world, "r2025")
    wait_for(world, "NO REPLY TO IT")
    assert len(silent_on) == 3
    wait_for(world, "r2025: -----")
    world.run(5000)
    assert drive.state == "running" and starts(world) == 1 and drive.hz() > 9
    world.press("NEXT")
    wait_for(world, "P0700:     5 A1")
    world.check()


def test_a_write_on_which_the_drive_falls_silent_says_so():
    world = parameter("P1000")
    drive = world.drives[1]
    hear = drive.slave.hear

    def hear_selectively(burst):
        task = bytes(burst.data[: burst.count])[3:4]
        return None if task and task[0] >> 4 == 2 else hear(burst)

    drive.slave.hear = hear_selectively
    write(world, 6)
    wait_for(world, "NO REPLY TO IT", 900)
    assert drive.read(1000) == 5
    wait_for(world, "P1000:     6")  # still being edited: SET would try again
    world.check()


def test_next_is_read_at_once_and_repeats_while_it_is_held():
    world = parameter("P0700")
    world.press("NEXT", 60)
    world.run(100)
    assert row_2(world) == "P1000:     5 A1"
    world.down("NEXT")
    seen = set()
    for _ in range(200):
        world.run(10)
        seen.add(row_2(world)[:5])
    assert len(seen) == 5
    world.check()


def test_a_value_follows_the_drive():
    world = parameter("P1000")
    world.drives[1].write(1000, 0, 3)
    world.run(800)
    assert row_2(world) == "P1000:     3 A1"
    world.check()


def test_the_telegrams_that_the_drive_counts_are_shown():
    world = parameter("r2024")
    first = int(row_2(world)[6:12])
    world.run(1000)
    assert first + 10 < int(row_2(world)[6:12]) <= world.drives[1].read(2024)
    world.check()


def test_a_value_is_that_of_the_drive_shown():
    world = panel(addresses=(1, 2, 31), loop_us=LOOP_US)
    for address, value in ((1, 1), (2, 2), (31, 3)):
        world.drives[address].write(1000, 0, value)
    show(world, "P1000")
    for row in ("P1000:     1 A1", "P1000:     2 A2", "P1000:     3 A31"):
        assert row_2(world) == row
        world.press("ADDRESS_UP", 30)
        assert "?" in row_2(world) or row_2(world)[13:] != row[13:]
        world.run(300)
    world.check()


def test_a_value_is_asked_for_half_a_second_after_its_last_answer():
    world = parameter("r2024")
    since_us = world.clock.now_us
    world.run(6000)
    asked, before = [], b""
    for at_us, sent, characters in world.wire.log.last(1000):
        if sent and at_us > since_us and len(characters) == 16:
            task = characters[3:6]  # it stays until it is answered
            if task == b"\x10\x18\x80" != before:
                asked.append(at_us // 1000)
            before = task
    spans = [later - sooner for sooner, later in zip(asked, asked[1:])]
    assert len(spans) > 7 and 500 <= min(spans) and max(spans) < 700, spans
    world.check()


def test_what_a_refused_parameter_has_left_is_not_said_of_the_next_one():
    """That one is unknown until it is told; and if it is refused too, that is said as well."""
    world = panel()
    parameters = world.drives[1].parameters
    parameters.rows = {row: parameters.rows[row] for row in parameters.rows if row < 2024}
    show(world, "P2011")
    world.press("NEXT")
    wait_for(world, "r2024: ----- A1")
    world.drives[1].stale_replies = 10
    world.press("NEXT")
    assert settled_row_2(world) == "r2025:     ? A1", world.lcd()
    wait_for(world, "NO SUCH PARAM.", 900)
    wait_for(world, "r2025: ----- A1")
    world.check()


def test_a_stale_answer_is_never_shown_as_another_parameter():
    """The drive still tells the old parameter for a while, as it may."""
    world = panel()
    world.drives[1].write(1000, 0, 3)
    world.drives[1].stale_replies = 10
    world.press("PARAM")
    allowed = {"P0700": "     5     ?", "P1000": "     3     ?", "P2011": "     1     ?"}
    for _ in range(6):
        for _ in range(50):
            world.run(10)
            name, value = row_2(world)[:5], row_2(world)[6:12]
            assert name not in allowed or value in allowed[name], world.lcd()
        world.press("NEXT", 30)
    world.check()


def test_a_parameter_that_the_drive_does_not_have_is_told():
    world = panel()
    parameters = world.drives[1].parameters
    parameters.rows = {row: parameters.rows[row] for row in parameters.rows if row != 2024}
    show(world, "P2011")
    world.press("NEXT")
    world.run(200)
    assert row_2(world) == "NO SUCH PARAM."
    world.run(3200)
    assert row_2(world) == "r2024: ----- A1"
    world.check()


def test_a_refusal_that_no_manual_explains_is_told_by_its_number():
    world = panel()
    channel = world.drives[1].channel
    reply = channel.reply

    def refuse(layout, pzd_words=2):
        words = reply(layout, pzd_words)
        is_asked = words[0] & 0x7FF == 2011 - 2000 and words[1] & 0x8000
        return [0x700B, words[1], 0, 99] if is_asked else words

    channel.reply = refuse
    show(world, "P2011")
    assert row_2(world) == "REFUSED: 99", world.lcd()
    world.run(3200)
    assert row_2(world) == "P2011: ----- A1"
    world.check()


def test_each_number_of_a_refusal_has_its_words():
    told = {
        0: "NO SUCH PARAM.", 1: "READ ONLY", 2: "BEYOND LIMITS", 3: "NO SUCH INDEX",
        4: "NOT AN ARRAY", 5: "WRONG DATA TYPE", 6: "MAY ONLY BE 0", 7: "NOT CHANGEABLE",
        11: "NO WRITE RIGHTS", 12: "KEYWORD MISSING", 17: "MODE FORBIDS IT", 18: "DRIVE ERROR",
        20: "ILLEGAL VALUE", 101: "INACTIVE NOW", 102: "REPLY TOO LONG", 103: "BAD PKW LENGTH",
        104: "NOT THIS VALUE", 105: "IS AN ARRAY", 106: "TASK UNKNOWN", 107: "TEXT IS FIXED",
        200: "BELOW LIMIT NOW", 201: "ABOVE LIMIT NOW", 204: "P0003 TOO LOW",
        pkw.NO_CHANGE_RIGHTS: "NO WRITE RIGHTS",
    }  # fmt: skip
    job = pkw.read(1000)
    job.state = pkw.REFUSED
    for job.error in set(told) | set(range(210)):
        words = failure(job)
        if job.error in told:
            assert words == (told[job.error].encode(),), (job.error, words)
        else:
            assert words[0] % words[1:] == b"REFUSED: %d" % job.error, (job.error, words)
    for job.state, text in ((pkw.UNANSWERED, b"NO REPLY TO IT"), (pkw.TIMED_OUT, b"NO ANSWER")):
        assert failure(job) == (text,), text


def test_the_value_of_a_silent_drive_is_not_shown():
    """Not even the last one, as soon as it is out of contact; and it comes back with it."""
    world = parameter("P1000")
    world.drives[1].unplug()
    world.run(1200)
    assert world.lcd() == ("S: 10.0 F: -----", "P1000:     ? A1 ")
    world.drives[1].plug()
    world.run(3000)
    assert row_2(world) == "P1000:     5 A1"
    world.check()


def test_a_value_that_is_not_told_any_more_is_not_shown():
    """It answers with an old parameter for ever: what it was told once is out of date."""
    world = parameter("P1000")
    world.drives[1].stale_replies = 1_000_000
    world.drives[1].write(1000, 0, 2)
    world.run(10_000)
    assert row_2(world) == "P1000:     ? A1"
    world.check()


def test_a_drive_that_does_not_tell_holds_up_no_other():
    world = parameter("P1000", addresses=(1, 2))
    world.drives[1].unplug()
    world.run(800)
    world.press("ADDRESS_UP")
    world.run(500)
    assert row_2(world) == "P1000:     5 A2"
    world.check()


# --- editing -------------------------------------------------------------------------------------


def test_edit_freezes_the_value_and_lets_it_go():
    world = parameter("P1000")
    world.press("EDIT")
    assert row_2(world) == "P1000:     5↕A1"
    world.press("UP")
    world.drives[1].write(1000, 0, 2)
    world.run(1500)
    assert row_2(world) == "P1000:     6↕A1"
    world.press("EDIT")
    assert row_2(world) == "P1000:     2 A1"
    world.press("EDIT")
    assert row_2(world) == "P1000:     2↕A1"
    assert not writes(world)
    world.check()


def test_a_warning_takes_turns_with_a_value_that_is_edited_and_has_the_whole_row():
    world = parameter("P1000")
    world.press("EDIT")
    world.drives[1].warn(501)
    world.run(1000)
    assert set(said(world, 6000)) == {"P1000:     5↕A1", "WARN A0501   A1"}
    world.check()


def test_an_edited_value_stays_within_its_range():
    for name, highest in (("P0700", 6), ("P1000", 77), ("P2011", 31)):
        world = parameter(name)
        world.press("EDIT")
        world.press("UP", 11_000)
        assert int(row_2(world)[6:12]) == highest
        world.press("DOWN", 11_000)
        assert row_2(world) == "%s:     0↕A1" % name
        world.check()


def test_a_small_range_is_walked_by_ones():
    world = parameter("P1000", loop_us=LOOP_US)
    world.press("EDIT")
    world.down("UP")
    last = 5
    for _ in range(400):
        world.run(10)
        value = int(row_2(world)[6:12])
        assert value - last in (0, 1)
        last = value
    assert 30 < last < 40
    world.check()


def test_readings_cannot_be_edited():
    for name in ("r2024", "r2025"):
        for key in ("EDIT", "UP", "DOWN"):
            world = parameter(name)
            world.press(key)
            assert row_2(world) == "READ ONLY"
            world.run(3100)
            assert row_2(world)[12] == " "
        world.press("SET")
        assert "FIRST" in row_2(world) or row_2(world) == "READ ONLY"
        world.run(500)
        assert not writes(world)
        world.check()


def test_up_down_and_set_without_edit_say_what_to_do():
    for key in ("UP", "DOWN", "SET"):
        world = parameter("P0700")
        world.press(key)
        assert row_2(world) == "PRESS EDIT FIRST"
        world.run(3100)
        assert row_2(world) == "P0700:     5 A1" and not writes(world)
        world.check()


def test_what_is_not_read_yet_cannot_be_edited():
    world = panel()
    world.drives[1].stale_replies = 50
    world.press("PARAM")
    world.press("EDIT")
    assert row_2(world) == "NOT READ YET"
    world.check()


def test_another_parameter_or_drive_drops_what_was_edited():
    for away, back in (("NEXT", "PREVIOUS"), ("ADDRESS_UP", "ADDRESS_DOWN"), ("PARAM", None)):
        world = parameter("P1000", addresses=(1, 2))
        edit(world, 3)
        world.press(away)
        if back:
            world.press(back)
        else:
            page_back(world)
        world.run(300)
        assert row_2(world) == "P1000:     5 A1"
        world.press("SET")
        assert row_2(world) == "PRESS EDIT FIRST" and not writes(world)
        world.check()


def test_what_was_edited_never_goes_to_another_drive():
    """Also when ADDRESS_UP and SET go down in the same moment, in every order and wiring."""
    for keys in ("direct", "matrix"):
        for early, late, ms in (("SET", "ADDRESS_UP", 0), ("ADDRESS_UP", "SET", 4),
                                ("SET", "ADDRESS_UP", 4)):  # fmt: skip
            world = parameter("P1000", addresses=(1, 2), keys=keys)
            edit(world, 4)
            world.down(early)
            world.run(ms)
            world.down(late)
            world.run(100)
            world.up("SET")
            world.up("ADDRESS_UP")
            world.run(100)
            world.press("SET", 2000)
            world.run(500)
            assert world.drives[2].read(1000) == 5, (keys, early, ms)
            assert not writes(world, 2)
            world.check()


# --- writing -------------------------------------------------------------------------------------


def test_set_asks_first():
    for name, value in (("P0700", 6), ("P1000", 3), ("P2011", 4)):
        world = edit(parameter(name), value)
        world.press("SET")
        for row in ("A1: %s=%d" % (name, value), "PANEL MAY LOSE", "THE DRIVE BY IT", "A1: P"):
            assert row_1(world).startswith(row) and row_2(world) == ASKED, world.lcd()
            world.run(1500)
        world.run(10_000)
        assert row_2(world) == ASKED and not writes(world)
        world.check()


def test_a_question_that_nobody_answers_is_gone_after_half_a_minute():
    world = edit(parameter("P1000"), 3)
    world.press("SET")
    world.run(29_500)
    assert row_2(world) == ASKED, world.lcd()
    world.run(700)
    assert row_2(world) == "P1000:     3↕A1" and not writes(world), world.lcd()
    world.check()


def test_set_does_not_answer_a_question_that_a_message_hides():
    """The drive falls silent on the parameter, which is read on: row 2 says so. SET takes that
    away, once or twice, and when the question is to be read again, SET answers it."""
    world = edit(parameter("P0700"), 6)
    drive = world.drives[1]
    hear = drive.slave.hear

    def hear_selectively(burst):
        reads = bytes(burst.data[3 : min(5, burst.count)]) == b"\x12\xbc"  # P0700
        return None if reads else hear(burst)

    drive.slave.hear = hear_selectively
    world.press("SET")
    wait_for(world, "NO REPLY TO IT")
    assert row_1(world).startswith("A1: P0700=6")
    world.press("SET")
    world.run(300)  # row 2 is there again, and nobody has read it yet
    world.press("SET")
    world.run(1000)
    assert row_2(world) == ASKED and not writes(world)
    world.press("SET")
    wait_for(world, "WRITTEN (RAM)")
    assert writes(world) == [(1, 700, "RAM", 6)]
    world.check()


def test_set_again_writes_into_ram():
    world = parameter("P1000")
    write(world, 3)
    world.run(200)
    assert row_2(world) == "WRITTEN (RAM)"
    world.run(3000)
    assert row_2(world) == "P1000:     3 A1"
    assert writes(world) == [(1, 1000, "RAM", 3)]
    restart_drive(world)
    world.run(2500)
    assert row_2(world) == "P1000:     5 A1"
    world.check()


def test_set_held_writes_into_the_eeprom_as_well():
    world = parameter("P1000")
    write_eeprom(world, 3)
    world.run(200)
    assert row_2(world) == "WRITTEN (EEPROM)"
    assert writes(world) == [(1, 1000, "RAM", 3), (1, 1000, "EEPROM", 3)]
    restart_drive(world)
    world.run(4000)
    assert row_2(world) == "P1000:     3 A1"
    world.check()


def test_only_a_set_that_is_held_for_a_second_and_a_half_reaches_the_eeprom():
    for ms, eeprom in ((1400, False), (1620, True)):
        world = edit(parameter("P1000"), 3)
        world.press("SET")
        world.press("SET", ms)
        world.run(1500)
        assert ((1, 1000, "EEPROM", 3) in writes(world)) == eeprom
        world.check()


def test_the_set_that_asks_does_not_write_however_long_it_is_held():
    world = edit(parameter("P1000"), 3)
    world.press("SET", 5000)
    assert row_2(world) == ASKED and not writes(world)
    world.check()


def test_a_held_set_writes_the_eeprom_once():
    world = edit(parameter("P1000"), 3)
    world.press("SET")
    world.down("SET")
    world.run(2200)
    before = world.wire.log.count
    world.run(5000)
    since = world.wire.log.last(world.wire.log.count - before)
    assert not [row for row in since if row[1] and row[2][3] >> 4 in WRITES]
    world.check()


def test_a_write_that_is_on_its_way_has_an_hourglass():
    world = edit(parameter("P1000"), 3)
    world.drives[1].stale_replies = 20
    world.press("SET")
    world.press("SET")
    world.run(100)
    assert row_2(world) == "P1000:     3⧗A1"
    wait_for(world, "WRITTEN (RAM)")  # two questions of the panel may be before it
    world.check()


def test_another_parameter_has_no_hourglass_of_a_write_that_is_still_on_its_way():
    world = edit(parameter("P1000"), 3)
    world.drives[1].stale_replies = 20
    world.press("SET")
    world.press("SET")
    world.press("PREVIOUS")
    assert settled_row_2(world) == "P0700:     ? A1", world.lcd()
    wait_for(world, "WRITTEN (RAM)")
    wait_for(world, "P0700:     5 A1")
    world.check()


def test_what_was_written_is_what_edit_begins_with_a_moment_later():
    for ms in (0, 120, 240, 360):
        world = edit(parameter("P1000"), 3)
        world.press("SET")
        world.run(ms)
        world.press("SET")
        wait_for(world, "WRITTEN (RAM)")
        world.run(150)
        world.press("EDIT")
        assert row_2(world) == "P1000:     3↕A1", (ms, world.lcd())
        world.check()


def test_who_lets_go_of_a_value_while_it_is_written_edits_nothing_when_it_is_refused():
    world = edit(parameter("P1000"), 7)
    world.drives[1].stale_replies = 20
    world.press("SET")
    world.press("SET")
    world.press("EDIT")
    wait_for(world, "NOT THIS VALUE")
    wait_for(world, "P1000:     5 A1")
    world.press("UP")
    assert row_2(world) == "PRESS EDIT FIRST", world.lcd()
    world.check()


def test_a_held_set_does_not_try_again_what_could_not_be_tried():
    """The drive is out of contact. It comes back while SET is still held."""
    world = edit(parameter("P1000", parameters={2014: 20_000}), 3)
    world.press("SET")
    world.drives[1].unplug()
    world.run(1500)
    world.down("SET")
    wait_for(world, "NO CONTACT")
    world.drives[1].plug()
    world.run(6000)
    world.up("SET")
    assert world.drives[1].read(1000) == 5 and not writes(world), writes(world)
    world.check()


def test_keys_while_set_is_held_do_not_change_what_becomes_permanent():
    """What was asked and written into RAM is what the EEPROM gets, or nothing."""
    for keys in (("EDIT", "DOWN"), ("UP",), ("NEXT",), ("ADDRESS_UP",), ("PARAM",)):
        for ms in (30, 300):
            world = edit(parameter("P1000", addresses=(1, 2)), 3)
            world.press("SET")
            world.down("SET")
            world.run(ms)
            for key in keys:
                world.press(key, 60)
            world.run(2500)
            for row in writes(world):
                assert row[:2] == (1, 1000) and row[3] == 3, (keys, ms, row)
            world.check()


def test_keys_while_set_is_held_do_not_move_a_drive_onto_another():
    world = edit(parameter("P2011", addresses=(1, 2)), 3)
    world.press("SET")
    world.down("SET")
    world.run(400)
    world.press("EDIT")
    world.press("DOWN")
    world.run(2000)
    assert world.drives[1].address == 3
    world.check()


def test_a_set_that_goes_on_after_the_line_failed_makes_nothing_permanent():
    """The operator reads NO CONTACT; a write some time later would be a surprise."""
    world = edit(parameter("P1000"), 3)
    world.press("SET")
    world.down("SET")
    world.run(300)
    world.drives[1].unplug()
    assert "NO CONTACT" not in said(world, 8000)  # nothing was tried
    world.drives[1].plug()
    world.run(3000)
    assert (1, 1000, "EEPROM", 3) not in writes(world)
    world.check()


def test_any_other_key_cancels_and_does_nothing_else():
    for key in KEYS:
        world = edit(parameter("P1000", addresses=(1, 2), loop_us=LOOP_US), 3)
        world.press("SET")
        row = row_1(world)
        world.press(key)
        assert row_2(world) == "P1000:     3↕A1", (key, world.lcd())
        assert row != row_1(world) == "S: 10.0 F:  0.00"
        world.run(1000)
        assert not writes(world) and starts(world) == 0
        world.check()


def test_a_key_that_cancels_does_nothing_else_while_it_is_held():
    for key in KEYS:
        world = edit(parameter("P1000", addresses=(1, 2)), 3)
        world.press("SET")
        world.press(key, 1500)
        assert row_2(world) == "P1000:     3↕A1", (key, world.lcd())
        assert not writes(world) and starts(world) == 0
        world.check()


def test_two_keys_at_once_are_no_answer():
    world = edit(parameter("P1000"), 3)
    world.press("SET")
    world.down("UP")
    world.press("SET")
    world.up("UP")
    world.run(500)
    assert row_2(world) == "P1000:     3↕A1" and not writes(world)


def test_stop_cancels_and_stops():
    world = show(running(), "P1000")
    edit(world, 3)
    world.press("SET")
    assert row_2(world) == ASKED
    since_us = world.clock.now_us
    world.press("STOP")
    assert row_2(world) == "P1000:     3↕A1"
    assert telegrams(world, since_us)[-1][1] == OFF1
    world.run(5000)
    assert world.drives[1].state == "ready" and not writes(world)
    world.check()


def test_a_refusal_is_told_in_words():
    """Name, value, what is set at the drive before, what is said."""
    for name, value, before, text in (
        ("P1000", 7, None, "NOT THIS VALUE"),
        ("P0700", 3, None, "NOT THIS VALUE"),
        ("P1000", 3, (927, 7), "NO WRITE RIGHTS"),
        ("P2011", 3, (3, 1), "P0003 TOO LOW"),
    ):
        world = panel()
        if before:
            world.drives[1].write(before[0], 0, before[1])
        show(world, name)
        number = int(name[1:])
        was = world.drives[1].read(number)
        write_eeprom(world, value)
        assert row_2(world) == text, world.lcd()
        assert world.drives[1].read(number) == was
        assert name == "P2011" or "EEPROM" not in [row[2] for row in writes(world)]
        world.run(3100)
        if text == "P0003 TOO LOW":  # the panel offers to raise it
            assert row_2(world) == "SET=DO  PARAM=NO", world.lcd()
            world.press("PARAM")
            world.run(200)
        assert row_2(world) == "%s:     %d↕A1" % (name, value)
        world.press("EDIT")
        assert row_2(world) == "%s:     %d A1" % (name, was)
        world.check()


def test_the_source_of_commands_is_not_changed_while_the_drive_runs():
    world = show(running(), "P0700")
    write(world, 2)
    world.run(200)
    assert row_2(world) == "MODE FORBIDS IT"
    world.run(1000)
    assert world.drives[1].state == "running" and world.drives[1].read(700) == 5
    world.check()


def test_a_drive_that_goes_silent_while_it_is_written_to_is_told_of():
    world = edit(parameter("P1000", parameters={2014: 20_000}), 3)
    world.press("SET")
    world.drives[1].unplug()
    world.press("SET", 1000)
    wait_for(world, "NO ANSWER")
    world.press("SET")
    world.press("SET")
    assert row_2(world) == "NO CONTACT"
    world.drives[1].plug()
    world.run(3500)
    assert world.drives[1].read(1000) == 5
    world.press("SET")
    world.press("SET")
    world.run(300)
    assert row_2(world) == "WRITTEN (RAM)" and world.drives[1].read(1000) == 3
    world.check()


def test_a_stale_answer_is_not_taken_for_a_confirmation():
    """The value stood there before; the drive takes a second to look at the task."""
    world = edit(parameter("P1000"), 7)
    world.drives[1].stale_replies = 20
    world.press("SET")
    world.press("SET")
    for _ in range(30):
        world.run(100)
        assert "WRITTEN" not in row_2(world)
        if row_2(world) == "NOT THIS VALUE":
            break
    assert row_2(world) == "NOT THIS VALUE"
    world.check()


def test_a_drive_that_keeps_another_value_than_it_was_told_is_asked_four_times_in_all():
    world = panel()
    channel = world.drives[1].channel
    accept = channel.accept

    def accept_another(words, layout):
        accept(list(words[:3]) + [2] if words[0] >> 12 in WRITES else words, layout)

    show(world, "P1000")
    channel.accept = accept_another
    write(world, 3)
    wait_for(world, "NOT WRITTEN")
    assert world.drives[1].read(1000) == 2
    tasks = [characters[3] >> 4 for _, sent, characters in world.wire.log.last(1000) if sent]
    times = [task in WRITES and before not in WRITES for before, task in zip(tasks, tasks[1:])]
    assert times.count(True) == 4, tasks
    world.check()


def test_a_write_waits_for_room_in_the_parameter_channel():
    world = panel()
    wait_until_known(world)
    control = world.app.panel.controls[0]
    channel, jobs = control.drive.channel, []
    write = world.app.panel.write(0, control, 1000, 0, 3)
    while not channel.is_full():
        jobs.append(pkw.read(1082))
        control.drive.ask(jobs[-1])
    world.run(60)
    assert write.outcome is None and not writes(world), write.outcome
    wait_for(world, "WRITTEN (RAM)")
    assert world.drives[1].read(1000) == 3
    assert [job.state for job in jobs] == [pkw.DONE] * len(jobs)
    world.check()


def test_an_element_is_written_by_the_tasks_for_arrays_where_the_family_has_those():
    """A V20: a word and a double word, each into RAM and into the EEPROM."""
    world = panel(kinds=simulated(listed_drives("1=v20")), settings={"kinds": {"1": "v20"}})
    wait_until_known(world)
    drive, front = world.drives[1], world.app.panel
    value = 0x41480000  # 12.5
    for number, bits, width, eeprom, tasks, reads in (  # tasks: of a value, of an element
        (5, 25, pkw.WORD, False, (2, 7), 25),
        (5, 27, pkw.WORD, True, (14, 12), 27),
        (1120, value, pkw.DOUBLE, False, (3, 8), 12.5),
        (1120, value + 0x80000, pkw.DOUBLE, True, (13, 11), 13),
    ):
        for index, task in enumerate(tasks):
            since_us = world.clock.now_us
            front.write(0, front.selected, number, index, bits, eeprom, width)
            world.run(1000)
            assert drive.read(number, index) == reads, (number, index, world.lcd())
            asked = [
                characters[3] >> 4
                for at_us, from_panel, characters in world.wire.log.last(200)
                if from_panel and at_us > since_us
            ]
            assert task in asked, (number, index, asked)
    world.check()


def test_a_second_write_waits_for_the_first():
    world = edit(parameter("P1000"), 3)
    world.drives[1].stale_replies = 30
    for _ in range(4):
        world.press("SET")
    assert row_2(world) == "STILL WRITING"
    world.run(2500)
    assert world.drives[1].read(1000) == 3
    world.check()


def test_the_end_of_a_write_is_told_though_another_drive_is_shown():
    for value, text in ((3, "A1: WRITTEN"), (7, "A1: NOT WRITTEN")):
        world = edit(parameter("P1000", addresses=(1, 2)), value)
        world.drives[1].stale_replies = 20
        world.press("SET")
        world.press("SET")
        world.press("ADDRESS_UP")
        wait_for(world, text)
        wait_for(world, "P1000:     5 A2")
        assert not writes(world, 2)
        world.check()


def test_a_write_goes_on_when_parameter_mode_is_left():
    world = edit(parameter("P1000", loop_us=LOOP_US), 3)
    world.drives[1].stale_replies = 20
    world.press("SET")
    world.down("SET")
    world.run(100)
    world.press("PARAM")
    wait_for(world, "WRITTEN (RAM)")
    world.run(4000)
    assert [row[2] for row in writes(world)] == ["RAM"]  # for the EEPROM nobody looks on
    world.up("SET")
    world.drives[1].stale_replies = 0
    page_back(world)
    world.run(300)
    assert row_2(world) == "P1000:     3 A1"
    world.check()


def test_what_was_written_counts_for_the_next_start():
    world = parameter("P0700", loop_us=LOOP_US)
    write(world, 2)
    world.run(300)
    world.press("START")
    assert row_2(world) == "NO:P0700 NOT USS" and starts(world) == 0
    world.check()


def test_what_was_written_is_known_on_the_home_page_soon():
    """The settings are read again at once; in their turn that would take a second and more."""
    world = panel()
    world.drives[1].write(2014, 0, 0)
    world.run(3000)
    show(world, "P0700")
    write(world, 2)
    page_back(world)
    world.run(350)
    assert row_2(world) == "LOCAL        A1"
    world.check()


# --- a drive under the hand ----------------------------------------------------------------------


def test_the_setpoint_does_not_move_in_parameter_mode():
    world = parameter("P1000")
    for _ in range(2):
        world.press("UP", 2000)
        world.press("DOWN", 500)
        world.press("EDIT")
    assert row_1(world) == "S: 10.0 F:  0.00"
    world.press("PARAM")
    assert row_1(world) == "S: 10.0 F:  0.00"
    world.check()


def test_start_stop_reverse_and_jog_act_and_row_1_shows_it():
    world = parameter("P1000")
    world.press("START")
    world.run(4000)
    assert world.lcd() == ("S: 10.0 F: 10.00", "P1000:     5 A1 ")
    world.press("REVERSE")
    world.run(6000)
    assert world.lcd() == ("S:-10.0 F:-10.00", "P1000:     5 A1 ")
    world.press("STOP")
    world.run(5000)
    assert world.lcd() == ("S:-10.0 F:  0.00", "P1000:     5 A1 ")
    assert world.drives[1].state == "ready"
    for key, sign in (("JOG_RIGHT", ""), ("JOG_LEFT", "-")):
        world.down(key)
        world.run(3000)
        assert row_1(world)[10:] == "%6s" % (sign + "5.00")
        world.up(key)
        world.run(3000)
        assert row_1(world)[10:] == "  0.00" and row_2(world) == "P1000:     5 A1"
    world.check()


def test_stop_that_is_held_says_what_it_does_in_parameter_mode():
    world = show(running(addresses=(1, 2)), "P1000")
    world.down("STOP")
    world.run(500)
    assert row_2(world) == "STOP, HOLD: OFF3"
    world.run(4000)
    assert row_2(world) == "ALL DRIVES: STOP"
    world.up("STOP")
    world.run(4000)
    assert row_2(world) == "P1000:     5 A1"
    world.check()


def test_a_jog_ends_when_a_question_comes():
    world = edit(parameter("P1000"), 3)
    world.down("JOG_RIGHT")
    world.run(2000)
    world.press("SET")
    assert row_2(world) == ASKED
    world.run(3000)
    assert world.drives[1].state == "ready" and row_2(world) == ASKED
    world.press("PARAM")
    world.run(1000)
    assert starts(world) == 1  # the key must be pressed anew
    world.check()


# --- alarms --------------------------------------------------------------------------------------


def test_a_fault_of_this_drive_is_shown_in_turn_and_acknowledged_by_stop():
    world = parameter("P1000")
    world.drives[1].fault(1)
    world.run(300)
    assert rows_in_turn(world) == {"A1 FAULT F0001", "P1000:     5 A1"}
    world.press("STOP")
    world.run(1000)
    assert world.drives[1].state == "ready"
    assert rows_in_turn(world) == {"P1000:     5 A1"}
    world.check()


def test_a_fault_whose_number_is_not_told_is_seen_in_parameter_mode_too():
    world = parameter("P1000")
    parameters = world.drives[1].parameters
    parameters.rows = {row: parameters.rows[row] for row in parameters.rows if row != 947}
    world.drives[1].fault(1)
    world.run(1000)
    assert [row for row in rows_in_turn(world) if "FAULT" in row]


def test_another_drive_that_runs_is_announced_in_parameter_mode():
    world = running(addresses=(1, 2), loop_us=LOOP_US)
    world.press("ADDRESS_UP")
    show(world, "P1000")
    assert rows_in_turn(world) == {"A1 RUN,HOLD=ALL", "P1000:     5 A2"}
    world.check()


def test_a_stop_that_is_not_obeyed_is_seen_in_parameter_mode():
    world = show(running(), "P1000")
    world.drives[1].process.words = lambda count: [0xFB34, 0x0CCD]
    world.press("STOP")
    world.run(2000)
    assert rows_in_turn(world) == {"STOP UNCONFIRMED"}


def test_a_drive_that_may_run_is_seen_in_parameter_mode():
    world = show(running(), "P1000")
    world.drives[1].unplug()
    world.run(1500)
    assert world.lcd() == ("NO CONTACT,     ", "MAY RUN      A1 ")
    world.check()


def test_an_alarm_takes_a_question_away():
    world = edit(show(running(), "P1000"), 3)
    world.press("SET")
    assert row_2(world) == ASKED
    world.drives[1].unplug()
    world.run(1500)
    assert world.lcd() == ("NO CONTACT,     ", "MAY RUN      A1 ")
    world.press("SET")
    world.drives[1].plug()
    world.run(3000)
    assert not writes(world)
    world.check()


def test_a_question_beside_an_alarm_tells_both_in_turn_all_that_is_at_stake():
    world = running()
    world.drives[1].unplug()
    world.run(3000)
    shown = world.app.panel
    question = Question(shown, ((b"ONE", b"TWO", b"THREE"), b"SET=DO  PARAM=NO"), (), {})
    told = []
    for shown.announcer.page_turns in range(8):
        question.draw(shown.screen, 0)
        told.append([row.rstrip() for row in shown.screen.rows()])
    assert [row for _, row in told] == [ASKED] * 8
    assert [row for row, _ in told[::2]] == ["ONE", "TWO", "THREE", "ONE"]
    assert {row for row, _ in told[1::2]} == {"A1 LOST,MAY RUN"}, told


# --- parameter mode by itself --------------------------------------------------------------------


class Mode(AskedDrive):
    """Parameter mode of one drive, which is asked, and answers what and when the test says."""

    mask = 0xFFFF
    pkw_words = 4
    active = False
    page_turns = 1
    off_time_ms, off_time_unit_ms, off_time_number = 1_001, 100, 2014
    link_index, linked = 3, (2014,)
    address_number, address = 2011, 1
    has_eeprom_tasks, permanent = True, ()
    shown = ((700, 100), (1000, 101), (2014, 9_999), (2024, None))

    def __init__(self, row=0):
        from panel.pages.parameters import Parameters

        AskedDrive.__init__(self)
        self.drive = self.survey = self.layout = self.family = self.desk = self
        self.selected = self.warning = self.announcer = self
        self.ask_first = {}
        self.remembered = {"panel.pages.parameters": row}
        self.screen = Screen()
        self.keys = Keys(KEY_NAMES, self.mask)
        self.said, self.wrote = [], []
        self.page = Parameters(self)
        assert [self.asks(0) for _ in range(3)] == [False, False, True]  # it prepares itself

    def say(self, _now_ms, *said):
        self.said.append(said)

    def write(self, _now_ms, _control, *what):
        self.wrote.append(what)
        self.outcome, self.done = None, False
        return self

    def asks(self, now_ms):
        """Whether it is asked in the step at this time."""
        before = len(self.asked)
        self.page.step(self.keys, now_ms & self.mask)
        return len(self.asked) > before

    def question(self):
        return self.asked[-1].number, self.asked[-1].index

    def answer(self, now_ms, value=0, state=pkw.DONE):
        AskedDrive.answer(self, value, state)
        return self.asks(now_ms)

    def press(self, *names, repeats=0):
        """The keys go down, or the one that is held repeats for so many times by now."""
        bits = self.keys.bits(names)
        self.keys.pressed, self.keys.repeated = (0, bits) if repeats else (bits, 0)
        self.keys.repeats = repeats
        self.page.take_keys(Acts(self.keys), 0)
        return self.row()

    def row(self):
        self.screen.put(1, 0, 16, b"")
        self.page.draw(self.screen, 0)
        return self.screen.rows()[1].rstrip()


EDITED = "P%04d:%6d\x01"


def editing(row, value):
    """A value was told, and EDIT was pressed."""
    mode = Mode(row)
    mode.answer(5, value)
    assert mode.press("EDIT") == EDITED % (mode.shown[row][0], value)
    return mode


def test_a_parameter_is_asked_for_500_ms_after_its_answer_and_another_one_at_once():
    mode = Mode()
    assert mode.question() == (700, 0) and mode.row() == "P0700:     ?"
    for at_ms in (10, 0xFFFF - 300, 1_000):  # the clock begins anew meanwhile
        assert not mode.answer(at_ms, 6) and mode.row() == "P0700:     6"
        assert not mode.asks(at_ms + 499) and mode.asks(at_ms + 500)
        assert not mode.asks(at_ms + 1_200)  # one question at a time
    mode.answer(2_000, 7)
    assert mode.press("NEXT") == "P1000:     ?"
    assert mode.remembered == {"panel.pages.parameters": 1}
    assert mode.asks(2_001) and mode.question() == (1000, 0)
    mode.answer(2_002, 1)
    mode.press("NEXT")
    assert mode.asks(2_003) and mode.question() == (2014, 3)  # it has a value for each link
    mode.answer(2_004, 1)
    assert mode.press("NEXT") == "r2024:     ?" and mode.press("NEXT") == "P0700:     ?"
    mode.full = True
    assert not mode.asks(2_005)
    mode.full = False
    assert mode.asks(2_006)


def test_a_drive_out_of_contact_tells_no_value_and_is_asked_as_soon_as_it_is_back():
    mode = Mode()
    mode.answer(10, 6)
    mode.contact = False
    assert not mode.asks(20) and not mode.asks(600) and mode.row() == "P0700:     ?"
    mode.contact = True
    assert mode.asks(601)


def test_a_refusal_is_said_when_it_begins_and_again_after_a_value():
    mode = Mode()
    now_ms, said = 0, 0
    for state, more, row in (
        (pkw.UNANSWERED, 1, "P0700: -----"), (pkw.UNANSWERED, 0, "P0700: -----"),
        (pkw.DONE, 0, "P0700:     0"), (pkw.UNANSWERED, 1, "P0700: -----"),
        (pkw.TIMED_OUT, 0, "P0700:     ?"), (pkw.REFUSED, 1, "P0700: -----"),
    ):  # fmt: skip
        mode.asked[-1].error = 0
        mode.answer(now_ms, 0, state)
        said += more
        assert len(mode.said) == said and mode.row() == row, state
        now_ms += 500
        assert mode.asks(now_ms)


def test_a_key_that_is_held_moves_a_range_of_more_than_100_by_more_than_ones():
    for row, values in ((0, (1, 2, 1)), (1, (100, 101, 100))):
        mode, number = editing(row, 0), Mode.shown[row][0]
        for key, repeats, value in zip(("UP", "UP", "DOWN"), (17, 17, 0), values):
            assert mode.press(key, repeats=repeats) == EDITED % (number, value)
    mode = editing(0, 99)
    assert [mode.press("UP")[6:12].strip() for _ in range(2)] == ["100", "100"]
    mode = editing(0, 1)
    assert [mode.press("DOWN")[6:12].strip() for _ in range(2)] == ["0", "0"]


def test_a_telegram_off_time_is_0_or_as_long_as_the_bus_needs():
    """1001 ms in tenths of a second: 11 of them."""
    mode = editing(2, 0)
    assert mode.press("UP") == EDITED % (2014, 11)
    assert mode.press("UP") == EDITED % (2014, 12)
    assert mode.press("DOWN") == EDITED % (2014, 11)
    assert mode.press("DOWN") == EDITED % (2014, 0)


def test_edit_and_set_are_refused_with_the_reason():
    for row, value, keys, reason in (
        (3, 5, ("EDIT",), words.READ_ONLY), (3, 5, ("UP",), words.READ_ONLY),
        (0, None, ("EDIT",), words.NOT_READ_YET), (0, 5, ("UP",), words.EDIT_FIRST),
        (0, 5, ("SET",), words.EDIT_FIRST), (0, 5, ("SET", "STOP"), None), (0, 5, (), None),
    ):  # fmt: skip
        mode = Mode(row)
        if value is not None:
            mode.answer(5, value)
        row = mode.row()
        assert mode.press(*keys) == row and mode.wrote == []
        assert mode.said == ([(reason,)] if reason else []), keys


def test_set_writes_what_is_edited_which_ends_when_it_is_written():
    for is_done in (True, False):
        mode = editing(2, 50)
        mode.press("UP")
        assert mode.press("SET") == "P2014:    51\x00"  # an hourglass
        assert mode.wrote == [(2014, 3, 51, False)]
        mode.outcome, mode.done = (words.WRITTEN,), is_done
        assert mode.asks(20)  # at once: it was asked 15 ms ago
        assert mode.row() == ("P2014:    50" if is_done else EDITED % (2014, 51))
    mode = editing(2, 50)
    mode.press("UP")
    mode.press("SET", "UP")
    assert mode.wrote == []  # with another key it is no clear wish
    assert mode.press("EDIT") == "P2014:    50"  # it is let go


def test_a_set_that_is_held_makes_permanent_what_it_wrote_as_long_as_there_is_contact():
    """And as long as no other key is pressed."""
    for lost_ms, key, made in (
        (None, None, [False, True]), (700, None, [False]), (1_499, None, [False]),
        (None, "STOP", [False]), (None, "START", [False]),
    ):  # fmt: skip
        mode = editing(1, 5)
        mode.press("SET")  # at 0
        mode.keys.down = mode.keys.bit("SET")
        mode.outcome, mode.done = (words.WRITTEN,), True
        mode.asks(100)
        if lost_ms is not None:
            mode.contact = False
            mode.asks(lost_ms)
            mode.contact = True
        if key is not None:
            mode.press(key)
        mode.asks(1_499)
        assert [what[-1] for what in mode.wrote] == [False]
        mode.asks(1_500)
        assert [what[-1] for what in mode.wrote] == made, lost_ms


# --- a question by itself ------------------------------------------------------------------------


class Shown:
    """What a question asks of its panel, whose keys and whose time are those of the test."""

    mask = 0xFFFF
    message = None
    alarm = False

    def __init__(self, began_ms=0, deaf_ms=0, **answers):
        self.selected = self
        self.began_ms = began_ms
        self.happened = []
        for key in answers:
            answers[key] = lambda now_ms, said=answers[key]: self.happened.append((said, now_ms))
        self.question = Question(self, ((b"ONE",), b"SET=DO"), (), answers, deaf_ms)

    def needs_attention(self):
        return self.alarm

    def uncover(self):
        self.happened.append("gone")

    def press(self, ms, *names, repeats=False):
        keys = Keys(KEY_NAMES, self.mask)
        bits = keys.bits(names)
        keys.pressed, keys.repeated = (0, bits) if repeats else (bits, 0)
        return self._new(lambda now_ms: self.question.take_keys(Acts(keys), now_ms), ms)

    def step(self, ms):
        return self._new(lambda now_ms: self.question.step(None, now_ms), ms)

    def _new(self, act, ms):
        """What has come of that."""
        self.happened = []
        act(self.began_ms + ms & self.mask)
        return self.happened


def test_one_key_alone_answers_a_question_and_each_other_one_ends_it():
    for keys, come_of_it in (
        (("SET",), ["gone", ("done", 9)]), (("START",), ["gone", ("gone on", 9)]),
        (("SET", "START"), ["gone"]), (("SET", "UP"), ["gone"]), (("STOP",), ["gone"]), ((), []),
    ):  # fmt: skip
        shown = Shown(SET="done", START="gone on")
        shown.step(0)
        assert shown.press(5, "SET", repeats=True) == []  # it was down before
        assert shown.press(9, *keys) == come_of_it, keys


def test_a_question_of_an_operator_is_answered_as_soon_as_it_is_there():
    shown = Shown()
    answers = {"SET": lambda now_ms: shown.happened.append(now_ms)}
    shown.question = Question(shown, ((b"ONE",), b"SET=DO"), (), answers)
    shown.step(0)
    assert shown.press(0, "SET") == ["gone", 0]
    assert shown.question.whole and not shown.question.obeys


def test_what_is_at_stake_is_told_in_turn_for_as_long_as_the_question_is_there():
    shown, screen, told = Shown(), Screen(), []
    shown.announcer = shown
    shown.question = Question(shown, ((b"ONE %d", b"TWO", b"THREE"), b"SET=DO"), (7,), {})
    for shown.page_turns in range(20):
        shown.question.draw(screen, 0)
        told.append([row.rstrip() for row in screen.rows()])
    rows = ("ONE 7", "TWO", "THREE")
    assert told == [[rows[turn % 3], "SET=DO"] for turn in range(20)]


def test_a_question_lasts_half_a_minute_from_when_it_was_shown():
    for began_ms in (0, 0xFFFF - 9_000):  # the clock begins anew meanwhile
        shown = Shown(began_ms, SET="done")
        assert shown.step(0) == shown.step(29_999) == [] and shown.step(30_000) == ["gone"]


def test_an_answer_counts_once_the_question_can_have_been_read():
    for began_ms in (0, 0xFFFF - 500):
        shown = Shown(began_ms, 1_000, SET="done")
        assert shown.press(0, "SET") == []  # it has not even been shown
        shown.step(0)
        assert shown.press(999, "SET") == []
        assert shown.press(1_000, "SET")[0] == "gone" and len(shown.happened) == 2
        shown = Shown(began_ms, 1_000, SET="done")
        shown.step(0)
        assert shown.press(1, "PARAM") == ["gone"]  # a no may come as soon as it likes


def test_an_answer_counts_half_a_second_after_what_has_hidden_the_keys_of_it():
    for began_ms in (0, 0xFFFF - 800):
        shown = Shown(began_ms, SET="done")
        shown.message = b"WRITTEN"
        shown.step(0)
        shown.step(700)
        shown.message = None
        shown.step(750)
        assert shown.press(760, "SET") == []
        shown.step(1_199)
        assert shown.press(1_199, "SET") == []
        shown.step(1_200)
        assert shown.press(1_200, "SET")[0] == "gone" and len(shown.happened) == 2


def test_only_an_alarm_that_comes_takes_a_question_away():
    shown = Shown(SET="done")
    assert shown.step(0) == []
    shown.alarm = True
    assert shown.step(10) == ["gone"]
    Shown.alarm = True
    try:
        shown = Shown(SET="done")
    finally:
        Shown.alarm = False
    shown.alarm = True  # it was there before
    assert shown.step(0) == shown.step(10) == []
    shown.alarm = False
    assert shown.step(20) == []
    shown.alarm = True
    assert shown.step(30) == ["gone"]


# --- SET by itself -------------------------------------------------------------------------------


class Desk:
    """What SET on a page of parameters asks of its panel and of the drive."""

    mask = 0xFFFF
    runs = starting = False
    taken = ()
    tries = True

    def __init__(self, family=MM440):
        self.family = family
        self.survey = self.selected = self
        self.said, self.wrote, self.covers = [], [], []
        self.writing = Writing(self)

    def any_runs(self):
        return self.runs

    def is_starting(self):
        return self.starting

    def needs_attention(self):
        return False

    def is_taken(self, address):
        return address in self.taken

    def say(self, _now_ms, *said):
        self.said.append(said)

    def cover(self, page):
        self.covers.append(page)

    def write(self, now_ms, _control, *what):
        self.wrote.append((now_ms,) + what)
        self.outcome, self.done = None, False
        return self if self.tries else None

    def set(self, now_ms, number, value, risk=None):
        self.writing.set(now_ms, (self, number, 0, value), risk, (1, 2, 3))

    def end(self, is_done):
        self.outcome, self.done = (words.WRITTEN,), is_done

    def steps(self, *times_ms, down=1):
        """What was written in these steps."""
        before = len(self.wrote)
        for now_ms in times_ms:
            self.writing.step(down, now_ms & self.mask)
        return self.wrote[before:]


def test_a_set_that_is_held_for_1500_ms_alone_writes_the_eeprom_after_the_ram():
    for began_ms in (0, 0xFFFF - 700):  # the clock begins anew meanwhile
        desk = Desk()
        desk.set(began_ms, 1000, 5)
        assert desk.wrote == [(began_ms, 1000, 0, 5, False)]
        assert desk.steps(began_ms + 100, began_ms + 1_600) == []  # the drive has not said so
        desk.end(True)
        assert desk.writing.step(1, began_ms + 100 & desk.mask) is desk
        assert desk.writing.step(1, began_ms + 200 & desk.mask) is None
        assert desk.steps(began_ms + 1_499) == []
        at_ms = began_ms + 1_500
        assert desk.steps(at_ms) == [(at_ms & desk.mask, 1000, 0, 5, True)]
        desk.end(True)
        assert desk.steps(at_ms + 10, at_ms + 1_500, at_ms + 9_000) == []  # once


def test_what_ends_a_held_set_makes_nothing_permanent():
    def let_go(desk):
        desk.writing.let_go()

    def up(desk):
        desk.steps(200, down=0)

    def forget(desk):
        desk.writing.forget()

    for what in (let_go, up, forget):
        desk = Desk()
        desk.set(0, 1000, 5)
        desk.end(True)
        desk.steps(100)
        what(desk)
        assert desk.steps(300, 1_500, 5_000) == [], what
    desk = Desk()
    desk.set(0, 1000, 5)
    desk.end(False)
    assert desk.steps(100, 1_500, 5_000) == []  # it was not written
    desk = Desk(MM3)
    desk.set(0, 5, 5)  # no family of those has a task for the EEPROM
    desk.end(True)
    assert desk.steps(100, 1_500, 5_000) == [] and desk.wrote == [(0, 5, 0, 5, False)]
    desk = Desk()
    desk.tries = False
    desk.set(0, 1000, 5)
    assert desk.steps(100, 1_500, 5_000) == []  # it could not be tried
    desk = Desk()
    desk.set(0, MM440.address_number, 7)
    assert desk.wrote == [(0, MM440.address_number, 0, 7, True)]  # at once: it always lasts
    desk.end(True)
    assert desk.steps(100, 1_500, 5_000) == []


def test_an_address_is_written_where_all_stands_and_nobody_has_it():
    number = MM440.address_number
    for field, value, reason in (
        ("runs", True, texts.STOP_FIRST), ("starting", True, texts.STOP_FIRST),
        ("taken", (7,), words.ADDRESS_TAKEN), ("taken", (8,), None),
    ):  # fmt: skip
        for risk in (None, CUTS_OFF):
            desk = Desk()
            setattr(desk, field, value)
            desk.set(0, number, 7, risk)
            if reason is None and risk == CUTS_OFF:
                assert len(desk.covers) == 1 and not desk.said and not desk.wrote
            else:
                assert desk.covers == []
                assert desk.said == ([(reason,)] if reason else [])
                assert len(desk.wrote) == (0 if reason else 1)
        for other in (number - 1, number + 1):
            desk = Desk()
            setattr(desk, field, value)
            desk.set(0, other, 7)
            assert desk.said == [] and len(desk.wrote) == 1


def test_a_value_of_two_words_is_written_as_wide_as_it_is():
    desk = Desk()
    desk.writing.set(0, (desk, 1120, 1, 1 << 17, pkw.DOUBLE), None, ())
    desk.end(True)
    desk.steps(100, 1_500)
    assert desk.wrote == [
        (now_ms, 1120, 1, 1 << 17, eeprom, pkw.DOUBLE)
        for now_ms, eeprom in ((0, False), (1_500, True))
    ]


def test_what_has_come_about_while_a_question_was_open_counts():
    desk = Desk()
    desk.set(0, MM440.address_number, 7, CUTS_OFF)
    desk.runs = True
    keys = Keys(KEY_NAMES, desk.mask)
    keys.pressed = keys.bit("SET")
    desk.uncover = lambda: None
    desk.covers[0].take_keys(Acts(keys), 50)
    assert desk.said == [(texts.STOP_FIRST,)] and desk.wrote == []


def test_each_risk_has_its_question():
    for risk in ASK:
        stakes, choice = ASK[risk]
        assert stakes[0] % (1, 700, 2) == b"A1: P0700=2" and choice == ASKED.encode()
    assert len({ASK[risk] for risk in ASK}) == len(ASK) == 2


def test_an_alarm_of_another_drive_is_not_hidden_by_a_question():
    world = running(addresses=(1, 2))
    world.press("ADDRESS_UP")
    edit(show(world, "P1000"), 3)
    world.press("SET")
    world.drives[1].unplug()
    world.run(1500)
    rows = set()
    for _ in range(80):
        world.run(50)
        rows.add(row_1(world).rstrip())
        assert row_2(world) == ASKED
    assert "A1 LOST,MAY RUN" in rows, rows
    world.check()
