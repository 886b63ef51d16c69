# SPDX-License-Identifier: MIT
"""Telegrams outside the list: mirror, broadcast, special."""

from round_bench import MIRROR, Bench, Node, framed
from uss import pkw, pzd
from uss.finding.mirror import OutsideTelegram
from uss.outside import NEW, PENDING, TIMED_OUT, Broadcast, Mirror, Special, stop_all
from uss.receiver import SILENT
from uss.telegram import BAD_BCC, BAD_LENGTH, GOOD

NET = b"\x12\x34\x56\x78\x9a\xbc\xde\xf0\x00\x00\x00\x00"
TOGETHER = Broadcast((pzd.OFF1, 0x1000), {2: 0xFFFF}).request  # a setpoint for all
RESPONSE_DELAY_US = 20_000


def nodes(count):
    return [Node(address) for address in range(1, count + 1)]


def through(bench, single):
    """Post it and wait until it is through; the telegrams that carried it."""
    sent = len(bench.sent)
    bench.master.turns.post(single)
    assert single.state == PENDING
    bench.run_until(lambda: single.state != PENDING)
    wanted = bytes(single.request[: single.size])
    bench.run(200_000)
    return [telegram for telegram in bench.sent[sent:] if telegram.characters == wanted]


def refused(what, *arguments):
    try:
        what(*arguments)
    except ValueError as error:
        return str(error)
    raise AssertionError("taken: %r" % (arguments,))


def test_each_is_sent_once():
    for make in (
        lambda: Mirror(1, NET),
        lambda: Broadcast((pzd.OFF1, 0), {2: 0xFFFF}),
        lambda: Special(None, b"\x01\x02\x03"),
    ):
        bench = Bench(nodes(3))
        bench.contact()
        assert len(through(bench, make())) == 1, make()


def test_each_is_sent_once_where_there_are_retries():
    """Nothing is missed where nobody is to answer."""
    for make in (
        lambda: Mirror(1, NET),
        lambda: Broadcast((pzd.OFF1, 0), {2: 0xFFFF}),
        lambda: Special(None, b"\x01\x02\x03"),
    ):
        bench = Bench(nodes(3))
        bench.contact()
        bench.master.retries = 3
        single = make()
        assert len(through(bench, single)) == 1 and single.state == pkw.DONE


def test_a_mirror_telegram_comes_back_from_who_is_there():
    bench = Bench(nodes(3))
    bench.contact()
    there, nobody = Mirror(2, NET), Mirror(9, NET)
    assert there.state == NEW
    through(bench, there)
    through(bench, nobody)
    assert there.state == pkw.DONE and bench.nodes[2].mirrored == 1
    assert nobody.state == TIMED_OUT and nobody.finding == SILENT
    assert all([drive.zsw == 0xFB31 for drive in bench.master.turns.drives])


def test_a_mirror_telegram_that_comes_back_otherwise_is_no_answer():
    bench = Bench(nodes(2))
    bench.contact()
    node = bench.nodes[2]
    other = framed(2 | MIRROR, b"\x55" + NET[1:])
    node.answer = lambda characters: (
        other if characters[2] & MIRROR else node.__class__.answer(node, characters)
    )
    mirror = Mirror(2, NET)
    through(bench, mirror)
    assert mirror.state == TIMED_OUT and mirror.finding == BAD_BCC


def test_a_mirror_telegram_is_repeated_as_often_as_any_exchange():
    bench = Bench(nodes(2))
    bench.contact()
    bench.master.retries = 2
    assert len(through(bench, Mirror(9, NET))) == 3


