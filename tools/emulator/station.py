# SPDX-License-Identifier: MIT
"""The transceiver of an emulated panel: TX, RX and driver enable as a station on the wire.

Everybody talks at a rate of its own. The chip's is the one that its UART is set to; what comes at
another one, the UART gets as garbage, and so does a drive what the chip says.

The chip tells a character when it is over, with the instant of its start bit; the world runs so
far behind that the character can still begin on the wire at that instant. What others send goes to
the chip character by character, and is taken back where a collision garbles it or a cut ends it.
As on the `Transceiver` of boards.sim.line.wire, the receiver is off while the
driver is on. It keeps the figures of the line, in nanoseconds of the chip's clock.
"""

from array import array

from boards.sim.clock import Event
from uss.timing import BAUD_RATES

BITS = 11  # of a character
# In bits, after the beginning of the last character: where a chip that drives the line stops for
# the world. The character is over then in the world as well. What others say from then on, the
# chip hears later; what they have said before, it does not hear.
GOES_ON_BITS_PERCENT = 2195
FOLLOWS_BITS_PERCENT = 40  # a later start bit is a gap; the world is that far behind
EDGES_KEPT = 16  # of the driver: more than there are while one character lasts
FIGURES_MAX = 20_000
COMPLAINTS_MAX = 16
UNIT_BAUD = 50  # of a rate in the records
TOLERANCE_PERCENT = 1  # a UART divides its clock: no rate is met exactly

PARITY_WRONG, STOP_WRONG = 1, 2  # flaws of a character
RATE_SHIFT = 2  # its rate stands above them


def rate_of(units):
    """The rate of USS that a chip has set which divides its clock; as it is if none is near."""
    measured = units * UNIT_BAUD
    for baud in BAUD_RATES:
        if 100 * abs(baud - measured) <= TOLERANCE_PERCENT * baud:
            return baud
    return measured


class Figures:
    """What was measured on the line, the first FIGURES_MAX of each kind, in nanoseconds.

    lead_ns       from the driver's on to the first start bit, for every telegram of the chip
    release_ns    from its last stop bit to the driver's off; negative: the driver cut it
    idle_ns       from the last stop bit of another station to the chip's next start bit
    driver        [(at_ns, on)] of its driver enable, since the world began
    heard_ns      when the last character that the chip received was over
    """

    def __init__(self):
        self.clear()

    def clear(self):
        """Forget what was measured so far."""
        self.lead_ns = array("q")
        self.release_ns = array("q")
        self.idle_ns = array("q")
        self.driver = []
        self.heard_ns = None

    @staticmethod
    def note(figures, value):
        if len(figures) < FIGURES_MAX:
            figures.append(value)


