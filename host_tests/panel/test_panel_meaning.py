# SPDX-License-Identifier: MIT
"""The operator's manual, hertz: what gives setpoint and actual value their meaning is read.

Parameters are changed behind the bus's back, as somebody at the drive does.
"""

from boards.sim.drives.families import mm440
from panel.setpoint import Setpoint
from panel_bench import (
    OFF1,
    ON,
    late,
    panel,
    row_1,
    row_2,
    running,
    settled_row_2,
    starts,
    take_commands_elsewhere_in_second_set,
    telegrams,
    unsupervised,
    wait_until_known,
)
from uss.families import rows
from version import VERSION

COM_LINK, STATUS, ACTUAL = 0x07F40000, 0x00340000, 0x00150000

# Number, index, a value with which the panel is not obeyed, what START says.
WRONG = (
    (700, 0, 2, "NO:P0700 NOT USS"),
    (719, 0, 10, "NO:P0719 NOT USS"),
    (719, 0, 45, "NO:P0719 NOT USS"),
    (719, 0, 3, "NO:P0719 NOT USS"),
    (719, 0, 51, "NO:P0719 NOT USS"),
    (840, 0, 0x02D20000, "NO:P0840 NOT USS"),
    (1000, 0, 2, "NO:P1000 NOT USS"),
    (1000, 0, 15, "NO:P1000 NOT USS"),
    (1070, 0, 0x02F30000, "NO:P1070 NOT USS"),
    (2200, 0, 0x00010000, "NO: P2200, PID"),
    (2019, 0, 0x00370000, "NO: P2019[0] ???"),
)


def set_at(drive, number, index, value):
    """What P0700 and P1000 connect stays as it is."""
    connected = [(source, drive.read(source)) for source in (840, 1070)]
    drive.write(number, index, value)
    for source, before in connected:
        if number != source:
            drive.write(source, 0, before)


def words(world, since_us):
    """The control words and setpoints of the panel since an instant."""
    sent = []
    for at_us, from_panel, characters in world.wire.log.last(5000):
        if from_panel and at_us >= since_us and len(characters) == 16:
            stw, hsw = characters[11] << 8 | characters[12], characters[13] << 8 | characters[14]
            sent.append((stw, hsw))
    return sent


def test_a_wrong_source_refuses_start():
    for number, index, value, refusal in WRONG:
        for settle_ms in (0, 4000):  # read by then, or only because START was pressed
            world = panel()
            wait_until_known(world)
            set_at(world.drives[1], number, index, value)
            world.run(settle_ms)
            world.press("START")
            said = [refusal] if settle_ms else [refusal, "NO: INHIBITED", "NO: NOT READY"]
            for _ in range(100):
                if row_2(world) in said:
                    break
                world.run(20)
            assert row_2(world) in said, (number, value, world.lcd())
            assert starts(world) == 0 and ON not in [stw for _, stw in telegrams(world, 0)]
            world.check()


def test_a_source_that_becomes_wrong_while_it_runs_takes_on_back():
    for number, index, value, _ in WRONG:
        world = running()
        set_at(world.drives[1], number, index, value)
        world.run(10_000)
        sent = [stw for _, stw in telegrams(world, world.clock.now_us - 1_000_000, 1)]
        assert set(sent) == {OFF1}, (number, value, world.lcd())
        world.check()


def test_p0719_decides_before_p0700_and_p1000():
    """55: ON and setpoint come from the terminals of the bus, whatever the others say."""
    for selection, number, value in ((55, 700, 2), (55, 1000, 2), (50, 700, 2), (5, 1000, 2)):
        world = panel()
        wait_until_known(world)
        world.drives[1].write(719, 0, selection)
        world.drives[1].write(number, 0, value)
        world.run(4000)
        world.press("START")
        world.run(3000)
        assert world.drives[1].state == "running", (selection, number, world.lcd())
        assert row_1(world) == "S: 10.0 F: 10.00"
        world.check()