def test_a_mirror_telegram_that_is_over_may_be_aimed_at_another_node():
    """It has zeros then, and everything else is as with a new one."""
    bench = Bench(nodes(2))
    bench.contact()
    bench.master.retries = 2
    mirror = Mirror(9, NET)
    assert (mirror.state, mirror.silent) == (NEW, 0)
    for node, net_count, times in ((9, 12, 3), (8, 10, 3), (2, 12, 1), (1, 4, 3)):
        mirror.aim(node, net_count)
        assert (mirror.state, mirror.silent, mirror.finding) == (NEW, 0, GOOD)
        sent = framed(node | MIRROR, bytes(net_count))
        fitting = [count for count in range(0, 42) if mirror.fits(count)]
        assert fitting == [net_count] and mirror.may_reply_alike()
        assert mirror.node == node and bytes(mirror.request[: mirror.size]) == sent
        assert repr(mirror) == "<Mirror to ADR %02X>" % (node | MIRROR)
        assert len(through(bench, mirror)) == times, node
        assert (mirror.state == pkw.DONE) == (times == 1), node
        assert mirror.finding == (GOOD if times == 1 else SILENT), node


def test_a_mirror_telegram_that_comes_back_the_next_time_has_no_finding():
    bench = Bench(nodes(2))
    bench.contact()
    node = bench.nodes[2]
    spoilt = [framed(2 | MIRROR, b"\x55" + NET[1:])]
    node.answer = lambda characters: (
        spoilt.pop()
        if characters[2] & MIRROR and spoilt
        else node.__class__.answer(node, characters)
    )
    mirror = Mirror(2, NET)
    for state, finding in ((TIMED_OUT, BAD_BCC), (pkw.DONE, GOOD)):
        through(bench, mirror)
        assert mirror.state == state and mirror.finding == finding


def test_after_a_broadcast_the_drives_have_time_to_take_it():
    """Nobody answers; the line is left alone for the response delay (USS.md 1.5)."""
    bench = Bench(nodes(3))
    bench.contact()
    broadcast = Broadcast((pzd.OFF1, 0x1000), {2: 0xFFFF})
    (telegram,) = through(bench, broadcast)
    assert broadcast.state == pkw.DONE and telegram.characters == TOGETHER
    following = bench.sent[bench.sent.index(telegram) + 1]
    pause_us = following.at - telegram.at - bench.timing.telegram_us(12)
    assert RESPONSE_DELAY_US <= pause_us <= RESPONSE_DELAY_US + 1_000
    assert not any([any(drive.counters[1:]) for drive in bench.master.turns.drives])


def answers(bench, address, net):
    """Somebody answers telegrams to this ADR with these net data."""
    send = bench.send

    def answering(buffer, count):
        send(buffer, count)
        if buffer[2] == address:
            end = bench.now + bench.timing.telegram_us(count - 4)
            bench.talk(framed(address, net), end + 3_000)

    bench.send = answering


def test_a_special_telegram_brings_what_its_node_answers():
    """Of the length that was agreed, or of any."""
    for reply_count, net in ((5, b"hello"), (None, b"hello"), (None, b"x"), (None, bytes(252))):
        bench = Bench(nodes(1))
        bench.contact()
        seen = []
        special = Special(
            9, b"\x01\x02\x03", reply_count, lambda net, count: seen.append(bytes(net[:count]))
        )
        answers(bench, 0x89, net)
        through(bench, special)
        assert special.state == pkw.DONE and seen == [net], (reply_count, net)
        assert bytes(special.reply[: special.reply_count]) == net


def test_a_special_telegram_is_not_answered_by_one_of_another_length():
    for net in (b"hell", b"hello!"):
        bench = Bench(nodes(1))
        bench.contact()
        seen = []
        special = Special(9, b"\x01\x02\x03", 5, lambda net, count: seen.append(net))
        answers(bench, 0x89, net)
        through(bench, special)
        assert special.state == TIMED_OUT and special.finding == BAD_LENGTH
        assert not seen and not special.reply_count


def test_what_comes_after_a_telegram_to_all_is_nobodys_answer():
    """Even if it has the ADR and the length of one."""
    bench = Bench(nodes(1))
    bench.contact()
    seen = []
    answers(bench, 0xA0, b"who")
    for net in (b"\x01\x02\x03", b"\x01\x02"):
        for reply_count in (None, 3):
            special = Special(None, net, reply_count, lambda net, count: seen.append(count))
            through(bench, special)
            assert special.state == pkw.DONE and not seen and not special.reply_count
    broadcast = Broadcast((pzd.OFF1, 0x1000), {2: 0xFFFF})
    assert not any([broadcast.fits(net_count) for net_count in range(253)])


