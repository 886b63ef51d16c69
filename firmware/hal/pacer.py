# SPDX-License-Identifier: MIT
"""Calls the bus engine when something is due, from whatever the port offers.

The receive interrupt, a one-shot timer and the main loop all end in `run`, which enters the engine
once at a time and sets the timer for when the engine wants to be called. So interrupt and polled
operation share one path. A hard interrupt that comes where the program has left too little of the
stack puts the engine off. An exception in the engine must not get out: if a hard interrupt raises,
MicroPython disables it for good. The engine counts it, takes back every ON and begins anew.

    pacer = Pacer(bus, link, board.clock, board.timer)
    pacer.start()
    ... each step of the main loop: pacer.tend()
    pacer.stop()
"""

from micropython import const

try:
    from micropython import stack_use
except ImportError:  # CPython, and ports that leave it out

    def stack_use():
        return 0


_RETRY_US = const(1_000)  # after an exception in the engine
WAKE_US = const(1_000)
_PERIOD_MIN_US = const(20)  # or the timer would fire before it is armed
OVERDUE_US = const(50_000)  # a timer that is so late is set again
_ENGINE_BYTES = const(2_800)  # of the stack, from `run` on
ROUNDS_MAX = const(4)  # entries in a row for events that came meanwhile; the timer takes the rest


class Pacer:
    """engine: has poll(now_us) -> microseconds, recover(now_us), and is_overtaken(now_us), whether
    it had better be entered though nothing is due. link, clock, timer: of `hal`.

    Fields to look at: `runs` (entries into the engine, 16 bit, wraps), `put_off` (those that found
    no stack, 16 bit, wraps) and `failure` (the exception caught last; the engine counts them).
    """

    def __init__(self, engine, link, clock, timer):
        self.runs = 0
        self.put_off = 0
        self.failure = None
        stack_bytes = getattr(link, "stack_bytes", 0)
        self._deep_bytes = stack_bytes and stack_bytes - _ENGINE_BYTES  # 0: it is long enough
        self._engine = engine
        self._link = link
        self._ticks_us = clock.ticks_us
        self._mask = clock.ticks_mask
        self._timer = timer
        # A plain flag is enough: an interrupt ends before the interrupted code goes on.
        self._inside = True  # also before `start` and after `stop`, so that `run` does nothing
        self._again = False
        self._asked_at_us = 0  # when the engine asked to be entered,
        self._due_us = 0  # and how long after that
        self._armed_at_us = 0  # when the timer was set,
        self._armed_us = 0  # and how long after that it comes
        self._thrown = None  # the Ctrl-C that the main loop must raise
        self._on_timer = self._timer_came  # bound once: binding allocates

    def start(self):
        self._inside = False
        self._link.on_activity = self.run
        self.run()

    def stop(self):
        """No interrupt enters the engine any more; the link is closed."""
        self._inside = True
        if self._timer:
            self._timer.deinit()
        self._armed_us = 0
        self._link.close()

    def tend(self):
        """From the main loop: drives the engine if there is no timer or it has made ready what is
        not wanted any more, and wakes a stuck timer. Answers whether it has entered the engine.

        Raises the KeyboardInterrupt that came while the engine was running.
        """
        now_us = self._ticks_us()
        late_us = ((now_us - self._asked_at_us) & self._mask) - self._due_us
        enters = self._timer is None or late_us > OVERDUE_US or self._engine.is_overtaken(now_us)
        if enters:
            self.run()
        if self._thrown is not None:
            thrown, self._thrown = self._thrown, None
            raise thrown
        return enters

    def run(self, only_if_due=False):
        """Enter the engine. If it is running already, let it be entered once more afterwards.

        only_if_due: if nothing is due, only set the timer again. This raises nothing: it may run
        in a handler, and MicroPython may raise a pending Ctrl-C anywhere in it.
        """
        inside = self._inside
        try:  # before the first jump: a pending Ctrl-C is raised at jumps
            if inside:
                self._again = True
                return
            if self._deep_bytes and stack_use() > self._deep_bytes:
                self._put_off()
                return
            for _ in range(ROUNDS_MAX):
                # The order matters, or an interrupt in between would be forgotten: it either
                # enters by itself, or is noted. Look at what is due after that, as it may change
                # it.
                self._again = False
                self._inside = True
                early_us = self._early_us() if only_if_due else 0
                if early_us > 0:
                    self._arm(early_us)
                else:
                    try:
                        now_us = self._ticks_us()
                        self._plan(self._engine.poll(now_us), now_us)
                    except Exception as failure:
                        self.failure = failure
                        self._recover()
                    self.runs = (self.runs + 1) & 0xFFFF
                only_if_due = False
                self._inside = False  # from here on an interrupt enters by itself
                if not self._again:
                    return
            self._inside = True
            self._plan(min(self._due_us, WAKE_US), self._ticks_us())
            self._inside = False
        except BaseException as thrown:
            self._thrown = thrown
            self._again = True
            if inside:
                return  # the run that is inside enters once more
            self._inside = True  # no interrupt may enter while this is half done
            try:
                self._recover()
            finally:
                self._inside = False

    def _put_off(self):
        """The engine is entered a little later, when the program is not so deep any more."""
        self._inside = True
        self.put_off = (self.put_off + 1) & 0xFFFF
        self._asked_at_us = self._ticks_us()
        self._due_us = 0
        self._arm(WAKE_US)
        self._inside = False

    def _recover(self):
        try:
            now_us = self._ticks_us()
            self._engine.recover(now_us)
            self._plan(_RETRY_US, now_us)
        except Exception as failure:  # nothing works: the main loop tries again, or the watchdog
            self.failure = failure

    def _plan(self, after_us, now_us):
        """Let the engine be entered `after_us` after `now_us`.

        Setting the timer takes long, and each exchange moves the instant a little further away. So
        a timer that will come earlier is left as it is, and set again when it comes.
        """
        self._asked_at_us = now_us
        self._due_us = after_us
        comes_us = self._armed_us - ((now_us - self._armed_at_us) & self._mask)
        if comes_us <= 0 or comes_us > after_us:
            self._arm(after_us)

    def _arm(self, after_us):
        timer = self._timer
        if not timer:
            return
        self._armed_us = 0  # in case `init` fails
        self._armed_at_us = self._ticks_us()
        timer.init(
            mode=timer.ONE_SHOT,
            period=after_us if after_us > _PERIOD_MIN_US else _PERIOD_MIN_US,
            tick_hz=1_000_000,
            callback=self._on_timer,
        )
        self._armed_us = after_us

    def _early_us(self):
        """How long there is until the engine wants to be entered; below 0, how late it is."""
        return self._due_us - ((self._ticks_us() - self._asked_at_us) & self._mask)

    def _timer_came(self, _timer):
        self.run(True)
