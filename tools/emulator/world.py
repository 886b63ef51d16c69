# SPDX-License-Identifier: MIT
"""The world of `boards.sim` around an emulated Pico: the real firmware in the real chip's time.

    world = PicoWorld("panel", addresses=(1, 2))    # build/pico/panel.uf2 on a chip that has power
    world.run(1000)
    world.press("START")
    assert world.lcd()[1].startswith("RUNNING")
    world.check()

It has the face of `boards.sim.world.World`, except `hang`: only a program inside the chip can do
that. It runs on the Unix port under launch.py. The world's clock stands behind the chip's by a
little less than a character, so that whatever the chip sends is known before its turn comes, and
whatever it receives still lies before it.
"""

import json
import os

from boards.sim.board import KEYS
from boards.sim.chip.backpack import Backpack
from boards.sim.clock import Clock, Event
from boards.sim.world import SETTINGS_FILE, Surroundings
from tools.emulator.chip import connection
from tools.emulator.flash_image import FlashImage
from tools.emulator.repl import Repl
from tools.emulator.station import Station, rate_of

BEHIND_BITS_PERCENT = 1090  # how far the world is behind the chip, in bits at the chip's rate

# Where things are on the board: boards/pico/README.md.
SENDS, RECEIVES, DRIVER_ENABLE = 4, 5, 6
LCD_RS, LCD_E, LCD_DATA = 7, 8, (9, 10, 11, 12)
LED = 25  # the Pico's own, which the panel leaves alone
KEY_PINS = {
    "START": 13,
    "STOP": 14,
    "REVERSE": 3,
    "JOG_RIGHT": 16,
    "JOG_LEFT": 17,
    "UP": 18,
    "DOWN": 19,
    "ADDRESS_UP": 20,
    "ADDRESS_DOWN": 21,
    "PARAM": 22,
    "NEXT": 26,
    "PREVIOUS": 27,
    "EDIT": 28,
    "SET": 2,
}

DISPLAYS = ("wires", "backpack")
PROGRAMS = ("panel", "stock")
build = ""  # which build of them: "_hard", that of a MicroPython with hard timers (fetch/pico.sh)

LOW, HIGH, NOBODY, SHORTED_HIGH = 0, 1, 2, 3  # of a wire, in the records
RUN_PIN, POWER = 0, 1  # kinds of reset that a world can do
RESET_CAUSES = {1: "watchdog", 2: "reset", 3: "power"}

LOG_MAX = 10_000
USB_KEPT_BYTES = 100_000
WAIT_STEP_MS = 5
CLOSE_MS = 3_000

TOP = __file__.rsplit("/", 3)[0] if __file__.count("/") > 2 else "."


class Output:
    """A pin of the chip that something of the board listens to: `on_change(level)`."""

    def __init__(self):
        self.on_change = None
        self._level = 0

    def put(self, state):
        level = 1 if state == HIGH else 0  # a wire that nobody drives is low
        if level != self._level:
            self._level = level
            if self.on_change is not None:
                self.on_change(level)


class Input:
    """A pin of the chip that something of the board drives; None: it lets go."""

    def __init__(self, world, gpio):
        self._world = world
        self._gpio = gpio

    def apply(self, level):
        self._world.tell("P", self._gpio, NOBODY if level is None else level)


