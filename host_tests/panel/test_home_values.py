# SPDX-License-Identifier: MIT
"""The operator's manual, the home page: NEXT and PREVIOUS show other values than the frequency.

Percent of the reference, and what the drive tells by parameters: Hz, 1/min, A, V, kW and C.
"""

import sys

from panel.phases import CHECKING, IDLE
from panel.screen import Screen
from panel_bench import (
    LOOP_US,
    OFF1,
    late,
    panel,
    row_1,
    row_2,
    running,
    telegrams,
    wait_until,
    wait_until_known,
)
from uss import pkw
from uss.families import MM3, MM440


def runs(kind="mm420", **more):
    """A panel whose drive, of this kind, runs at its setpoint."""
    family, _, words = kind.partition("/")
    module = __import__("boards.sim.drives.families." + family, None, None, (family,))
    own = {"family": module}
    if words:
        own["parameters"] = {2014: 2000, 2013: int(words)}
    settings = {"kinds": {"1": kind}, "unsupervised": [1]}
    return running(kinds={1: own}, settings=settings, **more)


def shown(world):
    """The value in row 1, once the drive has told it."""
    for _ in range(60):
        world.run(50)
        if not row_1(world)[7:].strip().startswith("?"):
            return row_1(world)[7:]
    raise AssertionError(world.lcd())


def values(world, key="NEXT"):
    """What row 1 shows behind the setpoint, from one press to the next, once round."""
    seen = []
    while len(seen) < 20:
        world.press(key)
        world.run(700)
        seen.append(shown(world))
        if "F:" in seen[-1]:
            return seen
    raise AssertionError(seen)


def units(seen):
    return [text.strip(" 0123456789.-") for text in seen]


def show(world, unit):
    """Press NEXT until this unit is shown."""
    for _ in range(12):
        world.press("NEXT")
        world.run(700)
        if row_1(world).rstrip().endswith(unit):
            return world
    raise AssertionError(world.lcd())


def asked(world, since_us, number):
    """How often the panel has asked for a parameter since an instant."""
    head = (0x1000 | number % 2000, 0x8000 if number >= 2000 else 0)
    told = 0
    for at_us, from_panel, characters in world.wire.log.last(1000):
        if from_panel and at_us >= since_us and len(characters) >= 12:
            words = (characters[3] << 8 | characters[4], characters[5] << 8 | characters[6])
            told += words == head
    return told


# --- what there is -------------------------------------------------------------------------------


def test_next_goes_through_all_values_and_round():
    world = runs("mm440")
    seen = values(world)
    assert units(seen) == ["%", "Hz", "rpm", "A", "V", "Vdc", "kW", "C M", "C I", "F:"], seen
    drive = world.drives[1]
    for text, number in zip(seen[1:-1], (24, 22, 27, 25, 26, 32, 35, 37)):
        value = float(text.strip().rstrip("HzrpmAVdckWMI C"))
        assert abs(value - drive.read(number)) <= max(0.51, abs(value) / 50), (text, number)
    assert seen[0] == "  20.0%  " and seen[1] == " 10.00Hz ", seen
    assert seen[-1] == " F: 10.00"
    world.check()


def test_previous_goes_the_other_way():
    world = runs("mm420")
    assert units(values(world)) == ["%", "Hz", "rpm", "A", "V", "Vdc", "C I", "F:"]
    assert units(values(world, "PREVIOUS")) == ["C I", "Vdc", "V", "A", "rpm", "Hz", "%", "F:"]
    world.check()


def test_each_family_shows_what_it_has():
    common = ["Hz", "rpm", "A", "V", "Vdc"]
    for kind, wanted in (
        ("g110", ["%"] + common + ["C I", "F:"]),
        ("v20", ["%"] + common + ["kW", "C M", "C I", "F:"]),
        ("g120", common + ["kW", "C M", "%F:"]),  # this one refuses r0037, and is in percent
        ("mm3", ["%", "rpm", "A", "V", "Vdc", "F:"]),
    ):
        world = runs(kind)
        seen = values(world)
        assert units(seen) == wanted, (kind, seen)
        world.check()


def test_a_value_in_words_has_its_decimals():
    world = show(runs("mm3"), "A")
    drive = world.drives[1]
    assert abs(float(shown(world).strip()[:-1]) - drive.read(132) / 10) < 0.05, world.lcd()
    show(world, "rpm")
    assert abs(int(shown(world).strip()[:-3]) - drive.read(135)) <= 2, world.lcd()


