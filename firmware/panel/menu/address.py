# SPDX-License-Identifier: MIT
"""Every address, 0...31: whether somebody answers there. SET takes that drive into the list.

The address that is shown is sent mirror telegrams in the lengths of the usual layouts, in the
share of the line's time that silent drives have. No drive acts on them (specification A-5.3).
"""

from micropython import const

from panel import texts
from panel.menu import Entries
from uss.finding.mirror import Mirror
from uss.pkw import DONE, PENDING
from uss.telegram import NODE_MAX

_TRIES = const(2)  # of each length: a telegram may be lost
_FRAME = const(4)  # characters that are not net data
# Net characters -> PKW words beside 2 PZD words. Who takes the first two takes any length.
_LENGTHS = ((10, 3), (12, 4), (4, 0))
_VARIABLE = const(127)


class List(Entries):
    title = texts.ANY_ADDRESS

    def __init__(self, panel, argument):
        Entries.__init__(self, panel, argument)
        self._mirror = Mirror(0, bytes(_LENGTHS[1][0]))
        self._address = -1
        self._row = 0  # of _LENGTHS
        self._tries = 0
        self._answered = []  # PKW words

    def first(self):
        return self.panel.selected.drive.address

    def count(self):
        return NODE_MAX + 1

    def words(self, position):
        if self._is_listed(position):
            what = texts.IN_THE_LIST
        elif position != self._address or self._row < len(_LENGTHS):
            what = texts.ASKS
        else:
            what = texts.ANSWERS if self._answered else texts.NOBODY
        return b"A%-2d %s" % (position, texts.of(what))

    def step(self, position, now_us):
        """Ask the address that is shown."""
        mirror = self._mirror
        if mirror.state == PENDING:
            return
        if position != self._address:
            self._address = position
            self._row = self._tries = 0
            self._answered = []
        elif mirror.node == position and self._tries:
            self._judge(mirror)
        bus = self.panel.bus
        if self._row < len(_LENGTHS) and not self._is_listed(position):
            if not bus.turns.has_command() and not bus.deadlines.silence_wait_us():
                mirror.aim(position, _LENGTHS[self._row][0])
                bus.turns.post(mirror)
                self._tries += 1

    def choose(self, position, now_ms):
        panel = self.panel
        if position != self._address or not self._answered or self._is_listed(position):
            return
        pkw_words = _VARIABLE if len(self._answered) > 1 else self._answered[0]
        panel.close_menu()
        panel.add(position, "mm420/%d" % pkw_words if pkw_words != 4 else "mm420")
        panel.say(now_ms, texts.ADDED)

    def _judge(self, mirror):
        """The telegram is over."""
        is_answered = mirror.state == DONE
        if is_answered:
            self._answered.append(_LENGTHS[self._row][1])
        if is_answered or self._tries >= _TRIES:
            self._row += 1
            self._tries = 0

    def _is_listed(self, address):
        return self.panel.bus.turns.at(address) is not None
