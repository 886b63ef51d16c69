# SPDX-License-Identifier: MIT
"""Who is on the line, and at which rate: by mirror telegrams, which nobody acts on."""

from boards.sim.drives.families import mm420
from fleet_bench import Fleet
from round_bench import MASK, MIRROR, READY, RUNNING, Bench, Node, framed
from uss.errors import NoContact, UssError
from uss.finding import scan as scanning
from uss.finding.scan import EVERY_NET_COUNT, NET_COUNTS, RATES, RateScan, Scan
from uss.master import CLOSED, LISTENING, OFF
from uss.outside import DONE, Mirror
from uss.timing import BAUD_RATES


def found_on(nodes, scan=None, **more):
    """A scan of a line on which the master knows nobody; the bench and the scan."""
    bench = Bench(nodes, listed=False, **more)
    scan = Scan(bench.master, MASK)

    def step():
        is_over = scan.step(bench.now)
        assert is_over is scan.over, "the step with which it is over has not said so"
        return is_over

    bench.run_until(step, 60_000_000)
    return bench, scan


def only_mirrors(bench, until=None):
    """Whether nothing was sent but mirror telegrams of which no word has bit 10."""
    for telegram in bench.sent[:until]:
        net = telegram.characters[3:-1]
        if telegram.address & ~0x1F != MIRROR or any(net):
            return False
    return True


def only_harmless(bench):
    """Whether a mirror was sent first, and nothing in which a word has bit 10 and is not OFF1,
    wherever in it a drive may look for its control word."""
    for telegram in bench.sent:
        net = telegram.characters[3:-1]
        for at in range(0, len(net), 2):
            word = net[at] << 8 | net[at + 1]
            if word & 0x0400 and word != 0x047E:
                return False
    ordinary = [index for index, each in enumerate(bench.sent) if not each.address & MIRROR]
    return only_mirrors(bench, ordinary[0] if ordinary else None)


# --- who is there -------------------------------------------------------------------------------


def test_everybody_is_found_with_the_length_that_he_takes():
    layouts = {0: (4, 2), 3: (3, 2), 7: (0, 2), 12: (4, 4), 20: (0, 4), 21: (3, 4), 31: (4, 8)}
    bench, scan = found_on([Node(address, *layout) for address, layout in layouts.items()])
    assert scan.found == {0: 12, 3: 10, 7: 4, 12: 16, 20: 8, 21: 14, 31: 24}
    assert not scan.variable and not scan.unclear
    assert only_harmless(bench)


def test_an_empty_line_takes_as_long_as_was_said():
    bench = Bench([], listed=False)
    scan = Scan(bench.master, MASK)
    promised_ms = scan.longest_ms
    bench.run_until(lambda: scan.step(bench.now) or bench.sent, 200_000)
    began = bench.now
    parts = []

    def step():
        parts.append(scan.progress(14))
        return scan.step(bench.now)

    bench.run_until(step, 60_000_000)
    assert parts == sorted(parts) and set(parts) == set(range(14)) and scan.progress(14) == 14
    assert scan.found == {} and scan.asked == 32 * len(NET_COUNTS) == len(bench.sent)
    assert 0.8 * promised_ms <= (bench.now - began) / 1000 <= promised_ms
    assert 6_000 < promised_ms < 9_000
    lengths = [len(each.characters) - 4 for each in bench.sent]
    assert lengths[::32] == lengths[31::32] == [12, 10, 4, 16, 24, 8, 14], "the most usual first"


def test_an_unknown_node_is_told_to_stop_and_nothing_else():
    """Bit 10 = 1 would tell it something, wherever in the telegram its control word may stand."""
    for mirrors in (True, False):
        nodes = [Node(address) for address in (1, 2, 17)]
        for node in nodes:
            node.mirrors = mirrors
        bench, scan = found_on(nodes)
        assert only_harmless(bench) and bool(scan.found) is mirrors
        assert [node.stw for node in nodes] == [0x047E if mirrors else 0] * 3


def test_on_request_it_sends_mirror_telegrams_and_nothing_else():
    bench = Bench([Node(1), Node(2, 3, 2)], listed=False)
    scan = Scan(bench.master, MASK, range(4), enquire=False)
    bench.run_until(lambda: scan.step(bench.now), 60_000_000)
    assert scan.found == {1: 12, 2: 10} and only_mirrors(bench)
    assert scan.nodes == scan.will_trip == {}
    scan = Scan(bench.master, MASK, range(4), enquire=False)
    bench.run_until(lambda: scan.step(bench.now) or scan.found)
    scan.end()
    assert scan.nodes == scan.will_trip == {}


def test_the_unusual_lengths_are_found_when_asked_for():
    bench = Bench([Node(4, 4, 3), Node(9, 0, 16), Node(20, 3, 0)], listed=False)
    scan = Scan(bench.master, MASK, (4, 9, 20, 21), EVERY_NET_COUNT)
    bench.run_until(lambda: scan.step(bench.now), 60_000_000)
    assert scan.found == {4: 14, 9: 32, 20: 6}
    assert list(EVERY_NET_COUNT) == [2 * words for words in range(1, 21)]


