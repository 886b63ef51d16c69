# SPDX-License-Identifier: MIT
"""The simulated drives of the other families: what each does unlike a MICROMASTER 420.

S1, S2 are recordings of real drives, OI440, CU240, G120 and V20 the manuals of these drives; what
is general knowledge alone is said in the files of the families.
"""

import os

from boards.sim.drives.families import NAMES, g110, g120, generic, mm3, mm420, mm440, named, v20
from boards.sim.drives.parameters import (
    CHANGE,
    DEFAULT,
    INDICES,
    MAXIMUM,
    MINIMUM,
    NUMBER,
    TYPE,
    default_values,
)
from boards.sim.drives.process import ACTUAL, STATUS_1
from drive_bench import (
    ACKNOWLEDGE,
    HALF,
    JOG_RIGHT,
    OFF1,
    RUN,
    Bench,
    float_words,
    from_hex,
    telegram,
)

FAMILIES = (generic, mm3, mm420, mm440, g110, v20, g120)


# --- the tables themselves --------------------------------------------------------------------


def test_every_family_is_found_by_its_name():
    shared = ("__init__", "mm4_parameters", "mm4_readings", "texts")
    files = os.listdir("boards/sim/drives/families")
    files = [file[:-3] for file in files if file.endswith(".py") and file[:-3] not in shared]
    assert sorted(files) == sorted(NAMES)
    assert [named(name) for name in ("mm3", "v20")] == [mm3, v20]
    try:
        named("mm9")
    except ValueError as error:
        assert "no family mm9: there are mm420 " in str(error)
    else:
        raise AssertionError("there is no mm9")


def test_every_table_is_whole():
    for family in FAMILIES:
        numbers = [row[NUMBER] for row in family.ROWS]
        assert numbers == sorted(set(numbers)), family.NAME
        for row in family.ROWS:
            where = family.NAME, row[NUMBER]
            assert len(row) == 11 and row[TYPE] in ("U16", "I16", "U32", "F"), where
            assert len(default_values(row)) == row[INDICES], where
            assert row[CHANGE] or row[MINIMUM] is None, where
            assert row[CHANGE] or row[NUMBER] in family.READINGS or row[DEFAULT] is not None, where
            if row[CHANGE]:
                for value in default_values(row):
                    assert row[MINIMUM] <= value <= row[MAXIMUM], where
        for name in ("LINK", "STYLE", "CHANNEL"):
            assert set(getattr(family, name)) == set(getattr(mm420, name)), (family.NAME, name)
        used = [number for _, number, _ in family.SETTINGS] + list(family.PERMITTED)
        used += list(family.COMMISSIONED) + list(family.READINGS)
        assert not [number for number in used if number not in numbers], family.NAME


def test_what_a_family_may_send_is_what_it_can_send():
    for family in FAMILIES:
        sent = family.LINK["sent"]
        if sent is not None:
            for value in family.PERMITTED[sent]:
                assert not value or value >> 16 in family.READINGS, (family.NAME, value)
            row = [row for row in family.ROWS if row[NUMBER] == sent][0]
            kinds = [family.READINGS[value >> 16][0] for value in row[DEFAULT][:2]]
            assert kinds == [STATUS_1, ACTUAL]


def test_each_runs_stops_and_is_read_as_it_is_delivered():
    """At 19200 each family has a code; the words are those of its own layout."""
    for family in FAMILIES:
        bench = Bench({family.LINK["off time"]: 0}, family=family)
        pkw_words, pzd_words = bench.drive.layout
        pkw = [0] * (3 if pkw_words == 127 else pkw_words)
        right = 0x0C7F if family is mm3 else RUN
        for stw, hsw, seconds in ((OFF1, 0, 0), (right, HALF, 20), (right, HALF, 0)):
            reply = bench.exchange(*pkw + [stw, hsw])
            bench.wait(seconds)
        assert bench.drive.hz() == 25 and bench.drive.state == "running", family.NAME
        assert len(reply) == len(pkw) + pzd_words and reply[-1] == HALF, family.NAME
        bench.exchange(*pkw + [OFF1, 0])
        bench.wait(20)
        assert bench.drive.state == "ready", family.NAME
        assert bench.drive.starts == 1 and bench.wire.violations() == []


