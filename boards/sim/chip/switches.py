# SPDX-License-Identifier: MIT
"""The keys of the panel as switches: a hand, contacts, and wires to the chip's pins.

A switch that has a pin of its own joins this pin to ground while somebody presses it; a normally
closed one does so while nobody does. The others join a row to a column of a matrix without diodes:
current also flows backwards through closed contacts, so that three keys at the corners of a
rectangle really look like four. The switches outlive the chip: every boot connects its new pins.

    switches = Switches(clock, ("START", "STOP"), closed=("STOP",))
    switches.connect((start_pin, stop_pin))
    switches.hold("START")          # start_pin() is 0
    switches.cut("STOP")            # stop_pin() is 1: as if it were pressed
"""

from boards.sim.clock import Event

# A column that nobody pulls low any more rises through the pull-up of the chip against the cable:
# 80 kohm (RP2040 data sheet, table of the pads: 50...80) times 100 pF, to 2.0 of 3.3 V.
RISE_US = 8

# A contact that bounces: it changes so many times more, in pairs, and rests so long in between.
BOUNCE_PAIRS_MAX = 4
BOUNCE_US = (50, 600)


class Switches:
    """names: of all keys. direct: those of them that have pins of their own.

    matrix: rows of names, None where there is no key; all other names are direct. closed: those
    of the direct that are normally closed. random: a function of (low, high), with which contacts
    bounce.
    """

    def __init__(self, clock, names, closed=(), matrix=(), random=None):
        places = places_of(matrix)
        self.names = names
        self.direct = tuple(key for key in names if key not in places)
        self.matrix = matrix
        self.closed = closed
        self._wires = [Wire() for _ in self.direct]
        self._grid = Grid(clock, len(matrix), len(matrix[0]) if matrix else 0)
        self._contacts = {}
        for key, wire in zip(self.direct, self._wires):
            self._contacts[key] = Contact(clock, wire.change, key in closed, random)
        for key, (row, column) in places.items():
            change = self._grid.contact(row, column)
            self._contacts[key] = Contact(clock, change, False, random)

    # The chip's side

    def connect(self, pins, rows=(), columns=()):
        """A boot: pins as in `direct`; rows are open-drain outputs, columns inputs."""
        for wire, pin in zip(self._wires, pins):
            wire.connect(pin)
        self._grid.connect(rows, columns)

    # A hand

    def hold(self, key):
        self._contact(key).press(True)

    def let_go(self, key):
        self._contact(key).press(False)

    # What may happen to the wires

    def cut(self, key):
        """Cut the wire of a key: its contact joins nothing any more."""
        self._contact(key).cut()

    def ground(self, column):
        """A column of the matrix touches ground, for good."""
        self._grid.ground(column)

    def _contact(self, key):
        if key not in self._contacts:
            raise ValueError("no key %s: there are %s" % (key, " ".join(self.names)))
        return self._contacts[key]


def places_of(matrix):
    """Row and column of every key of a matrix."""
    places = {}
    for row, keys in enumerate(matrix):
        for column, key in enumerate(keys):
            if key is not None:
                places[key] = row, column
    return places


class Contact:
    """What a key moves: change(joined) is called whenever it joins its two wires, or parts them.

    While it bounces it is moved by events, one for each time that it changes.
    """

    def __init__(self, clock, change, normally_closed, random):
        self._clock = clock
        self._change = change
        self._normally_closed = normally_closed
        self._random = random
        self._bounce = Event(self._bounced)
        self._bounces_left = 0
        self._pressed = False
        self._touching = False
        self._whole = True
        self._touch(normally_closed)

    def press(self, pressed):
        if pressed == self._pressed:
            return
        self._pressed = pressed
        self._touch(pressed != self._normally_closed)
        if self._random:
            self._bounces_left = 2 * self._random(0, BOUNCE_PAIRS_MAX)
            self._wait()

    def cut(self):
        self._whole = False
        self._change(False)

    def _touch(self, touching):
        self._touching = touching
        self._change(touching and self._whole)

    def _wait(self):
        self._clock.cancel(self._bounce)
        if self._bounces_left:
            at_us = self._clock.now_us + self._random(*BOUNCE_US)
            self._clock.schedule(self._bounce, at_us)

    def _bounced(self):
        self._bounces_left -= 1
        self._touch(not self._touching)
        self._wait()


class Wire:
    """From a key to its pin; the key's other end is ground."""

    def __init__(self):
        self._pin = None
        self._low = False

    def connect(self, pin):
        self._pin = pin
        self._show()

    def change(self, low):
        self._low = low
        self._show()

    def _show(self):
        if self._pin is not None:
            self._pin.apply(0 if self._low else None)


class Column(Wire):
    """It falls at once, and rises slowly: a program that scans a matrix has to wait for that."""

    def __init__(self, clock):
        Wire.__init__(self)
        self._clock = clock
        self._rise = Event(self._show)

    def change(self, low):
        if low == self._low:
            return
        self._low = low
        self._clock.cancel(self._rise)
        if low:
            self._show()
        else:
            self._clock.schedule(self._rise, self._clock.now_us + RISE_US)


class Grid:
    """The wires of a matrix: which columns are low, whichever way the current takes."""

    def __init__(self, clock, rows, columns):
        self._joined = [0] * rows  # for each row the columns that contacts join it to, as bits
        self._rows = ()  # the chip's pins, which drive them to ground
        self._grounded = 0  # columns, as bits
        self._columns = [Column(clock) for _ in range(columns)]

    def contact(self, row, column):
        """Returns a function change(joined) for the contact at this place."""
        bit = 1 << column

        def change(joined):
            if joined:
                self._joined[row] |= bit
            else:
                self._joined[row] &= ~bit
            self._watch(row)
            self._settle()

        return change

    def connect(self, rows, columns):
        for pin in rows:
            if pin.mode != pin.OPEN_DRAIN:
                raise ValueError("two rows that are not open-drain short each other out")
        self._rows = rows
        for row in range(len(rows)):
            self._watch(row)
        self._settle()
        for column, pin in zip(self._columns, columns):
            column.connect(pin)

    def ground(self, column):
        self._grounded |= 1 << column
        self._settle()

    def _watch(self, row):
        """A row that is joined to nothing makes no difference, and is set all the time."""
        if self._rows:
            self._rows[row].on_change = self._row_changed if self._joined[row] else None

    def _row_changed(self, _level):
        self._settle()

    def _settle(self):
        joined = self._joined
        low = self._grounded
        row = 0
        for pin in self._rows:
            if not pin.output:
                low |= joined[row]
            row += 1
        before = -1
        while low != before:  # backwards through a column that is low to the rows joined to it
            before = low
            for columns in joined:
                if columns & low:
                    low |= columns
        for column in self._columns:
            column.change(low & 1 == 1)
            low >>= 1
