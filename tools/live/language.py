# SPDX-License-Identifier: MIT
"""The words of a running panel and what shows it: README.md explains them.

    message = understood('{"t":"down","key":"STOP"}')   # Misunderstood: no message, and why
    line = spoken("notice", text="the line is cut")     # bytes, with the line's end

Both sides import it, on MicroPython and on CPython.
"""

import json

VERSION = 1
LINE_MAX = 2_000  # characters of a message to the panel
ID_MAX = 0x7FFFFFFF
SPEED_MAX = 100

# To the panel. Kind: its fields, each with the types it may have. Any of them may also say `id`.
NUMBER = (int, float)
TO_PANEL = {
    "hello": (("v", (int,)),),
    "alive": (),
    "bye": (),
    "down": (("key", (str,)),),
    "up": (("key", (str,)),),
    "release": (),
    "arm": (),
    "do": (("n", (int,)), ("line", (str,))),
    "speed": (("x", NUMBER),),
}
# From the panel. Kind: its fields. Those of `ANSWERS` are for one front end, the one of their id.
FROM_PANEL = {
    "hello": (
        "v", "version", "place", "real", "keys", "letters", "behind_fn", "drives", "baud",
        "lease_ms", "commands",
    ),
    "state": ("us", "lcd", "down", "shown", "doing"),
    "time": ("us", "speed", "wanted"),
    "drives": ("us", "drives"),
    "telegram": ("n", "us", "from", "hex", "text", "wrong"),
    "count": ("drives",),
    "broken": ("text",),
    "notice": ("text",),
    "done": ("id", "n", "ok", "out"),
    "error": ("id", "n", "text"),
}  # fmt: skip
ANSWERS = ("done", "error")


class Misunderstood(Exception):
    """A line that is no message. Text: why. id, n: as far as they could be read, else 0, None."""

    def __init__(self, text, id=0, n=None):
        super().__init__(text)
        self.id = id
        self.n = n


def understood(line):
    """The message of a line to the panel, a dict that has all of its fields and `id`."""
    if len(line) > LINE_MAX:
        raise Misunderstood("a message has %d characters at the most" % LINE_MAX)
    try:
        message = json.loads(line)
    except Exception:  # MicroPython's json has several
        raise Misunderstood("this is no JSON")
    if not isinstance(message, dict):
        raise Misunderstood("a message is an object")
    id, n = whole(message.get("id", 0)), whole(message.get("n"))
    if id is None:
        raise Misunderstood("id is a number from 0 to %d" % ID_MAX, 0, n)
    kind = message.get("t")
    if not isinstance(kind, str) or kind not in TO_PANEL:
        raise Misunderstood("no message of this kind: there are %s" % kinds(), id, n)
    for name, types in TO_PANEL[kind]:
        value = message.get(name)
        if not isinstance(value, types) or isinstance(value, bool):
            raise Misunderstood("%s wants %s" % (kind, name), id, n)
        if types == (int,) and whole(value) is None:
            raise Misunderstood("%s is a number from 0 to %d" % (name, ID_MAX), id)
    message["id"] = id
    return message


def whole(value):
    """A whole number within bounds, or None."""
    is_whole = isinstance(value, int) and not isinstance(value, bool)
    return value if is_whole and 0 <= value <= ID_MAX else None


def kinds():
    return " ".join(sorted(TO_PANEL))


def spoken(kind, **fields):
    """A message as the bytes of a line."""
    fields["t"] = kind
    return json.dumps(fields).encode() + b"\n"
