# SPDX-License-Identifier: MIT
"""The blocks of the S7-200's USS library, used as a PLC program uses them, on simulated drives."""

from boards.sim.clock import Clock, Event
from boards.sim.drives.families import g120, generic, mm3
from plc_bench import BAUD, Plc
from uss import families, pkw
from uss.bus import pkw_errors
from uss.layout import Layout
from uss.master import LISTENING
from uss.s7 import (
    TYPES,
    USS_CTRL,
    USS_INIT,
    USS_RPM_D,
    USS_RPM_R,
    USS_RPM_W,
    USS_WPM_D,
    USS_WPM_R,
    USS_WPM_W,
    Port,
    codes,
)

# --- RUN, and what a motor does on it -----------------------------------------------------------


def test_run_makes_the_motor_run_at_the_speed_and_its_end_stops_it():
    plc = Plc()
    plc.run(300)
    motor = plc.outputs()
    assert (motor.ERROR, motor.STATUS & 0xFF) == (0, 0x31) and not motor.RUN_EN
    plc.motor().RUN = True
    plc.run(1_500)
    assert plc.drive().state == "running" and abs(plc.drive().hz() - 25.0) < 0.01
    assert motor.RUN_EN and motor.D_DIR and not motor.INHIBIT and not motor.FAULT
    assert abs(motor.SPEED - 50.0) < 0.02, motor.SPEED
    plc.motor().RUN = False
    plc.run(1_500)
    assert plc.drive().state == "ready" and not motor.RUN_EN and motor.SPEED == 0
    plc.check()


def test_the_setpoint_is_followed_while_it_runs():
    plc = Plc()
    plc.start()
    for percent in (80.0, 10.0, 100.0):
        plc.motor().SPEED_SP = percent
        plc.run(2_500)
        assert abs(plc.drive().hz() - percent / 2) < 0.01, plc.drive().hz()
        assert abs(plc.outputs().SPEED - percent) < 0.02


def test_dir_and_a_negative_setpoint_turn_the_motor_round_and_cancel_each_other():
    plc = Plc()
    plc.start()
    for reverse, percent, hertz in (
        (True, 50.0, -25.0), (False, -50.0, -25.0), (True, -50.0, 25.0), (False, 50.0, 25.0)
    ):  # fmt: skip
        plc.motor().DIR = reverse
        plc.motor().SPEED_SP = percent
        plc.run(3_000)
        assert abs(plc.drive().hz() - hertz) < 0.01, (reverse, percent, plc.drive().hz())
        assert abs(plc.outputs().SPEED - 2 * hertz) < 0.02
        assert plc.outputs().D_DIR == (hertz > 0) and not plc.outputs().RUN_VOID


def test_a_uss_ctrl_says_nothing_of_a_drive_that_it_has_not_heard():
    control = USS_CTRL(Port(None, Clock()))
    outputs = (control.RESP_R, control.RUN_EN, control.D_DIR, control.INHIBIT, control.FAULT)
    assert outputs == (False,) * 5 and control.RUN_VOID is False
    assert (control.STATUS, control.SPEED, control.ERROR, control.STATUS_WORD) == (0, 0.0, 0, 0)


def test_resp_r_is_on_for_one_scan_with_each_reply():
    plc = Plc()
    plc.run(300)
    before = plc.port.drives[1].counters[0]
    responses = 0
    for _ in range(500):
        plc.run(2)
        responses += plc.outputs().RESP_R
    assert responses == plc.port.drives[1].counters[0] - before > 20
    for name, value in (("EN", False), ("DRIVE", 7)):
        while not plc.outputs().RESP_R:
            plc.run(2)
        right = getattr(plc.motor(), name)
        setattr(plc.motor(), name, value)
        plc.scan()
        assert not plc.outputs().RESP_R, name
        setattr(plc.motor(), name, right)
    plc.controls.clear()
    plc.run(400)
    new = USS_CTRL(plc.port)
    new(DRIVE=1)
    assert new.ERROR == 0 and not new.RESP_R  # what came before is not for it


def test_run_that_is_on_when_power_comes_starts_nothing():
    plc = Plc()
    plc.motor().RUN = True
    plc.run(2_000)
    assert plc.drive().starts == 0 and plc.outputs().RUN_VOID
    plc.motor().RUN = False
    plc.run(20)
    assert not plc.outputs().RUN_VOID
    plc.motor().RUN = True
    plc.run(500)
    assert plc.drive().state == "running" and not plc.outputs().RUN_VOID


def test_run_that_came_before_the_drive_answered_starts_nothing_when_it_does():
    plc = Plc()
    plc.drive().unplug()
    plc.run(300)
    plc.motor().RUN = True
    plc.run(300)
    plc.drive().plug()
    plc.run(3_000)
    assert plc.outputs().ERROR == 0
    assert plc.drive().starts == 0 and plc.outputs().RUN_VOID


