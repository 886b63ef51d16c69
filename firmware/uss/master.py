# SPDX-License-Identifier: MIT
"""The USS master: it sends telegrams to the drives one after the other and judges the replies.

This is the exchange: silence, request, reply. `turns` decides whose turn it is.

`poll(now)` does whatever is due - take received characters, judge them, choose the next drive,
build and send its telegram, time out - and answers in how many microseconds it has something to do
again. The receive interrupt, a timer or the main loop may call it at any time. It allocates
nothing, uses no float, and must not be entered twice at once (`hal.pacer` sees to that).

It has no clock and no driver: the time is an argument, and the link is a duck type of `hal`.

    bus = Master(link, Timing(19200), clock.ticks_mask)
    drive = bus.turns.add(1)
    bus.refresh(now)                # from the main loop, or every motor is stopped after 300 ms
    wait_us = bus.poll(now)
"""

from micropython import const

# Lower layers first: an import inside an import inside an import takes stack.
from uss import pkw, telegram
import uss.drive  # noqa: F401
from uss.deadlines import LOOK_US
from uss.fast import frame
from uss.receiver import COMING, SILENT, WAITING, Receiver
from uss.timing import elapsed
from uss.turns import Turns

LOST_US = const(1_000_000)  # after so long without a valid reply, contact with a drive is lost
DEAD_MAN_US = const(300_000)  # without `refresh` for so long, the loop is taken for dead
LISTEN_US = const(100_000)  # silence that must be heard before the first telegram
_BABBLE_US = const(500_000)  # after this the master sends even if the line never falls silent
_STUCK_US = const(50_000)  # a transmission that takes so much longer than it should has failed
_PAUSE_US = const(1_000_000)  # a pause ends after so long, even if `resume` is not called
PAUSE_LOOK_US = const(5_000)  # how soon the end of a pause, or a command, is noticed
_SHARED_EXCHANGES = const(1_000)  # so many after its last telegram another master counts as gone
_OFTEN = const(0xFFFF)  # `silent` of what is not repeated
_NO_CONTROL = const(0)  # a copy from `drive` for the compiler
_FAILURES_MAX = const(3)  # exceptions in a row after which nothing is known of the drives any more

_GOOD = const(0)  # a copy from `telegram` for the compiler: every exchange needs it

# What the engine is doing: `phase`. When one phase ends, the next begins in the same `poll`.
#
# phase        what ends it                                                 next
LISTENING = const(0)  # 100 ms of silence                                   RESTING
#                       off; close, when another master was heard           OFF, CLOSED
RESTING = const(1)  #   the start interval is over, and it is a drive's turn
#                       the link foresees the last stop bit                 AWAITING
#                       it does not                                         SENDING
#                       off, close, and every drive is told to stop         OFF, CLOSED
SENDING = const(2)  #   the last stop bit                                   AWAITING
#                       the link does not get rid of the telegram           RESTING
AWAITING = const(3)  #  the reply, or no reply in time                      RESTING
OFF = const(5)  #       on                                                  LISTENING
#                       close                                               CLOSED
CLOSED = const(4)  #    nothing
#
# An exception in SENDING or AWAITING also leads to RESTING (`recover`). From AWAITING the master
# sends the next telegram at once if the start interval has passed already.

# Bits of `_held`: why the next exchange does not begin.
_HELD_BY_PAUSE = const(1)
_HELD_BY_OFF = const(2)
_HELD_BY_CLOSE = const(4)
_GIVEN_UP = const(8)  # the master no longer waits for the drives' answers


