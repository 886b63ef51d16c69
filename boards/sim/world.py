"""The whole world of a panel in virtual time: wire, drives, chip, a hand at the keys.

    world = World(main.start, addresses=(1, 2))
    world.run(1000)
    world.press("START")
    assert world.lcd()[1].startswith("RUNNING")
    world.check()

The world knows nothing of the firmware: `start(board)` makes it and answers an object that has
`step()`, one turn of its main loop.
"""

import json

from boards.sim.board import KEYS, LOOP_US, Board, Display, Keypad, Store
from boards.sim.chip import Chip
from boards.sim.clock import Clock
from boards.sim.drive import Drive
from boards.sim.wire import Wire

BOOT_US = 100_000  # from reset to the first step of the firmware
TAP_MS = 100
RELEASE_MS = 40  # a key that was let go is up for so long before the hand is at the next one
HANG_SLICE_US = 1_000
COMPLAINTS_SHOWN = 5


class World:
    """start: makes the firmware. addresses: of the drives on the wire. baud: of wire and panel.

    settings: what else the panel's settings file says. seed: 0 is the plain world, in which every
    drive answers after 3 characters and every step of the loop takes 2 ms; any other number gives
    each its own times, the same for the same number. polled: no receive interrupt.
    ticks_start, ticks_mask: of the chip's clock.
    """

    def __init__(
        self,
        start,
        addresses=(1,),
        baud=19200,
        settings=None,
        seed=0,
        polled=False,
        ticks_start=0,
        ticks_mask=0x3FFFFFFF,
    ):
        self.clock = Clock(ticks_start, ticks_mask)
        self.wire = Wire(self.clock, baud)
        self.seed = seed
        self._random = (seed * 0x2545F + 0x1234567) & 0x3FFFFFFF or 1  # never 0
        self.drives = {}
        for address in addresses:
            # Not before two characters have passed, not later than the master waits at this rate.
            fastest_us = self.wire.start_interval_us
            delay_us = self.random(fastest_us, max(15_000, 3 * fastest_us // 2)) if seed else None
            self.drives[address] = Drive(self.clock, self.wire, address, reply_delay_us=delay_us)
        stored = dict(settings or {})
        stored.setdefault("baud", baud)
        stored.setdefault("drives", list(addresses))
        self.display = Display(self.clock)
        self.keypad = Keypad(KEYS)
        self.store = Store(json.dumps(stored).encode())
        self.resets = 0
        self.app = None
        self._start = start
        self._polled = polled
        self._bitten = False
        self.chips = []  # each life of the chip, the last one is `chip`
        self._boot()

    # --- time -----------------------------------------------------------------------------------

    def run(self, ms):
        """Let so many milliseconds pass, the firmware stepping."""
        until_us = self.clock.now_us + ms * 1000
        while self.clock.now_us < until_us:
            self.app.step()
            if self._bitten:
                self.reset()

    def hang(self, ms):
        """Let so many milliseconds pass in which the main loop does not run. Interrupts do."""
        until_us = self.clock.now_us + ms * 1000
        while self.clock.now_us < until_us:
            self.clock.advance(min(HANG_SLICE_US, until_us - self.clock.now_us))
            if self._bitten:
                self.reset()
                self.run(max(0, until_us - self.clock.now_us) // 1000)

    def reset(self):
        """The chip restarts, as after a watchdog: nothing of the firmware survives."""
        self.resets += 1
        self.chip.reset()
        self._boot()

    # --- a hand and an eye ----------------------------------------------------------------------

    def press(self, key, ms=TAP_MS):
        """Hold a key down for `ms` milliseconds, let it go, and let that be noticed."""
        self.down(key)
        self.run(ms)
        self.up(key)
        self.run(RELEASE_MS)

    def down(self, key):
        self.keypad.hold(key)

    def up(self, key):
        self.keypad.let_go(key)

    def lcd(self):
        """The two rows that can be read, 16 characters each."""
        return self.display.text()

    def reads(self, text):
        """Whether a person reads `text` on the display: in a row, or on across both rows."""
        row_1, row_2 = self.lcd()
        across = " ".join((row_1 + " " + row_2).split())
        return text in row_1 or text in row_2 or text in across

    # --- the referee ----------------------------------------------------------------------------

    def check(self):
        """AssertionError when a rule of the line was broken or an interrupt handler failed."""
        complaints = list(self.wire.violations)
        for chip in self.chips:
            for error in chip.handler_errors:
                complaints.append("interrupt handler: %r" % (error,))
        if complaints:
            shown = complaints[:COMPLAINTS_SHOWN]
            if len(complaints) > len(shown):
                shown.append("and %d more" % (len(complaints) - len(shown)))
            raise AssertionError("seed %d: %s" % (self.seed, "; ".join(shown)))

    def random(self, low, high):
        """A number from low to high, of a sequence that the seed decides (xorshift)."""
        state = self._random
        state ^= (state << 7) & 0x3FFFFFFF
        state ^= state >> 9
        state ^= (state << 8) & 0x3FFFFFFF
        self._random = state
        return low + state % (high - low + 1)

    def _boot(self):
        self._bitten = False
        self.chip = Chip(self.clock, self.wire)
        self.chip.on_bite = self._bite
        self.chips.append(self.chip)
        self.clock.advance(BOOT_US)
        loop_us = self._uneven_loop_us if self.seed else None
        board = Board(
            self.chip, self.display, self.keypad, self.store, self._polled, loop_us
        )
        self.app = self._start(board)

    def _bite(self):
        # Inside an event: the world restarts the chip when it has the floor again.
        self._bitten = True
        self.chip.reset()

    def _uneven_loop_us(self):
        return self.random(LOOP_US // 4, LOOP_US * 2)
