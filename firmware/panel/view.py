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

ADDRESS_COLUMN = const(13)
ANNOUNCE_MS = const(1_500)  # another drive is announced so long, then the page is as long


# How much another drive needs to be spoken of, and what is said.
SILENT_ABOUT, RUNS, NOTED, TRIPPED, LOST, UNCONFIRMED = range(6)
ANNOUNCEMENTS = (
    b"",
    texts.OTHER_RUNS,
    b"",  # and its notice
    texts.OTHER_TRIPPED,
    texts.OTHER_LOST,
    texts.OTHER_UNCONFIRMED,
)


# The fields of a picture, in the order in which they are drawn.
SETPOINT, ACTUAL, ROW_2, PAGE, ADDRESS, DONE = range(6)


class View:
    """panel: the `Panel` that is shown on `screen`, a field in a step: drawing takes its time.

    view.begin(page)        # a new picture
    view.step(now_ms)       # each step of the loop
    """

    def __init__(self, panel, screen):
        self._panel = panel
        self._screen = screen
        self._page = None
        self._next = DONE  # the field that is drawn next
        self._announced = None  # the drive that needs most to be spoken of, and how much
        self._highest = SILENT_ABOUT

    def begin(self, page):
        """A new picture, of this page."""
        self._page = page
        self._next = SETPOINT

    def is_done(self):
        """Whether all of it is drawn."""
        return self._next == DONE

    def step(self, now_ms):
        """Draw the next field of it, if there is one left."""
        if self._next == DONE:
            return
        if self._page.whole:
            self._draw_whole(now_ms)
            self._next = DONE
        else:
            self._next = self._draw(self._next, now_ms)

    def _draw_whole(self, now_ms):
        self._page.draw(self._screen, now_ms)
        if not now_ms // ANNOUNCE_MS & 1:
            self._announce(0, LOST)  # an alarm is not hidden by a question

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
        else:
            _draw_address(screen, control)
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
            self._screen.put(1, 0, ADDRESS_COLUMN, texts.MAY_RUN)
            return ADDRESS
        if not now_ms // ANNOUNCE_MS & 1 and self._announce(1, RUNS):
            return DONE
        return PAGE

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

    def _announce(self, row, least):
        """Speak in `row` of the drive that needs it most, at least so much, and is not told of by
        the page; False when none does.
        """
        self._announced, self._highest = None, least - 1
        for control in self._panel.controls:
            self._consider(control)
        if self._announced is None:
            return False
        self._draw_announcement(row)
        return True

    def _consider(self, control):
        selected = control is self._panel.selected
        if selected and self._page.tells_state:
            return
        rank = _rank(control, selected)
        if rank > self._highest:
            self._highest, self._announced = rank, control

    def _draw_announcement(self, row):
        screen, announced = self._screen, self._announced
        address, text = announced.drive.address, ANNOUNCEMENTS[self._highest]
        column = 2 if address < 10 else 3
        screen.put(row, 0, texts.ROW_WIDTH, b"A")
        screen.number(row, 1, column - 1, address * 100, 0)
        screen.put(row, column, texts.ROW_WIDTH - column, text)
        if self._highest == NOTED:
            screen.put(row, column + 1, texts.ROW_WIDTH - column - 1, announced.notice)
        elif self._highest == TRIPPED:
            draw_fault(screen, row, column + len(text) + 1, announced.fault)


def _rank(control, selected):
    """How much a drive needs to be spoken of: SILENT_ABOUT ... UNCONFIRMED."""
    if control.stop_watch.unconfirmed:
        return UNCONFIRMED
    if control.lost_running:
        return LOST
    if control.fault.active and (selected or control.notice is not None):
        return TRIPPED  # a drive that was on, or one that is worked on
    if control.runs():
        return SILENT_ABOUT if selected else RUNS
    return NOTED if selected and control.notice is not None else SILENT_ABOUT


def draw_fault(screen, row, column, fault):
    """F and the number of a fault, once it is known: it has been seen now."""
    fault.seen = True
    if fault.number:
        screen.put(row, column, 1, texts.FAULT_LETTER)
        screen.digits(row, column + 1, 4, fault.number)


def _draw_address(screen, control):
    """A and the address of a drive, left-aligned at the end of row 2."""
    address = control.drive.address
    screen.put(1, ADDRESS_COLUMN, 3, b"A")
    screen.number(1, ADDRESS_COLUMN + 1, 1 if address < 10 else 2, address * 100, 0)


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
