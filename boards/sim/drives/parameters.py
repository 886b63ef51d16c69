# SPDX-License-Identifier: MIT
"""The parameter store of a simulated drive: RAM, EEPROM, and what may be put into them.

It knows numbers, indices, types and ranges from the rows of a family (families/mm420.py).
parameter_channel.py decides who may write, and when.

    store = Parameters(mm420, reading)
    store.set(1120, 0, 5.0)         # as from the drive's own keypad: RAM and EEPROM
    store.get(1120, 0)              # 5.0
    words_of("F", 5.0)              # (0x40A0, 0)

A U16, I16 or U32 is an int; an F has single precision, because that is what the drive keeps. An
index counts from 0, whatever the family does.
"""

import struct

from boards.sim.drives.power.sources import connected

# Columns of a row.
NUMBER, NAME, TYPE, UNIT, INDICES, MINIMUM, MAXIMUM, DEFAULT, CHANGE, LEVEL, NOTE = range(11)

# Objections to a value, numbered as in a reply with AK 7.
OUT_OF_LIMITS = 2
ONLY_ZERO = 6
NOT_PERMITTED = 104

# Bits of an identifier (general knowledge, unverified): it differs from the value as delivered; it
# may only be set to 0.
CHANGED, ONLY_TO_ZERO = 0x1000, 0x2000


def single(value):
    """`value` as a float of single precision."""
    return struct.unpack(">f", struct.pack(">f", value))[0]


def is_word(kind):
    """Whether a value of this type has 16 bits."""
    return kind in ("U16", "I16")


def words_of(kind, value):
    """The words that carry a value of this type, one or two, the high one first."""
    if is_word(kind):
        return (value & 0xFFFF,)
    return struct.unpack(">HH", struct.pack(">f" if kind == "F" else ">I", value))


def value_of(kind, words):
    """The value of this type that one or two words hold."""
    if kind == "U16":
        return words[0]
    if kind == "I16":
        return words[0] - 0x10000 if words[0] & 0x8000 else words[0]
    return struct.unpack(">f" if kind == "F" else ">I", struct.pack(">HH", *words))[0]


def rows_like(rows, changes, without=()):
    """The rows of another family, sorted, with `changes` in place of some, or added.

    changes: whole rows. without: numbers that this family does not have.
    """
    by_number = {row[NUMBER]: row for row in rows}
    by_number.update({row[NUMBER]: row for row in in_single_precision(changes)})
    return tuple(by_number[number] for number in sorted(by_number) if number not in without)


def in_single_precision(rows):
    """The rows with the limits and defaults of floats as a drive keeps them, a list.

    Without this a 0.1 from the line would be below a minimum of 0.1.
    """
    return [row if row[TYPE] != "F" else _single_row(row) for row in rows]


def _single_row(row):
    default = row[DEFAULT]
    if isinstance(default, tuple):
        default = tuple(single(value) for value in default)
    else:
        default = single(default)
    limits = row[MINIMUM], row[MAXIMUM]
    if row[CHANGE]:
        limits = single(row[MINIMUM]), single(row[MAXIMUM])
    exact = row[:MINIMUM] + limits + (default,) + row[CHANGE:]
    return row if exact == row else exact  # mostly equal, which saves a second table in memory


def only(table, rows):
    """The part of a table {number: ...} that is about numbers of these rows."""
    numbers = [row[NUMBER] for row in rows]
    return {number: table[number] for number in table if number in numbers}


def default_values(row):
    """The values of a row as delivered, by index."""
    default = row[DEFAULT]
    return list(default if isinstance(default, tuple) else (default,) * row[INDICES])