def test_an_ordinary_telegram_outside_the_list_is_done_when_its_node_has_answered():
    bench = Bench(nodes(2))
    bench.contact()
    there, nobody = OutsideTelegram(2, NET), OutsideTelegram(9, NET)
    through(bench, there)
    through(bench, nobody)
    assert there.state == pkw.DONE and bench.nodes[2].mirrored == 0
    assert nobody.state == TIMED_OUT and nobody.finding == SILENT


def test_they_take_every_second_telegram_at_the_most():
    bench = Bench(nodes(2))
    bench.contact()
    singles = [Mirror(address, NET) for address in (1, 2, 1, 2, 1)]
    for single in singles:
        bench.master.turns.post(single)
    sent = len(bench.sent)
    bench.run_until(lambda: singles[-1].state != PENDING)
    addresses = bench.addresses(sent)
    for before, after in zip(addresses, addresses[1:]):
        assert not (before & MIRROR and after & MIRROR), addresses


def test_eight_may_wait_and_each_once():
    bench = Bench(nodes(1))
    bench.contact()
    singles = [Mirror(1, NET) for _ in range(9)]
    for single in singles[:8]:
        bench.master.turns.post(single)
    for single, reason in (
        (singles[8], "8 telegrams wait already"),
        (singles[0], "<Mirror to ADR 41> is pending already"),
    ):
        try:
            bench.master.turns.post(single)
        except RuntimeError as error:
            assert str(error) == reason
            continue
        raise AssertionError("taken")
    bench.run(3_000_000)
    assert [single.state for single in singles] == [pkw.DONE] * 8 + [NEW]
    bench.master.turns.post(singles[0])  # again, now that it is through
    bench.run(300_000)
    assert singles[0].state == pkw.DONE and bench.nodes[1].mirrored == 9


def test_a_bus_without_drives_sends_them_too():
    bench = Bench([Node(4)], listed=False)
    mirror = Mirror(4, NET)
    through(bench, mirror)
    assert mirror.state == pkw.DONE


def test_the_broadcast_that_stops_goes_before_everything():
    bench = Bench(nodes(6))
    bench.contact()
    for address in (2, 3):
        bench.drives[address].start(0x1000)
    bench.run(300_000)
    sent = len(bench.sent)
    bench.drives[1].stop()
    stop_all(bench.master)
    bench.run(500_000)
    telegrams = bench.sent[sent:]
    assert telegrams[0].address == 0x20
    net = telegrams[0].characters[3:-1]
    assert net == b"\x00\x03\x03\x01\x00\x00\x00\x00\x04\x7e\x00\x00", net  # ON and both jogs
    assert set(bench.addresses(sent)[1:3]) == {2, 3}  # and each by a telegram of its own
    assert {bench.stws(address)[-1] for address in range(1, 7)} == {pzd.OFF1}


def test_only_one_telegram_goes_ahead_of_all_others():
    bench = Bench(nodes(2))
    bench.contact()
    first, second = [Broadcast((pzd.OFF1, 0), {2: 0xFFFF}) for _ in range(2)]
    first.ahead = second.ahead = True
    bench.master.turns.post(first)
    try:
        bench.master.turns.post(second)
    except RuntimeError as error:
        assert "ahead of everything already" in str(error)
    else:
        raise AssertionError("taken")
    sent = len(bench.sent)
    stop_all(bench.master)  # its broadcast is not sent either, but each drive is told to stop
    bench.run(500_000)
    assert first.state == pkw.DONE and second.state == NEW
    assert bench.addresses(sent).count(0x20) == 1 and set(bench.addresses(sent)[1:3]) == {1, 2}
    assert len(through(bench, second)) == 1


def test_a_broadcast_says_bit_by_bit_what_is_taken_of_pzd_1_4_and_5():
    """The enable array (appendix of the specification): which places, and these three masks."""
    words = (pzd.OFF1, 0x1000, 0, 0x5678, 0x9ABC)
    request = Broadcast(words, {1: 0x0080, 4: 0x00F0, 5: 0x0F00}).request
    assert request[3:11] == b"\x00\x33\x00\x80\x00\xf0\x0f\x00", request
    assert request[11:-1] == b"\x04\x7e\x10\x00\x00\x00\x56\x78\x9a\xbc", request
    for place in (2, 3, 6):
        refused(Broadcast, words + (0,), {place: 0x00F0})
        assert Broadcast(words + (0,), {place: 0xFFFF}).request[4] == 1 | 1 << place


