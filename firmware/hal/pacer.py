"""Calls the bus engine when something is due, from whatever the port offers.

The receive interrupt, a one-shot timer and the main loop all end in `run`, which enters the engine
once at a time and re-arms the timer for what the engine asks. So interrupt and polled operation
share one path. An exception in the engine must not get out: a hard interrupt that raises is
disabled for good by MicroPython. It is counted, every ON is taken back, and the engine begins
anew.

    pacer = Pacer(bus, link, board.clock, board.timer, board.disable_irq, board.enable_irq)
    pacer.start()
    ... each step of the main loop: pacer.tend()
    pacer.stop()
"""

from micropython import const

RETRY_US = const(1_000)  # after an exception in the engine
WAKE_US = const(1_000)
PERIOD_MIN_US = const(20)  # or the timer would fire before it is armed
OVERDUE_US = const(50_000)  # a timer that is so late is not waited for any more
ROUNDS_MAX = const(4)  # entries in a row for events that came meanwhile; the timer takes the rest


class Pacer:
    """engine: has poll(now) -> microseconds, and recover(now). link, clock, timer: see `hal`.

    Fields to look at: `runs` (entries into the engine, 16 bit, wraps) and `failure` (the exception
    caught last; the engine counts them).
    """

    def __init__(self, engine, link, clock, timer, disable_irq, enable_irq):
        self.runs = 0
        self.failure = None
        self._engine = engine
        self._link = link
        self._ticks_us = clock.ticks_us
        self._mask = clock.ticks_mask
        self._timer = timer
        self._disable_irq = disable_irq
        self._enable_irq = enable_irq
        self._inside = False
        self._again = False
        self._stopped = True
        self._armed_at = 0
        self._armed_us = 0
        self._ctrl_c = False
        self._on_interrupt = self._interrupted  # bound once: binding allocates

    def start(self):
        self._stopped = False
        self._link.on_activity = self._on_interrupt
        self.run()

    def stop(self):
        """No interrupt enters the engine any more; the link is closed."""
        self._stopped = True
        if self._timer:
            self._timer.deinit()
        self._link.on_activity = None
        self._link.close()

    def tend(self):
        """From the main loop: drives the engine where there is no timer, and wakes a stuck one.

        Raises the KeyboardInterrupt that came while an interrupt was served.
        """
        if self._ctrl_c:
            self._ctrl_c = False
            raise KeyboardInterrupt
        waited_us = (self._ticks_us() - self._armed_at) & self._mask
        if self._timer is None or waited_us > self._armed_us + OVERDUE_US:
            self.run()

    def run(self):
        """Enter the engine unless somebody is inside; then have it entered once more."""
        if not self._may_enter():
            return
        try:
            self._work()
        except BaseException:  # Ctrl-C in the main loop: it goes on its way, the engine too
            try:
                self._recover()  # still inside: no interrupt may come in on half of it
            finally:
                self._inside = False
            raise

    def _may_enter(self):
        irq = self._disable_irq()
        try:
            if self._inside or self._stopped:
                self._again = True
                return False
            self._inside = True
            return True
        finally:
            self._enable_irq(irq)

    def _may_leave(self):
        irq = self._disable_irq()
        try:
            if self._again:
                return False
            self._inside = False
            return True
        finally:
            self._enable_irq(irq)

    def _work(self):
        for _ in range(ROUNDS_MAX):
            self._again = False
            self._enter()
            if self._may_leave():
                return
        self._inside = False
        if self._again:
            # The one-shot may have been the event that was put off, and so be used up.
            self._arm(WAKE_US)

    def _enter(self):
        self.runs = (self.runs + 1) & 0xFFFF
        try:
            self._arm(self._engine.poll(self._ticks_us()))
        except Exception as failure:
            self.failure = failure
            self._recover()

    def _recover(self):
        try:
            self._engine.recover(self._ticks_us())
            self._arm(RETRY_US)
        except Exception as failure:  # nothing works: the main loop tries again, or the watchdog
            self.failure = failure

    def _arm(self, after_us):
        self._armed_at = self._ticks_us()
        self._armed_us = after_us
        timer = self._timer
        if timer and not self._stopped:
            timer.init(
                mode=timer.ONE_SHOT,
                period=max(after_us, PERIOD_MIN_US),
                tick_hz=1_000_000,
                callback=self._on_interrupt,
            )

    def _interrupted(self, _source=None):
        # MicroPython raises a pending Ctrl-C wherever it happens to be, here as well; it would be
        # the end of this handler. The main loop is where it belongs.
        try:
            self.run()
        except KeyboardInterrupt:
            self._ctrl_c = True
