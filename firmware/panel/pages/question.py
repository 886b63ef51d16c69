"""A question that takes both rows: one key says yes, another may say something else, the rest no.

    panel.ask(Question(panel, texts.ASK_CUTS_OFF, {"SET": self._write}, mask))

Row 1 says in turn what is at stake, row 2 which keys answer. STOP does its work besides.
"""

from micropython import const

from panel import texts
from uss.timing import elapsed

TURN_MS = const(1_500)


class Question:
    """text: (texts for row 1 in turn, text of row 2). answers: key -> function of now_ms.

    mask: the clock's period - 1.
    """

    whole = True  # takes both rows
    obeys = False  # the keys that act on every page do not act on this one, but for STOP

    def __init__(self, panel, text, answers, mask):
        self._panel = panel
        self._mask = mask
        self._text = text
        self._answers = answers
        self._shown_at = None

    def take_keys(self, keys, now_ms):
        if not keys.pressed:
            return
        self._panel.close_question()
        for key, answer in self._answers.items():
            if keys.pressed == keys.bit(key):  # two keys at once are no answer
                answer(now_ms)

    def draw(self, screen, now_ms):
        turns, choice = self._text
        if self._shown_at is None:
            self._shown_at = now_ms
        turn = elapsed(now_ms, self._shown_at, self._mask) // TURN_MS
        screen.put(0, 0, texts.ROW_WIDTH, turns[turn % len(turns)])
        screen.put(1, 0, texts.ROW_WIDTH, choice)