def test_without_a_parameter_channel_there_is_only_what_pzd_tells():
    world = panel(kinds={1: {"parameters": {2013: 0}}}, settings={"kinds": {"1": "mm420/0"}})
    wait_until_known(world)
    assert row_1(world) == "S: 10.0%F:  0.00"
    world.press("NEXT")
    world.run(500)
    assert row_1(world) == "S: 10.0%F:  0.00"
    world.check()


def test_it_turns_left_with_a_minus():
    world = runs("mm440")
    world.press("REVERSE")
    world.run(5000)
    seen = values(world)
    assert seen[0].strip() == "-20.0%" and seen[1].strip() == "-10.0Hz", seen
    assert seen[2].strip().startswith("-"), seen
    world.check()


def drawn(world, values_shown):
    """Row 1 behind the setpoint, drawn anew."""
    screen = world.app.panel.screen
    screen.put(0, 0, 16, b"")
    assert values_shown.draw(screen)
    return screen.rows()[0][6:]


def test_percent_beyond_what_a_word_can_say():
    from panel.pages.values import Values

    world = runs("mm440")
    values_shown = Values(world.app.panel)
    values_shown.turn(1)
    assert drawn(world, values_shown).strip() == "20.0%"
    drive = world.app.panel.selected.drive
    for centihertz, text in ((1002, "20.0%"), (1003, "20.1%"), (-1002, "-20.0%")):  # the nearest
        drive.hiw = round(centihertz * 16384 / 5000) & 0xFFFF
        assert drawn(world, values_shown).strip() == text, centihertz
    drive.hiw = 0x7FFF
    assert drawn(world, values_shown) == "  >>>>>%  "


def test_a_value_of_the_drive_shown_before_is_not_drawn_for_another():
    from panel.pages.values import Values

    world = panel(addresses=(1, 2))
    wait_until_known(world)
    values_shown = Values(world.app.panel)
    for _ in range(3):
        values_shown.turn(1)
    assert drawn(world, values_shown).strip() == "?rpm"
    world.press("ADDRESS_UP")
    screen = world.app.panel.screen
    screen.put(0, 0, 16, b"")
    assert not values_shown.draw(screen) and screen.rows()[0] == " " * 16
    assert values_shown.step(0) and drawn(world, values_shown).strip() == "?rpm"


def tells(world, number, value):
    """From now on the drive has this value under a number."""
    readings = world.drives[1].readings
    tell = readings.value
    readings.value = lambda asked, index: value if asked == number else tell(asked, index)


def test_every_value_that_a_drive_may_tell_has_room():
    world = show(runs("mm440"), "rpm")
    for value, text in (
        (-15000.0, "-15000rpm"), (15000.0, "15000rpm"), (-9999.4, "-9999rpm"), (0.4, "0rpm"),
        (0.5, "1rpm"), (-0.0, "0rpm"), (1e-30, "0rpm"), (131000.0, "131000rpm"),
        (100_000.0, "100000rpm"), (-10_000.0, "-10000rpm"),
        (1e6, "-----rpm"), (-1e38, "-----rpm"), (float("inf"), "-----rpm"),
    ):  # fmt: skip
        tells(world, 22, value)
        world.run(1500)
        assert row_1(world)[7:].strip() == text, (value, world.lcd())
    show(world, "A")
    for value, text in (
        (0.004, "0.00A"),
        (49.5, "49.50A"),
        (655.35, "655.4A"),
        (-1.5, "-1.50A"),
    ):
        tells(world, 27, value)
        world.run(1500)
        assert row_1(world)[7:].strip() == text, (value, world.lcd())


# --- what it does and what it does not -----------------------------------------------------------


def test_it_follows_the_drive():
    world = show(runs("mm440"), "rpm")
    before = shown(world)
    world.press("UP", 3000)
    world.run(5000)
    after = shown(world)
    assert int(after.strip()[:-3]) > int(before.strip()[:-3]) + 100, (before, after)
    world.press("STOP")
    world.run(6000)
    assert shown(world) == "     0rpm", world.lcd()
    world.check()


def test_stop_acts_at_once():
    world = show(runs("mm440"), "A")
    pressed_us = world.clock.now_us
    world.press("STOP")
    sent = telegrams(world, pressed_us, 1)
    assert any(stw == OFF1 and at_us - pressed_us < 40_000 for at_us, stw in sent), sent
    world.run(6000)
    assert world.drives[1].hz() == 0
    world.check()


