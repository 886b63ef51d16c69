# SPDX-License-Identifier: MIT
"""One drive on the bus, as the master keeps it: commands, process image, counters.

Two sides share a drive: the *loop* (panel, your program) and the *engine* (`master.poll`, possibly
in an interrupt). They share words, not structures; each field has one writer:

    loop     wanted, off, ticket, stops, hsw, urgent, asking, acknowledgements, near, tells_status,
             further words on their way out
    engine   void, zsw, hiw, contact, contacts, was_running, silent, served, counters and the rest
    both     steady: False by whoever changes something, at last; True by the engine alone;
             `become`: the loop, while the bus keeps the engine away from the drive

ON and JOG are sent only on a ticket. Every `start` draws a new one. The engine voids the ticket in
force if the drive is lost, faults, stops of its own accord or stands still although it was not
told to, or if the loop stops refreshing. A void ticket stays void: whatever happens to the line or
the loop, only a fresh `start` makes a drive run again. Every STOP is sent: at least one telegram
carries OFF before the next ON, however soon that comes.

    drive.start(0x0CCD)                 # ON, setpoint HSW, from the next telegram on
    drive.start(0, pzd.JOG_LEFT)        # JOG, until `stop`
    drive.stop()                        # OFF1, in the very next telegram on the line
    drive.stop(pzd.OFF3)                # as fast as the drive can, until `stop` is for OFF1 again
    drive.acknowledge()                 # a fault
    drive.ask(pkw.read(700))            # see `channel`
    drive.put(4, 0x2000)                # further words of its layout: PZD4, here STW2
    drive.word(4)                       # ZSW2
"""

from array import array

from micropython import const

from uss import pzd
from uss.channel import Channel
from uss.fast import copy, frame, get_words
from uss.layout import STANDARD
from uss.pzd import STW_ON, STW_RUN, ZSW_RUNNING
from uss.receiver import SILENCE, TROUBLES
from uss.telegram import NET, NODE_MAX, put_word
from uss.timing import elapsed

_TICKET_MASK = const(0xFFFF)
_INSIST_MAX = const(10)  # telegrams out of turn that an OFF1 may take until the drive answers one,
_RESTING_INSIST_MAX = const(3)  # and if it did not answer before: 30 drives may be silent
SILENT_MAX = const(3)  # a drive that is silent so often in a row is not just disturbed
_SURE = const(2)  # so many telegrams may meet with another trouble before `trouble` changes
_SURE_MAX = const(3)
_AHEAD_US = const(100_000)  # an interrupt may be so far ahead of the loop's reading of the time
_UNKNOWN = const(-1)  # no control word
_NO_EDGE = const(-1)  # no acknowledgement on its way
_ANSWERED = const(-2)  # an acknowledgement was confirmed: a word without bit 7 must follow
_NO_ORDER = const(-1)  # HIW is expected to become nothing: a standstill tells nothing
_ORDER = const(0x0071)  # STW bits of an ON whose setpoint counts: 0, 4, 5 and 6
_PERCENT = const(100)
_TROUBLE = const(0x0048)  # ZSW_FAULT, ZSW_INHIBIT; the compiler does not know an imported const
_MOTION = const(0x004C)  # and ZSW_RUNNING
MOTION = _MOTION
_COUNTER_MASK = const(0xFFFF)  # counters wrap like the drive's own (specification)

# The counter of each receiver finding, and its bit of the error status word, both named as in
# specification. Characters that are lost, or have a wrong parity or stop bit, have no
# counter: no UART of MicroPython tells of them. They show as telegrams too short or with a wrong
# BCC.
COUNTERS = (
    "good",  # answered without an error
    "start",  # telegram start not identified
    "length",
    "bcc",
    "address",
    "no_reply",
    "residual",  # residual run time expired
)
STATUS_BITS = (0x00, 0x08, 0x40, 0x10, 0x08, 0x80, 0x20, 0x40)
_GARBLED_COUNTER = const(2)  # "length", because GARBLED has no counter of its own

# What the drives of a bus tell the engine, in three rows by address: how urgent a command is; that
# the drive's next turn would be too late; that the drive wants more than its turn. At ANY: that
# any of them may be set, and a telegram that was made ready is not to go before the engine has
# looked; at SOON: the same, but such a telegram may go. Only the engine clears them.
NODES = const(32)
COMMANDS = const(0)
OVERDUE = const(32)
WANTS = const(64)
ANY = const(96)
SOON = const(97)
ATTENTION = const(98)

