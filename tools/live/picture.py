# SPDX-License-Identifier: MIT
"""The picture of a panel and its world: lines of text, for a terminal of 80 x 24.

    picture = Picture(world, hand, boxes=True)
    picture.turn(passed_us)
    lines = picture.lines(world.wire.log.last(16), ["done: unplug 1"])

It looks at a `World` and a `Hand`, changes nothing, and knows no terminal: tests read it. What is
lit (the display, keys that are down) stands between the marks HIGHLIGHT and PLAIN.
"""

from tools.live.keys import ARM, LETTERS, STARTERS
from tools.live.terminal import HIGHLIGHT, PLAIN

ROWS = 24
COLUMNS = 79  # nothing in the last one: some terminals begin a new line then
SAID_ROWS = 3
DISPLAY_ROWS, DISPLAY_COLUMNS = 4, 19  # the corner of the picture that the display takes
LEGEND_COLUMNS = 3
LEGEND_COLUMN = 20
CELL_COLUMNS = 20
DRIVE_ROWS_MAX = 6
ADDRESS = 2011  # P2011

HELP = " small letter: tap  CAPITAL: hold  Esc: let go  space: STOP  : command  q: quit"
PROMPT_HELP = "Enter: do  empty line, Esc: keys  two spaces: STOP"
DRIVES_HEAD = " drive   motor            turns  state"
TELEGRAMS_HEAD = " telegrams: microseconds, > from the panel, < to it"

# Corners, horizontal and vertical of the frame around the display.
BOX = "\u250c\u2510\u2514\u2518\u2500\u2502"
PLAIN_BOX = "++++-|"

# What a terminal without UTF-8 shows for the display's own characters; "?" for all others.
STAND_INS = {
    "\u2195": "^",  # up-down arrow
    "\u29d7": "X",  # hourglass
    "\u2192": ">",
    "\u2190": "<",
    "\u00a5": "Y",  # the ROM's yen sign
    "\u00b0": "o",
    "\u00c4": "A",  # umlauts: a letter has one place
    "\u00d6": "O",
    "\u00dc": "U",
    "\u00e4": "a",
    "\u00f6": "o",
    "\u00fc": "u",
    "\u00df": "s",
    "\u00b5": "u",
}

# The shaft, seen from its end, turning to the right. The mark shows it behind a gear, as slow as
# the eye can follow, and never more than one position further: its direction can always be seen.
SHAFT = "|/-\\"
HZ_PER_STEP_A_SECOND = 3
STEP = HZ_PER_STEP_A_SECOND * 1_000_000


