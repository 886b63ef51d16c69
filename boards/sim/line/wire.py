# SPDX-License-Identifier: MIT
"""The RS-485 line: who talks when, exact to the character, and the rules of the line.

It carries characters of 11 bits (8E1) between stations and judges their timing, not their meaning.
A telegram costs one event, at its end: a station that wants to see single characters come in asks
the burst how many have arrived by now. The code that every telegram runs is cut into small
functions: MicroPython takes a frame of more than 11 words from the heap, and searches all of the
heap for a hole.

    wire = Wire(clock, 19200)
    wire.attach(drive)
    wire.talk(drive, reply, 16)
    wire.violations()                   # ["at 1146: ..."] when somebody broke a rule

Every station talks at a rate of its own, most of them at that of the line. Who hears a burst of
another rate, Burst.baud, makes no sense of it: a drive counts noise, a UART gets garbage.

A station has these attributes, all but the first optional:
    hear(burst)         called when somebody else's burst has ended
    watch(burst)        called when it begins
    name                for the texts of the violations
    hear_itself(burst)  called when its own burst has ended, where `Wire.echo` is on
    has_driver_enable   True: Wire.drive switches its driver, and the wire judges that; the
                        transceiver of any other station switches by itself, without fault
    is_panel            True: its telegrams are the panel's in the log
    is_weather          True: it is not a station, but interference; see faults.py

`Wire.faults` may hold an object that every telegram passes through (faults.py). While there is
one, the wire judges only the panel, by what it could hear; breaches that faults of the line forced
are noted apart, in `weather`.
"""

import sys
from array import array
from struct import pack_into

from boards.sim.clock import Event

BURST_LIMIT = 260  # the longest telegram has 256 characters
LOG_TELEGRAMS = 1000
LOG_CHARACTERS = 32768
VIOLATION_LIMIT = 100

# Instants are whole microseconds, and ends of characters are rounded down: a measured silence may
# be this much shorter than the true one.
ROUNDING_US = 1

LONG_AGO_US = -1_000_000  # before the world began the line was quiet for a second

# What a collision changes in each character. No part of it cancels out in the BCC, as an even
# number of inverted characters would. Each of the characters has a framing error.
GARBLE = bytes((181 * i ^ 181 * (i + 1)) & 0xFF for i in range(BURST_LIMIT))

# The errors that a receiver reports of a character, bits of `Burst.errors`.
PARITY, FRAME, OVERRUN = 1, 2, 4

# The panel cannot wait for a node that talks without a pause, because it has to send STOP: after
# so long it may talk into it. A pause counts only if it is longer than the second figure and 4
# characters: a link without interrupts does not see shorter ones.
BABBLE_US = 500_000
BABBLE_PAUSE_US = 20_000

# The rules of the line: the text of each breach. {us} is the figure measured, {start} the start
# interval and {character} one character, all in microseconds.
SHORT_SILENCE = "{name} talks after {us} us of silence, the start interval is {start} us"
COLLISION = "{name} talks while {other} talks, {us} us before the end of its last stop bit"
DRIVER_ON_INTO = "{name} enables its driver while {other} talks, {us} us before its end"
DRIVER_ON_UNDER = "{name} talks while {other} holds its driver enabled, since {us} us"
DRIVER_MISSING = "{name} talks with its driver disabled, {us} us of characters are lost"
DRIVER_CUTS = "{name} disables its driver {us} us before the end of its last stop bit"
DRIVER_EARLY = (
    "{name} has its driver enabled {us} us before the first start bit, allowed are {character} us"
)
DRIVER_LATE = (
    "{name} has its driver enabled {us} us after its last stop bit, allowed are {character} us"
)
DRIVER_IDLE = "{name} has its driver enabled for {us} us without sending"

SILENCE_RULES = (SHORT_SILENCE, COLLISION, DRIVER_ON_INTO)
DRIVER_RULES = (DRIVER_MISSING, DRIVER_CUTS, DRIVER_EARLY, DRIVER_LATE, DRIVER_IDLE)