class Station:
    """wire: the line. chip: a `Chip`. origin_ns: the chip's time when the world's clock was 0.

    complaints   characters that were no characters, as texts, the first 16
    figures      see `Figures`
    """

    name = "panel"
    has_driver_enable = True
    is_panel = True
    goes_on_percent = GOES_ON_BITS_PERCENT  # 0: the chip stops at each character
    tells_ahead = True  # False: a character is told when it begins

    def __init__(self, wire, chip, origin_ns):
        self.complaints = []
        self.figures = Figures()
        self._wire = wire
        self._clock = wire.clock
        self._chip = chip
        self._origin_ns = origin_ns
        self.tune(wire.baud)
        self._one = bytearray(1)
        self._to_send = []  # (start_ns, byte): told, and not on the wire yet
        self._burst = None  # ours, on the wire
        self._sent_until_ns = 0  # end of the last stop bit, of what was told
        self._begin = Event(self._begun)
        self._rose_ns = None  # when the driver went on, until its telegram has begun
        self._sending = False  # characters came since then
        self._edges = []  # (at_ns, on) of the driver, of late
        self._driving = False
        self._switched = 0  # how often the driver was switched, as far as it was told
        self._coming = None  # the burst of somebody else
        self._coming_us = 0
        self._taken = 0  # how many of its characters have begun, or were told before they did
        self._told = None  # how it was when such were told: see `_state`
        self._told_ends = None  # the ends of its characters, in microseconds after the first start
        self._next = Event(self._receive)
        self._heard_until_ns = None  # the end of what the chip heard last, until it sends
        wire.attach(self)

    # --- from the chip --------------------------------------------------------------------------

    def tune(self, baud):
        """The chip's UART has been set to this rate: told when it is known."""
        self.baud = baud
        self._character_ns = BITS * 1_000_000_000 // baud
        self._gap_ns = FOLLOWS_BITS_PERCENT * 10_000_000 // baud

    def talk_at(self, baud):
        """It talks at this rate now, in the world's time."""
        self._wire.set_rate(self, baud)

    def sent(self, at_ns, byte, flaws):
        """A character left TX; its start bit began at `at_ns`."""
        if flaws:
            self._complain(at_ns, "character %02X with a wrong parity or stop bit" % byte)
        if self._rose_ns is not None:
            Figures.note(self.figures.lead_ns, at_ns - self._rose_ns)
            self._rose_ns = None
        follows = at_ns - self._sent_until_ns <= self._gap_ns
        if not follows and self._heard_until_ns is not None:
            Figures.note(self.figures.idle_ns, at_ns - self._heard_until_ns)
            self._heard_until_ns = None
        self._sending = True
        self._sent_until_ns = at_ns + self._character_ns
        self._to_send.append((at_ns, byte, follows))
        self._put()

    def driver(self, at_ns, on):
        """The driver enable changed: told when it is known, before its turn in the world."""
        if on:
            self._rose_ns = at_ns
            self._sending = False
        elif self._sending:
            Figures.note(self.figures.release_ns, at_ns - self._sent_until_ns)
            self._sending = False
        self._switched += 1
        self._edges = self._edges[1 - EDGES_KEPT :] + [(at_ns, on)]
        if on != self._driving:
            self._driving = on
            Figures.note(self.figures.driver, (at_ns - self._origin_ns, on))

    def drive(self, at_ns, on):
        """The driver enable changes now, in the world's time.

        The wire counts whole microseconds: by them the last stop bit may seem not to be over.
        """
        burst = self._burst
        if not on and burst is not None and at_ns >= self._sent_until_ns:
            ends_us = burst.end_us
            if self._clock.now_us < ends_us <= self._clock.now_us + 2:
                self._clock.schedule(Event(lambda: self._wire.drive(self, False)), ends_us)
                return
        self._wire.drive(self, on)

    def reset(self):
        """The chip has let go of everything: its telegram ends here."""
        self._clock.cancel(self._begin)
        self._clock.cancel(self._next)
        self._wire.detach(self)
        self._to_send = []
        self._burst = None
        self._coming = None
        self._told = None
        self._chip.take_back(self._chip.now_ns)
        self._sending = False
        self._rose_ns = None
        self._heard_until_ns = None
        self._edges = []
        self._wire.attach(self, self.baud)

    def _put(self):
        """Put on the wire what follows the present burst without a gap; the rest waits."""
        while self._to_send:
            at_ns, _, follows = self._to_send[0]
            on_the_wire = self._burst is not None and self._burst.end_us > self._clock.now_us
            if not (follows and on_the_wire):
                if not self._begin.armed:
                    at_us = (at_ns - self._origin_ns) // 1000
                    self._clock.schedule(self._begin, at_us)
                return
            self._talk()

    def _begun(self):
        self._talk()
        self._put()

    def _talk(self):
        at_ns, self._one[0], _ = self._to_send.pop(0)
        try:
            self._burst = self._wire.talk(self, self._one, 1)
        except ValueError as error:  # longer than any telegram
            self._complain(at_ns, error.args[0])

    # --- from the wire --------------------------------------------------------------------------

    def watch(self, burst):
        if self._coming is not None and self._coming.end_us > self._clock.now_us:
            return  # of two talkers at once, the first is heard, garbled
        self._coming = burst
        self._coming_us = burst.start_us
        self._taken = 0
        # Not now: who talks has not put all of its characters there yet.
        self._clock.schedule(self._next, self._clock.now_us)

    def hear(self, burst):
        if burst is self._coming:
            self._coming = None

    def _receive(self):
        """A character begins: the chip will have it when it is over. It is told of all that follow
        as well, in as far as nothing hinders them now.
        """
        burst = self._coming
        at = self._taken
        if burst is None or burst.start_us != self._coming_us or at >= burst.count:
            return
        count = burst.count
        goes_through = (
            self.tells_ahead and burst.ends is burst.even_ends and not self._deaf(burst, at, count)
        )
        last = count if goes_through else at + 1
        self._taken = last
        if goes_through or not self._deaf(burst, at, last):
            for one in range(at, last):
                self._tell(burst, one)
            self._told = self._state(burst)
            self._told_ends = burst.ends
        if last < count:
            self._clock.schedule(self._next, burst.start_us + burst.ends[at])

    def _tell(self, burst, at):
        baud = burst.baud
        ends_ns = self._over_ns(burst.start_us, baud, at + 1)
        self._chip.tell(ends_ns, "C", burst.data[at], baud // UNIT_BAUD << RATE_SHIFT)
        self._hear_until(ends_ns)

    def _hear_until(self, at_ns):
        self._heard_until_ns = at_ns
        self.figures.heard_ns = at_ns - self._origin_ns

    def _deaf(self, burst, first, last):
        """Whether the driver was on, and so the receiver off, during any of these characters."""
        from_ns = self._over_ns(burst.start_us, burst.baud, first)
        until_ns = self._over_ns(burst.start_us, burst.baud, last)
        edges = self._edges
        while len(edges) > 1 and edges[1][0] <= from_ns:
            edges.pop(0)
        return any(on for at_ns, on in edges if at_ns < until_ns)

    def _over_ns(self, start_us, baud, characters):
        """When so many characters are over that follow one another."""
        return self._origin_ns + start_us * 1000 + characters * BITS * 1_000_000_000 // baud

    # What was told before it began

    def revise(self):
        """Before time goes on: if something has happened to what is coming in, the characters that
        were told and have not begun are taken back. They are told when they begin.
        """
        told = self._told
        if told is None:
            return
        burst, start_us, end_us = told[:3]
        now_us = self._clock.now_us
        if now_us >= end_us:
            self._told = None
        elif told != self._state(burst):
            self._told = None
            begun = self._begun_by(now_us - start_us)
            until_ns = self._over_ns(start_us, burst.baud, begun)
            self._chip.take_back(until_ns)
            if self._heard_until_ns is not None:
                self._hear_until(until_ns)
            if burst is self._coming and burst.start_us == start_us:
                self._taken = begun
                self._clock.schedule(self._next, start_us + self._told_ends[begun - 1])

    def _state(self, burst):
        """What changes when something happens to a burst, or to hearing it."""
        return (
            burst, burst.start_us, burst.end_us, burst.count, burst.garbled, self._switched
        )  # fmt: skip

    def _begun_by(self, elapsed_us):
        """How many of the characters that were told have begun so long after the first one.

        One that would begin at this very instant has not.
        """
        ends = self._told_ends
        begun = 1
        while ends[begun - 1] < elapsed_us:
            begun += 1
        return begun

    def _complain(self, at_ns, text):
        if len(self.complaints) < COMPLAINTS_MAX:
            at_us = (at_ns - self._origin_ns) // 1000
            self.complaints.append("at %d: panel: %s" % (at_us, text))