def test_a_start_is_not_later_by_it():
    def start_ms(world):
        world.run(2000)
        pressed_us = world.clock.now_us
        world.press("START")
        world.run(2000)
        on = [at_us for at_us, stw in telegrams(world, pressed_us, 1) if stw == 0x047F]
        return (on[0] - pressed_us) // 1000

    plain = panel()
    wait_until_known(plain)
    world = panel()
    wait_until_known(world)
    show(world, "A")
    assert start_ms(world) <= start_ms(plain) + 100
    world.check()


def test_of_a_drive_that_is_turned_to_its_settings_are_read_before_its_value():
    world = show(panel(addresses=(1, 2)), "A")
    for address in (2, 1):
        world.press("ADDRESS_UP")
        since_us = world.clock.now_us
        world.run(500)
        assert asked(world, since_us, 27) == 0 and row_1(world)[7:] == "     ?A  ", world.lcd()
        world.run(2000)
        assert shown(world) == "  0.00A  " and world.selected() == address, world.lcd()


def test_it_is_read_about_three_times_a_second():
    world = show(runs("mm440"), "A")
    since_us = world.clock.now_us
    world.run(3000)
    assert 7 <= asked(world, since_us, 27) <= 11
    while " F:" not in row_1(world):
        world.press("NEXT")
    since_us = world.clock.now_us
    world.run(3000)
    assert asked(world, since_us, 27) == 0  # not any more


def test_another_page_and_back_reads_it_anew():
    world = show(runs("mm440", loop_us=LOOP_US), "Vdc")
    before = shown(world)
    world.press("PARAM")
    world.run(500)
    assert " F:" in row_1(world), world.lcd()  # parameter mode has the frequency
    since_us = world.clock.now_us
    world.run(2000)
    assert asked(world, since_us, 26) == 0
    tells(world, 26, 321.0)
    world.down("PARAM")
    seen = set()
    for _ in range(100):
        world.run(5)
        seen.add(row_1(world)[7:])
    world.up("PARAM")
    assert "   321Vdc" in seen and before not in seen, (before, seen)
    world.check()


def test_the_value_stays_selected_while_other_drives_are_shown():
    from boards.sim.drives.families import generic, mm440

    kinds = {1: {"family": mm440}, 2: {"family": generic}, 3: {"family": mm440}}
    settings = {"kinds": {"1": "mm440", "2": "generic", "3": "mm440"}}
    world = panel(addresses=(1, 2, 3), kinds=kinds, settings=settings)
    wait_until_known(world)
    show(world, "kW")
    world.press("ADDRESS_UP")
    world.run(1500)
    assert row_1(world) == "S: 10.0%F:  0.00" and row_2(world).endswith("A2"), world.lcd()
    world.press("ADDRESS_UP")
    world.run(1500)
    assert shown(world) == "  0.00kW " and row_2(world).endswith("A3"), world.lcd()
    show(world, "%")
    world.press("ADDRESS_DOWN")  # this one is shown in percent anyway
    world.run(1500)
    assert row_1(world) == "S: 10.0%F:  0.00" and row_2(world).endswith("A2"), world.lcd()
    world.press("ADDRESS_UP")
    world.run(1500)
    assert row_1(world) == "S: 10.0   0.0%  " and row_2(world).endswith("A3"), world.lcd()
    world.check()


def test_from_a_value_that_a_drive_lacks_the_keys_go_on_as_from_its_frequency():
    from boards.sim.drives.families import mm3, mm440

    kinds, settings = {1: {"family": mm440}, 2: {"family": mm3}}, {"1": "mm440", "2": "mm3"}
    for key, unit in (("NEXT", "%"), ("PREVIOUS", "Vdc")):
        world = panel(addresses=(1, 2), kinds=kinds, settings={"kinds": settings})
        wait_until_known(world)
        show(world, "kW")
        world.press("ADDRESS_UP")
        world.run(1500)
        assert "F:" in row_1(world) and row_2(world).endswith("A2"), world.lcd()
        world.press(key)
        world.run(700)
        assert units([shown(world)]) == [unit], (key, world.lcd())
        world.check()


