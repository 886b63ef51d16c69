# SPDX-License-Identifier: MIT
"""The display's controller as a chip: an HD44780U with ROM A00 or A02, 2 x 16, on four data lines.

It takes nibbles from pins, executes instructions, keeps its memory while the microcontroller
resets, and complains about what the data sheet forbids (Hitachi, ADE-207-272). It is as slow as
the slowest specimen, and its memory holds random characters when power comes. You cannot read it:
R/W is tied low. The data sheet does not say what becomes of a write that comes too soon; here it
is lost.

    lcd = Lcd(clock)
    lcd.wire(register_select, enable, (d4, d5, d6, d7))
    lcd.text()                          # ("S: 10.0 F: 10.00", "RUNNING      A1 ")
    lcd.complaints()                    # ["at 1146 us: ..."] if a rule was broken
"""

COLUMNS = 16
ROW_LENGTH = 40  # characters of memory for each row, of which COLUMNS are seen
SECOND_ROW = 0x40

# Table 6 is for an oscillator of 270 kHz; the slowest has 190 kHz (DC characteristics).
POWER_ON_US = 40_000  # from 2.7 V on (figure 24, initialising by instruction)
START_US = (4_100, 100)  # after the first and the second function set since then (figure 24)
INSTRUCTION_US = 53  # 37 us * 270 / 190
DATA_US = 61  # the same, and 1.5 clocks until the address has moved (figure 10)
HOME_US = 2_160  # 1.52 ms * 270 / 190; clear takes as long

# Bus timing, write operation, 2.7 to 4.5 V, at the clock's resolution. Set-up and hold times are
# below it: the order of the calls decides.
PULSE_US = 1  # 450 ns
CYCLE_US = 1  # 1000 ns

COMPLAINT_LIMIT = 16

# The text of each broken rule.
TOO_SOON = "written to before its power-on time was over"
BUSY = "written to while it was busy"
SHORT_PULSE = "E was high for less than 450 ns"
SHORT_CYCLE = "E rose twice within 1000 ns"
UNSTEADY = "RS or data changed while E was high"
NO_FUNCTION_SET = "written to before the function set of 4 bits and 2 lines"
UNKNOWN = "no instruction has this code"
NO_CELL = "a character was written to an address that does not exist"

UNREADABLE = "▒"

# ROM A00 where it differs from ASCII, for the characters in use. Table 4 of the data sheet.
ROM = {
    0x5C: "¥", 0x7E: "→", 0x7F: "←", 0xA5: "·", 0xDF: "°", 0xE1: "ä", 0xE2: "ß", 0xE4: "µ",
    0xEE: "ñ", 0xEF: "ö", 0xF5: "ü", 0xFD: "÷", 0xFF: "█",
}  # fmt: skip
A02_ACCENTED = 0xA0  # from here on ROM A02 has the characters of ISO 8859-1, as good as

# What a person sees in the dots of a character that the firmware has drawn itself.
LOOKS = {
    bytes((0x1F, 0x11, 0x0A, 0x04, 0x0A, 0x11, 0x1F, 0x00)): "⧗",
    bytes((0x04, 0x0E, 0x15, 0x04, 0x04, 0x15, 0x0E, 0x04)): "↕",
    bytes((0x0A, 0x00, 0x0E, 0x11, 0x1F, 0x11, 0x11, 0x00)): "Ä",
    bytes((0x0A, 0x00, 0x0E, 0x11, 0x11, 0x11, 0x0E, 0x00)): "Ö",
    bytes((0x0A, 0x00, 0x11, 0x11, 0x11, 0x11, 0x0E, 0x00)): "Ü",
}


class _Line:
    """A wire to the controller: a pin tells it the level, but not which pin it is."""

    def __init__(self, lcd, bit):
        self._lcd = lcd
        self._bit = bit

    def changed(self, _level):
        lcd = self._lcd
        lcd._lines ^= self._bit
        if lcd._enable:
            lcd._complain(UNSTEADY)


