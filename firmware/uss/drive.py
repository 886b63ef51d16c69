"""One drive on the bus, as the master keeps it: commands, process image, counters.

Two sides share a drive: the *loop* (panel, own program) and the *engine* (`master.poll`, possibly
in an interrupt). They share words, not structures; each field has one writer:

    loop     wanted, off, ticket, stops, hsw, urgent, asking, acknowledgements
    engine   void, zsw, hiw, contact, contacts, was_running, silent, served, counters and the rest
    both     steady: False by whoever changes something, at last; True by the engine alone

ON and JOG are sent only on a ticket. Every `start` draws a new one; the engine voids the one in
force when the drive is lost, faults, stops of its own accord, or the loop stops refreshing. A void
ticket stays void: whatever happens to the line or the loop, only a fresh `start` makes a drive run
again. Every STOP is sent: one telegram at least carries OFF before the next ON, however soon that
comes.

    drive.start(0x0CCD)                 # ON, setpoint HSW, from the next telegram on
    drive.start(0, pzd.JOG_LEFT)        # JOG, until `stop`
    drive.stop()                        # OFF1, in the very next telegram on the line
    drive.stop(pzd.OFF3)                # as fast as the drive can, until `stop` is for OFF1 again
    drive.acknowledge()                 # a fault
    drive.ask(pkw.read(700))            # see `channel`
"""

from micropython import const

from uss import pzd
from uss.channel import PKW_COUNT, Channel
from uss.pzd import STW_ON, STW_RUN, ZSW_FAULT, ZSW_INHIBIT, ZSW_RUNNING
from uss.telegram import NET, NODE_MAX, put_word
from uss.timing import elapsed

