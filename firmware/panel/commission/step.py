# SPDX-License-Identifier: MIT
"""A step of a procedure: which parameter of the drive, what that needs, whether the drive has it.

    step = Step(row, control, is_done)      # row of the catalogue, "S"
    step.ask(reading)                       # True: a `Reading` is on its way
    step.is_right(job)                      # whether what it brought is what the step needs
    form = step.form(parameter_row, job)    # how that reads
    step.needed(form, has)                  # the bits that the step proposes

What a person sees of it and does with it: `course`.
"""

import catalogue
from micropython import const

from panel.lookup import value
from uss import pkw
from uss.families.generic import RESCALES

# What starts something reads 0 again, so no reading tells that it was done.
_STARTS = (10, 970, 971, 1910, 3900)
_OFF_TIME_MS = const(2_000)
_TELLS = b"?"  # a person
_STAYS = (b"@baud", b"@address")  # what it has is right: it answers
_SOURCES = (700, 1000)  # of commands and setpoint: the catalogue has them for the terminals
_BOP_LINK = b"4"


class Step:
    """key: of its row. number, index: of its parameter.

    is_typed: a person types the value. is_told: no reading tells that it is done, a person does.
    is_done: as far as it is known.
    """

    def __init__(self, row, control, is_done):
        self._control = control
        family = control.survey.family
        self.key = catalogue.number(row)
        self.number = number = int(row[catalogue.STEP_NUMBER])
        self.index = int(row[catalogue.STEP_INDEX])
        if number in family.linked:
            self.index = family.link_index
        needs = row[catalogue.STEP_VALUE]
        if family.com is not None and number in _SOURCES:
            needs = _BOP_LINK
        self._needs = needs
        self.is_typed = needs == _TELLS
        self.is_told = self.is_typed or (number in _STARTS and needs != b"0")
        self.is_done = is_done and self.is_told

    def ask(self, reading):
        """Read the parameter, if the drive can be asked now. Answers whether it is asked."""
        drive = self._control.drive
        if not drive.contact:
            return False
        is_element = self.index and self._control.survey.family.has_array_tasks
        task = pkw.READ_ELEMENT if is_element else pkw.READ
        return reading.ask(drive, self.number, self.index, task)

    def form(self, row, job):
        """The `value.Form` of what a reading brought. row: of the parameter."""
        return value.Form(row, job.width)

    def rescales(self, bits, has):
        """Whether the setpoint means another speed once these bits are written."""
        ask_first = self._control.survey.family.ask_first
        return ask_first.get(self.number) == RESCALES and bits != has

    def needed(self, form, has):
        """The bits that the step proposes, for a parameter that has the bits `has`."""
        needs, control = self._needs, self._control
        if needs in _STAYS:
            return has
        if needs == b"@pkw":
            return control.drive.layout.pkw_words
        if needs == b"@off":
            return has or max(_OFF_TIME_MS // control.survey.family.off_time_unit_ms, 1)
        number = catalogue.value(needs)
        if form.kind == value.FLOAT:
            high, low = pkw.float_to_words(float(number))
            return high << 16 | low
        return form.of_number(number)

    def is_right(self, job):
        needs, has = self._needs, job.integer_value()
        if needs in _STAYS:
            return True
        if needs == b"@pkw":
            return has == self._control.drive.layout.pkw_words
        if needs == b"@off":
            return has != 0
        number = catalogue.value(needs)
        return number in (has, pkw.words_to_float(job.high, job.low) if job.width > 1 else has)
