# SPDX-License-Identifier: MIT
"""Drives that have too many turns, and drives that have too few: the loop's part in `turns`.

One that stays silent, was not told to run and was not last seen running backs off: it is left out
of the round and asked now and then, so that it costs the others little. One that may run and trips
after a short time without telegrams (P2014) gets more turns than the list gives it.

Works a little at a time, whenever the loop refreshes the bus; the engine only walks the round.
"""

from array import array

from micropython import const

from uss.drive import NODES
from uss.pzd import ZSW_RUNNING

_BACK_OFF_US = const(1_600_000)  # a drive that backs off is asked again after so long
_PROBE_SHARE = const(22)  # or after so many times what that costs, so that it takes below 5 %
LOOK_US = const(4_000)  # how often drives are looked after
_SWEEP_US = const(130_000)  # in which each of them has been
_MEASURE_US = const(250_000)  # how often the duration of a round is measured
_NEAR = const(2)  # a gap of less than so many rounds is looked after
_MEASURED_MAX_US = const(1_000_000)  # what took longer tells nothing; 255 times it is small
_LONGEST_US = const(100_000_000)  # of a round; small enough to be multiplied
_FAR = const(6)  # until it is so many: the turns it gets besides make a round seem shorter


class Care:
    """turns: the `Turns` that it belongs to. mask: the clock's period - 1.

    looked_at: when `look` was called last; it is due after LOOK_US.
    """

    def __init__(self, turns, mask):
        self.looked_at = 0
        self._turns = turns
        self._mask = mask
        # Drives that back off.
        self._rests = bytearray(NODES)  # by address: whether it does
        self._back_off_us = _BACK_OFF_US
        self._uneasy = False  # one may have to begin, or to end it
        self._looked = 0  # which drive was looked after last
        self._since_silent = 0  # how many were looked after since one was silent
        # Drives whose turns in the list may be too far apart.
        self._gaps_us = array("i", bytes(4 * NODES))  # by address: how far they may be; 0: any
        self._least_us = 0  # of these; 0: there is none
        self._limit_us = 0  # gaps below this are looked after
        self._pressed = 0  # which drive was looked after last
        self._near = 0  # how many of these may have to be pressed
        self._crowded = False  # so many that the list alone does better
        self._exchanges = 0  # of the bus, when the duration of a round was measured last
        self._measured_at = 0

    def supervise(self, drive, gap_us):
        """Keep two telegrams to a drive that may run at most so far apart; 0: any distance."""
        before_us = self._gaps_us[drive.address]
        if gap_us == before_us:
            return
        self._gaps_us[drive.address] = gap_us
        if 0 < gap_us < (self._least_us or _LONGEST_US):
            self._least_us = gap_us
        elif before_us == self._least_us:
            self._find_least()

    def forget(self, drive):
        """It is not on the bus any more."""
        self._rests[drive.address] = False
        self.supervise(drive, 0)

    def readdressed(self, old, new):
        """A drive has another address."""
        self._rests[new] = self._rests[old]
        self._rests[old] = False
        self._gaps_us[new] = self._gaps_us[old]
        self._gaps_us[old] = 0

    def list_changed(self):
        """There is another list: what follows from that."""
        turns = self._turns
        timing = turns.timing
        probe_us = 0
        for drive in turns.drives:
            probe_us = max(probe_us, timing.telegram_us(drive.layout.net_count))
        probe_us += timing.start_interval_us + timing.reply_timeout_us + timing.character_us
        self._back_off_us = min(max(_BACK_OFF_US, _PROBE_SHARE * probe_us), self._mask >> 1)
        turns.round_count = 0  # nobody has a turn until it is filled
        turns.round = list(turns.list)
        self._fill_round()

    def look(self, now):
        """From the loop: a little of what is due."""
        passed_us = (now - self.looked_at) & self._mask
        self.looked_at = now
        turns = self._turns
        if turns.uneasy:  # of the engine, which does not write the other one
            turns.uneasy = False
            self._uneasy = True
        if self._uneasy:
            self._look_for_silent(now, passed_us)
        if self._least_us:
            if (now - self._measured_at) & self._mask >= _MEASURE_US:
                self._measure(now)
            if self._limit_us:
                self._look_for_overdue(now, passed_us)

    # --- drives that back off -------------------------------------------------------------------

    def _look_for_silent(self, now, passed_us):
        drives = self._turns.drives
        count = len(drives)
        for _ in range(_share(count, passed_us, _SWEEP_US)):
            self._looked = self._looked + 1 if self._looked + 1 < count else 0
            self._look_after(drives[self._looked], now)
        if self._since_silent > count:
            self._since_silent = 0
            self._uneasy = False

    def _look_after(self, drive, now):
        """Is it to back off, or to come back, or is it high time to ask it?"""
        backs_off = drive.keeps_silent() and self._anyone_has_contact()
        if backs_off != self._rests[drive.address]:
            self._rests[drive.address] = backs_off
            self._fill_round()
        if backs_off and drive.silent_us(now, self._mask) >= self._back_off_us:
            if not self._turns.is_under_way(drive):
                drive.ask_soon()
        self._since_silent = 0 if drive.silent else self._since_silent + 1

    def _anyone_has_contact(self):
        for drive in self._turns.drives:
            if drive.contact:
                return True
        return False

    def _fill_round(self):
        """The list without those that back off. In place: it takes no heap, and an interrupt that
        walks it meanwhile finds a drive everywhere, the one before or the one after.
        """
        turns = self._turns
        rests = self._rests
        count = 0
        for drive in turns.list:
            if not rests[drive.address]:
                turns.round[count] = drive
                count += 1
        turns.round_count = count

    # --- drives whose turns are too far apart ---------------------------------------------------

    def _find_least(self):
        least_us = _LONGEST_US
        for gap_us in self._gaps_us:
            if 0 < gap_us < least_us:
                least_us = gap_us
        self._least_us = least_us if least_us < _LONGEST_US else 0

    def _measure(self, now):
        """How long a round takes, by the telegrams since last time; which gaps that presses."""
        turns = self._turns
        passed_us = (now - self._measured_at) & self._mask
        exchanges = (turns.exchanges - self._exchanges) & 0xFFFF
        self._measured_at = now
        self._exchanges = turns.exchanges
        if passed_us >= _MEASURED_MAX_US:
            return  # nobody measured meanwhile: this is where it begins
        round_us = _LONGEST_US
        if exchanges:
            round_us = min(len(turns.list) * (passed_us // exchanges), _LONGEST_US)
        round_us = max(round_us, min(turns.cycle_us, _LONGEST_US))
        limit_us = (_FAR if self._limit_us else _NEAR) * round_us
        self._limit_us = limit_us if self._least_us < limit_us else 0

    def _look_for_overdue(self, now, passed_us):
        """Is a third of a gap over? Others may be due at the same time.

        Two telegrams of three are for these drives. When they are two thirds of the list, or more,
        each has its turn soonest if there are no others than those in the list.
        """
        drives = self._turns.drives
        count = len(drives)
        for _ in range(_share(count, passed_us, min(_SWEEP_US, self._least_us >> 2))):
            self._pressed = self._pressed + 1 if self._pressed + 1 < count else 0
            if not self._pressed:
                self._crowded = 3 * self._near >= 2 * len(self._turns.list)
                self._near = 0
            drive = drives[self._pressed]
            # What most drives are is seen without a call: standing.
            if drive.wanted or drive.was_running or drive.zsw & ZSW_RUNNING:
                gap_us = self._gaps_us[drive.address]
                if 0 < gap_us < self._limit_us:
                    self._near += 1
                    if not self._crowded and drive.silent_us(now, self._mask) > gap_us // 3:
                        if not self._turns.is_under_way(drive):
                            drive.press()


def _share(count, passed_us, sweep_us):
    """How many of `count` are to be looked after now, so that all have been after `sweep_us`."""
    return min(count, -(-count * min(passed_us, sweep_us) // max(sweep_us, 1)))
