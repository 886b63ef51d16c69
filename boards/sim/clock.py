# SPDX-License-Identifier: MIT
"""Virtual time: one clock for the whole simulated world, in integer microseconds.

It keeps a list of instants and calls what is due, in order, while a caller advances it. Nothing
happens between two instants, so an idle second costs nothing, and a run repeats to the
microsecond. Owners allocate their events once. To arm, move or cancel them then takes no heap, as
an interrupt handler demands.

    blink = Event(led.toggle)
    clock.schedule(blink, clock.now_us + 500_000)
    clock.advance(1_000_000)

The 32-bit build leaves its small integers after 2**30 us (17.9 minutes): from then on the clock is
still right, but it takes heap.
"""

SLEEP_LIMIT_US = 100  # of hal's contract `clock`


class Event:
    """Something that happens at an instant: `callback()` is called, without an argument.

    `armed` and `at_us` are for reading; Clock.schedule and Clock.cancel set them.
    """

    def __init__(self, callback):
        self.callback = callback
        self.at_us = 0
        self.armed = False
        self.next = None


class Clock:
    """Time since the world began, and the counters that the chip derives from it.

    ticks_start   microseconds that the chip's counter shows when the world begins, any number
    ticks_mask    2**n - 1, at most 0x3FFFFFFF: where ticks_us and ticks_ms wrap
    now_us        virtual time since the world began; it never wraps
    """

    def __init__(self, ticks_start=0, ticks_mask=0x3FFFFFFF):
        if ticks_mask & (ticks_mask + 1) or not 0 < ticks_mask <= 0x3FFFFFFF:
            raise ValueError("ticks_mask is 2**n - 1, at most 0x3FFFFFFF")
        self.now_us = 0
        self.ticks_mask = ticks_mask
        self._start_us = ticks_start & ticks_mask
        self._until_wrap_us = ticks_mask - self._start_us
        self._start_ms = (ticks_start // 1000) & ticks_mask
        self._until_wrap_ms = ticks_mask - self._start_ms
        self._start_rest_us = ticks_start % 1000
        self._head = Event(None)  # the list hangs on an event that never happens
        self._advancing = False

    def ticks_us(self):
        """Microseconds as the chip counts them."""
        # (elapsed + start) & mask, without the sum: two 30-bit numbers make 31 bits, which is
        # more than a small integer of the 32-bit build holds.
        elapsed = self.now_us & self.ticks_mask
        until_wrap = self._until_wrap_us
        if elapsed > until_wrap:
            return elapsed - until_wrap - 1
        return elapsed + self._start_us

    def ticks_ms(self):
        """Milliseconds as the chip counts them: the same wrap, a thousand times later."""
        elapsed = (self.now_us + self._start_rest_us) // 1000 & self.ticks_mask
        until_wrap = self._until_wrap_ms
        if elapsed > until_wrap:
            return elapsed - until_wrap - 1
        return elapsed + self._start_ms

    def schedule(self, event, at_us):
        """Let `event` happen at `at_us`; an armed event moves. An instant in the past means now.

        Events of one instant happen in the order in which they were scheduled.
        """
        if event.armed:
            self.cancel(event)
        if at_us < self.now_us:
            at_us = self.now_us
        before = self._head
        after = before.next
        while after is not None and after.at_us <= at_us:
            before = after
            after = after.next
        event.at_us = at_us
        event.armed = True
        event.next = after
        before.next = event

    def cancel(self, event):
        """Forget `event`; one that is not armed stays as it is."""
        if not event.armed:
            return
        before = self._head
        while before.next is not event:
            before = before.next
        before.next = event.next
        event.armed = False

    def coming(self):
        """The events to come, in order: (at_us, callback) of each."""
        event = self._head.next
        while event is not None:
            yield event.at_us, event.callback
            event = event.next

    def advance(self, us):
        """Let `us` microseconds pass."""
        self.advance_to(self.now_us + us)

    def sleep_us(self, us):
        """Busy waiting, as on the chip: 100 us at most, else ValueError, and never in an event."""
        if us > SLEEP_LIMIT_US:
            raise ValueError("nobody sleeps for %d us: the limit is %d" % (us, SLEEP_LIMIT_US))
        self.advance_to(self.now_us + us)

    def advance_to(self, at_us):
        """Let time pass until `at_us`, the events of that very instant included.

        now_us is exact inside each callback. If a callback raises, the advance ends at its instant
        and the caller gets the exception; the events after it stay armed.
        """
        if self._advancing:
            raise RuntimeError("the clock is being advanced already: an event cannot advance it")
        if at_us < self.now_us:
            raise ValueError("the clock does not run backwards")
        self._advancing = True
        try:
            event = self._head.next
            while event is not None and event.at_us <= at_us:
                self._head.next = event.next
                event.armed = False
                self.now_us = event.at_us
                event.callback()
                event = self._head.next
            self.now_us = at_us
        finally:
            self._advancing = False