def test_while_it_runs_the_limits_are_no_part_of_the_round():
    """They are read in between, in every other question: what is left comes round the sooner."""
    world = running()
    asked, log = [], world.wire.log
    for _ in range(60):
        seen = log.count
        world.run(200)
        for _at_us, from_panel, characters in log.last(log.count - seen):
            if from_panel and characters[3] >> 4 == 1:
                number = (characters[3] & 7) << 8 | characters[4]
                number += 2000 if characters[5] & 0x80 else 0
                if asked[-1:] != [number]:
                    asked.append(number)
    rounds = [place for place, number in enumerate(asked) if number == 2009]
    print(asked)
    assert rounds[1] - rounds[0] <= 2 * 13
    limits = [place for place, number in enumerate(asked) if number == 1082]
    assert max([after - before for before, after in zip(limits, limits[1:])]) <= 6


def test_an_actual_value_that_is_no_frequency_is_not_shown_as_one():
    """The drive runs all the same."""
    for source in (0, 0x001B0000, 0x00180000):  # nothing, r0027 A, r0024
        world = panel()
        wait_until_known(world)
        world.drives[1].write(2019, 1, source)
        world.press("START")
        world.run(4000)
        assert row_1(world) == "S: 10.0 F: -----" and row_2(world) == "RUNNING      A1"
        world.run(10_000)
        assert world.drives[1].state == "running" and row_2(world) == "RUNNING      A1"
        world.drives[1].write(2019, 1, ACTUAL)
        world.run(5000)
        assert row_1(world) == "S: 10.0 F: 10.00"
        world.check()


def test_what_becomes_no_frequency_while_it_runs_is_not_shown_for_long():
    """r0024 is much the same number, so nothing but reading P2019 shows it."""
    world = running()
    world.drives[1].write(2019, 1, 0x00180000)
    world.run(10_000)
    assert row_1(world) == "S: 10.0 F: -----" and row_2(world) == "RUNNING      A1", world.lcd()
    world.check()


def test_nothing_is_shown_in_hertz_before_its_meaning_is_read():
    """P2000, P2009 and P2019[1], whichever comes last."""
    world = panel(baud=2400)
    values = world.app.panel.selected.survey.values
    read_last = (rows.REFERENCE, rows.ABSOLUTE, rows.ACTUAL_SENT)
    splash = "USS %s IS NO" % VERSION
    dashes = 0
    while min([values[row] for row in read_last]) < 0:
        assert row_1(world) in ("S: 10.0 F: -----", splash, " " * 16), world.lcd()
        dashes += row_1(world).endswith("-----")
        world.run(20)
    world.run(300)
    assert dashes > 10 and row_1(world) == "S: 10.0 F:  0.00"
    world.check()


def test_a_drive_with_data_sets_is_asked_for_the_active_one():
    world = panel(kinds={1: {"family": mm440}})
    wait_until_known(world)
    take_commands_elsewhere_in_second_set(world.drives[1])
    world.run(5000)
    assert settled_row_2(world) == "LOCAL        A1"
    since_us = world.clock.now_us
    world.run(5000)
    asked = set()
    for at_us, from_panel, characters in world.wire.log.last(400):
        if from_panel and at_us > since_us and characters[3] >> 4:
            asked.add(((characters[3] & 7) << 8 | characters[4], characters[6]))
    for number in (700, 719, 840, 1000, 1070):
        assert (number, 1) in asked and (number, 0) not in asked, (number, asked)
    world.check()


def test_a_setpoint_that_a_limit_lowered_stays_there_while_it_runs():
    """41.9 Hz; P1082 is 5 Hz for a while, and 50 Hz again."""
    world = panel(settings={"setpoint_centihertz": 4190}, parameters={2014: 2000, 1120: 1.0})
    wait_until_known(world)
    world.press("START")
    world.run(5000)
    assert row_1(world) == "S: 41.9 F: 41.90"
    world.drives[1].write(1082, 0, 5.0)
    lowered_us = world.clock.now_us + 2_000_000
    world.run(90_000)
    assert row_1(world).startswith("S:  5.0")
    world.drives[1].write(1082, 0, 50.0)
    world.run(30_000)
    assert row_1(world) == "S:  5.0 F:  5.00", world.lcd()
    assert {hsw for _, hsw in words(world, lowered_us)} == {0x0666}
    world.press("UP")
    assert row_1(world).startswith("S:  5.1")
    world.check()


