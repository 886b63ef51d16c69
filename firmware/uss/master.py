"""The USS master: who talks when on the bus, and what becomes of it.

`poll(now)` does whatever is due - take received characters, judge them, choose the next drive,
build and send its telegram, time out - and answers in how many microseconds it has something to do
again. It may be called at any time by anyone: the receive interrupt, a timer, the main loop. It
allocates nothing, uses no float, and must not be entered twice at once (`hal.pacer` sees to that).

Not a clock and not a driver: the time is an argument, and the link is a duck type of `hal`.

    bus = Master(link, Timing(19200), clock.ticks_mask)
    drive = bus.add(1)
    bus.refresh(now)                # from the main loop, or every motor is stopped after 300 ms
    wait_us = bus.poll(now)
"""

from micropython import const

from uss import telegram
from uss.drive import Drive
from uss.receiver import COMING, SILENT, WAITING, Receiver
from uss.timing import elapsed

LIST_MAX = const(255)  # entries of the circulating list
LOST_US = const(1_000_000)  # without a valid reply for so long, contact with a drive is lost
DEAD_MAN_US = const(300_000)  # without `refresh` for so long, the loop is taken for dead
LISTEN_US = const(100_000)  # silence that must be heard before the first telegram
BABBLE_US = const(500_000)  # a line that never falls silent is sent on all the same after this
STUCK_US = const(50_000)  # a transmission that takes so much longer than it should has failed
PAUSE_US = const(1_000_000)  # a pause ends after so long, whether or not anybody ends it
PAUSE_LOOK_US = const(5_000)  # how soon its end, or a command, is noticed
FAILURES_MAX = const(3)  # exceptions in a row after which nothing is known of the drives any more

# Of `telegram`, for the compiler: these are needed in every exchange.
_NET = const(3)
_GOOD = const(0)

# What the engine is doing.
LISTENING = const(0)
RESTING = const(1)
SENDING = const(2)
AWAITING = const(3)
CLOSED = const(4)


