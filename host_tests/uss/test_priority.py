# SPDX-License-Identifier: MIT
"""A command that matters is in the next telegram on the line, whatever the bus is doing.

Each state of the list is brought about anew for every instant that matters in it: just before,
while and just after the engine is entered, and half way in between. At each of them a stop, the
release of a jog, an acknowledgement or a start is given to one of the drives; then the very next
telegram that begins must carry it.
"""

from round_bench import Bench, Node
from uss import pkw, pzd
from uss.master import AWAITING, DEAD_MAN_US, LISTENING, RESTING, SENDING
from uss.outside import Broadcast, Mirror, Special

WINDOW_US = 50_000  # at 19200 longer than any exchange
SENT = {SENDING, AWAITING}  # phases that every check is to meet
ALL_PHASES = {RESTING, SENDING, AWAITING}

# What may be wanted of a drive: how, and which bits of STW say so: mask, value. A drive without
# contact is sent OFF1 for any of them.
COMMANDS = (  # the first two stop
    (lambda drive: drive.stop(), 0x0401, 0x0400),
    (lambda drive: drive.stop(pzd.OFF3), 0x0405, 0x0400),
    (lambda drive: drive.start(0x1000), 0x040F, 0x040F),
    (lambda drive: drive.acknowledge(), 0x0400, 0x0400),
    (lambda drive: drive.start(0, pzd.JOG_LEFT), 0x0601, 0x0600),
)


def started(nodes=4, **more):
    """A bus in the middle of its work: drive 2 runs, drive 3 jogs."""
    bench = Bench([Node(address) for address in range(1, nodes + 1)], **more)
    bench.contact()
    bench.drives[2].start(0x2000)
    bench.drives[3].start(0, pzd.JOG_RIGHT)
    bench.run(250_000)
    return bench


def reach(bench, condition):
    """Stop at the beginning of the telegram that fulfils it."""
    sent = len(bench.sent)
    bench.run_until(lambda: len(bench.sent) > sent and condition(bench.sent[-1]))
    return bench


