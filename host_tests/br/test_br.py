# SPDX-License-Identifier: MIT
"""DriveController and its structures, used as a PLC program uses them, on simulated drives."""

import random

from boards.sim.drives.families import mm3, mm440
from br_bench import QUICK, SCAN_US, Plc
from uss import families, pzd
from uss.br import DriveController, codes
from uss.br.structures import STATUS_WORD
from uss.master import OFF

# --- a motor runs and stops ---------------------------------------------------------------------


def test_run_makes_the_motor_run_at_the_frequency_and_its_end_stops_it():
    plc = Plc()
    told = plc.told()
    plc.run(10)
    assert not told.Status.Receive  # it listens first
    plc.run(490)
    assert told.Status.Receive and told.StatusWord.DriveReady and not told.StatusWord.DriveRunning
    plc.wanted().Run = True
    plc.run(2_000)
    assert plc.drives[1].state == "running" and abs(plc.drives[1].hz() - 25.0) < 0.01
    assert told.StatusWord.DriveRunning and told.StatusWord.MotorRunsRight
    assert told.ActualValue.HEX == 0x2000
    assert abs(told.ActualValue.Percent - 50.0) < 0.02 and abs(told.ActualValue.Freq - 25.0) < 0.01
    plc.wanted().Run = False
    plc.run(2_000)
    assert plc.drives[1].state == "ready" and told.ActualValue.Freq == 0
    assert not plc.status.Error and plc.status.Busy
    plc.check()


def test_every_bit_of_the_status_word_has_its_member():
    plc = Plc()
    plc.start()
    word = plc.controller.bus.turns.at(1).zsw
    status = plc.told().StatusWord
    assert [getattr(status, name) for name in STATUS_WORD] == [
        word >> place & 1 == 1 for place in range(16)
    ]


def test_a_negative_frequency_and_reverse_turn_the_motor_round_and_cancel_each_other():
    plc = Plc()
    plc.start()
    for reverse, freq, hertz in (
        (True, 25.0, -25.0), (False, -25.0, -25.0), (True, -25.0, 25.0), (False, 10.0, 10.0)
    ):  # fmt: skip
        plc.wanted().Reverse = reverse
        plc.wanted().Freq = freq
        plc.run(3_000)
        assert abs(plc.drives[1].hz() - hertz) < 0.01, (reverse, freq, plc.drives[1].hz())
        assert abs(plc.told().ActualValue.Freq - hertz) < 0.01
    plc.check()


def test_the_reference_frequency_is_that_of_the_drive():
    parameters = dict(QUICK)
    parameters[2000] = 100.0
    plc = Plc(kinds={1: {"family": mm440, "parameters": parameters}})
    plc.lengths().PKW_lengh = 4
    plc.wanted().RefFreq = 100.0
    plc.start()
    assert abs(plc.drives[1].hz() - 25.0) < 0.01 and abs(plc.told().ActualValue.Percent - 25) < 0.1


def test_a_jog_goes_on_as_long_as_it_is_wanted_and_two_are_none():
    plc = Plc()
    plc.run(500)
    plc.wanted().JOGRight = True
    plc.run(1_000)
    assert plc.drives[1].hz() > 0
    plc.wanted().JOGLeft = True
    plc.run(2_000)
    assert plc.drives[1].hz() == 0
    plc.wanted().JOGRight = False  # the other one was on already: it has no edge
    plc.run(1_000)
    assert plc.drives[1].hz() == 0
    plc.wanted().JOGLeft = False
    plc.run(10)
    plc.wanted().JOGLeft = True
    plc.run(1_000)
    assert plc.drives[1].hz() < 0
    plc.wanted().JOGLeft = False
    plc.run(1_500)
    assert plc.drives[1].hz() == 0
    plc.check()


def test_a_jog_has_no_setpoint():
    plc = Plc()
    plc.run(500)
    plc.wanted().Run = True
    plc.run(100)
    plc.wanted().Run = False
    plc.run(500)
    assert plc.controller.bus.turns.at(1).hsw == 0x2000
    plc.wanted().JOGRight = True
    plc.run(10)
    assert plc.controller.bus.turns.at(1).wanted == pzd.JOG_RIGHT
    assert plc.controller.bus.turns.at(1).hsw == 0


