# SPDX-License-Identifier: MIT
"""The bus master: the circulating list, supervision of replies, parameter jobs, tickets."""

from master_bench import MASK, REPLY_DELAY_US, TIMING, Bus, parameters
from uss import pkw, pzd
from uss.drive import ANY, Drive
from uss.layout import VARIABLE, Layout
from uss.master import (
    AWAITING,
    CLOSED,
    DEAD_MAN_US,
    LISTENING,
    LOST_US,
    OFF,
    RESTING,
    SENDING,
    Master,
)
from uss.outside import Mirror
from uss.receiver import COMING, Receiver
from uss.timing import BAUD_RATES, Timing

# --- who talks when -----------------------------------------------------------------------------


def test_it_listens_for_100_ms_before_its_first_telegram():
    bus = Bus()
    bus.run(99_000)
    assert bus.sent == [] and bus.master.phase == LISTENING
    bus.run(5_000)
    assert len(bus.sent) == 1


def test_it_listens_as_long_however_late_it_begins():
    bus = Bus(start_at=10_000_000)
    bus.run(200_000)
    assert 10_100_000 <= bus.sent[0][0] < 10_110_000


def test_an_exchange_is_under_way_with_the_drive_that_was_sent_something_and_with_no_other():
    bus = Bus(addresses=(1, 2))
    seen = set()
    for _ in range(300):
        bus.run(1_000)
        busy = [drive.address for drive in bus.drives if bus.master.is_under_way(drive)]
        goes_on = bus.master.phase in (SENDING, AWAITING)
        assert busy == ([bus.sent[-1][1][2]] if goes_on else []), (bus.master.phase, busy)
        seen.add(tuple(busy))
    assert seen == {(), (1,), (2,)}


def test_another_master_is_noticed_and_not_fought():
    bus = Bus()
    for _ in range(50):
        bus.reply, bus.reply_at = b"\x02\x06\x01", bus.now
        bus.run(50_000)
    assert bus.sent == [] and bus.master.foreign >= 50
    bus.run(120_000)
    assert len(bus.sent) > 0


def test_the_list_goes_round_and_a_node_may_stand_in_it_twice():
    """The list of specification A-5.1: 0 1 3 5 0 1 7 21."""
    order = (0, 1, 3, 5, 0, 1, 7, 21)
    bus = Bus((0, 1, 3, 5, 7, 21))
    bus.master.turns.list.clear()
    for address in order:
        bus.master.turns.add(address)
    assert len(bus.master.turns.drives) == 6
    bus.run(1_000_000)
    sent = bus.addresses()
    for index in range(24):
        assert sent[index] == order[index % 8]


def test_the_next_telegram_follows_the_reply_after_the_start_interval():
    bus = Bus()
    bus.run(1_000_000)
    instants = [at for at, _ in bus.sent]
    gaps = [after - before for before, after in zip(instants, instants[1:])]
    exchange_us = TIMING.exchange_us(12, REPLY_DELAY_US)
    assert all(exchange_us <= gap <= exchange_us + 5 for gap in gaps), gaps[:5]


def test_a_silent_drive_is_counted_and_stays_in_the_list():
    bus = Bus((1, 2))
    bus.silent.add(2)
    bus.run(3_000_000)
    one, two = bus.drives
    assert two in bus.master.turns.list
    assert repr(two) == "<drive 2 ZSW 0000 HIW 0000>"
    assert repr(one) == "<drive 1 ZSW FB31 HIW 0000>"
    assert two.counters[5] >= 4 and two.counters[0] == 0 and not two.contact
    assert one.counters[0] > 20 and one.contact


def test_a_drive_beyond_the_list_or_the_addresses_is_refused():
    bus = Bus()
    for wrong in (-1, 32, None, "1"):
        try:
            bus.master.turns.add(wrong)
        except (ValueError, TypeError):
            continue
        raise AssertionError(wrong)
    for _ in range(254):
        bus.master.turns.add(1)
    try:
        bus.master.turns.add(1)
    except ValueError:
        return
    raise AssertionError("256 entries")


def test_a_closed_bus_ends_after_the_exchange_that_goes_on():
    bus = Bus()
    bus.run(200_000)
    bus.master.close()
    bus.run(50_000)
    assert bus.master.phase == CLOSED
    sent = len(bus.sent)
    bus.run(1_000_000)
    assert len(bus.sent) == sent


def test_a_bus_that_is_off_is_closed_at_once():
    bus = Bus()
    bus.run(200_000)
    bus.master.off()
    bus.run(50_000)
    sent = len(bus.sent)
    assert bus.master.phase == OFF
    bus.master.close()
    assert bus.master.phase == CLOSED
    bus.master.on()
    bus.run(500_000)
    assert bus.master.phase == CLOSED and len(bus.sent) == sent


def test_a_bus_that_is_closed_again_and_again_is_closed_all_the_same():
    """Each time was a new STOP for every drive, and none was ever answered in time."""
    bus = Bus()
    bus.run(200_000)
    for _ in range(50):
        bus.master.close()
        bus.run(1_000)
    assert bus.master.phase == CLOSED


def test_a_bus_that_is_closed_while_it_goes_off_is_closed_and_off_no_more():
    for calls in ((Master.off, Master.close), (Master.close, Master.off)):
        bus = Bus()
        bus.run(200_000)
        for call in calls:
            call(bus.master)
        bus.run(50_000)
        assert bus.master.phase == CLOSED and bus.drives[0].contact


# --- commands -----------------------------------------------------------------------------------


def test_a_drive_is_off_until_it_is_started():
    bus = Bus()
    bus.run(500_000)
    assert set(bus.stws(1)) == {pzd.OFF1}


def test_on_carries_the_setpoint_and_off_none():
    bus = Bus()
    bus.run(300_000)
    bus.drives[0].start(0x2000)
    bus.run(100_000)
    assert bus.sent[-1][1][11:15] == b"\x04\x7f\x20\x00"
    bus.drives[0].stop()
    bus.run(100_000)
    assert bus.sent[-1][1][11:15] == b"\x04\x7e\x00\x00"


def test_start_without_contact_sends_no_on_and_none_later():
    bus = Bus()
    bus.silent.add(1)
    bus.run(300_000)
    bus.drives[0].start(0x2000)
    bus.run(3_000_000)
    bus.silent.clear()
    bus.run(3_000_000)
    assert pzd.ON not in bus.stws(1) and bus.drives[0].contact


def test_a_command_is_in_the_next_telegram_whatever_stands_in_the_list():
    bus = Bus(tuple(range(1, 32)))
    bus.run(3_000_000)
    for step in range(60):
        bus.run(1_237)  # another phase of another exchange each time
        drive = bus.drives[step * 7 % 31]
        sent = len(bus.sent)
        if step & 1:
            drive.stop()
        else:
            drive.start(0x1000)
        while len(bus.sent) == sent:
            bus.run(200)
        assert bus.sent[sent][1][2] == drive.address


