# SPDX-License-Identifier: MIT
"""Keys on pins of their own, and in a matrix without diodes. Contract `keypad` of `hal`.

A key joins its pin to ground, the pin has a pull-up: low is down. A normally closed key opens when
it is pressed: high is down, and so is a broken wire. STOP has a pin of its own, best normally
closed. A wire to ground is not noticed there: it reads as a closed contact.

    keys = Matrix((row_1, row_2), (column_1, column_2), (("UP", "DOWN"), ("SET", None)), clock)
    keypad = Keypad((("START", start_pin), ("STOP", stop_pin)), keys, closed=("STOP",))
    keypad.names        # ("START", "STOP", "UP", "DOWN", "SET")
    keypad.read()       # 0b00010: STOP is down

This does not debounce: `panel.keys` does.
"""

from micropython import const

_KEYS_MAX = const(30)  # bits of a small integer that is not negative, on 32-bit ports

# A column rises through the chip's pull-up against its cable's capacitance: 8 us with 80 kohm
# (RP2040 data sheet, pads) and 100 pF, to 2.0 of 3.3 V. This is twice that, and a little more.
_SETTLE_US = const(20)


class Keypad:
    """direct: (name, Pin) for each key with a pin of its own, inputs with pull-ups.

    matrix: a `Matrix` or None. closed: names of the direct keys that are normally closed.
    levels, masks: None, or a function that answers the levels of all pins at one instant as bits,
    and the bit of each direct key's pin: asking each pin takes 100 us on an RP2040.
    ValueError: STOP has no pin of its own, a name stands twice, more than 30 keys, a normally
    closed key that is not among the direct ones.
    """

    def __init__(self, direct, matrix=None, closed=(), levels=None, masks=()):
        own = tuple(name for name, _ in direct)
        self.names = own + (matrix.names if matrix else ())
        check_names(self.names, own, closed)
        # Bound once, because calling a Pin itself would look the method up each time.
        self._direct = tuple((1 << bit, pin.value) for bit, (_, pin) in enumerate(direct))
        self._closed = sum(1 << own.index(name) for name in closed)
        self._matrix = matrix
        self._shift = len(own)
        self._levels = levels
        self._masks = tuple((1 << bit, mask) for bit, mask in enumerate(masks))
        self._seen = -1  # what `levels` answered last; at first -1, which is never an answer
        self._down = self._closed  # the keys that are down by that
        self.unclear = 0

    def read(self):
        if self._levels is None:
            down = _low(self._direct) ^ self._closed
        else:
            levels = self._levels()
            if levels != self._seen:
                # Use only these levels: a pin that is asked again may have bounced since.
                self._seen = levels
                self._down = self._closed
                for bit, mask in self._masks:
                    if not levels & mask:
                        self._down ^= bit
            down = self._down
        if self._matrix:
            down |= self._matrix.read() << self._shift
            self.unclear = self._matrix.unclear << self._shift
        return down


def _low(pins):
    """The pins that are low, as bits."""
    low = 0
    for bit, level in pins:
        if not level():
            low |= bit
    return low


def check_names(names, own, closed):
    if "STOP" not in own:
        raise ValueError("STOP has a pin of its own")
    if len(set(names)) < len(names):
        raise ValueError("a key stands there twice: %s" % " ".join(names))
    if len(names) > _KEYS_MAX:
        raise ValueError("%d keys: %d at the most" % (len(names), _KEYS_MAX))
    for name in closed:
        if name not in own:
            raise ValueError("%s is normally closed and has no pin of its own" % name)


class Matrix:
    """Drives the rows one after the other; the columns tell which of the row's keys are closed.

    rows: open-drain outputs, high. columns: inputs with pull-ups. names: for each row the name of
    the key at each column, None where there is none. clock: contract of `hal`. ValueError: names
    do not fit the pins. A read takes 20 us; with a key down, 20 us for each row and 40 us more.

    Current flows backwards through closed keys: with three at the corners of a rectangle, the
    fourth seems closed. So two rows that share two columns are ambiguous, and no key counts. Any
    other reading is true. (A key that moves within the read may be misread, once: no key is
    believed before it has been the same for some time.)

    A column that is low while no row is driven is shorted to ground: its keys do not count.

    unclear: the keys, as bits, that the last reading could not determine.
    """

    def __init__(self, rows, columns, names, clock):
        if len(names) != len(rows) or any(len(keys) != len(columns) for keys in names):
            raise ValueError("not a name for each of %d x %d" % (len(rows), len(columns)))
        self.names = tuple(name for keys in names for name in keys if name is not None)
        self._rows = tuple(row.value for row in rows)
        self._columns = tuple((1 << bit, pin.value) for bit, pin in enumerate(columns))
        self._keys = _bits_of(names)
        self.unclear = 0
        self._seen = [0] * len(rows)  # the columns that are low while a row is driven, as bits
        self._sleep_us = clock.sleep_us

    def read(self):
        """The keys that are down, as bits in the order of `names`; 0 if the reading is
        ambiguous."""
        self.unclear = 0
        if self._is_idle():
            return 0
        shorted = self._scan()
        if self._is_ambiguous():
            self.unclear = (1 << len(self._keys)) - 1
            return 0
        if shorted:
            self.unclear = self._keys_in([shorted] * len(self._rows))
        return self._keys_in(self._seen)

    def _is_idle(self):
        """Whether no key is down, as is usual: one look at all rows together tells."""
        for put in self._rows:
            put(0)
        self._sleep_us(_SETTLE_US)
        low = _low(self._columns)
        for put in self._rows:
            put(1)
        return not low

    def _scan(self):
        """Look at every row; return the columns that are shorted."""
        self._sleep_us(_SETTLE_US)
        shorted = _low(self._columns)
        row = 0
        for put in self._rows:
            put(0)
            self._sleep_us(_SETTLE_US)
            self._seen[row] = _low(self._columns) & ~shorted
            put(1)
            row += 1
        return shorted

    def _is_ambiguous(self):
        seen = self._seen
        for row in range(1, len(seen)):
            for other in range(row):
                shared = seen[row] & seen[other]
                if shared & (shared - 1):  # more than one bit
                    return True
        return False

    def _keys_in(self, seen):
        """The keys that are closed, as bits. seen: the low columns of each row, as bits."""
        keys = 0
        for row, column, bit in self._keys:
            if seen[row] & column:
                keys |= bit
        return keys


def _bits_of(names):
    """For each key of a matrix: its row, the bit of its column, its own bit."""
    keys = []
    for row, row_names in enumerate(names):
        for column, name in enumerate(row_names):
            if name is not None:
                keys.append((row, 1 << column, 1 << len(keys)))
    return tuple(keys)
