# SPDX-License-Identifier: MIT
"""What has to be said of the drives besides what the page tells: one trouble after the other.

To ask 31 drives while a picture is drawn would take a loop's time several times over. So the panel
hands over one drive after the other, and the announcer keeps what it found out until it looks at
that drive again. KINDS is the order: the most dangerous kind first, and of each kind the drives in
the order of the list. Between two announcements the page has its turn.

    announcer = Announcer(controls, mask)
    announcer.look(position)            # a drive at a time, by its place in the list
    announcer.begin(position, page, told, now_ms)   # before each picture
    if announcer.kind != NOTHING: announcer.draw(screen, 1)
"""

from micropython import const

from panel import texts, wording
from panel.reports.fault import draw_number
from panel.phases import ASKING
from uss import pzd
from uss.timing import elapsed

_SAID_MS = const(1_300)  # a second for whoever reads it, and what the picture takes
_PAGE_MS = const(600)  # and so long the page: with n drives each has been said within 2 n s
_ROUND_MS = const(6_000)  # all of them may take so long where none is an alarm
_TURN_MS = const(1_500)  # a page that has several things to say goes on to the next
_LATE_MS = const(500)  # who comes later than this begins to count anew

# What there may be to say of a drive: the most dangerous of its troubles.
NOTHING, UNHEARD, NOTED, TRIPPED, RUNS, REMARKED, LOST, UNCONFIRMED = range(8)
_ALARMS = (TRIPPED, LOST, UNCONFIRMED)

KINDS = (  # said of one drive, behind its address; of several; of more than so many together
    (texts.NOTHING, texts.NOTHING, 0),
    (texts.OTHER_UNHEARD, texts.SEVERAL_UNHEARD, 1),
    (texts.NOTHING, texts.SEVERAL_NOTED, 4),  # and its notice
    (texts.OTHER_TRIPPED, texts.SEVERAL_TRIPPED, 4),
    (texts.OTHER_RUNS, texts.SEVERAL_RUN, 4),
    (texts.NOTHING, texts.SEVERAL_REMARKED, 4),  # runs, and what somebody has changed since
    (texts.OTHER_LOST, texts.SEVERAL_LOST, 4),
    (texts.OTHER_UNCONFIRMED, texts.SEVERAL_UNCONFIRMED, 4),
)