def test_a_jog_does_not_become_a_run():
    plc = Plc()
    plc.run(500)
    plc.wanted().JOGRight = True
    plc.run(1_000)
    plc.wanted().Run = True
    plc.run(2_000)
    assert plc.drives[1].hz() == 0
    plc.wanted().JOGRight = plc.wanted().Run = False
    plc.start()


# --- no surprise start --------------------------------------------------------------------------


def test_run_that_is_on_when_the_bus_is_started_starts_nothing():
    plc = Plc()
    plc.wanted().Run = True
    plc.run(2_000)
    assert plc.drives[1].starts == 0
    plc.wanted().Run = False
    plc.run(10)
    plc.start()


def test_a_start_that_is_on_from_the_first_call_starts_nothing():
    plc = Plc()
    other = DriveController(plc.open_bus, plc.clock)
    other.Cmd.Start = True
    other()
    assert other.Status.Ready and not other.Status.Busy and other.bus is None


def test_after_a_fault_run_and_each_jog_want_a_new_edge():
    for member, has_edge in (("Run", False), ("Run", True), ("JOGRight", True), ("JOGLeft", True)):
        plc = Plc()
        plc.run(500)
        setattr(plc.wanted(), member, True)
        plc.run(500)
        assert plc.told().StatusWord.DriveRunning
        plc.drives[1].fault(1)
        plc.run(500)
        assert plc.told().StatusWord.DriveFault and not plc.told().StatusWord.DriveRunning
        if has_edge:  # while it cannot run that is no use
            setattr(plc.wanted(), member, False)
            plc.run(10)
            setattr(plc.wanted(), member, True)
            plc.controller()
            assert not plc.controller.bus.turns.at(1).wanted
        plc.wanted().FaultAcknowledge = True
        plc.run(1_000)
        assert not plc.told().StatusWord.DriveFault and plc.drives[1].state == "ready"
        assert plc.drives[1].starts == 1, member
        setattr(plc.wanted(), member, False)
        plc.run(10)
        plc.start()


def test_a_drive_that_was_lost_and_comes_back_does_not_run():
    plc = Plc()
    plc.start()
    plc.drives[1].unplug()
    for ms in (200, 1_300):  # it counts as lost after a second
        plc.run(ms)
        assert not plc.told().Status.Receive and plc.told().Status.ErrorID == codes.NO_MESSAGE
    plc.drives[1].plug()
    plc.run(3_000)
    assert plc.told().Status.Receive and plc.told().Status.ErrorID == codes.NO_ERROR
    assert plc.drives[1].hz() == 0 and plc.drives[1].starts == 1
    assert not plc.status.Error  # the source skips such an address, and goes on


def test_a_scan_that_hangs_stops_the_motors_when_it_goes_on():
    plc = Plc()
    plc.start()
    plc.clock.advance(400_000)
    plc.run(2_000)
    assert plc.drives[1].hz() == 0 and plc.drives[1].starts == 1


def test_leaving_with_stops_the_motor_whatever_happens():
    plc = Plc()
    plc.start()
    try:
        with plc.controller:
            raise KeyError("a contact is missing")
    except KeyError:
        pass
    assert plc.drives[1].state == "stopping"
    plc.run(1_500)
    assert plc.drives[1].hz() == 0 and plc.status.Ready and not plc.told().Status.Receive


def test_close_looks_at_the_bus_each_tenth_of_a_millisecond():
    plc = Plc()
    plc.start()
    rests = []
    sleep_us = plc.clock.sleep_us
    plc.clock.sleep_us = lambda us: rests.append(us) or sleep_us(us)
    plc.controller.close()
    assert len(rests) > 10 and set(rests) == {100}


def test_a_controller_that_was_never_started_leaves_at_once():
    plc = Plc()
    plc.run(100)
    sent = len(plc.wire.log.last(1000))
    before_us = plc.clock.now_us
    with DriveController(plc.open_bus, plc.clock) as other:
        for other.Cmd.Stop in (False, True):  # and there is nothing to stop
            other()
    assert other.bus is None and other.Status.Ready and not other.Status.Done
    assert plc.clock.now_us == before_us and len(plc.wire.log.last(1000)) == sent