def start_interval_us(baud):
    """The silence that must precede a telegram: two characters, rounded up."""
    return -(-22_000_000 // baud)


def ends_of_characters(baud):
    """The ends of as many characters as a burst can have, in microseconds after its beginning."""
    return array("i", [(i + 1) * 11_000_000 // baud for i in range(BURST_LIMIT)])


if sys.implementation.name == "micropython":
    # So many characters, in the words of `struct`. To make such a text, or a slice, takes heap.
    _CHARACTERS = tuple(["%ds" % count for count in range(BURST_LIMIT + 1)])

    def copy(data, count, into, at):
        """Copy data[:count] to into[at:], without heap."""
        pack_into(_CHARACTERS[count], into, at, data)

else:

    def copy(data, count, into, at):
        """Copy data[:count] to into[at:]. `struct` takes no memoryview here."""
        into[at : at + count] = data[:count]


class Burst:
    """Characters back to back from one talker. It belongs to the wire, which will use it again.

    data        as received, already garbled if there was a collision
    count       how many characters; a cut burst keeps those that were complete
    errors      None, or bits for each character: PARITY, FRAME, OVERRUN
    start_us    first start bit; end_us: end of the last stop bit, or the cut
    silence_us  how long the line was silent before it
    ends        ends[i] is the end of character i, in microseconds after start_us
    baud        the talker's rate
    even_ends   `ends` of characters back to back
    garbled     another station talked, or held its driver enabled, at the same time
    inside      it began while another station talked
    sent        None, or what left the talker, if faults of the line have changed it
    sent_count  how many characters those were
    """

    def __init__(self, ends, character_us, baud=0):
        self.baud = baud
        self.data = bytearray(BURST_LIMIT)
        self.count = 0
        self.start_us = 0
        self.end_us = 0
        self.silence_us = 0
        self.ends = ends
        self.errors = None
        self.garbled = False
        self.inside = False
        self.sent = None
        self.sent_count = 0
        self._character_us = character_us
        # All that faults need is allocated here, because they strike in interrupt handlers too.
        self.even_ends = ends
        self._own_ends = array("i", ends)
        self._flags = bytearray(BURST_LIMIT)
        self._original = bytearray(BURST_LIMIT)
        self._check = -1
        self._checked = bytearray(BURST_LIMIT)  # the characters that were looked through last
        self._checked_count = 0
        self._last_check = 0

    def begin(self, now_us, silence_us):
        """Begin anew, empty."""
        self.count = 0
        self.sent_count = 0
        self.start_us = now_us
        self.silence_us = silence_us
        self.ends = self.even_ends
        self.errors = None
        self.garbled = False
        self.inside = False
        self.sent = None
        self._check = -1

    def arrived(self, now_us):
        """How many characters are over, stop bit included, at `now_us`."""
        if now_us >= self.end_us:
            return self.count
        elapsed = now_us - self.start_us
        ends = self.ends
        count = 0
        if ends is self.even_ends:
            count = elapsed // self._character_us  # rounded up, so this is never too many
        last = self.count
        while count < last and ends[count] <= elapsed:
            count += 1
        return count

    def append(self, data, count):
        """Append `count` characters."""
        if self.sent is not None:
            self._append_unchanged(data, count)
            return
        at = self.count
        copy(data, count, self.data, at)
        self.count = self.sent_count = count = at + count
        self.end_us = self.start_us + self.even_ends[count - 1]
        if self.garbled:
            self._garble_from(at)

    def cut(self, now_us):
        """End the burst: only the characters that are complete by now were sent."""
        elapsed = now_us - self.start_us
        while self.sent_count and self.even_ends[self.sent_count - 1] > elapsed:
            self.sent_count -= 1
        self.count = self.arrived(now_us)
        self.end_us = now_us

    def garble(self, now_us):
        """Spoil what has not arrived yet."""
        if not self.garbled:
            self._garble_from(self.arrived(now_us))
            self.garbled = True

    def exclusive_or(self):
        """The exclusive or of all characters, computed once for all stations that hear them."""
        check = self._check
        if check < 0:
            if self.count != self._checked_count or self.data != self._checked:
                self._look_through()
            self._check = check = self._last_check
        return check

    def _look_through(self):
        # Mostly a station says again what it has said last, and this is not needed.
        check = 0
        data = self.data
        for i in range(self.count):
            check ^= data[i]
        self._last_check = check
        self._checked_count = self.count
        copy(data, BURST_LIMIT, self._checked, 0)

    def heard_us(self):
        """The end of the last character that can be heard; the burst's start if there is none."""
        return self.start_us + (self.ends[self.count - 1] if self.count else 0)

    # For faults. First call `change`; then for each character `carry`, and `put` for what arrives.

    def change(self):
        """Let what is heard differ from what was sent from now on."""
        if self.sent is not None:
            return
        self.sent = self._original
        for i in range(self.count):
            self._original[i] = self.data[i]
            self._own_ends[i] = self.even_ends[i]
        self.ends = self._own_ends

    def carry(self, character):
        """The talker sends this character; it is heard only if `put` follows."""
        at = self.sent_count
        self._original[at] = character
        self.sent_count = at + 1
        self.end_us = self.start_us + self.even_ends[at]

    def sent_end_us(self):
        """The end of the last character sent, after start_us."""
        return self.even_ends[self.sent_count - 1] if self.sent_count else 0

    def put(self, character, end_us, flags):
        """Let one character be heard. It ends so long after start_us, not before the last one."""
        at = self.count
        if at == BURST_LIMIT:
            return
        if self.garbled:
            character ^= GARBLE[at]
            flags |= FRAME
        self.data[at] = character
        self._own_ends[at] = end_us
        self.count = at + 1
        self._flags[at] = 0
        if flags:
            self.blame(at, flags)

    def _append_unchanged(self, data, count):
        for i in range(count):
            self.carry(data[i])
            self.put(data[i], self.sent_end_us(), 0)

    def blame(self, at, flags):
        """Mark character `at` with these errors."""
        if self.errors is None:
            self.errors = self._flags
            for i in range(BURST_LIMIT):
                self._flags[i] = 0
        self._flags[at] |= flags

    def _garble_from(self, first):
        for i in range(first, self.count):
            self.data[i] ^= GARBLE[i]
            self.blame(i, FRAME)


class _Tap:
    """A station's place on the line: its burst, and its driver if that is switched."""

    def __init__(self, wire, station, baud):
        self.wire = wire
        self.name = getattr(station, "name", "a station")
        self.from_panel = getattr(station, "is_panel", False)
        self.is_weather = getattr(station, "is_weather", False)
        self.deaf = False  # its receiving wire is cut
        self.mute = False  # its sending wire is cut
        self.alone = False  # what it sends reaches no other station
        self.hear = station.hear
        self.watch = getattr(station, "watch", None)
        self.attached_us = wire.clock.now_us
        self.wanted_baud = baud  # from its next telegram on
        self.tune()
        self.talking = False  # the burst is on the line
        self.end = Event(self.ended)
        self.has_driver_enable = getattr(station, "has_driver_enable", False)
        self.hear_itself = getattr(station, "hear_itself", None)
        self.driving = False
        self.driver_on_us = 0
        self.driver_needed_us = 0  # until when the driver had to be enabled
        self.driver_judged = False

    def tune(self):
        """Talk at the rate that is wanted from now on."""
        self.baud = baud = self.wanted_baud
        self.character_us = -(-11_000_000 // baud)
        self.start_interval_us = start_interval_us(baud)
        self.burst = Burst(self.wire.ends_at(baud), self.character_us, baud)

    def ended(self):
        self.wire._ended(self)


class Wire:
    """The line and its referee.

    baud                bits a second, of every station that has no other rate
    character_us        one character, rounded up
    start_interval_us   two characters, rounded up: silence that must precede a telegram (USS
                        specification 5.1.2)
    echo                True: a station that can hears what it sends itself, as on two wires with a
                        receiver that is never off
    log                 the last 1000 telegrams, as they left their talkers
    faults              None, or what has `talk(station, data, count)`, which every telegram passes
                        through, and `append(burst, data, count)`: see faults.py

    It has methods instead of properties: with one property in a class, MicroPython searches for
    `__setattr__` at every assignment to its objects' fields, and these are set in each telegram.
    """

    def __init__(self, clock, baud):
        self.clock = clock
        self.baud = baud
        self.character_us = -(-11_000_000 // baud)
        self.start_interval_us = start_interval_us(baud)
        self.ends = ends_of_characters(baud)
        self._ends_at = {baud: self.ends}
        self.echo = False
        self.log = Log()
        self.faults = None
        self._taps = {}
        self._attached = []
        self._hearing = []  # the stations whose receiving wire is whole
        self._cuts = {}  # name: (deaf, mute)
        self._talkers = 0
        self._drivers = 0
        self._babble_pause_us = max(BABBLE_PAUSE_US, 4 * self.character_us)
        self._idle_since_us = LONG_AGO_US
        self._last_began_us = LONG_AGO_US
        self._busy_since_us = 0  # since then no silence was as long as a start interval
        self._babble_since_us = 0  # since then interference, with what it hit, never paused
        self._babble_until_us = LONG_AGO_US
        self._violations = Book()
        self._weather = Book()

    # Stations

    def attach(self, station, baud=None):
        """Put `station` on the line; it hears the bursts that begin from now on.

        baud: at which it talks, if that is not the rate of the line.
        """
        if station in self._taps:
            raise ValueError("the station is on the line already")
        tap = _Tap(self, station, baud or self.baud)
        self._taps[station] = tap
        # A new list, because a station may come or go while the old one is being walked.
        self._attached = self._attached + [tap]
        tap.deaf, tap.mute = self._cuts.get(tap.name, (False, False))
        if not tap.deaf:
            self._hearing = self._hearing + [tap]

    def detach(self, station):
        """Take `station` off the line; what it is sending is cut."""
        tap = self._taps.get(station)
        if tap is None:
            return
        self.silence(station)
        self.drive(station, False)
        del self._taps[station]
        self._attached = [other for other in self._attached if other is not tap]
        self._hearing = [other for other in self._hearing if other is not tap]

    def set_rate(self, station, baud):
        """`station` talks at this rate from its next telegram on."""
        tap = self._taps.get(station)
        if tap is not None:
            tap.wanted_baud = baud

    def ends_at(self, baud):
        """`ends` at another rate."""
        if baud not in self._ends_at:
            self._ends_at[baud] = ends_of_characters(baud)
        return self._ends_at[baud]

    def cut(self, name, deaf=True, mute=True):
        """Cut the wires to the station of that name, whether or not it is plugged in: it does not
        hear others (deaf), others do not hear it (mute). Both False: mend them.
        """
        self._cuts[name] = (deaf, mute)
        for tap in self._attached:
            if tap.name == name:
                self._cut_wires(tap, deaf, mute)
        self._hearing = [tap for tap in self._attached if not tap.deaf]

    def _cut_wires(self, tap, deaf, mute):
        if mute and not tap.mute:
            needed_us = tap.driver_needed_us
            self._cut(tap)
            tap.driver_needed_us = needed_us  # the station does not notice, and goes on
        if mute != tap.mute and tap.driving:
            self._drivers += -1 if mute else 1
        tap.mute = mute
        if tap.deaf and not deaf:
            tap.attached_us = self.clock.now_us
        tap.deaf = deaf

    # Looking at it

    def names(self):
        """The names of the stations on the line."""
        return [tap.name for tap in self._attached if not tap.is_weather]

    def is_talking(self, station):
        """Whether this station's characters are on their way."""
        tap = self._taps.get(station)
        return tap is not None and tap.burst.end_us > self.clock.now_us

    def busy_until_us(self):
        """When the line falls silent, as far as is known: now, or later."""
        until_us = self.clock.now_us
        for tap in self._attached:
            if tap.talking and not tap.alone:
                until_us = max(until_us, tap.burst.end_us)
        return until_us

    # Talking

    def talk(self, station, data, count):
        """Send data[:count] from now on, characters back to back; the burst ends by itself.

        While the station's own burst is still going, the characters follow it without a gap.
        Returns the Burst, whose end_us says when the last stop bit is over, also if the characters
        do not reach the line; None if the station is not attached.
        ValueError: no characters, or more than a burst holds.
        """
        if self.faults is not None:
            return self.faults.talk(station, data, count)
        return self.put(station, data, count)

    def put(self, station, data, count):
        """As `talk`, after the faults that postpone, shorten or replace a telegram."""
        tap = self._taps.get(station)
        if tap is None:
            return None
        if tap.burst.end_us > self.clock.now_us:
            self._prolong(tap, data, count)
        else:
            self._begin(tap, data, count)
        return tap.burst

    def _begin(self, tap, data, count):
        if not 0 < count <= BURST_LIMIT:
            raise ValueError("a burst has 1...260 characters")
        burst = self._emptied(tap)
        now = burst.start_us
        if tap.has_driver_enable and not tap.driving:
            burst.append(data, count)
            self._miss_driver(tap)
            return
        if not self._talkers and now - self._idle_since_us >= self.start_interval_us:
            self._busy_since_us = now
        if tap.is_weather and now - self._babbled_until_us(now) >= self._babble_pause_us:
            self._babble_since_us = self._busy_since_us
        tap.alone = tap.mute
        if not tap.mute:
            self._judge_start(tap, now)
        if self.faults is None:
            burst.append(data, count)
        else:
            self._append(tap, data, count)
        tap.driver_needed_us = burst.end_us
        tap.driver_judged = False
        tap.talking = True
        self.clock.schedule(tap.end, burst.end_us)
        if not tap.mute:
            self._talkers += 1
            self._announce(tap)

    def _emptied(self, tap):
        """The station's burst, emptied, which begins now."""
        if tap.talking:  # its last burst ends at this very instant
            self._ended(tap)
        if tap.baud != tap.wanted_baud:
            tap.tune()
        now = self.clock.now_us
        silence_us = 0 if self._talkers else now - self._idle_since_us
        tap.burst.begin(now, silence_us)
        return tap.burst

    def _miss_driver(self, tap):
        self._violate(DRIVER_MISSING, tap, tap.burst.end_us - self.clock.now_us)

    def _announce(self, tap):
        burst = tap.burst
        for other in self._hearing:
            if other.watch is not None and other is not tap:
                other.watch(burst)

    def _append(self, tap, data, count):
        if self.faults is None or tap.is_weather:
            tap.burst.append(data, count)
        else:
            self.faults.append(tap.burst, data, count)

    def _prolong(self, tap, data, count):
        burst = tap.burst
        if not 0 < count <= BURST_LIMIT - burst.sent_count:
            raise ValueError("a burst has 1...260 characters")
        self._append(tap, data, count)
        if tap.talking:
            tap.driver_needed_us = burst.end_us
            self.clock.schedule(tap.end, burst.end_us)

    def _judge_start(self, tap, now):
        burst = tap.burst
        if tap.has_driver_enable:
            self._judge_driver(tap, DRIVER_EARLY, now)
        if self._talkers:
            self._settle(now)
        if self._talkers:
            other = self._talker()
            self._violate(COLLISION, tap, other.burst.end_us - now, other)
            self._garble(now)
            burst.garbled = True
            burst.inside = True
        elif burst.silence_us < tap.start_interval_us - ROUNDING_US:
            self._violate(SHORT_SILENCE, tap, burst.silence_us)
        if self._drivers > (1 if tap.driving else 0):
            other = self._driver_but(tap)
            self._violate(DRIVER_ON_UNDER, tap, now - other.driver_on_us, other)
            burst.garbled = True

    def took_place(self, station, burst):
        """`station` has sent this burst on the real line that this wire stands for; it is over.

        The wire does not judge it, and faults do not touch it. burst: one of the caller's, with
        the wire's `ends` or its own.
        """
        burst.baud = self.baud
        self._idle_since_us = burst.end_us
        self._last_began_us = burst.start_us
        self._tell(self._taps[station], burst)

    def silence(self, station):
        """Cut what `station` is sending: its power failed, its plug was pulled, its chip reset.

        The characters that are complete by now were sent; what follows was not.
        """
        tap = self._taps.get(station)
        if tap is not None:
            self._cut(tap)

    def _cut(self, tap):
        burst = tap.burst
        now = self.clock.now_us
        if burst.end_us <= now:
            return
        burst.cut(now)
        tap.driver_needed_us = now
        if tap.talking:
            self._ended(tap)

    def _ended(self, tap):
        self.clock.cancel(tap.end)
        burst = tap.burst
        tap.talking = False
        if not tap.alone:
            self._talkers -= 1
            until_us = burst.end_us
            if burst.sent is not None:  # nothing waits for characters that were lost on the way
                until_us = burst.heard_us() if burst.count else self._idle_since_us
            if until_us > self._idle_since_us:
                self._idle_since_us = until_us
                self._last_began_us = burst.start_us
            if tap.is_weather:
                self._babble_until_us = burst.end_us
        if not burst.sent_count:
            return
        if self.echo and tap.hear_itself is not None:
            tap.hear_itself(burst)
        self._tell(tap, burst)

    def _tell(self, tap, burst):
        """Hand a burst to the log, and to every station that can hear it."""
        self.log.add(burst, tap.from_panel)
        if tap.alone or not burst.count:
            return
        for other in self._hearing:
            # A station that was plugged in meanwhile has missed the beginning.
            if other is not tap and other.attached_us <= burst.start_us:
                other.hear(burst)

    def _settle(self, now):
        """End the bursts that are over at this very instant, although their event is yet to
        come."""
        for tap in self._attached:
            if tap.talking and tap.burst.end_us <= now:
                self._ended(tap)

    def _garble(self, now):
        for tap in self._attached:
            if tap.talking and not tap.alone:
                tap.burst.garble(now)

    def _talker(self):
        for tap in self._attached:
            if tap.talking and not tap.alone:
                return tap

    def _driver_but(self, talker):
        for tap in self._attached:
            if tap.driving and not tap.mute and tap is not talker:
                return tap

    # Driver enable

    def drive(self, station, on):
        """The driver enable of `station`, which announced `has_driver_enable`, goes on or off."""
        tap = self._taps.get(station)
        if tap is None or tap.driving == on:
            return
        now = self.clock.now_us
        tap.driving = on
        if on:
            tap.driver_on_us = now
            tap.driver_needed_us = now
            tap.driver_judged = False
            if tap.mute:
                return
            self._drivers += 1
            if self._talkers:
                self._settle(now)
            if self._talkers:
                other = self._talker()
                self._violate(DRIVER_ON_INTO, tap, other.burst.end_us - now, other)
                self._garble(now)
            return
        if not tap.mute:
            self._drivers -= 1
        if tap.talking and tap.burst.end_us > now:
            self._violate(DRIVER_CUTS, tap, tap.burst.end_us - now)
            self._cut(tap)
        else:
            self._judge_driver(tap, DRIVER_LATE, now)

    def _judge_driver(self, tap, rule, now):
        """The driver is enabled for one character, at the most, before and after what it sends."""
        needless_us = now - tap.driver_needed_us
        if needless_us <= tap.character_us or tap.driver_judged:
            return
        tap.driver_judged = True
        if rule is DRIVER_LATE and tap.driver_needed_us == tap.driver_on_us:
            rule = DRIVER_IDLE
        self._violate(rule, tap, needless_us)

    # The referee's books

    def _violate(self, rule, tap, us, other=None):
        book = self._violations
        if self.faults is not None and self._is_forced(rule, tap):
            book = self._weather
        name = other.name if other is not None else ""
        book.note(self.clock.now_us, rule, tap.name, name, us, tap.baud)

    def _is_forced(self, rule, tap):
        """Whether the faults of the line made a station break a rule.

        All stations but the panel must talk when their time has come. The panel always answers for
        its driver, and for the silence before its telegram as far as it could hear: a station does
        not hear a character before its end. The panel may talk into a node that never stops.
        """
        if not tap.from_panel or tap.deaf:
            return rule not in DRIVER_RULES
        if rule not in SILENCE_RULES:
            return False
        now = self.clock.now_us
        plugged_us = tap.attached_us  # or mended: it does not hear bursts that began before
        heard_us = self._idle_since_us
        if self._last_began_us < plugged_us:
            heard_us = LONG_AGO_US
        for other in self._attached:
            if other.talking and not other.alone and other is not tap:
                burst = other.burst
                arrived = burst.arrived(now)
                if arrived and burst.start_us >= plugged_us:
                    heard_us = max(heard_us, burst.start_us + burst.ends[arrived - 1])
        if now - heard_us >= tap.start_interval_us - ROUNDING_US:
            return True
        quiet_us = now - self._babbled_until_us(now)
        # The panel counts from when it last found the line silent; a shorter pause does not count.
        babble_us = now - self._babble_since_us + BABBLE_PAUSE_US
        return quiet_us < self._babble_pause_us and babble_us >= BABBLE_US

    def _babbled_until_us(self, now):
        """When interference was heard last."""
        for other in self._attached:
            if other.talking and other.is_weather and not other.alone:
                return now
        return self._babble_until_us

    def forgive(self):
        """Forget what was noted so far."""
        self._violations = Book()
        self._weather = Book()

    def violation_count(self):
        """How many breaches were noted."""
        return self._violations.count

    def weather_count(self):
        """How many times faults of the line made a station break a rule."""
        return self._weather.count

    def violations(self):
        """Texts "at <us>: <who> <what, figure>" of the rules broken, the first 100.

        A driver that is enabled for too long is noted when it goes off, or here.
        """
        for tap in self._attached:
            if tap.driving and not tap.talking:
                self._judge_driver(tap, DRIVER_LATE, self.clock.now_us)
        return self._violations.texts()

    def weather(self):
        """Texts as those of `violations`: what faults of the line made stations do."""
        return self._weather.texts()


class Book:
    """What a referee notes: the first 100 breaches, and how many there were."""

    def __init__(self):
        self.count = 0
        self._rows = [[0, None, "", "", 0, 0] for _ in range(VIOLATION_LIMIT)]

    def note(self, at_us, rule, name, other, us, baud):
        # Kept as figures, and made into texts later, because this may run in an interrupt handler.
        if self.count < VIOLATION_LIMIT:
            row = self._rows[self.count]
            row[0] = at_us
            row[1] = rule
            row[2] = name
            row[3] = other
            row[4] = us
            row[5] = baud
        self.count += 1

    def texts(self):
        texts = []
        for at_us, rule, name, other, us, baud in self._rows[: self.count]:
            start_us, character_us = start_interval_us(baud), -(-11_000_000 // baud)
            text = rule.format(
                name=name, other=other, us=us, start=start_us, character=character_us
            )
            texts.append("at %d: %s" % (at_us, text))
        return texts


class Log:
    """The last 1000 telegrams; fewer if they are longer than 32 characters on average.

    Their characters lie one after the other in a ring, so that keeping them takes no heap.
    """

    def __init__(self):
        self._ring = bytearray(LOG_CHARACTERS)
        self._start_us = array("q", [0] * LOG_TELEGRAMS)
        self._length = array("H", [0] * LOG_TELEGRAMS)
        self._from_panel = bytearray(LOG_TELEGRAMS)
        self._next = 0  # where the next telegram's row goes
        self._head = 0  # where its first character goes
        self.count = 0  # telegrams ever

    def add(self, burst, from_panel):
        row = self._next
        self._start_us[row] = burst.start_us
        self._from_panel[row] = from_panel
        self._next = row + 1 if row + 1 < LOG_TELEGRAMS else 0
        self.count += 1
        if burst.sent is None:
            self._length[row] = burst.count
            self._keep(burst.data, burst.count)
        else:
            self._length[row] = burst.sent_count
            self._keep(burst.sent, burst.sent_count)

    def _keep(self, data, count):
        head = self._head
        if head + count < LOG_CHARACTERS:
            copy(data, count, self._ring, head)
            self._head = head + count
            return
        for i in range(count):
            self._ring[head] = data[i]
            head = head + 1 if head + 1 < LOG_CHARACTERS else 0
        self._head = head

    def last(self, n):
        """The last `n` telegrams, oldest first, as tuples (start_us, from_panel, bytes)."""
        telegrams = []
        row = self._next
        end = self._head
        room = LOG_CHARACTERS
        for _ in range(min(n, self.count, LOG_TELEGRAMS)):
            row = row - 1 if row else LOG_TELEGRAMS - 1
            length = self._length[row]
            room -= length
            if room < 0:
                break
            start = (end - length) % LOG_CHARACTERS
            if start <= end:
                characters = self._ring[start:end]
            else:
                characters = self._ring[start:] + self._ring[:end]
            from_panel = bool(self._from_panel[row])
            telegrams.append((self._start_us[row], from_panel, bytes(characters)))
            end = start
        telegrams.reverse()
        return telegrams


class Transceiver:
    """The RS-485 chip that joins a UART and its driver enable pin to the line: one station.

    Receiver and driver share the enable pin, so the UART hears the line while the pin is low, and
    never itself. If the line has `echo`, the receiver is on all the time.
    """

    has_driver_enable = True
    is_panel = True

    def __init__(self, wire, uart, enable_pin, name="panel"):
        self.name = name
        self._wire = wire
        self._clock = wire.clock
        self._uart = uart
        self._deaf = False
        self._burst = None  # the burst that is coming in
        self._taken = 0  # how many of its characters the UART has got
        self._other = None  # a second burst at the same time, which ends later
        wire.attach(self, uart.baud)
        enable_pin.on_change = self._enable
        self._enable(enable_pin.value())
        uart.line = self

    def send(self, data, count):
        """Called by the UART. Returns when the last stop bit will be over, in virtual time."""
        burst = self._wire.talk(self, data, count)
        if self._wire.echo and burst is not self._burst:
            self.watch(burst)
        return burst.end_us

    def unplug(self):
        """Remove the chip: cut what it sends, leave the line."""
        self._uart.line = None
        self._wire.detach(self)

    def _enable(self, on):
        self.collect()
        burst = self._burst
        if burst is not None and not self._wire.echo:
            self._switch_within(burst, on)
        self._deaf = on and not self._wire.echo
        self._wire.drive(self, on)

    def _switch_within(self, burst, on):
        if on and self._taken:
            self._uart.quiet_since(burst.start_us + burst.ends[self._taken - 1])
        if not on and self._taken < burst.count:
            begun_us = burst.ends[self._taken - 1] if self._taken else 0
            if burst.start_us + begun_us < self._clock.now_us:
                self._taken += 1  # the character in which the receiver comes on is lost too

    def watch(self, burst):
        # Of several talkers at once, watch the first one character by character, then the one that
        # lasts longest.
        now = burst.start_us
        if self._burst is None or self._burst is burst or self._burst.end_us <= now:
            self._burst = burst
            self._taken = 0
        elif self._other is None or burst.end_us > self._other.end_us:
            self._other = burst

    def hear(self, burst):
        self.collect()
        if burst is self._burst:
            self._burst = None
            self._take_up_other()
        elif not self._deaf:
            # The second of two talkers comes in as one piece of garbage.
            self._uart.receive(self._understood(burst), 0, burst.count)
        if not self._deaf:
            self._uart.quiet_since(burst.end_us)

    hear_itself = hear

    def _take_up_other(self):
        """One of two talkers has ended: take in what is left of the other one too."""
        other = self._other
        self._other = None
        now = self._clock.now_us
        if other is not None and other.end_us > now and other.start_us < now:
            self._burst = other
            self._taken = other.arrived(now)

    def collect(self):
        """Hand the UART the characters that have arrived by now."""
        burst = self._burst
        if burst is None:
            return
        arrived = burst.arrived(self._clock.now_us)
        if arrived > self._taken:
            if not self._deaf:
                self._uart.receive(self._understood(burst), self._taken, arrived)
            self._taken = arrived

    def _understood(self, burst):
        """The characters that the UART makes of a burst."""
        return burst.data if burst.baud == self._uart.baud else GARBLE

    def receiving(self):
        """Whether a burst is coming in and a character of it has arrived."""
        self.collect()
        return self._burst is not None and self._taken > 0 and not self._deaf