def instants_of(prepare, window_us):
    """The instants that matter from the end of `prepare` on."""
    bench = prepare()
    began = bench.now
    bench.entries.clear()
    bench.run(window_us)
    instants = {began, began + window_us}
    before = began
    for entry in bench.entries:
        instants |= {entry - 1, entry, entry + 1, (before + entry) // 2}
        before = entry
    return sorted(each for each in instants if each >= began)


def check(prepare, phases=SENT, window_us=WINDOW_US, late_us=45_000, commands=COMMANDS):
    """Give every command at every instant, in turn to every drive; late_us: until it is sent."""
    seen = set()
    turn = 0
    for instant in instants_of(prepare, window_us):
        for _ in range(4):
            bench = prepare()
            drives = bench.master.turns.drives
            command, mask, value = commands[turn % len(commands)]
            drive = drives[turn // len(commands) % len(drives)]
            turn += 1
            bench.run_to(instant)
            seen.add(bench.master.phase)
            sent = len(bench.sent)
            where = (turn, instant, drive.address, bench.master.phase)
            contact = drive.contact
            command(drive)
            bench.run_until(lambda: len(bench.sent) > sent, 700_000)
            telegram = bench.sent[sent]
            assert telegram.address == drive.address, where + (telegram,)
            assert telegram.at - instant <= late_us, where + (telegram.at - instant,)
            if contact:
                assert telegram.stw() & mask == value, where + (telegram,)
            else:
                assert telegram.stw() & 0x0401 == 0x0400, where + (telegram,)
    assert phases <= seen, (phases, seen)
    print("%d commands" % turn)


# --- the states of the list ---------------------------------------------------------------------


def test_between_two_entries_of_the_list():
    check(started, ALL_PHASES, window_us=4 * 22_000)


def test_when_a_drive_is_silent():
    def prepare():
        bench = started()
        bench.nodes[4].plugged = False
        return reach(bench, lambda telegram: telegram.address == 4)

    check(prepare)


def test_before_a_retry():
    def prepare():
        bench = started()
        bench.master.retries = 2
        bench.nodes[4].plugged = False
        return reach(bench, lambda telegram: telegram.address == 4)

    check(prepare, window_us=100_000)


def test_while_a_dead_drive_is_tried():
    def prepare():
        bench = started()
        bench.nodes[4].plugged = False
        bench.run(2_500_000)
        return reach(bench, lambda telegram: telegram.address == 4)

    check(prepare)


def test_while_a_mirror_telegram_is_under_way():
    for node in (1, 9):  # one that answers, and one that does not

        def prepare(node=node):
            bench = started()
            bench.master.turns.post(Mirror(node))
            return reach(bench, lambda telegram: telegram.address == node | 0x40)

        check(prepare)


def test_after_a_broadcast():
    def prepare():
        bench = started()
        bench.master.turns.post(Broadcast((pzd.OFF1, 0), {2: 0xFFFF}))
        return reach(bench, lambda telegram: telegram.address == 0x20)

    check(prepare)


def test_while_a_special_telegram_is_under_way():
    def prepare():
        bench = started()
        bench.master.turns.post(Special(9, b"\x12\x34\x56"))
        return reach(bench, lambda telegram: telegram.address == 0x89)

    check(prepare)


def test_before_an_off_is_repeated():
    """Drive 4 does not answer its OFF1; another drive's command goes before its repetitions."""

    def prepare():
        bench = started()
        bench.nodes[4].plugged = False
        bench.drives[4].stop()
        return reach(bench, lambda telegram: telegram.address == 4)

    check(prepare, window_us=100_000)


def test_before_parameters():
    def prepare():
        bench = started()
        for address in (1, 4):
            bench.drives[address].ask(pkw.read(700))  # never answered
            bench.drives[address].want_turns(True)
        return reach(bench, lambda telegram: telegram.task() == 1)

    check(prepare, window_us=100_000)


def test_before_a_turn_for_the_off_time():
    def prepare():
        bench = started(6)
        bench.master.deadlines.supervise(bench.drives[2], 200)
        return reach(bench, lambda telegram: telegram.address == 2)

    check(prepare, window_us=140_000)


def test_while_it_waits_for_the_cycle():
    """It does not wait for the next round; the engine looks for commands meanwhile."""

    def prepare():
        bench = started()
        bench.master.turns.cycle_us = 200_000
        bench.run(500_000)
        return reach(bench, lambda telegram: telegram.address == 4)

    check(prepare, ALL_PHASES, window_us=120_000, late_us=30_000)


def test_in_a_pause():
    def prepare():
        bench = started()
        bench.master.pause()
        bench.run_until(lambda: bench.master.paused)
        return bench

    check(prepare, {RESTING}, window_us=30_000, late_us=7_000)


def test_while_it_listens_at_first():
    """Nothing is sent before it has listened; the first telegram of all is the command's."""
    check(lambda: Bench([Node(1), Node(2)]), {LISTENING}, window_us=99_000, late_us=110_000)


def test_while_it_listens_again():
    def prepare():
        bench = started()
        bench.master.off()
        bench.run(2_000_000)
        bench.master.on()
        bench.run(1_000)
        return bench

    check(prepare, {LISTENING}, window_us=90_000, late_us=410_000)


def test_after_a_failure():
    """The engine has failed once; what it did is to come to its end first."""

    def prepare():
        bench = reach(started(), lambda telegram: telegram.address == 2)
        bench.run(2_000)
        bench.master.recover(bench.now)
        sent = len(bench.sent)
        # It takes ON back from the two that run, which is a command of its own.
        bench.run_until(lambda: len(bench.sent) >= sent + 2)
        return bench

    check(prepare)


def test_on_a_line_with_an_echo():
    check(lambda: started(echo=True, idle_us=1_667))


def test_on_a_link_that_knows_the_end_of_sending_beforehand():
    check(lambda: started(foreseen=True), {RESTING, AWAITING})


def test_on_a_link_that_is_looked_at():
    """It knows late that a reply is over."""
    check(lambda: started(interrupts=False))


def test_when_the_list_was_just_changed():
    def prepare():
        bench = reach(started(), lambda telegram: telegram.address == 1)
        one, two, three, four = bench.master.turns.drives
        bench.master.turns.arrange([four, four, three, one, two, two])
        return bench

    check(prepare)


def test_with_a_queue_of_other_telegrams():
    def prepare():
        bench = started()
        for node in (9, 10, 1, 2, 11, 12):
            bench.master.turns.post(Mirror(node))
        return reach(bench, lambda telegram: telegram.address & 0x40)

    check(prepare, window_us=100_000)


# --- several at once ----------------------------------------------------------------------------


def test_several_commands_go_one_after_the_other_stops_first():
    for instant in instants_of(started, 2 * 22_000):
        bench = started(6)
        bench.run_to(instant)
        sent = len(bench.sent)
        one, two, three, four, five, six = bench.master.turns.drives
        six.start(0x1000)
        five.acknowledge()
        four.stop()  # it stands
        three.stop()  # it jogs
        two.stop()  # it runs
        bench.run_until(lambda: len(bench.sent) >= sent + 5)
        addresses = bench.addresses(sent)
        assert set(addresses[:2]) == {2, 3}, addresses
        assert addresses[2] == 4 and set(addresses[3:5]) == {5, 6}, addresses


def test_a_stop_takes_the_place_of_the_start_before_it():
    """At every instant: no ON is sent any more once STOP was pressed."""
    for instant in instants_of(started, 2 * 22_000):
        bench = started()
        bench.run_to(instant)
        sent = len(bench.sent)
        bench.drives[1].start(0x1000)
        bench.drives[1].stop()
        bench.run(100_000)
        assert bench.sent[sent].address == 1
        assert set(bench.stws(1, sent)) == {pzd.OFF1}


def test_when_the_master_of_the_loop_is_dead():
    """What it takes back itself goes first too, those that run before all others."""

    def prepare():
        bench = started(8)
        bench.refreshing = False
        return bench

    bench = prepare()
    bench.run(DEAD_MAN_US + 1_000)
    since = len(bench.sent) - 3
    bench.run(150_000)
    offs = [telegram.address for telegram in bench.sent[since:] if telegram.stw() == pzd.OFF1]
    first = [telegram for telegram in bench.sent[since:] if telegram.address in (2, 3)]
    assert {2, 3} <= set(offs[:5]), offs
    assert first[-1].stw() == pzd.OFF1


def test_a_stop_reaches_a_drive_whose_own_exchange_goes_on():
    """Its ON is on the line: the OFF is in the telegram behind it."""
    for offset_us in range(0, 22_000, 333):
        bench = reach(started(), lambda telegram: telegram.address == 2)
        bench.run(offset_us)
        if bench.sent[-1].address != 2:
            continue
        sent = len(bench.sent)
        bench.drives[2].stop()
        bench.run_until(lambda: len(bench.sent) > sent)
        assert bench.sent[sent].address == 2 and bench.sent[sent].stw() == pzd.OFF1


def test_with_31_drives_a_stop_takes_two_exchanges_at_the_most():
    bench = started(31)
    for address in range(20, 32):
        bench.nodes[address].plugged = False
    for step in range(62):
        drive = bench.drives[1 + step * 7 % 31]
        bench.run(31_337)
        began, sent = bench.now, len(bench.sent)
        drive.stop()
        bench.run_until(lambda: len(bench.sent) > sent)
        assert bench.sent[sent].address == drive.address
        assert bench.sent[sent].at - began <= 45_000
        bench.run(400_000)