class Master:
    """The bus and its circulating list of drives.

    link: what is sent on and received from. timing: `Timing` of its baud rate. mask: the clock's
    period - 1, at most 2**30 - 1. All figures of counters are unsigned 16-bit and wrap.

    Fields to look at: `phase`; `exchanges` (telegrams sent); `progress`, which moves as long as
    the engine gets anything done; `dead_man_trips`; `failures` (exceptions in `poll`); `foreign`
    (bursts heard while listening: another master is on the line); `paused` (nothing is sent and
    nothing awaited, by order of `pause`). `patience_us` is how long `progress` may stand still on
    a bus that works.
    """

    def __init__(self, link, timing, mask, lost_us=LOST_US):
        self.drives = []  # each once, in the order added
        self.list = []  # the circulating list; a drive may stand in it several times
        self.timing = timing
        self.phase = LISTENING
        self.exchanges = 0
        self.progress = 0
        self.patience_us = BABBLE_US + STUCK_US
        self.dead_man_trips = 0
        self.failures = 0
        self.foreign = 0
        self.paused = False
        self._link = link
        self._mask = mask
        self._lost_us = lost_us
        self._receiver = Receiver(timing, mask)
        self._foreseen = getattr(link, "foreseen", False)
        self._reply_window_us = self._receiver.window_us
        self._attention = bytearray(1)  # 1: a drive may be in a hurry
        self._drive = None  # the one whose turn it is
        self._insisted = False  # it was its turn because it is to have more than its turn
        self._look_from = 0  # where the search for one with a hurry begins
        self._failures_in_row = 0
        self._next = 0
        self._first = True  # poll was never called
        self._closing = False
        self._pausing = False
        self._held = False  # by one of these
        self._paused_since = 0
        self._quiet_since = 0  # the last character on the line, either direction
        self._resting_since = 0
        self._start_interval_us = timing.start_interval_us
        self._rest_us = timing.start_interval_us
        self._sending_since = 0
        self._refreshed_at = 0
        self._dead_man = True  # tripped until the loop refreshes for the first time

    # --- for the loop ---------------------------------------------------------------------------

    def add(self, address):
        """Put a drive at the end of the circulating list; answer its `Drive`.

        The same address again gives the same drive one more turn. ValueError when the address is
        not 0...31 or the list is full.
        """
        if len(self.list) >= LIST_MAX:
            raise ValueError("the circulating list holds %d entries" % LIST_MAX)
        for drive in self.drives:
            if drive.address == address:
                break
        else:
            drive = Drive(address, self._mask, self._attention)
            drive.residual_us = self.timing.residual_us(drive.net_count)
            drive.telegram_us = self.timing.telegram_us(drive.net_count)
            longest_us = drive.telegram_us + self.timing.reply_timeout_us + drive.residual_us
            self.patience_us = max(self.patience_us, longest_us + BABBLE_US + STUCK_US)
            # New lists, because an interrupt may be walking the old ones.
            self.drives = self.drives + [drive]
        self.list = self.list + [drive]
        return drive

    def readdress(self, drive, address):
        """From the next telegram on, `drive` answers at another address.

        ValueError when it is not 0...31 or another drive of this bus has it.
        """
        if not 0 <= address <= telegram.NODE_MAX:
            raise ValueError("drive address %r is not 0...31" % (address,))
        for other in self.drives:
            if other is not drive and other.address == address:
                raise ValueError("address %d is taken" % address)
        drive.address = address

    def longest_cycle_us(self):
        """How long a round of the list takes when every drive is silent till the last moment."""
        cycle_us = 0
        for drive in self.list:
            cycle_us += drive.telegram_us + self.timing.reply_timeout_us + drive.residual_us
        return cycle_us

    def refresh(self, now):
        """The loop says that it is alive. Whatever ran when it was not stays stopped."""
        self._refreshed_at = now
        self._dead_man = False

    def is_line_in_use(self):
        """Whether another master was heard and is listened to instead of talking."""
        return self.phase == LISTENING and self.foreign > 0

    def stop_all(self):
        """OFF1 to every drive by a telegram each; the engine takes those that run first."""
        for drive in self.drives:
            drive.stop()

    def close(self):
        """Send nothing any more once the exchange that goes on is over; `phase` is CLOSED then.

        Stop the drives first.
        """
        self._closing = True
        self._held = True

    def pause(self):
        """Begin no exchange until `resume`, 1 s at the most; `paused` tells when it has come so
        far. Commands go first, also later ones: whoever must not hear them late asks them first.
        """
        self._pausing = True
        self._held = True

    def resume(self):
        """Go on; when nothing was paused that is no change."""
        self._pausing = False
        self._held = self._closing
        self.paused = False

    # --- the engine -----------------------------------------------------------------------------

    def poll(self, now):
        """Do what is due; answer the microseconds until something is due again, at least 1."""
        if self._dead_man or (now - self._refreshed_at) & self._mask > DEAD_MAN_US:
            self._check_dead_man(now)
        phase = self.phase  # each step goes over to the next one when that can follow at once
        if phase == SENDING:
            return self._finish_sending(now)
        if phase == AWAITING:
            return self._await(now)
        if phase == RESTING:
            return self._rest(now)
        if phase == LISTENING:
            return self._listen(now)
        return DEAD_MAN_US

    def recover(self, now):
        """After an exception in `poll`: take ON back from every drive and begin with a silence in
        which whatever was under way comes to its end. Several in a row, and contact is lost.
        """
        self.failures = (self.failures + 1) & 0xFFFF
        self._failures_in_row += 1
        for drive in self.drives:
            drive.revoke()
            if self._failures_in_row >= FAILURES_MAX:
                drive.lose()
        self._quiet_since = now
        if self.phase != CLOSED and self.phase != LISTENING:
            self._begin_rest(now)
            if self._drive is not None:
                self._rest_us = self.timing.reply_timeout_us + self._drive.residual_us

    def _check_dead_man(self, now):
        """Take ON back from all drives, also one started later, until the loop is back."""
        if not self._dead_man:
            if elapsed(now, self._refreshed_at, self._mask) <= DEAD_MAN_US:
                return
            self._dead_man = True
            self.dead_man_trips = (self.dead_man_trips + 1) & 0xFFFF
        for drive in self.drives:
            drive.revoke()

    def _get_on(self):
        self.progress = (self.progress + 1) & 0xFFFF

    def _listen(self, now):
        """Before the first telegram: traffic not asked for means that another master is there."""
        self._get_on()
        if self._first:
            self._first = False
            self._quiet_since = now
        if self._heard_something(now):
            self.foreign = (self.foreign + 1) & 0xFFFF
        left_us = LISTEN_US - elapsed(now, self._quiet_since, self._mask)
        if left_us > 0:
            self.paused = self._pausing  # nothing is sent anyway, however long that takes
            self._paused_since = now
            return left_us
        self._begin_rest(now)
        return self._rest(now)

    def _begin_rest(self, now):
        self._resting_since = now
        self._rest_us = self._start_interval_us
        self.phase = RESTING

    def _rest(self, now):
        """The start interval: the line is silent for two characters before every telegram."""
        if now != self._resting_since:  # what had come by then is taken already
            self._heard_something(now)
        left_us = self._rest_us - elapsed(now, self._quiet_since, self._mask)
        if left_us > 0 and elapsed(now, self._resting_since, self._mask) < BABBLE_US:
            return left_us
        if self._held:
            if self._closing:
                self.phase = CLOSED
                return DEAD_MAN_US
            if self._keeps_pausing(now):
                return PAUSE_LOOK_US
        drive = self._choose()
        if drive is None:
            self._get_on()
            self._begin_rest(now)
            self._quiet_since = now
            return DEAD_MAN_US
        return self._send(drive, now)

    def _keeps_pausing(self, now):
        """Whether `pause` is in force: no command is waiting, and it has not taken too long."""
        if not self.paused:
            self._paused_since = now
        elif elapsed(now, self._paused_since, self._mask) >= PAUSE_US:
            self.resume()
            return False
        self.paused = not self._has_command()
        self._get_on()
        self._begin_rest(now)
        return self.paused

    def _has_command(self):
        for drive in self.drives:
            if drive.urgency() > 1:
                return True
        return False

    def _heard_something(self, now):
        """Swallow characters that nobody awaits; they move the beginning of the silence."""
        receiver = self._receiver
        link = self._link
        heard = link.receive(receiver.buffer, 0)
        if heard > 0:
            self._quiet_since = link.received_at
        elif heard == COMING:
            self._quiet_since = now
        return heard > 0

    def _choose(self):
        """The next drive: a command that matters goes before the list, a stop before a start."""
        if self._attention[0]:
            drive = self._most_urgent()
            if drive is not None:
                return drive
        entries = self.list
        if not entries:
            return None
        position = self._next if self._next < len(entries) else 0
        self._next = position + 1
        return entries[position]

    def _most_urgent(self):
        """The drive that is in the greatest hurry; None when the list may go on.

        What is only to have more than its turn gets every second telegram at the most, one drive
        after the other, so that the list goes on in between.
        """
        self._attention[0] = 0  # before looking: whoever calls for it from now on is not missed
        chosen = None
        highest = 1 if self._insisted else 0
        drives = self.drives
        position = self._look_from
        for _ in range(len(drives)):
            position = position + 1 if position + 1 < len(drives) else 0
            urgency = drives[position].urgency()
            if urgency:
                self._attention[0] = 1
                if urgency > highest:
                    highest = urgency
                    chosen = drives[position]
                    self._look_from = position
        self._insisted = chosen is not None and highest == 1
        return chosen

    def _send(self, drive, now):
        self._drive = drive
        request = drive.request
        drive.fill(request, _NET, now)
        if not drive.sealed or request[2] != drive.address:
            telegram.seal(request, drive.address, drive.net_count)
            drive.sealed = True
        link = self._link
        self.phase = SENDING
        self._sending_since = now
        link.send(request, drive.net_count + 4)
        self.exchanges = (self.exchanges + 1) & 0xFFFF
        left_us = link.sending_us(now)
        if self._foreseen:
            self._open(drive, link.sent_at)
        return self._sending_due_us(left_us)

    def _finish_sending(self, now):
        left_us = self._link.sending_us(now)
        drive = self._drive
        if left_us:
            sending_us = elapsed(now, self._sending_since, self._mask)
            if sending_us > drive.telegram_us + STUCK_US:
                return self._give_up(now)
            return self._sending_due_us(left_us)
        self._open(drive, self._link.sent_at)
        return self._await(now)

    def _open(self, drive, sent_at):
        """Await the reply to what was sent until, or will have been sent at `sent_at`."""
        self._quiet_since = sent_at
        self._receiver.open(drive.address, drive.net_count, drive.residual_us, sent_at)
        self.phase = AWAITING

    def _sending_due_us(self, left_us):
        """A link with interrupts reports the reply: there is nothing to do until that is late."""
        if self._link.interrupts:
            return left_us + self._reply_window_us
        return max(left_us, self.timing.character_us)

    def _give_up(self, now):
        """The link does not get rid of a telegram. Try again; this is no progress."""
        self._drive.miss(SILENT, now, self._lost_us)
        self._begin_rest(now)
        self._quiet_since = now
        self._resting_since = (now - BABBLE_US) & self._mask
        return self._rest(now)

    def _await(self, now):
        receiver = self._receiver
        finding = receiver.take(self._link, now)
        if finding == _GOOD:
            self._drive.take(receiver.buffer, _NET, now)
        elif finding == WAITING:
            return receiver.due_us(self._link, now)
        else:
            self._drive.miss(finding, now, self._lost_us)
        self._failures_in_row = 0
        self.progress = (self.progress + 1) & 0xFFFF
        self._quiet_since = quiet_since = receiver.heard_at
        silent_us = (now - quiet_since) & self._mask
        if self._start_interval_us <= silent_us < BABBLE_US and not self._held:
            drive = self._choose()  # the link took longer to report the reply than the rest lasts
            if drive is not None:
                return self._send(drive, now)
        self._begin_rest(now)
        return self._rest(now)
