# SPDX-License-Identifier: MIT
"""The process data of the drives that tools/drive serves, tried by a master of its own.

Which words are obeyed (digest 4.6 of the manuals), the state machine (C-5.2.1, PROFIdrive), and
what the words mean. Sections are those of the USS specification.
"""

import time

import pytest

from conformance.kinds import KINDS
from conformance.master import REPLY_S, Node
from conformance.program import Drives
from conformance.telegrams import float_of

INTERPRETERS = "host"

# Control words.
OFF1, RUN, OFF2, OFF3 = 0x047E, 0x047F, 0x047C, 0x047B
NO_PULSES, NO_RAMP_OUTPUT, NO_RAMP, NO_SETPOINT = 0x0477, 0x046F, 0x045F, 0x043F
ACKNOWLEDGE, JOG_RIGHT, JOG_LEFT, JOG_BOTH = 0x04FE, 0x057E, 0x067E, 0x077E
REVERSE = 0x0800
BY_PLC = 0x0400

# The low byte of a MICROMASTER 4's status word without a warning, bit 7.
INHIBITED, INHIBITED_OFF2, INHIBITED_OFF3 = 0x71, 0x61, 0x51
READY, READY_TO_RUN, RUNNING, FAULT = 0x31, 0x32, 0x34, 0x78
RUNNING_OFF3 = 0x14

WARNING, NO_DEVIATION, MAXIMUM, RIGHT = 0x0080, 0x0100, 0x0400, 0x4000
FULL = 0x4000  # P2000, 50 Hz
SPEED = 0x0400  # 3.125 Hz: not long to coast from
RAMPS = (1120, 1121, 1135)  # up, down, OFF3
SLOW = [0x41F0, 0]  # 30.0 s for 0...50 Hz
AT_ONCE = [0, 0]

MICROMASTER_4 = ("mm420 4+2", "mm440 4+8", "g110 variable+2", "v20 4+2")


@pytest.fixture(scope="module")
def drives():
    with Drives(KINDS) as drives:
        yield drives


@pytest.fixture
def node(request, drives):
    """The drive that the test is parametrized with, just powered up, its motor standing.

    Nothing that counts was sent to it.
    """
    node = drives.ready(request.param)
    yield node
    if node.exchange(node.no_task())[1][1]:  # a motor coasts over a power cycle
        until(node, OFF1, lambda zsw, hiw: not hiw)
    drives.leave(node)


def on(*names):
    return pytest.mark.parametrize("node", names, ids=names, indirect=True)


def state(node, stw, hsw=None):
    """The low byte of the status word in answer to a control word, without the warning."""
    zsw = node.control(stw, node.pzd[1] if hsw is None else hsw)[0]
    return zsw & 0x7F


def becomes(node, stw, wanted):
    """Whether the drive comes into this state while it is told so."""
    return until(node, stw, lambda zsw, hiw: zsw & 0x7F == wanted)


def until(node, stw, is_so):
    deadline = time.monotonic() + REPLY_S
    while time.monotonic() < deadline:
        zsw, hiw = node.control(stw)[:2]
        if is_so(zsw, signed(hiw)):
            return True
    return False


def signed(word):
    return (word & 0xFFFF ^ 0x8000) - 0x8000


def start(node, hsw=SPEED):
    """Run it, and wait until it has its speed."""
    assert state(node, OFF1, hsw) == READY
    assert state(node, RUN) == RUNNING
    assert at_speed(node, hsw)


def ramps(node, time_words):
    """How long it takes from now on; as they come, the drives do everything at once."""
    for number in RAMPS:
        assert node.task(3, number, 0, time_words) == (2, time_words)


def at_speed(node, hsw, stw=RUN):
    return until(node, stw, lambda zsw, hiw: abs(hiw - signed(hsw)) <= 1)


# ---- which process data are obeyed ------------------------------------------------------------


@on(*MICROMASTER_4)
def test_before_the_first_process_data_all_is_0_and_the_drive_is_inhibited(node):
    zsw = node.control(0, 0)[0]
    assert zsw & 0x0078 == 0x0040  # no fault, OFF2 and OFF3 active, inhibited


