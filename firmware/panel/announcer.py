# SPDX-License-Identifier: MIT
"""The drive that needs most to be spoken of, besides what the page tells, and the row about it.

Of 31 drives none is asked in the moment of drawing, which would take a loop's time several times
over: the panel hands over one after the other, and what was found out is kept until that drive is
looked at again.

    announcer = Announcer(screen)
    announcer.look(control, True, page.tells_state)     # a drive at a time
    if announcer.rank >= RUNS: announcer.draw(1)
"""

from panel import texts

# How much a drive needs to be spoken of, and what is said behind its address.
SILENT_ABOUT, RUNS, NOTED, TRIPPED, LOST, UNCONFIRMED = range(6)
ANNOUNCEMENTS = (
    b"",
    texts.OTHER_RUNS,
    b"",  # and its notice
    texts.OTHER_TRIPPED,
    texts.OTHER_LOST,
    texts.OTHER_UNCONFIRMED,
)


class Announcer:
    """screen: a `Screen`. `control`: the drive, None until one needs it. `rank`: how much."""

    def __init__(self, screen):
        self.control = None
        self.rank = SILENT_ABOUT
        self._screen = screen

    def look(self, control, selected, told):
        """selected: it is the drive shown. told: the page says what the drive shown does."""
        rank = SILENT_ABOUT if selected and told else _rank(control, selected)
        if control is self.control:
            self.rank = rank
        elif rank > self.rank:
            self.control = control
            self.rank = rank

    def draw(self, row):
        """Speak of it in all of `row`."""
        screen, control, rank = self._screen, self.control, self.rank
        address, text = control.drive.address, ANNOUNCEMENTS[rank]
        column = 2 if address < 10 else 3
        screen.put(row, 0, texts.ROW_WIDTH, b"A")
        screen.number(row, 1, column - 1, address * 100, 0)
        screen.put(row, column, texts.ROW_WIDTH - column, text)
        if rank == NOTED:
            screen.put(row, column + 1, texts.ROW_WIDTH - column - 1, control.notice)
        elif rank == TRIPPED:
            draw_fault(screen, row, column + len(text) + 1, control.fault)


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