def test_baud_codes():
    for family, slowest, fastest in (
        (mm3, 1200, 19200), (mm440, 2400, 115200), (g110, 1200, 57600), (v20, 9600, 115200),
        (g120, 2400, 187500), (generic, 300, 187500),
    ):  # fmt: skip
        rates = sorted(family.BAUD_CODES.values())
        assert (rates[0], rates[-1]) == (slowest, fastest), family.NAME
        for baud in (slowest, fastest):
            bench = Bench(family=family, baud=baud)
            pkw_words = bench.drive.layout[0]
            pkw = [0] * (3 if pkw_words == 127 else pkw_words)
            assert bench.exchange(*pkw + [OFF1, 0]), (family.NAME, baud)
    try:
        Bench(family=mm3, baud=115200)
    except ValueError as error:
        assert error.args[0] == "a MICROMASTER 3 has no code for 115200 baud"
    else:
        raise AssertionError("a MICROMASTER 3 at 115200 baud")


# --- MICROMASTER 3 ----------------------------------------------------------------------------


def micromaster_3(parameters=None, **more):
    return Bench(parameters, family=mm3, **more)


def test_mm3_has_a_bit_for_each_direction():
    bench = micromaster_3()
    bench.exchange(0, 0, 0, OFF1, 0)
    for stw, hz in ((0x0C7F, 25), (0x147F, -25), (0x047F, 0), (0x1C7F, 0), (0x0C7F, 25)):
        bench.exchange(0, 0, 0, stw, HALF)
        bench.wait(20)
        assert bench.drive.hz() == hz, hex(stw)
    assert bench.drive.starts == 1


def test_mm3_tells_the_size_of_the_speed_and_the_direction_in_bit_14():
    bench = micromaster_3({2: 0, 3: 0})
    bench.exchange(0, 0, 0, OFF1, 0)
    for stw, zsw in ((0x0C7F, 0xFB34), (0x147F, 0xBB34)):
        assert bench.exchange(0, 0, 0, stw, HALF)[3:] == [zsw, HALF]


def test_mm3_has_words_without_index():
    bench = micromaster_3()
    for request, reply in (
        ((0x105B, 0, 0), [0x105B, 0, 1]),  # P091
        ((0x105B, 1, 0), [0x705B, 1, 3]),  # no index
        ((0x105B, 0x8000, 0), [0x705B, 0x8000, 0]),  # no page
        ((0x2002, 0, 50), [0x1002, 0, 50]),  # P002 = 5.0 s
        ((0x2002, 0, 6501), [0x7002, 0, 2]),
        ((0x1000, 0, 0), [0x1000, 0, 0]),  # P000, the display
        ((0x605B, 0, 0), [0x705B, 0, 106]),  # no array tasks
        ((0xE002, 0, 40), [0x7002, 0, 106]),  # none for the EEPROM
        ((0x1001, 0, 0), [0x7001, 0, 0]),
    ):
        assert bench.exchange(*request + (OFF1, 0))[:3] == reply, request


def test_mm3_keeps_changes_when_p971_says_so():
    bench = micromaster_3()

    def after_a_power_cut(number):
        bench.drive.power_off()
        bench.drive.power_on()
        return bench.drive.read(number)

    bench.exchange(0x2002, 0, 50, OFF1, 0)
    assert bench.drive.eeprom_writes == 1 and after_a_power_cut(2) == 50
    bench.exchange(0x23CB, 0, 0, OFF1, 0)  # P971 = 0
    bench.exchange(0x2002, 0, 60, OFF1, 0)
    assert bench.drive.eeprom_writes == 1 and after_a_power_cut(2) == 50


def test_mm3_scaling():
    # P094 in 0.1 Hz with P095 = 0, in 0.01 Hz with 1; with 2 the setpoint is 0.01 Hz itself.
    for parameters, hsw, hz in (
        ({94: 600, 13: 650}, 0x2000, 30.0),
        ({95: 1, 94: 6000, 13: 6500}, 0x2000, 30.0),
        ({95: 2, 94: 5000, 13: 6500}, 3000, 30.0),
    ):
        parameters[2] = 0
        bench = micromaster_3(parameters)
        bench.exchange(0, 0, 0, OFF1, 0)
        reply = bench.exchange(0, 0, 0, 0x0C7F, hsw)
        assert reply[4] == hsw and bench.drive.hz() == hz, parameters
        display = 3000 if 95 in parameters else 300
        assert bench.exchange(0x1000, 0, 0, 0x0C7F, hsw)[2] == display


