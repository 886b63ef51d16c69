# SPDX-License-Identifier: MIT
"""What an earlier 8051 panel for the same drives did wrong, and this one does right: its keys.

Each of its 21 known defects has a test that shows the right behaviour on the whole panel; the
first line of the test names the defect. Here are those an operator meets at the keys and on the
display: 1 to 6, 11 to 15, 18 and 19. Those of the line are in test_8051_line.py.
"""

import main
from boards.sim.world import World
from panel_bench import (
    LOOP_US,
    OFF1,
    ON,
    page_back,
    panel,
    row_1,
    row_2,
    running,
    said,
    starts,
    telegrams,
)  # fmt: skip

ON_REVERSE = 0x0C7F
JOG_RIGHT, JOG_LEFT = 0x057E, 0x067E
ACKNOWLEDGE = 0x04FE
OFF3 = 0x047A
JOG_BITS, BY_PANEL = 0x0300, 0x0400  # of the control word
RIGHT_AND_LEFT = (("JOG_RIGHT", JOG_RIGHT, "JOG RIGHT"), ("JOG_LEFT", JOG_LEFT, "JOG LEFT"))


def words(world, since_us, address=1):
    """The control words that a drive was sent since an instant, one for each telegram."""
    return [stw for _, stw in telegrams(world, since_us, address)]


def setpoints(world, since_us):
    """The setpoint words that were sent with ON since an instant."""
    return [
        characters[13] << 8 | characters[14]
        for at_us, from_panel, characters in world.wire.log.last(1000)
        if from_panel and at_us >= since_us and characters[12] & 1
    ]


def parameter_mode(steps=0, **options):
    """A panel that shows parameter so many steps behind the first one, as the drive tells it."""
    world = panel(**options)
    world.press("PARAM")
    for _ in range(steps):
        world.press("NEXT")
    world.run(500)
    return world


P0700, P1000, P2011, R2024, R2025 = range(5)  # steps to each


def shown(world):
    """Name and value of the parameter on the display; the value is None where there is none."""
    name, value = row_2(world)[:6], row_2(world)[6:12].strip()
    return name[:5], int(value) if value.isdigit() else None


def tap(world, key, times):
    for _ in range(times):
        world.press(key, 60)


# --- the motor -----------------------------------------------------------------------------------


def test_a_jog_ends_when_its_key_is_let_go():
    """Defect 1: the motor went on jogging after the key was released."""
    for key, stw, text in RIGHT_AND_LEFT:
        world = panel(loop_us=LOOP_US)
        world.down(key)
        world.run(2000)
        assert row_2(world) == text + " " * (13 - len(text)) + "A1"
        assert words(world, world.clock.now_us - 1_000_000) and world.drives[1].state == "running"
        assert set(words(world, world.clock.now_us - 1_000_000)) == {stw}
        world.up(key)
        world.run(100)  # debounced, and the exchange that goes on is over
        let_go_us = world.clock.now_us
        world.run(4000)
        assert set(words(world, let_go_us)) == {OFF1}
        assert world.drives[1].hz() == 0 and row_2(world) == "READY        A1"
        world.check()


def test_a_jog_that_was_stopped_does_not_go_on_though_its_key_is_down():
    """Defect 1, the other way round: no jog without a fresh press."""
    world = panel()
    world.down("JOG_RIGHT")
    world.run(1000)
    world.press("STOP")
    stopped_us = world.clock.now_us
    world.run(4000)
    assert set(words(world, stopped_us)) == {OFF1} and world.drives[1].hz() == 0
    world.up("JOG_RIGHT")
    world.check()


def test_reverse_at_standstill_only_chooses_the_direction():
    """Defect 2: the word for it held JOG right as well, so that the motor started."""
    world = panel()
    world.press("REVERSE")
    world.run(2000)
    assert set(words(world, 0)) == {OFF1} and starts(world) == 0
    assert world.lcd() == ("S:-10.0 F:  0.00", "READY        A1 ")
    started_us = world.clock.now_us
    world.press("START")
    world.run(4000)
    assert set(words(world, started_us)) == {OFF1, ON_REVERSE}  # OFF1 till the drive is asked
    assert abs(world.drives[1].hz() + 10) < 0.01
    world.check()


