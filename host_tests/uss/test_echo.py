# SPDX-License-Identifier: MIT
"""A line with two wires whose receiver stays on: the master hears what it sends.

The echo may come by itself, in one burst with the reply, or in pieces; a mirror telegram that
comes back looks just the same.
"""

from round_bench import Bench, Node
from uss import pkw, pzd
from uss.families import GENERIC, drive_maker
from uss.layout import Layout
from uss.outside import Broadcast, Mirror
from uss.receiver import SILENT

IDLE_BITS = 32  # after so many bit times without a character an RP2040 reports a burst

# How the link hands over what it hears: bit times until it reports a burst, None when it has to be
# looked at.
LINKS = (0, 11, IDLE_BITS, None)
LAYOUTS = ((4, 2), (3, 2), (0, 2), (0, 1), (4, 16), (127, 2), (127, 6), (3, 0))


def bench_of(nodes, bits, baud=19200, echo=True, **more):
    idle_us = bits * 1_000_000 // baud if bits else 0
    return Bench(nodes, baud, echo=echo, idle_us=idle_us, interrupts=bits is not None, **more)


def mirrored(bench, address, net):
    """Post a mirror telegram and answer it when it is through."""
    mirror = Mirror(address, net)
    bench.master.turns.post(mirror)
    bench.run_until(lambda: mirror.state != pkw.PENDING)
    return mirror


def test_every_layout_works_with_and_without_an_echo_on_every_link():
    for bits in LINKS:
        for echo in (False, True):
            nodes = [Node(1 + row, *layout) for row, layout in enumerate(LAYOUTS)]
            bench = bench_of(nodes, bits, echo=echo)
            bench.run(2_000_000)
            for drive in bench.master.turns.drives:
                where = (bits, echo, drive.address, drive.counters)
                assert drive.contact and drive.counters[0] > 3, where
                assert not any(drive.counters[1:]), where


def test_the_echo_costs_nothing():
    for bits in LINKS[:3]:
        with_echo, without = (bench_of([Node(1)], bits, echo=echo) for echo in (True, False))
        with_echo.contact()
        without.contact()
        assert with_echo.rate(1, 5_000_000) >= without.rate(1, 5_000_000) - 2


