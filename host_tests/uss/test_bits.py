# SPDX-License-Identifier: MIT
"""Control and status words bit by bit: their names, and whether a drive may be started."""

from uss import bits
from uss.bits import STW2_BITS, STW_BITS, ZSW2_BITS, ZSW_BITS, bit, may_start, names
from uss.families import FAMILIES
from uss.pzd import ZSW_RUNS_RIGHT

# ZSW, what is remarkable about it. From captures and manuals (USS.md 4.3).
SEEN = (
    (0xFB31, ["READY_TO_SWITCH_ON", "CONTROL_REQUESTED", "BRAKE", "RUNS_RIGHT"]),
    (0xFA31, ["READY_TO_SWITCH_ON", "DEVIATION", "CONTROL_REQUESTED", "BRAKE", "RUNS_RIGHT"]),
    (0xBB34, ["RUNNING", "CONTROL_REQUESTED", "BRAKE"]),
    (0xFBC1, ["READY_TO_SWITCH_ON", "OFF2", "OFF3", "INHIBIT", "WARNING", "CONTROL_REQUESTED",
              "BRAKE", "RUNS_RIGHT"]),
)  # fmt: skip

# ZSW, whether ON makes it run (USS.md 4.9, 4.10).
STARTS = (
    (0xFB31, True),
    (0xFA31, True),
    (0xBB31, True),
    (0xEB31, True),  # G120
    (0x0731, True),  # an MM440 whose low-active bits are 0
    (0xFBB1, True),  # with a warning
    (0xFB34, True),  # runs already
    (0xFBC1, False),  # after power-up: OFF2 and OFF3 still in force
    (0xFB71, False),  # inhibited
    (0xFB78, False),  # fault
    (0xFB39, False),  # fault without the inhibit
    (0xFB21, False),  # OFF2
    (0xFB11, False),  # OFF3
    (0x0000, False),
)


def tables():
    found = [STW_BITS, ZSW_BITS, STW2_BITS, ZSW2_BITS]
    for family in FAMILIES:
        found += [family.stw_bits, family.zsw_bits, family.stw2_bits, family.zsw2_bits]
    return [bits.rows(table) for table in found]


def test_each_table_names_each_bit_once():
    for table in tables():
        places = [row[0] for row in table]
        assert places == sorted(set(places)) and all(0 <= place <= 15 for place in places), table
        assert len({row[1] for row in table}) == len(table), table


def test_status_words_as_seen_in_names():
    for zsw, said in SEEN:
        assert names(zsw, ZSW_BITS) == said, hex(zsw)


def test_a_control_word_in_names():
    assert names(0x0C7F, STW_BITS) == [
        "ON", "NO_OFF2", "NO_OFF3", "PULSES", "RAMP_OUTPUT", "RAMP_RUN", "SETPOINT", "CONTROL",
        "REVERSE",
    ]  # fmt: skip
    assert names(0, STW_BITS) == []


def test_the_second_words_in_names():
    """06E0h was sent by an MM440 that stood still (USS.md 4.4)."""
    assert names(0x06E0, ZSW2_BITS) == [
        "BELOW_THRESHOLD_FREQUENCY", "SETPOINT_REACHED", "BELOW_THRESHOLD_VOLTAGE",
        "RAMP_FINISHED", "PID_AT_MINIMUM",
    ]  # fmt: skip
    assert names(0x2101, STW2_BITS) == ["FIXED_FREQUENCY_BIT_0", "PID"]
    assert names(0, STW2_BITS) == ["EXTERNAL_FAULT"]  # 1 is no fault


def test_the_bits_above_those_of_the_specification():
    """Each has its place, and the word in which it alone is remarkable."""
    for table, word, said in (
        (STW_BITS, 0xE400, ["CONTROL", "MOP_UP", "MOP_DOWN", "REMOTE"]),
        (STW_BITS, 0x1000, []),
        (bits.STW_BITS_MM3, 0x7C00, ["CONTROL", "RUN_RIGHT", "RUN_LEFT", "MOP_UP", "MOP_DOWN"]),
        (bits.STW_BITS_MM3, 0x8000, []),
        (bits.STW_BITS_MM3, 0x0000, []),
        (bits.STW_BITS_G120, 0x0F80, ["ACKNOWLEDGE", "CONTROL", "REVERSE"]),
        (bits.STW_BITS_G120, 0xE000, ["MOP_UP", "MOP_DOWN", "DATA_SET_BIT_0"]),
        (bits.STW_BITS_G120, 0x1000, []),
        (bits.STW_BITS_G120, 0x0000, []),
        (bits.ZSW_BITS_MM3, 0x4530, ["MAXIMUM_REACHED", "RUNS_RIGHT"]),
        (bits.ZSW_BITS_MM3, 0x0130, []),
    ):
        assert names(word, table) == said, (said, names(word, table))
    for name, place in (
        ("DRIVE_DATA_SET_BIT_0", 4), ("DRIVE_DATA_SET_BIT_1", 5), ("DC_BRAKE", 9), ("DROOP", 11),
        ("TORQUE_CONTROL", 12), ("EXTERNAL_FAULT", 13), ("COMMAND_DATA_SET_BIT_1", 15),
    ):  # fmt: skip
        assert bit(name, STW2_BITS) == 1 << place, name
    for name, place in (
        ("PID_AT_MINIMUM", 10), ("PID_AT_MAXIMUM", 11), ("LOADS_DATA_SET_0", 14),
        ("LOADS_DATA_SET_1", 15),
    ):  # fmt: skip
        assert bit(name, ZSW2_BITS) == 1 << place, name


def test_an_idle_g120_reports_nothing_wrong():
    said = names(0xEB31, bits.ZSW_BITS_G120)
    assert said == ["READY_TO_SWITCH_ON", "CONTROL_REQUESTED", "RUNS_RIGHT"]


def test_the_specification_names_the_first_eleven_bits_of_every_family():
    for family in FAMILIES:
        for place, name, at_0 in bits.ZSW_BITS_PROFILE:
            assert (place, name, at_0) in bits.rows(family.zsw_bits), (family.name, name)


def test_a_bit_by_its_name():
    assert bit("FAULT", ZSW_BITS) == 0x0008
    assert bit("REVERSE", STW_BITS) == 0x0800
    assert bit("DATA_SET_BIT_0", bits.STW_BITS_G120) == 0x8000
    for table in (ZSW_BITS, bits.ZSW_BITS_MM3, bits.ZSW_BITS_G120):
        assert bit("RUNS_RIGHT", table) == ZSW_RUNS_RIGHT
    for table in tables():
        for place, name, _ in table:
            assert bit(name, table) == 1 << place


def test_a_name_that_no_bit_has_is_an_error():
    try:
        bit("JOG_RIGHT", bits.STW_BITS_G120)
    except ValueError as error:
        assert "JOG_RIGHT" in str(error)
        return
    raise AssertionError("a G120 has no jog")


def test_when_a_drive_may_be_started():
    for zsw, may in STARTS:
        assert may_start(zsw) is may, hex(zsw)