@on(*MICROMASTER_4)
def test_without_bit_10_process_data_are_ignored(node):
    node.control(OFF1, SPEED)
    for stw in (RUN & ~BY_PLC, 0x0000, OFF2 & ~BY_PLC, OFF3 & ~BY_PLC):
        assert state(node, stw, FULL) == READY
    start(node)
    for stw in (0x0000, OFF1 & ~BY_PLC, OFF2 & ~BY_PLC):
        assert state(node, stw, 0) == RUNNING
    assert at_speed(node, SPEED, 0x0000)


@on("g120 variable+2")
def test_a_g120_trips_when_bit_10_drops_while_it_runs(node):
    node.control(OFF1)
    assert node.control(RUN, SPEED)[0] & 7 == 7
    assert node.control(0x0000)[0] & 0x000F == 0x0008
    assert node.task(1, 947)[1] == [7220]


@on(*MICROMASTER_4)
def test_where_p0700_is_not_5_control_words_are_ignored(node):
    node.control(OFF1)
    assert node.task(2, 700, 0, [2])[0] == 1
    assert not state(node, RUN, SPEED) & RUNNING & 4
    zsw, hiw = node.control(OFF2)[:2]
    assert zsw & 0x0030 == 0x0030 and hiw == 0  # no OFF2, but the words come all the same
    assert node.task(2, 700, 0, [5])[0] == 1


@on(*MICROMASTER_4)
def test_where_p1000_is_not_5_the_setpoint_is_ignored(node):
    node.control(OFF1)
    assert node.task(2, 1000, 0, [3])[0] == 1
    assert state(node, RUN, SPEED) == RUNNING
    assert at_speed(node, 0)


@on("mm420 4+2", "mm440 4+8", "v20 4+2")
def test_without_process_data_words_there_are_none(drives, node):
    node.control(OFF1, SPEED)
    pkw, pzd = node.exchange(node.request(2, 2012, 0, [0]))
    assert pkw[0] >> 12 == 1 and len(pzd) == node.pzd_words  # as it was
    bare = Node(node.master, node.address, 4, 0)
    assert bare.exchange(bare.no_task()) == ([0] * 4, [])
    assert bare.task(1, 2036) == (1, [OFF1])
    bare.exchange(bare.request(2, 2012, 0, [node.pzd_words]))
    assert node.control(OFF1)[0] & 0x7F == READY


@on("mm420 4+2", "mm440 4+8", "v20 4+2")
def test_every_process_data_word_is_kept(node):
    words = [OFF1] + [0x1111 * i for i in range(1, node.pzd_words)]
    node.control(*words)
    node.pzd[0] = 0
    assert [node.task(6, 2018, i)[1][0] for i in range(node.pzd_words)] == words


@on("mm420 4+2", "v20 4+2")
def test_the_telegram_failure_time_trips_a_drive_that_runs(node):
    node.control(OFF1, SPEED)
    assert node.task(2, 2014, 0, [1000]) == (1, [1000])
    start(node)
    node.master.wait(1.01)
    assert state(node, RUN) == FAULT
    assert node.task(1, 947)[1] == [72]


@on(*MICROMASTER_4)
def test_the_telegram_failure_time_trips_a_drive_that_stands(node):
    node.control(OFF1)
    node.task(2, 2014, 0, [100])
    node.master.wait(0.11)
    assert state(node, OFF1) == FAULT


@on("mm420 4+2", "v20 4+2")
def test_the_telegram_failure_time_begins_with_the_first_good_telegram(drives, node):
    node.control(OFF1)
    node.task(14, 2014, 0, [100])
    drives.power_cycle(node)
    node.master.wait(0.2)
    assert state(node, OFF1) == READY
    node.task(14, 2014, 0, [0])


# ---- the state machine: from each state to each other -----------------------------------------


@on(*MICROMASTER_4)
def test_from_inhibited_only_off1_leads_on(node):
    assert state(node, RUN) == INHIBITED
    assert state(node, RUN) == INHIBITED
    assert state(node, OFF2) == INHIBITED_OFF2 or state(node, OFF2) == READY
    node.control(RUN)
    assert state(node, OFF1) == READY