class Parameters:
    """family: a module such as mm420. reading(number, index): the value of a read-only number.

    ram[number] is the list of the values in force, by index; read it, but change it with store().
    It stays the same list. ram has no readings, and no readings that can be set to 0 (P0952).
    eeprom_writes   how often the EEPROM was written since delivery; saving all counts as once
    """

    def __init__(self, family, reading):
        self.rows = {row[NUMBER]: row for row in family.ROWS}
        self.numbers = sorted(self.rows)
        self.ram = {}
        self.eeprom_writes = 0
        self._eeprom = {}
        self._family = family
        self._permitted = family.PERMITTED
        self.reading = reading
        self._retained = family.LINK["retained"]  # if not 0, the EEPROM keeps every change
        self._volatile = family.OPERATIONS  # commands, which the EEPROM does not keep
        self._only_zero = family.ONLY_ZERO
        for number in self.numbers:
            if self.rows[number][CHANGE] and number not in family.READINGS:
                self.ram[number] = default_values(self.rows[number])

    def value(self, number, index):
        """The present value of a number and index that exist."""
        if number in self.ram:
            return self.ram[number][index]
        return self.reading(number, index)

    def flags(self, number):
        """The bits of a description's identifier that tell the present state of this number."""
        if number in self._only_zero:
            return ONLY_TO_ZERO
        values = self.ram.get(number)
        return CHANGED if values and values != default_values(self.rows[number]) else 0

    def objection(self, number, index, value):
        """The error number that forbids `value` here, or None."""
        row = self.rows[number]
        if not row[MINIMUM] <= value <= row[MAXIMUM]:  # refuses a NaN too
            return OUT_OF_LIMITS
        if value not in self._permitted.get(number, (value,)):
            return NOT_PERMITTED
        return ONLY_ZERO if value and number in self._only_zero else None

    def store(self, number, index, value, permanently):
        """Keep a value that was checked, in RAM and, if `permanently`, in the EEPROM.

        The connectors that it sets (P0700 sets P0840) change with it.
        """
        if number not in self.ram:
            return
        self.ram[number][index] = value
        keep = permanently or self._retained is not None and self.ram[self._retained][0]
        if keep:
            self.eeprom_writes += 1
            self._keep(number, index, value)
        for target, connector in connected(self._family, number, value):
            if target in self.ram and index < len(self.ram[target]):
                self.ram[target][index] = connector
                if keep:
                    self._keep(target, index, connector)

    def _keep(self, number, index, value):
        if number not in self._volatile:
            self._kept(number)[index] = value

    def fit(self, number, index, value):
        """Put what the drive has calculated into RAM, a float, within the limits of the number."""
        row = self.rows[number]
        value = single(min(max(value, row[MINIMUM]), row[MAXIMUM]))
        self.store(number, index, value, False)

    def save(self):
        """RAM to EEPROM, as P0971 does."""
        self.eeprom_writes += 1
        for number, values in self.ram.items():
            if number in self._eeprom or values != default_values(self.rows[number]):
                if number not in self._volatile:
                    self._eeprom[number] = list(values)

    def load(self):
        """EEPROM to RAM, as at power-up."""
        for number, values in self.ram.items():
            values[:] = self._eeprom.get(number) or default_values(self.rows[number])

    def restore_defaults(self, kept):
        """Set all of RAM as delivered, except the numbers in `kept`."""
        for number, values in self.ram.items():
            if number not in kept:
                values[:] = default_values(self.rows[number])

    def deliver(self, kept):
        """Set RAM and EEPROM as delivered, except the numbers in `kept`."""
        self.restore_defaults(kept)
        self.eeprom_writes += 1
        self._eeprom = {n: values for n, values in self._eeprom.items() if n in kept}

    def _kept(self, number):
        """The values of a number in the EEPROM, which holds what was ever changed there."""
        values = self._eeprom.get(number)
        if values is None:
            values = self._eeprom[number] = default_values(self.rows[number])
        return values

    def nearest(self, number, value):
        """The limit that this value exceeds."""
        row = self.rows[number]
        return row[MAXIMUM] if value > row[MAXIMUM] else row[MINIMUM]

    # Behind the bus's back

    def get(self, number, index=0):
        """KeyError: no such number or index."""
        self._find(number, index)
        return self.value(number, index)

    def set(self, number, index, value):
        """Set RAM and EEPROM.

        KeyError: no such number or index. ValueError: read-only, or not a value for it.
        """
        row = self._find(number, index)
        label = self.label(number, index)
        if not row[CHANGE]:
            raise ValueError(label + " is read-only")
        if row[TYPE] != "F" and not isinstance(value, int):
            raise ValueError("%s is a whole number, not %r" % (label, value))
        if not isinstance(value, (int, float)):
            raise ValueError("%s is a number, not %r" % (label, value))
        objection = self.objection(number, index, value)
        if objection == OUT_OF_LIMITS:
            limits = (label, row[MINIMUM], row[MAXIMUM], row[UNIT], value)
            raise ValueError("%s goes from %s to %s %s: %s does not" % limits)
        if objection == NOT_PERMITTED:
            raise ValueError("%s cannot be %s" % (label, value))
        if objection == ONLY_ZERO:
            raise ValueError("%s can only be set to 0" % label)
        self.store(number, index, single(value) if row[TYPE] == "F" else value, True)

    def label(self, number, index):
        """The name as in the manuals: P2010[0], r0021; with an index only if there are several."""
        row = self.rows[number]
        text = "%s%04d" % ("P" if row[CHANGE] else "r", number)
        return "%s[%d]" % (text, index) if row[INDICES] > 1 else text

    def _find(self, number, index):
        row = self.rows.get(number)
        if row is None:
            raise KeyError("there is no parameter %s" % number)
        if not 0 <= index < row[INDICES]:
            label = self.label(number, 0).split("[")[0]
            raise KeyError("%s has no index %s" % (label, index))
        return row
