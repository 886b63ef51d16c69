# SPDX-License-Identifier: MIT
"""The exceptions of `bus` and `scan`, which say in plain words why something was not done.

A mistake in the program, not a fault of line or drive, is a ValueError or a TypeError.

    try:
        drive.run(25.0)
    except UssError as reason:
        print(reason)                       # drive 1 does not answer
"""

from uss.master import CLOSED, OFF

# Why the bus sends nothing any more, by the phase of the engine.
WHY_SILENT = {OFF: "the bus is off", CLOSED: "the bus is closed"}


class UssError(Exception):
    """The drive did not do what the program asked for."""


class NoContact(UssError):
    """The drive does not answer, or the bus sends it nothing.

    trouble: what came instead of valid answers, one of SILENCE, NOISE, OTHER_LENGTH, OTHER_ADDRESS
    and WRONG_CHECK of `receiver`; None if the bus sends nothing.
    """

    def __init__(self, text, trouble=None):
        super().__init__(text)
        self.trouble = trouble


class TimedOut(UssError):
    """The drive answers, but not to this parameter task."""


class FallsSilent(TimedOut):
    """The drive answers telegrams without this parameter task, but none with it. The bus withdrew
    the task, so that it does not lose the drive. A write may or may not have been carried out."""


class NotStarted(UssError):
    """The motor was not started. The text says why."""


class Refused(UssError):
    """The drive refused a parameter task.

    number: see `pkw_errors`; -1 if this master has no right to change parameters. job: the task,
    with what the drive offers instead.
    """

    def __init__(self, text, job):
        super().__init__(text)
        self.number = job.error
        self.job = job