def test_without_contact_it_is_dashes():
    world = show(panel(), "Vdc")
    world.drives[1].unplug()
    world.run(3000)
    assert row_1(world) == "S: 10.0 -----Vdc", world.lcd()
    world.press("PREVIOUS")
    world.run(100)
    world.press("NEXT")
    world.run(500)
    assert row_1(world)[7:] == " -----Vdc", world.lcd()
    world.run(5000)  # nor is it asked for meanwhile, and found not to be told
    world.drives[1].plug()
    drive = world.app.panel.selected.drive
    wait_until(world, lambda: drive.contact, 8_000)
    world.run(100)
    for _ in range(300):
        assert "-" not in row_1(world), world.lcd()
        world.run(10)
    assert shown(world).endswith("Vdc"), world.lcd()
    world.check()


def test_percent_without_contact_is_dashes():
    world = show(panel(), "%")
    world.drives[1].unplug()
    world.run(3000)
    assert row_1(world)[7:] == " -----%  ", world.lcd()


def test_a_value_that_is_late_is_not_shown_as_if_it_were_new():
    world = show(runs("mm440"), "A")
    late(world, 27)
    for _ in range(200):
        world.run(20)
        if row_1(world)[7:] == " -----A  ":
            break
    else:
        raise AssertionError(world.lcd())
    world.run(4000)
    assert "-----" not in row_1(world), world.lcd()


def test_a_value_that_is_not_told_any_more_is_not_shown_after_three_seconds():
    """The drive goes on with the answer to an old question, whatever it is asked."""
    world = show(runs("mm440"), "A")
    world.run(500)
    world.drives[1].stale_replies = 1_000_000
    before = row_1(world)
    world.run(2_600)
    assert row_1(world) == before, world.lcd()
    world.run(700)
    assert row_1(world)[7:] == "     ?A  ", world.lcd()
    world.run(2_000)  # the question is given up
    assert row_1(world)[7:] == " -----A  ", world.lcd()
    world.check()


def test_a_value_in_a_form_that_nobody_expects_is_dashes():
    """The current as a word, where all others of its family tell a floating-point number."""
    world = runs("mm440")
    rows = world.drives[1].parameters.rows
    rows[27] = rows[27][:2] + ("U16",) + rows[27][3:]
    tells(world, 27, 5)
    show(world, "A")
    world.run(500)
    assert row_1(world)[7:] == " -----A  ", world.lcd()
    world.check()


def test_refused_values_are_left_out_in_both_directions():
    world = runs("mm440")
    rows = world.drives[1].parameters.rows
    for number in (27, 25):
        del rows[number]
    there = ["%", "Hz", "rpm", "Vdc", "kW", "C M", "C I", "F:"]
    for _ in range(2):
        assert units(values(world)) == there
        assert units(values(world, "PREVIOUS")) == there[-2::-1] + there[-1:]
    world.check()


def test_a_value_on_which_the_drive_falls_silent_is_left_out_as_well():
    world = runs("mm440")
    hear = world.drives[1].slave.hear

    def hear_selectively(burst):
        is_asked = bytes(burst.data[3 : min(5, burst.count)]) == b"\x10\x1b"  # r0027, the current
        return None if is_asked else hear(burst)

    world.drives[1].slave.hear = hear_selectively
    there = ["%", "Hz", "rpm", "V", "Vdc", "kW", "C M", "C I", "F:"]
    for _ in range(2):
        assert units(values(world)) == there
    assert world.drives[1].state == "running"


def test_a_refused_value_is_left_out_and_not_asked_for_again():
    world = runs("g120")
    since_us = world.clock.now_us
    values(world)
    first = asked(world, since_us, 37)
    assert first >= 1
    since_us = world.clock.now_us
    values(world)
    assert asked(world, since_us, 37) == 0
    world.check()


def test_a_value_that_is_refused_later_is_dashes_and_asked_for_seldom():
    world = show(runs("mm440"), "A")
    rows = world.drives[1].parameters.rows
    kept = rows.pop(27)
    try:
        world.run(2000)
        assert row_1(world)[7:] == " -----A  ", world.lcd()
        since_us = world.clock.now_us
        world.run(5000)
        assert asked(world, since_us, 27) <= 3
        world.press("NEXT")
        world.run(700)
        assert shown(world).strip().endswith("V")
    finally:
        rows[27] = kept
    world.check()