def test_a_fault_ends_run_and_its_acknowledgement_does_not_bring_it_back():
    plc = Plc()
    plc.start()
    plc.drive().fault(1)
    plc.run(500)
    motor = plc.outputs()
    assert motor.FAULT and not motor.RUN_EN and motor.RUN_VOID and motor.ERROR == 0
    plc.motor().F_ACK = True
    plc.run(1_000)
    assert not motor.FAULT and plc.drive().state == "ready"
    assert motor.RUN_VOID and plc.drive().starts == 1
    plc.motor().RUN = False
    plc.run(20)
    plc.motor().RUN = True
    plc.run(500)
    assert plc.drive().state == "running" and plc.drive().starts == 2


def test_f_ack_acknowledges_by_its_edge_only():
    plc = Plc()
    plc.motor().F_ACK = True
    plc.run(300)
    plc.drive().fault(1)
    plc.run(1_000)
    assert plc.outputs().FAULT
    plc.motor().F_ACK = False
    plc.run(20)
    plc.motor().F_ACK = True
    plc.run(500)
    assert not plc.outputs().FAULT
    plc.drive().fault(1)
    plc.run(500)
    assert plc.outputs().FAULT


def test_an_input_that_is_left_out_is_off():
    """But for EN. The drive is a MICROMASTER 4, its setpoint 0 %."""
    plc = Plc()
    motor, inputs = plc.controls.pop(1), {}
    plc.others.append(lambda: motor(DRIVE=1, **inputs))
    plc.run(500)
    assert motor.ERROR == 0 and not motor.RUN_EN and plc.drive().starts == 0
    plc.drive().fault(1)
    plc.run(500)
    assert motor.FAULT  # nobody has acknowledged it
    inputs["F_ACK"] = True
    plc.run(500)
    assert not motor.FAULT
    inputs["RUN"] = True
    plc.run(1_500)
    assert plc.drive().state == "running" and plc.drive().hz() == motor.SPEED == 0
    inputs["SPEED_SP"] = 50.0
    plc.run(1_500)
    assert motor.SPEED > 0  # the usual direction
    plc.check()


def test_a_line_that_comes_back_starts_nothing():
    plc = Plc()
    plc.start()
    plc.drive().unplug()
    plc.run(2_000)
    motor = plc.outputs()
    assert motor.ERROR == codes.NO_ANSWER and not motor.RESP_R and motor.RUN_VOID
    assert motor.RUN_EN  # what was known last: it may run still
    plc.drive().plug()
    plc.run(3_000)
    assert motor.ERROR == 0 and plc.drive().state == "ready" and plc.drive().starts == 1


def test_off2_coasts_off3_brakes_and_run_counts_anew_after_either():
    for stop in ("OFF2", "OFF3"):
        plc = Plc(parameters={1120: 1.0, 1121: 100.0, 1135: 0.5})
        plc.start()
        setattr(plc.motor(), stop, True)
        plc.run(50)
        assert plc.drive().state != "running" and plc.outputs().RUN_VOID
        plc.run(1_000)
        assert plc.outputs().INHIBIT and not plc.outputs().RUN_EN, stop
        setattr(plc.motor(), stop, False)
        plc.run(1_000)
        assert not plc.outputs().INHIBIT and plc.drive().state == "ready"
        assert plc.outputs().RUN_VOID and plc.drive().starts == 1
        plc.motor().RUN = False
        plc.run(20)
        plc.motor().RUN = True
        plc.run(500)
        assert plc.drive().state == "running", stop


def test_off2_goes_before_off3():
    plc = Plc()
    plc.start()
    plc.motor().OFF2 = plc.motor().OFF3 = True
    plc.run(200)
    assert plc.port.drives[1].answered_stw == 0x047C


def test_a_setpoint_out_of_range_keeps_the_speed_and_starts_nothing():
    plc = Plc()
    plc.start()
    for percent in (200.1, -200.1, float("nan"), float("inf")):
        plc.motor().SPEED_SP = percent
        plc.run(100)
        assert plc.outputs().ERROR == codes.SPEED_RANGE
        assert abs(plc.drive().hz() - 25.0) < 0.01
    plc.motor().RUN = False
    plc.run(1_500)
    assert plc.drive().state == "ready"
    plc.motor().RUN = True
    plc.run(100)
    plc.motor().SPEED_SP = 50.0
    plc.run(1_000)
    assert plc.drive().starts == 1 and plc.outputs().RUN_VOID


def test_both_ends_of_the_range_are_in_it():
    plc = Plc()
    plc.run(300)
    for percent in (200, -200, 200.0, -200.0):
        plc.motor().SPEED_SP = percent
        plc.run(50)
        assert plc.outputs().ERROR == 0


