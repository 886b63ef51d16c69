# SPDX-License-Identifier: MIT
"""Values over time as a picture: a strip for each, one above the other, all with the same time."""

from html import escape

WIDTH, STRIP, MARGIN, GAP = 900, 120, 60, 34
COLOURS = ("#1b6ca8", "#c0392b", "#1e8449", "#8e44ad", "#b9770e", "#117a65")


def chart(heads, rows):
    """The text of an SVG file. rows: seconds, then a value or None for each head."""
    height = len(heads) * (STRIP + GAP) + MARGIN
    last_s = max([row[0] for row in rows] + [0.001])
    parts = [
        '<svg xmlns="http://www.w3.org/2000/svg" width="%d" height="%d" font-family="sans-serif" '
        'font-size="12">' % (WIDTH, height),
        '<rect width="100%" height="100%" fill="white"/>',
    ]
    for place, head in enumerate(heads):
        top = GAP + place * (STRIP + GAP)
        points = [(row[0] / last_s, row[place + 1]) for row in rows]
        parts += _strip(head, points, top, COLOURS[place % len(COLOURS)])
    parts.append(
        '<text x="%d" y="%d" text-anchor="end">%.3g s</text>' % (WIDTH - 10, height - 20, last_s)
    )
    return "\n".join(parts + ["</svg>", ""])


def _strip(head, points, top, colour):
    known = [value for _, value in points if value is not None]
    low, high = min(known, default=0), max(known, default=0)
    span = high - low or 1
    yield '<text x="%d" y="%d">%s</text>' % (MARGIN, top - 6, escape(head, quote=False))
    yield '<rect x="%d" y="%d" width="%d" height="%d" fill="none" stroke="#bbb"/>' % (
        MARGIN, top, WIDTH - MARGIN - 10, STRIP,
    )  # fmt: skip
    for value, y in ((high, top + 12), (low, top + STRIP)):
        yield '<text x="%d" y="%d" text-anchor="end">%.6g</text>' % (MARGIN - 4, y, value)
    line = []
    for share, value in points + [(0, None)]:
        if value is None:  # nobody knows what was in between: the line breaks
            if line:
                yield '<polyline fill="none" stroke="%s" points="%s"/>' % (colour, " ".join(line))
            line = []
        else:
            x = MARGIN + share * (WIDTH - MARGIN - 10)
            y = top + STRIP * (1 - (value - low) / span)
            line.append("%.1f,%.1f" % (x, y))