def test_mm3_supervises_in_seconds_and_trips_with_8():
    bench = micromaster_3({93: 2})
    bench.exchange(0, 0, 0, OFF1, 0)
    bench.wait(1.9)
    assert bench.drive.state == "ready"
    bench.wait(0.2)
    assert bench.drive.state == "fault"
    assert bench.exchange(0x13A2, 0, 0, OFF1, 0)[2] == 8  # P930
    assert bench.exchange(0, 0, 0, ACKNOWLEDGE, 0)[3] & 0x48 == 0x40


def test_mm3_obeys_as_p910_says():
    for mode, starts, hz in ((0, 0, 0), (1, 1, 25), (2, 0, 0), (3, 1, 0), (4, 0, 0)):
        bench = micromaster_3({910: mode})
        bench.exchange(0, 0, 0, OFF1, 0)
        bench.exchange(0, 0, 0, 0x0C7F, HALF)
        bench.wait(20)
        assert (bench.drive.starts, bench.drive.hz()) == (starts, hz), mode


# --- MICROMASTER 440 --------------------------------------------------------------------------

# Derived vectors: request, reply; PZD words as they come.
MM440_EXCHANGES = (
    ("V39 V40", "02 0E 01 61 30 00 02 00 00 00 00 04 7E 00 00 24",
     "02 0E 01 41 30 00 02 00 00 00 E6 FB 31 00 00 52"),
    ("V41 V42", "02 0E 01 91 30 00 00 00 00 00 00 04 7E 00 00 D6",
     "02 0E 01 61 30 00 00 00 00 00 03 FB 31 00 00 95"),
    ("V50 V51", "02 0E 01 82 DB 00 00 00 34 00 07 04 7E 00 00 1D",
     "02 0E 01 52 DB 00 00 00 34 00 07 FB 31 00 00 7D"),
    ("V21", "02 0E 01 12 BC 00 01 00 00 00 00 04 7E 00 00 D8",
     "02 0E 01 12 BC 00 01 00 00 00 02 FB 31 00 00 6A"),
)  # fmt: skip


def test_mm440_derived_vectors():
    for ids, request, reply in MM440_EXCHANGES:
        assert Bench(family=mm440).ask(from_hex(request)) == from_hex(reply), ids


def test_mm440_sends_eight_words_as_p2019_says():
    bench = Bench({2012: 8, 1120: 0.0}, family=mm440)
    bench.drive.write(2019, 4, 20 << 16)  # r0020 in PZD5
    bench.drive.write(2019, 7, 55 << 16)  # STW2 in PZD8
    bench.exchange(0, 0, 0, 0, OFF1, 0, 0, 0, 0, 0, 0, 0)
    reply = bench.exchange(0, 0, 0, 0, RUN, HALF, 3, 0x2000, 5, 6, 7, 8)
    assert reply[4:] == [0xFB34, HALF, 0, 0x06E6, HALF, 0, 0, 0x2000]
    assert [bench.drive.read(2018, i) for i in range(8)] == [RUN, HALF, 3, 0x2000, 5, 6, 7, 8]
    assert bench.drive.read(55) == bench.drive.read(2037) == 0x2000
    assert bench.drive.read(2036) == RUN


def test_mm440_acknowledges_by_p3981():
    bench = Bench({3: 4}, family=mm440)
    bench.control(OFF1)
    bench.drive.fault(1)
    # V52: P3981 = 1
    assert bench.ask(from_hex("02 0E 01 27 BD 80 00 00 00 00 01 04 7E 00 00 6C"))
    assert bench.drive.read(3981) == 0
    assert bench.control(OFF1)[0] & 0xFF == 0x31 and bench.drive.read(947) == 0


def test_mm440_has_two_analog_inputs_without_a_signal():
    bench = Bench(family=mm440)
    for index in (0, 1):  # r0755, r0754, r0752
        assert bench.task(0x12F3, index) == (0x12F3, index, 0, 0)
        assert bench.drive.read(754, index) == bench.drive.read(752, index) == 0


# --- G110 -------------------------------------------------------------------------------------


def test_g110_as_it_was_recorded():
    # S2: 0 + 2 words, address 0; the direction bit is 0 at standstill and at 0 Hz.
    bench = Bench({2013: 0}, address=0, family=g110)
    bench.exchange(OFF1, 0)
    assert bench.ask(from_hex("02 06 00 04 7E 00 00 7E")) == telegram(0, 0xBB31, 0)
    assert bench.exchange(RUN, 0) == [0xBB34, 0]
    bench.exchange(RUN, HALF)
    bench.wait(20)
    assert bench.ask(from_hex("02 06 00 04 7F 20 00 5F")) == from_hex("02 06 00 FB 34 20 00 EB")


