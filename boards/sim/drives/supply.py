# SPDX-License-Identifier: MIT
"""What feeds a simulated drive: the mains, the DC link, and electronics that boot.

    supply = Supply(clock, switches, process, start=drive.start, stop=drive.stop)
    supply.off()            # the mains go
    supply.on()             # they are back

When the mains go off, the DC link feeds everything for `buffered_ms`. Then it has collapsed: a
motor that is driven loses its pulses (undervoltage, F0003 on a MICROMASTER 4). The electronics
live on for `dark_ms` more. If the mains are back by then, it was a brownout; if later, a blackout.
The MM420 and MM440 operating instructions (3.15, 3.16) tell them apart by a display that has gone
dark. After a blackout the drive boots, and is silent for `boot_ms`. The instructions tell no
times: these are switches (switches.py).
"""

from boards.sim.clock import Event
from boards.sim.drives.power.plant import SUPPLY_V

# From mains that are back to a restart after a brownout (V20 parameter list, P1210: the first
# attempt; general knowledge).
RESTART_US = 1_000_000


class Supply:
    """start, stop: called when the electronics have booted, and when they go dark.

    mains    whether the mains are there
    powered  whether the electronics have power, booted or not
    booted   whether they have booted too
    """

    def __init__(self, clock, switches, process, start, stop):
        self._clock = clock
        self._switches = switches
        self._process = process
        self._start = start
        self._stop = stop
        self._volts = SUPPLY_V
        self._sagged = False  # the DC link has collapsed
        self._sag = Event(self._collapse)
        self._dark = Event(self._go_dark)
        self._boot = Event(self._have_booted)
        self._restart = Event(process.after_brownout)
        self.mains = self.powered = self.booted = False

    def begin(self):
        """Begin as if switched on long ago."""
        self.mains = self.powered = True
        self._have_booted()

    def off(self):
        """Switch the mains off."""
        if self.mains:
            self.mains = False
            self._clock.cancel(self._restart)
            self._after(self._sag, self._switches.buffered_ms)

    def on(self):
        """Switch the mains on."""
        if self.mains:
            return
        self.mains = True
        self._clock.cancel(self._sag)
        self._clock.cancel(self._dark)
        if not self._sagged:
            return
        self._sagged = False
        self._process.supply(self._volts)
        if not self.powered:
            self.powered = True
            self._after(self._boot, self._switches.boot_ms)
        elif self.booted:
            self._clock.schedule(self._restart, self._clock.now_us + RESTART_US)

    def set_volts(self, volts):
        self._volts = volts
        if not self._sagged:
            self._process.supply(volts)

    def _after(self, event, ms):
        """Schedule an event; with 0 ms do it at once, so that it is done when the call returns."""
        if ms:
            self._clock.schedule(event, self._clock.now_us + ms * 1000)
        else:
            event.callback()

    def _collapse(self):
        self._sagged = True
        self._process.supply(0)
        self._after(self._dark, self._switches.dark_ms)

    def _go_dark(self):
        self.powered = self.booted = False
        self._clock.cancel(self._boot)
        self._stop()

    def _have_booted(self):
        self.booted = True
        self._start()