# --- the program stops, or part of it -----------------------------------------------------------


def test_a_scan_that_stops_stops_the_motors():
    plc = Plc(paced=True)
    plc.start()
    plc.hang(400)
    assert plc.drive().state == "stopping"
    plc.run(3_000)
    assert plc.drive().state == "ready" and plc.outputs().RUN_VOID and plc.drive().starts == 1


def test_a_polled_scan_that_stopped_stops_them_when_it_goes_on():
    plc = Plc()
    plc.start()
    plc.hang(400)
    assert plc.drive().state == "running"
    plc.run(100)
    assert plc.drive().state == "stopping"
    plc.run(3_000)
    assert plc.drive().starts == 1


def test_a_uss_ctrl_that_is_not_called_stops_its_motor_and_no_other():
    plc = Plc((1, 2))
    plc.run(300)
    plc.motor(1).RUN = plc.motor(2).RUN = True
    plc.run(1_500)
    control = plc.controls.pop(1)
    plc.run(400)
    assert plc.drive(1).state == "stopping" and plc.drive(2).state == "running"
    plc.run(2_000)
    plc.controls[1] = control
    plc.run(500)
    assert plc.drive(1).state == "ready" and control.RUN_VOID


def test_a_uss_ctrl_has_300_ms_until_it_is_called_again():
    plc = Plc()
    plc.start()
    plc.scan()
    called_us = plc.clock.now_us
    drive = plc.port.drives[1]
    for later_us in list(range(2_000, 300_000, 10_000)) + [300_000]:
        plc.clock.advance(called_us + later_us - plc.clock.now_us)
        plc.port.scan()
    assert plc.port.controls[1] is plc.outputs() and drive.wanted
    plc.clock.advance(1)
    plc.port.scan()
    assert plc.port.controls[1] is None and not drive.wanted


def test_for_a_uss_ctrl_that_is_called_again_what_is_on_has_no_edge():
    for has_tripped in (False, True):
        plc = Plc()
        plc.run(300)
        control = plc.controls.pop(1)
        plc.run(400)
        plc.motor().RUN = plc.motor().F_ACK = True
        if has_tripped:
            plc.drive().fault(1)
        plc.controls[1] = control
        plc.run(500)
        assert control.RUN_VOID and plc.drive().starts == 0 and control.FAULT == has_tripped
        second = USS_CTRL(plc.port)
        second(DRIVE=1)
        assert second.ERROR == codes.INTERFERENCE  # the drive is the first one's again


def test_en_off_stops_the_motor_after_300_ms():
    plc = Plc()
    plc.start()
    plc.motor().EN = False
    plc.run(250)
    assert plc.drive().state == "running"
    plc.run(150)
    assert plc.drive().state == "stopping"
    plc.motor().EN = True
    plc.run(2_000)
    assert plc.drive().starts == 1 and plc.outputs().RUN_VOID


def test_a_drive_that_off2_holds_is_held_without_en_as_well():
    plc = Plc()
    plc.run(300)
    plc.motor().OFF2 = True
    plc.run(100)
    plc.motor().EN = False
    plc.run(500)
    assert plc.drive().stw == 0x047C


def test_another_drive_at_the_input_stops_the_one_before():
    plc = Plc((1, 2))
    plc.start(1)
    del plc.controls[2]
    plc.motor(1).DRIVE = 2
    plc.run(500)
    assert plc.drive(1).state in ("stopping", "ready") and plc.drive(2).starts == 0
    assert plc.outputs(1).RUN_VOID and plc.outputs(1).ERROR == 0


def test_an_input_that_is_refused_stops_the_motor():
    for name, value, error in (
        ("DRIVE", 32, codes.ILLEGAL_ADDRESS), ("DRIVE", 7, codes.NOT_ACTIVE),
        ("TYPE", 2, codes.ILLEGAL_COMMAND), ("TYPE", 0, codes.CHANGE_NOT_ALLOWED),
    ):  # fmt: skip
        plc = Plc()
        plc.start()
        setattr(plc.motor(), name, value)
        plc.run(10)
        assert plc.outputs().ERROR == error, (name, value, plc.outputs().ERROR)
        plc.run(100)
        assert plc.drive().state == "stopping", (name, value)


def test_a_second_uss_ctrl_for_a_drive_is_refused_and_changes_nothing():
    plc = Plc()
    plc.start()
    second = USS_CTRL(plc.port)
    plc.others.append(lambda: second(RUN=False, DRIVE=1, TYPE=1))
    plc.run(500)
    assert second.ERROR == codes.INTERFERENCE and plc.outputs().ERROR == 0
    assert plc.drive().state == "running"
    # The first one gives up: the second may have it, and starts nothing.
    del plc.controls[1]
    plc.run(500)
    assert second.ERROR == 0 and plc.drive().state == "stopping"


