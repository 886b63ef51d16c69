# SPDX-License-Identifier: MIT
"""The receive algorithm of the simulated drive, against a machine that sees only characters.

The drive judges a good telegram at one go, because a simulation has to be fast. Here it hears
random lines, with everything that can happen to a line, next to a plain machine of seven states:
both must deliver the same telegrams, count the same errors and show the same error status.
"""

from boards.sim.clock import Clock
from boards.sim.dice import Dice
from boards.sim.drives.slave import BROADCAST, MIRROR, STANDARD, VARIABLE, Slave
from boards.sim.drives.switches import Switches
from boards.sim.line.faults import LineFaults
from boards.sim.line.wire import FRAME, OVERRUN, Wire
from drive_bench import OFF1, telegram

ADDRESS = 3
BAUD = 19200
CHARACTER_US = 573
SEEDS = 70
TELEGRAMS = 40

# r2024...r2031, then the two that no parameter shows.
COUNTERS = (
    "good", "rejected", "frame", "overrun", "parity", "start", "bcc", "length", "residual time",
    "watchdog",
)  # fmt: skip
STATUS_BITS = {
    "frame": 0x01, "overrun": 0x02, "parity": 0x04, "start": 0x08, "bcc": 0x10,
    "residual time": 0x20, "length": 0x40,
}  # fmt: skip

# Silences between the pieces of what is said; none is near a limit of the algorithm.
PAUSES_US = (0, 100, 400, 900, 1_090, 1_200, 1_400, 3_000, 6_000, 13_000, 40_000, 240_000)

# What may happen to the line, from seed to seed.
WEATHER = (
    {},
    {"flip": 0.02},
    {"lost": 0.02, "doubled": 0.02},
    {"stray": 0.02, "flip": 0.005},
    {"noise": 8},
    {"noise": 4, "flip": 0.01, "lost": 0.01, "doubled": 0.01, "stray": 0.01},
    {"babble": 20_000},
)


