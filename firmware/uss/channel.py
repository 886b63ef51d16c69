# SPDX-License-Identifier: MIT
"""The parameter channel of one drive: jobs wait their turn, one task at a time is on the line.

The loop queues jobs and the engine carries them out: it repeats a task in every telegram until the
fitting reply comes, then sends "no task" (specification C-4.2.1.1). The queue is a ring with one
writer at each end, so neither side waits for the other.

A drive may fall silent on a task that it does not know. The bus must not lose it by that, or it
would stop its motor. So when telegrams with a task stay unanswered, the bus sends one without it.
If the drive answers that, the task is to blame, and ends as UNANSWERED. If not, the drive or the
line is silent: a task that reads goes on when the drive answers again. A task that writes is not
sent again, because the drive might carry it out twice.

    channel.ask(pkw.read(700))                  # loop
    channel.fill(net, at, now)                  # engine: the PKW words of the next request, 8
    channel.take(net, at, count)                # engine: the PKW words of the reply
"""

from micropython import const

from uss import pkw
from uss.fast import copy
from uss.timing import elapsed

NO_TASK = bytes(8)
JOBS_MAX = const(8)  # of a drive, the one on the line included; a power of two
REST_MAX = const(20)  # after so many telegrams without a task the next task is sent anyway
_TRIES_MIN = const(5)  # a task is sent at least so often: a drive may lag three, one may be lost
_SILENCES_MAX = const(3)  # telegrams with a task in a row that may stay unanswered
_WORK_TIMEOUT_US = const(2_000_000)  # long, because a reply may lag some cycles
_EEPROM_TIMEOUT_US = const(5_000_000)

NO_QUEUE = (None,)  # of a drive without PKW words
_ANY = const(-1)

_VARIABLE = const(127)  # of `layout`, which would be an import too deep for the 32-bit port

# Copies from `pkw`, for the compiler.
_THREE_WORDS = const(6)
_FOUR_WORDS = const(8)
_VARIABLE_LENGTH = const(0x100)
_SHORT = const(0x200)  # bit of _form: a request without a task has no PKW words
_FOLLOWED = const(0x400)  # bit of _form: `follow` has set where change reports go
_POSITION = const(7)  # bits of a place in the queue
_LAGS_MAX = const(4)  # so many old answers in a row are counted
_WAITING = const(-1)  # `tries` of a job whose turn has not come
_PENDING = const(1)
_FIRST_PERMANENT = const(11)