def test_whoever_takes_any_length_is_said_to():
    """And that is seen before it is asked what it is: a telegram that is a word longer."""
    bench, scan = found_on([Node(2), Node(5, 127, 2), Node(6, 127, 4)])
    assert set(scan.found) == {2, 5, 6}
    assert scan.variable == {5, 6}
    assert [address for address, node in scan.nodes.items() if node.variable] == [5, 6]
    for address in (2, 5, 6):
        asked = [each for each in bench.sent if each.address & 0x1F == address]
        lengths = [len(each.characters) - 4 for each in asked[:2]]
        assert lengths == [12, 14] and [each.address & MIRROR for each in asked[:3]] == [64, 64, 0]


def test_a_drive_without_process_data_that_answers_alike_makes_no_line_with_an_echo():
    bench, scan = found_on([Node(5, 4, 0)], interrupts=False)
    assert scan.found == {5: 8} and not bench.master.has_echo()


def test_two_nodes_of_one_address_are_told_from_none():
    """Their replies lie on top of each other. They are asked three times, first of all or not."""
    for addresses in (range(3, 8), (2, 3, 4)):
        bench = Bench([Node(3)], listed=False)
        answer = bench.nodes[3].answer

        def both(characters, answer=answer):
            reply = answer(characters)
            return reply and bytes(each | 0x11 for each in reply)

        bench.nodes[3].answer = both
        scan = Scan(bench.master, MASK, addresses)
        bench.run_until(lambda bench=bench, scan=scan: scan.step(bench.now), 60_000_000)
        assert scan.found == {} and set(scan.unclear) == {3}
        asked = [telegram.address for telegram in bench.sent].count(MIRROR | 3)
        assert asked == 3 + len(NET_COUNTS) - 1, asked  # silent but at its own length


def test_a_reply_that_was_spoilt_once_is_asked_for_again():
    bench = Bench([Node(3)], listed=False)
    answer = bench.nodes[3].answer
    replies = []

    def spoilt(characters):
        reply = answer(characters)
        if reply:
            replies.append(reply)
            if len(replies) == 1:
                return reply[:6] + b"\x55" + reply[7:]
        return reply

    bench.nodes[3].answer = spoilt
    scan = Scan(bench.master, MASK, range(8))
    bench.run_until(lambda: scan.step(bench.now), 60_000_000)
    assert scan.found == {3: 12} and scan.unclear == {}


def test_it_waits_until_the_bus_has_listened():
    bench = Bench([Node(1)], listed=False)
    scan = Scan(bench.master, MASK)
    bench.loop = lambda: scan.step(bench.now)
    bench.run(90_000)
    assert bench.sent == []
    bench.run(20_000)
    assert bench.sent


def test_it_says_so_where_the_bus_is_off_or_closed_unless_it_is_over():
    for silence in ("off", "close"):
        bench = Bench([Node(1)], listed=False)
        scan = Scan(bench.master, MASK)
        bench.run_until(lambda scan=scan, bench=bench: scan.step(bench.now) or scan.found)
        getattr(bench.master, silence)()
        bench.run_until(lambda bench=bench: bench.master.phase in (OFF, CLOSED))
        bench.run(100_000)
        sent = len(bench.sent)
        for _ in range(2):
            try:
                scan.step(bench.now)
            except NoContact:
                continue
            raise AssertionError("it went on")
        scan.end()
        assert scan.step(bench.now) and len(bench.sent) == sent


def test_it_waits_behind_other_telegrams_outside_the_list():
    bench = Bench([Node(1)], listed=False)
    others = [Mirror(1) for _ in range(8)]
    for other in others:
        bench.master.turns.post(other)
    scan = Scan(bench.master, MASK, range(3))
    bench.run_until(lambda: scan.step(bench.now), 60_000_000)
    assert scan.found == {1: 12} and all([other.state == DONE for other in others])
    assert scan.step(bench.now)  # it stays over
    for other in others:
        bench.master.turns.post(other)
    scan = Scan(bench.master, MASK, range(3))
    assert not scan.step(bench.now) and scan.asked == 0  # there is no room for one more
    bench.run_until(lambda: scan.step(bench.now), 60_000_000)
    assert scan.found == {1: 12} and all([other.state == DONE for other in others])


# --- beside drives that are controlled ----------------------------------------------------------


def test_drives_of_the_bus_are_found_without_being_asked():
    bench = Bench([Node(1), Node(2, 3, 2), Node(3, 127, 2)])
    bench.contact()
    sent = len(bench.sent)
    scan = Scan(bench.master, MASK, range(5))
    bench.run_until(lambda: scan.step(bench.now), 60_000_000)
    assert scan.found == {1: 12, 2: 10, 3: 10} and scan.variable == {3}
    assert {address for address in bench.addresses(sent) if address & MIRROR} == {0x40, 0x44}


