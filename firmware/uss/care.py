"""Drives that have too many turns, and drives that have too few: the loop's part in `turns`.

One that stays silent, was not told to run and was not last seen running backs off: it is left out
of the round and asked now and then, so that it costs the others little. One that may run and trips
after a short time without telegrams (P2014) gets more turns than the list gives it.

Works a little at a time, whenever the loop refreshes the bus; the engine only walks the round.
"""

from micropython import const

from uss.drive import NODES, OVERDUE, WANTS

BACK_OFF_US = const(1_600_000)  # a drive that backs off is asked again after so long
PROBE_SHARE = const(22)  # or after so many times what that costs, so that it takes below 5 %
LOOK_US = const(8_000)  # how often silent drives are looked after
SWEEP_US = const(100_000)  # in which each of them has been


class Care:
    """turns: the `Turns` that it belongs to. timing: of the line. mask: the clock's period - 1."""

    def __init__(self, turns, timing, mask):
        self._turns = turns
        self._timing = timing
        self._mask = mask
        self._gaps_us = {}  # drive: how far apart two telegrams to it may be while it may run
        self.pressed = []  # drives whose turns in the list may be further apart than that
        self._press = 0  # which of them was looked after last
        self.cycle_us = 0  # `cycle_us` of the turns when that was worked out
        self._rests = bytearray(NODES)  # by address: whether it backs off
        self._looked = 0  # which drive was looked after last
        self._looked_at = 0
        self._since_silent = 0  # how many were looked after since one was silent
        self._back_off_us = BACK_OFF_US
        self._longest_us = 0  # that a round may take

    def supervise(self, drive, gap_us):
        """Keep two telegrams to a drive that may run at most so far apart; 0: any distance."""
        self._gaps_us[drive] = gap_us
        others = [other for other in self.pressed if other is not drive]
        self.pressed = others + [drive] if 0 < gap_us < self._longest_us else others

    def forget(self, drive):
        """It is not on the bus any more."""
        self._gaps_us.pop(drive, None)
        self._rests[drive.address] = False

    def readdressed(self, old, new):
        """A drive has another address."""
        self._rests[new] = self._rests[old]
        self._rests[old] = False

    def list_changed(self):
        """There is another list, or another cycle time: what follows from that."""
        timing = self._timing
        turns = self._turns
        probe_us = 0
        for drive in turns.drives:
            probe_us = max(probe_us, timing.telegram_us(drive.layout.net_count))
        probe_us += timing.start_interval_us + timing.reply_timeout_us + timing.character_us
        self._back_off_us = min(max(BACK_OFF_US, PROBE_SHARE * probe_us), self._mask >> 1)
        self.cycle_us = turns.cycle_us
        self._longest_us = longest_us = max(turns.longest_cycle_us(), turns.cycle_us)
        gaps_us = self._gaps_us
        self.pressed = [drive for drive in turns.drives if 0 < gaps_us.get(drive, 0) < longest_us]
        turns.round_count = 0  # nobody has a turn until it is filled
        turns.round = list(turns.list)
        self._fill_round()

    def look_after_pressed(self, now, passed_us):
        """A few each time, all of them in SWEEP_US: is a third of a gap over? Others may be due at
        the same time. passed_us: since the last look.
        """
        pressed = self.pressed
        count = len(pressed)
        for _ in range(min(count, 1 + count * min(passed_us, SWEEP_US) // SWEEP_US)):
            self._press = self._press + 1 if self._press + 1 < count else 0
            drive = pressed[self._press]
            if drive.silent_us(now, self._mask) > self._gaps_us[drive] // 3 and drive.may_run():
                self._ask_soon(drive, OVERDUE)

    def look_after_silent(self, now):
        """A few each time, all of them in SWEEP_US; False when none has been silent lately."""
        passed_us = (now - self._looked_at) & self._mask
        if passed_us < LOOK_US:
            return True
        self._looked_at = now
        drives = self._turns.drives
        count = len(drives)
        for _ in range(min(count, 1 + count * min(passed_us, SWEEP_US) // SWEEP_US)):
            self._looked = self._looked + 1 if self._looked + 1 < count else 0
            self._look_after(drives[self._looked], now)
        if self._since_silent > count:
            self._since_silent = 0
            return False
        return True

    def _look_after(self, drive, now):
        """Is it to back off, or to come back, or is it high time to ask it?"""
        backs_off = drive.keeps_silent() and self._anyone_has_contact()
        if backs_off != self._rests[drive.address]:
            self._rests[drive.address] = backs_off
            self._fill_round()
        if backs_off and drive.silent_us(now, self._mask) >= self._back_off_us:
            self._ask_soon(drive, WANTS)
        self._since_silent = 0 if drive.silent else self._since_silent + 1

    def _ask_soon(self, drive, row):
        if not self._turns.is_under_way(drive):
            drive.ask_soon(row)

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