PZD_COUNT = const(4)  # characters of STW and HSW, of ZSW and HIW
TICKET_MASK = const(0xFFFF)
INSIST_MAX = const(10)  # telegrams out of turn that an OFF1 may take until the drive answers one
UNKNOWN = const(-1)  # no control word
COUNTER_MASK = const(0xFFFF)  # counters wrap like the drive's own (specification)

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
    """address: node 0...31, ValueError beyond. mask: the clock's period - 1.

    attention: a bytearray of one, shared by the drives of a bus; 1 as long as one of them may be
    in a hurry, so that the engine need not ask each of them before every telegram.
    """

    def __init__(self, address, mask, attention=None):
        if not 0 <= address <= NODE_MAX:
            raise ValueError("drive address %r is not 0...31" % (address,))
        self.address = address
        self.net_count = PKW_COUNT + PZD_COUNT  # net characters of a request and of a reply
        self.telegram_us = 0  # the time one takes; the master knows the line
        self.residual_us = 0  # the time a reply may take
        self.channel = Channel(mask)
        self.request = bytearray(NET + self.net_count + 1)  # the telegram to it
        self.sealed = False  # it is whole: frame and BCC fit its words
        self.steady = False  # nothing has happened that would change its words, but perhaps `hsw`
        self._mask = mask
        self._attention = attention or bytearray(1)
        # Written by the loop.
        self.wanted = 0  # the control word that makes it run, 0 for none
        self.off = pzd.OFF1  # the control word that makes it stop
        self.ticket = 0
        self.stops = 0
        self.hsw = 0
        self.urgent = 0
        self.asking = False  # somebody waits for its parameters
        self.acknowledgements = 0  # of faults
        # Written by the engine.
        self.void = 0
        self.zsw = 0
        self.hiw = 0
        self.contact = False  # a valid reply came within the lost time
        self.contacts = 0  # how often contact was made
        self.was_running = False  # when contact was lost: it may run still
        self.ran = False  # seen running on the ticket in force
        self.off_answers = 0  # valid replies to telegrams without ON; wraps
        self.answered_off = False  # the last valid reply was one to a telegram without ON
        self.answered_stw = 0  # the control word of that telegram; 0 without contact
        self.answered_address = address  # of the last valid reply
        self.silent = 0  # telegrams without a valid reply in a row
        self.served = 0
        self.stops_sent = 0  # `stops` when the last telegram was built
        self.taken_back = False  # ON was revoked and the telegram that says so is still to be sent
        self.insist = 0  # telegrams out of turn left to an OFF1 that no answer has confirmed
        self.counters = [0] * len(COUNTERS)
        self.acknowledged = 0  # `acknowledgements` that a valid reply has confirmed
        self._heard_at = 0
        self._sent_stw = 0
        self._sent_hsw = 0
        self._hsw = 0  # `hsw` when the telegram was built
        self._acknowledging = 0  # `acknowledgements` when bit 7 was sent
        self._edge_was_answered = False
        self._may_run = False  # sent ON or seen running, and not seen standing after OFF1

    # --- for the loop ---------------------------------------------------------------------------

    def start(self, hsw, stw=pzd.ON):
        """Have the drive run with setpoint word `hsw` (0...FFFFh) on a new ticket.

        stw: pzd.ON, ON_REVERSE, JOG_RIGHT or JOG_LEFT; a jog has its speed from the drive.
        ValueError: no such word. TypeError: no integer.
        """
        if hsw & 0xFFFF != hsw:
            raise ValueError("HSW %r is not 0...FFFFh" % hsw)
        self.hsw = hsw
        self.off = pzd.OFF1
        ticket = (self.ticket + 1) & TICKET_MASK
        if ticket == self.void:  # after 65536 starts the old void one comes round
            ticket = (ticket + 1) & TICKET_MASK
        # The engine may come in between any two of these: the word stands before its ticket does,
        # and the ticket is written once, so that what the engine voids stays void.
        self.wanted = 0
        self.ticket = ticket
        self.wanted = stw
        self.hurry()

    def turn(self, stw):
        """Another control word for a drive that is wanted to run; it starts none that is not."""
        if self.wanted:
            self.wanted = stw
            self.steady = False

    def stop(self, off=pzd.OFF1):
        """OFF, whatever state the drive is in, ahead of the list. It stays OFF until `start`.

        off: pzd.OFF1, OFF2 or OFF3. The latter two inhibit the drive until OFF1 follows.
        """
        self.wanted = 0
        self.off = off
        self.stops = (self.stops + 1) & TICKET_MASK
        self.hurry()

    def acknowledge(self):
        """Acknowledge a fault: one edge of bit 7, confirmed by a reply. Not while it runs."""
        self.acknowledgements = (self.acknowledgements + 1) & TICKET_MASK
        self.hurry()

    def hurry(self):
        """Let the next telegram on the line be one to this drive."""
        # Behind what has changed, because the engine may come in between: it would find nothing to
        # change, or not be called for it.
        self.urgent = (self.served + 1) & TICKET_MASK
        self.steady = False
        self._attention[0] = 1

    def want_turns(self, asking):
        """Whether it is to have more than its turn in the list, for its parameters."""
        self.asking = asking
        if asking:
            self._attention[0] = 1

    def is_on(self):
        """Whether ON or JOG is being sent."""
        return (
            self.wanted != 0
            and self.ticket != self.void
            and self.stops == self.stops_sent
            and self.contact
        )

    def stopped_by_engine(self):
        """Whether ON was wanted and the engine took it back; `stop` or `start` clear it."""
        return self.wanted != 0 and self.ticket == self.void

    def state(self):
        """What the last status word says: pzd.READY ... Means nothing without contact."""
        return pzd.state(self.zsw)

    def ask(self, job):
        """Queue a parameter job. RuntimeError when too many wait already or it is pending."""
        self.channel.ask(job)

    # --- for the engine: allocates nothing ------------------------------------------------------

    def revoke(self):
        """Void the ticket in force: no ON until the next `start`, and OFF1 ahead of the list."""
        if self.is_on():
            self.taken_back = True
            self._attention[0] = 1
        self.void = self.ticket
        self.ran = False
        self.steady = False

    def urgency(self):
        """How much this drive is in a hurry.

        0: its turn in the list will do. 1: more often than its turn: an OFF1 is repeated until it
        is answered, or parameters are waited for. 2: a command. 3: a stop. 4: a stop of a drive
        that runs, or may run.
        """
        if self.urgent == self.served and not self.taken_back and self.stops == self.stops_sent:
            return 1 if self.insist or self.asking else 0
        if self.is_on():
            return 2
        return 4 if self._may_run or self.zsw & ZSW_RUNNING else 3

    def fill(self, net, at, now):
        """Bring the words of the request up to date, PKW and PZD, in `net` from index `at` on.

        net: the same buffer every time, mostly `request`. What changes in it breaks its seal.
        """
        channel = self.channel
        if not channel.idle:
            self.sealed = False
            channel.fill(net, at, now)
        hsw = self.hsw
        if self.steady and hsw == self._hsw:
            return
        self._hsw = hsw
        self.served = self.urgent
        on = self.wanted and self.is_on()
        if self.taken_back or self.stops != self.stops_sent:
            self.taken_back = False
            self.stops_sent = self.stops
            self.insist = INSIST_MAX
            self._attention[0] = 1
        elif self.insist:
            self.insist -= 1
        if on:
            self._may_run = True
            self.insist = 0
            self.acknowledged = self.acknowledgements  # never with ON, nor much later
            stw = self.wanted
        else:
            self.ran = False
            stw = self.off
            if self.acknowledgements != self.acknowledged or self._edge_was_answered:
                stw |= self._acknowledge_bit()
        if not stw & STW_ON:
            hsw = 0
        if stw != self._sent_stw or hsw != self._sent_hsw:
            self.sealed = False
            self._sent_stw = UNKNOWN  # should this fail half way, both are written anew
            put_word(net, at + PKW_COUNT, stw)
            put_word(net, at + PKW_COUNT + 2, hsw)
            self._sent_stw = stw
            self._sent_hsw = hsw
        self.steady = not self.insist and self.acknowledgements == self.acknowledged

    def take(self, net, at, now):
        """Take the words of a valid reply that stands in `net` from index `at` on, behind ADR."""
        self._heard_at = now
        self.answered_address = net[at - 1]
        self.silent = 0
        counters = self.counters
        counters[0] = (counters[0] + 1) & COUNTER_MASK
        if not self.contact:
            # Contact is made before anything is sent on it, and what was wanted before is void.
            self.revoke()
            self.contacts = (self.contacts + 1) & COUNTER_MASK
            self.was_running = False
            self.contact = True
        pzd_at = at + PKW_COUNT
        self.zsw = zsw = net[pzd_at] << 8 | net[pzd_at + 1]
        self.hiw = net[pzd_at + 2] << 8 | net[pzd_at + 3]
        self.answered_stw = stw = self._sent_stw
        if stw & STW_RUN:
            self.answered_off = False
            self._watch_running(zsw)
        else:
            self.answered_off = True
            if not self.steady and stw & pzd.STW_ACKNOWLEDGE:
                self.acknowledged = self._acknowledging
                self._edge_was_answered = True
            self.off_answers = (self.off_answers + 1) & COUNTER_MASK
            self.insist = 0
            self._may_run = zsw & ZSW_RUNNING != 0
        if not self.channel.idle:
            self.channel.take(net, at)

    def miss(self, finding, now, lost_us):
        """Count an exchange that brought no valid reply; after `lost_us` of them contact is lost.

        finding: one of the receiver's, not GOOD.
        """
        self._count(finding)
        if self.silent < COUNTER_MASK:
            self.silent += 1
        if elapsed(now, self._heard_at, self._mask) >= lost_us:
            self.lose()
        self.channel.miss(now)

    def lose(self):
        """Contact is lost; ON, if it was being sent, is void."""
        if self.contact:
            self.was_running = self._may_run
            self.revoke()
            self.acknowledged = self.acknowledgements
            self.answered_stw = 0
            self.contact = False

    def _acknowledge_bit(self):
        """Bit 7 for an acknowledgement until a reply has confirmed it, or 0.

        It acts by its rising edge: after one that was confirmed a word goes without.
        """
        if self._edge_was_answered:
            self._edge_was_answered = False
            return 0
        self._acknowledging = self.acknowledgements
        return pzd.STW_ACKNOWLEDGE

    def _watch_running(self, zsw):
        # A drive that ran on this ticket and runs no more, trips or inhibits itself has stopped of
        # its own accord. It must not start again of its own accord when the cause goes away.
        if zsw & ZSW_RUNNING:
            self.ran = True
        elif self.ran:
            self.revoke()
        if zsw & (ZSW_FAULT | ZSW_INHIBIT):
            self.revoke()

    def _count(self, counter):
        self.counters[counter] = (self.counters[counter] + 1) & COUNTER_MASK

    def __repr__(self):
        return "<drive %d ZSW %04X HIW %04X>" % (self.address, self.zsw, self.hiw)