def test_a_limit_lowers_a_motor_soon():
    """2 s while it is shown, 10 s while it is not."""
    for key, ms in ((None, 2000), ("ADDRESS_UP", 10_000)):
        world = running(addresses=(1, 2))
        if key:
            world.press(key)
        world.run(1000)
        world.drives[1].write(1082, 0, 5.0)
        world.run(ms)
        since_us = world.clock.now_us
        world.run(300)
        assert {hsw for stw, hsw in words(world, since_us) if stw == ON} == {0x0666}, key
        world.check()


def test_a_minimum_frequency_raises_no_setpoint_of_a_motor_that_runs():
    """The drive turns at it all the same; the display says which setpoint is below it."""
    world = running()
    since_us = world.clock.now_us
    world.drives[1].write(1080, 0, 20.0)
    world.run(5000)
    assert row_1(world).startswith("S: 10.0 F: 20.0") and row_2(world) == "BELOW P1080  A1"
    assert {hsw for _, hsw in words(world, since_us)} == {0x0CCD}
    world.press("DOWN")
    assert row_1(world).startswith("S: 10.0")
    world.press("UP")
    world.run(200)
    assert row_1(world).startswith("S: 20.0") and row_2(world) == "RUNNING      A1"
    world.check()


def test_another_scaling_raises_no_setpoint_of_a_motor_that_runs():
    """P2000 halved: 10 Hz have become 5 Hz, and stay so. Doubled: 10 Hz they are again."""
    for number, index, value, shown in (
        (2000, 0, 25.0, "S:  5.0"),
        (2000, 0, 100.0, "S: 10.0"),
        (2009, 0, 1, "S: 10.0"),
    ):
        world = running()
        world.drives[1].write(number, index, value)
        world.run(100)
        highest = abs(world.drives[1].hz())
        in_force = min(1000, round(100 * setpoint_hz(world)))
        for _ in range(200):
            world.run(50)
            now = round(100 * setpoint_hz(world))
            assert now <= in_force or now > 1000, (number, value, now)  # until it is noticed
        assert row_1(world).startswith(shown), (number, value, world.lcd(), highest)
        world.check()


def setpoint_hz(world):
    """What the drive makes of the last setpoint sent."""
    drive = world.drives[1]
    hsw = words(world, 0)[-1][1]
    return hsw / 100 if drive.read(2009) else hsw * drive.read(2000) / 0x4000


def test_a_drive_that_falls_silent_on_what_it_lacks_is_known_all_the_same():
    """An MM420 has no r0050 and no r0051; this one does not even refuse them."""
    world = panel(kinds={1: {"switches": {"silent_refusals": True}}})
    wait_until_known(world, 40_000)
    known_us = world.clock.now_us
    world.run(10_000)
    assert questions(world, 50, 51, since_us=known_us) == 0, "its silence would slow the others"
    world.press("START")
    world.run(5000)
    assert world.drives[1].state == "running", world.lcd()
    running_us = world.clock.now_us
    world.run(10_000)
    assert row_2(world) == "RUNNING      A1" and starts(world) == 1
    assert questions(world, 50, 51, since_us=running_us) == 0
    world.check()


def test_a_drive_that_comes_back_is_asked_anew_for_what_it_did_not_answer():
    """It may be another one. Silence about r0050 and r0051 counts when it has come twice."""
    world = panel(kinds={1: {"switches": {"silent_refusals": True}}}, **unsupervised())
    wait_until_known(world, 40_000)
    before = questions(world, 50, 51)
    world.drives[1].unplug()
    world.run(3000)
    back_us = world.clock.now_us
    world.drives[1].plug()
    world.run(1000)
    wait_until_known(world, 40_000)
    after = questions(world, 50, 51, since_us=back_us)
    assert after >= before > 4, (before, after)
    world.check()


def questions(world, *numbers, since_us=0):
    """How many telegrams ask for one of these parameters."""
    count = 0
    for at_us, from_panel, characters in world.wire.log.last(5000):
        if from_panel and at_us >= since_us and len(characters) == 16:
            count += (characters[3] << 8 | characters[4]) - 0x1000 in numbers
    return count


