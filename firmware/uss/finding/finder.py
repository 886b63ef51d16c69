# SPDX-License-Identifier: MIT
"""Finds out how the telegrams of drives are divided that stand in the list and do not answer.

A drive of fixed length answers only telegrams of its own length, and drives are delivered with
different ones: P2013 = 127, 4, 3 or 0 PKW words. So a drive that stays silent is sent mirror
telegrams of the other lengths that it may have with its PZD words (specification A-4.3, A-5.3). It
acts on none of them: their net data are zeros, and so is bit 10 wherever a control word may stand.
Where one comes back, the drive gets that layout by `Turns.relayout`, and the list asks it in it. A
drive of variable length also sends back one that is a word longer.

    finder = Finder(bus, clock.ticks_mask)
    drive = finder.step(clock.ticks_us())   # from the loop, every few milliseconds
    if drive: print(drive.address, drive.layout)

These telegrams take of the time that silent drives share, see `silence`: half of it, a third where
more than seven are silent, so that the list still finds one that is switched on. The silent drives
have them in turn. One that has answered in another length than it was asked in goes first.

How long it takes at the most until the drive is in contact, beside one that runs, when the list
says 4 + 2 words and the drive has another of these layouts; no telegram is lost:

                        9600 baud   19200 baud
    one silent drive    3 s         3 s
    30 of them          45 s        30 s
"""

from micropython import const

# From the bottom of the house up: an import inside an import inside an import takes stack.
from uss.timing import elapsed
from uss.layout import VARIABLE, Layout
from uss.receiver import OTHER_LENGTH, SILENT
from uss.drive import NODES
from uss.pkw import DONE, PENDING
from uss.finding.mirror import Mirror
from uss.master import CLOSED, LISTENING, OFF

SILENT_MIN = const(3)  # telegrams that a drive has not answered before it is looked for,
STOPPED_MIN = const(30)  # and that one which may run has not: first of all it is sent its STOP
TRIES = const(3)  # when something came back, but not the telegram
_SILENCES = const(2)  # after which a drive takes one length only: one may have been lost
_FEW = const(8)  # silent drives; of so many the list asks two for each telegram of these
_UNUSED = const(4)  # the list has let so much room pass, in silent telegrams: it needs none
_PATIENCE_US = const(10_000_000)  # a telegram that is not through by then never will be

_FRAME = const(4)  # characters of a telegram that are not net data
_NET_MAX = const(2 * (4 + 16) + 2)
_WORDS = (3, 4, 0)  # PKW, the most usual first: a drive of variable length takes it as well

# What is done next: `_state`.
_LOOK = const(0)  # look for a silent drive, at one drive in a step
_ASK = const(1)  # send it the next length, as soon as there is room
_AWAIT = const(2)  # see what comes back
_SET = const(3)  # give it the layout that was found