def test_a_stop_goes_before_a_start_and_a_running_drive_first():
    bus = Bus((1, 2, 3, 4))
    bus.zsw[4] = 0xFB34
    bus.run(500_000)
    sent = len(bus.sent)
    bus.drives[0].start(0)
    bus.drives[1].stop()
    bus.drives[3].stop()
    while len(bus.sent) < sent + 3:
        bus.run(200)
    assert bus.addresses(sent) == [4, 2, 1]


def test_a_lost_drive_gets_no_on_until_it_is_started_again():
    bus = Bus()
    bus.run(300_000)
    drive = bus.drives[0]
    drive.start(0x2000)
    bus.zsw[1] = 0xFB34
    bus.run(300_000)
    assert bus.stws(1)[-1] == pzd.ON
    bus.silent.add(1)
    bus.run(LOST_US - 100_000)
    assert drive.contact and bus.stws(1)[-1] == pzd.ON
    bus.run(200_000)
    assert not drive.contact and drive.was_running and drive.stopped_by_engine()
    sent = len(bus.sent)
    bus.silent.clear()
    bus.run(2_000_000)
    assert drive.contact and pzd.ON not in bus.stws(1, sent)
    drive.start(0x2000)
    bus.run(100_000)
    assert bus.stws(1)[-1] == pzd.ON


def test_a_loop_that_does_not_refresh_loses_every_drive_after_300_ms():
    bus = Bus((1, 2, 3))
    bus.run(500_000)
    for drive in bus.drives:
        drive.start(0x1000)
        bus.zsw[drive.address] = 0xFB34
    bus.run(500_000)
    last = bus.now
    bus.run(1_000_000, refresh=False)
    assert bus.master.dead_man_trips == 1
    for drive in bus.drives:
        offs = [
            at
            for at, characters in bus.sent
            if at > last and characters[2] == drive.address and characters[12] == 0x7E
        ]
        assert DEAD_MAN_US < offs[0] - last <= DEAD_MAN_US + 4 * 22_000
    sent = len(bus.sent)
    bus.run(1_000_000)  # the loop is back: nothing starts
    for drive in bus.drives:
        assert pzd.ON not in bus.stws(drive.address, sent)


def test_a_program_that_never_refreshes_gets_no_on():
    bus = Bus()
    bus.run(300_000, refresh=False)
    bus.drives[0].start(0x1000)
    bus.run(1_000_000, refresh=False)
    assert len(bus.sent) > 20 and pzd.ON not in bus.stws(1)


def test_every_stop_is_sent_even_when_a_start_follows_at_once():
    bus = Bus((1, 2, 3))
    bus.run(500_000)
    drive = bus.drives[1]
    drive.start(0x1000)
    bus.run(200_000)
    for _ in range(3):
        sent = len(bus.sent)
        drive.stop()
        drive.start(0x1000)
        bus.run(200_000)
        stws = bus.stws(2, sent)
        assert stws[0] == pzd.OFF1 and stws[1] == stws[-1] == pzd.ON


def test_an_off_that_is_not_answered_is_repeated_every_second_telegram():
    bus = Bus((1, 2, 3, 4, 5, 6, 7, 8))
    bus.run(1_000_000)
    bus.silent.add(5)
    sent = len(bus.sent)
    bus.drives[4].stop()
    bus.run(800_000)
    addresses = bus.addresses(sent)
    after = addresses[addresses.index(5) :]
    assert after[:20].count(5) >= 10
    assert set(after[:20]) == {1, 2, 3, 4, 5, 6, 7, 8}  # the list goes on in between
    assert after[21:].count(5) <= 2  # it does not take half of the line for ever
    bus.silent.clear()
    sent = len(bus.sent)
    bus.run(500_000)
    assert bus.addresses(sent).count(5) <= 4


def test_a_drive_that_inhibits_itself_or_trips_is_not_left_with_on():
    """Before it ever ran: it must not start when the cause goes away."""
    for zsw in (0xFB71, 0xFB78):
        bus = Bus()
        bus.run(300_000)
        bus.zsw[1] = zsw
        bus.drives[0].start(0x1000)
        bus.run(200_000)
        assert bus.stws(1)[-1] == pzd.OFF1 and bus.drives[0].stopped_by_engine()


def test_a_drive_may_take_its_time_to_run_again_after_a_stop():
    bus = Bus()
    bus.run(300_000)
    drive = bus.drives[0]
    for _ in range(3):
        bus.zsw[1] = 0xFB31
        drive.start(0x1000)
        bus.run(300_000)  # not running yet: it magnetises its motor
        assert bus.stws(1)[-1] == pzd.ON and not drive.stopped_by_engine()
        bus.zsw[1] = 0xFB34
        bus.run(300_000)
        drive.stop()
        bus.run(300_000)


def test_when_the_dead_man_trips_the_drives_that_run_are_stopped_first():
    bus = Bus(tuple(range(1, 32)))
    bus.run(3_000_000)
    running = (5, 17, 30)
    for drive in bus.drives:
        if drive.address in running:
            drive.start(0x1000)
            bus.zsw[drive.address] = 0xFB34
    bus.run(3_000_000)
    last = bus.now
    bus.run(500_000, refresh=False)
    for address in running:
        sent = [(at, stw[12]) for at, stw in bus.sent if at > last and stw[2] == address]
        offs = [at for at, stw in sent if stw == 0x7E]
        assert offs[0] - last <= DEAD_MAN_US + 5 * 22_000, address


def test_a_line_that_never_falls_silent_is_sent_on_all_the_same():
    """A babbling station: STOP is sent into it, for what it is worth."""
    bus = Bus()
    bus.run(300_000)
    receive = bus.receive

    def babble(buffer, at):
        bus.received_at = bus.now & MASK
        return receive(buffer, at) or 1

    bus.receive = babble
    sent = len(bus.sent)
    bus.drives[0].stop()
    bus.run(3_000_000)
    assert 3 <= len(bus.sent) - sent <= 8


def test_a_link_that_cannot_send_tries_again_at_once_also_where_it_never_falls_silent():
    bus = Bus()
    bus.run(200_000)

    def babble(buffer, at):
        bus.received_at = bus.now & MASK
        return 1

    bus.sending_us = lambda now: 1_000
    bus.run(50_000)
    bus.receive = babble
    sent = len(bus.sent)
    bus.run(240_000)
    assert len(bus.sent) - sent in (3, 4)  # each time what it takes to send, and 50 ms