# --- stop and start -----------------------------------------------------------------------------


def test_stop_stops_the_motors_and_leaves_the_line_and_start_takes_it_again():
    plc = Plc((1, 2))
    plc.start(1)
    plc.start(2)
    plc.controller.Cmd.Stop = True
    plc.run(100)
    assert plc.status.Done and plc.status.Ready and not plc.status.Busy
    assert plc.controller.bus.phase == OFF
    assert not plc.told(1).Status.Receive
    sent = len(plc.wire.log.last(1000))
    plc.run(1_500)
    assert len(plc.wire.log.last(1000)) == sent and plc.drives[1].hz() == plc.drives[2].hz() == 0
    plc.controller.Cmd.Stop = False
    plc.controller.Cmd.Start = True
    plc.run(1_000)
    assert plc.status.Busy and not plc.status.Ready and not plc.status.Done
    assert plc.told(1).Status.Receive and plc.drives[1].starts == 1
    plc.wanted(1).Run = False
    plc.run(10)
    plc.start(1)
    plc.check()


def test_start_counts_only_when_it_may_be_started():
    plc = Plc()
    plc.start()
    plc.controller.Cmd.Start = True  # it is at work
    plc.run(500)
    assert plc.drives[1].state == "running" and plc.drives[1].starts == 1
    plc.controller.Cmd.Start = False
    plc.controller.Cmd.Stop = True
    plc.controller()
    plc.controller.Cmd.Stop = False
    plc.controller.Cmd.Start = True  # it is on its way out
    plc.run(300)
    assert plc.status.Done and plc.controller.bus.phase == OFF
    plc.controller.Cmd.Start = False
    plc.run(10)
    plc.controller.Cmd.Start = plc.controller.Cmd.Stop = True  # Stop goes first
    plc.run(10)
    plc.controller.Cmd.Stop = False
    plc.run(300)
    assert plc.status.Done and plc.controller.bus.phase == OFF


def test_what_was_switched_on_while_the_line_was_left_has_no_edge():
    plc = Plc()
    plc.start()
    for way_out in ("Stop", "close"):
        if way_out == "Stop":
            plc.controller.Cmd.Stop = True
        else:
            plc.controller.close()
        plc.run(1_500)
        plc.controller.Cmd.Stop = False
        plc.wanted().Run = plc.wanted().FaultAcknowledge = True
        plc.drives[1].fault(1)
        plc.controller.Cmd.Start = True
        plc.run(1_000)
        assert plc.drives[1].state == "fault" and plc.told().StatusWord.DriveFault, way_out
        plc.controller.Cmd.Start = False
        plc.wanted().Run = plc.wanted().FaultAcknowledge = False
        plc.run(10)
        plc.wanted().FaultAcknowledge = True
        plc.run(500)
        assert plc.drives[1].state == "ready" and plc.drives[1].starts == 1, way_out
        plc.wanted().FaultAcknowledge = False
    plc.check()


# --- the sequence and the lengths ---------------------------------------------------------------


def test_a_drive_that_stands_in_the_sequence_twice_is_asked_twice_as_often():
    plc = Plc((1, 2))
    plc.sequence(1, 2, 1)
    plc.run(200)
    drives = [plc.controller.bus.turns.at(address) for address in (1, 2)]
    before = [drive.counters[0] for drive in drives]
    plc.run(3_000)
    one, two = [drive.counters[0] - then for drive, then in zip(drives, before)]
    assert 1.9 < one / two < 2.1
    assert plc.controller.DriveSequence.ADDR in (1, 2)


def test_the_address_told_is_that_of_the_drive_that_has_answered():
    plc = Plc((1, 2))
    plc.run(500)
    told = set()
    for _ in range(50):
        plc.run(4)
        told.add(plc.controller.DriveSequence.ADDR)
    assert told == {1, 2}
    plc.drives[1].unplug()
    plc.run(100)
    told.clear()
    for _ in range(50):
        plc.run(4)
        told.add(plc.controller.DriveSequence.ADDR)
    assert told == {2}


