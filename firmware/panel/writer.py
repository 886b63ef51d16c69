# SPDX-License-Identifier: MIT
"""Writes parameters for the panel, one at a time, and tells what became of each.

In use:

    write = writer.write(control, 1000, 0, 5, False)        # a `Write`, into RAM
    writer.step(now_us)                 # again and again, until
    write.outcome                       # it is not None any more

The writer follows a drive to its new address, after a look whether anybody answers there already.
When the answer to the write is lost, nobody knows where the drive is: the writer looks for it at
the new address for a while, and then takes it to be at the old one.

    phase       what goes on                                ends when
    PROBING     three telegrams to the new address          nobody answers: WAITING
                                                            somebody does, or STOP: IDLE
    WAITING     the channel of the drive is full, perhaps   it has room: WRITING
    WRITING     the task is on its way; to a drive that     it is done or refused: IDLE
                moves and is silent, at either address      such a drive stays silent: LOOKING
    LOOKING     telegrams to the new address                it answers there, or time is up: IDLE
"""

from micropython import const

from panel import texts
from panel.pages import parameter_words as words
from panel.pages.parameter_words import failure
from uss import pkw
from uss.timing import elapsed

_LOOK_US = const(2_000_000)  # a drive that may have moved is looked for so long, or
_LOOK_CYCLES = const(3)  # so many rounds of the bus
_PROBES = const(3)  # telegrams after which nobody is there; the first was under way already

_SILENT_MAX = const(3)  # telegrams without an answer, then the other address is tried

_TRIES_MAX = const(3)

IDLE, PROBING, WAITING, WRITING, LOOKING = range(5)

# Task for a single value -> task for an element, in a family that takes an index by those.
_ELEMENT_TASKS = {
    pkw.WRITE_WORD: pkw.WRITE_ELEMENT_WORD,
    pkw.WRITE_DOUBLE: pkw.WRITE_ELEMENT_DOUBLE,
    pkw.WRITE_DOUBLE_EEPROM: pkw.WRITE_ELEMENT_DOUBLE_EEPROM,
    pkw.WRITE_WORD_EEPROM: pkw.WRITE_ELEMENT_WORD_EEPROM,
}


class Write:
    """A parameter that is to be written. value: the bits of 16 or 32, not negative; width: WORD or
    DOUBLE of `pkw`. moves: it is the drive's address.

    outcome: how it ended, a text and the values in it; None while it is on its way. done:
    the drive has confirmed it. The writer writes both; nobody writes any other field.
    """

    def __init__(self, control, number, index, value, eeprom=False, width=pkw.WORD):
        self.control = control
        self.number = number
        self.index = index
        self.value = value
        self.eeprom = eeprom
        self.width = width
        self.old_address = control.drive.address
        family = control.survey.family
        is_address = number == family.address_number and index == family.link_index
        self.moves = is_address and value != self.old_address
        self.outcome = None
        self.done = False

    def news(self, selected):
        """The outcome for somebody who looks at this control, as a text and values."""
        if self.control is selected:
            return self.outcome
        text = words.OTHER_WRITTEN if self.done else words.OTHER_NOT_WRITTEN
        return text, self.control.drive.address