def test_a_drive_of_the_bus_that_does_not_answer_is_looked_for():
    """It is set to another layout, for example."""
    bench = Bench([Node(1), Node(2)])
    bench.nodes[2].pkw_words = 3
    bench.run(1_000_000)
    scan = Scan(bench.master, MASK, range(5))
    bench.run_until(lambda: scan.step(bench.now), 60_000_000)
    assert scan.found == {1: 12, 2: 10}
    assert scan.nodes == scan.will_trip == {}, "it is the list that asks it"


def test_drives_that_were_not_asked_yet_are_waited_for():
    bench = Bench([Node(1), Node(2)])
    scan = Scan(bench.master, MASK, (1, 2))
    bench.run_until(lambda: scan.step(bench.now), 60_000_000)
    assert scan.found == {1: 12, 2: 12} and scan.asked == 0


def test_while_it_scans_the_drives_keep_four_fifths_of_their_rate():
    bench = Bench([Node(1), Node(2)])
    bench.contact()
    bench.drives[1].start(0x1000)
    bench.run(1_000_000)
    alone = bench.rate(1, 10_000_000)
    scan = Scan(bench.master, MASK)
    bench.loop = lambda: scan.step(bench.now & MASK)
    beside = bench.rate(1, 10_000_000)
    assert 0.79 * alone < beside < 0.87 * alone, (beside, alone)  # a fifth is that of silent ones
    assert scan.asked > 25
    bench.run_until(lambda: scan.over, 60_000_000)
    assert scan.found == {1: 12, 2: 12} and bench.nodes[1].zsw == 0xFB34
    assert not any(bench.drives[1].counters[1:])


def beside_one_that_runs(*addresses):
    """Drive 1 runs; nobody has told the master of the others."""
    bench = Bench([Node(1)] + [Node(address) for address in addresses], listed=False)
    bench.drives[1] = bench.master.turns.add(1)
    bench.contact()
    bench.drives[1].start(0x1000)
    bench.run(1_000_000)
    return bench


def test_nodes_that_have_fallen_silent_since_take_no_more_of_the_line_than_the_scan_did():
    bench = beside_one_that_runs(2, 3)
    alone = bench.rate(1, 5_000_000)
    scan = Scan(bench.master, MASK, (2, 3), (12,))
    bench.loop = lambda: scan.step(bench.now & MASK)
    bench.run_until(lambda: scan.over, 60_000_000)
    bench.nodes[2].plugged = bench.nodes[3].plugged = False
    bench.loop = lambda: scan.keep(bench.now & MASK)
    beside = bench.rate(1, 5_000_000)
    assert 0.79 * alone < beside < 0.87 * alone, (beside, alone)


def test_beside_a_drive_that_answers_it_waits_until_a_silence_has_been_charged():
    """10 ms from the step that has seen it; not behind an answer, nor where nobody answers."""
    for address, listed, waits in ((7, True, True), (7, False, False), (2, True, False)):
        bench = Bench([Node(1), Node(2)], listed=False)
        if listed:
            bench.drives[1] = bench.master.turns.add(1)
            bench.contact()
        bench.run(200_000)
        bench.master.deadlines.silence_wait_us = lambda longer_us=0: 0
        scan = Scan(bench.master, MASK, (address, 8, 9), (12,), enquire=False)
        now = MASK - 5_000
        assert not scan.step(now) and scan.asked == 1
        bench.run(200_000)
        for later_us in (0, 1, 9_999, 10_000):
            assert not scan.step(now + later_us & MASK)
            assert scan.asked == (1 if waits and later_us < 10_000 else 2), (address, later_us)


def test_silences_of_a_node_that_was_found_are_charged_like_those_of_others():
    """Of a telegram that keeps it from tripping, and of a question: 10 ms before the next one."""
    for enquire, address in ((False, 2 | MIRROR), (True, 2)):
        bench = Bench([Node(1), Node(2)], listed=False)
        bench.drives[1] = bench.master.turns.add(1)
        bench.contact()
        bench.master.deadlines.silence_wait_us = lambda longer_us=0: 0
        scan = Scan(bench.master, MASK, (2, 8), (12,), enquire=enquire)
        bench.run_until(lambda bench=bench, scan=scan: scan.step(bench.now) or scan.found)
        if enquire:
            bench.run_until(lambda bench=bench, scan=scan: scan.step(bench.now) or scan.nodes)
        bench.nodes[2].plugged = False
        if not enquire:
            bench.run(200_000)
            scan.step(bench.now)
        bench.run(200_000)
        own = [each for each in bench.addresses() if each != 1]
        assert own[-1] == address, own
        now = bench.now
        for later_us, count in ((0, 0), (9_999, 0), (10_000, 1)):
            scan.step(now + later_us)
            bench.run(50_000)
            asked = [each for each in bench.addresses() if each != 1]
            assert len(asked) - len(own) == count, (enquire, later_us)


