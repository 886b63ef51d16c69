# SPDX-License-Identifier: MIT
"""Gives more turns to drives that would trip for want of telegrams. The loop's part of `turns`.

A drive trips when it has heard no telegram for its telegram-off time, P2014 of a MICROMASTER 4.
So two telegrams to a drive that may run are less than a third of that time apart. Where the list
alone does not achieve this, the drive is pressed: it gets a turn early enough for whatever may
still go before it. A drive that never trips counts as one that trips when it would be lost.

While the bus tells silent drives to stop, the list has few turns. Then drives at rest are pressed
as well: they trip like the others, and nobody can start them before the fault is acknowledged.

The silent drives get what time is left, see `silence`. All this is done a little at a time,
whenever the loop refreshes the bus. The engine only walks the round.
"""

from array import array

from micropython import const

from uss.drive import NODES
from uss.pzd import ZSW_RUNNING
from uss.silence import SHARE, SPENT_MASK, Silence

LOOK_US = const(4_000)  # from one look at the drives to the next
_SWEEP_US = const(130_000)  # in so long each drive is looked after
_SLOW_US = const(50_000)  # a loop with so long between two looks does all four things in each,
_SLOWISH_US = const(25_000)  # and with so long, two of them
_PRESS_US = const(16_000)  # in so long each drive that may run is looked after
_MEASURE_US = const(250_000)  # from one measurement of an exchange's duration to the next
_MEASURED_MAX_US = const(1_000_000)  # a longer measurement was interrupted and tells nothing
_EXCHANGES_MIN = const(4)  # a measurement needs so many
_RARE_US = const(1_000_000)  # between two silences that make a running drive's telegram late
_LONGEST_US = const(100_000_000)  # small enough to be multiplied


