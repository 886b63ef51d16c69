# SPDX-License-Identifier: MIT
"""What a program of one's own gets instead of what it wanted: exceptions in plain words.

For `bus` and `scan`. What is no fault of line or drive but of the program is a ValueError or a
TypeError.

    try:
        drive.run(25.0)
    except UssError as reason:
        print(reason)                       # drive 1 does not answer
"""


class UssError(Exception):
    """What was wanted of a drive was not done."""


class NoContact(UssError):
    """The drive does not answer, or nothing is sent to it."""


class TimedOut(UssError):
    """The drive answers, but not to this parameter task."""


class NotStarted(UssError):
    """The motor was not started. The text says why."""


class Refused(UssError):
    """The drive refused a parameter task. number: see pkw.ERRORS; -1 when others have the right
    to change parameters. job: the task, with what the drive offers instead."""

    def __init__(self, text, job):
        super().__init__(text)
        self.number = job.error
        self.job = job