def test_a_read_carries_no_value():
    bus = Bus()
    bus.pkw[1] = parameters({2000: (2, 0x4248, 0x1234)})
    bus.run(300_000)
    job = pkw.read(2000)
    for _ in range(2):  # the same job again: its words hold the first answer
        sent = len(bus.sent)
        bus.drives[0].ask(job)
        bus.run(300_000)
        assert job.high == 0x4248
        for _, characters in bus.sent[sent:]:
            assert characters[7:11] == bytes(4)


def test_a_drive_that_stops_of_its_own_accord_is_not_started_again():
    bus = Bus()
    bus.run(300_000)
    drive = bus.drives[0]
    for stopped in (0xFB31, 0xFB71, 0xFB78):  # somebody else's OFF, inhibit, fault
        bus.zsw[1] = 0xFB31
        drive.start(0x2000)
        bus.run(100_000)
        bus.zsw[1] = 0xFB34
        bus.run(100_000)
        assert bus.stws(1)[-1] == pzd.ON
        bus.zsw[1] = stopped
        bus.run(100_000)
        bus.zsw[1] = 0xFB31
        sent = len(bus.sent)
        bus.run(500_000)
        assert pzd.ON not in bus.stws(1, sent), hex(stopped)
        assert drive.stopped_by_engine()


def test_65536_starts_later_a_void_ticket_is_still_void():
    drive = Drive(1, MASK)
    drive.contact = True
    drive.start(0)
    drive.revoke()
    assert not drive.is_on()
    drive.fill(0)  # the telegram that says so
    for _ in range(0x10003):
        drive.start(0)
        assert drive.is_on() and drive.ticket != drive.void
    drive.ticket = 0xFFFF
    drive.start(0)
    drive.revoke()
    assert drive.void == 0  # it is passed over as well
    drive.fill(0)
    drive.ticket = 0xFFFD
    for _ in range(4):
        drive.start(0)
        assert drive.is_on()


# --- parameter jobs -----------------------------------------------------------------------------


def test_a_parameter_is_read_and_then_no_task_stands():
    bus = Bus()
    bus.pkw[1] = parameters({700: (1, 0, 5)})
    bus.run(300_000)
    job = pkw.read(700)
    bus.drives[0].ask(job)
    bus.run(200_000)
    assert job.state == pkw.DONE and job.integer_value() == 5
    assert bus.sent[-1][1][3:11] == bytes(8)


def test_the_task_is_repeated_until_the_fitting_reply_comes():
    bus = Bus()
    bus.run(300_000)
    replies = [bytes(8), b"\x12\xbd\x00\x00\x00\x00\x00\x07", bytes(8)]  # none, P0701, none

    def slow(request):
        if request[0] >> 4 == 1 and replies:
            return replies.pop(0)
        return parameters({700: (1, 0, 5)})(request)

    bus.pkw[1] = slow
    job = pkw.read(700)
    sent = len(bus.sent)
    bus.drives[0].ask(job)
    bus.run(300_000)
    assert job.state == pkw.DONE and job.integer_value() == 5 and not replies
    asked = [characters[3:5] for _, characters in bus.sent[sent:]].count(b"\x12\xbc")
    assert asked == 4


def test_two_tasks_of_one_parameter_have_no_task_between_them():
    """Or the old reply would be taken for the confirmation of the write (C-4.2.1.1)."""
    bus = Bus()
    bus.pkw[1] = parameters({700: (1, 0, 5)})
    bus.run(300_000)
    first, second = pkw.write_word(700, 5), pkw.write_word(700, 5)
    sent = len(bus.sent)
    bus.drives[0].ask(first)
    bus.drives[0].ask(second)
    bus.run(300_000)
    assert first.state == second.state == pkw.DONE
    tasks = [characters[3] >> 4 for _, characters in bus.sent[sent:]]
    first_write = tasks.index(2)
    assert tasks[first_write : first_write + 4] == [2, 0, 2, 0]


def test_tasks_of_different_parameters_follow_each_other_at_once():
    bus = Bus()
    bus.pkw[1] = parameters({700: (1, 0, 5), 1000: (1, 0, 5)})
    bus.run(300_000)
    sent = len(bus.sent)
    jobs = [pkw.read(700), pkw.read(1000), pkw.read(700)]
    for job in jobs:
        bus.drives[0].ask(job)
    bus.run(200_000)
    assert [job.state for job in jobs] == [pkw.DONE] * 3
    tasks = [characters[3] >> 4 for _, characters in bus.sent[sent:]]
    assert tasks[tasks.index(1) :][:3] == [1, 1, 1]


def test_a_task_that_is_never_answered_times_out():
    bus = Bus()
    bus.run(300_000)
    job, patient = pkw.read(700), pkw.write_word(700, 5, eeprom=True)
    bus.drives[0].ask(job)
    bus.run(1_900_000)
    assert job.state == pkw.PENDING
    bus.run(200_000)
    assert job.state == pkw.TIMED_OUT
    bus.drives[0].ask(patient)
    bus.run(4_800_000)
    assert patient.state == pkw.PENDING
    bus.run(500_000)
    assert patient.state == pkw.TIMED_OUT


def test_jobs_for_a_silent_drive_time_out_too():
    bus = Bus()
    bus.silent.add(1)
    jobs = [pkw.read(700), pkw.read(1000), pkw.write_word(700, 5)]
    for job in jobs:
        bus.drives[0].ask(job)
    bus.run(8_000_000)
    assert [job.state for job in jobs] == [pkw.TIMED_OUT] * 3


def test_a_refusal_is_a_result():
    bus = Bus()
    bus.pkw[1] = parameters({1082: (7, 0, 17), 700: (8, 0, 0)})
    bus.run(300_000)
    late, rights = pkw.write_float(1082, 40.0), pkw.write_word(700, 2)
    bus.drives[0].ask(late)
    bus.drives[0].ask(rights)
    bus.run(300_000)
    assert late.state == pkw.REFUSED and late.error == 17
    assert rights.state == pkw.REFUSED and rights.error == pkw.NO_CHANGE_RIGHTS


def test_jobs_of_two_drives_run_at_once():
    bus = Bus((1, 2))
    for address in (1, 2):
        bus.pkw[address] = parameters({2000: (2, 0x4248, 0)})
    bus.run(300_000)
    jobs = [pkw.read(2000), pkw.read(2000)]
    sent = len(bus.sent)
    for drive, job in zip(bus.drives, jobs):
        drive.ask(job)
    bus.run(120_000)
    assert [job.float_value() for job in jobs] == [50.0, 50.0]
    assert len(bus.sent) - sent <= 6


def test_no_more_jobs_are_taken_than_can_be_kept():
    bus = Bus()
    drive = bus.drives[0]
    jobs = [pkw.read(700) for _ in range(9)]
    for job in jobs[:8]:
        drive.ask(job)
    try:
        drive.ask(jobs[8])
    except RuntimeError as error:
        assert "8 jobs wait" in str(error)
        return
    raise AssertionError("a ninth job was taken")


