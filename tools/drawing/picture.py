# SPDX-License-Identifier: MIT
"""A board seen from above, with what is wired to each pin, and the modules of the bus and the
display, as SVG."""

from tools.drawing.layouts import END, LAYOUTS, modules, numbered, sides
from tools.drawing.wires import keep_off, table, wires

ROW, TOP_Y, FONT = 22, 90, 13
LEFT_X, BODY, EDGE = 250, 220, 720  # where a board begins, how wide it is, the picture's width
RIGHT_X = LEFT_X + BODY
WIRE, INSIDE, NUMBER = 26, 10, 30  # lengths: of a wire, from the edge to a name; room of a number
CHARACTER = 8  # the widest that a character of this monospaced font is
BOARD, MODULE, PAPER = "#1d4d2b", "#2b3a4d", "#fff"
ON_BOARD, PALE, HEADING, OFF = "#fff", "#b9cfc0", "#000", "#999"
COLOURS = (("bus", "#b5651d"), ("key", "#2e6da4"), ("LCD", "#2e8b57"), ("S", "#6a4fa3"))
PLAIN = "#444"
STYLE = f'font-family="monospace" font-size="{FONT}"'
KEYS = "Each key joins its pin to ground. STOP opens when it is pressed, the others close."
MATRIX = "START and STOP join their pins to ground; STOP opens. The others join a row to a column."


class Box:
    """A board or a module. rows: (what is joined, pin) of the left side, of the right side.
    numbers: the pins are counted, around the board."""

    def __init__(self, name, y, rows, colour, numbers=False):
        self.name = name
        self.y = y
        self.rows = rows
        self.colour = colour
        self.numbers = numbers
        self.height = ROW * max(map(len, rows)) + 16


def boxes(board):
    """From the top to the bottom."""
    number_form, supply = LAYOUTS[board][1:]
    joined = {number_form % number: what for number, what in wires(board).items()}
    off = {number_form % number: what for number, what in keep_off(board).items()}
    both = {**off, **supply, **joined}
    rows = [
        [(both.get(pin, "ground" if pin.endswith("GND") else ""), pin) for pin in side]
        for side in sides(board)
    ]
    name = table(board)["name"]
    box = Box(f"{name}, from above: {END[board]} on top", TOP_Y, rows, BOARD, numbered(board))
    yield box
    for name, *rows in modules(board):
        box = Box(name, box.y + box.height + 50, rows, MODULE)
        yield box


def texts_of(board):
    """Each text of the picture: (x of its left end, y, the text, its colour)."""
    text = MATRIX if "ROWS" in table(board) else KEYS
    yield centred(text), 30, text, PLAIN
    off = keep_off(board).values()
    for box in boxes(board):
        yield centred(box.name), box.y - 22, box.name, HEADING
        inside = INSIDE + (NUMBER if box.numbers else 0)
        left, right = box.rows
        for place, (what, pin) in enumerate(left):
            y = level(box, place) + FONT // 3
            yield LEFT_X + inside, y, pin, ON_BOARD
            if box.numbers:
                yield LEFT_X + INSIDE, y, str(place + 1), PALE
            if what:
                yield LEFT_X - WIRE - 4 - width(what), y, what, colour(what, off)
        for place, (what, pin) in enumerate(right):
            y = level(box, place) + FONT // 3
            yield RIGHT_X - inside - width(pin), y, pin, ON_BOARD
            if box.numbers:
                number = str(len(left) + len(right) - place)
                yield RIGHT_X - INSIDE - width(number), y, number, PALE
            if what:
                yield RIGHT_X + WIRE + 4, y, what, colour(what, off)


def wires_of(board):
    """Each wire: (x of its left end, y, its colour)."""
    off = keep_off(board).values()
    for box in boxes(board):
        for rows, x in zip(box.rows, (LEFT_X - WIRE, RIGHT_X)):
            for place, (what, _) in enumerate(rows):
                if what and what not in off:
                    yield x, level(box, place), colour(what, off)


def level(box, place):
    return box.y + 8 + ROW * place + ROW // 2


def width(text):
    return len(text) * CHARACTER


def centred(text):
    return (EDGE - width(text)) // 2


def colour(what, off=()):
    if what in off:
        return OFF
    return next((shade for word, shade in COLOURS if what.startswith(word)), PLAIN)


def picture(board):
    drawn = list(boxes(board))
    height = drawn[-1].y + drawn[-1].height + 20
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{EDGE}" height="{height}" {STYLE}>',
        f'<rect width="{EDGE}" height="{height}" fill="{PAPER}"/>',
    ]
    for box in drawn:
        lines.append(
            f'<rect x="{LEFT_X}" y="{box.y}" width="{BODY}" height="{box.height}" rx="8"'
            f' fill="{box.colour}"/>'
        )
    middle = LEFT_X + BODY // 2  # the end by which one knows where the top is
    lines.append(
        f'<rect x="{middle - 28}" y="{TOP_Y - 14}" width="56" height="34" rx="3" fill="#9aa0a6"/>'
    )
    for x, y, shade in wires_of(board):
        lines.append(f'<path d="M{x} {y}H{x + WIRE}" stroke="{shade}" stroke-width="2"/>')
    for x, y, text, shade in texts_of(board):
        length = width(text)
        lines.append(f'<text x="{x}" y="{y}" fill="{shade}" textLength="{length}">{text}</text>')
    return "\n".join([*lines, "</svg>", ""])
