# SPDX-License-Identifier: MIT
"""What happens to a real line: interference, bad contacts, bad slaves, mains dips. Seeded.

As `Wire.faults` it gets every telegram; without it the line is perfect, and simulation costs
nothing more. Everything is drawn from one sequence of random numbers, so a run can be repeated.

    faults = LineFaults(wire, Dice(7, 1).random, {"flip": 0.001, "late": 0.01})
    faults.set("noise", 0.5)            # from now on a burst of noise every 2 s
    faults.strike("cut", 5)             # the next reply ends after 5 characters
    faults.log                          # [(at_us, kind, detail), ...], the last 100
    faults.count["flip"]

Characters are changed, lost, doubled or added on the way; all stations hear the same. A telegram
is never heard for longer than it was sent.
"""

from boards.sim.clock import Event
from boards.sim.line.wire import BURST_LIMIT, FRAME, PARITY

# Units of a rate.
PER_CHARACTER = "of the characters"
PER_REPLY = "of the replies"
PER_SECOND = "a second"
PER_HOUR = "an hour"
SWITCH = "on or off"
CHANCES = (PER_CHARACTER, PER_REPLY)

# Kind: what happens, the unit of its rate.
KINDS = {
    "flip": ("one bit of a character is wrong: data, parity or stop bit", PER_CHARACTER),
    "lost": ("a character is not heard", PER_CHARACTER),
    "doubled": ("a character is heard twice", PER_CHARACTER),
    "stray": ("a character that nobody sent comes in between", PER_CHARACTER),
    "late": ("a reply begins too late", PER_REPLY),
    "cut": ("a reply ends before its end", PER_REPLY),
    "foreign": ("a reply says that it is another drive's", PER_REPLY),
    "noise": ("characters that nobody sent, between the telegrams", PER_SECOND),
    "babble": ("a node talks without end for a while", PER_HOUR),
    "wire cut": ("wires to the panel or to a drive break for a while", PER_HOUR),
    "dip": ("the supply of the drives, of the panel or of all fails for a moment", PER_HOUR),
    "twin": ("a second slave has this address as well", SWITCH),
    "echo": ("the panel hears what it sends itself", SWITCH),
}

OF_CHARACTERS = ("flip", "lost", "doubled", "stray")
OF_REPLIES = ("late", "cut", "foreign")
NEVER = 0x3FFFFFFF
AS_IT_FALLS = -1
LOG_LIMIT = 100
ADDRESS_MAX = 31

# Bits of a character that may flip, after the start bit: data, parity, stop.
DATA_BITS = 8
STOP_BIT = 9

# The default range of a fault's size: from, to.
LATE_MS = (5, 120)  # so much later than usual
NOISE_CHARACTERS = (1, 12)
BABBLE_MS = (50, 3_000)
BABBLE_CHARACTERS = (1, 40)
WIRE_CUT_MS = (20, 5_000)
DIP_MS = (20, 3_000)
TWIN_US = (0, 15_000)  # how much later than its twin a drive replies

# Which wires of a station break: (whether it is deaf, whether it is mute).
WAYS = {"both": (True, True), "hears": (True, False), "talks": (False, True)}

# Which supply dips.
SUPPLIES = ("all", "drives", "panel")


class Weather:
    """A talker that is not a station: interference, or a defective node."""

    is_weather = True

    def __init__(self, wire, name):
        self.name = name
        wire.attach(self)

    def hear(self, burst):
        pass


