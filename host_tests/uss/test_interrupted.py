# SPDX-License-Identifier: MIT
"""The engine may come in between any two lines of what the loop does: nothing is lost by it.

On a chip it is an interrupt. Here each call of the loop is made again and again, and between two
of its lines, each time two others, the engine works for a while.
"""

from interruption_bench import interrupted
from round_bench import Bench, Node
from uss import pkw, pzd
from uss.layout import Layout
from uss.outside import Mirror, stop_all

INTERPRETERS = "cpython"


def three():
    """Drive 2 runs."""
    bench = Bench([Node(1), Node(2), Node(3)])
    bench.contact()
    bench.drives[2].start(0x1000)
    bench.run(150_000)
    return bench


def standing():
    bench = Bench([Node(1), Node(2), Node(3)])
    bench.contact()
    return bench


# --- commands -----------------------------------------------------------------------------------


def test_a_stop():
    for bench, _ in interrupted(three, lambda bench: bench.drives[2].stop()):
        returned = len(bench.sent)
        bench.run(200_000)
        assert pzd.ON not in bench.stws(2, returned)
        assert bench.stws(2)[-1] == pzd.OFF1 and bench.nodes[2].zsw == 0xFB31


def test_a_stop_is_in_the_next_telegram():
    for bench, sent in interrupted(three, lambda bench: bench.drives[2].stop()):
        returned = len(bench.sent)
        told = pzd.OFF1 in bench.stws(2, sent)
        bench.run(60_000)
        assert told or bench.sent[returned].address == 2


def test_a_start():
    for bench, sent in interrupted(standing, lambda bench: bench.drives[1].start(0x1234)):
        bench.run(100_000)
        assert bench.drives[1].is_on() and bench.nodes[1].zsw == 0xFB34
        assert set(bench.stws(1, sent)) <= {pzd.OFF1, pzd.ON}
        assert bench.sent[-1].address != 1 or bench.sent[-1].characters[13:15] == b"\x12\x34"


def test_a_start_the_other_way_round():
    def turn(bench):
        bench.drives[2].start(0x2222, pzd.ON_REVERSE)

    for bench, sent in interrupted(three, turn):
        bench.run(100_000)
        assert bench.stws(2)[-1] == pzd.ON_REVERSE
        assert set(bench.stws(2, sent)) <= {pzd.ON, pzd.OFF1, pzd.ON_REVERSE}


def test_a_stop_and_a_start_behind_it():
    def both(bench):
        bench.drives[2].stop()
        bench.drives[2].start(0x1000)

    for bench, sent in interrupted(three, both):
        bench.run(200_000)
        stws = bench.stws(2, sent)
        assert pzd.OFF1 in stws and stws[-1] == pzd.ON


def test_an_acknowledgement():
    for bench, sent in interrupted(standing, lambda bench: bench.drives[3].acknowledge()):
        bench.run(200_000)
        stws = bench.stws(3, sent)
        assert pzd.OFF1 | pzd.STW_ACKNOWLEDGE in stws and stws[-1] == pzd.OFF1


def test_a_drive_that_is_lost_meanwhile_does_not_start_later():
    """Contact is lost, and made again, in the middle of a start."""

    def start(bench):
        bench.drives[2].start(0x1000)

    def prepare():
        bench = three()
        bench.drives[2].stop()
        bench.run(100_000)
        bench.nodes[2].plugged = False
        bench.run(900_000)
        return bench

    for bench, _ in interrupted(prepare, start):
        bench.run(2_000_000)
        assert not bench.drives[2].contact
        returned = len(bench.sent)
        bench.nodes[2].plugged = True
        bench.run(3_000_000)
        assert bench.drives[2].contact and pzd.ON not in bench.stws(2, returned)


# --- parameters and telegrams outside the list --------------------------------------------------


