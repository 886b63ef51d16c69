# SPDX-License-Identifier: MIT
"""The drives that are not shown: the panel looks at each again and again, one in a turn.

Such a drive has nothing to say and nothing to ask: START has to be pressed anew, with that drive
in sight. The announcer hears what there is to announce of it.
"""

from micropython import const

_REREAD_US = const(2_000_000)  # a setting of such a drive is read again so often
_LONG_US = const(1_500)  # a step that has taken so long is not to do more


class Neighbours:
    """controls: of all drives. announcer: the `Announcer`. panel: the `Panel`, which heeds what a
    drive has told, and knows how long the step has taken.
    """

    def __init__(self, controls, announcer, panel):
        self._controls = controls
        self._announcer = announcer
        self._panel = panel
        self._shown = 0  # place of the one that is shown
        self._place = 0  # of the one that was looked at last
        self._control = None  # it was asked, and is still to be watched,
        self._is_watched = False  # or was, and is still to be announced
        self._at_rest = 0  # so many of them in a row were found at rest

    def show(self, place):
        """Another one is shown. The one before is looked at next, and all are counted anew."""
        self._place = self._shown - 1
        self._shown = place
        self._control = None
        self._is_watched = False
        self._at_rest = 0

    def are_at_rest(self):
        """Whether none of them runs, is told to, or may run out of contact, as far as is known."""
        return self._at_rest + 1 >= len(self._controls)

    def step(self, now_us):
        control = self._control
        if control is not None:
            self._watch(control, now_us)
            return
        control = self._next()
        if control.ask(now_us, _REREAD_US):
            self._panel.heed(control)
            self._place -= 1  # it has told something: in its next turn it is asked for more
        elif not self._panel.has_taken(_LONG_US) and control.is_quiet():
            if not control.drive.contact:  # of the others nothing new can be said
                self._announcer.look(self._place)
            self._at_rest += 1
        else:
            self._control = control  # that was enough for a step

    def _watch(self, control, now_us):
        if not self._is_watched:
            control.watch(now_us)
            control.keep_quiet()
            self._at_rest = 0 if control.is_active() else self._at_rest + 1
            if self._panel.has_taken(_LONG_US):
                self._is_watched = True
                return
        self._is_watched = False
        self._control = None
        self._announcer.look(self._place)

    def _next(self):
        count = len(self._controls)
        self._place = (self._place + 1) % count
        if self._place == self._shown:
            self._place = (self._place + 1) % count
        return self._controls[self._place]