class LineFaults:
    """wire: the line, whose `faults` this becomes. random(low, high): both included.

    rates     {kind: rate} of KINDS: chances 0...1, times a second or an hour; of the switches,
              "echo" True or False, "twin" an address or None
    on_dip    called with (one of SUPPLIES, milliseconds) when a supply dips, inside an event;
              None: supplies never dip
    log       the last 100 faults, oldest first, as (at_us, kind, detail)
    count     {kind: how often it has happened}
    """

    def __init__(self, wire, random, rates=None, on_dip=None):
        self.on_dip = on_dip
        self.count = {kind: 0 for kind in KINDS}
        self.rates = {kind: 0 for kind in KINDS}
        self.rates["twin"] = None
        self._random = random
        self._wire = wire
        self._clock = wire.clock
        self._log = [[0, "", 0] for _ in range(LOG_LIMIT)]
        self._logged = 0
        self._most = {kind: -1 for kind in OF_CHARACTERS + OF_REPLIES}
        # How many characters or replies there are until the next fault of each kind, that one
        # included. For kinds of characters: counted from when `_calm` was `_calm_from`.
        self._left = {kind: NEVER for kind in OF_CHARACTERS + OF_REPLIES}
        self._calm = self._calm_from = NEVER  # so many characters pass before the next fault
        self._struck = {}  # kind: how many characters of the next telegram, or the size of a fault
        self._struck_whose = {}  # kind: whose reply; None: any station's
        self._weather = {}  # name: the talker
        self._noise = bytearray(BURST_LIMIT)
        self._noise_count = 0
        self._cut_names = []
        self._babble_until_us = 0
        self._babble = Event(self._talk_babble)
        self._noise_later = Event(self._talk_noise)
        self._mend = Event(self.mend)
        self._happen = {
            "noise": self._be_noisy,
            "babble": self._begin_babble,
            "wire cut": self._break_wires,
            "dip": self._dip,
        }
        self._alarms = {kind: self._alarm(kind) for kind in self._happen}
        wire.faults = self
        for kind, rate in (rates or {}).items():
            self.set(kind, rate)

    # --- what people do -------------------------------------------------------------------------

    def set(self, kind, rate):
        """Let faults of that kind happen at this rate from now on; 0: none.

        KeyError: no such kind. ValueError: no such rate.
        """
        unit = KINDS[kind][1]
        if kind == "twin":
            rate = None if rate is False else rate
            if rate is not None and not 0 <= rate <= ADDRESS_MAX:
                raise ValueError("a twin has an address from 0 to %d" % ADDRESS_MAX)
        elif rate < 0 or (unit in CHANCES and rate > 1):
            raise ValueError(
                "%s has a rate from 0 %s %s" % (kind, "to 1" if unit in CHANCES else "on", unit)
            )
        self.rates[kind] = rate
        if kind == "echo":
            self._wire.echo = bool(rate)
        elif kind in self._left:
            self._spend()
            self._most[kind] = max(1, round(2 / rate) - 1) if rate else -1
            self._draw(kind)
            self._reckon()
        elif kind in self._alarms:
            self._clock.cancel(self._alarms[kind])
            if rate:
                self._schedule(kind)

    def calm(self):
        """End all faults, and mend what was cut."""
        for kind in KINDS:
            self.set(kind, None if kind == "twin" else 0)
        self._struck.clear()
        self._reckon()
        self._clock.cancel(self._babble)
        self._clock.cancel(self._noise_later)
        self.mend()

    def strike(self, kind, how_much=None, station=None):
        """Make one fault of that kind: now, or to the next telegram that it can happen to.

        how_much: characters ("flip", "lost", "doubled", "stray": so many of the next telegram;
        "cut": the reply keeps so many; "noise"), milliseconds ("late", "babble", "wire cut",
        "dip"), or the address ("foreign"); None: random.
        station: whose reply; None: any station's.
        KeyError: no such kind. ValueError: it is a switch; more characters than a burst holds.
        """
        if KINDS[kind][1] == SWITCH:
            raise ValueError("%s is on or off" % kind)
        if kind == "noise" and how_much is not None and how_much > BURST_LIMIT:
            raise ValueError("noise of %d characters at the most" % BURST_LIMIT)
        if kind in self._happen:
            self._happen[kind](how_much)
            return
        if how_much is None:
            how_much = 1 if kind in OF_CHARACTERS else AS_IT_FALLS
        self._spend()
        self._struck[kind] = how_much
        self._struck_whose[kind] = station
        self._reckon()

    def cut(self, name, way="both"):
        """The wires to a station, "panel" or "drive 3", break until `mend`. way: one of WAYS."""
        deaf, mute = WAYS[way]
        if name not in self._cut_names:
            self._cut_names.append(name)
        self._wire.cut(name, deaf, mute)
        self._note("wire cut", name)

    def mend(self):
        """Mend all wires."""
        self._clock.cancel(self._mend)
        while self._cut_names:
            self._wire.cut(self._cut_names.pop(), False, False)

    @property
    def log(self):
        first = max(0, self._logged - LOG_LIMIT)
        return [tuple(self._log[i % LOG_LIMIT]) for i in range(first, self._logged)]

    # --- telegrams ------------------------------------------------------------------------------

    def talk(self, station, data, count):
        """What `Wire.talk` does while there are faults. No heap for the panel's telegrams."""
        wire = self._wire
        if getattr(station, "is_panel", False) or getattr(station, "is_weather", False):
            return wire.put(station, data, count)
        if self._comes("cut", station):
            count = self._shortened(count)
        if self._comes("foreign", station):
            data = self._readdressed(data, count)
        if self.rates["twin"] is not None and count > 2 and data[2] & 31 == self.rates["twin"]:
            self._answer_twice(data, count)
        if self._comes("late", station):
            return self._postpone(station, data, count)
        return wire.put(station, data, count)

    def _comes(self, kind, station):
        """Whether the next fault of this kind happens to this reply."""
        self._left[kind] -= 1
        if self._left[kind] <= 0:
            self._draw(kind)
            return True
        return kind in self._struck and self._struck_whose[kind] in (None, station)

    def _told(self, kind, low, high):
        """The size that `strike` gave, else a number from low to high."""
        told = self._struck.pop(kind, AS_IT_FALLS)
        return self._random(low, high) if told == AS_IT_FALLS else told

    def _shortened(self, count):
        kept = max(1, min(self._told("cut", 1, max(1, count - 1)), count))
        self._note("cut", kept)
        return kept

    def _readdressed(self, data, count):
        """The reply with another address, and the BCC that fits it."""
        reply = bytearray(data[:count])
        address = self._told("foreign", 0, ADDRESS_MAX)
        if count > 3:
            changed = (reply[2] & ~ADDRESS_MAX | address) ^ reply[2]
            reply[2] ^= changed
            reply[count - 1] ^= changed
            self._note("foreign", address)
        return reply

    def _postpone(self, station, data, count):
        after_ms = self._told("late", *LATE_MS)
        self._note("late", after_ms)
        self._later(after_ms * 1000, station, bytes(data[:count]))

    def _answer_twice(self, data, count):
        after_us = self._random(*TWIN_US)
        self._note("twin", after_us)
        self._later(after_us, self._talker("a second slave"), bytes(data[:count]))

    def _later(self, after_us, station, data):
        def talk():
            if not self._wire.is_talking(station):
                self._wire.put(station, data, len(data))

        self._clock.schedule(Event(talk), self._clock.now_us + after_us)

    # --- characters -----------------------------------------------------------------------------

    def append(self, burst, data, count):
        """Append to a burst what arrives of `count` characters."""
        if count < self._calm and burst.sent is None:
            self._calm -= count
            burst.append(data, count)
            return
        burst.change()
        self._spend()
        for i in range(count):
            burst.carry(data[i])
            self._carry_over(burst, data[i], count - i)
        for kind in OF_CHARACTERS:
            self._struck.pop(kind, 0)
        self._reckon()

    def _carry_over(self, burst, character, rest):
        """Carry one character; `rest` are still to come in this telegram, this one included."""
        ends_us = burst.sent_end_us()
        if self._strikes("stray", rest):
            burst.put(self._random(0, 255), ends_us, 0)
        if self._strikes("lost", rest):
            return
        flags = 0
        if self._strikes("flip", rest):
            bit = self._random(0, STOP_BIT)
            if bit < DATA_BITS:
                character ^= 1 << bit
            flags = FRAME if bit == STOP_BIT else PARITY
        burst.put(character, ends_us, flags)
        if self._strikes("doubled", rest):
            burst.put(character, ends_us, flags)

    def _strikes(self, kind, rest):
        """Whether a fault of this kind happens to this character."""
        self._left[kind] -= 1
        comes = self._left[kind] <= 0
        if comes:
            self._draw(kind)
        told = self._struck.get(kind, 0)
        if told and self._random(1, rest) <= told:
            self._struck[kind] = told - 1
            comes = True
        if comes:
            self._note(kind, rest)
        return comes

    def _draw(self, kind):
        most = self._most[kind]
        self._left[kind] = self._random(1, most) if most > 0 else NEVER

    def _spend(self):
        """Subtract the characters that have passed from what is left of each kind."""
        passed = self._calm_from - self._calm
        for kind in OF_CHARACTERS:
            self._left[kind] -= passed
        self._calm_from = self._calm

    def _reckon(self):
        """Compute how many characters pass before the next fault, so that a good telegram costs
        one comparison."""
        calm = NEVER
        for kind in OF_CHARACTERS:
            if self._left[kind] < calm:
                calm = self._left[kind]
            if kind in self._struck:
                calm = 0
        self._calm = self._calm_from = calm

    # --- the line, and beyond -------------------------------------------------------------------

    def _alarm(self, kind):
        def ring():
            self._schedule(kind)
            self._happen[kind](None)

        return Event(ring)

    def _schedule(self, kind):
        """Schedule the next fault of a kind; on average they come as often as its rate says."""
        period_ms = 1_000 if KINDS[kind][1] == PER_SECOND else 3_600_000
        after_ms = self._random(1, max(1, int(2 * period_ms / self.rates[kind])))
        self._clock.schedule(self._alarms[kind], self._clock.now_us + after_ms * 1000)

    def _talker(self, name):
        if name not in self._weather:
            self._weather[name] = Weather(self._wire, name)
        return self._weather[name]

    def _be_noisy(self, characters):
        """Make noise when the line is silent, and not always at once."""
        self._noise_count = characters or self._random(*NOISE_CHARACTERS)
        pause_us = self._random(0, 4 * self._wire.character_us)
        self._clock.schedule(self._noise_later, self._wire.busy_until_us() + pause_us)

    def _talk_noise(self):
        self._note("noise", self._noise_count)
        self._talk_rubbish(self._talker("noise"), self._noise_count)

    def _talk_rubbish(self, talker, count):
        """Send random characters, every other one with an error. Returns when they end."""
        for i in range(count):
            self._noise[i] = self._random(0, 255)
        burst = self._wire.put(talker, self._noise, count)
        for i in range(count):
            burst.blame(burst.count - count + i, self._random(0, PARITY | FRAME))
        return burst.end_us

    def _begin_babble(self, lasting_ms):
        if lasting_ms is None:
            lasting_ms = self._random(*BABBLE_MS)
        self._note("babble", lasting_ms)
        self._babble_until_us = self._clock.now_us + lasting_ms * 1000
        self._clock.schedule(self._babble, self._clock.now_us)

    def _talk_babble(self):
        talker = self._talker("a babbling node")
        if self._wire.is_talking(talker):  # it still talks, and was told to begin once more
            self._clock.schedule(self._babble, self._clock.now_us + self._wire.character_us)
            return
        ends_us = self._talk_rubbish(talker, self._random(*BABBLE_CHARACTERS))
        if ends_us < self._babble_until_us:
            pause_us = self._random(0, 3 * self._wire.character_us // 2)
            self._clock.schedule(self._babble, ends_us + pause_us)

    def _break_wires(self, lasting_ms):
        names = self._wire.names()
        if not names:
            return  # nothing has any supply
        if lasting_ms is None:
            lasting_ms = self._random(*WIRE_CUT_MS)
        ways = sorted(WAYS)
        self.cut(names[self._random(0, len(names) - 1)], ways[self._random(0, len(ways) - 1)])
        self._clock.schedule(self._mend, self._clock.now_us + lasting_ms * 1000)

    def _dip(self, lasting_ms):
        if lasting_ms is None:
            lasting_ms = self._random(*DIP_MS)
        if self.on_dip is not None:
            self._note("dip", lasting_ms)
            self.on_dip(SUPPLIES[self._random(0, len(SUPPLIES) - 1)], lasting_ms)

    def _note(self, kind, detail):
        self.count[kind] += 1
        row = self._log[self._logged % LOG_LIMIT]
        row[0] = self._clock.now_us
        row[1] = kind
        row[2] = detail
        self._logged += 1
