# SPDX-License-Identifier: MIT
"""A board seen from above, with what is wired to each pin, as SVG."""

from tools.drawing.layouts import LAYOUTS, sides
from tools.drawing.wires import table, wires

ROW, TOP_Y, FONT = 22, 60, 13
LEFT_X, BODY, EDGE = 250, 220, 720  # where the board begins, how wide it is, the picture's width
CHARACTER = 8  # the widest that a character of this monospaced font is
COLOURS = (("bus", "#b5651d"), ("key", "#2e6da4"), ("LCD", "#2e8b57"), ("S", "#6a4fa3"))
STYLE = f'font-family="monospace" font-size="{FONT}"'


def texts_of(board):
    """Each text of the picture: (x of its left end, y, the text, its colour)."""
    _, number_form, supply = LAYOUTS[board]
    wired = {number_form % number: what for number, what in wires(board).items()}
    wired.update(supply)
    name = table(board)["name"]
    yield EDGE // 2 - len(name) * CHARACTER // 2, 30, name, "#000"
    for side, names in enumerate(sides(board)):
        for place, pin in enumerate(names):
            y = TOP_Y + ROW * place + ROW // 2 + FONT // 3
            what = wired.get(pin, "ground" if pin.endswith("GND") else "")
            if side == 0:
                yield LEFT_X + 10, y, pin, "#fff"
                if what:
                    yield LEFT_X - 30 - len(what) * CHARACTER, y, what, colour(what)
            else:
                yield LEFT_X + BODY - 10 - len(pin) * CHARACTER, y, pin, "#fff"
                if what:
                    yield LEFT_X + BODY + 30, y, what, colour(what)


def colour(what):
    return next((shade for word, shade in COLOURS if what.startswith(word)), "#444")


def picture(board):
    rows = max(map(len, sides(board)))
    height = TOP_Y + ROW * rows + 20
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{EDGE}" height="{height}" {STYLE}>',
        f'<rect width="{EDGE}" height="{height}" fill="#fff"/>',
        f'<rect x="{LEFT_X}" y="{TOP_Y - 8}" width="{BODY}" height="{ROW * rows + 16}" rx="8"'
        ' fill="#1d4d2b"/>',
    ]
    for x, y, text, shade in texts_of(board):
        if shade not in ("#fff", "#000"):
            end = LEFT_X if x < LEFT_X else LEFT_X + BODY
            begin = LEFT_X - 26 if x < LEFT_X else LEFT_X + BODY + 26
            level = y - FONT // 3
            lines.append(f'<path d="M{begin} {level}H{end}" stroke="{shade}" stroke-width="2"/>')
        length = len(text) * CHARACTER
        lines.append(f'<text x="{x}" y="{y}" fill="{shade}" textLength="{length}">{text}</text>')
    return "\n".join([*lines, "</svg>", ""])
