# SPDX-License-Identifier: MIT
"""Finds out how the telegrams of drives are divided that stand in the list and do not answer.

A drive of fixed length answers only telegrams of its own length, and drives are delivered with
different ones: P2013 = 127, 4, 3 or 0 PKW words. So a drive that stays silent is sent mirror
telegrams of the other lengths that it may have with its PZD words (specification A-4.3, A-5.3). It
acts on none of them: their net data are zeros, and so is bit 10 wherever a control word may stand.
Where one comes back, the drive gets that layout by `Turns.relayout`, and the list asks it in it. A
drive of variable length also sends back one that is a word longer. Where the length does not tell
the layout, because it is variable or the drive has other PZD words (P2012), the drive is asked:
`enquiry`. Each question carries the OFF that the drive is owed.

A drive may also answer in contact, and its answers make no sense: its survey doubts it. It is
asked what it is as well, if it is seen to stand.

    finder = Finder(bus, clock.ticks_mask)
    drive = finder.step(clock.ticks_us())   # from the loop, every few milliseconds
    if drive: print(drive.address, drive.layout)

These telegrams take of the time that silent drives share, see `silence`: half of it, a third where
more than seven are silent, so that the list still finds one that is switched on. The silent drives
have them in turn. One that has answered in another length than it was asked in goes first.

How long it takes at the most until the drive is in contact, beside one that runs, when the list
says 4 + 2 words and the drive has another of these layouts; no telegram is lost:

                        9600 baud   19200 baud
    one silent drive    4 s         4 s
    30 of them          45 s        30 s

With other PZD words it takes ten times as long, because only one such length is tried in each turn
of a drive, and beside many silent ones only now and then: minutes.
"""

from micropython import const

# From the bottom of the house up: an import inside an import inside an import takes stack.
from uss.timing import elapsed
from uss.layout import VARIABLE, Layout
from uss.receiver import OTHER_LENGTH, SILENT
from uss.drive import NODES, Drive
from uss.pkw import DONE, PENDING
from uss.finding.mirror import Mirror
from uss.master import CLOSED, LISTENING, OFF
from uss.telegram import GOOD

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
_FURTHER = const(3)  # the row behind these: one length with other PZD words, each time the next
_TURNS = const(8)  # where many are silent, it comes after so many turns of a drive
_LEAST_WORDS = const(2)  # of a whole telegram, 0 + 2,
_MOST_WORDS = const(12)  # and 4 + 8
_PZD_MIN = const(2)  # STW and HSW: without them nobody commands a drive

# What is done next: `_state`.
_LOOK = const(0)  # look for a silent drive, at one drive in a step
_ASK = const(1)  # send it the next length, as soon as there is room
_AWAIT = const(2)  # see what comes back
_SET = const(3)  # give it the layout that was found
_ENQUIRE = const(4)  # ask it the next question, as soon as there is room
_HEAR = const(5)  # see what it says


def enquirer(*node):
    """An `enquiry.Enquirer`: that module is not needed before a drive is found."""
    return __import__("uss.finding.enquiry", None, None, ("Enquirer",)).Enquirer(*node)