def test_a_job():
    jobs = []

    def ask(bench):
        jobs[:] = [pkw.read(700), pkw.read(701)]
        for job in jobs:
            bench.drives[1].ask(job)
        return jobs

    for bench, _ in interrupted(standing, ask):
        bench.run(5_000_000)
        assert [job.state for job in jobs] == [pkw.TIMED_OUT] * 2  # these nodes answer none
        assert bench.sent[-1].characters[3:11] == bytes(8)


def test_a_mirror_telegram():
    telegrams = []

    def post(bench):
        telegrams[:] = [Mirror(1), Mirror(3)]
        for telegram in telegrams:
            bench.master.turns.post(telegram)
        return telegrams

    for bench, _ in interrupted(three, post):
        bench.run(300_000)
        assert [telegram.state for telegram in telegrams] == [pkw.DONE] * 2
        assert bench.nodes[1].mirrored == bench.nodes[3].mirrored == 1


def test_a_broadcast_stop():
    for bench, _ in interrupted(three, lambda bench: stop_all(bench.master)):
        bench.run(300_000)
        assert bench.addresses().count(0x20) == 1
        assert bench.stws(2)[-1] == pzd.OFF1 and bench.nodes[2].zsw == 0xFB31


# --- the list -----------------------------------------------------------------------------------


def others_are_well(bench, *addresses):
    for address in addresses:
        drive = bench.drives[address]
        assert drive.contact and not any(drive.counters[1:]), (address, drive.counters)
    assert bench.nodes[2].zsw == 0xFB34  # and it runs on


def test_the_list_arranged_anew():
    def arrange(bench):
        one, two, three = bench.master.turns.drives
        bench.master.turns.arrange([three, one, one, two])

    for bench, _ in interrupted(three, arrange):
        returned = len(bench.sent)
        bench.run(400_000)
        addresses = bench.addresses(returned)
        place = addresses.index(3)
        assert addresses[place : place + 8] == [3, 1, 1, 2] * 2
        others_are_well(bench, 1, 2, 3)


def test_a_drive_taken_away():
    for bench, _ in interrupted(three, lambda bench: bench.master.turns.remove(bench.drives[3])):
        returned = len(bench.sent)
        bench.run(200_000)
        assert 3 not in bench.addresses(returned)
        others_are_well(bench, 1, 2)


def test_a_drive_added():
    def prepare():
        bench = three()
        bench.nodes[7] = Node(7, 3, 2)
        return bench

    for bench, _ in interrupted(prepare, lambda bench: bench.master.turns.add(7, Layout(3, 2))):
        bench.run(300_000)
        assert bench.master.turns.drives[-1].contact
        others_are_well(bench, 1, 2, 3)


def test_a_drive_that_gets_another_address():
    def prepare():
        bench = three()
        bench.nodes[9] = bench.nodes[3]
        return bench

    def move(bench):
        bench.nodes[3].address = 9
        bench.master.turns.readdress(bench.drives[3], 9)

    for bench, _ in interrupted(prepare, move):
        returned = len(bench.sent)
        bench.run(1_000_000)
        assert bench.drives[3].contact and 3 not in bench.addresses(returned)
        others_are_well(bench, 1, 2)
        bench.drives[3].stop()
        sent = len(bench.sent)
        bench.run(60_000)
        assert bench.sent[sent].address == 9


def test_off_and_on():
    def both(bench):
        bench.master.off()
        bench.master.on()

    for bench, _ in interrupted(three, both):
        bench.run(1_500_000)
        assert all([drive.contact for drive in bench.master.turns.drives])
        sent = len(bench.sent)
        bench.run(500_000)
        assert pzd.ON not in bench.stws(2, sent)


def test_supervision():
    for bench, _ in interrupted(
        three, lambda bench: bench.master.deadlines.supervise(bench.drives[2], 100)
    ):
        sent = len(bench.sent)
        bench.run(1_000_000)
        instants = [telegram.at for telegram in bench.sent[sent:] if telegram.address == 2]
        gaps = [after - before for before, after in zip(instants[1:], instants[2:])]
        assert max(gaps) < 45_000, max(gaps)  # two exchanges are longer than a third of it
        others_are_well(bench, 1, 2, 3)