# --- parameters ---------------------------------------------------------------------------------


def until_done(plc, block, ms=3_000, **inputs):
    """Call a block in every scan until it is done, with a request that is on all the time."""
    block(EN=True, XMT_REQ=True, **inputs)
    for _ in range(ms // 2):
        if block.DONE:
            return block
        plc.run(2)
        block(EN=True, XMT_REQ=True, **inputs)
    raise AssertionError("not done")


def test_a_block_without_a_request_asks_for_nothing_and_is_not_done():
    """An input that is not connected is off, but EN; DRIVE, PARAM, INDEX and VALUE are 0."""
    plc = Plc(parameters={1120: 12.5})
    plc.run(300)
    for kind in (USS_RPM_W, USS_RPM_D, USS_RPM_R, USS_WPM_W, USS_WPM_D, USS_WPM_R):
        block = kind(plc.port)
        for _ in range(3):
            assert (block.DONE, block.ERROR, block.STATUS_WORD) == (False, 0, 0), kind.__name__
            assert block.PKW_ERROR is None
            block(DRIVE=1, PARAM=700)
            plc.run(60)
        block(DRIVE=1, PARAM=700, EN=False, XMT_REQ=True)  # nor has it one when it is off
        plc.run(60)
        assert not block.DONE, kind.__name__
        block(XMT_REQ=True)
        assert block.DONE and block.ERROR == codes.NOT_ACTIVE, kind.__name__
    assert plc.drive().read(700) == 5


def test_reading_a_word_a_double_word_and_a_real():
    plc = Plc(parameters={1120: 12.5})
    plc.run(300)
    for block, number, value in (
        (USS_RPM_W(plc.port), 700, 5), (USS_RPM_R(plc.port), 1120, 12.5),
        (USS_RPM_D(plc.port), 1120, 0x41480000),
    ):  # fmt: skip
        until_done(plc, block, DRIVE=1, PARAM=number)
        assert (block.ERROR, block.STATUS_WORD, block.VALUE) == (0, 0, value)


def test_an_element_by_its_index():
    plc = Plc(parameters={(2012, 1): 4})
    plc.run(300)
    read = USS_RPM_W(plc.port)
    for index, value in ((0, 2), (1, 4)):
        read(EN=True, XMT_REQ=False)
        until_done(plc, read, DRIVE=1, PARAM=2012, INDEX=index)
        assert (read.ERROR, read.VALUE) == (0, value)
    read(EN=True, XMT_REQ=False)
    until_done(plc, read, DRIVE=1, PARAM=2012, INDEX=9)
    assert (read.ERROR, read.PKW_ERROR) == (codes.PARAMETER_REPLY, 3)


def test_an_element_goes_by_the_tasks_for_arrays_where_no_others_take_an_index():
    """Specification C-4.2.2; its index counts from 1."""
    plc = Plc(kinds={1: {"family": generic}}, types=(families.MM3, families.GENERIC))
    plc.run(300)
    read, write = USS_RPM_W(plc.port), USS_WPM_W(plc.port)
    until_done(plc, read, DRIVE=1, PARAM=2012, INDEX=2)
    assert (read.ERROR, read.VALUE) == (0, 2)
    for eeprom, value in ((False, 5), (True, 6)):
        write(EN=True, XMT_REQ=False)
        until_done(plc, write, DRIVE=1, PARAM=2012, INDEX=2, VALUE=value, EEPROM=eeprom)
        assert write.ERROR == 0 and plc.drive().read(2012, 1) == value


def test_a_full_queue_of_the_drive_is_a_busy_port():
    plc = Plc()
    plc.run(300)
    for number in range(9):
        try:
            plc.port.drives[1].ask(pkw.read(number))
        except RuntimeError:
            break
    read = until_done(plc, USS_RPM_W(plc.port), DRIVE=1, PARAM=700)
    assert read.ERROR == codes.PORT_BUSY


def test_one_type_is_enough():
    plc = Plc(types=TYPES[1:])
    plc.motor().TYPE = 0
    plc.start()


def test_writing_to_ram_and_for_good():
    plc = Plc()
    plc.run(300)
    until_done(plc, USS_WPM_R(plc.port), DRIVE=1, PARAM=1120, VALUE=7.5)
    assert plc.drive().read(1120) == 7.5
    until_done(plc, USS_WPM_R(plc.port), DRIVE=1, PARAM=1121, VALUE=8.5, EEPROM=True)
    plc.drive().power_off()
    plc.run(1_500)
    plc.drive().power_on()
    plc.run(1_500)
    assert plc.drive().read(1120) == 1.0 and plc.drive().read(1121) == 8.5


def test_a_request_is_carried_out_once_however_long_it_stays_on():
    plc = Plc()
    plc.run(300)
    write = until_done(plc, USS_WPM_R(plc.port), DRIVE=1, PARAM=1120, VALUE=7.5)
    plc.drive().write(1120, 0, 3.0)
    for _ in range(300):
        plc.run(2)
        write(EN=True, XMT_REQ=True, DRIVE=1, PARAM=1120, VALUE=7.5)
    assert write.DONE and plc.drive().read(1120) == 3.0
    write(EN=True, XMT_REQ=False, DRIVE=1, PARAM=1120, VALUE=7.5)
    assert write.DONE
    until_done(plc, write, DRIVE=1, PARAM=1120, VALUE=7.5)
    assert plc.drive().read(1120) == 7.5


def test_done_goes_off_with_the_next_request_and_errors_with_it():
    plc = Plc()
    plc.run(300)
    read = until_done(plc, USS_RPM_W(plc.port), DRIVE=1, PARAM=1999)
    assert read.ERROR == codes.PARAMETER_REPLY and read.PKW_ERROR == 0
    read(EN=True, XMT_REQ=False, DRIVE=1, PARAM=700)
    read(EN=True, XMT_REQ=True, DRIVE=1, PARAM=700)
    assert (read.DONE, read.ERROR, read.PKW_ERROR) == (False, 0, None)


def test_en_off_while_it_goes_on_keeps_the_result_for_later():
    plc = Plc()
    plc.run(300)
    read = USS_RPM_W(plc.port)
    read(EN=True, XMT_REQ=True, DRIVE=1, PARAM=700)
    for _ in range(100):
        plc.run(2)
        read(EN=False, XMT_REQ=True, DRIVE=1, PARAM=700)
    assert not read.DONE
    read(EN=True, XMT_REQ=False)
    assert read.DONE and read.VALUE == 5


def test_another_edge_while_a_request_goes_on_makes_none():
    plc = Plc()
    plc.run(300)
    read = USS_RPM_W(plc.port)
    for request in (True, False, True):
        read(XMT_REQ=request, DRIVE=1, PARAM=700)
        assert not read.DONE
    until_done(plc, read, DRIVE=1, PARAM=700)
    assert (read.ERROR, read.VALUE) == (0, 5)


def test_a_request_is_made_when_en_becomes_on_as_well():
    plc = Plc()
    plc.run(300)
    read = USS_RPM_W(plc.port)
    read(EN=False, XMT_REQ=True, DRIVE=1, PARAM=700)
    plc.run(200)
    assert not plc.port.is_busy()
    until_done(plc, read, DRIVE=1, PARAM=700)
    assert (read.ERROR, read.VALUE) == (0, 5)


def test_one_parameter_block_at_a_time():
    plc = Plc((1, 2))
    plc.run(300)
    first, second = USS_RPM_W(plc.port), USS_WPM_D(plc.port)
    first(EN=True, XMT_REQ=True, DRIVE=1, PARAM=700)
    second(EN=True, XMT_REQ=True, DRIVE=2, PARAM=1120, VALUE=1)
    assert not first.DONE
    assert second.DONE and second.ERROR == codes.PORT_BUSY and second.STATUS_WORD == 0x818A
    plc.run(500)
    first(EN=True)
    assert first.DONE and first.ERROR == 0
    second(EN=True, XMT_REQ=False)
    second(EN=True, XMT_REQ=True, DRIVE=2, PARAM=1120, VALUE=0x41000000)
    plc.run(500)
    second(EN=True)
    assert second.DONE and second.ERROR == 0 and plc.drive(2).read(1120) == 8.0


def test_parameters_are_read_and_written_while_the_motor_runs():
    plc = Plc()
    plc.start()
    read = until_done(plc, USS_RPM_R(plc.port), DRIVE=1, PARAM=21)
    assert abs(read.VALUE - 25.0) < 0.1
    until_done(plc, USS_WPM_R(plc.port), DRIVE=1, PARAM=1120, VALUE=5.0)
    assert plc.drive().state == "running"


def test_the_words_of_a_refusal_come_beside_the_code():
    plc = Plc()
    plc.run(300)
    write = until_done(plc, USS_WPM_R(plc.port), DRIVE=1, PARAM=1120, VALUE=1e6)
    assert (write.ERROR, write.STATUS_WORD) == (codes.PARAMETER_REPLY, 0x818C)
    assert write.PKW_ERROR == 2 and pkw_errors.error_text(write.PKW_ERROR) == "beyond the limits"


# --- drives of other kinds ----------------------------------------------------------------------

QUICK_MM3 = {"family": mm3, "parameters": {2: 10, 3: 10}}


class FourWords(families.G120):
    layout = Layout(4, 2)


def test_a_micromaster_3_beside_a_micromaster_4():
    plc = Plc((1, 2), kinds={1: QUICK_MM3})
    plc.motor(1).TYPE = 0
    plc.run(300)
    plc.motor(1).RUN = plc.motor(2).RUN = True
    plc.run(1_500)
    for address in (1, 2):
        assert abs(plc.drive(address).hz() - 25.0) < 0.1, address
        assert abs(plc.outputs(address).SPEED - 50.0) < 0.2
    plc.motor(1).DIR = True
    plc.motor(2).SPEED_SP = -50.0
    plc.run(3_000)
    for address in (1, 2):
        assert abs(plc.drive(address).hz() + 25.0) < 0.1, address
        assert abs(plc.outputs(address).SPEED + 50.0) < 0.2
        assert plc.outputs(address).ERROR == 0 and not plc.outputs(address).D_DIR
    plc.motor(1).RUN = plc.motor(2).RUN = False
    plc.run(1_500)
    assert plc.drive(1).state == plc.drive(2).state == "ready"
    plc.check()


def test_parameters_of_a_micromaster_3():
    plc = Plc(kinds={1: QUICK_MM3})
    plc.motor().TYPE = 0
    plc.run(300)
    read = until_done(plc, USS_RPM_W(plc.port), DRIVE=1, PARAM=2)
    assert (read.ERROR, read.VALUE) == (0, 10)
    until_done(plc, USS_WPM_W(plc.port), DRIVE=1, PARAM=2, VALUE=55)
    assert plc.drive().read(2) == 55
    # It has words alone, and no room for more: the channel says so before anything is sent.
    write = until_done(plc, USS_WPM_R(plc.port), DRIVE=1, PARAM=2, VALUE=5.0)
    assert (write.ERROR, write.PKW_ERROR) == (codes.PARAMETER_REPLY, 102)


def test_the_wrong_type_is_a_drive_that_does_not_respond():
    plc = Plc(kinds={1: QUICK_MM3})
    plc.run(500)
    assert plc.outputs().ERROR == codes.NO_ANSWER
    plc.motor().TYPE = 0
    plc.run(300)
    assert plc.outputs().ERROR == 0


def test_a_third_type():
    kind = {"family": g120, "parameters": {2022: 2, 2023: 4, 1120: 1.0, 1121: 1.0}}
    plc = Plc((1, 2), kinds={2: kind}, types=TYPES + (FourWords,))
    plc.motor(2).TYPE = 2
    plc.start(2)
    assert plc.outputs(2).STATUS & 0xFF == 0x37 and plc.outputs(2).RUN_EN
    assert abs(plc.outputs(2).SPEED - 50.0) < 0.1


def test_all_nodes_at_once():
    plc = Plc(tuple(range(31)))
    plc.run(3_000)
    for address in range(31):
        plc.motor(address).RUN = True
        plc.motor(address).SPEED_SP = 20.0 + 2 * address
    plc.run(4_000)
    for address in range(31):
        assert plc.outputs(address).ERROR == 0 and plc.outputs(address).RUN_EN, address
        assert abs(plc.outputs(address).SPEED - 20.0 - 2 * address) < 0.1, address
    plc.hang(400)
    plc.run(6_000)
    for address in range(31):
        assert plc.drive(address).state == "ready" and plc.outputs(address).RUN_VOID
    plc.check()


# --- USS_INIT -----------------------------------------------------------------------------------


def give(init, **inputs):
    """One edge of EN."""
    init(EN=False)
    init(EN=True, **inputs)
    return init


def test_init_is_carried_out_once_for_each_edge():
    plc = Plc((1,))
    for _ in range(20):
        plc.init(EN=True, MODE=1, BAUD=BAUD, ACTIVE=0b100)
        plc.run(2)
    assert plc.port.drives[2] is None
    give(plc.init, MODE=1, BAUD=BAUD, ACTIVE=0b100)
    assert plc.port.drives[2] is not None and plc.port.drives[1] is None


def test_active_drives_are_asked_without_any_other_block():
    plc = Plc((0, 5, 31))
    plc.controls.clear()
    plc.run(1_000)
    for address in (0, 5, 31):
        assert plc.port.drives[address].counters[0] > 5, address
    assert sum(drive is not None for drive in plc.port.drives) == 3


def test_the_active_drives_may_change_while_others_run():
    plc = Plc((1, 2))
    plc.start(1)
    give(plc.init, MODE=1, BAUD=BAUD, ACTIVE=0b0010)
    plc.run(300)
    assert (plc.init.DONE, plc.init.ERROR) == (True, 0)
    assert plc.outputs(2).ERROR == codes.NOT_ACTIVE
    assert plc.drive(1).state == "running" and plc.outputs(1).ERROR == 0
    give(plc.init, MODE=1, BAUD=BAUD, ACTIVE=0b0110)
    plc.run(300)
    assert plc.outputs(2).ERROR == 0 and plc.port.drives[2].contact
    plc.start(2)


def test_no_drive_at_all_may_be_active():
    for active in ({"ACTIVE": 0}, {}):
        plc = Plc((1,))
        plc.run(300)
        give(plc.init, MODE=1, BAUD=BAUD, **active)
        assert (plc.init.DONE, plc.init.ERROR) == (True, 0)
        plc.run(100)
        assert plc.outputs(1).ERROR == codes.NOT_ACTIVE


def test_a_drive_that_runs_cannot_be_dropped():
    for node in (0, 1):
        plc = Plc((node, 2))
        plc.start(node)
        for inputs in (
            {"MODE": 1, "BAUD": BAUD, "ACTIVE": 0b0100}, {"MODE": 0},
            {"MODE": 1, "BAUD": 9600, "ACTIVE": 0b0100 | 1 << node},
            {"MODE": 0, "BAUD": BAUD, "ACTIVE": 0b0100 | 1 << node},
        ):  # fmt: skip
            give(plc.init, **inputs)
            assert plc.init.DONE and plc.init.ERROR == codes.CHANGE_NOT_ALLOWED, inputs
            plc.run(500)
            assert plc.drive(node).state == "running" and plc.outputs(node).ERROR == 0


def test_mode_0_leaves_the_line_and_mode_1_takes_it_again():
    plc = Plc()
    plc.run(300)
    give(plc.init, MODE=0, BAUD=None, ACTIVE=-1)  # with MODE 0 the others do not matter
    for _ in range(50):
        plc.run(2)
        plc.init(EN=False)
    assert plc.init.DONE and plc.init.ERROR == 0 and plc.port.bus is None
    heard = plc.drive().read(2024)
    plc.run(1_000)
    assert plc.drive().read(2024) == heard and plc.outputs().ERROR == codes.PORT_NOT_USS
    give(plc.init, MODE=1, BAUD=BAUD, ACTIVE=0b10)
    assert plc.init.DONE and plc.port.bus.phase == LISTENING
    plc.run(500)
    assert plc.outputs().ERROR == 0 and plc.drive().read(2024) > heard


def test_another_rate_opens_the_line_anew():
    opened = []
    plc = Plc()
    plc.run(300)
    open_bus = plc.open_bus

    def note(baud):
        opened.append(baud)
        return open_bus(19200)

    plc.open_bus = note
    give(plc.init, MODE=1, BAUD=38400, ACTIVE=0b10)
    assert not plc.init.DONE  # an exchange is under way
    second = give(USS_INIT(plc.port), MODE=1, BAUD=BAUD, ACTIVE=0b10)
    assert second.DONE and second.ERROR == codes.PORT_BUSY and not opened
    plc.run(10)
    plc.init(EN=True)
    assert plc.outputs().ERROR == codes.PORT_NOT_USS
    for _ in range(50):
        plc.run(2)
        plc.init(EN=True)
    assert plc.init.DONE and opened == [38400]
    plc.run(300)
    assert plc.outputs().ERROR == 0


def test_before_init_every_block_says_so():
    port = Port(None, Clock())
    port.scan()
    for block in (USS_CTRL(port), USS_RPM_W(port), USS_WPM_R(port)):
        if isinstance(block, USS_CTRL):
            block(DRIVE=1, RUN=True)
        else:
            block(XMT_REQ=True, DRIVE=1, PARAM=700)
            assert block.DONE
        assert block.ERROR == codes.PORT_NOT_USS and block.STATUS_WORD == 0x818E
    init = USS_INIT(port)
    init(EN=False, MODE=1, BAUD=19200, ACTIVE=1)
    assert init.DONE is False


# --- the end of the program ---------------------------------------------------------------------


def close_at(plc, limit_ms):
    """Close the port, in so many milliseconds at the most."""
    before_us = plc.clock.now_us
    plc.port.close()
    assert plc.clock.now_us - before_us < limit_ms * 1000, plc.clock.now_us - before_us


def test_close_stops_every_motor_and_leaves_the_line():
    for paced in (False, True):
        plc = Plc((1, 2), paced=paced)
        plc.start(1)
        plc.start(2)
        close_at(plc, 150)
        assert plc.drive(1).state == plc.drive(2).state == "stopping", paced
        heard = plc.drive(1).read(2024)
        plc.motor(1).RUN = plc.motor(2).RUN = True
        plc.run(2_000)
        assert plc.drive(1).state == "ready" and plc.drive(1).read(2024) == heard
        assert plc.outputs(1).ERROR == codes.PORT_NOT_USS and plc.outputs(1).RUN_VOID
        plc.check()


def test_the_end_of_with_closes_the_port_whatever_ended_it():
    for ending in (None, ValueError, KeyboardInterrupt):
        plc = Plc()
        try:
            with plc.port as port:
                assert port is plc.port
                plc.start()
                if ending:
                    raise ending()
        except (ValueError, KeyboardInterrupt) as error:
            assert isinstance(error, ending)
        assert plc.drive().state == "stopping" and plc.port.bus is None, ending


def test_close_waits_until_the_drive_has_answered():
    plc = Plc()
    plc.start()
    plc.drive().unplug()
    plc.clock.schedule(Event(plc.drive().plug), plc.clock.now_us + 300_000)
    plc.port.close()
    assert plc.drive().state == "stopping"


def test_close_looks_at_the_bus_each_tenth_of_a_millisecond():
    plc = Plc()
    plc.start()
    rests = []
    sleep_us = plc.clock.sleep_us
    plc.clock.sleep_us = lambda us: rests.append(us) or sleep_us(us)
    plc.port.close()
    assert len(rests) > 10 and set(rests) == {100}


def test_close_gives_up_where_nobody_answers():
    plc = Plc()
    plc.start()
    plc.drive().unplug()
    close_at(plc, 1_500)
    assert plc.port.bus is None


def test_ctrl_c_does_not_cut_close_short():
    plc = Plc()
    plc.start()

    def press():
        raise KeyboardInterrupt

    for after_us in (10, 5_000, 12_000):
        plc.clock.schedule(Event(press), plc.clock.now_us + after_us)
    plc.port.close()
    assert plc.drive().state == "stopping" and plc.port.bus is None


def press_ctrl_c_at_the_next_reply(plc):
    take = plc.port.drives[1].take

    def press(*_):
        plc.port.drives[1].take = take
        raise KeyboardInterrupt

    plc.port.drives[1].take = press


def test_ctrl_c_in_the_middle_of_a_polled_scan_stops_the_motor_too():
    plc = Plc()
    plc.start()
    press_ctrl_c_at_the_next_reply(plc)
    try:
        with plc.port:
            plc.run(1_000)
            raise AssertionError("nobody pressed")
    except KeyboardInterrupt:
        pass
    assert plc.drive().state == "stopping"


def test_a_motor_does_not_run_on_where_scans_go_on_after_ctrl_c():
    plc = Plc()
    plc.start()
    press_ctrl_c_at_the_next_reply(plc)
    try:
        plc.run(1_000)
        raise AssertionError("nobody pressed")
    except KeyboardInterrupt:
        pass
    plc.run(2_000)
    assert plc.motor().RUN and plc.drive().state == "ready" and plc.outputs().RUN_VOID
    plc.check()


def test_a_port_that_is_not_set_up_or_closed_is_closed_at_once():
    port = Port(None, Clock())
    port.close()
    plc = Plc()
    plc.run(100)
    for _ in range(2):
        plc.port.close()
    plc = Plc()
    plc.start()
    plc.motor().RUN = False
    plc.run(1_500)
    give(plc.init, MODE=0)
    plc.port.close()  # it is being left already
    assert plc.port.bus is None and plc.port.is_set_up()


def test_a_closed_port_is_set_up_again_by_uss_init_and_starts_nothing():
    plc = Plc((0, 1, 31))
    plc.start()
    plc.port.close()
    assert plc.port.drives == plc.port.controls == [None] * 32
    give(plc.init, MODE=1, BAUD=BAUD, ACTIVE=plc.active)
    assert plc.init.DONE and plc.init.ERROR == 0
    plc.run(2_000)
    assert plc.outputs().ERROR == 0 and plc.outputs().RUN_VOID
    assert plc.drive().state == "ready" and plc.drive().starts == 1
    assert plc.port.drives[0].contact and plc.port.drives[31].contact


def test_a_parameter_block_that_close_has_overtaken_says_so():
    plc = Plc()
    plc.run(300)
    plc.drive().unplug()
    read = USS_RPM_W(plc.port)
    read(EN=True, XMT_REQ=True, DRIVE=1, PARAM=700)
    plc.port.close()
    read(EN=True, XMT_REQ=True, DRIVE=1, PARAM=700)
    assert read.DONE and read.ERROR == codes.PORT_NOT_USS


def test_close_after_a_hang_stops_the_motors():
    for hang_ms in (400, 20_000):
        plc = Plc()
        plc.start()
        plc.hang(hang_ms)
        assert plc.drive().state == "running"
        close_at(plc, 1_500)
        assert plc.drive().state == "stopping"
