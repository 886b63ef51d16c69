# SPDX-License-Identifier: MIT
"""What there is to see of a panel and its world, as the fields of messages: README.md.

    sights = Sights(world)
    sights.lcd()            # {"on": 1, "lit": 1, "codes": [...], "glyphs": "...", "text": [...]}
    sights.telegrams()      # those since the last call

It looks at a `World` and changes nothing.
"""

from binascii import hexlify

from boards.sim.chip.lcd import COLUMNS, ROW_LENGTH
from boards.sim.drives.words import CURRENT
from tools.driving.decoding import Setup, flaw, telegram
from uss.drive import COUNTERS

TELEGRAMS_MAX = 32  # in one go; those before are left out, as their numbers show
ZSW_FAULT = 0x0008


class Sights:
    """world: a `World`."""

    def __init__(self, world):
        self._world = world
        self._seen = world.wire.log.count
        self._setups = self._known_setups()  # as they were before the next telegrams

    def lcd(self):
        chip = self._world.lcd_chip
        codes = []
        for first in (0, ROW_LENGTH):
            cells = [(chip.first_column + column) % ROW_LENGTH for column in range(COLUMNS)]
            codes.append(hexed(bytes(chip.ddram[first + cell] for cell in cells)))
        return {
            "on": int(chip.is_on),
            "lit": int(chip.lit),
            "codes": codes,
            "glyphs": hexed(bytes(chip.cgram)),
            "text": list(chip.text()),
        }

    def drives(self):
        """One object for each drive of the line."""
        drives = self._world.drives
        if drives:
            return [simulated(address, drives[address]) for address in sorted(drives)]
        return [heard(drive) for drive in self._known()]

    def telegrams(self):
        """[(number, us, from_panel, hex, text, whether something is wrong with it)]"""
        log = self._world.wire.log
        fresh = min(log.count - self._seen, TELEGRAMS_MAX)
        self._seen = log.count
        told = []
        for us, from_panel, characters in log.last(fresh):
            text, wrong = self._text(characters, from_panel)
            told.append((0, us, from_panel, hexed(characters).upper(), text, wrong))
        first = log.count - len(told)
        self._setups = self._known_setups()
        return [(first + at,) + one[1:] for at, one in enumerate(told)]

    def counters(self):
        """What the panel has counted of each drive, by the names of the specification."""
        return [
            dict([("a", drive.address)] + list(zip(COUNTERS, drive.counters)))
            for drive in self._known()
        ]

    def addresses(self):
        return [drive["a"] for drive in self.drives()]

    def _known(self):
        """The drives of the panel's own list; none where nobody can look into the firmware."""
        bus = getattr(getattr(self._world, "app", None), "bus", None)
        return list(bus.turns.drives) if bus is not None else []

    def _text(self, characters, from_panel):
        try:
            wrong = flaw(characters, from_panel, self._setups)
            return wrong or telegram(characters, from_panel, self._setups), int(bool(wrong))
        except Exception:  # characters that are damaged may say anything
            return "cannot be understood", 1

    def _known_setups(self):
        drives = self._world.drives
        if drives:
            return {drive.address: Setup(drive) for drive in drives.values()}
        return {drive.address: SetupOfPanel(drive) for drive in self._known()}


class SetupOfPanel:
    """As `Setup`, of a real drive, as far as the panel knows it."""

    raw_numbers = second_word = False
    two_directions = False

    def __init__(self, drive):
        self.address = drive.address
        self.layout = drive.layout.pkw_words, drive.layout.pzd_words


def simulated(address, drive):
    """A drive that can be looked at: whatever its line says."""
    process = drive.process
    there = bool(drive.powered)
    return {
        "a": address,
        "at": drive.address,  # its address may have been changed
        "state": drive.state,
        "hz": rounded(drive.hz()),
        "set_hz": rounded(process.setpoint_hz()) if there else 0,
        "amps": rounded(process.quantity(CURRENT, 0)) if there else 0,
        "fault": name("F", process.faults[0]),
        "warning": name("A", process.memory.warnings[0]),
        "plugged": int(drive.plugged),
        "powered": int(there),
    }


def heard(drive):
    """A drive of which only its telegrams are known."""
    faulty = bool(drive.zsw & ZSW_FAULT)
    return {
        "a": drive.address,
        "at": drive.address,
        "state": "silent" if not drive.contact else "fault" if faulty else "heard",
        "hz": None,
        "set_hz": None,
        "amps": None,
        "fault": None,
        "warning": None,
        "plugged": int(bool(drive.contact)),
        "powered": int(bool(drive.contact)),
    }


def name(letter, number):
    return "%s%04d" % (letter, number) if number else None


def rounded(value):
    return round(value, 2) + 0.0


def hexed(data):
    return hexlify(data).decode()