class Channel:
    """mask: the clock's period - 1. pkw_words: 0, 3, 4 or layout.VARIABLE. longest: with VARIABLE
    the most PKW words that a request has room for. short: with VARIABLE, requests without a task
    have none.

    idle: there is no task, and the telegram says so: neither `fill` nor `take` would do anything.

    The loop writes _in, _form, and idle to False; the engine writes everything else. A Job belongs
    to the loop, but to the engine from `ask` until its state is no longer PENDING.
    """

    # Eight fields. One more would take 16 bytes more of each drive.

    def __init__(self, mask, pkw_words=4, longest=10, short=False):
        variable = pkw_words == _VARIABLE
        self.idle = pkw_words == 0
        self._form = _VARIABLE_LENGTH | 2 * longest if variable else 2 * pkw_words
        if short:
            self._form |= _SHORT
        self._mask = mask
        self._queue = [None] * JOBS_MAX if pkw_words else NO_QUEUE
        self._in = 0  # the place of the next job in the queue,
        self._out = 0  # and of the one on the line
        # If not 0, telegrams go without a task. Above 0: at most so many more, until the drive
        # answers one with AK 0. Below 0: minus the number sent because the task stays unanswered.
        self._without = 0
        # The key of the job that ended last: only a job with the same key must wait for AK 0.
        # _ANY: any job must.
        self._ended = _ANY

    def is_full(self):
        """Whether `ask` would be refused, because there is no room or there are no PKW words."""
        return not self._form or self._queue[self._in] is not None

    def ask(self, job):
        """Queue a job. RuntimeError if JOBS_MAX wait already, it is pending, or the drive has no
        parameter channel. A job that does not fit the channel is REFUSED at once.
        """
        form = self._form
        position = self._in
        if not form:
            raise RuntimeError("the drive has no parameter channel")
        if self._queue[position] is not None:
            raise RuntimeError("%d jobs wait already" % JOBS_MAX)
        if job.state == _PENDING:
            raise RuntimeError("%r is pending already" % (job,))
        # A plain job fits four words, which is what most drives have.
        if (form != _FOUR_WORDS or job.data is not None) and not job.fits(form):
            job.refuse(pkw.TOO_SMALL)
            return
        job.tries = _WAITING
        job.silences = job.lags = 0
        job.state = _PENDING
        self._queue[position] = job
        self._in = position + 1 & _POSITION
        self.idle = False

    def follow(self, reports):
        """Hand every reply to `reports`, a `change_reports.Reports`, and its bit to every task.

        None ends it. RuntimeError when the drive has no parameter channel.
        """
        if reports is None:
            self._form &= _FOLLOWED - 1
            return  # the engine sees by itself whether anything is left to do
        if not self._form:
            raise RuntimeError("the drive has no parameter channel")
        self.reports = reports
        self._form |= _FOLLOWED
        self.idle = False

    def become(self, other):
        """Take over the layout and the empty queue of `other`, which nobody uses.

        What waits ends as TIMED_OUT; change reports are followed on where there are PKW words. The
        engine may come in between and count a miss, but neither `fill` nor `take`.
        """
        self.idle = True  # from now on a miss is not for this channel
        for job in self._queue:
            if job is not None and job.state == _PENDING:
                job.state = pkw.TIMED_OUT
        form = other._form
        if form and self._form >= _FOLLOWED:
            form |= _FOLLOWED
        self._queue = other._queue
        self._in = self._out = 0
        self._ended = _ANY
        self._without = REST_MAX if form else 0  # the answer to an old task may still come
        self._form = form
        self.idle = not form

    # --- for the engine: allocates nothing ------------------------------------------------------

    def fill(self, net, at, now):
        """Write the PKW words of the next request into `net` from index `at` on; return how many
        characters they are.
        """
        job = self._queue[self._out]
        without = self._without
        words = NO_TASK
        if job is None:
            self.idle = not without and self._form < _FOLLOWED
        else:
            tries = job.tries
            if tries == _WAITING:
                tries = 0
                job.since = now
                # An old reply can mostly be taken for the answer only to the same question. So any
                # other question need not wait for "no task".
                if self._ended != _ANY and self._ended != job.key:
                    self._without = without = 0
            elif tries >= _TRIES_MIN:
                self._watch(job, now)
                without = self._without
            if not without:
                words = job.words
                if tries < _TRIES_MIN:
                    tries += 1
            job.tries = tries
        if self._form == _FOUR_WORDS:
            copy(words, net, at, _FOUR_WORDS)
            return _FOUR_WORDS
        return self._place(job, words, net, at)

    def _place(self, job, words, net, at):
        """Write the words in the form of a channel other than four fixed words, and the report
        bit.
        """
        form = self._form
        size = form & 0xFF
        if form & _VARIABLE_LENGTH:
            size = job.size() if words is not NO_TASK else _THREE_WORDS
            if words is NO_TASK and form & _SHORT and form < _FOLLOWED:
                return 0
        copy(words, net, at, size)
        if size == _THREE_WORDS:  # the word of a value goes where the high word was
            net[at + 4] = words[6]
            net[at + 5] = words[7]
        if form & _FOLLOWED:
            net[at] |= self.reports.bit
        return size

    def foresee(self, answering):
        """The words that `fill` would write if nothing happens meanwhile; None: that depends. This
        changes nothing; `sent` says that they went out.

        answering: a reply is under way; it is as `going_on.plan` says.
        """
        if self._form != _FOUR_WORDS:
            return None
        out = self._out
        job = self._queue[out]
        without = self._without
        ended = self._ended
        if without < 0:
            return None
        if answering:
            if without:
                without = 0
            elif job is not None and job.tries > 0:
                ended = _ANY if job.task >= _FIRST_PERMANENT else job.key
                job = self._queue[out + 1 & _POSITION]
                without = REST_MAX
        if job is None:
            return NO_TASK
        if job.tries == _WAITING:
            if ended != _ANY and ended != job.key:
                without = 0
        elif job.tries >= _TRIES_MIN:
            return None
        return NO_TASK if without else job.words

    def sent(self, net, at, now):
        """The words in `net` from index `at` on, of `foresee`, are on the line."""
        job = self._queue[self._out]
        if net[at] < 0x10:  # no task
            if job is None:
                self.idle = not self._without and self._form < _FOLLOWED
        elif job is not None:
            if job.tries == _WAITING:
                job.tries = 0
                job.since = now
            job.tries += 1
            self._without = 0

    def take(self, net, at, count=8):
        """Take the PKW words of a valid reply, `count` characters in `net` from index `at` on.
        None at all means the same as AK 0.
        """
        form = self._form
        if not count:
            net, at, count = NO_TASK, 0, _THREE_WORDS
        if form >= _FOLLOWED:
            form -= _FOLLOWED
            self.reports.take(net, at, count, form)
        out = self._out
        job = self._queue[out]
        without = self._without
        if without:
            if without < 0:
                self._judge(job)
                return
            # The task is over. Until the drive says AK 0, an old reply may still come.
            self._without = without = 0 if net[at] < 0x10 else without - 1
            if job is None and not without and self._form < _FOLLOWED:
                self.idle = True
        elif job is not None:
            if job.tries > 0 and job.answer(net, at, count, form):
                # As in `_end`, without the call: this is the common case.
                self._ended = _ANY if job.task >= _FIRST_PERMANENT else job.key
                self._queue[out] = None
                self._out = out + 1 & _POSITION
                self._without = REST_MAX
            else:  # an old answer; the next silence is the first
                job.silences = 0
                job.lags = min(job.lags + 1, _LAGS_MAX)

    def miss(self, now, silent=0, pressing=False):
        """There was no valid reply. silent: telegrams in a row without one. pressing: one more
        would take longer than half of the time after which the drive counts as lost.
        """
        job = self._queue[self._out]
        without = self._without
        if without < 0:
            if -without > job.lags:
                job.silences = 0  # the task is not the reason for the silence
            else:  # a drive that lags works on the task for so many telegrams more
                self._without = without - 1
            job.tries = min(job.tries + 1, _TRIES_MIN)
        elif without:
            self._without = without - 1
        elif job is not None and job.tries > 0:
            job.silences = silences = job.silences + 1
            if pressing or silences >= _SILENCES_MAX:
                self._without = -1
                if silent > silences:  # the drive was silent before it heard of the task
                    job.silences = 0
        if job is not None and job.tries >= _TRIES_MIN:
            self._watch(job, now)

    def _judge(self, job):
        """The drive answers a telegram without the task: is the task to blame?"""
        writes = job.writes()
        silences = job.silences
        # A drive that lags does so on every task, and its old answers reset `silences`: so one
        # silence less is enough.
        if silences >= _SILENCES_MAX - (job.lags > 0) or writes and silences:
            job.state = pkw.UNANSWERED
            self._end(job, writes)
        elif writes:
            job.state = pkw.TIMED_OUT
            self._end(job, True)
        else:
            self._without = 0  # the task goes on

    def _watch(self, job, now):
        """Time out a job that takes long."""
        timeout_us = _WORK_TIMEOUT_US if job.task < _FIRST_PERMANENT else _EEPROM_TIMEOUT_US
        if elapsed(now, job.since, self._mask) >= timeout_us:
            job.state = pkw.TIMED_OUT
            self._end(job, job.writes())

    def _end(self, job, strictly):
        # Two tasks on the same parameter must be told apart (specification C-4.2.1.1): the bus
        # sends "no task" between them until the drive has answered that. strictly: it sends "no
        # task" before any other task, because this one wears the EEPROM or may still be carried
        # out.
        self._ended = _ANY if strictly else job.key
        self._queue[self._out] = None
        self._out = self._out + 1 & _POSITION
        self._without = REST_MAX
