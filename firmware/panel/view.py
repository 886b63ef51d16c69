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
SETPOINT, ACTUAL, ROW_2, ADDRESS, DONE = range(5)


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

    def begin(self, page):
        """A new picture, of this page."""
        self._page = page
        self._next = SETPOINT

    def step(self, now_ms):
        """Draw the next field of it; False when there is none left."""
        field = self._next
        if field == DONE:
            return False
        page, screen, control = self._page, self._screen, self._panel.selected
        self._next = field + 1
        if page.whole:
            self._next = DONE
            page.draw(screen, now_ms)
            if not now_ms // ANNOUNCE_MS & 1:
                self._announce(0, page, LOST)  # an alarm is not hidden by a question
        elif field == ADDRESS:
            _draw_address(screen, control)
        elif field == ROW_2:
            if not self._draw_row_2(page, now_ms):
                self._next = DONE  # no room for an address
        elif field == ACTUAL:
            _draw_actual(screen, control)
        elif not self._draw_alarm(control):
            _draw_setpoint(screen, control)
        else:
            self._next = ROW_2
        return True

    def _draw_alarm(self, control):
        """What takes all of row 1 in place of the frequencies; False when nothing does."""
        if control.stop_watch.unconfirmed and self._panel.stop_key.text:
            self._screen.put(0, 0, texts.ROW_WIDTH, texts.STOP_UNCONFIRMED)
        elif control.lost_running:
            self._screen.put(0, 0, texts.ROW_WIDTH, texts.NO_CONTACT_ROW)
        else:
            return False
        return True

    def _draw_row_2(self, page, now_ms):
        """Answers whether the address of the drive stands behind it."""
        screen, panel = self._screen, self._panel
        control, held = panel.selected, panel.stop_key.text
        alarm = texts.STOP_UNCONFIRMED if control.stop_watch.unconfirmed else None
        if held or alarm:
            screen.put(1, 0, texts.ROW_WIDTH, held or alarm)
        elif control.lost_running:
            screen.put(1, 0, ADDRESS_COLUMN, texts.MAY_RUN)
            return True
        elif panel.message or panel.line_in_use():
            screen.put(1, 0, texts.ROW_WIDTH, panel.message or texts.LINE_IN_USE)
        elif now_ms // ANNOUNCE_MS & 1 or not self._announce(1, page, RUNS):
            page.draw(screen, now_ms)
            return True
        return False

    def _announce(self, row, page, least):
        """Speak in `row` of the drive that needs it most, at least so much, and is not told of by
        the page; False when none does.
        """
        highest, announced = least - 1, None
        for control in self._panel.controls:
            if control is not self._panel.selected or not page.tells_state:
                rank = _rank(control, control is self._panel.selected)
                if rank > highest:
                    highest, announced = rank, control
        if announced is None:
            return False
        screen, address = self._screen, announced.drive.address
        text = ANNOUNCEMENTS[highest]
        column = 2 if address < 10 else 3
        screen.put(row, 0, texts.ROW_WIDTH, b"A")
        screen.number(row, 1, column - 1, address * 100, 0)
        screen.put(row, column, texts.ROW_WIDTH - column, text)
        if highest == NOTED:
            screen.put(row, column + 1, texts.ROW_WIDTH - column - 1, announced.notice)
        elif highest == TRIPPED:
            draw_fault(screen, row, column + len(text) + 1, announced.fault)
        return True


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
