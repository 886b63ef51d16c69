# SPDX-License-Identifier: MIT
"""A board seen from above, with what is wired to each pin, and the modules of the bus and the
display."""

from tools.drawing.layouts import END, LAYOUTS, modules, numbered, sides
from tools.drawing.wires import keep_off, table, wires
from tools.pictures.svg import Picture, wrapped

ROW, FONT, HEADING, STEP = 21, 12, 13, 17
EDGE = 14
LEFT_X, BODY, ACROSS = 168, 184, 520  # where a board begins, how wide it is, the picture's width
RIGHT_X = LEFT_X + BODY
WIRE, INSIDE, NUMBER = 18, 8, 22  # lengths: of a wire, from the edge to a name; room of a number
BETWEEN = 48  # a board and a module
COLOURS = (("bus", "orange"), ("key", "blue"), ("LCD", "green"), ("S", "violet"))
KEYS = "Each key joins its pin to ground. STOP opens when it is pressed, the others close."
MATRIX = "START and STOP join their pins to ground; STOP opens. The others join a row to a column."


class Box:
    """A board or a module. rows: (what is joined, pin) of the left side, of the right side.
    numbers: the pins are counted, around the board."""

    def __init__(self, name, y, rows, colours, numbers=False):
        self.name = name
        self.y = y
        self.rows = rows
        self.colour, self.pale = colours
        self.numbers = numbers
        self.height = ROW * max(map(len, rows)) + 16


def boxes(board, y):
    """From the top to the bottom, the first one at y."""
    number_form, supply = LAYOUTS[board][1:]
    joined = {number_form % number: what for number, what in wires(board).items()}
    off = {number_form % number: what for number, what in keep_off(board).items()}
    both = {**off, **supply, **joined}
    rows = [
        [(both.get(pin, "ground" if pin.endswith("GND") else ""), pin) for pin in side]
        for side in sides(board)
    ]
    name = f"{table(board)['name']}, from above: {END[board]} on top"
    box = Box(name, y, rows, ("circuit", "on circuit"), numbered(board))
    yield box
    for name, *rows in modules(board):
        box = Box(name, box.y + box.height + BETWEEN, rows, ("module", "white"))
        yield box


def picture(board):
    name = table(board)["name"]
    joined = [f"{what}: pin {number}" for number, what in sorted(wires(board).items())]
    drawn = Picture(ACROSS, f"{name}: what is wired to which pin", ". ".join(joined) + ".")
    text = MATRIX if "ROWS" in table(board) else KEYS
    y = drawn.lines(
        EDGE, EDGE + FONT, wrapped(text, ACROSS - 2 * EDGE, FONT), STEP, colour="pale", size=FONT
    )
    off = keep_off(board).values()
    for at, box in enumerate(boxes(board, y + BETWEEN - 16)):
        _box(drawn, box, off)
        if not at:  # the end by which one knows where the top is
            drawn.rect(LEFT_X + BODY / 2 - 26, box.y - 12, 52, 30, "metal", radius=3)
        drawn.down = box.y + box.height + EDGE
    return drawn


def _box(drawn, box, off):
    """off: what is written at pins that are better left alone."""
    drawn.text(ACROSS / 2, box.y - 20, box.name, size=HEADING, anchor="middle", bold=True)
    drawn.rect(LEFT_X, box.y, BODY, box.height, box.colour, radius=8)
    inside = INSIDE + (NUMBER if box.numbers else 0)
    left, right = box.rows
    for place, (what, pin) in enumerate(left):
        y = box.y + 8 + ROW * place + ROW / 2
        drawn.text(LEFT_X + inside, y + 4, pin, "white", FONT)
        if box.numbers:
            drawn.text(LEFT_X + INSIDE, y + 4, str(place + 1), box.pale, FONT)
        _wire(drawn, LEFT_X, -1, y, what, off)
    for place, (what, pin) in enumerate(right):
        y = box.y + 8 + ROW * place + ROW / 2
        drawn.text(RIGHT_X - inside, y + 4, pin, "white", FONT, "end")
        if box.numbers:
            number = str(len(left) + len(right) - place)
            drawn.text(RIGHT_X - INSIDE, y + 4, number, box.pale, FONT, "end")
        _wire(drawn, RIGHT_X, 1, y, what, off)


def _wire(drawn, x, way, y, what, off):
    """From the edge at x to the left, -1, or to the right, 1, and what it leads to."""
    if not what:
        return
    shade = colour(what, off)
    end = x + way * WIRE
    if what not in off:
        drawn.line([(x, y), (end, y)], shade, 2)
    drawn.text(end + way * 4, y + 4, what, shade, FONT, "start" if way > 0 else "end")


def colour(what, off=()):
    if what in off:
        return "pale"
    return next((shade for word, shade in COLOURS if what.startswith(word)), "ink")
