# SPDX-License-Identifier: MIT
"""The operator's manual, faults and warnings: what one means, what to do; the fault memory."""

import sys

from lookup_bench import choose, entries, forget_modules, go_to, hold, press, speak, wait, world_of
from panel.lookup import broken
from panel_bench import OFF1, row_1, row_2, telegrams


def text_of(world):
    """What the list says, heading by heading, each in one line."""
    said = {}
    for heading, line in entries(world):
        said[heading] = (said.get(heading, "") + " " + line.strip()).strip()
    return said


def asks_for(world, number, since_us):
    """Telegrams of the panel with a task for this parameter, since an instant."""
    return [
        characters
        for at_us, from_panel, characters in world.wire.log.last(1000)
        if from_panel and at_us >= since_us and characters[3] >> 4
        and (characters[3] & 7) << 8 | characters[4] == number
    ]  # fmt: skip


def test_a_fault_is_read_understood_and_cleared():
    world = world_of()
    drive = world.drives[1]
    press(world, "START")
    world.run(3000)
    drive.fault(1)
    wait(world, "FAULT F0001  A1")
    world.run(500)
    hold(world, "PARAM", 1400)
    world.run(500)
    assert row_2(world) == ">WHAT IS F0001", world.lcd()
    press(world, "SET")
    world.run(500)
    said = text_of(world)
    assert sorted(said) == ["CAUSE", "F0001", "REMEDY"], said
    assert said["F0001"] == "Overcurrent"
    assert said["CAUSE"].startswith("Short circuit") and said["REMEDY"].endswith("."), said
    drive.clear_cause()
    press(world, "PARAM", "PARAM")
    wait(world, "FAULT F0001  A1")
    world.run(1200)
    press(world, "STOP")
    world.run(1000)
    assert row_2(world) == "READY        A1", world.lcd()
    world.check()


def test_a_text_is_broken_between_words_as_far_as_they_fit():
    for whole, lines in (
        (b"", []),
        (b"Current limit", [b"Current limit"]),
        (b"The motor is on", [b"The motor is on"]),  # 15
        (b"The motor is off", [b"The motor is", b"off"]),
        (b"The motor is on again.", [b"The motor is on", b"again."]),
        (b"Check the|fan, the|filter", [b"Check the fan,", b"the filter"]),
        (b"Auto-identification of it", [b"Auto-identifica", b"tion of it"]),
        (b"of auto-identification", [b"of", b"auto-identifica", b"tion"]),
    ):
        assert list(broken(whole, 15)) == lines, list(broken(whole, 15))


def test_what_a_warning_means_and_how_it_is_cured():
    world = world_of()
    world.drives[1].warn(501)
    wait(world, "WARN A0501")
    go_to(world, "WHAT IS A0501")
    world.run(500)
    said = text_of(world)
    assert said["A0501"] == "Current limit", said
    assert said["CAUSE"].startswith("The motor takes more than the current limit."), said
    assert said["REMEDY"], said
    world.check()


def test_the_catalogue_speaks_the_language_of_the_panel():
    world = world_of()
    speak(world, "de")
    world.drives[1].warn(501)
    wait(world, "WARN A0501")
    hold(world, "PARAM", 1400)
    world.run(500)
    assert row_2(world) == ">WAS IST A0501", world.lcd()
    press(world, "SET")
    world.run(500)
    said = text_of(world)
    assert said["A0501"] == "Stromgrenze", said
    assert sorted(said) == ["A0501", "ABHILFE", "URSACHE"], said
    assert said["ABHILFE"], said
    world.check()


def test_a_family_with_other_numbers():
    world = world_of("v20")
    world.drives[1].fault(72)
    wait(world, "FAULT F72")
    world.run(1000)
    go_to(world, "WHAT IS F72")
    world.run(500)
    assert set(text_of(world)) == {"F72", "CAUSE", "REMEDY"}
    world.check()


def test_what_the_catalogue_does_not_know_it_says():
    world = world_of()
    world.drives[1].fault(999)
    wait(world, "FAULT F0999")
    world.run(1000)
    go_to(world, "WHAT IS F0999")
    world.run(500)
    assert entries(world) == [("F0999", "NO TEXT FOR IT")]
    world.check()


def test_without_a_fault_there_is_nothing_to_ask():
    world = world_of()
    hold(world, "PARAM", 1400)
    assert row_2(world) == ">DRIVES"
    world.check()