def test_a_broadcast_to_drives_of_several_layouts_is_refused_and_they_are_stopped():
    for first, second in (((4, 2), (3, 2)), ((4, 2), (4, 4)), ((4, 4), (4, 2))):
        bench = Bench([Node(1, *first), Node(2, *second)])
        bench.contact()
        bench.drives[2].start(0x1000)
        bench.run(300_000)
        text = "Layout(%d, %d) beside Layout(%d, %d): no common broadcast" % (second + first)
        assert refused(stop_all, bench.master) == text
        bench.run(300_000)
        assert 0x20 not in bench.addresses() and bench.nodes[2].zsw == 0xFB31


def test_the_broadcast_that_stops_has_the_words_of_the_drives():
    """Of the only one, too; and where there is none, none is sent."""
    for node in (Node(1), Node(1, 4, 4)):
        bench = Bench([node])
        bench.contact()
        bench.drives[1].start(0x1000)
        bench.run(300_000)
        stop_all(bench.master)
        bench.run(300_000)
        (broadcast,) = [sent for sent in bench.sent if sent.address == 0x20]
        assert len(broadcast.characters) == 12 + 2 * node.pzd_words and node.zsw == 0xFB31
    bench = Bench([])
    stop_all(bench.master)
    bench.run(300_000)
    assert not bench.sent


def test_what_would_start_a_motor_or_is_no_telegram_is_refused():
    starts = refused(Broadcast, (pzd.ON, 0x1000), {1: 0xFFFF, 2: 0xFFFF})
    assert starts == "a broadcast starts no motors: STW 047Fh"
    refused(Broadcast, (pzd.ON,), {1: 0x0001})
    gives_up = refused(Broadcast, (0x0000, 0x1000), {2: 0xFFFF})
    assert gives_up == "STW 0000h gives up control"
    refused(Broadcast, (0x007E, 0x1000), {2: 0xFFFF})
    for jog in (0x057E, 0x067E):
        refused(Broadcast, (jog, 0), {1: 0x0300})
    refused(Broadcast, (pzd.OFF1, 0), {2: 0x00FF})  # a setpoint is taken as a whole
    refused(Broadcast, (pzd.OFF1,) * 16, {16: 0xFFFF})  # PZD16 never
    refused(Broadcast, (pzd.OFF1,) * 17, {2: 0xFFFF})
    refused(Broadcast, (), {})
    refused(Broadcast, (pzd.OFF1, 0), {0: 0xFFFF})
    refused(Broadcast, (pzd.OFF1, 0), {2: 0x1FFFF})
    refused(Broadcast, (pzd.OFF1, 0), {3: 0xFFFF})  # beyond its words
    refused(Mirror, 32)
    refused(Mirror, -1)
    refused(Special, 40, b"\x00")
    refused(Special, -1, b"\x00")
    refused(Mirror, 1, bytes(253))


def test_what_just_is_a_telegram_is_taken():
    """A word that no drive takes over starts nothing; and bit 10 alone keeps control."""
    assert (
        Broadcast((0x0400,), {1: 0x0001}).request[3:]
        == framed(0x20, b"\x00\x03\x00\x01\x00\x00\x00\x00\x04\x00")[3:]
    )
    assert Broadcast((pzd.ON, 0x1000), {2: 0xFFFF}).request[4] == 0x05
    assert Broadcast((pzd.OFF1,) * 16, {15: 0xFFFF}).request[3:5] == b"\x80\x01"
    for node in (0, 31):
        assert Mirror(node).request[:16] == framed(MIRROR | node, bytes(12))
        assert Special(node, b"\x55").request == framed(0x80 | node, b"\x55")
    assert Special(None, b"\x55").request == framed(0xA0, b"\x55")
