# SPDX-License-Identifier: MIT
"""Whose turn it is on the bus: the circulating list, and what goes before it.

The bus works through the list entry by entry (specification A-5.1): a drive that stands in it
twice is asked twice as often. Before the list go, in this order:

    a telegram outside the list that is `ahead`: a broadcast stop
    a command that matters: a stop of a drive that runs, another stop, anything else
    a drive whose next turn would be too late (two telegrams out of three, and between commands to
        drives without contact)
    an exchange that is repeated because no valid reply came
    another telegram outside the list, or a drive that wants more than its turn (every second
        telegram)

The bus counts and shows a drive that stays silent, and never takes it off the list. `silence` says
which of these rest, `deadlines` which drives need more turns. `master` does the sending.

    turns = Turns(Timing(19200), mask, 1_000_000, is_under_way)
    drive = turns.add(1)            # loop: or turns.add(1, Layout(VARIABLE, 4))
    turns.choose(now)               # engine: that drive, or None if there is none to ask now
"""

from micropython import const

from uss import pkw, telegram
from uss.drive import (
    ANY, ATTENTION, COMMANDS, NO_CONTROL, NODES, OVERDUE, SOON, WANTS, Drive,
)  # fmt: skip
from uss.deadlines import Deadlines
from uss.fast import calling, greatest
from uss.layout import STANDARD

_LIST_MAX = const(255)  # entries of the circulating list
_OUTSIDE_MAX = const(8)  # so many telegrams outside the list may wait
_OVERDUE_IN_A_ROW = const(2)
_OVERDUE_BETWEEN = const(3)  # commands to drives without contact
# Rows of the drives' attention, as bits of `calling`.
_COMMANDS = const(1)
_OVERDUE = const(2)
_WANTS = const(4)
_FORGOTTEN_MAX = const(4)  # in one look, so many drives are cleared that want no turn any more