def test_every_rate():
    for baud in (300, 9600, 57600, 115200, 187500):
        character_us = -(-11_000_000 // baud)
        for bits in LINKS:
            for characters in (2, 3):
                node = Node(1, delay_us=characters * character_us + 10)
                bench = bench_of([node], bits, baud)
                bench.run(500_000 + 1200 * character_us)
                drive = bench.drives[1]
                assert drive.counters[0] >= 3, (baud, bits, characters)
                assert not any(drive.counters[1:]), (baud, bits, characters, drive.counters)


def test_a_silent_drive_is_silent_although_its_request_comes_back():
    for bits in LINKS:
        bench = bench_of([Node(1), Node(2)], bits)
        bench.contact()
        bench.nodes[2].plugged = False
        bench.run(1_000_000)
        counters = bench.drives[2].counters
        assert counters[SILENT] >= 3 and sum(counters[1:]) == counters[SILENT], (bits, counters)
        assert not any(bench.drives[1].counters[1:])


def test_a_mirror_telegram_that_comes_back_twice_was_answered():
    for bits in LINKS:
        for echo in (False, True):
            bench = bench_of([Node(1), Node(5)], bits, echo=echo)
            bench.contact()
            for _ in range(5):
                mirror = mirrored(bench, 5, b"\x12\x34\x56\x78\x9a\xbc\xde\xf0\x00\x00\x00\x00")
                assert mirror.state == pkw.DONE, (bits, echo, mirror.finding)
            assert bench.nodes[5].mirrored == 5


def test_a_drive_that_is_silent_costs_no_more():
    """The characters that the link has announced are those of the echo: no reply is coming."""
    for bits in LINKS:
        for layout in ((4, 2), (127, 4)):
            sent = []
            for echo in (True, False):
                bench = bench_of([Node(1, *layout)], bits, baud=4800, echo=echo)
                bench.nodes[1].plugged = False
                bench.run(10_000_000)
                sent.append(len(bench.sent))
            assert sent[0] >= sent[1] - 2, (bits, layout, sent)


def test_the_echo_of_a_mirror_telegram_is_no_answer():
    """Nobody is there. A scan must not find 32 drives on a line with an echo."""
    for bits in LINKS:
        bench = bench_of([Node(1)], bits)
        bench.contact()
        for address in (2, 3, 4):
            mirror = mirrored(bench, address, bytes(12))
            assert mirror.state == pkw.TIMED_OUT and mirror.finding == SILENT, (bits, address)


def test_the_first_telegram_of_all_may_be_a_mirror_telegram():
    """Whether the line has an echo is known from the first telegram only when it is."""
    for bits in LINKS:
        for echo in (False, True):
            for present in (False, True):
                nodes = [Node(5)] if present else []
                bench = bench_of(nodes, bits, echo=echo, listed=False)
                mirror = mirrored(bench, 5, bytes(12))
                expected = pkw.DONE if present else pkw.TIMED_OUT
                assert mirror.state == expected, (bits, echo, present, mirror.finding)


def test_a_scan_on_a_line_with_an_echo_finds_who_is_there():
    from uss.finding.scan import Scan

    for bits in LINKS:
        bench = bench_of([Node(3), Node(9, 3, 2)], bits, listed=False)
        scan = Scan(bench.master, (1 << 30) - 1, addresses=range(12))
        bench.run_until(lambda: scan.step(bench.now), 30_000_000)
        assert scan.found == {3: 12, 9: 10}, (bits, scan.found)


def test_the_echo_may_go_and_come():
    """A receiver whose enable is wired to a switch."""
    bench = bench_of([Node(1), Node(2)], IDLE_BITS)
    bench.contact()
    for step in range(40):
        bench.echo = bool(step & 1)
        bench.run(37_000)
    for drive in bench.master.turns.drives:
        assert drive.contact and sum(drive.counters[1:]) == 0, drive.counters


def test_without_the_echo_a_mirror_telegram_is_still_known_by_its_time():
    bench = bench_of([Node(1), Node(5, delay_us=6_000)], IDLE_BITS)
    bench.contact()
    bench.echo = False
    bench.run(50_000)
    assert mirrored(bench, 5, bytes(12)).state == pkw.DONE
    assert mirrored(bench, 9, bytes(12)).state == pkw.TIMED_OUT


class Alike(Node):
    """A device whose status word may have any bits: it answers with the very telegram."""

    def answer(self, characters):
        return characters


class Pump(GENERIC):
    zsw_says = ((0x0400, 0x0400, pzd.ZSW_READY),)


def test_only_a_drive_with_a_status_word_of_its_own_may_answer_with_the_request():
    """A link that announces what it has heard does not know the pause before that exactly."""
    for family, has_contact in ((Pump, True), (GENERIC, False)):
        bench = bench_of([Alike(1)], IDLE_BITS, echo=False, listed=False)
        drive = bench.master.turns.add(1, Layout(4, 2), drive_maker(family))
        bench.run(1_000_000)
        assert drive.contact == has_contact, (family.__name__, drive.counters)
        assert (drive.counters[0] > 3) == has_contact, drive.counters


def test_the_echo_of_a_broadcast_is_known_by_the_first_one():
    """The drives have their time to take it: it is not cut short as by a reply. At the higher
    rate a link that has to be looked at cannot tell whether the echo came after a pause."""
    for baud in (19_200, 115_200):
        for bits in LINKS:
            bench = bench_of([], bits, baud)
            broadcast = Broadcast((pzd.OFF1, 0x1000), {2: 0xFFFF})
            bench.master.turns.post(broadcast)
            bench.run_until(lambda: broadcast.state != pkw.PENDING)
            passed_us = bench.now - bench.sent[0].at - bench.timing.telegram_us(12)
            assert broadcast.state == pkw.DONE and passed_us >= 20_000, (baud, bits, passed_us)


def test_an_echo_that_is_spoilt_is_no_reply():
    """Somebody talks at the same time."""
    bench = bench_of([Node(1)], 0)
    bench.contact()
    send = bench.send

    def spoilt(buffer, count):
        bench.echo = False
        send(buffer, count)
        bench.echo = True
        characters = bytearray(buffer[:count])
        characters[5] ^= 0x10
        characters[-1] ^= 0x10
        bench.talk(bytes(characters), bench.now)
        bench.bursts.sort()

    good = bench.drives[1].counters[0]
    bench.send = spoilt
    bench.run(1_000_000)
    drive = bench.drives[1]
    assert drive.counters[0] > good + 5 or not drive.contact  # heard, or not: never taken for one
    assert drive.zsw in (0xFB31, 0)
