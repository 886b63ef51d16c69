# SPDX-License-Identifier: MIT
"""A question that takes both rows: one key says yes, another may say something else, the rest no.

In use:

    panel.cover(Question(panel, ASK[CUTS_OFF], (1, 700, 2), {"SET": self._write}))

Row 1 says in turn what is at stake, row 2 which keys answer. STOP does its work besides.
"""

from micropython import const

from panel import texts, wording
from panel.pages import Page
from uss.timing import elapsed

_STALE_MS = const(30_000)  # whoever caused it is gone by then
_UNREAD_MS = const(500)  # until row 2 is drawn, and seen, when a message has left it


class Question(Page):
    """text: (texts for row 1 in turn, text of row 2), one of texts.ASK_...; values: what belongs
    into the former. answers: key -> function of now_ms.

    deaf_ms: so long after it appeared no answer counts, because nobody has read it yet. Nor does
    one while a message hides which keys answer.
    """

    modules = ("panel.pages.question",)
    whole = True
    obeys = False

    def __init__(self, panel, text, values, answers, deaf_ms=0):
        Page.__init__(self, panel)
        stakes, self._choice = text
        self._stakes = texts.filled(stakes, *values)
        self._answers = answers
        self._deaf_ms = deaf_ms
        self._shown_at_ms = None
        self._hidden_at_ms = None  # a message was in row 2, until then
        self._alarmed = panel.selected.needs_attention()

    def take_keys(self, acts, now_ms):
        if not acts.pressed:
            return
        chosen = None
        for key in self._answers:
            if acts.pressed == acts.bit(key):  # two keys at once are no answer
                chosen = self._answers[key]
        is_unread = self._hidden_at_ms is not None or self._shown_for_ms(now_ms) < self._deaf_ms
        if chosen is not None and is_unread:
            return
        self.close()
        acts.forget()  # a key that said no, and is held, does nothing else
        if chosen is not None:
            chosen(now_ms)

    def step(self, keys, now_ms):
        if self._shown_at_ms is None:
            self._shown_at_ms = now_ms
        if self.panel.message:
            self._hidden_at_ms = now_ms
        elif self._hidden_at_ms is not None:
            if elapsed(now_ms, self._hidden_at_ms, self.panel.mask) >= _UNREAD_MS:
                self._hidden_at_ms = None
        is_stale = self._shown_for_ms(now_ms) >= _STALE_MS
        # An alarm is not to be hidden; but one that nobody can end may need the answer.
        alarmed, self._alarmed = self._alarmed, self.panel.selected.needs_attention()
        if is_stale or self._alarmed and not alarmed:
            self.close()

    def draw(self, screen, now_ms):
        turn, stakes = self.panel.announcer.page_turns, self._stakes
        if not self._alarmed:
            row = stakes[turn % len(stakes)]
        elif turn & 1:
            row = wording.alarm(self.panel.selected)
        else:
            row = stakes[turn // 2 % len(stakes)]
        screen.put(0, 0, texts.ROW_WIDTH, row)
        screen.put(1, 0, texts.ROW_WIDTH, texts.of(self._choice))

    def _shown_for_ms(self, now_ms):
        if self._shown_at_ms is None:
            return 0
        return elapsed(now_ms, self._shown_at_ms, self.panel.mask)
