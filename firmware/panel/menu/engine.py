# SPDX-License-Identifier: MIT
"""Shows the lists of the menu, one over the other, and walks them. See `panel.menu`.

STOP acts as on every page, and stops the drive that row 2 names, too. Nothing in here starts a
motor. A menu that nobody has used for a minute closes.
"""

from micropython import const

import on_demand
from panel import texts, wording
from panel.menu import BACK, PAGE
from panel.pages import Page
from uss.timing import elapsed

_LOOKUP = ("catalogue", "panel.lookup", "panel.lookup.words")
_OF_A_SET = ("panel.pages.parameter_words", "panel.sets.pump", "panel.sets.work")
_COMMISSION = _LOOKUP + ("panel.commission", "panel.commission.words")
_DIAGNOSIS = ("panel.menu.diagnosis", "panel.menu.diagnosis.words")

# What a list wants besides, a step of the loop for each: from the bottom of the house up.
_WANTS = {
    "address": ("uss.finding", "uss.finding.mirror"),
    "commission.course": _COMMISSION
    + (
        "panel.lookup.value",
        "panel.pages.parameter_words",
        "panel.writer",
        "panel.commission.step",
    ),
    "commission.overview": _COMMISSION,
    "sets.overview": (
        "panel.menu.sets",
        "panel.menu.sets.words",
        "panel.sets",
        "panel.sets.set_file",
    ),  # fmt: skip
    "sets.save": ("catalogue", "version") + _OF_A_SET + ("panel.sets.saving",),
    "sets.write": _OF_A_SET + ("panel.sets.writing",),
    "diagnosis.counters": _DIAGNOSIS,
    "diagnosis.health": _DIAGNOSIS,
    "diagnosis.mirror": ("uss.finding", "uss.finding.mirror") + _DIAGNOSIS,
    "diagnosis.off": _DIAGNOSIS,
    "diagnosis.overview": _DIAGNOSIS,
    "diagnosis.telegrams": ("uss.finding", "uss.finding.witness") + _DIAGNOSIS,
    "diagnosis.times": ("uss.finding", "uss.finding.witness") + _DIAGNOSIS,
    "events": _LOOKUP,
    "kind": ("uss.families.bop", "uss.families.kinds"),
    "lookup.groups": _LOOKUP,
    "lookup.memory": _LOOKUP,
    "lookup.what": _LOOKUP,
    "turns": ("uss.families.kinds", "settings_file"),
    "value": ("uss.families.kinds", "settings_file"),
}
_BESIDE = ("lookup.", "commission.")  # lists that look into the catalogue
_REFUSED = ("START", "REVERSE", "JOG_RIGHT", "JOG_LEFT")  # they move a motor
_STALE_MS = const(60_000)
_TOLD_MS = const(3_000)
_COUNT_COLUMN = const(11)  # "12/31"