class Finder:
    """bus: the engine, `uss.master.Master`. mask: the clock's period - 1. enquire: what makes an
    Enquirer, for those who load it in a way of their own.

    It looks for drives that have no contact and have not answered SILENT_MIN telegrams. One that
    may run has not answered STOPPED_MIN, of which those since it was lost said STOP, all that go
    out of turn: in the layout that is found it hears its STOP. A drive in contact is left alone,
    unless its survey doubts it; when it falls silent, it is looked for again.
    """

    def __init__(self, bus, mask, enquire=enquirer):
        self._bus = bus
        self._enquire_by = enquire
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
        self._found = 0  # and its PKW and PZD words, as a key of _layouts
        self._row = 0  # of _WORDS, or _FURTHER
        self._answered = 0  # net characters of what came back
        self._tries = 0
        self._mirror = Mirror(0, bytes(_NET_MAX))
        self._enquirer = None  # while it is asked what it is,
        # and whether it answers late: a telegram of the list, which it may take as well, would get
        # the answer, or keep it from answering; and
        self._is_late = False
        self._telegram = self._mirror  # what is under way
        self._posted_at = 0
        self._silences = 0  # `silence.count` after the last one that did not come back
        self._seen = -1  # `silence.count` when no silent drive was found,
        self._doubts = -1  # and `Drive.doubts`, when none was doubted
        self._doubtful = False  # one of them is, as far as they were looked at
        self._further = bytearray(NODES)  # by address: the next length of _FURTHER, in words,
        self._turns_left = bytearray((_TURNS,) * NODES)  # and after so many turns it comes
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
            # Else everybody answers, and makes sense.
            if self._silence.count != self._seen or Drive.doubts != self._doubts:
                self._look()
        elif state == _AWAIT or state == _HEAR:
            self._await(now, state)
        elif self._drive.layout is not self._layout or not self._is_lost(self._drive):
            self._end()
        elif state == _ASK:
            self._ask(now)
        elif state == _ENQUIRE:
            if self._has_room(self._answered):
                self._post(self._enquirer.question(self._drive.off), now, _HEAR)
        else:
            return self._set()
        return None

    # --- whose turn it is -----------------------------------------------------------------------

    def _is_lost(self, drive):
        """Whether it is to be looked for."""
        if drive.contact:
            if not drive.doubted or drive.may_run():
                return False
        elif drive.silent < SILENT_MIN:
            return False
        elif drive.may_run() and (drive.silent < STOPPED_MIN or drive.is_told_in_vain()):
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
                if not self._doubtful:
                    self._doubts = Drive.doubts
                self._doubtful = False
            self._passed = 0
            return
        self._passed = passed + 1
        place = (self._place + 1 + passed) % len(drives)
        drive = drives[place]
        is_there = drive.doubted if drive.contact else drive.trouble == OTHER_LENGTH
        if drive.doubted:
            self._doubtful = True
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
        if drive.contact:  # its length is known
            self._row = _FURTHER
            self._answered = drive.layout.net_count
        self._next = None
        self._passed = 0
        self._state = _ASK

    # --- what it answers ------------------------------------------------------------------------

    def _ask(self, now):
        """The next length, or whether it takes a longer one, too."""
        net_count = self._answered + 2
        if not self._answered:
            if self._row > _FURTHER:
                self._give_up()
                return
            net_count = self._net_count()
            if not net_count or net_count == self._layout.net_count:
                self._row += 1  # the list asks it in that
                self._choose_further(net_count)
                return
        if not self._has_room(net_count):
            return
        self._mirror.aim(self._drive.address, net_count)
        self._post(self._mirror, now, _AWAIT)

    def _net_count(self):
        """Of the next telegram: one of the usual lengths, then the one of the others whose turn it
        is this time."""
        pzd_words = self._layout.pzd_words
        if self._row < _FURTHER:
            return 2 * (_WORDS[self._row] + pzd_words)
        words = self._further[self._drive.address]
        while words - pzd_words in _WORDS or not _LEAST_WORDS <= words <= _MOST_WORDS:
            words = words + 1 if words < _MOST_WORDS else _LEAST_WORDS
        return 2 * words

    def _post(self, telegram, now, state):
        try:
            self._turns.post(telegram)
        except RuntimeError:
            return  # others wait already
        self._telegram = telegram
        self._posted_at = now
        self._state = state

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

    def _await(self, now, state):
        telegram = self._telegram
        if telegram.state == PENDING:
            if elapsed(now, self._posted_at, self._mask) >= _PATIENCE_US:
                self._mirror = Mirror(0, bytes(_NET_MAX))  # the engine has failed with that one
                self._end()
        elif state == _AWAIT:
            self._state = _ASK
            self._judge(telegram)
        else:
            self._state = _ENQUIRE
            if telegram.state != DONE and telegram.finding == GOOD:
                self._is_late = True
            self._silence.spare(self._drive if self._is_late and self._may_wait(now) else None)
            if self._enquirer.take(telegram):
                self._conclude(self._enquirer.node)
                self._enquirer = None

    def _may_wait(self, now):
        """Whether the list may leave the drive to the enquiry, as far as contact goes."""
        drive = self._drive
        bound_us = self._bus.deadlines.bound_us(drive)
        return not drive.contact or drive.silent_us(now, self._mask) < bound_us

    def _judge(self, mirror):
        """Of the mirror telegram that is over."""
        if mirror.state == DONE:
            if mirror.node != self._drive.address:
                self._end()  # it has another address since
            elif self._answered:
                self._ask_it(True)
            else:
                self._answered = mirror.size - _FRAME
                self._tries = 0
            return
        self._silences = self._silence.count
        self._tries += 1
        is_silent = mirror.finding == SILENT
        if self._answered:
            if self._tries >= (_SILENCES if is_silent else TRIES):
                if self._row < _FURTHER:
                    self._find(_WORDS[self._row], self._layout.pzd_words)
                else:
                    self._ask_it(False)
        elif is_silent or self._tries >= TRIES:
            self._tries = 0
            self._row += 1
            self._choose_further(mirror.size - _FRAME)

    def _choose_further(self, net_count):
        """Whether its turn ends with one of the further lengths, and with which. net_count: of the
        last telegram. Where many are silent, the usual ones matter more."""
        address, row = self._drive.address, self._row
        if row > _FURTHER:
            self._further[address] = (net_count >> 1) + 1
        elif row == _FURTHER:
            left = self._turns_left[address]
            if left and self._silence.resting >= _FEW:
                self._turns_left[address] = left - 1
                self._row = row + 1
            else:
                self._turns_left[address] = _TURNS

    def _ask_it(self, variable):
        """The length does not tell the layout."""
        self._enquirer = self._enquire_by(self._drive.address, self._answered, variable, False)
        self._is_late = False
        self._state = _ENQUIRE

    def _conclude(self, node):
        """It has told its layout, or has nothing to tell it by."""
        layout = node.layout
        if not node.confirmed:
            if self._drive.contact and layout.pkw_words:
                self._give_up()  # the one that it has is as likely
                return
            if node.variable:
                layout = Layout(VARIABLE, self._layout.pzd_words)
        self._find(layout.pkw_words, layout.pzd_words)
        if layout.pzd_words < _PZD_MIN <= self._layout.pzd_words:
            self._give_up()

    def _find(self, pkw_words, pzd_words):
        """It has so many words."""
        self._found = pkw_words << 5 | pzd_words
        self._state = _SET
        if self._layout.pkw_words == pkw_words and self._layout.pzd_words == pzd_words:
            self._give_up()  # it should answer the list

    def _set(self):
        """Nothing is changed before there is memory for it."""
        layout = self._layouts.get(self._found)
        if layout is None:
            self._layouts[self._found] = layout = Layout(self._found >> 5, self._found & 0x1F)
        drive = self._drive
        self._end()
        try:
            self._turns.relayout(drive, layout, drive.doubted)
        except ValueError:  # it answered at the last moment
            return None
        return drive

    def _give_up(self):
        """For this time."""
        drive = self._drive
        self._in_vain[drive.address] = 1
        if drive.doubted:
            drive.doubted = False
        self._end()

    def _end(self):
        self._silence.spare(None)
        self._state = _LOOK