def test_a_drive_that_leaves_the_sequence_is_stopped_first():
    plc = Plc((1, 2))
    plc.start(1)
    plc.start(2)
    plc.sequence(2)
    plc.run(2_000)
    assert plc.drives[1].hz() == 0 and plc.drives[2].state == "running"
    assert plc.controller.bus.turns.at(1) is None and not plc.told(1).Status.Receive
    plc.sequence(2, 1)  # Run is on: that is no edge
    plc.run(1_000)
    assert plc.told(1).Status.Receive and plc.drives[1].starts == 1
    plc.check()


def test_lengths_may_change_while_the_bus_works_and_stop_the_motor():
    plc = Plc(kinds={1: {"parameters": QUICK}})  # a MICROMASTER 420: 4 + 2
    plc.run(1_000)
    assert not plc.told().Status.Receive
    plc.lengths().PKW_lengh = 4
    plc.start()
    plc.lengths().PZD_lengh = 4
    plc.run(2_000)
    assert plc.drives[1].hz() == 0 and plc.controller.bus.turns.at(1).layout.pzd_words == 4


def test_the_sequence_has_255_places():
    plc = Plc((1, 2))
    plc.sequence(*[1] * 254 + [2])
    plc.run(500)
    assert len(plc.controller.bus.turns.list) == 255
    assert plc.controller.bus.turns.list[-1].address == 2


def test_a_drive_that_is_on_its_way_out_of_the_sequence_is_not_started():
    plc = Plc((1, 2))
    plc.start(1)
    plc.sequence(2)
    plc.run(100)
    assert plc.drives[1].state == "stopping"
    for plc.wanted(1).Run in (False, True):
        plc.controller()
        assert not plc.controller.bus.turns.at(1).wanted
    plc.run(1_000)
    assert plc.drives[1].starts == 1 and plc.controller.bus.turns.at(1) is None
    plc.check()


def test_a_drive_whose_telegrams_have_no_control_word_is_not_started():
    plc = Plc(kinds={1: {"family": mm440, "parameters": {2012: 0}}})
    plc.lengths().PKW_lengh, plc.lengths().PZD_lengh = 4, 0
    plc.run(500)
    assert plc.told().Status.Receive and not plc.told().StatusWord.DriveReady
    plc.wanted().Run = True
    plc.run(500)
    assert plc.drives[1].starts == 0 and not plc.status.Error


def test_the_empty_sequence_asks_nobody():
    plc = Plc()
    plc.run(500)
    plc.sequence()
    plc.run(500)
    sent = len(plc.wire.log.last(1000))
    plc.run(500)
    assert len(plc.wire.log.last(1000)) == sent and plc.status.Busy


def test_other_families_run_by_their_own_words():
    plc = Plc(
        (1, 2),
        kinds={2: {"family": mm3, "parameters": {}}},
        families={2: families.MM3},
    )
    plc.lengths(2).PKW_lengh = 3
    plc.wanted(2).Freq = -20.0
    plc.start(2, 12_000)
    assert abs(plc.drives[2].hz() + 20.0) < 0.01, plc.drives[2].hz()
    assert abs(plc.told(2).ActualValue.Freq + 20.0) < 0.1


# --- errors -------------------------------------------------------------------------------------


def test_a_wrong_frequency_stops_the_motor_and_says_so_until_it_is_acknowledged():
    for member, wrong, code in (
        ("RefFreq", 0.99, codes.REFERENCE),
        ("RefFreq", 650.1, codes.REFERENCE),
        ("RefFreq", None, codes.REFERENCE),
        ("Freq", 100.0, codes.FREQUENCY),
        ("Freq", -100.01, codes.FREQUENCY),
        ("Freq", float("nan"), codes.FREQUENCY),
        ("Freq", "25", codes.FREQUENCY),
    ):
        plc = Plc()
        plc.start()
        right = getattr(plc.wanted(), member)
        setattr(plc.wanted(), member, wrong)
        plc.run(2_000)
        assert (plc.status.Error, plc.status.ErrorID) == (True, code), (member, wrong)
        assert plc.drives[1].hz() == 0 and plc.told().Status.Receive
        setattr(plc.wanted(), member, right)
        plc.run(1_000)
        assert plc.status.ErrorID == code and plc.drives[1].starts == 1
        plc.acknowledge_errors()
        assert (plc.status.Error, plc.status.ErrorID) == (False, codes.NO_ERROR)
        assert plc.drives[1].starts == 1
        plc.wanted().Run = False
        plc.run(10)
        plc.start()