@on(*MICROMASTER_4)
def test_from_inhibited_off2_and_off3_have_to_go_first(node):
    node.control(RUN)
    for stw in (OFF2, OFF3 & ~1, OFF2 & ~4):
        assert state(node, stw) & 0x40, hex(stw)
        assert state(node, stw | 1) & 0x40, hex(stw)
    assert state(node, RUN) & 0x40
    assert state(node, OFF1) == READY


@on(*MICROMASTER_4)
def test_from_ready_on_starts(node):
    assert state(node, OFF1, SPEED) == READY
    assert state(node, RUN) == RUNNING
    assert at_speed(node, SPEED)


@on(*MICROMASTER_4)
def test_from_ready_off2_and_off3_inhibit(node):
    for stw, wanted in ((OFF2, INHIBITED_OFF2), (OFF3 & ~1, INHIBITED_OFF3)):
        assert state(node, OFF1) == READY
        assert state(node, stw) == wanted
        assert state(node, RUN) == INHIBITED


@on(*MICROMASTER_4)
def test_on_without_pulses_is_ready_to_run(node):
    assert state(node, OFF1, SPEED) == READY
    assert state(node, NO_PULSES) == READY_TO_RUN
    assert state(node, NO_PULSES & ~1) == READY
    assert state(node, NO_PULSES) == READY_TO_RUN
    assert state(node, RUN) == RUNNING


@on(*MICROMASTER_4)
def test_from_ready_to_run_off2_inhibits(node):
    state(node, OFF1)
    assert state(node, NO_PULSES) == READY_TO_RUN
    assert state(node, OFF2 | 1) == INHIBITED_OFF2
    assert state(node, RUN) == INHIBITED


@on(*MICROMASTER_4)
def test_off1_ramps_down_and_ends_ready(node):
    start(node)
    ramps(node, SLOW)
    zsw, hiw = node.control(OFF1)[:2]
    assert zsw & 0x7F == RUNNING and hiw > 0  # pulses are on until it stands
    ramps(node, AT_ONCE)
    assert becomes(node, OFF1, READY)
    assert node.control(OFF1)[1] == 0


@on(*MICROMASTER_4)
def test_on_again_while_it_ramps_down_takes_it_up_again(node):
    start(node)
    ramps(node, SLOW)
    assert state(node, OFF1) == RUNNING
    assert state(node, RUN) == RUNNING
    ramps(node, AT_ONCE)
    assert at_speed(node, SPEED)


@on(*MICROMASTER_4)
def test_off2_takes_the_pulses_off_at_once_and_inhibits(node):
    start(node)
    assert state(node, OFF2 | 1) == INHIBITED_OFF2
    assert state(node, RUN) == INHIBITED
    assert state(node, OFF1) == READY
    assert state(node, RUN) == RUNNING


@on(*MICROMASTER_4)
def test_off3_ramps_down_by_a_ramp_of_its_own_and_inhibits(node):
    start(node)
    assert node.task(3, 1135, 0, SLOW) == (2, SLOW)
    assert state(node, OFF3) == RUNNING_OFF3
    assert node.control(OFF3)[1] > 0
    ramps(node, AT_ONCE)
    assert becomes(node, OFF3, INHIBITED_OFF3)
    assert state(node, RUN) == INHIBITED
    assert state(node, OFF1) == READY


@on(*MICROMASTER_4)
def test_off3_cannot_be_taken_back(node):
    for stw in (OFF3, OFF3 & ~1):  # in the second case RUN brings an edge of ON
        start(node)
        ramps(node, SLOW)
        assert state(node, stw) == RUNNING_OFF3
        assert state(node, RUN) & 0x1F == RUNNING_OFF3 & 0x1F
        ramps(node, AT_ONCE)
        assert becomes(node, RUN, INHIBITED)


@on(*MICROMASTER_4)
def test_off2_beats_off1_and_off3_on_their_ramps(node):
    for stw in (OFF1, OFF3):
        ramps(node, AT_ONCE)
        start(node)
        ramps(node, SLOW)
        assert state(node, stw) & RUNNING & 4
        assert state(node, OFF2) == INHIBITED_OFF2
        assert state(node, OFF1) == READY


