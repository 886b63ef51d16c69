# SPDX-License-Identifier: MIT
"""From a drive into a file: all that the catalogue says of its family, and the drive tells.

The drive refuses a number or an index that it lacks; that is left out. One that it has and does
not tell is left out too, and counted: `untold`. Where its access level hides some, nothing is
saved. The file appears when it is whole.
"""

from micropython import const

import catalogue
from panel import texts
from panel.menu.sets import words
from panel.pages.parameter_words import failure
from panel.sets import pump, set_file
from panel.sets.work import Work, catalogue_of
from uss import pkw
from version import VERSION

SETS_MAX = const(20)
_PIECE = const(512)  # bytes that are written at once
_ABSENT = (pkw.NO_PARAMETER, pkw.NO_INDEX, 4)  # 4: no array
_HIDDEN = const(204)  # by the access level

# How many values a family has: what the time that is left is reckoned with. A test counts them.
COUNTS = {
    "mm440": 1100, "mm430": 978, "mm420": 276, "mm410": 164, "g110": 202, "v20": 1004,
    "g120": 196, "mm3": 53,
}  # fmt: skip


def why_not(panel, control):
    """A text, or NOTHING: what is against saving it."""
    family = control.survey.family
    if catalogue_of(family) not in catalogue.FAMILIES or not control.drive.layout.pkw_words:
        return words.NO_TABLE
    try:
        if len(panel.board.store.names(set_file.ENDING)) >= SETS_MAX:
            return words.TOO_MANY
    except OSError:
        pass  # saving comes to a file that cannot be written, and says so
    return texts.NOTHING


class Save(Work):
    """name: bytes, 10 at the most."""

    def __init__(self, panel, control, name):
        self._name = name
        self._text = b""
        self._check = 0
        self._rows = 0
        self._file = None
        self._ratings = {}
        self.untold = 0
        Work.__init__(self, panel, control)
        self.total = COUNTS[catalogue_of(self.family)]
        self._table = catalogue.rows(catalogue_of(self.family), paced=True)
        self._row = None  # the next one, once it is found

    def work(self):
        store = self.panel.board.store
        yield from self.read_ratings(self._take_rating)
        family = catalogue_of(self.family)
        head = (family.encode(), self.drive.address, self._name, VERSION.encode(), self._ratings)
        for line in set_file.head_lines(*head):
            self._add(line)
        yield from self.write_flash(self._begin, store)
        for _ in pump.run(self.drive, self._tasks(), self._take):
            yield
            if len(self._text) >= _PIECE:
                yield from self.write_flash(self._write)
        self._text += set_file.end_line(self._rows, self._check) + b"\n"
        yield from self.write_flash(self._finish, store)
        self.outcome = (words.SAVED, self._rows)
        if self.untold:
            self.outcome = (words.SAVED_UNTOLD, self.untold)

    def look_ahead(self):
        if self._row is not None or self._table is None:
            return False
        for row in self._table:
            if row and row[catalogue.KEY][:1] == b"P":
                self._row = row
            return True
        self._table = None
        return True

    def _tasks(self):
        while self._row is not None or self._table is not None:
            row, self._row = self._row, None
            if row is not None:
                number = catalogue.number(row)
                kind = row[catalogue.TYPE]
                for index in range(0 if number in self.never else catalogue.indices(row)):
                    yield pump.reads(self.family, number, index), (number, index, kind)
            yield None

    def _take(self, job, tag):
        if self.is_to_be_repeated(job):
            return True
        self.done += 1
        if job.state == pkw.DONE:
            number, index, kind = tag
            if (job.width == pkw.WORD) != (kind in set_file.WORDS):  # the drive knows better
                kind = set_file.WORDS[0] if job.width == pkw.WORD else set_file.DOUBLES[0]
            self._add(set_file.row_line(number, index, kind, job.high, job.low))
            self._rows += 1
        elif job.state == pkw.REFUSED and job.error in (_HIDDEN, pkw.TOO_SMALL):
            raise ValueError(*failure(job))
        elif job.state != pkw.REFUSED or job.error not in _ABSENT:
            self.untold += 1
        return False

    def _take_rating(self, number, high, low):
        self._ratings[number] = (high, low)

    def _add(self, line):
        self._check = set_file.checked(line, self._check)
        self._text += line + b"\n"

    # --- what goes into the flash, each at an instant when it may -------------------------------

    def _begin(self, store):
        self._file = store.begin()

    def _write(self):
        self._file.write(self._text)
        self._text = b""

    def _finish(self, store):
        self._write()
        names = store.names(set_file.ENDING)
        number = 1
        while "%d%s" % (number, set_file.ENDING) in names:
            number += 1
        store.finish(self._file, "%d%s" % (number, set_file.ENDING))
