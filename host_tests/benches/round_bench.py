# SPDX-License-Identifier: MIT
"""A bus master on a line with nodes of a few lines each, exact to the microsecond.

For the tests of what the bus does: nodes have any layout, are slow, unplugged, answer mirror
telegrams; the line may carry an echo or another master's telegrams. The engine is entered when it
asked to be and when characters have come, and by nobody else: not when a command is given.

    bench = Bench([Node(1), Node(3, pkw_words=3)])
    bench.run(300_000)
    bench.drives[3].start(0x1000)
    bench.run(100_000)
    bench.sent[-1].stw()                # 047Fh
"""

from uss.going_on import master_of
from uss.layout import Layout
from uss.timing import Timing

MASK = (1 << 30) - 1
REFRESH_US = 2_000  # how often the loop comes round

READY, RUNNING = 0xFB31, 0xFB34

BROADCAST, MIRROR = 0x20, 0x40
NEVER = (1 << 30) - 1  # no test takes so long, and more would take heap


def framed(address, net):
    """A telegram around the net data."""
    characters = bytes((2, len(net) + 2, address)) + bytes(net)
    return characters + bytes((exclusive_or(characters),))


def exclusive_or(characters):
    check = 0
    for character in characters:
        check ^= character
    return check


class Node:
    """A drive that does what STW bit 0 says at once.

    pkw_words: 0, 3, 4, or 127, which takes requests of any length and answers with as many words.
    delay_us: silence before its reply, three characters if None.

    follows     whether its status word comes from the control word, or stays what `zsw` is set to
    mirrors     whether it answers mirror telegrams; `mirrored` of them so far
    stw         the last control word
    """

    def __init__(self, address, pkw_words=4, pzd_words=2, delay_us=None):
        self.address = address
        self.pkw_words = pkw_words
        self.pzd_words = pzd_words
        self.delay_us = delay_us
        self.plugged = True
        self.follows = True
        self.mirrors = True
        self.zsw = READY
        self.stw = 0
        self.mirrored = 0

    def answer(self, characters):
        """The reply to a telegram, or None."""
        net_count = len(characters) - 4
        if not self.plugged or exclusive_or(characters) or not self._takes(net_count):
            return None
        if characters[2] == self.address | MIRROR and self.mirrors:
            self.mirrored += 1
            return characters
        if characters[2] != self.address:
            return None
        at = net_count - 2 * self.pzd_words
        net = bytearray(net_count)
        if self.pzd_words:
            self.stw = characters[3 + at] << 8 | characters[4 + at]
            if self.follows:
                self.zsw = RUNNING if self.stw & 0x0401 == 0x0401 else READY
            net[at] = self.zsw >> 8
            net[at + 1] = self.zsw & 0xFF
        return framed(self.address, net)

    def _takes(self, net_count):
        if self.pkw_words == 127:
            return net_count >= 2 * self.pzd_words and not net_count & 1
        return net_count == 2 * (self.pkw_words + self.pzd_words)


class Sent:
    """A telegram of the master: when it began, its characters, how many PZD words are in it."""

    def __init__(self, at, characters, pzd_words):
        self.at = at
        self.characters = characters
        self.address = characters[2]
        self._pzd_words = pzd_words

    def stw(self):
        """Its control word; None where it has none."""
        if not self._pzd_words or self.address > 31:
            return None
        at = len(self.characters) - 1 - 2 * self._pzd_words
        return self.characters[at] << 8 | self.characters[at + 1]

    def task(self):
        """AK of its parameter task."""
        return self.characters[3] >> 4

    def __repr__(self):
        return "<%d %s>" % (self.at, " ".join(["%02X" % each for each in self.characters]))