class Writer:
    """bus: the `Master`, its drives added. settings: a `Settings`. mask: the clock's period - 1.

    Of a control it writes `moving` and `moved`, and no other field.
    """

    def __init__(self, bus, settings, mask):
        self._bus = bus
        self._settings = settings
        self._mask = mask
        self._patience_us = 0  # how long a drive that may have moved is looked for
        self._phase = IDLE
        self._job = pkw.read(0)
        self._write = None  # the last one
        self._ended = None  # likewise, until somebody has taken it
        self._since_us = 0
        self._stops = 0  # drive.stops when it was spoken to at the new address first
        self._telegrams = 0  # to the drive, then
        self._tries = 0
        self._silent = 0  # drive.silent when it was last spoken to at the other address

    def write(self, control, *what):
        """what: as of `Write`. One that cannot even be tried has its outcome already."""
        drive = control.drive
        write = Write(control, *what)
        if self._phase != IDLE or drive.channel.is_full():
            write.outcome = (texts.WRITER_BUSY,)
        elif not drive.contact:
            write.outcome = (texts.NO_CONTACT,)
        else:
            self._write = write
            self._tries = 0
            if write.moves:
                self._phase = PROBING
                control.moving = True
                self._go_to(write.value)
            else:
                self._phase = WAITING  # for a step: whoever calls this is deep in the stack
        return write

    def is_idle(self):
        """Whether nothing is on its way, and nobody has still to hear how the last one ended."""
        return self._phase == IDLE and self._ended is None

    def takes(self, address):
        """Whether a drive is just being given this address."""
        return self._phase != IDLE and self._write.moves and self._write.value == address

    def take_ended(self):
        """The `Write` that has ended, once; None otherwise."""
        ended, self._ended = self._ended, None
        return ended

    def step(self, now_us):
        if self._phase == IDLE:
            return
        if self._phase == WAITING:
            self._ask()
        elif self._phase == PROBING:
            self._probe()
        elif self._phase == LOOKING:
            self._look(now_us)
        elif self._job.state != pkw.PENDING:
            self._finish(now_us)
        elif self._write.moves:
            self._follow_silence()

    def _ask(self):
        write = self._write
        drive = write.control.drive
        if drive.channel.is_full():
            self._phase = WAITING
            return
        self._phase = WRITING
        self._silent = drive.silent
        task = pkw.WRITE_WORD_EEPROM if write.eeprom else pkw.WRITE_WORD
        if write.width == pkw.DOUBLE:
            task = pkw.WRITE_DOUBLE_EEPROM if write.eeprom else pkw.WRITE_DOUBLE
        if write.index and write.control.survey.family.has_array_tasks:
            task = _ELEMENT_TASKS[task]
        high, low = write.value >> 16, write.value & 0xFFFF
        self._job.aim(task, write.number, write.index, high, low)
        drive.ask(self._job)

    def _finish(self, now_us):
        job, write = self._job, self._write
        drive = write.control.drive
        may_have_moved = write.moves and job.state != pkw.REFUSED
        if job.state == pkw.DONE:
            if job.integer_value() == write.value:
                self._confirm()
            elif self._tries < _TRIES_MAX:  # that was an old answer to a reading
                self._tries += 1
                self._ask()
            else:
                self._end(words.NOT_WRITTEN)
        elif may_have_moved and drive.silent:
            self._phase = LOOKING
            self._since_us = now_us
            # A clock of a short period cannot tell more than half of it.
            patience_us = max(_LOOK_US, _LOOK_CYCLES * self._bus.turns.longest_cycle_us())
            self._patience_us = min(patience_us, self._mask >> 2)
            self._go_to(write.value)
        elif may_have_moved and drive.answered_address == write.value:
            self._confirm()
        else:
            self._end(*failure(job))

    def _confirm(self):
        write = self._write
        if write.moves:
            self._bus.turns.readdress(write.control.drive, write.value)
            # The panel must look for it there after a restart: it may run by then.
            self._settings.readdress(write.old_address, write.value)
            write.control.moved = True
        write.done = True
        self._end(words.WRITTEN_EEPROM if write.eeprom else words.WRITTEN)

    def _end(self, *outcome):
        self._phase = IDLE
        self._ended = write = self._write
        write.outcome = outcome
        write.control.moving = False
        # What may have changed by it is read again before anybody relies on it.
        write.control.survey.recheck()

    # --- a drive that moves to another address --------------------------------------------------

    def _go_to(self, address):
        drive = self._write.control.drive
        self._bus.turns.readdress(drive, address)
        drive.hurry()
        self._stops = drive.stops
        self._telegrams = sum(drive.counters)

    def _probe(self):
        """Nobody may be at the new address: two drives at one would answer at once for ever."""
        write = self._write
        drive = write.control.drive
        telegrams = (sum(drive.counters) - self._telegrams) & 0xFFFF
        if drive.stops != self._stops:  # that is for the drive, which is at the old address
            self._give_up_probe(words.NOT_WRITTEN)
        elif not drive.silent and drive.answered_address == write.value:
            self._give_up_probe(words.ADDRESS_TAKEN)
        elif telegrams >= _PROBES:
            self._bus.turns.readdress(drive, write.old_address)
            self._ask()
        elif drive.urgent == drive.served:
            drive.hurry()

    def _give_up_probe(self, outcome):
        self._go_to(self._write.old_address)
        self._end(outcome)

    def _follow_silence(self):
        """A drive that falls silent while it is told its new address may be there already, or not
        have heard of it: it is spoken to at either in turn, and the task with it.
        """
        write = self._write
        drive = write.control.drive
        if not drive.silent:
            self._silent = 0
        elif drive.silent >= self._silent + _SILENT_MAX:
            self._silent = drive.silent
            at_new = drive.address == write.value
            self._bus.turns.readdress(drive, write.old_address if at_new else write.value)

    def _look(self, now_us):
        write = self._write
        drive = write.control.drive
        if not drive.silent and drive.answered_address == write.value:
            self._confirm()
        elif elapsed(now_us, self._since_us, self._mask) >= self._patience_us:
            self._bus.turns.readdress(drive, write.old_address)
            self._end(words.NO_ANSWER)
