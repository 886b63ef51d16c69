# SPDX-License-Identifier: MIT
"""31 simulated drives of mixed families and layouts on one line, all controlled and read."""

from boards.sim.line.intruder import Intruder
from fleet_bench import Fleet
from round_bench import framed
from uss import pkw
from uss.finding.scan import EVERY_NET_COUNT, Scan

# A parameter that can be read in three words, by family; and one that needs four.
NUMBERS = {"MICROMASTER 3": (2, None), "SINAMICS G120": (2021, 1120)}


def numbers(fleet, address):
    return NUMBERS.get(fleet.motors[address].family.NAME, (2011, 1120))


def contact(fleet):
    fleet.run_until(lambda: all([drive.contact for drive in fleet.master.turns.drives]))


def test_they_are_all_different():
    fleet = Fleet()
    layouts = {motor.layout for motor in fleet.motors.values()}
    names = {motor.family.NAME for motor in fleet.motors.values()}
    delays = {motor.reply_delay_us for motor in fleet.motors.values()}
    assert len(fleet.motors) == 31 and len(layouts) >= 9 and len(names) >= 7 and len(delays) == 31


def test_all_run_and_all_are_read_at_once():
    fleet = Fleet()
    contact(fleet)
    fleet.start_all()
    jobs = {}
    done = dict.fromkeys(fleet.drives, 0)
    for _ in range(4_000):
        for address, drive in fleet.drives.items():
            job = jobs.get(address)
            if not drive.layout.pkw_words or job and job.state == pkw.PENDING:
                continue
            if job:
                assert job.state == pkw.DONE, (address, job)
                done[address] += 1
            short, long = numbers(fleet, address)
            wide = long and drive.layout.pkw_words > 3 and done[address] & 1
            jobs[address] = pkw.read(long if wide else short)
            drive.ask(jobs[address])
        fleet.run(2)
    for address, drive in fleet.drives.items():
        assert fleet.motors[address].state == "running", address
        assert drive.zsw & 4 and drive.hiw == 0x2000, (address, drive)
        assert not any(drive.counters[1:]), (address, drive.counters)
        if drive.layout.pkw_words:
            assert done[address] >= 4, (address, done[address])
    fleet.master.stop_all()
    fleet.run(15_000)
    assert all([motor.state != "running" for motor in fleet.motors.values()])
    fleet.check()


def test_a_round_takes_what_the_times_predict():
    """Within 3 %, from the layouts and the delays of the drives alone, at 19200."""
    fleet = Fleet()
    contact(fleet)
    fleet.start_all()
    predicted_us, measured_us = fleet.predicted_us(), fleet.cycle_us(20)
    print("predicted %d us, measured %d us" % (predicted_us, measured_us))
    assert abs(measured_us - predicted_us) < 0.03 * predicted_us
    fleet.check()


def test_a_round_takes_what_the_times_predict_at_other_rates():
    for baud, rounds in ((9600, 5), (38400, 20), (115200, 20)):
        fleet = Fleet(baud=baud)
        contact(fleet)
        predicted_us, measured_us = fleet.predicted_us(), fleet.cycle_us(rounds)
        print("%d baud: predicted %d us, measured %d us" % (baud, predicted_us, measured_us))
        assert abs(measured_us - predicted_us) < 0.03 * predicted_us
        fleet.check()


def rates(fleet, ms):
    """Good replies of each drive in the next `ms`."""
    before = {address: drive.counters[0] for address, drive in fleet.drives.items()}
    fleet.run(ms)
    return {
        address: drive.counters[0] - before[address] for address, drive in fleet.drives.items()
    }


def test_an_idle_drive_unplugged_costs_the_others_less_than_5_percent():
    fleet = Fleet()
    contact(fleet)
    fleet.start_all(but=(7,))
    before = rates(fleet, 60_000)
    fleet.motors[7].unplug()
    fleet.run(5_000)
    after = rates(fleet, 60_000)
    for address in fleet.drives:
        if address != 7:
            assert after[address] > 0.95 * before[address], (address, before, after)
    assert after[7] == 0 and not fleet.drives[7].contact
    fleet.check()


