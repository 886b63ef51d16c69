"""One drive on the bus, as the master keeps it: commands, images, parameter jobs, counters.

Two sides share a drive: the *loop* (panel, own program) and the *engine* (`master.poll`, possibly
in an interrupt). They share words, not structures; each field has one writer:

    loop     wanted, ticket, hsw, urgent, _queue_in
    engine   void, zsw, hiw, contact, contacts, was_running, silent, served, counters and the rest
    a Job    belongs to the loop, but to the engine from `ask` until its state is no longer PENDING

ON is sent only on a ticket. Every START draws a new one; the engine voids the one in force when
the drive is lost, faults, stops of its own accord, or the loop stops refreshing. A void ticket
stays void: whatever happens to the line or the loop, only a fresh `start` makes a drive run again.

    drive.start(0x0CCD)         # ON, setpoint HSW, from the next telegram on
    drive.stop()                # OFF1, in the very next telegram on the line
    drive.ask(pkw.read(700))
"""

from micropython import const

from uss import pkw, pzd
from uss.telegram import NODE_MAX, get_word, put_word
from uss.timing import elapsed

PKW_WORDS = const(4)
PZD_WORDS = const(2)
NET_COUNT = const(2 * (PKW_WORDS + PZD_WORDS))
PZD_OFFSET = const(2 * PKW_WORDS)

TICKET_MASK = const(0xFFFF)
COUNTER_MASK = const(0xFFFF)  # counters wrap like the drive's own (specification)
JOBS_MAX = const(8)
REST_MAX = const(20)  # telegrams without a task that are tried before the next one is sent anyway
TRIES_MIN = const(3)  # a task was sent at least so often before it times out

# What each receiver finding is counted as. Named as in specification.
COUNTERS = (
    "good",  # answered without an error
    "start",  # telegram start not identified
    "length",
    "bcc",
    "address",
    "no_reply",
    "residual",  # residual run time expired
)


