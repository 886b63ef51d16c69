# SPDX-License-Identifier: MIT
"""The microcontroller: what firmware uses of `machine` on the RP2040, on virtual time.

It executes no instructions: firmware runs as it is and takes no time. Names, arguments and limits
are those of the port, except that a constructor takes the Chip first and readinto() never waits.
Interrupt handlers run inside Clock.advance at their exact instant, hard ones with the heap locked,
as on the chip. No method that firmware calls takes heap; constructors, deinit() and resets do.

    chip = Chip(clock, wire)
    uart = UART(chip, 19200)
    driver_enable = Pin(chip)
    Transceiver(wire, uart, driver_enable)
    uart.irq(handler, UART.IRQ_RXIDLE, hard=True)
    timer = Timer(chip)
    timer.init(mode=Timer.ONE_SHOT, period=500, tick_hz=1_000_000, callback=handler)
"""

import sys

from micropython import const

from boards.sim.clock import Event
from boards.sim.line.wire import BURST_LIMIT, copy

try:
    from micropython import heap_lock, heap_unlock
except ImportError:  # CPython cannot lock its heap

    def heap_lock():
        pass

    def heap_unlock():
        pass


# After this instant virtual time is no longer a small integer, so that the simulator itself takes
# heap. Handlers then run with the heap unlocked. 17.5 minutes on the 32-bit build.
_HEAP_LOCK_UNTIL_US = (sys.maxsize >> 1) - 25_000_000

_ERROR_LIMIT = 16

PINS = 30

# Of a UART, in characters: the buffer of its driver and its FIFO. When this holds FULL_FIFO, the
# driver's interrupt handler takes all but one of them, so that the receive time-out will come.
RX_BUFFER, RX_FIFO = 256, 32
FULL_FIFO = 24
RX_LIMIT = RX_BUFFER + RX_FIFO

STORM_US = 50  # how long each run of a handler takes that comes again and again
STORM_LIMIT_US = 10_000_000  # the main loop waits no longer for the end of that


class Chip:
    """The chip as a whole: its interrupts and its reset.

    timeout_again: a receive time-out that was cleared comes again at once as long as characters
    are left in the FIFO. The documents leave that open.
    levels           the levels of its pins as bits, as its register shows them
    handler_errors   exceptions that interrupt handlers ended with, the first 16
    on_bite          called when the watchdog bites: a reset, unless you set another function
    """

    def __init__(self, clock, wire, timeout_again=False):
        self.clock = clock
        self.wire = wire
        self.timeout_again = timeout_again
        self.uarts = []
        self.storms = False  # an interrupt comes again whenever its handler returns
        self.levels = 0
        self.handler_errors = []
        self.on_bite = self.reset
        self.peripherals = []
        self.pins = []
        self._masked = False
        self._in_handler = False
        self._first_waiting = None
        self._last_waiting = None

    def reset(self):
        """Reset everything: sending stops, pins go low, timers and interrupts are gone.

        Peripherals made before are dead: using them does nothing. The firmware makes new ones.
        """
        peripherals, self.peripherals = self.peripherals, []
        pins, self.pins = self.pins, []
        self.uarts = []
        self.storms = False
        for peripheral in peripherals:
            peripheral.die()
        for pin in pins:
            pin.die()
        self.levels = 0
        self._masked = False
        self._first_waiting = None
        self._last_waiting = None

    def disable_irq(self):
        """Interrupts wait from now on. Returns the state for enable_irq."""
        self._let_uarts_collect()
        state = self._masked
        self._masked = True
        return state

    def enable_irq(self, state):
        """Back to the `state` that disable_irq returned; interrupts that waited run at once."""
        self._let_uarts_collect()
        self._masked = state
        self._let_uarts_collect()
        self._serve()

    def is_masked(self):
        return self._masked

    def wait_out_storm(self):
        """The main loop does nothing as long as an interrupt comes again and again."""
        waited_us = 0
        while self.storms and waited_us < STORM_LIMIT_US:
            self.clock.advance(STORM_US)
            waited_us += STORM_US

    def _let_uarts_collect(self):
        for uart in self.uarts:
            uart.collect()

    def interrupt(self, interrupt):
        """Run the handler of `interrupt` now, or as soon as interrupts are allowed."""
        if interrupt.waiting:
            return
        interrupt.waiting = True
        interrupt.next = None
        if self._first_waiting is None:
            self._first_waiting = interrupt
        else:
            self._last_waiting.next = interrupt
        self._last_waiting = interrupt
        self._serve()

    def _serve(self):
        # Handlers do not interrupt each other: all have one priority.
        while self._first_waiting is not None and not (self._masked or self._in_handler):
            interrupt = self._first_waiting
            self._first_waiting = interrupt.next
            interrupt.waiting = False
            if not interrupt.is_due() or interrupt.handler is None:
                continue
            self._in_handler = True
            try:
                self._run(interrupt)
            finally:
                self._in_handler = False

    def _run(self, interrupt):
        if interrupt.hard and self.clock.now_us < _HEAP_LOCK_UNTIL_US:
            heap_lock()
            try:
                error = interrupt.failure()
            finally:
                heap_unlock()
        else:
            error = interrupt.failure()
        if error is not None:
            interrupt.handler = None
            if len(self.handler_errors) < _ERROR_LIMIT:
                self.handler_errors.append(error)