def test_the_ends_of_the_ranges_are_right():
    plc = Plc()
    plc.run(300)
    for reference in (1, 1.0, 650, 650.0):
        for freq in (-2 * reference, 1.9999 * reference, 0):
            plc.wanted().RefFreq, plc.wanted().Freq = reference, freq
            plc.run(4)
            assert not plc.status.Error, (reference, freq)


def test_an_error_of_one_drive_stops_no_other():
    plc = Plc((1, 2))
    plc.start(1)
    plc.start(2)
    plc.wanted(2).Freq = 1_000.0
    plc.run(2_000)
    assert plc.status.ErrorID == codes.FREQUENCY
    assert plc.drives[1].state == "running" and plc.drives[2].hz() == 0


def test_wrong_lengths_and_addresses_are_told():
    for set_wrong, code in (
        (lambda plc: setattr(plc.lengths(), "PKW_lengh", 5), codes.PKW_LENGTH),
        (lambda plc: setattr(plc.lengths(), "PKW_lengh", None), codes.PKW_LENGTH),
        (lambda plc: setattr(plc.lengths(), "PZD_lengh", 17), codes.PZD_LENGTH),
        (lambda plc: plc.sequence(1, 32), codes.ADDRESS),
        (lambda plc: plc.sequence(1, -1), codes.ADDRESS),
        (lambda plc: plc.sequence(1, "2"), codes.ADDRESS),
    ):
        plc = Plc()
        plc.run(300)
        set_wrong(plc)
        plc.run(100)
        assert plc.status.ErrorID == code, (plc.status.ErrorID, code)
        assert plc.told().Status.Receive  # as it was before


def test_with_a_wrong_address_the_sequence_before_stays():
    plc = Plc((1, 2))
    plc.run(500)
    plc.sequence(1, 32)
    plc.run(500)
    assert plc.status.ErrorID == codes.ADDRESS and plc.told(2).Status.Receive
    assert [drive.address for drive in plc.controller.bus.turns.list] == [1, 2]


def test_wrong_lengths_stop_the_motor():
    plc = Plc()
    plc.start()
    plc.lengths().PZD_lengh = 17
    plc.run(1_500)
    assert plc.status.ErrorID == codes.PZD_LENGTH and plc.drives[1].hz() == 0
    plc.lengths().PZD_lengh = 2
    plc.acknowledge_errors()
    plc.run(500)
    assert plc.drives[1].starts == 1 and plc.told().Status.Receive
    plc.wanted().Run = False
    plc.run(10)
    plc.start()


def test_a_drive_whose_lengths_are_wrong_is_not_taken_into_the_sequence():
    plc = Plc((1, 2))
    plc.sequence(1)
    plc.run(500)
    plc.lengths(2).PKW_lengh = 5
    plc.sequence(1, 2)
    plc.run(500)
    assert (plc.status.Error, plc.status.ErrorID) == (True, codes.PKW_LENGTH)
    assert plc.controller.bus.turns.at(2) is None and not plc.told(2).Status.Receive
    assert plc.told(1).Status.Receive
    plc.lengths(2).PKW_lengh = 0
    plc.acknowledge_errors()
    plc.run(500)
    assert plc.told(2).Status.Receive and not plc.status.Error
    plc.check()


def test_a_telegram_of_no_words_is_told():
    plc = Plc()
    plc.lengths().PKW_lengh = plc.lengths().PZD_lengh = 0
    plc.run(100)
    assert plc.status.ErrorID == codes.LGE_SENT


def test_the_codes_of_what_comes_back_spoilt_are_told_for_the_drive():
    counters = [0] * 7
    for place, code in enumerate(codes.COUNTER_CODES):
        after = list(counters)
        after[place] += 1
        assert codes.of_reply(after, counters) == code
    assert codes.of_reply([0, 0, 0, 1, 0, 1, 0], counters) == codes.BCC_RECEIVED
    assert codes.of_reply([9, 0, 0, 0, 0, 1, 0], counters) == codes.NO_MESSAGE
    wraps = [0, 0, 0, 0xFFFF, 0, 0, 0]
    assert codes.of_reply(counters, wraps) == codes.BCC_RECEIVED


