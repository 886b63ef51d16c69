# SPDX-License-Identifier: MIT
"""What a program of one's own gets instead of what it wanted: exceptions in plain words.

For `bus` and `scan`. What is no fault of line or drive but of the program is a ValueError or a
TypeError.

    try:
        drive.run(25.0)
    except UssError as reason:
        print(reason)                       # drive 1 does not answer
"""

from uss.master import CLOSED, OFF

# Why nothing is sent any more, by the phase of the engine.
WHY_SILENT = {OFF: "the bus is off", CLOSED: "the bus is closed"}


class UssError(Exception):
    """What was wanted of a drive was not done."""


class NoContact(UssError):
    """The drive does not answer, or nothing is sent to it.

    trouble: what came instead of valid answers, one of SILENCE, NOISE, OTHER_LENGTH, OTHER_ADDRESS
    and WRONG_CHECK of `receiver`; None when nothing is sent.
    """

    def __init__(self, text, trouble=None):
        super().__init__(text)
        self.trouble = trouble


class TimedOut(UssError):
    """The drive answers, but not to this parameter task."""


class FallsSilent(TimedOut):
    """The drive answers telegrams without this parameter task, but none with it. The task was
    withdrawn, so that the drive is not lost by it. Whether it has written, nobody knows."""


class NotStarted(UssError):
    """The motor was not started. The text says why."""


class Refused(UssError):
    """The drive refused a parameter task.

    number: see `pkw_errors`; -1 when others have the right to change parameters. job: the task,
    with what the drive offers instead.
    """

    def __init__(self, text, job):
        super().__init__(text)
        self.number = job.error
        self.job = job