def test_a_node_that_is_asked_what_it_is_hears_mirror_telegrams_when_no_question_has_room():
    """100 ms after the last question: what layout it has is not known yet."""
    bench = Bench([Node(2)], listed=False)
    room = [0]
    bench.master.deadlines.silence_wait_us = lambda longer_us=0: room[0]
    scan = Scan(bench.master, MASK, (2,), (12,))
    bench.run_until(lambda: scan.step(bench.now) or scan.nodes)
    room[0] = 1
    bench.run(50_000)
    now, sent = bench.now, len(bench.sent)
    for later_us, count in ((0, 0), (99_999, 0), (100_000, 1)):
        assert not scan.step(now + later_us)
        bench.run(50_000)
        assert len(bench.sent) - sent == count, later_us
    assert bench.addresses(sent) == [2 | MIRROR] and len(bench.sent[sent].characters) == 16
    room[0] = 0
    bench.run_until(lambda: scan.step(bench.now))
    assert scan.asked_nodes() == [(2, scan.nodes[2])]


def test_nobody_is_kept_who_was_not_found_when_it_was_ended():
    """Not the one whose telegram was under way, either."""
    bench = Bench([Node(1)], listed=False)
    scan = Scan(bench.master, MASK, (1, 5), (12,), enquire=False)
    bench.run_until(lambda: scan.step(bench.now) or bench.addresses()[-1:] == [5 | MIRROR])
    assert not scan.over
    scan.end()
    sent = len(bench.sent)
    bench.loop = lambda: scan.keep(bench.now)
    bench.run(1_000_000)
    asked = bench.addresses(sent)
    assert set(asked) == {1 | MIRROR} and 7 < len(asked) < 11, asked


def test_it_is_over_when_it_said_beside_drives_too():
    bench = Bench([Node(1)])
    bench.contact()
    scan = Scan(bench.master, MASK)
    promised_ms = scan.longest_ms
    began = bench.now
    bench.loop = lambda: scan.step(bench.now & MASK)
    bench.run_until(lambda: scan.over, 90_000_000)
    assert (bench.now - began) / 1000 <= 1.1 * promised_ms


def test_a_stop_does_not_wait_for_the_scan_and_ends_it():
    bench = Bench([Node(1), Node(2)])
    bench.contact()
    for step in range(50):
        scan = Scan(bench.master, MASK)
        bench.loop = lambda: scan.step(bench.now & MASK)
        bench.drives[1].start(0x1000)
        bench.run(300_000 + 3_571 * step)
        assert not scan.over
        sent = len(bench.sent)
        bench.drives[1].stop()
        bench.run(100_000)
        assert bench.addresses(sent)[0] == 1, step
        assert scan.over and scan.stopped, step
        assert len([each for each in bench.addresses(sent) if each & MIRROR]) <= 1


def test_a_stop_ends_it_in_the_next_step_and_when_the_count_of_stops_begins_again_too():
    for before, behind in ((5, 6), (0xFFFF, 0)):
        bench = Bench([Node(1)])
        drive = bench.drives[1]
        drive.stops = drive.stops_sent = before
        bench.contact()
        scan = Scan(bench.master, MASK, (2,), (12,))
        assert not scan.step(bench.now)
        drive.stop()
        assert drive.stops == behind and scan.step(bench.now) and scan.stopped


def test_nothing_stops_a_scan_that_is_over_already():
    bench = Bench([Node(1), Node(2)])
    bench.contact()
    scan = Scan(bench.master, MASK, (1, 2))
    bench.run_until(lambda: scan.step(bench.now))
    bench.drives[1].stop()
    assert scan.step(bench.now) and not scan.stopped
    scan.end()
    assert not scan.stopped


def test_the_program_may_end_it():
    for when in ("found", "nodes"):  # before and while the node is asked what it is
        bench = Bench([Node(3)], listed=False)
        scan = Scan(bench.master, MASK)

        def is_time(bench=bench, scan=scan, when=when):
            return scan.step(bench.now) or getattr(scan, when)

        bench.run_until(is_time, 60_000_000)
        scan.end()
        bench.run(100_000)
        sent = len(bench.sent)
        bench.run(1_000_000)
        assert scan.step(bench.now) and scan.stopped and len(bench.sent) == sent
        assert scan.will_trip == {3: None}


def test_what_a_node_is_can_be_told_when_it_was_asked_everything():
    bench = Bench([Node(3), Node(5)], listed=False)
    scan = Scan(bench.master, MASK, (5, 3), (12,))
    bench.run_until(lambda: scan.step(bench.now) or scan.nodes)
    assert list(scan.nodes) == [5] and scan.asked_nodes() == []
    bench.run_until(lambda: scan.step(bench.now), 60_000_000)
    assert scan.asked_nodes() == [(3, scan.nodes[3]), (5, scan.nodes[5])]


