# SPDX-License-Identifier: MIT
"""A simulated line that somebody real talks on, through a port: the master of simulated drives.

Two kinds of port. A pty has no line: whatever is written into it arrives at once, so the
simulated wire takes the time that the characters need, and the reply goes out as its characters
are over, every 10 ms, as from an adapter. A real serial port has one: what comes from it has taken
its time already, and the reply is handed over at its beginning.

    wire = Wire(clock, 19200)
    master = PtyMaster(wire, write)     # or PortMaster(wire, write)
    master.received(data)               # what has come, when it comes; clock.follow() before it

The line judges only what a computer can tell. Characters that came together are one burst. A
master that is too fast behind a reply passes for one that has kept the start interval. Behind a
real port, whose adapter may hand over late, a telegram may come in pieces.

A port cannot say that a character came with a wrong parity or stop bit: the line drops such a
character, as does a program that obeys its UART. If somebody writes into a pty faster than a line
could carry it, the rest is lost: nobody has to wait until a simulated line has said it all.
"""

from boards.sim.clock import Event
from boards.sim.line.wire import BURST_LIMIT, Burst

STX = 0x02
WAITS_US = 500_000  # what has come and waits for the line: so much of its time, or one telegram
TELEGRAM_MAX = 256
LATE_US = 20_000  # adapters keep characters back for up to 16 ms
TOGETHER_US = 3_000  # characters that begin no telegram belong together when they are closer
PIECE_US = 10_000  # what is heard in so long is handed over together
ECHO_US = 100_000  # what is sent comes back within so long, or never


class Master:
    """What both have. write(data): to the port, at once. note(burst, from_master, seen): called
    for every telegram, or what else was said, when it is over; seen: what look() answered when it
    began, for things may change until then. lost: characters that the line had no time for.
    """

    name = "panel"  # as the script language calls whoever asks
    is_panel = True

    def __init__(self, wire, write, note=None, look=None):
        self._wire = wire
        self._clock = wire.clock
        self._write = write
        self._note = note
        self._look = look
        self._seen = {}  # burst: what was seen when it began
        self._pending = bytearray()
        self.lost = 0
        wire.attach(self)

    def _begins(self, burst):
        if self._look is not None:
            self._seen[burst] = self._look()

    def _noted(self, burst, from_master):
        if self._note is not None:
            self._note(burst, from_master, self._seen.pop(burst, None))

    def _hand_to_port(self, burst, first, last):
        """Characters first...last - 1, those that are any."""
        heard = bytes(burst.data[first:last])
        errors = burst.errors
        if errors is not None:
            heard = bytes([heard[i] for i in range(len(heard)) if not errors[first + i]])
        if heard:
            self._write(heard)
        return heard