def test_reverse_while_the_motor_turns_is_no_jog():
    """Defect 2: the direction bit and nothing else, there and back."""
    world = running()
    for stw, hz in ((ON_REVERSE, -10), (ON, 10)):
        world.press("REVERSE")
        pressed_us = world.clock.now_us
        world.run(6000)
        assert set(words(world, pressed_us)) == {stw}
        assert abs(world.drives[1].hz() - hz) < 0.01
    assert not [stw for stw in words(world, 0) if stw & JOG_BITS] and starts(world) == 1
    world.check()


def test_another_address_leaves_one_drive_running_and_starts_no_other():
    """Defect 3: one image for all drives, so that the new address was started with the old ON."""
    world = running(addresses=(1, 2))
    for key in ("ADDRESS_UP", "ADDRESS_DOWN"):
        changed_us = world.clock.now_us
        world.press(key)
        world.run(2000)
        assert set(words(world, changed_us, 1)) == {ON}
        assert set(words(world, changed_us, 2)) == {OFF1}
    assert starts(world, 1) == 1 and starts(world, 2) == 0
    assert abs(world.drives[1].hz() - 10) < 0.01
    world.check()


def test_stop_and_reverse_of_another_address_do_not_touch_the_first():
    """Defect 3: each drive has an image of its own, whatever key is pressed."""
    world = running(addresses=(1, 2))
    world.press("ADDRESS_UP")
    changed_us = world.clock.now_us
    world.press("REVERSE")
    world.press("STOP")
    tap(world, "UP", 5)
    world.run(1000)
    assert set(words(world, changed_us, 1)) == {ON}
    assert abs(world.drives[1].hz() - 10) < 0.01
    world.check()


def test_the_first_telegram_is_off1_by_this_panel():
    """Defect 4: 0000 was sent before the first key: OFF2, OFF3, and not even the panel's word."""
    world = World(main.start, addresses=(1, 2))
    world.run(3000)
    for address in (1, 2):
        assert len(words(world, 0, address)) > 50
        assert set(words(world, 0, address)) == {OFF1}
    reset_us = world.clock.now_us
    world.reset()
    world.run(1000)
    assert words(world, reset_us, 1)[0] == OFF1
    world.check()


def test_whatever_is_pressed_the_word_is_one_of_a_few_and_has_the_control_bit():
    """Defects 2 and 4: no other combination of bits ever leaves the panel."""
    world = panel()
    sent = set()
    for key, ms in (
        ("START", 2500), ("REVERSE", 100), ("STOP", 2500), ("JOG_LEFT", 700), ("STOP", 100),
        ("START", 1000), ("STOP", 100), ("REVERSE", 100), ("START", 1500), ("STOP", 100),
    ):  # fmt: skip
        pressed_us = world.clock.now_us
        world.press(key, ms)
        world.run(3000)
        sent |= set(words(world, pressed_us))
    assert sent <= {OFF1, OFF3, ON, ON_REVERSE, JOG_LEFT} and {OFF1, OFF3, ON} <= sent, sent
    for stw in sent:
        assert stw & BY_PANEL
    world.check()


def test_the_setpoint_stays_between_zero_and_the_highest_frequency():
    """Defect 5: it went down below zero and up without a limit."""
    for started in (False, True):
        world = running() if started else panel()
        for key, text in (("DOWN", "  0.0"), ("UP", " 50.0")):
            began_us = world.clock.now_us
            for _ in range(2):  # the end is reached, and pressed against
                world.press(key, 8000)
            assert row_1(world)[2:7] == text, row_1(world)
            for hsw in setpoints(world, began_us):
                assert 0 <= hsw <= 0x4000, hsw  # 8000h and more are negative
        if started:
            assert setpoints(world, 0)[-1] == 0x4000
        world.check()


# --- what the drive says -------------------------------------------------------------------------