class Announcer:
    """controls: of all drives. mask: the clock's period - 1.

    kind: what is said now; NOTHING while it is the page's turn. control: of which drive; None: of
    all those of that kind together. page_turns: how often a page that says one thing after the
    other has gone on since it came. Nobody else writes a field of it.
    """

    def __init__(self, controls, mask):
        self.kind = NOTHING
        self.control = None
        self.page_turns = 0
        self._controls = controls
        self._mask = mask
        self._kinds = bytearray(len(controls))  # what there is to say of each
        self._counts = bytearray(len(KINDS))  # and of how many drives of each kind
        self._counts[NOTHING] = len(controls)
        self._page_ms = _PAGE_MS
        self._last = UNHEARD  # the kind that was said last
        # The place of the drive it was said of. How many there are: of all of that kind together.
        # One more: of the one shown, after that.
        self._position = len(controls)
        self._before = -1  # of which before all
        self._since_ms = 0  # when what is said now, or the page, had its turn
        self._late_ms = 0  # so much longer than its time the page had, which the next one lacks
        self._turned_ms = 0  # when the page went on
        self._page = None  # that is shown,
        self._shown = 0  # and the place of its drive
        self._told = False  # what that drive does
        self._favoured = False  # a page that was new has had a turn of its own
        self._fault = None  # that the present picture tells of,
        self._begun_ms = 0  # since then

    def begin(self, position, page, told, now_ms):
        """A new picture: what it says besides its page, and what the one before has said.

        position: of the drive that is shown. told: row 2 of the page tells what that drive does.
        """
        if self._fault is not None:
            self._fault.show((now_ms - self._begun_ms) & self._mask)
        self._begun_ms = now_ms
        self._told = told
        if page is not self._page or position != self._shown:
            before = self._shown
            self._page = page
            self._shown = position
            self.look(before)
            self._page_ms = min(self._page_ms, self._find_page_ms())
            self._favour(now_ms)
        self._step(now_ms)
        if self.kind == NOTHING:
            self._fault = self._controls[position].fault if told else None
        else:
            self._fault = self.control.fault if self.kind == TRIPPED and self.control else None

    def look(self, position):
        """Find out what there is to say of a drive."""
        control = self._controls[position]
        shown = position == self._shown
        if shown and self._told and control.drive.contacts:
            kind = NOTHING  # as it mostly is, without a call: its page tells all
        else:
            seen = shown and self._page is not None and not self._page.whole
            kind = _kind(control, seen, shown and self._told)
        before = self._kinds[position]
        if kind != before:
            self._kinds[position] = kind
            self._counts[before] -= 1
            self._counts[kind] += 1
            # A longer page begins behind the next announcement: nobody waits longer for this one.
            self._page_ms = min(self._page_ms, self._find_page_ms())

    def make_room(self):
        """Another drive stands at the end of the list: nothing is to be said of it yet."""
        self._kinds.append(NOTHING)
        self._counts[NOTHING] += 1
        self._begin_anew()

    def close_up(self, position):
        """The drive at this place is not in the list any more."""
        self._counts[self._kinds[position]] -= 1
        self._kinds = self._kinds[:position] + self._kinds[position + 1 :]
        self._begin_anew()

    def _begin_anew(self):
        """Places of the list have another meaning."""
        self.kind = NOTHING
        self.control = self._fault = self._page = None
        self._position = len(self._kinds)
        self._before = -1
        self._shown = 0
        self._page_ms = self._find_page_ms()

    def has_alarm(self):
        """Whether there is something dangerous to be said."""
        counts = self._counts
        return counts[TRIPPED] + counts[LOST] + counts[UNCONFIRMED] > 0

    def draw(self, screen, row):
        """Write into all of `row` what is said now."""
        kind, control = self.kind, self.control
        one, several, _ = KINDS[kind]
        words = texts.of(texts.ADDRESS if control else several)
        screen.put(row, 0, texts.ROW_WIDTH, words)
        if control is None:
            column = len(words) + 1
            count = self._counts[kind]
            screen.number(row, column, 1 if count < 10 else 2, count * 100, 0)
            return
        address = control.drive.address
        column = 2 if address < 10 else 3
        screen.number(row, 1, column - 1, address * 100, 0)
        if kind == NOTED or kind == REMARKED:
            text = control.notice if kind == NOTED else wording.remark(control)
            words = wording.of(text, control.survey.family)
            screen.put(row, column + 1, texts.ROW_WIDTH - column - 1, words)
            return
        words = texts.of(one)
        screen.put(row, column, texts.ROW_WIDTH - column, words)
        if kind == TRIPPED:
            draw_number(screen, row, column + len(words) + 1, texts.FAULT_LETTER, control.fault)

    def _favour(self, now_ms):
        """A page that is new has a short turn at once, but keys that are pressed again and again
        put nothing off."""
        self.page_turns = 0
        self._turned_ms = now_ms
        if self.kind == NOTHING and not self._favoured:
            self._favoured = True
            spared_ms = self._page_ms - _PAGE_MS
            if (now_ms - self._since_ms) & self._mask > spared_ms:
                self._since_ms = (now_ms - spared_ms) & self._mask

    def _step(self, now_ms):
        """Go on to the next announcement, or to the page, when it is time to."""
        # The difference as it is: after half a period of the clock `elapsed` would be 0.
        spent_ms = (now_ms - self._since_ms) & self._mask
        if self.kind != NOTHING:
            if spent_ms >= _SAID_MS or not self._holds():
                if self.control is None and spent_ms < _SAID_MS:
                    self._position = self._before  # too few to be said together: each by itself
                self.kind = NOTHING
                self._since_ms = self._due_since(now_ms, spent_ms - _SAID_MS + self._late_ms)
                self._turned_ms = now_ms
                self.page_turns += 1
            return
        if self._counts[NOTHING] < len(self._kinds):
            if spent_ms >= self._page_ms:
                self._go_on()
                if self.kind != NOTHING:
                    self._late_ms = spent_ms - self._page_ms
                    self._since_ms = now_ms
        else:
            self._favoured = False
        turned_ms = elapsed(now_ms, self._turned_ms, self._mask)
        if turned_ms >= _TURN_MS:
            self._turned_ms = self._due_since(now_ms, turned_ms - _TURN_MS)
            self.page_turns += 1

    def _due_since(self, now_ms, late_ms):
        """When a turn of the page began that came so late: a slow loop is late each time, which
        must not add up. What is said has its full time: the picture is late as well."""
        return (now_ms - late_ms) & self._mask if 0 <= late_ms < _LATE_MS else now_ms

    def _holds(self):
        """Whether what is said now is still true."""
        if self._position > len(self._kinds):
            self.look(self._shown)
            return self._controls[self._shown] is self.control and self._is_own(self.kind)
        if self.control is not None:
            self.look(self._position)  # it may have been a while ago
            if self._kinds[self._position] != self.kind:
                return False
        return self._is_shared(self.kind) == (self.control is None)

    def _is_shared(self, kind):
        return self._counts[kind] > KINDS[kind][2]

    def _is_own(self, kind):
        """Whether the drive shown is among those: after a text that tells how many, it is said by
        itself, for START and STOP are about that one.
        """
        return self._kinds[self._shown] == kind != UNHEARD

    def _go_on(self):
        """To the next one in the order of KINDS and of the list."""
        kind, position, count = self._last, self._position, len(self._kinds)
        while True:
            if not self._counts[kind]:
                position = -1
            elif not self._is_shared(kind):
                position = self._find(kind, position + 1)
            elif position < count:  # also where it was one by one so far
                self._before = position
                position = count
            elif position == count and self._is_own(kind):
                position = count + 1
            else:
                position = -1
            if position >= 0:
                break
            kind = kind - 1 if kind > UNHEARD else UNCONFIRMED
        self.kind = self._last = kind
        self._position = position
        self._favoured = False
        place = self._shown if position > count else position
        self.control = None if position == count else self._controls[place]
        self._page_ms = self._find_page_ms()
        if not self._holds():
            self.kind = NOTHING  # it was over before it was said: the next one, next time

    def _find(self, kind, position):
        """The first place from this one on of a drive with something of this kind; -1: none."""
        kinds = self._kinds
        while position < len(kinds):
            if kinds[position] == kind:
                return position
            position += 1
        return -1

    def _find_page_ms(self):
        """How long the page has between two announcements."""
        counts = self._counts
        for kind in _ALARMS:
            if counts[kind]:
                return _PAGE_MS
        said = 0
        for kind in range(UNHEARD, len(KINDS)):
            if self._is_shared(kind):
                said += 2 if self._is_own(kind) else 1
            else:
                said += counts[kind]
        drives = len(self._kinds) - counts[NOTHING]
        round_ms = min((_SAID_MS + _PAGE_MS) * drives, _ROUND_MS)
        return max(round_ms // max(said, 1) - _SAID_MS, _PAGE_MS)


def _kind(control, seen, told):
    """What there is to say of a drive besides what the page tells: one of KINDS."""
    if not control.drive.contacts and control.is_unheard():
        return NOTHING if control.absence_known else UNHEARD
    if not seen:
        if control.stop_watch.unconfirmed:
            return UNCONFIRMED
        if control.lost_running:
            return LOST
        if control.drive.zsw & pzd.ZSW_RUNNING and control.runs():
            return REMARKED if control.remark else RUNS
    elif control.needs_attention():
        return NOTHING  # which outranks the rest
    elif not told and control.drive.is_on() and control.runs() and wording.remark(control):
        return REMARKED
    if not told:
        if control.fault.active:
            return TRIPPED
        if control.notice and control.phase != ASKING:  # which says why
            return NOTED
    return NOTHING
