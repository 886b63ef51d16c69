# SPDX-License-Identifier: MIT
"""The examples of tools/examples: each fits a screen, and does what it says."""

from tools.examples import (
    broadcast_stop,
    one_drive,
    own_family,
    own_program,
    parameters,
    plc_br,
    plc_s7,
    three_drives,
)
from tools.examples.simulation import DRIVES, Stage, names

INTERPRETERS = "unix64|unix32 cpython"  # people run them on both

EXAMPLES = (
    broadcast_stop, one_drive, own_family, own_program, parameters, plc_br, plc_s7, three_drives,
)  # fmt: skip
CODE_LINES_MAX = 25  # that a reader has before the eyes at once
PRINTED = []


def stage(**options):
    """A board with three drives; what an example prints goes to PRINTED."""
    del PRINTED[:]
    for example in EXAMPLES:
        example.print = note
    return Stage(**options)


def note(*words):
    PRINTED.append(" ".join(str(word) for word in words))


def code_lines(text):
    """Lines of code: without the docstring, blank lines, and the part that starts it on a chip."""
    _, _, code = text.split('"""', 2)
    code, _, _ = code.partition("\nif __name__")
    return [line for line in code.split("\n") if line.strip()]


def test_each_fits_a_screen():
    assert len(names()) == len(EXAMPLES)
    for name in names():
        with open("tools/examples/%s.py" % name) as file:
            lines = code_lines(file.read())
        assert len(lines) <= CODE_LINES_MAX, (name, len(lines))


def test_one_drive_runs_for_ten_seconds_and_stops():
    world = stage()
    seen = []
    world.at(9, lambda: seen.append(world.drives[1].hz()))
    world.play(one_drive.main)
    assert 24.9 < seen[0] < 25.1 and world.drives[1].hz() == 0
    assert PRINTED[9] == " 25.00 Hz  running" and PRINTED[10] == "  0.00 Hz  ready"
    world.check()


def test_a_second_time_the_drives_have_tripped_and_run_all_the_same():
    world = stage()
    for example in (one_drive, three_drives, broadcast_stop):
        world.play(example.main)
        world.clock.advance(5_000_000)  # longer than P2014: F0072
        assert world.drives[1].report().find("fault") > 0
    world.play(one_drive.main)
    assert PRINTED[-2] == " 25.00 Hz  running"
    world.check()


def test_three_drives_follow_each_other():
    world = stage()
    world.play(three_drives.main)
    assert [line.partition(",")[0] for line in PRINTED] == [
        "drive 1: 30.00 Hz",
        "drive 2: 15.00 Hz",
        "drive 3: 3.00 Hz",
    ]
    answers = [int(line.split(" ")[4]) for line in PRINTED]
    assert 1.8 < answers[0] / answers[1] < 2.2
    world.check()


def test_parameters_are_read_written_and_refused():
    world = stage()
    world.play(parameters.main)
    assert PRINTED == [
        "P0700 = 5 and P1082 = 50.00 Hz",
        "RAM: P1120 = 5.0 s",
        "EEPROM as well: P1121 = 8.0 s",
        "drive 1 refuses P1082[0]: beyond the limits (error 2)",
        "P2010[1] = 6",
    ]
    world.drives[1].power_off()
    world.drives[1].power_on()
    assert world.drives[1].read(1121) == 8.0 and world.drives[1].read(1120) == 10.0
    world.check()


def test_own_program_obeys_its_keys_until_ctrl_c():
    world = stage()
    seen = []
    world.at(2, world.tap, "START")
    world.at(12, lambda: seen.append(world.drives[1].hz()))
    world.at(12.1, world.tap, "STOP")
    world.at(22, lambda: seen.append(world.drives[1].hz()))
    world.at(23, world.interrupt)
    world.play(own_program.main)
    assert 39.9 < seen[0] < 40.1 and seen[1] == 0 and not world.resets
    world.check()


def test_own_program_says_why_the_pump_does_not_run():
    world = stage(parameters={2014: 2_000, 700: 2})
    world.at(2, world.tap, "START")
    world.at(3, world.interrupt)
    world.play(own_program.main)
    assert "drive 1 is not under USS control: P0700[0] = 2, not 5" in PRINTED
    assert world.drives[1].hz() == 0
    world.check()


def test_own_program_hears_stop_while_a_start_waits_for_the_drive():
    world = stage(parameters={2014: 2_000, 10: 1})  # commissioning: the motor does not run
    began_us = world.clock.now_us
    world.at(2, world.tap, "START")
    world.at(4, world.tap, "STOP")
    world.at(4.5, world.interrupt)
    world.play(own_program.main)
    sent = [
        (at_us - began_us, characters[12])
        for at_us, from_panel, characters in world.wire.log.last(1000)
        if from_panel and characters[2] == 1
    ]
    assert {low for at_us, low in sent if 3_000_000 < at_us < 4_000_000} == {0x7F}
    assert {low for at_us, low in sent if at_us > 4_050_000} == {0x7E}
    world.check()


def test_the_plc_of_siemens_runs_its_motor():
    for _ in range(2):  # the second time the drive has tripped meanwhile
        world = stage()
        seen = []
        world.at(12, lambda: seen.append(world.drives[1].hz()))
        world.play(plc_s7.main)
        world.clock.advance(5_000_000)
        assert abs(seen[0] - 25.0) < 0.01 and world.drives[1].hz() == 0
        assert world.drives[1].read(1120) == 2.0
        assert PRINTED[11] == "12 s   50 %  no error" and PRINTED[2] == " 3 s    0 %  no error"
        assert PRINTED[-1] == "P1120 = 2.00: no error; P1082 = 50.00"
        world.check()


def test_the_plc_of_b_and_r_runs_its_motor_and_turns_it_round():
    world = stage()
    world.play(plc_br.main)
    world.clock.advance(5_000_000)  # longer than P2014: F0072
    assert world.drives[1].report().find("fault") > 0
    seen = []
    world.at(7, lambda: seen.append(world.drives[1].hz()))
    world.at(12.5, lambda: seen.append(world.drives[1].hz()))
    world.play(plc_br.main)
    assert abs(seen[0] - 10.0) < 0.01 and abs(seen[1] + 10.0) < 0.01, seen
    assert PRINTED[-1] == "no error" and " 7 s   10.0 Hz" in PRINTED
    world.check()


def test_a_slave_of_ones_own_family_is_asked_without_control_and_then_runs():
    world = stage(addresses=(1,), kinds=DRIVES["own_family"])
    stws = []
    world.play(own_family.main)
    for _, from_panel, characters in world.wire.log.last(5000):
        if from_panel and len(characters) == 24:
            stws.append(characters[11] << 8 | characters[12])
    assert PRINTED == ["P2012 = 6, inhibited, ZSW 0040", "50.0 %, running, ZSW 8804"], PRINTED
    assert set(stws) == {0x0000, 0x047E, 0x047F} and stws[-1] == 0x047E
    world.check()


def test_broadcast_stops_all_three_at_once():
    world = stage()
    world.play(broadcast_stop.main)
    assert PRINTED == ["['running', 'running', 'running']", "['ready', 'ready', 'ready']"]
    world.check()


def test_whatever_ends_an_example_stops_its_motors():
    world = stage(parameters={2014: 60_000, 1121: 1.0})
    world.at(4, world.interrupt)
    world.play(three_drives.main)
    for drive in world.drives.values():
        assert drive.starts == 1
    world.clock.advance(2_000_000)
    for drive in world.drives.values():
        assert drive.hz() == 0
    world.check()
