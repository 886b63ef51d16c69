# SPDX-License-Identifier: MIT
"""How far long work is, and how long the rest will take.

progress = Progress(20)                     # pieces of work, or bytes
progress.line(3)                            # 3 of 20, 1:40 min left
"""

import time

SOON_S = 2  # before that nobody can tell how long it takes


class Progress:
    """count: of all pieces. now_s: a clock."""

    def __init__(self, count, now_s=time.monotonic):
        self.count = count
        self._now_s = now_s
        self._began_s = now_s()

    def left(self, done):
        """ "1:40 min left"; "" if nobody can tell. done: pieces, or a part of one."""
        took_s = self._now_s() - self._began_s
        if took_s < SOON_S or not 0 < done < self.count:
            return ""
        return shown(took_s * (self.count - done) / done) + " left"

    def line(self, done, part=0.0):
        """part: how much is done of what is being worked on, in pieces."""
        left = self.left(done + part)
        return f"{done} of {self.count}" + (f", {left}" if left else "")


def shown(seconds):
    """The time as a person says it."""
    seconds = round(seconds)
    if seconds < 60:
        return f"{seconds} s"
    if seconds < 3600:
        return f"{seconds // 60}:{seconds % 60:02} min"
    return f"{seconds // 3600}:{seconds // 60 % 60:02} h"
