"""The parameter channel of one drive: jobs wait their turn, one task at a time is on the line.

The loop puts jobs in, the engine carries them out: a task is repeated in every telegram until the
fitting reply comes, then "no task" follows (specification C-4.2.1.1). The queue is a ring with one
writer at each end, so that neither side waits for the other.

    channel.ask(pkw.read(700))                  # loop
    channel.fill(net, at, now)                  # engine: the PKW words of the next request
    channel.take(net, at)                       # engine: those of the reply
"""

from micropython import const

from uss import pkw
from uss.fast import copy
from uss.timing import elapsed

PKW_COUNT = const(8)  # characters of the four PKW words
NO_TASK = bytes(PKW_COUNT)
JOBS_MAX = const(8)
REST_MAX = const(20)  # telegrams without a task that are tried before the next one is sent anyway
TRIES_MIN = const(3)  # a task was sent at least so often before it times out


class Channel:
    """mask: the clock's period - 1.

    idle: nothing is asked, and the words in the telegram say so: neither `fill` nor `take` would
    do anything.

    Written by the loop: _in, and idle to False. By the engine: everything else. A Job belongs to
    the loop, but to the engine from `ask` until its state is no longer PENDING.
    """

    def __init__(self, mask):
        self.idle = False
        self._mask = mask
        self._queue = [None] * (JOBS_MAX + 1)
        self._in = 0
        self._out = 0
        self._job = None  # the task on the line
        self._since = 0
        self._tries = 0
        self._rest = 0  # telegrams without a task still to be tried for an answer with AK 0
        self._ended_pke = 0  # the job that ended last
        self._ended_ind = 0

    def is_full(self):
        """Whether `ask` would be refused for want of room."""
        return (self._in + 1) % len(self._queue) == self._out

    def ask(self, job):
        """Queue a job. RuntimeError when JOBS_MAX wait already or it is pending."""
        if self.is_full():
            raise RuntimeError("%d jobs wait already" % JOBS_MAX)
        if job.state == pkw.PENDING:
            raise RuntimeError("%r is pending already" % (job,))
        job.state = pkw.PENDING
        self._queue[self._in] = job
        self._in = (self._in + 1) % len(self._queue)
        self.idle = False

    # --- for the engine: allocates nothing ------------------------------------------------------

    def fill(self, net, at, now):
        """Write the PKW words of the next request into `net` from index `at` on."""
        job = self._job
        if self._out != self._in or self._tries >= TRIES_MIN:
            self.supervise(now)
            job = self._job
        if job is None or self._rest:
            copy(NO_TASK, net, at, PKW_COUNT)
            self.idle = job is None and not self._rest
            return
        copy(job.words, net, at, PKW_COUNT)
        if self._tries < TRIES_MIN:
            self._tries += 1

    def take(self, net, at):
        """Take the PKW words of a valid reply that stand in `net` from index `at` on."""
        pke = net[at] << 8 | net[at + 1]
        job = self._job
        if self._rest:
            # The task was withdrawn; until the drive says AK 0 an old reply may still come.
            self._rest = 0 if pke >> 12 == pkw.NO_REPLY else self._rest - 1
            self.idle = job is None and not self._rest and self._in == self._out
        elif job is not None:
            ind = net[at + 2] << 8 | net[at + 3]
            high = net[at + 4] << 8 | net[at + 5]
            low = net[at + 6] << 8 | net[at + 7]
            if job.answer(pke, ind, high, low):
                self._end()

    def miss(self, now):
        """There was no valid reply."""
        if self._rest:
            self._rest -= 1
        self.supervise(now)

    def supervise(self, now):
        """Time out a job that takes long; take the next one from the queue when there is none."""
        job = self._job
        if job is not None:
            if self._tries < TRIES_MIN or elapsed(now, self._since, self._mask) < job.timeout_us:
                return
            job.state = pkw.TIMED_OUT
            self._end()
        if self._out != self._in:
            self._begin(self._queue[self._out], now)

    def _begin(self, job, now):
        self._job = job
        self._since = now
        self._tries = 0
        # Only to the same question could an old reply be taken for the answer.
        if job.ind != self._ended_ind or (job.pke ^ self._ended_pke) & 0x07FF:
            self._rest = 0
        self._queue[self._out] = None
        self._out = (self._out + 1) % len(self._queue)

    def _end(self):
        # A task is never left standing. Two of the same parameter must be told apart
        # (specification C-4.2.1.1): "no task" stands between them until the drive has answered it.
        self._ended_pke = self._job.pke
        self._ended_ind = self._job.ind
        self._job = None
        self._rest = REST_MAX
