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
from uss import receiver
from uss.outside import Mirror


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