@on(*MICROMASTER_4)
def test_pulses_off_while_it_runs_is_ready_to_run_and_back(node):
    start(node)
    assert state(node, NO_PULSES) == READY_TO_RUN
    assert state(node, RUN) == RUNNING


@on(*MICROMASTER_4)
def test_a_fault_beats_everything_and_on_does_nothing(drives, node):
    start(node)
    drives.fault(node, 1)
    for stw in (RUN, OFF1, RUN, JOG_RIGHT, NO_PULSES):
        assert state(node, stw) == FAULT, hex(stw)


@on(*MICROMASTER_4)
def test_a_fault_is_acknowledged_by_an_edge_and_leads_to_inhibited(drives, node):
    state(node, OFF1)
    assert state(node, OFF1 | 0x80) == READY  # bit 7 is 1 already when the fault comes
    drives.fault(node, 1)
    assert state(node, OFF1 | 0x80) == FAULT
    assert state(node, OFF1) == FAULT
    assert state(node, RUN | 0x80) == INHIBITED  # acknowledged, but ON is still there
    assert state(node, RUN) == INHIBITED
    assert state(node, OFF1) == READY
    assert state(node, RUN) == RUNNING


@on(*MICROMASTER_4)
def test_the_number_of_the_fault_is_told_and_filed(drives, node):
    state(node, OFF1)
    drives.fault(node, 11)
    state(node, OFF1)
    assert node.task(6, 947, 0) == (4, [11])
    state(node, ACKNOWLEDGE)
    state(node, OFF1)
    assert node.task(6, 947, 0)[1] == [0] and node.task(6, 947, 2)[1] == [11]


@on(*MICROMASTER_4)
def test_a_fault_whose_cause_lasts_cannot_be_acknowledged(drives, node):
    state(node, OFF1)
    drives.fault(node, 11, lasting=True)
    assert state(node, ACKNOWLEDGE) == FAULT
    assert state(node, OFF1) == FAULT
    drives.clear(node)
    assert state(node, OFF1) == FAULT  # a new edge is needed
    assert state(node, ACKNOWLEDGE) in (INHIBITED, READY)
    assert state(node, OFF1) == READY


@on(*MICROMASTER_4)
def test_a_second_fault_before_the_acknowledgement_is_noted_beside_the_first(drives, node):
    state(node, OFF1)
    drives.fault(node, 11)
    drives.fault(node, 4)
    state(node, OFF1)
    assert [node.task(6, 947, i)[1][0] for i in (0, 1)] == [11, 4]


@on("mm420 4+2", "mm440 4+8")
def test_p0952_tells_how_many_faults_there_were_and_forgets_them(drives, node):
    state(node, OFF1)
    node.task(2, 952, 0, [0])
    assert node.task(1, 952) == (1, [0])
    for number in (1, 2):
        drives.fault(node, number)
        state(node, ACKNOWLEDGE)
        state(node, OFF1)
    assert [node.task(6, 947, i)[1][0] for i in (2, 4)] == [2, 1]
    assert node.task(1, 952)[1][0] >= 2
    assert node.task(2, 952, 0, [0])[0] == 1
    assert [node.task(6, 947, i)[1][0] for i in range(8)] == [0] * 8


@on(*MICROMASTER_4)
def test_a_warning_is_a_bit_that_needs_no_acknowledgement(drives, node):
    assert not node.control(OFF1)[0] & WARNING
    drives.warn(node, 501, True)
    assert node.control(OFF1)[0] & WARNING
    assert state(node, OFF1) == READY and state(node, RUN) == RUNNING
    assert node.task(6, 2110, 0)[1] == [501]
    drives.warn(node, 501, False)
    assert not node.control(OFF1)[0] & WARNING


@on("mm440 4+8")
def test_p3981_acknowledges_as_well(drives, node):
    state(node, OFF1)
    drives.set(node, 3, 4)
    drives.fault(node, 11)
    assert state(node, OFF1) == FAULT
    node.task(2, 3981, 0, [1])
    assert becomes(node, OFF1, READY)
    drives.set(node, 3, 3)


# ---- jog --------------------------------------------------------------------------------------


