# SPDX-License-Identifier: MIT
"""A random hand at everything that a bus offers, and a referee who reads the line.

One number reproduces a run: it is in the message when a rule is broken.
"""

import random

from round_bench import Bench, Node
from uss import pkw, pzd
from uss.master import DEAD_MAN_US, LISTENING, LOST_US, OFF
from uss.outside import Broadcast, Mirror, Special

SEEDS = range(1, 9)
STEPS = 150
LAYOUTS = ((4, 2), (4, 2), (3, 2), (0, 2), (127, 2), (4, 6), (127, 4))
FLAGS = (0x00, 0x20, 0x40, 0x80, 0xA0)  # of ADR; the others do not exist


class Referee:
    """Looks at each telegram when it begins."""

    def __init__(self, bench, seed):
        self.seed = seed
        self.bench = bench
        self.may = dict.fromkeys(bench.drives, False)  # whether ON may be sent to a drive
        self.due = []  # stops that are still to be sent
        self.refreshed_at = 0
        self.judged = 0
        self._send = bench.send
        self._quiet_at = 0
        bench.send = self.send

    def send(self, buffer, count):
        bench = self.bench
        for start, end, _ in bench.bursts:
            if start <= bench.now:
                self._quiet_at = max(self._quiet_at, end)
        self.demand(
            bench.now - self._quiet_at >= bench.timing.start_interval_us - 2, "start interval"
        )
        self._send(buffer, count)
        self._quiet_at = max(self._quiet_at, bench.now + bench.timing.telegram_us(count - 4))
        self.judge(bench.sent[-1])

    def heard(self, end):
        self._quiet_at = max(self._quiet_at, end)

    def judge(self, telegram):
        self.judged += 1
        characters = telegram.characters
        check = 0
        for character in characters:
            check ^= character
        self.demand(not check and characters[1] == len(characters) - 2, "frame")
        self.demand(telegram.address & 0xE0 in FLAGS, "ADR")
        self.demand(self.bench.master.phase not in (LISTENING, OFF), "silence")
        if telegram.address > 31:
            return
        address, stw = telegram.address, telegram.stw()
        self.demand(stw & 0x0400, "bit 10")
        if stw & 0x0301:
            self.demand(self.may[address], "ON without a start")
            alive_us = self.bench.now - self.refreshed_at
            self.demand(alive_us <= DEAD_MAN_US + 1_000, "ON by a dead loop")
        elif address in self.due:
            self.due.remove(address)
        if self.due and address not in self.due:
            self.demand(stw & 0x0301 == 0, "something goes before a stop")

    def demand(self, kept, rule):
        assert kept, "seed %d, at %d: %s" % (self.seed, self.bench.now, rule)


