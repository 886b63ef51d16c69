# SPDX-License-Identifier: MIT
"""A tape of the line: every request of the panel as sent, every reply as it arrived whole.

It runs in the panel's interrupt handlers, where nothing may take heap, so it only notes; the judge
plays it back later. It notes a request when it begins, before the line can spoil it, and a reply
at its end, if no character of it was spoilt.

    tape = Tape(world.wire)
    for row in tape.news(): tape.kind[row], tape.at_us[row], ...
"""

from array import array

NEVER = -1_000_000_000_000
LENGTH = 512
HEARD_MAX = 64
ROUNDING_US = 3
BEHIND_BITS = 40
LOOK_US = 8_000  # of a link without interrupts: how often it is looked at
# Of telegrams with 4 PKW and 2 PZD words: this panel speaks no other layout.
STX, LGE, COUNT = 0x02, 0x0E, 16

REQUEST, REPLY, MALFORMED = range(3)


class Tape:
    """Rows of a ring, one for each telegram: `kind`, `at_us` (when it began), `end_us`, `address`,
    and its words. Of a reply also `delay_us`: how long after the request it began, and `flawless`:
    nothing was heard in between, and no character came with an error.

    count         telegrams ever
    sent_us       when the last request began
    blurred_us    the end of the last telegram that somebody talked into
    chance_us     the end of the last characters that are no reply, and whose BCC fits by chance
    """

    name = "the tape"
    is_weather = True  # no station whose wires could break

    def __init__(self, wire):
        self.kind = bytearray(LENGTH)
        self.address = bytearray(LENGTH)
        self.at_us = [0] * LENGTH  # a list: to read an array of "q" takes heap
        self.end_us = [0] * LENGTH
        self.delay_us = [0] * LENGTH
        self.flawless = bytearray(LENGTH)
        self.words = array("H", bytes(2 * 6 * LENGTH))
        self.silence_us = [0] * LENGTH
        self.count = 0
        self.sent_us = -1
        self.blurred_us = 0
        self.chance_us = NEVER
        self._heard = bytearray(HEARD_MAX)  # since the request, if it is no whole reply,
        self._heard_count = 0  # so many characters,
        self._heard_us = 0  # until then
        self._asked = -1  # the address in the last request, and when that was over
        self._ended_us = 0
        self._played = 0
        # What comes so soon behind a reply spoils it: a UART takes both for one.
        self._behind_us = BEHIND_BITS * 1_000_000 // wire.baud + LOOK_US
        self._last_reply = 0
        self._panel_talks = False
        self._talk = wire.talk
        wire.talk = self._tapped
        wire.attach(self)

    def news(self):
        """The rows since the last time, oldest first."""
        while self._played < self.count:
            row = self._played % LENGTH
            self._played += 1
            yield row

    def is_settled(self, row, now_us):
        """Whether nothing can come behind this reply any more that would spoil it."""
        return now_us - self.end_us[row] > self._behind_us

    def _tapped(self, station, data, count):
        is_panel = getattr(station, "is_panel", False)
        self._panel_talks = is_panel
        burst = self._talk(station, data, count)
        self._panel_talks = False
        if is_panel and burst is not None:
            self.sent_us = burst.start_us
            self._asked = data[2]
            self._ended_us = burst.end_us
            self._heard_count = 0
            self._note(REQUEST, data, count, burst)
        return burst

    def watch(self, burst):
        """Of the wire: a burst begins."""
        if not self._panel_talks:
            row = self._last_reply
            if burst.start_us - self.end_us[row] < self._behind_us:
                self.flawless[row] = False

    def hear(self, burst):
        """Of the wire: a burst has ended."""
        if burst.start_us == self.sent_us:
            return
        data = burst.data
        if burst.garbled and data[0] == STX:
            self.blurred_us = burst.end_us
        is_whole = not burst.garbled and burst.count == COUNT and self._fits(data, 0)
        if self._heard_count or not is_whole:
            self._hear_more(burst, is_whole)
        if not is_whole:
            return
        self._last_reply = self.count % LENGTH
        self._note(REPLY, data, COUNT, burst)

    def _fits(self, data, at):
        """Whether what begins there is whole, and from the drive that was asked."""
        if data[at] != STX or data[at + 1] != LGE or data[at + 2] != self._asked:
            return False
        check = 0
        for index in range(at, at + COUNT):
            check ^= data[index]
        return not check

    def _hear_more(self, burst, is_whole):
        """What is spoilt, or comes in pieces: a panel that does not notice the gaps may take it
        for a reply.
        """
        heard, count = self._heard, self._heard_count
        if burst.start_us - self._heard_us > self._behind_us:
            count = 0
        for index in range(min(burst.count, HEARD_MAX - count)):
            heard[count + index] = burst.data[index]
        self._heard_count = count = min(count + burst.count, HEARD_MAX)
        self._heard_us = burst.end_us
        for at in range(count - COUNT + (0 if is_whole else 1)):
            if self._fits(heard, at):
                self.chance_us = burst.end_us

    def _note(self, kind, data, count, burst):
        index = self.count % LENGTH
        self.count += 1
        self.at_us[index] = burst.start_us
        self.end_us[index] = burst.end_us
        self.silence_us[index] = burst.silence_us
        delay_us = burst.start_us - self._ended_us
        self.delay_us[index] = delay_us
        self.flawless[index] = burst.errors is None and burst.silence_us + ROUNDING_US >= delay_us
        self.kind[index] = kind
        if count != COUNT or data[0] != STX or data[1] != LGE or data[2] > 31:
            self.kind[index] = MALFORMED
            return
        check = 0
        for at in range(COUNT):
            check ^= data[at]
        if check:
            self.kind[index] = MALFORMED
        self.address[index] = data[2]
        words = self.words
        at = 6 * index
        words[at] = data[3] << 8 | data[4]
        words[at + 1] = data[5] << 8 | data[6]
        words[at + 2] = data[7] << 8 | data[8]
        words[at + 3] = data[9] << 8 | data[10]
        words[at + 4] = data[11] << 8 | data[12]
        words[at + 5] = data[13] << 8 | data[14]
