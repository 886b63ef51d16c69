"""The panel: keys that act on every page, which drive is selected, which page is shown.

    panel = Panel(controls, bus, keypad.names, settings, clock.ticks_mask)
    panel.step(keypad.read(), now_ms, now_us)      # each step of the loop
    display.show(panel.screen.picture)

START, STOP and the address keys act on every page, STOP before everything else.
"""

from micropython import const

from panel import texts
from panel.keys import Keys
from panel.pages.home import Home
from panel.pages.splash import Splash
from panel.screen import Screen
from uss.timing import elapsed

SPLASH_MS = const(800)
DRAW_MS = const(50)
MESSAGE_MS = const(3_000)
STOP_ALL_MS = const(4_000)  # STOP held so long stops all drives
COARSE_AFTER = const(8)  # repeats of a held key, then the step is COARSE times as large
COARSE = const(10)


class Panel:
    """controls: a `Control` for each drive, at least one. key_names: as the keypad has its bits.

    settings: has setpoint_step_centihertz and complaint. mask: the clock's period - 1.

    For a page: `selected`, the control that is shown; `message`, a row that is shown for a while,
    or None; `announced`, the control of another drive that must be spoken of, with `announcement`.
    """

    def __init__(self, controls, bus, key_names, settings, mask):
        self.controls = controls
        self.selected = controls[0]
        self.screen = Screen()
        self.message = None
        self.announced = None
        self.announcement = None
        self._bus = bus
        self._keys = Keys(key_names, mask)
        self._mask = mask
        self._step_centihertz = settings.setpoint_step_centihertz
        self._home = Home(self)
        self._page = Splash()
        self._began_at = None
        self._complaint = settings.complaint
        self._message_at = 0
        self._stop_at = 0
        self._stop_all_armed = False
        self._drawn_at = None

    def step(self, raw_keys, now_ms, now_us):
        """raw_keys: the keys down now, as bits. Both times are readings of the clock."""
        for control in self.controls:
            control.step(now_us)
        keys = self._keys
        keys.update(raw_keys, now_ms)
        if keys.down:
            self._take_keys(keys, now_ms)
        for control in self.controls:
            refusal = control.take_refusal()
            if refusal and control is self.selected:
                self.say(refusal, now_ms)
        if self._page is not self._home:
            self._splash(now_ms)
        if self.message and elapsed(now_ms, self._message_at, self._mask) >= MESSAGE_MS:
            self.message = None
        if (
            keys.pressed
            or self._drawn_at is None
            or elapsed(now_ms, self._drawn_at, self._mask) >= DRAW_MS
        ):
            self._drawn_at = now_ms
            self._announce()
            self._page.draw(self.screen, now_ms)

    def say(self, text, now_ms):
        """Show a row for MESSAGE_MS, unless something else is said or a key is pressed."""
        self.message = text
        self._message_at = now_ms

    def step_of(self, keys):
        """The step of a value that UP and DOWN move: a key that is held soon moves it faster."""
        coarse = keys.repeated and keys.repeats > COARSE_AFTER
        return self._step_centihertz * (COARSE if coarse else 1)

    def line_in_use(self):
        """Whether another master was heard before the first telegram, so that none is sent."""
        return self._bus.is_line_in_use()

    def _splash(self, now_ms):
        if self._began_at is None:
            self._began_at = now_ms
        if elapsed(now_ms, self._began_at, self._mask) >= SPLASH_MS or self._keys.pressed:
            self._page = self._home
            if self._complaint:
                self.say(texts.SETTINGS_DAMAGED, now_ms)

    def _take_keys(self, keys, now_ms):
        if keys.pressed:
            self.message = None
        stop = keys.bit("STOP")
        if keys.pressed & stop:
            self.selected.stop()
            self._stop_at = now_ms
            self._stop_all_armed = True
        if keys.down & stop:
            self._stop_all_when_held(now_ms)
        if keys.pressed & keys.bit("START"):
            self._start(keys.down & stop, now_ms)
        if keys.pressed & keys.bit("ADDRESS_UP"):
            self._select(1)
        elif keys.pressed & keys.bit("ADDRESS_DOWN"):
            self._select(-1)
        self._page.take_keys(keys)

    def _start(self, stop_is_down, now_ms):
        if self._page is not self._home:
            return  # nobody has seen yet which drive would start, and how fast
        if stop_is_down:
            self.say(texts.REFUSED_STOP, now_ms)
        else:
            self.selected.start()

    def _stop_all_when_held(self, now_ms):
        held_ms = elapsed(now_ms, self._stop_at, self._mask)
        if self._stop_all_armed and held_ms >= STOP_ALL_MS:
            self._stop_all_armed = False
            for control in self.controls:
                control.stop()
            self.say(texts.ALL_STOPPED, now_ms)

    def _select(self, direction):
        """Show another drive. It starts and stops nothing."""
        position = self.controls.index(self.selected) + direction
        self.selected = self.controls[position % len(self.controls)]

    def _announce(self):
        """Find the drive, not selected, that most needs to be spoken of."""
        self.announced = None
        highest = 0
        for control in self.controls:
            if control is self.selected:
                continue
            if control.stop_watch.unconfirmed:
                rank, text = 3, texts.OTHER_UNCONFIRMED
            elif control.lost_running:
                rank, text = 2, texts.OTHER_LOST
            elif control.runs():
                rank, text = 1, texts.OTHER_RUNS
            else:
                continue
            if rank > highest:
                highest = rank
                self.announced = control
                self.announcement = text
