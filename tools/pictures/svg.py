# SPDX-License-Identifier: MIT
"""A picture as SVG: shapes and texts in a few colours, for the manuals.

    picture = Picture(460, "What it is", "What is to be seen, in a sentence or two.")
    picture.rect(10, 10, 200, 40, "box", radius=6)
    picture.text(20, 35, "START", bold=True)
    picture.down = 60                       # its height
    Path("a.svg").write_text(picture.svg())

It has a paper of its own, and every colour has a second one for those who read in the dark. No
font comes with it: each text says how long it is, so that it keeps its room in any font.
"""

from html import escape
from typing import NamedTuple

FONTS = {
    False: "Arial,Helvetica,Liberation Sans,sans-serif",
    True: "ui-monospace,Consolas,Menlo,Liberation Mono,monospace",
}
# Name: in the light, in the dark.
COLOURS = {
    "paper": ("#ffffff", "#0d1117"),
    "ink": ("#1f2328", "#e6edf3"),
    "pale": ("#59636e", "#9aa4af"),
    "line": ("#8c959f", "#6e7681"),
    "box": ("#eef1f4", "#1c232c"),
    "white": ("#ffffff", "#ffffff"),
    "blue": ("#1f5f9e", "#79b8ff"),
    "green": ("#1a7f37", "#4cc764"),
    "orange": ("#b3541e", "#f0a35e"),
    "violet": ("#6a4fa3", "#b99cf0"),
    "red": ("#c1272d", "#ff7b72"),
    "plate": ("#343b44", "#343b44"),  # the front of a panel looks the same at night
    "bezel": ("#14181d", "#14181d"),
    "cap": ("#e7eaee", "#e7eaee"),
    "on cap": ("#1f2328", "#1f2328"),
    "on plate": ("#d5dbe1", "#d5dbe1"),
    "go": ("#2c8a3f", "#2c8a3f"),
    "stop": ("#c1272d", "#c1272d"),
    "glass": ("#a9c346", "#a9c346"),
    "cell": ("#9fb93d", "#9fb93d"),
    "dot": ("#1c2a0c", "#1c2a0c"),
    "circuit": ("#1d4d2b", "#1d4d2b"),
    "on circuit": ("#b9cfc0", "#b9cfc0"),
    "module": ("#2b3a4d", "#2b3a4d"),
    "metal": ("#9aa0a6", "#9aa0a6"),
}
LINE = "line of "  # a colour that is drawn with, not filled with
MONO = 600  # width of a character, in thousandths of the font's size
HEIGHT, DEPTH = 0.75, 0.22  # of a text, above and below its line, in sizes of the font
# Widths of the characters from blank to tilde in Helvetica, in thousandths: plain, bold.
FIRST = 32
WIDTHS = {
    bold: [int(width) for width in row.split()]
    for bold, row in {
        False: """278 278 355 556 556 889 667 191 333 333 389 584 278 333 278 278
            556 556 556 556 556 556 556 556 556 556 278 278 584 584 584 556
            1015 667 667 722 722 667 611 778 722 278 500 667 556 833 722 778
            667 778 722 667 611 722 667 944 667 667 611 278 278 278 469 556
            333 556 556 500 556 556 278 556 556 222 222 500 222 833 556 556
            556 556 333 500 278 556 500 722 500 500 500 334 260 334 584""",
        True: """278 333 474 556 556 889 722 238 333 333 389 584 278 333 278 278
            556 556 556 556 556 556 556 556 556 556 333 333 584 584 584 611
            975 722 722 722 722 667 611 778 722 278 556 722 611 833 722 778
            667 778 722 667 611 722 667 944 667 667 611 333 278 333 584 556
            333 556 611 556 611 556 333 611 611 278 278 556 278 889 611 611
            611 611 389 556 333 611 556 778 556 556 500 389 280 389 584""",
    }.items()
}


def width(text, size, bold=False, mono=False):
    """Of a text, in user units. KeyError: it has a character whose width nobody knows."""
    if mono:
        return len(text) * MONO * size / 1000
    row = WIDTHS[bold]
    for character in text:
        if not FIRST <= ord(character) < FIRST + len(row):
            raise KeyError(character)
    return sum(row[ord(character) - FIRST] for character in text) * size / 1000


def wrapped(text, room, size, bold=False):
    """The text in lines that are no wider than `room`."""
    lines = []
    for word in text.split():
        longer = f"{lines[-1]} {word}" if lines else word
        if lines and width(longer, size, bold) <= room:
            lines[-1] = longer
        else:
            lines.append(word)
    return lines


class Box(NamedTuple):
    """A text and the room that it takes."""

    text: str
    left: float
    top: float
    right: float
    bottom: float

    def overlaps(self, other):
        return (
            self.left < other.right
            and other.left < self.right
            and self.top < other.bottom
            and other.top < self.bottom
        )