class PtyMaster(Master):
    """Its characters take their time on the wire, one behind the other."""

    def __init__(self, wire, write, note=None, look=None):
        Master.__init__(self, wire, write, note, look)
        self._burst = None  # what it is saying
        self._go_on = Event(self._over)
        self._answered_us = None  # the end of a reply, until it talks
        self._heard = None  # the burst that is being heard
        self._handed_over = 0  # so many of its characters
        self._hand_over = Event(self._hand_over_piece)

    def received(self, data, flaws=None):
        taken = data[: self._room()]
        self.lost += len(data) - len(taken)
        self._pending += taken
        if self._burst is not None:
            self._say_more()
        elif not self._go_on.armed:
            self._begin()

    def watch(self, burst):
        """A drive begins to talk. If two talk at once, the second is handed over at its end."""
        self._begins(burst)
        now_us = self._clock.now_us
        if self._heard is None or self._heard.end_us <= now_us:
            self._heard = burst
            self._handed_over = 0
            self._clock.schedule(self._hand_over, now_us + PIECE_US)

    def hear(self, burst):
        """A drive has talked."""
        self._answered_us = burst.end_us
        self._noted(burst, False)
        first = 0
        if burst is self._heard:
            first, self._heard = self._handed_over, None
            self._clock.cancel(self._hand_over)
        self._hand_to_port(burst, first, burst.count)

    def _hand_over_piece(self):
        burst = self._heard
        arrived = burst.arrived(self._clock.now_us)
        if arrived > self._handed_over:
            self._hand_to_port(burst, self._handed_over, arrived)
            self._handed_over = arrived
        if self._clock.now_us < burst.end_us:
            self._clock.schedule(self._hand_over, self._clock.now_us + PIECE_US)

    def hear_itself(self, burst):
        self._hand_to_port(burst, 0, burst.count)

    def _room(self):
        """For so many characters the line will have time soon."""
        said_us = self._burst.end_us - self._clock.now_us if self._burst is not None else 0
        room = (WAITS_US - said_us) // self._wire.character_us
        return max(max(room, TELEGRAM_MAX) - len(self._pending), 0)

    def _begin(self):
        """Talk, or first let the start interval pass behind a reply."""
        if self._answered_us is not None:
            from_us = self._answered_us + self._wire.start_interval_us
            self._answered_us = None
            if from_us > self._clock.now_us:
                self._clock.schedule(self._go_on, from_us)
                return
        self._say(BURST_LIMIT)

    def _say_more(self):
        """Say more behind the present burst, without a gap; what has no room waits for the end of
        that.
        """
        room = BURST_LIMIT - self._burst.sent_count
        if room:
            self._say(room)

    def _say(self, room):
        count = min(len(self._pending), room)
        begins = self._burst is None
        self._burst = self._wire.talk(self, self._pending, count)
        if begins:
            self._begins(self._burst)
        self._pending = self._pending[count:]
        self._clock.schedule(self._go_on, self._burst.end_us)

    def _over(self):
        burst, self._burst = self._burst, None
        if burst is not None:
            self._noted(burst, True)
        if self._pending:
            self._begin()


class PortMaster(Master):
    """Its characters have been on a line already when they come; replies go onto that line."""

    def __init__(self, wire, write, note=None, look=None):
        Master.__init__(self, wire, write, note, look)
        self._flaws = bytearray()  # of the pending characters, as in Burst.errors
        self._echo = b""
        self._echo_until_us = 0
        self._silence = Event(self._silent)

    def received(self, data, flaws=None):
        """flaws: a flag for every character, as in Burst.errors, or None."""
        data, flaws = self._without_echo(data, flaws or bytes(len(data)))
        if not data:
            return
        self._pending += data
        self._flaws += flaws
        pending = self._pending
        if pending[0] == STX and len(pending) > 1 and len(pending) >= pending[1] + 2:
            self._hand_over()
        else:
            self._clock.schedule(self._silence, self._clock.now_us + self._patience_us())

    def watch(self, burst):
        """A drive begins to talk. The port takes as long for it as the simulated line."""
        self._begins(burst)
        self._echo = self._hand_to_port(burst, 0, burst.count)
        self._echo_until_us = burst.end_us + ECHO_US

    def hear(self, burst):
        self._noted(burst, False)

    def _without_echo(self, data, flaws):
        """Some adapters hear themselves; a drive would take its own reply for a request."""
        count = min(len(data), len(self._echo))
        if data[:count] != self._echo[:count] or self._clock.now_us > self._echo_until_us:
            count = 0
            self._echo = b""
        self._echo = self._echo[count:]
        return data[count:], flaws[count:]

    def _patience_us(self):
        """How long more characters may still belong to what has come."""
        if self._pending[0] != STX:
            return max(self._wire.start_interval_us, TOGETHER_US)
        length = self._pending[1] + 2 if len(self._pending) > 1 else BURST_LIMIT
        return LATE_US + 3 * length * self._wire.character_us // 2

    def _silent(self):
        if self._pending:
            self._hand_over()

    def _hand_over(self):
        """All that is pending was one burst, which is over now."""
        self._clock.cancel(self._silence)
        count = min(len(self._pending), BURST_LIMIT)
        wire = self._wire
        burst = Burst(wire.ends, wire.character_us)
        burst.begin(self._clock.now_us - wire.ends[count - 1], wire.start_interval_us)
        burst.append(self._pending, count)
        burst.errors = self._flaws[:count] if any(self._flaws[:count]) else None
        self._pending = bytearray()
        self._flaws = bytearray()
        self._begins(burst)
        wire.took_place(self, burst)
        self._noted(burst, True)