def test_a_port_that_fails_is_told_and_stops_the_motor():
    plc = Plc()
    plc.start()

    def fails(buffer, at):
        raise OSError(5)

    receive = plc.link.receive
    plc.link.receive = fails
    plc.run(20)
    plc.link.receive = receive
    plc.run(2_000)
    assert plc.status.ErrorID == codes.READ_FAILED
    assert plc.drives[1].hz() == 0 and plc.drives[1].starts == 1
    plc.acknowledge_errors()
    plc.run(100)
    assert not plc.status.Error and plc.status.ErrorID == codes.NO_ERROR  # it was told once
    plc.controller.close()
    plc.controller.Cmd.Start = True
    plc.run(300)
    assert plc.told().Status.Receive and not plc.status.Error  # the port that is opened anew


def test_ctrl_c_in_the_middle_of_a_scan_ends_the_program_and_leaves_no_motor_running():
    plc = Plc()
    plc.start()

    def interrupted(buffer, at):
        raise KeyboardInterrupt

    receive = plc.link.receive
    plc.link.receive = interrupted
    try:
        plc.run(20)
    except KeyboardInterrupt:
        plc.link.receive = receive
    else:
        raise AssertionError("Ctrl-C is lost")
    assert plc.controller.bus.failures == 1
    plc.run(2_000)  # somebody goes on all the same
    assert plc.drives[1].hz() == 0 and plc.drives[1].starts == 1
    assert plc.status.ErrorID == codes.READ_FAILED
    plc.check()


def test_every_code_has_a_text():
    for _, rows in codes.BLOCKS:
        for code, meaning in rows:
            assert codes.text(code) == meaning != ""
    assert codes.text(0) == "" and "1...650 Hz" in codes.text(101) == codes.text(400)
    try:
        codes.text(504)
        raise AssertionError("504 is unused")
    except KeyError:
        pass


def test_random_programs_never_start_a_motor_without_an_edge():
    for seed in range(6):
        random.seed(seed)
        print("seed", seed)
        plc = Plc((1, 2))
        plc.run(500)
        was_wanted = {1: False, 2: False}
        edges = {1: 0, 2: 0}
        for _ in range(100):
            address = random.choice((1, 2))
            wanted = plc.wanted(address)
            change(plc, wanted, random.randrange(10))
            for each in (1, 2):
                now = plc.wanted(each)
                is_wanted = bool(now.Run or now.JOGRight or now.JOGLeft)
                edges[each] += is_wanted and not was_wanted[each]
                was_wanted[each] = is_wanted
            plc.run(random.choice((SCAN_US // 1000, 50, 400)))
        for each in (1, 2):
            assert plc.drives[each].starts <= edges[each], seed
        for drive in plc.drives.values():
            drive.plug()  # without P2014, one that hears nothing runs for ever
        plc.run(500)
        plc.controller.close()
        plc.clock.advance(3_000_000)
        assert plc.drives[1].hz() == plc.drives[2].hz() == 0
        plc.check()


def change(plc, wanted, what):
    if what < 3:
        wanted.Run = not wanted.Run
    elif what == 3:
        wanted.JOGRight = not wanted.JOGRight
    elif what == 4:
        wanted.Reverse = not wanted.Reverse
    elif what == 5:
        wanted.Freq = random.choice((-30.0, 0.0, 20.0, 50.0, 1e9, None))
    elif what == 6:
        wanted.RefFreq = random.choice((50.0, 50.0, 0.0))
    elif what == 7:
        wanted.FaultAcknowledge = not wanted.FaultAcknowledge
    elif what == 8:
        plc.sequence(*random.choice(((1, 2), (2,), (1, 1, 2), (2, 1))))
    else:
        drive = plc.drives[random.choice((1, 2))]
        random.choice((drive.plug, drive.unplug, lambda: drive.fault(1)))()
