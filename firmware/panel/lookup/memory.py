# SPDX-License-Identifier: MIT
"""The fault memory of the drive shown, the last fault first: r0947[0...7] of most.

A1 FAULTS    1/8        SET tells what one means: `what`
>F0001 Overcurr
"""

import catalogue
from panel import texts
from panel.lookup import Search, name_of, text, words
from panel.menu import Entries
from panel.reading import Reading
from uss import pkw

_FAULTS = 8
_WIDTH = 15  # of an entry
_NOT_TOLD = -1


class List(Entries):
    def __init__(self, panel, argument):
        Entries.__init__(self, panel, argument)
        self._control = control = panel.selected
        self._family = family = control.survey.family
        self._count = _FAULTS if family.has_indices else 1
        self._numbers = []  # as far as they are read
        self._names = {}  # number -> its text; None: it is looked for
        self._reading = Reading()
        self._search = Search()

    def heading(self, position):
        return texts.of(words.FAULTS_OF, self._control.drive.address)

    def count(self):
        return self._count

    def step(self, position, now_ms):
        family, drive = self._family, self._control.drive
        if self._search.rows is not None:
            return
        if self._reading.asked:
            self._take(self._reading.take())
        elif len(self._numbers) < self._count and drive.contact and family.fault_number:
            index = len(self._numbers)
            is_element = index and family.has_array_tasks
            task = pkw.READ_ELEMENT if is_element else pkw.READ
            self._reading.ask(drive, family.fault_number, index, task)

    def is_searching(self):
        return self._search.rows is not None

    def search(self):
        row = self._search.step()
        if row:
            self._names[catalogue.number(row)] = text(row)

    def _take(self, job):
        if job is None:
            return
        self._numbers.append(job.low if job.state == pkw.DONE else _NOT_TOLD)
        number, table = self._numbers[-1], name_of(self._family)
        if number > 0 and table and number not in self._names:
            rows = catalogue.rows(table, b"%d" % number, "F", paced=True)
            self._search.begin(rows)

    def words(self, position):
        if position >= len(self._numbers):
            return b"..."
        number = self._numbers[position]
        if number <= 0:
            return texts.of(words.NO_FAULT) if number == 0 else b"-----"
        name = self._names.get(number, b"")
        return (self._called(number) + b" " + name)[:_WIDTH].rstrip()

    def choose(self, position, now_ms):
        number = self._numbers[position] if position < len(self._numbers) else 0
        if number > 0:
            return "lookup.what", ("F", number, self._called(number))
        return None

    def _called(self, number):
        return self._family.fault_format.encode() % number