class Master:
    """The bus: whose turn it is (`turns`), and the exchanges with its drives.

    link: it sends and receives. timing: `Timing` of its baud rate. mask: the clock's period - 1,
    at most 2**30 - 1. All counters are unsigned 16-bit and wrap.

    Fields to look at: `phase`; `turns`, the drives and the circulating list; `deadlines`, how far
    apart the telegrams to a drive may be; `progress`, which moves as long as the engine gets
    anything done; `dead_man_trips`; `failures` (exceptions in `poll`); `foreign` (heard from
    another master: bursts before the first telegram, telegrams after it); `paused` (because of
    `pause` the master sends and awaits nothing). Settings, at any time: `retries`, how often the
    master repeats an exchange at once that brought no valid reply; `witness`, a `Witness` that is
    told of every exchange, or None.

    The loop writes _refreshed_at, retries, witness, _held. The engine writes all else. Both write:
    `phase` (the loop when it is OFF and the engine does nothing), what follows from that (_first,
    foreign), `paused` and _shared (the loop to False), _dead_man (the loop to False, in `refresh`;
    the engine to True), _abandoned (the engine to None).
    """

    def __init__(self, link, timing, mask, lost_us=LOST_US):
        # Fields that every step of the loop needs come first: an object with many fields finds the
        # first ones fastest.
        self._refreshed_at = 0
        self._dead_man = True  # tripped until the loop refreshes for the first time
        self.phase = LISTENING
        self.turns = turns = Turns(timing, mask, lost_us, self.is_under_way, self.abandon)
        self.deadlines = turns.deadlines
        self.timing = timing
        self.progress = 0
        self.dead_man_trips = 0
        self.failures = 0
        self.foreign = 0
        self.retries = 0
        self.paused = False
        self._mask = mask
        self._choose = turns.choose  # looked up once here, not in every turn
        self._shared = False  # another master was heard lately
        self._foreign_at = 0  # `exchanges` when it was heard last
        self._link = link
        self._receiver = Receiver(timing, mask)
        self._foreseen = link.interrupts and getattr(link, "foreseen", False)
        self._reply_window_us = self._receiver.window_us
        self._character_us = timing.character_us
        self._drive = None  # the one whose turn it is, or a telegram outside the list
        self._abandoned = None  # what is to stand in its place
        self._failures_in_row = 0
        self._first = True  # poll was not called yet
        self._held = 0
        self._paused_since = 0
        self._quiet_since = 0  # when the last character was on the line, in either direction
        self._resting_since = 0
        self._start_interval_us = timing.start_interval_us
        self._rest_us = timing.start_interval_us
        self._sending_since = 0
        self.witness = None

    # --- for the loop ---------------------------------------------------------------------------

    def refresh(self, now, looks=True):
        """The loop says that it is alive. Motors that were stopped while it was not stay stopped.

        looks: there is time to look after drives that are silent or wait too long, if that is due.
        """
        if (now - self._refreshed_at) & self._mask > DEAD_MAN_US and not self._dead_man:
            self._check_dead_man(now)  # nothing has entered the engine since: no timer does
        self._refreshed_at = now
        self._dead_man = False
        if looks and (now - self.deadlines.looked_at) & self._mask >= LOOK_US:
            self.deadlines.look(now)
            if self._shared:
                exchanges = self.turns.exchanges - self._foreign_at
                self._shared = exchanges & 0xFFFF < _SHARED_EXCHANGES

    def is_overtaken(self, now):
        """Whether the engine should be entered though nothing is due: see `uss.going_on`."""
        return False

    def is_undisturbed(self, until):
        """Whether nothing is to be done until then: a telegram is on its way, or the reply to it,
        which probably has as many characters.
        """
        if self.phase == AWAITING:
            reply_us = self._start_interval_us + self._drive.size * self._character_us
            return 0 < (self._quiet_since + reply_us - until) & self._mask <= self._mask >> 1
        return self.phase == SENDING

    def is_under_way(self, drive):
        """Whether an exchange with this drive has begun and not ended."""
        return self._drive is drive and self.phase in (SENDING, AWAITING)

    def abandon(self, drive):
        """Whatever comes of an exchange with this drive that is under way is a miss. The drive may
        be changed from now on; nobody begins another exchange with it before that is done.
        """
        exchange = self.turns.exchanges
        known = self._abandoned
        if known is not None and known.drive is drive and known.exchange == exchange:
            return  # the drive was changed already: it does not know what was sent
        if self.is_under_way(drive):
            self._abandoned = _Abandoned(drive, exchange)

    def patience_us(self):
        """How long `progress` may stay the same on a bus that works."""
        return _BABBLE_US + _STUCK_US + self.turns.longest_exchange_us

    def is_line_in_use(self):
        """Whether another master was heard, so that this one listens and does not send."""
        return self.phase == LISTENING and self.foreign > 0

    def is_line_shared(self):
        """Whether another master has lately sent telegrams between ours, or instead of a reply.
        Drives will misunderstand both masters; this one does nothing about it.
        """
        return self._shared

    def has_echo(self):
        """Whether the line echoes what is sent: two wires, and a receiver that stays on."""
        return self._receiver.echo

    def stop_all(self):
        """Send OFF1 to every drive, a telegram each; drives that run get theirs first. Those that
        this bus does not control are told nothing."""
        for drive in self.turns.drives:
            if drive.off != _NO_CONTROL:
                drive.stop()

    def off(self):
        """Leave the line to others: send OFF1 to every drive, then nothing until `on`.

        Once that is done `phase` is OFF, and contact with every drive is lost.
        """
        self.stop_all()
        self._held |= _HELD_BY_OFF

    def on(self):
        """Take the line again: listen first, as at the beginning. A drive that ran needs a new
        `start`."""
        self._held &= ~_HELD_BY_OFF
        if self.phase == OFF:
            self._first = True
            self.foreign = 0
            self.phase = LISTENING

    def close(self):
        """Leave the line for good: send OFF1 to every drive, then nothing any more.

        Once that is done `phase` is CLOSED; `leave` waits for it. To call this again changes
        nothing.
        """
        if not self._held & _HELD_BY_CLOSE:
            self.stop_all()
        self._held |= _HELD_BY_CLOSE
        if self.phase == OFF:
            self.phase = CLOSED

    def give_up(self):
        """After `close`: do not wait for the drives any more, only for the end of the exchange."""
        self._held |= _GIVEN_UP

    def pause(self):
        """Begin no exchange until `resume`, for at most 1 s; `paused` tells that the pause has
        begun. Commands go first, also later ones: `paused` is False until they are sent. So take
        new commands from the operator before you act on `paused`.
        """
        self._held |= _HELD_BY_PAUSE

    def resume(self):
        """End a pause; without one this changes nothing."""
        self._held &= ~_HELD_BY_PAUSE
        self.paused = False

    # --- the engine -----------------------------------------------------------------------------

    def poll(self, now):
        """Do what is due; return the microseconds until something is due again, at least 1."""
        if self._dead_man or (now - self._refreshed_at) & self._mask > DEAD_MAN_US:
            self._check_dead_man(now)
        phase = self.phase  # each step calls the next one if that can follow at once
        if phase == AWAITING:
            return self._await(now)
        if phase == SENDING:
            return self._finish_sending(now)
        if phase == RESTING:
            return self._rest(now)
        if phase == LISTENING:
            return self._listen(now)
        if phase == OFF:
            self._get_on()
            self._swallow(now)
        return DEAD_MAN_US

    def recover(self, now):
        """After an exception in `poll`: take ON back from every drive and begin with a silence
        that outlasts any telegram under way. After several exceptions in a row contact is lost.
        """
        self.failures = (self.failures + 1) & 0xFFFF
        self._failures_in_row += 1
        if self._abandoned is not None:
            self._replace()
        for drive in self.turns.drives:
            drive.revoke()
            if self._failures_in_row >= _FAILURES_MAX:
                drive.lose()
            drive.call()  # the engine may have taken its call without acting on it
        self._quiet_since = now
        if self.phase in (RESTING, SENDING, AWAITING):
            drive = self._drive
            if self.phase != RESTING and drive.outside:
                drive.miss(SILENT, now, 0, self._mask)  # a telegram outside the list ends so
            self._begin_rest(now)
            if drive is not None:
                reply_us = self.timing.reply_timeout_us + 2 * drive.size * self._character_us
                self._rest_us = reply_us

    def _check_dead_man(self, now):
        """If the loop is dead, take ON back from all drives, also from one started later, until
        the loop is back."""
        if not self._dead_man:
            if elapsed(now, self._refreshed_at, self._mask) <= DEAD_MAN_US:
                return
            self._dead_man = True
            self.dead_man_trips = (self.dead_man_trips + 1) & 0xFFFF
        for drive in self.turns.drives:
            drive.revoke()

    def _get_on(self):
        self.progress = (self.progress + 1) & 0xFFFF

    def _listen(self, now):
        """Listen before the first telegram: any traffic means that another master is there."""
        self._get_on()
        if self._first:
            self._first = False
            self._quiet_since = now
        if self._swallow(now):
            self._count_foreign()
        held = self._held
        if held & (_HELD_BY_OFF | _GIVEN_UP) or held & _HELD_BY_CLOSE and self.foreign:
            self.phase = CLOSED if held & _HELD_BY_CLOSE else OFF  # no drive was told anything yet
            return DEAD_MAN_US
        left_us = LISTEN_US - elapsed(now, self._quiet_since, self._mask)
        if left_us > 0:
            # While listening the bus is paused anyway, for as long as it listens.
            self.paused = self._held & _HELD_BY_PAUSE != 0
            self._paused_since = now
            return left_us
        self._begin_rest(now)
        return self._go_on(now)

    def _begin_rest(self, now):
        self._resting_since = now
        self._rest_us = self._start_interval_us
        self.phase = RESTING

    def _rest(self, now):
        """Hear whether the line is still silent, then go on."""
        heard = self._swallow(now)
        if heard and self._is_foreign(heard):
            self._count_foreign()
        return self._go_on(now)

    def _go_on(self, now):
        """Wait for the start interval: two characters of silence before every telegram."""
        left_us = self._rest_us - elapsed(now, self._quiet_since, self._mask)
        if left_us > 0 and elapsed(now, self._resting_since, self._mask) < _BABBLE_US:
            return left_us
        if self._held:
            held_us = self._hold(now)
            if held_us:
                return held_us
        drive = self._choose(now)
        if drive is None:
            return self._wait(now)
        return self._send(drive, now)

    def _wait(self, now):
        """There is nothing to send: the list is empty, or the round took less than its cycle
        time."""
        self._get_on()
        self._begin_rest(now)
        self._quiet_since = (now - self._rest_us) & self._mask  # at the latest
        return min(self.turns.wait_us(), PAUSE_LOOK_US) or PAUSE_LOOK_US

    def _hold(self, now):
        """How long close, off or pause keep the master from sending; 0: it may send now."""
        held = self._held
        if not held & (_HELD_BY_OFF | _HELD_BY_CLOSE):
            return PAUSE_LOOK_US if self._keeps_pausing(now) else 0
        for drive in self.turns.drives:
            if drive.wanted:
                drive.revoke()  # it was started since `close` or `off`
        if not held & _GIVEN_UP and not self.turns.all_told():
            return 0
        if held & _HELD_BY_CLOSE:
            self.phase = CLOSED
        else:
            self.phase = OFF
            for drive in self.turns.drives:
                drive.lose()
        return DEAD_MAN_US

    def _keeps_pausing(self, now):
        """Whether `pause` is in force: no command is waiting, and it has not taken too long."""
        if not self.paused:
            self._paused_since = now
        elif elapsed(now, self._paused_since, self._mask) >= _PAUSE_US:
            self.resume()
            return False
        self.paused = not self.turns.has_command()
        self._get_on()
        self._begin_rest(now)
        return self.paused

    def _swallow(self, now):
        """Take characters that are not awaited; the silence begins after them. Return how many."""
        receiver = self._receiver
        link = self._link
        heard = link.receive(receiver.buffer, 0)
        if heard > 0:
            self._quiet_since = link.received_at
            return heard
        if heard == COMING:
            self._quiet_since = now
        return 0

    def _is_foreign(self, count):
        """Whether these characters begin a telegram that this bus neither sent nor asked for.

        A late reply of the drive that was asked last does not count, nor does an echo.
        """
        buffer = self._receiver.buffer
        if count < 3 or buffer[0] != telegram.STX or buffer[1] & 1 or buffer[1] < 4:
            return False
        return self._drive is None or buffer[2] != self._drive.address

    def _count_foreign(self):
        self.foreign = (self.foreign + 1) & 0xFFFF
        self._foreign_at = self.turns.exchanges
        self._shared = self.phase != LISTENING

    def _send(self, drive, now):
        self._drive = drive
        request = drive.request
        drive.fill(now)
        size = drive.size
        if not drive.sealed or request[2] != drive.address:
            frame(request, size, drive.address)
            drive.sealed = True
        link = self._link
        if not self._foreseen:
            self.phase = SENDING
            self._sending_since = now
            link.send(request, size)
            return self._sending_due_us(link.sending_us(now))
        link.send(request, size)
        self._quiet_since = sent_at = link.sent_at
        self._receiver.open(drive, sent_at)
        self.phase = AWAITING
        # The link reports the reply: there is nothing to do until the reply is late.
        return ((sent_at - now) & self._mask) + self._reply_window_us

    def _replace(self):
        """The loop has abandoned an exchange: the one under way, unless that was over before."""
        abandoned, self._abandoned = self._abandoned, None
        if abandoned.exchange == self.turns.exchanges and abandoned.drive is self._drive:
            self._drive = abandoned
            self._receiver.await_instead(abandoned)

    def _finish_sending(self, now):
        if self._abandoned is not None:
            self._replace()
        left_us = self._link.sending_us(now)
        drive = self._drive
        if left_us:
            sending_us = elapsed(now, self._sending_since, self._mask)
            if sending_us > drive.size * self._character_us + _STUCK_US:
                return self._give_up(now)
            return self._sending_due_us(left_us)
        self._quiet_since = self._link.sent_at
        self._receiver.open(drive, self._link.sent_at)
        self.phase = AWAITING
        return self._await(now)

    def _sending_due_us(self, left_us):
        """When to look again. A link with interrupts reports the reply: then it is soon enough
        when the reply is late."""
        if self._link.interrupts:
            return left_us + self._reply_window_us
        return max(left_us, self.timing.character_us)

    def _give_up(self, now):
        """The link cannot send its telegram. Try again; this does not count as progress."""
        self._drive.miss(SILENT, now, self.turns.lost_us, self._mask)
        self._begin_rest(now)
        self._quiet_since = now
        self._resting_since = (now - _BABBLE_US) & self._mask
        return self._rest(now)

    def _await(self, now):
        return self._take(now) or self._go_on_at_once(now)

    def _take(self, now):
        """Take the reply, or count that there was none; 0. Before that: microseconds until there
        may be something to take.
        """
        if self._abandoned is not None:
            self._replace()
        receiver = self._receiver
        finding = receiver.take(self._link, now)
        if finding == _GOOD:
            self._drive.take(receiver.buffer, receiver.count, now)
        elif finding == WAITING:
            return receiver.due_us(self._link, now)
        else:
            self._miss(finding, now)
        self._conclude(self._drive, finding)
        return 0

    def _conclude(self, drive, finding):
        """The exchange with the drive is over."""
        receiver = self._receiver
        if self.witness is not None:
            self.witness.note(drive, finding, receiver)
        self._failures_in_row = 0
        self.progress = (self.progress + 1) & 0xFFFF
        self._quiet_since = receiver.heard_at

    def _go_on_at_once(self, now):
        """After an exchange: the next one, or the silence before it."""
        silent_us = (now - self._quiet_since) & self._mask
        if self._start_interval_us <= silent_us < _BABBLE_US and not self._held:
            # The link took longer to report the reply than the rest lasts.
            drive = self._choose(now)
            if drive is not None:
                return self._send(drive, now)
        self._begin_rest(now)
        return self._go_on(now)

    def _miss(self, finding, now):
        """There was no valid reply: count that, and repeat the exchange if `retries` says so."""
        drive = self._drive
        drive.miss(finding, now, self.turns.lost_us, self._mask)
        if finding == telegram.BAD_ADDRESS:
            self._count_foreign()
        if drive.outside or not drive.contact:
            spent_us = elapsed(now, self._receiver.sent_at, self._mask)
            spent_us += self._start_interval_us + drive.size * self._character_us
            self.deadlines.silence.charge(drive, spent_us)
        if drive.silent <= self.retries:
            if drive.outside:
                drive.state = pkw.PENDING  # it is repeated, so it is not over yet
            self.turns.repeat(drive)


class _Abandoned:
    """Takes the place of a drive in the exchange that was under way when it got another layout: it
    has the request that was sent. No reply is a valid one.

    drive: whose it was. exchange: `exchanges` of the bus then.
    """

    outside = True  # it is treated as if it were
    silent = _OFTEN  # nobody repeats it
    contact = False
    state = pkw.TIMED_OUT

    def __init__(self, drive, exchange):
        self.drive = drive
        self.exchange = exchange
        self.address = drive.address
        self.request = drive.request
        self.size = drive.size
        self._alike = drive.may_reply_alike()

    def fits(self, net_count):
        return False

    def may_reply_alike(self):
        return self._alike

    def take(self, buffer, count, now):
        self.miss(telegram.BAD_LENGTH, now, 0, 0)

    def miss(self, finding, now, lost_us, mask):
        self.drive.miss(finding, now, lost_us, mask)