@on(*MICROMASTER_4)
@pytest.mark.parametrize("stw, sign", ((JOG_RIGHT, 1), (JOG_LEFT, -1)))
def test_jog_turns_at_its_own_frequency_and_stops_when_let_go(node, stw, sign):
    state(node, OFF1, FULL)
    assert state(node, stw) == RUNNING
    assert at_speed(node, sign * FULL // 10, stw)  # P1058, P1059: 5 Hz
    zsw = node.control(stw)[0]
    assert bool(zsw & RIGHT) == (sign > 0)
    assert becomes(node, OFF1, READY)


@on(*MICROMASTER_4)
def test_jog_needs_on_to_be_0(node):
    state(node, OFF1)
    assert state(node, JOG_RIGHT | 1, 0) == RUNNING  # that is ON, with a setpoint of 0
    assert at_speed(node, 0, JOG_RIGHT | 1)


@on(*MICROMASTER_4)
def test_both_jogs_at_once_warn(node):
    state(node, OFF1)
    assert node.control(JOG_BOTH)[0] & WARNING
    assert not node.control(OFF1)[0] & WARNING
    assert state(node, OFF1) == READY


@on(*MICROMASTER_4)
def test_both_jogs_at_once_hold_the_speed(node):
    state(node, OFF1)
    state(node, JOG_RIGHT)
    assert at_speed(node, FULL // 10, JOG_RIGHT)
    zsw, hiw = node.control(JOG_BOTH)[:2]
    assert zsw & WARNING and abs(hiw - FULL // 10) <= 1
    assert node.control(JOG_BOTH)[1] == hiw


@on(*MICROMASTER_4)
def test_the_jog_direction_may_change_without_a_stop(node):
    state(node, OFF1)
    state(node, JOG_RIGHT)
    assert at_speed(node, FULL // 10, JOG_RIGHT)
    assert state(node, JOG_LEFT) == RUNNING
    assert at_speed(node, -FULL // 10, JOG_LEFT)


# ---- ramps and setpoints ----------------------------------------------------------------------


@on(*MICROMASTER_4)
def test_bit_4_forces_the_output_of_the_ramp_to_0(node):
    start(node)
    zsw, hiw = node.control(NO_RAMP_OUTPUT)[:2]
    assert zsw & 0x7F == RUNNING and hiw == 0
    assert at_speed(node, SPEED)


@on(*MICROMASTER_4)
def test_bit_5_holds_the_ramp(node):
    state(node, OFF1, SPEED)
    ramps(node, SLOW)
    state(node, RUN)
    held = node.control(NO_RAMP)[1]
    assert node.control(NO_RAMP)[1] == node.control(NO_RAMP)[1] == held < SPEED
    ramps(node, AT_ONCE)
    assert node.control(NO_RAMP)[1] == held
    assert at_speed(node, SPEED)


@on(*MICROMASTER_4)
def test_bit_6_makes_the_setpoint_0(node):
    start(node)
    ramps(node, SLOW)
    assert state(node, NO_SETPOINT) == RUNNING
    assert node.control(NO_SETPOINT)[1] > 0  # on its ramp
    ramps(node, AT_ONCE)
    assert at_speed(node, 0, NO_SETPOINT)
    assert state(node, NO_SETPOINT) == RUNNING


@on(*MICROMASTER_4)
def test_bit_11_and_a_negative_setpoint_both_reverse_and_cancel_each_other(node):
    start(node)
    assert at_speed(node, -SPEED, RUN | REVERSE)
    assert not node.control(RUN | REVERSE)[0] & RIGHT
    node.control(RUN | REVERSE, 0x10000 - SPEED)
    assert at_speed(node, SPEED, RUN | REVERSE)
    node.control(RUN, 0x10000 - SPEED)
    assert at_speed(node, -SPEED)


@on(*MICROMASTER_4)
def test_a_direction_change_goes_through_zero_without_a_stop(node):
    start(node)
    ramps(node, [0x40A0, 0])  # 5.0 s: about 0.6 s
    speeds = []

    def reversed_now(zsw, hiw):
        speeds.append(hiw)
        assert zsw & 0x7F == RUNNING
        return hiw <= -SPEED + 1

    assert until(node, RUN | REVERSE, reversed_now)
    assert speeds == sorted(speeds, reverse=True), speeds


@on("mm3 3+2")
def test_a_micromaster_3_has_a_bit_for_each_direction(node):
    right, left = RUN | 0x0800, RUN | 0x1000
    node.control(OFF1, SPEED)
    node.control(right)
    assert until(node, right, lambda zsw, hiw: zsw & 4 and zsw & RIGHT and abs(hiw) >= SPEED - 1)
    assert until(node, left, lambda zsw, hiw: not zsw & RIGHT and abs(hiw) >= SPEED - 1)
    assert until(node, OFF1, lambda zsw, hiw: not zsw & 4)


@on(*MICROMASTER_4)
def test_4000h_is_p2000_and_p1082_is_the_most(node):
    start(node, FULL)
    ak, words = node.task(1, 21)
    assert ak == 2 and abs(float_of(words) - 50.0) < 0.1
    node.control(RUN, 0x7FFF)
    zsw, hiw = node.control(RUN)[:2]
    assert hiw == FULL and zsw & MAXIMUM


@on("mm420 4+2", "mm440 4+8")
def test_with_p2009_words_are_hundredths_of_hertz(node):
    node.control(OFF1)
    assert node.task(2, 2009, 0, [1])[0] == 1
    start(node, 1000)
    assert node.control(RUN)[1] in range(999, 1002)
    assert abs(float_of(node.task(1, 21)[1]) - 10.0) < 0.02
    node.control(RUN, 0xFC18)
    assert at_speed(node, 0xFC18)


@on(*MICROMASTER_4)
def test_the_least_frequency_holds_for_small_setpoints(node):
    node.control(OFF1)
    assert node.task(3, 1080, 0, [0x40A0, 0])[0] == 2  # 5 Hz
    state(node, OFF1, 0x0100)
    state(node, RUN)
    assert at_speed(node, FULL // 10)


# ---- status words -----------------------------------------------------------------------------


@on(*MICROMASTER_4)
def test_bit_8_is_0_while_the_motor_is_off_its_setpoint(node):
    assert node.control(OFF1, 0)[0] & NO_DEVIATION
    assert not node.control(OFF1, FULL)[0] & NO_DEVIATION
    ramps(node, SLOW)
    state(node, RUN)
    assert not node.control(RUN)[0] & NO_DEVIATION
    ramps(node, AT_ONCE)
    assert at_speed(node, FULL)
    assert node.control(RUN)[0] & NO_DEVIATION


@on(*MICROMASTER_4)
def test_the_status_words_are_those_recorded_on_real_drives(node):
    right_at_zero = 0xFB31 if node is None or node.address != 6 else 0xBB31  # a G110 says left
    assert node.control(OFF1, 0)[0] == right_at_zero
    assert node.control(OFF1, FULL)[0] == right_at_zero & ~NO_DEVIATION
    start(node)
    assert node.control(RUN)[0] == 0xFB34


@on("mm420 4+2", "mm440 4+8", "v20 4+2")
def test_after_power_up_the_word_is_that_of_the_capture(node):
    assert node.control(0, 0)[0] == 0xFBC1


@on("g120 variable+2")
def test_the_states_of_a_g120_add_up(node):
    node.control(OFF1, 0)
    assert node.control(OFF1)[0] == 0xEB31
    node.control(RUN, SPEED)
    assert until(node, RUN, lambda zsw, hiw: zsw == 0xEF37 and abs(hiw - SPEED) <= 1)


@on("mm440 4+8")
def test_word_4_carries_status_word_2(node):
    node.control(OFF1, 0)
    zsw2 = node.control(OFF1)[3]
    assert zsw2 == 0x06E0  # as captured on an MM440 that stands
    assert node.task(1, 53) == (1, [zsw2])


@on(*MICROMASTER_4)
def test_p2019_says_what_the_words_carry(node):
    node.control(OFF1, SPEED)
    assert node.task(8, 2019, 1, [0x0034, 0]) == (5, [0x0034, 0])
    zsw, second = node.control(OFF1)[:2]
    assert second == zsw
    assert node.task(8, 2019, 1, [0x0015, 0]) == (5, [0x0015, 0])