OFFS = (pzd.OFF1, pzd.OFF2, pzd.OFF3)
NO_CONTROL = const(0)  # in place of an OFF: bit 10 is 0, and the drive is told nothing

# Bits of STW that `control` may change, and those that are 1 in every control word of `pzd`. The
# others start, stop, acknowledge, turn round or give up control.
_CONTROL_BITS = const(0xE078)
_CONTROL_ON = const(0x0078)


class Drive:
    """address: node 0...31, ValueError beyond. mask: the clock's period - 1. layout: a `Layout`.

    attention: shared by the drives of a bus, see ATTENTION, so that the engine need not ask each
    drive before every telegram.

    Fields to look at: `zsw`, `hiw`, `contact`, `was_running`; `silent`, telegrams without a valid
    reply in a row; `counters`, see COUNTERS; `status`, the error status word: what went wrong
    since the last valid reply, 0 after one; `trouble`, which of `receiver.TROUBLES` most of that
    was. A few others in between do not change it.
    """

    outside = False  # it is in the list; for telegrams outside it see `outside`
    doubts = 0  # how often a drive was doubted, of any drive

    # Forty-seven fields. One more would take 96 bytes more of each drive. None may come later: the
    # table of the fields must not grow while the engine, in an interrupt, writes into it.

    def __init__(self, address, mask, attention=None, layout=STANDARD):
        if not 0 <= address <= NODE_MAX:
            raise ValueError("drive address %r is not 0...31" % (address,))
        self.address = address
        self.layout = layout
        self.channel = Channel(mask, layout.pkw_words, layout.longest, layout.short)
        self.request = bytearray(NET + layout.net_max + 1)  # the telegram to the drive
        self.size = NET + layout.net_count + 1  # of the request, in characters
        self.sealed = False  # the request is whole: frame and BCC fit its words
        self.steady = False  # nothing would change the words of the request, except perhaps `hsw`
        self._attention = attention or bytearray(ATTENTION)
        # Written by the loop.
        self.wanted = 0  # the control word that makes it run, 0 for none
        self.off = pzd.OFF1  # the control word that makes it stop
        self.ticket = 0
        self.stops = 0
        self.hsw = 0
        self.urgent = 0
        self.asking = False  # the program waits for its parameters
        self.acknowledgements = 0  # of faults
        self.near = pzd.FULL_SCALE // _PERCENT * 2  # 2 % of HIW's full scale, even; 0: no speed
        self.tells_status = True  # ZSW is its status word; False: ZSW says nothing of the motor
        self.further = None  # PZD words beyond two: those to the drive, then those from it
        self.doubted = False  # its replies make no sense: perhaps they are divided differently
        # Written by the engine.
        self.void = 0
        self.zsw = 0
        self.hiw = 0
        self.contact = False  # a valid reply came within the lost time
        self.contacts = 0  # how often contact was made
        self.was_running = False  # it ran when contact was lost, so it may still run
        self.ran = False  # seen running on the ticket in force
        self.off_answers = 0  # valid replies to telegrams without ON; wraps
        self.answered_stw = 0  # the control word of that telegram; 0 without contact
        self.answered_address = address  # of the last valid reply
        self.silent = 0
        self.status = 0
        self.trouble = SILENCE
        self._sure = 0  # so many other troubles must come before `trouble` changes
        self.served = 0
        self.stops_sent = 0  # `stops` when the last telegram was built
        self.insist = 0  # telegrams out of turn left for an OFF1 that no answer has confirmed
        self.counters = array("H", bytes(2 * len(COUNTERS)))
        self.acknowledged = 0  # `acknowledgements` that a valid reply has confirmed
        self._tried_at = 0  # the last valid reply; without contact, the last telegram
        self._toggled = 0  # bits of STW that are inverted by `control`
        self._sent_stw = 0
        self._hsw = 0  # `hsw` when the telegram was built
        self._edge = _NO_EDGE  # `acknowledgements` when bit 7 was sent
        self._may_run = False  # sent ON or seen running, and not seen standing after OFF1
        self._order = _NO_ORDER  # the word that HIW should become
        self._arrived = False  # HIW has become that word
        if layout.pzd_words > 2:
            self.further = array("H", bytes(4 * (layout.pzd_words - 2)))

    # --- for the loop ---------------------------------------------------------------------------

    def start(self, hsw, stw=pzd.ON):
        """Make the drive run with setpoint word `hsw` (0...FFFFh) on a new ticket.

        stw: pzd.ON, ON_REVERSE, JOG_RIGHT or JOG_LEFT; a jog has its speed from the drive.
        ValueError if there is no such word, or the layout has no PZD. TypeError: not an integer.
        """
        if hsw & 0xFFFF != hsw:
            raise ValueError("HSW %r is not 0...FFFFh" % hsw)
        if not self.layout.pzd_words:
            raise ValueError("the telegrams to drive %d have no control word" % self.address)
        self.hsw = hsw
        self.off = pzd.OFF1
        ticket = (self.ticket + 1) & _TICKET_MASK
        if ticket == self.void:  # tickets wrap after 65536 starts: skip the void one
            ticket = (ticket + 1) & _TICKET_MASK
        # The engine may come in between any two of these lines. There is no control word while the
        # ticket is new, and the ticket is written once, so that what the engine voids stays void.
        self.wanted = 0
        self.ticket = ticket
        self.wanted = stw
        self.hurry()

    def turn(self, stw):
        """Change the control word of a drive that is wanted to run. This does not start a
        drive."""
        if self.wanted:
            self.wanted = stw
            self.steady = False

    def stop(self, off=pzd.OFF1):
        """Send OFF ahead of the list, whatever state the drive is in. It stays OFF until `start`.

        off: pzd.OFF1, OFF2 or OFF3; else ValueError. OFF2 and OFF3 inhibit the drive until OFF1
        follows.
        """
        if off not in OFFS:
            raise ValueError("STW %r is no OFF" % (off,))
        self.wanted = 0
        self.off = off
        self.stops = (self.stops + 1) & _TICKET_MASK
        self.hurry()

    def acknowledge(self):
        """Acknowledge a fault: one edge of bit 7, confirmed by a reply. Not while it runs."""
        self.acknowledgements = (self.acknowledgements + 1) & _TICKET_MASK
        self.hurry()

    def hurry(self):
        """Let the next telegram on the line be one to this drive."""
        # Call this after the change, never before it: the engine may come in between, and would
        # find nothing changed.
        self.urgent = (self.served + 1) & _TICKET_MASK
        self.steady = False
        self.call()

    def move(self, address):
        """The drive answers at another address from now on; `Turns` checks that it is free."""
        self.address = address
        self.call_again()  # what called at the old one

    def become(self, other):
        """Take over the layout of `other`, a new drive, with all that is made for it: the telegram
        and the parameter channel. PZD words that both have keep what `put` said.

        From the loop; the master sees that no telegram is built or taken meanwhile.
        """
        # It has missed no telegram that is divided like this.
        self.silent = self.status = 0
        self.channel.become(other.channel)
        if self.further and other.further:
            count = min(len(self.further), len(other.further)) >> 1
            for index in range(count):
                other.further[index] = self.further[index]
        self.further = other.further
        self.layout = other.layout
        self.request = other.request
        self.size = other.size
        self.sealed = self.steady = False

    def call(self):
        """Make the engine look how urgent this drive is."""
        attention = self._attention
        urgency = self.urgency()
        if urgency > 1:
            attention[self.address] = urgency
            attention[ANY] = 1

    def call_again(self):
        """Let the engine look once more at all that this drive may have called for."""
        self.call()
        self._call_for_turns()
        self._attention[ANY] = 1

    def _call_for_turns(self):
        attention = self._attention
        attention[WANTS + self.address] = 1
        attention[SOON] = 1

    def want_turns(self, asking):
        """Set whether it gets more than its turn in the list, for its parameters."""
        self.asking = asking
        if asking:
            self._call_for_turns()

    def control(self, bits, on):
        """Set these bits of STW to 1, or to 0, in every telegram, also while the drive runs.

        bits: any of 3...6, which are otherwise 1, and 13...15, which are otherwise 0. ValueError
        for other bits.
        """
        if bits & _CONTROL_BITS != bits:
            raise ValueError("STW bits %04Xh are no matter of control()" % (bits & ~_CONTROL_BITS))
        usual = _CONTROL_ON if on else _CONTROL_BITS & ~_CONTROL_ON
        self._toggled = self._toggled & ~bits | bits & ~usual
        self.steady = False

    def tell_speed(self, full_scale):
        """Say which count of HIW stands for 100 % speed; HIW is negative to the left.

        4000h by default; 0: HIW is no speed with a sign. By HIW the engine notices a motor that
        stands still although it was not told to, and takes ON back.
        """
        self.near = full_scale // _PERCENT * 2
        self.steady = False

    def put(self, place, word):
        """Send `word`, 0...FFFFh, as PZD word `place` from the next telegram on.

        place: 3...16; the first two are STW and HSW, 4 is mostly STW2. ValueError if there is no
        such word, or the layout has no such place.
        """
        if not 3 <= place <= self.layout.pzd_words or word & 0xFFFF != word:
            raise ValueError("PZD%r = %r to drive %d" % (place, word, self.address))
        self.further[place - 3] = word
        self.steady = False

    def word(self, place):
        """PZD word `place`, 1...16, of the last valid reply; 1 is ZSW, 2 HIW, 4 mostly ZSW2.

        ValueError if the layout has no such place. The word means nothing without contact.
        """
        words = self.layout.pzd_words
        if not 1 <= place <= words:
            raise ValueError("drive %d sends no PZD%r" % (self.address, place))
        if place < 3:
            return self.zsw if place == 1 else self.hiw
        return self.further[words - 2 + place - 3]

    # A method, not a property: if a class has a property, MicroPython takes three times as long to
    # store any attribute of its objects, in the interrupts too.

    def answered_off(self):
        """Whether the last valid reply was one to a telegram without ON."""
        return self.contact and not self.answered_stw & STW_RUN

    def may_run(self):
        """Whether the motor may turn: it was told to, is seen to, was lost while it did, or its
        ZSW does not tell."""
        return self._may_run or self.was_running or not self.tells_status or self.is_on()

    def is_on(self):
        """Whether ON or JOG is being sent."""
        return (
            self.wanted != 0
            and self.ticket != self.void
            and self.stops == self.stops_sent
            and self.contact
        )

    def stopped_by_engine(self):
        """Whether ON was wanted and the engine took it back; `stop` and `start` clear this."""
        return self.wanted != 0 and self.ticket == self.void

    def state(self):
        """What the last status word says: pzd.READY ... It means nothing without contact."""
        return pzd.state(self.zsw)

    def ask(self, job):
        """Queue a parameter job. RuntimeError if too many wait already, it is pending, or the
        drive has no parameter channel. A job that does not fit its layout is REFUSED at once.
        """
        self.channel.ask(job)
        self._attention[SOON] = 1

    # --- for the engine: allocates nothing ------------------------------------------------------

    def revoke(self):
        """Void the ticket in force: no ON until the next `start`, and OFF1 ahead of the list."""
        was_on = self.is_on()
        self.void = self.ticket
        self.ran = False
        self.steady = False
        if was_on:
            self.stops_sent = (self.stops - 1) & _TICKET_MASK  # one stop is still to be sent
            self.call()

    def ask_soon(self):
        """From the loop: give it one telegram besides its turns in the list."""
        if not self.insist:
            self.insist = 1
        self.steady = False
        self._call_for_turns()

    def press(self, urgency=2):
        """From the loop: its next turn in the list would be too late. urgency: 1 for a drive at
        rest, which goes after those that may run.
        """
        attention = self._attention
        attention[OVERDUE + self.address] = urgency
        attention[SOON] = 1

    def is_told_in_vain(self):
        """Whether it does not answer, and must still be told to stop or asked once more."""
        return not self.contact and (self.insist > 0 or self.stops != self.stops_sent)

    def urgency(self):
        """How urgent the next telegram to this drive is.

        0: its turn in the list will do. 1: it needs more than its turn, to repeat an OFF1 until it
        is answered, or because the program waits for parameters. 2: a command. 3: a stop. 4: a
        stop of a drive that runs, or may run.
        """
        if self.urgent == self.served and self.stops == self.stops_sent:
            return 1 if self.insist or self.asking and self.contact else 0
        if self.is_on():
            return 2
        return 4 if self._may_run or self.zsw & ZSW_RUNNING or not self.tells_status else 3

    def fill(self, now):
        """Bring the words of the request up to date. A change makes it unsealed."""
        channel = self.channel
        if not channel.idle:
            self.sealed = False
            size = NET + channel.fill(self.request, NET, now) + self.layout.pzd_count + 1
            if size != self.size:  # variable length: the PZD have moved
                self.size = size
                self.steady = False
        hsw = self.hsw
        if self.steady and hsw == self._hsw:
            return
        self._hsw = hsw
        self.served = self.urgent
        self._attention[self.address] = 0  # this telegram carries its command
        on = self.wanted and self.is_on()
        if self.stops != self.stops_sent:
            self.stops_sent = self.stops
            self.insist = _RESTING_INSIST_MAX if self.may_rest() else _INSIST_MAX
            self._call_for_turns()
        elif self.insist:
            self.insist -= 1
        if on:
            self._may_run = True
            self.insist = 0
            self.acknowledged = self.acknowledgements  # drop it: never with ON, nor much later
            stw = self.wanted
        else:
            self.ran = False
            stw = self.off
            if self.acknowledgements != self.acknowledged or self._edge == _ANSWERED:
                stw |= self._acknowledge_bit()
        if not stw & STW_ON:
            hsw = 0
        stw ^= self._toggled
        if on or self._order != _NO_ORDER:
            self._note_order(stw, hsw)
        self.sealed = self.steady = False  # if this fails half way, the next `fill` does it anew
        self._sent_stw = _UNKNOWN
        behind = self.layout.pzd_count + 1  # characters of the telegram from its PZD on
        if behind >= 3:
            request = self.request
            at = self.size - behind
            request[at] = stw >> 8
            request[at + 1] = stw & 0xFF
            if behind >= 5:
                request[at + 2] = hsw >> 8
                request[at + 3] = hsw & 0xFF
                if behind > 5:
                    self._put_further(at + 4)
        self._sent_stw = stw
        self.steady = not self.insist and self.acknowledgements == self.acknowledged

    def foresee(self, telegram, answering):
        """What the next request is if nothing happens meanwhile: the last one, or `telegram`, in
        which it is put together; None if it depends on something. Nothing of the drive changes:
        `follow` says that it went out.

        Its control word is that of the last request. answering: a reply of this drive is under
        way, to that request; it is as `going_on.plan` says.
        """
        request = self.request
        if not self.steady or not self.sealed or request[2] != self.address:
            return None
        hsw = self.hsw
        if self.channel.idle and (hsw == self._hsw or not self._sent_stw & STW_ON):
            return request
        size = self.size
        copy(request, telegram, 0, size)
        if not self.channel.idle:
            words = self.channel.foresee(answering)
            if words is None:
                return None
            copy(words, telegram, NET, len(words))
        if hsw != self._hsw and self._sent_stw & STW_ON:
            at = size - self.layout.pzd_count + 1
            if at < size - 1:
                telegram[at] = hsw >> 8
                telegram[at + 1] = hsw & 0xFF
        frame(telegram, size, self.address)
        return telegram

    def follow(self, telegram, now):
        """The telegram that `foresee` has put together is on the line."""
        size = self.size
        copy(telegram, self.request, 0, size)
        if not self.channel.idle:
            self.channel.sent(telegram, NET, now)
        stw = self._sent_stw
        behind = self.layout.pzd_count + 1
        if behind >= 5 and stw & STW_ON:
            at = size - behind + 2
            hsw = telegram[at] << 8 | telegram[at + 1]
            if hsw != self._hsw:
                self._hsw = hsw
                self._note_order(stw, hsw)

    def _note_order(self, stw, hsw):
        """Note what HIW should become by this telegram. A new value has not arrived yet."""
        order = hsw
        if stw & pzd.STW_REVERSE:
            order = -hsw & 0xFFFF
        # A setpoint below 5 % may mean a standstill. A jog has no setpoint.
        least = 5 * self.near >> 1
        if stw & _ORDER != _ORDER or not least or (order + least - 1) & 0xFFFF < 2 * least - 1:
            order = _NO_ORDER
        if order != self._order:
            self._order = order
            self._arrived = False

    def _put_further(self, at):
        for index in range(len(self.further) >> 1):
            put_word(self.request, at + 2 * index, self.further[index])

    def take(self, buffer, count, now):
        """Take the words of a valid reply: the first `count` characters of `buffer`."""
        self._tried_at = now
        self.answered_address = buffer[2]
        if self.silent:
            self.silent = 0
            self.status = 0
        counters = self.counters
        counters[0] = (counters[0] + 1) & _COUNTER_MASK
        if not self.contact:
            # On new contact, what was wanted before is void, so that it is not sent.
            self.revoke()
            self.contacts = (self.contacts + 1) & _COUNTER_MASK
            self.was_running = False
            self.contact = True
        behind = self.layout.pzd_count + 1
        at = count - behind
        zsw = buffer[at] << 8 | buffer[at + 1] if behind > 1 else 0
        if behind >= 5:
            self.hiw = buffer[at + 2] << 8 | buffer[at + 3]
            if behind > 5:
                words = (behind >> 1) - 2
                get_words(buffer, at + 4, self.further, words, words)
        self.zsw = zsw
        self.answered_stw = stw = self._sent_stw
        if stw & STW_RUN:
            self._watch_running(zsw)
        else:
            if not self.steady and stw & pzd.STW_ACKNOWLEDGE:
                self.acknowledged = self._edge
                self._edge = _ANSWERED
            self.off_answers = (self.off_answers + 1) & _COUNTER_MASK
            self.insist = 0
            self._may_run = zsw & ZSW_RUNNING != 0
        if not self.channel.idle:
            self.channel.take(buffer, NET, at - NET)

    def miss(self, finding, now, lost_us, mask):
        """Count an exchange that brought no valid reply; after `lost_us` of them contact is lost.

        finding: one of the receiver's, not GOOD.
        """
        row = finding if finding < len(COUNTERS) else _GARBLED_COUNTER
        self.counters[row] = (self.counters[row] + 1) & _COUNTER_MASK
        self.status |= STATUS_BITS[finding]
        self._weigh(TROUBLES[finding])
        if self.silent < _COUNTER_MASK:
            self.silent += 1
        pressing = False
        if not self.contact:
            self._tried_at = now
        else:
            passed_us = elapsed(now, self._tried_at, mask)
            pressing = passed_us + passed_us // self.silent > lost_us >> 1
            if passed_us >= lost_us:
                self.lose()
        if not self.channel.idle:
            self.channel.miss(now, self.silent, pressing)

    def _weigh(self, trouble):
        """Find the trouble that most telegrams have met with since the last valid reply. So two
        kinds that alternate on the line do not alternate on the display.
        """
        if self.silent and trouble == self.trouble:
            self._sure = min(self._sure + 1, _SURE_MAX)
        elif self.silent and self._sure:
            self._sure -= 1
        else:
            self.trouble = trouble
            self._sure = _SURE

    def fits(self, net_count):
        """Whether a reply may have so many net characters."""
        return self.layout.fits(net_count)

    def may_rest(self):
        """Whether it may miss turns: it does not answer, and was not told to run. A drive that was
        running when contact was lost keeps its turns.
        """
        return not self.contact and not self.was_running

    def silent_us(self, now, mask):
        """How long ago the last valid reply came; without contact, the last telegram."""
        passed_us = (now - self._tried_at) & mask
        return passed_us if passed_us < mask - _AHEAD_US else 0

    def may_reply_alike(self):
        """Whether its reply may be equal to the request. With PZD it may not: a status word has
        bit 9 set when bit 3 is not.
        """
        return not self.layout.pzd_words

    def doubt(self):
        """What it answers makes no sense. A finder asks it for its layout."""
        self.doubted = True
        Drive.doubts += 1

    def lose(self):
        """Contact is lost; ON, if it was being sent, is void."""
        if self.contact:
            self.was_running = self._may_run or not self.tells_status
            self.revoke()
            self.acknowledged = self.acknowledgements
            self.answered_stw = 0
            self.contact = False

    def _acknowledge_bit(self):
        """Bit 7 for an acknowledgement until a reply has confirmed it, or 0.

        The bit acts by its rising edge. So after a confirmed one, a word without the bit is sent.
        """
        if self._edge == _ANSWERED:
            self._edge = _NO_EDGE
            return 0
        self._edge = self.acknowledgements
        return pzd.STW_ACKNOWLEDGE

    def _watch_running(self, zsw):
        # A drive that ran on this ticket and no longer runs, or that trips or inhibits itself, has
        # stopped of its own accord. It must not start by itself when the cause goes away.
        if zsw & _MOTION == ZSW_RUNNING:
            self.ran = True
        elif self.ran or zsw & _TROUBLE:
            self.revoke()
        # A drive that had its speed and stands still, although it was told nothing else, has also
        # stopped: its mains were off, and it may power up and run again before any other sign.
        order = self._order
        if order >= 0:
            near = self.near
            if self._arrived:
                if (self.hiw + (near >> 1)) & 0xFFFF <= near:  # 1 %
                    self.revoke()
            elif (self.hiw - order + near) & 0xFFFF <= 2 * near:
                self._arrived = True

    def __repr__(self):
        return "<drive %d ZSW %04X HIW %04X>" % (self.address, self.zsw, self.hiw)