def test_a_drive_that_is_silent_about_a_parameter_is_known_on_a_slow_line_as_well():
    """A round of 31 drives takes three seconds at 4800 baud: one silence loses a drive there. So
    it is asked again as long as it has more than its turn.
    """
    addresses = tuple(range(1, 32))
    kinds = {1: {"switches": {"silent_refusals": True}}}
    world = panel(baud=4800, addresses=addresses, kinds=kinds, parameters={2014: 20_000})
    world.run(10_000)
    wait_until_known(world, 60_000)
    world.check()


def test_a_drive_that_falls_silent_about_its_data_set_is_not_known_from_that_step_on():
    world = panel(addresses=(1, 2))
    wait_until_known(world)
    survey = world.app.panel.controls[0].survey
    world.press("START", 30)  # everything is read, of a drive that is soon shown no longer
    world.drives[1].switches.silent_refusals = True  # a MICROMASTER 420 has no r0051
    world.press("ADDRESS_UP", 30)
    was_unknown = False
    for _ in range(6_000):
        world.run(1)
        was_unknown = was_unknown or not survey.complete
        assert survey.scaling is not None or not survey.complete
    assert was_unknown
    world.check()


def test_a_question_that_was_open_for_too_long_is_asked_again():
    """START alone asks for P1210 and r2024; what is not known keeps a drive from being READY."""
    for number in (700, 1082, 1210, 2024):
        world = panel()
        wait_until_known(world)
        world.press("START", 30)
        late(world, number)
        world.press("STOP")
        wait_until_known(world)
        world.press("START")
        world.run(4000)
        assert row_2(world) == "RUNNING      A1", (number, world.lcd())
        world.check()


def test_a_count_that_came_too_late_does_not_matter_to_a_motor_that_runs():
    world = running()
    survey = world.app.panel.selected.survey
    late(world, 2024)
    assert survey.complete
    world.press("STOP")
    world.run(5000)
    assert row_2(world) == "READY        A1", world.lcd()
    world.check()


# --- the setpoint by itself ----------------------------------------------------------------------