def test_a_fault_is_shown_with_its_number_and_stop_acknowledges_it():
    """Defect 6: a trip was neither shown nor could it be acknowledged."""
    world = running()
    world.drives[1].fault(11)
    world.run(600)
    assert row_2(world) == "FAULT F0011  A1"
    world.run(1200)
    pressed_us = world.clock.now_us
    world.press("STOP")
    world.run(1000)
    sent = words(world, pressed_us)
    assert sent[-1] == OFF1 and sent.count(ACKNOWLEDGE) == 1
    assert set(sent) == {OFF1, ACKNOWLEDGE}
    assert world.drives[1].state == "ready" and row_2(world) == "READY        A1"
    assert starts(world) == 1
    world.check()


def test_a_warning_is_shown():
    """Defect 6: a warning was not shown."""
    world = running()
    zsw = world.drives[1].process.zsw
    world.drives[1].process.zsw = lambda: zsw() | 0x80
    assert {row[:8].rstrip() for row in said(world, 3_500)} == {"RUNNING", "WARN"}
    world.check()


def test_a_frequency_to_the_left_is_negative_however_high_it_is():
    """Defect 12: 20000 - f for the left, told from the right by being above 100 Hz."""
    fast = {2014: 2000, 2000: 150.0, 1082: 150.0}
    for centihertz, right, left in ((1000, " 10.00", "-10.00"), (12000, "120.00", "-120.0")):
        world = panel(parameters=fast, settings={"setpoint_centihertz": centihertz})
        world.press("START")
        world.run(10_000)
        assert row_1(world)[10:] == right
        world.press("REVERSE")
        world.run(20_000)
        assert row_1(world)[10:] == left
        world.check()


def test_a_drive_that_falls_silent_is_told_of_within_three_failures():
    """Defect 18: the last frequency stayed on the display for ever."""
    world = running(loop_us=LOOP_US)
    assert row_1(world) == "S: 10.0 F: 10.00"
    world.drives[1].unplug()
    unplugged_us = world.clock.now_us
    while len(telegrams(world, unplugged_us)) < 4:  # the fourth follows the third failure
        world.run(2)
    world.run(100)  # a picture is begun every 45 ms
    assert row_1(world) == "S: 10.0 F: -----"
    assert world.clock.now_us - unplugged_us < 300_000
    world.run(1200)
    assert world.reads("NO CONTACT, MAY RUN") and "10.00" not in row_1(world)
    world.drives[1].plug()
    world.run(500)
    assert "-----" not in row_1(world) and not world.reads("NO CONTACT")
    world.check()


# --- parameters ----------------------------------------------------------------------------------


def test_the_drives_error_is_said_in_words_and_its_number_is_no_value():
    """Defect 11: the error number was shown as if it were the value. Here of a write: 104."""
    world = parameter_mode(P1000)
    world.press("EDIT")
    tap(world, "UP", 2)  # 7 is no source of setpoints
    world.press("SET")
    world.press("SET")  # yes
    world.run(500)
    assert row_2(world) == "NOT THIS VALUE"
    assert world.drives[1].read(1000) == 5
    world.press("EDIT")
    world.run(1000)
    assert shown(world) == ("P1000", 5)
    world.check()


def test_a_parameter_that_the_drive_does_not_know_has_no_value():
    """Defect 11, of a read: error 0 is not the value 0."""
    world = panel()
    del world.drives[1].parameters.rows[2024]
    world.press("PARAM")
    tap(world, "NEXT", R2024)
    world.run(500)
    assert row_2(world) == "NO SUCH PARAM."
    world.run(3500)
    assert row_2(world) == "r2024: ----- A1"
    world.check()


def test_the_list_of_parameters_goes_round_both_ways():
    """Defect 13: between the last and the first there was an empty place."""
    world = parameter_mode()
    order = ("P0700", "P1000", "P2011", "r2024", "r2025")
    for key, places in (("NEXT", (1, 2, 3, 4, 0, 1)), ("PREVIOUS", (0, 4, 3, 2, 1, 0, 4))):
        for place in places:
            world.press(key)
            world.run(300)
            name, value = shown(world)
            assert name == order[place] and value is not None, row_2(world)
    world.check()