def test_a_node_that_was_added_is_asked_by_the_list_and_the_others_by_the_scan():
    for added in (1, 2):
        bench = Bench([Node(1), Node(2)], listed=False)
        scan = Scan(bench.master, MASK, (1, 2), (12,))
        bench.run_until(lambda bench=bench, scan=scan: scan.step(bench.now), 60_000_000)
        drive = bench.master.turns.add(added)
        sent = len(bench.sent)
        bench.loop = lambda bench=bench, scan=scan: scan.keep(bench.now)
        bench.run(1_000_000)
        asked = bench.addresses(sent)
        assert set(asked) == {1, 2}, added
        assert 8 <= asked.count(3 - added) <= 11, "in a second, each time after KEEP_US"
        drive.start(0x1000)
        bench.run(100_000)
        sent = len(bench.sent)
        bench.run(1_000_000)
        assert set(bench.stws(added, sent)) == {0x047F}, "no OFF1 for a drive of the list"


def test_when_it_is_over_each_step_of_a_slow_loop_asks_the_node_that_waits_longest():
    bench = Bench([Node(1), Node(2), Node(3)], listed=False)
    scan = Scan(bench.master, MASK, (1, 2, 3), (12,))
    bench.run_until(lambda: scan.step(bench.now), 60_000_000)
    bench.run(200_000)
    sent = len(bench.sent)
    for times in (1, 1, 1, 3, 3, 3, 1, 1, 1):
        for _ in range(times):  # as long as one is under way there is no other one
            scan.keep(bench.now)
        bench.run(150_000)
    asked = bench.addresses(sent)
    assert sorted(asked[:3]) == [1, 2, 3] and asked == 3 * asked[:3], asked
    assert {each.stw() for each in bench.sent[sent:]} == {0x047E}


def test_a_node_is_kept_from_tripping_and_one_that_never_trips_is_left_alone():
    """P2014 = 0: it does not wait for telegrams. The other one is asked three times within it."""
    off_times_ms = {3: 0, 4: 900}
    kinds = {address: {"family": mm420, "parameters": {2014: off_time_ms}}
             for address, off_time_ms in off_times_ms.items()}  # fmt: skip
    fleet = Fleet(kinds, listed=False)
    scan = Scan(fleet.master, fleet.clock.ticks_mask, (3, 4), (12,))
    fleet.run_until(lambda: scan.step(fleet.clock.ticks_us()))
    assert {address: node.off_time_ms for address, node in scan.nodes.items()} == off_times_ms
    assert scan.will_trip == {4: 900}
    since, until_us = fleet.wire.log.count, fleet.clock.now_us + 3_000_000
    while fleet.clock.now_us < until_us:
        scan.keep(fleet.clock.ticks_us())
        fleet.run(2)
    log = fleet.wire.log.last(fleet.wire.log.count - since)
    asked = [characters[2] for _, mine, characters in log if mine]
    assert set(asked) == {4} and 9 <= len(asked) <= 10, asked
    assert fleet.motors[4].state == "ready", fleet.motors[4].state


def test_while_the_bus_is_off_or_listens_nobody_is_kept():
    """What was posted would be the first thing on the line."""
    bench = Bench([Node(1)], listed=False)
    scan = Scan(bench.master, MASK, (1,), (12,), enquire=False)
    bench.run_until(lambda: scan.step(bench.now))
    post, phases = bench.master.turns.post, []

    def noting(telegram):
        phases.append(bench.master.phase)
        post(telegram)

    bench.master.off()
    bench.run_until(lambda: bench.master.phase == OFF)
    bench.master.turns.post = noting
    bench.loop = lambda: scan.keep(bench.now)
    bench.run(200_000)
    assert phases == []
    bench.master.on()
    bench.run(90_000)
    assert bench.master.phase == LISTENING and phases == []
    bench.run_until(lambda: phases)
    assert LISTENING not in phases


def test_when_a_node_is_asked_again():
    """After a third of its P2014, but not within 100 ms, and then also where it is not known.
    It counts from the step that has seen the end of the telegram before."""
    bench = Bench([Node(1)], listed=False)
    scan = Scan(bench.master, MASK, (1,), (12,))
    bench.run_until(lambda: scan.step(bench.now), 60_000_000)
    for off_time_ms, again_us in (
        (None, 100_000), (150, 100_000), (300, 100_000), (301, 100_333), (900, 300_000),
    ):  # fmt: skip
        scan.nodes[1].off_time_ms = off_time_ms
        scan.keep(bench.now)
        bench.run(400_000)
        scan.keep(bench.now)
        bench.run(100_000)
        asked_at, sent = bench.now, len(bench.sent)
        for later_us, count in ((0, 0), (again_us - 1, 0), (again_us, 1)):
            scan.keep(asked_at + later_us & MASK)
            bench.run(50_000)
            assert len(bench.sent) - sent == count, (off_time_ms, later_us)


def test_a_node_without_process_data_is_kept_by_mirror_telegrams():
    """The others hear OFF1, by which a V20 does not trip either."""
    bench = Bench([Node(1), Node(5, 4, 0)], listed=False)
    scan = Scan(bench.master, MASK, (1, 5), (12, 8))
    bench.run_until(lambda: scan.step(bench.now), 60_000_000)
    sent = len(bench.sent)
    bench.loop = lambda: scan.keep(bench.now)
    bench.run(500_000)
    assert set(bench.addresses(sent)) == {1, 5 | MIRROR}


