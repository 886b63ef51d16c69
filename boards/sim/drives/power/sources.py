# SPDX-License-Identifier: MIT
"""Where a simulated drive takes its commands and its setpoint from: P0700, P1000 and their like.

P0700 and P1000 choose a source by a digit. On the drive each sets a connector that says the same
as number and index, P0840 for ON and P1070 for the main setpoint. The connector decides, and can
be set by itself. P0719 overrides both. All of this is general knowledge, from the MM4 function
diagrams; the USS specification knows no sources.

    sources = Sources(family)
    sources.take(process)               # its settings have changed
    sources.command(image)              # the control word that is obeyed
    sources.main, sources.place         # THIS_BUS, 1: the setpoint is PZD2
    family.SOURCES["sets"][700]         # (840, {5: 0x07F40000, ...}): what a write of P0700 sets
"""

from boards.sim.drives.words import ALWAYS, THIS_BUS, CONTROL_WORD_2, FIXED_FREQUENCY, MOP, ON

NONE = 0

# Connectors: number << 16 | index.
TERMINAL_1, KEYPAD, ANALOG = 722 << 16, 19 << 16, 755 << 16
MOP_OUTPUT, FIXED_OUTPUT = 1050 << 16, 1024 << 16

# Numbers that are a setpoint source by themselves.
OUTPUTS = {1050: MOP, 1024: FIXED_FREQUENCY}

# A family's data on sources: `words`, its numbers for the control words received, by their place
# in the image; `received`, the list of all words received; `digit`, the digit of P1000 that means
# this bus; `sets`, the numbers that set a connector: which one, and to what for each value, for
# P1000 for its units digit.
MM4 = {
    "words": {2036: 0, 2037: CONTROL_WORD_2},
    "received": 2018,
    "digit": THIS_BUS,
    "sets": {
        700: (
            (840, {0: TERMINAL_1, 1: KEYPAD, 2: TERMINAL_1, 4: 2032 << 16, 5: 2036 << 16,
                   6: 2090 << 16}),
        ),
        1000: (
            (1070, {0: NONE, 1: MOP_OUTPUT, 2: ANALOG, 3: FIXED_OUTPUT, 4: 2015 << 16 | 1,
                    5: 2018 << 16 | 1, 6: 2050 << 16 | 1, 7: 755 << 16 | 1}),
        ),
    },
}  # fmt: skip

# A family without connectors: only the digit counts.
FIXED = {"words": {}, "received": None, "digit": THIS_BUS, "sets": {}}

# The second generation of the G120 connects what its macro p0015 says, USS with 21.
G120 = {
    "words": {2090: 0, 2091: 1, 2092: 2, 2093: 3},
    "received": 2050,
    "digit": THIS_BUS,
    "sets": {
        15: (
            (840, {12: TERMINAL_1, 17: TERMINAL_1, 18: TERMINAL_1, 19: TERMINAL_1,
                   20: TERMINAL_1, 21: 2090 << 16}),
            (1070, {12: ANALOG, 17: ANALOG, 18: ANALOG, 19: ANALOG, 20: ANALOG,
                    21: 2050 << 16 | 1}),
        ),
    },
}  # fmt: skip

# P0719: tens as P0700, units as P1000; 0 leaves it to these.
SELECTIONS = tuple(10 * tens + units for tens in (0, 1, 4, 5, 6) for units in range(7))


def connected(family, number, value):
    """What a write of `value` to `number` connects: (number, connector) of each."""
    for target, by_value in family.SOURCES["sets"].get(number, ()):
        yield target, by_value[value % 10 if number == 1000 else value]


class Sources:
    """family: a module such as mm420.

    main        the source of the main setpoint, a digit as of P1000
    place       of the word that THIS_BUS means
    additional  the source of the additional setpoint
    """

    def __init__(self, family):
        self._words = family.SOURCES["words"]
        self._received = family.SOURCES["received"]
        self._digit = family.SOURCES["digit"]
        self._others = family.OTHER_COMMANDS
        self._digits = family.SETPOINT_SOURCES
        self._command = None  # a control word that no bus sets; None: that of the image
        self._on = None  # the connector of ON; None: from the control word, as the other bits
        self.main, self.place, self.additional = THIS_BUS, 1, 0

    def take(self, settings):
        """Take command_source, setpoint_source, selection, on_source and main_source."""
        commands, setpoint = settings.selection // 10, settings.selection % 10
        self._on = None if commands else settings.on_source
        self._command = self._others.get(commands or settings.command_source)
        self.place = 1
        if setpoint:
            self.main, self.additional = self._source(setpoint), 0
            return
        digits = self._digits.get(settings.setpoint_source, settings.setpoint_source)
        self.main, self.additional = self._source(digits % 10), self._source(digits // 10)
        if settings.main_source is not None:
            self.main, self.place = self.setpoint(settings.main_source)

    def _source(self, digit):
        """The source that a digit means; other links say nothing."""
        if digit == self._digit:
            return THIS_BUS
        return NONE if digit == THIS_BUS else digit

    def setpoint(self, connector):
        """What a connector of a setpoint means: source, and place of the word."""
        number, index = connector >> 16, connector & 0xFFFF
        if number == self._received:
            return THIS_BUS, index
        return OUTPUTS.get(number, NONE), 1

    def command(self, image, obeyed_bits):
        """The control word in force."""
        word = image[0] & obeyed_bits if self._command is None else self._command
        if self._on is not None:
            word = word | ON if self.bit(self._on, image) else word & ~ON
        return word

    def bit(self, connector, image):
        """What a binary connector says now: 0 or 1. Terminals and other links say 0."""
        if connector == ALWAYS:
            return 1
        place = self._words.get(connector >> 16)
        return 0 if place is None else image[place] >> (connector & 0x0F) & 1

    def is_word(self, connector):
        """Whether a binary connector is a bit of this bus."""
        return connector >> 16 in self._words