class Picture:
    """across, down: its width and height. title, words: for those who do not see it.

    texts: a `Box` for each text, in the order in which they came.
    """

    def __init__(self, across, title, words):
        self.across = across
        self.down = 0.0
        self.texts = []
        self._head = f"<title>{escape(title)}</title>\n<desc>{escape(words)}</desc>"
        self._used = {"paper"}
        self._shapes = []
        self._symbols = {}

    def rect(self, x, y, across, down, colour, radius=0, edge=None):
        """edge: the colour of a line around it; then `colour` may be None."""
        rounded = f' rx="{radius}"' if radius else ""
        self._add(
            f'<rect x="{_n(x)}" y="{_n(y)}" width="{_n(across)}" height="{_n(down)}"{rounded}'
            f"{self._class(colour, edge)}/>"
        )

    def line(self, way, colour, thick=1.5, dashes=None, arrow=False):
        """way: points (x, y). arrow: at its end."""
        drawn = "M" + "L".join(f"{_n(x)} {_n(y)}" for x, y in way)
        dashed = f' stroke-dasharray="{dashes}"' if dashes else ""
        self._add(f'<path d="{drawn}"{self._class(None, colour)} stroke-width="{thick}"{dashed}/>')
        if arrow:
            (x0, y0), (x, y) = way[-2:]
            along = ((x > x0) - (x < x0), (y > y0) - (y < y0))
            self.shape(_head(x, y, *along), colour)

    def shape(self, drawn, colour):
        """drawn: a path of SVG, filled."""
        self._add(f'<path d="{drawn}"{self._class(colour, None)}/>')

    def text(self, x, y, text, colour="ink", size=13, anchor="start", bold=False, mono=False):
        """anchor: which end of it is at x: start, middle, end. y: its line."""
        long = width(text, size, bold, mono)
        left = x - {"start": 0, "middle": long / 2, "end": long}[anchor]
        self.texts.append(Box(text, left, y - HEIGHT * size, left + long, y + DEPTH * size))
        weight = ' font-weight="bold"' if bold else ""
        family = f' font-family="{FONTS[True]}"' if mono else ""
        blanks = ' xml:space="preserve"' if "  " in text else ""
        self._add(
            f'<text x="{_n(left)}" y="{_n(y)}" font-size="{_n(size)}"{weight}{family}{blanks}'
            f'{self._class(colour, None)} textLength="{_n(long)}">{escape(text)}</text>'
        )

    def lines(self, x, y, texts, step, **how):
        """Texts below each other. Answers where the next one would be."""
        for text in texts:
            self.text(x, y, text, **how)
            y += step
        return y

    def symbol(self, name, drawn):
        """A shape that is used often; `use` draws it."""
        self._symbols[name] = drawn

    def use(self, places, colour, x, y, scale):
        """places: (name of a symbol, x, y) in units of `scale`, which is one number for each axis.

        (x, y): where they begin.
        """
        used = "".join(f'<use href="#{name}" x="{_n(u)}" y="{_n(v)}"/>' for name, u, v in places)
        across, down = scale
        self._add(
            f'<g transform="translate({_n(x)} {_n(y)}) scale({_n(across)} {_n(down)})"'
            f"{self._class(colour, None)}>{used}</g>"
        )

    def svg(self):
        """The file."""
        size = f'width="{_n(self.across)}" height="{_n(self.down)}"'
        box = f'viewBox="0 0 {_n(self.across)} {_n(self.down)}"'
        parts = [
            f'<svg xmlns="http://www.w3.org/2000/svg" {size} {box} role="img"'
            f' font-family="{FONTS[False]}">',
            self._head,
            self._style(),
        ]
        if self._symbols:
            drawn = (f'<path id="{name}" d="{way}"/>' for name, way in self._symbols.items())
            parts.append("<defs>\n" + "\n".join(drawn) + "\n</defs>")
        parts.append(f'<rect {size} rx="8" class="paper"/>')
        return "\n".join([*parts, *self._shapes, "</svg>", ""])

    def _add(self, shape):
        self._shapes.append(shape)

    def _class(self, fill, edge):
        """The attributes that colour a shape."""
        names = ([fill] if fill else []) + ([LINE + edge] if edge else [])
        self._used.update(names)
        nothing = "" if fill else ' fill="none"'
        return f' class="{" ".join(map(_css, names))}"{nothing}'

    def _style(self):
        """The classes in use, for the light and for the dark."""
        names = [name for name in (*COLOURS, *(LINE + name for name in COLOURS))
                 if name in self._used]  # fmt: skip
        light, dark = ("".join(_rule(name, at) for name in names) for at in (0, 1))
        return f"<style>\n{light}@media (prefers-color-scheme: dark) {{\n{dark}}}\n</style>"


def _css(name):
    return name.replace(" ", "-")


def _rule(name, at):
    what = "stroke" if name.startswith(LINE) else "fill"
    return f".{_css(name)}{{{what}:{COLOURS[name.removeprefix(LINE)][at]}}}\n"


def _n(number):
    """A number as short as it can be."""
    return f"{number:.2f}".rstrip("0").rstrip(".")


def _head(x, y, across, down, long=8, wide=4):
    """The head of an arrow that ends at (x, y)."""
    back_x, back_y = x - across * long, y - down * long
    return (
        f"M{_n(x)} {_n(y)}L{_n(back_x + down * wide)} {_n(back_y + across * wide)}"
        f"L{_n(back_x - down * wide)} {_n(back_y - across * wide)}z"
    )
