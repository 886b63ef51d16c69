# SPDX-License-Identifier: MIT
"""What saving and writing a set have in common: steps, what went wrong, how far it is.

work = Save(panel, control, b"PUMP 1")
work.step(now_ms)                   # again and again, until
work.outcome                        # it is not None any more: a text and the values in it
"""

from micropython import const

from panel import texts
from panel.menu.sets import words
from panel.pages import parameter_words
from panel.sets import pump
from uss import pkw
from uss.timing import elapsed

_STALLED_MS = const(15_000)  # nothing has come of it for so long
_TRIES = const(3)
_WORK_US = const(500)  # then it is enough for a step of the loop: one of these takes up to 2 ms
_STEPS_MAX = const(6)

# Readings that tell a drive's rating: power, current, voltage. What differs in them, or tells
# none, is another motor's.
RATINGS = {"mm3": (111, 112)}
USUAL_RATINGS = (206, 207, 208)

# Operations and passwords: no values that belong to a drive.
NEVER = {"mm3": (944, 971)}
USUAL_NEVER = (10, 11, 12, 40, 340, 952, 970, 971, 1900, 1910, 1960, 2111, 3900)


def catalogue_of(family):
    """The name of a family's table; that of one on the BOP link is that of its terminals."""
    return (family.com or family).__name__.lower()


class Work:
    """panel: the `Panel`. control: the `Control` of the drive.

    never: parameters that are none of the drive's values.
    done, total: values so far and at the end, as far as it is known; left_s: seconds that it still
    takes, None while nobody knows.
    """

    def __init__(self, panel, control):
        self.panel = panel
        self.control = control
        self.drive = control.drive
        self.family = control.survey.family
        self.never = NEVER.get(catalogue_of(self.family), USUAL_NEVER)
        self.outcome = None
        self.asks = False  # somebody has to answer first
        self.done = 0
        self.total = 1
        self.left_s = None
        self._tries = 0
        self._now_ms = None  # the last step
        self._steps = self.work()
        self._seen = 0  # `done` when the time was looked at last
        self._begun_ms = self._moved_ms = None

    def work(self):
        """A generator: a step of the loop each time; what it raises is the outcome."""

    def step(self, now_ms):
        if self.outcome is not None:
            return
        self._now_ms = now_ms
        try:
            self._look(now_ms)
            next(self._steps)
        except StopIteration:
            pass
        except (OSError, ValueError, MemoryError) as error:
            self._fail(error)

    def search(self):
        """As many steps as fit one of the loop, at the time of the last one. It is over then, or
        has something to wait for.
        """
        ticks_us, mask = self.panel.board.clock.ticks_us, self.panel.mask
        began_us = ticks_us()
        for _ in range(_STEPS_MAX if self._now_ms is not None else 0):
            try:
                has_looked = self.look_ahead()
            except (OSError, ValueError, MemoryError) as error:
                self._fail(error)
                return
            if not has_looked:
                self.step(self._now_ms)
            if self.outcome is not None or elapsed(ticks_us(), began_us, mask) >= _WORK_US:
                return

    def look_ahead(self):
        """Do a piece of what a step waits for, if there is any. Answers whether there was.

        It is not done within the step: what searches a table is a generator within another one
        within another one, and with those of the step a chip's stack would be too short for the
        interrupt that comes meanwhile.
        """
        return False

    def end(self, *outcome):
        self.outcome = outcome
        if self.panel.errand is not None:
            self.panel.errand = None
            self.panel.bus.resume()

    def _fail(self, error):
        if isinstance(error, OSError):
            self.end(words.FLASH_FULL)
        else:
            told = error.args and isinstance(error.args[0], bytes)
            self.end(*(error.args if told else (texts.NO_MEMORY,)))

    def percent(self):
        return min(100 * self.done // self.total, 100)

    def _look(self, now_ms):
        """Whether it still may go on, and how fast it does."""
        mask = self.panel.mask
        if not self.drive.contact:
            raise ValueError(texts.NO_CONTACT)
        if self.control.is_active():
            raise ValueError(texts.STOP_FIRST)
        if self._begun_ms is None or self.done < self._seen:
            self._begun_ms = now_ms
        if self._moved_ms is None or self.asks or self.done != self._seen:
            self._seen, self._moved_ms = self.done, now_ms
        elif elapsed(now_ms, self._moved_ms, mask) > _STALLED_MS:
            raise ValueError(parameter_words.NO_ANSWER)
        if self.done:
            passed_ms = elapsed(now_ms, self._begun_ms, mask)
            self.left_s = max(passed_ms * (self.total - self.done) // self.done // 1000, 0)

    # --- for the works --------------------------------------------------------------------------

    def write_flash(self, function, *arguments):
        """A generator: something is written into the flash, as soon as that may be."""
        failed = []

        def errand():
            try:
                function(*arguments)
            except OSError as error:
                failed.append(error)

        self.panel.errand = errand
        while self.panel.errand is not None:
            yield
        if failed:
            raise failed[0]

    def is_to_be_repeated(self, job):
        """Whether a reading ended without saying anything about the parameter."""
        if job.state == pkw.DONE or job.state == pkw.REFUSED or self._tries >= _TRIES:
            self._tries = 0
            return False
        self._tries += 1
        return True

    def one(self, *aim):
        """A generator: one task, aimed like this. Answers its job."""
        jobs = []
        tasks = iter([(aim, None)])
        yield from pump.run(self.drive, tasks, lambda job, _: jobs.append(job))
        return jobs[0]

    def read_ratings(self, take):
        """A generator. take: is told number, high and low."""
        name = catalogue_of(self.family)

        def note(job, number):
            if self.is_to_be_repeated(job):
                return True
            if job.state == pkw.DONE:
                take(number, job.high if job.width == pkw.DOUBLE else 0, job.low)

        numbers = RATINGS.get(name, USUAL_RATINGS)
        tasks = iter([(pump.reads(self.family, number, 0), number) for number in numbers])
        yield from pump.run(self.drive, tasks, note)