class Lcd:
    """clock: of the world. rom: "A00" or "A02". Power comes now.

    ddram, cgram        80 characters, 40 for each row; 8 rows of dots for each of 8 characters
    characters, dots    how many bytes were written to each
    instructions, clears, homes   how many were executed, clear and home among them
    lit                 whether its light is on; `light` is wired to the board
    is_on, two_lines, increment, shifts, first_column, address, in_cgram, eight_bits, half
                        its state, for tests to look at and to spoil; half: the high nibble of a
                        byte whose low one has not come, or -1
    """

    def __init__(self, clock, rom="A00"):
        self.rom = rom
        self.ddram = bytearray(2 * ROW_LENGTH)
        self.cgram = bytearray(64)
        self.characters = 0
        self.dots = 0
        self.instructions = 0
        self.clears = 0
        self.homes = 0
        self.lit = True
        self._clock = clock
        self._pins = ()
        self._lines = 0  # D4...D7, and RS as bit 4
        self._enable = 0
        self._rose_us = -CYCLE_US
        self._complained = 0
        self._book = [[0, None] for _ in range(COMPLAINT_LIMIT)]
        self._looked_at = [None, None]  # in each row: what its text depends on, and the text
        self._read = [None, None]
        self._instructions = (
            (0x80, self._set_ddram_address),
            (0x40, self._set_cgram_address),
            (0x20, self._function_set),
            (0x10, self._shift),
            (0x08, self._on_off),
            (0x04, self._entry_mode),
            (0x02, self._home),
            (0x01, self._clear),
        )
        self.power_on()

    def light(self, on):
        self.lit = on

    def power_on(self):
        """Power comes, or comes back: 8 bits wide, off, random characters in its memory."""
        for memory in (self.ddram, self.cgram):
            for index in range(len(memory)):
                memory[index] = (index * 73 + 41) & 0xFF
        self.is_on = False
        self.two_lines = False
        self.increment = 1
        self.shifts = False
        self.first_column = 0
        self.address = 0
        self.in_cgram = False
        self.eight_bits = True
        self.half = -1
        self._is_set = False  # a function set was executed since the width of the bus changed
        self._has_started = False  # an instruction was executed since power-on
        self._function_sets = 0  # since power-on; counted only as far as START_US needs
        self._busy_us = 0
        self._ready_us = self._clock.now_us + POWER_ON_US

    # --- the wires ------------------------------------------------------------------------------

    def wire(self, register_select, enable, data):
        """Listen to these pins from now on; all are low. data: D4, D5, D6, D7."""
        self._pins = tuple(data) + (register_select, enable)
        for position, pin in enumerate(self._pins[:-1]):
            pin.on_change = _Line(self, 1 << position).changed
        enable.on_change = self._enable_changed
        self._lines = 0
        self._enable = 0

    def let_go(self):
        """The microcontroller resets and lets go of the wires, so that E falls.

        A pulse that this cuts short counts as a pulse, and not as a broken rule.
        """
        for pin in self._pins:
            pin.on_change = None
        self._pins = ()
        if self._enable:
            self._enable = 0
            self._take(self._lines)

    def _enable_changed(self, level):
        now_us = self._clock.now_us
        self._enable = level
        if level:
            if now_us - self._rose_us < CYCLE_US:
                self._complain(SHORT_CYCLE)
            self._rose_us = now_us
        else:
            if now_us - self._rose_us < PULSE_US:
                self._complain(SHORT_PULSE)
            self._take(self._lines)

    # --- the controller -------------------------------------------------------------------------

    def _take(self, lines):
        """Take a nibble, with RS as bit 4. For a byte, the register that came with the second
        nibble counts.
        """
        if self._clock.now_us < self._ready_us:
            self._complain(BUSY if self._has_started else TOO_SOON)
        elif self.eight_bits:
            self._execute(lines >> 4, (lines & 0x0F) << 4 | 0x0F)  # open D0...D3 are pulled up
        elif self.half < 0:
            self.half = lines & 0x0F
        else:
            code = self.half << 4 | lines & 0x0F
            self.half = -1
            self._execute(lines >> 4, code)

    def _execute(self, is_data, code):
        self._has_started = True
        self._busy_us = DATA_US if is_data else INSTRUCTION_US
        if (self.eight_bits or not self._is_set) and (is_data or code >> 5 != 1):
            self._complain(NO_FUNCTION_SET)
        if is_data:
            self._write(code)
        else:
            self._instruct(code)
        self._ready_us = self._clock.now_us + self._busy_us

    def _instruct(self, code):
        self.instructions += 1
        for bit, instruction in self._instructions:  # the highest bit decides
            if code & bit:
                instruction(code)
                return
        self._complain(UNKNOWN)

    def _write(self, code):
        if self.in_cgram:
            self.cgram[self.address] = code
            self.dots += 1
        else:
            cell = self._cell()
            if cell < 0:
                self._complain(NO_CELL)
            else:
                self.ddram[cell] = code
                self.characters += 1
            if self.shifts:
                self._scroll(self.increment)
        self._move(self.increment)

    def _cell(self):
        """The index in `ddram` that the address means; -1: none."""
        row_length = ROW_LENGTH if self.two_lines else 2 * ROW_LENGTH
        if self.address < row_length:
            return self.address
        if self.two_lines and SECOND_ROW <= self.address < SECOND_ROW + ROW_LENGTH:
            return self.address - SECOND_ROW + ROW_LENGTH
        return -1

    def _move(self, step):
        if self.in_cgram:
            self.address = (self.address + step) & 0x3F
            return
        cell = self._cell()
        if cell < 0:
            self.address = (self.address + step) & 0x7F
            return
        cell = (cell + step) % (2 * ROW_LENGTH)
        if self.two_lines and cell >= ROW_LENGTH:
            cell += SECOND_ROW - ROW_LENGTH
        self.address = cell

    def _scroll(self, step):
        self.first_column = (self.first_column + step) % (2 * ROW_LENGTH)

    def _set_ddram_address(self, code):
        self.in_cgram = False
        self.address = code & 0x7F

    def _set_cgram_address(self, code):
        self.in_cgram = True
        self.address = code & 0x3F

    def _function_set(self, code):
        eight_bits = bool(code & 0x10)
        # The number of lines can be set only once after a change of the width.
        if eight_bits != self.eight_bits:
            self.eight_bits = eight_bits
            self.two_lines = bool(code & 0x08)
            self._is_set = False
        elif not self._is_set:
            self.two_lines = bool(code & 0x08)
            self._is_set = True
        if self._function_sets < len(START_US):
            self._busy_us = START_US[self._function_sets]
            self._function_sets += 1

    def _shift(self, code):
        step = 1 if code & 0x04 else -1
        if code & 0x08:
            self._scroll(-step)  # the picture moves right, so cells on its left come into view
        else:
            self._move(step)

    def _on_off(self, code):
        self.is_on = bool(code & 0x04)

    def _entry_mode(self, code):
        self.increment = 1 if code & 0x02 else -1
        self.shifts = bool(code & 0x01)

    def _home(self, code):
        self.homes += 1
        self._to_the_beginning()

    def _clear(self, code):
        self.clears += 1
        for cell in range(len(self.ddram)):
            self.ddram[cell] = 0x20
        self.increment = 1
        self._to_the_beginning()

    def _to_the_beginning(self):
        self.in_cgram = False
        self.address = 0
        self.first_column = 0
        self._busy_us = HOME_US

    # --- an eye ---------------------------------------------------------------------------------

    def text(self):
        """Both rows, as a person reads them: blanks while the display is off."""
        return self._row(0), self._row(1)

    def _row(self, row):
        if not self.is_on or (row and not self.two_lines):
            return " " * COLUMNS
        length = ROW_LENGTH if self.two_lines else 2 * ROW_LENGTH
        cells = self.ddram[row * ROW_LENGTH :][:length]
        column = self.first_column % length
        codes = (cells + cells)[column : column + COLUMNS]
        # Who waits for a text looks at the same one again and again.
        looked_at = (self.rom, bytes(codes), bytes(self.cgram))
        if looked_at != self._looked_at[row]:
            self._looked_at[row] = looked_at
            self._read[row] = "".join([self._look(code) for code in codes])
        return self._read[row]

    def _look(self, code):
        if self.rom == "A02" and code >= A02_ACCENTED:
            return chr(code)
        if code in ROM and self.rom == "A00":
            return ROM[code]
        if 0x20 <= code < 0x7E or code == 0x7E and self.rom == "A02":
            return chr(code)
        if code < 0x10:
            first = (code & 7) * 8
            dots = bytes(row & 0x1F for row in self.cgram[first : first + 8])
            return LOOKS.get(dots, UNREADABLE)
        return UNREADABLE

    def complaints(self):
        """The first 16 broken rules, as texts with their instants."""
        return ["at %d us: %s" % (at_us, rule) for at_us, rule in self._book[: self._complained]]

    def _complain(self, rule):
        if self._complained < COMPLAINT_LIMIT:
            entry = self._book[self._complained]
            entry[0] = self._clock.now_us
            entry[1] = rule
            self._complained += 1
