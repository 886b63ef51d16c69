# SPDX-License-Identifier: MIT
"""What a START asks before the motor turns: whether the operator takes a risk, see `panel.risks`.

START takes it. Where SET puts it right, SET writes P2014, and the next START asks for less.
"""

from micropython import const

from panel import risks, texts
from panel.phases import ASKING
from panel.pages.question import Question

_READING_MS = const(1_000)  # so long a START does not answer: it may be a double tap


class RiskQuestion(Question):
    """About the risk that `panel.selected` is asked about, which is open."""

    modules = ("panel.pages.risk",) + Question.modules

    def __init__(self, panel):
        self._control = control = panel.selected
        self._risk = risk = control.question()
        text, values, can_fix, self._value = risks.ask(control, risk)
        answers = {"START": self._accept}
        if risk == risks.SUPERVISION and getattr(panel.board, "must_supervise", False):
            answers["START"] = self._refuse
            text = text[0], texts.FIX_OR_STOP if can_fix else texts.CANNOT_START
        if can_fix:
            answers["SET"] = self._supervise
        Question.__init__(self, panel, text, values, answers, _READING_MS)

    def close(self):
        self._control.drop_question()
        Question.close(self)

    def step(self, keys, now_ms):
        control, risk = self._control, self._risk
        if control.phase != ASKING or not risks.is_open(control, risk):
            self.close()
        elif risks.measure(control, risk) != self._value:  # another one than was asked about
            self.panel.cover(RiskQuestion(self.panel))
        else:
            Question.step(self, keys, now_ms)

    def _accept(self, now_ms):
        if self.panel.stop_key.is_down:
            self.panel.say(now_ms, texts.REFUSED_STOP)
        else:
            self._control.accept_risk(self._risk, self._value)

    def _refuse(self, now_ms):
        """On this board nobody may take that risk."""
        self.panel.say(now_ms, texts.REFUSED_UNWATCHED)

    def _supervise(self, now_ms):
        """Have the drive stop by itself when this panel falls silent."""
        family = self._control.survey.family
        number, index = family.off_time_number, family.link_index
        value = -(-self._control.desk.off_time_ms // family.off_time_unit_ms)
        self.panel.write(now_ms, self._control, number, index, value)