def test_those_that_were_found_take_two_of_three_telegrams_at_the_most():
    """However many they are: else the search would come to no end."""
    bench = Bench([Node(address) for address in range(20)], listed=False)
    scan = Scan(bench.master, MASK, range(24), (12, 10), enquire=False)
    bench.run_until(lambda: scan.step(bench.now), 60_000_000)
    known, rows = set(), [0]
    for each in bench.sent:
        telegram = each.address, len(each.characters)
        if telegram in known:
            rows[-1] += 1
        else:
            rows.append(0)
        known.add(telegram)
    assert max(rows) == 2 and rows.count(2) > 10, rows


def test_a_scan_that_is_to_look_no_further_asks_what_it_has_found_not_for_long():
    """One that tells nothing would be asked a hundred questions."""
    bench = Bench([Node(3)], listed=False)
    scan = Scan(bench.master, MASK)
    bench.run_until(lambda: scan.step(bench.now) or scan.nodes, 60_000_000)
    assert scan.progress(1000) < 100
    scan.finish()
    assert scan.progress(1000) == 1000
    bench.run_until(lambda: scan.step(bench.now))
    questions = [each for each in bench.sent if each.address == 3]
    # And the one that had been posted, and OFF1 in its usual form.
    assert len(questions) == 1 + 20 + 1, len(questions)
    assert not questions[-1].task() and questions[-1].stw() == 0x047E
    # The questions keep it from tripping: mirror telegrams are not needed for that.
    assert bench.addresses().count(MIRROR | 3) == 2
    assert scan.will_trip == {3: None}


def test_the_last_questions_are_those_that_were_sent():
    """For many others there was no room, beside eight telegrams of somebody else."""
    bench = Bench([Node(3)], listed=False)
    scan = Scan(bench.master, MASK)
    bench.run_until(lambda: scan.step(bench.now) or scan.nodes, 60_000_000)
    scan.finish()
    post, tries = bench.master.turns.post, [0]

    def post_at_times(telegram):
        tries[0] += 1
        if tries[0] % 3:
            raise RuntimeError("8 telegrams wait already")
        post(telegram)

    bench.master.turns.post = post_at_times
    bench.run_until(lambda: scan.step(bench.now))
    questions = [each for each in bench.sent if each.address == 3]
    assert len(questions) == 1 + 20 + 1 and tries[0] >= 3 * 20, (len(questions), tries)


def test_a_scan_that_is_to_look_no_further_still_sees_whether_any_length_will_do():
    """That telegram waits for room when the program has seen enough."""
    bench = Bench([Node(3, 127, 2), Node(4)], listed=False)
    room = [0]
    bench.master.deadlines.silence_wait_us = lambda longer_us=0: room[0]
    scan = Scan(bench.master, MASK, (3, 4), (12,), enquire=False)
    assert not scan.step(bench.now)
    bench.run_until(lambda: scan.step(bench.now) or scan.asked)
    room[0] = 1
    bench.run_until(lambda: scan.step(bench.now) or scan.found)
    scan.finish()
    assert not scan.step(bench.now) and scan.asked == 1
    room[0] = 0
    bench.run_until(lambda: scan.step(bench.now))
    assert scan.asked == 2 and scan.found == {3: 12} and scan.variable == {3}
    assert scan.progress(1000) == 1000, "more than all is done"


def test_a_scan_that_is_to_look_no_further_stops_whom_it_has_found():
    """Wherever that strikes; a motor may have been left running by somebody."""
    for step in range(40):
        bench = Bench([Node(0), Node(3, 127, 2)], listed=False)
        scan = Scan(bench.master, MASK)
        bench.loop = lambda: scan.step(bench.now & MASK)
        bench.run(120_000 + 41_000 * step)
        scan.finish()
        asked = scan.asked
        began = bench.now
        bench.run_until(lambda: scan.over)
        assert scan.stopped and scan.asked - asked <= 1
        assert bench.now - began < 1_500_000, (step, bench.now - began)
        assert sorted(scan.nodes) == sorted(scan.found), step
        for address in scan.found:
            assert bench.nodes[address].stw == 0x047E, step
        assert only_harmless(bench)
    assert sorted(scan.found) == [0, 3]


# --- at which rate ------------------------------------------------------------------------------


class Lines:
    """Opens a bus at any rate; the nodes hear and answer at their own one only."""

    def __init__(self, baud, nodes):
        self.baud = baud
        self.nodes = nodes
        self.benches = []
        self.opened = []

    def open(self, baud):
        bench = Bench(self.nodes if baud == self.baud else [], baud, listed=False)
        self.benches.append(bench)
        self.opened.append(baud)
        return bench.master

    def carry_out(self, scan, foreign=lambda bench: False):
        """foreign: whether somebody else talks now."""
        while True:
            if self.benches:
                bench = self.benches[-1]
                if foreign(bench):
                    bench.talk(framed(3, bytes(12)))
                bench.run(20_000)
                now = bench.now & MASK
            else:
                now = 0
            if scan.step(now):
                assert scan.step(now)  # it stays over
                return
            assert not scan.over, "the step with which it is over has not said so"