class Menu(Page):
    """The page that covers all others while the menu is open. begin: the first list."""

    modules = ("panel.menu.engine", "panel.menu.words")
    whole = True
    obeys = False
    locks = False  # a closed lock opens nothing of it but the page for its code

    def __init__(self, panel, begin=("main", None)):
        Page.__init__(self, panel)
        self._coming = None  # (name, argument) of a list that is not there yet
        self._page = None  # the place of the page that is to come when the menu closes
        self._lists = []  # (name of the module, `List`, position in it), the one shown last
        self._used_at_ms = None
        self._told = None  # words in place of the entry, for a while or until a key is pressed
        self._told_at_ms = 0
        self._alarmed = panel.selected.needs_attention()
        self._keep = ()  # modules that stay when it closes
        self._enter(*begin)
        self._wanted.insert(0, "panel.menu.words")

    def take_keys(self, acts, now_ms):
        if acts.pressed:
            self._told = None
        if acts.has("STOP") and self._lists:
            self._stop(now_ms)
        if self._coming or self._page is not None or not (acts.pressed or acts.repeated):
            return
        self._used_at_ms = now_ms
        name, shown, position = self._lists[-1]
        taken = shown.take_keys(acts)
        if taken:
            if taken is BACK:
                self._leave(now_ms)
            return
        direction = acts.direction("DOWN", "UP") or acts.direction("NEXT", "PREVIOUS")
        turned = acts.direction("ADDRESS_UP", "ADDRESS_DOWN")
        if acts.has("PARAM"):
            self._leave(now_ms)
        elif turned and name == "address":
            self._lists[-1] = (name, shown, (position + turned) % shown.count())
        elif acts.has("SET"):
            self._go(shown.choose(min(position, shown.count() - 1), now_ms), now_ms)
        elif direction and not shown.change(position, -direction * acts.pace(100)):
            self._lists[-1] = (name, shown, (position + direction) % shown.count())
        elif any([acts.has(key) for key in _REFUSED]):
            self._say(now_ms, "IN_THE_MENU")

    def is_ready(self):
        return len(self._lists) > 0

    @property
    def is_busy(self):
        is_searching = bool(self._lists) and self._lists[-1][1].is_searching()
        return is_searching or self._coming is not None or self._page is not None

    def work(self, now_ms):
        """What takes long has a turn of its own: a module that comes, a piece of a search."""
        if self._page is not None:
            if len(self._lists) > 1:  # the one that is shown goes with the page that comes
                self._drop_list(0)
            elif self.panel.has_time():
                self.panel.show_page(now_ms, self._page)
        elif not self._coming:
            self._lists[-1][1].search()
        elif self.panel.has_time():
            self._come(now_ms)

    def step(self, keys, now_ms):
        if self._coming:
            return
        if self._told and elapsed(now_ms, self._told_at_ms, self.panel.mask) >= _TOLD_MS:
            self._told = None
        _, shown, position = self._lists[-1]
        shown.step(position, now_ms)
        if not self._lists:  # that has closed the menu
            return
        if self._used_at_ms is None or shown.is_busy():
            self._used_at_ms = now_ms
        stale = elapsed(now_ms, self._used_at_ms, self.panel.mask) >= _STALE_MS
        # An alarm is not to be hidden; but one that nobody can end may need the menu.
        alarmed, self._alarmed = self._alarmed, self.panel.selected.needs_attention()
        if stale or self._alarmed and not alarmed:
            self.close()

    def close(self, keep=()):
        """Close the whole menu. keep: modules of it that stay, for the page that comes."""
        self._keep = keep
        if self._coming:
            self._forget(self._coming[0])
            self._coming = None
        needed = []
        while self._lists:
            name, shown, _ = self._lists.pop()
            shown.end()
            needed += shown.ahead + (_module(name),) + _WANTS.get(name, ())
        self._drop(needed)
        self.panel.uncover()

    def draw(self, screen, now_ms):
        if not self._lists:
            return  # the first one is yet to come, or all have closed in the middle of a picture
        _, shown, position = self._lists[-1]
        count = shown.count()
        position = min(position, count - 1)  # what was last in it may have gone
        if self._alarmed and self.panel.announcer.page_turns & 1:
            # That of the drive shown, in turn with the title: only the others are announced.
            screen.put(0, 0, texts.ROW_WIDTH, wording.alarm(self.panel.selected))
        else:
            width = _COUNT_COLUMN if count > 1 else texts.ROW_WIDTH
            screen.put(0, 0, width, shown.heading(position))
            if count > 1:
                place = b"%5s" % (b"%d/%d" % (position + 1, count))
                screen.put(0, width, texts.ROW_WIDTH - width, place)

    def draw_row_2(self, screen, now_ms):
        if not self._lists:
            return
        _, shown, position = self._lists[-1]
        position = min(position, shown.count() - 1)
        screen.put(1, 0, 1, texts.of(texts.MENU_MARK))
        screen.put(1, 1, texts.ROW_WIDTH - 1, self._told or shown.words(position))

    def _stop(self, now_ms):
        """STOP has stopped the drive shown, and row 2 may name another one: that stops as well,
        since the operator looks at it. The display says which drives that are.
        """
        _, shown, position = self._lists[-1]
        panel = self.panel
        address = panel.selected.drive.address
        named = shown.control_at(min(position, shown.count() - 1))
        if named in panel.controls and named is not panel.selected:
            named.stop_unseen()
            self._say(now_ms, "STOPPED_TWO", address, named.drive.address)
        elif shown.tells_stop:
            self._say(now_ms, "STOPPED", address)

    def _say(self, now_ms, name, *values):
        """A text of `words`, which came with a step of its own, in place of the entry. Behind the
        mark of the menu: what the list does meanwhile goes on.
        """
        self._told = texts.of(getattr(on_demand.load("panel.menu.words"), name), *values)
        self._told_at_ms = now_ms

    def _go(self, following, now_ms):
        """Where a list leads to, unless it has closed the menu."""
        if following is None or not self._lists:
            return
        if following is BACK:
            self._leave(now_ms)
        elif following[0] is PAGE:
            self._page = following[1]
        else:
            self._enter(*following)

    def _enter(self, name, argument):
        """That list comes with the steps that follow: each loads one module."""
        self._coming = (name, argument)
        self._wanted = list(_WANTS.get(name, ())) + [_module(name)]

    def _come(self, now_ms):
        name, argument = self._coming
        try:
            if self._wanted:
                module = on_demand.load(self._wanted.pop(0))
                self._wanted[:0] = getattr(module, "LOADS", ())
                return
            shown = on_demand.load(_module(name)).List(self.panel, argument)
            self._lists.append((name, shown, shown.first()))
        except MemoryError:
            self.panel.say(now_ms, texts.NO_MEMORY)
            self._forget(name)
        self._coming = None
        if not self._lists:
            self.panel.uncover()

    def _drop_list(self, place):
        name, shown, _ = self._lists.pop(place)
        shown.end()
        self._drop(shown.ahead)
        self._forget(name)

    def _forget(self, name):
        """What a list has needed leaves the memory."""
        needed = [module for one in self._lists for module in _WANTS.get(one[0], ())]
        self._drop((_module(name),) + _WANTS.get(name, ()), needed)

    def _drop(self, modules, needed=()):
        if modules is self._keep:
            return
        keep = self._keep
        if needed or keep:
            modules = [name for name in modules if name not in needed and name not in keep]
        on_demand.drop(*modules)

    def _leave(self, now_ms):
        """Back to the list above this one."""
        self._lists[-1][1].leave(now_ms)
        if not self._lists:  # that has closed the menu
            return
        self._drop_list(-1)
        if not self._lists:
            self.panel.uncover()


def _module(name):
    """Where a list stands: below this folder, or beside it, with what it looks up."""
    return ("panel." if name.startswith(_BESIDE) else "panel.menu.") + name
