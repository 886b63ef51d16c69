# SPDX-License-Identifier: MIT
"""What a running panel has told so far: its messages (tools/live/README.md), kept for a picture.

told = Told()
told.take(message)
told.lcd["text"], told.drives, told.telegrams.rows ...
"""

from collections import OrderedDict, deque

SAME_US = 10_000_000  # a telegram that comes again within so long is a repeat
ROWS_MAX = 1_000
NOTICES_MAX = 50
DARK = {"on": 0, "lit": 1, "codes": ["20" * 16] * 2, "glyphs": "00" * 64, "text": [" " * 16] * 2}


class Row:
    """A telegram, and how often it has come."""

    def __init__(self, message):
        self.message = message
        self.count = 1
        self.first_us = self.last_us = message["us"]


class Telegrams:
    """The telegrams in the order in which each first came; a repeat only counts. rows: newest
    last. While it is paused the rows stay as they are, and what comes is kept for later.
    """

    def __init__(self):
        self.rows = []
        self.paused = False
        self._by_text = OrderedDict()
        self._kept = deque(maxlen=ROWS_MAX)

    def take(self, message):
        if self.paused:
            self._kept.append(message)
            return
        known = message["from"], message["text"]
        row = self._by_text.get(known)
        if row is not None and message["us"] - row.last_us < SAME_US:
            row.count += 1
            row.last_us = message["us"]
            row.message = message
            return
        row = self._by_text[known] = Row(message)
        self._by_text.move_to_end(known)
        self.rows.append(row)
        if len(self.rows) > ROWS_MAX:
            del self.rows[: ROWS_MAX // 2]
            while len(self._by_text) > ROWS_MAX:
                self._by_text.popitem(last=False)

    def pause(self, on):
        """Stand still, or go on with what came meanwhile."""
        self.paused = on
        while self._kept and not on:
            self.take(self._kept.popleft())


class Told:
    """hello, lcd, down, shown, doing, us, speed, wanted, drives, counts: as told last, with the
    names of the messages. notices: lines for a person that nobody has taken yet. broken: a rule of
    the line that was broken, "" if none. changed: something was told since it was set to False.
    """

    def __init__(self):
        self.hello = None
        self.lcd = DARK
        self.down = []
        self.shown = None
        self.doing = None
        self.us = 0
        self.speed = self.wanted = 1.0
        self.drives = []
        self.counts = {}
        self.broken = ""
        self.telegrams = Telegrams()
        self.notices = deque(maxlen=NOTICES_MAX)
        self.changed = False

    def take(self, message):
        """A message that is no answer."""
        take = getattr(self, "_" + message["t"], None)
        if take is not None:  # a later version may say more
            take(message)
            self.changed = True

    def _hello(self, message):
        self.hello = message

    def _state(self, message):
        self.us = message["us"]
        self.lcd = message["lcd"]
        self.down = message["down"]
        self.shown = message["shown"]
        self.doing = message["doing"]

    def _time(self, message):
        self.us = message["us"]
        self.speed = message["speed"]
        self.wanted = message["wanted"]

    def _drives(self, message):
        self.us = message["us"]
        self.drives = message["drives"]

    def _telegram(self, message):
        self.telegrams.take(message)

    def _count(self, message):
        self.counts = {drive["a"]: drive for drive in message["drives"]}

    def _broken(self, message):
        self.broken = message["text"]

    def _notice(self, message):
        self.notices.append(message["text"])