class Bench:
    """nodes: who is on the line. baud: of it. listed: False leaves them out of the master's list.

    echo: the master hears what it sends. idle_us: a link with interrupts announces characters when
    nothing has come for so long. interrupts: False is a link that has to be looked at. foreseen:
    it knows beforehand when the last stop bit will have left; another one reports that. goes_on:
    it sends by itself what was made ready. mask: of the clock's counter.

    loop        called as often as the main loop comes round
    refreshing  False: the main loop hangs
    entries     instants at which the engine was entered
    went_on     how often the link has sent a telegram by itself
    plan        by which it looks at a reply before that
    """

    def __init__(
        self, nodes, baud=19200, listed=True, echo=False, idle_us=0, interrupts=True,
        foreseen=False, goes_on=False, mask=MASK,
    ):  # fmt: skip
        self.foreseen = foreseen
        self.goes_on = goes_on
        self.went_on = 0
        self._ready = None  # (request, size of the reply, telegram, not before) for `_go_on`
        self._handed = 0  # characters of a reply that `_go_on` has taken
        self._follows = False
        self.timing = Timing(baud)
        self.now = 0
        self.mask = mask
        self.nodes = {node.address: node for node in nodes}
        self.sent = []
        self.echo = echo
        self.interrupts = interrupts
        self.resolution_us = idle_us if interrupts else 5_000
        self.sent_at = 0
        self.received_at = 0
        self.refreshing = True
        self.entries = []
        self.loop = None
        self._idle_us = idle_us
        self._sending_until = None
        self._end_awaited = False
        self.bursts = []  # [start, end, characters] that were not handed over
        self._taken = 0  # characters of the first one that were
        self.due = 0
        self._loop_at = 0
        self.master = master_of(self, self.timing, mask)
        self.drives = {}
        if listed:
            for node in nodes:
                layout = Layout(node.pkw_words, node.pzd_words)
                self.drives[node.address] = self.master.turns.add(node.address, layout)

    # The link.

    def send(self, buffer, count):
        characters = bytes(buffer[:count])
        until = self.now + self.timing.telegram_us(count - 4)
        node = self.nodes.get(characters[2] & 0x1F)
        self.sent.append(Sent(self.now, characters, node.pzd_words if node else 0))
        self._sending_until = until
        self._end_awaited = True
        if self.foreseen:
            self.sent_at = until & self.mask
        if self.echo:
            self.talk(characters, self.now)
        if characters[2] & ~(MIRROR | 0x1F) or not node:
            return
        reply = node.answer(characters)
        if reply:
            delay_us = node.delay_us
            if delay_us is None:
                delay_us = 3 * self.timing.character_us
            self.talk(reply, until + delay_us)

    def sending_us(self, now):
        if self._sending_until is None:
            return 0
        if self.now < self._sending_until:
            return self._sending_until - self.now
        self.sent_at = self._sending_until & self.mask
        self._sending_until = None
        return 0

    def _reports_at(self):
        """When the link calls for the engine the next time; never, when it has to be looked at."""
        if not self.interrupts:
            return NEVER
        reports_at = self._announced_at()
        if self._end_awaited and not self.foreseen:
            reports_at = min(reports_at, self._sending_until)
        return reports_at

    def instruct(self, buffer, says_nothing_new, plan, attention):
        self.plan = plan
        self._instructions = buffer, says_nothing_new, plan, attention

    def prepare(self, request, size, buffer, count, after_us):
        self._ready = request, size, bytes(buffer[:count]), after_us

    def take_back(self):
        self._ready = None

    def follow(self):
        follows, self._follows = self._follows, False
        if follows:
            self._handed = 0
        return follows

    def _go_on(self):
        """A burst is over: look at the reply, and send what was made ready."""
        buffer, says_nothing_new, plan, attention = self._instructions
        (request, size, following, after_us), self._ready = self._ready, None
        if sum(len(characters) for _, _, characters in self.bursts) != size:
            return
        sent_at = self.sent_at
        self._handed = self.receive(buffer, 0)
        if (self.received_at - sent_at) & self.mask < after_us:
            return
        if says_nothing_new(buffer, size, request, plan, attention):
            self.send(following, len(following))
            self.went_on += 1
            self._follows = True

    def receive(self, buffer, at):
        count, self._handed = self._handed, 0
        if count:
            return count
        while self.bursts:
            start, end, characters = self.bursts[0]
            arrived = len(characters)
            if self.interrupts:
                if self.now < self._announced_at() and not count:
                    return -1 if self.now >= start + self.timing.character_us else 0
            else:
                passed_us = max(0, self.now - start)
                arrived = min(arrived, passed_us * self.timing.baud // 11_000_000)
            for index in range(self._taken, arrived):
                if at + count < len(buffer):
                    buffer[at + count] = characters[index]
                    count += 1
                    # One that is looked at says when it was looked at.
                    self.received_at = (end if self.interrupts else self.now) & self.mask
            self._taken = max(arrived, self._taken)
            if arrived < len(characters):
                break
            self.bursts.pop(0)
            self._taken = 0
            if self.interrupts and self.bursts and self.bursts[0][0] - end >= self._idle_us:
                break
        return count

    def talk(self, characters, start=None):
        """Characters of somebody else on the line, from now on or from the instant `start`."""
        start = self.now if start is None else start
        end = start + self.timing.telegram_us(len(characters) - 4)
        self.bursts.append((start, end, bytes(characters)))

    def _announced_at(self):
        """When what is on the line is over, and seen to be."""
        if not self.bursts:
            return NEVER
        end = self.bursts[0][1]
        for index in range(1, len(self.bursts)):  # a slice would take heap in each of its calls
            start, this_end, _ = self.bursts[index]
            if start - end >= self._idle_us:
                break
            end = max(end, this_end)
        return end + self._idle_us

    # Time.

    def run(self, us):
        """Let time pass."""
        self.run_to(self.now + us)

    def run_to(self, until):
        """Let time pass up to the instant; what the engine does at that very instant is done."""
        while True:
            if self.now >= self._loop_at:
                self._loop_at = self.now + REFRESH_US
                if self.refreshing:
                    self.master.refresh(self.now & self.mask)
                if self.loop:
                    self.loop()
            due = min(self.due, self._reports_at())
            if self.now >= due:
                self._enter()
                continue
            if self.now >= until:
                return
            self.now = min(until, due, self._loop_at)

    def _enter(self):
        if self._end_awaited and self.now >= self._sending_until:
            self._end_awaited = False
        ended = None
        if self.interrupts and self.now >= self._announced_at():
            ended = self.bursts[0]
            if self._ready:
                self._go_on()
        wait_us = self.master.poll(self.now & self.mask)
        assert wait_us >= 1
        self.entries.append(self.now)
        if ended and self.bursts and self.bursts[0] is ended:  # it is not announced again
            self.bursts.pop(0)
            self._taken = 0
        self.due = self.now + wait_us

    def run_until(self, condition, limit_us=10_000_000):
        """Let time pass until `condition()`; AssertionError when that takes too long."""
        until = self.now + limit_us
        while not condition():
            assert self.now < until, "it did not come so far"
            self.run_to(min(self.due, self.now + 500))

    def contact(self):
        """Let the master find everybody who is plugged in."""
        drives = [drive for drive in self.master.turns.drives if self.nodes[drive.address].plugged]
        self.run_until(lambda: all([drive.contact for drive in drives]))

    # What was sent.

    def addresses(self, since=0):
        return [telegram.address for telegram in self.sent[since:]]

    def stws(self, address, since=0):
        return [telegram.stw() for telegram in self.sent[since:] if telegram.address == address]

    def rate(self, address, us):
        """Answered telegrams to a drive in the next so many microseconds."""
        good = self.drives[address].counters[0]
        self.run(us)
        return self.drives[address].counters[0] - good