class Finder:
    """bus: the engine, `uss.master.Master`. mask: the clock's period - 1.

    It looks for drives that have no contact and have not answered SILENT_MIN telegrams, or
    STOPPED_MIN where they may run: in the layout that it finds they hear their STOP. A drive in
    contact is left alone; when it falls silent, it is looked for again.
    """

    def __init__(self, bus, mask):
        self._bus = bus
        self._turns = bus.turns
        self._silence = bus.deadlines.silence
        self._mask = mask
        self._state = _LOOK
        self._place = 0  # in the list of drives, of the last one that had its turn;
        self._passed = 0  # so many behind it were looked at,
        self._next = None  # and this is the first of them that is silent
        self._next_place = 0
        self._drive = None  # whose turn it is,
        self._layout = None  # what the bus took for its layout then,
        self._found = 0  # and how many PKW words it has
        self._row = 0  # of _WORDS
        self._answered = 0  # net characters of what came back
        self._tries = 0
        self._mirror = Mirror(0, bytes(_NET_MAX))
        self._posted_at = 0
        self._silences = 0  # `silence.count` after the last one that did not come back
        self._seen = -1  # `silence.count` when no silent drive was found
        self._in_vain = bytearray(NODES)  # by address: it answers, and in no length of these
        self._layouts = {}  # that were found: drives share them

    def step(self, now):
        """Do what is next, which takes no time worth mentioning; answer the drive that has just
        got another layout, or None. Allocates only when it finds something.

        now: reading of the clock in microseconds.
        """
        phase = self._bus.phase
        if phase == LISTENING or phase == OFF or phase == CLOSED:
            return None
        state = self._state
        if state == _LOOK:
            if self._silence.count != self._seen:  # else everybody answers
                self._look()
        elif state == _AWAIT:
            self._await(now)
        elif self._drive.layout is not self._layout or not self._is_lost(self._drive):
            self._state = _LOOK
        elif state == _ASK:
            self._ask(now)
        else:
            return self._set()
        return None

    # --- whose turn it is -----------------------------------------------------------------------

    def _is_lost(self, drive):
        """Whether it is to be looked for."""
        least = STOPPED_MIN if drive.may_run() else SILENT_MIN
        if drive.contact or drive.silent < least:
            return False
        return self._turns.by_address[drive.address] is drive

    def _look(self):
        """At one more drive of the list; when all are through, the first silent one is next."""
        drives = self._turns.drives
        passed = self._passed
        if passed >= len(drives):
            if self._next is not None:
                self._place = self._next_place
                self._begin(self._next)
            else:
                self._seen = self._silence.count
            self._passed = 0
            return
        self._passed = passed + 1
        place = (self._place + 1 + passed) % len(drives)
        drive = drives[place]
        is_there = not drive.contact and drive.trouble == OTHER_LENGTH
        if not is_there:
            self._in_vain[drive.address] = 0
        if not self._is_lost(drive):
            return
        if is_there and not self._in_vain[drive.address]:
            self._begin(drive)  # out of turn
        elif self._next is None:
            self._next = drive
            self._next_place = place

    def _begin(self, drive):
        self._drive = drive
        self._layout = drive.layout
        self._row = self._tries = self._answered = 0
        self._next = None
        self._passed = 0
        self._state = _ASK

    # --- what it answers ------------------------------------------------------------------------

    def _ask(self, now):
        """The next length, or whether it takes a longer one, too."""
        net_count = self._answered + 2
        if not self._answered:
            if self._row >= len(_WORDS):
                self._give_up()
                return
            net_count = 2 * (_WORDS[self._row] + self._layout.pzd_words)
            if not net_count or net_count == self._layout.net_count:
                self._row += 1  # the list asks it in that
                return
        if not self._has_room(net_count):
            return
        self._mirror.aim(self._drive.address, net_count)
        try:
            self._turns.post(self._mirror)
        except RuntimeError:
            return  # others wait already
        self._posted_at = now
        self._state = _AWAIT

    def _has_room(self, net_count):
        """Whether a telegram of this length may be sent now that perhaps nobody answers."""
        silence = self._silence
        if self._turns.has_command() or silence.shared_us != silence.charged_us:
            return False  # what the last one took is not accounted for yet
        if not self._answered:  # it may not even be there
            passed = (silence.count - self._silences) & 0xFFFF
            needed = 1 if silence.resting < _FEW else 2
            if passed < needed and silence.wait_us > -_UNUSED * silence.silent_exchange_us:
                return False
        timing = self._bus.timing
        exchange_us = timing.start_interval_us + timing.telegram_us(net_count)
        exchange_us += timing.reply_timeout_us + timing.character_us
        longer_us = max(exchange_us - silence.silent_exchange_us, 0)
        return self._bus.deadlines.silence_wait_us(longer_us) == 0

    def _await(self, now):
        mirror = self._mirror
        if mirror.state == PENDING:
            if elapsed(now, self._posted_at, self._mask) >= _PATIENCE_US:
                self._mirror = Mirror(0, bytes(_NET_MAX))  # the engine has failed with that one
                self._state = _LOOK
            return
        self._state = _ASK
        if mirror.state == DONE:
            if mirror.node != self._drive.address:
                self._state = _LOOK  # it has another address since
            elif self._answered:
                self._find(VARIABLE)
            else:
                self._answered = mirror.size - _FRAME
                self._tries = 0
            return
        self._silences = self._silence.count
        self._tries += 1
        is_silent = mirror.finding == SILENT
        if self._answered:
            if self._tries >= (_SILENCES if is_silent else TRIES):
                self._find(_WORDS[self._row])
        elif is_silent or self._tries >= TRIES:
            self._row += 1
            self._tries = 0

    def _find(self, pkw_words):
        """It has so many PKW words."""
        self._found = pkw_words
        self._state = _SET
        if pkw_words == self._layout.pkw_words:
            self._give_up()  # it should answer the list

    def _set(self):
        """Nothing is changed before there is memory for it."""
        pzd_words = self._layout.pzd_words
        key = self._found << 5 | pzd_words
        layout = self._layouts.get(key)
        if layout is None:
            self._layouts[key] = layout = Layout(self._found, pzd_words)
        try:
            self._turns.relayout(self._drive, layout)
        except ValueError:  # it answered at the last moment
            self._state = _LOOK
            return None
        self._state = _LOOK
        return self._drive

    def _give_up(self):
        """For this time."""
        self._in_vain[self._drive.address] = 1
        self._state = _LOOK