def test_each_value_stays_within_its_own_limits():
    """Defect 14: a value wrapped at the maximum of the parameter shown before it."""
    for steps, key, highest in (
        (P0700, "NEXT", 6), (P1000, "NEXT", 77), (P2011, "NEXT", 31), (P2011 - 5, "PREVIOUS", 31),
    ):  # fmt: skip
        world = parameter_mode()
        tap(world, key, abs(steps))
        world.run(500)
        world.press("EDIT")
        for direction, end in (("UP", highest), ("DOWN", 0)):
            world.press(direction, 12_000)
            assert shown(world)[1] == end, (steps, row_2(world))
            tap(world, direction, 2)  # against the end
            assert shown(world)[1] == end, (steps, row_2(world))
        world.check()


def test_a_reading_cannot_be_edited():
    """Defect 14: it could, on the display."""
    for steps in (R2024, R2025):
        world = parameter_mode(steps)
        for key in ("EDIT", "UP", "DOWN"):
            world.press(key)
            world.run(100)
            assert row_2(world) == "READ ONLY", key
        world.press("SET")
        world.run(4000)
        assert telegrams_with_task(world, 1) and not telegrams_with_task(world, 2)
        world.check()


def telegrams_with_task(world, task):
    """How many of the panel's telegrams carried this parameter task."""
    sent = [characters for _, from_panel, characters in world.wire.log.last(1000) if from_panel]
    return len([characters for characters in sent if characters[3] >> 4 == task])


def test_a_write_that_may_cut_the_panel_off_asks_first():
    """Defect 15: it was written without a word."""
    for steps, number, asked in ((P0700, 700, 5), (P1000, 1000, 5), (P2011, 2011, 1)):
        world = parameter_mode(steps)
        world.press("EDIT")
        world.press("UP")
        world.press("SET", 2000)  # held, too: that is no yes
        assert world.reads("PANEL MAY LOSE") or world.reads("THE DRIVE BY IT")
        assert world.drives[1].read(number) == asked
        world.press("PARAM")  # no
        world.run(500)
        assert world.drives[1].read(number) == asked
        assert telegrams_with_task(world, 2) + telegrams_with_task(world, 14) == 0
        world.press("SET")
        world.press("SET")  # yes
        world.run(300)
        assert row_2(world).startswith("WRITTEN") and world.drives[1].read(number) == asked + 1
        world.check()


def test_the_panel_follows_a_drive_to_the_address_it_wrote():
    """Defect 15: writing P2011 lost the drive."""
    world = parameter_mode(P2011)
    world.press("EDIT")
    tap(world, "UP", 3)
    world.press("SET")
    world.press("SET")
    world.run(4000)
    assert world.drives[1].address == 4
    assert row_2(world) == "P2011:     4 A4"
    page_back(world)
    world.press("START")
    world.run(4000)
    assert world.lcd() == ("S: 10.0 F: 10.00", "RUNNING      A4 ")
    world.check()


def test_a_source_that_was_written_away_is_said_and_start_is_refused():
    """Defect 15: the panel seemed to be in command and was not."""
    for steps, state, refusal in (
        (P0700, "LOCAL        A1", "NO:P0700 NOT USS"),
        (P1000, "READY        A1", "NO:P1000 NOT USS"),
    ):
        world = parameter_mode(steps)
        world.press("EDIT")
        tap(world, "DOWN", 3)  # 2: the terminals
        world.press("SET")
        world.press("SET")
        world.run(4000)
        page_back(world)
        world.run(100)
        assert row_2(world) == state
        world.press("START")
        world.run(500)
        assert row_2(world) == refusal and starts(world) == 0
        world.check()


def test_a_tap_on_set_writes_the_ram_and_held_the_eeprom():
    """Defect 19: nothing outlived the drive's power."""
    for held_ms, outcome, kept in ((100, "WRITTEN (RAM)", 5), (2000, "WRITTEN (EEPROM)", 6)):
        world = parameter_mode(P1000)
        drive = world.drives[1]
        world.press("EDIT")
        world.press("UP")
        world.press("SET")
        world.press("SET", held_ms)
        world.run(500)
        assert row_2(world) == outcome and drive.read(1000) == 6
        drive.power_off()
        world.run(2000)
        drive.power_on()
        world.run(4000)
        assert drive.read(1000) == kept and shown(world) == ("P1000", kept)
        world.check()