def test_g110_has_no_indices():
    bench = Bench(family=g110)
    assert bench.drive.layout == (127, 2)
    assert bench.exchange(0x100A, 0x8000, 0, OFF1, 0)[:3] == [0x100A, 0x8000, 7]
    assert bench.exchange(0x100A, 0x8001, 0, OFF1, 0)[:3] == [0x700A, 0x8001, 3]
    assert bench.exchange(0x1009, 0x8000, 0, OFF1, 0)[:3] == [0x7009, 0x8000, 0]  # no P2009


# --- V20 --------------------------------------------------------------------------------------


def test_v20_supervises_from_the_first_process_data_on():
    # Macro Cn010: P2014 = 500 ms; another drive on the line has to be asked in between.
    bench = Bench(family=v20)
    assert bench.drive.read(2014) == 500
    mirror = telegram(0x41, 0, 0, 0, OFF1, 0)
    assert bench.ask(mirror) == mirror
    bench.wait(5)
    assert bench.drive.read(947) == 0
    bench.exchange(0, 0, 0, OFF1, 0)
    bench.wait(0.4)
    bench.exchange(0, 0, 0, OFF1, 0)
    bench.wait(0.4)
    assert bench.drive.state == "ready"
    bench.ask(mirror)  # which are not process data
    bench.wait(0.1)
    assert bench.drive.state == "fault" and bench.drive.read(947) == 72


# --- G120 -------------------------------------------------------------------------------------


def test_g120_states_add_up():
    bench = Bench({2023: 4, 1120: 0.0}, family=g120)
    assert bench.control(OFF1)[0] == 0xEB31
    assert bench.control(RUN & ~8)[0] == 0xEB33
    assert bench.control(RUN, HALF) == (0xEF37, HALF)


def test_g120_tells_speeds():
    bench = Bench({2023: 4, 1120: 0.0, 2000: 3000.0, 1082: 3000.0}, family=g120)
    bench.control(OFF1)
    bench.control(RUN, HALF)
    assert bench.task(0x1015, 0, stw=RUN, hsw=HALF)[2:] == float_words(1500.0)
    assert bench.drive.hz() == 50


def test_g120_does_not_jog():
    bench = Bench({2023: 4}, family=g120)
    bench.control(OFF1)
    assert bench.control(JOG_RIGHT)[0] == 0xEB31
    assert bench.drive.starts == 0


def test_g120_trips_when_control_is_given_up_while_it_runs():
    bench = Bench({2023: 4}, family=g120)
    bench.control(OFF1)
    assert bench.control(0)[0] == 0xEB31
    bench.control(RUN, HALF)
    bench.control(RUN & ~0x0400, HALF)
    assert bench.drive.state == "fault" and bench.drive.read(947) == 7220


def test_g120_supervises_its_line():
    bench = Bench({2023: 4, 2040: 100}, family=g120)
    bench.control(OFF1)
    bench.wait(0.2)
    assert bench.drive.read(947) == 1910
    assert bench.control(ACKNOWLEDGE)[0] & 0x48 == 0x40


def test_g120_is_obeyed_through_its_macro_alone():
    bench = Bench({2023: 4, 15: 12}, family=g120)
    bench.control(OFF1)
    bench.control(RUN, HALF)
    assert bench.drive.starts == 0


# --- broadcast --------------------------------------------------------------------------------


def test_families_without_broadcast_drop_it():
    everything = telegram(0x20, 0x0007, 0xFFFF, 0, 0, OFF1, 0x1234)
    for family, takes in ((mm420, True), (mm440, True), (generic, True), (g120, False)):
        link = family.LINK
        bench = Bench({link["pkw words"]: 4}, family=family)
        assert bench.ask(everything) is None
        reply = bench.drive.report()
        assert ("hsw=1234" in reply) == takes, family.NAME
        assert ("good=1" in reply) == takes, family.NAME
        assert "rejected=0" in reply


def test_any_family_on_a_line_that_is_too_fast_for_it():
    assert Bench(family=mm3, baud=115200, any_baud=True).exchange(0, 0, 0, OFF1, 0)