def test_a_running_drive_unplugged_is_asked_in_every_round():
    fleet = Fleet()
    contact(fleet)
    fleet.start_all()
    fleet.motors[7].unplug()
    fleet.run(5_000)
    for _ in range(5):
        since = fleet.wire.log.count
        fleet.run(8_000)
        asked = fleet.requests(since, 7)
        assert asked >= fleet.requests(since, 8) - 1 >= 5, asked
    assert fleet.drives[7].was_running and fleet.motors[7].state == "running"
    fleet.check()


def test_plugged_back_in_it_is_asked_within_2_seconds():
    fleet = Fleet()
    contact(fleet)
    fleet.start_all(but=(7, 12))
    for step in range(6):
        address = (7, 12)[step & 1]
        fleet.motors[address].unplug()
        fleet.run(6_000 + 377 * step)
        assert not fleet.drives[address].contact
        fleet.motors[address].plug()
        began = fleet.clock.now_us
        fleet.run_until(lambda: fleet.drives[address].contact)
        assert fleet.clock.now_us - began <= 2_000_000
    fleet.check()


def test_all_of_it_without_receive_interrupts():
    fleet = Fleet(interrupts=False)
    contact(fleet)
    fleet.start_all()
    fleet.run(5_000)
    for address, drive in fleet.drives.items():
        assert not any(drive.counters[1:]), (address, drive.counters)
    fleet.check()


def test_all_of_it_on_a_line_with_an_echo():
    fleet = Fleet()
    fleet.wire.echo = True
    contact(fleet)
    fleet.start_all()
    fleet.run(5_000)
    for address, drive in fleet.drives.items():
        assert not any(drive.counters[1:]), (address, drive.counters)
    predicted_us, measured_us = fleet.predicted_us(), fleet.cycle_us(10)
    assert abs(measured_us - predicted_us) < 0.03 * predicted_us
    fleet.check()


def test_a_scan_finds_them_all():
    """None of them is known to the master, and none is moved by it. Each is told OFF1."""
    fleet = Fleet(baud=115200, listed=False)
    scan = Scan(fleet.master, fleet.clock.ticks_mask, net_counts=EVERY_NET_COUNT)
    promised_ms = scan.longest_ms
    fleet.run_until(lambda: scan.step(fleet.clock.ticks_us()), 3 * promised_ms)
    assert sorted(scan.found) == sorted(fleet.motors)
    for address, motor in fleet.motors.items():
        pkw_words, pzd_words = motor.layout
        if pkw_words == 127:
            assert address in scan.variable
        else:
            assert scan.found[address] == 2 * (pkw_words + pzd_words), (address, scan.found)
            assert address not in scan.variable
        assert motor.state == "inhibited" or "ready" in motor.state, motor.report()
        assert "stw=047E" in motor.report() and "starts=0" in motor.report(), motor.report()
        node = scan.nodes[address]
        assert node.layout.fits(2 * (min(pkw_words, 3 if pkw_words == 127 else 4) + pzd_words))
        if pkw_words:  # the others tell nothing of themselves
            assert (node.layout.pkw_words, node.layout.pzd_words) == motor.layout
    assert not scan.unclear
    fleet.check()


def test_another_master_is_heard_and_starts_nothing():
    """Now and then it talks into an exchange; most of what it says is heard in the pauses.

    What it garbles may look like a telegram, and like a drive that has stopped of its own accord:
    that one is not started again.
    """
    fleet = Fleet(lost_us=5_000_000)
    contact(fleet)
    for drive in fleet.drives.values():  # or they would be asked in the pauses
        fleet.master.deadlines.supervise(drive, 60_000)
    fleet.start_all()
    fleet.master.turns.cycle_us = 1_500_000
    intruder = Intruder(fleet.clock, fleet.wire, framed(31, bytes(12)), 397_000)
    intruder.begin()
    fleet.run(20_000)
    intruder.end()
    assert fleet.master.foreign > intruder.sent // 5, (fleet.master.foreign, intruder.sent)
    for address, drive in fleet.drives.items():
        running = fleet.motors[address].state == "running"
        assert drive.contact and running == drive.is_on(), (address, drive)
        assert fleet.motors[address].starts == 1
    fleet.master.turns.cycle_us = 0
    fleet.run(2_000)
    assert fleet.master.failures == 0
    assert not [drive for drive in fleet.drives.values() if drive.status]