def test_the_rate_is_found_and_who_is_there():
    for baud in (9600, 19200, 187500, 2400):
        lines = Lines(baud, [Node(2), Node(11, 3, 2)])
        scan = RateScan(lines.open, MASK, nothing_runs=True, addresses=range(12))
        lines.carry_out(scan)
        assert (scan.baud, scan.found) == (baud, {2: 12, 11: 10})
        assert set(scan.nodes) == set(scan.will_trip) == {2, 11}
        assert lines.opened == list(RATES[: RATES.index(baud) + 1])
        assert all(only_harmless(bench) for bench in lines.benches)


def test_nothing_is_opened_unless_nothing_runs():
    lines = Lines(9600, [])
    for words in ({}, {"nothing_runs": False}, {"nothing_runs": 1}):
        try:
            RateScan(lines.open, MASK, **words)
        except ValueError as error:
            assert "nothing_runs=True" in str(error)
            continue
        raise AssertionError(words)
    assert lines.opened == []


def test_no_rate_is_tried_unless_every_drive_of_the_list_is_seen_to_stand():
    def left(bench):
        """A scan that is to follow this bus; the rates that it opens."""
        opened = []
        scan = RateScan(
            lambda baud: opened.append(baud) or Lines(None, []).open(baud), MASK,
            nothing_runs=True, rates=(9600,), addresses=range(2), bus=bench.master,
        )  # fmt: skip
        return scan, opened

    bench = Bench([Node(1), Node(2)])
    bench.contact()
    bench.nodes[2].follows = False
    for is_told, zsw in ((True, READY), (False, RUNNING)):  # it may start soon, or runs by itself
        if is_told:
            bench.drives[2].start(0x1000)
        bench.nodes[2].zsw = zsw
        bench.run(100_000)
        scan, opened = left(bench)
        try:
            scan.step(bench.now)
        except UssError as error:
            assert "drive 2 is not seen to stand" in str(error), error
        else:
            raise AssertionError(is_told)
        bench.drives[2].stop()
        bench.run(100_000)
    bench.nodes[2].follows = True
    bench.drives[2].start(0x1000)
    bench.run(100_000)
    scan, opened = left(bench)
    for reason in ("drive 2 is not seen to stand", "another master is on the line"):
        try:
            scan.step(bench.now)
        except UssError as error:
            assert reason in str(error), error
        else:
            raise AssertionError(reason)
        bench.drives[2].stop()
        bench.run(100_000)
        bench.nodes[1].plugged = False  # another one answers for it
        bench.run_until(lambda: bench.sent[-1].address == 1)
        bench.talk(framed(7, bytes(12)), bench.now + 11_000)
        bench.run(30_000)
        bench.nodes[1].plugged = True
    bench.run_until(lambda: not bench.master.is_line_shared(), 60_000_000)
    for _ in range(100):
        assert not scan.step(bench.now)
        assert not opened or bench.master.phase == OFF
        bench.run(5_000)
    assert opened == [9600] and bench.nodes[1].stw == 0x047E
    try:
        left(bench)[0].step(bench.now)  # a bus that is off sees nobody
    except UssError as error:
        assert "drive 1 is not seen to stand" in str(error)
    else:
        raise AssertionError("tried")
    bench.nodes[1].plugged = False
    bench.master.on()
    bench.run(3_000_000)
    try:
        left(bench)[0].step(bench.now)
    except UssError as error:
        assert "drive 1 is not seen to stand" in str(error)
        return
    raise AssertionError("tried")


def test_a_bus_without_drives_is_put_off_too_before_another_rate_is_tried():
    bench = Bench([], listed=False)
    phases = []

    def open_bus(baud):
        phases.append(bench.master.phase)
        return Lines(None, []).open(baud)

    scan = RateScan(open_bus, MASK, nothing_runs=True, rates=(9600,), bus=bench.master)
    bench.loop = lambda: scan.step(bench.now)
    bench.run_until(lambda: phases)
    assert phases == [OFF] and not scan.over
    bench.talk(framed(3, bytes(12)))  # on the bus before, which is off: that is all the same now
    bench.run(20_000)
    assert not scan.over and len(phases) == 1


def test_a_bus_without_drives_that_hears_another_master_is_not_left():
    bench = Bench([], listed=False)
    scan = RateScan(None, MASK, nothing_runs=True, bus=bench.master)
    bench.talk(framed(3, bytes(12)))
    bench.run(20_000)
    try:
        scan.step(bench.now)
    except UssError as error:
        assert "another master is on the line" in str(error), error
        assert bench.master.phase == LISTENING and not scan.over
        return
    raise AssertionError("left")