class PicoWorld(Surroundings):
    """program: "panel" or "stock" of build/pico, as `build` says, or the path of a UF2 file.
    addresses, baud, settings, seed, parameters, kinds: as in `Surroundings`; a seed makes keys
    bounce and drives answer each in its own time.

    display: "wires", four data lines, or "backpack", on I2C. files: path -> content, put on the
    chip's file system. flash: path of a flash image to begin with, of which all but the program
    stays, and which gets no settings if it has some. new: nobody has given the panel settings yet;
    baud is that of the line alone. model: settings of the emulated chip that
    differ from the usual ones, as {"receive_timeout": "again"}: README.md. jumpers: (from, to) of
    wires between two GPIOs; one from TX to RX makes the chip hear itself.

    figures        of the line, see `station.Figures`
    restarts       [(at_us, cause)], also as `reset_causes`; cause: "watchdog", "reset" or "power"
    flash_log      [(at_us, what, duration_us)], what: 1 erase, 2 program, 3 erase of a block
    led            [(at_us, on)] of the Pico's own LED, with which a script can tell something
    usb            what came from the USB serial, the last 100 000 bytes
    repl           the MicroPython prompt, over USB
    """

    place = "an emulated Pico"
    refused = {"hang": "nobody can hang the emulated chip from outside"}

    def __init__(
        self,
        program="panel",
        addresses=(1,),
        baud=19200,
        settings=None,
        seed=0,
        parameters=None,
        display="wires",
        files=None,
        flash=None,
        model=None,
        kinds=None,
        new=False,
        jumpers=(),
    ):
        if display not in DISPLAYS:
            raise ValueError("a display is one of: %s" % " ".join(DISPLAYS))
        Surroundings.__init__(
            self, Clock(), addresses, baud, settings, seed, "direct", parameters, kinds
        )
        self.chip = connection()
        self.restarts = []
        self.flash_log = []
        self.led = []
        self._selected = None
        self.usb = bytearray()
        self.repl = Repl(self)
        self._origin_ns = self.chip.now_ns
        self._behind_ns = behind_ns(baud)
        self._records = []  # (at_ns, kind, a, b) that are not due in the world yet
        self._due = Event(self._take_due)
        self._outputs = {}
        self._depths = [0, 0]
        if new:
            self.stored = None
        self._begin_chip(program_path(program), baud, display, files or {}, flash, model, jumpers)
        self.station = Station(self.wire, self.chip, self._origin_ns)
        self.figures = self.station.figures
        self.backpack = None
        if display == "backpack":
            self.backpack = Backpack(self.clock, self.lcd_chip)
        self._wire_display()
        self.keypad.connect([Input(self, KEY_PINS[key]) for key in KEYS])

    # --- time -----------------------------------------------------------------------------------

    def run(self, ms):
        """Let so many milliseconds pass."""
        clock = self.clock
        until_us = clock.now_us + ms * 1000
        while clock.now_us < until_us:
            self.station.revise()
            # What happens in the world at an instant reaches the chip a character later.
            bound_us = self._next_event_us(until_us)
            self.chip.run(self._chip_ns(bound_us), self._take, self.station.goes_on_percent)
            reached_us = (self.chip.now_ns - self._origin_ns - self._behind_ns) // 1000
            clock.advance_to(max(clock.now_us, min(reached_us, until_us)))

    def run_until(self, condition, ms):
        """Let time pass until `condition()` is true, `ms` at the most; answer whether it is."""
        until_us = self.clock.now_us + ms * 1000
        while not condition():
            if self.clock.now_us >= until_us:
                return False
            self.run(WAIT_STEP_MS)
        return True

    def reset(self):
        """The chip's RUN pin is pulsed low."""
        self.tell("X", RUN_PIN)
        self._settle()

    def cut_power(self, at_us=None):
        """Power goes, now or at an instant to come, and is back at once.

        A flash operation under way is left half done. The display loses its power as well.
        """
        if at_us is None:
            self.tell("X", POWER)
            self._settle()
        else:
            self.chip.tell(self._origin_ns + at_us * 1000, "X", POWER)

    def close(self):
        """Do as a person who leaves: Ctrl-C stops the drives, and the panel with them."""
        self.tell("S", 0)
        self.repl.write(b"\x03")
        self.run_until(lambda: not any(drive.hz() for drive in self.drives.values()), CLOSE_MS)

    def open_serial(self):
        """Join the chip's USB serial to the pty of launch.py; its path, for other programs."""
        self.tell("S", 1)
        self._settle()
        path = os.getenv("USS_PICO_SERIAL")
        self.place = "an emulated Pico, USB %s" % path
        return path

    def selected(self):
        """The address that the display showed last."""
        word = self.lcd()[1].rstrip().rpartition(" ")[2]
        if word[:1] == "A" and word[1:].isdigit():
            self._selected = int(word[1:])
        return self._selected

    def tell(self, kind, a=0, b=0, content=None):
        """Something happens to the chip now; what the world does is a character late for it."""
        self.chip.tell(self._origin_ns + self.clock.now_us * 1000, kind, a, b, content)

    # --- the chip's files -----------------------------------------------------------------------

    def save_flash(self, path):
        """Write the image of the flash to a file, as it is now."""
        self.tell("F", content=path.encode())
        self._settle()

    def read_file(self, path):
        """A file of the chip's as it stands in the flash now, None where there is none."""
        image = temporary()
        self.save_flash(image)
        try:
            return FlashImage(image).read(path)
        finally:
            os.remove(image)

    def settings(self):
        """The panel's settings as they stand in the flash now."""
        stored = self.read_file(SETTINGS_FILE)
        return None if stored is None else json.loads(stored)

    def stack_depths(self):
        """The greatest depths of the stack since the last call, bytes: of the program, and of the
        interrupts' handlers, which may come at any depth of the program.
        """
        self.tell("K")
        self._settle()
        return tuple(self._depths)

    # --- the referee ----------------------------------------------------------------------------

    def complaints(self):
        complaints = Surroundings.complaints(self) + self.station.complaints
        if self.backpack:
            complaints += ["display: " + complaint for complaint in self.backpack.complaints]
        return complaints

    @property
    def reset_causes(self):
        """Why the chip restarted, in turn."""
        return [cause for _, cause in self.restarts]

    # --- inside ---------------------------------------------------------------------------------

    def _begin_chip(self, program, baud, display, files, flash, model, jumpers):
        """Put the files on a flash, and power to a chip with it."""
        image = FlashImage(flash)
        if self.stored is not None and image.read(SETTINGS_FILE) is None:
            image.write(SETTINGS_FILE, json.dumps(self.stored).encode())
        for path, content in files.items():
            image.write(path, content)
        path = temporary()
        image.save(path)
        watch, devices = [DRIVER_ENABLE, LED], []
        if display == "backpack":
            devices = [0x27]
        else:
            watch += [LCD_RS, LCD_E] + list(LCD_DATA)
        self.chip.begin(program, watch, baud, path, i2c=devices, model=model, jumpers=jumpers)
        try:
            self._settle()
        finally:
            os.remove(path)

    def _wire_display(self):
        if not self.backpack:
            outputs = {gpio: Output() for gpio in (LCD_RS, LCD_E) + LCD_DATA}
            data = [outputs[gpio] for gpio in LCD_DATA]
            self.lcd_chip.wire(outputs[LCD_RS], outputs[LCD_E], data)
            self._outputs = outputs

    def _settle(self):
        """Let the chip take what it was told, no time passing."""
        self.chip.run(self.chip.now_ns, self._take)

    def _chip_ns(self, world_us):
        """How far the chip may be when the world is there."""
        return self._origin_ns + world_us * 1000 + self._behind_ns

    def _next_event_us(self, until_us):
        """When the world does something next that the chip might notice.

        The chip has done already what the world does because of a record. Only a restart may not
        come late: the restart must cut what the chip sent before it, and nothing that it sends
        afterwards.
        """
        for at_ns, kind, _, _ in self._records:
            if kind == "Z":
                until_us = min(until_us, self._world_us(at_ns))
        for at_us, callback in self.clock.coming():
            if callback is not self._due.callback:
                return min(at_us, until_us)
        return until_us

    def _take(self, at_ns, kind, a, b, content):
        """A record of the chip's, as soon as it is known."""
        if kind == "T":
            self.station.sent(at_ns, a, b)
        elif kind == "U":
            self.usb.extend(content)
            if len(self.usb) > USB_KEPT_BYTES:
                self.usb = self.usb[-USB_KEPT_BYTES:]
        elif kind == "K":
            self._depths[a] = b
        elif kind == "V":
            self._note(self.flash_log, (self._world_us(at_ns), a, b * 100))
        elif kind == "E" and a == LED:
            self._note(self.led, (self._world_us(at_ns), b == HIGH))
        else:
            if kind == "B":
                self.station.tune(rate_of(b))
                self._behind_ns = behind_ns(self.station.baud)
            if kind == "E" and a == DRIVER_ENABLE:
                self.station.driver(at_ns, b == HIGH)
            self._queue(at_ns, kind, a, b)

    def _note(self, log, entry):
        if len(log) < LOG_MAX:
            log.append(entry)

    def _queue(self, at_ns, kind, a, b):
        records = self._records
        place = len(records)
        while place and records[place - 1][0] > at_ns:
            place -= 1
        if kind == "Z":  # it is why the pins have been let go of at this very instant
            while place and records[place - 1][0] == at_ns:
                place -= 1
        records.insert(place, (at_ns, kind, a, b))
        if place == 0:
            self.clock.schedule(self._due, self._world_us(at_ns))

    def _world_us(self, at_ns):
        return (at_ns - self._origin_ns) // 1000

    def _take_due(self):
        """The records whose instant has come."""
        records = self._records
        while records and self._world_us(records[0][0]) <= self.clock.now_us:
            at_ns, kind, a, b = records.pop(0)
            if kind == "B":
                self.station.talk_at(rate_of(b))
            elif kind == "E" and a == DRIVER_ENABLE:
                self.station.drive(at_ns, b == HIGH)
            elif kind == "E":
                self._outputs[a].put(b)
            elif kind == "I":
                self.backpack.take(b)
            elif kind == "Z":
                self._restarted(RESET_CAUSES.get(a, "reset"))
        if records:
            self.clock.schedule(self._due, self._world_us(records[0][0]))

    def _restarted(self, cause):
        self.resets += 1
        self.restarts.append((self.clock.now_us, cause))
        self.station.reset()
        if cause == "power":
            (self.backpack or self.lcd_chip).power_on()
        if not self.backpack:
            self.lcd_chip.let_go()
            self._wire_display()


def behind_ns(baud):
    """How far the world is behind a chip that sends at this rate."""
    return BEHIND_BITS_PERCENT * 10_000_000 // baud


def program_path(program):
    """The UF2 file of a program by its name, or the path itself."""
    return "%s/build/pico/%s%s.uf2" % (TOP, program, build) if program in PROGRAMS else program


def temporary():
    """A path of a file that nobody else has, for a moment."""
    number = int.from_bytes(os.urandom(6), "big")
    return "%s/build/flash.%x" % (TOP, number)