class Machine:
    """IDLE, LEN, ADR, NET (BCC among it), GAP and SKIP, and timers for the pause and the telegram.

    net: its net characters, None where LGE tells. Instants are whole microseconds: two of them
    make a pause up to 2 us shorter than it was.
    """

    def __init__(self, net, pzd_words, switches):
        self.count = {name: 0 for name in COUNTERS}
        self.delivered = []
        self.status = 0
        self._net = net
        self._least = 2 * pzd_words + 2
        self._switches = switches
        self._state = "IDLE"
        self._last_us = -1_000_000
        self._stx_us = 0
        self._expires_us = None
        self._characters = []
        self._error = 0
        self._adr_error = 0

    def pass_time(self, begins_us, ends_us):
        """Until the next character, which begins and ends then."""
        paused = begins_us - self._last_us >= 22_000_000 // BAUD - 2
        if self._state in ("LEN", "ADR", "NET"):
            if self._state == "ADR" and not self._is_length():
                if paused:  # nobody will know whose it was
                    self._drop("length")
            elif ends_us > self._expires_us or (paused and self._switches.strict_gaps):
                mine = len(self._characters) < 3 or self._is_mine()
                self._drop("residual time", mine, rejected=False)
        if paused and self._state in ("GAP", "SKIP"):
            self._state = "IDLE"

    def take(self, begins_us, ends_us, character, error):
        self.pass_time(begins_us, ends_us)
        self._last_us = max(self._last_us, ends_us)
        if self._state == "GAP":
            self._drop("start")
        elif self._state == "IDLE":
            self._start(ends_us, character, error)
        elif self._state != "SKIP":
            self._characters.append(character)
            self._error = self._error or error
            self._go_on(error)

    def busy(self, ends_us):
        """A second talker: the first one's telegram tells, this one only keeps the line busy."""
        self._last_us = max(self._last_us, ends_us)

    def _start(self, ends_us, character, error):
        if error:
            self._drop(kind_of(error))
        elif character != 0x02:
            self._drop("start")
        else:
            self._characters = [character]
            self._error = 0
            self._stx_us = ends_us
            self._expire_after(252 if self._net is None else self._net)
            self._state = "LEN"

    def _go_on(self, error):
        characters = self._characters
        if self._state == "LEN":
            self._state = "ADR"
            self._adr_error = 0
            if self._net is None and self._is_length():
                self._expire_after(characters[1] - 2)
            return
        if self._state == "ADR":
            self._adr_error = error
            self._state = "NET"
        if not self._is_length():
            self._drop("length", self._is_mine())
        elif len(characters) == characters[1] + 2:
            self._end()

    def _end(self):
        characters = self._characters
        check = 0
        for character in characters:
            check ^= character
        if check:
            self._drop("bcc", self._is_mine())
        elif self._error:
            self._drop(kind_of(self._error), self._is_mine())
        else:
            self._state = "GAP"
            if self._is_mine():
                self.count["good"] += 1
            form = form_of(characters[2])
            if form:
                self.status = 0
                self.delivered.append((form, bytes(characters)))

    def _expire_after(self, net):
        self._expires_us = self._stx_us + -(-(net + 3) * 11 * 1_500_000 // BAUD)

    def _is_length(self):
        lge = self._characters[1]
        if self._net is not None:
            return lge == self._net + 2
        return max(4, self._least) <= lge <= 254 and lge % 2 == 0

    def _is_mine(self):
        """Also when the ADR cannot be told."""
        known = form_of(self._characters[2]) is not None
        return known or self._switches.counts_all or self._adr_error > 0

    def _drop(self, kind, mine=True, rejected=True):
        self._state = "SKIP"
        if mine:
            self.count[kind] += 1
            self.count["rejected"] += rejected
            self.status |= STATUS_BITS[kind]


def kind_of(error):
    if error & FRAME:
        return "frame"
    return "overrun" if error & OVERRUN else "parity"


def form_of(adr):
    """What a telegram with this ADR is to the drive, None: nothing (USS specification A-4.3)."""
    flags = adr >> 5
    if flags == 0b001:
        return BROADCAST
    if adr & 31 != ADDRESS:
        return None
    return {0b000: STANDARD, 0b010: MIRROR}.get(flags)


class Talker:
    name = "talker"

    def __init__(self, wire):
        wire.attach(self)

    def hear(self, burst):
        pass


class Both:
    """The drive's receiver and the machine, at one place of the line."""

    name = "drive"

    def __init__(self, wire, pkw_words, pzd_words, **switches):
        self.switches = Switches(switches)
        self.slave = Slave(wire, self.switches)
        self.slave.address = ADDRESS
        self.slave.pkw_words = pkw_words
        self.slave.pzd_words = pzd_words
        net = None if pkw_words == VARIABLE else 2 * (pkw_words + pzd_words)
        self.machine = Machine(net, pzd_words, self.switches)
        self.delivered = []
        self._inside = []  # ends of what was said into something else
        self.heard = []  # for people, when they disagree
        wire.attach(self)

    def hear(self, burst):
        form = self.slave.hear(burst)
        if form:
            slave = self.slave
            self.delivered.append((form, bytes(slave.telegram[: slave.length])))
        if burst.inside:  # it is over before the one that it spoils, or outlasts it
            self._inside.append(burst.heard_us())
            return
        self._pass_inside(burst.start_us)
        for i in range(burst.count):
            ends_us = burst.start_us + burst.ends[i]
            error = burst.errors[i] if burst.errors else 0
            self.machine.take(ends_us - CHARACTER_US, ends_us, burst.data[i], error)
            self.heard.append((ends_us, burst.data[i], error))
        self._pass_inside(burst.end_us)

    def _pass_inside(self, until_us):
        for ends_us in self._inside:
            if ends_us <= until_us:
                self.machine.busy(ends_us)
        self._inside = [ends_us for ends_us in self._inside if ends_us > until_us]

    def agree(self, now_us):
        self._pass_inside(now_us)
        self.machine.pass_time(now_us, now_us)
        counted = dict(zip(COUNTERS, self.slave.counters()))
        assert self.delivered == self.machine.delivered, self.heard[-60:]
        assert counted == self.machine.count, (counted, self.machine.count, self.heard[-60:])
        assert self.slave.error_status() == self.machine.status


def said(random, words):
    """What somebody says: mostly a telegram, not always a good one."""
    adr = (ADDRESS, ADDRESS, ADDRESS, ADDRESS | 0x40, 0x20, 7, 0x80 | ADDRESS, 0xFF)[random(0, 7)]
    kind = random(0, 9)
    if kind == 0:
        words = random(1, 12)
    data = bytearray(telegram(adr, *[OFF1 if random(0, 1) else 0x0202 for _ in range(words)]))
    if kind == 1:
        data[random(0, len(data) - 1)] ^= 1 << random(0, 7)
    elif kind == 2:
        data = data[: random(1, len(data))]
    elif kind == 3:
        data += bytes([random(0, 255) for _ in range(random(1, 6))])
    elif kind == 4:
        data[1] = random(0, 255)
    return bytes(data)


def run_line(seed, layout, weather, **switches):
    random = Dice(seed).random
    clock = Clock()
    wire = Wire(clock, BAUD)
    talker = Talker(wire)
    both = Both(wire, *layout, **switches)
    if weather:
        LineFaults(wire, Dice(seed, 1).random, weather)
    clock.advance(5_000)
    for _ in range(TELEGRAMS):
        data = said(random, sum(layout) if layout[0] != VARIABLE else random(2, 8))
        if random(0, 2) == 0:  # in pieces
            cut = random(1, len(data))
            pieces = [data[:cut], data[cut:]]
        else:
            pieces = [data]
        for piece in pieces:
            if piece:
                burst = wire.talk(talker, piece, len(piece))
                if random(0, 9) == 0 and burst.count:
                    burst.blame(random(0, burst.count - 1), random(1, 7))
                clock.advance_to(burst.end_us + PAUSES_US[random(0, len(PAUSES_US) - 1)])
        if wire.busy_until_us() == clock.now_us and clock.now_us - burst.end_us >= 3_000:
            both.agree(clock.now_us)
    if wire.faults is not None:
        wire.faults.calm()
    clock.advance(1_000_000)  # longer than any telegram may take
    both.agree(clock.now_us)
    return both


def test_the_drive_hears_what_the_algorithm_hears():
    delivered = 0
    total = {name: 0 for name in COUNTERS}
    for seed in range(1, SEEDS + 1):
        layout = ((4, 2), (3, 2), (0, 2), (VARIABLE, 2), (4, 4), (VARIABLE, 0))[seed % 6]
        weather = WEATHER[seed % len(WEATHER)]
        try:
            both = run_line(
                seed, layout, weather, strict_gaps=seed % 5 == 0, counts_all=seed % 4 == 0
            )
        except AssertionError:
            print("seed", seed)
            raise
        delivered += len(both.delivered)
        for name, count in both.machine.count.items():
            total[name] += count
    assert delivered > 3 * SEEDS, delivered
    for name in COUNTERS[:-1]:  # the watchdog is the drive's
        assert total[name] > SEEDS // 10, total