def test_a_fault_or_a_warning_without_a_number_cannot_be_asked_about():
    world = world_of()
    drive = world.drives[1]
    for number, report, text in ((2110, drive.warn, "WARN"), (947, drive.fault, "FAULT")):
        del drive.parameters.rows[number]
        report(1)
        wait(world, text)
        world.run(1500)
        hold(world, "PARAM", 1400)
        world.run(500)
        assert row_2(world) == ">DRIVES", world.lcd()
        press(world, "PARAM")


def test_beside_a_warning_the_other_lists_are_as_ever():
    world = world_of()
    world.drives[1].warn(501)
    wait(world, "WARN A0501")
    go_to(world, "DIAGNOSIS")
    world.run(500)
    assert (row_1(world)[:9], row_2(world)) == ("DIAGNOSIS", ">BUS COUNTERS"), world.lcd()
    world.check()


def test_the_fault_memory_has_the_last_faults_with_their_texts():
    world = world_of()
    drive = world.drives[1]
    for number in (1, 11):
        drive.fault(number)
        world.run(3000)
        drive.clear_cause()
        press(world, "STOP")
        world.run(1000)
    drive.stale_replies = 100_000  # it does not tell them yet
    go_to(world, "FAULT MEMORY")
    for key, place in (("SET", "1/8"), ("UP", "8/8"), ("SET", "8/8"), ("DOWN", "1/8")):
        press(world, key)
        assert world.lcd() == ("A1 FAULTS    %s" % place, ">...            "), world.lcd()
    drive.stale_replies = 0
    world.run(4000)
    told_us = world.clock.now_us
    there = entries(world)
    assert not asks_for(world, 947, told_us), "each is asked for once"
    told = [drive.read(947, index) for index in range(8)]
    assert told[0] == told[1] == 0 and {1, 11} < set(told), told
    there = [row for _, row in there]
    assert len(there) <= 8 and "F0001 Overcurre" in there and "NO FAULT" in there, there
    choose(world, "F0011")
    world.run(500)
    said = text_of(world)
    assert said["F0011"] == "Motor too hot" and said["REMEDY"], said
    press(world, "PARAM")
    world.run(300)
    assert row_1(world).startswith("A1 FAULTS"), world.lcd()
    choose(world, "F0001")  # the catalogue is still there for the list below
    world.run(500)
    assert text_of(world)["F0001"] == "Overcurrent"
    world.check()


def test_the_fault_memory_of_a_drive_without_indices_has_one_entry():
    world = world_of("mm3")
    go_to(world, "FAULT MEMORY")
    world.run(1000)
    assert world.lcd()[0] == "A1 FAULTS       " and row_2(world) == ">NO FAULT", world.lcd()
    press(world, "SET")  # it means nothing
    assert world.lcd()[0] == "A1 FAULTS       " and row_2(world) == ">NO FAULT", world.lcd()
    world.check()


def test_a_fault_memory_that_is_not_told_is_dashes():
    world = world_of()
    del world.drives[1].parameters.rows[947]
    go_to(world, "FAULT MEMORY")
    world.run(1500)
    assert row_2(world) == ">-----", world.lcd()


def test_the_elements_of_a_g120_are_asked_for_by_their_tasks():
    """But for the first, which is asked for like any value; other drives tell all of them so."""
    for kind, task in (("g120", 6), ("mm440", 1)):
        world = world_of(kind)
        since_us = world.clock.now_us
        go_to(world, "FAULT MEMORY")
        world.run(2000)
        assert {row for _, row in entries(world)} == {"NO FAULT"}
        number = world.app.panel.selected.survey.family.fault_number
        tasks = {(sent[6], sent[3] >> 4) for sent in asks_for(world, number, since_us)}
        assert tasks == {(0, 1)} | {(index, task) for index in range(1, 8)}, tasks
        world.check()


def test_stop_acts_while_the_text_is_read():
    world = world_of()
    world.drives[1].warn(600)
    press(world, "START")
    world.run(3000)
    wait(world, "WARN A0600")
    go_to(world, "WHAT IS A0600")
    world.run(500)
    assert world.drives[1].state == "running"
    pressed_us = world.clock.now_us
    press(world, "STOP")
    assert telegrams(world, pressed_us, 1)[1][1] == OFF1
    world.run(11_000)
    assert world.drives[1].state != "running" and row_2(world).startswith(">")
    world.check()


def test_all_of_it_leaves_the_memory():
    world = world_of()
    forget_modules()
    world.drives[1].warn(501)
    wait(world, "WARN A0501")
    go_to(world, "WHAT IS A0501")
    world.run(500)
    assert "panel.lookup.what" in sys.modules
    press(world, "PARAM", "PARAM")
    world.run(300)
    left = [name for name in sys.modules if name.startswith(("panel.lookup", "catalogue"))]
    assert left == [], left
    world.check()
