# SPDX-License-Identifier: MIT
"""A question that takes both rows: one key says yes, another may say something else, the rest no.

    panel.ask(Question(panel, texts.ASK_CUTS_OFF, {"SET": self._write}, mask))

Row 1 says in turn what is at stake, row 2 which keys answer. STOP does its work besides.
"""

from micropython import const

from panel import texts
from uss.timing import elapsed

_STALE_MS = const(30_000)


class Question:
    """text: (texts for row 1 in turn, text of row 2). answers: key -> function of now_ms.

    mask: the clock's period - 1. deaf_ms: so long after it appeared no answer counts, because
    nobody has read it yet.
    """

    whole = True  # takes both rows
    tells_state = False
    obeys = False  # the keys that act on every page do not act on this one, but for STOP

    def __init__(self, panel, text, answers, mask, deaf_ms=0):
        self._panel = panel
        self._mask = mask
        self._deaf_ms = deaf_ms
        self._text = text
        self._answers = answers
        self._shown_at = None

    def take_keys(self, acts, now_ms):
        if not acts.pressed:
            return
        chosen = None
        for key in self._answers:
            if acts.pressed == acts.bit(key):  # two keys at once are no answer
                chosen = self._answers[key]
        if chosen is not None and self._shown_for(now_ms) < self._deaf_ms:
            return
        self._panel.close_question()
        acts.forget()  # a key that said no, and is held, does nothing else
        if chosen is not None:
            chosen(now_ms)

    def step(self, now_ms):
        """Again and again while it is shown. Answers whether it has been there so long that
        whoever caused it is gone."""
        if self._shown_at is None:
            self._shown_at = now_ms
        return self._shown_for(now_ms) >= _STALE_MS

    def draw(self, screen, now_ms):
        turns, choice = self._text
        screen.put(0, 0, texts.ROW_WIDTH, turns[self._panel.announcer.page_turns % len(turns)])
        screen.put(1, 0, texts.ROW_WIDTH, choice)

    def _shown_for(self, now_ms):
        if self._shown_at is None:
            return 0
        return elapsed(now_ms, self._shown_at, self._mask)
