# SPDX-License-Identifier: MIT
"""Limits what silent drives cost: all of them together at most a fifth of the line's time.

A drive rests as soon as it was silent once, if it has no contact, is not told to run and was not
running when it was seen last. A resting drive has no turn in the round; the resting ones are asked
one after the other. A telegram that nobody answers takes long: itself and the reply time-out. So
the share counts time, not telegrams: after such a telegram the bus waits five times as long as it
took before it sends the next. A drive that answers owes nothing. So when many are switched on at
once, the bus finds them one right after the other.

Drives that run come first: `Deadlines` says whether one more silence leaves them their bound.
"""

from micropython import const

from uss.drive import NODES, SILENT_MAX
from uss.fast import greatest

SHARE = const(5)  # the silent drives have one part in so many
_ROUND_US = const(700_000)  # if few are silent, they are not asked more often than once in this
_OWED_MAX = const(2)  # silences owed at most, or a STOP to many would keep them unasked for long
SPENT_MASK = const(0x3FFFFFFF)  # sums of microseconds wrap so


class Silence:
    """turns: the `Turns` that it belongs to.

    The engine counts the telegrams without a valid reply that went to drives without contact or
    outside the list: `count`, 16 bit; `spent_us`, how long they took; `shared_us`, the same
    without drives that may run, which do not use the share. It writes these three in `charge`.

    `rests`: by address, whether a drive rests. `resting`: how many do. `wait_us`: how long until
    the share has room for one more silence; `Deadlines` counts it down, and below 0 there has been
    room for so long. `charged_us`: how much of `shared_us` is settled. `spared`: see `spare`. The
    loop writes these, and all else.
    """

    def __init__(self, turns):
        self.count = 0
        self.spent_us = 0
        self.shared_us = 0
        self.rests = bytearray(NODES)
        self.resting = 0
        self.wait_us = 0
        self.charged_us = 0
        self.spared = None
        self.silent_exchange_us = 0  # how long a telegram without a reply takes at the most
        self._turns = turns
        self._asked = None  # the drive that was given a turn last
        self._is_asked = False  # it has not had that turn yet
        self._witness = None  # a drive that answers or may run, so that others must rest

    def charge(self, drive, spent_us):
        """From the engine: the drive did not answer, and that took so much of the line's time."""
        self.count = (self.count + 1) & 0xFFFF
        self.spent_us = (self.spent_us + spent_us) & SPENT_MASK
        if drive.outside or not drive.was_running:
            self.shared_us = (self.shared_us + spent_us) & SPENT_MASK

    def list_changed(self, net_count):
        """The list has changed. net_count: net characters of its longest telegram."""
        timing = self._turns.timing
        sending_us = timing.start_interval_us + timing.telegram_us(net_count)
        waiting_us = timing.reply_timeout_us + timing.character_us
        self.silent_exchange_us = sending_us + waiting_us
        self._witness = None

    def forget(self, drive):
        """The drive is not on the bus any more."""
        if self.rests[drive.address]:
            self._set(drive.address, 0)
        if self._asked is drive:
            self._asked = None
            self._is_asked = False

    def readdressed(self, old, new):
        self.rests[new], self.rests[old] = self.rests[old], 0

    def settle(self):
        """Charge the share with the time that silent drives have taken."""
        shared_us = self.shared_us
        spent_us = (shared_us - self.charged_us) & SPENT_MASK
        self.charged_us = shared_us
        if not self._is_anyone_there():
            return  # no other drive loses time by it
        most_us = _OWED_MAX * SHARE * self.silent_exchange_us
        # If one telegram is late, the next may come sooner, or the drives would not get their
        # share.
        wait_us = max(self.wait_us, -2 * self.silent_exchange_us)
        self.wait_us = min(wait_us + SHARE * min(spent_us, most_us), most_us)
        if self._asked is not None and self._asked.silent > SILENT_MAX:
            self.wait_us = max(self.wait_us, _ROUND_US // max(self.resting, 1))

    def spare(self, drive):
        """The list leaves this drive to those who ask it something else, unless it may run. None:
        it leaves nobody any more."""
        before, self.spared = self.spared, drive
        if before is not drive:
            if before is not None and self._turns.by_address[before.address] is before:
                self.look_after(before)
            if drive is not None:
                self.look_after(drive)

    def look_after(self, drive):
        """Let the drive rest, or bring it back into the round, as it should be."""
        rests = 0
        if drive is self.spared and drive.contact:
            rests = 0 if drive.may_run() else 1
        elif drive.may_rest():
            # A drive that was never asked has a turn before it rests, unless time is owed.
            rests = self.rests[drive.address] or drive.silent or self.wait_us > 0
            rests = 1 if rests and self._is_anyone_there() else 0
        if rests != self.rests[drive.address]:
            self._set(drive.address, rests)
            if rests:
                self._turns.leave_round(drive)
            else:
                self._turns.join_round(drive)

    def give_turn(self):
        """Give one resting drive a turn, if none of them has one."""
        asked = self._asked
        if self._is_asked:
            # The next look knows how long it took. If the drive answers, an exchange with it may
            # be under way at every look, so contact ends the wait too.
            waits = asked.insist > 0 or self._turns.is_under_way(asked)
            self._is_asked = waits and not asked.contact
            if asked.contact:
                self.look_after(asked)
        elif self.wait_us <= 0 and self.resting:
            last = asked.address if asked is not None else 0
            asked = self._turns.by_address[greatest(self.rests, 0, NODES, last)]
            if asked is not None:  # a Ctrl-C in `relayout` leaves none there
                self._asked = asked
                self._is_asked = asked is not self.spared
                if self._is_asked:
                    asked.ask_soon()

    def _is_anyone_there(self):
        """1 if a drive answers, or may run. Without one, no drive loses time to the silent
        ones."""
        witness = self._witness
        if witness is not None and (witness.contact or witness.was_running):
            return 1
        for drive in self._turns.drives:
            if drive.contact or drive.was_running:
                self._witness = drive
                return 1
        self._witness = None
        self.wait_us = 0
        return 0

    def _set(self, address, rests):
        self.rests[address] = rests
        self.resting += 1 if rests else -1