def test_a_pending_job_is_not_taken_twice():
    bus = Bus()
    job = pkw.read(700)
    bus.drives[0].ask(job)
    try:
        bus.drives[0].ask(job)
    except RuntimeError:
        return
    raise AssertionError("taken twice")


def test_a_job_after_the_other_is_never_lost():
    """The queue goes round many times."""
    bus = Bus()
    bus.pkw[1] = parameters({700: (1, 0, 5), 1000: (1, 0, 6), 2000: (2, 0x4248, 0)})
    bus.run(300_000)
    for step in range(100):
        job = pkw.read((700, 1000, 2000)[step % 3])
        bus.drives[0].ask(job)
        while job.state == pkw.PENDING:
            bus.run(5_000)
        assert job.state == pkw.DONE, step


# --- trouble ------------------------------------------------------------------------------------


def test_after_an_exception_every_drive_is_off_and_the_bus_goes_on():
    bus = Bus()
    bus.run(300_000)
    bus.drives[0].start(0x1000)
    bus.run(100_000)
    bus.master.recover(bus.now)
    sent = len(bus.sent)
    bus.run(500_000)
    assert bus.master.failures == 1
    assert len(bus.sent) > sent + 10 and pzd.ON not in bus.stws(1, sent)


def test_after_an_exception_nothing_is_sent_into_the_reply_that_may_come():
    bus = Bus()
    bus.run(300_000)
    sent = len(bus.sent)
    while len(bus.sent) == sent:
        bus.run(500)
    bus.master.recover(bus.now)
    failed = bus.now
    bus.run(200_000)
    first_us = bus.sent[sent + 1][0]
    assert first_us - failed >= TIMING.reply_timeout_us + TIMING.telegram_us(12)


def test_an_exception_while_it_listens_does_not_make_it_talk():
    bus = Bus()
    bus.run(50_000)
    bus.master.recover(bus.now)
    bus.run(95_000)
    assert bus.sent == [] and bus.master.phase == LISTENING
    bus.run(20_000)
    assert bus.sent


def test_several_exceptions_in_a_row_and_nothing_is_known_of_the_drives():
    bus = Bus()
    bus.run(300_000)
    for _ in range(3):
        assert bus.drives[0].contact
        bus.master.recover(bus.now)
    assert not bus.drives[0].contact
    progress = bus.master.progress
    bus.run(500_000)
    assert bus.drives[0].contact and bus.master.progress > progress


def test_a_bad_reply_changes_nothing_in_the_image():
    bus = Bus()
    bus.run(300_000)
    drive = bus.drives[0]
    good, zsw = drive.counters[0], drive.zsw
    bus.zsw[1] = 0x1234
    answer = bus.answer

    def spoil(address, request):
        answer(address, request)
        bus.reply = bus.reply[:-1] + bytes((bus.reply[-1] ^ 1,))

    bus.answer = spoil
    bus.run(300_000)
    assert drive.zsw == zsw and drive.counters[0] <= good + 1
    assert drive.counters[3] > 5  # wrong BCC


# --- a pause ------------------------------------------------------------------------------------


def test_a_pause_begins_when_the_exchange_that_goes_on_is_over():
    bus = Bus()
    bus.run(300_000)
    sent = len(bus.sent)
    while len(bus.sent) == sent:
        bus.run(500)
    good = bus.drives[0].counters[0]
    bus.master.pause()
    assert not bus.master.paused
    bus.run(50_000)
    assert bus.master.paused and bus.drives[0].counters[0] == good + 1
    sent = len(bus.sent)
    progress = bus.master.progress
    bus.run(500_000)
    assert len(bus.sent) == sent and bus.master.progress != progress
    bus.master.resume()
    assert not bus.master.paused
    bus.run(10_000)
    assert len(bus.sent) == sent + 1
    bus.run(300_000)
    assert list(bus.drives[0].counters[1:]) == [0] * 6


def test_a_pause_that_nobody_ends_ends_after_a_second():
    bus = Bus()
    bus.run(300_000)
    bus.master.pause()
    while not bus.master.paused:
        bus.run(1)
    sent = len(bus.sent)
    bus.run(990_000)
    assert bus.master.paused and len(bus.sent) == sent
    bus.run(6_000)  # it looks every 5 ms
    assert not bus.master.paused and len(bus.sent) > sent
    bus.master.resume()  # too late, and no harm
    bus.run(100_000)
    assert not bus.master.paused


def test_a_stop_is_sent_in_a_pause_and_the_pause_goes_on():
    bus = Bus((1, 2))
    bus.run(300_000)
    bus.master.pause()
    bus.run(60_000)
    sent = len(bus.sent)
    bus.drives[1].stop()
    bus.run(60_000)
    assert bus.addresses(sent) == [2] and bus.stws(2, sent) == [pzd.OFF1]
    assert bus.master.paused


def test_a_command_given_before_a_pause_is_sent_before_it():
    bus = Bus((1, 2))
    bus.run(300_000)
    bus.drives[0].start(0x1000)
    bus.drives[1].stop()
    sent = len(bus.sent)
    bus.master.pause()
    while not bus.master.paused:
        bus.run(500)
    assert bus.addresses(sent)[-2:] == [2, 1] and bus.stws(1, sent)[-1] == pzd.ON


def test_a_panel_whose_loop_hangs_in_a_pause_is_stopped_all_the_same():
    bus = Bus()
    bus.run(300_000)
    bus.drives[0].start(0x1000)
    bus.run(100_000)
    bus.master.pause()
    last = bus.now
    bus.run(400_000, refresh=False)
    offs = [at for at, characters in bus.sent if at > last and characters[12] == 0x7E]
    assert offs and offs[0] - last <= DEAD_MAN_US + 22_000


def test_a_closed_bus_does_not_wait_for_the_end_of_a_pause():
    bus = Bus()
    bus.run(300_000)
    bus.master.pause()
    bus.run(50_000)
    bus.master.close()
    bus.run(50_000)
    assert bus.master.phase == CLOSED


def test_while_it_listens_a_pause_is_in_force_at_once():
    """Another master may talk for hours: what waits for the pause must not wait for that."""
    bus = Bus()
    bus.master.pause()
    for _ in range(50):
        bus.reply, bus.reply_at = b"\x02\x06\x01", bus.now
        bus.run(50_000)
        assert bus.master.paused
    bus.run(900_000)
    assert bus.master.paused and bus.sent == []
    bus.run(400_000)
    assert not bus.master.paused and bus.sent


# --- links that know more -----------------------------------------------------------------------


class ForeseeingBus(Bus):
    """Its link knows beforehand when the last stop bit will have left, as a PIO does."""

    foreseen = True

    def send(self, buffer, count):
        Bus.send(self, buffer, count)
        self.sent_at = self._sending_until & MASK


