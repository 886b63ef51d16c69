# SPDX-License-Identifier: MIT
"""What a program asks of a family besides its values; all of it is found in `uss.families`.

baud_code(MM440, 19200)                     # 7
turns.add(1, Pump.layout, drive_maker(Pump))    # as the family's status word wants it
can_be_set_to(MM440, Layout(4, 8))          # True
"""

from uss.drive import NO_CONTROL, Drive
from uss.families.rows import SOURCE, STEPS, WORD


def baud_code(family, baud):
    """The code of a baud rate for the family's parameter. ValueError when it has none."""
    for code, rate in family.baud_codes.items():
        if rate == baud:
            return code
    raise ValueError("%s has no code for %r baud" % (family.name, baud))


def drive_maker(family, control=True):
    """What `Turns.add` makes a drive of the family with. control: False if the drive is told
    nothing but parameters: bit 10 of STW is 0."""
    if family.zsw_says is None and control:
        return Drive

    def make(*arguments):
        drive = _make(family, arguments)
        if not control:
            drive.off = NO_CONTROL
        return drive

    return make


def _make(family, arguments):
    if family.zsw_says is None:
        return Drive(*arguments)
    from uss.families.status import TranslatedDrive  # here, because few programs need it

    return TranslatedDrive(family.zsw_says, *arguments)


def can_be_set_to(family, layout):
    """Whether drives of the family can have telegrams of this `Layout`."""
    return layout.suits(family)


def value(job, kind, is_fine=False):
    """What a job that is done read for a row of `survey`: an integer, or a float in Hz or 1/min.

    kind: of the row. is_fine: whether the row ABSOLUTE is not 0, which matters to STEPS alone.
    """
    if kind == STEPS:
        return job.integer_value() / (100 if is_fine else 10)
    if kind in (WORD, SOURCE):
        return job.integer_value()
    return job.float_value()


def is_float(family, number):
    """Whether a 32-bit value of this parameter is floating point, as far as anybody knows."""
    integers = family.integer_doubles
    if isinstance(integers, str):
        from uss.families.integers import TABLES  # here, because few programs need it

        return not sum([bound <= number for bound in TABLES[integers]]) & 1
    return integers is not None and number not in integers