class Scale:
    """4000h is so many hundredths of a hertz."""

    def __init__(self, full):
        self.full = full

    def hsw(self, centihertz):
        return (centihertz * 0x4000 + self.full // 2) // self.full

    def centihertz(self, word):
        return (word * self.full + 0x2000) // 0x4000


class Told:
    """The survey of a drive, and the settings of its panel: what a setpoint asks of them."""

    complete = True
    wanted = hsw = version = 0
    lowest_centihertz, highest_centihertz, setpoint_centihertz = 0, 6_000, 1_000

    def __init__(self):
        self.drive = self
        self.limits = (0, 5_000)
        self.scaling = Scale(5_000)

    def lowest(self):
        return self.limits[0]

    def highest(self):
        return self.limits[1]

    def tell(self, lowest=0, highest=5_000, **told):
        """It has told something else."""
        self.limits = (lowest, highest)
        for name in told:
            setattr(self, name, told[name])
        self.version += 1


def made(**told):
    survey = Told()
    for name in told:
        setattr(survey, name, told[name])
    setpoint = Setpoint(survey, survey)
    survey.tell()
    assert setpoint.has_news() and setpoint.step()
    assert not setpoint.has_news() and not setpoint.step()
    return survey, setpoint


def run_it(survey, setpoint):
    """ON is sent: that alone is no news."""
    survey.wanted = 1
    assert not setpoint.has_news() and not setpoint.step() and not setpoint.has_news()


def told(survey, setpoint, *limits, **more):
    """What is shown, and what is sent, once it has told that."""
    survey.tell(*limits, **more)
    assert setpoint.has_news() and setpoint.step() and not setpoint.has_news()
    return setpoint.centihertz, survey.hsw


def word(centihertz):
    return Scale(5_000).hsw(centihertz)


def test_while_it_stands_the_setpoint_comes_back_when_a_limit_goes():
    survey, setpoint = made()
    assert (setpoint.centihertz, survey.hsw) == (1_000, word(1_000))
    assert told(survey, setpoint, 0, 800) == (800, word(800))
    assert told(survey, setpoint) == (1_000, word(1_000))
    assert told(survey, setpoint, 1_200) == (1_200, word(1_200)) and not setpoint.is_below()
    assert told(survey, setpoint, 1_200, 900) == (900, word(900))  # no more than the highest
    assert told(survey, setpoint) == (1_000, word(1_000))
    setpoint.change(10)
    assert (setpoint.centihertz, survey.hsw) == (1_010, word(1_010))
    assert told(survey, setpoint, 0, 800)[0] == 800
    setpoint.change(-1)
    assert told(survey, setpoint)[0] == 799  # that is what the operator set last


def test_a_setpoint_keeps_within_the_limits_of_panel_and_drive():
    for settings, limits, lowest, highest in (
        ((0, 6_000), (0, 5_000), 0, 5_000),
        ((0, 4_000), (0, 5_000), 0, 4_000),
        ((500, 6_000), (300, 5_000), 500, 5_000),
        ((300, 6_000), (500, 5_000), 500, 5_000),
    ):
        survey, setpoint = made(lowest_centihertz=settings[0], highest_centihertz=settings[1])
        told(survey, setpoint, *limits)
        for change, reached in ((-9_000, lowest), (9_000, highest), (-1, highest - 1)):
            setpoint.change(change)
            assert (setpoint.centihertz, survey.hsw) == (reached, word(reached)), change
        # A drive that is not known has those of the panel, and is sent nothing.
        assert told(survey, setpoint, *limits, complete=False)[1] == word(highest - 1)
        setpoint.change(9_000)
        assert (setpoint.centihertz, survey.hsw) == (settings[1], word(highest - 1))


def test_a_setpoint_is_there_before_a_drive_has_told_anything():
    survey = Told()
    setpoint = Setpoint(survey, survey)
    assert not setpoint.has_news() and not setpoint.step() and not setpoint.is_below()
    setpoint.change(10)
    assert setpoint.centihertz == 1_010
    run_it(survey, setpoint)
    # What it has told counts with the next key, even before its turn.
    survey, setpoint = made()
    survey.tell(0, 800)
    setpoint.change(10)
    assert setpoint.centihertz == 800 and not setpoint.has_news()


def test_while_it_runs_a_limit_lowers_the_setpoint_for_good():
    survey, setpoint = made()
    run_it(survey, setpoint)
    assert told(survey, setpoint, 0, 800) == (800, word(800))
    assert told(survey, setpoint) == (800, word(800))
    assert told(survey, setpoint, 900) == (800, word(800)) and setpoint.is_below()
    setpoint.change(-1)  # down is not up
    assert (setpoint.centihertz, survey.hsw) == (800, word(800))
    setpoint.change(10)
    assert (setpoint.centihertz, survey.hsw) == (900, word(900)) and not setpoint.is_below()
    setpoint.change(-10)
    assert setpoint.centihertz == 900
    assert told(survey, setpoint, 0, 700, complete=False) == (900, word(900))
    assert told(survey, setpoint, 0, 700, complete=True) == (700, word(700))
    survey.wanted = 0
    assert told(survey, setpoint) == (700, word(700))


def test_another_scaling_raises_no_word_that_is_sent():
    survey, setpoint = made()
    run_it(survey, setpoint)
    before = survey.hsw
    assert told(survey, setpoint, scaling=Scale(2_500)) == (500, before)
    less = Scale(10_000).hsw(500)
    assert told(survey, setpoint, scaling=Scale(10_000)) == (500, less)
    assert told(survey, setpoint) == (500, less)
    survey, setpoint = made()
    run_it(survey, setpoint)
    assert told(survey, setpoint, scaling=Scale(4_999))[1] <= before  # nor by rounding


def test_a_direction_is_a_minus_that_every_other_setpoint_keeps():
    survey, setpoint = made()
    setpoint.negate(True)
    assert survey.hsw == -word(1_000) & 0xFFFF and setpoint.centihertz == 1_000
    run_it(survey, setpoint)
    assert told(survey, setpoint, 0, 800) == (800, -word(800) & 0xFFFF)
    setpoint.change(-100)
    assert survey.hsw == -word(700) & 0xFFFF
    setpoint.negate(False)
    assert survey.hsw == word(700)
