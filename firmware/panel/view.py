# SPDX-License-Identifier: MIT
"""What is on the display: the page, and what must be said whatever the page is.

    row 1   frequencies of the drive shown, or NO CONTACT, when it ran and was lost
    row 2   the first of these: what a held STOP does, a STOP that is not obeyed, MAY RUN, a
            message, another master, another drive that runs (in turn with the page), the page

Row 1 has 5 places for the setpoint and 6 for the actual frequency. A value that needs more room
gives up decimals (-650.00 is shown as -650.0); without contact the actual frequency is dashes,
never the last one known.
"""

from micropython import const

from panel import texts
from panel.announcer import LOST, RUNS, Announcer

_ADDRESS_COLUMN = const(13)
_ANNOUNCE_MS = const(1_500)  # another drive is announced so long, then the page is as long

# The fields of a picture, in the order in which they are drawn. The last one may take the place of
# PAGE and ADDRESS; a page that is WHOLE is the only one.
SETPOINT, ACTUAL, ROW_2, PAGE, ADDRESS, DONE, ANNOUNCEMENT, WHOLE = range(8)


class View:
    """panel: the `Panel` that is shown on `screen`, a field in a step: drawing takes its time.

    view.begin(page)        # a new picture
    view.step(now_ms)       # again and again
    view.look(control)      # a drive that may have to be announced, one at a time
    """

    def __init__(self, panel, screen):
        self._panel = panel
        self._screen = screen
        self._page = None
        self._next = DONE  # the field that is drawn next
        self._announcer = Announcer(screen)

    def begin(self, page):
        """A new picture, of this page."""
        self._page = page
        self._next = WHOLE if page.whole else SETPOINT

    def is_done(self):
        """Whether all of it is drawn."""
        return self._next == DONE

    def look(self, control):
        """Look whether a drive needs to be announced."""
        selected = control is self._panel.selected
        self._announcer.look(control, selected, self._page.tells_state)

    def step(self, now_ms):
        """Draw the next field of it, if there is one left."""
        field = self._next
        if field != DONE:
            self._next = self._draw(field, now_ms)

    def _draw(self, field, now_ms):
        """Draw a field; answers the one that is drawn next."""
        screen, control = self._screen, self._panel.selected
        if field == SETPOINT:
            if self._draw_alarm(control):
                return ROW_2
            _draw_setpoint(screen, control)
        elif field == ACTUAL:
            _draw_actual(screen, control)
        elif field == ROW_2:
            return self._draw_row_2(now_ms)
        elif field == PAGE:
            self._page.draw(screen, now_ms)
        elif field == ADDRESS:
            _draw_address(screen, control)
        elif field == WHOLE:
            self._page.draw(screen, now_ms)
            self._announce(0, LOST, now_ms)  # an alarm is not hidden by a question
            return DONE
        else:
            return DONE if self._announce(1, RUNS, now_ms) else PAGE
        return field + 1

    def _draw_alarm(self, control):
        """What takes all of row 1 in place of the frequencies; False when nothing does."""
        if control.stop_watch.unconfirmed and self._panel.stop_key.text:
            self._screen.put(0, 0, texts.ROW_WIDTH, texts.STOP_UNCONFIRMED)
        elif control.lost_running:
            self._screen.put(0, 0, texts.ROW_WIDTH, texts.NO_CONTACT_ROW)
        else:
            return False
        return True

    def _draw_row_2(self, now_ms):
        """What must be said before the page; answers the field that is drawn next."""
        text = self._why_no_page()
        if text is not None:
            self._screen.put(1, 0, texts.ROW_WIDTH, text)
            return DONE  # no room for an address
        if self._panel.selected.lost_running:
            self._screen.put(1, 0, _ADDRESS_COLUMN, texts.MAY_RUN)
            return ADDRESS
        return ANNOUNCEMENT if self._announcer.rank >= RUNS else PAGE

    def _why_no_page(self):
        """The text that takes all of row 2; None when there is none."""
        panel = self._panel
        if panel.stop_key.text:
            return panel.stop_key.text
        if panel.selected.stop_watch.unconfirmed:
            return texts.STOP_UNCONFIRMED
        if panel.selected.lost_running:
            return None
        if panel.message:
            return panel.message
        return texts.LINE_IN_USE if panel.line_in_use() else None

    def _announce(self, row, least, now_ms):
        """Speak in all of `row` of the drive that needs it most, if it is time to, and if it needs
        it at least so much; False otherwise.
        """
        announcer = self._announcer
        if now_ms // _ANNOUNCE_MS & 1 or announcer.rank < least:
            return False
        self.look(announcer.control)  # it may have been a while ago
        if announcer.rank < least:
            return False
        announcer.draw(row)
        return True


def _draw_address(screen, control):
    """A and the address of a drive, left-aligned at the end of row 2."""
    address = control.drive.address
    screen.put(1, _ADDRESS_COLUMN, 3, b"A")
    screen.number(1, _ADDRESS_COLUMN + 1, 1 if address < 10 else 2, address * 100, 0)


def _draw_setpoint(screen, control):
    setpoint = control.setpoint.centihertz
    screen.put(0, 0, 2, b"S:")
    screen.number(0, 2, 5, -setpoint if control.reversed else setpoint, 1)
    if control.reversed and not setpoint:
        screen.put(0, 3, 1, b"-")  # the direction is to be seen before it turns


def _draw_actual(screen, control):
    screen.put(0, 7, 3, b" F:")
    actual = control.actual_centihertz()
    if actual is None:
        screen.put(0, 10, 6, texts.UNKNOWN_VALUE)
    elif control.actual_is_beyond():
        screen.put(0, 10, 6, texts.BEYOND_VALUE)
    else:
        screen.number(0, 10, 6, actual, 2)