def test_a_link_that_foresees_the_end_of_sending_is_not_asked_again():
    bus = ForeseeingBus((1, 2))
    polls = [0]
    poll = bus.master.poll

    def counted(now):
        polls[0] += 1
        return poll(now)

    bus.master.poll = counted
    bus.run(300_000)
    polls[0], sent = 0, len(bus.sent)
    for drive in bus.drives:
        drive.start(0x1000)
    bus.run(1_000_000)
    instants = [at for at, _ in bus.sent[sent:]]
    gaps = [after - before for before, after in zip(instants, instants[1:])]
    exchange_us = TIMING.exchange_us(12, REPLY_DELAY_US)
    assert all(exchange_us <= gap <= exchange_us + 5 for gap in gaps), gaps[:5]
    for drive in bus.drives:
        assert drive.counters[0] > 20 and not any(drive.counters[1:]), drive.counters
        assert bus.stws(drive.address)[-1] == pzd.ON


def test_where_the_end_of_sending_is_foreseen_it_wants_to_be_entered_when_the_reply_is_late():
    """Also where the counter of the clock begins anew meanwhile. Before that nothing is over."""
    window_us = Receiver(TIMING, MASK).window_us
    for start_at in (0, MASK - 105_000, MASK - 115_000):
        bus = ForeseeingBus(start_at=start_at)
        poll, waits = bus.master.poll, []
        bus.master.poll = lambda now: waits.append(poll(now)) or waits[-1]
        bus.silent.add(1)
        bus.run_until(lambda: bus.sent)
        for silent in range(3):
            assert waits[-1] == TIMING.telegram_us(12) + window_us
            bus.now += waits[-1] - 1
            assert bus.master.poll(bus.now & MASK) == 1 and bus.drives[0].silent == silent
            bus.now += 1
            bus.master.poll(bus.now & MASK)
            assert bus.drives[0].silent == silent + 1 and len(bus.sent) == silent + 2


def test_a_silent_drive_costs_the_response_delay_on_such_a_link_too():
    bus = ForeseeingBus()
    bus.silent.add(1)
    bus.run(1_000_000)
    instants = [at for at, _ in bus.sent]
    for before, after in zip(instants, instants[1:]):
        waited_us = after - before - TIMING.telegram_us(12)
        assert 0 <= waited_us - TIMING.reply_timeout_us <= 3 * TIMING.character_us, waited_us
    assert bus.drives[0].counters[5] >= len(instants) - 1


def test_while_characters_come_in_nothing_is_sent_into_them():
    """A link that announces the end of what comes says so instead of handing it over."""
    bus = ForeseeingBus()
    bus.run(300_000)
    receive, sent = bus.receive, len(bus.sent)
    bus.receive = lambda buffer, at: -1
    began_us = bus.now
    bus.run(400_000)
    assert len(bus.sent) - sent <= 1  # the one that could go out before it began
    bus.run(300_000)
    assert len(bus.sent) - sent <= 3 and bus.now - began_us >= 700_000  # babble is talked over
    bus.receive = receive
    bus.run(300_000)
    assert len(bus.sent) - sent > 8


def test_what_is_announced_in_the_microsecond_in_which_a_rest_begins_is_taken_at_once():
    """Taken later, with what had come since, it seemed to end too early: the master sent while a
    drive talked."""
    bus = Bus()
    bus.silent.add(1)
    bus.run(300_000)
    while bus.master.phase != AWAITING:
        bus.run(1)
    bus.receive = lambda buffer, at: COMING
    while bus.master.phase != RESTING:
        now = bus.now
        bus.now += bus.master.poll(now & MASK)
    bus.now, sent = now, len(bus.sent)

    def announce(buffer, at):
        bus.receive = lambda buffer, at: 0
        bus.received_at = (now - 2 * TIMING.start_interval_us) & MASK
        return 27

    bus.receive = announce
    bus.master.poll(now & MASK)
    assert bus.receive is not announce and len(bus.sent) == sent + 1


def test_the_loop_is_undisturbed_while_a_telegram_goes_out_and_until_a_reply_may_be_over():
    bus = Bus()
    bus.run(300_000)
    while bus.master.phase != RESTING:
        bus.run(1)
    assert not bus.master.is_undisturbed(bus.now & MASK)
    while bus.master.phase != SENDING:
        bus.run(1)
    assert bus.master.is_undisturbed(bus.now & MASK)
    while bus.master.phase != AWAITING:
        bus.run(1)
    soonest_us = bus.sent_at + TIMING.start_interval_us + 16 * TIMING.character_us
    assert soonest_us <= bus.reply_at
    assert bus.master.is_undisturbed(bus.now & MASK)
    assert bus.master.is_undisturbed(soonest_us - 1 & MASK)
    for passed_us in (0, 1, 10_000):
        assert not bus.master.is_undisturbed(soonest_us + passed_us & MASK)


def test_where_the_end_of_sending_is_foreseen_the_loop_is_undisturbed_as_long():
    bus = ForeseeingBus()
    bus.run(300_000)
    sent = len(bus.sent)
    bus.run_until(lambda: len(bus.sent) > sent)
    soonest_us = bus.sent_at + TIMING.start_interval_us + 16 * TIMING.character_us
    for until, undisturbed in ((bus.now, True), (soonest_us - 1, True), (soonest_us, False)):
        assert bus.master.is_undisturbed(until) == undisturbed, until


def test_a_link_that_foresees_the_end_but_reports_no_reply_is_looked_at_all_the_same():
    class LookedAt(ForeseeingBus):
        interrupts = False

    bus = LookedAt()
    bus.run_until(lambda: bus.sent)
    assert bus.master.phase == SENDING
    bus.now += TIMING.telegram_us(12)
    assert bus.master.poll(bus.now) <= TIMING.start_interval_us + 16 * TIMING.character_us
    bus.run(30_000)
    assert bus.drives[0].contact


def test_a_list_that_is_emptied_ends_the_telegrams_and_nothing_else():
    bus = Bus()
    bus.run(300_000)
    bus.master.turns.remove(bus.drives[0])
    bus.run(100_000)
    sent = len(bus.sent)
    bus.run(500_000)
    assert len(bus.sent) == sent and bus.master.failures == 0
    bus.master.turns.add(1)
    bus.run(500_000)
    assert len(bus.sent) > sent + 5


def test_the_patience_with_a_bus_that_works_outlasts_its_longest_exchange():
    """Or, at 300 baud, the watchdog would not be fed while a drive is silent."""
    for baud in BAUD_RATES:
        line = Timing(baud)
        for layout, reply_count in ((Layout(4, 2), 12), (Layout(VARIABLE, 2), 252)):
            master = Master(Bus(), line, MASK)
            master.turns.add(1, layout)
            longest_us = line.telegram_us(layout.net_max) + line.reply_timeout_us
            longest_us += line.residual_us(reply_count)
            assert master.patience_us() > longest_us, (baud, layout)
            least_us = master.patience_us()
            master.turns.add(2)
            assert master.patience_us() >= least_us


