# SPDX-License-Identifier: MIT
"""One question about a parameter: asked, and answered, unless nobody wants to know any more.

In use:

    reading = Reading()
    reading.ask(drive, 700)             # False: the channel of the drive is full, later
    job = reading.take()                # None: nothing was asked, or it is on its way
    reading.drop()                      # it is about something else from now on
"""

from uss import pkw


class Reading:
    """asked: a question is on its way, or its answer is still to be taken."""

    def __init__(self):
        self.asked = False
        self._job = None  # made with the first question: most drives never have one

    def ask(self, drive, number, index=0, task=pkw.READ):
        """Queue the question. Answers whether there was room for it."""
        if drive.channel.is_full():
            return False
        if self._job is None:
            self._job = pkw.Job(task, number, index)
        else:
            self._job.aim(task, number, index)
        drive.ask(self._job)
        self.asked = True
        return True

    def prepare(self):
        """Make the job now, if there is none. Answers whether that was to do: it takes long."""
        if self._job is not None:
            return False
        self._job = pkw.read(0)
        return True

    def take(self):
        """The job of a question that has come to its end, once."""
        if not self.asked or self._job.state == pkw.PENDING:
            return None
        self.asked = False
        return self._job

    def drop(self):
        """What was asked, if anything, does not count any more. The drive may take its time."""
        if self.asked:
            self.asked = False
            self._job = None