class Hand:
    """Does something random to the bus, again and again."""

    def __init__(self, seed):
        random.seed(seed)
        count = 2 + random.getrandbits(3)
        nodes = [Node(address, *LAYOUTS[self.number(7)]) for address in range(count)]
        for node in nodes:
            node.delay_us = 1_200 + self.number(9_000)
        self.bench = Bench(nodes, echo=bool(self.number(2)), foreseen=bool(self.number(2)))
        self.referee = Referee(self.bench, seed)
        self.bench.loop = self.loop
        self.off = False

    def loop(self):
        """Contact that was lost takes the permission to run with it, as does a hung loop."""
        referee = self.referee
        if self.bench.refreshing:
            referee.refreshed_at = self.bench.now
        for drive in self.bench.master.turns.drives:
            if not drive.contact:
                referee.may[drive.address] = False

    def number(self, below):
        return random.getrandbits(16) % below

    def step(self):
        drives = self.bench.master.turns.drives
        drive = drives[self.number(len(drives))]
        deeds = (
            self.start, self.start, self.stop, self.stop, self.acknowledge, self.jog, self.ask,
            self.plug, self.unplug, self.arrange, self.post, self.settings, self.hang, self.switch,
            self.stop_all, self.pause,
        )  # fmt: skip
        deed = deeds[self.number(len(deeds))]
        if self.off and not self.number(3):
            deed = self.switch
        deed(drive)
        self.bench.run(self.number(60_000) + self.number(4) * self.number(300_000))

    def start(self, drive):
        self.referee.may[drive.address] = not self.off and drive.contact
        drive.start(self.number(0x4000))

    def jog(self, drive):
        self.referee.may[drive.address] = not self.off and drive.contact
        drive.start(0, pzd.JOG_RIGHT)

    def stop(self, drive):
        drive.stop((pzd.OFF1, pzd.OFF2, pzd.OFF3)[self.number(3)])
        self.stopped(drive)

    def stopped(self, drive):
        self.referee.may[drive.address] = False
        if not self.off and drive.address not in self.referee.due:
            self.referee.due.append(drive.address)

    def stop_all(self, drive):
        self.bench.master.stop_all()
        for each in self.bench.master.turns.drives:
            self.stopped(each)

    def acknowledge(self, drive):
        drive.acknowledge()

    def ask(self, drive):
        if drive.layout.pkw_words:
            try:
                drive.ask(pkw.read(self.number(2_000)))
            except RuntimeError:
                pass
        drive.want_turns(bool(self.number(2)))

    def plug(self, drive):
        for node in self.bench.nodes.values():
            node.plugged = True

    def unplug(self, drive):
        self.bench.nodes[drive.address].plugged = False

    def arrange(self, drive):
        turns = self.bench.master.turns
        drives = turns.drives
        turns.arrange(drives + [drive] * self.number(5) + drives[: self.number(3)])

    def post(self, drive):
        singles = (
            Mirror(self.number(32), bytes(drive.layout.net_count)),
            Broadcast((pzd.OFF1, 0x1000), {2: 0xFFFF}),
            Special(self.number(32), b"\x01\x02\x03"),
            Special(None, b"\x01\x02\x03"),
        )
        try:
            self.bench.master.turns.post(singles[self.number(4)])
        except RuntimeError:
            pass

    def settings(self, drive):
        master = self.bench.master
        master.retries = self.number(3)
        master.turns.cycle_us = (0, 0, 100_000, 350_000)[self.number(4)]
        master.deadlines.supervise(drive, (0, 400, 2_000)[self.number(3)])

    def hang(self, drive):
        """The main loop stands still for a while."""
        self.bench.refreshing = False
        self.bench.run(self.number(600_000))
        if self.bench.now - self.referee.refreshed_at > DEAD_MAN_US:
            for address in self.referee.may:
                self.referee.may[address] = False
        self.bench.refreshing = True

    def switch(self, drive):
        self.off = not self.off
        for address in self.referee.may:
            self.referee.may[address] = False
        del self.referee.due[:]
        if self.off:
            self.bench.master.off()
        else:
            self.bench.master.on()

    def pause(self, drive):
        self.bench.master.pause()
        self.bench.run(self.number(100_000))
        self.bench.master.resume()

    def finish(self):
        """Everybody is plugged in, and nothing is wanted any more: all is well in the end."""
        bench = self.bench
        self.plug(None)
        bench.master.turns.cycle_us = 0
        if self.off:
            self.switch(None)
        bench.master.stop_all()
        bench.run(LOST_US * 4)
        for drive in bench.master.turns.drives:
            self.referee.demand(drive.contact and drive.silent == 0, "contact in the end")
            self.referee.demand(bench.nodes[drive.address].zsw == 0xFB31, "stopped in the end")
        good = self.answers()
        bench.run(1_000_000)
        self.referee.demand(self.answers() - good >= 15, "progress in the end")

    def answers(self):
        return sum([drive.counters[0] for drive in self.bench.master.turns.drives])


def test_a_random_hand_breaks_no_rule():
    judged = 0
    for seed in SEEDS:
        hand = Hand(seed)
        for _ in range(STEPS):
            hand.step()
        hand.finish()
        judged += hand.referee.judged
    print("%d telegrams" % judged)
    assert judged > 500 * len(SEEDS)


def test_the_referee_would_notice():
    hand = Hand(1)
    hand.bench.run(300_000)
    hand.bench.drives[0].start(0x1000)  # without his knowledge
    try:
        hand.bench.run(300_000)
    except AssertionError as error:
        assert "ON without a start" in str(error)
        return
    raise AssertionError("not noticed")