def test_while_it_sends_it_wants_to_be_entered_at_the_end_or_when_the_reply_is_late():
    window_us = Receiver(TIMING, MASK).window_us
    left_us = TIMING.telegram_us(12)
    for interrupts in (True, False):
        bus = Bus()
        bus.interrupts = interrupts  # whether the link reports the reply
        bus.run(200_000)
        sent = len(bus.sent)
        while len(bus.sent) == sent:
            bus.run(1)
        begun = bus.sent[-1][0]
        for passed_us in (0, 1000, left_us - TIMING.character_us, left_us - 5):
            bus.now = begun + passed_us
            due_us = bus.master.poll(bus.now)
            rest_us = left_us - passed_us
            if interrupts:
                assert due_us == rest_us + window_us
            else:
                assert due_us == max(rest_us, TIMING.character_us)
        assert bus.master.phase == SENDING
        bus.run(60_000)
        assert bus.drives[0].silent == 0 and bus.drives[0].contact


# --- to the microsecond -------------------------------------------------------------------------


def at_rest(bus):
    """An exchange is over, and the start interval has begun."""
    bus.run_until(lambda: bus.master.phase == AWAITING)
    bus.run_until(lambda: bus.master.phase == RESTING)
    return bus.now


def test_it_listens_for_100_ms_to_the_microsecond():
    """From its first look on, or from the last character that it hears."""
    bus = Bus()
    bus.master.refresh(7)
    assert bus.master.poll(7) == 100_000
    assert bus.master.poll(40_007) == 60_000
    bus.reply, bus.reply_at, bus.now = b"\x00", 50_000, 60_000
    assert bus.master.poll(60_000) == 90_000
    assert bus.master.poll(149_999) == 1 and bus.master.phase == LISTENING
    bus.now = 150_000
    bus.master.poll(150_000)
    assert [at for at, _ in bus.sent] == [150_000]


def test_the_loop_counts_as_dead_after_300_ms_to_the_microsecond():
    """Whether the engine is entered in between or only the loop comes back."""
    for enter in (Master.poll, Master.refresh):
        bus = Bus()
        bus.run(300_000)
        master, drive = bus.master, bus.drives[0]
        for trips in (0, 1, 2):
            now = bus.now
            master.refresh(now)
            drive.start(0x1000)
            assert drive.is_on() and master.dead_man_trips == trips
            enter(master, now + 300_000)
            assert drive.is_on() and master.dead_man_trips == trips
            master.refresh(now)
            enter(master, now + 300_001)
            assert not drive.is_on() and master.dead_man_trips == trips + 1
            bus.now = now + 300_001
            bus.run(50_000)


def test_an_instant_that_was_read_just_before_the_loop_came_round_stops_nobody():
    """An interrupt may have read the clock, and then another one the loop's part."""
    for start_at in (0, MASK - 300_000):  # also where the counter of the clock begins anew
        bus = Bus(start_at=start_at)
        bus.run(300_000)
        master, drive = bus.master, bus.drives[0]
        drive.start(0x1000)
        for early_us in (1, 5, 100_000):
            master.refresh(bus.now + early_us & MASK)
            master.poll(bus.now & MASK)
            assert drive.is_on() and master.dead_man_trips == 0, early_us


def test_while_the_loop_is_dead_that_is_counted_once_and_nothing_can_be_started():
    bus = Bus()
    bus.run(300_000)
    for later_us in (300_001, 400_000, 500_000):
        bus.drives[0].start(0x1000)
        bus.master.poll(bus.now + later_us)
        assert not bus.drives[0].is_on() and bus.master.dead_man_trips == 1


def test_its_counters_have_16_bits():
    for before, after in ((0x7FFF, 0x8000), (0xFFFF, 0)):
        bus = Bus()
        master = bus.master
        master.foreign = master.progress = before
        bus.reply = b"\x00"
        master.poll(0)
        assert master.foreign == master.progress == after
        bus.run(300_000)
        for _ in range(2):
            master.progress = before
            at_rest(bus)
            assert master.progress == after
        master.failures = master.dead_man_trips = before
        master.recover(bus.now)
        bus.run(400_000, refresh=False)
        assert master.failures == master.dead_man_trips == after


def test_what_is_only_announced_while_it_listens_is_no_other_master():
    """It may be a spike; but the 100 ms begin anew. What then comes is one."""
    bus = Bus()
    receive, bus.receive = bus.receive, lambda buffer, at: COMING
    for now in (7, 50_000, 120_000):
        assert bus.master.poll(now) == 100_000
    assert bus.master.foreign == 0
    bus.receive, bus.reply = receive, b"\x02\x0e\x01"
    bus.now = bus.reply_at = 120_000
    bus.master.poll(120_000)
    assert bus.master.foreign == 1
    assert bus.master.is_line_in_use() and not bus.master.is_line_shared()


def test_where_nobody_was_asked_so_far_each_telegram_is_another_masters():
    bus = Bus(())
    bus.run(200_000)
    for foreign in (1, 2):
        bus.reply, bus.reply_at = b"\x02\x0e\x01", bus.now
        bus.master.poll(bus.now)
        assert bus.master.foreign == foreign and bus.master.is_line_shared()


def test_in_the_rest_a_reply_of_the_drive_that_was_asked_is_no_other_master():
    """Its ADR says so, whatever stands behind it."""
    bus = Bus()
    bus.run(300_000)
    for characters, foreign in (
        (b"\x02\x0e\x01\x00", 0),
        (b"\x02\x0e\x02\x01", 1),
        (b"\x02\x0e\x01\x02", 1),
        (b"\x02\x0e\x21\x01", 2),
        (b"\x02\x0e\x00", 3),
    ):
        at_rest(bus)
        bus.reply, bus.reply_at = characters, bus.now
        assert bus.master.poll(bus.now) == TIMING.start_interval_us  # the silence begins anew
        assert bus.master.foreign == foreign, characters
        assert bus.master.is_line_shared() == (foreign > 0)
        bus.run(30_000)


def test_a_line_that_is_never_silent_is_sent_on_after_half_a_second_to_the_microsecond():
    bus = Bus()
    bus.run(300_000)
    rested_at = at_rest(bus)
    sent = len(bus.sent)

    def babble(buffer, at):
        bus.received_at = bus.now & MASK
        return 1

    bus.receive = babble
    for passed_us in (100, 1_000, 300_000, 499_999):
        bus.now = rested_at + passed_us
        bus.master.refresh(bus.now)
        assert bus.master.poll(bus.now) == TIMING.start_interval_us
    assert len(bus.sent) == sent
    bus.now = rested_at + 500_000
    bus.master.poll(bus.now)
    assert len(bus.sent) == sent + 1