class Interrupt:
    """One interrupt of one peripheral: the handler, and a place in the chip's queue.

    is_due() tells, at the handler's turn, whether there is still a reason to call it.
    """

    def __init__(self, source, is_due):
        self.source = source
        self.is_due = is_due
        self.handler = None
        self.hard = False
        self.waiting = False
        self.next = None

    def failure(self):
        """Run the handler; return what it raised, or None."""
        try:
            self.handler(self.source)
        except Exception as error:
            return error


class UART:
    """machine.UART, 8E1, as far as it is used, with the RP2040's ways.

    Receiving: 32 characters of FIFO, which the driver moves into a buffer of 256 by interrupts;
    what does not fit is lost. IRQ_RXIDLE comes 32 bit times after the last character, if
    characters are left in the FIFO: any() and readinto() empty it, so whoever polls gets no
    interrupt. While the buffer is full, the FIFO stays as it is: IRQ_RXIDLE then comes once, or
    again and again.
    """

    IRQ_RXIDLE = 0x40

    def __init__(self, chip, baudrate):
        self.baud = baudrate
        self.line = None  # the transceiver puts itself here
        self._chip = chip
        self._clock = chip.clock
        self._buffer = bytearray(RX_LIMIT)
        self._head = 0
        self._count = 0
        self._in_fifo = 0  # how many of them, the last ones, are still in the FIFO
        self._sent_us = chip.clock.now_us
        self._sending = 0
        self._interrupt = Interrupt(self, self._is_due)
        self._timeout = Event(self._timed_out)
        self._timeout_us = -(-32_000_000 // baudrate)
        chip.peripherals.append(self)
        chip.uarts.append(self)

    def irq(self, handler=None, trigger=0, hard=False):
        """Call handler(uart) on IRQ_RXIDLE; None stops that. Anything else: ValueError."""
        if handler is not None and not callable(handler):
            raise ValueError("handler must be None or callable")
        if trigger & ~self.IRQ_RXIDLE:
            raise ValueError("trigger 0x%04x unsupported" % trigger)
        self._interrupt.handler = handler if trigger else None
        self._interrupt.hard = bool(hard)

    def any(self):
        """How many characters are in the buffer. Empties the FIFO into it, as far as there is
        room, and so suppresses IRQ_RXIDLE."""
        self.collect()
        self._move(RX_FIFO)
        return self._count - self._in_fifo

    def readinto(self, buffer, n=None):
        """Take what waits, at most len(buffer) or `n`. Returns how many, or None for nothing."""
        self.collect()
        limit = len(buffer)
        if n is not None and n < limit:
            limit = n
        count = self._count - self._in_fifo
        if count < limit:  # the buffer is empty now
            count = self._count
            self._in_fifo = 0
        if count > limit:
            count = limit
        if not count:
            return None
        self._hand_over(buffer, count)
        return count

    def fifo_holds(self):
        """Whether characters stand in the FIFO: what RXFE in the register UARTFR tells."""
        self.collect()
        return self._in_fifo > 0

    def drop_fifo(self):
        """Read the register UARTDR until the FIFO is empty."""
        self._count -= self._in_fifo
        self._in_fifo = 0

    def collect(self):
        """Put the characters that have come by now into the FIFO, or the buffer."""
        if self.line is not None:
            self.line.collect()
        if self._in_fifo >= FULL_FIFO and not self._chip.is_masked():
            self._serve_full()

    def _move(self, most):
        """Move so many characters from the FIFO to the buffer, as far as there is room."""
        moved = min(most, self._in_fifo, RX_BUFFER - (self._count - self._in_fifo))
        if moved:
            self._in_fifo -= moved
            if self._in_fifo:  # reading starts the time-out anew
                self._clock.schedule(self._timeout, self._clock.now_us + self._timeout_us)

    def _serve_full(self):
        """Run the driver's handler each time that the FIFO held FULL_FIFO."""
        times = (self._in_fifo - FULL_FIFO) // (FULL_FIFO - 1) + 1
        room = RX_BUFFER - (self._count - self._in_fifo)
        self._in_fifo -= min(times * (FULL_FIFO - 1), room)

    def _hand_over(self, buffer, count):
        data = self._buffer
        at = self._head
        if not at and count <= BURST_LIMIT:
            copy(data, count, buffer, 0)
            at = count
        else:
            for i in range(count):
                buffer[i] = data[at]
                at = at + 1 if at + 1 < RX_LIMIT else 0
        self._head = at
        self._count -= count

    def write(self, data, n=None):
        """Send `data`, or `n` characters of it, at once or as soon as earlier characters are out.

        Returns how many characters were taken; None if there is no room for a single one.
        """
        count = len(data)
        if n is not None and n < count:
            count = n
        if not count:
            return 0
        if self._sent_us <= self._clock.now_us:
            self._sending = 0
        count = min(count, BURST_LIMIT - self._sending)
        if self.line is None or not count:
            return None
        self._sent_us = self.line.send(data, count)
        self._sending += count
        return count

    def txdone(self):
        """Whether the last stop bit is over."""
        return self._clock.now_us >= self._sent_us

    def deinit(self):
        """Turn it off: it stops sending, drops what waits and calls no handler."""
        self._interrupt.handler = None
        self._clock.cancel(self._timeout)
        self._count = 0
        self._in_fifo = 0
        self._sent_us = self._clock.now_us
        if self.line is not None:
            self.line.unplug()

    die = deinit

    # The line's side

    def receive(self, data, first, stop):
        """Characters first...stop - 1 of `data` come in."""
        buffer = self._buffer
        masked = self._chip.is_masked()
        room = RX_FIFO - self._in_fifo if masked else RX_LIMIT - self._count
        if stop - first > room:
            stop = first + room
        if not self._count:
            self._head = 0  # so that mostly all is copied at one go
        at = (self._head + self._count) % RX_LIMIT
        self._count += stop - first
        self._in_fifo += stop - first
        if not first and at + stop <= RX_LIMIT:
            copy(data, stop, buffer, at)
        else:
            while first < stop:
                buffer[at] = data[first]
                first += 1
                at = at + 1 if at + 1 < RX_LIMIT else 0
        if self._in_fifo >= FULL_FIFO and not masked:
            self._serve_full()

    def quiet_since(self, at_us):
        """The last character ended at `at_us`."""
        if self._in_fifo:
            self._clock.schedule(self._timeout, at_us + self._timeout_us)

    def _timed_out(self):
        self._chip.storms = False
        # Characters of the next burst have come already: its end will start the time-out anew.
        if self.line is not None and self.line.receiving():
            return
        if self._in_fifo:
            self._chip.interrupt(self._interrupt)

    def _is_due(self):
        """Run the driver's handler; return whether it calls the program's."""
        due = self._in_fifo > 0
        if due and self._chip.timeout_again and self._count - self._in_fifo == RX_BUFFER:
            self._chip.storms = True
            self._clock.schedule(self._timeout, self._clock.now_us + STORM_US)
        self._move(FULL_FIFO - 1)
        return due


_IN = const(0)
_OUT = const(1)


class Pin:
    """machine.Pin: an output, an open-drain output, or an input with or without a pull.

    output             what the pin does to its wire. OUT: the level. OPEN_DRAIN: 0 pulls it low, 1
                       lets go of it.
    on_change(output)  tells the rest of the board when that changes
    apply(level)       what the rest of the board does to the wire: 0, 1, or None for nothing

    An input, and an open-drain output that has let go, read what is applied, else the pull; a wire
    that nothing holds is 0.
    mask               its bit in `Chip.levels`; 0 for pins after the thirtieth

    A reset leaves the wire to the board: an output is low, as by a resistor to ground.
    """

    IN = _IN
    OUT = _OUT
    OPEN_DRAIN = 2
    PULL_UP = 1
    PULL_DOWN = 2

    def __init__(self, chip, mode=OUT, pull=None, *, value=0, on_change=None):
        if mode not in (self.IN, self.OUT, self.OPEN_DRAIN):
            raise ValueError("invalid mode %r" % (mode,))
        self.mode = mode
        self.pull = pull
        self.on_change = on_change
        self.mask = 1 << len(chip.pins) if len(chip.pins) < PINS else 0
        self.output = 1 if mode == self.OPEN_DRAIN else 0
        self._chip = chip
        # A pin is read and set thousands of times a second, so both are prepared here.
        self._settable = mode != self.IN
        self._let_go = 1 if pull == self.PULL_UP else 0  # the level if the pin does not drive
        self._level = 0  # what value() answers
        chip.pins.append(self)
        self.value(value)
        self._settle()

    def value(self, level=None):
        """Return the level, or set it. Setting the level of an input changes nothing."""
        if level is None:
            return self._level
        output = level = 1 if level else 0
        if output == self.output or not self._settable:
            return
        self.output = output
        if output and self.mode != _OUT:  # as in `_settle`, without a call
            level = self._let_go
        if level != self._level:
            self._level = level
            self._chip.levels ^= self.mask
        if self.on_change is not None:
            self.on_change(output)

    __call__ = value

    def on(self):
        self.value(1)

    def off(self):
        self.value(0)

    def apply(self, level):
        if level is None:
            level = 1 if self.pull == self.PULL_UP else 0
        self._let_go = level
        self._settle()

    def die(self):
        self.value(1 if self.mode == self.OPEN_DRAIN else 0)
        self._settable = False
        self.mask = 0

    def _settle(self):
        level = self.output
        if self.mode != _OUT and (level or self.mode == _IN):
            level = self._let_go
        if level != self._level:
            self._level = level
            self._chip.levels ^= self.mask


class Timer:
    """machine.Timer, the virtual one: there may be any number."""

    ONE_SHOT = 0
    PERIODIC = 1

    def __init__(self, chip):
        self._chip = chip
        self._clock = chip.clock
        self._mode = self.PERIODIC
        self._period_us = 0
        self._is_hard = False  # whatever `init` says
        self._interrupt = Interrupt(self, self._is_due)
        self._alarm = Event(self._elapsed)
        self._due = False
        self._alive = True
        chip.peripherals.append(self)

    def init(self, *, mode=PERIODIC, period=0xFFFFFFFF, tick_hz=1000, callback=None, hard=False):
        """Call callback(timer) after `period` ticks, or each time they have passed.

        A running timer starts anew. Less than 1 us is 1 us. A hard callback takes no heap (RP2040
        since MicroPython 1.26; 1.25 refuses the argument). TypeError: no integers. ValueError: a
        negative period, with which the chip's timer would not fire in a lifetime.
        """
        if mode | period | tick_hz < 0:  # only integers can be put together like this
            raise ValueError("negative period")
        self._mode = mode
        if 1_000_000 % tick_hz == 0:  # otherwise 32-bit integers would take heap
            period_us = period * (1_000_000 // tick_hz)
        else:
            period_us = period * 1_000_000 // tick_hz
        self._period_us = max(period_us, 1)
        self._interrupt.handler = callback
        self._interrupt.hard = hard or self._is_hard
        self._due = False
        if self._alive:
            self._clock.schedule(self._alarm, self._clock.now_us + self._period_us)

    def deinit(self):
        """Stop, and forget a callback that waits for its turn."""
        self._clock.cancel(self._alarm)
        self._due = False

    def die(self):
        self.deinit()
        self._alive = False

    def _elapsed(self):
        if self._mode != self.ONE_SHOT:
            self._clock.schedule(self._alarm, self._alarm.at_us + self._period_us)
        self._due = True
        self._chip.interrupt(self._interrupt)

    def _is_due(self):
        return self._due


class WDT:
    """machine.WDT: cannot be stopped, only fed; a reset ends it. ValueError: over `longest_ms`."""

    def __init__(self, chip, timeout_ms=5000, longest_ms=8388):
        if not 0 < timeout_ms <= longest_ms:
            raise ValueError("timeout exceeds %d" % longest_ms)
        self._chip = chip
        self._timeout_us = timeout_ms * 1000
        self._alive = True
        self._bite = Event(self._bitten)
        chip.peripherals.append(self)
        self.feed()

    def feed(self):
        """Start `timeout_ms` anew."""
        if self._alive:
            clock = self._chip.clock
            clock.schedule(self._bite, clock.now_us + self._timeout_us)

    def die(self):
        self._alive = False
        self._chip.clock.cancel(self._bite)

    def _bitten(self):
        self._chip.on_bite()