class Picture:
    """world: a `World`. hand: a `Hand`. boxes: the terminal shows more than ASCII."""

    def __init__(self, world, hand, boxes):
        self._world = world
        self._hand = hand
        self._boxes = boxes
        self._angles = {address: 0.0 for address in world.drives}  # Hz times microseconds
        self.positions = {address: 0 for address in world.drives}

    def turn(self, passed_us):
        """Turn the shafts by so much of the world's time since the last picture."""
        for address, drive in self._world.drives.items():
            angle = self._angles[address] + drive.hz() * passed_us
            if abs(angle) >= STEP:
                step = 1 if angle > 0 else -1
                self.positions[address] += step
                angle = max(-STEP, min(STEP, angle - step * STEP))
            self._angles[address] = angle

    def lines(self, telegrams, said, broken="", speed=1.0, command=None):
        """The whole picture, ROWS lines of COLUMNS at the most.

        telegrams: as `Wire.log.last` has them, newest last. said: up to SAID_ROWS lines for the
        end: what came of a command. broken: a rule of the line that was broken. speed: how fast
        the world's time passes. command: what is being typed, in the place of the help on keys.
        """
        lines = [self._title(speed)] + self._panel()
        lines += [HELP if command is None else prompt(command), ""]
        lines += [DRIVES_HEAD] + self._drives() + [""] if self._world.drives else []
        lines.append(TELEGRAMS_HEAD)
        room = ROWS - SAID_ROWS - 1 - len(lines)
        lines += [telegram_line(*telegram) for telegram in telegrams[-room:]]
        lines += [""] * (ROWS - SAID_ROWS - 1 - len(lines))
        lines.append("BROKEN: " + broken if broken else "")
        lines += (list(said) + [""] * SAID_ROWS)[:SAID_ROWS]
        return [cut(self._written(line), COLUMNS) for line in lines]

    def _title(self, speed):
        tenths = self._world.clock.now_us // 100_000
        return " USS panel on %s   time %d:%02d:%02d.%d   speed x %.1f" % (
            self._world.place,
            tenths // 36000, tenths // 600 % 60, tenths // 10 % 60, tenths % 10, speed,
        )  # fmt: skip

    def _panel(self):
        """The display, the keys beside it."""
        box = BOX if self._boxes else PLAIN_BOX
        display = [box[0] + box[4] * 16 + box[1]]
        display += [box[5] + HIGHLIGHT + row + PLAIN + box[5] for row in self._world.lcd()]
        display.append(box[2] + box[4] * 16 + box[3])
        legend = self._legend()
        lines = []
        for index in range(max(len(display), len(legend))):
            left = display[index] if index < len(display) else ""
            right = legend[index] if index < len(legend) else ""
            lines.append(padded(" " + left, LEGEND_COLUMN) + right)
        return lines

    def _legend(self):
        names = self._world.keypad.names
        cells = [self._cell(letter, key) for letter, key in LETTERS if key in names]
        rows = -(-len(cells) // LEGEND_COLUMNS)
        return ["".join(cells[row::rows]) for row in range(rows)]

    def _cell(self, letter, key):
        how = ""
        if key == self._hand.key:
            how = "HELD" if self._hand.held else "down"
        elif key in self._hand.fixed:
            how = "down"
        if key in STARTERS and self._world.port is not None:
            letter = ARM + letter
        cell = padded("%s %s" % (letter, key), 14) + " " + how
        return padded(HIGHLIGHT + cell + PLAIN if how else cell, CELL_COLUMNS)

    def _drives(self):
        """A line for each drive; if there are too many, those that matter now come first."""
        drives = self._world.drives
        addresses = sorted(drives)
        if len(addresses) <= DRIVE_ROWS_MAX:
            return [self._drive(address) for address in addresses]
        first = [address for address in addresses if self._matters(address)]
        shown = first + [address for address in addresses if address not in first]
        shown = shown[: DRIVE_ROWS_MAX - 1]
        lines = [self._drive(address) for address in shown]
        return lines + [" + %d more" % (len(addresses) - len(shown))]

    def _matters(self, address):
        drive = self._world.drives[address]
        return drive.read(ADDRESS) == self._world.selected() or drive.hz() != 0

    def _drive(self, address):
        drive = self._world.drives[address]
        address = drive.read(ADDRESS)  # it may have been changed
        hz = drive.hz()
        fault = drive.report().split("fault=")[1].split()[0]
        return "%s%-6s (%s) %7.2f Hz %-6s %-13s %s%s" % (
            "*" if address == self._world.selected() else " ",
            "A%d" % address,
            SHAFT[self.positions[address] % len(SHAFT)],
            abs(hz),
            "right" if hz > 0 else "left" if hz < 0 else "",
            drive.state,
            "" if fault == "-" else fault + " ",
            "" if drive.plugged else "unplugged",
        )

    def _written(self, line):
        return line if self._boxes else in_ascii(line)


def in_ascii(line):
    """A line for a terminal without UTF-8, as wide as it is."""
    return "".join(
        character if ord(character) < 0x80 else STAND_INS.get(character, "?") for character in line
    )


def prompt(command):
    """The line that a command is typed on."""
    line = " :%s_" % command
    room = COLUMNS - len(PROMPT_HELP)
    return padded(line, room) + PROMPT_HELP if len(line) < room else line


def shows_display(rows, columns):
    """Whether a terminal has room for all of the display."""
    room = rows if rows >= ROWS else rows - 1  # the last one says that it is small
    return room >= DISPLAY_ROWS and columns >= DISPLAY_COLUMNS


def telegram_line(at_us, from_panel, characters):
    """A telegram as the script command `bus` shows it; what does not fit is left out."""
    shown = "%10d %s" % (at_us, ">" if from_panel else "<")
    fitting = (COLUMNS - len(shown) - len(" ...")) // 3
    shown += "".join(" %02X" % character for character in characters[:fitting])
    return shown + (" ..." if len(characters) > fitting else "")


def seen(line):
    """A line without its marks."""
    return line.replace(HIGHLIGHT, "").replace(PLAIN, "")


def padded(line, width):
    return line + " " * (width - len(seen(line)))


def cut(line, width):
    """The line, or as much of it as has room."""
    if len(seen(line)) <= width:
        return line
    kept = ""
    room = width
    for character in line:
        if character in (HIGHLIGHT, PLAIN):
            kept += character
        elif room:
            kept += character
            room -= 1
    return kept


def folded(text, width):
    """`text` as lines of at most `width`, broken at blanks; a word that is longer is cut."""
    lines = []
    while len(text) > width:
        at = text.rfind(" ", 1, width + 1)
        if at < 0:
            at = width
        lines.append(text[:at])
        text = text[at:].lstrip()
    return lines + [text]


def fitted(lines, rows, columns):
    """As much of a picture as a terminal has room for: the top, and a row that says so."""
    if rows >= ROWS and columns >= COLUMNS:
        return lines
    said = [line for line in lines[-SAID_ROWS:] if line]
    notice = "q quits. %d x %d is too small: the panel needs %d x %d"
    notice %= (columns, rows, COLUMNS, ROWS)
    kept = lines[: rows - 1] if rows < ROWS else lines[:-1]
    kept = kept + [said[0] if said else notice]
    return [cut(line, columns) for line in kept]