def test_every_rate_is_tried_once():
    """Of all that there are, those of every interface first."""
    assert sorted(RATES) == sorted(BAUD_RATES)
    lines = Lines(None, [])
    scan = RateScan(lines.open, MASK, nothing_runs=True, addresses=(0,), net_counts=(4,))
    lines.carry_out(scan)
    assert lines.opened == [
        9600, 19200, 38400, 57600, 115200, 187500, 4800, 2400, 76800, 93750, 1200, 600, 300,
    ]  # fmt: skip
    lines = Lines(None, [])
    rates = (9600, 115200, 38400)
    scan = RateScan(lines.open, MASK, nothing_runs=True, rates=rates, addresses=range(4))
    lines.carry_out(scan)
    assert scan.baud is None and scan.found == {} and lines.opened == list(rates)


def test_drives_that_all_have_the_same_address_leave_a_trace():
    """As delivered: their replies lie on top of each other, at one rate only."""
    node = Node(0)
    answer = node.answer
    node.answer = lambda characters: bytes([each | 0x11 for each in answer(characters) or b""])
    lines = Lines(19200, [node])
    rates = (9600, 19200, 38400)
    scan = RateScan(lines.open, MASK, nothing_runs=True, rates=rates, addresses=range(4))
    lines.carry_out(scan)
    assert scan.baud is None and set(scan.unclear) == {19200} and set(scan.unclear[19200]) == {0}


def test_at_each_rate_it_listens_before_it_sends():
    lines = Lines(None, [])
    rates = (19200, 9600)
    scan = RateScan(lines.open, MASK, nothing_runs=True, rates=rates, addresses=range(2))
    lines.carry_out(scan)
    for bench in lines.benches:
        assert bench.sent[0].at >= 100_000


def test_where_somebody_talks_nothing_is_sent():
    lines = Lines(9600, [Node(1)])
    scan = RateScan(lines.open, MASK, nothing_runs=True)
    lines.carry_out(scan, lambda bench: True)
    assert scan.line_in_use and scan.baud is None
    for bench in lines.benches:
        bench.run(3_000_000)
        assert bench.sent == [] and bench.master.phase == OFF


def test_what_the_bus_has_heard_before_it_sends_ends_nothing():
    """A spike, and a loop that came round when the line had been silent for long enough."""
    lines = Lines(9600, [Node(1)])

    def open_late(baud):
        master = lines.open(baud)
        lines.benches[-1].talk(b"\x00")
        lines.benches[-1].run(250_000)
        return master

    scan = RateScan(open_late, MASK, nothing_runs=True)
    lines.carry_out(scan)
    assert lines.benches[0].master.foreign == 1
    assert (scan.baud, scan.found) == (9600, {1: 12}) and not scan.line_in_use


def test_a_master_that_is_heard_later_ends_it():
    """One that talks once a second: not while the bus listened."""
    lines = Lines(9600, [])
    scan = RateScan(lines.open, MASK, nothing_runs=True)
    lines.carry_out(scan, lambda bench: bench.now % 1_000_000 == 600_000)
    assert scan.line_in_use and scan.baud is None and lines.opened == [9600]
    lines.benches[0].run(1_000_000)
    assert lines.benches[0].master.phase == OFF, "the line is left to the other one"


def test_the_program_may_end_the_search_for_the_rate():
    lines = Lines(9600, [Node(3)])
    scan = RateScan(lines.open, MASK, nothing_runs=True)
    scan.end()
    lines.carry_out(scan)
    assert lines.opened == [] and scan.baud is None and scan.found == {}
    scan = RateScan(lines.open, MASK, nothing_runs=True)
    lines.carry_out(scan, lambda bench: scan.found and scan.end())
    sent = len(lines.benches[0].sent)
    lines.benches[0].run(1_000_000)
    assert lines.opened == [9600] and len(lines.benches[0].sent) == sent
    assert scan.found == {3: 12} and scan.will_trip == {3: None} and scan.scan.stopped


def test_a_bus_with_drives_is_not_taken():
    bench = Bench([Node(1)])
    scan = RateScan(lambda baud: bench.master, MASK, nothing_runs=True)
    try:
        scan.step(0)
    except ValueError as error:
        assert "drives" in str(error)
        return
    raise AssertionError("taken")


def test_a_rate_that_is_none_is_refused():
    try:
        RateScan(None, MASK, nothing_runs=True, rates=(9600, 14400))
    except ValueError as error:
        assert "14400" in str(error)
        return
    raise AssertionError("taken")


def test_how_long_it_takes_is_said_beforehand():
    scan = RateScan(None, MASK, nothing_runs=True)
    slow = RateScan(None, MASK, nothing_runs=True, rates=(300,))
    assert 60_000 < slow.longest_ms < scan.longest_ms < 600_000
    usual = RateScan(None, MASK, nothing_runs=True, rates=(19200,))
    assert usual.longest_ms == Scan(Bench([], listed=False).master, MASK).longest_ms
    assert scanning.NET_COUNTS[0] == 12
    both = RateScan(None, MASK, nothing_runs=True, rates=(9600, 19200))
    assert [each.longest_ms for each in (slow, usual, both)] == [194_720, 8_111, 18_735]
    bench = Bench([Node(1)])
    scan = Scan(bench.master, MASK)
    assert scan.longest_ms == 8_111
    bench.contact()
    assert scan.longest_ms == 40_559, "it has a fifth of the time"