class Drive:
    """address: node 0...31, ValueError beyond. mask: the clock's period - 1."""

    def __init__(self, address, mask):
        if not 0 <= address <= NODE_MAX:
            raise ValueError("drive address %r is not 0...31" % (address,))
        self.address = address
        self._mask = mask
        # Written by the loop.
        self.wanted = False
        self.ticket = 0
        self.hsw = 0
        self.urgent = 0
        # Written by the engine.
        self.void = 0
        self.zsw = 0
        self.hiw = 0
        self.contact = False  # a valid reply came within the lost time
        self.contacts = 0  # how often contact was made
        self.heard = False  # ever
        self.was_running = False  # when contact was lost: it may run still
        self.ran = False  # seen running on the ticket in force
        self.off_answers = 0  # valid replies to telegrams without ON; wraps
        self.answered_off = False  # the last valid reply was one to a telegram without ON
        self.silent = 0  # telegrams without a valid reply in a row
        self.served = 0
        self.taken_back = False  # ON was revoked and the telegram that says so is still to be sent
        self.counters = [0] * len(COUNTERS)
        self._heard_at = 0
        self._sent_on = False
        # The queue of jobs: a ring with one writer at each end.
        self._queue = [None] * (JOBS_MAX + 1)
        self._queue_in = 0
        self._queue_out = 0
        self._job = None
        self._job_since = 0
        self._job_tries = 0
        self._rest = 0  # telegrams without a task still to be tried for an answer with AK 0
        self._ended_pke = 0  # the job that ended last
        self._ended_ind = 0

    # --- for the loop ---------------------------------------------------------------------------

    def start(self, hsw):
        """Have the drive run with setpoint word `hsw` (0...FFFFh) on a new ticket."""
        self.hsw = hsw
        self.ticket = (self.ticket + 1) & TICKET_MASK
        if self.ticket == self.void:  # after 65536 starts the old void one comes round
            self.ticket = (self.ticket + 1) & TICKET_MASK
        self.wanted = True
        self.hurry()

    def stop(self):
        """OFF1, whatever state the drive is in, ahead of the list. It stays OFF until `start`."""
        self.wanted = False
        self.hurry()

    def hurry(self):
        """Let the next telegram on the line be one to this drive."""
        self.urgent = (self.served + 1) & TICKET_MASK

    def is_on(self):
        """Whether ON is being sent."""
        return self.wanted and self.ticket != self.void and self.contact

    def stopped_by_engine(self):
        """Whether ON was wanted and the engine took it back; `stop` or `start` clear it."""
        return self.wanted and self.ticket == self.void

    def state(self):
        """What the last status word says: pzd.READY ... Means nothing without contact."""
        return pzd.state(self.zsw)

    def ask(self, job):
        """Queue a parameter job. RuntimeError when JOBS_MAX wait already or it is pending."""
        following = (self._queue_in + 1) % len(self._queue)
        if following == self._queue_out:
            raise RuntimeError("drive %d has %d jobs already" % (self.address, JOBS_MAX))
        if job.state == pkw.PENDING:
            raise RuntimeError("%r is pending already" % (job,))
        job.state = pkw.PENDING
        self._queue[self._queue_in] = job
        self._queue_in = following

    # --- for the engine: allocates nothing ------------------------------------------------------

    def revoke(self):
        """Void the ticket in force: no ON until the next `start`, and OFF1 ahead of the list."""
        if self.is_on():
            self.taken_back = True
        self.void = self.ticket
        self.ran = False

    def urgency(self):
        """0: wait for your turn in the list. Above: go before it, the highest first."""
        if not (self.taken_back or self.urgent != self.served):
            return 0
        if self.is_on():
            return 1
        return 3 if self.zsw & pzd.ZSW_RUNNING else 2

    def fill(self, net, at, now):
        """Write this drive's request, PKW and PZD words, into `net` from index `at` on."""
        self._next_job(now)
        job = self._job
        if job is None or self._rest:
            for index in range(at, at + PZD_OFFSET):
                net[index] = 0
        else:
            put_word(net, at, job.pke)
            put_word(net, at + 2, job.ind)
            # Only a write carries a value; a read's words are where its result will stand.
            write = job.task != pkw.READ
            put_word(net, at + 4, job.high if write else 0)
            put_word(net, at + 6, job.low if write else 0)
            if self._job_tries < TRIES_MIN:
                self._job_tries += 1
        on = self.is_on()
        self._sent_on = on
        self.taken_back = False
        if not on:
            self.ran = False
        put_word(net, at + PZD_OFFSET, pzd.ON if on else pzd.OFF1)
        put_word(net, at + PZD_OFFSET + 2, self.hsw if on else 0)

    def take(self, net, at, now):
        """Take the words of a valid reply that stands in `net` from index `at` on."""
        self._heard_at = now
        self.silent = 0
        self._count(0)
        if not self.contact:
            # Contact is made before anything is sent on it, and what was wanted before is void.
            self.revoke()
            self.contacts = (self.contacts + 1) & COUNTER_MASK
            self.was_running = False
            self.contact = True
            self.heard = True
        self.zsw = get_word(net, at + PZD_OFFSET)
        self.hiw = get_word(net, at + PZD_OFFSET + 2)
        self.answered_off = not self._sent_on
        if self._sent_on:
            self._watch_running()
        else:
            self.off_answers = (self.off_answers + 1) & COUNTER_MASK
        self._take_pkw(get_word(net, at), get_word(net, at + 2), net, at + 4)

    def miss(self, finding, now, lost_us):
        """Count an exchange that brought no valid reply; after `lost_us` of them contact is lost.

        finding: one of the receiver's, not GOOD.
        """
        self._count(finding)
        if self.silent < COUNTER_MASK:
            self.silent += 1
        if self._rest:
            self._rest -= 1
        if self.contact and elapsed(now, self._heard_at, self._mask) >= lost_us:
            self.was_running = self._sent_on or self.state() == pzd.RUNNING
            self.contact = False
            self.revoke()
        self._next_job(now)

    def _watch_running(self):
        # A drive that ran on this ticket and runs no more, or trips, has stopped of its own
        # accord. It must not start again of its own accord when the cause goes away.
        if self.zsw & pzd.ZSW_RUNNING:
            self.ran = True
        elif self.ran:
            self.revoke()
        if self.zsw & pzd.ZSW_FAULT:
            self.revoke()

    def _take_pkw(self, pke, ind, net, at):
        if self._rest:
            # The task was withdrawn; until the drive says AK 0 an old reply may still come.
            self._rest = 0 if pke >> 12 == pkw.NO_REPLY else self._rest - 1
        elif self._job is not None and self._job_tries:
            if self._job.answer(pke, ind, get_word(net, at), get_word(net, at + 2)):
                self._end_job()

    def _next_job(self, now):
        """Time out a job that takes long; take the next one from the queue when there is none."""
        job = self._job
        if job is not None:
            if self._job_tries < TRIES_MIN:
                return
            if elapsed(now, self._job_since, self._mask) < job.timeout_us:
                return
            job.state = pkw.TIMED_OUT
            self._end_job()
        out = self._queue_out
        if out != self._queue_in:
            self._job = job = self._queue[out]
            self._queue[out] = None
            # Only to the same question could an old reply be taken for the answer.
            if job.ind != self._ended_ind or (job.pke ^ self._ended_pke) & 0x07FF:
                self._rest = 0
            self._queue_out = (out + 1) % len(self._queue)
            self._job_since = now
            self._job_tries = 0

    def _end_job(self):
        # A task is never left standing. Two of the same parameter must be told apart
        # (specification C-4.2.1.1): "no task" stands between them until the drive has answered it.
        self._ended_pke = self._job.pke
        self._ended_ind = self._job.ind
        self._job = None
        self._rest = REST_MAX

    def _count(self, counter):
        self.counters[counter] = (self.counters[counter] + 1) & COUNTER_MASK

    def __repr__(self):
        return "<drive %d ZSW %04X HIW %04X>" % (self.address, self.zsw, self.hiw)
