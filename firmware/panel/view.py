# SPDX-License-Identifier: MIT
"""What is on the display: the page, and what must be said whatever the page is.

    row 1   an announcement where row 2 has no place for it; an alarm of the drive shown; else its
            frequencies
    row 2   the first of these: what a held STOP does; a message or another master, unless the
            drive shown is an alarm; an announcement; STOP UNCONFIRMED or MAY RUN; the page

A page that is whole has both rows. Announcements take the place of its first, a message and what a
held STOP does that of its second.

Row 1 has 5 places for the setpoint and 6 for the actual frequency. A value that needs more room
gives up decimals (-650.00 is shown as -650.0); without contact the actual frequency is dashes,
never the last one known.

The view decides nothing. Between two pictures the panel finds out when it is time for an
announcement, and how long a fault has been on the display.
"""

from micropython import const

from panel import texts
from panel.announcer import NOTHING

_ADDRESS_COLUMN = const(13)

# The fields of a picture, in the order in which they are drawn. ROW_2 is that row up to the
# address, unless ANNOUNCEMENT is drawn in its place; a page that is whole has WHOLE alone, and
# BELOW where it draws row 2 by itself.
SETPOINT, ACTUAL, ROW_2, ADDRESS, DONE, ANNOUNCEMENT, WHOLE, BELOW = range(8)


class View:
    """panel: the `Panel` that is shown on `screen`, a field in a step: drawing takes its time.
    keys: its `Keys`.

    view.begin(page)        # a new picture
    view.step(now_ms)       # again and again
    """

    def __init__(self, panel, screen, keys):
        self._panel = panel
        self._screen = screen
        self._keys = keys
        self._page = None
        self._next = DONE  # the field that is drawn next

    def begin(self, page):
        """A new picture, of this page; None: the rest of the present one is left undrawn."""
        self._page = page
        self._next = DONE if page is None else WHOLE if page.whole else SETPOINT

    def is_done(self):
        """Whether nothing of it is left to be drawn."""
        return self._next == DONE

    def step(self, now_ms):
        """Draw the next field of it, if there is one left."""
        field = self._next
        if field != DONE:
            self._next = self._draw(field, now_ms)
            if self._keys.shift and (field == SETPOINT or field == WHOLE):
                self._screen.mark(self._keys.shift)

    def tells_state(self, page):
        """Whether a picture of this page begun now tells what the drive shown does."""
        return page.tells_state and self._text() is None

    def _draw(self, field, now_ms):
        """Draw a field; answers the one that is drawn next."""
        screen, panel = self._screen, self._panel
        if field == SETPOINT:
            if self._draw_alarm(panel.selected):
                return ROW_2
            _draw_setpoint(screen, panel.selected)
        elif field == ACTUAL:
            values = self._page.values
            if values is None or not values.draw(screen):
                _draw_actual(screen, panel.selected)
        elif field == ROW_2:
            return self._draw_row_2(panel.selected, now_ms)
        elif field == ADDRESS:
            _draw_address(screen, panel.selected)
        elif field == WHOLE:
            self._page.draw(screen, now_ms)
            if panel.announcer.kind != NOTHING:
                panel.announcer.draw(screen, 0)
            if self._page.draw_row_2 is not None:
                return BELOW
            self._draw_text()
            return DONE
        elif field == BELOW:
            if not self._draw_text():
                self._page.draw_row_2(screen, now_ms)
            return DONE
        else:
            panel.announcer.draw(screen, 1)
            return DONE
        return field + 1

    def _draw_text(self):
        """What takes all of row 2 of a page that is whole; False when nothing does."""
        text = self._text()
        if text is None:
            return False
        self._screen.put(1, 0, texts.ROW_WIDTH, text)
        return True

    def _draw_alarm(self, control):
        """What takes all of row 1 in place of the frequencies; False when nothing does."""
        announcer = self._panel.announcer
        announces = announcer.kind != NOTHING
        if announces and self._text() is not None:
            announcer.draw(self._screen, 0)
        elif control.stop_watch.unconfirmed and (announces or self._text() is not None):
            self._screen.put(0, 0, texts.ROW_WIDTH, texts.of(texts.STOP_UNCONFIRMED))
        elif control.lost_running:
            self._screen.put(0, 0, texts.ROW_WIDTH, texts.of(texts.NO_CONTACT_ROW))
        else:
            return False
        return True

    def _draw_row_2(self, control, now_ms):
        """What must be said, else what the page says; answers the field that is drawn next."""
        text = self._text()
        if text is None:
            if self._panel.announcer.kind != NOTHING:
                return ANNOUNCEMENT
            if control.stop_watch.unconfirmed:
                text = texts.of(texts.STOP_UNCONFIRMED)
        if text is not None:
            self._screen.put(1, 0, texts.ROW_WIDTH, text)
            return DONE  # no room for an address
        if control.lost_running:
            self._screen.put(1, 0, _ADDRESS_COLUMN, texts.of(texts.MAY_RUN))
        else:
            self._page.draw(self._screen, now_ms)
        return ADDRESS

    def _text(self):
        """The text that takes all of row 2 whatever is announced; None when there is none."""
        panel = self._panel
        if panel.stop_key.text:
            return texts.of(panel.stop_key.text)
        if panel.selected.needs_attention():
            return None
        if panel.message:
            return panel.message
        return texts.of(texts.LINE_IN_USE) if panel.line_in_use() else None


def _draw_address(screen, control):
    """A and the address of a drive, left-aligned at the end of row 2."""
    address = control.drive.address
    screen.put(1, _ADDRESS_COLUMN, 3, texts.of(texts.ADDRESS))
    screen.number(1, _ADDRESS_COLUMN + 1, 1 if address < 10 else 2, address * 100, 0)


def _draw_setpoint(screen, control):
    setpoint = control.setpoint.centihertz
    screen.put(0, 0, 2, texts.of(texts.SETPOINT))
    screen.number(0, 2, 5, -setpoint if control.reversed else setpoint, 1)
    if control.reversed and not setpoint:
        screen.put(0, 3, 1, b"-")  # the direction is to be seen before it turns


def _draw_actual(screen, control):
    percent = control.survey.is_percent()
    screen.put(0, 7, 3, texts.of(texts.ACTUAL_PERCENT if percent else texts.ACTUAL))
    actual = control.actual_centihertz()
    if actual is None:
        screen.put(0, 10, 6, texts.of(texts.UNKNOWN_VALUE))
    elif control.actual_is_beyond():
        screen.put(0, 10, 6, texts.of(texts.BEYOND_VALUE))
    else:
        screen.number(0, 10, 6, actual, 2)