def test_the_half_second_of_a_line_that_is_never_silent_begins_behind_a_pause_or_a_wait():
    """A character in the last moment of it has its silence after it, as always."""

    def pause(bus):
        bus.master.pause()
        bus.run(700_000)
        assert bus.master.paused
        bus.master.resume()

    def wait_for_the_next_round(bus):
        bus.master.turns.cycle_us = 900_000
        bus.run(700_000)
        bus.master.turns.cycle_us = 0

    for rest in (pause, wait_for_the_next_round):
        bus = Bus()
        bus.run(300_000)
        rest(bus)
        sent = len(bus.sent)
        bus.reply, bus.reply_at = b"\x00", bus.now
        assert bus.master.poll(bus.now) == TIMING.start_interval_us
        assert len(bus.sent) == sent
        bus.now += TIMING.start_interval_us
        bus.master.poll(bus.now)
        assert len(bus.sent) == sent + 1


def test_a_reply_that_ended_after_the_clock_was_read_has_its_silence_after_it():
    bus = Bus()
    bus.run(300_000)
    bus.run_until(lambda: bus.master.phase == AWAITING)
    receive = bus.receive

    def receive_later(buffer, at):
        count = receive(buffer, at)
        bus.received_at = bus.now + 3
        return count

    bus.receive, bus.now, sent = receive_later, bus.reply_at, len(bus.sent)
    assert bus.master.poll(bus.now) == TIMING.start_interval_us
    assert bus.drives[0].silent == 0 and len(bus.sent) == sent


def test_a_telegram_is_given_up_50_ms_after_it_should_have_left_to_the_microsecond():
    bus = Bus()
    bus.run(300_000)
    sent = len(bus.sent)
    bus.run_until(lambda: len(bus.sent) > sent)
    bus.sending_us = lambda now: 1
    begun, drive = bus.now, bus.drives[0]
    last_us = 16 * TIMING.character_us + 50_000
    progress = bus.master.progress
    for passed_us in (9_000, last_us):
        bus.now = begun + passed_us
        bus.master.poll(bus.now)
        assert bus.master.phase == SENDING and len(bus.sent) == sent + 1 and drive.silent == 0
    bus.now += 1
    bus.master.poll(bus.now)
    assert drive.silent == 1 and drive.counters[5] == 1 and bus.master.progress == progress
    assert bus.master.phase == SENDING and len(bus.sent) == sent + 2  # it tries again at once


def test_a_pause_lasts_a_second_to_the_microsecond_and_is_looked_at_every_5_ms():
    bus = Bus()
    bus.run(300_000)
    bus.master.pause()
    bus.run_until(lambda: bus.master.paused)
    began, sent = bus.now, len(bus.sent)
    for passed_us in (0, 5_000, 200_000, 600_000, 999_999):
        bus.now = began + passed_us
        bus.master.refresh(bus.now)
        assert bus.master.poll(bus.now) == 5_000 and bus.master.paused
    assert len(bus.sent) == sent
    bus.now = began + 1_000_000
    bus.master.poll(bus.now)
    assert not bus.master.paused and len(bus.sent) == sent + 1


def test_after_an_exception_it_waits_for_the_reply_that_may_come_and_no_longer():
    """Behind a telegram, or in the rest after it, as long as a reply may take; before the first
    telegram two characters."""
    reply_us = TIMING.reply_timeout_us + 32 * TIMING.character_us
    for phase in (SENDING, AWAITING, RESTING):
        bus = Bus()
        bus.run(300_000)
        bus.run_until(lambda phase=phase: bus.master.phase == phase)
        bus.receive = lambda buffer, at: 0
        began, sent = bus.now, len(bus.sent)
        bus.master.recover(began)
        assert bus.master.phase == RESTING
        assert bus.master.poll(began) == reply_us
        bus.now = began + reply_us - 1
        assert bus.master.poll(bus.now) == 1 and len(bus.sent) == sent
        bus.now += 1
        bus.master.poll(bus.now)
        assert len(bus.sent) == sent + 1


def test_after_an_exception_before_the_first_telegram_it_waits_for_two_characters():
    bus = Bus(())
    bus.run(200_000)
    bus.master.recover(bus.now)
    assert bus.master.phase == RESTING
    assert bus.master.poll(bus.now) == TIMING.start_interval_us


def test_exceptions_count_in_a_row_until_an_exchange_is_over():
    bus = Bus()
    bus.run(300_000)
    for _ in range(5):
        for _ in range(2):
            bus.master.recover(bus.now)
        assert bus.drives[0].contact
        at_rest(bus)
    for contact in (True, True, False):
        bus.master.recover(bus.now)
        assert bus.drives[0].contact == contact


def test_a_command_that_the_engine_had_taken_up_when_it_failed_is_sent_all_the_same():
    bus = Bus((1, 2, 3, 4))
    bus.run(600_000)
    bus.run_until(lambda: bus.addresses()[-1] == 1)
    attention = bus.master.turns.attention
    bus.drives[3].stop()
    attention[4] = attention[ANY] = 0
    bus.master.recover(bus.now)
    sent = len(bus.sent)
    bus.run_until(lambda: len(bus.sent) > sent)
    assert bus.addresses(sent) == [4]


def test_another_master_is_shared_with_for_1000_exchanges_after_its_last_telegram():
    bus = Bus()
    bus.run(300_000)
    master = bus.master
    for begins in (7, 0xFF00):  # the counter of exchanges goes round
        at_rest(bus)
        master.turns.exchanges = begins
        bus.reply, bus.reply_at = b"\x02\x0e\x07", bus.now
        master.poll(bus.now)
        assert master.is_line_shared()
        for passed, shared in ((1, True), (999, True), (1_000, False)):
            master.turns.exchanges = (begins + passed) & 0xFFFF
            master.deadlines.looked_at = (bus.now - 4_000) & MASK
            master.refresh(bus.now)
            assert master.is_line_shared() == shared, (begins, passed)


def test_the_drives_are_looked_after_every_4_ms_if_the_loop_has_time():
    bus = Bus()
    bus.run(300_000)
    master, since = bus.master, bus.now
    master.deadlines.looked_at = since
    for passed_us, looks, looked_at in (
        (3_999, True, since),
        (4_000, False, since),
        (4_000, True, since + 4_000),
        (7_999, True, since + 4_000),
        (8_100, True, since + 8_100),
    ):
        master.refresh(since + passed_us, looks)
        assert master.deadlines.looked_at == looked_at, (passed_us, looks)
    master.refresh(since + 12_100)  # without a word about it
    assert master.deadlines.looked_at == since + 12_100


