# SPDX-License-Identifier: MIT
"""Shows the lists of the menu, one over the other, and walks them. See `panel.menu`.

STOP acts as on every page; nothing in here starts a motor. A menu that nobody has used for a
minute closes.
"""

from micropython import const

import on_demand
from panel import texts
from panel.pages import Page
from uss.timing import elapsed

_STALE_MS = const(60_000)
_COUNT_COLUMN = const(11)  # "12/31"


class Menu(Page):
    """The page that covers all others while the menu is open. begin: the first list."""

    modules = ("panel.menu.engine",)
    whole = True
    obeys = False

    def __init__(self, panel, begin=("main", None)):
        Page.__init__(self, panel)
        self._lists = []  # (name of the module, `List`, position in it), the one shown last
        self._used_at_ms = None
        self._enter(*begin)

    def take_keys(self, acts, now_ms):
        if not (acts.pressed or acts.repeated):
            return
        self._used_at_ms = now_ms
        name, shown, position = self._lists[-1]
        direction = acts.direction("DOWN", "UP") or acts.direction("NEXT", "PREVIOUS")
        turned = acts.direction("ADDRESS_UP", "ADDRESS_DOWN")
        if acts.has("PARAM"):
            self._leave()
        elif turned and name == "address":
            self._lists[-1] = (name, shown, (position + turned) % shown.count())
        elif acts.has("SET"):
            following = shown.choose(position, now_ms)
            if following is not None:
                self._enter(*following)
        elif direction and not shown.change(position, -direction * acts.pace(100)):
            self._lists[-1] = (name, shown, (position + direction) % shown.count())

    def step(self, keys, now_ms):
        _, shown, position = self._lists[-1]
        shown.step(position, now_ms)
        if self._used_at_ms is None:
            self._used_at_ms = now_ms
        stale = elapsed(now_ms, self._used_at_ms, self.panel.mask) >= _STALE_MS
        if stale or self.panel.selected.needs_attention():  # an alarm is not to be hidden
            self.close()

    def close(self):
        """Close the whole menu."""
        while self._lists:
            on_demand.drop("panel.menu." + self._lists.pop()[0])
        self.panel.uncover()

    def draw(self, screen, now_ms):
        _, shown, position = self._lists[-1]
        count = shown.count()
        position = min(position, count - 1)  # what was last in it may have gone
        screen.put(0, 0, _COUNT_COLUMN, texts.of(shown.title))
        screen.put(0, _COUNT_COLUMN, 5, b"%5s" % (b"%d/%d" % (position + 1, count)))
        screen.put(1, 0, 1, texts.of(texts.MENU_MARK))
        screen.put(1, 1, texts.ROW_WIDTH - 1, shown.words(position))

    def _enter(self, name, argument):
        shown = on_demand.load("panel.menu." + name).List(self.panel, argument)
        self._lists.append((name, shown, shown.first()))

    def _leave(self):
        """Back to the list above this one."""
        on_demand.drop("panel.menu." + self._lists.pop()[0])
        if not self._lists:
            self.panel.uncover()
