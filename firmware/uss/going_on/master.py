# SPDX-License-Identifier: MIT
"""The master that makes the next telegram ready, so that the link can go on at once.

While a telegram or its reply is on the line, `Turns.foresee` says who is next and `Drive.foresee`
what that drive will be told if nobody calls and the reply shows nothing new. The link gets both:
the telegram, and the plan by which `says_nothing_new` looks at the reply. Until the telegram has
gone out, nothing of the drive has changed; `Drive.follow` does that afterwards.

What makes it safe:
* Only the last control word of a drive is repeated, and ON only if its last telegram had it.
* Whoever calls (a stop, any command, a drive that was changed) sets the attention of `Turns`, and
  the link looks at that microseconds before it sends.
* If the telegram goes to the drive that answers, everything in the reply that takes ON back is
  new (`plan.watch`). If it goes to another one, the reply matters to the next telegram but one.
* Each entry into the engine takes the telegram back first, and makes it ready anew at last.
* The loop must have refreshed so lately that the dead man does not trip before the reply is there.
"""

from array import array

from micropython import const

from uss import telegram
from uss.going_on.plan import WORDS, leave_open, watch
from uss.receiver import ROUNDING_US
from uss.master import AWAITING, DEAD_MAN_US, LOST_US, SENDING, Master

try:
    from uss.going_on.viper import says_nothing_new
except (ImportError, AttributeError, NameError, SyntaxError, ValueError):  # as in `uss.fast`
    from uss.going_on.python import says_nothing_new

_READY_US = const(1_500)  # for making a telegram ready, twice as long as it takes


class GoingOnMaster(Master):
    """As `Master`, for a link that `goes_on` (see `hal`)."""

    def __init__(self, link, timing, mask, lost_us=LOST_US):
        Master.__init__(self, link, timing, mask, lost_us)
        self._following = None  # the drive to which the link sends by itself,
        self._sent = None  # and what: the last request to it, or another one
        # How long after a request the reply ends at the least, apart from its characters.
        self._pause_us = timing.start_interval_us - ROUNDING_US - link.resolution_us
        receiver = self._receiver
        self._sixteen_us = receiver.sixteen_us
        turns = self.turns
        plan = array("H", bytes(2 * WORDS))
        room = bytearray(telegram.SIZE_MAX)
        self._parts = (turns, receiver, link, plan, room)  # one look for all
        link.instruct(receiver.buffer, says_nothing_new, plan, turns.attention)

    def is_overtaken(self, now):
        """Whether somebody has called since the next telegram was made ready, and there is time to
        make another one ready."""
        if self._following is None or not self.turns.is_called():
            return False
        return self.is_undisturbed((now + _READY_US) & self._mask)

    # --- the engine -----------------------------------------------------------------------------

    def poll(self, now):
        self._link.take_back()
        due_us = Master.poll(self, now)
        if self.phase == AWAITING:
            self._prepare(now)
        return due_us

    def recover(self, now):
        link = self._link
        link.take_back()
        if link.follow():  # what comes now is the reply of that drive
            self._drive = self._following
            self.turns.pass_on()
        self._following = None
        Master.recover(self, now)

    def _await(self, now):
        turns, receiver, link, _, _ = self._parts
        if not link.follow():
            return self._take(now) or self._go_on_at_once(now)
        if self._abandoned is not None:
            self._replace()
        answered, size = self._drive, self._drive.size
        # The link has gone on by itself, whatever happens here.
        self._drive = drive = self._following
        self._following = None
        turns.pass_on()
        receiver.accept(size, link.received_at)
        answered.take(receiver.buffer, size, now)
        self._conclude(answered, telegram.GOOD)
        if self._sent is not drive.request:
            drive.follow(self._sent, now)
        if not self._foreseen:
            self.phase = SENDING
            self._sending_since = now
            return self._sending_due_us(link.sending_us(now))
        self._quiet_since = sent_at = link.sent_at
        receiver.open(drive, sent_at)
        return ((sent_at - now) & self._mask) + self._reply_window_us

    def _prepare(self, now):
        """Let the link go on by itself when the reply comes, unless that depends on something."""
        turns, receiver, link, plan, room = self._parts
        self._following = None
        if self._held or receiver.count or receiver.stray or receiver.echo:
            return
        left_us = DEAD_MAN_US - turns.longest_exchange_us  # in which the loop may have refreshed
        if (now - self._refreshed_at) & self._mask > left_us:
            return
        following = turns.foresee(now)
        if following is None:
            return
        drive = self._drive
        answering = following is drive
        sent = following.foresee(room, answering)
        if sent is None:
            return
        if answering:
            watch(plan, drive)
        else:
            leave_open(plan)
        self._sent = sent
        self._following = following
        size = drive.size
        after_us = self._pause_us + (size * self._sixteen_us >> 4)
        link.prepare(drive.request, size, sent, following.size, after_us)