def test_a_bus_that_is_off_or_closed_wants_to_be_entered_every_300_ms():
    for leave, phase in ((Master.off, OFF), (Master.close, CLOSED)):
        for listened_us in (50_000, 300_000):
            bus = Bus()
            bus.run(listened_us)
            leave(bus.master)
            waits = []
            for _ in range(50):
                waits.append(bus.master.poll(bus.now))
                if bus.master.phase == phase:
                    break
                bus.now += min(waits[-1], 1_000)
            bus.run(300_000)
            assert bus.master.phase == phase and bus.master.poll(bus.now) == 300_000


def test_how_long_nothing_may_move_is_half_a_second_and_50_ms_and_an_exchange():
    bus = Bus()
    assert bus.master.patience_us() == 550_000 + bus.master.turns.longest_exchange_us


def test_where_nobody_is_listed_it_looks_for_somebody_every_5_ms():
    bus = Bus(())
    bus.run(200_000)
    for _ in range(3):
        progress = bus.master.progress
        bus.master.refresh(bus.now)
        assert bus.master.poll(bus.now) == 5_000
        assert bus.master.progress == progress + 1
        bus.now += 5_000


def test_whoever_is_listed_after_a_wait_of_any_length_is_asked_in_the_next_step():
    """Also where the clock has gone half of its way round, or begun anew, meanwhile."""
    for start_at in (0, MASK // 4, MASK * 3 // 4, MASK - 150_000):
        for steps in (1, 2, 7):
            bus = Bus((), start_at)
            bus.run(200_000)
            for _ in range(steps):
                bus.now += MASK // 10
                bus.master.refresh(bus.now & MASK)
                assert bus.master.poll(bus.now & MASK) == 5_000
            bus.master.turns.add(1)
            bus.now += 5_000
            bus.master.poll(bus.now & MASK)
            assert bus.addresses() == [1], (start_at, steps)


def test_the_wait_for_the_next_round_is_as_long_as_its_cycle_time_leaves():
    """At most 5 ms at a time, so that a command is noticed; to the microsecond at its end."""
    bus = Bus()
    bus.run(300_000)
    bus.master.turns.cycle_us = 50_000
    bus.run(200_000)
    sent = len(bus.sent)
    bus.run_until(lambda: len(bus.sent) > sent)
    begun = bus.now
    bus.run_until(lambda: bus.master.phase == RESTING)
    bus.now = begun + 42_000
    waits = []
    while len(bus.sent) == sent + 1:
        bus.master.refresh(bus.now)
        wait_us = bus.master.poll(bus.now)
        if len(bus.sent) == sent + 1:
            waits.append(wait_us)
            bus.now += wait_us
    assert waits == [5_000, 3_000] and bus.now == begun + 50_000


def test_the_next_telegram_follows_at_once_if_the_reply_is_reported_after_the_start_interval():
    for late_us in (TIMING.start_interval_us - 1, TIMING.start_interval_us, 100_000):
        bus = Bus()
        bus.run(300_000)
        bus.run_until(lambda: bus.master.phase == AWAITING)
        bus.now, sent = bus.reply_at + late_us, len(bus.sent)
        bus.master.refresh(bus.now)
        wait_us = bus.master.poll(bus.now)
        if late_us < TIMING.start_interval_us:
            assert wait_us == 1 and bus.master.phase == RESTING and len(bus.sent) == sent
        else:
            assert bus.master.phase == SENDING and len(bus.sent) == sent + 1


def test_a_silence_is_charged_with_its_exchange_where_there_is_no_contact_or_no_drive():
    """The request and the silence before it, and how long the reply was waited for."""
    bus = Bus((1, 2))
    bus.silent.add(2)
    bus.run(300_000)
    charges = []
    bus.master.deadlines.silence.charge = lambda who, spent_us: charges.append((who, spent_us))
    whole_us = TIMING.start_interval_us + 16 * TIMING.character_us
    whole_us += Receiver(TIMING, MASK).window_us
    bus.run_until(lambda: charges)
    assert charges == [(bus.drives[1], whole_us)]
    charges.clear()
    bus.silent.add(1)
    bus.run_until(lambda: bus.drives[0].silent)
    probe = Mirror(9, bytes(12))
    bus.master.turns.post(probe)
    bus.run_until(lambda: probe.state != pkw.PENDING)
    assert (probe, whole_us) in charges  # and not the one that is in contact
    assert [who for who, _ in charges].count(bus.drives[0]) == 0 and bus.drives[0].contact


def test_contact_is_lost_after_a_second_unless_it_is_told_otherwise():
    assert Master(Bus(), TIMING, MASK).turns.lost_us == 1_000_000
    assert Master(Bus(), TIMING, MASK, 2_500_000).turns.lost_us == 2_500_000


def test_what_the_loop_starts_when_it_has_come_back_is_not_taken_back_by_its_refresh():
    bus = Bus()
    bus.run(400_000, refresh=False)
    bus.drives[0].start(0x1000)
    bus.master.refresh(bus.now)
    assert bus.drives[0].is_on() and bus.master.dead_man_trips == 0
    bus.run(50_000)
    assert bus.stws(1)[-1] == pzd.ON


def test_an_exception_makes_no_miss_of_what_is_over_or_of_a_drive_in_the_list():
    for phase in (SENDING, AWAITING, RESTING):
        bus = Bus()
        bus.run(300_000)
        bus.run_until(lambda phase=phase: bus.master.phase == phase)
        counters = list(bus.drives[0].counters)
        bus.master.recover(bus.now)
        assert list(bus.drives[0].counters) == counters and bus.drives[0].silent == 0

    def echo(address, request):
        bus.reply = request
        bus.reply_at = bus.now + 2 * TIMING.telegram_us(12) + REPLY_DELAY_US

    bus.zsw[0x41] = 0  # somebody answers there
    bus.answer = echo
    probe = Mirror(1, bytes(12))
    bus.master.turns.post(probe)
    bus.run_until(lambda: probe.state != pkw.PENDING)
    assert probe.state == pkw.DONE and bus.master.phase == RESTING
    bus.master.recover(bus.now)
    assert probe.state == pkw.DONE


def test_a_bus_that_is_closed_while_it_listens_tells_every_drive_unless_the_line_is_anothers():
    for foreign, gives_up, sent in ((0, False, [1, 2]), (1, False, []), (0, True, [])):
        bus = Bus((1, 2))
        if foreign:
            bus.reply = b"\x02\x06\x01"
        bus.run(50_000)
        bus.master.close()
        if gives_up:
            bus.master.give_up()
        assert bus.master.phase == LISTENING
        bus.run(500_000)
        assert bus.master.phase == CLOSED and bus.master.foreign == foreign
        assert bus.addresses()[:2] == sent and set(bus.stws(1)) <= {pzd.OFF1}