def test_a_value_that_is_told_again_is_there_ten_seconds_later():
    world = show(runs("mm440"), "A")
    rows = world.drives[1].parameters.rows
    kept = rows.pop(27)
    world.run(2000)
    rows[27] = kept
    assert row_1(world)[7:] == " -----A  ", world.lcd()
    world.run(10_300)
    assert float(row_1(world)[7:13]) > 0, world.lcd()
    world.check()


# --- by themselves -------------------------------------------------------------------------------


class Told:
    """A panel with one drive, which is asked, and answers what and when the test says."""

    mask = 0xFFFF
    contact = True
    phase = IDLE
    unchecked = 0
    pkw_words = 4
    full = False
    percent = False
    scaling = None

    def __init__(self, unit, family=MM440):
        from panel.pages.values import Values

        self.selected = self.drive = self.survey = self.layout = self.channel = self
        self.family = family
        self.remembered = {}
        self.screen = Screen()
        self.jobs = []
        self.values = Values(self)
        while not self.row().rstrip().endswith(unit):
            assert self.values.turn(1)

    def is_percent(self):
        return self.percent

    def actual_is_beyond(self):
        return False

    def actual_centihertz(self):
        return None

    def is_full(self):
        return self.full

    def ask(self, job):
        job.state = pkw.PENDING
        self.jobs.append(job)

    def row(self):
        self.screen.put(0, 0, 16, b"")
        return self.screen.rows()[0][7:] if self.values.draw(self.screen) else "frequency"

    def asks(self, now_ms):
        """Whether it is asked in the step at this time."""
        before = len(self.jobs)
        assert self.values.step(now_ms & self.mask)
        return len(self.jobs) > before

    def answer(self, now_ms, value=None, state=pkw.DONE, width=pkw.DOUBLE):
        """The drive answers; what is shown then."""
        job = self.jobs[-1]
        job.state, job.width = state, width if state == pkw.DONE else 0
        if value is not None and width == pkw.DOUBLE:
            job.high, job.low = pkw.float_to_words(value)
        elif value is not None:
            job.low = value
        self.is_shown = self.values.step(now_ms & self.mask)
        return self.row().strip()


def test_the_next_question_follows_300_ms_after_an_answer_and_10_s_after_a_refusal():
    for began_ms in (20, 0xFFFF - 200):  # the clock begins anew meanwhile
        told = Told("A")
        assert told.asks(began_ms) and not told.asks(began_ms + 9)
        assert told.answer(began_ms + 10, 1.25) == "1.25A"
        answered_ms = began_ms + 10
        for state, wait_ms in (
            (pkw.DONE, 300), (pkw.TIMED_OUT, 300), (pkw.REFUSED, 10_000), (pkw.UNANSWERED, 10_000),
        ):  # fmt: skip
            assert not told.asks(answered_ms + 299) and told.asks(answered_ms + 300)
            row = told.answer(answered_ms + 320, 1.25, state)
            assert row == ("1.25A" if state == pkw.DONE else "-----A"), state
            answered_ms += 320
            assert not told.asks(answered_ms + wait_ms - 1) and told.asks(answered_ms + wait_ms)
            assert told.answer(answered_ms + wait_ms + 5, 2.0) == "2.00A"
            answered_ms += wait_ms + 5


def test_a_value_is_shown_until_3_s_after_it_was_told():
    told = Told("V")
    told.asks(0)
    assert told.answer(50, 230.4) == "230V" and told.asks(350)
    for now_ms, row in ((3_049, "230V"), (3_050, "?V"), (9_000, "?V")):
        assert not told.asks(now_ms) and told.row().strip() == row


def test_a_start_and_a_drive_that_is_not_known_yet_go_first():
    told = Told("A")
    told.phase = CHECKING
    assert not told.asks(0)
    told.phase, told.unchecked = IDLE, 1
    assert not told.asks(10)
    told.unchecked, told.full = 0, True
    assert not told.asks(20)
    told.full = False
    assert told.asks(30)


