# SPDX-License-Identifier: MIT
"""What is wrong with a drive without contact is said as what it is, and does not flicker.

Silence, noise, another length, another address, a wrong check: five things, each with a cure of
its own. These are the fields of a drive; test_panel_trouble has the display, test_bus the
exceptions.
"""

from round_bench import Bench, Node
from spoilt_bench import (
    TROUBLES,
    longer,
    noisy,
    of_another_address,
    silent,
    with_a_wrong_check,
)
from uss import pkw, receiver
from uss.drive import Drive
from uss.outside import Mirror
from uss.receiver import OTHER_LENGTH, SILENT
from uss.telegram import BAD_LENGTH

MASK = (1 << 30) - 1
LOST_US = 1_000_000


def spoilt_by_turns(*turns):
    """A drive whose replies are spoilt in these ways, one after the other, on and on."""
    bench = Bench([Node(1), Node(2)])
    bench.contact()
    node = bench.nodes[1]
    count = [0]

    def answer(characters):
        reply = Node.answer(node, characters)
        if reply is None or characters[2] != 1:
            return reply
        count[0] += 1
        return turns[count[0] % len(turns)](bytes(reply))

    node.answer = answer
    return bench


def kinds(bench, us):
    """Every trouble that drive 1 has told of in that time."""
    seen = set()
    bench.loop = lambda: seen.add(bench.drives[1].trouble)
    bench.run(us)
    return seen


def test_two_kinds_that_take_turns_do_not_flicker():
    for first in (silent, noisy, with_a_wrong_check):
        for second in (longer, of_another_address):
            bench = spoilt_by_turns(first, second)
            bench.run(2_000_000)
            assert len(kinds(bench, 20_000_000)) == 1


def test_what_is_mostly_so_is_what_is_said():
    bench = spoilt_by_turns(silent, longer, longer, longer, noisy)
    bench.run(2_000_000)
    assert kinds(bench, 20_000_000) == {receiver.OTHER_LENGTH}
    bench = spoilt_by_turns(silent, silent, noisy)
    bench.run(2_000_000)
    assert kinds(bench, 20_000_000) == {receiver.SILENCE}


def test_another_trouble_is_noticed_soon():
    bench = spoilt_by_turns(longer)
    bench.run(10_000_000)
    assert bench.drives[1].trouble == receiver.OTHER_LENGTH
    bench.nodes[1].plugged = False
    bench.run_until(lambda: bench.drives[1].trouble == receiver.SILENCE, 4_000_000)


def test_how_often_another_trouble_must_be_met_with():
    """Three times where there was one, four where it was the same three times or more; any
    telegram with the old one outweighs one with the new."""
    length, silent = BAD_LENGTH, SILENT
    for before, turns, told in (
        ((), (length,), (True,)),  # the first one since a valid reply
        ((silent,), (length,) * 4, (False, False, True, True)),
        ((silent,) * 2, (length,) * 5, (False, False, False, True, True)),
        ((silent,) * 9, (length,) * 5, (False, False, False, True, True)),
        ((silent,), (length, silent, length, length, length), (False,) * 4 + (True,)),
        ((silent,) * 2, (length, length, silent, length), (False,) * 4),
        ((silent,), (length,) * 3 + (silent,) * 4, (False, False) + (True,) * 3 + (False,) * 2),
    ):
        drive = Drive(1, MASK)
        drive.take(bytes(16), 16, 0)
        for finding in before:
            drive.miss(finding, 0, LOST_US, MASK)
        seen = []
        for finding in turns:
            drive.miss(finding, 0, LOST_US, MASK)
            seen.append(drive.trouble == OTHER_LENGTH)
        assert tuple(seen) == told, (before, turns, seen)
        drive.take(bytes(16), 16, 0)
        drive.miss(length, 0, LOST_US, MASK)
        assert drive.trouble == OTHER_LENGTH


def test_contact_lasts_a_second_and_half_of_it_is_enough_to_withhold_a_task():
    """A telegram without the task may then bring a reply, before contact is lost. Each one is
    taken to need as long as those before it did."""
    for instants, withheld in (
        ((250_000,), False), ((250_001,), True),
        ((100_000, 333_333), False), ((100_000, 333_334), True),
    ):  # fmt: skip
        drive = Drive(1, MASK)
        drive.take(bytes(16), 16, 0)
        drive.ask(pkw.read(700))
        for instant in instants:
            drive.fill(0)
            assert drive.request[3] >> 4 == 1
            drive.miss(SILENT, instant, LOST_US, MASK)
        drive.fill(instants[-1])
        assert (drive.request[3] >> 4 == 0) == withheld, instants
        drive.miss(SILENT, LOST_US - 1, LOST_US, MASK)
        assert drive.contact
        drive.miss(SILENT, LOST_US, LOST_US, MASK)
        assert not drive.contact


def test_a_drive_tells_for_how_long_it_is_silent():
    """Since its last valid reply, or, without contact, since the last telegram. An interrupt may
    be ahead of who asks, by a tenth of a second."""
    drive = Drive(1, MASK)
    for at in (1_000_000, MASK - 5):
        drive.lose()
        drive.miss(SILENT, at - 3_000, LOST_US, MASK)
        assert drive.silent_us(at, MASK) == 3_000
        drive.take(bytes(16), 16, at)
        drive.miss(SILENT, at + 2_000 & MASK, LOST_US, MASK)
        for us, told_us in ((7_000, 7_000), (0, 0), (-1, 0), (-100_000, 0)):
            assert drive.silent_us(at + us & MASK, MASK) == told_us, (at, us)
        assert drive.silent_us(at - 200_000 & MASK, MASK) > 1_000_000


def test_every_trouble_counts_as_no_valid_reply():
    """None of them keeps contact: that, and the count of silence, are as they ever were."""
    for how, trouble, _, _ in TROUBLES:
        bench = spoilt_by_turns(how)
        drive = bench.drives[1]
        good = drive.counters[0]
        bench.run(900_000)
        assert drive.contact and drive.silent > 3, how.__name__
        bench.run(300_000)
        assert not drive.contact and drive.trouble == trouble, (how.__name__, drive.trouble)
        assert drive.counters[0] == good
        assert sum(drive.counters[1:]) == drive.silent


def test_a_telegram_outside_the_list_tells_what_came_instead():
    for how, trouble, _, _ in TROUBLES:
        bench = Bench([Node(1)])
        bench.contact()
        node = bench.nodes[1]
        node.answer = lambda characters, node=node, how=how: how(Node.answer(node, characters))
        mirror = Mirror(1)
        bench.master.turns.post(mirror)
        bench.run(200_000)
        assert receiver.TROUBLES[mirror.finding] == trouble, (how.__name__, mirror.finding)
