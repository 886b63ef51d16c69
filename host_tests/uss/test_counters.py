# SPDX-License-Identifier: MIT
"""What went wrong is counted, per drive and for the bus, and the status byte says what kind."""

from round_bench import Bench, Node, framed
from uss.drive import COUNTERS
from uss.receiver import FINDINGS, GARBLED

# How a reply is spoilt, the counter that says so, and the bit of the status byte (USS.md 1.8).
WRONGS = (
    ("no reply", lambda reply: None, "no_reply", 0x80),
    ("wrong BCC", lambda reply: reply[:-1] + bytes((reply[-1] ^ 0x10,)), "bcc", 0x10),
    ("no STX", lambda reply: b"\x03" + reply[1:], "start", 0x08),
    ("wrong LGE", lambda reply: framed(reply[2], reply[3:-3]), "length", 0x40),
    ("another node", lambda reply: framed(reply[2] ^ 4, reply[3:-1]), "address", 0x08),
    ("cut off", lambda reply: reply[:9], "residual", 0x20),
    ("garbled", lambda reply: reply[:1] + b"\x0c" + reply[2:], "length", 0x40),
)


def good(node, characters):
    return Node.answer(node, characters)


def test_each_fault_has_its_counter_and_its_bit():
    for name, how, counter, bit in WRONGS:
        bench = Bench([Node(1), Node(2)])
        bench.contact()
        drive = bench.drives[1]
        assert drive.status == 0
        bench.nodes[1].answer = lambda characters: how(good(bench.nodes[1], characters))
        bench.run(500_000)
        assert drive.counters[COUNTERS.index(counter)] >= 3, (name, drive.counters)
        assert sum(drive.counters[1:]) == drive.counters[COUNTERS.index(counter)], name
        assert drive.status == bit, (name, drive.status)
        assert drive.silent == sum(drive.counters[1:])
        assert not any(bench.drives[2].counters[1:]) and bench.drives[2].status == 0, name


def test_the_status_byte_is_cleared_by_the_next_good_telegram():
    bench = Bench([Node(1)])
    bench.contact()
    drive = bench.drives[1]
    for name, how, _, bit in WRONGS:
        bench.nodes[1].answer = lambda characters: how(good(bench.nodes[1], characters))
        bench.run_until(lambda: drive.status == bit)
        bench.nodes[1].answer = lambda characters: good(bench.nodes[1], characters)
        bench.run_until(lambda: drive.silent == 0)
        assert drive.status == 0, name


def test_several_kinds_of_faults_in_a_row_all_show():
    bench = Bench([Node(1)])
    bench.contact()
    drive = bench.drives[1]
    bits = 0
    for _, how, _, bit in WRONGS[:3]:
        silent = drive.silent
        bench.nodes[1].answer = lambda characters: how(good(bench.nodes[1], characters))
        bench.run_until(lambda: drive.silent > silent + 1)  # one was under way already
        bits |= bit
    assert drive.status & bits == bits


def test_each_drive_of_a_bus_has_its_own():
    bench = Bench([Node(address) for address in range(1, 8)])
    bench.contact()
    for address, (_, how, _, _) in enumerate(WRONGS, 1):
        node = bench.nodes[address]
        node.answer = lambda characters, node=node, how=how: how(good(node, characters))
    bench.run(500_000)
    drives = bench.master.turns.drives
    assert all([sum([drive.counters[row] for drive in drives]) for row in range(len(COUNTERS))])
    status = 0
    for drive in drives:
        status |= drive.status
    assert status == 0x80 | 0x10 | 0x08 | 0x40 | 0x20


def test_every_telegram_is_counted_once():
    bench = Bench([Node(1), Node(2), Node(3, 3, 2)])
    bench.nodes[2].plugged = False
    bench.run(3_000_000)
    drives = bench.master.turns.drives
    under_way = len(bench.sent) - sum([sum(drive.counters) for drive in drives])
    assert 0 <= under_way <= 1 and bench.master.turns.exchanges == len(bench.sent)
    for drive in drives:
        asked = bench.addresses().count(drive.address)
        assert 0 <= asked - sum(drive.counters) <= 1


def test_counters_wrap_like_those_of_the_drives():
    bench = Bench([Node(1)])
    bench.contact()
    drive = bench.drives[1]
    drive.counters[0] = drive.counters[COUNTERS.index("no_reply")] = 0xFFFF
    bench.run(50_000)
    assert 0 < drive.counters[0] < 5
    bench.nodes[1].plugged = False
    bench.run(100_000)
    assert drive.counters[COUNTERS.index("no_reply")] < 5


def test_counters_have_the_names_of_the_findings():
    """A finding of the receiver is the place of its counter; only what is garbled has none."""
    assert len(COUNTERS) == len(FINDINGS) - 1 == GARBLED
    for name, text in zip(COUNTERS, FINDINGS):
        if name != "good":
            assert name.replace("_", " ").split()[0].lower() in text.lower(), (name, text)