def test_only_what_next_has_just_come_to_is_left_out_when_it_is_refused():
    told = Told("rpm")
    told.asks(0)
    assert told.answer(10, state=pkw.REFUSED).endswith("?A") and told.is_shown
    told.asks(20)
    assert told.answer(30, 1.0) == "1.00A"
    told.asks(330)
    assert told.answer(340, state=pkw.REFUSED) == "-----A"  # it is told some other time
    for direction, unit in ((-1, "Hz"), (1, "A"), (1, "V")):
        assert told.values.turn(direction) and told.row().strip() == "?" + unit
    told = Told("Hz")
    told.values.turn(-1)
    told.values.turn(1)
    told.asks(0)
    assert told.answer(10, state=pkw.TIMED_OUT) == "-----Hz"  # it was not refused
    told.asks(310)
    assert told.answer(320, state=pkw.UNANSWERED).endswith("?rpm")
    told = Told("C I")
    told.asks(0)
    assert told.answer(10, state=pkw.UNANSWERED) == "frequency" and not told.is_shown


def test_a_floating_point_number_is_shown_to_the_nearest_hundredth_up_to_131071():
    told, now_ms = Told("A"), 0
    for value, row in (
        (0.0049, "0.00A"), (0.0051, "0.01A"), (0.0149, "0.01A"), (0.0151, "0.02A"),
        (0.0078, "0.01A"), (0.25, "0.25A"), (1.005001, "1.01A"), (1.9951, "2.00A"),
        (131071.0, "131071A"), (131072.0, "-----A"), (-0.0051, "-0.01A"), (-131071.0, "999999A"),
        (-9999.49, "-9999A"), (-9999.51, "-10000A"), (99999.4, "99999A"), (99999.6, "100000A"),
    ):  # fmt: skip
        assert told.asks(now_ms)
        assert told.answer(now_ms, value) == row, value
        now_ms += 300
    told.asks(now_ms)
    assert told.answer(now_ms, 5, width=pkw.WORD) == "-----A"  # nobody knows what it means
    told = Told("A", MM3)
    told.asks(0)
    assert told.answer(0, 25, width=pkw.WORD) == "2.50A"
    told.asks(300)
    assert told.answer(300, 25.0) == "-----A"


def test_percent_is_the_nearest_to_what_the_reference_says():
    told = Told("%")
    for reference, actual, row in (
        (6_500, 3, "0.1%"), (6_500, 2, "0.0%"), (6_500, -3, "-0.1%"), (6_500, 6_500, "100.0%"),
        (6_500, -13_000, "-200%"), (5_000, 65_000, "1300%"), (65_000, 32_500, "50.0%"),
        (65_000, 195_000, "300.0%"), (6_500, None, "-----%"),
    ):  # fmt: skip
        told.scaling, told.reference_centihertz = told, reference
        told.actual_centihertz = lambda actual=actual: actual
        assert told.row().strip() == row, (reference, actual, told.row())
    told.actual_centihertz = lambda: 6_500
    told.scaling = None  # it has not told its reference so far
    assert told.row().strip() == "-----%"
    told.actual_is_beyond = lambda: True
    assert told.row() == " >>>>>%  "
    told.actual_centihertz = lambda: None  # of a drive that is silent
    assert told.row().strip() == "-----%" and not told.asks(0)
    told.percent = True
    assert told.row() == "frequency"


def test_a_drive_that_is_lost_tells_nothing_and_is_asked_as_soon_as_it_is_back():
    for state, row in ((pkw.DONE, "1.25A"), (pkw.TIMED_OUT, "-----A")):
        told = Told("A")
        told.asks(0)
        assert told.answer(10, 1.25, state) == row
        told.contact = False
        assert not told.asks(20) and told.row().strip() == "-----A" and not told.asks(2_000)
        told.contact = True
        assert told.row().strip() == "?A" and told.asks(2_010)


def test_each_value_has_its_unit_and_its_decimals():
    for units_of, number in ((("Hz", "A", "kW"), " 12.35"),
                             (("rpm", "V", "Vdc", "C M", "C I"), "    12")):  # fmt: skip
        for unit in units_of:
            told = Told(unit)
            assert told.row() == "     ?%-3s" % unit
            told.asks(0)
            told.answer(0, 12.346)
            assert told.row() == "%s%-3s" % (number, unit)


def test_it_leaves_the_memory_with_the_frequency():
    world = show(panel(), "Hz")
    assert "panel.pages.values" in sys.modules and "uss.families.readings" not in sys.modules
    show(world, "C I")
    world.press("NEXT")
    world.run(700)
    assert " F:" in row_1(world) and "panel.pages.values" not in sys.modules
    world = show(runs("g120"), "C M")
    world.press("NEXT")  # to one that is refused, and on to the frequency
    world.run(700)
    assert "F:" in row_1(world) and "panel.pages.values" not in sys.modules
    world.check()