class Turns:
    """timing: `Timing` of the line. mask: the clock's period - 1. lost_us: without a valid reply
    for so long, contact with a drive is lost. is_under_way: function drive -> whether an exchange
    with it has begun and not ended. abandon: function drive; such an exchange ends as a miss.

    Fields to look at: `drives`, each once, in the order added; `list`, the circulating list, see
    `arrange`; `exchanges`, how often there was a turn, 16 bit; `deadlines`, which looks after
    drives that need more turns. A setting, at any time: `cycle_us`, a round of the list begins so
    long after the round before, 0 for at once.

    The loop writes the list and the round with all that follows from them, and _outside_in;
    `deadlines` writes lists_between; the engine writes all else. Both write: following (the loop
    when it changes the round or the list); _ahead and _again (the loop puts one in, or takes out
    the drive that is removed); the attention (any caller sets its rows, the engine clears them).
    """

    def __init__(self, timing, mask, lost_us, is_under_way, abandon=None):
        # What every exchange asks for comes first, as in `Master`.
        self.attention = bytearray(ATTENTION)  # of the drives, see `drive`
        self.following = _LIST_MAX  # the next drive's place in the round; beyond it a round begins
        self.round_count = 0  # so many entries of `round` count
        self.round = []  # the list without the drives that rest
        self.exchanges = 0
        self.cycle_us = 0
        self._more = False  # besides the list there was something that waits for a later telegram
        self._foreseen = None  # the drive that `foresee` named, until it has its turn
        self.drives = []
        self.list = []
        self.by_address = [None] * NODES  # the same drives, by address
        self.timing = timing
        self.lost_us = lost_us
        self.is_under_way = is_under_way
        self.longest_exchange_us = 0  # when the reply comes, and ends, at the last moment
        self.lists_between = 1  # from one telegram that is extra to the next, so many of the list
        self._abandon = abandon
        self._mask = mask
        self._round_began_at = None
        self._round_left_us = 0  # what is left of the cycle time at the end of the round
        self._again = None  # the drive whose exchange is repeated
        self._ahead = None  # a telegram outside the list that goes before everything
        self._outside = [None] * (_OUTSIDE_MAX + 1)  # the others: a ring, one writer at each end
        self._outside_in = 0
        self._outside_out = 0
        self._outside_last = False  # a telegram outside the list had the last extra turn, no drive
        self._overdue = 0  # turns in a row that overdue drives had; below 0: turns they now get
        self._lists_left = 0
        self._look_from = 0  # the search for an urgent drive begins after this address,
        self._overdue_from = 0  # and the search for an overdue one after this
        self.deadlines = Deadlines(self, mask)

    # --- for the loop ---------------------------------------------------------------------------

    def add(self, address, layout=None, make=Drive):
        """Put a drive at the end of the circulating list; return its `Drive`.

        layout: how its telegrams are divided, STANDARD if not given. make: what makes it, see
        `families.drive_maker`. The same address again gives
        the same drive one more turn. ValueError if the address is not 0...31, the list is full,
        or the drive has another layout already.
        """
        if len(self.list) >= _LIST_MAX:
            raise ValueError("the circulating list holds %d entries" % _LIST_MAX)
        drive = self.at(address)
        if drive is None:
            drive = make(address, self._mask, self.attention, layout or STANDARD)
            # New lists, because an interrupt may have come in while it walks the old ones.
            self.by_address[address] = drive
            self.drives = self.drives + [drive]
        elif layout and not layout.is_like(drive.layout):
            raise ValueError("drive %d has %r already" % (address, drive.layout))
        self._set_list(self.list + [drive])
        return drive

    def at(self, address):
        """The drive with this address; None if there is none, or the address is not 0...31."""
        return self.by_address[address] if address in range(NODES) else None

    def remove(self, drive):
        """Take a drive off the bus: it gets no telegrams any more.

        ValueError if it is not on this bus, or may be running under control of this bus.
        """
        if drive not in self.drives:
            raise ValueError("drive %d is not on this bus" % drive.address)
        if drive.may_run() and drive.off != NO_CONTROL:
            raise ValueError("drive %d may be running" % drive.address)
        self.deadlines.forget(drive)
        self.drives = [other for other in self.drives if other is not drive]
        self._set_list([entry for entry in self.list if entry is not drive])
        self.by_address[drive.address] = None
        self._forget_turn(drive)

    def _forget_turn(self, drive):
        """It has no turn any more that was promised already."""
        if self._again is drive:
            self._again = None
        if self._foreseen is drive:
            self._foreseen = None
        self.attention[ANY] = 1  # the next telegram is perhaps made ready, for this drive

    def arrange(self, entries):
        """Make this the circulating list: drives of this bus, each at least once, in any order.

        A drive that stands in it more often is asked more often. The round begins anew. ValueError
        when there are more than 255, or one is missing, or one is of another bus.
        """
        entries = list(entries)
        if len(entries) > _LIST_MAX:
            raise ValueError("the circulating list holds %d entries" % _LIST_MAX)
        for drive in entries:
            if drive not in self.drives:
                raise ValueError("drive %d is not on this bus" % drive.address)
        for drive in self.drives:
            if drive not in entries:
                raise ValueError("drive %d would have no turn" % drive.address)
        self._set_list(entries)
        self.following = _LIST_MAX

    def readdress(self, drive, address):
        """From the next telegram on, `drive` answers at another address.

        ValueError when it is not 0...31 or another drive of this bus has it.
        """
        if not 0 <= address <= telegram.NODE_MAX:
            raise ValueError("drive address %r is not 0...31" % (address,))
        old = drive.address
        if address == old:
            return
        if self.by_address[address] is not None:
            raise ValueError("address %d is taken" % address)
        self.by_address[address] = drive
        drive.move(address)
        self.deadlines.readdressed(old, address)
        self.attention[old] = 0
        self.by_address[old] = None

    def relayout(self, drive, layout, doubted=False):
        """From the next telegram on, the telegrams to `drive` are divided like `layout`.

        An exchange that is under way ends as a miss. A stop that is owed stays owed, and so do
        commands and counters; parameter jobs that wait are TIMED_OUT. The drive is asked soon.
        ValueError when it is not on this bus, or is in contact. Of a drive that may be running
        only who knows that it has this layout by now may say so: its STOP goes out in this one.

        doubted: it may be in contact, if it stands; it has none in the new layout yet.
        """
        address = drive.address
        if self.by_address[address] is not drive:
            raise ValueError("drive %d is not on this bus" % address)
        self._check_lost(drive, doubted)
        fresh = Drive(address, self._mask, self.attention, layout)
        # While its parts do not fit together, no exchange with it begins: nobody finds it. The
        # last one that may have begun is no longer its own.
        is_in_round = not self.deadlines.silence.rests[address]
        self.by_address[address] = None
        if is_in_round:
            self.leave_round(drive)
        self._forget_turn(drive)
        try:
            self._check_lost(drive, doubted)
            if self._abandon:
                self._abandon(drive)
            self._check_lost(drive, doubted)  # it answered at the last moment
        except BaseException:
            self._bring_back(drive, is_in_round)
            raise
        if doubted:
            drive.lose()
            drive.doubted = False
        drive.become(fresh)
        self._bring_back(drive, is_in_round)
        drive.ask_soon()
        self._follow_layouts()

    def _check_lost(self, drive, doubted):
        if drive.contact and not (doubted and not drive.may_run()):
            raise ValueError("drive %d is in contact" % drive.address)

    def _bring_back(self, drive, is_in_round):
        self.by_address[drive.address] = drive
        if is_in_round:
            self.join_round(drive)
        drive.call_again()  # nobody heard what it called meanwhile

    def post(self, telegram_outside):
        """Send a telegram outside the list once (see `outside`). It is the next telegram but one
        at the latest, if nothing else is urgent. RuntimeError if 8 wait already, or this one does.
        """
        if telegram_outside.state == pkw.PENDING:
            raise RuntimeError("%r is pending already" % (telegram_outside,))
        following = (self._outside_in + 1) % len(self._outside)
        if telegram_outside.ahead:
            if self._ahead is not None:
                raise RuntimeError("%r is to go ahead of everything already" % (self._ahead,))
        elif following == self._outside_out:
            raise RuntimeError("%d telegrams wait already" % _OUTSIDE_MAX)
        telegram_outside.state = pkw.PENDING
        telegram_outside.silent = 0
        if telegram_outside.ahead:
            self._ahead = telegram_outside
        else:
            self._outside[self._outside_in] = telegram_outside
            self._outside_in = following
        self.attention[ANY] = 1

    def longest_cycle_us(self, entries=None):
        """How long a round of the list, or of `entries` in its place, takes if every drive replies
        at the last moment."""
        counts = [drive.layout.net_max for drive in entries or self.list]
        return sum([self._longest_us(count, count) for count in counts])

    def _longest_us(self, request_count, reply_count):
        timing = self.timing
        request_us = timing.start_interval_us + timing.telegram_us(request_count)
        reply_us = timing.character_us + timing.residual_us(reply_count)
        return request_us + timing.reply_timeout_us + reply_us

    def _set_list(self, entries):
        self.list = entries
        self._follow_layouts()
        self.round_count = 0  # nobody has a turn until it is filled
        self.round = list(entries)
        self._fill_round()

    def _follow_layouts(self):
        """What follows from the layouts of the drives."""
        longest_us = 0
        last = None
        for drive in self.drives:
            layout = drive.layout
            if layout is not last:  # mostly they share one
                last = layout
                reply_count = telegram.NET_COUNT_MAX if layout.variable else layout.net_max
                longest_us = max(longest_us, self._longest_us(layout.net_max, reply_count))
        self.longest_exchange_us = longest_us
        self.deadlines.list_changed()

    # --- for `silence`, from the loop -----------------------------------------------------------

    # `following` moves with the round, or the next drive would lose its turn: a drive that stands
    # after one that answers every second telegram would never be asked. If an interrupt takes a
    # turn between the two steps, it asks one drive twice and leaves none out.

    def leave_round(self, drive):
        """The drive rests from now on."""
        drives = self.round
        places = 0  # of this drive, among the places that have had their turn
        for place in range(min(self.following, self.round_count)):
            if drives[place] is drive:
                places += 1
        self.following = max(self.following - places, 0)
        self._fill_round()

    def join_round(self, drive):
        """The drive does not rest any more."""
        self._fill_round()
        drives = self.round
        passed = min(self.following, self.round_count)
        place = 0
        while place < passed:
            if drives[place] is drive:
                self.following += 1
                passed = min(passed + 1, self.round_count)
            place += 1

    def _fill_round(self):
        """The list without those that rest, or are just given another layout. In place: it takes
        no heap, and an interrupt that walks it meanwhile finds a drive everywhere, the one before
        or the one after.
        """
        rests = self.deadlines.silence.rests
        by_address = self.by_address
        drives = self.round
        count = 0
        for drive in self.list:
            if not rests[drive.address] and by_address[drive.address] is drive:
                drives[count] = drive
                count += 1
        self.round_count = count

    # --- for the engine: allocates nothing ------------------------------------------------------

    def choose(self, now):
        """The next drive: a command that matters goes before the list, a stop before a start.

        None if there is none to ask now; `wait_us` tells for how long.
        """
        drive = self._most_urgent() if self._more or self.is_called() else None
        if drive is None:
            drive, self._foreseen = self._foreseen, None
            if drive is None:
                drive = self._next_of_list(now)
                if drive is None:
                    return None
        self.exchanges = (self.exchanges + 1) & 0xFFFF
        return drive

    def foresee(self, now):
        """The drive that has the next turn if nobody calls meanwhile; None: that depends.

        Until its turn has come, by `choose` or `pass_on`, it is the same one, and what is more
        urgent goes before it.
        """
        attention = self.attention
        if attention[ANY] or attention[SOON]:
            rows = calling(attention, NODES, ANY)
            if self._ahead is not None or rows & (_COMMANDS | _OVERDUE):
                return None
            attention[ANY] = attention[SOON] = 0  # who calls from now on is heard
            self._more = True
        if self._again is not None or self.cycle_us:
            return None
        drive = self._foreseen
        if drive is None:
            if self._more:
                self._more = False
                drive = self._extra(calling(attention, NODES, ANY))
            self._foreseen = drive = drive or self._next_of_list(now)
        return drive

    def pass_on(self):
        """The foreseen drive has its turn now."""
        self._foreseen = None
        self.exchanges = (self.exchanges + 1) & 0xFFFF

    def _next_of_list(self, now):
        position = self.following
        if position >= self.round_count:
            if not self.round_count or self.cycle_us and not self._begin_round(now):
                return None
            position = 0
        self.following = position + 1
        return self.round[position]

    def wait_us(self):
        """After `choose` has found none: what is left of the cycle time; 0: the list is empty."""
        left_us, self._round_left_us = self._round_left_us, 0
        return left_us

    def repeat(self, drive):
        """There was no valid reply: once more, unless the drive was removed meanwhile."""
        if drive.outside or self.by_address[drive.address] is drive:
            self._again = drive
            self._more = True

    def is_called(self):
        """Whether a drive or a telegram outside the list has called, and nobody has heard it."""
        return self.attention[ANY] != 0 or self.attention[SOON] != 0

    def has_command(self):
        """Whether there is a command that does not wait for its turn."""
        return self._ahead is not None or greatest(self.attention, COMMANDS, NODES, 0) >= 0

    def all_told(self):
        """Whether every drive in contact has answered its OFF1 and the others were sent it; drives
        without contact that may run were sent it several times.
        """
        for drive in self.drives:
            if drive.contact:
                waits = not drive.answered_off()
            else:
                waits = drive.was_running and drive.insist
            if waits or drive.urgency() > 1:
                return False
        return self._ahead is None

    def _begin_round(self, now):
        """At the end of the list: whether the cycle time is over, so that the next round
        begins."""
        began_at = self._round_began_at
        cycle_us = min(self.cycle_us, self._mask >> 2)  # with a longer one, misses cannot be timed
        if began_at is not None:
            passed_us = (now - began_at) & self._mask
            if passed_us < cycle_us:
                self._round_left_us = cycle_us - passed_us
                return False
            if passed_us < 2 * cycle_us:  # keep in step with the rounds before
                now = (began_at - (self._mask - cycle_us) - 1) & self._mask  # a small integer
        self._round_began_at = now
        return True

    def _most_urgent(self):
        """The most urgent drive or telegram; None if the list may go on.

        A drive that only wants more than its turn gets every second telegram at the most. Overdue
        drives get two in a row, so that the list goes on in between. A command to a drive without
        contact takes long. So after such a command, three overdue drives that are not told to run
        go before the next.
        """
        attention = self.attention
        # Cleared before the look, so that a drive that calls now is not missed.
        attention[ANY] = attention[SOON] = 0
        self._more = False
        if self._ahead is not None:
            drive, self._ahead = self._ahead, None
            self._more = True
            return drive
        rows = calling(attention, NODES, ANY)
        if rows & _COMMANDS:
            drive = self._find(COMMANDS, 2)
            if drive is not None:
                if drive.contact:
                    return drive
                if self._overdue >= 0 or not rows & _OVERDUE or self._overdue_is_on():
                    self._overdue = -_OVERDUE_BETWEEN
                    return drive
        if rows & _OVERDUE and self._overdue < _OVERDUE_IN_A_ROW:
            drive = self._next_overdue()
            if drive is not None:
                self._overdue += 1
                return drive
        self._overdue = 0
        if self._again is not None:
            drive, self._again = self._again, None
            self._more = True
            return drive
        if self._foreseen is not None:
            self._more = True
            return None
        return self._extra(rows)

    def _extra(self, rows):
        """What gets an extra turn: a telegram outside the list, or a drive that wants more than
        its turn; None if the list may go on. rows: who calls."""
        if self._lists_left:
            self._lists_left -= 1
            if rows or self._lists_left or self._outside_out != self._outside_in:
                self._more = True
            return None
        drive = self._find(WANTS, 1) if rows & _WANTS and self._outside_last else None
        self._outside_last = False
        if drive is None:
            drive = self._next_outside()
            self._outside_last = drive is not None
        if drive is None and rows & _WANTS:
            drive = self._find(WANTS, 1)
        if drive is not None:
            self._lists_left = self.lists_between
        return drive

    def _overdue_is_on(self):
        """Whether the next overdue drive is told to run: such a telegram must not go before a
        stop.
        """
        drive = self.by_address[greatest(self.attention, OVERDUE, NODES, self._overdue_from)]
        return drive is not None and drive.wanted != 0

    def _next_overdue(self):
        attention = self.attention
        address = greatest(attention, OVERDUE, NODES, self._overdue_from)
        attention[OVERDUE + address] = 0  # it is asked now
        self._more = True
        self._overdue_from = address
        return self.by_address[address]

    def _find(self, row, least):
        """The most urgent of the drives that have called in this row, if its urgency is at least
        `least`; else None. Calls of drives that were served meanwhile are cleared, only a few each
        time, because an interrupt must not take long.
        """
        attention = self.attention
        for _ in range(NODES if row == COMMANDS else _FORGOTTEN_MAX):
            address = greatest(attention, row, NODES, self._look_from)
            if address < 0:
                return None
            self._more = True
            drive = self.by_address[address]
            if drive is not None and drive.urgency() >= least:
                self._look_from = address
                return drive
            attention[row + address] = 0
        return None

    def _next_outside(self):
        place = self._outside_out
        if place == self._outside_in:
            return None
        telegram_outside = self._outside[place]
        self._outside[place] = None
        self._outside_out = (place + 1) % len(self._outside)
        self._more = True
        return telegram_outside