class Deadlines:
    """turns: the `Turns` that it belongs to. mask: the clock's period - 1.

    looked_at: when `look` was called last; it is due after LOOK_US. silence: the `Silence` of the
    drives that do not answer. The loop writes all fields of this class, and `lists_between` of
    `Turns`; it counts `wait_us` of `Silence` down.
    """

    def __init__(self, turns, mask):
        self.looked_at = 0
        self.silence = Silence(turns)
        self._turns = turns
        self._mask = mask
        self._bounds_us = array("i", bytes(4 * NODES))  # by address: a third of P2014; 0: none
        # The drives that may run, as of the last sweep.
        self._hurried = [None] * NODES  # the first `_hurried_count` count
        self._hurried_count = 0
        self._hurried_us = 0  # the time of an exchange with each of them
        self._least_us = _LONGEST_US  # the shortest bound of them,
        self._trips_us = _LONGEST_US  # and of those of them that trip
        self._needed_us = 0  # between two telegrams to one of them, if all are answered
        self._gap_us = 0  # the same with silences
        self._list_does = True  # the list is enough: none needs more turns, or most do
        self._latest_us = array("i", bytes(4 * NODES))  # by place: how long until it is pressed
        self._pressed = 0  # so many of them were looked after,
        self._press_us = 0  # in so long
        # The sweep under way.
        self._swept = 0  # so many drives were looked after,
        self._sweep_us = 0  # in so long
        self._running = 0
        self._running_us = 0  # the time of an exchange with each of them
        self._needy = 0  # drives whose turns in the list may be too far apart
        self._in_vain = 0  # drives that are told to stop and do not answer
        self._stops_in_vain = False  # the last sweep found several; a single one may have its turn
        self._least_so_far_us = self._trips_so_far_us = _LONGEST_US
        self._round_us = _LONGEST_US  # between two turns in the list, at the most
        self._loop_us = LOOK_US  # how far apart looks are
        self._next = 0  # which of four things a look does next
        # How long an exchange takes that is answered.
        self._exchange_us = 0
        self._quickest_us = 0
        self._measured_at = 0
        self._exchanges = 0  # those of the bus at the last measurement
        self._silences = 0
        self._silences_us = 0

    # --- what may be asked ----------------------------------------------------------------------

    def supervise(self, drive, off_time_ms):
        """Keep two telegrams to a drive that may run less than a third of `off_time_ms` apart.

        The drive trips after this time without telegrams, P2014 of a MICROMASTER 4. 0, for never,
        counts as the time after which the drive is lost; so does a drive that is not supervised.
        If its turns in the list are further apart, `look` gives it more.
        """
        bound_us = off_time_ms * 1000 // 3
        if bound_us != self._bounds_us[drive.address]:
            self._bounds_us[drive.address] = bound_us
            self._sweep_us = _SWEEP_US  # finish this sweep in the next looks

    def bound_us(self, drive):
        return self._bounds_us[drive.address] or self._turns.lost_us // 3

    def gap_us(self, drive):
        """The longest gap in microseconds between two telegrams to `drive`, and to every drive
        that runs, that this line can promise once `drive` runs beside them. One exchange in that
        gap may stay unanswered. A drive counts as running a tenth of a second after its start.
        """
        # This uses the drives that ran in the last sweep: a walk over all drives would take as
        # long as a whole step of the loop may.
        running, running_us = self._hurried_count, self._hurried_us
        if not drive.may_run():
            running += 1
            running_us += self._cost_us(drive)
        return self._with_silences(self._needed(running, running_us))

    def first_late(self, drive):
        """The drive that would get its telegrams too late for `supervise` if `drive` ran beside
        those that run now: `drive` or one of them; None if there is none. A drive that never
        trips, or that is not supervised, is never late.
        """
        gap_us = self.gap_us(drive)
        bounds_us = self._bounds_us  # 0 for a drive that never trips, which is never late
        if 0 < bounds_us[drive.address] <= gap_us:
            return drive
        if self._least_us <= gap_us:
            for place in range(self._hurried_count):
                other = self._hurried[place]
                if other.contact and 0 < bounds_us[other.address] <= gap_us:
                    return other
        return None

    def silence_wait_us(self, longer_us=0):
        """How long to wait, in microseconds, before one more telegram that perhaps nobody answers:
        until the share of the silent drives has room for it. The telegram takes of their share.

        longer_us: so much longer than the longest one of the list does that telegram take.
        """
        if not self._has_room(longer_us):
            return _LONGEST_US
        return max(self.silence.wait_us, 0)

    # --- what changes ---------------------------------------------------------------------------

    def forget(self, drive):
        """The drive is not on the bus any more."""
        self.silence.forget(drive)
        self._bounds_us[drive.address] = 0

    def readdressed(self, old, new):
        """A drive has another address."""
        self.silence.readdressed(old, new)
        self._bounds_us[new] = self._bounds_us[old]
        self._bounds_us[old] = 0

    def list_changed(self):
        """The list has changed: compute what depends on it."""
        net_count = max([drive.layout.net_count for drive in self._turns.drives] or [0])
        self.silence.list_changed(net_count)
        timing = self._turns.timing
        self._exchange_us = timing.exchange_us(net_count, timing.start_interval_us)
        self._quickest_us = self._exchange_us

    def look(self, now):
        """From the loop: do a little of what is due."""
        passed_us = (now - self.looked_at) & self._mask
        self.looked_at = now
        if passed_us > self._loop_us:
            self._loop_us = min(passed_us, _SWEEP_US)
        else:
            self._loop_us -= self._loop_us >> 5  # a single slow step is soon forgotten
        if self.silence.wait_us > -_LONGEST_US:
            self.silence.wait_us -= passed_us
        self._sweep_us += passed_us
        self._press_us += passed_us
        self._do_next(now)
        if passed_us >= _SLOWISH_US:
            for _ in range(3 if passed_us >= _SLOW_US else 1):
                self._do_next(now)

    # --- behind it ------------------------------------------------------------------------------

    def _do_next(self, now):
        """Do one thing in each look, because the loop's steps must be short."""
        silence = self.silence
        self._next = following = self._next + 1 & 3
        if following & 1 and (self._stops_in_vain or not self._list_does):
            self._press(now)
        elif following == 0 and (now - self._measured_at) & self._mask >= _MEASURE_US:
            self._measure(now)
        elif following == 2 and silence.shared_us != silence.charged_us:
            silence.settle()
        elif following == 2 and silence.resting and self._has_room():
            silence.give_turn()
        else:
            self._sweep(now)

    def _cost_us(self, drive):
        """How long an exchange with the drive takes."""
        return self._exchange_us if drive.contact else self.silence.silent_exchange_us

    def _sweep(self, now):
        drives = self._turns.drives
        count = len(drives)
        swept = self._swept
        if swept >= count:
            self._end_sweep()  # nothing else in this look: this takes long enough
            return
        until = _share(count, self._sweep_us, _SWEEP_US)
        if swept >= until:
            return
        rests = self.silence.rests
        while swept < until:
            drive = drives[swept]
            swept += 1
            if not drive.contact or rests[drive.address]:
                self.silence.look_after(drive)
                if drive.is_told_in_vain():
                    self._in_vain += 1
            elif self._stops_in_vain:
                self._press_if_late(drive, now)
            # Most drives stand. This test sees that without a call.
            if drive.wanted or drive.was_running or drive.zsw & ZSW_RUNNING:
                if drive.may_run():
                    self._hurry(drive)
        self._swept = swept

    def _press_if_late(self, drive, now):
        bound_us = self._bounds_us[drive.address]
        if 0 < bound_us < drive.silent_us(now, self._mask) and not drive.may_run():
            drive.press(1)

    def _hurry(self, drive):
        running = self._running
        bound_us = self._bounds_us[drive.address]
        if bound_us and drive.contact and bound_us < self._trips_so_far_us:
            self._trips_so_far_us = bound_us
        bound_us = bound_us or self._turns.lost_us // 3
        if drive.contact:
            cost_us = self._exchange_us
            if bound_us < self._least_so_far_us:
                self._least_so_far_us = bound_us
        else:  # its bound does not limit what others may take
            cost_us = self.silence.silent_exchange_us
        self._hurried[running] = drive
        # At the earliest during the exchange after its own, so that it is the next but one.
        self._latest_us[running] = max(bound_us - self._gap_us, cost_us >> 1)
        self._running = running + 1
        self._running_us += cost_us
        if bound_us < self._round_us:
            self._needy += 1

    def _end_sweep(self):
        """All drives have been looked after: compute what their turns add up to."""
        turns = self._turns
        running = self._running
        self._hurried_count = running
        self._hurried_us = self._running_us
        self._least_us = self._least_so_far_us
        self._trips_us = self._trips_so_far_us
        self._needed_us = self._needed(running, self._running_us)
        self._gap_us = self._with_silences(self._needed_us)
        # If two thirds of the list are in need, pressing makes no drive wait less.
        needy = self._needy
        crowded = 3 * needy >= 2 * turns.round_count > 0 and not turns.cycle_us
        turns.lists_between = 3 if crowded else 1
        self._list_does = crowded or not needy
        self._stops_in_vain = self._in_vain > 1
        self._in_vain = 0
        if self._list_does and not self._stops_in_vain:
            self._press_us = 0  # no drive is pressed
        # Every second telegram may be one outside the list.
        exchanges_us = (2 * turns.round_count + 1) * self._exchange_us
        self._round_us = max(exchanges_us, turns.cycle_us) + self.silence.silent_exchange_us
        self._needy = 0
        self._swept = 0
        self._sweep_us = 0
        self._running = 0
        self._running_us = 0
        self._least_so_far_us = self._trips_so_far_us = _LONGEST_US

    def _press(self, now):
        """Press the drives whose next telegram would be late if another one went before it."""
        count = self._hurried_count
        pressed = self._pressed
        until = _share(count, self._press_us, min(_PRESS_US, self._least_us >> 2))
        while pressed < until:
            drive = self._hurried[pressed]
            if drive.silent_us(now, self._mask) > self._latest_us[pressed]:
                if not self._turns.is_under_way(drive):
                    drive.press()
            pressed += 1
        if pressed >= count:
            pressed = 0
            self._press_us = 0
        self._pressed = pressed

    def _needed(self, running, running_us):
        """The gap between two telegrams to each of so many drives, if all telegrams are answered.

        Either they get two telegrams out of three, another exchange may just have begun, and the
        loop must notice first that they are late; or all have their turns in the list, with an
        extra telegram after every third.
        """
        exchange_us = self._exchange_us
        turns = self._turns
        list_count = max(turns.round_count, running)
        if 3 * running >= 2 * list_count and not turns.cycle_us:
            others_us = (list_count - running) * exchange_us
            return (running_us + others_us) * 4 // 3
        seen_us = 2 * self._loop_us + _PRESS_US
        return seen_us + running_us + ((running_us + exchange_us) >> 1) + exchange_us

    def _with_silences(self, needed_us):
        """That gap with the share of the resting drives in it, and with one drive that falls
        silent.
        """
        if self.silence.resting:
            needed_us += needed_us // (SHARE - 1)
        return needed_us + self.silence.silent_exchange_us

    def _has_room(self, longer_us=0):
        """Whether the drives that run still have their telegrams in time after one more silence.
        Where there are too many of them for that anyway, a silence may take a quarter of what they
        need: it trips none. Where only a drive that never trips would be late, and not lost, a
        silence is allowed now and then.
        """
        needed_us = self._needed_us
        least_us = self._least_us
        if self.silence.wait_us < -_RARE_US:
            least_us = min(self._trips_us, 2 * least_us)
        # Where one exchange takes more than a third of P2014, silent drives may go unasked for
        # 13 s, or until the drive stands. To risk more is no better: it outlives two lost
        # telegrams in a row, and a silence between them would leave it one.
        room_us = max(least_us - needed_us, needed_us >> 2)
        return self.silence.silent_exchange_us + longer_us < room_us

    def _measure(self, now):
        """Measure how long answered exchanges take."""
        turns, silence = self._turns, self.silence
        passed_us = (now - self._measured_at) & self._mask
        silences = (silence.count - self._silences) & 0xFFFF
        count = ((turns.exchanges - self._exchanges) & 0xFFFF) - silences
        passed_us -= (silence.spent_us - self._silences_us) & SPENT_MASK
        self._measured_at = now
        self._exchanges = turns.exchanges
        self._silences = silence.count
        self._silences_us = silence.spent_us
        # With a cycle time the bus waits between rounds; that time does not count as exchanges.
        if _EXCHANGES_MIN <= count and 0 < passed_us < _MEASURED_MAX_US and not turns.cycle_us:
            longest_us = self._quickest_us + turns.timing.reply_timeout_us
            measured_us = min(max(passed_us // count, self._quickest_us), longest_us)
            self._exchange_us += (measured_us - self._exchange_us) >> 2


def _share(count, passed_us, period_us):
    """How many of `count` should be looked after by now, so that all are at the end."""
    return count if passed_us >= period_us else count * passed_us // period_us
