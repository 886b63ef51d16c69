# SPDX-License-Identifier: MIT
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
from collections import OrderedDict

from boards.sim.board import KEYPADS, LOOP_US, NORMALLY_CLOSED, Board
from boards.sim.chip.machine import Chip
from boards.sim.clock import Clock
from boards.sim.dice import Dice
from boards.sim.chip.flash import Flash, PowerCut
from boards.sim.chip.lcd import Lcd
from boards.sim.chip.usb import Usb
from boards.sim.chip.switches import Switches
from boards.sim.line.wire import Wire
from boards.sim.drives.families import mm420, setting_of
from boards.sim.drives.drive import Drive
from boards.sim.drives.mains import Mains
from hal.store import FileStore

BOOT_US = 100_000  # from reset to the first step of the firmware
SETTINGS_FILE = "settings.json"
TAP_MS = 100
RELEASE_MS = 40  # after a key is let go, the hand takes so long to the next one
HANG_SLICE_US = 1_000
COMPLAINTS_SHOWN = 5


class Surroundings:
    """Everything around the chip of a panel, whichever chip that is: a line with drives, the
    controller of the display, switches; a hand that presses them, an eye, and a referee.

    addresses: of the drives on the wire. baud: of wire and panel. settings: what else the panel's
    settings file says. seed: 0 is the plain world, in which every drive answers after 3
    characters; any other number gives each its own time, the same for the same number, and keys
    bounce. keys: "direct", each with a pin of its own, "matrix", all but START and STOP, or
    "compact", eight keys with pins of their own.
    parameters: of every drive, {number: value}; without them they are supervised, P2014, as
    commissioned drives are. kinds: {address: what else `Drive` is given there}, such as
    {3: {"family": g110, "parameters": {2013: 0}, "reply_delay_us": 4_000}}; fleet.py has some,
    kinds.py makes them from what a person has written. A drive with "factory" stands on the wire,
    and not in the settings.

    random    a function of (low, high): the numbers of the seed
    stored    what the panel's settings file should say; None: there is to be none
    resets    how often the chip has restarted
    place     where the panel runs, for people
    refused   commands of the script language that cannot be done here: name -> why
    notices   lines for people that were not shown yet
    port      None: the line is simulated; or the port of the computer that is the line
    """

    place = "the virtual board"
    refused = {}
    run = None  # run(ms): lets time pass; each world defines it
    notices = ()
    port = None

    def __init__(
        self,
        clock,
        addresses,
        baud,
        settings,
        seed,
        keys="direct",
        parameters=None,
        kinds=None,
    ):
        self.clock = clock
        self.wire = Wire(clock, baud)
        self.seed = seed
        self.random = Dice(seed).random
        supervised_ms = supervision_ms(baud, len(addresses))
        self.drives = OrderedDict()  # a dict of MicroPython has an order of its own
        for address in addresses:
            # Not before two characters have passed, not later than the master waits at this rate.
            fastest_us = self.wire.start_interval_us
            delay_us = self.random(fastest_us, max(15_000, 3 * fastest_us // 2)) if seed else None
            kind = {"reply_delay_us": delay_us, "parameters": parameters}
            kind.update((kinds or {}).get(address, {}))
            if kind.get("factory"):
                kind["reply_delay_us"] = None  # it may be too short at the rate of its own
            elif kind["parameters"] is None:
                kind["parameters"] = supervision(kind.get("family", mm420), supervised_ms)
            self.drives[address] = Drive(clock, self.wire, address, **kind)
        self.mains = Mains(clock, list(self.drives.values()))
        self.stored = dict(settings or {})
        self.stored.setdefault("baud", baud)
        known = [address for address in addresses if not self.drives[address].factory]
        if known or not addresses:  # of a drive as delivered nobody has told the panel
            self.stored.setdefault("drives", known)
        self.lcd_chip = Lcd(clock)
        if keys not in KEYPADS:
            raise ValueError("keys are wired %s, not %s" % (" or ".join(KEYPADS), keys))
        names, matrix = KEYPADS[keys]
        self.keypad = Switches(
            clock, names, NORMALLY_CLOSED, matrix, self.random if seed else None
        )
        self.resets = 0

    # --- a hand and an eye ----------------------------------------------------------------------

    def press(self, key, ms=TAP_MS):
        """Hold a key down for `ms` milliseconds, let it go, and wait until that is noticed."""
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
        return self.lcd_chip.text()

    def reads(self, text):
        """Whether a person reads `text` on the display: in a row, or on across both rows."""
        row_1, row_2 = self.lcd()
        across = " ".join((row_1 + " " + row_2).split())
        return text in row_1 or text in row_2 or text in across

    # --- the referee ----------------------------------------------------------------------------

    def check(self):
        """AssertionError: a rule of line or display was broken, or an interrupt handler failed."""
        complaints = self.complaints()
        if complaints:
            shown = complaints[:COMPLAINTS_SHOWN]
            if len(complaints) > len(shown):
                shown.append("and %d more" % (len(complaints) - len(shown)))
            raise AssertionError("seed %d: %s" % (self.seed, "; ".join(shown)))

    def complaints(self):
        """The rules that were broken, as texts."""
        complaints = list(self.wire.violations())
        for complaint in self.lcd_chip.complaints():
            complaints.append("display: " + complaint)
        return complaints


class World(Surroundings):
    """start: makes the firmware. polled: no receive interrupt. ticks_start, ticks_mask: of the
    chip's clock; or give a `clock` instead. store: keeps the panel's settings in place of the
    flash; what it has already is not touched. unset: the panel has no settings file yet, as at its
    first power-on. loop_us: how long each step of the main loop takes in the plain world; with a
    seed each takes its own time. The others are those of `Surroundings`. With an odd seed the
    UART's receive time-out comes again while characters are left (`Chip`).
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
        keys="direct",
        parameters=None,
        store=None,
        kinds=None,
        clock=None,
        unset=False,
        loop_us=LOOP_US,
    ):
        clock = clock or Clock(ticks_start, ticks_mask)
        Surroundings.__init__(
            self, clock, addresses, baud, settings, seed, keys, parameters, kinds
        )
        stored = json.dumps(self.stored).encode()
        self.flash = Flash(busy=self._flash_is_busy)
        self.store = store or FileStore(SETTINGS_FILE, self.flash.open, self.flash)
        if unset:
            pass
        elif store is None:
            self.flash.files[SETTINGS_FILE] = stored
        elif store.read(0) is None:
            store.replace(stored)
        self.usb = Usb()
        self.app = None
        self.start = start
        self._polled = polled
        self._loop_us = loop_us
        self._bitten = False
        self._dipped = False
        self.chips = []  # each life of the chip, the last one is `chip`
        self._boot()

    # --- time -----------------------------------------------------------------------------------

    def run(self, ms):
        """Let so many milliseconds pass, the firmware stepping."""
        clock = self.clock
        until_us = clock.now_us + ms * 1000
        while clock.now_us < until_us:
            try:
                following = self.app.step()
                if following:
                    self._hand_over(following)
            except PowerCut:  # `flash.cut_at` was reached; power is back at once
                self.flash.power_on()
                self.reset()
            if self._bitten:
                self.reset()
            elif self._dipped:
                self.cut_power()

    def hang(self, ms):
        """Let so many milliseconds pass in which the main loop does not run. Interrupts do."""
        until_us = self.clock.now_us + ms * 1000
        while self.clock.now_us < until_us:
            self.clock.advance(min(HANG_SLICE_US, until_us - self.clock.now_us))
            if self._bitten or self._dipped:
                self.reset()
                self.run(max(0, until_us - self.clock.now_us) // 1000)

    def reset(self):
        """The chip restarts, as after a watchdog: nothing of the firmware survives."""
        self.resets += 1
        self.lcd_chip.let_go()
        self.chip.reset()
        self._boot()

    def cut_power(self):
        """Power goes, for the display as well, and is back at once."""
        self.lcd_chip.let_go()
        self.lcd_chip.power_on()
        self.reset()

    def dip(self, whose, ms):
        """The supply of "drives", "panel" or "all" fails. The drives have none for `ms`; the panel
        restarts as soon as no event is running. May be called in an event: `LineFaults.on_dip`.
        """
        if whose != "panel":
            self.mains.dip(ms)
        if whose != "drives":
            self._dipped = True
            self.lcd_chip.let_go()
            self.chip.reset()

    def close(self):
        """Stop the drives, and the panel with them."""
        self.app.close()

    def selected(self):
        """The address of the drive that the panel shows."""
        return self.app.panel.selected.drive.address

    def complaints(self):
        complaints = Surroundings.complaints(self)
        for chip in self.chips:
            for error in chip.handler_errors:
                complaints.append("interrupt handler: %r" % (error,))
        return complaints

    def _boot(self):
        cause = "WATCHDOG" if self._bitten else ""
        self._bitten = self._dipped = False
        self.chip = self.make_chip()
        self.chip.on_bite = self._bite
        self.chips.append(self.chip)
        self.clock.advance(BOOT_US)
        loop_us = self._uneven_loop_us if self.seed else self._even_loop_us
        self.app = self.start(self.make_board(loop_us, cause))

    def make_chip(self):
        return Chip(self.clock, self.wire, timeout_again=bool(self.seed & 1))

    def make_board(self, loop_us, cause):
        """The board around the chip that has just booted. As `Board`."""
        return Board(
            self.chip,
            self.lcd_chip,
            self.keypad,
            self.store,
            self._polled,
            loop_us,
            cause,
            self.usb,
        )

    def _hand_over(self, following):
        """Another program has the chip from now on."""
        self.app = following

    def _flash_is_busy(self, us):
        # The firmware runs from the same flash, so it stands still meanwhile.
        irq = self.chip.disable_irq()
        self.clock.advance(us)
        self.chip.enable_irq(irq)

    def _bite(self):
        # This is inside an event: the world restarts the chip after it.
        self._bitten = True
        self.lcd_chip.let_go()
        self.chip.reset()

    def _even_loop_us(self):
        return self._loop_us

    def _uneven_loop_us(self):
        return self.random(LOOP_US // 4, LOOP_US * 2)


def supervision(family, ms):
    """The parameter that makes a drive of a family supervise its line, for at least so long."""
    unit_us = family.LINK["unit us"]
    return {setting_of(family, "off time"): -(-ms * 1000 // unit_us)}


def supervision_ms(baud, drives):
    """A telegram off time that fits a line: four rounds in which every answer comes late."""
    exchange_ms = 2 * 16 * 11_000 // baud + 20
    return min(max(4 * exchange_ms * drives, 2_000), 60_000)
