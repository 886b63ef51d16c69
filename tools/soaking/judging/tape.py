# SPDX-License-Identifier: MIT
"""A tape of the line: every request of the panel as sent, every reply as it arrived whole.

It runs in the panel's interrupt handlers, where nothing may take heap, so it only notes; the judge
plays it back later. It notes a request when it begins, before the line can spoil it, and a reply
at its end, if no character of it was spoilt. How long the telegrams of a drive are it does not
know: it takes any length for a reply.

    tape = Tape(world.wire)
    for row in tape.news(): tape.kind[row], tape.at_us[row], tape.word(row, 0), ...
"""

NEVER = -1_000_000_000_000
LENGTH = 512
HEARD_MAX = 64
ROUNDING_US = 3
BEHIND_BITS = 40
LOOK_US = 8_000  # of a link without interrupts: how often it is looked at
STX = 0x02
NET = 3  # the place of the first net character
FRAME = 4  # characters of a telegram that are not net data
MIRROR = 0x40  # bit of ADR
NODE_MAX = 31
SIZE = 64  # characters of a row: more than the longest telegram of a panel, 10 + 16 words

# A telegram of the panel to a drive, what comes back from the drive that was asked, a telegram of
# the panel that a drive is to send back, that telegram when it has come back, and what is none.
REQUEST, REPLY, MIRRORED, RETURNED, MALFORMED = range(5)


class Tape:
    """Rows of a ring, one for each telegram: `kind`, `at_us` (when it began), `end_us`, `address`,
    `count`, how many net words it has, and these, by `word`. Of a reply also `delay_us`: how long
    after the request it began, and `flawless`: nothing was heard in between, and no character came
    with an error.

    withdrawn_now   by address, whether the program has taken ON back from the drive; of a request,
                  `withdrawn` says whether it had when that began
    left_now      by address, whether a drive was there and has moved; `left` is of a request, too
    telegrams     ever
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
        self.count = bytearray(LENGTH)
        self.withdrawn = bytearray(LENGTH)
        self.withdrawn_now = bytearray(NODE_MAX + 1)
        self.left = bytearray(LENGTH)
        self.left_now = bytearray(NODE_MAX + 1)
        self._data = bytearray(SIZE * LENGTH)
        self.silence_us = [0] * LENGTH
        self.telegrams = 0
        self.sent_us = -1
        self.blurred_us = 0
        self.chance_us = NEVER
        self._heard = bytearray(HEARD_MAX)  # since the request, if it is no whole reply,
        self._heard_count = 0  # so many characters,
        self._heard_us = 0  # until then
        self._asked = -1  # ADR of the last request, and when that was over
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
        while self._played < self.telegrams:
            row = self._played % LENGTH
            self._played += 1
            yield row

    def word(self, row, place):
        """A net word of a telegram. place: from 0 on; from the end: -1 is the last one."""
        at = SIZE * row + 2 * (place if place >= 0 else self.count[row] + place)
        return self._data[at] << 8 | self._data[at + 1]

    def is_blank(self, row):
        """Whether all net data are zeros."""
        at = SIZE * row
        return not any(self._data[at : at + 2 * self.count[row]])

    def too_late(self, address, now_us):
        """If the last telegram is one to this drive and began just now, it should not have."""
        row = (self.telegrams - 1) % LENGTH
        if self.kind[row] == REQUEST and self.address[row] == address:
            if self.at_us[row] == now_us:
                self.withdrawn[row] = 1

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
            self._note(MIRRORED if data[2] & MIRROR else REQUEST, data, count, burst)
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
        is_whole = not burst.garbled and self._fits(data, 0, burst.count) == burst.count
        if self._heard_count or not is_whole:
            self._hear_more(burst, is_whole)
        if not is_whole:
            return
        self._last_reply = self.telegrams % LENGTH
        self._note(RETURNED if self._asked & MIRROR else REPLY, data, burst.count, burst)

    def _fits(self, data, at, end):
        """How long the telegram is that begins there, whole, of the drive that was asked; or 0."""
        if end - at < FRAME + 2 or data[at] != STX or data[at + 2] != self._asked:
            return 0
        count = data[at + 1] + 2
        if count & 1 or not FRAME + 2 <= count <= min(end - at, FRAME + SIZE):
            return 0
        check = 0
        for index in range(at, at + count):
            check ^= data[index]
        return 0 if check else count

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
        for at in range(count):
            size = self._fits(heard, at, count)
            if size and not (is_whole and at + size == count):
                self.chance_us = burst.end_us

    def _note(self, kind, data, count, burst):
        index = self.telegrams % LENGTH
        self.telegrams += 1
        self.at_us[index] = burst.start_us
        self.end_us[index] = burst.end_us
        self.silence_us[index] = burst.silence_us
        delay_us = burst.start_us - self._ended_us
        self.delay_us[index] = delay_us
        self.flawless[index] = burst.errors is None and burst.silence_us + ROUNDING_US >= delay_us
        self.kind[index] = kind
        self.address[index] = address = data[2] & NODE_MAX
        self.withdrawn[index] = self.withdrawn_now[address]
        self.left[index] = self.left_now[address]
        self.count[index] = 0
        net_count = count - FRAME
        is_frame = net_count > 0 and not count & 1 and data[0] == STX and data[1] == count - 2
        if not is_frame or net_count > SIZE or data[2] & ~MIRROR != address:
            self.kind[index] = MALFORMED
            return
        check = 0
        for at in range(count):
            check ^= data[at]
        if check:
            self.kind[index] = MALFORMED
        self.count[index] = net_count >> 1
        row = self._data
        at = SIZE * index
        for place in range(NET, NET + net_count):
            row[at] = data[place]
            at += 1
